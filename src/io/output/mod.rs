//! Writing files safely: a file is whole or not there, and what was there before is never lost.
//!
//! Every file is written beside its place under a temporary name and then renamed. [`OutputFolder`]
//! does so for several files at once: all are written before the first is renamed, and when a
//! rename fails, the earlier ones are undone.

use std::fs::{self, File, Metadata};
use std::io::{ErrorKind, Write as _};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempPath};

use super::IoError;

mod stale;
mod temporary;

pub use temporary::TemporaryFolder;

/// The letters and digits of temporary names, drawn by the system's randomness: runs in containers
/// that share a folder and not their process numbers never meet.
const RANDOM_LETTERS: usize = 12;

/// Writes `bytes` to `path`: whole, or not at all. An existing file is replaced and keeps its
/// permissions; a device or a pipe (`/dev/null`) is written to as it is. `-` is standard output.
///
/// # Errors
/// When the folder does not exist, a folder stands in the way, or the system refuses; then nothing
/// has changed.
///
/// # Example
/// ```
/// let path = std::env::temp_dir().join(format!("kerfold-doc-{}-note.txt", std::process::id()));
/// kerfold::io::output::write_file(&path, b"whole, or not at all")?;
/// assert_eq!(std::fs::read(&path)?, b"whole, or not at all");
/// # std::fs::remove_file(&path)?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), IoError> {
    if path.as_os_str() == "-" {
        let mut out = std::io::stdout().lock();
        let written = out.write_all(bytes).and_then(|()| out.flush());
        return written.map_err(|source| unwritable(path, source));
    }
    check_parent(path)?;
    write_all(std::iter::once((path.to_owned(), bytes)))
}

/// Writes several files, each to its path: all of them, or none, as [`OutputFolder::commit`] does
/// in one folder. The folders must exist.
///
/// # Errors
/// As [`write_file`].
///
/// # Example
/// ```
/// let name = |n| std::env::temp_dir().join(format!("kerfold-doc-{}-{n}.txt", std::process::id()));
/// kerfold::io::output::write_files(&[(name(1), b"one".to_vec()), (name(2), b"two".to_vec())])?;
/// assert_eq!(std::fs::read(name(2))?, b"two");
/// # std::fs::remove_file(name(1))?;
/// # std::fs::remove_file(name(2))?;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_files(files: &[(PathBuf, Vec<u8>)]) -> Result<(), IoError> {
    for (path, _) in files {
        check_parent(path)?;
    }
    write_all(files.iter().map(|(path, bytes)| (path.clone(), bytes.as_slice())))
}

/// Writes files into folders that exist. Devices and pipes come last, as they are: what went into
/// them cannot be taken back.
fn write_all<'a>(files: impl Iterator<Item = (PathBuf, &'a [u8])>) -> Result<(), IoError> {
    let (mut staged, mut devices) = (Vec::new(), Vec::new());
    for (path, bytes) in files {
        let target = Target::of(&path)?;
        if target.is_device() {
            devices.push((path, bytes));
        } else {
            staged.push(Staged::write(target, bytes)?);
        }
    }
    publish_all(staged)?;
    devices.into_iter().try_for_each(|(path, bytes)| {
        fs::write(&path, bytes).map_err(|source| unwritable(&path, source))
    })
}

/// What [`OutputFolder::commit`] has done.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Written {
    /// The files, in the order in which they were added.
    pub paths: Vec<PathBuf>,
    /// Files of an earlier run that are no part of this one: sheets beyond the last, parts that are
    /// gone, formats not asked for any more. By name, in the same folder.
    pub stale: Vec<PathBuf>,
}

impl Written {
    /// Removes the files of an earlier run.
    ///
    /// # Errors
    /// When the system refuses; the files before are gone by then.
    pub fn remove_stale(&self) -> Result<(), IoError> {
        for path in &self.stale {
            match fs::remove_file(path) {
                Err(source) if source.kind() != ErrorKind::NotFound => {
                    return Err(unwritable(path, source));
                }
                _ => {}
            }
        }
        Ok(())
    }
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

    /// Writes all files, making the folder and its parents when they are missing. Other files in
    /// the folder stay as they are; those of an earlier run are named in the result.
    ///
    /// # Errors
    /// When the folder cannot be made, a folder stands where a file should go, or the system
    /// refuses. Then new folders and files are removed again, and files that were there before are
    /// as before.
    pub fn commit(self) -> Result<Written, IoError> {
        let made = MadeFolders::make(&self.folder)?;
        let files = self.files.iter();
        write_all(files.map(|(name, bytes)| (self.folder.join(name), bytes.as_slice())))?;
        made.keep();
        let names: Vec<&str> = self.names().collect();
        Ok(Written {
            paths: names.iter().map(|name| self.folder.join(name)).collect(),
            stale: stale::of_earlier_runs(&self.folder, &names),
        })
    }
}

/// Renames all staged files to their places; undoes the earlier renames when one fails. The files
/// are on the disk before, and the names when this returns: a power cut leaves the old or the new.
fn publish_all(staged: Vec<Staged>) -> Result<(), IoError> {
    let mut backups = Vec::with_capacity(staged.len());
    if staged.len() > 1 {
        for file in &staged {
            backups.push(file.target.back_up()?);
        }
    }
    let places: Vec<PathBuf> = staged.iter().map(|file| file.target.path.clone()).collect();
    for (i, file) in staged.into_iter().enumerate() {
        if let Err(error) = file.publish() {
            for (place, backup) in places[..i].iter().zip(&mut backups) {
                restore(place, backup.take());
            }
            return Err(error);
        }
    }
    let mut folders: Vec<&Path> = places.iter().filter_map(|place| place.parent()).collect();
    folders.sort_unstable();
    folders.dedup();
    folders.into_iter().for_each(sync_folder);
    Ok(())
}

/// Puts back what was at `place` before. When even that fails, the backup stays beside its place.
fn restore(place: &Path, backup: Option<TempPath>) {
    match backup {
        Some(backup) => {
            if let Err(failed) = backup.persist(place) {
                drop(failed.path.keep());
            }
        }
        None => drop(fs::remove_file(place)),
    }
}

/// Brings the names in a folder to the disk, where the system can do so; the files are written
/// whether or not.
fn sync_folder(folder: &Path) {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    if cfg!(unix) {
        drop(File::open(folder).and_then(|folder| folder.sync_all()));
    }
}

/// The folder of a file that is to be written.
fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Makes something beside `path` under a name that nothing has; it is removed when dropped.
fn beside<T>(
    path: &Path,
    make: impl FnMut(&Path) -> std::io::Result<T>,
) -> std::io::Result<NamedTempFile<T>> {
    let mut names = tempfile::Builder::new();
    names.prefix(".kerfold-").suffix(".tmp").rand_bytes(RANDOM_LETTERS);
    names.make_in(folder_of(path), make)
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
    fn back_up(&self) -> Result<Option<TempPath>, IoError> {
        if self.existing.is_none() {
            return Ok(None);
        }
        let backup = beside(&self.path, |backup| match fs::hard_link(&self.path, backup) {
            Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                fs::copy(&self.path, backup).map(drop)
            }
            linked => linked,
        });
        let backup = backup.map_err(|source| unwritable(&self.path, source))?;
        Ok(Some(backup.into_temp_path()))
    }
}

/// A file that is written, but not yet in its place.
struct Staged {
    temporary: TempPath,
    target: Target,
}

impl Staged {
    fn write(target: Target, bytes: &[u8]) -> Result<Self, IoError> {
        match Self::written(&target, bytes) {
            Ok(temporary) => Ok(Self { temporary, target }),
            Err(source) => Err(unwritable(&target.path, source)),
        }
    }

    fn written(target: &Target, bytes: &[u8]) -> std::io::Result<TempPath> {
        // Made as any program makes files, so that new ones have the permissions that the user
        // wants for them.
        let mut file = beside(&target.path, |path| File::create_new(path))?;
        file.as_file_mut().write_all(bytes)?;
        if let Some(there) = &target.existing {
            file.as_file().set_permissions(there.permissions())?;
        }
        file.as_file().sync_all()?;
        Ok(file.into_temp_path())
    }

    fn publish(self) -> Result<(), IoError> {
        self.temporary
            .persist(&self.target.path)
            .map_err(|failed| unwritable(&self.target.path, failed.error))
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
