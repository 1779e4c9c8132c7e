//! Text in the encodings that editors and exporters use.
//!
//! Formats are read as UTF-8. A text in UTF-16, as some shells and editors of Windows save it, is
//! turned into UTF-8 first; a byte order mark and the padding of old tools at the end go.

use std::borrow::Cow;
use std::path::Path;

/// The mark at the start of UTF-8 texts.
const UTF8_MARK: &[u8] = b"\xef\xbb\xbf";
/// Fills up the last block of a file in some programs: NUL, and the end mark of DOS.
const PADDING: [u8; 2] = [0, 0x1a];
/// So many units of two bytes must look like UTF-16 when no mark says so.
const SAMPLE: usize = 8;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ByteOrder {
    Little,
    Big,
}

/// The bytes as UTF-8 without a mark and without padding; other bytes stay as they are.
pub(super) fn as_utf8(bytes: &[u8]) -> Cow<'_, [u8]> {
    match utf16_order(bytes) {
        Some((order, text)) => {
            let text = from_utf16(text, order);
            Cow::Owned(without_padding(text.as_bytes()).to_vec())
        }
        None => Cow::Borrowed(without_padding(bytes.strip_prefix(UTF8_MARK).unwrap_or(bytes))),
    }
}

/// A text that must be UTF-8 or UTF-16, such as JSON, TOML and CSV, without its mark.
///
/// # Errors
/// The place of the first byte that fits neither.
pub fn decode_text(bytes: &[u8]) -> Result<String, usize> {
    if let Some((order, text)) = utf16_order(bytes) {
        return Ok(from_utf16(text, order));
    }
    let text = bytes.strip_prefix(UTF8_MARK).unwrap_or(bytes);
    let before = bytes.len() - text.len();
    let text = std::str::from_utf8(text).map_err(|error| before + error.valid_up_to())?;
    Ok(text.to_owned())
}

/// Reads a file that must be text, as [`decode_text`] does.
///
/// # Errors
/// What the system says, or [`std::io::ErrorKind::InvalidData`] with the byte that is no text.
pub fn read_text(path: &Path) -> std::io::Result<String> {
    decode_text(&std::fs::read(path)?).map_err(|at| {
        let message = format!("it must be text in UTF-8, but byte {at} is not");
        std::io::Error::new(std::io::ErrorKind::InvalidData, message)
    })
}

/// A name in a file: UTF-8, or else Latin-1.
pub(super) fn name_text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&b| char::from(b)).collect(),
    }
}

fn without_padding(bytes: &[u8]) -> &[u8] {
    let end = bytes.iter().rposition(|b| !PADDING.contains(b)).map_or(0, |last| last + 1);
    &bytes[..end]
}

/// The byte order of a text in UTF-16, and the text without its mark.
fn utf16_order(bytes: &[u8]) -> Option<(ByteOrder, &[u8])> {
    match bytes {
        [0xff, 0xfe, text @ ..] => return Some((ByteOrder::Little, text)),
        [0xfe, 0xff, text @ ..] => return Some((ByteOrder::Big, text)),
        _ => {}
    }
    // Without a mark: every other byte of the start is zero, and the rest is plain text.
    let sample = bytes.get(..2 * SAMPLE)?;
    let is_plain = |b: u8| b.is_ascii_graphic() || b.is_ascii_whitespace();
    let all = |low: usize| sample.chunks_exact(2).all(|u| is_plain(u[low]) && u[1 - low] == 0);
    if all(0) {
        Some((ByteOrder::Little, bytes))
    } else if all(1) {
        Some((ByteOrder::Big, bytes))
    } else {
        None
    }
}

fn from_utf16(text: &[u8], order: ByteOrder) -> String {
    let unit = |pair: &[u8]| match order {
        ByteOrder::Little => u16::from_le_bytes([pair[0], pair[1]]),
        ByteOrder::Big => u16::from_be_bytes([pair[0], pair[1]]),
    };
    let units = text.chunks_exact(2).map(unit);
    char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn utf16(text: &str, mark: bool, order: ByteOrder) -> Vec<u8> {
        let marked = if mark { format!("\u{feff}{text}") } else { text.to_owned() };
        let bytes = |u: u16| match order {
            ByteOrder::Little => u.to_le_bytes(),
            ByteOrder::Big => u.to_be_bytes(),
        };
        marked.encode_utf16().flat_map(bytes).collect()
    }

    #[test]
    fn all_encodings_say_the_same() {
        let text = "v 0 0 0\nv 1 0 0 # Länge\n";
        let mut files = vec![text.as_bytes().to_vec(), format!("\u{feff}{text}").into_bytes()];
        for order in [ByteOrder::Little, ByteOrder::Big] {
            files.extend([true, false].map(|mark| utf16(text, mark, order)));
        }
        for file in files {
            assert_eq!(as_utf8(&file), text.as_bytes(), "{file:?}");
            assert_eq!(decode_text(&file).as_deref(), Ok(text), "{file:?}");
        }
        assert_eq!(as_utf8(b"v 1 2 3\0\0\x1a"), &b"v 1 2 3"[..]);
        assert_eq!(decode_text(b"\xef\xbb\xbfab\xff"), Err(5));
        assert_eq!(name_text(b"W\xe4nde"), "Wände");
    }
}
