//! `assembly.txt`: what to do in which order, in names and numbers that stand on the sheets.

use std::collections::{BTreeMap, BTreeSet};

use super::Fabrication;
use crate::net::PieceId;
use crate::sheet::{AssemblyStep, Drawing, Labels, MarkKind, Stretch};
use crate::units::counted;

/// What is engraved on the sheets.
pub(super) struct Engraved<'a> {
    fabrication: &'a Fabrication,
    labels: Labels,
    /// The names of marks that are a name or a number.
    marks: BTreeSet<&'a str>,
    /// The stretches of every piece, by their place in the assembly, ascending.
    of_piece: BTreeMap<PieceId, Vec<usize>>,
}

impl<'a> Engraved<'a> {
    pub fn new(fabrication: &'a Fabrication, labels: Labels) -> Self {
        let marks = fabrication.sheets.drawings.iter().flat_map(Drawing::marks);
        let marks = marks.filter(|m| matches!(m.kind, MarkKind::PieceName | MarkKind::SeamNumber));
        let mut of_piece: BTreeMap<PieceId, Vec<usize>> = BTreeMap::new();
        for (i, stretch) in fabrication.sheets.assembly.stretches.iter().enumerate() {
            for piece in stretch.pieces {
                of_piece.entry(piece).or_default().push(i);
            }
        }
        Self { fabrication, labels, marks: marks.map(|m| m.id.as_str()).collect(), of_piece }
    }

    /// Whether an edge of the model has its number on one of its sides at least.
    fn has_number(&self, seam: usize) -> bool {
        let id = self.fabrication.net.seams[seam].id;
        (1..=2).any(|side| self.marks.contains(format!("{id}-number-{side}").as_str()))
    }

    /// The numbers that stand for a stretch on the sheets; none where there was no room.
    fn numbers(&self, stretch: &Stretch) -> Vec<usize> {
        let edges = stretch.seams.iter().map(|&(seam, _)| seam);
        match self.labels {
            Labels::None | Labels::Pieces => Vec::new(),
            Labels::All => {
                let first = edges.clone().next().is_some_and(|seam| self.has_number(seam));
                if first { vec![stretch.number] } else { Vec::new() }
            }
            Labels::Edges => edges
                .filter(|&seam| self.has_number(seam))
                .map(|seam| self.fabrication.net.seams[seam].id.0)
                .collect(),
        }
    }

    /// The name of a piece as it can be found.
    fn piece(&self, id: PieceId) -> String {
        if self.labels == Labels::None || self.marks.contains(format!("{id}-name").as_str()) {
            id.to_string()
        } else {
            "the piece without a name".to_owned()
        }
    }

    /// ` along seam 3`; a stretch without a number by its neighbours that have one.
    fn along(&self, stretches: &[&Stretch]) -> String {
        if matches!(self.labels, Labels::None | Labels::Pieces) {
            return String::new();
        }
        let numbers: Vec<usize> = stretches.iter().flat_map(|s| self.numbers(s)).collect();
        let bare: Vec<&Stretch> =
            stretches.iter().copied().filter(|s| self.numbers(s).is_empty()).collect();
        let mut words = Vec::new();
        if !numbers.is_empty() {
            words.push(seams(&numbers));
        }
        if !bare.is_empty() {
            let beside: BTreeSet<usize> =
                bare.iter().flat_map(|s| self.neighbours(s)).take(4).collect();
            let what = counted(bare.len(), "short seam", "short seams");
            let what = what.strip_prefix("1 ").map_or(what.clone(), |one| format!("a {one}"));
            let beside: Vec<usize> = beside.into_iter().collect();
            words.push(if beside.is_empty() {
                format!("{what} without a number")
            } else {
                format!("{what} without a number beside {}", seams(&beside))
            });
        }
        format!(" along {}", words.join(" and "))
    }

    /// The numbers of stretches that end where a stretch does, on one of its pieces.
    fn neighbours(&self, stretch: &Stretch) -> Vec<usize> {
        let corners = |s: &Stretch| -> BTreeSet<usize> {
            s.seams.iter().flat_map(|&(i, _)| self.fabrication.net.seams[i].edge).collect()
        };
        let own = corners(stretch);
        let all = &self.fabrication.sheets.assembly.stretches;
        let near = stretch.pieces.iter().filter_map(|piece| self.of_piece.get(piece)).flatten();
        let near: BTreeSet<usize> = near.copied().collect();
        let is_beside = |other: &&Stretch| {
            other.number != stretch.number && corners(other).intersection(&own).next().is_some()
        };
        let near = near.into_iter().map(|i| &all[i]);
        near.filter(is_beside).flat_map(|s| self.numbers(s)).collect()
    }

    /// What is done in one step, in words.
    pub fn step(&self, steps: &[AssemblyStep]) -> String {
        let stretches = &self.fabrication.sheets.assembly.stretches;
        let stretch = |step: &AssemblyStep| &stretches[step.number - 1];
        let mut clauses: Vec<(String, Vec<&Stretch>)> = Vec::new();
        for step in steps {
            let here = stretch(step);
            let [a, b] = here.pieces;
            let what = match step.attaches {
                Some(piece) => {
                    let other = if piece == a { b } else { a };
                    format!("attach {} to {}", self.piece(piece), self.piece(other))
                }
                None if a == b => format!("close {}", self.piece(a)),
                None => format!("close {} to {}", self.piece(a.min(b)), self.piece(a.max(b))),
            };
            match clauses.last_mut().filter(|last| last.0 == what) {
                Some(last) => last.1.push(here),
                None => clauses.push((what, vec![here])),
            }
        }
        let words = clauses.iter().map(|(what, along)| what.clone() + &self.along(along));
        words.collect::<Vec<_>>().join("; ")
    }

    /// The numbers of a step for its picture: `P02 3,4`.
    pub fn label(&self, steps: &[AssemblyStep]) -> String {
        let stretches = &self.fabrication.sheets.assembly.stretches;
        let numbers = steps.iter().flat_map(|s| self.numbers(&stretches[s.number - 1]));
        let numbers: Vec<String> = numbers.take(LABELLED).map(|n| n.to_string()).collect();
        let name = steps.iter().find_map(|s| s.attaches).map(|piece| piece.to_string());
        let seams = (!numbers.is_empty()).then(|| format!("SEAM {}", numbers.join(",")));
        name.into_iter().chain(seams).collect::<Vec<_>>().join("  ")
    }

    /// Nothing where names and numbers say all.
    fn head(&self) -> &'static str {
        match self.labels {
            Labels::None => {
                "Nothing is engraved on the sheets; pieces have their names in layout.json.\n\n"
            }
            Labels::Pieces => "Seams have no numbers on the sheets.\n\n",
            Labels::All | Labels::Edges => "",
        }
    }
}

/// Numbers of seams that a picture of a step shows.
const LABELLED: usize = 4;

fn seams(numbers: &[usize]) -> String {
    let list = numbers.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    if numbers.len() == 1 { format!("seam {list}") } else { format!("seams {list}") }
}

/// The order in which seams are closed, for people: one line a step.
pub(super) fn assembly_text(fabrication: &Fabrication, labels: Labels, command: &str) -> String {
    let engraved = Engraved::new(fabrication, labels);
    let mut text = format!("{command}\n\n{}", engraved.head());
    for (i, steps) in fabrication.sheets.assembly.together().iter().enumerate() {
        text += &format!("step {}: {}\n", i + 1, engraved.step(steps));
    }
    text
}
