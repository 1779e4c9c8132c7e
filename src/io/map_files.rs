//! The assembly map as SVG and PDF: filled outlines and single-stroke names, so that both look
//! alike without a font.

use std::fmt::Write as _;

use glam::DVec2;

use super::number::{decimal, push_point};
use crate::panel::{AssemblyMap, MapPanel};
use crate::sheet::lettering;

/// Share of the free room in a panel that its name takes; names are never higher than this, nor
/// drawn below that, in mm.
const NAME_SHARE: f64 = 0.7;
const NAME_HEIGHTS: [f64; 2] = [0.2, 4.0];
/// Height of the titles in mm.
const TITLE: f64 = 4.0;
/// Widths of lines in mm.
const OUTLINE: f64 = 0.12;
const NAME: f64 = 0.15;

/// What is drawn, in order, page coordinates in mm with y up.
enum Shape {
    /// A closed outline, filled with white.
    Panel { name: String, outline: Vec<DVec2> },
    /// Open lines.
    Text(Vec<Vec<DVec2>>),
}

fn shapes(map: &AssemblyMap) -> Vec<Shape> {
    let mut shapes = Vec::new();
    for view in &map.views {
        for panel in &view.panels {
            shapes.push(Shape::Panel {
                name: panel.panel.to_string(),
                outline: panel.outline.clone(),
            });
            shapes.extend(name(panel).map(Shape::Text));
        }
        shapes.extend(text(view.title, view.title_at, TITLE).map(Shape::Text));
    }
    let scale = format!("SCALE 1:{:.1}", map.scale);
    shapes.extend(text(&scale, DVec2::new(map.width - 70.0, 3.0), TITLE).map(Shape::Text));
    shapes
}

/// Lettering that begins at a point.
fn text(words: &str, at: DVec2, height: f64) -> Option<Vec<Vec<DVec2>>> {
    let letters = lettering(words, height).ok()?;
    Some(letters.strokes.into_iter().map(|s| s.into_iter().map(|p| p + at).collect()).collect())
}

/// The name of a panel about its middle, as large as there is room.
fn name(panel: &MapPanel) -> Option<Vec<Vec<DVec2>>> {
    let words = panel.panel.to_string();
    let unit = lettering(&words, 1.0).ok()?;
    let size = unit.high - unit.low;
    let height = (NAME_SHARE * (panel.room / size).min_element()).min(NAME_HEIGHTS[1]);
    if height.is_nan() || height < NAME_HEIGHTS[0] {
        return None;
    }
    text(&words, panel.label_at - unit.low.midpoint(unit.high) * height, height)
}

/// The map as SVG; `command` is the command line that made it.
///
/// # Example
/// ```
/// use kerfold::io::map_files::map_svg;
/// use kerfold::panel::assembly_map;
/// use kerfold::panel::{PanelParams, plates};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let map = assembly_map(&made);
/// assert!(map_svg(&map, "my program").contains("<svg"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn map_svg(map: &AssemblyMap, command: &str) -> String {
    let (width, height) = (map.width, map.height);
    let mut svg = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
        width=\"{width}mm\" \
         height=\"{height}mm\" viewBox=\"0 0 {width} {height}\">\n<metadata>{}</metadata>\n\
         <g fill=\"none\" stroke=\"#000000\" stroke-width=\"{NAME}\" stroke-linejoin=\"round\" \
         stroke-linecap=\"round\">\n",
        escaped(command)
    );
    let path = |svg: &mut String, points: &[DVec2]| {
        for (i, p) in points.iter().enumerate() {
            *svg += if i == 0 { "M " } else { " L " };
            push_point(svg, DVec2::new(p.x, height - p.y));
        }
    };
    for shape in shapes(map) {
        match shape {
            Shape::Panel { name, outline } => {
                let _ = write!(
                    svg,
                    "<path class=\"{name}\" fill=\"#FFFFFF\" stroke=\"#707070\" \
                    stroke-width=\"{OUTLINE}\" d=\""
                );
                path(&mut svg, &outline);
                svg += " Z\"/>\n";
            }
            Shape::Text(strokes) => {
                svg += "<path d=\"";
                for (i, stroke) in strokes.iter().enumerate() {
                    svg += if i == 0 { "" } else { " " };
                    path(&mut svg, stroke);
                }
                svg += "\"/>\n";
            }
        }
    }
    svg + "</g>\n</svg>\n"
}

/// The map as PDF, at true size on one page; `command` is the command line that made it.
///
/// # Example
/// ```
/// use kerfold::io::map_files::map_pdf;
/// use kerfold::panel::assembly_map;
/// use kerfold::panel::{PanelParams, plates};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let map = assembly_map(&made);
/// assert!(map_pdf(&map, "my program").starts_with(b"%PDF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn map_pdf(map: &AssemblyMap, command: &str) -> Vec<u8> {
    let mut content = format!("{0} 0 0 {0} 0 0 cm 1 J 1 j\n", 72.0 / 25.4);
    for shape in shapes(map) {
        let (setup, strokes, end) = match &shape {
            Shape::Panel { outline, .. } => {
                (format!("1 g 0.44 G {OUTLINE} w"), std::slice::from_ref(outline), "b")
            }
            Shape::Text(strokes) => (format!("0 G {NAME} w"), strokes.as_slice(), "S"),
        };
        content += &setup;
        for points in strokes {
            for (i, &p) in points.iter().enumerate() {
                content.push(' ');
                push_point(&mut content, p);
                content += if i == 0 { " m" } else { " l" };
            }
        }
        let _ = writeln!(content, " {end}");
    }
    pdf_pages([map.width, map.height], [content].into_iter(), "assembly map", command)
}

/// A PDF of pages of one size in mm; the title is plain ASCII. One page after the other is made and
/// written, so that no two copies of thousands of them are held.
pub(super) fn pdf_pages(
    [width, height]: [f64; 2],
    pages: impl ExactSizeIterator<Item = String>,
    title: &str,
    command: &str,
) -> Vec<u8> {
    let points = |mm: f64| decimal(mm * 72.0 / 25.4);
    let (width, height) = (points(width), points(height));
    let kids: Vec<String> = (0..pages.len()).map(|i| format!("{} 0 R", 4 + 2 * i)).collect();
    let mut file = Objects { file: b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n".to_vec(), places: Vec::new() };
    file.add(&["<< /Type /Catalog /Pages 2 0 R >>"]);
    file.add(&[&format!("<< /Type /Pages /Kids [{}] /Count {} >>", kids.join(" "), pages.len())]);
    file.add(&[&format!(
        "<< /Title ({title}) /Creator (kerfold) /Subject {} >>",
        pdf_text(command)
    )]);
    for (i, content) in pages.enumerate() {
        file.add(&[&format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Resources << >> \
            /Contents {} 0 R >>",
            5 + 2 * i
        )]);
        let head = format!("<< /Length {} >>\nstream\n", content.len());
        file.add(&[&head, &content, "endstream"]);
    }
    file.end()
}

/// The numbered objects of a PDF.
struct Objects {
    file: Vec<u8>,
    /// Where each begins.
    places: Vec<usize>,
}

impl Objects {
    /// Writes the next object, given in parts.
    fn add(&mut self, parts: &[&str]) {
        self.places.push(self.file.len());
        self.file.extend(format!("{} 0 obj\n", self.places.len()).bytes());
        parts.iter().for_each(|part| self.file.extend_from_slice(part.as_bytes()));
        self.file.extend_from_slice(b"\nendobj\n");
    }

    /// The file with its table of places.
    fn end(self) -> Vec<u8> {
        let Self { mut file, places } = self;
        let table = file.len();
        file.extend(format!("xref\n0 {}\n0000000000 65535 f \n", places.len() + 1).bytes());
        places.iter().for_each(|place| file.extend(format!("{place:010} 00000 n \n").bytes()));
        let trailer = format!(
            "trailer\n<< /Size {} /Root 1 0 R /Info 3 0 R >>\nstartxref\n{table}\n%%EOF\n",
            places.len() + 1
        );
        file.extend(trailer.bytes());
        file
    }
}

/// A PDF text string: ASCII in brackets, anything else as UTF-16 in hexadecimal.
fn pdf_text(text: &str) -> String {
    if text.chars().all(|c| (' '..='~').contains(&c)) {
        let escaped = text.replace('\\', r"\\").replace('(', r"\(").replace(')', r"\)");
        return format!("({escaped})");
    }
    let units: String = text.encode_utf16().map(|unit| format!("{unit:04X}")).collect();
    format!("<FEFF{units}>")
}

fn escaped(text: &str) -> String {
    let shown = text.replace(|c: char| c.is_control(), " ");
    shown.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
