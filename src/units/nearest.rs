//! The known word nearest to a mistyped one, for messages that say "did you mean".

/// The word of `known` that takes the fewest typing slips to become `typed`; the first of equals.
///
/// A slip is a letter missing, too many, wrong, or swapped with its neighbour (Damerau 1964).
/// `None` when every word is more than a third of its letters (but at least one slip) away: then a
/// guess would only mislead.
pub fn nearest_word<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed: Vec<char> = typed.to_lowercase().chars().collect();
    let scored =
        known.into_iter().map(|word| (slips(&typed, &word.chars().collect::<Vec<_>>()), word));
    let (slips, word) = scored.min_by_key(|&(slips, _)| slips)?;
    (slips <= (word.chars().count() / 3).max(1)).then_some(word)
}

/// The optimal string alignment distance, by rows.
fn slips(a: &[char], b: &[char]) -> usize {
    // Beyond this no word of ours is near; it also keeps a pasted file from costing time.
    if a.len().abs_diff(b.len()) > b.len() {
        return usize::MAX;
    }
    let mut before: Vec<usize> = Vec::new();
    let mut above: Vec<usize> = (0..=b.len()).collect();
    for i in 1..=a.len() {
        let mut row = vec![i; b.len() + 1];
        for j in 1..=b.len() {
            let change = above[j - 1] + usize::from(a[i - 1] != b[j - 1]);
            row[j] = change.min(above[j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                row[j] = row[j].min(before[j - 2] + 1);
            }
        }
        before = std::mem::replace(&mut above, row);
    }
    above[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slips_of_each_kind_are_mended_and_strangers_are_not() {
        let words = ["valence", "sides", "fold", "made"];
        for (typed, expected) in [
            ("valense", Some("valence")),
            ("Valence", Some("valence")),
            ("vlaence", Some("valence")),
            ("side", Some("sides")),
            ("foldd", Some("fold")),
            ("colour", None),
            ("", None),
        ] {
            assert_eq!(nearest_word(typed, words), expected, "{typed}");
        }
        assert_eq!(nearest_word(&"x".repeat(1_000_000), words), None);
    }
}
