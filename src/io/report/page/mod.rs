//! The report of `check` for people who were not there: what stands on its pages, in order, before
//! it is HTML or PDF.
//!
//! Both writers are fed with the same content, so neither can say more than the other. Pictures
//! come as bytes, since drawing is not this room's work.

mod sections;
pub(super) mod words;

use clap::ValueEnum;

pub(super) use self::sections::content;
use crate::check::{Details, Report};
use crate::mesh::FaceId;

/// Which rows the lists of a report have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum ReportRows {
    /// The worst 24 of each list.
    #[default]
    Worst,
    /// All, ascending.
    All,
}

/// Pictures for a report, as PNG files.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ReportPictures {
    /// The whole model.
    pub views: Vec<ReportPicture>,
    /// The worst panels, worst first.
    pub panels: Vec<PanelPictures>,
}

/// A picture with what it shows.
#[derive(Debug, Clone, PartialEq)]
pub struct ReportPicture {
    /// What it shows and what its colours mean, in a sentence or two.
    pub caption: String,
    /// The PNG file.
    pub png: Vec<u8>,
}

/// Pictures of one panel.
#[derive(Debug, Clone, PartialEq)]
pub struct PanelPictures {
    /// The face.
    pub face: FaceId,
    /// Where it is on the model; a PNG file.
    pub place: Vec<u8>,
    /// The panel with its neighbours; a PNG file.
    pub close: Vec<u8>,
}

/// What a report for people is made from.
#[derive(Debug, Clone, Copy)]
pub struct ReportPage<'a> {
    /// The name of the model, such as its file's.
    pub title: &'a str,
    /// What was measured and found.
    pub report: &'a Report,
    /// Vertices and edges.
    pub details: &'a Details,
    /// Pictures.
    pub pictures: &'a ReportPictures,
    /// Which rows the lists have.
    pub rows: ReportRows,
    /// The command line that made it.
    pub command: &'a str,
}

/// What kind of report it is.
pub(super) const KIND: &str = "Planarity and valence report";

/// The whole report.
pub(super) struct Content<'a> {
    pub(super) title: &'a str,
    /// Whether everything is kept, and the same in words.
    pub(super) verdict: (bool, String),
    /// What the model is, by name.
    pub(super) facts: Vec<(&'static str, Words)>,
    pub(super) views: &'a [ReportPicture],
    pub(super) sections: Vec<Section<'a>>,
    pub(super) command: &'a str,
}

/// A part under a heading.
pub(super) struct Section<'a> {
    pub(super) title: String,
    pub(super) blocks: Vec<Block<'a>>,
}

/// A piece of a section.
pub(super) enum Block<'a> {
    Text(Words),
    /// Smaller and paler.
    Note(Words),
    Table(Table),
    Chart(Chart),
    Panels(Vec<PanelCard<'a>>),
    /// Terms and what they mean.
    Terms(&'static [(&'static str, &'static str)]),
}

/// A stretch of text.
pub(super) type Words = Vec<Word>;

/// A piece of a text.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Word {
    Text(String),
    /// Something to type.
    Code(&'static str),
    /// A number, shown with four digits.
    Figure(f64),
    /// `pass` or `fail`.
    Verdict(bool),
}

/// Rows of cells.
pub(super) struct Table {
    /// What is listed, in a word.
    pub(super) class: &'static str,
    pub(super) head: &'static [&'static str],
    pub(super) rows: Vec<Vec<Words>>,
}

/// Bars with counts.
pub(super) struct Chart {
    /// What it shows, for those who cannot see it.
    pub(super) name: &'static str,
    /// What stands below all bars.
    pub(super) axis: &'static str,
    pub(super) bars: Vec<Bar>,
    /// A dashed line before the bar of that number, or between two if it has a fraction, and what
    /// it says.
    pub(super) limit: Option<(f64, &'static str)>,
}

/// One bar.
pub(super) struct Bar {
    /// What stands below it; may be empty.
    pub(super) label: String,
    /// How high it is.
    pub(super) count: usize,
    /// Whether what it counts is within the limit.
    pub(super) is_kept: bool,
}

impl Bar {
    /// Red, green, blue.
    pub(super) const fn colour(&self) -> [u8; 3] {
        if self.is_kept { [96, 140, 190] } else { [190, 60, 48] }
    }
}

/// One of the worst panels.
pub(super) struct PanelCard<'a> {
    pub(super) name: String,
    pub(super) is_kept: bool,
    pub(super) sides: String,
    pub(super) pictures: &'a PanelPictures,
    /// Figures with their units.
    pub(super) figures: Vec<(Words, &'static str)>,
}

impl Table {
    /// The column that is text and takes what room is left; all others are as wide as they must be.
    pub(super) fn wide_column(&self) -> Option<usize> {
        (self.class == "findings").then_some(1)
    }
}
