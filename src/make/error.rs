//! The one error of making things.

use super::dform::DformError;
use super::materials::MaterialError;
use super::nest_error::NestError;
use super::outlines_error::OutlinesError;
use super::panel_error::PanelOptionError;
use crate::check::CheckError;
use crate::code::codes;
use crate::gluing::GluingError;
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
use crate::units::counted;

/// What stopped the making of a thing, be it a step of a recipe or a verb.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MakeError {
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
    /// A D-form cannot be made as asked.
    #[error(transparent)]
    Dform(#[from] DformError),
    /// Outlines close to no body.
    #[error(transparent)]
    Gluing(#[from] GluingError),
    /// Outlines, options or a gluing file cannot be taken.
    #[error(transparent)]
    Outlines(#[from] OutlinesError),
    /// The mesh could not be unfolded.
    #[error(transparent)]
    Unfold(#[from] UnfoldError),
    /// A file of pieces could not be taken.
    #[error(transparent)]
    Nest(#[from] NestError),
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
    /// A material that does not fold, and folds.
    #[error(
        "{material} does not fold, but the pieces have {}: say how with --fold score or --fold \
        hinge, or cut every face by itself with --pieces faces",
        counted(*folds, "fold", "folds")
    )]
    RigidFolds {
        /// What the material is called.
        material: String,
        /// How many folds there are.
        folds: usize,
    },
    /// A story shows what the recipe does not make.
    #[error("the story shows `{frame}`, and {why}")]
    NoFrame {
        /// What it shows.
        frame: &'static str,
        /// What is missing, and what to do.
        why: &'static str,
    },
    /// The picture could not be drawn.
    #[error(transparent)]
    Picture(#[from] PictureError),
}

codes!(error MakeError {
    NoMesh = 711,
    SecondMesh = 712,
    State = 713,
    RigidFolds = 714,
    NoFrame = 715,
} through {
    Io.0,
    Planes.0,
    Shape.0,
    Op.0,
    Select.0,
    Seam.0,
    Check.0,
    Dform.0,
    Gluing.0,
    Outlines.0,
    Unfold.0,
    Nest.0,
    Sheet.0,
    Material.0,
    Panel.0,
    PanelOption.0,
    Picture.0,
});
