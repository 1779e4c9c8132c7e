//! Façades of glass panels and a random solid of 1000: `cargo bench --bench panels [FACES…]`.
//!
//! For 10 000, 20 000 and 100 000 panels the CPU seconds of plates, schedule and sheets without
//! nesting, then of all files, the 3D files with them; how time grows from 10 000 to 100 000; and
//! where a bar is missed: 10 s and 1 GB for plates, schedule and sheets of 20 000, 8 s with all
//! their files, an exponent of 1.1. No peer is known that makes plates with mitres and schedules
//! from a file, so none is compared.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use clock::{peak_megabytes, process_seconds};
use kerfold::io::sheet::svg::write_svg;
use kerfold::make::{PaneFile, PanelFiles, PanelJob, SolidFile, panel_model, panel_outputs};
use kerfold::mesh::Mesh;
use kerfold::panel::{PanelParams, ReferenceSide, panel_net, plates, schedule};
use kerfold::progress::Silent;
use kerfold::shape::{hexagonal_facade, random_tangent_polytope};
use kerfold::sheet::{
    JointParams, Labels, LetterParams, NestParams, SheetParams, StockParams, lay_out,
};
use kerfold::unfold::MeshSource;
use kerfold::units::Length;

/// What plates, schedule and sheets of 20 000 panels may take.
const MOST_SECONDS: f64 = 10.0;
const MOST_MEGABYTES: f64 = 1000.0;
/// The CPU seconds in which 20 000 panels with all files are to be done.
const MOST_WITH_FILES: f64 = 8.0;
/// Time may grow with at most this power of the number of panels.
const MOST_EXPONENT: f64 = 1.1;

/// Columns and rows of the façades.
const FACADES: [(usize, usize); 3] = [(100, 100), (200, 100), (400, 250)];
/// The number of panels that the bars of seconds are for.
const BAR_PANELS: usize = 20_000;

fn main() {
    let wanted: Vec<usize> = std::env::args().filter_map(|a| a.parse().ok()).collect();
    println!("peer: none known");
    let mut measured = Vec::new();
    for (columns, rows) in FACADES {
        if wanted.is_empty() || wanted.contains(&(columns * rows)) {
            measured.push(facade(columns, rows));
        }
    }
    growth(&measured);
    if wanted.is_empty() {
        exactness(&random_tangent_polytope(1000, 1));
    }
}

/// What a façade took, in CPU seconds.
struct Measured {
    panels: usize,
    /// Plates, schedule and sheets.
    made: f64,
    /// The same with all files.
    with_files: f64,
}

/// How time grows between the smallest and the largest façade.
fn growth(measured: &[Measured]) {
    let [Some(first), Some(last)] = [measured.first(), measured.last()] else { return };
    if first.panels == last.panels {
        return;
    }
    let exponent = |of: fn(&Measured) -> f64| {
        (of(last) / of(first)).ln() / (last.panels as f64 / first.panels as f64).ln()
    };
    for (what, exponent) in [
        ("plates, schedule, sheets", exponent(|m| m.made)),
        ("all files", exponent(|m| m.with_files)),
    ] {
        println!(
            "exponent from {} to {} panels, {what}: {exponent:.2}; bar {MOST_EXPONENT} {}",
            first.panels,
            last.panels,
            verdict(exponent <= MOST_EXPONENT)
        );
    }
}

fn verdict(is_kept: bool) -> &'static str {
    if is_kept { "kept" } else { "MISSED" }
}

/// Plates of glass with joints of 8 mm, and sheets as glass is sold.
fn asked() -> (PanelParams, SheetParams) {
    let params = PanelParams {
        gap: Length::from_mm(8.0),
        side: ReferenceSide::Out,
        ..PanelParams::default()
    };
    let sheet = SheetParams {
        stock: StockParams {
            sheet: "3210x6000".parse().expect("a size"),
            ..StockParams::default()
        },
        letter: LetterParams { labels: Labels::Edges, ..LetterParams::default() },
        joint: JointParams { thickness: Some(Length::from_mm(10.0)), ..JointParams::default() },
        // Rows of boxes: nesting has a bench of its own.
        nest: NestParams { nest_effort: 0, ..NestParams::default() },
        ..SheetParams::default()
    };
    (params, sheet)
}

fn facade(columns: usize, rows: usize) -> Measured {
    // As bent from end to end whatever the number of panels.
    let size = 1000.0 * columns.max(2 * rows) as f64;
    let mesh = hexagonal_facade(columns, rows, 1000.0, [0.9 * size, 0.6 * size]);
    let (params, sheet) = asked();
    let panels = mesh.face_count();
    println!("façade of {panels} panels");
    let made = in_steps(&mesh, &params, &sheet);
    let mut clock = Clock::start();
    let source = MeshSource { scale: 1.0, split_vertices: &[] };
    let solids = vec![SolidFile::Step, SolidFile::Obj, SolidFile::Glb, SolidFile::Stl];
    let files = PanelFiles { solids, drawings: vec![PaneFile::None] };
    let job = PanelJob { panels: &params, files: &files, sheet: &sheet };
    let panelled = panel_model(&mesh, job, &source, &Silent).expect("panels");
    clock.lap("plates to sheets in one call");
    let outputs = panel_outputs(&panelled, &mesh, &sheet, "bench").expect("files");
    let bytes: usize = outputs.iter().map(|(_, bytes)| bytes.len()).sum();
    clock.lap(&format!("all {} files, {} MB", outputs.len(), bytes / 1_000_000));
    let with_files = clock.total();
    if panels == BAR_PANELS {
        let verdict = verdict(with_files <= MOST_WITH_FILES);
        println!("with all files {with_files:.2} CPU s; bar {MOST_WITH_FILES} s {verdict}");
    }
    Measured { panels, made, with_files }
}

/// Plates, schedule and sheets one after the other: the CPU seconds of all.
fn in_steps(mesh: &Mesh, params: &PanelParams, sheet: &SheetParams) -> f64 {
    let thickness = sheet.joint.thickness.expect("it is set");
    let mut clock = Clock::start();
    let made = plates(mesh, thickness, params, &Silent).expect("plates");
    clock.lap("plates");
    let listed = schedule(mesh, &made, params, &Silent).expect("nobody stops it");
    clock.lap("schedule");
    let net = panel_net(mesh, &made, 1.0, &[]);
    let bare = SheetParams {
        joint: JointParams { thickness: None, ..sheet.joint.clone() },
        ..sheet.clone()
    };
    let sheets = lay_out(&net, &bare).expect("sheets");
    clock.lap("sheets laid out");
    let bytes: usize =
        sheets.drawings.iter().map(|d| write_svg(d, bare.files.preset, "bench").len()).sum();
    clock.lap("sheets written");
    let (seconds, megabytes) = (clock.total(), peak_megabytes());
    println!(
        "  {} groups, {} sheets, {} MB of SVG, largest residual {:.1e}",
        listed.groups.len(),
        sheets.drawings.len(),
        bytes / 1_000_000,
        listed.totals.residual
    );
    let bar = if mesh.face_count() == BAR_PANELS {
        let is_kept = seconds <= MOST_SECONDS && megabytes <= MOST_MEGABYTES;
        format!("; bar {MOST_SECONDS} s and {MOST_MEGABYTES} MB {}", verdict(is_kept))
    } else {
        String::new()
    };
    println!("  plates, schedule, sheets: {seconds:.2} CPU s, {megabytes:.0} MB{bar}");
    seconds
}

/// The promises about random 3-valent solids, on a size that tests do not take.
fn exactness(mesh: &Mesh) {
    let mut clock = Clock::start();
    let made =
        plates(mesh, Length::from_mm(0.05), &PanelParams::default(), &Silent).expect("plates");
    clock.lap("1000 random faces");
    let worst =
        made.plates
            .iter()
            .flat_map(|p| {
                p.front.iter().zip(&p.back).map(|(&f, &b)| {
                    ((p.on_front(f) - p.on_back(b)).dot(p.frame.normal) - 0.05).abs()
                })
            })
            .fold(0.0, f64::max);
    println!(
        "thickness off by at most {worst:.1e} of a solid of size 2; bar 1e-12 of the size {}",
        if worst > 2e-12 { "MISSED" } else { "kept" }
    );
}

/// CPU time between laps.
struct Clock {
    start: f64,
    last: f64,
}

impl Clock {
    fn start() -> Self {
        let now = process_seconds();
        Self { start: now, last: now }
    }

    fn lap(&mut self, what: &str) {
        let now = process_seconds();
        println!("  {:>8.2} CPU s  {what}", now - self.last);
        self.last = now;
    }

    fn total(&self) -> f64 {
        process_seconds() - self.start
    }
}
