//! The planes of a dual convex hull.

use glam::DVec3;

use super::build::Assembly;
use super::parts::Cluster;
use super::{HullPart, OpError, half_space_error};
use crate::geom::hull::{Apart, Form, HalfSpace, Intersect, Numbers, Polygons, intersect_apart};
use crate::geom::{Plane, RoundingBound};
use crate::progress::Progress;

/// The half-spaces of a dual hull, counted from a local origin so that far from the origin no
/// digits are lost.
pub(super) struct Dual {
    origin: DVec3,
    interior: DVec3,
    /// The planes through the corners of the hull, in the order of the points, then the box.
    half_spaces: Vec<HalfSpace>,
    box_sides: usize,
    /// How near vertices may be before coordinates cannot tell them apart where the points lie.
    resolution: f64,
}

/// How many of the half-spaces are sides of the box.
pub(super) fn box_sides(no_box: bool) -> usize {
    if no_box { 0 } else { 6 }
}

impl Dual {
    /// One half-space through each corner of the hull with the mean of the unit normals of its
    /// faces there, and the box.
    pub(super) fn of(points: &[DVec3], faces: &Polygons, no_box: bool) -> Self {
        let (low, high) =
            points.iter().fold((points[0], points[0]), |(l, h), &p| (l.min(p), h.max(p)));
        let origin = low + (high - low) / 2.0;
        let mut normals = vec![DVec3::ZERO; points.len()];
        for run in faces.iter() {
            let corners: Vec<DVec3> = run.iter().map(|&i| points[i as usize] - origin).collect();
            let normal = Plane::newell(&corners).map_or(DVec3::ZERO, |plane| plane.normal());
            run.iter().for_each(|&i| normals[i as usize] += normal);
        }
        let (mut half_spaces, mut sum) = (Vec::new(), DVec3::ZERO);
        for (&p, normal) in points.iter().zip(normals) {
            // The normals around a corner never cancel, all point away from the inside; points that
            // are no corner have none.
            if let Some(normal) = normal.try_normalize() {
                half_spaces.push(HalfSpace { normal, offset: normal.dot(p - origin) });
                sum += p - origin;
            }
        }
        let interior = sum / half_spaces.len() as f64;
        if !no_box {
            for axis in 0..3 {
                let side = DVec3::AXES[axis];
                half_spaces.push(HalfSpace { normal: -side, offset: origin[axis] - low[axis] });
                half_spaces.push(HalfSpace { normal: side, offset: high[axis] - origin[axis] });
            }
        }
        let resolution = RoundingBound::of_box(low, high).length();
        Self { origin, interior, half_spaces, box_sides: box_sides(no_box), resolution }
    }

    /// Intersects the first `planes` half-spaces with the box and adds the solid to a mesh.
    pub(super) fn add_to(
        &self,
        mesh: &mut Assembly,
        cluster: &Cluster,
        (form, planes): (Form, usize),
        progress: &dyn Progress,
    ) -> Result<HullPart, OpError> {
        let (corners, sides) = self.half_spaces.split_at(self.half_spaces.len() - self.box_sides);
        let chosen: Vec<HalfSpace> = corners.iter().take(planes).chain(sides).copied().collect();
        let options = Intersect {
            form,
            numbers: Numbers::Constructed,
            interior: Some(self.interior),
            resolution: self.resolution,
        };
        // The sides of the box stay where the points end.
        let movable = chosen.len() - self.box_sides;
        let Apart { polytope, half_spaces, moved } =
            intersect_apart(&chosen, &options, movable, &|| !progress.is_cancelled())
                .map_err(|reason| half_space_error(&cluster.name, reason))?;
        let part = HullPart {
            name: cluster.name.clone(),
            points: cluster.points.len(),
            planes: chosen.len(),
            moved: moved.len(),
            ..HullPart::default()
        };
        Ok(mesh.add_polytope(polytope, &half_spaces, self.origin, part))
    }
}
