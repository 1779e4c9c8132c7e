//! Sheets as PDF 1.5, written out by hand: a page has a handful of objects, and coordinates must
//! keep four decimals.
//!
//! One page as large as the sheet, user space in millimetres by one matrix, strokes as wide as in the
//! SVG. Every operation is a layer (an optional content group) of its name; `info` is switched off
//! for printing, unless there are registration marks on it. See [`tiles`] for paper.

pub mod tiles;

use std::fmt::Write as _;

use crate::io::number::{decimal, shown_points};
use crate::sheet::{Drawing, LayerKind, Pen, Stroke, Style};

/// Points in a millimetre.
const POINTS: f64 = 72.0 / 25.4;

/// One page: its size in mm and what is drawn on it.
struct Page {
    width: f64,
    height: f64,
    content: String,
}

/// The bytes of a PDF with the sheet at true size on one page; `command` is the command line that
/// made it.
///
/// # Example
/// ```
/// use kerfold::io::sheet::pdf::write_pdf;
/// use kerfold::sheet::Preset;
///
/// let coupon = kerfold::sheet::kerf_coupon(3.0, "PLY 3 MM")?;
/// assert!(write_pdf(&coupon, Preset::RedCut, "my program").starts_with(b"%PDF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_pdf(drawing: &Drawing, style: impl Into<Style>, command: &str) -> Vec<u8> {
    let style = style.into();
    let mut content = String::new();
    draw_layers(&mut content, drawing, &style);
    let page = Page { width: drawing.width, height: drawing.height, content };
    document(&[page], (&drawing.file_stem(), command), None, style.prints_info())
}

/// All strokes of a drawing, layer by layer, in millimetres.
fn draw_layers(content: &mut String, drawing: &Drawing, style: &Style) {
    for (i, layer) in drawing.layers.iter().enumerate() {
        let _ = writeln!(content, "/OC /L{i} BDC");
        colour(content, style.pen(layer.kind));
        layer.marks.iter().flat_map(|m| &m.strokes).for_each(|stroke| path(content, stroke));
        *content += "EMC\n";
    }
}

/// Colour and width of what follows.
fn colour(content: &mut String, pen: Pen) {
    let [r, g, b] = pen.colour.map(|c| decimal(f64::from(c) / 255.0));
    let _ = writeln!(content, "{r} {g} {b} RG {} w", decimal(pen.width));
}

/// One path, stroked.
fn path(content: &mut String, stroke: &Stroke) {
    let points = shown_points(stroke, None);
    for (i, [x, y]) in points.iter().enumerate() {
        let _ = write!(content, "{x} {y} {} ", if i == 0 { 'm' } else { 'l' });
    }
    *content += if stroke.closed { "s\n" } else { "S\n" };
}

/// The file: catalogue, pages, layers, information.
/// `extra` is one more layer, `/L5`, which is printed; `prints_info` says whether the layer `info`
/// is.
fn document(
    pages: &[Page],
    (title, command): (&str, &str),
    extra: Option<&str>,
    prints_info: bool,
) -> Vec<u8> {
    let mut file = Objects::default();
    let layers = LayerKind::ALL.len() + usize::from(extra.is_some());
    // 1 the catalogue, 2 the pages, 3 the information, then the layers, then two objects a page.
    let layer = |i: usize| 4 + i;
    let page_at = |i: usize| 4 + layers + 2 * i;
    let list = |numbers: Vec<usize>| {
        numbers.iter().map(|n| format!("{n} 0 R")).collect::<Vec<_>>().join(" ")
    };
    let all_layers = list((0..layers).map(layer).collect());
    let info = layer(LayerKind::ALL.len() - 1);
    file.add(&format!(
        "<< /Type /Catalog /Pages 2 0 R /OCProperties << /OCGs [{all_layers}] /D << /Order \
        [{all_layers}] /ON [{all_layers}] \
         /AS [<< /Event /Print /Category [/Print] /OCGs [{info} 0 R] >>] >> >> >>"
    ));
    let kids = list((0..pages.len()).map(page_at).collect());
    file.add(&format!("<< /Type /Pages /Count {} /Kids [{kids}] >>", pages.len()));
    file.add(&format!(
        "<< /Title {} /Subject {} /Creator (kerfold) >>",
        text(title),
        text(command)
    ));
    for kind in LayerKind::ALL {
        let is_printed = prints_info || kind != LayerKind::Info;
        let state = if is_printed { "ON" } else { "OFF" };
        let name = kind.name();
        file.add(&format!(
            "<< /Type /OCG /Name ({name}) /Usage << /Print << /PrintState /{state} >> >> >>"
        ));
    }
    if let Some(name) = extra {
        file.add(&format!("<< /Type /OCG /Name ({name}) >>"));
    }
    let properties: Vec<String> = (0..layers).map(|i| format!("/L{i} {} 0 R", layer(i))).collect();
    let properties = properties.join(" ");
    let scale = format!("{POINTS:.9}");
    for (i, page) in pages.iter().enumerate() {
        let (width, height) = (decimal(page.width * POINTS), decimal(page.height * POINTS));
        file.add(&format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] \
             /Resources << /Properties << {properties} >> >> /Contents {} 0 R >>",
            page_at(i) + 1
        ));
        let content = format!("{scale} 0 0 {scale} 0 0 cm\n1 J 1 j\n{}", page.content);
        file.add(&format!("<< /Length {} >>\nstream\n{content}endstream", content.len()));
    }
    file.finish()
}

/// A string object: ASCII in brackets, anything else in UTF-16.
fn text(text: &str) -> String {
    if text.chars().all(|c| (' '..='~').contains(&c)) {
        let escaped = text.replace('\\', r"\\").replace('(', r"\(").replace(')', r"\)");
        return format!("({escaped})");
    }
    let units: String = text.encode_utf16().map(|unit| format!("{unit:04X}")).collect();
    format!("<FEFF{units}>")
}

/// Numbered objects and where they begin.
struct Objects {
    bytes: Vec<u8>,
    offsets: Vec<usize>,
}

impl Default for Objects {
    fn default() -> Self {
        Self { bytes: b"%PDF-1.5\n".to_vec(), offsets: Vec::new() }
    }
}

impl Objects {
    fn add(&mut self, object: &str) {
        self.begin();
        self.bytes.extend(object.bytes());
        self.bytes.extend(b"\nendobj\n");
    }

    fn begin(&mut self) {
        self.offsets.push(self.bytes.len());
        self.bytes.extend(format!("{} 0 obj\n", self.offsets.len()).bytes());
    }

    /// The file; object 1 is its root, object 3 its information.
    fn finish(mut self) -> Vec<u8> {
        let start = self.bytes.len();
        let count = self.offsets.len() + 1;
        let mut end = format!("xref\n0 {count}\n0000000000 65535 f \n");
        for offset in &self.offsets {
            let _ = writeln!(end, "{offset:010} 00000 n ");
        }
        let _ = write!(
            end,
            "trailer\n<< /Size {count} /Root 1 0 R /Info 3 0 R >>\nstartxref\n{start}\n%%EOF\n"
        );
        self.bytes.extend(end.bytes());
        self.bytes
    }
}
