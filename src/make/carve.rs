//! Carves a D-form: takes the folds of a choice, rolls them or cuts them off, and looks whether the
//! pieces lie flat; if not, takes the next choice, and then less of each.

use std::collections::HashMap;

use super::MakeError;
use super::candidates::{Candidates, candidates};
use super::dform::{Carving, DformError, DformParams};
use super::divide::Room;
use super::fabricate::room;
use crate::measure::{concave_edges, edge_length, fold_angle};
use crate::mesh::{EdgeId, EdgeMap, FaceId, Mesh, VertexId};
use crate::net::Net;
use crate::op::{
    OpContext, OpError, Origins, Roll, RollOptions, RollParams, Scope, TruncateEdgeParams,
    largest_roll, truncate_edges,
};
use crate::progress::Progress;
use crate::seam::{SeamError, fold_sum, piece_count, piece_of_faces, seam_cycles};
use crate::select::{NewElements, Selection};
use crate::sheet::SheetParams;
use crate::unfold::{MeshSource, Seams, UnfoldParams, unfold};
use crate::units::{Length, counted};

/// Choices of folds that are carved and laid out, at most, until one lies flat in as many pieces as
/// it should.
const TRIED: usize = 24;
/// The same at each smaller size.
const TRIED_SMALLER: usize = 3;
/// Smaller radii that are tried, as shares of the largest, or of the one that was given.
const SHARES: [f64; 11] = [0.95, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1];

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
    /// The folds as they were chosen, of the mesh before.
    pub chosen: Vec<EdgeId>,
    /// What the user should know.
    pub notes: Vec<String>,
}

impl CarvedDform {
    /// The mesh as it is, with its folds.
    pub(super) fn uncarved(mesh: &Mesh, folds: &[EdgeId]) -> Self {
        let made = NewElements { strip: folds.to_vec(), ..NewElements::default() };
        let (folds, chosen) = (folds.to_vec(), folds.to_vec());
        Self { mesh: mesh.clone(), made, folds, chosen, notes: Vec::new() }
    }

    /// With notes on how it was chosen before its own.
    fn after(mut self, mut notes: Vec<String>) -> Self {
        notes.append(&mut self.notes);
        Self { notes, ..self }
    }
}

/// Chooses the folds and rolls them, or cuts them off round after round.
///
/// The pieces that the folds promise are those that come out: what is connected before carving is
/// connected by folds after it, and the carved pieces are laid out to see that no fold opens. For
/// two pieces and for one, choices are tried in the order of their fold sums, 24 at most, until
/// that holds. Where no choice keeps its promise, a smaller radius or offset at which one does is
/// taken if the size was left open, and named if it was given; where there is none either, nothing
/// is made. On a mesh that is not convex only those folds are carved whose ends are convex corners,
/// each without touching the rest of the mesh; no plane can shave the others, which stay sharp
/// folds.
///
/// # Errors
/// [`MakeError::Seam`] when the mesh is open, not 3-valent, or has no such choice;
/// [`MakeError::Op`] when it cannot be cut so, or for options that do not go together;
/// [`MakeError::Dform`] when the given size loses folds that a smaller one keeps, or every size
/// does.
pub fn carve_dform(
    mesh: &Mesh,
    params: &DformParams,
    progress: &dyn Progress,
) -> Result<CarvedDform, MakeError> {
    carve_candidates(mesh, params, None, progress)
}

/// As [`carve_dform`], for pieces that go onto sheets: of the choices that keep their promise the
/// first whose pieces fit is taken, so that none has to be divided; where none fits, the first.
///
/// # Errors
/// As [`carve_dform`].
pub fn carve_dform_for_sheet(
    mesh: &Mesh,
    params: &DformParams,
    sheet: &SheetParams,
    progress: &dyn Progress,
) -> Result<CarvedDform, MakeError> {
    carve_candidates(mesh, params, room(sheet), progress)
}

fn carve_candidates(
    mesh: &Mesh,
    params: &DformParams,
    room: Option<Room>,
    progress: &dyn Progress,
) -> Result<CarvedDform, MakeError> {
    params.carving()?;
    let Candidates { folds, notes } = candidates(mesh, params.matching, progress)?;
    Ok(carve_folds(mesh, folds, (params, room), progress)?.after(notes))
}

/// Carves the first of these choices that keeps its promise, as [`carve_dform`].
pub(super) fn carve_folds(
    mesh: &Mesh,
    folds: Vec<Vec<EdgeId>>,
    (params, room): (&DformParams, Option<Room>),
    progress: &dyn Progress,
) -> Result<CarvedDform, MakeError> {
    let carving = params.carving()?;
    let mut notes = Vec::new();
    let few = &folds[..folds.len().min(TRIED)];
    let broken = match carve_first_whole(mesh, few, (carving, room), progress) {
        Tried::Whole { passed, carved } => {
            if passed > 0 {
                notes.push(format!(
                    "{} passed over: carved, the pieces do not lie flat as they are, or do not fit \
                    on the sheet",
                    counted(
                        passed,
                        "choice of folds tried before was",
                        "choices of folds tried before were"
                    )
                ));
            }
            return Ok(carved.after(notes));
        }
        Tried::Broken(broken) => broken,
        Tried::Impossible(error) => return Err(error),
    };
    let BrokenPromise { promised, made } = broken;
    match smaller(mesh, &folds, carving, progress) {
        None if progress.is_cancelled() => Err(OpError::Cancelled.into()),
        None => Err(DformError::NeverFlat { promised, made }.into()),
        Some(found) if params.is_open() => {
            notes.push(found.note);
            Ok(found.carved.after(notes))
        }
        Some(found) => Err(match carving {
            Carving::Cut { offset, .. } => {
                DformError::LosesFolds { offset, promised, made, largest: found.size }
            }
            Carving::Rolled(RollParams { roll, .. }) => {
                DformError::RollLosesFolds { roll, promised, made, largest: found.size }
            }
            Carving::Nothing => DformError::NeverFlat { promised, made },
        }
        .into()),
    }
}

/// What became of some choices of folds at one size.
enum Tried {
    /// The first that lies flat in as many pieces as it promised, after some that do not.
    Whole { passed: usize, carved: Box<CarvedDform> },
    /// None does.
    Broken(BrokenPromise),
    /// None can be carved.
    Impossible(MakeError),
}

/// How many pieces the first choice promised and made.
struct BrokenPromise {
    promised: usize,
    made: usize,
}

fn carve_first_whole(
    mesh: &Mesh,
    choices: &[Vec<EdgeId>],
    (carving, room): (Carving, Option<Room>),
    progress: &dyn Progress,
) -> Tried {
    let (mut first, mut failure, mut too_large) = (None, None, None);
    for (i, folds) in choices.iter().enumerate() {
        progress.report("trying folds", i, choices.len());
        let promised = piece_count(mesh, folds);
        match carve(mesh, folds, carving, progress) {
            Ok(carved) => {
                let net = laid_flat(&carved, progress);
                let made = net.as_ref().map_or(carved.mesh.face_count(), |net| net.pieces.len());
                let fits = |net: &Net| {
                    room.is_none_or(|room| net.pieces.iter().all(|p| room.holds(&p.outline)))
                };
                if made != promised {
                    first = first.or(Some(BrokenPromise { promised, made }));
                } else if net.as_ref().is_some_and(fits) {
                    return Tried::Whole { passed: i, carved: Box::new(carved) };
                } else if too_large.is_none() {
                    too_large = Some(Tried::Whole { passed: i, carved: Box::new(carved) });
                }
            }
            Err(error) => failure = failure.or(Some(error)),
        }
        if progress.is_cancelled() {
            break;
        }
    }
    if let Some(whole) = too_large {
        return whole;
    }
    match (first, failure) {
        (Some(first), _) => Tried::Broken(first),
        (None, Some(error)) => Tried::Impossible(error),
        (None, None) => Tried::Impossible(SeamError::Empty.into()),
    }
}

/// A smaller size at which a choice keeps what it promises.
struct Smaller {
    carved: CarvedDform,
    size: f64,
    note: String,
}

/// The largest size below the one asked for, of those that are tried, at which one of the first
/// choices keeps its promise.
fn smaller(
    mesh: &Mesh,
    choices: &[Vec<EdgeId>],
    carving: Carving,
    progress: &dyn Progress,
) -> Option<Smaller> {
    // The last choice is the one that is known to lie flat as long as little is carved.
    let mut few: Vec<Vec<EdgeId>> = choices.iter().take(TRIED_SMALLER).cloned().collect();
    few.extend(choices.iter().skip(TRIED_SMALLER).last().cloned());
    match carving {
        Carving::Nothing => None,
        Carving::Cut { offset, bend, rounds } => {
            smaller_offset(mesh, &few, (offset, bend, rounds), progress)
        }
        Carving::Rolled(roll) => {
            let tried = SHARES.into_iter().enumerate();
            tried.take_while(|_| !progress.is_cancelled()).find_map(|(i, share)| {
                progress.report("trying smaller radii", i, SHARES.len());
                few.iter().find_map(|folds| smaller_roll(mesh, folds, (roll, share), progress))
            })
        }
    }
}

/// In steps of a hundredth.
fn smaller_offset(
    mesh: &Mesh,
    choices: &[Vec<EdgeId>],
    (asked, bend, rounds): (f64, f64, u32),
    progress: &dyn Progress,
) -> Option<Smaller> {
    let mut hundredths = (100.0 * asked).ceil() as u32;
    let count = hundredths as usize;
    while hundredths > 1 && !progress.is_cancelled() {
        hundredths -= 1;
        progress.report("trying smaller offsets", count - hundredths as usize, count);
        let offset = f64::from(hundredths) / 100.0;
        let carving = Carving::Cut { offset, bend, rounds };
        if let Tried::Whole { carved, .. } =
            carve_first_whole(mesh, choices, (carving, None), progress)
        {
            let note = format!(
                "the offset is {offset} instead of {asked}: the largest that keeps the pieces whole"
            );
            return Some(Smaller { carved: *carved, size: offset, note });
        }
    }
    None
}

/// With a share of the radius that was asked for, or of the largest.
fn smaller_roll(
    mesh: &Mesh,
    folds: &[EdgeId],
    (params, share): (RollParams, f64),
    progress: &dyn Progress,
) -> Option<Smaller> {
    let (round, _) = rollable(mesh, folds);
    let asked = match params.roll {
        Roll::Radius(radius) => [radius.mm(); 2],
        Roll::Cone(radii) => radii.map(Length::mm),
        Roll::Max | Roll::Each => [largest_roll(mesh, &round).ok()?.radius; 2],
    };
    // In hundredths of a millimetre where that is fine enough, so that it can be typed.
    let radii = asked.map(|r| {
        let radius = r * share;
        if radius > 1.0 { (radius * 100.0).floor() / 100.0 } else { radius }
    });
    let roll = if radii[0] == radii[1] {
        Roll::Radius(Length::from_mm(radii[0]))
    } else {
        Roll::Cone(radii.map(Length::from_mm))
    };
    let choice = [folds.to_vec()];
    let carving = Carving::Rolled(RollParams { roll, ..params });
    let Tried::Whole { carved, .. } = carve_first_whole(mesh, &choice, (carving, None), progress)
    else {
        return None;
    };
    let note = format!(
        "the roll is {roll} instead of {}: with {:.2} mm a piece overlaps itself",
        params.roll,
        asked[0].max(asked[1])
    );
    Some(Smaller { carved: *carved, size: radii[0].max(radii[1]), note })
}

/// The pieces that the carved mesh comes apart into along its seams, and along folds that have to
/// open for an overlap; nothing where it cannot be unfolded.
fn laid_flat(carved: &CarvedDform, progress: &dyn Progress) -> Option<Net> {
    let seams = Seams::Folds(carved.folds.clone());
    unfold(&carved.mesh, &seams, &UnfoldParams::default(), &MeshSource::default(), progress).ok()
}

fn carve(
    mesh: &Mesh,
    folds: &[EdgeId],
    carving: Carving,
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
    let uncarved = |notes| CarvedDform { notes, ..CarvedDform::uncarved(mesh, folds) };
    if carving == Carving::Nothing {
        return Ok(uncarved(notes));
    }
    let select = Selection::of_edges(round.iter().copied());
    let Some(cut) = select.and_then(|select| truncation(select, carving, sharp.is_empty())) else {
        notes.push(
            "no fold is cut: none has two convex ends, where a plane could shave it off".to_owned(),
        );
        return Ok(uncarved(notes));
    };
    let (carved, report) = truncate_edges(mesh, &cut, &OpContext { made: None, progress })?;
    notes.extend(report.notes("edge"));
    let between = edges_within_pieces(mesh, folds, &carved, &report.origins);
    let chosen = folds.to_vec();
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
    Ok(CarvedDform { mesh: carved, made: report.made, folds, chosen, notes })
}

/// The step `cut edge` that carves.
fn truncation(select: Selection, carving: Carving, is_convex: bool) -> Option<TruncateEdgeParams> {
    Some(match carving {
        Carving::Nothing => return None,
        Carving::Rolled(RollParams { roll, strips, strip }) => {
            let rolling = RollOptions { roll: Some(roll), strips, strip };
            TruncateEdgeParams { rolling, ..TruncateEdgeParams::rolled(select, roll) }
        }
        Carving::Cut { offset, bend, rounds: repeat } => {
            let scope = if is_convex { Scope::Global } else { Scope::Local };
            TruncateEdgeParams { bend, repeat, scope, ..TruncateEdgeParams::new(select, offset) }
        }
    })
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
