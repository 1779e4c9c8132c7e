//! PNG of drawings, which are plain areas and thin lines.
//!
//! Every row is written as its difference from the row above (filter "up"), which is zero but where
//! lines run. What is left to pack are runs: of zeros, and of a pixel that comes again and again. So
//! nothing is searched for, and a row like the one above costs one comparison. The files are about a
//! third larger than those of a general encoder, which takes many times as long.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use tiny_skia::Pixmap;

/// Symbols of literals, the end of the block, and lengths.
const SYMBOLS: usize = 286;
const END: usize = 256;
/// The longest run that one symbol stands for.
const LONGEST: usize = 258;
/// The longest code that a symbol may have, in bits.
const MOST_BITS: u8 = 15;
/// The filter "up".
const UP: u8 = 2;
/// The modulus of Adler-32.
const ADLER: u64 = 65_521;

/// A picture as a PNG of red, green and blue; `None` where something shines through.
pub(super) fn line_png(pixmap: &Pixmap) -> Option<Vec<u8>> {
    let mut packed = Packed::default();
    let row_bytes = 4 * pixmap.width() as usize;
    let nothing = vec![0; row_bytes];
    let mut above = &nothing[..];
    for row in pixmap.data().chunks_exact(row_bytes) {
        packed.literal(UP);
        packed.row(row, above)?;
        (packed.adler.0, packed.adler.1) = (packed.adler.0 % ADLER, packed.adler.1 % ADLER);
        above = row;
    }
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let [width, height] = [pixmap.width(), pixmap.height()].map(u32::to_be_bytes);
    // Eight bits each of red, green and blue; deflate, filters by row, no interlacing.
    chunk(&mut file, b"IHDR", &[&width[..], &height, &[8, 2, 0, 0, 0]].concat());
    chunk(&mut file, b"IDAT", &packed.into_zlib());
    chunk(&mut file, b"IEND", &[]);
    Some(file)
}

/// Rows as literals and runs.
#[derive(Default)]
struct Packed {
    /// Literals below 256; else a run: its length, from bit 9 on, and in bit 8 whether pixels or
    /// zeros are repeated.
    tokens: Vec<u32>,
    /// The two sums of Adler-32.
    adler: (u64, u64),
}

const PIXELS: u32 = 0x100;

impl Packed {
    fn literal(&mut self, byte: u8) {
        self.tokens.push(u32::from(byte));
        self.add(byte);
    }

    fn add(&mut self, byte: u8) {
        self.adler.0 += u64::from(byte);
        // The sum begins at one.
        self.adler.1 += self.adler.0 + 1;
    }

    /// A row after the row above it, in pixels of four bytes; `None` where one shines through.
    fn row(&mut self, row: &[u8], above: &[u8]) -> Option<()> {
        const STRIDE: usize = 64;
        let end = row.len();
        let mut at = 0;
        while at < end {
            let start = at;
            while at + STRIDE <= end && row[at..at + STRIDE] == above[at..at + STRIDE] {
                at += STRIDE;
            }
            while at < end && row[at..at + 4] == above[at..at + 4] {
                at += 4;
            }
            self.zeros((at - start) / 4 * 3);
            let (mut last, mut times) = (None, 0);
            while at < end && row[at..at + 4] != above[at..at + 4] {
                if row[at + 3] != u8::MAX {
                    return None;
                }
                let pixel = [0, 1, 2].map(|k| row[at + k].wrapping_sub(above[at + k]));
                if last == Some(pixel) {
                    times += 1;
                } else {
                    self.again(last, times);
                    pixel.into_iter().for_each(|byte| self.literal(byte));
                    (last, times) = (Some(pixel), 0);
                }
                at += 4;
            }
            self.again(last, times);
        }
        Some(())
    }

    /// So many zeros.
    fn zeros(&mut self, count: usize) {
        if count == 0 {
            return;
        }
        self.literal(0);
        let (mut left, sum) = (count - 1, self.adler.0 + 1);
        self.adler.1 += left as u64 * sum;
        while left > 2 {
            let run = left.min(LONGEST);
            self.tokens.push((run as u32) << 9);
            left -= run;
        }
        self.tokens.extend((0..left).map(|_| 0));
        // What counts below 256 is a literal, so runs are never shorter than three.
    }

    /// The last pixel so many times again.
    fn again(&mut self, pixel: Option<[u8; 3]>, times: usize) {
        let Some(pixel) = pixel else { return };
        (0..times).for_each(|_| pixel.into_iter().for_each(|byte| self.add(byte)));
        let mut left = 3 * times;
        while left > 0 {
            // A multiple of three, so that what is left is one, too.
            let run = left.min(LONGEST);
            self.tokens.push((run as u32) << 9 | PIXELS);
            left -= run;
        }
    }

    /// One block with a code of its own, between the header and the sum of zlib.
    fn into_zlib(self) -> Vec<u8> {
        let mut counts = [0; SYMBOLS];
        counts[END] = 1;
        for &token in &self.tokens {
            counts[symbol(token).0] += 1;
        }
        let lengths = code_lengths(counts);
        let codes = codes(&lengths);
        let mut bits = Bits { bytes: vec![0x78, 0x01], held: 0, count: 0 };
        // The last block, with its own codes: of all symbols, of three distances, and of 19 lengths
        // of codes, in an order of their own that begins with the three for repeating.
        bits.put(0b101, 3);
        bits.put(SYMBOLS as u64 - 257, 5);
        bits.put(3 - 1, 5);
        bits.put(19 - 4, 4);
        (0..19).for_each(|i| bits.put(if i < 3 { 0 } else { 4 }, 3));
        // Of the distances 1 and 3 each has a bit. A length as a code of four bits is itself, the
        // highest bit first.
        for &length in lengths.iter().chain(&[1, 0, 1]) {
            bits.put(u64::from(length.reverse_bits() >> 4), 4);
        }
        for &token in &self.tokens {
            let (symbol, extra, value) = symbol(token);
            bits.put(codes[symbol], lengths[symbol]);
            if symbol > END {
                bits.put(value, extra);
                bits.put(u64::from(token & PIXELS != 0), 1);
            }
        }
        bits.put(codes[END], lengths[END]);
        let mut bytes = bits.end();
        let sums = [self.adler.1, self.adler.0 + 1].map(|sum| (sum % ADLER) as u16);
        bytes.extend(sums.into_iter().flat_map(u16::to_be_bytes));
        bytes
    }
}

/// The symbol of a token, how many bits follow it, and these.
fn symbol(token: u32) -> (usize, u8, u64) {
    let length = (token >> 9) as usize;
    match length {
        0 => (token as usize, 0, 0),
        LONGEST => (SYMBOLS - 1, 0, 0),
        3..11 => (254 + length, 0, 0),
        _ => {
            // Four symbols to every doubling.
            let beyond = length - 3;
            let extra = beyond.ilog2() as usize - 2;
            let symbol = 261 + 4 * extra + (beyond >> extra & 3);
            (symbol, extra as u8, (beyond & ((1 << extra) - 1)) as u64)
        }
    }
}

/// How long the code of each symbol is, after Huffman; 0 for one that does not come. Where a code
/// would be too long, rare symbols are taken for less rare.
fn code_lengths(mut counts: [u64; SYMBOLS]) -> [u8; SYMBOLS] {
    loop {
        let mut heap: BinaryHeap<Reverse<(u64, usize)>> =
            (0..SYMBOLS).filter(|&i| counts[i] > 0).map(|i| Reverse((counts[i], i))).collect();
        let mut parents = vec![usize::MAX; SYMBOLS];
        while let (Some(Reverse((a, i))), Some(Reverse((b, j)))) = (heap.pop(), heap.pop()) {
            (parents[i], parents[j]) = (parents.len(), parents.len());
            heap.push(Reverse((a + b, parents.len())));
            parents.push(usize::MAX);
        }
        let depth = |mut i: usize| {
            let mut depth = 0_usize;
            while parents[i] != usize::MAX {
                (i, depth) = (parents[i], depth + 1);
            }
            depth
        };
        let depths: [usize; SYMBOLS] = std::array::from_fn(depth);
        if depths.iter().all(|&depth| depth <= usize::from(MOST_BITS)) {
            return depths.map(|depth| depth as u8);
        }
        counts = counts.map(|count| count.div_ceil(2));
    }
}

/// The codes that go with their lengths: shorter ones first, then in the order of the symbols; the
/// highest bit is written first, so they are turned around.
fn codes(lengths: &[u8; SYMBOLS]) -> [u64; SYMBOLS] {
    let mut codes = [0; SYMBOLS];
    let mut next = 0_u64;
    for bits in 1..=MOST_BITS {
        for (code, _) in codes.iter_mut().zip(lengths).filter(|(_, length)| **length == bits) {
            *code = next.reverse_bits() >> (64 - u32::from(bits));
            next += 1;
        }
        next <<= 1;
    }
    codes
}

/// Bits put together to bytes, the lowest first.
struct Bits {
    bytes: Vec<u8>,
    held: u64,
    count: u8,
}

impl Bits {
    /// Adds bits, at most 15.
    fn put(&mut self, value: u64, bits: u8) {
        self.held |= value << self.count;
        self.count += bits;
        if self.count >= 32 {
            self.bytes.extend_from_slice(&(self.held as u32).to_le_bytes());
            self.held >>= 32;
            self.count -= 32;
        }
    }

    fn end(mut self) -> Vec<u8> {
        let whole = usize::from(self.count.div_ceil(8));
        self.bytes.extend_from_slice(&self.held.to_le_bytes()[..whole]);
        self.bytes
    }
}

/// Adds a part of a PNG: its length, name and content with their checksum.
fn chunk(file: &mut Vec<u8>, name: &[u8; 4], content: &[u8]) {
    file.extend((content.len() as u32).to_be_bytes());
    file.extend(name);
    file.extend_from_slice(content);
    let summed = name.iter().chain(content);
    let sum =
        summed.fold(u32::MAX, |sum, &byte| CHECKSUMS[usize::from(sum as u8 ^ byte)] ^ (sum >> 8));
    file.extend((!sum).to_be_bytes());
}

/// CRC-32 of every byte.
const CHECKSUMS: [u32; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < 256 {
        let mut sum = byte as u32;
        let mut bit = 0;
        while bit < 8 {
            sum = if sum & 1 == 1 { 0xEDB8_8320 ^ (sum >> 1) } else { sum >> 1 };
            bit += 1;
        }
        table[byte] = sum;
        byte += 1;
    }
    table
};

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
        // Counts as skewed as those of Fibonacci give the longest codes.
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

    #[test]
    fn codes_that_would_be_too_long_are_shortened_and_stay_complete() {
        let mut counts = [0; SYMBOLS];
        let (mut a, mut b) = (1_u64, 1);
        for count in counts.iter_mut().take(40) {
            *count = a;
            (a, b) = (b, a + b);
        }
        let lengths = code_lengths(counts);
        assert!(lengths.iter().all(|&length| length <= MOST_BITS));
        let share: f64 =
            lengths.iter().filter(|&&l| l > 0).map(|&l| 0.5_f64.powi(i32::from(l))).sum();
        assert_eq!(share, 1.0);
    }
}
