//! Pages of A4 that are filled from the top: what stands where, and what it is.
//!
//! Lengths are points (1/72 in). Places are measured from the top left corner of the page, y down.

use std::collections::BTreeSet;

use krilla::image::Image;

use super::font::Font;

/// Width and height of A4.
pub(super) const PAGE: [f64; 2] = [595.276, 841.89];
/// Free borders: at the sides, above, and below, where the foot stands.
const BORDER: [f64; 3] = [48.0, 48.0, 58.0];
/// Left end of what is printed, and its width.
pub(super) const LEFT: f64 = BORDER[0];
pub(super) const WIDTH: f64 = PAGE[0] - 2.0 * BORDER[0];
/// Width of the lines of frames.
const FRAME: f64 = 0.6;

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

/// What a part of the report is, for programs that read it aloud or take it apart.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Role {
    Title,
    Heading,
    Paragraph,
    Table,
    Row,
    HeadCell,
    Cell,
    /// A picture, with what it shows in words.
    Figure(String),
}

/// A part with the parts and marks in it, in the order in which they are read.
#[derive(Debug, Default)]
pub(super) struct Part {
    pub(super) role: Option<Role>,
    pub(super) children: Vec<Child>,
}

/// What is in a part, by number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Child {
    Part(usize),
    Mark(usize),
}

/// One thing on a page.
#[derive(Debug)]
pub(super) struct Mark {
    pub(super) page: usize,
    pub(super) shape: Shape,
    /// Whether it belongs to a part; what does not is an ornament.
    pub(super) is_read: bool,
}

/// What is drawn.
#[derive(Debug)]
pub(super) enum Shape {
    /// A line of text whose base line begins at a point.
    Text { at: [f64; 2], pen: Pen, text: String },
    /// A filled box: its top left corner and its size.
    Box { at: [f64; 2], size: [f64; 2], colour: Rgb },
    /// A straight line, dashed or not.
    Line { ends: [[f64; 2]; 2], colour: Rgb, width: f64, is_dashed: bool },
    /// A picture: its top left corner and its size.
    Picture { at: [f64; 2], size: [f64; 2], image: Image },
}

/// Pages, the last one being filled.
pub(super) struct Paper {
    pub(super) pages: usize,
    pub(super) marks: Vec<Mark>,
    /// The first is the whole.
    pub(super) parts: Vec<Part>,
    /// The parts that are open, the whole first.
    open: Vec<usize>,
    /// Letters that a font lacks.
    missing: BTreeSet<char>,
    /// How far down the last page is filled.
    pub(super) y: f64,
}

impl Paper {
    pub(super) fn new() -> Self {
        Self {
            pages: 1,
            marks: Vec::new(),
            parts: vec![Part::default()],
            open: vec![0],
            missing: BTreeSet::new(),
            y: BORDER[1],
        }
    }

    /// What is free on this page.
    pub(super) fn room(&self) -> f64 {
        PAGE[1] - BORDER[2] - self.y
    }

    /// Goes on to the next page where there is less room. Says whether it did.
    pub(super) fn need(&mut self, height: f64) -> bool {
        let is_full = self.room() < height && self.y > BORDER[1];
        if is_full {
            self.pages += 1;
            self.y = BORDER[1];
        }
        is_full
    }

    /// Draws a part: the texts and pictures of `draw` belong to it.
    pub(super) fn part(&mut self, role: Role, draw: impl FnOnce(&mut Self)) {
        let number = self.parts.len();
        self.parts.push(Part { role: Some(role), children: Vec::new() });
        self.add_child(Child::Part(number));
        self.open.push(number);
        draw(self);
        self.open.pop();
    }

    fn add_child(&mut self, child: Child) {
        if let Some(&part) = self.open.last() {
            self.parts[part].children.push(child);
        }
    }

    /// A line of text whose base line is at a height.
    pub(super) fn text(&mut self, at: [f64; 2], anchor: Anchor, pen: Pen, text: &str) {
        self.text_on(self.pages - 1, at, anchor, pen, text);
    }

    fn text_on(&mut self, page: usize, [x, y]: [f64; 2], anchor: Anchor, pen: Pen, text: &str) {
        let text = text.trim_end();
        if text.is_empty() {
            return;
        }
        let width = pen.font.width(text, pen.size);
        let x = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - width / 2.0,
            Anchor::End => x - width,
        };
        self.missing.extend(text.chars().filter(|&letter| !pen.font.has(letter)));
        let shape = Shape::Text { at: [x, y], pen, text: text.to_owned() };
        // Outside all parts there is only what every page repeats.
        self.draw(page, shape, self.open.len() > 1);
    }

    /// Text in as many lines as it needs, from page to page.
    pub(super) fn paragraph(&mut self, role: Role, pen: Pen, text: &str) {
        self.part(role, |paper| {
            for line in pen.font.wrap(text, pen.size, WIDTH) {
                paper.need(pen.leading());
                paper.y += pen.leading();
                paper.text([LEFT, paper.y - 0.3 * pen.size], Anchor::Start, pen, &line);
            }
        });
    }

    /// A filled box: its top left corner and its size.
    pub(super) fn fill(&mut self, at: [f64; 2], size: [f64; 2], colour: Rgb) {
        self.draw(self.pages - 1, Shape::Box { at, size, colour }, false);
    }

    /// The border of a box.
    pub(super) fn frame(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], colour: Rgb) {
        let corners = [[x, y], [x + width, y], [x + width, y + height], [x, y + height]];
        for i in 0..4 {
            self.line(corners[i], corners[(i + 1) % 4], colour, FRAME);
        }
    }

    /// A straight line.
    pub(super) fn line(&mut self, from: [f64; 2], to: [f64; 2], colour: Rgb, width: f64) {
        let shape = Shape::Line { ends: [from, to], colour, width, is_dashed: false };
        self.draw(self.pages - 1, shape, false);
    }

    /// A dashed vertical line.
    pub(super) fn dashes(&mut self, x: f64, from: f64, to: f64, colour: Rgb) {
        let ends = [[x, from], [x, to]];
        let shape = Shape::Line { ends, colour, width: 0.8, is_dashed: true };
        self.draw(self.pages - 1, shape, false);
    }

    /// A picture in a frame, as wide as asked, with what it shows in words; its height.
    pub(super) fn image(&mut self, at: [f64; 2], width: f64, image: &Image, shows: &str) -> f64 {
        let size = [width, width * aspect(image)];
        self.part(Role::Figure(shows.to_owned()), |paper| {
            let shape = Shape::Picture { at, size, image: image.clone() };
            paper.draw(paper.pages - 1, shape, true);
        });
        self.frame(at, size, LINE);
        size[1]
    }

    fn draw(&mut self, page: usize, shape: Shape, is_read: bool) {
        if is_read {
            self.add_child(Child::Mark(self.marks.len()));
        }
        self.marks.push(Mark { page, shape, is_read });
    }

    /// What stands at the end of the report: who made it, and which letters could not be shown.
    pub(super) fn colophon(&mut self, pen: Pen, command: &str) {
        self.paragraph(Role::Paragraph, pen, &format!("Made by {command}"));
        if self.missing.is_empty() {
            return;
        }
        let signs: Vec<String> =
            self.missing.iter().map(|&sign| format!("U+{:04X}", u32::from(sign))).collect();
        let note = format!(
            "Shown as an empty box, since the font of this report has no glyph for it: {}.",
            signs.join(", ")
        );
        self.paragraph(Role::Paragraph, pen, &note);
    }

    /// Puts the title and its number at the foot of every page.
    pub(super) fn number(&mut self, title: &str) {
        let pen = Pen::new(Font::Regular, 8.0, SOFT);
        let y = PAGE[1] - 32.0;
        let short: String = title.chars().take(90).collect();
        for page in 0..self.pages {
            self.text_on(page, [LEFT, y], Anchor::Start, pen, &short);
            let number = format!("Page {} of {}", page + 1, self.pages);
            self.text_on(page, [LEFT + WIDTH, y], Anchor::End, pen, &number);
        }
    }
}

/// Height over width of a picture.
pub(super) fn aspect(image: &Image) -> f64 {
    let (width, height) = image.size();
    f64::from(height) / f64::from(width.max(1))
}
