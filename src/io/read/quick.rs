//! The plainest lines of text files, which are nearly all of them, read in one pass over their bytes.
//! What is not as plain as that is left to the reader of the format, which knows the rest and names
//! faults.

use glam::DVec3;

/// Three numbers with a point, with white space between and around them, and nothing else.
pub(super) fn point(mut rest: &[u8]) -> Option<DVec3> {
    let mut point = [0.0; 3];
    for coordinate in &mut point {
        let start = rest.trim_ascii_start();
        let (value, length) = fast_float2::parse_partial(start).ok()?;
        *coordinate = value;
        rest = &start[length..];
        if rest.first().is_some_and(|b| !b.is_ascii_whitespace()) {
            return None;
        }
    }
    rest.trim_ascii_start().is_empty().then_some(DVec3::from_array(point))
}

/// Appends the corners of a face, `1 2 3` or `1/1 2/2 3/3`, counted from 1, and nothing else. Returns
/// whether it was that plain; if not, nothing is appended.
pub(super) fn corners(rest: &[u8], corners: &mut Vec<u32>) -> bool {
    let before = corners.len();
    let is_plain = push_corners(rest, corners).is_some();
    if !is_plain {
        corners.truncate(before);
    }
    is_plain
}

fn push_corners(mut rest: &[u8], corners: &mut Vec<u32>) -> Option<()> {
    loop {
        rest = rest.trim_ascii_start();
        if rest.is_empty() {
            return Some(());
        }
        let mut number = digits(&mut rest)?;
        corners.push(number.checked_sub(1)?);
        // A texture and a normal may follow, which have to be numbers and are not needed.
        for _ in 0..2 {
            if rest.first() == Some(&b'/') {
                rest = &rest[1..];
                number = if rest.first() == Some(&b'/') { 1 } else { digits(&mut rest)? };
                number.checked_sub(1)?;
            }
        }
        if rest.first().is_some_and(|b| !b.is_ascii_whitespace()) {
            return None;
        }
    }
}

/// Takes a whole number of at most nine digits from the beginning.
fn digits(rest: &mut &[u8]) -> Option<u32> {
    let count = rest.iter().take_while(|b| b.is_ascii_digit()).count();
    let (number, after) = rest.split_at(count);
    *rest = after;
    let value = || number.iter().fold(0, |value, b| 10 * value + u32::from(b - b'0'));
    (1..=9).contains(&count).then(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plain_points_are_those_that_the_long_way_reads() {
        for (text, x) in [("1 2 3", 1.0), ("\t-0.1e-3  2 3 ", -0.1e-3), (".5 2 3\r", 0.5)] {
            assert_eq!(point(text.as_bytes()), Some(DVec3::new(x, 2.0, 3.0)), "{text}");
            let long = text.split_whitespace().next().and_then(|word| word.parse().ok());
            assert_eq!(long, Some(x), "{text}");
        }
        for text in ["", "1 2", "1 2 3 4", "1,5 2 3", "1 2 3#", "1 2 3 # c", "1 2 \\", "a 2 3"] {
            assert_eq!(point(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn plain_faces_are_numbers_with_at_most_two_others() {
        for text in ["1 2 3", " 1/4 2/5 3/6 ", "1//4 2//5 3//6", "1/4/7\t2/5/8 3/6/9"] {
            let mut found = vec![9];
            assert!(corners(text.as_bytes(), &mut found), "{text}");
            assert_eq!(found, [9, 0, 1, 2], "{text}");
        }
        for text in
            ["0 1 2", "-1 2 3", "1 2 3 # c", "1 2 x", "1/2/3/4 2 3", "1234567890 1 2", "1 2 \\"]
        {
            let mut found = vec![9];
            assert!(!corners(text.as_bytes(), &mut found), "{text}");
            assert_eq!(found, [9], "{text}");
        }
    }
}
