//! The edges to open as a user names them: a selection, or a file.

use std::fmt;
use std::path::{Path, PathBuf};
use std::str::FromStr;

use serde::{Deserialize, Deserializer};

use super::MakeError;
use crate::io::read_seams;
use crate::mesh::{EdgeId, SplitVertex};
use crate::select::{Context, ParseError, Selection};

/// See the module documentation. A text that names an existing file, or ends in `.obj` or `.txt`,
/// is a file.
#[derive(Debug, Clone)]
pub enum SeamChoice {
    /// In the selection language.
    Selection(Selection),
    /// OBJ with `l` lines, or an edge list; see [`read_seams`].
    File(PathBuf),
}

impl SeamChoice {
    /// The edges on a mesh, ascending.
    ///
    /// # Errors
    /// What selecting or reading the file can refuse.
    pub fn edges(
        &self,
        context: &Context<'_>,
        splits: &[SplitVertex],
    ) -> Result<Vec<EdgeId>, MakeError> {
        Ok(match self {
            Self::Selection(selection) => selection.edges(context)?,
            Self::File(path) => read_seams(path, context.mesh, splits)?,
        })
    }

    pub(super) fn in_folder(&self, folder: &Path) -> Self {
        match self {
            Self::Selection(_) => self.clone(),
            Self::File(path) => Self::File(folder.join(path)),
        }
    }
}

impl FromStr for SeamChoice {
    type Err = ParseError;

    fn from_str(text: &str) -> Result<Self, ParseError> {
        let path = Path::new(text);
        let ends_like_a_file = path
            .extension()
            .is_some_and(|end| end.eq_ignore_ascii_case("obj") || end.eq_ignore_ascii_case("txt"));
        if ends_like_a_file || path.is_file() {
            Ok(Self::File(path.to_owned()))
        } else {
            text.parse().map(Self::Selection)
        }
    }
}

impl fmt::Display for SeamChoice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Selection(selection) => selection.fmt(f),
            Self::File(path) => path.display().fmt(f),
        }
    }
}

impl<'de> Deserialize<'de> for SeamChoice {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// A text is a selection or a file; ids are a selection.
        #[derive(Deserialize)]
        #[serde(
            untagged,
            expecting = "a selection like \"fold>60\", the name of a seam file, an id, or a list \
            of ids"
        )]
        enum Written {
            Text(String),
            Ids(Selection),
        }
        match Written::deserialize(deserializer)? {
            Written::Text(text) => text.parse().map_err(serde::de::Error::custom),
            Written::Ids(selection) => Ok(Self::Selection(selection)),
        }
    }
}
