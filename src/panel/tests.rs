//! Plates as a whole: exact thickness, shared cuts, collisions.

use std::collections::HashMap;

use glam::{DVec2, DVec3};

use super::*;
use crate::geom::polygon::signed_area;
use crate::measure::{dihedral_angle, size, volume};
use crate::mesh::{HalfEdgeId, Mesh};
use crate::progress::Silent;
use crate::shape::{SolidParams, hexagonal_facade, random_tangent_polytope, solid, solid_names};
use crate::units::Length;

fn named(name: &str) -> Mesh {
    let params = SolidParams { name: name.parse().expect("a name"), ..SolidParams::default() };
    solid(&params).expect("a solid")
}

fn made(mesh: &Mesh, mm: f64, params: &PanelParams) -> Result<Plates, PanelError> {
    plates(mesh, Length::from_mm(mm), params, &Silent)
}

fn listed(mesh: &Mesh, made: &Plates) -> Schedule {
    schedule(mesh, made, &PanelParams::default(), &Silent).expect("nobody stops it")
}

fn all_solids() -> impl Iterator<Item = Mesh> {
    solid_names().filter(|n| !n.contains('N') && !n.contains('A')).map(named)
}

/// Where a side of a plate begins, at front and back, in space.
fn corners(plate: &Plate, h: HalfEdgeId) -> [DVec3; 2] {
    let i = plate.half_edges.iter().position(|&g| g == h).expect("a side of the plate");
    let at = plate.begins[i];
    [plate.on_front(plate.front[at]), plate.on_back(plate.back[at])]
}

/// The same where it ends.
fn far_corners(plate: &Plate, h: HalfEdgeId) -> [DVec3; 2] {
    let i = plate.half_edges.iter().position(|&g| g == h).expect("a side of the plate");
    let at = plate.ends[i];
    [plate.on_front(plate.front[at]), plate.on_back(plate.back[at])]
}

/// Thickness exact, neighbours meet in the same corners where three faces meet, and each side's
/// four corners lie in the plane of the mitre; all to 1e-12 of the size.
fn assert_exact(mesh: &Mesh, made: &Plates, gap: f64) {
    let (low, high) = mesh.bounds().expect("vertices");
    let size = (high - low).length();
    let bound = 1e-12 * size;
    let index: HashMap<_, _> = made.plates.iter().map(|p| (p.face, p)).collect();
    for plate in &made.plates {
        let normal = mesh.plane(plate.face).expect("an area").normal();
        for (&f, &b) in plate.front.iter().zip(&plate.back) {
            let (f, b) = (plate.on_front(f), plate.on_back(b));
            assert!(
                ((f - b).dot(normal) - plate.thickness).abs() <= bound,
                "thickness of {:?}",
                plate.face
            );
            assert!(
                (f - plate.on_front(plate.front[0])).dot(normal).abs() <= bound,
                "front not planar"
            );
            assert!(
                (b - plate.on_back(plate.back[0])).dot(normal).abs() <= bound,
                "back not planar"
            );
        }
    }
    for e in mesh.edges() {
        let [h, g] = e.half_edges();
        let (p, q) = (index[&mesh.face(h)], index[&mesh.face(g)]);
        // Along the edge, then across the mitre: the plane that both must share, moved apart by the
        // gap.
        let [a, b] = mesh.edge_positions(e);
        let [n, m] = [p, q].map(|plate| plate.frame.normal);
        let mitre = (b - a).cross(n + m).normalize();
        for (plate, side) in [(p, h), (q, g)] {
            for corner in [corners(plate, side), far_corners(plate, side)].concat() {
                let distance = ((corner - a).dot(mitre).abs() - gap / 2.0).abs();
                assert!(distance <= bound, "edge {e:?} is {distance} off its mitre");
            }
        }
        let is_exact = mesh.edge_vertices(e).iter().all(|&v| mesh.valence(v) == 3);
        if gap == 0.0 && is_exact {
            for (x, y) in [(h, mesh.next(g)), (mesh.next(h), g)] {
                let pairs = corners(p, x).into_iter().zip(corners(q, y));
                pairs.for_each(|(x, y)| {
                    assert!(x.distance(y) <= bound, "{e:?}: {} apart", x.distance(y))
                });
            }
        }
    }
}

#[test]
fn plates_of_all_solids_are_exact() {
    for mesh in all_solids() {
        for (side, gap) in
            [(ReferenceSide::Out, 0.0), (ReferenceSide::In, 0.0), (ReferenceSide::Mid, 1.0)]
        {
            let params = PanelParams { side, gap: Length::from_mm(gap), ..PanelParams::default() };
            let made = made(&mesh, 2.0, &params).expect("thin plates fit");
            assert_exact(&mesh, &made, gap);
        }
    }
}

#[test]
fn plates_of_random_solids_are_exact() {
    for seed in 0..3 {
        let mesh = random_tangent_polytope(1000, seed);
        let made =
            made(&mesh, 0.01, &PanelParams::default()).expect("offsets of a sphere shrink alike");
        assert_exact(&mesh, &made, 0.0);
        assert!(made.nodes.iter().all(|n| n.residual == 0.0 && n.miss_mm == 0.0));
    }
}

#[test]
fn the_plates_fill_the_shell_between_two_solids() {
    // Offsetting a tangent polytope of the unit sphere scales it, so the shell's volume is known.
    let mesh = random_tangent_polytope(60, 7);
    let made =
        made(&mesh, 0.25, &PanelParams::default()).expect("offsets of a sphere shrink alike");
    let sum: f64 = made.plates.iter().map(Plate::volume).sum();
    let shell = volume(&mesh) * (1.0 - 0.75_f64.powi(3));
    assert!((sum / shell - 1.0).abs() < 1e-12, "{sum} {shell}");
    let node = |n: &Node| n.back.distance(mesh.position(n.vertex) * 0.75) < 1e-12;
    assert!(made.nodes.iter().all(node));
}

#[test]
fn mitres_are_half_of_what_the_dihedral_angle_lacks() {
    for mesh in all_solids() {
        let made = made(&mesh, 2.0, &PanelParams::default()).expect("thin plates fit");
        for cut in &made.edges {
            let dihedral = dihedral_angle(&mesh, cut.edge).expect("two faces").to_degrees();
            for inset in cut.insets.iter().flatten() {
                assert!((inset.bevel(2.0).to_degrees() - (180.0 - dihedral) / 2.0).abs() < 1e-10);
            }
        }
    }
}

#[test]
fn the_regular_octahedron_meets_and_a_skewed_one_tells_how_far_it_does_not() {
    let mut mesh = named("octahedron");
    let meets = made(&mesh, 3.0, &PanelParams::default()).expect("fits");
    assert!(meets.nodes.iter().all(|n| n.valence == 4 && n.residual < 1e-12 && n.miss_mm < 1e-12));
    let v = mesh.vertices().next().expect("a vertex");
    mesh.set_position(v, mesh.position(v) + DVec3::new(6.0, 9.0, -4.0), false);
    let skewed = made(&mesh, 3.0, &PanelParams::default()).expect("fits");
    let worst = skewed.nodes.iter().map(|n| n.residual).fold(0.0, f64::max);
    assert!(worst > 1e-3, "{worst}");
    for node in &skewed.nodes {
        // Twice the thickness, twice the miss.
        assert!(node.miss_mm >= 0.9 * 3.0 * node.residual, "{node:?}");
    }
    // The plates themselves stay planar and of exact thickness, and share their mitres.
    assert_exact(&mesh, &skewed, 0.0);
}

#[test]
fn different_thicknesses_still_meet_at_three_valent_nodes() {
    let mut mesh = named("dodecahedron");
    let faces: Vec<_> = mesh.faces().collect();
    faces.iter().step_by(2).for_each(|&f| mesh.set_group(f, "thick"));
    let thick = "thick=4mm".parse().expect("a group");
    let params = PanelParams {
        thickness_of: vec![thick],
        side: ReferenceSide::Mid,
        ..PanelParams::default()
    };
    let made = made(&mesh, 2.0, &params).expect("fits");
    let plate =
        |h: HalfEdgeId| made.plates.iter().find(|p| p.face == mesh.face(h)).expect("a plate");
    for node in &made.nodes {
        for h in mesh.outgoing(node.vertex) {
            let [front, back] = corners(plate(h), h);
            assert!(
                front.distance(node.front) < 1e-10 && back.distance(node.back) < 1e-10,
                "{node:?}"
            );
        }
    }
    let unknown = PanelParams {
        thickness_of: vec!["roof=1".parse().expect("a group")],
        ..PanelParams::default()
    };
    let error = super::tests::made(&mesh, 2.0, &unknown).expect_err("no such group").to_string();
    assert!(error.contains("its groups are thick"), "{error}");
}

/// A box of 100 × 80 × 4 mm with a corner cut off, so that it has a short edge.
fn chamfered() -> Mesh {
    let at = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
    let flat = [(0., 0.), (98., 0.), (100., 2.), (100., 80.), (0., 80.)];
    let points =
        flat.iter().map(|&(x, y)| at(x, y, 0.0)).chain(flat.iter().map(|&(x, y)| at(x, y, 60.0)));
    let sides = (0..5).map(|i| vec![i, (i + 1) % 5, (i + 1) % 5 + 5, i + 5]);
    let faces = [vec![4, 3, 2, 1, 0], vec![5, 6, 7, 8, 9]].into_iter().chain(sides);
    Mesh::from_faces(points, faces).expect("a box")
}

#[test]
fn collisions_are_named_with_the_largest_thickness_that_works() {
    let mesh = chamfered();
    let short = 8_f64.sqrt();
    // Both ends of the short edge move in by tan(22.5°) per mm of thickness.
    let expected = short / (2.0 * 22.5_f64.to_radians().tan());
    let error = made(&mesh, 5.0, &PanelParams::default()).expect_err("too thick");
    let PanelError::Collision { found } = &error else { panic!("{error}") };
    assert!(found.iter().all(|c| (c.largest - expected).abs() < 1e-9), "{found:?}");
    assert!(error.to_string().contains("3.414 mm"), "{error}");
    assert!(made(&mesh, expected * 0.999, &PanelParams::default()).is_ok());
    assert!(made(&mesh, expected * 1.001, &PanelParams::default()).is_err());
    // Where all sides of a cube's plates would vanish, a little less is advised, and that works.
    let cube = named("box-20x20x20");
    let error =
        made(&cube, 10.0, &PanelParams::default()).expect_err("nothing is left of the backs");
    assert!(error.to_string().contains("works everywhere is 9.99 mm"), "{error}");
    assert!(made(&cube, 9.99, &PanelParams::default()).is_ok());
    // Outwards there is room for anything.
    let outwards = PanelParams { side: ReferenceSide::In, ..PanelParams::default() };
    assert!(made(&mesh, 50.0, &outwards).is_ok());
    let wide = PanelParams { gap: Length::from_mm(70.0), ..outwards };
    let error = made(&mesh, 1.0, &wide).expect_err("the gap alone is too wide");
    assert!(error.to_string().contains("make the gap narrower"), "{error}");
}

/// An open L of three plates, standing on its rim: two walls and a concave floor.
fn concave_shell() -> Mesh {
    let flat = [(0., 0.), (60., 0.), (60., 30.), (30., 30.), (30., 60.), (0., 60.)];
    let points = flat
        .iter()
        .map(|&(x, y)| DVec3::new(x * 1.2, y * 1.2, 0.0))
        .chain(flat.iter().map(|&(x, y)| DVec3::new(x + 6.0, y + 6.0, 40.0)));
    let walls = (0..6).map(|i| vec![i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6]);
    Mesh::from_faces(points, walls.chain([vec![6, 7, 8, 9, 10, 11]])).expect("a shell")
}

#[test]
fn concave_panels_and_concave_edges_are_exact() {
    let mesh = concave_shell();
    let made = made(&mesh, 2.0, &PanelParams::default()).expect("fits");
    let floor = &made.plates[6];
    assert_eq!(floor.front.len(), 6);
    assert!(signed_area(&floor.back) < signed_area(&floor.front));
    let concave = made.edges.iter().filter(|c| c.fold.is_some_and(|f| f < -0.1)).count();
    assert!(concave >= 1);
    for node in made.nodes.iter().filter(|n| !n.is_rim) {
        for h in mesh.outgoing(node.vertex) {
            let plate = made.plates.iter().find(|p| p.face == mesh.face(h)).expect("a plate");
            let [front, back] = corners(plate, h);
            assert!(
                front.distance(node.front) < 1e-11 && back.distance(node.back) < 1e-11,
                "{node:?}"
            );
        }
    }
}

#[test]
fn rims_are_cut_square_plumb_or_along_their_plane() {
    let mesh = concave_shell();
    let square = |(cut, normal): &(DVec3, DVec3)| cut.dot(*normal).abs() < 1e-12;
    assert!(rim_cuts(&mesh, RimCut::Square).iter().all(square));
    // These walls are too upright to be cut plumb.
    assert!(rim_cuts(&mesh, RimCut::Plumb).iter().all(square));
    assert!(
        rim_cuts(&mesh, RimCut::Bisected)
            .iter()
            .all(|(cut, _)| cut.cross(DVec3::Z).length() < 1e-12)
    );
    let base = [(-50., -50., 0.), (50., -50., 0.), (50., 50., 3.), (-50., 50., 0.), (0., 0., 30.)];
    let roof =
        Mesh::from_faces(base.map(DVec3::from), [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
            .expect("a roof");
    let plumb = rim_cuts(&roof, RimCut::Plumb);
    assert!(plumb.iter().all(|(cut, normal)| cut.z.abs() < 1e-12 && cut.dot(*normal).abs() > 0.1));
}

/// The unit normals of the cuts along the rim, with those of their plates.
fn rim_cuts(mesh: &Mesh, rim: RimCut) -> Vec<(DVec3, DVec3)> {
    let made = made(mesh, 2.0, &PanelParams { rim, ..PanelParams::default() }).expect("fits");
    let across = |cut: &EdgeCut| {
        let h = cut
            .edge
            .half_edges()
            .into_iter()
            .find(|&h| !mesh.is_hole(mesh.face(h)))
            .expect("one plate");
        let plate = made.plates.iter().find(|p| p.face == mesh.face(h)).expect("a plate");
        let i = plate.half_edges.iter().position(|&g| g == h).expect("a side");
        let n = plate.front.len();
        let along = plate.on_front(plate.front[(i + 1) % n]) - plate.on_front(plate.front[i]);
        let over = plate.on_back(plate.back[i]) - plate.on_front(plate.front[i]);
        (along.cross(over).normalize(), plate.frame.normal)
    };
    made.edges.iter().filter(|c| mesh.is_rim(c.edge)).map(across).collect()
}

#[test]
fn square_cuts_stay_inside_the_bevelled_plates_and_open_a_v() {
    let mesh = named("dodecahedron");
    let bevelled = made(&mesh, 3.0, &PanelParams::default()).expect("fits");
    let params = PanelParams { cutting: CutStyle::Square, ..PanelParams::default() };
    let square = made(&mesh, 3.0, &params).expect("fits");
    for (bevel, square) in bevelled.plates.iter().zip(&square.plates) {
        assert_eq!((&square.front, &square.back), (&square.back, &square.blank));
        let same = square.front.iter().zip(&bevel.back).all(|(a, b)| a.distance(*b) < 1e-12);
        assert!(same, "of a convex solid the backs are smaller");
        assert_eq!(bevel.blank, bevel.front);
    }
    for cut in &square.edges {
        let half = cut.fold.expect("no rim") / 2.0;
        let [front, back] = cut.opening.expect("a V");
        assert!((front - 6.0 * half.sin()).abs() < 1e-10 && back < 1e-10, "{front} {back}");
    }
}

#[test]
fn fingers_interlock_and_never_overlap() {
    let mesh = named("box-80x60x50");
    let params = PanelParams { edges: EdgeKind::Finger.into(), ..PanelParams::default() };
    let made = made(&mesh, 4.0, &params).expect("fits");
    assert!(made.edges.iter().all(|c| c.kind == EdgeKind::Finger && c.fallback.is_none()));
    for plate in &made.plates {
        assert_eq!(plate.front, plate.back);
        assert!(plate.front.len() > 12, "{}", plate.front.len());
    }
    // Together the plates fill the shell but for the three-way corners, and a quarter of the
    // thickness at the ends of the edges.
    let sum: f64 = made.plates.iter().map(Plate::volume).sum();
    let shell = 80.0 * 60.0 * 50.0 - 72.0 * 52.0 * 42.0;
    assert!((shell - sum - 8.0 * 64.0 - 24.0 * 16.0).abs() < 1e-6, "{sum} {shell}");
}

#[test]
fn what_fingers_cannot_hold_falls_back_and_says_so() {
    let mesh = named("soccer-ball");
    let params = PanelParams {
        edges: "0-180:finger".parse().expect("rules"),
        shallow: Shallow::Stitch,
        ..PanelParams::default()
    };
    let made = made(&mesh, 2.0, &params).expect("fits");
    let fingers = made.edges.iter().filter(|c| c.kind == EdgeKind::Finger).count();
    let fallen = made.edges.iter().filter(|c| c.fallback.is_some()).count();
    let stitched = made.edges.iter().filter(|c| c.kind == EdgeKind::Stitch).count();
    // Hexagons meet at 138.2°, hexagons and pentagons at 142.6°.
    assert_eq!((fingers, fallen, stitched), (30, 60, 60));
    assert!(
        made.edges
            .iter()
            .filter_map(|c| c.fallback)
            .all(|f| f == (EdgeKind::Finger, EdgeFallback::Shallow))
    );
}

#[test]
fn holes_stand_opposite_each_other_and_keep_clear() {
    let mesh = named("cube");
    let hardware = Hardware { hole_spacing: Some(Length::from_mm(20.0)), ..Hardware::default() };
    let params = PanelParams { edges: EdgeKind::Stitch.into(), hardware, ..PanelParams::default() };
    let made = made(&mesh, 3.0, &params).expect("fits");
    // Of the three edges at a corner one gets the hole there, since those of two would touch on
    // their common plate.
    assert_eq!((made.hole_pairs, made.lost_hole_pairs), (12 * 5 - 16, 16));
    for plate in &made.plates {
        for hole in &plate.holes {
            // 3 mm of mitre and twice the diameter from its own edge; the nearest hole of another
            // edge may be at 10 mm.
            let sides = plate.reference.iter().zip(plate.reference.iter().cycle().skip(1));
            let mut insets = sides.map(|(&a, &b)| (b - a).normalize().perp_dot(hole.centre - a));
            assert!(insets.any(|inset| (inset - 11.0).abs() < 1e-9));
        }
    }
}

#[test]
fn relieved_corners_take_the_depth_asked_for() {
    let mesh = named("cube");
    let params = PanelParams { corner_relief: Length::from_mm(5.0), ..PanelParams::default() };
    let made = made(&mesh, 3.0, &params).expect("fits");
    for plate in &made.plates {
        assert_eq!(
            (plate.front.len(), plate.back.len(), plate.begins.as_slice()),
            (8, 8, &[1, 3, 5, 7][..])
        );
        let chamfer = plate.back[1].distance(plate.back[0]);
        assert!((chamfer - 10.0).abs() < 1e-9, "{chamfer}");
    }
    let deep = PanelParams { corner_relief: Length::from_mm(40.0), ..PanelParams::default() };
    let made = super::tests::made(&mesh, 3.0, &deep).expect("fits");
    assert_eq!(made.unrelieved_corners, 24);
}

#[test]
fn facades_are_exact_and_saddles_have_concave_panels() {
    for (radii, has_concave) in [([60_000.0, 40_000.0], false), ([40_000.0, -40_000.0], true)] {
        let mesh = hexagonal_facade(12, 10, 1000.0, radii);
        let gap = 8.0;
        let params = PanelParams { gap: Length::from_mm(gap), ..PanelParams::default() };
        let made = made(&mesh, 10.0, &params).expect("fits");
        assert_eq!(made.plates.iter().any(Plate::is_concave), has_concave);
        let size = size(&mesh).length();
        for cut in &made.edges {
            let Some([front, back]) = cut.opening else { continue };
            assert!(
                (front - gap).abs() < 1e-12 * size && (back - gap).abs() < 1e-12 * size,
                "{front} {back}"
            );
        }
        assert!(made.nodes.iter().all(|n| n.valence <= 3 && n.residual == 0.0));
        let listed = schedule(&mesh, &made, &params, &Silent).expect("nobody stops it");
        // The surface has two mirror planes or its panels come at least in pairs turned by half a
        // turn.
        assert!(listed.groups.len() <= 60, "{} groups", listed.groups.len());
        assert!(listed.panels.iter().all(|p| p.planarity < 1e-9 && p.mass > 15.0 && p.mass < 22.0));
    }
}

#[test]
fn mirror_images_are_told_from_copies() {
    let snub = made(&named("snub-cube"), 2.0, &PanelParams::default()).expect("fits");
    let rows = listed(&named("snub-cube"), &snub).groups;
    // Squares, triangles among triangles, and triangles beside squares, which have one bevel of
    // another kind.
    let mut sizes: Vec<usize> = rows.iter().map(|r| r.panels.len()).collect();
    sizes.sort_unstable();
    assert_eq!(sizes, [6, 8, 24]);
    let mesh = random_tangent_polytope(12, 3);
    let plates = made(&mesh, 0.05, &PanelParams::default()).expect("fits").plates;
    let plate = plates.iter().find(|p| p.front.len() > 4).expect("a panel without symmetry");
    let mut mirrored = plate.clone();
    let flipped = |points: &[DVec2]| {
        points.iter().rev().map(|p| DVec2::new(5.0 - p.x, p.y + 3.0)).collect::<Vec<_>>()
    };
    (mirrored.front, mirrored.back) = (flipped(&plate.front), flipped(&plate.back));
    let found =
        twins(&[plate.clone(), mirrored, plate.clone()], 1e-6, &Silent).expect("nobody stops it");
    assert_eq!(found[1], Twin { first: 0, is_mirrored: true });
    assert_eq!(found[2], Twin { first: 0, is_mirrored: false });
    assert_eq!(
        twins(&plates, 1e-6, &Silent)
            .expect("nobody stops it")
            .iter()
            .filter(|t| t.is_mirrored)
            .count(),
        0
    );
}

#[test]
fn size_and_place_change_nothing_but_the_numbers() {
    let mesh = named("truncated-octahedron");
    let here = made(&mesh, 2.0, &PanelParams::default()).expect("fits");
    for (scale, far) in [(1e-3, DVec3::ZERO), (1e3, DVec3::ZERO), (1.0, DVec3::new(1e6, -2e6, 5e5))]
    {
        let mut moved = mesh.clone();
        moved.clear_planes();
        moved.vertices().collect::<Vec<_>>().into_iter().for_each(|v| {
            moved.set_position(v, mesh.position(v) * scale + far, false);
        });
        let there = made(&moved, 2.0 * scale, &PanelParams::default()).expect("fits");
        let bound = 1e-9 * scale + 1e-15 * far.length();
        for (a, b) in here.plates.iter().zip(&there.plates) {
            let same = |p: &[DVec2], q: &[DVec2]| {
                p.iter().zip(q).all(|(p, q)| (*p * scale).distance(*q) < 1e3 * bound)
            };
            assert!(same(&a.front, &b.front) && same(&a.back, &b.back), "{scale} {far}");
        }
    }
}
