//! Binary DXF: the same group codes and values as in text, packed.

use std::borrow::Cow;

use super::ArtError;
use super::budget::{Budget, Cost};
use super::dxf_value::Pair;

/// How a binary file begins.
const SENTINEL: &[u8] = b"AutoCAD Binary DXF\r\n\x1a\0";

/// How the value of a group code is packed.
enum Packing {
    Text,
    Double,
    Whole(usize),
    Chunk,
}

impl Packing {
    fn of(code: i32) -> Self {
        match code {
            10..=59 | 110..=149 | 210..=239 | 460..=469 | 1010..=1059 => Self::Double,
            60..=79 | 170..=179 | 270..=289 | 370..=389 | 400..=409 | 1060..=1070 => Self::Whole(2),
            90..=99 | 420..=429 | 440..=459 | 1071 => Self::Whole(4),
            160..=169 => Self::Whole(8),
            290..=299 => Self::Whole(1),
            310..=319 | 1004 => Self::Chunk,
            _ => Self::Text,
        }
    }
}

/// Reads bytes one after the other.
struct Bytes<'a> {
    rest: &'a [u8],
}

impl<'a> Bytes<'a> {
    fn take(&mut self, count: usize) -> Option<&'a [u8]> {
        let (taken, rest) = self.rest.split_at_checked(count)?;
        self.rest = rest;
        Some(taken)
    }

    /// A whole number, the low byte first.
    fn whole(&mut self, count: usize) -> Option<i64> {
        let bytes = self.take(count)?;
        let value = bytes.iter().rev().fold(0_u64, |v, b| v << 8 | u64::from(*b));
        // The sign is that of the highest bit.
        let spare = 64 - 8 * count as u32;
        Some((value << spare) as i64 >> spare)
    }

    /// Codes take two bytes; before release 13 one, and three for the few above 254.
    fn code(&mut self, is_old: bool) -> Option<i32> {
        if !is_old {
            return self.whole(2).map(|code| code as i32);
        }
        match self.take(1)?[0] {
            255 => self.whole(2).map(|code| code as i32),
            code => Some(i32::from(code)),
        }
    }

    fn value(&mut self, packing: &Packing) -> Option<Cow<'a, str>> {
        match packing {
            Packing::Text => {
                let end = self.rest.iter().position(|b| *b == 0)?;
                let text = self.take(end + 1)?;
                Some(String::from_utf8_lossy(&text[..end]))
            }
            Packing::Double => {
                let bytes = self.take(8)?.try_into().ok()?;
                Some(Cow::Owned(f64::from_le_bytes(bytes).to_string()))
            }
            Packing::Whole(count) => Some(Cow::Owned(self.whole(*count)?.to_string())),
            Packing::Chunk => {
                let length = usize::from(self.take(1)?[0]);
                self.take(length).map(|_| Cow::Borrowed(""))
            }
        }
    }
}

/// The pairs of a binary file; nothing for other files.
pub(super) fn pairs<'a>(
    bytes: &'a [u8],
    budget: &Budget,
) -> Result<Option<Vec<Pair<'a>>>, ArtError> {
    let Some(rest) = bytes.strip_prefix(SENTINEL) else { return Ok(None) };
    let mut bytes = Bytes { rest };
    // The first pair is always code 0 and a word.
    let is_old = rest.get(1).is_some_and(|b| *b != 0);
    let mut pairs = Vec::new();
    loop {
        let pair = bytes.code(is_old).and_then(|c| Some((c, bytes.value(&Packing::of(c))?)));
        let Some(pair) = pair else {
            let fault = "the binary file breaks off before its EOF; export the drawing again";
            return Err(ArtError::Dxf { line: pairs.len() + 1, fault });
        };
        if pair.0 == 0 && pair.1 == "EOF" {
            return Ok(Some(pairs));
        }
        budget.spend(Cost::Values, 1)?;
        pairs.push(pair);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_and_both_kinds_of_codes_are_read() {
        let mut new = SENTINEL.to_vec();
        new.extend(b"\0\0LINE\0");
        new.extend([10, 0]);
        new.extend((-1.5_f64).to_le_bytes());
        new.extend([62, 0, 0xff, 0xff]);
        new.extend(b"\0\0EOF\0rubbish");
        let expected: Vec<Pair<'_>> =
            [(0, "LINE"), (10, "-1.5"), (62, "-1")].map(|(c, v)| (c, v.into())).to_vec();
        assert_eq!(pairs(&new, &Budget::default()), Ok(Some(expected)));
        let old = [SENTINEL, b"\0LINE\0\xff\xf0\x03note\0\0EOF\0"].concat();
        let expected: Vec<Pair<'_>> =
            [(0, "LINE"), (1008, "note")].map(|(c, v)| (c, v.into())).to_vec();
        assert_eq!(pairs(&old, &Budget::default()), Ok(Some(expected)));
        assert!(pairs(&new[..30], &Budget::default()).is_err());
        assert_eq!(pairs(b"  0\nSECTION", &Budget::default()), Ok(None));
    }
}
