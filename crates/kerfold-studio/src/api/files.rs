//! Files of the studio's folder.

use std::path::Path;
use std::sync::Arc;
use std::time::SystemTime;

use axum::extract::{Path as Named, Request, State};
use axum::response::Json as Answer;
use kerfold::io::output::write_file;
use serde_json::{Value, json};

use super::request::{FILE_LIMIT, body, length};
use crate::{Studio, StudioError, paths};

/// Endings of files that the studio takes and lists.
const KNOWN: [&str; 10] = ["toml", "obj", "ply", "stl", "off", "glb", "3mf", "csv", "svg", "dxf"];
/// Files that are listed at most.
const MOST: usize = 500;

/// Recipes and meshes of the folder, those written last first.
pub(crate) async fn list(State(studio): State<Arc<Studio>>) -> Answer<Value> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(studio.root()).into_iter().flatten().flatten() {
        let (path, name) = (entry.path(), entry.file_name().to_string_lossy().into_owned());
        if is_known(&path) && path.is_file() && paths::inside(studio.root(), &name).is_ok() {
            let written = entry.metadata().and_then(|data| data.modified());
            found.push((written.unwrap_or(SystemTime::UNIX_EPOCH), name));
        }
    }
    found.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.cmp(&b.1)));
    let names: Vec<String> = found.into_iter().take(MOST).map(|(_, name)| name).collect();
    let folder = studio.root().file_name().map(|name| name.to_string_lossy().into_owned());
    Answer(json!({ "folder": folder, "files": names }))
}

fn is_known(path: &Path) -> bool {
    let ending = path.extension().and_then(|e| e.to_str()).map(str::to_lowercase);
    ending.is_some_and(|ending| KNOWN.contains(&ending.as_str()))
}

/// A file that was dropped on the page; another one of its name is not lost.
pub(crate) async fn upload(
    State(studio): State<Arc<Studio>>,
    Named(name): Named<String>,
    request: Request,
) -> Result<Answer<Value>, StudioError> {
    let path = paths::inside(studio.root(), &name)?;
    if !is_known(&path) || name.starts_with('.') || name.contains('/') {
        let message =
            format!("the studio takes files that end in {}, without a folder", KNOWN.join(", "));
        return Err(StudioError::File { file: name, message });
    }
    let bytes = body(length(&request), request.into_body(), FILE_LIMIT).await?;
    match std::fs::read(&path) {
        Ok(before) if before == bytes => {}
        Ok(_) => return Err(StudioError::Exists { file: name }),
        Err(_) => write_file(&path, &bytes)?,
    }
    Ok(Answer(json!({ "file": name })))
}
