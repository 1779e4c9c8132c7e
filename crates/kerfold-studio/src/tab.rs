//! A tab of a browser: its session, its work, and what it is told.

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use kerfold::progress::Progress;
use kerfold::recipe::{Job, Recipe, Session, StepDraft};
use serde_json::json;
use tokio::sync::broadcast;

use crate::StudioError;
use crate::studio::KEPT;

/// Kinds of work that go on side by side; within one the newest counts and stops the others.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Lane {
    /// The model, and what a step would do to it.
    Model,
    /// How far a slider may go.
    Limit,
    /// Pieces and sheets.
    Result,
    /// Files.
    Export,
}

const LANES: usize = 4;

pub(crate) struct Tab {
    pub id: String,
    session: Mutex<Session>,
    file: Mutex<Option<String>>,
    stops: Mutex<[Arc<AtomicBool>; LANES]>,
    events: broadcast::Sender<String>,
    /// Counts changes, so that the page knows which answer is the newest.
    revision: AtomicU64,
    /// Whether the recipe will be kept soon.
    is_keeping: AtomicBool,
    /// The last job without pieces, and what it was unfolded to.
    unfolded: Mutex<Option<[Arc<Job>; 2]>>,
}

impl Tab {
    pub fn new(id: String, root: &Path) -> Self {
        Self {
            id,
            session: Mutex::new(Session::new(root)),
            file: Mutex::default(),
            stops: Mutex::default(),
            events: broadcast::channel(64).0,
            revision: AtomicU64::new(0),
            is_keeping: AtomicBool::new(false),
            unfolded: Mutex::default(),
        }
    }

    /// The session; held only for moments, never while steps are done.
    pub fn session(&self) -> MutexGuard<'_, Session> {
        self.session.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn file(&self) -> Option<String> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    pub fn set_file(&self, file: Option<String>) {
        *self.file.lock().unwrap_or_else(PoisonError::into_inner) = file;
    }

    pub fn revision(&self) -> u64 {
        self.revision.load(Ordering::Relaxed)
    }

    pub fn events(&self) -> broadcast::Receiver<String> {
        self.events.subscribe()
    }

    /// The recipe has changed: pieces and sheets on their way are not wanted any more, and the
    /// recipe is kept in case that nobody saves it.
    pub fn changed(self: &Arc<Self>) {
        self.revision.fetch_add(1, Ordering::Relaxed);
        self.stop(Lane::Result);
        // A slider in motion changes it fifty times a second; a disk need not follow.
        if !self.is_keeping.swap(true, Ordering::Relaxed) {
            let tab = self.clone();
            tokio::spawn(async move {
                tokio::time::sleep(KEEP_AFTER).await;
                let _ = tokio::task::spawn_blocking(move || tab.keep()).await;
            });
        }
    }

    /// Writes the recipe where it is found again after a reload or a restart.
    pub fn keep(&self) {
        self.is_keeping.store(false, Ordering::Relaxed);
        let (folder, recipe) = {
            let session = self.session();
            (session.folder().join(KEPT), session.recipe().text())
        };
        let kept = std::fs::create_dir_all(&folder).map_err(|e| e.to_string()).and_then(|()| {
            let file = folder.join(format!("{}.toml", self.id));
            kerfold::io::output::write_file(&file, recipe.as_bytes()).map_err(|e| e.to_string())
        });
        if let Err(error) = kept {
            self.tell(&json!({ "warning": format!("the recipe could not be kept: {error}") }));
        }
    }

    /// What the recipe makes after so many steps. With `auto`, a recipe that makes no pieces is
    /// unfolded as by `unfold = "auto"`, or else "one", so that there are sheets to look at.
    pub fn run(
        &self,
        steps: Option<usize>,
        auto: bool,
        progress: &dyn Progress,
    ) -> Result<Arc<Job>, StudioError> {
        let (replay, folder, name) = {
            let mut session = self.session();
            let steps = steps.unwrap_or(session.step_count());
            let name = session.recipe().name;
            (session.replay(steps)?, session.folder().to_owned(), name)
        };
        let (reached, job) = replay.run(progress);
        self.session().keep(&reached);
        let job = job?;
        if !auto || !job.has_mesh() || job.fabrication.is_some() || job.panelled.is_some() {
            return Ok(job);
        }
        if let Some(known) = self.unfolded(&job) {
            return Ok(known);
        }
        let unfold = |pieces: &str| -> Result<Arc<Job>, StudioError> {
            let mut step = Recipe::parse(&StepDraft::new("unfold", pieces).text())?;
            step.name.clone_from(&name);
            Ok(Arc::new(Job::clone(&job).carry_on(&step, &folder, progress)?))
        };
        // Strips that cuts have made need not be pieces that lie flat; then one piece is tried.
        let made = unfold("auto").or_else(|error| {
            if error.is_stopped() { Err(error) } else { unfold("one").map_err(|_| error) }
        })?;
        let mut kept = self.unfolded.lock().unwrap_or_else(PoisonError::into_inner);
        *kept = Some([job, made.clone()]);
        Ok(made)
    }

    /// What a job was unfolded to, if it was the last one.
    fn unfolded(&self, job: &Arc<Job>) -> Option<Arc<Job>> {
        let kept = self.unfolded.lock().unwrap_or_else(PoisonError::into_inner);
        kept.as_ref().filter(|[of, _]| Arc::ptr_eq(of, job)).map(|[_, made]| made.clone())
    }

    fn stop(&self, lane: Lane) -> Arc<AtomicBool> {
        let mut stops = self.stops.lock().unwrap_or_else(PoisonError::into_inner);
        let next = Arc::new(AtomicBool::new(false));
        std::mem::replace(&mut stops[lane as usize], next.clone()).store(true, Ordering::Relaxed);
        next
    }

    /// Stops all work.
    pub fn stop_all(&self) {
        for lane in [Lane::Model, Lane::Limit, Lane::Result, Lane::Export] {
            self.stop(lane);
        }
    }

    fn tell(&self, event: &serde_json::Value) {
        // Nobody needs to listen.
        let _ = self.events.send(event.to_string());
    }
}

/// Shows work to the tab and stops it.
pub(crate) struct Watch {
    tab: Arc<Tab>,
    stop: Arc<AtomicBool>,
    told: Mutex<Instant>,
}

/// How long after a change the recipe is kept, with all changes that came by then.
const KEEP_AFTER: Duration = Duration::from_millis(300);

/// Between two reports of work.
const PAUSE: Duration = Duration::from_millis(100);

impl Progress for Watch {
    fn report(&self, work: &str, done: usize, total: usize) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if told.elapsed() >= PAUSE {
            *told = Instant::now();
            self.tab.tell(&json!({ "work": work, "done": done, "total": total }));
        }
    }

    fn is_cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// Stops the work of a request that nobody waits for any more.
struct Waiting(Arc<AtomicBool>);

impl Drop for Waiting {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}

/// Does work beside the server's own threads. Work of the same lane that is not done yet is stopped
/// and answers [`StudioError::Superseded`], and so is work whose caller has gone.
pub(crate) async fn work<T: Send + 'static>(
    tab: &Arc<Tab>,
    lane: Lane,
    task: impl FnOnce(&Tab, &dyn Progress) -> Result<T, StudioError> + Send + 'static,
) -> Result<T, StudioError> {
    let stop = tab.stop(lane);
    let _waiting = Waiting(stop.clone());
    let (told, tab) = (Mutex::new(Instant::now()), tab.clone());
    let done = tokio::task::spawn_blocking(move || {
        let watch = Watch { tab: tab.clone(), stop, told };
        let result = task(&tab, &watch);
        // An answer that nobody wants is none, be it a success or not.
        if watch.is_cancelled() { Err(StudioError::Superseded) } else { result }
    });
    let result = done.await.map_err(|error| StudioError::BadRequest {
        message: format!("this request met a fault of the studio itself ({error}); report it"),
    })?;
    result.map_err(|e| if e.is_stopped() { StudioError::Superseded } else { e })
}
