//! The examples are built with the tests; here they are run.

use std::path::PathBuf;
use std::process::Command;

/// Standard output of an example that must succeed.
fn output(name: &str) -> String {
    // Tests lie in `deps`, examples beside it.
    let mut path: PathBuf = std::env::current_exe().expect("the path of this test");
    path.pop();
    path.pop();
    path.push("examples");
    path.push(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    if !path.exists() {
        // `cargo test --test examples` alone does not build them.
        let release = (!cfg!(debug_assertions)).then_some("--release");
        let built = Command::new(env!("CARGO"))
            .args(["build", "--quiet", "--examples"])
            .args(release)
            .status();
        assert!(built.expect("cargo").success(), "the examples do not build");
    }
    let done = Command::new(&path).output().unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    assert!(done.status.success(), "{name}: {}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).expect("text")
}

#[test]
fn carve_prints_a_mesh_with_three_edges_at_every_vertex() {
    let text = output("carve");
    assert_eq!(text.lines().filter(|l| l.starts_with("v ")).count(), 180);
    assert_eq!(text.lines().filter(|l| l.starts_with("f ")).count(), 92);
}

#[test]
fn two_pieces_prints_a_sheet() {
    let text = output("two_pieces");
    assert!(
        text.starts_with("<?xml") || text.starts_with("<svg"),
        "{}",
        &text[..text.len().min(80)]
    );
    assert!(text.contains("P01") && text.contains("P02") && !text.contains("P03"));
}

#[test]
fn plates_lists_two_kinds() {
    let text = output("plates");
    assert!(text.contains("12 plates") && text.contains("20 plates"), "{text}");
}

#[test]
fn sponge_has_the_genus_of_menger() {
    let text = output("sponge");
    assert!(text.contains("round 1: 72 faces, genus 5, 0.740741"), "{text}");
    assert!(text.contains("genus 81, 0.548697"), "{text}");
}
