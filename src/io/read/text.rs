//! Lines and words of text formats.

/// The lines of a text with their numbers from 1, without their ends, which may be LF, CR LF or CR.
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
        let end =
            self.rest.iter().position(|&b| b == b'\n' || b == b'\r').unwrap_or(self.rest.len());
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

#[cfg(test)]
mod tests {
    use super::*;

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
