//! Volumes and areas on one side of a plane, cube by cube, without any mesh.

use glam::DVec3;

/// The volume of the part of the unit cube at `low` that lies behind the plane n · (x − p) = 0.
pub fn cube_volume_behind(low: DVec3, n: DVec3, p: DVec3) -> f64 {
    // Six tetrahedra around the diagonal: one for each way to walk from the low to the high corner
    // along the axes.
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    let orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let at = |x: DVec3| (x, n.dot(x - p));
    let tetrahedron = |[a, b, _]: [usize; 3]| {
        let (first, second) = (low + axes[a], low + axes[a] + axes[b]);
        [at(low), at(first), at(second), at(low + DVec3::ONE)]
    };
    orders.into_iter().map(|order| behind(tetrahedron(order))).sum()
}

/// The volume behind, by dividing an edge with ends on both sides until none is left.
fn behind(corners: [(DVec3, f64); 4]) -> f64 {
    if corners.iter().all(|c| c.1 <= 0.0) {
        let [a, b, c, d] = corners.map(|c| c.0);
        return (b - a).cross(c - a).dot(d - a).abs() / 6.0;
    }
    if corners.iter().all(|c| c.1 >= 0.0) {
        return 0.0;
    }
    let front = corners.iter().position(|c| c.1 > 0.0).expect("one is in front");
    let back = corners.iter().position(|c| c.1 < 0.0).expect("one is behind");
    let ((x, dx), (y, dy)) = (corners[front], corners[back]);
    let middle = (x + (y - x) * (dx / (dx - dy)), 0.0);
    [front, back]
        .into_iter()
        .map(|replaced| {
            let mut half = corners;
            half[replaced] = middle;
            behind(half)
        })
        .sum()
}

/// The area in which the plane n · (x − p) = 0 meets the unit cube at `low`.
pub fn cube_section(low: DVec3, n: DVec3, p: DVec3) -> f64 {
    let n = n.normalize();
    let centre = low + 0.5;
    let middle = centre - n * n.dot(centre - p);
    let u = n.any_orthonormal_vector();
    let v = n.cross(u);
    let mut polygon: Vec<DVec3> = [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)]
        .iter()
        .map(|&(a, b)| middle + u * a + v * b)
        .collect();
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        polygon = clip(&polygon, axis, axis.dot(low) + 1.0);
        polygon = clip(&polygon, -axis, -axis.dot(low));
    }
    let Some(&first) = polygon.first() else { return 0.0 };
    polygon.windows(2).map(|w| (w[0] - first).cross(w[1] - first).dot(n)).sum::<f64>() / 2.0
}

/// The part of a convex polygon with n · x ≤ d (Sutherland and Hodgman 1974).
fn clip(polygon: &[DVec3], n: DVec3, d: f64) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (da, db) = (n.dot(a) - d, n.dot(b) - d);
        if da <= 0.0 {
            kept.push(a);
        }
        if (da < 0.0 && db > 0.0) || (da > 0.0 && db < 0.0) {
            kept.push(a + (b - a) * (da / (da - db)));
        }
    }
    kept
}
