//! Pictures as a PDF holds them: rows of red, green and blue, taken from a PNG file.
//!
//! Reads what our own pictures are: eight bits a channel, three or four channels, rows one after
//! the other (PNG specification, third edition: 5.3 chunks, 9.2 filters).

use miniz_oxide::inflate::decompress_to_vec_zlib_with_limit;

/// A picture, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Raster {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Red, green and blue of every pixel.
    pub(super) rgb: Vec<u8>,
}

/// No picture of ours has more pixels along a side.
const LARGEST: usize = 1 << 15;

impl Raster {
    /// Reads a PNG file; what is not opaque lies on white. `None` for what is no PNG file of the
    /// kind described above.
    pub(super) fn of_png(png: &[u8]) -> Option<Self> {
        let mut rest = png.strip_prefix(b"\x89PNG\r\n\x1a\n")?;
        let (mut head, mut packed) = (None, Vec::new());
        while let [a, b, c, d, kind @ ..] = rest {
            let length = u32::from_be_bytes([*a, *b, *c, *d]) as usize;
            let (kind, data) = (kind.get(..4)?, kind.get(4..4 + length)?);
            match kind {
                b"IHDR" => head = Some(data),
                b"IDAT" => packed.extend_from_slice(data),
                _ => {}
            }
            rest = rest.get(length + 12..)?;
        }
        let [w0, w1, w2, w3, h0, h1, h2, h3, 8, colour, 0, 0, 0] = *head? else { return None };
        let channels = match colour {
            2 => 3,
            6 => 4,
            _ => return None,
        };
        let [width, height] =
            [[w0, w1, w2, w3], [h0, h1, h2, h3]].map(|b| u32::from_be_bytes(b) as usize);
        if width == 0 || height == 0 || width > LARGEST || height > LARGEST {
            return None;
        }
        let stride = width * channels;
        let mut bytes = decompress_to_vec_zlib_with_limit(&packed, (stride + 1) * height).ok()?;
        if bytes.len() != (stride + 1) * height {
            return None;
        }
        let mut rgb = Vec::with_capacity(width * height * 3);
        let mut above = vec![0; stride];
        for row in bytes.chunks_exact_mut(stride + 1) {
            let (filter, row) = row.split_first_mut()?;
            unfilter(*filter, row, &above, channels)?;
            row.chunks_exact(channels).for_each(|pixel| rgb.extend(on_white(pixel)));
            above.copy_from_slice(row);
        }
        Some(Self { width, height, rgb })
    }
}

/// Turns differences to the pixels on the left and above back into values.
fn unfilter(filter: u8, row: &mut [u8], above: &[u8], channels: usize) -> Option<()> {
    for i in 0..row.len() {
        let left = if i < channels { 0 } else { row[i - channels] };
        let up = above[i];
        let corner = if i < channels { 0 } else { above[i - channels] };
        let guess = match filter {
            0 => 0,
            1 => left,
            2 => up,
            3 => left.midpoint(up),
            4 => nearest(left, up, corner),
            _ => return None,
        };
        row[i] = row[i].wrapping_add(guess);
    }
    Some(())
}

/// The neighbour that is nearest to left + up − corner (Paeth).
fn nearest(left: u8, up: u8, corner: u8) -> u8 {
    let [a, b, c] = [left, up, corner].map(i16::from);
    let [to_left, to_up, to_corner] = [a, b, c].map(|x| (a + b - c - x).abs());
    if to_left <= to_up && to_left <= to_corner {
        left
    } else if to_up <= to_corner {
        up
    } else {
        corner
    }
}

fn on_white(pixel: &[u8]) -> [u8; 3] {
    let alpha = u16::from(pixel.get(3).copied().unwrap_or(255));
    [0, 1, 2].map(|i| ((u16::from(pixel[i]) * alpha + 255 * (255 - alpha) + 127) / 255) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_are_read_as_their_own_library_reads_them() {
        let mut pixmap = tiny_skia::Pixmap::new(37, 23).expect("a size");
        for (i, pixel) in pixmap.pixels_mut().iter_mut().enumerate() {
            let at = |k: usize| ((i * k * k) % 251) as u8;
            *pixel = tiny_skia::ColorU8::from_rgba(
                at(3),
                at(7),
                at(1),
                if i % 5 == 0 { 0 } else { 255 },
            )
            .premultiply();
        }
        let png = pixmap.encode_png().expect("a file");
        let raster = Raster::of_png(&png).expect("a picture");
        assert_eq!((raster.width, raster.height), (37, 23));
        for (pixel, rgb) in pixmap.pixels().iter().zip(raster.rgb.chunks(3)) {
            let on_white = |c: u8| c + (255 - pixel.alpha());
            assert_eq!(rgb, [pixel.red(), pixel.green(), pixel.blue()].map(on_white));
        }
        for end in [0, 7, 20, 33, 60, png.len() - 13] {
            assert_eq!(Raster::of_png(&png[..end]), None, "cut off at {end}");
        }
    }

    #[test]
    fn every_filter_is_undone() {
        // Three pixels of three channels below a row of values.
        let above = [10, 20, 30, 40, 50, 60, 70, 80, 90];
        let want = [1_u8, 200, 3, 44, 55, 6, 77, 8, 99];
        for filter in 0..=4 {
            let mut row = want;
            for i in (0..9).rev() {
                let (left, corner) = if i < 3 { (0, 0) } else { (want[i - 3], above[i - 3]) };
                let guess = match filter {
                    0 => 0,
                    1 => left,
                    2 => above[i],
                    3 => ((u16::from(left) + u16::from(above[i])) / 2) as u8,
                    _ => nearest(left, above[i], corner),
                };
                row[i] = want[i].wrapping_sub(guess);
            }
            unfilter(filter, &mut row, &above, 3).expect("a known filter");
            assert_eq!(row, want);
        }
        assert_eq!(unfilter(5, &mut [0], &[0], 1), None);
    }
}
