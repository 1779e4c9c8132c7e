//! The constraints of planarizing: for each face with more than three sides, the heights of its
//! corners over its own plane must be those of a plane.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use crate::geom::sparse::{SparseRow, nested_dissection, solve_normal};
use crate::geom::{Frame, bending_patterns, fit_plane};
use crate::mesh::{FaceId, Mesh};

/// The linearised constraints of one round, and the order in which they are eliminated in all
/// rounds.
pub(super) struct Constraints {
    faces: Vec<FaceId>,
    /// The column of each vertex slot.
    columns: Vec<usize>,
    vertex_count: usize,
    /// Rows in the order of elimination.
    order: Vec<usize>,
    rows: Vec<SparseRow>,
    /// How far each row is from being kept, in mm.
    excess: Vec<f64>,
}

impl Constraints {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let faces: Vec<FaceId> = mesh.faces().filter(|&f| mesh.sides(f) > 3).collect();
        let mut columns = vec![usize::MAX; mesh.vertex_slots()];
        let mut vertex_count = 0;
        for v in mesh.vertices() {
            columns[v.index()] = vertex_count;
            vertex_count += 1;
        }
        let order = order_of_rows(mesh, &faces);
        Self { faces, columns, vertex_count, order, rows: Vec::new(), excess: Vec::new() }
    }

    /// Linearises at the positions of the mesh.
    pub(super) fn measure(&mut self, mesh: &Mesh) {
        self.rows.clear();
        self.excess.clear();
        for &f in &self.faces {
            let corners = mesh.face_positions(f);
            let columns: Vec<usize> =
                mesh.face_vertices(f).map(|v| self.columns[v.index()]).collect();
            let (patterns, normal, heights) = bending(&corners);
            for pattern in patterns {
                let mut row = SparseRow::new();
                for (&column, &share) in columns.iter().zip(&pattern) {
                    row.extend((0..3).map(|axis| (3 * column + axis, share * normal[axis])));
                }
                self.excess.push(pattern.iter().zip(&heights).map(|(p, h)| p * h).sum());
                self.rows.push(row);
            }
        }
    }

    /// The steps of all vertices that keep the constraints to first order, and among those the ones
    /// nearest to the wish, measured by the inverse of the mobility. `None` when the system is
    /// singular at this shift.
    pub(super) fn solve(&self, wish: &[DVec3], mobility: &[f64], shift: f64) -> Option<Vec<DVec3>> {
        let weights: Vec<f64> = mobility.iter().flat_map(|&m| [m; 3]).collect();
        let wished = |column: usize| wish[column / 3][column % 3];
        let lack: Vec<f64> = self
            .rows
            .iter()
            .zip(&self.excess)
            .map(|(row, excess)| {
                -excess - row.iter().map(|&(column, value)| value * wished(column)).sum::<f64>()
            })
            .collect();
        let multipliers = solve_normal(&self.rows, &weights, shift, &self.order, &lack)?;
        let mut steps = wish.to_vec();
        debug_assert_eq!(steps.len(), self.vertex_count);
        for (row, multiplier) in self.rows.iter().zip(&multipliers) {
            for &(column, value) in row {
                steps[column / 3][column % 3] += weights[column] * value * multiplier;
            }
        }
        Some(steps)
    }
}

/// The bending patterns of a face, the normal of its plane, and the heights of its corners over it.
/// Corners that have no plane (all on one line) bend in no way.
fn bending(corners: &[DVec3]) -> (Vec<Vec<f64>>, DVec3, Vec<f64>) {
    let Some(plane) = fit_plane(corners) else {
        // Rows of zeros keep the numbering; the shift makes them harmless.
        return (
            vec![vec![0.0; corners.len()]; corners.len() - 3],
            DVec3::ZERO,
            vec![0.0; corners.len()],
        );
    };
    let frame = Frame::on_plane(&plane);
    let flat: Vec<DVec2> = corners.iter().map(|&p| frame.flatten(p)).collect();
    let heights = corners.iter().map(|&p| plane.signed_distance(p)).collect();
    (bending_patterns(&flat), plane.normal(), heights)
}

/// Faces by nested dissection, the rows of a face one after the other.
fn order_of_rows(mesh: &Mesh, faces: &[FaceId]) -> Vec<usize> {
    let mut place_of = vec![usize::MAX; mesh.face_slots()];
    faces.iter().enumerate().for_each(|(i, f)| place_of[f.index()] = i);
    let (mut places, mut neighbours, mut first_row, mut rows) =
        (Vec::new(), Vec::new(), Vec::new(), 0);
    for &f in faces {
        let corners = mesh.face_positions(f);
        places.push(corners.iter().sum::<DVec3>() / corners.len() as f64);
        let around =
            mesh.face_vertices(f).flat_map(|v| mesh.vertex_faces(v)).map(|g| place_of[g.index()]);
        neighbours.push(
            around.filter(|&i| i != usize::MAX).collect::<BTreeSet<_>>().into_iter().collect(),
        );
        first_row.push(rows);
        rows += corners.len() - 3;
    }
    let dissected = nested_dissection(&places, &neighbours);
    dissected
        .into_iter()
        .flat_map(|i| (0..mesh.sides(faces[i]) - 3).map(move |j| (i, j)))
        .map(|(i, j)| first_row[i] + j)
        .collect()
}
