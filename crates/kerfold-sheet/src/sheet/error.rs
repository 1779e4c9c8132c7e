//! What can go wrong between pieces and sheets.

use std::fmt;

use super::joint_kind::Joint;
use super::layout::SheetId;
use crate::code::codes;
use crate::net::PieceId;

/// Why pieces could not be laid out. The last three variants are the findings of [`super::verify`]:
/// our own bugs, reported instead of written to a file.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SheetError {
    /// A parameter outside its range.
    #[error("{name} is {value} mm, but must be at least {least} mm and finite")]
    OutOfRange {
        /// Which parameter.
        name: &'static str,
        /// What it was, in mm.
        value: f64,
        /// What it must be at least, in mm.
        least: f64,
    },
    /// An option that the joint does not use, or one that it needs.
    #[error("{}", joint_option(option, *joint, *is_missing))]
    JointOption {
        /// The option, as a flag without its dashes.
        option: &'static str,
        /// The joint.
        joint: Joint,
        /// Whether the option lacks; else it is one too many.
        is_missing: bool,
    },
    /// A length for dashes where nothing is dashed.
    #[error(
        "{option} needs folds that are dashed or perforated; choose a score that is, or leave it \
        out"
    )]
    ScoreOption {
        /// The option, as a flag without its dashes.
        option: &'static str,
    },
    /// A width for holding tabs without any.
    #[error("hold-width needs the number of tabs that hold every part; give hold, for example 3")]
    HoldOption,
    /// More holding tabs than make sense.
    #[error("hold is {count}, but must be 100 at most")]
    TooManyTabs {
        /// What it was.
        count: u32,
    },
    /// A speed that nothing moves at.
    #[error("speed {name} is {value} mm/s, but must be more than 0 and finite")]
    BadSpeed {
        /// Which one.
        name: &'static str,
        /// What it was.
        value: f64,
    },
    /// A material by name that nobody looked up.
    #[error("material {name} was not looked up; take the parameters from `recipe::with_material`")]
    MaterialNotTaken {
        /// The name.
        name: String,
    },
    /// An angle of flaps outside its range.
    #[error("flap-angle is {degrees}°, but must be 20° to 90°")]
    FlapAngle {
        /// What it was.
        degrees: f64,
    },
    /// The margin leaves nothing of the sheet.
    #[error(
        "a margin of {margin} mm and a kerf of {kerf} mm leaves no room on a {width} × {height} mm \
        sheet; \
         choose a smaller margin or a larger sheet"
    )]
    MarginTooLarge {
        /// The free border.
        margin: f64,
        /// The width of the cut.
        kerf: f64,
        /// The sheet.
        width: f64,
        /// The sheet.
        height: f64,
    },
    /// Pieces that fit on no sheet at any angle; all of them.
    #[error("{}", too_large(pieces, *width, *height, *margin))]
    PiecesTooLarge {
        /// The pieces with the box each needs.
        pieces: Vec<TooLarge>,
        /// The sheet.
        width: f64,
        /// The sheet.
        height: f64,
        /// The free border.
        margin: f64,
    },
    /// A polygon of the sheet that is none.
    #[error("{name}: {why}; give corners in order around the polygon, within the sheet")]
    BadPolygon {
        /// The parameter.
        name: &'static str,
        /// What is wrong.
        why: String,
    },
    /// Guillotine cuts with what they cannot do.
    #[error(
        "guillotine cuts need whole rectangular sheets and no groups; leave out sheet-outline, \
        defects and together"
    )]
    GuillotineOption,
    /// Lines shared by parts, and a cut that has a width.
    #[error(
        "common-line needs a kerf of 0, and it is {kerf} mm, given or the material's: a shared \
        line would take {} mm of both \
         parts; leave out common-line, or name no material and no kerf", kerf / 2.0
    )]
    CommonLineKerf {
        /// The width of the cut.
        kerf: f64,
    },
    /// Lines shared by parts, and what cannot be done with them.
    #[error("{option} does not go with common-line: give one of the two")]
    CommonLineOption {
        /// The option, as a flag without its dashes.
        option: &'static str,
    },
    /// A sheet that takes far too many pages of paper.
    #[error(
        "a sheet of {width} × {height} mm would be printed on about {pages} pages, and {most} are \
        the most; take a smaller sheet or larger paper, or leave out tile"
    )]
    TooManyTiles {
        /// Width of the sheet in mm.
        width: f64,
        /// Height of the sheet in mm.
        height: f64,
        /// About how many pages.
        pages: f64,
        /// How many there may be.
        most: f64,
    },
    /// A parameter names a piece that is not there.
    #[error(
        "{name} names piece {piece}, but there are only {pieces} pieces, P01 to {}",
        PieceId(pieces.saturating_sub(1))
    )]
    NoSuchPiece {
        /// The parameter.
        name: &'static str,
        /// The piece.
        piece: PieceId,
        /// How many there are.
        pieces: usize,
    },
    /// Pieces that fit on a sheet by their size, but for which no place was found even on an empty
    /// one.
    #[error("{}", no_place(pieces))]
    NoPlace {
        /// One piece, or those of one group.
        pieces: Vec<PieceId>,
    },
    /// A piece turned as it may not be.
    #[error("piece {piece} is turned by {rotation}°, which is not allowed; please report this bug")]
    Turned {
        /// The piece.
        piece: PieceId,
        /// Its angle.
        rotation: f64,
    },
    /// Pieces of one group on two sheets.
    #[error("pieces {first} and {second} must share a sheet and do not; please report this bug")]
    Parted {
        /// One piece.
        first: PieceId,
        /// The other.
        second: PieceId,
    },
    /// A piece in the way of a defect or over the outline of the sheet.
    #[error(
        "piece {piece} on sheet {sheet} is {distance} mm from {what} instead of {least} mm; please \
        report this bug"
    )]
    OnDefect {
        /// The piece.
        piece: PieceId,
        /// The sheet.
        sheet: SheetId,
        /// A defect, or the outline of the sheet.
        what: &'static str,
        /// Their distance; 0 when they touch or overlap.
        distance: f64,
        /// What it must be.
        least: f64,
    },
    /// A piece that a guillotine cut would cut through.
    #[error(
        "a cut from edge to edge runs through piece {piece} on sheet {sheet}; please report this \
        bug"
    )]
    CutThrough {
        /// The piece.
        piece: PieceId,
        /// The sheet.
        sheet: SheetId,
    },
    /// An outline or hole that bounds no area.
    #[error(
        "contour {contour} of piece {piece} has {corners} corners or numbers that are not finite; \
        unfold the mesh again"
    )]
    BadContour {
        /// The piece.
        piece: PieceId,
        /// 0 for the outline, then the holes.
        contour: usize,
        /// Its number of corners.
        corners: usize,
    },
    /// An outline that crosses itself or runs clockwise cannot grow by the kerf.
    #[error(
        "the outline of piece {piece} falls into {parts} parts when it grows by half the kerf; \
        unfold the mesh again"
    )]
    KerfSplit {
        /// The piece.
        piece: PieceId,
        /// Number of parts; one is right.
        parts: usize,
    },
    /// A fold or seam names a piece that the net does not hold.
    #[error(
        "edge {edge} lies on piece {piece}, which the net does not hold; read the pieces file again"
    )]
    UnknownPiece {
        /// The edge's name.
        edge: String,
        /// The missing piece.
        piece: PieceId,
    },
    /// A character without a glyph.
    #[error(
        "no glyph for {character:?} in {text:?}; use A-Z, 0-9, space and - . / # + : _ ° % , ( ) = × Ø <"
    )]
    NoGlyph {
        /// The character.
        character: char,
        /// The text that holds it.
        text: String,
    },
    /// A piece on no sheet, or on several.
    #[error("piece {piece} was placed {times} times instead of once; please report this bug")]
    NotPlacedOnce {
        /// The piece.
        piece: PieceId,
        /// How often it was placed.
        times: usize,
    },
    /// A cut line in the margin or off the sheet.
    #[error(
        "piece {piece} on sheet {sheet} reaches {by} mm over the margin; please report this bug"
    )]
    OverMargin {
        /// The piece.
        piece: PieceId,
        /// The sheet.
        sheet: SheetId,
        /// How far, in mm.
        by: f64,
    },
    /// Two pieces nearer than the spacing.
    #[error(
        "pieces {first} and {second} on sheet {sheet} are {distance} mm apart instead of {spacing} \
        mm; please report this bug"
    )]
    TooClose {
        /// One piece.
        first: PieceId,
        /// The other.
        second: PieceId,
        /// The sheet.
        sheet: SheetId,
        /// Their distance; 0 when they touch or overlap.
        distance: f64,
        /// What it must be.
        spacing: f64,
    },
    /// A line of the info layer on a part.
    #[error("{mark} lies on piece {piece} on sheet {sheet}; please report this bug")]
    InfoOnPart {
        /// The name of the mark.
        mark: String,
        /// The piece.
        piece: PieceId,
        /// The sheet.
        sheet: SheetId,
    },
}

codes!(error SheetError {
    OutOfRange = 501,
    JointOption = 502,
    ScoreOption = 503,
    HoldOption = 504,
    TooManyTabs = 505,
    BadSpeed = 506,
    MaterialNotTaken = 507,
    FlapAngle = 508,
    MarginTooLarge = 509,
    PiecesTooLarge = 510,
    BadPolygon = 511,
    GuillotineOption = 512,
    NoSuchPiece = 513,
    NoPlace = 514,
    Turned = 515,
    Parted = 516,
    OnDefect = 517,
    CutThrough = 518,
    BadContour = 519,
    KerfSplit = 520,
    UnknownPiece = 521,
    NoGlyph = 522,
    NotPlacedOnce = 523,
    OverMargin = 524,
    TooClose = 525,
    CommonLineKerf = 526,
    CommonLineOption = 527,
    TooManyTiles = 528,
    InfoOnPart = 531,
});

/// A piece that fits on no sheet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TooLarge {
    /// The piece.
    pub piece: PieceId,
    /// Longer side of its smallest bounding box, kerf included.
    pub width: f64,
    /// Shorter side of that box.
    pub height: f64,
    /// Number of its faces; a single face cannot be split further.
    pub faces: usize,
}

/// How many pieces a message lists before it only counts.
const LISTED: usize = 10;

fn no_place(pieces: &[PieceId]) -> String {
    let names: Vec<String> = pieces.iter().take(LISTED).map(ToString::to_string).collect();
    let more = if pieces.len() > LISTED { " …" } else { "" };
    let names = names.join(", ") + more;
    match pieces.len() {
        1 => format!(
            "no place on an empty sheet was found for piece {names}; use larger sheets, or look at \
            their outline and defects"
        ),
        _ => format!(
            "pieces {names} are to lie on one sheet, but no place was found for all of them on an \
            empty one; use larger sheets or smaller groups"
        ),
    }
}

fn joint_option(option: &str, joint: Joint, is_missing: bool) -> String {
    let name = clap::ValueEnum::to_possible_value(&joint)
        .map(|v| v.get_name().to_owned())
        .unwrap_or_default();
    if is_missing {
        format!("joint {name} needs the {option}; give it, for example 3mm")
    } else {
        format!("joint {name} does not use {option}; leave it out or choose another joint")
    }
}

fn too_large(pieces: &[TooLarge], width: f64, height: f64, margin: f64) -> String {
    let (usable_width, usable_height) = (width - 2.0 * margin, height - 2.0 * margin);
    let mut text = format!(
        "{} too large for a {width} × {height} mm sheet ({usable_width} × {usable_height} mm \
        inside the margin):",
        if pieces.len() == 1 {
            "1 piece is".to_owned()
        } else {
            format!("{} pieces are", pieces.len())
        },
    );
    for p in pieces.iter().take(LISTED) {
        text += &format!(" {} needs {:.1} × {:.1} mm", p.piece, p.width, p.height);
        text += if p.faces == 1 { " (a single face);" } else { ";" };
    }
    if pieces.len() > LISTED {
        text += &format!(" and {} more;", pieces.len() - LISTED);
    }
    let need = pieces.iter().fold((0.0, 0.0), |(w, h), p| (p.width.max(w), p.height.max(h)));
    // Rounded up, so that the sheet asked for is large enough.
    let need = ((need.0 + 2.0 * margin).ceil(), (need.1 + 2.0 * margin).ceil());
    text += &format!(" use sheets of {} × {} mm, more pieces, or a smaller model", need.0, need.1);
    text
}

impl fmt::Display for SheetId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "S{:02}", self.0 + 1)
    }
}
