//! Convex hull, dual convex hull and half-spaces, as meshes.
//!
//! Source: Gonen 2007, IV.B.1 and figures 14 and 15. The convex hull has coplanar neighbours
//! merged. The dual hull is the intersection of one half-space for each corner of the hull (its
//! plane passes through the corner, with the mean of the unit normals of the hull's faces there)
//! with the bounding box of the points. All faces are convex and carry their planes. A mesh can be
//! divided first into clusters, each with its own hull and component.
//!
//! Changes: everything; the result is a new mesh. n planes in general position: n faces, 3n − 6
//! edges, 2n − 4 vertices, all of valence 3. Every result contains the points that it was made of,
//! but for planes moved. Degenerate: where more than three planes meet the vertex has a higher
//! valence, unless the simple form is asked for: then planes there are moved inwards by less than
//! 1/32 768 of the size, so that the vertices of three edges lie apart. Points that span no volume
//! are an error that says so.

mod build;
mod bundle;
mod decompose;
mod dual;
mod merge;
mod params;
mod parts;

#[cfg(test)]
mod tests;

pub use params::{Axis, HullParams, HullStepChoice, HullStepList};

use super::size::check_size;
use super::{OpContext, OpError};
use crate::geom::hull::{
    Apart, Form, HalfSpace, HalfSpaceError, HullError, Intersect, Numbers, Polygons,
    convex_hull_while, intersect_apart,
};
use crate::mesh::{Mesh, VertexId};
use crate::progress::Progress;
use build::Assembly;
use parts::Cluster;

/// What a hull was made of.
#[derive(Debug, Clone, Default)]
pub struct HullReport {
    /// The convex parts, one component each, in the order of the faces.
    pub parts: Vec<HullPart>,
    /// Clusters without any point, of which nothing was made.
    pub empty_clusters: usize,
    /// Vertices of the result where other than three edges meet.
    pub not_three_valent: Vec<VertexId>,
    /// The meshes after the first planes, as asked for by [`HullParams::steps`].
    pub steps: Vec<HullStep>,
}

impl HullReport {
    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes: Vec<String> = Vec::new();
        for part in &self.parts {
            let idle = part.without_face.len();
            if idle > 0 {
                notes.push(format!(
                    "{}: {idle} of {} half-spaces contribute no face",
                    part.name, part.planes
                ));
            }
            if part.moved > 0 {
                notes.push(format!(
                    "{}: {} planes were moved inwards by at most 1/32768 of the size, so that the \
                    vertices of three edges lie apart",
                    part.name, part.moved
                ));
            }
        }
        if self.empty_clusters > 0 {
            notes.push(format!("{} clusters hold no point", self.empty_clusters));
        }
        if !self.not_three_valent.is_empty() {
            notes.push(format!(
                "{} vertices have other than three edges",
                self.not_three_valent.len()
            ));
        }
        notes
    }
}

/// One convex part of a hull.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct HullPart {
    /// Name of the face group: `hull`, `part-1`, … or that of the group it was made of.
    pub name: String,
    /// How many points it holds; 0 for half-spaces.
    pub points: usize,
    /// How many half-spaces were intersected, the box included; 0 for a plain hull.
    pub planes: usize,
    /// The half-spaces that contribute no face, because they are redundant, repeated, or only
    /// touch. Numbered from 0: as given, or the corners of the hull in the order of their vertices,
    /// then the six sides of the box.
    pub without_face: Vec<usize>,
    /// How many half-spaces were moved inwards a little, so that the vertices of the simple form
    /// lie apart.
    pub moved: usize,
    /// Number of faces.
    pub faces: usize,
}

/// A picture on the way: the intersection of the box with the first planes.
#[derive(Debug, Clone)]
pub struct HullStep {
    /// How many planes, the box not counted.
    pub planes: usize,
    /// The mesh after them.
    pub mesh: Mesh,
}

impl HullStep {
    /// The name of its picture beside the model `stem`: `stem-after-20.png`.
    pub fn file_name(&self, stem: &str) -> String {
        format!("{stem}-after-{}.png", self.planes)
    }
}

/// The convex hull or dual convex hull of a mesh's vertices, of all or by clusters.
///
/// Every vertex of a dual hull is compared with all of its planes, and the mesh is one that every
/// reader takes.
///
/// # Errors
/// [`OpError::NoHull`] when the points of a part span no volume, [`OpError::HalfSpaces`] when a
/// dual hull without box is unbounded, [`OpError::CountOutOfRange`],
/// [`OpError::ConcavityOutOfRange`], [`OpError::NotClosed`] for convex parts of an open mesh,
/// [`OpError::Exclude`], [`OpError::Requires`], [`OpError::Cancelled`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// // At each corner of the cube a plane: an octahedron in the cube's box.
/// let cube = kerfold::shape::cube(10.0);
/// let params = HullParams { dual: true, no_box: true, ..HullParams::default() };
/// let (dual, _) = hull(&cube, &params, &OpContext::default())?;
/// assert_eq!((dual.vertex_count(), dual.face_count()), (6, 8));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn hull(
    mesh: &Mesh,
    params: &HullParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, HullReport), OpError> {
    params.check()?;
    check_steps(mesh, params)?;
    let clusters = parts::clusters(mesh, params, context.progress)?;
    let mut report = HullReport { empty_clusters: clusters.empty, ..HullReport::default() };
    let mut result = Assembly::default();
    let steps = params.steps.as_ref().map_or(&[][..], |steps| &steps.0);
    let mut pictures: Vec<(HullStepChoice, Assembly)> =
        steps.iter().map(|&step| (step, Assembly::default())).collect();
    for (i, cluster) in clusters.parts.iter().enumerate() {
        context.progress.report("hulls", i, clusters.parts.len());
        let faces = faces_of(cluster, context.progress)?;
        if params.dual {
            let dual = dual::Dual::of(&cluster.points, &faces, params.no_box);
            let form = if params.simple { Form::Simple } else { Form::Merged };
            let part = dual.add_to(&mut result, cluster, (form, usize::MAX), context.progress)?;
            report.parts.push(part);
            for (step, picture) in &mut pictures {
                dual.add_to(picture, cluster, (form, step.planes()), context.progress)?;
            }
        } else {
            report.parts.push(result.add_hull(cluster, &faces));
        }
    }
    let result = result.mesh()?;
    report.not_three_valent = other_than_three(&result);
    let planes = report.parts.iter().map(|part| part.planes - dual::box_sides(params.no_box));
    let most = if params.dual { planes.max().unwrap_or(0) } else { 0 };
    for (step, picture) in pictures {
        report.steps.push(HullStep { planes: step.planes().min(most), mesh: picture.mesh()? });
    }
    Ok((result, report))
}

/// Refuses more pictures than memory holds: each is a solid of at most one plane for each vertex and
/// six for the box, and a solid of p planes has at most 3p − 6 edges.
fn check_steps(mesh: &Mesh, params: &HullParams) -> Result<(), OpError> {
    let steps = params.steps.as_ref().map_or(&[][..], |steps| &steps.0);
    let edges_of =
        |step: &HullStepChoice| 3.0 * (step.planes().min(mesh.vertex_count()) + 6) as f64;
    let mut edges = vec![mesh.edge_count() as f64];
    edges.extend(steps.iter().scan(edges[0], |sum, step| {
        *sum += edges_of(step);
        Some(*sum)
    }));
    let asked = u32::try_from(steps.len()).unwrap_or(u32::MAX);
    check_size("steps", asked, |count| edges[(count as usize).min(steps.len())])
}

/// The faces of the hull of a cluster.
fn faces_of(cluster: &Cluster, progress: &dyn Progress) -> Result<Polygons, OpError> {
    let goes_on = || !progress.is_cancelled();
    convex_hull_while(&cluster.points, Numbers::Constructed, &goes_on).map_err(
        |reason| match reason {
            HullError::Stopped => OpError::Cancelled,
            reason => OpError::NoHull { part: cluster.name.clone(), reason },
        },
    )
}

/// The error of a part.
fn half_space_error(part: &str, reason: HalfSpaceError) -> OpError {
    match reason {
        HalfSpaceError::Stopped => OpError::Cancelled,
        reason => OpError::HalfSpaces { part: part.to_owned(), reason },
    }
}

/// The solid that half-spaces n·x ≤ d bound. Of `params` only [`HullParams::simple`] matters. The
/// numbers are taken as given: more than three planes meet in a vertex only when they do so
/// exactly, or so nearly that rounded coordinates cannot tell their meeting points apart. Every
/// vertex is compared with all half-spaces.
///
/// # Errors
/// [`OpError::HalfSpaces`] when they have nothing in common (with the numbers of those that exclude
/// each other), no volume, or leave a direction open (with the direction), and
/// [`OpError::Cancelled`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use glam::DVec3;
/// use kerfold::geom::hull::HalfSpace;
///
/// let normals = [DVec3::ONE, DVec3::new(1., -1., -1.), DVec3::new(-1., 1., -1.), DVec3::new(-1., -1., 1.)];
/// let half_spaces = normals.map(|normal| HalfSpace { normal, offset: 5.0 });
/// let params = HullParams::default();
/// let (tetrahedron, _) = kerfold::op::halfspaces(&half_spaces, &params, &OpContext::default())?;
/// assert_eq!(tetrahedron.face_count(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn halfspaces(
    half_spaces: &[HalfSpace],
    params: &HullParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, HullReport), OpError> {
    let name = "hull".to_owned();
    let form = if params.simple { Form::Simple } else { Form::Merged };
    let options = Intersect { form, numbers: Numbers::Given, ..Intersect::default() };
    let goes_on = || !context.progress.is_cancelled();
    let apart = intersect_apart(half_spaces, &options, half_spaces.len(), &goes_on);
    let Apart { polytope, half_spaces, moved } =
        apart.map_err(|reason| half_space_error(&name, reason))?;
    let mut result = Assembly::default();
    let part =
        HullPart { name, planes: half_spaces.len(), moved: moved.len(), ..HullPart::default() };
    let part = result.add_polytope(polytope, &half_spaces, glam::DVec3::ZERO, part);
    let mesh = result.mesh()?;
    let not_three_valent = other_than_three(&mesh);
    Ok((mesh, HullReport { parts: vec![part], not_three_valent, ..HullReport::default() }))
}

fn other_than_three(mesh: &Mesh) -> Vec<VertexId> {
    mesh.vertices().filter(|&v| mesh.valence(v) != 3).collect()
}
