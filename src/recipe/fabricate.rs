//! From a mesh to pieces on sheets: chooses the seams, unfolds, and divides what no sheet can hold.

use std::collections::BTreeSet;

use serde::Deserialize;

use super::StepFailure;
use crate::measure::{edge_length, fold_angle};
use crate::mesh::{EdgeId, Mesh};
use crate::net::{Net, Piece, PieceId};
use crate::progress::Progress;
use crate::seam::least_matching;
use crate::select::{Context, Made, Selection};
use crate::sheet::{SheetError, SheetParams, SheetSet, TooLarge, lay_out};
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
            Err(SheetError::PiecesTooLarge { pieces, .. }) if pieces.iter().all(|p| p.faces > 1) => {
                let before = divided;
                let mut open: BTreeSet<usize> = net.seams.iter().map(|s| s.id.0).collect();
                for too_large in &pieces {
                    divided += usize::from(best_division(&net, too_large).is_some_and(|e| open.insert(e)));
                }
                if divided == before {
                    return Err(lay_out(&net, sheet).map(|_| StepFailure::NoMesh).unwrap_or_else(Into::into));
                }
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
    if params.pieces == PiecesMode::Auto
        && let Some(folds) = d_form_folds(mesh)
    {
        return Ok((Seams::Folds(folds), "the model is a D-form: its dull edges fold, all others open"));
    }
    Ok((Seams::Free, "the unfolder chose the seams"))
}

/// The folds of a D-form: a closed 3-valent mesh whose least perfect matching of edges is clearly duller than the rest.
fn d_form_folds(mesh: &Mesh) -> Option<Vec<EdgeId>> {
    if !mesh.is_closed() || mesh.vertices().any(|v| mesh.valence(v) != 3) {
        return None;
    }
    let folds = least_matching(mesh).ok()?;
    let mut is_fold = crate::mesh::EdgeMap::filled(mesh.edge_slots(), false);
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

/// The fold of a piece whose opening divides its area most evenly.
fn best_division(net: &Net, too_large: &TooLarge) -> Option<usize> {
    let piece = net.pieces.iter().find(|p| p.id == too_large.piece)?;
    let tree = PieceTree::new(net, piece);
    let whole: f64 = tree.areas.iter().sum();
    let below = tree.areas_below();
    (1..piece.faces.len())
        .filter_map(|i| Some((tree.parent_edge[i]?, (whole / 2.0 - below[i]).abs())))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(edge, _)| edge)
}

/// The faces of a piece as a tree of folds, in the order in which they were reached from the first.
struct PieceTree {
    order: Vec<usize>,
    parent: Vec<usize>,
    parent_edge: Vec<Option<usize>>,
    areas: Vec<f64>,
}

impl PieceTree {
    fn new(net: &Net, piece: &Piece) -> Self {
        let place: std::collections::HashMap<usize, usize> =
            piece.faces.iter().enumerate().map(|(i, f)| (f.face, i)).collect();
        let mut neighbours: Vec<Vec<(usize, usize)>> = vec![Vec::new(); piece.faces.len()];
        for fold in net.folds.iter().filter(|f| f.piece == piece.id) {
            let [a, b] = fold.faces.map(|f| place[&f]);
            neighbours[a].push((b, fold.id.0));
            neighbours[b].push((a, fold.id.0));
        }
        let n = piece.faces.len();
        let areas = piece.faces.iter().map(|f| crate::geom::polygon::signed_area(&f.polygon)).collect();
        let mut tree = Self { order: vec![0], parent: vec![0; n], parent_edge: vec![None; n], areas };
        let mut seen = vec![false; n];
        seen[0] = true;
        let mut next = 0;
        while let Some(&f) = tree.order.get(next) {
            next += 1;
            for &(g, edge) in &neighbours[f] {
                if !std::mem::replace(&mut seen[g], true) {
                    (tree.parent[g], tree.parent_edge[g]) = (f, Some(edge));
                    tree.order.push(g);
                }
            }
        }
        tree
    }

    /// For each face the area of what hangs on it.
    fn areas_below(&self) -> Vec<f64> {
        let mut below = self.areas.clone();
        for &f in self.order.iter().skip(1).rev() {
            below[self.parent[f]] += below[f];
        }
        below
    }
}

/// The name under which a piece is shown.
pub(super) fn piece_list(ids: &[PieceId]) -> String {
    ids.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ")
}
