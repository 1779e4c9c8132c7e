//! Seams of D-forms against their bars: `cargo bench --bench seams` (`-- quick` leaves out 5000
//! faces).
//!
//! Counts of matchings against exhaustive search; the proof for Tutte's graph; two pieces without
//! overlap of random convex 3-valent meshes; the least-weight matching of 100 000 edges, and of a
//! smaller mesh against networkx in the same run (the same sum, and how many times faster). Times
//! are CPU seconds of one thread. Without networkx the comparison is named as missing.

#![allow(clippy::print_stdout, reason = "a bench prints")]

mod clock;

use clock::thread_seconds;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::process::{Command, Stdio};

use kerfold::io::{ReadOptions, read_mesh};
use kerfold::mesh::Mesh;
use kerfold::progress::Silent;
use kerfold::seam::{
    TwoPieceSearch, fold_sum, fold_weight, is_perfect_matching, least_matching, piece_count, table,
};
use kerfold::shape::{SolidParams, random_tangent_polytope, solid};
use kerfold::unfold::{MeshSource, PiecesMode, Seams, UnfoldParams, unfold};

/// Matchings by the number of pieces that they leave, counted by exhaustive search.
const COUNTS: [(&str, &[(usize, usize)]); 7] = [
    ("tetrahedron", &[(2, 3)]),
    ("cube", &[(2, 6), (3, 3)]),
    ("dodecahedron", &[(2, 30), (4, 6)]),
    ("truncated-tetrahedron", &[(2, 3), (3, 4), (5, 1)]),
    ("truncated-cube", &[(2, 6), (3, 3), (4, 16), (6, 6), (9, 1)]),
    ("prism-6", &[(2, 8), (3, 10), (4, 2)]),
    ("tutte", &[(3, 168), (4, 444), (5, 312), (6, 36)]),
];
/// The proof that Tutte's graph has no two-piece seam, in seconds.
const TUTTE: f64 = 1.0;
/// Faces, seeds, and what the slowest may take in seconds.
const TWO_PIECES: [(usize, u64, f64); 5] = [
    (100, 20, f64::INFINITY),
    (200, 20, f64::INFINITY),
    (500, 20, f64::INFINITY),
    (1000, 20, 1.0),
    (5000, 3, 30.0),
];
/// The least-weight matching of 100 000 edges, in seconds.
const MATCHING: f64 = 5.0;

fn main() {
    let quick = std::env::args().any(|a| a == "quick");
    counts();
    proof();
    for (faces, seeds, bar) in TWO_PIECES.into_iter().filter(|row| !quick || row.0 < 5000) {
        two_pieces(faces, seeds, bar);
    }
    matching();
    against_networkx();
}

fn counts() {
    for (name, wanted) in COUNTS {
        let mesh = named(name);
        let (rows, seconds) =
            timed(|| table(&mesh, usize::MAX, &Silent).expect("a 3-valent solid"));
        let mut found = BTreeMap::new();
        rows.iter().for_each(|row| *found.entry(row.pieces).or_insert(0) += row.orbit_size);
        let found: Vec<(usize, usize)> = found.into_iter().collect();
        let all: usize = found.iter().map(|&(_, n)| n).sum();
        let list: Vec<String> = found.iter().map(|(pieces, n)| format!("{n}×{pieces}")).collect();
        println!(
            "counts       {name:<22} {all:>4} matchings, {:>3} up to symmetry, pieces {:<34} \
            {seconds:.4} s{}",
            rows.len(),
            list.join(" "),
            verdict(found == wanted)
        );
    }
}

fn named(name: &str) -> Mesh {
    if name == "tutte" {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/meshes/tutte.obj");
        return read_mesh(path.as_ref(), &ReadOptions::default())
            .expect("the fixture is there")
            .mesh;
    }
    solid(&SolidParams { name: name.parse().expect("a name"), edge: None, size: None })
        .expect("a solid")
}

fn proof() {
    let mesh = named("tutte");
    let (conflicts, seconds) = timed(|| {
        let mut search = TwoPieceSearch::new(&mesh, &Silent).expect("3-valent");
        assert!(
            search.next_candidate(&Silent).is_none() && search.is_exhausted(),
            "a two-piece seam of Tutte's graph"
        );
        search.proof().to_string()
    });
    println!(
        "proof        tutte: {conflicts}: {seconds:.4} s, bar {TUTTE} s{}",
        verdict(seconds < TUTTE)
    );
    let params = UnfoldParams { pieces: PiecesMode::Count(2), ..UnfoldParams::default() };
    let (refused, seconds) =
        timed(|| unfold(&mesh, &Seams::Free, &params, &MeshSource::default(), &Silent).is_err());
    println!(
        "proof        tutte: `unfold --pieces 2` refuses: {seconds:.4} s, bar {TUTTE} s{}",
        verdict(refused && seconds < TUTTE)
    );
}

fn two_pieces(faces: usize, seeds: u64, bar: f64) {
    let params = UnfoldParams { pieces: PiecesMode::Count(2), ..UnfoldParams::default() };
    let (mut found, mut slowest, mut all, mut above) = (0, 0.0_f64, 0.0, 0.0);
    for seed in 0..seeds {
        let mesh = random_tangent_polytope(faces, seed);
        let (net, seconds) =
            timed(|| unfold(&mesh, &Seams::Free, &params, &MeshSource::default(), &Silent));
        (slowest, all) = (slowest.max(seconds), all + seconds);
        let Ok(net) = net else { continue };
        let folds: Vec<_> = net.folds.iter().map(|f| kerfold::mesh::EdgeId::new(f.id.0)).collect();
        found += usize::from(net.pieces.len() == 2 && net.proof.overlaps == 0);
        let least = fold_sum(&mesh, &least_matching(&mesh, &Silent).expect("3-valent"));
        above += fold_sum(&mesh, &folds) / least - 1.0;
    }
    println!(
        "two pieces   n = {faces:>5}: {found} of {seeds} seeds, slowest {slowest:.3} s, mean {:.3} \
        s, bar {bar} s, fold sum {:.1} % \
         above the least matching{}",
        all / seeds as f64,
        100.0 * above / seeds as f64,
        verdict(found as u64 == seeds && slowest < bar)
    );
}

fn matching() {
    for (faces, bar) in [(33_336, MATCHING), (333_336, f64::INFINITY)] {
        let mesh = random_tangent_polytope(faces, 1);
        let (folds, seconds) = timed(|| least_matching(&mesh, &Silent).expect("3-valent"));
        println!(
            "matching     {} edges: {seconds:.3} s, bar {bar} s, fold sum {:.9}, {} pieces{}",
            mesh.edge_count(),
            fold_sum(&mesh, &folds),
            piece_count(&mesh, &folds),
            verdict(is_perfect_matching(&mesh, &folds) && seconds < bar)
        );
    }
}

/// The same small matching by networkx, which is in Python, but the only other one that many people
/// have at hand.
fn against_networkx() {
    const PROGRAM: &str = "import sys,time,networkx as n\n\
        g=n.Graph();g.add_weighted_edges_from((int(a),int(b),float(w)) for a,b,w in map(str.split,sys.stdin))\n\
        t=time.process_time();m=n.min_weight_matching(g)\n\
        print(time.process_time()-t,repr(sum(g[a][b]['weight'] for a,b in m)),len(m),n.__version__)";
    let mesh = random_tangent_polytope(400, 1);
    let (folds, ours) = timed(|| least_matching(&mesh, &Silent).expect("3-valent"));
    let mut text = String::new();
    for e in mesh.edges() {
        let [a, b] = mesh.edge_vertices(e);
        writeln!(text, "{} {} {:?}", a.index(), b.index(), fold_weight(&mesh, e))
            .expect("a string grows");
    }
    let path = std::env::temp_dir().join(format!("kerfold-bench-seams-{}.txt", std::process::id()));
    std::fs::write(&path, text).expect("the temporary folder is writable");
    let input = std::fs::File::open(&path).expect("just written");
    let output =
        Command::new("python3").args(["-c", PROGRAM]).stdin(input).stderr(Stdio::null()).output();
    std::fs::remove_file(&path).expect("the file was there");
    let told = output
        .ok()
        .filter(|o| o.status.success())
        .map(|o| String::from_utf8_lossy(&o.stdout).into_owned());
    let Some(told) = told else {
        println!("peer         networkx (Python) is not installed; no comparison is made");
        return;
    };
    let words: Vec<&str> = told.split_whitespace().collect();
    let [theirs, their_sum] = [0, 1].map(|i| words[i].parse::<f64>().expect("a number"));
    let sum = fold_sum(&mesh, &folds);
    println!(
        "peer         networkx {}, {} edges: {theirs:.3} s against {ours:.5} s, {:.0} times; sums \
        {their_sum:.12} and {sum:.12}{}",
        words[3],
        mesh.edge_count(),
        theirs / ours,
        verdict((sum - their_sum).abs() <= 1e-9 * sum)
    );
}

fn verdict(holds: bool) -> &'static str {
    if holds { "" } else { "  MISSED" }
}

/// What came out and the processor seconds of this thread that it took.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let before = thread_seconds();
    let result = work();
    (result, thread_seconds() - before)
}
