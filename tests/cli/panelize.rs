//! What `panelize` reads: grids of heights, formulas over drawings, curves, rough surfaces.

use std::fs;

use serde_json::Value;

use super::harness::{Folder, Ran, run};

fn written(folder: &Folder, name: &str, text: &str) -> String {
    let path = folder.path(name);
    fs::write(&path, text).expect("a file");
    path
}

/// The model that a run wrote: largest extents in mm, faces, and rims.
fn model(path: &str) -> (Vec<f64>, u64, u64) {
    let ran = run(&["info", path, "--json"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let json = serde_json::from_str::<Value>(&ran.out).expect("JSON")["model"].clone();
    let size = json["size_mm"].as_array().expect("a size").iter().filter_map(Value::as_f64);
    let count = |key: &str| json[key].as_u64().expect("a count");
    (size.collect(), count("faces"), count("rims"))
}

fn assert_panels(ran: &Ran, path: &str) {
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    let checked = run(&["check", path, "--profile", "exact", "--require", "planar,valence3"]);
    assert_eq!(checked.code, Some(0), "{}", checked.out);
}

/// Heights of a shallow dome over 6 by 5 metres.
fn dome(separator: &str) -> String {
    let heights = |y: i32| {
        let row = (-6..=6).map(|x| {
            let (x, y) = (f64::from(x) / 2.0, f64::from(y) / 2.0);
            format!("{separator}{}", 1.0 - (x * x + y * y) / 16.0)
        });
        format!("{}{}\n", f64::from(y) / 2.0, row.collect::<String>())
    };
    let head: String = (-6..=6).map(|x| format!("{separator}{}", f64::from(x) / 2.0)).collect();
    format!("y\\x{head}\n{}", (-5..=5).map(heights).collect::<String>())
}

#[test]
fn a_grid_of_heights_becomes_panels_and_says_how_it_was_read() {
    let folder = Folder::new("panelize-heights");
    let out = folder.path("panels.obj");
    let grid = written(&folder, "heights.csv", &dome(","));
    let ran = run(&["panelize", &grid, "--units", "m", "--count", "24", "-o", &out]);
    assert_panels(&ran, &out);
    let told = "13 values of x by 11 of y, read from a table whose first row is x";
    assert!(ran.err.contains(told), "{}", ran.err);
    let (size, ..) = model(&out);
    assert!((5900.0..6100.0).contains(&size[0]), "{size:?}");
    // Any verb reads it; what is no grid is told with its line, column and code.
    assert_eq!(model(&grid).1, 2 * 12 * 10);
    for (text, told) in [
        (dome(",").replacen("\n0,0.4375", "\n0,much", 1), ":7: column 2 is `much`"),
        (dome(";").replacen("\n0;", "\n-2;", 1), ":7: the first column is y"),
        ("0,0,1\n1,0,1\n0,1,2\n".to_owned(), "no whole grid"),
    ] {
        let bad = written(&folder, "bad.csv", &text);
        let ran = run(&["panelize", &bad, "--count", "24", "-o", &out]);
        assert!(ran.code == Some(2) && ran.err.contains(told), "{}", ran.err);
        assert!(ran.err.contains("(E145)"), "{}", ran.err);
    }
}

#[test]
fn a_formula_lies_over_drawn_lines_with_holes() {
    let folder = Folder::new("panelize-domain");
    let out = folder.path("panels.obj");
    let square = |size: f64| {
        let corners = [(-size, -size), (size, -size), (size, size), (-size, size)];
        corners.map(|(x, y)| format!("{x},{y}\n")).concat()
    };
    let list =
        written(&folder, "yard.csv", &format!("{}\n# the eye\n{}", square(4.0), square(1.5)));
    let svg = "<svg xmlns='http://www.w3.org/2000/svg' width='80mm' height='80mm' viewBox='0 0 80 \
        80'><rect width='80' height='80'/><path d='M25 25h30v30h-30z'/></svg>";
    let drawing = written(&folder, "yard.svg", svg);
    let mut areas = Vec::new();
    for domain in [format!("{list}@m"), format!("{drawing}@8m")] {
        let height = ["--height", "2-(x^2+y^2)/40", "--domain", &domain, "--steps", "40"];
        let options = ["--count", "44", "--rim", "walls", "-o", &out];
        let ran = run(&[&["panelize"][..], &height, &options].concat());
        assert!(matches!(ran.code, Some(0 | 1)), "{}", ran.err);
        let (size, faces, rims) = model(&out);
        assert!((size[0] - 8000.0).abs() < 1e-6 && rims == 2, "{size:?} {rims}");
        areas.push(faces);
    }
    assert!(areas.iter().all(|faces| (40..=48).contains(faces)), "{areas:?}");
    for (domain, code) in [
        (written(&folder, "bow.csv", "0,0\n5,5\n5,0\n0,5\n"), "(E856)"),
        (written(&folder, "word.csv", "0,0\n5,five\n"), "(E"),
        (folder.path("missing.svg"), "(E"),
        ("cirkle@8m".to_owned(), "(E"),
    ] {
        let ran =
            run(&["panelize", "--height", "0", "--domain", &domain, "--count", "20", "-o", &out]);
        assert!(ran.code == Some(2) && ran.err.contains(code), "{domain}: {}", ran.err);
    }
}

#[test]
fn curves_are_in_the_unit_of_the_surface() {
    let folder = Folder::new("panelize-curves");
    let out = folder.path("panels.obj");
    let grid = written(&folder, "heights.csv", &dome(","));
    let curve = written(&folder, "row.obj", "v -2 -1 0.7\nv 0 0 1\nv 2 1 0.7\nl 1 2 3\n");
    let along = |units: &str| {
        run(&["panelize", &grid, "--units", units, "--count", "24", "--align", &curve, "-o", &out])
    };
    assert_panels(&along("m"), &out);
    let with = fs::read(&out).expect("panels");
    let ran = run(&["panelize", &grid, "--units", "m", "--count", "24", "-o", &out]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
    assert_ne!(fs::read(&out).expect("panels"), with, "the curve changes nothing");
    // A curve 3 m above.
    let high = written(&folder, "high.obj", "v -2 -1 4\nv 0 0 4\nl 1 2\n");
    let ran =
        run(&["panelize", &grid, "--units", "m", "--count", "24", "--align", &high, "-o", &out]);
    assert!(ran.code == Some(2) && ran.err.contains("(E857)"), "{}", ran.err);
    let ran = run(&["panelize", &grid, "--count", "24", "--align", "sideways", "-o", &out]);
    assert!(ran.code == Some(2) && ran.err.contains("flat, rim, none"), "{}", ran.err);
}

#[test]
fn a_rough_surface_is_made_even_and_the_way_is_told() {
    let folder = Folder::new("panelize-smooth");
    let out = folder.path("panels.obj");
    // Every other height 4 mm off.
    let mut count = 0;
    let rough: Vec<String> = dome(",")
        .lines()
        .map(|line| {
            let cell = |cell: &str| {
                count += 1;
                match cell.parse::<f64>() {
                    Ok(z) if count > 20 && count % 3 == 0 => format!("{}", z + 0.004),
                    _ => cell.to_owned(),
                }
            };
            let (y, rest) = line.split_once(',').expect("cells");
            format!("{y},{}", rest.split(',').map(cell).collect::<Vec<_>>().join(","))
        })
        .collect();
    let grid = written(&folder, "rough.csv", &rough.join("\n"));
    let run = |smooth: &str| {
        let options = ["--units", "m", "--extent", "6m", "--mend", "--count", "24"];
        run(&[&["panelize", &grid, "--smooth", smooth, "-o", &out][..], &options].concat())
    };
    let ran = run("30mm");
    assert_panels(&ran, &out);
    assert!(ran.err.contains("the surface was made even"), "{}", ran.err);
    assert!(!ran.err.contains("farther than --smooth allows"), "{}", ran.err);
    assert!(run("0.5mm").err.contains("farther than --smooth allows"));
    let refused = run("0mm");
    assert!(refused.code == Some(2) && refused.err.contains("(E842)"), "{}", refused.err);
}

#[test]
fn planes_of_a_file_are_those_of_panels_in_the_unit_of_the_surface() {
    let folder = Folder::new("panelize-fix");
    let out = folder.path("panels.obj");
    let grid = written(&folder, "heights.csv", &dome(","));
    let planes = written(&folder, "planes.csv", "nx,ny,nz,d\n# the top, lowered\n0,0,2,1.96\n");
    let fixed = |planes: &str| {
        run(&["panelize", &grid, "--units", "m", "--count", "24", "--fix", planes, "-o", &out])
    };
    let ran = fixed(&planes);
    assert_panels(&ran, &out);
    assert!(ran.err.contains("(line 3)"), "{}", ran.err);
    let text = fs::read_to_string(&out).expect("panels");
    let height = |line: &str| line.strip_prefix("v ")?.split(' ').nth(2)?.parse::<f64>().ok();
    let on = text.lines().filter_map(height).filter(|z| (z - 980.0).abs() < 1e-9).count();
    assert!(on >= 4, "{on} corners at 980 mm");
    // Planes for the rim are read alike, in the same unit, and have to be near one.
    let rim = |planes: &str| {
        run(&["panelize", &grid, "--units", "m", "--count", "24", "--rim", planes, "-o", &out])
    };
    let ran = rim(&written(&folder, "rim.csv", "0,0,1,77\n"));
    assert!(ran.code == Some(2) && ran.err.contains("(E850)"), "{}", ran.err);
    let high = written(&folder, "high.csv", "0,0,1,1\n0,0,1,3\n");
    let ran = fixed(&high);
    assert!(ran.code == Some(2) && ran.err.contains("line 2"), "{}", ran.err);
    assert!(ran.err.contains("(E859)") && ran.err.contains("2000.0 mm off"), "{}", ran.err);
    let ran = fixed(&written(&folder, "bad.csv", "0,0,1\n"));
    assert!(ran.code == Some(2) && ran.err.contains("(E173)"), "{}", ran.err);
    // As a step of a recipe, relative to it.
    let recipe = "[[step]]\nheight = \"1-(x^2+y^2)/16\"\ndomain = \"6mx5m\"\nsteps = 40\n[[step]]\n\
        panelize = \"count\"\ncount = 24\nfix = \"planes.csv\"\n";
    let recipe = written(&folder, "dome.toml", recipe);
    let ran = run(&["run", &recipe, "-o", &folder.path("made")]);
    assert!(ran.err.contains("(line 3)"), "{}", ran.err);
}

#[test]
fn points_of_a_file_have_a_vertex_each_in_the_unit_of_the_surface() {
    let folder = Folder::new("panelize-stay");
    let out = folder.path("panels.obj");
    let grid = written(&folder, "heights.csv", &dome(","));
    let stay = |points: &str| {
        run(&["panelize", &grid, "--units", "m", "--count", "24", "--stay", points, "-o", &out])
    };
    let (text, there) = ("0.5,-0.25,0.98046875\n", "v 500 -250 980.46875");
    let as_obj = "v 0.5 -0.25 0.98046875\n";
    for (name, text) in [("at.txt", text), ("at.obj", as_obj), ("at.csv", text)] {
        let ran = stay(&written(&folder, name, text));
        assert_panels(&ran, &out);
        assert!(ran.err.contains("(point 1)"), "{}", ran.err);
        let made = fs::read_to_string(&out).expect("panels");
        assert!(made.lines().any(|line| line == there), "{name}");
    }
    let ran = stay(&written(&folder, "high.csv", "0.5,-0.25,3\n"));
    assert!(ran.code == Some(2) && ran.err.contains("(E866)"), "{}", ran.err);
    let ran = stay(&written(&folder, "bad.csv", "0,0\n"));
    assert!(ran.code == Some(2) && ran.err.contains("bad.csv"), "{}", ran.err);
    let recipe = "[[step]]\nheight = \"1-(x^2+y^2)/16\"\ndomain = \"6mx5m\"\nsteps = 40\n[[step]]\n\
        panelize = \"count\"\ncount = 24\nstay = \"columns.csv\"\n";
    written(&folder, "columns.csv", text);
    let recipe = written(&folder, "dome.toml", recipe);
    let ran = run(&["run", &recipe, "-o", &folder.path("made")]);
    assert!(ran.err.contains("(point 1)"), "{}", ran.err);
}

#[test]
fn panels_are_mirrored_and_edges_drawn_to_few_lengths() {
    let folder = Folder::new("panelize-symmetry");
    let out = folder.path("panels.obj");
    let grid = written(&folder, "heights.csv", &dome(","));
    let made = |options: &[&str]| {
        let usual = ["panelize", &grid, "--units", "m", "--count", "24", "-o", &out];
        run(&[&usual[..], options].concat())
    };
    let ran = made(&["--symmetry", "x,y"]);
    assert_panels(&ran, &out);
    for axis in ["mirrored across x = 0 mm", "mirrored across y = 0 mm"] {
        assert!(ran.err.contains(axis), "{}", ran.err);
    }
    assert!(!ran.err.contains("neither"), "{}", ran.err);
    // Two lengths are fewer than planar panels can have here: that is told, with what was reached.
    let ran = made(&["--families", "2"]);
    assert!(ran.code == Some(1) && ran.err.contains("(F615)"), "{}", ran.err);
    assert!(ran.err.contains("2 families of lengths asked for"), "{}", ran.err);
    let checked = run(&["check", &out, "--profile", "exact", "--require", "planar,valence3"]);
    assert_eq!(checked.code, Some(0), "{}", checked.out);
    let ran = made(&["--max-fold", "1deg", "--max-hollow", "0.01mm"]);
    assert!(ran.code == Some(1) && ran.err.contains("(F616)"), "{}", ran.err);
    let ran = made(&["--symmetry", "z"]);
    assert!(ran.code == Some(2) && ran.err.contains("(E864)"), "{}", ran.err);
}

#[test]
fn the_worst_panels_are_drawn_with_their_numbers() {
    let folder = Folder::new("worst");
    let (heights, panels, picture) = (
        written(&folder, "dome.csv", &dome(",")),
        folder.path("dome.obj"),
        folder.path("worst.svg"),
    );
    let arguments = [
        "panelize",
        &heights,
        "--units",
        "m",
        "--size",
        "1.2m",
        "-o",
        &panels,
        "--picture",
        &picture,
    ];
    let ran = run(&arguments);
    assert_panels(&ran, &panels);
    // "off the surface by … mm at most (panels 3, 4, 0)"
    let (_, rest) = ran.err.split_once("at most (panels ").expect("the worst are named");
    let (list, _) = rest.split_once(')').expect("a list");
    let worst = list.split(", ").count();
    // Fills of the colour that points out, and lines, of which letters are made.
    let drawn = |path: &str| {
        let svg = fs::read_to_string(path).expect("a picture");
        let fills = svg.split("fill=\"#F").skip(1);
        let reds = fills.filter(|fill| fill.get(1..2).is_some_and(|green| "789".contains(green)));
        (reds.count(), svg.matches(" stroke=").count() + svg.matches('M').count())
    };
    let plain = folder.path("plain.svg");
    assert_eq!(run(&["render", &panels, "-o", &plain]).code, Some(0));
    let ((reds, lines), (no_reds, fewer)) = (drawn(&picture), drawn(&plain));
    assert!(reds >= worst && no_reds == 0, "{reds} and {no_reds} red areas for {worst} panels");
    assert!(lines > fewer, "numbers are drawn: {lines} lines, without them {fewer}");
    let other = folder.path("worst.bmp");
    let refused =
        run(&["panelize", &heights, "--size", "1.2m", "-o", &panels, "--picture", &other]);
    assert!(refused.code == Some(2) && refused.err.contains("(E005)"), "{}", refused.err);
}
