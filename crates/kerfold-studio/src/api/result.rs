//! Pieces, sheets, the report, and how the pieces close.

use std::collections::BTreeMap;
use std::sync::Arc;

use axum::http::header::CONTENT_TYPE;
use axum::response::{IntoResponse, Json as Answer, Response};
use glam::DVec3;
use kerfold::bloom::{Bloom, END};
use kerfold::geom::triangulate;
use kerfold::io::panels_json::panels_json;
use kerfold::io::pieces_json::write_pieces_json;
use kerfold::io::report::json::check_json;
use kerfold::io::sheet::files::sheet_bytes;
use kerfold::io::sheet::layout::write_layout_json;
use kerfold::make::{Fabrication, MakeError, flat_places};
use kerfold::mesh::FaceId;
use kerfold::recipe::Job;
use kerfold::sheet::{SheetFormat, SheetParams};
use serde::{Deserialize, Serialize};
use serde_json::value::{RawValue, to_raw_value};
use serde_json::{Value, json};

use super::model::binary;
use super::outputs::{Named, command};
use super::request::{Asked, At};
use crate::StudioError;
use crate::encode::bloom_bytes;
use crate::tab::{Lane, work};

type Result<T> = std::result::Result<T, StudioError>;

/// Pieces and sheets of a job, be they of a net or of panels.
fn made(job: &Job) -> Option<(&Fabrication, &SheetParams)> {
    let of_net = job.fabrication.as_ref().map(|(made, sheet)| (made, sheet));
    of_net.or_else(|| job.panelled.as_ref().map(|(made, sheet)| (&made.fabrication, sheet)))
}

/// An answer by its keys. What is text already is not read in order to be written again: pieces take
/// megabytes.
type Told = BTreeMap<&'static str, Box<RawValue>>;

fn raw(text: String) -> Option<Box<RawValue>> {
    RawValue::from_string(text).ok()
}

fn put(told: &mut Told, key: &'static str, value: &impl Serialize) {
    told.extend(to_raw_value(value).ok().map(|value| (key, value)));
}

pub(crate) async fn result(at: At, Asked(named): Asked<Named>) -> Result<Answer<Told>> {
    let command = command(&at.tab, &named);
    let told = work(&at.tab, Lane::Result, move |tab, progress| {
        // The report does not wait for pieces, and is there when they cannot be made.
        let (bare, mut failed) = answered(tab.run(None, false, progress))?;
        let report = match &bare {
            Some(job) if job.has_mesh() => Some(check_json(&job.report()?, &command)),
            _ => None,
        };
        let mut job = bare;
        if job.is_some() {
            let (whole, error) = answered(tab.run(None, true, progress))?;
            (job, failed) = (whole.or(job), error);
        }
        let mut told = job.map_or_else(Told::new, |job| told(&job, &command));
        put(&mut told, "revision", &tab.revision());
        put(&mut told, "command", &command);
        put(&mut told, "report", &report.and_then(raw));
        put(&mut told, "failure", &failed);
        put(&mut told, "closing_seconds", &END);
        Ok(told)
    })
    .await?;
    Ok(Answer(told))
}

/// A job or why there is none; work that was stopped has no answer.
fn answered(job: Result<Arc<Job>>) -> Result<(Option<Arc<Job>>, Option<Value>)> {
    match job {
        Ok(job) => Ok((Some(job), None)),
        Err(error) if error.is_stopped() => Err(error),
        Err(error) => Ok((None, Some(failure(&error)))),
    }
}

/// What a job has made.
fn told(job: &Job, command: &str) -> Told {
    let unclean: Vec<String> = job.with_findings.iter().map(ToString::to_string).collect();
    let made = made(job);
    let panels = job.panelled.as_ref().map(|(p, _)| {
        let layout = &p.fabrication.sheets.layout;
        raw(panels_json(&p.schedule, &p.plates, layout, &p.findings, command))
    });
    let pieces = made.and_then(|(m, _)| raw(write_pieces_json(&m.net, command)));
    let layout = made.and_then(|(m, _)| raw(write_layout_json(&m.sheets.layout, command)));
    let mut told = Told::new();
    put(&mut told, "notes", &job.notes);
    put(&mut told, "unclean", &unclean);
    put(&mut told, "verdict_counts", &job.is_check_asked);
    put(&mut told, "pieces", &pieces);
    put(&mut told, "layout", &layout);
    put(&mut told, "seconds", &made.and_then(|(m, sheet)| m.sheets.seconds(sheet)));
    put(&mut told, "panels", &panels.flatten());
    told
}

fn failure(error: &StudioError) -> Value {
    use kerfold::code::Coded;
    json!({ "code": error.code().to_string(), "message": error.to_string() })
}

/// A sheet as it will be written, as SVG.
pub(crate) async fn sheet(at: At, Asked(named): Asked<Named>) -> Result<Response> {
    let (number, command) = (at.number()?, command(&at.tab, &named));
    let svg = work(&at.tab, Lane::Result, move |tab, progress| {
        let job = tab.run(None, true, progress)?;
        let (made, params) = made(&job).ok_or(StudioError::NotMade { what: "sheets" })?;
        let drawing = number.checked_sub(1).and_then(|i| made.sheets.drawings.get(i));
        let drawing = drawing.ok_or(StudioError::NotMade { what: "sheet of this number" })?;
        Ok(sheet_bytes(drawing, SheetFormat::Svg, params, &command))
    })
    .await?;
    Ok(([(CONTENT_TYPE, "image/svg+xml")], svg).into_response())
}

#[derive(Deserialize)]
pub(crate) struct Moment {
    /// From 0, flat, to `closing_seconds`, closed.
    seconds: f64,
}

/// The pieces on their way from the sheets to the closed model.
pub(crate) async fn bloom(at: At, Asked(moment): Asked<Moment>) -> Result<Response> {
    let bytes = work(&at.tab, Lane::Model, move |tab, progress| {
        let job = tab.run(None, true, progress)?;
        let (made, _) = made(&job).ok_or(StudioError::NotMade { what: "pieces" })?;
        let mesh = job.mesh().map_err(|_| MakeError::NoMesh)?;
        // Panels are plates, not faces of a net that closes.
        if job.panelled.is_some() {
            return Err(StudioError::NotMade { what: "pieces that fold" });
        }
        let corners = |face: usize| Some(mesh.face_positions(FaceId::new(face)));
        let places = flat_places(&made.sheets.layout);
        let bloom = Bloom::new(&made.net, &places, corners);
        let (low, high) = mesh.bounds().unwrap_or_default();
        let middle = low.midpoint(high);
        let poses = bloom.at(moment.seconds);
        let faces = bloom.tree().leaves().iter().zip(poses).map(|(leaf, pose)| {
            let flat = bloom.tree().flat(leaf);
            let corners: Vec<DVec3> = flat.polygon.iter().map(|&p| pose.lift(p) - middle).collect();
            (flat.face, corners, triangulate(&flat.polygon))
        });
        Ok(bloom_bytes(faces))
    })
    .await?;
    Ok(binary(bytes))
}
