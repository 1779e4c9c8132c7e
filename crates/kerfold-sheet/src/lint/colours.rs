//! What is done along a line, by its colour, where layers do not tell.

use super::artwork::{ArtPath, Artwork, Operation};
use crate::geom::Grid;
use crate::geom::polygon::bounds;

/// A colour: red, green, blue.
pub type Rgb = [u8; 3];

/// The colours of a drawing, `None` where a layer shows the operation.
#[derive(Debug, Clone, Default)]
pub struct Colours {
    /// Of the paths, in their order.
    pub paths: Vec<Option<Rgb>>,
    /// Of the texts, in their order.
    pub texts: Vec<Option<Rgb>>,
    /// Whether the file says that boxes.py made it.
    pub is_by_boxes: bool,
}

/// How near two ends count as one when chains of red lines are looked for, in mm.
const NEAR: f64 = 0.01;

/// What colours mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Palette {
    /// Everything is cut.
    Any,
    /// Red is cut, blue is scored, black and green are engraved, all else is cut.
    RedCut,
    /// As boxes.py draws: black is cut around parts, blue inside, green and cyan are etched, red is
    /// a note.
    Boxes,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Hue {
    Black,
    Red,
    Green,
    Blue,
    Cyan,
    Other,
}

impl Hue {
    fn of(colour: Rgb) -> Self {
        let is = |want: [bool; 3]| {
            (0..3).all(|i| if want[i] { colour[i] > 200 } else { colour[i] < 60 })
        };
        let rows = [
            ([false; 3], Self::Black),
            ([true, false, false], Self::Red),
            ([false, true, false], Self::Green),
            ([false, false, true], Self::Blue),
            ([false, true, true], Self::Cyan),
        ];
        rows.into_iter().find(|(want, _)| is(*want)).map_or(Self::Other, |(_, hue)| hue)
    }
}

impl Palette {
    fn operation(self, hue: Hue) -> Operation {
        match (self, hue) {
            (Self::RedCut, Hue::Blue) => Operation::Score,
            (Self::RedCut, Hue::Black | Hue::Green) => Operation::Engrave,
            (Self::Boxes, Hue::Black) => Operation::CutOuter,
            (Self::Boxes, Hue::Blue) => Operation::CutInner,
            (Self::Boxes, Hue::Green | Hue::Cyan) => Operation::Engrave,
            (Self::Boxes, Hue::Red) => Operation::Info,
            _ => Operation::Cut,
        }
    }
}

impl Artwork {
    /// Gives every path and text without a telling layer an operation by its colour. Where red is
    /// used, red is cut, blue is scored, black and green are engraved, and everything else is cut.
    /// A drawing in the colours of boxes.py is one that says so, one with black and blue but no
    /// red, or one whose red lines bound nothing and lie among black ones: then black and blue are
    /// cut and red is a note, and the drawing gets a note that says so.
    pub fn operations_by_colour(&mut self, colours: &Colours) {
        let palette = self.palette(colours);
        let of = |colour: Rgb| palette.operation(Hue::of(colour));
        for (path, colour) in self.paths.iter_mut().zip(&colours.paths) {
            path.operation = colour.map_or(path.operation, of);
        }
        for (text, colour) in self.texts.iter_mut().zip(&colours.texts) {
            // A written word is nothing that is cut, whatever its colour; but it may be a note.
            let is_note = colour.map(of) == Some(Operation::Info);
            text.operation = if is_note { Operation::Info } else { text.operation };
        }
        if palette == Palette::Boxes {
            self.notes.push(
                "colours are taken as boxes.py draws them: black and blue are cut, green and cyan \
                etched, red is a note"
                    .to_owned(),
            );
        }
    }

    fn palette(&self, colours: &Colours) -> Palette {
        let hues: Vec<Option<Hue>> = colours.paths.iter().map(|c| c.map(Hue::of)).collect();
        let has = |hue: Hue| hues.contains(&Some(hue));
        let painted = |hue: Hue| -> Vec<&ArtPath> {
            let rows = self.paths.iter().zip(&hues).filter(|(_, h)| **h == Some(hue));
            rows.map(|(path, _)| path).collect()
        };
        let is_boxes = match (has(Hue::Black), has(Hue::Red), has(Hue::Blue)) {
            (true, _, _) if colours.is_by_boxes => true,
            (true, false, true) => true,
            (true, true, _) => are_notes_among(&painted(Hue::Red), &painted(Hue::Black)),
            _ => false,
        };
        match (is_boxes, has(Hue::Red)) {
            (true, _) => Palette::Boxes,
            (false, true) => Palette::RedCut,
            (false, false) => Palette::Any,
        }
    }
}

/// Whether lines bound nothing, neither alone nor as a chain, and lie within the box of others.
fn are_notes_among(lines: &[&ArtPath], others: &[&ArtPath]) -> bool {
    let extent = |paths: &[&ArtPath]| bounds(paths.iter().flat_map(|p| &p.points));
    let (Some(own), Some(around)) = (extent(lines), extent(others)) else { return false };
    let is_within = around.0.cmplt(own.0).all() && around.1.cmpgt(own.1).all();
    is_within && lines.iter().all(|p| !p.closed) && !do_ends_meet(lines)
}

fn do_ends_meet(lines: &[&ArtPath]) -> bool {
    let mut grid = Grid::new([0.0; 2], NEAR);
    let mut ends = Vec::new();
    for path in lines {
        for &end in path.points.first().into_iter().chain(path.points.last()) {
            let is_met = |number: u32| end.distance(ends[number as usize]) <= NEAR;
            if grid.around(end.to_array()).any(is_met) {
                return true;
            }
            grid.insert(end.to_array());
            ends.push(end);
        }
    }
    false
}
