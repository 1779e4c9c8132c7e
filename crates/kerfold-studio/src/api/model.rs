//! The model: as it is after a step, as it would be, and what of it is marked.

use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Json as Answer, Response};
use kerfold::mesh::{EdgeId, Mesh};
use kerfold::progress::Progress;
use kerfold::recipe::{Session, StepDraft, Value as StepValue};
use kerfold::seam::{SeamError, fold_sum, hamiltonian_folds, least_matching, piece_count, table};
use kerfold::select::{Context, ElementKind, Likeness, Selection, alike};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use super::request::{Asked, At, Json};
use crate::tab::{Lane, Tab, work};
use crate::{StudioError, mesh_bytes};

type Result<T> = std::result::Result<T, StudioError>;

#[derive(Deserialize)]
pub(crate) struct Steps {
    /// After how many steps; all where it is left out.
    steps: Option<usize>,
}

pub(super) fn binary(bytes: Vec<u8>) -> Response {
    ([(CONTENT_TYPE, "application/octet-stream")], bytes).into_response()
}

fn told(value: Value) -> Map<String, Value> {
    match value {
        Value::Object(map) => map,
        _ => Map::new(),
    }
}

pub(crate) async fn model(at: At, Asked(asked): Asked<Steps>) -> Result<Response> {
    let bytes = work(&at.tab, Lane::Model, move |tab, progress| {
        let job = tab.run(asked.steps, false, progress)?;
        let unclean: Vec<String> = job.with_findings.iter().map(ToString::to_string).collect();
        let told = told(json!({
            "revision": tab.revision(), "notes": job.notes, "unclean": unclean,
        }));
        if !job.has_mesh() {
            return Err(StudioError::NotMade { what: "model" });
        }
        Ok(mesh_bytes(job.mesh()?, job.made(), told))
    })
    .await?;
    Ok(binary(bytes))
}

#[derive(Deserialize)]
pub(crate) struct Preview {
    /// After how many steps the step would come; all where it is left out.
    steps: Option<usize>,
    step: StepDraft,
}

pub(crate) async fn preview(at: At, Json(asked): Json<Preview>) -> Result<Response> {
    let bytes = work(&at.tab, Lane::Model, move |tab, progress| {
        let replay = {
            let mut session = tab.session();
            let steps = asked.steps.unwrap_or(session.step_count());
            check(&session, &asked.step)?;
            session.replay(steps)?
        };
        let (reached, preview) = replay.preview(asked.step, progress);
        tab.session().keep(&reached);
        let preview = preview?;
        let cut = preview.cut.as_ref().map(|cut| {
            json!({
                "overcut": cut.overcut, "cuts": cut.cuts, "missed": cut.missed, "lids": cut.lids,
            })
        });
        let told = told(json!({
            "revision": tab.revision(), "notes": preview.notes, "is_clean": preview.is_clean,
            "cut": cut,
        }));
        Ok(mesh_bytes(&preview.mesh, preview.made.as_ref(), told))
    })
    .await?;
    Ok(binary(bytes))
}

fn check(session: &Session, step: &StepDraft) -> Result<()> {
    crate::paths::check_step(session.folder(), step, &session.recipe().parameters)
}

#[derive(Deserialize)]
pub(crate) struct Limit {
    steps: Option<usize>,
    step: StepDraft,
    /// The key that is a number, or a quantity in the unit.
    key: String,
    /// Such as `mm`; for plain numbers nothing.
    unit: Option<String>,
    /// The least and the largest value to look at.
    from: f64,
    to: f64,
}

/// Halvings of the range: a sixteen thousandth of it is finer than a slider.
const HALVINGS: usize = 14;

/// The largest value of a key at which no cuts meet.
pub(crate) async fn limit(at: At, Json(asked): Json<Limit>) -> Result<Answer<Value>> {
    let value = work(&at.tab, Lane::Limit, move |tab, progress| {
        let replay = {
            let mut session = tab.session();
            let steps = asked.steps.unwrap_or(session.step_count());
            check(&session, &asked.step)?;
            session.replay(steps)?
        };
        let meets = |value: f64| -> Result<bool> {
            let mut step = asked.step.clone();
            let value = match &asked.unit {
                Some(unit) => StepValue::from(format!("{value}{unit}")),
                None => StepValue::from(value),
            };
            step.set(&asked.key, Some(value));
            let (reached, preview) = replay.preview(step, progress);
            tab.session().keep(&reached);
            if progress.is_cancelled() {
                return Err(StudioError::Superseded);
            }
            // What cannot be cut at all meets.
            Ok(preview.map_or(true, |p| p.cut.is_none_or(|cut| !cut.overcut.is_empty())))
        };
        let (mut low, mut high) = (asked.from, asked.to);
        if !meets(high)? {
            return Ok(Some(high));
        }
        let mut found = None;
        for _ in 0..HALVINGS {
            let middle = low.midpoint(high);
            if meets(middle)? {
                high = middle;
            } else {
                (low, found) = (middle, Some(middle));
            }
        }
        Ok(found)
    })
    .await?;
    Ok(Answer(json!({ "value": value })))
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Kind {
    Vertex,
    Edge,
    Face,
}

#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum How {
    Direction,
    Loop,
    Strip,
    Symmetric,
}

#[derive(Deserialize)]
pub(crate) struct Mark {
    steps: Option<usize>,
    kind: Kind,
    /// A text in the selection language, or …
    selection: Option<String>,
    /// … an element and what is like it.
    id: Option<usize>,
    how: Option<How>,
}

/// What a selection means, or what is like an element, as text and as ids.
pub(crate) async fn mark(at: At, Json(asked): Json<Mark>) -> Result<Answer<Value>> {
    let marked = work(&at.tab, Lane::Limit, move |tab, progress| marked(tab, &asked, progress));
    Ok(Answer(marked.await?))
}

fn marked(tab: &Tab, asked: &Mark, progress: &dyn Progress) -> Result<Value> {
    let job = tab.run(asked.steps, false, progress)?;
    let mesh = job.mesh()?;
    let kind = match asked.kind {
        Kind::Vertex => ElementKind::Vertex,
        Kind::Edge => ElementKind::Edge,
        Kind::Face => ElementKind::Face,
    };
    let likeness = match asked.how {
        Some(How::Loop) => Likeness::Loop,
        Some(How::Strip) => Likeness::Strip,
        Some(How::Symmetric) => Likeness::Symmetric,
        Some(How::Direction) | None => Likeness::Direction,
    };
    let selection: Selection = match (&asked.selection, asked.id) {
        (Some(text), _) => text.parse()?,
        (None, Some(id)) => alike(mesh, kind, id, likeness).ok_or_else(|| {
            StudioError::BadRequest { message: format!("there is no {kind} {id}") }
        })?,
        (None, None) => {
            let message = "send a selection, or the id of an element".to_owned();
            return Err(StudioError::BadRequest { message });
        }
    };
    let context = Context { mesh, made: job.made(), progress };
    let ids: Vec<usize> = match kind {
        ElementKind::Vertex => {
            selection.vertices(&context)?.into_iter().map(|v| v.index()).collect()
        }
        ElementKind::Edge => selection.edges(&context)?.into_iter().map(|e| e.index()).collect(),
        ElementKind::Face => selection.faces(&context)?.into_iter().map(|f| f.index()).collect(),
    };
    Ok(json!({ "selection": selection.to_string(), "ids": ids }))
}

/// Choices of folds that are looked at before only the best two are listed, symmetric ones counted.
const MOST_MATCHINGS: usize = 20_000;

/// The ways to divide the model by closed seams.
pub(crate) async fn seams(at: At, Asked(asked): Asked<Steps>) -> Result<Answer<Value>> {
    let told = work(&at.tab, Lane::Limit, move |tab, progress| {
        let job = tab.run(asked.steps, false, progress)?;
        let mesh = job.mesh()?;
        let (rows, note) = rows(mesh, progress)?;
        Ok(json!({ "rows": rows, "note": note }))
    })
    .await?;
    Ok(Answer(told))
}

fn rows(mesh: &Mesh, progress: &dyn Progress) -> Result<(Vec<Value>, Option<String>)> {
    let row = |matching: Value, selection: String, folds: &[EdgeId], orbit: Option<usize>| {
        let ids: Vec<usize> = folds.iter().map(|e| e.index()).collect();
        json!({
            "matching": matching, "selection": selection, "folds": ids, "orbit": orbit,
            "pieces": piece_count(mesh, folds), "fold_sum": fold_sum(mesh, folds),
        })
    };
    let too_many = match table(mesh, MOST_MATCHINGS, progress) {
        Ok(rows) => {
            let one = |r: &kerfold::seam::MatchingRow| {
                row(json!(r.index), format!("matching:{}", r.index), &r.folds, Some(r.orbit_size))
            };
            return Ok((rows.iter().map(one).collect(), None));
        }
        Err(error @ SeamError::TooMany { .. }) => error,
        Err(error) => return Err(error.into()),
    };
    let least = least_matching(mesh, progress)?;
    let mut rows = vec![row(json!("least"), "matching".to_owned(), &least, None)];
    if let Ok(folds) = hamiltonian_folds(mesh, progress) {
        rows.insert(0, row(json!("hamiltonian"), "hamiltonian".to_owned(), &folds, None));
    }
    Ok((rows, Some(too_many.to_string())))
}
