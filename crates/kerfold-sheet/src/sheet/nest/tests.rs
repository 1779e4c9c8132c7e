//! Laws of nesting over random sets: what lies on a sheet is measured by `verify`, which shares
//! nothing with the search.

use std::collections::BTreeSet;

use glam::DVec2;
use proptest::prelude::*;

use super::super::testing::{ell, net_of, piece, random_convex, ring, square};
use super::super::verify::{clearance, verify};
use super::super::{
    CutShape, Layout, SheetError, SheetParams, SheetSet, SheetSize, StockParams, lay_out,
    lay_out_watched,
};
use super::{
    Corners, DefectList, GroupList, Guillotine, NestParams, Rotation, RotationList, StockList,
};
use crate::net::{Net, PieceId};
use crate::progress::Progress;

fn params(width: f64, height: f64) -> SheetParams {
    let nest = NestParams { nest_effort: 1, ..NestParams::default() };
    SheetParams {
        stock: StockParams { sheet: SheetSize::of_mm(width, height), ..StockParams::default() },
        nest,
        ..SheetParams::default()
    }
}

fn laid(net: &Net, params: &SheetParams) -> SheetSet {
    lay_out(net, params).expect("all pieces fit")
}

fn polygons(count: u64) -> Net {
    net_of((0..count).map(random_convex).collect())
}

fn sheet_of(layout: &Layout, piece: usize) -> usize {
    layout
        .sheets
        .iter()
        .position(|s| s.placed.iter().any(|p| p.piece == PieceId(piece)))
        .expect("it lies somewhere")
}

#[test]
fn more_effort_is_never_worse_and_the_seed_decides() {
    let net = polygons(30);
    let run = |effort, seed| {
        let mut params = params(200.0, 150.0);
        (params.nest.nest_effort, params.nest.nest_seed) = (effort, seed);
        laid(&net, &params)
    };
    let left = |set: &SheetSet| {
        let last = set.layout.sheets.last().expect("sheets");
        (set.layout.sheets.len(), last.offcut.map_or(200.0, |o| o[0].x))
    };
    let (none, some) = (run(0, 7), run(4, 7));
    assert!(left(&some) < left(&none), "{:?} {:?}", left(&some), left(&none));
    assert_eq!(run(1, 7), run(1, 7));
    assert_ne!(run(1, 7), run(1, 8));
}

#[test]
fn a_small_piece_lies_in_the_hole_of_a_large_one() {
    let frame = {
        let mut frame = piece(PieceId(0), square(190.0));
        frame.holes =
            vec![square(150.0).into_iter().rev().map(|p| p + DVec2::splat(20.0)).collect()];
        frame
    };
    let mut net = net_of(vec![square(190.0), square(100.0), square(30.0)]);
    net.pieces[0] = frame;
    let set = laid(&net, &params(200.0, 200.0));
    assert_eq!(set.layout.sheets.len(), 1);
}

#[test]
fn grain_and_single_rotations_are_kept() {
    let net = polygons(12);
    let mut params = params(200.0, 150.0);
    params.nest.rotations = Rotation::Grain(30.0);
    params.nest.rotate = "P03=fixed,P05-P06=90".parse::<RotationList>().expect("a list");
    let layout = laid(&net, &params).layout;
    for placed in layout.sheets.iter().flat_map(|s| &s.placed) {
        let allowed: &[f64] = match placed.piece.0 {
            2 => &[0.0],
            4 | 5 => &[0.0, 90.0, 180.0, 270.0],
            _ => &[150.0, 330.0],
        };
        assert!(allowed.contains(&placed.rotation), "{placed:?}");
    }
}

#[test]
fn groups_share_a_sheet() {
    let net = polygons(24);
    let mut params = params(160.0, 120.0);
    params.nest.together = "P01,P24;P05-P09".parse::<GroupList>().expect("groups");
    let layout = laid(&net, &params).layout;
    assert!(layout.sheets.len() > 1);
    assert_eq!(sheet_of(&layout, 0), sheet_of(&layout, 23));
    assert_eq!((4..9).map(|i| sheet_of(&layout, i)).collect::<BTreeSet<_>>().len(), 1);
    params.nest.together = "P01-P24".parse().expect("a group");
    let error = lay_out(&net, &params).expect_err("too many for one sheet");
    assert!(error.to_string().contains("are to lie on one sheet"), "{error}");
}

#[test]
fn sheets_in_stock_come_first_and_larger_pieces_wait_for_larger_sheets() {
    let mut contours: Vec<_> = (0..10).map(random_convex).collect();
    contours.push(square(140.0));
    let mut params = params(160.0, 150.0);
    params.nest.stock = "90x80*2".parse::<StockList>().expect("stock");
    let layout = laid(&net_of(contours), &params).layout;
    let sizes: Vec<(f64, f64)> = layout.sheets.iter().map(|s| (s.width, s.height)).collect();
    assert_eq!(sizes[..2], [(90.0, 80.0); 2], "{sizes:?}");
    assert_eq!(layout.sheets[sheet_of(&layout, 10)].width, 160.0);
}

#[test]
fn outlines_and_defects_are_kept_clear() {
    let net = polygons(8);
    let mut params = params(200.0, 200.0);
    params.nest.sheet_outline =
        "0,0:200,0:200,60:60,200:0,200".parse::<Corners>().expect("an outline");
    params.nest.defects =
        "40,40:80,60;1@10,100:30,100:20,130".parse::<DefectList>().expect("defects");
    let set = laid(&net, &params);
    let corners = set.layout.sheets[0]
        .placed
        .iter()
        .flat_map(|p| p.apply_all(&net.pieces[p.piece.0].outline));
    for p in corners {
        assert!((p.x + p.y) < 260.0 - 5.0, "{p} is over the slanted side");
        assert!(!(p.x > 38.0 && p.x < 82.0 && p.y > 38.0 && p.y < 62.0), "{p} is on the defect");
    }
    params.nest.guillotine = Guillotine::On;
    assert_eq!(lay_out(&net, &params), Err(SheetError::GuillotineOption));
    params.nest.guillotine = Guillotine::Off;
    params.nest.sheet_outline = "0,0:200,200:200,0:0,190".parse().expect("corners");
    assert!(matches!(lay_out(&net, &params), Err(SheetError::BadPolygon { .. })));
    params.nest.sheet_outline = "0,0:300,0:0,100".parse().expect("corners");
    let error = lay_out(&net, &params).expect_err("off the sheet");
    assert!(error.to_string().contains("300,0"), "{error}");
}

/// Pieces that lie on the border of a sheet are off it by rounding, and not over it.
#[test]
fn a_sheet_with_an_outline_needs_no_margin() {
    for outline in ["0,0:200,0:200,200:0,200", "0,0:200,0:200,60:60,200:0,200"] {
        for count in 8..12 {
            let mut params = params(200.0, 200.0);
            params.stock.margin = crate::units::Length::from_mm(0.0);
            params.nest.sheet_outline = outline.parse().expect("an outline");
            let set = laid(&polygons(count), &params);
            assert!(!set.layout.sheets.is_empty());
        }
    }
}

/// Divides a rectangle by the cuts in their order: each must run from side to side of the part that
/// it lies in.
fn assert_edge_to_edge(size: DVec2, cuts: &[[DVec2; 2]]) {
    let mut parts = vec![(DVec2::ZERO, size)];
    for &[a, b] in cuts {
        let near = |x: f64, y: f64| (x - y).abs() < 1e-6;
        let middle = a.midpoint(b);
        let at = parts
            .iter()
            .position(|(l, h)| middle.cmpgt(*l - 1e-7).all() && middle.cmplt(*h + 1e-7).all());
        let (low, high) = parts.swap_remove(at.expect("a part that is cut"));
        if near(a.x, b.x) {
            assert!(
                near(a.y.min(b.y), low.y) && near(a.y.max(b.y), high.y),
                "{a} {b} in {low} {high}"
            );
            parts.extend([(low, DVec2::new(a.x, high.y)), (DVec2::new(a.x, low.y), high)]);
        } else {
            assert!(
                near(a.x.min(b.x), low.x) && near(a.x.max(b.x), high.x),
                "{a} {b} in {low} {high}"
            );
            parts.extend([(low, DVec2::new(high.x, a.y)), (DVec2::new(low.x, a.y), high)]);
        }
    }
}

#[test]
fn guillotine_cuts_go_from_edge_to_edge_and_through_no_piece() {
    let net = polygons(30);
    for (rotation, spacing) in [(Rotation::Free, 3.0), (Rotation::Fixed, 0.5)] {
        let mut params = params(200.0, 150.0);
        params.stock.spacing = crate::units::Length::from_mm(spacing);
        (params.nest.guillotine, params.nest.rotations) = (Guillotine::On, rotation);
        let set = laid(&net, &params);
        assert!(set.layout.sheets.len() > 1);
        for sheet in &set.layout.sheets {
            assert!(sheet.cuts.len() >= sheet.placed.len());
            assert_edge_to_edge(DVec2::new(200.0, 150.0), &sheet.cuts);
        }
        let mut moved = set.layout.clone();
        let (low, high) = (sheet_corner(&moved), moved.sheets[0].cuts[3]);
        moved.sheets[0].placed[0].x += high[0].x - low.x - 1.0;
        let shapes: Vec<CutShape> =
            net.pieces.iter().map(|p| CutShape::of_piece(p, 0.0).expect("sound")).collect();
        assert!(verify(&shapes, &moved, &params).is_err());
    }
    let whole = laid(
        &net_of(vec![square(100.0)]),
        &SheetParams {
            stock: StockParams { sheet: SheetSize::of_mm(110.0, 110.0), ..params(0.0, 0.0).stock },
            ..params(0.0, 0.0)
        },
    );
    assert_eq!(whole.layout.sheets.len(), 1);
}

fn sheet_corner(layout: &Layout) -> DVec2 {
    let placed = layout.sheets[0].placed[0];
    DVec2::new(placed.x, placed.y)
}

#[test]
fn names_that_are_not_there_are_told() {
    let mut params = params(200.0, 150.0);
    params.nest.rotate = "P09=fixed".parse().expect("a list");
    let error = lay_out(&polygons(3), &params).expect_err("no P09").to_string();
    assert!(error.contains("P09") && error.contains("P01 to P03"), "{error}");
}

struct Stopped;

impl Progress for Stopped {
    fn report(&self, _work: &str, _done: usize, _total: usize) {}

    fn is_cancelled(&self) -> bool {
        true
    }
}

#[test]
fn who_stops_the_search_gets_the_best_so_far() {
    let mut params = params(200.0, 150.0);
    params.nest.nest_effort = 1_000_000;
    let set = lay_out_watched(&polygons(20), &params, &Stopped).expect("a layout all the same");
    assert!(set.report.is_stopped && !set.layout.sheets.is_empty());
}

/// A lone piece that fits its sheet at few angles only: the search must see that it cannot be laid
/// shorter, and end.
#[test]
fn a_piece_that_hardly_fits_ends_the_search() {
    // The room inside the margin is 120 x 100.
    let corners = [[0.0, 0.0], [116.0, 0.0], [118.0, 40.0], [59.0, 98.0], [0.0, 40.0]];
    let long: Vec<DVec2> = corners.map(DVec2::from).to_vec();
    let mut params = params(130.0, 110.0);
    params.nest.nest_effort = 5;
    for seed in 0..6 {
        params.nest.nest_seed = seed;
        let set = laid(&net_of(vec![long.clone()]), &params);
        assert_eq!(set.layout.sheets.len(), 1);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    /// Any pieces, any rotations, any spacing: the re-measuring, which lay_out does itself, finds
    /// nothing; nor does a measure of every pair.
    #[test]
    fn nothing_overlaps_and_the_spacing_is_kept(
        seeds in prop::collection::vec(0_u64..1000, 2..14),
        turn in 0..4_usize,
        spacing in 0.01..6.0_f64,
        seed in 0_u64..100,
    ) {
        let mut contours: Vec<_> = seeds.iter().map(|&s| random_convex(s)).collect();
        contours.push(ell());
        let mut net = net_of(contours);
        net.pieces.push(ring(PieceId(net.pieces.len())));
        let mut params = params(130.0, 110.0);
        params.stock.spacing = crate::units::Length::from_mm(spacing);
        params.nest.rotations = [Rotation::Free, Rotation::Quarter, Rotation::Half, Rotation::Fixed][turn];
        params.nest.nest_seed = seed;
        let set = laid(&net, &params);
        let shapes: Vec<CutShape> = net.pieces.iter().map(|p| CutShape::of_piece(p, 0.0).expect("sound")).collect();
        for sheet in &set.layout.sheets {
            for (i, a) in sheet.placed.iter().enumerate() {
                for b in &sheet.placed[..i] {
                    prop_assert!(clearance((&shapes[a.piece.0], a), (&shapes[b.piece.0], b)) > spacing - 1e-6);
                }
            }
        }
    }
}
