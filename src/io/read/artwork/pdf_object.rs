//! PDF objects: numbers, names, strings, arrays, dictionaries, streams, and how they are written.

use std::collections::BTreeMap;

use super::ArtError;
use super::budget::{Budget, Cost};

/// How deep arrays and dictionaries may be nested.
const DEEPEST: usize = 64;

/// See the module documentation.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Object {
    Null,
    Bool(bool),
    Number(f64),
    Name(String),
    Text(Vec<u8>),
    Array(Vec<Object>),
    Dict(Dict),
    Stream(Dict, Vec<u8>),
    Reference(u32),
    /// A word that is none of these: an operator of a content stream.
    Word(String),
}

/// Names with their objects.
pub(super) type Dict = BTreeMap<String, Object>;

impl Object {
    pub fn number(&self) -> Option<f64> {
        if let Self::Number(n) = self { Some(*n) } else { None }
    }

    pub fn name(&self) -> Option<&str> {
        if let Self::Name(n) = self { Some(n) } else { None }
    }

    pub fn dict(&self) -> Option<&Dict> {
        match self {
            Self::Dict(d) | Self::Stream(d, _) => Some(d),
            _ => None,
        }
    }
}

/// Reads objects from bytes.
pub(super) struct Lexer<'a> {
    pub bytes: &'a [u8],
    pub at: usize,
    budget: &'a Budget,
}

fn is_delimiter(b: u8) -> bool {
    b"()<>[]{}/%".contains(&b)
}

fn is_space(b: u8) -> bool {
    matches!(b, 0 | 9 | 10 | 12 | 13 | 32)
}

impl<'a> Lexer<'a> {
    pub fn new(bytes: &'a [u8], at: usize, budget: &'a Budget) -> Self {
        Self { bytes, at, budget }
    }

    pub fn skip(&mut self) {
        while let Some(&b) = self.bytes.get(self.at) {
            if b == b'%' {
                let rest = &self.bytes[self.at..];
                self.at +=
                    rest.iter().position(|b| matches!(b, b'\n' | b'\r')).unwrap_or(rest.len());
            } else if is_space(b) {
                self.at += 1;
            } else {
                break;
            }
        }
    }

    /// The next object; nothing at the end or at a closing bracket.
    pub fn object(&mut self) -> Result<Option<Object>, ArtError> {
        let start = self.at;
        let object = self.nested(0)?;
        self.budget.spend(Cost::Steps, self.at.saturating_sub(start) + 1)?;
        Ok(object)
    }

    fn nested(&mut self, depth: usize) -> Result<Option<Object>, ArtError> {
        self.skip();
        if depth > DEEPEST {
            return Err(ArtError::TooDeep);
        }
        let Some(&byte) = self.bytes.get(self.at) else { return Ok(None) };
        Ok(match byte {
            b'/' => Some(Object::Name(self.name())),
            b'(' => Some(Object::Text(self.string())),
            b'<' if self.bytes.get(self.at + 1) == Some(&b'<') => {
                self.at += 2;
                Some(Object::Dict(self.dict(depth)?))
            }
            b'<' => Some(Object::Text(self.hex())),
            b'[' => {
                self.at += 1;
                Some(Object::Array(self.array(depth)?))
            }
            b']' | b'>' | b')' | b'}' => None,
            b'{' => {
                self.at += 1;
                Some(Object::Null)
            }
            _ => Some(self.word()),
        })
    }

    fn array(&mut self, depth: usize) -> Result<Vec<Object>, ArtError> {
        let mut items = Vec::new();
        while let Some(item) = self.nested(depth + 1)? {
            self.budget.spend(Cost::Values, 1)?;
            items.push(item);
        }
        self.skip();
        self.at += usize::from(self.bytes.get(self.at) == Some(&b']'));
        Ok(items)
    }

    fn dict(&mut self, depth: usize) -> Result<Dict, ArtError> {
        let mut dict = Dict::new();
        while let Some(Object::Name(key)) = self.nested(depth + 1)? {
            if let Some(value) = self.nested(depth + 1)? {
                // An entry takes about as much as that many numbers.
                self.budget.spend(Cost::Values, 4)?;
                dict.insert(key, value);
            }
        }
        self.skip();
        if self.bytes[self.at..].starts_with(b">>") {
            self.at += 2;
        }
        Ok(dict)
    }

    fn name(&mut self) -> String {
        self.at += 1;
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(|&b| !is_space(b) && !is_delimiter(b)) {
            self.at += 1;
        }
        let raw = &self.bytes[start..self.at];
        let mut name = Vec::with_capacity(raw.len());
        let mut i = 0;
        while i < raw.len() {
            let code = (raw[i] == b'#').then(|| raw.get(i + 1..i + 3)).flatten();
            let code = code
                .and_then(|c| std::str::from_utf8(c).ok())
                .and_then(|c| u8::from_str_radix(c, 16).ok());
            name.push(code.unwrap_or(raw[i]));
            i += if code.is_some() { 3 } else { 1 };
        }
        String::from_utf8_lossy(&name).into_owned()
    }

    fn string(&mut self) -> Vec<u8> {
        self.at += 1;
        let (mut text, mut open) = (Vec::new(), 1);
        while let Some(&b) = self.bytes.get(self.at) {
            self.at += 1;
            match b {
                b'\\' => {
                    // Escapes that stand for other characters do not matter to a judge of lines.
                    // The file may end here, and no place lies behind its end.
                    if let Some(&escaped) = self.bytes.get(self.at) {
                        text.push(escaped);
                        self.at += 1;
                    }
                    continue;
                }
                b'(' => open += 1,
                b')' => open -= 1,
                _ => {}
            }
            if open == 0 {
                break;
            }
            text.push(b);
        }
        text
    }

    pub fn hex(&mut self) -> Vec<u8> {
        self.at += 1;
        let mut digits = Vec::new();
        while let Some(&b) = self.bytes.get(self.at) {
            self.at += 1;
            if b == b'>' {
                break;
            }
            digits.extend(char::from(b).to_digit(16).map(|d| d as u8));
        }
        digits.chunks(2).map(|pair| pair[0] << 4 | pair.get(1).copied().unwrap_or(0)).collect()
    }

    /// A number, a reference, or a word.
    fn word(&mut self) -> Object {
        let word = self.token();
        match word.as_str() {
            "true" => return Object::Bool(true),
            "false" => return Object::Bool(false),
            "null" => return Object::Null,
            _ => {}
        }
        // No power of ten, and neither `inf` nor `nan`: those are words here.
        let is_of_number = |b: u8| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.');
        let number = word.parse::<f64>().ok().filter(|_| word.bytes().all(is_of_number));
        let Some(number) = number else { return Object::Word(word) };
        if word.bytes().all(|b| b.is_ascii_digit()) {
            let after = self.at;
            self.skip();
            let generation = self.token();
            self.skip();
            let is_reference = !generation.is_empty()
                && generation.bytes().all(|b| b.is_ascii_digit())
                && self.token() == "R";
            if let (true, Ok(id)) = (is_reference, word.parse()) {
                return Object::Reference(id);
            }
            self.at = after;
        }
        Object::Number(number)
    }

    pub fn token(&mut self) -> String {
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(|&b| !is_space(b) && !is_delimiter(b)) {
            self.at += 1;
        }
        if self.at == start && self.at < self.bytes.len() && !is_delimiter(self.bytes[self.at]) {
            self.at += 1;
        }
        String::from_utf8_lossy(&self.bytes[start..self.at]).into_owned()
    }
}
