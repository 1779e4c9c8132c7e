//! `hull` of half-spaces.

use std::fs;
use std::path::Path;

use super::harness::{Folder, run};

#[test]
fn planes_that_bound_nothing_are_refused_with_place_and_reason() {
    let folder = Folder::new("planes");
    let output = folder.path("out.obj");
    let walls = "1,0,0,1\n-1,0,0,1\n0,1,0,1\n0,-1,0,1\n";
    for (name, text, messages) in [
        ("empty.csv", String::new(), &["there are no half-spaces"][..]),
        ("word.csv", format!("{walls}0, 0, up, 1\n"), &["word.csv:5:7: `up` is not a number"]),
        (
            "open.csv",
            format!("{walls}0,0,1,1\n"),
            &["the direction (0.0000, 0.0000, -1.0000) open"],
        ),
        (
            "apart.csv",
            format!("# box\n{walls}0,0,1,1\n0,0,-1,-2\n"),
            &["exclude each other", "on the lines 6, 7"],
        ),
        ("flat.csv", format!("{walls}0,0,1,1\n0,0,-1,-1\n"), &["no room", "on the lines 5, 6"]),
    ] {
        let file = folder.path(name);
        fs::write(&file, text).expect("a file");
        let ran = run(&["hull", "--planes", &file, "-o", &output]);
        assert_eq!((ran.code, ran.out.as_str()), (Some(2), ""), "{name}");
        assert!(messages.iter().all(|m| ran.err.contains(m)), "{name}: {}", ran.err);
        assert!(!Path::new(&output).exists(), "{name}");
    }
    let missing = run(&["hull", "--planes", &folder.path("none.csv"), "-o", &output]);
    assert!(missing.code == Some(2) && missing.err.contains("none.csv"), "{}", missing.err);
}

/// Two tetrahedra that touch in a vertex, each a group: their hulls keep the names, and the file of
/// them gives the same hulls again.
#[test]
fn hulls_of_groups_are_the_same_when_their_file_is_read_again() {
    let folder = Folder::new("by-group");
    let model = folder.path("two.obj");
    let text = "v 0 0 0\nv 9 0 0\nv 0 9 0\nv 0 0 9\nv -9 0 0\nv 0 -9 0\nv 0 0 -9\n\
        g first part\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n\
        g second\nf 1 5 6\nf 1 7 5\nf 1 6 7\nf 5 7 6\n";
    fs::write(&model, text).expect("a file");
    let [once, twice] = ["once.obj", "twice.obj"].map(|name| folder.path(name));
    let shape = |path: &str| {
        let read = kerfold::io::read_mesh(Path::new(path), &Default::default()).expect("a mesh");
        let groups: Vec<_> =
            read.mesh.faces().map(|f| read.mesh.group(f).map(String::from)).collect();
        (read.mesh.counts(), groups)
    };
    for (from, to) in [(&model, &once), (&once, &twice)] {
        let ran = run(&["hull", from, "--by-group", "-o", to]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        let (counts, groups) = shape(to);
        assert_eq!((counts.vertices, counts.edges, counts.faces), (8, 12, 8));
        assert_eq!((counts.components, counts.rims), (2, 0));
        let of = |name: &str| groups.iter().filter(|g| g.as_deref() == Some(name)).count();
        assert_eq!((of("first part"), of("second")), (4, 4));
    }
    assert_eq!(shape(&once), shape(&twice));
}

/// A number of parts beyond all use is refused before any cut is made; a convex solid is one part
/// however many are allowed.
#[test]
fn parts_beyond_all_use_are_refused_at_once() {
    let folder = Folder::new("parts");
    let [model, output] = ["solid.obj", "parts.obj"].map(|name| folder.path(name));
    let made = run(&["solid", "geodesic-4", "--size", "100", "-o", &model]);
    assert_eq!(made.code, Some(0), "{}", made.err);
    let refused = run(&["hull", &model, "--parts", "4000000000", "-o", &output]);
    assert_eq!(refused.code, Some(2), "{}", refused.err);
    let says = |text: &str| refused.err.contains(text);
    assert!(says("E313") && says("1 to 1024 parts"), "{}", refused.err);
    assert!(!Path::new(&output).exists());
    let convex = run(&["hull", &model, "--parts", "3", "-o", &output]);
    assert_eq!(convex.code, Some(0), "{}", convex.err);
}
