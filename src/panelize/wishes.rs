//! What the user wants of rows, along the rim or along drawn curves, and of the rim itself.

use glam::DVec3;

use super::curvature::Quadric;
use super::field::Target;
use super::solve::{RimRule, rim_plane_without_rim};
use super::surface::Surface;
use super::{Align, LayoutChoice, PanelizeError, PanelizeParams, RimChoice};
use crate::geom::{AxisBox, BoxTree, nearest_on_segment};

/// Rows along the rim are wanted so much more than rows along curvature.
const RIM_WEIGHT: f64 = 3.0;
/// Rows along a drawn curve are wanted so much more than those along curvature, on the curve. A
/// curve is thin, and the field is drawn to curvature on all the surface beside it.
const CURVE_WEIGHT: f64 = 30.0;
/// So far from a curve rows still follow it, in panel sizes, less and less.
const CURVE_REACH: f64 = 0.75;
/// A curve that rises from the surface more steeply has no direction on it: the cosine.
const STEEPEST: f64 = 0.3;

/// Rows that are wanted besides those along curvature. Lengths are in panel sizes, seen from
/// `origin`.
///
/// # Errors
/// [`PanelizeError::NoCurveThere`] for a drawn curve away from the surface, and for a file of
/// curves that was not read.
pub(super) fn targets(
    surface: &Surface,
    quadrics: &[Quadric],
    params: &PanelizeParams,
    (size, origin): (f64, DVec3),
) -> Result<Vec<Target>, PanelizeError> {
    match &params.align {
        Align::Flat | Align::None => Ok(Vec::new()),
        Align::Rim => Ok(along_rim(surface)),
        Align::Curves(curves) => {
            let scaled = |curve: &Vec<DVec3>| curve.iter().map(|&p| (p - origin) / size).collect();
            let curves: Vec<Vec<DVec3>> = curves.iter().map(scaled).collect();
            along_curves(surface, quadrics, &curves).map_err(|(curve, off)| {
                PanelizeError::NoCurveThere { curve, distance_mm: off * size, size }
            })
        }
        Align::File(path) => Err(PanelizeError::CurvesUnread { path: path.clone() }),
    }
}

fn along_rim(surface: &Surface) -> Vec<Target> {
    let on_rim = (0..surface.points.len()).filter(|&v| surface.is_rim(v) && !surface.is_corner[v]);
    let along =
        |vertex| Target { vertex, direction: surface.rim_direction(vertex), weight: RIM_WEIGHT };
    on_rim.map(along).collect()
}

/// Rows along curves; or the first of them that no vertex is near to, and its distance.
fn along_curves(
    surface: &Surface,
    quadrics: &[Quadric],
    curves: &[Vec<DVec3>],
) -> Result<Vec<Target>, (usize, f64)> {
    let mut segments: Vec<([DVec3; 2], usize)> = Vec::new();
    for (i, curve) in curves.iter().enumerate() {
        let sides = curve.windows(2).map(|w| [w[0], w[1]]);
        segments.extend(sides.filter(|[a, b]| a != b).map(|side| (side, i)));
    }
    let boxes = segments.iter().map(|&(side, _)| AxisBox::of(side));
    let boxes: Vec<AxisBox> = boxes.map(|b| b.unwrap_or(EMPTY)).collect();
    let tree = BoxTree::new(&boxes);
    let mut nearest = vec![f64::INFINITY; curves.len()];
    let mut made = Vec::new();
    for (vertex, &p) in surface.points.iter().enumerate() {
        let off = |s: usize| p.distance(nearest_on_segment(p, segments[s].0));
        let Some((found, distance)) = tree.nearest(p, off) else { continue };
        let ([a, b], curve) = segments[found];
        nearest[curve] = nearest[curve].min(distance);
        let normal = quadrics[vertex].normal;
        let way = (b - a).normalize_or_zero();
        let direction = way - normal * way.dot(normal);
        if distance < CURVE_REACH && direction.length() > STEEPEST {
            let weight = CURVE_WEIGHT * (1.0 - distance / CURVE_REACH);
            made.push(Target { vertex, direction, weight });
        }
    }
    // A curve that lies on another may be the nearest of no vertex.
    for curve in (0..curves.len()).filter(|&i| nearest[i] > CURVE_REACH) {
        let sides = segments.iter().filter(|(_, of)| *of == curve);
        let off = sides.map(|&(side, _)| {
            let off = surface.points.iter().map(|&p| p.distance(nearest_on_segment(p, side)));
            off.fold(f64::INFINITY, f64::min)
        });
        let off = off.fold(f64::INFINITY, f64::min);
        if off > CURVE_REACH {
            return Err((curve, off));
        }
    }
    Ok(made)
}

const EMPTY: AxisBox = AxisBox { low: DVec3::ZERO, high: DVec3::ZERO };

/// What becomes of the rim.
pub(super) fn rim_rule(
    surface: &Surface,
    params: &PanelizeParams,
    (size, origin): (f64, DVec3),
) -> Result<RimRule, PanelizeError> {
    Ok(match &params.rim {
        RimChoice::Free => RimRule::Curve,
        // Rims that turn about an axis have no straight stretches but those of the file.
        RimChoice::Walls if params.layout != LayoutChoice::Free => RimRule::Curve,
        RimChoice::Walls => RimRule::Walls,
        RimChoice::Planes(_) | RimChoice::File(_) | RimChoice::Given(_) => {
            let planes = params.rim_planes(origin, size).unwrap_or_default();
            if let Some(plane) = rim_plane_without_rim(surface, &planes) {
                return Err(PanelizeError::NoRimThere { plane });
            }
            RimRule::Planes(planes)
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::curvature::quadrics;
    use super::super::field::RowField;
    use super::super::refine::Triangles;
    use super::super::surface::SPACING;
    use super::*;

    /// A vault of 12 by 8 panels that bends across x, so that rows along curvature run along y.
    fn vault() -> Surface {
        let point = |i: usize| {
            let (x, y) = ((i % 13) as f64 - 6.0, (i / 13) as f64 - 4.0);
            DVec3::new(x, y, -x * x / 24.0)
        };
        let cells = (0..8).flat_map(|j| (0..12).map(move |i| 13 * j + i));
        let corners = cells.flat_map(|a| [[a, a + 1, a + 14], [a, a + 14, a + 13]]).collect();
        let points = (0..13 * 9).map(point).collect();
        let mut made = Triangles { points, corners, ..Triangles::default() };
        assert!(made.refine(SPACING, 100_000));
        Surface::new(made)
    }

    /// The angle between a row and a direction, 0 to 30 degrees, at the vertex nearest to a place.
    fn off(
        (surface, quadrics): (&Surface, &[Quadric]),
        curves: &[Vec<DVec3>],
        places: &[(DVec3, DVec3)],
    ) -> Vec<f64> {
        let targets = along_curves(surface, quadrics, curves).expect("curves on the surface");
        let field = RowField::new(surface, quadrics, true, &targets).expect("rows");
        let at = |&(place, along): &(DVec3, DVec3)| {
            let row = field.direction(quadrics, surface.nearest(place, 0));
            let angle = row.angle_between(along).to_degrees() % 60.0;
            angle.min(60.0 - angle)
        };
        places.iter().map(at).collect()
    }

    #[test]
    fn rows_follow_a_drawn_curve_and_curvature_far_from_it() {
        let surface = vault();
        // 25° from the rows of curvature, and so as far from another of the six directions.
        let along = DVec3::new(25_f64.to_radians().sin(), 25_f64.to_radians().cos(), 0.0);
        let curve = vec![along * -2.0, along * 2.0];
        let quadrics = quadrics(&surface);
        let known = (&surface, &quadrics[..]);
        let on = [-0.5, 0.0, 0.5].map(|share| (along * share, along));
        let far = (DVec3::new(5.5, 0.0, -1.2), DVec3::Y);
        let found = off(known, &[curve], &[on[0], on[1], on[2], far]);
        assert!(found[..3].iter().all(|angle| *angle < 3.0), "off the curve: {found:?}");
        assert!(found[3] < 6.0, "off curvature, far from the curve: {found:?}");
        assert!(off(known, &[], &[(DVec3::ZERO, DVec3::Y)])[0] < 1.0);
    }

    #[test]
    fn curves_away_from_the_surface_are_told() {
        let surface = vault();
        let quadrics = quadrics(&surface);
        let on = vec![DVec3::ZERO, DVec3::X];
        let away = vec![DVec3::new(0.0, 0.0, 3.0), DVec3::new(1.0, 0.0, 3.0)];
        let found = |curves: &[Vec<DVec3>]| along_curves(&surface, &quadrics, curves);
        // The same curve twice is no fault.
        assert!(found(&[on.clone(), on.clone()]).is_ok());
        let (curve, off) = found(&[on.clone(), away]).expect_err("too far");
        assert!(curve == 1 && (2.9..3.1).contains(&off), "{curve} {off}");
        let (curve, off) = found(&[vec![DVec3::ZERO], on]).expect_err("no length");
        assert!(curve == 0 && off.is_infinite());
    }
}
