//! What a stranger sees first: the first command of the README, run in a clean folder, and all that
//! every other verb leaves that writes sheets. Lines can be seen, nothing for the eye crosses a
//! part, and every name and number of the assembly stands on a sheet.
//!
//! `KERFOLD_STRANGER=DIR cargo test --test stranger` judges a folder that somebody else's run of that
//! command has left, as `.ci/run` does with a fresh clone.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

use glam::DVec2;
use kerfold::geom::polygon::{Location, bounds, locate, segments_meet};
use kerfold::sheet::lettering;
use tiny_skia::{Color, LineCap, Paint, PathBuilder, Pixmap, Stroke, Transform};

/// Share of the pixels along outlines that must be darker than half.
const DARK: f64 = 0.03;

/// Pixels of a screen in a millimetre.
const SCREEN: f64 = 96.0 / 25.4;

/// The first command of the README without the program's name.
fn first_command() -> Vec<String> {
    let readme = std::fs::read_to_string("README.md").expect("the README");
    let command = readme.lines().find_map(|line| line.strip_prefix("cargo run --release -- "));
    let command = command.expect("a command that builds and runs kerfold");
    command.split_whitespace().map(str::to_owned).collect()
}

fn run(folder: &Path, args: &[&str]) {
    let program = env!("CARGO_BIN_EXE_kerfold");
    let out = Command::new(program).args(args).current_dir(folder).output().expect("it runs");
    let told = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{args:?}: {told}");
}

fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path());
    let mut files: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|e| e == ending)).collect();
    files.sort();
    files
}

fn text(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A path of a sheet: its layer, its class and its polylines, y down.
struct Line {
    layer: String,
    class: String,
    colour: [u8; 3],
    width: f64,
    strokes: Vec<(Vec<DVec2>, bool)>,
}

/// All paths of an SVG sheet, and its size.
fn lines_of(path: &Path) -> (Vec<Line>, DVec2) {
    let text = text(path);
    let document = roxmltree::Document::parse(&text).expect("well-formed XML");
    let root = document.root_element();
    let size = |name| {
        let value = root.attribute(name).and_then(|v| v.strip_suffix("mm"));
        value.and_then(|v| v.parse().ok()).expect("a size in mm")
    };
    let mut lines = Vec::new();
    for node in document.descendants().filter(|n| n.has_tag_name("path")) {
        let layer = node.parent().expect("a layer");
        let of = |name| layer.attribute(name).expect("an attribute");
        let hex = u32::from_str_radix(&of("stroke")[1..], 16).expect("a colour");
        lines.push(Line {
            layer: of("id").to_owned(),
            class: node.attribute("class").expect("a class").to_owned(),
            colour: [16, 8, 0].map(|shift| (hex >> shift) as u8),
            width: of("stroke-width").parse().expect("a width"),
            strokes: strokes(node.attribute("d").expect("data")),
        });
    }
    (lines, DVec2::new(size("width"), size("height")))
}

fn strokes(data: &str) -> Vec<(Vec<DVec2>, bool)> {
    let of = |part: &str| {
        let point = |pair: &str| {
            let (x, y) = pair.split_once(',')?;
            Some(DVec2::new(x.parse().ok()?, y.parse().ok()?))
        };
        (part.split(' ').filter_map(point).collect(), part.contains('Z'))
    };
    data.split('M').filter(|part| !part.trim().is_empty()).map(of).collect()
}

fn segments(line: &Line) -> Vec<[DVec2; 2]> {
    let of = |(points, closed): &(Vec<DVec2>, bool)| {
        let closing = points.last().zip(points.first()).filter(|_| *closed);
        let open = points.windows(2).map(|w| [w[0], w[1]]);
        open.chain(closing.map(|(a, b)| [*a, *b])).collect::<Vec<_>>()
    };
    line.strokes.iter().flat_map(of).collect()
}

/// Draws a sheet as a browser shows it at its true size, and tells the share of dark pixels beside
/// its outlines.
fn share_on_screen(path: &Path) -> f64 {
    let (lines, size) = lines_of(path);
    let [width, height] = (size * SCREEN).to_array().map(|x| x.ceil() as u32);
    let mut picture = Pixmap::new(width, height).expect("a size");
    picture.fill(Color::WHITE);
    let mut outlines = Pixmap::new(width, height).expect("a size");
    outlines.fill(Color::WHITE);
    for line in &lines {
        let mut builder = PathBuilder::new();
        for [a, b] in segments(line) {
            let at = |p: DVec2| ((p.x * SCREEN) as f32, (p.y * SCREEN) as f32);
            builder.move_to(at(a).0, at(a).1);
            builder.line_to(at(b).0, at(b).1);
        }
        let Some(shape) = builder.finish() else { continue };
        let mut paint = Paint::default();
        let [r, g, b] = line.colour;
        paint.set_color_rgba8(r, g, b, 255);
        let stroke = |width: f32| Stroke { width, line_cap: LineCap::Butt, ..Stroke::default() };
        let own = stroke((line.width * SCREEN) as f32);
        picture.stroke_path(&shape, &paint, &own, Transform::identity(), None);
        if line.class == "outline" {
            let mark = Paint::default();
            outlines.stroke_path(&shape, &mark, &stroke(3.0), Transform::identity(), None);
        }
    }
    let band = outlines.pixels().iter().map(|p| p.red() < 128);
    share(band, picture.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]))
}

/// The share of the pixels of a band that are darker than half.
fn share(band: impl Iterator<Item = bool>, pixels: impl Iterator<Item = [u8; 3]>) -> f64 {
    let on_band: Vec<[u8; 3]> = band.zip(pixels).filter(|(is_in, _)| *is_in).map(|x| x.1).collect();
    let luma = |[r, g, b]: &[u8; 3]| {
        0.2126 * f64::from(*r) + 0.7152 * f64::from(*g) + 0.0722 * f64::from(*b)
    };
    assert!(!on_band.is_empty(), "no outline");
    on_band.iter().filter(|p| luma(p) < 128.0).count() as f64 / on_band.len() as f64
}

/// The same of a picture: the band lies where what is shown meets the background, which is the
/// colour that most pixels have.
fn share_of_picture(path: &Path) -> f64 {
    let picture = Pixmap::load_png(path).expect("a picture");
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let pixels: Vec<[u8; 3]> =
        picture.pixels().iter().map(|p| [p.red(), p.green(), p.blue()]).collect();
    let mut counts = std::collections::BTreeMap::new();
    pixels.iter().for_each(|p| *counts.entry(*p).or_insert(0) += 1);
    let ground = counts.into_iter().max_by_key(|&(_, n)| n).map(|(p, _)| p).expect("pixels");
    let is_shown: Vec<bool> = pixels.iter().map(|p| *p != ground).collect();
    let band = (0..width * height).map(|i| {
        let (x, y) = (i % width, i / width);
        let (xs, ys) =
            (x.saturating_sub(2)..(x + 3).min(width), y.saturating_sub(2)..(y + 3).min(height));
        is_shown[i]
            && ys
                .flat_map(|y| xs.clone().map(move |x| (x, y)))
                .any(|(x, y)| !is_shown[y * width + x])
    });
    share(band, pixels.iter().copied())
}

fn assert_seen(folder: &Path) {
    for path in files(folder, "svg").iter().filter(|p| is_sheet(p)) {
        let share = share_on_screen(path);
        assert!(share >= DARK, "{}: {share} of the outlines are dark", path.display());
    }
    for path in files(folder, "png") {
        let share = share_of_picture(&path);
        assert!(share >= DARK, "{}: {share} of the outlines are dark", path.display());
    }
}

fn is_sheet(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("sheet-"))
}

fn assert_nothing_on_parts(folder: &Path) {
    for path in files(folder, "svg").iter().filter(|p| is_sheet(p)) {
        let (lines, _) = lines_of(path);
        let parts: Vec<&Vec<DVec2>> = lines
            .iter()
            .filter(|l| l.class == "outline")
            .flat_map(|l| &l.strokes)
            .map(|(points, _)| points)
            .collect();
        assert!(!parts.is_empty(), "{}: no part", path.display());
        let info: Vec<&Line> = lines.iter().filter(|l| l.layer == "info").collect();
        assert!(!info.is_empty(), "{}: no legend", path.display());
        for [a, b] in info.into_iter().flat_map(segments) {
            for part in &parts {
                let (low, high) = bounds(part.iter()).expect("points");
                if a.max(b).cmplt(low).any() || a.min(b).cmpgt(high).any() {
                    continue;
                }
                let n = part.len();
                let is_met = locate(part, a) == Location::Inside
                    || (0..n).any(|i| segments_meet(part[i], part[(i + 1) % n], a, b));
                assert!(!is_met, "{}: {a} {b} lies on a part", path.display());
            }
        }
    }
}

/// Numbers and names that lie on a score line are cut through when it is folded.
fn assert_letters_keep_clear_of_scores(folder: &Path) {
    for path in files(folder, "svg").iter().filter(|p| is_sheet(p)) {
        let (lines, _) = lines_of(path);
        let of = |layer: &str| -> Vec<[DVec2; 2]> {
            lines.iter().filter(|l| l.layer == layer).flat_map(segments).collect()
        };
        let scores = of("score");
        for [a, b] in of("engrave") {
            let is_met = scores.iter().any(|&[c, d]| segments_meet(a, b, c, d));
            assert!(!is_met, "{}: {a} {b} crosses a score line", path.display());
        }
    }
}

/// Whether strokes are a text, turned and scaled anyhow, but not mirrored. The machine's order may
/// have turned the whole of it around.
fn spells(strokes: &[(Vec<DVec2>, bool)], text: &str) -> bool {
    let found: Vec<Vec<DVec2>> =
        strokes.iter().map(|(p, _)| p.iter().map(|p| DVec2::new(p.x, -p.y)).collect()).collect();
    let backwards: Vec<Vec<DVec2>> =
        found.iter().rev().map(|stroke| stroke.iter().rev().copied().collect()).collect();
    let letters = lettering(text, 1.0).expect("letters").strokes;
    is_like(&found, &letters) || is_like(&backwards, &letters)
}

/// Whether lines are others turned, scaled and moved.
fn is_like(found: &[Vec<DVec2>], letters: &[Vec<DVec2>]) -> bool {
    let shape = |points: &[Vec<DVec2>]| points.iter().map(Vec::len).collect::<Vec<_>>();
    if shape(found) != shape(letters) {
        return false;
    }
    let [from, to] = [letters.concat(), found.concat()];
    let farthest = (1..from.len())
        .max_by(|&i, &j| from[i].distance(from[0]).total_cmp(&from[j].distance(from[0])));
    let Some(far) = farthest else { return false };
    // As complex numbers: to = turn · from + shift.
    let (u, v) = (from[far] - from[0], to[far] - to[0]);
    let turn = DVec2::new(u.dot(v), u.perp_dot(v)) / u.length_squared();
    let size = v.length() / u.length();
    let is_near =
        |(&a, &b): (&DVec2, &DVec2)| (to[0] + turn.rotate(a - from[0])).distance(b) < 0.03 * size;
    from.iter().zip(&to).all(is_near)
}

/// Names and numbers that the steps of an assembly use.
fn named(text: &str) -> (BTreeSet<String>, BTreeSet<String>) {
    let (mut pieces, mut numbers) = (BTreeSet::new(), BTreeSet::new());
    for line in text.lines().filter_map(|line| line.strip_prefix("step ")) {
        let (_, what) = line.split_once(": ").expect("what to do");
        for word in what.split(|c: char| !c.is_alphanumeric()) {
            if word.starts_with('P') && word.len() > 2 {
                pieces.insert(word.to_owned());
            } else if !word.is_empty() && word.bytes().all(|b| b.is_ascii_digit()) {
                numbers.insert(word.to_owned());
            }
        }
        // How many seams have no number is not a number of a seam.
        assert!(!what.contains("E0"), "bare edges: {line}");
    }
    (pieces, numbers)
}

fn assert_assembly_is_on_sheets(folder: &Path) {
    let (pieces, numbers) = named(&text(&folder.join("assembly.txt")));
    let sheets: Vec<Line> = files(folder, "svg")
        .iter()
        .filter(|p| is_sheet(p))
        .flat_map(|path| lines_of(path).0)
        .collect();
    let is_there = |class: &str, text: &str| {
        sheets.iter().any(|l| l.class == class && spells(&l.strokes, text))
    };
    for piece in &pieces {
        assert!(is_there("name", piece), "{piece} stands on no sheet");
    }
    for number in &numbers {
        assert!(is_there("number", number), "{number} stands on no sheet");
    }
}

fn assert_fit_for_a_stranger(folder: &Path) {
    assert!(folder.join("sheets.html").is_file(), "no page to look at");
    let page = text(&folder.join("sheets.html"));
    for word in ["src=", "href=", "@import", "url("] {
        assert!(!page.contains(word), "the page asks for other files: {word}");
    }
    for sheet in files(folder, "svg").iter().filter(|p| is_sheet(p)) {
        assert!(sheet.with_extension("png").is_file(), "{} has no picture", sheet.display());
        let stem = sheet.file_stem().expect("a name").to_string_lossy();
        assert!(page.contains(&format!("id=\"{stem}\"")), "{stem} is not on the page");
    }
    assert_seen(folder);
    assert_nothing_on_parts(folder);
    assert_letters_keep_clear_of_scores(folder);
    assert_assembly_is_on_sheets(folder);
}

#[test]
fn the_first_command_of_the_readme_leaves_what_can_be_seen_and_built() {
    if let Some(folder) = std::env::var_os("KERFOLD_STRANGER") {
        return assert_fit_for_a_stranger(Path::new(&folder));
    }
    let clean = tempfile::tempdir().expect("a folder");
    let command = first_command();
    let recipe = command.iter().find(|word| word.ends_with(".toml")).expect("a recipe");
    let place = clean.path().join(recipe);
    std::fs::create_dir_all(place.parent().expect("a folder")).expect("a folder");
    std::fs::copy(recipe, &place).expect("a copy of the recipe");
    run(clean.path(), &command.iter().map(String::as_str).collect::<Vec<_>>());
    assert_fit_for_a_stranger(&clean.path().join("out"));
}

#[test]
fn every_verb_that_writes_sheets_leaves_what_can_be_seen_and_built() {
    let clean = tempfile::tempdir().expect("a folder");
    let here = clean.path();
    run(here, &["solid", "cuboctahedron", "--size", "90mm", "-o", "solid.obj"]);
    run(here, &["unfold", "solid.obj", "--sheet", "A4", "-o", "unfold"]);
    run(here, &["unfold", "solid.obj", "--pieces", "faces", "--labels", "edges", "-o", "edges"]);
    run(here, &["unfold", "solid.obj", "--pieces", "4", "--labels", "pieces", "-o", "pieces"]);
    run(here, &["panels", "solid.obj", "--thickness", "3mm", "-o", "panels"]);
    run(here, &["nest", "unfold/pieces.json", "--quantity", "3", "-o", "nest"]);
    run(here, &["dform", "cube", "--size", "120mm", "--rounds", "2", "-o", "dform"]);
    let narrow = ["--roll", "max", "--strips", "15", "--angles", "on", "-o", "strips"];
    run(here, &[&["dform", "dodecahedron", "--size", "180mm"], &narrow[..]].concat());
    for folder in ["unfold", "edges", "pieces", "panels", "nest", "dform", "strips"] {
        assert_fit_for_a_stranger(&here.join(folder));
    }
}

#[test]
fn letters_are_read_as_they_stand() {
    let turned = |text: &str| -> Vec<(Vec<DVec2>, bool)> {
        let turn = DVec2::from_angle(1.0) * 3.0;
        let put = |p: &DVec2| {
            let q = turn.rotate(*p) + DVec2::new(7.0, 9.0);
            DVec2::new(q.x, -q.y)
        };
        let strokes = lettering(text, 1.0).expect("letters").strokes;
        strokes.iter().map(|s| (s.iter().map(put).collect(), false)).collect()
    };
    assert!(spells(&turned("16"), "16") && spells(&turned("P09"), "P09"));
    for other in ["19", "61", "91", "18", "1"] {
        assert!(!spells(&turned("16"), other), "{other}");
    }
    let mut mirrored = turned("12");
    mirrored.iter_mut().flat_map(|s| &mut s.0).for_each(|p| p.x = -p.x);
    assert!(!spells(&mirrored, "12"));
}
