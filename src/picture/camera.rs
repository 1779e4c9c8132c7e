//! The camera: from the model to the picture.

use glam::{DVec2, DVec3};

use super::bsp::Eye;
use super::params::Projection;
use super::{PictureError, RenderParams};
use crate::mesh::Mesh;

/// The distance of the eye in half diagonals of the model, for perspective.
const EYE_DISTANCE: f64 = 5.0;

/// The rectangle of the picture that the model may fill, in pixels, y down.
#[derive(Debug, Clone, Copy)]
pub(super) struct Window {
    pub low: DVec2,
    pub high: DVec2,
}

/// Maps the model to pixels. Planes stay planes: the third coordinate, larger when nearer, is a
/// projective depth.
#[derive(Debug, Clone, Copy)]
pub(super) struct Camera {
    axes: [DVec3; 3],
    centre: DVec3,
    radius: f64,
    eye_distance: f64,
    scale: f64,
    shift: DVec2,
}

impl Camera {
    /// A camera that sees all of some models as large as the window allows.
    pub fn fitted(
        meshes: &[&Mesh],
        params: &RenderParams,
        window: Window,
    ) -> Result<Self, PictureError> {
        let axes = params.axes()?;
        if !(0.1..=20.0).contains(&params.zoom) {
            return Err(PictureError::ZoomOutOfRange { zoom: params.zoom });
        }
        for (mesh, v) in meshes.iter().flat_map(|mesh| mesh.vertices().map(move |v| (mesh, v))) {
            // Half of the largest number, so that differences stay finite.
            let p = mesh.position(v);
            if !p.is_finite() || p.abs().max_element() > f64::MAX / 4.0 {
                return Err(PictureError::VertexTooFar { vertex: v, x: p.x, y: p.y, z: p.z });
            }
        }
        let bounds = meshes.iter().filter_map(|mesh| mesh.bounds());
        let (low, high) =
            bounds.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).ok_or(PictureError::NoFaces)?;
        let centre = low.midpoint(high);
        let extent = (high - low).max_element();
        // Half the diagonal, without squaring what could overflow.
        let radius =
            if extent > 0.0 { ((high - low) / extent).length() / 2.0 * extent } else { 1.0 };
        let eye_distance =
            if params.projection == Projection::Perspective { EYE_DISTANCE } else { f64::INFINITY };
        let mut camera =
            Self { axes, centre, radius, eye_distance, scale: 1.0, shift: DVec2::ZERO };
        camera.fit(meshes, window, params.zoom);
        Ok(camera)
    }

    fn fit(&mut self, meshes: &[&Mesh], window: Window, zoom: f64) {
        let mut low = DVec2::INFINITY;
        let mut high = DVec2::NEG_INFINITY;
        for p in meshes.iter().flat_map(|mesh| mesh.vertices().map(|v| mesh.position(v))) {
            let p = self.project(p).truncate();
            (low, high) = (low.min(p), high.max(p));
        }
        let (room, size) = (window.high - window.low, high - low);
        // A model seen from its end can have no width or no height, but a point-like one must not
        // become infinite.
        self.scale = (room / size.max(DVec2::splat(1e-6))).min_element() * zoom;
        self.shift = window.low.midpoint(window.high) - low.midpoint(high) * self.scale;
    }

    /// The position in half diagonals, turned so that x is right, y up and z towards the eye.
    pub fn turned(&self, p: DVec3) -> DVec3 {
        let q = (p - self.centre) / self.radius;
        let [x, y, z] = self.axes;
        DVec3::new(q.dot(x), q.dot(y), q.dot(z))
    }

    /// Pixels right and down from the top left, and depth in pixels.
    pub fn project(&self, p: DVec3) -> DVec3 {
        self.place(self.turned(p))
    }

    /// The eye, in the coordinates of [`Self::turned`].
    pub fn eye(&self) -> Eye {
        if self.eye_distance.is_finite() {
            Eye::At(DVec3::Z * self.eye_distance)
        } else {
            Eye::Along(DVec3::Z)
        }
    }

    /// As [`Self::project`] for a position that was turned already.
    pub fn place(&self, q: DVec3) -> DVec3 {
        let q = q / (1.0 - q.z / self.eye_distance) * self.scale;
        DVec3::new(q.x + self.shift.x, -q.y + self.shift.y, q.z)
    }

    /// Pixels per half diagonal at the middle of the model.
    pub fn scale(&self) -> f64 {
        self.scale
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::model::tests::cuboid;

    #[test]
    fn the_model_fills_its_window_at_every_size_and_place() {
        let window = Window { low: DVec2::new(10.0, 20.0), high: DVec2::new(410.0, 320.0) };
        for (size, place) in [(1.0, 0.0), (1e-9, 0.0), (1e5, 1e9), (1e-140, 0.0), (1e140, 0.0)] {
            let mesh = cuboid(DVec3::splat(place), DVec3::splat(size) + place);
            let camera =
                Camera::fitted(&[&mesh], &RenderParams::default(), window).expect("a camera");
            let points: Vec<DVec2> =
                mesh.vertices().map(|v| camera.project(mesh.position(v)).truncate()).collect();
            let (low, high) = crate::geom::polygon::bounds(&points).expect("points");
            assert!(
                (high - low).y - 300.0 < 1e-6 && (300.0 - (high - low).y) < 1e-3,
                "{size}: {low} {high}"
            );
            assert!(low.x > 10.0 && high.x < 410.0 && (low.y - 20.0).abs() < 1e-3);
        }
    }

    #[test]
    fn zooming_keeps_the_middle_and_enlarges_the_rest() {
        let window = Window { low: DVec2::ZERO, high: DVec2::splat(100.0) };
        let mesh = cuboid(DVec3::ZERO, DVec3::ONE);
        let whole = RenderParams { projection: Projection::Parallel, ..RenderParams::default() };
        let near = RenderParams { zoom: 4.0, ..whole.clone() };
        let [whole, near] =
            [whole, near].map(|p| Camera::fitted(&[&mesh], &p, window).expect("a camera"));
        let middle = |camera: &Camera| camera.project(DVec3::splat(0.5)).truncate();
        assert!(middle(&whole).distance(middle(&near)) < 1e-9);
        assert!((near.scale() - 4.0 * whole.scale()).abs() < 1e-9 * near.scale());
        for zoom in [0.0, 21.0, f64::NAN] {
            let params = RenderParams { zoom, ..RenderParams::default() };
            let refused = Camera::fitted(&[&mesh], &params, window);
            assert!(matches!(refused, Err(PictureError::ZoomOutOfRange { .. })));
        }
    }

    #[test]
    fn planes_stay_planes_and_nearer_is_larger() {
        let window = Window { low: DVec2::ZERO, high: DVec2::splat(100.0) };
        let mesh = cuboid(DVec3::ZERO, DVec3::ONE);
        let camera = Camera::fitted(&[&mesh], &RenderParams::default(), window).expect("a camera");
        let [a, b, c] =
            [DVec3::ZERO, DVec3::X, DVec3::new(0.0, 0.6, 0.8)].map(|p| camera.project(p));
        let d = camera.project(DVec3::new(0.3, 0.3, 0.4));
        assert!((d - a).dot((b - a).cross(c - a)).abs() < 1e-6);
        assert!(camera.project(DVec3::new(0.0, -1.0, 0.0)).z > camera.project(DVec3::ZERO).z);
    }
}
