//! Progress on a terminal, and Ctrl-C.

use std::io::{IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use crate::progress::Progress;

static IS_CANCELLED: AtomicBool = AtomicBool::new(false);
static IS_LINE_OPEN: AtomicBool = AtomicBool::new(false);
static LAST_SHOWN_MS: AtomicU64 = AtomicU64::new(0);
static START: OnceLock<Instant> = OnceLock::new();

/// Nothing is shown before this, and then not more often than the second number.
const FIRST_MS: u64 = 1000;
const EVERY_MS: u64 = 200;

/// The first Ctrl-C asks the work to stop cleanly; the second ends the process. SIGTERM and SIGHUP,
/// as job schedulers and closed terminals send them, count as Ctrl-C.
pub(super) fn watch_for_ctrl_c() {
    START.get_or_init(Instant::now);
    // Without a handler Ctrl-C simply ends the process, which is fine: files are written beside and
    // renamed.
    let _ = ctrlc::set_handler(|| {
        if IS_CANCELLED.swap(true, Ordering::SeqCst) {
            #[allow(clippy::exit)]
            std::process::exit(130);
        }
    });
}

/// Shows progress on standard error when that is a terminal.
#[derive(Debug, Clone, Copy)]
pub(super) struct Terminal {
    is_shown: bool,
}

impl Terminal {
    pub(super) fn new(is_quiet: bool) -> Self {
        Self { is_shown: !is_quiet && std::io::stderr().is_terminal() }
    }
}

impl Progress for Terminal {
    fn report(&self, work: &str, done: usize, total: usize) {
        let now = START.get_or_init(Instant::now).elapsed().as_millis() as u64;
        let last = LAST_SHOWN_MS.load(Ordering::Relaxed);
        if !self.is_shown || now < FIRST_MS || now < last + EVERY_MS {
            return;
        }
        LAST_SHOWN_MS.store(now, Ordering::Relaxed);
        IS_LINE_OPEN.store(true, Ordering::Relaxed);
        let state = if total > 0 { format!("{done} of {total}") } else { done.to_string() };
        let _ = write!(std::io::stderr(), "\r\x1b[K{work}: {state} (Ctrl-C stops)");
    }

    fn is_cancelled(&self) -> bool {
        IS_CANCELLED.load(Ordering::Relaxed)
    }
}

/// Takes the progress line away before anything else is printed.
pub(super) fn clear_progress() {
    if IS_LINE_OPEN.swap(false, Ordering::Relaxed) {
        let _ = write!(std::io::stderr(), "\r\x1b[K");
    }
}
