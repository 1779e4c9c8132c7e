//! Curves as polylines.

use std::f64::consts::TAU;

use glam::{DAffine2, DVec2};
use kurbo::{Arc, CubicBez, PathEl, Point, QuadBez, SvgArc, Vec2};

use super::ArtError;
use super::budget::{Budget, Cost};

/// Points on a curve's way after its beginning; `scale` is how much larger it will be in
/// millimetres.
pub(super) struct Flattener<'a> {
    /// Largest distance from the true curve, in the curve's own units.
    tolerance: f64,
    budget: &'a Budget,
}

/// Degrees of splines that are read; no program offers more.
pub(super) const HIGHEST_DEGREE: usize = 25;

impl<'a> Flattener<'a> {
    pub fn new(scale: f64, budget: &'a Budget) -> Self {
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        Self { tolerance: budget.flatness.unwrap_or(super::FLATNESS) / scale, budget }
    }

    /// For a transform: by its larger stretch.
    pub fn of(transform: &DAffine2, budget: &'a Budget) -> Self {
        let m = transform.matrix2;
        Self::new(m.x_axis.length().max(m.y_axis.length()), budget)
    }

    /// As many pieces as are wanted, at least one; an error where no budget would do.
    fn pieces(&self, wanted: f64) -> Result<usize, ArtError> {
        if !wanted.is_finite() {
            return Err(ArtError::OutOfRange { what: "a curve".to_owned() });
        }
        let pieces = wanted.ceil().max(1.0) as usize;
        self.budget.expect(Cost::Points, pieces)?;
        Ok(pieces)
    }

    /// A cubic Bézier curve.
    pub fn cubic(&self, [a, b, c, d]: [DVec2; 4], out: &mut Vec<DVec2>) -> Result<(), ArtError> {
        let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
        // Wang's bound is never less than what is needed.
        self.pieces((0.75 * bend / self.tolerance).sqrt())?;
        let curve = CubicBez::new(point(a), point(b), point(c), point(d));
        let path = [PathEl::MoveTo(curve.p0), PathEl::CurveTo(curve.p1, curve.p2, curve.p3)];
        self.flatten(path, out)
    }

    /// A quadratic Bézier curve.
    pub fn quadratic(&self, [a, b, c]: [DVec2; 3], out: &mut Vec<DVec2>) -> Result<(), ArtError> {
        let bend = (a - 2.0 * b + c).length();
        self.pieces((0.25 * bend / self.tolerance).sqrt())?;
        let curve = QuadBez::new(point(a), point(b), point(c));
        self.flatten([PathEl::MoveTo(curve.p0), PathEl::QuadTo(curve.p1, curve.p2)], out)
    }

    fn flatten(&self, path: [PathEl; 2], out: &mut Vec<DVec2>) -> Result<(), ArtError> {
        let before = out.len();
        kurbo::flatten(path, self.tolerance, |element| {
            if let PathEl::LineTo(p) = element {
                out.push(DVec2::new(p.x, p.y));
            }
        });
        self.budget.spend(Cost::Points, out.len() - before)
    }

    /// An elliptic arc: centre + cos t · `x` + sin t · `y`, from `from` over `sweep` radians.
    pub fn arc(
        &self,
        centre: DVec2,
        [x, y]: [DVec2; 2],
        (from, sweep): (f64, f64),
        out: &mut Vec<DVec2>,
    ) -> Result<(), ArtError> {
        let radius = x.length().max(y.length());
        let share = (self.tolerance / radius).min(0.5);
        // The half angle of a chord whose rise is that share of the radius.
        let step = 2.0 * (2.0 * (share / 2.0).sqrt().asin());
        let pieces = self.pieces(if radius == 0.0 { 1.0 } else { sweep.abs() / step })?;
        self.budget.spend(Cost::Points, pieces)?;
        for i in 1..=pieces {
            let t = from + sweep * i as f64 / pieces as f64;
            out.push(centre + x * t.cos() + y * t.sin());
        }
        Ok(())
    }

    /// A whole ellipse, closed, its first point not repeated.
    pub fn ellipse(&self, centre: DVec2, axes: [DVec2; 2]) -> Result<Vec<DVec2>, ArtError> {
        let mut points = vec![];
        self.arc(centre, axes, (0.0, TAU), &mut points)?;
        // It ends where it begins: at the end of the first axis.
        points.rotate_right(1);
        Ok(points)
    }

    /// The arc of a bulge (tangent of a quarter of its angle, positive to the left of the way) from
    /// a to b.
    pub fn bulge(
        &self,
        a: DVec2,
        b: DVec2,
        bulge: f64,
        out: &mut Vec<DVec2>,
    ) -> Result<(), ArtError> {
        let chord = b - a;
        if bulge == 0.0 || chord == DVec2::ZERO {
            out.push(b);
            return self.budget.spend(Cost::Points, 1);
        }
        let sweep = 4.0 * bulge.atan();
        let centre = a + chord / 2.0 + chord.perp() * ((1.0 - bulge * bulge) / (4.0 * bulge));
        let x = a - centre;
        self.arc(centre, [x, x.perp()], (0.0, sweep), out)?;
        out.pop();
        out.push(b);
        Ok(())
    }

    /// The arc of an SVG path from a to b: radii, the turn of the x axis in degrees, the flags for
    /// the large arc and for the positive direction.
    pub fn svg_arc(
        &self,
        [a, b]: [DVec2; 2],
        radii: DVec2,
        turn: f64,
        [large_arc, sweep]: [bool; 2],
        out: &mut Vec<DVec2>,
    ) -> Result<(), ArtError> {
        if a == b {
            return Ok(());
        }
        let arc = SvgArc {
            from: point(a),
            to: point(b),
            radii: Vec2::new(radii.x, radii.y),
            x_rotation: turn.to_radians(),
            large_arc,
            sweep,
        };
        // An arc without a radius is a straight line.
        if let Some(arc) = Arc::from_svg_arc(&arc) {
            let axis = DVec2::from_angle(arc.x_rotation);
            let axes = [axis * arc.radii.x, axis.perp() * arc.radii.y];
            let centre = DVec2::new(arc.center.x, arc.center.y);
            self.arc(centre, axes, (arc.start_angle, arc.sweep_angle), out)?;
            out.pop();
        }
        out.push(b);
        Ok(())
    }

    /// A rational B-spline (de Boor's algorithm at even steps of every span); nothing where degree,
    /// knots and control points do not fit together.
    pub fn spline(
        &self,
        degree: usize,
        knots: &[f64],
        control: &[(DVec2, f64)],
    ) -> Result<Option<Vec<DVec2>>, ArtError> {
        let is_sound = (1..=HIGHEST_DEGREE).contains(&degree)
            && control.len() > degree
            && knots.len() == control.len() + degree + 1;
        if !is_sound {
            return Ok(None);
        }
        let mut points = Vec::new();
        for k in degree..control.len() {
            let (from, to) = (knots[k], knots[k + 1]);
            // Empty spans, and those with knots that are no numbers.
            if to <= from || !(to - from).is_finite() {
                continue;
            }
            let legs = control[k - degree..=k].windows(2);
            let way: f64 = legs.map(|w| w[0].0.distance(w[1].0)).sum();
            // From the second derivative, which grows with the degree and with the way.
            let bend = (degree * degree) as f64 * way / 4.0;
            let pieces = self.pieces((bend / self.tolerance).sqrt().max(4.0))?;
            self.budget.spend(Cost::Points, pieces)?;
            self.budget.spend(Cost::Steps, pieces * (degree + 1) * (degree + 1))?;
            let first = usize::from(!points.is_empty());
            for i in first..=pieces {
                let u = from + (to - from) * i as f64 / pieces as f64;
                points.push(de_boor(k, u, degree, knots, control));
            }
        }
        Ok(Some(points))
    }
}

fn point(p: DVec2) -> Point {
    Point::new(p.x, p.y)
}

fn de_boor(k: usize, u: f64, degree: usize, knots: &[f64], control: &[(DVec2, f64)]) -> DVec2 {
    let mut d = [(DVec2::ZERO, 0.0); HIGHEST_DEGREE + 1];
    for (here, &(p, w)) in d.iter_mut().zip(&control[k - degree..=k]) {
        *here = (p * w, w);
    }
    for r in 1..=degree {
        for j in (r..=degree).rev() {
            let i = j + k - degree;
            let width = knots[i + degree + 1 - r] - knots[i];
            let a = if width > 0.0 { (u - knots[i]) / width } else { 0.0 };
            d[j] = (d[j - 1].0.lerp(d[j].0, a), d[j - 1].1 + (d[j].1 - d[j - 1].1) * a);
        }
    }
    d[degree].0 / d[degree].1
}

/// The sweep of an arc that runs counter-clockwise from one angle to another, in radians in
/// (0, 2π]. What spans a whole turn or a bit more, as rounding writes it, is a whole turn.
pub(super) fn sweep_between(from: f64, to: f64) -> f64 {
    let bit = 1e-12 * (1.0 + from.abs() + to.abs());
    let sweep = (to - from).rem_euclid(TAU);
    if to - from >= TAU - bit || sweep <= bit { TAU } else { sweep }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_and_a_bit_is_a_turn() {
        assert_eq!(sweep_between(0.0, 6.283185308), TAU);
        assert_eq!(sweep_between(0.0, 0.0), TAU);
        assert_eq!(sweep_between(1.0, 1.0 + TAU), TAU);
        assert!((sweep_between(3.0, 1.0) - (TAU - 2.0)).abs() < 1e-15);
        assert!((sweep_between(0.0, 1e-3) - 1e-3).abs() < 1e-15);
    }

    #[test]
    fn curves_stay_within_the_flatness_of_a_fine_one() {
        let budget = Budget::default();
        let (coarse, fine) = (Flattener::new(1.0, &budget), Flattener::new(1e4, &budget));
        let bow = [(0.0, 0.0), (90.0, 10.0), (-30.0, 40.0), (50.0, 60.0)].map(DVec2::from);
        let [mut few, mut many] = [vec![bow[0]], vec![bow[0]]];
        assert!(coarse.cubic(bow, &mut few).is_ok() && fine.cubic(bow, &mut many).is_ok());
        let off = |p: DVec2| {
            let to = |w: &[DVec2]| {
                let t = ((p - w[0]).dot(w[1] - w[0]) / w[0].distance_squared(w[1])).clamp(0.0, 1.0);
                p.distance(w[0].lerp(w[1], t))
            };
            few.windows(2).map(to).fold(f64::INFINITY, f64::min)
        };
        let worst = many.iter().map(|&p| off(p)).fold(0.0, f64::max);
        assert!(worst <= crate::io::read::artwork::FLATNESS, "{worst}");
    }
}
