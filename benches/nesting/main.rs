//! Nesting on four sets of pieces: `cargo bench --bench nesting` (all bars, about half an hour of
//! CPU time), or `cargo bench --bench nesting -- --quick` (one seed, ten seconds each), or with the
//! names of sets.
//!
//! `eff` is the number of sheets less one plus the used part of the last. Bars are medians of five
//! seeds. spyrrow (PyPI), which packs one endless strip without sheets and so has it easier, is
//! asked in the same run; without it that is said. Sheets have no margin and the spacing is 0.01 mm
//! for both. Last, ten thousand small pieces with default effort.

#![allow(clippy::print_stdout, reason = "a bench prints")]

#[path = "../clock/mod.rs"]
mod clock;

use clock::{peak_megabytes, process_seconds};
use std::io::Write as _;
use std::process::{Command, Stdio};

use glam::DVec2;
use kerfold::net::{MeshCounts, Net, Piece, PieceId, Proof};
use kerfold::sheet::{
    Labels, LetterParams, NestParams, SheetParams, SheetSet, SheetSize, StockParams, lay_out,
};
use kerfold::units::Length;
use sets::{Set, area, set};

mod sets;

/// Name, effort, sheets at most, eff at most.
const BARS: [(&str, u32, usize, f64); 8] = [
    ("a", 100, 4, 3.45),
    ("b", 100, 5, 5.0),
    ("c", 100, 3, 2.85),
    ("d", 100, 2, 2.0),
    ("a", 600, 4, 3.40),
    ("b", 600, 5, 4.6),
    ("c", 600, 3, 2.75),
    ("d", 600, 2, 2.0),
];
const SEEDS: [u64; 5] = [1, 2, 3, 4, 5];
const SPACING: f64 = 0.01;

fn main() {
    let args: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    if let Some(i) = args.iter().position(|a| a == "--many") {
        return many(args[i + 1].parse().expect("a number of pieces"));
    }
    let is_quick = args.iter().any(|a| a == "--quick");
    let names: Vec<&String> = args.iter().filter(|a| !a.starts_with("--")).collect();
    println!(
        "{:<4} {:>6} {:>7} {:>8} {:>7} {:>7} {:>8}  seeds",
        "set", "bound", "effort", "CPU s", "sheets", "eff", "bar"
    );
    for (name, effort, most_sheets, bar) in BARS {
        if (!names.is_empty() && !names.iter().any(|n| *n == name)) || (is_quick && effort > 100) {
            continue;
        }
        let set = set(name, 1);
        let seeds = if is_quick { &SEEDS[..1] } else { &SEEDS[..] };
        let mut runs: Vec<(f64, usize, f64)> =
            seeds.iter().map(|&seed| run(&set, effort, seed)).collect();
        runs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (eff, sheets, _) = runs[runs.len() / 2];
        let cpu = runs.iter().map(|r| r.2).sum::<f64>() / runs.len() as f64;
        let all: Vec<String> = runs.iter().map(|r| format!("{:.3}", r.0)).collect();
        let missed = if sheets > most_sheets || eff > bar { "MISSED" } else { "" };
        println!(
            "{name:<4} {:>6.2} {effort:>7} {cpu:>8.1} {sheets:>7} {eff:>7.3} {bar:>8.2}  {} \
            {missed}",
            set.bound,
            all.join(" ")
        );
        if effort == 100 {
            println!("     spyrrow, one strip, 20 s: {}", spyrrow(&set, 20));
        }
    }
    if names.is_empty() {
        let program = std::env::current_exe().expect("this program has a path");
        let output =
            Command::new(program).args(["--many", "10000"]).output().expect("it runs again");
        print!("{}", String::from_utf8_lossy(&output.stdout));
    }
}

fn run(set: &Set, effort: u32, seed: u64) -> (f64, usize, f64) {
    let nest = NestParams { nest_effort: effort, nest_seed: seed, ..NestParams::default() };
    let before = process_seconds();
    let result = laid(set, nest);
    let cpu = process_seconds() - before;
    let sheets = result.layout.sheets.len();
    let along = |p: DVec2| if set.sheet.x >= set.sheet.y { p.x } else { p.y };
    let last = result.layout.sheets.last().expect("pieces");
    let ends = last.placed.iter().flat_map(|p| p.apply_all(&set.pieces[p.piece.0])).map(along);
    (sheets as f64 - 1.0 + ends.fold(0.0, f64::max) / along(set.sheet), sheets, cpu)
}

fn laid(set: &Set, nest: NestParams) -> SheetSet {
    let piece = |(i, outline): (usize, &Vec<DVec2>)| Piece {
        id: PieceId(i),
        outline: outline.clone(),
        holes: Vec::new(),
        faces: Vec::new(),
    };
    let net = Net {
        scale: 1.0,
        counts: MeshCounts::default(),
        pieces: set.pieces.iter().enumerate().map(piece).collect(),
        folds: Vec::new(),
        seams: Vec::new(),
        rims: Vec::new(),
        proof: Proof::default(),
    };
    let params = SheetParams {
        stock: StockParams {
            sheet: SheetSize::of_mm(set.sheet.x, set.sheet.y),
            margin: Length::from_mm(0.0),
            spacing: Length::from_mm(SPACING),
            ..StockParams::default()
        },
        letter: LetterParams { labels: Labels::None, ..LetterParams::default() },
        nest,
        ..SheetParams::default()
    };
    lay_out(&net, &params).expect("all pieces fit")
}

/// So many copies of a convex piece or two, small ones, on sheets of 600 × 400 mm.
fn many(count: usize) {
    let mut set = set("a", 1);
    let pieces: Vec<Vec<DVec2>> = (0..count)
        .map(|i| set.pieces[i % set.pieces.len()].iter().map(|&p| p * 0.25).collect())
        .collect();
    set.pieces = pieces;
    let bound = set.pieces.iter().map(|p| area(p)).sum::<f64>() / (set.sheet.x * set.sheet.y);
    let before = process_seconds();
    let result = laid(&set, NestParams::default());
    println!(
        "{count} small pieces: {:.1} CPU s (bar 120), {:.0} MB (bar 2000), {} sheets, bound \
        {bound:.2}",
        process_seconds() - before,
        peak_megabytes(),
        result.layout.sheets.len()
    );
}

fn spyrrow(set: &Set, seconds: u32) -> String {
    const SCRIPT: &str = "
import json, sys, resource
try:
    import spyrrow
except ImportError:
    print('not installed (pip install spyrrow); no comparison is made'); sys.exit()
q = json.load(sys.stdin)
items = [spyrrow.Item(str(i), [tuple(c) for c in p], 1, None) for i, p in enumerate(q['pieces'])]
c = spyrrow.StripPackingConfig(early_termination=False, total_computation_time=q['seconds'], num_workers=1, seed=0, min_items_separation=q['spacing'])
s = spyrrow.StripPackingInstance('x', q['across'], items).solve(c)
print('eff %.3f, %.1f CPU s' % (s.width / q['along'], resource.getrusage(resource.RUSAGE_SELF).ru_utime))
";
    let pieces: Vec<Vec<[f64; 2]>> =
        set.pieces.iter().map(|p| p.iter().map(|q| q.to_array()).collect()).collect();
    let (along, across) = (set.sheet.max_element(), set.sheet.min_element());
    let question = format!(
        "{{\"pieces\": {pieces:?}, \"seconds\": {seconds}, \"spacing\": \
        {SPACING}, \"along\": {along}, \"across\": {across}}}"
    );
    let python = Command::new("python3")
        .args(["-c", SCRIPT])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn();
    let Ok(mut python) = python else {
        return "python3 is not installed; no comparison is made".to_owned();
    };
    if let Some(mut input) = python.stdin.take() {
        let _ = input.write_all(question.as_bytes());
    }
    let output =
        python.wait_with_output().map(|o| String::from_utf8_lossy(&o.stdout).trim().to_owned());
    output.unwrap_or_else(|error| error.to_string())
}
