//! Pictures that explain: elements pointed out, a slicing plane and what it takes, what a step was
//! about to cut.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use serde::Deserialize;

use super::{Fabrication, MakeError};
use crate::geom::{Frame, polygon};
use crate::mesh::{EdgeId, FaceId, Mesh, VertexId};
use crate::op::{ChosenElements, Keep, OpContext, OpError, SliceParams, slice};
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
        Ids::None | Ids::Marked => {
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
    for (part, shift) in [(kept, DVec3::ZERO), (taken, away)] {
        let Some(mut part) = part else { continue };
        part.compact();
        let first = points.len();
        points.extend(part.vertices().map(|v| part.position(v) + shift));
        for f in part.faces() {
            if shift != DVec3::ZERO {
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

/// How a picture shows what is worst of a mesh: in red, with its numbers.
pub fn worst_in_red(worst: &ChosenElements, render: &RenderParams) -> (RenderParams, Marks) {
    let ChosenElements { vertices, edges, faces } = worst.clone();
    let marks = Marks { vertices, edges, faces, ..Marks::default() };
    let numbered = RenderParams { ids: Ids::Marked, colour: Colour::Faces, ..render.clone() };
    (numbered, marks)
}

/// A step of a recipe with the mesh before and after it.
#[derive(Debug, Clone)]
pub struct Moment {
    /// How the step begins: `cut vertex`, `planarize`, ….
    pub verb: &'static str,
    /// The mesh before.
    pub before: Arc<Mesh>,
    /// What it was told to cut, open or join.
    pub chosen: ChosenElements,
    /// The mesh after.
    pub after: Arc<Mesh>,
    /// What it made.
    pub made: Option<NewElements>,
}

impl Moment {
    /// Whether the step cuts, opens or joins something that can be pointed out.
    pub fn is_pointed(&self) -> bool {
        self.is_cut() || !self.chosen.is_empty()
    }

    /// Whether the step cuts by planes.
    fn is_cut(&self) -> bool {
        self.verb.starts_with("cut")
    }

    /// The model before the step: what is cut, opened or joined in red; of a cut also its sections,
    /// and its plane where there is only one.
    pub(crate) fn about_to(&self) -> (Mesh, Marks) {
        let mut before = Mesh::clone(&self.before);
        let map = before.compact();
        let ChosenElements { vertices, edges, faces } = &self.chosen;
        let mut marks = Marks {
            vertices: vertices.iter().filter_map(|&v| map.vertex(v)).collect(),
            edges: edges.iter().filter_map(|&e| map.edge(e)).collect(),
            faces: faces.iter().filter_map(|&f| map.face(f)).collect(),
            ..Marks::default()
        };
        let made = self.made.as_ref().filter(|_| self.is_cut());
        let Some(made) = made.filter(|made| (1..=MOST_SECTIONS).contains(&made.faces.len())) else {
            return (before, marks);
        };
        let mut points: Vec<DVec3> = before.vertices().map(|v| before.position(v)).collect();
        let mut polygons: Vec<Vec<usize>> =
            before.faces().map(|f| before.face_vertices(f).map(|v| v.index()).collect()).collect();
        for &f in &made.faces {
            let first = points.len();
            points.extend(self.after.face_positions(f));
            marks.sections.push(FaceId::new(polygons.len()));
            polygons.push((first..points.len()).collect());
        }
        if let Some(corners) = plane_patch(&self.after, &made.faces) {
            let first = points.len();
            points.extend(corners);
            marks.planes.push(FaceId::new(polygons.len()));
            polygons.push((first..points.len()).collect());
        }
        match Mesh::from_faces(points, polygons) {
            // Vertices and faces keep their numbers; edges may not.
            Ok(both) => {
                let ends = |e: EdgeId| before.edge_vertices(e);
                marks.edges =
                    marks.edges.iter().filter_map(|&e| edge_between(&both, ends(e))).collect();
                (both, marks)
            }
            Err(_) => (before, Marks::default()),
        }
    }
}

fn edge_between(mesh: &Mesh, [a, b]: [VertexId; 2]) -> Option<EdgeId> {
    mesh.outgoing(a).find(|&h| mesh.target(h) == b).map(|h| h.edge())
}

/// Where a step cuts more sections, they hide each other.
const MOST_SECTIONS: usize = 24;

/// How far the picture of a plane goes beyond its sections, relative to these.
const BEYOND: f64 = 0.25;

/// The corners of a rectangle around sections that lie in one plane; `None` where they do not.
fn plane_patch(mesh: &Mesh, sections: &[FaceId]) -> Option<[DVec3; 4]> {
    let plane = mesh.plane(*sections.first()?)?;
    let frame = Frame::on_plane(&plane);
    let points: Vec<DVec3> = sections.iter().flat_map(|&f| mesh.face_positions(f)).collect();
    let flat: Vec<DVec2> = points.iter().map(|&p| frame.flatten(p)).collect();
    let (low, high) = polygon::bounds(&flat)?;
    // Pictures need no exact planes: what is off by less than a thousandth is not seen.
    let reach = 1e-3 * low.distance(high);
    if points.iter().any(|&p| plane.signed_distance(p).abs() > reach) {
        return None;
    }
    let (middle, half) = (low.midpoint(high), (high - low) / 2.0 + BEYOND * low.distance(high));
    let corner = |x: f64, y: f64| frame.lift(middle + half * DVec2::new(x, y));
    Some([corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
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
