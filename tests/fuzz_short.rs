//! The bodies of the fuzz targets on damaged fixtures, always the same ones: a short run of what
//! `cargo fuzz` does for hours.

#[path = "../fuzz/src/lib.rs"]
mod targets;

use std::path::Path;
use std::time::{Duration, Instant};

/// Damaged files for each reader, or as many as `KERFOLD_FUZZ_ROUNDS` says, and the bytes of the
/// longest one that is taken as a seed.
const ROUNDS: usize = 400;
const LONGEST: usize = 20_000;
/// No file of that size may take longer, in a build without optimisation on a busy machine.
const SLOWEST: Duration = Duration::from_secs(10);

/// What else a reader knows that no fixture says.
const WORDS: &[&str] = &[
    "0",
    "-1",
    "1e999",
    "nan",
    "4294967296",
    "1,5",
    "#",
    "\\\n",
    "\r\n",
    "\0",
    "\u{feff}",
    "ä",
    "\"",
    "[[",
    "{",
    "}",
    "end",
    "f 1 2 3\n",
    "v 0 0 0 2\n",
    "solid",
    "element face 9\n",
    "tristrips",
    "all",
    "not",
    "sides>3",
    "step",
    "offset.0",
    "<use href='#a'/>",
    "ELLIPSE",
    "endobj",
    "\"mesh\":0",
    "\"count\":99999999999",
    "/Length",
];

fn rounds() -> usize {
    let asked = std::env::var("KERFOLD_FUZZ_ROUNDS").ok();
    asked.map_or(ROUNDS, |text| text.parse().expect("a number of rounds"))
}

struct Dice(u64);

impl Dice {
    fn below(&mut self, count: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % count
    }

    /// A copy of a file with some damage: cut off, changed, doubled, or with a word thrown in.
    fn damaged(&mut self, whole: &[u8]) -> Vec<u8> {
        let mut bytes = whole.to_vec();
        for _ in 0..=self.below(4) {
            let at = self.below(bytes.len() + 1);
            match self.below(6) {
                0 => bytes.truncate(at),
                1 | 2 if at < bytes.len() => bytes[at] = self.below(256) as u8,
                3 => {
                    let end = (at + self.below(40)).min(bytes.len());
                    let piece = bytes[at..end].to_vec();
                    let place = self.below(bytes.len() + 1);
                    bytes.splice(place..place, piece);
                }
                4 => {
                    let end = (at + self.below(20)).min(bytes.len());
                    bytes.drain(at..end);
                }
                _ => {
                    let word = WORDS[self.below(WORDS.len())];
                    bytes.splice(at..at, word.bytes());
                }
            }
        }
        bytes
    }
}

/// Seeds for a target: fixtures of its format, and texts that are too short for a file.
fn seeds(target: &str) -> Vec<Vec<u8>> {
    let (folders, ending): (&[&str], &str) = match target {
        "obj" | "off" | "ply" | "stl" | "glb" | "3mf" => {
            (&["fixtures/meshes", "fixtures/bad"], target)
        }
        "svg" | "dxf" | "pdf" => (&["fixtures/lint"], target),
        "recipe" => (&["fixtures/recipes", "fixtures/bad-recipes"], "toml"),
        "planes" => (&["fixtures/planes"], "csv"),
        _ => (&[], ""),
    };
    let mut seeds: Vec<Vec<u8>> = match target {
        "points" => {
            vec![b"# axis\n1,2,3\n-4 0.5,6e1\n".into(), b"v 1 2 3\nv 4 5 6\nl 2 1\n".into()]
        }
        "heights" => vec![
            b"y\\x,0,1,2\n0,1,1,1\n1,1,2,1\n".into(),
            b"x;y;z\n0;0;1,5\n1;0;2\n0;1;1\n1;1;0\n".into(),
        ],
        "seams" => vec![b"0 1 # a seam\n2 3\n".into(), b"v 0 0 0\nl 1 2 4\nl -1 -2\n".into()],
        "pieces" => vec![PIECES.into()],
        "order" => vec![
            br#"{"units": "mm", "pieces": [{"outline": [[0,0],[9,0],[9,9]], "quantity": 2}]}"#
                .into(),
            PIECES.into(),
        ],
        "select" => vec![
            b"all & !(sides=5 | valence>3)".into(),
            b"along=z angle<30deg".into(),
            b"0,3-7,hamiltonian".into(),
        ],
        _ => Vec::new(),
    };
    for folder in folders {
        let entries = std::fs::read_dir(Path::new(folder)).expect("fixtures");
        let mut paths: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
        paths.sort();
        let is_meant = |path: &std::path::PathBuf| path.extension().is_some_and(|e| e == ending);
        let files =
            paths.into_iter().filter(is_meant).map(|p| std::fs::read(p).expect("a fixture"));
        seeds.extend(files.filter(|bytes| bytes.len() <= LONGEST));
    }
    assert!(!seeds.is_empty(), "no seeds for {target}");
    seeds
}

/// A triangle as `pieces.json`.
const PIECES: &str = r#"{ "command": "kerfold", "units": "mm", "scale": 1.0,
"mesh": {"vertices": 3, "edges": 3, "faces": 1}, "pieces": [{"id": "P01",
"outline": [[0.0,0.0],[9.0,0.0],[0.0,9.0]], "holes": [], "faces": [{"face": 0,
"vertices": [0,1,2], "polygon": [[0.0,0.0],[9.0,0.0],[0.0,9.0]]}]}], "folds": [], "seams": [],
"rims": [{"edge": [0,1], "piece": "P01", "face": 0, "segment": [[0.0,0.0],[9.0,0.0]]}],
"proof": {"congruence_mm": 0.0, "refold_mm": 0.0, "overlaps": 0} }"#;

#[test]
fn readers_take_or_refuse_any_bytes() {
    for (name, body) in targets::READERS {
        let seeds = seeds(name);
        let mut dice = Dice(name.bytes().map(u64::from).sum());
        seeds.iter().for_each(|seed| body(seed));
        for round in 0..rounds() {
            let bytes = dice.damaged(&seeds[round % seeds.len()]);
            let start = Instant::now();
            body(&bytes);
            let took = start.elapsed();
            assert!(took < SLOWEST, "{name}, round {round}: {took:?} for {} bytes", bytes.len());
        }
    }
}

#[test]
fn chains_of_operators_are_sound_and_their_files_are_read_back() {
    let mut dice = Dice(1);
    for _ in 0..rounds() / 8 {
        let bytes: Vec<u8> = (0..30).map(|_| dice.below(256) as u8).collect();
        targets::chains(&bytes);
    }
}

/// What fuzzing found: each file lies under the name of its target, and went wrong there once.
#[test]
fn old_finds_stay_mended() {
    let mut count = 0;
    for entry in std::fs::read_dir("fixtures/finds").expect("finds") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        let (target, _) = name.split_once('-').expect("a target and a number");
        let reader = targets::READERS.iter().find(|(name, _)| *name == target);
        assert!(reader.is_some() || target == "chains", "{name} is for no target");
        let body = reader.map_or(targets::chains as fn(&[u8]), |(_, body)| *body);
        body(&std::fs::read(&path).expect("a find"));
        count += 1;
    }
    assert!(count >= 2, "{count} finds");
}
