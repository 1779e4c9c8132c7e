//! The shape of a surface around a vertex, as Srinivasan & Akleman 2004, 5, tell it from its edges.

use glam::DVec3;

use crate::mesh::{Mesh, VertexId};

/// Directions whose spat product is below this are in one plane: the rounding of unit vectors, with
/// room for the rounding of their ends.
const FLAT: f64 = 1e-12;

/// What the edges at a vertex look like.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum VertexKind {
    /// The tip of a pyramid over a convex polygon.
    Convex,
    /// The tip of a pyramid over a polygon with reflex corners.
    Star,
    /// The same turned inside out, the bottom of a funnel.
    Concave,
    /// All edges in one plane.
    Planar,
    /// The edges lie on no one side of any plane.
    Saddle,
    /// At a rim, or with fewer than three edges that are no self-loops.
    Open,
}

impl VertexKind {
    /// All kinds.
    pub const ALL: [Self; 6] =
        [Self::Convex, Self::Star, Self::Concave, Self::Planar, Self::Saddle, Self::Open];

    /// The kind in one word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Convex => "convex",
            Self::Star => "star",
            Self::Concave => "concave",
            Self::Planar => "planar",
            Self::Saddle => "saddle",
            Self::Open => "open",
        }
    }

    /// What a Sierpinski polyhedron will show at such a vertex; `None` when nothing is odd.
    pub fn expectation(self) -> Option<&'static str> {
        match self {
            Self::Convex => None,
            Self::Star => Some("the bases of their pyramids are star-shaped"),
            Self::Concave => {
                Some("their pyramids are turned inside out and count as negative volume")
            }
            Self::Planar => Some(
                "their pyramids are flat, and every round makes more flat ones; better avoid such \
                vertices",
            ),
            Self::Saddle => Some(
                "their pyramids cross themselves; they do not get more, and smaller with every \
                round",
            ),
            Self::Open => Some("no pyramid closes there"),
        }
    }
}

/// The kind of a vertex, by the directions of its edges without self-loops.
pub fn vertex_kind(mesh: &Mesh, v: VertexId) -> VertexKind {
    let at = mesh.position(v);
    // Clockwise seen from outside; counter-clockwise is what the signs below are made for.
    let mut spokes: Vec<DVec3> = mesh
        .outgoing(v)
        .filter(|&h| mesh.target(h) != v)
        .map(|h| (mesh.position(mesh.target(h)) - at).normalize_or_zero())
        .collect();
    spokes.reverse();
    if spokes.len() < 3 || mesh.is_rim_vertex(v) {
        return VertexKind::Open;
    }
    let normals = || pairs(&spokes).map(|(a, b)| a.cross(b));
    let main = normals()
        .max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()))
        .unwrap_or_default();
    if spokes.iter().all(|s| s.dot(main.normalize_or_zero()).abs() <= FLAT) {
        return VertexKind::Planar;
    }
    let Some(axis) = inner_axis(&spokes) else { return VertexKind::Saddle };
    // Seen along the axis from the tip the spokes make a polygon; from outside it runs clockwise
    // around the axis.
    let base: Vec<DVec3> = spokes.iter().map(|s| *s / s.dot(axis)).collect();
    let area: DVec3 = pairs(&base).map(|(a, b)| a.cross(b)).sum();
    if area.dot(axis) >= 0.0 {
        return VertexKind::Concave;
    }
    let turns = (0..spokes.len()).map(|i| {
        let [a, b, c] = [0, 1, 2].map(|k| spokes[(i + k) % spokes.len()]);
        a.cross(b).dot(c)
    });
    if turns.into_iter().all(|spat| spat <= FLAT) { VertexKind::Convex } else { VertexKind::Star }
}

fn pairs(ring: &[DVec3]) -> impl Iterator<Item = (DVec3, DVec3)> + '_ {
    ring.iter().copied().zip(ring.iter().copied().cycle().skip(1))
}

/// A direction that makes an acute angle with every spoke, if there is one: the mean of the spokes
/// mostly, else the sum of the extreme rays of all such directions, each of which is perpendicular
/// to two spokes.
fn inner_axis(spokes: &[DVec3]) -> Option<DVec3> {
    let fits = |axis: DVec3, least: f64| spokes.iter().all(|s| s.dot(axis) > least);
    let mean = spokes.iter().sum::<DVec3>().normalize_or_zero();
    if fits(mean, FLAT) {
        return Some(mean);
    }
    let mut sum = DVec3::ZERO;
    for (i, a) in spokes.iter().enumerate() {
        for b in &spokes[i + 1..] {
            let ray = a.cross(*b).normalize_or_zero();
            sum += [ray, -ray].into_iter().filter(|&ray| fits(ray, -FLAT)).sum::<DVec3>();
        }
    }
    let axis = sum.normalize_or_zero();
    fits(axis, FLAT).then_some(axis)
}
