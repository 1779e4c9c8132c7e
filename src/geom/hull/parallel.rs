//! Filling a table on all processors; the result never depends on their number.

/// Below this many values a thread costs more than it saves.
const WORTH_A_THREAD: usize = 1 << 14;

/// Sets every value of `out` to `make(its index)`.
pub(super) fn fill<T: Send>(out: &mut [T], make: impl Fn(usize) -> T + Sync) {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get()).min(out.len() / WORTH_A_THREAD + 1);
    let share = out.len().div_ceil(threads).max(1);
    let run = |start: usize, part: &mut [T]| {
        for (i, value) in part.iter_mut().enumerate() {
            *value = make(start + i);
        }
    };
    if threads == 1 {
        return run(0, out);
    }
    std::thread::scope(|scope| {
        for (k, part) in out.chunks_mut(share).enumerate() {
            let run = &run;
            scope.spawn(move || run(k * share, part));
        }
    });
}
