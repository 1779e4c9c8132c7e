//! A state of folding as a mesh, for pictures and checks.

use glam::DVec3;

use super::{FoldTree, Leaf, Pose};
use crate::mesh::{BuildError, FaceId, Mesh, MeshBuilder};
use crate::net::EdgeLabel;

/// The mesh of all faces that `group` gives one of the `names`, by its place in them, where `poses`
/// puts them; its groups have these names in this order. Faces are connected by their folds and by
/// the seams that `is_closed` names; all other edges are rims. Where faces that are connected have
/// a corner at different places, as in a ring of folds that is only half closed, the corner is put
/// in the middle.
///
/// # Errors
/// [`BuildError`] when no face has a group, or when the net is not one of a mesh.
pub fn state_mesh(
    tree: &FoldTree<'_>,
    poses: &[Pose],
    is_closed: impl Fn(EdgeLabel) -> bool,
    names: &[String],
    group: impl Fn(&Leaf) -> Option<usize>,
) -> Result<Mesh, BuildError> {
    let groups: Vec<Option<usize>> = tree.leaves().iter().map(&group).collect();
    let mut corners = Corners::new(tree, &groups);
    let net = tree.net();
    for fold in &net.folds {
        corners.join(tree, fold.faces, fold.edge);
    }
    for seam in net.seams.iter().filter(|s| is_closed(s.id)) {
        corners.join(tree, [seam.sides[0].face, seam.sides[1].face], seam.edge);
    }
    let (vertices, positions) = corners.vertices(tree, poses);
    let mut builder = MeshBuilder::new();
    for p in positions {
        builder.vertex(p);
    }
    let shown: Vec<usize> = (0..groups.len()).filter(|&i| groups[i].is_some()).collect();
    for &i in &shown {
        builder.face(vertices[corners.starts[i]..corners.starts[i + 1]].iter().copied());
    }
    let (mut mesh, _) = builder.build()?;
    // A group is numbered when it first gets a face: so the first face goes through all of them.
    for name in names {
        mesh.set_group(FaceId::new(0), name);
    }
    for (f, &i) in shown.iter().enumerate() {
        if let Some(name) = groups[i].and_then(|k| names.get(k)) {
            mesh.set_group(FaceId::new(f), name);
        }
    }
    Ok(mesh)
}

/// Corners of faces, united where faces are connected.
struct Corners {
    /// Leaf → its first corner; one entry more at the end. Leaves that are not shown have none.
    starts: Vec<usize>,
    /// Corner → another one of the same vertex, or itself.
    parents: Vec<usize>,
}

impl Corners {
    fn new(tree: &FoldTree<'_>, groups: &[Option<usize>]) -> Self {
        let mut starts = vec![0];
        for (leaf, group) in tree.leaves().iter().zip(groups) {
            let count = if group.is_some() { tree.flat(leaf).vertices.len() } else { 0 };
            starts.push(starts[starts.len() - 1] + count);
        }
        let parents = (0..starts[starts.len() - 1]).collect();
        Self { starts, parents }
    }

    fn root(&mut self, mut corner: usize) -> usize {
        while self.parents[corner] != corner {
            self.parents[corner] = self.parents[self.parents[corner]];
            corner = self.parents[corner];
        }
        corner
    }

    /// Unites the corners of two faces at the ends of their common edge.
    fn join(&mut self, tree: &FoldTree<'_>, faces: [usize; 2], edge: [usize; 2]) {
        let [Some(a), Some(b)] = faces.map(|f| tree.place_of(f)) else { return };
        let ends = |place: usize| {
            let vertices = &tree.flat(&tree.leaves()[place]).vertices;
            let (n, start) = (vertices.len(), self.starts[place]);
            if self.starts[place + 1] == start {
                return None;
            }
            let at = |from: usize, to: usize| {
                (0..n).find(|&i| vertices[i] == from && vertices[(i + 1) % n] == to)
            };
            let forward = at(edge[0], edge[1]).map(|i| [start + i, start + (i + 1) % n]);
            forward.or_else(|| at(edge[1], edge[0]).map(|i| [start + (i + 1) % n, start + i]))
        };
        if let (Some(own), Some(other)) = (ends(a), ends(b)) {
            for (p, q) in own.into_iter().zip(other) {
                let (p, q) = (self.root(p), self.root(q));
                self.parents[p.max(q)] = p.min(q);
            }
        }
    }

    /// Corner → its vertex, and where the vertices lie.
    fn vertices(&mut self, tree: &FoldTree<'_>, poses: &[Pose]) -> (Vec<usize>, Vec<DVec3>) {
        let count = self.parents.len();
        let mut sums = vec![(DVec3::ZERO, 0.0); count];
        let mut roots = Vec::with_capacity(count);
        for (i, leaf) in tree.leaves().iter().enumerate() {
            for (k, corner) in (self.starts[i]..self.starts[i + 1]).enumerate() {
                let root = self.root(corner);
                roots.push(root);
                sums[root].0 += poses[i].lift(tree.flat(leaf).polygon[k]);
                sums[root].1 += 1.0;
            }
        }
        let mut numbers = vec![usize::MAX; count];
        let mut positions = Vec::new();
        for (root, &(sum, weight)) in sums.iter().enumerate().filter(|(_, s)| s.1 > 0.0) {
            numbers[root] = positions.len();
            positions.push(sum / weight);
        }
        (roots.into_iter().map(|root| numbers[root]).collect(), positions)
    }
}
