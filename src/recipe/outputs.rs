//! What a job leaves in its folder, as names and bytes; nothing is written here.

use super::Job;
use crate::check::details;
use crate::io::report::html::check_html;
use crate::io::report::json::check_json;
use crate::io::report::page::{ReportPage, ReportRows};
use crate::io::{MeshFormat, WriteOptions, mesh_bytes};
use crate::make::{
    MakeError, Output, fabrication_outputs, panel_outputs, report_pictures, sheet_picture,
    show_outputs,
};
use crate::picture::render_model;

/// The files of a whole recipe: model, picture, report, the steps of a hull where asked for, and if
/// it was unfolded pieces, layout, sheets and their pictures.
///
/// # Errors
/// [`MakeError`] when the model cannot be written, checked or drawn.
pub fn job_outputs(job: &Job, command: &str) -> Result<Vec<Output>, MakeError> {
    let mut outputs = Vec::new();
    // A recipe that only nests pieces has no model.
    if job.has_mesh() || job.fabrication.is_none() {
        let mesh = job.mesh()?;
        let options = WriteOptions { command: Some(command.to_owned()), ..WriteOptions::default() };
        outputs.push(("model.obj".to_owned(), mesh_bytes(MeshFormat::Obj, mesh, &options)?));
        outputs.push(("model.png".to_owned(), render_model(mesh, &job.render)?.to_png()));
        outputs.push(("report.json".to_owned(), check_json(&job.report()?, command).into_bytes()));
        if job.is_check_asked {
            outputs.push(("report.html".to_owned(), report_page(job, command)?.into_bytes()));
        }
    }
    for step in &job.hull_steps {
        outputs.push((step.file_name("model"), render_model(&step.mesh, &job.render)?.to_png()));
    }
    if let Some((panelled, sheet)) = &job.panelled {
        outputs.extend(panel_outputs(panelled, sheet, command)?);
    }
    if let Some((fabrication, sheet)) = &job.fabrication {
        outputs.extend(fabrication_outputs(fabrication, sheet, command)?);
    }
    let made = job
        .fabrication
        .as_ref()
        .map(|(f, _)| f)
        .or(job.panelled.as_ref().map(|(p, _)| &p.fabrication));
    if let Some(fabrication) = made {
        for drawing in &fabrication.sheets.drawings {
            let picture = sheet_picture(drawing, job.render.width)?;
            outputs.push((format!("{}.png", drawing.file_stem()), picture));
        }
    }
    if let Some(((fabrication, _), mesh)) = job.fabrication.as_ref().zip(job.mesh().ok()) {
        outputs.extend(show_outputs(fabrication, mesh, &job.show, &job.render, command)?);
    }
    Ok(outputs)
}

/// The page of the report, with the pictures seen as the recipe says.
fn report_page(job: &Job, command: &str) -> Result<String, MakeError> {
    let (mesh, report) = (job.mesh()?, job.report()?);
    let pictures = report_pictures(mesh, &report, &job.render)?;
    let (title, rows, details) = ("model", ReportRows::Worst, details(mesh));
    Ok(check_html(&ReportPage {
        title,
        report: &report,
        details: &details,
        pictures: &pictures,
        rows,
        command,
    }))
}
