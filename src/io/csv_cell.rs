//! One field of a CSV file: in quotes where it needs them (RFC 4180), and never a formula.

/// A field as it is written. What a spreadsheet would run as a formula (a text that begins with `=`,
/// `+`, `-`, `@`, a tab or a line break, as the name of a group may) gets an apostrophe before it;
/// numbers, and several of them, stay as they are.
pub(super) fn cell(field: &str) -> String {
    let begins = field.starts_with(['=', '+', '-', '@', '\t', '\r', '\n']);
    let is_number = |word: &str| word.parse::<f64>().is_ok();
    let are_numbers = || field.split([' ', ';']).filter(|word| !word.is_empty()).all(is_number);
    let mark = if begins && !are_numbers() { "'" } else { "" };
    if field.contains([',', '"', '\r', '\n']) {
        format!("\"{mark}{}\"", field.replace('"', "\"\""))
    } else {
        format!("{mark}{field}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_texts_and_numbers_are_numbers() {
        for (field, written) in [
            ("-1.5", "-1.5"),
            ("-1 2e3 -4", "-1 2e3 -4"),
            ("-1 2; 3 -4", "-1 2; 3 -4"),
            ("roof", "roof"),
            ("=1+2", "'=1+2"),
            ("+cmd|' /C calc'!A0", "'+cmd|' /C calc'!A0"),
            ("-2+3", "'-2+3"),
            ("@SUM(A1,A2)", "\"'@SUM(A1,A2)\""),
            ("a \"b\", c", "\"a \"\"b\"\", c\""),
            ("", ""),
        ] {
            assert_eq!(cell(field), written);
        }
    }
}
