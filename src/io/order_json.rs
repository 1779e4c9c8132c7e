//! Pieces to be nested: any number of `pieces.json`, ours or anybody's, as one net.
//!
//! Of a piece only its `outline` is needed. `holes`, `quantity`, `rotation` and `group` may be
//! there; a file with `mesh` is one of ours and brings its folds and seams along. Contours may run
//! either way round and may repeat their first corner at the end; what crosses itself is refused.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec2;
use serde::Deserialize;

use super::pieces_json::{PiecesJsonError, read_pieces_json};
use crate::code::codes;
use crate::geom::polygon::{Location, locate, segments_cross, signed_area};
use crate::net::{EdgeLabel, FlatFace, Fold, MeshCounts, Net, NetRim, Piece, PieceId, Proof, Seam};
use crate::sheet::{NestParams, Rotation};

/// Why pieces could not be taken.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OrderError {
    /// Not JSON, or not of the right form.
    #[error(
        "line {line}, column {column}: {message}; a file of pieces is \
        {{\"units\": \"mm\", \"pieces\": [{{\"outline\": [[x,y], …]}}]}}"
    )]
    Syntax {
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What the JSON reader says.
        message: String,
    },
    /// A file of ours that is not right.
    #[error(transparent)]
    Pieces(#[from] PiecesJsonError),
    /// A unit other than millimetres.
    #[error("units is {found:?}, but must be \"mm\"")]
    Units {
        /// What it is.
        found: String,
    },
    /// A contour that bounds nothing, or crosses itself, or a hole outside its piece.
    #[error("pieces[{index}].{contour}: {why}")]
    Contour {
        /// The piece's place in the file.
        index: usize,
        /// `outline` or `holes[0]`.
        contour: String,
        /// What is wrong.
        why: String,
    },
    /// A rotation that is none.
    #[error("pieces[{index}].rotation: {error}")]
    Rotation {
        /// The piece's place in the file.
        index: usize,
        /// Why not.
        error: crate::units::UnitError,
    },
    /// Nothing, or far too much to lay out.
    #[error("{count} pieces in all; from 1 to {most} can be nested")]
    Count {
        /// How many there are.
        count: usize,
        /// How many there may be.
        most: usize,
    },
}

codes!(error OrderError {
    Syntax = 161,
    Units = 162,
    Contour = 163,
    Count = 164,
} through {
    Pieces.0,
    Rotation.error,
});

/// More pieces than this are refused.
const MOST_PIECES: usize = 100_000;

#[derive(Deserialize)]
struct File {
    units: Option<String>,
    mesh: Option<serde_json::Value>,
    pieces: Vec<Entry>,
}

#[derive(Deserialize)]
struct Entry {
    id: Option<String>,
    outline: Vec<[f64; 2]>,
    #[serde(default)]
    holes: Vec<Vec<[f64; 2]>>,
    quantity: Option<usize>,
    rotation: Option<String>,
    group: Option<String>,
}

impl Entry {
    /// How many times it is made; once where nothing is said.
    fn quantity(&self) -> usize {
        self.quantity.unwrap_or(1)
    }
}

/// Where a piece of an order comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OrderSource {
    /// The number of the file, from 0.
    pub file: usize,
    /// Its name there, or its place when it has none.
    pub id: String,
    /// Which of several alike it is, from 0.
    pub copy: usize,
}

/// Pieces of several files as one net, numbered anew.
#[derive(Debug, Clone)]
pub struct Order {
    /// All pieces, with the folds and seams of those files that have them.
    pub net: Net,
    /// For each piece where it comes from.
    pub sources: Vec<OrderSource>,
    rotations: BTreeMap<PieceId, Rotation>,
    groups: BTreeMap<(usize, usize, String), BTreeSet<PieceId>>,
    files: usize,
}

impl Default for Order {
    fn default() -> Self {
        let net = Net {
            scale: 1.0,
            counts: MeshCounts::default(),
            pieces: Vec::new(),
            folds: Vec::new(),
            seams: Vec::new(),
            rims: Vec::new(),
            proof: Proof::default(),
        };
        Self {
            net,
            sources: Vec::new(),
            rotations: BTreeMap::new(),
            groups: BTreeMap::new(),
            files: 0,
        }
    }
}

impl Order {
    /// Adds the pieces of a file, all of them `quantity` times.
    ///
    /// # Errors
    /// [`OrderError`], with the place in the file.
    pub fn add(&mut self, text: &str, quantity: usize) -> Result<(), OrderError> {
        let syntax = |e: serde_json::Error| OrderError::Syntax {
            line: e.line(),
            column: e.column(),
            message: e.to_string().split(" at line ").next().unwrap_or_default().to_owned(),
        };
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let file: File = serde_json::from_str(text).map_err(syntax)?;
        if let Some(found) = file.units.filter(|u| u != "mm") {
            return Err(OrderError::Units { found });
        }
        let net = match file.mesh {
            Some(_) => read_pieces_json(text)?.0,
            None => bare_net(&file.pieces),
        };
        let net = checked(net)?;
        self.refuse_too_many(&file.pieces, quantity)?;
        let most_copies = file.pieces.iter().map(Entry::quantity).max().unwrap_or(0);
        for whole in 0..quantity {
            for single in 0..most_copies {
                let names = self.add_copy(&net, |i| single < file.pieces[i].quantity());
                for (&index, &piece) in &names {
                    self.note_source(&file.pieces[index], Copy { index, piece, whole, single })?;
                }
            }
        }
        self.files += 1;
        Ok(())
    }

    fn refuse_too_many(&self, entries: &[Entry], quantity: usize) -> Result<(), OrderError> {
        let one_set = entries.iter().map(Entry::quantity).fold(0_usize, usize::saturating_add);
        let count = one_set.saturating_mul(quantity).saturating_add(self.net.pieces.len());
        if count > MOST_PIECES {
            return Err(OrderError::Count { count, most: MOST_PIECES });
        }
        Ok(())
    }

    /// Remembers where a piece comes from and what its file says about it.
    fn note_source(&mut self, entry: &Entry, copy: Copy) -> Result<(), OrderError> {
        let Copy { index, piece, whole, single } = copy;
        self.sources.push(OrderSource {
            file: self.files,
            id: entry.id.clone().unwrap_or_else(|| format!("pieces[{index}]")),
            copy: whole * entry.quantity() + single,
        });
        if let Some(rotation) = &entry.rotation {
            let rotation =
                rotation.parse().map_err(|error| OrderError::Rotation { index, error })?;
            self.rotations.insert(piece, rotation);
        }
        if let Some(group) = &entry.group {
            self.groups.entry((self.files, whole, group.clone())).or_default().insert(piece);
        }
        Ok(())
    }

    /// The parameters with what the files say about their pieces; what the parameters say
    /// themselves counts more.
    ///
    /// # Errors
    /// [`OrderError::Count`] for an order of nothing.
    pub fn params(&self, params: &NestParams) -> Result<NestParams, OrderError> {
        if self.net.pieces.is_empty() {
            return Err(OrderError::Count { count: 0, most: MOST_PIECES });
        }
        let mut params = params.clone();
        for (&piece, &rotation) in &self.rotations {
            params.rotate.0.entry(piece).or_insert(rotation);
        }
        for group in self.groups.values() {
            params.together.add(group.clone());
        }
        Ok(params)
    }

    /// Adds those pieces of a net that are to be made, under new numbers; returns the new name for
    /// each place in the net.
    fn add_copy(&mut self, net: &Net, is_made: impl Fn(usize) -> bool) -> BTreeMap<usize, PieceId> {
        let base = self.net.counts;
        let mut names = BTreeMap::new();
        let mut renamed = BTreeMap::new();
        for (i, piece) in net.pieces.iter().enumerate().filter(|&(i, _)| is_made(i)) {
            let id = PieceId(self.net.pieces.len());
            names.insert(i, id);
            renamed.insert(piece.id, id);
            let faces = piece.faces.iter().map(|f| shifted_face(f, base)).collect();
            let (outline, holes) = (piece.outline.clone(), piece.holes.clone());
            self.net.pieces.push(Piece { id, faces, outline, holes });
        }
        for fold in &net.folds {
            if let Some(&piece) = renamed.get(&fold.piece) {
                self.net.folds.push(Fold {
                    id: shifted_label(fold.id, base),
                    edge: shifted_ends(fold.edge, base),
                    piece,
                    faces: fold.faces.map(|f| f + base.faces),
                    ..fold.clone()
                });
            }
        }
        for seam in &net.seams {
            self.add_seam(seam, base, &renamed);
        }
        for rim in &net.rims {
            if let Some(&piece) = renamed.get(&rim.piece) {
                self.net.rims.push(NetRim {
                    edge: shifted_ends(rim.edge, base),
                    piece,
                    face: rim.face + base.faces,
                    ..rim.clone()
                });
            }
        }
        self.add_counts_and_proof(net, base);
        names
    }

    /// Adds a seam with both its sides, or a rim for the side whose partner is not made this time.
    fn add_seam(&mut self, seam: &Seam, base: MeshCounts, renamed: &BTreeMap<PieceId, PieceId>) {
        let edge = shifted_ends(seam.edge, base);
        let mut sides = seam.sides.clone();
        let is_whole = sides.iter().all(|side| renamed.contains_key(&side.piece));
        for side in &mut sides {
            let Some(&piece) = renamed.get(&side.piece) else { continue };
            side.piece = piece;
            side.face += base.faces;
            if !is_whole {
                let (face, segment) = (side.face, side.segment);
                self.net.rims.push(NetRim { edge, piece, face, segment });
            }
        }
        if is_whole {
            let id = shifted_label(seam.id, base);
            self.net.seams.push(Seam { id, edge, sides, ..seam.clone() });
        }
    }

    fn add_counts_and_proof(&mut self, net: &Net, base: MeshCounts) {
        let labels = net.folds.iter().map(|f| f.id).chain(net.seams.iter().map(|s| s.id));
        let edges = labels.map(|l| l.0 + 1).max().unwrap_or(0).max(net.counts.edges);
        self.net.counts = MeshCounts {
            vertices: base.vertices + net.counts.vertices,
            edges: base.edges + edges,
            faces: base.faces + net.counts.faces,
        };
        let proof = &mut self.net.proof;
        proof.congruence_mm = proof.congruence_mm.max(net.proof.congruence_mm);
        proof.refold_mm = proof.refold_mm.max(net.proof.refold_mm);
        proof.overlaps += net.proof.overlaps;
    }
}

/// Which copy of which entry a piece is.
struct Copy {
    /// The place of the entry in its file.
    index: usize,
    piece: PieceId,
    /// The number of the copy of the whole file, and of the entry in it.
    whole: usize,
    single: usize,
}

/// A face whose numbers begin behind those that are taken.
fn shifted_face(face: &FlatFace, base: MeshCounts) -> FlatFace {
    FlatFace {
        face: face.face + base.faces,
        vertices: face.vertices.iter().map(|v| v + base.vertices).collect(),
        polygon: face.polygon.clone(),
    }
}

fn shifted_ends(edge: [usize; 2], base: MeshCounts) -> [usize; 2] {
    edge.map(|v| v + base.vertices)
}

fn shifted_label(label: EdgeLabel, base: MeshCounts) -> EdgeLabel {
    EdgeLabel(label.0 + base.edges)
}

/// A net of pieces that are one face each, without edges that are known.
fn bare_net(entries: &[Entry]) -> Net {
    let points = |c: &Vec<[f64; 2]>| c.iter().copied().map(DVec2::from).collect::<Vec<_>>();
    let piece = |(i, entry): (usize, &Entry)| {
        let outline = points(&entry.outline);
        Piece {
            id: PieceId(i),
            faces: Vec::new(),
            outline,
            holes: entry.holes.iter().map(points).collect(),
        }
    };
    Net { pieces: entries.iter().enumerate().map(piece).collect(), ..Order::default().net }
}

/// The net with contours that run the right way round, and without repeated corners.
fn checked(mut net: Net) -> Result<Net, OrderError> {
    let is_bare = net.counts == MeshCounts::default();
    for (index, piece) in net.pieces.iter_mut().enumerate() {
        contour(&mut piece.outline, 1.0).map_err(|why| OrderError::Contour {
            index,
            contour: "outline".to_owned(),
            why,
        })?;
        for (h, hole) in piece.holes.iter_mut().enumerate() {
            let bad = |why| OrderError::Contour { index, contour: format!("holes[{h}]"), why };
            if !is_bare {
                // Our own holes may be slits.
                continue;
            }
            contour(hole, -1.0).map_err(bad)?;
            if hole.iter().any(|&p| locate(&piece.outline, p) == Location::Outside) {
                return Err(bad("it lies outside the outline".to_owned()));
            }
        }
        if piece.faces.is_empty() {
            let vertices =
                (net.counts.vertices..net.counts.vertices + piece.outline.len()).collect();
            piece.faces =
                vec![FlatFace { face: net.counts.faces, vertices, polygon: piece.outline.clone() }];
            net.counts.vertices += piece.outline.len();
            net.counts.faces += 1;
        }
    }
    Ok(net)
}

fn contour(corners: &mut Vec<DVec2>, sense: f64) -> Result<(), String> {
    if let Some(p) = corners.iter().find(|p| !p.is_finite()) {
        return Err(format!("{},{} is no point", p.x, p.y));
    }
    corners.dedup();
    if corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let area = signed_area(corners);
    if corners.len() < 3 || area == 0.0 || !area.is_finite() {
        return Err("it needs three corners or more and an area".to_owned());
    }
    let n = corners.len();
    for i in 0..n {
        for j in 0..i {
            if segments_cross(corners[i], corners[(i + 1) % n], corners[j], corners[(j + 1) % n]) {
                return Err(format!(
                    "its sides {} and {} cross; divide the piece there",
                    j + 1,
                    i + 1
                ));
            }
        }
    }
    if area * sense < 0.0 {
        corners.reverse();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(text: &str) -> String {
        Order::default().add(text, 1).expect_err(text).to_string()
    }

    #[test]
    fn anybodys_pieces_are_taken_either_way_round() {
        let mut order = Order::default();
        let text = r#"{"pieces": [{"outline": [[0,0],[0,10],[10,10],[10,0],[0,0]], "holes": [[[2,2],[4,2],[4,4]]], "quantity": 3, "rotation": "fixed"},
            {"id": "lid", "outline": [[0,0],[5,0],[0,5]], "group": "g"}]}"#;
        order.add(text, 2).expect("good pieces");
        assert_eq!(order.net.pieces.len(), 8);
        assert!(
            order
                .net
                .pieces
                .iter()
                .all(|p| signed_area(&p.outline) > 0.0
                    && p.holes.iter().all(|h| signed_area(h) < 0.0))
        );
        assert_eq!(
            order.sources.iter().filter(|s| s.id == "lid").map(|s| s.copy).collect::<Vec<_>>(),
            [0, 1]
        );
        let params = order.params(&NestParams::default()).expect("some pieces");
        assert_eq!((params.rotate.0.len(), params.together.0.len()), (6, 2));
    }

    #[test]
    fn complaints_name_the_place() {
        assert!(refused("[").contains("line 1, column"));
        assert!(refused("{}").contains("pieces"));
        assert!(refused(r#"{"units": "in", "pieces": []}"#).contains("must be \"mm\""));
        assert!(
            refused(r#"{"pieces": [{"outline": [[0,0],[1,0]]}]}"#)
                .contains("pieces[0].outline: it needs three")
        );
        assert!(
            refused(r#"{"pieces": [{"outline": [[0,0],[9,9],[9,0],[0,8]]}]}"#)
                .contains("sides 1 and 3 cross")
        );
        let hole =
            r#"{"pieces": [{"outline": [[0,0],[9,0],[0,9]], "holes": [[[8,8],[9,8],[9,9]]]}]}"#;
        assert!(refused(hole).contains("pieces[0].holes[0]: it lies outside"));
        assert!(
            refused(r#"{"pieces": [{"outline": [[0,0],[9,0],[0,9]], "rotation": "45"}]}"#)
                .contains("pieces[0].rotation")
        );
        assert!(
            refused(r#"{"pieces": [{"outline": [[0,0],[9,0],[0,9]], "quantity": 200000}]}"#)
                .contains("200000 pieces")
        );
    }
}
