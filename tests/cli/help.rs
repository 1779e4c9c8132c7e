//! Help, completions, manual pages, and what is mistyped.

use std::fs;
use std::path::Path;

use super::harness::{Folder, run, verbs};

#[test]
fn every_verb_has_an_example_in_its_help() {
    let verbs = verbs();
    for name in [
        "solid",
        "info",
        "check",
        "cut",
        "unfold",
        "seams",
        "dform",
        "panels",
        "verify",
        "lint",
        "kerf-test",
        "run",
        "gallery",
        "render",
        "completions",
        "man",
    ] {
        assert!(verbs.contains(&vec![name.to_owned()]), "{name}");
    }
    assert!(verbs.len() >= 16, "{verbs:?}");
    for verb in verbs {
        let mut arguments: Vec<&str> = verb.iter().map(String::as_str).collect();
        let example = format!("Example: kerfold {}", arguments.join(" "));
        arguments.push("--help");
        let help = run(&arguments);
        assert_eq!((help.code, help.err.as_str()), (Some(0), ""));
        assert!(help.out.contains(&example), "{verb:?} has no example:\n{}", help.out);
    }
}

#[test]
fn completions_and_manual_pages_know_every_verb() {
    let folder = Folder::new("man");
    assert_eq!(run(&["man", "-o", &folder.path("man1")]).code, Some(0));
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = run(&["completions", shell]);
        assert_eq!((script.code, script.err.as_str()), (Some(0), ""), "{shell}");
        for verb in verbs() {
            assert!(script.out.contains(verb.last().expect("a verb")), "{shell} {verb:?}");
            let page = folder.path(&format!("man1/kerfold-{}.1", verb.join("-")));
            assert!(fs::read_to_string(&page).expect(&page).contains("Example: kerfold"), "{page}");
        }
    }
    assert_eq!(run(&["completions", "tcsh"]).code, Some(2));
}

#[test]
fn mistyped_arguments_are_exit_code_2() {
    let cases: &[(&[&str], &str)] = &[
        (&["unfoldd", "x.obj"], "unfold"),
        (&["unfold", "x.obj"], "--output"),
        (&["solid", "dodecahedrn", "-o", "x.obj"], "dodecahedron"),
        (&["render", "fixtures/meshes/cube.obj", "-o", "x.jpg"], ".png"),
        (
            &["unfold", "fixtures/meshes/cube.obj", "--animate", "x.gltf", "-o", "x"],
            "something.glb",
        ),
        (&["unfold", "fixtures/meshes/cube.off", "--joint", "tabs", "-o", "x"], "thickness"),
        (&["check", "fixtures/meshes/cube.obj", "--report", "x.txt"], ".json"),
        (
            &["cut", "edge", "fixtures/meshes/cube.obj", "--select", "hamiltonain", "-o", "x.obj"],
            "hamiltonian",
        ),
    ];
    for (arguments, hint) in cases {
        let ran = run(arguments);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{arguments:?}");
        assert!(ran.err.contains(hint), "{arguments:?}: {}", ran.err);
    }
    assert!(!Path::new("x.obj").exists() && !Path::new("x.jpg").exists());
}
