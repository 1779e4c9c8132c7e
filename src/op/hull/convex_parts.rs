//! Approximate convex decomposition: the only door to parry's.
//!
//! Source: Mamou and Ghorbel 2009, "A simple and efficient approach for 3D mesh approximate convex
//! decomposition" (HACD), in its volumetric form: the model is divided into voxels and these by
//! planes until the parts are nearly convex.

use glam::DVec3;
use parry3d_f64::math::Vector;
use parry3d_f64::transformation::vhacd::{VHACD, VHACDParameters};

/// Voxels along the longest side of the model.
const RESOLUTION: u32 = 96;

/// Divides a surface of triangles into at most `most` nearly convex parts, each given by points of
/// the surface within it.
///
/// `concavity` is the share of volume by which a part's hull may exceed it. Parts without points
/// are left out.
pub(super) fn convex_parts(
    points: &[DVec3],
    triangles: &[[u32; 3]],
    most: u32,
    concavity: f64,
) -> Vec<Vec<DVec3>> {
    if most < 2 || triangles.is_empty() {
        return Vec::new();
    }
    let vertices: Vec<Vector> = points.iter().map(|p| Vector::new(p.x, p.y, p.z)).collect();
    let params = VHACDParameters {
        concavity,
        resolution: RESOLUTION,
        max_convex_hulls: most,
        ..VHACDParameters::default()
    };
    let parts = VHACD::decompose(&params, &vertices, triangles, true);
    let pieces = parts.compute_primitive_intersections(&vertices, triangles);
    let back = |piece: Vec<Vector>| {
        piece.into_iter().map(|p| DVec3::new(p.x, p.y, p.z)).collect::<Vec<_>>()
    };
    pieces.into_iter().filter(|piece| piece.len() > 3).map(back).collect()
}
