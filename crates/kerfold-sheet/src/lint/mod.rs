//! Judges a drawing that is to be cut, anybody's, as a shop would: what it would send back, with
//! the place and what to do.
//!
//! The room knows lines with an operation and a layer, in millimetres; no file format and no net.
//! It shares nothing with `sheet` but the geometry of `geom`, so that it can judge our own sheets.

mod artwork;
mod colours;
mod contours;
mod distance;
mod features;
mod hinges;
mod holes;
mod lines;
mod order;
mod pairs;
mod params;
mod report;
mod webs;
mod work;

pub use artwork::{ArtPath, ArtText, Artwork, Operation, UnitState};
pub use colours::{Colours, Rgb};
pub use params::{LimitError, LintParams, SheetLimit};
pub use report::{Check, LintFinding, LintReport, UnknownCheck};
pub use work::LintError;

use contours::Contours;
use lines::Line;
use pairs::Pairs;
use work::Work;

/// Judges a drawing.
///
/// # Errors
/// [`LintError`] where too much lies on too much to be looked through.
///
/// ```
/// use glam::DVec2;
/// use kerfold_sheet::lint::{ArtPath, Artwork, Check, LintParams, Operation, lint};
///
/// let corner = ArtPath {
///     points: vec![DVec2::ZERO, DVec2::new(40.0, 0.0), DVec2::new(40.0, 30.0)],
///     closed: false,
///     operation: Operation::Cut,
///     layer: "cut".to_owned(),
///     name: None,
/// };
/// let drawing = Artwork { paths: vec![corner], ..Artwork::default() };
/// let report = lint(&drawing, &LintParams::default())?;
/// assert_eq!(report.findings[0].check, Check::OpenContour);
/// # Ok::<(), kerfold_sheet::lint::LintError>(())
/// ```
pub fn lint(artwork: &Artwork, params: &LintParams) -> Result<LintReport, LintError> {
    judge(artwork, params, &mut Work::default())
}

/// Judges the pages of one file; the work for all of them is bounded together.
///
/// # Errors
/// As [`lint()`].
pub fn lint_pages(pages: &[Artwork], params: &LintParams) -> Result<Vec<LintReport>, LintError> {
    let mut work = Work::default();
    pages.iter().map(|page| judge(page, params, &mut work)).collect()
}

fn judge(artwork: &Artwork, params: &LintParams, work: &mut Work) -> Result<LintReport, LintError> {
    let mut report = LintReport::new(&params.skip);
    let joined = lines::join(artwork, params.gap.mm(), params.join(), work)?;
    features::units(artwork, &mut report);
    features::not_flat(artwork, &mut report);
    features::texts(artwork, &mut report);
    features::size(artwork, &joined, params, &mut report);
    features::stray_points(artwork, &joined, &mut report);
    // Lines drawn twice are reported once and judged once.
    let (lines, twins) = lines::without_twins(joined);
    features::twins(&lines, &twins, &mut report);
    judge_lines(artwork, &lines, params, &mut report, work)?;
    Ok(report)
}

/// The checks that look at lines and at what they have in common.
fn judge_lines(
    artwork: &Artwork,
    lines: &[Line],
    params: &LintParams,
    report: &mut LintReport,
    work: &mut Work,
) -> Result<(), LintError> {
    let contours = Contours::of(lines, params.gap.mm(), work)?;
    let is_dash = hinges::dashes(lines, &contours, params, work)?;
    features::open_contours(lines, &contours, &is_dash, params, report);
    if report.wants_any(&[Check::Duplicate, Check::Overlap, Check::SelfCrossing, Check::Crossing])
        || report.wants_any(&[Check::ThinWeb])
    {
        let pairs = Pairs::of(lines, params.gap.mm(), params.web() + params.kerf(), work)?;
        features::doubled(lines, &pairs, report);
        features::crossings(lines, &pairs, report);
        holes::small(lines, &contours, &is_dash, params, report);
        webs::between(lines, &contours, &pairs, &is_dash, params, report);
    } else {
        holes::small(lines, &contours, &is_dash, params, report);
    }
    if report.wants_any(&[Check::ThinWeb]) {
        webs::necks(lines, &contours, &is_dash, params, report, work)?;
    }
    order::order(artwork, lines, &contours, report);
    Ok(())
}

#[cfg(test)]
mod tests;
