//! The work of a session, apart from it.

use std::path::PathBuf;
use std::sync::Arc;

use super::super::job::JobContext;
use super::{Entry, Job, SessionError, Step, StepDraft, StepError, Value};
use crate::mesh::Mesh;
use crate::op::{CutReport, OpContext};
use crate::progress::Progress;
use crate::recipe::OperatorStep;
use crate::select::NewElements;

/// A chain of steps with what it made.
#[derive(Clone)]
pub struct Reached {
    pub(super) context: Arc<JobContext>,
    pub(super) steps: Vec<Arc<Entry>>,
    pub(super) job: Arc<Job>,
}

impl Reached {
    /// How many steps led here.
    pub fn steps(&self) -> usize {
        self.steps.len()
    }

    /// What they made.
    pub fn job(&self) -> &Arc<Job> {
        &self.job
    }
}

/// Steps that are to be done, from the last state that is known on.
pub struct Replay {
    pub(super) folder: PathBuf,
    pub(super) parameters: Arc<[(String, Value)]>,
    pub(super) context: Arc<JobContext>,
    pub(super) steps: Vec<Arc<Entry>>,
    /// How many of them are done, and what they made.
    pub(super) known: usize,
    pub(super) job: Arc<Job>,
}

/// What a step would do.
#[derive(Debug, Clone)]
pub struct Preview {
    /// The mesh as it would be.
    pub mesh: Mesh,
    /// What the step would make.
    pub made: Option<NewElements>,
    /// Of a cut everything about it, such as the elements whose cuts would meet.
    pub cut: Option<CutReport>,
    /// What the user should know, in words.
    pub notes: Vec<String>,
    /// Whether the step would reach what is asked of it.
    pub is_clean: bool,
}

impl Replay {
    /// How many steps are left to do.
    pub fn left(&self) -> usize {
        self.steps.len() - self.known
    }

    /// Does the steps. What was reached is returned even when a later step fails or the user stops,
    /// so that it can be kept ([`super::Session::keep`]).
    pub fn run(&self, progress: &dyn Progress) -> (Vec<Reached>, Result<Arc<Job>, StepError>) {
        let mut job = self.job.clone();
        let mut reached = Vec::new();
        for i in self.known..self.steps.len() {
            let mut next = Job::clone(&job);
            next.begin(&self.context);
            if let Err(error) = next.carry_out(i + 1, &self.steps[i].step, &self.folder, progress) {
                return (reached, Err(error));
            }
            job = Arc::new(next);
            let (context, steps) = (self.context.clone(), self.steps[..=i].to_vec());
            reached.push(Reached { context, steps, job: job.clone() });
        }
        (reached, Ok(job))
    }

    /// What one step more would do, without doing it.
    ///
    /// # Errors
    /// [`SessionError::Step`] when it cannot be read, [`SessionError::NoPreview`] when it changes
    /// no mesh, [`SessionError::Run`] when it, or a step before it, fails.
    pub fn preview(
        &self,
        draft: StepDraft,
        progress: &dyn Progress,
    ) -> (Vec<Reached>, Result<Preview, SessionError>) {
        let number = self.steps.len() + 1;
        let (reached, job) = self.run(progress);
        let preview = || {
            let (entry, job) = (Entry::read(number, draft, &self.parameters)?, job?);
            preview(number, &entry.step, &job, &self.folder, progress)
        };
        (reached, preview())
    }
}

fn preview(
    number: usize,
    step: &Step,
    job: &Job,
    folder: &std::path::Path,
    progress: &dyn Progress,
) -> Result<Preview, SessionError> {
    let verb = step.verb();
    let failed =
        |cause| SessionError::Run(StepError { step: number, verb, cause: Box::new(cause) });
    if let Step::Operator(OperatorStep { params, .. }) = step {
        let mesh = job.mesh().map_err(failed)?;
        let context = OpContext { made: job.made(), progress };
        if let Some(cut) = params.cut(mesh, &context) {
            let (mesh, report) = cut.map_err(|error| failed(error.into()))?;
            let notes = report.notes(verb.trim_start_matches("cut "));
            let made = Some(report.made.clone());
            return Ok(Preview { mesh, made, cut: Some(report), notes, is_clean: true });
        }
    }
    if !matches!(step, Step::Operator(_) | Step::Solid(_) | Step::Hull(_)) {
        return Err(SessionError::NoPreview { verb });
    }
    let mut next = job.clone();
    let (notes, unclean) = (next.notes.len(), next.with_findings.len());
    next.carry_out(number, step, folder, progress)?;
    Ok(Preview {
        mesh: next.mesh().map_err(failed)?.clone(),
        made: next.made().cloned(),
        cut: None,
        notes: next.notes.split_off(notes),
        is_clean: next.with_findings.len() <= unclean,
    })
}
