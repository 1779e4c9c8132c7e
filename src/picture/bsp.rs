//! Polygons from the farthest to the nearest, cut where they reach around one another: a binary
//! partition of space (Fuchs, Kedem and Naylor 1980), walked while it is made.

use glam::DVec3;

/// What lies within this of a plane is in it. Coordinates are in half diagonals of the model, so this
/// is relative to its size.
const IN_PLANE: f64 = 1e-9;

/// A flat convex polygon with what it is drawn with.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Patch<T> {
    pub points: Vec<DVec3>,
    pub look: T,
}

/// From where polygons are seen.
#[derive(Debug, Clone, Copy)]
pub(super) enum Eye {
    At(DVec3),
    /// From infinitely far along this direction.
    Along(DVec3),
}

enum Task<T> {
    Order(Vec<Patch<T>>),
    Emit(Vec<Patch<T>>),
}

/// The patches in the order in which they are painted.
pub(super) fn painted<T: Clone>(patches: Vec<Patch<T>>, eye: Eye) -> Vec<Patch<T>> {
    let mut done = Vec::with_capacity(patches.len());
    let mut tasks = vec![Task::Order(patches)];
    while let Some(task) = tasks.pop() {
        let mut patches = match task {
            Task::Emit(patches) => {
                done.extend(patches);
                continue;
            }
            Task::Order(patches) => patches,
        };
        if patches.len() < 2 {
            done.extend(patches);
            continue;
        }
        let pivot = patches.swap_remove(patches.len() / 2);
        let (normal, anchor) = (normal(&pivot.points), pivot.points[0]);
        let (mut above, mut below, mut within) = (Vec::new(), Vec::new(), vec![pivot]);
        for patch in patches {
            divide(patch, (normal, anchor), (&mut above, &mut below, &mut within));
        }
        let seen_from_above = match eye {
            Eye::At(eye) => normal.dot(eye - anchor) > 0.0,
            Eye::Along(direction) => normal.dot(direction) > 0.0,
        };
        let [near, far] = if seen_from_above { [above, below] } else { [below, above] };
        tasks.extend([Task::Order(near), Task::Emit(within), Task::Order(far)]);
    }
    done
}

fn normal(points: &[DVec3]) -> DVec3 {
    let first = points[0];
    let twice: DVec3 = points.windows(2).map(|w| (w[0] - first).cross(w[1] - first)).sum();
    twice.normalize_or_zero()
}

type Sides<'a, T> = (&'a mut Vec<Patch<T>>, &'a mut Vec<Patch<T>>, &'a mut Vec<Patch<T>>);

/// Sorts a patch to the sides of a plane, cut in two where it crosses it.
fn divide<T: Clone>(
    patch: Patch<T>,
    (normal, anchor): (DVec3, DVec3),
    (above, below, within): Sides<'_, T>,
) {
    let heights: Vec<f64> = patch.points.iter().map(|&p| normal.dot(p - anchor)).collect();
    let is_above = heights.iter().any(|&h| h > IN_PLANE);
    let is_below = heights.iter().any(|&h| h < -IN_PLANE);
    match (is_above, is_below) {
        (true, false) => above.push(patch),
        (false, true) => below.push(patch),
        (false, false) => within.push(patch),
        (true, true) => {
            let [upper, lower] = [1.0, -1.0].map(|sign| {
                let points = part(&patch.points, &heights, sign);
                (points.len() > 2).then(|| Patch { points, look: patch.look.clone() })
            });
            above.extend(upper);
            below.extend(lower);
        }
    }
}

/// The part of a convex polygon on one side of a plane.
fn part(points: &[DVec3], heights: &[f64], sign: f64) -> Vec<DVec3> {
    let n = points.len();
    let mut kept = Vec::with_capacity(n + 1);
    for i in 0..n {
        let j = (i + 1) % n;
        let (h, k) = (sign * heights[i], sign * heights[j]);
        if h >= -IN_PLANE {
            kept.push(points[i]);
        }
        if (h > IN_PLANE && k < -IN_PLANE) || (h < -IN_PLANE && k > IN_PLANE) {
            kept.push(points[i].lerp(points[j], h / (h - k)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(z: f64, tilt: f64, look: u8) -> Patch<u8> {
        let at = |x: f64, y: f64| DVec3::new(x, y, z + tilt * x);
        Patch { points: vec![at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0)], look }
    }

    #[test]
    fn what_is_nearer_comes_later() {
        for eye in [Eye::Along(DVec3::Z), Eye::At(DVec3::new(0.0, 0.0, 9.0))] {
            let order =
                painted(vec![square(0.5, 0.0, 2), square(-0.5, 0.0, 0), square(0.0, 0.0, 1)], eye);
            assert_eq!(order.iter().map(|p| p.look).collect::<Vec<_>>(), [0, 1, 2]);
        }
    }

    #[test]
    fn what_crosses_is_cut_and_nothing_is_lost() {
        let order = painted(vec![square(0.0, 0.0, 0), square(0.0, 0.5, 1)], Eye::Along(DVec3::Z));
        assert_eq!(order.len(), 3, "one of the two in two parts");
        let area = |p: &Patch<u8>| {
            let first = p.points[0];
            let flat: f64 = p.points.windows(2).map(|w| (w[0] - first).cross(w[1] - first).z).sum();
            flat / 2.0
        };
        let of = |look: u8| order.iter().filter(|p| p.look == look).map(area).sum::<f64>();
        assert!((of(0) - 4.0).abs() < 1e-12 && (of(1) - 4.0).abs() < 1e-12);
    }
}
