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
    /// What the name of a layer tells, if anything.
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

impl Artwork {
    /// Gives every path without a telling layer an operation by its colour: where red is used, blue
    /// is scored, black and green are engraved; everything else is cut. `colours` are those of the
    /// paths, `None` where the layer told.
    pub fn operations_by_colour(&mut self, colours: &[Option<[u8; 3]>]) {
        let is = |c: [u8; 3], want: [bool; 3]| {
            (0..3).all(|i| if want[i] { c[i] > 200 } else { c[i] < 60 })
        };
        let red = |c: &Option<[u8; 3]>| c.is_some_and(|c| is(c, [true, false, false]));
        let has_red = colours.iter().any(red);
        for (path, colour) in self.paths.iter_mut().zip(colours) {
            let Some(colour) = *colour else { continue };
            path.operation = if !has_red {
                Operation::Cut
            } else if is(colour, [false, false, true]) {
                Operation::Score
            } else if is(colour, [false; 3]) || is(colour, [false, true, false]) {
                Operation::Engrave
            } else {
                Operation::Cut
            };
        }
    }
}
