//! The report of `check` as a PDF of A4 pages: the same content as the HTML page, with pictures
//! inside and charts as lines.
//!
//! The pages are laid out here and written by krilla: tagged, so that programs read headings,
//! tables and pictures as such, and with the font in the file, so that Greek, Cyrillic and Polish
//! names are shown as they are. A sign that the font lacks is an empty box, and the end of the
//! report names it.

mod blocks;
mod file;
mod font;
mod paper;

#[cfg(test)]
mod tests;

use krilla::image::Image;

use font::Font;
use paper::{
    Anchor, BAD, GOOD, INK, LEFT, LINE, Paper, Pen, Rgb, Role, SOFT, WHITE, WIDTH, aspect,
};

use super::page::words::{shown, verdict};
use super::page::{Block, Content, KIND, ReportPage, ReportPicture, Section, Word, content};

const BODY: Pen = Pen::new(Font::Regular, 9.5, INK);
const BOLD: Pen = Pen::new(Font::Bold, 9.5, INK);
const SMALL: Pen = Pen::new(Font::Regular, 8.0, SOFT);
const TITLE: Pen = Pen::new(Font::Bold, 20.0, INK);
const HEADING: Pen = Pen::new(Font::Bold, 12.5, INK);
/// Between blocks.
const GAP: f64 = 6.0;
/// Between pictures or cards side by side.
const GUTTER: f64 = 12.0;

/// The bytes of the PDF.
///
/// # Example
/// ```
/// use kerfold::check::details;
/// use kerfold::io::report::page::{ReportPage, ReportPictures, ReportRows};
/// use kerfold::io::report::pdf::check_pdf;
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(40.0);
/// let page = ReportPage {
///     title: "cube",
///     report: &check(&cube, &CheckParams::default())?,
///     details: &details(&cube),
///     pictures: &ReportPictures::default(),
///     rows: ReportRows::default(),
///     command: "my program",
/// };
/// assert!(check_pdf(&page).starts_with(b"%PDF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_pdf(page: &ReportPage<'_>) -> Vec<u8> {
    let content = content(page);
    file::bytes(&pages(&content), &heading(&content), content.command)
}

/// The title of the document, at the foot of every page.
fn heading(content: &Content<'_>) -> String {
    format!("{}: planarity and valence", content.title)
}

/// Everything on its pages.
fn pages(content: &Content<'_>) -> Paper {
    let mut paper = Paper::new();
    head(&mut paper, content);
    views(&mut paper, content.views);
    content.sections.iter().for_each(|part| section(&mut paper, part));
    paper.y += 2.0 * GAP;
    paper.need(3.0 * SMALL.leading());
    paper.line([LEFT, paper.y], [LEFT + WIDTH, paper.y], LINE, 0.6);
    paper.colophon(SMALL, content.command);
    paper.number(&heading(content));
    paper
}

/// A picture of ours; `None` for bytes that are none.
fn picture(png: &[u8]) -> Option<Image> {
    Image::from_png(png.to_vec().into(), false).ok()
}

fn head(paper: &mut Paper, content: &Content<'_>) {
    paper.paragraph(Role::Paragraph, SMALL, &KIND.to_uppercase());
    paper.paragraph(Role::Title, TITLE, content.title);
    paper.y += GAP;
    let (is_kept, said) = &content.verdict;
    let pen = Pen::new(Font::Bold, 11.0, WHITE);
    let lines = pen.font.wrap(said, pen.size, WIDTH - 20.0);
    let height = lines.len() as f64 * pen.leading() + 12.0;
    paper.fill([LEFT, paper.y], [WIDTH, height], verdict_colour(*is_kept));
    paper.part(Role::Paragraph, |paper| {
        for (i, line) in lines.iter().enumerate() {
            let base = paper.y + 6.0 + (i as f64 + 0.78) * pen.leading();
            paper.text([LEFT + 10.0, base], Anchor::Start, pen, line);
        }
    });
    paper.y += height + 2.0 * GAP;
    facts(paper, content);
}

/// What the model is, in four columns.
fn facts(paper: &mut Paper, content: &Content<'_>) {
    const COLUMNS: usize = 4;
    let width = (WIDTH - (COLUMNS - 1) as f64 * GUTTER) / COLUMNS as f64;
    for row in content.facts.chunks(COLUMNS) {
        let values: Vec<Vec<String>> =
            row.iter().map(|(_, value)| BOLD.font.wrap(&plain(value), BOLD.size, width)).collect();
        let tallest = values.iter().map(Vec::len).max().unwrap_or(1);
        for (i, ((name, _), lines)) in row.iter().zip(&values).enumerate() {
            let x = LEFT + i as f64 * (width + GUTTER);
            paper.line([x, paper.y], [x + width, paper.y], LINE, 0.6);
            paper.part(Role::Paragraph, |paper| {
                paper.text([x, paper.y + 11.0], Anchor::Start, SMALL, name);
                for (k, line) in lines.iter().enumerate() {
                    let base = paper.y + 24.0 + k as f64 * BOLD.leading();
                    paper.text([x, base], Anchor::Start, BOLD, line);
                }
            });
        }
        paper.y += 20.0 + tallest as f64 * BOLD.leading();
    }
}

/// The first as wide as the page, the others in pairs.
fn views(paper: &mut Paper, views: &[ReportPicture]) {
    let Some((first, others)) = views.split_first() else { return };
    paper.y += GAP;
    row_of_views(paper, std::slice::from_ref(first), WIDTH);
    others.chunks(2).for_each(|pair| row_of_views(paper, pair, (WIDTH - GUTTER) / 2.0));
}

fn row_of_views(paper: &mut Paper, views: &[ReportPicture], width: f64) {
    let shown: Vec<(Image, &str)> =
        views.iter().filter_map(|v| Some((picture(&v.png)?, v.caption.as_str()))).collect();
    let lines = |caption: &str| SMALL.font.wrap(caption, SMALL.size, width);
    let heights = shown.iter().map(|(image, caption)| {
        width * aspect(image) + lines(caption).len() as f64 * SMALL.leading()
    });
    let tallest = heights.fold(0.0, f64::max);
    paper.need(tallest + GAP);
    let top = paper.y;
    for (i, (image, caption)) in shown.iter().enumerate() {
        let x = LEFT + i as f64 * (width + GUTTER);
        let below = top + paper.image([x, top], width, image, caption);
        paper.part(Role::Paragraph, |paper| {
            for (k, line) in lines(caption).iter().enumerate() {
                let base = below + 3.0 + (k as f64 + 0.8) * SMALL.leading();
                paper.text([x, base], Anchor::Start, SMALL, line);
            }
        });
    }
    paper.y = top + tallest + 2.0 * GAP;
}

fn section(paper: &mut Paper, section: &Section<'_>) {
    paper.y += 2.0 * GAP;
    let first = section.blocks.iter().take(2).map(blocks::least_room).sum::<f64>();
    paper.need(30.0 + first);
    paper.line([LEFT, paper.y], [LEFT + WIDTH, paper.y], INK, 1.2);
    paper.y += 5.0;
    paper.paragraph(Role::Heading, HEADING, &section.title);
    for block in &section.blocks {
        paper.y += GAP / 2.0;
        match block {
            Block::Text(words) => paper.paragraph(Role::Paragraph, BODY, &plain(words)),
            Block::Note(words) => paper.paragraph(Role::Paragraph, SMALL, &plain(words)),
            Block::Table(rows) => blocks::table(paper, rows),
            Block::Chart(bars) => blocks::chart(paper, bars),
            Block::Panels(cards) => blocks::panels(paper, cards),
            Block::Terms(list) => blocks::terms(paper, list),
        }
        paper.y += GAP / 2.0;
    }
}

const fn verdict_colour(is_kept: bool) -> Rgb {
    if is_kept { GOOD } else { BAD }
}

/// Words as they are read.
fn plain(words: &[Word]) -> String {
    let word = |word: &Word| match word {
        Word::Text(text) => text.clone(),
        Word::Code(text) => (*text).to_owned(),
        Word::Figure(x) => shown(*x),
        Word::Verdict(is_kept) => verdict(*is_kept).to_owned(),
    };
    words.iter().map(word).collect()
}
