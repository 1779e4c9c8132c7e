//! Object File Format: polygons as text. Normals, colours and texture coordinates are not needed.

use glam::DVec3;

use super::raw::RawMesh;
use super::text::{Lines, number, words};
use crate::io::error::{ContentFault, Located, excerpt};

/// First words of the variants whose vertices begin with three coordinates.
const VARIANTS: [&[u8]; 6] = [b"OFF", b"COFF", b"NOFF", b"CNOFF", b"STOFF", b"STCNOFF"];
const VERTEX_EXAMPLE: &str = "0 1.5 2";
const FACE_EXAMPLE: &str = "3 0 1 2";

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
    if bytes.contains(&0) {
        return Err(Located::anywhere(ContentFault::NotText { format: "OFF" }));
    }
    let mut lines = Lines::new(bytes);
    let [vertices, faces] = counts(&mut lines)?;
    let left = lines.rest().len();
    for (element, count) in [("vertex", vertices), ("face", faces)] {
        // The shortest line is a digit and its end.
        if count > left as u64 {
            return Err(Located::anywhere(ContentFault::CountTooLarge {
                element: element.into(),
                count,
                bytes: left,
            }));
        }
    }
    let mut raw = RawMesh::default();
    for index in 0..vertices as usize {
        let (line, text) = next_element(&mut lines, "vertex", index, vertices)?;
        let position = vertex(text).ok_or_else(|| {
            Located::at(
                line,
                ContentFault::NotAVertex { text: excerpt(text), example: VERTEX_EXAMPLE },
            )
        })?;
        raw.positions.push(position);
        raw.vertex_lines.push(line as u32);
    }
    for index in 0..faces as usize {
        let (line, text) = next_element(&mut lines, "face", index, faces)?;
        let corners = face(text).ok_or_else(|| {
            Located::at(line, ContentFault::NotAFace { text: excerpt(text), example: FACE_EXAMPLE })
        })?;
        raw.push_face(corners);
        raw.face_lines.push(line as u32);
    }
    Ok(raw)
}

/// The numbers of vertices and faces, which stand after the keyword or on a line of their own.
fn counts(lines: &mut Lines) -> Result<[u64; 2], Located> {
    let end = || {
        Located::anywhere(ContentFault::CutShort { element: "header".into(), index: 0, count: 1 })
    };
    let (mut line, first) = lines.next_content().ok_or_else(end)?;
    let keyword = words(first).next().unwrap_or_default();
    let mut text = first;
    if VARIANTS.contains(&keyword) {
        text = first[keyword.len()..].trim_ascii();
        if text.is_empty() {
            (line, text) = lines.next_content().ok_or_else(end)?;
        }
    } else if number(keyword).is_none() {
        let text = excerpt(first);
        return Err(Located::at(
            line,
            ContentFault::NotThisFormat { format: "OFF of points in space", text },
        ));
    }
    let numbers: Vec<Option<u64>> =
        words(text).take(2).map(|w| std::str::from_utf8(w).ok()?.parse().ok()).collect();
    match numbers[..] {
        [Some(vertices), Some(faces)] => Ok([vertices, faces]),
        _ => Err(Located::at(
            line,
            ContentFault::BadHeader {
                text: excerpt(text),
                format: "OFF",
                wanted: "it needs the numbers of vertices, faces and edges, as in `8 6 12`",
            },
        )),
    }
}

fn next_element<'a>(
    lines: &mut Lines<'a>,
    element: &str,
    index: usize,
    count: u64,
) -> Result<(usize, &'a [u8]), Located> {
    let cut_short =
        || ContentFault::CutShort { element: element.into(), index, count: count as usize };
    lines.next_content().ok_or_else(|| Located::anywhere(cut_short()))
}

fn vertex(line: &[u8]) -> Option<DVec3> {
    let mut numbers = words(line).map(number);
    let mut coordinate = || numbers.next().flatten();
    Some(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
}

/// The number of corners, the corners, and perhaps a colour, which is left.
fn face(line: &[u8]) -> Option<Vec<u32>> {
    let mut numbers = words(line).map(|word| std::str::from_utf8(word).ok()?.parse::<u32>().ok());
    let sides = numbers.next()?? as usize;
    let corners: Option<Vec<u32>> = numbers.take(sides).collect();
    corners.filter(|corners| corners.len() == sides)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_may_follow_the_keyword_and_colours_are_left() {
        let corners = "0 0 0\n1 0 0 # x\n\n0 1 0 255 0 0\n";
        for header in
            ["OFF\n3 1 3\n", "OFF 3 1 3\n", "# made by hand\nCOFF\n# counts\n3 1\n", "3 1 0\n"]
        {
            let raw =
                read(format!("{header}{corners}3 0 1 2 0.5 0.5 0.5\n").as_bytes()).expect("an OFF");
            assert_eq!(raw.positions, [DVec3::ZERO, DVec3::X, DVec3::Y]);
            assert_eq!((raw.face(0), raw.ends.len()), (&[0, 1, 2][..], 1));
        }
    }

    #[test]
    fn faults_carry_their_lines() {
        let line = |text: &str| read(text.as_bytes()).expect_err("a fault").line;
        assert_eq!(line("OFF\n3 1 3\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"), Some(4));
        assert_eq!(line("OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n"), Some(6));
        assert_eq!(line("OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2\n"), Some(6));
        assert_eq!(line("OFF\nmany\n"), Some(2));
        assert_eq!(line("4OFF\n3 1 3\n"), Some(1));
        assert_eq!(line("OFF\n3 1 3\n0 0 0\n"), None);
        let huge = read(b"OFF\n4000000000 1 0\n0 0 0\n").expect_err("too many");
        assert!(matches!(
            huge.fault,
            ContentFault::CountTooLarge { count: 4_000_000_000, bytes: 6, .. }
        ));
    }
}
