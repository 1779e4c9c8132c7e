//! Where lettering goes: names in the widest face of a piece, seam numbers along the edges, always
//! inside one face.
//!
//! A text that lies inside one face crosses neither a cut nor a fold. What does not fit at the
//! least height is left out and counted: lettering that nobody can read only costs time on the
//! machine.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use glam::DVec2;

use super::glyph::{Lettering, lettering};
use super::obstacle::{Obstacle, Obstacles, is_clear};
use crate::geom::polygon::{Location, borders_meet, bounds, centroid, locate, signed_area};
use crate::net::{FlatFace, Piece, Segment};
use crate::sheet::distance::{distance_to_contour, edges};
use crate::sheet::error::SheetError;

/// Height of a seam's number on a sheet of [`USUAL_SHEET`], in mm; never more than
/// [`NUMBER_SHARE`] of its edge or stretch.
const NUMBER_HEIGHT: f64 = 4.0;

/// The longer side of the sheet on which numbers have [`NUMBER_HEIGHT`], in mm.
const USUAL_SHEET: f64 = 600.0;

/// How letters grow with the sheet: 2.5 mm on A4, which is read in the hand, 20 mm on 6 m of glass,
/// which is read from some metres away.
const GROWTH: f64 = 0.7;

/// Least height of a number where there is room, in mm.
const LEAST_NUMBER: f64 = 2.5;

/// Height of a piece's name relative to that of numbers.
const NAME_SHARE: f64 = 1.5;

/// Largest height of a number relative to its edge or stretch.
const NUMBER_SHARE: f64 = 0.35;

/// Least height that can be read off card, in mm.
const LEAST_HEIGHT: f64 = 1.5;

/// From one height that is tried to the next.
const SMALLER: f64 = 0.8;

/// Free space around a text, relative to its height.
const CLEAR: f64 = 0.25;

/// Faces of a piece that are tried for its name, largest first.
const FACES_TRIED: usize = 8;

/// A text in the piece's frame.
#[derive(Debug, Clone)]
pub(super) struct Label {
    pub strokes: Vec<Vec<DVec2>>,
    /// The box of the strokes with free space around, counter-clockwise.
    pub frame: [DVec2; 4],
    pub height: f64,
}

/// The height of numbers that suits a sheet, in mm.
pub(in crate::sheet) fn sheet_letter(sheet: DVec2) -> f64 {
    let growth = (sheet.max_element() / USUAL_SHEET).powf(GROWTH);
    (NUMBER_HEIGHT * growth).max(LEAST_NUMBER)
}

/// What a label in a face must keep clear of, and how large it may be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room<'a> {
    /// Frames of other labels.
    pub taken: &'a [[DVec2; 4]],
    /// Contours of joints.
    pub obstacles: Obstacles<'a>,
    /// Largest height, in mm: what suits the sheet and the length that it stands for.
    pub letter: f64,
}

/// The height of a number that suits the sheet, and the edge or stretch that it stands for.
pub(super) fn suited(letter: f64, length: f64) -> f64 {
    letter.min(NUMBER_SHARE * length)
}

/// What is already lettered on the faces of a piece, by their index.
pub(super) type Taken = BTreeMap<usize, Vec<[DVec2; 4]>>;

/// The name of a piece, as large as fits beside what is taken, reading along `upright` where
/// possible and else along a face's longest edge; with the index of the face that holds it.
/// Obstacles are those near each of the faces.
pub(super) fn name_label(
    piece: &Piece,
    upright: DVec2,
    taken: &Taken,
    (obstacles, letter): (&[Vec<Obstacle>], f64),
) -> Result<Option<(usize, Label)>, SheetError> {
    let text = piece.id.to_string();
    let largest = NAME_SHARE * letter;
    let mut order: Vec<(f64, usize)> =
        piece.faces.iter().enumerate().map(|(i, f)| (signed_area(&f.polygon), i)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut best: Option<(usize, Label)> = None;
    for &(_, i) in order.iter().take(FACES_TRIED) {
        let polygon = &piece.faces[i].polygon;
        let obstacles = obstacles.get(i).map_or(&[][..], Vec::as_slice);
        let centres = Centres::of(polygon, obstacles);
        for direction in [upright, along_longest_edge(polygon, upright)] {
            let beaten = best.as_ref().map_or(0.0, |(_, b)| b.height);
            let free = |frame: &[DVec2; 4]| {
                is_free(polygon, frame, taken.get(&i).map_or(&[], Vec::as_slice))
                    && is_clear(frame, obstacles)
            };
            if let Some(label) = largest_name(&text, &centres, direction, [beaten, largest], free)?
            {
                best = Some((i, label));
            }
        }
        if best.as_ref().is_some_and(|(_, b)| b.height >= largest) {
            break;
        }
    }
    Ok(best)
}

/// Where the middle of a name is tried, one place after the other: most names fit the first, and the
/// others cost more than all the rest of the lettering.
struct Centres<'a> {
    polygon: &'a [DVec2],
    obstacles: Obstacles<'a>,
    inner: [OnceCell<DVec2>; 2],
}

impl<'a> Centres<'a> {
    fn of(polygon: &'a [DVec2], obstacles: Obstacles<'a>) -> Self {
        Self { polygon, obstacles, inner: Default::default() }
    }

    fn all(&self) -> impl Iterator<Item = DVec2> + '_ {
        let inner = |i: usize| {
            let obstacles = if i == 0 { &[] } else { self.obstacles };
            *self.inner[i].get_or_init(|| inner_point(self.polygon, obstacles))
        };
        let count = if self.obstacles.is_empty() { 1 } else { 2 };
        std::iter::once_with(|| centroid(self.polygon)).chain((0..count).map(inner))
    }
}

/// The largest text higher than `beaten`, and not above `largest`, that is free at one of the places.
fn largest_name(
    text: &str,
    centres: &Centres<'_>,
    direction: DVec2,
    [beaten, largest]: [f64; 2],
    is_free: impl Fn(&[DVec2; 4]) -> bool,
) -> Result<Option<Label>, SheetError> {
    for height in heights(largest).take_while(|&h| h > beaten) {
        let line = Line::new(text, height)?;
        for centre in centres.all() {
            let place = Place { centre, direction };
            if is_free(&line.frame(place)) {
                return Ok(Some(line.label(place, &[])));
            }
        }
    }
    Ok(None)
}

/// The number of a seam inside `face`, parallel to its edge, to be read from the middle of the
/// face: its head is at the edge. `edge` are the mesh's vertices at the two ends of `segment`.
/// Keeps clear of what the room holds.
pub(super) fn number_label(
    text: &str,
    face: &FlatFace,
    edge: [usize; 2],
    segment: Segment,
    room: Room<'_>,
) -> Result<Option<Label>, SheetError> {
    let Some([a, b]) = face.side(edge, segment) else { return Ok(None) };
    beside(text, face, [a, b], -(b - a).normalize_or_zero(), room)
}

/// As [`number_label`] across the edge, for narrow faces: it reads away from the edge.
pub(super) fn number_across(
    text: &str,
    face: &FlatFace,
    edge: [usize; 2],
    segment: Segment,
    room: Room<'_>,
) -> Result<Option<Label>, SheetError> {
    let Some([a, b]) = face.side(edge, segment) else { return Ok(None) };
    beside(text, face, [a, b], (b - a).normalize_or_zero().perp(), room)
}

/// A text that reads along `reading` as near as possible to an edge that has the face on its left.
fn beside(
    text: &str,
    face: &FlatFace,
    [a, b]: Segment,
    reading: DVec2,
    room: Room<'_>,
) -> Result<Option<Label>, SheetError> {
    let Room { taken, obstacles, letter } = room;
    let inwards = (b - a).normalize_or_zero().perp();
    for height in heights(letter) {
        let line = Line::new(text, height)?;
        for t in [0.5, 0.38, 0.62, 0.26, 0.74] {
            let place = Place { centre: a.lerp(b, t), direction: reading };
            let mut frame = line.frame(place);
            // The face lies on the left of its edges; the frame goes there until it is clear of the
            // edge.
            let reach = frame.iter().map(|&p| (p - a).dot(inwards)).fold(f64::INFINITY, f64::min);
            let mut moves = vec![inwards * (CLEAR * height - reach)];
            frame = frame.map(|p| p + moves[0]);
            // Notches and holes of a joint lie along the edge: further in it may be free.
            let tries = if obstacles.is_empty() { 1 } else { 8 };
            for _ in 0..tries {
                if is_free(&face.polygon, &frame, taken) && is_clear(&frame, obstacles) {
                    return Ok(Some(line.label(place, &moves)));
                }
                let further = inwards * (0.5 * height);
                moves.push(further);
                frame = frame.map(|p| p + further);
            }
        }
    }
    Ok(None)
}

fn heights(largest: f64) -> impl Iterator<Item = f64> {
    std::iter::successors(Some(largest), |h| Some(h * SMALLER)).take_while(|&h| h >= LEAST_HEIGHT)
}

/// Where the middle of a text's box is, and along which unit vector it reads.
#[derive(Clone, Copy)]
struct Place {
    centre: DVec2,
    direction: DVec2,
}

/// A text of one height, before it is known where it can lie: many places are tried by its frame, and
/// its strokes are put to one.
struct Line {
    letters: Lettering,
    height: f64,
}

impl Line {
    fn new(text: &str, height: f64) -> Result<Self, SheetError> {
        Ok(Self { letters: lettering(text, height)?, height })
    }

    fn put(&self, Place { centre, direction }: Place, p: DVec2) -> DVec2 {
        let middle = self.letters.low.midpoint(self.letters.high);
        centre + direction.rotate(p - middle)
    }

    fn frame(&self, place: Place) -> [DVec2; 4] {
        let clear = DVec2::splat(CLEAR * self.height);
        let (low, high) = (self.letters.low - clear, self.letters.high + clear);
        let corners = [low, DVec2::new(high.x, low.y), high, DVec2::new(low.x, high.y)];
        corners.map(|p| self.put(place, p))
    }

    /// The label at a place, moved from there step by step.
    fn label(&self, place: Place, moves: &[DVec2]) -> Label {
        let moved = |p: DVec2| moves.iter().fold(p, |p, by| p + *by);
        let stroke = |s: &Vec<DVec2>| s.iter().map(|&p| moved(self.put(place, p))).collect();
        let strokes = self.letters.strokes.iter().map(stroke).collect();
        Label { strokes, frame: self.frame(place).map(moved), height: self.height }
    }
}

/// Along the longest edge of a polygon, not upside down with respect to `upright`.
fn along_longest_edge(polygon: &[DVec2], upright: DVec2) -> DVec2 {
    let longest = edges(polygon)
        .map(|(a, b)| b - a)
        .reduce(|l, e| if e.length() > l.length() { e } else { l });
    let direction = longest.unwrap_or(upright).normalize_or(upright);
    if direction.dot(upright) < 0.0 { -direction } else { direction }
}

/// A point far inside a polygon and from obstacles: the best of a grid, the centroid and the ears,
/// then improved step by step.
fn inner_point(polygon: &[DVec2], obstacles: Obstacles<'_>) -> DVec2 {
    const GRID: usize = 12;
    let Some((low, high)) = bounds(polygon) else { return DVec2::ZERO };
    let n = polygon.len();
    let depth = |p: DVec2| {
        if locate(polygon, p) != Location::Inside || !obstacles.iter().all(|o| o.has_material(p)) {
            return -1.0;
        }
        let own = distance_to_contour(p, polygon);
        obstacles.iter().fold(own, |least, obstacle| obstacle.distance_below(p, least))
    };
    let cell = (high - low) / GRID as f64;
    let on_grid = |i: usize| low + cell * (DVec2::new((i % GRID) as f64, (i / GRID) as f64) + 0.5);
    let ears = (0..n).map(|i| (polygon[i] + polygon[(i + 1) % n] + polygon[(i + 2) % n]) / 3.0);
    let candidates = (0..GRID * GRID).map(on_grid).chain(ears).chain([centroid(polygon)]);
    let deeper = |best: (f64, DVec2), p: DVec2| {
        let here = depth(p);
        if here > best.0 { (here, p) } else { best }
    };
    let mut best = candidates.fold((-1.0, low), deeper);
    let mut step = cell;
    for _ in 0..16 {
        let around = (0..8)
            .map(|k| best.1 + step * DVec2::from_angle(f64::from(k) * std::f64::consts::FRAC_PI_4));
        let found = around.fold(best, deeper);
        step = if found.0 > best.0 { step } else { step / 2.0 };
        best = found;
    }
    best.1
}

/// Whether a frame lies inside a face and on nothing else.
fn is_free(polygon: &[DVec2], frame: &[DVec2; 4], taken: &[[DVec2; 4]]) -> bool {
    taken.iter().all(|other| !overlap(other, frame)) && frame_inside(polygon, frame)
}

/// Whether a convex frame lies in the interior of a polygon, exactly.
fn frame_inside(polygon: &[DVec2], frame: &[DVec2; 4]) -> bool {
    frame.iter().all(|&p| locate(polygon, p) == Location::Inside) && !borders_meet(polygon, frame)
}

fn overlap(a: &[DVec2; 4], b: &[DVec2; 4]) -> bool {
    borders_meet(a, b)
        || locate(a, b[0]) != Location::Outside
        || locate(b, a[0]) != Location::Outside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::polygon::segments_meet;
    use crate::net::PieceId;
    use crate::sheet::testing::{ell, piece, points, ring, square};

    fn far_away() -> Label {
        let place = Place { centre: DVec2::splat(30.0), direction: DVec2::X };
        Line::new("1", 3.0).expect("a letter").label(place, &[])
    }

    fn room<'a>(taken: &'a [[DVec2; 4]], obstacles: Obstacles<'a>) -> Room<'a> {
        Room { taken, obstacles, letter: NUMBER_HEIGHT }
    }

    #[test]
    fn numbers_suit_what_they_stand_for() {
        assert_eq!((suited(4.0, 100.0), suited(4.0, 10.0)), (4.0, 3.5));
    }

    #[test]
    fn letters_suit_the_sheet() {
        let on = |x: f64, y: f64| sheet_letter(DVec2::new(x, y));
        assert_eq!((on(210.0, 297.0), on(600.0, 400.0)), (2.5, 4.0));
        assert!((on(6000.0, 3210.0) - 20.0).abs() < 0.1, "{}", on(6000.0, 3210.0));
        assert!(on(1220.0, 2440.0) > 10.0 && on(50.0, 50.0) == 2.5);
    }

    fn obstacles<const N: usize>(contours: [Vec<DVec2>; N]) -> Vec<Obstacle> {
        contours.iter().filter_map(|contour| Obstacle::of(contour)).collect()
    }

    fn assert_clear(piece: &Piece, label: &Label) {
        for stroke in &label.strokes {
            for w in stroke.windows(2) {
                assert_eq!(locate(&piece.outline, w[0]), Location::Inside);
                for contour in std::iter::once(&piece.outline).chain(&piece.holes) {
                    assert!(edges(contour).all(|(a, b)| !segments_meet(a, b, w[0], w[1])));
                }
                assert!(piece.holes.iter().all(|h| locate(h, w[0]) == Location::Outside));
            }
        }
    }

    #[test]
    fn names_lie_inside_squares_ells_rings_and_slivers() {
        let sliver = points([(0.0, 0.0), (90.0, 60.0), (86.0, 62.0)]);
        let ring = ring(PieceId(7));
        for piece in [
            piece(PieceId(0), square(30.0)),
            piece(PieceId(1), ell()),
            piece(PieceId(2), sliver),
            ring,
        ] {
            let (_, label) = name_label(&piece, DVec2::X, &Taken::new(), (&[], NUMBER_HEIGHT))
                .expect("known letters")
                .expect("room for a name");
            assert!(label.height >= LEAST_HEIGHT);
            assert_clear(&piece, &label);
        }
        let tiny = piece(PieceId(0), square(4.0));
        assert!(
            name_label(&tiny, DVec2::X, &Taken::new(), (&[], NUMBER_HEIGHT))
                .expect("known letters")
                .is_none()
        );
    }

    #[test]
    fn the_name_of_a_frame_lies_beside_its_hole() {
        let hole: Vec<DVec2> =
            square(80.0).into_iter().rev().map(|p| p + DVec2::splat(20.0)).collect();
        let mut frame = piece(PieceId(0), square(120.0));
        frame.holes = vec![hole.clone()];
        let contours = [square(120.0), hole];
        let near = [obstacles(contours)];
        let (_, label) = name_label(&frame, DVec2::X, &Taken::new(), (&near, NUMBER_HEIGHT))
            .expect("letters")
            .expect("room");
        assert_clear(&frame, &label);
        assert_eq!(label.height, NAME_SHARE * NUMBER_HEIGHT);
    }

    #[test]
    fn a_large_square_gets_the_full_height_upright() {
        let (_, label) = name_label(
            &piece(PieceId(0), square(50.0)),
            DVec2::Y,
            &Taken::new(),
            (&[], NUMBER_HEIGHT),
        )
        .expect("letters")
        .expect("room");
        assert_eq!(label.height, NAME_SHARE * NUMBER_HEIGHT);
        let reading = (label.frame[1] - label.frame[0]).normalize();
        assert!(reading.distance(DVec2::Y) < 1e-12);
    }

    #[test]
    fn numbers_stand_inside_their_edge_with_the_head_to_it() {
        let piece = piece(PieceId(0), square(30.0));
        let face = &piece.faces[0];
        for (edge, segment) in [
            ([0, 1], [piece.outline[0], piece.outline[1]]),
            ([1, 0], [piece.outline[1], piece.outline[0]]),
        ] {
            let label = number_label("12", face, edge, segment, room(&[], &[]))
                .expect("letters")
                .expect("room");
            assert_clear(&piece, &label);
            // The lower edge: reading from the middle, right is left.
            assert!((label.frame[1] - label.frame[0]).normalize().distance(-DVec2::X) < 1e-12);
            assert!(label.frame[2].y < label.frame[1].y && label.frame[2].y > 0.0);
            assert!(label.frame[1].y < 10.0);
        }
        let segment = [piece.outline[0], piece.outline[1]];
        assert!(
            number_label("12", face, [0, 2], segment, room(&[], &[])).expect("letters").is_none()
        );
    }

    #[test]
    fn nothing_is_lettered_into_what_is_cut_away() {
        let piece = piece(PieceId(0), square(60.0));
        let segment = [piece.outline[0], piece.outline[1]];
        // A notch from the lower edge, wide and deep enough for a number.
        let notch = [(20.0, 0.0), (20.0, 12.0), (40.0, 12.0), (40.0, 0.0)];
        let cut =
            [vec![DVec2::ZERO], points(notch), points([(60.0, 0.0), (60.0, 60.0), (0.0, 60.0)])]
                .concat();
        let cuts = obstacles([cut.clone()]);
        let label = number_label("12", &piece.faces[0], [0, 1], segment, room(&[], &cuts));
        let label = label.expect("letters").expect("room beside or behind the notch");
        let in_notch = label.frame.iter().all(|p| locate(&points(notch), *p) == Location::Inside);
        assert!(
            !in_notch && label.frame.iter().all(|p| locate(&cut, *p) == Location::Inside),
            "{:?}",
            label.frame
        );
        let hole = points([(10.0, 10.0), (10.0, 50.0), (50.0, 50.0), (50.0, 10.0)]);
        assert!(!is_clear(&far_away().frame, &obstacles([square(60.0), hole])));
        let slit = points([(0.0, 50.0), (60.0, 50.0)]);
        let label = far_away();
        assert!(is_clear(&label.frame, &obstacles([slit])));
    }

    #[test]
    fn a_taken_place_is_avoided_and_a_short_edge_gets_no_number() {
        let piece = piece(PieceId(0), square(60.0));
        let segment = [piece.outline[0], piece.outline[1]];
        let first = number_label("12", &piece.faces[0], [0, 1], segment, room(&[], &[]))
            .expect("letters")
            .expect("room");
        let second =
            number_label("13", &piece.faces[0], [0, 1], segment, room(&[first.frame], &[]))
                .expect("letters")
                .expect("room");
        assert!(!overlap(&first.frame, &second.frame));
        let small = self::piece(PieceId(0), square(3.0));
        let segment = [small.outline[0], small.outline[1]];
        let low = Room { letter: suited(NUMBER_HEIGHT, 3.0), ..room(&[], &[]) };
        assert!(
            number_label("12", &small.faces[0], [0, 1], segment, low).expect("letters").is_none()
        );
    }
}
