//! What was reached, as numbers and in words.

use glam::DVec3;

use super::curvature::Quadric;
use super::prove::node_reach;
use super::regions::Kind;
use super::{EXACT, Model, PanelizeFinding, PanelizeParams, Solved};
use crate::check::short;
use crate::code::Coded;

/// Panels that leave the surface by more than this share of their size do so because it bends too
/// much for them; a sag of as much is the most that goes well.
const MOST_OFF: f64 = 0.2;
/// Plates may reach so many thicknesses from their node.
const FARTHEST_NODE: f64 = 1.5;
/// The sag counts where it is largest but for this share of the surface.
const SHARE: f64 = 0.99;
/// So many places of one kind are named.
const NAMED: usize = 6;

/// A place of the result with what was measured there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// What is wrong.
    pub finding: PanelizeFinding,
    /// The face, or the vertex for [`PanelizeFinding::FarNode`].
    pub element: usize,
    /// What was measured: mm, degrees or thicknesses.
    pub measured: f64,
    /// Where, in mm.
    pub place: DVec3,
}

/// What was reached. Lengths are in mm, angles in degrees, areas in those of a regular hexagon of
/// the panel size.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelizeReport {
    /// The panel size.
    pub size_mm: f64,
    /// How many panels there are.
    pub panels: usize,
    /// How many there should be for the size.
    pub wanted: f64,
    /// The largest and the 95th percentile of the distance of a panel from the surface.
    pub deviation_mm: [f64; 2],
    /// By how much a flat panel leaves the surface where it bends most.
    pub sag_mm: f64,
    /// The shortest edge.
    pub shortest_mm: f64,
    /// The smallest and the largest angle.
    pub angles: [f64; 2],
    /// The smallest and the largest area.
    pub areas: [f64; 2],
    /// How many inner panels there are, and how many of them are hexagons.
    pub inner: [usize; 2],
    /// How many panels are concave.
    pub concave: usize,
    /// How far plates reach from a node, at most, in thicknesses.
    pub node_reach: f64,
    /// The largest distance of a corner from its planes.
    pub planarity_mm: f64,
    /// What is wrong, by kind, the worst first.
    pub findings: Vec<Place>,
    /// Whether the work was stopped.
    pub was_stopped: bool,
}

impl PanelizeReport {
    pub(super) fn new(model: &Model, solved: &Solved, params: &PanelizeParams) -> Self {
        let m = &solved.measured;
        let size = model.size;
        let least =
            |value: &dyn Fn(usize) -> f64| (0..m.len()).map(value).fold(f64::INFINITY, f64::min);
        let most = |value: &dyn Fn(usize) -> f64| (0..m.len()).map(value).fold(0.0, f64::max);
        let deviations: Vec<f64> = m.iter().map(|m| m.deviation).collect();
        let inner: Vec<_> = m.iter().filter(|m| !m.is_rim).collect();
        let mut made = Self {
            size_mm: size,
            panels: m.len(),
            wanted: model.surface.area() / super::sites::PANEL_AREA,
            deviation_mm: [1.0, 0.95].map(|share| percentile(&deviations, share) * size),
            sag_mm: sag(&model.quadrics) * size,
            shortest_mm: least(&|f| m[f].shortest) * size,
            angles: [least(&|f| m[f].least_angle), most(&|f| m[f].largest_angle)],
            areas: [least(&|f| m[f].area), most(&|f| m[f].area)],
            inner: [inner.len(), inner.iter().filter(|m| m.sides == 6).count()],
            concave: m.iter().filter(|m| m.concave > 0).count(),
            node_reach: reaches(solved).map(|(_, reach)| reach).fold(0.0, f64::max),
            planarity_mm: solved.lack * size,
            findings: Vec::new(),
            was_stopped: solved.was_stopped,
        };
        made.findings = findings(model, solved, params);
        made
    }

    /// Whether everything is as it should be.
    pub fn is_clean(&self) -> bool {
        self.findings.is_empty() && !self.was_stopped
    }

    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![self.summary(), self.shape()];
        let mut rest = &self.findings[..];
        while let Some(first) = rest.first() {
            let count = rest.iter().take_while(|place| place.finding == first.finding).count();
            notes.push(self.told(&rest[..count]));
            rest = &rest[count..];
        }
        if self.was_stopped {
            notes.push(format!(
                "stopped early: the panels are the best so far ({})",
                PanelizeFinding::Stopped.code()
            ));
        }
        notes
    }

    fn summary(&self) -> String {
        format!(
            "{} panels of {} mm (room for {:.0}); off the surface by {} mm at most and {} mm for \
            95 % (a flat panel of the size leaves it by {} mm); corners off their planes by {} mm \
            at most",
            self.panels,
            short(self.size_mm),
            self.wanted,
            short(self.deviation_mm[0]),
            short(self.deviation_mm[1]),
            short(self.sag_mm),
            short(self.planarity_mm),
        )
    }

    fn shape(&self) -> String {
        format!(
            "shortest edge {} mm; angles {:.0} to {:.0}°; areas {:.2} to {:.2} of a regular \
            hexagon; {} of {} inner panels are hexagons; {} concave; plates reach at most {:.2} \
            thicknesses from a node",
            short(self.shortest_mm),
            self.angles[0],
            self.angles[1],
            self.areas[0],
            self.areas[1],
            self.inner[1],
            self.inner[0],
            self.concave,
            self.node_reach,
        )
    }

    /// Places with one finding, in words.
    fn told(&self, places: &[Place]) -> String {
        let kind = places[0].finding;
        let (what, advice) = match kind {
            PanelizeFinding::Crosses => (
                "panels that cross themselves or run against the surface",
                "take a smaller size, another alignment or another seed",
            ),
            PanelizeFinding::GoesThrough => {
                ("panels that go through another", "take a smaller size or another seed")
            }
            PanelizeFinding::NotPlanar => {
                ("panels that are not planar up to rounding", "take a smaller size or another seed")
            }
            PanelizeFinding::TooCurved => (
                "panels that leave the surface by more than a fifth of their size, since it bends \
                too much for it",
                "take a smaller size",
            ),
            PanelizeFinding::ShortEdge => {
                ("panels with a shorter edge than allowed", "take another seed or a smaller size")
            }
            PanelizeFinding::SharpAngle => {
                ("panels with a sharper angle than allowed", "take another seed or a smaller size")
            }
            PanelizeFinding::TooLarge => {
                ("panels that do not fit the sheet", "take a smaller size")
            }
            PanelizeFinding::FarNode => (
                "vertices that plates reach from far",
                "bend the surface more there, or take another seed",
            ),
            PanelizeFinding::Stopped => ("panels that are not finished", "run it to the end"),
        };
        let unit = match kind {
            PanelizeFinding::SharpAngle => "°",
            PanelizeFinding::FarNode => " thicknesses",
            PanelizeFinding::Crosses | PanelizeFinding::GoesThrough => "",
            _ => " mm",
        };
        let name = |place: &Place| {
            let measured = if unit.is_empty() {
                String::new()
            } else {
                format!(" {}{unit}", short(place.measured))
            };
            let p = place.place;
            format!("{}{measured} at ({:.0}, {:.0}, {:.0})", place.element, p.x, p.y, p.z)
        };
        let fitting = self.size_mm * MOST_OFF / (self.sag_mm / self.size_mm);
        let fitting = match kind {
            PanelizeFinding::TooCurved if fitting < self.size_mm => {
                format!(" (about {} mm fits)", short(fitting))
            }
            _ => String::new(),
        };
        let names: Vec<String> = places.iter().take(NAMED).map(name).collect();
        let more = if places.len() > NAMED { ", …" } else { "" };
        format!(
            "{what}, {} in all: {}{more}; {advice}{fitting} ({})",
            places.len(),
            names.join(", "),
            kind.code()
        )
    }
}

/// Everything that is wrong, by kind, the worst first.
fn findings(model: &Model, solved: &Solved, params: &PanelizeParams) -> Vec<Place> {
    let m = &solved.measured;
    let size = model.size;
    let panels = &solved.state.panels;
    let centre = |f: usize| model.place(panels.centre(f));
    let faces = |finding, measured: &dyn Fn(usize) -> Option<f64>| -> Vec<Place> {
        let all = (0..m.len()).filter_map(|f| Some((f, measured(f)?)));
        let mut found: Vec<Place> = all
            .map(|(f, measured)| Place { finding, element: f, measured, place: centre(f) })
            .collect();
        found.sort_by(|a, b| b.measured.total_cmp(&a.measured).then(a.element.cmp(&b.element)));
        found
    };
    let is_through = |f: usize| solved.through.iter().any(|pair| pair.contains(&f));
    let mut all = faces(PanelizeFinding::Crosses, &|f| (!m[f].is_sound).then_some(0.0));
    all.extend(faces(PanelizeFinding::GoesThrough, &|f| is_through(f).then_some(0.0)));
    if solved.lack > EXACT {
        let off = |f: usize| {
            let corners = panels.faces[f].iter().map(|&v| panels.points[v]);
            corners.map(|p| solved.state.planes[f].distance(p).abs()).fold(0.0, f64::max)
        };
        all.extend(faces(PanelizeFinding::NotPlanar, &|f| (off(f) > EXACT).then(|| off(f) * size)));
    }
    all.extend(faces(PanelizeFinding::TooCurved, &|f| {
        (m[f].deviation > MOST_OFF).then(|| m[f].deviation * size)
    }));
    let mut short_edges = faces(PanelizeFinding::ShortEdge, &|f| {
        (m[f].shortest < params.min_edge / 2.0).then(|| m[f].shortest * size)
    });
    short_edges.reverse();
    all.extend(short_edges);
    let sharpest = |f: usize| m[f].least_angle.min(360.0 - m[f].largest_angle);
    let mut sharp = faces(PanelizeFinding::SharpAngle, &|f| {
        (sharpest(f) < params.min_angle.degrees() / 2.0).then(|| sharpest(f))
    });
    sharp.reverse();
    all.extend(sharp);
    if let Some(sheet) = params.max_panel {
        all.extend(faces(PanelizeFinding::TooLarge, &|f| {
            (!fits(m[f].extent.map(|x| x * size), sheet.0)).then(|| m[f].diameter * size)
        }));
    }
    all.extend(far_nodes(model, solved));
    all
}

/// Whether a box fits a sheet, either way around; both with the shorter side first.
/// The panel by its longer side first, the sheet by its shorter.
fn fits(panel: [f64; 2], sheet: [f64; 2]) -> bool {
    panel[0] <= sheet[1] && panel[1] <= sheet[0]
}

pub(super) fn far_nodes(model: &Model, solved: &Solved) -> Vec<Place> {
    let far = reaches(solved).filter(|&(_, reach)| reach > FARTHEST_NODE);
    let mut found: Vec<Place> = far
        .map(|(v, measured)| Place {
            finding: PanelizeFinding::FarNode,
            element: v,
            measured,
            place: model.place(solved.state.panels.points[v]),
        })
        .collect();
    found.sort_by(|a, b| b.measured.total_cmp(&a.measured).then(a.element.cmp(&b.element)));
    found
}

/// The reach of every inner node.
fn reaches(solved: &Solved) -> impl Iterator<Item = (usize, f64)> + '_ {
    let state = &solved.state;
    let inner = (0..state.panels.points.len()).filter(|&v| state.panels.kinds[v] == Kind::Inner);
    inner.filter_map(|v| {
        let &[a, b, c] = &state.fans[v][..] else { return None };
        Some((v, node_reach([a, b, c].map(|f| state.planes[f].normal))))
    })
}

/// By how much of its size a flat panel leaves the surface where it bends most.
pub(super) fn sag(quadrics: &[Quadric]) -> f64 {
    percentile(&quadrics.iter().map(Quadric::sag).collect::<Vec<f64>>(), SHARE)
}

pub(super) fn percentile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().saturating_sub(1);
    sorted.get((last as f64 * share) as usize).copied().unwrap_or(0.0)
}
