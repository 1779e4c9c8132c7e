//! The file of the pages: marks drawn by krilla, and the tree of what they are.

use krilla::Document;
use krilla::color::rgb;
use krilla::geom::{PathBuilder, Point, Rect, Size, Transform};
use krilla::image::Image;
use krilla::metadata::Metadata;
use krilla::page::PageSettings;
use krilla::paint::{Fill, Stroke, StrokeDash};
use krilla::surface::Surface;
use krilla::tagging::{
    Artifact, ArtifactType, ContentTag, Identifier, SpanTag, TableHeaderScope, Tag, TagGroup,
    TagKind, TagTree,
};
use krilla::text::Font as FontFile;

use super::font::Font;
use super::paper::{Child, Mark, PAGE, Paper, Pen, Rgb, Role, Shape};

/// The bytes of the file. The same pages give the same bytes: nothing in it shows the time.
pub(super) fn bytes(paper: &Paper, title: &str, command: &str) -> Vec<u8> {
    let fonts = Font::ALL
        .map(|font| FontFile::new(font.file().into(), 0).expect("the font of the house is a font"));
    let mut document = Document::new();
    document.set_metadata(
        Metadata::new()
            .title(title.to_owned())
            .description(command.to_owned())
            .creator("kerfold".to_owned())
            .language("en".to_owned()),
    );
    let mut names: Vec<Option<Identifier>> = Vec::with_capacity(paper.marks.len());
    names.resize_with(paper.marks.len(), || None);
    for number in 0..paper.pages {
        let [width, height] = PAGE.map(|x| x as f32);
        let settings = PageSettings::from_wh(width, height).expect("A4 has a size");
        let mut page = document.start_page_with(settings);
        let mut surface = page.surface();
        let marks = paper.marks.iter().enumerate().filter(|(_, mark)| mark.page == number);
        for (i, mark) in marks {
            names[i] = draw(&mut surface, mark, &fonts);
        }
        surface.finish();
        page.finish();
    }
    let mut tree = TagTree::new().with_lang(Some("en".to_owned()));
    for child in &paper.parts[0].children {
        if let Child::Part(part) = *child {
            tree.push(group(paper, part, &mut names));
        }
    }
    document.set_tag_tree(tree);
    document.finish().expect("a report keeps the rules of PDF")
}

/// Draws a mark; its name for the tree, when it is read.
fn draw(surface: &mut Surface<'_>, mark: &Mark, fonts: &[FontFile; 2]) -> Option<Identifier> {
    let tag = match (&mark.shape, mark.is_read) {
        (Shape::Text { pen, text, .. }, true) => {
            // An empty box stands for a letter; who copies the text gets the letter.
            let has_boxes = text.chars().any(|letter| !pen.font.has(letter));
            let actual = has_boxes.then_some(text.as_str());
            ContentTag::Span(SpanTag::empty().with_actual_text(actual))
        }
        (_, true) => ContentTag::Other,
        (_, false) => ContentTag::Artifact(Artifact::with_kind(ArtifactType::Layout)),
    };
    let name = surface.start_tagged(tag);
    match &mark.shape {
        Shape::Text { at, pen, text } => draw_text(surface, *at, *pen, text, fonts),
        Shape::Box { at, size, colour } => draw_box(surface, *at, *size, *colour),
        Shape::Line { ends, colour, width, is_dashed } => {
            let array = vec![4.0, 2.5];
            let dash = is_dashed.then_some(StrokeDash { array, offset: 0.0 });
            let stroke =
                Stroke { paint: ink(*colour), width: *width as f32, dash, ..Stroke::default() };
            draw_line(surface, *ends, stroke);
        }
        Shape::Picture { at, size, image } => draw_picture(surface, *at, *size, image),
    }
    surface.end_tagged();
    mark.is_read.then_some(name)
}

fn draw_text(surface: &mut Surface<'_>, at: [f64; 2], pen: Pen, text: &str, fonts: &[FontFile; 2]) {
    set_fill(surface, pen.colour);
    let font = fonts[pen.font as usize].clone();
    let glyphs = pen.font.glyphs(text);
    surface.draw_glyphs(point(at), &glyphs, font, text, pen.size as f32, false);
}

fn draw_box(surface: &mut Surface<'_>, at: [f64; 2], size: [f64; 2], colour: Rgb) {
    let [[x, y], [width, height]] = [at, size].map(|pair| pair.map(|x| x as f32));
    let mut path = PathBuilder::new();
    // A box without a width shows nothing and is no rectangle.
    if let Some(rectangle) = Rect::from_xywh(x, y, width, height) {
        path.push_rect(rectangle);
    }
    if let Some(path) = path.finish() {
        set_fill(surface, colour);
        surface.draw_path(&path);
    }
}

fn draw_line(surface: &mut Surface<'_>, [from, to]: [[f64; 2]; 2], stroke: Stroke) {
    let mut path = PathBuilder::new();
    let [from, to] = [point(from), point(to)];
    path.move_to(from.x, from.y);
    path.line_to(to.x, to.y);
    if let Some(path) = path.finish() {
        surface.set_fill(None);
        surface.set_stroke(Some(stroke));
        surface.draw_path(&path);
        surface.set_stroke(None);
    }
}

fn draw_picture(surface: &mut Surface<'_>, at: [f64; 2], size: [f64; 2], image: &Image) {
    let [x, y] = at.map(|x| x as f32);
    let [width, height] = size.map(|x| x as f32);
    if let Some(size) = Size::from_wh(width, height) {
        surface.push_transform(&Transform::from_translate(x, y));
        surface.draw_image(image.clone(), size);
        surface.pop();
    }
}

fn set_fill(surface: &mut Surface<'_>, colour: Rgb) {
    surface.set_stroke(None);
    surface.set_fill(Some(Fill { paint: ink(colour), ..Fill::default() }));
}

fn ink([red, green, blue]: Rgb) -> krilla::paint::Paint {
    rgb::Color::new(red, green, blue).into()
}

fn point([x, y]: [f64; 2]) -> Point {
    Point::from_xy(x as f32, y as f32)
}

/// A part with everything in it.
fn group(paper: &Paper, part: usize, names: &mut [Option<Identifier>]) -> TagGroup {
    let part = &paper.parts[part];
    let mut group = TagGroup::new(part.role.as_ref().map_or(Tag::Div.into(), kind));
    for child in &part.children {
        match *child {
            Child::Part(inner) => group.push(self::group(paper, inner, names)),
            Child::Mark(mark) => {
                if let Some(name) = names[mark].take() {
                    group.push(name);
                }
            }
        }
    }
    group
}

fn kind(role: &Role) -> TagKind {
    let level = |number: u16| number.try_into().expect("headings count from 1");
    match role {
        Role::Title => Tag::Hn(level(1), None).into(),
        Role::Heading => Tag::Hn(level(2), None).into(),
        Role::Paragraph => Tag::P.into(),
        Role::Table => Tag::Table.into(),
        Role::Row => Tag::TR.into(),
        Role::HeadCell => Tag::TH(TableHeaderScope::Column).into(),
        Role::Cell => Tag::TD.into(),
        Role::Figure(shows) => Tag::Figure(Some(shows.clone())).into(),
    }
}
