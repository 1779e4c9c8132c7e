//! How far a face is from planar, in the numbers that shops ask for (`operators.md` 11).

use glam::DVec3;

use crate::geom::{Plane, fit_plane};
use crate::mesh::{FaceId, Mesh};

/// A corner that stands out from the line between its neighbours by less than this share of the
/// face's diameter is straight: its normal is chance, since the seventh digit of a file would turn
/// it. On a panel of 1 m that is 0.01 mm.
const STRAIGHT: f64 = 1e-5;

/// How far a face is from planar. All zero for triangles, exactly.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Planarity {
    /// Largest distance of a corner from the least-squares plane of the corners, in mm.
    pub mm: f64,
    /// The same over the face's diameter (its largest corner distance), in per mille.
    pub permille: f64,
    /// Largest angle between the face's Newell normal and the normal of a corner, in degrees in [0,
    /// 90]. Straight corners have no normal and are left out; normals of reflex corners are turned
    /// to the face's side.
    pub degrees: f64,
    /// For faces with four sides: distance between the diagonals over their mean length, in per
    /// cent.
    pub percent: Option<f64>,
}

/// Measures one face. A face whose corners are collinear counts as planar: every plane through the
/// line fits.
pub fn planarity(mesh: &Mesh, f: FaceId) -> Planarity {
    polygon_planarity(&mesh.face_positions(f))
}

/// The same for a closed polygon in space.
pub fn polygon_planarity(corners: &[DVec3]) -> Planarity {
    if corners.len() <= 3 {
        return Planarity::default();
    }
    let diameter = diameter(corners);
    let mm = fit_plane(corners).map_or(0.0, |plane| deviation(corners, &plane));
    Planarity {
        mm,
        permille: if diameter > 0.0 { 1000.0 * mm / diameter } else { 0.0 },
        degrees: Plane::newell(corners)
            .map_or(0.0, |plane| twist(corners, plane.normal(), diameter).to_degrees()),
        percent: <[DVec3; 4]>::try_from(corners).ok().map(diagonal_gap),
    }
}

/// The largest distance of a corner from the plane that the face carries, in mm; `None` when it
/// carries none.
pub fn plane_deviation(mesh: &Mesh, f: FaceId) -> Option<f64> {
    let plane = mesh.carried_plane(f)?;
    Some(
        mesh.face_vertices(f)
            .map(|v| plane.signed_distance(mesh.position(v)).abs())
            .fold(0.0, f64::max),
    )
}

fn deviation(corners: &[DVec3], plane: &Plane) -> f64 {
    corners.iter().map(|&p| plane.signed_distance(p).abs()).fold(0.0, f64::max)
}

/// The largest distance between two of the corners.
pub(super) fn diameter(corners: &[DVec3]) -> f64 {
    let pairs = corners
        .iter()
        .enumerate()
        .flat_map(|(i, &a)| corners[..i].iter().map(move |&b| a.distance_squared(b)));
    pairs.fold(0.0, f64::max).sqrt()
}

/// The largest angle between `normal` and the normal of a corner, in radians.
fn twist(corners: &[DVec3], normal: DVec3, diameter: f64) -> f64 {
    let mut largest = 0.0_f64;
    let mut before = corners[corners.len() - 1];
    for (i, &at) in corners.iter().enumerate() {
        let after = corners[(i + 1) % corners.len()];
        let corner_normal = (at - before).cross(after - at);
        // |normal| = height over the chord × length of the chord.
        if corner_normal.length() > STRAIGHT * diameter * before.distance(after) {
            let across = normal.cross(corner_normal).length();
            largest = largest.max(across.atan2(normal.dot(corner_normal).abs()));
        }
        before = at;
    }
    largest
}

/// The distance between the lines of the two diagonals over their mean length, in per cent.
fn diagonal_gap([a, b, c, d]: [DVec3; 4]) -> f64 {
    let (first, second) = (c - a, d - b);
    let Some(across) = first.cross(second).try_normalize() else { return 0.0 };
    let mean = (first.length() + second.length()) / 2.0;
    100.0 * across.dot(b - a).abs() / mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points(list: &[[f64; 3]]) -> Vec<DVec3> {
        list.iter().map(|&p| DVec3::from_array(p)).collect()
    }

    #[test]
    fn a_saddle_quad_in_all_four_measures() {
        // Corners of a square of side 2, alternately 0.1 up and down.
        let quad = points(&[[1., 1., 0.1], [-1., 1., -0.1], [-1., -1., 0.1], [1., -1., -0.1]]);
        let found = polygon_planarity(&quad);
        assert!((found.mm - 0.1).abs() < 1e-14);
        assert!((found.permille - 1000.0 * 0.1 / 8f64.sqrt()).abs() < 1e-10);
        // Corner at (1, 1): edges (-2, 0, -0.2) and (0, -2, -0.2); its normal leans by atan(0.1
        // √2).
        assert!((found.degrees - (0.1 * 2f64.sqrt()).atan().to_degrees()).abs() < 1e-10);
        // The diagonals of length √8 pass each other at a distance of 0.2.
        let percent = found.percent.expect("a quad");
        assert!((percent - 100.0 * 0.2 / 8f64.sqrt()).abs() < 1e-10, "{percent}");
    }

    #[test]
    fn triangles_are_planar_exactly() {
        let thin = points(&[[0.1, 0.2, 0.3], [1e6, 1e-3, 7.7], [0.3, 0.1, 0.7]]);
        assert_eq!(polygon_planarity(&thin), Planarity::default());
    }

    #[test]
    fn concave_faces_and_straight_corners_are_not_twisted() {
        let ell = points(&[
            [0., 0., 0.],
            [1., 0., 0.],
            [2., 0., 0.],
            [2., 1., 0.],
            [1., 1., 0.],
            [1., 2., 0.],
            [0., 2., 0.],
        ]);
        let found = polygon_planarity(&ell);
        assert!(found.mm < 1e-15 && found.degrees < 1e-12, "{found:?}");
        // The straight corner a hair off its line, as a file with seven digits would have it.
        let mut noisy = ell;
        noisy[1].z = 1e-7;
        let found = polygon_planarity(&noisy);
        assert!(found.degrees < 1e-4, "{found:?}");
        assert!(found.mm > 1e-8);
    }

    #[test]
    fn a_dent_of_a_concave_face_is_measured() {
        let mut ell = points(&[
            [0., 0., 0.],
            [2., 0., 0.],
            [2., 1., 0.],
            [1., 1., 0.],
            [1., 2., 0.],
            [0., 2., 0.],
        ]);
        ell[3].z = 0.3;
        let found = polygon_planarity(&ell);
        assert!(found.mm > 0.1 && found.mm < 0.3);
        assert!(found.degrees > 10.0 && found.degrees < 45.0);
        assert_eq!(found.percent, None);
    }

    #[test]
    fn corners_off_a_carried_plane_are_seen() {
        let square = points(&[[0., 0., 0.], [1., 0., 0.], [1., 1., 0.25], [0., 1., 0.]]);
        let mut mesh = Mesh::from_faces(square, [[0, 1, 2, 3]]).expect("a square");
        let f = FaceId::new(0);
        assert_eq!(plane_deviation(&mesh, f), None);
        mesh.set_plane(f, Plane::new(DVec3::Z, DVec3::ZERO).expect("a plane"));
        assert_eq!(plane_deviation(&mesh, f), Some(0.25));
    }

    proptest! {
        /// Planar polygons stay planar under any motion and scale, and a corner moved out by h is
        /// off by less than h.
        #[test]
        fn motions_and_scales_change_nothing(
            radii in prop::collection::vec(0.2_f64..1.0, 4..12),
            axis in prop::array::uniform3(-1.0_f64..1.0),
            shift in prop::array::uniform3(-10.0_f64..10.0),
            scale in prop::sample::select(vec![1e-3, 1.0, 1e5]),
            dent in 0.01_f64..0.1,
        ) {
            let Some(axis) = DVec3::from_array(axis).try_normalize() else { return Ok(()) };
            let turn = glam::DQuat::from_axis_angle(axis, 1.1);
            let count = radii.len() as f64;
            let at = |i: usize, r: f64, z: f64| {
                let (sin, cos) = (i as f64 / count * std::f64::consts::TAU).sin_cos();
                (turn * DVec3::new(r * cos, r * sin, z) + DVec3::from_array(shift)) * scale
            };
            let flat: Vec<_> = radii.iter().enumerate().map(|(i, &r)| at(i, r, 0.0)).collect();
            let found = polygon_planarity(&flat);
            prop_assert!(found.permille < 1e-10, "{:?}", found);
            prop_assert!(found.percent.is_none_or(|p| p < 1e-9));
            let mut dented = flat;
            dented[0] = at(0, radii[0], dent);
            let found = polygon_planarity(&dented);
            prop_assert!(found.mm > 0.0 && found.mm < dent * scale && found.degrees > 0.0);
        }
    }
}
