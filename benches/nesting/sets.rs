//! The sets of pieces: made from a seed by splitmix64, then scaled so that their area is the
//! promised number of sheets.

use glam::DVec2;

/// Pieces and the sheets that they are to be laid on.
#[derive(Debug, Clone)]
pub struct Set {
    pub sheet: DVec2,
    /// Area of the pieces in sheets: no layout can be better.
    pub bound: f64,
    pub pieces: Vec<Vec<DVec2>>,
}

struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ self.0 >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ mixed >> 31) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }
}

/// Set `a`, `b`, `c` or `d`.
pub fn set(name: &'static str, seed: u64) -> Set {
    let mut dice =
        Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(0x2545_f491_4f6c_dd1d));
    let small = DVec2::new(600.0, 400.0);
    let (sheet, bound, count, make): (_, _, usize, fn(&mut Dice) -> Vec<DVec2>) = match name {
        "a" => (small, 2.82, 200, |dice| convex(dice, 40.0, 120.0)),
        "b" => (small, 2.66, 60, arc),
        "c" => (DVec2::new(1220.0, 2440.0), 2.24, 1000, |dice| convex(dice, 60.0, 150.0)),
        _ => (small, 0.81, 12, why),
    };
    let mut pieces: Vec<Vec<DVec2>> = (0..count).map(|_| make(&mut dice)).collect();
    let area: f64 = pieces.iter().map(|p| area(p)).sum::<f64>() / (sheet.x * sheet.y);
    pieces.iter_mut().flatten().for_each(|p| *p *= (bound / area).sqrt());
    Set { sheet, bound, pieces }
}

pub fn area(contour: &[DVec2]) -> f64 {
    (0..contour.len()).map(|i| contour[i].perp_dot(contour[(i + 1) % contour.len()])).sum::<f64>()
        / 2.0
}

/// Five to seven corners on an ellipse of the given width.
fn convex(dice: &mut Dice, low: f64, high: f64) -> Vec<DVec2> {
    let corners = 5 + (dice.unit() * 3.0) as usize;
    let width = dice.between(low, high);
    let aspect = dice.between(0.7, 1.0);
    let turn = DVec2::from_angle(dice.between(0.0, std::f64::consts::TAU));
    let corner = |i: usize| {
        let at = (i as f64 + 0.7 * (dice.unit() - 0.5)) * std::f64::consts::TAU / corners as f64;
        turn.rotate(DVec2::new(at.cos(), at.sin() * aspect) * (width / 2.0))
    };
    (0..corners).map(corner).collect()
}

/// A bent strip, 20 to 40 mm wide and 200 to 500 mm long.
fn arc(dice: &mut Dice) -> Vec<DVec2> {
    const STEPS: i32 = 12;
    let (width, length, sweep) =
        (dice.between(20.0, 40.0), dice.between(200.0, 500.0), dice.between(40.0, 140.0));
    let sweep = sweep.to_radians();
    let radius = length / sweep;
    let at =
        |radius: f64, i: i32| DVec2::from_angle(sweep * f64::from(i) / f64::from(STEPS)) * radius;
    let outer = (0..=STEPS).map(|i| at(radius + width / 2.0, i));
    outer.chain((0..=STEPS).rev().map(|i| at(radius - width / 2.0, i))).collect()
}

/// Three arms.
fn why(dice: &mut Dice) -> Vec<DVec2> {
    let (length, half) = (dice.between(110.0, 150.0), dice.between(18.0, 23.0));
    let arm = |k: i32| {
        let along = DVec2::from_angle((90.0 + 120.0 * f64::from(k)).to_radians());
        let fork = DVec2::from_angle((150.0 + 120.0 * f64::from(k)).to_radians());
        [
            along * length - along.perp() * half,
            along * length + along.perp() * half,
            fork * (half / 60f64.to_radians().sin()),
        ]
    };
    (0..3).flat_map(arm).collect()
}
