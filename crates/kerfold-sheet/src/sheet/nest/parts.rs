//! Outlines cut into convex parts: triangles first, then united across their common sides for as
//! long as the union is convex (Hertel and Mehlhorn 1983). Parts cover a shape exactly, so what
//! parts do not touch, the shape does not.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use glam::DVec2;

use crate::geom::polygon::signed_area;
use crate::geom::predicate::orient2d;
use crate::geom::triangulate_region;

/// The convex parts, counter-clockwise, of the area between an outline and its holes. `None` where
/// contours cross each other or themselves.
pub(super) fn convex_parts(outline: &[DVec2], holes: &[Vec<DVec2>]) -> Option<Vec<Vec<DVec2>>> {
    if is_convex(outline) && holes.is_empty() {
        return Some(vec![outline.to_vec()]);
    }
    let contours: Vec<&[DVec2]> =
        std::iter::once(outline).chain(holes.iter().map(Vec::as_slice)).collect();
    let (corners, triangles) = triangulate_region(&contours)?;
    let parts = united(&corners, triangles);
    Some(parts.into_iter().map(|part| part.into_iter().map(|i| corners[i]).collect()).collect())
}

/// Convex parts of more than the area, where contours cross: of the outline without holes, or its
/// convex hull.
pub(super) fn wider_parts(outline: &[DVec2]) -> Vec<Vec<DVec2>> {
    convex_parts(outline, &[]).unwrap_or_else(|| vec![crate::geom::polygon::convex_hull(outline)])
}

fn is_convex(contour: &[DVec2]) -> bool {
    let n = contour.len();
    let turns =
        (0..n).all(|i| orient2d(contour[i], contour[(i + 1) % n], contour[(i + 2) % n]) >= 0.0);
    // A contour that winds twice turns left everywhere, too.
    turns
        && n >= 3
        && signed_area(&crate::geom::polygon::convex_hull(contour))
            <= signed_area(contour) * (1.0 + 1e-12)
}

/// Unites triangles across the longest sides first, and across the shortest; what leaves fewer
/// parts is taken.
fn united(corners: &[DVec2], triangles: Vec<[usize; 3]>) -> Vec<Vec<usize>> {
    let long = united_by(corners, &triangles, |s, t| t.total_cmp(&s));
    let short = united_by(corners, &triangles, |s, t| s.total_cmp(&t));
    if short.len() < long.len() { short } else { long }
}

fn united_by(
    corners: &[DVec2],
    triangles: &[[usize; 3]],
    order: fn(f64, f64) -> Ordering,
) -> Vec<Vec<usize>> {
    let mut parts: Vec<Vec<usize>> = triangles.iter().map(|t| t.to_vec()).collect();
    let mut owner: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for (p, part) in parts.iter().enumerate() {
        (0..part.len()).for_each(|i| _ = owner.insert((part[i], part[(i + 1) % part.len()]), p));
    }
    let is_inner = |&(a, b): &(usize, usize)| a < b && owner.contains_key(&(b, a));
    let mut sides: Vec<(usize, usize)> = owner.keys().copied().filter(is_inner).collect();
    let length = |&(a, b): &(usize, usize)| corners[a].distance_squared(corners[b]);
    sides.sort_by(|s, t| order(length(s), length(t)).then(s.cmp(t)));
    for (a, b) in sides {
        let (p, q) = (owner[&(a, b)], owner[&(b, a)]);
        if p == q {
            continue;
        }
        let union = joined(&parts[p], &parts[q], a, b);
        let n = union.len();
        let turns_left = |i: usize| {
            let (u, v, w) =
                (corners[union[(i + n - 1) % n]], corners[union[i]], corners[union[(i + 1) % n]]);
            orient2d(u, v, w) >= 0.0
        };
        if (0..n).all(|i| (union[i] != a && union[i] != b) || turns_left(i)) {
            (0..n).for_each(|i| _ = owner.insert((union[i], union[(i + 1) % n]), p));
            parts[p] = union;
            parts[q].clear();
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

/// Two parts as one, without their side from `a` to `b`, which `p` has in this sense and `q` in the
/// other.
fn joined(p: &[usize], q: &[usize], a: usize, b: usize) -> Vec<usize> {
    let from = |part: &[usize], corner: usize| {
        let start = part.iter().position(|&c| c == corner).expect("the part has this corner");
        part[start..].iter().chain(&part[..start]).copied().collect::<Vec<_>>()
    };
    // b … a of the first, then what lies between a and b on the second.
    let mut union = from(p, b);
    let second = from(q, a);
    union.extend(&second[1..second.len() - 1]);
    union
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::{ell, square};
    use super::*;
    use proptest::prelude::*;

    fn area(parts: &[Vec<DVec2>]) -> f64 {
        parts.iter().map(|p| signed_area(p)).sum()
    }

    fn assert_parts(outline: &[DVec2], holes: &[Vec<DVec2>]) -> usize {
        let parts = convex_parts(outline, holes).expect("nothing crosses");
        let whole = signed_area(outline) + holes.iter().map(|h| signed_area(h)).sum::<f64>();
        assert!(parts.iter().all(|p| is_convex(p)), "{parts:?}");
        assert!(
            (area(&parts) - whole).abs() <= 1e-9 * whole,
            "{} instead of {whole}",
            area(&parts)
        );
        parts.len()
    }

    #[test]
    fn few_parts_cover_the_shape() {
        assert_eq!(assert_parts(&square(10.0), &[]), 1);
        assert!(assert_parts(&ell(), &[]) <= 3);
        let hole: Vec<DVec2> =
            square(4.0).into_iter().rev().map(|p| p + DVec2::splat(3.0)).collect();
        assert!(assert_parts(&square(10.0), &[hole]) <= 6);
    }

    #[test]
    fn crossing_contours_are_covered_more_widely() {
        let bow = [(0.0, 0.0), (10.0, 0.0), (0.0, 10.0), (12.0, 10.0)].map(DVec2::from);
        assert_eq!(convex_parts(&bow, &[]), None);
        assert_eq!(wider_parts(&bow).len(), 1);
        let hole = square(4.0).into_iter().rev().map(|p| p + DVec2::splat(8.0)).collect();
        assert_eq!(convex_parts(&square(10.0), &[hole]), None, "it sticks out");
        assert_eq!(wider_parts(&square(10.0)), [square(10.0)]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn stars_are_covered_by_convex_parts(radii in prop::collection::vec(2.0..60.0_f64, 5..24)) {
            let n = radii.len() as f64;
            let star: Vec<DVec2> = radii.iter().enumerate()
                .map(|(i, r)| DVec2::from_angle(i as f64 * std::f64::consts::TAU / n) * r).collect();
            assert_parts(&star, &[]);
        }
    }
}
