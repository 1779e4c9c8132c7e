//! The panel size, from what the user gave.

use super::curvature::quadrics;
use super::refine::Triangles;
use super::report::sag;
use super::surface::PANEL_AREA;
use super::{Model, PanelizeError, PanelizeParams, fine_surface};
use crate::mesh::Mesh;
use crate::progress::Progress;
use crate::units::Length;

/// Rounds of finding the size for a sag: curvature is seen at the scale of the panels.
const ROUNDS: usize = 4;

impl Triangles {
    /// The area, in squared units of the points.
    pub(super) fn area(&self) -> f64 {
        let places = self.corners.iter().map(|t| t.map(|i| self.points[i]));
        places.map(|[a, b, c]| (b - a).cross(c - a).length() / 2.0).sum()
    }
}

/// The distance of the middles of neighbouring panels in mm.
pub(super) fn panel_size(given: &Triangles, params: &PanelizeParams) -> Result<f64, PanelizeError> {
    let area = given.area();
    let of_count = |count: f64| (area / (count * PANEL_AREA)).sqrt();
    match (params.size, params.count, params.sag) {
        (Some(size), ..) => Ok(size.mm()),
        (_, Some(count), _) => Ok(of_count(f64::from(count))),
        (.., Some(sag)) => size_of_sag(given, sag.mm(), of_count(200.0)),
        _ => Err(PanelizeError::NoSize { given: 0 }),
    }
}

/// The size at which a flat panel leaves the surface by `wanted` mm where it bends most: k L²/6 = sag.
fn size_of_sag(given: &Triangles, wanted: f64, start: f64) -> Result<f64, PanelizeError> {
    // Of a flat surface any size will do.
    let largest = start * 10.0;
    let mut size = start;
    for _ in 0..ROUNDS {
        let surface = fine_surface(given, (size, glam::DVec3::ZERO), &[])?;
        let seen = sag(&quadrics(&surface)) * size;
        size = (size * (wanted / seen.max(f64::MIN_POSITIVE)).sqrt()).min(largest);
    }
    Ok(size)
}

/// Each size that is tried after one that does not fit is smaller by this factor.
const SMALLER: f64 = 0.8;
/// So many are tried.
const TRIES: i32 = 8;

/// The largest of some smaller sizes at which panels can be laid out, where none of `size` can.
pub(super) fn size_that_fits(
    mesh: &Mesh,
    params: &PanelizeParams,
    size: f64,
    progress: &dyn Progress,
) -> Option<f64> {
    let fits = |&size: &f64| {
        let size = Some(Length::from_mm(size));
        let params = PanelizeParams { size, count: None, sag: None, ..params.clone() };
        // Laying out is quick, solving would not be.
        Model::new(mesh, &params, progress)
            .is_ok_and(|model| matches!(model.draft(0, params.seed), Some(Ok(_))))
    };
    let sizes = (1..=TRIES).map(|k| size * SMALLER.powi(k));
    sizes.take_while(|_| !progress.is_cancelled()).find(fits)
}
