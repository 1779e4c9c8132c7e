//! What a caller of `panelize` can mend, and what it finds wrong with its result.

use glam::DVec3;

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
        "panels of {size} mm on this surface (about {count} of them) need more than {limit} \
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
        "no panels of {size} mm can be laid out around ({:.1}, {:.1}, {:.1}): the surface is \
        narrower than two panels there, or has a hole smaller than a panel; take smaller panels, \
        or close the hole",
        place.x, place.y, place.z
    )]
    TooNarrow {
        /// The panel size in mm.
        size: f64,
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
    /// A plane for the rim that no rim is near to.
    #[error(
        "plane {} of `--rim plane:…` lies near no rim of the surface, so nothing would stay in it; \
        give its place with a unit, or leave it out",
        plane + 1
    )]
    NoRimThere {
        /// Which of the planes, from 0.
        plane: usize,
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
});
