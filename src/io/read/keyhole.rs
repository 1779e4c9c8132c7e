//! Faces that visit a vertex twice: a hole joined to the outline by a cut there and back (a
//! *keyhole*), or parts that touch at a corner. They become several faces that visit each vertex
//! once.

use std::collections::HashMap;

use glam::DVec3;

use crate::geom::polygon::signed_area;
use crate::geom::{Frame, Plane, triangulate_region};

/// What the area of the parts may differ by from that of the face, relative to it: the parts use
/// the same corners, so only sums are rounded.
const SAME_AREA: f64 = 1e-9;
/// Larger faces are not split: the work grows with the square of the corners.
const MOST_CORNERS: usize = 10_000;

/// Whether a vertex comes twice.
pub(super) fn visits_twice(face: &[u32]) -> bool {
    if face.len() <= 16 {
        return (1..face.len()).any(|i| face[..i].contains(&face[i]));
    }
    let mut sorted = face.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).any(|pair| pair[0] == pair[1])
}

/// Simple polygons that cover the face and run the way it runs, the one with its first corner
/// first. `None` when the face is no area with holes: it crosses itself, runs out and back to a
/// corner of its own, or has no area.
pub(super) fn simple_parts(face: &[u32], positions: &[DVec3]) -> Option<Vec<Vec<u32>>> {
    if face.len() > MOST_CORNERS {
        return None;
    }
    let points: Vec<DVec3> =
        face.iter().map(|&v| positions.get(v as usize).copied()).collect::<Option<_>>()?;
    let plane = Plane::newell(&points)?;
    let frame = Frame::on_plane(&plane);
    let flat = |v: u32| frame.flatten(positions[v as usize]);
    let contours = contours(face)?;
    let names: Vec<u32> = distinct(contours.iter().flatten());
    if names.len() != distinct(face.iter()).len() {
        // A spike: cut away with its corner, the corner would be lost without a word.
        return None;
    }
    let outlines: Vec<_> =
        contours.iter().map(|c| c.iter().map(|&v| flat(v)).collect::<Vec<_>>()).collect();
    let borrowed: Vec<_> = outlines.iter().map(Vec::as_slice).collect();
    let (corners, triangles) = triangulate_region(&borrowed)?;
    let whole = signed_area(&face.iter().map(|&v| flat(v)).collect::<Vec<_>>());
    let parts: f64 = triangles.iter().map(|t| signed_area(&t.map(|i| corners[i]))).sum();
    if corners.len() != names.len() || (whole - parts).abs() > SAME_AREA * whole.abs() {
        return None;
    }
    let triangles = triangles.into_iter().map(|t| t.map(|i| names[i])).collect();
    let mut polygons = grown(triangles, &sides(&contours));
    polygons.sort_by_key(|polygon| !polygon.contains(&face[0]));
    Some(polygons)
}

/// The closed ways that are left of the sides once those that run there and back are taken away,
/// each visiting a vertex once.
fn contours(face: &[u32]) -> Option<Vec<Vec<u32>>> {
    let mut sides: Vec<Option<[u32; 2]>> =
        (0..face.len()).map(|i| Some([face[i], face[(i + 1) % face.len()]])).collect();
    let mut waiting: HashMap<[u32; 2], Vec<usize>> = HashMap::new();
    for i in 0..sides.len() {
        let Some([a, b]) = sides[i] else { continue };
        match waiting.get_mut(&[b, a]).and_then(Vec::pop) {
            Some(other) => (sides[i], sides[other]) = (None, None),
            None => waiting.entry([a, b]).or_default().push(i),
        }
    }
    let mut contours = Vec::new();
    // The vertices on the way, and where each of them stands in it.
    let mut way: Vec<u32> = Vec::new();
    while let Some(first) = sides.iter().position(Option::is_some) {
        let mut at = sides[first].map(|[a, _]| a)?;
        loop {
            if let Some(start) = way.iter().position(|&v| v == at) {
                contours.push(way.split_off(start));
            }
            way.push(at);
            let next = sides.iter_mut().find(|side| side.is_some_and(|[a, _]| a == at));
            match next.and_then(Option::take) {
                Some([_, b]) => at = b,
                None => break,
            }
        }
        // What is left of the way is the vertex where it closed.
        if way.len() > 1 {
            return None;
        }
        way.clear();
    }
    (!contours.is_empty() && contours.iter().all(|c| c.len() >= 3)).then_some(contours)
}

/// The sides of contours, each as it runs.
fn sides(contours: &[Vec<u32>]) -> Vec<[u32; 2]> {
    let of = |c: &Vec<u32>| (0..c.len()).map(|i| [c[i], c[(i + 1) % c.len()]]).collect::<Vec<_>>();
    contours.iter().flat_map(of).collect()
}

fn distinct<'a>(vertices: impl Iterator<Item = &'a u32>) -> Vec<u32> {
    let mut seen = std::collections::HashSet::new();
    vertices.copied().filter(|&v| seen.insert(v)).collect()
}

/// Joins triangles to polygons, as far as a polygon visits each vertex once. `borders` are the
/// sides that no polygon may cross.
fn grown(triangles: Vec<[u32; 3]>, borders: &[[u32; 2]]) -> Vec<Vec<u32>> {
    let mut at_side: HashMap<[u32; 2], usize> = HashMap::new();
    for (i, &[a, b, c]) in triangles.iter().enumerate() {
        at_side.extend([[a, b], [b, c], [c, a]].map(|side| (side, i)));
    }
    let mut is_taken = vec![false; triangles.len()];
    let mut polygons = Vec::new();
    for (i, &triangle) in triangles.iter().enumerate() {
        if std::mem::replace(&mut is_taken[i], true) {
            continue;
        }
        let mut polygon = triangle.to_vec();
        let mut at = 0;
        while at < polygon.len() {
            let (a, b) = (polygon[at], polygon[(at + 1) % polygon.len()]);
            let over =
                at_side.get(&[b, a]).filter(|&&t| !is_taken[t] && !borders.contains(&[a, b]));
            let tip = over.and_then(|&t| {
                let tip = triangles[t].into_iter().find(|&v| v != a && v != b)?;
                (!polygon.contains(&tip)).then_some((t, tip))
            });
            match tip {
                Some((t, tip)) => {
                    is_taken[t] = true;
                    polygon.insert(at + 1, tip);
                }
                None => at += 1,
            }
        }
        polygons.push(polygon);
    }
    polygons
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> [DVec3; 4] {
        [[low, low], [high, low], [high, high], [low, high]]
            .map(|[x, y]| DVec3::new(x, y, 0.3 * x - 2.0 * y))
    }

    fn area(polygons: &[Vec<u32>], positions: &[DVec3]) -> f64 {
        let of = |p: &Vec<u32>| {
            let flat: Vec<_> = p.iter().map(|&v| positions[v as usize].truncate()).collect();
            signed_area(&flat)
        };
        polygons.iter().map(of).sum()
    }

    #[test]
    fn a_hole_is_kept_by_polygons_around_it() {
        let positions: Vec<DVec3> = square(0.0, 60.0)
            .into_iter()
            .chain(
                [[20., 20.], [20., 40.], [40., 40.], [40., 20.]]
                    .map(|[x, y]| DVec3::new(x, y, 0.3 * x - 2.0 * y)),
            )
            .collect();
        let face = [0, 1, 2, 3, 0, 4, 5, 6, 7, 4];
        assert!(visits_twice(&face));
        let parts = simple_parts(&face, &positions).expect("a plate with a hole");
        assert!(parts.len() >= 2 && parts.iter().all(|p| !visits_twice(p)), "{parts:?}");
        assert!((area(&parts, &positions) - 3200.0).abs() < 1e-9, "{parts:?}");
        // The other way round as well.
        let turned: Vec<u32> = face.into_iter().rev().collect();
        let parts = simple_parts(&turned, &positions).expect("the same from below");
        assert!((area(&parts, &positions) + 3200.0).abs() < 1e-9, "{parts:?}");
    }

    #[test]
    fn parts_that_touch_at_a_corner_are_two() {
        let positions: Vec<DVec3> =
            square(0.0, 10.0).into_iter().chain(square(10.0, 30.0).into_iter().skip(1)).collect();
        let parts = simple_parts(&[0, 1, 2, 4, 5, 6, 2, 3], &positions).expect("two squares");
        assert_eq!(parts.iter().map(Vec::len).collect::<Vec<_>>(), [4, 4]);
        assert!(parts[0].contains(&0), "{parts:?}");
        assert_eq!(area(&parts, &positions), 500.0);
    }

    #[test]
    fn what_is_no_area_with_holes_is_left() {
        let positions = square(0.0, 10.0);
        // A spike, a way there and back, and a vertex that does not exist.
        assert_eq!(simple_parts(&[0, 1, 3, 1, 2], &positions), None);
        assert_eq!(simple_parts(&[0, 1, 0, 1], &positions), None);
        assert_eq!(simple_parts(&[0, 1, 2, 9, 0], &positions), None);
    }
}
