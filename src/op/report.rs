//! What a chain of cuts made and removed.

use super::OpError;
use super::cut::{Cutter, Lineage};
use super::rolled::{RollLimit, RolledEdge};
use super::simple::{drop_flat, keep_cut_simple};
use crate::code::Code;
use crate::measure::{CrossingKind, CrossingPair, crossings_while};
use crate::mesh::{EdgeId, FaceId, Mesh, Renumbering, VertexId, VertexMap};
use crate::progress::Progress;
use crate::select::NewElements;
use crate::units::counted;

/// The first of a list as a note names them; dots stand for the rest.
pub(super) fn first_few<T: ToString>(list: &[T], most: usize) -> String {
    let shown: Vec<String> = list.iter().take(most).map(T::to_string).collect();
    shown.join(", ") + if list.len() > most { ", …" } else { "" }
}

/// An offset that was made smaller so that cuts are disjoint.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShrunkOffset {
    /// The element, by its number in the mesh of its round.
    pub element: usize,
    /// The offset that was used.
    pub offset: f64,
}

/// As many pairs of faces as a report may hold; more say nothing new.
const MOST_PAIRS: usize = 1000;

/// The pairs of faces of a result that go through each other, as many as a report may hold.
///
/// # Errors
/// [`OpError::Cancelled`].
pub(super) fn crossing_pairs(
    mesh: &Mesh,
    progress: &dyn Progress,
) -> Result<Vec<CrossingPair>, OpError> {
    progress.report("looking for crossings", 0, 1);
    crossings_while(mesh, MOST_PAIRS, &|| !progress.is_cancelled()).ok_or(OpError::Cancelled)
}

/// A note on faces that go through each other; `None` without any.
pub(super) fn crossing_note(pairs: &[CrossingPair], code: Code) -> Option<String> {
    let named: Vec<String> = pairs
        .iter()
        .map(|pair| {
            let word = match pair.kind {
                CrossingKind::Through => "with",
                CrossingKind::Overlap => "on",
            };
            format!("{} {word} {}", pair.first, pair.second)
        })
        .collect();
    let many = if pairs.len() < MOST_PAIRS { "" } else { "at least " };
    (!pairs.is_empty()).then(|| {
        format!(
            "faces of the result go through each other or cover each other, {many}{} pairs: {} \
            ({code})",
            pairs.len(),
            first_few(&named, 8)
        )
    })
}

/// The elements that an operator was told to work on, by their numbers in the mesh before.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct ChosenElements {
    /// Vertices that are cut off.
    pub vertices: Vec<VertexId>,
    /// Edges that are cut off: the folds, should it become a D-form.
    pub edges: Vec<EdgeId>,
    /// Faces that are cut off, opened or joined.
    pub faces: Vec<FaceId>,
}

impl ChosenElements {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.vertices.len() + self.edges.len() + self.faces.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// What a chain of cuts did. Ids of things that were made are those of the resulting mesh.
#[derive(Debug, Clone, Default)]
pub struct CutReport {
    /// How many planes were applied, over all rounds.
    pub cuts: usize,
    /// How many of them met nothing: the plane missed, or earlier cuts had removed the element.
    pub missed: usize,
    /// How many holes of sections could not be joined to their caps, because the mesh touches or
    /// crosses itself there. Each has a face of its own, a lid that lies on the cap and looks the
    /// other way: the mesh is sound and its volume right, but the lid is no panel.
    pub lids: usize,
    /// The elements whose cut was not disjoint from the others, by their number in the mesh of
    /// their round: it removed a vertex that was not its own, or something that another cut had
    /// made.
    pub overcut: Vec<usize>,
    /// The elements whose offset was made smaller so that the cuts are disjoint.
    pub shrunk: Vec<ShrunkOffset>,
    /// How many cavities went with the shell that local cuts took from around them.
    pub cavities_gone: usize,
    /// What was made, for the selections `made` and `strip` of the next step.
    pub made: NewElements,
    /// For truncations, which faces of the mesh before them those of the result continue.
    pub origins: Origins,
    /// Vertices of the result where other than three edges meet.
    pub not_three_valent: Vec<VertexId>,
    /// How many connected parts the result has.
    pub components: usize,
    /// Whether an offset above 1 was used, beyond the far ends of the edges.
    pub is_beyond_far_ends: bool,
    /// The elements that were chosen to be cut off; none for a plane.
    pub chosen: ChosenElements,
    /// The edges that were rolled, ascending.
    pub rolled: Vec<RolledEdge>,
    /// What limits their radius, where the largest was asked for.
    pub roll_limit: Option<RollLimit>,
}

impl CutReport {
    /// The same, of a cut of these edges.
    pub(super) fn of_edges(self, edges: Vec<EdgeId>) -> Self {
        Self { chosen: ChosenElements { edges, ..ChosenElements::default() }, ..self }
    }

    /// What the user should know, in words; `element` is what was cut: vertex, edge, face or plane.
    pub fn notes(&self, element: &str) -> Vec<String> {
        let mut notes = roll_notes(&self.rolled, self.roll_limit.as_ref());
        if self.is_beyond_far_ends {
            notes.push(
                "the offset is above 1: the planes lie beyond the far ends of the edges".to_owned(),
            );
        }
        if self.lids > 0 {
            notes.push(format!(
                "{} holes of sections could not be joined to their caps since the model touches or \
                crosses itself there: each is closed by a face that lies on the cap; repair the model, or cut without caps",
                self.lids
            ));
        }
        if self.missed > 0 {
            notes.push(format!("{} of {} cuts met nothing", self.missed, self.cuts));
        }
        if !self.overcut.is_empty() {
            notes.push(format!(
                "{} cuts met each other ({element} {}): the caps are not disjoint; a smaller \
                offset keeps them apart",
                self.overcut.len(),
                first_few(&self.overcut, 12)
            ));
        }
        if let Some(least) = self.shrunk.iter().map(|s| s.offset).min_by(f64::total_cmp) {
            let count = self.shrunk.len();
            notes.push(format!(
                "{count} offsets were made smaller to keep the cuts apart, the least to {least:.4}"
            ));
        }
        if !self.not_three_valent.is_empty() {
            notes.push(format!(
                "{} vertices have other than three edges",
                self.not_three_valent.len()
            ));
        }
        if self.cavities_gone > 0 {
            notes.push(format!("{} cavities went with the shell around them", self.cavities_gone));
        }
        if self.components > 1 {
            notes.push(format!("the model now has {} parts", self.components));
        }
        notes
    }
}

/// What was rolled, in words.
fn roll_notes(rolled: &[RolledEdge], limit: Option<&RollLimit>) -> Vec<String> {
    if rolled.is_empty() {
        return Vec::new();
    }
    let range = |values: &mut dyn Iterator<Item = f64>| {
        let (least, most) =
            values.fold((f64::INFINITY, 0.0_f64), |(least, most), v| (least.min(v), most.max(v)));
        let [least, most] = [least, most].map(|v| format!("{v:.2}"));
        if least == most { least } else { format!("{least} to {most}") }
    };
    let strips = rolled.iter().map(|r| r.strips);
    let [fewest, most] = [strips.clone().min(), strips.max()].map(Option::unwrap_or_default);
    let strips = if fewest == most { most.to_string() } else { format!("{fewest} to {most}") };
    let mut notes = vec![format!(
        "{} rolled with a radius of {} mm, {strips} strips each: {} mm wide and {}° apart; they \
        touch the faces {} mm from the edge",
        counted(rolled.len(), "edge", "edges"),
        range(&mut rolled.iter().flat_map(|r| r.radii)),
        range(&mut rolled.iter().map(|r| r.width)),
        range(&mut rolled.iter().map(|r| r.fold_deg)),
        range(&mut rolled.iter().flat_map(|r| r.touch)),
    )];
    notes.extend(limit.map(|limit| {
        let edges: Vec<String> = limit.edges.iter().map(ToString::to_string).collect();
        let (rolls, take) = match edges.len() {
            1 => ("roll of edge", "takes"),
            _ => ("rolls of edges", "take"),
        };
        format!(
            "the radius {:.2} mm is the largest: of {} the {rolls} {} {take} {:.1} %",
            limit.radius,
            limit.place,
            edges.join(" and "),
            100.0 * limit.share
        )
    }));
    notes
}

/// For each face of a mesh the one that it continues of the mesh before all rounds: what is left of
/// it, or a cap along one of its edges.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Origins(Vec<Option<FaceId>>);

impl Origins {
    /// Every face continues itself.
    pub(super) fn new(mesh: &Mesh) -> Self {
        Self((0..mesh.face_slots()).map(|i| Some(FaceId::new(i))).collect())
    }

    /// The face that a face continues: of the cap of an edge one of the two beside the edge,
    /// nothing for the cap of anything else.
    pub fn of(&self, f: FaceId) -> Option<FaceId> {
        self.0.get(f.index()).copied().flatten()
    }

    /// After a round of cuts.
    pub(super) fn after(&self, cutter: &Cutter, marks: &RoundMarks) -> Self {
        let origin = |i: usize| {
            let lineage = cutter.lineage_of(FaceId::new(i));
            let strip = marks.strips.binary_search_by_key(&lineage, |s| s.cap);
            let beside = strip.map_or(lineage, |strip| marks.strips[strip].origin);
            cutter.face_before(beside).and_then(|f| self.of(f))
        };
        Self((0..cutter.mesh().face_slots()).map(origin).collect())
    }

    /// After the gaps in the mesh were closed.
    fn renumbered(&self, map: &Renumbering, faces: usize) -> Self {
        if self.0.is_empty() {
            return Self::default();
        }
        let mut renumbered = vec![None; faces];
        for (i, &origin) in self.0.iter().enumerate() {
            if let Some(f) = map.face(FaceId::new(i)) {
                renumbered[f.index()] = origin;
            }
        }
        Self(renumbered)
    }
}

/// The caps and strips of one round, by lineage.
#[derive(Default)]
pub(super) struct RoundMarks {
    /// The caps of the round's cuts.
    pub caps: Vec<Lineage>,
    /// For each cut of an edge its strip.
    pub strips: Vec<StripMark>,
}

/// The cap of an edge's cut.
pub(super) struct StripMark {
    pub cap: Lineage,
    /// The two faces along which it runs.
    pub beside: [Lineage; 2],
    /// A face of the mesh before the round that it continues.
    pub origin: Lineage,
}

impl RoundMarks {
    /// What the round made, in the ids that the cutter's mesh has now.
    pub(super) fn collect(&self, cutter: &Cutter) -> NewElements {
        let mesh = cutter.mesh();
        let is_cap = |f: FaceId| self.caps.binary_search(&cutter.lineage_of(f)).is_ok();
        let faces: Vec<FaceId> = mesh.faces().filter(|&f| is_cap(f)).collect();
        let mut vertices: Vec<VertexId> =
            faces.iter().flat_map(|&f| mesh.face_vertices(f)).collect();
        vertices.sort_unstable();
        vertices.dedup();
        let mut edges: Vec<_> =
            faces.iter().flat_map(|&f| mesh.face_half_edges(f)).map(|h| h.edge()).collect();
        edges.sort_unstable();
        edges.dedup();
        let strip = edges
            .iter()
            .copied()
            .filter(|&e| self.runs_along_strip(cutter, mesh.edge_faces(e)))
            .collect();
        NewElements { vertices, edges, strip, faces }
    }

    fn runs_along_strip(&self, cutter: &Cutter, faces: [FaceId; 2]) -> bool {
        let [a, b] = faces.map(|f| cutter.lineage_of(f));
        let runs = |cap: Lineage, other: Lineage| {
            let i = self.strips.binary_search_by_key(&cap, |s| s.cap);
            i.is_ok_and(|i| self.strips[i].beside.contains(&other))
        };
        runs(a, b) || runs(b, a)
    }
}

/// Closes the gaps in the mesh and fills in what only the result can tell.
///
/// # Errors
/// [`OpError::NotSimple`] for a face that comes twice to a vertex or has no area, and cannot be mended.
pub(super) fn finish(mut mesh: Mesh, mut report: CutReport) -> Result<(Mesh, CutReport), OpError> {
    drop_flat(&mut mesh, &report.made.vertices);
    let map = report.made.compact(&mut mesh);
    report.origins = report.origins.renumbered(&map, mesh.face_slots());
    keep_cut_simple(&mut mesh, &mut report.made)?;
    let edges = edges_at(&mesh);
    report.not_three_valent = mesh.vertices().filter(|&v| edges[v] != 3).collect();
    report.components = mesh.component_count();
    Ok((mesh, report))
}

/// How many edges end at each vertex, a self-loop twice: gone through as they lie in memory, which is
/// faster than to walk around each vertex.
fn edges_at(mesh: &Mesh) -> VertexMap<u32> {
    let mut count = VertexMap::filled(mesh.vertex_slots(), 0);
    mesh.edges().flat_map(|e| mesh.edge_vertices(e)).for_each(|v| count[v] += 1);
    count
}
