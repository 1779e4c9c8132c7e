//! From merged to simple: every vertex of higher valence divided into vertices of valence 3 at the
//! same point.

use super::polytope::{Polygons, Polytope};

/// Gives each vertex where k > 3 faces meet k − 2 numbers, as if the face with the lowest number
/// among them had been moved outwards by infinitely little less than the others: its corner becomes
/// a chain of k − 3 edges, the other faces keep one edge to it.
pub(super) fn split(polytope: Polytope) -> Polytope {
    let Polytope { mut vertices, half_spaces, faces, interior } = polytope;
    // No vertex has fewer than three faces, so the sum shows it.
    if faces.corners().len() == 3 * vertices.len() {
        return Polytope { vertices, half_spaces, faces, interior };
    }
    let stars = stars(&faces, vertices.len());
    // The number of the first vertex beyond the old one at each vertex.
    let mut added = Vec::with_capacity(stars.len());
    for (v, star) in stars.iter().enumerate() {
        added.push(vertices.len() as u32);
        let position = vertices[v];
        vertices.extend(std::iter::repeat_n(position, star.len() - 3));
    }
    let mut divided = Polygons::with_capacity(faces.len(), faces.corners().len() * 2);
    let mut run = Vec::new();
    for (face, polygon) in faces.iter().enumerate() {
        run.clear();
        for &v in polygon {
            chain(
                &stars[v as usize],
                face as u32,
                |i| if i == 0 { v } else { added[v as usize] + i - 1 },
                &mut run,
            );
        }
        divided.push(run.iter().copied());
    }
    Polytope { vertices, half_spaces, faces: divided, interior }
}

/// The corners that a face gets at a vertex. The star begins with its lowest face 0; vertex i joins
/// faces 0, i + 1 and i + 2.
fn chain(star: &[u32], face: u32, vertex: impl Fn(u32) -> u32, run: &mut Vec<u32>) {
    let k = star.len() as u32;
    let place = star.iter().position(|&f| f == face).expect("the face is at its corner") as u32;
    // Within a face the corners run from the side of the next face around the vertex to that of the
    // one before.
    match place {
        0 => run.extend((0..k - 2).map(vertex)),
        1 => run.push(vertex(0)),
        _ if place == k - 1 => run.push(vertex(k - 3)),
        _ => run.extend([vertex(place - 1), vertex(place - 2)]),
    }
}

/// For each vertex the faces around it, counter-clockwise seen from outside, beginning with the
/// lowest.
pub(super) fn stars(faces: &Polygons, vertices: usize) -> Vec<Vec<u32>> {
    // (vertex after, vertex before, face) for each corner.
    let mut corners: Vec<Vec<(u32, u32, u32)>> = vec![Vec::new(); vertices];
    for (face, polygon) in faces.iter().enumerate() {
        let n = polygon.len();
        for (i, &v) in polygon.iter().enumerate() {
            corners[v as usize].push((polygon[(i + 1) % n], polygon[(i + n - 1) % n], face as u32));
        }
    }
    let turn = |mut around: Vec<(u32, u32, u32)>| {
        let Some(&(_, mut before, first)) = around.first() else { return Vec::new() };
        around.sort_unstable();
        let mut star = vec![first];
        while star.len() < around.len() {
            // The next face counter-clockwise leaves the vertex where this one came in.
            let Ok(i) = around.binary_search_by_key(&before, |c| c.0) else { break };
            before = around[i].1;
            star.push(around[i].2);
        }
        star
    };
    corners.into_iter().map(turn).collect()
}
