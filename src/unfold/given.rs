//! Whether seams and folds that the caller gave can be, and whether they were kept to; seams by
//! fold angle.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::dual::FLAT;
use super::{Seams, UnfoldError};
use crate::measure::{angle_deficit, edge_length, fold_angle};
use crate::mesh::{EdgeId, EdgeMap, HalfEdgeId, Mesh, VertexId, VertexMap};
use crate::net::Net;

/// Whether given seams (or folds) reach every vertex around which the faces cannot lie flat.
/// [`super::unfold`] opens a further edge there; call this first when the seams are a maker's own
/// and are not to be added to.
///
/// # Errors
/// [`UnfoldError::ConePoints`] names the vertices that no seam and no rim reaches.
pub fn check_seams(mesh: &Mesh, seams: &Seams) -> Result<(), UnfoldError> {
    let (listed, opens): (&[EdgeId], bool) = match seams {
        Seams::Open(edges) => (edges, true),
        Seams::Folds(edges) => (edges, false),
        Seams::Free | Seams::Within { .. } => return Ok(()),
    };
    let mut is_open = EdgeMap::filled(mesh.edge_slots(), !opens);
    listed.iter().filter(|&&e| mesh.has_edge(e)).for_each(|&e| is_open[e] = opens);
    let is_inside =
        |v: &VertexId| mesh.outgoing(*v).all(|h| !is_open[h.edge()] && !mesh.is_rim(h.edge()));
    let vertices: Vec<usize> =
        mesh.vertices().filter(|v| is_inside(v) && is_cone(mesh, *v)).map(|v| v.index()).collect();
    if vertices.is_empty() { Ok(()) } else { Err(UnfoldError::ConePoints { vertices }) }
}

/// Whether the faces around an inner vertex cannot lie flat together.
fn is_cone(mesh: &Mesh, v: VertexId) -> bool {
    angle_deficit(mesh, v).is_some_and(|deficit| deficit.abs() > FLAT)
}

/// Seams for a mesh of any valence: the edges that fold by more than `angle` (radians, either way),
/// and from them and the rims the shortest ways along edges to every vertex around which the faces
/// cannot lie flat, so that each is on a seam.
///
/// The nearest such vertices come first, and what leads to one may serve the next (a Steiner tree
/// by shortest paths, Takahashi and Matsuyama 1980). A component with neither rim nor sharp edge
/// begins at its first such vertex.
pub fn seams_by_angle(mesh: &Mesh, angle: f64) -> Vec<EdgeId> {
    let is_sharp = |e: EdgeId| fold_angle(mesh, e).is_some_and(|fold| fold.abs() > angle);
    let sharp: Vec<EdgeId> = mesh.edges().filter(|&e| is_sharp(e)).collect();
    let mut ways = Ways::new(mesh);
    let rims = mesh.edges().filter(|&e| mesh.is_rim(e));
    rims.chain(sharp.iter().copied())
        .flat_map(|e| mesh.edge_vertices(e))
        .for_each(|v| ways.reach(v, 0.0, None));
    let mut seams = sharp;
    ways.lead(&mut seams);
    for v in mesh.vertices().filter(|&v| is_cone(mesh, v)) {
        if ways.distance[v] == f64::INFINITY {
            ways.reach(v, 0.0, None);
            ways.lead(&mut seams);
        }
    }
    seams.sort_unstable();
    seams.dedup();
    seams
}

/// Shortest ways from the seams, which grow by the ways that were taken.
struct Ways<'a> {
    mesh: &'a Mesh,
    distance: VertexMap<f64>,
    /// The half-edge that came to a vertex; none on a seam.
    by: VertexMap<Option<HalfEdgeId>>,
    /// Distances (their bits order as they do, since they are not negative) with their vertices,
    /// nearest first.
    open: BinaryHeap<Reverse<(u64, VertexId)>>,
}

impl<'a> Ways<'a> {
    fn new(mesh: &'a Mesh) -> Self {
        let distance = VertexMap::filled(mesh.vertex_slots(), f64::INFINITY);
        Self {
            mesh,
            distance,
            by: VertexMap::filled(mesh.vertex_slots(), None),
            open: BinaryHeap::new(),
        }
    }

    fn reach(&mut self, v: VertexId, distance: f64, by: Option<HalfEdgeId>) {
        if distance < self.distance[v] {
            (self.distance[v], self.by[v]) = (distance, by);
            self.open.push(Reverse((distance.to_bits(), v)));
        }
    }

    /// Goes on from what was reached (Dijkstra 1959); the way to every cone point becomes seam, at
    /// distance 0.
    fn lead(&mut self, seams: &mut Vec<EdgeId>) {
        while let Some(Reverse((bits, v))) = self.open.pop() {
            if bits != self.distance[v].to_bits() {
                continue;
            }
            if is_cone(self.mesh, v) {
                let mut at = v;
                while let Some(h) = self.by[at].take() {
                    seams.push(h.edge());
                    self.distance[at] = 0.0;
                    self.open.push(Reverse((0, at)));
                    at = self.mesh.origin(h);
                }
            }
            for h in self.mesh.outgoing(v) {
                let distance = self.distance[v] + edge_length(self.mesh, h.edge());
                self.reach(self.mesh.target(h), distance, Some(h));
            }
        }
    }
}

/// Whether these edges fold in a net (or are rims).
///
/// # Errors
/// [`UnfoldError::NotKept`] names those that are seams.
pub fn check_folded(net: &Net, keep: &[EdgeId]) -> Result<(), UnfoldError> {
    let seams: std::collections::BTreeSet<usize> = net.seams.iter().map(|s| s.id.0).collect();
    let mut edges: Vec<usize> =
        keep.iter().map(|e| e.index()).filter(|e| seams.contains(e)).collect();
    edges.sort_unstable();
    edges.dedup();
    if edges.is_empty() { Ok(()) } else { Err(UnfoldError::NotKept { edges }) }
}
