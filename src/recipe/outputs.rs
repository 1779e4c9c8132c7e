//! What a job leaves in its folder, as names and bytes; nothing is written here.

use super::story::frames;
use super::{Before, Job};
use crate::check::details;
use crate::io::report::html::check_html;
use crate::io::report::json::check_json;
use crate::io::report::page::{ReportPage, ReportRows};
use crate::io::{MeshFormat, WriteOptions, mesh_bytes};
use crate::make::{
    MakeError, Output, fabrication_outputs, in_pieces, panel_outputs, report_pictures,
    show_outputs, worst_in_red, x_ray,
};
use crate::mesh::Mesh;
use crate::op::OpContext;
use crate::picture::{Colour, render_model, render_story, render_with};
use crate::progress::Silent;

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
        let options = WriteOptions {
            command: Some(command.to_owned()),
            made: job.made().cloned(),
            ..WriteOptions::default()
        };
        outputs.push(("model.obj".to_owned(), mesh_bytes(MeshFormat::Obj, mesh, &options)?));
        outputs.extend(pictures(job, mesh)?);
        outputs.push(("report.json".to_owned(), check_json(&job.report()?, command).into_bytes()));
        if job.is_check_asked {
            outputs.push(("report.html".to_owned(), report_page(job, command)?.into_bytes()));
        }
    }
    for step in &job.hull_steps {
        outputs.push((step.file_name("model"), render_model(&step.mesh, &job.render)?.to_png()));
    }
    if let Some((panelled, sheet)) = &job.panelled {
        outputs.extend(panel_outputs(panelled, job.mesh()?, sheet, command)?);
    }
    if let Some((fabrication, sheet)) = &job.fabrication {
        outputs.extend(fabrication_outputs(fabrication, job.mesh().ok(), sheet, command)?);
    }
    if let Some(((fabrication, sheet), mesh)) = job.fabrication.as_ref().zip(job.mesh().ok()) {
        let show = (&job.show, sheet.letter.labels);
        outputs.extend(show_outputs(fabrication, mesh, show, &job.render, command)?);
    }
    Ok(outputs)
}

/// The picture of the model, and where it is asked for of the model before the last operator.
fn pictures(job: &Job, mesh: &Mesh) -> Result<Vec<Output>, MakeError> {
    let context = OpContext { made: job.made(), progress: &Silent };
    let (shown, marks) = job.point_out.shown(mesh, job.made(), job.render.ids, &context)?;
    let made = job.fabrication.as_ref().map(|(f, _)| f);
    let (shown, render) = match made.filter(|_| job.render.colour == Colour::Piece) {
        Some(made) => in_pieces(made, shown, &job.render),
        None => (shown, job.render.clone()),
    };
    let mut outputs =
        vec![("model.png".to_owned(), render_with(&shown, &render, &marks)?.to_png())];
    if !job.worst.is_empty() {
        let (render, marks) = worst_in_red(&job.worst, &job.render);
        let picture = render_with(mesh, &render, &marks)?;
        outputs.push(("worst.png".to_owned(), picture.to_png()));
    }
    if let Some(last) = job.moments.last().filter(|_| job.story.before == Before::On) {
        let (before, marks) = last.about_to();
        let picture = render_with(&before, &x_ray(&job.render), &marks)?;
        outputs.push(("before.png".to_owned(), picture.to_png()));
    }
    if !job.story.story.is_empty() {
        let picture = render_story(&frames(job, (&shown, &marks))?, &job.render)?;
        outputs.push(("story.png".to_owned(), picture.to_png()));
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
