//! The meeting point of three planes, solved on residuals.

use glam::DVec3;

use super::Plane;

/// The point where three planes meet, found from a point `near` it: only the small way from there
/// is solved for, so the error is relative to that way and not to the distance from the origin.
///
/// `None` when the planes do not meet in one well-determined point.
#[inline]
pub fn meet_three(planes: [&Plane; 3], near: DVec3) -> Option<DVec3> {
    let [n0, n1, n2] = planes.map(Plane::normal);
    let [r0, r1, r2] = planes.map(|p| p.signed_distance(near));
    let across = n1.cross(n2);
    // The normals have unit length: the determinant is the volume that they span.
    let determinant = n0.dot(across);
    if determinant.abs() < 1e-9 {
        return None;
    }
    let step = (across * r0 + n2.cross(n0) * r1 + n0.cross(n1) * r2) / determinant;
    step.is_finite().then_some(near - step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_planes_meet_to_the_last_digit_far_from_the_origin() {
        let corner = DVec3::new(37_000.125, -12_000.5, 8_000.25);
        let directions =
            [DVec3::new(1.0, 0.2, 0.0), DVec3::new(0.1, 1.0, 0.3), DVec3::new(-0.2, 0.1, 1.0)];
        let planes = directions.map(|n| Plane::new(n, corner).expect("a plane"));
        let met =
            meet_three([&planes[0], &planes[1], &planes[2]], corner + 1e-6).expect("they meet");
        assert!(met.distance(corner) < 2e-11);
    }

    #[test]
    fn parallel_planes_do_not_meet() {
        let plane = Plane::new(DVec3::Z, DVec3::ZERO).expect("a plane");
        let other = Plane::new(DVec3::X, DVec3::ZERO).expect("a plane");
        assert!(meet_three([&plane, &plane.moved(1.0), &other], DVec3::ZERO).is_none());
    }
}
