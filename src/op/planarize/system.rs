//! The linear system of one round: corners come into the planes of their faces, vertices stay close
//! to where they were, neighbours move alike, and faces stay star-shaped.
//!
//! The plane of a face is an unknown beside its corners (Tang, Sun, Gomes, Wallner, Pottmann 2014,
//! "Form-finding with polyhedral meshes made simple"), and is eliminated face by face: what is left
//! are the heights that no plane has ([`bending_patterns`]). So a face adds one small dense block
//! over its own corners.

use glam::{DVec2, DVec3};

use crate::geom::fronts::{FrontFactor, Fronts};
use crate::geom::{Frame, bending_patterns, fit_plane};
use crate::mesh::{FaceId, Mesh, VertexId};

/// No unknown: the vertex is fixed.
const NONE: usize = usize::MAX;
/// A side that turns about the middle of its face less than this share of what it did at the start
/// is held back.
const STAR: f64 = 0.2;
/// What that weighs against planarity.
const STAR_WEIGHT: f64 = 0.01;
/// The least shifts that are tried.
const SHIFTS: [f64; 4] = [1e-14, 1e-12, 1e-10, 1e-8];

/// What vertices are drawn to besides planes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pull {
    /// Weight of the way back to the start, against planarity.
    pub back: f64,
    /// Weight of neighbours moving alike, against the same.
    pub alike: f64,
    /// Whether faces are kept star-shaped.
    pub keeps_stars: bool,
}

/// Faces and unknowns; the same in all rounds.
pub(super) struct System {
    faces: Vec<Corners>,
    edges: Vec<[usize; 2]>,
    /// The vertices that move.
    free: Vec<VertexId>,
    /// Where they were at the start, and all other vertices of [`Self::places`] after them.
    start: Vec<DVec3>,
    fronts: Fronts,
}

/// A face with more than three sides.
struct Corners {
    vertices: Vec<VertexId>,
    /// The unknown of each corner, or [`NONE`].
    nodes: Vec<usize>,
    /// Twice the areas of the triangles of each side and the middle, at the start. Only positive
    /// ones are held: a side of a concave face may turn the other way.
    stars: Vec<f64>,
}

/// A symmetric matrix over the free corners of a face and its right-hand side.
struct Block {
    nodes: Vec<usize>,
    matrix: Vec<f64>,
    right: Vec<f64>,
}

impl System {
    /// `is_fixed` by vertex slot; `alike` says whether neighbours move alike. Unless they do, vertices
    /// of triangles alone stay where they are.
    pub(super) fn new(mesh: &Mesh, is_fixed: &[bool], alike: bool) -> Self {
        let can_bend = |v: VertexId| mesh.vertex_faces(v).any(|f| mesh.sides(f) > 3);
        let moves = |v: &VertexId| !is_fixed[v.index()] && (alike || can_bend(*v));
        let free: Vec<VertexId> = mesh.vertices().filter(moves).collect();
        let mut node = vec![NONE; mesh.vertex_slots()];
        free.iter().enumerate().for_each(|(i, v)| node[v.index()] = i);
        let wanted = |f: &FaceId| {
            mesh.sides(*f) > 3 && mesh.face_vertices(*f).any(|v| node[v.index()] != NONE)
        };
        let faces: Vec<Corners> =
            mesh.faces().filter(wanted).map(|f| Corners::new(mesh, f, &node)).collect();
        let ends = mesh.edges().map(|e| mesh.edge_vertices(e).map(|v| node[v.index()]));
        let edges: Vec<[usize; 2]> =
            ends.filter(|[u, v]| alike && u != v && (*u != NONE || *v != NONE)).collect();
        let mut cliques: Vec<Vec<usize>> = faces.iter().map(Corners::free_nodes).collect();
        cliques.extend(edges.iter().map(|e| e.iter().copied().filter(|&n| n != NONE).collect()));
        let start: Vec<DVec3> = free.iter().map(|&v| mesh.position(v)).collect();
        let fronts = Fronts::new(&start, cliques, 3);
        Self { faces, edges, free, start, fronts }
    }

    /// The vertices that move.
    pub(super) fn free(&self) -> &[VertexId] {
        &self.free
    }

    /// The step of each free vertex at the positions of the mesh; `None` when the system is
    /// singular at every shift.
    pub(super) fn step(&self, mesh: &Mesh, pull: Pull) -> Option<Vec<DVec3>> {
        let mut right = vec![0.0; 3 * self.free.len()];
        for (i, (&v, &start)) in self.free.iter().zip(&self.start).enumerate() {
            let back = (start - mesh.position(v)) * pull.back;
            right[3 * i..3 * i + 3].copy_from_slice(&back.to_array());
        }
        let blocks: Vec<Block> =
            self.faces.iter().map(|face| face.block(mesh, pull.keeps_stars)).collect();
        let alike: Vec<Block> =
            self.edges.iter().map(|&edge| self.edge_block(mesh, edge, pull.alike)).collect();
        let mut matrix = self.fronts.zeros();
        for (clique, block) in blocks.iter().chain(&alike).enumerate() {
            self.fronts.add(&mut matrix, clique, &block.matrix);
            for (i, &node) in block.nodes.iter().enumerate() {
                (0..3).for_each(|axis| right[3 * node + axis] += block.right[3 * i + axis]);
            }
        }
        let factor = |&shift: &f64| self.fronts.factor(matrix.clone(), pull.back + shift);
        let solved = SHIFTS.iter().find_map(factor).map(|f: FrontFactor<'_>| f.solve(&right))?;
        let steps = solved.chunks_exact(3).map(DVec3::from_slice).collect::<Vec<_>>();
        steps.iter().all(|s| s.is_finite()).then_some(steps)
    }

    /// Two ends move alike; a fixed end does not move.
    fn edge_block(&self, mesh: &Mesh, edge: [usize; 2], weight: f64) -> Block {
        let moved = edge.map(|n| match n {
            NONE => DVec3::ZERO,
            n => mesh.position(self.free[n]) - self.start[n],
        });
        let nodes: Vec<usize> = edge.into_iter().filter(|&n| n != NONE).collect();
        let mut block = Block::new(nodes);
        let apart = moved[0] - moved[1];
        for axis in DVec3::AXES {
            let signs = [(edge[0], axis), (edge[1], -axis)];
            let row: Vec<DVec3> =
                signs.into_iter().filter(|&(n, _)| n != NONE).map(|(_, by)| by).collect();
            block.add(&row, apart.dot(axis), weight);
        }
        block
    }
}

impl Corners {
    fn new(mesh: &Mesh, f: FaceId, node: &[usize]) -> Self {
        let vertices: Vec<VertexId> = mesh.face_vertices(f).collect();
        let nodes = vertices.iter().map(|v| node[v.index()]).collect();
        let places = mesh.face_positions(f);
        let stars = facing(&places).map_or(vec![0.0; places.len()], |n| stars(&places, n));
        Self { vertices, nodes, stars }
    }

    fn free_nodes(&self) -> Vec<usize> {
        self.nodes.iter().copied().filter(|&n| n != NONE).collect()
    }

    fn block(&self, mesh: &Mesh, keeps_stars: bool) -> Block {
        let mut block = Block::new(self.free_nodes());
        let places: Vec<DVec3> = self.vertices.iter().map(|&v| mesh.position(v)).collect();
        // Corners on one line have no plane, and bend in no way.
        let Some(plane) = fit_plane(&places) else { return block };
        let frame = Frame::on_plane(&plane);
        let flat: Vec<DVec2> = places.iter().map(|&p| frame.flatten(p)).collect();
        let heights: Vec<f64> = places.iter().map(|&p| plane.signed_distance(p)).collect();
        for pattern in bending_patterns(&flat) {
            let excess = pattern.iter().zip(&heights).map(|(p, h)| p * h).sum();
            let row: Vec<DVec3> = pattern.iter().map(|&share| plane.normal() * share).collect();
            block.add(&self.of_free(row), excess, 1.0);
        }
        if keeps_stars {
            self.hold_stars(&places, &mut block);
        }
        block
    }

    /// Sides that hardly turn about the middle any more are turned back, so that the face does not
    /// cross itself and no corner runs into another.
    fn hold_stars(&self, places: &[DVec3], block: &mut Block) {
        let Some(facing) = facing(places) else { return };
        let count = places.len();
        let size = (self.stars.iter().sum::<f64>() / count as f64).sqrt();
        let centre = places.iter().sum::<DVec3>() / count as f64;
        for (i, (now, first)) in stars(places, facing).into_iter().zip(&self.stars).enumerate() {
            let least = STAR * first;
            if *first <= 0.0 || now >= least {
                continue;
            }
            let j = (i + 1) % count;
            let (a, b) = (places[i] - centre, places[j] - centre);
            let (by_a, by_b) = (b.cross(facing), facing.cross(a));
            let by_centre = -(by_a + by_b) / count as f64;
            let row = (0..count).map(|k| match k {
                k if k == i => by_a + by_centre,
                k if k == j => by_b + by_centre,
                _ => by_centre,
            });
            let row: Vec<DVec3> = row.map(|by| by / size).collect();
            block.add(&self.of_free(row), (now - least) / size, STAR_WEIGHT);
        }
    }

    fn of_free(&self, row: Vec<DVec3>) -> Vec<DVec3> {
        row.into_iter().zip(&self.nodes).filter(|(_, n)| **n != NONE).map(|(by, _)| by).collect()
    }
}

impl Block {
    fn new(nodes: Vec<usize>) -> Self {
        let size = 3 * nodes.len();
        Self { nodes, matrix: vec![0.0; size * size], right: vec![0.0; size] }
    }

    /// Adds the square of a residual with these derivatives by the free corners.
    fn add(&mut self, row: &[DVec3], residual: f64, weight: f64) {
        let size = self.right.len();
        let by = |i: usize| row[i / 3][i % 3];
        for i in 0..size {
            self.right[i] -= weight * by(i) * residual;
            for j in 0..size {
                self.matrix[i * size + j] += weight * by(i) * by(j);
            }
        }
    }
}

/// The normal of the plane of a face, on the side from which it runs counter-clockwise.
fn facing(places: &[DVec3]) -> Option<DVec3> {
    let normal = fit_plane(places)?.normal();
    let whole: f64 = stars(places, normal).iter().sum();
    Some(if whole < 0.0 { -normal } else { normal })
}

/// Twice the areas of the triangles of each side and the middle, as seen against a normal.
fn stars(places: &[DVec3], normal: DVec3) -> Vec<f64> {
    let count = places.len();
    let centre = places.iter().sum::<DVec3>() / count as f64;
    let star = |i: usize| (places[i] - centre).cross(places[(i + 1) % count] - centre).dot(normal);
    (0..count).map(star).collect()
}
