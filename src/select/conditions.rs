//! The conditions of the selection language as a table, for the parser's hints and the reference.

/// A condition and what it selects. Of elements for which it has no meaning it says [`NOTHING`];
/// there it is an error.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Condition {
    /// The word that it begins with; empty for ids.
    pub word: &'static str,
    /// An example, which can be copied.
    pub example: &'static str,
    /// Which vertices.
    pub vertices: &'static str,
    /// Which edges.
    pub edges: &'static str,
    /// Which faces.
    pub faces: &'static str,
}

/// Stands where a condition has no meaning.
pub const NOTHING: &str = "–";

/// All conditions.
pub const CONDITIONS: [Condition; 15] = [
    row("all", "all", "all", "all", "all but holes"),
    row("", "3,7,10-14", "by id", "by id", "by id"),
    row(
        "valence",
        "valence=4",
        "by the number of edges there",
        "with two such ends",
        "with such corners only",
    ),
    row("sides", "sides=5", NOTHING, NOTHING, "by their number of sides"),
    row(
        "fold",
        "fold>30deg",
        NOTHING,
        "by the size of the fold angle; rims have none and never fit",
        NOTHING,
    ),
    row(
        "along",
        "along=z:5deg",
        NOTHING,
        "parallel to the direction within the angle, either way",
        NOTHING,
    ),
    row(
        "above",
        "above=z:10mm",
        "beyond that height",
        "with both ends there",
        "with all corners there",
    ),
    row(
        "below",
        "below=z:10mm",
        "short of that height",
        "with both ends there",
        "with all corners there",
    ),
    row(
        "normal",
        "normal=z:20deg",
        "by the mean of the unit normals around them",
        NOTHING,
        "with the normal within the angle of the direction",
    ),
    row("group", "group=roof", "on a face of the group", "on a face of the group", "in the group"),
    row(
        "made",
        "made",
        "that the last step made",
        "that the last step made",
        "that the last step made",
    ),
    row("strip", "strip", NOTHING, "the long edges that the last step made", NOTHING),
    row(
        "matching",
        "matching:7",
        NOTHING,
        "folds of a D-form: with a number that row of `kerfold seams`, without it the least fold \
        angle × length in all",
        NOTHING,
    ),
    row(
        "flattest",
        "flattest",
        NOTHING,
        "folds of a D-form with the least fold angle in all",
        NOTHING,
    ),
    row("hamiltonian", "hamiltonian", NOTHING, "folds of a D-form of two pieces", NOTHING),
];

const fn row(
    word: &'static str,
    example: &'static str,
    vertices: &'static str,
    edges: &'static str,
    faces: &'static str,
) -> Condition {
    Condition { word, example, vertices, edges, faces }
}

/// The words that can begin a condition.
pub(super) fn words() -> impl Iterator<Item = &'static str> {
    CONDITIONS.iter().map(|condition| condition.word).filter(|word| !word.is_empty())
}
