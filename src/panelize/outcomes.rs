//! What became of what was asked for beside a size: given planes, mirrored pairs, families of
//! lengths; and places that are named.

use glam::DVec3;

use super::PanelizeFinding;
use crate::check::short;

/// A place of the result with what was measured there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// What is wrong.
    pub finding: PanelizeFinding,
    /// The face, or the vertex for [`PanelizeFinding::FarNode`] and [`PanelizeFinding::PointLost`].
    pub element: usize,
    /// What was measured: mm, degrees or thicknesses.
    pub measured: f64,
    /// Where, in mm.
    pub place: DVec3,
}

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

/// A point that was to stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StayedPoint {
    /// Which of the points, from 0.
    pub point: usize,
    /// The vertex of the panels that is nearest to it.
    pub vertex: usize,
    /// How far that is from it, in mm.
    pub off_mm: f64,
}

/// The points that stay, in words; nothing without any.
pub(super) fn stayed_note(points: &[StayedPoint]) -> Option<String> {
    let off = points.iter().map(|point| point.off_mm).fold(0.0, f64::max);
    let name = |p: &StayedPoint| format!("{} (point {})", p.vertex, p.point + 1);
    let names: Vec<String> = points.iter().take(NAMED).map(name).collect();
    let more = if points.len() > NAMED { ", …" } else { "" };
    let verb = if points.len() == 1 { "vertex stands" } else { "vertices stand" };
    (!points.is_empty()).then(|| {
        format!(
            "{} {verb} at the points that stay: {}{more}; off by {} mm at most",
            points.len(),
            names.join(", "),
            short(off)
        )
    })
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

/// What became of a mirror plane, counted on the result by corners alone.
#[derive(Debug, Clone, PartialEq)]
pub struct MirrorReport {
    /// The axis that the plane is square to, 0 to 2.
    pub axis: usize,
    /// Where it is, in mm.
    pub at_mm: f64,
    /// Pairs of panels that are images of each other.
    pub pairs: usize,
    /// Panels that lie across it and are images of themselves.
    pub across: usize,
    /// Panels that are neither.
    pub alone: usize,
    /// Corners count as images within this distance, in mm.
    pub tolerance_mm: f64,
}

impl MirrorReport {
    /// In words.
    pub(super) fn note(&self) -> String {
        let alone = match self.alone {
            0 => String::new(),
            alone => format!(", {alone} neither"),
        };
        format!(
            "mirrored across {} = {} mm: {} pairs of panels and {} across the plane{alone}, within {} mm",
            ["x", "y", "z"][self.axis],
            short(self.at_mm),
            self.pairs,
            self.across,
            short(self.tolerance_mm)
        )
    }
}

/// What became of families of lengths. Edges are of one length within `tolerance_mm`.
#[derive(Debug, Clone, PartialEq)]
pub struct FamilyReport {
    /// How many lengths were asked for.
    pub asked: usize,
    /// How many edges there are.
    pub edges: usize,
    /// How many lengths there were before, and are now.
    pub lengths: [usize; 2],
    /// How many edges have the length of a family, of those asked for.
    pub alike: usize,
    /// How many kinds of panels there were before, and are now.
    pub panels: [usize; 2],
    /// The largest distance of a panel from the surface before, and now.
    pub deviation_mm: [f64; 2],
    /// The largest distance of an edge from the length of its family, before and now.
    pub off_mm: [f64; 2],
    /// Within what lengths are alike.
    pub tolerance_mm: f64,
    /// Edges that have the length of no family, by a panel beside each, the worst first.
    pub missed: Vec<Place>,
}

impl FamilyReport {
    /// In words.
    pub(super) fn note(&self) -> String {
        let [before, now] = self.lengths;
        let [panels_before, panels] = self.panels;
        let [off_before, off] = self.off_mm.map(short);
        let [from, to] = self.deviation_mm.map(short);
        format!(
            "{} families of lengths asked for: {before} different lengths became {now} (within {} mm), and \
            {} of {} edges have the length of a family, the others are off by up to {off} mm (before \
            {off_before} mm); {panels_before} different panels became {panels}; the panels are off the \
            surface by {to} mm at most, where they were by {from} mm",
            self.asked,
            short(self.tolerance_mm),
            self.alike,
            self.edges,
        )
    }
}
