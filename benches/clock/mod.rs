//! What all benches measure with: processor seconds to the microsecond, and peak memory. Processor
//! time is a fairer figure than the clock on the wall where other programs run.

#![allow(dead_code, reason = "each bench needs its part")]

/// What the program has, too.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

/// Processor seconds of the calling thread.
pub fn thread_seconds() -> f64 {
    seconds(Whose::Thread)
}

/// Processor seconds of the process, all threads.
pub fn process_seconds() -> f64 {
    seconds(Whose::Process)
}

/// The most memory that the process has held, in MB; not a number where the system does not tell.
pub fn peak_megabytes() -> f64 {
    let text = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = text.lines().find(|line| line.starts_with("VmHWM:"));
    let kilobytes = line
        .and_then(|line| line.split_whitespace().nth(1))
        .and_then(|word| word.parse::<f64>().ok());
    kilobytes.map_or(f64::NAN, |k| k / 1024.0)
}

#[derive(Clone, Copy)]
enum Whose {
    Thread,
    Process,
}

#[cfg(unix)]
fn seconds(whose: Whose) -> f64 {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(match whose {
        Whose::Thread => ClockId::ThreadCPUTime,
        Whose::Process => ClockId::ProcessCPUTime,
    });
    time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
}

/// Elsewhere the clock on the wall stands in.
#[cfg(not(unix))]
fn seconds(_: Whose) -> f64 {
    static START: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    START.get_or_init(std::time::Instant::now).elapsed().as_secs_f64()
}
