//! Curves as polylines.

use std::f64::consts::{PI, TAU};

use glam::{DAffine2, DVec2};

/// Points on a curve's way after its beginning; `scale` is how much larger it will be in
/// millimetres.
pub(super) struct Flattener {
    /// Largest distance from the true curve, in the curve's own units.
    tolerance: f64,
}

/// No curve needs more pieces than this.
const MOST: f64 = 2000.0;

impl Flattener {
    pub fn new(scale: f64) -> Self {
        let scale = if scale.is_finite() && scale > 0.0 { scale } else { 1.0 };
        Self { tolerance: super::FLATNESS / scale }
    }

    /// For a transform: by its larger stretch.
    pub fn of(transform: &DAffine2) -> Self {
        let m = transform.matrix2;
        Self::new(m.x_axis.length().max(m.y_axis.length()))
    }

    /// A cubic Bézier curve. As many pieces as its second differences demand (Wang's bound).
    pub fn cubic(&self, [a, b, c, d]: [DVec2; 4], out: &mut Vec<DVec2>) {
        let bend = (a - 2.0 * b + c).length().max((b - 2.0 * c + d).length());
        let pieces = (0.75 * bend / self.tolerance).sqrt().ceil().clamp(1.0, MOST) as usize;
        for i in 1..=pieces {
            let t = i as f64 / pieces as f64;
            let s = 1.0 - t;
            out.push(if i == pieces {
                d
            } else {
                a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t)
            });
        }
    }

    /// A quadratic Bézier curve.
    pub fn quadratic(&self, [a, b, c]: [DVec2; 3], out: &mut Vec<DVec2>) {
        self.cubic([a, a.lerp(b, 2.0 / 3.0), c.lerp(b, 2.0 / 3.0), c], out);
    }

    /// An elliptic arc: centre + cos t · `x` + sin t · `y`, from `from` over `sweep` radians.
    pub fn arc(
        &self,
        centre: DVec2,
        [x, y]: [DVec2; 2],
        (from, sweep): (f64, f64),
        out: &mut Vec<DVec2>,
    ) {
        let radius = x.length().max(y.length());
        let step = 2.0 * (1.0 - (self.tolerance / radius).min(0.5)).acos();
        let pieces = (sweep.abs() / step).ceil().clamp(1.0, MOST) as usize;
        for i in 1..=pieces {
            let t = from + sweep * i as f64 / pieces as f64;
            out.push(centre + x * t.cos() + y * t.sin());
        }
    }

    /// A whole ellipse, closed, its first point not repeated.
    pub fn ellipse(&self, centre: DVec2, axes: [DVec2; 2]) -> Vec<DVec2> {
        let mut points = vec![];
        self.arc(centre, axes, (0.0, TAU), &mut points);
        // It ends where it begins: at the end of the first axis.
        points.rotate_right(1);
        points
    }

    /// The arc of a bulge (tangent of a quarter of its angle, positive to the left of the way) from
    /// a to b.
    pub fn bulge(&self, a: DVec2, b: DVec2, bulge: f64, out: &mut Vec<DVec2>) {
        let chord = b - a;
        if bulge == 0.0 || chord == DVec2::ZERO || !bulge.is_finite() {
            out.push(b);
            return;
        }
        let sweep = 4.0 * bulge.atan();
        let centre = a + chord / 2.0 + chord.perp() * ((1.0 - bulge * bulge) / (4.0 * bulge));
        let x = a - centre;
        self.arc(centre, [x, x.perp()], (0.0, sweep), out);
        if let Some(last) = out.last_mut() {
            *last = b;
        }
    }

    /// The arc of an SVG path from a to b (its implementation notes, F.6.5): radii, the turn of the
    /// x axis in degrees, the flags for the large arc and for the positive direction.
    pub fn svg_arc(
        &self,
        [a, b]: [DVec2; 2],
        radii: DVec2,
        turn: f64,
        [large, positive]: [bool; 2],
        out: &mut Vec<DVec2>,
    ) {
        let radii = radii.abs();
        if a == b {
            return;
        }
        if radii.min_element() == 0.0 || !radii.is_finite() {
            out.push(b);
            return;
        }
        let axis = DVec2::from_angle(turn.to_radians());
        // In a frame where the ellipse is a unit circle.
        let back = DVec2::from_angle(-turn.to_radians());
        let flat = |p: DVec2| back.rotate(p) / radii;
        let half = flat((a - b) / 2.0);
        let stretch = half.length().max(1.0);
        let half = half / stretch;
        let rest = (1.0 / half.length_squared() - 1.0).max(0.0).sqrt();
        let sign = if large == positive { -1.0 } else { 1.0 };
        let centre = DVec2::new(half.y, -half.x) * (sign * rest);
        let angle = |p: DVec2| p.y.atan2(p.x);
        let from = angle(half - centre);
        let mut sweep = angle(-half - centre) - from;
        if positive && sweep < 0.0 {
            sweep += TAU;
        } else if !positive && sweep > 0.0 {
            sweep -= TAU;
        }
        let radii = radii * stretch;
        let [x, y] = [axis * radii.x, axis.perp() * radii.y];
        let middle = a.midpoint(b) + axis.rotate(centre * radii);
        self.arc(middle, [x, y], (from, sweep), out);
        if let Some(last) = out.last_mut() {
            *last = b;
        }
    }

    /// A rational B-spline (de Boor's algorithm at even steps of every span).
    pub fn spline(&self, degree: usize, knots: &[f64], control: &[(DVec2, f64)]) -> Vec<DVec2> {
        let mut points = Vec::new();
        let sound =
            degree >= 1 && control.len() > degree && knots.len() == control.len() + degree + 1;
        if !sound {
            return control.iter().map(|c| c.0).collect();
        }
        for k in degree..control.len() {
            let (from, to) = (knots[k], knots[k + 1]);
            if to <= from || !(to - from).is_finite() {
                continue;
            }
            let way: f64 =
                control[k - degree..=k].windows(2).map(|w| w[0].0.distance(w[1].0)).sum();
            let pieces = (way / self.tolerance).sqrt().ceil().clamp(4.0, 500.0) as usize;
            let first = usize::from(!points.is_empty());
            for i in first..=pieces {
                let u = from + (to - from) * i as f64 / pieces as f64;
                points.push(de_boor(k, u, degree, knots, control));
            }
        }
        points
    }
}

fn de_boor(k: usize, u: f64, degree: usize, knots: &[f64], control: &[(DVec2, f64)]) -> DVec2 {
    let mut d: Vec<(DVec2, f64)> =
        control[k - degree..=k].iter().map(|&(p, w)| (p * w, w)).collect();
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

/// The sweep of an arc that runs counter-clockwise from one angle to another, in degrees, as
/// radians in (0, 2π].
pub(super) fn sweep_between(from: f64, to: f64) -> f64 {
    let sweep = (to - from).to_radians().rem_euclid(TAU);
    if sweep < 1e-12 * PI { TAU } else { sweep }
}
