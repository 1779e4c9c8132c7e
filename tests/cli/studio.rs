//! `studio` starts another program: it is found, gets what was typed, or its lack is told.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::process::Command;

use super::harness::{Folder, program, ran};

/// The program in a folder of its own, so that no studio that was built here stands beside it.
fn alone(folder: &Folder) -> Command {
    let own = folder.path("kerfold");
    let built = program().get_program().to_owned();
    let is_there = fs::exists(&own).expect("a folder");
    if !is_there && fs::hard_link(&built, &own).is_err() {
        fs::copy(&built, &own).expect("a copy");
    }
    let mut command = Command::new(own);
    command.env("PATH", folder.path("bin"));
    command
}

fn script(path: &str, text: &str) {
    fs::write(path, format!("#!/bin/sh\n{text}\n")).expect("a script");
    fs::set_permissions(path, fs::Permissions::from_mode(0o755)).expect("permissions");
}

#[test]
fn a_missing_studio_is_told_with_how_to_install_it() {
    let folder = Folder::new("no-studio");
    let ran = ran(alone(&folder).args(["studio", "--no-open"]));
    assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""));
    assert!(ran.err.contains("cargo install --path crates/kerfold-studio"), "{}", ran.err);
    assert!(ran.err.contains("Node 20") && ran.err.contains("(E015)"), "{}", ran.err);
}

#[test]
fn a_studio_gets_what_was_typed() {
    let folder = Folder::new("studio");
    fs::create_dir(folder.path("bin")).expect("a folder");
    let studio = folder.path("bin/kerfold-studio");
    script(&studio, "echo \"$@\"");
    let typed = ran(alone(&folder).args(["studio", "a b.toml", "--port", "8080", "--no-open"]));
    assert_eq!(typed.code, Some(0), "{}", typed.err);
    assert_eq!(typed.out, "--port 8080 --no-open -- a b.toml\n");
    script(&studio, "exit 2");
    let failed = ran(alone(&folder).arg("studio"));
    assert!(failed.code == Some(2) && failed.err.contains("(E017)"), "{}", failed.err);
    // The one beside is taken first.
    script(&folder.path("kerfold-studio"), "echo beside");
    assert_eq!(ran(alone(&folder).arg("studio")).out, "beside\n");
}
