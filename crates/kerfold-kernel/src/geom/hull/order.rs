//! In which order points are inserted: random rounds, each along a curve.
//!
//! Sources: Amenta, Choi and Rote 2003, "Incremental constructions con BRIO": rounds that grow by a
//! constant factor keep the expected work low whatever the input, and within a round any order may
//! be chosen. Here each round brings the points to four times as many, which on a sphere is some 6
//! % faster than twice. The order chosen is a Hilbert curve over the six sides of a cube around the
//! centre, so that neighbours in time are neighbours in direction and the way to the next point is
//! short (random order instead takes some thirty times as long for a million points).
//!
//! Only the first rounds run over the whole cube. The points of the last two are taken cell by
//! cell, a cell being a stretch of the curve, each with its own rounds: so the facets at work fit
//! into a near cache, and cells far apart can be worked on at the same time.

use glam::DVec3;

use super::parallel::{each, fill, sort};

/// Points that fit into the key beside round, side and place on the curve.
pub(super) const MOST_POINTS: usize = 1 << INDEX_BITS;
const INDEX_BITS: u32 = 26;
const CURVE_BITS: u32 = 13;
/// Side of the cube and place on its curve.
const PLACE_BITS: u32 = 3 + 2 * CURVE_BITS;
const ROUND_BITS: u32 = 5;
/// About how many points the first round holds.
const FIRST_ROUND: usize = 32;
/// So many of the last rounds are taken cell by cell.
const CELL_ROUNDS: u32 = 2;
const CELL_ROUND_BITS: u32 = 1;
/// How many points a cell holds.
const CELL_POINTS: usize = 1 << 13;
/// From so many points on the range of directions is taken from a sample.
const SAMPLED_FROM: usize = 1 << 12;
const SAMPLE_STEP: usize = 16;

/// In which order points are inserted. A point's place is its index in `points`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Order {
    /// The numbers of the points.
    pub points: Vec<u32>,
    /// For each of the seeds, which come first, the cell that it lies in.
    pub seed_cells: Vec<u32>,
    /// For each cell along the curve the place behind its last point.
    pub cells: Vec<u32>,
}

/// The order of `n` points; `direction` is a point seen from the centre.
///
/// Depends on nothing but n and the directions: the rounds are drawn by a fixed hash of them, so
/// that of equal points the one with the lowest number comes first.
pub(super) fn insertion_order(n: usize, direction: impl Fn(usize) -> DVec3 + Sync) -> Order {
    let layout = Layout::of(n, &direction);
    let mut keys = vec![0_u64; n];
    fill(&mut keys, |i| layout.key(direction(i)) | i as u64);
    sort(&mut keys);
    let (seeds, late) = keys.split_at(keys.partition_point(|&key| key < LATE));
    let mut points = vec![0; n];
    let (seed_points, late_points) = points.split_at_mut(seeds.len());
    seed_points.iter_mut().zip(seeds).for_each(|(point, &key)| *point = number(key));
    let mut cells: Vec<(&[u64], &mut [u32])> =
        late.chunks(CELL_POINTS).zip(late_points.chunks_mut(CELL_POINTS)).collect();
    each(&mut cells, n, |(keys, points)| by_rounds(keys, points));
    let firsts: Vec<u64> = cells.iter().map(|(keys, _)| late_place(keys[0])).collect();
    let cell_of = |&key: &u64| {
        firsts.partition_point(|&first| first <= seed_place(key)).saturating_sub(1) as u32
    };
    let seed_cells = seeds.iter().map(cell_of).collect();
    let ends = (1..=firsts.len())
        .map(|k| (seeds.len() + (k * CELL_POINTS).min(late.len())) as u32)
        .collect();
    Order { points, seed_cells, cells: ends }
}

/// Set in the keys of the points that are no seeds.
const LATE: u64 = 1 << 63;
/// Where the place on the curve begins in the key of a point that is no seed.
const LATE_PLACE: u32 = INDEX_BITS + CELL_ROUND_BITS;

fn number(key: u64) -> u32 {
    (key & (MOST_POINTS as u64 - 1)) as u32
}

fn seed_place(key: u64) -> u64 {
    key >> INDEX_BITS & ((1 << PLACE_BITS) - 1)
}

fn late_place(key: u64) -> u64 {
    (key & !LATE) >> LATE_PLACE
}

fn late_round(key: u64) -> usize {
    (key >> INDEX_BITS & ((1 << CELL_ROUND_BITS) - 1)) as usize
}

/// The points of a cell, which are sorted along the curve, round by round.
fn by_rounds(keys: &[u64], points: &mut [u32]) {
    let mut next = [0; 1 << CELL_ROUND_BITS];
    keys.iter().for_each(|&key| next[late_round(key)] += 1);
    let mut begin = 0;
    for next in &mut next {
        begin += std::mem::replace(next, begin);
    }
    for &key in keys {
        let place = &mut next[late_round(key)];
        points[*place] = number(key);
        *place += 1;
    }
}

/// How the sides of the cube are divided.
struct Layout {
    sides: [Raster; 6],
    rounds: u32,
    /// Levels of the curve.
    bits: u32,
}

impl Layout {
    fn of(n: usize, direction: &impl Fn(usize) -> DVec3) -> Self {
        let bits = (n.max(1).ilog2() / 2 + 4).min(CURVE_BITS);
        Self {
            sides: ranges(n, direction).map(|range| Raster::of(range, bits)),
            rounds: ((n / FIRST_ROUND).max(1).ilog2() / 2).min((1 << ROUND_BITS) - 1),
            bits,
        }
    }

    /// The key by which points are sorted, with room for the number of the point in its lowest
    /// bits. Seeds: round, then place on the curve. Others: place, then round.
    fn key(&self, direction: DVec3) -> u64 {
        let late = lateness(direction);
        let (side, u) = on_cube(direction);
        let curve = hilbert(self.sides[side].cell(u), self.bits);
        let place = (side as u64) << (2 * self.bits) | u64::from(curve);
        if late >= CELL_ROUNDS || self.rounds < 2 * CELL_ROUNDS {
            (u64::from(self.rounds - late.min(self.rounds)) << PLACE_BITS | place) << INDEX_BITS
        } else {
            LATE | place << LATE_PLACE | u64::from(CELL_ROUNDS - 1 - late) << INDEX_BITS
        }
    }
}

/// What part of a side of the cube the points use, so that a flat dome still spreads over the whole
/// curve.
#[derive(Clone, Copy)]
struct Range {
    low: [f64; 2],
    high: [f64; 2],
}

/// Where the cells of a curve lie within a range.
#[derive(Clone, Copy)]
struct Raster {
    low: [f64; 2],
    /// Cells per length.
    density: [f64; 2],
    bits: u32,
}

impl Raster {
    fn of(Range { low, high }: Range, bits: u32) -> Self {
        let cells = f64::from(1_u32 << bits);
        Self { low, density: std::array::from_fn(|k| cells / (high[k] - low[k])), bits }
    }

    fn cell(&self, u: [f64; 2]) -> [u32; 2] {
        // A cast saturates, so that what lies beyond the ends goes to them, and takes the NaN of no
        // width to 0.
        std::array::from_fn(|k| {
            (((u[k] - self.low[k]) * self.density[k]) as u32).min((1 << self.bits) - 1)
        })
    }
}

/// The ranges of the directions, of many those of a sample: they only decide how well the curve is
/// used.
fn ranges(n: usize, direction: &impl Fn(usize) -> DVec3) -> [Range; 6] {
    let mut ranges = [Range { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] }; 6];
    for i in (0..n).step_by(if n < SAMPLED_FROM { 1 } else { SAMPLE_STEP }) {
        let (side, u) = on_cube(direction(i));
        let Range { low, high } = &mut ranges[side];
        *low = [low[0].min(u[0]), low[1].min(u[1])];
        *high = [high[0].max(u[0]), high[1].max(u[1])];
    }
    ranges
}

/// The side of the cube that a direction meets, and where. The three sides around a corner follow
/// one another, so that half of the curve has a short border.
fn on_cube(direction: DVec3) -> (usize, [f64; 2]) {
    // By index, since nothing can foresee a branch.
    let coordinates = direction.to_array();
    let size = coordinates.map(f64::abs);
    let larger = usize::from(size[1] > size[0]);
    let axis = [larger, 2][usize::from(size[2] > size[larger])];
    let height = coordinates[axis];
    if height == 0.0 {
        return (0, [0.0; 2]);
    }
    let inverse = 1.0 / height.abs();
    let u = [coordinates[[1, 2, 0][axis]] * inverse, coordinates[[2, 0, 1][axis]] * inverse];
    (axis + 3 * usize::from(height < 0.0), u)
}

/// The place of a cell along the Hilbert curve of a square with 2^bits cells a side.
fn hilbert([x, y]: [u32; 2], bits: u32) -> u32 {
    // Several levels at a time. An odd number of levels above, all zeros, would turn the curve, so
    // whole steps are taken from the top.
    let steps = bits.div_ceil(STEP_LEVELS);
    let shift = STEP_LEVELS * steps - bits;
    let (x, y) = (x << shift, y << shift);
    let (mut place, mut state) = (0, 0);
    for step in (0..steps).rev() {
        let [x, y] = [x, y].map(|c| c >> (STEP_LEVELS * step) & STEP_MASK);
        let entry = u32::from(STEP[(state << (2 * STEP_LEVELS) | x << STEP_LEVELS | y) as usize]);
        place = place << (2 * STEP_LEVELS) | entry & PLACE_MASK;
        state = entry >> (2 * STEP_LEVELS);
    }
    place >> (2 * shift)
}

/// So many levels of the curve are looked up at once.
const STEP_LEVELS: u32 = 5;
const STEP_MASK: u32 = (1 << STEP_LEVELS) - 1;
const PLACE_MASK: u32 = (1 << (2 * STEP_LEVELS)) - 1;

/// For each state of the curve and place of a cell in a square of 32 × 32 how far along the curve
/// the cell lies, in the lower ten bits, and the state of the curve within it. State 0 is the curve
/// from the lower left to the lower right, 1 that mirrored at the diagonal; 2 is added where it is
/// mirrored at both sides.
static STEP: [u16; 4 << (2 * STEP_LEVELS)] = step_table();

const fn step_table() -> [u16; 4 << (2 * STEP_LEVELS)] {
    let mut table = [0; 4 << (2 * STEP_LEVELS)];
    let mut i = 0;
    while i < table.len() {
        let (mut x, mut y, mut place) =
            (i as u32 >> STEP_LEVELS & STEP_MASK, i as u32 & STEP_MASK, 0);
        let state = i as u32 >> (2 * STEP_LEVELS);
        let (mut is_swapped, mut is_flipped) = (state & 1 == 1, state >> 1 == 1);
        if is_flipped {
            (x, y) = (STEP_MASK - x, STEP_MASK - y);
        }
        if is_swapped {
            (x, y) = (y, x);
        }
        let mut level = STEP_LEVELS;
        while level > 0 {
            level -= 1;
            let (right, upper) = (x >> level & 1, y >> level & 1);
            place = place << 2 | ((3 * right) ^ upper);
            // In the lower quarters the curve runs mirrored at the diagonal, in the right one at
            // the other diagonal.
            if upper == 0 {
                if right == 1 {
                    (x, y) = (!x, !y);
                    is_flipped = !is_flipped;
                }
                (x, y) = (y, x);
                is_swapped = !is_swapped;
            }
        }
        table[i] = (place
            | (is_swapped as u32) << (2 * STEP_LEVELS)
            | (is_flipped as u32) << (2 * STEP_LEVELS + 1)) as u16;
        i += 1;
    }
    table
}

/// 0 for the last round, which holds three quarters of the points, 1 for the one before, and so on.
fn lateness(direction: DVec3) -> u32 {
    hash(direction).trailing_zeros() / 2
}

/// The finaliser of splitmix64 (Steele, Lea and Flood 2014) of the coordinates, multiplied together
/// on the way.
fn hash(direction: DVec3) -> u64 {
    // Adding zero makes −0 and 0 one.
    let mixed = direction.to_array().into_iter().fold(0x9e37_79b9_7f4a_7c15_u64, |hash, x| {
        (hash ^ (x + 0.0).to_bits()).wrapping_mul(0xbf58_476d_1ce4_e5b9).rotate_left(29)
    });
    let mut z = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_visits_every_cell_and_moves_to_a_neighbour() {
        let mut cells: Vec<[u32; 2]> = (0..1024).map(|i| [i % 32, i / 32]).collect();
        let step = |w: &[[u32; 2]]| w[0][0].abs_diff(w[1][0]) + w[0][1].abs_diff(w[1][1]);
        for bits in 5..9 {
            cells.sort_by_key(|&cell| hilbert(cell, bits));
            assert!(bits > 5 || cells.windows(2).all(|w| step(w) == 1));
            assert!(
                cells.iter().zip(0..).all(|(&cell, place)| hilbert(cell, bits) == place),
                "{bits}"
            );
        }
    }

    fn directions(n: usize) -> Vec<DVec3> {
        (0..n as u32)
            .map(|i| DVec3::new(f64::from(i) * 0.37 - 700.0, f64::from(i % 7) - 3.0, 5.0))
            .collect()
    }

    #[test]
    fn every_number_comes_once_and_the_seeds_come_first() {
        for n in [0, 2, 100, 5000, 200_000] {
            let directions = directions(n);
            let Order { points, seed_cells, cells } = insertion_order(n, |i| directions[i]);
            let mut sorted = points.clone();
            sorted.sort_unstable();
            assert!(sorted.iter().enumerate().all(|(i, &p)| i == p as usize));
            assert_eq!(points.len(), n);
            assert_eq!(cells.last().map_or(seed_cells.len(), |&end| end as usize), n);
            assert!(
                cells.is_sorted()
                    && seed_cells.iter().all(|&cell| (cell as usize) < cells.len().max(1))
            );
            // Of many points one in sixteen is a seed.
            assert!(
                n < 10_000 || (n / 18..n / 14).contains(&seed_cells.len()),
                "{}",
                seed_cells.len()
            );
        }
    }

    #[test]
    fn rounds_quadruple_within_a_cell() {
        let directions = directions(200_000);
        let Order { points, seed_cells, cells } =
            insertion_order(directions.len(), |i| directions[i]);
        let mut start = seed_cells.len();
        for end in cells {
            let run = &points[start..end as usize];
            let late: Vec<u32> = run.iter().map(|&i| lateness(directions[i as usize])).collect();
            assert!(late.is_sorted_by(|a, b| a >= b));
            start = end as usize;
        }
        let last = directions.iter().filter(|&&d| lateness(d) == 0).count();
        assert!((148_000..152_000).contains(&last), "{last}");
    }
}
