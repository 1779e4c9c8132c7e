//! Where every piece lies, and the one call from a net to drawings.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;

use super::assembly::{Assembly, assembly};
use super::boundary::Boundaries;
use super::bounding_box::{rounded, smallest_box};
use super::distance::contour_distance;
use super::draw::draw;
use super::drawing::Drawing;
use super::error::{SheetError, TooLarge};
use super::info::{draw_info, verify_info};
use super::joint::join;
use super::kerf::CutShape;
use super::layout::{Layout, Placed, Sheet, SheetId, SheetReport};
use super::nest::{CommonLine, Laid, StockSheet, candidates, lay, offcut};
use super::params::SheetParams;
use super::score_gap::near_scores;
use super::slit::mend;
use super::stock::Stock;
use super::stretch::stretches;
use super::verify::verify;
use crate::geom::polygon::{Location, bounds, locate};
use crate::net::{Net, Piece, PieceId};
use crate::progress::{Progress, Silent};
use crate::units::Length;

/// Sheets with their drawings, measured and ready to be written.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SheetSet {
    /// Where the pieces lie.
    pub layout: Layout,
    /// One drawing per sheet.
    pub drawings: Vec<Drawing>,
    /// In which order the seams are closed.
    pub assembly: Assembly,
    /// What was left out.
    pub report: SheetReport,
}

impl SheetSet {
    /// Length of the travel moves of all sheets, in mm.
    pub fn travel_length(&self) -> f64 {
        self.drawings.iter().map(Drawing::travel_length).sum()
    }

    /// Estimated seconds on the machine for all sheets, where a material has speeds.
    pub fn seconds(&self, params: &SheetParams) -> Option<f64> {
        let speeds = params.stock.made_of.as_ref()?.speed;
        Some(self.drawings.iter().map(|d| speeds.seconds(d)).sum())
    }
}

/// Whether a piece, kerf included, fits on an empty sheet at an angle that is allowed. Every piece
/// fits on `sheet = none`.
///
/// # Errors
/// As [`lay_out`], for the parameters and the piece's contours; a piece too large is no error here.
pub fn fits(piece: &Piece, params: &SheetParams) -> Result<bool, SheetError> {
    let Some(sheets) = params.sheets()? else { return Ok(true) };
    let shapes = [CutShape::of_piece(piece, params.stock.kerf.mm())?];
    Ok(candidates(&shapes, &sheets, &params.nest)
        .iter()
        .all(|c| c.poses.iter().any(Option::is_some)))
}

/// Places, letters, draws and measures all pieces of a net. For `sheet = none` everything is empty.
///
/// # Errors
/// [`SheetError::OutOfRange`], [`SheetError::MarginTooLarge`], [`SheetError::JointOption`],
/// [`SheetError::FlapAngle`], [`SheetError::BadPolygon`], [`SheetError::GuillotineOption`] and
/// [`SheetError::NoSuchPiece`] for parameters; [`SheetError::PiecesTooLarge`] with all pieces that
/// fit at no angle, so that they can be split; [`SheetError::NoPlace`] for pieces that outlines,
/// defects and groups leave no place for; [`SheetError::BadContour`], [`SheetError::KerfSplit`] and
/// [`SheetError::UnknownPiece`] for a broken net; what [`verify`] finds, for a bug of ours.
///
/// # Example
/// ```
/// use glam::DVec2;
/// use kerfold_sheet::net::{MeshCounts, Net, Piece, PieceId, Proof};
/// use kerfold_sheet::sheet::{SheetParams, lay_out};
///
/// let outline = [[0.0, 0.0], [80.0, 0.0], [80.0, 50.0]].map(DVec2::from).to_vec();
/// let net = Net {
///     scale: 1.0,
///     counts: MeshCounts { vertices: 0, edges: 0, faces: 0 },
///     pieces: vec![Piece { id: PieceId(0), outline, holes: vec![], faces: vec![] }],
///     folds: vec![],
///     seams: vec![],
///     rims: vec![],
///     proof: Proof { congruence_mm: 0.0, refold_mm: 0.0, overlaps: 0 },
/// };
/// let sheets = lay_out(&net, &SheetParams::default())?;
/// assert_eq!(sheets.layout.sheets[0].placed.len(), 1);
/// # Ok::<(), kerfold_sheet::sheet::SheetError>(())
/// ```
pub fn lay_out(net: &Net, params: &SheetParams) -> Result<SheetSet, SheetError> {
    lay_out_watched(net, params, &Silent)
}

/// As [`lay_out`], with reports. When it is asked to stop, the best layout so far is drawn.
///
/// # Errors
/// As [`lay_out`].
pub fn lay_out_watched(
    net: &Net,
    params: &SheetParams,
    progress: &dyn Progress,
) -> Result<SheetSet, SheetError> {
    params.stock.check_material()?;
    let Some(sheets) = params.sheets()? else {
        return Ok(SheetSet::default());
    };
    check_names(net, params)?;
    let mended = mend(net);
    let net = mended.as_ref().map_or(net, |m| &m.net);
    let boundaries = Boundaries::new(net);
    let stretches = stretches(net, &boundaries);
    let jointed = join(net, &params.joint, &params.stock)?;
    let bare = net;
    let net = jointed.as_ref().map_or(net, |j| &j.net);
    let shapes = net
        .pieces
        .iter()
        .map(|p| CutShape::of_piece(p, params.stock.kerf.mm()))
        .collect::<Result<Vec<_>, _>>()?;
    let (mut layout, widened) = place_all(net, &shapes, (params, &sheets), progress)?;
    let (mut drawings, mut report) =
        draw(net, &shapes, &layout, (params, &stretches, jointed.as_ref()))?;
    for (drawing, sheet) in drawings.iter_mut().zip(&layout.sheets) {
        let tolerance = 6.0 * sheets[sheet.stock].stock.rounding();
        // With a kerf, lines of one part that meet have become one.
        let meets_itself = params.stock.kerf.mm() == 0.0 && drawing.cut_own_lines_once(tolerance);
        if params.nest.common_line == CommonLine::On {
            report.shared_length += drawing.cut_once(tolerance);
        }
        if meets_itself || params.nest.common_line == CommonLine::On {
            drawing.arrange();
        }
    }
    draw_info(&mut drawings, (net, &shapes), (&layout, &sheets), params, &mut report)?;
    report.near_scores = near_scores(net, &drawings, params);
    report.widened_pieces = widened;
    report.lost_holes = shapes.iter().map(|s| s.lost_holes).sum();
    report.closed_notches = shapes.iter().map(|s| s.closed_notches).sum();
    let narrow = |i: usize| narrow_holes([&bare.pieces[i], &net.pieces[i]], &shapes[i], params);
    report.narrow_holes = (0..shapes.len()).map(narrow).sum();
    report.widened_notches = shapes.iter().map(|s| s.widened_notches).sum();
    report.narrow_spacing = params.stock.made_of.as_ref().and_then(|material| {
        let [left, web] = [params.stock.spacing.mm() - params.stock.kerf.mm(), material.web.mm()];
        (left < web).then_some([left, web])
    });
    report.is_stopped = progress.is_cancelled();
    layout.cut_length = drawings.iter().map(Drawing::cut_length).sum();
    layout.score_length = drawings.iter().map(Drawing::score_length).sum();
    verify(&shapes, &layout, params)?;
    verify_info(&drawings, &shapes, &layout)?;
    report.joints = jointed.map(|j| j.report).unwrap_or_default();
    let mut assembly = assembly(bare, stretches);
    if let Some(mended) = mended {
        // Seams are named by their index in the net that was given.
        let seams = assembly.stretches.iter_mut().flat_map(|s| &mut s.seams);
        seams.for_each(|(s, _)| *s = mended.seams[*s]);
        report.uncut_seams = mended.uncut;
    }
    Ok(SheetSet { layout, drawings, assembly, report })
}

/// Least material that is wanted between two cuts, in mm.
const LEAST_WEB: f64 = 1.0;

/// Holes narrower than this many thicknesses burn out.
const LEAST_HOLE: f64 = 1.5;

/// How many holes of a piece are narrower than the thickness wants, or nearer to another contour of
/// it than a web should be. What joints cut is made to be so narrow and does not count; a notch whose
/// mouth is narrower than the kerf leaves a hole that does.
fn narrow_holes([bare, jointed]: [&Piece; 2], shape: &CutShape, params: &SheetParams) -> usize {
    let of_material = params.stock.made_of.as_ref().map(|m| m.thickness);
    let thickness = params.joint.thickness.or(of_material).map_or(0.0, Length::mm);
    let own = narrow_among(&bare.outline, &bare.holes, (0.0, thickness), |_| true);
    if shape.closed_notches == 0 {
        return own;
    }
    let is_left = |cut: &[DVec2]| {
        let is_within = |hole: &Vec<DVec2>| locate(hole, cut[0]) == Location::Inside;
        !jointed.holes.iter().any(is_within)
    };
    let kerf = params.stock.kerf.mm();
    own + narrow_among(&shape.outline, &shape.holes, (kerf, thickness), is_left)
}

/// The same for those contours that count, along which a cut of a width in mm is made in material of
/// a thickness.
fn narrow_among(
    outline: &[DVec2],
    holes: &[Vec<DVec2>],
    (kerf, thickness): (f64, f64),
    counts: impl Fn(&[DVec2]) -> bool,
) -> usize {
    let is_narrow = |hole: &[DVec2]| {
        let least = smallest_box(hole);
        least.width.min(least.height) + kerf < LEAST_HOLE * thickness
    };
    let is_near = |i: usize| {
        let others = holes.iter().enumerate().filter(|&(j, _)| j != i).map(|(_, hole)| &hole[..]);
        std::iter::once(outline)
            .chain(others)
            .any(|other| contour_distance(&holes[i], other) - kerf < LEAST_WEB)
    };
    let those = (0..holes.len()).filter(|&i| counts(&holes[i]));
    those.filter(|&i| is_narrow(&holes[i]) || is_near(i)).count()
}

/// Whether all pieces that the parameters name are there.
fn check_names(net: &Net, params: &SheetParams) -> Result<(), SheetError> {
    let known: BTreeSet<PieceId> = net.pieces.iter().map(|p| p.id).collect();
    let turned = params.nest.rotate.0.keys().map(|&piece| ("rotate", piece));
    let grouped = params.nest.together.0.iter().flatten().map(|&piece| ("together", piece));
    match turned.chain(grouped).find(|(_, piece)| !known.contains(piece)) {
        Some((name, piece)) => {
            Err(SheetError::NoSuchPiece { name, piece, pieces: net.pieces.len() })
        }
        None => Ok(()),
    }
}

fn place_all(
    net: &Net,
    shapes: &[CutShape],
    (params, sheets): (&SheetParams, &[StockSheet]),
    progress: &dyn Progress,
) -> Result<(Layout, Vec<PieceId>), SheetError> {
    let candidates = candidates(shapes, sheets, &params.nest);
    let too_large: Vec<TooLarge> = net
        .pieces
        .iter()
        .zip(&candidates)
        .filter(|(_, c)| c.poses.iter().all(Option::is_none))
        .map(|(piece, c)| {
            let least = smallest_box(&c.shape.outline);
            TooLarge {
                piece: piece.id,
                width: least.width,
                height: least.height,
                faces: piece.faces.len(),
            }
        })
        .collect();
    if !too_large.is_empty() {
        let largest = |s: &&StockSheet| s.stock.size.x * s.stock.size.y;
        let stock = sheets
            .iter()
            .max_by(|a, b| largest(a).total_cmp(&largest(b)))
            .map_or(sheets[0].stock, |s| s.stock);
        let (width, height, margin) = (stock.size.x, stock.size.y, stock.margin);
        return Err(SheetError::PiecesTooLarge { pieces: too_large, width, height, margin });
    }
    if shapes.is_empty() {
        return Ok((Layout::default(), Vec::new()));
    }
    let laid = lay(&candidates, sheets, &params.nest, progress).map_err(|no_place| {
        SheetError::NoPlace { pieces: no_place.pieces.iter().map(|&i| shapes[i].piece).collect() }
    })?;
    Ok((layout_of(shapes, &laid, sheets), laid.widened))
}

fn layout_of(shapes: &[CutShape], laid: &Laid, stock: &[StockSheet]) -> Layout {
    let mut bins: BTreeMap<usize, (Vec<Placed>, DVec2)> = BTreeMap::new();
    for (shape, lying) in shapes.iter().zip(&laid.lying) {
        let rotation = rounded(rounded(lying.angle).rem_euclid(360.0));
        let placed =
            Placed { piece: shape.piece, x: rounded(lying.at.x), y: rounded(lying.at.y), rotation };
        let (_, high) = bounds(&placed.apply_all(&shape.outline)).unwrap_or_default();
        let here = bins.entry(lying.bin).or_default();
        here.0.push(placed);
        here.1 = here.1.max(high);
    }
    let last = bins.keys().last().copied();
    let sheets = bins.into_iter().enumerate().map(|(i, (bin, (mut placed, used)))| {
        placed.sort_by_key(|p| p.piece);
        let which = bin.min(stock.len() - 1);
        let Stock { size, spacing, .. } = stock[which].stock;
        let is_whole = stock[which].outline.is_empty();
        let offcut = offcut(size, used, spacing).filter(|_| Some(bin) == last && is_whole);
        let cuts = laid.cuts.get(bin).cloned().unwrap_or_default();
        Sheet {
            id: SheetId(i),
            width: rounded(size.x),
            height: rounded(size.y),
            placed,
            stock: which,
            offcut,
            cuts,
        }
    });
    let sheets: Vec<Sheet> = sheets.collect();
    let area: f64 = shapes.iter().map(CutShape::area).sum();
    let all: f64 = sheets.iter().map(|s| s.width * s.height).sum();
    let density = if sheets.is_empty() { 0.0 } else { area / all };
    Layout { sheets, density, cut_length: 0.0, score_length: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::super::layout::Turn;
    use super::super::testing::{ell, net_of, random_convex, ring, square};
    use super::super::{Labels, LetterParams, NestParams, SheetSize, StockParams};
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn quarter_turns_are_exact() {
        let p = DVec2::new(0.1, 0.7);
        let turned = [0.0, 90.0, 180.0, 270.0, 360.0, -90.0].map(|d| Turn::degrees(d).apply(p));
        let expected = [p, p.perp(), -p, -p.perp(), p, -p.perp()];
        assert_eq!(turned, expected);
    }

    #[test]
    fn two_squares_lie_side_by_side_within_margin_and_spacing() {
        let net = net_of(vec![square(40.0), square(40.0)]);
        let set = lay_out(&net, &SheetParams::default()).expect("two squares fit");
        assert_eq!(set.layout.sheets.len(), 1);
        let placed = &set.layout.sheets[0].placed;
        let corners = placed.iter().map(|p| p.apply_all(&square(40.0))).collect::<Vec<_>>();
        assert!(corners.iter().flatten().all(|p| p.min_element() > 5.0 - 1e-8), "{corners:?}");
        assert!(contour_distance(&corners[0], &corners[1]) > 3.0 - 1e-8);
        assert!((set.layout.cut_length - 320.0).abs() < 1e-6);
        assert!((set.layout.density - 3200.0 / 240_000.0).abs() < 1e-12);
    }

    #[test]
    fn one_piece_as_large_as_the_sheet_allows_fits_and_one_larger_is_named() {
        let net = net_of(vec![square(390.0)]);
        assert!(lay_out(&net, &SheetParams::default()).is_ok());
        let net = net_of(vec![square(390.1), square(10.0), square(500.0)]);
        let error = lay_out(&net, &SheetParams::default()).expect_err("two are too large");
        let SheetError::PiecesTooLarge { pieces, .. } = &error else { panic!("{error}") };
        assert_eq!(pieces.iter().map(|p| p.piece.0).collect::<Vec<_>>(), [0, 2]);
        let text = error.to_string();
        assert!(text.contains("P01 needs 390.1 × 390.1 mm (a single face)"), "{text}");
        assert!(text.contains("use sheets of 510 × 510 mm"), "{text}");
        let fit = |size: f64| fits(&net_of(vec![square(size)]).pieces[0], &SheetParams::default());
        assert_eq!((fit(390.0), fit(390.1)), (Ok(true), Ok(false)));
    }

    #[test]
    fn the_kerf_counts_when_pieces_are_placed() {
        let params = SheetParams {
            stock: StockParams { kerf: Length::from_mm(0.2), ..StockParams::default() },
            ..SheetParams::default()
        };
        let net = net_of(vec![square(390.0)]);
        assert!(matches!(lay_out(&net, &params), Err(SheetError::PiecesTooLarge { .. })));
        let set = lay_out(&net_of(vec![square(389.8)]), &params).expect("fits with its kerf");
        let placed = set.layout.sheets[0].placed[0];
        assert!((placed.apply(DVec2::ZERO) - DVec2::splat(5.1)).length() < 1e-8);
        assert!((set.layout.cut_length - 4.0 * 390.0).abs() < 1e-5, "{}", set.layout.cut_length);
    }

    #[test]
    fn a_long_sliver_lies_along_the_diagonal() {
        let sliver = [(0.0, 0.0), (650.0, 0.0), (650.0, 4.0)].map(DVec2::from).to_vec();
        let set = lay_out(&net_of(vec![sliver]), &SheetParams::default())
            .expect("fits along the diagonal");
        let rotation = set.layout.sheets[0].placed[0].rotation;
        assert!(rotation % 90.0 > 10.0, "{rotation}");
    }

    #[test]
    fn many_pieces_go_on_to_further_sheets_and_twice_gives_the_same() {
        let mut contours: Vec<_> = (0..40).map(random_convex).collect();
        contours.extend([ell(), square(200.0)]);
        let mut net = net_of(contours);
        net.pieces.push(ring(PieceId(42)));
        let params = SheetParams {
            stock: StockParams {
                sheet: SheetSize::of_mm(300.0, 260.0),
                kerf: Length::from_mm(0.15),
                ..StockParams::default()
            },
            letter: LetterParams { labels: Labels::All, ..LetterParams::default() },
            ..SheetParams::default()
        };
        let set = lay_out(&net, &params).expect("all fit");
        assert!(set.layout.sheets.len() > 1);
        assert_eq!(set.layout.sheets.iter().map(|s| s.placed.len()).sum::<usize>(), 43);
        assert!(set.layout.density > 0.3, "{}", set.layout.density);
        assert_eq!(lay_out(&net, &params), Ok(set));
    }

    #[test]
    fn groups_share_a_sheet_and_names_lie_beside_holes() {
        let bar = [(0.0, 0.0), (150.0, 0.0), (150.0, 20.0), (0.0, 20.0)].map(DVec2::from).to_vec();
        let triangle = [(0.0, 0.0), (60.0, 0.0), (0.0, 40.0)].map(DVec2::from).to_vec();
        let mut contours = vec![square(120.0); 3];
        contours.extend(vec![ell(); 6]);
        contours.extend(vec![triangle; 10]);
        contours.extend(vec![bar; 5]);
        let mut net = net_of(contours);
        let hole: Vec<DVec2> =
            square(80.0).into_iter().rev().map(|p| p + DVec2::splat(20.0)).collect();
        net.pieces[..3].iter_mut().for_each(|p| p.holes = vec![hole.clone()]);
        for seed in 0..4 {
            let nest = NestParams {
                together: "P10-P19".parse().expect("a group"),
                stock: "300x200,200x200*2".parse().expect("stock"),
                nest_effort: 4,
                nest_seed: seed,
                ..NestParams::default()
            };
            let params = SheetParams {
                stock: StockParams {
                    sheet: SheetSize::of_mm(300.0, 250.0),
                    ..StockParams::default()
                },
                nest,
                ..SheetParams::default()
            };
            let set = lay_out(&net, &params).expect("all fit");
            assert_eq!(set.report.unnamed_pieces, []);
        }
    }

    #[test]
    fn no_sheets_means_nothing_to_draw() {
        let params = SheetParams {
            stock: StockParams { sheet: SheetSize::None, ..StockParams::default() },
            ..SheetParams::default()
        };
        let set = lay_out(&net_of(vec![square(1e6)]), &params).expect("everything fits nowhere");
        assert!(set.layout.sheets.is_empty() && set.drawings.is_empty());
        assert_eq!(
            lay_out(&net_of(vec![]), &SheetParams::default())
                .expect("nothing to place")
                .layout
                .sheets,
            []
        );
    }

    #[test]
    fn a_broken_outline_is_an_error_and_no_panic() {
        for contour in [
            vec![],
            vec![DVec2::ZERO, DVec2::ONE],
            vec![DVec2::ZERO, DVec2::X, DVec2::splat(f64::NAN)],
        ] {
            for kerf in [0.0, 0.1] {
                let params = SheetParams {
                    stock: StockParams { kerf: Length::from_mm(kerf), ..StockParams::default() },
                    ..SheetParams::default()
                };
                let result = lay_out(&net_of(vec![contour.clone()]), &params);
                assert!(
                    matches!(result, Err(SheetError::BadContour { contour: 0, .. })),
                    "{result:?}"
                );
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]
        /// Spiky pieces, any kerf, any spacing: the re-measuring at the end finds nothing.
        #[test]
        fn spiky_pieces_pass_the_re_measuring(
            stars in prop::collection::vec(prop::collection::vec(1.0..60.0_f64, 5..16), 1..12),
            (kerf, spacing, margin) in (0.0..1.0_f64, 0.01..10.0_f64, 0.0..20.0_f64),
            far in -1e5..1e5_f64,
        ) {
            let corner = |i: usize, n: usize, r: f64| {
                DVec2::from_angle(i as f64 * std::f64::consts::TAU / n as f64) * r + DVec2::splat(far)
            };
            let star = |radii: Vec<f64>| radii.iter().enumerate().map(|(i, &r)| corner(i, radii.len(), r)).collect();
            let [kerf, spacing, margin] = [kerf, spacing, margin].map(Length::from_mm);
            let params = SheetParams { stock: StockParams { kerf, spacing, margin, sheet: SheetSize::of_mm(250.0, 200.0), ..StockParams::default() }, ..Default::default() };
            let set = lay_out(&net_of(stars.into_iter().map(star).collect()), &params);
            prop_assert!(set.is_ok(), "{set:?}");
        }
    }
}
