//! The exact sponge of a parallelepiped: unit faces between the cells that stay and those that do
//! not.

use glam::DVec3;

use super::super::{OpContext, OpError};
use crate::geom::RoundingBound;
use crate::mesh::{Mesh, MeshBuilder};

/// Six rounds would need more than a hundred million faces.
const MOST_ROUNDS: u32 = 5;

pub(super) fn exact(mesh: &Mesh, rounds: u32, context: &OpContext<'_>) -> Result<Mesh, OpError> {
    if rounds > MOST_ROUNDS {
        return Err(OpError::RepeatOutOfRange { repeat: rounds, limit: MOST_ROUNDS });
    }
    let (corner, edges) = frame(mesh).ok_or(OpError::NotABox)?;
    let cells = 3_usize.pow(rounds);
    let mut sponge = Sponge {
        cells,
        corner,
        edges,
        numbers: vec![u32::MAX; (cells + 1).pow(3)],
        builder: MeshBuilder::new(),
    };
    for z in 0..cells {
        if context.progress.is_cancelled() {
            return Err(OpError::Cancelled);
        }
        context.progress.report("laying cells", z, cells);
        for y in 0..cells {
            for x in 0..cells {
                sponge.cell([x, y, z]);
            }
        }
    }
    Ok(sponge.builder.build().expect("the cells of a sponge bound a surface").0)
}

/// A corner of a parallelepiped and its three edges, right-handed; `None` when the mesh is none.
fn frame(mesh: &Mesh) -> Option<(DVec3, [DVec3; 3])> {
    let is_like_one = mesh.vertex_count() == 8
        && mesh.face_count() == 6
        && mesh.edge_count() == 12
        && mesh.component_count() == 1
        && mesh.vertices().all(|v| mesh.valence(v) == 3)
        && mesh.faces().all(|f| mesh.sides(f) == 4);
    let start = mesh.vertices().next().filter(|_| is_like_one)?;
    let corner = mesh.position(start);
    let ends: Vec<DVec3> = mesh.neighbours(start).map(|v| mesh.position(v) - corner).collect();
    let [a, mut b, mut c] = ends[..] else { return None };
    let volume = a.cross(b).dot(c);
    if volume < 0.0 {
        std::mem::swap(&mut b, &mut c);
    }
    let (low, high) = mesh.bounds()?;
    let bound = 8.0 * RoundingBound::of_box(low, high).length();
    let is_corner =
        |p: DVec3| (0..8).any(|i| (corner + corner_of([a, b, c], i)).distance(p) <= bound);
    let is_box =
        volume.abs() > bound.powi(3) && mesh.vertices().all(|v| is_corner(mesh.position(v)));
    is_box.then_some((corner, [a, b, c]))
}

fn corner_of(edges: [DVec3; 3], i: usize) -> DVec3 {
    (0..3).filter(|&axis| i >> axis & 1 == 1).map(|axis| edges[axis]).sum()
}

struct Sponge {
    cells: usize,
    corner: DVec3,
    edges: [DVec3; 3],
    /// The number of each point of the grid that is a vertex.
    numbers: Vec<u32>,
    builder: MeshBuilder,
}

impl Sponge {
    /// Whether a cell stays: in no round does it lie in the middle along two axes.
    fn stays(&self, cell: [usize; 3]) -> bool {
        let mut rest = cell;
        let mut size = self.cells;
        while size > 1 {
            if rest.iter().filter(|&&i| i % 3 == 1).count() >= 2 {
                return false;
            }
            rest = rest.map(|i| i / 3);
            size /= 3;
        }
        true
    }

    /// Adds the faces of a cell towards what is empty.
    fn cell(&mut self, cell: [usize; 3]) {
        if !self.stays(cell) {
            return;
        }
        for axis in 0..3 {
            for is_far in [false, true] {
                let beyond = if is_far {
                    Some(cell[axis] + 1).filter(|&i| i < self.cells)
                } else {
                    cell[axis].checked_sub(1)
                };
                let mut neighbour = cell;
                if let Some(i) = beyond {
                    neighbour[axis] = i;
                    if self.stays(neighbour) {
                        continue;
                    }
                }
                self.face(cell, axis, is_far);
            }
        }
    }

    fn face(&mut self, cell: [usize; 3], axis: usize, is_far: bool) {
        let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut around = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| {
            let mut point = cell;
            point[axis] += usize::from(is_far);
            point[u] += i;
            point[v] += j;
            point
        });
        if !is_far {
            around.reverse();
        }
        let corners = around.map(|point| self.vertex(point));
        self.builder.face(corners);
    }

    fn vertex(&mut self, point: [usize; 3]) -> usize {
        let [x, y, z] = point;
        let slot = (z * (self.cells + 1) + y) * (self.cells + 1) + x;
        if self.numbers[slot] == u32::MAX {
            let share = point.map(|i| i as f64 / self.cells as f64);
            let place: DVec3 = (0..3).map(|axis| self.edges[axis] * share[axis]).sum();
            self.numbers[slot] = self.builder.vertex(self.corner + place) as u32;
        }
        self.numbers[slot] as usize
    }
}
