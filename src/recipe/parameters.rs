//! The parameters of a recipe: names with values, used as `"{size}"` or in arithmetic as
//! `"{size}/3"`.
//!
//! They stand in texts. A text that is arithmetic on parameters and quantities becomes its result,
//! with a unit; in any other text each `{name}` gives way to its value as it is written.

use std::borrow::Cow;
use std::str::FromStr;

use crate::units::{Angle, Length, nearest_word};

/// Names and values, in the order of the recipe.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Parameters {
    values: Vec<(String, String)>,
}

/// A number with what it measures.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Quantity {
    x: f64,
    kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Number,
    /// In mm.
    Length,
    /// In degrees.
    Angle,
}

impl Parameters {
    pub(super) fn add(&mut self, name: String, value: String) {
        self.values.push((name, value));
    }

    pub(super) fn names(&self) -> Vec<&str> {
        self.values.iter().map(|(name, _)| name.as_str()).collect()
    }

    /// Gives a parameter another value; `false` when there is none of the name.
    pub(super) fn set(&mut self, name: &str, value: &str) -> bool {
        let found = self.values.iter_mut().find(|(known, _)| known == name);
        found.map(|(_, old)| value.clone_into(old)).is_some()
    }

    fn get(&self, name: &str) -> Option<&str> {
        self.values.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The text of a TOML value with parameters in their places.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub(super) fn fill<'t>(&self, value: &'t str) -> Result<Cow<'t, str>, String> {
        let mut filled = String::new();
        let mut rest = value;
        while let Some(start) = rest.find(['"', '\'']) {
            let quote = &rest[start..=start];
            let Some(length) = rest[start + 1..].find(quote) else { break };
            let content = &rest[start + 1..start + 1 + length];
            let is_whole = start == 0 && filled.is_empty() && length + 2 == rest.len();
            filled += &rest[..start];
            // An escaped text is no place for parameters.
            if has_name(content) && !content.contains('\\') {
                filled += &self.literal(content, is_whole)?;
            } else {
                filled += &rest[start..start + 2 + length];
            }
            rest = &rest[start + 2 + length..];
        }
        if filled.is_empty() {
            return Ok(Cow::Borrowed(value));
        }
        filled += rest;
        Ok(Cow::Owned(filled))
    }

    /// What stands in the place of a text; a plain number is none when it is the whole value.
    fn literal(&self, content: &str, is_whole: bool) -> Result<String, String> {
        for name in names_in(content) {
            if self.get(name).is_none() {
                return Err(self.unknown(name));
            }
        }
        let lone = content.trim().strip_prefix('{').and_then(|text| text.strip_suffix('}'));
        let text = match lone.and_then(|name| self.get(name)) {
            Some(value) => value.to_owned(),
            None => match Arithmetic::of(self, content) {
                Some(Ok(quantity)) => quantity.to_string(),
                Some(Err(wrong)) => return Err(format!("`{content}`: {wrong}")),
                None => self.replaced(content),
            },
        };
        let is_number = is_whole && text.parse::<f64>().is_ok_and(f64::is_finite);
        Ok(if is_number { text } else { format!("\"{}\"", text.replace('"', "\\\"")) })
    }

    /// What is wrong with a name that is not known.
    pub(super) fn unknown(&self, name: &str) -> String {
        let names = self.names();
        let advice = match (nearest_word(name, names.iter().copied()), names.is_empty()) {
            (Some(near), _) => format!("did you mean `{near}`?"),
            (None, true) => "the recipe has no [parameters]".to_owned(),
            (None, false) => format!("known are {}", names.join(", ")),
        };
        format!("there is no parameter `{name}`; {advice}")
    }

    fn replaced(&self, content: &str) -> String {
        let mut text = content.to_owned();
        for (name, value) in &self.values {
            text = text.replace(&format!("{{{name}}}"), value);
        }
        text
    }
}

/// Whether a text names a parameter.
fn has_name(content: &str) -> bool {
    names_in(content).next().is_some()
}

/// The names in curly brackets: letters, digits, `_` and `-`, beginning with a letter.
fn names_in(content: &str) -> impl Iterator<Item = &str> {
    content.split('{').skip(1).filter_map(|rest| {
        let name = &rest[..rest.find('}')?];
        is_name(name).then_some(name)
    })
}

/// Whether a text can name a parameter.
pub(super) fn is_name(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == '-')
}

impl FromStr for Quantity {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        let text = text.trim();
        let is = |kind, x: f64| Self { x, kind };
        if let Ok(x) = crate::units::parse_number(text) {
            return Ok(is(Kind::Number, x));
        }
        if let Ok(length) = text.parse::<Length>() {
            return Ok(is(Kind::Length, length.mm()));
        }
        text.parse::<Angle>().map(|angle| is(Kind::Angle, angle.degrees())).map_err(|_| ())
    }
}

impl std::fmt::Display for Quantity {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let unit = match self.kind {
            Kind::Number => "",
            Kind::Length => "mm",
            Kind::Angle => "deg",
        };
        write!(f, "{}{unit}", self.x)
    }
}

/// A text read as sums and products of quantities.
struct Arithmetic<'a> {
    parameters: &'a Parameters,
    rest: &'a str,
}

/// `None` for a text that is no arithmetic, an error for arithmetic that makes no sense.
type Found = Option<Result<Quantity, String>>;

impl<'a> Arithmetic<'a> {
    fn of(parameters: &'a Parameters, text: &'a str) -> Found {
        let mut reader = Self { parameters, rest: text.trim() };
        let found = reader.sum()?;
        if reader.rest.is_empty() { Some(found) } else { None }
    }

    fn take(&mut self, signs: &[char]) -> Option<char> {
        let sign = self.rest.chars().next().filter(|c| signs.contains(c))?;
        self.rest = self.rest[1..].trim_start();
        Some(sign)
    }

    fn sum(&mut self) -> Found {
        let mut total = self.product()?;
        while let Some(sign) = self.take(&['+', '-']) {
            let next = self.product()?;
            total = total.and_then(|a| next.and_then(|b| added(a, b, sign)));
        }
        Some(total)
    }

    fn product(&mut self) -> Found {
        let mut total = self.factor()?;
        while let Some(sign) = self.take(&['*', '/']) {
            let next = self.factor()?;
            total = total.and_then(|a| next.and_then(|b| multiplied(a, b, sign)));
        }
        Some(total)
    }

    fn factor(&mut self) -> Found {
        if self.take(&['(']).is_some() {
            let inner = self.sum()?;
            return self.take(&[')']).map(|_| inner);
        }
        if self.take(&['-']).is_some() {
            let inner = self.factor()?;
            return Some(inner.map(|q| Quantity { x: -q.x, ..q }));
        }
        let end = match self.rest.strip_prefix('{') {
            Some(inner) => inner.find('}')? + 2,
            None => self.rest.find(|c: char| "+-*/() ".contains(c)).unwrap_or(self.rest.len()),
        };
        let (word, rest) = self.rest.split_at(end);
        self.rest = rest.trim_start();
        let name = word.strip_prefix('{').and_then(|word| word.strip_suffix('}'));
        let text = name.map_or(Some(word), |name| self.parameters.get(name))?;
        text.parse().ok().map(Ok)
    }
}

fn added(a: Quantity, b: Quantity, sign: char) -> Result<Quantity, String> {
    if a.kind != b.kind {
        return Err(format!("{a} and {b} do not measure the same, so they cannot be added"));
    }
    Ok(Quantity { x: if sign == '+' { a.x + b.x } else { a.x - b.x }, kind: a.kind })
}

fn multiplied(a: Quantity, b: Quantity, sign: char) -> Result<Quantity, String> {
    let kind = match (a.kind, b.kind, sign) {
        (kind, Kind::Number, _) | (Kind::Number, kind, '*') => kind,
        (one, other, '/') if one == other => Kind::Number,
        _ => return Err(format!("{a} {sign} {b} is no length, angle or number")),
    };
    let x = if sign == '*' { a.x * b.x } else { a.x / b.x };
    if x.is_finite() {
        Ok(Quantity { x, kind })
    } else {
        Err(format!("{a} {sign} {b} is no number"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters() -> Parameters {
        let mut parameters = Parameters::default();
        for (name, value) in [
            ("size", "180mm"),
            ("n", "4"),
            ("tilt", "30deg"),
            ("sheet", "600x400"),
            ("eighth", "1/8in"),
        ] {
            parameters.add(name.to_owned(), value.to_owned());
        }
        parameters
    }

    #[test]
    fn texts_become_values_or_results() {
        for (text, filled) in [
            ("\"{size}\"", "\"180mm\""),
            ("\"{size}/3\"", "\"60mm\""),
            ("'{size} / {n} + 1cm'", "\"55mm\""),
            ("\"({size} - 20mm) * 2\"", "\"320mm\""),
            ("\"-{tilt}/2\"", "\"-15deg\""),
            ("\"{n}\"", "4"),
            ("\"{n}*2\"", "8"),
            ("\"{size}/{size}\"", "1"),
            ("\"{sheet}\"", "\"600x400\""),
            ("\"{n}x{n}\"", "\"4x4\""),
            ("\"above=z:{size}\"", "\"above=z:180mm\""),
            ("\"{eighth}*2\"", "\"6.35mm\""),
            ("[\"{n}\", \"{size}\"]", "[\"4\", \"180mm\"]"),
            ("\"plain\"", "\"plain\""),
            ("\"{1,2}\"", "\"{1,2}\""),
            ("3.5", "3.5"),
        ] {
            assert_eq!(parameters().fill(text).expect(text), filled, "{text}");
        }
    }

    #[test]
    fn nonsense_is_told() {
        for (text, what) in [
            ("\"{sise}\"", "did you mean `size`?"),
            ("\"{size}+{tilt}\"", "do not measure the same"),
            ("\"{size}*{size}\"", "is no length"),
            ("\"{size}/0\"", "is no number"),
        ] {
            let told = parameters().fill(text).expect_err(text);
            assert!(told.contains(what), "{text}: {told}");
        }
        assert!(Parameters::default().fill("\"{a}\"").expect_err("none").contains("[parameters]"));
    }
}
