//! The header of a PLY file.

use super::words;
use super::{ContentFault, Located, excerpt};
use crate::units::nearest_word;

/// How the values are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    BinaryLittleEndian,
    BinaryBigEndian,
}

/// The type of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// A property: one number, or a list of numbers when it has a type for the length.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Property {
    pub name: String,
    pub item: Scalar,
    pub list_count: Option<Scalar>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Element {
    pub name: String,
    pub count: u64,
    pub properties: Vec<Property>,
}

#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Header {
    pub encoding: Encoding,
    pub elements: Vec<Element>,
    /// Lines that are no statement: how many, and the first.
    pub passed_over: Option<(usize, usize)>,
}

impl Scalar {
    fn of_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// Number of bytes in binary files.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

impl Element {
    /// Whether its lists are strips of triangles.
    pub fn is_strips(&self) -> bool {
        self.name == "tristrips"
    }

    /// Whether a mesh is made of it.
    pub fn is_needed(&self) -> bool {
        self.name == "vertex" || self.name == "face" || self.is_strips()
    }
}

/// Reads the header; returns it with the number of its lines and what follows it.
pub(super) fn read(bytes: &[u8]) -> Result<(Header, usize, &[u8]), Located> {
    let mut rest = bytes;
    let first = take_line(&mut rest).unwrap_or_default();
    if first.trim_ascii() != b"ply" {
        return Err(Located::at(
            1,
            ContentFault::NotThisFormat { format: "PLY", text: excerpt(first) },
        ));
    }
    let mut encoding = None;
    let mut elements = Vec::new();
    let mut passed_over: Option<(usize, usize)> = None;
    let mut is_after_comment = false;
    for number in 2.. {
        let Some(line) = take_line(&mut rest) else { break };
        let fault = |wanted| {
            Located::at(
                number,
                ContentFault::BadHeader { text: excerpt(line), format: "PLY", wanted },
            )
        };
        let parts: Vec<&[u8]> = words(line).collect();
        let was_after_comment = std::mem::replace(&mut is_after_comment, false);
        match parts[..] {
            [] => {}
            [b"comment" | b"obj_info", ..] => is_after_comment = true,
            [b"format", name, ..] => {
                let known = encoding_of(name);
                encoding = Some(known.ok_or_else(|| {
                    fault("known formats are ascii and binary_little_endian or _big_endian")
                })?);
            }
            [b"element", name, count] => {
                let element = element(name, count);
                elements.push(
                    element
                        .ok_or_else(|| fault("an element needs a name and a count below 2^64"))?,
                );
            }
            [b"property", ref about @ ..] => {
                let property = property(about)
                    .ok_or_else(|| fault("a property needs a known type and a name"))?;
                let element = elements
                    .last_mut()
                    .ok_or_else(|| fault("properties stand after their element"))?;
                element.properties.push(property);
            }
            [b"end_header"] => {
                let encoding = encoding
                    .ok_or_else(|| fault("a line like `format ascii 1.0` must come before it"))?;
                return Ok((Header { encoding, elements, passed_over }, number, rest));
            }
            // A comment that runs over several lines. In a text it may stand anywhere: a statement
            // that went lost with it would leave numbers over.
            [word, ..]
                if !is_misspelt(word)
                    && (was_after_comment || encoding == Some(Encoding::Text)) =>
            {
                let (count, first) = passed_over.unwrap_or((0, number));
                passed_over = Some((count + 1, first));
                is_after_comment = was_after_comment;
            }
            _ => return Err(fault("write a comment as `comment ...`")),
        }
    }
    Err(Located::anywhere(ContentFault::CutShort { element: "header".into(), index: 0, count: 1 }))
}

/// Whether a word is nearly a statement of headers, or is one with the wrong words after it.
fn is_misspelt(word: &[u8]) -> bool {
    let known = ["format", "element", "property", "end_header", "comment", "obj_info"];
    nearest_word(&String::from_utf8_lossy(word), known).is_some()
}

/// The next line. Binary values may follow right after its end, which is LF, CR LF or CR.
fn take_line<'a>(rest: &mut &'a [u8]) -> Option<&'a [u8]> {
    let end = rest.iter().position(|&b| b == b'\n' || b == b'\r')?;
    let (line, after) = rest.split_at(end);
    *rest = after.strip_prefix(b"\r\n").or(after.get(1..)).unwrap_or_default();
    Some(line)
}

fn encoding_of(name: &[u8]) -> Option<Encoding> {
    match name {
        b"ascii" => Some(Encoding::Text),
        b"binary_little_endian" => Some(Encoding::BinaryLittleEndian),
        b"binary_big_endian" => Some(Encoding::BinaryBigEndian),
        _ => None,
    }
}

fn element(name: &[u8], count: &[u8]) -> Option<Element> {
    let count = std::str::from_utf8(count).ok()?.parse().ok()?;
    Some(Element {
        name: String::from_utf8_lossy(name).into_owned(),
        count,
        properties: Vec::new(),
    })
}

fn property(about: &[&[u8]]) -> Option<Property> {
    let (list_count, item, name) = match *about {
        [b"list", count, item, name] => (Some(Scalar::of_name(count)?), item, name),
        [item, name] => (None, item, name),
        _ => return None,
    };
    Some(Property {
        name: String::from_utf8_lossy(name).into_owned(),
        item: Scalar::of_name(item)?,
        list_count,
    })
}
