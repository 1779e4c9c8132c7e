//! PNG of drawings, which are plain areas and thin lines, for jobs that have a thousand of them.
//!
//! Every row is written as its difference from the row above (filter "up"), which is zero but where
//! lines run: no filter is tried, and what is left packs fast and small. The fastest packing of the
//! crate would make files three times as large.

use png::{BitDepth, ColorType, Compression, Encoder, Filter};
use tiny_skia::Pixmap;

/// A picture as a PNG of red, green and blue; `None` where something shines through.
pub(super) fn line_png(pixmap: &Pixmap) -> Option<Vec<u8>> {
    let pixels = || pixmap.data().chunks_exact(4);
    if pixels().any(|pixel| pixel[3] != u8::MAX) {
        return None;
    }
    let colours: Vec<u8> = pixels().flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, pixmap.width(), pixmap.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_filter(Filter::Up);
    let written = encoder.write_header().and_then(|mut rows| {
        rows.write_image_data(&colours)?;
        rows.finish()
    });
    written.ok().map(|()| file)
}

#[cfg(test)]
mod tests {
    use tiny_skia::{Color, PremultipliedColorU8};

    use super::*;

    fn picture(width: u32, height: u32, colour: impl Fn(u32, u32) -> [u8; 3]) -> Pixmap {
        let mut pixmap = Pixmap::new(width, height).expect("a size");
        for (i, pixel) in pixmap.pixels_mut().iter_mut().enumerate() {
            let [r, g, b] = colour(i as u32 % width, i as u32 / width);
            *pixel = PremultipliedColorU8::from_rgba(r, g, b, 255).expect("opaque");
        }
        pixmap
    }

    #[test]
    fn another_reader_sees_the_same_pixels() {
        let noise = |x: u32, y: u32| {
            let mixed =
                (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(40_503)).wrapping_mul(69_069);
            [mixed as u8, (mixed >> 11) as u8, (mixed >> 23) as u8]
        };
        let ring = |x: u32, y: u32| {
            let off = (x as i32 - 150).pow(2) + (y as i32 - 100).pow(2) - 6400;
            if off.abs() < 400 { [255, (off.abs() / 2) as u8, 7] } else { [240; 3] }
        };
        let steps = |x: u32, y: u32| [(y.leading_zeros() + x.trailing_zeros()) as u8, 0, 0];
        for pixmap in [
            picture(300, 200, |_, _| [1, 2, 3]),
            picture(300, 200, |_, _| [0; 3]),
            picture(1, 1, |_, _| [9, 8, 7]),
            picture(17, 300, |x, y| [x as u8, y as u8, 0]),
            picture(2048, 1024, steps),
            picture(300, 200, ring),
            picture(333, 111, noise),
        ] {
            let png = line_png(&pixmap).expect("nothing shines through");
            let read = Pixmap::decode_png(&png).expect("a PNG");
            assert_eq!((read.width(), read.height()), (pixmap.width(), pixmap.height()));
            assert!(read.data() == pixmap.data(), "{} × {}", read.width(), read.height());
        }
    }

    #[test]
    fn lines_on_plain_ground_make_small_files_and_what_shines_through_none() {
        let grid =
            picture(1200, 900, |x, y| if x % 100 == 0 || y == x { [0; 3] } else { [250; 3] });
        // Of three bytes a pixel, less than a two-hundredth.
        assert!(line_png(&grid).is_some_and(|png| png.len() < 3 * 1200 * 900 / 200));
        let mut glass = Pixmap::new(4, 4).expect("a size");
        glass.fill(Color::from_rgba8(10, 20, 30, 128));
        assert_eq!(line_png(&glass), None);
    }
}
