//! The recipe of a tab: its steps, its history, its text.

use std::convert::Infallible;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};

use axum::extract::State;
use axum::http::header::CONTENT_TYPE;
use axum::response::sse::{Event, KeepAlive, Sse};
use axum::response::{IntoResponse, Json as Answer, Response};
use futures_core::Stream;
use kerfold::recipe::{StepDraft, Value as StepValue};
use serde::{Deserialize, Deserializer};
use serde_json::{Value, json};
use tokio::sync::mpsc;

use super::request::{At, Json};
use crate::tab::Tab;
use crate::{Studio, StudioError, paths};

type Result<T = Answer<Value>> = std::result::Result<T, StudioError>;

/// All kinds of steps.
pub(crate) async fn schema() -> Answer<Value> {
    Answer(crate::json_schema())
}

#[derive(Deserialize)]
pub(crate) struct OpenTab {
    resume: Option<String>,
}

pub(crate) async fn open_tab(
    State(studio): State<Arc<Studio>>,
    Json(asked): Json<OpenTab>,
) -> Result {
    let tab = studio.open_tab(asked.resume.as_deref())?;
    Ok(tell(&tab))
}

/// The recipe as the page shows it.
pub(crate) fn tell(tab: &Tab) -> Answer<Value> {
    let session = tab.session();
    let recipe = session.recipe();
    let [undo, redo] = session.can_undo_redo();
    Answer(json!({
        "tab": tab.id, "revision": tab.revision(), "file": tab.file(), "name": recipe.name,
        "steps": recipe.steps, "text": recipe.text(), "undo": undo, "redo": redo,
    }))
}

pub(crate) async fn state(at: At) -> Answer<Value> {
    tell(&at.tab)
}

pub(crate) async fn text(at: At) -> Response {
    let text = at.tab.session().recipe().text();
    ([(CONTENT_TYPE, "text/plain; charset=utf-8")], text).into_response()
}

#[derive(Deserialize)]
pub(crate) struct OpenRecipe {
    /// The text of a recipe, or …
    text: Option<String>,
    /// … a recipe or mesh of the folder.
    file: Option<String>,
}

pub(crate) async fn open(
    State(studio): State<Arc<Studio>>,
    at: At,
    Json(asked): Json<OpenRecipe>,
) -> Result {
    match (asked.text, asked.file) {
        (Some(text), None) => {
            studio.open_text(&at.tab, &text)?;
            at.tab.set_file(None);
        }
        (None, Some(file)) => studio.open_file(&at.tab, &file)?,
        _ => {
            let message = "name a file or send a text, one of the two".to_owned();
            return Err(StudioError::BadRequest { message });
        }
    }
    Ok(changed(&at.tab))
}

fn changed(tab: &Arc<Tab>) -> Answer<Value> {
    tab.changed();
    tell(tab)
}

#[derive(Deserialize)]
pub(crate) struct Rename {
    name: Option<String>,
}

pub(crate) async fn rename(at: At, Json(asked): Json<Rename>) -> Result {
    at.tab.session().rename(asked.name.filter(|name| !name.trim().is_empty()));
    Ok(changed(&at.tab))
}

#[derive(Deserialize)]
pub(crate) struct Apply {
    step: StepDraft,
    at: Option<usize>,
}

pub(crate) async fn apply(
    State(studio): State<Arc<Studio>>,
    at: At,
    Json(asked): Json<Apply>,
) -> Result {
    let mut session = at.tab.session();
    paths::check_step(studio.root(), &asked.step, &session.recipe().parameters)?;
    session.apply(asked.step, asked.at)?;
    drop(session);
    Ok(changed(&at.tab))
}

#[derive(Deserialize)]
pub(crate) struct Set {
    key: String,
    /// The value; `null` takes the key away.
    #[serde(deserialize_with = "some_or_null")]
    value: Option<StepValue>,
    /// The same number for all values of one drag.
    gesture: Option<u64>,
}

/// `null` is a value that must be said.
fn some_or_null<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> std::result::Result<Option<StepValue>, D::Error> {
    Option::deserialize(deserializer)
}

pub(crate) async fn set(
    State(studio): State<Arc<Studio>>,
    at: At,
    Json(asked): Json<Set>,
) -> Result {
    let (number, mut session) = (at.number()?, at.tab.session());
    let recipe = session.recipe();
    // A step that does not exist is refused by the session, with its number.
    if let Some(step) = number.checked_sub(1).and_then(|i| recipe.steps.get(i)) {
        let mut step = step.clone();
        step.set(&asked.key, asked.value.clone());
        paths::check_step(studio.root(), &step, &recipe.parameters)?;
    }
    session.set(number, &asked.key, asked.value, asked.gesture)?;
    drop(session);
    Ok(changed(&at.tab))
}

pub(crate) async fn remove(at: At) -> Result {
    at.tab.session().remove(at.number()?)?;
    Ok(changed(&at.tab))
}

pub(crate) async fn undo(at: At) -> Answer<Value> {
    at.tab.session().undo();
    changed(&at.tab)
}

pub(crate) async fn redo(at: At) -> Answer<Value> {
    at.tab.session().redo();
    changed(&at.tab)
}

/// Stops all work of the tab.
pub(crate) async fn stop(at: At) -> Answer<Value> {
    at.tab.stop_all();
    tell(&at.tab)
}

/// What work is going on, as it goes.
pub(crate) async fn events(
    at: At,
) -> Sse<impl Stream<Item = std::result::Result<Event, Infallible>>> {
    let mut told = at.tab.events();
    let (send, receive) = mpsc::channel(16);
    tokio::spawn(async move {
        use tokio::sync::broadcast::error::RecvError;
        loop {
            match told.recv().await {
                Ok(event) => {
                    if send.send(event).await.is_err() {
                        break;
                    }
                }
                // Who is late has missed what is old by now.
                Err(RecvError::Lagged(_)) => {}
                Err(RecvError::Closed) => break,
            }
        }
    });
    Sse::new(Events(receive)).keep_alive(KeepAlive::default())
}

struct Events(mpsc::Receiver<String>);

impl Stream for Events {
    type Item = std::result::Result<Event, Infallible>;

    fn poll_next(mut self: Pin<&mut Self>, context: &mut Context<'_>) -> Poll<Option<Self::Item>> {
        let next = self.0.poll_recv(context);
        next.map(|event| event.map(|text| Ok(Event::default().data(text))))
    }
}
