//! The gallery: many recipes at once, each with its picture and its facts, on one page.
//!
//! The bundled recipes make the figures of the papers; a user's own folder of recipes can be shown
//! in the same way. Recipes are built side by side, and what each makes is the same as that of
//! `kerfold run`.

mod bundle;
mod page;

use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

pub use self::bundle::{BundledFile, bundled, bundled_recipe, unpacked};
pub use self::page::{gallery_html, gallery_markdown};

use crate::code::{Code, Coded};
use crate::make::{MakeError, Output};
use crate::progress::Progress;
use crate::recipe::{Job, Recipe, RecipeError, StepError, job_outputs};

/// A recipe to be shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GalleryRecipe {
    /// Its name, which is that of its folder in the gallery, such as `gonen-fig-05-global-cut`.
    pub name: String,
    /// The TOML text.
    pub text: String,
    /// Where the relative file names in it start from.
    pub folder: PathBuf,
}

/// What is said about a recipe that was built.
#[derive(Debug, Clone, PartialEq)]
pub struct Exhibit {
    /// The name of its folder.
    pub name: String,
    /// The title that the recipe gives itself, or else its name.
    pub title: String,
    /// The comment at the head of the recipe, which says what it shows, line by line.
    pub story: Vec<String>,
    /// The TOML text.
    pub recipe: String,
    /// Numbers of vertices, edges, faces, components and handles; none for a recipe that only
    /// nests.
    pub model: Option<ModelFacts>,
    /// Number of pieces, and of sheets, once something was unfolded, panelled or nested.
    pub pieces: Option<(usize, usize)>,
    /// The picture of the page: the story where the recipe tells one, else the model, else the
    /// first sheet.
    pub picture: &'static str,
    /// What the check found: one message each; empty when the recipe asked for none.
    pub findings: Vec<String>,
}

/// The pictures of a recipe, the one that tells most first.
const PICTURES: [&str; 3] = [STORY, "model.png", "sheet-01.png"];

/// Several pictures side by side.
const STORY: &str = "story.png";

/// Facts of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelFacts {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces.
    pub faces: usize,
    /// Number of connected parts.
    pub components: usize,
    /// Number of handles of all parts.
    pub genus: usize,
    /// Largest distance of a corner from the plane of its face, in mm.
    pub planarity_mm: f64,
    /// The largest extent of the model, in mm.
    pub size_mm: f64,
}

/// Why a recipe could not be shown.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GalleryError {
    /// The recipe cannot be read.
    #[error("{name}: {error}")]
    Recipe {
        /// Its name.
        name: String,
        /// What is wrong.
        error: Box<RecipeError>,
    },
    /// A step failed.
    #[error("{name}: {error}")]
    Step {
        /// Its name.
        name: String,
        /// Which, and why.
        error: StepError,
    },
    /// The result cannot be drawn or written.
    #[error("{name}: {error}")]
    Output {
        /// Its name.
        name: String,
        /// What is wrong.
        error: Box<MakeError>,
    },
}

impl Coded for GalleryError {
    fn code(&self) -> Code {
        match self {
            Self::Recipe { error, .. } => error.code(),
            Self::Step { error, .. } => error.code(),
            Self::Output { error, .. } => error.code(),
        }
    }
}

/// Builds one recipe: what is said about it, and its files. `width` is that of its pictures in
/// pixels, instead of what the recipe says.
///
/// # Errors
/// [`GalleryError`] with the name of the recipe.
pub fn exhibit(
    recipe: &GalleryRecipe,
    width: Option<u32>,
    progress: &dyn Progress,
) -> Result<(Exhibit, Vec<Output>), GalleryError> {
    let name = || recipe.name.clone();
    let parsed = Recipe::parse(&recipe.text)
        .map_err(|error| GalleryError::Recipe { name: name(), error: Box::new(error) })?;
    let mut job = Job::run(&parsed, &recipe.folder, progress)
        .map_err(|error| GalleryError::Step { name: name(), error })?;
    if let Some(width) = width {
        (job.render.width, job.render.height) = (width, None);
    }
    let failed = |error| GalleryError::Output { name: name(), error: Box::new(error) };
    let command = format!("kerfold run {0}.toml -o {0}", recipe.name);
    let outputs = job_outputs(&job, &command).map_err(failed)?;
    let report = if job.has_mesh() { Some(job.report().map_err(failed)?) } else { None };
    let findings = report.iter().filter(|_| job.is_check_asked).flat_map(|r| &r.findings);
    let made = job
        .fabrication
        .as_ref()
        .map(|(f, _)| f)
        .or(job.panelled.as_ref().map(|(p, _)| &p.fabrication));
    let has = |picture: &&str| outputs.iter().any(|(name, _)| name == picture);
    let exhibit = Exhibit {
        name: name(),
        picture: PICTURES.into_iter().find(has).unwrap_or(PICTURES[1]),
        title: parsed.name.unwrap_or_else(name),
        story: story(&recipe.text),
        recipe: recipe.text.clone(),
        findings: job
            .with_findings
            .iter()
            .map(ToString::to_string)
            .chain(findings.map(|f| f.message.clone()))
            .collect(),
        model: report.as_ref().map(|r| ModelFacts {
            vertices: r.model.vertices,
            edges: r.model.edges,
            faces: r.model.faces,
            components: r.model.components,
            genus: r.model.genus,
            planarity_mm: r.worst.mm,
            size_mm: r.model.size_mm.max_element(),
        }),
        pieces: made.map(|f| (f.net.pieces.len(), f.sheets.drawings.len())),
    };
    Ok((exhibit, outputs))
}

/// The comment at the head of a recipe.
fn story(text: &str) -> Vec<String> {
    let lines = text.lines().map_while(|line| line.strip_prefix('#'));
    lines.map(|line| line.trim().to_owned()).filter(|line| !line.is_empty()).collect()
}

/// Does some work for each recipe, on all processors, and returns the results in the order of the
/// recipes.
pub fn side_by_side<T: Send>(
    recipes: &[GalleryRecipe],
    progress: &dyn Progress,
    work: &(dyn Fn(&GalleryRecipe, &dyn Progress) -> T + Sync),
) -> Vec<T> {
    let done = AtomicUsize::new(0);
    let run = |recipe: &GalleryRecipe| {
        let result = work(recipe, &Inside(progress));
        progress.report("recipes", done.fetch_add(1, Ordering::Relaxed) + 1, recipes.len());
        result
    };
    recipes.par_iter().with_max_len(1).map(run).collect()
}

/// The progress of one recipe among many: it can be stopped, but its own steps are not reported.
struct Inside<'a>(&'a dyn Progress);

impl Progress for Inside<'_> {
    fn report(&self, _work: &str, _done: usize, _total: usize) {}

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}
