//! Plates keep out of each other, whatever the model, the joints and the thickness; and their
//! bodies are closed.
//!
//! Judged by code that shares nothing with the house's own test of overlaps, which measures volumes
//! of convex parts: here the edges of one plate are followed through the other. Where two bodies
//! overlap, an edge of one of them runs inside the other.

#[path = "plates_apart/inside.rs"]
mod inside;
#[path = "plates_apart/models.rs"]
mod models;

use std::collections::BTreeMap;

use kerfold::mesh::Mesh;
use kerfold::panel::{
    CutStyle, EdgeFallback, EdgeKind, Hardware, PanelError, PanelParams, Plates, ReferenceSide,
    RimCut, plates, schedule, solid,
};
use kerfold::progress::Silent;
use kerfold::units::Length;

use inside::overlapping;
use models::{
    open_polytope, reflex_rim, rounded, saddle, solids, star_prism, thin_slab, tilted_cube,
};

fn make(mesh: &Mesh, mm: f64, params: &PanelParams) -> Result<Plates, PanelError> {
    plates(mesh, Length::from_mm(mm), params, &Silent)
}

/// Plates lie apart, their bodies are closed, and the schedule lists what they are.
fn assert_right(mesh: &Mesh, made: &Plates, params: &PanelParams, title: &str) {
    let found = overlapping(&made.plates);
    assert!(found.is_empty(), "{title}: {found:?}");
    for plate in &made.plates {
        let body = solid(plate).unwrap_or_else(|e| panic!("{title}: {e}"));
        let mut edges: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for &[a, b, c] in body.faces.iter().flat_map(|face| &face.triangles) {
            [(a, b), (b, c), (c, a)].into_iter().for_each(|e| *edges.entry(e).or_default() += 1);
        }
        let is_paired =
            |(&(a, b), &n): (&(u32, u32), &usize)| n == 1 && edges.get(&(b, a)) == Some(&1);
        assert!(edges.iter().all(is_paired), "{title}: face {:?}", plate.face);
        if plate.holes.is_empty() {
            let (volume, listed) = (body.volume(), plate.volume());
            assert!((volume - listed).abs() < 1e-9 * listed, "{title}: {volume} {listed}");
        }
    }
    let listed = schedule(mesh, made, params, &Silent).expect("nobody stops it");
    assert_eq!(listed.panels.len(), made.plates.len(), "{title}");
    let mass: f64 = made.plates.iter().map(|p| p.volume() * params.density_kg_m3() * 1e-9).sum();
    assert!((listed.totals.mass - mass).abs() <= 1e-12 * mass, "{title}");
    assert_eq!(listed.groups.iter().map(|g| g.panels.len()).sum::<usize>(), listed.panels.len());
    for cut in &made.node_cuts {
        assert!(cut.overlap_mm3 > 0.0 && cut.cut_mm.iter().any(|&mm| mm > 0.0), "{title}: {cut:?}");
    }
}

const KINDS: [EdgeKind; 5] =
    [EdgeKind::Mitre, EdgeKind::Butt, EdgeKind::Finger, EdgeKind::Stitch, EdgeKind::Hinge];
const SIDES: [ReferenceSide; 3] = [ReferenceSide::In, ReferenceSide::Mid, ReferenceSide::Out];

/// Plates of all kinds, sides and gaps. `share` is the thickness as a part of the shortest edge.
/// Thick plates that run into themselves are refused, which is counted; thin ones fit.
fn all_kinds(mesh: &Mesh, share: f64, title: &str) -> usize {
    let edges = mesh.edges().map(|e| mesh.edge_positions(e)).map(|[a, b]| a.distance(b));
    let thickness = share * edges.fold(f64::INFINITY, f64::min);
    let mut refused = 0;
    // Thick stitched and hinged plates end where mitred ones do.
    let kinds = if share > 0.1 { &KINDS[..3] } else { &KINDS };
    for &kind in kinds {
        for (side, gap) in SIDES.into_iter().zip([0.0, 0.2, 0.0]) {
            let cutting = if kind == EdgeKind::Finger { CutStyle::Square } else { CutStyle::Bevel };
            let gap = Length::from_mm(gap * thickness);
            let hardware = Hardware {
                finger_width: Some(Length::from_mm(15.0)),
                hole_spacing: matches!(kind, EdgeKind::Stitch | EdgeKind::Hinge)
                    .then(|| Length::from_mm(20.0)),
                ..Hardware::default()
            };
            let params = PanelParams {
                side,
                gap,
                cutting,
                edges: kind.into(),
                hardware,
                ..PanelParams::default()
            };
            let title = format!("{title} {thickness} {} {side:?} {gap}", kind.name());
            match make(mesh, thickness, &params) {
                Ok(made) => assert_right(mesh, &made, &params, &title),
                Err(PanelError::Collision { .. }) if share > 0.1 => refused += 1,
                Err(error) => panic!("{title}: {error}"),
            }
        }
    }
    refused
}

#[test]
fn plates_of_all_solids_keep_apart() {
    let mut refused = 0;
    for (name, mesh) in solids() {
        all_kinds(&mesh, 0.03, name);
        refused += all_kinds(&mesh, 0.2, name);
    }
    assert!(refused < 60, "{refused} thick ones were refused");
}

#[test]
fn plates_of_random_models_keep_apart() {
    for seed in 0..3 {
        let star = star_prism(7 + seed as usize, seed);
        all_kinds(&star, 0.05, &format!("star {seed}"));
        let open = open_polytope(24, seed);
        all_kinds(&open, 0.02, &format!("open {seed}"));
    }
    all_kinds(&saddle(), 0.03, "saddle");
}

#[test]
fn rims_with_reflex_corners_keep_apart() {
    for rim in [RimCut::Square, RimCut::Plumb, RimCut::Bisected] {
        for (side, mm) in SIDES.into_iter().flat_map(|side| [(side, 3.0), (side, 20.0)]) {
            let params = PanelParams { rim, side, ..PanelParams::default() };
            for (title, mesh) in [("ell", reflex_rim()), ("saddle", saddle())] {
                let mm = if title == "saddle" { mm * 0.4 } else { mm };
                let made = make(&mesh, mm, &params).unwrap_or_else(|e| panic!("{title}: {e}"));
                assert_right(&mesh, &made, &params, &format!("{title} {rim:?} {side:?} {mm}"));
                if title == "ell" && side == ReferenceSide::Out && mm == 20.0 {
                    assert_eq!(made.node_cuts.len(), 1, "the two plates meet behind the corner");
                }
            }
        }
    }
}

#[test]
fn butt_joints_at_nodes_of_four_are_cut_back_and_listed() {
    let (_, mesh) = solids().find(|(name, _)| *name == "cuboctahedron").expect("a solid");
    let params = PanelParams {
        side: ReferenceSide::Mid,
        gap: Length::from_mm(8.0),
        edges: EdgeKind::Butt.into(),
        ..PanelParams::default()
    };
    let made = make(&mesh, 5.0, &params).expect("fits");
    assert_right(&mesh, &made, &params, "cuboctahedron");
    assert!(!made.node_cuts.is_empty());
    let fallen = |why: EdgeFallback| {
        made.edges.iter().filter(|e| e.fallback.is_some_and(|(_, w)| w == why)).count()
    };
    assert_eq!(fallen(EdgeFallback::Overlap), 0, "cutting corners is enough");
}

#[test]
fn files_with_few_digits_keep_apart_and_bent_faces_are_found_or_refused() {
    let params = PanelParams::default();
    for decimals in [1, 3, 6] {
        for (name, mesh) in solids().filter(|(name, _)| name.contains("truncated")) {
            let mesh = rounded(&mesh, decimals);
            let made = make(&mesh, 2.0, &params).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_right(&mesh, &made, &params, &format!("{name} with {decimals} decimals"));
        }
    }
    let mesh = tilted_cube(0.4);
    let made = make(&mesh, 3.0, &params).expect("within a millimetre");
    assert_right(&mesh, &made, &params, "a cube with one corner moved");
    assert!(made.nodes.iter().any(|n| n.miss_mm > 0.05), "its plates do not meet");
    let findings = kerfold::panel::panel_findings(&mesh, &made, &params);
    assert_eq!(findings.len(), 3, "the three faces of the corner");
    let error = make(&tilted_cube(20.0), 3.0, &params).expect_err("far from planar");
    assert!(matches!(&error, PanelError::NotPlanar { found } if found.len() == 3), "{error}");
}

#[test]
fn what_no_cut_can_part_is_refused_with_its_places() {
    let params = PanelParams { side: ReferenceSide::In, ..PanelParams::default() };
    let error = make(&thin_slab(4.0), 3.0, &params).expect_err("two walls in one place");
    let PanelError::Overlap { found } = &error else { panic!("{error}") };
    assert!(found.iter().any(|o| o.vertex.is_none() && o.mm3 > 1.0), "{found:?}");
    assert!(error.to_string().contains("share"), "{error}");
    assert!(make(&thin_slab(4.0), 1.0, &params).is_ok());
}
