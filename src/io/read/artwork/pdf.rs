//! PDF: objects found by scanning the whole file, so that damaged tables do not matter; the pages
//! in order.

use std::collections::BTreeMap;

use super::pdf_object::{Dict, Lexer, Object, unpack};
use super::pdf_page::page;
use super::{ArtError, DEEPEST};
use crate::lint::Artwork;

/// All objects of a file by number; later ones replace earlier ones.
pub(super) struct Objects(BTreeMap<u32, Object>);

impl Objects {
    /// Follows references.
    pub fn get<'a>(&'a self, mut object: &'a Object) -> &'a Object {
        for _ in 0..DEEPEST {
            match object {
                Object::Reference(id) => object = self.0.get(id).unwrap_or(&Object::Null),
                other => return other,
            }
        }
        &Object::Null
    }

    /// An entry of a dictionary, followed.
    pub fn entry<'a>(&'a self, dict: &'a Dict, name: &str) -> Option<&'a Object> {
        dict.get(name).map(|o| self.get(o)).filter(|o| **o != Object::Null)
    }
}

pub(super) fn read(bytes: &[u8]) -> Result<Vec<Artwork>, ArtError> {
    let objects = scan(bytes)?;
    let root = objects
        .0
        .values()
        .rev()
        .filter_map(Object::dict)
        .find(|d| d.get("Type").and_then(Object::name) == Some("Catalog"));
    let root = root.ok_or(ArtError::Pdf("it has no catalogue; export the drawing again"))?;
    let mut pages = Vec::new();
    let inherited = Dict::new();
    let top = objects.entry(root, "Pages").and_then(Object::dict);
    collect(&objects, top.ok_or(ArtError::Pdf("it has no pages"))?, &inherited, &mut pages, 0)?;
    if pages.is_empty() {
        return Err(ArtError::Pdf("it has no pages"));
    }
    pages.iter().map(|dict| page(&objects, dict)).collect()
}

/// The dictionaries of the pages with what they inherit.
fn collect(
    objects: &Objects,
    node: &Dict,
    inherited: &Dict,
    pages: &mut Vec<Dict>,
    depth: usize,
) -> Result<(), ArtError> {
    if depth > DEEPEST {
        return Err(ArtError::TooDeep);
    }
    let mut here = inherited.clone();
    for name in ["MediaBox", "CropBox", "Resources", "Rotate", "UserUnit"] {
        here.extend(node.get(name).map(|value| (name.to_owned(), value.clone())));
    }
    let Some(Object::Array(kids)) = objects.entry(node, "Kids") else {
        here.extend(node.iter().map(|(k, v)| (k.clone(), v.clone())));
        pages.push(here);
        return Ok(());
    };
    kids.iter()
        .filter_map(|kid| objects.get(kid).dict())
        .try_for_each(|kid| collect(objects, kid, &here, pages, depth + 1))
}

fn scan(bytes: &[u8]) -> Result<Objects, ArtError> {
    let mut objects = BTreeMap::new();
    let mut at = 0;
    while let Some(found) = find(bytes, b" obj", at) {
        at = found + 4;
        let Some(id) = number_before(bytes, found) else { continue };
        let mut lexer = Lexer { bytes, at };
        let Some(object) = lexer.object() else { continue };
        let object = match object {
            Object::Dict(dict) => stream(bytes, &mut lexer, dict),
            other => other,
        };
        at = lexer.at.max(at);
        objects.insert(id, object);
    }
    let is_locked = |d: &Dict| d.contains_key("Encrypt");
    let trailer = find(bytes, b"trailer", 0).map(|t| Lexer { bytes, at: t + 7 }.object());
    if objects.values().filter_map(Object::dict).any(is_locked)
        || matches!(trailer, Some(Some(Object::Dict(d))) if is_locked(&d))
    {
        return Err(ArtError::Pdf("it is encrypted; save it without a password"));
    }
    let packed: Vec<Object> =
        objects.values().filter(|o| type_of(o) == Some("ObjStm")).cloned().collect();
    for object in &packed {
        // Objects that stand by themselves are the newer ones.
        for (id, inner) in unpacked(object)? {
            objects.entry(id).or_insert(inner);
        }
    }
    Ok(Objects(objects))
}

fn type_of(object: &Object) -> Option<&str> {
    object.dict()?.get("Type")?.name()
}

/// The number of the object in `12 0 obj`, where the space before `obj` is at `end`.
fn number_before(bytes: &[u8], end: usize) -> Option<u32> {
    let digits = |end: usize| bytes[..end].iter().rev().take_while(|b| b.is_ascii_digit()).count();
    let generation = digits(end);
    let before = end.checked_sub(generation + 1)?;
    let number = digits(before);
    std::str::from_utf8(&bytes[before - number..before])
        .ok()?
        .parse()
        .ok()
        .filter(|_| generation > 0)
}

/// A dictionary with the stream after it, if there is one.
fn stream(bytes: &[u8], lexer: &mut Lexer<'_>, dict: Dict) -> Object {
    lexer.skip();
    if !bytes[lexer.at..].starts_with(b"stream") {
        return Object::Dict(dict);
    }
    let mut start = lexer.at + 6;
    start += usize::from(bytes.get(start) == Some(&b'\r'));
    start += usize::from(bytes.get(start) == Some(&b'\n'));
    let said = dict.get("Length").and_then(Object::number).map(|n| start + n.max(0.0) as usize);
    // The length may be wrong, or stand elsewhere: what counts is where the stream says that it
    // ends.
    let is_end =
        |e: &usize| *e <= bytes.len() && find(bytes, b"endstream", *e).is_some_and(|f| f <= e + 2);
    let end =
        said.filter(is_end).or_else(|| find(bytes, b"endstream", start)).unwrap_or(bytes.len());
    lexer.at = end;
    Object::Stream(dict, bytes[start.min(end)..end].to_vec())
}

/// The objects inside an object stream.
fn unpacked(object: &Object) -> Result<Vec<(u32, Object)>, ArtError> {
    let Object::Stream(dict, raw) = object else { return Ok(Vec::new()) };
    let bytes = unpack(dict, raw).map_err(ArtError::Pdf)?;
    let of = |name: &str| dict.get(name).and_then(Object::number).unwrap_or(0.0).max(0.0) as usize;
    let (count, first) = (of("N"), of("First"));
    let mut head = Lexer { bytes: &bytes, at: 0 };
    let mut inner = Vec::new();
    for _ in 0..count.min(bytes.len()) {
        let (Some(Object::Number(id)), Some(Object::Number(offset))) =
            (head.object(), head.object())
        else {
            break;
        };
        let at = first + offset.max(0.0) as usize;
        inner.extend(Lexer { bytes: &bytes, at }.object().map(|o| (id as u32, o)));
    }
    Ok(inner)
}

fn find(bytes: &[u8], what: &[u8], from: usize) -> Option<usize> {
    let rest = bytes.get(from..)?;
    let first = what[0];
    let mut at = 0;
    while let Some(next) = rest[at..].iter().position(|&b| b == first) {
        if rest[at + next..].starts_with(what) {
            return Some(from + at + next);
        }
        at += next + 1;
    }
    None
}
