//! The page of a gallery, as HTML beside the folders of its recipes, and as Markdown for
//! documentation.

use std::fmt::Write as _;

use super::{Exhibit, ModelFacts};
use crate::io::escaped;
use crate::units::counted;

const STYLE: &str = "\
body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:1400px;padding:0 1rem;color:#222;background:#fcfbf9}
h1{font-weight:600}h2{margin-top:2.5rem;font-weight:600;border-bottom:1px solid #ddd}
main{display:grid;grid-template-columns:repeat(auto-fill,minmax(300px,1fr));gap:1.5rem}
article{background:#fff;border:1px solid #e3e0da;border-radius:6px;overflow:hidden}
.story{grid-column:1/-1}
article img{width:100%;display:block;border-bottom:1px solid #eee}
article div{padding:.7rem .9rem}h3{margin:0 0 .3rem;font-size:1rem}
p{margin:.3rem 0}.facts{font-variant-numeric:tabular-nums;color:#555}.fail{color:#a03024}
pre{overflow:auto;background:#f5f3ef;padding:.6rem;font-size:12px}summary{cursor:pointer;color:#555}";

/// Groups by the beginnings of the names, in the order of the page; the last takes the rest.
const GROUPS: [(&str, &str); 5] = [
    ("gonen-", "Modeling planar 3-valence meshes (Gonen 2007)"),
    ("srinivasan-", "Modeling high-genus surfaces (Srinivasan 2004)"),
    ("sierpinski-fig-", "Sierpinski polyhedra (Srinivasan and Akleman 2004)"),
    ("panelized-", "Freeform surfaces in planar panels"),
    ("", "More"),
];

/// The exhibits of each group, groups without any left out.
fn grouped(exhibits: &[Exhibit]) -> impl Iterator<Item = (&'static str, Vec<&Exhibit>)> {
    let group = |e: &Exhibit| GROUPS.iter().position(|(start, _)| e.name.starts_with(start));
    let groups = GROUPS.iter().enumerate().map(move |(k, &(_, title))| {
        (title, exhibits.iter().filter(|e| group(e) == Some(k)).collect::<Vec<_>>())
    });
    groups.filter(|(_, members)| !members.is_empty())
}

/// One page for all: picture, recipe, counts, genus, planarity, pieces and sheets of each. It
/// refers to the pictures and reports in the folders beside it, and loads nothing else.
pub fn gallery_html(exhibits: &[Exhibit], failures: &[String], command: &str) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n<title>kerfold \
        gallery</title>\n\
         <meta name=\"viewport\" \
         content=\"width=device-width\"/>\n<style>{STYLE}</style>\n</head>\n<body>\n\
         <h1>Gallery</h1>\n<p>{} recipes, made by <code>{}</code></p>\n",
        exhibits.len() + failures.len(),
        escaped(command)
    );
    for failure in failures {
        let _ = writeln!(page, "<p class=\"fail\">{}</p>", escaped(failure));
    }
    for (title, members) in grouped(exhibits) {
        let _ = writeln!(page, "<h2>{}</h2>\n<main>", escaped(title));
        members.into_iter().for_each(|e| card(&mut page, e));
        page += "</main>\n";
    }
    page + "</body>\n</html>\n"
}

fn card(page: &mut String, e: &Exhibit) {
    let (name, title) = (escaped(&e.name), escaped(&e.title));
    let picture = e.picture;
    // A story is read from left to right, so it has the whole width.
    let wide = if picture == super::STORY { " class=\"story\"" } else { "" };
    let _ = writeln!(
        page,
        "<article{wide} id=\"{name}\"><a href=\"{name}/{picture}\"><img src=\"{name}/{picture}\" \
        alt=\"{title}\" \
         loading=\"lazy\"/></a>\n<div><h3>{title}</h3>"
    );
    for line in &e.story {
        let _ = writeln!(page, "<p>{}</p>", escaped(line));
    }
    let _ = writeln!(page, "<p class=\"facts\">{}</p>", escaped(&facts(e)));
    for finding in e.findings.iter().take(4) {
        let _ = writeln!(page, "<p class=\"fail\">{}</p>", escaped(finding));
    }
    let _ = writeln!(
        page,
        "<details><summary>{name}.toml</summary><pre>{}</pre></details>",
        escaped(&e.recipe)
    );
    page.push_str("</div></article>\n");
}

/// Counts, genus, planarity, pieces and sheets in one line.
fn facts(e: &Exhibit) -> String {
    let mut facts = Vec::new();
    if let Some(m) = &e.model {
        let [vertices, edges, faces] = [
            counted(m.vertices, "vertex", "vertices"),
            counted(m.edges, "edge", "edges"),
            counted(m.faces, "face", "faces"),
        ];
        facts.push(format!("{vertices}, {edges}, {faces}"));
        if m.components > 1 {
            facts.push(format!("{} parts", m.components));
        }
        facts.push(format!("genus {}", m.genus));
        facts.push(planarity(m));
    }
    if let Some((pieces, sheets)) = e.pieces {
        let [pieces, sheets] =
            [counted(pieces, "piece", "pieces"), counted(sheets, "sheet", "sheets")];
        facts.push(format!("{pieces} on {sheets}"));
    }
    if !e.findings.is_empty() {
        facts.push(counted(e.findings.len(), "finding", "findings"));
    }
    facts.join(" · ")
}

/// Below a billionth of the model, deviations are the rounding of the computation: no digits that
/// another machine may not show.
fn planarity(m: &ModelFacts) -> String {
    const ROUNDING: f64 = 1e-9;
    if m.planarity_mm <= ROUNDING * m.size_mm {
        "planar to rounding".to_owned()
    } else {
        format!("off plane by {:.2} mm at most", m.planarity_mm)
    }
}

/// The same as a page of Markdown; the pictures are expected in the folder `pictures`, named after
/// the recipes.
pub fn gallery_markdown(exhibits: &[Exhibit], pictures: &str) -> String {
    let mut page = String::new();
    for (title, members) in grouped(exhibits) {
        let _ = writeln!(page, "## {title}\n");
        for e in members {
            let _ =
                writeln!(page, "### {}\n\n![{}]({pictures}/{}.png)\n", e.title, e.title, e.name);
            for line in &e.story {
                let _ = writeln!(page, "{line}  ");
            }
            let _ = writeln!(page, "{}. Recipe `{}`.\n", facts(e), e.name);
        }
    }
    page
}
