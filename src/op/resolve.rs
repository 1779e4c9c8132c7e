//! Resolving: brings vertices where more than three edges meet back to three, by moving faces
//! inwards by a tiny amount.
//!
//! Source: our own; the reason is Gonen 2007, II (three planes meet in one point whatever their
//! offsets, more do not). Moving one face at a vertex of valence k inwards lets each of the k − 2
//! edges that leave the face there meet it in a point of its own:
//!
//! ```text
//!   \ | /            \  |  /
//!    \|/              o-o-o      o: three edges each
//!  ---o---     to   --       --
//!   face              face
//! ```
//!
//! Needs: a face at the vertex that is planar, touches no rim, and from whose corners all other
//! edges lead down; convex solids have nothing else. Faces that resolve many vertices come first.
//! Where an edge is too short for the whole move, as the new ones at a neighbour's corner are, a
//! face moves half as far as that edge leads down. Keeps: every other plane; genus; the number of
//! faces. Changes: V + (k − 3), E + (k − 3) for each vertex. Degenerate: vertices without such a
//! face, saddles for one, stay as they are and are named.

use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap, HashMap};

use glam::DVec3;
use serde::Deserialize;

use super::cut::{Capping, Cutter, Reach, SlicingPlane};
use super::{OpContext, OpError};
use crate::check::short;
use crate::mesh::{FaceId, HalfEdgeId, Mesh, VertexId};
use crate::select::Selection;
use crate::units::Length;

/// How to resolve vertices. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct ResolveParams {
    /// Which vertices, in the selection language; those with three edges or fewer are left alone.
    #[arg(long, value_name = "SELECTION", default_value = "all")]
    #[serde(default = "Selection::all")]
    pub select: Selection,
    /// How far faces move inwards at most, above 0 and in mm unless a unit is given; less than the
    /// kerf is invisible.
    #[arg(long, default_value = "0.01mm")]
    #[serde(default = "default_depth")]
    pub depth: Length,
}

fn default_depth() -> Length {
    Length::from_mm(0.01)
}

impl Default for ResolveParams {
    fn default() -> Self {
        Self { select: Selection::all(), depth: default_depth() }
    }
}

/// What resolving did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ResolveReport {
    /// The vertices that were resolved, in ids of the mesh before.
    pub resolved: Vec<VertexId>,
    /// The chosen vertices where more than three edges still meet since the geometry does not allow
    /// it, in ids of the result.
    pub unresolved: Vec<VertexId>,
    /// How many faces were moved.
    pub faces_moved: usize,
    /// The longest way of a face, in mm: the depth, or less where edges are short.
    pub largest_face_movement_mm: f64,
    /// The shortest way of a face, in mm.
    pub least_face_movement_mm: f64,
    /// The longest way from a new vertex to where it came from, in mm: more than the face's way
    /// where edges are shallow.
    pub largest_vertex_movement_mm: f64,
}

impl ResolveReport {
    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if !self.resolved.is_empty() {
            notes.push(format!(
                "{} vertices were split into 3-valent ones; faces moved by {} mm at most, vertices \
                by {} mm",
                self.resolved.len(),
                short(self.largest_face_movement_mm),
                short(self.largest_vertex_movement_mm)
            ));
        }
        if !self.unresolved.is_empty() {
            notes.push(format!(
                "{} vertices could not be split without changing the shape",
                self.unresolved.len()
            ));
        }
        notes
    }
}

/// Splits vertices of valence above three by moving faces inwards.
///
/// # Errors
/// [`OpError::Select`] for an empty selection, [`OpError::DepthTooSmall`] when the depth is not
/// above what rounding allows.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// // Four edges meet at each vertex of an octahedron.
/// let solid = kerfold::shape::octahedron(10.0);
/// let (mesh, _) = resolve(&solid, &ResolveParams::default(), &OpContext::default())?;
/// assert!(mesh.vertices().all(|v| mesh.valence(v) == 3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn resolve(
    mesh: &Mesh,
    params: &ResolveParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, ResolveReport), OpError> {
    let chosen = params.select.vertices(&context.select(mesh))?;
    let mut cutter = Cutter::new(mesh.clone());
    cutter.set_capping(Capping::Always);
    let depth = params.depth.mm();
    // Both sides of the moved plane must be clear of rounding.
    let least = 8.0 * cutter.bound();
    if !(depth > least && depth.is_finite()) {
        return Err(OpError::DepthTooSmall { depth, least });
    }
    let open = chosen.into_iter().filter(|&v| mesh.valence(v) > 3).collect();
    let mut work = Resolving {
        cutter,
        depth,
        least,
        open,
        origins: HashMap::new(),
        report: ResolveReport::default(),
    };
    work.run(context)?;
    Ok(work.finish())
}

struct Resolving {
    cutter: Cutter,
    depth: f64,
    /// Moves below this one drown in rounding.
    least: f64,
    /// The vertices that wait.
    open: BTreeSet<VertexId>,
    /// Where the new vertices came from.
    origins: HashMap<VertexId, DVec3>,
    report: ResolveReport,
}

/// A face before it is moved.
struct FaceBefore {
    corners: Vec<VertexId>,
    /// Where the corners are.
    places: Vec<DVec3>,
    /// Where they were at first.
    origins: Vec<DVec3>,
    group: Option<String>,
    /// The neighbours beyond seams.
    seam_faces: BTreeSet<FaceId>,
}

impl FaceBefore {
    fn of(mesh: &Mesh, f: FaceId, origins: &HashMap<VertexId, DVec3>) -> Self {
        let corners: Vec<VertexId> = mesh.face_vertices(f).collect();
        let origin = |&v: &VertexId| origins.get(&v).copied().unwrap_or(mesh.position(v));
        let seams = mesh.face_half_edges(f).filter(|h| mesh.is_seam(h.edge()));
        Self {
            places: mesh.face_positions(f),
            origins: corners.iter().map(origin).collect(),
            group: mesh.group(f).map(str::to_owned),
            seam_faces: seams.map(|h| mesh.face(h.twin())).collect(),
            corners,
        }
    }

    /// The origin of the corner nearest to a point.
    fn origin_near(&self, here: DVec3) -> Option<DVec3> {
        let far = |&i: &usize| here.distance_squared(self.places[i]);
        let nearest = (0..self.places.len()).min_by(|a, b| far(a).total_cmp(&far(b)));
        nearest.map(|i| self.origins[i])
    }
}

impl Resolving {
    /// First the faces that can move all the way, then the others.
    fn run(&mut self, context: &OpContext<'_>) -> Result<(), OpError> {
        self.move_faces(self.depth, context)?;
        self.move_faces(self.least, context)
    }

    /// Moves one face after the other, if it can move by `least`: those with the most waiting
    /// vertices first, then those with the lowest id.
    fn move_faces(&mut self, least: f64, context: &OpContext<'_>) -> Result<(), OpError> {
        let mesh = self.cutter.mesh();
        let faces: BTreeSet<FaceId> =
            self.open.iter().flat_map(|&v| mesh.vertex_faces(v)).collect();
        let mut queue: BinaryHeap<(usize, Reverse<FaceId>)> =
            faces.into_iter().map(|f| (self.waiting_at(f), Reverse(f))).collect();
        while let Some((promised, Reverse(f))) = queue.pop() {
            let waiting = if self.cutter.mesh().has_face(f) { self.waiting_at(f) } else { 0 };
            if waiting == 0 {
                continue;
            }
            if waiting < promised {
                queue.push((waiting, Reverse(f)));
            } else if let Some(depth) = self.possible_move(f).filter(|&depth| depth >= least) {
                if context.progress.is_cancelled() {
                    return Err(OpError::Cancelled);
                }
                self.move_face(f, depth)?;
            }
        }
        Ok(())
    }

    fn waiting_at(&self, f: FaceId) -> usize {
        self.cutter.mesh().face_vertices(f).filter(|v| self.open.contains(v)).count()
    }

    /// How far a face can move inwards; `None` when it touches a rim or itself or is not planar.
    fn possible_move(&self, f: FaceId) -> Option<f64> {
        let mesh = self.cutter.mesh();
        let plane = mesh.plane(f)?;
        let height = |v: VertexId| plane.signed_distance(mesh.position(v));
        let mut depth = self.depth;
        let mut corners = Vec::new();
        let mut deviation = 0.0_f64;
        for h in mesh.face_half_edges(f) {
            let v = mesh.origin(h);
            corners.push(v);
            deviation = deviation.max(height(v).abs());
            let own = [h, mesh.prev(h).twin()];
            let leaving = mesh.outgoing(v).filter(|out| !own.contains(out));
            // Half the way that an edge leads down, so that something is left of it.
            depth = leaving.map(|out| -0.5 * height(mesh.target(out))).fold(depth, f64::min);
            if mesh.is_rim_vertex(v) {
                return None;
            }
        }
        corners.sort_unstable();
        let visits_once = corners.windows(2).all(|w| w[0] != w[1]);
        (visits_once && deviation <= 0.25 * depth).then_some(depth)
    }

    fn move_face(&mut self, f: FaceId, depth: f64) -> Result<(), OpError> {
        let mesh = self.cutter.mesh();
        let plane = mesh.plane(f).expect("a face that can move has a plane").moved(-depth);
        let before = FaceBefore::of(mesh, f, &self.origins);
        let local = Reach::Local(&before.corners);
        self.cutter.cut(&SlicingPlane { plane, given: None }, local);
        for cap in self.cutter.take_caps() {
            self.take_over(cap, &before);
        }
        let report = &mut self.report;
        let least =
            if report.faces_moved == 0 { depth } else { report.least_face_movement_mm.min(depth) };
        report.faces_moved += 1;
        report.least_face_movement_mm = least;
        report.largest_face_movement_mm = report.largest_face_movement_mm.max(depth);
        report.resolved.extend(before.corners.iter().copied().filter(|v| self.open.remove(v)));
        Ok(())
    }

    /// Gives a cap the group and the seams of the face that was moved, and notes how far its
    /// corners are from where they were at first.
    fn take_over(&mut self, cap: FaceId, before: &FaceBefore) {
        let mesh = self.cutter.mesh_mut();
        if let Some(group) = &before.group {
            mesh.set_group(cap, group);
        }
        let walk: Vec<HalfEdgeId> = mesh.face_half_edges(cap).collect();
        for h in walk {
            mesh.set_seam(h.edge(), before.seam_faces.contains(&mesh.face(h.twin())));
            let (v, here) = (mesh.origin(h), mesh.position(mesh.origin(h)));
            let Some(origin) = before.origin_near(here) else { continue };
            self.origins.insert(v, origin);
            let way = here.distance(origin);
            self.report.largest_vertex_movement_mm =
                self.report.largest_vertex_movement_mm.max(way);
        }
    }

    fn finish(self) -> (Mesh, ResolveReport) {
        let (mut mesh, mut report) = (self.cutter.into_mesh(), self.report);
        let map = mesh.compact();
        report.resolved.sort_unstable();
        report.unresolved = self.open.into_iter().filter_map(|v| map.vertex(v)).collect();
        (mesh, report)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{face_diameter, volume};
    use crate::mesh::assert_sound;
    use crate::shape::{self, Archimedean};

    fn resolved(mesh: &Mesh, depth: f64) -> (Mesh, ResolveReport) {
        let params = ResolveParams { depth: Length::from_mm(depth), ..ResolveParams::default() };
        let (result, report) = resolve(mesh, &params, &OpContext::default()).expect("resolved");
        assert_sound(&result);
        assert_eq!(result.face_count(), mesh.face_count());
        for f in result.faces() {
            let corners = result.face_positions(f);
            let plane = crate::geom::fit_plane(&corners).expect("a plane");
            let deviation =
                corners.iter().map(|&p| plane.signed_distance(p).abs()).fold(0.0, f64::max);
            assert!(
                deviation <= 1e-12 * face_diameter(&result, f),
                "{f} deviates by {deviation:e}"
            );
        }
        (result, report)
    }

    #[test]
    fn convex_solids_become_simple() {
        let solids = [
            (shape::octahedron(100.0), [12, 18, 8]),
            (shape::icosahedron(100.0), [36, 54, 20]),
            (shape::archimedean(Archimedean::Cuboctahedron, 100.0), [24, 36, 14]),
            (shape::antiprism(7, 100.0), [28, 42, 16]),
            (shape::cube(100.0), [8, 12, 6]),
        ];
        for (mesh, counts) in solids {
            let (result, report) = resolved(&mesh, 0.01);
            assert_eq!([result.vertex_count(), result.edge_count(), result.face_count()], counts);
            assert!(result.vertices().all(|v| result.valence(v) == 3));
            assert!(report.unresolved.is_empty());
            assert_eq!(
                report.resolved.len(),
                mesh.vertices().filter(|&v| mesh.valence(v) > 3).count()
            );
            assert!(report.largest_vertex_movement_mm < 0.1, "{report:?}");
            assert!(volume(&result) <= volume(&mesh) && volume(&result) > 0.999 * volume(&mesh));
        }
    }

    #[test]
    fn every_vertex_of_a_geodesic_sphere() {
        let (result, report) = resolved(&shape::geodesic(6, 100.0), 1e-4);
        assert!(report.unresolved.is_empty(), "{report:?}");
        assert!(result.vertices().all(|v| result.valence(v) == 3));
    }

    #[test]
    fn a_saddle_is_named_and_left() {
        // Two ridges across each other's valleys: the middle vertex goes up and down by turns.
        let z = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
        let rim = (0..8).map(|i| {
            let angle = std::f64::consts::TAU * f64::from(i) / 8.0;
            DVec3::new(angle.cos(), angle.sin(), z[i as usize]) * 10.0
        });
        let points: Vec<DVec3> = rim.chain([DVec3::ZERO, DVec3::new(0.0, 0.0, -50.0)]).collect();
        let upper = (0..8).map(|i| [i, (i + 1) % 8, 8]);
        let lower = (0..8).map(|i| [(i + 1) % 8, i, 9]);
        let mesh = Mesh::from_faces(points, upper.chain(lower)).expect("a saddle on a point");
        let (result, report) = resolved(&mesh, 0.01);
        assert!(report.unresolved.iter().any(|&v| result.position(v) == DVec3::ZERO));
    }

    #[test]
    fn groups_and_seams_go_with_the_moved_face() {
        let mut mesh = shape::octahedron(100.0);
        let faces: Vec<FaceId> = mesh.faces().collect();
        faces.iter().for_each(|&f| mesh.set_group(f, "skin"));
        let edges: Vec<_> = mesh.edges().collect();
        edges.iter().for_each(|&e| mesh.set_seam(e, true));
        let (result, _) = resolved(&mesh, 0.01);
        assert!(result.faces().all(|f| result.group(f) == Some("skin")));
        // The short edges at the six vertices are new folds.
        assert_eq!(result.edges().filter(|&e| result.is_seam(e)).count(), 12);
    }

    #[test]
    fn a_depth_within_rounding_is_refused() {
        for depth in [0.0, -1.0, 1e-13, f64::NAN] {
            let params =
                ResolveParams { depth: Length::from_mm(depth), ..ResolveParams::default() };
            let error = resolve(&shape::octahedron(100.0), &params, &OpContext::default())
                .expect_err("too small");
            assert!(matches!(error, OpError::DepthTooSmall { .. }));
        }
    }
}
