//! Meshes that are hard on an unfolder.

use super::*;

#[test]
fn needles_lie_flat() {
    // A spire a thousand times as high as wide: its sides are needles of 0.1 by 1000.
    let n = 60;
    let mut points: Vec<DVec3> =
        (0..n).map(|i| start::unit_vector(0.0, f64::from(i) * TAU / f64::from(n))).collect();
    points.push(at(0.0, 0.0, 1000.0));
    let n = n as usize;
    let mut faces = vec![(0..n).rev().collect::<Vec<_>>()];
    faces.extend((0..n).map(|i| vec![i, (i + 1) % n, n]));
    let net = free(&build((points, faces)));
    assert_eq!((net.pieces.len(), net.folds.len()), (1, n));
}

/// The surface of unit cubes in a plate, with a hole wherever both coordinates are odd: `(nx / 2)
/// (ny / 2)` handles.
fn perforated_plate(nx: usize, ny: usize) -> Mesh {
    let is_solid = |x: i64, y: i64| {
        let inside = (0..nx as i64).contains(&x) && (0..ny as i64).contains(&y);
        inside && !(x % 2 == 1 && y % 2 == 1)
    };
    let id = |x: i64, y: i64, z: i64| {
        (z * (nx as i64 + 1) * (ny as i64 + 1) + y * (nx as i64 + 1) + x) as usize
    };
    let (mut builder, mut ids) = (MeshBuilder::new(), std::collections::BTreeMap::new());
    let mut quads: Vec<[[i64; 3]; 4]> = Vec::new();
    for (x, y) in (0..nx as i64)
        .flat_map(|x| (0..ny as i64).map(move |y| (x, y)))
        .filter(|&(x, y)| is_solid(x, y))
    {
        quads.push([[x, y, 0], [x, y + 1, 0], [x + 1, y + 1, 0], [x + 1, y, 0]]);
        quads.push([[x, y, 1], [x + 1, y, 1], [x + 1, y + 1, 1], [x, y + 1, 1]]);
        let walls = [
            ([0, -1], [0, 0], [1, 0]),
            ([1, 0], [1, 0], [1, 1]),
            ([0, 1], [1, 1], [0, 1]),
            ([-1, 0], [0, 1], [0, 0]),
        ];
        for (_, a, b) in walls.into_iter().filter(|&([dx, dy], ..)| !is_solid(x + dx, y + dy)) {
            let corner = |c: [i64; 2], z| [x + c[0], y + c[1], z];
            quads.push([corner(a, 0), corner(b, 0), corner(b, 1), corner(a, 1)]);
        }
    }
    for quad in quads {
        let face = quad.map(|[x, y, z]| {
            *ids.entry(id(x, y, z))
                .or_insert_with(|| builder.vertex(at(x as f64, y as f64, z as f64)))
        });
        builder.face(face);
    }
    builder.build().expect("a plate").0
}

#[test]
fn many_handles_are_cut_open() {
    let mesh = perforated_plate(9, 7);
    assert_eq!(crate::measure::genus(&mesh), 12);
    let net = net(&mesh, &Seams::Free, PiecesMode::Auto);
    assert!(net.pieces.len() <= 3, "{}", net.pieces.len());
}

/// A tetrahedron with a spike on every side, after Bern, Demaine, Eppstein, Kuo, Mantler and
/// Snoeyink 2003 ("Ununfoldable polyhedra with convex faces"): around a spike's foot the faces take
/// more than a full turn.
fn spiked_tetrahedron(foot: f64, height: f64) -> Mesh {
    let corners = [at(1., 1., 1.), at(1., -1., -1.), at(-1., 1., -1.), at(-1., -1., 1.)];
    let mut points = corners.to_vec();
    let mut faces = Vec::new();
    for side in [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]] {
        let middle = side.iter().map(|&v| corners[v]).sum::<DVec3>() / 3.0;
        let first = points.len();
        points.extend(side.iter().map(|&v| middle.lerp(corners[v], foot)));
        points.push(middle + middle.normalize() * height);
        for i in 0..3 {
            let j = (i + 1) % 3;
            faces.push(vec![side[i], side[j], first + j, first + i]);
            faces.push(vec![first + i, first + j, first + 3]);
        }
    }
    build((points, faces))
}

#[test]
fn spiked_polyhedra_end_with_what_was_tried() {
    let mesh = spiked_tetrahedron(0.5, 4.0);
    let params = UnfoldParams { pieces: PiecesMode::One, effort: 3, ..UnfoldParams::default() };
    let error = unfold(&mesh, &Seams::Free, &params, &MeshSource::default(), &Silent)
        .expect_err("no net is known");
    let UnfoldError::MorePieces { asked: 1, found, starts, moves, joins, .. } = error else {
        panic!("{error}")
    };
    assert!(found > 1 && starts > 1 && moves > 100 && joins > 10, "{error}");
    for part in [starts as u64, moves, joins as u64] {
        assert!(error.to_string().contains(&part.to_string()));
    }
    assert_eq!(net(&mesh, &Seams::Free, PiecesMode::Auto).pieces.len(), found);
}

#[test]
fn a_surface_with_one_side_is_no_mesh() {
    let n = 9;
    let points = (0..n).flat_map(|i| {
        let u = f64::from(i) * TAU / f64::from(n);
        [1.0, -1.0].map(|v| {
            at(
                u.cos() * (3.0 + v * (u / 2.0).cos()),
                u.sin() * (3.0 + v * (u / 2.0).cos()),
                v * (u / 2.0).sin(),
            )
        })
    });
    let n = n as usize;
    let mut faces: Vec<Vec<usize>> =
        (0..n - 1).map(|i| vec![2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1]).collect();
    faces.push(vec![2 * n - 2, 1, 0, 2 * n - 1]);
    assert!(Mesh::from_faces(points, faces).is_err());
}

#[test]
fn seams_by_angle_reach_every_cone_point() {
    // No edge of this ball is sharp: the seams are a tree through all vertices.
    let ball = rough_ball(3, 12, 8);
    let angle =
        |mesh: &Mesh, degrees: f64| Seams::Open(seams_by_angle(mesh, f64::to_radians(degrees)));
    let Seams::Open(tree) = angle(&ball, 179.0) else { panic!("open") };
    assert_eq!(tree.len(), ball.vertex_count() - 1);
    let seams = angle(&ball, 30.0);
    check_seams(&ball, &seams).expect("every cone point has a seam");
    let opened = net(&ball, &seams, PiecesMode::Auto);
    let is_sharp = |e: EdgeId| {
        crate::measure::fold_angle(&ball, e).is_some_and(|a| a.abs() > 30_f64.to_radians())
    };
    assert!(folded(&opened).into_iter().all(|e| !is_sharp(e)));
    // Of a prism with flat lids of many faces just the sharp edges.
    let prism = prism(&[(0., 0.), (2., 0.), (4., 0.), (4., 2.), (0., 2.)]);
    let Seams::Open(edges) = angle(&prism, 45.0) else { panic!("open") };
    assert_eq!(edges.len(), prism.edge_count() - 1);
}

#[test]
fn polishing_shortens_seams_and_keeps_the_net_flat() {
    let mesh = polytope(150, 4);
    let dual = Dual::new(&mesh, &Seams::Free).expect("planar faces");
    let mut rng = Rng::new(1);
    let (start, _) = best_start(&dual, &mesh, &Seams::Free, (STARTS, 0), &mut rng, &Silent);
    let mut layout = Repair::new(start, 1).run(1_000_000, &Silent);
    assert!(layout.overlaps.is_empty());
    let length = |layout: &Layout| -> f64 {
        let folds =
            layout.dual.hinges.iter().filter(|h| layout.forest.is_fold(layout.dual, h.sides[0]));
        folds.map(|h| h.length).sum()
    };
    let before = length(&layout);
    polish::polish(&mut layout, 1_000_000, &Silent);
    assert!(length(&layout) > before);
    assert!(layout.fresh().overlaps.is_empty());
}
