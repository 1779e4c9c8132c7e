//! Joints on whole models, looked at by code that shares nothing with the one that made them: only
//! the lines that are drawn are read.

use glam::DVec2;
use kerfold::make::{FabricateParams, FabricateSettings, fabricate};
use kerfold::net::Net;
use kerfold::progress::Silent;
use kerfold::shape::{SolidParams, solid};
use kerfold::sheet::{
    Angles, Drawing, Joint, JointParams, LayerKind, LetterParams, MarkKind, SheetParams, SheetSet,
    SheetSize, StockParams, lay_out, smallest_box,
};
use kerfold::unfold::{MeshSource, Seams, UnfoldParams, unfold};
use kerfold::units::Length;

const JOINTS: [Joint; 6] =
    [Joint::None, Joint::Flaps, Joint::Rivets, Joint::Stitch, Joint::Fingers, Joint::Tabs];

fn net(name: &str, size: f64, pieces: &str) -> Net {
    let params = SolidParams {
        name: name.parse().expect("a solid"),
        edge: None,
        size: Some(Length::from_mm(size)),
    };
    let mesh = solid(&params).expect("a solid");
    let unfolding =
        UnfoldParams { pieces: pieces.parse().expect("a mode"), ..UnfoldParams::default() };
    unfold(
        &mesh,
        &Seams::Free,
        &unfolding,
        &MeshSource { scale: 1.0, split_vertices: &[] },
        &Silent,
    )
    .expect("a net")
}

fn sheets(net: &Net, joint: Joint, kerf: f64) -> SheetSet {
    let params = SheetParams {
        joint: JointParams {
            kind: joint,
            thickness: matches!(joint, Joint::Fingers | Joint::Tabs).then(|| Length::from_mm(3.0)),
            ..JointParams::default()
        },
        stock: StockParams {
            kerf: Length::from_mm(kerf),
            sheet: SheetSize::of_mm(1500.0, 1500.0),
            ..StockParams::default()
        },
        letter: LetterParams { angles: Angles::On, ..LetterParams::default() },
        ..SheetParams::default()
    };
    lay_out(net, &params).unwrap_or_else(|e| panic!("{joint:?} {kerf}: {e}"))
}

/// Twice the area of a triangle, with its sign.
fn turn(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// Whether the insides of two segments cross.
fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0
}

/// By counting crossings of a ray.
fn inside(polygon: &[[DVec2; 2]], p: DVec2) -> bool {
    let crossed = polygon.iter().filter(|[a, b]| {
        (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    crossed.count() % 2 == 1
}

type Lines = Vec<[DVec2; 2]>;

/// The lines of every mark that `wanted` takes.
fn lines(drawing: &Drawing, wanted: impl Fn(MarkKind) -> bool) -> Vec<(String, Lines)> {
    let marks = drawing.marks().filter(|m| wanted(m.kind));
    marks
        .map(|mark| {
            let segments = mark.strokes.iter().flat_map(|stroke| {
                let last = stroke
                    .closed
                    .then(|| [stroke.points[stroke.points.len() - 1], stroke.points[0]]);
                stroke.points.windows(2).map(|w| [w[0], w[1]]).chain(last).collect::<Vec<_>>()
            });
            (mark.id.clone(), segments.collect())
        })
        .collect()
}

fn assert_no_cross(what: &str, a: &Lines, b: &Lines) {
    for &s in a {
        for &t in b {
            assert!(!cross(s, t), "{what}: {s:?} crosses {t:?}");
        }
    }
}

/// With the four decimals of a file, no contour goes out along a line and back on it.
fn assert_no_spike(what: &str, contour: &Lines) {
    let mut points: Vec<[i64; 2]> =
        contour.iter().map(|[a, _]| a.to_array().map(|x| (x * 1e4).round() as i64)).collect();
    points.dedup();
    let n = points.len();
    for i in 0..n {
        let [before, tip, after] = [points[(i + n - 1) % n], points[i], points[(i + 1) % n]];
        assert!(before != after, "{what}: out to {tip:?} and back to {after:?}, in 0.1 µm");
    }
}

fn assert_sheet(what: &str, drawing: &Drawing) {
    let outlines = lines(drawing, |k| k == MarkKind::Outline);
    let holes = lines(drawing, |k| k == MarkKind::Hole);
    let cuts: Lines = outlines.iter().chain(&holes).flat_map(|(_, l)| l.clone()).collect();
    for (id, outline) in outlines.iter().chain(&holes) {
        assert_no_spike(&format!("{what} {id}"), outline);
    }
    // No cut crosses another one or itself: no piece, flap, slot or hole overlaps anything.
    assert_no_cross(what, &cuts, &cuts);
    for (id, hole) in &holes {
        let own = outlines.iter().filter(|(piece, _)| id.starts_with(&format!("{piece}-")));
        let own: Vec<_> = own.collect();
        assert_eq!(own.len(), 1, "{what}: {id}");
        assert!(
            hole.iter().all(|s| inside(&own[0].1, s[0])),
            "{what}: {id} is outside of its piece"
        );
        for (other, lines) in holes.iter().filter(|(other, _)| other != id) {
            assert!(!inside(lines, hole[0][0]), "{what}: {id} is inside of {other}");
        }
    }
    for (id, outline) in &outlines {
        for (other, lines) in outlines.iter().filter(|(other, _)| other != id) {
            assert!(!inside(lines, outline[0][0]), "{what}: {id} lies on {other}");
        }
    }
    // Lettering is on a piece and crosses neither cut nor fold.
    let scores: Lines =
        lines(drawing, |k| k.layer() == LayerKind::Score).into_iter().flat_map(|l| l.1).collect();
    for (id, text) in lines(drawing, |k| k.layer() == LayerKind::Engrave) {
        assert_no_cross(&format!("{what} {id}"), &text, &cuts);
        assert_no_cross(&format!("{what} {id}"), &text, &scores);
        assert!(
            outlines.iter().any(|(_, o)| text.iter().all(|s| inside(o, s[0]))),
            "{what}: {id} is on no piece"
        );
        assert!(!holes.iter().any(|(_, h)| inside(h, text[0][0])), "{what}: {id} is in a hole");
    }
    // Folds stay inside of their pieces.
    for (id, fold) in lines(drawing, |k| k.layer() == LayerKind::Score) {
        for [a, b] in fold {
            let within = |t: f64| outlines.iter().any(|(_, o)| inside(o, a.lerp(b, t)));
            assert!(
                [1e-6, 0.5, 1.0 - 1e-6].into_iter().all(within),
                "{what}: {id} leaves its piece"
            );
        }
    }
}

#[test]
fn no_joint_overlaps_anything_on_any_sheet() {
    for (name, size, pieces) in [
        ("dodecahedron", 180.0, "1"),
        ("cube", 100.0, "faces"),
        ("soccer-ball", 250.0, "1"),
        ("snub-cube", 200.0, "3"),
        ("octahedron", 150.0, "2"),
        ("prism-5", 90.0, "1"),
        ("geodesic-2", 160.0, "auto"),
    ] {
        let net = net(name, size, pieces);
        for joint in JOINTS {
            for kerf in [0.0, 0.2] {
                let set = sheets(&net, joint, kerf);
                for drawing in &set.drawings {
                    assert_sheet(&format!("{name} {joint:?} kerf {kerf}"), drawing);
                }
            }
        }
    }
}

#[test]
fn every_seam_has_its_number_on_both_sides_or_the_report_counts_it() {
    for joint in JOINTS {
        let net = net("dodecahedron", 180.0, "2");
        let set = sheets(&net, joint, 0.1);
        let marks =
            set.drawings.iter().flat_map(|d| d.marks().filter(|m| m.kind == MarkKind::SeamNumber));
        let ids: Vec<String> = marks.map(|m| m.id.clone()).collect();
        let sides = 2 * set.assembly.stretches.len();
        assert_eq!(ids.len() + set.report.unnumbered_sides, sides, "{joint:?}");
        assert_eq!(set.report.unnumbered_sides, 0, "{joint:?}: a face of 70 mm has room");
        for id in &ids {
            let other = match id.strip_suffix("-1") {
                Some(stem) => format!("{stem}-2"),
                None => format!("{}-1", id.trim_end_matches("-2")),
            };
            assert!(ids.contains(&other), "{joint:?}: {id} without {other}");
        }
    }
}

#[test]
fn plates_of_a_cube_have_a_tab_for_every_slot() {
    let net = net("cube", 100.0, "faces");
    let set = sheets(&net, Joint::Tabs, 0.0);
    assert_eq!((set.report.joints.tabbed, set.report.joints.fallbacks.len()), (12, 0));
    let slots: usize =
        set.drawings.iter().flat_map(|d| d.marks()).filter(|m| m.kind == MarkKind::Hole).count();
    // Tabs are the sides of the outlines as long as a tab that lie on the edges of the square;
    // slots are 9 × 3 mm.
    let mut tops = 0;
    for mark in set.drawings.iter().flat_map(|d| d.marks()).filter(|m| m.kind == MarkKind::Outline)
    {
        let p = &mark.strokes[0].points;
        tops += (0..p.len())
            .filter(|&i| (p[i].distance(p[(i + 1) % p.len()]) - 9.0).abs() < 1e-6)
            .count();
    }
    assert!(slots >= 12);
    // Between two tabs the edge is as long as a tab, too: on every one of the 12 edges one less
    // than tabs.
    assert_eq!(tops, 2 * slots - 12);
}

#[test]
fn flaps_count_when_a_piece_is_divided_for_the_sheet() {
    let params = SolidParams {
        name: "dodecahedron".parse().expect("a solid"),
        edge: None,
        size: Some(Length::from_mm(180.0)),
    };
    let mesh = solid(&params).expect("a solid");
    let source = MeshSource { scale: 1.0, split_vertices: &[] };
    let made = |sheet: &SheetParams| {
        let choice = FabricateParams::default();
        let unfold = UnfoldParams::default();
        let settings = FabricateSettings { unfold: &unfold, choice: &choice, sheet };
        fabricate(&mesh, None, &settings, &source, &Silent).expect("pieces on sheets")
    };
    let none = made(&SheetParams {
        stock: StockParams { sheet: SheetSize::None, ..StockParams::default() },
        ..SheetParams::default()
    });
    let bare = smallest_box(&none.net.pieces[0].outline);
    // A sheet on which the piece fits without flaps and does not with them.
    let sheet = SheetSize::of_mm(bare.width + 12.0, bare.height + 12.0);
    assert_eq!(
        made(&SheetParams {
            stock: StockParams { sheet, ..StockParams::default() },
            ..SheetParams::default()
        })
        .net
        .pieces
        .len(),
        1
    );
    let flapped = made(&SheetParams {
        stock: StockParams { sheet, ..StockParams::default() },
        joint: JointParams { kind: Joint::Flaps, ..JointParams::default() },
        ..SheetParams::default()
    });
    assert!(flapped.net.pieces.len() > 1 && flapped.divided > 0);
}
