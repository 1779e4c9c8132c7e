//! The reader of the selection language: recursive descent, one character ahead.
//!
//! ```text
//! or    = and { "|" and }
//! and   = not { "&" not }
//! not   = "!" not | "(" or ")" | atom
//! atom  = ids | word | word sign value | "matching" ":" number
//! ids   = run { "," run }          run = number [ "-" number ]
//! sign  = "=" | "!=" | "<" | "<=" | ">" | ">="
//! value = text up to the next "&", "|", "(" or ")", or text in quotes
//! ```

use glam::DVec3;

use super::conditions::words;
use super::expr::{Atom, Compare, Expr};
use super::seams::Folds;
use crate::code::codes;
use crate::units::{Angle, Direction, Length, nearest_word, parse_number};

/// Why a text is no selection. Columns are counted in characters, from 1.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ParseError {
    /// Nothing was typed.
    #[error("the selection is empty; write for example all, valence=4 or 3,7,10-14")]
    Empty,
    /// A word that the language does not have.
    #[error("`{word}` at column {column} is not known; {}", hint(nearest.as_deref()))]
    UnknownWord {
        /// The word.
        word: String,
        /// Where it begins.
        column: usize,
        /// The nearest word that exists.
        nearest: Option<String>,
    },
    /// Something else should stand here.
    #[error("{found} at column {column}, but {wanted} was expected")]
    Unexpected {
        /// What stands there.
        found: String,
        /// Where.
        column: usize,
        /// What may stand there.
        wanted: &'static str,
    },
    /// A value that cannot be read.
    #[error("`{text}` at column {column} is not {wanted}; write it like {example}")]
    Value {
        /// The value.
        text: String,
        /// Where it begins.
        column: usize,
        /// What it should be.
        wanted: &'static str,
        /// An example to copy.
        example: &'static str,
    },
    /// Too many brackets or `!` within each other.
    #[error(
        "more than {limit} brackets or `!` within each other at column {column}; write the \
        selection flatter"
    )]
    TooDeep {
        /// How many may be.
        limit: usize,
        /// Where the limit was passed.
        column: usize,
    },
}

codes!(error ParseError {
    Empty = 291,
    UnknownWord = 292,
    Unexpected = 293,
    Value = 294,
    TooDeep = 295,
});

fn hint(nearest: Option<&str>) -> String {
    match nearest {
        Some(word) => format!("did you mean `{word}`?"),
        None => format!("the words are {}", words().collect::<Vec<_>>().join(", ")),
    }
}

/// How far expressions may nest: deep enough for people, shallow enough for the stack.
const DEEPEST: usize = 64;

/// The tolerance of `along` and `normal` when none is typed.
const DEFAULT_TOLERANCE: Angle = Angle::from_degrees(1.0);

const WANT_ATOM: &str = "a condition like all, valence=4 or 3,7,10-14";
const WANT_JOIN: &str = "`&`, `|` or the end (a name with such signs goes in quotes)";

/// Reads a whole selection.
pub(super) fn parse(text: &str) -> Result<Expr, ParseError> {
    if text.trim().is_empty() {
        return Err(ParseError::Empty);
    }
    let mut parser = Parser { text, at: 0, depth: 0 };
    let expr = parser.or()?;
    if parser.at < text.len() { Err(parser.unexpected(WANT_JOIN)) } else { Ok(expr) }
}

struct Parser<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl<'a> Parser<'a> {
    fn or(&mut self) -> Result<Expr, ParseError> {
        self.chain('|', Self::and, Expr::Or)
    }

    fn and(&mut self) -> Result<Expr, ParseError> {
        self.chain('&', Self::not, Expr::And)
    }

    fn chain(
        &mut self,
        sign: char,
        part: fn(&mut Self) -> Result<Expr, ParseError>,
        join: fn(Vec<Expr>) -> Expr,
    ) -> Result<Expr, ParseError> {
        let first = part(self)?;
        let mut parts = vec![first];
        while self.takes(sign) {
            parts.push(part(self)?);
        }
        Ok(if parts.len() == 1 { parts.remove(0) } else { join(parts) })
    }

    fn not(&mut self) -> Result<Expr, ParseError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(ParseError::TooDeep { limit: DEEPEST, column: self.column(self.at) });
        }
        let expr = if self.takes('!') {
            Expr::Not(Box::new(self.not()?))
        } else if self.takes('(') {
            let inner = self.or()?;
            if !self.takes(')') {
                return Err(self.unexpected("`&`, `|` or `)`"));
            }
            inner
        } else {
            Expr::Atom(self.atom()?)
        };
        self.depth -= 1;
        Ok(expr)
    }

    fn atom(&mut self) -> Result<Atom, ParseError> {
        match self.peek() {
            Some(c) if c.is_ascii_digit() => self.ids(),
            Some(c) if c.is_alphabetic() => self.word(),
            _ => Err(self.unexpected(WANT_ATOM)),
        }
    }

    fn ids(&mut self) -> Result<Atom, ParseError> {
        let (start, text) = self.take_while(|c| !"&|()!".contains(c));
        let run = |part: &str| {
            let (first, last) = part.split_once('-').unwrap_or((part, part));
            let number = |t: &str| {
                Some(t.trim())
                    .filter(|t| t.bytes().all(|b| b.is_ascii_digit()))?
                    .parse::<u32>()
                    .ok()
            };
            Some((number(first)?, number(last)?)).filter(|(first, last)| first <= last)
        };
        let runs: Option<Vec<_>> = text.split(',').map(run).collect();
        runs.map(Atom::Ids).ok_or_else(|| self.bad(start, text, "a list of ids", "3,7,10-14"))
    }

    fn word(&mut self) -> Result<Atom, ParseError> {
        let (start, word) = self.take_while(|c| c.is_alphanumeric() || c == '-' || c == '_');
        Ok(match word {
            "all" => Atom::All,
            "made" => Atom::Made,
            "strip" => Atom::Strip,
            // `dullest` is what recipes before 0.2 say.
            "flattest" | "dullest" => Atom::Folds(Folds::Flattest),
            "hamiltonian" => Atom::Folds(Folds::TwoPieces),
            "matching" => Atom::Folds(self.matching()?),
            "valence" => {
                let compare = self.compare()?;
                Atom::Valence(
                    compare,
                    self.value("a whole number", "valence=4", |t| t.parse().ok())?,
                )
            }
            "sides" => {
                let compare = self.compare()?;
                Atom::Sides(compare, self.value("a whole number", "sides=5", |t| t.parse().ok())?)
            }
            "fold" => {
                let compare = self.compare()?;
                Atom::Fold(compare, self.value("an angle", "fold>30deg", |t| t.parse().ok())?)
            }
            "along" => self.directed(
                "a direction and an angle",
                "along=z:5deg or along=1,1,0:5deg",
                Atom::Along,
            )?,
            "normal" => self.directed(
                "a direction and an angle",
                "normal=z:20deg or normal=1,1,0:20deg",
                Atom::Normal,
            )?,
            "above" => self.beyond(
                "a direction and a length",
                "above=z:10mm or above=1,1,0:10mm",
                Atom::Above,
            )?,
            "below" => self.beyond(
                "a direction and a length",
                "below=z:10mm or below=1,1,0:10mm",
                Atom::Below,
            )?,
            "group" => {
                self.equals()?;
                Atom::Group(self.value("a name", "group=roof", |t| unquoted(t).map(str::to_owned))?)
            }
            _ => {
                let nearest = nearest_word(word, words()).map(str::to_owned);
                return Err(ParseError::UnknownWord {
                    word: word.to_owned(),
                    column: self.column(start),
                    nearest,
                });
            }
        })
    }

    fn matching(&mut self) -> Result<Folds, ParseError> {
        if !self.takes(':') {
            return Ok(Folds::Least);
        }
        self.value("a whole number", "matching:7", |t| t.parse().ok()).map(Folds::Number)
    }

    /// A direction with an angle, which may be left out.
    fn directed(
        &mut self,
        wanted: &'static str,
        example: &'static str,
        atom: fn(Direction, Angle) -> Atom,
    ) -> Result<Atom, ParseError> {
        self.equals()?;
        self.value(wanted, example, |text| {
            let (towards, angle) = text.split_once(':').map_or((text, None), |(d, a)| (d, Some(a)));
            let angle = angle.map_or(Some(DEFAULT_TOLERANCE), |a| a.parse().ok())?;
            Some(atom(direction(towards)?, angle)).filter(|_| angle.degrees() >= 0.0)
        })
    }

    /// A direction with a length.
    fn beyond(
        &mut self,
        wanted: &'static str,
        example: &'static str,
        atom: fn(Direction, Length) -> Atom,
    ) -> Result<Atom, ParseError> {
        self.equals()?;
        self.value(wanted, example, |text| {
            let (towards, length) = text.split_once(':')?;
            Some(atom(direction(towards)?, length.parse().ok()?))
        })
    }

    fn compare(&mut self) -> Result<Compare, ParseError> {
        self.skip_blanks();
        let rest = &self.text[self.at..];
        let sign = Compare::SIGNS.iter().find(|(sign, _)| rest.starts_with(sign));
        let &(sign, compare) =
            sign.ok_or_else(|| self.unexpected("`=`, `!=`, `<`, `<=`, `>` or `>=`"))?;
        self.at += sign.len();
        Ok(compare)
    }

    fn equals(&mut self) -> Result<(), ParseError> {
        if self.takes('=') { Ok(()) } else { Err(self.unexpected("`=`")) }
    }

    /// Takes the text of a value and reads it by `read`.
    fn value<T>(
        &mut self,
        wanted: &'static str,
        example: &'static str,
        read: impl Fn(&str) -> Option<T>,
    ) -> Result<T, ParseError> {
        self.skip_blanks();
        let quote = self.peek().filter(|c| ['"', '\''].contains(c));
        let closing = quote.and_then(|q| self.text[self.at + 1..].find(q));
        let (start, text) = match closing {
            Some(length) => {
                let start = self.at;
                self.at += length + 2;
                (start, &self.text[start..self.at])
            }
            None => self.take_while(|c| !"&|()".contains(c)),
        };
        self.skip_blanks();
        read(text).ok_or_else(|| self.bad(start, text, wanted, example))
    }

    fn take_while(&mut self, is_part: impl Fn(char) -> bool) -> (usize, &'a str) {
        let start = self.at;
        let rest = &self.text[start..];
        let length = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
        self.at += length;
        self.skip_blanks();
        (start, rest[..length].trim_end())
    }

    fn takes(&mut self, sign: char) -> bool {
        let is_there = self.peek() == Some(sign);
        if is_there {
            self.at += sign.len_utf8();
        }
        is_there
    }

    fn peek(&mut self) -> Option<char> {
        self.skip_blanks();
        self.text[self.at..].chars().next()
    }

    fn skip_blanks(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
    }

    fn column(&self, at: usize) -> usize {
        self.text[..at].chars().count() + 1
    }

    fn unexpected(&mut self, wanted: &'static str) -> ParseError {
        let found =
            self.peek().map_or("the selection ends".to_owned(), |c| format!("`{c}` stands"));
        ParseError::Unexpected { found, column: self.column(self.at), wanted }
    }

    fn bad(
        &self,
        start: usize,
        text: &str,
        wanted: &'static str,
        example: &'static str,
    ) -> ParseError {
        ParseError::Value { text: text.to_owned(), column: self.column(start), wanted, example }
    }
}

/// An axis by name, with or without a sign, or three numbers that are not all zero.
fn direction(text: &str) -> Option<Direction> {
    let text = text.trim();
    let name = text.strip_prefix('+').unwrap_or(text);
    if let Some((_, axis)) = Direction::AXES.iter().find(|(axis, _)| *axis == name) {
        return Some(Direction(*axis));
    }
    let parts: Vec<f64> =
        text.split(',').map(|part| parse_number(part).ok()).collect::<Option<_>>()?;
    let vector = DVec3::from_array(parts.try_into().ok()?);
    (vector != DVec3::ZERO).then_some(Direction(vector))
}

/// A name without its quotes; `None` when it is empty.
fn unquoted(text: &str) -> Option<&str> {
    let inside = |quote: char| text.strip_prefix(quote)?.strip_suffix(quote);
    let name = inside('"').or_else(|| inside('\'')).unwrap_or(text);
    (!name.is_empty()).then_some(name)
}
