//! Work without the lock of the interpreter, which Ctrl-C stops.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError, mpsc};
use std::time::Duration;
use std::{panic, thread};

use kerfold::progress::Progress;
use pyo3::prelude::*;

use crate::trouble::fault;

/// How often the thread that waits looks after signals and the hook.
const LOOK: Duration = Duration::from_millis(25);

/// As much as the main thread of a program has, and more than other threads of Python get.
const STACK: usize = 16 << 20;

/// What is called while work goes on: `hook(work, done, total)`.
static HOOK: Mutex<Option<Py<PyAny>>> = Mutex::new(None);

/// Sets the function that is called now and then while work goes on, with the name of the work, the
/// steps done and the steps in all (0 when unknown); None takes it away. What it raises stops the
/// work.
#[pyfunction]
pub(crate) fn on_progress(hook: Option<Py<PyAny>>) {
    *HOOK.lock().unwrap_or_else(PoisonError::into_inner) = hook;
}

#[derive(Default)]
struct Watch {
    is_stopped: AtomicBool,
    news: Mutex<Option<(String, usize, usize)>>,
}

impl Progress for Watch {
    fn report(&self, work: &str, done: usize, total: usize) {
        let mut news = self.news.lock().unwrap_or_else(PoisonError::into_inner);
        *news = Some((work.to_owned(), done, total));
    }

    fn is_cancelled(&self) -> bool {
        self.is_stopped.load(Ordering::Relaxed)
    }
}

impl Watch {
    /// Runs the handlers of signals that came, and tells the hook what is new.
    fn look(&self, py: Python<'_>) -> PyResult<()> {
        py.check_signals()?;
        let news = self.news.lock().unwrap_or_else(PoisonError::into_inner).take();
        let hook = HOOK.lock().unwrap_or_else(PoisonError::into_inner);
        let hook = hook.as_ref().map(|hook| hook.clone_ref(py));
        match (news, hook) {
            (Some(news), Some(hook)) => hook.call1(py, news).map(drop),
            _ => Ok(()),
        }
    }
}

/// Does some work on a thread of its own, while this one waits for it, lets other threads of Python
/// run, and stops it on Ctrl-C or when the progress hook raises something.
///
/// # Errors
/// What the signal handler or the hook raised.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    work: impl FnOnce(&dyn Progress) -> T + Send,
) -> PyResult<T> {
    let watch = Watch::default();
    let result = py.detach(|| {
        thread::scope(|scope| {
            let (done, is_done) = mpsc::channel::<()>();
            let worker = thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || {
                // Dropped in the end, whatever end it is.
                let _done = done;
                work(&watch)
            });
            let worker =
                worker.map_err(|error| fault(&format!("no thread to work on: {error}")))?;
            let mut raised = None;
            while let Err(mpsc::RecvTimeoutError::Timeout) = is_done.recv_timeout(LOOK) {
                if raised.is_none() {
                    raised = Python::attach(|py| watch.look(py)).err();
                    watch.is_stopped.store(raised.is_some(), Ordering::Relaxed);
                }
            }
            let result = worker.join().unwrap_or_else(|panic| panic::resume_unwind(panic));
            raised.map_or(Ok(result), Err)
        })
    });
    // A signal that came after the last look.
    result.and_then(|result| py.check_signals().map(|()| result))
}
