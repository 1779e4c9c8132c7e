//! What of a fold is left where notches of a joint begin at its ends.

use glam::DVec2;

use super::super::distance::edges;
use crate::geom::polygon::{Location, locate};
use crate::net::{Piece, Segment};

/// Parts of a fold shorter than this share of it are none: rounding at the corners where folds
/// begin.
const NONE: f64 = 1e-9;

/// The parts of a segment that lie on the material of a piece, from its beginning to its end.
pub(crate) fn on_material(piece: &Piece, [a, b]: Segment) -> Vec<Segment> {
    let contours = || std::iter::once(&piece.outline).chain(&piece.holes);
    let along = b - a;
    let mut cuts = vec![0.0, 1.0];
    for (c, d) in contours().flat_map(|contour| edges(contour)) {
        let edge = d - c;
        let cross = along.perp_dot(edge);
        let (t, u) = ((c - a).perp_dot(edge) / cross, (c - a).perp_dot(along) / cross);
        // Parallel edges give no finite numbers and cross nothing. A corner on the fold is met by
        // rounding only; a needless cut does no harm, since parts that follow each other are joined
        // again.
        if t > 0.0 && t < 1.0 && (-NONE..=1.0 + NONE).contains(&u) {
            cuts.push(t);
        }
    }
    cuts.sort_by(f64::total_cmp);
    let is_material = |t: f64| {
        let p = a.lerp(b, t);
        // Where an edge of a joint runs along the fold the edge is cut, and there is nothing to
        // fold.
        let is_cut = contours()
            .flat_map(|c| edges(c))
            .any(|(c, d)| distance_to(p, c, d) <= NONE * along.length());
        !is_cut
            && contours().enumerate().all(|(i, c)| (locate(c, p) == Location::Inside) == (i == 0))
    };
    let mut parts: Vec<[f64; 2]> = Vec::new();
    for w in cuts.windows(2).filter(|w| w[1] - w[0] > NONE && is_material(w[0].midpoint(w[1]))) {
        match parts.last_mut() {
            Some(last) if w[0] - last[1] <= NONE => last[1] = w[1],
            _ => parts.push([w[0], w[1]]),
        }
    }
    parts.into_iter().map(|ends| ends.map(|t| if t == 1.0 { b } else { a.lerp(b, t) })).collect()
}

/// The distance of a point from a segment.
fn distance_to(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    p.distance(a + along * t)
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::{piece, ring, square};
    use super::*;
    use crate::net::PieceId;

    #[test]
    fn only_what_lies_on_material_is_left() {
        let plate = piece(PieceId(0), square(30.0));
        let from = |x: f64, y: f64, u: f64, v: f64| [DVec2::new(x, y), DVec2::new(u, v)];
        assert_eq!(on_material(&plate, from(0.0, 0.0, 30.0, 30.0)), [from(0.0, 0.0, 30.0, 30.0)]);
        let near = |found: &[Segment], expected: &[Segment]| {
            // Ends that are crossings are constructed points and carry a rounding.
            found.len() == expected.len()
                && found
                    .iter()
                    .zip(expected)
                    .all(|(f, e)| f.iter().zip(e).all(|(p, q)| p.distance(*q) < 1e-14 * 30.0))
        };
        assert!(near(
            &on_material(&plate, from(-10.0, 15.0, 20.0, 15.0)),
            &[from(0.0, 15.0, 20.0, 15.0)]
        ));
        assert_eq!(on_material(&plate, from(-10.0, 15.0, -5.0, 15.0)), [[DVec2::ZERO; 2]; 0]);
        let parts = on_material(&ring(PieceId(0)), from(0.0, 15.0, 30.0, 15.0));
        assert!(near(&parts, &[from(0.0, 15.0, 10.0, 15.0), from(20.0, 15.0, 30.0, 15.0)]));
        // An edge of a joint along the beginning of a fold is a cut, whichever way its corners are
        // rounded.
        let notched = [
            (0.0, 0.0),
            (30.0, 0.0),
            (30.0, 20.0),
            (0.0, 20.0),
            (0.0, 10.0),
            (5.0, 10.0),
            (5.0, 5.0),
            (0.0, 5.0),
        ];
        let turn = DVec2::from_angle(0.7);
        let notched =
            piece(PieceId(0), notched.map(|(x, y)| turn.rotate(DVec2::new(x, y))).to_vec());
        let fold = from(0.0, 10.0, 30.0, 10.0).map(|p| turn.rotate(p));
        assert!(near(
            &on_material(&notched, fold),
            &[from(5.0, 10.0, 30.0, 10.0).map(|p| turn.rotate(p))]
        ));
    }
}
