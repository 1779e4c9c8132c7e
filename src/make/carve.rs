//! Carves a D-form: takes the folds of a choice, cuts them off, and looks whether the pieces lie
//! flat; if not, takes the next.

use std::collections::HashMap;

use super::MakeError;
use super::dform::{DformParams, MatchingChoice};
use crate::measure::{concave_edges, fold_angle};
use crate::mesh::{EdgeId, EdgeMap, Mesh, VertexId};
use crate::op::{OpContext, Scope, TruncateEdgeParams, truncate_edges};
use crate::progress::Progress;
use crate::seam::{
    MATCHING_LIMIT, SeamError, flattest_matching, fold_sum, hamiltonian_folds, least_matching,
    matching, one_piece_folds, piece_count, seam_cycles, table,
};
use crate::select::{NewElements, Selection};
use crate::unfold::{MeshSource, Seams, UnfoldParams, unfold};
use crate::units::counted;

/// Choices of folds that are carved and laid out, at most, until one lies flat in as many pieces as
/// it should.
const TRIED: usize = 24;
/// Up to this many vertices all two-piece seams are candidates; of larger meshes only the best one
/// found.
const LISTED_VERTICES: usize = 64;

/// A carved D-form.
#[derive(Debug, Clone)]
pub struct CarvedDform {
    /// The mesh.
    pub mesh: Mesh,
    /// What carving made; `strip` are the folds that it made.
    pub made: NewElements,
    /// All folds, one at every vertex: the strips, and those that stay sharp.
    pub folds: Vec<EdgeId>,
    /// What the user should know.
    pub notes: Vec<String>,
}

impl CarvedDform {
    /// With notes on how it was chosen before its own.
    fn after(mut self, mut notes: Vec<String>) -> Self {
        notes.append(&mut self.notes);
        Self { notes, ..self }
    }
}

/// Chooses the folds and cuts them off, round after round.
///
/// For two pieces and for one, choices are tried in the order of their fold sums, 24 at most, until
/// the carved pieces lie flat without overlap and no fold has to be opened (but the one that opens
/// a ring); the first choice is kept where none does. On a mesh that is not convex only those folds
/// are cut off whose ends are convex corners, each without touching the rest of the mesh; no plane
/// can shave the others, which stay sharp folds.
///
/// # Errors
/// [`MakeError::Seam`] when the mesh is open, not 3-valent, or has no such choice;
/// [`MakeError::Op`] when it cannot be cut so.
pub fn carve_dform(
    mesh: &Mesh,
    params: &DformParams,
    progress: &dyn Progress,
) -> Result<CarvedDform, MakeError> {
    let Candidates { folds, pieces, mut notes } = candidates(mesh, params.matching, progress)?;
    let (mut first, mut failure) = (None, None);
    let count = folds.len().min(TRIED);
    for (i, folds) in folds.iter().take(TRIED).enumerate() {
        progress.report("trying folds", i, count);
        match carve(mesh, folds, params, progress) {
            Ok(carved)
                if count == 1
                    || pieces.is_none_or(|pieces| lies_flat_in(pieces, &carved, progress)) =>
            {
                if i > 0 {
                    notes.push(format!(
                        "{i} choices of folds with no larger fold sum were passed over: carved, \
                        their pieces overlap"
                    ));
                }
                return Ok(carved.after(notes));
            }
            Ok(carved) => first = first.or(Some(carved)),
            Err(error) => failure = failure.or(Some(error)),
        }
        if progress.is_cancelled() {
            break;
        }
    }
    match (first, failure) {
        (Some(carved), _) => {
            notes.push(format!(
                "{count} choices of folds were carved, but none lies flat unless a further fold \
                opens; the first was taken, \
                 another `--offset` or fewer `--rounds` may do"
            ));
            Ok(carved.after(notes))
        }
        (None, Some(error)) => Err(error),
        (None, None) => Err(SeamError::Empty.into()),
    }
}

/// Choices of folds in the order in which they are tried.
struct Candidates {
    folds: Vec<Vec<EdgeId>>,
    /// How many pieces each is to leave; unknown where any number will do.
    pieces: Option<usize>,
    notes: Vec<String>,
}

fn candidates(
    mesh: &Mesh,
    choice: MatchingChoice,
    progress: &dyn Progress,
) -> Result<Candidates, SeamError> {
    let one = |folds| Candidates { folds: vec![folds], pieces: None, notes: Vec::new() };
    match choice {
        MatchingChoice::Least => least_matching(mesh, progress).map(one),
        MatchingChoice::Flattest => flattest_matching(mesh, progress).map(one),
        MatchingChoice::Row(row) => matching(mesh, row, progress).map(one),
        MatchingChoice::OnePiece => Ok(Candidates {
            folds: one_piece_folds(mesh, progress)?,
            pieces: Some(1),
            notes: Vec::new(),
        }),
        MatchingChoice::TwoPieces => match hamiltonian_folds(mesh, progress) {
            Ok(folds) => Ok(two_pieces(mesh, folds, progress)),
            Err(
                why @ (SeamError::NoHamiltonian { .. }
                | SeamError::SearchStopped { .. }
                | SeamError::SeveralComponents { .. }),
            ) => {
                let notes = vec![format!("the least matching was taken: {why}")];
                Ok(Candidates { notes, ..one(least_matching(mesh, progress)?) })
            }
            Err(error) => Err(error),
        },
    }
}

/// The best two-piece seam first, then all others of a small mesh.
fn two_pieces(mesh: &Mesh, best: Vec<EdgeId>, progress: &dyn Progress) -> Candidates {
    let pieces = piece_count(mesh, &best);
    let mut folds = vec![best];
    if mesh.vertex_count() <= LISTED_VERTICES
        && let Ok(rows) = table(mesh, MATCHING_LIMIT, progress)
    {
        let others = rows
            .into_iter()
            .filter(|r| r.pieces == pieces && r.seam_cycles == 1 && r.folds != folds[0]);
        let others: Vec<_> = others.map(|r| r.folds).collect();
        folds.extend(others);
    }
    Candidates { folds, pieces: Some(pieces), notes: Vec::new() }
}

/// Whether the carved mesh comes apart along its seams into that many pieces, so that no fold opens
/// for an overlap.
fn lies_flat_in(pieces: usize, carved: &CarvedDform, progress: &dyn Progress) -> bool {
    let params = UnfoldParams::default();
    let net = unfold(
        &carved.mesh,
        &Seams::Folds(carved.folds.clone()),
        &params,
        &MeshSource::default(),
        progress,
    );
    net.is_ok_and(|net| net.pieces.len() == pieces)
}

fn carve(
    mesh: &Mesh,
    folds: &[EdgeId],
    params: &DformParams,
    progress: &dyn Progress,
) -> Result<CarvedDform, MakeError> {
    let mut notes = vec![format!(
        "{} with a fold sum of {:.2} rad·mm, {}, {} before carving",
        counted(folds.len(), "fold", "folds"),
        fold_sum(mesh, folds),
        counted(seam_cycles(mesh, folds).len(), "closed seam", "closed seams"),
        counted(piece_count(mesh, folds), "piece", "pieces")
    )];
    let (round, sharp) = rollable(mesh, folds);
    let uncarved = |notes| CarvedDform {
        mesh: mesh.clone(),
        made: NewElements { strip: folds.to_vec(), ..NewElements::default() },
        folds: folds.to_vec(),
        notes,
    };
    if params.rounds == 0 {
        return Ok(uncarved(notes));
    }
    let Some(select) = Selection::of_edges(round.iter().copied()) else {
        notes.push(
            "no fold is cut: none has two convex ends, where a plane could shave it off".to_owned(),
        );
        return Ok(uncarved(notes));
    };
    let scope = if sharp.is_empty() { Scope::Global } else { Scope::Local };
    let cut = TruncateEdgeParams {
        bend: params.bend,
        repeat: params.rounds,
        scope,
        ..TruncateEdgeParams::new(select, params.offset)
    };
    let (carved, report) = truncate_edges(mesh, &cut, &OpContext { made: None, progress })?;
    notes.extend(report.notes("edge"));
    let mut folds = report.made.strip.clone();
    if !sharp.is_empty() {
        notes.push(format!(
            "{} sharp: no plane shaves off an edge that ends in a concave corner",
            counted(sharp.len(), "fold stays", "folds stay")
        ));
        folds.extend(found_again(mesh, &sharp, &carved));
        folds.sort_unstable();
    }
    Ok(CarvedDform { mesh: carved, made: report.made, folds, notes })
}

/// The folds that planes can cut off, and the others. On a convex mesh these are all; else those
/// that, as all edges at their ends, bend outwards.
fn rollable(mesh: &Mesh, folds: &[EdgeId]) -> (Vec<EdgeId>, Vec<EdgeId>) {
    let mut is_concave = EdgeMap::filled(mesh.edge_slots(), false);
    concave_edges(mesh).into_iter().for_each(|e| is_concave[e] = true);
    let bends_outwards = |v: VertexId| {
        mesh.outgoing(v).all(|h| !is_concave[h.edge()] && fold_angle(mesh, h.edge()).is_some())
    };
    folds.iter().partition(|&&e| mesh.edge_vertices(e).into_iter().all(bends_outwards))
}

/// Edges that no cut has touched, by the places of their ends. One that a cut did touch is not
/// among them: it is cut off, and the unfolder will open what it must.
fn found_again(before: &Mesh, edges: &[EdgeId], after: &Mesh) -> Vec<EdgeId> {
    let place = |mesh: &Mesh, v: VertexId| mesh.position(v).to_array().map(f64::to_bits);
    let at: HashMap<[u64; 3], VertexId> = after.vertices().map(|v| (place(after, v), v)).collect();
    let find = |&e: &EdgeId| {
        let [a, b] = before.edge_vertices(e).map(|v| at.get(&place(before, v)).copied());
        let (a, b) = (a?, b?);
        after.outgoing(a).find(|&h| after.target(h) == b).map(|h| h.edge())
    };
    edges.iter().filter_map(find).collect()
}
