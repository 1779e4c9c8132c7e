use super::*;
use crate::check::{CheckParams, Details, Report, Requirement, check, details};
use crate::io::report::page::{ReportPictures, ReportRows};
use crate::make::report_pictures;
use crate::mesh::Mesh;
use crate::picture::RenderParams;
use crate::shape::{SolidParams, solid};

struct NewElements {
    report: Report,
    details: Details,
    pictures: ReportPictures,
}

impl NewElements {
    fn of(mesh: &Mesh) -> Self {
        let params = CheckParams { require: vec![Requirement::Valence3], ..CheckParams::default() };
        let report = check(mesh, &params).expect("good limits");
        let pictures = report_pictures(mesh, &report, &RenderParams::default())
            .expect("a model that can be drawn");
        Self { details: details(mesh), report, pictures }
    }

    fn page(&self, rows: ReportRows) -> ReportPage<'_> {
        let Self { report, details, pictures } = self;
        ReportPage {
            title: "a (b) \\ é 日.obj",
            report,
            details,
            pictures,
            rows,
            command: "kerfold check 'a.obj'",
        }
    }
}

/// A geodesic sphere whose corners were pulled about, divided into quads.
fn bent() -> Mesh {
    let params =
        SolidParams { name: "cuboctahedron".parse().expect("a name"), edge: None, size: None };
    let mut mesh = solid(&params).expect("a solid");
    let v = mesh.vertices().next().expect("a corner");
    mesh.set_position(v, mesh.position(v) * 1.2, true);
    mesh
}

/// Every stream of a file, unpacked; text as it is, pictures as pixels.
fn streams(pdf: &[u8]) -> Vec<(String, Vec<u8>)> {
    let find = |from: usize, what: &[u8]| (from..pdf.len()).find(|&i| pdf[i..].starts_with(what));
    let (mut found, mut at) = (Vec::new(), 0);
    while let Some(start) = find(at, b"/Length ") {
        let begin = find(start, b"stream\n").expect("a stream") + 7;
        let words = String::from_utf8_lossy(&pdf[start + 8..begin]).into_owned();
        let length: usize = words.split(' ').next().and_then(|n| n.parse().ok()).expect("a length");
        let object =
            (0..start).rev().find(|&i| pdf[i..].starts_with(b"<< ")).expect("a dictionary");
        let dictionary = String::from_utf8_lossy(&pdf[object..begin]).into_owned();
        let bytes = miniz_oxide::inflate::decompress_to_vec_zlib(&pdf[begin..begin + length])
            .expect("packed");
        found.push((dictionary, bytes));
        at = begin + length;
    }
    found
}

/// All strings that are shown, with the codes of signs as they are.
fn shown_strings(pdf: &[u8]) -> Vec<String> {
    let pages = streams(pdf).into_iter().filter(|(dictionary, _)| !dictionary.contains("/Image"));
    let text: String = pages.map(|(_, bytes)| String::from_utf8(bytes).expect("ASCII")).collect();
    let shown = text.lines().filter_map(|line| line.strip_suffix(" Tj ET")?.split_once(" Td "));
    shown.map(|(_, string)| string[1..string.len() - 1].to_owned()).collect()
}

#[test]
fn the_file_is_whole() {
    let made = NewElements::of(&bent());
    let pdf = check_pdf(&made.page(ReportRows::Worst));
    assert!(pdf.starts_with(b"%PDF-1.5\n") && pdf.ends_with(b"%%EOF\n"));
    // The table of places points at every object.
    let table =
        (0..pdf.len()).rev().find(|&i| pdf[i..].starts_with(b"\nxref\n")).expect("a table") + 1;
    let text = String::from_utf8(pdf[table..].to_vec()).expect("ASCII");
    let places = text.lines().filter_map(|line| line.strip_suffix(" 00000 n "));
    let mut count = 0;
    for (i, place) in places.enumerate() {
        let place: usize = place.parse().expect("a number");
        assert!(pdf[place..].starts_with(format!("{} 0 obj\n", i + 1).as_bytes()));
        count += 1;
    }
    assert!(text.contains(&format!("/Size {} ", count + 1)));
    let images = streams(&pdf).into_iter().filter(|(dictionary, _)| dictionary.contains("/Image"));
    let sizes: Vec<usize> = images.map(|(_, bytes)| bytes.len()).collect();
    assert_eq!(sizes[..3], [1400 * 640 * 3, 800 * 600 * 3, 800 * 600 * 3]);
    assert_eq!(sizes.len(), 3 + 2 * made.pictures.panels.len());
    assert!(made.pictures.panels.len() > 1 && sizes[3..].iter().all(|&size| size == 320 * 240 * 3));
    assert_eq!(pdf, check_pdf(&made.page(ReportRows::Worst)), "the same bytes each time");
}

#[test]
fn everything_that_the_content_says_is_on_the_pages() {
    let made = NewElements::of(&bent());
    for rows in [ReportRows::Worst, ReportRows::All] {
        let page = made.page(rows);
        let shown = shown_strings(&check_pdf(&page));
        let all = shown.concat();
        let is_there = |text: &str| {
            // Lines end between words: spaces at their ends are not printed.
            let bare = |text: &str| text.replace(' ', "");
            let string = font::string(text);
            assert!(bare(&all).contains(&bare(&string[1..string.len() - 1])), "{text} is missing");
        };
        let content = content(&page);
        is_there(content.title);
        is_there(&content.verdict.1);
        content
            .facts
            .iter()
            .for_each(|(name, value)| [*name, &plain(value)].into_iter().for_each(is_there));
        content.views.iter().for_each(|view| is_there(&view.caption));
        for section in &content.sections {
            is_there(&section.title);
            for block in &section.blocks {
                match block {
                    Block::Text(words) | Block::Note(words) => is_there(&plain(words)),
                    Block::Table(table) => {
                        assert!(
                            !table.rows.is_empty()
                                && table.rows.iter().all(|r| r.len() == table.head.len())
                        );
                        table.rows.iter().flatten().for_each(|words| is_there(&plain(words)));
                    }
                    Block::Chart(chart) => {
                        is_there(chart.axis);
                        chart
                            .bars
                            .iter()
                            .filter(|b| b.count > 0)
                            .for_each(|b| is_there(&b.count.to_string()));
                    }
                    Block::Panels(cards) => cards.iter().for_each(|card| is_there(&card.name)),
                    Block::Terms(list) => {
                        list.iter().for_each(|(a, b)| [*a, *b].into_iter().for_each(is_there))
                    }
                }
            }
        }
        assert!(shown.iter().any(|s| s.starts_with("Page 1 of ")));
    }
}

#[test]
fn long_tables_go_on_with_their_head_and_nothing_leaves_the_paper() {
    let name = "geodesic-4".parse().expect("a name");
    let mesh = solid(&SolidParams { name, edge: None, size: None }).expect("a solid");
    let made = NewElements::of(&mesh);
    let pdf = check_pdf(&made.page(ReportRows::All));
    let shown = shown_strings(&pdf);
    let heads = shown.iter().filter(|s| s.as_str() == "Conical residual, mm/mm").count();
    assert!(heads >= 3, "{heads} heads for {} nodes", mesh.vertex_count());
    for (_, page) in streams(&pdf).iter().filter(|(dictionary, _)| !dictionary.contains("/Image")) {
        let text = String::from_utf8(page.clone()).expect("ASCII");
        for line in text.lines().filter_map(|line| line.split_once(" Td ")) {
            let place: Vec<f64> =
                line.0.rsplit(' ').take(2).filter_map(|n| n.parse().ok()).collect();
            assert!(
                (20.0..820.0).contains(&place[0]) && (40.0..560.0).contains(&place[1]),
                "{line:?}"
            );
        }
    }
}
