//! Whether the file works from the inside outwards.

use super::artwork::{Artwork, Operation};
use super::contours::Contours;
use super::lines::{Line, label};
use super::report::{Check, LintReport};

/// The operations' order, and inner contours before those around them. Each kind of fault is
/// reported once per line that comes too late.
pub(super) fn order(
    artwork: &Artwork,
    lines: &[Line],
    contours: &Contours,
    report: &mut LintReport,
) {
    // Inner and outer cuts are judged by what lies in what, not by their layers' names.
    let rank = |o: Operation| if o.is_cut() { 2 } else { usize::from(o == Operation::Score) };
    let mut latest: Option<(usize, Operation)> = None;
    let mut told = [false; 3];
    for (i, path) in
        artwork.paths.iter().enumerate().filter(|(_, p)| p.operation != Operation::Info)
    {
        let here = rank(path.operation);
        match latest {
            Some((before, operation)) if here < before => {
                if !std::mem::replace(&mut told[here], true) {
                    let words =
                        format!("{} comes after {}", path.operation.name(), operation.name());
                    report.add(Check::Order, path.points.first().copied(), &label(path, i), words);
                }
            }
            Some((before, _)) if here == before => {}
            _ => latest = Some((here, path.operation)),
        }
    }
    for (i, line) in lines.iter().enumerate().filter(|(_, l)| l.closed && l.operation.is_cut()) {
        if let Some(parent) = contours.parent[i].filter(|&p| lines[p].first < line.first) {
            let words = format!("is cut after {}, which lies around it", lines[parent].label);
            report.add(Check::Order, line.points.first().copied(), &line.label, words);
        }
    }
}
