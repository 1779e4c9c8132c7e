//! Figures and words of a report.

use super::{Word, Words};
use crate::check::short;

/// Every figure of the page with its definition.
pub(super) const DEFINITIONS: [(&str, &str); 10] = [
    (
        "mm",
        "Planarity: the largest distance of a corner of the panel from the plane that fits its \
        corners best (least squares), in \
         millimetres.",
    ),
    (
        "‰",
        "The same over the panel’s diameter, which is the largest distance of two of its corners, \
        in thousandths.",
    ),
    (
        "°",
        "Twist: the largest angle between the normal of the panel (Newell) and the normal of one \
        of its corners, in degrees. \
         Corners on a straight line have none.",
    ),
    (
        "%",
        "For panels with four sides: the distance of the two diagonals over their mean length, in \
        hundredths.",
    ),
    (
        "% of the limit",
        "The measured value over its limit; with several limits, that of the tightest. Up to 100 \
        the panel passes.",
    ),
    ("Valence", "The number of edges that meet at a node. At a rim, two are as good as three."),
    (
        "Conical residual",
        "The planes of the panels at a node are moved out by 1 mm: how far the point that serves \
        them best (least squares) is \
         still from one of them, in mm per mm of thickness. 0: plates of constant thickness meet in one point.",
    ),
    (
        "Angle deficit",
        "360° minus the angles of the panels at a node, in degrees. Positive at a peak, 0 where \
        the surface can lie flat, \
         negative at a saddle. At a rim the open angle counts too.",
    ),
    (
        "Dihedral",
        "The angle between the two panels at an edge, inside the model, in degrees. 180° is flat; \
        less is convex, more concave.",
    ),
    (
        "Mitre",
        "(180° − dihedral) / 2: what each panel’s edge is cut off square, in degrees; negative at \
        a concave edge.",
    ),
];

/// Nothing but text.
pub(super) fn text(text: impl Into<String>) -> Words {
    vec![Word::Text(text.into())]
}

/// Nothing but a figure.
pub(in crate::io) fn figure(x: f64) -> Words {
    vec![Word::Figure(x)]
}

/// A figure, or a dash where there is none.
pub(in crate::io) fn optional(x: Option<f64>) -> Words {
    x.map_or_else(|| text("–"), figure)
}

impl From<&str> for Word {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

/// A figure for people: four digits; what is smaller than anybody can measure is said so.
pub(in crate::io) fn shown(x: f64) -> String {
    if x != 0.0 && x.abs() < 1e-4 {
        (if x > 0.0 { "< 0.0001" } else { "> −0.0001" }).to_owned()
    } else {
        short(x).replace('-', "−")
    }
}

/// `pass` or `fail`.
pub(in crate::io) const fn verdict(is_kept: bool) -> &'static str {
    if is_kept { "pass" } else { "fail" }
}

/// `1 panel`, `2 panels`.
pub(super) fn count(n: usize, one: &str, many: &str) -> String {
    format!("{n} {}", if n == 1 { one } else { many })
}
