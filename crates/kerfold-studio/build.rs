//! Builds the page with npm from the lock file, and lists its files for the program.
//!
//! npm works on a copy in the build folder, so that the source stays as it is. Node is needed to
//! build this crate only; the program that comes out needs none.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// What the page is made of.
const SOURCES: [&str; 6] =
    ["index.html", "package.json", "package-lock.json", "tsconfig.json", "vite.config.ts", "src"];

fn main() {
    let web = PathBuf::from(variable("CARGO_MANIFEST_DIR")).join("web");
    let out = PathBuf::from(variable("OUT_DIR"));
    for source in SOURCES {
        println!("cargo::rerun-if-changed=web/{source}");
    }
    // A page that somebody has built before: packagers that build without a network.
    println!("cargo::rerun-if-env-changed=KERFOLD_STUDIO_PAGE");
    println!("cargo::rerun-if-changed=build.rs");
    let dist = match env::var_os("KERFOLD_STUDIO_PAGE") {
        Some(folder) => {
            println!("cargo::rerun-if-changed={}", folder.to_string_lossy());
            PathBuf::from(folder)
        }
        None => build(&web, &out.join("web")),
    };
    let mut files = Vec::new();
    list(&dist, &dist, &mut files);
    files.sort();
    assert!(
        files.iter().any(|(name, _)| name == "index.html"),
        "{} holds no index.html, so it is no page",
        dist.display()
    );
    let mut text = "/// Names and bytes of the page's files.\n\
        static PAGE_FILES: &[(&str, &[u8])] = &[\n"
        .to_owned();
    for (name, path) in &files {
        let _ = writeln!(text, "    ({name:?}, include_bytes!({path:?})),");
    }
    text += "];\n";
    let target = out.join("page_files.rs");
    fs::write(&target, text).unwrap_or_else(|e| panic!("{}: {e}", target.display()));
}

fn variable(name: &str) -> String {
    env::var(name).unwrap_or_else(|_| panic!("Cargo sets {name}"))
}

/// Copies the sources, fetches what the lock file names, and builds. Returns the folder of the
/// page.
fn build(web: &Path, work: &Path) -> PathBuf {
    check_node();
    let _ = fs::remove_dir_all(work.join("src"));
    for source in SOURCES {
        copy(&web.join(source), &work.join(source));
    }
    let lock = fs::read(work.join("package-lock.json")).expect("it was copied");
    let stamp = work.join("installed-lock.json");
    if fs::read(&stamp).ok().as_deref() != Some(&lock) {
        npm(work, &["ci", "--ignore-scripts", "--no-audit", "--no-fund"]);
        fs::write(&stamp, lock).unwrap_or_else(|e| panic!("{}: {e}", stamp.display()));
    }
    npm(work, &["run", "build"]);
    work.join("dist")
}

fn check_node() {
    let told = Command::new("node").arg("--version").output();
    let version = told.ok().map(|out| String::from_utf8_lossy(&out.stdout).trim().to_owned());
    let major = version.as_deref().and_then(|v| v.trim_start_matches('v').split('.').next());
    let is_new = major.and_then(|m| m.parse::<u32>().ok()).is_some_and(|m| m >= 20);
    assert!(
        is_new,
        "\n\nThe studio's page is built with Node 20 or newer and npm; found {}.\n\
        Install it from https://nodejs.org or with your system's packages and build again, or set \
        KERFOLD_STUDIO_PAGE to a folder with a page that is built already.\n\
        Without the studio nothing needs Node: `cargo build --release` builds all the rest.\n",
        version.as_deref().unwrap_or("none"),
    );
}

fn npm(folder: &Path, arguments: &[&str]) {
    let program = if cfg!(windows) { "npm.cmd" } else { "npm" };
    let done = Command::new(program).args(arguments).current_dir(folder).output();
    let words = arguments.join(" ");
    match done {
        Ok(out) if out.status.success() => {}
        Ok(out) => panic!(
            "\n\n`npm {words}` failed:\n{}{}\n",
            String::from_utf8_lossy(&out.stdout),
            String::from_utf8_lossy(&out.stderr)
        ),
        Err(error) => panic!("\n\nnpm cannot be started ({error}); it comes with Node 20\n"),
    }
}

fn copy(from: &Path, to: &Path) {
    let fail = |e: std::io::Error| -> () { panic!("{}: {e}", from.display()) };
    if from.is_dir() {
        fs::create_dir_all(to).unwrap_or_else(fail);
        for entry in fs::read_dir(from).into_iter().flatten().flatten() {
            copy(&entry.path(), &to.join(entry.file_name()));
        }
    } else {
        if let Some(folder) = to.parent() {
            fs::create_dir_all(folder).unwrap_or_else(fail);
        }
        fs::copy(from, to).map(drop).unwrap_or_else(fail);
    }
}

fn list(root: &Path, folder: &Path, files: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            list(root, &path, files);
        } else if let Ok(name) = path.strip_prefix(root) {
            let name = name.to_string_lossy().replace('\\', "/");
            files.push((name, path.to_string_lossy().into_owned()));
        }
    }
}
