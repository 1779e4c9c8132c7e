//! A recipe in the making: steps are put to it, changed and taken away, and only what follows a
//! change is done again. It knows no window and no network; the studio is one of its users.
//!
//! A [`Session`] holds the steps with their history and remembers what they made. The work itself
//! is a [`Replay`], which needs the session only before and after: so a newer value can be set
//! while the older one is still being worked out, and stop it through [`Progress`].

mod cache;
mod error;
mod replay;

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::sync::Arc;

pub use error::SessionError;
pub use replay::{Preview, Reached, Replay};

use super::job::JobContext;
use super::{Job, RecipeDraft, RecipeError, Step, StepDraft, StepError, Value};
use crate::progress::Progress;
use cache::Cache;

/// A step with what it stands for. Whether two are the same is a question of their address.
#[derive(Debug)]
pub(super) struct Entry {
    pub draft: StepDraft,
    pub step: Step,
}

impl Entry {
    fn read(
        number: usize,
        draft: StepDraft,
        parameters: &[(String, Value)],
    ) -> Result<Arc<Self>, SessionError> {
        let step = draft.read(parameters).map_err(|error| SessionError::Step {
            step: number,
            key: error.at().and_then(|at| draft.key_in_line(at.line)).map(str::to_owned),
            error: Box::new(error),
        })?;
        Ok(Arc::new(Self { draft, step }))
    }
}

/// The recipe at one moment. A copy shares its steps.
#[derive(Debug, Clone, Default)]
struct Version {
    name: Option<String>,
    parameters: Arc<[(String, Value)]>,
    steps: Vec<Arc<Entry>>,
}

/// How many changes can be undone.
const MOST_CHANGES: usize = 200;

/// A recipe with its history, and what its steps have made so far.
pub struct Session {
    folder: PathBuf,
    now: Version,
    undo: Vec<Version>,
    redo: Vec<Version>,
    /// The value that is being dragged: its step, its key, and the gesture.
    drag: Option<(usize, String, u64)>,
    cache: Cache,
    /// What the recipe as a whole says of the states in the cache.
    context: Arc<JobContext>,
}

impl Session {
    /// An empty recipe; files that its steps name are looked for from `folder`.
    pub fn new(folder: &Path) -> Self {
        Self {
            folder: folder.to_owned(),
            now: Version::default(),
            undo: Vec::new(),
            redo: Vec::new(),
            drag: None,
            cache: Cache::default(),
            context: Arc::default(),
        }
    }

    /// Takes over a recipe; what there was can be had back by [`Self::undo`].
    ///
    /// # Errors
    /// As [`super::Recipe::parse`]; the recipe is then as it was.
    pub fn open(&mut self, text: &str) -> Result<(), RecipeError> {
        let draft = RecipeDraft::parse(text)?;
        let draft_parameters: Arc<[(String, Value)]> = draft.parameters.into();
        let read = |draft: StepDraft| {
            let step = draft.read(&draft_parameters)?;
            Ok(Arc::new(Entry { draft, step }))
        };
        let steps = draft.steps.into_iter().map(read).collect::<Result<Vec<_>, RecipeError>>()?;
        self.change(Version { name: draft.name, parameters: draft_parameters.clone(), steps });
        // Files that it reads may be others by now.
        self.cache = Cache::default();
        Ok(())
    }

    /// The recipe as it stands.
    pub fn recipe(&self) -> RecipeDraft {
        let steps = self.now.steps.iter().map(|entry| entry.draft.clone()).collect();
        RecipeDraft { name: self.now.name.clone(), parameters: self.now.parameters.to_vec(), steps }
    }

    /// How many steps there are.
    pub fn step_count(&self) -> usize {
        self.now.steps.len()
    }

    /// The folder from which files are named.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Gives the recipe a name, or takes it away.
    pub fn rename(&mut self, name: Option<String>) {
        self.change(Version { name, ..self.now.clone() });
    }

    /// Puts a step to the recipe so that it is the one with the number `at`, from 1; without a
    /// number it comes last. Returns its number.
    ///
    /// # Errors
    /// [`SessionError::NoSuchStep`], or [`SessionError::Step`] for a step that cannot be read;
    /// nothing is changed then.
    pub fn apply(&mut self, draft: StepDraft, at: Option<usize>) -> Result<usize, SessionError> {
        let at = at.unwrap_or(self.step_count() + 1);
        if at == 0 || at > self.step_count() + 1 {
            return Err(self.no_such(at));
        }
        let entry = Entry::read(at, draft, &self.now.parameters)?;
        let mut next = self.now.clone();
        next.steps.insert(at - 1, entry);
        self.change(next);
        Ok(at)
    }

    /// Sets a key of a step, or takes it away so that its default counts. Calls with the same
    /// number of a gesture are one change for [`Self::undo`]: a slider that is dragged.
    ///
    /// # Errors
    /// As [`Self::apply`].
    pub fn set(
        &mut self,
        step: usize,
        key: &str,
        value: Option<Value>,
        gesture: Option<u64>,
    ) -> Result<(), SessionError> {
        let entry = self.entry(step)?;
        let mut draft = entry.draft.clone();
        draft.set(key, value);
        if draft == entry.draft {
            return Ok(());
        }
        let entry = Entry::read(step, draft, &self.now.parameters)?;
        let mut next = self.now.clone();
        next.steps[step - 1] = entry;
        let drag = gesture.map(|gesture| (step, key.to_owned(), gesture));
        if drag.is_some() && drag == self.drag {
            self.now = next;
        } else {
            self.change(next);
        }
        self.drag = drag;
        Ok(())
    }

    /// Gives a parameter of the recipe a value; steps that use it are read anew.
    ///
    /// # Errors
    /// [`SessionError::Step`] for a step that cannot be read with it; nothing is changed then.
    pub fn set_parameter(&mut self, name: &str, value: Value) -> Result<(), SessionError> {
        let mut parameters = self.now.parameters.to_vec();
        match parameters.iter_mut().find(|(known, _)| known == name) {
            Some((_, old)) => *old = value,
            None => parameters.push((name.to_owned(), value)),
        }
        let mut next = Version { parameters: parameters.into(), ..self.now.clone() };
        for (i, entry) in next.steps.iter_mut().enumerate() {
            if entry.draft.text().contains('{') {
                *entry = Entry::read(i + 1, entry.draft.clone(), &next.parameters)?;
            }
        }
        self.change(next);
        Ok(())
    }

    /// Takes a step away.
    ///
    /// # Errors
    /// [`SessionError::NoSuchStep`].
    pub fn remove(&mut self, step: usize) -> Result<(), SessionError> {
        self.entry(step)?;
        let mut next = self.now.clone();
        next.steps.remove(step - 1);
        self.change(next);
        Ok(())
    }

    /// Takes the last change back; `false` when there is none.
    pub fn undo(&mut self) -> bool {
        self.drag = None;
        let Some(before) = self.undo.pop() else { return false };
        self.redo.push(std::mem::replace(&mut self.now, before));
        true
    }

    /// Makes the change again that was taken back last; `false` when there is none.
    pub fn redo(&mut self) -> bool {
        self.drag = None;
        let Some(next) = self.redo.pop() else { return false };
        self.undo.push(std::mem::replace(&mut self.now, next));
        true
    }

    /// Whether there is something to undo and to redo.
    pub fn can_undo_redo(&self) -> [bool; 2] {
        [!self.undo.is_empty(), !self.redo.is_empty()]
    }

    /// Forgets what the steps have made, because files that they read have changed.
    pub fn forget(&mut self) {
        self.cache = Cache::default();
    }

    /// The work that leads to the state after so many steps; what is known is not done again.
    ///
    /// # Errors
    /// [`SessionError::NoSuchStep`].
    pub fn replay(&mut self, steps: usize) -> Result<Replay, SessionError> {
        let wanted = self.now.steps.get(..steps).ok_or_else(|| self.no_such(steps))?.to_vec();
        let all = self.now.steps.iter().map(|entry| &entry.step);
        let context = JobContext::of(self.now.name.as_deref(), all);
        if context != *self.context {
            // The name stands on sheets, and so no state is what it would be.
            (self.context, self.cache) = (Arc::new(context), Cache::default());
        }
        let (known, job) = self.cache.longest(&wanted);
        let context = self.context.clone();
        let (folder, parameters) = (self.folder.clone(), self.now.parameters.clone());
        Ok(Replay { folder, parameters, context, steps: wanted, known, job })
    }

    /// Remembers what a replay has reached, be it to its end or not.
    pub fn keep(&mut self, reached: &[Reached]) {
        // What was begun under another name is not what it would be now.
        let is_of_now = |one: &&Reached| Arc::ptr_eq(&one.context, &self.context);
        reached.iter().filter(is_of_now).for_each(|one| self.cache.keep(one.clone()));
    }

    /// Runs the recipe up to so many steps: a [`Self::replay`] that is kept.
    ///
    /// # Errors
    /// [`SessionError::NoSuchStep`], or [`SessionError::Run`]: the first step that fails.
    pub fn run(&mut self, steps: usize, progress: &dyn Progress) -> Result<Arc<Job>, SessionError> {
        let replay = self.replay(steps)?;
        let (reached, result) = replay.run(progress);
        self.keep(&reached);
        Ok(result?)
    }

    fn change(&mut self, next: Version) {
        self.undo.push(std::mem::replace(&mut self.now, next));
        if self.undo.len() > MOST_CHANGES {
            self.undo.remove(0);
        }
        self.redo.clear();
        self.drag = None;
    }

    fn entry(&self, step: usize) -> Result<&Arc<Entry>, SessionError> {
        let entry = step.checked_sub(1).and_then(|i| self.now.steps.get(i));
        entry.ok_or_else(|| self.no_such(step))
    }

    fn no_such(&self, step: usize) -> SessionError {
        SessionError::NoSuchStep { step, steps: self.step_count() }
    }
}
