//! PDF objects: numbers, names, strings, arrays, dictionaries, streams, and how they are written.

use std::collections::BTreeMap;

use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;

/// No page of lines needs more once it is unpacked.
const MOST_BYTES: usize = 256 << 20;

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
}

fn is_delimiter(b: u8) -> bool {
    b"()<>[]{}/%".contains(&b)
}

fn is_space(b: u8) -> bool {
    matches!(b, 0 | 9 | 10 | 12 | 13 | 32)
}

impl Lexer<'_> {
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
    pub fn object(&mut self) -> Option<Object> {
        self.nested(0)
    }

    fn nested(&mut self, depth: usize) -> Option<Object> {
        self.skip();
        if depth > DEEPEST {
            return None;
        }
        match *self.bytes.get(self.at)? {
            b'/' => Some(Object::Name(self.name())),
            b'(' => Some(Object::Text(self.string())),
            b'<' if self.bytes.get(self.at + 1) == Some(&b'<') => {
                self.at += 2;
                Some(Object::Dict(self.dict(depth)))
            }
            b'<' => Some(Object::Text(self.hex())),
            b'[' => {
                self.at += 1;
                let mut items = Vec::new();
                while let Some(item) = self.nested(depth + 1) {
                    items.push(item);
                }
                self.skip();
                self.at += usize::from(self.bytes.get(self.at) == Some(&b']'));
                Some(Object::Array(items))
            }
            b']' | b'>' | b')' | b'}' => None,
            b'{' => {
                self.at += 1;
                Some(Object::Null)
            }
            _ => Some(self.word()),
        }
    }

    fn dict(&mut self, depth: usize) -> Dict {
        let mut dict = Dict::new();
        while let Some(Object::Name(key)) = self.nested(depth + 1) {
            if let Some(value) = self.nested(depth + 1) {
                dict.insert(key, value);
            }
        }
        self.skip();
        if self.bytes[self.at.min(self.bytes.len())..].starts_with(b">>") {
            self.at += 2;
        }
        dict
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
                    text.extend(self.bytes.get(self.at));
                    self.at += 1;
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

    fn hex(&mut self) -> Vec<u8> {
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
        let Ok(number) = word.parse::<f64>() else { return Object::Word(word) };
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

/// The bytes of a stream, unpacked.
pub(super) fn unpack(dict: &Dict, raw: &[u8]) -> Result<Vec<u8>, &'static str> {
    let list = |object: Option<&Object>| match object {
        Some(Object::Array(items)) => items.clone(),
        Some(other) => vec![other.clone()],
        None => Vec::new(),
    };
    let filters = list(dict.get("Filter"));
    let parameters = list(dict.get("DecodeParms"));
    let mut bytes = raw.to_vec();
    for (i, filter) in filters.iter().enumerate() {
        bytes = match filter.name() {
            Some("FlateDecode" | "Fl") => {
                let plain = decompress_to_vec_zlib_with_limit(&bytes, MOST_BYTES);
                // What could be unpacked before a fault at the end is used, as other readers do.
                let plain = plain.unwrap_or_else(|e| e.output);
                predicted(plain, parameters.get(i).and_then(Object::dict))
            }
            Some("ASCIIHexDecode" | "AHx") => {
                Lexer { bytes: &[b"<", &bytes[..]].concat(), at: 0 }.hex()
            }
            Some("ASCII85Decode" | "A85") => ascii85(&bytes),
            _ => {
                return Err(
                    "a page is packed in a way that is not read (LZW or encrypted); export it \
                    again as PDF 1.4 or later",
                );
            }
        };
    }
    Ok(bytes)
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
    let width =
        (of("Columns", 1.0) * of("Colors", 1.0) * of("BitsPerComponent", 8.0)).div_ceil(8).max(1);
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
