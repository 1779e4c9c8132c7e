//! Lines that two parts share are cut once: what has been drawn for one part is left out of the
//! next.

use glam::DVec2;

use super::drawing::{Drawing, LayerKind, Mark, Stroke};

impl Drawing {
    /// Leaves out of every closed cut what runs along another cut before it, up to `tolerance` mm,
    /// and keeps the whole contours for [`Drawing::parts`]. Returns the length that is left out.
    pub(crate) fn cut_once(&mut self, tolerance: f64) -> f64 {
        let mut drawn: Vec<[DVec2; 2]> = Vec::new();
        let mut saved = 0.0;
        for layer in &mut self.layers {
            if !matches!(layer.kind, LayerKind::CutInner | LayerKind::CutOuter) {
                continue;
            }
            for mark in &mut layer.marks {
                let Some(ring) = ring(mark) else { continue };
                let left = left_of(&ring, &drawn, tolerance);
                drawn.extend((0..ring.len()).map(|i| [ring[i], ring[(i + 1) % ring.len()]]));
                if let Some(left) = left {
                    let length = mark.strokes[0].length();
                    let whole = std::mem::replace(&mut mark.strokes, left);
                    saved += length - mark.strokes.iter().map(Stroke::length).sum::<f64>();
                    self.whole.push(Mark { strokes: whole, ..mark.clone() });
                }
            }
            layer.marks.retain(|m| !m.strokes.is_empty());
        }
        saved
    }
}

/// The points of a mark that is one closed line.
fn ring(mark: &Mark) -> Option<Vec<DVec2>> {
    match mark.strokes.as_slice() {
        [stroke] if stroke.closed && stroke.points.len() > 2 => Some(stroke.points.clone()),
        _ => None,
    }
}

/// The open lines that are left of a ring without what is drawn already; nothing when it stays
/// whole.
fn left_of(ring: &[DVec2], drawn: &[[DVec2; 2]], tolerance: f64) -> Option<Vec<Stroke>> {
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    let (mut is_whole, mut goes_on) = (true, false);
    for (i, &p) in ring.iter().enumerate() {
        let q = ring[(i + 1) % ring.len()];
        let length = p.distance(q);
        let free = free_stretches([p, q], drawn, tolerance);
        is_whole &= free == [[0.0, length]];
        for &[from, to] in &free {
            let end = if to == length { q } else { p.lerp(q, to / length) };
            match lines.last_mut().filter(|_| from == 0.0 && goes_on) {
                Some(line) => line.push(end),
                None => {
                    lines.push(vec![if from == 0.0 { p } else { p.lerp(q, from / length) }, end])
                }
            }
        }
        goes_on = free.last().is_some_and(|f| f[1] == length);
    }
    if is_whole {
        return None;
    }
    // The last line may run into the first one.
    if goes_on && lines.len() > 1 && lines[0][0] == ring[0] {
        let first = lines.remove(0);
        if let Some(last) = lines.last_mut() {
            last.extend(&first[1..]);
        }
    }
    Some(lines.into_iter().map(|points| Stroke { points, closed: false }).collect())
}

/// The stretches of a side, from and to in mm along it, on which nothing is drawn.
fn free_stretches([p, q]: [DVec2; 2], drawn: &[[DVec2; 2]], tolerance: f64) -> Vec<[f64; 2]> {
    let length = p.distance(q);
    let along = (q - p) / length;
    let grown = DVec2::splat(tolerance);
    let (low, high) = (p.min(q) - grown, p.max(q) + grown);
    let covers = |&[r, s]: &[DVec2; 2]| {
        if r.max(s).cmplt(low).any() || r.min(s).cmpgt(high).any() {
            return None;
        }
        let is_on = [r, s].iter().all(|&e| along.perp_dot(e - p).abs() <= tolerance);
        let (a, b) = (along.dot(r - p), along.dot(s - p));
        is_on.then_some([a.min(b), a.max(b)])
    };
    let mut covered: Vec<[f64; 2]> =
        drawn.iter().filter_map(covers).filter(|c| c[1] - c[0] > tolerance).collect();
    covered.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut free = Vec::new();
    let mut at = 0.0;
    // What only touches an end of the side covers nothing of it.
    for [from, to] in covered.into_iter().filter(|c| c[0] < length - tolerance) {
        if to <= at + tolerance {
            continue;
        }
        if from - at > tolerance {
            free.push([at, from]);
        }
        at = to;
        if at >= length - tolerance {
            return free;
        }
    }
    free.push([at, length]);
    free
}

#[cfg(test)]
mod tests {
    use super::super::testing::{net_of, points, square};
    use super::super::{
        CommonLine, NestParams, SheetError, SheetParams, SheetSet, StockParams, lay_out,
    };
    use super::*;
    use crate::geom::polygon::signed_area;
    use crate::units::Length;

    fn params() -> SheetParams {
        let nest = NestParams { common_line: CommonLine::On, ..NestParams::default() };
        SheetParams { nest, ..SheetParams::default() }
    }

    fn cuts(set: &SheetSet) -> Vec<[DVec2; 2]> {
        let strokes = set
            .drawings
            .iter()
            .flat_map(Drawing::marks)
            .filter(|m| m.kind.layer() == LayerKind::CutOuter);
        let sides = |s: &Stroke| {
            let ring: Vec<DVec2> =
                s.points.iter().chain(s.points.first().filter(|_| s.closed)).copied().collect();
            ring.windows(2).map(|w| [w[0], w[1]]).collect::<Vec<_>>()
        };
        strokes.flat_map(|m| &m.strokes).flat_map(sides).collect()
    }

    /// No two cuts run along one another.
    fn assert_cut_once(set: &SheetSet) {
        let cuts = cuts(set);
        for (i, &side) in cuts.iter().enumerate() {
            let length = side[0].distance(side[1]);
            assert_eq!(free_stretches(side, &cuts[..i], 1e-5), [[0.0, length]], "{side:?}");
        }
    }

    #[test]
    fn squares_make_a_grid_whose_lines_are_cut_once() {
        let set = lay_out(&net_of(vec![square(40.0); 12]), &params()).expect("all fit");
        assert_cut_once(&set);
        // Twelve squares have 48 sides; a column of nine has 28 lines, and three beside it add 7.
        assert!((set.layout.cut_length - 35.0 * 40.0).abs() < 1e-4, "{}", set.layout.cut_length);
        let saved = set.report.shared_length;
        assert!((set.layout.cut_length + saved - 48.0 * 40.0).abs() < 1e-4, "{saved}");
        // Files of single parts hold whole contours.
        let parts = set.drawings[0].parts();
        assert_eq!(parts.len(), 12);
        assert!(parts.iter().all(|p| (p.cut_length() - 160.0).abs() < 1e-6));
        assert_eq!(lay_out(&net_of(vec![square(40.0); 12]), &params()), Ok(set));
    }

    #[test]
    fn triangles_and_hexagons_of_any_turn_share_sides() {
        let turned = |by: f64, n: i32| -> Vec<DVec2> {
            (0..n)
                .map(|i| {
                    DVec2::from_angle(by + f64::from(i) * std::f64::consts::TAU / f64::from(n))
                        * 30.0
                })
                .collect()
        };
        for corners in [3, 6] {
            let contours: Vec<_> = (0..10).map(|i| turned(0.37 * f64::from(i), corners)).collect();
            let whole: f64 = contours
                .iter()
                .map(|c| (0..c.len()).map(|i| c[i].distance(c[(i + 1) % c.len()])).sum::<f64>())
                .sum();
            assert!(signed_area(&contours[0]) > 0.0);
            let set = lay_out(&net_of(contours), &params()).expect("all fit");
            assert_cut_once(&set);
            assert!(set.layout.cut_length < 0.85 * whole, "{} of {whole}", set.layout.cut_length);
        }
    }

    #[test]
    fn a_kerf_and_holding_tabs_are_refused_with_the_reason() {
        let net = net_of(vec![square(40.0); 2]);
        let error = lay_out(
            &net,
            &SheetParams {
                stock: StockParams { kerf: Length::from_mm(0.2), ..params().stock },
                ..params()
            },
        )
        .expect_err("a kerf");
        assert!(error.to_string().contains("0.1 mm of both parts"), "{error}");
        let error = lay_out(
            &net,
            &SheetParams { stock: StockParams { holding_tabs: 2, ..params().stock }, ..params() },
        )
        .expect_err("tabs");
        assert_eq!(error, SheetError::CommonLineOption { option: "hold" });
    }

    #[test]
    fn of_a_ring_the_stretches_between_are_left() {
        let square = square(10.0);
        let line = |a: (f64, f64), b: (f64, f64)| [DVec2::from(a), DVec2::from(b)];
        assert_eq!(left_of(&square, &[line((0.0, 12.0), (10.0, 12.0))], 1e-6), None);
        // Half of the lower side, and the whole left one.
        let left = left_of(
            &square,
            &[line((10.0, 0.0), (5.0, 0.0)), line((0.0, -5.0), (0.0, 15.0))],
            1e-6,
        );
        let expected = [
            points([(0.0, 0.0), (5.0, 0.0)]).to_vec(),
            points([(10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]),
        ];
        let left: Vec<_> = left.expect("not whole").into_iter().map(|s| s.points).collect();
        assert_eq!(left, expected);
        // The middle of the upper side: one line around the corner where the ring begins.
        let left = left_of(&square, &[line((3.0, 10.0), (6.0, 10.0))], 1e-6).expect("not whole");
        assert_eq!(left.len(), 1);
        assert!(
            left[0].points[0].distance(DVec2::new(3.0, 10.0)) < 1e-12 && left[0].points.len() == 6,
            "{left:?}"
        );
    }
}
