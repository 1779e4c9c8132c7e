//! The selection language: which vertices, edges, faces.
//!
//! Conditions are joined by `!` (not), `&` (and), `|` (or), binding in this order, and brackets.
//! What each condition means for each kind of element says the table [`CONDITIONS`], which
//! `docs/reference.md` shows.
//!
//! Where it says –, the condition is an error. `valence`, `sides` and `fold` take `=`, `!=`, `<`,
//! `<=`, `>`, `>=`. Directions are `x`, `-z`, … or three numbers (`along=1,1,0:5deg`); the
//! tolerance of `along` and `normal` is 1deg when left out. Angles that differ by no more than a
//! millionth of a degree are equal. A group name with `&`, `|`, brackets or blanks at its ends goes
//! in quotes: `group="top (left)"`.

mod alike;
mod conditions;
mod error;
mod evaluate;
mod expr;
mod found;
mod parse;
mod seams;

pub use alike::{Likeness, alike};
pub use conditions::{CONDITIONS, Condition, NOTHING};
pub use error::{ElementKind, SelectError};
pub use parse::ParseError;

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, de};

use crate::mesh::{EdgeId, FaceId, Mesh, Renumbering, VertexId};
use crate::progress::{Progress, Silent};
use expr::{Atom, Expr};

/// A parsed selection: read by [`str::parse`], written by [`fmt::Display`]; in a recipe a text, an
/// id, or a list of ids.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection(Expr);

/// What a selection is evaluated on.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// The mesh as it is now.
    pub mesh: &'a Mesh,
    /// What the last step made, for `made` and `strip`.
    pub made: Option<&'a NewElements>,
    /// Progress and Ctrl-C; choosing folds on a large mesh takes a while.
    pub progress: &'a dyn Progress,
}

/// What an operator made, in ids of the mesh that it returned.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct NewElements {
    /// New vertices.
    pub vertices: Vec<VertexId>,
    /// New edges.
    pub edges: Vec<EdgeId>,
    /// Of the new edges the long ones: those along which a cut edge or strip runs.
    pub strip: Vec<EdgeId>,
    /// New faces.
    pub faces: Vec<FaceId>,
}

impl NewElements {
    /// Closes the gaps in the ids of a mesh, and follows the ids to their new numbers.
    pub(crate) fn compact(&mut self, mesh: &mut Mesh) -> Renumbering {
        let map = mesh.compact();
        self.vertices = self.vertices.iter().filter_map(|&v| map.vertex(v)).collect();
        self.edges = self.edges.iter().filter_map(|&e| map.edge(e)).collect();
        self.strip = self.strip.iter().filter_map(|&e| map.edge(e)).collect();
        self.faces = self.faces.iter().filter_map(|&f| map.face(f)).collect();
        map
    }
}

impl<'a> Context<'a> {
    /// A mesh on which no step was done yet.
    pub fn of(mesh: &'a Mesh) -> Self {
        Self { mesh, made: None, progress: &Silent }
    }
}

impl Selection {
    /// Everything.
    pub fn all() -> Self {
        Self(Expr::Atom(Atom::All))
    }

    /// These vertices, given in any order. `None` when there are none.
    pub fn of_vertices(ids: impl IntoIterator<Item = VertexId>) -> Option<Self> {
        Self::of_ids(ids.into_iter().map(|v| v.index() as u32))
    }

    /// These edges, given in any order. `None` when there are none.
    pub fn of_edges(ids: impl IntoIterator<Item = EdgeId>) -> Option<Self> {
        Self::of_ids(ids.into_iter().map(|e| e.index() as u32))
    }

    /// These faces, given in any order. `None` when there are none.
    pub fn of_faces(ids: impl IntoIterator<Item = FaceId>) -> Option<Self> {
        Self::of_ids(ids.into_iter().map(|f| f.index() as u32))
    }

    /// The elements with these ids, of whatever kind the operator asks for.
    fn of_ids(ids: impl IntoIterator<Item = u32>) -> Option<Self> {
        let mut runs: Vec<(u32, u32)> = Vec::new();
        for id in ids {
            match runs.last_mut() {
                Some((_, last)) if last.checked_add(1) == Some(id) => *last = id,
                _ => runs.push((id, id)),
            }
        }
        (!runs.is_empty()).then_some(Self(Expr::Atom(Atom::Ids(runs))))
    }

    /// The selected vertices, ascending.
    ///
    /// # Errors
    /// [`SelectError`]; an empty result is one too.
    pub fn vertices(&self, context: &Context<'_>) -> Result<Vec<VertexId>, SelectError> {
        let chosen = evaluate::evaluate(&self.0, context, ElementKind::Vertex)?;
        Ok(chosen.into_iter().map(VertexId::new).collect())
    }

    /// The selected edges, ascending.
    ///
    /// # Errors
    /// As [`Self::vertices`].
    pub fn edges(&self, context: &Context<'_>) -> Result<Vec<EdgeId>, SelectError> {
        let chosen = evaluate::evaluate(&self.0, context, ElementKind::Edge)?;
        Ok(chosen.into_iter().map(EdgeId::new).collect())
    }

    /// The selected faces, ascending; never a hole.
    ///
    /// # Errors
    /// As [`Self::vertices`].
    pub fn faces(&self, context: &Context<'_>) -> Result<Vec<FaceId>, SelectError> {
        let chosen = evaluate::evaluate(&self.0, context, ElementKind::Face)?;
        Ok(chosen.into_iter().map(FaceId::new).collect())
    }
}

impl FromStr for Selection {
    type Err = ParseError;

    fn from_str(text: &str) -> Result<Self, ParseError> {
        parse::parse(text).map(Self)
    }
}

impl fmt::Display for Selection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl<'de> Deserialize<'de> for Selection {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader)
    }
}

/// Reads a selection from a text, an id, or a list of ids.
struct Reader;

impl<'de> de::Visitor<'de> for Reader {
    type Value = Selection;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a selection like \"valence=4\", an id, or a list of ids")
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<Selection, E> {
        text.parse().map_err(E::custom)
    }

    fn visit_u64<E: de::Error>(self, id: u64) -> Result<Selection, E> {
        let id =
            u32::try_from(id).map_err(|_| E::invalid_value(de::Unexpected::Unsigned(id), &self))?;
        Ok(Selection(Expr::Atom(Atom::Ids(vec![(id, id)]))))
    }

    fn visit_i64<E: de::Error>(self, id: i64) -> Result<Selection, E> {
        let whole =
            u64::try_from(id).map_err(|_| E::invalid_value(de::Unexpected::Signed(id), &self))?;
        self.visit_u64(whole)
    }

    fn visit_seq<A: de::SeqAccess<'de>>(self, mut list: A) -> Result<Selection, A::Error> {
        let mut ids: Vec<u32> = Vec::new();
        while let Some(id) = list.next_element()? {
            ids.push(id);
        }
        Selection::of_ids(ids).ok_or_else(|| de::Error::custom(ParseError::Empty))
    }
}

#[cfg(test)]
mod tests;
