//! From one element to all that are like it: what a double click marks.

use std::collections::{BTreeSet, HashMap};

use glam::DVec3;

use super::{ElementKind, Selection};
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, Mesh, VertexId};
use crate::seam::edge_symmetries;

/// In which way elements are like one another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Likeness {
    /// Edges that run in the same direction, faces that look the same way, vertices with as many
    /// edges; a condition that holds on another mesh, too.
    Direction,
    /// Edges that go on straight through vertices with an even number of edges, and strips of faces
    /// with four sides for a face; a vertex is alone.
    Loop,
    /// Edges across from one another in faces with an even number of sides, as the rungs of a
    /// ladder; for a face and a vertex as [`Self::Loop`].
    Strip,
    /// Wherever a symmetry of the mesh, turned or mirrored, carries the element.
    Symmetric,
}

/// Meshes with more edges are not searched for symmetries: each may be carried to any other.
const MOST_EDGES: usize = 20_000;

/// All elements that are like the given one, itself among them, as a selection. An id that the mesh
/// does not have selects nothing: `None`.
pub fn alike(mesh: &Mesh, kind: ElementKind, id: usize, likeness: Likeness) -> Option<Selection> {
    match kind {
        ElementKind::Vertex => {
            let v = Some(VertexId::new(id)).filter(|&v| mesh.has_vertex(v))?;
            match likeness {
                Likeness::Direction => format!("valence={}", mesh.valence(v)).parse().ok(),
                Likeness::Symmetric => of(kind, orbit(mesh, kind, id)),
                _ => of(kind, [id]),
            }
        }
        ElementKind::Edge => {
            let e = Some(EdgeId::new(id)).filter(|&e| mesh.has_edge(e))?;
            match likeness {
                Likeness::Direction => {
                    let [a, b] = mesh.edge_positions(e);
                    direction(b - a, true).map_or_else(
                        || of(kind, [id]),
                        |direction| format!("along={direction}").parse().ok(),
                    )
                }
                Likeness::Loop => of(kind, walk(mesh, e, |h| straight_on(mesh, h))),
                Likeness::Strip => of(kind, walk(mesh, e, |h| across(mesh, h))),
                Likeness::Symmetric => of(kind, orbit(mesh, kind, id)),
            }
        }
        ElementKind::Face => {
            let f = Some(FaceId::new(id)).filter(|&f| mesh.has_face(f) && !mesh.is_hole(f))?;
            match likeness {
                Likeness::Direction => {
                    let normal = mesh.plane(f).and_then(|plane| direction(plane.normal(), false));
                    normal.map_or_else(
                        || of(kind, [id]),
                        |normal| format!("normal={normal}").parse().ok(),
                    )
                }
                Likeness::Symmetric => of(kind, orbit(mesh, kind, id)),
                _ => of(kind, face_strip(mesh, f)),
            }
        }
    }
}

fn of(kind: ElementKind, ids: impl IntoIterator<Item = usize>) -> Option<Selection> {
    let mut ids: Vec<usize> = ids.into_iter().collect();
    ids.sort_unstable();
    ids.dedup();
    match kind {
        ElementKind::Vertex => Selection::of_vertices(ids.into_iter().map(VertexId::new)),
        ElementKind::Edge => Selection::of_edges(ids.into_iter().map(EdgeId::new)),
        ElementKind::Face => Selection::of_faces(ids.into_iter().map(FaceId::new)),
    }
}

/// A direction as it is typed: an axis by its name, others by numbers that are far finer than the
/// degree by which selections differ. A line looks both ways, so it may be turned.
fn direction(vector: DVec3, is_line: bool) -> Option<String> {
    let unit = vector.try_normalize()?;
    let text = |x: f64| {
        let rounded = (x * 1e4).round() / 1e4;
        if rounded == 0.0 { "0".to_owned() } else { format!("{rounded}") }
    };
    let unit =
        if is_line && unit.abs().max_element() == -unit.min_element() { -unit } else { unit };
    let parts = unit.to_array().map(text);
    let words: Vec<&str> = parts.iter().map(String::as_str).collect();
    Some(match words[..] {
        ["1", "0", "0"] => "x".to_owned(),
        ["0", "1", "0"] => "y".to_owned(),
        ["0", "0", "1"] => "z".to_owned(),
        ["-1", "0", "0"] => "-x".to_owned(),
        ["0", "-1", "0"] => "-y".to_owned(),
        ["0", "0", "-1"] => "-z".to_owned(),
        _ => parts.join(","),
    })
}

/// The edges that a step leads to from both half-edges of one, until it ends or comes back.
fn walk(mesh: &Mesh, e: EdgeId, step: impl Fn(HalfEdgeId) -> Option<HalfEdgeId>) -> Vec<usize> {
    let mut found = BTreeSet::from([e.index()]);
    for start in e.half_edges() {
        let mut h = start;
        for _ in 0..mesh.edge_count() {
            let Some(next) = step(h).filter(|next| next.edge() != e) else { break };
            found.insert(next.edge().index());
            h = next;
        }
    }
    found.into_iter().collect()
}

/// The half-edge that goes on straight at the target, where as many edges lie on either side.
fn straight_on(mesh: &Mesh, h: HalfEdgeId) -> Option<HalfEdgeId> {
    let around: Vec<HalfEdgeId> = mesh.outgoing(mesh.target(h)).collect();
    let back = around.iter().position(|&out| out == h.twin())?;
    let half = around.len().is_multiple_of(2).then_some(around.len() / 2)?;
    Some(around[(back + half) % around.len()])
}

/// The half-edge of the next face that lies across from this one.
fn across(mesh: &Mesh, h: HalfEdgeId) -> Option<HalfEdgeId> {
    let face = mesh.face(h);
    let sides = mesh.sides(face);
    if mesh.is_hole(face) || sides % 2 == 1 {
        return None;
    }
    Some((0..sides / 2).fold(h, |h, _| mesh.next(h)).twin())
}

/// The faces with four sides that follow a face across both pairs of its sides.
fn face_strip(mesh: &Mesh, f: FaceId) -> Vec<usize> {
    let mut found = BTreeSet::from([f.index()]);
    if mesh.sides(f) != 4 {
        return vec![f.index()];
    }
    for start in mesh.face_half_edges(f) {
        let mut h = start.twin();
        for _ in 0..mesh.face_count() {
            let face = mesh.face(h);
            if mesh.is_hole(face) || mesh.sides(face) != 4 || face == f {
                break;
            }
            found.insert(face.index());
            h = mesh.next(mesh.next(h)).twin();
        }
    }
    found.into_iter().collect()
}

/// Where the symmetries of the mesh carry an element: it is known by the edges at it.
fn orbit(mesh: &Mesh, kind: ElementKind, id: usize) -> Vec<usize> {
    if mesh.edge_count() > MOST_EDGES {
        return vec![id];
    }
    let edges_of = |id: usize| -> Vec<usize> {
        let mut edges: Vec<usize> = match kind {
            ElementKind::Vertex => {
                mesh.outgoing(VertexId::new(id)).map(|h| h.edge().index()).collect()
            }
            ElementKind::Edge => vec![id],
            ElementKind::Face => {
                mesh.face_half_edges(FaceId::new(id)).map(|h| h.edge().index()).collect()
            }
        };
        edges.sort_unstable();
        edges
    };
    let all: Vec<usize> = match kind {
        ElementKind::Vertex => mesh.vertices().map(VertexId::index).collect(),
        ElementKind::Edge => mesh.edges().map(EdgeId::index).collect(),
        ElementKind::Face => mesh.faces().map(FaceId::index).collect(),
    };
    let known: HashMap<Vec<usize>, usize> = all.into_iter().map(|i| (edges_of(i), i)).collect();
    let own = edges_of(id);
    let carried = edge_symmetries(mesh).into_iter().filter_map(|image| {
        let mut edges: Vec<usize> = own.iter().map(|&e| image[EdgeId::new(e)].index()).collect();
        edges.sort_unstable();
        known.get(&edges).copied()
    });
    let found: BTreeSet<usize> = carried.chain([id]).collect();
    found.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::select::Context;
    use crate::shape::{SolidParams, cube, solid};

    fn named(name: &str) -> Mesh {
        let name = name.parse().expect("a solid");
        solid(&SolidParams { name, edge: None, size: None }).expect("a solid")
    }

    fn count(mesh: &Mesh, kind: ElementKind, id: usize, likeness: Likeness) -> usize {
        let selection = alike(mesh, kind, id, likeness).expect("an element");
        // What a click writes must be readable.
        let selection: Selection = selection.to_string().parse().expect("a selection");
        let context = Context::of(mesh);
        let (ids, count): (Vec<usize>, usize) = match kind {
            ElementKind::Vertex => {
                let found = selection.vertices(&context).expect("vertices");
                (found.iter().map(|v| v.index()).collect(), found.len())
            }
            ElementKind::Edge => {
                let found = selection.edges(&context).expect("edges");
                (found.iter().map(|e| e.index()).collect(), found.len())
            }
            ElementKind::Face => {
                let found = selection.faces(&context).expect("faces");
                (found.iter().map(|f| f.index()).collect(), found.len())
            }
        };
        assert!(ids.contains(&id));
        count
    }

    #[test]
    fn what_is_like_an_element_of_a_cube() {
        use ElementKind::{Edge, Face, Vertex};
        use Likeness::{Direction, Loop, Strip, Symmetric};
        let cube = cube(10.0);
        for (kind, likeness, expected) in [
            (Edge, Direction, 4),
            (Edge, Loop, 1),
            (Edge, Strip, 4),
            (Edge, Symmetric, 12),
            (Face, Direction, 1),
            (Face, Loop, 6),
            (Face, Symmetric, 6),
            (Vertex, Direction, 8),
            (Vertex, Loop, 1),
            (Vertex, Symmetric, 8),
        ] {
            assert_eq!(count(&cube, kind, 3, likeness), expected, "{kind} {likeness:?}");
        }
        assert!(alike(&cube, Edge, 12, Loop).is_none() && alike(&cube, Face, 6, Loop).is_none());
    }

    #[test]
    fn loops_and_symmetries_of_other_solids() {
        // An octahedron is three squares of edges.
        assert_eq!(count(&named("octahedron"), ElementKind::Edge, 0, Likeness::Loop), 4);
        // A truncated icosahedron has two kinds of edges, 60 and 30.
        let ball = named("soccer-ball");
        let mut orbits: Vec<usize> =
            (0..90).map(|e| count(&ball, ElementKind::Edge, e, Likeness::Symmetric)).collect();
        orbits.sort_unstable();
        orbits.dedup();
        assert_eq!(orbits, [30, 60]);
        // Skew edges are found by their direction, too.
        assert_eq!(count(&named("dodecahedron"), ElementKind::Edge, 7, Likeness::Direction), 2);
    }
}
