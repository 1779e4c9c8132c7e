//! Which piece lies where on which sheet.

use glam::DVec2;

use super::joint::JointReport;
use crate::code::codes;
use crate::net::{EdgeLabel, PieceId};

/// A sheet's number, counted from 0, shown as `S01`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub struct SheetId(pub usize);

/// Which piece lies where: what `layout.json` holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// The sheets; none for `sheet = none`.
    pub sheets: Vec<Sheet>,
    /// Area of the pieces over the area of the sheets, 0 to 1.
    pub density: f64,
    /// Length of all cuts, in mm.
    pub cut_length: f64,
    /// Length of all score lines as drawn, in mm.
    pub score_length: f64,
}

/// One sheet of stock.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sheet {
    /// Its name.
    pub id: SheetId,
    /// Along x, in mm.
    pub width: f64,
    /// Along y, in mm.
    pub height: f64,
    /// The pieces on it, ascending by name.
    pub placed: Vec<Placed>,
    /// Which of the sheets at hand it is: their order in the parameter `stock`, then those of the
    /// usual size.
    pub stock: usize,
    /// Of the last sheet, the corners of the rectangle that is left whole, when it is worth
    /// keeping.
    pub offcut: Option<[DVec2; 2]>,
    /// Cuts from edge to edge in the order in which they are made; only for guillotine layouts.
    pub cuts: Vec<[DVec2; 2]>,
}

/// A piece on a sheet: a point p of the piece lands at R(rotation)·p + (x, y).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placed {
    /// The piece.
    pub piece: PieceId,
    /// Where the origin of the piece's frame lands, in mm; nine decimals.
    pub x: f64,
    /// As `x`.
    pub y: f64,
    /// Degrees counter-clockwise, in [0, 360); nine decimals.
    pub rotation: f64,
}

impl Placed {
    /// Where a point of the piece lands.
    pub fn apply(&self, p: DVec2) -> DVec2 {
        Turn::degrees(self.rotation).apply(p) + DVec2::new(self.x, self.y)
    }

    /// Where all points of a line land.
    pub fn apply_all(&self, points: &[DVec2]) -> Vec<DVec2> {
        let turn = Turn::degrees(self.rotation);
        points.iter().map(|&p| turn.apply(p) + DVec2::new(self.x, self.y)).collect()
    }
}

/// A rotation that is exact at multiples of 90°.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn(DVec2);

impl Turn {
    pub fn degrees(degrees: f64) -> Self {
        // Only the rest below 90° goes through the sine, so that quarter turns change no digit.
        let quarters = (degrees / 90.0).floor();
        let rest = DVec2::from_angle((degrees - quarters * 90.0).to_radians());
        Self(match quarters.rem_euclid(4.0) as u8 {
            0 => rest,
            1 => rest.perp(),
            2 => -rest,
            _ => -rest.perp(),
        })
    }

    pub fn apply(self, p: DVec2) -> DVec2 {
        self.0.rotate(p)
    }
}

/// What breaks a limit of the material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SheetFinding {
    /// Folds are scored nearer to each other than the material can take.
    NearScores,
}

codes!(finding SheetFinding { NearScores = 631 });

/// Folds of one face that are scored nearer to each other than the material can take: it tears or
/// breaks between them.
#[derive(Debug, Clone, PartialEq)]
pub struct NearScores {
    /// Number of pairs of folds without a common corner.
    pub pairs: usize,
    /// Pairs of folds that leave one corner.
    pub fans: Fans,
    /// The least distance between two, in mm.
    pub least: f64,
    /// What it should be: twice the thickness, at least 1 mm.
    pub limit: f64,
    /// Whether the thickness is known; else card is supposed, and nothing is found.
    pub is_known: bool,
    /// The pieces that have such folds.
    pub pieces: Vec<PieceId>,
}

/// Folds that leave one corner at so small an angle that they run near each other for long.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fans {
    /// Number of pairs of folds.
    pub pairs: usize,
    /// How far from its corner the longest of them runs nearer than the limit, in mm.
    pub longest: f64,
    /// How far from a corner folds may run near each other, in mm: ten times the limit.
    pub reach: f64,
}

/// What could not be drawn, in numbers; nothing here makes a sheet wrong.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SheetReport {
    /// Pieces too small for their name.
    pub unnamed_pieces: Vec<PieceId>,
    /// Sides of seams too short for their number.
    pub unnumbered_sides: usize,
    /// Folds between faces in one plane: nothing to score.
    pub flat_folds: usize,
    /// Folds shorter than what is left out at their ends.
    pub unscored_folds: usize,
    /// Holes narrower than the kerf, which nothing can cut.
    pub lost_holes: usize,
    /// Notches narrower than the kerf that could not be opened without dividing the piece: the
    /// flaps are connected there.
    pub closed_notches: usize,
    /// Slits, and notches narrower than the kerf, that are cut wider than they are, so that a
    /// closed path leads in and out again.
    pub widened_notches: usize,
    /// Seams whose two sides lie on one another: they are left uncut and fold.
    pub uncut_seams: Vec<EdgeLabel>,
    /// Holes that pieces have of their own, not for joints, and that are narrow for the thickness
    /// or near another cut.
    pub narrow_holes: usize,
    /// Folds without room for their angle, where angles were asked for.
    pub unmarked_angles: usize,
    /// Length of the lines that two parts share and that are cut once, in mm.
    pub shared_length: f64,
    /// What is left between two parts and the least that the material wants, in mm, when that is
    /// more.
    pub narrow_spacing: Option<[f64; 2]>,
    /// Pieces whose lines cross, which nesting took for larger than they are.
    pub widened_pieces: Vec<PieceId>,
    /// Sheets without room for the reference, beside the parts or in the margin.
    pub sheets_without_reference: usize,
    /// Sheets that a plotter has to find by marks, but that have no room for them.
    pub sheets_without_marks: usize,
    /// Sheets without room for all of the legend.
    pub sheets_without_legend: usize,
    /// Cuts from edge to edge, and borders of offcuts, without room for their label.
    pub unlabelled_lines: usize,
    /// Folds that are scored nearer to each other than the material can take.
    pub near_scores: Option<NearScores>,
    /// Whether the search was stopped before its effort was used up.
    pub is_stopped: bool,
    /// What became of the joints.
    pub joints: JointReport,
}
