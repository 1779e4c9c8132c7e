//! DXF, PDF and LightBurn files of a small net, judged by what their formats demand; readers that
//! others wrote judge them in `.ci/readers`.

use kerfold::io::sheet::dxf::write_dxf;
use kerfold::io::sheet::files::sheet_files;
use kerfold::io::sheet::lbrn2::write_lbrn2;
use kerfold::io::sheet::pdf::tiles::write_tiles;
use kerfold::io::sheet::pdf::write_pdf;
use kerfold::progress::Silent;
use kerfold::recipe::{Job, Recipe};
use kerfold::sheet::{Drawing, FileParams, Paper, PartFiles, Preset, SheetParams};

const COMMAND: &str = "kerfold unfold \"a&b\".obj --score (x) \u{e4} \u{1}";

fn drawing() -> Drawing {
    let text = "[[step]]\nsolid = \"cube\"\nsize = \"40mm\"\n[[step]]\nunfold = \"auto\"\nsheet = \
    \"300x200\"\nscore = \"dashed\"";
    let recipe = Recipe::parse(text).expect("a recipe");
    let job = Job::run(&recipe, std::path::Path::new(""), &Silent).expect("a cube");
    job.fabrication.expect("pieces").0.sheets.drawings.remove(0)
}

/// Group codes with their values.
fn pairs(text: &str) -> Vec<(u16, &str)> {
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines.len().is_multiple_of(2) && text.is_ascii());
    lines.chunks(2).map(|pair| (pair[0].trim().parse().expect("a group code"), pair[1])).collect()
}

#[test]
fn dxf_has_every_stroke_closed_cuts_and_no_handle_twice() {
    let drawing = drawing();
    let text = write_dxf(&drawing, Preset::RedCut, COMMAND);
    let pairs = pairs(&text);
    assert_eq!(pairs[0], (999, r#"kerfold unfold "a&b".obj --score (x) \U+00E4  "#));
    let value = |name: &str| pairs.iter().position(|p| *p == (9, name)).map(|i| pairs[i + 1].1);
    assert_eq!(
        ["$ACADVER", "$INSUNITS", "$MEASUREMENT"].map(value),
        [Some("AC1015"), Some("4"), Some("1")]
    );
    let mut handles: Vec<&str> =
        pairs.iter().filter(|p| matches!(p.0, 5 | 105)).map(|p| p.1).collect();
    // The seed for the next handle stands in the header and is larger than all others.
    let seed = u32::from_str_radix(handles.remove(0), 16).expect("a handle");
    let count = handles.len();
    assert!(handles.iter().all(|h| u32::from_str_radix(h, 16).expect("a handle") < seed));
    handles.sort_unstable();
    handles.dedup();
    assert_eq!(handles.len(), count);
    let strokes: usize = drawing.marks().map(|m| m.strokes.len()).sum();
    let begins: Vec<usize> = (0..pairs.len()).filter(|&i| pairs[i] == (0, "LWPOLYLINE")).collect();
    assert_eq!(begins.len(), strokes);
    for i in begins {
        let entity: Vec<_> = pairs[i + 1..].iter().take_while(|p| p.0 != 0).collect();
        let of = |code: u16| entity.iter().find(|p| p.0 == code).map(|p| p.1);
        let is_cut = of(8).is_some_and(|layer| layer.starts_with("CUT"));
        assert!(!is_cut || of(70) == Some("1"), "{entity:?}");
        let corners = entity.iter().filter(|p| p.0 == 10).count();
        assert_eq!(of(90).and_then(|n| n.parse().ok()), Some(corners));
    }
}

#[test]
fn pdf_offsets_lead_to_their_objects_and_the_page_is_the_sheet() {
    let drawing = drawing();
    let tiles = write_tiles(&drawing, Paper::A4, Preset::RedCut, COMMAND).expect("known letters");
    for (bytes, size) in [
        (write_pdf(&drawing, Preset::RedCut, COMMAND), "[0 0 850.3937 566.9291]"),
        (tiles, "[0 0 595.2756 841.8898]"),
    ] {
        let text = String::from_utf8(bytes).expect("ASCII");
        let start: usize =
            text.lines().rev().nth(1).and_then(|l| l.parse().ok()).expect("where the table is");
        let table: Vec<&str> = text[start..].lines().collect();
        assert_eq!(table[0], "xref");
        let entries: Vec<&str> =
            table[2..].iter().copied().take_while(|l| *l != "trailer").collect();
        for (number, line) in entries.iter().enumerate().skip(1) {
            let offset: usize = line[..10].parse().expect("an offset");
            assert!(text[offset..].starts_with(&format!("{number} 0 obj\n")), "{line}");
        }
        assert!(text.contains(size), "{size}");
        assert!(text.contains("/Subject <FEFF006B"), "the command has a letter outside ASCII");
    }
}

#[test]
fn lbrn2_has_settings_in_working_order_and_closed_cuts() {
    let text = write_lbrn2(&drawing(), |_| Some(20.0), COMMAND);
    let document = roxmltree::Document::parse(&text).expect("well-formed XML");
    let value = |node: roxmltree::Node<'_, '_>, name: &str| -> f64 {
        let child = node.children().find(|c| c.has_tag_name(name)).expect(name);
        child.attribute("Value").and_then(|v| v.parse().ok()).expect(name)
    };
    let settings = document.descendants().filter(|n| n.has_tag_name("CutSetting"));
    let orders: Vec<(f64, f64)> =
        settings.map(|s| (value(s, "index"), value(s, "priority"))).collect();
    assert_eq!(orders, [(3.0, 0.0), (2.0, 1.0), (1.0, 2.0), (0.0, 3.0), (30.0, 4.0)]);
    let paths = document.descendants().filter(|n| n.attribute("Type") == Some("Path"));
    let mut cuts = 0;
    for path in paths {
        let text = |name: &str| {
            path.children().find(|c| c.has_tag_name(name)).and_then(|c| c.text()).expect(name)
        };
        let (corners, lines) =
            (text("VertList").matches('V').count(), text("PrimList").matches('L').count());
        let is_cut = path.attribute("CutIndex") == Some("0");
        cuts += usize::from(is_cut);
        assert!(lines == corners - usize::from(!is_cut) || lines == corners, "{corners} {lines}");
        assert!(!is_cut || text("PrimList").ends_with(" 0"));
    }
    assert_eq!(cuts, 1);
}

#[test]
fn files_are_named_by_sheet_part_and_paper_and_twice_the_same() {
    let drawings = [drawing()];
    let params = SheetParams {
        files: FileParams {
            format: "lbrn2,dxf,svg".parse().expect("formats"),
            tile: Some(Paper::Letter),
            part_files: PartFiles::On,
            ..FileParams::default()
        },
        ..SheetParams::default()
    };
    let files = sheet_files(&drawings, &params, COMMAND).expect("known letters");
    let names: Vec<&str> = files.iter().map(|f| f.0.as_str()).collect();
    let sheet = ["sheet-01.svg", "sheet-01.dxf", "sheet-01.lbrn2"];
    assert_eq!(
        names,
        [&sheet[..], &["P01.svg", "P01.dxf", "P01.lbrn2", "sheet-01-letter.pdf"]].concat()
    );
    assert_eq!(sheet_files(&drawings, &params, COMMAND), Ok(files));
}
