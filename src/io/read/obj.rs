//! Wavefront OBJ: polygons, groups and seams.
//!
//! The `tobj` crate parses positions and faces. It numbers positions by their first use within each
//! object and names no lines, and a contract of ours is that the n-th `v` line is vertex n − 1. So
//! it gets a text with one object, whose first face lists all vertices in order: numbering by first
//! use then changes nothing. Groups and seams are read here, texture coordinates, normals and
//! materials are not needed.

use std::borrow::Cow;

use glam::DVec3;
use tobj::LoadError;

use super::raw::{GroupRun, RawMesh, SeamSegment};
use super::text::{Lines, number, without_comment, words};
use crate::io::error::{ContentFault, Located, excerpt};

const VERTEX_EXAMPLE: &str = "v 0 1.5 2";
const FACE_EXAMPLE: &str = "f 1 2 3";
/// The group whose `l` lines are seams.
const SEAM: &str = "seam";
/// What OBJ calls faces that belong to no group.
const NO_GROUP: &str = "default";

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
    if bytes.contains(&0) {
        return Err(Located::anywhere(ContentFault::NotText { format: "OBJ" }));
    }
    let mut scan = Scan::default();
    for statement in Statements::new(bytes) {
        scan.take(&statement)?;
    }
    let mut raw = scan.raw;
    let count = raw.vertex_lines.len();
    parse(&scan.text, &mut raw).map_err(|error| locate(bytes, &error, count))?;
    match raw.seams.iter().find(|seam| seam.ends.iter().any(|&v| v as usize >= count)) {
        Some(seam) => Err(missing_seam_end(bytes, *seam, count)),
        None => Ok(raw),
    }
}

fn missing_seam_end(bytes: &[u8], seam: SeamSegment, count: usize) -> Located {
    let statement = Statements::new(bytes).find(|statement| statement.line == seam.line);
    let text = statement.map_or(Cow::default(), |statement| statement.text);
    let index = i64::from(seam.ends[0].max(seam.ends[1])) + 1;
    Located::at(seam.line, no_such_vertex(&text, index, count))
}

/// Lets tobj read the positions and faces.
fn parse(statements: &[u8], raw: &mut RawMesh) -> Result<(), LoadError> {
    let count = raw.vertex_lines.len();
    let mut all_vertices = String::with_capacity(8 * count + 2);
    all_vertices.push('f');
    for i in 1..=count {
        all_vertices.push(' ');
        all_vertices.push_str(&i.to_string());
    }
    all_vertices.push('\n');
    let mut text = std::io::Read::chain(all_vertices.as_bytes(), statements);
    let no_materials = |_: &std::path::Path| Err(LoadError::GenericFailure);
    let (models, _) = tobj::load_obj_buf(&mut text, &tobj::LoadOptions::default(), no_materials)?;
    let mesh = models.into_iter().next().ok_or(LoadError::GenericFailure)?.mesh;
    raw.positions = mesh.positions.chunks_exact(3).map(DVec3::from_slice).collect();
    raw.corners = mesh.indices.get(count..).unwrap_or_default().to_vec();
    let mut end = 0;
    // tobj leaves the numbers of corners out when all faces are triangles.
    let sides = mesh
        .face_arities
        .get(1..)
        .map(Cow::Borrowed)
        .unwrap_or_else(|| vec![3; raw.face_lines.len()].into());
    raw.ends.extend(sides.iter().map(|&n| {
        end += n as usize;
        end
    }));
    Ok(())
}

/// One statement: a line with the lines that a backslash ties to it.
struct Statement<'a> {
    line: usize,
    text: Cow<'a, [u8]>,
}

impl Statement<'_> {
    /// The first word and the rest.
    fn parts(&self) -> (&[u8], &[u8]) {
        let text = self.text.trim_ascii();
        text.split_at(text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len()))
    }
}

struct Statements<'a> {
    lines: Lines<'a>,
}

impl<'a> Statements<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { lines: Lines::new(bytes) }
    }
}

impl<'a> Iterator for Statements<'a> {
    type Item = Statement<'a>;

    fn next(&mut self) -> Option<Statement<'a>> {
        let (line, first) = self.lines.next()?;
        let mut text = Cow::Borrowed(first);
        while let Some(tied) = text.trim_ascii_end().strip_suffix(b"\\") {
            let mut joined = tied.to_vec();
            joined.push(b' ');
            if let Some((_, more)) = self.lines.next() {
                joined.extend_from_slice(more);
            }
            text = Cow::Owned(joined);
        }
        Some(Statement { line, text })
    }
}

/// What one pass over the statements keeps: the text for tobj, and what tobj does not read.
#[derive(Default)]
struct Scan {
    text: Vec<u8>,
    raw: RawMesh,
    object: Option<String>,
    group: Option<String>,
}

impl Scan {
    fn take(&mut self, statement: &Statement) -> Result<(), Located> {
        let (keyword, rest) = statement.parts();
        match keyword {
            b"v" => {
                self.raw.vertex_lines.push(statement.line as u32);
                self.pass_on(b'v', coordinates(without_comment(rest)));
            }
            b"f" => {
                self.raw.face_lines.push(statement.line as u32);
                self.pass_on(b'f', without_comment(rest));
            }
            b"l" => return self.seam(statement),
            b"o" => {
                self.object = name(rest);
                self.group = None;
                self.start_group();
            }
            b"g" => {
                self.group = name(rest);
                self.start_group();
            }
            _ => {}
        }
        Ok(())
    }

    fn pass_on(&mut self, keyword: u8, rest: &[u8]) {
        self.text.push(keyword);
        self.text.push(b' ');
        self.text.extend_from_slice(rest);
        self.text.push(b'\n');
    }

    fn start_group(&mut self) {
        let name =
            self.group.clone().or_else(|| self.object.clone()).filter(|name| name != NO_GROUP);
        self.raw.groups.push(GroupRun { first_face: self.raw.face_lines.len(), name });
    }

    fn seam(&mut self, statement: &Statement) -> Result<(), Located> {
        let is_seam =
            |name: &Option<String>| name.as_ref().is_some_and(|n| n.eq_ignore_ascii_case(SEAM));
        if !is_seam(&self.group) && !is_seam(&self.object) {
            return Ok(());
        }
        let (_, rest) = statement.parts();
        let count = self.raw.vertex_lines.len();
        let indices: Option<Vec<i64>> = words(without_comment(rest)).map(index).collect();
        let fault = |fault| Located::at(statement.line, fault);
        let not_a_seam = || fault(ContentFault::NotASeam { text: excerpt(&statement.text) });
        let indices = indices.filter(|i| i.len() >= 2).ok_or_else(not_a_seam)?;
        let vertices: Result<Vec<u32>, Located> = indices
            .into_iter()
            .map(|i| {
                resolve(i, count).ok_or_else(|| fault(no_such_vertex(&statement.text, i, count)))
            })
            .collect();
        let segments = vertices?;
        let segments =
            segments.windows(2).map(|w| SeamSegment { line: statement.line, ends: [w[0], w[1]] });
        self.raw.seams.extend(segments);
        Ok(())
    }
}

/// The coordinates of a `v` line without a colour after them, which tobj takes only when every
/// vertex has one.
fn coordinates(rest: &[u8]) -> &[u8] {
    let mut ends = rest.iter().enumerate().filter(|&(i, b)| {
        !b.is_ascii_whitespace() && rest.get(i + 1).is_none_or(u8::is_ascii_whitespace)
    });
    match (ends.nth(2), ends.nth(2)) {
        (Some((third, _)), Some(_)) => &rest[..=third],
        _ => rest,
    }
}

/// The name of a group or object; a comment begins at a `#` after white space.
fn name(rest: &[u8]) -> Option<String> {
    let comment = rest.windows(2).position(|w| w[0].is_ascii_whitespace() && w[1] == b'#');
    let name = rest[..comment.unwrap_or(rest.len())].trim_ascii();
    (!name.is_empty()).then(|| String::from_utf8_lossy(name).into_owned())
}

/// The position index of a corner (`7`, `7/1`, `7//3`, `-1`).
fn index(word: &[u8]) -> Option<i64> {
    std::str::from_utf8(word.split(|&b| b == b'/').next()?).ok()?.parse().ok()
}

/// The vertex that an index names when `count` vertices came before; negative indices count back
/// from the last.
fn resolve(index: i64, count: usize) -> Option<u32> {
    let zero_based =
        if index < 0 { i64::try_from(count).ok()?.checked_add(index)? } else { index - 1 };
    u32::try_from(zero_based).ok()
}

fn no_such_vertex(text: &[u8], index: i64, count: usize) -> ContentFault {
    ContentFault::NoSuchVertex { text: excerpt(text), index, count }
}

/// The first statement that brings tobj to its error, which carries no line.
fn locate(bytes: &[u8], error: &LoadError, count: usize) -> Located {
    let mut vertices = 0;
    for statement in Statements::new(bytes) {
        let (keyword, rest) = statement.parts();
        let fault = match keyword {
            b"v" => {
                vertices += 1;
                let fault = || ContentFault::NotAVertex {
                    text: excerpt(&statement.text),
                    example: VERTEX_EXAMPLE,
                };
                (!is_vertex(without_comment(rest))).then(fault)
            }
            b"f" => face_fault(&statement.text, without_comment(rest), vertices, count),
            _ => None,
        };
        if let Some(fault) = fault {
            return Located::at(statement.line, fault);
        }
    }
    Located::anywhere(ContentFault::NotThisFormat {
        format: "OBJ",
        text: format!("{}; {error}", excerpt(bytes)),
    })
}

/// What is wrong with a face after `before` of `count` vertices.
fn face_fault(text: &[u8], corners: &[u8], before: usize, count: usize) -> Option<ContentFault> {
    let indices: Option<Vec<i64>> = words(corners).map(index).collect();
    let Some(indices) = indices.filter(|_| words(corners).all(is_corner)) else {
        return Some(ContentFault::NotAFace { text: excerpt(text), example: FACE_EXAMPLE });
    };
    let is_missing = |&i: &i64| resolve(i, before).is_none_or(|v| v as usize >= count);
    indices.into_iter().find(is_missing).map(|i| no_such_vertex(text, i, count))
}

fn is_vertex(rest: &[u8]) -> bool {
    let numbers: Option<Vec<f64>> = words(coordinates(rest)).map(number).collect();
    // A fourth number divides the other three.
    numbers.is_some_and(|n| n.len() == 3 || n.len() == 4 && n[3] != 0.0)
}

fn is_corner(word: &[u8]) -> bool {
    let mut parts = word.split(|&b| b == b'/');
    let is_index = |part: &[u8]| part.is_empty() || index(part).is_some();
    parts.by_ref().take(3).all(is_index) && parts.next().is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn faces(raw: &RawMesh) -> Vec<&[u32]> {
        (0..raw.ends.len()).map(|f| raw.face(f)).collect()
    }

    #[test]
    fn the_order_of_the_file_is_kept_whatever_the_faces_use_first() {
        let raw =
            read(b"v 0 0 0\nv 1 0 0\nv 9 9 9\nv 0 1 0\nf 4 2 1\nf -4 -3 -1\n").expect("an OBJ");
        assert_eq!(raw.positions[2], DVec3::splat(9.0));
        assert_eq!(raw.positions[3], DVec3::Y);
        assert_eq!(faces(&raw), [[3, 1, 0], [0, 1, 3]]);
        assert_eq!((raw.vertex_lines, raw.face_lines), (vec![1, 2, 3, 4], vec![5, 6]));
    }

    #[test]
    fn all_the_usual_spellings_are_read() {
        let text = "\u{feff}# made by hand\r\nmtllib none.mtl\r\no thing\r\nv 0 0 0 1.0 # w\r\n\tv \
        1 0 0 0.5 0.5 0.5\r\nv 1 1 \\\r\n0\r\n\
            v 0 1 0 0.1 0.2 0.3 1\r\nvt 0 0\r\nvn 0 0 1\r\nusemtl red\r\ng left hand\r\nf 1/1/1 2//1 3/1 4/1/1#x\r\n\
            g\r\nf 1/-1/-1 2 \\\r\n 3\r\ng default\r\nf 1 2 4\r\ns off\r\np 1\r\nl 1 2\r\n";
        let raw = read(text.as_bytes()).expect("an OBJ");
        assert_eq!(raw.positions, [DVec3::ZERO, DVec3::X, DVec3::new(1., 1., 0.), DVec3::Y]);
        assert_eq!(faces(&raw), [&[0, 1, 2, 3][..], &[0, 1, 2], &[0, 1, 3]]);
        let groups: Vec<_> =
            raw.groups.iter().map(|run| (run.first_face, run.name.as_deref())).collect();
        assert_eq!(
            groups,
            [(0, Some("thing")), (0, Some("left hand")), (1, Some("thing")), (2, None)]
        );
        assert!(raw.seams.is_empty());
    }

    #[test]
    fn seams_are_the_lines_of_the_group_or_object_of_that_name() {
        let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        for name in ["g seam", "o seam", "o Seam\ng seam"] {
            let raw =
                read(format!("{corners}l 1 2\n{name}\nl 1/1 2/2 -1\ng rest\nl 1 2\n").as_bytes());
            let ends: Vec<_> = raw.expect("an OBJ").seams.iter().map(|s| s.ends).collect();
            assert_eq!(ends[..2], [[0, 1], [1, 2]], "{name}");
        }
    }

    #[test]
    fn any_number_of_vertices_is_numbered_right() {
        for count in 0..6 {
            let text: String = (0..count).map(|i| format!("v {i} 0 0\n")).collect();
            let raw = read(text.as_bytes()).expect("an OBJ");
            assert_eq!((raw.positions.len(), raw.ends.len()), (count, 0));
        }
        let raw = read(b"v 0 0 0\nf\nf 1\nf 1 1\n").expect("an OBJ");
        assert_eq!(raw.ends, [0, 1, 3]);
    }

    #[test]
    fn faults_carry_their_lines() {
        let fault = |text: &str| read(text.as_bytes()).expect_err("a fault");
        let line = |text: &str| fault(text).line;
        assert_eq!(line("v 0 0 0\n\nv 0 zero 0\nf 1 2 x\n"), Some(3));
        assert_eq!(line("v 0 0 0\nv 0 0\n"), Some(2));
        assert_eq!(line("v 1 1 1 0\n"), Some(1));
        assert_eq!(line("v 1 1 1 0 0\n"), Some(1));
        assert_eq!(line("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 two 3\n"), Some(5));
        assert_eq!(line("v 0 0 0\nf 1/1/1/1\n"), Some(2));
        assert_eq!(line("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n"), Some(5));
        assert_eq!(line("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n"), Some(4));
        assert_eq!(line("v 0 0 0\nv 1 0 0\nf -1 -2 -3\nv 0 1 0\n"), Some(3));
        assert_eq!(line("v 0 0 0\nf /1 1 1\n"), Some(2));
        assert_eq!(line("v 0 0 0\ng seam\nl 1\n"), Some(3));
        assert_eq!(line("v 0 0 0\ng seam\nl 1 2\n"), Some(3));
        assert_eq!(line("v 0 0 0\nf 1 99999999999999999999 1\n"), Some(2));
        assert_eq!(fault("v\0").fault, ContentFault::NotText { format: "OBJ" });
    }
}
