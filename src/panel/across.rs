//! The picture across an edge: how far the sides of two plates move in from it, at their fronts and
//! at their backs.
//!
//! Looked at along the edge, a plate is a strip between its back and front offsets, and its
//! neighbour the same strip turned by the fold angle φ. With n its normal and u the direction out
//! of it, square to the edge, a point is o·n + s·u; the neighbour's normal is n·cos φ + u·sin φ.
//! All joints are lines s(o) in that picture; the *inset* is −s.

/// Mitres between plates of different thickness are no steeper than this, in degrees off square;
/// where the edge is so flat that they would be, the mitre bisects the angle and the surfaces step.
const STEEPEST: f64 = 80.0;

/// How far a side of a plate lies inside of the edge, in mm; negative outside.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inset {
    /// In the front plane.
    pub front: f64,
    /// In the back plane.
    pub back: f64,
    /// Of the ends of fingers, where there are any; front and back are then their roots.
    pub tip: Option<f64>,
}

impl Inset {
    /// How far inside the side is at the innermost of front and back.
    pub fn inner(&self) -> f64 {
        self.front.max(self.back)
    }

    /// The same at the outermost: the long point, where glass is measured.
    pub fn outer(&self) -> f64 {
        self.front.min(self.back)
    }

    /// The angle of the cut off square in radians: positive where the front is longer, negative
    /// where the back is.
    pub fn bevel(&self, thickness: f64) -> f64 {
        ((self.back - self.front) / thickness).atan()
    }
}

/// The picture across an edge, seen from one of its plates.
pub(super) struct Across {
    /// The fold angle in radians.
    pub fold: f64,
    /// The offsets of front and back of the plate itself.
    pub own: [f64; 2],
    /// Those of its neighbour.
    pub other: [f64; 2],
}

/// Cut square where it is innermost.
pub(super) fn squared(inset: Inset) -> Inset {
    let inner = inset.inner();
    Inset { front: inner, back: inner, tip: inset.tip }
}

impl Across {
    /// The slope ds/do of the plane in which the plates meet: through the lines where their fronts
    /// and their backs meet.
    fn slope(&self) -> f64 {
        let [t, u] = [self.own, self.other].map(|[front, back]| front - back);
        // Equal plates bisect the angle, whatever it is; so they do while all thicknesses shrink to
        // nothing.
        let exact = if t == u {
            (self.fold / 2.0).tan()
        } else {
            (u - t * self.fold.cos()) / (t * self.fold.sin())
        };
        if t != u && exact.abs() > STEEPEST.to_radians().tan() || !exact.is_finite() {
            (self.fold / 2.0).tan()
        } else {
            exact
        }
    }

    pub fn is_stepped(&self) -> bool {
        let [t, u] = [self.own, self.other].map(|[front, back]| front - back);
        let exact = (u - t * self.fold.cos()) / (t * self.fold.sin());
        // At a flat edge this is 0/0, or a number over 0.
        t != u && (exact.is_nan() || exact.abs() > STEEPEST.to_radians().tan())
    }

    pub fn mitre(&self, gap: f64) -> Inset {
        let slope = self.slope();
        let back_off = gap / 2.0 * slope.hypot(1.0);
        let [front, back] = self.own.map(|o| back_off - o * slope);
        Inset { front, back, tip: None }
    }

    /// The same edge with concave turned into convex: seen from behind.
    fn convex_view(&self) -> Across {
        if self.fold >= 0.0 {
            return Across { fold: self.fold, own: self.own, other: self.other };
        }
        let mirrored = |[front, back]: [f64; 2]| [-back, -front];
        Across { fold: -self.fold, own: mirrored(self.own), other: mirrored(self.other) }
    }

    /// The inset at an own offset of the neighbour's plane at its offset `p`.
    fn at_plane(&self, own: f64, p: f64) -> f64 {
        (own * self.fold.cos() - p) / self.fold.sin()
    }

    /// Puts values for the outer and inner offset of the convex view back to front and back.
    fn seen(&self, outer: f64, inner: f64) -> Inset {
        let (front, back) = if self.fold >= 0.0 { (outer, inner) } else { (inner, outer) };
        Inset { front, back, tip: None }
    }

    /// Of a butt joint, the plate that runs through to the outer side of the other.
    pub fn through(&self) -> Inset {
        let view = self.convex_view();
        let [outer, inner] = view.own.map(|o| view.at_plane(o, view.other[0]));
        self.seen(outer, inner)
    }

    /// Of a butt joint, the plate that stops at the inner side of the other.
    pub fn stopped(&self, gap: f64) -> Inset {
        let view = self.convex_view();
        let [outer, inner] = view.own.map(|o| view.at_plane(o, view.other[1] - gap));
        self.seen(outer, inner)
    }

    /// Fingers: the roots leave room for the slab of the neighbour, the tips are flush with its
    /// outer side.
    pub fn finger(&self) -> Inset {
        let view = self.convex_view();
        let inmost = |p: f64| {
            view.own.map(|o| view.at_plane(o, p)).into_iter().fold(f64::NEG_INFINITY, f64::max)
        };
        let [tip, root] = view.other.map(inmost);
        Inset { front: root, back: root, tip: Some(tip) }
    }

    /// The distances between the two plates at front and back.
    pub fn opening(&self, own: Inset, other: Inset) -> [f64; 2] {
        let (sin, cos) = self.fold.sin_cos();
        let distance = |(o, inset): (f64, f64), (p, across): (f64, f64)| {
            // The neighbour's point p·n' − inset'·u', with u' = −u·cos φ + n·sin φ.
            let (up, out) = (p * cos - across * sin - o, p * sin + across * cos + inset);
            up.hypot(out)
        };
        [
            distance((self.own[0], own.front), (self.other[0], other.front)),
            distance((self.own[1], own.back), (self.other[1], other.back)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn across(fold: f64, own: [f64; 2], other: [f64; 2]) -> Across {
        Across { fold: fold.to_radians(), own, other }
    }

    #[test]
    fn equal_plates_bisect_and_open_square_cuts_by_twice_the_sine() {
        for fold in [-120.0_f64, -30.0, 0.0, 10.0, 90.0, 150.0] {
            let plates = across(fold, [0.0, -4.0], [0.0, -4.0]);
            let mitre = plates.mitre(0.0);
            assert!((mitre.bevel(4.0).to_degrees() - fold / 2.0).abs() < 1e-12, "{fold}");
            assert!(plates.opening(mitre, mitre).iter().all(|&d| d < 1e-12), "{fold}");
            let square = squared(mitre);
            let opening = plates.opening(square, square);
            let widest = opening[0].max(opening[1]);
            assert!(
                (widest - 8.0 * (fold.abs().to_radians() / 2.0).sin()).abs() < 1e-12,
                "{fold}: {opening:?}"
            );
            assert!(opening[0].min(opening[1]) < 1e-12);
        }
    }

    #[test]
    fn the_gap_is_measured_square_to_the_cut() {
        let plates = across(60.0, [3.0, 0.0], [3.0, 0.0]);
        let opening = plates.opening(plates.mitre(8.0), plates.mitre(8.0));
        assert!(opening.iter().all(|d| (d - 8.0).abs() < 1e-12), "{opening:?}");
    }

    #[test]
    fn unequal_plates_meet_on_the_lines_of_their_fronts_and_backs() {
        let (own, other) = ([2.0, -2.0], [5.0, -5.0]);
        let (here, there) = (across(100.0, own, other), across(100.0, other, own));
        let opening = here.opening(here.mitre(0.0), there.mitre(0.0));
        assert!(opening.iter().all(|&d| d < 1e-12), "{opening:?}");
        assert!(
            !here.is_stepped()
                && across(2.0, own, other).is_stepped()
                && across(0.0, own, other).is_stepped()
        );
    }

    #[test]
    fn a_right_angled_butt_and_finger_joint_take_the_thickness() {
        let (thick, thin) = ([0.0, -6.0], [0.0, -4.0]);
        let through = across(90.0, thick, thin).through();
        assert!(through.front.abs() < 1e-12 && through.back.abs() < 1e-12);
        let stopped = across(90.0, thin, thick).stopped(1.0);
        assert!((stopped.front - 7.0).abs() < 1e-12 && (stopped.back - 7.0).abs() < 1e-12);
        let finger = across(90.0, thin, thick).finger();
        assert!((finger.front - 6.0).abs() < 1e-12 && finger.tip.is_some_and(|t| t.abs() < 1e-12));
        // Seen from behind a concave edge is the same joint.
        let concave = across(-90.0, [4.0, 0.0], [6.0, 0.0]).finger();
        assert!(
            (concave.front - 6.0).abs() < 1e-12 && concave.tip.is_some_and(|t| t.abs() < 1e-12)
        );
    }
}
