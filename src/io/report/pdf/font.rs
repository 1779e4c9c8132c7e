//! The two fonts of the report, which go into the file as far as they are used: DejaVu Sans
//! Condensed and its bold, with the letters of Latin, Greek and Cyrillic.
//!
//! Widths and glyphs are read off the fonts. Letters are set one after the other; the languages
//! that the fonts know need no more.

use std::sync::LazyLock;

use krilla::text::{GlyphId, KrillaGlyph};
use skrifa::charmap::Charmap;
use skrifa::instance::{LocationRef, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::{FontRef, MetadataProvider as _};

/// One of the two fonts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Font {
    Regular,
    Bold,
}

/// A font file as it is asked for glyphs.
struct Face {
    letters: Charmap<'static>,
    widths: GlyphMetrics<'static>,
    units: f32,
}

static FACES: LazyLock<[Face; 2]> = LazyLock::new(|| Font::ALL.map(Face::of));

impl Face {
    fn of(font: Font) -> Self {
        let file = FontRef::new(font.file()).expect("the font of the house is a font");
        let units = file.metrics(Size::unscaled(), LocationRef::default()).units_per_em;
        Self {
            letters: file.charmap(),
            widths: file.glyph_metrics(Size::unscaled(), LocationRef::default()),
            units: f32::from(units),
        }
    }

    /// The number of a letter's glyph; 0, which is an empty box, where there is none.
    fn glyph(&self, letter: char) -> skrifa::GlyphId {
        self.letters.map(letter).unwrap_or_default()
    }

    /// How wide a letter is, as a part of the size.
    fn advance(&self, letter: char) -> f32 {
        self.widths.advance_width(self.glyph(letter)).unwrap_or_default() / self.units
    }
}

impl Font {
    pub(super) const ALL: [Self; 2] = [Self::Regular, Self::Bold];

    /// The bytes of its file.
    pub(super) const fn file(self) -> &'static [u8] {
        match self {
            Self::Regular => include_bytes!("../../../../assets/fonts/DejaVuSansCondensed.ttf"),
            Self::Bold => include_bytes!("../../../../assets/fonts/DejaVuSansCondensed-Bold.ttf"),
        }
    }

    fn face(self) -> &'static Face {
        &FACES[self as usize]
    }

    /// Whether it has a glyph for a letter.
    pub(super) fn has(self, letter: char) -> bool {
        self.face().letters.map(letter).is_some()
    }

    /// The glyphs of a text, one for each letter.
    pub(super) fn glyphs(self, text: &str) -> Vec<KrillaGlyph> {
        let face = self.face();
        let glyph = |(at, letter): (usize, char)| {
            let (number, range) = (face.glyph(letter), at..at + letter.len_utf8());
            let number = GlyphId::new(number.to_u32());
            KrillaGlyph::new(number, face.advance(letter), 0.0, 0.0, 0.0, range, None)
        };
        text.char_indices().map(glyph).collect()
    }

    /// How wide a text is at a size.
    pub(super) fn width(self, text: &str, size: f64) -> f64 {
        text.chars().map(|letter| self.advance(letter, size)).sum()
    }

    fn advance(self, letter: char, size: f64) -> f64 {
        f64::from(self.face().advance(letter)) * size
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
            for letter in piece.chars() {
                let wide = self.advance(letter, size);
                if used > 0.0 && letter != ' ' && used + wide > room {
                    lines.push(String::new());
                    used = 0.0;
                }
                used += wide;
                if let Some(line) = lines.last_mut() {
                    line.push(letter);
                }
            }
        }
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_fonts_have_the_letters_of_europe_and_the_signs_of_reports() {
        let text = "Zażółć gęślą jaźń, Κουτί από ξύλο, Коробка из фанеры, Größe, ‰ % ° − – … “x” ²";
        for font in Font::ALL {
            assert!(text.chars().all(|letter| font.has(letter)), "{font:?}");
            assert!(text.chars().all(|letter| font.advance(letter, 1.0) > 0.0), "{font:?}");
            assert!(!font.has('箱'));
            let glyphs = font.glyphs("aé箱");
            let ranges: Vec<_> = glyphs.iter().map(|glyph| glyph.text_range.clone()).collect();
            assert_eq!(ranges, [0..1, 1..3, 3..6]);
            assert_eq!(glyphs[2].glyph_id, GlyphId::new(0));
            assert!(glyphs[2].x_advance > 0.0, "what is missing is seen");
        }
        assert!(Font::Bold.width("W", 10.0) > Font::Regular.width("W", 10.0));
        assert_eq!(Font::Regular.width("0000", 10.0), 4.0 * Font::Regular.width("7", 10.0));
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
