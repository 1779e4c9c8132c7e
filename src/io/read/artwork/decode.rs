//! Bytes as text: packed files, and the encodings that drawings come in.

use miniz_oxide::inflate::{DecompressError, TINFLStatus, decompress_to_vec_with_limit};

use super::ArtError;
use super::budget::{Budget, Cost};

/// Undoes gzip, as in `.svgz`; other bytes stay.
pub(super) fn gunzipped(bytes: &[u8], budget: &Budget) -> Result<Option<Vec<u8>>, ArtError> {
    let Some(start) = gzip_header(bytes) else { return Ok(None) };
    let limit = budget.left(Cost::Bytes);
    match decompress_to_vec_with_limit(&bytes[start..], limit) {
        Ok(plain) => {
            budget.spend(Cost::Bytes, plain.len())?;
            Ok(Some(plain))
        }
        Err(error) if is_over_limit(&error) => {
            Err(budget.spend(Cost::Bytes, usize::MAX).err().unwrap_or(ArtError::Empty))
        }
        Err(_) => Err(ArtError::Svg("its packing (gzip) is damaged".to_owned())),
    }
}

/// Whether unpacking stopped since there would have been more than was allowed.
pub(super) fn is_over_limit(error: &DecompressError) -> bool {
    error.status == TINFLStatus::HasMoreOutput
}

/// Length of the header of a gzip file (RFC 1952); nothing for other files.
fn gzip_header(bytes: &[u8]) -> Option<usize> {
    const CHECKSUM: u8 = 2;
    const EXTRA: u8 = 4;
    const NAME: u8 = 8;
    const COMMENT: u8 = 16;
    let &[0x1f, 0x8b, 8, flags, ..] = bytes else { return None };
    let mut at = 10;
    if flags & EXTRA != 0 {
        let length = bytes.get(at..at + 2)?;
        at += 2 + usize::from(u16::from_le_bytes([length[0], length[1]]));
    }
    for _ in [NAME, COMMENT].into_iter().filter(|flag| flags & flag != 0) {
        at += 1 + bytes.get(at..)?.iter().position(|b| *b == 0)?;
    }
    at += if flags & CHECKSUM != 0 { 2 } else { 0 };
    (at <= bytes.len()).then_some(at)
}

/// XML as text: UTF-8, UTF-16, and the Latin encodings by their declaration.
pub(super) fn xml_text(bytes: &[u8]) -> Result<String, ArtError> {
    if let Some(text) = utf16(bytes) {
        return Ok(text);
    }
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let error = match std::str::from_utf8(bytes) {
        Ok(text) => return Ok(text.to_owned()),
        Err(error) => error,
    };
    let declared = declared_encoding(bytes).unwrap_or_default();
    match declared.as_str() {
        "iso-8859-1" | "latin1" | "iso-8859-15" | "windows-1252" | "cp1252" | "us-ascii" => {
            Ok(bytes.iter().map(|&b| char::from(b)).collect())
        }
        "" | "utf-8" => Err(ArtError::Svg(format!(
            "byte {} is no UTF-8; save it as UTF-8",
            error.valid_up_to()
        ))),
        other => {
            Err(ArtError::Svg(format!("its encoding `{other}` is not read; save it as UTF-8")))
        }
    }
}

/// UTF-16 by its byte order mark, or by the zeros in its first tag.
pub(super) fn utf16(bytes: &[u8]) -> Option<String> {
    let (is_little, body) = match bytes {
        [0xff, 0xfe, body @ ..] => (true, body),
        [0xfe, 0xff, body @ ..] => (false, body),
        [b'<', 0, ..] => (true, bytes),
        [0, b'<', ..] => (false, bytes),
        _ => return None,
    };
    let unit = |pair: &[u8]| {
        let pair = [pair[0], pair[1]];
        if is_little { u16::from_le_bytes(pair) } else { u16::from_be_bytes(pair) }
    };
    let units: Vec<u16> = body.chunks_exact(2).map(unit).collect();
    Some(String::from_utf16_lossy(&units))
}

fn declared_encoding(bytes: &[u8]) -> Option<String> {
    let head = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).into_owned();
    let head = head.split("?>").next()?;
    let after = head.split_once("encoding")?.1.trim_start().strip_prefix('=')?.trim_start();
    let quote = after.chars().next().filter(|c| matches!(c, '"' | '\''))?;
    Some(after[1..].split(quote).next()?.to_ascii_lowercase())
}

/// Refuses XML whose entities would blow up, and tags with more attributes than any drawing has:
/// both take more than their size to read.
pub(super) fn check_xml(text: &str, budget: &Budget) -> Result<(), ArtError> {
    let attributes = text.split('<').map(|tag| {
        let tag = tag.split('>').next().unwrap_or_default();
        tag.bytes().filter(|b| *b == b'=').count()
    });
    if attributes.max().unwrap_or(0) > MOST_ATTRIBUTES {
        return Err(ArtError::TooMuch {
            what: "attributes of one element",
            limit: MOST_ATTRIBUTES,
        });
    }
    let values: Vec<&str> = text.split("<!ENTITY").skip(1).filter_map(quoted).collect();
    let Some(longest) = values.iter().map(|v| v.len()).max() else { return Ok(()) };
    if values.iter().any(|v| v.replace("&#", "").contains('&')) {
        let fault = "an entity is made of others; save it as plain SVG";
        return Err(ArtError::Svg(fault.to_owned()));
    }
    let uses = text.bytes().filter(|b| *b == b'&').count();
    budget.spend(Cost::Bytes, uses.saturating_mul(longest))
}

/// No drawing gives one element more.
const MOST_ATTRIBUTES: usize = 2000;

/// What stands between the first quotes.
fn quoted(text: &str) -> Option<&str> {
    let start = text.find(['"', '\''])?;
    let quote = char::from(text.as_bytes()[start]);
    text[start + 1..].split(quote).next()
}
