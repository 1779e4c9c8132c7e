//! Carries out a recipe: one mesh on its way from a solid or a file to sheets.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::{Before, OperatorStep, ReadStep, Recipe, Step, StepError, StoryParams};
use crate::check::{CheckParams, Report, check};
use crate::io::{ReadMesh, read_mesh, size_note};
use crate::make::{
    DformError, DformParams, FabricateParams, FabricateSettings, Fabrication, MakeError, Moment,
    OutlineParams, OutlinesError, PanelFiles, PanelJob, Panelled, PiecePromise, PointOut,
    ShowParams, carve_dform_for_sheet, fabricate, height_mesh, nest_files, operate, outlined_dform,
    panel_model, solid_of_planes, with_material,
};
use crate::mesh::{Mesh, SplitVertex};
use crate::op::{ChosenElements, HullParams, HullStep, OpContext, OpError, hull};
use crate::panel::PanelParams;
use crate::picture::RenderParams;
use crate::progress::Progress;
use crate::select::{NewElements, Selection};
use crate::shape::solid;
use crate::sheet::SheetParams;
use crate::unfold::{MeshSource, PiecesMode, UnfoldParams};

/// An operator of a recipe that did not reach what was asked for; the notes say what is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StepWithFindings {
    /// The number of the step, from 1.
    pub step: usize,
    /// Its verb.
    pub verb: &'static str,
}

impl fmt::Display for StepWithFindings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "step {} ({}) has findings, see its notes", self.step, self.verb)
    }
}

/// What a recipe as a whole says of every step.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct JobContext {
    /// The name of the recipe, which stands on its sheets.
    title: String,
    /// Which steps are kept to be shown.
    keeps: Keeps,
}

/// Which steps a job keeps to be shown.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
enum Keeps {
    #[default]
    None,
    Last,
    All,
}

impl JobContext {
    pub(super) fn of<'a>(name: Option<&str>, steps: impl Iterator<Item = &'a Step>) -> Self {
        let keeps = steps.map(|s: &Step| match s {
            Step::Render { story, .. } if !story.story.is_empty() => Keeps::All,
            Step::Render { story, .. } if story.before == Before::On => Keeps::Last,
            _ => Keeps::None,
        });
        let keeps = keeps.max().unwrap_or_default();
        Self { title: name.unwrap_or_default().to_owned(), keeps }
    }
}

/// What a recipe has made so far. A copy shares the mesh, so that the states between the steps can
/// be kept.
#[derive(Clone, Default)]
pub struct Job {
    /// The name of the recipe, which stands on its sheets.
    title: String,
    mesh: Option<Arc<Mesh>>,
    /// The factor from the numbers of the file that the mesh came from to millimetres.
    scale: Option<f64>,
    made: Option<NewElements>,
    /// Into how many pieces the strips of the last cut come apart, as the edges promised.
    promised: Option<PiecePromise>,
    /// What the user should know, in order.
    pub notes: Vec<String>,
    /// Operators that did not reach what was asked for, as far as no later step mends it.
    pub with_findings: Vec<StepWithFindings>,
    /// How the picture of the model looks.
    pub render: RenderParams,
    /// What the picture points out.
    pub point_out: PointOut,
    /// What else is shown.
    pub story: StoryParams,
    /// The operators with the meshes before and after them, as far as the recipe shows them.
    pub moments: Vec<Moment>,
    keeps: Keeps,
    /// What of the mesh is worst by the measure of the operator that made it.
    pub(super) worst: ChosenElements,
    /// The dual hull on its way, as the last hull was asked for.
    pub hull_steps: Vec<HullStep>,
    /// Limits for the report.
    pub check: CheckParams,
    /// Whether the recipe asked for a check, so that findings count.
    pub is_check_asked: bool,
    /// What is made to be looked at, once unfolded.
    pub show: ShowParams,
    /// Pieces and sheets, once unfolded, with how the sheets are drawn.
    pub fabrication: Option<(Fabrication, SheetParams)>,
    /// Plates, once panelled, with how their sheets are drawn.
    pub panelled: Option<(Panelled, SheetParams)>,
}

impl Job {
    /// Runs all steps. `folder` is where relative file names of the recipe start from.
    ///
    /// # Errors
    /// [`StepError`]: the first step that fails, with its number.
    pub fn run(recipe: &Recipe, folder: &Path, progress: &dyn Progress) -> Result<Self, StepError> {
        Self::default().carry_on(recipe, folder, progress)
    }

    /// A job that begins with a mesh of the caller instead of a first step that makes one. Its ids
    /// are closed up, so that they are those of the model that will be written.
    pub fn with_mesh(mut mesh: Mesh, notes: Vec<String>) -> Self {
        mesh.compact();
        Self { mesh: Some(Arc::new(mesh)), notes, ..Self::default() }
    }

    /// Runs the steps of a recipe on what there is.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn carry_on(
        mut self,
        recipe: &Recipe,
        folder: &Path,
        progress: &dyn Progress,
    ) -> Result<Self, StepError> {
        self.begin(&JobContext::of(recipe.name.as_deref(), recipe.steps.iter()));
        for (i, step) in recipe.steps.iter().enumerate() {
            self.carry_out(i + 1, step, folder, progress)?;
        }
        Ok(self)
    }

    /// Takes over what the whole recipe says of every step.
    pub(super) fn begin(&mut self, context: &JobContext) {
        self.title.clone_from(&context.title);
        self.keeps = context.keeps;
    }

    /// Carries out one step; `number` is its place in the recipe, from 1.
    pub(super) fn carry_out(
        &mut self,
        number: usize,
        step: &Step,
        folder: &Path,
        progress: &dyn Progress,
    ) -> Result<(), StepError> {
        self.step(number, step, folder, progress).map_err(|cause| StepError {
            step: number,
            verb: step.verb(),
            cause: Box::new(cause),
        })
    }

    /// The job with the gaps in the ids of its mesh closed up, so that ids are those of a file of
    /// it, and of arrays.
    #[must_use]
    pub fn closed_up(mut self) -> Self {
        if let Some(mesh) = self.mesh.as_mut()
            && has_gaps(mesh)
        {
            let mesh = Arc::make_mut(mesh);
            match self.made.as_mut() {
                Some(made) => drop(made.compact(mesh)),
                None => drop(mesh.compact()),
            }
        }
        self
    }

    /// The mesh as it is by now.
    ///
    /// # Errors
    /// [`MakeError::NoMesh`] before the first step.
    pub fn mesh(&self) -> Result<&Mesh, MakeError> {
        self.mesh.as_deref().ok_or(MakeError::NoMesh)
    }

    /// What the last step made, for the selections `made` and `strip` of the next one.
    pub fn made(&self) -> Option<&NewElements> {
        self.made.as_ref()
    }

    /// Whether there is a mesh; a job that only nests pieces has none.
    pub fn has_mesh(&self) -> bool {
        self.mesh.is_some()
    }

    /// The report on the mesh as it is by now.
    ///
    /// # Errors
    /// [`MakeError::NoMesh`], or [`MakeError::Check`] for a limit that is none.
    pub fn report(&self) -> Result<Report, MakeError> {
        Ok(check(self.mesh()?, &self.check)?)
    }

    fn step(
        &mut self,
        number: usize,
        step: &Step,
        folder: &Path,
        progress: &dyn Progress,
    ) -> Result<(), MakeError> {
        if progress.is_cancelled() {
            return Err(OpError::Cancelled.into());
        }
        match step {
            Step::Solid(params) => self.start(solid(params)?)?,
            Step::Height(params) => {
                let (mesh, notes) = height_mesh(params, folder)?;
                self.notes.extend(notes);
                self.scale = Some(params.domain.unit_mm());
                self.start(mesh)?;
            }
            Step::Read(read) => self.read(read, folder)?,
            Step::Planes(planes) => {
                let params = HullParams { simple: planes.simple, ..HullParams::default() };
                let path = folder.join(&planes.path);
                let (mesh, report) = solid_of_planes(&path, &params, progress)?;
                self.notes.extend(report.notes());
                self.start(mesh)?;
            }
            Step::Operator(operator) => self.operator(number, operator, folder, progress)?,
            Step::Hull(params) => self.hull(params, progress)?,
            Step::Check(params) => (self.check, self.is_check_asked) = (params.clone(), true),
            Step::Render { render, point_out, story } => {
                (self.render, self.point_out) = (render.clone(), point_out.clone());
                self.story = story.clone();
            }
            Step::Dform { dform, outlines, sheet, show } => {
                self.show = show.clone();
                let sheet = self.sheet(sheet, folder)?;
                if outlines.is_given() {
                    no_carving(dform)?;
                    self.outlines(outlines, folder, sheet, progress)?;
                } else {
                    no_stray_option(outlines)?;
                    self.dform(dform, &sheet, progress)?;
                }
            }
            Step::Unfold { unfold, fabricate, sheet, show } => {
                self.show = show.clone();
                self.unfold(unfold, fabricate, &self.sheet(sheet, folder)?, folder, progress)?;
            }
            Step::Panels { panels, files, sheet } => {
                self.panels(panels, files, &self.sheet(sheet, folder)?, progress)?
            }
            Step::Nest { nest, sheet } => {
                let sheet = self.sheet(sheet, folder)?;
                let fabrication = nest_files(nest, &sheet, folder, progress)?;
                self.notes.extend(fabrication.notes());
                self.fabrication = Some((fabrication, sheet));
            }
        }
        Ok(())
    }

    fn read(&mut self, read: &ReadStep, folder: &Path) -> Result<(), MakeError> {
        let path: PathBuf = folder.join(&read.path);
        let ReadMesh { mut mesh, notes, made, scale, .. } = read_mesh(&path, &read.options)?;
        self.scale = Some(scale);
        let notes = notes.into_iter().chain(size_note(&mesh, &read.options));
        self.notes.extend(notes.map(|note| note.to_string()));
        // From here on ids are those of the model.obj that will be written.
        self.made = made.map(|mut made| {
            made.compact(&mut mesh);
            made
        });
        mesh.compact();
        self.start(mesh)?;
        Ok(())
    }

    fn operator(
        &mut self,
        number: usize,
        OperatorStep { verb, params }: &OperatorStep,
        folder: &Path,
        progress: &dyn Progress,
    ) -> Result<(), MakeError> {
        let context = OpContext { made: self.made.as_ref(), progress };
        let scale = self.scale.unwrap_or(1.0);
        let output = operate(params.as_ref(), (folder, scale), self.mesh()?, &context)?;
        self.notes.extend(output.notes);
        // To planarize again is how to mend faces that did not become planar.
        self.with_findings.retain(|u| u.verb != "planarize" || *verb != "planarize");
        if !output.is_clean {
            self.with_findings.push(StepWithFindings { step: number, verb });
        }
        let cut = (&output.chosen.edges[..], self.made.as_ref());
        self.promised = PiecePromise::of(self.mesh()?, cut, self.promised);
        self.change(verb, output.chosen, output.mesh, output.made);
        self.worst = output.worst;
        Ok(())
    }

    /// Puts another mesh in the place of the one that there is.
    fn change(
        &mut self,
        verb: &'static str,
        chosen: ChosenElements,
        after: Mesh,
        made: Option<NewElements>,
    ) {
        let after = Arc::new(after);
        if self.keeps <= Keeps::Last {
            self.moments.clear();
        }
        if let Some(before) = self.mesh.take().filter(|_| self.keeps > Keeps::None) {
            let (after, made) = (after.clone(), made.clone());
            self.moments.push(Moment { verb, before, chosen, after, made });
        }
        (self.mesh, self.made) = (Some(after), made);
        self.worst = ChosenElements::default();
    }

    fn hull(&mut self, params: &HullParams, progress: &dyn Progress) -> Result<(), MakeError> {
        let (mesh, report) = hull(self.mesh()?, params, &OpContext { made: None, progress })?;
        self.notes.extend(report.notes());
        self.hull_steps = report.steps;
        // The hull is a solid of its own, whatever its corners came from.
        self.with_findings.clear();
        self.promised = None;
        self.change("hull", ChosenElements::default(), mesh, None);
        Ok(())
    }

    /// Sheet parameters with what their material decides, and the name of the recipe.
    fn sheet(&self, sheet: &SheetParams, folder: &Path) -> Result<SheetParams, MakeError> {
        Ok(with_material(sheet, folder)?.titled(&self.title))
    }

    fn start(&mut self, mesh: Mesh) -> Result<(), MakeError> {
        if self.mesh.is_some() {
            return Err(MakeError::SecondMesh);
        }
        self.mesh = Some(Arc::new(mesh));
        Ok(())
    }

    fn dform(
        &mut self,
        params: &DformParams,
        sheet: &SheetParams,
        progress: &dyn Progress,
    ) -> Result<(), MakeError> {
        let carved = carve_dform_for_sheet(self.mesh()?, params, sheet, progress)?;
        self.notes.extend(carved.notes);
        let chosen = ChosenElements { edges: carved.chosen, ..ChosenElements::default() };
        self.change("dform", chosen, carved.mesh, Some(carved.made));
        let folds = FabricateParams {
            folds: Selection::of_edges(carved.folds.iter().copied()),
            ..FabricateParams::default()
        };
        self.promised = None;
        self.unfold(&UnfoldParams::default(), &folds, sheet, Path::new(""), progress)
    }

    fn outlines(
        &mut self,
        params: &OutlineParams,
        folder: &Path,
        sheet: SheetParams,
        progress: &dyn Progress,
    ) -> Result<(), MakeError> {
        let made = outlined_dform(params, folder, &sheet, progress)?;
        self.start(made.mesh)?;
        self.notes.extend(made.notes);
        (self.fabrication, self.panelled) = (Some((made.fabrication, sheet)), None);
        Ok(())
    }

    /// Panels take the place of pieces unfolded before, since both would go to the same files.
    fn panels(
        &mut self,
        params: &PanelParams,
        files: &PanelFiles,
        sheet: &SheetParams,
        progress: &dyn Progress,
    ) -> Result<(), MakeError> {
        let source = MeshSource { scale: 1.0, split_vertices: &[] };
        let panelled = panel_model(
            self.mesh()?,
            PanelJob { panels: params, files, sheet },
            &source,
            progress,
        )?;
        self.notes.extend(panelled.notes());
        (self.panelled, self.fabrication) = (Some((panelled, sheet.clone())), None);
        Ok(())
    }

    fn unfold(
        &mut self,
        unfold: &UnfoldParams,
        choice: &FabricateParams,
        sheet: &SheetParams,
        folder: &Path,
        progress: &dyn Progress,
    ) -> Result<(), MakeError> {
        let splits: &[SplitVertex] = &[];
        let source = MeshSource { scale: 1.0, split_vertices: splits };
        let choice = choice.in_folder(folder);
        let fabrication = fabricate(
            self.mesh()?,
            self.made.as_ref(),
            &FabricateSettings { unfold, choice: &choice, sheet },
            &source,
            progress,
        )?;
        let made = fabrication.net.pieces.len();
        let is_meant = choice.is_of_strips() && unfold.pieces == PiecesMode::Auto;
        if let Some(PiecePromise { pieces: promised, is_perfect }) = self.promised
            && promised != made
            && is_meant
            && fabrication.divided == 0
            && (is_perfect || fabrication.is_of_given_folds())
        {
            return Err(DformError::BrokenPromise { promised, made }.into());
        }
        self.notes.extend(fabrication.notes());
        (self.fabrication, self.panelled) = (Some((fabrication, sheet.clone())), None);
        Ok(())
    }
}

fn has_gaps(mesh: &Mesh) -> bool {
    mesh.vertex_slots() > mesh.vertex_count()
        || mesh.edge_slots() > mesh.edge_count()
        || mesh.face_slots() > mesh.face_count() + mesh.hole_count()
}

/// Options of outlines mean nothing for a D-form of a solid.
fn no_stray_option(outlines: &OutlineParams) -> Result<(), MakeError> {
    match outlines.without_outlines() {
        None => Ok(()),
        Some(option) => Err(OutlinesError::Options {
            what: format!("`{option}` is given without outlines"),
            advice: "name outlines or a gluing file, or leave it out",
        }
        .into()),
    }
}

/// Folds are carved on solids; outlines have none.
fn no_carving(dform: &DformParams) -> Result<(), MakeError> {
    if *dform == DformParams::default() {
        return Ok(());
    }
    Err(OutlinesError::Options {
        what: "options that carve folds are given with outlines".to_owned(),
        advice: "outlines are joined as they are: leave out everything that is for solids",
    }
    .into())
}
