//! How many rings there are on a surface of revolution, and how many panels in each.

use std::f64::consts::{PI, TAU};

use super::revolve::Revolution;

/// The distance of rings along the curve, in panel sizes.
const HEIGHT: f64 = 0.88;
/// The number of panels may halve so often.
const HALVINGS: usize = 3;
/// What it costs to halve it, against the mean square of the logarithm of widths.
const HALVING_COST: f64 = 0.02;
/// Each halving is one more kind of panel: so many are taken lightly, and more cost so much each.
const FEW_HALVINGS: usize = 2;
/// See [`FEW_HALVINGS`].
const MANY_COST: f64 = 0.3;
/// A cap has at least so many sides, and a ring so many panels.
const LEAST: usize = 5;
/// So many plans of each kind are worth a try.
const KEPT: usize = 3;

/// One ring; a cap on the axis is a ring of one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    /// How many panels there are.
    pub count: usize,
    /// The angle of the first of them.
    pub offset: f64,
    /// Where it stands, as a share of the curve.
    pub share: f64,
    /// The number of its first panel.
    pub first: usize,
}

/// A plan of rings.
#[derive(Debug, Clone)]
pub(super) struct RingPlan {
    pub rings: Vec<Ring>,
    /// Whether panels are joined along the curve instead of along rings.
    pub is_columns: bool,
    /// Of rings that are mirror images of those at the other end of the curve: the turn about the axis
    /// that belongs to the image.
    pub turn: Option<f64>,
    cost: f64,
}

/// What is known of the surface, in panel sizes.
struct Survey<'a> {
    revolution: &'a Revolution,
    size: f64,
    /// How many panels there should be.
    wanted: f64,
}

/// Plans that are worth a try, the likeliest first.
pub(super) fn ring_plans(revolution: &Revolution, size: f64, wanted: f64) -> Vec<RingPlan> {
    let survey = Survey { revolution, size, wanted };
    let mut plans = survey.ring_plans();
    plans.extend(survey.column_plans());
    plans
}

impl Survey<'_> {
    fn around(&self, share: f64) -> f64 {
        TAU * self.revolution.at(share).x / self.size
    }

    /// Plans of rings that are joined along themselves.
    fn ring_plans(&self) -> Vec<RingPlan> {
        let length = self.revolution.length / self.size;
        let [start, end] = self.revolution.is_pole;
        // A rim cuts off half a ring, a cap is half of one.
        let poles = 0.5 * f64::from(u8::from(start) + u8::from(end));
        let exact = length / HEIGHT - poles;
        let mut plans = Vec::new();
        for more in [0.0, -1.0, 1.0] {
            let count = if self.revolution.is_loop {
                2.0 * (exact / 2.0 + more).round()
            } else {
                (exact + more).round()
            };
            let first = if start { 1.0 } else { 0.5 };
            let steps = if self.revolution.is_loop { count } else { count + poles };
            if count < 2.0 || self.revolution.is_loop && count < 4.0 {
                continue;
            }
            let shares: Vec<f64> =
                (0..count as usize).map(|j| (j as f64 + first) / steps).collect();
            plans.extend(self.with_counts(&shares));
        }
        best(plans)
    }

    /// Plans with rings at some shares of the curve.
    fn with_counts(&self, shares: &[f64]) -> Vec<RingPlan> {
        let widest = shares.iter().map(|&s| self.around(s)).fold(0.0, f64::max);
        let (low, high) = ((widest * 0.6) as usize, (widest * 1.6).ceil() as usize);
        let mut plans = Vec::new();
        for most in low.max(LEAST)..=high.max(LEAST) {
            let Some(counts) = self.counts(shares, most) else { continue };
            plans.push(self.plan(shares, &counts));
        }
        best(plans)
    }

    /// How many panels each ring has when the largest have `most`: so that they are as wide as high,
    /// by dynamic programming over the rings. What counts is how often the number is halved, and how
    /// many rings ago that changed.
    fn counts(&self, shares: &[f64], most: usize) -> Option<Vec<usize>> {
        let halvings = if self.revolution.is_loop { 0 } else { HALVINGS };
        let may = |h: usize| h <= halvings && most.is_multiple_of(1 << h) && most >> h >= LEAST;
        let own = |share: f64, h: usize| {
            let count = (most >> h) as f64;
            count / self.wanted * (self.around(share) / count).ln().powi(2)
        };
        // A state is three times the halvings and how many rings ago they changed, up to two.
        let states = 3 * (HALVINGS + 1);
        let mut costs = vec![f64::INFINITY; states];
        (0..=HALVINGS).filter(|&h| may(h)).for_each(|h| costs[3 * h + 2] = own(shares[0], h));
        let mut came: Vec<Vec<usize>> = Vec::new();
        for &share in &shares[1..] {
            let mut next = vec![f64::INFINITY; states];
            let mut from = vec![0; states];
            for (s, cost) in costs.iter().enumerate() {
                let (h, age) = (s / 3, s % 3);
                for to in (h.saturating_sub(1)..=h + 1).filter(|&to| may(to)) {
                    let (step, age) = match (to == h, age) {
                        (true, _) => (0.0, (age + 1).min(2)),
                        (false, 2) => (HALVING_COST, 0),
                        (false, _) => continue,
                    };
                    let total = cost + step + own(share, to);
                    if total < next[3 * to + age] {
                        (next[3 * to + age], from[3 * to + age]) = (total, s);
                    }
                }
            }
            came.push(from);
            costs = next;
        }
        let last = (0..states).min_by(|&a, &b| costs[a].total_cmp(&costs[b]))?;
        if !costs[last].is_finite() {
            return None;
        }
        let mut path = vec![last];
        for from in came.iter().rev() {
            path.push(from[path[path.len() - 1]]);
        }
        let mut counts: Vec<usize> = path.into_iter().rev().map(|s| most >> (s / 3)).collect();
        if self.revolution.is_mirrored {
            // Plans that cost the same need not be even.
            let last = counts.len() - 1;
            (0..counts.len() / 2).for_each(|j| counts[last - j] = counts[j]);
        }
        Some(counts)
    }

    /// The plan of rings that are joined along themselves, with caps where the curve meets the axis.
    fn plan(&self, shares: &[f64], counts: &[usize]) -> RingPlan {
        let [start, end] = self.revolution.is_pole;
        let mut rows: Vec<(usize, f64)> =
            counts.iter().copied().zip(shares.iter().copied()).collect();
        if start {
            rows.insert(0, (1, 0.0));
        }
        if end {
            rows.push((1, 1.0));
        }
        let halvings = counts.windows(2).filter(|pair| pair[0] != pair[1]).count();
        // Mirror images are no further kinds.
        let halvings = if self.revolution.is_mirrored { halvings / 2 } else { halvings };
        let widths = counts.iter().zip(shares);
        let widths = widths.map(|(&n, &s)| n as f64 * (self.around(s) / n as f64).ln().powi(2));
        let many = halvings.saturating_sub(FEW_HALVINGS) as f64;
        let cost =
            widths.sum::<f64>() / self.wanted + HALVING_COST * halvings as f64 + MANY_COST * many;
        self.numbered(&rows, false, cost)
    }

    /// Plans of columns: rings half a panel apart, of which every other one has the same angles.
    fn column_plans(&self) -> Vec<RingPlan> {
        let revolution = self.revolution;
        if revolution.is_pole != [false; 2] {
            return Vec::new();
        }
        let length = revolution.length / self.size;
        let mut plans = Vec::new();
        for more in [0, 1, -1, 2, -2] {
            let count = (2.0 * length).round() as i64 + more;
            let is_odd = count % 2 == 1;
            if count < 4 || revolution.is_loop && (is_odd || count < 6) {
                continue;
            }
            let panels = (self.wanted / count as f64).round() as usize;
            for panels in panels.saturating_sub(1)..=panels + 1 {
                if panels < LEAST {
                    continue;
                }
                let share = |k: i64| (k as f64 + 0.5) / count as f64;
                let rows: Vec<(usize, f64)> = (0..count).map(|k| (panels, share(k))).collect();
                let width = |s: f64| self.around(s) / (2 * panels) as f64 / 0.75_f64.sqrt();
                let cost = rows.iter().map(|&(_, s)| width(s).ln().powi(2)).sum::<f64>();
                plans.push(self.numbered(&rows, true, cost / count as f64));
            }
        }
        best(plans)
    }

    /// Rings by their number of panels and share of the curve.
    fn numbered(&self, rows: &[(usize, f64)], is_columns: bool, cost: f64) -> RingPlan {
        let mut rings: Vec<Ring> = Vec::new();
        let mut total = 0;
        for &(count, share) in rows {
            let offset = match rings.last() {
                Some(last) if last.count == count => last.offset + PI / count as f64,
                Some(last) => last.offset,
                None => 0.0,
            };
            rings.push(Ring { count, offset, share, first: total });
            total += count;
        }
        let turn = (self.revolution.is_mirrored && !is_columns).then(|| mirrored(&mut rings));
        let off = total as f64 / self.wanted - 1.0;
        RingPlan { rings, is_columns, turn, cost: cost + 4.0 * off * off }
    }
}

/// Gives the rings of the second half the angles of their images in the first, turned; the turn. Where
/// two rings stand in the middle, they are half a step apart.
fn mirrored(rings: &mut [Ring]) -> f64 {
    let count = rings.len();
    let turn = if count.is_multiple_of(2) { PI / rings[count / 2].count as f64 } else { 0.0 };
    for j in 0..count / 2 {
        rings[count - 1 - j].offset = rings[j].offset + turn;
    }
    turn
}

/// The plans that cost least.
fn best(mut plans: Vec<RingPlan>) -> Vec<RingPlan> {
    plans.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    plans.truncate(KEPT);
    plans
}
