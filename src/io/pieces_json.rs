//! `pieces.json`, written and read (`docs/formats.md`): the contract between unfolding and
//! everything that comes after.
//!
//! Written by hand rather than by derive: the keys come in a fixed order, one piece's face, fold,
//! seam or rim to a line, and numbers are the shortest that read back as the same double. Read
//! through paths, so that every complaint names its field.

use std::fmt::{self, Write as _};

use glam::DVec2;
use serde_json::Value;

use crate::code::codes;
use crate::net::{
    EdgeLabel, FlatFace, Fold, FoldKind, MeshCounts, Net, NetRim, Piece, PieceId, Proof, Seam,
    SeamSide, Segment,
};

/// Why a `pieces.json` could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PiecesJsonError {
    /// Not JSON at all.
    #[error(
        "pieces.json, line {line}, column {column}: {message}; write the file anew with `unfold`"
    )]
    Syntax {
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1.
        column: usize,
        /// What the JSON reader says.
        message: String,
    },
    /// A field that is not there.
    #[error("pieces.json: {field} is missing; write the file anew with `unfold`")]
    Missing {
        /// Its path, like `pieces[2].faces[0].polygon`.
        field: String,
    },
    /// A field of the wrong kind.
    #[error("pieces.json: {field} must be {wanted}, but is {found}")]
    Wrong {
        /// Its path.
        field: String,
        /// What it should be.
        wanted: &'static str,
        /// What it is, shortened.
        found: String,
    },
}

codes!(error PiecesJsonError {
    Syntax = 181,
    Missing = 182,
    Wrong = 183,
});

/// The text of `pieces.json`. `command` is the command line that made the net.
///
/// Every number of the net must be finite, as those of [`crate::unfold::unfold`] are.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use kerfold::io::pieces_json::{read_pieces_json, write_pieces_json};
///
/// let net = unfold(
///     &kerfold::shape::cube(40.0),
///     &Seams::Free,
///     &UnfoldParams::default(),
///     &MeshSource { scale: 1.0, split_vertices: &[] },
///     &Silent,
/// )?;
/// let text = write_pieces_json(&net, "my program");
/// let (again, command) = read_pieces_json(&text)?;
/// assert_eq!((again.pieces, command.as_str()), (net.pieces, "my program"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_pieces_json(net: &Net, command: &str) -> String {
    let mut text = String::new();
    write_net(&mut text, net, command).expect("writing into a string cannot fail");
    text
}

/// Reads the text of a `pieces.json`: the net, and the command line that made it.
///
/// # Errors
/// See [`PiecesJsonError`]. Unknown keys are ignored. Whether the net is right is for
/// [`crate::unfold::prove`] to say.
///
/// # Example
/// ```
/// use kerfold::io::pieces_json::read_pieces_json;
///
/// let error = read_pieces_json("{}").expect_err("no pieces");
/// assert!(error.to_string().contains("pieces.json"), "{error}");
/// ```
pub fn read_pieces_json(text: &str) -> Result<(Net, String), PiecesJsonError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let value: Value = serde_json::from_str(text).map_err(|e| PiecesJsonError::Syntax {
        line: e.line(),
        column: e.column(),
        message: e.to_string().split(" at line ").next().unwrap_or_default().to_owned(),
    })?;
    let file = Field { path: String::new(), value: &value };
    file.member("units")?.one_of(&[("mm", ())], "\"mm\"")?;
    Ok((read_net(&file)?, file.member("command")?.text()?.to_owned()))
}

// ---- writing ------------------------------------------------------------------------------------

fn write_net(out: &mut String, net: &Net, command: &str) -> fmt::Result {
    let counts = net.counts;
    write!(
        out,
        "{{ \"command\": {},\n  \"units\": \"mm\", \"scale\": {}, ",
        Quoted(command),
        Number(net.scale)
    )?;
    writeln!(
        out,
        "\"mesh\": {{\"vertices\": {}, \"edges\": {}, \"faces\": {}}},",
        counts.vertices, counts.edges, counts.faces
    )?;
    list(out, "pieces", &net.pieces, write_piece)?;
    list(out, "folds", &net.folds, write_fold)?;
    list(out, "seams", &net.seams, write_seam)?;
    list(out, "rims", &net.rims, write_rim)?;
    let Proof { congruence_mm, refold_mm, overlaps } = net.proof;
    writeln!(
        out,
        "  \"proof\": {{\"congruence_mm\": {}, \"refold_mm\": {}, \"overlaps\": {overlaps}}} }}",
        Number(congruence_mm),
        Number(refold_mm)
    )
}

fn list<T>(
    out: &mut String,
    key: &str,
    items: &[T],
    write: fn(&mut String, &T) -> fmt::Result,
) -> fmt::Result {
    write!(out, "  \"{key}\": [")?;
    for (i, item) in items.iter().enumerate() {
        out.push_str(if i == 0 { "\n    " } else { ",\n    " });
        write(out, item)?;
    }
    out.push_str(if items.is_empty() { "],\n" } else { "\n  ],\n" });
    Ok(())
}

fn write_piece(out: &mut String, piece: &Piece) -> fmt::Result {
    write!(
        out,
        "{{\"id\": \"{}\", \"outline\": {}, \"holes\": [",
        piece.id,
        Points(&piece.outline)
    )?;
    for (i, hole) in piece.holes.iter().enumerate() {
        write!(out, "{}{}", if i == 0 { "" } else { ", " }, Points(hole))?;
    }
    out.push_str("],\n     \"faces\": [");
    for (i, flat) in piece.faces.iter().enumerate() {
        out.push_str(if i == 0 { "\n      " } else { ",\n      " });
        let FlatFace { face, vertices, polygon } = flat;
        write!(
            out,
            "{{\"face\": {face}, \"vertices\": {}, \"polygon\": {}}}",
            Indices(vertices),
            Points(polygon)
        )?;
    }
    out.push_str("]}");
    Ok(())
}

fn write_fold(out: &mut String, fold: &Fold) -> fmt::Result {
    write!(
        out,
        "{{\"id\": \"{}\", \"edge\": {}, \"piece\": \"{}\", \"faces\": {}, \"segment\": \
        {}, \"fold_angle\": {}, \
         \"kind\": \"{}\"}}",
        fold.id,
        Indices(&fold.edge),
        fold.piece,
        Indices(&fold.faces),
        Points(&fold.segment),
        Number(fold.fold_angle),
        kind_name(fold.kind)
    )
}

fn write_seam(out: &mut String, seam: &Seam) -> fmt::Result {
    write!(
        out,
        "{{\"id\": \"{}\", \"edge\": {}, \"length\": {}, \"fold_angle\": {}, \"sides\": [",
        seam.id,
        Indices(&seam.edge),
        Number(seam.length),
        Number(seam.fold_angle)
    )?;
    for (i, side) in seam.sides.iter().enumerate() {
        let SeamSide { piece, face, segment } = side;
        let comma = if i == 0 { "" } else { ", " };
        write!(
            out,
            "{comma}{{\"piece\": \"{piece}\", \"face\": {face}, \"segment\": {}}}",
            Points(segment)
        )?;
    }
    out.push_str("]}");
    Ok(())
}

fn write_rim(out: &mut String, rim: &NetRim) -> fmt::Result {
    let NetRim { edge, piece, face, segment } = rim;
    write!(
        out,
        "{{\"edge\": {}, \"piece\": \"{piece}\", \"face\": {face}, \"segment\": {}}}",
        Indices(edge),
        Points(segment)
    )
}

fn kind_name(kind: FoldKind) -> &'static str {
    match kind {
        FoldKind::Mountain => "mountain",
        FoldKind::Valley => "valley",
        FoldKind::Flat => "flat",
    }
}

/// The shortest decimal number that reads back as the same double.
struct Number(f64);

impl fmt::Display for Number {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Debug, unlike Display, writes very small and very large numbers with an exponent.
        write!(f, "{:?}", self.0)
    }
}

struct Quoted<'a>(&'a str);

impl fmt::Display for Quoted<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Value::from(self.0).fmt(f)
    }
}

struct Points<'a>(&'a [DVec2]);

impl fmt::Display for Points<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_char('[')?;
        for (i, p) in self.0.iter().enumerate() {
            write!(f, "{}[{},{}]", if i == 0 { "" } else { "," }, Number(p.x), Number(p.y))?;
        }
        f.write_char(']')
    }
}

struct Indices<'a>(&'a [usize]);

impl fmt::Display for Indices<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_char('[')?;
        for (i, index) in self.0.iter().enumerate() {
            write!(f, "{}{index}", if i == 0 { "" } else { "," })?;
        }
        f.write_char(']')
    }
}

// ---- reading ------------------------------------------------------------------------------------

/// A value and the way to it.
struct Field<'a> {
    path: String,
    value: &'a Value,
}

type Read<T> = Result<T, PiecesJsonError>;

impl<'a> Field<'a> {
    fn wrong(&self, wanted: &'static str) -> PiecesJsonError {
        let text = self.value.to_string();
        let found = match text.char_indices().nth(40) {
            Some((end, _)) => format!("{}…", &text[..end]),
            None => text,
        };
        let field = if self.path.is_empty() { "the file".to_owned() } else { self.path.clone() };
        PiecesJsonError::Wrong { field, wanted, found }
    }

    fn member(&self, key: &str) -> Read<Field<'a>> {
        let object = self.value.as_object().ok_or_else(|| self.wrong("an object"))?;
        let path =
            if self.path.is_empty() { key.to_owned() } else { format!("{}.{key}", self.path) };
        match object.get(key) {
            Some(value) => Ok(Field { path, value }),
            None => Err(PiecesJsonError::Missing { field: path }),
        }
    }

    fn items<T>(&self, read: impl Fn(&Field<'a>) -> Read<T>) -> Read<Vec<T>> {
        let items = self.value.as_array().ok_or_else(|| self.wrong("a list"))?;
        let field = |(i, value)| Field { path: format!("{}[{i}]", self.path), value };
        items.iter().enumerate().map(|item| read(&field(item))).collect()
    }

    fn two<T>(&self, read: impl Fn(&Field<'a>) -> Read<T>) -> Read<[T; 2]> {
        self.items(read)?.try_into().map_err(|_| self.wrong("a list of two"))
    }

    fn number(&self) -> Read<f64> {
        self.value.as_f64().ok_or_else(|| self.wrong("a number"))
    }

    fn index(&self) -> Read<usize> {
        let index = self.value.as_u64().and_then(|i| usize::try_from(i).ok());
        index.ok_or_else(|| self.wrong("a whole number from 0"))
    }

    fn text(&self) -> Read<&'a str> {
        self.value.as_str().ok_or_else(|| self.wrong("a text"))
    }

    fn one_of<T: Copy>(&self, values: &[(&str, T)], wanted: &'static str) -> Read<T> {
        let text = self.text()?;
        let found = values.iter().find(|(name, _)| *name == text);
        found.map(|&(_, value)| value).ok_or_else(|| self.wrong(wanted))
    }

    fn point(&self) -> Read<DVec2> {
        self.two(Field::number).map(DVec2::from)
    }

    fn points(&self) -> Read<Vec<DVec2>> {
        self.items(Field::point)
    }

    fn segment(&self) -> Read<Segment> {
        self.two(Field::point)
    }

    fn pair(&self) -> Read<[usize; 2]> {
        self.two(Field::index)
    }

    fn piece_id(&self) -> Read<PieceId> {
        let number = self
            .value
            .as_str()
            .and_then(|id| id.strip_prefix('P')?.parse::<usize>().ok()?.checked_sub(1));
        number.map(PieceId).ok_or_else(|| self.wrong("a piece id like \"P01\""))
    }

    fn edge_label(&self) -> Read<EdgeLabel> {
        let number = self.value.as_str().and_then(|id| id.strip_prefix('E')?.parse().ok());
        number.map(EdgeLabel).ok_or_else(|| self.wrong("an edge id like \"E012\""))
    }
}

fn read_net(file: &Field) -> Read<Net> {
    let mesh = file.member("mesh")?;
    let proof = file.member("proof")?;
    Ok(Net {
        scale: file.member("scale")?.number()?,
        counts: MeshCounts {
            vertices: mesh.member("vertices")?.index()?,
            edges: mesh.member("edges")?.index()?,
            faces: mesh.member("faces")?.index()?,
        },
        pieces: file.member("pieces")?.items(read_piece)?,
        folds: file.member("folds")?.items(read_fold)?,
        seams: file.member("seams")?.items(read_seam)?,
        rims: file.member("rims")?.items(read_rim)?,
        proof: Proof {
            congruence_mm: proof.member("congruence_mm")?.number()?,
            refold_mm: proof.member("refold_mm")?.number()?,
            overlaps: proof.member("overlaps")?.index()?,
        },
    })
}

fn read_piece(field: &Field) -> Read<Piece> {
    Ok(Piece {
        id: field.member("id")?.piece_id()?,
        outline: field.member("outline")?.points()?,
        holes: field.member("holes")?.items(Field::points)?,
        faces: field.member("faces")?.items(|face| {
            Ok(FlatFace {
                face: face.member("face")?.index()?,
                vertices: face.member("vertices")?.items(Field::index)?,
                polygon: face.member("polygon")?.points()?,
            })
        })?,
    })
}

fn read_fold(field: &Field) -> Read<Fold> {
    let kinds =
        [FoldKind::Mountain, FoldKind::Valley, FoldKind::Flat].map(|kind| (kind_name(kind), kind));
    Ok(Fold {
        id: field.member("id")?.edge_label()?,
        edge: field.member("edge")?.pair()?,
        piece: field.member("piece")?.piece_id()?,
        faces: field.member("faces")?.pair()?,
        segment: field.member("segment")?.segment()?,
        fold_angle: field.member("fold_angle")?.number()?,
        kind: field.member("kind")?.one_of(&kinds, "\"mountain\", \"valley\" or \"flat\"")?,
    })
}

fn read_seam(field: &Field) -> Read<Seam> {
    let side = |side: &Field| {
        Ok(SeamSide {
            piece: side.member("piece")?.piece_id()?,
            face: side.member("face")?.index()?,
            segment: side.member("segment")?.segment()?,
        })
    };
    Ok(Seam {
        id: field.member("id")?.edge_label()?,
        edge: field.member("edge")?.pair()?,
        length: field.member("length")?.number()?,
        fold_angle: field.member("fold_angle")?.number()?,
        sides: field.member("sides")?.two(side)?,
    })
}

fn read_rim(field: &Field) -> Read<NetRim> {
    Ok(NetRim {
        edge: field.member("edge")?.pair()?,
        piece: field.member("piece")?.piece_id()?,
        face: field.member("face")?.index()?,
        segment: field.member("segment")?.segment()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::Mesh;
    use crate::progress::Silent;
    use crate::unfold::{MeshSource, Seams, UnfoldParams, unfold};
    use glam::DVec3;

    /// Two thirds of a tent: an open strip of a square, a slanted square and a triangle.
    fn net() -> Net {
        let points = [
            (0., 0., 0.),
            (1., 0., 0.),
            (1., 1., 0.1),
            (0., 1., 0.1),
            (1., 2., 0.),
            (0., 2., 0.),
            (2., 0., 1.),
        ];
        let mesh = Mesh::from_faces(
            points.map(|(x, y, z)| DVec3::new(x, y, z) / 3.0),
            [vec![0, 1, 2, 3], vec![3, 2, 4, 5], vec![1, 6, 2]],
        );
        let mesh = mesh.expect("an open strip");
        let mut net =
            unfold(&mesh, &Seams::Free, &UnfoldParams::default(), &MeshSource::default(), &Silent)
                .expect("a net");
        net.proof.refold_mm = 4e-13;
        net
    }

    #[test]
    fn what_is_written_reads_back_to_the_last_bit() {
        let command = "kerfold unfold \"a\\b.obj\" -o x";
        let text = write_pieces_json(&net(), command);
        let (read, said) = read_pieces_json(&text).expect("our own file");
        assert_eq!((&read, said.as_str()), (&net(), command));
        assert_eq!(write_pieces_json(&read, command), text);
        assert!(text.starts_with("{ \"command\": \"kerfold unfold"));
        assert!(text.contains("\"refold_mm\": 4e-13"));
    }

    #[test]
    fn keys_come_in_the_order_of_the_contract() {
        let text = write_pieces_json(&net(), "c");
        let keys = [
            "command", "units", "scale", "mesh", "pieces", "outline", "holes", "folds", "seams",
            "rims", "proof",
        ];
        let places: Vec<_> =
            keys.iter().map(|k| text.find(&format!("\"{k}\":")).expect(k)).collect();
        assert!(places.is_sorted(), "{places:?}");
    }

    #[test]
    fn complaints_name_the_field() {
        let text = write_pieces_json(&net(), "c");
        let complaint = |from: &str, to: &str| {
            assert!(text.contains(from), "{from}");
            read_pieces_json(&text.replacen(from, to, 1)).expect_err(to).to_string()
        };
        assert!(complaint("\"outline\"", "\"outlines\"").contains("pieces[0].outline is missing"));
        assert!(
            complaint("\"face\": 0", "\"face\": -1")
                .contains("pieces[0].faces[0].face must be a whole number")
        );
        assert!(
            complaint("\"kind\": \"", "\"kind\": \"x")
                .contains("folds[0].kind must be \"mountain\"")
        );
        assert!(complaint("\"mm\"", "\"in\"").contains("units must be \"mm\", but is \"in\""));
        assert!(complaint("\"P01\"", "\"P00\"").contains("piece id like"));
        assert!(complaint("{ \"command\"", "{ ").contains("line 1, column"));
    }
}
