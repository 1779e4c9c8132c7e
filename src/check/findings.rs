//! The checks: each looks for one kind of fault and lists its findings, ascending by id.

use std::cmp::Ordering;
use std::collections::BTreeMap;

use super::{CheckFinding, CheckKind, Element, Report, Requirement, Unit, short, surface};
use crate::geom::RoundingBound;
use crate::measure::{self, edge_length, face_diameter, face_width, self_contact};
use crate::mesh::{EdgeId, FaceId, Mesh, VertexId};

/// Vertices that a message names before it says "and more".
const NAMED: usize = 8;

/// All findings, in the order of [`CheckKind`].
pub(super) fn all(mesh: &Mesh, report: &Report) -> Vec<CheckFinding> {
    let mut findings = Vec::new();
    if let Some((low, high)) = mesh.bounds() {
        let bound = RoundingBound::of_box(low, high).length();
        findings.extend(mesh.faces().filter_map(|f| degenerate_face(mesh, f, bound)));
        findings.extend(mesh.edges().filter_map(|e| zero_length_edge(mesh, e, bound)));
    }
    findings.extend(mesh.faces().filter_map(|f| self_intersection(mesh, f)));
    findings.extend(planarity(report));
    findings.extend(surface::always(mesh));
    findings.extend(surface::limits(mesh, &report.limits));
    type Check = fn(&Mesh, &Report) -> Vec<CheckFinding>;
    let on_request: [(Requirement, Check); 6] = [
        (Requirement::Valence3, valence),
        (Requirement::Closed, closed),
        (Requirement::Convex, convex),
        (Requirement::Manifold, manifold),
        (Requirement::OneComponent, one_component),
        (Requirement::Simple, simple),
    ];
    for (requirement, check) in on_request {
        if report.require.contains(&requirement) {
            findings.extend(check(mesh, report));
        }
    }
    findings
}

fn degenerate_face(mesh: &Mesh, f: FaceId, bound: f64) -> Option<CheckFinding> {
    let sides = mesh.sides(f);
    let finding = |measured, limit, unit, message| CheckFinding {
        check: CheckKind::DegenerateFace,
        element: Element::Face,
        id: f.index(),
        measured,
        limit,
        unit,
        message,
    };
    if sides < 3 {
        return Some(finding(
            sides as f64,
            3.0,
            Unit::Sides,
            format!("face {f} has {sides} sides; a face needs 3"),
        ));
    }
    let diameter = face_diameter(mesh, f);
    let width = face_width(mesh, f);
    (width <= bound).then(|| {
        let message = format!(
            "face {f} has no area: it is {} mm long and {} mm wide",
            short(diameter),
            short(width)
        );
        finding(width, bound, Unit::Mm, message)
    })
}

/// A self-loop is a link without length by its nature; files leave it out.
fn zero_length_edge(mesh: &Mesh, e: EdgeId, bound: f64) -> Option<CheckFinding> {
    let length = edge_length(mesh, e);
    let [a, b] = mesh.edge_vertices(e);
    (a != b && length <= bound).then(|| CheckFinding {
        check: CheckKind::ZeroLengthEdge,
        element: Element::Edge,
        id: e.index(),
        measured: length,
        limit: bound,
        unit: Unit::Mm,
        message: format!(
            "the edge between vertices {a} and {b} has no length ({} mm)",
            short(length)
        ),
    })
}

fn self_intersection(mesh: &Mesh, f: FaceId) -> Option<CheckFinding> {
    let sides = self_contact(mesh, f)?;
    let [[a, b], [c, d]] = sides.map(|e| mesh.edge_vertices(e));
    Some(CheckFinding {
        check: CheckKind::SelfIntersection,
        element: Element::Face,
        id: f.index(),
        measured: 1.0,
        limit: 0.0,
        unit: Unit::Contacts,
        message: format!(
            "the outline of face {f} meets itself: its sides {a}-{b} and {c}-{d} cross, touch or \
            overlap"
        ),
    })
}

fn planarity(report: &Report) -> impl Iterator<Item = CheckFinding> + '_ {
    report.faces.iter().filter_map(|f| {
        let breach = f.breach?;
        Some(CheckFinding {
            check: CheckKind::Planarity,
            element: Element::Face,
            id: f.face.index(),
            measured: breach.measured,
            limit: breach.limit,
            unit: breach.unit,
            message: format!(
                "face {} ({} sides) is {} mm off its plane, {} per mille of its size, turned by {} \
                degrees; allowed: {} {}",
                f.face,
                f.sides,
                short(f.planarity.mm),
                short(f.planarity.permille),
                short(f.planarity.degrees),
                short(breach.limit),
                breach.unit
            ),
        })
    })
}

fn valence(mesh: &Mesh, report: &Report) -> Vec<CheckFinding> {
    // At a rim two edges are an outer corner of one face: nothing meets there that could miss.
    let is_allowed = |&v: &VertexId| mesh.valence(v) == 2 && mesh.is_rim_vertex(v);
    let wrong = report.valence.other.iter().copied().filter(|v| !is_allowed(v));
    let finding = |v: VertexId| {
        let valence = mesh.valence(v);
        CheckFinding {
            check: CheckKind::Valence,
            element: Element::Vertex,
            id: v.index(),
            measured: valence as f64,
            limit: 3.0,
            unit: Unit::Edges,
            message: format!("vertex {v} has {valence} edges instead of 3"),
        }
    };
    wrong.map(finding).collect()
}

fn closed(mesh: &Mesh, _: &Report) -> Vec<CheckFinding> {
    let rims = measure::rims(mesh).into_iter().enumerate();
    let finding = |(i, rim): (usize, measure::Rim)| CheckFinding {
        check: CheckKind::Closed,
        element: Element::Rim,
        id: i,
        measured: rim.edges as f64,
        limit: 0.0,
        unit: Unit::Edges,
        message: format!(
            "the surface is open: a rim of {} edges, {} mm long, through vertices {}",
            rim.edges,
            short(rim.length),
            named(mesh.face_vertices(rim.hole))
        ),
    };
    rims.map(finding).collect()
}

fn convex(mesh: &Mesh, report: &Report) -> Vec<CheckFinding> {
    let mut findings: Vec<CheckFinding> = not_a_ball(report).into_iter().collect();
    findings.extend(report.convexity.concave_faces.iter().map(|&f| concave_face(mesh, f)));
    findings.extend(report.convexity.concave_edges.iter().map(|&e| concave_edge(mesh, e)));
    if findings.is_empty() && !report.is_convex() {
        findings.push(not_convex(
            0.0,
            1.0,
            Unit::Windings,
            "the surface does not wind once around its middle".into(),
        ));
    }
    findings
}

fn not_convex(measured: f64, limit: f64, unit: Unit, message: String) -> CheckFinding {
    CheckFinding {
        check: CheckKind::Convex,
        element: Element::Model,
        id: 0,
        measured,
        limit,
        unit,
        message,
    }
}

fn not_a_ball(report: &Report) -> Option<CheckFinding> {
    let model = &report.model;
    let cases = [
        (model.rims, 0, Unit::Rims, "it is open"),
        (model.genus, 0, Unit::Handles, "it has handles"),
        (model.components, 1, Unit::Components, "it is not one part"),
    ];
    let (measured, limit, unit, why) =
        cases.into_iter().find(|&(count, allowed, ..)| count != allowed)?;
    let message = format!("the model cannot be convex: {why} ({measured} {unit})");
    Some(not_convex(measured as f64, limit as f64, unit, message))
}

fn concave_face(mesh: &Mesh, f: FaceId) -> CheckFinding {
    let angles =
        mesh.face_half_edges(f).filter_map(|h| measure::corner_angle(mesh, h).map(f64::to_degrees));
    let widest = angles.fold(180.0, f64::max);
    CheckFinding {
        check: CheckKind::Convex,
        element: Element::Face,
        id: f.index(),
        measured: widest,
        limit: 180.0,
        unit: Unit::Degrees,
        message: format!("face {f} is concave: its widest corner has {} degrees", short(widest)),
    }
}

fn concave_edge(mesh: &Mesh, e: EdgeId) -> CheckFinding {
    let [a, b] = mesh.edge_vertices(e);
    let inwards = -measure::fold_angle(mesh, e).unwrap_or(0.0).to_degrees();
    CheckFinding {
        check: CheckKind::Convex,
        element: Element::Edge,
        id: e.index(),
        measured: inwards,
        limit: 0.0,
        unit: Unit::Degrees,
        message: format!(
            "the edge between vertices {a} and {b} is concave: it bends inwards by {} degrees",
            short(inwards)
        ),
    }
}

/// Vertices at exactly one place: where a surface touches itself, the reader has pulled it apart.
fn manifold(mesh: &Mesh, _: &Report) -> Vec<CheckFinding> {
    // Adding zero makes one of the two zeros.
    let key = |v: VertexId| (mesh.position(v) + 0.0).to_array();
    let by_place = |&v: &VertexId, &u: &VertexId| {
        let axes = key(v).into_iter().zip(key(u)).map(|(a, b)| a.total_cmp(&b));
        axes.fold(Ordering::Equal, Ordering::then).then(v.cmp(&u))
    };
    let mut vertices: Vec<VertexId> = mesh.vertices().collect();
    vertices.sort_unstable_by(by_place);
    let shared = vertices.chunk_by(|&v, &u| key(v) == key(u)).filter(|group| group.len() > 1);
    let mut findings: Vec<CheckFinding> = shared
        .flat_map(|group| group[1..].iter().map(|&v| doubled(v, group[0], group.len())))
        .collect();
    findings.sort_by_key(|finding| finding.id);
    findings
}

fn doubled(v: VertexId, first: VertexId, count: usize) -> CheckFinding {
    CheckFinding {
        check: CheckKind::Manifold,
        element: Element::Vertex,
        id: v.index(),
        measured: count as f64,
        limit: 1.0,
        unit: Unit::Vertices,
        message: format!(
            "vertex {v} lies at the same place as vertex {first}: the surface touches itself or is \
            not welded there"
        ),
    }
}

fn one_component(mesh: &Mesh, report: &Report) -> Vec<CheckFinding> {
    let count = report.model.components;
    if count == 1 {
        return Vec::new();
    }
    let seeds = mesh.components().into_iter().filter_map(|c| c.vertices.first().copied());
    vec![CheckFinding {
        check: CheckKind::OneComponent,
        element: Element::Model,
        id: 0,
        measured: count as f64,
        limit: 1.0,
        unit: Unit::Components,
        message: format!(
            "the model has {count} parts that are not connected; they hold vertices {}",
            named(seeds)
        ),
    }]
}

fn simple(_: &Mesh, report: &Report) -> Vec<CheckFinding> {
    let mut by_face: BTreeMap<FaceId, Vec<FaceId>> = BTreeMap::new();
    for pair in &report.crossings {
        by_face.entry(pair.first).or_default().push(pair.second);
    }
    let finding = |(face, others): (FaceId, Vec<FaceId>)| {
        let mut names: Vec<String> = others.iter().take(NAMED).map(FaceId::to_string).collect();
        if others.len() > NAMED {
            names.push("...".to_owned());
        }
        CheckFinding {
            check: CheckKind::Simple,
            element: Element::Face,
            id: face.index(),
            measured: others.len() as f64,
            limit: 0.0,
            unit: Unit::Faces,
            message: format!(
                "face {face} goes through or covers {} {}",
                if others.len() == 1 { "face" } else { "faces" },
                names.join(", ")
            ),
        }
    };
    by_face.into_iter().map(finding).collect()
}

/// The first few vertices of a list, and whether there are more.
fn named(vertices: impl Iterator<Item = VertexId>) -> String {
    let mut names: Vec<String> = vertices.take(NAMED + 1).map(|v| v.to_string()).collect();
    if names.len() > NAMED {
        names[NAMED] = "...".into();
    }
    names.join(", ")
}

#[cfg(test)]
mod tests {
    use crate::check::{
        CheckKind, CheckParams, Element, Profile, Report, Requirement, Unit, Verdict, check,
    };
    use crate::fixtures::{CUBE_FACES, cube, cube_corners, ell_prism, octahedron, open_box, torus};
    use crate::mesh::{Mesh, VertexId};
    use crate::units::Length;
    use glam::DVec3;

    fn with(mesh: &Mesh, require: &[Requirement]) -> Report {
        check(mesh, &CheckParams { require: require.to_vec(), ..CheckParams::default() })
            .expect("good limits")
    }

    fn found(report: &Report) -> Vec<(CheckKind, Element, usize)> {
        report.findings.iter().map(|f| (f.check, f.element, f.id)).collect()
    }

    const ALL: [Requirement; 7] = [
        Requirement::Planar,
        Requirement::Valence3,
        Requirement::Closed,
        Requirement::Convex,
        Requirement::Manifold,
        Requirement::OneComponent,
        Requirement::Simple,
    ];

    #[test]
    fn a_cube_passes_everything() {
        let report = with(&cube(), &ALL);
        assert!(report.findings.is_empty() && report.is_convex());
        assert_eq!(report.verdict(), Verdict::Pass);
        assert!(report.profiles.iter().all(|&(_, passes)| passes));
        assert!(report.conical.is_empty() && report.valence.other.is_empty());
        assert_eq!((report.model.genus, report.model.rims, report.model.components), (0, 0, 1));
    }

    #[test]
    fn a_bent_face_breaks_the_profile_it_should() {
        let bent = |by: f64| {
            let mut mesh = cube();
            mesh.set_position(VertexId::new(0), DVec3::new(-1.0, -1.0, -1.0 - by), true);
            mesh
        };
        let fails = |by, profile| {
            let params = CheckParams { profile, ..CheckParams::default() };
            let found = found(&check(&bent(by), &params).expect("good limits"));
            assert!(found.is_empty() || found == [(CheckKind::Planarity, Element::Face, 0)]);
            !found.is_empty()
        };
        // Only the bottom leaves its plane: by a quarter of the step in mm, 1.8 and 3.5 per mille,
        // 0.4 and 0.8 degrees.
        assert_eq!(Profile::ALL.map(|p| fails(0.02, p)), [true, false, false, false]);
        assert_eq!(Profile::ALL.map(|p| fails(0.04, p)), [true, true, false, true]);
        let mesh = bent(0.02);
        let strict = CheckParams { max_mm: Some(Length::from_mm(0.004)), ..CheckParams::default() };
        let report = check(&mesh, &strict).expect("good limits");
        let finding = &report.findings[0];
        assert_eq!((finding.limit, finding.unit, finding.id), (0.004, Unit::Mm, 0));
        assert!((finding.measured - 0.005).abs() < 1e-5, "{}", finding.measured);
        assert_eq!(report.worst_faces(1)[0].face.index(), 0);
        assert_eq!(report.worst.mm, finding.measured);
    }

    #[test]
    fn requirements_become_findings_only_when_asked_for() {
        let (open, peaks, ell) = (open_box(), octahedron(), ell_prism());
        for mesh in [&open, &peaks, &ell, &torus(5, 4)] {
            assert!(!with(mesh, &[Requirement::Planar]).has_findings());
        }
        assert_eq!(
            found(&with(&open, &[Requirement::Closed])),
            [(CheckKind::Closed, Element::Rim, 0)]
        );
        assert_eq!(found(&with(&open, &[Requirement::Valence3])), []);
        let report = with(&peaks, &[Requirement::Valence3]);
        assert_eq!(report.findings.len(), 6);
        assert_eq!((report.findings[5].id, report.findings[5].measured), (5, 4.0));
        assert!(report.conical.iter().all(|node| node.residual.is_some_and(|r| r < 1e-14)));
        let report = with(&ell, &[Requirement::Convex]);
        let kinds: Vec<_> =
            report.findings.iter().map(|f| (f.element, f.measured.round())).collect();
        assert_eq!(kinds, [(Element::Face, 270.0), (Element::Face, 270.0), (Element::Edge, 90.0)]);
        let report = with(&torus(5, 4), &[Requirement::Convex]);
        assert_eq!(
            (report.findings[0].element, report.findings[0].unit),
            (Element::Model, Unit::Handles)
        );
    }

    #[test]
    fn a_surface_that_touches_itself_is_not_manifold() {
        // Two cubes that share one corner: the builder pulls them apart.
        let mut points = cube_corners();
        points.extend(cube_corners().into_iter().skip(1).map(|p| p + 2.0));
        let second = CUBE_FACES.map(|f| f.map(|i| if i == 0 { 7 } else { i + 7 }));
        let mesh =
            Mesh::from_faces(points, CUBE_FACES.into_iter().chain(second)).expect("two cubes");
        let report = with(&mesh, &[Requirement::Manifold, Requirement::OneComponent]);
        let wanted = [
            (CheckKind::Manifold, Element::Vertex, 15),
            (CheckKind::OneComponent, Element::Model, 0),
        ];
        assert_eq!(found(&report), wanted);
    }

    #[test]
    fn slivers_points_and_crossed_faces_are_always_findings() {
        let mut mesh = cube();
        mesh.set_position(VertexId::new(1), mesh.position(VertexId::new(0)), true);
        let report = with(&mesh, &[]);
        let kinds: Vec<CheckKind> = report.findings.iter().map(|f| f.check).collect();
        // The side that lost a corner is bent, too.
        assert_eq!(kinds, [CheckKind::ZeroLengthEdge, CheckKind::Planarity]);
        let crossed = [[0., 0.], [2., 2.], [2., 0.], [0., 1.]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let mesh = Mesh::from_faces(crossed, [[0, 1, 2, 3]]).expect("a crossed face");
        assert_eq!(found(&with(&mesh, &[])), [(CheckKind::SelfIntersection, Element::Face, 0)]);
        let sliver = [[0., 0.], [1., 0.], [0.5, 1e-13]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let mesh = Mesh::from_faces(sliver, [[0, 1, 2]]).expect("a sliver");
        assert_eq!(found(&with(&mesh, &[])), [(CheckKind::DegenerateFace, Element::Face, 0)]);
        let mut lone = Mesh::new();
        lone.create_vertex(DVec3::ZERO);
        assert_eq!(found(&with(&lone, &[])), [(CheckKind::DegenerateFace, Element::Face, 0)]);
        assert!(!with(&Mesh::new(), &[]).has_findings());
    }

    #[test]
    fn the_same_mesh_gives_the_same_report() {
        let mesh = torus(7, 5);
        assert_eq!(with(&mesh, &ALL), with(&mesh, &ALL));
    }

    #[test]
    fn faces_that_go_through_each_other_are_named_when_asked_for() {
        // A square pierced by a triangle that stands on it, apart in the file.
        let points = [
            (0., 0., 0.),
            (4., 0., 0.),
            (4., 4., 0.),
            (0., 4., 0.),
            (1., 1., -1.),
            (3., 1., -1.),
            (2., 2., 1.),
        ];
        let points = points.map(|(x, y, z)| DVec3::new(x, y, z));
        let mesh = Mesh::from_faces(points, [vec![0, 1, 2, 3], vec![4, 5, 6]]).expect("two faces");
        let report = with(&mesh, &[Requirement::Simple]);
        assert_eq!(found(&report), [(CheckKind::Simple, Element::Face, 0)]);
        assert_eq!(report.findings[0].message, "face 0 goes through or covers face 1");
        let silent = with(&mesh, &[]);
        assert!(silent.findings.is_empty() && silent.crossings.len() == 1);
    }
}
