//! A drawing as it is machined: lines, each with an operation; texts; what could not be read.

use glam::DVec2;

/// One page of a file, in millimetres, origin bottom left, y up.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Artwork {
    /// Width and height of the page, where the file has one.
    pub size: Option<DVec2>,
    /// What the file says about its unit.
    pub unit: UnitState,
    /// All lines that would be machined or seen, in the order of the file.
    pub paths: Vec<ArtPath>,
    /// Live text.
    pub texts: Vec<ArtText>,
    /// What the file holds besides, by kind: not judged.
    pub unread: Vec<(String, usize)>,
    /// What was taken to be so without the file saying it, or read in part, in words.
    pub notes: Vec<String>,
    /// How many lines do not lie flat, and a place where one is; they are seen from above.
    pub not_flat: Option<(usize, DVec2)>,
}

/// What a file says about its unit.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum UnitState {
    /// The unit is said.
    #[default]
    Known,
    /// Nothing is said; the words tell what was assumed.
    Missing(&'static str),
    /// The file contradicts itself; the words tell how.
    Contradictory(&'static str),
}

/// One line, curves flattened.
#[derive(Debug, Clone, PartialEq)]
pub struct ArtPath {
    /// Its points; a closed line does not repeat the first.
    pub points: Vec<DVec2>,
    /// Whether the file says that it is closed.
    pub closed: bool,
    /// What is done along it.
    pub operation: Operation,
    /// Its layer, or its colour where the file has no layers.
    pub layer: String,
    /// Its name, where it has one.
    pub name: Option<String>,
}

/// Text that is no lines.
#[derive(Debug, Clone, PartialEq)]
pub struct ArtText {
    /// What it says, as far as known.
    pub text: String,
    /// Where it begins.
    pub at: DVec2,
    /// What is done with it; a note on a layer that is never machined does no harm.
    pub operation: Operation,
}

/// What is done along a line, in working order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Operation {
    /// Marked.
    Engrave,
    /// Folded along.
    Score,
    /// Cut through, and the file says that it is inside a part.
    CutInner,
    /// Cut through, and the file does not say where.
    Cut,
    /// Cut through, and the file says that it bounds a part.
    CutOuter,
    /// Never machined.
    Info,
}

impl Operation {
    /// What the name of a layer says, if anything.
    pub fn of_name(name: &str) -> Option<Self> {
        let name = name.to_ascii_lowercase();
        let has = |words: &[&str]| words.iter().any(|w| name.contains(w));
        if has(&[
            "info",
            "guide",
            "construction",
            "dimension",
            "defpoints",
            "reference",
            "sheet border",
        ]) {
            Some(Self::Info)
        } else if has(&["engrav", "etch", "mark", "raster", "letter"]) {
            Some(Self::Engrave)
        } else if has(&["score", "fold", "bend", "crease", "perf"]) {
            Some(Self::Score)
        } else if has(&["inner", "inside", "interior", "hole"]) {
            Some(Self::CutInner)
        } else if has(&["outer", "outside", "exterior", "outline"]) {
            Some(Self::CutOuter)
        } else if has(&["cut", "through"]) {
            Some(Self::Cut)
        } else {
            None
        }
    }

    /// Whether it goes through the material.
    pub const fn is_cut(self) -> bool {
        matches!(self, Self::Cut | Self::CutInner | Self::CutOuter)
    }

    /// Its name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Engrave => "engrave",
            Self::Score => "score",
            Self::CutInner => "cut-inner",
            Self::Cut => "cut",
            Self::CutOuter => "cut-outer",
            Self::Info => "info",
        }
    }
}
