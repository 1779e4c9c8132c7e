//! Sheets as DXF R2000 (AC1015), the youngest version that every shop's program reads.
//!
//! Millimetres (`$INSUNITS` 4, `$MEASUREMENT` 1), origin bottom left, y up. Every stroke is an
//! LWPOLYLINE, closed for cuts; layers are `ENGRAVE`, `SCORE` (dashed), `CUT_INNER`, `CUT_OUTER`
//! and `INFO` (never plotted), entities come in working order. The file is written in full: tables,
//! blocks and the layout dictionary, so that no reader has to mend it.

mod frame;

use crate::io::number::shown_points;
use crate::sheet::{Drawing, LayerKind, Mark, Stroke};
use frame::{Handles, Pairs};

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

/// The text of one DXF file for a sheet; `command` is the command line that made it.
///
/// # Example
/// ```
/// use kerfold::io::sheet::dxf::write_dxf;
///
/// let coupon = kerfold::sheet::kerf_coupon(3.0, "PLY 3 MM")?;
/// assert!(write_dxf(&coupon, "my program").trim_end().ends_with("EOF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_dxf(drawing: &Drawing, command: &str) -> String {
    let mut handles = Handles::new();
    let mut entities = Pairs::default();
    for layer in &drawing.layers {
        for mark in &layer.marks {
            mark_entities(&mut entities, &mut handles, layer.kind, mark);
        }
    }
    frame::file([drawing.width, drawing.height], command, &entities, &handles)
}

fn mark_entities(entities: &mut Pairs, handles: &mut Handles, layer: LayerKind, mark: &Mark) {
    // A fold that is drawn as dashes already must not be dashed once more.
    let is_dashed = layer == LayerKind::Score && mark.strokes.len() > 1;
    for stroke in &mark.strokes {
        polyline(entities, handles, layer_name(layer), is_dashed, stroke);
    }
}

fn polyline(out: &mut Pairs, handles: &mut Handles, layer: &str, is_dashed: bool, stroke: &Stroke) {
    let points = shown_points(stroke, None);
    if points.len() < 2 {
        return;
    }
    out.text(0, "LWPOLYLINE");
    out.handle(5, handles.next());
    out.handle(330, frame::MODEL_SPACE);
    out.text(100, "AcDbEntity");
    out.text(8, layer);
    if is_dashed {
        out.text(6, "Continuous");
    }
    out.text(100, "AcDbPolyline");
    out.number(90, points.len());
    out.number(70, usize::from(stroke.closed));
    out.text(43, "0.0");
    for [x, y] in &points {
        out.text(10, x);
        out.text(20, y);
    }
}
