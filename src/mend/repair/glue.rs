//! Which sides of faces belong together; faces turned and vertices parted after that.

use glam::DVec3;

use super::super::soup::{Side, Soup, by_edge};
use super::{Repair, Repairs};

/// A side without a neighbour.
const NONE: u32 = u32::MAX;

/// The neighbour of every side.
pub(super) struct Glue {
    sides: Vec<Side>,
    /// Where the sides of each face begin.
    starts: Vec<u32>,
    /// The other side at the edge, or [`NONE`].
    other: Vec<u32>,
    /// How many edges had more than two faces.
    crowded: usize,
}

impl Glue {
    pub(super) fn new(soup: &Soup) -> Self {
        let sides = soup.sides();
        let mut other = vec![NONE; sides.len()];
        let mut crowded = 0;
        let edges = by_edge(&sides);
        // Faces that end somewhere are fins rather than walls of a solid.
        let mut is_fin = vec![false; soup.faces.len()];
        for edge in edges.iter().filter(|edge| edge.len() == 1) {
            is_fin[sides[edge[0] as usize].face as usize] = true;
        }
        for edge in edges {
            let pairs = match edge[..] {
                [_] => continue,
                [a, b] => vec![[a, b]],
                _ => {
                    crowded += 1;
                    let of_fin = |&s: &u32| is_fin[sides[s as usize].face as usize];
                    let (fins, walls): (Vec<u32>, Vec<u32>) = edge.into_iter().partition(of_fin);
                    let mut pairs = pairs_around(soup, &sides, &walls);
                    pairs.extend(pairs_around(soup, &sides, &fins));
                    pairs
                }
            };
            for [a, b] in pairs {
                (other[a as usize], other[b as usize]) = (b, a);
            }
        }
        let mut starts = Vec::with_capacity(soup.faces.len());
        let mut start = 0;
        for face in &soup.faces {
            starts.push(start);
            start += face.corners.len() as u32;
        }
        Self { sides, starts, other, crowded }
    }

    fn sides_of(&self, soup: &Soup, face: u32) -> std::ops::Range<u32> {
        let start = self.starts[face as usize];
        start..start + soup.faces[face as usize].corners.len() as u32
    }

    /// Turns faces so that neighbours run along their edge in opposite directions. Of each part the
    /// side with less area turns; where that is impossible, the edge is cut open.
    pub(super) fn orient(&mut self, soup: &mut Soup, repairs: &mut Repairs) {
        let mut is_turned = vec![false; soup.faces.len()];
        let mut is_met = vec![false; soup.faces.len()];
        let mut turned_count = 0;
        let mut cut = 0;
        for seed in 0..soup.faces.len() as u32 {
            if std::mem::replace(&mut is_met[seed as usize], true) {
                continue;
            }
            let mut part = vec![seed];
            let mut at = 0;
            while at < part.len() {
                let f = part[at];
                at += 1;
                for s in self.sides_of(soup, f) {
                    let t = self.other[s as usize];
                    if t == NONE {
                        continue;
                    }
                    let (a, b) = (self.sides[s as usize], self.sides[t as usize]);
                    let runs_along = a.from == b.from;
                    let wanted = is_turned[f as usize] != runs_along;
                    if !std::mem::replace(&mut is_met[b.face as usize], true) {
                        is_turned[b.face as usize] = wanted;
                        part.push(b.face);
                    } else if is_turned[b.face as usize] != wanted {
                        (self.other[s as usize], self.other[t as usize]) = (NONE, NONE);
                        cut += 1;
                    }
                }
            }
            turned_count += turn_lesser(soup, &part, &mut is_turned);
        }
        for (face, _) in soup.faces.iter_mut().zip(&is_turned).filter(|(_, turned)| **turned) {
            face.corners.reverse();
        }
        self.follow(soup, &is_turned);
        repairs.add(Repair::Turned, turned_count);
        repairs.add(Repair::OneSided, cut);
    }

    /// The sides of the faces as they run now.
    fn follow(&mut self, soup: &Soup, is_turned: &[bool]) {
        // Reversed, the side from corner i to i + 1 becomes the one that begins at n − 2 − i.
        let mut new_place: Vec<u32> = (0..self.sides.len() as u32).collect();
        for (f, _) in is_turned.iter().enumerate().filter(|(_, turned)| **turned) {
            let n = soup.faces[f].corners.len() as u32;
            for i in 0..n {
                new_place[(self.starts[f] + i) as usize] = self.starts[f] + (2 * n - 2 - i) % n;
            }
        }
        let mut other = vec![NONE; self.other.len()];
        for (s, &t) in self.other.iter().enumerate().filter(|(_, t)| **t != NONE) {
            other[new_place[s] as usize] = new_place[t as usize];
        }
        (self.sides, self.other) = (soup.sides(), other);
    }

    /// Gives every fan of faces vertices of its own, and edges that would still be one a vertex in
    /// between. Needs faces that are oriented.
    pub(super) fn part(&mut self, soup: &mut Soup, repairs: &mut Repairs) {
        let fans = self.fans(soup);
        let mut vertex_of_fan = vec![NONE; self.sides.len()];
        let mut is_taken = vec![false; soup.positions.len()];
        let mut parted = 0;
        for (fan, side) in fans.iter().zip(&self.sides) {
            let (fan, v) = (*fan as usize, side.from);
            if vertex_of_fan[fan] == NONE {
                vertex_of_fan[fan] = if std::mem::replace(&mut is_taken[v as usize], true) {
                    parted += 1;
                    soup.positions.push(soup.positions[v as usize]);
                    soup.positions.len() as u32 - 1
                } else {
                    v
                };
            }
        }
        for (s, side) in self.sides.iter().enumerate() {
            let corner = &mut soup.faces[side.face as usize].corners[side.corner as usize];
            *corner = vertex_of_fan[fans[s] as usize];
        }
        self.part_edges(soup);
        repairs.add(Repair::PartedEdges, self.crowded);
        repairs.add(Repair::PartedVertices, parted);
    }

    /// For each corner, named by the side that begins there, the lowest one of its fan.
    fn fans(&self, soup: &Soup) -> Vec<u32> {
        let mut fan: Vec<u32> = (0..self.sides.len() as u32).collect();
        fn root(fan: &mut [u32], mut at: u32) -> u32 {
            while fan[at as usize] != at {
                fan[at as usize] = fan[fan[at as usize] as usize];
                at = fan[at as usize];
            }
            at
        }
        let next = |s: u32| {
            let side = self.sides[s as usize];
            let n = soup.faces[side.face as usize].corners.len() as u32;
            self.starts[side.face as usize] + (side.corner + 1) % n
        };
        for (s, &t) in self.other.iter().enumerate() {
            let s = s as u32;
            if t == NONE || t < s {
                continue;
            }
            // The start of one is the end of the other.
            for (a, b) in [(s, next(t)), (next(s), t)] {
                let (a, b) = (root(&mut fan, a), root(&mut fan, b));
                fan[a.max(b) as usize] = a.min(b);
            }
        }
        (0..fan.len() as u32).map(|s| root(&mut fan, s)).collect()
    }

    /// Of several edges between the same two vertices all but the first get a vertex in between.
    fn part_edges(&self, soup: &mut Soup) {
        let sides = soup.sides();
        let mut more: Vec<(u32, u32)> = Vec::new();
        for edge in by_edge(&sides).into_iter().filter(|edge| edge.len() > 1) {
            let own: Vec<u32> = edge
                .iter()
                .copied()
                .filter(|&s| self.other[s as usize] == NONE || s < self.other[s as usize])
                .collect();
            for (k, &s) in own.iter().enumerate().skip(1) {
                let [a, b] = sides[s as usize].ends().map(|v| soup.positions[v as usize]);
                let v = soup.positions.len() as u32;
                soup.positions.push(a.lerp(b, k as f64 / own.len() as f64));
                more.push((s, v));
                let t = self.other[s as usize];
                more.extend((t != NONE).then_some((t, v)));
            }
        }
        // From the last on, so that the places of earlier corners stay.
        more.sort_unstable_by(|a, b| b.cmp(a));
        for (s, v) in more {
            let side = sides[s as usize];
            soup.faces[side.face as usize].corners.insert(side.corner as usize + 1, v);
        }
    }
}

/// Of a part, turns the faces that have less area together; returns how many.
fn turn_lesser(soup: &Soup, part: &[u32], is_turned: &mut [bool]) -> usize {
    let area = |turned: bool| -> f64 {
        let faces = part.iter().filter(|&&f| is_turned[f as usize] == turned);
        faces.map(|&f| soup.area_vector(f as usize).length()).sum()
    };
    if area(true) > area(false) {
        part.iter().for_each(|&f| is_turned[f as usize] ^= true);
    }
    part.iter().filter(|&&f| is_turned[f as usize]).count()
}

/// Pairs of sides around an edge with more than two faces, so that the solid lies between the two of
/// a pair, as the faces say by the way they look; what they contradict each other about is paired
/// by angle.
fn pairs_around(soup: &Soup, sides: &[Side], edge: &[u32]) -> Vec<[u32; 2]> {
    let Some(&first) = edge.first() else { return Vec::new() };
    let [a, b] = sides[first as usize].ends();
    let axis = (soup.positions[b as usize] - soup.positions[a as usize]).normalize_or_zero();
    let across = axis.any_orthonormal_vector();
    let up = axis.cross(across);
    let angle = |s: u32| {
        let side = sides[s as usize];
        let along = if side.from == a { axis } else { -axis };
        let inwards = soup.normal(side.face as usize).map_or(DVec3::ZERO, |n| n.cross(along));
        inwards.dot(up).atan2(inwards.dot(across))
    };
    let mut around: Vec<(f64, u32)> = edge.iter().map(|&s| (angle(s), s)).collect();
    around.sort_by(|x, y| x.0.total_cmp(&y.0).then(x.1.cmp(&y.1)));
    let n = around.len();
    let goes_up = |i: usize| sides[around[i].1 as usize].from == a;
    let mut pairs = Vec::new();
    let mut is_paired = vec![false; n];
    // A face that runs up the edge has the solid before it, one that runs down behind it.
    for i in 0..n {
        let before = (i + n - 1) % n;
        if goes_up(i) && !goes_up(before) {
            pairs.push([around[before].1, around[i].1]);
            (is_paired[before], is_paired[i]) = (true, true);
        }
    }
    let rest: Vec<u32> = (0..n).filter(|&i| !is_paired[i]).map(|i| around[i].1).collect();
    pairs.extend(rest.chunks_exact(2).map(|pair| [pair[0], pair[1]]));
    pairs
}
