use super::*;
use crate::measure::{genus, planarity, volume};
use crate::shape;

fn run(mesh: &Mesh, params: &RindParams) -> (Mesh, RindReport) {
    let (made, report) = rind(mesh, params, &OpContext::default()).expect("a rind");
    assert!(made.faults().is_empty(), "{:?}", &made.faults()[..made.faults().len().min(4)]);
    assert_eq!((genus(&made), made.components().len()), (report.genus, report.components));
    assert!(made.is_closed() && volume(&made) > 0.0);
    (made, report)
}

fn params(thickness: f64, punch: &[u32], peel: &[u32]) -> RindParams {
    let chosen = |ids: &[u32]| Selection::of_faces(ids.iter().map(|&f| FaceId::new(f as usize)));
    RindParams {
        thickness: Length::from_mm(thickness),
        thickness_of: Vec::new(),
        punch: chosen(punch),
        peel: chosen(peel),
        shell: ShellSource::New,
    }
}

fn counts(mesh: &Mesh) -> [usize; 3] {
    [mesh.vertex_count(), mesh.edge_count(), mesh.face_count()]
}

/// Two faces of a cube that are opposite, and one beside both.
fn opposite_and_beside(mesh: &Mesh) -> [u32; 3] {
    let beside = mesh.edge_faces(mesh.edges().next().expect("edges"))[1];
    let first = mesh.edge_faces(mesh.edges().next().expect("edges"))[0];
    let touches = |f: FaceId| mesh.face_half_edges(f).any(|h| mesh.face(h.twin()) == first);
    let opposite = mesh.faces().find(|&f| f != first && !touches(f)).expect("six faces");
    [first, opposite, beside].map(|f| f.index() as u32)
}

fn platonic() -> [Mesh; 5] {
    shape::Platonic::ALL.map(|solid| shape::platonic(solid, 10.0))
}

/// A quarter of the faces to punch and a quarter to peel, at random; the last face stays.
fn some_openings(mesh: &Mesh, random: &mut u64) -> [Vec<u32>; 2] {
    let mut sets = [Vec::new(), Vec::new()];
    for f in 0..mesh.face_count() as u32 - 1 {
        *random = random.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        if let Some(set) = sets.get_mut((*random >> 60) as usize % 4) {
            set.push(f);
        }
    }
    sets
}

#[test]
fn counts_are_those_that_were_measured_and_volumes_exact() {
    let cube = shape::cube(10.0);
    let [a, b, c] = opposite_and_beside(&cube);
    let (shell, report) = run(&cube, &params(2.0, &[], &[]));
    assert_eq!((counts(&shell), report.components, report.made.faces.len()), ([16, 24, 12], 2, 6));
    assert!((volume(&shell) - (1000.0 - 216.0)).abs() < 1e-10);
    let (shell, _) = run(&cube, &params(2.0, &[a], &[]));
    assert_eq!((counts(&shell), genus(&shell)), ([16, 28, 14], 0));
    let (shell, _) = run(&cube, &params(2.0, &[a, b], &[]));
    assert_eq!((counts(&shell), genus(&shell)), ([16, 32, 16], 1));
    // Neighbours: a wall without thickness that goes when one of them is peeled. At either end of
    // it two edges join the skins, of which one gets a vertex in between.
    let (shell, report) = run(&cube, &params(2.0, &[a, c], &[]));
    assert_eq!((counts(&shell), genus(&shell), report.mended.split), ([18, 34, 16], 1, 2));
    assert!(report.pairs.is_empty(), "{:?}", report.pairs);
    let (shell, report) = run(&cube, &params(2.0, &[a], &[c]));
    assert_eq!((counts(&shell), genus(&shell), report.walls_removed), ([16, 28, 14], 0, 1));
    let corner: Vec<u32> = cube
        .vertex_faces(cube.vertices().next().expect("corners"))
        .map(|f| f.index() as u32)
        .collect();
    let (shell, _) = run(&cube, &params(2.0, &[], &corner));
    assert_eq!((counts(&shell), genus(&shell)), ([14, 24, 12], 0));
    // All around: two plates.
    let belt: Vec<u32> = (0..6).filter(|f| ![a, b].contains(f)).collect();
    let (shell, report) = run(&cube, &params(2.0, &[], &belt));
    assert_eq!((counts(&shell), report.components), ([16, 24, 12], 2));
}

#[test]
fn outwards_is_the_larger_shell() {
    let cube = shape::cube(10.0);
    let (shell, _) = run(&cube, &params(-1.0, &[0], &[1, 2]));
    assert_eq!(volume(&run(&cube, &params(-1.0, &[], &[])).0).round(), 1728.0 - 1000.0);
    assert!(volume(&shell) < 728.0);
    let given = shell.vertices().filter(|&v| shell.is_given(v)).count();
    assert_eq!(given, cube.vertices().filter(|&v| cube.is_given(v)).count());
}

#[test]
fn every_set_of_openings_leaves_the_genus_that_its_shape_demands() {
    let solids = [&platonic()[..], &[shape::soccer_ball(10.0)]].concat();
    let mut random = 12345_u64;
    for mesh in &solids {
        for _ in 0..40 {
            let sets = some_openings(mesh, &mut random);
            let (_, report) = run(mesh, &params(0.5, &sets[0], &sets[1]));
            assert!(report.residual_mm == 0.0 && report.crossing.is_empty(), "{report:?}");
            let is_apart = |f: &u32| {
                let f = FaceId::new(*f as usize);
                mesh.face_half_edges(f).all(|h| {
                    !sets.iter().flatten().any(|g| mesh.face(h.twin()).index() == *g as usize)
                })
            };
            if sets.iter().flatten().all(is_apart) && report.openings > 0 {
                assert_eq!(report.genus, report.openings - 1);
            }
        }
    }
}

#[test]
fn the_second_skin_is_parallel_and_planar() {
    let ball = shape::soccer_ball(20.0);
    let (shell, _) = run(&ball, &params(1.5, &[0], &[]));
    for f in shell.faces() {
        assert!(planarity(&shell, f).mm < 1e-11, "{f}");
    }
}

#[test]
fn too_much_thickness_is_told_with_the_faces() {
    let cuboid = shape::cuboid(glam::DVec3::new(10.0, 20.0, 30.0));
    assert!(run(&cuboid, &params(4.9, &[], &[])).1.crossing.is_empty());
    let (_, report) = rind(&cuboid, &params(5.1, &[], &[]), &OpContext::default()).expect("a rind");
    assert_eq!(report.crossing.len(), 6);
    // No side turns round, but the dent comes too near to the bottom.
    let points = (0..8).map(|i| {
        glam::DVec3::new([-10.0, 10.0][i & 1], [-10.0, 10.0][i >> 1 & 1], [0.0, 10.0][i >> 2])
    });
    let points = points.chain([glam::DVec3::Z]);
    let sides =
        [vec![0, 2, 3, 1], vec![0, 1, 5, 4], vec![2, 6, 7, 3], vec![0, 4, 6, 2], vec![1, 3, 7, 5]];
    let dent = [[4, 5, 8], [5, 7, 8], [7, 6, 8], [6, 4, 8]].map(|t| t.to_vec());
    let dented = Mesh::from_faces(points, sides.into_iter().chain(dent)).expect("a dented box");
    assert!(run(&dented, &params(0.4, &[], &[])).1.crossing.is_empty());
    let (_, report) = rind(&dented, &params(1.0, &[], &[]), &OpContext::default()).expect("a rind");
    assert!(report.crossing.contains(&0), "{report:?}");
}

#[test]
fn a_group_can_have_a_thickness_of_its_own() {
    let mut cube = shape::cube(10.0);
    cube.set_group(FaceId::new(3), "lid");
    let mut thick = params(1.0, &[], &[]);
    thick.thickness_of = vec!["lid=3mm".parse().expect("a group's thickness")];
    let (shell, _) = run(&cube, &thick);
    assert!((volume(&shell) - (1000.0 - 8.0 * 8.0 * 6.0)).abs() < 1e-10);
    thick.thickness_of = vec!["bottom=3mm".parse().expect("a group's thickness")];
    assert!(matches!(rind(&cube, &thick, &OpContext::default()), Err(OpError::NoSuchGroup { .. })));
    thick.thickness_of = vec!["lid=-3mm".parse().expect("a group's thickness")];
    assert!(matches!(rind(&cube, &thick, &OpContext::default()), Err(OpError::Exclude { .. })));
    assert!(
        "lid".parse::<GroupThickness>().is_err() && "lid=wide".parse::<GroupThickness>().is_err()
    );
}

#[test]
fn an_open_sheet_becomes_a_slab() {
    let points =
        [(0.0, 0.0), (4.0, 0.0), (4.0, 3.0), (0.0, 3.0)].map(|(x, y)| glam::DVec3::new(x, y, 0.0));
    let sheet = Mesh::from_faces(points, [[0, 1, 2, 3]]).expect("a rectangle");
    let (slab, report) = run(&sheet, &params(0.5, &[], &[]));
    assert!((volume(&slab) - 6.0).abs() < 1e-12);
    assert_eq!((counts(&slab), report.genus), ([8, 12, 6], 0));
}

#[test]
fn what_cannot_be_is_refused() {
    let cube = shape::cube(10.0);
    let refuse = |p: &RindParams| rind(&cube, p, &OpContext::default()).expect_err("refused");
    assert!(matches!(refuse(&params(0.0, &[], &[])), OpError::DepthTooSmall { .. }));
    assert!(matches!(refuse(&params(f64::NAN, &[], &[])), OpError::DepthTooSmall { .. }));
    assert!(matches!(refuse(&params(1.0, &[], &[0, 1, 2, 3, 4, 5])), OpError::AllOpened));
    assert!(matches!(refuse(&params(1.0, &[9], &[])), OpError::Select(_)));
}

/// The openings of a shell that was made before are those of one that is made at once.
#[test]
fn a_given_shell_is_opened_as_a_new_one_would_be() {
    let mut random = 99_u64;
    for mesh in &platonic() {
        let (shell, _) = run(mesh, &params(0.5, &[], &[]));
        for _ in 0..30 {
            let sets = some_openings(mesh, &mut random);
            if sets.iter().all(Vec::is_empty) {
                continue;
            }
            let (wanted, at_once) = run(mesh, &params(0.5, &sets[0], &sets[1]));
            // Some faces are named on the first skin, the others by what lies behind them.
            let behind = |f: u32| 2 * f + f % 2;
            let named = sets.map(|set| set.into_iter().map(behind).collect::<Vec<u32>>());
            let mut given = params(0.6, &named[0], &named[1]);
            given.shell = ShellSource::Given;
            let (opened, report) = run(&shell, &given);
            assert_eq!(counts(&opened), counts(&wanted), "{named:?}");
            assert_eq!(
                (report.openings, report.walls_removed),
                (at_once.openings, at_once.walls_removed)
            );
            assert_eq!((report.genus, report.components), (at_once.genus, at_once.components));
            assert!((volume(&opened) - volume(&wanted)).abs() < 1e-9 * volume(mesh));
        }
    }
}

#[test]
fn a_face_without_a_partner_is_refused() {
    let cube = shape::cube(10.0);
    let mut given = params(2.0, &[0], &[]);
    given.shell = ShellSource::Given;
    let refused = rind(&cube, &given, &OpContext::default()).expect_err("ten millimetres through");
    assert!(refused.to_string().contains("twice the thickness"), "{refused}");
    // Through the whole cube: walls without thickness between the sides are left.
    given.thickness = Length::from_mm(5.0);
    let (ring, report) = rind(&cube, &given, &OpContext::default()).expect("a ring");
    assert_eq!((ring.faults().len(), genus(&ring), report.openings), (0, 1, 1));
}
