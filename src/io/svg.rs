//! Sheets as SVG, written through the `svg` crate.
//!
//! One user unit is one millimetre; (x, y) of a drawing becomes (x, height − y). One layer per operation in working order,
//! one path per mark, no transforms, no text elements, at most four decimals. Colours and widths come from the preset; what
//! a line means is also in its `class`.

use glam::DVec2;
use svg::node::Text;
use svg::node::element::{Element, Group, Path, SVG};

use crate::sheet::{Drawing, Layer, LayerKind, Mark, Preset, Stroke};

/// How one layer is drawn.
struct Pen {
    colour: &'static str,
    width: &'static str,
}

/// The text of one SVG file for a sheet; `command` is the command line that made it.
pub fn write_svg(drawing: &Drawing, preset: Preset, command: &str) -> String {
    let (width, height) = (decimal(drawing.width), decimal(drawing.height));
    let metadata = Element::new("metadata");
    let mut root = SVG::new()
        .set("xmlns:inkscape", "http://www.inkscape.org/namespaces/inkscape")
        .set("width", format!("{width}mm"))
        .set("height", format!("{height}mm"))
        .set("viewBox", format!("0 0 {width} {height}"));
    root = root.add(with_text(metadata, command));
    for layer in &drawing.layers {
        root = root.add(group(layer, drawing.height, preset));
    }
    format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{root}\n")
}

fn with_text(mut element: Element, text: &str) -> Element {
    // XML has no way to write most control characters, not even escaped.
    let shown = text.replace(|c: char| is_not_xml(c), "\u{fffd}");
    svg::Node::append(&mut element, Text::new(shown));
    element
}

fn is_not_xml(c: char) -> bool {
    (c < ' ' && !matches!(c, '\t' | '\n')) || matches!(c, '\u{fffe}' | '\u{ffff}')
}

fn group(layer: &Layer, height: f64, preset: Preset) -> Group {
    let pen = pen(preset, layer.kind);
    let name = layer.kind.name();
    let group = Group::new()
        .set("id", name)
        .set("inkscape:groupmode", "layer")
        .set("inkscape:label", name)
        .set("fill", "none")
        .set("stroke", pen.colour)
        .set("stroke-width", pen.width);
    layer.marks.iter().fold(group, |group, mark| group.add(path(mark, height)))
}

fn path(mark: &Mark, height: f64) -> Path {
    let data: Vec<String> = mark.strokes.iter().map(|s| path_data(s, height)).collect();
    Path::new().set("id", mark.id.as_str()).set("class", mark.kind.name()).set("d", data.join(" "))
}

/// `M x,y L x,y … Z`, without points that four decimals cannot tell apart.
fn path_data(stroke: &Stroke, height: f64) -> String {
    let shown = |p: &DVec2| format!("{},{}", decimal(p.x), decimal(height - p.y));
    let mut points: Vec<String> = stroke.points.iter().map(shown).collect();
    points.dedup();
    while stroke.closed && points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    let end = if stroke.closed { " Z" } else { "" };
    format!("M {}{end}", points.join(" L "))
}

/// At most four decimals, no trailing zeros, never −0.
fn decimal(value: f64) -> String {
    let text = format!("{value:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

/// Red, blue and black as most machines sort them.
const RED: &str = "#FF0000";
const BLUE: &str = "#0000FF";
const BLACK: &str = "#000000";
const GREEN: &str = "#00FF00";
const GREY: &str = "#808080";

/// The pen of a layer. Strokes are hairlines, never above 0.1 mm: wider ones are taken for areas to engrave.
fn pen(preset: Preset, layer: LayerKind) -> Pen {
    // In the order of `LayerKind::ALL`: engrave, score, inner cuts, outer cuts, info.
    let (colours, width) = match preset {
        Preset::RedCut | Preset::Glowforge | Preset::Epilog => ([BLACK, BLUE, RED, RED, GREY], "0.0254"),
        Preset::Boxes => ([GREEN, GREEN, BLUE, BLACK, GREY], "0.1"),
        // C03, C02, C01, C00 and T1 of its palette; T1 is a tool layer, which is never run.
        Preset::Lightburn => (["#00E000", RED, BLUE, BLACK, "#F36926"], "0.0254"),
        // Black means a filled area there; single strokes are line engraving, and so red.
        Preset::Ponoko => ([RED, RED, BLUE, BLUE, GREY], "0.01"),
    };
    let colour = match layer {
        LayerKind::Engrave => colours[0],
        LayerKind::Score => colours[1],
        LayerKind::CutInner => colours[2],
        LayerKind::CutOuter => colours[3],
        LayerKind::Info => colours[4],
    };
    Pen { colour, width }
}
