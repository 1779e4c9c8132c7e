//! The command line: arguments, calls, exit codes; one verb, one file.
//!
//! Results go to standard output, messages to standard error. Exit codes: 0 clean, 1 findings, 2
//! error. A broken pipe is a success: whoever reads has read enough.

mod check;
mod colour;
mod cut;
mod dform;
mod error;
mod explain;
mod gallery;
mod help;
mod hull;
mod info;
mod input;
mod kerf_test;
mod lint;
mod manual;
mod nest;
mod operator;
mod output;
mod panelize;
mod panels;
mod reference;
mod render;
mod repair;
mod run;
mod seams;
mod snippet;
mod solid;
mod studio;
mod sweep;
mod terminal;
mod unfold;
mod verify;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use output::Console;
pub use reference::reference;

use crate::op::{
    HandleParams, MengerParams, MergeParams, PlanarizeParams, RindParams, SierpinskiParams,
    SimplifyParams, SubdivideParams,
};

/// Carve planar 3-valence meshes, check them, and unfold them into sheets that a shop can cut.
#[derive(Debug, Parser)]
#[command(
    name = "kerfold",
    version,
    propagate_version = true,
    disable_help_subcommand = true,
    max_term_width = 110
)]
#[command(
    after_help = "Exit codes: 0 clean, 1 findings, 2 error. `-` as a file is standard input or \
    output (OBJ).\n\n\
    Example: kerfold run fixtures/recipes/two-piece-d-form.toml -o out"
)]
struct Cli {
    #[command(flatten)]
    console: Console,
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Debug, Subcommand)]
enum Verb {
    Solid(solid::SolidArgs),
    Info(info::InfoArgs),
    Check(check::CheckArgs),
    Cut(cut::CutArgs),
    Hull(hull::HullArgs),
    /// Move vertices as little as possible until every face is planar to a profile; exit code 1
    /// when that is not reached
    #[command(after_help = "Example: kerfold planarize facade.obj --profile glass --rim fixed -o \
        planar.obj")]
    Planarize(operator::OperatorArgs<PlanarizeParams>),
    /// Make one polygon of faces that lie flat beside each other, as triangles from STL and CAD do
    #[command(after_help = "Example: kerfold merge dome.stl --tolerance 0.05mm -o panes.obj")]
    Merge(operator::OperatorArgs<MergeParams>),
    Repair(repair::RepairArgs),
    /// Make fewer triangles, so many or within a deviation: a scan becomes a paper model
    #[command(after_help = "Example: kerfold simplify cat.stl --faces 300 -o paper-cat.obj")]
    Simplify(operator::OperatorArgs<SimplifyParams>),
    Panelize(panelize::PanelizeArgs),
    /// Make a mesh finer: Doo–Sabin, Catmull–Clark, Loop, simplest, honeycomb, truncation, dual or
    /// triangles
    #[command(after_help = "Example: kerfold subdivide doo-sabin cube.obj --rounds 2 -o round.obj")]
    Subdivide(operator::OperatorArgs<SubdivideParams>),
    /// Halve every edge and remove the middle of every face, over and over: one connected surface
    /// of high genus
    #[command(
        after_help = "Example: kerfold sierpinski tetrahedron.obj --rounds 3 -o sierpinski.obj"
    )]
    Sierpinski(operator::OperatorArgs<SierpinskiParams>),
    /// Make a shell of even thickness, with faces punched through or peeled off; exit code 1 when
    /// it crosses itself
    #[command(
        after_help = "Example: kerfold rind ball.obj --thickness 2mm --peel sides=5 -o rind.obj"
    )]
    Rind(operator::OperatorArgs<RindParams>),
    /// Dig a tunnel into every face, over and over; `--exact` makes Menger's own sponge of a cube;
    /// exit code 1 when it crosses itself
    #[command(
        after_help = "Example: kerfold menger dodecahedron.obj --thickness 0.2 -o sponge.obj"
    )]
    Menger(operator::OperatorArgs<MengerParams>),
    /// Join two faces by a curved handle, or by a hole when the weights are negative; exit code 1
    /// when it crosses itself
    #[command(
        after_help = "Example: kerfold handle cup.obj --from 2 --to 5 --segments 8 -o mug.obj"
    )]
    Handle(operator::OperatorArgs<HandleParams>),
    Unfold(unfold::UnfoldArgs),
    Seams(seams::SeamsArgs),
    Dform(dform::DformArgs),
    Panels(panels::PanelsArgs),
    Nest(nest::NestArgs),
    Verify(verify::VerifyArgs),
    Lint(lint::LintArgs),
    KerfTest(kerf_test::KerfTestArgs),
    Run(run::RunArgs),
    Gallery(gallery::GalleryArgs),
    Render(render::RenderArgs),
    Studio(studio::StudioArgs),
    Explain(explain::ExplainArgs),
    Help(help::HelpArgs),
    Completions(manual::CompletionsArgs),
    Man(manual::ManArgs),
}

/// How a verb ended when it did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    Clean,
    Findings,
}

/// The whole command line definition, for completions and manual pages.
fn command() -> clap::Command {
    // `unfold` has an effort and a seed of its own; where there is only one of each, the short
    // names do.
    let short = |nest: clap::Command| {
        nest.mut_arg("nest_effort", |a| a.visible_alias("effort"))
            .mut_arg("nest_seed", |a| a.visible_alias("seed"))
    };
    Cli::command().mut_subcommand("nest", short)
}

/// Reads the arguments of the process, does what they say, and returns the exit code.
pub fn run() -> ExitCode {
    let colour = colour::asked_colour(std::env::args_os());
    let parsed = command()
        .color(colour.of_clap())
        .try_get_matches()
        .and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = match parsed {
        Ok(cli) => cli,
        Err(refusal) => return explain::refuse(&refusal),
    };
    let console = cli.console;
    terminal::watch_for_ctrl_c();
    let result = match cli.verb {
        Verb::Solid(args) => solid::run(&args, &console),
        Verb::Info(args) => info::run(&args, &console),
        Verb::Check(args) => check::run(&args, &console),
        Verb::Cut(args) => cut::run(&args, &console),
        Verb::Hull(args) => hull::run(&args, &console),
        Verb::Planarize(args) => operator::run(&args, &console),
        Verb::Merge(args) => operator::run(&args, &console),
        Verb::Repair(args) => repair::run(&args, &console),
        Verb::Simplify(args) => operator::run(&args, &console),
        Verb::Panelize(args) => panelize::run(&args, &console),
        Verb::Subdivide(args) => operator::run(&args, &console),
        Verb::Sierpinski(args) => operator::run(&args, &console),
        Verb::Rind(args) => operator::run(&args, &console),
        Verb::Menger(args) => operator::run(&args, &console),
        Verb::Handle(args) => operator::run(&args, &console),
        Verb::Unfold(args) => unfold::run(&args, &console),
        Verb::Seams(args) => seams::run(&args, &console),
        Verb::Dform(args) => dform::run(&args, &console),
        Verb::Panels(args) => panels::run(&args, &console),
        Verb::Nest(args) => nest::run(&args, &console),
        Verb::Verify(args) => verify::run(&args, &console),
        Verb::Lint(args) => lint::run(&args, &console),
        Verb::KerfTest(args) => kerf_test::run(&args, &console),
        Verb::Run(args) => run::run(&args, &console),
        Verb::Gallery(args) => gallery::run(&args, &console),
        Verb::Render(args) => render::run(&args, &console),
        Verb::Studio(args) => studio::run(&args, &console),
        Verb::Explain(args) => explain::run(&args, &console),
        Verb::Help(args) => help::run(&args, &console),
        Verb::Completions(args) => manual::completions(&args),
        Verb::Man(args) => manual::man(&args, &console),
    };
    terminal::clear_progress();
    match result {
        Ok(Outcome::Clean) => ExitCode::SUCCESS,
        Ok(Outcome::Findings) => ExitCode::from(1),
        Err(error) if error.is_broken_pipe() => ExitCode::SUCCESS,
        Err(error) => {
            output::complain(&error);
            ExitCode::from(2)
        }
    }
}
