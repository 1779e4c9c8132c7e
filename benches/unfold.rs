//! The unfolder against its bars: `cargo bench --bench unfold [-- --models DIR] [--only WORD]`.
//!
//! Prints faces, components, pieces and CPU seconds of one thread for random convex 3-valent
//! meshes, regular solids, and models, and says `MISSED` where a bar is missed. Every net is proven
//! once more (`unfold::prove`, which shares no code with the search) outside the time that is
//! measured. No peer is run: Blender's Paper Model, papercraft and mesh_unfolder have no release
//! that a script can install and call; what they reach is in the design notes, and the bars are
//! above all of it.
//!
//! `--models DIR` names a folder with spot.obj, cow.obj, fandisk.obj and teapot.obj (their licences
//! are not all clear, so only Spot, CC0, is bundled). They are unfolded in full, and decimated to
//! 200 and 1000 triangles by pymeshlab (`python3`, `pip install pymeshlab`), keeping topology.
//! `--large DIR` names a folder with large meshes (the Stanford bunny, an armadillo and an elephant
//! come with the data of CGAL): each OBJ, OFF or PLY there is unfolded at efforts of about 20 and 60
//! seconds for 20 000 triangles, and as strips.
//! `--only WORD` runs the rows whose name holds the word.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use clock::thread_seconds;
use std::path::{Path, PathBuf};
use std::process::Command;

use kerfold::io::{ReadOptions, read_mesh};
use kerfold::mesh::{Mesh, SplitVertex};
use kerfold::progress::Silent;
use kerfold::shape::{Archimedean, Platonic, SolidParams, random_tangent_polytope, solid};
use kerfold::unfold::{MeshSource, PiecesMode, Seams, UnfoldParams, prove, unfold};

/// Random convex meshes: faces, CPU seconds that one may take at most.
const CONVEX: [(usize, f64); 5] = [(100, 0.1), (200, 0.1), (500, 0.1), (1000, 0.3), (5000, 5.0)];
/// Seeds of each size.
const SEEDS: u64 = 20;
/// CPU seconds that one regular solid may take.
const SOLID: f64 = 0.02;
/// CPU seconds for models of 200 and 1000 triangles, and for full ones at the default effort.
const DECIMATED: f64 = 5.0;
const FULL: f64 = 10.0;
/// The effort that is worth a minute, and what it may take and must reach for a component.
const LONG_EFFORT: u32 = 60;
const LONG: f64 = 60.0;
const LONG_PIECES: usize = 3;
/// The efforts of large meshes, with seconds and pieces for a component that they must keep to at
/// 20 000 triangles; seconds grow with the triangles. The last is for strips, of which any number
/// will do.
const LARGE: [(u32, f64, usize); 2] = [(10, 20.0, 10), (40, 60.0, 6)];
const LARGE_FACES: f64 = 20_000.0;
const LARGE_STRIPS: f64 = 2.0;

fn main() {
    let args: Vec<String> = std::env::args().collect();
    let after =
        |flag: &str| args.iter().position(|a| a == flag).and_then(|i| args.get(i + 1)).cloned();
    let bench = Bench { only: after("--only") };
    println!(
        "{:<28} {:>6} {:>5} {:>7} {:>9} {:>9}  verdict",
        "mesh", "faces", "parts", "pieces", "CPU s", "bar s"
    );
    bench.convex();
    bench.solids();
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/meshes");
    for (name, bar) in [("spot-200", DECIMATED), ("spot-1000", DECIMATED)] {
        bench.model(name, &fixtures.join(name).with_extension("obj"), bar, 1);
    }
    if let Some(folder) = after("--large") {
        bench.large(Path::new(&folder));
    }
    match after("--models").map(PathBuf::from) {
        Some(folder) => bench.models(&folder),
        None => {
            println!("models: no folder given (--models DIR); only Spot is measured");
            bench.full("spot", &fixtures.join("spot.obj"));
        }
    }
}

struct Bench {
    only: Option<String>,
}

/// One row of the table, or the worst of several.
struct Row {
    faces: usize,
    parts: usize,
    pieces: usize,
    seconds: f64,
}

impl Bench {
    fn is_wanted(&self, name: &str) -> bool {
        self.only.as_ref().is_none_or(|word| name.contains(word.as_str()))
    }

    fn convex(&self) {
        for (n, bar) in CONVEX {
            let name = format!("convex-{n} x {SEEDS}");
            if self.is_wanted(&name) {
                let rows = (0..SEEDS)
                    .map(|seed| run(&random_tangent_polytope(n, seed), &[], PiecesMode::Auto, 10));
                let worst = rows
                    .map(|row| row.unwrap_or_else(|fault| panic!("{name}: {fault}")))
                    .reduce(worse);
                report(&name, &worst.expect("seeds"), bar, 1);
            }
        }
    }

    fn solids(&self) {
        let fixed = Platonic::ALL
            .map(Platonic::name)
            .into_iter()
            .chain(Archimedean::ALL.map(Archimedean::name));
        let families = (3..=20).flat_map(|n| [format!("prism-{n}"), format!("antiprism-{n}")]);
        let names: Vec<String> = fixed.map(str::to_owned).chain(families).collect();
        let mut worst: Option<(String, Row)> = None;
        for name in names.iter().filter(|name| self.is_wanted(name)) {
            let params =
                SolidParams { name: name.parse().expect("a solid"), ..SolidParams::default() };
            let row = run(&solid(&params).expect("a solid"), &[], PiecesMode::One, 10);
            let row = row.unwrap_or_else(|fault| panic!("{name}: {fault}"));
            if row.seconds >= SOLID || row.pieces > 1 {
                report(name, &row, SOLID, 1);
            }
            if worst.as_ref().is_none_or(|w| row.seconds > w.1.seconds) {
                worst = Some((name.clone(), row));
            }
        }
        if let Some((name, row)) = worst {
            report(&format!("{} solids, {name}", names.len()), &row, SOLID, 1);
        }
    }

    fn models(&self, folder: &Path) {
        let small = std::env::temp_dir().join(format!("kerfold-bench-{}", std::process::id()));
        std::fs::create_dir_all(&small).expect("the temporary folder is writable");
        for name in ["spot", "cow", "fandisk", "teapot"] {
            let path = folder.join(name).with_extension("obj");
            for count in [200, 1000] {
                let short = format!("{name}-{count} decimated");
                if self.is_wanted(&short) {
                    let output = small.join(format!("{name}-{count}.obj"));
                    match decimate(&path, count, &output) {
                        Ok(()) => self.model(&short, &output, DECIMATED, 1),
                        Err(fault) => println!("{short:<28} not measured: {fault}"),
                    }
                }
            }
        }
        for name in ["spot", "cow", "fandisk", "teapot"] {
            self.full(name, &folder.join(name).with_extension("obj"));
        }
        std::fs::remove_dir_all(&small).expect("the folder is our own");
    }

    /// Every mesh of a folder, at growing efforts and as strips.
    fn large(&self, folder: &Path) {
        let entries = std::fs::read_dir(folder).expect("the folder is there");
        let mut paths: Vec<PathBuf> = entries.map(|e| e.expect("an entry").path()).collect();
        paths.retain(|p| {
            p.extension().is_some_and(|e| ["obj", "off", "ply"].iter().any(|&x| e == x))
        });
        paths.sort();
        for path in paths {
            let name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into());
            if !self.is_wanted(&name) {
                continue;
            }
            let read = match read_mesh(&path, &ReadOptions::default()) {
                Ok(read) => read,
                Err(fault) => {
                    println!("{name:<28} not measured: {fault}");
                    continue;
                }
            };
            let share = read.mesh.face_count() as f64 / LARGE_FACES;
            for (effort, bar, most) in LARGE {
                match run(&read.mesh, &read.splits, PiecesMode::Auto, effort) {
                    Ok(row) => report(&format!("{name}, effort {effort}"), &row, bar * share, most),
                    Err(fault) => println!("{name:<28} FAILED: {fault}"),
                }
            }
            match run(&read.mesh, &read.splits, PiecesMode::Strips, 10) {
                Ok(row) => {
                    report(&format!("{name}, strips"), &row, LARGE_STRIPS * share, usize::MAX)
                }
                Err(fault) => println!("{name:<28} FAILED: {fault}"),
            }
        }
    }

    /// A full model at both efforts.
    fn full(&self, name: &str, path: &Path) {
        self.measure(&format!("{name} full"), path, 10, FULL, usize::MAX);
        // The design promises a number of pieces for these two only.
        let pieces = if ["spot", "fandisk"].contains(&name) { LONG_PIECES } else { usize::MAX };
        self.measure(
            &format!("{name} full, effort {LONG_EFFORT}"),
            path,
            LONG_EFFORT,
            LONG,
            pieces,
        );
    }

    fn model(&self, name: &str, path: &Path, bar: f64, pieces: usize) {
        self.measure(name, path, 10, bar, pieces);
    }

    fn measure(&self, name: &str, path: &Path, effort: u32, bar: f64, pieces: usize) {
        if !self.is_wanted(name) {
            return;
        }
        let read = match read_mesh(path, &ReadOptions::default()) {
            Ok(read) => read,
            Err(fault) => return println!("{name:<28} not measured: {fault}"),
        };
        match run(&read.mesh, &read.splits, PiecesMode::Auto, effort) {
            Ok(row) => report(name, &row, bar, pieces),
            Err(fault) => println!("{name:<28} FAILED: {fault}"),
        }
    }
}

fn worse(a: Row, b: Row) -> Row {
    Row { pieces: a.pieces.max(b.pieces), seconds: a.seconds.max(b.seconds), ..a }
}

/// `most` pieces for each part.
fn report(name: &str, row: &Row, bar: f64, most: usize) {
    let mut verdict = Vec::new();
    if row.seconds >= bar {
        verdict.push("MISSED (time)".to_owned());
    }
    if row.pieces > most.saturating_mul(row.parts) {
        verdict.push(format!("MISSED ({most} per part)"));
    }
    let Row { faces, parts, pieces, seconds } = row;
    let verdict = if verdict.is_empty() { "ok".to_owned() } else { verdict.join(", ") };
    println!("{name:<28} {faces:>6} {parts:>5} {pieces:>7} {seconds:>9.4} {bar:>9}  {verdict}");
}

fn run(
    mesh: &Mesh,
    split_vertices: &[SplitVertex],
    pieces: PiecesMode,
    effort: u32,
) -> Result<Row, String> {
    let params = UnfoldParams { pieces, effort, ..UnfoldParams::default() };
    let source = MeshSource { scale: 1.0, split_vertices };
    let start = thread_seconds();
    let net =
        unfold(mesh, &Seams::Free, &params, &source, &Silent).map_err(|fault| fault.to_string())?;
    let seconds = thread_seconds() - start;
    let proof = prove(mesh, &net).map_err(|fault| fault.to_string())?;
    assert_eq!(proof.overlaps, 0, "the proof counts overlaps");
    Ok(Row { faces: mesh.face_count(), parts: components(mesh), pieces: net.pieces.len(), seconds })
}

fn components(mesh: &Mesh) -> usize {
    mesh.component_count()
}

const DECIMATE: &str = "
import sys, pymeshlab
meshes = pymeshlab.MeshSet()
meshes.load_new_mesh(sys.argv[1])
meshes.meshing_merge_close_vertices(threshold=pymeshlab.PercentageValue(1e-6))
meshes.meshing_decimation_quadric_edge_collapse(
    targetfacenum=int(sys.argv[2]), preservetopology=True, preserveboundary=True, autoclean=True)
meshes.save_current_mesh(sys.argv[3], save_vertex_normal=False, save_vertex_color=False, save_wedge_texcoord=False)
";

fn decimate(model: &Path, count: usize, output: &Path) -> Result<(), String> {
    let mut python = Command::new("python3");
    python.args(["-c", DECIMATE]).arg(model).arg(count.to_string()).arg(output);
    let done = python.output().map_err(|fault| format!("python3: {fault}"))?;
    if done.status.success() {
        return Ok(());
    }
    let text = String::from_utf8_lossy(&done.stderr).into_owned();
    Err(format!("python3 with pymeshlab: {}", text.lines().last().unwrap_or("failed")))
}
