//! Why a selection cannot be evaluated.

use std::fmt;

use crate::code::codes;
use crate::seam::SeamError;

/// What is selected.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ElementKind {
    /// Vertices.
    Vertex,
    /// Edges.
    Edge,
    /// Faces that are not holes.
    Face,
}

impl fmt::Display for ElementKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Vertex => "vertex",
            Self::Edge => "edge",
            Self::Face => "face",
        })
    }
}

impl ElementKind {
    /// The word for several of them.
    pub fn plural(self) -> &'static str {
        match self {
            Self::Vertex => "vertices",
            Self::Edge => "edges",
            Self::Face => "faces",
        }
    }
}

/// Why a selection cannot be evaluated on a mesh.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SelectError {
    /// The condition has no meaning for this kind of element.
    #[error("`{atom}` selects {}, but {} are wanted here", list(serves), wanted.plural())]
    WrongKind {
        /// The condition.
        atom: String,
        /// What is wanted.
        wanted: ElementKind,
        /// What the condition selects.
        serves: &'static [ElementKind],
    },
    /// An id that no element has.
    #[error("there is no {kind} {id}; {}", numbered(*kind, *count, *last))]
    NoSuchId {
        /// What was looked for.
        kind: ElementKind,
        /// The id.
        id: u32,
        /// How many there are.
        count: usize,
        /// The highest id; `None` when there are none.
        last: Option<usize>,
    },
    /// A group that the mesh does not have.
    #[error("no face belongs to a group called `{name}`; {}", groups(nearest.as_deref(), known))]
    NoSuchGroup {
        /// The name.
        name: String,
        /// The nearest name that exists.
        nearest: Option<String>,
        /// The groups of the mesh.
        known: Vec<String>,
    },
    /// There was no step before.
    #[error(
        "`{atom}` means what the last step made, but no step came before: OBJ files tell it, others do not"
    )]
    NothingMade {
        /// The condition.
        atom: String,
    },
    /// The seams that were asked for do not exist.
    #[error("`{atom}`: {source}")]
    Seams {
        /// The condition.
        atom: String,
        /// Why.
        source: SeamError,
    },
    /// Nothing fits.
    #[error(
        "`{selection}` selects no {kind}{}",
        found.as_ref().map(|found| format!("; {found}")).unwrap_or_default()
    )]
    Empty {
        /// The whole selection.
        selection: String,
        /// What was looked for.
        kind: ElementKind,
        /// What there is instead.
        found: Option<String>,
    },
}

codes!(error SelectError {
    WrongKind = 281,
    NoSuchId = 282,
    NoSuchGroup = 283,
    NothingMade = 284,
    Empty = 285,
} through {
    Seams.source,
});

fn list(kinds: &[ElementKind]) -> String {
    kinds.iter().map(|kind| kind.plural()).collect::<Vec<_>>().join(" and ")
}

fn numbered(kind: ElementKind, count: usize, last: Option<usize>) -> String {
    match last {
        Some(last) => format!("the mesh has {count} {}, numbered from 0 to {last}", kind.plural()),
        None => format!("the mesh has no {}", kind.plural()),
    }
}

fn groups(nearest: Option<&str>, known: &[String]) -> String {
    match (nearest, known) {
        (Some(name), _) => format!("did you mean `{name}`?"),
        (None, []) => "the mesh has no groups".to_owned(),
        (None, known) if known.len() <= 12 => format!("the groups are {}", known.join(", ")),
        (None, known) => {
            format!("the mesh has {} groups, among them {}", known.len(), known[..12].join(", "))
        }
    }
}
