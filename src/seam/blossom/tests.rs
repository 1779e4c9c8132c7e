use super::*;
use crate::progress::Silent;

/// A small generator of pseudo-random numbers (SplitMix64).
pub(in crate::seam) struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
}

/// Complementary slackness: the matching is perfect, no edge is shorter than its duals, matched
/// edges are tight, blossoms have duals that are not negative and are full. Together: no perfect
/// matching has a smaller sum.
fn assert_optimal(graph: &Graph, weights: &[i64], matching: &[u32], certificate: &Certificate) {
    let n = graph.vertex_count() as usize;
    let mut met = vec![0; n];
    for &e in matching {
        for v in graph.ends[e as usize] {
            met[v as usize] += 1;
        }
    }
    assert!(met.iter().all(|&m| m == 1), "not a perfect matching");
    let mut slack: Vec<i64> = graph
        .ends
        .iter()
        .zip(weights)
        .map(|(&[u, v], w)| {
            4 * w - certificate.vertices[u as usize] - certificate.vertices[v as usize]
        })
        .collect();
    let mut bound: i128 = certificate.vertices.iter().map(|&y| i128::from(y)).sum();
    let mut is_matched = vec![false; weights.len()];
    matching.iter().for_each(|&e| is_matched[e as usize] = true);
    let mut inside = vec![false; n];
    for (vertices, dual) in &certificate.blossoms {
        assert!(*dual >= 0 && vertices.len() % 2 == 1);
        bound += i128::from(*dual);
        vertices.iter().for_each(|&v| inside[v as usize] = true);
        for &v in vertices {
            for &e in graph.incident(v) {
                if !inside[graph.other(e, v) as usize] {
                    slack[e as usize] -= dual;
                }
            }
        }
        vertices.iter().for_each(|&v| inside[v as usize] = false);
    }
    for (e, &s) in slack.iter().enumerate() {
        let [u, v] = graph.ends[e];
        assert!(u == v || s >= 0, "edge {e} has slack {s}");
        assert!(!is_matched[e] || s == 0, "matched edge {e} has slack {s}");
    }
    let sum: i128 = matching.iter().map(|&e| 4 * i128::from(weights[e as usize])).sum();
    assert_eq!(sum, bound, "the dual bound is not reached");
}

fn assert_solved(graph: &Graph, weights: &[i64]) -> Vec<u32> {
    let mut solver = Solver::new(graph, weights);
    solver.run(&Silent).expect("a perfect matching");
    let matching = solver.matching();
    assert_optimal(graph, weights, &matching, &solver.certificate());
    matching
}

/// The least sum by trying everything; `None` when there is no perfect matching.
fn brute_force(graph: &Graph, weights: &[i64], met: &mut Vec<bool>) -> Option<i64> {
    let Some(v) = met.iter().position(|m| !m) else { return Some(0) };
    met[v] = true;
    let mut best: Option<i64> = None;
    for &e in graph.incident(v as u32) {
        let u = graph.other(e, v as u32) as usize;
        if met[u] {
            continue;
        }
        met[u] = true;
        let rest = brute_force(graph, weights, met);
        met[u] = false;
        best = [best, rest.map(|r| r + weights[e as usize])].into_iter().flatten().min();
    }
    met[v] = false;
    best
}

/// Every vertex with three random partners; loops and double edges come up too.
fn random_cubic(vertices: usize, random: &mut Random) -> Graph {
    let mut ends: Vec<u32> = (0..vertices as u32).flat_map(|v| [v; 3]).collect();
    for i in (1..ends.len()).rev() {
        ends.swap(i, random.below(i + 1));
    }
    Graph::of_ends(vertices, ends.chunks_exact(2).map(|p| [p[0], p[1]]).collect())
}

/// Hexagons in a torus of `w` by `h` cells: large, cubic, bipartite; an even `twist` shears it; `h`
/// is even.
fn brick_wall(w: usize, h: usize, twist: usize) -> Graph {
    let at = |x: usize, y: usize| {
        ((y % h) * 2 * w + (x + if y >= h { twist } else { 0 }) % (2 * w)) as u32
    };
    let mut ends = Vec::new();
    for y in 0..h {
        for x in 0..2 * w {
            ends.push([at(x, y), at(x + 1, y)]);
            if (x + y) % 2 == 0 {
                ends.push([at(x, y), at(x, y + 1)]);
            }
        }
    }
    Graph::of_ends(2 * w * h, ends)
}

#[test]
fn small_graphs_agree_with_trying_everything() {
    let mut random = Random(1);
    let (mut solved, mut refused) = (0, 0);
    for round in 0..4000 {
        let n = 2 * (1 + random.below(6));
        let graph = if round % 2 == 0 {
            random_cubic(n, &mut random)
        } else {
            let m = random.below(3 * n) + n / 2;
            Graph::of_ends(
                n,
                (0..m).map(|_| [random.below(n) as u32, random.below(n) as u32]).collect(),
            )
        };
        let range = [3, 10, 1 << 40][round % 3];
        let weights: Vec<i64> =
            graph.ends.iter().map(|_| random.below(range) as i64 - range as i64 / 3).collect();
        match brute_force(&graph, &weights, &mut vec![false; n]) {
            Some(least) => {
                let sum: i64 =
                    assert_solved(&graph, &weights).iter().map(|&e| weights[e as usize]).sum();
                assert_eq!(sum, least);
                solved += 1;
            }
            None => {
                let unmatched = least_perfect_matching(&graph, &weights, &Silent)
                    .expect_err("no perfect matching");
                let Unmatched::Barrier(barrier) = unmatched else { panic!("{unmatched:?}") };
                assert_barrier(&graph, &barrier);
                refused += 1;
            }
        }
    }
    assert!(solved > 1000 && refused > 300, "{solved} solved, {refused} refused");
}

/// Counts the odd parts that are left without the barrier.
fn assert_barrier(graph: &Graph, barrier: &Barrier) {
    let n = graph.vertex_count();
    let mut seen = vec![false; n as usize];
    barrier.vertices.iter().for_each(|&v| seen[v as usize] = true);
    let mut odd = 0;
    for seed in 0..n {
        let mut stack = vec![seed];
        let mut size = 0;
        while let Some(v) = stack.pop() {
            if !std::mem::replace(&mut seen[v as usize], true) {
                size += 1;
                stack.extend(graph.incident(v).iter().map(|&e| graph.other(e, v)));
            }
        }
        odd += size % 2;
    }
    assert_eq!(odd, barrier.odd_parts);
    assert!(odd > barrier.vertices.len());
}

#[test]
fn large_graphs_are_proved_least() {
    let mut random = Random(2);
    for (round, range) in [(0, 1), (1, 2), (2, 10), (3, 1000), (4, 1 << 40), (5, 1 << 20)] {
        let graph =
            if round % 2 == 0 { random_cubic(3000, &mut random) } else { brick_wall(40, 40, 6) };
        let weights: Vec<i64> = graph.ends.iter().map(|_| random.below(range) as i64).collect();
        // A random cubic graph may have a bridge; these have none that matters.
        assert_solved(&graph, &weights);
    }
}

#[test]
fn nearly_equal_weights_and_many_odd_cycles() {
    let mut random = Random(3);
    for seed in 0..20 {
        // A ring of triangles: blossoms everywhere.
        let n = 6 * (20 + seed);
        let triangles = n / 3;
        let mut ends = Vec::new();
        for t in 0..triangles as u32 {
            ends.extend([[3 * t, 3 * t + 1], [3 * t + 1, 3 * t + 2], [3 * t + 2, 3 * t]]);
        }
        let mut free: Vec<u32> = (0..n as u32).collect();
        for i in (1..free.len()).rev() {
            free.swap(i, random.below(i + 1));
        }
        ends.extend(free.chunks_exact(2).map(|p| [p[0], p[1]]));
        let graph = Graph::of_ends(n, ends);
        let weights: Vec<i64> =
            graph.ends.iter().map(|_| (1 << 40) + random.below(4) as i64).collect();
        assert_solved(&graph, &weights);
    }
}

/// Thousands of edges, with ties and without; how fast a hundred thousand are is the bench's to
/// tell.
#[test]
fn thousands_of_edges() {
    let mut random = Random(4);
    for range in [1, 2, 10, 1000, 1 << 40] {
        for graph in [brick_wall(37, 36, 6), random_cubic(2_666, &mut random)] {
            let weights: Vec<i64> = graph.ends.iter().map(|_| random.below(range) as i64).collect();
            assert_solved(&graph, &weights);
        }
    }
}
