//! Lists the bundled recipes and the meshes and outlines that they read, so that the installed
//! program carries them.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

const FOLDERS: [(&str, &str); 4] = [
    ("fixtures/recipes", "toml"),
    ("fixtures/recipes/gallery", "toml"),
    ("fixtures/meshes", "obj"),
    ("fixtures/outlines", "svg"),
];

fn main() -> io::Result<()> {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").ok_or(io::ErrorKind::NotFound)?);
    let mut table = String::from("&[\n");
    for (folder, extension) in FOLDERS {
        println!("cargo::rerun-if-changed={folder}");
        for path in files(&root.join(folder), extension)? {
            let name = path.strip_prefix(root.join("fixtures")).map_err(io::Error::other)?;
            let name = name
                .components()
                .map(|c| c.as_os_str().to_string_lossy())
                .collect::<Vec<_>>()
                .join("/");
            writeln!(table, "    ({name:?}, include_str!({:?})),", path.display().to_string())
                .map_err(io::Error::other)?;
        }
    }
    table += "]\n";
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or(io::ErrorKind::NotFound)?);
    fs::write(out.join("bundle.rs"), table)
}

/// The files of a folder with an extension, by name.
fn files(folder: &Path, extension: &str) -> io::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.extension().is_some_and(|e| e == extension) {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}
