//! Tabs on one side of a seam, slots for them in the partner, for plates of one thickness, cut
//! square.
//!
//! The faces are the outer sides of the plates. The plate with the tabs ends at the inner side of
//! its partner; its tabs go on through the partner to its outer side and do not jut out. The
//! partner keeps its whole face and grows a lip beyond the edge, so that its slots lie inside of
//! its outline.
//!
//! With the dihedral angle δ and the thickness t the slanted slab of the one plate crosses the
//! other one, measured from the edge into it, from min(0, t · cot δ) to t / sin δ + max(0, t · cot
//! δ): that is where the slot is, t wide at a right angle and wider else, since a square cut has to
//! let a slanted plate through. Tabs end max(0, t · cot δ) before the edge, the plate between them
//! t / sin δ more. Lips end before the corners of the face, where the plates meet as at a finger
//! joint: one keeps the edge, the other one ends behind it.

use glam::DVec2;

use super::super::boundary::{Boundaries, Contour, Place, segment_distance};
use super::super::distance::edges;
use super::fingers::{corner, depths};
use super::params::{FlapSide, Tabs, WEB};
use super::webs::in_the_way;
use super::{JointFallback, JointReport};
use crate::geom::polygon::{Location, locate};
use crate::net::{Net, Segment};

/// Trials of a seam, in order: the side by the rule (0) or its partner (1), and the free part at
/// both ends in multiples of the least one.
const TRIALS: [(usize, f64); 4] = [(0, 1.0), (0, 2.0), (1, 1.0), (1, 2.0)];

/// Length of a slot relative to its width, unless tabs are asked for that are narrower.
const SLOT_LENGTH: f64 = 2.05;

/// Tabs along one edge and the slots for them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    /// The side of the seam with the tabs.
    pub side: usize,
    /// Where the tabs begin, from the beginning of their edge.
    pub starts: Vec<f64>,
    /// Width of every tab and length of every slot.
    pub width: f64,
    /// How far inside of the edge tabs end, and the plate between them.
    pub short: f64,
    pub deep: f64,
    /// Where slots begin and end, from the edge into the partner.
    pub slot: [f64; 2],
    /// Least material around a slot.
    pub web: f64,
}

impl Row {
    /// The tabs of a seam, or why it can have none.
    fn of(
        fold_angle: f64,
        length: f64,
        tabs: &Tabs,
        (side, ends): (usize, f64),
    ) -> Result<Self, JointFallback> {
        let (short, deep) = depths(fold_angle, tabs.thickness)?;
        let dihedral = (180.0 - fold_angle).to_radians();
        let web = tabs.thickness.max(WEB);
        // At the ends a third plate needs its room, about as deep as this one.
        let free = length - 2.0 * ends * (deep + web);
        let width = tabs.width.min(free);
        let lean = tabs.thickness * dihedral.cos() / dihedral.sin();
        let slot = [lean.min(0.0), tabs.thickness / dihedral.sin() + lean.max(0.0)];
        // A slot is longer than wide, or it burns out as a small hole does.
        let least = (SLOT_LENGTH * (slot[1] - slot[0])).min(tabs.width).max(tabs.thickness);
        if width < least || width.is_nan() {
            return Err(JointFallback::Short);
        }
        let count = ((free - width) / (2.0 * width)).floor().max(0.0) as usize + 1;
        let first = (length - width * (2 * count - 1) as f64) / 2.0;
        let starts = (0..count).map(|i| first + 2.0 * width * i as f64).collect();
        Ok(Self { side, starts, width, short, deep, slot, web })
    }

    /// The slots in the partner, whose edge runs from `a` to `b`, clockwise as holes are.
    fn slots(&self, [a, b]: Segment) -> Vec<Vec<DVec2>> {
        let along = (b - a).normalize_or_zero();
        let (inwards, length) = (along.perp(), a.distance(b));
        let slot = |start: f64| {
            // The partner's edge runs the other way.
            let ends = [length - start - self.width, length - start];
            let at = |x: f64, depth: f64| a + along * x + inwards * depth;
            let [near, far] = self.slot;
            vec![at(ends[0], near), at(ends[0], far), at(ends[1], far), at(ends[1], near)]
        };
        self.starts.iter().map(|&start| slot(start)).collect()
    }

    /// What the plate with the tabs is cut like between its corners.
    fn tabs(&self, [a, b]: Segment) -> Vec<DVec2> {
        let along = (b - a).normalize_or_zero();
        let at = |x: f64, depth: f64| a + along * x + along.perp() * depth;
        let tab = |&start: &f64| {
            let end = start + self.width;
            [at(start, self.deep), at(start, self.short), at(end, self.short), at(end, self.deep)]
        };
        self.starts.iter().flat_map(tab).collect()
    }

    /// What its partner is cut like: the lip.
    fn lip(&self, [a, b]: Segment) -> Vec<DVec2> {
        let along = (b - a).normalize_or_zero();
        let length = a.distance(b);
        let at = |x: f64, depth: f64| a + along * x + along.perp() * depth;
        let (first, last) = (self.starts[0], self.starts[self.starts.len() - 1] + self.width);
        let ends = [length - last - self.web, length - first + self.web];
        let out = self.slot[0] - self.web;
        vec![at(ends[0], 0.0), at(ends[0], out), at(ends[1], out), at(ends[1], 0.0)]
    }
}

/// A slot of a piece, by its place in the net.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Slot {
    pub piece: usize,
    pub contour: Vec<DVec2>,
}

/// Adds tabs and slots to all seams that can have them; gives the slots and the seams that cannot.
pub(super) fn add_tabs(
    net: &Net,
    boundaries: &mut Boundaries,
    tabs: &Tabs,
    report: &mut JointReport,
) -> (Vec<Slot>, Vec<usize>) {
    let web = (tabs.thickness / 2.0).max(WEB);
    let mut trials = vec![0; net.seams.len()];
    let mut rows: Vec<Result<Row, JointFallback>> = (0..net.seams.len())
        .map(|s| next_row(net, boundaries, tabs, s, &mut trials[s], JointFallback::Narrow))
        .collect();
    // Every round takes a trial from a seam, so that it ends; without any the outlines are those of
    // the net.
    loop {
        boundaries.contours.iter_mut().for_each(|c| shape(c, &rows));
        let mut blocked = Vec::new();
        for piece in 0..net.pieces.len() {
            blocked.extend(in_the_way(boundaries, piece, web, |s| rows[s].is_ok()));
            blocked.extend(slots_in_the_way(net, boundaries, piece, &rows));
        }
        blocked.sort_unstable();
        blocked.dedup();
        for &s in &blocked {
            rows[s] = next_row(net, boundaries, tabs, s, &mut trials[s], JointFallback::Narrow);
        }
        if blocked.is_empty() {
            break;
        }
    }
    let mut slots = Vec::new();
    let mut fallen = Vec::new();
    for (s, row) in rows.iter().enumerate() {
        match (row, boundaries.places[s]) {
            (Ok(row), places) => {
                report.tabbed += 1;
                if let Some(place) = places[1 - row.side] {
                    let piece = boundaries.contours[place.contour].piece;
                    let cut = row.slots(edge(boundaries, place));
                    slots.extend(cut.into_iter().map(|contour| Slot { piece, contour }));
                }
            }
            (Err(why), _) => {
                report.fallbacks.push((net.seams[s].id, *why));
                fallen.push(s);
            }
        }
    }
    (slots, fallen)
}

/// The next trial of a seam that gives a row; else `why`, or what the seam's own numbers say.
fn next_row(
    net: &Net,
    boundaries: &Boundaries,
    tabs: &Tabs,
    s: usize,
    trial: &mut usize,
    why: JointFallback,
) -> Result<Row, JointFallback> {
    let seam = &net.seams[s];
    if boundaries.places[s].iter().any(Option::is_none) {
        return Err(why);
    }
    let key = |k: usize| (seam.sides[k].piece, seam.sides[k].face);
    let lower = usize::from(key(1) < key(0));
    let first = match tabs.side {
        FlapSide::Lower => lower,
        FlapSide::Higher => 1 - lower,
        FlapSide::Alternate => lower ^ boundaries.places[s][lower].map_or(0, |p| p.edge % 2),
    };
    let mut reported = why;
    while let Some(&(other, ends)) = TRIALS.get(*trial) {
        *trial += 1;
        match Row::of(seam.fold_angle, seam.length, tabs, (first ^ other, ends)) {
            Ok(row) => return Ok(row),
            // A seam too short for wide ends was tried with narrow ones before.
            Err(reason) if *trial == 1 => reported = reason,
            Err(_) => {}
        }
    }
    Err(reported)
}

fn edge(boundaries: &Boundaries, place: Place) -> Segment {
    boundaries.contours[place.contour].edge(place.edge)
}

/// Cuts tabs and lips of all edges of a contour.
fn shape(contour: &mut Contour, rows: &[Result<Row, JointFallback>]) {
    let n = contour.len();
    let row = |i: usize| contour.sides[i].and_then(|(s, k)| Some((rows[s].as_ref().ok()?, k)));
    let level =
        |i: usize| row(i).map_or(0.0, |(row, k)| if row.side == k { row.deep } else { 0.0 });
    let levels: Vec<f64> = (0..n).map(level).collect();
    let profiles: Vec<Vec<DVec2>> = (0..n)
        .map(|i| match row(i) {
            Some((row, k)) if row.side == k => row.tabs(contour.edge(i)),
            Some((row, _)) => row.lip(contour.edge(i)),
            None => Vec::new(),
        })
        .collect();
    for (i, profile) in profiles.into_iter().enumerate() {
        let before = (i + n - 1) % n;
        contour.cut_corners[i] =
            corner(contour.edge(before), contour.edge(i), (levels[before], levels[i]));
        contour.profiles[i] = profile;
    }
}

/// The seams whose tabs or slots on a piece lack room: slots near a cut, a fold or one another, and
/// either near the plate that stands on another edge.
fn slots_in_the_way(
    net: &Net,
    boundaries: &Boundaries,
    piece: usize,
    rows: &[Result<Row, JointFallback>],
) -> Vec<usize> {
    let edges = jointed_edges(boundaries, piece, rows);
    let room = Room::of(net, boundaries, piece, &edges);
    let mut slots: Vec<SlotOf> = Vec::new();
    let mut found = Vec::new();
    for edge in &edges {
        if edge.row.side == edge.side {
            let tabs = edge.row.tabs(edge.segment);
            if !tabs.chunks(4).all(|tab| room.keeps_off_plates(tab, edge)) {
                found.push(edge.seam);
            }
            continue;
        }
        for contour in edge.row.slots(edge.segment) {
            let least = edge.row.web * (1.0 - 1e-9);
            let is_beside = |slot: &&SlotOf| {
                slot.seam != edge.seam
                    && sides(&slot.contour).any(|side| distance(&contour, side) < least)
            };
            let beside: Vec<usize> = slots.iter().filter(is_beside).map(|s| s.seam).collect();
            if !room.is_free(&contour, edge, least) || !beside.is_empty() {
                found.push(edge.seam);
                found.extend(beside);
            }
            slots.push(SlotOf { seam: edge.seam, contour });
        }
    }
    found
}

/// A slot with its seam.
struct SlotOf {
    seam: usize,
    contour: Vec<DVec2>,
}

/// An edge of a piece that has tabs or slots.
struct JointedEdge<'a> {
    seam: usize,
    /// Which side of the seam it is.
    side: usize,
    segment: Segment,
    row: &'a Row,
}

fn jointed_edges<'a>(
    boundaries: &Boundaries,
    piece: usize,
    rows: &'a [Result<Row, JointFallback>],
) -> Vec<JointedEdge<'a>> {
    let mut all = Vec::new();
    for contour in boundaries.of_piece(piece) {
        for i in 0..contour.len() {
            if let Some((seam, side)) = contour.sides[i]
                && let Ok(row) = &rows[seam]
            {
                all.push(JointedEdge { seam, side, segment: contour.edge(i), row });
            }
        }
    }
    all
}

/// What the tabs and slots of a piece keep clear of.
struct Room<'a> {
    /// The outline as it is cut, then the holes.
    paths: Vec<Vec<DVec2>>,
    folds: Vec<Segment>,
    /// Edges with plates on them.
    edges: &'a [JointedEdge<'a>],
}

impl<'a> Room<'a> {
    fn of(net: &Net, boundaries: &Boundaries, piece: usize, edges: &'a [JointedEdge<'a>]) -> Self {
        let id = net.pieces[piece].id;
        Self {
            paths: boundaries.of_piece(piece).map(Contour::path).collect(),
            folds: net.folds.iter().filter(|f| f.piece == id).map(|f| f.segment).collect(),
            edges,
        }
    }

    /// Whether a polygon on one edge is as far from the others as their plates reach.
    fn keeps_off_plates(&self, polygon: &[DVec2], own: &JointedEdge<'_>) -> bool {
        let mut others = self.edges.iter().filter(|other| other.segment != own.segment);
        others.all(|other| distance(polygon, other.segment) >= other.row.deep)
    }

    /// Whether a slot lies in the piece and keeps its distances.
    fn is_free(&self, slot: &[DVec2], own: &JointedEdge<'_>, least: f64) -> bool {
        let is_inside = self.paths.iter().enumerate().all(|(c, path)| {
            slot.iter().all(|&p| (locate(path, p) == Location::Inside) == (c == 0))
        });
        is_inside
            && self.paths.iter().all(|path| sides(path).all(|side| distance(slot, side) >= least))
            && self.folds.iter().all(|&fold| distance(slot, fold) >= own.row.web / 2.0)
            && self.keeps_off_plates(slot, own)
    }
}

fn sides(polygon: &[DVec2]) -> impl Iterator<Item = Segment> {
    edges(polygon).map(|(a, b)| [a, b])
}

/// The least distance between the sides of a polygon and a segment.
fn distance(polygon: &[DVec2], segment: Segment) -> f64 {
    sides(polygon).map(|side| segment_distance(side, segment)).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PLY: Tabs = Tabs { thickness: 3.0, width: 9.0, side: FlapSide::Lower };

    #[test]
    fn at_a_right_angle_a_tab_of_the_thickness_meets_a_slot_of_the_thickness() {
        let row = Row::of(90.0, 60.0, &PLY, (0, 1.0)).expect("a right angle");
        assert!((row.slot[1] - row.slot[0] - 3.0).abs() < 1e-12 && row.slot[0].abs() < 1e-12);
        assert!(row.short.abs() < 1e-12 && (row.deep - 3.0).abs() < 1e-12);
        assert_eq!((row.starts.len(), row.width), (3, 9.0));
        // Evenly between the ends.
        assert!((row.starts[0] + row.starts[2] + 9.0 - 60.0).abs() < 1e-12);
        assert_eq!(Row::of(90.0, 14.0, &PLY, (0, 1.0)), Err(JointFallback::Short));
        assert_eq!(Row::of(20.0, 60.0, &PLY, (0, 1.0)), Err(JointFallback::Shallow));
    }

    proptest! {
        /// In a section across the edge: wherever the plate with the tab is inside its partner, the
        /// slot is; the tab does not jut out, and the plate between the tabs stays out of its
        /// partner.
        #[test]
        fn the_slab_goes_through_its_slot(fold in 41.0..149.0_f64, s in -1.0..20.0_f64, r in 0.0..3.0_f64) {
            let row = Row::of(fold, 200.0, &PLY, (0, 1.0)).expect("an angle that tabs can hold");
            let dihedral = (180.0 - fold).to_radians();
            // The partner lies along x with its inside up; the plate with the tab leans by the
            // dihedral angle.
            let (along, inwards) = (DVec2::from_angle(dihedral), DVec2::new(dihedral.sin(), -dihedral.cos()));
            let p = along * s + inwards * r;
            if (0.0..=3.0).contains(&p.y) && s >= row.short {
                prop_assert!(p.x >= row.slot[0] - 1e-9 && p.x <= row.slot[1] + 1e-9);
            }
            if s >= row.short {
                prop_assert!(p.y >= -1e-9, "juts out");
            }
            if s >= row.deep {
                prop_assert!(p.y >= 3.0 - 1e-9, "the plate between the tabs is in its partner");
            }
        }

        #[test]
        fn every_tab_has_its_slot_opposite(fold in 41.0..149.0_f64, length in 40.0..300.0_f64) {
            let Ok(row) = Row::of(fold, length, &PLY, (0, 1.0)) else { return Ok(()) };
            let (a, b) = (DVec2::new(1.0, 2.0), DVec2::new(1.0, 2.0) + DVec2::from_angle(0.7) * length);
            let tabs = row.tabs([a, b]);
            let slots = row.slots([b, a]);
            prop_assert_eq!(tabs.len(), 4 * slots.len());
            let along = (b - a) / length;
            for (tab, slot) in tabs.chunks(4).zip(&slots) {
                let reach = |points: &[DVec2]| {
                    let at = points.iter().map(|p| (*p - a).dot(along));
                    at.fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)])
                };
                let (t, s) = (reach(tab), reach(slot));
                prop_assert!((t[0] - s[0]).abs() < 1e-9 && (t[1] - s[1]).abs() < 1e-9);
                prop_assert!(crate::geom::polygon::signed_area(slot) < 0.0);
            }
        }
    }
}
