//! Is every face, and every side of an edge, as large as on the mesh?

use glam::{DVec2, DVec3};

use super::{LENGTH, LENGTH_OF_SIZE, ProofError, exceeds};
use crate::geom::fit_plane;
use crate::mesh::{EdgeId, FaceId, Mesh};
use crate::net::Net;

/// Up to so many corners every distance is measured; above, those of each corner to the next two
/// and to the far side.
const ALL_PAIRS: usize = 32;

/// The largest difference of a distance between two corners of a face.
pub(super) fn check(mesh: &Mesh, net: &Net, size: f64) -> Result<f64, ProofError> {
    check_partners(mesh, net, size)?;
    let mut worst: f64 = 0.0;
    let limit = LENGTH_OF_SIZE * size;
    for flat in net.pieces.iter().flat_map(|piece| &piece.faces) {
        let points = mesh.face_positions(FaceId::new(flat.face));
        let limit = limit + bend(&points);
        let by = distortion(&points, &flat.polygon);
        if exceeds(by, limit) {
            return Err(ProofError::Distorted { face: flat.face, by, limit });
        }
        worst = worst.max(by);
    }
    Ok(worst)
}

/// How much nearer two corners of a face may come when it is laid flat: that its corners lie off
/// their plane takes that much of its distances, the most where sides are short. Nothing of a
/// planar face.
fn bend(points: &[DVec3]) -> f64 {
    let Some(plane) = Some(points).filter(|p| p.len() > 3).and_then(fit_plane) else { return 0.0 };
    let off = points.iter().map(|&p| plane.signed_distance(p).abs()).fold(0.0, f64::max);
    let sides = points.iter().zip(points.iter().cycle().skip(1));
    let shortest = sides.map(|(p, q)| p.distance(*q)).fold(f64::INFINITY, f64::min);
    (16.0 * off * off / shortest).min(4.0 * off)
}

fn distortion(points: &[DVec3], flat: &[DVec2]) -> f64 {
    let n = points.len();
    let by = |i: usize, j: usize| (points[i].distance(points[j]) - flat[i].distance(flat[j])).abs();
    let others = |i: usize| -> Vec<usize> {
        if n <= ALL_PAIRS {
            (0..i).collect()
        } else {
            vec![(i + 1) % n, (i + 2) % n, (i + n / 2) % n, (i + n / 3) % n]
        }
    };
    (0..n).flat_map(|i| others(i).into_iter().map(move |j| by(i, j))).fold(0.0, larger)
}

/// The larger of two numbers; NaN wins.
fn larger(a: f64, b: f64) -> f64 {
    if a.total_cmp(&b).is_gt() { a } else { b }
}

/// Both sides of every seam, and every fold and rim, as long as the edge of the mesh.
fn check_partners(mesh: &Mesh, net: &Net, size: f64) -> Result<(), ProofError> {
    let length = |[a, b]: [DVec2; 2]| a.distance(b);
    let true_length = |edge: usize| {
        let [a, b] = mesh.edge_positions(EdgeId::new(edge));
        a.distance(b)
    };
    let seams = net
        .seams
        .iter()
        .map(|s| (s.id.0, [length(s.sides[0].segment), length(s.sides[1].segment), s.length]));
    let folds = net.folds.iter().map(|f| (f.id.0, [length(f.segment); 3]));
    for (edge, lengths) in seams.chain(folds) {
        let on_mesh = true_length(edge);
        let limit = LENGTH * on_mesh + LENGTH_OF_SIZE * size;
        let by = lengths.into_iter().map(|l| (l - on_mesh).abs()).fold(0.0, larger);
        if exceeds(by, limit) {
            let ends = mesh.edge_vertices(EdgeId::new(edge)).map(|v| v.index());
            return Err(ProofError::Partners { edge, ends, by, limit });
        }
    }
    Ok(())
}
