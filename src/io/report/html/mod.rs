//! The report of `check` as one page: HTML that loads nothing, its pictures inside.
//!
//! The page is XHTML-clean, so that any XML parser reads it. Every figure stands in a `<data>`
//! element whose `value` reads back to the same bits; what is shown has four digits.

mod chart;
mod style;

use std::fmt::Write as _;

use super::page::words::{shown, verdict};
use super::page::{Block, Content, KIND, PanelCard, ReportPage, Section, Table, Word, content};
use crate::io::base64::base64;
use crate::io::number::xml;

/// The page.
///
/// # Example
/// ```
/// use kerfold::check::details;
/// use kerfold::io::report::page::{ReportPage, ReportPictures, ReportRows};
/// use kerfold::io::report::html::check_html;
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
/// assert!(check_html(&page).starts_with("<!DOCTYPE html>"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_html(page: &ReportPage<'_>) -> String {
    let content = content(page);
    let title = xml(content.title);
    let mut html = format!(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta \
        charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"generator\" content=\"kerfold\"/>\n<title>{title}: planarity and \
         valence</title>\n\
         <style>{}</style>\n</head>\n<body>\n",
        style::SHEET
    );
    html += &head(&content);
    html += &views(&content);
    content.sections.iter().for_each(|part| html += &section(part));
    let _ = write!(
        html,
        "<footer>Made by <code>{}</code></footer>\n</body>\n</html>\n",
        xml(content.command)
    );
    html
}

fn head(content: &Content<'_>) -> String {
    let (is_kept, said) = &content.verdict;
    let facts = content.facts.iter();
    let facts: String = facts
        .map(|(name, value)| format!("<div><dt>{name}</dt><dd>{}</dd></div>\n", words(value)))
        .collect();
    format!(
        "<header><p class=\"kind\">{KIND}</p>\n<h1>{}</h1>\n<p class=\"verdict {}\">{said}</p>\n\
         <dl class=\"facts\">\n{facts}</dl></header>\n",
        xml(content.title),
        verdict(*is_kept)
    )
}

fn views(content: &Content<'_>) -> String {
    let figures = content.views.iter().map(|view| {
        let caption = xml(&view.caption);
        format!(
            "<figure>{}<figcaption>{caption}</figcaption></figure>\n",
            image(&view.png, &caption)
        )
    });
    format!("<section class=\"views\">\n{}</section>\n", figures.collect::<String>())
}

fn image(png: &[u8], words: &str) -> String {
    format!("<img alt=\"{words}\" src=\"data:image/png;base64,{}\"/>", base64(png))
}

fn section(section: &Section<'_>) -> String {
    let is_terms = section.blocks.iter().any(|block| matches!(block, Block::Terms(_)));
    let class = if is_terms { " class=\"definitions\"" } else { "" };
    let mut html = format!("<section{class}><h2>{}</h2>\n", xml(&section.title));
    for block in &section.blocks {
        html += &match block {
            Block::Text(text) => format!("<p>{}</p>\n", words(text)),
            Block::Note(text) => format!("<p class=\"note\">{}</p>\n", words(text)),
            Block::Table(rows) => table(rows),
            Block::Chart(chart) => chart::bars(chart),
            Block::Panels(cards) => {
                format!(
                    "<div class=\"panels\">\n{}</div>\n",
                    cards.iter().map(panel).collect::<String>()
                )
            }
            Block::Terms(terms) => {
                let list =
                    terms.iter().map(|(name, words)| format!("<dt>{name}</dt><dd>{words}</dd>\n"));
                format!("<dl>\n{}</dl>\n", list.collect::<String>())
            }
        };
    }
    html + "</section>\n"
}

fn panel(card: &PanelCard<'_>) -> String {
    let figures = card.figures.iter();
    let rows: String = figures
        .map(|(figure, unit)| format!("<tr><td>{}</td><th>{unit}</th></tr>", words(figure)))
        .collect();
    let name = &card.name;
    format!(
        "<article class=\"panel\"><h3>{name} \
        {}</h3>{}{}\n<p>{}</p><table>{rows}</table></article>\n",
        word(&Word::Verdict(card.is_kept)),
        image(&card.pictures.close, &format!("{name} with its neighbours")),
        image(&card.pictures.place, &format!("{name} on the model")),
        card.sides,
    )
}

fn table(table: &Table) -> String {
    let head: String =
        table.head.iter().map(|name| format!("<th scope=\"col\">{name}</th>")).collect();
    let mut html =
        format!("<table class=\"{}\"><thead><tr>{head}</tr></thead>\n<tbody>\n", table.class);
    for row in &table.rows {
        html += "<tr>";
        row.iter().for_each(|cell| html.extend(["<td>", &words(cell), "</td>"]));
        html += "</tr>\n";
    }
    html + "</tbody></table>\n"
}

fn words(words: &[Word]) -> String {
    words.iter().map(word).collect()
}

/// A word; a figure for programs has all its digits.
fn word(word: &Word) -> String {
    match word {
        Word::Text(text) => xml(text),
        Word::Code(text) => format!("<code>{}</code>", xml(text)),
        Word::Figure(x) => format!("<data value=\"{x:?}\">{}</data>", xml(&shown(*x))),
        Word::Verdict(is_kept) => format!("<span class=\"{0}\">{0}</span>", verdict(*is_kept)),
    }
}

#[cfg(test)]
mod tests;
