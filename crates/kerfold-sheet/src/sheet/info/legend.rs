//! The words of the legend: project, sheet, kerf, what the colours mean, which side is seen.

use crate::sheet::drawing::{Drawing, LayerKind};
use crate::sheet::files::Rgb;
use crate::sheet::letter::glyph;
use crate::sheet::params::SheetParams;

/// Letters of the project's name that are shown.
const LONGEST_TITLE: usize = 36;

/// A line of the legend.
pub(super) struct Line {
    pub words: String,
    /// Whether it tells colours, which not every format keeps.
    pub is_of_colours: bool,
}

/// Text in letters that the lettering has: capitals, others left out.
pub(in crate::sheet) fn lettered(text: &str) -> String {
    let capitals = text.to_uppercase().replace(['_', '\t'], " ");
    let known = capitals.chars().filter(|&c| glyph(c).is_some());
    known.collect::<String>().split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The lines of a sheet's legend. `sheets` is the number of all sheets; `shows_outside` says that
/// the pieces are seen from outside the model.
pub(super) fn lines(
    drawing: &Drawing,
    params: &SheetParams,
    (sheets, shows_outside): (usize, bool),
) -> Vec<Line> {
    let short = |value: f64| (value * 1e4).round() / 1e4;
    let (width, height) = (short(drawing.width), short(drawing.height));
    let name = lettered(params.files.title.as_deref().unwrap_or_default());
    let name: String = name.chars().take(LONGEST_TITLE).collect();
    let which = format!("{} OF {sheets}", drawing.sheet);
    let first = if name.is_empty() { which } else { format!("{}  {which}", name.trim_end()) };
    let kerf = short(params.stock.kerf.mm());
    let mut lines = vec![first, format!("{width} X {height} MM  KERF {kerf} MM")];
    if let Some(material) = &params.stock.made_of {
        lines.push(lettered(&material.title));
    }
    if shows_outside {
        lines.push("THIS SIDE OUT".to_owned());
    }
    let plain = lines.into_iter().map(|words| Line { words, is_of_colours: false });
    let colours = colours(drawing, params);
    plain.chain(colours.map(|words| Line { words, is_of_colours: true })).collect()
}

/// What each colour on the sheet means, a line for cuts and one for the rest.
fn colours(drawing: &Drawing, params: &SheetParams) -> impl Iterator<Item = String> {
    let style = params.style();
    let name = |kind| word(style.pen(kind).colour);
    let [inner, outer] = [LayerKind::CutInner, LayerKind::CutOuter].map(name);
    let has = |kind| !drawing.is_empty(kind);
    let mut cuts = if inner == outer || !has(LayerKind::CutInner) {
        format!("{outer} CUTS")
    } else {
        format!("{inner} CUTS HOLES  {outer} CUTS OUTLINES")
    };
    if has(LayerKind::Score) {
        cuts += &format!("  {} FOLDS", name(LayerKind::Score));
    }
    let mut rest = format!("{} IS NOT CUT", name(LayerKind::Info));
    if has(LayerKind::Engrave) {
        rest = format!("{} LETTERS  {rest}", name(LayerKind::Engrave));
    }
    [cuts, rest].into_iter()
}

/// The name of a colour, where it has one.
fn word(colour: Rgb) -> String {
    let known = match colour {
        [255, 0, 0] => "RED",
        [0, 0, 255] => "BLUE",
        [0, 0, 0] => "BLACK",
        [0, 255, 0] | [0, 0xE0, 0] => "GREEN",
        [128, 128, 128] => "GREY",
        [0xF3, 0x69, 0x26] => "ORANGE",
        [255, 0, 255] => "MAGENTA",
        [0, 255, 255] => "CYAN",
        [255, 255, 0] => "YELLOW",
        [r, g, b] => return format!("#{r:02X}{g:02X}{b:02X}"),
    };
    known.to_owned()
}
