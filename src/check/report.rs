//! The report of a check: what was measured, what was found, and the verdict.

use std::collections::BTreeMap;
use std::fmt;

use glam::DVec3;

use super::{Breach, Limits, Profile, Requirement, Unit};
use crate::code::codes;
use crate::measure::{Convexity, CrossingPair, Planarity};
use crate::mend::{FLAT_MM, flat_patches};
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::units::counted;

/// More pairs of crossing faces than this are not looked for.
pub const MOST_CROSSINGS: usize = 1000;

/// Everything that a check measured and found.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The profile that was asked for.
    pub profile: Profile,
    /// The limits that were applied: the profile's with the user's in their place.
    pub limits: Limits,
    /// What was required, sorted, each once.
    pub require: Vec<Requirement>,
    /// Counts and size.
    pub model: ModelCounts,
    /// Each face with its planarity, ascending.
    pub faces: Vec<FaceReport>,
    /// The largest of each planarity measure; `percent` is `None` without quads.
    pub worst: Planarity,
    /// Each profile, and whether all faces keep its own limits.
    pub profiles: [(Profile, bool); 4],
    /// The largest distance of a corner from the plane that its face carries, in mm; `None` when no
    /// face carries one.
    pub carried_mm: Option<f64>,
    /// Valences.
    pub valence: ValenceReport,
    /// What stands between the model and convexity.
    pub convexity: Convexity,
    /// The end vertices of the concave edges, in the order of `convexity.concave_edges`.
    pub concave_ends: Vec<[VertexId; 2]>,
    /// The vertices with more than three edges, ascending, and whether plates meet there.
    pub conical: Vec<ConicalNode>,
    /// Pairs of faces that go through each other or cover each other, ascending; at most
    /// [`MOST_CROSSINGS`] of them.
    pub crossings: Vec<CrossingPair>,
    /// Faces that lie flat beside each other, as triangles of a CAD program do.
    pub flat: FlatNeighbours,
    /// What breaks a limit or a requirement, in the order of [`CheckKind`] and ascending by id.
    pub findings: Vec<CheckFinding>,
}

/// How many faces lie flat beside each other, within [`crate::mend::FLAT_MM`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct FlatNeighbours {
    /// Faces with a neighbour in their plane.
    pub faces: usize,
    /// The regions that they make.
    pub regions: usize,
}

impl FlatNeighbours {
    /// Those of a mesh.
    pub fn of(mesh: &Mesh) -> Self {
        let flat = flat_patches(mesh, FLAT_MM);
        Self { faces: flat.faces_to_merge(), regions: flat.regions_to_merge() }
    }

    /// What to do about them, in one line; `None` when there are none.
    pub fn proposal(&self) -> Option<String> {
        (self.regions > 0).then(|| {
            format!(
                "{} flat beside others and would be {}: kerfold merge IN -o OUT, or --merge-flat \
                when reading",
                counted(self.faces, "face lies", "faces lie"),
                counted(self.regions, "polygon", "polygons")
            )
        })
    }
}

/// Counts and size of the model.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ModelCounts {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces, holes not counted.
    pub faces: usize,
    /// Number of connected parts.
    pub components: usize,
    /// Number of handles of all parts.
    pub genus: usize,
    /// Number of rims.
    pub rims: usize,
    /// Extent along the three axes.
    pub size_mm: DVec3,
}

/// One face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FaceReport {
    /// The face.
    pub face: FaceId,
    /// Number of sides.
    pub sides: usize,
    /// How far it is from planar.
    pub planarity: Planarity,
    /// The limit that it breaks worst, if it does.
    pub breach: Option<Breach>,
}

/// How many vertices have how many edges.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ValenceReport {
    /// Number of vertices by valence.
    pub histogram: BTreeMap<usize, usize>,
    /// The vertices whose valence is not three, ascending.
    pub other: Vec<VertexId>,
}

/// A vertex with more than three edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConicalNode {
    /// The vertex.
    pub vertex: VertexId,
    /// Number of its edges.
    pub valence: usize,
    /// By how many mm per mm of thickness plates miss each other there
    /// ([`crate::measure::conical_residual`]).
    pub residual: Option<f64>,
}

/// What was checked. Findings are sorted in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[non_exhaustive]
pub enum CheckKind {
    /// A face without area, or with fewer than three sides.
    DegenerateFace,
    /// An edge without length.
    ZeroLengthEdge,
    /// A face whose outline crosses or touches itself.
    SelfIntersection,
    /// A face that is not planar within the profile.
    Planarity,
    /// A closed model of which the faces look inwards.
    InsideOut,
    /// A vertex on an edge that it does not belong to.
    Junction,
    /// A face that is there twice.
    Doubled,
    /// A corner sharper than allowed.
    SharpCorner,
    /// An edge shorter than allowed.
    ShortEdge,
    /// An edge that needs a steeper mitre than allowed.
    Mitre,
    /// The file names another unit than the one that it was read with.
    OtherUnit,
    /// A vertex without exactly three edges.
    Valence,
    /// A rim.
    Closed,
    /// Something that is not convex.
    Convex,
    /// Two vertices at one place.
    Manifold,
    /// More than one connected part.
    OneComponent,
    /// Faces that go through each other.
    Simple,
}

codes!(finding CheckKind {
    DegenerateFace = 101,
    ZeroLengthEdge = 102,
    SelfIntersection = 103,
    Planarity = 104,
    Valence = 105,
    Closed = 106,
    Convex = 107,
    Manifold = 108,
    OneComponent = 109,
    Simple = 110,
    InsideOut = 111,
    Junction = 112,
    Doubled = 113,
    SharpCorner = 114,
    ShortEdge = 115,
    Mitre = 116,
    OtherUnit = 117,
});

/// What a finding is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Element {
    /// A face; the id is its number in the file.
    Face,
    /// An edge; the id is its number in the mesh, the message names its vertices.
    Edge,
    /// A vertex; the id is its number in the file.
    Vertex,
    /// A rim; rims are numbered from 0, the message names vertices on it.
    Rim,
    /// The whole model; the id is 0.
    Model,
}

/// Something that breaks a limit or a requirement.
#[derive(Debug, Clone, PartialEq)]
pub struct CheckFinding {
    /// What was checked.
    pub check: CheckKind,
    /// What kind of element it is about.
    pub element: Element,
    /// Which one.
    pub id: usize,
    /// What was measured.
    pub measured: f64,
    /// What is allowed.
    pub limit: f64,
    /// The unit of both.
    pub unit: Unit,
    /// The same in words.
    pub message: String,
}

/// Pass or fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// No finding.
    Pass,
    /// At least one finding.
    Fail,
}

impl Report {
    /// Whether there is a finding.
    pub fn has_findings(&self) -> bool {
        !self.findings.is_empty()
    }

    /// Pass without a finding, else fail.
    pub fn verdict(&self) -> Verdict {
        if self.has_findings() { Verdict::Fail } else { Verdict::Pass }
    }

    /// Whether the mesh bounds a convex solid.
    pub fn is_convex(&self) -> bool {
        self.convexity.is_convex()
    }

    /// The `count` faces that use most of their limits, worst first; equal ones by mm, then by id.
    pub fn worst_faces(&self, count: usize) -> Vec<&FaceReport> {
        let mut ranked: Vec<(f64, &FaceReport)> =
            self.faces.iter().map(|f| (self.limits.share(&f.planarity), f)).collect();
        ranked.sort_by(|(a, f), (b, g)| {
            b.total_cmp(a).then(g.planarity.mm.total_cmp(&f.planarity.mm)).then(f.face.cmp(&g.face))
        });
        ranked.into_iter().take(count).map(|(_, f)| f).collect()
    }
}

impl CheckKind {
    /// The name as files show it.
    pub fn name(self) -> &'static str {
        match self {
            Self::DegenerateFace => "degenerate-face",
            Self::ZeroLengthEdge => "zero-length-edge",
            Self::SelfIntersection => "self-intersection",
            Self::Planarity => "planarity",
            Self::Valence => "valence",
            Self::Closed => "closed",
            Self::Convex => "convex",
            Self::Manifold => "manifold",
            Self::OneComponent => "one-component",
            Self::Simple => "simple",
            Self::InsideOut => "inside-out",
            Self::Junction => "t-junction",
            Self::Doubled => "doubled-face",
            Self::SharpCorner => "sharp-corner",
            Self::ShortEdge => "short-edge",
            Self::Mitre => "mitre",
            Self::OtherUnit => "other-unit",
        }
    }
}

impl Element {
    /// The name as files show it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Face => "face",
            Self::Edge => "edge",
            Self::Vertex => "vertex",
            Self::Rim => "rim",
            Self::Model => "model",
        }
    }
}

impl Verdict {
    /// The name as files show it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
        }
    }
}

impl fmt::Display for CheckKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for Element {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
