//! The bundled recipes: each gives what its figure predicts, and the page of the gallery in the
//! documentation tells just that.

use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};

use kerfold::gallery::{Exhibit, GalleryRecipe, bundled, exhibit, gallery_markdown, side_by_side};
use kerfold::progress::Silent;

use golden::{assert_golden, is_blessing};

#[path = "golden/mod.rs"]
mod golden;

const PAGE: &str = "docs/gallery.md";
const PICTURES: &str = "docs/images/gallery";
/// Of a picture in the documentation, in pixels and bytes. A story is twice as wide, with up to six
/// pictures.
const WIDTH: u32 = 480;
const MOST_BYTES: u64 = 200_000;
const HEAD: &str = "\
# Gallery

Every figure of the three papers that shows a result, each from one bundled recipe. `kerfold gallery
-o DIR` makes them all, with this page as HTML; `kerfold run RECIPE -o DIR` makes one. The recipes
lie in `fixtures/recipes` and `fixtures/recipes/gallery`. What a caption predicts stands above the
figures that were measured; each recipe's check holds to it.

This page is written by `KERFOLD_BLESS=1 cargo test --release --test gallery`; without the variable
the test compares it with what the recipes make.

";

fn recipes() -> Vec<GalleryRecipe> {
    let mut recipes: Vec<GalleryRecipe> = bundled()
        .filter_map(|file| {
            let (folder, name) = file.path.rsplit_once('/')?;
            let name = name.strip_suffix(".toml")?;
            let folder: PathBuf = Path::new("fixtures").join(folder);
            Some(GalleryRecipe { name: name.to_owned(), text: file.text.to_owned(), folder })
        })
        .collect();
    recipes.sort_by(|a, b| a.name.cmp(&b.name));
    recipes
}

/// An exhibit, a hash of all its files, and its picture.
fn built(recipe: &GalleryRecipe) -> (Exhibit, u64, Vec<u8>) {
    let (exhibit, outputs) =
        exhibit(recipe, Some(WIDTH), &Silent).unwrap_or_else(|e| panic!("{e}"));
    let mut hasher = DefaultHasher::new();
    outputs.hash(&mut hasher);
    let shown = exhibit.picture;
    let picture = outputs.into_iter().find(|(name, _)| name == shown).map(|(_, bytes)| bytes);
    (exhibit, hasher.finish(), picture.unwrap_or_default())
}

fn page(exhibits: &[Exhibit]) -> String {
    HEAD.to_owned() + &gallery_markdown(exhibits, "images/gallery")
}

#[test]
fn recipes_are_all_bundled_under_one_name_each() {
    let recipes = recipes();
    let names: BTreeSet<&str> = recipes.iter().map(|r| r.name.as_str()).collect();
    assert_eq!(names.len(), recipes.len(), "two recipes of one name");
    let on_disk = ["fixtures/recipes", "fixtures/recipes/gallery"].iter().flat_map(|folder| {
        std::fs::read_dir(folder).expect("recipes").map(|entry| entry.expect("an entry").path())
    });
    let on_disk: Vec<PathBuf> =
        on_disk.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    assert_eq!(on_disk.len(), recipes.len());
    for recipe in &recipes {
        assert!(recipe.text.starts_with('#'), "{} does not say what it shows", recipe.name);
    }
}

/// The findings that the text predicts (mostly none), and the figures of the page; every fourth recipe is
/// built twice, to the same bytes. Blessing writes the page and its pictures.
#[test]
fn every_recipe_gives_what_it_predicts_and_the_page_says_so() {
    let recipes = recipes();
    let first = side_by_side(&recipes, &Silent, &|recipe, _| {
        let (exhibit, hash, picture) = built(recipe);
        if is_blessing() {
            let path = Path::new(PICTURES).join(format!("{}.png", recipe.name));
            std::fs::write(path, picture).expect("a picture");
        }
        let predicted: Vec<&str> =
            recipe.text.lines().filter_map(|line| line.strip_prefix("# Finding: ")).collect();
        assert_eq!(exhibit.findings, predicted, "{}", recipe.name);
        let place = recipes.iter().position(|r| r.name == recipe.name);
        if place.is_some_and(|i| i.is_multiple_of(4)) {
            assert_eq!(built(recipe).1, hash, "{}: two runs differ", recipe.name);
        }
        exhibit
    });
    assert_golden(PAGE, &page(&first));
}

#[test]
fn every_recipe_has_its_picture_and_pictures_are_small() {
    let recipes = recipes();
    let wanted: BTreeSet<String> = recipes.iter().map(|r| format!("{}.png", r.name)).collect();
    let mut there = BTreeSet::new();
    for entry in std::fs::read_dir(PICTURES).expect("pictures") {
        let entry = entry.expect("an entry");
        let bytes = entry.metadata().expect("metadata").len();
        let name = entry.file_name().to_string_lossy().into_owned();
        assert!(bytes <= MOST_BYTES, "{name} has {bytes} bytes");
        there.insert(name);
    }
    assert_eq!(there, wanted);
}
