//! Where seams may begin: rims are cut into chords, and where a place to begin gives too much
//! material, the nearest that does not is named.

use super::GluingError;
use super::rims::{self, Rims};
use super::seams::{Gluing, Seam, Span};

/// Other places to begin that are tried where there is too much material, and pairs of corners.
const MEND_STEPS: usize = 240;
const MEND_CORNERS: usize = 2500;

impl Gluing {
    /// The same seams begun elsewhere: the side `b` of the first seam is moved along its rim, and
    /// of a zip both sides. `None` for more than one seam, which have no such freedom.
    fn moved(&self, by: f64) -> Option<Self> {
        let [seam] = self.seams.as_slice() else { return None };
        let moved = |span: &Span| Span { from: span.from + by, to: span.to + by, ..*span };
        let a = if self.outlines.len() == 1 { moved(&seam.a) } else { seam.a };
        Some(Self { seams: vec![Seam { a, b: moved(&seam.b) }], ..self.clone() })
    }

    /// Cuts the rims into chords and checks that they make a sphere without too much material
    /// anywhere. Where there is too much, the nearest other place to start that has none is named.
    pub(super) fn rims(&self) -> Result<Rims, GluingError> {
        match rims::cut(self) {
            Err(GluingError::Angle { place, degrees, count, .. }) => {
                Err(GluingError::Angle { place, degrees, count, mend: self.mend() })
            }
            rims => rims,
        }
    }

    fn mend(&self) -> Option<String> {
        self.moved(0.0)?;
        let is_zip = self.outlines.len() == 1;
        let whole = self.outlines[self.outlines.len() - 1].length();
        let word = if is_zip { "zip" } else { "start" };
        let begin = self.seams[0].b.from - if is_zip { whole / 2.0 } else { 0.0 };
        let mut changes = self.changes(begin, whole);
        changes.sort_by(|a, b| a.abs().total_cmp(&b.abs()).then(b.total_cmp(a)));
        let step = whole / MEND_STEPS as f64;
        let mended = changes
            .into_iter()
            .find(|&by| self.moved(by).is_some_and(|moved| rims::cut(&moved).is_ok()));
        Some(match mended {
            Some(by) => {
                let place = (begin + by).rem_euclid(whole);
                let part = place / whole;
                format!(
                    "the smallest change that mends it, in steps of {step:.2} mm, is {by:+.2} mm: \
                     `--{word} {part:.9}` ({place:.4} mm)"
                )
            }
            None => format!(
                "no other `--{word}` mends it (tried in steps of {step:.2} mm): make the outlines \
                 less hollow"
            ),
        })
    }

    /// Ways to begin elsewhere: equal steps, and where a corner meets a corner.
    fn changes(&self, begin: f64, whole: f64) -> Vec<f64> {
        let nearest = |by: f64| by - whole * (by / whole).round();
        let mut changes: Vec<f64> =
            (1..MEND_STEPS).map(|k| nearest(k as f64 * whole / MEND_STEPS as f64)).collect();
        let [first, last] = [&self.outlines[0], &self.outlines[self.outlines.len() - 1]];
        let (a, b): (Vec<f64>, Vec<f64>) = (first.corners().collect(), last.corners().collect());
        if a.len() * b.len() <= MEND_CORNERS {
            for x in &a {
                // Of a zip, corners at equal distances from its beginning meet.
                let halved = if self.outlines.len() == 1 { 2.0 } else { 1.0 };
                changes.extend(b.iter().map(|y| nearest((x + y) / halved - begin)));
            }
        }
        changes
    }
}
