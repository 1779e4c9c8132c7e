//! Panels of freeform surfaces, against the bars: `cargo bench --bench panelize [NAME…]`.
//!
//! Surfaces by formula, each with three sizes and five seeds. A run is kept when every panel is
//! simple, planar and goes through no other, nodes have three members, and deviation, edges,
//! angles, areas, nodes and count are within the bars; 95 of 100 runs are to be. Then mirrored pairs
//! (`mirrored`) and families of lengths (`families`). Then other ways to
//! the same (`baselines`): triangles, quads made planar, and the dual of a triangulation made
//! planar, with cells as large as the panels. Then the CPU seconds and the memory for 500, 1 000 and
//! 5 000 panels. With `--figures DIR` instead the models there at 60 and 200 panels, and their nets.
//! No peer is known that proves planes, so none is compared.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use std::f64::consts::TAU;

use clock::{peak_megabytes, process_seconds};
use glam::{DVec2, DVec3};
use kerfold::geom::polygon::segments_meet;
use kerfold::geom::{Frame, Plane};
use kerfold::io::{ReadOptions, read_mesh};
use kerfold::measure::{crossings, planarity};
use kerfold::mesh::{FaceId, Mesh};
use kerfold::op::{OpContext, PlanarizeParams, planarize};
use kerfold::panelize::{
    HeightParams, MirrorReport, PanelizeFinding, PanelizeParams, PanelizeReport, RimChoice,
    height_field, panelize,
};
use kerfold::progress::Silent;
use kerfold::unfold::{MeshSource, Seams, UnfoldParams, unfold};
use kerfold::units::Length;

/// Height fields: name, formula, rectangle, panel size in mm.
const FIELDS: &[(&str, &str, &str, f64)] = &[
    ("paraboloid", "4-x^2/18-y^2/12", "14mx10m", 1000.0),
    ("hypar", "x*y/9", "12mx12m", 1000.0),
    ("saddle", "x^2/12-y^2/16", "12mx10m", 1000.0),
    ("waves", "1.1*sin(2*pi*x/14+0.4)+0.9*cos(2*pi*y/12)", "22mx18m", 1200.0),
    ("vault", "3.5-x^2/12-y^2/400", "12mx16m", 1000.0),
    ("bump", "2.2*exp(-(x^2+y^2)/9)", "16mx14m", 1000.0),
    ("monkey", "(x^3-3*x*y^2)/110", "10mx10m", 900.0),
    ("shallow", "0.6*(1-(x^2+y^2)/81)", "14mx14m", 1200.0),
];

/// Panels and the CPU seconds that they may take.
const SPEED: &[(u32, f64)] = &[(500, 10.0), (1000, 25.0), (5000, 180.0)];

/// A name, the radius in m at a height, the lowest and highest height, and the size of panels in mm.
type Band = (&'static str, fn(f64) -> f64, [f64; 2], f64);

fn main() {
    let all: Vec<String> = std::env::args().skip(1).collect();
    if let Some(at) = all.iter().position(|a| a == "--figures") {
        return figures(all.get(at + 1).expect("a folder of models"));
    }
    let named: Vec<String> = all.into_iter().filter(|a| !a.starts_with('-')).collect();
    let is_meant = |name: &str| named.is_empty() || named.iter().any(|n| n == name);
    let (mut kept, mut runs) = (0, 0);
    for &(name, formula, domain, size) in FIELDS {
        if is_meant(name) {
            series(name, &field(formula, domain), size, &RimChoice::Walls, (&mut kept, &mut runs));
        }
    }
    let bands: [Band; 2] = [
        ("tower", |z| 4.5 * (1.0 + z * z / 36.0).sqrt(), [-6.0, 8.0], 1200.0),
        ("catenoid", |z| 3.0 * (z / 3.0).cosh(), [-4.0, 4.0], 1000.0),
    ];
    for (name, radius, ends, size) in bands {
        if is_meant(name) {
            let planes = ends.map(|z| format!("z={z}m")).join(",");
            let rim = format!("plane:{planes}").parse().expect("planes");
            series(name, &band(radius, ends), size, &rim, (&mut kept, &mut runs));
        }
    }
    if runs > 0 {
        println!("{kept} of {runs} runs kept; bar 95 of 100");
    }
    if is_meant("mirrored") {
        mirrored();
    }
    if is_meant("families") {
        families();
    }
    if is_meant("baselines") {
        baselines();
    }
    if is_meant("speed") {
        speed();
    }
}

fn field(formula: &str, domain: &str) -> Mesh {
    let domain = domain.parse().expect("a rectangle");
    height_field(&HeightParams::new(formula, domain)).expect("a height field")
}

/// A surface of revolution about z, in metres, as a mesh in mm.
fn band(radius: fn(f64) -> f64, [low, high]: [f64; 2]) -> Mesh {
    let (rows, columns) = (90, 220);
    let point = |k: usize| {
        let (j, i) = (k / columns, k % columns);
        let z = low + (high - low) * j as f64 / (rows - 1) as f64;
        let angle = TAU * (i as f64 + 0.5 * (j % 2) as f64) / columns as f64;
        1000.0 * DVec3::new(radius(z) * angle.cos(), radius(z) * angle.sin(), z)
    };
    let cells = (0..rows - 1).flat_map(|j| (0..columns).map(move |i| (j, i)));
    let faces = cells.flat_map(|(j, i)| {
        let at = |j: usize, i: usize| j * columns + i % columns;
        let [a, b, c, d] = [at(j, i), at(j, i + 1), at(j + 1, i), at(j + 1, i + 1)];
        if j % 2 == 0 { [[a, b, c], [b, d, c]] } else { [[a, b, d], [a, d, c]] }
    });
    let faces: Vec<[usize; 3]> = faces.collect();
    Mesh::from_faces((0..rows * columns).map(point), faces).expect("a band")
}

/// Three sizes, five seeds each.
fn series(
    name: &str,
    mesh: &Mesh,
    size: f64,
    rim: &RimChoice,
    (kept, runs): (&mut usize, &mut usize),
) {
    for factor in [0.85, 1.0, 1.15] {
        for seed in 1..=5 {
            let start = process_seconds();
            let params = PanelizeParams {
                size: Some(Length::from_mm(size * factor)),
                rim: rim.clone(),
                seed,
                ..PanelizeParams::default()
            };
            *runs += 1;
            let (made, report) = match panelize(mesh, &params, &Silent) {
                Ok(made) => made,
                Err(error) => {
                    println!("{name} × {factor}, seed {seed}: MISSED: {error}");
                    continue;
                }
            };
            let missed = missed(&made, &report);
            *kept += usize::from(missed.is_empty());
            let verdict =
                if missed.is_empty() { "kept".into() } else { format!("MISSED {missed:?}") };
            let l = report.size_mm;
            println!(
                "{name} × {factor}, seed {seed}: {} panels, deviation {:.3} and {:.3} L, sag \
                {:.3} L, shortest {:.3} L, angles {:.0} to {:.0}°, areas {:.2} to {:.2}, reach \
                {:.3}, {} concave; {:.1} CPU s; {verdict}",
                report.panels,
                report.deviation_mm[0] / l,
                report.deviation_mm[1] / l,
                report.sag_mm / l,
                report.shortest_mm / l,
                report.angles[0],
                report.angles[1],
                report.areas[0],
                report.areas[1],
                report.node_reach,
                report.concave,
                process_seconds() - start,
            );
        }
    }
}

/// The bars that a run misses.
fn missed(made: &Mesh, report: &PanelizeReport) -> Vec<&'static str> {
    let l = report.size_mm;
    let [most, usual] = report.deviation_mm.map(|d| d / l);
    let sag = report.sag_mm / l;
    let is_broken = report.findings.iter().any(|place| {
        matches!(place.finding, PanelizeFinding::Crosses | PanelizeFinding::GoesThrough)
    });
    let short = made.edges().map(|e| made.edge_positions(e));
    let short = short.filter(|[a, b]| a.distance(*b) < 0.1 * l).count();
    let valence =
        |v| if made.is_rim_vertex(v) { made.valence(v) <= 3 } else { made.valence(v) == 3 };
    let [angles, areas] = [report.angles, report.areas];
    [
        ("simple panels", !is_broken),
        ("planarity", report.planarity_mm < 1e-13 * l),
        ("valence", made.vertices().all(valence)),
        ("deviation", most <= (2.5 * sag).max(0.05)),
        ("usual deviation", usual <= (1.5 * sag).max(0.035)),
        ("edges", short as f64 <= 0.005 * made.edge_count() as f64),
        ("angles", angles[0] >= 12.0 && angles[1] <= 300.0),
        ("areas", areas[0] >= 0.2 && areas[1] <= 2.4),
        ("nodes", report.node_reach <= 1.5),
        ("count", (report.panels as f64 / report.wanted - 1.0).abs() <= 0.1),
    ]
    .into_iter()
    .filter_map(|(name, is_kept)| (!is_kept).then_some(name))
    .collect()
}

/// Surfaces that are their own images, and the axes along which they are: pairs are counted on the
/// result, and the bars hold as for others.
fn mirrored() {
    for (place, axes) in [(0, "x"), (0, "x,y"), (2, "x,y"), (4, "x"), (5, "x,y"), (7, "y")] {
        let (name, formula, domain, size) = FIELDS[place];
        let mesh = field(formula, domain);
        for seed in 1..=3 {
            let params = PanelizeParams {
                size: Some(Length::from_mm(size)),
                rim: RimChoice::Walls,
                symmetry: axes.parse().expect("axes"),
                seed,
                ..PanelizeParams::default()
            };
            let (made, report) = match panelize(&mesh, &params, &Silent) {
                Ok(made) => made,
                Err(error) => {
                    println!("{name} mirrored along {axes}, seed {seed}: {error}");
                    continue;
                }
            };
            let count = |mirror: &MirrorReport| {
                format!(
                    "{} pairs, {} across, {} neither",
                    mirror.pairs, mirror.across, mirror.alone
                )
            };
            let counts: Vec<String> = report.mirrors.iter().map(count).collect();
            let missed = missed(&made, &report);
            let verdict =
                if missed.is_empty() { "kept".into() } else { format!("MISSED {missed:?}") };
            println!(
                "{name} mirrored along {axes}, seed {seed}: {} panels, {}, {} kinds; deviation {:.3} L; \
                {verdict}",
                report.panels,
                counts.join("; "),
                report.panel_kinds,
                report.deviation_mm[0] / report.size_mm,
            );
        }
    }
}

/// How few lengths edges can have.
fn families() {
    for place in [0, 2, 4] {
        let (name, formula, domain, size) = FIELDS[place];
        let mesh = field(formula, domain);
        for count in [5, 20, 60] {
            let params = PanelizeParams {
                size: Some(Length::from_mm(size)),
                rim: RimChoice::Walls,
                families: Some(count),
                ..PanelizeParams::default()
            };
            let (_, report) = panelize(&mesh, &params, &Silent).expect("panels");
            let Some(found) = &report.families else { continue };
            println!(
                "{name}, {count} families: {:?} lengths, {} of {} edges alike, off {:.4} L before and \
                {:.4} L now; {:?} kinds of panels; deviation {:.3} L before and {:.3} L now",
                found.lengths,
                found.alike,
                found.edges,
                found.off_mm[0] / size,
                found.off_mm[1] / size,
                found.panels,
                found.deviation_mm[0] / size,
                found.deviation_mm[1] / size,
            );
        }
    }
}

/// A height field of the table of baselines: its place in [`FIELDS`], and the same formula.
type Height = (usize, fn(f64, f64) -> f64);

/// Panels of four kinds on one surface: what a table of ways to build it shows.
fn baselines() {
    let heights: [Height; 4] = [
        (0, |x, y| 4.0 - x * x / 18.0 - y * y / 12.0),
        (1, |x, y| x * y / 9.0),
        (3, |x, y| 1.1 * (TAU * x / 14.0 + 0.4).sin() + 0.9 * (TAU * y / 12.0).cos()),
        (4, |x, y| 3.5 - x * x / 12.0 - y * y / 400.0),
    ];
    println!(
        "surface, way: panels, different ones (mirrored ones are one, to 1 mm), nodes above three \
        members, crossing panels, off their planes mm, off the surface L at most and for 95 %"
    );
    for (place, height) in heights {
        let (name, formula, domain, size) = FIELDS[place];
        let sides = domain.trim_end_matches('m').split("mx").map(|s| s.parse().expect("a side"));
        let sides: Vec<f64> = sides.collect();
        let mesh = field(formula, domain);
        let params = PanelizeParams {
            size: Some(Length::from_mm(size)),
            rim: RimChoice::Walls,
            ..PanelizeParams::default()
        };
        let (panels, _) = panelize(&mesh, &params, &Silent).expect("panels");
        // Cells of the same area as a regular hexagon of the size.
        let cell = (size / 1000.0) * 0.75_f64.sqrt().sqrt();
        let lattice = Lattice { sides: [sides[0], sides[1]], height };
        let planar = |mesh: &Mesh| {
            let context = OpContext { made: None, progress: &Silent };
            planarize(mesh, &PlanarizeParams::default(), &context).expect("planes").0
        };
        let ways = [
            ("panelize", panels),
            ("triangles", lattice.triangles(cell)),
            ("quads, planarize", planar(&lattice.quads(cell))),
            ("dual of triangles, planarize", planar(&lattice.dual(cell))),
        ];
        for (way, made) in ways {
            row(name, way, &made, size, height);
        }
    }
}

/// Cells over a rectangle about the origin, in metres; meshes in mm.
struct Lattice {
    sides: [f64; 2],
    height: fn(f64, f64) -> f64,
}

impl Lattice {
    fn mesh(&self, flat: &[[f64; 2]], faces: Vec<Vec<usize>>) -> Mesh {
        let points = flat.iter().map(|&[x, y]| 1000.0 * DVec3::new(x, y, (self.height)(x, y)));
        Mesh::from_faces(points, faces).expect("cells")
    }

    /// Columns and rows of cells of about the size of a square.
    fn counts(&self, cell: f64) -> [usize; 2] {
        self.sides.map(|side| (side / cell).round().max(1.0) as usize)
    }

    fn grid(&self, [columns, rows]: [usize; 2]) -> Vec<[f64; 2]> {
        let at = |i: usize, n: usize, side: f64| side * (i as f64 / n as f64 - 0.5);
        let [width, depth] = self.sides;
        let places = (0..=rows).flat_map(|j| (0..=columns).map(move |i| (i, j)));
        places.map(|(i, j)| [at(i, columns, width), at(j, rows, depth)]).collect()
    }

    fn quads(&self, cell: f64) -> Mesh {
        let [columns, rows] = self.counts(cell);
        let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| j * (columns + 1) + i));
        let faces = cells.map(|a| vec![a, a + 1, a + columns + 2, a + columns + 1]).collect();
        self.mesh(&self.grid([columns, rows]), faces)
    }

    /// Two triangles for each cell of twice the area.
    fn triangles(&self, cell: f64) -> Mesh {
        let [columns, rows] = self.counts(cell * 2.0_f64.sqrt());
        let cells = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
        let faces = cells.flat_map(|(i, j)| {
            let a = j * (columns + 1) + i;
            let [a, b, c, d] = [a, a + 1, a + columns + 2, a + columns + 1];
            if (i + j) % 2 == 0 {
                [vec![a, b, c], vec![a, c, d]]
            } else {
                [vec![a, b, d], vec![b, c, d]]
            }
        });
        self.mesh(&self.grid([columns, rows]), faces.collect())
    }

    /// Bricks in staggered rows, which are the dual of a regular triangulation, each with a corner
    /// amid its long sides: hexagons with their corners on the surface.
    fn dual(&self, cell: f64) -> Mesh {
        let height = cell * 0.75_f64.sqrt();
        let [columns, rows] = [
            (self.sides[0] / (cell * cell / height)).round() as usize,
            (self.sides[1] / height).round() as usize,
        ];
        let [width, depth] = self.sides;
        // Every line between rows has a corner at each half step.
        let line = |j: usize| -> Vec<[f64; 2]> {
            let y = depth * (j as f64 / rows as f64 - 0.5);
            // Corners step up and down by a sixth of a row, as in a regular hexagon.
            let sway = if j == 0 || j == rows { 0.0 } else { depth / rows as f64 / 6.0 };
            let at = |i: usize| {
                let is_end = i == 0 || i == 2 * columns;
                let up = if (i + j).is_multiple_of(2) { sway } else { -sway };
                let x = width * (i as f64 / (2 * columns) as f64 - 0.5);
                [x, y + if is_end { 0.0 } else { up }]
            };
            (0..=2 * columns).map(at).collect()
        };
        let flat: Vec<[f64; 2]> = (0..=rows).flat_map(line).collect();
        let per_line = 2 * columns + 1;
        let mut faces = Vec::new();
        for j in 0..rows {
            let ends: Vec<usize> = if j % 2 == 0 {
                (0..=columns).map(|i| 2 * i).collect()
            } else {
                let inner = (0..columns).map(|i| 2 * i + 1);
                std::iter::once(0).chain(inner).chain([2 * columns]).collect()
            };
            for pair in ends.windows(2) {
                let low = (pair[0]..=pair[1]).map(|i| j * per_line + i);
                let high = (pair[0]..=pair[1]).rev().map(|i| (j + 1) * per_line + i);
                faces.push(low.chain(high).collect());
            }
        }
        // Corners that only lie on a straight rim belong to one face.
        let mut uses = vec![0; flat.len()];
        faces.iter().flatten().for_each(|&v: &usize| uses[v] += 1);
        let is_end = |v: usize| v.is_multiple_of(per_line) || v % per_line == per_line - 1;
        let is_first = |v: usize| v < per_line || v >= flat.len() - per_line;
        let keeps = |v: &usize| uses[*v] > 1 || is_end(*v) && is_first(*v);
        faces.iter_mut().for_each(|face: &mut Vec<usize>| face.retain(keeps));
        self.mesh(&flat, faces)
    }
}

/// One row of the table.
fn row(name: &str, way: &str, made: &Mesh, size: f64, height: fn(f64, f64) -> f64) {
    let crowded = made.vertices().filter(|&v| made.valence(v) > 3).count();
    let mut kinds: Vec<Vec<i64>> = made.faces().map(|f| kind(&made.face_positions(f))).collect();
    kinds.sort_unstable();
    kinds.dedup();
    let mut crossing: Vec<FaceId> =
        crossings(made, 1000).into_iter().flat_map(|pair| [pair.first, pair.second]).collect();
    crossing.extend(made.faces().filter(|&f| crosses_itself(&made.face_positions(f))));
    crossing.sort_unstable();
    crossing.dedup();
    let flat = made.faces().map(|f| planarity(made, f).mm).fold(0.0, f64::max);
    let mut off: Vec<f64> = made
        .faces()
        .map(|f| {
            let corners = made.face_positions(f);
            let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
            let next = corners.iter().cycle().skip(1);
            let sides = corners.iter().zip(next).map(|(a, b)| a.midpoint(*b));
            let places = corners.iter().copied().chain(sides).chain([middle]);
            places.map(|p| distance(p / 1000.0, height)).fold(0.0, f64::max) * 1000.0 / size
        })
        .collect();
    off.sort_by(f64::total_cmp);
    println!(
        "{name}, {way}: {} panels, {} different, {crowded} nodes above three, {} crossing, {flat:.1e} \
        mm off their planes, {:.3} and {:.3} L off the surface",
        made.face_count(),
        kinds.len(),
        crossing.len(),
        off[off.len() - 1],
        off[off.len() * 95 / 100],
    );
}

/// A panel by its sides and the short diagonals between them, in mm, whichever way around and
/// turned over or not.
fn kind(corners: &[DVec3]) -> Vec<i64> {
    let count = corners.len();
    let mut kinds = Vec::new();
    for start in 0..count {
        for back in [false, true] {
            let at = |i: usize| {
                let i = if back { start + count * 2 - i } else { start + i };
                corners[i % count]
            };
            let round = |a: DVec3, b: DVec3| a.distance(b).round() as i64;
            let sides = (0..count).flat_map(|i| [round(at(i), at(i + 1)), round(at(i), at(i + 2))]);
            kinds.push(sides.collect());
        }
    }
    kinds.into_iter().min().unwrap_or_default()
}

/// Whether two sides that are no neighbours meet, seen along the normal.
fn crosses_itself(corners: &[DVec3]) -> bool {
    let Some(plane) = Plane::newell(corners) else { return true };
    let frame = Frame::on_plane(&plane);
    let flat: Vec<DVec2> = corners.iter().map(|&p| frame.flatten(p)).collect();
    let count = flat.len();
    let side = |i: usize| [flat[i], flat[(i + 1) % count]];
    (0..count).any(|i| {
        (i + 2..count).filter(|&j| (j + 1) % count != i).any(|j| {
            let ([a, b], [c, d]) = (side(i), side(j));
            segments_meet(a, b, c, d)
        })
    })
}

/// How far a place is from a height field, to first order, all in metres.
fn distance(p: DVec3, height: fn(f64, f64) -> f64) -> f64 {
    let step = 1e-5;
    let slope =
        |dx: f64, dy: f64| (height(p.x + dx, p.y + dy) - height(p.x - dx, p.y - dy)) / (2.0 * step);
    let (sx, sy) = (slope(step, 0.0), slope(0.0, step));
    (p.z - height(p.x, p.y)).abs() / (1.0 + sx * sx + sy * sy).sqrt()
}

/// Models of a folder as few panels, and their nets.
fn figures(folder: &str) {
    let files = std::fs::read_dir(folder).expect("a folder").filter_map(Result::ok);
    let mut files: Vec<_> = files.map(|entry| entry.path()).collect();
    files.retain(|path| path.extension().is_some_and(|end| end == "obj"));
    files.sort();
    for path in files {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let read = read_mesh(&path, &ReadOptions::default()).expect("a model");
        for count in [60, 200] {
            let params = PanelizeParams { count: Some(count), ..PanelizeParams::default() };
            let (made, report) = match panelize(&read.mesh, &params, &Silent) {
                Ok(made) => made,
                Err(error) => {
                    println!("{name}, {count} asked: {error}");
                    continue;
                }
            };
            let source = MeshSource { scale: 1.0, split_vertices: &[] };
            let net = unfold(&made, &Seams::Free, &UnfoldParams::default(), &source, &Silent);
            let net = net.map(|net| net.pieces.len().to_string());
            let net = net.unwrap_or_else(|error| error.to_string());
            let missed = missed(&made, &report);
            let missed: Vec<&str> = missed.into_iter().filter(|m| FIGURES.contains(m)).collect();
            let parts = made.components().len();
            println!(
                "{name}, {count} asked: {} panels in {parts} parts, deviation {:.3} L; missed {missed:?}; pieces \
                of the net: {net}",
                report.panels,
                report.deviation_mm[0] / report.size_mm,
            );
            report.notes().iter().skip(3).for_each(|note| println!("  {note}"));
        }
    }
}

/// What figures have to hold of [`missed`].
const FIGURES: [&str; 4] = ["simple panels", "planarity", "valence", "count"];

fn speed() {
    for &(count, most) in SPEED {
        // A larger piece of the same waves for more panels.
        let side = 24.0 * (f64::from(count) / 500.0).sqrt();
        let mesh = field(FIELDS[3].1, &format!("{side}mx{side}m"));
        let start = process_seconds();
        let params = PanelizeParams { count: Some(count), ..PanelizeParams::default() };
        let (made, report) = panelize(&mesh, &params, &Silent).expect("panels");
        let seconds = process_seconds() - start;
        let verdict = if seconds > most { "MISSED" } else { "kept" };
        println!(
            "{} panels asked, {} made, {} findings; {seconds:.1} CPU s, bar {most} s {verdict}; {:.0} MB, \
            bar 2000 MB",
            count,
            made.face_count(),
            report.findings.len(),
            peak_megabytes()
        );
    }
}
