//! The picture of a model.

use glam::DVec2;
use rayon::prelude::*;
use tiny_skia::Pixmap;

use super::band::{BAND_ROWS, Band, Coverage};
use super::camera::Camera;
use super::frame::window;
use super::legend::Legend;
use super::lettering::write_clear;
use super::marks::{Marks, Tag};
use super::paint;
use super::pieces::piece_of_faces;
use super::scene::{Dot, Scene};
use super::through::aimed;
use super::{Colour, Picture, PictureError, RenderParams};
use crate::measure::planarity;
use crate::mesh::{FaceId, FaceMap, Mesh};

/// Deviations below this part of the model's diagonal look planar in every picture: they may be no
/// more than rounding.
const PLANAR: f64 = 1e-6;

/// Draws a model: shaded faces, edges, hidden parts hidden.
///
/// The background is nearly white. Outlines are thicker than folds; edges between coplanar faces
/// are light, and where edges are only a few pixels apart they fade, so that fine meshes stay
/// readable. Rims are orange. What is seen from behind is blue-grey with [`Colour::Faces`]. The
/// planarity of a face is the largest distance of its corners from their least-squares plane, in
/// the model's unit, taken as mm. Pictures with a side below 160 pixels have no legend.
///
/// # Errors
/// [`PictureError::SizeOutOfRange`], [`PictureError::NoDirection`], [`PictureError::NoFaces`] and
/// [`PictureError::VertexTooFar`].
///
/// # Example
/// ```
/// use kerfold::picture::{RenderParams, render_model};
///
/// let picture = render_model(&kerfold::shape::cube(40.0), &RenderParams::default())?;
/// assert!(picture.width() > 0);
/// # Ok::<(), kerfold::picture::PictureError>(())
/// ```
pub fn render_model(mesh: &Mesh, params: &RenderParams) -> Result<Picture, PictureError> {
    render_one(mesh, params, &Marks::default())
}

/// A picture from one side, with elements pointed out in red.
pub(super) fn render_one(
    mesh: &Mesh,
    params: &RenderParams,
    marks: &Marks,
) -> Result<Picture, PictureError> {
    let (legend, mut colours) = colours(mesh, params.colour);
    marks.paint(&mut colours);
    draw_model(mesh, params, legend, (&colours, marks))
}

/// Draws a model with each face coloured by how much of its limit it uses: 1 is the limit, from 2
/// on the colour stays. The legend is in per cent. `params.colour` does not count.
///
/// # Errors
/// As [`render_model`].
pub fn render_shares(
    mesh: &Mesh,
    params: &RenderParams,
    shares: &FaceMap<f64>,
) -> Result<Picture, PictureError> {
    let mut colours = FaceMap::filled(mesh.face_slots(), paint::FRONT);
    for f in mesh.faces() {
        colours[f] = paint::scale_colour(shares[f] / 2.0);
    }
    draw_model(
        mesh,
        &RenderParams { colour: Colour::Planarity, ..params.clone() },
        Some(Legend::limit()),
        (&colours, &Marks::default()),
    )
}

/// Draws a pale model with one face in red, without a legend. `params.colour` does not count.
///
/// # Errors
/// As [`render_model`].
pub fn render_marked(
    mesh: &Mesh,
    params: &RenderParams,
    marked: FaceId,
) -> Result<Picture, PictureError> {
    let mut colours = FaceMap::filled(mesh.face_slots(), paint::PALE);
    colours[marked] = paint::scale_colour(0.8);
    let params = RenderParams { colour: Colour::Planarity, ..params.clone() };
    draw_model(mesh, &params, None, (&colours, &Marks::default()))
}

fn draw_model(
    mesh: &Mesh,
    params: &RenderParams,
    legend: Option<Legend>,
    look: (&FaceMap<[u8; 3]>, &Marks),
) -> Result<Picture, PictureError> {
    let params = &aimed(mesh, params)?;
    let (width, height) = params.pixels();
    let mut pixmap = super::blank(width, height)?;
    if mesh.face_count() == 0 {
        return Err(PictureError::NoFaces);
    }
    let legend = legend.filter(|_| Legend::has_room(width, height));
    let camera = Camera::fitted(&[mesh], params, window(width, height, legend.is_some()))?;
    let scene = Scene::new(mesh, params, &camera, look);
    draw(&mut pixmap, mesh, &scene, BAND_ROWS);
    if let Some(legend) = legend {
        legend.draw(&mut pixmap);
    }
    Ok(Picture { pixmap })
}

/// The legend and the colour of each face.
pub(super) fn colours(mesh: &Mesh, colour: Colour) -> (Option<Legend>, FaceMap<[u8; 3]>) {
    let mut colours = FaceMap::filled(mesh.face_slots(), paint::FRONT);
    match colour {
        Colour::Faces => (None, colours),
        Colour::Planarity => {
            let deviations: Vec<(FaceId, f64)> =
                mesh.faces().map(|f| (f, planarity(mesh, f).mm)).collect();
            let diagonal = crate::measure::size(mesh).length();
            let top = deviations.iter().map(|&(_, d)| d).fold(PLANAR * diagonal, f64::max);
            for (f, deviation) in deviations {
                colours[f] = paint::scale_colour(if top > 0.0 { deviation / top } else { 0.0 });
            }
            (Some(Legend::planarity(top)), colours)
        }
        Colour::Valence => {
            for f in mesh.faces() {
                colours[f] = paint::PALE;
            }
            (Some(Legend::valence(mesh)), colours)
        }
        Colour::Group => {
            let numbers: std::collections::HashMap<&str, usize> =
                mesh.groups().iter().enumerate().map(|(i, name)| (name.as_str(), i)).collect();
            for f in mesh.faces() {
                if let Some(&number) = mesh.group(f).and_then(|name| numbers.get(name)) {
                    colours[f] = paint::GROUPS[number % paint::GROUPS.len()];
                }
            }
            (None, colours)
        }
        Colour::Piece => {
            let pieces = piece_of_faces(mesh);
            for f in mesh.faces() {
                colours[f] = paint::GROUPS[pieces[f] % paint::GROUPS.len()];
            }
            (None, colours)
        }
    }
}

/// Draws bands of so many rows of pixels, each by one of the threads: its pixels depend on nothing
/// but the scene.
pub(super) fn draw(pixmap: &mut Pixmap, mesh: &Mesh, scene: &Scene, rows: usize) {
    let (width, height) = (pixmap.width() as usize, pixmap.height() as usize);
    let draw = |(i, pixels): (usize, &mut [u8])| {
        let rows = i * rows..((i + 1) * rows).min(height);
        draw_band(pixels, mesh, scene, width, rows)
    };
    let bands = pixmap.data_mut().par_chunks_mut(width * 4 * rows).enumerate();
    let (dots, tags): (Vec<Vec<&Dot>>, Vec<Vec<&Tag>>) = bands.map(draw).unzip();
    let (mut dots, mut tags) = (dots.concat(), tags.concat());
    // Dots can overlap, so their order must not depend on who finished first.
    dots.sort_by_key(|dot| dot.vertex);
    for dot in dots {
        draw_dot(pixmap, dot, scene.dot_radius);
    }
    // Where numbers would lie on one another, the nearer one stays.
    tags.sort_by(|a, b| b.place.z.total_cmp(&a.place.z).then_with(|| a.text.cmp(&b.text)));
    draw_tags(pixmap, &tags);
}

/// Writes numbers with their middles at their places.
fn draw_tags(pixmap: &mut Pixmap, tags: &[&Tag]) {
    let height = (pixmap.width().max(pixmap.height()) as f32 / 90.0).max(7.0);
    let mut taken: Vec<(DVec2, DVec2)> = Vec::new();
    for tag in tags {
        let size = DVec2::new(tag.text.len() as f64 * 0.93, 1.0) * f64::from(height);
        let low = tag.place.truncate() - size / 2.0;
        let high = low + size;
        if taken.iter().any(|(l, h)| l.cmplt(high).all() && low.cmplt(*h).all()) {
            continue;
        }
        taken.push((low, high));
        write_clear(pixmap, &tag.text, (low.x as f32, high.y as f32), height, paint::LINE);
    }
}

fn draw_band<'a>(
    pixels: &mut [u8],
    mesh: &Mesh,
    scene: &'a Scene,
    width: usize,
    rows: std::ops::Range<usize>,
) -> (Vec<&'a Dot>, Vec<&'a Tag>) {
    let band = Band::new(scene, width, rows.clone());
    let mut coverage = Coverage::new(width, rows.clone());
    band.draw_lines(&mut coverage);
    let paper = paint::ink(paint::PAPER);
    let places = rows.flat_map(|y| (0..width).map(move |x| (x, y)));
    for (pixel, (x, y)) in pixels.chunks_exact_mut(4).zip(places) {
        let [r, g, b] = paint::shown(coverage.over(x, y, band.light(x, y, paper)));
        pixel.copy_from_slice(&[r, g, b, 255]);
    }
    (band.visible_dots(mesh), band.visible_tags(mesh))
}

/// A disc with a thin pale ring, so that dots stand off from lines.
fn draw_dot(pixmap: &mut Pixmap, dot: &Dot, radius: f64) {
    let (width, height) = (pixmap.width() as usize, pixmap.height() as usize);
    let ring = radius * 1.25 + 0.5;
    let range = |middle: f64, end: usize| {
        let [low, high] =
            [middle - ring - 1.0, middle + ring + 1.0].map(|x| x.clamp(0.0, end as f64) as usize);
        low..high
    };
    for (y, x) in
        range(dot.place.y, height).flat_map(|y| range(dot.place.x, width).map(move |x| (y, x)))
    {
        let distance = DVec2::new(x as f64 + 0.5, y as f64 + 0.5).distance(dot.place.truncate());
        let pixel = &mut pixmap.data_mut()[(y * width + x) * 4..][..3];
        let mut light = paint::ink([pixel[0], pixel[1], pixel[2]]);
        for (reach, colour) in [(ring, paint::PAPER), (radius, dot.colour)] {
            light = light.lerp(paint::ink(colour), (reach + 0.5 - distance).clamp(0.0, 1.0) as f32);
        }
        pixel.copy_from_slice(&paint::shown(light));
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::picture::paint::{Modelling, lit, shown};
    use crate::picture::{EdgeLines, Projection, UpAxis, View};
    use glam::DVec3;
    use proptest::prelude::*;

    const BOX: [[usize; 4]; 6] =
        [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

    fn box_corner(low: DVec3, high: DVec3, i: usize) -> DVec3 {
        DVec3::new([low.x, high.x][i & 1], [low.y, high.y][i >> 1 & 1], [low.z, high.z][i >> 2])
    }

    /// A box between two corners.
    pub fn cuboid(low: DVec3, high: DVec3) -> Mesh {
        Mesh::from_faces((0..8).map(|i| box_corner(low, high, i)), BOX).expect("a box")
    }

    pub fn torus(n: usize, m: usize) -> Mesh {
        let angle = |i: usize, n: usize| i as f64 / n as f64 * std::f64::consts::TAU;
        let point = |i, j| {
            let (a, b) = (angle(i, n), angle(j, m));
            DVec3::new((3.0 + b.cos()) * a.cos(), (3.0 + b.cos()) * a.sin(), b.sin())
        };
        let points = (0..n * m).map(|k| point(k / m, k % m));
        let face = |i: usize, j: usize| {
            let (k, l) = ((i + 1) % n, (j + 1) % m);
            [i * m + j, k * m + j, k * m + l, i * m + l]
        };
        Mesh::from_faces(points, (0..n * m).map(|k| face(k / m, k % m))).expect("a torus")
    }

    fn small() -> RenderParams {
        RenderParams { width: 240, height: Some(180), ..RenderParams::default() }
    }

    fn seen_from(view: View) -> RenderParams {
        RenderParams { view, projection: Projection::Parallel, ..small() }
    }

    fn render(mesh: &Mesh, params: &RenderParams) -> Picture {
        render_model(mesh, params).expect("a picture")
    }

    fn pixels(picture: &Picture) -> impl Iterator<Item = [u8; 3]> + '_ {
        let places = (0..picture.height()).flat_map(|y| (0..picture.width()).map(move |x| (x, y)));
        places.map(|(x, y)| picture.pixel(x, y).expect("within the picture"))
    }

    fn shows(picture: &Picture, colour: [u8; 3]) -> bool {
        pixels(picture).any(|pixel| pixel == colour)
    }

    fn facing(colour: [u8; 3], modelling: Modelling) -> [u8; 3] {
        shown(lit(colour, DVec3::Z, modelling))
    }

    #[test]
    fn a_box_from_the_front_is_one_face_in_a_frame() {
        let picture = render(&cuboid(DVec3::ZERO, DVec3::ONE), &seen_from(View::Front));
        assert_eq!((picture.width(), picture.height()), (240, 180));
        for (x, y) in [(0, 0), (239, 0), (0, 179), (239, 179)] {
            assert_eq!(picture.pixel(x, y), Some(paint::PAPER));
        }
        assert_eq!((picture.pixel(240, 0), picture.pixel(0, 180)), (None, None));
        // The box is 180 − 2 · 10.8 pixels high; nothing of its hidden edges is seen, not even at
        // the border of a band.
        let face = facing(paint::FRONT, Modelling::Full);
        for (x, y) in (45..195).flat_map(|x| (15..165).map(move |y| (x, y))) {
            assert_eq!(picture.pixel(x, y), Some(face), "{x} {y}");
        }
        let dark = |x, y| picture.pixel(x, y).expect("within")[0] < 120;
        assert!((9..13).any(|y| dark(120, y)) && (167..171).any(|y| dark(120, y)));
    }

    #[test]
    fn the_notch_of_a_concave_face_and_the_hole_of_a_torus_show_the_background() {
        let ell = [(0., 0.), (3., 0.), (3., 1.), (1., 1.), (1., 3.), (0., 3.)];
        let at = |z: f64| ell.iter().map(move |&(x, y)| DVec3::new(x, y, z));
        let sides = (0..6).map(|i| vec![i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6]);
        let faces = sides.chain([(0..6).rev().collect(), (6..12).collect()]);
        let prism = Mesh::from_faces(at(0.0).chain(at(1.0)), faces).expect("a prism");
        let picture = render(&prism, &seen_from(View::Top));
        let face = facing(paint::FRONT, Modelling::Full);
        assert_eq!(picture.pixel(150, 60), Some(paint::PAPER));
        assert_eq!((picture.pixel(60, 60), picture.pixel(150, 150)), (Some(face), Some(face)));

        let ring = torus(24, 12);
        let picture = render(&ring, &seen_from(View::Top));
        assert_eq!(picture.pixel(120, 90), Some(paint::PAPER));
        assert_ne!(picture.pixel(120, 30), Some(paint::PAPER));
        let side = render(&ring, &seen_from(View::Front));
        assert_ne!(side.pixel(120, 90), Some(paint::PAPER));
    }

    #[test]
    fn what_is_behind_is_hidden() {
        let (near, far) = (DVec3::ZERO, DVec3::new(1.0, 3.0, 1.0));
        let points = (0..8).map(|i| box_corner(near, near + 4.0, i)).chain(
            (0..8).map(|i| box_corner(far + DVec3::Y * 4.0, far + DVec3::new(1.0, 5.0, 1.0), i)),
        );
        let faces = BOX.into_iter().chain(BOX.map(|face| face.map(|v| v + 8)));
        let mut mesh = Mesh::from_faces(points, faces).expect("two boxes");
        for f in mesh.faces().collect::<Vec<_>>() {
            mesh.set_group(f, if f.index() < 6 { "near" } else { "far" });
        }
        let colour = |group: usize| facing(paint::GROUPS[group], Modelling::Soft);
        let picture =
            |view| render(&mesh, &RenderParams { colour: Colour::Group, ..seen_from(view) });
        let front = picture(View::Front);
        assert!(shows(&front, colour(0)) && !shows(&front, colour(1)));
        let back = picture(View::Back);
        assert!(shows(&back, colour(0)) && shows(&back, colour(1)));
    }

    #[test]
    fn an_open_box_shows_its_inside_and_its_rim() {
        let points = (0..8).map(|i| box_corner(DVec3::ZERO, DVec3::ONE, i));
        let open = Mesh::from_faces(points, BOX.into_iter().filter(|&face| face != BOX[1]))
            .expect("a box");
        let picture = render(&open, &seen_from(View::Top));
        assert_eq!(picture.pixel(120, 90), Some(facing(paint::BACK, Modelling::Full)));
        assert!(pixels(&picture).any(|[r, _, b]| r > 150 && b < 100));
        let bare = render(&open, &RenderParams { edges: EdgeLines::Off, ..seen_from(View::Top) });
        assert!(!pixels(&bare).any(|[r, _, b]| r > 150 && b < 100));
    }

    #[test]
    fn the_same_model_gives_the_same_bytes_however_the_work_is_divided() {
        let (ring, params) = (torus(20, 9), RenderParams { colour: Colour::Valence, ..small() });
        let picture = render(&ring, &params);
        assert_eq!(picture.to_png(), render(&ring, &params).to_png());
        let camera = Camera::fitted(&[&ring], &params, window(240, 180, true)).expect("a camera");
        let (legend, colours) = colours(&ring, params.colour);
        let marks = Marks::default();
        let scene = Scene::new(&ring, &params, &camera, (&colours, &marks));
        for (workers, rows) in [(1, 64), (3, 17), (7, 1), (2, 500)] {
            let mut pixmap = crate::picture::blank(240, 180).expect("a size");
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(workers).build().expect("a pool");
            pool.install(|| draw(&mut pixmap, &ring, &scene, rows));
            legend.as_ref().expect("a legend").draw(&mut pixmap);
            assert!(pixmap == picture.pixmap, "{workers} threads, {rows} rows");
        }
    }

    #[test]
    fn size_does_not_matter() {
        let ring = torus(12, 6);
        let picture = render(&ring, &small());
        for scale in [2f64.powi(-40), 2f64.powi(40)] {
            let mut scaled = ring.clone();
            for v in ring.vertices() {
                scaled.set_position(v, ring.position(v) * scale, true);
            }
            assert!(render(&scaled, &small()) == picture, "{scale}");
        }
    }

    #[test]
    fn planarity_is_seen() {
        let mut mesh = cuboid(DVec3::ZERO, DVec3::ONE);
        let params = RenderParams {
            colour: Colour::Planarity,
            edges: EdgeLines::Off,
            ..seen_from(View::Front)
        };
        let centre = |mesh: &Mesh| render(mesh, &params).pixel(90, 100).expect("within");
        let [r, _, b] = centre(&mesh);
        assert!(b > r, "planar is blue");
        let corner = mesh.vertices().next().expect("a corner");
        mesh.set_position(corner, DVec3::new(-0.2, -0.2, -0.2), true);
        let [r, _, b] = centre(&mesh);
        assert!(r > b, "bent is red");
    }

    #[test]
    fn valences_are_seen_and_dots_in_hiding_are_not() {
        let params = RenderParams { colour: Colour::Valence, ..seen_from(View::Front) };
        let picture = render(&cuboid(DVec3::ZERO, DVec3::ONE), &params);
        let green = paint::valence_colour(3);
        let legend = (Legend::width(240, 180)) as u32;
        let places = (0..180).flat_map(|y| (0..240 - legend).map(move |x| (x, y)));
        let marked: Vec<_> = places.filter(|&(x, y)| picture.pixel(x, y) == Some(green)).collect();
        assert!(marked.len() > 4);
        let (left, right) = (marked.iter().map(|p| p.0).min(), marked.iter().map(|p| p.0).max());
        // All dots are at the corners of the square: none in its middle.
        let [left, right] = [left, right].map(|x| x.expect("dots"));
        assert!(marked.iter().all(|&(x, _)| x < left + 8 || x + 8 > right));
    }

    #[test]
    fn fine_meshes_do_not_turn_black() {
        let brightness = |mesh: &Mesh| {
            let picture = render(mesh, &RenderParams { edges: EdgeLines::On, ..small() });
            pixels(&picture).map(|p| f64::from(p[1])).sum::<f64>() / (240.0 * 180.0)
        };
        let (coarse, fine) = (brightness(&torus(16, 8)), brightness(&torus(300, 150)));
        assert!(fine > coarse - 10.0, "{coarse} {fine}");
    }

    #[test]
    fn the_outline_of_a_fine_mesh_has_no_gaps() {
        let picture = render(&torus(400, 200), &seen_from(View::Top));
        for y in 20..160 {
            let row =
                (0..240).filter_map(|x| picture.pixel(x, y)).skip_while(|&p| p == paint::PAPER);
            let darkest = row.take(4).map(|p| p[1]).min();
            assert!(darkest.is_some_and(|g| g < 150), "row {y}: {darkest:?}");
        }
    }

    #[test]
    fn what_cannot_be_drawn_is_told() {
        let mesh = cuboid(DVec3::ZERO, DVec3::ONE);
        let error = |params: RenderParams| render_model(&mesh, &params).expect_err("a fault");
        let wide = error(RenderParams { width: 15, ..small() });
        assert_eq!(wide, PictureError::SizeOutOfRange { side: "wide", pixels: 15 });
        let high = error(RenderParams { height: Some(8193), ..small() });
        assert_eq!(high.to_string(), "a picture cannot be 8193 pixels high; choose 16 to 8192");
        assert!(matches!(
            error(RenderParams { width: u32::MAX, height: None, ..small() }),
            PictureError::SizeOutOfRange { .. }
        ));
        let view = View::From(DVec3::new(f64::NAN, 0.0, 1.0));
        assert!(matches!(
            error(RenderParams { view, ..small() }),
            PictureError::NoDirection { .. }
        ));
        assert_eq!(render_model(&Mesh::new(), &small()), Err(PictureError::NoFaces));
        let mut far = mesh.clone();
        let v = far.vertices().nth(3).expect("a corner");
        for place in
            [DVec3::splat(f64::NAN), DVec3::new(0.0, f64::INFINITY, 0.0), DVec3::splat(f64::MAX)]
        {
            far.set_position(v, place, false);
            let fault = render_model(&far, &small()).expect_err("too far");
            assert!(matches!(fault, PictureError::VertexTooFar { vertex, .. } if vertex == v));
        }
    }

    #[test]
    fn degenerate_models_are_drawn_without_fuss() {
        let flat = cuboid(DVec3::ZERO, DVec3::new(1.0, 1.0, 1e-12));
        let mut point = cuboid(DVec3::ZERO, DVec3::ONE);
        for v in point.vertices().collect::<Vec<_>>() {
            point.set_position(v, DVec3::ONE, true);
        }
        for mesh in [&flat, &point] {
            for view in [View::Front, View::Top, View::ThreeQuarter] {
                for colour in [Colour::Faces, Colour::Planarity, Colour::Valence] {
                    let picture = render(mesh, &RenderParams { colour, ..seen_from(view) });
                    assert_eq!(picture.pixel(0, 0), Some(paint::PAPER));
                }
            }
        }
        let tiny =
            RenderParams { width: 16, height: Some(16), colour: Colour::Planarity, ..small() };
        assert!(shows(&render(&flat, &tiny), paint::PAPER));
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(48))]

        /// The inside of a closed box is never seen, from wherever one looks.
        #[test]
        fn a_closed_box_hides_its_inside(x in -1.0..1.0, y in -1.0..1.0, z in -1.0..1.0, up_is_y: bool, parallel: bool) {
            let params = RenderParams {
                width: 64,
                height: Some(64),
                view: View::From(DVec3::new(x, y, z)),
                up: if up_is_y { UpAxis::Y } else { UpAxis::Z },
                projection: if parallel { Projection::Parallel } else { Projection::Perspective },
                ..RenderParams::default()
            };
            let picture = render(&cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 3.0)), &params);
            prop_assert!(pixels(&picture).all(|[r, _, b]| r >= b));
        }
    }
}
