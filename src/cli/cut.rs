//! `kerfold cut`

use std::path::{Path, PathBuf};

use clap::{Args, Subcommand};

use super::error::CliError;
use super::input::Input;
use super::output::beside;
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::mesh::Mesh;
use crate::op::{
    CutReport, Keep, OpContext, OpError, ResolveParams, SliceParams, TruncateEdgeParams,
    TruncateFaceParams, TruncateVertexParams, resolve, slice, slice_both, truncate_edges,
    truncate_faces, truncate_vertices,
};
use crate::units::Length;

/// Cut a mesh by a plane, or its vertices, edges or faces by planes that they set themselves
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold cut edge cube.obj --select 0 --offset 0.2 --repeat 3 -o \
    rounded.obj")]
pub(super) struct CutArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Cut vertices off
    #[command(after_help = "Example: kerfold cut vertex cube.obj --select all --offset 0.25 -o \
        truncated.obj")]
    Vertex(CutOf<TruncateVertexParams>),
    /// Cut edges off; repeated, each becomes a developable strip
    #[command(
        after_help = "Example: kerfold cut edge dodecahedron.obj --select hamiltonian --offset 0.3 \
        --repeat 4 -o d-form.obj"
    )]
    Edge(CutOf<TruncateEdgeParams>),
    /// Push faces inwards
    #[command(after_help = "Example: kerfold cut face ball.obj --select 'sides=5' -o pushed.obj")]
    Face(CutOf<TruncateFaceParams>),
    /// Cut by a plane
    #[command(
        after_help = "Example: kerfold cut plane spot.obj --normal z --point 0,0,0 -o half.obj"
    )]
    Plane(CutOf<SliceParams>),
}

#[derive(Debug, Args)]
struct CutOf<T: Args> {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    params: T,
    /// Afterwards split vertices with more than three edges into 3-valent ones by moving faces
    /// inwards, by 0.01mm at most or as far as given
    #[arg(
        long,
        value_name = "DEPTH",
        num_args = 0..=1,
        require_equals = true,
        default_missing_value = "0.01mm"
    )]
    resolve: Option<Length>,
    /// The mesh to write: OBJ, PLY, STL, OFF, 3MF or DXF; `-` writes OBJ to standard output. With
    /// `--keep both` two meshes are written, OUT-reverse and OUT-normal
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

pub(super) fn run(args: &CutArgs, console: &Console) -> Result<Outcome, CliError> {
    match &args.what {
        What::Vertex(cut) => cut.run("vertex", truncate_vertices, console),
        What::Edge(cut) => cut.run("edge", truncate_edges, console),
        What::Face(cut) => cut.run("face", truncate_faces, console),
        What::Plane(cut) if cut.params.keep == Keep::Both => both_parts(cut, console),
        What::Plane(cut) => cut.run("plane", slice, console),
    }
}

/// Writes the parts on both sides of a plane, or the only one that is not empty.
fn both_parts(cut: &CutOf<SliceParams>, console: &Console) -> Result<Outcome, CliError> {
    if cut.output == Path::new("-") {
        return Err(CliError::TwoToStdout);
    }
    let read = cut.input.read()?;
    let progress = Terminal::new(console.quiet);
    let parts = slice_both(
        &read.mesh,
        &cut.params,
        &OpContext { made: read.made.as_ref(), progress: &progress },
    )?;
    console.notes(&read.notes);
    let mut models = Vec::new();
    for (part, side) in parts.into_iter().zip(["reverse", "normal"]) {
        match part {
            Some((mesh, report)) => {
                let (mesh, notes) = cut.resolved(mesh, report.notes("plane"))?;
                models.push((beside(&cut.output, side), mesh, notes));
            }
            None => console.notes(&[format!(
                "nothing lies on the {side} side of the plane; no file was written for it"
            )]),
        }
    }
    console.write_models(&models, Vec::new())?;
    Ok(Outcome::Clean)
}

type Operator<T> = fn(&Mesh, &T, &OpContext<'_>) -> Result<(Mesh, CutReport), OpError>;

impl<T: Args> CutOf<T> {
    fn run(
        &self,
        element: &str,
        operator: Operator<T>,
        console: &Console,
    ) -> Result<Outcome, CliError> {
        let read = self.input.read()?;
        let progress = Terminal::new(console.quiet);
        let context = OpContext { made: read.made.as_ref(), progress: &progress };
        let (mesh, report) = operator(&read.mesh, &self.params, &context)?;
        let notes =
            read.notes.iter().map(ToString::to_string).chain(report.notes(element)).collect();
        let (mesh, notes) = self.resolved(mesh, notes)?;
        // Resolving gives other ids.
        let made = self.resolve.is_none().then_some(&report.made);
        console.write_model(&self.output, &mesh, made, &notes)?;
        Ok(Outcome::Clean)
    }

    /// The mesh with its vertices resolved, where that is asked for, and what to say about it.
    fn resolved(
        &self,
        mut mesh: Mesh,
        mut notes: Vec<String>,
    ) -> Result<(Mesh, Vec<String>), CliError> {
        if let Some(depth) = self.resolve {
            let params = ResolveParams { depth, ..ResolveParams::default() };
            let (resolved, report) = resolve(&mesh, &params, &OpContext::default())?;
            notes.extend(report.notes());
            mesh = resolved;
        }
        Ok((mesh, notes))
    }
}
