//! Which steps there are and which keys they take: the fields of the parameter structs of their
//! verbs. The structs' own command-line definitions are asked for them, so that recipe, command
//! line and reference cannot part.

use std::sync::Arc;

use clap::{Args, Command};
use serde::de::DeserializeOwned;

use super::error::RecipeError;
use super::fields::{KnownKeys, StepFields};
use super::{
    DformParams, FabricateParams, NestStep, OperatorStep, OutlineParams, PanelFiles, PlanesStep,
    PointOut, ReadStep, ShowParams, Step, StoryParams,
};
use crate::check::CheckParams;
use crate::op::{
    HandleParams, HullParams, MengerParams, MergeParams, Operate, PlanarizeParams, RepairParams,
    ResolveParams, RindParams, SierpinskiParams, SimplifyParams, SliceParams, SubdivideParams,
    TruncateEdgeParams, TruncateFaceParams, TruncateVertexParams,
};
use crate::panel::PanelParams;
use crate::panelize::{HeightParams, PanelizeParams};
use crate::picture::RenderParams;
use crate::shape::SolidParams;
use crate::sheet::SheetParams;
use crate::unfold::UnfoldParams;

/// A kind of step of a recipe.
pub struct StepKind {
    /// The key that says what the step does.
    pub verb: &'static str,
    /// What that key must be for this kind; `None` where it is the value of [`Self::field`]. Only
    /// `cut` has kinds.
    pub kind: Option<&'static str>,
    /// The parameter that the value of the verb's key goes to; empty where there is a kind.
    pub field: &'static str,
    /// Words for the values of a parameter that is a switch on the command line: the word and what
    /// it stands for.
    pub words: &'static [(&'static str, &'static str)],
    params: &'static [fn(Command) -> Command],
    pub(super) read: Read,
}

type Read = fn(&StepFields<'_>) -> Result<Step, RecipeError>;

impl StepKind {
    /// The command-line definition of everything that the step takes. The id of an argument is the
    /// key.
    pub fn command(&self) -> Command {
        self.params.iter().fold(Command::new(self.verb), |command, augment| augment(command))
    }

    /// All keys, that of the field of the verb among them.
    pub(super) fn known_keys(&self) -> KnownKeys {
        let all = self.command().get_arguments().map(|a| a.get_id().to_string()).collect();
        KnownKeys { all, of_verb: self.field, words: self.words }
    }
}

/// All kinds of steps.
pub fn steps() -> &'static [StepKind] {
    STEPS
}

const STEPS: &[StepKind] = &[
    step("solid", "name", &[SolidParams::augment_args], |s| Ok(Step::Solid(s.read()?))),
    step("read", "path", &[ReadStep::augment_args], |s| Ok(Step::Read(s.read()?))),
    step("height", "height", &[HeightParams::augment_args], |s| Ok(Step::Height(s.read()?))),
    step("planes", "path", &[PlanesStep::augment_args], |s| Ok(Step::Planes(s.read()?))),
    cut("vertex", &[TruncateVertexParams::augment_args], |s| {
        operator::<TruncateVertexParams>(s, "cut vertex")
    }),
    cut("edge", &[TruncateEdgeParams::augment_args], |s| {
        operator::<TruncateEdgeParams>(s, "cut edge")
    }),
    cut("face", &[TruncateFaceParams::augment_args], |s| {
        operator::<TruncateFaceParams>(s, "cut face")
    }),
    cut("plane", &[SliceParams::augment_args], |s| operator::<SliceParams>(s, "cut plane")),
    StepKind {
        words: &[("\"convex\"", "false"), ("\"dual\"", "true")],
        ..step("hull", "dual", &[HullParams::augment_args], |s| Ok(Step::Hull(s.read()?)))
    },
    step("resolve", "select", &[ResolveParams::augment_args], |s| {
        operator::<ResolveParams>(s, "resolve")
    }),
    step("planarize", "profile", &[PlanarizeParams::augment_args], |s| {
        operator::<PlanarizeParams>(s, "planarize")
    }),
    step("merge", "tolerance", &[MergeParams::augment_args], |s| {
        operator::<MergeParams>(s, "merge")
    }),
    step("repair", "close_holes", &[RepairParams::augment_args], |s| {
        operator::<RepairParams>(s, "repair")
    }),
    step("simplify", "faces", &[SimplifyParams::augment_args], |s| {
        operator::<SimplifyParams>(s, "simplify")
    }),
    step("panelize", "size", &[PanelizeParams::augment_args], |s| {
        operator::<PanelizeParams>(s, "panelize")
    }),
    step("subdivide", "scheme", &[SubdivideParams::augment_args], |s| {
        operator::<SubdivideParams>(s, "subdivide")
    }),
    step("sierpinski", "rounds", &[SierpinskiParams::augment_args], |s| {
        operator::<SierpinskiParams>(s, "sierpinski")
    }),
    step("handle", "from", &[HandleParams::augment_args], |s| {
        operator::<HandleParams>(s, "handle")
    }),
    step("menger", "rounds", &[MengerParams::augment_args], |s| {
        operator::<MengerParams>(s, "menger")
    }),
    step("rind", "thickness", &[RindParams::augment_args], |s| operator::<RindParams>(s, "rind")),
    step("check", "profile", &[CheckParams::augment_args], |s| Ok(Step::Check(s.read()?))),
    step(
        "unfold",
        "pieces",
        &[
            UnfoldParams::augment_args,
            FabricateParams::augment_args,
            SheetParams::augment_args,
            ShowParams::augment_args,
        ],
        |s| {
            Ok(Step::Unfold {
                unfold: s.read()?,
                fabricate: s.read()?,
                sheet: s.read()?,
                show: s.read()?,
            })
        },
    ),
    StepKind {
        words: &[("\"outlines\"", "\"hamiltonian\"")],
        ..step(
            "dform",
            "matching",
            &[
                DformParams::augment_args,
                OutlineParams::augment_args,
                SheetParams::augment_args,
                ShowParams::augment_args,
            ],
            |s| {
                Ok(Step::Dform {
                    dform: s.read()?,
                    outlines: s.read()?,
                    sheet: s.read()?,
                    show: s.read()?,
                })
            },
        )
    },
    step(
        "panels",
        "side",
        &[PanelParams::augment_args, PanelFiles::augment_args, SheetParams::augment_args],
        |s| Ok(Step::Panels { panels: s.read()?, files: s.read()?, sheet: s.read()? }),
    ),
    step("nest", "pieces", &[NestStep::augment_args, SheetParams::augment_args], |s| {
        Ok(Step::Nest { nest: s.read()?, sheet: s.read()? })
    }),
    step(
        "render",
        "view",
        &[RenderParams::augment_args, PointOut::augment_args, StoryParams::augment_args],
        |s| Ok(Step::Render { render: s.read()?, point_out: s.read()?, story: s.read()? }),
    ),
];

const fn step(
    verb: &'static str,
    field: &'static str,
    params: &'static [fn(Command) -> Command],
    read: Read,
) -> StepKind {
    StepKind { verb, kind: None, field, words: &[], params, read }
}

const fn cut(
    kind: &'static str,
    params: &'static [fn(Command) -> Command],
    read: Read,
) -> StepKind {
    StepKind { verb: "cut", kind: Some(kind), field: "", words: &[], params, read }
}

fn operator<T: Args + DeserializeOwned + Operate + 'static>(
    step: &StepFields<'_>,
    verb: &'static str,
) -> Result<Step, RecipeError> {
    Ok(Step::Operator(OperatorStep { verb, params: Arc::new(step.read::<T>()?) }))
}

/// The verbs, each once.
pub(super) fn verbs() -> Vec<&'static str> {
    let mut verbs: Vec<&str> = STEPS.iter().map(|step| step.verb).collect();
    verbs.dedup();
    verbs
}

/// What `cut` may cut.
pub(super) fn cuts() -> Vec<&'static str> {
    STEPS.iter().filter_map(|step| step.kind).collect()
}
