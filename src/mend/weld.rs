//! Which vertices lie together, and what is left of a face when they become one.

use std::hash::BuildHasher as _;

use glam::DVec3;
use hashbrown::HashTable;

use crate::geom::Grid;

/// The vertex that each vertex goes into: the nearest earlier one that stays and is at most
/// `distance` away, in the unit of the positions; 0 takes equal positions only. Those that stay are
/// farther apart than `distance`.
pub fn weld_targets(positions: &[DVec3], distance: f64) -> Vec<u32> {
    if distance > 0.0 { nearest_earlier(positions, distance) } else { first_equal(positions) }
}

/// The first vertex at the same position, for each.
pub fn first_equal(positions: &[DVec3]) -> Vec<u32> {
    // The table holds numbers of vertices only, and asks the positions themselves.
    let hasher = foldhash::fast::RandomState::default();
    let key = |v: u32| position_key(positions[v as usize]);
    let hash = |&v: &u32| hasher.hash_one(key(v));
    let mut first = HashTable::with_capacity(positions.len() / 6);
    let first_of =
        |v: u32| *first.entry(hash(&v), |&other| key(other) == key(v), hash).or_insert(v).get();
    (0..positions.len() as u32).map(first_of).collect()
}

/// Equal positions have equal keys; −0 equals 0.
pub fn position_key(p: DVec3) -> [u64; 3] {
    (p + 0.0).to_array().map(f64::to_bits)
}

fn nearest_earlier(positions: &[DVec3], distance: f64) -> Vec<u32> {
    let low = positions.iter().copied().reduce(DVec3::min).unwrap_or_default();
    let high = positions.iter().copied().reduce(DVec3::max).unwrap_or_default();
    // Cells may be larger than the distance, never smaller, so that only neighbours are searched
    // and the numbers stay small.
    let cell = distance.max((high - low).max_element() / (1_u64 << 40) as f64);
    let mut grid = Grid::new(low.to_array(), cell);
    // The vertices that stay, by their numbers in the grid.
    let mut staying: Vec<u32> = Vec::new();
    let mut target = Vec::with_capacity(positions.len());
    for (v, &p) in positions.iter().enumerate() {
        let mut nearest: Option<(f64, u32)> = None;
        for w in grid.around(p.to_array()).map(|number| staying[number as usize]) {
            let d = p.distance(positions[w as usize]);
            if d <= distance && nearest.is_none_or(|n| (d, w) < n) {
                nearest = Some((d, w));
            }
        }
        if nearest.is_none() {
            grid.insert(p.to_array());
            staying.push(v as u32);
        }
        target.push(nearest.map_or(v as u32, |(_, w)| w));
    }
    target
}

/// Removes corners that repeat the one before, and spikes that run out and back: neither bounds any
/// area.
pub fn remove_spikes(face: &mut Vec<u32>) {
    let mut at = 0;
    let mut unchanged = 0;
    while face.len() > 1 && unchanged < face.len() {
        let n = face.len();
        at %= n;
        let (here, next) = (face[at], face[(at + 1) % n]);
        if here == next {
            face.remove(at);
        } else if n > 2 && face[(at + 2) % n] == here {
            // here – next – here: next goes, and one of the two.
            face.remove((at + 1) % n);
            let at_here = if (at + 1) % n < at { at - 1 } else { at };
            face.remove(at_here);
        } else {
            at += 1;
            unchanged += 1;
            continue;
        }
        at = at.saturating_sub(2);
        unchanged = 0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn spikes_go_and_the_rest_stays() {
        let cleaned = |face: &[u32]| {
            let mut face = face.to_vec();
            remove_spikes(&mut face);
            face
        };
        assert_eq!(cleaned(&[1, 2, 3, 4]), [1, 2, 3, 4]);
        assert_eq!(cleaned(&[1, 1, 2, 3, 3]), [1, 2, 3]);
        assert!(cleaned(&[1, 2, 1, 3]).len() < 3);
        assert!(cleaned(&[1, 1, 1]).len() < 3);
        let mut kept = cleaned(&[1, 2, 3, 2, 4]);
        kept.sort_unstable();
        assert_eq!(kept, [1, 2, 4]);
        assert_eq!(cleaned(&[1, 2, 3, 1, 4, 5]), [1, 2, 3, 1, 4, 5]);
    }

    #[test]
    fn minus_zero_is_zero() {
        assert_eq!(first_equal(&[DVec3::ZERO, DVec3::X, -DVec3::ZERO]), [0, 1, 0]);
    }

    proptest! {
        #[test]
        fn survivors_are_further_apart_than_the_distance(
            points in prop::collection::vec(prop::array::uniform3(-3_i8..3), 1..40),
            distance in 0.01_f64..2.5,
        ) {
            let positions: Vec<DVec3> = points.iter().map(|p| DVec3::from_array(p.map(f64::from)) * 0.7).collect();
            let target = nearest_earlier(&positions, distance);
            for (v, &t) in target.iter().enumerate() {
                prop_assert_eq!(target[t as usize], t);
                prop_assert!(positions[v].distance(positions[t as usize]) <= distance);
                for (w, &u) in target.iter().enumerate() {
                    let both_stay = t as usize == v && u as usize == w && v != w;
                    prop_assert!(!both_stay || positions[v].distance(positions[w]) > distance);
                }
            }
        }
    }
}
