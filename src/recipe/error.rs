//! What is wrong with a recipe, with line and column.

use std::fmt;

use super::materials::MaterialError;
use super::panels::PanelOptionError;
use crate::check::CheckError;
use crate::code::{Code, Coded, codes};
use crate::io::IoError;
use crate::io::planes_csv::PlanesError;
use crate::mesh::BuildError;
use crate::op::OpError;
use crate::panel::PanelError;
use crate::picture::PictureError;
use crate::seam::SeamError;
use crate::select::SelectError;
use crate::shape::ShapeError;
use crate::sheet::SheetError;
use crate::unfold::UnfoldError;

/// A place in a recipe file, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Position {
    /// The line.
    pub line: usize,
    /// The character in the line.
    pub column: usize,
}

impl fmt::Display for Position {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}, column {}", self.line, self.column)
    }
}

/// Why a recipe could not be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RecipeError {
    /// Not TOML.
    #[error("{at}: {message}")]
    Syntax {
        /// Where.
        at: Position,
        /// What the TOML reader says.
        message: String,
    },
    /// A key that nobody knows.
    #[error("{at}: `{key}` is not known {place}; {advice}")]
    UnknownKey {
        /// Where.
        at: Position,
        /// The key.
        key: String,
        /// In what.
        place: String,
        /// The nearest known key, or all of them.
        advice: String,
    },
    /// A step that does not say what to do.
    #[error("{at}: this step does not say what to do; it needs one of the keys {verbs}")]
    NoVerb {
        /// Where the step begins.
        at: Position,
        /// The known verbs.
        verbs: String,
    },
    /// A step that says two things.
    #[error("{at}: this step says both `{first}` and `{second}`; make two steps of it")]
    TwoVerbs {
        /// Where the second verb stands.
        at: Position,
        /// The first verb.
        first: String,
        /// The second verb.
        second: String,
    },
    /// A value that does not fit.
    #[error("{at}: {message}")]
    BadValue {
        /// Where.
        at: Position,
        /// What is wrong with it.
        message: String,
    },
    /// No step at all.
    #[error(
        "the recipe has no [[step]]; the first one names a solid or reads a file, e.g. solid = \
        \"dodecahedron\""
    )]
    NoSteps,
}

codes!(error RecipeError {
    Syntax = 701,
    UnknownKey = 702,
    NoVerb = 703,
    TwoVerbs = 704,
    BadValue = 705,
    NoSteps = 706,
});

/// Why a recipe could not be carried out. The step is counted from 1.
#[derive(Debug, thiserror::Error)]
#[error("step {step} ({verb}): {cause}")]
pub struct StepError {
    /// Which step.
    pub step: usize,
    /// What it does.
    pub verb: &'static str,
    /// Why it failed.
    pub cause: Box<StepFailure>,
}

impl Coded for StepError {
    fn code(&self) -> Code {
        self.cause.code()
    }
}

/// What stopped a step.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum StepFailure {
    /// The step needs a mesh, and none has been made.
    #[error("there is no mesh yet; begin with a step that names a solid or reads a file")]
    NoMesh,
    /// The step would throw away the mesh made so far.
    #[error("there is a mesh already; only the first step may make or read one")]
    SecondMesh,
    /// A file could not be read.
    #[error(transparent)]
    Io(#[from] IoError),
    /// A file holds no half-spaces, or they bound no solid.
    #[error(transparent)]
    Planes(#[from] PlanesError),
    /// A solid could not be made.
    #[error(transparent)]
    Shape(#[from] ShapeError),
    /// An operator refused.
    #[error(transparent)]
    Op(#[from] OpError),
    /// A selection could not be read on the mesh.
    #[error(transparent)]
    Select(#[from] SelectError),
    /// No such seams.
    #[error(transparent)]
    Seam(#[from] SeamError),
    /// A limit of the check is no limit.
    #[error(transparent)]
    Check(#[from] CheckError),
    /// The mesh could not be unfolded.
    #[error(transparent)]
    Unfold(#[from] UnfoldError),
    /// A file of pieces could not be taken.
    #[error(transparent)]
    Nest(#[from] super::NestError),
    /// The pieces could not be laid out.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// The material could not be taken.
    #[error(transparent)]
    Material(#[from] MaterialError),
    /// The faces could not be made into plates.
    #[error(transparent)]
    Panel(#[from] PanelError),
    /// Options of panels that do not fit together.
    #[error(transparent)]
    PanelOption(#[from] PanelOptionError),
    /// A state of folding is no mesh.
    #[error("the pieces cannot be drawn while they fold: {0}; unfold the mesh again")]
    State(BuildError),
    /// The picture could not be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

codes!(error StepFailure {
    NoMesh = 711,
    SecondMesh = 712,
    State = 713,
} through {
    Io.0,
    Planes.0,
    Shape.0,
    Op.0,
    Select.0,
    Seam.0,
    Check.0,
    Unfold.0,
    Nest.0,
    Sheet.0,
    Material.0,
    Panel.0,
    PanelOption.0,
    Picture.0,
});
