//! Findings in words.

use super::PanelizeFinding;

/// What is wrong where panels have this finding, and what to do; `None` for [`words_of_wishes`].
pub(super) fn words(kind: PanelizeFinding) -> Option<(&'static str, &'static str)> {
    Some(match kind {
        PanelizeFinding::Crosses => (
            "panels that cross themselves or run against the surface",
            "take a smaller size, another alignment or another seed",
        ),
        PanelizeFinding::GoesThrough => {
            ("panels that go through another", "take a smaller size or another seed")
        }
        PanelizeFinding::NotPlanar => {
            ("panels that are not planar up to rounding", "take a smaller size or another seed")
        }
        PanelizeFinding::TooCurved => (
            "panels that leave the surface by more than is allowed, since it bends too much for \
                their size",
            "take a smaller size, or allow more (--max-off)",
        ),
        PanelizeFinding::ShortEdge => {
            ("panels with a shorter edge than allowed", "take another seed or a smaller size")
        }
        PanelizeFinding::SharpAngle => {
            ("panels with a sharper angle than allowed", "take another seed or a smaller size")
        }
        PanelizeFinding::TooLarge => ("panels that do not fit the sheet", "take a smaller size"),
        PanelizeFinding::FarNode => (
            "vertices that plates reach from far",
            "bend the surface more there, take another seed, or allow more (--max-reach)",
        ),
        PanelizeFinding::CreaseLost => (
            "panels that a crease runs through, farther from all edges than a tenth of their \
                size",
            "take a smaller size or another seed",
        ),
        PanelizeFinding::FullNode => (
            "vertices with more than three members, since so many creases meet there",
            "cut the corner off in the model, or keep fewer creases with a larger `--crease`",
        ),
        PanelizeFinding::UnevenRing => (
            "rings of which the panels are not congruent, by their first panels",
            "take another size, or `--layout free`",
        ),
        _ => return None,
    })
}

/// The same for what only some users ask for.
pub(super) fn words_of_wishes(kind: PanelizeFinding) -> (&'static str, &'static str) {
    match kind {
        PanelizeFinding::PlaneLost => (
            "panels that left the planes that were given for them",
            "change one of the planes that meet there, or take a smaller size",
        ),
        PanelizeFinding::PointLost => (
            "vertices that are nearest to points that were to stay, and miss them",
            "move the point, leave it out, or take a smaller size",
        ),
        PanelizeFinding::Unpaired => (
            "panels that are no images of others across a mirror plane",
            "take another seed or a smaller size",
        ),
        PanelizeFinding::ManyLengths => (
            "edges that have the length of no family",
            "ask for more families, or for fewer panels",
        ),
        PanelizeFinding::SharpFold => (
            "panels that fold against a neighbour by more than is allowed",
            "take a smaller size, or allow more (--max-fold)",
        ),
        PanelizeFinding::DeepHollow => (
            "concave panels that are deeper than is allowed, as they must be where the surface is a \
                saddle",
            "take a smaller size, or allow more (--max-hollow)",
        ),
        _ => ("panels that are not finished", "run it to the end"),
    }
}

/// What is measured where a panel has this finding; nothing where nothing is.
pub(super) fn unit_of(kind: PanelizeFinding) -> &'static str {
    match kind {
        PanelizeFinding::SharpAngle | PanelizeFinding::SharpFold => "°",
        PanelizeFinding::FarNode => " thicknesses",
        PanelizeFinding::FullNode => " panels",
        PanelizeFinding::UnevenRing => " kinds",
        PanelizeFinding::Unpaired => " panels",
        PanelizeFinding::Crosses | PanelizeFinding::GoesThrough => "",
        _ => " mm",
    }
}
