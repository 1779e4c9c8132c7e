//! A triangle mesh made fine: edges that are too long are halved, and their triangles divided into
//! two, three or four, until none is left.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;

/// Points and triangles by the numbers of their corners, counter-clockwise.
#[derive(Debug, Clone, Default)]
pub(super) struct Triangles {
    pub points: Vec<DVec3>,
    pub corners: Vec<[usize; 3]>,
    /// Edges that stay where they are, the lower vertex first.
    pub creases: BTreeSet<[usize; 2]>,
}

impl Triangles {
    /// Halves edges until none is longer than `longest`, or until there are more than `most`
    /// triangles; whether it came to an end. The longest edges are halved first and edges turned in
    /// between, so that needles become triangles instead of many needles.
    pub(super) fn refine(&mut self, longest: f64, most: usize) -> bool {
        let length = |&[a, b]: &[usize; 2]| self.points[a].distance(self.points[b]);
        let sides = self.corners.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let mut limit = sides.map(|e| length(&e)).fold(0.0, f64::max);
        loop {
            limit = (limit / 1.5).max(longest);
            self.make_delaunay();
            loop {
                let middles = self.halve(limit);
                if middles.is_empty() {
                    break;
                }
                if self.corners.len() + 2 * middles.len() > most {
                    return false;
                }
                self.divide(&middles);
            }
            if limit <= longest {
                self.make_delaunay();
                return true;
            }
        }
    }

    /// The new vertices in the middle of edges that are too long.
    fn halve(&mut self, longest: f64) -> BTreeMap<[usize; 2], usize> {
        let mut middles = BTreeMap::new();
        for &[a, b, c] in &self.corners {
            for [u, v] in [[a, b], [b, c], [c, a]] {
                let (p, q) = (self.points[u], self.points[v]);
                if p.distance(q) > longest && !middles.contains_key(&edge(u, v)) {
                    middles.insert(edge(u, v), self.points.len());
                    self.points.push(p.midpoint(q));
                }
            }
        }
        middles
    }

    fn divide(&mut self, middles: &BTreeMap<[usize; 2], usize>) {
        let mut made = Vec::with_capacity(self.corners.len() + 2 * middles.len());
        for &[a, b, c] in &self.corners {
            let halved = [[a, b], [b, c], [c, a]].map(|[u, v]| middles.get(&edge(u, v)).copied());
            match halved {
                [None, None, None] => made.push([a, b, c]),
                [Some(m), None, None] => made.extend([[a, m, c], [m, b, c]]),
                [None, Some(m), None] => made.extend([[b, m, a], [m, c, a]]),
                [None, None, Some(m)] => made.extend([[c, m, b], [m, a, b]]),
                [Some(m), Some(n), None] => made.extend(self.three([a, b, c], m, n)),
                [None, Some(m), Some(n)] => made.extend(self.three([b, c, a], m, n)),
                [Some(n), None, Some(m)] => made.extend(self.three([c, a, b], m, n)),
                [Some(l), Some(m), Some(n)] => {
                    made.extend([[a, l, n], [l, b, m], [n, m, c], [l, m, n]]);
                }
            }
        }
        self.corners = made;
        let halves = |&[a, b]: &[usize; 2]| match middles.get(&[a, b]) {
            Some(&m) => vec![edge(a, m), edge(m, b)],
            None => vec![[a, b]],
        };
        self.creases = self.creases.iter().flat_map(halves).collect();
    }

    /// A triangle a, b, c with middles m on a–b and n on b–c; the quad that is left is divided by
    /// its shorter diagonal.
    fn three(&self, [a, b, c]: [usize; 3], m: usize, n: usize) -> [[usize; 3]; 3] {
        let p = &self.points;
        if p[a].distance_squared(p[n]) < p[c].distance_squared(p[m]) {
            [[m, b, n], [a, m, n], [a, n, c]]
        } else {
            [[m, b, n], [a, m, c], [m, n, c]]
        }
    }
}

/// The ends of an edge, the lower first.
pub(super) fn edge(u: usize, v: usize) -> [usize; 2] {
    [u.min(v), u.max(v)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_become_short_and_the_area_stays() {
        let points = [(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)];
        let points = points.map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let mut mesh =
            Triangles { points, corners: vec![[0, 1, 2], [0, 2, 3]], ..Triangles::default() };
        assert!(mesh.refine(0.3, 10_000));
        let area: f64 = mesh
            .corners
            .iter()
            .map(|t| t.map(|i| mesh.points[i]))
            .map(|[a, b, c]| (b - a).cross(c - a).z / 2.0)
            .inspect(|area| assert!(*area > 0.0))
            .sum();
        assert!((area - 3.0).abs() < 1e-12);
        assert!(!mesh.refine(1e-3, 10_000), "more triangles than allowed");
    }
}
