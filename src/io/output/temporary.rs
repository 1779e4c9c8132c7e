//! A folder that goes when it is no longer needed.

use std::path::Path;

use crate::io::IoError;

/// A folder among the system's temporary ones, which goes with everything in it when it is dropped.
#[derive(Debug)]
pub struct TemporaryFolder(tempfile::TempDir);

impl TemporaryFolder {
    /// Makes one.
    ///
    /// # Errors
    /// [`IoError::Unwritable`].
    ///
    /// # Example
    /// ```
    /// use kerfold::io::output::TemporaryFolder;
    ///
    /// let folder = TemporaryFolder::new()?;
    /// std::fs::write(folder.path().join("note"), "short")?;
    /// let path = folder.path().to_owned();
    /// drop(folder);
    /// assert!(!path.exists());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn new() -> Result<Self, IoError> {
        let made = tempfile::Builder::new().prefix("kerfold-").tempdir();
        made.map(Self).map_err(|source| IoError::Unwritable { path: std::env::temp_dir(), source })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.0.path()
    }
}
