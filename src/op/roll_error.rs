//! Why edges cannot be rolled as asked.

use super::rolled::Place;
use crate::code::codes;
use crate::mesh::{EdgeId, VertexId};

/// Why no edge was rolled; nothing was cut.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RollError {
    /// The edge is none that planes can roll.
    #[error(
        "edge {edge} is {why}, and cutting rolls only edges that bend outwards; leave it out of \
        the selection, and it stays a sharp fold"
    )]
    NotConvex {
        /// The edge.
        edge: EdgeId,
        /// What it is instead of convex.
        why: &'static str,
    },
    /// Another edge at one of its ends is not convex.
    #[error(
        "edge {edge} ends at vertex {vertex}, where edge {other} is {why}: the strips would have \
        no face to end on; leave edge {edge} out of the selection, and it stays a sharp fold"
    )]
    EndNotConvex {
        /// The chosen edge.
        edge: EdgeId,
        /// Its end.
        vertex: VertexId,
        /// The edge there that does not bend outwards.
        other: EdgeId,
        /// What it is instead of convex.
        why: &'static str,
    },
    /// Two chosen edges share an end.
    #[error(
        "edges {first} and {second} meet at vertex {vertex}, so their rolls would run into each \
        other; roll them in two steps, or leave one out of the selection"
    )]
    EdgesMeet {
        /// The edge with the lower number.
        first: EdgeId,
        /// The other one.
        second: EdgeId,
        /// Where they meet.
        vertex: VertexId,
    },
    /// The radius leaves nothing of an edge or face that must stay.
    #[error("{asked} is too large: the rolls would take all of {place}{}; {}",
        of_edges(edges), advice(asked, *largest))]
    TooLarge {
        /// The roll that was asked for.
        asked: String,
        /// What limits it.
        place: Place,
        /// The edges whose rolls meet there.
        edges: Vec<EdgeId>,
        /// The largest radius that fits, in mm; for a cone that of its wider end, both made smaller
        /// alike. 0 where none fits.
        largest: f64,
    },
    /// A radius that is none.
    #[error("the radius is {radius} mm, but it must be above 0 and finite")]
    BadRadius {
        /// What was given, in mm.
        radius: f64,
    },
    /// A number or size of strips that is none.
    #[error("{what} is {value}, but it must be {range}; 9 strips are usual, which is `--strips 9`")]
    BadStrips {
        /// What was given.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The range, in words.
        range: &'static str,
    },
    /// What was cut is not what was planned; found by code that did not cut.
    #[error(
        "the rolls did not come out as planned: {what}; take a smaller radius, fewer strips, or \
        make faces planar first with `kerfold planarize`"
    )]
    NotAsPlanned {
        /// What differs, with its numbers.
        what: String,
    },
}

codes!(error RollError {
    NotConvex = 342,
    EndNotConvex = 343,
    EdgesMeet = 344,
    TooLarge = 345,
    BadRadius = 346,
    BadStrips = 347,
    NotAsPlanned = 348,
});

fn of_edges(edges: &[EdgeId]) -> String {
    match edges {
        [] => String::new(),
        [one] => format!(", at edge {one}"),
        many => {
            let names: Vec<String> = many.iter().map(ToString::to_string).collect();
            format!(", between edges {}", names.join(" and "))
        }
    }
}

fn advice(asked: &str, largest: f64) -> String {
    if largest <= 0.0 {
        "leave the edge out of the selection".to_owned()
    } else if asked.contains(',') {
        format!("take {largest} mm at most at the wider end and less alike at the other")
    } else {
        format!("take {largest} mm at most, or `max`")
    }
}
