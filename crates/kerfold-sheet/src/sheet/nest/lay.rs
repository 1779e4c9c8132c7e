//! From pieces as they are cut to where they lie, by whichever way the parameters ask for.

use glam::DVec2;

use super::super::bounding_box::{OrientedBox, box_at, fitting_box, rounded};
use super::super::kerf::CutShape;
use super::super::layout::Turn;
use super::super::place::{Item, pack, pack_rows};
use super::guillotine::{Boxed, guillotine};
use super::search::Turns;
use super::shape::Shape;
use super::stock::StockSheet;
use super::{
    Axis, CommonLine, Effort, Guillotine, Lying, NestParams, NoPlace, Piece, Problem, Rotation,
    nest,
};
use crate::geom::polygon::{bounds, convex_hull, signed_area};
use crate::net::PieceId;
use crate::progress::Progress;

/// Work, in parts measured, that an ordinary machine does in a tenth of a second.
const WORK_OF_EFFORT: f64 = 700_000.0;
/// Fewer pieces than this get less.
const FULL_EFFORT_PIECES: f64 = 60.0;
/// Boxes are packed as a start for at most so many pieces.
const MOST_BOXES: usize = 500;

/// Where everything lies, and the cuts from edge to edge of every sheet, if there are any.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Laid {
    pub lying: Vec<Lying>,
    pub cuts: Vec<Vec<[DVec2; 2]>>,
    /// Pieces that were taken for larger than they are, as their lines cross.
    pub widened: Vec<PieceId>,
}

/// A piece with its hull and what is allowed.
#[derive(Debug)]
pub(crate) struct Candidate<'a> {
    pub shape: &'a CutShape,
    pub rotation: Rotation,
    hull: Vec<DVec2>,
    /// On every sheet of the stock, the turn at which it fits best.
    pub poses: Vec<Option<OrientedBox>>,
}

/// Finds out on which sheets pieces fit.
pub(crate) fn candidates<'a>(
    shapes: &'a [CutShape],
    sheets: &[StockSheet],
    params: &NestParams,
) -> Vec<Candidate<'a>> {
    let rotation =
        |piece: PieceId| params.rotate.0.get(&piece).copied().unwrap_or(params.rotations);
    let mut all = Vec::with_capacity(shapes.len());
    for shape in shapes {
        let (rotation, hull) = (rotation(shape.piece), convex_hull(&shape.outline));
        let mut poses: Vec<Option<OrientedBox>> = Vec::with_capacity(sheets.len());
        for (i, sheet) in sheets.iter().enumerate() {
            // Sheets of one kind stand together.
            let same = i > 0
                && sheets[i - 1].stock == sheet.stock
                && sheets[i - 1].outline == sheet.outline;
            let found = if same { poses[i - 1] } else { pose(&hull, rotation, sheet) };
            poses.push(found);
        }
        all.push(Candidate { shape, rotation, hull, poses });
    }
    all
}

fn pose(hull: &[DVec2], rotation: Rotation, sheet: &StockSheet) -> Option<OrientedBox> {
    let bin = sheet.bin();
    let (room, rounding) = (bin.high - bin.low, sheet.stock.rounding());
    let fits = |b: &OrientedBox| b.width <= room.x + rounding && b.height <= room.y + rounding;
    match rotation.angles() {
        None => fitting_box(hull, room, rounding),
        Some(angles) => angles.into_iter().map(|a| box_at(hull, a)).find(fits),
    }
}

/// Lays all pieces; each must fit on some sheet.
pub(crate) fn lay(
    candidates: &[Candidate<'_>],
    sheets: &[StockSheet],
    params: &NestParams,
    progress: &dyn Progress,
) -> Result<Laid, NoPlace> {
    let effort = f64::from(params.nest_effort) * WORK_OF_EFFORT;
    let share = ((candidates.len() as f64 + 5.0) / FULL_EFFORT_PIECES).min(1.0);
    let effort = Effort { seed: params.nest_seed, work: (effort * share) as u64 };
    if params.guillotine == Guillotine::On {
        return by_guillotine(candidates, sheets, effort, progress);
    }
    let is_plain =
        sheets.len() == 1 && sheets[0].bin().obstacles.is_empty() && params.together.0.is_empty();
    if is_plain && params.nest_effort == 0 && params.common_line == CommonLine::Off {
        return Ok(Laid { lying: boxes(candidates, &sheets[0], pack_rows), ..Laid::default() });
    }
    let group =
        |piece: PieceId| params.together.0.iter().position(|g| g.len() > 1 && g.contains(&piece));
    let least = Least::of(candidates, sheets[0].stock.spacing);
    let pieces = candidates.iter().map(|c| Piece {
        shape: Shape::new(&c.shape.outline, &least.holes_with_room(c.shape)),
        turns: match c.rotation.angles() {
            Some(angles) => Turns::Some(angles),
            None => {
                Turns::Free { home: c.poses.iter().rev().flatten().next().map_or(0.0, |p| p.angle) }
            }
        },
        group: group(c.shape.piece),
        fits: c.poses.iter().map(Option::is_some).collect(),
    });
    let problem = Problem {
        pieces: pieces.collect(),
        stock: sheets.iter().map(StockSheet::bin).collect(),
        spacing: sheets[0].stock.spacing,
        common_line: params.common_line,
    };
    let start =
        (is_plain && candidates.len() <= MOST_BOXES).then(|| boxes(candidates, &sheets[0], pack));
    let lies_wide = |(_, piece): &(&Candidate<'_>, &Piece)| !piece.shape.is_exact;
    let widened = candidates.iter().zip(&problem.pieces).filter(lies_wide);
    let widened = widened.map(|(c, _)| c.shape.piece).collect();
    Ok(Laid { lying: nest(&problem, start, effort, progress)?, widened, ..Laid::default() })
}

/// What a hole must have at least, or no piece can lie in it.
struct Least {
    area: f64,
    diameter: f64,
}

impl Least {
    fn of(candidates: &[Candidate<'_>], spacing: f64) -> Self {
        let areas = candidates.iter().map(|c| c.shape.area());
        let extents = candidates.iter().filter_map(|c| bounds(&c.hull));
        let diameters = extents.map(|(low, high)| (high - low).max_element());
        Self {
            area: areas.fold(f64::INFINITY, f64::min),
            // A piece is as wide as its hull one way or the other, and keeps the spacing.
            diameter: diameters.fold(f64::INFINITY, f64::min) + 2.0 * spacing,
        }
    }

    /// The holes of a piece in which another might lie. All others count as material: thousands of
    /// stitch holes would only cost time.
    fn holes_with_room(&self, shape: &CutShape) -> Vec<Vec<DVec2>> {
        let has_room = |hole: &&Vec<DVec2>| {
            let (low, high) = bounds(hole.iter()).unwrap_or_default();
            signed_area(hole).abs() >= self.area && low.distance(high) >= self.diameter
        };
        shape.holes.iter().filter(has_room).cloned().collect()
    }
}

/// A layout of bounding boxes.
fn boxes(
    candidates: &[Candidate<'_>],
    sheet: &StockSheet,
    pack: impl Fn(&[Item], DVec2) -> Vec<super::super::place::Spot>,
) -> Vec<Lying> {
    let stock = &sheet.stock;
    let poses: Vec<OrientedBox> = candidates.iter().filter_map(|c| c.poses[0]).collect();
    // A box with the spacing on two sides, in a room with the spacing on two sides: neighbours keep
    // their distance.
    let room = stock.usable() + DVec2::splat(stock.spacing);
    let item = |(c, p): (&Candidate<'_>, &OrientedBox)| {
        let grown = DVec2::new(p.width, p.height) + DVec2::splat(stock.spacing);
        // A box that touches the room may be larger by rounding.
        let fit = |size: DVec2| {
            (size - DVec2::splat(stock.rounding())).cmple(room).all().then(|| size.min(room))
        };
        let may_turn = c.rotation.allows(p.angle + 90.0);
        Item { upright: fit(grown), turned: fit(DVec2::new(grown.y, grown.x)).filter(|_| may_turn) }
    };
    let spots = pack(&candidates.iter().zip(&poses).map(item).collect::<Vec<_>>(), room);
    let lying = |((c, pose), spot): ((&Candidate<'_>, &OrientedBox), super::super::place::Spot)| {
        let angle = rounded(pose.angle + if spot.turned { 90.0 } else { 0.0 });
        Lying {
            bin: spot.bin,
            angle,
            at: put_low(&c.shape.outline, angle, spot.low + DVec2::splat(stock.margin)),
        }
    };
    candidates.iter().zip(&poses).zip(spots).map(lying).collect()
}

/// Where the frame of an outline lands when its turned box has its lower left corner at `low`.
fn put_low(outline: &[DVec2], angle: f64, low: DVec2) -> DVec2 {
    let turn = Turn::degrees(angle);
    let turned: Vec<DVec2> = outline.iter().map(|&p| turn.apply(p)).collect();
    low - bounds(&turned).unwrap_or_default().0
}

fn by_guillotine(
    candidates: &[Candidate<'_>],
    sheets: &[StockSheet],
    effort: Effort,
    progress: &dyn Progress,
) -> Result<Laid, NoPlace> {
    let boxed = |c: &Candidate<'_>| {
        let angles = match c.rotation.angles() {
            Some(angles) => angles,
            None => {
                let mut angles: Vec<f64> =
                    c.poses.iter().flatten().flat_map(|p| [p.angle, p.angle + 90.0]).collect();
                angles.sort_by(f64::total_cmp);
                angles.dedup();
                angles
            }
        };
        let ways = angles.into_iter().map(|a| {
            let b = box_at(&c.hull, a);
            (a, DVec2::new(b.width, b.height) + DVec2::splat(sheets[0].stock.spacing))
        });
        Boxed { ways: ways.collect() }
    };
    let boxed: Vec<Boxed> = candidates.iter().map(boxed).collect();
    let (places, cuts) = guillotine(&boxed, sheets, effort, progress)?;
    let lying = candidates.iter().zip(places).map(|(c, place)| {
        let angle = rounded(place.angle.rem_euclid(360.0));
        Lying { bin: place.bin, angle, at: put_low(&c.shape.outline, angle, place.low) }
    });
    Ok(Laid { lying: lying.collect(), cuts, ..Laid::default() })
}

/// The part of the last sheet that is left whole: from the furthest cut and the spacing on to the
/// edge.
pub(crate) fn offcut(size: DVec2, used: DVec2, spacing: f64) -> Option<[DVec2; 2]> {
    let axis = if size.x >= size.y { Axis::X } else { Axis::Y };
    let from = axis.of(used) + spacing;
    let low = axis.with(DVec2::ZERO, from);
    (axis.of(size) - from >= 0.05 * axis.of(size)).then_some([low, size])
}
