//! Rolling: a convex edge becomes a fillet of planes that all touch one cylinder, or one cone.
//!
//! Source: the tangent cylinder is elementary; the edge truncation that it stands beside is Gonen
//! 2007, IV.A, whose strips come out uneven. For an edge between faces with outward unit normals n₁,
//! n₂ and the fold angle θ between them, a radius r and k strips: the axis is the edge moved inwards
//! by r / cos(θ/2) along the bisector; plane j of k has the normal (sin((1 − s)θ) n₁ + sin(sθ) n₂) /
//! sin θ with s = j / (k + 1), and touches the cylinder. All strips have the width 2 r tan(θ / (2(k
//! + 1))), all folds the angle θ / (k + 1).
//!
//! Keeps: planarity, genus, and valence 3. Changes between ends with three edges: V + 2k, E + 3k,
//! F + k for each chosen edge. Degenerate cases are refused by name before anything is cut: edges that
//! are concave, flat or rims, ends with such an edge, chosen edges that meet, radii that leave
//! nothing of an edge or a face (`limit`). What was cut is measured by code of its own (`proof`).

mod limit;
mod params;
mod proof;
mod radii;
mod ridge;

#[cfg(test)]
mod tests;

pub use params::{Roll, RollOptions, RollParams, RollWordError, StripSize, StripWordError};

use self::limit::Limit;
use self::proof::Planned;
use self::radii::Radii;
use self::ridge::{Ridge, Shapes};
use super::cut::{Cutter, Reach, SlicingPlane};
use super::report::{CutReport, Origins, RoundMarks, StripMark, finish};
use super::roll_error::RollError;
use super::rolled::{RollLimit, RolledEdge};
use super::size::check_size;
use super::{OpContext, OpError};
use crate::geom::Plane;
use crate::measure::convexity;
use crate::mesh::{EdgeId, Mesh, VertexId};
use crate::progress::Progress;

/// A limit as the report names it.
fn named(limit: &Limit, ridges: &[Ridge], radius: f64, share: f64) -> RollLimit {
    RollLimit { place: limit.place, edges: first_edges(limit, ridges), radius, share }
}

/// The edges of a limit, ascending.
fn first_edges(limit: &Limit, ridges: &[Ridge]) -> Vec<EdgeId> {
    let mut edges: Vec<EdgeId> = limit.taken.iter().map(|&(i, _)| ridges[i].edge).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

/// The largest common radius of these edges, in mm, and what limits it; solved from lengths.
///
/// # Errors
/// [`OpError::Roll`] for edges that cannot be rolled together.
pub fn largest_roll(mesh: &Mesh, edges: &[EdgeId]) -> Result<RollLimit, OpError> {
    let (ridges, _) = ridges(mesh, edges)?;
    let radii = Radii::solve(mesh, &ridges, Roll::Max)?;
    Ok(radii.limit.expect("the largest radius has a limit"))
}

/// Rolls the edges. Each cut reaches only what is connected with its edge.
///
/// # Errors
/// [`OpError::Roll`], [`OpError::Exclude`] for two sizes of strips, [`OpError::DoesNotFit`],
/// [`OpError::Cancelled`].
pub(super) fn roll_edges(
    mesh: &Mesh,
    chosen: &[EdgeId],
    params: &RollParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, CutReport), OpError> {
    check_strips(params)?;
    let (ridges, is_convex) = ridges(mesh, chosen)?;
    let radii = Radii::solve(mesh, &ridges, params.roll)?;
    let strips = ridges.iter().zip(&radii.of).map(|(ridge, &of)| strip_count(ridge, of, params));
    let strips: Vec<u32> = strips.collect::<Result<_, _>>()?;
    let most = strips.iter().copied().max().unwrap_or(0);
    let total: f64 = strips.iter().map(|&k| f64::from(k)).sum();
    check_size("strips", most, |asked| {
        mesh.edge_count() as f64 + 3.0 * total * f64::from(asked) / f64::from(most.max(1))
    })?;
    let (after, mut report) = cut_rolls(mesh, &ridges, (&radii.of, &strips), context.progress)?;
    let planned = Planned {
        before: mesh,
        ridges: &ridges,
        strips: &strips,
        is_cylinders: radii.of.iter().all(|[one, other]| one == other),
        is_convex,
    };
    planned.compare(&after, &report.made)?;
    let rolled = |((ridge, &radii), &strips): ((&Ridge, &[f64; 2]), &u32)| RolledEdge {
        edge: ridge.edge,
        radii,
        touch: radii.map(|r| r * ridge.touch()),
        strips,
        width: ridge.width(radii, strips),
        fold_deg: (ridge.fold / f64::from(strips + 1)).to_degrees(),
    };
    report.rolled = ridges.iter().zip(&radii.of).zip(&strips).map(rolled).collect();
    report.roll_limit = radii.limit;
    Ok((after, report))
}

/// The edges as ridges, and whether the mesh is convex everywhere.
fn ridges(mesh: &Mesh, chosen: &[EdgeId]) -> Result<(Vec<Ridge>, bool), OpError> {
    let shape = convexity(mesh);
    let shapes = Shapes::new(mesh, &shape.concave_edges);
    let ridges: Vec<Ridge> =
        chosen.iter().map(|&e| Ridge::new(mesh, &shapes, e)).collect::<Result<_, _>>()?;
    let mut at: Vec<(VertexId, EdgeId)> =
        ridges.iter().flat_map(|ridge| ridge.ends.map(|v| (v, ridge.edge))).collect();
    at.sort_unstable();
    if let Some(pair) = at.windows(2).find(|pair| pair[0].0 == pair[1].0) {
        let (first, second, vertex) = (pair[0].1, pair[1].1, pair[0].0);
        return Err(RollError::EdgesMeet { first, second, vertex }.into());
    }
    Ok((ridges, shape.is_convex()))
}

fn check_strips(params: &RollParams) -> Result<(), OpError> {
    let bad = |what, value, range| Err(RollError::BadStrips { what, value, range }.into());
    match (params.strips, params.strip) {
        (Some(_), Some(_)) => Err(OpError::Exclude { first: "strips", second: "strip" }),
        (Some(n), None) if !(1..=RollParams::MOST_STRIPS).contains(&n) => {
            bad("the number of strips", f64::from(n), "from 1 to 1000")
        }
        (None, Some(StripSize::Width(width))) if width.mm() <= 0.0 || width.mm().is_nan() => {
            bad("the width of strips in mm", width.mm(), "above 0")
        }
        (None, Some(StripSize::Angle(angle)))
            if angle.degrees() <= 0.0 || angle.degrees() >= 180.0 || angle.degrees().is_nan() =>
        {
            bad("the angle between strips in degrees", angle.degrees(), "above 0 and below 180")
        }
        _ => Ok(()),
    }
}

fn strip_count(ridge: &Ridge, radii: [f64; 2], params: &RollParams) -> Result<u32, OpError> {
    let count = match params.strip {
        None => return Ok(params.strips.unwrap_or(RollParams::STRIPS)),
        Some(StripSize::Width(width)) => ridge.strips_of_width(radii, width.mm()),
        Some(StripSize::Angle(angle)) => ridge.strips_of_angle(angle.radians()),
    };
    if count > f64::from(RollParams::MOST_STRIPS) {
        let (what, range) = ("the number of strips that this size asks for", "at most 1000");
        return Err(RollError::BadStrips { what, value: count, range }.into());
    }
    Ok(count as u32)
}

fn cut_rolls(
    mesh: &Mesh,
    ridges: &[Ridge],
    (radii, strips): (&[[f64; 2]], &[u32]),
    progress: &dyn Progress,
) -> Result<(Mesh, CutReport), OpError> {
    let mut cutter = Cutter::new(mesh.clone());
    cutter.start_round();
    let mut report = CutReport { origins: Origins::new(cutter.mesh()), ..CutReport::default() };
    let mut marks = RoundMarks::default();
    cutter.reserve(strips.iter().map(|&k| k as usize).sum());
    for (i, ridge) in ridges.iter().enumerate() {
        progress.report("rolling", i, ridges.len());
        if progress.is_cancelled() {
            return Err(OpError::Cancelled);
        }
        let planes = ridge.planes(radii[i], strips[i]).ok_or(OpError::NoPlaneAtEdge(ridge.edge))?;
        cut_roll(&mut cutter, ridge, &planes, (&mut marks, &mut report));
        if cutter.mesh().face_count() == 0 {
            return Err(OpError::NothingLeft { cut: report.cuts, cuts: report.cuts });
        }
    }
    report.made = marks.collect(&cutter);
    report.origins = report.origins.after(&cutter, &marks);
    finish(cutter.into_mesh(), report)
}

/// The planes of one edge, in their order around it: each begins where the one before ended.
fn cut_roll(
    cutter: &mut Cutter,
    ridge: &Ridge,
    planes: &[Plane],
    (marks, report): (&mut RoundMarks, &mut CutReport),
) {
    let beside = ridge.faces.map(|f| cutter.lineage_of(f));
    let first = report.cuts;
    let mut seeds: Vec<VertexId> = ridge.ends.to_vec();
    for (j, &plane) in planes.iter().enumerate() {
        cutter.cut(&SlicingPlane { plane, given: None }, Reach::Local(&seeds));
        let cap = cutter.cap_lineage(report.cuts);
        let before = if j == 0 { beside[0] } else { cutter.cap_lineage(first + j - 1) };
        let after =
            if j + 1 == planes.len() { beside[1] } else { cutter.cap_lineage(first + j + 1) };
        marks.caps.push(cap);
        marks.strips.push(StripMark { cap, beside: [before, after], origin: beside[0] });
        report.cuts += 1;
        report.missed += usize::from(cutter.last_cut().is_miss);
        report.lids += cutter.last_cut().lids;
        let caps = cutter.take_caps();
        let corners = caps.into_iter().flat_map(|f| cutter.mesh().face_vertices(f));
        let corners: Vec<VertexId> = corners.collect();
        if !corners.is_empty() {
            seeds = corners;
        }
    }
}
