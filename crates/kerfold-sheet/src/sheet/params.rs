//! How sheets are laid out and drawn: one definition for the library, the command line and the
//! recipe.

use glam::DVec2;
use serde::Deserialize;

use super::drawing::LayerKind;
use super::error::SheetError;
use super::files::{Colours, FileParams, Style};
use super::joint::{JointParams, plan};
use super::joint_kind::Joint;
use super::letter::LetterParams;
use super::material::{Hex, Material, MaterialColours};
use super::nest::{NestParams, StockSheet, stock_sheets};
use super::score::ScoreParams;
use super::stock::StockParams;

/// The most pages of paper that one sheet may be printed on.
const MOST_TILES: f64 = 10_000.0;

/// How pieces are placed on sheets, joined, lettered and drawn.
#[derive(Debug, Clone, PartialEq, Default, clap::Args, Deserialize)]
pub struct SheetParams {
    /// What the pieces are cut from, and how.
    #[command(flatten)]
    #[serde(flatten)]
    pub stock: StockParams,
    /// Where pieces may lie.
    #[command(flatten)]
    #[serde(flatten)]
    pub nest: NestParams,
    /// What holds the sides of seams together.
    #[command(flatten)]
    #[serde(flatten)]
    pub joint: JointParams,
    /// How folds are drawn.
    #[command(flatten)]
    #[serde(flatten)]
    pub score: ScoreParams,
    /// What is engraved.
    #[command(flatten)]
    #[serde(flatten)]
    pub letter: LetterParams,
    /// Which files are written.
    #[command(flatten)]
    #[serde(flatten)]
    pub files: FileParams,
    /// What the pieces are. Nobody types it: whoever makes the pieces knows.
    #[arg(skip)]
    #[serde(skip)]
    pub pieces: PieceKind,
}

/// What the pieces of a net are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PieceKind {
    /// Faces that are connected at their folds: the cut of a piece is the border of its faces.
    #[default]
    Faces,
    /// Plates, one for each face: their cuts leave gaps to the borders of the faces and have
    /// fingers and holes, which lettering keeps clear of.
    Panels,
}

impl SheetParams {
    /// How far joints may stand out beyond the outlines of pieces, in mm; 0 for options that are
    /// refused later.
    pub fn joint_reach(&self) -> f64 {
        plan(&self.joint, &self.stock).map_or(0.0, |plan| plan.reach())
    }

    /// The sheets in the order in which they are used; the last as often as needed. Nothing for
    /// `sheet = none`.
    ///
    /// # Errors
    /// Numbers out of range, polygons that cross themselves, a margin that leaves nothing of a
    /// sheet.
    pub(crate) fn sheets(&self) -> Result<Option<Vec<StockSheet>>, SheetError> {
        let sheets = stock_sheets(&self.nest, &self.stock)?;
        sheets.iter().flatten().try_for_each(|sheet| self.check_tiles(sheet.stock.size))?;
        Ok(sheets)
    }

    /// Refuses sheets of impossible numbers, for callers that work long before they lay out.
    ///
    /// # Errors
    /// As [`super::lay_out`] for its parameters alone.
    pub fn check_sheets(&self) -> Result<(), SheetError> {
        self.sheets().map(drop)
    }

    /// Refuses a sheet that would be printed on far too many pages, before any work is done.
    fn check_tiles(&self, size: DVec2) -> Result<(), SheetError> {
        let Some(paper) = self.files.tile else { return Ok(()) };
        let pages = (size / paper.mm()).ceil().element_product();
        if pages > MOST_TILES {
            let (width, height) = (size.x, size.y);
            return Err(SheetError::TooManyTiles { width, height, pages, most: MOST_TILES });
        }
        Ok(())
    }

    /// The same with everything that the material decides: its kerf where none is given, its
    /// thickness where the joint needs one and none is given, its colours and speeds.
    pub fn with_material(&self, material: Material) -> Self {
        let mut params = self.clone();
        if params.stock.kerf.mm() == 0.0 {
            params.stock.kerf = material.kerf;
        }
        let is_thick = !matches!(
            params.joint.kind,
            Joint::None | Joint::Flaps | Joint::Rivets | Joint::Stitch
        );
        if is_thick && params.joint.thickness.is_none() {
            params.joint.thickness = Some(material.thickness);
        }
        params.stock.made_of = Some(material);
        params
    }

    /// The same with a name of the project, unless it has one already; an empty name is none.
    ///
    /// # Example
    /// ```
    /// use kerfold_sheet::sheet::SheetParams;
    ///
    /// let params = SheetParams::default().titled("lamp").titled("other");
    /// assert_eq!(params.files.title.as_deref(), Some("lamp"));
    /// ```
    pub fn titled(mut self, title: &str) -> Self {
        if self.files.title.is_none() && !title.is_empty() {
            self.files.title = Some(title.to_owned());
        }
        self
    }

    /// The colours and widths of lines.
    pub fn style(&self) -> Style {
        let of = |m: &Material| {
            let MaterialColours { cut_outer, cut_inner, score, engrave } = &m.colours;
            let [cut_outer, cut_inner, score, engrave] =
                [cut_outer, cut_inner, score, engrave].map(|c| c.map(|Hex(rgb)| rgb));
            Colours { cut_outer, cut_inner, score, engrave }
        };
        Style {
            preset: self.files.preset,
            colours: self.stock.made_of.as_ref().map(of).unwrap_or_default(),
        }
    }

    /// The speed of an operation in mm/s, where a material says .
    pub fn speed(&self, layer: LayerKind) -> Option<f64> {
        self.stock.made_of.as_ref().and_then(|m| m.speed.of(layer))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::stock::SheetSize;
    use crate::units::Length;

    #[derive(clap::Parser)]
    struct Line {
        #[command(flatten)]
        params: SheetParams,
    }

    #[test]
    fn the_three_doors_have_the_same_defaults() {
        let line = <Line as clap::Parser>::parse_from(["x"]).params;
        let recipe: SheetParams = toml::from_str("").expect("all keys have defaults");
        assert_eq!(line, SheetParams::default());
        assert_eq!(recipe, SheetParams::default());
    }

    #[test]
    fn the_recipe_and_the_flags_say_the_same() {
        let text = "sheet = \"24x12in\"\nkerf = \"0.15mm\"\nmargin = 2\npreset = \
        \"lightburn\"\nlabels = \"pieces\"\nscore = \"dashed\"\njoint = \"none\"";
        let recipe: SheetParams = toml::from_str(text).expect("a recipe");
        let flags = [
            "x",
            "--sheet",
            "24inx12in",
            "--kerf",
            "0.15",
            "--margin",
            "2mm",
            "--preset",
            "lightburn",
        ];
        let flags = flags.into_iter().chain(["--labels", "pieces", "--score", "dashed"]);
        assert_eq!(<Line as clap::Parser>::parse_from(flags).params, recipe);
        assert_eq!(recipe.stock.sheet, SheetSize::of_mm(24.0 * 25.4, 12.0 * 25.4));
    }

    #[test]
    fn numbers_out_of_range_are_named() {
        let with = |change: fn(&mut SheetParams)| {
            let mut params = SheetParams::default();
            change(&mut params);
            params.stock.checked().map(|_| ()).expect_err("out of range").to_string()
        };
        assert!(with(|p| p.stock.kerf = Length::from_mm(-0.1)).contains("kerf is -0.1 mm"));
        assert!(with(|p| p.stock.spacing = Length::from_mm(0.0)).contains("at least 0.01 mm"));
        assert!(
            with(|p| p.stock.margin = Length::from_mm(200.0))
                .contains("leaves no room on a 600 × 400 mm sheet")
        );
        assert!(with(|p| p.stock.margin = Length::from_mm(f64::NAN)).contains("margin is NaN mm"));
        let none = SheetParams {
            stock: StockParams { sheet: SheetSize::None, ..StockParams::default() },
            ..SheetParams::default()
        };
        assert_eq!(none.stock.checked().expect("no sheet is fine"), None);
    }

    #[test]
    fn sheets_of_far_too_many_pages_are_refused_before_any_work() {
        let on_paper = |width: f64, height: f64| {
            let mut params = SheetParams::default();
            params.stock.sheet = SheetSize::of_mm(width, height);
            params.files.tile = Some(crate::sheet::Paper::A4);
            params.check_sheets()
        };
        assert_eq!(on_paper(21_000.0, 29_700.0), Ok(()), "100 × 100 pages are the most");
        let Err(SheetError::TooManyTiles { pages, most, .. }) = on_paper(21_001.0, 29_700.0) else {
            panic!("more pages are refused")
        };
        assert_eq!((pages, most), (10_100.0, MOST_TILES));
    }
}
