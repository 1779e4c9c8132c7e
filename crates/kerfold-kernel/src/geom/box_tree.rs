//! A tree of boxes, for finding all pairs that meet in n log n.

use glam::DVec3;

/// A box along the axes; its corners belong to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxisBox {
    /// The least coordinates.
    pub low: DVec3,
    /// The largest coordinates.
    pub high: DVec3,
}

impl AxisBox {
    /// The box of some points; `None` without any.
    pub fn of(points: impl IntoIterator<Item = DVec3>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        let around = Self { low: first, high: first };
        Some(points.fold(around, |b, p| Self { low: b.low.min(p), high: b.high.max(p) }))
    }

    /// Whether both have a point in common.
    pub fn meets(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }

    /// How far a point is from the box; 0 inside.
    pub fn distance(&self, p: DVec3) -> f64 {
        p.distance(p.clamp(self.low, self.high))
    }

    fn around(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Twice its middle, which sorts as the middle does.
    fn middle(&self, axis: usize) -> f64 {
        self.low[axis] + self.high[axis]
    }
}

/// So many boxes lie in a leaf.
const LEAF: usize = 4;

/// Boxes, halved again and again along the longest axis.
#[derive(Debug)]
pub struct BoxTree<'a> {
    boxes: &'a [AxisBox],
    /// The numbers of the boxes; every node has a run of them.
    order: Vec<u32>,
    nodes: Vec<Node>,
}

#[derive(Debug)]
struct Node {
    bounds: AxisBox,
    start: u32,
    end: u32,
    /// The second child; the first follows its parent. Zero for a leaf.
    second: u32,
}

impl<'a> BoxTree<'a> {
    /// A tree of these boxes, at most 2³² of them.
    pub fn new(boxes: &'a [AxisBox]) -> Self {
        let mut tree = Self { boxes, order: (0..boxes.len() as u32).collect(), nodes: Vec::new() };
        if !boxes.is_empty() {
            tree.divide(0, boxes.len());
        }
        tree
    }

    /// Makes the node of a run and those below it. Halves are of one size, so the depth is
    /// logarithmic.
    fn divide(&mut self, start: usize, end: usize) {
        let run = &mut self.order[start..end];
        let first = self.boxes[run[0] as usize];
        let bounds = run.iter().fold(first, |all, &i| all.around(self.boxes[i as usize]));
        let number = self.nodes.len();
        self.nodes.push(Node { bounds, start: start as u32, end: end as u32, second: 0 });
        if end - start <= LEAF {
            return;
        }
        let size = bounds.high - bounds.low;
        let axis = (0..3).max_by(|&a, &b| size[a].total_cmp(&size[b])).unwrap_or(0);
        let half = (end - start) / 2;
        run.select_nth_unstable_by(half, |&a, &b| {
            let middle = |i: u32| self.boxes[i as usize].middle(axis);
            middle(a).total_cmp(&middle(b)).then(a.cmp(&b))
        });
        self.divide(start, start + half);
        self.nodes[number].second = self.nodes.len() as u32;
        self.divide(start + half, end);
    }

    /// Calls `found` with the numbers of every two boxes that meet, the lower first, each pair
    /// once; ends when it says `false`.
    pub fn pairs(&self, mut found: impl FnMut(usize, usize) -> bool) {
        let mut open = if self.nodes.is_empty() { Vec::new() } else { vec![[0_u32; 2]] };
        while let Some([a, b]) = open.pop() {
            let [first, second] = [a, b].map(|i| &self.nodes[i as usize]);
            if !first.bounds.meets(&second.bounds) {
                continue;
            }
            if first.second == 0 && second.second == 0 {
                if !self.leaf_pairs(a == b, first, second, &mut found) {
                    return;
                }
            } else if a == b {
                open.extend([[a + 1, a + 1], [a + 1, first.second], [first.second; 2]]);
            } else if second.second == 0 || first.second != 0 && first.len() >= second.len() {
                open.extend([[a + 1, b], [first.second, b]]);
            } else {
                open.extend([[a, b + 1], [a, second.second]]);
            }
        }
    }

    /// The box whose content is nearest to a point, and how far it is: `distance` measures the
    /// content of one box, which must lie inside it. Of several the lowest number; `None` without
    /// boxes, or when no distance is a number.
    pub fn nearest(
        &self,
        p: DVec3,
        mut distance: impl FnMut(usize) -> f64,
    ) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        let reach = |node: u32| self.nodes[node as usize].bounds.distance(p);
        let mut open = if self.nodes.is_empty() { Vec::new() } else { vec![0_u32] };
        while let Some(number) = open.pop() {
            let node = &self.nodes[number as usize];
            if best.is_some_and(|(_, found)| node.bounds.distance(p) > found) {
                continue;
            }
            if node.second != 0 {
                // The nearer half is looked at first, so it is pushed last.
                let (a, b) = (number + 1, node.second);
                open.extend(if reach(a) <= reach(b) { [b, a] } else { [a, b] });
                continue;
            }
            for &i in self.run(node) {
                let d = distance(i as usize);
                let is_nearer =
                    best.is_none_or(|(j, found)| d < found || d == found && (i as usize) < j);
                if d.is_finite() && is_nearer {
                    best = Some((i as usize, d));
                }
            }
        }
        best
    }

    fn leaf_pairs(
        &self,
        is_one: bool,
        first: &Node,
        second: &Node,
        found: &mut impl FnMut(usize, usize) -> bool,
    ) -> bool {
        for (k, &i) in self.run(first).iter().enumerate() {
            let others = if is_one { &self.run(second)[k + 1..] } else { self.run(second) };
            for &j in others {
                let (low, high) = (i.min(j) as usize, i.max(j) as usize);
                if self.boxes[low].meets(&self.boxes[high]) && !found(low, high) {
                    return false;
                }
            }
        }
        true
    }

    fn run(&self, node: &Node) -> &[u32] {
        &self.order[node.start as usize..node.end as usize]
    }
}

impl Node {
    fn len(&self) -> u32 {
        self.end - self.start
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_pair_that_meets_is_found_once() {
        let mut seed = 7_u64;
        let mut number = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (seed >> 40) as f64 / (1_u64 << 24) as f64
        };
        for count in [0, 1, 2, 5, 40, 300] {
            let boxes: Vec<AxisBox> = (0..count)
                .map(|_| {
                    let low = DVec3::new(number(), number(), number());
                    AxisBox { low, high: low + DVec3::new(number(), number(), number()) * 0.2 }
                })
                .collect();
            let mut found = Vec::new();
            BoxTree::new(&boxes).pairs(|i, j| {
                found.push((i, j));
                true
            });
            found.sort_unstable();
            let all: Vec<(usize, usize)> = (0..count)
                .flat_map(|i| (i + 1..count).map(move |j| (i, j)))
                .filter(|&(i, j)| boxes[i].meets(&boxes[j]))
                .collect();
            assert_eq!(found, all);
            let p = DVec3::new(number(), number(), number());
            let from = |i: usize| boxes[i].distance(p);
            let nearest = (0..count).min_by(|&i, &j| from(i).total_cmp(&from(j)));
            let wanted = nearest.map(|i| (i, from(i)));
            assert_eq!(BoxTree::new(&boxes).nearest(p, from), wanted);
        }
    }
}
