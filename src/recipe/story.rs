//! The pictures of a story, in the order in which a recipe names them.

use super::{Job, StoryFrame};
use crate::make::{MakeError, Moment, flat_mesh, in_pieces, x_ray};
use crate::mesh::Mesh;
use crate::picture::{
    Colour, EdgeLines, Frame, Ids, Marks, Projection, RenderParams, Surface, View,
};

/// The frames that the job shows; `shown` is the model with what is pointed out on it.
///
/// # Errors
/// [`MakeError::NoFrame`] for one that the recipe does not make.
pub(super) fn frames(job: &Job, shown: (&Mesh, &Marks)) -> Result<Vec<Frame>, MakeError> {
    // What is on its way is shown as a mesh, not as the smooth form that it becomes.
    let plain = RenderParams {
        ids: Ids::None,
        edges: EdgeLines::On,
        surface: Surface::Solid,
        ..without_pieces(&job.render)
    };
    let mut frames = Vec::new();
    let first = job.moments.first();
    for frame in &job.story.story {
        match frame {
            StoryFrame::Start => {
                let first = first.ok_or(no_operator("start"))?;
                frames.push(common(Mesh::clone(&first.before), &plain, "START"));
            }
            StoryFrame::Each => {
                let (_, early) = job.moments.split_last().ok_or(no_operator("each"))?;
                for (number, moment) in (1..).zip(early) {
                    let label = format!("{number} {}", moment.verb.to_uppercase());
                    frames.push(common(Mesh::clone(&moment.after), &plain, &label));
                }
            }
            StoryFrame::Cuts => {
                first.ok_or(no_operator("cuts"))?;
                frames.extend(job.moments.iter().map(|moment| about_to(moment, &plain)));
            }
            StoryFrame::Cut => {
                let last = job.moments.iter().rfind(|m| m.is_pointed()).or(job.moments.last());
                frames.push(about_to(last.ok_or(no_operator("cut"))?, &plain));
            }
            StoryFrame::Steps => frames.extend(steps(job, &plain)?),
            StoryFrame::Model => frames.extend(model(job, shown)),
            StoryFrame::Sheets => frames.push(sheets(job)?),
        }
    }
    Ok(frames)
}

fn no_operator(frame: &'static str) -> MakeError {
    let why = "no step before it changes the mesh: add one, or leave it out of the story";
    MakeError::NoFrame { frame, why }
}

/// Pieces are known for the model only.
fn without_pieces(render: &RenderParams) -> RenderParams {
    let colour = match render.colour {
        Colour::Piece => Colour::Faces,
        other => other,
    };
    RenderParams { colour, ..render.clone() }
}

/// A frame that is seen as the model is.
fn common(mesh: Mesh, look: &RenderParams, label: &str) -> Frame {
    let (marks, label) = (Marks::default(), label.to_owned());
    Frame { mesh, marks, look: look.clone(), is_apart: false, label }
}

/// As many elements are pointed out in a frame.
const MANY: usize = 100;

fn about_to(moment: &Moment, look: &RenderParams) -> Frame {
    let count = moment.chosen.len();
    let most = match moment.chosen.faces.len() {
        0 => MANY,
        // Red faces hide nothing, unless hardly any other is left.
        _ => MANY.max(moment.before.face_count() * 3 / 4),
    };
    if count > most {
        // Where everything is cut, marks would hide it.
        let label = format!("{} ×{count}", moment.verb.to_uppercase());
        return common(Mesh::clone(&moment.before), look, &label);
    }
    let (mesh, marks) = moment.about_to();
    // Sections lie within, so they are seen through the model; all else is on its surface.
    let look = if marks.sections.is_empty() { look.clone() } else { x_ray(look) };
    Frame { marks, ..common(mesh, &look, &moment.verb.to_uppercase()) }
}

fn steps(job: &Job, look: &RenderParams) -> Result<Vec<Frame>, MakeError> {
    if job.hull_steps.is_empty() {
        let why = "no step asks for it: write `steps` into a step `hull = \"dual\"`";
        return Err(MakeError::NoFrame { frame: "steps", why });
    }
    let label = |planes: usize| match planes {
        0 => "BOX".to_owned(),
        1 => "1 PLANE".to_owned(),
        _ => format!("{planes} PLANES"),
    };
    let frame = |step: &crate::op::HullStep| common(step.mesh.clone(), look, &label(step.planes));
    Ok(job.hull_steps.iter().map(frame).collect())
}

/// The model as its own picture shows it, once for each view.
fn model(job: &Job, (mesh, marks): (&Mesh, &Marks)) -> Vec<Frame> {
    // The mesh is in its pieces already.
    let colour = match job.render.colour {
        Colour::Piece if job.fabrication.is_some() => Colour::Group,
        other => other,
    };
    let look = RenderParams { colour, ..job.render.clone() };
    let one = Frame { marks: marks.clone(), ..common(mesh.clone(), &look, "MODEL") };
    if job.render.views.is_empty() {
        return vec![one];
    }
    let seen = |&view: &View| Frame {
        look: RenderParams { view, ..look.clone() },
        is_apart: true,
        label: view.to_string().to_uppercase(),
        ..one.clone()
    };
    job.render.views.iter().map(seen).collect()
}

fn sheets(job: &Job) -> Result<Frame, MakeError> {
    let why = "nothing was unfolded: add a step `unfold` or `dform`";
    let (fabrication, _) =
        job.fabrication.as_ref().ok_or(MakeError::NoFrame { frame: "sheets", why })?;
    let (model, _) = in_pieces(fabrication, job.mesh()?.clone(), &job.render);
    let look = RenderParams {
        colour: Colour::Group,
        view: View::Top,
        projection: Projection::Parallel,
        ids: Ids::None,
        ..job.render.clone()
    };
    let flat = flat_mesh(fabrication, model.groups())?;
    Ok(Frame { is_apart: true, ..common(flat, &look, "SHEETS") })
}
