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

/// For each number the mean of its family: k-means in one dimension (Lloyd 1982), the better of two
/// starts: families of equal counts, and families between the widest gaps, which finds those that
/// there are already.
fn means(all: &[f64], count: usize) -> Vec<f64> {
    let mut order: Vec<usize> = (0..all.len()).collect();
    order.sort_by(|&a, &b| all[a].total_cmp(&all[b]).then(a.cmp(&b)));
    let sorted: Vec<f64> = order.iter().map(|&i| all[i]).collect();
    let count = count.min(sorted.len());
    let even: Vec<usize> = (1..=count).map(|k| k * sorted.len() / count).collect();
    let mut gaps: Vec<usize> = (1..sorted.len()).collect();
    let gap = |i: usize| sorted[i] - sorted[i - 1];
    gaps.sort_by(|&i, &j| gap(j).total_cmp(&gap(i)).then(i.cmp(&j)));
    gaps.truncate(count.saturating_sub(1));
    gaps.push(sorted.len());
    gaps.sort_unstable();
    let found = [even, gaps].map(|ends| relaxed(&sorted, ends));
    let off = |means: &[f64]| sorted.iter().zip(means).map(|(x, m)| (x - m).powi(2)).sum::<f64>();
    let best = if off(&found[1]) < off(&found[0]) { &found[1] } else { &found[0] };
    let mut wanted = vec![0.0; all.len()];
    order.iter().zip(best).for_each(|(&i, &mean)| wanted[i] = mean);
    wanted
}

/// The mean of the family of each of some ascending numbers; families end before `ends` at first.
fn relaxed(sorted: &[f64], mut ends: Vec<usize>) -> Vec<f64> {
    let mean = |from: usize, to: usize| sorted[from..to].iter().sum::<f64>() / (to - from) as f64;
    let runs = |ends: &[usize]| -> Vec<[usize; 2]> {
        let starts = std::iter::once(0).chain(ends.iter().copied());
        let runs = starts.zip(ends.iter().copied()).map(|(from, to)| [from, to]);
        runs.filter(|[from, to]| from < to).collect()
    };
    for _ in 0..ROUNDS {
        let middles: Vec<f64> = runs(&ends).into_iter().map(|[from, to]| mean(from, to)).collect();
        let between = |pair: &[f64]| sorted.partition_point(|x| *x < (pair[0] + pair[1]) / 2.0);
        let mut next: Vec<usize> = middles.windows(2).map(between).collect();
        next.push(sorted.len());
        if next == ends {
            break;
        }
        ends = next;
    }
    let family = |[from, to]: [usize; 2]| std::iter::repeat_n(mean(from, to), to - from);
    runs(&ends).into_iter().flat_map(family).collect()
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
        // Few of one kind beside many of another: families of equal counts would never part them.
        let heaps = [1.0; 50].into_iter().chain([2.0, 3.0, 4.0]).collect::<Vec<f64>>();
        assert_eq!(means(&heaps, 4), heaps);
    }
}
