//! Which segments of many come near one another: a tree of boxes that lie along the segments in
//! them, so that a thousand slanted strokes side by side are as easy as a thousand level ones.
//!
//! The boxes are those of Gottschalk, Lin and Manocha (1996, OBBTree) in the plane; a pair of
//! subtrees is left out as soon as one of the four directions of two boxes separates them.

use std::ops::{ControlFlow, Range};

use glam::DVec2;

/// How many segments a leaf holds at most.
const LEAF: usize = 6;

/// A segment with what a search may ask of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Its ends.
    pub ends: [DVec2; 2],
    /// How far around it counts as near; two segments meet at most their sum apart.
    pub reach: f64,
    /// A bit for its kind; what a kind means is the caller's.
    pub kind: u8,
}

/// What is known of a pair of groups of segments before it is looked at closely.
#[derive(Debug, Clone, Copy)]
pub struct PairOfGroups {
    /// All kinds in the two groups.
    pub kinds: [u8; 2],
    /// The least angle between a segment of the one and a segment of the other, in radians from 0
    /// to π/2, as far as known.
    pub angle: f64,
}

/// Segments in a tree.
#[derive(Debug, Clone)]
pub struct SegmentTree {
    segments: Vec<Segment>,
    /// Numbers of the segments, those of a node side by side.
    order: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Debug, Clone)]
struct Node {
    from: u32,
    to: u32,
    /// The two parts; leaves have none.
    parts: Option<[u32; 2]>,
    kinds: u8,
    /// The largest angle of a segment to the axis.
    spread: f64,
    low: DVec2,
    high: DVec2,
    centre: DVec2,
    axis: DVec2,
    /// Half the length along the axis and across it.
    half: DVec2,
}

impl SegmentTree {
    /// The tree of these segments; they keep their numbers.
    pub fn new(segments: Vec<Segment>) -> Self {
        let order = (0..segments.len() as u32).collect();
        let mut tree = Self { segments, order, nodes: Vec::new() };
        if !tree.segments.is_empty() {
            tree.grow(0..tree.segments.len());
        }
        tree
    }

    /// The segments by number.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Adds the node of a range of `order` with all below it; its number.
    fn grow(&mut self, range: Range<usize>) -> u32 {
        let node = self.boxed(range.clone());
        let key = self.split_key(&node);
        let number = self.nodes.len();
        self.nodes.push(node);
        if range.len() > LEAF {
            let middle = range.len() / 2;
            let segments = &self.segments;
            self.order[range.clone()].select_nth_unstable_by(middle, |&a, &b| {
                let [x, y] = [a, b].map(|s| key.of(&segments[s as usize]));
                x.total_cmp(&y).then(a.cmp(&b))
            });
            let cut = range.start + middle;
            let parts = [self.grow(range.start..cut), self.grow(cut..range.end)];
            self.nodes[number].parts = Some(parts);
        }
        number as u32
    }

    fn members(&self, range: Range<usize>) -> impl Iterator<Item = &Segment> {
        self.order[range].iter().map(|&s| &self.segments[s as usize])
    }

    fn boxed(&self, range: Range<usize>) -> Node {
        let members = || self.members(range.clone());
        let axis = common_direction(members());
        let across = axis.perp();
        let origin = self.segments[self.order[range.start] as usize].ends[0];
        let (mut from, mut to) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let (mut spread, mut kinds) = (0.0_f64, 0);
        for segment in members() {
            let reach = DVec2::splat(segment.reach);
            for end in segment.ends {
                let local = DVec2::new(axis.dot(end - origin), across.dot(end - origin));
                (from, to) = (from.min(local - reach), to.max(local + reach));
                (low, high) = (low.min(end - reach), high.max(end + reach));
            }
            kinds |= segment.kind;
            spread = spread.max(angle_between(axis, segment.direction()));
        }
        let middle = from.midpoint(to);
        let centre = origin + axis * middle.x + across * middle.y;
        // What rounding may have taken off the box.
        let slack = 1e-15 * low.abs().max(high.abs()).max_element();
        let half = (to - from) / 2.0 * (1.0 + 1e-12) + DVec2::splat(slack);
        let (from, to) = (range.start as u32, range.end as u32);
        Node { from, to, parts: None, kinds, spread, low, high, centre, axis, half }
    }

    /// By what the segments of a node are told apart best.
    fn split_key(&self, node: &Node) -> SplitKey {
        let range = node.from as usize..node.to as usize;
        let count = range.len() as f64;
        let (mut from, mut to) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut length = 0.0;
        for segment in self.members(range) {
            let middle = segment.middle() - node.centre;
            let local = DVec2::new(node.axis.dot(middle), node.axis.perp().dot(middle));
            (from, to) = (from.min(local), to.max(local));
            length += segment.length() / count;
        }
        let extent = to - from;
        if node.spread * length > extent.max_element() {
            SplitKey::Turn { axis: node.axis }
        } else if extent.y * 2.0 >= extent.x {
            SplitKey::Along { axis: node.axis.perp() }
        } else {
            SplitKey::Along { axis: node.axis }
        }
    }

    /// Calls `meet` once for every pair of segments that may be as near as their reach, the smaller
    /// number first, in a fixed order, until it breaks off. Pairs of groups that `wants` does not
    /// want are left out.
    pub fn pairs<B>(
        &self,
        wants: impl Fn(PairOfGroups) -> bool,
        mut meet: impl FnMut(usize, usize) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let mut open = Vec::new();
        if !self.nodes.is_empty() {
            open.push([0, 0]);
        }
        while let Some([a, b]) = open.pop() {
            let (p, q) = (&self.nodes[a as usize], &self.nodes[b as usize]);
            let kinds = [p.kinds, q.kinds];
            if a == b {
                if wants(PairOfGroups { kinds, angle: 0.0 }) {
                    match p.parts {
                        Some([l, r]) => open.extend([[r, r], [l, r], [l, l]]),
                        None => self.meet_within(p, &mut meet)?,
                    }
                }
                continue;
            }
            let angle = (angle_between(p.axis, q.axis) - p.spread - q.spread).max(0.0);
            if are_apart(p, q) || !wants(PairOfGroups { kinds, angle }) {
                continue;
            }
            match (p.parts, q.parts) {
                (None, None) => self.meet_across(p, q, &mut meet)?,
                (Some([l, r]), None) => open.extend([[r, b], [l, b]]),
                (Some([l, r]), Some(_)) if p.to - p.from >= q.to - q.from => {
                    open.extend([[r, b], [l, b]]);
                }
                (_, Some([l, r])) => open.extend([[a, r], [a, l]]),
            }
        }
        ControlFlow::Continue(())
    }

    fn meet_within<B>(
        &self,
        leaf: &Node,
        meet: &mut impl FnMut(usize, usize) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let members = &self.order[leaf.from as usize..leaf.to as usize];
        for (k, &i) in members.iter().enumerate() {
            for &j in &members[..k] {
                self.meet_pair(i, j, meet)?;
            }
        }
        ControlFlow::Continue(())
    }

    fn meet_across<B>(
        &self,
        p: &Node,
        q: &Node,
        meet: &mut impl FnMut(usize, usize) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        for &i in &self.order[p.from as usize..p.to as usize] {
            for &j in &self.order[q.from as usize..q.to as usize] {
                self.meet_pair(i, j, meet)?;
            }
        }
        ControlFlow::Continue(())
    }

    fn meet_pair<B>(
        &self,
        i: u32,
        j: u32,
        meet: &mut impl FnMut(usize, usize) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let [s, t] = [i, j].map(|k| &self.segments[k as usize]);
        let reach = DVec2::splat(s.reach + t.reach);
        let (s_low, s_high) = (s.ends[0].min(s.ends[1]), s.ends[0].max(s.ends[1]));
        let (t_low, t_high) = (t.ends[0].min(t.ends[1]), t.ends[0].max(t.ends[1]));
        if (s_low - reach).cmpgt(t_high).any() || (t_low - reach).cmpgt(s_high).any() {
            return ControlFlow::Continue(());
        }
        meet(i.min(j) as usize, i.max(j) as usize)
    }

    /// Calls `visit` for the segments that may come as near to the box between two corners as their
    /// reach, in a fixed order, until it breaks off.
    pub fn in_box<B>(
        &self,
        low: DVec2,
        high: DVec2,
        visit: impl FnMut(usize) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let root = self.nodes.first();
        let asked = root.map(|root| Node::level(low.max(root.low), high.min(root.high)));
        let is_out = |node: &Node| asked.as_ref().is_none_or(|asked| are_apart(node, asked));
        self.search((low, high), is_out, visit)
    }

    /// Calls `visit` for the segments as diagonals of boxes: for every one whose box, grown by its
    /// reach, holds a point.
    pub fn boxes_around<B>(
        &self,
        p: DVec2,
        visit: impl FnMut(usize) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        self.search((p, p), |_| false, visit)
    }

    fn search<B>(
        &self,
        (low, high): (DVec2, DVec2),
        is_out: impl Fn(&Node) -> bool,
        mut visit: impl FnMut(usize) -> ControlFlow<B>,
    ) -> ControlFlow<B> {
        let is_beside = |l: DVec2, h: DVec2| l.cmpgt(high).any() || h.cmplt(low).any();
        let mut open = if self.nodes.is_empty() { Vec::new() } else { vec![0_u32] };
        while let Some(number) = open.pop() {
            let node = &self.nodes[number as usize];
            if is_beside(node.low, node.high) || is_out(node) {
                continue;
            }
            if let Some([left, right]) = node.parts {
                open.extend([right, left]);
                continue;
            }
            for &s in &self.order[node.from as usize..node.to as usize] {
                let segment = &self.segments[s as usize];
                let reach = DVec2::splat(segment.reach);
                let [a, b] = segment.ends;
                if !is_beside(a.min(b) - reach, a.max(b) + reach) {
                    visit(s as usize)?;
                }
            }
        }
        ControlFlow::Continue(())
    }
}

impl Node {
    /// A box that is asked for, its sides level and upright.
    fn level(low: DVec2, high: DVec2) -> Self {
        let slack = DVec2::splat(1e-15 * low.abs().max(high.abs()).max_element());
        Self {
            from: 0,
            to: 0,
            parts: None,
            kinds: 0,
            spread: 0.0,
            low,
            high,
            centre: low.midpoint(high),
            axis: DVec2::X,
            half: (high - low) / 2.0 + slack,
        }
    }
}

impl Segment {
    fn middle(&self) -> DVec2 {
        self.ends[0].midpoint(self.ends[1])
    }

    fn length(&self) -> f64 {
        self.ends[0].distance(self.ends[1])
    }

    /// A unit vector; zero for a point.
    fn direction(&self) -> DVec2 {
        (self.ends[1] - self.ends[0]).normalize_or_zero()
    }
}

/// What segments are sorted by where they are split into two halves.
enum SplitKey {
    /// By the place of their middles along an axis.
    Along { axis: DVec2 },
    /// By their turn against an axis.
    Turn { axis: DVec2 },
}

impl SplitKey {
    fn of(&self, segment: &Segment) -> f64 {
        match *self {
            Self::Along { axis } => axis.dot(segment.middle()),
            Self::Turn { axis } => {
                let along = segment.direction();
                let along = if axis.dot(along) < 0.0 { -along } else { along };
                axis.perp_dot(along)
            }
        }
    }
}

/// The direction that segments have on the whole, long ones counting more; whichever way each runs.
fn common_direction<'a>(segments: impl Iterator<Item = &'a Segment>) -> DVec2 {
    // Doubled angles do not know forwards from backwards.
    let doubled = |s: &Segment| {
        let d = s.direction();
        DVec2::new(d.x * d.x - d.y * d.y, 2.0 * d.x * d.y) * s.length()
    };
    let sum: DVec2 = segments.map(doubled).sum();
    DVec2::from_angle(sum.to_angle() / 2.0)
}

/// The angle between two lines along unit vectors, from 0 to π/2; 0 where one has no direction.
fn angle_between(a: DVec2, b: DVec2) -> f64 {
    a.perp_dot(b).abs().min(1.0).asin()
}

/// Whether one of the directions of two boxes separates them.
fn are_apart(p: &Node, q: &Node) -> bool {
    if p.low.cmpgt(q.high).any() || q.low.cmpgt(p.high).any() {
        return true;
    }
    let between = q.centre - p.centre;
    let cosine = p.axis.dot(q.axis).abs();
    let sine = p.axis.perp_dot(q.axis).abs();
    let onto_other =
        |half: DVec2| DVec2::new(half.x * cosine + half.y * sine, half.x * sine + half.y * cosine);
    let local = |axis: DVec2| DVec2::new(axis.dot(between), axis.perp_dot(between)).abs();
    local(p.axis).cmpgt(p.half + onto_other(q.half)).any()
        || local(q.axis).cmpgt(q.half + onto_other(p.half)).any()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Rng;

    fn segment(a: DVec2, b: DVec2) -> Segment {
        Segment { ends: [a, b], reach: 0.05, kind: 1 }
    }

    fn distance(p: DVec2, [a, b]: [DVec2; 2]) -> f64 {
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a + (b - a) * t)
    }

    fn near_pairs(segments: &[Segment]) -> (Vec<(usize, usize)>, usize) {
        let tree = SegmentTree::new(segments.to_vec());
        let (mut found, mut tests) = (Vec::new(), 0);
        let end: ControlFlow<()> = tree.pairs(
            |_| true,
            |i, j| {
                tests += 1;
                found.push((i, j));
                ControlFlow::Continue(())
            },
        );
        assert!(end.is_continue());
        found.sort_unstable();
        assert!(found.windows(2).all(|w| w[0] != w[1]), "a pair came twice");
        (found, tests)
    }

    #[test]
    fn no_pair_within_reach_is_missed_near_or_far_from_the_origin() {
        for shift in [0.0, 1e6] {
            let mut rng = Rng::new(7);
            let mut at = || DVec2::new(rng.unit(), rng.unit()) * 10.0 + DVec2::splat(shift);
            let segments: Vec<Segment> = (0..400)
                .map(|_| (at(), at()))
                .map(|(a, b)| segment(a, a + (b - a) * 0.2))
                .collect();
            let (found, _) = near_pairs(&segments);
            for j in 0..segments.len() {
                for i in 0..j {
                    let (p, q) = (segments[i].ends, segments[j].ends);
                    let ends = p.iter().map(|&e| distance(e, q));
                    let nearest = ends.chain(q.iter().map(|&e| distance(e, p))).fold(9.0, f64::min);
                    if nearest < 0.1 {
                        assert!(found.binary_search(&(i, j)).is_ok(), "{i} {j} {nearest}");
                    }
                }
            }
        }
    }

    #[test]
    fn slanted_strokes_side_by_side_take_linear_work() {
        let tests = |n: usize| {
            let stroke = |i: usize| {
                let across = DVec2::from_angle(0.6).perp() * (0.2 * i as f64);
                segment(across, across + DVec2::from_angle(0.6) * 2000.0)
            };
            near_pairs(&(0..n).map(stroke).collect::<Vec<_>>()).1
        };
        let [few, many] = [tests(2000), tests(16_000)];
        assert!(many < 9 * few && many < 30 * 16_000, "{few} {many}");
    }

    #[test]
    fn boxes_are_asked_and_searches_break_off() {
        let level = |y: f64| segment(DVec2::new(0.0, y), DVec2::new(9.0, y));
        let tree = SegmentTree::new((0..50).map(|i| level(f64::from(i))).collect());
        let mut found = Vec::new();
        let end: ControlFlow<()> = tree.in_box(DVec2::new(3.0, 6.5), DVec2::new(4.0, 8.5), |i| {
            found.push(i);
            ControlFlow::Continue(())
        });
        assert!(end.is_continue());
        found.sort_unstable();
        assert_eq!(found, [7, 8]);
        let first = tree.in_box(DVec2::ZERO, DVec2::splat(99.0), ControlFlow::Break);
        assert!(first.is_break());
        assert!(
            SegmentTree::new(Vec::new())
                .in_box(DVec2::ZERO, DVec2::ONE, ControlFlow::Break)
                .is_continue()
        );
    }
}
