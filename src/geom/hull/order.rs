//! In which order points are inserted: random rounds, each along a curve.
//!
//! Sources: Amenta, Choi and Rote 2003, "Incremental constructions con BRIO": rounds that double in size keep the expected
//! work low whatever the input, and within a round any order may be chosen. The order chosen is a Hilbert curve over the
//! six sides of a cube around the centre, so that neighbours in time are neighbours in direction and the walk to the next
//! point is short (random order instead takes some thirty times as long for a million points).

use glam::DVec3;

use super::parallel::{fill, sort};

/// Points that fit into the key beside round, side and place on the curve.
pub(super) const MOST_POINTS: usize = 1 << INDEX_BITS;
const INDEX_BITS: u32 = 26;
const CURVE_BITS: u32 = 15;
/// About how many points the first round holds.
const FIRST_ROUND: usize = 32;

/// The numbers 0..n in the order of insertion; `direction` is a point seen from the centre.
///
/// Depends on nothing but n and the directions: the rounds are drawn by a fixed hash of them, so that of equal points the one
/// with the lowest number comes first.
pub(super) fn insertion_order(n: usize, direction: impl Fn(usize) -> DVec3 + Sync) -> Vec<u32> {
    let ranges = ranges(n, &direction);
    let rounds = (n / FIRST_ROUND).max(1).ilog2().min(31);
    let bits = (n.max(1).ilog2() / 2 + 4).min(CURVE_BITS);
    let mut keys = vec![0_u64; n];
    fill(&mut keys, |i| {
        let direction = direction(i);
        let round = rounds - lateness(direction).min(rounds);
        let (side, u) = on_cube(direction);
        let place = hilbert(ranges[side].cell(u, bits), bits);
        u64::from(round) << 59 | (side as u64) << 56 | u64::from(place) << INDEX_BITS | i as u64
    });
    sort(&mut keys);
    keys.iter().map(|key| (key & (MOST_POINTS as u64 - 1)) as u32).collect()
}

/// What part of a side of the cube the points use, so that a flat dome still spreads over the whole curve.
#[derive(Clone, Copy)]
struct Range {
    low: [f64; 2],
    high: [f64; 2],
}

impl Range {
    fn cell(&self, u: [f64; 2], bits: u32) -> [u32; 2] {
        let cells = f64::from(1_u32 << bits);
        std::array::from_fn(|k| {
            let width = self.high[k] - self.low[k];
            let share = if width > 0.0 { (u[k] - self.low[k]) / width } else { 0.0 };
            // A cast saturates, so that rounding at the ends does no harm.
            ((share * cells) as u32).min((1 << bits) - 1)
        })
    }
}

fn ranges(n: usize, direction: &impl Fn(usize) -> DVec3) -> [Range; 6] {
    let mut ranges = [Range { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] }; 6];
    for i in 0..n {
        let (side, u) = on_cube(direction(i));
        let Range { low, high } = &mut ranges[side];
        *low = [low[0].min(u[0]), low[1].min(u[1])];
        *high = [high[0].max(u[0]), high[1].max(u[1])];
    }
    ranges
}

/// The side of the cube that a direction meets, and where.
fn on_cube(direction: DVec3) -> (usize, [f64; 2]) {
    let size = direction.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let height = direction[axis];
    if height == 0.0 {
        return (0, [0.0; 2]);
    }
    let u = [direction[(axis + 1) % 3], direction[(axis + 2) % 3]].map(|x| x / height.abs());
    (2 * axis + usize::from(height < 0.0), u)
}

/// The place of a cell along the Hilbert curve of a square with 2^bits cells a side.
fn hilbert([mut x, mut y]: [u32; 2], bits: u32) -> u32 {
    let mut place = 0;
    for level in (0..bits).rev() {
        let (right, upper) = (x >> level & 1, y >> level & 1);
        place = place << 2 | ((3 * right) ^ upper);
        // In the lower quarters the curve runs mirrored at the diagonal, in the right one at the other diagonal; without
        // branches, since nothing can foresee them.
        let lower = upper.wrapping_sub(1);
        let flip = lower & right.wrapping_neg();
        (x, y) = (x ^ flip, y ^ flip);
        let swap = (x ^ y) & lower;
        (x, y) = (x ^ swap, y ^ swap);
    }
    place
}

/// 0 for the last round, which holds half of the points, 1 for the one before, and so on.
fn lateness(direction: DVec3) -> u32 {
    hash(direction).trailing_zeros()
}

/// The finaliser of splitmix64 (Steele, Lea and Flood 2014), once for each coordinate.
fn hash(direction: DVec3) -> u64 {
    direction.to_array().into_iter().fold(0, |hash: u64, x| {
        // Adding zero makes −0 and 0 one.
        let mut z = hash.wrapping_add((x + 0.0).to_bits()).wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_every_cell_and_moves_to_a_neighbour() {
        let mut cells: Vec<[u32; 2]> = (0..1024).map(|i| [i % 32, i / 32]).collect();
        cells.sort_by_key(|&cell| hilbert(cell, 5));
        let step = |w: &[[u32; 2]]| w[0][0].abs_diff(w[1][0]) + w[0][1].abs_diff(w[1][1]);
        assert!(cells.windows(2).all(|w| step(w) == 1));
        assert_eq!(hilbert(cells[1023], 5), 1023);
    }

    #[test]
    fn every_number_comes_once_and_rounds_double() {
        let directions: Vec<DVec3> =
            (0..5000).map(|i| DVec3::new(f64::from(i) * 0.37, f64::from(i % 7) - 3.0, 5.0)).collect();
        let order = insertion_order(directions.len(), |i| directions[i]);
        let mut sorted = order.clone();
        sorted.sort_unstable();
        assert!(sorted.iter().enumerate().all(|(i, &p)| i == p as usize));
        // The last round holds about half of the points: those whose hash has no zeros at its end.
        let is_last = |&&i: &&u32| lateness(directions[i as usize]) == 0;
        let last = order.iter().rev().take_while(is_last).count();
        assert!((2300..2700).contains(&last), "{last}");
        assert_eq!(order.iter().filter(is_last).count(), last);
        assert!(insertion_order(0, |_| DVec3::ZERO).is_empty());
        assert_eq!(insertion_order(2, |_| DVec3::ZERO).len(), 2);
    }
}
