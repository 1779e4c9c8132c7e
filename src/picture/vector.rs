//! Pictures of models as areas and lines, for SVG and PDF.
//!
//! Faces are cut and put in order from back to front, so that painting them one over the other hides
//! what is hidden; lines are the visible parts that a picture of pixels has. Smooth surfaces are
//! shaded face by face.

use std::fmt::Write as _;

use glam::{DVec2, DVec3};

use super::band::{Band, HIDDEN};
use super::bsp::{Patch, painted};
use super::camera::Camera;
use super::frame::window;
use super::legend::{Legend, Shape};
use super::marks::Marks;
use super::model::colours;
use super::paint;
use super::params::Shadow;
use super::scene::{Ink, Scene};
use super::through::aimed;
use super::{PictureError, RenderParams};
use crate::geom::{Frame, Plane, triangulate};
use crate::mesh::Mesh;

/// Triangles of a vector picture at most: others are too heavy for the programs that open them.
pub const MAX_VECTOR_FACES: usize = 12_000;

/// Light that comes through a face of an x-ray.
const X_RAY: f64 = 0.35;

/// A picture of areas and lines; origin at the top left, y down, in pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct VectorPicture {
    width: f64,
    height: f64,
    /// From back to front.
    areas: Vec<(Vec<DVec2>, [u8; 3])>,
    opacity: f64,
    lines: Vec<VectorLine>,
    dots: Vec<(DVec2, f64, [u8; 3])>,
}

#[derive(Debug, Clone, PartialEq)]
struct VectorLine {
    points: Vec<DVec2>,
    colour: [u8; 3],
    width: f64,
    strength: f64,
}

/// Draws a model as areas and lines, with elements pointed out in red.
///
/// # Errors
/// As [`super::render_model`], and [`PictureError::TooManyFaces`] above [`MAX_VECTOR_FACES`]
/// triangles, [`PictureError::OnlyPixels`] for several views or a soft shadow.
pub fn render_vector(
    mesh: &Mesh,
    params: &RenderParams,
    marks: &Marks,
) -> Result<VectorPicture, PictureError> {
    if !params.views.is_empty() || params.shadow == Shadow::Soft {
        return Err(PictureError::OnlyPixels);
    }
    let params = &aimed(mesh, params)?;
    let (width, height) = params.pixels();
    super::blank(width, height)?;
    if mesh.face_count() == 0 {
        return Err(PictureError::NoFaces);
    }
    let triangles: usize = mesh.faces().map(|f| mesh.sides(f).saturating_sub(2)).sum();
    if triangles > MAX_VECTOR_FACES {
        return Err(PictureError::TooManyFaces { triangles });
    }
    let (legend, mut colours) = colours(mesh, params.colour);
    let legend = legend.filter(|_| Legend::has_room(width, height));
    let camera = Camera::fitted(&[mesh], params, window(width, height, legend.is_some()))?;
    marks.paint(&mut colours);
    let scene = Scene::new(mesh, params, &camera, (&colours, marks));
    let areas = painted(patches(mesh, &camera, &scene), camera.eye());
    let flat = |p: Patch<[u8; 3]>| {
        let points = p.points.iter().map(|&q| camera.place(q).truncate()).collect();
        (points, p.look)
    };
    let band = Band::new(&scene, width as usize, 0..height as usize);
    let tags = band.visible_tags(mesh);
    let letter = f64::from(width.max(height)) / 90.0;
    let words = tags.iter().flat_map(|tag| letters(&tag.text, tag.place.truncate(), letter));
    let dots = band.visible_dots(mesh).into_iter();
    let dots = dots.map(|d| (d.place.truncate(), scene.dot_radius, d.colour));
    let shapes = legend.map_or(Vec::new(), |legend| legend.shapes(width, height));
    let (legend_lines, legend_dots) = as_lines(&shapes);
    Ok(VectorPicture {
        width: width.into(),
        height: height.into(),
        areas: areas.into_iter().map(flat).collect(),
        opacity: if scene.is_x_ray { X_RAY } else { 1.0 },
        lines: lines(&scene, &band).into_iter().chain(words).chain(legend_lines).collect(),
        dots: dots.chain(legend_dots).collect(),
    })
}

/// The faces as triangles, turned as the camera, each with what a screen shows.
fn patches(mesh: &Mesh, camera: &Camera, scene: &Scene) -> Vec<Patch<[u8; 3]>> {
    let mut patches = Vec::new();
    let mut facets = scene.facets.iter().peekable();
    for f in mesh.faces() {
        let corners: Vec<DVec3> =
            mesh.face_vertices(f).map(|v| camera.turned(mesh.position(v))).collect();
        // A face that is seen from its edge has no facet, and covers nothing.
        let mut look = None;
        while let Some(facet) = facets.next_if(|facet| facet.face == f) {
            look = Some(paint::shown(facet.light));
        }
        let (Some(look), Some(plane)) = (look, Plane::newell(&corners)) else { continue };
        let frame = Frame::on_plane(&plane);
        let flat: Vec<DVec2> = corners.iter().map(|&p| frame.flatten(p)).collect();
        let patch = |t: [usize; 3]| Patch { points: t.map(|i| corners[i]).to_vec(), look };
        // A triangle without area covers nothing and divides nothing.
        let has_area =
            |[a, b, c]: &[usize; 3]| (flat[*b] - flat[*a]).perp_dot(flat[*c] - flat[*a]) != 0.0;
        patches.extend(triangulate(&flat).into_iter().filter(has_area).map(patch));
    }
    patches
}

fn lines(scene: &Scene, band: &Band<'_>) -> Vec<VectorLine> {
    let mut lines = Vec::new();
    for line in &scene.lines {
        let colour = line.ink.colour();
        let mut add = |points: Vec<DVec2>, strength: f64| {
            lines.push(VectorLine { points, colour, width: line.width, strength });
        };
        if scene.is_x_ray {
            let whole = line.ends.map(DVec3::truncate).to_vec();
            let share = if line.ink == Ink::Mark { 1.0 } else { HIDDEN };
            add(whole, f64::from(share * line.strength));
        }
        for part in band.visible_parts(line) {
            add(part.to_vec(), line.strength.into());
        }
    }
    lines
}

/// A disc: middle, radius, colour.
type Disc = (DVec2, f64, [u8; 3]);

/// The legend as lines and dots: its bars are lines as wide as the bars are high.
fn as_lines(shapes: &[Shape]) -> (Vec<VectorLine>, Vec<Disc>) {
    let (mut lines, mut dots) = (Vec::new(), Vec::new());
    let at = |x: f32, y: f32| DVec2::new(x.into(), y.into());
    for shape in shapes {
        match shape {
            &Shape::Bar { place: [x, y, width, height], colour } => lines.push(VectorLine {
                points: vec![at(x, y + height / 2.0), at(x + width, y + height / 2.0)],
                colour,
                // Rows are painted a little over one another, so that no gap shines through.
                width: f64::from(height) * 1.3,
                strength: 1.0,
            }),
            &Shape::Disc { middle: (x, y), radius, colour } => {
                dots.push((at(x, y), radius.into(), colour));
            }
            Shape::Text { text, place: (x, y), height, colour } => {
                let height = f64::from(*height);
                let Ok(word) = crate::sheet::plain_lettering(text, height) else { continue };
                let put = |s: &Vec<DVec2>| VectorLine {
                    points: s.iter().map(|p| at(*x, *y) + *p * DVec2::new(1.0, -1.0)).collect(),
                    colour: *colour,
                    width: (height / 8.0).max(1.0),
                    strength: 1.0,
                };
                lines.extend(word.strokes.iter().map(put));
            }
        }
    }
    (lines, dots)
}

/// A text as lines around its middle, with a pale rim.
fn letters(text: &str, middle: DVec2, height: f64) -> Vec<VectorLine> {
    let Ok(word) = crate::sheet::plain_lettering(text, height) else { return Vec::new() };
    let shift = middle - word.low.midpoint(word.high) * DVec2::new(1.0, -1.0);
    let line = |colour, width: f64| {
        let put = move |s: &Vec<DVec2>| VectorLine {
            points: s.iter().map(|p| shift + *p * DVec2::new(1.0, -1.0)).collect(),
            colour,
            width,
            strength: 1.0,
        };
        word.strokes.iter().map(put).collect::<Vec<_>>()
    };
    [line(paint::PAPER, height / 2.2), line(paint::LINE, height / 7.0)].concat()
}

impl VectorPicture {
    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        (self.width as u32, self.height as u32)
    }

    /// The picture as SVG; `command` is the command line that made it.
    pub fn to_svg(&self, command: &str) -> String {
        let Self { width, height, opacity, .. } = self;
        let mut svg = format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg \
            xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
            viewBox=\"0 0 {width} {height}\">\n<metadata>{}</metadata>\n<rect width=\"{width}\" \
            height=\"{height}\" fill=\"{}\"/>\n<g stroke-width=\"0.5\" \
            stroke-linejoin=\"round\">\n",
            plain(command),
            hex(paint::PAPER)
        );
        let seen = if *opacity < 1.0 { format!(" opacity=\"{opacity}\"") } else { String::new() };
        for (points, colour) in &self.areas {
            // Neighbours are painted a little over one another, so that no gap shines through.
            let (colour, path) = (hex(*colour), path(points));
            let rim = if *opacity < 1.0 { "none" } else { &colour };
            let _ = writeln!(svg, "<path d=\"{path}Z\" fill=\"{colour}\" stroke=\"{rim}\"{seen}/>");
        }
        svg += "</g>\n<g fill=\"none\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n";
        for line in &self.lines {
            let (width, strength) = (short(line.width), short(line.strength));
            let _ = writeln!(
                svg,
                "<path d=\"{}\" stroke=\"{}\" stroke-width=\"{width}\" opacity=\"{strength}\"/>",
                path(&line.points),
                hex(line.colour)
            );
        }
        svg += "</g>\n";
        for (at, radius, colour) in &self.dots {
            let [x, y, r] = [at.x, at.y, *radius].map(short);
            let _ = writeln!(
                svg,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{r}\" fill=\"{}\"/>",
                hex(*colour)
            );
        }
        svg + "</svg>\n"
    }

    /// The picture as PDF on one page, a pixel to a point; `command` is the command line that made
    /// it.
    pub fn to_pdf(&self, command: &str) -> Vec<u8> {
        let mut content = format!("1 0 0 -1 0 {} cm 1 J 1 j\n", short(self.height));
        let colour = |[r, g, b]: [u8; 3]| [r, g, b].map(|c| short(f64::from(c) / 255.0)).join(" ");
        let see = |share: f64| format!("/G{} gs", (20.0 * share).round().clamp(1.0, 20.0));
        let _ = writeln!(
            content,
            "{} rg 0 0 {} {} re f",
            colour(paint::PAPER),
            self.width,
            self.height
        );
        let _ = writeln!(content, "{} 0.5 w", see(self.opacity));
        for (points, look) in &self.areas {
            let (look, end) = (colour(*look), if self.opacity < 1.0 { "f" } else { "b" });
            let _ = writeln!(content, "{look} rg {look} RG {}{end}", steps(points));
        }
        for line in &self.lines {
            let (look, width) = (colour(line.colour), short(line.width));
            let see = see(line.strength);
            let _ = writeln!(content, "{see} {look} RG {width} w {}S", steps(&line.points));
        }
        content += "/G20 gs\n";
        for (at, radius, look) in &self.dots {
            // A point drawn with a round pen.
            let (look, width) = (colour(*look), short(2.0 * radius));
            let _ = writeln!(content, "{look} RG {width} w {}S", steps(&[*at, *at]));
        }
        pdf([self.width, self.height], &content, command)
    }
}

fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02X}{g:02X}{b:02X}")
}

/// Two decimals at most.
fn short(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn path(points: &[DVec2]) -> String {
    let at = |p: &DVec2| format!("{} {}", short(p.x), short(p.y));
    let list: Vec<String> = points.iter().map(at).collect();
    format!("M{}", list.join("L"))
}

/// The same as operators of PDF.
fn steps(points: &[DVec2]) -> String {
    let at = |(i, p): (usize, &DVec2)| {
        format!("{} {} {} ", short(p.x), short(p.y), if i == 0 { 'm' } else { 'l' })
    };
    points.iter().enumerate().map(at).collect()
}

/// Text that stands between tags.
fn plain(text: &str) -> String {
    let shown = text.replace(|c: char| c.is_control(), " ");
    shown.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A PDF of one page; strengths from 0.05 to 1 are `/G1` to `/G20`.
fn pdf([width, height]: [f64; 2], content: &str, command: &str) -> Vec<u8> {
    let states: String = (1..=20)
        .map(|i| {
            let share = short(f64::from(i) / 20.0);
            format!("/G{i} << /CA {share} /ca {share} >> ")
        })
        .collect();
    let units: String = command.encode_utf16().map(|unit| format!("{unit:04X}")).collect();
    let objects = [
        "<< /Type /Catalog /Pages 2 0 R >>".to_owned(),
        "<< /Type /Pages /Kids [4 0 R] /Count 1 >>".to_owned(),
        format!("<< /Title (picture) /Creator (kerfold) /Subject <FEFF{units}> >>"),
        format!(
            "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width} {height}] /Resources << \
            /ExtGState << {states}>> >> /Contents 5 0 R >>"
        ),
        format!("<< /Length {} >>\nstream\n{content}endstream", content.len()),
    ];
    let mut file = b"%PDF-1.4\n".to_vec();
    let mut table = format!("xref\n0 {}\n0000000000 65535 f \n", objects.len() + 1);
    for (i, object) in objects.iter().enumerate() {
        let _ = writeln!(table, "{:010} 00000 n ", file.len());
        file.extend(format!("{} 0 obj\n{object}\nendobj\n", i + 1).bytes());
    }
    let start = file.len();
    let count = objects.len() + 1;
    table += &format!(
        "trailer\n<< /Size {count} /Root 1 0 R /Info 3 0 R >>\nstartxref\n{start}\n%%EOF\n"
    );
    file.extend(table.bytes());
    file
}

#[cfg(test)]
mod tests {
    use super::super::model::tests::torus;
    use super::super::{Colour, Surface, render_model};
    use super::*;

    /// Paints the areas with pixels and compares them with the picture of pixels.
    #[test]
    fn painting_the_areas_in_order_hides_what_is_hidden() {
        let params = RenderParams {
            width: 200,
            colour: Colour::Valence,
            edges: super::super::EdgeLines::Off,
            ..RenderParams::default()
        };
        let ring = torus(16, 8);
        let vector = render_vector(&ring, &params, &Marks::default()).expect("a picture");
        let mut painted = tiny_skia::Pixmap::new(200, 150).expect("a size");
        let [r, g, b] = paint::PAPER;
        painted.fill(tiny_skia::Color::from_rgba8(r, g, b, 255));
        for (points, [r, g, b]) in &vector.areas {
            let mut path = tiny_skia::PathBuilder::new();
            path.move_to(points[0].x as f32, points[0].y as f32);
            points[1..].iter().for_each(|p| path.line_to(p.x as f32, p.y as f32));
            path.close();
            let mut look = tiny_skia::Paint::default();
            look.set_color_rgba8(*r, *g, *b, 255);
            if let Some(path) = path.finish() {
                let rule = tiny_skia::FillRule::Winding;
                painted.fill_path(&path, &look, rule, tiny_skia::Transform::identity(), None);
            }
        }
        // Too small for a legend, which stands beside the areas.
        let plain = RenderParams { colour: Colour::Faces, ..params };
        let vector = render_vector(&ring, &plain, &Marks::default()).expect("a picture");
        assert!(vector.areas.len() >= 2 * 16 * 8);
        let picture = render_model(&ring, &plain).expect("a picture");
        let is_ground = |p: [u8; 3]| p == paint::PAPER;
        let differ = (0..200 * 150)
            .filter(|&i| {
                let (x, y) = (i % 200, i / 200);
                let own = painted.pixel(x, y).expect("within");
                let own = [own.red(), own.green(), own.blue()];
                is_ground(own) != is_ground(picture.pixel(x, y).expect("within"))
            })
            .count();
        // Only along outlines.
        assert!(differ < 200 * 150 / 50, "{differ}");
    }

    #[test]
    fn legends_are_those_of_pixels() {
        let cube = crate::shape::cube(10.0);
        let drawn = |colour, width| {
            let params = RenderParams { width, colour, ..RenderParams::default() };
            render_vector(&cube, &params, &Marks::default()).expect("a picture")
        };
        let in_strip = |picture: &VectorPicture| {
            let left = picture.width - Legend::width(400, 300);
            let lines = picture.lines.iter().filter(|l| l.points[0].x > left).count();
            (lines, picture.dots.iter().filter(|d| d.0.x > left).count())
        };
        // A dot for the one valence that there is; letters, but no scale.
        let (lines, dots) = in_strip(&drawn(Colour::Valence, 400));
        assert!(dots == 1 && lines > 10, "{lines} {dots}");
        // A row of the scale for every pixel of its height, and its letters.
        let (lines, dots) = in_strip(&drawn(Colour::Planarity, 400));
        assert!(dots == 0 && lines > 132, "{lines} {dots}");
        // The model keeps clear of the strip, and small pictures have none.
        let all = drawn(Colour::Planarity, 400);
        let left = all.width - Legend::width(400, 300);
        assert!(all.areas.iter().flat_map(|a| &a.0).all(|p| p.x < left));
        assert!(drawn(Colour::Valence, 180).lines.len() < 20);
        assert!(drawn(Colour::Faces, 400).lines.len() < 20);
    }

    #[test]
    fn several_views_and_shadows_are_refused() {
        let cube = crate::shape::cube(10.0);
        let views = RenderParams {
            views: vec!["front".parse().expect("a view"); 2],
            ..RenderParams::default()
        };
        let shadow = RenderParams { shadow: Shadow::Soft, ..RenderParams::default() };
        for params in [views, shadow] {
            let refused = render_vector(&cube, &params, &Marks::default());
            assert_eq!(refused.err(), Some(PictureError::OnlyPixels));
        }
    }

    #[test]
    fn files_are_whole_and_large_models_refused() {
        let params = RenderParams { surface: Surface::XRay, ..RenderParams::default() };
        let cube = crate::shape::cube(10.0);
        let picture = render_vector(&cube, &params, &Marks::default()).expect("a picture");
        assert!(picture.to_svg("a <b>").contains("a &lt;b&gt;"));
        assert!(picture.to_pdf("kerfold").ends_with(b"%%EOF\n"));
        let fine = torus(120, 60);
        let refused = render_vector(&fine, &params, &Marks::default());
        assert!(matches!(refused, Err(PictureError::TooManyFaces { .. })));
    }
}
