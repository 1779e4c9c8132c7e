//! `unfold`: all files or none, animations.

use std::fs;

use super::harness::{Folder, good_model, run};

#[test]
fn of_several_files_all_are_written_or_none() {
    let folder = Folder::new("all-or-none");
    let model = good_model(&folder);
    fs::create_dir_all(folder.path("out/layout.json")).expect("a folder where a file should go");
    fs::write(folder.path("out/pieces.json"), "precious").expect("a file");
    let before = folder.contents();
    let ran = run(&["unfold", &model, "--sheet", "600x400", "-o", &folder.path("out")]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("layout.json"), "{}", ran.err);
    assert_eq!(folder.contents(), before);
}

#[test]
fn animations_are_written_where_they_are_named_or_nothing_is() {
    let folder = Folder::new("animate");
    let model = good_model(&folder);
    let animations = [
        ("bloom.glb", &b"glTF"[..]),
        ("bloom.png", &b"\x89PNG"[..]),
        ("bloom.fold", &b"{\n\"file_spec\": 1.1,"[..]),
    ];
    for (name, start) in animations {
        let file = folder.path(name);
        let ran = run(&["unfold", &model, "--animate", &file, "-o", &folder.path("out"), "--json"]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
        assert!(ran.out.contains(name), "{}", ran.out);
        assert!(fs::read(&file).expect("the animation").starts_with(start), "{name}");
    }
    let recipe = folder.path("recipe.toml");
    let text = "[[step]]\nsolid = \"cube\"\nsize = \"80mm\"\n\n[[step]]\nunfold = \"one\"\nanimate \
    = \"up.glb\"\n\
        assembly = \"pictures\"\njoint = \"tabs\"\nthickness = 3\nsubstitute = \"mitre\"\n";
    fs::write(&recipe, text).expect("a recipe");
    for out in ["first", "second"] {
        let ran = run(&["run", &recipe, "-o", &folder.path(out)]);
        assert_eq!(ran.code, Some(0), "{}", ran.err);
    }
    for name in ["up.glb", "assembly-01.png", "assembly.txt"] {
        let [first, second] =
            ["first", "second"].map(|out| fs::read(folder.path(&format!("{out}/{name}"))));
        let (first, second) = (first.expect(name), second.expect(name));
        // The command in the file names its folder.
        assert!(first.len() > 100 && (name != "assembly-01.png" || first == second), "{name}");
    }
    fs::write(folder.path("wall"), "a file where a folder should be").expect("a file");
    let before = folder.contents();
    let ran = run(&[
        "unfold",
        &model,
        "--animate",
        &folder.path("wall/x.glb"),
        "-o",
        &folder.path("new"),
    ]);
    assert_eq!(ran.code, Some(2));
    assert!(ran.err.contains("wall"), "{}", ran.err);
    assert_eq!(folder.contents(), before);
}
