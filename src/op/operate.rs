//! What all operators on one mesh have in common, so that a recipe and the command line can carry
//! out any of them.

use std::fmt;
use std::path::Path;

use glam::DVec3;

use super::{
    ChosenElements, CutReport, HandleAxis, HandleParams, HullParams, MengerParams, MergeParams,
    OpContext, OpError, PlanarizeParams, RepairParams, ResolveParams, RindParams, SierpinskiParams,
    SimplifyParams, SliceParams, SubdivideParams, TruncateEdgeParams, TruncateFaceParams,
    TruncateVertexParams, handle, hull, menger, merge, planarize, repair, resolve, rind,
    sierpinski, sierpinski_preview, simplify, slice, subdivide, truncate_edges, truncate_faces,
    truncate_vertices,
};
use crate::geom::hull::HalfSpace;
use crate::mesh::{FaceId, Mesh, VertexId};
use crate::panelize::{
    Align, FixChoice, FixedPlane, PanelizeParams, RimChoice, StayChoice, panelize,
};
use crate::select::NewElements;

/// What an operator made of a mesh.
#[derive(Debug, Clone)]
pub struct OperatorOutput {
    /// The new mesh.
    pub mesh: Mesh,
    /// What the selections `made` and `strip` of the next step mean; `None` when the operator does
    /// not say.
    pub made: Option<NewElements>,
    /// What the user should know, in words.
    pub notes: Vec<String>,
    /// What it was told to cut, open or join, of the mesh before.
    pub chosen: ChosenElements,
    /// What of the new mesh is worst by the operator's own measure, at which the user should look;
    /// none where it measures nothing.
    pub worst: ChosenElements,
    /// Whether the operator reached what was asked for; if not, the notes say what is missing, and
    /// the command line ends with 1.
    pub is_clean: bool,
}

impl OperatorOutput {
    /// Reached, and nothing said about what was made.
    fn new(mesh: Mesh, notes: Vec<String>) -> Self {
        let none = ChosenElements::default;
        Self { mesh, made: None, notes, chosen: none(), worst: none(), is_clean: true }
    }
}

/// The parameters of an operator that takes one mesh and makes one.
///
/// Implemented by parameter structs. A new operator implements it, gets a variant in `cli` and a
/// row in the table of `recipe`, and is then a verb and a step.
pub trait Operate: fmt::Debug + Send + Sync {
    /// Does it.
    ///
    /// # Errors
    /// Those of the operator itself.
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError>;

    /// What can be said of the mesh before the work begins, in words; the notes of the result say
    /// it again.
    fn preview(&self, _mesh: &Mesh) -> Vec<String> {
        Vec::new()
    }

    /// The same cut with its whole report, so that it can be shown before it is made; `None` for
    /// operators that cut nothing.
    fn cut(
        &self,
        _mesh: &Mesh,
        _context: &OpContext<'_>,
    ) -> Option<Result<(Mesh, CutReport), OpError>> {
        None
    }

    /// A file with points that has to be read first; operators read no files.
    fn points_file(&self) -> Option<&Path> {
        None
    }

    /// The same parameters with the lines of points of their file in its place; `None` when they
    /// take none. `_scale` is the factor from the numbers of the model's file to millimetres, for
    /// curves that were drawn on it.
    fn with_points(&self, _curves: Vec<Vec<DVec3>>, _scale: f64) -> Option<Box<dyn Operate>> {
        None
    }

    /// A file with planes for rims that has to be read first, beside [`Self::planes_file`].
    fn rim_file(&self) -> Option<&Path> {
        None
    }

    /// The same parameters with the planes of that file in its place, each with its line; `None` when
    /// they take none. `_scale` as for [`Self::with_points`].
    fn with_rim(&self, _planes: &[(HalfSpace, usize)], _scale: f64) -> Option<Box<dyn Operate>> {
        None
    }

    /// A file with single points that has to be read first, beside [`Self::points_file`].
    fn places_file(&self) -> Option<&Path> {
        None
    }

    /// The same parameters with the points of that file in its place; `None` when they take none.
    /// `_scale` as for [`Self::with_points`].
    fn with_places(&self, _places: Vec<DVec3>, _scale: f64) -> Option<Box<dyn Operate>> {
        None
    }

    /// A file with planes that has to be read first.
    fn planes_file(&self) -> Option<&Path> {
        None
    }

    /// The same parameters with the planes of their file in its place, each with its line; `None`
    /// when they take none. `_scale` as for [`Self::with_points`].
    fn with_planes(&self, _planes: &[(HalfSpace, usize)], _scale: f64) -> Option<Box<dyn Operate>> {
        None
    }
}

macro_rules! cuts {
    ($($params:ty, $operator:ident, $element:literal;)*) => {$(
        impl Operate for $params {
            fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
                let (mesh, report) = $operator(mesh, self, context)?;
                let notes = report.notes($element);
                let CutReport { made, chosen, .. } = report;
                Ok(OperatorOutput { chosen, made: Some(made), ..OperatorOutput::new(mesh, notes) })
            }

            fn cut(&self, mesh: &Mesh, context: &OpContext<'_>) -> Option<Result<(Mesh, CutReport), OpError>> {
                Some($operator(mesh, self, context))
            }
        }
    )*};
}

cuts! {
    TruncateVertexParams, truncate_vertices, "vertex";
    TruncateEdgeParams, truncate_edges, "edge";
    TruncateFaceParams, truncate_faces, "face";
    SliceParams, slice, "plane";
}

impl Operate for HullParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = hull(mesh, self, context)?;
        Ok(OperatorOutput::new(mesh, report.notes()))
    }
}

impl Operate for ResolveParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = resolve(mesh, self, context)?;
        Ok(OperatorOutput::new(mesh, report.notes()))
    }
}

impl Operate for MergeParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = merge(mesh, self, context)?;
        let notes = report.notes();
        Ok(OperatorOutput { made: Some(report.made), ..OperatorOutput::new(mesh, notes) })
    }
}

impl Operate for RepairParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = repair(mesh, self, context)?;
        Ok(OperatorOutput::new(mesh, report.notes()))
    }
}

impl Operate for SimplifyParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = simplify(mesh, self, context)?;
        let is_clean = report.is_clean();
        Ok(OperatorOutput { is_clean, ..OperatorOutput::new(mesh, report.notes()) })
    }
}

impl Operate for PlanarizeParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = planarize(mesh, self, context)?;
        let notes = report.notes();
        Ok(OperatorOutput { is_clean: report.is_clean(), ..OperatorOutput::new(mesh, notes) })
    }
}

impl Operate for PanelizeParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = panelize(mesh, self, context.progress)?;
        let [faces, vertices] = report.pointed_out();
        let worst = ChosenElements {
            faces: faces.into_iter().map(FaceId::new).collect(),
            vertices: vertices.into_iter().map(VertexId::new).collect(),
            ..ChosenElements::default()
        };
        let is_clean = report.is_clean();
        Ok(OperatorOutput { worst, is_clean, ..OperatorOutput::new(mesh, report.notes()) })
    }

    fn points_file(&self) -> Option<&Path> {
        match &self.align {
            Align::File(path) => Some(path),
            _ => None,
        }
    }

    fn with_points(&self, mut curves: Vec<Vec<DVec3>>, scale: f64) -> Option<Box<dyn Operate>> {
        curves.iter_mut().flatten().for_each(|p| *p *= scale);
        Some(Box::new(Self { align: Align::Curves(curves), ..self.clone() }))
    }

    fn places_file(&self) -> Option<&Path> {
        match &self.stay {
            StayChoice::File(path) => Some(path),
            _ => None,
        }
    }

    fn with_places(&self, places: Vec<DVec3>, scale: f64) -> Option<Box<dyn Operate>> {
        let stay = StayChoice::Points(places.into_iter().map(|p| p * scale).collect());
        Some(Box::new(Self { stay, ..self.clone() }))
    }

    fn planes_file(&self) -> Option<&Path> {
        match &self.fix {
            FixChoice::File(path) => Some(path),
            _ => None,
        }
    }

    fn with_planes(&self, planes: &[(HalfSpace, usize)], scale: f64) -> Option<Box<dyn Operate>> {
        Some(Box::new(Self { fix: FixChoice::Planes(fixed(planes, scale)), ..self.clone() }))
    }

    fn rim_file(&self) -> Option<&Path> {
        match &self.rim {
            RimChoice::File(path) => Some(path),
            _ => None,
        }
    }

    fn with_rim(&self, planes: &[(HalfSpace, usize)], scale: f64) -> Option<Box<dyn Operate>> {
        Some(Box::new(Self { rim: RimChoice::Given(fixed(planes, scale)), ..self.clone() }))
    }
}

/// Planes of a file in mm.
fn fixed(planes: &[(HalfSpace, usize)], scale: f64) -> Vec<FixedPlane> {
    let fixed = |&(plane, line): &(HalfSpace, usize)| {
        let HalfSpace { normal, offset } = plane;
        FixedPlane { normal, offset: offset * scale, line }
    };
    planes.iter().map(fixed).collect()
}

impl Operate for SubdivideParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = subdivide(mesh, self, context)?;
        Ok(OperatorOutput::new(mesh, report.notes()))
    }
}

impl Operate for SierpinskiParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = sierpinski(mesh, self, context)?;
        Ok(OperatorOutput::new(mesh, report.notes()))
    }

    fn preview(&self, mesh: &Mesh) -> Vec<String> {
        sierpinski_preview(mesh)
    }
}

impl Operate for RindParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let faces = self.opened(mesh, context)?;
        let (mesh, report) = rind(mesh, self, context)?;
        Ok(OperatorOutput {
            chosen: ChosenElements { faces, ..ChosenElements::default() },
            is_clean: report.crossing.is_empty() && report.pairs.is_empty(),
            made: Some(report.made.clone()),
            ..OperatorOutput::new(mesh, report.notes())
        })
    }
}

impl Operate for MengerParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let (mesh, report) = menger(mesh, self, context)?;
        Ok(OperatorOutput {
            is_clean: report.crossing.is_empty() && report.pairs.is_empty(),
            ..OperatorOutput::new(mesh, report.notes())
        })
    }
}

impl Operate for HandleParams {
    fn operate(&self, mesh: &Mesh, context: &OpContext<'_>) -> Result<OperatorOutput, OpError> {
        let faces = self.faces().filter(|&f| mesh.has_face(f)).collect();
        let (mesh, report) = handle(mesh, self, context)?;
        Ok(OperatorOutput {
            chosen: ChosenElements { faces, ..ChosenElements::default() },
            is_clean: report.crossing.is_empty() && report.pairs.is_empty(),
            made: Some(report.made.clone()),
            ..OperatorOutput::new(mesh, report.notes())
        })
    }

    fn points_file(&self) -> Option<&Path> {
        match &self.axis {
            Some(HandleAxis::File(path)) => Some(path),
            _ => None,
        }
    }

    fn with_points(&self, curves: Vec<Vec<DVec3>>, _scale: f64) -> Option<Box<dyn Operate>> {
        Some(Box::new(Self { axis: Some(HandleAxis::Points(curves.concat())), ..self.clone() }))
    }
}
