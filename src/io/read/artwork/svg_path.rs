//! The little languages inside SVG attributes: path data, transforms, lengths, colours.

use glam::{DAffine2, DMat2, DVec2};

use super::curve::Flattener;

/// Subpaths with whether each is closed.
pub(super) type Subpaths = Vec<(Vec<DVec2>, bool)>;

/// Reads path data up to its first mistake, as browsers do.
pub(super) fn subpaths(data: &str, flattener: &Flattener) -> Subpaths {
    let mut reader = PathReader {
        numbers: Numbers { text: data.as_bytes(), at: 0 },
        done: Vec::new(),
        flattener,
    };
    reader.read();
    reader.done
}

struct PathReader<'a> {
    numbers: Numbers<'a>,
    done: Subpaths,
    flattener: &'a Flattener,
}

impl PathReader<'_> {
    fn read(&mut self) {
        let mut command = 0_u8;
        let mut points: Vec<DVec2> = Vec::new();
        // The last control point, for the smooth commands, with the letter it came from.
        let mut control = (DVec2::ZERO, 0_u8);
        let mut current = DVec2::ZERO;
        loop {
            match self.numbers.letter() {
                Some(letter) => command = letter,
                None if self.numbers.is_at_end()
                    || command == 0
                    || command.eq_ignore_ascii_case(&b'z') =>
                {
                    break;
                }
                // Further numbers after a move are lines.
                None if command == b'M' => command = b'L',
                None if command == b'm' => command = b'l',
                None => {}
            }
            let base = if command.is_ascii_lowercase() { current } else { DVec2::ZERO };
            let letter = command.to_ascii_uppercase();
            if letter == b'Z' {
                if let Some(&first) = points.first() {
                    current = first;
                    self.done.push((std::mem::take(&mut points), true));
                }
                continue;
            }
            if letter == b'M' {
                let Some(to) = self.numbers.point() else { break };
                self.flush(&mut points);
                current = base + to;
                points.push(current);
                control.1 = 0;
                continue;
            }
            if points.is_empty() {
                points.push(current);
            }
            let Some(next) = self.draw(letter, base, current, &mut control, &mut points) else {
                break;
            };
            current = next;
        }
        self.flush(&mut points);
    }

    fn flush(&mut self, points: &mut Vec<DVec2>) {
        if !points.is_empty() {
            self.done.push((std::mem::take(points), false));
        }
    }

    /// One command with its numbers; where it ends.
    fn draw(
        &mut self,
        letter: u8,
        base: DVec2,
        current: DVec2,
        control: &mut (DVec2, u8),
        points: &mut Vec<DVec2>,
    ) -> Option<DVec2> {
        let n = &mut self.numbers;
        let mirrored =
            |kind: u8, of: &(DVec2, u8)| if of.1 == kind { 2.0 * current - of.0 } else { current };
        let (end, last) = match letter {
            b'L' => (base + n.point()?, (current, 0)),
            b'H' => (DVec2::new(base.x + n.number()?, current.y), (current, 0)),
            b'V' => (DVec2::new(current.x, base.y + n.number()?), (current, 0)),
            b'C' | b'S' => {
                let first =
                    if letter == b'C' { base + n.point()? } else { mirrored(b'C', control) };
                let (second, end) = (base + n.point()?, base + n.point()?);
                self.flattener.cubic([current, first, second, end], points);
                (end, (second, b'C'))
            }
            b'Q' | b'T' => {
                let middle =
                    if letter == b'Q' { base + n.point()? } else { mirrored(b'Q', control) };
                let end = base + n.point()?;
                self.flattener.quadratic([current, middle, end], points);
                (end, (middle, b'Q'))
            }
            b'A' => {
                let (radii, turn) = (n.point()?, n.number()?);
                let flags = [n.flag()?, n.flag()?];
                let end = base + n.point()?;
                self.flattener.svg_arc([current, end], radii, turn, flags, points);
                (end, (current, 0))
            }
            _ => return None,
        };
        *control = last;
        if matches!(letter, b'L' | b'H' | b'V') {
            points.push(end);
        }
        Some(end)
    }
}

/// Numbers separated by spaces, commas or nothing at all.
pub(super) struct Numbers<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Numbers<'a> {
    pub fn of(text: &'a str) -> Self {
        Self { text: text.as_bytes(), at: 0 }
    }

    fn skip(&mut self) {
        while self.text.get(self.at).is_some_and(|b| b.is_ascii_whitespace() || *b == b',') {
            self.at += 1;
        }
    }

    fn is_at_end(&mut self) -> bool {
        self.skip();
        self.at >= self.text.len()
    }

    fn letter(&mut self) -> Option<u8> {
        self.skip();
        let letter = *self.text.get(self.at).filter(|b| b.is_ascii_alphabetic())?;
        self.at += 1;
        Some(letter)
    }

    fn flag(&mut self) -> Option<bool> {
        self.skip();
        let flag = *self.text.get(self.at).filter(|b| matches!(b, b'0' | b'1'))?;
        self.at += 1;
        Some(flag == b'1')
    }

    pub fn number(&mut self) -> Option<f64> {
        self.skip();
        let start = self.at;
        let rest = &self.text[start..];
        let mut end = usize::from(matches!(rest.first(), Some(b'+' | b'-')));
        let digits = |from: usize| rest[from..].iter().take_while(|b| b.is_ascii_digit()).count();
        end += digits(end);
        if rest.get(end) == Some(&b'.') {
            end += 1 + digits(end + 1);
        }
        if matches!(rest.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(rest.get(end + 1), Some(b'+' | b'-')));
            let power = digits((end + 1 + sign).min(rest.len()));
            // `em` and `ex` are units, not powers.
            end += if power > 0 { 1 + sign + power } else { 0 };
        }
        let number = std::str::from_utf8(&rest[..end]).ok()?.parse().ok()?;
        self.at = start + end;
        Some(number)
    }

    pub fn point(&mut self) -> Option<DVec2> {
        Some(DVec2::new(self.number()?, self.number()?))
    }

    fn rest(&self) -> &str {
        std::str::from_utf8(&self.text[self.at..]).unwrap_or_default().trim()
    }
}

/// All points of `points="..."`.
pub(super) fn point_list(text: &str) -> Vec<DVec2> {
    let mut numbers = Numbers::of(text);
    std::iter::from_fn(|| numbers.point()).collect()
}

/// A length with its unit in user units of 1/96 in, or in percent of `whole`. The unit is returned,
/// too.
pub(super) fn length(text: &str, whole: f64) -> Option<(f64, String)> {
    let mut numbers = Numbers::of(text);
    let value = numbers.number()?;
    let unit = numbers.rest().to_ascii_lowercase();
    let factor = match unit.as_str() {
        "" | "px" => 1.0,
        "mm" => 96.0 / 25.4,
        "cm" => 960.0 / 25.4,
        "q" => 24.0 / 25.4,
        "in" => 96.0,
        "pt" => 96.0 / 72.0,
        "pc" => 16.0,
        "%" => whole / 100.0,
        "em" => 16.0,
        "ex" => 8.0,
        _ => return None,
    };
    Some((value * factor, unit))
}

/// A list of transforms, the first outermost.
pub(super) fn transform(text: &str) -> DAffine2 {
    let mut all = DAffine2::IDENTITY;
    for part in text.split(')') {
        let Some((name, arguments)) = part.split_once('(') else { continue };
        let mut numbers = Numbers::of(arguments);
        let n: Vec<f64> = std::iter::from_fn(|| numbers.number()).collect();
        let shear = |x: f64, y: f64| {
            DAffine2::from_mat2(DMat2::from_cols(DVec2::new(1.0, y), DVec2::new(x, 1.0)))
        };
        all *= match (name.trim_matches(|c: char| c.is_whitespace() || c == ','), n.as_slice()) {
            ("matrix", &[a, b, c, d, e, f]) => DAffine2::from_cols_array(&[a, b, c, d, e, f]),
            ("translate", &[x]) => DAffine2::from_translation(DVec2::new(x, 0.0)),
            ("translate", &[x, y]) => DAffine2::from_translation(DVec2::new(x, y)),
            ("scale", &[s]) => DAffine2::from_scale(DVec2::splat(s)),
            ("scale", &[x, y]) => DAffine2::from_scale(DVec2::new(x, y)),
            ("rotate", &[angle]) => DAffine2::from_angle(angle.to_radians()),
            ("rotate", &[angle, x, y]) => {
                let centre = DVec2::new(x, y);
                DAffine2::from_translation(centre)
                    * DAffine2::from_angle(angle.to_radians())
                    * DAffine2::from_translation(-centre)
            }
            ("skewX", &[angle]) => shear(angle.to_radians().tan(), 0.0),
            ("skewY", &[angle]) => shear(0.0, angle.to_radians().tan()),
            _ => DAffine2::IDENTITY,
        };
    }
    all
}

/// A colour; `None` for `none` and what paints nothing.
pub(super) fn colour(text: &str) -> Option<[u8; 3]> {
    let text = text.trim();
    if let Some(hex) = text.strip_prefix('#').filter(|h| h.is_ascii()) {
        let pair = |i: usize| u8::from_str_radix(&hex[2 * i..2 * i + 2], 16).ok();
        let single = |i: usize| u8::from_str_radix(&hex[i..=i], 16).ok().map(|v| v * 17);
        return match hex.len() {
            3 | 4 => Some([single(0)?, single(1)?, single(2)?]),
            6 | 8 => Some([pair(0)?, pair(1)?, pair(2)?]),
            _ => Some([0; 3]),
        };
    }
    if let Some(inside) = text.strip_prefix("rgb").and_then(|t| t.split_once('(')) {
        let mut parts = inside.1.split([',', ' ', ')']).filter(|t| !t.is_empty());
        let mut channel = || {
            let part = parts.next()?;
            let value = match part.strip_suffix('%') {
                Some(percent) => percent.parse::<f64>().ok()? * 2.55,
                None => part.parse().ok()?,
            };
            Some(value.round().clamp(0.0, 255.0) as u8)
        };
        return Some([channel()?, channel()?, channel()?]);
    }
    match text.to_ascii_lowercase().as_str() {
        "none" | "transparent" | "" => None,
        "red" => Some([255, 0, 0]),
        "blue" => Some([0, 0, 255]),
        "lime" => Some([0, 255, 0]),
        "green" => Some([0, 128, 0]),
        "white" => Some([255; 3]),
        "magenta" | "fuchsia" => Some([255, 0, 255]),
        "cyan" | "aqua" => Some([0, 255, 255]),
        "yellow" => Some([255, 255, 0]),
        "orange" => Some([255, 165, 0]),
        "grey" | "gray" => Some([128; 3]),
        // Other names are some colour, and none of those that mean something.
        "black" | "currentcolor" => Some([0; 3]),
        _ => Some([128, 64, 64]),
    }
}
