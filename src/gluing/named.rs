//! Outlines by name. All begin on an axis of symmetry, at the right, and run counter-clockwise.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

use super::{GluingError, Outline};
use crate::units::nearest_word;

/// Points of a smooth outline: fine enough that no chord of a seam sees them.
const FINE: usize = 1 << 14;
/// The largest extent of a named outline, in mm.
const EXTENT: f64 = 100.0;
const KINDS: [&str; 10] = [
    "circle",
    "ellipse",
    "superellipse",
    "rounded-rectangle",
    "rectangle",
    "lens",
    "regular",
    "trefoil",
    "peanut",
    "egg",
];

/// An outline by its name, 100 mm in its largest extent.
///
/// `circle`; `ellipse-2x1`; `superellipse-2x1-4` (with the exponent, 1.2 to 20);
/// `rounded-rectangle-2x1-0.3` (with the radius as a part of half the short side, above 0 to 1);
/// `rectangle-2x1`, from the lower left corner; `lens-0.5` (two arcs with so much width for its
/// length, above 0 to 1, from the right tip); `regular-7` (corners, 3 to 200); `trefoil-0.25` and
/// `peanut-0.25` (three and two lobes of so much, above 0 to 0.45); `egg-0.2` (how much thinner one
/// end is, above 0 to 0.35).
///
/// # Errors
/// [`GluingError::UnknownName`], [`GluingError::NameNumbers`].
pub fn named_outline(name: &str) -> Result<Outline, GluingError> {
    let kind = KINDS
        .into_iter()
        .filter(|kind| {
            name.strip_prefix(kind).is_some_and(|rest| rest.is_empty() || rest.starts_with('-'))
        })
        .max_by_key(|kind| kind.len());
    let Some(kind) = kind else {
        let word = name.split(|c: char| c.is_ascii_digit()).next().unwrap_or_default();
        let nearest = nearest_word(word.trim_end_matches('-'), KINDS).map(ToOwned::to_owned);
        return Err(GluingError::UnknownName { name: name.to_owned(), nearest });
    };
    let numbers = Numbers { name, rest: name[kind.len()..].trim_start_matches('-') };
    match kind {
        "circle" => {
            numbers.count(0, "circle")?;
            smooth(name, DVec2::from_angle)
        }
        "ellipse" => {
            let [a, b] = numbers.sides(1, "ellipse-2x1")?.0;
            smooth(name, |t| DVec2::new(a * t.cos(), b * t.sin()))
        }
        "superellipse" => {
            let ([a, b], e) = numbers.sides(2, "superellipse-2x1-4")?;
            let e = numbers.within(e, 1.2, 20.0, "the exponent")?;
            smooth(name, |t| superellipse(t, [a, b], e))
        }
        "rounded-rectangle" => {
            let ([a, b], r) = numbers.sides(2, "rounded-rectangle-2x1-0.3")?;
            let r = numbers.within(r, 1e-3, 1.0, "the radius")?;
            rounded_rectangle(name, [a, b], r * a.min(b))
        }
        "rectangle" => {
            let [a, b] = numbers.sides(1, "rectangle-2x1")?.0;
            let corners = [(0.0, 0.0), (a, 0.0), (a, b), (0.0, b)];
            sized(name, &corners.map(|(x, y)| DVec2::new(x, y)), 0.5)
        }
        "lens" => {
            let width = numbers.one("lens-0.5")?;
            let width = numbers.within(width, 0.01, 1.0, "the width")?;
            lens(name, width)
        }
        "regular" => {
            let sides = numbers.one("regular-7")?;
            let sides = numbers.within(sides, 3.0, 200.0, "the number of corners")?;
            regular(name, sides, &numbers)
        }
        "trefoil" | "peanut" => {
            let depth = numbers.one(&format!("{kind}-0.25"))?;
            let depth = numbers.within(depth, 1e-3, 0.45, "the depth")?;
            let lobes = if kind == "trefoil" { 3.0 } else { 2.0 };
            smooth(name, |t| DVec2::from_angle(t) * (1.0 + depth * (lobes * t).cos()))
        }
        _ => {
            let thin = numbers.one("egg-0.2")?;
            let thin = numbers.within(thin, 1e-3, 0.35, "the thinness")?;
            smooth(name, |t| DVec2::new(1.3 * t.cos(), t.sin() * (1.0 - thin * t.cos())))
        }
    }
}

struct Numbers<'a> {
    name: &'a str,
    rest: &'a str,
}

impl Numbers<'_> {
    fn fault<T>(&self, fault: String) -> Result<T, GluingError> {
        Err(GluingError::NameNumbers { name: self.name.to_owned(), fault })
    }

    fn parts(&self) -> Vec<&str> {
        if self.rest.is_empty() { Vec::new() } else { self.rest.split('-').collect() }
    }

    fn count(&self, wanted: usize, example: &str) -> Result<(), GluingError> {
        if self.parts().len() == wanted {
            return Ok(());
        }
        self.fault(format!("write it like {example}"))
    }

    fn number(&self, text: &str, example: &str) -> Result<f64, GluingError> {
        match text.parse::<f64>() {
            Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
            _ => self.fault(format!("`{text}` is no number above 0; write it like {example}")),
        }
    }

    fn one(&self, example: &str) -> Result<f64, GluingError> {
        self.count(1, example)?;
        self.number(self.rest, example)
    }

    /// Two sides as `2x1`, and the number after them.
    fn sides(&self, parts: usize, example: &str) -> Result<([f64; 2], f64), GluingError> {
        self.count(parts, example)?;
        let parts = self.parts();
        let Some((a, b)) = parts[0].split_once('x') else {
            return self
                .fault(format!("its sides are two numbers with x; write it like {example}"));
        };
        let (a, b) = (self.number(a, example)?, self.number(b, example)?);
        let ratio = self.within(a / b, 1.0 / 50.0, 50.0, "the ratio of the sides")?;
        let last = parts.get(1).map_or(Ok(0.0), |text| self.number(text, example))?;
        Ok(([ratio, 1.0], last))
    }

    fn within(&self, x: f64, low: f64, high: f64, what: &str) -> Result<f64, GluingError> {
        if (low..=high).contains(&x) {
            return Ok(x);
        }
        self.fault(format!("{what} is {x}; take {low} to {high}"))
    }
}

fn smooth(name: &str, at: impl Fn(f64) -> DVec2) -> Result<Outline, GluingError> {
    let points: Vec<DVec2> = (0..FINE).map(|i| at(TAU * i as f64 / FINE as f64)).collect();
    sized(name, &points, 0.5)
}

/// By the direction seen from its middle, so that no stretch of the rim gets few points.
fn superellipse(t: f64, [a, b]: [f64; 2], e: f64) -> DVec2 {
    let d = DVec2::new(a * t.cos(), b * t.sin());
    d / ((d.x / a).abs().powf(e) + (d.y / b).abs().powf(e)).powf(1.0 / e)
}

fn rounded_rectangle(name: &str, [a, b]: [f64; 2], r: f64) -> Result<Outline, GluingError> {
    let mut points = vec![DVec2::new(a, 0.0)];
    let quarters = [(a - r, b - r), (r - a, b - r), (r - a, r - b), (a - r, r - b)];
    for (i, &(x, y)) in quarters.iter().enumerate() {
        let steps = FINE / 4;
        points.extend((0..=steps).map(|k| {
            let t = PI / 2.0 * (i as f64 + k as f64 / steps as f64);
            DVec2::new(x, y) + r * DVec2::from_angle(t)
        }));
    }
    sized(name, &points, 0.5)
}

fn lens(name: &str, width: f64) -> Result<Outline, GluingError> {
    // Half the angle of an arc over the length 2 with so much rise.
    let half = 2.0 * width.atan();
    let (radius, steps) = (1.0 / half.sin(), FINE / 2);
    let arc: Vec<DVec2> = (0..steps)
        .map(|k| {
            let t = half * (1.0 - 2.0 * k as f64 / steps as f64);
            radius * DVec2::new(t.sin(), t.cos() - half.cos())
        })
        .collect();
    let points: Vec<DVec2> = arc.iter().copied().chain(arc.iter().map(|&p| -p)).collect();
    sized(name, &points, 0.1)
}

fn regular(name: &str, sides: f64, numbers: &Numbers) -> Result<Outline, GluingError> {
    if sides.fract() != 0.0 {
        return numbers.fault("the number of corners is no whole number".to_owned());
    }
    let points: Vec<DVec2> =
        (0..sides as usize).map(|i| DVec2::from_angle(TAU * i as f64 / sides)).collect();
    sized(name, &points, 1e-6)
}

fn sized(name: &str, points: &[DVec2], corner: f64) -> Result<Outline, GluingError> {
    let outline = Outline::with_corners(name, points, corner)?;
    Ok(outline.scaled(EXTENT / outline.size().max_element()))
}
