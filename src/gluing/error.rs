//! Why outlines do not close to a body.

use crate::code::codes;

/// Why outlines cannot be joined, or what they close to is no solid.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GluingError {
    /// A name that no outline has.
    #[error(
        "`{name}` is no outline{}; write circle, ellipse-2x1, superellipse-2x1-4, \
        rounded-rectangle-2x1-0.3, rectangle-2x1, lens-0.5, regular-7, trefoil-0.25, peanut-0.25, \
        egg-0.2, or the path of an SVG or DXF file",
        nearest.as_ref().map(|n| format!(" (did you mean {n}?)")).unwrap_or_default()
    )]
    UnknownName {
        /// What was typed.
        name: String,
        /// The nearest known word.
        nearest: Option<String>,
    },
    /// Numbers of a name that are out of range.
    #[error("outline `{name}`: {fault}")]
    NameNumbers {
        /// What was typed.
        name: String,
        /// What is wrong with its numbers and what would do.
        fault: String,
    },
    /// An outline that bounds no piece.
    #[error("outline {name}: {fault}")]
    BadOutline {
        /// Its name.
        name: String,
        /// What is wrong, where, and what to do.
        fault: String,
    },
    /// Too few or too many seam points.
    #[error("{points} seam points were asked for; take {least} to {most}")]
    Points {
        /// What was asked for.
        points: usize,
        /// The fewest.
        least: usize,
        /// The most.
        most: usize,
    },
    /// A seam whose two sides differ in length.
    #[error(
        "seam {seam}: {a} is {a_mm:.6} mm long and {b} is {b_mm:.6} mm, {:.6} mm apart; make them \
        equal, or let the outlines be scaled to fit",
        (a_mm - b_mm).abs()
    )]
    Lengths {
        /// The seam as it was written.
        seam: String,
        /// One side.
        a: String,
        /// The other side.
        b: String,
        /// Its length.
        a_mm: f64,
        /// Its length.
        b_mm: f64,
    },
    /// A stretch of a rim that belongs to several seams or to none.
    #[error(
        "the rim of {name} from {from_mm:.4} to {to_mm:.4} mm (of {whole_mm:.4}) is {}; every part \
        of a rim must belong to exactly one side of a seam",
        if *twice { "joined twice" } else { "left open" }
    )]
    Rim {
        /// The outline.
        name: String,
        /// Where the stretch begins.
        from_mm: f64,
        /// Where it ends.
        to_mm: f64,
        /// The whole rim.
        whole_mm: f64,
        /// Whether it is joined twice, not left open.
        twice: bool,
    },
    /// The pieces hang together in several parts.
    #[error(
        "{} is joined with {} only, and not with {}; join all pieces to one surface, or make \
        several bodies",
        apart[0], apart[1], apart[2]
    )]
    Apart {
        /// A piece, those that it hangs together with, and one that it does not.
        apart: [String; 3],
    },
    /// The surface is no sphere.
    #[error(
        "joined so, the pieces are no sphere: {vertices} points − {edges} seam parts + {pieces} \
        pieces is {euler} and not 2; a closed body needs seams that leave no handle"
    )]
    NoSphere {
        /// Points of the seams.
        vertices: usize,
        /// Chords of the seams.
        edges: usize,
        /// Pieces.
        pieces: usize,
        /// Their Euler number.
        euler: i64,
    },
    /// More than 360° of material at a point.
    #[error(
        "at {place} there is {degrees:.4}° of material, {:.4}° more than a convex body can have \
        ({count} such points in all); {}",
        degrees - 360.0, mend.as_deref().unwrap_or("make the outlines less hollow there")
    )]
    Angle {
        /// Where: the pieces with places along their rims.
        place: String,
        /// How much material.
        degrees: f64,
        /// At how many points there is too much.
        count: usize,
        /// What would mend it.
        mend: Option<String>,
    },
    /// The body is a flat shape, covered twice.
    #[error(
        "joined so, the pieces fold flat: they lie on one another as a shape of {:.4} × {:.4} mm \
        covered twice, and no solid comes out; join them at another place",
        size[0], size[1]
    )]
    FoldsFlat {
        /// Width and height of the shape, in mm.
        size: [f64; 2],
    },
    /// The search for the body did not come to its end.
    #[error(
        "the body was not found: {fault}; take another number of points, or join at a slightly \
        other place"
    )]
    NotFound {
        /// How far the search came.
        fault: String,
    },
    /// The body does not pass its own checks.
    #[error("the body that was found is not true: {fault}; take another number of points")]
    NotTrue {
        /// What was measured.
        fault: String,
    },
    /// Planes that bound no solid.
    #[error("{planes} planes for each piece: {fault}; take more planes")]
    Planes {
        /// How many were asked for.
        planes: usize,
        /// What is wrong.
        fault: String,
    },
    /// Stopped by the user.
    #[error("stopped before the body was found; nothing was made")]
    Cancelled,
}

codes!(error GluingError {
    UnknownName = 871,
    NameNumbers = 872,
    BadOutline = 873,
    Points = 874,
    Lengths = 875,
    Rim = 876,
    Apart = 877,
    NoSphere = 878,
    Angle = 879,
    FoldsFlat = 880,
    NotFound = 881,
    NotTrue = 882,
    Planes = 883,
    Cancelled = 884,
});
