//! Wavefront OBJ: polygons, groups and seams. Texture coordinates and normals are not needed; what
//! else is passed over is noted.
//!
//! The group of a face is that of `g`. Without one it is the object of `o`, unless the faces of that
//! object have several materials: then, and without an object, it is the material of `usemtl`. So
//! what somebody coloured stays apart, and several objects stay apart as well.

use std::borrow::Cow;
use std::collections::HashMap;

use super::decode::name_text;
use super::raw::{GroupRun, RawMesh, SeamSegment};
use super::text::{Commas, Lines, without_comment, words};
use super::{ReadNote, quick};
use crate::io::error::{ContentFault, Located, excerpt};

const VERTEX_EXAMPLE: &str = "v 0 1.5 2";
const FACE_EXAMPLE: &str = "f 1 2 3";
/// The group whose `l` lines are seams.
const SEAM: &str = "seam";
/// The group of points and lines that the last step made, and of the long ones among the lines.
const MADE: &str = "made";
const STRIP: &str = "strip";
/// What follows the group of faces that the last step made.
const MADE_MARK: &str = " made";
/// What OBJ calls faces that belong to no group.
const NO_GROUP: &str = "default";
/// What programs write for faces that have no material.
const NO_MATERIAL: [&str; 2] = ["None", "(null)"];
/// Statements that make no shape, so nobody misses them.
const LOOKS: [&[u8]; 16] = [
    b"vt",
    b"vn",
    b"s",
    b"mg",
    b"mtllib",
    b"usemap",
    b"maplib",
    b"bevel",
    b"c_interp",
    b"d_interp",
    b"lod",
    b"shadow_obj",
    b"trace_obj",
    b"ctech",
    b"stech",
    b"vp",
];

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
    if bytes.contains(&0) {
        return Err(Located::anywhere(ContentFault::NotText { format: "OBJ" }));
    }
    let mut scan = Scan::default();
    let mut statements = Statements::new(bytes);
    while let Some((line, text)) = statements.lines.next() {
        if !scan.take_plain(line, text) {
            scan.take(&statements.whole(line, text))?;
        }
    }
    let raw = scan.finished();
    let count = raw.positions.len();
    let is_missing = |&v: &u32| v as usize >= count;
    let mut faces = 0..raw.ends.len();
    if let Some(face) = faces.find(|&face| raw.face(face).iter().any(is_missing)) {
        let index = raw.face(face).iter().copied().find(is_missing).unwrap_or_default();
        return Err(missing_vertex(bytes, raw.face_lines[face] as usize, index, count));
    }
    match raw.seams.iter().find(|seam| seam.ends.iter().any(is_missing)) {
        Some(seam) => Err(missing_vertex(bytes, seam.line, seam.ends[0].max(seam.ends[1]), count)),
        None => Ok(raw),
    }
}

/// The fault of the statement in a line that names a vertex beyond the last, counted from 0.
fn missing_vertex(bytes: &[u8], line: usize, vertex: u32, count: usize) -> Located {
    let statement = Statements::new(bytes).find(|statement| statement.line == line);
    let text = statement.map_or(Cow::default(), |statement| statement.text);
    Located::at(line, no_such_vertex(&text, i64::from(vertex) + 1, count))
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

impl<'a> Iterator for Statements<'a> {
    type Item = Statement<'a>;

    fn next(&mut self) -> Option<Statement<'a>> {
        let (line, first) = self.lines.next()?;
        Some(self.whole(line, first))
    }
}

impl<'a> Statements<'a> {
    fn new(bytes: &'a [u8]) -> Self {
        Self { lines: Lines::new(bytes) }
    }

    /// The statement that begins with a line.
    fn whole(&mut self, line: usize, first: &'a [u8]) -> Statement<'a> {
        let mut text = Cow::Borrowed(first);
        while let Some(tied) = tied_to_next(&text) {
            let mut joined = tied.to_vec();
            joined.push(b' ');
            if let Some((_, more)) = self.lines.next() {
                joined.extend_from_slice(more);
            }
            text = Cow::Owned(joined);
        }
        Statement { line, text }
    }
}

/// The text of a statement without its last backslash, when that ties the next line to it. A
/// backslash in a comment does not, nor one at the end of a name (`usemtl C:\textures\`).
fn tied_to_next(text: &[u8]) -> Option<&[u8]> {
    let tied = text.trim_ascii_end().strip_suffix(b"\\")?;
    let keyword = words(text).next().unwrap_or_default();
    let has_numbers = matches!(keyword, b"v" | b"vt" | b"vn" | b"vp" | b"f" | b"fo" | b"l" | b"p");
    let is_apart = tied.last().is_none_or(u8::is_ascii_whitespace);
    (!tied.contains(&b'#') && (has_numbers || is_apart)).then_some(tied)
}

/// What one pass over the statements keeps.
#[derive(Default)]
struct Scan {
    raw: RawMesh,
    object: Option<String>,
    group: Option<String>,
    material: Option<String>,
    /// How often an object began.
    objects: usize,
    /// Of every run of faces, what may name it besides its group.
    runs: Vec<RunNames>,
    commas: Commas,
    weights: Counted,
    passed_over: Counted,
}

/// What may name a run of faces besides `g`.
struct RunNames {
    object: usize,
    is_grouped: bool,
    material: Option<String>,
}

/// How often something came, and where first.
#[derive(Default, Clone, Copy)]
struct Counted {
    count: usize,
    first: usize,
}

impl Counted {
    fn add(&mut self, at: usize) {
        self.first = if self.count == 0 { at } else { self.first };
        self.count += 1;
    }
}

impl Scan {
    /// Takes a vertex or a face of the plainest form; returns whether the line is one.
    fn take_plain(&mut self, line: usize, text: &[u8]) -> bool {
        match text {
            [b'v', b' ', rest @ ..] => match quick::point(rest) {
                Some(point) => {
                    self.raw.positions.push(point);
                    self.raw.vertex_lines.push(line as u32);
                    true
                }
                None => false,
            },
            [b'f', b' ', rest @ ..] if quick::corners(rest, &mut self.raw.corners) => {
                self.raw.ends.push(self.raw.corners.len());
                self.raw.face_lines.push(line as u32);
                true
            }
            _ => false,
        }
    }

    fn take(&mut self, statement: &Statement) -> Result<(), Located> {
        let (keyword, rest) = statement.parts();
        match keyword {
            b"v" => self.vertex(statement)?,
            b"f" | b"fo" => self.face(statement)?,
            b"l" => self.line(statement)?,
            b"p" if self.is_group(MADE) => self.point(statement)?,
            b"o" => {
                self.object = name(rest);
                self.group = None;
                self.objects += 1;
                self.start_group();
            }
            b"usemtl" => {
                self.material = name(rest).filter(|name| !NO_MATERIAL.contains(&name.as_str()));
                self.start_material();
            }
            b"g" => {
                self.group = name(rest);
                self.start_group();
            }
            [] | [b'#', ..] => {}
            _ if LOOKS.contains(&keyword) => {}
            _ => self.passed_over.add(statement.line),
        }
        Ok(())
    }

    /// The raw mesh with its notes.
    fn finished(mut self) -> RawMesh {
        self.name_by_material();
        let Counted { count, first } = self.weights;
        let weights = (count > 0).then_some(ReadNote::Weights { count, first });
        let Counted { count, first } = self.passed_over;
        let passed_over = (count > 0).then_some(ReadNote::PassedOver { count, first_line: first });
        self.raw.notes.extend(self.commas.note().into_iter().chain(weights).chain(passed_over));
        self.raw
    }

    /// `v x y z`, with a weight after them or a colour.
    fn vertex(&mut self, statement: &Statement) -> Result<(), Located> {
        let (_, rest) = statement.parts();
        let fault = || {
            let text = excerpt(&statement.text);
            let fault = ContentFault::NotAVertex { text, example: VERTEX_EXAMPLE };
            Located::at(statement.line, fault)
        };
        let all: Vec<&[u8]> = words(without_comment(rest)).collect();
        let mut position =
            self.commas.point(all.iter().copied(), statement.line).ok_or_else(fault)?;
        match all.len() {
            3 | 6.. => {}
            4 => {
                let weight = self.commas.number(all[3], statement.line).ok_or_else(fault)?;
                if weight == 0.0 || !weight.is_finite() {
                    return Err(fault());
                }
                if weight != 1.0 {
                    position /= weight;
                    self.weights.add(self.raw.positions.len());
                }
            }
            _ => return Err(fault()),
        }
        self.raw.positions.push(position);
        self.raw.vertex_lines.push(statement.line as u32);
        Ok(())
    }

    /// `f 1 2 3`. A number beyond the vertices so far may still come.
    fn face(&mut self, statement: &Statement) -> Result<(), Located> {
        let (_, rest) = statement.parts();
        let count = self.raw.positions.len();
        for word in words(without_comment(rest)) {
            let index = index(word).filter(|_| is_corner(word)).ok_or_else(|| {
                let text = excerpt(&statement.text);
                let fault = ContentFault::NotAFace { text, example: FACE_EXAMPLE };
                Located::at(statement.line, fault)
            })?;
            let vertex = resolve(index, count).ok_or_else(|| {
                Located::at(statement.line, no_such_vertex(&statement.text, index, count))
            })?;
            self.raw.corners.push(vertex);
        }
        self.raw.ends.push(self.raw.corners.len());
        self.raw.face_lines.push(statement.line as u32);
        Ok(())
    }

    fn start_group(&mut self) {
        let name = self.group.clone().or_else(|| self.object.clone());
        let unmarked = name.as_ref().and_then(|name| name.strip_suffix(MADE_MARK));
        let (name, is_made) = match unmarked {
            Some(unmarked) => (Some(unmarked.trim_end().to_owned()), true),
            None => (name, false),
        };
        // `g default` says that there is none, so no material takes its place.
        let is_grouped = self.group.is_some();
        let name = name.filter(|name| name != NO_GROUP);
        self.raw.groups.push(GroupRun { first_face: self.raw.face_lines.len(), name, is_made });
        let material = self.material.clone();
        self.runs.push(RunNames { object: self.objects, is_grouped, material });
    }

    /// Begins a run of faces, unless the last one has none yet.
    fn start_material(&mut self) {
        let next = self.raw.face_lines.len();
        match self.raw.groups.last().zip(self.runs.last_mut()) {
            Some((run, names)) if run.first_face == next => {
                names.material.clone_from(&self.material);
            }
            _ => self.start_group(),
        }
    }

    /// Gives runs without a group the name of their material, where that says more than the object.
    fn name_by_material(&mut self) {
        let mut materials: HashMap<usize, &Option<String>> = HashMap::new();
        let mut mixed: Vec<usize> = Vec::new();
        let ends = self.raw.groups.iter().skip(1).map(|run| run.first_face);
        let ends: Vec<usize> = ends.chain([self.raw.face_lines.len()]).collect();
        let has_faces = |(run, &end): (&GroupRun, &usize)| run.first_face < end;
        let has_faces: Vec<bool> = self.raw.groups.iter().zip(&ends).map(has_faces).collect();
        for (names, _) in self.runs.iter().zip(&has_faces).filter(|(n, has)| **has && !n.is_grouped)
        {
            if *materials.entry(names.object).or_insert(&names.material) != &names.material {
                mixed.push(names.object);
            }
        }
        mixed.dedup();
        for (run, names) in self.raw.groups.iter_mut().zip(&self.runs) {
            let is_mixed = mixed.binary_search(&names.object).is_ok();
            if !names.is_grouped && (is_mixed || run.name.is_none()) {
                run.name = names.material.clone().or(run.name.take());
            }
        }
    }

    fn is_group(&self, name: &str) -> bool {
        let is_name = |n: &Option<String>| n.as_ref().is_some_and(|n| n.eq_ignore_ascii_case(name));
        is_name(&self.group) || is_name(&self.object)
    }

    /// `p 1 2` of the group `made`: vertices that the last step made.
    fn point(&mut self, statement: &Statement) -> Result<(), Located> {
        let vertices = self.vertices(statement, 1)?;
        self.raw.made.vertices.extend(vertices);
        Ok(())
    }

    /// `l 1 2 3`: a seam, or edges that the last step made.
    fn line(&mut self, statement: &Statement) -> Result<(), Located> {
        if !(self.is_group(SEAM) || self.is_group(MADE) || self.is_group(STRIP)) {
            self.passed_over.add(statement.line);
            return Ok(());
        }
        let vertices = self.vertices(statement, 2)?;
        let pairs = vertices.windows(2).map(|w| [w[0], w[1]]);
        if self.is_group(MADE) {
            self.raw.made.edges.extend(pairs);
        } else if self.is_group(STRIP) {
            self.raw.made.strip.extend(pairs);
        } else {
            let line = statement.line;
            self.raw.seams.extend(pairs.map(|ends| SeamSegment { line, ends }));
        }
        Ok(())
    }

    /// The vertices that a line or point names, at least so many.
    fn vertices(&self, statement: &Statement, least: usize) -> Result<Vec<u32>, Located> {
        let (_, rest) = statement.parts();
        let count = self.raw.positions.len();
        let indices: Option<Vec<i64>> = words(without_comment(rest)).map(index).collect();
        let fault = |fault| Located::at(statement.line, fault);
        let not_a_seam = || fault(ContentFault::NotASeam { text: excerpt(&statement.text) });
        let indices = indices.filter(|i| i.len() >= least).ok_or_else(not_a_seam)?;
        let resolved = indices.into_iter().map(|i| {
            resolve(i, count).ok_or_else(|| fault(no_such_vertex(&statement.text, i, count)))
        });
        resolved.collect()
    }
}

/// The name of a group or object; a comment begins at a `#` after white space.
fn name(rest: &[u8]) -> Option<String> {
    let comment = rest.windows(2).position(|w| w[0].is_ascii_whitespace() && w[1] == b'#');
    let name = rest[..comment.unwrap_or(rest.len())].trim_ascii();
    (!name.is_empty()).then(|| name_text(name))
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

fn is_corner(word: &[u8]) -> bool {
    let mut parts = word.split(|&b| b == b'/');
    let is_index = |part: &[u8]| part.is_empty() || index(part).is_some();
    parts.by_ref().take(3).all(is_index) && parts.next().is_none()
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

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
    fn a_backslash_in_a_comment_or_a_name_ties_no_line() {
        for line in ["# floor \\", "#\\", "usemtl C:\\new\\", "g a\\", "v 0 0 1 # above \\"] {
            let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{line}\nf 1 2 3\n");
            let raw = read(text.as_bytes()).expect("an OBJ");
            assert_eq!(faces(&raw), [[0, 1, 2]], "{line}");
        }
        let raw = read(b"v 0 0 0\nv 1 0 0\nv 0 1 0\ng a \\\nb\nfo 1 2 \\\n3\n").expect("an OBJ");
        assert_eq!(raw.groups[0].name.as_deref(), Some("a  b"));
        assert_eq!(faces(&raw), [[0, 1, 2]]);
    }

    #[test]
    fn weights_divide_and_commas_are_decimal_and_both_are_noted() {
        let raw = read(b"v 0 0 0 1\nv 3 6 -9 3\nv 1,5 0 2e1 1,0\nf 1 2 3\n").expect("an OBJ");
        assert_eq!(raw.positions[1..], [DVec3::new(1., 2., -3.), DVec3::new(1.5, 0., 20.)]);
        let commas = ReadNote::DecimalCommas { count: 2, first_line: 3 };
        assert_eq!(raw.notes, [commas, ReadNote::Weights { count: 1, first: 1 }]);
        assert!(read(b"v 1,2,3\n").is_err() && read(b"v 1, 2, 3\n").is_err());
    }

    #[test]
    fn what_is_passed_over_is_noted_and_names_may_be_latin() {
        let text =
            b"v 0 0 0\nv 1 0 0\nv 0 1 0\ncstype bezier\nl 1 2\ng W\xe4nde\nvt 0 0\nf 1 2 3\n";
        let raw = read(text).expect("an OBJ");
        assert_eq!(raw.notes, [ReadNote::PassedOver { count: 2, first_line: 4 }]);
        assert_eq!(raw.groups[0].name.as_deref(), Some("Wände"));
    }

    #[test]
    fn materials_are_groups_where_neither_group_nor_object_tells_faces_apart() {
        let groups = |middle: &str| {
            let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{middle}");
            let raw = read(text.as_bytes()).expect("an OBJ");
            let last = raw.face_lines.len();
            let ends = raw.groups.iter().skip(1).map(|run| run.first_face).chain([last]);
            let runs = raw.groups.iter().zip(ends).filter(|(run, end)| run.first_face < *end);
            runs.map(|(run, _)| run.name.clone().unwrap_or_default()).collect::<Vec<_>>()
        };
        let f = "f 1 2 3\n";
        // No object; one object of two colours; two objects of one colour each.
        assert_eq!(groups(&format!("usemtl red\n{f}usemtl deep blue\n{f}")), ["red", "deep blue"]);
        assert_eq!(groups(&format!("o box\nusemtl red\n{f}usemtl blue\n{f}")), ["red", "blue"]);
        let two = format!("o a\nusemtl red\n{f}o b\n{f}");
        assert_eq!(groups(&two), ["a", "b"]);
        // A group wins, and `None` is no material.
        assert_eq!(groups(&format!("g lid\nusemtl red\n{f}usemtl blue\n{f}")), ["lid", "lid"]);
        assert_eq!(groups(&format!("usemtl None\n{f}usemtl (null)\n{f}")), ["", ""]);
        assert_eq!(groups(&format!("g default\nusemtl red\n{f}g\n{f}")), ["", "red"]);
        // Faces without a material keep the object's name.
        assert_eq!(groups(&format!("o box\n{f}usemtl red\n{f}")), ["box", "red"]);
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
