//! A story: several pictures side by side, each with a word of what it shows.

use tiny_skia::{Pixmap, PixmapPaint, Transform};

use super::band::BAND_ROWS;
use super::camera::Camera;
use super::frame::window;
use super::lettering::write_clear;
use super::marks::Marks;
use super::model::{colours, draw};
use super::scene::Scene;
use super::strip::letter_height;
use super::through::aimed;
use super::{Picture, PictureError, RenderParams, View, paint};
use crate::mesh::Mesh;

/// One picture of a story.
#[derive(Debug, Clone)]
pub struct Frame {
    /// What is shown.
    pub mesh: Mesh,
    /// What is pointed out on it.
    pub marks: Marks,
    /// How it looks; width, height and several views do not count.
    pub look: RenderParams,
    /// Whether it is seen by a camera of its own; the others have one in common, so that they can
    /// be compared.
    pub is_apart: bool,
    /// What stands in the upper left corner, in characters that [`crate::sheet::glyph`] has.
    pub label: String,
}

/// The number of columns for so many frames: up to three side by side, four in a square.
fn columns(frames: usize) -> u32 {
    match frames {
        0..=3 => frames as u32,
        4 => 2,
        _ => 3,
    }
}

/// Draws the frames in rows as wide as two pictures of `params.width`, each three quarters as high
/// as wide. Frames with a common camera are seen as `params` say, and where these look through a hole,
/// through one of the last of them. There are no legends.
///
/// # Errors
/// As [`super::render_model`], for the size of a frame and of the whole.
pub fn render_story(frames: &[Frame], params: &RenderParams) -> Result<Picture, PictureError> {
    if frames.is_empty() {
        return Err(PictureError::NoFaces);
    }
    let columns = columns(frames.len());
    let cell = RenderParams {
        width: params.width.saturating_mul(2) / columns,
        height: None,
        views: Vec::new(),
        ..params.clone()
    };
    let (width, height) = cell.pixels();
    let rows = (frames.len() as u32).div_ceil(columns);
    let mut whole = super::blank(width.saturating_mul(columns), height.saturating_mul(rows))?;
    super::blank(width, height)?;
    let [r, g, b] = paint::PAPER;
    whole.fill(tiny_skia::Color::from_rgba8(r, g, b, 255));
    let common = Common::of(frames, &cell)?;
    for (i, frame) in (0..).zip(frames) {
        let picture = draw_frame(frame, &cell, common.as_ref())?;
        let at = |x: u32| i32::try_from(x).unwrap_or(i32::MAX);
        whole.draw_pixmap(
            at((i % columns) * width),
            at((i / columns) * height),
            picture.as_ref(),
            &PixmapPaint::default(),
            Transform::identity(),
            None,
        );
    }
    Ok(Picture { pixmap: whole })
}

/// The camera of all frames that have one in common, with its view.
struct Common {
    camera: Camera,
    view: View,
}

impl Common {
    fn of(frames: &[Frame], cell: &RenderParams) -> Result<Option<Self>, PictureError> {
        let shared: Vec<&Mesh> = frames.iter().filter(|f| !f.is_apart).map(|f| &f.mesh).collect();
        let Some(last) = shared.last() else { return Ok(None) };
        let seen = aimed(last, cell)?;
        let (width, height) = cell.pixels();
        let camera = Camera::fitted(&shared, &seen, window(width, height, false))?;
        Ok(Some(Self { camera, view: seen.view }))
    }
}

fn draw_frame(
    frame: &Frame,
    cell: &RenderParams,
    common: Option<&Common>,
) -> Result<Pixmap, PictureError> {
    let (width, height) = cell.pixels();
    let mut pixmap = super::blank(width, height)?;
    if frame.mesh.face_count() == 0 {
        return Err(PictureError::NoFaces);
    }
    let look = RenderParams { width, height: None, views: Vec::new(), ..frame.look.clone() };
    let (look, camera) = match common.filter(|_| !frame.is_apart) {
        Some(common) => (RenderParams { view: common.view, ..look }, common.camera),
        None => {
            let look = aimed(&frame.mesh, &look)?;
            let camera = Camera::fitted(&[&frame.mesh], &look, window(width, height, false))?;
            (look, camera)
        }
    };
    let (_, mut colours) = colours(&frame.mesh, look.colour);
    frame.marks.paint(&mut colours);
    let scene = Scene::new(&frame.mesh, &look, &camera, (&colours, &frame.marks));
    draw(&mut pixmap, &frame.mesh, &scene, BAND_ROWS);
    let letter = letter_height(height) * 0.8;
    write_clear(&mut pixmap, &frame.label, (letter, 2.0 * letter), letter, paint::LINE);
    Ok(pixmap)
}

#[cfg(test)]
mod tests {
    use super::super::model::tests::cuboid;
    use super::*;
    use glam::DVec3;

    fn frame(size: f64, is_apart: bool) -> Frame {
        Frame {
            mesh: cuboid(DVec3::ZERO, DVec3::splat(size)),
            marks: Marks::default(),
            look: RenderParams::default(),
            is_apart,
            label: "A".to_owned(),
        }
    }

    #[test]
    fn frames_with_a_common_camera_are_to_scale_and_others_fill_theirs() {
        let params = RenderParams { width: 180, ..RenderParams::default() };
        let frames = [frame(1.0, false), frame(3.0, false), frame(1.0, true)];
        let picture = render_story(&frames, &params).expect("a picture");
        assert_eq!((picture.width(), picture.height()), (360, 90));
        let covered = |column: u32| {
            let inner =
                (column * 120 + 24..(column + 1) * 120).flat_map(|x| (0..90).map(move |y| (x, y)));
            inner.filter(|&(x, y)| picture.pixel(x, y) != Some(paint::PAPER)).count()
        };
        let [small, large, apart] = [0, 1, 2].map(covered);
        assert!(small * 5 < large && small * 5 < apart, "{small} {large} {apart}");
        assert!(matches!(render_story(&[], &params), Err(PictureError::NoFaces)));
    }

    #[test]
    fn four_frames_stand_in_a_square_and_more_in_rows_of_three() {
        assert_eq!([1, 2, 3, 4, 5, 6].map(columns), [1, 2, 3, 2, 3, 3]);
    }
}
