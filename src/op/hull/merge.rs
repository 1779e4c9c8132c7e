//! Pieces joined to few parts: always the two whose common hull adds the least volume.

use glam::DVec3;

use super::super::OpError;
use super::bundle::{Bundle, PartPoint};
use crate::progress::Progress;

/// More pieces than this are first gathered by where they lie, since pairs of them are compared.
const MOST_COMPARED: usize = 256;
/// Boxes nearer than this share of the size touch.
const NEAR: f64 = 1e-6;

/// Joins bundles until at most `most` are left. The points of those that span no volume, and
/// `left`, go to the nearest of the others. Empty when none spans a volume.
///
/// # Errors
/// [`OpError::Cancelled`].
pub(super) fn merged(
    bundles: Vec<Bundle>,
    left: Vec<PartPoint>,
    most: usize,
    progress: &dyn Progress,
) -> Result<Vec<Bundle>, OpError> {
    let (solid, flat): (Vec<Bundle>, Vec<Bundle>) =
        bundles.into_iter().partition(|bundle| bundle.volume > 0.0);
    if solid.is_empty() {
        return Ok(Vec::new());
    }
    let stray = flat.into_iter().flat_map(Bundle::into_points).chain(left).collect();
    let gathered = gathered(solid, most.max(MOST_COMPARED));
    let mut joining = Joining::of(with_stray(gathered, stray), progress)?;
    while joining.left > most {
        joining.join_cheapest(progress)?;
    }
    Ok(joining.bundles.into_iter().flatten().collect())
}

/// Adds each point to the bundle whose box is nearest.
fn with_stray(mut bundles: Vec<Bundle>, stray: Vec<PartPoint>) -> Vec<Bundle> {
    let mut more: Vec<Vec<PartPoint>> = vec![Vec::new(); bundles.len()];
    for point in stray {
        let off = |b: &Bundle| point.position.clamp(b.low, b.high).distance_squared(point.position);
        let nearest =
            (0..bundles.len()).min_by(|&i, &j| off(&bundles[i]).total_cmp(&off(&bundles[j])));
        if let Some(i) = nearest {
            more[i].push(point);
        }
    }
    for (bundle, more) in bundles.iter_mut().zip(more).filter(|(_, more)| !more.is_empty()) {
        bundle.add(more);
    }
    bundles
}

/// At most so many bundles, made by halving the longest side of the boxes' middles again and again.
fn gathered(bundles: Vec<Bundle>, most: usize) -> Vec<Bundle> {
    if bundles.len() <= most {
        return bundles;
    }
    if most == 1 {
        return vec![Bundle::of(bundles.into_iter().flat_map(Bundle::into_points).collect())];
    }
    let middles = || bundles.iter().map(Bundle::middle);
    let low = middles().reduce(DVec3::min).unwrap_or_default();
    let high = middles().reduce(DVec3::max).unwrap_or_default();
    let axis = (high - low).max_position();
    let mut bundles = bundles;
    bundles.sort_by(|a, b| a.middle()[axis].total_cmp(&b.middle()[axis]));
    let first_share = most / 2;
    let upper = bundles.split_off(bundles.len() * first_share / most);
    let mut all = gathered(bundles, first_share);
    all.extend(gathered(upper, most - first_share));
    all
}

/// Two bundles, and what joining them adds.
struct Pair {
    added: f64,
    first: usize,
    second: usize,
}

/// Bundles while they are joined; those that are gone are empty.
struct Joining {
    bundles: Vec<Option<Bundle>>,
    /// Those that touch.
    pairs: Vec<Pair>,
    left: usize,
    margin: f64,
}

impl Joining {
    fn of(bundles: Vec<Bundle>, progress: &dyn Progress) -> Result<Self, OpError> {
        let low = bundles.iter().map(|b| b.low).reduce(DVec3::min).unwrap_or_default();
        let high = bundles.iter().map(|b| b.high).reduce(DVec3::max).unwrap_or_default();
        let margin = NEAR * (high - low).length();
        let left = bundles.len();
        let bundles = bundles.into_iter().map(Some).collect();
        let mut joining = Self { bundles, pairs: Vec::new(), left, margin };
        for second in 1..joining.bundles.len() {
            joining.add_pairs(second, progress)?;
        }
        Ok(joining)
    }

    /// Adds the pairs of a bundle with those before it that it touches.
    fn add_pairs(&mut self, second: usize, progress: &dyn Progress) -> Result<(), OpError> {
        if progress.is_cancelled() {
            return Err(OpError::Cancelled);
        }
        let Some(new) = &self.bundles[second] else { return Ok(()) };
        for (first, old) in self.bundles[..second].iter().enumerate() {
            let Some(old) = old.as_ref().filter(|old| old.touches(new, self.margin)) else {
                continue;
            };
            let added = old.joined(new).volume - old.volume - new.volume;
            self.pairs.push(Pair { added, first, second });
        }
        Ok(())
    }

    /// Joins the pair that adds the least or, when none touch, the two with the smallest box.
    fn join_cheapest(&mut self, progress: &dyn Progress) -> Result<(), OpError> {
        let cheapest = self.pairs.iter().min_by(|a, b| a.added.total_cmp(&b.added));
        let chosen = cheapest.map(|pair| (pair.first, pair.second)).or_else(|| self.nearest());
        let Some((first, second)) = chosen else { return Ok(()) };
        self.pairs
            .retain(|pair| [pair.first, pair.second].iter().all(|i| *i != first && *i != second));
        let pair = (self.bundles[first].take(), self.bundles[second].take());
        if let (Some(a), Some(b)) = pair {
            self.bundles.push(Some(a.joined(&b)));
            self.left -= 1;
        }
        self.add_pairs(self.bundles.len() - 1, progress)
    }

    fn nearest(&self) -> Option<(usize, usize)> {
        let present: Vec<(usize, &Bundle)> = self
            .bundles
            .iter()
            .enumerate()
            .filter_map(|(i, bundle)| bundle.as_ref().map(|bundle| (i, bundle)))
            .collect();
        let mut best: Option<(f64, (usize, usize))> = None;
        for (k, &(j, second)) in present.iter().enumerate() {
            for &(i, first) in &present[..k] {
                let span = first.span(second);
                if best.is_none_or(|best| span < best.0) {
                    best = Some((span, (i, j)));
                }
            }
        }
        best.map(|best| best.1)
    }
}
