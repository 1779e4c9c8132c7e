//! From a surface to a first layout of panels.

use super::curvature::Quadric;
use super::field::RowField;
use super::lattice::lattice;
use super::mirror::{Faults, Mirror};
use super::regions::{Panels, panels_of_sites};
use super::sites::{Ground, fill_and_thin, sites_of_lattice};
use super::solve::Symmetry;
use super::surface::Surface;

/// The count may be off by this share before the layout is made again with a size corrected.
const COUNT_OFF: f64 = 0.06;
/// The most layouts for one seed; more with mirror planes, since whole rows come or go at once.
const LAYOUTS: usize = 3;
const LAYOUTS_MIRRORED: usize = 6;
/// Rounds of mending panels at mirror planes.
const MENDS: usize = 24;

/// A layout: panels, how much of the area of a regular hexagon each should have, and which of their
/// corners are images of each other.
#[derive(Debug)]
pub(super) struct Layout {
    pub panels: Panels,
    pub areas: Vec<f64>,
    pub symmetry: Option<Symmetry>,
}

/// What panels are laid out along: a field of rows, and the sizes of panels, at each vertex.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    pub field: &'a RowField,
    pub scale: &'a [f64],
}

/// Lays panels out on a surface, or on one part of it and its images.
///
/// # Errors
/// The vertices in the middle of the regions that make no panels.
pub(super) fn layout(
    surface: &Surface,
    quadrics: &[Quadric],
    Rows { field, scale }: Rows<'_>,
    mirror: Option<&Mirror>,
    seed: u64,
) -> Result<Layout, Vec<usize>> {
    let ground_of = mirror.map_or(surface, |mirror| &mirror.part);
    let count = ground_of.points.len();
    let wanted = surface.room();
    let mut size = 1.0;
    let mut best: Option<(f64, Layout)> = None;
    let mut failed = Vec::new();
    for _ in 0..if mirror.is_some() { LAYOUTS_MIRRORED } else { LAYOUTS } {
        let sizes: Vec<f64> = scale[..count].iter().map(|s| s * size).collect();
        let held = lattice(ground_of, &quadrics[..count], field, &sizes, seed);
        let ground = Ground { surface: ground_of, sizes: &sizes };
        let mut sites = sites_of_lattice(ground, &held);
        fill_and_thin(ground, &mut sites);
        let made = match mirror {
            None => panels_of_sites(surface, &mut sites).map(|panels| (panels, None)),
            Some(mirror) => mirrored(mirror, surface, &mut sites),
        };
        match made {
            Ok((panels, symmetry)) => {
                let share = panels.faces.len() as f64 / wanted;
                let off = (share - 1.0).abs();
                size *= share.sqrt();
                if best.as_ref().is_none_or(|(least, _)| off < *least) {
                    best = Some((off, Layout { panels, areas: Vec::new(), symmetry }));
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
    let Some((_, mut made)) = best else { return Err(failed) };
    let mean = wanted / made.panels.faces.len() as f64;
    made.areas = made.panels.sites.iter().map(|&v| scale[v] * scale[v] * mean).collect();
    for (own, given) in made.areas.iter_mut().zip(&surface.pins.areas) {
        *own = given.unwrap_or(*own);
    }
    Ok(made)
}

/// The panels of one part and their images, mended where they do not fit at the mirror planes.
fn mirrored(
    mirror: &Mirror,
    whole: &Surface,
    sites: &mut Vec<usize>,
) -> Result<(Panels, Option<Symmetry>), Vec<usize>> {
    let part = &mirror.part;
    let mut bad = Vec::new();
    for _ in 0..MENDS {
        let half = panels_of_sites(part, sites)?;
        let Faults { beside, bad: lost } = match mirror.panels(&half, whole) {
            Ok((panels, symmetry)) => return Ok((panels, Some(symmetry))),
            Err(faults) => faults,
        };
        bad = beside.iter().map(|&(k, _)| sites[k]).chain(lost.iter().map(|&k| sites[k])).collect();
        for (k, axis) in beside {
            let mask = part.mask(sites[k]) | 1 << axis;
            sites[k] = part.nearest_with(mask, part.points[sites[k]]).unwrap_or(sites[k]);
        }
        // Panels of the part that make none with their images give way to their neighbours.
        if let Some(&first) = lost.first() {
            sites.remove(first);
        }
    }
    Err(bad)
}
