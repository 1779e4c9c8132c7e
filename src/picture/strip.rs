//! Several states of a model in one picture, side by side and row by row, all seen by one camera.

use tiny_skia::{Pixmap, PixmapPaint, Transform};

use super::band::BAND_ROWS;
use super::camera::Camera;
use super::frame::window;
use super::lettering::write;
use super::marks::Marks;
use super::model::{colours, draw};
use super::scene::Scene;
use super::{Picture, PictureError, RenderParams, paint};
use crate::mesh::Mesh;

/// One state.
#[derive(Debug, Clone)]
pub struct Cell {
    /// The model as it is then.
    pub mesh: Mesh,
    /// What stands in the upper left corner, in characters that [`crate::sheet::glyph`] has.
    pub label: String,
}

/// Draws the cells in rows of `columns`, `params.width` pixels wide in all. `params.height` is that
/// of one cell; without it, three quarters of its width. All cells are drawn to the same scale.
///
/// # Errors
/// As [`super::render_model`], for the size of a cell and of the whole.
pub fn render_strip(
    cells: &[Cell],
    columns: u32,
    params: &RenderParams,
) -> Result<Picture, PictureError> {
    let columns = columns.max(1);
    let cell = RenderParams { width: params.width / columns, ..params.clone() };
    let (width, height) = cell.pixels();
    let rows = (cells.len() as u32).div_ceil(columns).max(1);
    let mut whole = super::blank(width.saturating_mul(columns), height.saturating_mul(rows))?;
    let [r, g, b] = paint::PAPER;
    whole.fill(tiny_skia::Color::from_rgba8(r, g, b, 255));
    let meshes: Vec<&Mesh> = cells.iter().map(|c| &c.mesh).collect();
    super::blank(width, height)?;
    let camera = Camera::fitted(&meshes, &cell, window(width, height, false))?;
    for (i, state) in (0..).zip(cells) {
        let picture = draw_cell(state, &cell, &camera)?;
        let place = ((i % columns) * width, (i / columns) * height);
        let at = |x: u32| i32::try_from(x).unwrap_or(i32::MAX);
        whole.draw_pixmap(
            at(place.0),
            at(place.1),
            picture.as_ref(),
            &PixmapPaint::default(),
            Transform::identity(),
            None,
        );
    }
    Ok(Picture { pixmap: whole })
}

fn draw_cell(cell: &Cell, params: &RenderParams, camera: &Camera) -> Result<Pixmap, PictureError> {
    let (width, height) = params.pixels();
    let mut pixmap = super::blank(width, height)?;
    if cell.mesh.face_count() == 0 {
        return Err(PictureError::NoFaces);
    }
    let (_, colours) = colours(&cell.mesh, params.colour);
    let scene = Scene::new(&cell.mesh, params, camera, (&colours, &Marks::default()));
    draw(&mut pixmap, &cell.mesh, &scene, BAND_ROWS);
    let letter = letter_height(height);
    write(&mut pixmap, &cell.label, (letter, 2.0 * letter), letter, paint::LINE);
    Ok(pixmap)
}

pub(super) fn letter_height(height: u32) -> f32 {
    (height as f32 / 20.0).max(7.0)
}

#[cfg(test)]
mod tests {
    use super::super::model::tests::cuboid;
    use super::*;
    use glam::DVec3;

    #[test]
    fn cells_stand_in_rows_to_one_scale() {
        let cell = |size: f64| Cell {
            mesh: cuboid(DVec3::ZERO, DVec3::splat(size)),
            label: "1".to_owned(),
        };
        let params = RenderParams { width: 300, ..RenderParams::default() };
        let picture = render_strip(&[cell(1.0), cell(4.0), cell(2.0), cell(4.0)], 3, &params)
            .expect("a picture");
        assert_eq!((picture.width(), picture.height()), (300, 150));
        let covered = |column: u32, row: u32| {
            let inner = (column * 100 + 20..(column + 1) * 100)
                .flat_map(|x| (row * 75..(row + 1) * 75).map(move |y| (x, y)));
            inner.filter(|&(x, y)| picture.pixel(x, y) != Some(paint::PAPER)).count()
        };
        let [small, large, middle, again, nothing] =
            [covered(0, 0), covered(1, 0), covered(2, 0), covered(0, 1), covered(1, 1)];
        assert!(
            small * 8 < large && small < middle && middle * 2 < large,
            "{small} {middle} {large}"
        );
        assert_eq!((again, nothing), (large, 0));
        assert!(matches!(render_strip(&[], 3, &params), Err(PictureError::NoFaces)));
        let narrow = RenderParams { width: 30, ..RenderParams::default() };
        assert!(matches!(
            render_strip(&[cell(1.0)], 3, &narrow),
            Err(PictureError::SizeOutOfRange { .. })
        ));
    }
}
