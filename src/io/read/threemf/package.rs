//! The zip that a 3MF file is.

use std::io::{Cursor, Read as _};

use roxmltree::Document;
use zip::ZipArchive;

use super::broken;
use crate::io::error::ContentFault;
use crate::io::read::decode_text;

/// Bytes that all parts together may have when they are unpacked; a tree of XML takes ten times as
/// many.
const MOST: usize = 128 << 20;
const RELATIONSHIPS: &str = "_rels/.rels";
/// Where the model lies when nothing says where.
const USUAL: &str = "3D/3dmodel.model";

/// Whether a file begins as zip files do.
pub(in crate::io::read) fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04")
}

pub(super) struct Package<'a> {
    archive: ZipArchive<Cursor<&'a [u8]>>,
    /// How many bytes may still be unpacked.
    left: usize,
}

impl<'a> Package<'a> {
    pub fn open(bytes: &'a [u8]) -> Result<Self, ContentFault> {
        let archive = ZipArchive::new(Cursor::new(bytes));
        let archive = archive.map_err(|error| broken(format!("it is no zip ({error})")))?;
        Ok(Self { archive, left: MOST })
    }

    /// The path of the part with the model.
    pub fn root(&mut self) -> Result<String, ContentFault> {
        let Ok(text) = self.text(RELATIONSHIPS) else { return Ok(USUAL.to_owned()) };
        let document = Document::parse(&text);
        let document =
            document.map_err(|error| broken(format!("{RELATIONSHIPS} is no XML ({error})")))?;
        let is_model = |node: &roxmltree::Node<'_, '_>| {
            node.attribute("Type").is_some_and(|kind| kind.ends_with("/3dmodel"))
        };
        let model = document.descendants().find(is_model).and_then(|node| node.attribute("Target"));
        Ok(model.map_or(USUAL, |path| path.trim_start_matches('/')).to_owned())
    }

    /// A part as text.
    pub fn text(&mut self, path: &str) -> Result<String, ContentFault> {
        let path = path.trim_start_matches('/');
        let mut bytes = Vec::new();
        let file = self.archive.by_name(path);
        let file = file.map_err(|error| broken(format!("{path} cannot be opened ({error})")))?;
        // What the zip says about sizes is not believed.
        let read = file.take(self.left as u64 + 1).read_to_end(&mut bytes);
        read.map_err(|error| broken(format!("{path} cannot be unpacked ({error})")))?;
        match self.left.checked_sub(bytes.len()) {
            Some(left) => self.left = left,
            None => return Err(ContentFault::TooMuchUnpacked { most: MOST >> 20 }),
        }
        decode_text(&bytes).map_err(|at| broken(format!("byte {at} of {path} is no UTF-8")))
    }
}
