//! Dual hulls against qhull, run in the same call on the same planes: `cargo bench --bench
//! dual_hull`.
//!
//! Planes tangent to a sphere and to a 10:3:1 ellipsoid at random points. Prints seconds of both,
//! two ratios, the counts and the peak memory of our first run. Times are medians. qhull's time is
//! the processor time that it reports for the hull alone, without reading or writing and without
//! the vertices of the solid; it has one thread. "CPU x" is that time over our processor time in
//! all threads, "wall x" over our time by the clock on the wall. The bar is compared with "CPU x",
//! which no number of processors can better. Without qhull (Debian: `qhull-bin`) only our own
//! numbers are printed and the comparison is named as missing.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use clock::{peak_megabytes, process_seconds};
use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use glam::DVec3;
use kerfold::geom::hull::{Form, HalfSpace, Intersect, Polytope, intersect};

/// What the project promises: how many times faster than qhull at each size.
const BARS: [(usize, f64); 3] = [(10_000, 10.0), (100_000, 10.0), (1_000_000, 15.0)];
/// Of so many runs of qhull the median counts; of ours of at least five.
const QHULL_RUNS: usize = 3;
/// The most memory that a million planes may take, in MB.
const MOST_MEGABYTES: f64 = 250.0;

fn main() {
    // Each case runs in a process of its own, so that its peak memory is its own.
    let args: Vec<String> = std::env::args().collect();
    if let Some(i) = args.iter().position(|a| a == "--case") {
        let n = args[i + 2].parse().expect("a number of planes");
        return run_case(&args[i + 1], n);
    }
    let qhull = qhull_version();
    match &qhull {
        Some(version) => println!("peer: {version}"),
        None => println!("peer: qhull is not installed (Debian: qhull-bin); no comparison is made"),
    }
    println!("the bar is compared with CPU x");
    println!(
        "{:<10} {:>8} {:>9} {:>9} {:>9} {:>7} {:>7} {:>5} {:>6}  counts",
        "shape", "planes", "wall s", "CPU s", "qhull s", "wall x", "CPU x", "bar", "MB"
    );
    for shape in ["sphere", "ellipsoid"] {
        for (n, bar) in BARS {
            let ours = own_process(shape, n);
            let theirs = qhull.as_ref().map(|_| run_qhull(&planes(shape, n)));
            let [wall, cpu, megabytes] = ours.numbers;
            let ratio = |own: f64| theirs.map_or("-".to_owned(), |t| format!("{:.1}", t / own));
            let (wall_ratio, cpu_ratio) = (ratio(wall), ratio(cpu));
            let missed = theirs.is_some_and(|t| t / cpu < bar)
                || (n == 1_000_000 && megabytes > MOST_MEGABYTES);
            let theirs = theirs.map_or("-".to_owned(), |t| format!("{t:.3}"));
            let verdict = if missed { "MISSED" } else { "" };
            println!(
                "{shape:<10} {n:>8} {wall:>9.4} {cpu:>9.4} {theirs:>9} {wall_ratio:>7} \
                {cpu_ratio:>7} {bar:>5} {megabytes:>6.0}  {} {verdict}",
                ours.counts
            );
        }
    }
}

struct Ours {
    /// Wall seconds, CPU seconds, peak megabytes.
    numbers: [f64; 3],
    counts: String,
}

fn own_process(shape: &str, n: usize) -> Ours {
    let program = std::env::current_exe().expect("this program has a path");
    let output = Command::new(program)
        .args(["--case", shape, &n.to_string()])
        .output()
        .expect("it runs again");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let words: Vec<&str> = text.split_whitespace().collect();
    assert!(
        output.status.success() && words.len() > 3,
        "the case failed: {}",
        String::from_utf8_lossy(&output.stderr)
    );
    Ours {
        numbers: [0, 1, 2].map(|i| words[i].parse().expect("a number")),
        counts: words[3..].join(" "),
    }
}

fn run_case(shape: &str, n: usize) {
    let planes = planes(shape, n);
    let repeats = (5_000_000 / n).clamp(5, 201);
    let (mut wall, mut cpu, mut megabytes, mut polytope) =
        (Vec::new(), Vec::new(), f64::INFINITY, Polytope::default());
    for _ in 0..repeats {
        drop(std::mem::take(&mut polytope));
        let (start, cpu_start) = (Instant::now(), process_seconds());
        let options = Intersect { form: Form::Simple, ..Intersect::default() };
        polytope = intersect(&planes, &options).expect("bounded");
        wall.push(start.elapsed().as_secs_f64());
        cpu.push(process_seconds() - cpu_start);
        // One hull is what a run of the program makes; later ones meet memory in pieces.
        megabytes = megabytes.min(peak_megabytes());
    }
    let (wall, cpu) = (median(wall), median(cpu));
    let counts = [polytope.faces.len(), polytope.edge_count(), polytope.vertices.len()];
    assert_eq!(counts, [n, 3 * n - 6, 2 * n - 4], "the counts are wrong");
    println!("{wall} {cpu} {megabytes} F {} E {} V {}", counts[0], counts[1], counts[2]);
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn planes(shape: &str, n: usize) -> Vec<HalfSpace> {
    let axes = if shape == "ellipsoid" { DVec3::new(10.0, 3.0, 1.0) } else { DVec3::ONE };
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut signed = move || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let mut on_sphere = move || loop {
        let (u, v) = (signed(), signed());
        let s = u * u + v * v;
        if s < 1.0 {
            let radius = 2.0 * (1.0 - s).sqrt();
            return DVec3::new(u * radius, v * radius, 1.0 - 2.0 * s);
        }
    };
    // The tangent plane at axes·u has the normal u / axes and the offset 1, scaled to unit length.
    (0..n)
        .map(|_| {
            let normal = on_sphere() / axes;
            HalfSpace { normal: normal.normalize(), offset: 1.0 / normal.length() }
        })
        .collect()
}

fn qhull_version() -> Option<String> {
    let output = Command::new("qhull").arg("-V").stdin(Stdio::null()).output().ok()?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The CPU seconds that qhull reports for the intersection about the origin.
fn run_qhull(planes: &[HalfSpace]) -> f64 {
    let mut input = format!("4\n{}\n", planes.len());
    for HalfSpace { normal: n, offset } in planes {
        writeln!(input, "{:?} {:?} {:?} {:?}", n.x, n.y, n.z, -offset).expect("a string grows");
    }
    let path = std::env::temp_dir().join(format!("kerfold-bench-{}.txt", std::process::id()));
    std::fs::write(&path, input).expect("the temporary folder is writable");
    let seconds = (0..QHULL_RUNS).map(|_| qhull_seconds(&path)).collect();
    std::fs::remove_file(&path).expect("the file was there");
    median(seconds)
}

fn qhull_seconds(input: &Path) -> f64 {
    let output =
        Command::new("qhull").args(["H0,0,0", "s", "TI"]).arg(input).output().expect("qhull runs");
    let text = String::from_utf8_lossy(&output.stderr);
    let line = text.lines().find(|line| line.contains("CPU seconds to compute"));
    let seconds =
        line.and_then(|line| line.split_whitespace().last()).and_then(|word| word.parse().ok());
    seconds.unwrap_or_else(|| panic!("qhull does not tell its time: {text}"))
}
