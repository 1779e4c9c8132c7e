//! What leaves the studio: the recipe, and all files that `kerfold run` would write.

use std::sync::Arc;

use axum::extract::State;
use axum::http::header::{CONTENT_DISPOSITION, CONTENT_TYPE};
use axum::response::{IntoResponse, Json as Answer, Response};
use kerfold::io::output::{OutputFolder, write_file};
use kerfold::make::Output;
use kerfold::progress::Progress;
use kerfold::recipe::job_outputs;
use serde::Deserialize;
use serde_json::{Value, json};

use super::recipe::tell;
use super::request::{Asked, At, Json};
use crate::tab::{Lane, Tab, work};
use crate::{Studio, StudioError, paths, zip::zip};

type Result<T = Answer<Value>> = std::result::Result<T, StudioError>;

/// Under which names recipe and results are written.
#[derive(Deserialize, Default)]
pub(crate) struct Named {
    /// The recipe; that of the tab where it is left out, else `recipe.toml`.
    file: Option<String>,
    /// The folder of the results; `out` where it is left out.
    folder: Option<String>,
    /// Whether another file of the recipe's name may go.
    #[serde(default)]
    replace: bool,
}

impl Named {
    fn file(&self, tab: &Tab) -> String {
        self.file.clone().or_else(|| tab.file()).unwrap_or_else(|| "recipe.toml".to_owned())
    }

    fn folder(&self) -> &str {
        self.folder.as_deref().unwrap_or("out")
    }
}

/// The command line that writes the same files: they all carry it.
pub(super) fn command(tab: &Tab, named: &Named) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,=:+@%".contains(c);
    let quoted = |text: &str| match !text.is_empty() && text.chars().all(plain) {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', r"'\''")),
    };
    format!("kerfold run {} -o {}", quoted(&named.file(tab)), quoted(named.folder()))
}

/// Writes the recipe.
pub(crate) async fn save(
    State(studio): State<Arc<Studio>>,
    at: At,
    Json(named): Json<Named>,
) -> Result {
    save_recipe(&studio, &at.tab, &named)?;
    Ok(tell(&at.tab))
}

fn save_recipe(studio: &Studio, tab: &Tab, named: &Named) -> Result<String> {
    let file = named.file(tab);
    let path = paths::inside(studio.root(), &file)?;
    let is_plain = !file.contains('/') && !file.starts_with('.') && file.ends_with(".toml");
    if !is_plain {
        let message =
            "a recipe is named something.toml and lies in the folder of the studio".into();
        return Err(StudioError::File { file, message });
    }
    let text = tab.session().recipe().text();
    let before = std::fs::read(&path).ok();
    let is_own = tab.file().as_deref() == Some(file.as_str());
    let is_other = before.as_deref().is_some_and(|bytes| bytes != text.as_bytes());
    if is_other && !is_own && !named.replace {
        return Err(StudioError::Exists { file });
    }
    write_file(&path, text.as_bytes())?;
    tab.set_file(Some(file.clone()));
    Ok(file)
}

fn outputs(tab: &Tab, command: &str, progress: &dyn Progress) -> Result<Vec<Output>> {
    let job = tab.run(None, false, progress)?;
    Ok(job_outputs(&job, command)?)
}

/// Writes the recipe and all that it makes into a folder.
pub(crate) async fn export(
    State(studio): State<Arc<Studio>>,
    at: At,
    Json(named): Json<Named>,
) -> Result {
    let folder = paths::inside(studio.root(), named.folder())?;
    let file = save_recipe(&studio, &at.tab, &named)?;
    let command = command(&at.tab, &named);
    let written = work(&at.tab, Lane::Export, {
        let command = command.clone();
        move |tab, progress| {
            let mut files = OutputFolder::new(&folder);
            for (name, bytes) in outputs(tab, &command, progress)? {
                paths::inside(studio.root(), &format!("{}/{name}", named.folder()))?;
                files.add(name, bytes);
            }
            let names: Vec<String> = files.names().map(str::to_owned).collect();
            files.commit()?;
            Ok(names)
        }
    })
    .await?;
    Ok(Answer(json!({ "recipe": file, "written": written, "command": command })))
}

/// The same as an archive.
pub(crate) async fn archive(at: At, Asked(named): Asked<Named>) -> Result<Response> {
    let (file, command) = (named.file(&at.tab), command(&at.tab, &named));
    let bytes = work(&at.tab, Lane::Export, move |tab, progress| {
        let mut files = vec![(file, tab.session().recipe().text().into_bytes())];
        let outputs = outputs(tab, &command, progress)?;
        let folder = named.folder().trim_matches('/').to_owned();
        files.extend(outputs.into_iter().map(|(name, bytes)| (format!("{folder}/{name}"), bytes)));
        zip(&files).ok_or(StudioError::TooLarge { limit: u32::MAX as usize })
    })
    .await?;
    let headers = [
        (CONTENT_TYPE, "application/zip"),
        (CONTENT_DISPOSITION, "attachment; filename=\"kerfold.zip\""),
    ];
    Ok((headers, bytes).into_response())
}
