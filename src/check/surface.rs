//! Findings about the surface as a whole and about shapes that a shop cannot make: faces that look
//! inwards, T-junctions, doubled faces; corners too sharp, edges too short, mitres too steep.

use std::collections::HashMap;

use super::{CheckFinding, CheckKind, Element, Limits, Unit, short};
use crate::measure::{self, corner_angle, edge_length, fold_angle};
use crate::mend::{junctions, position_key};
use crate::mesh::{FaceId, Mesh};

/// What is always looked for.
pub(super) fn always(mesh: &Mesh) -> Vec<CheckFinding> {
    let mut findings: Vec<CheckFinding> = inside_out(mesh).into_iter().collect();
    findings.extend(t_junctions(mesh));
    findings.extend(doubled_faces(mesh));
    findings
}

/// What breaks the limits of shapes, where there are any.
pub(super) fn limits(mesh: &Mesh, limits: &Limits) -> Vec<CheckFinding> {
    let mut findings = Vec::new();
    if let Some(limit) = limits.min_angle_degrees {
        findings.extend(mesh.faces().filter_map(|f| sharp_corner(mesh, f, limit)));
    }
    if let Some(limit) = limits.min_edge_mm {
        findings.extend(short_edges(mesh, limit));
    }
    if let Some(limit) = limits.max_mitre_degrees {
        findings.extend(steep_mitres(mesh, limit));
    }
    findings
}

fn inside_out(mesh: &Mesh) -> Option<CheckFinding> {
    let volume = if mesh.is_closed() { measure::volume(mesh) } else { 0.0 };
    (volume < 0.0).then(|| CheckFinding {
        check: CheckKind::InsideOut,
        element: Element::Model,
        id: 0,
        measured: volume,
        limit: 0.0,
        unit: Unit::CubicMm,
        message: format!(
            "the model is inside out: its faces look inwards and its volume is {} mm³; --flip \
            turns them when reading, `kerfold repair IN -o OUT` for good",
            short(volume)
        ),
    })
}

fn t_junctions(mesh: &Mesh) -> Vec<CheckFinding> {
    let found = junctions(mesh);
    let finding = |junction: crate::mend::Junction| {
        let [a, b] = mesh.edge_vertices(junction.edge);
        CheckFinding {
            check: CheckKind::Junction,
            element: Element::Vertex,
            id: junction.vertex.index(),
            measured: junction.distance,
            limit: junction.limit,
            unit: Unit::Mm,
            message: format!(
                "a T-junction: vertex {} lies on the edge between vertices {a} and {b} and is no \
                end of it, so the surface is open there; `kerfold repair IN -o OUT` joins them",
                junction.vertex
            ),
        }
    };
    found.into_iter().map(finding).collect()
}

/// Faces whose corners lie where those of an earlier face lie, in whatever order. Two faces on the
/// same vertices are the two sides of a pillow and no fault.
fn doubled_faces(mesh: &Mesh) -> Vec<CheckFinding> {
    let mut first: HashMap<Vec<[u64; 3]>, FaceId> = HashMap::with_capacity(mesh.face_count());
    let mut findings = Vec::new();
    for f in mesh.faces() {
        let mut key: Vec<[u64; 3]> =
            mesh.face_vertices(f).map(|v| position_key(mesh.position(v))).collect();
        key.sort_unstable();
        let earlier = *first.entry(key).or_insert(f);
        let share = || mesh.face_vertices(f).any(|v| mesh.face_vertices(earlier).any(|u| u == v));
        if earlier != f && !share() {
            findings.push(CheckFinding {
                check: CheckKind::Doubled,
                element: Element::Face,
                id: f.index(),
                measured: 2.0,
                limit: 1.0,
                unit: Unit::Faces,
                message: format!(
                    "face {f} has its corners where face {earlier} has them: it is there twice; \
                    `kerfold repair IN -o OUT` leaves one"
                ),
            });
        }
    }
    findings
}

fn sharp_corner(mesh: &Mesh, f: FaceId, limit: f64) -> Option<CheckFinding> {
    let angle = |h| Some((corner_angle(mesh, h)?.to_degrees(), mesh.origin(h)));
    let corners = mesh.face_half_edges(f).filter_map(angle);
    let (degrees, vertex) = corners.reduce(|a, b| if b.0 < a.0 { b } else { a })?;
    (degrees < limit).then(|| CheckFinding {
        check: CheckKind::SharpCorner,
        element: Element::Face,
        id: f.index(),
        measured: degrees,
        limit,
        unit: Unit::Degrees,
        message: format!(
            "face {f} has a corner of {}° at vertex {vertex}; allowed: {}° or more",
            short(degrees),
            short(limit)
        ),
    })
}

fn short_edges(mesh: &Mesh, limit: f64) -> impl Iterator<Item = CheckFinding> + '_ {
    mesh.edges().filter_map(move |e| {
        let length = edge_length(mesh, e);
        let [a, b] = mesh.edge_vertices(e);
        (length < limit && a != b).then(|| CheckFinding {
            check: CheckKind::ShortEdge,
            element: Element::Edge,
            id: e.index(),
            measured: length,
            limit,
            unit: Unit::Mm,
            message: format!(
                "the edge between vertices {a} and {b} is {} mm long; allowed: {} mm or more",
                short(length),
                short(limit)
            ),
        })
    })
}

/// A mitre is half of what the faces fold by.
fn steep_mitres(mesh: &Mesh, limit: f64) -> impl Iterator<Item = CheckFinding> + '_ {
    mesh.edges().filter_map(move |e| {
        let mitre = fold_angle(mesh, e)?.abs().to_degrees() / 2.0;
        let [a, b] = mesh.edge_vertices(e);
        (mitre > limit).then(|| CheckFinding {
            check: CheckKind::Mitre,
            element: Element::Edge,
            id: e.index(),
            measured: mitre,
            limit,
            unit: Unit::Degrees,
            message: format!(
                "the edge between vertices {a} and {b} needs a mitre of {}°; allowed: {}° or less",
                short(mitre),
                short(limit)
            ),
        })
    })
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::super::{CheckParams, Profile, check};
    use super::*;
    use crate::fixtures::{CUBE_FACES, cube, cube_corners};
    use crate::units::{Angle, Length};

    fn kinds(mesh: &Mesh, params: &CheckParams) -> Vec<(CheckKind, Element, usize)> {
        let report = check(mesh, params).expect("good limits");
        report.findings.iter().map(|f| (f.check, f.element, f.id)).collect()
    }

    #[test]
    fn a_cube_inside_out_is_told_and_a_cube_with_a_cavity_is_not() {
        let back = CUBE_FACES.map(|f| [f[3], f[2], f[1], f[0]]);
        let inverted = Mesh::from_faces(cube_corners(), back).expect("a cube");
        let found = kinds(&inverted, &CheckParams::default());
        assert_eq!(found, [(CheckKind::InsideOut, Element::Model, 0)]);
        let mut points = cube_corners();
        points.extend(cube_corners().into_iter().map(|p| p * 0.5 + DVec3::splat(0.1)));
        let faces = CUBE_FACES.into_iter().chain(back.map(|f| f.map(|v| v + 8)));
        let hollow = Mesh::from_faces(points, faces).expect("a hollow cube");
        assert!(kinds(&hollow, &CheckParams::default()).is_empty());
    }

    #[test]
    fn a_vertex_on_an_edge_is_a_junction_unless_it_is_an_end() {
        let places = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1), (0, 2), (2, 2)];
        let places = places.map(|(x, y)| DVec3::new(f64::from(x), f64::from(y), 0.0));
        let faces = [vec![0, 1, 4, 5], vec![1, 2, 3, 4], vec![5, 3, 7, 6]];
        let mesh = Mesh::from_faces(places, faces).expect("three faces");
        let found = kinds(&mesh, &CheckParams::default());
        assert_eq!(found, [(CheckKind::Junction, Element::Vertex, 4)]);
        let faces = [vec![0, 1, 4, 5], vec![1, 2, 3, 4], vec![5, 4, 3, 7, 6]];
        let mesh = Mesh::from_faces(places, faces).expect("three faces");
        assert!(kinds(&mesh, &CheckParams::default()).is_empty());
    }

    #[test]
    fn a_face_that_is_there_twice_is_told() {
        let mut points = cube_corners();
        points.extend(CUBE_FACES[2].map(|v| cube_corners()[v]));
        let faces = CUBE_FACES.into_iter().chain([[8, 9, 10, 11]]);
        let mesh = Mesh::from_faces(points, faces).expect("a cube and a square");
        let found = kinds(&mesh, &CheckParams::default());
        assert_eq!(found, [(CheckKind::Doubled, Element::Face, 6)]);
    }

    #[test]
    fn limits_of_shapes_are_kept_to_the_number() {
        let params = |angle: f64, edge: f64, mitre: f64| CheckParams {
            min_angle: Some(Angle::from_degrees(angle)),
            min_edge: Some(Length::from_mm(edge)),
            max_mitre: Some(Angle::from_degrees(mitre)),
            ..CheckParams::default()
        };
        assert!(kinds(&cube(), &params(89.9, 2.0, 45.1)).is_empty());
        let counts = |angle, edge, mitre| {
            let found = kinds(&cube(), &params(angle, edge, mitre));
            let count = |kind| found.iter().filter(|f| f.0 == kind).count();
            [CheckKind::SharpCorner, CheckKind::ShortEdge, CheckKind::Mitre].map(count)
        };
        assert_eq!(counts(90.1, 2.0, 45.1), [6, 0, 0]);
        assert_eq!(counts(89.9, 2.1, 45.1), [0, 12, 0]);
        assert_eq!(counts(89.9, 2.0, 44.9), [0, 0, 12]);
        // A shop's profile has limits of its own, and the user's take their place.
        let glazier = CheckParams { profile: Profile::Glazier, ..CheckParams::default() };
        assert_eq!(kinds(&cube(), &glazier).len(), 12);
        let own = CheckParams { min_edge: Some(Length::from_mm(1.0)), ..glazier };
        assert!(kinds(&cube(), &own).is_empty());
    }
}
