//! The known word nearest to a mistyped one, for messages that say "did you mean".

/// The word of `known` that takes the fewest typing slips to become `typed`; the first of equals.
///
/// A slip is a letter missing, too many, wrong, or swapped with its neighbour (Damerau 1964).
/// `None` when every word is more than a third of its letters (but at least one slip) away: then a
/// guess would only mislead.
pub fn nearest_word<'a>(typed: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let typed = typed.to_lowercase();
    let length = typed.chars().count();
    let slips = |word: &str| {
        let letters = word.chars().count();
        // Beyond this no word is near; it also keeps a pasted file from costing time.
        let is_far = length.abs_diff(letters) > letters;
        if is_far { usize::MAX } else { strsim::osa_distance(&typed, word) }
    };
    let nearest =
        known.into_iter().map(|word| (slips(word), word)).min_by_key(|scored| scored.0)?;
    let (slips, word) = nearest;
    (slips <= (word.chars().count() / 3).max(1)).then_some(word)
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
