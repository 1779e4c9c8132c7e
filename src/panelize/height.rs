//! Surfaces given as heights over a rectangle.

use std::fmt;
use std::str::FromStr;

use glam::DVec3;
use serde::{Deserialize, Deserializer, de};

use super::PanelizeError;
use super::formula::Formula;
use crate::mesh::Mesh;
use crate::units::Length;

/// Steps of the mesh along the longer side of the rectangle.
const STEPS: f64 = 160.0;

/// The size of a rectangle, and the unit in which it was given.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Domain {
    /// Width and depth in mm.
    pub size_mm: [f64; 2],
    /// The unit of the first number, in mm.
    pub unit_mm: f64,
}

impl FromStr for Domain {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is not like 22mx18m");
        let (width, depth) = text.split_once('x').ok_or_else(wrong)?;
        let length = |part: &str| part.trim().parse::<Length>().map_err(|e| e.to_string());
        let after_number = width.trim().rsplit(|c: char| c.is_ascii_digit() || c == '.').next();
        let unit = after_number.unwrap_or_default();
        let unit_mm = length(&format!("1{unit}"))?.mm();
        let size_mm = [length(width)?.mm(), length(depth)?.mm()];
        let ratio = size_mm[0] / size_mm[1];
        if size_mm.iter().any(|s| !(*s > 0.0 && s.is_finite())) || !(0.01..=100.0).contains(&ratio)
        {
            return Err(wrong());
        }
        Ok(Self { size_mm, unit_mm })
    }
}

impl fmt::Display for Domain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}mmx{}mm", self.size_mm[0], self.size_mm[1])
    }
}

impl<'de> Deserialize<'de> for Domain {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

/// A height field by a formula. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct HeightParams {
    /// The height z as a formula in x and y, which run from the middle of the rectangle, all three
    /// in the unit of the rectangle's width: `2*sin(x/3) + cos(y/2)`.
    #[arg(long, value_name = "FORMULA")]
    pub height: String,
    /// The rectangle: 22mx18m.
    #[arg(long, value_name = "WIDTHxDEPTH")]
    pub domain: Domain,
}

/// The mesh of a height field: triangles in staggered rows, 160 of them along the longer side.
///
/// # Errors
/// [`PanelizeError::Formula`] for a formula that cannot be read, [`PanelizeError::NoHeight`] where
/// it has no value.
pub fn height_field(params: &HeightParams) -> Result<Mesh, PanelizeError> {
    let formula = Formula::read(&params.height)?;
    let Domain { size_mm: [width, depth], unit_mm } = params.domain;
    let step = width.max(depth) / STEPS;
    let columns = (width / step).ceil().max(2.0) as usize;
    let rows = (depth / (step * 0.75_f64.sqrt())).ceil().max(2.0) as usize;
    let mut points = Vec::with_capacity((columns + 2) * (rows + 1));
    let mut starts = Vec::with_capacity(rows + 2);
    for j in 0..=rows {
        starts.push(points.len());
        let y = depth * (j as f64 / rows as f64 - 0.5);
        for share in row_shares(j, columns) {
            let x = width * (share - 0.5);
            let z = formula.at(x / unit_mm, y / unit_mm) * unit_mm;
            if !z.is_finite() {
                let [x, y] = [x / unit_mm, y / unit_mm];
                return Err(PanelizeError::NoHeight { text: params.height.clone(), x, y });
            }
            points.push(DVec3::new(x, y, z));
        }
    }
    starts.push(points.len());
    let faces = (0..rows)
        .flat_map(|j| band(&points, starts[j]..starts[j + 1], starts[j + 1]..starts[j + 2]));
    let faces: Vec<[usize; 3]> = faces.collect();
    let place = DVec3::ZERO;
    Mesh::from_faces(points, faces).map_err(|_| PanelizeError::NoMesh { place })
}

/// Where the points of a row stand along it; odd rows are staggered by half a step.
fn row_shares(row: usize, columns: usize) -> Vec<f64> {
    let count = columns as f64;
    if row.is_multiple_of(2) {
        return (0..=columns).map(|i| i as f64 / count).collect();
    }
    let inner = (0..columns).map(|i| (i as f64 + 0.5) / count);
    std::iter::once(0.0).chain(inner).chain([1.0]).collect()
}

/// The triangles between two rows.
fn band(
    points: &[DVec3],
    low: std::ops::Range<usize>,
    high: std::ops::Range<usize>,
) -> Vec<[usize; 3]> {
    let (mut i, mut k) = (low.start, high.start);
    let mut faces = Vec::with_capacity(low.len() + high.len());
    while i + 1 < low.end || k + 1 < high.end {
        let climbs = i + 1 >= low.end || k + 1 < high.end && points[k + 1].x < points[i + 1].x;
        if climbs {
            faces.push([i, k + 1, k]);
            k += 1;
        } else {
            faces.push([i, i + 1, k]);
            i += 1;
        }
    }
    faces
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::assert_sound;

    fn field(height: &str, domain: &str) -> Result<Mesh, PanelizeError> {
        let domain = domain.parse().expect("a domain");
        height_field(&HeightParams { height: height.to_owned(), domain })
    }

    #[test]
    fn heights_are_in_the_unit_of_the_rectangle() {
        let mesh = field("x*y/10 + 1", "8mx6m").expect("a hypar");
        assert_sound(&mesh);
        let (low, high) = mesh.bounds().expect("points");
        assert_eq!((low.x, high.x, low.y, high.y), (-4000.0, 4000.0, -3000.0, 3000.0));
        assert!((low.z - -200.0).abs() < 1e-9 && (high.z - 2200.0).abs() < 1e-9);
        assert!((crate::measure::surface_area(&mesh) / 48e6 - 1.0).abs() < 0.2);
    }

    #[test]
    fn the_unit_of_the_formula_is_that_of_the_width() {
        for (text, unit, width) in [
            ("22mx18m", 1000.0, 22_000.0),
            ("2e1mx18m", 1000.0, 20_000.0),
            ("22e3x18e3", 1.0, 22_000.0),
            ("24\"x18\"", 25.4, 24.0 * 25.4),
        ] {
            let domain: Domain = text.parse().expect(text);
            assert_eq!((domain.unit_mm, domain.size_mm[0]), (unit, width), "{text}");
        }
    }

    #[test]
    fn what_has_no_height_or_no_size_is_refused() {
        let error = field("sqrt(x)", "8x6").expect_err("no root");
        assert!(matches!(error, PanelizeError::NoHeight { x, .. } if x < 0.0), "{error}");
        for text in ["", "8", "8x0", "8mx-2m", "1x1000", "8mx6parsec"] {
            assert!(text.parse::<Domain>().is_err(), "{text}");
        }
    }
}
