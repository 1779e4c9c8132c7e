//! What verbs print and write.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::colour::{Colour, asked_colour};
use super::error::CliError;
use super::snippet::recipe_snippet;
use crate::code::Coded;
use crate::io::output::{OutputFolder, write_file, write_files};
use crate::io::{IoError, MeshFormat, WriteOptions, file_note, mesh_bytes};
use crate::measure::size;
use crate::mesh::Mesh;
use crate::recipe::shell_text;
use crate::select::NewElements;
use crate::units::counted;

/// How much is said, and in what form.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(super) struct Console {
    /// Print results as JSON
    #[arg(long, global = true)]
    pub json: bool,
    /// Print no notes and no summaries; errors still
    #[arg(long, short, global = true)]
    pub quiet: bool,
    /// Colours in messages and help: auto where a terminal reads them and NO_COLOR is not set
    #[arg(long, global = true, value_enum, default_value_t, value_name = "WHEN")]
    pub color: Colour,
}

/// What becomes of files that an earlier run left in the folder.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(super) struct Clean {
    /// Remove sheets and other files of an earlier run that are no part of this one any more; only
    /// files that kerfold wrote [default: they stay, and a note names them]
    #[arg(long)]
    pub clean: bool,
}

/// A file that is to be written.
pub(super) type OutputFile = (PathBuf, Vec<u8>);

impl Console {
    /// Prints a result to standard output.
    pub(super) fn result(&self, text: &str) -> Result<(), CliError> {
        if self.quiet { Ok(()) } else { print(text) }
    }

    /// Prints notes to standard error, one a line.
    pub(super) fn notes<T: ToString>(&self, notes: &[T]) {
        if !self.quiet {
            for note in notes {
                say(&format!("note: {}", note.to_string()));
            }
        }
    }

    /// Writes a mesh and prints its size, to standard error when the mesh itself goes to standard
    /// output.
    pub(super) fn write_model(
        &self,
        path: &Path,
        mesh: &Mesh,
        made: Option<&NewElements>,
        notes: &[String],
    ) -> Result<(), CliError> {
        let (path, bytes) = model_file(path, mesh, made)?;
        write_file(&path, &bytes)?;
        self.show_model(&path, mesh, notes)
    }

    /// Writes meshes and what belongs to them: all files, or none. None is standard output.
    pub(super) fn write_models(
        &self,
        models: &[(PathBuf, Mesh, Vec<String>)],
        others: Vec<OutputFile>,
    ) -> Result<(), CliError> {
        let mut files = others;
        for (path, mesh, _) in models {
            files.push(model_file(path, mesh, None)?);
        }
        write_files(&files)?;
        models.iter().try_for_each(|(path, mesh, notes)| self.show_model(path, mesh, notes))
    }

    fn show_model(&self, path: &Path, mesh: &Mesh, notes: &[String]) -> Result<(), CliError> {
        let notes: Vec<String> = notes.iter().cloned().chain(file_note(mesh)).collect();
        let is_stdout = path == Path::new("-");
        if self.json {
            let (command, model) = (command_line(), model_json(mesh));
            let path = path.to_string_lossy();
            let written =
                json!({ "command": command, "written": path, "model": model, "notes": notes });
            let text = format!("{written:#}\n");
            if is_stdout {
                say(text.trim_end())
            } else {
                self.result(&text)?
            }
            return Ok(());
        }
        self.notes(&notes);
        let text = format!("{}: {}", path.display(), model_text(mesh));
        match (is_stdout, self.quiet) {
            (true, false) => say(&text),
            _ => self.result(&(text + "\n"))?,
        }
        Ok(())
    }

    /// Writes files into a folder, all or none, and returns their paths as text; says what an
    /// earlier run has left there.
    pub(super) fn write_folder(
        &self,
        folder: &Path,
        outputs: Vec<(String, Vec<u8>)>,
        clean: Clean,
    ) -> Result<Vec<String>, CliError> {
        let (written, note) = write_into(folder, outputs, clean)?;
        self.notes(note.as_slice());
        Ok(written)
    }
}

/// Files that a note names before it says "and more".
const NAMED: usize = 8;

/// Writes files into a folder, all or none; returns their paths and what to say about files of an
/// earlier run.
pub(super) fn write_into(
    folder: &Path,
    outputs: Vec<(String, Vec<u8>)>,
    clean: Clean,
) -> Result<(Vec<String>, Option<String>), IoError> {
    let mut files = OutputFolder::new(folder);
    for (name, bytes) in outputs {
        files.add(name, bytes);
    }
    let written = files.commit()?;
    if clean.clean {
        written.remove_stale()?;
    }
    let paths = written.paths.iter().map(|path| path.to_string_lossy().into_owned()).collect();
    let names: Vec<_> = written.stale.iter().filter_map(|path| path.file_name()).collect();
    let named: Vec<_> = names.iter().take(NAMED).map(|name| name.to_string_lossy()).collect();
    let more = names.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more") } else { String::new() };
    let list = format!("{}{more}", named.join(", "));
    let note = match clean.clean {
        true => format!("removed from {}, left there by an earlier run: {list}", folder.display()),
        false => format!(
            "in {} an earlier run has left what is no part of this one: {list}; --clean removes it",
            folder.display()
        ),
    };
    Ok((paths, (!names.is_empty()).then_some(note)))
}

/// A mesh as a file in the format of its path.
fn model_file(path: &Path, mesh: &Mesh, made: Option<&NewElements>) -> Result<OutputFile, IoError> {
    let format = MeshFormat::of_path(path)
        .ok_or_else(|| IoError::UnknownFormat { path: path.to_owned() })?;
    let options = WriteOptions {
        command: Some(command_line()),
        made: made.cloned(),
        ..WriteOptions::default()
    };
    Ok((path.to_owned(), mesh_bytes(format, mesh, &options)?))
}

/// `dir/half.obj` becomes `dir/half-normal.obj`.
pub(super) fn beside(path: &Path, what: &str) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_owned();
    name.push(format!("-{what}"));
    if let Some(extension) = path.extension() {
        name.push(".");
        name.push(extension);
    }
    path.with_file_name(name)
}

/// Counts and size of a model in one line.
pub(super) fn model_text(mesh: &Mesh) -> String {
    let extent = size(mesh);
    format!(
        "{}, {}, {}, {} × {} × {} mm",
        counted(mesh.vertex_count(), "vertex", "vertices"),
        counted(mesh.edge_count(), "edge", "edges"),
        counted(mesh.face_count(), "face", "faces"),
        short(extent.x),
        short(extent.y),
        short(extent.z)
    )
}

pub(super) fn model_json(mesh: &Mesh) -> Value {
    let extent = size(mesh);
    json!({
        "vertices": mesh.vertex_count(), "edges": mesh.edge_count(), "faces": mesh.face_count(),
        "rims": mesh.hole_count(), "size_mm": [extent.x, extent.y, extent.z],
    })
}

/// A length for people: six significant digits.
pub(super) fn short(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = (5 - value.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let text = format!("{value:.digits$}");
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

/// The command line as files carry it: the program by its name alone, arguments quoted where a
/// shell would need it.
pub(super) fn command_line() -> String {
    let arguments =
        std::env::args_os().skip(1).map(|argument| argument.to_string_lossy().into_owned());
    shell_text(&std::iter::once("kerfold".to_owned()).chain(arguments).collect::<Vec<_>>())
}

/// Prints to standard output.
pub(super) fn print(text: &str) -> Result<(), CliError> {
    let mut out = std::io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush()).map_err(CliError::Stdout)
}

/// Prints a line to standard error. If even that is closed, nobody can be told.
pub(super) fn say(line: &str) {
    super::terminal::clear_progress();
    let _ = writeln!(std::io::stderr(), "{line}");
}

/// Prints an error with its code, and the place of a fault in a recipe as compilers show it.
pub(super) fn complain(error: &CliError) {
    let options =
        error.options().map(|options| format!("; options: {options}")).unwrap_or_default();
    say(&format!("kerfold: {error}{options} ({})", error.code()));
    if let CliError::Recipe { path, error, text } = error
        && let Some(snippet) = recipe_snippet(path, text, error, asked_colour(std::env::args_os()))
    {
        say(&snippet);
    }
}
