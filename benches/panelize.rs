//! Panels of freeform surfaces, against the bars: `cargo bench --bench panelize [NAME…]`.
//!
//! Surfaces by formula, each with three sizes and five seeds. A run is kept when every panel is
//! simple, planar and goes through no other, nodes have three members, and deviation, edges,
//! angles, areas, nodes and count are within the bars; 95 of 100 runs are to be. Then the CPU
//! seconds for 500, 1 000 and 5 000 panels. No peer is known that proves planes, so none is
//! compared.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use std::f64::consts::TAU;

use clock::process_seconds;
use glam::DVec3;
use kerfold::mesh::Mesh;
use kerfold::panelize::{
    HeightParams, PanelizeFinding, PanelizeParams, PanelizeReport, RimChoice, height_field,
    panelize,
};
use kerfold::progress::Silent;
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
    let named: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
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
    println!("{kept} of {runs} runs kept; bar 95 of 100");
    if is_meant("speed") {
        speed();
    }
}

fn field(formula: &str, domain: &str) -> Mesh {
    let domain = domain.parse().expect("a rectangle");
    height_field(&HeightParams { height: formula.to_owned(), domain }).expect("a height field")
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
            "{} panels asked, {} made, {} findings; {seconds:.1} CPU s; bar {most} s {verdict}",
            count,
            made.face_count(),
            report.findings.len()
        );
    }
}
