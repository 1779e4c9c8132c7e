//! Writing files safely: a file is whole or not there, and what was there before is never lost.
//!
//! Every file is written beside its place under a temporary name and then renamed. [`OutputFolder`]
//! does so for several files at once: all are written before the first is renamed, and when a
//! rename fails, the earlier ones are undone.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use super::IoError;

/// Writes `bytes` to `path`: whole, or not at all. An existing file is replaced and keeps its
/// permissions; a device or a pipe (`/dev/null`) is written to as it is. `-` is standard output.
///
/// # Errors
/// When the folder does not exist, a folder stands in the way, or the system refuses; then nothing
/// has changed.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    if path.as_os_str() == "-" {
        let mut out = std::io::stdout().lock();
        let written = out.write_all(bytes).and_then(|()| out.flush());
        return written.map_err(|source| unwritable(path, source));
    }
    check_parent(path)?;
    let target = Target::of(path)?;
    if target.is_device() {
        return fs::write(path, bytes).map_err(|source| unwritable(path, source));
    }
    Staged::write(target, bytes)?.publish()
}

/// Collects the files of one run and writes them into a folder together: all of them, or none.
#[derive(Debug, Clone)]
pub struct OutputFolder {
    folder: PathBuf,
    files: Vec<(String, Vec<u8>)>,
}

impl OutputFolder {
    /// An empty collection for `folder`. Nothing is written or made before [`Self::commit`].
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), files: Vec::new() }
    }

    /// The folder that the files will go to.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Adds a file by its plain name. A second file of the same name takes the place of the first.
    pub fn add(&mut self, name: impl Into<String>, bytes: impl Into<Vec<u8>>) {
        let (name, bytes) = (name.into(), bytes.into());
        match self.files.iter_mut().find(|(known, _)| *known == name) {
            Some(file) => file.1 = bytes,
            None => self.files.push((name, bytes)),
        }
    }

    /// The names of the files so far, in the order in which they were added.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|(name, _)| name.as_str())
    }

    /// Writes all files, making the folder and its parents when they are missing, and returns their
    /// paths. Other files in the folder stay as they are.
    ///
    /// # Errors
    /// When the folder cannot be made, a folder stands where a file should go, or the system
    /// refuses. Then new folders and files are removed again, and files that were there before are
    /// as before.
    pub fn commit(self) -> Result<Vec<PathBuf>, IoError> {
        let made = MadeFolders::make(&self.folder)?;
        let mut staged = Vec::with_capacity(self.files.len());
        for (name, bytes) in &self.files {
            staged.push(Staged::write(Target::of(&self.folder.join(name))?, bytes)?);
        }
        publish_all(staged)?;
        made.keep();
        Ok(self.files.iter().map(|(name, _)| self.folder.join(name)).collect())
    }
}

/// Renames all staged files to their places; undoes the earlier renames when one fails.
fn publish_all(staged: Vec<Staged>) -> Result<(), IoError> {
    let mut backups = Vec::with_capacity(staged.len());
    for file in &staged {
        backups.push(file.target.back_up()?);
    }
    let places: Vec<PathBuf> = staged.iter().map(|file| file.target.path.clone()).collect();
    for (i, file) in staged.into_iter().enumerate() {
        if let Err(error) = file.publish() {
            places[..i]
                .iter()
                .zip(&mut backups)
                .for_each(|(place, backup)| restore(place, backup.as_mut()));
            return Err(error);
        }
    }
    Ok(())
}

/// Puts back what was at `place` before. When even that fails, the backup stays beside its place.
fn restore(place: &Path, backup: Option<&mut Temporary>) {
    match backup {
        Some(backup) => backup.is_kept = fs::rename(&backup.path, place).is_err(),
        None => drop(fs::remove_file(place)),
    }
}

/// Where a file should go, and what is there now.
struct Target {
    path: PathBuf,
    existing: Option<Metadata>,
}

impl Target {
    fn of(path: &Path) -> Result<Self, IoError> {
        // A link stays a link; the file that it names is replaced.
        let linked = if path.is_symlink() { fs::canonicalize(path).ok() } else { None };
        let path = linked.unwrap_or_else(|| path.to_owned());
        let existing = fs::metadata(&path).ok();
        match &existing {
            Some(there) if there.is_dir() => Err(IoError::IsFolder { path }),
            Some(there) if there.permissions().readonly() => Err(IoError::WriteProtected { path }),
            _ => Ok(Self { path, existing }),
        }
    }

    fn is_device(&self) -> bool {
        self.existing.as_ref().is_some_and(|there| !there.is_file())
    }

    /// A second name (or a copy) of the file that is there now.
    fn back_up(&self) -> Result<Option<Temporary>, IoError> {
        if self.existing.is_none() {
            return Ok(None);
        }
        let backup = Temporary::beside(&self.path);
        let saved = fs::hard_link(&self.path, &backup.path)
            .or_else(|_| fs::copy(&self.path, &backup.path).map(drop));
        saved.map_err(|source| unwritable(&self.path, source)).map(|()| Some(backup))
    }
}

/// A file that is written, but not yet in its place.
struct Staged {
    temporary: Temporary,
    target: Target,
}

impl Staged {
    fn write(target: Target, bytes: &[u8]) -> Result<Self, IoError> {
        let temporary = Temporary::beside(&target.path);
        let written =
            OpenOptions::new().write(true).create_new(true).open(&temporary.path).and_then(
                |file| {
                    fill(file, bytes)?;
                    target.existing.as_ref().map_or(Ok(()), |there| {
                        fs::set_permissions(&temporary.path, there.permissions())
                    })
                },
            );
        match written {
            Ok(()) => Ok(Self { temporary, target }),
            Err(source) => Err(unwritable(&target.path, source)),
        }
    }

    fn publish(mut self) -> Result<(), IoError> {
        fs::rename(&self.temporary.path, &self.target.path)
            .map_err(|source| unwritable(&self.target.path, source))?;
        self.temporary.is_kept = true;
        Ok(())
    }
}

fn fill(mut file: File, bytes: &[u8]) -> std::io::Result<()> {
    file.write_all(bytes)?;
    file.flush()
}

/// A file under a temporary name; removed when dropped, unless it is kept.
struct Temporary {
    path: PathBuf,
    is_kept: bool,
}

impl Temporary {
    fn beside(path: &Path) -> Self {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let path = path.with_file_name(format!(".kerfold-{}-{number}.tmp", std::process::id()));
        Self { path, is_kept: false }
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.is_kept {
            // It may never have been made.
            drop(fs::remove_file(&self.path));
        }
    }
}

/// Folders that were made for the output; removed when dropped, unless they are kept.
struct MadeFolders {
    innermost_first: Vec<PathBuf>,
}

impl MadeFolders {
    fn make(folder: &Path) -> Result<Self, IoError> {
        let is_missing = |f: &&Path| !f.as_os_str().is_empty() && fs::symlink_metadata(f).is_err();
        let missing: Vec<PathBuf> =
            folder.ancestors().take_while(is_missing).map(Path::to_owned).collect();
        let mut made = Self { innermost_first: Vec::new() };
        check_is_folder(folder.ancestors().nth(missing.len()).unwrap_or(folder), folder)?;
        for folder in missing.into_iter().rev() {
            match fs::create_dir(&folder) {
                Ok(()) => made.innermost_first.insert(0, folder),
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
                Err(source) => return Err(unwritable(&folder, source)),
            }
        }
        Ok(made)
    }

    fn keep(mut self) {
        self.innermost_first.clear();
    }
}

impl Drop for MadeFolders {
    fn drop(&mut self) {
        for folder in &self.innermost_first {
            // A folder that somebody else has filled meanwhile stays.
            drop(fs::remove_dir(folder));
        }
    }
}

fn check_parent(path: &Path) -> Result<(), IoError> {
    let Some(parent) = path.parent().filter(|p| !p.as_os_str().is_empty()) else { return Ok(()) };
    match parent.ancestors().find(|f| f.as_os_str().is_empty() || f.exists()) {
        Some(there) if there != parent && (there.as_os_str().is_empty() || there.is_dir()) => {
            Err(IoError::NoFolder { path: path.to_owned(), folder: parent.to_owned() })
        }
        Some(there) => check_is_folder(there, path),
        None => Ok(()),
    }
}

fn check_is_folder(there: &Path, wanted: &Path) -> Result<(), IoError> {
    if there.as_os_str().is_empty() || there.is_dir() {
        return Ok(());
    }
    Err(IoError::NotAFolder { path: wanted.to_owned(), file: there.to_owned() })
}

fn unwritable(path: &Path, source: std::io::Error) -> IoError {
    IoError::Unwritable { path: path.to_owned(), source }
}

#[cfg(test)]
mod tests;
