//! Surfaces given as heights over a rectangle, or over the area of a drawing.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3, I64Vec2};
use serde::Deserialize;

use super::PanelizeError;
use super::domain::Domain;
use super::formula::Formula;
use super::refine::Triangles;
use crate::geom::polygon::{Location, locate};
use crate::geom::{nearest_on_segment, triangulate_region, triangulate_region_through};
use crate::mesh::Mesh;

/// Steps along the longer side unless said otherwise.
const STEPS: u32 = 160;
/// A drawn curve becomes chords that leave it by at most that part of a step.
const CHORD: f64 = 0.01;
/// Inner points stay so far from those on a line, in steps.
const CLEARANCE: f64 = 0.6;
/// Drawings with more corners, all their lines together, are refused.
const MOST_POINTS: usize = 20_000;

/// A height field by a formula. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct HeightParams {
    /// The height z as a formula in x and y, which run from the middle of the domain, all three
    /// in the unit of the domain: `2*sin(x/3) + cos(y/2)`.
    #[arg(long, value_name = "FORMULA")]
    pub height: String,
    /// The rectangle, 22mx18m, an outline by name, circle@22m, or the closed lines of a drawing: SVG,
    /// DXF or PDF, or a list of points (.csv, x,y on each line, an empty line between outlines).
    /// Lines inside others are holes. outline.svg@22m is 22 m in its largest extent, and the formula
    /// is in m; points.csv@m has points and formula in m. Without, both are in mm.
    #[arg(long, value_name = "WIDTHxDEPTH|OUTLINE")]
    pub domain: Domain,
    /// Steps of the mesh along the longer side of the domain, 10 to 1000. Eight for each panel are
    /// enough, and fewer take less time.
    #[arg(long, value_name = "N", default_value_t = STEPS)]
    #[serde(default = "default_steps")]
    pub steps: u32,
}

fn default_steps() -> u32 {
    STEPS
}

impl HeightParams {
    /// A formula over a domain with the usual steps.
    pub fn new(height: &str, domain: Domain) -> Self {
        Self { height: height.to_owned(), domain, steps: STEPS }
    }
}

/// The mesh of a height field, of triangles of about one size.
///
/// # Errors
/// [`PanelizeError::Formula`] for a formula that cannot be read, [`PanelizeError::NoHeight`] where
/// it has no value, [`PanelizeError::BadDomain`] for lines that bound no area, and for a drawing
/// that was not read.
pub fn height_field(params: &HeightParams) -> Result<Mesh, PanelizeError> {
    let formula = Formula::read(&params.height)?;
    let steps = f64::from(params.steps);
    if !(10.0..=1000.0).contains(&steps) {
        let name = "the number of steps";
        return Err(PanelizeError::OutOfRange { name, value: steps, low: 10.0, high: 1000.0 });
    }
    let Triangles { mut points, corners, .. } = match &params.domain {
        Domain::Rectangle { size_mm, .. } => over_rectangle(*size_mm, steps),
        Domain::Contours { contours, .. } => over_contours(contours, steps)?,
        Domain::Drawing { .. } => {
            let what = "it is still the name of a file, which has to be read first".to_owned();
            return Err(PanelizeError::BadDomain { what });
        }
    };
    let unit_mm = params.domain.unit_mm();
    for p in &mut points {
        p.z = formula.at(p.x / unit_mm, p.y / unit_mm) * unit_mm;
        if !p.z.is_finite() {
            let [x, y] = [p.x / unit_mm, p.y / unit_mm];
            return Err(PanelizeError::NoHeight { text: params.height.clone(), x, y });
        }
    }
    let place = DVec3::ZERO;
    Mesh::from_faces(points, corners).map_err(|_| PanelizeError::NoMesh { place })
}

/// Triangles in staggered rows.
fn over_rectangle([width, depth]: [f64; 2], steps: f64) -> Triangles {
    let step = width.max(depth) / steps;
    let columns = (width / step).ceil().max(2.0) as usize;
    let rows = (depth / (step * 0.75_f64.sqrt())).ceil().max(2.0) as usize;
    let mut points = Vec::with_capacity((columns + 2) * (rows + 1));
    let mut starts = Vec::with_capacity(rows + 2);
    for j in 0..=rows {
        starts.push(points.len());
        let y = depth * (j as f64 / rows as f64 - 0.5);
        let shares = row_shares(j, columns).into_iter();
        points.extend(shares.map(|share| DVec3::new(width * (share - 0.5), y, 0.0)));
    }
    starts.push(points.len());
    let corners = (0..rows)
        .flat_map(|j| band(&points, starts[j]..starts[j + 1], starts[j + 1]..starts[j + 2]))
        .collect();
    Triangles { points, corners, ..Triangles::default() }
}

/// Triangles of about one size between closed lines: points along them, and a lattice inside.
fn over_contours(contours: &[Vec<DVec2>], steps: f64) -> Result<Triangles, PanelizeError> {
    let bad = |what: &str| PanelizeError::BadDomain { what: what.to_owned() };
    let all = || contours.iter().flatten().copied();
    let low = all().reduce(DVec2::min).unwrap_or_default();
    let high = all().reduce(DVec2::max).unwrap_or_default();
    let extent = (high - low).max_element();
    if !(extent > 0.0 && extent.is_finite()) {
        return Err(bad("there is no closed line"));
    }
    let step = extent / steps;
    let chords: Vec<Vec<DVec2>> = contours.iter().map(|c| chords(c, CHORD * step)).collect();
    if chords.iter().map(Vec::len).sum::<usize>() > MOST_POINTS {
        return Err(bad("its lines have too many corners; draw it with fewer"));
    }
    let lines: Vec<Vec<DVec2>> = chords.iter().map(|line| stepped(line, step)).collect();
    let lines: Vec<&[DVec2]> = lines.iter().map(Vec::as_slice).collect();
    // Points on the sides could hide that these cross.
    let whole: Vec<&[DVec2]> = chords.iter().map(Vec::as_slice).collect();
    triangulate_region(&whole).ok_or_else(|| bad("its lines cross, or bound no area"))?;
    let inner = lattice_inside(&chords, &lines, (low, high), step);
    let (points, corners) = triangulate_region_through(&lines, &inner)
        .ok_or_else(|| bad("its lines cross, or bound no area"))?;
    let points = points.into_iter().map(|p| p.extend(0.0)).collect();
    Ok(Triangles { points, corners, ..Triangles::default() })
}

/// A closed line with points on its sides so that none is much longer than a step.
fn stepped(line: &[DVec2], step: f64) -> Vec<DVec2> {
    let next = line.iter().cycle().skip(1);
    let sides = line.iter().zip(next);
    sides
        .flat_map(|(&a, &b)| {
            let count = (a.distance(b) / step).round().max(1.0) as usize;
            (0..count).map(move |i| a.lerp(b, i as f64 / count as f64))
        })
        .collect()
}

/// The points of a triangular lattice inside an odd number of closed lines, none too near to a
/// point on them.
fn lattice_inside(
    chords: &[Vec<DVec2>],
    lines: &[&[DVec2]],
    (low, high): (DVec2, DVec2),
    step: f64,
) -> Vec<DVec2> {
    let cell = |p: DVec2| ((p - low) / step).floor().as_i64vec2();
    let mut near: BTreeMap<[i64; 2], Vec<DVec2>> = BTreeMap::new();
    for &p in lines.iter().copied().flatten() {
        near.entry(cell(p).to_array()).or_default().push(p);
    }
    let is_apart = |p: DVec2| {
        let around = (-1..=1).flat_map(|i| (-1..=1).map(move |j| I64Vec2::new(i, j)));
        let mut beside = around.filter_map(|by| near.get(&(cell(p) + by).to_array())).flatten();
        beside.all(|q| q.distance(p) > CLEARANCE * step)
    };
    let is_inside =
        |p: DVec2| chords.iter().filter(|c| locate(c, p) == Location::Inside).count() % 2 == 1;
    let height = step * 0.75_f64.sqrt();
    let [columns, rows] = ((high - low) / DVec2::new(step, height)).ceil().to_array();
    let place = |i: usize, j: usize| {
        low + DVec2::new((i as f64 + 0.5 * (j % 2) as f64) * step, j as f64 * height)
    };
    (0..=rows as usize)
        .flat_map(|j| (0..=columns as usize).map(move |i| place(i, j)))
        .filter(|&p| is_apart(p) && is_inside(p))
        .collect()
}

/// A closed line with fewer points, none of those left out farther off than `near` (Ramer 1972;
/// Douglas, Peucker 1973).
fn chords(line: &[DVec2], near: f64) -> Vec<DVec2> {
    let count = line.len();
    let way = |&i: &usize| line[i].distance_squared(line[0]);
    let Some(far) = (1..count).max_by(|a, b| way(a).total_cmp(&way(b))) else {
        return line.to_vec();
    };
    let at = |i: usize| line[i % count].extend(0.0);
    let mut stays = vec![false; count];
    (stays[0], stays[far]) = (true, true);
    let mut open = vec![(0, far), (far, count)];
    while let Some((a, b)) = open.pop() {
        let off = |i: usize| at(i).distance(nearest_on_segment(at(i), [at(a), at(b)]));
        let worst = (a + 1..b).max_by(|&i, &j| off(i).total_cmp(&off(j)));
        if let Some(worst) = worst.filter(|&i| off(i) > near) {
            stays[worst] = true;
            open.extend([(a, worst), (worst, b)]);
        }
    }
    (0..count).filter(|&i| stays[i]).map(|i| line[i]).collect()
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
    use std::f64::consts::TAU;

    use super::*;
    use crate::mesh::assert_sound;

    fn field(height: &str, domain: &str) -> Result<Mesh, PanelizeError> {
        let domain = domain.parse().expect("a domain");
        height_field(&HeightParams::new(height, domain))
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

    /// The roof of a courtyard: a circle of 12 m with a square eye of 3 m.
    fn courtyard(height: &str) -> Result<Mesh, PanelizeError> {
        let circle = (0..2000).map(|i| DVec2::from_angle(f64::from(i) * TAU / 2000.0) * 6000.0);
        let eye = [(-1.0, -1.0), (2.0, -1.0), (2.0, 2.0), (-1.0, 2.0)];
        let eye = eye.map(|(x, y)| DVec2::new(x, y) * 1000.0).to_vec();
        let domain = Domain::Contours { contours: vec![circle.collect(), eye], unit_mm: 1000.0 };
        height_field(&HeightParams::new(height, domain))
    }

    #[test]
    fn a_drawn_area_with_a_hole_becomes_triangles_of_about_one_size() {
        let mesh = courtyard("1 + x/4").expect("a roof");
        assert_sound(&mesh);
        let area = crate::measure::surface_area(&mesh) / (17.0_f64 / 16.0).sqrt();
        let wanted = (36.0 * std::f64::consts::PI - 9.0) * 1e6;
        assert!((area / wanted - 1.0).abs() < 1e-3, "{area} instead of {wanted}");
        let longest = mesh.edges().map(|e| mesh.edge_positions(e)).map(|[a, b]| a.distance(b));
        // No place is farther than 1/√3 steps from a point of the lattice, and one that was left out
        // has a point of a line near by: so large are empty circles. The roof slopes by 1 in 4.
        let bound = 2.0 * (1.0 / 3.0_f64.sqrt() + CLEARANCE) * (17.0_f64 / 16.0).sqrt();
        let longest = longest.fold(0.0, f64::max) / (12_000.0 / f64::from(STEPS));
        assert!(longest <= bound, "{longest} of {bound} steps");
        let expected = wanted / (12_000.0 / f64::from(STEPS)).powi(2) / 0.75_f64.sqrt();
        let count = mesh.vertex_count() as f64 / expected;
        assert!((0.95..1.1).contains(&count), "{count} of the points that the area holds");
        let mut sharpest = f64::INFINITY;
        for f in mesh.faces() {
            let corners = mesh.face_positions(f);
            let [a, b, c] = [0, 1, 2].map(|i| corners[i]);
            let sides = [a.distance(b), b.distance(c), c.distance(a)];
            let doubled = (b - a).cross(c - a).length();
            sharpest = sharpest.min(doubled / sides.into_iter().fold(0.0, f64::max).powi(2));
        }
        assert!(sharpest > 0.1, "a needle of {sharpest}");
        for v in mesh.vertices() {
            let p = mesh.position(v);
            assert!((p.z - 1000.0 - p.x / 4.0).abs() < 1e-9);
        }
    }

    #[test]
    fn lines_that_bound_nothing_are_refused() {
        let bow = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(DVec2::from).to_vec();
        for contours in [vec![], vec![bow], vec![vec![DVec2::ZERO, DVec2::X]]] {
            let domain = Domain::Contours { contours, unit_mm: 1.0 };
            let error = height_field(&HeightParams::new("0", domain));
            let error = error.expect_err("no area");
            assert!(matches!(error, PanelizeError::BadDomain { .. }), "{error}");
        }
    }

    #[test]
    fn what_has_no_height_is_refused() {
        let error = field("sqrt(x)", "8x6").expect_err("no root");
        assert!(matches!(error, PanelizeError::NoHeight { x, .. } if x < 0.0), "{error}");
        let error = courtyard("ln(x)").map(|_| ()).expect_err("no logarithm");
        assert!(matches!(error, PanelizeError::NoHeight { .. }), "{error}");
        assert!(courtyard("sqrt(36.0001-x^2-y^2)").is_ok());
        let domain = "8mx6m".parse().expect("a rectangle");
        let coarse = HeightParams { steps: 10, ..HeightParams::new("0", domain) };
        assert!(height_field(&coarse).expect("a plane").vertex_count() < 120);
        let error = height_field(&HeightParams { steps: 9, ..coarse }).map(|_| ());
        assert!(matches!(error, Err(PanelizeError::OutOfRange { .. })), "{error:?}");
    }
}
