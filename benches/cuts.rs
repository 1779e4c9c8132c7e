//! Cuts against trimesh, manifold3d and voro++, run in the same call on the same input: `cargo
//! bench --bench cuts`.
//!
//! Three questions: one capped cut of a closed mesh of 1.3 million triangles; a chain of 78 728
//! vertex truncations of a cube (nine rounds, every vertex, planes through the points at a third of
//! its edges), with the time per cut on meshes of a thousand to a million vertices; local cuts on a
//! mesh of a million faces. All times are CPU seconds of the thread or the process, on the mesh in
//! memory, without files; the best of several runs counts on both sides.
//!
//! Peers: Python with `trimesh` and `manifold3d` (PyPI); a C++ compiler with `voro++-dev` (Debian;
//! further places for headers and library in `CXXFLAGS`). A peer that is not there is named, and
//! nothing is compared with it.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use clock::{peak_megabytes, thread_seconds};
use std::path::PathBuf;
use std::process::Command;

use glam::DVec3;
use kerfold::geom::Plane;
use kerfold::mesh::{Mesh, VertexId};
use kerfold::op::{
    CutChain, OpContext, Reach, SliceParams, TruncateVertexParams, slice, truncate_vertices,
};
use kerfold::select::Selection;
use kerfold::shape;

const ONE_CUT_BAR: f64 = 25.0;
const CHAIN_BAR: f64 = 4.0;
/// The best of so many runs of the chain counts, theirs and ours.
const CHAIN_RUNS: usize = 9;
/// A chain's cut may take this many times longer on a large mesh than on a small one before it is
/// no longer called flat: what the caches of the machine no longer hold costs more to fetch.
const FLAT_BAR: f64 = 3.0;

/// Geodesic sphere of 20 · 256² triangles.
const FREQUENCY: u32 = 256;
const RADIUS: f64 = 100.0;
const NORMAL: [f64; 3] = [1.0, 0.3, 0.2];
const POINT: [f64; 3] = [10.0, 0.0, 0.0];

fn main() {
    let wanted: Vec<String> = std::env::args().skip(1).filter(|a| !a.starts_with('-')).collect();
    let runs = |name: &str| wanted.is_empty() || wanted.iter().any(|w| w == name);
    if runs("one") {
        one_cut();
    }
    if runs("chain") {
        chain();
    }
    if runs("local") {
        local_cuts();
    }
}

// ---- one capped cut -----------------------------------------------------------------------------

fn one_cut() {
    let mesh = shape::geodesic(FREQUENCY, RADIUS);
    println!("one capped cut of {} triangles, closed; CPU seconds", mesh.face_count());
    let (normal, point) = (DVec3::from_array(NORMAL), DVec3::from_array(POINT));
    let mut in_place = f64::INFINITY;
    let mut closed_up = f64::INFINITY;
    let mut counts = [0; 2];
    for _ in 0..7 {
        let mut chain = CutChain::new(mesh.clone());
        let start = thread_seconds();
        let caps =
            chain.cut_given(normal, point, Reach::Global).expect("a sphere can be cut").len();
        let cut = thread_seconds();
        let half = chain.finish();
        let end = thread_seconds();
        assert!(half.is_closed() && caps == 1);
        counts = [half.vertex_count(), half.face_count()];
        in_place = in_place.min(cut - start);
        closed_up = closed_up.min(end - start);
    }
    let whole = best_of(3, || {
        slice(&mesh, &SliceParams::new(normal, point), &OpContext::default())
            .expect("a sphere can be cut");
    });
    println!(
        "  kerfold, in place                    {in_place:.4}   ({} vertices, {} faces left)",
        counts[0], counts[1]
    );
    println!("  kerfold, in place, gaps closed       {closed_up:.4}");
    println!("  kerfold, slice(): a copy and a report {whole:.4}");
    println!("  peak memory so far {:.0} MB", peak_megabytes());
    let peers = python_cut(&mesh);
    for (name, seconds) in &peers {
        match seconds {
            Some(seconds) => println!(
                "  {name:<12} {seconds:.4}   ratio {:.1} (bar {ONE_CUT_BAR}) {}; with gaps closed \
                {:.1}; slice() {:.1}",
                seconds / in_place,
                verdict(seconds / in_place >= ONE_CUT_BAR),
                seconds / closed_up,
                seconds / whole,
            ),
            None => println!("  {name:<12} is not installed (PyPI); no comparison is made"),
        }
    }
}

/// Reads the mesh as raw numbers and cuts it; prints the least CPU seconds of three cuts, or
/// nothing without the module.
const PYTHON: &str = r#"
import sys, time
import numpy as np
v = np.fromfile(sys.argv[2], dtype="<f8").reshape(-1, 3)
f = np.fromfile(sys.argv[3], dtype="<u4").reshape(-1, 3)
n = np.array([float(x) for x in sys.argv[4:7]])
p = np.array([float(x) for x in sys.argv[7:10]])
n /= np.linalg.norm(n)
best = 1e9
if sys.argv[1] == "trimesh":
    import trimesh
    m = trimesh.Trimesh(v, f, process=False)
    for _ in range(3):
        t = time.process_time()
        half = trimesh.intersections.slice_mesh_plane(m, -n, p, cap=True)
        best = min(best, time.process_time() - t)
    assert half.is_watertight
else:
    import manifold3d
    m = manifold3d.Manifold(manifold3d.Mesh(v.astype(np.float32), f))
    assert m.num_tri() == len(f)
    for _ in range(3):
        t = time.process_time()
        half = m.trim_by_plane(-n, -n.dot(p))
        assert half.num_tri() > 0
        best = min(best, time.process_time() - t)
print(best)
"#;

fn python_cut(mesh: &Mesh) -> [(&'static str, Option<f64>); 2] {
    let numbers = Scratch::new("vertices");
    let corners = Scratch::new("faces");
    let positions: Vec<u8> = mesh
        .vertices()
        .flat_map(|v| mesh.position(v).to_array())
        .flat_map(f64::to_le_bytes)
        .collect();
    let faces: Vec<u8> = mesh
        .faces()
        .flat_map(|f| mesh.face_vertices(f))
        .flat_map(|v| (v.index() as u32).to_le_bytes())
        .collect();
    std::fs::write(&numbers.0, positions).expect("the temporary folder is writable");
    std::fs::write(&corners.0, faces).expect("the temporary folder is writable");
    ["trimesh", "manifold3d"].map(|module| {
        let mut command = Command::new("python3");
        command.args(["-c", PYTHON, module]).arg(&numbers.0).arg(&corners.0);
        command.args(NORMAL.iter().chain(&POINT).map(f64::to_string));
        (module, output_of(command).and_then(|text| text.trim().parse().ok()))
    })
}

// ---- the chain of truncations -------------------------------------------------------------------

/// In which order the corners of a round are cut.
#[derive(Clone, Copy)]
enum Order {
    /// As the mesh numbers them.
    Mesh,
    /// Neighbours after one another: voro++ begins its search for the cut vertex at the place of
    /// the last cut, so the order decides its time more than anything else.
    Curve,
}

fn chain() {
    println!(
        "chain of truncations of a cube, every vertex, planes through the points at a third of the \
        edges"
    );
    let mut planes: Vec<Plane> = Vec::new();
    for (order, name) in
        [(Order::Curve, "rounds along a curve"), (Order::Mesh, "in the order of the mesh")]
    {
        planes.clear();
        let (total, cuts) = own_chain(order, &mut planes);
        println!("  {name}");
        println!(
            "    kerfold, planes and cuts  {total:.4}   ({:.3} µs a cut)",
            total / 78_728.0 * 1e6
        );
        println!(
            "    kerfold, cuts only        {cuts:.4}   ({:.3} µs a cut)",
            cuts / 78_728.0 * 1e6
        );
        match run_voro(&planes) {
            Ok((seconds, vertices)) => {
                let ratio = seconds / cuts;
                println!(
                    "    voro++, cuts only         {seconds:.4}   ratio {ratio:.1} (bar \
                    {CHAIN_BAR}) {}; {vertices} vertices",
                    verdict(ratio >= CHAIN_BAR)
                );
            }
            Err(reason) => println!("    voro++: {reason}; no comparison is made"),
        }
    }
    let unseeded = best_of(5, || {
        let mut chain = CutChain::new(shape::cube(2.0));
        for plane in &planes {
            chain.cut(plane, Reach::Global);
            if chain.mesh().vertex_count() > 4000 {
                break;
            }
        }
    });
    println!(
        "  kerfold, without seeds (the whole mesh is asked) up to 4000 vertices {unseeded:.4}"
    );
    println!("  time per cut by the size of the mesh:");
    let mut per_round: Vec<(usize, f64)> = Vec::new();
    let mut chain = CutChain::new(shape::cube(2.0));
    for _ in 0..11 {
        truncate_round(&mut chain, Order::Mesh, &mut per_round, None);
    }
    let small = per_round.iter().find(|r| r.0 >= 1000).map_or(f64::NAN, |r| r.1);
    for &(vertices, seconds) in per_round.iter().filter(|r| r.0 >= 1000) {
        println!("  {vertices:>9} vertices {:>8.3} µs", seconds * 1e6);
    }
    let large = per_round.last().map_or(f64::NAN, |r| r.1);
    println!(
        "  largest to smallest {:.2} (bar {FLAT_BAR}) {}",
        large / small,
        verdict(large / small <= FLAT_BAR)
    );
    let rounds = best_of(3, || {
        let params =
            TruncateVertexParams { repeat: 7, ..TruncateVertexParams::new(Selection::all(), 0.25) };
        truncate_vertices(
            &shape::cube(2.0),
            &TruncateVertexParams { scope: kerfold::op::Scope::Local, ..params },
            &OpContext::default(),
        )
        .expect("something is left");
    });
    println!(
        "  truncate_vertices, 7 rounds with report {rounds:.4}   ({:.3} µs a cut)",
        rounds / 8744.0 * 1e6
    );
}

/// Nine rounds: the least seconds with the planes and of the cuts alone, and the planes.
fn own_chain(order: Order, planes: &mut Vec<Plane>) -> (f64, f64) {
    let (mut total, mut cuts) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..CHAIN_RUNS {
        planes.clear();
        let mut chain = CutChain::new(shape::cube(2.0));
        let start = thread_seconds();
        let cutting: f64 =
            (0..9).map(|_| truncate_round(&mut chain, order, &mut Vec::new(), Some(planes))).sum();
        let end = thread_seconds();
        assert_eq!(planes.len(), 78_728);
        assert_eq!(chain.mesh().vertex_count(), 8 * 3_usize.pow(9));
        total = total.min(end - start);
        cuts = cuts.min(cutting);
    }
    (total, cuts)
}

/// All planes from the mesh as it is, then all cuts. Adds (vertices before, seconds per cut) and
/// returns the seconds of the cuts alone.
fn truncate_round(
    chain: &mut CutChain,
    order: Order,
    per_round: &mut Vec<(usize, f64)>,
    planes: Option<&mut Vec<Plane>>,
) -> f64 {
    let start = thread_seconds();
    let mesh = chain.mesh();
    let mut elements: Vec<(VertexId, Plane)> =
        mesh.vertices().map(|v| (v, plane_at(mesh, v))).collect();
    if matches!(order, Order::Curve) {
        elements.sort_by_key(|(_, plane)| place_on_curve(plane));
    }
    let planned = thread_seconds();
    chain.reserve(elements.len());
    for (v, plane) in &elements {
        let caps = chain.cut(plane, Reach::Local(&[*v]));
        debug_assert_eq!(caps.len(), 1);
    }
    let cutting = thread_seconds() - planned;
    per_round.push((elements.len(), (thread_seconds() - start) / elements.len() as f64));
    if let Some(planes) = planes {
        planes.extend(elements.iter().map(|e| e.1));
    }
    cutting
}

fn plane_at(mesh: &Mesh, v: VertexId) -> Plane {
    let here = mesh.position(v);
    let mut points = [DVec3::ZERO; 3];
    for (point, u) in points.iter_mut().zip(mesh.neighbours(v)) {
        *point = here.lerp(mesh.position(u), 1.0 / 3.0);
    }
    let normal = (points[1] - points[0]).cross(points[2] - points[0]);
    let outwards = if normal.dot(here - points[0]) > 0.0 { normal } else { -normal };
    Plane::new(outwards, points[0]).expect("three points")
}

/// A curve through the cube [−1, 1]³ that visits its eighths one after the other, and theirs in
/// turn.
fn place_on_curve(plane: &Plane) -> u64 {
    let cell = ((plane.point() + 1.0) * 512.0).floor();
    let bits = [cell.x, cell.y, cell.z].map(|c| c as u64);
    (0..10).fold(0, |code, bit| {
        (0..3).fold(code, |code, axis| code | (bits[axis] >> bit & 1) << (3 * bit + axis))
    })
}

/// Cuts the cube [−1, 1]³ by half-spaces n · x ≤ d read from a file, as often as we do, and prints
/// the least CPU seconds.
const CPP: &str = r#"
#include <voro++/voro++.hh>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>
static double seconds() {
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}
int main(int, char** argv) {
    std::vector<double> planes;
    FILE* file = std::fopen(argv[1], "r");
    double value;
    while (std::fscanf(file, "%lf", &value) == 1) planes.push_back(value);
    double best = 1e9;
    int vertices = 0;
    for (int run = 0; run < std::atoi(argv[2]); run++) {
        voro::voronoicell cell;
        cell.init(-1, 1, -1, 1, -1, 1);
        double start = seconds();
        // A plane is given to voro++ by a vector and the displacement d of 2 n · x = d for a unit
        // n.
        for (size_t i = 0; i + 3 < planes.size(); i += 4)
            cell.plane(planes[i], planes[i + 1], planes[i + 2], 2 * planes[i + 3]);
        double spent = seconds() - start;
        if (spent < best) best = spent;
        vertices = cell.p;
    }
    std::printf("%.9f %d\n", best, vertices);
}
"#;

fn run_voro(planes: &[Plane]) -> Result<(f64, usize), &'static str> {
    let source = Scratch::new("voro.cc");
    let program = Scratch::new("voro");
    let numbers = Scratch::new("planes");
    let mut text = String::new();
    for plane in planes {
        let n = plane.normal();
        text += &format!("{:?} {:?} {:?} {:?}\n", n.x, n.y, n.z, plane.offset());
    }
    std::fs::write(&source.0, CPP).expect("the temporary folder is writable");
    std::fs::write(&numbers.0, text).expect("the temporary folder is writable");
    let mut compile = Command::new("c++");
    compile.arg("-O3").arg(&source.0);
    compile.args(std::env::var("CXXFLAGS").unwrap_or_default().split_whitespace());
    compile.arg("-lvoro++").arg("-o").arg(&program.0);
    output_of(compile)
        .ok_or("no C++ compiler with voro++ (Debian: g++, voro++-dev; or CXXFLAGS)")?;
    let mut run = Command::new(&program.0);
    run.arg(&numbers.0).arg(CHAIN_RUNS.to_string());
    let output = output_of(run).ok_or("the program failed")?;
    let mut words = output.split_whitespace();
    let seconds = words.next().and_then(|w| w.parse().ok());
    seconds.zip(words.next().and_then(|w| w.parse().ok())).ok_or("the program printed no time")
}

// ---- local cuts on a large mesh -----------------------------------------------------------------

fn local_cuts() {
    println!("local cuts, one corner each, spread over a geodesic sphere; CPU time");
    let mut first = f64::NAN;
    for frequency in [23, 71, 224] {
        let mesh = shape::geodesic(frequency, RADIUS);
        let faces = mesh.face_count();
        let count = 20_000.min(mesh.vertex_count() / 4);
        let step = mesh.vertex_count() / count;
        let elements: Vec<(VertexId, Plane)> = (0..count)
            .map(|i| VertexId::new(i * step))
            .map(|v| (v, shallow_plane(&mesh, v)))
            .collect();
        // The clock of a thread is coarse: short chains are run several times.
        let repeats = 40_000 / count;
        let mut halves = [0.0; 2];
        for _ in 0..repeats {
            let mut chain = CutChain::new(mesh.clone());
            for (half, elements) in
                halves.iter_mut().zip([&elements[..count / 2], &elements[count / 2..]])
            {
                let start = thread_seconds();
                for (v, plane) in elements {
                    chain.cut(plane, Reach::Local(&[*v]));
                }
                *half += (thread_seconds() - start) / (elements.len() * repeats) as f64;
            }
        }
        let mean = (halves[0] + halves[1]) / 2.0;
        first = if first.is_nan() { mean } else { first };
        println!(
            "  {faces:>9} faces {count:>6} cuts {:>8.3} µs a cut in the first half, {:>8.3} in the \
            second; {:.2} of the smallest {}",
            halves[0] * 1e6,
            halves[1] * 1e6,
            mean / first,
            verdict(mean / first <= FLAT_BAR)
        );
    }
}

/// A plane that cuts one corner of a convex mesh off, at a quarter of its shallowest edge.
fn shallow_plane(mesh: &Mesh, v: VertexId) -> Plane {
    let here = mesh.position(v);
    let normal = here.normalize();
    let fall = mesh
        .neighbours(v)
        .map(|u| normal.dot(here - mesh.position(u)))
        .fold(f64::INFINITY, f64::min);
    Plane::new(normal, here - normal * (0.25 * fall)).expect("a direction")
}

// ---- measuring ----------------------------------------------------------------------------------

/// A file in the temporary folder that goes with its owner.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        Self(std::env::temp_dir().join(format!("kerfold-bench-{}-{name}", std::process::id())))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = std::fs::remove_file(&self.0);
    }
}

fn output_of(mut command: Command) -> Option<String> {
    let output = command.output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

fn verdict(is_held: bool) -> &'static str {
    if is_held { "held" } else { "MISSED" }
}

fn best_of(runs: usize, mut work: impl FnMut()) -> f64 {
    let time = |_| {
        let start = thread_seconds();
        work();
        thread_seconds() - start
    };
    (0..runs).map(time).fold(f64::INFINITY, f64::min)
}
