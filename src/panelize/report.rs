//! What was reached, as numbers and in words.

use glam::DVec3;

use super::curvature::Quadric;
use super::outcomes::{
    FamilyReport, FixedPanel, MirrorReport, Place, StayedPoint, fixed_note, stayed_note,
};
use super::prove::node_reach;
use super::stays::{fixed_panels, lost_planes, lost_points, mirrors, stayed_points, unpaired};
use super::words::{unit_of, words, words_of_wishes};
use super::{ALIKE, EXACT, Model, PanelizeFinding, PanelizeParams, Solved};
use crate::check::short;
use crate::code::Coded;

/// Panels that leave the surface by more than this share of their size do so because it bends too
/// much for them; a sag of as much is the most that goes well.
const MOST_OFF: f64 = 0.2;
/// Creases that are kept may be so far from the edges of panels, in panel sizes.
pub(super) const CREASE_OFF: f64 = 0.1;
/// The sag counts where it is largest but for this share of the surface.
const SHARE: f64 = 0.99;
/// Panels may be so much more or fewer than were asked for, or so many.
const MOST_OTHER: f64 = 0.1;
const FEW_OTHER: f64 = 5.0;
/// So many of the panels that are farthest off are named.
const WORST: usize = 3;
/// So many places of one kind are named.
const NAMED: usize = 6;

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
    /// How many were asked for, where the size came from that.
    pub asked: Option<u32>,
    /// The largest and the 95th percentile of the distance of a panel from the surface.
    pub deviation_mm: [f64; 2],
    /// By how much a flat panel leaves the surface where it bends most.
    pub sag_mm: f64,
    /// How far the surface that was used lies from the one that was given, at most and for 95 % of
    /// its vertices, and the share of them that would have gone farther than was allowed; `None`
    /// unless it was made even.
    pub smoothed_mm: Option<[f64; 3]>,
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
    /// How deep a concave corner lies within the convex hull of its panel, at most.
    pub hollow_mm: f64,
    /// The largest angle by which neighbours fold.
    pub largest_fold: f64,
    /// The panels that are farthest off the surface, and by how much, in mm; the worst first.
    pub worst: Vec<(usize, f64)>,
    /// How far plates reach from a node, at most, in thicknesses.
    pub node_reach: f64,
    /// The largest distance of a corner from its planes.
    pub planarity_mm: f64,
    /// How many panels differ by more than a thousandth of the panel size in a side or a diagonal;
    /// mirror images are alike.
    pub panel_kinds: usize,
    /// How many edges differ by more in length, and how many edges there are.
    pub edge_kinds: [usize; 2],
    /// How many rings there are, caps among them; 0 for other layouts.
    pub rings: usize,
    /// What became of edges of the surface that fold by more than `crease`, or 40 degrees.
    pub creases: CreaseReport,
    /// The panels whose planes were given.
    pub fixed: Vec<FixedPanel>,
    /// The points that were to stay.
    pub stayed: Vec<StayedPoint>,
    /// What was to stay and could not, in words.
    pub not_fixed: Vec<String>,
    /// The mirror planes.
    pub mirrors: Vec<MirrorReport>,
    /// What became of families of lengths, if they were asked for.
    pub families: Option<FamilyReport>,
    /// What is wrong, by kind, the worst first.
    pub findings: Vec<Place>,
    /// Whether the work was stopped.
    pub was_stopped: bool,
}

/// What became of the edges of the surface that fold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CreaseReport {
    /// How many edges of the surface fold by more than the limit.
    pub edges: usize,
    /// The largest fold.
    pub largest_fold: f64,
    /// Whether they were to be kept.
    pub is_kept: bool,
    /// The largest distance of a place on them from the edges of panels if they were to be kept,
    /// else from the panels.
    pub off_mm: f64,
}

/// Findings of one kind that a picture points out.
const POINTED_OUT: usize = 8;

impl PanelizeReport {
    /// What a picture of the worst should point out, by the numbers of faces and of vertices: the
    /// first findings of each kind, or without any the panels that are farthest off the surface.
    pub fn pointed_out(&self) -> [Vec<usize>; 2] {
        let mut pointed = [Vec::new(), Vec::new()];
        for kind in self.findings.chunk_by(|a, b| a.finding == b.finding) {
            let is_node = kind[0].finding.is_of_vertex();
            pointed[usize::from(is_node)].extend(kind.iter().take(POINTED_OUT).map(|p| p.element));
        }
        if self.findings.is_empty() {
            pointed[0] = self.worst.iter().map(|&(f, _)| f).collect();
        }
        for elements in &mut pointed {
            elements.sort_unstable();
            elements.dedup();
        }
        pointed
    }

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
            wanted: model.surface.room(),
            asked: params.count,
            deviation_mm: [1.0, 0.95].map(|share| percentile(&deviations, share) * size),
            sag_mm: sag(&model.quadrics) * size,
            smoothed_mm: model.moved.map(|m| [m.distance[0] * size, m.distance[1] * size, m.held]),
            shortest_mm: least(&|f| m[f].shortest) * size,
            angles: [least(&|f| m[f].least_angle), most(&|f| m[f].largest_angle)],
            areas: [least(&|f| m[f].area), most(&|f| m[f].area)],
            inner: [inner.len(), inner.iter().filter(|m| m.sides == 6).count()],
            concave: m.iter().filter(|m| m.concave > 0).count(),
            hollow_mm: most(&|f| m[f].hollow) * size,
            largest_fold: most(&|f| m[f].fold),
            worst: worst(&deviations, size),
            node_reach: reaches(solved).map(|(_, reach)| reach).fold(0.0, f64::max),
            planarity_mm: solved.lack * size,
            panel_kinds: solved.kinds.panels,
            edge_kinds: [solved.kinds.edges, solved.kinds.all_edges],
            rings: solved.rings.iter().max().map_or(0, |last| last + 1),
            creases: CreaseReport {
                edges: model.folds.len(),
                largest_fold: model.folds.iter().map(|f| f.angle).fold(0.0, f64::max).to_degrees(),
                is_kept: model.keeps_creases,
                off_mm: solved.off_folds.iter().map(|(off, _)| *off).fold(0.0, f64::max) * size,
            },
            fixed: fixed_panels(model, solved),
            stayed: stayed_points(model, solved),
            not_fixed: model.pin_notes.clone(),
            families: solved.families.clone(),
            mirrors: mirrors(model, solved).into_iter().map(|(report, _)| report).collect(),
            findings: Vec::new(),
            was_stopped: solved.was_stopped,
        };
        made.findings = findings(model, solved, params);
        made
    }

    /// Whether everything is as it should be.
    pub fn is_clean(&self) -> bool {
        self.findings.is_empty() && !self.was_stopped && self.other_count().is_none()
    }

    /// The number that was asked for, where the panels are more than a tenth, and more than five, off it.
    fn other_count(&self) -> Option<u32> {
        let off = |asked: u32| (self.panels as f64 - f64::from(asked)).abs();
        self.asked.filter(|&asked| off(asked) > (MOST_OTHER * f64::from(asked)).max(FEW_OTHER))
    }

    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![self.summary(), self.shape(), self.repeats()];
        notes.extend(self.creases.note());
        notes.extend(self.smoothed_mm.map(smoothing));
        notes.extend(fixed_note(&self.fixed));
        notes.extend(stayed_note(&self.stayed));
        notes.extend(self.mirrors.iter().map(MirrorReport::note));
        notes.extend(self.families.as_ref().map(FamilyReport::note));
        notes.extend(self.not_fixed.iter().cloned());
        let mut rest = &self.findings[..];
        while let Some(first) = rest.first() {
            let count = rest.iter().take_while(|place| place.finding == first.finding).count();
            notes.push(self.told(&rest[..count]));
            rest = &rest[count..];
        }
        if let Some(asked) = self.other_count() {
            notes.push(format!(
                "{} panels, where {asked} were asked for: parts of the surface are thinner than a \
                panel; ask for more, or give --size ({})",
                self.panels,
                PanelizeFinding::OtherCount.code()
            ));
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
            "{} panels of {} mm (room for {:.0}); off the surface by {} mm at most (panels {}) and {} mm \
            for 95 % (a flat panel of the size leaves it by {} mm); corners off their planes by {} mm \
            at most",
            self.panels,
            short(self.size_mm),
            self.wanted,
            short(self.deviation_mm[0]),
            self.worst.iter().map(|(f, _)| f.to_string()).collect::<Vec<_>>().join(", "),
            short(self.deviation_mm[1]),
            short(self.sag_mm),
            short(self.planarity_mm),
        )
    }

    fn shape(&self) -> String {
        format!(
            "shortest edge {} mm; angles {:.0} to {:.0}°; areas {:.2} to {:.2} of a regular \
            hexagon; {} of {} inner panels are hexagons; {} concave, up to {} mm deep; neighbours fold by \
            up to {:.1}°; plates reach at most {:.2} thicknesses from a node",
            short(self.shortest_mm),
            self.angles[0],
            self.angles[1],
            self.areas[0],
            self.areas[1],
            self.inner[1],
            self.inner[0],
            self.concave,
            short(self.hollow_mm),
            self.largest_fold,
            self.node_reach,
        )
    }

    /// How often panels and edges repeat, in words.
    fn repeats(&self) -> String {
        let [edges, all] = self.edge_kinds;
        let rings = match self.rings {
            0 => String::new(),
            rings => format!(" in {rings} rings, caps among them"),
        };
        format!(
            "within {} mm there are {} different panels{rings} (mirror images count as one) and \
            {edges} different lengths of {all} edges",
            short(self.size_mm * ALIKE),
            self.panel_kinds,
        )
    }

    /// Places with one finding, in words.
    fn told(&self, places: &[Place]) -> String {
        let kind = places[0].finding;
        let (what, advice) = words(kind).unwrap_or_else(|| words_of_wishes(kind));
        let unit = unit_of(kind);
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

impl CreaseReport {
    /// What became of them, in words; nothing without any.
    fn note(&self) -> Option<String> {
        let Self { edges, largest_fold, .. } = self;
        let off = short(self.off_mm);
        match (edges, self.is_kept) {
            (0, true) => Some("the surface has no crease to be kept: no edge folds so far".into()),
            (0, false) => None,
            (_, true) => Some(format!(
                "creases kept: {edges} edges of the surface, folds up to {largest_fold:.0}°; edges \
                of panels follow them within {off} mm"
            )),
            (_, false) => Some(format!(
                "creases rounded: {edges} edges of the surface fold by more than 40°, up to \
                {largest_fold:.0}°, and lie up to {off} mm off the panels; keep them with `--crease \
                40deg`"
            )),
        }
    }
}

/// How far the surface was made even, in words.
fn smoothing([most, usual, held]: [f64; 3]) -> String {
    let told = format!(
        "the surface was made even: it lies within {} mm of the one that was given, and within {} \
        mm for 95 % of it; panels are measured from the even one",
        short(most),
        short(usual)
    );
    if held > 0.0 {
        let share = (held * 100.0).max(0.1);
        return format!("{told}; {share:.1} % of it would have moved farther than --smooth allows");
    }
    told
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
    let most_off = params.max_off.map_or(MOST_OFF, |off| off.mm() / size);
    all.extend(faces(PanelizeFinding::TooCurved, &|f| {
        (m[f].deviation > most_off).then(|| m[f].deviation * size)
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
    if let Some(most) = params.max_fold.map(|angle| angle.degrees()) {
        all.extend(faces(PanelizeFinding::SharpFold, &|f| (m[f].fold > most).then(|| m[f].fold)));
    }
    if let Some(most) = params.max_hollow.map(|depth| depth.mm() / size) {
        let hollow = |f: usize| (m[f].hollow > most).then(|| m[f].hollow * size);
        all.extend(faces(PanelizeFinding::DeepHollow, &hollow));
    }
    if let Some(sheet) = params.max_panel {
        all.extend(faces(PanelizeFinding::TooLarge, &|f| {
            (!fits(m[f].extent.map(|x| x * size), sheet.0)).then(|| m[f].diameter * size)
        }));
    }
    all.extend(far_nodes(model, solved, params.max_reach));
    all.extend(lost_creases(model, solved));
    all.extend(lost_planes(model, solved));
    all.extend(lost_points(model, solved));
    all.extend(unpaired(model, solved));
    all.extend(solved.families.iter().flat_map(|families| families.missed.clone()));
    all.extend(full_nodes(model, solved));
    all.extend(uneven_rings(model, solved));
    all
}

/// Whether a box fits a sheet, either way around; both with the shorter side first.
/// The panel by its longer side first, the sheet by its shorter.
fn fits(panel: [f64; 2], sheet: [f64; 2]) -> bool {
    panel[0] <= sheet[1] && panel[1] <= sheet[0]
}

/// Edges of creases to be kept that no edges of panels follow.
fn lost_creases(model: &Model, solved: &Solved) -> Vec<Place> {
    let folds = model.folds.iter().zip(&solved.off_folds);
    let lost = folds.filter(|(_, (off, _))| model.keeps_creases && *off > CREASE_OFF);
    let mut found: Vec<Place> = lost
        .map(|(fold, &(off, panel))| Place {
            finding: PanelizeFinding::CreaseLost,
            element: panel,
            measured: off * model.size,
            place: fold.places[0].midpoint(fold.places[1]),
        })
        .collect();
    found.sort_by(|a, b| b.measured.total_cmp(&a.measured).then(a.element.cmp(&b.element)));
    found
}

/// Vertices at which more than three panels meet: there more than three creases do.
fn full_nodes(model: &Model, solved: &Solved) -> Vec<Place> {
    let fans = solved.state.fans.iter().enumerate();
    fans.filter(|(_, fan)| fan.len() > 3)
        .map(|(v, fan)| Place {
            finding: PanelizeFinding::FullNode,
            element: v,
            measured: fan.len() as f64,
            place: model.place(solved.state.panels.points[v]),
        })
        .collect()
}

/// Rings with panels of more kinds than they should have: one, or two where the ring beside has half
/// as many panels.
fn uneven_rings(model: &Model, solved: &Solved) -> Vec<Place> {
    let count = solved.rings.iter().max().map_or(0, |last| last + 1);
    let mut panels = vec![Vec::new(); count];
    solved.rings.iter().enumerate().for_each(|(f, &ring)| panels[ring].push(f));
    let halves = |ring: usize| {
        let beside = [ring.checked_sub(1), Some(ring + 1)];
        let mut beside = beside.into_iter().flatten().filter_map(|r| panels.get(r));
        beside.any(|other| 2 * other.len() == panels[ring].len())
    };
    let mut found = Vec::new();
    for (ring, own) in panels.iter().enumerate() {
        let mut kinds: Vec<usize> = own.iter().map(|&f| solved.kinds.of_panel[f]).collect();
        kinds.sort_unstable();
        kinds.dedup();
        if kinds.len() > if halves(ring) { 2 } else { 1 } {
            let (finding, element) = (PanelizeFinding::UnevenRing, own[0]);
            let place = model.place(solved.state.panels.centre(element));
            found.push(Place { finding, element, measured: kinds.len() as f64, place });
        }
    }
    found
}

pub(super) fn far_nodes(model: &Model, solved: &Solved, most: f64) -> Vec<Place> {
    // On a crease plates cannot but reach as far as the mitre of two of them.
    let needed = |v: usize| {
        let state = &solved.state;
        if !state.panels.kinds[v].is_on_crease() {
            return 1.0;
        }
        let normals: Vec<DVec3> = state.fans[v].iter().map(|&f| state.planes[f].normal).collect();
        let pairs = (0..normals.len()).flat_map(|i| (0..i).map(move |j| [i, j]));
        pairs.map(|[i, j]| 2.0 / (normals[i] + normals[j]).length()).fold(1.0, f64::max)
    };
    let far = reaches(solved).filter(|&(v, reach)| reach > most * needed(v));
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

/// The panels that are farthest off the surface.
fn worst(deviations: &[f64], size: f64) -> Vec<(usize, f64)> {
    let mut order: Vec<usize> = (0..deviations.len()).collect();
    order.sort_by(|&f, &g| deviations[g].total_cmp(&deviations[f]).then(f.cmp(&g)));
    order.truncate(WORST);
    order.into_iter().map(|f| (f, deviations[f] * size)).collect()
}

/// The reach of every inner node.
fn reaches(solved: &Solved) -> impl Iterator<Item = (usize, f64)> + '_ {
    let state = &solved.state;
    let inner = (0..state.panels.points.len()).filter(|&v| state.fans[v].len() == 3);
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
