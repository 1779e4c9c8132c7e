//! Counts in words.

/// A count with its noun: `1 sheet`, `2 sheets`, `0 sheets`. Both forms are given, with the verb
/// where one follows: `counted(n, "fold is", "folds are")`.
///
/// ```
/// use kerfold_kernel::units::counted;
///
/// assert_eq!(counted(1, "vertex", "vertices"), "1 vertex");
/// assert_eq!(counted(0, "fold is", "folds are"), "0 folds are");
/// ```
pub fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
