//! The chunks of a GLB file.

use super::broken;
use crate::io::error::{ContentFault, excerpt};

const MAGIC: &[u8] = b"glTF";
const JSON: &[u8] = b"JSON";
const BINARY: &[u8] = b"BIN\0";
const HEADER: usize = 12;

/// Whether a file begins as GLB does.
pub(in crate::io::read) fn is_glb(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// The text, the bytes of buffer 0, and how many bytes follow the file's own end.
pub(super) fn container(bytes: &[u8]) -> Result<(&[u8], &[u8], usize), ContentFault> {
    if !is_glb(bytes) {
        return Err(ContentFault::NotThisFormat { format: "GLB", text: excerpt(bytes) });
    }
    let word = |at: usize| {
        let word = bytes.get(at..at + 4).and_then(|word| word.first_chunk::<4>());
        word.map(|word| u32::from_le_bytes(*word) as usize)
    };
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(broken("its header is cut short"));
    };
    if version != 2 {
        return Err(broken(format!("it is of version {version}, and version 2 is read")));
    }
    if length > bytes.len() {
        let lacks = length - bytes.len();
        return Err(broken(format!("the last {lacks} bytes are missing")));
    }
    let mut chunks: [Option<&[u8]>; 2] = [None, None];
    let mut at = HEADER;
    while at + 8 <= length {
        let (size, kind) = (word(at).unwrap_or(0), &bytes[at + 4..at + 8]);
        let Some(chunk) =
            (at + 8).checked_add(size).and_then(|end| bytes[..length].get(at + 8..end))
        else {
            return Err(broken(format!("the chunk at byte {at} is longer than the file")));
        };
        // Of several of a kind the first one counts; readers pass over chunks that they do not know.
        for (found, name) in chunks.iter_mut().zip([JSON, BINARY]) {
            if kind == name {
                found.get_or_insert(chunk);
            }
        }
        at += 8 + size;
    }
    let [text, binary] = chunks;
    let text = text.ok_or_else(|| broken("it has no chunk of JSON"))?;
    Ok((text, binary.unwrap_or_default(), bytes.len() - length))
}
