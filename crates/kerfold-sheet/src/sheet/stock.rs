//! What pieces are cut from: the size of sheets, the free border, the width of the cut.

use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

use glam::DVec2;
use serde::{Deserialize, Deserializer};

use super::error::SheetError;
use super::material::Material;
use crate::units::{Length, UnitError, parse_number};

/// Smallest spacing in mm: nearer cut lines would be one line in a file with four decimals.
const MIN_SPACING: f64 = 0.01;

/// What pieces are cut from, and how.
#[derive(Debug, Clone, PartialEq, clap::Args, Deserialize)]
pub struct StockParams {
    /// Size of a sheet, width x height: 600x400, 24inx12in, A0 to A5, letter, mat-12x12 and
    /// mat-12x24 (the mats of cutting plotters), jumbo (glass, 6000x3210); none for no sheets
    #[arg(long, value_name = "SIZE", default_value = "600x400")]
    #[serde(default = "default_sheet")]
    pub sheet: SheetSize,
    /// Free border of every sheet, measured to the cut line; 0 or more
    #[arg(long, value_name = "LENGTH", default_value = "5mm")]
    #[serde(default = "default_margin")]
    pub margin: Length,
    /// Least distance between the cut lines of two pieces; at least 0.01mm
    #[arg(long, value_name = "LENGTH", default_value = "3mm")]
    #[serde(default = "default_spacing")]
    pub spacing: Length,
    /// Name of the material, as in `ply3`: thickness, kerf, colours and speeds
    #[arg(long, value_name = "NAME")]
    #[serde(default)]
    pub material: Option<String>,
    /// A file with further materials (TOML)
    #[arg(long, value_name = "FILE")]
    #[serde(default)]
    pub materials: Option<PathBuf>,
    /// The material itself, once it was looked up
    #[arg(skip)]
    #[serde(skip)]
    pub made_of: Option<Material>,
    /// Full width of the cut: outlines grow by half of it, holes shrink; 0 or more. With 0 the
    /// material's kerf is taken
    #[arg(long, value_name = "LENGTH", default_value = "0mm")]
    #[serde(default)]
    pub kerf: Length,
    /// Holding tabs: at how many places the outline of every part is left uncut, 0 to 100
    #[arg(
        id = "hold",
        long = "hold",
        alias = "holding-tabs",
        value_name = "N",
        default_value = "0"
    )]
    #[serde(default, rename = "hold")]
    pub holding_tabs: u32,
    /// Width of a holding tab, at least 0.05mm; 0.5mm unless given
    #[arg(
        id = "hold_width",
        long = "hold-width",
        alias = "holding-tab-width",
        value_name = "LENGTH"
    )]
    #[serde(default, rename = "hold_width")]
    pub holding_tab_width: Option<Length>,
}

fn default_sheet() -> SheetSize {
    SheetSize::of_mm(600.0, 400.0)
}

fn default_margin() -> Length {
    Length::from_mm(5.0)
}

fn default_spacing() -> Length {
    Length::from_mm(3.0)
}

impl Default for StockParams {
    fn default() -> Self {
        Self {
            sheet: default_sheet(),
            margin: default_margin(),
            spacing: default_spacing(),
            material: None,
            materials: None,
            made_of: None,
            kerf: Length::default(),
            holding_tabs: 0,
            holding_tab_width: None,
        }
    }
}

/// The stock that pieces are cut from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SheetSize {
    /// No sheets: pieces only.
    None,
    /// Sheets of one size.
    Size {
        /// Along x, positive.
        width: Length,
        /// Along y, positive.
        height: Length,
    },
}

/// Sizes with a name, width and height in mm.
const NAMED_SIZES: [(&str, f64, f64); 10] = [
    ("a0", 841.0, 1189.0),
    ("a1", 594.0, 841.0),
    ("a2", 420.0, 594.0),
    ("a3", 297.0, 420.0),
    ("a4", 210.0, 297.0),
    ("a5", 148.0, 210.0),
    ("letter", 215.9, 279.4),
    // The mats of cutting plotters, 12 × 12 and 12 × 24 in.
    ("mat-12x12", 304.8, 304.8),
    ("mat-12x24", 304.8, 609.6),
    // The largest pane of float glass that is usually traded.
    ("jumbo", 6000.0, 3210.0),
];

impl SheetSize {
    /// A sheet of the given width and height in mm.
    pub const fn of_mm(width: f64, height: f64) -> Self {
        Self::Size { width: Length::from_mm(width), height: Length::from_mm(height) }
    }

    /// Width and height in mm; nothing for [`SheetSize::None`].
    pub fn mm(self) -> Option<DVec2> {
        match self {
            Self::None => None,
            Self::Size { width, height } => Some(DVec2::new(width.mm(), height.mm())),
        }
    }
}

impl FromStr for SheetSize {
    type Err = UnitError;
    fn from_str(text: &str) -> Result<Self, UnitError> {
        let name = text.trim().to_ascii_lowercase();
        if name == "none" {
            return Ok(Self::None);
        }
        if let Some(&(_, width, height)) = NAMED_SIZES.iter().find(|&&(n, ..)| n == name) {
            return Ok(Self::of_mm(width, height));
        }
        two_lengths(&name).filter(|(w, h)| w.mm() > 0.0 && h.mm() > 0.0).map_or_else(
            || {
                let example = "600x400, 24inx12in, A4, letter or none";
                Err(UnitError { text: text.to_owned(), wanted: "a sheet size", example })
            },
            |(width, height)| Ok(Self::Size { width, height }),
        )
    }
}

/// Reads `24inx12in`; a unit that stands only behind the second number is meant for both.
fn two_lengths(text: &str) -> Option<(Length, Length)> {
    let (first, second) = text.split_once(['x', '×'])?;
    let unit = second.trim_start_matches(|c: char| c.is_ascii_digit() || " .+-/".contains(c));
    let shared = parse_number(first).is_ok() && !unit.is_empty();
    let first = if shared { format!("{first}{unit}") } else { first.to_owned() };
    Some((first.parse().ok()?, second.parse().ok()?))
}

impl fmt::Display for SheetSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Size { width, height } => write!(f, "{width}x{height}"),
        }
    }
}

impl<'de> Deserialize<'de> for SheetSize {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(serde::de::Error::custom)
    }
}

/// A sheet in checked numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Stock {
    /// Width and height of the sheet.
    pub size: DVec2,
    /// Free border.
    pub margin: f64,
    /// Least distance between two pieces.
    pub spacing: f64,
}

impl Stock {
    /// Width and height inside the margin.
    pub fn usable(&self) -> DVec2 {
        self.size - DVec2::splat(2.0 * self.margin)
    }

    /// How far rounding may carry a point of a piece: a nanometre per metre of sheet.
    pub fn rounding(&self) -> f64 {
        1e-9 * self.size.length()
    }
}

impl StockParams {
    /// Whether a material that is named was looked up.
    pub(crate) fn check_material(&self) -> Result<(), SheetError> {
        match &self.material {
            Some(name) if self.made_of.is_none() => {
                Err(SheetError::MaterialNotTaken { name: name.clone() })
            }
            _ => Ok(()),
        }
    }

    /// Checks all numbers; nothing for `sheet = none`.
    ///
    /// # Errors
    /// [`SheetError::OutOfRange`] and [`SheetError::MarginTooLarge`] with the numbers.
    pub(crate) fn checked(&self) -> Result<Option<Stock>, SheetError> {
        for (name, value, least) in [
            ("margin", self.margin, 0.0),
            ("spacing", self.spacing, MIN_SPACING),
            ("kerf", self.kerf, 0.0),
        ] {
            // Written so that NaN is out of range too.
            if !(value.mm() >= least && value.mm().is_finite()) {
                return Err(SheetError::OutOfRange { name, value: value.mm(), least });
            }
        }
        let Some(size) = self.sheet.mm() else { return Ok(None) };
        for (name, value) in [("sheet width", size.x), ("sheet height", size.y)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SheetError::OutOfRange { name, value, least: f64::MIN_POSITIVE });
            }
        }
        let stock = Stock { size, margin: self.margin.mm(), spacing: self.spacing.mm() };
        if stock.usable().min_element() <= self.kerf.mm() {
            let margin = stock.margin;
            return Err(SheetError::MarginTooLarge {
                margin,
                kerf: self.kerf.mm(),
                width: size.x,
                height: size.y,
            });
        }
        Ok(Some(stock))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheet_sizes_are_read() {
        let mm =
            |text: &str| text.parse::<SheetSize>().ok().and_then(SheetSize::mm).map(|s| (s.x, s.y));
        assert_eq!(mm("600x400"), Some((600.0, 400.0)));
        assert_eq!(mm("600mm x 40cm"), Some((600.0, 400.0)));
        assert_eq!(mm("A4"), Some((210.0, 297.0)));
        assert_eq!(mm("Letter"), Some((215.9, 279.4)));
        assert_eq!(mm("mat-12x24"), Some((304.8, 609.6)));
        assert_eq!("none".parse(), Ok(SheetSize::None));
        for bad in ["", "600", "600x", "0x400", "-600x400", "B5", "600x400x2", "nanx1"] {
            let error = bad.parse::<SheetSize>().expect_err(bad);
            assert!(error.to_string().contains("600x400"), "{error}");
        }
    }
}
