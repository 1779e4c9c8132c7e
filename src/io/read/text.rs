//! Lines, words and numbers of text formats.

use glam::DVec3;

use super::ReadNote;

/// The lines of a text with their numbers from 1, without their ends, which may be LF, CR LF or CR.
#[derive(Clone)]
pub(super) struct Lines<'a> {
    rest: &'a [u8],
    number: usize,
}

impl<'a> Lines<'a> {
    /// The lines of `bytes`; a byte order mark at the start is left out.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { rest: bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), number: 0 }
    }

    /// What has not been read yet.
    pub fn rest(&self) -> &'a [u8] {
        self.rest
    }

    /// The next line that has more than white space and a comment, without the comment.
    pub fn next_content(&mut self) -> Option<(usize, &'a [u8])> {
        self.map(|(number, line)| (number, without_comment(line).trim_ascii()))
            .find(|(_, line)| !line.is_empty())
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.rest.is_empty() {
            return None;
        }
        let end = memchr::memchr2(b'\n', b'\r', self.rest).unwrap_or(self.rest.len());
        let (line, after) = self.rest.split_at(end);
        self.rest = after.strip_prefix(b"\r\n").or(after.get(1..)).unwrap_or_default();
        self.number += 1;
        Some((self.number, line))
    }
}

/// The line up to the first `#`.
pub(super) fn without_comment(line: &[u8]) -> &[u8] {
    line.iter().position(|&b| b == b'#').map_or(line, |end| &line[..end])
}

/// The words of a line.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// The number that a word stands for, NaN and infinities among them.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The number that a word stands for when it may have a decimal comma, and whether it has one.
pub(super) fn decimal(word: &[u8]) -> Option<(f64, bool)> {
    if let Some(value) = number(word) {
        return Some((value, false));
    }
    let comma = word.iter().position(|&b| b == b',')?;
    let (before, after) = (&word[..comma], &word[comma + 1..]);
    let is_between_digits = before.last().is_some_and(u8::is_ascii_digit)
        && after.first().is_some_and(u8::is_ascii_digit);
    let pointed = [before, after].join(&b'.');
    // A second comma, or a point besides, makes no number.
    number(&pointed).filter(|_| is_between_digits).map(|value| (value, true))
}

/// Counts numbers with a decimal comma, for a note.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Commas {
    count: usize,
    first_line: usize,
}

impl Commas {
    /// The number that a word in a line stands for.
    pub fn number(&mut self, word: &[u8], line: usize) -> Option<f64> {
        let (value, has_comma) = decimal(word)?;
        if has_comma {
            self.first_line = if self.count == 0 { line } else { self.first_line };
            self.count += 1;
        }
        Some(value)
    }

    /// The first three words as coordinates.
    pub fn point<'a>(
        &mut self,
        mut words: impl Iterator<Item = &'a [u8]>,
        line: usize,
    ) -> Option<DVec3> {
        let mut coordinate = || self.number(words.next()?, line);
        Some(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
    }

    /// What to say about them.
    pub fn note(self) -> Option<ReadNote> {
        let Self { count, first_line } = self;
        (count > 0).then_some(ReadNote::DecimalCommas { count, first_line })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commas_are_decimal_only_between_digits_and_alone() {
        assert_eq!(decimal(b"-30,5e1"), Some((-305.0, true)));
        assert_eq!(decimal(b"1.5"), Some((1.5, false)));
        for word in [&b"1,2,3"[..], b"1,", b",5", b"1.234,5", b"1,234.5", b"a,b", b","] {
            assert_eq!(decimal(word), None, "{:?}", String::from_utf8_lossy(word));
        }
    }

    #[test]
    fn all_line_ends_count_the_same() {
        let lines = |text: &'static str| {
            Lines::new(text.as_bytes()).map(|(n, l)| (n, l.len())).collect::<Vec<_>>()
        };
        for text in ["ab\n\nc", "ab\r\n\r\nc\r\n", "ab\r\rc\r", "\u{feff}ab\n\nc\n"] {
            assert_eq!(lines(text), [(1, 2), (2, 0), (3, 1)], "{text:?}");
        }
        let mut content = Lines::new(b"# x\n\n 1 2 # y\n3");
        assert_eq!(content.next_content(), Some((3, &b"1 2"[..])));
        assert_eq!(content.next_content(), Some((4, &b"3"[..])));
        assert_eq!(content.next_content(), None);
    }
}
