//! Plates that overlap are parted: corners are cut off at the nodes where plates meet, and where
//! that would take too much, fingers and butt joints give way to mitres.
//!
//! With three plates at a vertex mitres keep all of them apart. With more, the mitres of a plate
//! need not meet in one line: two plates that share nothing but the vertex then reach into each
//! other, and so does what a butt joint lets run through. At the end of a reflex corner of a rim a
//! plate goes on behind the mitre of its neighbour.

use std::collections::BTreeSet;

use glam::DVec3;

use super::cell::{Cell, HalfSpace};
use super::cut::Cutter;
use super::error::{Overlap, PanelError};
use super::node::NodeCut;
use super::outline::FlatFace;
use super::overlap::Shared;
use super::shape::MovedSides;
use crate::mesh::{EdgeId, HalfEdgeId, VertexId};
use crate::net::PieceId;

/// A corner is cut off at least this far behind its inner point, in thicknesses: shorter chamfers
/// are no work that anybody does, and their lines would be as long as rounding.
const LEAST: f64 = 0.1;

/// Halvings of the interval between corners that are whole and corners that are cut as deep as the
/// other plate reaches.
const HALVINGS: usize = 40;

/// What parts the plates.
pub(super) struct Parted {
    pub cuts: Vec<NodeCut>,
    /// The edges that give way.
    pub fallen: BTreeSet<EdgeId>,
}

/// Finds for all overlaps what parts them, and cuts the corners.
///
/// # Errors
/// [`PanelError::Overlap`] where nothing can.
pub(super) fn part(
    found: &[Shared],
    faces: &[FlatFace],
    cutter: &mut Cutter<'_>,
) -> Result<Parted, PanelError> {
    let mut parted = Parted { cuts: Vec::new(), fallen: BTreeSet::new() };
    let mut stuck = Vec::new();
    for shared in found {
        let pair = shared.plates.map(|i| &faces[i]);
        for place in places(shared, pair, cutter) {
            if let Some(cut) = cut_corners(&place, pair, cutter) {
                cut.levels.iter().for_each(|&(h, level)| cutter.cut_corner(h, level));
                parted.cuts.push(cut.listed);
                continue;
            }
            let special = edges_at(place.vertex, pair, cutter);
            if special.is_empty() {
                let faces = pair.map(|face| face.face);
                stuck.push(Overlap { faces, vertex: place.vertex, mm3: place.volume });
            }
            parted.fallen.extend(special);
        }
    }
    if parted.fallen.is_empty() && !stuck.is_empty() {
        return Err(PanelError::Overlap { found: stuck });
    }
    Ok(parted)
}

/// A part of what two plates share, near one of the vertices that they have in common.
struct Place<'a> {
    plates: [usize; 2],
    vertex: Option<VertexId>,
    volume: f64,
    cells: Vec<&'a Cell>,
    about: DVec3,
}

/// Divides what two plates share among their common vertices.
fn places<'a>(shared: &'a Shared, pair: [&FlatFace; 2], cutter: &Cutter<'_>) -> Vec<Place<'a>> {
    let mesh = cutter.mesh;
    let vertices =
        pair.map(|face| face.half_edges.iter().map(|&h| mesh.origin(h)).collect::<BTreeSet<_>>());
    let common: Vec<VertexId> = vertices[0].intersection(&vertices[1]).copied().collect();
    let nearest = |cell: &Cell| {
        let middle = cell.points().iter().sum::<DVec3>() / cell.points().len() as f64;
        let distance = |v: VertexId| mesh.position(v).distance(middle + shared.about);
        common.iter().copied().min_by(|&v, &w| distance(v).total_cmp(&distance(w)))
    };
    let mut places: Vec<Place<'a>> = Vec::new();
    for cell in &shared.cells {
        let vertex = nearest(cell);
        let at = places.iter().position(|p| p.vertex == vertex).unwrap_or_else(|| {
            places.push(Place {
                plates: shared.plates,
                vertex,
                volume: 0.0,
                cells: Vec::new(),
                about: shared.about,
            });
            places.len() - 1
        });
        places[at].volume += cell.volume();
        places[at].cells.push(cell);
    }
    // Parts that lie double count double in the sum over the cells.
    if let [only] = places.as_mut_slice() {
        only.volume = shared.volume;
    }
    places
}

/// Corners with the levels at which they are cut off, and what is listed of it.
struct Cuts {
    levels: Vec<(HalfEdgeId, f64)>,
    listed: NodeCut,
}

/// A corner of a plate at a node that can be cut off.
struct Corner<'a> {
    face: &'a FlatFace,
    index: usize,
    sides: MovedSides<'a>,
    /// Along the bisector: where the corner begins, where its inner point is, and how far the other
    /// plate reaches.
    outermost: f64,
    inner: f64,
    reach: f64,
    /// The bisector in space, from the same point as the cells.
    bisector: HalfSpace,
    least: f64,
}

/// Cuts the corners of both plates off as deep as needed, else that of one.
fn cut_corners(place: &Place<'_>, pair: [&FlatFace; 2], cutter: &Cutter<'_>) -> Option<Cuts> {
    let vertex = place.vertex?;
    let corners = pair.map(|face| Corner::at(vertex, face, place, cutter));
    let [a, b] = corners.each_ref().map(Option::as_ref);
    let tries = [[a, b], [a, None], [None, b]];
    let levels = tries.into_iter().find_map(|corners| parting_levels(place, corners))?;
    let listed = NodeCut {
        vertex,
        panels: place.plates.map(PieceId),
        overlap_mm3: place.volume,
        cut_mm: [0, 1].map(|k| match (&corners[k], levels[k]) {
            (Some(corner), Some(level)) => level - corner.outermost,
            _ => 0.0,
        }),
    };
    let cut = |k: usize| Some((corners[k].as_ref()?.half_edge(), levels[k]?));
    Some(Cuts { levels: [cut(0), cut(1)].into_iter().flatten().collect(), listed })
}

/// The levels at which the given corners must be cut off so that nothing is shared any more; the
/// same share of what the other plate reaches for both. `None` when a corner cannot be cut so deep.
fn parting_levels(
    place: &Place<'_>,
    corners: [Option<&Corner<'_>>; 2],
) -> Option<[Option<f64>; 2]> {
    let given: Vec<&Corner<'_>> = corners.into_iter().flatten().collect();
    if given.is_empty() {
        return None;
    }
    let is_apart = |share: f64| {
        let planes: Vec<HalfSpace> = given.iter().map(|corner| corner.behind(share)).collect();
        place.cells.iter().all(|cell| cell.within(&planes).is_none())
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = low + (high - low) / 2.0;
        *(if is_apart(middle) { &mut high } else { &mut low }) = middle;
    }
    let level = |corner: &Corner<'_>| corner.level(high);
    let is_possible = given.iter().all(|c| c.sides.can_be_cut(c.index, level(c)));
    is_possible.then(|| corners.map(|corner| corner.map(level)))
}

impl<'a> Corner<'a> {
    /// The convex corner of a face at a vertex.
    fn at(
        vertex: VertexId,
        face: &'a FlatFace,
        place: &Place<'_>,
        cutter: &Cutter<'_>,
    ) -> Option<Self> {
        let is_here = |&i: &usize| {
            cutter.mesh.origin(face.half_edges[i]) == vertex
                && face.is_convex(i)
                && !face.is_straight(i)
        };
        let index = (0..face.len()).find(is_here)?;
        let sides = MovedSides::new(face, cutter);
        let [outermost, inner] = sides.corner_levels(index);
        let flat = face.bisector(index);
        let frame = &face.frame;
        let normal = frame.x * flat.x + frame.y * flat.y;
        let bisector = HalfSpace { normal, offset: normal.dot(frame.origin - place.about) };
        let points = place.cells.iter().flat_map(|cell| cell.points());
        let reach = points.map(|&p| bisector.distance(p)).fold(f64::NEG_INFINITY, f64::max);
        let least = LEAST * cutter.thickness[face.face];
        Some(Self { face, index, sides, outermost, inner, reach, bisector, least })
    }

    fn half_edge(&self) -> HalfEdgeId {
        self.face.half_edges[self.index]
    }

    /// Where the corner is cut off at a share of the way to where the other plate reaches.
    fn level(&self, share: f64) -> f64 {
        let first = self.inner + self.least;
        first + share * (self.reach - first).max(0.0)
    }

    /// What is left of the plate.
    fn behind(&self, share: f64) -> HalfSpace {
        let level = self.level(share);
        HalfSpace { normal: -self.bisector.normal, offset: -self.bisector.offset - level }
    }
}

/// The edges of two plates at a vertex that could be mitred instead; of all their edges where they
/// have no vertex in common.
fn edges_at(vertex: Option<VertexId>, pair: [&FlatFace; 2], cutter: &Cutter<'_>) -> Vec<EdgeId> {
    let edges = pair.into_iter().flat_map(|face| &face.half_edges).map(|h| h.edge());
    let is_here = |e: EdgeId| vertex.is_none_or(|v| cutter.mesh.edge_vertices(e).contains(&v));
    edges.filter(|&e| cutter.is_special(e) && is_here(e)).collect()
}
