use std::f64::consts::{PI, TAU};
use std::path::Path;

use glam::DVec2;

use super::*;
use crate::lint::{ArtPath, Operation, UnitState};

fn one(name: &str, text: &str) -> Artwork {
    read_artwork(Path::new(name), text.as_bytes()).unwrap_or_else(|e| panic!("{e}")).1.remove(0)
}

fn length(path: &ArtPath) -> f64 {
    let n = path.points.len();
    (0..n - usize::from(!path.closed))
        .map(|i| path.points[i].distance(path.points[(i + 1) % n]))
        .sum()
}

fn svg(body: &str) -> Artwork {
    let head = "<svg xmlns='http://www.w3.org/2000/svg' width='100mm' height='50mm' viewBox='0 0 \
    200 100'>";
    one("x.svg", &format!("{head}{body}</svg>"))
}

#[test]
fn svg_units_views_and_transforms_end_in_millimetres_with_y_up() {
    let art = svg("<g transform='translate(20,10) scale(2)'><path d='m 0 0 h 10 v 5 z'/></g>");
    assert_eq!((art.size, &art.unit), (Some(DVec2::new(100.0, 50.0)), &UnitState::Known));
    let expected = [(10.0, 45.0), (20.0, 45.0), (20.0, 40.0)].map(DVec2::from);
    assert!(
        art.paths[0].points.iter().zip(expected).all(|(p, q)| p.distance(q) < 1e-9),
        "{:?}",
        art.paths[0]
    );
    assert!(art.paths[0].closed);
}

#[test]
fn svg_curves_have_their_lengths() {
    // Millimetres are half of user units here.
    for (body, expected) in [
        ("<circle cx='50' cy='50' r='40'/>", 20.0 * TAU),
        ("<path d='M 10 50 a 40 40 0 1 1 0.0001 0 z'/>", 20.0 * TAU),
        ("<path d='M 10,50 A 40,40,0,0,1,90,50'/>", 20.0 * PI),
        ("<path d='M10 50A40 40 0 0190 50'/>", 20.0 * PI),
        ("<path d='M0 0C0 55.228 44.772 100 100 100'/>", 25.0 * PI),
        ("<path d='M0 0Q50 50 100 0T200 0'/>", 114.779),
        ("<rect width='60' height='40' rx='10'/>", 40.0 + 20.0 + 5.0 * TAU),
        ("<polyline points='0,0 30,40 60,0'/>", 50.0),
    ] {
        let art = svg(body);
        let found = length(&art.paths[0]);
        assert!((found - expected).abs() < 0.02 * expected.sqrt(), "{body}: {found} {expected}");
    }
}

#[test]
fn svg_styles_layers_uses_and_hidden_things() {
    let art = svg("<style>.c{stroke:#f00;fill:none} #h{display:none}</style><defs><path id='p' \
    d='M0 0H10'/></defs>
         <g id='Fold lines'><path class='c' d='M0 0H10'/></g>
         <path class='c' d='M0 1H10'/><path style='stroke:blue' d='M0 2H10'/><path stroke='black' d='M0 3H10'/>
         <path id='h' d='M0 4H10'/><path fill='none' d='M0 5H10'/>
         <use href='#p' x='5' y='6' stroke='red'/><image href='x.png'/>");
    let operations: Vec<Operation> = art.paths.iter().map(|p| p.operation).collect();
    assert_eq!(
        operations,
        [Operation::Score, Operation::Cut, Operation::Score, Operation::Engrave, Operation::Cut]
    );
    assert!(art.paths[4].points[0].distance(DVec2::new(2.5, 47.0)) < 1e-9);
    assert_eq!(art.unread, [("image".to_owned(), 1)]);
}

fn dxf(units: i32, blocks: &str, entities: &str) -> Artwork {
    let sections = format!(
        "0 SECTION 2 HEADER 9 $INSUNITS 70 {units} 0 ENDSEC 0 SECTION 2 BLOCKS {blocks} 0 ENDSEC 0 \
        SECTION 2 ENTITIES \
         {entities} 0 ENDSEC 0 EOF"
    );
    one("x.dxf", &sections.split_whitespace().map(|w| format!("{w}\n")).collect::<String>())
}

#[test]
fn dxf_entities_have_their_lengths_in_millimetres() {
    for (entity, expected) in [
        ("0 LINE 8 0 10 0 20 0 11 3 21 4", 5.0),
        ("0 CIRCLE 8 0 10 5 20 5 40 10", 10.0 * TAU),
        ("0 ARC 8 0 10 5 20 5 40 10 50 270 51 90", 10.0 * PI),
        ("0 LWPOLYLINE 8 0 90 2 70 1 10 0 20 0 42 1 10 20 20 0 42 1", 10.0 * TAU),
        ("0 LWPOLYLINE 8 0 90 2 70 0 10 0 20 0 42 -1 10 20 20 0", 10.0 * PI),
        (
            "0 POLYLINE 8 0 70 1 0 VERTEX 10 0 20 0 0 VERTEX 10 3 20 0 0 VERTEX 10 0 20 4 0 SEQEND",
            12.0,
        ),
        ("0 ELLIPSE 8 0 10 0 20 0 11 10 21 0 40 1 41 0 42 3.14159265", 10.0 * PI),
        (
            "0 SPLINE 8 0 70 0 71 2 72 6 73 3 40 0 40 0 40 0 40 1 40 1 40 1 41 1 41 0.70710678 41 \
            1 \
             10 10 20 0 10 10 20 10 10 0 20 10",
            5.0 * PI,
        ),
    ] {
        let mm = length(&dxf(4, "", entity).paths[0]);
        assert!((mm - expected).abs() < 0.02 * expected.sqrt(), "{entity}: {mm} {expected}");
        let inches = length(&dxf(1, "", entity).paths[0]);
        assert!(
            (inches - 25.4 * expected).abs() < 0.1 * (25.4 * expected).sqrt(),
            "{entity}: {inches}"
        );
    }
}

#[test]
fn dxf_blocks_are_put_turned_scaled_and_repeated() {
    let block = "0 BLOCK 2 B 10 1 20 0 0 LINE 8 0 10 1 20 0 11 2 21 0 0 ENDBLK";
    let art = dxf(4, block, "0 INSERT 2 B 8 SCORE 10 10 20 20 41 3 42 3 50 90 70 2 44 5");
    assert_eq!(art.paths.len(), 2);
    let expected = [[(10.0, 20.0), (10.0, 23.0)], [(10.0, 25.0), (10.0, 28.0)]];
    for (path, ends) in art.paths.iter().zip(expected) {
        assert_eq!(path.operation, Operation::Score);
        assert!(path.points.iter().zip(ends).all(|(p, q)| p.distance(q.into()) < 1e-9), "{path:?}");
    }
    let own = "0 BLOCK 2 B 10 0 20 0 0 INSERT 2 B 10 0 20 0 0 ENDBLK";
    let sections = format!(
        "0 SECTION 2 BLOCKS {own} 0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 2 B 10 0 20 0 0 ENDSEC 0 \
        EOF"
    );
    let text: String = sections.split_whitespace().map(|w| format!("{w}\n")).collect();
    assert_eq!(read_artwork(Path::new("x.dxf"), text.as_bytes()).err(), Some(ArtError::TooDeep));
}

/// A PDF with a packed page, a form, and objects in an object stream, as other programs write them.
fn packed_pdf() -> Vec<u8> {
    let pack = |bytes: &[u8]| miniz_oxide::deflate::compress_to_vec_zlib(bytes, 6);
    let inner = "1 0 2 33 3 77 << /Type /Catalog /Pages 2 0 R >> << /Type /Pages /Count 1 /Kids [3 \
    0 R] >>   \
                 << /Type /Page /Parent 2 0 R /MediaBox [0 0 144 72] /Rotate 90 /Contents 4 0 R /Resources << /XObject << /F 5 0 R >> >> >>";
    let first = inner.find("<<").expect("a dictionary");
    let offset = |what: &str| inner.find(what).expect("an object") - first;
    let head = format!("1 0 2 {} 3 {} ", offset("<< /Type /Pages"), offset("<< /Type /Page /P"));
    let objects = format!("{head}{}", &inner[first..]);
    let mut file = b"%PDF-1.5\n".to_vec();
    let mut add = |id: u32, dict: &str, bytes: &[u8]| {
        file.extend(format!("{id} 0 obj\n<< {dict} /Length {} >>\nstream\n", bytes.len()).bytes());
        file.extend(bytes);
        file.extend(b"\nendstream\nendobj\n");
    };
    add(
        7,
        &format!("/Type /ObjStm /N 3 /First {} /Filter /FlateDecode", head.len()),
        &pack(objects.as_bytes()),
    );
    add(4, "/Filter /FlateDecode", &pack(b"1 0 0 RG q 2 0 0 2 0 0 cm /F Do Q 0 0 m 72 0 l S"));
    add(5, "/Type /XObject /Subtype /Form /BBox [0 0 9 9] /Matrix [1 0 0 1 9 0]", b"0 0 9 9 re S");
    file
}

#[test]
fn pdf_pages_are_found_unpacked_turned_and_their_forms_followed() {
    let (format, pages) =
        read_artwork(Path::new("x"), &packed_pdf()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((format, pages.len()), (ArtFormat::Pdf, 1));
    let art = &pages[0];
    assert_eq!(art.size, Some(DVec2::new(25.4, 50.8)));
    assert_eq!(art.paths.len(), 2);
    assert!((length(&art.paths[0]) - 72.0 * 25.4 / 72.0).abs() < 1e-9 && art.paths[0].closed);
    // Turned clockwise, the lower left corner comes to the upper left.
    assert!(art.paths[1].points[0].distance(DVec2::new(0.0, 50.8)) < 1e-9, "{:?}", art.paths[1]);
    assert!(art.paths[1].points[1].distance(DVec2::new(0.0, 25.4)) < 1e-9, "{:?}", art.paths[1]);
}

#[test]
fn cut_off_and_garbled_files_end_in_words_not_in_panics() {
    let samples = [
        packed_pdf(),
        std::fs::read("fixtures/lint/good.svg").expect("a fixture"),
        std::fs::read("fixtures/lint/good.dxf").expect("a fixture"),
        std::fs::read("fixtures/lint/06-text.pdf").expect("a fixture"),
    ];
    for bytes in samples {
        for end in (0..bytes.len()).step_by(7) {
            let _ = read_artwork(Path::new("x"), &bytes[..end]);
            let mut garbled = bytes.clone();
            garbled[end] ^= 0x55;
            let _ = read_artwork(Path::new("x"), &garbled);
        }
    }
}

#[test]
fn bombs_end_in_an_error_with_the_limit() {
    let tens = |one: &str| one.repeat(10);
    let uses =
        (1..8).map(|k| format!("<g id='l{k}'>{}</g>", tens(&format!("<use href='#l{}'/>", k - 1))));
    let uses: String = uses.collect();
    let svg = format!(
        "<svg xmlns='http://www.w3.org/2000/svg'><path id='l0' d='M0 0h1'/>{uses}<use href='#l7'/></svg>"
    );
    let entity = format!("<!DOCTYPE svg [<!ENTITY a '{}'>]>", "x".repeat(100_000));
    let entities = format!(
        "{entity}<svg xmlns='http://www.w3.org/2000/svg'><text>{}</text></svg>",
        "&a;".repeat(2000)
    );
    let far = format!(
        "<svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0{}'/></svg>",
        "C0 9e6 9e6 0 9e6 9e6".repeat(90)
    );
    let attributes = "a='' ".repeat(3000);
    let attributes = format!("<svg xmlns='http://www.w3.org/2000/svg' {attributes}/>");
    let block = "0 BLOCK 2 A 0 LINE 10 0 20 0 11 1 21 1 0 ENDBLK";
    let arrays = format!(
        "0 SECTION 2 BLOCKS {block} 0 ENDSEC 0 SECTION 2 ENTITIES 0 INSERT 2 A 70 1000 71 1000 0 \
        ENDSEC 0 EOF"
    );
    let arrays = arrays.split_whitespace().map(|w| format!("{w}\n")).collect::<String>();
    let page = "%PDF-1.4 1 0 obj <</Type/Catalog/Pages 2 0 R>> endobj 3 0 obj \
                <</Type/Pages/Kids[4 0 R]>> endobj 4 0 obj <</Type/Page/Contents 5 0 R>> endobj";
    let pages = format!("{page} 2 0 obj <</Type/Pages/Kids[{}]>> endobj", "4 0 R ".repeat(1001));
    let open = format!(
        "{page} 2 0 obj <</Type/Pages/Kids[4 0 R]>> endobj 5 0 obj <<>> stream {} endstream",
        "q ".repeat(5000)
    );
    let bombs = [
        svg.as_str(),
        &entities,
        &far,
        &attributes,
        arrays.as_str(),
        pages.as_str(),
        open.as_str(),
    ];
    for bomb in bombs {
        let error = read_artwork(Path::new("x.svg"), bomb.as_bytes()).err();
        assert!(matches!(error, Some(ArtError::TooMuch { .. })), "{error:?}");
    }
}

#[test]
fn numbers_that_are_none_are_named() {
    for body in [
        "<path id='p' d='M0 0L1e999 5'/>",
        "<circle id='p' r='1e999'/>",
        "<path id='p' d='M0 0L1e30 5'/>",
        "<g transform='scale(1e300)'><path id='p' d='M0 0L1e30 5'/></g>",
    ] {
        let text = format!("<svg xmlns='http://www.w3.org/2000/svg' width='9mm'>{body}</svg>");
        let error = read_artwork(Path::new("x"), text.as_bytes()).map_err(|e| e.to_string());
        assert!(error.as_ref().is_err_and(|e| e.contains('p')), "{body}: {error:?}");
    }
    for (code, number) in [(40, "inf"), (40, "nan"), (10, "1e20"), (40, "1e400")] {
        let circle =
            format!("0 SECTION 2 ENTITIES 0 CIRCLE {code} {number} 10 1 20 1 40 2 0 ENDSEC 0 EOF");
        let circle: String = circle.split_whitespace().map(|w| format!("{w}\n")).collect();
        let error = read_artwork(Path::new("x.dxf"), circle.as_bytes()).err();
        assert!(matches!(error, Some(ArtError::OutOfRange { .. })), "{number}: {error:?}");
    }
}

#[test]
fn svg_pages_are_as_large_as_they_say() {
    let page = |attributes: &str| {
        let text = format!(
            "<svg xmlns='http://www.w3.org/2000/svg' {attributes}><path d='M0 0h90'/></svg>"
        );
        let art = one("x.svg", &text);
        (art.size, art.unit == UnitState::Known, length(&art.paths[0]))
    };
    for side in ["width='100mm'", "height='60mm'", "width='100mm' height='100%'"] {
        let (size, is_known, length) = page(&format!("{side} viewBox='0 0 200 120'"));
        assert!(size.is_some_and(|s| s.distance(DVec2::new(100.0, 60.0)) < 1e-9) && is_known);
        assert!((length - 45.0).abs() < 1e-9, "{side}: {length}");
    }
    assert!(!page("viewBox='0 0 200 120'").1);
    let old = "xmlns:inkscape='http://www.inkscape.org/namespaces/inkscape' width='50.8mm' \
               height='25.4mm' inkscape:version=";
    assert!((page(&format!("{old}'0.48.4 r9939'")).2 - 25.4).abs() < 1e-9);
    assert!((page(&format!("{old}'0.92.3'")).2 - 25.4 * 90.0 / 96.0).abs() < 1e-9);
}

#[test]
fn svg_styles_win_over_attributes_and_visibility_is_inherited() {
    let art = svg("<style>path{stroke:blue} #b{stroke:lime !important}</style>\
         <path display='none' style='display:inline' d='M0 0H10'/>\
         <path stroke='red' d='M0 1H10'/><path id='b' style='stroke:red' d='M0 2H10'/>\
         <g visibility='hidden'><path d='M0 3H10'/><path visibility='visible' d='M0 4H10'/></g>\
         <text x='2' y='2'>Lid</text><path clip-path='url(#c)' d='M0 5H10'/>");
    assert_eq!(art.paths.len(), 5);
    assert_eq!(art.texts.iter().map(|t| t.text.as_str()).collect::<Vec<_>>(), ["Lid"]);
    assert!(art.unread[0].0.starts_with("clip-path"), "{:?}", art.unread);
}

#[test]
fn svg_is_read_in_other_encodings_and_packed() {
    let text = "<?xml version='1.0' encoding='ISO-8859-1'?><svg \
                xmlns='http://www.w3.org/2000/svg'><path id='Köln' d='M0 0h9'/></svg>";
    let latin: Vec<u8> = text.chars().map(|c| c as u32 as u8).collect();
    let wide = |swap: bool| {
        let units = std::iter::once(0xfeff).chain(text.encode_utf16());
        units.flat_map(|u| if swap { u.to_be_bytes() } else { u.to_le_bytes() }).collect()
    };
    let packed = miniz_oxide::deflate::compress_to_vec(text.as_bytes(), 6);
    let gzip = [b"\x1f\x8b\x08\x08\0\0\0\0\0\x03x.svg\0".to_vec(), packed].concat();
    for bytes in [text.as_bytes().to_vec(), latin, wide(false), wide(true), gzip] {
        let art =
            read_artwork(Path::new("x"), &bytes).unwrap_or_else(|e| panic!("{e}")).1.remove(0);
        assert_eq!(art.paths[0].name.as_deref(), Some("Köln"));
    }
}

#[test]
fn dxf_names_know_no_case_and_missing_blocks_are_named() {
    let layers = "0 SECTION 2 TABLES 0 LAYER 2 OFF 62 -7 0 LAYER 2 ICE 70 1 62 7 0 LAYER 2 SHY 62 7 \
                  290 0 0 ENDSEC";
    let block = "0 BLOCK 2 Door 10 0 20 0 0 LINE 8 cut 10 0 20 0 11 5 21 0 0 ENDBLK";
    let entities = "0 INSERT 8 off 2 dOOR 10 1 20 1 0 INSERT 8 ice 2 DOOR 10 1 20 1 0 INSERT 2 gate \
                    0 LINE 8 Off 10 0 20 0 11 1 21 1 0 LINE 8 shy 10 0 20 0 11 1 21 1";
    let art = dxf(4, &format!("{block} 0 ENDSEC {layers} 0 SECTION 2 REST"), entities);
    // What is not plotted is there, and never machined.
    let operations: Vec<Operation> = art.paths.iter().map(|p| p.operation).collect();
    assert_eq!(operations, [Operation::Cut, Operation::Info]);
    let kinds: Vec<&str> = art.unread.iter().map(|(kind, _)| kind.as_str()).collect();
    assert_eq!(kinds.len(), 4, "{kinds:?}");
    assert!(kinds.iter().any(|kind| kind.contains("`gate`")), "{kinds:?}");
}

#[test]
fn dxf_curves_with_normal_down_stay_and_run_the_other_way() {
    let down = "210 0 220 0 230 -1";
    let quarter = format!("0 ELLIPSE 10 50 20 50 11 20 21 0 40 0.5 41 0 42 1.5707963267949 {down}");
    let art = dxf(4, "", &quarter);
    let last = art.paths[0].points.last().copied().unwrap_or_default();
    assert!(last.distance(DVec2::new(50.0, 40.0)) < 1e-9, "{last}");
    // Circles are in a plane of their own, which is turned over.
    let circle = dxf(4, "", &format!("0 CIRCLE 10 50 20 50 40 3 {down}"));
    assert!(circle.paths[0].points.iter().all(|p| p.x < 0.0));
    let tilted = dxf(4, "", "0 CIRCLE 10 0 20 0 40 3 210 1 220 0 230 1");
    assert_eq!(tilted.not_flat.map(|n| n.0), Some(1));
    assert_eq!(dxf(4, "", "0 LINE 10 0 20 0 30 1 11 5 21 0 31 1").not_flat, None);
}

/// What a PDF can hold, cut off at each of its bytes: every object may be the last, and half there.
#[test]
fn a_pdf_may_end_anywhere() {
    let whole = b"%PDF-1.4\n1 0 obj\n<< /Type /Catalog /Na#20me [(a\\)(b)\\\\) <4a4B> 12 0 R -.5 true null] \
        /Length 9 >>\nstream\r\n0 0 m {1} \nendstream\nendobj\n2 0 obj (\\(\\";
    for end in 0..=whole.len() {
        // Half a file is refused or has no lines; neither is a reason to stop.
        if let Ok((_, pages)) = read_artwork(Path::new("half.pdf"), &whole[..end]) {
            assert!(pages.iter().all(|page| page.paths.is_empty()), "{end}");
        }
    }
}
