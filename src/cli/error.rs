//! Everything that ends a verb with exit code 2.

use std::io;
use std::path::PathBuf;

use crate::check::CheckError;
use crate::code::{Coded, codes};
use crate::gallery::GalleryError;
use crate::io::IoError;
use crate::io::artwork::ArtError;
use crate::io::pieces_json::PiecesJsonError;
use crate::lint::{LimitError, LintError};
use crate::make::MakeError;
use crate::op::OpError;
use crate::picture::PictureError;
use crate::recipe::{RecipeError, StepError, SweepError};
use crate::seam::SeamError;
use crate::shape::ShapeError;

/// What went wrong, for the user.
#[derive(Debug, thiserror::Error)]
pub(super) enum CliError {
    #[error(transparent)]
    Io(#[from] IoError),
    #[error(transparent)]
    Shape(#[from] ShapeError),
    #[error(transparent)]
    Op(#[from] OpError),
    #[error(transparent)]
    Check(#[from] CheckError),
    #[error(transparent)]
    Picture(#[from] PictureError),
    #[error(transparent)]
    Seam(#[from] SeamError),
    #[error(transparent)]
    Limit(LimitError),
    #[error("{}: {error}", path.display())]
    Artwork { path: PathBuf, error: ArtError },
    #[error("{}: {error}", path.display())]
    Lint { path: PathBuf, error: LintError },
    #[error("{}: sheets are written as SVG, DXF, PDF or LightBurn project; name the file \
    something.svg, .dxf, .pdf or .lbrn2", path.display())]
    UnknownSheetFormat { path: PathBuf },
    #[error(transparent)]
    Step(#[from] MakeError),
    #[error("{}: {error}", path.display())]
    Recipe { path: PathBuf, error: Box<RecipeError>, text: String },
    #[error("{}: {error}", path.display())]
    Sweep { path: PathBuf, error: SweepError },
    #[error(
        "{}: there are no recipes in this folder; put files that end in .toml into it",
        path.display()
    )]
    NoRecipes { path: PathBuf },
    #[error("no recipe is named {name}; known are {known}")]
    UnknownRecipe { name: String, known: String },
    #[error("{count} of {total} recipes failed, the others are in the gallery; the first: {first}")]
    Gallery { count: usize, total: usize, first: Box<GalleryError> },
    #[error("{}: {error}", path.display())]
    RecipeStep { path: PathBuf, error: StepError },
    #[error("{}: cannot be read: {error}", path.display())]
    Unreadable { path: PathBuf, error: io::Error },
    #[error("{}: {error}", path.display())]
    Pieces { path: PathBuf, error: PiecesJsonError },
    #[error("{}: the scale is {scale}; it must be a number above 0, the factor from the model's \
    unit to millimetres", path.display())]
    Scale { path: PathBuf, scale: f64 },
    #[error("{}: this must be text in UTF-8, but byte {at} is not", path.display())]
    NotText { path: PathBuf, at: usize },
    #[error("{}: pictures are written as PNG, SVG or PDF; name the file something.png, .svg or .pdf", path.display())]
    NotPng { path: PathBuf },
    #[error("{}: reports are written as HTML, PDF, JSON or CSV; name the file something.html, \
    .pdf, .json or .csv", path.display())]
    UnknownReport { path: PathBuf },
    #[error(
        "two meshes cannot go to standard output; name a file with -o, and -reverse and -normal \
        are put to its name"
    )]
    TwoToStdout,
    #[error(
        "pictures of the steps cannot go to standard output; name a file with -o, and \
        -after-20.png is put to its name"
    )]
    PicturesToStdout,
    #[error(
        "the studio is not installed; install it from the sources with `cargo install --path \
        crates/kerfold-studio`, which needs Node 20"
    )]
    NoStudio,
    #[error("the studio ended with the error above")]
    StudioFailed,
    #[error("{}: the studio cannot be started: {error}", program.display())]
    StudioNotStarted { program: PathBuf, error: io::Error },
    #[error("stopped; the recipes that were done by then are in their folders")]
    Stopped,
    #[error("writing to standard output: {0}")]
    Stdout(io::Error),
    #[error(
        "`{word}` is no code and no finding; {}`kerfold explain` lists all",
        did_you_mean(nearest.as_deref())
    )]
    NoSuchCode { word: String, nearest: Option<String> },
    #[error("`{word}` is no verb; {}`kerfold help` lists all", did_you_mean(nearest.as_deref()))]
    NoSuchVerb { word: String, nearest: Option<String> },
}

codes!(error CliError {
    UnknownSheetFormat = 1,
    Unreadable = 2,
    Scale = 3,
    NotText = 4,
    NotPng = 5,
    UnknownReport = 6,
    TwoToStdout = 7,
    PicturesToStdout = 8,
    Stdout = 9,
    NoSuchCode = 10,
    NoRecipes = 11,
    UnknownRecipe = 12,
    Gallery = 13,
    Stopped = 14,
    NoStudio = 15,
    NoSuchVerb = 16,
    StudioFailed = 17,
    StudioNotStarted = 18,
} through {
    Io.0,
    Shape.0,
    Op.0,
    Check.0,
    Picture.0,
    Seam.0,
    Limit.0,
    Artwork.error,
    Lint.error,
    Step.0,
    Recipe.error,
    Sweep.error,
    RecipeStep.error,
    Pieces.error,
});

impl CliError {
    /// Whether the reader of our output has gone: then all is well.
    pub(super) fn is_broken_pipe(&self) -> bool {
        match self {
            Self::Stdout(error) => error.kind() == io::ErrorKind::BrokenPipe,
            Self::Io(error) => error.is_broken_pipe(),
            _ => false,
        }
    }
}

impl CliError {
    /// The options that a message of the library speaks of in its own words; a recipe has none.
    pub(super) fn options(&self) -> Option<&'static str> {
        if matches!(self, Self::RecipeStep { .. } | Self::Recipe { .. } | Self::Gallery { .. }) {
            return None;
        }
        match self.code().to_string().as_str() {
            "E236" => Some("--weld 0"),
            "E427" => Some("--effort 50, --seed 2, --pieces auto"),
            "E428" => Some("--pieces auto"),
            "E604" => Some("--edges 0-10:butt"),
            _ => None,
        }
    }
}

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map(|word| format!("did you mean `{word}`? ")).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the library says in words of its own, the command line says with its options.
    #[test]
    fn messages_of_the_library_get_their_options() {
        let error = CliError::Seam(SeamError::Cancelled);
        assert_eq!(error.options(), None);
        let path = std::path::Path::new("fixtures/bad/zero-length-edge.obj");
        let refused = crate::io::read_mesh(path, &crate::io::ReadOptions::default());
        let error = CliError::Io(refused.expect_err("an edge of length zero"));
        assert_eq!(error.options(), Some("--weld 0"));
    }
}
