//! A convex edge as the roll sees it, and the planes that roll it.

use glam::DVec3;

use crate::geom::Plane;
use crate::measure::{edge_length, fold_angle};
use crate::mesh::{EdgeId, EdgeMap, FaceId, HalfEdgeId, Mesh, VertexId};
use crate::op::OpError;
use crate::op::roll_error::RollError;

/// Faces that turn by less, in radians, lie in one plane for whoever folds them: there is nothing
/// to roll.
const FLAT: f64 = 1e-6;

/// A convex edge between two faces, all edges at its ends convex, too.
pub(super) struct Ridge {
    /// The edge.
    pub edge: EdgeId,
    /// Its ends, the lower number first.
    pub ends: [VertexId; 2],
    /// Its faces, that on the left of the way from the first end to the second first.
    pub faces: [FaceId; 2],
    /// Where the first end is.
    pub start: DVec3,
    /// Unit vector from the first end to the second.
    pub along: DVec3,
    /// From end to end, in mm.
    pub length: f64,
    /// The unit normals of the faces.
    pub normals: [DVec3; 2],
    /// Unit vectors in the faces, from the edge inwards.
    pub into: [DVec3; 2],
    /// The angle between the normals, in radians, in (0, π).
    pub fold: f64,
}

/// Which edges are not convex, in words.
pub(super) struct Shapes(EdgeMap<Option<&'static str>>);

impl Shapes {
    /// Of a mesh of which these edges are concave.
    pub fn new(mesh: &Mesh, concave: &[EdgeId]) -> Self {
        let mut shapes = EdgeMap::filled(mesh.edge_slots(), None);
        for e in mesh.edges() {
            shapes[e] = match fold_angle(mesh, e) {
                None if mesh.is_rim(e) => Some("a rim"),
                None => Some("without a fold angle, since a face there has no area"),
                Some(angle) if angle.abs() < FLAT => Some("flat"),
                Some(angle) if angle < 0.0 => Some("concave"),
                Some(_) => None,
            };
        }
        concave.iter().for_each(|&e| shapes[e] = Some("concave"));
        Self(shapes)
    }

    /// What the edge is, if it is not convex.
    pub fn fault(&self, e: EdgeId) -> Option<&'static str> {
        self.0[e]
    }
}

impl Ridge {
    /// Refuses, by name, what cannot be rolled.
    pub fn new(mesh: &Mesh, shapes: &Shapes, edge: EdgeId) -> Result<Self, OpError> {
        if let Some(why) = shapes.fault(edge) {
            return Err(RollError::NotConvex { edge, why }.into());
        }
        let [one, other] = edge.half_edges();
        let h = if mesh.origin(one) < mesh.origin(other) { one } else { other };
        let ends = [mesh.origin(h), mesh.target(h)];
        for vertex in ends {
            let around = mesh.outgoing(vertex).map(HalfEdgeId::edge).filter(|&e| e != edge);
            for other in around {
                if let Some(why) = shapes.fault(other) {
                    return Err(RollError::EndNotConvex { edge, vertex, other, why }.into());
                }
            }
        }
        let faces = [mesh.face(h), mesh.face(h.twin())];
        let [start, end] = ends.map(|v| mesh.position(v));
        let no_plane = || OpError::NoPlaneAtEdge(edge);
        let along = (end - start).try_normalize().ok_or_else(no_plane)?;
        let normal = |f| mesh.plane(f).map(|plane| plane.normal()).ok_or_else(no_plane);
        let normals = [normal(faces[0])?, normal(faces[1])?];
        let into = [normals[0].cross(along), along.cross(normals[1])];
        let fold = normals[0].cross(normals[1]).length().atan2(normals[0].dot(normals[1]));
        let length = edge_length(mesh, edge);
        Ok(Self { edge, ends, faces, start, along, length, normals, into, fold })
    }

    /// How far from the edge a cylinder of radius 1 touches the faces.
    pub fn touch(&self) -> f64 {
        (0.5 * self.fold).tan()
    }

    /// By how much the line of touch leaves the edge, for each mm along it.
    pub fn slope(&self, radii: [f64; 2]) -> f64 {
        self.touch() * (radii[1] - radii[0]) / self.length
    }

    /// The planes that roll the edge into so many strips, from the first face to the second. Their
    /// normals turn about the axis of the cylinder or cone in equal steps.
    ///
    /// Cylinder: the axis is the edge moved inwards along the bisector by r / cos(θ/2). Cone: the
    /// apex P lies on the edge's line; with τ the slope of the line of touch, the axis is w cos γ −
    /// n sin γ, w along the line of touch, tan γ = τ cot(θ/2) / √(1 + τ²).
    pub fn planes(&self, radii: [f64; 2], strips: u32) -> Option<Vec<Plane>> {
        let slope = self.slope(radii);
        let stretch = (1.0 + slope * slope).sqrt();
        let gamma = (slope / (self.touch() * stretch)).atan();
        let (sin, cos) = gamma.sin_cos();
        let line = (self.along + self.into[0] * slope) / stretch;
        let axis = (line * cos - self.normals[0] * sin).try_normalize()?;
        let upright = self.normals.map(|n| n + axis * sin);
        let turn = upright[0].cross(upright[1]).length().atan2(upright[0].dot(upright[1]));
        let bisector = (self.normals[0] + self.normals[1]).try_normalize()?;
        let inside = self.start - bisector * (radii[0] / (0.5 * self.fold).cos());
        let first = self.touch() * radii[0];
        let plane = |j: u32| {
            let share = f64::from(j) / f64::from(strips + 1);
            let turned = upright[0] * (((1.0 - share) * turn).sin() / turn.sin())
                + upright[1] * ((share * turn).sin() / turn.sin());
            let normal = (turned - axis * sin).try_normalize()?;
            let point = if slope == 0.0 {
                inside + normal * radii[0]
            } else {
                // Where the line of touch of this plane passes the first end.
                let touching = (axis + normal * sin) / cos;
                self.start + (touching * stretch - self.along) * (first / slope)
            };
            Plane::new(normal, point)
        };
        (1..=strips).map(plane).collect()
    }

    /// The width of a strip at the end where it is narrower, in mm.
    pub fn width(&self, radii: [f64; 2], strips: u32) -> f64 {
        2.0 * radii[0].min(radii[1]) * (0.5 * self.fold / f64::from(strips + 1)).tan()
    }

    /// The fewest strips none of which is wider than this at any end.
    pub fn strips_of_width(&self, radii: [f64; 2], width: f64) -> f64 {
        let half = (width / (2.0 * radii[0].max(radii[1]))).atan();
        (0.5 * self.fold / half - 1.0 - 1e-9).ceil().max(1.0)
    }

    /// The fewest strips of which no two turn by more against each other; radians.
    pub fn strips_of_angle(&self, angle: f64) -> f64 {
        (self.fold / angle - 1.0 - 1e-9).ceil().max(1.0)
    }
}
