//! What every cut keeps: soundness, volume, area, the sides of the plane; on solids that make it
//! hard.

mod fuzz;
mod random;
mod reference;
mod solids;
mod voxels;

use glam::{DVec3, IVec3};
use kerfold::measure::{face_area, surface_area, volume};
use kerfold::mesh::{FaceId, Mesh, assert_sound};
use kerfold::op::{Capping, CutReport, Keep, OpContext, OpError, SliceParams, slice, slice_both};
use kerfold::shape;

use random::Random;
use voxels::{Touch, Voxels};

/// A plane as it is given to `slice`.
#[derive(Debug, Clone, Copy)]
struct Given {
    normal: DVec3,
    point: DVec3,
}

type Halves = [Option<(Mesh, CutReport)>; 2];

// ---- planes that aim at trouble -----------------------------------------------------------------

/// Through three vertices, along an edge, equal to a face, through one vertex, or through none;
/// sometimes a few ulps off.
fn aimed_plane(mesh: &Mesh, random: &mut Random) -> Option<Given> {
    let points: Vec<DVec3> = mesh.vertices().map(|v| mesh.position(v)).collect();
    let edges: Vec<_> = mesh.edges().collect();
    let faces: Vec<_> = mesh.faces().collect();
    let direction = |random: &mut Random| {
        let mut number = || random.below(7) as f64 - 3.0;
        DVec3::new(number(), number(), number())
    };
    let (a, b, c) = (*random.pick(&points), *random.pick(&points), *random.pick(&points));
    let (normal, point) = match random.below(6) {
        0 => ((b - a).cross(c - a), a),
        1 => {
            let [p, q] = mesh.edge_positions(*random.pick(&edges));
            ((q - p).cross(direction(random)), p)
        }
        2 => {
            let corners = mesh.face_positions(*random.pick(&faces));
            (newell(&corners) * if random.below(2) == 0 { 1.0 } else { -1.0 }, corners[0])
        }
        3 => (direction(random), a),
        4 => (*random.pick(&[DVec3::X, DVec3::Y, DVec3::Z]), a.midpoint(b)),
        _ => {
            let skew = |random: &mut Random| random.between(-1.0, 1.0);
            (DVec3::new(skew(random), skew(random), skew(random)), a.midpoint(b))
        }
    };
    let point = nudged(point, random);
    (normal != DVec3::ZERO).then_some(Given { normal, point })
}

/// Mostly the point itself, else a few ulps off along an axis, or a tiny share of a unit.
fn nudged(mut point: DVec3, random: &mut Random) -> DVec3 {
    let axis = random.below(3);
    // An ulp of zero is nothing that anybody meets; take those of the other numbers.
    let number = if point[axis] == 0.0 { 1.0 } else { point[axis] };
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    let ulp = number.next_up() - number;
    point[axis] += sign
        * match random.below(8) {
            0 => ulp,
            1 => 3.0 * ulp,
            2 => 10.0_f64.powi(-(5 + random.below(11) as i32)),
            _ => 0.0,
        };
    point
}

/// Seeds for a test; the environment variable `KERFOLD_SEEDS` runs that many times as many.
fn seeds(count: u64) -> std::ops::Range<u64> {
    let times = std::env::var("KERFOLD_SEEDS").ok().and_then(|n| n.parse().ok()).unwrap_or(1);
    0..count * times
}

fn newell(corners: &[DVec3]) -> DVec3 {
    let next = corners.iter().cycle().skip(1);
    corners.iter().zip(next).map(|(&a, &b)| (a - corners[0]).cross(b - corners[0])).sum()
}

// ---- what must hold -----------------------------------------------------------------------------

fn cut_in_two(mesh: &Mesh, plane: Given) -> Result<Halves, OpError> {
    slice_both(mesh, &SliceParams::new(plane.normal, plane.point), &OpContext::default())
}

fn is_simple(mesh: &Mesh, f: FaceId) -> bool {
    let mut corners: Vec<_> = mesh.face_vertices(f).collect();
    let sides = corners.len();
    corners.sort_unstable();
    corners.dedup();
    sides >= 3 && corners.len() == sides
}

/// A mesh as text, every digit of it.
fn bytes(mesh: &Mesh) -> String {
    let positions: Vec<_> =
        mesh.vertices().map(|v| (v, mesh.position(v).to_array().map(f64::to_bits))).collect();
    let faces: Vec<_> = mesh
        .faces_and_holes()
        .map(|f| (f, mesh.is_hole(f), mesh.face_vertices(f).collect::<Vec<_>>()))
        .collect();
    format!("{positions:?} {faces:?}")
}

/// Sound, no face visits a vertex twice, no edge without length, nothing on the wrong side, misses
/// change nothing.
fn check_halves(mesh: &Mesh, plane: Given, halves: &Halves, title: &str) {
    let size = kerfold::measure::size(mesh).length();
    let unit = plane.normal.normalize();
    for (half, sign) in halves.iter().zip([1.0, -1.0]) {
        let Some((part, report)) = half else { continue };
        assert_sound(part);
        assert_eq!(part.is_closed(), mesh.is_closed(), "{title}: rims");
        let faces_ok = part.faces().all(|f| is_simple(part, f));
        assert!(faces_ok, "{title}: a face visits a vertex twice");
        for e in part.edges() {
            let [a, b] = part.edge_positions(e);
            assert!(a != b, "{title}: {e} has no length");
        }
        for v in part.vertices() {
            let height = sign * unit.dot(part.position(v) - plane.point);
            assert!(height <= 1e-11 * size, "{title}: {v} is {height:e} on the wrong side");
        }
        if report.missed == 1 {
            assert_eq!(bytes(part), bytes(mesh), "{title}: a miss changed something");
        }
    }
}

fn check_volume(mesh: &Mesh, halves: &Halves, title: &str) {
    let before = volume(mesh);
    let after: f64 = halves.iter().flatten().map(|(part, _)| volume(part)).sum();
    // Constructed vertices within 1e-12 of the size count as on the plane: needles feel that.
    let is_given = mesh.vertices().all(|v| mesh.is_given(v));
    let near = if is_given { 0.0 } else { 1e-12 * kerfold::measure::size(mesh).length() };
    // No vertex can lie nearer to where it should than its coordinates are fine: what is thin, or
    // small and far from the origin, feels that.
    let largest = mesh.vertices().map(|v| mesh.position(v).abs().max_element()).fold(0.0, f64::max);
    let slack = surface_area(mesh) * near.max(4.0 * (largest.next_up() - largest));
    assert!(
        (after - before).abs() <= slack.max(1e-12 * before.abs()),
        "{title}: volume {after} for {before}"
    );
}

fn cap_area((mesh, report): &(Mesh, CutReport)) -> f64 {
    report.made.faces.iter().map(|&f| face_area(mesh, f)).sum()
}

fn has_flat_face(mesh: &Mesh, plane: Given) -> bool {
    let is_near = |p: DVec3| plane.normal.normalize().dot(p - plane.point).abs() < 1e-9;
    mesh.faces().any(|f| mesh.face_positions(f).into_iter().all(is_near))
}

/// Without faces in the plane: both halves show the same section, and the surface is what it was
/// plus two sections.
fn check_area(mesh: &Mesh, plane: Given, halves: &Halves, title: &str) {
    let [Some(low), Some(high)] = halves else { return };
    if has_flat_face(mesh, plane) || !mesh.is_closed() {
        return;
    }
    let (below, above) = (cap_area(low), cap_area(high));
    let total = surface_area(mesh);
    assert!((below - above).abs() <= 1e-9 * total, "{title}: caps of {below} and {above}");
    let after = surface_area(&low.0) + surface_area(&high.0);
    assert!(
        (after - total - 2.0 * below).abs() <= 1e-9 * total,
        "{title}: area {after} for {total} and {below}"
    );
}

fn check_all(mesh: &Mesh, plane: Given, title: &str) -> Halves {
    let title = format!("{title}, {plane:?}");
    let halves = cut_in_two(mesh, plane).unwrap_or_else(|error| panic!("{title}: {error}"));
    check_halves(mesh, plane, &halves, &title);
    check_volume(mesh, &halves, &title);
    check_area(mesh, plane, &halves, &title);
    halves
}

// ---- convex and not -----------------------------------------------------------------------------

#[test]
fn random_convex_solids() {
    for seed in seeds(400) {
        let mut random = Random::new(seed);
        let mesh = shape::random_tangent_polytope(4 + random.below(40), seed);
        if let Some(plane) = aimed_plane(&mesh, &mut random) {
            check_all(&mesh, plane, &format!("convex {seed}"));
        }
    }
}

#[test]
fn prisms_over_stars() {
    for seed in seeds(1500) {
        let mut random = Random::new(seed);
        let mesh = solids::star_prism(&mut random);
        if let Some(plane) = aimed_plane(&mesh, &mut random) {
            check_all(&mesh, plane, &format!("star {seed}"));
        }
    }
}

#[test]
fn landscapes_with_saddles() {
    for seed in seeds(2500) {
        let mut random = Random::new(seed);
        let mesh = solids::landscape(&mut random);
        if let Some(plane) = aimed_plane(&mesh, &mut random) {
            check_all(&mesh, plane, &format!("landscape {seed}"));
        }
    }
}

#[test]
fn several_components() {
    for seed in seeds(300) {
        let mut random = Random::new(seed);
        let tunnels = Voxels::with_tunnels(1 + seed as i32 % 2);
        let parts = [
            tunnels.mesh(Touch::Apart, 60, &mut random).expect("a block with tunnels"),
            solids::landscape(&mut random),
            solids::star_prism(&mut random),
        ];
        let mesh = solids::side_by_side(&parts[random.below(3)], &parts[random.below(3)]);
        if let Some(plane) = aimed_plane(&mesh, &mut random) {
            check_all(&mesh, plane, &format!("components {seed}"));
        }
    }
}

// ---- unit cubes: exact volumes and areas --------------------------------------------------------

fn check_voxels(voxels: &Voxels, touch: Touch, mesh: &Mesh, plane: Given, title: &str) {
    let halves = check_all(mesh, plane, title);
    let Given { normal, point } = plane;
    let title = format!("{title}, {plane:?}");
    for (half, n) in halves.iter().zip([normal, -normal]) {
        let expected: f64 =
            voxels.cubes().map(|c| reference::cube_volume_behind(c.as_dvec3(), n, point)).sum();
        let found = half.as_ref().map_or(0.0, |(part, _)| volume(part));
        assert!((found - expected).abs() <= 1e-9, "{title}: volume {found} for {expected}");
    }
    let is_axial = normal.to_array().iter().filter(|&&x| x != 0.0).count() == 1;
    if is_axial {
        check_axial(voxels, touch, plane, &halves, &title);
    } else if let [Some(low), Some(_)] = &halves {
        let expected: f64 =
            voxels.cubes().map(|c| reference::cube_section(c.as_dvec3(), normal, point)).sum();
        let found = cap_area(low);
        assert!((found - expected).abs() <= 1e-7, "{title}: caps of {found} for {expected}");
    }
}

/// A cut between two layers of cubes leaves just the surface of the cubes of the half, no membrane
/// and no pit.
fn check_axial(voxels: &Voxels, touch: Touch, plane: Given, halves: &Halves, title: &str) {
    let direction = plane.normal.normalize();
    let height = direction.dot(plane.point);
    if height != height.round() {
        return;
    }
    let is_behind = |c: IVec3| direction.dot(c.as_dvec3() + 0.5) < height;
    for (i, half) in halves.iter().enumerate() {
        let expected = voxels.exposed(|c| is_behind(c) == (i == 0)) as f64;
        let found = half.as_ref().map_or(0.0, |(part, _)| surface_area(part));
        // A cube that hangs on the edges around a hollow leaves a lid of no thickness there: edges
        // that lie on each other without being joined do not tell which is which.
        let surplus = if touch == Touch::Through { (found - expected).max(0.0) } else { 0.0 };
        assert!(
            (found - expected - surplus).abs() <= 1e-9,
            "{title}: half {i} has a surface of {found}, not {expected}"
        );
    }
}

#[test]
fn cubes_in_any_arrangement() {
    let mut with_lids = 0;
    for seed in seeds(4000) {
        let mut random = Random::new(seed);
        let voxels = Voxels::random(&mut random);
        let touch = if random.below(2) == 0 { Touch::Apart } else { Touch::Through };
        let merge = [0, 50, 100][random.below(3)];
        let Some(mesh) = voxels.mesh(touch, merge, &mut random) else { continue };
        let Some(plane) = aimed_plane(&mesh, &mut random) else { continue };
        // Cubes that touch along edges make holes that touch their outer walk at every corner.
        let halves =
            cut_in_two(&mesh, plane).unwrap_or_else(|error| panic!("cubes {seed}: {error}"));
        if halves.iter().flatten().any(|(_, report)| report.lids > 0) {
            with_lids += 1;
            halves.iter().flatten().for_each(|(part, _)| assert_sound(part));
            check_volume(&mesh, &halves, &format!("cubes {seed}, {plane:?}"));
            continue;
        }
        check_voxels(&voxels, touch, &mesh, plane, &format!("cubes {seed}"));
    }
    assert!(with_lids <= seeds(4000).end / 2000, "{with_lids} with lids");
}

/// A plate with many holes: one bridge more than holes where the search finds one chain, never a
/// stack overflow.
#[test]
fn a_plate_with_many_holes() {
    for (holes, most) in [(3_i32, 8 * 8), (30, 30 * 30 + 200)] {
        let voxels = Voxels::new(IVec3::new(2 * holes + 1, 2 * holes + 1, 1), |c| {
            c.x % 2 == 0 || c.y % 2 == 0
        });
        let mesh = voxels.mesh(Touch::Apart, 0, &mut Random::new(1)).expect("a plate");
        let plane = Given { normal: DVec3::Z, point: DVec3::splat(0.5) };
        let halves = check_all(&mesh, plane, "plate");
        let Some((_, report)) = &halves[0] else { panic!("a half") };
        assert!(report.made.faces.len() <= most, "{} caps", report.made.faces.len());
    }
}

#[test]
fn tunnels_and_cavities() {
    for seed in seeds(600) {
        let mut random = Random::new(seed);
        let voxels = match seed % 4 {
            0 => Voxels::with_tunnels(1),
            1 => Voxels::with_tunnels(2),
            2 => Voxels::with_cavity(false),
            _ => Voxels::with_cavity(true),
        };
        let mesh =
            voxels.mesh(Touch::Apart, [0, 50, 100][random.below(3)], &mut random).expect("a block");
        if let Some(plane) = aimed_plane(&mesh, &mut random) {
            check_voxels(&voxels, Touch::Apart, &mesh, plane, &format!("hollow {seed}"));
        }
    }
}

#[test]
fn a_cut_at_the_ceiling_of_a_hollow_opens_it() {
    let voxels = Voxels::with_cavity(false);
    let mesh = voxels.mesh(Touch::Apart, 0, &mut Random::new(0)).expect("a block");
    for height in [1.0, 2.0, 3.0] {
        let plane = Given { normal: DVec3::Z, point: DVec3::new(0.3, 0.4, height) };
        check_voxels(&voxels, Touch::Apart, &mesh, plane, "ceiling");
    }
}

// ---- open meshes --------------------------------------------------------------------------------

#[test]
fn open_meshes_stay_open_and_lose_no_area() {
    for seed in seeds(1500) {
        let mut random = Random::new(seed);
        let voxels = Voxels::random(&mut random);
        let percent = 5 + random.below(40);
        let Some(mesh) = voxels.open_mesh(percent, &mut random) else { continue };
        let Some(plane) = aimed_plane(&mesh, &mut random) else { continue };
        let title = format!("open {seed}, {plane:?}");
        let halves = cut_in_two(&mesh, plane).unwrap_or_else(|error| panic!("{title}: {error}"));
        for (part, _) in halves.iter().flatten() {
            assert_sound(part);
            assert!(part.faces().all(|f| is_simple(part, f)), "{title}");
        }
        let has_flat = has_flat_face(&mesh, plane);
        let caps: f64 = halves.iter().flatten().map(cap_area).sum();
        let after: f64 = halves.iter().flatten().map(|(part, _)| surface_area(part)).sum();
        let before = surface_area(&mesh);
        assert!(
            has_flat || (after - caps - before).abs() <= 1e-9 * before,
            "{title}: {after} for {before} and {caps}"
        );
    }
}

/// A cup: a block with a pit, without the lid's ring, so that walls inside and outside end in rims.
fn pipe() -> Mesh {
    let ring =
        |s: f64, z: f64| [(-s, -s), (s, -s), (s, s), (-s, s)].map(|(x, y)| DVec3::new(x, y, z));
    let points = [ring(2.0, 0.0), ring(2.0, 4.0)].concat();
    let sides = (0..4).map(|i| [i, (i + 1) % 4, 4 + (i + 1) % 4, 4 + i]);
    Mesh::from_faces(points, sides).expect("a pipe without ends")
}

#[test]
fn caps_are_offered_not_forced() {
    let mesh = pipe();
    assert_eq!(mesh.hole_count(), 2);
    let part = |mesh: &Mesh, normal, cap| {
        let params = SliceParams { cap, ..SliceParams::new(normal, DVec3::new(0.1, 0.2, 1.0)) };
        slice(mesh, &params, &OpContext::default()).expect("a part").0
    };
    // Across the pipe: a whole loop. Along the pipe: the section runs from rim to rim and cannot be
    // capped.
    for (normal, cap, holes, faces) in [
        (DVec3::Z, Capping::Auto, 2, 4),
        (DVec3::Z, Capping::Always, 1, 5),
        (DVec3::Z, Capping::Never, 2, 4),
        (DVec3::X, Capping::Auto, 1, 3),
        (DVec3::X, Capping::Always, 1, 3),
    ] {
        let part = part(&mesh, normal, cap);
        assert_sound(&part);
        assert_eq!((part.hole_count(), part.face_count()), (holes, faces), "{normal} {cap:?}");
    }
    let closed = shape::cube(4.0);
    let part = part(&closed, DVec3::Z, Capping::Never);
    assert_eq!((part.hole_count(), part.face_count()), (1, 5));
}

// ---- the same again -----------------------------------------------------------------------------

#[test]
fn the_same_input_twice_gives_the_same_bytes() {
    for seed in seeds(100) {
        let mut random = Random::new(seed);
        let mesh = solids::landscape(&mut random);
        let Some(plane) = aimed_plane(&mesh, &mut random) else { continue };
        let run = || {
            cut_in_two(&mesh, plane).expect("halves").map(|half| half.map(|(part, _)| bytes(&part)))
        };
        assert_eq!(run(), run(), "landscape {seed}");
    }
}

#[test]
fn size_and_place_do_not_change_the_topology() {
    for seed in seeds(600) {
        let mut random = Random::new(seed);
        let mesh = if seed % 2 == 0 {
            solids::landscape(&mut random)
        } else {
            let Some(mesh) = Voxels::random(&mut random).mesh(Touch::Apart, 50, &mut random) else {
                continue;
            };
            mesh
        };
        let Some(plane) = aimed_plane(&mesh, &mut random) else { continue };
        let is_whole = |p: DVec3| p == p.round();
        // Numbers that scaling rounds no longer lie on one plane exactly: aimed planes need whole
        // numbers and exact factors.
        let is_exact = is_whole(plane.normal) && is_whole(plane.point);
        let factors: &[(f64, f64)] = if is_exact {
            &[(1e3, 0.0), (1.0, 1e6), (1.0 / 1024.0, 0.0), (1e3, 1e6)]
        } else {
            &[(1.0 / 1024.0, 0.0)]
        };
        let counts = |halves: Halves| {
            halves.map(|half| half.map(|(m, _)| (m.vertex_count(), m.edge_count(), m.face_count())))
        };
        let expected = counts(cut_in_two(&mesh, plane).expect("halves"));
        for &(scale, shift) in factors {
            let place = |p: DVec3| p * scale + DVec3::new(shift, -shift, 2.0 * shift);
            let mut moved = mesh.clone();
            moved.clear_planes();
            mesh.vertices().for_each(|v| moved.set_position(v, place(mesh.position(v)), true));
            let found = counts(
                cut_in_two(&moved, Given { normal: plane.normal, point: place(plane.point) })
                    .expect("halves"),
            );
            assert_eq!(found, expected, "{seed}: times {scale}, moved by {shift}, {plane:?}");
        }
    }
}

#[test]
fn a_millionth_and_a_thousandfold_of_a_general_cut() {
    for seed in seeds(200) {
        let mut random = Random::new(seed);
        let mesh = solids::star_prism(&mut random);
        let mut number = || random.between(-1.0, 1.0);
        let plane = Given {
            normal: DVec3::new(number(), number(), number()),
            point: DVec3::new(0.1, 0.2, 0.4),
        };
        let counts = |halves: Halves| {
            halves.map(|half| half.map(|(m, _)| (m.vertex_count(), m.edge_count())))
        };
        let expected = counts(cut_in_two(&mesh, plane).expect("halves"));
        for (scale, shift) in [(1e-3, 0.0), (1e3, 0.0), (1.0, 1e6), (1e-6, 0.0)] {
            let place = |p: DVec3| p * scale + DVec3::splat(shift);
            let mut moved = mesh.clone();
            mesh.vertices().for_each(|v| moved.set_position(v, place(mesh.position(v)), true));
            let found = counts(
                cut_in_two(&moved, Given { normal: plane.normal, point: place(plane.point) })
                    .expect("halves"),
            );
            assert_eq!(found, expected, "{seed}: times {scale}, moved by {shift}");
        }
    }
}

#[test]
fn keeping_both_is_refused_where_one_mesh_is_wanted() {
    let params = SliceParams { keep: Keep::Both, ..SliceParams::new(DVec3::Z, DVec3::ZERO) };
    let error = slice(&shape::cube(1.0), &params, &OpContext::default()).expect_err("two parts");
    assert_eq!(error, OpError::TwoParts);
    let halves = slice_both(&shape::cube(1.0), &params, &OpContext::default()).expect("two parts");
    assert!(halves.iter().all(Option::is_some));
    let above = SliceParams::new(DVec3::Z, DVec3::splat(9.0));
    let [low, high] =
        slice_both(&shape::cube(1.0), &above, &OpContext::default()).expect("one part");
    assert!(low.is_some() && high.is_none());
}
