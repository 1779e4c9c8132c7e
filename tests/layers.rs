//! The house rules that a compiler does not check, read off the source text: layers, doors, one
//! writer of links, no printing and no panics by habit. `docs/architecture.md` says why; this file
//! says what.
//!
//! Comments, strings, `#[cfg(test)]` items and files named `tests.rs` are left out. A rule without
//! a test is a wish, and a test that cannot fail is one too: at the end every rule is fed a planted
//! violation.

use std::collections::BTreeSet;
use std::fmt;

use circles::House;
use size::size_faults;
use source::{Source, read, root, sources};

#[path = "layers/circles.rs"]
mod circles;
#[path = "layers/page.rs"]
mod page;
#[path = "layers/size.rs"]
mod size;
#[path = "layers/source.rs"]
mod source;

// ---- the tables ---------------------------------------------------------------------------------

/// A module with its layer, the crate it stands in, and the modules it may use.
struct Room {
    layer: u8,
    home: &'static str,
    module: &'static str,
    may_use: &'static [&'static str],
}

const fn room(
    layer: u8,
    home: &'static str,
    module: &'static str,
    may_use: &'static [&'static str],
) -> Room {
    Room { layer, home, module, may_use }
}

const KERNEL: &str = "crates/kerfold-kernel/src/";
const SHEET: &str = "crates/kerfold-sheet/src/";
const TOP: &str = "src/";
/// The crates as code names them, with their folders. The order is that of their dependence.
const CRATES: &[(&str, &str)] =
    &[("kerfold_kernel", KERNEL), ("kerfold_sheet", SHEET), ("kerfold", TOP)];

/// Layers. The rule: a module uses only modules that stand above it in this table, and of those
/// only the ones in its row; and it does use every one of them. So all arrows point downwards in
/// the house, from layer 5 to layer 0.
const ROOMS: &[Room] = &[
    room(0, KERNEL, "code", &[]),
    room(0, KERNEL, "geom", &[]),
    room(0, KERNEL, "units", &[]),
    room(0, KERNEL, "progress", &[]),
    room(0, KERNEL, "random", &[]),
    room(0, TOP, "explain", &[]),
    room(0, TOP, "memory", &[]),
    room(1, KERNEL, "mesh", &["geom"]),
    room(1, SHEET, "net", &[]),
    room(2, KERNEL, "measure", &["geom", "mesh"]),
    room(2, KERNEL, "shape", &["geom", "units", "random", "mesh"]),
    room(2, TOP, "mend", &["geom", "units", "mesh", "measure"]),
    room(2, TOP, "seam", &["units", "mesh", "measure", "progress"]),
    room(2, TOP, "select", &["geom", "units", "mesh", "measure", "seam", "progress"]),
    room(3, TOP, "check", &["geom", "units", "mesh", "measure", "mend"]),
    room(3, TOP, "panelize", &["geom", "units", "random", "mesh", "measure", "check", "progress"]),
    room(
        3,
        TOP,
        "op",
        &[
            "memory", "geom", "units", "random", "mesh", "measure", "mend", "select", "check",
            "panelize", "progress",
        ],
    ),
    room(
        3,
        TOP,
        "unfold",
        &["geom", "random", "mesh", "measure", "seam", "check", "net", "progress"],
    ),
    room(3, TOP, "panel", &["geom", "units", "mesh", "measure", "check", "net", "progress"]),
    room(3, TOP, "gluing", &["geom", "units", "mesh", "measure", "net", "progress"]),
    room(3, SHEET, "sheet", &["geom", "units", "random", "net", "progress"]),
    room(3, SHEET, "lint", &["geom", "units"]),
    room(3, TOP, "bloom", &["geom", "mesh", "net"]),
    room(
        4,
        TOP,
        "io",
        &[
            "geom", "units", "mesh", "net", "measure", "mend", "select", "check", "panel", "sheet",
            "lint", "bloom",
        ],
    ),
    room(4, TOP, "picture", &["geom", "units", "mesh", "measure", "sheet"]),
    room(
        4,
        TOP,
        "make",
        &[
            "geom", "units", "progress", "mesh", "net", "measure", "shape", "seam", "select",
            "check", "panelize", "op", "unfold", "panel", "gluing", "sheet", "lint", "bloom", "io",
            "picture",
        ],
    ),
    room(
        4,
        TOP,
        "recipe",
        &[
            "units", "progress", "mesh", "shape", "select", "check", "panelize", "op", "unfold",
            "panel", "sheet", "io", "picture", "make",
        ],
    ),
    room(4, TOP, "gallery", &["units", "progress", "io", "make", "recipe"]),
    room(
        5,
        TOP,
        "cli",
        &[
            "units", "progress", "mesh", "net", "measure", "shape", "seam", "select", "check",
            "panelize", "op", "unfold", "panel", "sheet", "lint", "io", "picture", "make",
            "recipe", "gallery", "explain",
        ],
    ),
];

/// What every module may use besides: codes of errors are a common vocabulary, as glam's vectors
/// are, and so is the macro that gives them. It uses nothing itself.
const EVERYWHERE: &[&str] = &["code", "codes"];

/// Doors. The rule: an outside crate enters the house only through the files whose path begins with
/// one of these, and it does enter by each of them. A new dependency needs a row here, and a reason
/// in `docs/dependencies.md`.
const DOORS: &[(&str, &[&str])] = &[
    ("glam", &[TOP, KERNEL, SHEET]),
    (
        "serde",
        &[TOP, SHEET, "crates/kerfold-kernel/src/units/", "crates/kerfold-kernel/src/shape/"],
    ),
    ("thiserror", &[TOP, KERNEL, SHEET]),
    ("clap", &[TOP, SHEET]),
    ("nalgebra", &["crates/kerfold-kernel/src/geom/"]),
    ("nalgebra_sparse", &["crates/kerfold-kernel/src/geom/sparse.rs"]),
    ("rand_xoshiro", &["crates/kerfold-kernel/src/random.rs"]),
    ("robust", &["crates/kerfold-kernel/src/geom/predicate.rs"]),
    ("strsim", &["crates/kerfold-kernel/src/units/nearest.rs"]),
    ("spade", &["crates/kerfold-kernel/src/geom/triangulate.rs", "src/op/cut/bridge.rs"]),
    ("batsat", &["src/seam/sat.rs"]),
    ("i_overlay", &["crates/kerfold-sheet/src/sheet/kerf.rs"]),
    ("meshopt", &["src/op/simplify/"]),
    ("tobj", &["src/io/write/obj_check.rs"]),
    ("tempfile", &["src/io/output/"]),
    ("annotate_snippets", &["src/cli/"]),
    ("svg", &["src/io/sheet/svg.rs"]),
    ("sysinfo", &["src/memory.rs"]),
    (
        "roxmltree",
        &[
            "src/io/read/artwork/svg.rs",
            "src/io/read/artwork/svg_page.rs",
            "src/io/read/artwork/svg_style.rs",
            "src/io/read/threemf/",
        ],
    ),
    ("svgtypes", &["src/io/read/artwork/svg_path.rs"]),
    ("kurbo", &["src/io/read/artwork/curve.rs"]),
    ("krilla", &["src/io/report/pdf/"]),
    ("skrifa", &["src/io/report/pdf/font.rs"]),
    ("fast_float2", &["src/io/read/quick.rs"]),
    ("memchr", &["src/io/read/text.rs"]),
    (
        "rayon",
        &[
            "crates/kerfold-sheet/src/sheet/draw.rs",
            "src/check/run.rs",
            "src/gallery/mod.rs",
            "src/io/sheet/files.rs",
            "src/make/outputs.rs",
            "src/panel/overlap.rs",
            "src/panel/settle.rs",
            "src/picture/model.rs",
            "src/unfold/proof/mod.rs",
        ],
    ),
    ("foldhash", &["src/mend/weld.rs"]),
    ("hashbrown", &["src/mend/weld.rs"]),
    ("miniz_oxide", &["src/io/read/artwork/decode.rs", "src/io/read/artwork/pdf_unpack.rs"]),
    ("rust_xlsxwriter", &["src/io/panels_xlsx.rs"]),
    ("zip", &["src/io/read/threemf/package.rs", "src/io/write/threemf.rs"]),
    ("tiny_skia", &["src/picture/"]),
    ("png", &["src/picture/line_png.rs"]),
    ("serde_json", &["src/io/", "src/cli/", "src/recipe/sweep.rs"]),
    ("csv", &["src/recipe/sweep.rs"]),
    ("toml", &["src/recipe/", "src/make/materials.rs", "src/make/glue_file.rs"]),
    ("clap_complete", &["src/cli/"]),
    ("clap_mangen", &["src/cli/"]),
    ("ctrlc", &["src/cli/"]),
    ("mimalloc", &["src/main.rs"]),
];

/// What parameter structs anywhere may take from clap. The rule: whatever builds or runs a command
/// line stays in `src/cli`.
const CLAP_EVERYWHERE: &[&str] = &["Args", "ValueEnum", "value_parser", "builder"];
/// The recipe reader asks the parameter structs for their field names, schema and shell for all that
/// they say of them, so that recipe, forms and command line cannot part.
const CLAP_COMMANDS: &[&str] = &[
    "src/cli/",
    "src/main.rs",
    "src/recipe/keys.rs",
    "src/recipe/fields.rs",
    "src/recipe/schema.rs",
    "src/recipe/shell.rs",
];

/// The rule: half-edge links are written in one file, so that every mesh stays manifold by
/// construction.
const WRITER_OF_LINKS: &str = "crates/kerfold-kernel/src/mesh/store/links/mod.rs";
const LINKS: &[&str] = &["next", "prev", "origin"];

/// The rule: the library neither prints nor exits nor panics by habit. A macro or call, and the
/// only places that may have it.
const FORBIDDEN: &[(&str, &[&str], &str)] = &[
    ("println!", PRINTERS, "return data and let src/cli print it"),
    ("print!", PRINTERS, "return data and let src/cli print it"),
    ("eprintln!", PRINTERS, "return an error or report through `Progress`"),
    ("eprint!", PRINTERS, "return an error or report through `Progress`"),
    ("dbg!", &[], "remove it"),
    (
        ".unwrap()",
        &[],
        "return an error, or `expect(\"the invariant\")` where only our own bug could fail",
    ),
    ("todo!", &[], "write the code, or return an error that says what is missing"),
    ("unimplemented!", &[], "write the code, or return an error that says what is missing"),
    ("process::exit", PRINTERS, "return an error; the exit code is decided in src/cli"),
];
const PRINTERS: &[&str] = &["src/cli/", "src/main.rs"];

// ---- the tests ----------------------------------------------------------------------------------

#[test]
fn the_table_of_layers_points_downwards() {
    for (i, room) in ROOMS.iter().enumerate() {
        for used in room.may_use {
            let j = ROOMS
                .iter()
                .position(|r| r.module == *used)
                .unwrap_or_else(|| panic!("{used} is no module"));
            assert!(
                j < i && ROOMS[j].layer <= room.layer,
                "{} may not use {used}, which stands below it",
                room.module
            );
        }
    }
}

#[test]
fn every_module_has_a_row() {
    for (_, home) in CRATES {
        for line in read(&root().join(home).join("lib.rs")).lines() {
            let module =
                line.trim().strip_prefix("pub mod ").and_then(|rest| rest.strip_suffix(';'));
            if let Some(module) = module.filter(|m| !(*m == "shape" && *home == TOP)) {
                assert!(
                    find_room(module).is_some_and(|room| room.home == *home),
                    "add `{module}` to ROOMS in tests/layers.rs and to docs/architecture.md"
                );
            }
        }
    }
}

#[test]
fn every_dependency_has_a_door() {
    for (_, home) in CRATES {
        let manifest = root().join(home.trim_end_matches("src/")).join("Cargo.toml");
        for name in dependencies(&read(&manifest)) {
            let known = DOORS.iter().any(|(door, _)| *door == name);
            let is_ours = CRATES.iter().any(|(ours, _)| *ours == name);
            assert!(
                known || is_ours,
                "add `{name}` to DOORS in tests/layers.rs and its reason to docs/dependencies.md"
            );
        }
    }
}

#[test]
fn modules_use_only_what_lies_below_them() {
    hold(layer_faults);
}

#[test]
fn every_permission_is_used() {
    let faults = idle_permissions(&sources());
    assert!(faults.is_empty(), "take these out of the tables:\n{}", faults.join("\n"));
}

#[test]
fn outside_crates_come_in_by_their_doors() {
    hold(door_faults);
}

#[test]
fn no_two_files_of_a_room_use_each_other() {
    let sources = sources();
    let circles = House::new(&sources).circles();
    assert!(
        circles.is_empty(),
        "move what both need into a file of its own, or the call up to who uses both:\n{}",
        circles.join("\n")
    );
}

#[test]
fn links_are_written_in_one_file() {
    let store = read(&root().join("crates/kerfold-kernel/src/mesh/store/mod.rs"));
    let fields = store.split("struct HalfEdge {").nth(1).and_then(|rest| rest.split('}').next());
    let fields = fields.expect("mesh/store/mod.rs defines HalfEdge");
    assert!(
        !fields.contains("pub"),
        "the fields of HalfEdge stay private, else every module could write links"
    );
    hold(link_faults);
}

#[test]
fn the_library_does_not_print_exit_or_unwrap() {
    hold(habit_faults);
}

#[test]
fn functions_and_files_are_short() {
    hold(size_faults);
}

#[test]
fn planted_circles_are_found() {
    let circles = |files: &[(&str, &str)]| {
        let sources: Vec<Source> = files.iter().map(|(p, text)| Source::new(p, text)).collect();
        House::new(&sources).circles()
    };
    let room = ("src/op/mod.rs", "mod a; mod b; mod c; pub struct Top; pub use b::Thing as Found;");
    let a = ("src/op/a.rs", "use super::{Found, Top}; pub struct Other; mod inner;");
    let b = ("src/op/b.rs", "use super::Top; pub struct Thing;");
    assert!(circles(&[room, a, b]).is_empty());
    // Through a path in the code, through a group, and from a file further in.
    let back = ("src/op/b.rs", "pub struct Thing; fn f() -> super::a::Other { super::a::Other }");
    let of_ops = "kerfold::op::a and kerfold::op::b: src/op/a.rs uses src/op/b.rs";
    assert_eq!(circles(&[room, a, back]), [format!("{of_ops}, src/op/b.rs uses src/op/a.rs")]);
    let back = ("src/op/b.rs", "pub struct Thing; use crate::op::{Top, a::{self, inner::Deep}};");
    let deep = ("src/op/a/inner.rs", "pub struct Deep;");
    assert_eq!(
        circles(&[room, a, back, deep]),
        [format!("{of_ops}, src/op/b.rs uses src/op/a/inner.rs")]
    );
    // Tests may look anywhere.
    let back = ("src/op/b.rs", "pub struct Thing; #[cfg(test)] mod tests { use super::a::Other; }");
    assert!(circles(&[room, a, back]).is_empty());
}

#[test]
fn planted_violations_are_found() {
    let layer = |path: &str, text: &str| faults_of(layer_faults, path, text);
    assert_eq!(
        layer("crates/kerfold-kernel/src/geom/plane.rs", "\nuse crate::mesh::Mesh;"),
        ["crates/kerfold-kernel/src/geom/plane.rs:2"]
    );
    assert_eq!(
        layer(
            "crates/kerfold-sheet/src/sheet/place.rs",
            "use crate::{geom::Plane, net::{Net, Piece},\n mesh::Mesh};"
        )
        .len(),
        1
    );
    assert_eq!(
        layer("crates/kerfold-sheet/src/sheet/place.rs", "fn f() -> usize { crate::op::slice() }")
            .len(),
        1
    );
    assert_eq!(layer("src/seam/graph.rs", "use super::super::select::Selection;").len(), 1);
    assert_eq!(layer("src/io/obj.rs", "use crate::nowhere::X;").len(), 1);
    assert_eq!(
        layer(
            "crates/kerfold-sheet/src/net/mod.rs",
            "fn f() -> impl Iterator + use<'_> { g(); crate::io::h() }"
        )
        .len(),
        1
    );
    assert_eq!(
        layer("src/op/slice.rs", "use crate::{geom, mesh::Mesh}; use super::cutter::Cutter;").len(),
        0
    );
    let in_test = "fn f() { \"crate::cli::x\"; } // crate::cli\n#[cfg(test)]\nmod tests \
    { use crate::cli::run; fn g() {} }";
    assert_eq!(layer("crates/kerfold-kernel/src/geom/plane.rs", in_test).len(), 0);
    let after_test = "#[cfg(test)]\nmod tests { fn g() {} }\nuse crate::cli::run;";
    assert_eq!(
        layer("crates/kerfold-kernel/src/geom/plane.rs", after_test),
        ["crates/kerfold-kernel/src/geom/plane.rs:3"]
    );

    let door = |path: &str, text: &str| faults_of(door_faults, path, text);
    assert_eq!(door("crates/kerfold-kernel/src/mesh/walk.rs", "use nalgebra::Matrix3;").len(), 1);
    assert_eq!(door("src/op/slice.rs", "let x = robust::orient3d(a, b, c, d);").len(), 1);
    assert_eq!(door("src/op/slice.rs", "#[derive(Debug, clap::Args)] struct P;").len(), 0);
    assert_eq!(door("src/op/slice.rs", "#[derive(clap::Parser)] struct P;").len(), 1);
    assert_eq!(door("src/op/slice.rs", "use clap::{Args, Subcommand};").len(), 1);
    assert_eq!(door("src/cli/mod.rs", "use clap::{Args, Subcommand};").len(), 0);
    assert_eq!(
        door("src/io/mod.rs", "mod svg; pub use svg::write_svg; use super::svg::X;").len(),
        0
    );
    assert_eq!(door("crates/kerfold-sheet/src/sheet/draw.rs", "use svg::Document;").len(), 1);

    let link = |path: &str, text: &str| faults_of(link_faults, path, text);
    assert_eq!(
        link("crates/kerfold-kernel/src/mesh/walk.rs", "self.half_edges[3]\n.next = h;"),
        ["crates/kerfold-kernel/src/mesh/walk.rs:2"]
    );
    assert_eq!(
        link(
            "crates/kerfold-kernel/src/mesh/build.rs",
            "let h = HalfEdge { next, prev, origin, face };"
        )
        .len(),
        1
    );
    assert_eq!(
        link("crates/kerfold-kernel/src/mesh/walk.rs", "if a.next == b { let c = a.prev; }").len(),
        0
    );
    assert_eq!(link(WRITER_OF_LINKS, "a.next = b;").len(), 0);

    let habit = |path: &str, text: &str| faults_of(habit_faults, path, text);
    assert_eq!(
        habit("src/op/slice.rs", "x.unwrap(); todo!(); println!(\"x\"); std::process::exit(1);")
            .len(),
        4
    );
    assert_eq!(
        habit(
            "src/op/slice.rs",
            "x.unwrap_or(1); // x.unwrap()\nlet s = r#\"println!(\" todo!\"#;"
        )
        .len(),
        0
    );
    assert_eq!(habit("src/cli/mod.rs", "println!(\"x\");").len(), 0);
    assert_eq!(habit("src/cli/mod.rs", "x.unwrap();").len(), 1);

    let size = |text: &str| faults_of(size_faults, "src/op/slice.rs", text);
    let body = |lines: usize| format!("fn f() -> [u8; 2] {{{}}}", "\n".repeat(lines - 1));
    assert_eq!((size(&body(80)).len(), size(&body(81)).len()), (0, 1));
    let fields = "fn f() -> S { S { a: 1, #[cfg(test)] b: v(1, 2), #[cfg(test)] c: 3 } }\n\n";
    assert_eq!(size(&fields.repeat(41)).len(), 0);
    let seven = "fn f<F: Fn(A) -> B>(&self, a: A<B, C>, b: (B, B), c: C, d: D, e: E, f: F,) {}";
    assert_eq!(size(seven).len(), 0);
    assert_eq!(size(&seven.replace("&self", "&self, g: G")).len(), 1);
    assert_eq!(size(&format!("{}const A: u8 = 1;", "\n".repeat(600))), ["src/op/slice.rs:601"]);
}

// ---- the rules ----------------------------------------------------------------------------------

/// A broken rule, with its place and what to do.
struct Fault {
    path: String,
    line: usize,
    advice: String,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {}", self.path, self.line, self.advice)
    }
}

fn layer_faults(source: &Source) -> Vec<Fault> {
    let Some(module) = source.module() else { return Vec::new() };
    let mut faults = Vec::new();
    for path in source.paths() {
        let Some(used) = source.inner_module(&path) else { continue };
        if used == module || EVERYWHERE.contains(&used.as_str()) {
            continue;
        }
        let advice = match (find_room(module), find_room(&used)) {
            (None, _) => {
                format!("add `{module}` to ROOMS in tests/layers.rs and to docs/architecture.md")
            }
            (_, None) => format!(
                "`{used}` is no module of the table; use it by its own module, or add a row to \
                ROOMS"
            ),
            (Some(room), Some(_))
                if room.may_use.contains(&used.as_str()) || EVERYWHERE.contains(&used.as_str()) =>
            {
                continue;
            }
            (Some(room), Some(other)) => format!(
                "`{module}` (layer {}) may not use `{used}` (layer {}); it may use {}: move the \
                shared part down, or hand \
                 the value in from above",
                room.layer,
                other.layer,
                list(room.may_use)
            ),
        };
        faults.push(source.fault(path.line, advice));
    }
    faults
}

fn door_faults(source: &Source) -> Vec<Fault> {
    let mut faults = Vec::new();
    for path in source.paths() {
        let Some((name, places)) = DOORS.iter().find(|(name, _)| *name == path.segments[0]) else {
            continue;
        };
        // `mod svg;` makes `svg::` a module of this file, not the crate.
        if source.declares(name) {
            continue;
        }
        if !is_in(&source.path, places) {
            faults.push(source.fault(
                path.line,
                format!("`{name}` comes in only through {}: call that", list(places)),
            ));
        } else if *name == "clap" && !is_in(&source.path, CLAP_COMMANDS) {
            let item = path.segments.get(1).map_or("", String::as_str);
            if !CLAP_EVERYWHERE.contains(&item) {
                let advice = format!(
                    "`clap::{item}` belongs in src/cli; here only {} are used",
                    list(CLAP_EVERYWHERE)
                );
                faults.push(source.fault(path.line, advice));
            }
        }
    }
    faults
}

/// Only the mesh is looked at: the fields are private to the store, so elsewhere the compiler
/// holds the rule.
fn link_faults(source: &Source) -> Vec<Fault> {
    if source.path == WRITER_OF_LINKS || !source.path.starts_with("crates/kerfold-kernel/src/mesh/")
    {
        return Vec::new();
    }
    let is_definition = |i: usize| i > 0 && source.tokens[i - 1].text == "struct";
    let mut faults = Vec::new();
    for i in 0..source.tokens.len() {
        let assigned = LINKS.iter().find(|link| {
            source.reads(i, &[".", link, "="])
                && !source.reads(i + 3, &["="])
                && !source.reads(i + 3, &[">"])
        });
        if let Some(link) = assigned {
            let advice = format!(
                "`.{link}` is assigned only in {WRITER_OF_LINKS}: compose the operators there \
                instead"
            );
            faults.push(source.fault(source.tokens[i].line, advice));
        }
        if source.reads(i, &["HalfEdge", "{"]) && !is_definition(i) {
            let advice = format!(
                "half-edges are made only in {WRITER_OF_LINKS}: compose the operators there instead"
            );
            faults.push(source.fault(source.tokens[i].line, advice));
        }
    }
    faults
}

fn habit_faults(source: &Source) -> Vec<Fault> {
    let mut faults = Vec::new();
    for (habit, places, advice) in FORBIDDEN {
        let wanted = Source::new("", habit).tokens;
        let wanted: Vec<&str> = wanted.iter().map(|t| t.text.as_str()).collect();
        if is_in(&source.path, places) {
            continue;
        }
        for i in (0..source.tokens.len()).filter(|&i| source.reads(i, &wanted)) {
            faults
                .push(source.fault(source.tokens[i].line, format!("no `{habit}` here: {advice}")));
        }
    }
    faults
}

/// Rows of the two tables that nothing in the source needs.
fn idle_permissions(sources: &[Source]) -> Vec<String> {
    let mut used = BTreeSet::new();
    let mut entered = BTreeSet::new();
    for source in sources {
        for path in source.paths() {
            if let (Some(module), Some(other)) = (source.module(), source.inner_module(&path)) {
                used.insert((module.to_owned(), other));
            }
            entered.insert((path.segments[0].clone(), source.path.clone()));
        }
    }
    let mut idle = Vec::new();
    for room in ROOMS {
        let unused = room
            .may_use
            .iter()
            .filter(|other| !used.contains(&(room.module.to_owned(), (**other).to_owned())));
        idle.extend(unused.map(|other| format!("{} does not use {other}", room.module)));
    }
    for (name, places) in DOORS {
        let closed = places.iter().filter(|place| {
            !entered.iter().any(|(segment, path)| segment == name && path.starts_with(**place))
        });
        idle.extend(closed.map(|place| format!("{name} does not come in through {place}")));
    }
    idle
}

fn find_room(module: &str) -> Option<&'static Room> {
    ROOMS.iter().find(|room| room.module == module)
}

fn is_in(path: &str, places: &[&str]) -> bool {
    places.iter().any(|place| path.starts_with(place))
}

fn list(names: &[&str]) -> String {
    if names.is_empty() { "nothing".to_owned() } else { names.join(", ") }
}

/// The names of the normal dependencies, as code writes them.
fn dependencies(manifest: &str) -> Vec<String> {
    let section = manifest.lines().skip_while(|line| line.trim() != "[dependencies]").skip(1);
    let section = section.filter(|line| !line.trim_start().starts_with('#'));
    let names =
        section.take_while(|line| !line.starts_with('[')).filter_map(|line| line.split_once('='));
    names.map(|(name, _)| name.trim().trim_end_matches(".workspace").replace('-', "_")).collect()
}

/// Asserts that a rule finds no fault in the source of all crates.
#[track_caller]
fn hold(rule: fn(&Source) -> Vec<Fault>) {
    let sources = sources();
    assert!(sources.len() > 20, "the source was not found");
    let faults: Vec<String> =
        sources.iter().flat_map(rule).map(|fault| fault.to_string()).collect();
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}

/// The places of the faults that a rule finds in a text.
fn faults_of(rule: fn(&Source) -> Vec<Fault>, path: &str, text: &str) -> Vec<String> {
    rule(&Source::new(path, text))
        .into_iter()
        .map(|fault| format!("{}:{}", fault.path, fault.line))
        .collect()
}
