//! Families of lengths: edges sorted into few groups, each drawn to the mean of its own.

use std::collections::BTreeMap;

use super::super::refine::edge;
use super::super::regions::Panels;

/// Rounds of sorting; more hardly move an edge from one family to another.
const ROUNDS: usize = 60;

/// The length that each edge is drawn to, its lower end first.
pub(in super::super) type Wanted = BTreeMap<[usize; 2], f64>;

/// Edges in families of about one length, and the mean of each family for its edges.
pub(in super::super) fn wanted_lengths(panels: &Panels, count: usize) -> Wanted {
    let mut lengths = BTreeMap::new();
    for face in &panels.faces {
        for i in 0..face.len() {
            let (u, v) = (face[i], face[(i + 1) % face.len()]);
            lengths.insert(edge(u, v), panels.points[u].distance(panels.points[v]));
        }
    }
    let all: Vec<f64> = lengths.values().copied().collect();
    lengths.into_keys().zip(means(&all, count)).collect()
}

/// For each number the mean of its family: k-means in one dimension (Lloyd 1982), from families of
/// equal counts.
fn means(all: &[f64], count: usize) -> Vec<f64> {
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|&a, &b| all[a].total_cmp(&all[b]).then(a.cmp(&b)));
    let sorted: Vec<f64> = order.iter().map(|&i| all[i]).collect();
    let count = count.min(sorted.len());
    let mut ends: Vec<usize> = (1..=count).map(|k| k * sorted.len() / count).collect();
    let mean = |from: usize, to: usize| sorted[from..to].iter().sum::<f64>() / (to - from) as f64;
    let middles = |ends: &[usize]| -> Vec<f64> {
        let starts = std::iter::once(0).chain(ends.iter().copied());
        let ways = starts.zip(ends.iter().copied());
        ways.filter(|(from, to)| from < to).map(|(from, to)| mean(from, to)).collect()
    };
    for _ in 0..ROUNDS {
        let middles = middles(&ends);
        let mut next: Vec<usize> = middles
            .windows(2)
            .map(|pair| sorted.partition_point(|x| *x < (pair[0] + pair[1]) / 2.0))
            .collect();
        next.push(sorted.len());
        if next == ends {
            break;
        }
        ends = next;
    }
    let mut wanted = vec![0.0; all.len()];
    let mut from = 0;
    for to in ends {
        if from < to {
            let middle = mean(from, to);
            order[from..to].iter().for_each(|&i| wanted[i] = middle);
        }
        from = to;
    }
    wanted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_heaps_go_to_the_means_of_these() {
        let all = [5.2, 1.0, 1.2, 9.0, 5.0, 1.1, 9.0, 9.0, 9.0, 9.0];
        let found = means(&all, 3);
        let expected = [5.1, 1.1, 1.1, 9.0, 5.1, 1.1, 9.0, 9.0, 9.0, 9.0];
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?}");
        assert_eq!(means(&[2.0, 1.0], 5), [2.0, 1.0]);
    }
}
