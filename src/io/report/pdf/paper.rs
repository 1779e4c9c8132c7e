//! Pages of A4 that are filled from the top, and the file of them.
//!
//! Lengths are points (1/72 in). Places are measured from the top left corner of the page, y down.

use std::fmt::Write as _;

use miniz_oxide::deflate::compress_to_vec_zlib;

use super::font::{Font, string};
use super::raster::Raster;
use crate::io::number::decimal;
use crate::io::sheet::pdf::{Objects, text as string_object};

/// Width and height of A4.
const PAGE: [f64; 2] = [595.276, 841.89];
/// Free borders: at the sides, above, and below, where the foot stands.
const BORDER: [f64; 3] = [48.0, 48.0, 58.0];
/// Left end of what is printed, and its width.
pub(super) const LEFT: f64 = BORDER[0];
pub(super) const WIDTH: f64 = PAGE[0] - 2.0 * BORDER[0];
/// How hard streams are packed, 0 to 10.
const PACKING: u8 = 6;

/// Colours of the report.
pub(super) type Rgb = [u8; 3];
pub(super) const INK: Rgb = [38, 36, 31];
pub(super) const SOFT: Rgb = [109, 104, 95];
pub(super) const LINE: Rgb = [220, 215, 205];
pub(super) const GOOD: Rgb = [47, 125, 93];
pub(super) const BAD: Rgb = [176, 58, 46];
pub(super) const WHITE: Rgb = [255, 255, 255];

/// How a text looks.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    pub(super) font: Font,
    pub(super) size: f64,
    pub(super) colour: Rgb,
}

impl Pen {
    pub(super) const fn new(font: Font, size: f64, colour: Rgb) -> Self {
        Self { font, size, colour }
    }

    /// From one line to the next.
    pub(super) fn leading(&self) -> f64 {
        1.35 * self.size
    }
}

/// Where a text stands at its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Pages, the last one being filled.
pub(super) struct Paper {
    pages: Vec<String>,
    images: Vec<Raster>,
    /// How far down the last page is filled.
    pub(super) y: f64,
}

impl Paper {
    pub(super) fn new() -> Self {
        Self { pages: vec![String::new()], images: Vec::new(), y: BORDER[1] }
    }

    /// What is free on this page.
    pub(super) fn room(&self) -> f64 {
        PAGE[1] - BORDER[2] - self.y
    }

    /// Goes on to the next page where there is less room. Says whether it did.
    pub(super) fn need(&mut self, height: f64) -> bool {
        let is_full = self.room() < height && self.y > BORDER[1];
        if is_full {
            self.pages.push(String::new());
            self.y = BORDER[1];
        }
        is_full
    }

    /// A line of text whose base line is at a height.
    pub(super) fn text(&mut self, at: [f64; 2], anchor: Anchor, pen: Pen, text: &str) {
        let page = self.pages.len() - 1;
        self.text_on(page, at, anchor, pen, text);
    }

    fn text_on(&mut self, page: usize, [x, y]: [f64; 2], anchor: Anchor, pen: Pen, text: &str) {
        let width = pen.font.width(text.trim_end(), pen.size);
        let x = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - width / 2.0,
            Anchor::End => x - width,
        };
        let (font, size) = (pen.font.short(), decimal(pen.size));
        let (colour, x, y) = (fill(pen.colour), decimal(x), decimal(PAGE[1] - y));
        let _ = writeln!(
            self.pages[page],
            "BT {colour} /{font} {size} Tf {x} {y} Td {} Tj ET",
            string(text)
        );
    }

    /// Text in as many lines as it needs, from page to page.
    pub(super) fn paragraph(&mut self, pen: Pen, text: &str) {
        for line in pen.font.wrap(text, pen.size, WIDTH) {
            self.need(pen.leading());
            self.y += pen.leading();
            self.text([LEFT, self.y - 0.3 * pen.size], Anchor::Start, pen, &line);
        }
    }

    /// A filled box: its top left corner and its size.
    pub(super) fn fill(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: Rgb) {
        let numbers = [x, PAGE[1] - y - height, width, height].map(decimal).join(" ");
        self.draw(&format!("{} {numbers} re f", fill(colour)));
    }

    /// The border of a box.
    pub(super) fn frame(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: Rgb) {
        let numbers = [x, PAGE[1] - y - height, width, height].map(decimal).join(" ");
        self.draw(&format!("{} 0.6 w {numbers} re S", stroke(colour)));
    }

    /// A straight line.
    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb, width: f64) {
        let [[a, b], [c, d]] = [from, to].map(|[x, y]| [decimal(x), decimal(PAGE[1] - y)]);
        self.draw(&format!("{} {} w {a} {b} m {c} {d} l S", stroke(colour), decimal(width)));
    }

    /// A dashed vertical line.
    pub(super) fn dashes(&mut self, x: f64, from: f64, to: f64, colour: Rgb) {
        self.draw("[4 2.5] 0 d");
        self.line([x, from], [x, to], colour, 0.8);
        self.draw("[] 0 d");
    }

    /// A picture in a frame, as wide as told; its height.
    pub(super) fn image(&mut self, [x, y]: [f64; 2], width: f64, raster: Raster) -> f64 {
        let height = width * raster.height as f64 / raster.width as f64;
        let number = self.images.len();
        self.images.push(raster);
        let place = [width, 0.0, 0.0, height, x, PAGE[1] - y - height].map(decimal).join(" ");
        self.draw(&format!("q {place} cm /I{number} Do Q"));
        self.frame([x, y], [width, height], LINE);
        height
    }

    fn draw(&mut self, operators: &str) {
        if let Some(page) = self.pages.last_mut() {
            page.push_str(operators);
            page.push('\n');
        }
    }

    /// The file. Every page has the title and its number at its foot.
    pub(super) fn finish(mut self, title: &str, command: &str) -> Vec<u8> {
        let pen = Pen::new(Font::Regular, 8.0, SOFT);
        let (count, y) = (self.pages.len(), PAGE[1] - 32.0);
        let short: String = title.chars().take(90).collect();
        for page in 0..count {
            self.text_on(page, [LEFT, y], Anchor::Start, pen, &short);
            let number = format!("Page {} of {count}", page + 1);
            self.text_on(page, [LEFT + WIDTH, y], Anchor::End, pen, &number);
        }
        self.file(title, command)
    }

    fn file(&self, title: &str, command: &str) -> Vec<u8> {
        let mut file = Objects::packed();
        // 1 the catalogue, 2 the pages, 3 the information, then the fonts, the pictures, and two
        // objects a page.
        let fonts = 4;
        let images = fonts + Font::ALL.len();
        let page_at = |i: usize| images + self.images.len() + 2 * i;
        file.add(
            "<< /Type /Catalog /Pages 2 0 R /Lang (en) /ViewerPreferences << /DisplayDocTitle \
        true >> >>",
        );
        let kids: Vec<String> =
            (0..self.pages.len()).map(|i| format!("{} 0 R", page_at(i))).collect();
        let [width, height] = PAGE.map(decimal);
        let named = |names: Vec<String>, first: usize| -> String {
            names
                .iter()
                .enumerate()
                .map(|(i, name)| format!(" /{name} {} 0 R", first + i))
                .collect()
        };
        let font_names =
            named(Font::ALL.iter().map(|font| font.short().to_owned()).collect(), fonts);
        let image_names = named((0..self.images.len()).map(|i| format!("I{i}")).collect(), images);
        file.add(&format!(
            "<< /Type /Pages /Count {} /Kids [{}] /MediaBox [0 0 {width} {height}] \
             /Resources << /Font <<{font_names} >> /XObject <<{image_names} >> >> >>",
            kids.len(),
            kids.join(" ")
        ));
        let [title, command] = [title, command].map(string_object);
        file.add(&format!("<< /Title {title} /Subject {command} /Creator (kerfold) >>"));
        for font in Font::ALL {
            let name = font.name();
            file.add(&format!(
                "<< /Type /Font /Subtype /Type1 /BaseFont /{name} /Encoding /WinAnsiEncoding >>"
            ));
        }
        for Raster { width, height, rgb } in &self.images {
            let kind = format!(
                "/Type /XObject /Subtype /Image /Width {width} /Height {height} /ColorSpace \
                /DeviceRGB /BitsPerComponent 8 "
            );
            file.add_stream(&(kind + "/Filter /FlateDecode"), &compress_to_vec_zlib(rgb, PACKING));
        }
        for (i, page) in self.pages.iter().enumerate() {
            file.add(&format!("<< /Type /Page /Parent 2 0 R /Contents {} 0 R >>", page_at(i) + 1));
            file.add_stream(
                "/Filter /FlateDecode",
                &compress_to_vec_zlib(page.as_bytes(), PACKING),
            );
        }
        file.finish()
    }
}

fn fill(colour: Rgb) -> String {
    format!("{} rg", numbers(colour))
}

fn stroke(colour: Rgb) -> String {
    format!("{} RG", numbers(colour))
}

fn numbers(colour: Rgb) -> String {
    colour.map(|c| decimal(f64::from(c) / 255.0)).join(" ")
}
