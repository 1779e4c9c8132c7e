//! Mesh to pieces: seams, flattening, overlap, proof by refolding.
//!
//! [`unfold`] lays every face flat, keeps a forest of folds, moves branches until nothing overlaps,
//! opens more folds where moving does not help, and lets [`prove`], which shares none of that code,
//! measure the result against the mesh.

mod convex;
mod d_form;
mod dual;
mod error;
mod flat_polygon;
mod forest;
mod given;
mod grid;
mod join;
mod layout;
mod overlap;
mod params;
mod polish;
mod proof;
mod repair;
mod result;
mod sets;
mod split;
mod start;

pub use dual::FLAT;
pub use error::UnfoldError;
pub use given::{check_folded, check_seams, seams_by_angle};
pub use params::{MeshSource, PiecesMode, PiecesModeError, Seams, UnfoldParams};
pub use proof::{
    EdgeFault, LENGTH as LENGTH_LIMIT, ProofError, REFOLD as REFOLD_LIMIT, prove, renumbered,
};

use crate::mesh::Mesh;
use crate::net::Net;
use crate::progress::Progress;
use crate::random::Rng;
use dual::Dual;
use forest::Forest;
use layout::Layout;
use repair::Repair;
use start::Rule;

/// Spanning forests to choose the first start from, and that of later attempts.
const STARTS: usize = 30;
const LATER_STARTS: usize = 8;
/// Faces laid for each step of effort, in times that every face is laid; of a small mesh as if it
/// had so many faces.
const STEP: u64 = 150;
const LEAST_SIZE: usize = 2000;
/// The same for one attempt.
const LEAST_ATTEMPT: usize = 100;
/// What making the seams shorter may take, in the same unit.
const POLISH: u64 = 20;
/// The most that one attempt may take, in the same unit, and the share of it for moving branches
/// before pieces are joined.
const ATTEMPT: u64 = 750;
const REPAIR_SHARE: u64 = 3;

/// Unfolds a mesh into flat pieces that do not overlap themselves.
///
/// The mesh is in millimetres and its faces are planar (within the usual profile of `check`; see
/// [`UnfoldError::NotPlanar`]) simple polygons, convex or not; it may have rims (they are cuts),
/// handles and several components. Faces stay whole.
///
/// Which edges fold: a forest over the faces, within what `seams` allows. Two faces of a piece
/// whose common edge comes to lie on itself fold there too (around a flat vertex, for instance), so
/// no slit of zero width is ever cut. With [`Seams::Free`] the forest is the best of several rules,
/// then repaired; the piece count is as low as the search finds, and the seams are then made
/// shorter where nothing overlaps. [`Seams::Within`] holds that search to edges that stay and edges
/// that open. [`PiecesMode::Strips`], and two pieces of a closed 3-valent mesh, choose seams as
/// D-forms do: the folds meet every vertex once. With given seams or folds every ring of faces
/// opens at the fold with the least fold angle × length, flat ones last. Where faces overlap and no
/// other allowed edge helps, a further fold opens. So given seams always open; a given fold may.
///
/// Pieces come with the most faces first, of equal ones the one with the lowest face; the first
/// face laid, in the middle of the piece, has its longest side along x, and the piece's box starts
/// at (0, 0).
///
/// # Errors
/// See [`UnfoldError`]. A net that does not pass [`prove`] is never returned.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(40.0);
/// let source = MeshSource { scale: 1.0, split_vertices: &[] };
/// let net = unfold(&cube, &Seams::Free, &UnfoldParams::default(), &source, &Silent)?;
/// assert_eq!((net.pieces.len(), net.folds.len(), net.seams.len()), (1, 5, 7));
/// # Ok::<(), kerfold::unfold::UnfoldError>(())
/// ```
pub fn unfold(
    mesh: &Mesh,
    seams: &Seams,
    params: &UnfoldParams,
    source: &MeshSource,
    progress: &dyn Progress,
) -> Result<Net, UnfoldError> {
    let dual = Dual::new(mesh, seams)?;
    let loose = dual.with_loose_flat_edges();
    let duals = [&dual, loose.as_ref().unwrap_or(&dual)];
    let faces = dual.face_count();
    if let PiecesMode::Count(asked) = params.pieces
        && asked > faces
    {
        return Err(UnfoldError::TooManyPieces { asked, faces });
    }
    let whole = |forest| Layout::new(&dual, forest, usize::MAX).expect("no limit, no giving up");
    let layout = match params.pieces {
        PiecesMode::Faces => whole(Forest::scattered(&dual)),
        PiecesMode::Strips => settled(match d_form::strips(&dual, mesh, seams, params, progress) {
            Some(layout) => layout,
            None => whole(start::strips(&dual)),
        }),
        PiecesMode::Count(2) => match d_form::two_pieces(&dual, mesh, seams, params, progress)? {
            Some(layout) => layout,
            None => counted(fewest(duals, mesh, seams, params, progress), params.pieces)?,
        },
        _ => counted(fewest(duals, mesh, seams, params, progress), params.pieces)?,
    };
    let mut net = result::net(mesh, &layout, source);
    if let Seams::Within { keep, .. } = seams {
        check_folded(&net, keep)?;
    }
    net.proof = prove(mesh, &net)?;
    Ok(net)
}

/// What a search has tried, for the message when it did not find what was asked for.
#[derive(Debug, Clone, Copy, Default)]
struct Tried {
    starts: usize,
    moves: u64,
    joins: usize,
}

/// The layout with the fewest pieces that the search finds: attempts from other starts, at most one
/// more than there are steps of effort, until there are as few pieces as can be or the budget is
/// spent; then seams of its own choice are made shorter. The first attempt keeps flat edges
/// together as far as can be, and later ones open them only for fewer pieces.
fn fewest<'a>(
    [dual, loose]: [&'a Dual; 2],
    mesh: &Mesh,
    seams: &Seams,
    params: &UnfoldParams,
    progress: &dyn Progress,
) -> (Layout<'a>, Tried) {
    let mut rng = Rng::new(params.seed);
    let least = dual.least_pieces();
    let size = dual.face_count().max(LEAST_ATTEMPT) as u64;
    let mut budget = u64::from(params.effort) * STEP * dual.face_count().max(LEAST_SIZE) as u64;
    let mut tried = Tried::default();
    let mut best: Option<Layout> = None;
    for _ in 0..=params.effort {
        let (starts, dual) = if best.is_none() { (STARTS, dual) } else { (LATER_STARTS, loose) };
        let (start, starts) =
            best_start(dual, mesh, seams, (starts, tried.starts), &mut rng, progress);
        tried.starts += starts;
        let layout = attempt(
            start,
            budget.min(ATTEMPT * size),
            (&mut budget, &mut tried),
            &mut rng,
            progress,
        );
        if best.as_ref().is_none_or(|best| layout.forest.roots().len() < best.forest.roots().len())
        {
            best = Some(layout);
        }
        let pieces = best.as_ref().map_or(0, |best| best.forest.roots().len());
        if pieces <= least || budget == 0 || progress.is_cancelled() {
            break;
        }
    }
    let mut layout = best.expect("one attempt at least");
    // Where the seams are given, rings open at their least fold and stay so.
    if seams.is_searched() {
        polish::polish(&mut layout, POLISH * size, progress);
    }
    (settled(layout), tried)
}

/// One way from a start to pieces without overlaps: branches are moved, what still overlaps is
/// parted, pieces are joined.
fn attempt<'a>(
    start: Layout<'a>,
    share: u64,
    (budget, tried): (&mut u64, &mut Tried),
    rng: &mut Rng,
    progress: &dyn Progress,
) -> Layout<'a> {
    let mut repair = Repair::new(start, rng.bits());
    let mut layout = repair.run(share / REPAIR_SHARE, progress);
    let (moves, work) = repair.effort();
    tried.moves += u64::from(moves);
    *budget = budget.saturating_sub(work);
    if !layout.overlaps.is_empty() {
        split::split_overlaps(&mut layout);
        split::join_pieces(&mut layout, || !progress.is_cancelled());
        let limit = share.saturating_sub(work);
        let mut joiner = join::Joiner::new(layout, rng, limit);
        let spent = joiner.run(progress);
        *budget = budget.saturating_sub(spent);
        tried.joins += joiner.joins;
        tried.moves += joiner.moves;
        layout = joiner.layout;
    }
    layout
}

/// The start with the fewest overlaps, the first without any, and how many were tried: `count`
/// rules from turn `first` on.
fn best_start<'a>(
    dual: &'a Dual,
    mesh: &Mesh,
    seams: &Seams,
    (count, first): (usize, usize),
    rng: &mut Rng,
    progress: &dyn Progress,
) -> (Layout<'a>, usize) {
    let rule = |turn: usize, rng: &mut Rng| match first + turn {
        0 if !seams.is_searched() => Rule::Sharpest,
        turn => Rule::of_turn(turn, rng),
    };
    let lay =
        |rule, limit, rng: &mut Rng| Layout::new(dual, start::forest(dual, mesh, rule, rng), limit);
    let first = rule(0, rng);
    let mut best = lay(first, usize::MAX, rng).expect("no limit, no giving up");
    for turn in 1..count {
        if best.overlaps.is_empty() || progress.is_cancelled() {
            return (best, turn);
        }
        progress.report("choosing a start", turn, count);
        let rule = rule(turn, rng);
        if let Some(better) = lay(rule, best.overlaps.len() - 1, rng) {
            best = better;
        }
    }
    (best, count)
}

/// Laid out afresh until that shows no overlap: what the moves have lost to rounding may hide one
/// at the bound.
fn settled(layout: Layout) -> Layout {
    let mut layout = layout.fresh();
    while !layout.overlaps.is_empty() {
        split::split_overlaps(&mut layout);
        layout = layout.fresh();
    }
    layout
}

/// Holds the layout to the number of pieces that was asked for.
fn counted<'a>(
    (mut layout, tried): (Layout<'a>, Tried),
    mode: PiecesMode,
) -> Result<Layout<'a>, UnfoldError> {
    let components = layout.dual.component_count();
    let asked = match mode {
        PiecesMode::One => components,
        PiecesMode::Count(asked) => asked,
        _ => return Ok(layout),
    };
    let found = layout.forest.roots().len();
    if found > asked {
        let Tried { starts, moves, joins } = tried;
        return Err(UnfoldError::MorePieces { asked, found, components, starts, moves, joins });
    }
    if found == asked {
        return Ok(layout);
    }
    split::split_to_count(&mut layout, asked);
    Ok(settled(layout))
}

#[cfg(test)]
mod tests;
