//! How large panels are where: a factor for each vertex.
//!
//! Rows that fan out or close in would end in dislocations, pairs of pentagons and heptagons. A
//! lattice whose size changes with the field needs none: dσ = ∗dθ for the logarithm σ of the size
//! (rows as the curves of a conformal map; Springborn, Schröder, Pinkall 2008). The change is held
//! within bounds, at the cost of panels of unequal size.

use glam::DVec3;

use super::curvature::Quadric;
use super::field::{RowField, angle_in};
use super::surface::Surface;
use crate::geom::fronts::Fronts;

/// The gradient of a scale field and of hat functions on one triangle.
struct Triangle {
    /// The gradients of the three hat functions.
    hats: [DVec3; 3],
    area: f64,
}

/// The factors by which panels are larger or smaller, `limit` the most of their logarithm; their
/// squares have the mean 1 over the area. All are 1 when the limit is 0.
pub(super) fn scale_field(
    surface: &Surface,
    quadrics: &[Quadric],
    field: &RowField,
    limit: f64,
) -> Vec<f64> {
    let even = vec![1.0; surface.points.len()];
    if limit <= 0.0 {
        return even;
    }
    let Some(logarithms) = solve(surface, quadrics, field) else { return even };
    let area = surface.area();
    let mean =
        |values: &[f64]| values.iter().zip(&surface.areas).map(|(x, a)| x * a).sum::<f64>() / area;
    let middle = mean(&logarithms);
    let held: Vec<f64> =
        logarithms.iter().map(|s| (limit * ((s - middle) / limit).tanh()).exp()).collect();
    let squares: Vec<f64> = held.iter().map(|s| s * s).collect();
    let scale = mean(&squares).sqrt();
    held.iter().map(|s| s / scale).collect()
}

/// The function whose gradient comes nearest to the field's turning, turned by a right angle.
fn solve(surface: &Surface, quadrics: &[Quadric], field: &RowField) -> Option<Vec<f64>> {
    let cliques = surface
        .triangles
        .iter()
        .map(|t| t.to_vec())
        .chain((0..surface.points.len()).map(|v| vec![v]));
    let mut fronts = Fronts::new(&surface.points, cliques.collect(), 1);
    let mut matrix = fronts.zeros();
    let mut right = vec![0.0; surface.points.len()];
    for (k, &t) in surface.triangles.iter().enumerate() {
        let Some(triangle) = Triangle::new(t.map(|i| surface.points[i])) else { continue };
        let wish = triangle.wish(surface, quadrics, field, t);
        let mut block = [0.0; 9];
        for i in 0..3 {
            right[t[i]] += triangle.hats[i].dot(wish) * triangle.area;
            for j in 0..3 {
                block[3 * i + j] = triangle.hats[i].dot(triangle.hats[j]) * triangle.area;
            }
        }
        fronts.add(&mut matrix, k, &block);
    }
    for (v, area) in surface.areas.iter().enumerate() {
        fronts.add(&mut matrix, surface.triangles.len() + v, &[area * 1e-4]);
    }
    fronts.forget_cliques();
    Some(fronts.factor(matrix, 1e-12)?.solve(&right))
}

impl Triangle {
    fn new([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let normal = (b - a).cross(c - a);
        let double = normal.length();
        if double == 0.0 {
            return None;
        }
        let unit = normal / double;
        let hats = [c - b, a - c, b - a].map(|side| unit.cross(side) / double);
        Some(Self { hats, area: double / 2.0 })
    }

    /// The gradient of the field's angle on the triangle, turned by a right angle.
    fn wish(
        &self,
        surface: &Surface,
        quadrics: &[Quadric],
        field: &RowField,
        t: [usize; 3],
    ) -> DVec3 {
        let turn = |i: usize, j: usize| {
            let way = surface.points[j] - surface.points[i];
            let moved = angle_in(&quadrics[j], way) - angle_in(&quadrics[i], way);
            let sixth = std::f64::consts::FRAC_PI_3;
            let angle = field.angles[j] - field.angles[i] - moved;
            angle - sixth * (angle / sixth).round()
        };
        let gradient = self.hats[1] * turn(t[0], t[1]) + self.hats[2] * turn(t[0], t[2]);
        let normal = (self.hats[0].cross(self.hats[1])).normalize_or_zero();
        -normal.cross(gradient)
    }
}
