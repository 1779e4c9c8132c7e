//! What became of what was asked for beside a size: given planes.

use crate::check::short;

/// A panel whose plane was given.
#[derive(Debug, Clone, PartialEq)]
pub struct FixedPanel {
    /// What asked for it: the line of the file, or the group of faces.
    pub asked: String,
    /// The panel.
    pub panel: usize,
    /// The largest distance of its corners from the plane, in mm.
    pub off_mm: f64,
}

/// So many panels are named.
const NAMED: usize = 8;

/// The panels with given planes, in words; nothing without any.
pub(super) fn fixed_note(panels: &[FixedPanel]) -> Option<String> {
    let off = panels.iter().map(|panel| panel.off_mm).fold(0.0, f64::max);
    let name = |panel: &FixedPanel| format!("{} ({})", panel.panel, panel.asked);
    let names: Vec<String> = panels.iter().take(NAMED).map(name).collect();
    let more = if panels.len() > NAMED { ", …" } else { "" };
    (!panels.is_empty()).then(|| {
        format!(
            "{} panels have the planes that were given: {}{more}; their corners are off them by {} mm \
            at most",
            panels.len(),
            names.join(", "),
            short(off)
        )
    })
}
