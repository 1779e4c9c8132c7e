//! The values after a PLY header, one after the other.

use super::header::{Element, Property, Scalar};
use super::{ContentFault, Located, excerpt};
use crate::io::read::ReadNote;
use crate::io::read::text::Commas;

/// Numbers in the order of the file. All types fit into f64 without loss.
pub(super) trait Values {
    /// The next number.
    fn next(&mut self, kind: Scalar) -> Result<f64, Missing>;
    /// Number of bytes that have not been read.
    fn remaining(&self) -> usize;
    /// The fewest bytes that one number takes.
    fn least_item_bytes(&self, kind: Scalar) -> usize;
    /// The line of the last number; `None` in binary files.
    fn line(&self) -> Option<usize>;
    /// Called after each element: what stands behind it in its line, if lines hold one each.
    fn end_element(&mut self) {}
    /// What to note, once all is read.
    fn notes(&self) -> Vec<ReadNote>;

    /// The fewest bytes that a property takes.
    fn least_bytes(&self, property: &Property) -> usize {
        self.least_item_bytes(property.list_count.unwrap_or(property.item))
    }
}

/// Why there is no next number.
pub(super) enum Missing {
    End,
    NotANumber { text: String, line: usize },
}

impl Missing {
    /// The fault, for an element.
    pub fn within(self, element: &Element, index: usize) -> Located {
        let name = element.name.clone();
        match self {
            Self::End => Located::anywhere(ContentFault::CutShort {
                element: name,
                index,
                count: element.count as usize,
            }),
            Self::NotANumber { text, line } => Located::at(
                line,
                ContentFault::BadValue { text, element: name, index, wanted: "a number" },
            ),
        }
    }
}

/// Numbers as words; line ends count as white space.
pub(super) struct Text<'a> {
    rest: &'a [u8],
    line: usize,
    commas: Commas,
    /// Whether each element has a line of its own, of which what is left over is passed over.
    is_by_lines: bool,
    is_line_begun: bool,
    extra: Option<(usize, usize)>,
}

impl<'a> Text<'a> {
    /// The words of `rest`, which begins after `lines_before` lines.
    pub fn new(rest: &'a [u8], lines_before: usize) -> Self {
        let commas = Commas::default();
        Self {
            rest,
            line: lines_before + 1,
            commas,
            is_by_lines: false,
            is_line_begun: false,
            extra: None,
        }
    }

    /// The same where each element has a line of its own, which may have more numbers than the
    /// header says.
    pub fn by_lines(rest: &'a [u8], lines_before: usize) -> Self {
        Self { is_by_lines: true, ..Self::new(rest, lines_before) }
    }
}

impl Values for Text<'_> {
    fn next(&mut self, _kind: Scalar) -> Result<f64, Missing> {
        let start = self.rest.iter().position(|b| !b.is_ascii_whitespace()).ok_or(Missing::End)?;
        let (space, from_word) = self.rest.split_at(start);
        let has_end = space.iter().any(|&b| b == b'\n' || b == b'\r');
        if self.is_by_lines && std::mem::replace(&mut self.is_line_begun, true) && has_end {
            return Err(Missing::NotANumber { text: "end of the line".into(), line: self.line });
        }
        // CR LF is one end, and so is CR alone.
        let ends = (0..space.len()).filter(|&i| {
            space[i] == b'\n' || space[i] == b'\r' && space.get(i + 1) != Some(&b'\n')
        });
        self.line += ends.count();
        let end = from_word.iter().position(u8::is_ascii_whitespace).unwrap_or(from_word.len());
        let (word, rest) = from_word.split_at(end);
        self.rest = rest;
        let line = self.line;
        let missing = || Missing::NotANumber { text: excerpt(word), line };
        self.commas.number(word, line).ok_or_else(missing)
    }

    fn end_element(&mut self) {
        if !self.is_by_lines {
            return;
        }
        self.is_line_begun = false;
        let is_end = |&b: &u8| b == b'\n' || b == b'\r';
        let end = self.rest.iter().position(is_end).unwrap_or(self.rest.len());
        let (extra, rest) = self.rest.split_at(end);
        if !extra.trim_ascii().is_empty() {
            let (count, first) = self.extra.unwrap_or((0, self.line));
            self.extra = Some((count + 1, first));
        }
        self.rest = rest;
    }

    fn notes(&self) -> Vec<ReadNote> {
        let extra = self.extra;
        let extra = extra.map(|(count, first_line)| ReadNote::ExtraColumns { count, first_line });
        let bytes = self.rest.trim_ascii().len();
        let rest = (bytes > 0).then_some(ReadNote::Rest { bytes });
        self.commas.note().into_iter().chain(extra).chain(rest).collect()
    }

    fn remaining(&self) -> usize {
        self.rest.len()
    }

    /// A digit and the space after it; the last of the file may lack the space.
    fn least_item_bytes(&self, _kind: Scalar) -> usize {
        1
    }

    fn line(&self) -> Option<usize> {
        Some(self.line)
    }
}

/// Numbers as they are in memory.
pub(super) struct Binary<'a> {
    rest: &'a [u8],
    is_big_endian: bool,
}

impl<'a> Binary<'a> {
    /// The numbers in `rest`.
    pub fn new(rest: &'a [u8], is_big_endian: bool) -> Self {
        Self { rest, is_big_endian }
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N], Missing> {
        let (bytes, rest) = self.rest.split_first_chunk::<N>().ok_or(Missing::End)?;
        self.rest = rest;
        let mut bytes = *bytes;
        if self.is_big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl Values for Binary<'_> {
    fn next(&mut self, kind: Scalar) -> Result<f64, Missing> {
        Ok(match kind {
            Scalar::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Scalar::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Scalar::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Scalar::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Scalar::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Scalar::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Scalar::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Scalar::F64 => f64::from_le_bytes(self.take()?),
        })
    }

    fn remaining(&self) -> usize {
        self.rest.len()
    }

    fn least_item_bytes(&self, kind: Scalar) -> usize {
        kind.size()
    }

    fn line(&self) -> Option<usize> {
        None
    }

    fn notes(&self) -> Vec<ReadNote> {
        let last = self.rest.iter().rposition(|&b| b != 0);
        last.map(|last| ReadNote::Rest { bytes: last + 1 }).into_iter().collect()
    }
}
