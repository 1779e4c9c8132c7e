//! Object File Format: polygons as text. Normals, colours and texture coordinates are not needed.
//!
//! Most files have one vertex or face in a line, perhaps with a colour after it, so lines are read
//! first. Some have their numbers in any lines; those are read as one row of numbers, which must
//! come out to the last one.

use std::borrow::Cow;

use super::ReadNote;
use super::raw::RawMesh;
use super::text::{Commas, Lines, words};
use crate::io::error::{ContentFault, Located, excerpt};

/// First words of the variants whose vertices begin with three coordinates; longer ones first, so
/// that a keyword is found whole.
const VARIANTS: [&[u8]; 8] =
    [b"STCNOFF", b"STNOFF", b"STCOFF", b"CNOFF", b"STOFF", b"COFF", b"NOFF", b"OFF"];
const VERTEX_EXAMPLE: &str = "0 1.5 2";
const FACE_EXAMPLE: &str = "3 0 1 2";

pub(super) fn read(bytes: &[u8]) -> Result<RawMesh, Located> {
    if bytes.contains(&0) {
        return Err(Located::anywhere(ContentFault::NotText { format: "OFF" }));
    }
    let by_lines = by_lines(bytes);
    match by_lines {
        Ok(raw) if raw.notes.is_empty() => Ok(raw),
        // Only where all numbers are used up, the row is what was meant.
        _ => by_numbers(bytes).map_or(by_lines, Ok),
    }
}

/// Whether a word is the keyword of the format, alone or with a count glued to it (`OFF8`).
pub(super) fn begins_off(word: &[u8]) -> bool {
    keyword(word).is_some_and(|rest| rest.first().is_none_or(u8::is_ascii_digit))
}

/// What follows the keyword.
fn keyword(text: &[u8]) -> Option<&[u8]> {
    VARIANTS.iter().find_map(|name| {
        let start = text.get(..name.len())?;
        start.eq_ignore_ascii_case(name).then(|| &text[name.len()..])
    })
}

fn by_lines(bytes: &[u8]) -> Result<RawMesh, Located> {
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
    let mut commas = Commas::default();
    for index in 0..vertices as usize {
        let (line, text) = next_element(&mut lines, "vertex", index, vertices, |_| 3)?;
        let position = commas.point(words(&text), line).ok_or_else(|| {
            let text = excerpt(&text);
            Located::at(line, ContentFault::NotAVertex { text, example: VERTEX_EXAMPLE })
        })?;
        raw.positions.push(position);
        raw.vertex_lines.push(line as u32);
    }
    for index in 0..faces as usize {
        let sides = |first: &[u8]| integer(first).map_or(1, |sides| sides as usize + 1);
        let (line, text) = next_element(&mut lines, "face", index, faces, sides)?;
        let corners = face(&text).ok_or_else(|| {
            let text = excerpt(&text);
            Located::at(line, ContentFault::NotAFace { text, example: FACE_EXAMPLE })
        })?;
        raw.push_face(corners);
        raw.face_lines.push(line as u32);
    }
    raw.notes.extend(commas.note());
    let rest = lines.rest();
    if lines.next_content().is_some() {
        raw.notes.push(ReadNote::Rest { bytes: rest.trim_ascii().len() });
    }
    Ok(raw)
}

/// The mesh when the whole file is one row of numbers without colours, whatever its lines. `None`
/// when numbers are missing or left over, or when each element has a line of its own: numbers that
/// are missing in one of those are not to be taken from the next.
fn by_numbers(bytes: &[u8]) -> Option<RawMesh> {
    let mut lines = Lines::new(bytes);
    let mut row: Vec<(usize, &[u8])> = Vec::new();
    let mut line_count = 0;
    while let Some((line, text)) = lines.next_content() {
        let text = if row.is_empty() { keyword(text).unwrap_or(text) } else { text };
        row.extend(words(text).map(|word| (line, word)));
        line_count += 1;
    }
    let mut numbers = row.into_iter();
    let mut count = || numbers.next().and_then(|(_, word)| integer(word));
    // The number of edges is not needed.
    let (vertices, faces, _) = (count()?, count()?, count()?);
    let elements = u64::from(vertices) + u64::from(faces);
    // The keyword and the counts stand in one line, or in two.
    if [elements + 1, elements + 2].contains(&line_count) {
        return None;
    }
    let mut raw = RawMesh::default();
    let mut commas = Commas::default();
    for _ in 0..vertices {
        let point: Vec<(usize, &[u8])> = numbers.by_ref().take(3).collect();
        let line = point.first()?.0;
        raw.positions.push(commas.point(point.iter().map(|&(_, word)| word), line)?);
        raw.vertex_lines.push(line as u32);
    }
    for _ in 0..faces {
        let (line, sides) = numbers.next()?;
        let sides = integer(sides)? as usize;
        let corners = numbers.by_ref().take(sides).map(|(_, word)| integer(word));
        let corners: Vec<u32> = corners.collect::<Option<_>>()?;
        let is_face = sides > 2 && corners.iter().all(|&v| u64::from(v) < u64::from(vertices));
        if corners.len() != sides || !is_face {
            return None;
        }
        raw.push_face(corners);
        raw.face_lines.push(line as u32);
    }
    raw.notes.extend(commas.note());
    numbers.next().is_none().then_some(raw)
}

/// The numbers of vertices and faces, which stand after the keyword or on a line of their own.
fn counts(lines: &mut Lines) -> Result<[u64; 2], Located> {
    let end = || {
        Located::anywhere(ContentFault::CutShort { element: "header".into(), index: 0, count: 1 })
    };
    let (mut line, first) = lines.next_content().ok_or_else(end)?;
    let mut text = first;
    let first_word = words(first).next().unwrap_or_default();
    if begins_off(first_word) {
        text = keyword(first).unwrap_or(first).trim_ascii();
        if text.is_empty() {
            (line, text) = lines.next_content().ok_or_else(end)?;
        }
    } else if integer(first_word).is_none() {
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

/// The next line, with the lines after it that it needs to have as many words as `needed` says of
/// its first one. Lines are joined only when they come out even: a line that is short is no reason
/// to take numbers from the next element.
fn next_element<'a>(
    lines: &mut Lines<'a>,
    element: &str,
    index: usize,
    count: u64,
    needed: impl Fn(&[u8]) -> usize,
) -> Result<(usize, Cow<'a, [u8]>), Located> {
    let cut_short =
        || ContentFault::CutShort { element: element.into(), index, count: count as usize };
    let (line, text) = lines.next_content().ok_or_else(|| Located::anywhere(cut_short()))?;
    let needed = needed(words(text).next().unwrap_or_default());
    let mut joined = Cow::Borrowed(text);
    let mut have = number_of_words(text);
    let mut ahead = lines.clone();
    while have < needed {
        let Some((_, more)) = ahead.next_content() else { break };
        have += number_of_words(more);
        joined.to_mut().push(b' ');
        joined.to_mut().extend_from_slice(more);
    }
    if have == needed {
        *lines = ahead;
        return Ok((line, joined));
    }
    Ok((line, Cow::Borrowed(text)))
}

fn number_of_words(text: &[u8]) -> usize {
    words(text).count()
}

fn integer(word: &[u8]) -> Option<u32> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The number of corners, the corners, and perhaps a colour, which is left.
fn face(line: &[u8]) -> Option<Vec<u32>> {
    let mut numbers = words(line).map(integer);
    let sides = numbers.next()?? as usize;
    let corners: Option<Vec<u32>> = numbers.take(sides).collect();
    corners.filter(|corners| corners.len() == sides)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn numbers_may_stand_in_any_lines() {
        let wanted = read(b"OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").expect("an OFF");
        for text in [
            "OFF3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
            "off\n3 1 3\n0 0\n0\n1 0\n0\n0 1\n0\n3 0\n1\n2\n",
            "OFF 3 1 3 0 0 0 1 0 0 0 1 0 3 0 1 2",
            "OFF\n3\n1\n3\n0 0 0 1 0 0\n0 1 0 3\n0 1 2\n",
        ] {
            let raw = read(text.as_bytes()).expect(text);
            assert_eq!((raw.positions, raw.corners), (wanted.positions.clone(), vec![0, 1, 2]));
            assert!(raw.notes.is_empty(), "{text}");
        }
    }

    #[test]
    fn a_short_line_takes_nothing_from_the_next_element() {
        let line = |text: &str| read(text.as_bytes()).expect_err(text).line;
        let corners = "0 0 0\n1 0 0\n0 1 0\n";
        assert_eq!(line(&format!("OFF\n3 2 3\n{corners}3 0 1\n3 2 1 0\n")), Some(6));
        let more = read(format!("OFF\n3 1 3\n{corners}3 0 1 2\n3 2 1 0\n").as_bytes());
        assert_eq!(more.expect("an OFF").notes, [ReadNote::Rest { bytes: 7 }]);
    }

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
