//! Pictures that explain: elements pointed out, a slicing plane and what it takes, what a step was
//! about to cut.

use serde::Deserialize;

use super::{Fabrication, MakeError};
use crate::mesh::{FaceId, Mesh};
use crate::op::{Keep, OpContext, OpError, SliceParams, slice};
use crate::picture::{Colour, Ids, Marks, RenderParams, Surface};
use crate::select::{Context, NewElements, Selection};
use crate::units::{Direction, Point};

/// How far what a plane takes is moved away, relative to the model.
const APART: f64 = 0.12;

/// What a picture points out.
#[derive(Debug, Clone, Default, clap::Args, Deserialize)]
pub struct PointOut {
    /// Elements in red: a selection of faces, edges or vertices, whichever it finds first; with
    /// --ids those of that kind.
    #[arg(long, value_name = "SELECTION")]
    #[serde(default)]
    pub select: Option<Selection>,
    /// A plane across this direction: what it would take is moved away and coloured.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "point")]
    #[serde(default)]
    pub normal: Option<Direction>,
    /// A point on that plane.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true, requires = "normal")]
    #[serde(default)]
    pub point: Option<Point>,
}

impl PointOut {
    /// The mesh as it is shown, and what is red on it.
    ///
    /// # Errors
    /// [`MakeError::Select`] for a selection that finds nothing, [`MakeError::Op`] for a plane that
    /// is none.
    pub fn shown(
        &self,
        mesh: &Mesh,
        made: Option<&NewElements>,
        ids: Ids,
        context: &OpContext<'_>,
    ) -> Result<(Mesh, Marks), MakeError> {
        let chosen = match &self.select {
            None => Marks::default(),
            Some(selection) => {
                let context = Context { mesh, made, progress: context.progress };
                marks(selection, &context, ids)?
            }
        };
        let (Some(normal), Some(point)) = (self.normal, self.point) else {
            return Ok((mesh.clone(), chosen));
        };
        taken_apart(mesh, normal, point, context)
    }
}

/// Which elements a selection means: those of the kind whose numbers are shown, else the first kind
/// of which it finds some.
fn marks(selection: &Selection, context: &Context<'_>, ids: Ids) -> Result<Marks, MakeError> {
    let faces = || Ok(Marks { faces: selection.faces(context)?, ..Marks::default() });
    let edges = || Ok(Marks { edges: selection.edges(context)?, ..Marks::default() });
    let vertices = || Ok(Marks { vertices: selection.vertices(context)?, ..Marks::default() });
    match ids {
        Ids::Faces => faces(),
        Ids::Edges => edges(),
        Ids::Vertices => vertices(),
        // The message about faces is as good as the others.
        Ids::None => {
            faces().or_else(|error| edges().or_else(|_: MakeError| vertices()).or(Err(error)))
        }
    }
}

/// What a plane keeps, and moved away along its normal what it takes, in red.
fn taken_apart(
    mesh: &Mesh,
    normal: Direction,
    point: Point,
    context: &OpContext<'_>,
) -> Result<(Mesh, Marks), MakeError> {
    let part = |keep: Keep| {
        let params = SliceParams { keep, ..SliceParams::new(normal.0, point.0) };
        match slice(mesh, &params, context) {
            Ok((part, _)) => Ok(Some(part)),
            Err(OpError::NothingLeft { .. }) => Ok(None),
            Err(error) => Err(error),
        }
    };
    let (kept, taken) = (part(Keep::Reverse)?, part(Keep::Normal)?);
    let away = normal.0.normalize_or_zero() * APART * crate::measure::size(mesh).length();
    let mut points = Vec::new();
    let mut polygons: Vec<Vec<usize>> = Vec::new();
    let mut red = Vec::new();
    for (part, shift) in [(kept, glam::DVec3::ZERO), (taken, away)] {
        let Some(mut part) = part else { continue };
        part.compact();
        let first = points.len();
        points.extend(part.vertices().map(|v| part.position(v) + shift));
        for f in part.faces() {
            if shift != glam::DVec3::ZERO {
                red.push(FaceId::new(polygons.len()));
            }
            polygons.push(part.face_vertices(f).map(|v| first + v.index()).collect());
        }
    }
    match Mesh::from_faces(points, polygons) {
        Ok(both) => Ok((both, Marks { faces: red, ..Marks::default() })),
        // Parts that touch themselves cannot be put together again: the whole model is shown.
        Err(_) => Ok((mesh.clone(), Marks::default())),
    }
}

/// The model as it was before a step, seen through, with the sections along which the step cut it.
pub(crate) fn before_and_sections(
    before: &Mesh,
    after: &Mesh,
    made: Option<&NewElements>,
) -> Option<(Mesh, Marks)> {
    let mut before = before.clone();
    before.compact();
    let mut points: Vec<_> = before.vertices().map(|v| before.position(v)).collect();
    let mut polygons: Vec<Vec<usize>> =
        before.faces().map(|f| before.face_vertices(f).map(|v| v.index()).collect()).collect();
    let mut red = Vec::new();
    for &f in made.map_or(&[][..], |made| &made.faces) {
        let first = points.len();
        points.extend(after.face_positions(f));
        red.push(FaceId::new(polygons.len()));
        polygons.push((first..points.len()).collect());
    }
    let both = Mesh::from_faces(points, polygons).ok()?;
    Some((both, Marks { faces: red, ..Marks::default() }))
}

/// The mesh with its pieces as groups, so that they have the colours of groups.
pub(crate) fn in_pieces(
    fabrication: &Fabrication,
    mut mesh: Mesh,
    render: &RenderParams,
) -> (Mesh, RenderParams) {
    for piece in &fabrication.net.pieces {
        for face in piece.faces.iter().map(|f| FaceId::new(f.face)) {
            if mesh.has_face(face) {
                mesh.set_group(face, &piece.id.to_string());
            }
        }
    }
    (mesh, RenderParams { colour: Colour::Group, ..render.clone() })
}

/// How the picture before a step looks.
pub(crate) fn x_ray(render: &RenderParams) -> RenderParams {
    RenderParams {
        surface: Surface::XRay,
        colour: Colour::Faces,
        views: Vec::new(),
        ..render.clone()
    }
}
