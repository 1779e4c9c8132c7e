//! Every line is cut once. What has been drawn for one part is left out of the next, where parts
//! may share lines; and where the outline of a part comes by its own line again, only the first way
//! is cut.

use std::collections::BTreeMap;

use glam::DVec2;

use super::drawing::{Drawing, Layer, LayerKind, Mark, Stroke};
use crate::net::PieceId;

/// Into how many columns of a sheet drawn sides are sorted.
const COLUMNS: f64 = 256.0;

impl Drawing {
    /// Leaves out of every cut what runs along another cut before it, up to `tolerance` mm, and
    /// keeps the whole contours for [`Drawing::parts`]. Returns the length that is left out.
    pub(crate) fn cut_once(&mut self, tolerance: f64) -> f64 {
        let mut drawn = Drawn::new(self.width, tolerance);
        let mut saved = 0.0;
        for layer in self.layers.iter_mut().filter(|l| is_cut(l)) {
            for mark in &mut layer.marks {
                let left = left_of(&mark.strokes, &mut drawn, Itself::Differs);
                let Some(left) = left else { continue };
                let length = |strokes: &[Stroke]| strokes.iter().map(Stroke::length).sum::<f64>();
                let whole = std::mem::replace(&mut mark.strokes, left);
                saved += length(&whole) - length(&mark.strokes);
                self.whole.push(Mark { strokes: whole, ..mark.clone() });
            }
            layer.marks.retain(|m| !m.strokes.is_empty());
        }
        saved
    }

    /// Leaves out of every cut what runs along an earlier line of the same part, up to `tolerance`
    /// mm: without a kerf an outline may touch itself, and a hole its outline. Returns whether
    /// there was any.
    pub(crate) fn cut_own_lines_once(&mut self, tolerance: f64) -> bool {
        let mut of_part: BTreeMap<Option<PieceId>, Drawn> = BTreeMap::new();
        let mut is_changed = false;
        let width = self.width;
        for layer in self.layers.iter_mut().filter(|l| is_cut(l)) {
            for mark in &mut layer.marks {
                let fresh = || Drawn::new(width, tolerance);
                let drawn = of_part.entry(mark.piece).or_insert_with(fresh);
                if let Some(left) = left_of(&mark.strokes, drawn, Itself::Counts) {
                    mark.strokes = left;
                    is_changed = true;
                }
            }
            layer.marks.retain(|m| !m.strokes.is_empty());
        }
        is_changed
    }
}

fn is_cut(layer: &Layer) -> bool {
    matches!(layer.kind, LayerKind::CutInner | LayerKind::CutOuter)
}

/// Whether a line is also compared with what comes before on itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Itself {
    Counts,
    Differs,
}

/// The sides that are drawn already, by the columns of the sheet through which they run.
struct Drawn {
    column: f64,
    tolerance: f64,
    sides: BTreeMap<i64, Vec<[DVec2; 2]>>,
}

impl Drawn {
    fn new(width: f64, tolerance: f64) -> Self {
        Self { column: width / COLUMNS, tolerance, sides: BTreeMap::new() }
    }

    /// The columns that a side passes, and those that it nearly does.
    fn columns(&self, [p, q]: [DVec2; 2]) -> std::ops::RangeInclusive<i64> {
        let column = |x: f64| (x / self.column).floor() as i64;
        column(p.x.min(q.x) - self.tolerance)..=column(p.x.max(q.x) + self.tolerance)
    }

    fn add(&mut self, side: [DVec2; 2]) {
        for column in self.columns(side) {
            self.sides.entry(column).or_default().push(side);
        }
    }

    /// The stretches of a side, from and to in mm along it, on which nothing is drawn.
    fn free_stretches(&self, side: [DVec2; 2]) -> Vec<[f64; 2]> {
        let near = self.sides.range(self.columns(side)).flat_map(|(_, sides)| sides);
        free_stretches(side, near, self.tolerance)
    }
}

/// The lines that are left of some without what is drawn already, and draws them; nothing when they
/// stay whole.
fn left_of(strokes: &[Stroke], drawn: &mut Drawn, itself: Itself) -> Option<Vec<Stroke>> {
    let (mut left, mut is_whole) = (Vec::new(), true);
    for stroke in strokes {
        let parts = left_of_stroke(stroke, drawn, itself);
        is_whole &= parts.is_none();
        left.extend(parts.unwrap_or_else(|| vec![stroke.clone()]));
    }
    if itself == Itself::Differs {
        strokes.iter().flat_map(sides).for_each(|side| drawn.add(side));
    }
    (!is_whole).then_some(left)
}

/// The sides of a line.
fn sides(stroke: &Stroke) -> impl Iterator<Item = [DVec2; 2]> {
    let back = stroke.points.first().filter(|_| stroke.closed);
    stroke.points.iter().zip(stroke.points.iter().skip(1).chain(back)).map(|(&p, &q)| [p, q])
}

/// The open lines that are left of one line.
fn left_of_stroke(stroke: &Stroke, drawn: &mut Drawn, itself: Itself) -> Option<Vec<Stroke>> {
    let mut lines: Vec<Vec<DVec2>> = Vec::new();
    let (mut is_whole, mut goes_on) = (true, false);
    for [p, q] in sides(stroke) {
        let length = p.distance(q);
        let free = drawn.free_stretches([p, q]);
        if itself == Itself::Counts {
            drawn.add([p, q]);
        }
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
    if stroke.closed && goes_on && lines.len() > 1 && lines[0][0] == stroke.points[0] {
        let first = lines.remove(0);
        if let Some(last) = lines.last_mut() {
            last.extend(&first[1..]);
        }
    }
    Some(lines.into_iter().map(|points| Stroke { points, closed: false }).collect())
}

/// The stretches of a side, from and to in mm along it, on which none of the drawn ones lies.
fn free_stretches<'a>(
    [p, q]: [DVec2; 2],
    drawn: impl Iterator<Item = &'a [DVec2; 2]>,
    tolerance: f64,
) -> Vec<[f64; 2]> {
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
        drawn.filter_map(covers).filter(|c| c[1] - c[0] > tolerance).collect();
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
            assert_eq!(free_stretches(side, cuts[..i].iter(), 1e-5), [[0.0, length]], "{side:?}");
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

    /// What is left of a ring beside the drawn lines.
    fn left_of_ring(points: &[DVec2], lines: &[[DVec2; 2]], itself: Itself) -> Option<Vec<Stroke>> {
        let mut drawn = Drawn::new(50.0, 1e-6);
        lines.iter().for_each(|&line| drawn.add(line));
        left_of(&[Stroke { points: points.to_vec(), closed: true }], &mut drawn, itself)
    }

    #[test]
    fn of_a_ring_the_stretches_between_are_left() {
        let square = square(10.0);
        let line = |a: (f64, f64), b: (f64, f64)| [DVec2::from(a), DVec2::from(b)];
        let left = |lines: &[[DVec2; 2]]| left_of_ring(&square, lines, Itself::Differs);
        assert_eq!(left(&[line((0.0, 12.0), (10.0, 12.0))]), None);
        // Half of the lower side, and the whole left one.
        let lines = [line((10.0, 0.0), (5.0, 0.0)), line((0.0, -5.0), (0.0, 15.0))];
        let found: Vec<_> =
            left(&lines).expect("not whole").into_iter().map(|s| s.points).collect();
        let expected = [
            points([(0.0, 0.0), (5.0, 0.0)]).to_vec(),
            points([(10.0, 0.0), (10.0, 10.0), (0.0, 10.0)]),
        ];
        assert_eq!(found, expected);
        // The middle of the upper side: one line around the corner where the ring begins.
        let found = left(&[line((3.0, 10.0), (6.0, 10.0))]).expect("not whole");
        assert_eq!(found.len(), 1);
        assert!(
            found[0].points[0].distance(DVec2::new(3.0, 10.0)) < 1e-12
                && found[0].points.len() == 6,
            "{found:?}"
        );
    }

    /// A frame that is closed where its ends meet, along 10 mm, and one whose ends are set off by
    /// 4.
    fn frames() -> [Vec<DVec2>; 2] {
        let inner = [(10.0, 10.0), (10.0, 30.0), (30.0, 30.0), (30.0, 10.0)];
        let outer = [(40.0, 0.0), (40.0, 40.0), (0.0, 40.0), (0.0, 0.0)];
        let ring = |ends: [(f64, f64); 2], middle: [(f64, f64); 2]| {
            points(
                [&outer[..], &ends[..1], &middle[..1], &inner[..], &middle[1..], &ends[1..]]
                    .concat()
                    .try_into()
                    .unwrap_or([(0.0, 0.0); 12]),
            )
        };
        let met = ring([(20.0, 0.0); 2], [(20.0, 10.0); 2]);
        let set_off = ring([(20.0, 0.0), (20.0, 4.0)], [(20.0, 10.0), (20.0, 14.0)]);
        [met, set_off]
    }

    #[test]
    fn where_a_part_meets_itself_the_line_is_cut_once() {
        for (frame, common) in frames().into_iter().zip([10.0, 6.0]) {
            let length = Stroke { points: frame.clone(), closed: true }.length();
            let left = left_of_ring(&frame, &[], Itself::Counts).expect("meets itself");
            let now: f64 = left.iter().map(Stroke::length).sum();
            assert!((length - now - common).abs() < 1e-9, "{length} {now}");
            // Turned, and as a part on a sheet.
            let turned: Vec<DVec2> =
                frame.iter().map(|&p| DVec2::from_angle(0.7).rotate(p)).collect();
            let net = net_of(vec![turned, square(20.0)]);
            let mut none = SheetParams::default();
            none.stock.kerf = Length::from_mm(0.0);
            for params in [none, params()] {
                let set = lay_out(&net, &params).expect("both fit");
                assert_cut_once(&set);
                let saved = length + 80.0 - set.report.shared_length - set.layout.cut_length;
                assert!((saved - common).abs() < 1e-4, "{saved}");
            }
        }
        assert_eq!(left_of_ring(&square(10.0), &[], Itself::Counts), None);
    }
}
