//! Filling and sorting tables on all processors; the result never depends on their number.

/// Below this many values a thread costs more than it saves.
const WORTH_A_THREAD: usize = 1 << 14;

/// Sets every value of `out` to `make(its index)`.
pub(super) fn fill<T: Send>(out: &mut [T], make: impl Fn(usize) -> T + Sync) {
    in_shares(out, |start, part| part.iter_mut().enumerate().for_each(|(i, value)| *value = make(start + i)));
}

/// Sorts keys that all differ.
pub(super) fn sort(keys: &mut [u64]) {
    let share = in_shares(keys, |_, part| part.sort_unstable());
    // Sorted shares are runs that this sort finds and merges.
    if share < keys.len() {
        keys.sort();
    }
}

/// Runs `work` on equal shares of `values`, each with the index of its first; returns the length of a share.
fn in_shares<T: Send>(values: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) -> usize {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get()).min(values.len() / WORTH_A_THREAD + 1);
    let share = values.len().div_ceil(threads).max(1);
    if threads == 1 {
        work(0, values);
        return share;
    }
    std::thread::scope(|scope| {
        for (k, part) in values.chunks_mut(share).enumerate() {
            let work = &work;
            scope.spawn(move || work(k * share, part));
        }
    });
    share
}
