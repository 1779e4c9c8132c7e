//! The page of an SVG: its size in millimetres and the way from user units there.

use glam::{DAffine2, DVec2};
use roxmltree::Node;

use super::svg_path::{PerInch, length, point_list};
use crate::lint::UnitState;

const INKSCAPE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// The page and its view.
pub(super) struct Page {
    /// Width and height in mm.
    pub size: DVec2,
    /// From user units to mm, y still down.
    pub to_mm: DAffine2,
    /// Width and height of the view in user units.
    pub view: DVec2,
    pub unit: UnitState,
    /// User units in an inch.
    pub per_inch: PerInch,
    /// What was assumed, in words.
    pub note: Option<String>,
}

impl Page {
    pub fn of(root: Node<'_, '_>) -> Self {
        let (per_inch, note) = match old_inkscape(root) {
            Some(version) => (
                PerInch(90.0),
                Some(format!("made by Inkscape {version}: 90 user units to an inch, not 96")),
            ),
            None => (PerInch(96.0), None),
        };
        let pixel = 25.4 / per_inch.0;
        let side = |name: &str| {
            let side = root.attribute(name).and_then(|v| length(v, f64::NAN, per_inch));
            side.filter(|l| l.0 > 0.0 && l.0.is_finite())
        };
        let view = root.attribute("viewBox").and_then(view_box);
        let (width, height) = (side("width"), side("height"));
        let of = |s: &Option<(f64, bool)>| s.as_ref().map(|s| s.0);
        let is_real = |s: &Option<(f64, bool)>| s.as_ref().is_some_and(|s| s.1);
        let own = view.map_or(DVec2::new(300.0, 150.0), |v| v.1);
        // One side alone gives the other in the proportions of the view.
        let ratio = view.map(|v| v.1.y / v.1.x);
        let size = match (of(&width), of(&height), ratio) {
            (Some(w), None, Some(ratio)) => DVec2::new(w, w * ratio),
            (None, Some(h), Some(ratio)) => DVec2::new(h / ratio, h),
            (w, h, _) => DVec2::new(w.unwrap_or(own.x), h.unwrap_or(own.y)),
        };
        let is_given = |side: &Option<(f64, bool)>| side.is_some() || view.is_none();
        let is_known = (is_real(&width) || !is_given(&width))
            && (is_real(&height) || !is_given(&height))
            && (is_real(&width) || is_real(&height));
        let assumed = match per_inch.0 {
            90.0 => "1/90 in for a user unit is assumed",
            _ => "1/96 in for a user unit is assumed",
        };
        let unit = if is_known { UnitState::Known } else { UnitState::Missing(assumed) };
        let page = Self {
            size: size * pixel,
            to_mm: DAffine2::from_scale(DVec2::splat(pixel)),
            view: size,
            unit,
            per_inch,
            note,
        };
        match view {
            Some(view) => page.through(view, size, root.attribute("preserveAspectRatio")),
            None => page,
        }
    }

    /// With a view box in it.
    fn through(mut self, (low, view): (DVec2, DVec2), size: DVec2, how: Option<&str>) -> Self {
        let stretch = size / view;
        let is_stretched = (stretch.x - stretch.y).abs() > 1e-3 * stretch.max_element();
        if self.unit == UnitState::Known && is_stretched {
            self.unit = UnitState::Contradictory(
                "width and height do not have the proportions of the viewBox; lengths are not true",
            );
        }
        self.to_mm *= fit(low, view, size, how);
        self.view = view;
        self
    }
}

/// The version of Inkscape that made a drawing, if its user units are 1/90 in: before 0.92.
fn old_inkscape(root: Node<'_, '_>) -> Option<String> {
    let version = root.attribute((INKSCAPE, "version"))?.split_whitespace().next()?;
    let mut numbers = version.split(|c: char| !c.is_ascii_digit()).map(str::parse::<u32>);
    let (major, minor) = (numbers.next()?.ok()?, numbers.next()?.ok()?);
    ((major, minor) < (0, 92)).then(|| version.to_owned())
}

/// Corner and size of a view box.
pub(super) fn view_box(text: &str) -> Option<(DVec2, DVec2)> {
    match *point_list(text).as_slice() {
        [low, size] if size.min_element() > 0.0 => Some((low, size)),
        _ => None,
    }
}

/// A view box fitted into a viewport.
pub(super) fn fit(low: DVec2, view: DVec2, port: DVec2, how: Option<&str>) -> DAffine2 {
    let how = how.unwrap_or_default();
    let stretch = port / view;
    let scale = match how {
        h if h.contains("none") => stretch,
        h if h.contains("slice") => DVec2::splat(stretch.max_element()),
        _ => DVec2::splat(stretch.min_element()),
    };
    let share = |min: &str, max: &str| {
        if how.contains(min) {
            0.0
        } else if how.contains(max) {
            1.0
        } else {
            0.5
        }
    };
    let rest = (port - view * scale) * DVec2::new(share("xMin", "xMax"), share("YMin", "YMax"));
    DAffine2::from_translation(rest)
        * DAffine2::from_scale(scale)
        * DAffine2::from_translation(-low)
}
