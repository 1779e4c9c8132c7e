//! The sections of a report.

use std::collections::BTreeMap;

use super::super::text::shape_limits;
use super::words::{DEFINITIONS, count, figure, optional, text};
use super::{
    Bar, Block, Chart, Content, PanelCard, ReportPage, ReportRows, Section, Table, Word, Words,
};
use crate::check::{
    CheckFinding, EdgeDetail, FaceReport, Report, Unit, Verdict, VertexDetail, short,
};

/// Rows of each table when only the worst are listed.
const LISTED: usize = 24;
/// The same for the findings of one check, which are long.
const FINDINGS: usize = 12;
/// Deviations below this share of the model are the rounding of a computation.
const ROUNDING: f64 = 1e-9;

/// Everything that the report says.
pub(in crate::io) fn content<'a>(page: &ReportPage<'a>) -> Content<'a> {
    let parts = [limits, deviations, panels, findings, nodes, edges, faces, definitions];
    Content {
        title: page.title,
        verdict: (page.report.verdict() == Verdict::Pass, verdict_in_words(page.report)),
        facts: facts(page.report),
        views: &page.pictures.views,
        sections: parts.iter().filter_map(|part| part(page)).collect(),
        command: page.command,
    }
}

/// `Fail: 604 findings (planarity 305, valence 299)`.
fn verdict_in_words(r: &Report) -> String {
    if r.verdict() == Verdict::Pass {
        return "Pass: every limit and requirement is kept".to_owned();
    }
    let mut counts = BTreeMap::new();
    r.findings.iter().for_each(|f| *counts.entry(f.check).or_insert(0) += 1);
    let parts: Vec<String> = counts.iter().map(|(check, n)| format!("{check} {n}")).collect();
    format!("Fail: {} ({})", count(r.findings.len(), "finding", "findings"), parts.join(", "))
}

fn facts(r: &Report) -> Vec<(&'static str, Words)> {
    let m = &r.model;
    let [x, y, z] = m.size_mm.to_array().map(Word::Figure);
    let mut required = vec!["planar faces".to_owned()];
    required.extend(r.require.iter().map(ToString::to_string));
    let mut profile = text(format!("{}, at most ", r.profile));
    profile.extend(limits_in_words(r));
    vec![
        ("Panels (faces)", text(m.faces.to_string())),
        ("Nodes (vertices)", text(m.vertices.to_string())),
        ("Edges", text(m.edges.to_string())),
        ("Size", vec![x, " × ".into(), y, " × ".into(), z, " mm".into()]),
        ("Parts · handles · rims", text(format!("{} · {} · {}", m.components, m.genus, m.rims))),
        ("Convex", text(if r.is_convex() { "yes" } else { "no" })),
        ("Profile", profile),
        ("Required", text(required.join(", "))),
    ]
}

/// The limits as they are said: `1 mm and 2 ‰`.
fn limits_in_words(r: &Report) -> Words {
    let l = &r.limits;
    let limits = [(l.mm, " mm"), (l.permille, " ‰"), (l.degrees, "°")];
    let mut said = Words::new();
    for (limit, unit) in limits.into_iter().filter_map(|(x, unit)| Some((x?, unit))) {
        if !said.is_empty() {
            said.push(" and ".into());
        }
        said.extend([Word::Figure(limit), unit.into()]);
    }
    let shapes = shape_limits(l);
    if !shapes.is_empty() {
        said.push(shapes.as_str().into());
    }
    said
}

fn limits<'a>(page: &ReportPage<'a>) -> Option<Section<'a>> {
    let (r, worst) = (page.report, &page.report.worst);
    let measures = [
        ("Distance from the plane, mm", Some(worst.mm), r.limits.mm),
        ("The same over the panel's diameter, ‰", Some(worst.permille), r.limits.permille),
        ("Twist of a corner, °", Some(worst.degrees), r.limits.degrees),
        ("Gap of a quad's diagonals, %", worst.percent, None),
    ];
    let rows = measures.into_iter().map(|(name, largest, limit)| {
        let verdict = match (largest, limit) {
            (Some(largest), Some(limit)) => vec![Word::Verdict(largest <= limit)],
            _ => text("no limit"),
        };
        vec![text(name), optional(largest), optional(limit), verdict]
    });
    let kept: Vec<String> = r
        .profiles
        .iter()
        .map(|&(p, ok)| format!("{p}: {}", if ok { "kept" } else { "not kept" }))
        .collect();
    let broken = r.faces.iter().filter(|f| f.breach.is_some()).count();
    let all = count(r.faces.len(), "panel", "panels");
    Some(Section {
        title: format!("Verdict against the profile “{}”", r.profile),
        blocks: vec![
            Block::Text(text(format!("{broken} of {all} break a planarity limit."))),
            Block::Table(Table {
                class: "limits",
                head: &["Measure", "Largest", "Allowed", "Verdict"],
                rows: rows.collect(),
            }),
            Block::Note(text(format!(
                "All profiles, each with its own limits: {}. Limits are kerfold’s defaults or were \
                given for this check; they \
                 are not norms.",
                kept.join(" · ")
            ))),
        ],
    })
}

/// Two histograms: against the limit, and in mm.
fn deviations<'a>(page: &ReportPage<'a>) -> Option<Section<'a>> {
    /// Upper ends of the bins, in per cent of the limit; the last bin has none.
    const ENDS: [f64; 13] = [10., 20., 30., 40., 50., 60., 70., 80., 90., 100., 150., 200., 500.];
    /// The bin of 100 per cent.
    const LIMIT: usize = 10;
    let r = page.report;
    let mut counts = [0; ENDS.len() + 1];
    for f in &r.faces {
        counts[ENDS.partition_point(|&end| end < 100.0 * r.limits.share(&f.planarity))] += 1;
    }
    let label = |i: usize| ENDS.get(i).map_or("more".to_owned(), f64::to_string);
    let bar = |(i, &count): (usize, &usize)| Bar { label: label(i), count, is_kept: i < LIMIT };
    let mut blocks = vec![
        Block::Text(text(
            "Number of panels by how much of the tightest limit they use; beyond 100 % a limit is \
            broken.",
        )),
        Block::Chart(Chart {
            name: "Panels by share of the limit",
            axis: "up to, in per cent of the limit",
            bars: counts.iter().enumerate().map(bar).collect(),
            limit: Some((LIMIT as f64, "limit")),
        }),
    ];
    blocks.extend(distances(r));
    Some(Section { title: "How the panels spread".to_owned(), blocks })
}

/// The histogram in mm; a sentence where there is nothing but rounding to show.
fn distances<'a>(r: &Report) -> Vec<Block<'a>> {
    const BINS: usize = 20;
    if r.worst.mm <= ROUNDING * r.model.size_mm.max_element() {
        return vec![Block::Text(text(
            "No corner is off the plane of its panel by more than rounding.",
        ))];
    }
    let mut counts = [0; BINS];
    for f in &r.faces {
        counts[((f.planarity.mm / r.worst.mm * BINS as f64) as usize).min(BINS - 1)] += 1;
    }
    let width = r.worst.mm / BINS as f64;
    let bar = |(i, &count): (usize, &usize)| Bar {
        label: if i % 4 == 1 { short((i + 1) as f64 * width) } else { String::new() },
        count,
        is_kept: r.limits.mm.is_none_or(|limit| limit > i as f64 * width),
    };
    let limit =
        r.limits.mm.filter(|&limit| limit < r.worst.mm).map(|limit| (limit / width, "limit in mm"));
    vec![
        Block::Text(text("Number of panels by the largest distance of a corner from the plane.")),
        Block::Chart(Chart {
            name: "Panels by distance in mm",
            axis: "up to, in mm",
            bars: counts.iter().enumerate().map(bar).collect(),
            limit,
        }),
    ]
}

fn panels<'a>(page: &ReportPage<'a>) -> Option<Section<'a>> {
    let r = page.report;
    let cards = page.pictures.panels.iter().filter_map(|pictures| {
        let f = r.faces.iter().find(|f| f.face == pictures.face)?;
        let p = &f.planarity;
        Some(PanelCard {
            name: format!("Panel {}", f.face),
            is_kept: f.breach.is_none(),
            sides: count(f.sides, "side", "sides"),
            pictures,
            figures: vec![
                (figure(p.mm), "mm"),
                (figure(p.permille), "‰"),
                (figure(p.degrees), "°"),
                (optional(p.percent), "%"),
                (figure(100.0 * r.limits.share(p)), "% of limit"),
            ],
        })
    });
    let cards: Vec<PanelCard<'a>> = cards.collect();
    (!cards.is_empty()).then(|| Section {
        title: "The worst panels".to_owned(),
        blocks: vec![
            Block::Text(text(
                "Those that use most of their limits, worst first; seen along their normals, close \
                by and on the model.",
            )),
            Block::Panels(cards),
        ],
    })
}

fn findings<'a>(page: &ReportPage<'a>) -> Option<Section<'a>> {
    let all = &page.report.findings;
    let title = "Findings".to_owned();
    if all.is_empty() {
        return Some(Section { title, blocks: vec![Block::Text(text("None."))] });
    }
    let mut rows: Vec<&CheckFinding> = all.iter().collect();
    if page.rows == ReportRows::Worst {
        // The sort is stable: what breaks nothing by measure stays in order.
        let rank =
            |f: &CheckFinding| if f.limit > 0.0 { f.measured / f.limit } else { f64::INFINITY };
        rows.sort_by(|a, b| a.check.cmp(&b.check).then(rank(b).total_cmp(&rank(a))));
        // The worst of every check: a long list of one must not hide the others.
        let groups = rows.chunk_by(|a, b| a.check == b.check);
        rows = groups.flat_map(|group| group.iter().take(FINDINGS).copied()).collect();
    }
    let mut blocks =
        page.share_listed(rows.len(), all.len(), "by check, each with the worst first");
    let row = |f: &&CheckFinding| {
        let unit = format!(" {}", if f.unit == Unit::Permille { "‰" } else { f.unit.name() });
        let measure = |x: f64| vec![Word::Figure(x), Word::Text(unit.clone())];
        vec![
            text(f.check.to_string()),
            text(f.message.clone()),
            measure(f.measured),
            measure(f.limit),
        ]
    };
    blocks.push(Block::Table(Table {
        class: "findings",
        head: &["Check", "What", "Measured", "Allowed"],
        rows: rows.iter().map(row).collect(),
    }));
    Some(Section { title, blocks })
}

fn nodes<'a>(page: &ReportPage<'a>) -> Option<Section<'a>> {
    let (r, all) = (page.report, &page.details.vertices);
    let rows = nodes_to_list(all, page.rows);
    let bar = |(&valence, &count): (&usize, &usize)| Bar {
        label: valence.to_string(),
        count,
        is_kept: valence <= 3,
    };
    let mut blocks = vec![
        Block::Text(nodes_in_words(r.model.vertices, all)),
        Block::Chart(Chart {
            name: "Nodes by valence",
            axis: "valence: number of edges that meet",
            bars: r.valence.histogram.iter().map(bar).collect(),
            limit: None,
        }),
    ];
    blocks.extend(page.share_listed(
        rows.len(),
        all.len(),
        "largest conical residual first, then largest deficit",
    ));
    blocks.push(Block::Table(Table {
        class: "nodes",
        head: &["Node", "Valence", "Where", "Conical residual, mm/mm", "Angle deficit, °"],
        rows: rows.into_iter().map(node_row).collect(),
    }));
    Some(Section { title: "Nodes".to_owned(), blocks })
}

/// The nodes for the table: all of them, or the worst with the worst first.
fn nodes_to_list(all: &[VertexDetail], wanted: ReportRows) -> Vec<&VertexDetail> {
    let mut rows: Vec<&VertexDetail> = all.iter().collect();
    if wanted == ReportRows::Worst {
        let deficit = |v: &VertexDetail| v.deficit_degrees.map_or(0.0, f64::abs);
        // Residuals of three planes are rounding; they must not decide the order.
        let residual = |v: &VertexDetail| match v.valence {
            0..=3 => 0.0,
            _ => v.residual.unwrap_or(f64::INFINITY),
        };
        rows.sort_by(|a, b| {
            let by_residual = residual(b).total_cmp(&residual(a));
            by_residual.then(deficit(b).total_cmp(&deficit(a)))
        });
        rows.truncate(LISTED);
    }
    rows
}

fn node_row(v: &VertexDetail) -> Vec<Words> {
    vec![
        text(v.vertex.to_string()),
        text(v.valence.to_string()),
        text(if v.is_on_rim { "rim" } else { "inside" }),
        optional(v.residual),
        optional(v.deficit_degrees),
    ]
}

/// What is to be said of all nodes, above their chart.
fn nodes_in_words(count_of_nodes: usize, all: &[VertexDetail]) -> Words {
    let crowded = all.iter().filter(|v| v.valence > 3).count();
    let nodes = count(count_of_nodes, "node", "nodes");
    let worst = all.iter().filter_map(|v| v.residual).fold(0.0, f64::max);
    let deficits = || all.iter().filter_map(|v| v.deficit_degrees);
    let least = optional(deficits().reduce(f64::min));
    let most = optional(deficits().reduce(f64::max));
    let mut words = text(format!(
        "{crowded} of {nodes} have more than three edges. At a node with three edges, plates of \
        constant thickness meet exactly; at others they may miss each other: here by up to "
    ));
    words.push(Word::Figure(worst));
    words.push(" mm per mm of thickness. The angle deficits run from ".into());
    words.extend(least.into_iter().chain(text("° to ")).chain(most).chain(text("°.")));
    words
}

fn edges<'a>(page: &ReportPage<'a>) -> Option<Section<'a>> {
    let all = &page.details.edges;
    let mut rows: Vec<&EdgeDetail> = all.iter().collect();
    if page.rows == ReportRows::Worst {
        let rank = |e: &EdgeDetail| e.dihedral_degrees.map_or(-1.0, |d| (180.0 - d).abs());
        rows.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
        rows.truncate(LISTED);
    }
    let row = |e: &&EdgeDetail| {
        let [a, b] = e.ends;
        let fold = match e.dihedral_degrees {
            None => "rim",
            Some(d) if d < 180.0 => "convex",
            Some(d) if d > 180.0 => "concave",
            Some(_) => "flat",
        };
        let mitre = e.dihedral_degrees.map(|d| (180.0 - d) / 2.0);
        let ends = text(format!("{a}–{b}"));
        vec![ends, figure(e.length_mm), optional(e.dihedral_degrees), optional(mitre), text(fold)]
    };
    let rims = all.iter().filter(|e| e.dihedral_degrees.is_none()).count();
    let edges = count(all.len(), "edge", "edges");
    let mut blocks = vec![
        Block::Text(text(format!("{edges}, {rims} without an angle (rims)."))),
        Block::Chart(dihedrals(all)),
    ];
    blocks.extend(page.share_listed(rows.len(), all.len(), "those farthest from flat first"));
    blocks.push(Block::Table(Table {
        class: "edges",
        head: &["Edge (nodes)", "Length, mm", "Dihedral, °", "Mitre, °", "Kind"],
        rows: rows.iter().map(row).collect(),
    }));
    Some(Section { title: "Edges".to_owned(), blocks })
}

fn dihedrals(edges: &[EdgeDetail]) -> Chart {
    const BIN: f64 = 10.0;
    let mut counts = BTreeMap::new();
    for angle in edges.iter().filter_map(|e| e.dihedral_degrees) {
        *counts.entry((angle / BIN) as usize).or_insert(0) += 1;
    }
    let range =
        counts.keys().next().copied().unwrap_or(0)..=counts.keys().last().copied().unwrap_or(0);
    let count_of = |bin: &usize| counts.get(bin).copied().unwrap_or(0);
    let bar = |bin: usize| Bar {
        label: format!("{}", bin as f64 * BIN),
        count: count_of(&bin),
        is_kept: true,
    };
    Chart {
        name: "Edges by dihedral angle",
        axis: "dihedral angle, in degrees, from the number shown to 10 more",
        bars: range.map(bar).collect(),
        limit: None,
    }
}

fn faces<'a>(page: &ReportPage<'a>) -> Option<Section<'a>> {
    let r = page.report;
    let rows: Vec<&FaceReport> = match page.rows {
        ReportRows::Worst => r.worst_faces(LISTED),
        ReportRows::All => r.faces.iter().collect(),
    };
    let row = |f: &&FaceReport| {
        let p = &f.planarity;
        let share = figure(100.0 * r.limits.share(p));
        let mut cells = vec![text(f.face.to_string()), text(f.sides.to_string())];
        cells.extend([p.mm, p.permille, p.degrees].map(figure));
        cells.extend([optional(p.percent), share, vec![Word::Verdict(f.breach.is_none())]]);
        cells
    };
    let mut blocks =
        page.share_listed(rows.len(), r.faces.len(), "those that use most of their limits first");
    blocks.push(Block::Table(Table {
        class: "faces",
        head: &["Panel", "Sides", "mm", "‰", "°", "%", "% of the limit", "Planarity"],
        rows: rows.iter().map(row).collect(),
    }));
    Some(Section { title: "Panels".to_owned(), blocks })
}

fn definitions<'a>(_: &ReportPage<'a>) -> Option<Section<'a>> {
    Some(Section {
        title: "What the figures mean".to_owned(),
        blocks: vec![Block::Terms(&DEFINITIONS)],
    })
}

impl ReportPage<'_> {
    /// The line above a list that says what is left out.
    fn share_listed<'a>(&self, shown: usize, all: usize, order: &str) -> Vec<Block<'a>> {
        if shown == all && self.rows == ReportRows::All {
            return Vec::new();
        }
        let mut words = text(format!("Listed: {order}."));
        if shown < all {
            let rest = format!(" {shown} of {all}; all with ");
            words.extend([Word::Text(rest), Word::Code("--rows all"), ", and in JSON.".into()]);
        }
        vec![Block::Note(words)]
    }
}
