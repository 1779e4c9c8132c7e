//! Symmetries of a mesh, as permutations of its edges.

use super::graph::Graph;
use crate::measure::{edge_length, fold_angle};
use crate::mesh::{EdgeId, EdgeMap, HalfEdgeId, HalfEdgeMap, Mesh};

/// Lengths that differ by less than this part of the longest edge, and fold angles by less than
/// this in radians, count as equal: far above rounding, far below what can be cut.
const EQUAL: f64 = 1e-9;

/// Edges that look alike: by length and signed fold angle.
#[derive(Debug)]
pub(super) struct EdgeClasses {
    /// The class of each edge, by its number in the graph.
    pub of_edge: Vec<u32>,
    /// The weight of each edge; exactly the same within a class.
    pub weights: Vec<f64>,
}

impl EdgeClasses {
    pub fn new(mesh: &Mesh, graph: &Graph) -> Self {
        let lengths: Vec<f64> = graph.edge_ids.iter().map(|&e| edge_length(mesh, e)).collect();
        // An unknown angle is distinguished from all real ones.
        let angles: Vec<f64> =
            graph.edge_ids.iter().map(|&e| fold_angle(mesh, e).unwrap_or(10.0)).collect();
        let longest = lengths.iter().copied().fold(0.0, f64::max);
        let (lengths, angles) = (snapped(&lengths, EQUAL * longest), snapped(&angles, EQUAL));
        let angle_weight = |a: f64| if a > std::f64::consts::PI { 0.0 } else { a.abs() };
        let weights = lengths.iter().zip(&angles).map(|(l, &a)| l * angle_weight(a)).collect();
        let mut kinds: Vec<(u64, u64)> =
            lengths.iter().zip(&angles).map(|(l, a)| (l.to_bits(), a.to_bits())).collect();
        let keys = kinds.clone();
        kinds.sort_unstable();
        kinds.dedup();
        let number = |k| kinds.binary_search(k).expect("each key is in the list") as u32;
        Self { of_edge: keys.iter().map(number).collect(), weights }
    }
}

/// The values with those that follow each other closer than `bound` made equal.
fn snapped(values: &[f64], bound: f64) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut snapped = values.to_vec();
    for pair in order.windows(2) {
        if values[pair[1]] - values[pair[0]] <= bound {
            snapped[pair[1]] = snapped[pair[0]];
        }
    }
    snapped
}

/// The symmetries of a mesh, turns and mirrors, each as the image of every edge; the identity is
/// left out. Between equal components those that swap two of them; with these all others can be
/// made. The work grows with the number of edges times that of symmetries.
pub fn edge_symmetries(mesh: &Mesh) -> Vec<EdgeMap<EdgeId>> {
    let graph = Graph::new(mesh);
    let classes = EdgeClasses::new(mesh, &graph);
    let image = |permutation: Vec<u32>| {
        let mut image = EdgeMap::filled(mesh.edge_slots(), EdgeId::new(0));
        for (&e, k) in graph.edge_ids.iter().zip(permutation) {
            image[e] = graph.edge_ids[k as usize];
        }
        image
    };
    symmetries(mesh, &graph, &classes).into_iter().map(image).collect()
}

/// Symmetries that generate all others: permutations of the edges (by their numbers in the graph)
/// that keep what is next to what and the class of every edge; turns and mirrors, of each component
/// and between equal components. For a connected mesh these are all symmetries but the identity.
pub(super) fn symmetries(mesh: &Mesh, graph: &Graph, classes: &EdgeClasses) -> Vec<Vec<u32>> {
    let mut number = EdgeMap::filled(mesh.edge_slots(), 0);
    (0u32..).zip(&graph.edge_ids).for_each(|(i, &e)| number[e] = i);
    let class = |h: HalfEdgeId| classes.of_edge[number[h.edge()] as usize];
    let components = component_of_edges(mesh);
    let sizes: Vec<usize> = components.iter().map(Vec::len).collect();
    let mut symmetries = Vec::new();
    for (i, from) in components.iter().enumerate() {
        for (j, to) in components.iter().enumerate().skip(i).filter(|&(j, _)| sizes[i] == sizes[j])
        {
            for target in to.iter().flat_map(|e| e.half_edges()) {
                for mirrored in [false, true] {
                    let Some(image) = image_of(mesh, from[0].half_edge(), target, mirrored, &class)
                    else {
                        continue;
                    };
                    let mut permutation: Vec<u32> = (0..graph.edge_ids.len() as u32).collect();
                    for &e in from {
                        let f = image[e.half_edge()]
                            .expect("all half-edges of the component have images")
                            .edge();
                        permutation[number[e] as usize] = number[f];
                        if i != j {
                            permutation[number[f] as usize] = number[e];
                        }
                    }
                    if permutation.iter().enumerate().any(|(k, &p)| k != p as usize) {
                        symmetries.push(permutation);
                    }
                }
            }
        }
    }
    symmetries
}

/// The edges of each component, ascending.
fn component_of_edges(mesh: &Mesh) -> Vec<Vec<EdgeId>> {
    let of_vertices = mesh.components().into_iter().filter(|c| c.edges > 0).map(|c| {
        let mut edges: Vec<EdgeId> =
            c.vertices.iter().flat_map(|&v| mesh.outgoing(v)).map(HalfEdgeId::edge).collect();
        edges.sort_unstable();
        edges.dedup();
        edges
    });
    of_vertices.collect()
}

/// The map of half-edges that sends `from` to `to` and keeps (or mirrors) all walks; `None` when
/// there is none, or when it sends an edge to one of another class. A mirrored half-edge keeps its
/// origin and has its face on the right.
fn image_of(
    mesh: &Mesh,
    from: HalfEdgeId,
    to: HalfEdgeId,
    mirrored: bool,
    class: &impl Fn(HalfEdgeId) -> u32,
) -> Option<HalfEdgeMap<Option<HalfEdgeId>>> {
    let step = |h: HalfEdgeId| if mirrored { mesh.prev(h.twin()).twin() } else { mesh.next(h) };
    // Most tries fail at once; only a full one is worth a table.
    if class(from) != class(to) || class(mesh.next(from)) != class(step(to)) {
        return None;
    }
    let mut image = HalfEdgeMap::filled(mesh.half_edge_slots(), None);
    image[from] = Some(to);
    let mut stack = vec![from];
    while let Some(h) = stack.pop() {
        let g = image[h].expect("what is on the stack has an image");
        for (h, g) in [(h.twin(), g.twin()), (mesh.next(h), step(g))] {
            match image[h] {
                Some(known) if known != g => return None,
                Some(_) => {}
                None if class(h) != class(g) => return None,
                None => {
                    image[h] = Some(g);
                    stack.push(h);
                }
            }
        }
    }
    Some(image)
}

#[cfg(test)]
mod tests {
    use super::super::fixtures;
    use super::*;

    fn order(mesh: &Mesh) -> usize {
        let graph = Graph::new(mesh);
        // The group has the identity too.
        1 + symmetries(mesh, &graph, &EdgeClasses::new(mesh, &graph)).len()
    }

    #[test]
    fn groups_have_their_known_orders() {
        assert_eq!(order(&fixtures::tetrahedron()), 24);
        assert_eq!(order(&fixtures::cube()), 48);
        assert_eq!(order(&fixtures::dodecahedron()), 120);
        assert_eq!(order(&fixtures::prism(6, 2.0)), 24);
        assert_eq!(order(&fixtures::prism(4, 2.0)), 16);
        assert_eq!(order(&fixtures::random_convex(12, 5)), 1);
    }
}
