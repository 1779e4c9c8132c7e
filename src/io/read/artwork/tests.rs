use std::f64::consts::{PI, TAU};
use std::path::Path;

use super::*;

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
