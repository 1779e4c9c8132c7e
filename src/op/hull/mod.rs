//! Convex hull, dual convex hull and half-spaces, as meshes.
//!
//! Source: Gonen 2007, IV.B.1 and figures 14 and 15. The convex hull has coplanar neighbours
//! merged. The dual hull is the intersection of one half-space for each corner of the hull (its
//! plane passes through the corner, with the mean of the unit normals of the hull's faces there)
//! with the bounding box of the points. All faces are convex and carry their planes. A mesh can be
//! divided first into clusters, each with its own hull and component.
//!
//! Changes: everything; the result is a new mesh. n planes in general position: n faces, 3n − 6
//! edges, 2n − 4 vertices, all of valence 3. Every result contains the points that it was made of.
//! Degenerate: where more than three planes meet the vertex has a higher valence, unless the simple
//! form is asked for; points that span no volume are an error that says so.

mod build;
mod convex_parts;
mod dual;
mod params;
mod parts;

#[cfg(test)]
mod tests;

pub use params::{Axis, HullParams, HullStepChoice, HullStepList};

use super::{OpContext, OpError};
use crate::geom::hull::{Form, HalfSpace, Intersect, Numbers, convex_hull, intersect};
use crate::mesh::{Mesh, VertexId};
use build::Assembly;

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
/// # Errors
/// [`OpError::NoHull`] when the points of a part span no volume, [`OpError::HalfSpaces`] when a
/// dual hull without box is unbounded, [`OpError::CountOutOfRange`],
/// [`OpError::ConcavityOutOfRange`], [`OpError::Exclude`], [`OpError::Requires`],
/// [`OpError::Cancelled`].
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
    let clusters = parts::clusters(mesh, params)?;
    let mut report = HullReport { empty_clusters: clusters.empty, ..HullReport::default() };
    let mut result = Assembly::default();
    let steps = params.steps.as_ref().map_or(&[][..], |steps| &steps.0);
    let mut pictures: Vec<(HullStepChoice, Assembly)> =
        steps.iter().map(|&step| (step, Assembly::default())).collect();
    for (i, cluster) in clusters.parts.iter().enumerate() {
        context.progress.report("hulls", i, clusters.parts.len());
        if context.progress.is_cancelled() {
            return Err(OpError::Cancelled);
        }
        let no_hull = |reason| OpError::NoHull { part: cluster.name.clone(), reason };
        let faces = convex_hull(&cluster.points, Numbers::Constructed).map_err(no_hull)?;
        if params.dual {
            let dual = dual::Dual::of(&cluster.points, &faces, params.no_box);
            let form = if params.simple { Form::Simple } else { Form::Merged };
            report.parts.push(dual.add_to(&mut result, cluster, form, usize::MAX)?);
            for (step, picture) in &mut pictures {
                dual.add_to(picture, cluster, form, step.planes())?;
            }
        } else {
            report.parts.push(result.add_hull(cluster, &faces));
        }
    }
    let result = result.mesh()?;
    report.not_three_valent = other_than_three(&result);
    for (step, picture) in pictures {
        let most = report
            .parts
            .iter()
            .map(|part| part.planes - dual::box_sides(params.no_box))
            .max()
            .unwrap_or(0);
        report.steps.push(HullStep { planes: step.planes().min(most), mesh: picture.mesh()? });
    }
    Ok((result, report))
}

/// The solid that half-spaces n·x ≤ d bound. Of `params` only [`HullParams::simple`] matters. The
/// numbers are taken as given: more than three planes meet in a vertex only when they do so
/// exactly.
///
/// # Errors
/// [`OpError::HalfSpaces`] when they have nothing in common (with the numbers of those that exclude
/// each other), no volume, or leave a direction open (with the direction).
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
/// let (tetrahedron, _) = kerfold::op::halfspaces(&half_spaces, &params)?;
/// assert_eq!(tetrahedron.face_count(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn halfspaces(
    half_spaces: &[HalfSpace],
    params: &HullParams,
) -> Result<(Mesh, HullReport), OpError> {
    let name = "hull".to_owned();
    let form = if params.simple { Form::Simple } else { Form::Merged };
    let options = Intersect { form, numbers: Numbers::Given, interior: None };
    let polytope = intersect(half_spaces, &options)
        .map_err(|reason| OpError::HalfSpaces { part: name.clone(), reason })?;
    let mut result = Assembly::default();
    let part = HullPart { name, points: 0, planes: half_spaces.len(), ..HullPart::default() };
    let part = result.add_polytope(polytope, half_spaces, glam::DVec3::ZERO, part);
    let mesh = result.mesh()?;
    let not_three_valent = other_than_three(&mesh);
    Ok((mesh, HullReport { parts: vec![part], not_three_valent, ..HullReport::default() }))
}

fn other_than_three(mesh: &Mesh) -> Vec<VertexId> {
    mesh.vertices().filter(|&v| mesh.valence(v) != 3).collect()
}
