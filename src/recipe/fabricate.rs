//! From a mesh to pieces on sheets: chooses the seams, unfolds, and divides what no sheet can hold.

use std::collections::BTreeSet;

use serde::Deserialize;

use super::StepFailure;
use super::divide::{Room, folds_to_open};
use crate::measure::{edge_length, fold_angle};
use crate::mesh::{EdgeId, EdgeMap, FaceMap, Mesh};
use crate::net::{Net, PieceId};
use crate::progress::Progress;
use crate::seam::least_matching_by;
use crate::select::{Context, Made, Selection};
use crate::sheet::{SheetError, SheetParams, SheetSet, lay_out};
use crate::unfold::{PiecesMode, Seams, Source, UnfoldParams, unfold};

/// Which edges open. Without either, marked seams of the file are used; without marks the unfolder chooses.
#[derive(Debug, Clone, Default, clap::Args, Deserialize)]
pub struct FabricateParams {
    /// Edges to open, in the selection language; others open only where a piece cannot lie flat without.
    #[arg(long, value_name = "SELECTION", conflicts_with = "folds")]
    #[serde(default)]
    pub seams: Option<Selection>,
    /// Edges to keep as folds (`matching`, `hamiltonian`, `strip`, …); all others open.
    #[arg(long, value_name = "SELECTION")]
    #[serde(default)]
    pub folds: Option<Selection>,
}

/// Pieces, and the sheets that hold them.
#[derive(Debug, Clone)]
pub struct Fabrication {
    /// The pieces with their proof.
    pub net: Net,
    /// Layout and drawings; empty without sheets.
    pub sheets: SheetSet,
    /// How the seams were chosen, in words for the user.
    pub seams: &'static str,
    /// How many folds were opened because a piece was too large for the sheet.
    pub divided: usize,
}

/// A D-form folds far less than it is seamed: the mean seam must turn at least this many times as much as the mean fold.
const D_FORM_CONTRAST: f64 = 4.0;

/// Unfolds a mesh, in millimetres, and lays the pieces out. Pieces too large for the sheet are opened at the fold that
/// divides their area best until they fit.
///
/// # Errors
/// What selecting, unfolding and laying out can refuse; a single face too large for the sheet is
/// [`SheetError::PiecesTooLarge`] with the size that it needs.
pub fn fabricate(
    mesh: &Mesh,
    made: Option<&Made>,
    (params, choice, sheet): (&UnfoldParams, &FabricateParams, &SheetParams),
    source: &Source<'_>,
    progress: &dyn Progress,
) -> Result<Fabrication, StepFailure> {
    let (mut seams, words) = choose_seams(mesh, made, params, choice)?;
    let mut params = params.clone();
    let mut divided = 0;
    loop {
        let net = unfold(mesh, &seams, &params, source, progress)?;
        match lay_out(&net, sheet) {
            Ok(sheets) => return Ok(Fabrication { net, sheets, seams: words, divided }),
            Err(SheetError::PiecesTooLarge { pieces, width, height, margin }) if pieces.iter().all(|p| p.faces > 1) => {
                let mut open: BTreeSet<usize> = net.seams.iter().map(|s| s.id.0).collect();
                let before = open.len();
                for too_large in &pieces {
                    open.extend(room(sheet).into_iter().flat_map(|room| folds_to_open(&net, too_large.piece, room)));
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

fn choose_seams(
    mesh: &Mesh,
    made: Option<&Made>,
    params: &UnfoldParams,
    choice: &FabricateParams,
) -> Result<(Seams, &'static str), StepFailure> {
    let context = Context { mesh, made };
    if let Some(seams) = &choice.seams {
        return Ok((Seams::Open(seams.edges(&context)?), "the edges that were selected open"));
    }
    if let Some(folds) = &choice.folds {
        return Ok((Seams::Folds(folds.edges(&context)?), "all edges but the selected folds open"));
    }
    let marked = Seams::marked(mesh);
    if marked != Seams::Free {
        return Ok((marked, "the seams that the file marks open"));
    }
    // Cutting a matching over and over leaves strips; where they reach every face, they are the pieces.
    if params.pieces == PiecesMode::Auto
        && let Some(made) = made
        && strips_reach_every_face(mesh, &made.strip)
    {
        return Ok((Seams::Folds(made.strip.clone()), "the strips that the last cut made fold, all other edges open"));
    }
    if params.pieces == PiecesMode::Auto
        && let Some(folds) = d_form_folds(mesh)
    {
        return Ok((Seams::Folds(folds), "the model is a D-form: its dull edges fold, all others open"));
    }
    Ok((Seams::Free, "the unfolder chose the seams"))
}

fn strips_reach_every_face(mesh: &Mesh, strip: &[EdgeId]) -> bool {
    let mut is_reached = FaceMap::filled(mesh.face_slots(), false);
    for f in strip.iter().flat_map(|&e| mesh.edge_faces(e)) {
        is_reached[f] = true;
    }
    mesh.is_closed() && mesh.faces().all(|f| is_reached[f])
}

/// The folds of a D-form: a closed 3-valent mesh whose dullest perfect matching of edges is clearly duller than the rest.
fn d_form_folds(mesh: &Mesh) -> Option<Vec<EdgeId>> {
    if !mesh.is_closed() || mesh.vertices().any(|v| mesh.valence(v) != 3) {
        return None;
    }
    // By angle alone: with the length as a factor, short sharp edges would be lighter than the long dull folds of a strip.
    let folds = least_matching_by(mesh, |e| fold_angle(mesh, e).unwrap_or(0.0).abs()).ok()?;
    let mut is_fold = EdgeMap::filled(mesh.edge_slots(), false);
    for &e in &folds {
        is_fold[e] = true;
    }
    let mean = |wanted: bool| {
        let edges = mesh.edges().filter(|&e| is_fold[e] == wanted);
        let (turn, length) = edges.fold((0.0, 0.0), |(turn, length), e| {
            let l = edge_length(mesh, e);
            (turn + l * fold_angle(mesh, e).unwrap_or(0.0).abs(), length + l)
        });
        turn / length
    };
    (mean(false) > D_FORM_CONTRAST * mean(true)).then_some(folds)
}

/// The room inside the margin of a sheet, kerf included; `None` without sheets.
fn room(sheet: &SheetParams) -> Option<Room> {
    let inside = sheet.sheet.mm()? - 2.0 * sheet.margin.mm() - sheet.kerf.mm();
    Some(Room { longer: inside.max_element(), shorter: inside.min_element() })
}

/// The name under which a piece is shown.
pub(super) fn piece_list(ids: &[PieceId]) -> String {
    ids.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
