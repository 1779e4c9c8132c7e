//! The check itself: measures, and asks what is found.

use glam::DVec3;
use rayon::prelude::*;

use super::report::{
    ConicalNode, FaceReport, FlatNeighbours, MOST_CROSSINGS, ModelCounts, Report, ValenceReport,
};
use super::{CheckError, CheckParams, Limits, Profile, findings};
use crate::measure::{self, Planarity, planarity, plane_deviation};
use crate::mesh::{EdgeId, FaceId, FaceMap, Mesh, VertexId};

/// Measures a mesh and compares it with the limits and requirements of `params`.
///
/// Always findings: faces beyond the planarity limits, without area or with an outline that meets
/// itself, edges without length (shorter than the rounding bound, 1e-12 of the model), faces that
/// look inwards, T-junctions and doubled faces; and what breaks the limits of shapes, where the
/// profile or the user sets some. Only when required: valence, rims, convexity, vertices at one
/// place, several components, faces that go through each other; these are still reported as data.
///
/// # Errors
/// [`CheckError::BadLimit`] when a limit is negative or not finite.
pub fn check(mesh: &Mesh, params: &CheckParams) -> Result<Report, CheckError> {
    let limits = params.limits()?;
    let mut require = params.require.clone();
    require.sort_unstable();
    require.dedup();
    let faces: Vec<FaceId> = mesh.faces().collect();
    let faces: Vec<FaceReport> =
        faces.into_par_iter().map(|f| face_report(mesh, f, &limits)).collect();
    let mut deviations = FaceMap::filled(mesh.face_slots(), 0.0);
    for f in &faces {
        deviations[f.face] = f.planarity.mm;
    }
    let model = counts(mesh);
    let is_ball = (model.components, model.genus, model.rims) == (1, 0, 0);
    let convexity = measure::convexity_of(mesh, &deviations, is_ball);
    let mut report = Report {
        profile: params.profile,
        limits,
        require,
        model,
        worst: faces.iter().fold(Planarity::default(), |worst, f| largest(worst, f.planarity)),
        profiles: Profile::ALL.map(|p| (p, faces.iter().all(|f| p.limits().allow(&f.planarity)))),
        carried_mm: mesh.faces().filter_map(|f| plane_deviation(mesh, f)).reduce(f64::max),
        valence: ValenceReport {
            histogram: measure::valence_histogram(mesh),
            other: measure::other_valences(mesh),
        },
        concave_ends: convexity
            .concave_edges
            .iter()
            .map(|&e: &EdgeId| mesh.edge_vertices(e))
            .collect(),
        conical: conical_nodes(mesh),
        crossings: measure::crossings(mesh, MOST_CROSSINGS),
        flat: FlatNeighbours::of(mesh),
        convexity,
        faces,
        findings: Vec::new(),
    };
    report.findings = findings::all(mesh, &report);
    Ok(report)
}

fn face_report(mesh: &Mesh, face: FaceId, limits: &Limits) -> FaceReport {
    let planarity = planarity(mesh, face);
    FaceReport { face, sides: mesh.sides(face), planarity, breach: limits.breach(&planarity) }
}

fn largest(a: Planarity, b: Planarity) -> Planarity {
    Planarity {
        mm: a.mm.max(b.mm),
        permille: a.permille.max(b.permille),
        degrees: a.degrees.max(b.degrees),
        percent: a.percent.into_iter().chain(b.percent).reduce(f64::max),
    }
}

fn counts(mesh: &Mesh) -> ModelCounts {
    let components = mesh.components();
    ModelCounts {
        vertices: mesh.vertex_count(),
        edges: mesh.edge_count(),
        faces: mesh.face_count(),
        components: components.len(),
        genus: components.iter().map(|c| c.genus).sum(),
        rims: mesh.hole_count(),
        size_mm: measure::size(mesh),
    }
}

fn conical_nodes(mesh: &Mesh) -> Vec<ConicalNode> {
    let crowded: Vec<(VertexId, usize)> =
        mesh.vertices().map(|v| (v, mesh.valence(v))).filter(|&(_, valence)| valence > 3).collect();
    if crowded.is_empty() {
        return Vec::new();
    }
    // Each face is seen from all its corners; its normal is worked out once.
    let mut normals = FaceMap::filled(mesh.face_slots(), None);
    for f in mesh.faces() {
        normals[f] = mesh.plane(f).map(|plane| plane.normal());
    }
    let node = |(vertex, valence)| {
        let around: Option<Vec<DVec3>> = mesh.vertex_faces(vertex).map(|f| normals[f]).collect();
        ConicalNode {
            vertex,
            valence,
            residual: around.and_then(|n| measure::conical_residual_of(&n)),
        }
    };
    crowded.into_par_iter().map(node).collect()
}
