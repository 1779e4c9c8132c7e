//! What the machine does on every sheet, in order, without colours: layers of lines with a meaning
//! and a name.

use glam::DVec2;

use super::layout::{Sheet, SheetId};
use crate::net::PieceId;

/// One sheet as lines: origin bottom left, y up, in mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Drawing {
    /// The sheet.
    pub sheet: SheetId,
    /// The part, where it shows only one.
    pub part: Option<PieceId>,
    /// Along x.
    pub width: f64,
    /// Along y.
    pub height: f64,
    /// All five layers in working order.
    pub layers: Vec<Layer>,
    /// Whole contours of the parts that share lines with others, which the layers hold without what
    /// others draw.
    pub whole: Vec<Mark>,
    /// Outlines of the two sides of bevelled plates, as they lie; for formats that can tell them
    /// apart from cuts. Whoever makes the plates adds them.
    pub sides: Vec<(PlateSide, Mark)>,
}

/// A side of a plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum PlateSide {
    /// The outside of the model.
    Front,
    /// The inside.
    Back,
}

/// What is done in one go.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// What is done.
    pub kind: LayerKind,
    /// Its lines, piece by piece.
    pub marks: Vec<Mark>,
}

/// The operations, in working order: what is cut out last cannot move before.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum LayerKind {
    /// Lettering.
    Engrave,
    /// Folds.
    Score,
    /// Holes, perforations and living hinges.
    CutInner,
    /// Outlines.
    CutOuter,
    /// For the eye only, never cut.
    Info,
}

/// What a line means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum MarkKind {
    /// Name of a piece.
    PieceName,
    /// Number of a seam, on both its sides.
    SeamNumber,
    /// The angle of a fold.
    FoldAngle,
    /// Where a stretch of seam ends, on both its sides.
    SeamMark,
    /// The fold between a piece and its flap, bent inwards.
    FlapFold,
    /// A convex fold, bent away from the viewer.
    MountainFold,
    /// A concave fold, bent towards the viewer.
    ValleyFold,
    /// A fold that is cut through with bridges.
    Perforation,
    /// A row of slits of a living hinge.
    Hinge,
    /// Boundary of a hole.
    Hole,
    /// A single line of the kerf coupon, open on purpose: its width is what is measured.
    Slit,
    /// Boundary of a piece that lies in a hole of another: cut before it.
    NestedOutline,
    /// Boundary of a piece.
    Outline,
    /// A square to measure after cutting or printing.
    Reference,
    /// Text for the operator.
    Note,
}

/// Lines that belong together under one name.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Unique in its drawing: `P01`, `P01-hole-1`, `P01-slit-1`, `P01-name`, `E012`,
    /// `E013-number-1`, `E013-mark-1`, `E012-angle`, `E013-flap`, `E012-slits-1`, `reference`,
    /// `note`.
    pub id: String,
    /// What it means.
    pub kind: MarkKind,
    /// The piece that it is on, if on any.
    pub piece: Option<PieceId>,
    /// Its lines; contours have exactly one unless they are held by tabs, letters and dashes
    /// several.
    pub strokes: Vec<Stroke>,
}

/// One polyline.
#[derive(Debug, Clone, PartialEq)]
pub struct Stroke {
    /// Its points.
    pub points: Vec<DVec2>,
    /// Whether the last point is joined to the first, which is not repeated.
    pub closed: bool,
}

impl LayerKind {
    /// All layers in working order.
    pub const ALL: [Self; 5] =
        [Self::Engrave, Self::Score, Self::CutInner, Self::CutOuter, Self::Info];

    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Engrave => "engrave",
            Self::Score => "score",
            Self::CutInner => "cut-inner",
            Self::CutOuter => "cut-outer",
            Self::Info => "info",
        }
    }
}

impl MarkKind {
    /// The layer that holds it.
    pub const fn layer(self) -> LayerKind {
        match self {
            Self::PieceName | Self::SeamNumber | Self::FoldAngle | Self::SeamMark => {
                LayerKind::Engrave
            }
            Self::FlapFold | Self::MountainFold | Self::ValleyFold => LayerKind::Score,
            Self::Perforation | Self::Hinge | Self::Hole | Self::Slit | Self::NestedOutline => {
                LayerKind::CutInner
            }
            Self::Outline => LayerKind::CutOuter,
            Self::Reference | Self::Note => LayerKind::Info,
        }
    }

    /// The name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::PieceName => "name",
            Self::SeamNumber => "number",
            Self::FoldAngle => "angle",
            Self::SeamMark => "mark",
            Self::FlapFold => "flap",
            Self::MountainFold => "mountain",
            Self::ValleyFold => "valley",
            Self::Hole => "hole",
            Self::Slit => "slit",
            Self::Perforation => "perforation",
            Self::Hinge => "hinge",
            Self::NestedOutline | Self::Outline => "outline",
            Self::Reference => "reference",
            Self::Note => "note",
        }
    }
}

impl Stroke {
    /// Its length in mm.
    pub fn length(&self) -> f64 {
        let open: f64 = self.points.windows(2).map(|w| w[0].distance(w[1])).sum();
        let closing = self.points.first().zip(self.points.last()).filter(|_| self.closed);
        open + closing.map_or(0.0, |(a, b)| a.distance(*b))
    }
}

impl Drawing {
    pub(crate) fn new(sheet: &Sheet) -> Self {
        let layers = LayerKind::ALL.map(|kind| Layer { kind, marks: Vec::new() }).to_vec();
        Self {
            sheet: sheet.id,
            part: None,
            width: sheet.width,
            height: sheet.height,
            layers,
            whole: Vec::new(),
            sides: Vec::new(),
        }
    }

    /// The name of its file without the ending: `sheet-01`; of a part `P01`.
    pub fn file_stem(&self) -> String {
        self.part.map_or_else(|| format!("sheet-{:02}", self.sheet.0 + 1), |part| part.to_string())
    }

    /// All marks in working order.
    pub fn marks(&self) -> impl Iterator<Item = &Mark> {
        self.layers.iter().flat_map(|l| &l.marks)
    }

    /// Length of all cuts, in mm.
    pub fn cut_length(&self) -> f64 {
        self.length(|l| matches!(l, LayerKind::CutInner | LayerKind::CutOuter))
    }

    /// Length of all score lines as drawn, in mm.
    pub fn score_length(&self) -> f64 {
        self.length(|l| l == LayerKind::Score)
    }

    fn length(&self, wanted: impl Fn(LayerKind) -> bool) -> f64 {
        self.layers.iter().filter(|l| wanted(l.kind)).map(Layer::length).sum()
    }

    pub(crate) fn add(
        &mut self,
        kind: MarkKind,
        id: String,
        piece: Option<PieceId>,
        strokes: Vec<Stroke>,
    ) {
        let layer = self.layers.iter_mut().find(|l| l.kind == kind.layer());
        layer.expect("a drawing has all layers").marks.push(Mark { id, kind, piece, strokes });
    }
}
