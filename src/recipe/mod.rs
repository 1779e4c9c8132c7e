//! A chain of steps read from TOML, run in order.
//!
//! Every step is the same parameter struct as the verb of that name on the command line. The steps
//! of a recipe share one
//! [`Job`]: the mesh as it is by then, what the last step made, and the results that are written at
//! the end.

mod call;
mod draft;
mod error;
mod fields;
mod job;
mod keys;
mod outputs;
mod parameters;
mod parse;
mod schema;
mod session;
mod shell;
mod story;
mod sweep;

#[cfg(test)]
mod tests;

use std::path::PathBuf;
use std::sync::Arc;

use serde::Deserialize;

pub use draft::{RecipeDraft, StepDraft, Value};
pub use error::{Position, RecipeError, StepError};
pub use job::{Job, StepWithFindings};
pub use keys::{StepKind, steps};
pub use outputs::job_outputs;
pub use schema::{ChoiceSchema, KeySchema, StepGroup, StepSchema, ValueKind, schema};
pub use session::{Preview, Reached, Replay, Session, SessionError};
pub use shell::{shell_line, shell_text};
pub use sweep::{MANIFEST, MOST_VARIANTS, Sweep, SweepError, SweepResults, Variant};

use crate::check::CheckParams;
use crate::io::ReadOptions;
use crate::make::{
    DformParams, FabricateParams, NestStep, OutlineParams, PanelFiles, PlanesStep, PointOut,
    ShowParams,
};
use crate::op::{HullParams, Operate};
use crate::panel::PanelParams;
use crate::panelize::HeightParams;
use crate::picture::RenderParams;
use crate::shape::SolidParams;
use crate::sheet::SheetParams;
use crate::unfold::UnfoldParams;

/// A recipe: a name and what to do, in order.
#[derive(Debug, Clone)]
pub struct Recipe {
    /// What it makes.
    pub name: Option<String>,
    /// The steps.
    pub steps: Vec<Step>,
}

/// A mesh file to read.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct ReadStep {
    /// The file, relative to the recipe's folder.
    #[arg(value_name = "FILE")]
    pub path: PathBuf,
    /// How to read it.
    #[command(flatten)]
    #[serde(flatten)]
    pub options: ReadOptions,
}

/// What a recipe shows besides its model.
#[derive(Debug, Clone, PartialEq, Eq, Default, clap::Args, Deserialize)]
pub struct StoryParams {
    /// Whether before.png shows the model as it was before the last operator, seen through, with the
    /// sections along which it was cut, and what was cut, opened or joined in red
    #[arg(long, value_enum, default_value_t)]
    #[serde(default)]
    pub before: Before,
    /// Pictures side by side in story.png, in this order, with what the frames show: start, each,
    /// cuts, cut, steps, model, sheets
    #[arg(long, value_enum, value_name = "LIST", value_delimiter = ',')]
    #[serde(default)]
    pub story: Vec<StoryFrame>,
}

/// What a picture of a story shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StoryFrame {
    /// The mesh that the recipe begins with.
    Start,
    /// The mesh after each operator but the last.
    Each,
    /// The mesh before each operator, with what is cut, opened or joined in red.
    Cuts,
    /// The same before the last operator that cuts, opens or joins something.
    Cut,
    /// The dual hull on its way, as the step `hull` asks.
    Steps,
    /// The model, from each of the views.
    Model,
    /// The pieces as they lie on the sheets, in the colours that they have on the model.
    Sheets,
}

/// Whether there is a picture of the model before the last operator.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Before {
    /// No picture.
    #[default]
    Off,
    /// `before.png`.
    On,
}

/// An operator of [`crate::op`] with its parameters.
#[derive(Debug, Clone)]
pub struct OperatorStep {
    /// How the step begins: `cut vertex`, `planarize`, ….
    pub verb: &'static str,
    /// What it does.
    pub params: Arc<dyn Operate>,
}

/// One step of a recipe.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub enum Step {
    /// `solid = "cube"`: a ready-made mesh.
    Solid(SolidParams),
    /// `read = "model.obj"`: a mesh file.
    Read(ReadStep),
    /// `height = "2*sin(x/3)"`: a surface given as heights over a rectangle.
    Height(HeightParams),
    /// `planes = "planes.csv"`: the solid that half-spaces bound.
    Planes(PlanesStep),
    /// `cut = "edge"`, `planarize = "exact"`, `subdivide = "loop"` and all other operators that
    /// take one mesh and make one.
    Operator(OperatorStep),
    /// `hull = "convex"` or `hull = "dual"`.
    Hull(HullParams),
    /// `check = "glass"`: limits for the report.
    Check(CheckParams),
    /// `unfold = "auto"`: pieces and sheets.
    Unfold {
        /// How to divide the model.
        unfold: UnfoldParams,
        /// Which edges open.
        fabricate: FabricateParams,
        /// Where the pieces go.
        sheet: SheetParams,
        /// What is made to be looked at.
        show: ShowParams,
    },
    /// `dform = "hamiltonian"`: carves the folds of a D-form and unfolds it. `dform = "outlines"`:
    /// joins flat outlines, as a first step.
    Dform {
        /// Which folds, and how to carve them.
        dform: DformParams,
        /// The outlines, where it is made from these.
        outlines: OutlineParams,
        /// Where the pieces go.
        sheet: SheetParams,
        /// What is made to be looked at.
        show: ShowParams,
    },
    /// `panels = "out"`: every face becomes a plate.
    Panels {
        /// How the plates are made.
        panels: PanelParams,
        /// What is written.
        files: PanelFiles,
        /// Where the panels go; their thickness.
        sheet: SheetParams,
    },
    /// `nest = "pieces.json"`: anybody's pieces onto sheets.
    Nest {
        /// Which pieces.
        nest: NestStep,
        /// Where they go.
        sheet: SheetParams,
    },
    /// `render = "iso"`: how the picture of the model looks.
    Render {
        /// Colours, view, numbers.
        render: RenderParams,
        /// What is pointed out.
        point_out: PointOut,
        /// What else is shown.
        story: StoryParams,
    },
}

impl Step {
    /// The verb that the step begins with.
    pub fn verb(&self) -> &'static str {
        match self {
            Self::Solid(_) => "solid",
            Self::Read(_) => "read",
            Self::Height(_) => "height",
            Self::Planes(_) => "planes",
            Self::Operator(step) => step.verb,
            Self::Hull(_) => "hull",
            Self::Check(_) => "check",
            Self::Unfold { .. } => "unfold",
            Self::Dform { .. } => "dform",
            Self::Panels { .. } => "panels",
            Self::Nest { .. } => "nest",
            Self::Render { .. } => "render",
        }
    }
}
