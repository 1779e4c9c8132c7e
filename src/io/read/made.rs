//! What a file says that the step before made.

use super::raw::RawMesh;
use crate::mesh::{EdgeId, FaceId, Mesh, SplitVertex, VertexId};
use crate::select::NewElements;

/// The elements that an OBJ file marks as made; `None` when it marks none. What is no edge of the
/// mesh is left out: a mark is no shape.
pub(super) fn of_raw(raw: &RawMesh, mesh: &Mesh, splits: &[SplitVertex]) -> Option<NewElements> {
    let copies = |v: u32| {
        let v = VertexId::new(v as usize);
        let added = splits.iter().filter(move |s| s.given == v).map(|s| s.added);
        std::iter::once(v)
            .chain(added)
            .filter(|&v| v.index() < mesh.vertex_slots() && mesh.has_vertex(v))
    };
    let edge = |&[a, b]: &[u32; 2]| -> Option<EdgeId> {
        copies(a).find_map(|a| copies(b).find_map(|b| mesh.edge_between(a, b)))
    };
    let mut made = NewElements {
        vertices: raw.made.vertices.iter().flat_map(|&v| copies(v)).collect(),
        edges: raw.made.edges.iter().filter_map(edge).collect(),
        strip: raw.made.strip.iter().filter_map(edge).collect(),
        faces: Vec::new(),
    };
    let ends = raw.groups.iter().skip(1).map(|run| run.first_face).chain([raw.ends.len()]);
    for (run, end) in raw.groups.iter().zip(ends).filter(|(run, _)| run.is_made) {
        made.faces.extend((run.first_face..end).map(FaceId::new));
    }
    made.vertices.sort_unstable();
    made.vertices.dedup();
    for edges in [&mut made.edges, &mut made.strip] {
        edges.sort_unstable();
        edges.dedup();
    }
    (made != NewElements::default()).then_some(made)
}
