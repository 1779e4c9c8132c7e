//! The recipes that come with the program, and the meshes and outlines that they read.

use std::path::{Path, PathBuf};

use crate::io::IoError;
use crate::io::output::TemporaryFolder;

/// Path below the folder of the fixtures, with `/`, and contents; sorted within each folder. Made
/// by `build.rs`.
const BUNDLE: &[(&str, &str)] = include!(concat!(env!("OUT_DIR"), "/bundle.rs"));

/// A file that comes with the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BundledFile {
    /// Its path, such as `recipes/gallery/gonen-fig-05-global-cut.toml`; recipes name their meshes
    /// relative to it.
    pub path: &'static str,
    /// Its contents.
    pub text: &'static str,
}

/// All files, recipes before meshes.
pub fn bundled() -> impl Iterator<Item = BundledFile> {
    BUNDLE.iter().map(|&(path, text)| BundledFile { path, text })
}

/// The bundled recipe of a name (`two-piece-d-form`, with or without `.toml`), where there is no file
/// of that name.
pub fn bundled_recipe(name: &Path) -> Option<BundledFile> {
    if name.exists() {
        return None;
    }
    let wanted = name.to_str().filter(|name| !name.contains(['/', '\\']))?;
    let wanted = format!("/{}.toml", wanted.strip_suffix(".toml").unwrap_or(wanted));
    bundled().find(|file| file.path.starts_with("recipes/") && file.path.ends_with(&wanted))
}

/// All bundled files in a folder that goes again, and the folder of one of them: recipes read their
/// meshes from beside them.
///
/// # Errors
/// [`IoError::Unwritable`].
pub fn unpacked(recipe: BundledFile) -> Result<(TemporaryFolder, PathBuf), IoError> {
    let folder = TemporaryFolder::new()?;
    for file in bundled() {
        let path = folder.path().join(file.path);
        let parent = path.parent().unwrap_or(folder.path());
        std::fs::create_dir_all(parent)
            .and_then(|()| std::fs::write(&path, file.text))
            .map_err(|source| IoError::Unwritable { path: path.clone(), source })?;
    }
    let own = folder.path().join(recipe.path);
    let own = own.parent().unwrap_or(folder.path()).to_owned();
    Ok((folder, own))
}
