//! Codes of errors and findings.
//!
//! A code is a letter and a number: `E302` is an error, `F104` a finding. The tables stand beside
//! the enums they number (macro `codes!`); the pages stand in `docs/errors.md`, two sentences each.
//! Each room has a range of its own:
//!
//! | range | room |
//! |---|---|
//! | E001–E099 | `cli` |
//! | E101–E199 | `io` |
//! | E201–E299 | `units`, `geom`, `mesh`, `shape`, `select` |
//! | E301–E399 | `op` |
//! | E401–E499 | `seam`, `unfold` |
//! | E501–E599 | `sheet` |
//! | E601–E699 | `panel` |
//! | E701–E799 | `recipe` |
//! | E801–E899 | `check`, `lint`, `picture` |
//! | E901–E949 | the studio |
//! | F101–F199 | `check` |
//! | F201–F299 | `lint` |
//! | F301–F399 | `panel` |
//! | F401–F499 | the proof of `unfold` |
//! | F501–F599 | `op` |
//!
//! A number never changes its meaning once it is given, and that of a variant that is gone is not
//! given again.

use std::fmt;

/// What kind of thing a code names.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Kind {
    Error,
    Finding,
}

impl Kind {
    const fn letter(self) -> char {
        match self {
            Self::Error => 'E',
            Self::Finding => 'F',
        }
    }
}

/// The code of an error or a finding; shown as `E302` or `F104`. Errors come before findings, then
/// numbers ascend.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code {
    kind: Kind,
    number: u16,
}

impl Code {
    /// The code of an error; numbers go from 1 to 999.
    pub const fn error(number: u16) -> Self {
        Self { kind: Kind::Error, number }
    }

    /// The code of a finding; numbers go from 1 to 999.
    pub const fn finding(number: u16) -> Self {
        Self { kind: Kind::Finding, number }
    }

    /// Reads what [`fmt::Display`] writes; small letters do as well, and so does a number without
    /// its zeros. `None` when the text is no code.
    pub fn read(text: &str) -> Option<Self> {
        let kind = match text.get(..1)? {
            "E" | "e" => Kind::Error,
            "F" | "f" => Kind::Finding,
            _ => return None,
        };
        let digits = Some(&text[1..])
            .filter(|t| (1..=3).contains(&t.len()) && t.bytes().all(|b| b.is_ascii_digit()))?;
        Some(Self { kind, number: digits.parse().ok()? })
    }

    /// How far two codes of the same kind are apart; `None` for those of different kinds.
    pub fn distance(self, other: Self) -> Option<u16> {
        (self.kind == other.kind).then(|| self.number.abs_diff(other.number))
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{:03}", self.kind.letter(), self.number)
    }
}

/// An error or finding with a code.
pub trait Coded {
    /// Its code; where one error only carries another, that of the innermost.
    fn code(&self) -> Code;
}

/// Numbers the variants of an enum, or a struct. A variant without a number does not compile.
/// Variants that only carry another error stand behind `through` with the field that holds it; they
/// show its code.
///
/// ```text
/// codes!(error OpError { OffsetOutOfRange = 301, Cancelled = 302 } through { Select.0, NoHull.reason });
/// codes!(finding Check { OpenContour = 201 });
/// codes!(error struct UnitError = 201);
/// ```
#[macro_export]
macro_rules! codes {
    ($kind:ident struct $type:ident = $number:literal) => {
        impl $crate::code::Coded for $type {
            fn code(&self) -> $crate::code::Code {
                $crate::code::Code::$kind($number)
            }
        }
    };
    (
        $kind:ident $type:ident { $($variant:ident = $number:literal),* $(,)? }
        $(through { $($outer:ident . $field:tt),* $(,)? })?
    ) => {
        impl $crate::code::Coded for $type {
            fn code(&self) -> $crate::code::Code {
                match self {
                    $(Self::$variant { .. } => $crate::code::Code::$kind($number),)*
                    $($(Self::$outer { $field: inner, .. } => $crate::code::Coded::code(inner),)*)?
                }
            }
        }
    };
}
pub use crate::codes;

impl<T: Coded + ?Sized> Coded for Box<T> {
    fn code(&self) -> Code {
        (**self).code()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    enum Inner {
        Lost { _at: usize },
        Found(()),
    }
    codes!(error Inner { Lost = 7, Found = 12 });

    enum Outer {
        Alone,
        Tuple(Inner),
        Named { error: Box<Inner> },
    }
    codes!(finding Outer { Alone = 999 } through { Tuple.0, Named.error });

    #[test]
    fn the_innermost_error_gives_the_code() {
        let shown = |coded: &dyn Coded| coded.code().to_string();
        assert_eq!(shown(&Outer::Alone), "F999");
        assert_eq!(shown(&Outer::Tuple(Inner::Found(()))), "E012");
        assert_eq!(shown(&Outer::Named { error: Box::new(Inner::Lost { _at: 3 }) }), "E007");
    }

    #[test]
    fn codes_are_read_as_they_are_written() {
        for code in [Code::error(1), Code::error(302), Code::finding(999)] {
            assert_eq!(Code::read(&code.to_string()), Some(code));
            assert_eq!(Code::read(&code.to_string().to_lowercase()), Some(code));
        }
        assert_eq!(Code::read("E12"), Some(Code::error(12)));
        for no_code in ["", "E", "E0012", "G012", "E+12", "302", "É12", "planarity"] {
            assert_eq!(Code::read(no_code), None, "{no_code}");
        }
    }
}
