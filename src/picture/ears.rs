//! Cutting a polygon that is not planar into triangles, for drawing only.
// To be replaced by the triangulation of `geom` when that is there.

use glam::DVec2;

use crate::geom::predicate::orient2d;

/// Triangles of a counter-clockwise polygon, as corners; concave polygons too. Always corners − 2
/// of them: where the polygon crosses itself, some overlap.
pub(super) fn ears(corners: &[DVec2]) -> Vec<[usize; 3]> {
    let mut left: Vec<usize> = (0..corners.len()).collect();
    let mut triangles = Vec::with_capacity(corners.len().saturating_sub(2));
    while left.len() > 3 {
        let count = left.len();
        let at = |i: usize| [left[(i + count - 1) % count], left[i], left[(i + 1) % count]];
        // The best ear has the shortest new diagonal, so that quads are cut the short way.
        let diagonal = |&i: &usize| corners[at(i)[0]].distance_squared(corners[at(i)[2]]);
        let ears = (0..count).filter(|&i| is_ear(corners, &left, at(i)));
        let best = ears.min_by(|i, j| diagonal(i).total_cmp(&diagonal(j))).unwrap_or(0);
        triangles.push(at(best));
        left.remove(best);
    }
    if let [a, b, c] = left[..] {
        triangles.push([a, b, c]);
    }
    triangles
}

fn is_ear(corners: &[DVec2], left: &[usize], [a, b, c]: [usize; 3]) -> bool {
    let (pa, pb, pc) = (corners[a], corners[b], corners[c]);
    let inside = |p: DVec2| {
        orient2d(pa, pb, p) >= 0.0 && orient2d(pb, pc, p) >= 0.0 && orient2d(pc, pa, p) >= 0.0
    };
    // A corner at the place of the ear's own corners is the other side of a slit and does not
    // block.
    let blocks = |&i: &usize| ![pa, pb, pc].contains(&corners[i]) && inside(corners[i]);
    orient2d(pa, pb, pc) > 0.0 && !left.iter().any(blocks)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::polygon::signed_area;

    #[test]
    fn ears_cover_a_concave_polygon_once() {
        let star: Vec<DVec2> = (0..14)
            .map(|i| {
                DVec2::from_angle(f64::from(i) * std::f64::consts::TAU / 14.0)
                    * if i % 2 == 0 { 3.0 } else { 1.0 }
            })
            .collect();
        let triangles = ears(&star);
        assert_eq!(triangles.len(), 12);
        let areas: Vec<f64> = triangles.iter().map(|t| signed_area(&t.map(|i| star[i]))).collect();
        assert!(areas.iter().all(|&a| a > 0.0));
        assert!((areas.iter().sum::<f64>() - signed_area(&star)).abs() < 1e-12);
    }

    #[test]
    fn nonsense_still_ends() {
        let bow = [DVec2::ZERO, DVec2::ONE, DVec2::X, DVec2::Y, DVec2::ZERO, DVec2::ZERO];
        assert_eq!(ears(&bow).len(), 4);
        assert!(ears(&[]).is_empty());
    }
}
