//! Sheets as DXF R2000 (AC1015), the youngest version that every shop's program reads.
//!
//! Millimetres (`$INSUNITS` 4, `$MEASUREMENT` 1), origin bottom left, y up. Every stroke is an
//! LWPOLYLINE, closed for cuts, but round holes are circles; layers are `ENGRAVE`, `SCORE` (dashed),
//! `CUT_INNER`, `CUT_OUTER` and `INFO` (never plotted), and where plates are bevelled `INFO_FRONT`
//! and `INFO_BACK` with the outlines of their two sides. Entities come in working order. The file is
//! written in full: tables, blocks and the layout dictionary, so that no reader has to mend it.

mod frame;

use glam::DVec2;

use crate::geom::polygon::centroid;
use crate::io::number::{decimal, shown_points};
use crate::sheet::{Drawing, LayerKind, Mark, MarkKind, PlateSide, Style};
pub(in crate::io) use frame::plain;
use frame::{Handles, Pairs, index_of, weight};

/// A regular polygon with this many sides at least stands for a circle.
const ROUND: usize = 12;

/// A layer of a file.
#[derive(Debug, Clone, Copy)]
pub(in crate::io) struct DxfLayer<'a> {
    pub name: &'a str,
    /// Of the index of colours.
    pub colour: u8,
    /// Hundredths of a millimetre.
    pub weight: u8,
    pub is_dashed: bool,
    pub is_plotted: bool,
}

/// What is drawn, in order.
#[derive(Default)]
pub(in crate::io) struct Entities {
    pairs: Pairs,
    handles: Handles,
}

impl Entities {
    /// A polyline of points as text.
    pub fn polyline(&mut self, layer: &str, points: &[[String; 2]], is_closed: bool) {
        self.line(layer, false, points, is_closed);
    }

    fn line(&mut self, layer: &str, is_dashed: bool, points: &[[String; 2]], is_closed: bool) {
        if points.len() < 2 {
            return;
        }
        self.begin("LWPOLYLINE", layer);
        if is_dashed {
            self.pairs.text(6, "Continuous");
        }
        let out = &mut self.pairs;
        out.text(100, "AcDbPolyline");
        out.number(90, points.len());
        out.number(70, usize::from(is_closed));
        out.text(43, "0.0");
        for [x, y] in points {
            out.text(10, x);
            out.text(20, y);
        }
    }

    /// A circle.
    pub fn circle(&mut self, layer: &str, [x, y]: [String; 2], radius: &str) {
        self.begin("CIRCLE", layer);
        let out = &mut self.pairs;
        out.text(100, "AcDbCircle");
        out.text(10, &x);
        out.text(20, &y);
        out.text(30, "0");
        out.text(40, radius);
    }

    /// A plane of three or four corners, the last one twice where there are three. The sides whose
    /// bit is set are hidden; the lowest bit is that of the first side.
    pub fn face(&mut self, layer: &str, corners: [[String; 3]; 4], hidden: u8) {
        self.begin("3DFACE", layer);
        let out = &mut self.pairs;
        out.text(100, "AcDbFace");
        for (code, [x, y, z]) in (10..).zip(&corners) {
            out.text(code, x);
            out.text(code + 10, y);
            out.text(code + 20, z);
        }
        out.number(70, hidden);
    }

    fn begin(&mut self, kind: &str, layer: &str) {
        let out = &mut self.pairs;
        out.text(0, kind);
        out.handle(5, self.handles.next());
        out.handle(330, frame::MODEL_SPACE);
        out.text(100, "AcDbEntity");
        out.text(8, layer);
    }
}

/// The text of a file with some layers and entities.
pub(in crate::io) fn dxf_file(
    size: [f64; 2],
    layers: &[DxfLayer<'_>],
    command: &str,
    entities: &Entities,
) -> String {
    frame::file(size, layers, command, (&entities.pairs, &entities.handles))
}

/// The name of a layer in DXF files.
pub fn layer_name(layer: LayerKind) -> &'static str {
    match layer {
        LayerKind::Engrave => "ENGRAVE",
        LayerKind::Score => "SCORE",
        LayerKind::CutInner => "CUT_INNER",
        LayerKind::CutOuter => "CUT_OUTER",
        LayerKind::Info => "INFO",
    }
}

/// The text of one DXF file for a sheet; `command` is the command line that made it. Layers have
/// the colour of the index that is nearest to that of the style, and its line weight.
///
/// # Example
/// ```
/// use kerfold::io::sheet::dxf::write_dxf;
/// use kerfold::sheet::Preset;
///
/// let coupon = kerfold::sheet::kerf_coupon(3.0, "PLY 3 MM")?;
/// let text = write_dxf(&coupon, Preset::RedCut, "my program");
/// assert!(text.trim_end().ends_with("EOF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_dxf(drawing: &Drawing, style: impl Into<Style>, command: &str) -> String {
    let style = style.into();
    let mut entities = Entities::default();
    for layer in &drawing.layers {
        layer.marks.iter().for_each(|mark| mark_entities(&mut entities, layer.kind, mark));
    }
    for (side, mark) in &drawing.sides {
        for stroke in &mark.strokes {
            entities.polyline(side_layer(*side), &shown_points(stroke, None), stroke.closed);
        }
    }
    let mut layers: Vec<DxfLayer<'_>> =
        LayerKind::ALL.into_iter().map(|kind| sheet_layer(kind, &style)).collect();
    if !drawing.sides.is_empty() {
        layers.extend([PlateSide::Front, PlateSide::Back].map(|side| DxfLayer {
            name: side_layer(side),
            colour: if side == PlateSide::Front { 3 } else { 4 },
            weight: weight(style.pen(LayerKind::Info).width),
            is_dashed: side == PlateSide::Back,
            is_plotted: false,
        }));
    }
    dxf_file([drawing.width, drawing.height], &layers, command, &entities)
}

fn sheet_layer(kind: LayerKind, style: &Style) -> DxfLayer<'static> {
    let pen = style.pen(kind);
    DxfLayer {
        name: layer_name(kind),
        colour: index_of(pen.colour),
        weight: weight(pen.width),
        is_dashed: kind == LayerKind::Score,
        is_plotted: kind != LayerKind::Info,
    }
}

const fn side_layer(side: PlateSide) -> &'static str {
    match side {
        PlateSide::Front => "INFO_FRONT",
        PlateSide::Back => "INFO_BACK",
    }
}

fn mark_entities(entities: &mut Entities, layer: LayerKind, mark: &Mark) {
    // A fold that is drawn as dashes already must not be dashed once more.
    let is_dashed = layer == LayerKind::Score && mark.strokes.len() > 1;
    let name = layer_name(layer);
    for stroke in &mark.strokes {
        let is_hole = mark.kind == MarkKind::Hole && stroke.closed;
        match circle_of(&stroke.points).filter(|_| is_hole) {
            Some((c, radius)) => entities.circle(name, [c.x, c.y].map(decimal), &decimal(radius)),
            None => entities.line(name, is_dashed, &shown_points(stroke, None), stroke.closed),
        }
    }
}

/// Centre and radius of the circle that a regular polygon of many sides stands for.
fn circle_of(points: &[DVec2]) -> Option<(DVec2, f64)> {
    let n = points.len();
    if n < ROUND {
        return None;
    }
    let centre = centroid(points);
    let radius = points.iter().map(|p| p.distance(centre)).sum::<f64>() / n as f64;
    let side = 2.0 * radius * (std::f64::consts::PI / n as f64).sin();
    // As near as the four decimals of the file tell.
    let near = |a: f64, b: f64| (a - b).abs() < 1e-6 * radius.max(1.0);
    let is_regular = (0..n).all(|i| {
        near(points[i].distance(centre), radius)
            && near(points[i].distance(points[(i + 1) % n]), side)
    });
    is_regular.then_some((centre, radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_regular_polygons_of_many_sides_are_circles() {
        let ring = |n: usize, squeeze: f64| -> Vec<DVec2> {
            let angle = |i: usize| i as f64 * std::f64::consts::TAU / n as f64;
            let at =
                |i| DVec2::new(7.0, 9.0) + DVec2::from_angle(angle(i)) * DVec2::new(2.5, squeeze);
            (0..n).map(at).collect()
        };
        let (centre, radius) = circle_of(&ring(24, 2.5)).expect("a circle");
        assert!(centre.distance(DVec2::new(7.0, 9.0)) < 1e-9 && (radius - 2.5).abs() < 1e-9);
        assert_eq!(circle_of(&ring(24, 2.4)), None);
        assert_eq!(circle_of(&ring(6, 2.5)), None);
    }
}
