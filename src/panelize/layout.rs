//! From a surface to a first layout of panels.

use super::curvature::Quadric;
use super::field::RowField;
use super::lattice::lattice;
use super::regions::{Panels, panels_of_sites};
use super::sites::{Ground, fill_and_thin, sites_of_lattice};
use super::surface::Surface;

/// The count may be off by this share before the layout is made again with a size corrected.
const COUNT_OFF: f64 = 0.06;
/// The most layouts for one seed.
const LAYOUTS: usize = 3;

/// A layout: panels, and how much of the area of a regular hexagon each should have.
#[derive(Debug)]
pub(super) struct Layout {
    pub panels: Panels,
    pub areas: Vec<f64>,
}

/// Lays panels out on a surface by a field, their sizes scaled by `scale`.
///
/// # Errors
/// The vertices in the middle of the regions that make no panels.
pub(super) fn layout(
    surface: &Surface,
    quadrics: &[Quadric],
    field: &RowField,
    scale: &[f64],
    seed: u64,
) -> Result<Layout, Vec<usize>> {
    let wanted = surface.room();
    let mut size = 1.0;
    let mut best: Option<(f64, Panels)> = None;
    let mut failed = Vec::new();
    for _ in 0..LAYOUTS {
        let sizes: Vec<f64> = scale.iter().map(|s| s * size).collect();
        let held = lattice(surface, quadrics, field, &sizes, seed);
        let ground = Ground { surface, sizes: &sizes };
        let mut sites = sites_of_lattice(ground, &held);
        fill_and_thin(ground, &mut sites);
        match panels_of_sites(surface, &mut sites) {
            Ok(panels) => {
                let share = panels.faces.len() as f64 / wanted;
                let off = (share - 1.0).abs();
                size *= share.sqrt();
                if best.as_ref().is_none_or(|(least, _)| off < *least) {
                    best = Some((off, panels));
                }
                if off < COUNT_OFF {
                    break;
                }
            }
            Err(bad) => {
                failed = bad;
                size *= 0.97;
            }
        }
    }
    let Some((_, panels)) = best else { return Err(failed) };
    let mean = wanted / panels.faces.len() as f64;
    let mut areas: Vec<f64> = panels.sites.iter().map(|&v| scale[v] * scale[v] * mean).collect();
    for (own, given) in areas.iter_mut().zip(&surface.pins.areas) {
        *own = given.unwrap_or(*own);
    }
    Ok(Layout { panels, areas })
}
