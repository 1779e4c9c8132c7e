//! Formulas in x and y: `2*sin(x/3) + cos(y/2)`.

use super::PanelizeError;

/// A formula that was read.
#[derive(Debug, Clone)]
pub(super) enum Formula {
    Number(f64),
    X,
    Y,
    Negative(Box<Self>),
    Two(char, Box<Self>, Box<Self>),
    Call(Function, Vec<Self>),
}

/// Functions with the number of their arguments.
#[derive(Debug, Clone, Copy)]
pub(super) struct Function {
    name: &'static str,
    arguments: usize,
    value: fn(&[f64]) -> f64,
}

const fn function(name: &'static str, arguments: usize, value: fn(&[f64]) -> f64) -> Function {
    Function { name, arguments, value }
}

const FUNCTIONS: &[Function] = &[
    function("sin", 1, |a| a[0].sin()),
    function("cos", 1, |a| a[0].cos()),
    function("tan", 1, |a| a[0].tan()),
    function("sinh", 1, |a| a[0].sinh()),
    function("cosh", 1, |a| a[0].cosh()),
    function("tanh", 1, |a| a[0].tanh()),
    function("exp", 1, |a| a[0].exp()),
    function("ln", 1, |a| a[0].ln()),
    function("sqrt", 1, |a| a[0].sqrt()),
    function("abs", 1, |a| a[0].abs()),
    function("min", 2, |a| a[0].min(a[1])),
    function("max", 2, |a| a[0].max(a[1])),
    function("hypot", 2, |a| a[0].hypot(a[1])),
    function("atan2", 2, |a| a[0].atan2(a[1])),
];

/// Brackets may stand so deep in each other.
const DEEPEST: usize = 100;
/// Longer formulas are refused, in bytes: a chain of terms is as deep as it is long.
const LONGEST: usize = 4000;

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// [`PanelizeError::Formula`] with the column.
    pub(super) fn read(text: &str) -> Result<Self, PanelizeError> {
        let mut reader = Reader { text, at: 0, depth: 0 };
        if text.len() > LONGEST {
            return Err(reader.wrong("a shorter formula"));
        }
        let formula = reader.sum()?;
        reader.blanks();
        if reader.at < text.len() {
            return Err(reader.wrong("an operator, or the end"));
        }
        Ok(formula)
    }

    /// Its value.
    pub(super) fn at(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Number(number) => *number,
            Self::X => x,
            Self::Y => y,
            Self::Negative(a) => -a.at(x, y),
            Self::Two(sign, a, b) => {
                let (a, b) = (a.at(x, y), b.at(x, y));
                match sign {
                    '+' => a + b,
                    '-' => a - b,
                    '*' => a * b,
                    '/' => a / b,
                    _ => a.powf(b),
                }
            }
            Self::Call(function, arguments) => {
                let values: Vec<f64> = arguments.iter().map(|a| a.at(x, y)).collect();
                (function.value)(&values)
            }
        }
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl Reader<'_> {
    fn wrong(&self, wanted: &str) -> PanelizeError {
        PanelizeError::Formula {
            text: self.text.to_owned(),
            column: self.text[..self.at].chars().count() + 1,
            wanted: wanted.to_owned(),
        }
    }

    fn blanks(&mut self) {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start().len();
    }

    fn next(&mut self) -> Option<char> {
        self.blanks();
        self.text[self.at..].chars().next()
    }

    /// Takes one of some signs.
    fn take(&mut self, signs: &str) -> Option<char> {
        let sign = self.next().filter(|&c| signs.contains(c))?;
        self.at += sign.len_utf8();
        Some(sign)
    }

    fn sum(&mut self) -> Result<Formula, PanelizeError> {
        let mut left = self.product()?;
        while let Some(sign) = self.take("+-") {
            left = Formula::Two(sign, Box::new(left), Box::new(self.product()?));
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Formula, PanelizeError> {
        let mut left = self.signed()?;
        while let Some(sign) = self.take("*/") {
            left = Formula::Two(sign, Box::new(left), Box::new(self.signed()?));
        }
        Ok(left)
    }

    fn signed(&mut self) -> Result<Formula, PanelizeError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.wrong("fewer brackets in each other"));
        }
        let made = if self.take("-").is_some() {
            Formula::Negative(Box::new(self.signed()?))
        } else {
            let base = self.single()?;
            match self.take("^") {
                Some(sign) => Formula::Two(sign, Box::new(base), Box::new(self.signed()?)),
                None => base,
            }
        };
        self.depth -= 1;
        Ok(made)
    }

    fn single(&mut self) -> Result<Formula, PanelizeError> {
        if self.take("(").is_some() {
            let inner = self.sum()?;
            return if self.take(")").is_some() { Ok(inner) } else { Err(self.wrong("a `)`")) };
        }
        match self.next() {
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_ascii_alphabetic() => self.word(),
            _ => Err(self.wrong("a number, x, y, a function or a bracket")),
        }
    }

    fn number(&mut self) -> Result<Formula, PanelizeError> {
        let rest = &self.text[self.at..];
        let digits = |text: &str| {
            text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit() || c == '.').len()
        };
        let mut length = digits(rest);
        // An exponent belongs to the number only with digits behind it.
        if let Some(power) = rest[length..].strip_prefix(['e', 'E']) {
            let sign = usize::from(power.starts_with(['+', '-']));
            let more = digits(&power[sign..]);
            length += if more > 0 { 1 + sign + more } else { 0 };
        }
        let number = rest[..length].parse().map_err(|_| self.wrong("a number"))?;
        self.at += length;
        Ok(Formula::Number(number))
    }

    fn word(&mut self) -> Result<Formula, PanelizeError> {
        let rest = &self.text[self.at..];
        let length =
            rest.len() - rest.trim_start_matches(|c: char| c.is_ascii_alphanumeric()).len();
        let word = &rest[..length];
        match word {
            "x" | "y" | "pi" => {
                self.at += length;
                return Ok(match word {
                    "x" => Formula::X,
                    "y" => Formula::Y,
                    _ => Formula::Number(std::f64::consts::PI),
                });
            }
            _ => {}
        }
        let Some(&function) = FUNCTIONS.iter().find(|f| f.name == word) else {
            let names: Vec<&str> = FUNCTIONS.iter().map(|f| f.name).collect();
            return Err(self.wrong(&format!("x, y, pi or one of {}", names.join(", "))));
        };
        self.at += length;
        self.call(function)
    }

    fn call(&mut self, function: Function) -> Result<Formula, PanelizeError> {
        if self.take("(").is_none() {
            return Err(self.wrong("a `(`"));
        }
        let mut arguments = vec![self.sum()?];
        while arguments.len() < function.arguments {
            if self.take(",").is_none() {
                return Err(self.wrong("a `,` and another argument"));
            }
            arguments.push(self.sum()?);
        }
        if self.take(")").is_none() {
            return Err(self.wrong("a `)`"));
        }
        Ok(Formula::Call(function, arguments))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_have_the_values_that_arithmetic_gives() {
        for (text, value) in [
            ("1 + 2*3", 7.0),
            ("-2^2", -4.0),
            ("2^-1", 0.5),
            ("2^3^2", 512.0),
            ("(1 - 2) - 3", -4.0),
            ("8/2/2", 2.0),
            ("x*y - x", 0.0),
            ("max(x, 10*y) + hypot(3,4)", 15.0),
            ("cos(pi) + sqrt(4)", 1.0),
            ("1.5e1 - .5", 14.5),
        ] {
            let formula = Formula::read(text).expect(text);
            assert!((formula.at(2.0, 1.0) - value).abs() < 1e-14, "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_told_with_its_column() {
        for (text, at) in [
            ("", 1),
            ("2*", 3),
            ("2 x", 3),
            ("sin x", 5),
            ("(1", 3),
            ("sine(x)", 1),
            ("max(1)", 6),
            ("1..2", 1),
            ("3 + é", 5),
        ] {
            match Formula::read(text) {
                Err(PanelizeError::Formula { column, .. }) => assert_eq!(column, at, "{text}"),
                other => panic!("{text}: {other:?}"),
            }
        }
        assert!(Formula::read(&"(".repeat(100_000)).is_err());
        assert!(Formula::read(&format!("{}x", "x+".repeat(100_000))).is_err());
    }
}
