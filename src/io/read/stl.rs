//! STL, text and binary: triangles without shared vertices, welded where their coordinates are
//! equal.

use glam::{DVec3, Vec3};

use super::raw::RawMesh;
use super::text::{Commas, Lines, words};
use super::{ReadNote, quick};
use crate::io::error::{ContentFault, Located, excerpt};
use crate::mend::first_equal;

const HEADER: usize = 80;
const TRIANGLE: usize = 50;

/// The corners of all triangles, three for each, and their lines.
#[derive(Default)]
struct Soup {
    corners: Vec<DVec3>,
    corner_lines: Vec<u32>,
    triangle_lines: Vec<u32>,
    notes: Vec<ReadNote>,
}

/// Reads `bytes` as binary STL or else their `text`, which has lost its mark and its padding.
/// Triangles of which two corners are one are dropped and noted.
pub(super) fn read(bytes: &[u8], text: &[u8]) -> Result<RawMesh, Located> {
    let soup = if is_binary(bytes) || !is_text(text) { binary(bytes)? } else { of_text(text)? };
    if let Some(corner) = soup.corners.iter().position(|p| !p.is_finite()) {
        let line = soup.corner_lines.get(corner).map(|&line| line as usize);
        return Err(Located {
            line,
            fault: ContentFault::TriangleNotFinite { triangle: corner / 3 },
        });
    }
    Ok(welded(soup))
}

/// Whether the length is what the number of triangles in a binary header asks for. Some binary
/// files begin with `solid`.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    announced(bytes)
        .is_some_and(|count| (bytes.len() - HEADER - 4) as u64 == count * TRIANGLE as u64)
}

/// Whether this is STL as text: it begins with `solid`, or with `facet` where that line is missing.
fn is_text(text: &[u8]) -> bool {
    let start = text.trim_ascii_start().get(..5).unwrap_or_default();
    let begins = [b"solid", b"facet"].iter().any(|word| start.eq_ignore_ascii_case(*word));
    begins && !text.contains(&0)
}

fn announced(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER..HEADER + 4)?.first_chunk::<4>()?;
    Some(u64::from(u32::from_le_bytes(*count)))
}

fn binary(bytes: &[u8]) -> Result<Soup, Located> {
    let Some(count) = announced(bytes) else {
        return Err(Located::anywhere(ContentFault::NotThisFormat {
            format: "STL",
            text: excerpt(bytes),
        }));
    };
    let body = &bytes[HEADER + 4..];
    // Some programs write more after the triangles, none writes less.
    if ((body.len() / TRIANGLE) as u64) < count {
        let fault =
            ContentFault::CountTooLarge { element: "triangle".into(), count, bytes: body.len() };
        return Err(Located::anywhere(fault));
    }
    let corners = body.chunks_exact(TRIANGLE).take(count as usize).flat_map(|triangle| {
        let coordinate =
            |i: usize| triangle[4 * i..].first_chunk::<4>().map_or(0.0, |b| f32::from_le_bytes(*b));
        // The first three numbers are the normal.
        [3, 6, 9].map(|i| Vec3::new(coordinate(i), coordinate(i + 1), coordinate(i + 2)).as_dvec3())
    });
    let rest = body[count as usize * TRIANGLE..].iter().rposition(|&b| b != 0);
    Ok(Soup {
        corners: corners.collect(),
        notes: rest.map(|last| ReadNote::Rest { bytes: last + 1 }).into_iter().collect(),
        ..Soup::default()
    })
}

fn of_text(text: &[u8]) -> Result<Soup, Located> {
    let mut soup = Soup::default();
    let mut commas = Commas::default();
    for (line, text) in Lines::new(text) {
        if let Some(corner) = plain_vertex(text) {
            soup.corners.push(corner);
            soup.corner_lines.push(line as u32);
            continue;
        }
        let mut words = words(text);
        let Some(first) = words.next() else { continue };
        let keyword = keyword(first, &mut words);
        let is = |name: &[u8]| keyword == name;
        let started = soup.corners.len() - 3 * soup.triangle_lines.len();
        let fault = |wanted| {
            let triangle = soup.triangle_lines.len();
            Located::at(line, ContentFault::BadTriangle { text: excerpt(text), triangle, wanted })
        };
        if is(b"vertex") {
            let corner = commas
                .point(words, line)
                .ok_or_else(|| fault("a vertex needs three numbers, as in `vertex 0 1.5 2`"))?;
            soup.corners.push(corner);
            soup.corner_lines.push(line as u32);
        } else if is(b"endloop") {
            if started != 3 {
                return Err(fault("a triangle needs three `vertex` lines"));
            }
            soup.triangle_lines.push(line as u32 - 3);
        } else if [&b"solid"[..], b"facet", b"outerloop", b"endfacet", b"endsolid"]
            .into_iter()
            .any(is)
        {
            if started != 0 {
                return Err(fault("a triangle needs three `vertex` lines and an `endloop`"));
            }
        } else {
            return Err(fault("remove the line"));
        }
    }
    match soup.corners.len() - 3 * soup.triangle_lines.len() {
        0 => {
            soup.notes.extend(commas.note());
            Ok(soup)
        }
        _ => {
            let index = soup.triangle_lines.len();
            Err(Located::anywhere(ContentFault::CutShort {
                element: "triangle".into(),
                index,
                count: index + 1,
            }))
        }
    }
}

/// A corner of the plainest form, `vertex 0 1.5 2`.
fn plain_vertex(text: &[u8]) -> Option<DVec3> {
    quick::point(text.trim_ascii_start().strip_prefix(b"vertex ")?)
}

/// The keyword of a line in small letters; `end loop` is `endloop`.
fn keyword<'a>(first: &[u8], rest: &mut impl Iterator<Item = &'a [u8]>) -> Vec<u8> {
    let mut keyword = first.to_ascii_lowercase();
    if [&b"end"[..], b"outer"].contains(&&*keyword) {
        keyword.extend(rest.next().unwrap_or_default().to_ascii_lowercase());
    }
    keyword
}

/// Gives equal corners one number, in the order in which they first come, and drops triangles that
/// lose a corner.
fn welded(soup: Soup) -> RawMesh {
    let first = first_equal(&soup.corners);
    let mut raw =
        RawMesh { face_lines: soup.triangle_lines, notes: soup.notes, ..RawMesh::default() };
    let mut numbers = vec![0; first.len()];
    for (corner, &at) in first.iter().enumerate() {
        if at as usize == corner {
            numbers[corner] = raw.positions.len() as u32;
            raw.positions.push(soup.corners[corner]);
            raw.vertex_lines.extend(soup.corner_lines.get(corner));
        }
    }
    raw.corners = first.iter().map(|&at| numbers[at as usize]).collect();
    raw.ends = (1..=first.len() / 3).map(|triangle| 3 * triangle).collect();
    raw.drop_flat_triangles();
    raw
}

#[cfg(test)]
mod tests {
    use super::super::decode::as_utf8;
    use super::*;

    fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
        super::read(bytes, &as_utf8(bytes))
    }

    const TEXT: &str = "solid two parts\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   \
    vertex 1 0 0\n   vertex 0 1 0\n  endloop\n \
        endfacet\n FACET NORMAL 0 0 1\n OUTER LOOP\n VERTEX 1 0 -0\n VERTEX 1 1 0\n VERTEX 0 1 0\n ENDLOOP\n ENDFACET\nendsolid two parts\n";

    fn binary_file(header: &[u8], triangles: &[[f32; 9]]) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn text_and_binary_are_welded_alike() {
        let triangles =
            [[0., 0., 0., 1., 0., 0., 0., 1., 0.], [1., 0., -0., 1., 1., 0., 0., 1., 0.]];
        // The header of a binary file may begin as a text file does.
        let from_binary = read(&binary_file(b"solid two parts", &triangles)).expect("an STL");
        let from_text = read(TEXT.as_bytes()).expect("an STL");
        assert_eq!(
            from_binary.positions,
            [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1., 1., 0.)]
        );
        assert_eq!(from_binary.corners, [0, 1, 2, 1, 3, 2]);
        assert_eq!(
            (&from_text.positions, &from_text.corners),
            (&from_binary.positions, &from_binary.corners)
        );
        assert_eq!(
            (from_text.vertex_lines, from_text.face_lines),
            (vec![4, 5, 6, 12], vec![4, 11])
        );
    }

    #[test]
    fn triangles_that_lose_a_corner_are_dropped_and_counted() {
        let flat = [1., 1., 1., 1., 1., 1., 2., 2., 2.];
        let good = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
        let raw = read(&binary_file(b"", &[flat, good, flat])).expect("an STL");
        let dropped = ReadNote::DroppedFaces { count: 2, first: 0 };
        assert_eq!((raw.ends.len(), raw.notes.as_slice()), (1, &[dropped][..]));
        assert_eq!(raw.file_face(0), 1);
    }

    #[test]
    fn dialects_and_padding_are_read() {
        let plain = read(TEXT.as_bytes()).expect("an STL");
        let apart = TEXT.replace("endloop", "end loop").replace("endfacet", "end facet");
        for text in [
            format!("\u{feff}{TEXT}"),
            format!("{TEXT}\0\0\0"),
            TEXT.replace("solid two parts\n facet", "facet"),
            apart.replace("endsolid", "end solid"),
            TEXT.replace("0 1 0", "0,0 1,0 0"),
        ] {
            let raw = read(text.as_bytes()).expect(&text);
            assert_eq!(
                (&raw.positions, &raw.corners),
                (&plain.positions, &plain.corners),
                "{text}"
            );
        }
        let mut longer = binary_file(b"", &[[0., 0., 0., 1., 0., 0., 0., 1., 0.]]);
        longer.extend([7, 7, 0, 0]);
        assert_eq!(read(&longer).expect("an STL").notes, [ReadNote::Rest { bytes: 2 }]);
    }

    #[test]
    fn what_is_broken_is_named() {
        let fault = |bytes: &[u8]| read(bytes).expect_err("a fault");
        let whole = binary_file(b"x", &[[0.; 9], [1.; 9]]);
        assert!(matches!(
            fault(&whole[..120]).fault,
            ContentFault::CountTooLarge { count: 2, bytes: 36, .. }
        ));
        assert!(matches!(fault(b"nonsense").fault, ContentFault::NotThisFormat { .. }));
        let mut nan = [0.0; 9];
        nan[4] = f32::NAN;
        assert_eq!(
            fault(&binary_file(b"", &[[0.; 9], nan])).fault,
            ContentFault::TriangleNotFinite { triangle: 1 }
        );
        let altered = |from: &str, to: &str| fault(TEXT.replacen(from, to, 1).as_bytes());
        assert_eq!(altered("vertex 1 0 0", "vertex 1 zero 0").line, Some(5));
        assert_eq!(altered("   vertex 1 0 0\n", "").line, Some(6));
        assert_eq!(altered("  endloop\n", "").line, Some(7));
        assert_eq!(altered("vertex 1 0 0", "vertex 1 inf 0").line, Some(5));
        let cut = fault(&TEXT.as_bytes()[..TEXT.find("VERTEX 0 1").expect("there")]);
        assert!(matches!(cut.fault, ContentFault::CutShort { index: 1, .. }));
        // A file that ends between its triangles is only seen by its rims.
        assert!(read(b"solid\nendsolid\n").expect("an STL").ends.is_empty());
    }
}
