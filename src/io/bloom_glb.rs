//! A net that folds itself up, as an animated scene.
//!
//! Every piece is a node, and every face hangs as a node on the one that carries it, with its
//! origin on their fold; a fold is a rotation track. The file holds single precision, whose errors
//! would add up along a long strip: so each rotation is chosen for what its carrier has become by
//! rounding, and each translation likewise.

use glam::{DQuat, DVec2, DVec3};

use super::write::glb::{
    GlbMaterialId, GlbNode, GlbNodeId, GlbScene, GlbSurface, GlbTrack, GlbValues,
};
use crate::bloom::{Bloom, END, FOLDING, Leaf, MOVING, Pose};
use crate::geom::triangulate;

/// Colours of pieces, in turn.
const COLOURS: [[u8; 3]; 6] = [
    [234, 225, 211],
    [136, 170, 206],
    [233, 178, 112],
    [150, 196, 150],
    [222, 140, 130],
    [178, 160, 208],
];
const LINE: [u8; 3] = [40, 38, 36];

/// The scene of a bloom: flat at 0 s, closed at its end.
///
/// # Example
/// ```
/// use kerfold::bloom::Bloom;
/// use kerfold::io::{bloom_glb::bloom_scene, glb::glb_bytes};
/// use kerfold::prelude::*;
///
/// let net = unfold(
///     &kerfold::shape::cube(40.0),
///     &Seams::Free,
///     &UnfoldParams::default(),
///     &MeshSource { scale: 1.0, split_vertices: &[] },
///     &Silent,
/// )?;
/// let bloom = Bloom::new(&net, &[], |_| None);
/// let bytes = glb_bytes(&bloom_scene(&bloom, "cube"), "my program")?;
/// assert!(bytes.starts_with(b"glTF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn bloom_scene(bloom: &Bloom<'_>, name: &str) -> GlbScene {
    let mut scene = GlbScene::new(name);
    let line = scene.add_material("edges", LINE, 1.0);
    let used = bloom.tree().net().pieces.len().min(COLOURS.len());
    let colours = COLOURS[..used]
        .iter()
        .zip(1..)
        .map(|(&colour, i)| scene.add_material(format!("piece {i}"), colour, 1.0));
    let colours: Vec<GlbMaterialId> = colours.collect();
    let mut made: Vec<NewElements> = Vec::new();
    for (i, leaf) in bloom.tree().leaves().iter().enumerate() {
        let material = colours[leaf.piece % colours.len()];
        let origin = origin(bloom, leaf);
        let carrier = match &leaf.hinge {
            None => piece_node(&mut scene, bloom, i, origin),
            Some(hinge) => made[hinge.parent],
        };
        let next = face_node(&mut scene, bloom, i, &carrier, origin, [material, line]);
        made.push(next);
    }
    scene
}

/// A node as single precision has made it.
#[derive(Clone, Copy)]
struct NewElements {
    node: GlbNodeId,
    /// Where its origin lies in the flat frame of its piece.
    flat: DVec2,
    /// Its pose in space when closed.
    closed: Pose,
}

/// The point about which a face turns.
fn origin(bloom: &Bloom<'_>, leaf: &Leaf) -> DVec2 {
    match &leaf.hinge {
        Some(hinge) => hinge.line[0].midpoint(hinge.line[1]),
        None => bloom.tree().flat(leaf).polygon.first().copied().unwrap_or_default(),
    }
}

/// The node that moves a whole piece, its origin at that of its root face.
fn piece_node(scene: &mut GlbScene, bloom: &Bloom<'_>, place: usize, origin: DVec2) -> NewElements {
    let leaf = &bloom.tree().leaves()[place];
    let [flat, closed] = [bloom.flat()[place], bloom.closed()[place]].map(|pose| Pose {
        rotation: single_turn(pose.rotation),
        translation: single(pose.lift(origin)),
    });
    let node = scene.add_node(GlbNode {
        name: bloom.tree().net().pieces[leaf.piece].id.to_string(),
        parent: None,
        translation: flat.translation,
        rotation: flat.rotation,
        surface: None,
        extras: Vec::new(),
    });
    let times = vec![0.0, MOVING[0], MOVING[1], END];
    let places = [flat, flat, closed, closed];
    let turns = GlbValues::Rotations(places.iter().map(|p| p.rotation).collect());
    scene.add_track(GlbTrack { node, times: times.clone(), values: turns });
    let shifts = GlbValues::Translations(places.iter().map(|p| p.translation).collect());
    scene.add_track(GlbTrack { node, times, values: shifts });
    NewElements {
        node,
        flat: origin,
        closed: Pose { rotation: closed.rotation.normalize(), ..closed },
    }
}

fn face_node(
    scene: &mut GlbScene,
    bloom: &Bloom<'_>,
    place: usize,
    carrier: &NewElements,
    origin: DVec2,
    [material, line]: [GlbMaterialId; 2],
) -> NewElements {
    let leaf = &bloom.tree().leaves()[place];
    let face = bloom.tree().flat(leaf);
    let translation = single((origin - carrier.flat).extend(0.0));
    // What the carrier lacks after rounding, the face makes up for.
    let goal = bloom.closed()[place].rotation;
    let is_turning = leaf.hinge.as_ref().is_some_and(|h| h.angle != 0.0);
    let turn = if is_turning {
        single_turn(carrier.closed.rotation.inverse() * goal)
    } else {
        DQuat::IDENTITY
    };
    let n = face.polygon.len() as u32;
    let node = scene.add_node(GlbNode {
        name: format!("F{:03}", face.face),
        parent: Some(carrier.node),
        translation,
        rotation: DQuat::IDENTITY,
        surface: Some(GlbSurface {
            points: face.polygon.iter().map(|&p| (p - origin).extend(0.0)).collect(),
            triangles: triangulate(&face.polygon)
                .into_iter()
                .map(|t| t.map(|i| i as u32))
                .collect(),
            material: Some(material),
            lines: (0..n).map(|i| [i, (i + 1) % n]).collect(),
            line_material: Some(line),
        }),
        extras: Vec::new(),
    });
    if is_turning {
        let values = vec![DQuat::IDENTITY, DQuat::IDENTITY, turn, turn];
        let times = vec![0.0, FOLDING[0], FOLDING[1], END];
        scene.add_track(GlbTrack { node, times, values: GlbValues::Rotations(values) });
    }
    let closed = Pose {
        rotation: (carrier.closed.rotation * turn.normalize()).normalize(),
        translation: carrier.closed.transform(translation),
    };
    NewElements { node, flat: carrier.flat + translation.truncate(), closed }
}

fn single(p: DVec3) -> DVec3 {
    p.as_vec3().as_dvec3()
}

/// A rotation of single precision, by the shorter way.
fn single_turn(turn: DQuat) -> DQuat {
    let turn = if turn.w < 0.0 { -turn } else { turn };
    DQuat::from_array(turn.normalize().to_array().map(|x| f64::from(x as f32)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{FaceId, Mesh};
    use crate::progress::Silent;
    use crate::shape::{SolidName, SolidParams, solid};
    use crate::unfold::{MeshSource, Seams, UnfoldParams, unfold};

    /// Where every face's corners are after so many seconds, as a reader of the file would have it,
    /// in single precision as stored.
    fn played(scene: &GlbScene, seconds: f64) -> Vec<(String, Vec<DVec3>)> {
        let mut local: Vec<Pose> = scene
            .nodes()
            .iter()
            .map(|n| Pose { rotation: n.rotation, translation: n.translation })
            .collect();
        for track in scene.tracks() {
            let after =
                track.times.iter().position(|&t| t >= seconds).unwrap_or(track.times.len() - 1);
            let before = after.saturating_sub(1);
            let span = track.times[after] - track.times[before];
            let share = if span > 0.0 {
                ((seconds - track.times[before]) / span).clamp(0.0, 1.0)
            } else {
                1.0
            };
            let pose = &mut local[track.node.index()];
            match &track.values {
                GlbValues::Rotations(v) => {
                    pose.rotation = v[before].normalize().slerp(v[after].normalize(), share)
                }
                GlbValues::Translations(v) => pose.translation = v[before].lerp(v[after], share),
            }
        }
        let mut world: Vec<Pose> = Vec::new();
        let mut faces = Vec::new();
        for (node, local) in scene.nodes().iter().zip(&local) {
            let pose = node.parent.map_or(*local, |p| world[p.index()].compose(local));
            world.push(pose);
            if let Some(surface) = &node.surface {
                faces.push((
                    node.name.clone(),
                    surface.points.iter().map(|&p| pose.transform(single(p))).collect(),
                ));
            }
        }
        faces
    }

    fn blooming(mesh: &Mesh) -> (GlbScene, f64) {
        let source = MeshSource { scale: 1.0, split_vertices: &[] };
        let net = unfold(mesh, &Seams::Free, &UnfoldParams::default(), &source, &Silent)
            .expect("a solid unfolds");
        let bloom = Bloom::new(&net, &[], |f| Some(mesh.face_positions(FaceId::new(f))));
        (bloom_scene(&bloom, "test"), net.proof.refold_mm)
    }

    #[test]
    fn the_animation_begins_flat_and_ends_closed_to_a_millionth_of_the_size() {
        for name in ["cube", "dodecahedron", "soccer-ball", "geodesic-12", "antiprism-17"] {
            let name: SolidName = name.parse().expect("a known solid");
            let mesh = solid(&SolidParams { name, edge: None, size: None }).expect("a solid");
            let size = crate::measure::size(&mesh).length();
            let (scene, refold) = blooming(&mesh);
            let flat = played(&scene, 0.0);
            let level = flat[0].1[0].z;
            assert!(flat.iter().flat_map(|f| &f.1).all(|p| (p.z - level).abs() < 1e-6 * size));
            let half = played(&scene, (FOLDING[0] + FOLDING[1]) / 2.0);
            assert!(half.iter().flat_map(|f| &f.1).any(|p| (p.z - level).abs() > 1e-2 * size));
            let closed = played(&scene, END);
            assert_eq!(closed.len(), mesh.face_count());
            let mut worst: f64 = 0.0;
            for (name, corners) in closed {
                let face: usize = name[1..].parse().expect("a number");
                let there = mesh.face_positions(FaceId::new(face));
                worst = corners.iter().zip(&there).fold(worst, |w, (p, q)| w.max(p.distance(*q)));
            }
            assert!(worst < 1e-6 * size + refold, "{worst:e} of {size}");
        }
    }
}
