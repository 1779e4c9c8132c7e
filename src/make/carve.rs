//! Carves a D-form: takes the folds of a choice, cuts them off, and looks whether the pieces lie
//! flat; if not, takes the next.

use std::collections::HashMap;

use super::MakeError;
use super::dform::{DformError, DformParams, MatchingChoice};
use crate::measure::{concave_edges, edge_length, fold_angle};
use crate::mesh::{EdgeId, EdgeMap, FaceId, Mesh, VertexId};
use crate::op::{OpContext, Origins, Scope, TruncateEdgeParams, truncate_edges};
use crate::progress::Progress;
use crate::seam::{
    MATCHING_LIMIT, SeamError, flattest_matching, fold_sum, hamiltonian_folds, least_matching,
    matching, one_piece_folds, piece_count, piece_of_faces, seam_cycles, table,
};
use crate::select::{NewElements, Selection};
use crate::unfold::{MeshSource, Seams, UnfoldParams, unfold};
use crate::units::counted;

/// Choices of folds that are carved and laid out, at most, until one lies flat in as many pieces as
/// it should.
const TRIED: usize = 24;
/// The same at each smaller offset.
const TRIED_SMALLER: usize = 3;
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
    /// All folds: the strips, those that stay sharp, and where cuts met what lies within a piece.
    /// One at every vertex, but where cuts met.
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
/// The pieces that the folds promise are those that come out: what is connected before carving is
/// connected by folds after it, and the carved pieces are laid out to see that no fold opens. For
/// two pieces and for one, choices are tried in the order of their fold sums, 24 at most, until
/// that holds. Where no choice keeps its promise, the largest smaller offset at which one does is
/// taken if the offset was left open, and named if it was given; where there is none either, the
/// first choice is kept, with a note. On a mesh that is not convex only those folds are cut off
/// whose ends are convex corners, each without touching the rest of the mesh; no plane can shave
/// the others, which stay sharp folds.
///
/// # Errors
/// [`MakeError::Seam`] when the mesh is open, not 3-valent, or has no such choice;
/// [`MakeError::Op`] when it cannot be cut so; [`MakeError::Dform`] when the given offset loses
/// folds that a smaller one keeps.
pub fn carve_dform(
    mesh: &Mesh,
    params: &DformParams,
    progress: &dyn Progress,
) -> Result<CarvedDform, MakeError> {
    let Candidates { folds, mut notes } = candidates(mesh, params.matching, progress)?;
    let asked = params.offset_or_default();
    let broken = match carve_first_whole(mesh, &folds, (params, asked), progress) {
        Carving::Whole { passed, carved } => {
            if passed > 0 {
                notes.push(format!(
                    "{} passed over: carved, the pieces do not lie flat as they are",
                    counted(
                        passed,
                        "choice of folds with no larger fold sum was",
                        "choices of folds with no larger fold sum were"
                    )
                ));
            }
            return Ok(carved.after(notes));
        }
        Carving::Broken(broken) => broken,
        Carving::Impossible(error) => return Err(error),
    };
    match (smaller_offset(mesh, &folds, params, progress), params.offset) {
        (Some((largest, _)), Some(offset)) => {
            let BrokenPromise { promised, made, .. } = *broken;
            Err(DformError::LosesFolds { offset, promised, made, largest }.into())
        }
        (Some((largest, carved)), None) => {
            notes.push(format!(
                "the offset is {largest} instead of {asked}: the largest that keeps the pieces whole"
            ));
            Ok(carved.after(notes))
        }
        (None, _) => {
            let BrokenPromise { promised, made, carved } = *broken;
            notes.push(format!(
                "{} carved, but none lies flat unless a further fold opens; the first was taken, \
                with {made} pieces instead of {promised}: fewer `--rounds` may do",
                counted(folds.len().min(TRIED), "choice of folds was", "choices of folds were")
            ));
            Ok(carved.after(notes))
        }
    }
}

/// What became of some choices of folds at one offset.
enum Carving {
    /// The first that lies flat in as many pieces as it promised, after some that do not.
    Whole { passed: usize, carved: Box<CarvedDform> },
    /// None does.
    Broken(Box<BrokenPromise>),
    /// None can be carved.
    Impossible(MakeError),
}

/// The first choice, and how many pieces it promised and made.
struct BrokenPromise {
    promised: usize,
    made: usize,
    carved: CarvedDform,
}

fn carve_first_whole(
    mesh: &Mesh,
    choices: &[Vec<EdgeId>],
    (params, offset): (&DformParams, f64),
    progress: &dyn Progress,
) -> Carving {
    let (mut first, mut failure) = (None, None);
    let count = choices.len().min(TRIED);
    for (i, folds) in choices.iter().take(TRIED).enumerate() {
        progress.report("trying folds", i, count);
        let promised = piece_count(mesh, folds);
        match carve(mesh, folds, (params, offset), progress) {
            Ok(carved) => match pieces_flat(&carved, progress) {
                Some(made) if made == promised => {
                    return Carving::Whole { passed: i, carved: Box::new(carved) };
                }
                made => {
                    let made = made.unwrap_or(carved.mesh.face_count());
                    first = first.or(Some(Box::new(BrokenPromise { promised, made, carved })));
                }
            },
            Err(error) => failure = failure.or(Some(error)),
        }
        if progress.is_cancelled() {
            break;
        }
    }
    match (first, failure) {
        (Some(first), _) => Carving::Broken(first),
        (None, Some(error)) => Carving::Impossible(error),
        (None, None) => Carving::Impossible(SeamError::Empty.into()),
    }
}

/// The largest offset below the one asked for at which the first choices keep what they promise, in
/// steps of a hundredth, and what is carved there.
fn smaller_offset(
    mesh: &Mesh,
    choices: &[Vec<EdgeId>],
    params: &DformParams,
    progress: &dyn Progress,
) -> Option<(f64, CarvedDform)> {
    let choices = &choices[..choices.len().min(TRIED_SMALLER)];
    let asked = params.offset_or_default();
    let mut hundredths = (100.0 * asked).ceil() as u32;
    let count = hundredths as usize;
    while hundredths > 1 && !progress.is_cancelled() {
        hundredths -= 1;
        progress.report("trying smaller offsets", count - hundredths as usize, count);
        let offset = f64::from(hundredths) / 100.0;
        if let Carving::Whole { carved, .. } =
            carve_first_whole(mesh, choices, (params, offset), progress)
        {
            return Some((offset, *carved));
        }
    }
    None
}

/// Choices of folds in the order in which they are tried.
struct Candidates {
    folds: Vec<Vec<EdgeId>>,
    notes: Vec<String>,
}

fn candidates(
    mesh: &Mesh,
    choice: MatchingChoice,
    progress: &dyn Progress,
) -> Result<Candidates, SeamError> {
    let one = |folds| Candidates { folds: vec![folds], notes: Vec::new() };
    match choice {
        MatchingChoice::Least => least_matching(mesh, progress).map(one),
        MatchingChoice::Flattest => flattest_matching(mesh, progress).map(one),
        MatchingChoice::Row(row) => matching(mesh, row, progress).map(one),
        MatchingChoice::OnePiece => {
            Ok(Candidates { folds: one_piece_folds(mesh, progress)?, notes: Vec::new() })
        }
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
    Candidates { folds, notes: Vec::new() }
}

/// How many pieces the carved mesh comes apart into along its seams, and along folds that have to
/// open for an overlap; nothing where it cannot be unfolded.
fn pieces_flat(carved: &CarvedDform, progress: &dyn Progress) -> Option<usize> {
    let seams = Seams::Folds(carved.folds.clone());
    let net =
        unfold(&carved.mesh, &seams, &UnfoldParams::default(), &MeshSource::default(), progress);
    net.ok().map(|net| net.pieces.len())
}

fn carve(
    mesh: &Mesh,
    folds: &[EdgeId],
    (params, offset): (&DformParams, f64),
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
        ..TruncateEdgeParams::new(select, offset)
    };
    let (carved, report) = truncate_edges(mesh, &cut, &OpContext { made: None, progress })?;
    notes.extend(report.notes("edge"));
    let between = edges_within_pieces(mesh, folds, &carved, &report.origins);
    let mut folds = report.made.strip.clone();
    if !sharp.is_empty() {
        notes.push(format!(
            "{} sharp: no plane shaves off an edge that ends in a concave corner",
            counted(sharp.len(), "fold stays", "folds stay")
        ));
        folds.extend(found_again(mesh, &sharp, &carved));
    }
    let joining = joining(&carved, &folds, between);
    folds.extend(joining);
    folds.sort_unstable();
    folds.dedup();
    Ok(CarvedDform { mesh: carved, made: report.made, folds, notes })
}

/// The edges of the carved mesh between two faces that come from one piece. Where cuts meet, a
/// strip may vanish between two others, and its neighbours then share an edge that no cut made. Of
/// a piece that meets itself along a seam nobody can say which of these edges are seams, so none is
/// named.
fn edges_within_pieces(
    mesh: &Mesh,
    folds: &[EdgeId],
    carved: &Mesh,
    origins: &Origins,
) -> Vec<EdgeId> {
    let piece = piece_of_faces(mesh, folds);
    let mut meets_itself = vec![false; mesh.face_count()];
    let mut is_fold = EdgeMap::filled(mesh.edge_slots(), false);
    folds.iter().for_each(|&e| is_fold[e] = true);
    for e in mesh.edges().filter(|&e| !is_fold[e]) {
        if let [Some(a), Some(b)] = mesh.edge_faces(e).map(|f| piece[f])
            && a == b
        {
            meets_itself[a] = true;
        }
    }
    let piece_of = |f: FaceId| origins.of(f).and_then(|origin| piece[origin]);
    let is_within = |&e: &EdgeId| match carved.edge_faces(e).map(piece_of) {
        [Some(a), Some(b)] => a == b && !meets_itself[a],
        _ => false,
    };
    carved.edges().filter(is_within).collect()
}

/// Of the candidates those that join what the folds leave apart, the longest first. The others
/// would close a ring around a vertex whose faces cannot lie flat together, and stay seams.
fn joining(mesh: &Mesh, folds: &[EdgeId], mut candidates: Vec<EdgeId>) -> Vec<EdgeId> {
    let mut piece = piece_of_faces(mesh, folds);
    candidates
        .sort_by(|&a, &b| edge_length(mesh, b).total_cmp(&edge_length(mesh, a)).then(a.cmp(&b)));
    candidates.retain(|&e| {
        let [a, b] = mesh.edge_faces(e).map(|f| piece[f]);
        if a != b {
            let joined: Vec<FaceId> = mesh.faces().filter(|&f| piece[f] == b).collect();
            joined.into_iter().for_each(|f| piece[f] = a);
        }
        a != b
    });
    candidates
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
