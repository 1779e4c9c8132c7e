//! Which files are written for a sheet, and in which colours.

use std::fmt;
use std::str::FromStr;

use clap::ValueEnum;
use glam::DVec2;
use serde::{Deserialize, Deserializer};

use super::drawing::LayerKind;
use crate::code::codes;

/// Which files are written of sheets.
#[derive(Debug, Clone, PartialEq, Eq, Default, clap::Args, Deserialize)]
pub struct FileParams {
    /// Colours and stroke widths of the drawing
    #[arg(long, value_enum, default_value = "red-cut")]
    #[serde(default)]
    pub preset: Preset,
    /// File formats of the sheets: svg, dxf, pdf, lbrn2, separated by commas
    #[arg(long, value_name = "LIST", default_value = "svg")]
    #[serde(default)]
    pub format: Formats,
    /// Also print every sheet at true size on several pages of this paper, as one PDF
    #[arg(long, value_enum, value_name = "PAPER")]
    #[serde(default)]
    pub tile: Option<Paper>,
    /// Whether every part gets files of its own besides the sheets
    #[arg(long, value_enum, default_value = "off")]
    #[serde(default)]
    pub part_files: PartFiles,
    /// Whether a square to measure after cutting or printing stands on the info layer, beside the
    /// parts
    #[arg(long, value_enum, default_value = "on")]
    #[serde(default)]
    pub reference: Reference,
    /// Name of the project in the legend of every sheet; the name of the recipe or of the model
    /// unless given
    #[arg(long, value_name = "NAME")]
    #[serde(default)]
    pub title: Option<String>,
}

/// Colours and stroke widths that a machine's software expects.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// Red cuts, blue scores, black engraving.
    #[default]
    RedCut,
    /// The colours of boxes.py.
    Boxes,
    /// The palette of LightBurn; the info layer is its tool layer.
    Lightburn,
    /// Ponoko: blue cuts, red line engraving.
    Ponoko,
    /// Glowforge: one step per colour.
    Glowforge,
    /// Epilog, Trotec, ULS: hairlines.
    Epilog,
    /// Cricut: red is cut, blue scored, black drawn by the pen; grey is for the operation Guide.
    Cricut,
    /// Silhouette: red is cut, blue scored, green drawn by the pen; black is printed, with
    /// registration marks in a margin of 15 mm or more.
    Silhouette,
}

/// A format of sheet files.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, ValueEnum)]
pub enum SheetFormat {
    /// Scalable Vector Graphics, millimetres.
    Svg,
    /// AutoCAD drawing exchange, R2000, millimetres.
    Dxf,
    /// Portable Document Format, one page as large as the sheet.
    Pdf,
    /// LightBurn project.
    Lbrn2,
}

impl SheetFormat {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::Svg, Self::Dxf, Self::Pdf, Self::Lbrn2];

    /// The ending of the files, without a dot.
    pub const fn extension(self) -> &'static str {
        match self {
            Self::Svg => "svg",
            Self::Dxf => "dxf",
            Self::Pdf => "pdf",
            Self::Lbrn2 => "lbrn2",
        }
    }
}

/// One or more formats, each once, in the order of [`SheetFormat::ALL`]. Typed as `svg,dxf`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Formats(Vec<SheetFormat>);

/// A word that names no format.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{word}` is no format of sheets; use one or more of svg, dxf, pdf, lbrn2, as in svg,dxf")]
pub struct FormatsError {
    /// What was typed.
    pub word: String,
}

codes!(error struct FormatsError = 541);

impl Formats {
    /// The formats.
    pub fn iter(&self) -> impl Iterator<Item = SheetFormat> + '_ {
        self.0.iter().copied()
    }
}

impl Default for Formats {
    fn default() -> Self {
        Self(vec![SheetFormat::Svg])
    }
}

impl FromIterator<SheetFormat> for Formats {
    fn from_iter<I: IntoIterator<Item = SheetFormat>>(formats: I) -> Self {
        let mut formats: Vec<SheetFormat> = formats.into_iter().collect();
        formats.sort();
        formats.dedup();
        Self(formats)
    }
}

impl FromStr for Formats {
    type Err = FormatsError;
    fn from_str(text: &str) -> Result<Self, FormatsError> {
        let read = |word: &str| {
            let word = word.trim();
            let found =
                SheetFormat::ALL.into_iter().find(|f| f.extension().eq_ignore_ascii_case(word));
            found.ok_or_else(|| FormatsError { word: word.to_owned() })
        };
        text.split(',').map(read).collect()
    }
}

impl fmt::Display for Formats {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.iter().map(|f| f.extension()).collect::<Vec<_>>().join(","))
    }
}

impl<'de> Deserialize<'de> for Formats {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// Paper that a sheet is printed on in tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Paper {
    /// 210 × 297 mm.
    A4,
    /// 297 × 420 mm.
    A3,
    /// 8.5 × 11 in.
    Letter,
}

impl Paper {
    /// Width and height in mm, upright.
    pub const fn mm(self) -> DVec2 {
        match self {
            Self::A4 => DVec2::new(210.0, 297.0),
            Self::A3 => DVec2::new(297.0, 420.0),
            Self::Letter => DVec2::new(215.9, 279.4),
        }
    }

    /// Its name in file names.
    pub const fn name(self) -> &'static str {
        match self {
            Self::A4 => "a4",
            Self::A3 => "a3",
            Self::Letter => "letter",
        }
    }
}

/// Whether every part gets files of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PartFiles {
    /// Sheets only.
    #[default]
    Off,
    /// Besides the sheets one file per part in every format, for shops that nest themselves.
    On,
}

/// Whether a reference square stands on the info layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reference {
    /// A square of 100 mm beside the parts; a smaller one or a bar in the margin where there is no
    /// room.
    #[default]
    On,
    /// None.
    Off,
}

/// A colour, red, green and blue.
pub type Rgb = [u8; 3];

/// Colours of the operations that take the place of the preset's.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Colours {
    /// Outlines.
    pub cut_outer: Option<Rgb>,
    /// Holes, perforations and living hinges.
    pub cut_inner: Option<Rgb>,
    /// Folds.
    pub score: Option<Rgb>,
    /// Lettering.
    pub engrave: Option<Rgb>,
}

/// How lines look in a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Style {
    /// Colours and widths.
    pub preset: Preset,
    /// What a material changes of them.
    pub colours: Colours,
}

/// How one layer is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pen {
    /// Its colour.
    pub colour: Rgb,
    /// Stroke width in mm.
    pub width: f64,
}

impl From<Preset> for Style {
    fn from(preset: Preset) -> Self {
        Self { preset, colours: Colours::default() }
    }
}

/// Red, blue and black as most machines sort them.
const RED: Rgb = [255, 0, 0];
const BLUE: Rgb = [0, 0, 255];
const BLACK: Rgb = [0, 0, 0];
const GREEN: Rgb = [0, 255, 0];
const GREY: Rgb = [128, 128, 128];

/// Stroke width that the eye sees on screen and on paper, in mm.
const VISIBLE: f64 = 0.2;

/// Widest stroke that Epilog, Trotec and ULS cut, in mm: 0.001 in.
const HAIRLINE: f64 = 0.0254;

/// Stroke width that Ponoko cuts, in mm.
const PONOKO: f64 = 0.01;

impl Style {
    /// Whether the info layer is for printing, not for the eye alone: with registration marks on it.
    pub fn prints_info(&self) -> bool {
        self.preset == Preset::Silhouette
    }

    /// The pen of a layer. Strokes are wide enough to be seen, but for machines that tell cuts from
    /// engraving by the width of the stroke: those get hairlines.
    pub fn pen(&self, layer: LayerKind) -> Pen {
        // In the order of `LayerKind::ALL`: engrave, score, inner cuts, outer cuts, info.
        let (colours, width) = match self.preset {
            Preset::RedCut | Preset::Glowforge => ([BLACK, BLUE, RED, RED, GREY], VISIBLE),
            Preset::Epilog => ([BLACK, BLUE, RED, RED, GREY], HAIRLINE),
            Preset::Boxes => ([GREEN, GREEN, BLUE, BLACK, GREY], VISIBLE),
            // C03, C02, C01, C00 and T1 of its palette; T1 is a tool layer, which is never run.
            Preset::Lightburn => ([[0, 0xE0, 0], RED, BLUE, BLACK, [0xF3, 0x69, 0x26]], VISIBLE),
            // Black means a filled area there; single strokes are line engraving, and so red.
            Preset::Ponoko => ([RED, RED, BLUE, BLUE, GREY], PONOKO),
            Preset::Cricut => ([BLACK, BLUE, RED, RED, GREY], VISIBLE),
            // A sensor looks for its marks in black.
            Preset::Silhouette => ([GREEN, BLUE, RED, RED, BLACK], VISIBLE),
        };
        let (at, own) = match layer {
            LayerKind::Engrave => (0, self.colours.engrave),
            LayerKind::Score => (1, self.colours.score),
            LayerKind::CutInner => (2, self.colours.cut_inner),
            LayerKind::CutOuter => (3, self.colours.cut_outer),
            LayerKind::Info => (4, None),
        };
        Pen { colour: own.unwrap_or(colours[at]), width }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_are_read_once_each_and_strangers_named() {
        let formats: Formats = "pdf, svg,PDF".parse().expect("formats");
        assert_eq!(formats.to_string(), "svg,pdf");
        for (bad, word) in [("", "``"), ("svg,png", "`png`"), ("svg,", "``")] {
            let text = bad.parse::<Formats>().expect_err(bad).to_string();
            assert!(text.contains(word) && text.contains("lbrn2"), "{text}");
        }
    }

    #[test]
    fn only_machines_that_cut_by_width_get_hairlines_and_a_material_has_the_last_word() {
        for preset in Preset::value_variants() {
            let cuts_by_width = matches!(preset, Preset::Epilog | Preset::Ponoko);
            for layer in LayerKind::ALL {
                let width = Style::from(*preset).pen(layer).width;
                assert_eq!(width <= HAIRLINE, cuts_by_width, "{preset:?}");
                assert!(cuts_by_width || width == VISIBLE, "{preset:?}");
            }
        }
        let own = Colours { score: Some([1, 2, 3]), ..Colours::default() };
        let style = Style { preset: Preset::Boxes, colours: own };
        assert_eq!(style.pen(LayerKind::Score).colour, [1, 2, 3]);
        assert_eq!(style.pen(LayerKind::CutOuter).colour, BLACK);
    }
}
