//! A picture of a model from one side or from several.

use tiny_skia::{PixmapPaint, Transform};

use super::lettering::write;
use super::marks::Marks;
use super::model::render_one;
use super::strip::letter_height;
use super::{Picture, PictureError, RenderParams, View, paint};
use crate::mesh::Mesh;

/// As [`super::render_model`], with elements pointed out in red, and with several views where the
/// parameters name them.
///
/// # Errors
/// As [`super::render_model`].
pub fn render_with(
    mesh: &Mesh,
    params: &RenderParams,
    marks: &Marks,
) -> Result<Picture, PictureError> {
    if params.views.is_empty() {
        render_one(mesh, params, marks)
    } else {
        render_views(mesh, params, marks)
    }
}

/// Draws a model from several sides, in rows that are nearly as many as columns, each with the name
/// of its view; `params.width` and `params.height` are those of the whole.
fn render_views(
    mesh: &Mesh,
    params: &RenderParams,
    marks: &Marks,
) -> Result<Picture, PictureError> {
    let count = params.views.len() as u32;
    let columns = (1..=count).find(|c| c * c >= count).unwrap_or(1);
    let rows = count.div_ceil(columns);
    let (_, whole_height) = params.pixels();
    let (width, height) = (params.width / columns, whole_height / rows);
    let mut whole = super::blank(width * columns, height * rows)?;
    let [r, g, b] = paint::PAPER;
    whole.fill(tiny_skia::Color::from_rgba8(r, g, b, 255));
    for (i, &view) in (0..).zip(&params.views) {
        let params =
            RenderParams { width, height: Some(height), view, views: Vec::new(), ..params.clone() };
        let mut picture = render_one(mesh, &params, marks)?.pixmap;
        let letter = letter_height(height);
        let name = view_name(view);
        write(&mut picture, &name, (letter, 2.0 * letter), letter, paint::LINE);
        let at = |n: u32| i32::try_from(n).unwrap_or(i32::MAX);
        whole.draw_pixmap(
            at(i % columns * width),
            at(i / columns * height),
            picture.as_ref(),
            &PixmapPaint::default(),
            Transform::identity(),
            None,
        );
    }
    Ok(Picture { pixmap: whole })
}

fn view_name(view: View) -> String {
    view.to_string().to_uppercase()
}
