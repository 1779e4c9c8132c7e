//! What a caller of an operator can mend.

use super::roll_error::RollError;
use crate::code::codes;
use crate::geom::hull::{HalfSpaceError, HullError};
use crate::mesh::{BuildError, EdgeId, FaceId, FileFault, VertexId};
use crate::panelize::PanelizeError;
use crate::select::SelectError;

/// Why an operator refused; no mesh was made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OpError {
    /// The selection could not be read on this mesh.
    #[error(transparent)]
    Select(#[from] SelectError),
    /// Edges that cannot be rolled as asked.
    #[error(transparent)]
    Roll(#[from] RollError),
    /// The offset is not in (0, 2].
    #[error(
        "the offset is {offset}, but it must be above 0 (the element itself) and at most 2 (1 is \
        the far ends of the edges)"
    )]
    OffsetOutOfRange {
        /// What was given.
        offset: f64,
    },
    /// The bend is not in [−1, 1].
    #[error(
        "the bend is {bend}, but it must lie between -1 (the plane of one face) and 1 (the plane \
        of the other)"
    )]
    BendOutOfRange {
        /// What was given.
        bend: f64,
    },
    /// No round, or too many.
    #[error("{repeat} rounds were asked for, but the number must lie between 1 and {limit}")]
    RepeatOutOfRange {
        /// What was given.
        repeat: u32,
        /// The most that is allowed.
        limit: u32,
    },
    /// The normal of a slicing plane is zero or not finite.
    #[error(
        "the normal ({0}, {1}, {2}) has no direction; give three numbers that are not all zero"
    )]
    NoDirection(f64, f64, f64),
    /// A point is not finite.
    #[error("the point ({0}, {1}, {2}) is not finite")]
    BadPoint(f64, f64, f64),
    /// The normals around a vertex cancel, or its faces have no area.
    #[error(
        "no slicing plane at vertex {0}: its face normals cancel or its faces have no area; leave \
        it out of the selection"
    )]
    NoPlaneAtVertex(VertexId),
    /// The normals of an edge's faces cancel, or nothing leaves its ends.
    #[error(
        "no slicing plane at edge {0}: its face normals cancel or no other edge leaves its ends; \
        leave it out of the selection"
    )]
    NoPlaneAtEdge(EdgeId),
    /// A face has no area, or no edge leaves it.
    #[error(
        "no slicing plane at face {0}: it has no area or no edge leaves it; leave it out of the \
        selection"
    )]
    NoPlaneAtFace(FaceId),
    /// A step has one mesh as its result, but both parts of a slice were asked for.
    #[error(
        "keeping both parts gives two models, but only one can go on from here; keep `reverse` or \
        `normal`"
    )]
    TwoParts,
    /// The cuts take everything away.
    #[error("nothing is left: the {cut} of {cuts} cuts removes the rest of the model; use a \
    smaller offset, fewer elements or a local scope", cut = ordinal(*cut))]
    NothingLeft {
        /// Which cut it was, counted from 1.
        cut: usize,
        /// How many there were to be.
        cuts: usize,
    },
    /// Cuts that were to be disjoint meet others however small they are.
    #[error(
        "the cuts of elements {} cannot be kept apart: they share vertices, or their planes run \
        through other parts of the model; choose elements that do not touch each other, or a local scope, or do not ask for disjoint cuts",
        first_few(elements)
    )]
    NotDisjoint {
        /// The elements, by their number in the mesh of their round.
        elements: Vec<usize>,
    },
    /// Faces cannot be moved by less than rounding.
    #[error(
        "the depth is {depth} mm, but it must be above {least:.3e} mm, the rounding at this size \
        and place"
    )]
    DepthTooSmall {
        /// What was given, in mm.
        depth: f64,
        /// What it must exceed, in mm.
        least: f64,
    },
    /// Too many of something, or none.
    #[error("there can be 1 to {limit} {what}, not {count}")]
    CountOutOfRange {
        /// What is counted.
        what: &'static str,
        /// What was given.
        count: u32,
        /// The most that is allowed.
        limit: u32,
    },
    /// The concavity is not in (0, 1].
    #[error(
        "the concavity is {concavity}, but it must be above 0 (convex parts only) and at most 1 \
        (one part)"
    )]
    ConcavityOutOfRange {
        /// What was given.
        concavity: f64,
    },
    /// Two parameters that do not go together.
    #[error("{first} and {second} do not go together; leave one of them out")]
    Exclude {
        /// One of them.
        first: &'static str,
        /// The other.
        second: &'static str,
    },
    /// A parameter that means something only with another.
    #[error("{what} means something only together with {needed}; set {needed} or leave {what} out")]
    Requires {
        /// The parameter.
        what: &'static str,
        /// What it needs.
        needed: &'static str,
    },
    /// Points span no volume.
    #[error("{part}: {reason}")]
    NoHull {
        /// The part of the model.
        part: String,
        /// Why it has no hull.
        reason: HullError,
    },
    /// Half-spaces bound no solid.
    #[error("{part}: {reason}")]
    HalfSpaces {
        /// The part of the model.
        part: String,
        /// Why not.
        reason: HalfSpaceError,
    },
    /// A hull has more elements than a mesh can hold.
    #[error("the hull cannot be built: {0}")]
    Build(#[from] BuildError),
    /// A weight is not in its range.
    #[error("the {what} is {weight}, but it must be {least} and finite")]
    WeightOutOfRange {
        /// Which weight.
        what: &'static str,
        /// What was given.
        weight: f64,
        /// The range, in words.
        least: &'static str,
    },
    /// A share is not in its range.
    #[error("the {what} is {share}, but it must be above 0 and below {limit}")]
    ShareOutOfRange {
        /// What it is the share of.
        what: &'static str,
        /// What was given.
        share: f64,
        /// The end of the range, not part of it.
        limit: f64,
    },
    /// A round would make more faces than a mesh should hold.
    #[error("round {round} would make about {faces} faces, more than {limit}; do fewer rounds")]
    TooManyFaces {
        /// The round, counted from 1.
        round: u32,
        /// How many there would be.
        faces: usize,
        /// How many there may be.
        limit: usize,
    },
    /// Faces that are not planar and have no corner that may move.
    #[error(
        "faces {} are not planar, but all of their corners are fixed; free some of them, or fix \
        fewer rims",
        first_few(faces)
    )]
    AllCornersFixed {
        /// The faces, by number.
        faces: Vec<usize>,
    },
    /// A face group that no face belongs to.
    #[error("there is no face group `{group}`; `kerfold info` lists the groups")]
    NoSuchGroup {
        /// What was given.
        group: String,
    },
    /// A face that has no normal.
    #[error("face {0} has no area, so it has no normal; remove it or weld its corners")]
    NoArea(FaceId),
    /// A shell of which every face would be opened.
    #[error("every face would be opened, so nothing would be left; leave at least one face out")]
    AllOpened,
    /// An angle is not in its range.
    #[error(
        "the {what} angle is {degrees} degrees, but it must be at least {least} and below {limit}"
    )]
    AngleOutOfRange {
        /// Which angle.
        what: &'static str,
        /// What was given.
        degrees: f64,
        /// The least that is allowed.
        least: f64,
        /// The end of the range, not part of it.
        limit: f64,
    },
    /// The operator needs a closed mesh.
    #[error(
        "{what} needs a closed mesh, but this one has {holes} holes; close them first, or make a \
        shell of it with `rind`"
    )]
    NotClosed {
        /// What was to be made.
        what: &'static str,
        /// How many holes there are.
        holes: usize,
    },
    /// The exact Menger sponge of something else.
    #[error(
        "the exact sponge is that of a cube, box or parallelepiped with 6 faces and 8 corners; \
        leave `exact` out for other solids"
    )]
    NotABox,
    /// A face or corner that is not there.
    #[error("there is no {what} {id}; `kerfold info` shows how many there are")]
    NoSuchElement {
        /// What was looked for.
        what: &'static str,
        /// Its number.
        id: usize,
    },
    /// Two faces between which no handle can be.
    #[error("no handle from face {from} to face {to}: {reason}")]
    NoHandle {
        /// The first face.
        from: u32,
        /// The second face.
        to: u32,
        /// Why not, and what to do.
        reason: &'static str,
    },
    /// The result would not fit the memory of the machine, or no mesh could number it.
    #[error(
        "{asked} {what} would make about {edges:.3e} edges, which take {} of memory, and {} may be \
        taken here; {}",
        memory_size(*bytes), memory_size(*budget), most_that_fit(*most, what)
    )]
    DoesNotFit {
        /// What makes the result large: rounds, segments.
        what: &'static str,
        /// How many were asked for.
        asked: u32,
        /// The most that fit.
        most: u32,
        /// How many edges there would be.
        edges: f64,
        /// What they would take, in bytes.
        bytes: f64,
        /// What they may take, in bytes.
        budget: f64,
    },
    /// The result is no mesh of polygons that a file could hold.
    #[error("the result is no mesh of simple polygons: {fault}; {advice}")]
    NotSimple {
        /// What is wrong with it.
        fault: FileFault,
        /// What to do.
        advice: &'static str,
    },
    /// A local cut takes away what is around a cavity, but does not reach the cavity itself.
    #[error(
        "the cuts run into a cavity that they do not reach, at its vertex {vertex}; let them reach \
        everything (a global scope), or cut less deep"
    )]
    CavityLaidOpen {
        /// A vertex of the cavity, of the mesh before the cuts.
        vertex: VertexId,
    },
    /// A tolerance that no distance can keep.
    #[error("the tolerance is {tolerance} mm, but it must be 0 or more and finite")]
    ToleranceOutOfRange {
        /// What was given, in mm.
        tolerance: f64,
    },
    /// Too few faces for any solid.
    #[error("{faces} faces were asked for, but a solid has at least 4")]
    TooFewFaces {
        /// What was asked for.
        faces: usize,
    },
    /// No smaller surface keeps what was asked for.
    #[error(
        "no smaller surface was found in {tries} tries: fewer faces would tear it or move it too \
        far; ask for more faces or allow more deviation"
    )]
    NotSimplified {
        /// How often it was tried.
        tries: usize,
    },
    /// Holes to close have no width.
    #[error("holes of {mm} mm cannot be closed; --close-holes takes a length above 0 mm")]
    HoleOutOfRange {
        /// What was given, in mm.
        mm: f64,
    },
    /// [`crate::panelize`] refused.
    #[error(transparent)]
    Panelize(#[from] PanelizeError),
    /// The user asked to stop.
    #[error("stopped before the end; nothing was written")]
    Cancelled,
}

codes!(error OpError {
    OffsetOutOfRange = 301,
    BendOutOfRange = 302,
    RepeatOutOfRange = 303,
    NoDirection = 304,
    BadPoint = 305,
    NoPlaneAtVertex = 306,
    NoPlaneAtEdge = 307,
    NoPlaneAtFace = 308,
    TwoParts = 309,
    NothingLeft = 310,
    NotDisjoint = 311,
    DepthTooSmall = 312,
    CountOutOfRange = 313,
    ConcavityOutOfRange = 314,
    Exclude = 315,
    Requires = 316,
    WeightOutOfRange = 317,
    ShareOutOfRange = 318,
    TooManyFaces = 319,
    AllCornersFixed = 320,
    NoSuchGroup = 321,
    NoArea = 322,
    AllOpened = 323,
    AngleOutOfRange = 324,
    NotClosed = 325,
    NotABox = 326,
    NoSuchElement = 327,
    NoHandle = 328,
    Cancelled = 329,
    DoesNotFit = 330,
    NotSimple = 331,
    CavityLaidOpen = 332,
    ToleranceOutOfRange = 350,
    HoleOutOfRange = 351,
    TooFewFaces = 352,
    NotSimplified = 353,
} through {
    Select.0,
    Roll.0,
    NoHull.reason,
    HalfSpaces.reason,
    Build.0,
    Panelize.0,
});

fn first_few(elements: &[usize]) -> String {
    let shown: Vec<String> = elements.iter().take(8).map(usize::to_string).collect();
    let more = elements.len().saturating_sub(shown.len());
    if more == 0 { shown.join(", ") } else { format!("{} and {more} more", shown.join(", ")) }
}

/// An amount of memory in words.
fn memory_size(bytes: f64) -> String {
    if bytes.is_infinite() {
        "more than can be counted".to_owned()
    } else if bytes < 1e9 {
        format!("{:.0} MB", bytes / 1e6)
    } else {
        format!("{:.1} GB", bytes / 1e9)
    }
}

fn most_that_fit(most: u32, what: &str) -> String {
    match most {
        0 => "not even one fits; make the model simpler".to_owned(),
        most => format!("at most {most} {what} fit"),
    }
}

fn ordinal(n: usize) -> String {
    let ending = match (n % 10, n % 100) {
        (1, 11) | (2, 12) | (3, 13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{n}{ending}")
}
