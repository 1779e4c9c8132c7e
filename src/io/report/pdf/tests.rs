use super::paper::Shape;
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

/// All texts of the pages.
fn texts(paper: &Paper) -> Vec<String> {
    let shown = paper.marks.iter().filter_map(|mark| match &mark.shape {
        Shape::Text { text, .. } => Some(text.clone()),
        _ => None,
    });
    shown.collect()
}

/// How often a name stands in a file, outside what is packed.
fn count(pdf: &[u8], name: &str) -> usize {
    pdf.windows(name.len()).filter(|window| *window == name.as_bytes()).count()
}

#[test]
fn the_file_is_tagged_has_its_fonts_and_pictures_and_is_the_same_each_time() {
    let made = NewElements::of(&bent());
    let page = made.page(ReportRows::Worst);
    let pdf = check_pdf(&page);
    assert!(pdf.starts_with(b"%PDF-1.7\n") && pdf.trim_ascii_end().ends_with(b"%%EOF"));
    assert_eq!(pdf, check_pdf(&page), "the same bytes each time");
    let pictures = 3 + 2 * made.pictures.panels.len();
    assert!(made.pictures.panels.len() > 1);
    assert_eq!(count(&pdf, "/Subtype/Image"), pictures);
    for size in ["/Width 1400/Height 640", "/Width 800/Height 600", "/Width 320/Height 240"] {
        assert!(count(&pdf, size) > 0, "{size}");
    }
    // Two fonts, each with the letters that stand behind its glyphs.
    assert_eq!((count(&pdf, "/FontFile2"), count(&pdf, "/ToUnicode")), (2, 2));
    assert_eq!(count(&pdf, "/S/H1"), 1);
    for role in ["/S/H2", "/S/P", "/S/Table", "/S/TR", "/S/TH", "/S/TD"] {
        assert!(count(&pdf, role) > 1, "{role}");
    }
    let charts = |section: &Section<'_>| {
        section.blocks.iter().filter(|block| matches!(block, Block::Chart(_))).count()
    };
    let charts: usize = content(&page).sections.iter().map(charts).sum();
    assert_eq!(count(&pdf, "/S/Figure"), pictures + charts);
}

#[test]
fn signs_without_a_glyph_are_named_at_the_end() {
    let made = NewElements::of(&bent());
    let strange = content(&made.page(ReportRows::Worst));
    let said = texts(&pages(&strange)).concat();
    assert!(said.contains("no glyph for it: U+65E5."), "{said}");
    let known = Content { title: "Zażółć Κουτί Коробка.obj", ..strange };
    assert!(!texts(&pages(&known)).concat().contains("no glyph"));
}

#[test]
fn everything_that_the_content_says_is_on_the_pages() {
    let made = NewElements::of(&bent());
    for rows in [ReportRows::Worst, ReportRows::All] {
        let page = made.page(rows);
        let content = content(&page);
        let shown = texts(&pages(&content));
        let all = shown.concat();
        let is_there = |text: &str| {
            // Lines end between words: spaces at their ends are not printed.
            let bare = |text: &str| text.replace(' ', "");
            assert!(bare(&all).contains(&bare(text)), "{text} is missing");
        };
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
    let page = made.page(ReportRows::All);
    let paper = pages(&content(&page));
    let heads = texts(&paper).iter().filter(|s| s.as_str() == "Conical residual, mm/mm").count();
    assert!(heads >= 3, "{heads} heads for {} nodes", mesh.vertex_count());
    for mark in &paper.marks {
        if let Shape::Text { at: [x, y], pen, text } = &mark.shape {
            let right = x + pen.font.width(text, pen.size);
            assert!((20.0..822.0).contains(y) && *x >= LEFT - 1e-6, "{text} at {x}, {y}");
            assert!(right <= LEFT + WIDTH + 1e-6, "{text} ends at {right}");
        }
    }
}
