//! `kerfold cut`

use std::path::PathBuf;

use clap::{Args, Subcommand};

use super::error::CliError;
use super::input::Input;
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::mesh::Mesh;
use crate::op::{
    CutReport, OpContext, OpError, SliceParams, TruncateEdge, TruncateFace, TruncateVertex, slice, truncate_edges,
    truncate_faces, truncate_vertices,
};

/// Cut a mesh by a plane, or its vertices, edges or faces by planes that they set themselves
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold cut edge cube.obj --select 0 --offset 0.2 --repeat 3 -o rounded.obj")]
pub(super) struct CutArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Cut vertices off
    #[command(after_help = "Example: kerfold cut vertex cube.obj --select all --offset 0.25 -o truncated.obj")]
    Vertex(CutOf<TruncateVertex>),
    /// Cut edges off; repeated, each becomes a developable strip
    #[command(
        after_help = "Example: kerfold cut edge dodecahedron.obj --select hamiltonian --offset 0.3 --repeat 4 -o d-form.obj"
    )]
    Edge(CutOf<TruncateEdge>),
    /// Push faces inwards
    #[command(after_help = "Example: kerfold cut face ball.obj --select 'sides=5' -o pushed.obj")]
    Face(CutOf<TruncateFace>),
    /// Cut by a plane
    #[command(after_help = "Example: kerfold cut plane spot.obj --normal z --point 0,0,0 -o half.obj")]
    Plane(CutOf<SliceParams>),
}

#[derive(Debug, Args)]
struct CutOf<T: Args> {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    params: T,
    /// The mesh to write: OBJ, PLY, STL or OFF; `-` writes OBJ to standard output
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

pub(super) fn run(args: &CutArgs, console: &Console) -> Result<Outcome, CliError> {
    match &args.what {
        What::Vertex(cut) => cut.run("vertex", truncate_vertices, console),
        What::Edge(cut) => cut.run("edge", truncate_edges, console),
        What::Face(cut) => cut.run("face", truncate_faces, console),
        What::Plane(cut) => cut.run("plane", slice, console),
    }
}

type Operator<T> = fn(&Mesh, &T, &OpContext<'_>) -> Result<(Mesh, CutReport), OpError>;

impl<T: Args> CutOf<T> {
    fn run(&self, element: &str, operator: Operator<T>, console: &Console) -> Result<Outcome, CliError> {
        let read = self.input.read()?;
        let progress = Terminal::new(console.quiet);
        let context = OpContext { made: None, progress: &progress };
        let (mesh, report) = operator(&read.mesh, &self.params, &context)?;
        let notes: Vec<String> = read.notes.iter().map(ToString::to_string).chain(report.notes(element)).collect();
        console.write_model(&self.output, &mesh, &notes)?;
        Ok(Outcome::Clean)
    }
}
