//! Numbers as people read them in messages.

/// A number with four digits, without trailing zeros; very small and very large ones with an
/// exponent.
pub(crate) fn short(x: f64) -> String {
    let size = x.abs();
    if x == 0.0 {
        "0".into()
    } else if !(1e-4..1e9).contains(&size) {
        format!("{x:.2e}")
    } else {
        // Whole digits are never rounded away; behind the point four digits in all are left.
        let decimals = (3 - size.log10().floor() as i32).clamp(0, 7) as usize;
        let text = format!("{x:.decimals$}");
        if text.contains('.') {
            text.trim_end_matches('0').trim_end_matches('.').to_owned()
        } else {
            text
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_but_keep_their_size() {
        for (x, text) in [
            (0.0, "0"),
            (2.0, "2"),
            (261.8034, "261.8"),
            (0.012345, "0.01235"),
            (1e-13, "1.00e-13"),
            (123_456.7, "123457"),
            (-0.5, "-0.5"),
            (3.2e12, "3.20e12"),
            (0.99996, "1"),
            (100.0, "100"),
        ] {
            assert_eq!(short(x), text);
        }
    }
}
