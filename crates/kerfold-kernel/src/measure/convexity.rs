//! Whether a mesh bounds a convex solid, and where it does not.
//!
//! A closed connected surface without handles whose faces are convex, whose edges are nowhere
//! concave, and which winds once around a point that lies behind all its faces, bounds a convex
//! solid: seen from that point it covers the sphere of directions exactly once. Local tests alone
//! would let a double pyramid over a five-pointed star pass. (The idea of a local test and one
//! global one: Mehlhorn et al. 1999, "Checking geometric programs or verification of geometric
//! structures".)
//!
//! Signs are exact ([`orient3d`], [`orient2d`]) where triangles meet and at corners. What stands
//! out by less than the rounding bound (1e-12 of the model, [`RoundingBound`]) is flat, since
//! coplanar faces hold rounded corners; beside a face with more than three corners its own
//! deviation from planar is added, since its plane is not known better.

use std::f64::consts::PI;

use glam::DVec3;

use super::contact::{dropped_axis, flat};
use super::planarity;
use crate::geom::predicate::{orient2d, orient3d};
use crate::geom::{Plane, RoundingBound};
use crate::mesh::{EdgeId, FaceId, FaceMap, HalfEdgeId, Mesh};

/// What stands between a mesh and convexity.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Convexity {
    /// Closed, one component, no handle.
    pub is_ball: bool,
    /// Edges where the surface bends inwards, ascending.
    pub concave_edges: Vec<EdgeId>,
    /// Faces with a reflex corner, ascending.
    pub concave_faces: Vec<FaceId>,
    /// How far the surface stands out at the worst of these, in mm.
    pub deepest_mm: f64,
    /// Whether the surface winds exactly once around its middle, with every face looking away from
    /// it. Not judged (false) when something above is wrong.
    pub winds_once: bool,
}

impl Convexity {
    /// Whether the mesh bounds a convex solid. A flat solid without volume is none.
    pub fn is_convex(&self) -> bool {
        self.is_ball
            && self.concave_edges.is_empty()
            && self.concave_faces.is_empty()
            && self.winds_once
    }
}

/// Judges a mesh.
pub fn convexity(mesh: &Mesh) -> Convexity {
    let mut deviations = FaceMap::filled(mesh.face_slots(), 0.0);
    for f in mesh.faces() {
        deviations[f] = planarity(mesh, f).mm;
    }
    let components = mesh.components();
    let is_ball = mesh.is_closed() && components.len() == 1 && components[0].genus == 0;
    convexity_of(mesh, &deviations, is_ball)
}

/// The edges where the surface bends inwards by more than rounding, ascending. Rims are none.
pub fn concave_edges(mesh: &Mesh) -> Vec<EdgeId> {
    convexity(mesh).concave_edges
}

/// Judges a mesh of which the faces' deviations from planar, and whether it is closed, of one part
/// and without handles, are known already.
pub fn convexity_of(mesh: &Mesh, deviations: &FaceMap<f64>, is_ball: bool) -> Convexity {
    let Some((low, high)) = mesh.bounds() else { return Convexity::default() };
    let judge = Judge { mesh, deviations, bound: RoundingBound::of_box(low, high).length() };
    let mut found = Convexity { is_ball, ..Convexity::default() };
    let mut deepest = 0.0_f64;
    let mut keep = |depth: Option<f64>| {
        deepest = deepest.max(depth.unwrap_or(0.0));
        depth.is_some()
    };
    found.concave_edges = mesh.edges().filter(|&e| keep(judge.edge_depth(e))).collect();
    found.concave_faces = mesh.faces().filter(|&f| keep(judge.face_depth(f))).collect();
    found.deepest_mm = deepest;
    let is_locally_convex = found.concave_edges.is_empty() && found.concave_faces.is_empty();
    found.winds_once = is_ball && is_locally_convex && winds_once(mesh);
    found
}

struct Judge<'a> {
    mesh: &'a Mesh,
    deviations: &'a FaceMap<f64>,
    bound: f64,
}

/// The corner of a face that lies farthest inwards from one of its sides.
struct FarCorner {
    position: DVec3,
    distance: f64,
}

impl Judge<'_> {
    /// How far one face of a concave edge stands out over the other; `None` when the edge is
    /// convex, flat or a rim.
    fn edge_depth(&self, e: EdgeId) -> Option<f64> {
        if self.mesh.is_rim(e) {
            return None;
        }
        let [h, g] = e.half_edges();
        let (left, right) = (self.far_corner(h)?, self.far_corner(g)?);
        // The larger face says where the plane is, the smaller is judged: nothing is extrapolated.
        let (base, plane_corner, judged) =
            if left.distance >= right.distance { (h, left, right) } else { (g, right, left) };
        let [a, b] = [
            self.mesh.position(self.mesh.origin(base)),
            self.mesh.position(self.mesh.target(base)),
        ];
        let faces = self.mesh.edge_faces(e);
        let (height, slack) = if faces.iter().all(|&f| self.is_triangle(f)) {
            // Positive when the judged corner lies behind the plane.
            let volume = orient3d(a, b, plane_corner.position, judged.position);
            (-volume / (b - a).cross(plane_corner.position - a).length(), 0.0)
        } else {
            let slack = self.deviations[faces[0]] + self.deviations[faces[1]];
            (self.mesh.plane(self.mesh.face(base))?.signed_distance(judged.position), slack)
        };
        (height > self.bound + slack).then_some(height)
    }

    fn is_triangle(&self, f: FaceId) -> bool {
        self.mesh.sides(f) == 3
    }

    fn far_corner(&self, h: HalfEdgeId) -> Option<FarCorner> {
        let mesh = self.mesh;
        let from = mesh.position(mesh.origin(h));
        let along = (mesh.position(mesh.target(h)) - from).try_normalize()?;
        let f = mesh.face(h);
        if self.is_triangle(f) {
            let position = mesh.position(mesh.origin(mesh.prev(h)));
            return Some(FarCorner { position, distance: along.cross(position - from).length() });
        }
        let inwards = mesh.plane(f)?.normal().cross(along);
        let corners = mesh.face_vertices(f).map(|v| mesh.position(v));
        let far =
            corners.map(|position| FarCorner { position, distance: inwards.dot(position - from) });
        far.reduce(|best, c| if c.distance > best.distance { c } else { best })
    }

    /// How far the deepest reflex corner of a face lies inside the line between its neighbours;
    /// `None` without one.
    fn face_depth(&self, f: FaceId) -> Option<f64> {
        let corners = self.mesh.face_positions(f);
        if corners.len() <= 3 {
            return None;
        }
        let normal = Plane::newell(&corners)?.normal();
        let axis = dropped_axis(normal);
        let side = normal[axis].signum();
        let depth = |i: usize| {
            let [before, at, after] =
                [i + corners.len() - 1, i, i + 1].map(|k| corners[k % corners.len()]);
            let turn = orient2d(flat(before, axis), flat(at, axis), flat(after, axis)) * side;
            let chord = before.distance(after);
            // A spike has no chord; it stands out by its whole length.
            let height = if chord > 0.0 {
                (at - before).cross(after - at).length() / chord
            } else {
                at.distance(before)
            };
            if turn < 0.0 { height } else { 0.0 }
        };
        let deepest = (0..corners.len()).map(depth).fold(0.0, f64::max);
        (deepest > self.bound + self.deviations[f]).then_some(deepest)
    }
}

/// Whether the middle of the vertices lies behind every face and the faces cover the sphere around
/// it once.
fn winds_once(mesh: &Mesh) -> bool {
    let Some((low, high)) = mesh.bounds() else { return false };
    let anchor = low.midpoint(high);
    let sum: DVec3 = mesh.vertices().map(|v| mesh.position(v) - anchor).sum();
    let centre = anchor + sum / mesh.vertex_count() as f64;
    let mut covered = 0.0;
    for f in mesh.faces() {
        if mesh.plane(f).is_none_or(|plane| plane.signed_distance(centre) >= 0.0) {
            return false;
        }
        let corners: Vec<DVec3> =
            mesh.face_vertices(f).map(|v| mesh.position(v) - centre).collect();
        covered +=
            corners.windows(2).skip(1).map(|w| solid_angle(corners[0], w[0], w[1])).sum::<f64>();
    }
    // A whole number of windings up to rounding.
    (covered / (4.0 * PI)).round() == 1.0
}

/// The signed solid angle of a triangle seen from the origin (van Oosterom and Strackee 1983).
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let (la, lb, lc) = (a.length(), b.length(), c.length());
    let below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    2.0 * a.dot(b.cross(c)).atan2(below)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::fixtures::{
        CUBE_FACES, cube, cube_corners, ell_prism, octahedron, open_box, prism, torus,
    };
    use proptest::prelude::*;

    #[test]
    fn convex_solids_are_convex() {
        for mesh in [cube(), octahedron(), prism(&[[0., 0.], [1., 0.], [2., 0.], [2., 2.]])] {
            let found = convexity(&mesh);
            assert!(found.is_convex(), "{found:?}");
        }
    }

    #[test]
    fn an_ell_has_one_concave_edge_and_two_concave_faces() {
        let mesh = ell_prism();
        let found = convexity(&mesh);
        assert_eq!(found.concave_edges.len(), 1);
        let [a, b] = mesh.edge_positions(found.concave_edges[0]);
        assert_eq!(a.truncate(), b.truncate());
        assert_eq!(a.truncate(), glam::DVec2::ONE);
        assert_eq!(found.concave_faces, [FaceId::new(0), FaceId::new(1)]);
        assert!((found.deepest_mm - 1.0).abs() < 1e-14, "{}", found.deepest_mm);
        assert!(!found.is_convex());
        assert_eq!(concave_edges(&mesh), found.concave_edges);
    }

    #[test]
    fn open_and_high_genus_meshes_are_not_convex() {
        let found = convexity(&open_box());
        assert!(!found.is_convex() && found.concave_edges.is_empty());
        assert!(!convexity(&torus(5, 4)).is_convex());
        assert!(!convexity(&Mesh::new()).is_convex());
    }

    #[test]
    fn a_solid_turned_inside_out_is_concave_everywhere() {
        let inside_out = CUBE_FACES.map(|mut f| {
            f.reverse();
            f
        });
        let mesh = Mesh::from_faces(cube_corners(), inside_out).expect("a cube");
        assert_eq!(convexity(&mesh).concave_edges.len(), 12);
    }

    #[test]
    fn a_double_pyramid_over_a_star_is_locally_convex_only() {
        let mut points: Vec<_> = (0..5)
            .map(|i| (f64::from(i) * 0.4 * std::f64::consts::TAU).sin_cos())
            .map(|(s, c)| DVec3::new(c, s, 0.0))
            .collect();
        points.extend([DVec3::Z, -DVec3::Z]);
        let faces = (0..5).flat_map(|i| [[i, (i + 1) % 5, 5], [(i + 1) % 5, i, 6]]);
        let mesh = Mesh::from_faces(points, faces).expect("a double pyramid");
        let found = convexity(&mesh);
        assert!(found.is_ball && found.concave_edges.is_empty() && found.concave_faces.is_empty());
        assert!(!found.winds_once && !found.is_convex());
    }

    #[test]
    fn a_dent_of_a_millionth_is_seen_and_one_of_rounding_is_not() {
        // The cube's top as four triangles around its middle.
        let dented = |depth: f64| {
            let mut points = cube_corners();
            points.push(DVec3::new(0.1, 0.3, 1.0 - depth));
            let mut faces: Vec<Vec<usize>> =
                CUBE_FACES.iter().filter(|f| f[..2] != [4, 5]).map(|f| f.to_vec()).collect();
            faces.extend([[4, 5], [5, 7], [7, 6], [6, 4]].map(|[a, b]| vec![a, b, 8]));
            convexity(&Mesh::from_faces(points, faces).expect("a cube"))
        };
        assert!(dented(0.0).is_convex() && dented(1e-13).is_convex() && dented(-1e-6).is_convex());
        let found = dented(1e-6);
        assert_eq!(found.concave_edges.len(), 4);
        assert!(found.deepest_mm > 1e-6 && found.deepest_mm < 4e-6, "{}", found.deepest_mm);
    }

    #[test]
    fn a_dihedron_has_no_inside() {
        let mut mesh = Mesh::new();
        mesh.create_face_manifold(&cube_corners()[..3]).expect("two triangles");
        assert!(!convexity(&mesh).is_convex());
    }

    proptest! {
        /// Prisms over polygons of a circle are convex wherever they lie and however large they
        /// are; with one corner pulled inside the chord of its neighbours they are not.
        #[test]
        fn motions_and_scales_change_nothing(
            sides in 4_usize..9,
            axis in prop::array::uniform3(-1.0_f64..1.0),
            shift in prop::array::uniform3(-100.0_f64..100.0),
            scale in prop::sample::select(vec![1e-3, 1.0, 1e5]),
        ) {
            let Some(axis) = DVec3::from_array(axis).try_normalize() else { return Ok(()) };
            let base = |radius: f64| -> Vec<[f64; 2]> {
                (0..sides).map(|i| {
                    let (s, c) = (i as f64 / sides as f64 * std::f64::consts::TAU).sin_cos();
                    if i == 0 { [radius * c, radius * s] } else { [c, s] }
                }).collect()
            };
            let moved = |radius: f64| {
                let mut mesh = prism(&base(radius));
                let turn = glam::DQuat::from_axis_angle(axis, 2.1);
                let ids: Vec<_> = mesh.vertices().collect();
                for v in ids {
                    mesh.set_position(v, (turn * mesh.position(v) + DVec3::from_array(shift)) * scale, true);
                }
                convexity(&mesh)
            };
            prop_assert!(moved(1.0).is_convex(), "{:?}", moved(1.0));
            let chord = (std::f64::consts::TAU / sides as f64).cos();
            let dented = moved(chord - 0.1);
            prop_assert_eq!((dented.concave_edges.len(), dented.concave_faces.len()), (1, 2));
        }
    }
}
