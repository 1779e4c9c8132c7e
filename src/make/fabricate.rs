//! From a mesh to pieces on sheets: chooses the seams, unfolds, and divides what no sheet can hold.

use std::collections::BTreeSet;
use std::path::Path;

use serde::Deserialize;

use super::MakeError;
use super::divide::{Room, folds_to_open};
use super::flat_folds;
use super::seam_choice::SeamChoice;
use crate::io::order_json;
use crate::mesh::{EdgeId, FaceMap, Mesh};
use crate::net::{Fold, Net, PieceId, Seam};
use crate::progress::Progress;
use crate::select::{Context, NewElements, Selection};
use crate::sheet::{FoldWay, SheetError, SheetParams, SheetSet, lay_out_watched};
use crate::unfold::{
    FLAT, MeshSource, PiecesMode, Seams, UnfoldParams, check_folded, check_seams, seams_by_angle,
    unfold,
};
use crate::units::{Angle, Length};

/// Living hinges are as wide as so many thicknesses, where nothing is said.
const HINGE: f64 = 10.0;

/// How the seams were chosen, in words.
const STRIPS: &str = "the strips that the last cut made fold, all other edges open";
const SELECTED_FOLDS: &str = "all edges but the selected folds open";

/// Which edges open. Without either, marked seams of the file are used; without marks the unfolder
/// chooses.
#[derive(Debug, Clone, Default, clap::Args, Deserialize)]
pub struct FabricateParams {
    /// Edges to open: a selection, or a file (OBJ with `l` lines, or `v0 v1` per line); others open
    /// only where faces overlap.
    #[arg(long, value_name = "SELECTION|FILE", conflicts_with = "folds")]
    #[serde(default)]
    pub seams: Option<SeamChoice>,
    /// Edges to keep as folds (`matching`, `hamiltonian`, `strip`, …); all others open.
    #[arg(long, value_name = "SELECTION")]
    #[serde(default)]
    pub folds: Option<Selection>,
    /// Edges that fold by more than this angle open, e.g. 40deg, and the shortest ways from them to
    /// every vertex around which the faces cannot lie flat; above 0. For meshes with more than
    /// three edges at a vertex.
    #[arg(long, value_name = "ANGLE", conflicts_with_all = ["seams", "folds"])]
    #[serde(default)]
    pub sharp: Option<Angle>,
    /// Edges that must stay together as folds, whatever else opens; an error where they cannot.
    #[arg(long, value_name = "SELECTION")]
    #[serde(default)]
    pub keep: Option<Selection>,
    /// Edges that must open, whatever else does.
    #[arg(long, value_name = "SELECTION")]
    #[serde(default)]
    pub cut: Option<Selection>,
}

impl FabricateParams {
    /// Whether the strips of the last cut are the folds, by name or because nothing else was said.
    pub fn is_of_strips(&self) -> bool {
        self.folds.as_ref().is_none_or(|folds| folds.to_string() == "strip")
            && self.seams.is_none()
            && self.sharp.is_none()
            && self.keep.is_none()
            && self.cut.is_none()
    }

    /// The same with a seam file looked for from a folder.
    pub(crate) fn in_folder(&self, folder: &Path) -> Self {
        Self { seams: self.seams.as_ref().map(|seams| seams.in_folder(folder)), ..self.clone() }
    }
}

/// Pieces, and the sheets that hold them.
#[derive(Debug, Clone)]
pub struct Fabrication {
    /// The pieces with their proof.
    pub net: Net,
    /// Layout and drawings; empty without sheets.
    pub sheets: SheetSet,
    /// How the seams were chosen, in words for the user; empty where there was nothing to choose.
    pub seams: &'static str,
    /// How many folds were opened because a piece was too large for the sheet.
    pub divided: usize,
    /// For each piece the file that it comes from; empty when the pieces were unfolded here.
    pub sources: Vec<order_json::OrderSource>,
}

/// What a fabrication is asked for.
#[derive(Debug, Clone, Copy)]
pub struct FabricateSettings<'a> {
    /// How the mesh is unfolded.
    pub unfold: &'a UnfoldParams,
    /// Which seams are taken.
    pub choice: &'a FabricateParams,
    /// How the pieces lie on sheets, and what is drawn on them.
    pub sheet: &'a SheetParams,
}

impl Fabrication {
    /// Whether the folds were named, by the user or by the last cut.
    pub fn is_of_given_folds(&self) -> bool {
        [STRIPS, SELECTED_FOLDS].contains(&self.seams)
    }

    /// The seams of a model that was unfolded here at which nothing bends: nobody wants them, but
    /// without them faces would overlap, or they were asked for.
    pub(super) fn flat_seams(&self) -> Vec<String> {
        if self.seams.is_empty() || !self.sources.is_empty() {
            return Vec::new();
        }
        let is_flat = |s: &&Seam| s.fold_angle.to_radians().abs() <= FLAT;
        self.net.seams.iter().filter(is_flat).map(|s| s.id.to_string()).collect()
    }
}

/// Unfolds a mesh, in millimetres, and lays the pieces out. Pieces too large for the sheet are
/// opened at the fold that divides their area best until they fit.
///
/// # Errors
/// What selecting, unfolding and laying out can refuse; a single face too large for the sheet is
/// [`SheetError::PiecesTooLarge`] with the size that it needs.
pub fn fabricate(
    mesh: &Mesh,
    made: Option<&NewElements>,
    settings: &FabricateSettings<'_>,
    source: &MeshSource<'_>,
    progress: &dyn Progress,
) -> Result<Fabrication, MakeError> {
    let FabricateSettings { unfold: params, choice, sheet } = *settings;
    sheet.check_sheets()?;
    let context = Context { mesh, made, progress };
    let keep = selected(&context, choice.keep.as_ref())?;
    let (mut seams, mut words) = choose_seams(&context, source, params, choice)?;
    let mut params = params.clone();
    let is_open = matches!(seams, Seams::Free);
    let rigid = sheet.stock.made_of.as_ref().filter(|m| m.rigid && sheet.score.fold.is_none());
    if rigid.is_some() && is_open && params.pieces == PiecesMode::Auto {
        params.pieces = PiecesMode::Faces;
        words = "the material does not fold, so every face is a piece; --fold score or --fold \
            hinge folds it all the same";
    }
    let sheet = &with_hinges(sheet);
    let mut divided = 0;
    loop {
        let net = unfold(mesh, &seams, &params, source, progress)?;
        refuse_rigid_folds(&net, sheet)?;
        match lay_out_watched(&net, sheet, progress) {
            Ok(sheets) => {
                check_folded(&net, &keep)?;
                return Ok(Fabrication { net, sheets, seams: words, divided, sources: Vec::new() });
            }
            Err(SheetError::PiecesTooLarge { pieces, width, height, margin })
                if pieces.iter().all(|p| p.faces > 1) =>
            {
                let mut open: BTreeSet<usize> = net.seams.iter().map(|s| s.id.0).collect();
                let before = open.len();
                for too_large in &pieces {
                    open.extend(
                        room(sheet)
                            .into_iter()
                            .flat_map(|room| folds_to_open(&net, too_large.piece, room)),
                    );
                }
                if open.len() == before {
                    return Err(SheetError::PiecesTooLarge { pieces, width, height, margin }.into());
                }
                divided += open.len() - before;
                seams = Seams::Open(open.into_iter().map(EdgeId::new).collect());
                // The number of pieces now follows from the sheet.
                params.pieces = PiecesMode::Auto;
            }
            Err(error) => return Err(error.into()),
        }
    }
}

/// The pieces of a fabrication on other sheets, as they are: none is divided.
///
/// # Errors
/// What laying out can refuse; [`SheetError::PiecesTooLarge`] for pieces that no sheet can hold.
pub fn lay_out_again(
    made: &Fabrication,
    sheet: &SheetParams,
    progress: &dyn Progress,
) -> Result<Fabrication, MakeError> {
    sheet.check_sheets()?;
    refuse_rigid_folds(&made.net, sheet)?;
    let sheets = lay_out_watched(&made.net, &with_hinges(sheet), progress)?;
    Ok(Fabrication { sheets, ..made.clone() })
}

/// Nothing that bends is cut from a material that does not fold, unless it is said how.
fn refuse_rigid_folds(net: &Net, sheet: &SheetParams) -> Result<(), MakeError> {
    let rigid = sheet.stock.made_of.as_ref().filter(|m| m.rigid && sheet.score.fold.is_none());
    let bends = |fold: &Fold| fold.fold_angle.to_radians().abs() > FLAT;
    match rigid {
        Some(material) if net.folds.iter().any(bends) => {
            let (material, folds) = (material.title.clone(), net.folds.len());
            Err(MakeError::RigidFolds { material, folds })
        }
        _ => Ok(()),
    }
}

/// With `--fold hinge`, living hinges as wide as the material wants them, where nothing is said.
fn with_hinges(sheet: &SheetParams) -> SheetParams {
    let mut sheet = sheet.clone();
    if let (Some(FoldWay::Hinge), None, Some(material)) =
        (sheet.score.fold, sheet.score.hinge, &sheet.stock.made_of)
    {
        sheet.score.hinge = Some(Length::from_mm(HINGE * material.thickness.mm()));
    }
    sheet
}

fn choose_seams(
    context: &Context<'_>,
    source: &MeshSource<'_>,
    params: &UnfoldParams,
    choice: &FabricateParams,
) -> Result<(Seams, &'static str), MakeError> {
    let (mesh, made) = (context.mesh, context.made);
    let [keep, cut] = [&choice.keep, &choice.cut].map(|list| selected(context, list.as_ref()));
    let (keep, cut) = (keep?, cut?);
    if let Some((seams, words)) = given_seams(context, source, choice, [&keep, &cut])? {
        check_seams(mesh, &seams)?;
        return Ok((seams, words));
    }
    if !keep.is_empty() || !cut.is_empty() {
        return Ok((
            Seams::Within { keep, cut },
            "the unfolder chose the seams within what was to be kept and cut",
        ));
    }
    // Cutting a matching over and over leaves strips; where they reach every face, they are the
    // pieces.
    if params.pieces == PiecesMode::Auto
        && let Some(made) = made
        && strips_reach_every_face(mesh, &made.strip)
    {
        return Ok((Seams::Folds(made.strip.clone()), STRIPS));
    }
    if params.pieces == PiecesMode::Auto
        && let Some(folds) = flat_folds::folds(mesh, context.progress)
    {
        return Ok((
            Seams::Folds(folds),
            "the model is a D-form: its flat edges fold, all others open",
        ));
    }
    Ok((Seams::Free, "the unfolder chose the seams"))
}

/// The seams that the user gave, in one way or the other.
fn given_seams(
    context: &Context<'_>,
    source: &MeshSource<'_>,
    choice: &FabricateParams,
    [keep, cut]: [&[EdgeId]; 2],
) -> Result<Option<(Seams, &'static str)>, MakeError> {
    let open = |mut edges: Vec<EdgeId>| {
        edges.extend(cut);
        Seams::Open(edges)
    };
    if let Some(seams) = &choice.seams {
        let edges = seams.edges(context, source.split_vertices)?;
        return Ok(Some((open(edges), "the edges that were selected open")));
    }
    if let Some(angle) = choice.sharp {
        let edges = seams_by_angle(context.mesh, angle.radians());
        return Ok(Some((
            open(edges),
            "sharp edges open, and ways from them to all points that cannot lie flat",
        )));
    }
    if let Some(folds) = &choice.folds {
        let mut edges = folds.edges(context)?;
        edges.extend(keep);
        edges.retain(|e| !cut.contains(e));
        return Ok(Some((Seams::Folds(edges), SELECTED_FOLDS)));
    }
    Ok(match Seams::marked(context.mesh) {
        Seams::Open(marked) => Some((open(marked), "the seams that the file marks open")),
        _ => None,
    })
}

/// The edges of a list that may be missing.
fn selected(context: &Context<'_>, list: Option<&Selection>) -> Result<Vec<EdgeId>, MakeError> {
    Ok(list.map_or(Ok(Vec::new()), |list| list.edges(context))?)
}

fn strips_reach_every_face(mesh: &Mesh, strip: &[EdgeId]) -> bool {
    let mut is_reached = FaceMap::filled(mesh.face_slots(), false);
    for f in strip.iter().flat_map(|&e| mesh.edge_faces(e)) {
        is_reached[f] = true;
    }
    mesh.is_closed() && mesh.faces().all(|f| is_reached[f])
}

/// The room inside the margin of a sheet for a piece with its joints, kerf included; `None` without
/// sheets.
pub(super) fn room(sheet: &SheetParams) -> Option<Room> {
    let inside = sheet.stock.sheet.mm()?
        - 2.0 * (sheet.stock.margin.mm() + sheet.joint_reach())
        - sheet.stock.kerf.mm();
    Some(Room { longer: inside.max_element(), shorter: inside.min_element() })
}

/// The name under which a piece is shown.
pub(super) fn piece_list(ids: &[PieceId]) -> String {
    ids.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
