//! Are the angles of folds and seams those of the mesh, and are folds named as they bend?
//!
//! The pieces fold up by the angles of folds alone, so seams need a look of their own: who closes
//! one bevels or glues by its angle.

use super::refold::unevenness;
use super::{EdgeFault, ProofError, REFOLD};
use crate::geom::Plane;
use crate::mesh::{EdgeId, FaceMap, Mesh};
use crate::net::{FoldKind, Net};

/// A fold that bends by less than this may have any name, in degrees: far above rounding, far below
/// what anybody can see.
const NAMELESS: f64 = 1e-4;

pub(super) fn check(mesh: &Mesh, net: &Net, size: f64) -> Result<(), ProofError> {
    // Each face lies at several edges.
    let mut uneven = FaceMap::filled(mesh.face_slots(), 0.0);
    mesh.faces().for_each(|f| uneven[f] = unevenness(mesh, f));
    let bends: Vec<Option<Bend>> =
        net.folds.iter().map(|fold| Bend::at(mesh, EdgeId::new(fold.id.0), &uneven)).collect();
    let folds = net
        .folds
        .iter()
        .zip(&bends)
        .filter_map(|(fold, bend)| Some((fold.id.0, fold.edge, fold.fold_angle, (*bend)?)));
    let seams = net.seams.iter().filter_map(|seam| {
        let bend = Bend::at(mesh, EdgeId::new(seam.id.0), &uneven)?;
        Some((seam.id.0, seam.edge, seam.fold_angle, bend))
    });
    for (edge, ends, given, fold) in folds.chain(seams) {
        // An angle is as wrong as the far corner of the smaller face comes off its place.
        let off = fold.differs_by(given).to_radians() * fold.reach;
        let is_right = off <= size * (REFOLD + 4.0 * fold.slope);
        // An angle that is no number is wrong, too.
        if !is_right {
            let fault = EdgeFault::Angle { given, angle: fold.degrees };
            return Err(ProofError::Edge { edge, ends, fault });
        }
    }
    for (fold, bend) in net.folds.iter().zip(&bends) {
        let Some(bend) = bend else { continue };
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
#[derive(Clone, Copy)]
struct Bend {
    degrees: f64,
    /// The diameter of the smaller face, in mm.
    reach: f64,
    /// How far the faces are from planar, relative to their extent.
    slope: f64,
}

impl Bend {
    /// `None` at a rim and beside a face without area.
    fn at(mesh: &Mesh, e: EdgeId, uneven: &FaceMap<f64>) -> Option<Self> {
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
            slope: uneven[faces[0]].max(uneven[faces[1]]),
        })
    }

    /// Half a turn to the one side is half a turn to the other.
    fn differs_by(&self, given: f64) -> f64 {
        let difference = (given - self.degrees).abs();
        difference.min((360.0 - difference).abs())
    }
}
