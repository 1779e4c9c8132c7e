//! The report of `check` as one page for people who were not there: HTML that loads nothing, its pictures inside.
//!
//! The page is XHTML-clean, so that any XML parser reads it. Every figure stands in a `<data>` element whose `value` reads
//! back to the same bits; what is shown has four digits. Pictures come as bytes, since drawing is not this room's work.

mod chart;
mod style;
mod words;

use std::collections::BTreeMap;
use std::fmt::Write as _;

use chart::Bar;
use clap::ValueEnum;
pub(crate) use words::escaped;
use words::{DEFINITIONS, count, figure, optional};

use super::base64::base64;
use crate::check::{Details, EdgeDetail, FaceReport, Finding, Report, Unit, Verdict, VertexDetail, short};
use crate::mesh::FaceId;

/// Rows of each table when only the worst are listed.
const LISTED: usize = 24;
/// The same for findings, which are long.
const FINDINGS: usize = 12;
/// Deviations below this share of the model are the rounding of a computation.
const ROUNDING: f64 = 1e-9;
/// Colours of bars that keep the limit, and that do not.
const KEPT: [u8; 3] = [96, 140, 190];
const BROKEN: [u8; 3] = [190, 60, 48];

/// Which rows the lists of a report have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum ReportRows {
    /// The worst 24 of each list.
    #[default]
    Worst,
    /// All, ascending.
    All,
}

/// Pictures for a page, as PNG files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReportPictures {
    /// The whole model.
    pub views: Vec<ReportPicture>,
    /// The worst panels, worst first.
    pub panels: Vec<PanelPictures>,
}

/// A picture with what it shows.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportPicture {
    /// What it shows and what its colours mean, in a sentence or two.
    pub caption: String,
    /// The PNG file.
    pub png: Vec<u8>,
}

/// Pictures of one panel.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelPictures {
    /// The face.
    pub face: FaceId,
    /// Where it is on the model; a PNG file.
    pub place: Vec<u8>,
    /// The panel with its neighbours; a PNG file.
    pub close: Vec<u8>,
}

/// What a page is made from.
#[derive(Debug, Clone, Copy)]
pub struct ReportPage<'a> {
    /// The name of the model, such as its file's.
    pub title: &'a str,
    /// What was measured and found.
    pub report: &'a Report,
    /// Vertices and edges.
    pub details: &'a Details,
    /// Pictures.
    pub pictures: &'a ReportPictures,
    /// Which rows the lists have.
    pub rows: ReportRows,
    /// The command line that made it.
    pub command: &'a str,
}

/// The page.
pub fn check_html(page: &ReportPage<'_>) -> String {
    let title = escaped(page.title);
    let mut html = format!(
        "<!DOCTYPE html>\n<html xmlns=\"http://www.w3.org/1999/xhtml\" lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n\
         <meta name=\"generator\" content=\"kerfold\"/>\n<title>{title}: planarity and valence</title>\n\
         <style>{}</style>\n</head>\n<body>\n",
        style::SHEET
    );
    for part in [head, views, limits, deviations, panels, findings, nodes, edges, faces, definitions] {
        html += &part(page);
    }
    let _ = write!(html, "<footer>Made by <code>{}</code></footer>\n</body>\n</html>\n", escaped(page.command));
    html
}

fn head(page: &ReportPage<'_>) -> String {
    let (r, m) = (page.report, &page.report.model);
    let (class, words) = match r.verdict() {
        Verdict::Pass => ("pass", "Pass: every limit and requirement is kept".to_owned()),
        Verdict::Fail => ("fail", format!("Fail: {}", count(r.findings.len(), "finding", "findings"))),
    };
    let size = m.size_mm.to_array().map(figure).join(" × ");
    let require: Vec<String> = r.require.iter().map(ToString::to_string).collect();
    let required =
        if require.is_empty() { "planar faces".to_owned() } else { format!("planar faces, {}", require.join(", ")) };
    let convex = if r.is_convex() { "yes" } else { "no" };
    let facts = [
        ("Panels (faces)", m.faces.to_string()),
        ("Nodes (vertices)", m.vertices.to_string()),
        ("Edges", m.edges.to_string()),
        ("Size", format!("{size} mm")),
        ("Parts · handles · rims", format!("{} · {} · {}", m.components, m.genus, m.rims)),
        ("Convex", convex.to_owned()),
        ("Profile", format!("{}, {}", r.profile, limits_in_words(r))),
        ("Required", required),
    ];
    let facts: String =
        facts.iter().map(|(name, value)| format!("<div><dt>{name}</dt><dd>{value}</dd></div>\n")).collect();
    format!(
        "<header><p class=\"kind\">Planarity and valence report</p>\n<h1>{}</h1>\n<p class=\"verdict {class}\">{words}</p>\n\
         <dl class=\"facts\">\n{facts}</dl></header>\n",
        escaped(page.title)
    )
}

/// The limits as they are said: `at most 1 mm and 2 ‰`.
fn limits_in_words(report: &Report) -> String {
    let l = &report.limits;
    let limits = [(l.mm, " mm"), (l.permille, " ‰"), (l.degrees, "°")];
    let said: Vec<String> = limits.iter().filter_map(|&(x, unit)| Some(figure(x?) + unit)).collect();
    format!("at most {}", said.join(" and "))
}

fn views(page: &ReportPage<'_>) -> String {
    let shown = page.pictures.views.iter().map(|view| {
        let caption = escaped(&view.caption);
        format!("<figure>{}<figcaption>{caption}</figcaption></figure>\n", image(&view.png, &caption))
    });
    format!("<section class=\"views\">\n{}</section>\n", shown.collect::<String>())
}

fn image(png: &[u8], words: &str) -> String {
    format!("<img alt=\"{words}\" src=\"data:image/png;base64,{}\"/>", base64(png))
}

fn limits(page: &ReportPage<'_>) -> String {
    let (r, worst) = (page.report, &page.report.worst);
    let measures = [
        ("Distance from the plane, mm", Some(worst.mm), r.limits.mm),
        ("The same over the panel's diameter, ‰", Some(worst.permille), r.limits.permille),
        ("Twist of a corner, °", Some(worst.degrees), r.limits.degrees),
        ("Gap of a quad's diagonals, %", worst.percent, None),
    ];
    let rows = measures.into_iter().map(|(name, largest, limit)| {
        let verdict = match (largest, limit) {
            (Some(largest), Some(limit)) => verdict(largest <= limit),
            _ => "no limit".to_owned(),
        };
        vec![name.to_owned(), optional(largest), optional(limit), verdict]
    });
    let table = table("limits", &["Measure", "Largest", "Allowed", "Verdict"], rows);
    let kept: Vec<String> =
        r.profiles.iter().map(|&(p, ok)| format!("{p}: {}", if ok { "kept" } else { "not kept" })).collect();
    let broken = r.faces.iter().filter(|f| f.breach.is_some()).count();
    format!(
        "<section><h2>Verdict against the profile “{}”</h2>\n<p>{} of {} break a planarity limit.</p>\n{table}\
         <p class=\"note\">All profiles, each with its own limits: {}. Limits are kerfold’s defaults or were given for this \
         check; they are not norms.</p></section>\n",
        r.profile,
        broken,
        count(r.faces.len(), "panel", "panels"),
        kept.join(" · ")
    )
}

fn verdict(is_kept: bool) -> String {
    let word = if is_kept { "pass" } else { "fail" };
    format!("<span class=\"{word}\">{word}</span>")
}

/// Two histograms: against the limit, and in mm.
fn deviations(page: &ReportPage<'_>) -> String {
    /// Upper ends of the bins, in per cent of the limit; the last bin has none.
    const ENDS: [f64; 13] = [10., 20., 30., 40., 50., 60., 70., 80., 90., 100., 150., 200., 500.];
    let r = page.report;
    let mut counts = [0; ENDS.len() + 1];
    for f in &r.faces {
        counts[ENDS.partition_point(|&end| end < 100.0 * r.limits.share(&f.planarity))] += 1;
    }
    let label = |i: usize| ENDS.get(i).map_or("more".to_owned(), |end| format!("≤ {end}"));
    let colour = |i: usize| if i < 10 { KEPT } else { BROKEN };
    let shares: Vec<Bar> =
        counts.iter().enumerate().map(|(i, &count)| Bar { label: label(i), count, colour: colour(i) }).collect();
    format!(
        "<section><h2>How the panels spread</h2>\n<p>Number of panels by how much of the tightest limit they use; beyond 100 % \
         a limit is broken.</p>\n{}{}</section>\n",
        chart::bars("Panels by share of the limit", "per cent of the limit used", &shares, Some((10.0, "limit"))),
        distances(r)
    )
}

/// The histogram in mm; a sentence where there is nothing but rounding to show.
fn distances(r: &Report) -> String {
    const BINS: usize = 20;
    if r.worst.mm <= ROUNDING * r.model.size_mm.max_element() {
        return "<p>No corner is off the plane of its panel by more than rounding.</p>\n".to_owned();
    }
    let mut counts = [0; BINS];
    for f in &r.faces {
        counts[((f.planarity.mm / r.worst.mm * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let width = r.worst.mm / BINS as f64;
    let bar = |(i, &count): (usize, &usize)| {
        let label = if i % 4 == 1 { short((i + 1) as f64 * width) } else { String::new() };
        let is_over = r.limits.mm.is_some_and(|limit| i as f64 * width >= limit);
        Bar { label, count, colour: if is_over { BROKEN } else { KEPT } }
    };
    let bars: Vec<Bar> = counts.iter().enumerate().map(bar).collect();
    let limit = r.limits.mm.filter(|&limit| limit < r.worst.mm).map(|limit| (limit / width, "limit in mm"));
    format!(
        "<p>Number of panels by the largest distance of a corner from the plane.</p>\n{}",
        chart::bars("Panels by distance in mm", "up to, in mm", &bars, limit)
    )
}

fn panels(page: &ReportPage<'_>) -> String {
    let r = page.report;
    let cards = page.pictures.panels.iter().filter_map(|panel| {
        let f = r.faces.iter().find(|f| f.face == panel.face)?;
        let p = &f.planarity;
        let name = format!("Panel {}", f.face);
        let rows = [
            ("mm", figure(p.mm)),
            ("‰", figure(p.permille)),
            ("°", figure(p.degrees)),
            ("%", optional(p.percent)),
            ("% of limit", figure(100.0 * r.limits.share(p))),
        ];
        let rows: String = rows.iter().map(|(unit, x)| format!("<tr><td>{x}</td><th>{unit}</th></tr>")).collect();
        Some(format!(
            "<article class=\"panel\"><h3>{name} {}</h3>{}{}\n<p>{}</p><table>{rows}</table></article>\n",
            verdict(f.breach.is_none()),
            image(&panel.close, &format!("{name} with its neighbours")),
            image(&panel.place, &format!("{name} on the model")),
            count(f.sides, "side", "sides"),
        ))
    });
    let cards: String = cards.collect();
    if cards.is_empty() {
        return String::new();
    }
    format!(
        "<section><h2>The worst panels</h2>\n<p>Those that use most of their limits, worst first; seen along their normals, \
         close by and on the model.</p>\n<div class=\"panels\">\n{cards}</div></section>\n"
    )
}

fn findings(page: &ReportPage<'_>) -> String {
    let all = &page.report.findings;
    if all.is_empty() {
        return "<section><h2>Findings</h2>\n<p>None.</p></section>\n".to_owned();
    }
    let mut rows: Vec<&Finding> = all.iter().collect();
    if page.rows == ReportRows::Worst {
        // The sort is stable: what breaks nothing by measure stays in order.
        let rank = |f: &Finding| if f.limit > 0.0 { f.measured / f.limit } else { f64::INFINITY };
        rows.sort_by(|a, b| a.check.cmp(&b.check).then(rank(b).total_cmp(&rank(a))));
        rows.truncate(FINDINGS);
    }
    let shown = page.share_listed(rows.len(), all.len(), "by check, each with the worst first");
    let row = |f: &&Finding| {
        let unit = if f.unit == Unit::Permille { "‰" } else { f.unit.name() };
        let (measured, limit) = (figure(f.measured), figure(f.limit));
        vec![f.check.to_string(), escaped(&f.message), format!("{measured} {unit}"), format!("{limit} {unit}")]
    };
    let table = table("findings", &["Check", "What", "Measured", "Allowed"], rows.iter().map(row));
    format!("<section><h2>Findings</h2>\n{shown}{table}</section>\n")
}

fn nodes(page: &ReportPage<'_>) -> String {
    let (r, all) = (page.report, &page.details.vertices);
    let bar = |(valence, &count): (&usize, &usize)| Bar {
        label: valence.to_string(),
        count,
        colour: if *valence > 3 { BROKEN } else { KEPT },
    };
    let chart = chart::bars(
        "Nodes by valence",
        "valence: number of edges that meet",
        &r.valence.histogram.iter().map(bar).collect::<Vec<_>>(),
        None,
    );
    let worst = all.iter().filter_map(|v| v.residual).fold(0.0, f64::max);
    let deficits = || all.iter().filter_map(|v| v.deficit_degrees);
    let [least, most] = [deficits().reduce(f64::min), deficits().reduce(f64::max)].map(optional);
    let mut rows: Vec<&VertexDetail> = all.iter().collect();
    if page.rows == ReportRows::Worst {
        let key = |v: &VertexDetail| (v.residual.unwrap_or(f64::INFINITY), v.deficit_degrees.map_or(0.0, f64::abs));
        // Residuals of three planes are rounding; they must not decide the order.
        let rank = |v: &VertexDetail| if v.valence > 3 { key(v) } else { (0.0, key(v).1) };
        rows.sort_by(|a, b| rank(b).0.total_cmp(&rank(a).0).then(rank(b).1.total_cmp(&rank(a).1)));
        rows.truncate(LISTED);
    }
    let shown = page.share_listed(rows.len(), all.len(), "largest conical residual first, then largest deficit");
    let row = |v: &&VertexDetail| {
        let place = if v.is_on_rim { "rim" } else { "inside" };
        let (residual, deficit) = (optional(v.residual), optional(v.deficit_degrees));
        vec![v.vertex.to_string(), v.valence.to_string(), place.to_owned(), residual, deficit]
    };
    let head = ["Node", "Valence", "Where", "Conical residual, mm/mm", "Angle deficit, °"];
    format!(
        "<section><h2>Nodes</h2>\n<p>{} of {} have a valence other than 3. At a node with three edges, plates of constant \
         thickness meet exactly; at others they may miss each other: here by up to {} mm per mm of thickness. The angle \
         deficits run from {least}° to {most}°.</p>\n{chart}{shown}{}</section>\n",
        r.valence.other.len(),
        count(r.model.vertices, "node", "nodes"),
        figure(worst),
        table("nodes", &head, rows.iter().map(row))
    )
}

fn edges(page: &ReportPage<'_>) -> String {
    const BIN: f64 = 10.0;
    let all = &page.details.edges;
    let mut counts = BTreeMap::new();
    for angle in all.iter().filter_map(|e| e.dihedral_degrees) {
        *counts.entry((angle / BIN) as usize).or_insert(0) += 1;
    }
    let range = counts.keys().next().copied().unwrap_or(0)..=counts.keys().last().copied().unwrap_or(0);
    let label = |bin: usize| format!("{}", bin as f64 * BIN);
    let count_of = |bin: &usize| counts.get(bin).copied().unwrap_or(0);
    let bars: Vec<Bar> = range.map(|bin| Bar { label: label(bin), count: count_of(&bin), colour: KEPT }).collect();
    let chart = chart::bars(
        "Edges by dihedral angle",
        "dihedral angle, in degrees, from the number shown to 10 more",
        &bars,
        None,
    );
    let mut rows: Vec<&EdgeDetail> = all.iter().collect();
    if page.rows == ReportRows::Worst {
        let rank = |e: &EdgeDetail| e.dihedral_degrees.map_or(-1.0, |d| (180.0 - d).abs());
        rows.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
        rows.truncate(LISTED);
    }
    let shown = page.share_listed(rows.len(), all.len(), "those farthest from flat first");
    let row = |e: &&EdgeDetail| {
        let [a, b] = e.ends;
        let fold = match e.dihedral_degrees {
            None => "rim",
            Some(d) if d < 180.0 => "convex",
            Some(d) if d > 180.0 => "concave",
            Some(_) => "flat",
        };
        let mitre = e.dihedral_degrees.map(|d| (180.0 - d) / 2.0);
        let ends = format!("{a}–{b}");
        vec![ends, figure(e.length_mm), optional(e.dihedral_degrees), optional(mitre), fold.to_owned()]
    };
    let head = ["Edge (nodes)", "Length, mm", "Dihedral, °", "Mitre, °", "Kind"];
    let rims = all.iter().filter(|e| e.dihedral_degrees.is_none()).count();
    let (edges, table) = (count(all.len(), "edge", "edges"), table("edges", &head, rows.iter().map(row)));
    format!(
        "<section><h2>Edges</h2>\n<p>{edges}, {rims} without an angle (rims).</p>\n{chart}{shown}{table}</section>\n"
    )
}

fn faces(page: &ReportPage<'_>) -> String {
    let r = page.report;
    let rows: Vec<&FaceReport> = match page.rows {
        ReportRows::Worst => r.worst_faces(LISTED),
        ReportRows::All => r.faces.iter().collect(),
    };
    let row = |f: &&FaceReport| {
        let p = &f.planarity;
        let [mm, permille, degrees] = [p.mm, p.permille, p.degrees].map(figure);
        let share = figure(100.0 * r.limits.share(p));
        let verdict = verdict(f.breach.is_none());
        vec![f.face.to_string(), f.sides.to_string(), mm, permille, degrees, optional(p.percent), share, verdict]
    };
    let head = ["Panel", "Sides", "mm", "‰", "°", "%", "% of the limit", "Planarity"];
    format!(
        "<section><h2>Panels</h2>\n{}{}</section>\n",
        page.share_listed(rows.len(), r.faces.len(), "those that use most of their limits first"),
        table("faces", &head, rows.iter().map(row))
    )
}

fn definitions(_: &ReportPage<'_>) -> String {
    let list: String = DEFINITIONS.iter().map(|(name, words)| format!("<dt>{name}</dt><dd>{words}</dd>\n")).collect();
    format!("<section class=\"definitions\"><h2>What the figures mean</h2>\n<dl>\n{list}</dl></section>\n")
}

impl ReportPage<'_> {
    /// The line above a list that says what is left out.
    fn share_listed(&self, shown: usize, all: usize, order: &str) -> String {
        if shown == all && self.rows == ReportRows::All {
            return String::new();
        }
        let rest = if shown < all {
            format!(" {shown} of {all}; all with <code>--rows all</code>, and in JSON.")
        } else {
            String::new()
        };
        format!("<p class=\"note\">Listed: {order}.{rest}</p>\n")
    }
}

/// A table; cells are HTML already.
fn table(class: &str, head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let head: String = head.iter().map(|name| format!("<th scope=\"col\">{name}</th>")).collect();
    let mut html = format!("<table class=\"{class}\"><thead><tr>{head}</tr></thead>\n<tbody>\n");
    for row in rows {
        html += "<tr>";
        row.iter().for_each(|cell| html.extend(["<td>", cell, "</td>"]));
        html += "</tr>\n";
    }
    html + "</tbody></table>\n"
}

#[cfg(test)]
mod tests;
