//! The model as triangles for the page.

use std::collections::BTreeMap;

use glam::DVec3;
use serde_json::{Value, json};

use crate::geom::triangulate;
use crate::mesh::{FaceId, Mesh};
use crate::net::Net;

/// Triangles that a browser turns without effort.
const MOST_TRIANGLES: usize = 60_000;

/// From the middle of the model on the page to its farthest corner.
const RADIUS: f64 = 1000.0;

/// Positions, triangles with their faces, the piece of each face, and the two ends of every seam in
/// space; `None` for models that are too large or have other faces than the net.
pub(super) fn model_json(net: &Net, mesh: &Mesh) -> Option<Value> {
    let (low, high) = mesh.bounds()?;
    let centre = low.midpoint(high);
    let radius = mesh.vertices().map(|v| mesh.position(v).distance(centre)).fold(0.0, f64::max);
    let place = |p: DVec3| {
        let q = ((p - centre) / radius * RADIUS).round();
        [q.x as i64, q.y as i64, q.z as i64]
    };
    let (mut points, mut triangles, mut of_triangle, mut of_face) =
        (vec![], vec![], vec![], vec![]);
    let mut ends: BTreeMap<(usize, usize, usize), [[i64; 3]; 2]> = BTreeMap::new();
    for (p, piece) in net.pieces.iter().enumerate() {
        for face in &piece.faces {
            let id = FaceId::new(face.face);
            let corners = mesh.has_face(id).then(|| mesh.face_positions(id))?;
            if corners.len() != face.polygon.len() {
                return None;
            }
            let first = points.len() / 3;
            points.extend(corners.iter().flat_map(|&c| place(c)));
            for triangle in triangulate(&face.polygon) {
                triangles.extend(triangle.map(|i| first + i));
                of_triangle.push(of_face.len());
            }
            of_face.push(p);
            let n = face.vertices.len();
            for i in 0..n {
                let j = (i + 1) % n;
                let key = (face.face, face.vertices[i], face.vertices[j]);
                ends.insert(key, [place(corners[i]), place(corners[j])]);
            }
        }
    }
    if of_triangle.len() > MOST_TRIANGLES {
        return None;
    }
    let seams = net.seams.iter().map(|seam| {
        let [a, b] = seam.edge;
        let side = |k: usize| {
            let face = seam.sides[k].face;
            ends.get(&(face, a, b)).or_else(|| ends.get(&(face, b, a)))
        };
        side(0).or_else(|| side(1)).map_or(Value::Null, |ends| json!(ends.as_flattened()))
    });
    let seams: Vec<Value> = seams.collect();
    Some(json!({
        "points": points, "triangles": triangles, "face": of_triangle, "piece": of_face, "seams": seams,
    }))
}
