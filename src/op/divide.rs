//! Faces that come twice to a vertex, as caps do whose outline touches itself: no file of polygons
//! holds one, so they become several that come to each vertex once.
//!
//! Parts that only touch at the vertex are parted there, by a self-loop of length zero that no file
//! holds; a bridge to a hole, or a hole that touches the outline, is cut across by diagonals.

use glam::DVec2;

use crate::geom::polygon::signed_area;
use crate::geom::{Frame, Plane, triangulate};
use crate::mesh::{Corner, FaceId, HalfEdgeId, Mesh, VertexId};
use crate::select::NewElements;

/// Divides all faces that come twice to a vertex, as far as that is possible; parts of a new face
/// are new. Returns how many edges that took.
pub(super) fn divide_repeated(mesh: &mut Mesh, made: &mut NewElements) -> usize {
    let mut seen = Vec::new();
    let mut open: Vec<FaceId> = mesh.faces().filter(|&f| comes_twice(mesh, f, &mut seen)).collect();
    // Every edge leaves fewer corners in a face, so this ends; what cannot be divided stays.
    let mut count = 0;
    while let Some(f) = open.pop() {
        let Some([i, j]) = dividing(mesh, f) else { continue };
        let corners: Vec<HalfEdgeId> = mesh.face_half_edges(f).collect();
        let Ok(e) = mesh.insert_edge(Corner::At(corners[i]), Corner::At(corners[j])) else {
            continue;
        };
        count += 1;
        let parts = mesh.edge_faces(e);
        if made.faces.contains(&f) {
            made.faces.extend(parts.iter().filter(|&&part| part != f));
        }
        open.extend(parts.into_iter().filter(|&part| comes_twice(mesh, part, &mut seen)));
    }
    made.faces.sort_unstable();
    count
}

/// Faces with more corners are sorted to find the same one twice.
const FEW_CORNERS: usize = 16;

/// Whether a face comes twice to a vertex; corners that a self-loop brings do not count. `seen` is
/// room to work in.
fn comes_twice(mesh: &Mesh, f: FaceId, seen: &mut Vec<VertexId>) -> bool {
    let straight = mesh.face_half_edges(f).filter(|&h| mesh.origin(h) != mesh.target(h));
    seen.clear();
    seen.extend(straight.map(|h| mesh.origin(h)));
    if seen.len() > FEW_CORNERS {
        return repeats(seen) > 0;
    }
    (1..seen.len()).any(|i| seen[..i].contains(&seen[i]))
}

/// How often a walk comes to a vertex where it was before.
fn repeats(walk: &[VertexId]) -> usize {
    let mut sorted = walk.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).filter(|pair| pair[0] == pair[1]).count()
}

/// The corners, by their places in the face, between which an edge divides a face best.
fn dividing(mesh: &Mesh, f: FaceId) -> Option<[usize; 2]> {
    let vertices: Vec<VertexId> = mesh.face_vertices(f).collect();
    let points = mesh.face_positions(f);
    let plane = mesh.plane(f).or_else(|| Plane::newell(&points))?;
    let frame = Frame::on_plane(&plane);
    let flat: Vec<DVec2> = points.iter().map(|&p| frame.flatten(p)).collect();
    touching(&vertices, &flat).or_else(|| diagonal(mesh, &vertices, &flat))
}

/// The places from `i` up to `j` and those from `j` on around to `i`.
fn parts<T: Copy>(all: &[T], i: usize, j: usize) -> [Vec<T>; 2] {
    [all[i..j].to_vec(), [&all[j..], &all[..i]].concat()]
}

/// Two visits to one vertex between which lies a part of its own.
fn touching(vertices: &[VertexId], flat: &[DVec2]) -> Option<[usize; 2]> {
    let n = vertices.len();
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| [i, j]));
    let is_own = |part: &Vec<DVec2>| part.len() > 2 && signed_area(part) > 0.0;
    pairs
        .filter(|&[i, j]| vertices[i] == vertices[j])
        .find(|&[i, j]| parts(flat, i, j).iter().all(is_own))
}

/// The diagonal that leaves the fewest repeated visits, where it leaves fewer; one between vertices
/// that an edge joins already only for want of another.
fn diagonal(mesh: &Mesh, vertices: &[VertexId], flat: &[DVec2]) -> Option<[usize; 2]> {
    let n = vertices.len();
    let is_inner = |&[i, j]: &[usize; 2]| j - i > 1 && j - i < n - 1 && vertices[i] != vertices[j];
    let left = |[i, j]: [usize; 2]| {
        let [mut first, mut second] = parts(vertices, i, j);
        first.push(vertices[j]);
        second.push(vertices[i]);
        repeats(&first) + repeats(&second)
    };
    let sides = triangulate(flat).into_iter().flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let inner = sides.map(|[a, b]| [a.min(b), a.max(b)]).filter(is_inner);
    let is_double = |[i, j]: [usize; 2]| mesh.edge_between(vertices[i], vertices[j]).is_some();
    inner
        .map(|ends| (left(ends), is_double(ends), ends))
        .min()
        .filter(|best| best.0 < repeats(vertices))
        .map(|best| best.2)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    fn named(ids: &[usize], points: &[[f64; 2]]) -> (Vec<VertexId>, Vec<DVec2>) {
        let names = ids.iter().map(|&i| VertexId::new(i)).collect();
        (names, ids.iter().map(|&i| DVec2::from(points[i])).collect())
    }

    #[test]
    fn squares_that_touch_in_a_corner_are_parted_there() {
        let points =
            [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [4.0, 2.0], [4.0, 4.0], [2.0, 4.0], [0.0, 2.0]];
        let (names, flat) = named(&[0, 1, 2, 3, 4, 5, 2, 6], &points);
        assert_eq!(touching(&names, &flat), Some([2, 6]));
        let sizes = parts(&names, 2, 6).map(|part| (part.len(), repeats(&part)));
        assert_eq!((repeats(&names), sizes), (1, [(4, 0), (4, 0)]));
    }

    #[test]
    fn a_hole_that_hangs_on_a_corner_is_cut_across() {
        let points = [[0.0, 0.0], [9.0, 0.0], [9.0, 9.0], [0.0, 9.0], [3.0, 6.0], [6.0, 3.0]];
        let (names, flat) = named(&[0, 1, 2, 3, 0, 4, 5], &points);
        assert_eq!(touching(&names, &flat), None, "the triangle runs the other way");
        let all = points.map(|[x, y]| DVec3::new(x, y, 0.0));
        let mesh = Mesh::from_faces(all, [[0, 3, 4], [1, 2, 5]]).expect("vertices");
        let [i, j] = diagonal(&mesh, &names, &flat).expect("a diagonal");
        let [mut first, mut second] = parts(&names, i, j);
        first.push(names[j]);
        second.push(names[i]);
        assert_eq!((repeats(&first), repeats(&second)), (0, 0), "{i} {j}");
    }
}
