//! The picture of one cutting sheet.

use glam::DVec2;
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, Rect, Stroke, Transform,
};

use super::{MAX_PIXELS, MIN_PIXELS, Picture, PictureError};

/// A sheet as strokes. All lengths in mm, origin at the bottom left, y up.
#[derive(Debug, Clone, PartialEq)]
pub struct Strokes {
    /// Width of the sheet.
    pub width_mm: f64,
    /// Height of the sheet.
    pub height_mm: f64,
    /// The layers, drawn in this order.
    pub layers: Vec<StrokeLayer>,
}

/// Lines of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct StrokeLayer {
    /// The name, for messages.
    pub name: String,
    /// Red, green and blue (sRGB).
    pub colour: [u8; 3],
    /// Width of the strokes; drawn at least as wide as the eye needs.
    pub width_mm: f64,
    /// The lines.
    pub polylines: Vec<Polyline>,
    /// Whether the closed lines bound parts. What they enclose by the even-odd rule, over all such
    /// layers together, is tinted: outer contours and their holes.
    pub bounds_parts: bool,
}

/// One line.
#[derive(Debug, Clone, PartialEq)]
pub struct Polyline {
    /// Its points.
    pub points: Vec<DVec2>,
    /// Whether the last point is joined to the first.
    pub is_closed: bool,
}

/// The margin around the sheet, as a part of the picture's width.
const MARGIN: f64 = 0.02;
const SHEET: [u8; 3] = [255, 255, 255];
const BORDER: [u8; 3] = [150, 146, 140];
const AROUND: [u8; 3] = [236, 234, 230];
const PART: [u8; 3] = [246, 238, 222];

/// Draws a sheet `width` pixels wide; the height follows from the sheet, within the limits of a
/// picture.
///
/// # Errors
/// [`PictureError::SizeOutOfRange`], [`PictureError::SheetWithoutSize`] and
/// [`PictureError::StrokeNotFinite`].
pub fn render_sheet(strokes: &Strokes, width: u32) -> Result<Picture, PictureError> {
    super::blank(width, MIN_PIXELS)?;
    check(strokes)?;
    let size = DVec2::new(strokes.width_mm, strokes.height_mm);
    let margin = (f64::from(width) * MARGIN).ceil();
    let wished = (f64::from(width) - 2.0 * margin) / size.x * size.y + 2.0 * margin;
    let height = wished.ceil().clamp(f64::from(MIN_PIXELS), f64::from(MAX_PIXELS)) as u32;
    let mut pixmap = super::blank(width, height)?;
    let room = DVec2::new(f64::from(width), f64::from(height)) - 2.0 * margin;
    let scale = (room / size).min_element();
    let low = (DVec2::new(f64::from(width), f64::from(height)) - size * scale) / 2.0;
    let place = Placement { scale, left: low.x, bottom: low.y + size.y * scale };
    draw(&mut pixmap, strokes, place);
    Ok(Picture { pixmap })
}

/// From mm to pixels.
#[derive(Clone, Copy)]
struct Placement {
    scale: f64,
    left: f64,
    bottom: f64,
}

impl Placement {
    fn pixel(self, p: DVec2) -> (f32, f32) {
        ((self.left + p.x * self.scale) as f32, (self.bottom - p.y * self.scale) as f32)
    }
}

fn check(strokes: &Strokes) -> Result<(), PictureError> {
    let (width_mm, height_mm) = (strokes.width_mm, strokes.height_mm);
    let has_size = |x: f64| x.is_normal() && x > 0.0;
    if !has_size(width_mm) || !has_size(height_mm) {
        return Err(PictureError::SheetWithoutSize { width_mm, height_mm });
    }
    for layer in &strokes.layers {
        for (line, polyline) in layer.polylines.iter().enumerate() {
            if let Some(point) = polyline.points.iter().position(|p| !p.is_finite()) {
                let (layer, p) = (layer.name.clone(), polyline.points[point]);
                return Err(PictureError::StrokeNotFinite { layer, line, point, x: p.x, y: p.y });
            }
        }
    }
    Ok(())
}

fn draw(pixmap: &mut Pixmap, strokes: &Strokes, place: Placement) {
    let [r, g, b] = AROUND;
    pixmap.fill(Color::from_rgba8(r, g, b, 255));
    let pixel = f64::from(pixmap.width().max(pixmap.height())) / 1200.0;
    let (left, bottom) = place.pixel(DVec2::ZERO);
    let (right, top) = place.pixel(DVec2::new(strokes.width_mm, strokes.height_mm));
    if let Some(rect) = Rect::from_ltrb(left, top, right, bottom) {
        let sheet = PathBuilder::from_rect(rect);
        fill(pixmap, &sheet, SHEET);
        stroke(pixmap, &sheet, BORDER, pixel.max(1.0) as f32);
    }
    let parts = strokes.layers.iter().filter(|layer| layer.bounds_parts);
    let contours = parts.flat_map(|layer| &layer.polylines).filter(|line| line.is_closed);
    if let Some(path) = path(contours, place) {
        fill(pixmap, &path, PART);
    }
    for layer in &strokes.layers {
        if let Some(path) = path(&layer.polylines, place) {
            let width = (layer.width_mm * place.scale).max(1.3 * pixel).max(0.8);
            stroke(pixmap, &path, layer.colour, width as f32);
        }
    }
}

fn path<'a>(lines: impl IntoIterator<Item = &'a Polyline>, place: Placement) -> Option<Path> {
    let mut path = PathBuilder::new();
    for line in lines {
        for (i, &p) in line.points.iter().enumerate() {
            let (x, y) = place.pixel(p);
            if i == 0 { path.move_to(x, y) } else { path.line_to(x, y) }
        }
        if line.is_closed && line.points.len() > 1 {
            path.close();
        }
    }
    path.finish()
}

fn plain(colour: [u8; 3]) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color_rgba8(colour[0], colour[1], colour[2], 255);
    paint
}

fn fill(pixmap: &mut Pixmap, path: &Path, colour: [u8; 3]) {
    pixmap.fill_path(path, &plain(colour), FillRule::EvenOdd, Transform::identity(), None);
}

fn stroke(pixmap: &mut Pixmap, path: &Path, colour: [u8; 3], width: f32) {
    let stroke =
        Stroke { width, line_cap: LineCap::Round, line_join: LineJoin::Round, ..Stroke::default() };
    pixmap.stroke_path(path, &plain(colour), &stroke, Transform::identity(), None);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rectangle(low: [f64; 2], high: [f64; 2]) -> Polyline {
        let ([x, y], [u, v]) = (low, high);
        let points = [(x, y), (u, y), (u, v), (x, v)].map(|(x, y)| DVec2::new(x, y)).to_vec();
        Polyline { points, is_closed: true }
    }

    fn layer(name: &str, colour: [u8; 3], polylines: Vec<Polyline>) -> StrokeLayer {
        StrokeLayer {
            name: name.to_owned(),
            colour,
            width_mm: 0.1,
            polylines,
            bounds_parts: name.starts_with("cut"),
        }
    }

    /// A part of 60 × 60 mm with a hole of 20 × 20 mm at the lower left of a sheet of 200 × 100 mm.
    fn sheet() -> Strokes {
        let fold = Polyline {
            points: vec![DVec2::new(10.0, 60.0), DVec2::new(70.0, 60.0)],
            is_closed: false,
        };
        let inner = layer("cut-inner", [255, 0, 0], vec![rectangle([30.0, 30.0], [50.0, 50.0])]);
        let outer = layer("cut-outer", [255, 0, 0], vec![rectangle([10.0, 10.0], [70.0, 70.0])]);
        let layers = vec![layer("score", [0, 0, 255], vec![fold]), inner, outer];
        Strokes { width_mm: 200.0, height_mm: 100.0, layers }
    }

    #[test]
    fn parts_are_where_they_are_cut() {
        let picture = render_sheet(&sheet(), 1000).expect("a picture");
        // A margin of 20 pixels on each side: 4.8 pixels per mm.
        assert_eq!((picture.width(), picture.height()), (1000, 520));
        let at = |x: f64, y: f64| {
            picture.pixel((20.0 + 4.8 * x) as u32, (500.0 - 4.8 * y) as u32).expect("within")
        };
        assert_eq!((at(20.0, 20.0), at(40.0, 40.0), at(100.0, 90.0)), (PART, SHEET, SHEET));
        assert_eq!(picture.pixel(0, 0), Some(AROUND));
        let column =
            |x: f64| (20..500).filter_map(move |y| picture.pixel((20.0 + 4.8 * x) as u32, y));
        let red = column.clone()(20.0).filter(|[r, g, _]| *r > 200 && *g < 160).count();
        assert!((2..=6).contains(&red), "two cuts: {red}");
        assert!(column(20.0).any(|[r, _, b]| b > 200 && r < 160), "a fold");
    }

    #[test]
    fn sheets_that_cannot_be_drawn_are_told() {
        assert!(matches!(
            render_sheet(&sheet(), 9000),
            Err(PictureError::SizeOutOfRange { pixels: 9000, .. })
        ));
        for width_mm in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let fault = render_sheet(&Strokes { width_mm, ..sheet() }, 100).expect_err("no size");
            assert!(matches!(fault, PictureError::SheetWithoutSize { .. }));
        }
        let mut broken = sheet();
        broken.layers[1].polylines[0].points[2].x = f64::NAN;
        let fault = render_sheet(&broken, 100).expect_err("not finite");
        assert!(
            matches!(fault, PictureError::StrokeNotFinite { layer, line: 0, point: 2, .. } if layer == "cut-inner")
        );
    }

    #[test]
    fn strange_sheets_still_give_a_picture() {
        for (width_mm, height_mm) in [(1.0, 1e6), (1e6, 1.0), (1e-200, 1e200)] {
            let strokes = Strokes { width_mm, height_mm, layers: sheet().layers };
            assert!(render_sheet(&strokes, 64).is_ok(), "{width_mm} {height_mm}");
        }
        let empty = Polyline { points: Vec::new(), is_closed: true };
        let point = Polyline { points: vec![DVec2::ONE], is_closed: true };
        let layers = vec![layer("cut", [0, 0, 0], vec![empty, point])];
        assert!(render_sheet(&Strokes { layers, ..sheet() }, 16).is_ok());
    }
}
