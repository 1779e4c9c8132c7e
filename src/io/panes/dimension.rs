//! The dimensions of a pane: sides with their mitres, angles, diagonals, holes.

use glam::DVec2;

use super::Place;
use super::shape::{Pen, Shape, words, words_from};
use crate::geom::polygon::signed_area;
use crate::panel::{PanelRow, Plate};

/// Height of the figures, in mm of paper.
const FIGURES: f64 = 2.5;

/// From a side to its dimension line, in mm of paper.
const OFFSET: f64 = 9.0;

/// Half the length of the slanted stroke at the ends of a dimension line, in mm of paper.
const TICK: f64 = 1.2;

/// Holes that get their places in figures; more are told by their number alone.
const PLACED_HOLES: usize = 8;

/// Mitres nearer to square than this are square, in degrees.
const SQUARE: f64 = 0.01;

pub(super) fn dimensions(row: &PanelRow, plate: &Plate, place: &Place) -> Vec<Shape> {
    let mut shapes = Vec::new();
    let corners: Vec<DVec2> = plate.begins.iter().map(|&i| place.at(plate.front[i])).collect();
    for i in 0..plate.begins.len() {
        shapes.extend(side(row, plate, place, i));
    }
    shapes.extend(angles(row, &corners));
    shapes.extend(diagonals(plate, place));
    shapes.extend(holes(plate, place));
    shapes
}

/// A length for people: tenths of a millimetre.
pub(super) fn tenths(mm: f64) -> String {
    let text = format!("{mm:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// The dimension line of a side with its length, and its mitre beyond.
fn side(row: &PanelRow, plate: &Plate, place: &Place, i: usize) -> Vec<Shape> {
    let ends = plate.front_side(i);
    let [a, b] = ends.map(|p| place.at(p));
    let along = (b - a).normalize_or(DVec2::X);
    // Sides run counter-clockwise: outside is on their right.
    let outwards = -along.perp();
    let [p, q] = [a, b].map(|end| end + outwards * OFFSET);
    let mut shapes = vec![Shape::line(Pen::Dimension, [p, q])];
    for (end, on_line) in [(a, p), (b, q)] {
        let from = end + outwards;
        shapes.push(Shape::line(Pen::Dimension, [from, on_line + outwards * TICK]));
        let slant = (along + along.perp()) * (TICK / 2.0);
        shapes.push(Shape::line(Pen::Dimension, [on_line - slant, on_line + slant]));
    }
    let middle = p.midpoint(q);
    let length = tenths(ends[0].distance(ends[1]));
    shapes.extend(words(&length, middle + outwards * (0.9 * FIGURES), along, FIGURES));
    let bevel = row.bevels.get(i).copied().unwrap_or_default();
    let cut =
        if bevel.abs() < SQUARE { "SQUARE".to_owned() } else { format!("{bevel:.1}° OFF SQUARE") };
    let edge = row.edges.get(i).map(|e| format!("E{:03}  ", e.index())).unwrap_or_default();
    let beyond = middle + outwards * (2.6 * FIGURES);
    shapes.extend(words(&(edge + &cut), beyond, along, 0.8 * FIGURES));
    shapes
}

/// The angle at every corner, inside.
fn angles(row: &PanelRow, corners: &[DVec2]) -> Vec<Shape> {
    let n = corners.len();
    let is_turned = signed_area(corners) < 0.0;
    let at = |i: usize| {
        let (before, here, after) = (corners[(i + n - 1) % n], corners[i], corners[(i + 1) % n]);
        let [u, v] = [before - here, after - here].map(|d| d.normalize_or_zero());
        let turns_in = (here - before).perp_dot(after - here) >= 0.0;
        let bisector = (u + v).normalize_or((after - here).perp().normalize_or_zero());
        let inwards = if turns_in != is_turned { bisector } else { -bisector };
        // Sharp corners have no room at their tip.
        let half = (row.angles.get(i).copied().unwrap_or(90.0) / 2.0).to_radians();
        // The words lie level, about six times as long as high.
        let room = FIGURES * (2.6 * inwards.x.abs() + 0.8 * inwards.y.abs());
        let depth = ((0.6 * FIGURES + room) / half.sin().max(0.2)).min(10.0 * FIGURES);
        let text = format!("{:.1}°", row.angles.get(i).copied().unwrap_or_default());
        words(&text, here + inwards * depth, DVec2::X, 0.8 * FIGURES)
    };
    (0..n).flat_map(at).collect()
}

/// Both diagonals of a quadrilateral; of other polygons those from the first corner, which fix the
/// shape.
fn diagonals(plate: &Plate, place: &Place) -> Vec<Shape> {
    let corners: Vec<DVec2> = plate.begins.iter().map(|&i| plate.front[i]).collect();
    let n = corners.len();
    let pairs: Vec<(usize, usize)> = match n {
        4 => vec![(0, 2), (1, 3)],
        _ => (2..n.saturating_sub(1)).map(|i| (0, i)).collect(),
    };
    let mut shapes = Vec::new();
    for (i, j) in pairs {
        let [a, b] = [corners[i], corners[j]].map(|p| place.at(p));
        let along = (b - a).normalize_or(DVec2::X);
        shapes.extend(dashes(a, b));
        // Away from the middle, where diagonals cross.
        let at = a.lerp(b, 0.62) + along.perp() * (0.9 * FIGURES);
        let length = tenths(corners[i].distance(corners[j]));
        shapes.extend(words(&length, at, along, FIGURES));
    }
    shapes
}

/// A dashed line, its dashes drawn one by one.
fn dashes(a: DVec2, b: DVec2) -> Vec<Shape> {
    let count = (a.distance(b) / 6.0).ceil().max(1.0);
    let at = |t: f64| a.lerp(b, t / count);
    (0..count as usize)
        .map(|i| Shape::line(Pen::Dimension, [at(i as f64), at(i as f64 + 0.6)]))
        .collect()
}

/// A cross in every hole, and its diameter and place from the left end of the bottom side, in mm.
fn holes(plate: &Plate, place: &Place) -> Vec<Shape> {
    let mut shapes = Vec::new();
    for hole in &plate.holes {
        let centre = place.at(hole.centre);
        let reach = hole.radius / place.scale + 1.0;
        for arm in [DVec2::X, DVec2::Y] {
            shapes.push(Shape::line(Pen::Dimension, [centre - arm * reach, centre + arm * reach]));
        }
        if plate.holes.len() <= PLACED_HOLES {
            let from = place.turn.rotate(hole.centre - place.origin);
            let [x, y] = from.to_array().map(tenths);
            let text = format!("Ø{} X{x} Y{y}", tenths(2.0 * hole.radius));
            let at = centre + DVec2::new(reach + 0.5, 0.5);
            shapes.extend(words_from(&text, at, 0.8 * FIGURES));
        }
    }
    shapes
}
