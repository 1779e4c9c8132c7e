//! Whether given planes and mirror images are what they should be, measured on the result.

use super::mirror::{Paired, paired};
use super::outcomes::{FixedPanel, MirrorReport, Place};
use super::{Model, PanelizeFinding, Solved};

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
