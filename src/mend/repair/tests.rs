use glam::DVec3;

use super::*;
use crate::fixtures::{CUBE_FACES, cube, cube_corners};
use crate::measure::volume;
use crate::mend::SoupFace;
use crate::mesh::{Mesh, assert_sound};
use crate::units::Length;

fn soup<F: AsRef<[u32]>>(positions: Vec<DVec3>, faces: impl IntoIterator<Item = F>) -> Soup {
    let face =
        |(i, f): (usize, F)| SoupFace { corners: f.as_ref().to_vec(), source: Some(i as u32) };
    Soup { positions, faces: faces.into_iter().enumerate().map(face).collect() }
}

fn cube_faces() -> Vec<Vec<u32>> {
    CUBE_FACES.map(|f| f.map(|v| v as u32).to_vec()).to_vec()
}

fn mended(mut soup: Soup, params: &RepairParams) -> (Mesh, Repairs) {
    let repairs = repair(&mut soup, params);
    let mesh = soup.build(&Mesh::new()).expect("a surface");
    assert_sound(&mesh);
    assert!(mesh.file_faults().is_empty(), "{:?}", mesh.file_faults());
    (mesh, repairs)
}

fn done(repairs: &Repairs) -> Vec<(Repair, usize)> {
    repairs.done.iter().map(|m| (m.repair, m.count)).collect()
}

#[test]
fn a_sound_cube_needs_nothing() {
    let given = soup(cube_corners(), cube_faces());
    let (mesh, repairs) = mended(given, &RepairParams::default());
    assert!(repairs.is_nothing(), "{repairs:?}");
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (8, 6));
}

#[test]
fn every_way_to_turn_faces_of_a_cube_is_undone() {
    for turned in 0_u32..64 {
        let mut faces = cube_faces();
        for (i, face) in faces.iter_mut().enumerate() {
            if turned >> i & 1 == 1 {
                face.reverse();
            }
        }
        let (mesh, repairs) = mended(soup(cube_corners(), faces), &RepairParams::default());
        assert!(mesh.is_closed());
        assert!((volume(&mesh) - volume(&cube())).abs() < 1e-12, "{turned:b}: {repairs:?}");
        // The lesser half turns, and then the whole if that was the right one.
        let count = turned.count_ones();
        assert_eq!(
            repairs.count(Repair::TurnedParts),
            usize::from(count > 3 || (count == 3 && repairs.count(Repair::TurnedParts) == 1))
        );
    }
}

#[test]
fn a_cavity_looks_inwards_and_stays() {
    let mut places = cube_corners();
    places.extend(cube_corners().into_iter().map(|p| p * 0.5 + DVec3::splat(0.1)));
    let inner = |f: &Vec<u32>| f.iter().rev().map(|v| v + 8).collect::<Vec<u32>>();
    let mut faces = cube_faces();
    faces.extend(cube_faces().iter().map(inner));
    let right = volume(&cube()) * (1.0 - 0.125);
    let (mesh, repairs) = mended(soup(places.clone(), faces.clone()), &RepairParams::default());
    assert!(repairs.is_nothing(), "{repairs:?}");
    assert!((volume(&mesh) - right).abs() < 1e-12);
    faces.iter_mut().for_each(|f| f.reverse());
    let (mesh, repairs) = mended(soup(places, faces), &RepairParams::default());
    assert_eq!(done(&repairs), [(Repair::TurnedParts, 2)]);
    assert!((volume(&mesh) - right).abs() < 1e-12);
}

#[test]
fn torn_doubled_and_empty_faces() {
    let (mut places, mut faces) = (Vec::new(), Vec::new());
    for face in cube_faces() {
        let start = places.len() as u32;
        places.extend(face.iter().map(|&v| cube_corners()[v as usize]));
        faces.push((start..start + 4).collect::<Vec<u32>>());
    }
    faces.push(faces[2].iter().rev().copied().collect());
    faces.push(faces[1].clone());
    faces.push(vec![0, 1, 1]);
    let (mesh, repairs) = mended(soup(places, faces), &RepairParams::default());
    assert!(mesh.is_closed());
    assert_eq!(done(&repairs), [(Repair::Welded, 16), (Repair::Empty, 1), (Repair::Doubled, 2)]);
}

#[test]
fn cubes_that_touch_along_an_edge_and_in_a_corner_come_apart() {
    for (shift, edges, vertices) in [(DVec3::new(2.0, 2.0, 0.0), 1, 2), (DVec3::splat(2.0), 0, 1)] {
        let mut places = cube_corners();
        places.extend(cube_corners().into_iter().map(|p| p + shift));
        let mut faces = cube_faces();
        faces.extend(cube_faces().iter().map(|f| f.iter().map(|v| v + 8).collect::<Vec<u32>>()));
        let (mesh, repairs) = mended(soup(places, faces), &RepairParams::default());
        assert_eq!(mesh.components().len(), 2);
        assert!(mesh.is_closed());
        assert!((volume(&mesh) - 2.0 * volume(&cube())).abs() < 1e-12);
        assert_eq!(repairs.count(Repair::PartedEdges), edges);
        assert_eq!(repairs.count(Repair::PartedVertices), vertices);
    }
}

#[test]
fn a_fin_on_a_cube_comes_off() {
    let mut places = cube_corners();
    places.push(DVec3::new(9.0, 9.0, 9.0));
    let mut faces = cube_faces();
    let [a, b] = [faces[0][0], faces[0][1]];
    faces.push(vec![a, b, 8]);
    let (mesh, repairs) = mended(soup(places, faces), &RepairParams::default());
    assert_eq!((mesh.components().len(), repairs.count(Repair::PartedEdges)), (2, 1));
    assert!((volume(&mesh) - volume(&cube())).abs() < 1e-9);
}

#[test]
fn a_moebius_strip_is_cut_open() {
    let n = 9_u32;
    let places: Vec<DVec3> = (0..n)
        .flat_map(|i| {
            let turn = std::f64::consts::TAU * f64::from(i) / f64::from(n);
            let (out, half) = (DVec3::new(turn.cos(), turn.sin(), 0.0), turn / 2.0);
            let across = out * half.cos() + DVec3::Z * half.sin();
            [out * 3.0 - across, out * 3.0 + across]
        })
        .collect();
    let faces = (0..n).map(|i| {
        let (a, b) = (2 * i, 2 * i + 1);
        let (c, d) = if i + 1 == n { (1, 0) } else { (a + 2, b + 2) };
        vec![a, c, d, b]
    });
    let (mesh, repairs) = mended(soup(places, faces), &RepairParams::default());
    assert_eq!(repairs.count(Repair::OneSided), 1);
    assert_eq!((mesh.hole_count(), mesh.face_count()), (1, 9));
}

#[test]
fn a_vertex_on_a_side_is_taken_in() {
    // Two squares beside one wide rectangle.
    let places = [(0, 0), (1, 0), (2, 0), (2, 1), (1, 1), (0, 1), (0, 2), (2, 2)];
    let places = places.map(|(x, y)| DVec3::new(f64::from(x), f64::from(y), 0.0)).to_vec();
    let faces = [vec![0, 1, 4, 5], vec![1, 2, 3, 4], vec![5, 3, 7, 6]];
    let (mesh, repairs) = mended(soup(places, faces), &RepairParams::default());
    assert_eq!(done(&repairs), [(Repair::Junctions, 1)]);
    assert_eq!((mesh.hole_count(), mesh.edge_count(), mesh.components().len()), (1, 10, 1));
}

#[test]
fn small_holes_close_and_large_ones_stay() {
    let faces = || cube_faces().into_iter().skip(1);
    let across = 8.0_f64.sqrt();
    for (width, is_closed) in [(0.99 * across, false), (1.01 * across, true)] {
        let params = RepairParams { close_holes: Some(Length::from_mm(width)) };
        let (mesh, repairs) = mended(soup(cube_corners(), faces()), &params);
        assert_eq!(mesh.is_closed(), is_closed);
        assert_eq!(repairs.count(Repair::ClosedHoles), usize::from(is_closed));
        assert_eq!(mesh.face_count(), if is_closed { 6 } else { 5 });
    }
    // A hole that is not flat gets triangles.
    let mut places = cube_corners();
    places[CUBE_FACES[0][0]] += DVec3::splat(-0.3);
    let params = RepairParams { close_holes: Some(Length::from_mm(9.0)) };
    let (mesh, _) = mended(soup(places, faces()), &params);
    assert_eq!((mesh.is_closed(), mesh.face_count()), (true, 7));
}

#[test]
fn the_needle_on_a_side_goes_and_nothing_stays_open() {
    let places = [(0, 0, 0), (40, 0, 0), (0, 40, 0), (0, 0, 40), (20, 0, 0)];
    let places = places.map(|(x, y, z)| DVec3::new(x.into(), y.into(), z.into())).to_vec();
    let faces = [[0, 2, 4], [2, 1, 4], [0, 4, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let (mesh, repairs) = mended(soup(places, faces), &RepairParams::default());
    assert!(mesh.is_closed());
    assert_eq!(done(&repairs), [(Repair::Empty, 1), (Repair::Junctions, 1)]);
}

/// A face that touches itself, and holes with corners in a row: lids that would be empty or lie twice
/// at an edge are none, and the hole stays, which is said.
#[test]
fn holes_that_triangles_do_not_fill_once_stay_open() {
    type Case<'a> = (&'a [[i8; 3]], &'a [&'a [u32]]);
    let cases: [Case; 2] = [
        (
            &[[1, 2, 0], [1, 0, 0], [1, 1, 1], [0, 2, 0], [2, 2, 0], [0, 1, 1], [1, 1, 0]],
            &[&[4, 3, 2, 0, 6]],
        ),
        (
            &[
                [0, 0, 1],
                [0, 1, 2],
                [0, 0, 0],
                [0, 2, 1],
                [1, 1, 2],
                [1, 1, 1],
                [2, 0, 1],
                [0, 0, 2],
            ],
            &[&[3, 4, 4, 1], &[2, 3, 6, 2, 5, 3], &[5, 5, 1], &[6, 2, 7, 0, 1]],
        ),
    ];
    for (points, faces) in cases {
        let places = points.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
        let params = RepairParams { close_holes: Some(Length::from_mm(9.0)) };
        let (_, repairs) = mended(soup(places, faces), &params);
        assert!(done(&repairs).iter().any(|(what, _)| *what == Repair::LeftHoles), "{points:?}");
    }
}

mod random {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(512))]

        /// Whatever the faces are: what is left is a surface that a file can hold.
        #[test]
        fn any_faces_become_a_surface(
            points in prop::collection::vec(prop::array::uniform3(0_i8..3), 3..9),
            faces in prop::collection::vec(prop::collection::vec(0_usize..64, 1..7), 1..12),
            closes in any::<bool>(),
        ) {
            let places: Vec<DVec3> =
                points.iter().map(|p| DVec3::from_array(p.map(f64::from))).collect();
            let faces: Vec<Vec<u32>> = faces
                .iter()
                .map(|f| f.iter().map(|v| (v % places.len()) as u32).collect())
                .collect();
            let mut soup = soup(places, faces);
            let params = RepairParams { close_holes: closes.then(|| Length::from_mm(9.0)) };
            repair(&mut soup, &params);
            if soup.faces.is_empty() {
                return Ok(());
            }
            let mesh = soup.build(&Mesh::new()).expect("a surface");
            assert_sound(&mesh);
            prop_assert!(mesh.file_faults().is_empty(), "{:?}", mesh.file_faults());
        }
    }
}
