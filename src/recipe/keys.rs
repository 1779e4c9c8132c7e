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
    /// What the step does, in a line; that of its verb on the command line, too.
    pub help: &'static str,
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
    step(
        "solid",
        "name",
        "Begin with a ready-made solid: Platonic, Archimedean, prism-N, antiprism-N, geodesic-N, soccer-ball, box-AxBxC",
        &[SolidParams::augment_args],
        |s| Ok(Step::Solid(s.read()?)),
    ),
    step(
        "read",
        "path",
        "Begin with a mesh file: OBJ, PLY, STL, OFF, GLB or 3MF",
        &[ReadStep::augment_args],
        |s| Ok(Step::Read(s.read()?)),
    ),
    step(
        "height",
        "height",
        "Begin with a surface that a formula gives as heights over a rectangle",
        &[HeightParams::augment_args],
        |s| Ok(Step::Height(s.read()?)),
    ),
    step(
        "planes",
        "path",
        "Begin with the solid that half-spaces bound",
        &[PlanesStep::augment_args],
        |s| Ok(Step::Planes(s.read()?)),
    ),
    cut("vertex", "Cut vertices off", &[TruncateVertexParams::augment_args], |s| {
        operator::<TruncateVertexParams>(s, "cut vertex")
    }),
    cut(
        "edge",
        "Cut edges off; repeated, each becomes a developable strip",
        &[TruncateEdgeParams::augment_args],
        |s| operator::<TruncateEdgeParams>(s, "cut edge"),
    ),
    cut("face", "Push faces inwards", &[TruncateFaceParams::augment_args], |s| {
        operator::<TruncateFaceParams>(s, "cut face")
    }),
    cut("plane", "Cut by a plane", &[SliceParams::augment_args], |s| {
        operator::<SliceParams>(s, "cut plane")
    }),
    StepKind {
        words: &[("\"convex\"", "false"), ("\"dual\"", "true")],
        ..step(
            "hull",
            "dual",
            "Make the convex hull of a mesh or its dual (one plane through each corner of the hull)",
            &[HullParams::augment_args],
            |s| Ok(Step::Hull(s.read()?)),
        )
    },
    step(
        "resolve",
        "select",
        "Split vertices with more than three edges into 3-valent ones by moving faces inwards",
        &[ResolveParams::augment_args],
        |s| operator::<ResolveParams>(s, "resolve"),
    ),
    step(
        "planarize",
        "profile",
        "Move vertices as little as possible until every face is planar to a profile",
        &[PlanarizeParams::augment_args],
        |s| operator::<PlanarizeParams>(s, "planarize"),
    ),
    step(
        "merge",
        "tolerance",
        "Make one polygon of faces that lie flat beside each other, as triangles from STL and CAD do",
        &[MergeParams::augment_args],
        |s| operator::<MergeParams>(s, "merge"),
    ),
    step(
        "repair",
        "close_holes",
        "Mend faces that are no surface: weld, orient, drop doubled and empty faces, close T-junctions, part edges with more than two faces",
        &[RepairParams::augment_args],
        |s| operator::<RepairParams>(s, "repair"),
    ),
    step(
        "simplify",
        "faces",
        "Make fewer triangles, so many or within a deviation: a scan becomes a paper model",
        &[SimplifyParams::augment_args],
        |s| operator::<SimplifyParams>(s, "simplify"),
    ),
    StepKind {
        // Beside a key of that name; the size itself is left open.
        words: &[("\"count\"", "\"count\""), ("\"sag\"", "\"sag\"")],
        ..step(
            "panelize",
            "size",
            "Make planar panels of a freeform surface, three edges at every node",
            &[PanelizeParams::augment_args],
            |s| operator::<PanelizeParams>(s, "panelize"),
        )
    },
    step(
        "subdivide",
        "scheme",
        "Make a mesh finer: Doo–Sabin, Catmull–Clark, Loop, simplest, honeycomb, truncation, dual or triangles",
        &[SubdivideParams::augment_args],
        |s| operator::<SubdivideParams>(s, "subdivide"),
    ),
    step(
        "sierpinski",
        "rounds",
        "Halve every edge and remove the middle of every face, over and over: one connected surface of high genus",
        &[SierpinskiParams::augment_args],
        |s| operator::<SierpinskiParams>(s, "sierpinski"),
    ),
    step(
        "handle",
        "from",
        "Join two faces by a curved handle, or by a hole when the weights are negative",
        &[HandleParams::augment_args],
        |s| operator::<HandleParams>(s, "handle"),
    ),
    step(
        "menger",
        "rounds",
        "Dig a tunnel into every face, over and over; exact ones make Menger's own sponge of a cube",
        &[MengerParams::augment_args],
        |s| operator::<MengerParams>(s, "menger"),
    ),
    step(
        "rind",
        "thickness",
        "Make a shell of even thickness, with faces punched through or peeled off",
        &[RindParams::augment_args],
        |s| operator::<RindParams>(s, "rind"),
    ),
    step(
        "check",
        "profile",
        "Measure planarity, valence, manifoldness, convexity and genus against limits",
        &[CheckParams::augment_args],
        |s| Ok(Step::Check(s.read()?)),
    ),
    step(
        "unfold",
        "pieces",
        "Unfold a mesh into flat pieces that never overlap, and lay them out on sheets",
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
            "Make a D-form of a solid (choose the folds, roll them into even strips) or of flat outlines (the one convex body that their rims close to), unfold it, and lay the pieces out",
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
        "Make every face a plate of constant thickness: mitres, gaps, joints, schedule, sheets, assembly map and 3D files",
        &[PanelParams::augment_args, PanelFiles::augment_args, SheetParams::augment_args],
        |s| Ok(Step::Panels { panels: s.read()?, files: s.read()?, sheet: s.read()? }),
    ),
    step(
        "nest",
        "pieces",
        "Lay anybody's flat pieces out on sheets, close together, and draw the sheets",
        &[NestStep::augment_args, SheetParams::augment_args],
        |s| Ok(Step::Nest { nest: s.read()?, sheet: s.read()? }),
    ),
    step(
        "render",
        "view",
        "Draw a picture of a mesh, hidden parts hidden",
        &[RenderParams::augment_args, PointOut::augment_args, StoryParams::augment_args],
        |s| Ok(Step::Render { render: s.read()?, point_out: s.read()?, story: s.read()? }),
    ),
];

const fn step(
    verb: &'static str,
    field: &'static str,
    help: &'static str,
    params: &'static [fn(Command) -> Command],
    read: Read,
) -> StepKind {
    StepKind { verb, kind: None, field, help, words: &[], params, read }
}

const fn cut(
    kind: &'static str,
    help: &'static str,
    params: &'static [fn(Command) -> Command],
    read: Read,
) -> StepKind {
    StepKind { verb: "cut", kind: Some(kind), field: "", help, words: &[], params, read }
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
