//! One face laid flat in a frame of its own.
//!
//! What is planar and what is not is decided in one place, by the limits of `check`. A face that is
//! planar up to the digits of a file is projected onto its plane. One that is farther off, but
//! within the limits, is projected and then moved in its plane until every side is as long as on
//! the mesh: sides must meet their partners to the last digit, while the other distances within
//! the face may differ by the little that its bend takes.

use glam::{DVec2, DVec3};

use super::UnfoldError;
use crate::check::{Profile, ROUNDED};
use crate::geom::{Frame, Plane, fit_plane};
use crate::measure::polygon_planarity;

/// How far a corner may lie off its face's plane so that projection alone is true enough, relative
/// to the face's diameter.
///
/// Projecting a side of length L whose ends lie d off on different sides shortens it by (2d)² / 2L.
/// The limit of [`ROUNDED`], 1e-5 of the diameter D, and of 1.5e-5 of √(D·L) where sides are short, keeps mating
/// sides equal to 1e-9 of the diameter, and holds for files with single-precision coordinates.
const PROJECTED: f64 = ROUNDED;

/// A face that is not higher over its longest line than this many times the rounding bound has no
/// plane that means anything.
const SLIVER: f64 = 4.0;

/// Steps of Newton's method for the lengths of sides; it doubles the digits with each.
const STEPS: usize = 20;

/// See the module documentation.
pub(super) struct FlatPolygon {
    /// Corners in the face's own frame.
    pub corners: Vec<DVec2>,
    /// The unit direction of the side after each corner.
    pub directions: Vec<DVec2>,
    /// An upper bound of the diameter.
    pub diameter: f64,
}

impl FlatPolygon {
    /// The face with these corners in space; `rounding` is the rounding bound of the mesh.
    pub fn new(points: &[DVec3], face: usize, rounding: f64) -> Result<Self, UnfoldError> {
        let no_area = UnfoldError::FaceWithoutArea { face };
        let plane = Plane::newell(points).filter(|_| points.len() >= 3).ok_or(no_area.clone())?;
        let diameter = 2.0 * points.iter().map(|p| p.distance(plane.point())).fold(0.0, f64::max);
        if doubled_area(points) <= SLIVER * rounding * diameter {
            return Err(no_area);
        }
        let sides: Vec<DVec3> =
            (0..points.len()).map(|i| points[(i + 1) % points.len()] - points[i]).collect();
        let lengths: Vec<f64> = sides.iter().map(|side| side.length()).collect();
        let shortest = lengths.iter().copied().fold(diameter, f64::min);
        let projected =
            PROJECTED * diameter.min(1.5 * (diameter * shortest).sqrt()) + 16.0 * rounding;
        let (plane, deviation) = nearest_plane(plane, points, projected).ok_or(no_area.clone())?;
        check_planar(points, face, deviation, rounding)?;
        // The longest side lies along x: a frame that does not depend on how the face is turned in
        // space.
        let longest = sides.iter().copied().fold(DVec3::ZERO, longer);
        let frame = Frame::along(plane.point(), longest, plane.normal()).ok_or(no_area.clone())?;
        let mut corners: Vec<DVec2> = points.iter().map(|&p| frame.flatten(p)).collect();
        // Directions come from differences of given points, not of flat ones: short sides keep all
        // their digits.
        let mut flat_sides: Vec<DVec2> =
            sides.iter().map(|side| DVec2::new(side.dot(frame.x), side.dot(frame.y))).collect();
        if deviation > projected {
            give_lengths(&mut corners, &lengths).ok_or(no_area.clone())?;
            flat_sides = sides_of(&corners);
        }
        let directions = flat_sides.iter().map(|side| side.try_normalize());
        let directions = directions.collect::<Option<_>>().ok_or(no_area)?;
        Ok(Self { corners, directions, diameter })
    }
}

/// Twice the area of a polygon that is about planar.
fn doubled_area(points: &[DVec3]) -> f64 {
    let fan = points[1..].windows(2).map(|w| (w[0] - points[0]).cross(w[1] - points[0]));
    fan.sum::<DVec3>().length()
}

fn longer(a: DVec3, b: DVec3) -> DVec3 {
    if b.length_squared() > a.length_squared() { b } else { a }
}

/// The plane itself where all corners are near enough to it, else the least-squares plane; and how
/// far the corners are off.
fn nearest_plane(plane: Plane, points: &[DVec3], near: f64) -> Option<(Plane, f64)> {
    let deviation =
        |plane: &Plane| points.iter().map(|&p| plane.signed_distance(p).abs()).fold(0.0, f64::max);
    let own = deviation(&plane);
    if points.len() == 3 || own <= near {
        return Some((plane, own));
    }
    let fitted = fit_plane(points)?;
    let outward = if fitted.normal().dot(plane.normal()) < 0.0 { fitted.flipped() } else { fitted };
    Some((outward, deviation(&outward)))
}

/// Holds a face to the limits of the usual profile, as `check` does.
fn check_planar(
    points: &[DVec3],
    face: usize,
    deviation: f64,
    rounding: f64,
) -> Result<(), UnfoldError> {
    if deviation <= rounding {
        return Ok(());
    }
    let profile = Profile::default();
    match profile.limits().breach(&polygon_planarity(points)) {
        Some(breach) => Err(UnfoldError::NotPlanar { face, profile, breach }),
        None => Ok(()),
    }
}

fn sides_of(corners: &[DVec2]) -> Vec<DVec2> {
    (0..corners.len()).map(|i| corners[(i + 1) % corners.len()] - corners[i]).collect()
}

/// Moves corners as little as it takes until the sides have these lengths: Newton's method, each
/// step the shortest that mends the lengths to first order. `None` when it does not end.
fn give_lengths(corners: &mut [DVec2], lengths: &[f64]) -> Option<()> {
    let n = corners.len();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    for _ in 0..STEPS {
        let sides = sides_of(corners);
        let missing: Vec<f64> = (0..n).map(|i| lengths[i] - sides[i].length()).collect();
        if missing.iter().all(|m| m.abs() <= 4.0 * f64::EPSILON * longest) {
            return Some(());
        }
        let directions: Vec<DVec2> = sides.iter().map(|side| side.normalize_or_zero()).collect();
        let pulls = pulls(&directions, &missing);
        for i in 0..n {
            let before = (i + n - 1) % n;
            corners[i] += directions[before] * pulls[before] - directions[i] * pulls[i];
        }
    }
    let close = |(side, length): (&DVec2, &f64)| (side.length() - length).abs() <= 1e-13 * longest;
    sides_of(corners).iter().zip(lengths).all(close).then_some(())
}

/// How far each side must pull its ends apart so that all grow by what they miss, to first order:
/// conjugate gradients (Hestenes and Stiefel 1952) on a matrix that couples neighbours only.
fn pulls(directions: &[DVec2], missing: &[f64]) -> Vec<f64> {
    let n = directions.len();
    let grown = |pulls: &[f64]| -> Vec<f64> {
        let coupled = |i: usize, j: usize| directions[i].dot(directions[j]) * pulls[j];
        (0..n)
            .map(|i| 2.0 * pulls[i] - coupled(i, (i + 1) % n) - coupled(i, (i + n - 1) % n))
            .collect()
    };
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (mut pulls, mut rest) = (vec![0.0; n], missing.to_vec());
    let mut along = rest.clone();
    let mut left = dot(&rest, &rest);
    let enough = f64::EPSILON * f64::EPSILON * left;
    for _ in 0..2 * n {
        if left <= enough {
            break;
        }
        let growth = grown(&along);
        let bend = dot(&along, &growth);
        if bend <= 0.0 {
            break;
        }
        let step = left / bend;
        for i in 0..n {
            pulls[i] += step * along[i];
            rest[i] -= step * growth[i];
        }
        let before = std::mem::replace(&mut left, dot(&rest, &rest));
        for i in 0..n {
            along[i] = rest[i] + along[i] * (left / before);
        }
    }
    pulls
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A polygon whose corners lie `off` above and below a plane, by turns, and at distances from
    /// its middle that differ by `uneven`.
    fn bent(n: u32, off: f64, uneven: f64) -> Vec<DVec3> {
        let corner = |i: u32| {
            let flat = DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / f64::from(n));
            (flat * (900.0 + uneven * f64::from(i % 3))).extend(if i.is_multiple_of(2) {
                off
            } else {
                -off
            })
        };
        (0..n).map(corner).collect()
    }

    #[test]
    fn sides_of_a_bent_face_are_true_to_length() {
        for n in [4, 5, 6, 24, 100] {
            for scale in [1e-3, 1.0] {
                let points: Vec<DVec3> = bent(n, 0.5, 50.0).iter().map(|p| *p * scale).collect();
                let flat = FlatPolygon::new(&points, 0, 1e-9 * scale).expect("within the limits");
                for i in 0..n as usize {
                    let next = (i + 1) % n as usize;
                    let [there, here] = [
                        points[i].distance(points[next]),
                        flat.corners[i].distance(flat.corners[next]),
                    ];
                    assert!((there - here).abs() <= 1e-13 * 2000.0 * scale, "{n}: {there} {here}");
                }
            }
        }
    }

    #[test]
    fn the_limit_is_that_of_check() {
        let refused = |off: f64| FlatPolygon::new(&bent(6, off, 0.0), 3, 1e-9).err();
        assert_eq!(refused(0.999), None);
        let Some(UnfoldError::NotPlanar { face: 3, breach, .. }) = refused(1.001) else {
            panic!("1 mm is the limit")
        };
        let found = polygon_planarity(&bent(6, 1.001, 0.0));
        assert_eq!(Profile::default().limits().breach(&found), Some(breach));
    }

    #[test]
    fn slivers_have_no_area() {
        for height in [0.0, 1e-17, 1e-13, 1e-12] {
            let points = [DVec3::ZERO, DVec3::X, DVec3::new(0.3, height, 0.0)];
            let error = FlatPolygon::new(&points, 7, 1e-12).err();
            assert_eq!(error, Some(UnfoldError::FaceWithoutArea { face: 7 }), "{height}");
        }
        let points = [DVec3::ZERO, DVec3::X, DVec3::new(0.3, 1e-11, 0.0)];
        assert!(FlatPolygon::new(&points, 7, 1e-12).is_ok());
    }
}
