//! Solids of unit cubes: every volume and area of a cut can be had by adding up cubes.

use std::collections::BTreeMap;

use glam::IVec3;
use kerfold::mesh::{EdgeId, Mesh, MeshBuilder};

use super::random::Random;

/// A set of unit cubes; cube (i, j, k) fills [i, i+1] × [j, j+1] × [k, k+1].
#[derive(Debug, Clone)]
pub struct Voxels {
    size: IVec3,
    filled: Vec<bool>,
}

/// How two cubes that touch along an edge only are joined there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Touch {
    /// Each cube keeps its own edge.
    Apart,
    /// The solid goes on through the edge.
    Through,
}

struct Quad {
    cube: IVec3,
    corners: [IVec3; 4],
}

const AXES: [IVec3; 3] = [IVec3::X, IVec3::Y, IVec3::Z];

impl Voxels {
    pub fn new(size: IVec3, is_filled: impl FnMut(IVec3) -> bool) -> Self {
        let filled = cells(size).map(is_filled).collect();
        Self { size, filled }
    }

    pub fn random(random: &mut Random) -> Self {
        let mut side = || 2 + random.below(3) as i32;
        let size = IVec3::new(side(), side(), side());
        let percent = 35 + random.below(60);
        Self::new(size, |_| random.below(100) < percent)
    }

    /// A block with `tunnels` tunnels along z: genus `tunnels`.
    pub fn with_tunnels(tunnels: i32) -> Self {
        Self::new(IVec3::new(2 * tunnels + 1, 3, 2), |c| !(c.y == 1 && c.x % 2 == 1))
    }

    /// A block with a hollow that has no way out, wide enough for a pillar that hangs from its
    /// ceiling.
    pub fn with_cavity(has_pillar: bool) -> Self {
        let is_hollow = |c: IVec3| c.cmpge(IVec3::ONE).all() && c.cmple(IVec3::new(3, 3, 2)).all();
        let is_pillar = |c: IVec3| has_pillar && c == IVec3::new(2, 2, 2);
        Self::new(IVec3::new(5, 5, 4), |c| !is_hollow(c) || is_pillar(c))
    }

    pub fn cubes(&self) -> impl Iterator<Item = IVec3> + '_ {
        cells(self.size).filter(|&c| self.has(c))
    }

    pub fn has(&self, c: IVec3) -> bool {
        let inside = c.cmpge(IVec3::ZERO).all() && c.cmplt(self.size).all();
        inside && self.filled[((c.x * self.size.y + c.y) * self.size.z + c.z) as usize]
    }

    /// The number of unit squares that bound the cubes of which `keep` holds.
    pub fn exposed(&self, keep: impl Fn(IVec3) -> bool) -> usize {
        let is_there = |c: IVec3| self.has(c) && keep(c);
        let directions = AXES.into_iter().flat_map(|a| [a, -a]);
        directions.map(|d| self.cubes().filter(|&c| keep(c) && !is_there(c + d)).count()).sum()
    }

    fn quads(&self) -> Vec<Quad> {
        let mut quads = Vec::new();
        for cube in self.cubes() {
            for (i, &axis) in AXES.iter().enumerate() {
                let (u, v) = (AXES[(i + 1) % 3], AXES[(i + 2) % 3]);
                if !self.has(cube + axis) {
                    let o = cube + axis;
                    quads.push(Quad { cube, corners: [o, o + u, o + u + v, o + v] });
                }
                if !self.has(cube - axis) {
                    quads.push(Quad { cube, corners: [cube, cube + v, cube + u + v, cube + u] });
                }
            }
        }
        quads
    }

    /// The surface. `merge` joins about that percentage of the neighbours that lie in one plane.
    /// `None` when there is no cube, or when an edge would have four faces all the same.
    pub fn mesh(&self, touch: Touch, merge: usize, random: &mut Random) -> Option<Mesh> {
        let mut mesh = self.builder(touch, |_| true)?.build().ok()?.0;
        merge_flat(&mut mesh, merge, random);
        mesh.compact();
        Some(mesh)
    }

    /// The surface without about `percent` of its squares.
    pub fn open_mesh(&self, percent: usize, random: &mut Random) -> Option<Mesh> {
        let left_out: Vec<bool> =
            (0..self.quads().len()).map(|_| random.below(100) < percent).collect();
        let mut mesh = self.builder(Touch::Apart, |q| !left_out[q])?.build().ok()?.0;
        mesh.compact();
        Some(mesh)
    }

    fn builder(&self, touch: Touch, keep: impl Fn(usize) -> bool) -> Option<MeshBuilder> {
        let quads = self.quads();
        let class = corner_classes(&quads, touch)?;
        let mut builder = MeshBuilder::new();
        let mut number = BTreeMap::new();
        for (q, quad) in quads.iter().enumerate().filter(|&(q, _)| keep(q)) {
            let mut corners = Vec::new();
            for i in 0..4 {
                let vertex = || builder.vertex(quad.corners[i].as_dvec3());
                corners.push(*number.entry(class[4 * q + i]).or_insert_with(vertex));
            }
            builder.face(corners);
        }
        Some(builder)
    }
}

fn cells(size: IVec3) -> impl Iterator<Item = IVec3> {
    (0..size.x).flat_map(move |x| {
        (0..size.y).flat_map(move |y| (0..size.z).map(move |z| IVec3::new(x, y, z)))
    })
}

/// For each corner of each quad the vertex that it is: corners are connected across the edges that
/// their quads share.
fn corner_classes(quads: &[Quad], touch: Touch) -> Option<Vec<usize>> {
    let mut at_edge: BTreeMap<[[i32; 3]; 2], Vec<usize>> = BTreeMap::new();
    for (q, quad) in quads.iter().enumerate() {
        for i in 0..4 {
            let mut ends = [quad.corners[i].to_array(), quad.corners[(i + 1) % 4].to_array()];
            ends.sort_unstable();
            at_edge.entry(ends).or_default().push(q);
        }
    }
    let mut parent: Vec<usize> = (0..4 * quads.len()).collect();
    for (ends, around) in &at_edge {
        for (a, b) in partners(quads, around, touch)? {
            for end in ends.map(IVec3::from_array) {
                let corner =
                    |q: usize| 4 * q + quads[q].corners.iter().position(|&c| c == end).unwrap_or(0);
                let (x, y) = (root(&parent, corner(a)), root(&parent, corner(b)));
                parent[x] = y;
            }
        }
    }
    Some((0..parent.len()).map(|i| root(&parent, i)).collect())
}

fn partners(quads: &[Quad], around: &[usize], touch: Touch) -> Option<Vec<(usize, usize)>> {
    match *around {
        [a, b] => Some(vec![(a, b)]),
        [a, ref rest @ ..] if rest.len() == 3 => {
            let partner = |&&b: &&usize| {
                let is_one_cube = quads[a].cube == quads[b].cube;
                // Through the edge: the quad of the other cube that bounds the same empty cell
                // looks across it.
                let is_across = !is_one_cube && shares_empty_cell(&quads[a], &quads[b]);
                if touch == Touch::Apart { is_one_cube } else { is_across }
            };
            let b = *rest.iter().find(partner)?;
            let others: Vec<usize> = rest.iter().copied().filter(|&q| q != b).collect();
            Some(vec![(a, b), (others[0], others[1])])
        }
        _ => None,
    }
}

fn shares_empty_cell(a: &Quad, b: &Quad) -> bool {
    empty_cell(a) == empty_cell(b)
}

fn empty_cell(quad: &Quad) -> IVec3 {
    let [a, b, c, _] = quad.corners;
    quad.cube + (b - a).cross(c - b)
}

fn root(parent: &[usize], mut i: usize) -> usize {
    while parent[i] != i {
        i = parent[i];
    }
    i
}

/// Deletes edges between faces in one plane as long as the face that results visits every vertex
/// once.
fn merge_flat(mesh: &mut Mesh, percent: usize, random: &mut Random) {
    let edges: Vec<EdgeId> = mesh.edges().collect();
    for e in edges {
        let [f, g] = mesh.edge_faces(e);
        let normal = |f| mesh.plane(f).map(|p| p.normal());
        if random.below(100) >= percent || f == g || normal(f) != normal(g) {
            continue;
        }
        let of_f: Vec<_> = mesh.face_vertices(f).collect();
        if mesh.face_vertices(g).filter(|v| of_f.contains(v)).count() == 2 {
            mesh.delete_edge(e);
        }
    }
}
