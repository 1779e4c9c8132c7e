//! The checks one by one.

use glam::DVec2;

use super::artwork::{Artwork, Operation, UnitState};
use super::contours::Contours;
use super::lines::{Line, On, Twin, label};
use super::pairs::{Common, Pairs};
use super::params::LintParams;
use super::report::{Check, LintReport};
use crate::geom::polygon::bounds;

/// Extents that nobody means: below a millimetre, above the largest glass.
const PLAUSIBLE: [f64; 2] = [1.0, 20_000.0];

pub(super) fn units(artwork: &Artwork, report: &mut LintReport) {
    match artwork.unit {
        UnitState::Known => {}
        UnitState::Missing(assumed) => {
            report.add(
                Check::Units,
                None,
                "",
                format!("the file does not say its unit; {assumed}"),
            );
        }
        UnitState::Contradictory(how) => report.add(Check::Units, None, "", how.to_owned()),
    }
    if let Some((low, high)) = bounds(artwork.paths.iter().flat_map(|p| &p.points)) {
        let extent = (high - low).max_element();
        let limit = if extent < PLAUSIBLE[0] { PLAUSIBLE[0] } else { PLAUSIBLE[1] };
        if extent > 0.0 && !(PLAUSIBLE[0]..=PLAUSIBLE[1]).contains(&extent) {
            let words =
                format!("the drawing is {} mm large; is it in another unit?", short(extent));
            report.measured(Check::Units, Some(low), "", words, Some((extent, limit)));
        }
    }
}

pub(super) fn not_flat(artwork: &Artwork, report: &mut LintReport) {
    if let Some((count, at)) = artwork.not_flat {
        let words = match count {
            1 => "1 line does not lie flat; seen from above its length is not true".to_owned(),
            _ => format!("{count} lines do not lie flat; seen from above lengths are not true"),
        };
        report.add(Check::NotFlat, Some(at), "", words);
    }
}

pub(super) fn texts(artwork: &Artwork, report: &mut LintReport) {
    for text in artwork.texts.iter().filter(|t| t.operation != Operation::Info) {
        let shown: String = text.text.chars().take(40).collect();
        report.add(Check::Text, Some(text.at), "", format!("live text {shown:?}"));
    }
}

pub(super) fn size(
    artwork: &Artwork,
    lines: &[Line],
    params: &LintParams,
    report: &mut LintReport,
) {
    let asked = params.sheet.map(|s| DVec2::new(s.width, s.height));
    // Written sizes have some decimals less than ours.
    let slack = params.gap.mm();
    if let (Some(sheet), Some(page)) = (asked, artwork.size)
        && (page - sheet).max_element() > slack
        && (DVec2::new(page.y, page.x) - sheet).max_element() > slack
    {
        let words = format!(
            "the page is {} × {} mm, the sheet {} × {} mm",
            short(page.x),
            short(page.y),
            short(sheet.x),
            short(sheet.y)
        );
        report.add(Check::OffSheet, None, "", words);
        return;
    }
    let machined = || lines.iter().filter(|l| l.operation != Operation::Info);
    let Some(room) = artwork.size.or(asked) else { return };
    let Some((low, _)) = bounds(machined().flat_map(|l| &l.points)) else { return };
    // A file without a page lies where it likes.
    let origin = if artwork.size.is_some() { DVec2::ZERO } else { low };
    for line in machined() {
        let Some((low, high)) = bounds(&line.points) else { continue };
        let over = (origin - low).max(high - origin - room).max_element();
        if over > slack {
            let far = |p: &&DVec2| (origin - **p).max(**p - origin - room).max_element();
            let at = line.points.iter().max_by(|a, b| far(a).total_cmp(&far(b))).copied();
            let words = format!("reaches {} mm over the edge of the sheet", short(over));
            report.measured(Check::OffSheet, at, &line.label, words, Some((over, 0.0)));
        }
    }
}

pub(super) fn stray_points(artwork: &Artwork, lines: &[Line], report: &mut LintReport) {
    let mut kept: Vec<bool> = vec![false; artwork.paths.len()];
    lines.iter().for_each(|l| kept[l.first] = true);
    for (i, path) in artwork.paths.iter().enumerate() {
        let extent = bounds(&path.points).map_or(0.0, |(low, high)| (high - low).max_element());
        // Lines that were joined to others are not lost; those without extent are.
        if !kept[i] && extent <= 0.01 {
            report.add(
                Check::StrayPoint,
                path.points.first().copied(),
                &label(path, i),
                "has no length".to_owned(),
            );
        }
    }
}

/// Lines drawn again, point by point.
pub(super) fn twins(lines: &[Line], twins: &[Twin], report: &mut LintReport) {
    for twin in twins {
        let first = &lines[twin.of];
        let words = format!("lies on {} over its whole length", first.label);
        let numbers = Some((first.length(), 0.0));
        report.measured(Check::Duplicate, Some(twin.at), &twin.label, words, numbers);
    }
}

pub(super) fn open_contours(
    lines: &[Line],
    contours: &Contours,
    is_dash: &[bool],
    params: &LintParams,
    report: &mut LintReport,
) {
    let on = On::of(lines, params.gap.mm());
    for (i, line) in lines.iter().enumerate().filter(|(_, l)| !l.closed && l.operation.is_cut()) {
        // A slit in a part: on the layer of inner cuts, inside an outline; or one of a hinge.
        let is_slit = line.operation == Operation::CutInner && contours.parent[i].is_some();
        if is_slit || is_dash[i] {
            continue;
        }
        let (Some(&a), Some(&b)) = (line.points.first(), line.points.last()) else { continue };
        // A cut from one cut to another closes what these leave open: lines that two parts share.
        if on.is_closed_by_cuts(i, line) {
            continue;
        }
        let words = format!("its ends are {} mm apart", short(a.distance(b)));
        report.measured(
            Check::OpenContour,
            Some(b),
            &line.label,
            words,
            Some((a.distance(b), params.gap.mm())),
        );
    }
}

/// Whether two operations may not share a line.
fn collide(a: Operation, b: Operation) -> bool {
    let is_engraved = |o| o == Operation::Engrave;
    is_engraved(a) == is_engraved(b)
}

pub(super) fn doubled(lines: &[Line], pairs: &Pairs, report: &mut LintReport) {
    for (&(i, j), common) in &pairs.common {
        let Some((length, at)) =
            common.overlap.filter(|_| collide(lines[i].operation, lines[j].operation))
        else {
            continue;
        };
        let shorter = lines[i].length().min(lines[j].length());
        if i != j && is_duplicate(&lines[i], &lines[j], common) {
            let words = format!("lies on {} over its whole length", lines[i].label);
            report.measured(
                Check::Duplicate,
                Some(at),
                &lines[j].label,
                words,
                Some((length, 0.0)),
            );
        } else {
            let other = if i == j { "itself" } else { &lines[i].label };
            let words = format!("runs along {other} for {} mm", short(length.min(shorter)));
            report.measured(Check::Overlap, Some(at), &lines[j].label, words, Some((length, 0.0)));
        }
    }
}

/// Whether two lines run on one another from end to end.
fn is_duplicate(a: &Line, b: &Line, common: &Common) -> bool {
    common.overlap.is_some_and(|(length, _)| length >= 0.95 * a.length().max(b.length()))
}

pub(super) fn crossings(lines: &[Line], pairs: &Pairs, report: &mut LintReport) {
    for (&(i, j), common) in &pairs.common {
        let Some(at) = common.crossing.filter(|_| !is_duplicate(&lines[i], &lines[j], common))
        else {
            continue;
        };
        let both_engraved =
            lines[i].operation == Operation::Engrave && lines[j].operation == Operation::Engrave;
        if i == j && !both_engraved {
            report.add(Check::SelfCrossing, Some(at), &lines[i].label, "crosses itself".to_owned());
        } else if i != j && !both_engraved {
            report.add(
                Check::Crossing,
                Some(at),
                &lines[j].label,
                format!("crosses {}", lines[i].label),
            );
        }
    }
}

/// Four significant digits are enough to find a place.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
