//! Sierpinski polyhedra and Doo–Sabin at a million faces: seconds of processor time, bytes a face
//! at the peak, and whether time is linear.
//!
//! Bars: a million faces within a second and 300 bytes a face; from 1e4 to 1e6 faces the time for a
//! face at most doubles. Each case runs in a process of its own, since the peak of a process never
//! falls. Peer: none; TopMod, the only other program with these operators, is not packaged
//! anywhere, and its times of an earlier build are no measurement of this run.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use clock::{peak_megabytes, thread_seconds};
use std::process::{Command, ExitCode};

use kerfold::mesh::Mesh;
use kerfold::op::{OpContext, Scheme, SierpinskiParams, SubdivideParams, sierpinski, subdivide};
use kerfold::shape;

/// The best of so many runs counts, so that it is not the system handing out memory that is
/// measured.
const RUNS: usize = 3;
const SECONDS: f64 = 1.0;
const LINEAR: f64 = 2.0;
const BYTES: f64 = 300.0;
/// Rounds on an icosahedron that make some 1e4, 1e5 and 1e6 faces.
const ROUNDS: [u32; 3] = [5, 7, 8];

fn sierpinskied(mesh: &Mesh, rounds: u32) -> Mesh {
    sierpinski(mesh, &SierpinskiParams { rounds }, &OpContext::default()).expect("it fits").0
}

fn smoothed(mesh: &Mesh, rounds: u32) -> Mesh {
    subdivide(mesh, &SubdivideParams::new(Scheme::DooSabin, rounds), &OpContext::default())
        .expect("it fits")
        .0
}

/// One case in this process: faces, seconds, bytes.
fn case(name: &str, rounds: u32) {
    let start = shape::icosahedron(100.0);
    let before = peak_megabytes();
    let (mut seconds, mut faces, mut megabytes) = (f64::INFINITY, 0, f64::INFINITY);
    for _ in 0..RUNS {
        let start_time = thread_seconds();
        let made = if name == "sierpinski" {
            sierpinskied(&start, rounds)
        } else {
            smoothed(&start, rounds)
        };
        seconds = seconds.min(thread_seconds() - start_time);
        faces = made.face_count();
        // That of the first run.
        megabytes = megabytes.min(peak_megabytes() - before);
    }
    println!("{faces} {seconds} {}", megabytes * 1024.0 * 1024.0);
}

fn run(name: &str, rounds: u32) -> [f64; 3] {
    let program = std::env::current_exe().expect("this program");
    let output = Command::new(program)
        .args(["case", name, &rounds.to_string()])
        .output()
        .expect("it starts");
    let text = String::from_utf8(output.stdout).expect("text");
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|n| n.parse().ok()).collect();
    numbers.try_into().expect("three numbers")
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(at) = arguments.iter().position(|a| a == "case") {
        case(&arguments[at + 1], arguments[at + 2].parse().expect("rounds"));
        return ExitCode::SUCCESS;
    }
    let mut is_missed = false;
    for name in ["sierpinski", "doo-sabin"] {
        let mut shares = Vec::new();
        for rounds in ROUNDS {
            let [faces, seconds, bytes] = run(name, rounds);
            println!("{name}: {faces:.0} faces, {seconds:.3} s, {:.0} bytes a face", bytes / faces);
            shares.push(seconds / faces);
            if faces > 5e5 {
                let (per_million, per_face) = (seconds / faces * 1e6, bytes / faces);
                println!(
                    "{name}: {per_million:.2} s for a million faces (bar {SECONDS}), {per_face:.0} \
                    bytes a face (bar {BYTES})"
                );
                is_missed |= per_million > SECONDS || per_face > BYTES || per_face.is_nan();
            }
        }
        let ratio = shares[shares.len() - 1] / shares[0];
        println!(
            "{name}: a face takes {ratio:.2} times as long in the largest as in the smallest (bar \
            {LINEAR})"
        );
        is_missed |= ratio > LINEAR;
    }
    println!("peer: none, see the head of this file");
    if is_missed {
        println!("MISSED: a bar above");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
