//! From a mesh to its plates, in named steps.

use std::collections::BTreeSet;

use glam::DVec2;

use super::collision::{collisions, crossing};
use super::cut::{Cutter, EdgeFallback, Inset};
use super::error::PanelError;
use super::finger::{Comb, combs, zone_points};
use super::hole::drill;
use super::node::nodes;
use super::outline::FlatFace;
use super::params::{Hardware, PanelParams};
use super::plate::{Plate, Plates};
use super::rule::EdgeKind;
use crate::geom::Frame;
use crate::mesh::{EdgeId, EdgeMap, FaceMap, Mesh};
use crate::progress::Progress;
use crate::units::Length;

/// Makes a plate of every face of a mesh in millimetres. Faces are taken to be planar (their plane
/// is the one that they carry, else the Newell plane); they may be concave.
///
/// # Errors
/// [`PanelError`]: a number out of range, a group that is not there, a face without area, faces that lie on each other, or
/// plates that run into themselves, with the largest thickness that works.
///
/// # Example
/// ```
/// use kerfold::panel::{Hardware, PanelParams, plates};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let hardware = Hardware::default();
/// let made = plates(&cube, Length::from_mm(5.0), (&params, &hardware), &Silent)?;
/// assert_eq!(made.plates.len(), 6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn plates(
    mesh: &Mesh,
    thickness: Length,
    (params, hardware): (&PanelParams, &Hardware),
    progress: &dyn Progress,
) -> Result<Plates, PanelError> {
    params.check(thickness)?;
    hardware.check()?;
    let faces = mesh.faces().map(|f| FlatFace::new(mesh, f)).collect::<Result<Vec<_>, _>>()?;
    faces.iter().try_for_each(|face| face.check(mesh))?;
    let mut flat = FaceMap::filled(mesh.face_slots(), usize::MAX);
    faces.iter().enumerate().for_each(|(i, face)| flat[face.face] = i);
    let mut cutter = Cutter::new(mesh, params, thicknesses(mesh, thickness, params)?)?;
    let shaped = settle(&faces, &flat, &mut cutter, hardware, progress)?;
    let mut made = Plates {
        edges: mesh.edges().map(|e| cutter.edge_cut(e)).collect(),
        nodes: nodes(mesh, &cutter, &faces, &flat),
        ..Plates::default()
    };
    for (face, shape) in faces.iter().zip(shaped) {
        made.straight_corners.extend(shape.straight.iter().map(|&i| (face.face, i)));
        made.unrelieved_corners += shape.unrelieved;
        made.plates.push(shape.plate);
    }
    drill(&mut made, &faces, &flat, &cutter, hardware);
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

/// A plate without holes, and what could not be done to it.
struct Shaped {
    plate: Plate,
    straight: Vec<usize>,
    unrelieved: usize,
}

/// Shapes all plates, taking fingers and butt joints away where they do not fit until nothing
/// collides.
fn settle(
    faces: &[FlatFace],
    flat: &FaceMap<usize>,
    cutter: &mut Cutter<'_>,
    hardware: &Hardware,
    progress: &dyn Progress,
) -> Result<Vec<Shaped>, PanelError> {
    loop {
        let mut found = Vec::new();
        for (i, face) in faces.iter().enumerate() {
            found.extend(collisions(face, cutter));
            if i.is_multiple_of(1024) {
                progress.report("plates", i, faces.len());
                if progress.is_cancelled() {
                    return Err(PanelError::Cancelled);
                }
            }
        }
        if !found.is_empty() {
            let special =
                |c: &super::Collision| special_edges(&faces[flat[c.face]], cutter, c.edge);
            let fallen: BTreeSet<EdgeId> = found.iter().flat_map(special).collect();
            if fallen.is_empty() {
                found.sort_by(|a, b| {
                    (a.largest / a.thickness).total_cmp(&(b.largest / b.thickness))
                });
                return Err(PanelError::Collision { found });
            }
            fallen.into_iter().for_each(|e| cutter.fall_back(e, EdgeFallback::Narrow));
            continue;
        }
        let combs = match combs(faces, flat, cutter, hardware) {
            Ok(combs) => combs,
            Err(short) => {
                short.into_iter().for_each(|e| cutter.fall_back(e, EdgeFallback::Short));
                continue;
            }
        };
        let shaped: Vec<Shaped> = faces.iter().map(|face| shape(face, cutter, &combs)).collect();
        let narrow: BTreeSet<EdgeId> = faces
            .iter()
            .zip(&shaped)
            .flat_map(|(face, s)| crossed_fingers(face, &s.plate, &combs))
            .collect();
        if narrow.is_empty() {
            return Ok(shaped);
        }
        narrow.into_iter().for_each(|e| cutter.fall_back(e, EdgeFallback::Narrow));
    }
}

/// The edges beside a collision that could be something else: those with fingers or butt joints.
fn special_edges(face: &FlatFace, cutter: &Cutter<'_>, at: Option<EdgeId>) -> Vec<EdgeId> {
    let edge = |i: usize| face.half_edges[i % face.len()].edge();
    let here = (0..face.len()).find(|&i| at == Some(edge(i)));
    let near: Vec<EdgeId> = match here {
        Some(i) => vec![edge(face.before(i)), edge(i), edge(i + 1)],
        None => (0..face.len()).map(edge).collect(),
    };
    near.into_iter()
        .filter(|&e| matches!(cutter.kind(e), EdgeKind::Finger | EdgeKind::Butt))
        .collect()
}

/// The fingered edges of a plate whose outline crosses itself.
fn crossed_fingers(face: &FlatFace, plate: &Plate, combs: &EdgeMap<Option<Comb>>) -> Vec<EdgeId> {
    let fingered: Vec<EdgeId> =
        face.half_edges.iter().map(|h| h.edge()).filter(|&e| combs[e].is_some()).collect();
    if fingered.is_empty() {
        return fingered;
    }
    let side = |at: usize| {
        plate.begins.partition_point(|&b| b <= at).checked_sub(1).unwrap_or(face.len() - 1)
    };
    let crossings = [&plate.front, &plate.back].into_iter().filter_map(|outline| crossing(outline));
    let near: Vec<EdgeId> = crossings
        .flat_map(|(a, b)| [a, b])
        .flat_map(|at| [face.half_edges[side(at)].edge()])
        .filter(|e| fingered.contains(e))
        .collect();
    // Where sides without fingers cross, something else must give: then all of them.
    let is_crossed =
        [&plate.front, &plate.back].into_iter().any(|outline| crossing(outline).is_some());
    if is_crossed && near.is_empty() { fingered } else { near }
}

/// One plate: sides moved, corners relieved, fingers put on.
fn shape(face: &FlatFace, cutter: &Cutter<'_>, combs: &EdgeMap<Option<Comb>>) -> Shaped {
    let insets: Vec<Inset> = face.half_edges.iter().map(|&h| cutter.inset(h, 1.0)).collect();
    let polygon = |of: fn(&Inset) -> f64| face.moved(&insets.iter().map(of).collect::<Vec<_>>());
    let (front, straight) = polygon(|i| i.front);
    let (back, blank) = (polygon(|i| i.back).0, polygon(Inset::outer).0);
    let inner = polygon(Inset::inner).0;
    let relief = cutter.params.corner_relief.mm();
    let levels: Vec<Option<f64>> =
        (0..face.len()).map(|i| relief_level(face, i, (&front, &back, &blank), relief)).collect();
    let convex = (0..face.len()).filter(|&i| is_convex(face, i)).count();
    let unrelieved = if relief > 0.0 { convex - levels.iter().flatten().count() } else { 0 };
    let (mut begins, mut ends) = (Vec::new(), Vec::new());
    let mut finish = |base: &[DVec2]| {
        begins.clear();
        ends.clear();
        let mut outline = Vec::new();
        for i in 0..face.len() {
            let corner = base[i];
            match levels[i] {
                Some(level) => {
                    let [before, after] = relieved(face, i, corner, level);
                    ends.push(outline.len());
                    outline.push(before);
                    begins.push(outline.len());
                    outline.push(after);
                }
                None => {
                    ends.push(outline.len());
                    begins.push(outline.len());
                    outline.push(corner);
                }
            }
            let comb = combs[face.half_edges[i].edge()].as_ref();
            outline
                .extend(comb.into_iter().flat_map(|comb| zone_points(face, i, &insets[i], comb)));
        }
        // So far the end of the side before each corner.
        ends.rotate_left(1);
        outline
    };
    let [front, back, blank] = [&front, &back, &blank].map(|base| finish(base));
    let offset = cutter.offsets(face.face, 1.0)[0];
    let frame = Frame { origin: face.frame.origin + face.frame.normal * offset, ..face.frame };
    let plate = Plate {
        face: face.face,
        thickness: cutter.thickness[face.face],
        frame,
        half_edges: face.half_edges.clone(),
        reference: face.corners.clone(),
        front,
        back,
        blank,
        begins,
        ends,
        inner,
        holes: Vec::new(),
    };
    Shaped { plate, straight, unrelieved }
}

fn is_convex(face: &FlatFace, i: usize) -> bool {
    face.along[face.before(i)].perp_dot(face.along[i]) > 0.0
}

/// The inward unit bisector of a corner.
fn bisector(face: &FlatFace, i: usize) -> DVec2 {
    (face.along[face.before(i)].perp() + face.along[i].perp()).normalize_or_zero()
}

/// The share of a side that the relief of one of its ends may take.
const RELIEF_SHARE: f64 = 0.45;

/// Where the relief of a corner cuts, along its bisector; `None` without relief, at reflex corners,
/// and where it would take too much of a side.
fn relief_level(
    face: &FlatFace,
    i: usize,
    (front, back, blank): (&[DVec2], &[DVec2], &[DVec2]),
    relief: f64,
) -> Option<f64> {
    if relief <= 0.0 || !is_convex(face, i) {
        return None;
    }
    let inwards = bisector(face, i);
    let outlines = [front, back, blank];
    let level = front[i].dot(inwards).max(back[i].dot(inwards)) + relief;
    let n = face.len();
    let fits = outlines.into_iter().all(|outline| {
        let [p, q] = relieved(face, i, outline[i], level);
        let (before, after) = (outline[face.before(i)], outline[(i + 1) % n]);
        p.distance(outline[i]) < RELIEF_SHARE * outline[i].distance(before)
            && q.distance(outline[i]) < RELIEF_SHARE * outline[i].distance(after)
    });
    fits.then_some(level)
}

/// The two corners that take the place of one.
fn relieved(face: &FlatFace, i: usize, corner: DVec2, level: f64) -> [DVec2; 2] {
    let inwards = bisector(face, i);
    let rest = level - corner.dot(inwards);
    let (u, v) = (face.along[face.before(i)], face.along[i]);
    [corner + u * (rest / u.dot(inwards)), corner + v * (rest / v.dot(inwards))]
}
