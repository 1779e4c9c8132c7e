//! The little languages inside SVG attributes, read by `svgtypes`: path data, points, transforms,
//! lengths, colours.

use glam::{DAffine2, DMat2, DVec2};
use svgtypes::{
    Length, LengthUnit, Paint, PaintFallback, PathParser, PathSegment, PointsParser,
    TransformListParser, TransformListToken,
};

use super::ArtError;
use super::curve::Flattener;

/// Subpaths with whether each is closed.
pub(super) type Subpaths = Vec<(Vec<DVec2>, bool)>;

/// Path data up to its first mistake, as browsers read them, and whether there is one.
pub(super) fn subpaths(
    data: &str,
    flattener: &Flattener<'_>,
) -> Result<(Subpaths, bool), ArtError> {
    let mut pen = Pen::default();
    for segment in PathParser::from(data) {
        let Ok(segment) = segment else { return Ok((pen.finish(), true)) };
        pen.draw(segment, flattener)?;
    }
    Ok((pen.finish(), false))
}

/// The control point that a smooth command mirrors.
#[derive(Clone, Copy, Default, PartialEq)]
enum Control {
    #[default]
    None,
    Cubic(DVec2),
    Quadratic(DVec2),
}

/// Follows path data.
#[derive(Default)]
struct Pen {
    done: Subpaths,
    points: Vec<DVec2>,
    at: DVec2,
    control: Control,
}

impl Pen {
    fn finish(mut self) -> Subpaths {
        self.lift();
        self.done
    }

    fn lift(&mut self) {
        if !self.points.is_empty() {
            self.done.push((std::mem::take(&mut self.points), false));
        }
    }

    fn draw(&mut self, segment: PathSegment, flattener: &Flattener<'_>) -> Result<(), ArtError> {
        let base = if segment.is_abs() { DVec2::ZERO } else { self.at };
        match segment {
            PathSegment::MoveTo { x, y, .. } => {
                self.lift();
                self.at = base + DVec2::new(x, y);
                self.points.push(self.at);
                self.control = Control::None;
                return Ok(());
            }
            PathSegment::ClosePath { .. } => {
                if let Some(&first) = self.points.first() {
                    self.at = first;
                    self.done.push((std::mem::take(&mut self.points), true));
                }
                self.control = Control::None;
                return Ok(());
            }
            _ => {}
        }
        // What is drawn on without a move begins where the last part was closed.
        if self.points.is_empty() {
            self.points.push(self.at);
        }
        self.draw_on(segment, base, flattener)
    }

    /// Lines and curves.
    fn draw_on(
        &mut self,
        segment: PathSegment,
        base: DVec2,
        flattener: &Flattener<'_>,
    ) -> Result<(), ArtError> {
        let at = self.at;
        let point = |x: f64, y: f64| base + DVec2::new(x, y);
        let (end, control) = match segment {
            PathSegment::HorizontalLineTo { x, .. } => {
                (DVec2::new(base.x + x, at.y), Control::None)
            }
            PathSegment::VerticalLineTo { y, .. } => (DVec2::new(at.x, base.y + y), Control::None),
            PathSegment::CurveTo { x1, y1, x2, y2, x, y, .. } => {
                let [first, second, end] = [point(x1, y1), point(x2, y2), point(x, y)];
                flattener.cubic([at, first, second, end], &mut self.points)?;
                (end, Control::Cubic(second))
            }
            PathSegment::SmoothCurveTo { x2, y2, x, y, .. } => {
                let first = match self.control {
                    Control::Cubic(before) => 2.0 * at - before,
                    _ => at,
                };
                let [second, end] = [point(x2, y2), point(x, y)];
                flattener.cubic([at, first, second, end], &mut self.points)?;
                (end, Control::Cubic(second))
            }
            PathSegment::Quadratic { x1, y1, x, y, .. } => {
                let [middle, end] = [point(x1, y1), point(x, y)];
                flattener.quadratic([at, middle, end], &mut self.points)?;
                (end, Control::Quadratic(middle))
            }
            PathSegment::SmoothQuadratic { x, y, .. } => {
                let middle = match self.control {
                    Control::Quadratic(before) => 2.0 * at - before,
                    _ => at,
                };
                let end = point(x, y);
                flattener.quadratic([at, middle, end], &mut self.points)?;
                (end, Control::Quadratic(middle))
            }
            PathSegment::EllipticalArc {
                rx, ry, x_axis_rotation, large_arc, sweep, x, y, ..
            } => {
                let (end, radii) = (point(x, y), DVec2::new(rx, ry));
                let flags = [large_arc, sweep];
                flattener.svg_arc([at, end], radii, x_axis_rotation, flags, &mut self.points)?;
                (end, Control::None)
            }
            PathSegment::LineTo { x, y, .. } | PathSegment::MoveTo { x, y, .. } => {
                (point(x, y), Control::None)
            }
            PathSegment::ClosePath { .. } => (at, Control::None),
        };
        if self.points.last() != Some(&end) || at == end {
            self.points.push(end);
        }
        (self.at, self.control) = (end, control);
        Ok(())
    }
}

/// All points of `points="..."`.
pub(super) fn point_list(text: &str) -> Vec<DVec2> {
    PointsParser::from(text).map(|(x, y)| DVec2::new(x, y)).collect()
}

/// How many user units an inch has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PerInch(pub f64);

/// A length with its unit in user units, or in percent of `whole`; whether its unit is one of the
/// real world.
pub(super) fn length(text: &str, whole: f64, per_inch: PerInch) -> Option<(f64, bool)> {
    let text = text.trim();
    let PerInch(inch) = per_inch;
    // A quarter of a millimetre, which svgtypes does not know.
    if let Some(quarters) = text.strip_suffix(['q', 'Q']) {
        return Some((quarters.parse::<f64>().ok()? * inch / 101.6, true));
    }
    let lower = text.to_ascii_lowercase();
    let Length { number, unit } = lower.parse().ok()?;
    let (factor, is_real) = match unit {
        LengthUnit::None | LengthUnit::Px => (1.0, false),
        LengthUnit::Em => (16.0, false),
        LengthUnit::Ex => (8.0, false),
        LengthUnit::Percent => (whole / 100.0, false),
        LengthUnit::In => (inch, true),
        LengthUnit::Cm => (inch / 2.54, true),
        LengthUnit::Mm => (inch / 25.4, true),
        LengthUnit::Pt => (inch / 72.0, true),
        LengthUnit::Pc => (inch / 6.0, true),
    };
    Some((number * factor, is_real))
}

/// A list of transforms, the first outermost, up to its first mistake.
pub(super) fn transform(text: &str) -> DAffine2 {
    let shear = |x: f64, y: f64| DAffine2::from_mat2(DMat2::from_cols_array(&[1.0, y, x, 1.0]));
    let tokens = TransformListParser::from(text).map_while(Result::ok);
    tokens.fold(DAffine2::IDENTITY, |all, token| {
        all * match token {
            TransformListToken::Matrix { a, b, c, d, e, f } => {
                DAffine2::from_cols_array(&[a, b, c, d, e, f])
            }
            TransformListToken::Translate { tx, ty } => {
                DAffine2::from_translation(DVec2::new(tx, ty))
            }
            TransformListToken::Scale { sx, sy } => DAffine2::from_scale(DVec2::new(sx, sy)),
            TransformListToken::Rotate { angle } => DAffine2::from_angle(angle.to_radians()),
            TransformListToken::SkewX { angle } => shear(angle.to_radians().tan(), 0.0),
            TransformListToken::SkewY { angle } => shear(0.0, angle.to_radians().tan()),
        }
    })
}

/// A colour that stands for gradients and words that name none: some colour, and none of those
/// that mean something.
const SOME: [u8; 3] = [128, 64, 64];

/// What paints a line; `None` for what paints nothing. `current` is what `currentColor` means.
pub(super) fn colour(text: &str, current: Option<[u8; 3]>) -> Option<[u8; 3]> {
    let rgb = |c: svgtypes::Color| (c.alpha > 0).then_some([c.red, c.green, c.blue]);
    match Paint::from_str(text) {
        Ok(Paint::None) => None,
        Ok(Paint::Color(colour)) => rgb(colour),
        Ok(Paint::CurrentColor) => current,
        Ok(Paint::FuncIRI(_, Some(PaintFallback::Color(colour)))) => rgb(colour),
        Ok(_) => Some(SOME),
        Err(_) if text.trim().is_empty() => None,
        Err(_) => Some(SOME),
    }
}

/// Whether a number in a text is beyond all numbers, as `1e999`.
pub(super) fn has_infinite(text: &str) -> bool {
    let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | 'e' | 'E' | '+' | '-');
    text.split(|c| !is_of_number(c))
        .filter(|word| word.len() > 4)
        .any(|word| word.parse::<f64>().is_ok_and(f64::is_infinite))
}
