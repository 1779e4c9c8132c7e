//! D-forms from outlines: what is asked for, and the body with its pieces on sheets.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use serde::Deserialize;

use super::glue_file::read_glue_file;
use super::merged_net::without_blank_folds;
use super::outline_source::read_outline;
use super::outlines_error::OutlinesError;
use super::rim_place::RimPlace;
use super::{FabricateParams, FabricateSettings, Fabrication, MakeError, Output, fabricate};
use crate::gluing::{Glued, Gluing, GluingError, Outline, glue, planar_body};
use crate::measure::size;
use crate::mesh::Mesh;
use crate::picture::{Cell, RenderParams, render_strip};
use crate::progress::Progress;
use crate::select::Selection;
use crate::sheet::{SheetParams, lay_out_watched};
use crate::unfold::{MeshSource, UnfoldParams, prove};
use crate::units::{Angle, counted};

/// What becomes of outlines whose perimeters differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Fit {
    /// The second is scaled to the perimeter of the first; sides of seams in a gluing file may
    /// differ by a thousandth.
    #[default]
    Scale,
    /// They are refused.
    Exact,
}

/// A D-form from flat outlines instead of a solid.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct OutlineParams {
    /// Outlines that are joined rim to rim, two, or one with --zip: SVG or DXF files with one
    /// closed line each, lists of points (.csv, x,y on each line), or names: circle, ellipse-2x1,
    /// superellipse-2x1-4, rounded-rectangle-2x1-0.3, rectangle-2x1, lens-0.5, regular-7,
    /// trefoil-0.25, peanut-0.25, egg-0.2. A size may follow after @, the largest extent:
    /// circle@180mm; names are 100 mm without
    #[arg(long, num_args = 1..=2, value_name = "OUTLINE")]
    #[serde(default)]
    pub outlines: Vec<String>,
    /// Which place of the second rim meets the first point of the first: a part of the rim (0.25,
    /// 1/3) or a length (40mm)
    #[arg(long, value_name = "PLACE", allow_negative_numbers = true)]
    #[serde(default)]
    pub start: Option<RimPlace>,
    /// What becomes of perimeters that differ
    #[arg(long, value_enum, default_value = "scale")]
    #[serde(default)]
    pub fit: Fit,
    /// Zip one outline shut from this place of its rim; it becomes a D-form of one piece
    #[arg(long, value_name = "PLACE", allow_negative_numbers = true)]
    #[serde(default)]
    pub zip: Option<RimPlace>,
    /// Chords on the longest rim, 12 to 4000; how far their corners leave the outline is a note
    #[arg(long, default_value_t = DEFAULT_POINTS, value_name = "N")]
    #[serde(default = "default_points")]
    pub points: usize,
    /// A file that says how any number of outlines are joined
    #[arg(long, value_name = "FILE.toml", conflicts_with_all = ["outlines", "start", "zip"])]
    #[serde(default)]
    pub glue: Option<PathBuf>,
    /// A body of so many planes for each piece instead, for sheets that do not bend
    #[arg(long, value_name = "N")]
    #[serde(default)]
    pub planar: Option<usize>,
    /// Lines along which a piece bends by less are not scored
    #[arg(long, default_value = "8deg", value_name = "ANGLE")]
    #[serde(default = "default_bending")]
    pub bending: Angle,
}

const DEFAULT_POINTS: usize = 240;
const DEFAULT_BENDING: Angle = Angle::from_degrees(8.0);
/// Sides of seams in a gluing file may differ by that part of a rim unless they must be exact.
const SLACK: f64 = 1e-3;

fn default_points() -> usize {
    DEFAULT_POINTS
}

fn default_bending() -> Angle {
    DEFAULT_BENDING
}

impl Default for OutlineParams {
    fn default() -> Self {
        Self {
            outlines: Vec::new(),
            start: None,
            fit: Fit::default(),
            zip: None,
            points: DEFAULT_POINTS,
            glue: None,
            planar: None,
            bending: DEFAULT_BENDING,
        }
    }
}

impl OutlineParams {
    /// Whether a D-form is to be made from outlines.
    pub fn is_given(&self) -> bool {
        !self.outlines.is_empty() || self.glue.is_some()
    }

    /// An option that only means something with outlines, where one is given without.
    pub fn without_outlines(&self) -> Option<&'static str> {
        let usual = Self::default();
        [
            ("start", self.start.is_some()),
            ("zip", self.zip.is_some()),
            ("planar", self.planar.is_some()),
            ("fit", self.fit != usual.fit),
            ("points", self.points != usual.points),
            ("bending", self.bending != usual.bending),
        ]
        .into_iter()
        .find(|&(_, is_given)| is_given && !self.is_given())
        .map(|(name, _)| name)
    }
}

/// A D-form from outlines, ready to be written.
#[derive(Debug, Clone)]
pub struct OutlinedDform {
    /// The body, or the planes around it.
    pub mesh: Mesh,
    /// Its pieces on sheets.
    pub fabrication: Fabrication,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// Reads and joins outlines, solves for the body and lays its pieces out. `folder` is where
/// relative file names start from.
///
/// # Errors
/// [`MakeError::Gluing`] when they close to no body, [`MakeError::Outlines`] for files and options,
/// and what laying out can refuse.
pub fn outlined_dform(
    params: &OutlineParams,
    folder: &Path,
    sheet: &SheetParams,
    progress: &dyn Progress,
) -> Result<OutlinedDform, MakeError> {
    let (gluing, mut notes) = gluing(params, folder)?;
    let glued = glue(&gluing, progress)?;
    notes.extend(body_notes(&gluing, &glued));
    match params.planar {
        Some(planes) => planar(&glued, planes, sheet, notes, progress),
        None => curved(glued, params, sheet, notes, progress),
    }
}

/// The outlines and how they are joined.
fn gluing(params: &OutlineParams, folder: &Path) -> Result<(Gluing, Vec<String>), MakeError> {
    let options = |what: &str, advice| OutlinesError::Options { what: what.to_owned(), advice };
    if params.planar.is_some() && params.bending != DEFAULT_BENDING {
        let advice = "planes fold at every edge: leave out --bending";
        return Err(options("--bending is given with --planar", advice).into());
    }
    if let Some(file) = &params.glue {
        if !params.outlines.is_empty() || params.start.is_some() || params.zip.is_some() {
            let what = "a gluing file is given with outlines, a start or a zip";
            return Err(options(what, "leave these out: the file says what is joined").into());
        }
        let slack = if params.fit == Fit::Scale { SLACK } else { 0.0 };
        let gluing = read_glue_file(&folder.join(file), params.points, slack)?;
        let worst = gluing
            .seams
            .iter()
            .map(|s| ((s.a.to - s.a.from) - (s.b.to - s.b.from)).abs())
            .fold(0.0, f64::max);
        let whole = gluing.outlines.iter().map(Outline::length).fold(0.0, f64::max);
        let notes = (worst > 1e-9 * whole)
            .then(|| format!("sides of seams that differ by up to {worst:.4} mm were made equal"));
        return Ok((gluing, notes.into_iter().collect()));
    }
    let outlines: Vec<Outline> = params
        .outlines
        .iter()
        .map(|source| read_outline(source, folder))
        .collect::<Result<_, _>>()?;
    match (<[Outline; 1]>::try_from(outlines.clone()), params.zip) {
        (Ok([outline]), Some(zip)) if params.start.is_none() => {
            let start = zip.mm(outline.length());
            Ok((Gluing::zip(outline, start, params.points), Vec::new()))
        }
        (Ok(_), _) => Err(options(
            "one outline is given",
            "give --zip PLACE to close it by itself and no --start, or a second outline",
        )
        .into()),
        (Err(_), Some(_)) => Err(options(
            "two outlines cannot be zipped",
            "give one outline with --zip, or two without",
        )
        .into()),
        (Err(outlines), None) => {
            let [a, b] = <[Outline; 2]>::try_from(outlines).map_err(|outlines| {
                options(
                    &format!("{} outlines are given", outlines.len()),
                    "give two, one with --zip, or a gluing file with --glue",
                )
            })?;
            let (b, notes) = fitted(&a, b, params.fit)?;
            let start = params.start.map_or(0.0, |start| start.mm(b.length()));
            Ok((Gluing::pair(a, b, start, params.points), notes))
        }
    }
}

/// The second outline with the perimeter of the first.
fn fitted(a: &Outline, b: Outline, fit: Fit) -> Result<(Outline, Vec<String>), OutlinesError> {
    let (whole, other) = (a.length(), b.length());
    let is_equal = (whole - other).abs() <= 1e-9 * whole;
    if !is_equal && fit == Fit::Exact {
        let names = [a, &b].map(|o| o.name().to_owned());
        return Err(OutlinesError::Perimeters { names, mm: [whole, other] });
    }
    let note = (!is_equal).then(|| {
        format!(
            "{} was scaled by {:.6}, from a perimeter of {other:.3} mm to the {whole:.3} mm of {}",
            b.name(),
            whole / other,
            a.name()
        )
    });
    Ok((b.scaled(whole / other), note.into_iter().collect()))
}

fn body_notes(gluing: &Gluing, glued: &Glued) -> Vec<String> {
    let facts = &glued.facts;
    let off: Vec<String> = gluing
        .outlines
        .iter()
        .zip(&facts.off_outline)
        .map(|(outline, off)| format!("{} by {off:.4} mm", outline.name()))
        .collect();
    vec![
        format!(
            "the one convex body that these rims close to: {} corners, edges true to {:.1e} of the \
            size, angles to {:.1e} rad",
            facts.corners, facts.edge_error, facts.angle_error
        ),
        format!(
            "so that chords are equal on both sides, they leave the outlines: {}",
            off.join(", ")
        ),
    ]
}

fn curved(
    glued: Glued,
    params: &OutlineParams,
    sheet: &SheetParams,
    mut notes: Vec<String>,
    progress: &dyn Progress,
) -> Result<OutlinedDform, MakeError> {
    let Glued { mesh, mut net, .. } = glued;
    net.proof = prove(&mesh, &net).map_err(|fault| GluingError::NotTrue {
        fault: format!("the pieces are not those of the body: {fault}"),
    })?;
    let (drawn, blank) = without_blank_folds(&net, params.bending);
    notes.push(format!(
        "{} by {}° or more and scored; {blank} less, which is left to the sheet",
        counted(drawn.folds.len(), "ruling is bent", "rulings are bent"),
        params.bending.degrees()
    ));
    let sheets = lay_out_watched(&drawn, sheet, progress)?;
    let words = "the rims are the seams: the pieces are the outlines";
    let fabrication = Fabrication { net, sheets, seams: words, divided: 0, sources: Vec::new() };
    notes.extend(fabrication.notes());
    Ok(OutlinedDform { mesh, fabrication, notes })
}

fn planar(
    glued: &Glued,
    planes: usize,
    sheet: &SheetParams,
    mut notes: Vec<String>,
    progress: &dyn Progress,
) -> Result<OutlinedDform, MakeError> {
    let body = planar_body(glued, planes)?;
    notes.push(format!(
        "{planes} planes for each piece: the corners lie up to {:.3} mm ({:.2} % of the size) \
        outside the smooth body",
        body.distance,
        100.0 * body.distance / size(&body.mesh).length()
    ));
    if body.without_face > 0 || body.not_three > 0 {
        notes.push(format!(
            "{} planes bound no face; at {} corners other than three faces meet",
            body.without_face, body.not_three
        ));
    }
    let choice = FabricateParams {
        folds: Selection::of_edges(body.folds.iter().copied()),
        ..FabricateParams::default()
    };
    let settings = FabricateSettings { unfold: &UnfoldParams::default(), choice: &choice, sheet };
    let fabrication = fabricate(&body.mesh, None, &settings, &MeshSource::default(), progress)?;
    notes.extend(fabrication.notes());
    Ok(OutlinedDform { mesh: body.mesh, fabrication, notes })
}

/// How many places a list shows, and pictures in a row.
const LISTED: usize = 16;
const COLUMNS: u32 = 6;
/// Chords of the bodies on a list.
const LIST_POINTS: usize = 96;

/// A picture of the pieces and of the bodies for places all around the rim, and a line of text for
/// each; the file is named list.png.
///
/// # Errors
/// As [`outlined_dform`]; places without a body are told and no error.
pub fn outline_list(
    params: &OutlineParams,
    folder: &Path,
    render: &RenderParams,
    progress: &dyn Progress,
) -> Result<(Output, Vec<String>), MakeError> {
    let has_place = params.start.is_some() || params.zip.is_some();
    if params.glue.is_some() || params.planar.is_some() || has_place {
        let what = "a list shows places all around, on one or two outlines".to_owned();
        let advice = "leave --glue, --planar, --start and --zip out";
        return Err(OutlinesError::Options { what, advice }.into());
    }
    let is_zip = params.outlines.len() == 1;
    let (mut cells, mut lines) = (Vec::new(), Vec::new());
    for k in 0..LISTED {
        progress.report("trying places", k, LISTED);
        if progress.is_cancelled() {
            return Err(GluingError::Cancelled.into());
        }
        let part = k as f64 / LISTED as f64;
        let place = Some(RimPlace::Part(part));
        let (start, zip) = if is_zip { (None, place) } else { (place, None) };
        let points = params.points.min(LIST_POINTS);
        let here = OutlineParams { start, zip, points, ..params.clone() };
        let (gluing, notes) = gluing(&here, folder)?;
        if k == 0 {
            lines.extend(notes);
            for outline in &gluing.outlines {
                cells.push(Cell { mesh: flat_piece(outline)?, label: "PIECE".to_owned() });
            }
        }
        let told = match glue(&gluing, progress) {
            Ok(glued) => {
                let extent = size(&glued.mesh);
                cells.push(Cell { mesh: glued.mesh, label: format!("{part}") });
                format!("{:.1} x {:.1} x {:.1} mm", extent.x, extent.y, extent.z)
            }
            Err(GluingError::Cancelled) => return Err(GluingError::Cancelled.into()),
            Err(error) => error.to_string(),
        };
        lines.push(format!("{} {part}: {told}", if is_zip { "zip" } else { "start" }));
    }
    let wide = RenderParams { width: render.width.max(1600), ..render.clone() };
    let picture = render_strip(&cells, COLUMNS, &wide)?.to_png();
    Ok((("list.png".to_owned(), picture), lines))
}

/// A piece lying flat, as a mesh.
fn flat_piece(outline: &Outline) -> Result<Mesh, MakeError> {
    let n = LIST_POINTS;
    let step = outline.length() / n as f64;
    let points = (0..n).map(|i| outline.at(i as f64 * step).extend(0.0));
    Mesh::from_faces(points, [(0..n).collect::<Vec<_>>()]).map_err(MakeError::State)
}
