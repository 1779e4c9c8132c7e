//! What pieces and sheets leave in a folder, as names and bytes; nothing is written here.

use rayon::prelude::*;

use super::assembly_text::assembly_text;
use super::fabricate::piece_list;
use super::{Fabrication, MakeError};
use crate::code::Coded;
use crate::io::pieces_json::write_pieces_json;
use crate::io::sheet::files::sheet_files;
use crate::io::sheet::layout::write_order_layout_json;
use crate::io::sheet::page::{SheetPage, sheets_html};
use crate::mesh::Mesh;
use crate::net::EdgeLabel;
use crate::picture::{PictureError, Polyline, StrokeLayer, Strokes, render_sheet};
use crate::sheet::{
    Drawing, JointFallback, JointReport, LayerKind, NearScores, SheetFinding, SheetParams,
    SheetReport, Style,
};
use crate::units::counted;

/// A file to be written: its name in the folder, and its bytes.
pub type Output = (String, Vec<u8>);

/// Width of the picture of a sheet, in pixels.
const SHEET_PICTURE: u32 = 1200;

/// Pieces, layout and sheets with a picture of each and a page to look at them all; the pieces only
/// when no sheets were asked for. `model` is the mesh in mm that was unfolded, where there is one.
///
/// # Errors
/// [`MakeError`] when a sheet cannot be tiled or drawn.
pub fn fabrication_outputs(
    fabrication: &Fabrication,
    model: Option<&Mesh>,
    sheet: &SheetParams,
    command: &str,
) -> Result<Vec<Output>, MakeError> {
    let mut outputs =
        vec![("pieces.json".to_owned(), write_pieces_json(&fabrication.net, command).into_bytes())];
    if !fabrication.sheets.drawings.is_empty() {
        let layout =
            write_order_layout_json(&fabrication.sheets.layout, &fabrication.sources, command);
        outputs.push(("layout.json".to_owned(), layout.into_bytes()));
        let text = assembly_text(fabrication, sheet.letter.labels, command);
        outputs.push(("assembly.txt".to_owned(), text.into_bytes()));
        let page =
            SheetPage { net: &fabrication.net, sheets: &fabrication.sheets, model, params: sheet };
        outputs.push(("sheets.html".to_owned(), sheets_html(&page, command).into_bytes()));
    }
    outputs.extend(sheet_files(&fabrication.sheets.drawings, sheet, command)?);
    let picture = |drawing: &Drawing| -> Result<Output, MakeError> {
        let picture = sheet_picture(drawing, &sheet.style(), SHEET_PICTURE)?;
        Ok((format!("{}.png", drawing.file_stem()), picture))
    };
    let pictures: Vec<_> = fabrication.sheets.drawings.par_iter().map(picture).collect();
    for picture in pictures {
        outputs.push(picture?);
    }
    Ok(outputs)
}

/// A PNG of a sheet in the colours of its style, parts tinted.
///
/// # Errors
/// [`PictureError`] for a size that cannot be drawn.
pub fn sheet_picture(
    drawing: &Drawing,
    style: &Style,
    width: u32,
) -> Result<Vec<u8>, PictureError> {
    let layers = drawing.layers.iter().map(|layer| StrokeLayer {
        name: layer.kind.name().to_owned(),
        colour: style.pen(layer.kind).colour,
        width_mm: style.pen(layer.kind).width,
        polylines: layer
            .marks
            .iter()
            .flat_map(|mark| &mark.strokes)
            .map(|stroke| Polyline { points: stroke.points.clone(), is_closed: stroke.closed })
            .collect(),
        bounds_parts: matches!(layer.kind, LayerKind::CutInner | LayerKind::CutOuter),
    });
    let strokes =
        Strokes { width_mm: drawing.width, height_mm: drawing.height, layers: layers.collect() };
    Ok(render_sheet(&strokes, width)?.to_line_png())
}

impl Fabrication {
    /// What the user should know about pieces and sheets.
    pub fn notes(&self) -> Vec<String> {
        let report = &self.sheets.report;
        let mut notes = self.piece_notes();
        notes.extend(lettering_notes(report));
        notes.extend(fold_notes(report));
        notes.extend(contour_notes(report));
        notes.extend(layout_notes(report));
        notes.extend(info_notes(report));
        notes.extend(near_note(report));
        notes.extend(joint_notes(&report.joints));
        notes
    }

    /// What breaks a limit of the material, with its code and what to do; nothing where the material
    /// is not known.
    pub fn findings(&self) -> Vec<String> {
        let near = self.sheets.report.near_scores.as_ref().filter(|near| near.is_known);
        let code = SheetFinding::NearScores.code();
        near.map(|near| format!("finding {code}: {}", near_text(near))).into_iter().collect()
    }

    fn piece_notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.seams.is_empty() {
            notes.push(self.seams.to_owned());
        }
        if self.divided > 0 {
            let folds = counted(self.divided, "fold was", "folds were");
            notes.push(folds + " opened so that the pieces fit on the sheet");
        }
        let flat = self.flat_seams();
        if !flat.is_empty() {
            let seams = counted(flat.len(), "seam runs", "seams run");
            notes.push(format!("{seams} between faces in one plane: {}", flat.join(", ")));
        }
        notes
    }
}

/// A note on something, where there is any of it.
fn note(count: usize, text: impl FnOnce() -> String) -> Option<String> {
    (count > 0).then(text)
}

fn lettering_notes(report: &SheetReport) -> impl Iterator<Item = String> {
    let (unnamed, sides) = (&report.unnamed_pieces, report.unnumbered_sides);
    let names =
        note(unnamed.len(), || format!("no room for the names of pieces {}", piece_list(unnamed)));
    let numbers =
        note(sides, || format!("no room for {}", counted(sides, "seam number", "seam numbers")));
    let angles = note(report.unmarked_angles, || {
        let folds = counted(report.unmarked_angles, "fold", "folds");
        format!("no room for the angles of {folds}")
    });
    [names, numbers, angles].into_iter().flatten()
}

fn fold_notes(report: &SheetReport) -> impl Iterator<Item = String> {
    let flat = note(report.flat_folds, || {
        counted(report.flat_folds, "fold is flat and was", "folds are flat and were")
            + " not scored"
    });
    let unscored = note(report.unscored_folds, || {
        counted(
            report.unscored_folds,
            "fold is shorter than what is left out at its ends and was not scored",
            "folds are shorter than what is left out at their ends and were not scored",
        )
    });
    [flat, unscored].into_iter().flatten()
}

fn contour_notes(report: &SheetReport) -> impl Iterator<Item = String> {
    let lost = note(report.lost_holes, || {
        counted(
            report.lost_holes,
            "hole is narrower than the kerf and was",
            "holes are narrower than the kerf and were",
        ) + " left out"
    });
    let narrow = note(report.narrow_holes, || {
        counted(report.narrow_holes, "hole of a piece is", "holes of pieces are")
            + " narrow or less than 1 mm beside another cut: a larger model or other seams avoid that"
    });
    let closed = note(report.closed_notches, || {
        counted(report.closed_notches, "notch is", "notches are")
            + " narrower than the kerf and not cut: flaps are connected there"
    });
    let widened = note(report.widened_notches, || {
        counted(report.widened_notches, "slit or notch is", "slits and notches are")
            + " too narrow for a closed cut and cut wider"
    });
    let uncut = note(report.uncut_seams.len(), || {
        let seams = counted(report.uncut_seams.len(), "seam is", "seams are");
        let list = edge_list(&report.uncut_seams);
        format!("{seams} left uncut, as both sides lie on one another: {list}")
    });
    [lost, narrow, closed, widened, uncut].into_iter().flatten()
}

fn layout_notes(report: &SheetReport) -> impl Iterator<Item = String> {
    let stopped = note(usize::from(report.is_stopped), || {
        "the search was stopped; this is the best layout so far".to_owned()
    });
    let spacing = report.narrow_spacing.map(|[left, web]| {
        let left = (left * 1000.0).round() / 1000.0;
        format!(
            "only {left} mm are left between parts, less than the {web} mm that the material \
            wants: raise the spacing"
        )
    });
    let shared = (report.shared_length * 10.0).round() / 10.0;
    let shared = note(usize::from(shared > 0.0), || {
        format!("{shared} mm of cuts are shared by two parts and cut once")
    });
    let widened = note(report.widened_pieces.len(), || {
        format!(
            "lines of pieces cross, so that they take more room on the sheet, and no other lies in \
            their holes: {}",
            piece_list(&report.widened_pieces)
        )
    });
    [stopped, spacing, shared, widened].into_iter().flatten()
}

/// Folds that are scored too near to each other, and what to do.
fn near_text(near: &NearScores) -> String {
    let short = |mm: f64| (mm * 100.0).round() / 100.0;
    let limit = short(near.limit);
    let pairs = (near.pairs > 0).then(|| {
        let pairs = counted(near.pairs, "pair of folds is", "pairs of folds are");
        format!("{pairs} scored nearer than {limit} mm, the nearest {} mm", short(near.least))
    });
    let fans = (near.fans.pairs > 0).then(|| {
        let pairs = counted(near.fans.pairs, "pair of folds leaves", "pairs of folds leave");
        format!(
            "{pairs} one corner and {} nearer than {limit} mm for more than {} mm, up to {} mm",
            if near.fans.pairs == 1 { "runs" } else { "run" },
            short(near.fans.reach),
            short(near.fans.longest)
        )
    });
    let both: Vec<String> = pairs.into_iter().chain(fans).collect();
    format!(
        "{}, on {}; fewer rounds, a larger model or --hinge {}mm give it room",
        both.join("; "),
        piece_list(&near.pieces),
        short(2.0 * near.limit)
    )
}

/// The same where the material is not known.
fn near_note(report: &SheetReport) -> Option<String> {
    let near = report.near_scores.as_ref().filter(|near| !near.is_known)?;
    Some(format!("{} (as on card; --material tells more)", near_text(near)))
}

/// What the info layer lacks.
fn info_notes(report: &SheetReport) -> impl Iterator<Item = String> {
    let lacks = |count: usize, what: &str| {
        let sheets = counted(count, "sheet has", "sheets have");
        note(count, || {
            format!(
                "{sheets} no room for {what} and {} without",
                if count == 1 { "is" } else { "are" }
            )
        })
    };
    let reference = lacks(report.sheets_without_reference, "a reference square");
    let marks = note(report.sheets_without_marks, || {
        let sheets = counted(report.sheets_without_marks, "sheet has", "sheets have");
        format!(
            "{sheets} no room for registration marks; --margin 15mm and a sheet of 65mm or more make \
            room"
        )
    });
    let legend = lacks(report.sheets_without_legend, "the whole legend");
    let labels = note(report.unlabelled_lines, || {
        let lines = counted(report.unlabelled_lines, "line", "lines");
        format!("no room for the labels of {lines} on the info layer")
    });
    [reference, marks, legend, labels].into_iter().flatten()
}

/// What became of the joints, in words for the user.
fn joint_notes(joints: &JointReport) -> Vec<String> {
    let mut notes = Vec::new();
    if joints.flaps > 0 {
        let (narrowed, moved) = (joints.narrowed_flaps, joints.moved_flaps);
        notes.push(format!(
            "{}; for lack of room {} narrower and {moved} on the other side",
            counted(joints.flaps, "flap", "flaps"),
            counted(narrowed, "is", "are")
        ));
    }
    if !joints.bare_seams.is_empty() {
        notes.push(format!(
            "no room for flaps at {}: {}",
            counted(joints.bare_seams.len(), "seam", "seams"),
            edge_list(&joints.bare_seams)
        ));
    }
    if joints.fingered > 0 {
        notes.push(counted(joints.fingered, "seam has", "seams have") + " fingers");
    }
    if joints.tabbed > 0 {
        notes.push(counted(joints.tabbed, "seam has", "seams have") + " tabs and slots");
    }
    let substitute =
        if joints.mitred.is_empty() { "they are stitched" } else { "they are left to be mitred" };
    for (why, words) in [
        (JointFallback::Shallow, "too shallow for fingers or tabs (dihedral angle above 140°)"),
        (JointFallback::Sharp, "too sharp for fingers or tabs (dihedral angle below 30°)"),
        (JointFallback::Concave, "concave, where fingers and tabs cannot meet"),
        (JointFallback::Short, "too short for fingers or a tab"),
        (JointFallback::Narrow, "beside faces too narrow for notches, tabs or slots"),
    ] {
        let seams: Vec<EdgeLabel> =
            joints.fallbacks.iter().filter(|f| f.1 == why).map(|f| f.0).collect();
        if !seams.is_empty() {
            let count = counted(seams.len(), "seam is", "seams are");
            notes.push(format!("{count} {words}; {substitute}: {}", edge_list(&seams)));
        }
    }
    notes.extend(mitre_note(&joints.mitred));
    if joints.hole_pairs + joints.lost_hole_pairs > 0 {
        let (made, lost) = (joints.hole_pairs, joints.lost_hole_pairs);
        let made = counted(made, "pair", "pairs");
        notes.push(format!("{made} of holes; {lost} more had no room on both sides"));
    }
    notes
}

/// What to take off the square edges of mitred seams, one angle after the other.
fn mitre_note(mitred: &[(EdgeLabel, f64)]) -> Option<String> {
    let mut by_angle: std::collections::BTreeMap<i64, Vec<EdgeLabel>> =
        std::collections::BTreeMap::new();
    for &(edge, degrees) in mitred {
        by_angle.entry((10.0 * degrees).round() as i64).or_default().push(edge);
    }
    let angle = |(tenths, edges): (&i64, &Vec<EdgeLabel>)| {
        format!("{}° at {}", *tenths as f64 / 10.0, edge_list(edges))
    };
    let angles: Vec<String> = by_angle.iter().map(angle).collect();
    (!angles.is_empty())
        .then(|| format!("mitre, off the square edge of either side: {}", angles.join("; ")))
}

/// The first names of a list of edges.
fn edge_list(edges: &[EdgeLabel]) -> String {
    const LISTED: usize = 12;
    let mut text =
        edges.iter().take(LISTED).map(ToString::to_string).collect::<Vec<_>>().join(", ");
    if edges.len() > LISTED {
        text += ", …";
    }
    text
}
