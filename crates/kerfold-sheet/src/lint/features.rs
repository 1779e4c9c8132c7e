//! The checks one by one.

use glam::DVec2;

use super::artwork::{Artwork, Operation, UnitState};
use super::contours::Contours;
use super::lines::{Line, On, label};
use super::pairs::{Pairs, distance};
use super::params::LintParams;
use super::report::{Check, LintReport};
use crate::geom::polygon::{Location, bounds, locate, signed_area};

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

pub(super) fn texts(artwork: &Artwork, report: &mut LintReport) {
    for text in &artwork.texts {
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

pub(super) fn open_contours(
    lines: &[Line],
    contours: &Contours,
    params: &LintParams,
    report: &mut LintReport,
) {
    let on = On::of(lines, params.gap.mm());
    for (i, line) in lines.iter().enumerate().filter(|(_, l)| !l.closed && l.operation.is_cut()) {
        // A slit in a part: on the layer of inner cuts, inside an outline.
        if line.operation == Operation::CutInner && contours.parent[i].is_some() {
            continue;
        }
        let (Some(&a), Some(&b)) = (line.points.first(), line.points.last()) else { continue };
        // A cut from one cut to another closes what these leave open: lines that two parts share.
        if on.is_closed_by_cuts(i) {
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
        let longer = lines[i].length().max(lines[j].length());
        if i != j && length >= 0.95 * longer {
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

pub(super) fn crossings(lines: &[Line], pairs: &Pairs, report: &mut LintReport) {
    for (&(i, j), common) in &pairs.common {
        let Some(at) = common.crossing else { continue };
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

pub(super) fn small_holes(
    lines: &[Line],
    contours: &Contours,
    params: &LintParams,
    report: &mut LintReport,
) {
    let Some(thickness) = params.thickness else { return };
    let least = 1.5 * thickness.mm();
    for (i, line) in lines.iter().enumerate() {
        if !(line.closed && line.operation.is_cut() && contours.is_hole(i)) {
            continue;
        }
        let width = least_width(&line.points) + params.kerf();
        if width < least {
            let words = format!(
                "this hole is {} mm wide, at least {} is wanted",
                short(width),
                short(least)
            );
            report.measured(
                Check::SmallHole,
                line.points.first().copied(),
                &line.label,
                words,
                Some((width, least)),
            );
        }
    }
}

/// The least distance between two parallel lines along an edge that hold a contour between them.
fn least_width(points: &[DVec2]) -> f64 {
    let n = points.len();
    let across = |i: usize| {
        let normal = (points[(i + 1) % n] - points[i]).normalize_or_zero().perp();
        let spans = points.iter().map(|p| normal.dot(*p - points[i]));
        let (low, high) = spans.fold((0.0_f64, 0.0_f64), |(l, h), s| (l.min(s), h.max(s)));
        if normal == DVec2::ZERO { f64::INFINITY } else { high - low }
    };
    // A large contour is no small hole; its box tells enough.
    if n > 400 {
        return bounds(points).map_or(0.0, |(low, high)| (high - low).min_element());
    }
    (0..n).map(across).fold(f64::INFINITY, f64::min)
}

pub(super) fn thin_webs(
    lines: &[Line],
    contours: &Contours,
    pairs: &Pairs,
    params: &LintParams,
    report: &mut LintReport,
) {
    let limit = params.web();
    let mut tell = |at: DVec2, label: &str, distance: f64, other: &str| {
        let width = distance - params.kerf();
        let words = format!("{} mm of material are left to {other}", short(width.max(0.0)));
        report.measured(Check::ThinWeb, Some(at), label, words, Some((width, limit)));
    };
    let is_contour = |i: usize| lines[i].closed && lines[i].operation.is_cut();
    for (&(i, j), common) in &pairs.common {
        let Some((distance, at)) =
            common.nearest.filter(|_| i != j && is_contour(i) && is_contour(j))
        else {
            continue;
        };
        if contours.share_material(i, j) && common.overlap.is_none() && common.crossing.is_none() {
            tell(at, &lines[j].label, distance, &lines[i].label);
        }
    }
    for i in (0..lines.len()).filter(|&i| is_contour(i)) {
        if let Some((distance, at)) =
            neck(&lines[i].points, contours.is_hole(i), params.web() + params.kerf())
        {
            tell(at, &lines[i].label, distance, "itself");
        }
    }
}

/// The thinnest neck of a contour below a width: from a corner that points into the material to
/// another stretch of the contour, through the material. Tips, which are thin everywhere, are none.
fn neck(points: &[DVec2], is_hole: bool, web: f64) -> Option<(f64, DVec2)> {
    let n = points.len();
    let turn = if (signed_area(points) > 0.0) != is_hole { 1.0 } else { -1.0 };
    let mut along = vec![0.0; n + 1];
    for i in 0..n {
        along[i + 1] = along[i] + points[i].distance(points[(i + 1) % n]);
    }
    let total = along[n];
    let mut least: Option<(f64, DVec2)> = None;
    for i in 0..n {
        let (p, before, after) = (points[i], points[(i + n - 1) % n], points[(i + 1) % n]);
        let (into, out) = ((p - before).normalize_or_zero(), (after - p).normalize_or_zero());
        // Corners of flattened curves turn less than that; a neck between two curves has none and
        // is not looked for.
        if turn * into.perp_dot(out) > -0.2 {
            continue;
        }
        for j in 0..n {
            let ends = [points[j], points[(j + 1) % n]];
            if ends[0].min(ends[1]).cmpgt(p + DVec2::splat(web)).any()
                || ends[0].max(ends[1]).cmplt(p - DVec2::splat(web)).any()
            {
                continue;
            }
            let (width, foot) = distance(p, ends);
            let way = (along[j] + ends[0].distance(foot) - along[i]).abs();
            let is_apart = way.min(total - way) > 4.0 * web;
            let middle = locate(points, p.midpoint(foot));
            let is_through = (middle == Location::Inside) != is_hole;
            if width < web && is_apart && is_through && least.is_none_or(|(w, _)| width < w) {
                least = Some((width, p.midpoint(foot)));
            }
        }
    }
    least
}

/// Four significant digits are enough to find a place.
fn short(value: f64) -> String {
    let text = format!("{value:.3}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
