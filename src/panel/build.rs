//! From a mesh to its plates, in named steps.

use super::cut::Cutter;
use super::error::PanelError;
use super::hole::drill;
use super::node::nodes;
use super::outline::FlatFace;
use super::params::PanelParams;
use super::planar::refuse_bent;
use super::plate::Plates;
use super::settle::settle;
use crate::mesh::{FaceId, FaceMap, Mesh};
use crate::progress::Progress;
use crate::units::Length;

/// Makes a plate of every face of a mesh in millimetres. A plate lies in the plane that its face
/// carries, else in the Newell plane; faces may be concave. Faces that are not planar are
/// [`super::PanelFinding`]s, those far from it are refused.
///
/// No two plates share more than [`super::SHARED`] of their volume: what is cut off for it stands
/// in [`Plates::node_cuts`], what is mitred for it in [`super::EdgeCut::fallback`].
///
/// # Errors
/// [`PanelError`]: a number out of range, a group that is not there, a face without area or far
/// from planar, faces that lie on each other, plates that run into themselves, with the largest
/// thickness that works, or into each other.
///
/// # Example
/// ```
/// use kerfold::panel::{PanelParams, plates};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let made = plates(&cube, Length::from_mm(5.0), &PanelParams::default(), &Silent)?;
/// assert_eq!(made.plates.len(), 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plates(
    mesh: &Mesh,
    thickness: Length,
    params: &PanelParams,
    progress: &dyn Progress,
) -> Result<Plates, PanelError> {
    params.check(thickness)?;
    refuse_bent(mesh)?;
    let faces = mesh.faces().map(|f| FlatFace::new(mesh, f)).collect::<Result<Vec<_>, _>>()?;
    faces.iter().try_for_each(|face| face.check(mesh))?;
    let mut flat = FaceMap::filled(mesh.face_slots(), usize::MAX);
    faces.iter().enumerate().for_each(|(i, face)| flat[face.face] = i);
    let mut cutter = Cutter::new(mesh, params, thicknesses(mesh, thickness, params)?)?;
    for face in &faces {
        let straight = (0..face.len()).filter(|&i| face.is_straight(i));
        straight.for_each(|i| cutter.set_straight(face.half_edges[i]));
        cutter.set_slack(face);
    }
    let settled = settle(&faces, &flat, &mut cutter, progress)?;
    let mut made = Plates {
        edges: mesh.edges().map(|e| cutter.edge_cut(e)).collect(),
        nodes: nodes(mesh, &cutter, &faces, &flat),
        straight_corners: faces.iter().flat_map(|f| levelled_corners(f, &cutter)).collect(),
        node_cuts: settled.cuts,
        ..Plates::default()
    };
    for shape in settled.shaped {
        made.unrelieved_corners += shape.unrelieved;
        made.plates.push(shape.plate);
    }
    drill(&mut made, &faces, &flat, &cutter, progress)?;
    Ok(made)
}

/// The thickness of every plate.
fn thicknesses(
    mesh: &Mesh,
    thickness: Length,
    params: &PanelParams,
) -> Result<FaceMap<f64>, PanelError> {
    let mut all = FaceMap::filled(mesh.face_slots(), thickness.mm());
    for own in &params.thickness_of {
        if !mesh.groups().contains(&own.group) {
            return Err(PanelError::UnknownGroup {
                group: own.group.clone(),
                known: mesh.groups().to_vec(),
            });
        }
        for f in mesh.faces().filter(|&f| mesh.group(f) == Some(&own.group)) {
            all[f] = own.thickness.mm();
        }
    }
    Ok(all)
}

/// The straight corners of a face between edges that ask for different insets.
fn levelled_corners(face: &FlatFace, cutter: &Cutter<'_>) -> Vec<(FaceId, usize)> {
    let gap = cutter.params.gap.mm();
    let own = |i: usize| cutter.own_inset(face.half_edges[i], 1.0, gap);
    let differ = |a: f64, b: f64| (a - b).abs() > 2e3 * f64::EPSILON * (a.abs() + b.abs());
    let is_levelled = |&i: &usize| {
        let (before, after) = (own(face.before(i)), own(i));
        face.is_straight(i)
            && (differ(before.front, after.front) || differ(before.back, after.back))
    };
    (0..face.len()).filter(is_levelled).map(|i| (face.face, i)).collect()
}
