//! The recipes that come with the program, and the meshes that they read.

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
