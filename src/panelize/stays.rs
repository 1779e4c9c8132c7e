//! Whether given planes, given points and mirror images are what they should be, measured on the
//! result.

use glam::DVec3;

use super::mirror::{Paired, paired};
use super::outcomes::{FixedPanel, MirrorReport, Place, StayedPoint};
use super::{HeldPoint, Model, PanelizeFinding, Solved};

/// Corners farther from a given plane have left it, and those farther from an image are none, in panel
/// sizes.
const PLANE_OFF: f64 = 1e-9;

/// The panels whose planes were given, and how far their corners are from these.
pub(super) fn fixed_panels(model: &Model, solved: &Solved) -> Vec<FixedPanel> {
    let panels = &solved.state.panels;
    let off = |f: usize| {
        let away = |&v: &usize| model.pins[f].plane.signed_distance(panels.points[v]).abs();
        panels.faces[f].iter().map(away).fold(0.0, f64::max) * model.size
    };
    let fixed = |f: usize| {
        let asked = model.pins[f].asked.to_string();
        FixedPanel { asked, panel: f, off_mm: off(f) }
    };
    (0..model.pins.len()).map(fixed).collect()
}

/// The mirror planes, with the first panel that has no image.
pub(super) fn mirrors(model: &Model, solved: &Solved) -> Vec<(MirrorReport, usize)> {
    let one = |&axis: &usize| {
        let found = paired(&solved.state.panels, axis, PLANE_OFF);
        let Paired { pairs, across, alone, first_alone } = found;
        let (at_mm, tolerance_mm) = (model.origin[axis], PLANE_OFF * model.size);
        (MirrorReport { axis, at_mm, pairs, across, alone, tolerance_mm }, first_alone)
    };
    model.mirrors.iter().map(one).collect()
}

/// Panels that are no images of others, the first for each mirror plane.
pub(super) fn unpaired(model: &Model, solved: &Solved) -> Vec<Place> {
    let all = mirrors(model, solved).into_iter().filter(|(report, _)| report.alone > 0);
    all.map(|(report, first)| Place {
        finding: PanelizeFinding::Unpaired,
        element: first,
        measured: report.alone as f64,
        place: model.place(solved.state.panels.centre(first)),
    })
    .collect()
}

/// The vertex that is nearest to each point that stays, whichever was put there.
pub(super) fn stayed_points(model: &Model, solved: &Solved) -> Vec<StayedPoint> {
    let state = &solved.state;
    let used = (0..state.panels.points.len()).filter(|&v| !state.fans[v].is_empty());
    let places: Vec<_> = used.map(|v| (v, model.vertex(&state.panels, v))).collect();
    let near = |(point, held): (usize, &HeldPoint)| {
        let off = |place: &DVec3| place.distance(held.given);
        let nearest = places.iter().min_by(|a, b| off(&a.1).total_cmp(&off(&b.1)));
        let (vertex, off_mm) = nearest.map_or((0, f64::INFINITY), |(v, place)| (*v, off(place)));
        StayedPoint { point, vertex, off_mm }
    };
    model.held.iter().enumerate().map(near).collect()
}

/// Points at which no corner of panels stands.
pub(super) fn lost_points(model: &Model, solved: &Solved) -> Vec<Place> {
    let stayed = stayed_points(model, solved).into_iter();
    let lost = stayed.filter(|point| point.off_mm > PLANE_OFF * model.size);
    lost.map(|point| Place {
        finding: PanelizeFinding::PointLost,
        element: point.vertex,
        measured: point.off_mm,
        place: model.held[point.point].given,
    })
    .collect()
}

/// Panels that left the planes that were given for them.
pub(super) fn lost_planes(model: &Model, solved: &Solved) -> Vec<Place> {
    let fixed = fixed_panels(model, solved).into_iter();
    let lost = fixed.filter(|panel| panel.off_mm > PLANE_OFF * model.size);
    lost.map(|panel| Place {
        finding: PanelizeFinding::PlaneLost,
        element: panel.panel,
        measured: panel.off_mm,
        place: model.place(solved.state.panels.centre(panel.panel)),
    })
    .collect()
}
