//! The directions of the rows: a six-fold field on the surface.
//!
//! At each vertex u = e^{6iθ}, θ the angle of a row in the vertex's own frame, so that six
//! directions are one number. Between neighbours the frames are compared along their common edge
//! (Knöppel, Crane, Pinkall, Schröder 2013, "Globally optimal direction fields"). Rows should run
//! along the direction of the smaller absolute curvature: there a lattice of planes meets in good
//! polygons whatever the sign of the curvature; how much that matters falls with the ratio of the
//! curvatures, and at umbilics not at all.

use glam::{DVec2, DVec3};

use super::curvature::Quadric;
use super::surface::Surface;
use crate::geom::fronts::Fronts;

/// The field follows its targets over so many panel sizes.
const SMOOTH: f64 = 1.5;
/// Curvature counts from this sag on, in panel sizes.
const FLAT_SAG: f64 = 0.01;

/// Rows along a direction at a vertex, and how strongly.
#[derive(Debug, Clone, Copy)]
pub(super) struct Target {
    pub vertex: usize,
    pub direction: DVec3,
    /// 1 is as strong as curvature can be.
    pub weight: f64,
}

/// The field: at each vertex the angle of one of the six directions in the axes of its quadric.
#[derive(Debug)]
pub(super) struct RowField {
    pub angles: Vec<f64>,
}

impl RowField {
    /// The field that follows curvature (where `follows_curvature`) and the targets; without either
    /// it is as smooth as can be. `None` when the linear system has no solution, which only
    /// surfaces with numbers beyond range have.
    pub(super) fn new(
        surface: &Surface,
        quadrics: &[Quadric],
        follows_curvature: bool,
        targets: &[Target],
    ) -> Option<Self> {
        let mut wishes = vec![(DVec2::X, 1e-9); surface.points.len()];
        if follows_curvature {
            wishes = quadrics.iter().map(curvature_wish).collect();
        }
        for target in targets {
            let angle = angle_in(&quadrics[target.vertex], target.direction);
            wishes[target.vertex] = (sixth(angle), target.weight);
        }
        solve(surface, quadrics, &wishes).map(|angles| Self { angles })
    }

    /// One of the six directions at a vertex.
    pub(super) fn direction(&self, quadrics: &[Quadric], v: usize) -> DVec3 {
        let (sin, cos) = self.angles[v].sin_cos();
        quadrics[v].axes[0] * cos + quadrics[v].axes[1] * sin
    }
}

/// The angle of a direction in the axes of a quadric.
pub(super) fn angle_in(quadric: &Quadric, direction: DVec3) -> f64 {
    direction.dot(quadric.axes[1]).atan2(direction.dot(quadric.axes[0]))
}

/// The number of a six-fold direction.
fn sixth(angle: f64) -> DVec2 {
    DVec2::from_angle(6.0 * angle)
}

/// The direction of the smaller curvature, and how much it matters there.
fn curvature_wish(quadric: &Quadric) -> (DVec2, f64) {
    let (_, angle) = quadric.principal();
    let sag = quadric.sag();
    let matters = (1.0 - quadric.ratio().abs()).max(0.0) * sag / (sag + FLAT_SAG);
    (sixth(angle), matters.max(1e-9))
}

/// The sum of |u_j − r u_i|² over the edges and of λ w |u − wish|² over the vertices, at its least.
fn solve(surface: &Surface, quadrics: &[Quadric], wishes: &[(DVec2, f64)]) -> Option<Vec<f64>> {
    let count = surface.points.len();
    let cliques = surface.edges.iter().map(|e| e.to_vec()).collect();
    let single = (0..count).map(|v| vec![v]);
    let cliques: Vec<Vec<usize>> = Vec::into_iter(cliques).chain(single).collect();
    let mut fronts = Fronts::new(&surface.points, cliques, 2);
    let mut matrix = fronts.zeros();
    for (k, &[i, j]) in surface.edges.iter().enumerate() {
        let way = surface.points[j] - surface.points[i];
        let turn = sixth(angle_in(&quadrics[j], way) - angle_in(&quadrics[i], way));
        let (c, s) = (turn.x, turn.y);
        fronts.add(
            &mut matrix,
            k,
            &[
                1.0, 0.0, -c, -s, //
                0.0, 1.0, s, -c, //
                -c, s, 1.0, 0.0, //
                -s, -c, 0.0, 1.0,
            ],
        );
    }
    let strength = 3.0 * (mean_edge(surface) / SMOOTH).powi(2);
    let mut right = vec![0.0; 2 * count];
    for (v, &(wish, weight)) in wishes.iter().enumerate() {
        let weight = weight * strength;
        fronts.add(&mut matrix, surface.edges.len() + v, &[weight, 0.0, 0.0, weight]);
        right[2 * v..2 * v + 2].copy_from_slice(&(wish * weight).to_array());
    }
    fronts.forget_cliques();
    let solved = fronts.factor(matrix, 1e-12)?.solve(&right);
    Some(solved.chunks_exact(2).map(|u| u[1].atan2(u[0]) / 6.0).collect())
}

/// The mean length of an edge.
pub(super) fn mean_edge(surface: &Surface) -> f64 {
    let length = |&[a, b]: &[usize; 2]| surface.points[a].distance(surface.points[b]);
    surface.edges.iter().map(length).sum::<f64>() / surface.edges.len() as f64
}
