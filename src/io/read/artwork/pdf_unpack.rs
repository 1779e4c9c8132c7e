//! Packed streams of PDF: Flate with PNG predictors, ASCII85, hexadecimal digits.

use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;

use super::ArtError;
use super::budget::{Budget, Cost};
use super::decode::is_over_limit;
use super::pdf_object::{Dict, Lexer, Object};

/// The bytes of a stream, unpacked.
pub(super) fn unpack(dict: &Dict, raw: &[u8], budget: &Budget) -> Result<Vec<u8>, ArtError> {
    let filters = list(dict.get("Filter"));
    let parameters = list(dict.get("DecodeParms"));
    budget.spend(Cost::Bytes, raw.len())?;
    let mut bytes = raw.to_vec();
    for (i, filter) in filters.iter().enumerate() {
        bytes = match filter.name() {
            Some("FlateDecode" | "Fl") => {
                let plain = inflated(&bytes, budget)?;
                predicted(plain, parameters.get(i).and_then(Object::dict))
            }
            Some("ASCIIHexDecode" | "AHx") => {
                Lexer::new(&[b"<", &bytes[..]].concat(), 0, budget).hex()
            }
            Some("ASCII85Decode" | "A85") => ascii85(&bytes),
            _ => {
                return Err(ArtError::Pdf(
                    "a page is packed in a way that is not read (LZW or encrypted); export it \
                    again as PDF 1.4 or later",
                ));
            }
        };
        budget.spend(Cost::Bytes, bytes.len())?;
    }
    Ok(bytes)
}

/// What could be unpacked before a fault at the end is used, as other readers do.
fn inflated(bytes: &[u8], budget: &Budget) -> Result<Vec<u8>, ArtError> {
    match decompress_to_vec_zlib_with_limit(bytes, budget.left(Cost::Bytes)) {
        Ok(plain) => Ok(plain),
        Err(error) if is_over_limit(&error) => {
            budget.expect(Cost::Bytes, usize::MAX)?;
            Ok(error.output)
        }
        Err(error) => Ok(error.output),
    }
}

fn list(object: Option<&Object>) -> &[Object] {
    match object {
        Some(Object::Array(items)) => items,
        Some(other) => std::slice::from_ref(other),
        None => &[],
    }
}

/// Undoes the PNG predictors, which compressed tables of objects use.
fn predicted(bytes: Vec<u8>, parameters: Option<&Dict>) -> Vec<u8> {
    let of = |name: &str, default: f64| {
        parameters
            .and_then(|p| p.get(name))
            .and_then(Object::number)
            .unwrap_or(default)
            .clamp(0.0, 65536.0) as usize
    };
    if of("Predictor", 1.0) < 10 {
        return bytes;
    }
    let bits = of("Columns", 1.0) * of("Colors", 1.0) * of("BitsPerComponent", 8.0);
    // No row is longer than all there is.
    let width = bits.div_ceil(8).clamp(1, bytes.len().max(1));
    let step = (of("Colors", 1.0) * of("BitsPerComponent", 8.0)).div_ceil(8).max(1);
    let mut before = vec![0_u8; width];
    let mut plain = Vec::with_capacity(bytes.len());
    for row in bytes.chunks(width + 1) {
        let mut line = row[1..].to_vec();
        for i in 0..line.len() {
            let left = if i >= step { line[i - step] } else { 0 };
            let corner = if i >= step { before[i - step] } else { 0 };
            let up = before[i];
            let guess = match row[0] {
                1 => left,
                2 => up,
                3 => ((u16::from(left) + u16::from(up)) / 2) as u8,
                4 => paeth(left, up, corner),
                _ => 0,
            };
            line[i] = line[i].wrapping_add(guess);
        }
        plain.extend_from_slice(&line);
        before[..line.len()].copy_from_slice(&line);
    }
    plain
}

fn paeth(left: u8, up: u8, corner: u8) -> u8 {
    let [a, b, c] = [left, up, corner].map(i16::from);
    let guess = a + b - c;
    let [da, db, dc] = [a, b, c].map(|x| (guess - x).abs());
    if da <= db && da <= dc {
        left
    } else if db <= dc {
        up
    } else {
        corner
    }
}

fn ascii85(bytes: &[u8]) -> Vec<u8> {
    let mut plain = Vec::new();
    let mut group: Vec<u32> = Vec::new();
    let mut flush = |group: &mut Vec<u32>| {
        let kept = group.len().saturating_sub(1);
        group.resize(5, 84);
        let value = group.iter().fold(0_u32, |v, d| v.wrapping_mul(85).wrapping_add(*d));
        plain.extend_from_slice(&value.to_be_bytes()[..kept]);
        group.clear();
    };
    for &b in bytes.iter().take_while(|b| **b != b'~') {
        match b {
            b'z' if group.is_empty() => {
                group = vec![0; 5];
                flush(&mut group);
            }
            b'!'..=b'u' => {
                group.push(u32::from(b - b'!'));
                if group.len() == 5 {
                    flush(&mut group);
                }
            }
            _ => {}
        }
    }
    if group.len() > 1 {
        flush(&mut group);
    }
    plain
}
