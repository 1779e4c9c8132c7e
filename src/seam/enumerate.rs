//! All perfect matchings of small 3-valent meshes, up to the symmetry of the mesh.

use std::collections::HashSet;

use super::graph::Graph;
use super::symmetry::{EdgeClasses, symmetries};
use super::weight::{fold_sum, quantised};
use super::{SeamError, piece_count, seam_cycles};
use crate::measure::edge_length;
use crate::mesh::{EdgeId, Mesh};
use crate::progress::Progress;

/// How many matchings [`matching`] lists at most before it gives up. Numbers grow fast: 9 for a
/// cube, 36 for a dodecahedron, 12 500 for a soccer ball.
pub const MATCHING_LIMIT: usize = 200_000;
/// Matchings listed between two questions whether to go on.
const LISTED_AT_ONCE: usize = 256;

/// All perfect matchings of a closed 3-valent mesh, one after the other, symmetric ones too. The
/// order is always the same but means nothing. Each step is quick in small meshes; the number of
/// matchings grows exponentially with the size.
#[derive(Debug, Clone)]
pub struct Matchings {
    graph: Graph,
    met: Vec<bool>,
    /// The vertices without a fold.
    unmet: Unmet,
    /// A vertex each, with the edges that may become its fold and how many of them have been tried.
    stack: Vec<Choice>,
    started: bool,
}

/// The vertices without a fold, by how many of their edges lead to another one without.
#[derive(Debug, Clone)]
struct Unmet {
    /// For each number of such edges the vertices that have it.
    of_count: [Vec<u32>; 4],
    count: Vec<usize>,
    /// Where each stands among those of its number.
    place: Vec<usize>,
}

impl Unmet {
    /// All vertices, with the number of their edges, 3 at most.
    fn new(counts: impl Iterator<Item = usize>) -> Self {
        let count: Vec<usize> = counts.collect();
        let place = vec![0; count.len()];
        let mut unmet = Self { of_count: Default::default(), count, place };
        // The lowest vertex comes last, that is first.
        (0..unmet.count.len() as u32).rev().for_each(|v| unmet.insert(v));
        unmet
    }

    fn insert(&mut self, v: u32) {
        let list = &mut self.of_count[self.count[v as usize]];
        self.place[v as usize] = list.len();
        list.push(v);
    }

    fn remove(&mut self, v: u32) {
        let list = &mut self.of_count[self.count[v as usize]];
        let place = self.place[v as usize];
        list.swap_remove(place);
        if let Some(&moved) = list.get(place) {
            self.place[moved as usize] = place;
        }
    }

    fn change(&mut self, v: u32, by: isize) {
        self.remove(v);
        let count = &mut self.count[v as usize];
        *count = count.wrapping_add_signed(by);
        self.insert(v);
    }

    /// The vertex with the fewest such edges, of several the one that came there last: near where
    /// the last fold was chosen, a dead end shows soonest.
    fn scarcest(&self) -> Option<u32> {
        self.of_count.iter().find_map(|list| list.last().copied())
    }
}

#[derive(Debug, Clone)]
struct Choice {
    edges: Vec<u32>,
    tried: usize,
}

impl Matchings {
    /// The matchings of a mesh.
    ///
    /// # Errors
    /// [`SeamError::Empty`], [`SeamError::Open`], [`SeamError::Valence`].
    pub fn new(mesh: &Mesh) -> Result<Self, SeamError> {
        let graph = Graph::cubic(mesh)?;
        let met = vec![false; graph.vertex_ids.len()];
        let count = |v: u32| graph.incident(v).iter().filter(|&&e| graph.other(e, v) != v).count();
        let unmet = Unmet::new((0..graph.vertex_count()).map(count));
        Ok(Self { graph, met, unmet, stack: Vec::new(), started: false })
    }

    /// Takes an edge as a fold.
    fn fold(&mut self, e: u32) {
        for v in self.graph.ends[e as usize] {
            self.met[v as usize] = true;
            self.unmet.remove(v);
            self.change_choices_around(v, -1);
        }
    }

    /// Gives the last fold up.
    fn unfold(&mut self, e: u32) {
        for v in self.graph.ends[e as usize].into_iter().rev() {
            self.change_choices_around(v, 1);
            self.met[v as usize] = false;
            self.unmet.insert(v);
        }
    }

    fn change_choices_around(&mut self, v: u32, by: isize) {
        for &e in self.graph.incident(v) {
            let w = self.graph.other(e, v);
            if w != v && !self.met[w as usize] {
                self.unmet.change(w, by);
            }
        }
    }

    /// The next matching as edge numbers, in the order of choice.
    fn advance(&mut self) -> Option<Vec<u32>> {
        if !std::mem::replace(&mut self.started, true) {
            let first = self.choice()?;
            self.stack.push(first);
        }
        while let Some(top) = self.stack.last_mut() {
            let last = top.tried.checked_sub(1).and_then(|i| top.edges.get(i)).copied();
            let next = top.edges.get(top.tried).copied();
            top.tried += 1;
            if let Some(last) = last {
                self.unfold(last);
            }
            let Some(next) = next else {
                self.stack.pop();
                continue;
            };
            self.fold(next);
            match self.choice() {
                Some(choice) => self.stack.push(choice),
                None => return Some(self.stack.iter().map(|c| c.edges[c.tried - 1]).collect()),
            }
        }
        None
    }

    /// A vertex without a fold that has the fewest edges left, so that what is forced comes first;
    /// `None` when all vertices have their folds.
    fn choice(&self) -> Option<Choice> {
        let v = self.unmet.scarcest()?;
        let is_open = |&e: &u32| {
            let w = self.graph.other(e, v);
            w != v && !self.met[w as usize]
        };
        let edges = self.graph.incident(v).iter().copied().filter(is_open).collect();
        Some(Choice { edges, tried: 0 })
    }
}

impl Iterator for Matchings {
    type Item = Vec<EdgeId>;

    fn next(&mut self) -> Option<Vec<EdgeId>> {
        let folds = self.advance()?;
        Some(self.graph.ids(folds))
    }
}

/// A choice of folds that meet every vertex once, standing for all that are symmetric to it.
#[derive(Debug, Clone, PartialEq)]
pub struct MatchingRow {
    /// Its number, from 0: the K of the selection `matching:K`.
    pub index: usize,
    /// The folds, ascending; the lexicographically least of all symmetric choices.
    pub folds: Vec<EdgeId>,
    /// Number of pieces that the seams leave.
    pub pieces: usize,
    /// Number of closed seams.
    pub seam_cycles: usize,
    /// Length of all seams together, in the model's unit.
    pub seam_length: f64,
    /// Sum of |fold angle| × length over the folds, in radians times the model's unit.
    pub fold_sum: f64,
    /// How many choices of folds are symmetric to this one, itself counted.
    pub orbit_size: usize,
}

/// All choices of folds that meet every vertex of a closed 3-valent mesh once, up to the symmetry
/// of the mesh (turns and mirrors that keep lengths and fold angles). The order: fewest pieces
/// first, then least fold sum, then the lexicographically least folds. `orbit_size` sums up to the
/// number of all perfect matchings.
///
/// # Errors
/// [`SeamError::Empty`], [`SeamError::Open`], [`SeamError::Valence`], [`SeamError::NoMatching`],
/// [`SeamError::Cancelled`], and [`SeamError::TooMany`] when there are more than `limit` matchings
/// (symmetric ones counted).
pub fn table(
    mesh: &Mesh,
    limit: usize,
    progress: &dyn Progress,
) -> Result<Vec<MatchingRow>, SeamError> {
    let mut matchings = Matchings::new(mesh)?;
    let mut all = Vec::new();
    while let Some(mut folds) = matchings.advance() {
        if all.len() == limit {
            return Err(SeamError::TooMany { limit });
        }
        if all.len() % LISTED_AT_ONCE == 0 {
            if progress.is_cancelled() {
                return Err(SeamError::Cancelled);
            }
            progress.report("listing matchings", all.len(), 0);
        }
        folds.sort_unstable();
        all.push(folds);
    }
    if all.is_empty() {
        // The solver says why.
        super::least_matching(mesh, progress)?;
    }
    all.sort_unstable();
    let graph = &matchings.graph;
    let classes = EdgeClasses::new(mesh, graph);
    let weights = quantised(&classes.weights, graph.vertex_ids.len());
    let mut rows: Vec<(i64, MatchingRow)> = orbits(&all, &symmetries(mesh, graph, &classes))
        .into_iter()
        .map(|(folds, orbit_size)| {
            (
                folds.iter().map(|&e| weights[e as usize]).sum(),
                row(mesh, graph.ids(folds.iter().copied()), orbit_size),
            )
        })
        .collect();
    rows.sort_by(|(a, r), (b, s)| (r.pieces, a, &r.folds).cmp(&(s.pieces, b, &s.folds)));
    Ok(rows.into_iter().enumerate().map(|(index, (_, row))| MatchingRow { index, ..row }).collect())
}

/// The folds of row `index` (from 0) of [`table`].
///
/// # Errors
/// As [`table`] with [`MATCHING_LIMIT`], and [`SeamError::NoSuchMatching`].
pub fn matching(
    mesh: &Mesh,
    index: usize,
    progress: &dyn Progress,
) -> Result<Vec<EdgeId>, SeamError> {
    let mut rows = table(mesh, MATCHING_LIMIT, progress)?;
    if index >= rows.len() {
        return Err(SeamError::NoSuchMatching { index, count: rows.len() });
    }
    Ok(rows.swap_remove(index).folds)
}

fn row(mesh: &Mesh, folds: Vec<EdgeId>, orbit_size: usize) -> MatchingRow {
    let cycles = seam_cycles(mesh, &folds);
    let seam_length = cycles.iter().flatten().map(|h| edge_length(mesh, h.edge())).sum();
    let (pieces, fold_sum) = (piece_count(mesh, &folds), fold_sum(mesh, &folds));
    MatchingRow {
        index: 0,
        folds,
        pieces,
        seam_cycles: cycles.len(),
        seam_length,
        fold_sum,
        orbit_size,
    }
}

/// The first of each set of symmetric matchings, and the size of the set. The matchings come
/// sorted, so the first is the lexicographically least.
fn orbits<'a>(all: &'a [Vec<u32>], symmetries: &[Vec<u32>]) -> Vec<(&'a [u32], usize)> {
    let mut seen: HashSet<Vec<u32>> = HashSet::with_capacity(all.len());
    let mut orbits = Vec::new();
    for folds in all {
        if !seen.insert(folds.clone()) {
            continue;
        }
        let mut orbit = vec![folds.clone()];
        let mut next = 0;
        while let Some(member) = orbit.get(next).cloned() {
            next += 1;
            for permutation in symmetries {
                let mut image: Vec<u32> = member.iter().map(|&e| permutation[e as usize]).collect();
                image.sort_unstable();
                if !seen.contains(&image) {
                    seen.insert(image.clone());
                    orbit.push(image);
                }
            }
        }
        orbits.push((folds.as_slice(), orbit.len()));
    }
    orbits
}

#[cfg(test)]
mod tests {
    use super::super::{fixtures, is_perfect_matching, least_matching};
    use super::*;
    use crate::progress::Silent;

    /// How many matchings leave how many pieces.
    fn pieces(mesh: &Mesh) -> Vec<(usize, usize)> {
        let rows = table(mesh, MATCHING_LIMIT, &Silent).expect("matchings");
        let mut counts = std::collections::BTreeMap::new();
        for row in &rows {
            assert!(is_perfect_matching(mesh, &row.folds));
            assert_eq!(row.pieces, row.seam_cycles + 1, "on a sphere");
            *counts.entry(row.pieces).or_insert(0) += row.orbit_size;
        }
        let listed = Matchings::new(mesh).expect("cubic").collect::<HashSet<_>>();
        assert_eq!(listed.len(), counts.values().sum::<usize>(), "every matching once");
        counts.into_iter().collect()
    }

    #[test]
    fn counts_agree_with_exhaustive_search() {
        assert_eq!(pieces(&fixtures::tetrahedron()), [(2, 3)]);
        assert_eq!(pieces(&fixtures::cube()), [(2, 6), (3, 3)]);
        assert_eq!(pieces(&fixtures::dodecahedron()), [(2, 30), (4, 6)]);
        assert_eq!(
            pieces(&fixtures::truncated(&fixtures::tetrahedron(), 1.0 / 3.0)),
            [(2, 3), (3, 4), (5, 1)]
        );
        let truncated_cube = fixtures::truncated(&fixtures::cube(), 1.0 / (2.0 + 2f64.sqrt()));
        assert_eq!(pieces(&truncated_cube), [(2, 6), (3, 3), (4, 16), (6, 6), (9, 1)]);
        assert_eq!(pieces(&fixtures::prism(6, 1.0)), [(2, 8), (3, 10), (4, 2)]);
        assert_eq!(pieces(&fixtures::tutte()), [(3, 168), (4, 444), (5, 312), (6, 36)]);
    }

    #[test]
    fn symmetric_matchings_are_one_row() {
        let sizes = |mesh: &Mesh| {
            table(mesh, 1000, &Silent)
                .expect("matchings")
                .iter()
                .map(|r| (r.pieces, r.orbit_size))
                .collect::<Vec<_>>()
        };
        assert_eq!(sizes(&fixtures::tetrahedron()), [(2, 3)]);
        assert_eq!(sizes(&fixtures::cube()), [(2, 6), (3, 3)]);
        assert_eq!(sizes(&fixtures::dodecahedron()), [(2, 30), (4, 6)]);
        // A brick is less symmetric than a cube.
        let mut brick: Vec<usize> = sizes(&fixtures::prism(4, 2.0)).iter().map(|s| s.1).collect();
        brick.sort_unstable();
        assert_eq!(brick, [1, 2, 2, 4]);
    }

    #[test]
    fn rows_do_not_hang_on_rounding() {
        // The same brick, turned and moved: the same table.
        let brick = fixtures::truncated(&fixtures::prism(5, 2.0), 0.3);
        let mut turned = brick.clone();
        let turn = glam::DMat3::from_axis_angle(glam::DVec3::new(1.0, 2.0, 2.0) / 3.0, 0.7);
        for v in brick.vertices() {
            turned.set_position(
                v,
                turn * brick.position(v) * 1000.0 + glam::DVec3::splat(77.0),
                true,
            );
        }
        let folds = |mesh: &Mesh| {
            table(mesh, 1000, &Silent)
                .expect("rows")
                .into_iter()
                .map(|r| r.folds)
                .collect::<Vec<_>>()
        };
        assert_eq!(folds(&brick), folds(&turned));
        let first = &table(&brick, 1000, &Silent).expect("rows")[0];
        assert_eq!(matching(&brick, 0, &Silent).expect("a row"), first.folds);
    }

    #[test]
    fn the_least_of_all_is_what_the_solver_finds() {
        for mesh in [
            fixtures::cube(),
            fixtures::random_convex(14, 3),
            fixtures::prism(7, 3.0),
            fixtures::tutte(),
        ] {
            let rows = table(&mesh, MATCHING_LIMIT, &Silent).expect("rows");
            let least = rows.iter().map(|r| r.fold_sum).fold(f64::INFINITY, f64::min);
            let found = fold_sum(&mesh, &least_matching(&mesh, &Silent).expect("a matching"));
            assert!((found - least).abs() <= 1e-9 * least, "{found} {least}");
        }
    }

    #[test]
    fn a_torus_counts_pieces_by_faces() {
        let torus = fixtures::hexagon_torus(3, 2);
        let rows = table(&torus, MATCHING_LIMIT, &Silent).expect("rows");
        assert!(
            rows.iter().any(|r| r.pieces == 1),
            "a seam that does not separate leaves one piece"
        );
        assert!(rows.iter().any(|r| r.pieces != r.seam_cycles + 1));
    }

    #[test]
    fn what_cannot_be_is_said() {
        let cube = fixtures::cube();
        assert_eq!(table(&cube, 8, &Silent), Err(SeamError::TooMany { limit: 8 }));
        assert_eq!(table(&cube, 9, &Silent).expect("nine").len(), 2);
        assert_eq!(
            matching(&cube, 2, &Silent),
            Err(SeamError::NoSuchMatching { index: 2, count: 2 })
        );
    }
}
