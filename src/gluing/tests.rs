use glam::DVec2;

use super::random_points::random_points;
use super::*;
use crate::measure::convexity;
use crate::progress::Silent;
use crate::random::Rng;

fn named(name: &str) -> Outline {
    named_outline(name).expect(name)
}

fn fitted(a: &Outline, b: Outline) -> Outline {
    let factor = a.length() / b.length();
    b.scaled(factor)
}

fn pair(a: &str, b: &str, start: f64, points: usize) -> Result<Glued, GluingError> {
    let a = named(a);
    let b = fitted(&a, named(b));
    let start = start * b.length();
    glue(&Gluing::pair(a, b, start, points), &Silent)
}

fn random_outline(rng: &mut Rng) -> Outline {
    Outline::new("random", &random_points(|| rng.unit(), 4096)).expect("an outline")
}

/// Every corner of a piece lies where the outline, cut into chords, has it.
fn assert_true(glued: &Glued) {
    assert!(convexity(&glued.mesh).is_convex());
    assert!(glued.facts.edge_error < 1e-12 && glued.facts.angle_error < 1e-9, "{:?}", glued.facts);
    let flat: usize = glued.net.pieces.iter().map(|p| p.faces.len()).sum();
    assert_eq!(flat, glued.mesh.face_count());
}

#[test]
fn the_cases_of_the_trial_close() {
    for (a, b, start) in [
        ("circle", "ellipse-1.6x1", 0.1),
        ("ellipse-2x1", "ellipse-2x1", 0.25),
        ("ellipse-2x1", "ellipse-2x1", 0.125),
        ("superellipse-1x1-6", "ellipse-1.5x1", 0.07),
        ("trefoil-0.12", "trefoil-0.12", 1.0 / 6.0),
        ("peanut-0.25", "peanut-0.25", 0.25),
        ("regular-7", "circle", 0.0),
    ] {
        let glued = pair(a, b, start, 60).unwrap_or_else(|e| panic!("{a} {b}: {e}"));
        assert_true(&glued);
        assert_eq!(glued.net.pieces.len(), 2);
    }
}

#[test]
fn random_pairs_close() {
    for seed in 0..6 {
        let mut rng = Rng::new(seed);
        let a = random_outline(&mut rng);
        let b = fitted(&a, random_outline(&mut rng));
        let start = rng.unit() * b.length();
        assert_true(&glue(&Gluing::pair(a, b, start, 48), &Silent).expect("a body"));
    }
}

/// Two squares turned by an eighth: sixteen right triangles in pairs, known in closed form as the
/// square antiprism's cousin; its faces are what two squares with shifted corners must give.
#[test]
fn polygons_stay_themselves() {
    let glued = pair("regular-4", "regular-4", 0.125, 40).expect("a body");
    assert_true(&glued);
    assert_eq!(glued.mesh.vertex_count(), 8);
    assert!(glued.facts.off_outline.iter().all(|&off| off == 0.0), "{:?}", glued.facts);
    // A ruling crosses the seam where straight sides meet: it gets a point there.
    let glued = pair("regular-4", "regular-3", 0.07, 40).expect("a body");
    assert_true(&glued);
    assert!(glued.mesh.vertex_count() > glued.facts.corners);
}

#[test]
fn equal_outlines_without_a_shift_fold_flat() {
    for (name, start) in [
        ("circle", 0.3),
        ("ellipse-2x1", 0.0),
        ("ellipse-2x1", 0.5),
        ("regular-5", 0.0),
        ("superellipse-2x1-4", 0.5),
    ] {
        match pair(name, name, start, 60) {
            Err(GluingError::FoldsFlat { size }) => {
                assert!((size[0] - 100.0).abs() < 2.0, "{name} {size:?}");
            }
            other => panic!("{name} {start}: {other:?}"),
        }
    }
}

#[test]
fn one_piece_is_zipped_shut() {
    for name in ["ellipse-2x1", "ellipse-3x1", "trefoil-0.12", "egg-0.2"] {
        let mut solved = 0;
        for k in 0..=20 {
            let outline = named(name);
            let start = outline.length() * f64::from(k) / 20.0;
            match glue(&Gluing::zip(outline, start, 48), &Silent) {
                Ok(glued) => {
                    assert_true(&glued);
                    assert_eq!(glued.net.pieces.len(), 1);
                    solved += 1;
                }
                Err(GluingError::FoldsFlat { .. } | GluingError::Angle { .. }) => {}
                Err(error) => panic!("{name} {k}: {error}"),
            }
        }
        assert!(solved >= 12, "{name}: {solved}");
    }
}

#[test]
fn too_much_material_is_named_with_what_mends_it() {
    let Err(GluingError::Angle { degrees, mend, count, .. }) =
        pair("trefoil-0.25", "trefoil-0.25", 1.0 / 6.0, 60)
    else {
        panic!("hollow on hollow")
    };
    assert!(degrees > 360.0 && count > 0 && mend.expect("words").contains("no other"));
    // A notch of 20° against a corner that is too blunt, and one that is sharp enough elsewhere.
    let points: Vec<DVec2> = [(0., 0.), (50., 10.), (100., 0.), (100., 60.), (0., 60.)]
        .map(|(x, y)| DVec2::new(x, y))
        .to_vec();
    let a = Outline::new("notched", &points).expect("an outline");
    let b = fitted(&a, named("regular-3"));
    let (from, to) = (a.length(), b.length());
    assert!((from - to).abs() < 1e-9);
    let refused = glue(&Gluing::pair(a.clone(), b.clone(), 0.2 * to, 60), &Silent);
    let Err(GluingError::Angle { mend: Some(mend), .. }) = refused else { panic!("{refused:?}") };
    let fraction: f64 = mend
        .split("`--start ")
        .nth(1)
        .and_then(|t| t.split('`').next())
        .and_then(|t| t.parse().ok())
        .expect(&mend);
    assert!(glue(&Gluing::pair(a, b, fraction * to, 60), &Silent).is_ok(), "{mend}");
}

/// A tetrahedron of four triangles, and a drum of two discs and a band.
#[test]
fn more_pieces_are_glued_by_their_seams() {
    let tri = named("regular-3");
    let side = tri.length() / 3.0;
    let outlines: Vec<Outline> =
        ["A", "B", "C", "D"].map(|name| tri.clone().renamed(name)).to_vec();
    let span = |piece: usize, k: f64| Span { piece, from: k * side, to: (k + 1.0) * side };
    let seams = [
        ((0, 0.), (1, 0.)),
        ((0, 1.), (2, 0.)),
        ((0, 2.), (3, 0.)),
        ((1, 1.), (3, 2.)),
        ((1, 2.), (2, 1.)),
        ((2, 2.), (3, 1.)),
    ]
    .map(|((p, i), (q, j))| Seam { a: span(p, i), b: span(q, j) })
    .to_vec();
    let gluing = Gluing { outlines, seams, points: 30, slack: 1e-9 };
    let glued = glue(&gluing, &Silent).expect("a tetrahedron");
    assert_true(&glued);
    assert_eq!((glued.mesh.vertex_count(), glued.net.pieces.len()), (4, 4));
    let mut open = gluing.clone();
    open.seams.pop();
    assert!(matches!(glue(&open, &Silent), Err(GluingError::Rim { twice: false, .. })));
    let mut twice = gluing.clone();
    twice.seams.push(twice.seams[0].clone());
    assert!(matches!(glue(&twice, &Silent), Err(GluingError::Rim { twice: true, .. })));
    let mut longer = gluing.clone();
    longer.seams[0].a.to += 1.0;
    assert!(matches!(glue(&longer, &Silent), Err(GluingError::Lengths { .. })));
}

#[test]
fn a_torus_and_two_bodies_are_refused() {
    let square = named("regular-4");
    let side = square.length() / 4.0;
    let span = |piece: usize, k: f64| Span { piece, from: k * side, to: (k + 1.0) * side };
    let torus = Gluing {
        outlines: vec![square.clone()],
        seams: vec![
            Seam { a: span(0, 0.0), b: span(0, 2.0) },
            Seam { a: span(0, 1.0), b: span(0, 3.0) },
        ],
        points: 40,
        slack: 1e-9,
    };
    assert!(matches!(glue(&torus, &Silent), Err(GluingError::NoSphere { euler: 0, .. })));
    let whole = |piece: usize| Span { piece, from: 0.0, to: 4.0 * side };
    let apart = Gluing {
        outlines: vec![square.clone(), square.clone(), square.clone(), square],
        seams: vec![Seam { a: whole(0), b: whole(1) }, Seam { a: whole(2), b: whole(3) }],
        points: 40,
        slack: 1e-9,
    };
    assert!(matches!(glue(&apart, &Silent), Err(GluingError::Apart { .. })));
}

#[test]
fn planes_bound_a_solid_around_the_body() {
    let glued = pair("ellipse-2x1", "ellipse-2x1", 0.25, 60).expect("a body");
    let mut last = f64::INFINITY;
    for planes in [4, 8, 16] {
        let solid = planar_body(&glued, planes).expect("a solid");
        assert!(convexity(&solid.mesh).is_convex());
        assert_eq!(solid.mesh.face_count() + solid.without_face, 2 * planes);
        assert!(solid.distance > 0.0 && solid.distance < last, "{planes}: {}", solid.distance);
        last = solid.distance;
    }
    assert!(last < 2.0, "{last}");
    assert!(matches!(planar_body(&glued, 1), Err(GluingError::Planes { .. })));
}

#[test]
fn names_are_read_and_misspelt_ones_answered() {
    for name in [
        "circle",
        "ellipse-2x1",
        "superellipse-2x1-4",
        "rounded-rectangle-3x2-0.3",
        "rectangle-3x1",
        "lens-0.5",
        "regular-7",
        "trefoil-0.25",
        "peanut-0.2",
        "egg-0.2",
    ] {
        let outline = named(name);
        assert!((outline.size().max_element() - 100.0).abs() < 1e-9, "{name}");
    }
    let misspelt = named_outline("elipse-2x1").expect_err("no outline").to_string();
    assert!(misspelt.contains("did you mean ellipse"), "{misspelt}");
    for bad in [
        "ellipse",
        "ellipse-2",
        "ellipse-0x1",
        "regular-2",
        "regular-2.5",
        "trefoil-9",
        "circle-3",
        "superellipse-2x1",
    ] {
        assert!(matches!(named_outline(bad), Err(GluingError::NameNumbers { .. })), "{bad}");
    }
}

#[test]
fn outlines_that_bound_nothing_are_refused() {
    let line = [DVec2::ZERO, DVec2::X, DVec2::new(2.0, 0.0)];
    assert!(matches!(Outline::new("line", &line), Err(GluingError::BadOutline { .. })));
    let bow = [(0., 0.), (60., 50.), (60., 0.), (0., 40.)].map(|(x, y)| DVec2::new(x, y));
    let bow = Outline::new("bow", &bow).expect("has an area");
    let refused = glue(&Gluing::zip(bow, 0.0, 60), &Silent);
    assert!(matches!(refused, Err(GluingError::BadOutline { .. } | GluingError::Angle { .. })));
    let few = glue(&Gluing::zip(named("circle"), 0.0, 3), &Silent);
    assert!(matches!(few, Err(GluingError::Points { .. })));
}
