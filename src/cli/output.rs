//! What verbs print and write.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::error::CliError;
use crate::code::Coded;
use crate::io::output::OutputFolder;
use crate::io::{WriteOptions, write_mesh};
use crate::measure::size;
use crate::mesh::Mesh;
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
}

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
        notes: &[String],
    ) -> Result<(), CliError> {
        let command = command_line();
        write_mesh(
            path,
            mesh,
            &WriteOptions { command: Some(command.clone()), ..WriteOptions::default() },
        )?;
        let is_stdout = path == Path::new("-");
        if self.json {
            let model = model_json(mesh);
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
        self.notes(notes);
        let text = format!("{}: {}", path.display(), model_text(mesh));
        match (is_stdout, self.quiet) {
            (true, false) => say(&text),
            _ => self.result(&(text + "\n"))?,
        }
        Ok(())
    }

    /// Writes files into a folder, all or none, and returns their paths.
    pub(super) fn write_folder(
        folder: &Path,
        outputs: Vec<(String, Vec<u8>)>,
    ) -> Result<Vec<PathBuf>, CliError> {
        let mut files = OutputFolder::new(folder);
        for (name, bytes) in outputs {
            files.add(name, bytes);
        }
        Ok(files.commit()?)
    }
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
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+@%".contains(c);
    let arguments = std::env::args().skip(1).map(|argument| {
        let is_plain = !argument.is_empty() && argument.chars().all(plain);
        if is_plain { argument } else { format!("'{}'", argument.replace('\'', r"'\''")) }
    });
    std::iter::once("kerfold".to_owned()).chain(arguments).collect::<Vec<_>>().join(" ")
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

/// Prints an error with its code.
pub(super) fn complain(error: &CliError) {
    let options =
        error.options().map(|options| format!("; options: {options}")).unwrap_or_default();
    say(&format!("kerfold: {error}{options} ({})", error.code()));
}
