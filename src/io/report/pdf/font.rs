//! Text in the two fonts that every PDF reader has, Helvetica and its bold, so that none is
//! embedded.
//!
//! Widths are those of Adobe's metrics for its core fonts, in thousandths of the size, by code of
//! the encoding (WinAnsi, which is code page 1252).

use std::fmt::Write as _;

/// One of the two fonts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Font {
    Regular,
    Bold,
}

impl Font {
    pub(super) const ALL: [Self; 2] = [Self::Regular, Self::Bold];

    /// Its name in the PDF standard.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Regular => "Helvetica",
            Self::Bold => "Helvetica-Bold",
        }
    }

    /// Its name on our pages.
    pub(super) const fn short(self) -> &'static str {
        match self {
            Self::Regular => "F1",
            Self::Bold => "F2",
        }
    }

    /// How wide a text is at a size.
    pub(super) fn width(self, text: &str, size: f64) -> f64 {
        text.chars().map(|c| self.advance(code(c))).sum::<f64>() * size / 1000.0
    }

    fn advance(self, code: u8) -> f64 {
        let widths = match self {
            Self::Regular => &REGULAR,
            Self::Bold => &BOLD,
        };
        f64::from(widths[usize::from(code) - FIRST])
    }

    /// A text in lines no longer than the room, divided between words; a word that is longer is
    /// divided anywhere.
    pub(super) fn wrap(self, text: &str, size: f64, room: f64) -> Vec<String> {
        let mut lines = vec![String::new()];
        let mut used = 0.0;
        for piece in text.split_inclusive(' ') {
            let bare = self.width(piece.trim_end(), size);
            if used > 0.0 && used + bare > room {
                lines.push(String::new());
                used = 0.0;
            }
            for c in piece.chars() {
                let wide = self.advance(code(c)) * size / 1000.0;
                if used > 0.0 && c != ' ' && used + wide > room {
                    lines.push(String::new());
                    used = 0.0;
                }
                used += wide;
                if let Some(line) = lines.last_mut() {
                    line.push(c);
                }
            }
        }
        lines
    }
}

/// The text as a string object, ASCII only.
pub(super) fn string(text: &str) -> String {
    let mut out = "(".to_owned();
    for code in text.trim_end().chars().map(code) {
        match code {
            b'(' | b')' | b'\\' => {
                out.push('\\');
                out.push(char::from(code));
            }
            b' '..=b'~' => out.push(char::from(code)),
            _ => {
                let _ = write!(out, "\\{code:03o}");
            }
        }
    }
    out + ")"
}

/// The code of a character; signs that the encoding lacks become their nearest kin, letters that it
/// lacks a question mark.
fn code(c: char) -> u8 {
    match c {
        ' '..='~' => c as u8,
        '\u{2212}' => 0x96,
        '\u{a0}'..='\u{ff}' if c != '\u{ad}' => c as u8,
        _ => HIGH.chars().position(|high| high == c && c != ' ').map_or(b'?', |i| 0x80 + i as u8),
    }
}

/// The characters from 0x80 to 0x9f; a space where there is none.
const HIGH: &str = "€ ‚ƒ„…†‡ˆ‰Š‹Œ Ž  ‘’“”•–—˜™š›œ žŸ";

/// The first code with a width.
const FIRST: usize = 32;

#[rustfmt::skip]
const REGULAR: [u16; 224] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556,
    833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500,
    556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500,
    334, 260, 334, 584, 0, 556, 0, 222, 556, 333, 1000, 556, 556, 333, 1000, 667, 333, 1000, 0, 611, 0, 0, 222, 222,
    333, 333, 350, 556, 1000, 333, 1000, 500, 333, 944, 0, 500, 667, 278, 333, 556, 556, 556, 556, 260, 556, 333, 737,
    370, 556, 584, 333, 737, 333, 400, 584, 333, 333, 333, 556, 537, 278, 333, 333, 365, 556, 834, 834, 834, 611, 667,
    667, 667, 667, 667, 667, 1000, 722, 667, 667, 667, 667, 278, 278, 278, 278, 722, 722, 778, 778, 778, 778, 778,
    584, 778, 722, 722, 722, 722, 667, 667, 611, 556, 556, 556, 556, 556, 556, 889, 500, 556, 556, 556, 556, 278, 278,
    278, 278, 556, 556, 556, 556, 556, 556, 556, 584, 611, 556, 556, 556, 556, 500, 556, 500,
];

#[rustfmt::skip]
const BOLD: [u16; 224] = [
    278, 333, 474, 556, 556, 889, 722, 238, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556, 556, 556, 556,
    556, 556, 556, 333, 333, 584, 584, 584, 611, 975, 722, 722, 722, 722, 667, 611, 778, 722, 278, 556, 722, 611, 833,
    722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 333, 278, 333, 584, 556, 333, 556, 611, 556, 611,
    556, 333, 611, 611, 278, 278, 556, 278, 889, 611, 611, 611, 611, 389, 556, 333, 611, 556, 778, 556, 556, 500, 389,
    280, 389, 584, 0, 556, 0, 278, 556, 500, 1000, 556, 556, 333, 1000, 667, 333, 1000, 0, 611, 0, 0, 278, 278, 500,
    500, 350, 556, 1000, 333, 1000, 556, 333, 944, 0, 500, 667, 278, 333, 556, 556, 556, 556, 280, 556, 333, 737, 370,
    556, 584, 333, 737, 333, 400, 584, 333, 333, 333, 611, 556, 278, 333, 333, 365, 556, 834, 834, 834, 611, 722, 722,
    722, 722, 722, 722, 1000, 722, 667, 667, 667, 667, 278, 278, 278, 278, 722, 722, 778, 778, 778, 778, 778, 584,
    778, 722, 722, 722, 722, 667, 667, 611, 556, 556, 556, 556, 556, 556, 889, 556, 556, 556, 556, 556, 278, 278, 278,
    278, 611, 611, 611, 611, 611, 611, 611, 584, 611, 611, 611, 611, 611, 556, 611, 556,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_of_reports_have_codes_and_widths() {
        assert_eq!(
            string("a (b) 5 ‰ \u{2212}3° “x” 日"),
            r"(a \(b\) 5 \211 \2263\260 \223x\224 ?)"
        );
        assert!((Font::Regular.width("0000", 10.0) - 22.24).abs() < 1e-9);
        assert!((Font::Bold.width("W", 1000.0) - 944.0).abs() < 1e-9);
        for font in Font::ALL {
            let codes = (' '..='~').chain('\u{a0}'..='\u{ff}').chain(HIGH.chars()).map(code);
            assert!(codes.clone().all(|code| font.advance(code) > 0.0));
            assert_eq!(
                codes.filter(|&code| code == b'?').count(),
                2,
                "the question mark and the soft hyphen"
            );
        }
    }

    #[test]
    fn lines_are_no_longer_than_their_room_and_lose_nothing() {
        let text = "Short words, and one that is longthananylinecouldeverbe in this room.";
        for room in [30.0, 60.0, 200.0, 1000.0] {
            let lines = Font::Regular.wrap(text, 10.0, room);
            assert_eq!(lines.concat(), text);
            assert!(
                lines.iter().all(|line| Font::Regular.width(line.trim_end(), 10.0) <= room),
                "{lines:?}"
            );
        }
        assert_eq!(Font::Regular.wrap(text, 10.0, 1000.0).len(), 1);
    }
}
