//! The sheets at hand, in the order in which they are used.

use glam::DVec2;

use super::super::error::SheetError;
use super::super::stock::{Stock, StockParams};
use super::collision_field::Obstacle;
use super::parts::convex_parts;
use super::shape::Shape;
use super::{Bin, CommonLine, Guillotine, NestParams};
use crate::geom::polygon::{bounds, segments_cross, signed_area};

/// One sheet.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StockSheet {
    /// Size, margin and spacing.
    pub stock: Stock,
    /// Its true outline, counter-clockwise; empty for a rectangle.
    pub outline: Vec<DVec2>,
    /// Places that cannot be used, counter-clockwise.
    pub defects: Vec<Vec<DVec2>>,
}

/// The sheets in the order in which they are used; the last as often as needed. Nothing for
/// `sheet = none`.
///
/// # Errors
/// Numbers out of range, polygons that cross themselves, a margin that leaves nothing of a
/// sheet.
pub(crate) fn stock_sheets(
    nest: &NestParams,
    stock: &StockParams,
) -> Result<Option<Vec<StockSheet>>, SheetError> {
    let Some(usual) = stock.checked()? else { return Ok(None) };
    let outline = sound("sheet-outline", &nest.sheet_outline.0, usual.size)?;
    let usual = StockSheet { stock: usual, outline, defects: Vec::new() };
    let mut sheets = Vec::new();
    for &(size, count) in &nest.stock.0 {
        let of_size = StockParams { sheet: size, ..stock.clone() };
        if let Some(stock) = of_size.checked()? {
            let sheet = StockSheet { stock, outline: Vec::new(), defects: Vec::new() };
            sheets.extend(std::iter::repeat_n(sheet, count));
        }
    }
    let most = nest.defects.0.iter().filter_map(|d| d.0).max().map_or(0, |last| last + 1);
    if most > MOST_SHEETS {
        return Err(SheetError::BadPolygon {
            name: "defects",
            why: "they name a sheet above 10000".to_owned(),
        });
    }
    while sheets.len() < most + 1
        || nest.stock.0.iter().map(|s| s.1).sum::<usize>() + 1 > sheets.len()
    {
        sheets.push(usual.clone());
    }
    let last = sheets.len() - 1;
    for (which, corners) in &nest.defects.0 {
        for (i, sheet) in sheets.iter_mut().enumerate() {
            // The last one stands for all further ones, which have only the defects of all
            // sheets.
            if which.is_none_or(|w| w == i && i < last) {
                let defect = sound("defects", corners, DVec2::INFINITY)?;
                sheet.defects.push(defect);
            }
        }
    }
    check_common_line(nest, stock)?;
    let is_odd = sheets.iter().any(|s| !s.outline.is_empty() || !s.defects.is_empty());
    if nest.guillotine == Guillotine::On && (is_odd || !nest.together.0.is_empty()) {
        return Err(SheetError::GuillotineOption);
    }
    Ok(Some(sheets))
}

fn check_common_line(nest: &NestParams, stock: &StockParams) -> Result<(), SheetError> {
    if nest.common_line == CommonLine::Off {
        return Ok(());
    }
    if stock.kerf.mm() > 0.0 {
        return Err(SheetError::CommonLineKerf { kerf: stock.kerf.mm() });
    }
    let with =
        [("guillotine", nest.guillotine == Guillotine::On), ("hold", stock.holding_tabs > 0)];
    match with.into_iter().find(|w| w.1) {
        Some((option, _)) => Err(SheetError::CommonLineOption { option }),
        None => Ok(()),
    }
}

const MOST_SHEETS: usize = 10_000;

/// A polygon, turned counter-clockwise, that bounds an area, does not cross itself and lies within
/// a sheet.
fn sound(name: &'static str, corners: &[DVec2], size: DVec2) -> Result<Vec<DVec2>, SheetError> {
    let bad = |why: String| Err(SheetError::BadPolygon { name, why });
    if corners.is_empty() {
        return Ok(Vec::new());
    }
    let n = corners.len();
    let side = |i: usize| (corners[i], corners[(i + 1) % n]);
    for i in 0..n {
        for j in 0..i {
            let ((a, b), (c, d)) = (side(i), side(j));
            if segments_cross(a, b, c, d) {
                return bad(format!("sides {} and {} cross", j + 1, i + 1));
            }
        }
    }
    if let Some(p) =
        corners.iter().find(|p| size.is_finite() && (p.cmplt(DVec2::ZERO) | p.cmpgt(size)).any())
    {
        return bad(format!(
            "corner {},{} lies off the sheet of {} × {} mm",
            p.x, p.y, size.x, size.y
        ));
    }
    let area = signed_area(corners);
    if area == 0.0 {
        return bad("it bounds no area".to_owned());
    }
    let mut corners = corners.to_vec();
    if area < 0.0 {
        corners.reverse();
    }
    Ok(corners)
}

impl StockSheet {
    /// The sheet as the search sees it.
    pub(super) fn bin(&self) -> Bin {
        let margin = DVec2::splat(self.stock.margin);
        let (mut low, mut high) = (margin, self.stock.size - margin);
        let mut obstacles = Vec::new();
        if let Some((least, most)) = bounds(&self.outline) {
            (low, high) = (low.max(least + margin), high.min(most - margin));
            // Everything around the outline, as wide as the margin reaches.
            let by = margin + self.stock.size * 0.01;
            let (l, h) = (least - by, most + by);
            let frame = [l, DVec2::new(h.x, l.y), h, DVec2::new(l.x, h.y)];
            let inside: Vec<DVec2> = self.outline.iter().rev().copied().collect();
            let parts = convex_parts(&frame, &[inside]).expect("sound outlines do not cross");
            obstacles.extend(
                parts
                    .into_iter()
                    .map(|p| Obstacle { shape: Shape::new(&p, &[]), clearance: self.stock.margin }),
            );
        }
        for defect in &self.defects {
            obstacles
                .push(Obstacle { shape: Shape::new(defect, &[]), clearance: self.stock.spacing });
        }
        Bin { low, high, obstacles }
    }
}
