//! Are the angles of folds and seams those of the mesh, and are folds named as they bend?
//!
//! The pieces fold up by the angles of folds alone, so seams need a look of their own: who closes
//! one bevels or glues by its angle.

use super::refold::unevenness;
use super::{EdgeFault, ProofError, REFOLD};
use crate::geom::Plane;
use crate::mesh::{EdgeId, Mesh};
use crate::net::{FoldKind, Net};

/// A fold that bends by less than this may have any name, in degrees: far above rounding, far below
/// what anybody can see.
const NAMELESS: f64 = 1e-4;

pub(super) fn check(mesh: &Mesh, net: &Net, size: f64) -> Result<(), ProofError> {
    let folds = net.folds.iter().map(|fold| (fold.id.0, fold.edge, fold.fold_angle));
    let seams = net.seams.iter().map(|seam| (seam.id.0, seam.edge, seam.fold_angle));
    for (edge, ends, given) in folds.chain(seams) {
        let Some(fold) = Bend::at(mesh, EdgeId::new(edge)) else { continue };
        // An angle is as wrong as the far corner of the smaller face comes off its place.
        let off = fold.differs_by(given).to_radians() * fold.reach;
        let is_right = off <= size * (REFOLD + 4.0 * fold.slope);
        // An angle that is no number is wrong, too.
        if !is_right {
            let fault = EdgeFault::Angle { given, angle: fold.degrees };
            return Err(ProofError::Edge { edge, ends, fault });
        }
    }
    for fold in &net.folds {
        let Some(bend) = Bend::at(mesh, EdgeId::new(fold.id.0)) else { continue };
        let angle = bend.degrees;
        let is_named = match fold.kind {
            FoldKind::Mountain => angle > -NAMELESS,
            FoldKind::Valley => angle < NAMELESS || angle.abs() >= 180.0 - NAMELESS,
            FoldKind::Flat => angle.abs() < NAMELESS,
        };
        if !is_named {
            let named = match fold.kind {
                FoldKind::Mountain => "a mountain",
                FoldKind::Valley => "a valley",
                FoldKind::Flat => "flat",
            };
            let fault = EdgeFault::Kind { named, angle };
            return Err(ProofError::Edge { edge: fold.id.0, ends: fold.edge, fault });
        }
    }
    Ok(())
}

/// How the mesh bends at an edge.
struct Bend {
    degrees: f64,
    /// The diameter of the smaller face, in mm.
    reach: f64,
    /// How far the faces are from planar, relative to their extent.
    slope: f64,
}

impl Bend {
    /// `None` at a rim and beside a face without area.
    fn at(mesh: &Mesh, e: EdgeId) -> Option<Self> {
        if mesh.is_rim(e) {
            return None;
        }
        let faces = mesh.edge_faces(e);
        let points = faces.map(|f| mesh.face_positions(f));
        let [n, m] = [Plane::newell(&points[0])?.normal(), Plane::newell(&points[1])?.normal()];
        let [a, b] = mesh.edge_positions(e);
        let along = (b - a).try_normalize()?;
        let reach = |i: usize| points[i].iter().map(|p| p.distance(a)).fold(0.0, f64::max);
        Some(Self {
            degrees: along.dot(n.cross(m)).atan2(n.dot(m)).to_degrees(),
            reach: reach(0).min(reach(1)),
            slope: unevenness(mesh, faces[0]).max(unevenness(mesh, faces[1])),
        })
    }

    /// Half a turn to the one side is half a turn to the other.
    fn differs_by(&self, given: f64) -> f64 {
        let difference = (given - self.degrees).abs();
        difference.min((360.0 - difference).abs())
    }
}
