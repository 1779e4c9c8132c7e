//! `kerfold seams`

use std::path::PathBuf;

use serde_json::json;

use super::error::CliError;
use super::input::Input;
use super::output::{command_line, model_text, short};
use super::terminal::Terminal;
use super::{Console, Outcome};
use crate::io::output::write_file;
use crate::make::{FoldChoice, MakeError, choices_picture};
use crate::measure::edge_length;
use crate::mesh::{EdgeId, Mesh};
use crate::progress::Progress;
use crate::seam::{
    SeamError, fold_sum, hamiltonian_folds, least_matching, piece_count, seam_cycles, table,
};

/// List the ways to divide a closed 3-valent mesh by closed seams, up to its symmetry
#[derive(Debug, clap::Args)]
#[command(after_help = "Example: kerfold seams dodecahedron.obj\n\n\
    The folds of each row meet every vertex once. Take row K with `matching:K` in a selection, or with `dform --matching K`.")]
pub(super) struct SeamsArgs {
    #[command(flatten)]
    input: Input,
    /// List at most so many choices of folds, symmetric ones counted; of a mesh that has more only
    /// the least matching and a two-piece seam are listed
    #[arg(long, default_value_t = LIMIT, value_name = "N")]
    limit: usize,
    /// Draw all choices into one picture, a .png: the carved body of each and its pieces, with the
    /// number of the row; the first 60 where there are more
    #[arg(long, value_name = "OUT")]
    draw: Option<PathBuf>,
}

/// As many choices as `seams` lists unless told otherwise.
pub(super) const LIMIT: usize = 20_000;

/// A choice of folds with what it means.
pub(super) struct Row {
    /// How a selection calls it.
    selection: String,
    folds: Vec<EdgeId>,
    /// How many choices are the same up to symmetry; unknown where not all were listed.
    orbit: Option<usize>,
    pieces: usize,
    cycles: usize,
    seam_length: f64,
    fold_sum: f64,
}

impl Row {
    fn new(mesh: &Mesh, selection: String, folds: Vec<EdgeId>, orbit: Option<usize>) -> Self {
        let mut is_fold = vec![false; mesh.edge_slots()];
        folds.iter().for_each(|e| is_fold[e.index()] = true);
        let seams = mesh.edges().filter(|e| !is_fold[e.index()]);
        Self {
            selection,
            orbit,
            pieces: piece_count(mesh, &folds),
            cycles: seam_cycles(mesh, &folds).len(),
            seam_length: seams.map(|e| edge_length(mesh, e)).sum(),
            fold_sum: fold_sum(mesh, &folds),
            folds,
        }
    }
}

pub(super) fn run(args: &SeamsArgs, console: &Console) -> Result<Outcome, CliError> {
    let is_png = |path: &PathBuf| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("png"));
    if let Some(path) = args.draw.as_ref().filter(|path| !is_png(path)) {
        return Err(CliError::NotPng { path: path.clone() });
    }
    let read = args.input.read()?;
    let (mesh, progress) = (&read.mesh, Terminal::new(console.quiet));
    let (rows, why) = rows(mesh, args.limit, &progress)?;
    let notes: Vec<String> = read.notes.iter().map(ToString::to_string).chain(why).collect();
    if let Some(path) = &args.draw {
        write_file(path, &picture(mesh, &rows, &progress)?)?;
    }
    if console.json {
        let rows: Vec<_> = rows.iter().map(row_json).collect();
        let told = json!({ "command": command_line(), "matchings": rows, "notes": notes });
        console.result(&format!("{told:#}\n"))?;
    } else {
        console.notes(&notes);
        console.result(&format!("{}\n{}", model_text(mesh), table_text(&rows)))?;
    }
    Ok(Outcome::Clean)
}

/// All rows as small pictures, as PNG.
pub(super) fn picture(
    mesh: &Mesh,
    rows: &[Row],
    progress: &dyn Progress,
) -> Result<Vec<u8>, MakeError> {
    let choice = |row: &Row| FoldChoice {
        label: format!("{} {} PIECES", row.selection.to_uppercase(), row.pieces),
        folds: row.folds.clone(),
    };
    let choices: Vec<FoldChoice> = rows.iter().map(choice).collect();
    choices_picture(mesh, &choices, progress)
}

/// The whole table, or what can be said of a mesh with too many matchings, and why.
pub(super) fn rows(
    mesh: &Mesh,
    limit: usize,
    progress: &dyn Progress,
) -> Result<(Vec<Row>, Option<String>), SeamError> {
    let too_many = match table(mesh, limit, progress) {
        Ok(rows) => {
            let row = |r: crate::seam::MatchingRow| {
                Row::new(mesh, format!("matching:{}", r.index), r.folds, Some(r.orbit_size))
            };
            return Ok((rows.into_iter().map(row).collect(), None));
        }
        Err(error @ SeamError::TooMany { .. }) => error,
        Err(error) => return Err(error),
    };
    let mut rows =
        vec![Row::new(mesh, "matching".to_owned(), least_matching(mesh, progress)?, None)];
    let mut why = too_many.to_string();
    match hamiltonian_folds(mesh, progress) {
        Ok(folds) => rows.push(Row::new(mesh, "hamiltonian".to_owned(), folds, None)),
        Err(error) => why += &format!("; {error}"),
    }
    Ok((rows, Some(why)))
}

pub(super) fn row_json(row: &Row) -> serde_json::Value {
    let folds: Vec<usize> = row.folds.iter().map(|e| e.index()).collect();
    json!({
        "selection": row.selection, "pieces": row.pieces, "seam_cycles": row.cycles,
        "seam_length_mm": row.seam_length,
        "fold_sum_rad_mm": row.fold_sum, "orbit": row.orbit, "folds": folds,
    })
}

pub(super) fn table_text(rows: &[Row]) -> String {
    let mut text = format!(
        "{:<14}{:>7}{:>8}{:>14}{:>18}{:>12}\n",
        "selection", "pieces", "cycles", "seam mm", "fold sum rad·mm", "symmetric"
    );
    for row in rows {
        let orbit = row.orbit.map_or_else(|| "?".to_owned(), |orbit| orbit.to_string());
        text += &format!(
            "{:<14}{:>7}{:>8}{:>14}{:>18}{:>12}\n",
            row.selection,
            row.pieces,
            row.cycles,
            short(row.seam_length),
            short(row.fold_sum),
            orbit
        );
    }
    let listed: Option<usize> = rows.iter().map(|r| r.orbit).sum();
    text + &listed.map_or_else(String::new, |all| {
        format!("{} of {all} choices, up to symmetry\n", rows.len())
    })
}
