//! What `check` and `info` print for people: compact, aligned, with units and definitions.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::check::{CheckKind, FaceReport, Limits, Report, short};
use crate::code::Coded;
use crate::measure::{Planarity, Summary};
use crate::units;

/// Faces in the table of the worst.
const WORST: usize = 10;
/// Findings that are written out; the rest is counted.
const SHOWN: usize = 40;
/// Below this share of the model's size a concave edge is likely the rounding of a file with seven
/// digits.
const FILE_DIGITS: f64 = 1e-6;

/// The report of `check`: model, measures, worst faces, findings, verdict, advice.
///
/// # Example
/// ```
/// use kerfold::io::report::text::check_text;
/// use kerfold::prelude::*;
///
/// let report = check(&kerfold::shape::cube(40.0), &CheckParams::default())?;
/// assert!(check_text(&report, "my program").contains("no findings"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_text(report: &Report, command: &str) -> String {
    let mut page = Page::titled(command);
    let m = &report.model;
    page.row(
        "Model",
        &[
            &counted(m.vertices, "vertex", "vertices"),
            &counted(m.edges, "edge", "edges"),
            &counted(m.faces, "face", "faces"),
        ],
    );
    page.more(&[
        &counted(m.components, "component", "components"),
        &format!("genus {}", m.genus),
        &counted(m.rims, "rim", "rims"),
    ]);
    page.row("Size", &[&extent(m.size_mm)]);
    page.row("Profile", &[&format!("{}: at most {}", report.profile, limits(&report.limits))]);
    page.more(&["limits are kerfold's own defaults or yours, not norms"]);
    page.row("Planarity", &[&format!("largest {}", measures(&report.worst))]);
    let kept: Vec<String> =
        report.profiles.iter().map(|(p, ok)| format!("{p} {}", yes(*ok))).collect();
    page.more(&[&format!("profiles kept: {}", kept.join(", "))]);
    if let Some(mm) = report.carried_mm {
        page.more(&[&format!(
            "largest distance of a corner from the plane that its face carries: {} mm",
            short(mm)
        )]);
    }
    page.row("Valence", &[&format!("{} (edges: vertices)", histogram(&report.valence.histogram))]);
    nodes(&mut page, report);
    page.row("Convex", &[&convexity(report)]);
    crossings(&mut page, report);
    worst_faces(&mut page, report);
    findings(&mut page, report);
    page.blank();
    let count = counted(report.findings.len(), "finding", "findings");
    page.row("Verdict", &[&format!("{}: {count}", report.verdict())]);
    for (i, line) in advice(report).iter().enumerate() {
        if i == 0 { page.row("Advice", &[line]) } else { page.more(&[line]) }
    }
    page.text
}

/// The summary of `info`. `notes` are what the reader had to say.
///
/// # Example
/// ```
/// use kerfold::io::report::text::info_text;
/// use kerfold::measure::summary;
///
/// let facts = summary(&kerfold::shape::cube(40.0));
/// assert!(info_text(&facts, &[], "my program").contains("12"));
/// ```
pub fn info_text(summary: &Summary, notes: &[String], command: &str) -> String {
    let mut page = Page::titled(command);
    let s = summary;
    page.row(
        "Model",
        &[
            &counted(s.vertices, "vertex", "vertices"),
            &counted(s.edges, "edge", "edges"),
            &counted(s.faces, "face", "faces"),
        ],
    );
    let genus: usize = s.components.iter().map(|c| c.genus).sum();
    page.more(&[
        &counted(s.components.len(), "component", "components"),
        &format!("genus {genus}"),
        &format!("Euler number {}", s.euler_number),
    ]);
    page.row("Size", &[&extent(s.size), &format!("area {} mm²", short(s.area))]);
    if let Some(l) = s.edge_lengths {
        let spread = format!(
            "{} shortest, {} mean, {} longest, {} in all (mm)",
            short(l.min),
            short(l.mean),
            short(l.max),
            short(l.total)
        );
        page.row("Edges", &[&spread]);
    }
    page.row("Valence", &[&format!("{} (edges: vertices)", histogram(&s.valences))]);
    page.row("Sides", &[&format!("{} (sides: faces)", histogram(&s.sides))]);
    rims(&mut page, s);
    if s.seams > 0 {
        page.row("Seams", &[&format!("{} marked", counted(s.seams, "edge", "edges"))]);
    }
    for (i, g) in s.groups.iter().enumerate() {
        let group = format!("{} ({})", g.name, counted(g.faces, "face", "faces"));
        if i == 0 { page.row("Groups", &[&group]) } else { page.more(&[&group]) }
    }
    components(&mut page, s);
    for note in notes.iter().chain(&inwards_in_words(s)) {
        page.row("Note", &[note]);
    }
    page.text
}

fn rims(page: &mut Page, s: &Summary) {
    if s.rims.is_empty() {
        return page.row("Rims", &["none, the surface is closed"]);
    }
    let edges: usize = s.rims.iter().sum();
    let length = format!("{} mm", short(s.rim_length));
    let rims = counted(s.rims.len(), "rim", "rims");
    page.row("Rims", &[&rims, &counted(edges, "edge", "edges"), &length]);
}

/// Components whose faces look inwards, if there are any.
fn inwards_in_words(s: &Summary) -> Option<String> {
    let inwards = s.components.iter().filter(|c| c.volume.is_some_and(|v| v < 0.0)).count();
    let components = counted(inwards, "component", "components");
    (inwards > 0).then(|| {
        format!("{components} with a negative volume: faces look inwards there, or it is a cavity")
    })
}

/// Faces that go through each other, where there are any.
fn crossings(page: &mut Page, report: &Report) {
    /// Pairs that are named.
    const NAMED: usize = 8;
    let found = &report.crossings;
    if found.is_empty() {
        return;
    }
    let pairs = counted(found.len(), "pair", "pairs");
    let names: Vec<String> =
        found.iter().take(NAMED).map(|p| format!("{} with {}", p.first, p.second)).collect();
    let more = if found.len() > NAMED { ", …" } else { "" };
    page.row(
        "Crossings",
        &[&format!("{pairs} of faces go through each other: {}{more}", names.join(", "))],
    );
    page.more(&["`--require simple` makes a finding of them"]);
}

fn nodes(page: &mut Page, report: &Report) {
    if report.conical.is_empty() {
        return;
    }
    let worst = report.conical.iter().filter_map(|n| Some((n.residual?, n.vertex)));
    let worst = worst.reduce(|a, b| if b.0 > a.0 { b } else { a });
    let crowded = counted(report.conical.len(), "vertex has", "vertices have");
    page.row("Nodes", &[&format!("{crowded} more than three edges")]);
    if let Some((residual, vertex)) = worst {
        let gap = format!(
            "plates miss each other there by up to {} mm per mm of thickness (vertex {vertex})",
            short(residual)
        );
        page.more(&[&gap]);
    }
}

fn convexity(report: &Report) -> String {
    let c = &report.convexity;
    if report.is_convex() {
        return "yes".into();
    }
    let mut why = Vec::new();
    if !c.is_ball {
        why.push("not one closed part without handles".to_owned());
    }
    if !c.concave_edges.is_empty() {
        why.push(counted(c.concave_edges.len(), "concave edge", "concave edges"));
    }
    if !c.concave_faces.is_empty() {
        why.push(counted(c.concave_faces.len(), "concave face", "concave faces"));
    }
    if c.deepest_mm > 0.0 {
        why.push(format!("deepest {} mm", short(c.deepest_mm)));
    }
    if why.is_empty() {
        why.push("it does not wind once around its middle".to_owned());
    }
    format!("no: {}", why.join(", "))
}

fn worst_faces(page: &mut Page, report: &Report) {
    let worst: Vec<&FaceReport> =
        report.worst_faces(WORST).into_iter().filter(|f| f.sides > 3).collect();
    page.blank();
    if worst.is_empty() {
        return page.line("No face has more than three corners, so all are planar exactly.");
    }
    page.line(&format!(
        "{:>8} {:>6} {:>10} {:>10} {:>10} {:>10}  limit used",
        "face", "sides", "mm", "‰", "°", "%"
    ));
    for f in worst {
        let p = &f.planarity;
        let percent = p.percent.map_or("-".into(), short);
        let used = share(report.limits.share(p));
        page.line(&format!(
            "{:>8} {:>6} {:>10} {:>10} {:>10} {:>10}  {used}",
            f.face.index(),
            f.sides,
            short(p.mm),
            short(p.permille),
            short(p.degrees),
            percent
        ));
    }
    page.line(
        "mm: largest distance of a corner from the least-squares plane; ‰: the same over the \
    face's diameter;",
    );
    page.line(
        "°: largest angle between the face's normal and that of a corner; %: gap of a quad's \
    diagonals over their length.",
    );
}

fn findings(page: &mut Page, report: &Report) {
    if report.findings.is_empty() {
        return;
    }
    page.blank();
    let width = report.findings.iter().map(|f| f.check.name().len()).max().unwrap_or(0);
    for f in report.findings.iter().take(SHOWN) {
        page.line(&format!("{} {:width$}  {}", f.check.code(), f.check.name(), f.message));
    }
    if report.findings.len() > SHOWN {
        page.line(&format!(
            "... and {} more; --report FILE.json lists all",
            report.findings.len() - SHOWN
        ));
    }
}

/// What to do next, most pressing first.
fn advice(report: &Report) -> Vec<String> {
    let has = |kind| report.findings.iter().any(|f| f.check == kind);
    let mut lines = Vec::new();
    if has(CheckKind::DegenerateFace) || has(CheckKind::ZeroLengthEdge) {
        lines.push(
            "faces without area and edges without length: weld their vertices (--weld) or remove \
            them"
                .to_owned(),
        );
    }
    if has(CheckKind::SelfIntersection) {
        lines.push(
            "faces that cross themselves cannot be cut out of a sheet: redraw or divide them"
                .to_owned(),
        );
    }
    if has(CheckKind::Planarity) {
        lines.push("to flatten the faces: kerfold planarize IN -o OUT".to_owned());
        let kept: Vec<&str> =
            report.profiles.iter().filter(|(_, ok)| *ok).map(|(p, _)| p.name()).collect();
        if !kept.is_empty() {
            lines.push(format!(
                "the model keeps the profile {} (--profile) as it is",
                kept.join(", ")
            ));
        }
    }
    if !report.conical.is_empty() {
        lines.push(
            "to leave three edges at every vertex: kerfold cut vertex IN --select \
            'valence>3' -o OUT"
                .to_owned(),
        );
    }
    if has(CheckKind::Closed) {
        lines.push(
            "rims are cut like any outline; to close small holes: kerfold repair IN --close-holes \
            10mm -o OUT"
                .to_owned(),
        );
    }
    if has(CheckKind::InsideOut) || has(CheckKind::Junction) || has(CheckKind::Doubled) {
        lines.push("to mend the surface: kerfold repair IN -o OUT".to_owned());
    }
    lines.extend(report.flat.proposal());
    if has(CheckKind::Convex) {
        lines.push("for the convex hull: kerfold hull IN -o OUT".to_owned());
        if report.convexity.deepest_mm < FILE_DIGITS * report.model.size_mm.length() {
            lines.push(
                "what is concave is so by a hair: the file may have too few digits".to_owned(),
            );
        }
    }
    if has(CheckKind::Manifold) {
        lines.push(
            "vertices at one place: weld them (--weld), or pull apart what should not touch"
                .to_owned(),
        );
    }
    if !report.has_findings() {
        lines.push("to unfold it into sheets: kerfold unfold IN -o DIR".to_owned());
    }
    lines
}

fn components(page: &mut Page, summary: &Summary) {
    page.blank();
    page.line(&format!(
        "{:>9} {:>9} {:>9} {:>9} {:>6} {:>5}  volume mm³",
        "component", "vertices", "edges", "faces", "genus", "rims"
    ));
    for (i, c) in summary.components.iter().enumerate().take(SHOWN) {
        let volume = c.volume.map_or("open".into(), short);
        page.line(&format!(
            "{i:>9} {:>9} {:>9} {:>9} {:>6} {:>5}  {volume}",
            c.vertices, c.edges, c.faces, c.genus, c.rims
        ));
    }
    if summary.components.len() > SHOWN {
        page.line(&format!("... and {} more; --json lists all", summary.components.len() - SHOWN));
    }
}

/// Lines with a label in the first columns.
struct Page {
    text: String,
}

impl Page {
    fn titled(command: &str) -> Self {
        Self { text: format!("{command}\n\n") }
    }

    fn row(&mut self, label: &str, parts: &[&str]) {
        self.line(&format!("{label:<10} {}", parts.join(", ")));
    }

    fn more(&mut self, parts: &[&str]) {
        self.row("", parts);
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line.trim_end());
        self.text.push('\n');
    }

    fn blank(&mut self) {
        self.text.push('\n');
    }
}

/// A count in a text to be read: none is `no sheets`.
fn counted(count: usize, one: &str, many: &str) -> String {
    if count == 0 { format!("no {many}") } else { units::counted(count, one, many) }
}

fn yes(is: bool) -> &'static str {
    if is { "yes" } else { "no" }
}

fn extent(size: DVec3) -> String {
    format!("{} x {} x {} mm", short(size.x), short(size.y), short(size.z))
}

fn measures(p: &Planarity) -> String {
    let quads =
        p.percent.map(|percent| format!(", quads {} %", short(percent))).unwrap_or_default();
    format!("{} mm, {} ‰, {}°{quads}", short(p.mm), short(p.permille), short(p.degrees))
}

fn limits(limits: &Limits) -> String {
    let parts =
        [(limits.mm, " mm"), (limits.permille, " ‰ of the face's diameter"), (limits.degrees, "°")];
    let parts: Vec<String> = parts
        .into_iter()
        .filter_map(|(limit, unit)| Some(format!("{}{unit}", short(limit?))))
        .collect();
    parts.join(" and ") + &shape_limits(limits)
}

/// The limits of shapes as they follow those of planarity; empty without any.
pub(super) fn shape_limits(limits: &Limits) -> String {
    let least = [
        (limits.min_angle_degrees, "corners of at least ", "°"),
        (limits.min_edge_mm, "edges of at least ", " mm"),
        (limits.max_mitre_degrees, "mitres of at most ", "°"),
    ];
    let said = least.into_iter().filter_map(|(limit, what, unit)| Some((limit?, what, unit)));
    said.map(|(limit, what, unit)| format!("; {what}{}{unit}", short(limit))).collect()
}

fn histogram(counts: &BTreeMap<usize, usize>) -> String {
    let parts: Vec<String> =
        counts.iter().map(|(value, count)| format!("{value}: {count}")).collect();
    if parts.is_empty() { "none".into() } else { parts.join(", ") }
}

fn share(share: f64) -> String {
    if share < 0.01 {
        "< 1 %".into()
    } else if share < 100.0 {
        format!("{:.0} %", 100.0 * share)
    } else {
        "> 100 times".into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::check::{CheckParams, Profile, Requirement, check};
    use crate::fixtures::{cube, ell_prism, octahedron, open_box};
    use crate::measure::summary;
    use crate::mesh::{Mesh, VertexId};

    #[test]
    fn a_cube_reads_well() {
        let report = check(&cube(), &CheckParams::default()).expect("good limits");
        let wanted = "\
kerfold check cube.obj

Model      8 vertices, 12 edges, 6 faces
           1 component, genus 0, no rims
Size       2 x 2 x 2 mm
Profile    glass: at most 1 mm and 2 ‰ of the face's diameter
           limits are kerfold's own defaults or yours, not norms
Planarity  largest 0 mm, 0 ‰, 0°, quads 0 %
           profiles kept: exact yes, glass yes, plywood yes, paper yes
Valence    3: 8 (edges: vertices)
Convex     yes
";
        let text = check_text(&report, "kerfold check cube.obj");
        assert!(text.starts_with(wanted), "{text}");
        let end = "\nVerdict    pass: no findings\nAdvice     to unfold it into sheets: kerfold \
        unfold IN -o DIR\n";
        assert!(text.ends_with(end), "{text}");
    }

    #[test]
    fn a_bent_concave_and_crowded_model_gets_advice() {
        let mut mesh = ell_prism();
        mesh.set_position(VertexId::new(0), DVec3::new(0.0, 0.0, -0.5), true);
        let params = CheckParams {
            profile: Profile::Paper,
            require: vec![Requirement::Convex],
            ..CheckParams::default()
        };
        let text = check_text(&check(&mesh, &params).expect("good limits"), "kerfold");
        for part in [
            "Verdict    fail: ",
            "planarize",
            "kerfold hull IN",
            "1 concave edge",
            "the model keeps the profile plywood",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
        let text = check_text(
            &check(&octahedron(), &CheckParams::default()).expect("good limits"),
            "kerfold",
        );
        for part in ["6 vertices have more than three edges", "valence>3", "planar exactly"] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
    }

    #[test]
    fn the_info_shows_rims_groups_and_notes() {
        let mut mesh = open_box();
        mesh.set_group(crate::mesh::FaceId::new(0), "floor");
        let text =
            info_text(&summary(&mesh), &["three vertices welded".into()], "kerfold info box.obj");
        for part in [
            "Rims       1 rim, 4 edges, 8 mm",
            "Groups     floor (1 face)",
            "Note       three vertices welded",
            "  open\n",
            "Euler number 1",
        ] {
            assert!(text.contains(part), "no {part} in\n{text}");
        }
        assert!(info_text(&summary(&Mesh::new()), &[], "kerfold info").contains("no vertices"));
    }
}
