//! What a caller of `panelize` can mend, and what it finds wrong with its result.

use std::path::PathBuf;

use glam::DVec3;

use crate::check::short;
use crate::code::codes;

/// Why no panels were made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PanelizeError {
    /// None or several of size, count and sag.
    #[error(
        "{given} of size, count and sag were given, but it takes exactly one: `--size 1.2m`, \
        `--count 400` or `--sag 20mm`"
    )]
    NoSize {
        /// How many were given.
        given: usize,
    },
    /// A number is out of its range.
    #[error("{name} is {value}, but it must lie between {low} and {high}")]
    OutOfRange {
        /// The parameter.
        name: &'static str,
        /// What was given.
        value: f64,
        /// The least that is allowed.
        low: f64,
        /// The most that is allowed.
        high: f64,
    },
    /// The surface would need too many triangles.
    #[error(
        "panels of {size:.1} mm on this surface (about {count} of them) need more than {limit} \
        triangles; take larger panels, or a coarser mesh if the file is finer than a sixth of a \
        panel"
    )]
    TooFine {
        /// The panel size in mm.
        size: f64,
        /// How many panels there would be.
        count: usize,
        /// The most triangles.
        limit: usize,
    },
    /// Panels cannot be laid out.
    #[error(
        "no panels of {size:.1} mm can be laid out around ({:.1}, {:.1}, {:.1}): the surface is \
        narrower than two panels there, or has a hole smaller than a panel; {}, or close the hole",
        place.x, place.y, place.z,
        match fits {
            Some(fits) => {
                let fits = short(*fits);
                format!("panels of {fits} mm can be laid out (--size {fits}mm)")
            }
            None => "take much smaller panels".to_owned(),
        }
    )]
    TooNarrow {
        /// The panel size in mm.
        size: f64,
        /// A smaller size that can be laid out, if one was found.
        fits: Option<f64>,
        /// Where, in mm.
        place: DVec3,
    },
    /// A linear system could not be solved.
    #[error(
        "the rows of panels cannot be laid out: the surface has triangles without area or numbers \
        beyond range; mend the mesh first"
    )]
    NoField,
    /// The polygons do not make a mesh.
    #[error(
        "the panels around ({:.1}, {:.1}, {:.1}) do not make a surface; take another seed or \
        another size",
        place.x, place.y, place.z
    )]
    NoMesh {
        /// Where, in mm.
        place: DVec3,
    },
    /// A formula cannot be read.
    #[error("`{text}` is no formula: at column {column} there should be {wanted}")]
    Formula {
        /// The formula.
        text: String,
        /// Where, from 1.
        column: usize,
        /// What should be there.
        wanted: String,
    },
    /// A formula has no value somewhere.
    #[error(
        "`{text}` has no finite value at x = {x}, y = {y}; change the formula, or take a \
        rectangle on which it has one"
    )]
    NoHeight {
        /// The formula.
        text: String,
        /// Where, in the unit of the rectangle's width.
        x: f64,
        /// Where, in the same unit.
        y: f64,
    },
    /// The area below a height field cannot be used.
    #[error(
        "the domain of the height cannot be used: {what}; take a rectangle like 22mx18m, or a \
        drawing of closed lines that do not cross, holes inside"
    )]
    BadDomain {
        /// What is wrong with it.
        what: String,
    },
    /// A drawn curve away from the surface.
    #[error(
        "curve {} of `--align` {}, so no row can follow it; draw it on the surface, in the unit of \
        its file, or leave it out",
        curve + 1,
        if distance_mm.is_finite() {
            format!("comes no nearer to the surface than {distance_mm:.1} mm, with panels of {size:.1} mm")
        } else {
            "has no length".to_owned()
        }
    )]
    NoCurveThere {
        /// Which of the curves, from 0.
        curve: usize,
        /// How far it is from the surface, in mm; infinite for a curve without length.
        distance_mm: f64,
        /// The panel size in mm.
        size: f64,
    },
    /// Curves are still the name of a file.
    #[error("the curves of {} have to be read before panels are made along them", path.display())]
    CurvesUnread {
        /// The file.
        path: PathBuf,
    },
    /// A plane for the rim that no rim is near to.
    #[error(
        "plane {} of `--rim` lies near no rim of the surface, so nothing would stay in it; \
        give its place with a unit, or leave it out",
        plane + 1
    )]
    NoRimThere {
        /// Which of the planes, from 0.
        plane: usize,
    },
    /// Two options that exclude each other.
    #[error("{one} and {other} do not go together; leave one of them out")]
    Together {
        /// An option.
        one: &'static str,
        /// Another one.
        other: &'static str,
    },
    /// No surface of revolution: some of it lies beside the curve that turns about the axis.
    #[error(
        "the surface does not turn about an axis along {axis}: ({:.1}, {:.1}, {:.1}) is {off:.1} mm \
        off the curve that turns about it best, and {most:.1} mm are allowed; name its axis, as in \
        `--layout rings:axis=z`, or leave `--layout` out",
        place.x, place.y, place.z
    )]
    NotRound {
        /// The axis.
        axis: &'static str,
        /// By how much, in mm.
        off: f64,
        /// What is allowed, in mm.
        most: f64,
        /// Where, in mm.
        place: DVec3,
    },
    /// No surface of revolution: it does not go all around once.
    #[error(
        "the surface does not turn about an axis along {axis}: seen from the axis at {degrees:.0}° \
        there are {count} curves where there should be one; rings need one surface that goes all \
        around: name its axis, as in `--layout rings:axis=z`, or leave `--layout` out"
    )]
    NoTurn {
        /// The axis.
        axis: &'static str,
        /// At which angle about the axis.
        degrees: f64,
        /// How many curves there are.
        count: usize,
    },
    /// No rings can be planned.
    #[error(
        "no rings of panels of {size} mm fit this surface: it takes at least two rings, and five \
        panels in each; take smaller panels"
    )]
    NoRings {
        /// The panel size in mm.
        size: f64,
    },
    /// A given plane that the surface comes nowhere near to.
    #[error(
        "the plane on line {line} of `--fix` fits the surface nowhere: at best, around ({:.1}, \
        {:.1}, {:.1}), it is {distance_mm:.1} mm off and tilted by {degrees:.1}°, and a panel on it \
        would leave the surface by more than {allowed_mm:.1} mm; mend the plane (n·x = d, in the unit \
        of the surface's file), leave it out, or take larger panels",
        place.x, place.y, place.z
    )]
    NoPlaneThere {
        /// The line of the file.
        line: usize,
        /// How far the plane is from the surface there, in mm.
        distance_mm: f64,
        /// How far it is tilted against the surface there, in degrees.
        degrees: f64,
        /// Where it fits best, in mm.
        place: DVec3,
        /// How far a panel may leave the surface, in mm.
        allowed_mm: f64,
    },
    /// A group of faces that cannot be one panel.
    #[error(
        "group `{name}` cannot stay one panel: {what}; name another one (`--fix group:NAME`), or mend \
        the model"
    )]
    BadGroup {
        /// The group; `*` for all.
        name: String,
        /// What is in the way.
        what: String,
    },
    /// Planes are still the name of a file.
    #[error("the planes of {} have to be read before panels are made on them", path.display())]
    PlanesUnread {
        /// The file.
        path: PathBuf,
    },
    /// Points that stay are still the name of a file.
    #[error("the points of {} have to be read before panels are made at them", path.display())]
    PointsUnread {
        /// The file.
        path: PathBuf,
    },
    /// A point that is to stay is not on the surface.
    #[error(
        "point {} of `--stay`, ({:.1}, {:.1}, {:.1}), is {distance_mm:.1} mm off the surface, and \
        {allowed_mm:.1} mm are allowed; put it on the surface, in the unit of its file, leave it out, or \
        take larger panels",
        point + 1, place.x, place.y, place.z
    )]
    PointOffSurface {
        /// Which of the points, from 0.
        point: usize,
        /// Where it is, in mm.
        place: DVec3,
        /// How far it is from the surface, in mm.
        distance_mm: f64,
        /// How far it may be, in mm.
        allowed_mm: f64,
    },
    /// Two points that are to stay are too near to each other.
    #[error(
        "points {} and {} of `--stay` are {distance_mm:.1} mm apart, and edges of these panels have to be \
        {allowed_mm:.1} mm long at least; leave one of them out, or take smaller panels",
        points[0] + 1, points[1] + 1
    )]
    PointsTooNear {
        /// Which of the points, from 0.
        points: [usize; 2],
        /// How far apart they are, in mm.
        distance_mm: f64,
        /// How far apart they have to be, in mm.
        allowed_mm: f64,
    },
    /// No corner of panels can be put at a point that is to stay.
    #[error(
        "no corner of panels of {size:.1} mm can stand at point {} of `--stay`, ({:.1}, {:.1}, {:.1}): all \
        near it stand at other points, or the rim is in the way; leave it out, put it on the rim, or take \
        smaller panels",
        point + 1, place.x, place.y, place.z
    )]
    NoCornerThere {
        /// Which of the points, from 0.
        point: usize,
        /// Where it is, in mm.
        place: DVec3,
        /// The panel size in mm.
        size: f64,
    },
    /// Two given planes want the same panel.
    #[error(
        "the planes on lines {} and {} of `--fix` ask for one panel: both fit the surface best around \
        ({:.1}, {:.1}, {:.1}), {distance_mm:.1} mm apart; leave one of them out, or take smaller panels",
        lines[0], lines[1], place.x, place.y, place.z
    )]
    PlanesTooNear {
        /// Their lines.
        lines: [usize; 2],
        /// How far apart their places are, in mm.
        distance_mm: f64,
        /// The place of the second, in mm.
        place: DVec3,
    },
    /// Given planes of panels that meet do not.
    #[error(
        "the panels of {} meet around ({:.1}, {:.1}, {:.1}), but their planes {}; change one of the \
        planes, or take a size with which another panel comes between",
        asked.join(" and "), place.x, place.y, place.z,
        match distance_mm {
            Some(off) => format!("do {off:.1} mm from there, and {allowed_mm:.1} mm are allowed"),
            None => "have no point in common".to_owned(),
        }
    )]
    PlanesDoNotMeet {
        /// What asked for the planes.
        asked: Vec<String>,
        /// Where the panels meet, in mm.
        place: DVec3,
        /// How far from there the planes do, in mm; `None` when they do nowhere.
        distance_mm: Option<f64>,
        /// How far they may, in mm.
        allowed_mm: f64,
    },
    /// No mirror image of itself.
    #[error(
        "the surface is not its own image across {axis} = {at:.1} mm, the middle of its bounding box: the \
        image of ({:.1}, {:.1}, {:.1}) is {off:.1} mm off it, and {most:.1} mm are allowed; name another \
        axis, mend the model there, or leave `--symmetry` out",
        place.x, place.y, place.z
    )]
    NotMirrored {
        /// The axis that the plane is square to.
        axis: &'static str,
        /// Where the plane is, in mm.
        at: f64,
        /// By how much, in mm.
        off: f64,
        /// What is allowed, in mm.
        most: f64,
        /// Where, in mm.
        place: DVec3,
    },
    /// Ctrl-C before there was a result.
    #[error("stopped before there were any panels")]
    Cancelled,
}

codes!(error PanelizeError {
    NoSize = 841,
    OutOfRange = 842,
    TooFine = 843,
    TooNarrow = 844,
    NoField = 845,
    NoMesh = 846,
    Cancelled = 847,
    Formula = 848,
    NoHeight = 849,
    NoRimThere = 850,
    Together = 851,
    NotRound = 852,
    NoTurn = 853,
    NoRings = 854,
    BadDomain = 856,
    NoCurveThere = 857,
    CurvesUnread = 858,
    NoPlaneThere = 859,
    BadGroup = 860,
    PlanesUnread = 861,
    PlanesTooNear = 862,
    PlanesDoNotMeet = 863,
    NotMirrored = 864,
    PointsUnread = 865,
    PointOffSurface = 866,
    PointsTooNear = 867,
    NoCornerThere = 868,
});

/// What is wrong with panels that were made all the same.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum PanelizeFinding {
    /// The outline of a panel crosses itself, or runs against the surface.
    Crosses,
    /// A panel goes through another.
    GoesThrough,
    /// Panels are not planar up to rounding.
    NotPlanar,
    /// A panel leaves the surface by more than a fifth of its size.
    TooCurved,
    /// An edge is shorter than the limit.
    ShortEdge,
    /// An angle is sharper than the limit, or as near to a full turn.
    SharpAngle,
    /// A panel does not fit the sheet.
    TooLarge,
    /// Plates at a node reach far from it.
    FarNode,
    /// The work was stopped early.
    Stopped,
    /// No edges of panels follow a crease that is to be kept.
    CreaseLost,
    /// More than three panels meet at a vertex, since more than three creases do.
    FullNode,
    /// Panels of one ring are not congruent.
    UnevenRing,
    /// A panel left the plane that was given for it.
    PlaneLost,
    /// A panel is no image of another across a mirror plane.
    Unpaired,
    /// No corner of panels stands at a point that was to stay.
    PointLost,
    /// An edge has the length of no family.
    ManyLengths,
    /// Neighbours fold by more than is allowed.
    SharpFold,
    /// A concave panel is deeper than is allowed.
    DeepHollow,
    /// The panels are not as many as were asked for.
    OtherCount,
}

impl PanelizeFinding {
    /// Whether the element at its place is a vertex, and not a panel.
    pub(super) fn is_of_vertex(self) -> bool {
        matches!(self, Self::FarNode | Self::PointLost)
    }
}

codes!(finding PanelizeFinding {
    Crosses = 601,
    GoesThrough = 602,
    NotPlanar = 603,
    TooCurved = 604,
    ShortEdge = 605,
    SharpAngle = 606,
    TooLarge = 607,
    FarNode = 608,
    Stopped = 609,
    CreaseLost = 610,
    FullNode = 611,
    UnevenRing = 612,
    PlaneLost = 613,
    Unpaired = 614,
    ManyLengths = 615,
    SharpFold = 616,
    DeepHollow = 617,
    PointLost = 618,
    OtherCount = 620,
});
