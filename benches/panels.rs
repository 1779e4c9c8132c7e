//! A façade of 20 000 glass panels and a random solid of 1000: `cargo bench --bench panels`.
//!
//! Prints CPU seconds and peak memory of plates, schedule and sheets without nesting, then of the
//! 3D files, and says when the bar of 10 s and 1 GB is missed. No peer is known that makes plates
//! with mitres and schedules from a file, so none is compared.

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

/// What the façade may take.
const MOST_SECONDS: f64 = 10.0;
const MOST_MEGABYTES: f64 = 1000.0;

fn main() {
    println!("peer: none known");
    facade();
    let small = random_tangent_polytope(1000, 1);
    exactness(&small);
}

fn facade() {
    let mesh = hexagonal_facade(200, 100, 1000.0, [180_000.0, 120_000.0]);
    let thickness = Length::from_mm(10.0);
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
        joint: JointParams { thickness: Some(thickness), ..JointParams::default() }, // Rows of boxes: nesting has a bench of its own.
        nest: NestParams { nest_effort: 0, ..NestParams::default() },
        ..SheetParams::default()
    };
    let mut clock = Clock::start();
    let made = plates(&mesh, thickness, &params, &Silent).expect("plates");
    clock.lap("plates");
    let listed = schedule(&mesh, &made, &params, &Silent).expect("nobody stops it");
    clock.lap("schedule");
    let net = panel_net(&mesh, &made, 1.0, &[]);
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
        "façade: {} panels, {} groups, {} sheets, {} MB of SVG, largest residual {:.1e}",
        listed.panels.len(),
        listed.groups.len(),
        sheets.drawings.len(),
        bytes / 1_000_000,
        listed.totals.residual
    );
    let verdict =
        if seconds > MOST_SECONDS || megabytes > MOST_MEGABYTES { "MISSED" } else { "kept" };
    println!(
        "plates, schedule, sheets: {seconds:.2} CPU s, {megabytes:.0} MB; bar 10 s and 1000 MB \
        {verdict}"
    );
    drop((made, listed, net, sheets));
    let mut clock = Clock::start();
    let source = MeshSource { scale: 1.0, split_vertices: &[] };
    for solids in [
        vec![SolidFile::None],
        vec![SolidFile::Step, SolidFile::Obj, SolidFile::Glb, SolidFile::Stl],
    ] {
        let files = PanelFiles { solids, drawings: vec![PaneFile::None] };
        let job = PanelJob { panels: &params, files: &files, sheet: &sheet };
        let panelled = panel_model(&mesh, job, &source, &Silent).expect("panels");
        let outputs = panel_outputs(&panelled, &mesh, &sheet, "bench").expect("files");
        let bytes: usize = outputs.iter().map(|(_, bytes)| bytes.len()).sum();
        clock.lap(&format!("all {} files, {} MB", outputs.len(), bytes / 1_000_000));
    }
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
