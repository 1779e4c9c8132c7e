//! Whether the outline of a face crosses or touches itself.

use glam::{DVec2, DVec3};

use crate::geom::polygon::{on_segment, segments_cross};
use crate::geom::predicate::orient2d;
use crate::geom::{Plane, fit_plane};
use crate::mesh::{EdgeId, FaceId, Mesh};

/// Two sides of a face that cross, touch or fold back onto each other; the first such pair around
/// the face.
///
/// Judged in the face's plane: along the axis nearest to its normal the corners are looked at with
/// their own two other coordinates, so the signs are exact. Sides of length zero are passed over.
/// `None` for a simple polygon, and for a face whose corners are collinear.
pub fn self_contact(mesh: &Mesh, f: FaceId) -> Option<[EdgeId; 2]> {
    let corners = mesh.face_positions(f);
    if corners.len() <= 3 {
        return None;
    }
    // A figure of eight may have a Newell vector of zero and still a plane.
    let plane = Plane::newell(&corners).or_else(|| fit_plane(&corners))?;
    let axis = dropped_axis(plane.normal());
    let sides: Vec<Side> = mesh
        .face_half_edges(f)
        .enumerate()
        .map(|(i, h)| Side {
            from: flat(corners[i], axis),
            to: flat(corners[(i + 1) % corners.len()], axis),
            edge: h.edge(),
        })
        .filter(|side| side.from != side.to)
        .collect();
    first_contact(&sides).map(|(i, j)| [sides[i].edge, sides[j].edge])
}

/// The axis along which a plane is seen most squarely.
pub(super) fn dropped_axis(normal: DVec3) -> usize {
    let n = normal.abs();
    if n.x > n.y && n.x > n.z {
        0
    } else if n.y > n.z {
        1
    } else {
        2
    }
}

/// The two coordinates other than `axis`, in the order that keeps counter-clockwise as it is for a
/// positive normal.
pub(super) fn flat(p: DVec3, axis: usize) -> DVec2 {
    match axis {
        0 => DVec2::new(p.y, p.z),
        1 => DVec2::new(p.z, p.x),
        _ => DVec2::new(p.x, p.y),
    }
}

struct Side {
    from: DVec2,
    to: DVec2,
    edge: EdgeId,
}

impl Side {
    fn low(&self) -> DVec2 {
        self.from.min(self.to)
    }

    fn high(&self) -> DVec2 {
        self.from.max(self.to)
    }

    fn meets(&self, other: &Self) -> bool {
        let apart = self.high().cmplt(other.low()).any() || other.high().cmplt(self.low()).any();
        !apart
            && (segments_cross(self.from, self.to, other.from, other.to)
                || [other.from, other.to].iter().any(|&p| on_segment(self.from, self.to, p))
                || [self.from, self.to].iter().any(|&p| on_segment(other.from, other.to, p)))
    }

    /// Whether the next side runs back over this one.
    fn folds_back(&self, next: &Self) -> bool {
        orient2d(self.from, self.to, next.to) == 0.0
            && (self.to - self.from).dot(next.to - next.from) < 0.0
    }
}

/// Sweeps over the sides by their lower ends along the longer extent; the lowest pair of positions
/// wins.
fn first_contact(sides: &[Side]) -> Option<(usize, usize)> {
    let (low, high) = crate::geom::polygon::bounds(sides.iter().map(|s| &s.from))?;
    let along = usize::from((high - low).x < (high - low).y);
    let mut order: Vec<usize> = (0..sides.len()).collect();
    order.sort_by(|&i, &j| sides[i].low()[along].total_cmp(&sides[j].low()[along]));
    let mut first: Option<(usize, usize)> = None;
    for (k, &i) in order.iter().enumerate() {
        let end = sides[i].high()[along];
        for &j in order[k + 1..].iter().take_while(|&&j| sides[j].low()[along] <= end) {
            let pair = (i.min(j), i.max(j));
            if first.is_none_or(|best| pair < best) && in_contact(sides, pair) {
                first = Some(pair);
            }
        }
    }
    first
}

fn in_contact(sides: &[Side], (i, j): (usize, usize)) -> bool {
    if j == i + 1 {
        sides[i].folds_back(&sides[j])
    } else if i == 0 && j + 1 == sides.len() {
        sides[j].folds_back(&sides[i])
    } else {
        sides[i].meets(&sides[j])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn contact(corners: &[[f64; 2]]) -> Option<[usize; 2]> {
        // Tilted out of all axes by an integer shear, so that the plane stays exact.
        let points = corners.iter().map(|p| DVec3::new(p[0], p[1], p[0] + 2.0 * p[1]));
        let mesh = Mesh::from_faces(points, std::iter::once(0..corners.len())).expect("a polygon");
        self_contact(&mesh, FaceId::new(0)).map(|pair| pair.map(EdgeId::index))
    }

    #[test]
    fn simple_outlines_have_none() {
        assert_eq!(contact(&[[0., 0.], [2., 0.], [2., 1.], [1., 1.], [1., 2.], [0., 2.]]), None);
        assert_eq!(contact(&[[0., 0.], [1., 0.], [2., 0.], [2., 2.]]), None);
        let star = (0..500).map(|i| {
            let (sin, cos) = (f64::from(i) / 500.0 * std::f64::consts::TAU).sin_cos();
            let r = if i % 2 == 0 { 1.0 } else { 0.4 };
            [r * cos, r * sin]
        });
        assert_eq!(contact(&star.collect::<Vec<_>>()), None);
    }

    #[test]
    fn crossings_touches_and_spikes_are_found() {
        // A bow tie, whose Newell vector is zero.
        assert_eq!(contact(&[[0., 0.], [1., 1.], [1., 0.], [0., 1.]]), Some([0, 2]));
        // A corner on another side.
        assert_eq!(contact(&[[0., 0.], [4., 0.], [4., 2.], [2., 0.], [0., 2.]]), Some([0, 2]));
        // A spike that runs back over its own side.
        assert_eq!(contact(&[[0., 0.], [4., 0.], [2., 0.], [2., 2.]]), Some([0, 1]));
        // A pentagram.
        let star = (0..5)
            .map(|i| (f64::from(i) * 0.4 * std::f64::consts::TAU).sin_cos())
            .map(|(s, c)| [c, s]);
        assert_eq!(contact(&star.collect::<Vec<_>>()), Some([0, 2]));
    }
}
