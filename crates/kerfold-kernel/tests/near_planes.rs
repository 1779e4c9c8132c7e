//! Half-spaces that are given several times up to their last digits: every vertex of the solid lies
//! within the stated bound of its planes, by exact arithmetic.
//!
//! `KERFOLD_SETS=100000` tries more sets.

use glam::DVec3;
use kerfold_kernel::geom::hull::{
    Form, HalfSpace, Intersect, Numbers, Polytope, intersect_verified,
};
use kerfold_kernel::random::Rng;
use num_bigint::BigInt;

/// How many sets are tried.
const SETS: u64 = 10_000;

/// A number m · 2^e; every double is one.
struct Dyadic {
    m: BigInt,
    e: i32,
}

impl Dyadic {
    fn of(x: f64) -> Self {
        let bits = x.to_bits();
        let exponent = (bits >> 52 & 0x7ff) as i32;
        let fraction = (bits & ((1 << 52) - 1)) as i64;
        let m = if exponent == 0 { fraction } else { fraction | 1 << 52 };
        Self { m: BigInt::from(if x < 0.0 { -m } else { m }), e: exponent.max(1) - 1075 }
    }

    fn times(&self, other: &Self) -> Self {
        Self { m: &self.m * &other.m, e: self.e + other.e }
    }

    fn plus(&self, other: &Self) -> Self {
        let e = self.e.min(other.e);
        let lifted = |x: &Self| &x.m << ((x.e - e) as usize);
        Self { m: lifted(self) + lifted(other), e }
    }

    fn is_above(&self, other: &Self) -> bool {
        let negative = Self { m: -&other.m, e: other.e };
        self.plus(&negative).m > BigInt::ZERO
    }
}

/// n·x − d.
fn height(h: &HalfSpace, x: DVec3) -> Dyadic {
    let term = |k: usize| Dyadic::of(h.normal[k]).times(&Dyadic::of(x[k]));
    [term(0), term(1), term(2)].iter().fold(Dyadic::of(-h.offset), |sum, term| sum.plus(term))
}

/// Whether a vertex lies outside a half-space, or off its plane, by more than a bound: exact.
fn is_off(h: &HalfSpace, x: DVec3, bound: f64, is_own: bool) -> bool {
    let terms = (h.normal * x).abs();
    let rounded = h.normal.dot(x) - h.offset;
    let doubt = 4.0 * f64::EPSILON * (terms.x + terms.y + terms.z + h.offset.abs());
    // Rounded arithmetic is enough far inside.
    if !is_own && rounded < -doubt {
        return false;
    }
    let height = height(h, x);
    if !is_own && height.m <= BigInt::ZERO {
        return false;
    }
    // (n·x − d)² > bound² n·n
    let squared = |x: f64| Dyadic::of(x).times(&Dyadic::of(x));
    let n = h.normal.to_array().map(squared);
    let length = n[0].plus(&n[1]).plus(&n[2]);
    height.times(&height).is_above(&squared(bound).times(&length))
}

#[track_caller]
fn assert_right(p: &Polytope, half_spaces: &[HalfSpace], bounds: f64, what: &str) {
    let bound = bounds * p.rounding();
    for (v, &x) in p.vertices.iter().enumerate() {
        assert!(x.is_finite(), "{what}: vertex {v}");
        for (i, h) in half_spaces.iter().enumerate() {
            assert!(!is_off(h, x, bound, false), "{what}: vertex {v} is outside {i}: {x}");
        }
    }
    for (run, &i) in p.faces.iter().zip(&p.half_spaces) {
        for &v in run {
            let (x, h) = (p.vertices[v as usize], &half_spaces[i as usize]);
            assert!(!is_off(h, x, bound, true), "{what}: vertex {v} is off its plane {i}: {x}");
        }
    }
}

/// Unit normals and distances of a solid that is bounded.
fn shape(kind: u64, random: &mut Rng) -> Vec<HalfSpace> {
    let unit = |normal| HalfSpace { normal, offset: 1.0 };
    let ends = [unit(DVec3::Z), unit(DVec3::NEG_Z)];
    match kind % 4 {
        0 => DVec3::AXES.into_iter().flat_map(|axis| [unit(axis), unit(-axis)]).collect(),
        1 => {
            let sides = 3 + random.below(12);
            let angle = |k: usize| std::f64::consts::TAU * k as f64 / sides as f64;
            let side = |k: usize| unit(DVec3::new(angle(k).cos(), angle(k).sin(), 0.0));
            (0..sides).map(side).chain(ends).collect()
        }
        2 => {
            let axes = DVec3::AXES.into_iter().flat_map(|axis| [unit(axis), unit(-axis)]);
            axes.chain((0..random.below(10)).map(|_| unit(random.on_sphere()))).collect()
        }
        _ => {
            // A slab some thousand times wider than thick.
            let thin = 10.0_f64.powf(-3.0 * random.unit());
            let cube = DVec3::AXES.into_iter().flat_map(|axis| [unit(axis), unit(-axis)]);
            cube.map(|h| HalfSpace { offset: if h.normal.z == 0.0 { 1.0 } else { thin }, ..h })
                .collect()
        }
    }
}

/// A number moved by some ulps, or by a share of it.
fn nudged(x: f64, noise: f64, random: &mut Rng) -> f64 {
    if noise > 0.0 {
        x + noise * random.signed()
    } else {
        [x.next_down(), x, x.next_up()][random.below(3)]
    }
}

/// 12 to 40 planes: those of a shape, turned, scaled and moved, and some of them again with noise.
fn set(seed: u64) -> Vec<HalfSpace> {
    let mut random = Rng::new(seed);
    let shape = shape(seed, &mut random);
    let (x, z) = (random.on_sphere(), random.on_sphere());
    let y = z.cross(x).normalize();
    let turned = [y.cross(x), y, x];
    let frame = [[DVec3::X, DVec3::Y, DVec3::Z], turned, turned][(seed / 4 % 3) as usize];
    let size = 10.0_f64.powf(4.0 * random.signed());
    let shift = random.on_sphere() * size * [0.0, 3.0][(seed / 12 % 2) as usize];
    let placed = |h: &HalfSpace| {
        let normal = frame[0] * h.normal.x + frame[1] * h.normal.y + frame[2] * h.normal.z;
        HalfSpace { normal, offset: h.offset * size + normal.dot(shift) }
    };
    let mut planes: Vec<HalfSpace> = shape.iter().map(placed).collect();
    let first = planes.len();
    let count = 12 + random.below(29);
    // From one ulp to 1e-12, relative.
    let share = 10.0_f64.powf(-12.0 - 4.0 * random.unit());
    let noise = [0.0, share, share, share, share][(seed % 5) as usize];
    while planes.len() < count.max(first + 1) {
        let HalfSpace { normal, offset } = planes[random.below(first)];
        let longer = if random.below(3) == 0 { 3.0 } else { 1.0 };
        let moved = normal.to_array().map(|n| longer * nudged(n, noise, &mut random));
        let offset = longer * nudged(offset, noise * size, &mut random);
        planes.push(HalfSpace { normal: DVec3::from_array(moved), offset });
    }
    planes
}

#[test]
fn no_vertex_lies_farther_than_the_bound_from_its_planes() {
    let asked = std::env::var("KERFOLD_SETS").ok().and_then(|sets| sets.parse().ok());
    for seed in 0..asked.unwrap_or(SETS) {
        let planes = set(seed);
        // Numbers taken as given: one rounding bound. Joined vertices: four.
        for (numbers, bounds) in [(Numbers::Given, 1.0), (Numbers::Constructed, 4.0)] {
            let options = Intersect { numbers, ..Intersect::default() };
            let what = format!("set {seed}, {numbers:?}");
            match intersect_verified(&planes, &options, &|| true) {
                Ok(polytope) => assert_right(&polytope, &planes, bounds, &what),
                Err(error) => panic!("{what}: {error}"),
            }
        }
    }
}

#[test]
fn a_large_set_given_twice_is_right_too() {
    let mut random = Rng::new(11);
    let first: Vec<HalfSpace> =
        (0..5000).map(|_| HalfSpace { normal: random.on_sphere(), offset: 1.0 }).collect();
    let mut planes = first.clone();
    for h in &first {
        let normal = h.normal.to_array().map(|n| nudged(n, 1e-13, &mut random));
        planes.push(HalfSpace { normal: DVec3::from_array(normal), ..*h });
    }
    for form in [Form::Merged, Form::Simple] {
        let options = Intersect { form, ..Intersect::default() };
        let ball = intersect_verified(&planes, &options, &|| true);
        let ball = ball.unwrap_or_else(|error| panic!("{form:?}: {error}"));
        assert!(ball.faces.len() > 5000, "{form:?}: {} faces", ball.faces.len());
    }
}

#[test]
fn the_exact_arithmetic_sees_what_doubles_do_not() {
    let h = HalfSpace { normal: DVec3::new(0.1, 0.2, 0.3), offset: 0.6 };
    // 0.1 + 0.2 + 0.3 as doubles is not 0.6, but rounds to a neighbour.
    let sum = height(&h, DVec3::ONE);
    let quarter_ulp = Dyadic { m: BigInt::from(1), e: -55 };
    assert!(sum.is_above(&Dyadic::of(0.0)) && !sum.is_above(&quarter_ulp.times(&Dyadic::of(4.0))));
    assert!(is_off(&h, DVec3::ONE * 1.001, 1e-6, false));
    assert!(!is_off(&h, DVec3::ONE * 0.999, 1e-6, false));
    assert!(is_off(&h, DVec3::ONE * 0.999, 1e-6, true));
}
