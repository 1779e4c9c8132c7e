//! The lettering of one piece: its name, the numbers of its seams with marks, the angles of its
//! folds.

use std::collections::BTreeMap;

use glam::DVec2;

use super::label::{Label, Room, Taken, name_label, number_across, number_label, suited};
use super::obstacle::{Obstacle, is_clear, obstacles_near};
use super::params::{Angles, Labels, LetterParams};
use crate::geom::polygon::{Location, locate};
use crate::net::{FlatFace, FoldKind, Net, Piece, Seam};
use crate::sheet::drawing::{Drawing, MarkKind, Stroke};
use crate::sheet::error::SheetError;
use crate::sheet::features::Features;
use crate::sheet::layout::{Placed, SheetReport};
use crate::sheet::stretch::Stretch;

/// What is lettered first and so gets the best place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Order {
    NameFirst,
    NumbersFirst,
}

/// The lettering of one piece.
#[derive(Default)]
struct Lettered {
    labels: Vec<(MarkKind, String, Label)>,
    taken: Taken,
    named: bool,
    unnumbered: usize,
    unmarked_angles: usize,
}

/// Letters one piece.
pub(crate) struct PieceLettering<'a> {
    net: &'a Net,
    piece: &'a Piece,
    here: &'a Features<'a>,
    placed: &'a Placed,
    /// For each face what its labels must keep clear of.
    obstacles: Vec<Vec<Obstacle>>,
    params: LetterParams,
    /// Height of numbers that suits the sheet, in mm.
    letter: f64,
}

/// How much larger a number must be to stand farther from the middle of its stretch.
const WORTH: f64 = 1.3;

/// Length of the mark at the end of a stretch, and how far from the edge it begins, in mm.
const MARK: [f64; 2] = [2.0, 0.4];

impl<'a> PieceLettering<'a> {
    /// Obstacles are contours that labels keep clear of, in the frame of the piece.
    pub fn new(
        net: &'a Net,
        (piece, here, placed): (&'a Piece, &'a Features<'a>, &'a Placed),
        obstacles: &[Vec<DVec2>],
        (params, letter): (LetterParams, f64),
    ) -> Self {
        let obstacles: Vec<Obstacle> = obstacles.iter().filter_map(|o| Obstacle::of(o)).collect();
        let near = |face: &FlatFace| obstacles_near(&face.polygon, &obstacles);
        let obstacles = piece.faces.iter().map(near).collect();
        Self { net, piece, here, placed, obstacles, params, letter }
    }

    /// Draws what there is room for, and counts the rest in the report.
    pub fn draw(&self, drawing: &mut Drawing, report: &mut SheetReport) -> Result<(), SheetError> {
        let mut lettered = self.letter(Order::NameFirst)?;
        if lettered.unnumbered > 0 {
            // A seam without its number is the greater loss: the name makes room.
            let other = self.letter(Order::NumbersFirst)?;
            lettered = if other.unnumbered < lettered.unnumbered { other } else { lettered };
        }
        if !lettered.named && self.params.labels != Labels::None {
            report.unnamed_pieces.push(self.piece.id);
        }
        report.unnumbered_sides += lettered.unnumbered;
        report.unmarked_angles += lettered.unmarked_angles;
        for (kind, id, label) in lettered.labels {
            let open = |points: &Vec<DVec2>| Stroke {
                points: self.placed.apply_all(points),
                closed: false,
            };
            drawing.add(kind, id, Some(self.piece.id), label.strokes.iter().map(open).collect());
        }
        Ok(())
    }

    fn letter(&self, order: Order) -> Result<Lettered, SheetError> {
        let mut lettered = Lettered::default();
        let labels = self.params.labels;
        if order == Order::NameFirst && labels != Labels::None {
            self.name(&mut lettered)?;
        }
        match labels {
            Labels::All => self.stretches(&mut lettered)?,
            Labels::Edges => self.edges(&mut lettered)?,
            Labels::None | Labels::Pieces => {}
        }
        if order == Order::NumbersFirst && labels != Labels::None {
            self.name(&mut lettered)?;
        }
        if self.params.angles == Angles::On {
            self.angles(&mut lettered)?;
        }
        Ok(lettered)
    }

    fn name(&self, lettered: &mut Lettered) -> Result<(), SheetError> {
        let upright = DVec2::from_angle(-self.placed.rotation.to_radians());
        let room = (self.obstacles.as_slice(), self.letter);
        if let Some((face, label)) = name_label(self.piece, upright, &lettered.taken, room)? {
            lettered.put(MarkKind::PieceName, format!("{}-name", self.piece.id), face, label);
            lettered.named = true;
        }
        Ok(())
    }

    fn faces(&self) -> BTreeMap<usize, usize> {
        self.piece.faces.iter().enumerate().map(|(i, f)| (f.face, i)).collect()
    }

    fn edges(&self, lettered: &mut Lettered) -> Result<(), SheetError> {
        let faces = self.faces();
        for &(seam, i) in &self.here.seams {
            let text = seam.id.0.to_string();
            let letter = suited(self.letter, seam.length);
            match self.beside(&text, &faces, (seam, i), (false, letter), &lettered.taken)? {
                Some((at, label)) => lettered.put(
                    MarkKind::SeamNumber,
                    format!("{}-number-{}", seam.id, i + 1),
                    at,
                    label,
                ),
                None => lettered.unnumbered += 1,
            }
        }
        Ok(())
    }

    /// One number for every stretch, as near to its middle as there is room, and marks where only
    /// they show its ends.
    fn stretches(&self, lettered: &mut Lettered) -> Result<(), SheetError> {
        let faces = self.faces();
        for &(stretch, i) in &self.here.stretches {
            let text = stretch.number.to_string();
            let n = stretch.seams.len();
            let mut order: Vec<usize> = (0..n).collect();
            order.sort_by_key(|&k| ((2 * k + 1).abs_diff(n), k));
            let letter = suited(self.letter, stretch.length(self.net));
            let mut found: Option<(usize, Label)> = None;
            let ways = [false, true].into_iter().flat_map(|w| order.iter().map(move |&k| (w, k)));
            for (across, k) in ways {
                let height = found.as_ref().map_or(0.0, |(_, label)| label.height);
                if height >= letter {
                    break;
                }
                let (s, forward) = stretch.seams[k];
                let side = (&self.net.seams[s], forward ^ i);
                // Across an edge the length of the stretch is no limit.
                let largest = if across { self.letter } else { letter };
                let label = self.beside(&text, &faces, side, (across, largest), &lettered.taken)?;
                // Nearer to the middle is better, unless it is much smaller there.
                found = label.filter(|(_, l)| l.height > WORTH * height).or(found);
            }
            let (first, forward) = stretch.seams[0];
            let name =
                |what: &str| format!("{}-{what}-{}", self.net.seams[first].id, 1 + (forward ^ i));
            match found {
                Some((at, label)) => lettered.put(MarkKind::SeamNumber, name("number"), at, label),
                None => lettered.unnumbered += 1,
            }
            if let Some(mark) = self.mark(stretch, i, &faces) {
                lettered.labels.push((MarkKind::SeamMark, name("mark"), mark));
            }
        }
        Ok(())
    }

    /// The short line at the beginning of a stretch that another one runs into.
    fn mark(&self, stretch: &Stretch, i: usize, faces: &BTreeMap<usize, usize>) -> Option<Label> {
        let (s, forward) = *stretch.seams.first().filter(|_| stretch.goes_on[0])?;
        let side = &self.net.seams[s].sides[forward ^ i];
        let index = *faces.get(&side.face)?;
        let face = &self.piece.faces[index];
        let [a, b] = face.side(self.net.seams[s].edge, side.segment)?;
        // The beginning of the stretch is where its forward side begins and its partner ends.
        let (at, towards) = if i == 0 { (a, b) } else { (b, a) };
        // A little beside the corner, where a fold may begin.
        let at = at + (towards - at).normalize_or_zero() * (0.25_f64).min(0.2 * a.distance(b));
        let inwards = (b - a).normalize_or_zero().perp();
        let line = vec![at + inwards * MARK[1], at + inwards * (MARK[1] + MARK[0])];
        let inside = line.iter().all(|&p| locate(&face.polygon, p) == Location::Inside);
        let frame = [line[0], line[1], line[1], line[0]];
        let label = Label { strokes: vec![line], frame, height: MARK[0] };
        (inside && is_clear(&label.frame, &self.obstacles[index])).then_some(label)
    }

    fn angles(&self, lettered: &mut Lettered) -> Result<(), SheetError> {
        let faces = self.faces();
        for fold in self.here.folds.iter().filter(|f| f.kind != FoldKind::Flat) {
            let text = format!("{:.0}°", fold.fold_angle);
            let mut found = None;
            for at in fold.faces.iter().filter_map(|f| faces.get(f).copied()) {
                if found.is_none() {
                    let [a, b] = fold.segment;
                    let letter = suited(self.letter, a.distance(b));
                    let room = Room { letter, ..self.room(at, &lettered.taken) };
                    let face = &self.piece.faces[at];
                    let label = number_label(&text, face, fold.edge, fold.segment, room)?;
                    found = label.map(|label| (at, label));
                }
            }
            match found {
                Some((at, label)) => {
                    lettered.put(MarkKind::FoldAngle, format!("{}-angle", fold.id), at, label)
                }
                None => lettered.unmarked_angles += 1,
            }
        }
        Ok(())
    }

    fn beside(
        &self,
        text: &str,
        faces: &BTreeMap<usize, usize>,
        (seam, i): (&Seam, usize),
        (across, letter): (bool, f64),
        taken: &Taken,
    ) -> Result<Option<(usize, Label)>, SheetError> {
        let side = &seam.sides[i];
        let Some(&at) = faces.get(&side.face) else { return Ok(None) };
        let put = if across { number_across } else { number_label };
        let face = &self.piece.faces[at];
        let room = Room { letter, ..self.room(at, taken) };
        let label = put(text, face, seam.edge, side.segment, room)?;
        Ok(label.map(|label| (at, label)))
    }

    /// What labels in a face keep clear of.
    fn room<'b>(&'b self, face: usize, taken: &'b Taken) -> Room<'b> {
        let taken = taken.get(&face).map_or(&[][..], Vec::as_slice);
        Room { taken, obstacles: &self.obstacles[face], letter: self.letter }
    }
}

impl Lettered {
    fn put(&mut self, kind: MarkKind, id: String, face: usize, label: Label) {
        self.taken.entry(face).or_default().push(label.frame);
        self.labels.push((kind, id, label));
    }
}
