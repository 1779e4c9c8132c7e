//! What the program leaves on the disk: whole files or none, nothing of an earlier run unsaid,
//! names in any letters; and what it says of files that are not right.

#![cfg(unix)]

use std::ffi::{OsStr, OsString};
use std::fs;
use std::os::unix::ffi::{OsStrExt as _, OsStringExt as _};
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A folder of its own, removed at the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let folder =
            std::env::temp_dir().join(format!("kerfold-whole-{}-{name}", std::process::id()));
        drop(fs::remove_dir_all(&folder));
        fs::create_dir_all(&folder).expect("a folder");
        Self(folder)
    }

    fn run<S: AsRef<OsStr>>(&self, args: &[S]) -> (i32, String) {
        let output = Command::new(env!("CARGO_BIN_EXE_kerfold"))
            .args(args)
            .current_dir(&self.0)
            .output()
            .expect("the program runs");
        said(&output)
    }

    fn names(&self, folder: impl AsRef<Path>) -> Vec<String> {
        let entries = fs::read_dir(self.0.join(folder)).expect("a folder");
        let mut names: Vec<_> = entries
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    fn write(&self, name: impl AsRef<Path>, bytes: impl AsRef<[u8]>) {
        fs::write(self.0.join(name), bytes).expect("a file");
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).expect("a file")
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        drop(fs::remove_dir_all(&self.0));
    }
}

/// The exit code, and all that was printed.
fn said(output: &Output) -> (i32, String) {
    let text = [&output.stdout[..], &output.stderr[..]].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    assert!(!text.contains("panicked"), "{text}");
    (output.status.code().expect("it ends by itself"), text)
}

fn ok<S: AsRef<OsStr>>(scratch: &Scratch, args: &[S]) -> String {
    let (code, text) = scratch.run(args);
    assert_eq!(code, 0, "{text}");
    text
}

#[test]
fn both_halves_of_a_cut_come_or_neither() {
    let scratch = Scratch::new("both");
    ok(&scratch, &["solid", "cube", "-q", "-o", "c.obj"]);
    fs::create_dir(scratch.0.join("half-normal.obj")).expect("a folder in the way");
    let cut = [
        "cut", "plane", "c.obj", "--normal", "z", "--point", "0,0,0", "--keep", "both", "-q", "-o",
        "half.obj",
    ];
    let (code, text) = scratch.run(&cut);
    assert_eq!(code, 2, "{text}");
    assert_eq!(scratch.names(""), ["c.obj", "half-normal.obj"]);
    fs::remove_dir(scratch.0.join("half-normal.obj")).expect("out of the way");
    ok(&scratch, &cut);
    assert_eq!(scratch.names(""), ["c.obj", "half-normal.obj", "half-reverse.obj"]);
}

#[test]
fn sheets_of_an_earlier_run_are_named_or_removed() {
    let scratch = Scratch::new("sheets");
    ok(&scratch, &["solid", "cube", "--size", "100", "-q", "-o", "c.obj"]);
    let unfold = |more: &[&str]| {
        let args = ["unfold", "c.obj", "--pieces", "faces", "-o", "out"];
        ok(&scratch, &[&args, more].concat())
    };
    unfold(&["--sheet", "130x130"]);
    let names = scratch.names("out");
    let sheets = |ending: &str| {
        names.iter().filter(|n| n.starts_with("sheet-") && n.ends_with(ending)).count()
    };
    assert_eq!((sheets(".svg"), sheets(".png")), (6, 6));
    scratch.write("out/sheet-07.svg", "<svg/>");
    scratch.write("out/own.txt", "mine");
    let named = unfold(&["--sheet", "600x400"]);
    assert!(named.contains("sheet-02.svg") && named.contains("--clean"), "{named}");
    assert!(scratch.names("out").contains(&"sheet-06.svg".to_owned()));
    let removed = unfold(&["--sheet", "600x400", "--clean"]);
    assert!(removed.contains("removed") && removed.contains("sheet-05.svg"), "{removed}");
    assert_eq!(
        scratch.names("out"),
        [
            "assembly.txt",
            "layout.json",
            "own.txt",
            "pieces.json",
            "sheet-01.png",
            "sheet-01.svg",
            "sheet-07.svg",
            "sheets.html"
        ]
    );
    let quiet = unfold(&["--sheet", "600x400"]);
    assert!(!quiet.contains("earlier run"), "{quiet}");
}

/// SIGTERM and SIGHUP end the search for a layout as Ctrl-C does: the best so far is written.
#[test]
fn signals_of_schedulers_end_the_work_cleanly() {
    for signal in ["TERM", "HUP"] {
        let scratch = Scratch::new(signal);
        scratch.write(
            "p.json",
            r#"{"pieces": [{"outline": [[0,0],[90,0],[60,80],[20,30]], "quantity": 60}]}"#,
        );
        let args = ["nest", "p.json", "--sheet", "600x400", "--effort", "1000", "-o", "out"];
        let mut child = Command::new(env!("CARGO_BIN_EXE_kerfold"))
            .args(args)
            .current_dir(&scratch.0)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the program runs");
        std::thread::sleep(Duration::from_secs(2));
        assert!(child.try_wait().expect("a child").is_none(), "it ended before the signal");
        let id = child.id().to_string();
        assert!(
            Command::new("kill")
                .args([&format!("-{signal}"), &id])
                .status()
                .expect("kill")
                .success()
        );
        let start = Instant::now();
        let (code, text) = said(&child.wait_with_output().expect("it ends"));
        assert!(start.elapsed() < Duration::from_secs(60), "{:?}", start.elapsed());
        assert_eq!(code, 0, "{text}");
        assert!(text.contains("stopped"), "{text}");
        assert!(!scratch.names("out").iter().any(|name| name.starts_with('.')));
    }
}

#[test]
fn names_that_are_no_utf8_are_names() {
    let scratch = Scratch::new("names");
    let name = |text: &[u8]| OsString::from_vec(text.to_vec());
    let args = |words: &[&[u8]]| words.iter().map(|word| name(word)).collect::<Vec<_>>();
    ok(&scratch, &args(&[b"solid", b"cube", b"--json", b"-o", b"n\xff.obj"]));
    ok(&scratch, &args(&[b"info", b"n\xff.obj"]));
    ok(&scratch, &args(&[b"info", b"n\xff.obj", b"--json"]));
    ok(&scratch, &args(&[b"check", b"n\xff.obj", b"--report", b"r\xff.html"]));
    ok(&scratch, &args(&[b"render", b"n\xff.obj", b"--json", b"-o", b"p\xff.png"]));
    ok(&scratch, &args(&[b"unfold", b"n\xff.obj", b"--json", b"-o", b"o\xff"]));
    ok(&scratch, &args(&[b"nest", b"o\xff/pieces.json", b"--json", b"-o", b"s\xff"]));
    ok(&scratch, &args(&[b"verify", b"o\xff/pieces.json", b"n\xff.obj", b"--json"]));
    ok(&scratch, &args(&[b"lint", b"o\xff/sheet-01.svg", b"--json"]));
    ok(
        &scratch,
        &args(&[b"panels", b"n\xff.obj", b"--thickness", b"1mm", b"--json", b"-o", b"q\xff"]),
    );
    ok(&scratch, &args(&[b"kerf-test", b"--thickness", b"3", b"--json", b"-o", b"k\xff.svg"]));
    let folder = scratch.0.join(OsStr::from_bytes(b"f\xff"));
    fs::create_dir(&folder).expect("a folder");
    let recipe = "[[step]]\nsolid = \"cube\"\n";
    fs::write(folder.join(OsStr::from_bytes(b"r\xff.toml")), recipe).expect("a recipe");
    ok(&scratch, &args(&[b"run", b"f\xff/r\xff.toml", b"--json", b"-o", b"t\xff"]));
    ok(&scratch, &args(&[b"gallery", b"f\xff", b"--json", b"-o", b"g\xff"]));
    let (code, text) = scratch.run(&args(&[b"info", b"missing\xff.obj"]));
    assert!(code == 2 && text.contains("missing\u{fffd}.obj"), "{text}");
    let (code, text) = scratch.run(&args(&[b"check", b"n\xff.obj", b"--profile", b"\xff"]));
    assert_eq!(code, 2, "{text}");
}

#[test]
fn marks_and_wide_letters_before_json_and_toml_are_no_fault() {
    let scratch = Scratch::new("marks");
    let wide = |text: &str| -> Vec<u8> {
        format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_le_bytes).collect()
    };
    let pieces = r#"{"pieces": [{"outline": [[0,0],[90,0],[60,80]]}]}"#;
    let recipe = "[[step]]\nsolid = \"cube\"\n";
    let planes = "1,0,0,1\n-1,0,0,1\n0,1,0,1\n0,-1,0,1\n0,0,1,1\n0,0,-1,1\n";
    for (name, text, verb) in [
        ("p.json", pieces, &["nest"][..]),
        ("r.toml", recipe, &["run"]),
        ("w.csv", planes, &["hull", "--planes"]),
    ] {
        for bytes in [format!("\u{feff}{text}").into_bytes(), wide(text)] {
            scratch.write(name, bytes);
            let out = if verb[0] == "hull" { "h.obj" } else { "out" };
            ok(&scratch, &[verb, &[name, "-q", "-o", out]].concat());
        }
    }
    ok(&scratch, &["solid", "cube", "-q", "-o", "c.obj"]);
    ok(&scratch, &["unfold", "c.obj", "-q", "-o", "u"]);
    scratch.write("u/pieces.json", format!("\u{feff}{}", scratch.text("u/pieces.json")));
    ok(&scratch, &["verify", "u/pieces.json", "c.obj"]);
}

#[test]
fn verify_looks_at_the_names_of_folds_and_the_angles_of_seams() {
    let scratch = Scratch::new("verify");
    ok(&scratch, &["solid", "cube", "-q", "-o", "c.obj"]);
    ok(&scratch, &["unfold", "c.obj", "-q", "-o", "u"]);
    let good = scratch.text("u/pieces.json");
    ok(&scratch, &["verify", "u/pieces.json", "c.obj"]);
    let seams = good.find("\"seams\"").expect("seams");
    let angle = good[seams..].find("\"fold_angle\": ").expect("an angle") + seams + 14;
    let bad_angle = format!("{}-{}", &good[..angle], &good[angle..]);
    for (bad, code) in [(good.replacen("mountain", "valley", 1), "F428"), (bad_angle, "F427")] {
        assert_ne!(bad, good);
        scratch.write("u/pieces.json", bad);
        let (exit, text) = scratch.run(&["verify", "u/pieces.json", "c.obj"]);
        assert!(exit == 1 && text.contains(code), "{text}");
    }
}

#[test]
fn a_fault_in_a_recipe_is_shown_in_its_line() {
    let scratch = Scratch::new("recipe");
    fs::create_dir(scratch.0.join("f")).expect("a folder");
    scratch.write("f/lamp.toml", "name = \"Würfel\"\n[[step]]\nsolid = \"cube\"\nszie = \"3mm\"\n");
    let (code, text) = scratch.run(&["run", "f/lamp.toml", "-o", "out"]);
    assert_eq!(code, 2);
    for part in
        ["line 4, column 1: ", "(E702)", "f/lamp.toml:4:1", "4 | szie = \"3mm\"", "^^^^ did you"]
    {
        assert!(text.contains(part), "{text}\n lacks {part}");
    }
    scratch.write("f/lamp.toml", "[[step]]\nsolid = \"cube\"\nsize.\"größe\" = \"ü\"\n");
    let (code, text) = scratch.run(&["run", "f/lamp.toml", "-o", "out"]);
    assert!(code == 2 && text.contains("line 3, column 1: `size` takes a value"), "{text}");
    // A gallery of nothing else has the same to say, and a page.
    let (code, text) = scratch.run(&["gallery", "f", "-o", "g"]);
    assert!(code == 2 && text.contains("line 3, column 1: `size` takes a value"), "{text}");
    assert_eq!(scratch.names("g"), ["index.html"]);
}
