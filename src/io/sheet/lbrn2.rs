//! Sheets as LightBurn projects.
//!
//! XML, millimetres, y up. Cut settings carry the operations in working order (`priority`); index 0
//! is the outer cut and so on down its palette, index 30 is a tool layer, which is never run. One
//! group per mark of several strokes, one path per stroke; the vertices of a path stand in
//! `VertList`, its lines in `PrimList`. Power is the machine's own business and is not written;
//! speed is, when the material names it.

use std::fmt::Write as _;

use crate::io::number::{shown_points, xml};
use crate::sheet::{Drawing, LayerKind, Mark, Stroke};

/// A layer's index in the palette, its name, and its place in the working order.
fn setting(layer: LayerKind) -> (usize, &'static str, usize) {
    match layer {
        LayerKind::CutOuter => (0, "C00", 3),
        LayerKind::CutInner => (1, "C01", 2),
        LayerKind::Score => (2, "C02", 1),
        LayerKind::Engrave => (3, "C03", 0),
        LayerKind::Info => (30, "T1", 4),
    }
}

/// The text of one project for a sheet; `command` is the command line that made it, `speed` the
/// speed of an operation in mm/s where it is known.
///
/// # Example
/// ```
/// use kerfold::io::sheet::lbrn2::write_lbrn2;
/// use kerfold::sheet::LayerKind;
///
/// let coupon = kerfold::sheet::kerf_coupon(3.0, "PLY 3 MM")?;
/// let speed = |layer| (layer == LayerKind::CutOuter).then_some(12.0);
/// assert!(write_lbrn2(&coupon, speed, "my program").contains("<LightBurnProject"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_lbrn2(
    drawing: &Drawing,
    speed: impl Fn(LayerKind) -> Option<f64>,
    command: &str,
) -> String {
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    text += "<LightBurnProject AppVersion=\"1.4.00\" FormatVersion=\"1\" MaterialHeight=\"0\" \
    MirrorX=\"False\" MirrorY=\"False\">\n";
    for layer in LayerKind::ALL {
        let (index, name, priority) = setting(layer);
        let kind = if layer == LayerKind::Info { "Tool" } else { "Cut" };
        text += &format!(
            "  <CutSetting type=\"{kind}\">\n    <index Value=\"{index}\"/>\n    <name \
            Value=\"{name} {}\"/>\n",
            layer.name()
        );
        if let Some(speed) = speed(layer) {
            text += &format!("    <speed Value=\"{speed}\"/>\n");
        }
        text += &format!("    <priority Value=\"{priority}\"/>\n  </CutSetting>\n");
    }
    for layer in &drawing.layers {
        let (index, ..) = setting(layer.kind);
        // LightBurn's palette is its own: what the colours of the other formats mean is no help.
        let own = layer.marks.iter().filter(|mark| !mark.id.starts_with("legend-colours"));
        own.for_each(|mark| shape(&mut text, mark, index));
    }
    text +=
        &format!("  <Notes ShowOnLoad=\"0\" Notes=\"{}\"/>\n</LightBurnProject>\n", xml(command));
    text
}

fn shape(text: &mut String, mark: &Mark, index: usize) {
    match mark.strokes.as_slice() {
        [stroke] => *text += &path(stroke, index, "  "),
        strokes => {
            *text += "  <Shape Type=\"Group\">\n    <XForm>1 0 0 1 0 0</XForm>\n    <Children>\n";
            strokes.iter().for_each(|stroke| *text += &path(stroke, index, "      "));
            *text += "    </Children>\n  </Shape>\n";
        }
    }
}

fn path(stroke: &Stroke, index: usize, indent: &str) -> String {
    let points = shown_points(stroke, None);
    // No handles: `c0x1` and `c1x1` stand where a curve would have them.
    let vertices: String = points.iter().map(|[x, y]| format!("V{x} {y}c0x1c1x1")).collect();
    let n = points.len();
    let mut lines = String::new();
    for i in 1..n {
        let _ = write!(lines, "L{} {i}", i - 1);
    }
    if stroke.closed && n > 1 {
        let _ = write!(lines, "L{} 0", n - 1);
    }
    format!(
        "{indent}<Shape Type=\"Path\" CutIndex=\"{index}\">\n{indent}  <XForm>1 0 0 1 0 0</XForm>\n\
         {indent}  <VertList>{vertices}</VertList>\n{indent}  <PrimList>{lines}</PrimList>\n{indent}</Shape>\n"
    )
}
