//! From where a hole of a model can be looked through.
//!
//! A view is judged by a small picture: how much of the background is enclosed by the model. Of a
//! fixed list of directions, the usual one first, the first that shows enough of a hole is taken, else
//! the one that shows most.

use glam::DVec3;

use super::band::Band;
use super::camera::Camera;
use super::frame::window;
use super::marks::Marks;
use super::params::{EdgeLines, Ids, Shadow, Surface};
use super::scene::Scene;
use super::{PictureError, RenderParams, View, paint};
use crate::mesh::{FaceMap, Mesh};

/// Width and height of the picture that a view is judged by, in pixels.
const SMALL: u32 = 72;

/// What must show of a hole, as a part of that picture, and what is enough of it.
const LEAST: f64 = 0.002;
const ENOUGH: f64 = 0.008;

/// Directions that are tried: around the model at four heights, the usual one first.
fn directions() -> Vec<DVec3> {
    const AROUND: [[f64; 2]; 8] = [
        [0.52, -1.0],
        [1.0, -0.52],
        [0.2, -1.0],
        [1.0, -0.15],
        [-0.52, -1.0],
        [0.0, -1.0],
        [-1.0, -0.3],
        [1.0, 0.6],
    ];
    let mut all = Vec::new();
    for z in [0.62, 0.3, 1.1, 0.05, 2.5, -0.5] {
        all.extend(AROUND.map(|[x, y]| DVec3::new(x, y, z)));
    }
    all
}

/// The same parameters with a direction instead of [`View::Through`].
pub(super) fn aimed(mesh: &Mesh, params: &RenderParams) -> Result<RenderParams, PictureError> {
    if params.view != View::Through || mesh.face_count() == 0 {
        return Ok(params.clone());
    }
    let small = RenderParams {
        width: SMALL,
        height: Some(SMALL),
        edges: EdgeLines::Off,
        ids: Ids::None,
        surface: Surface::Solid,
        shadow: Shadow::Off,
        views: Vec::new(),
        zoom: 1.0,
        ..params.clone()
    };
    let mut best = (LEAST, View::ThreeQuarter);
    for from in directions() {
        let view = View::From(from);
        let share = enclosed(mesh, &RenderParams { view, ..small.clone() })?;
        if share > best.0 {
            best = (share, view);
        }
        if best.0 >= ENOUGH {
            break;
        }
    }
    Ok(RenderParams { view: best.1, ..params.clone() })
}

/// The share of the picture that is background enclosed by the model.
fn enclosed(mesh: &Mesh, params: &RenderParams) -> Result<f64, PictureError> {
    let (width, height) = (SMALL as usize, SMALL as usize);
    let camera = Camera::fitted(&[mesh], params, window(SMALL, SMALL, false))?;
    let colours = FaceMap::filled(mesh.face_slots(), paint::FRONT);
    let scene = Scene::new(mesh, params, &camera, (&colours, &Marks::default()));
    let band = Band::new(&scene, width, 0..height);
    let mut is_open: Vec<bool> =
        (0..width * height).map(|i| band.is_background(i % width, i / width)).collect();
    let all = is_open.iter().filter(|&&open| open).count();
    // What is connected with the border is outside.
    let border = (0..width).flat_map(|i| [(i, 0), (i, height - 1), (0, i), (width - 1, i)]);
    let mut waiting: Vec<(usize, usize)> = border.collect();
    let mut outside = 0;
    while let Some((x, y)) = waiting.pop() {
        if !std::mem::take(&mut is_open[y * width + x]) {
            continue;
        }
        outside += 1;
        let left = x.checked_sub(1).map(|x| (x, y));
        let above = y.checked_sub(1).map(|y| (x, y));
        let right = (x + 1 < width).then_some((x + 1, y));
        let below = (y + 1 < height).then_some((x, y + 1));
        waiting.extend([left, right, above, below].into_iter().flatten());
    }
    Ok((all - outside) as f64 / (width * height) as f64)
}

#[cfg(test)]
mod tests {
    use super::super::model::tests::torus;
    use super::*;

    #[test]
    fn the_hole_of_a_ring_is_looked_through_and_a_box_is_seen_as_usual() {
        let ring = torus(24, 12);
        let through = RenderParams { view: View::Through, ..RenderParams::default() };
        let params = aimed(&ring, &through).expect("a view");
        assert_ne!(params.view, View::Through);
        let small = RenderParams { width: SMALL, height: Some(SMALL), ..params };
        assert!(enclosed(&ring, &small).expect("a share") > LEAST);
        let cube = crate::shape::cube(10.0);
        assert_eq!(aimed(&cube, &through).expect("a view").view, View::ThreeQuarter);
    }
}
