//! `gallery`.

use std::fs;

use super::harness::{Folder, run};

#[test]
fn a_gallery_shows_what_works_and_names_what_fails() {
    let folder = Folder::new("gallery");
    let bundled = folder.path("bundled");
    let ran =
        run(&["gallery", "--only", "gonen-fig-08,gonen-fig-05", "--width", "64", "-o", &bundled]);
    assert_eq!((ran.code, ran.err.as_str()), (Some(0), ""));
    assert!(
        ran.out.contains("gonen-fig-08-vertex-truncation") && ran.out.contains("pass"),
        "{}",
        ran.out
    );
    let page = fs::read_to_string(folder.path("bundled/index.html")).expect("the page");
    assert!(
        page.contains("9 vertices, 16 edges, 9 faces") && page.contains("planar to rounding"),
        "{page}"
    );
    assert!(
        fs::read(folder.path("bundled/gonen-fig-05-global-cut/model.png"))
            .expect("a picture")
            .len()
            > 100
    );
    // The recipes lie beside it and run as they are.
    let recipe = folder.path("bundled/recipes/gallery/gonen-fig-05-global-cut.toml");
    assert_eq!(run(&["run", &recipe, "-o", &folder.path("again")]).code, Some(0));

    let own = folder.path("own");
    fs::create_dir(&own).expect("a folder");
    let none = run(&["gallery", &own, "-o", &folder.path("site")]);
    assert!(none.code == Some(2) && none.err.contains("no recipes"), "{}", none.err);
    let cube = "[[step]]\nsolid = \"cube\"\nsize = \"80mm\"\n";
    fs::write(folder.path("own/good.toml"), cube).expect("a recipe");
    fs::write(folder.path("own/bad.toml"), "[[step]]\nsolid = \"cbe\"\n").expect("a recipe");
    let open = format!("{cube}[[step]]\ncheck = \"glass\"\nrequire = \"valence3,closed,planar\"\n");
    fs::write(folder.path("own/checked.toml"), open).expect("a recipe");
    let mixed = run(&["gallery", &own, "-o", &folder.path("site")]);
    assert_eq!(mixed.code, Some(2));
    assert!(
        mixed.err.contains("1 of 3 recipes failed") && mixed.err.contains("bad: line 2"),
        "{}",
        mixed.err
    );
    let page = fs::read_to_string(folder.path("site/index.html")).expect("the page");
    assert!(page.contains("good/model.png") && page.contains("class=\"fail\""), "{page}");
    let unknown = run(&["gallery", "--only", "nothing", "-o", &folder.path("x")]);
    assert!(unknown.code == Some(2) && unknown.err.contains("gonen-fig-08"), "{}", unknown.err);
    assert_eq!(run(&["gallery", &folder.path("missing"), "-o", &folder.path("x")]).code, Some(2));
    fs::write(folder.path("wall"), "a file where a folder should be").expect("a file");
    assert_eq!(run(&["gallery", &own, "-o", &folder.path("wall")]).code, Some(2));
}
