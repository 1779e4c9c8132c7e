//! Filling and sorting tables on all processors; the result never depends on their number.

use std::ops::Range;
use std::sync::{Mutex, PoisonError};

/// Below this many values a thread costs more than it saves.
const WORTH_A_THREAD: usize = 1 << 14;

/// Sets every value of `out` to `make(its index)`.
pub(super) fn fill<T: Send>(out: &mut [T], make: impl Fn(usize) -> T + Sync) {
    in_shares(out, |start, part| {
        part.iter_mut().enumerate().for_each(|(i, value)| *value = make(start + i))
    });
}

/// Sets every value of `out` to what `make(its index, itself)` has first, and returns what it has
/// besides, in the order of the values.
pub(super) fn update_and_pick<T: Send, P: Send>(
    out: &mut [T],
    make: impl Fn(usize, &T) -> (T, Option<P>) + Sync,
) -> Vec<P> {
    let picked = Picked::default();
    in_shares(out, |start, part| {
        let mut own = Vec::new();
        for (i, value) in (start..).zip(part) {
            let (next, pick) = make(i, value);
            *value = next;
            own.extend(pick);
        }
        picked.add(start, own);
    });
    picked.in_order()
}

/// The values that are wanted, in their order.
pub(super) fn pick<T: Copy + Send + Sync>(
    values: &[T],
    is_wanted: impl Fn(&T) -> bool + Sync,
) -> Vec<T> {
    let all = Picked::default();
    let share = share_of(values.len());
    let (picked, is_wanted) = (&all, &is_wanted);
    std::thread::scope(|scope| {
        for (k, part) in values.chunks(share).enumerate() {
            let work = move || picked.add(k, part.iter().copied().filter(is_wanted).collect());
            if share >= values.len() {
                work();
            } else {
                scope.spawn(work);
            }
        }
    });
    all.in_order()
}

/// What threads pick, each with the number of its share.
struct Picked<T>(Mutex<Vec<(usize, Vec<T>)>>);

impl<T> Default for Picked<T> {
    fn default() -> Self {
        Self(Mutex::new(Vec::new()))
    }
}

impl<T> Picked<T> {
    fn add(&self, share: usize, values: Vec<T>) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).push((share, values));
    }

    fn in_order(self) -> Vec<T> {
        let mut shares = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        shares.sort_unstable_by_key(|share| share.0);
        shares.into_iter().flat_map(|share| share.1).collect()
    }
}

/// Runs `work` on shares of `count` runs that lie one behind the other in `out`. Each share is told
/// which runs are its own.
pub(super) fn fill_runs<T: Send>(
    out: &mut [T],
    count: usize,
    begin: impl Fn(usize) -> usize,
    work: impl Fn(Range<usize>, &mut [T]) + Sync,
) {
    let share = share_of(count);
    std::thread::scope(|scope| {
        let mut rest = out;
        for start in (0..count).step_by(share) {
            let own = start..(start + share).min(count);
            let is_last = own.end == count;
            let length = if is_last { rest.len() } else { begin(own.end) - begin(own.start) };
            let (part, others) = rest.split_at_mut(length);
            rest = others;
            let work = &work;
            if is_last {
                work(own, part);
            } else {
                scope.spawn(move || work(own, part));
            }
        }
    });
}

/// Sorts keys that all differ.
pub(super) fn sort(keys: &mut [u64]) {
    let share = in_shares(keys, |_, part| part.sort_unstable());
    // Sorted shares are runs that this sort finds and merges.
    if share < keys.len() {
        keys.sort();
    }
}

/// Runs `work` on every value, which stand for `count` smaller ones in all.
pub(super) fn each<T: Send>(values: &mut [T], count: usize, work: impl Fn(&mut T) + Sync) {
    let share = values.len().div_ceil(threads_for(count)).max(1);
    std::thread::scope(|scope| {
        let mut shares = values.chunks_mut(share);
        let own = shares.next();
        for part in shares {
            let work = &work;
            scope.spawn(move || part.iter_mut().for_each(work));
        }
        own.into_iter().flatten().for_each(&work);
    });
}

/// The length of equal shares of `count` values, one for each processor.
pub(super) fn share_of(count: usize) -> usize {
    count.div_ceil(threads_for(count)).max(1)
}

/// How many threads are worth it for so many values. The system is only asked when more than one
/// may be.
fn threads_for(count: usize) -> usize {
    match count / WORTH_A_THREAD + 1 {
        1 => 1,
        most => std::thread::available_parallelism().map_or(1, |n| n.get()).min(most),
    }
}

/// Runs `work` on equal shares of `values`, each with the index of its first; returns the length of
/// a share.
fn in_shares<T: Send>(values: &mut [T], work: impl Fn(usize, &mut [T]) + Sync) -> usize {
    let share = share_of(values.len());
    if share >= values.len() {
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
