//! Sheets as SVG, written through the `svg` crate.
//!
//! One user unit is one millimetre; (x, y) of a drawing becomes (x, height − y). One layer per
//! operation in working order, one path per mark, no transforms, no text elements, at most four
//! decimals. Colours and widths come from the preset; what a line means is also in its `class`.

use svg::node::Text;
use svg::node::element::{Element, Group, Path, SVG};

use crate::io::number::{decimal, hex, is_not_xml, push_shown_points};
use crate::sheet::{Drawing, Layer, Mark, Stroke, Style};

/// The text of one SVG file for a sheet; `command` is the command line that made it.
///
/// # Example
/// ```
/// use kerfold::io::sheet::svg::write_svg;
/// use kerfold::sheet::Preset;
///
/// let coupon = kerfold::sheet::kerf_coupon(3.0, "PLY 3 MM")?;
/// assert!(write_svg(&coupon, Preset::Lightburn, "my program").contains("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_svg(drawing: &Drawing, style: impl Into<Style>, command: &str) -> String {
    let style = style.into();
    let (width, height) = (decimal(drawing.width), decimal(drawing.height));
    let metadata = Element::new("metadata");
    let mut root = SVG::new()
        .set("xmlns:inkscape", "http://www.inkscape.org/namespaces/inkscape")
        .set("width", format!("{width}mm"))
        .set("height", format!("{height}mm"))
        .set("viewBox", format!("0 0 {width} {height}"));
    root = root.add(with_text(metadata, command));
    for layer in &drawing.layers {
        root = root.add(group(layer, drawing.height, &style));
    }
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{root}\n")
}

fn with_text(mut element: Element, text: &str) -> Element {
    // XML has no way to write most control characters, not even escaped.
    let shown = text.replace(|c: char| is_not_xml(c), "\u{fffd}");
    svg::Node::append(&mut element, Text::new(shown));
    element
}

fn group(layer: &Layer, height: f64, style: &Style) -> Group {
    let pen = style.pen(layer.kind);
    let name = layer.kind.name();
    let group = Group::new()
        .set("id", name)
        .set("inkscape:groupmode", "layer")
        .set("inkscape:label", name)
        .set("fill", "none")
        .set("stroke", hex(pen.colour))
        .set("stroke-width", decimal(pen.width));
    layer.marks.iter().fold(group, |group, mark| group.add(path(mark, height)))
}

fn path(mark: &Mark, height: f64) -> Path {
    let mut data = String::new();
    for (i, stroke) in mark.strokes.iter().enumerate() {
        data += if i == 0 { "" } else { " " };
        push_path(&mut data, stroke, height);
    }
    Path::new().set("id", mark.id.as_str()).set("class", mark.kind.name()).set("d", data)
}

/// Adds `M x,y L x,y … Z`, without points that four decimals cannot tell apart.
fn push_path(data: &mut String, stroke: &Stroke, height: f64) {
    *data += "M ";
    push_shown_points(data, stroke, height);
    *data += if stroke.closed { " Z" } else { "" };
}
