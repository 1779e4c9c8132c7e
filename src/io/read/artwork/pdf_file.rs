//! The objects of a PDF, found by scanning the whole file, so that damaged tables do not matter.

use std::collections::BTreeMap;

use super::budget::{Budget, Cost};
use super::pdf_object::{Dict, Lexer, Object};
use super::pdf_unpack::unpack;
use super::{ArtError, DEEPEST};

/// All objects of a file by number; later ones replace earlier ones.
pub(super) struct Objects(BTreeMap<u32, Object>);

impl Objects {
    /// Reads all objects, packed ones among them.
    pub fn of_file(bytes: &[u8], budget: &Budget) -> Result<Self, ArtError> {
        scan(bytes, budget).map(Self)
    }

    /// The catalogue from which everything hangs; of several the last.
    pub fn catalogue(&self) -> Option<&Dict> {
        let root = self.0.values().rev().find(|o| type_of(o) == Some("Catalog"));
        root.and_then(Object::dict)
    }

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

/// A page with what it inherits from the nodes above it.
#[derive(Clone)]
pub(super) struct PageNode<'a> {
    own: &'a Dict,
    inherited: [Option<&'a Object>; INHERITED.len()],
}

/// What the pages of a node have in common unless they say otherwise.
const INHERITED: [&str; 4] = ["MediaBox", "Resources", "Rotate", "UserUnit"];

impl<'a> PageNode<'a> {
    /// The node above all pages.
    pub fn top(own: &'a Dict) -> Self {
        Self { own, inherited: [None; INHERITED.len()] }
    }

    /// The nodes below; none for a page.
    pub fn kids(&self, objects: &'a Objects) -> Option<Vec<Self>> {
        let Some(Object::Array(kids)) = objects.entry(self.own, "Kids") else { return None };
        let mut inherited = self.inherited;
        for (slot, name) in inherited.iter_mut().zip(INHERITED) {
            *slot = self.own.get(name).or(*slot);
        }
        let kids = kids.iter().filter_map(|kid| objects.get(kid).dict());
        Some(kids.map(|own| Self { own, inherited }).collect())
    }

    /// An entry of the page itself, else of the nodes above it, followed.
    pub fn entry(&self, objects: &'a Objects, name: &str) -> Option<&'a Object> {
        let inherited = INHERITED.iter().position(|known| *known == name);
        let above = inherited.and_then(|i| self.inherited[i]);
        objects.entry(self.own, name).or(above.map(|o| objects.get(o)))
    }
}

fn scan(bytes: &[u8], budget: &Budget) -> Result<BTreeMap<u32, Object>, ArtError> {
    let mut objects = BTreeMap::new();
    let mut at = 0;
    while let Some(found) = find(bytes, b" obj", at) {
        at = found + 4;
        let Some(id) = number_before(bytes, found) else { continue };
        let mut lexer = Lexer::new(bytes, at, budget);
        let Some(object) = lexer.object()? else { continue };
        let object = match object {
            Object::Dict(dict) => stream(bytes, &mut lexer, dict),
            other => other,
        };
        at = lexer.at.max(at);
        budget.spend(Cost::Values, 4)?;
        objects.insert(id, object);
    }
    let is_locked = |d: &Dict| d.contains_key("Encrypt");
    let trailer = find(bytes, b"trailer", 0);
    let trailer = trailer.map(|t| Lexer::new(bytes, t + 7, budget).object()).transpose()?;
    if objects.values().filter_map(Object::dict).any(is_locked)
        || matches!(trailer.flatten(), Some(Object::Dict(d)) if is_locked(&d))
    {
        return Err(ArtError::Pdf("it is encrypted; save it without a password"));
    }
    let packed: Vec<u32> =
        objects.iter().filter(|(_, o)| type_of(o) == Some("ObjStm")).map(|(id, _)| *id).collect();
    for stream in packed {
        // Objects that stand by themselves are the newer ones.
        for (id, inner) in unpacked(&objects[&stream], budget)? {
            objects.entry(id).or_insert(inner);
        }
    }
    Ok(objects)
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
    let said = dict.get("Length").and_then(Object::number);
    let said = said.map(|length| start.saturating_add(length.max(0.0) as usize));
    // The length may be wrong, or stand elsewhere: what counts is where the stream says that it
    // ends.
    let is_end = |e: &usize| {
        let after = bytes.get(*e..).unwrap_or_default();
        (0..=2).any(|skipped| after.get(skipped..).is_some_and(|a| a.starts_with(b"endstream")))
    };
    let end =
        said.filter(is_end).or_else(|| find(bytes, b"endstream", start)).unwrap_or(bytes.len());
    lexer.at = end;
    Object::Stream(dict, bytes[start.min(end)..end].to_vec())
}

/// The objects inside an object stream.
fn unpacked(object: &Object, budget: &Budget) -> Result<Vec<(u32, Object)>, ArtError> {
    let Object::Stream(dict, raw) = object else { return Ok(Vec::new()) };
    let bytes = unpack(dict, raw, budget)?;
    let of = |name: &str| dict.get(name).and_then(Object::number).unwrap_or(0.0).max(0.0) as usize;
    let (count, first) = (of("N"), of("First"));
    let mut head = Lexer::new(&bytes, 0, budget);
    let mut inner = Vec::new();
    for _ in 0..count.min(bytes.len()) {
        let (Some(Object::Number(id)), Some(Object::Number(offset))) =
            (head.object()?, head.object()?)
        else {
            break;
        };
        let at = first.saturating_add(offset.max(0.0) as usize);
        if let Some(object) = Lexer::new(&bytes, at, budget).object()? {
            budget.spend(Cost::Values, 4)?;
            inner.push((id as u32, object));
        }
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
