//! Simplify: fewer triangles, so that a scan or a sculpture becomes a paper model.
//!
//! Source: edges are collapsed in the order of their quadric error (Garland, Heckbert 1997, "Surface
//! simplification using quadric error metrics"), by the library meshoptimizer. What it returns is
//! held against the mesh before by code of its own: it must be a surface again, and no vertex of the
//! old one may lie farther from it than was allowed.
//!
//! Needs: a mesh that a file of polygons can hold; polygons are divided into triangles first. Keeps:
//! places: every vertex of the result is one of the mesh, to the bit; groups, by the nearest old
//! face. Changes: V, E, F fall; seams are lost. Degenerate: where fewer faces would tear the surface
//! or fold it onto itself, it keeps more, and says so.

mod deviation;

#[cfg(test)]
mod tests;

use glam::DVec3;
use meshopt::SimplifyOptions;
use serde::Deserialize;

use self::deviation::{deviation, nearest_faces};
use super::{OpContext, OpError, OpFinding};
use crate::check::short;
use crate::code::Coded;
use crate::geom::{Frame, triangulate};
use crate::measure::{CrossingPair, crossings, genus};
use crate::mesh::{FaceId, Mesh, MeshBuilder, VertexId};
use crate::units::{Length, counted};

/// Where a result is no surface, it is asked for again with so many more faces.
const MORE: f64 = 1.15;
/// How often.
const MOST_TRIES: usize = 12;
/// More than any model is large, in mm, and small enough to be squared in single precision.
const NO_LIMIT: f64 = 1e12;
/// Pairs of faces that a report names at most.
const MOST_PAIRS: usize = 1000;

/// How to simplify: at least one of the two. One definition for the library, the command line and
/// the recipe.
#[derive(Debug, Clone, Default, PartialEq, clap::Args, Deserialize)]
pub struct SimplifyParams {
    /// How many triangles are wanted, 4 or more; a few less or more may come.
    #[arg(long, value_name = "N", required_unless_present = "deviation")]
    #[serde(default)]
    pub faces: Option<usize>,
    /// How far the surface may move from where it was, above 0, in mm unless a unit is given. With
    /// --faces, whichever ends first.
    #[arg(long, value_name = "LENGTH")]
    #[serde(default)]
    pub deviation: Option<Length>,
}

/// What simplifying did.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SimplifyReport {
    /// How many triangles there were.
    pub before: usize,
    /// How many there are.
    pub after: usize,
    /// How far the farthest old vertex lies from the new surface, in mm, measured.
    pub deviation_mm: f64,
    /// Whether more triangles than asked for had to stay, so that the surface stays whole or near.
    pub kept_more: bool,
    /// How many seams were lost.
    pub lost_seams: usize,
    /// How many handles there were and are.
    pub genus: [usize; 2],
    /// Pairs of faces of the result that go through each other.
    pub pairs: Vec<CrossingPair>,
}

impl SimplifyReport {
    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![format!(
            "{} became {}; no vertex of the old surface lies farther than {} mm from the new one",
            counted(self.before, "triangle", "triangles"),
            self.after,
            short(self.deviation_mm)
        )];
        if self.kept_more {
            notes.push(
                "more triangles stay than were asked for: fewer would tear the surface or move it \
                too far"
                    .to_owned(),
            );
        }
        if self.genus[0] != self.genus[1] {
            notes.push(format!(
                "the number of handles changed from {} to {}",
                self.genus[0], self.genus[1]
            ));
        }
        if self.lost_seams > 0 {
            notes.push(format!(
                "{} lost: their edges are no more",
                counted(self.lost_seams, "seam mark was", "seam marks were")
            ));
        }
        if let Some(pair) = self.pairs.first() {
            notes.push(format!(
                "{} of faces go through each other, the first {} and {}; allow less deviation or \
                more faces ({})",
                counted(self.pairs.len(), "pair", "pairs"),
                pair.first,
                pair.second,
                OpFinding::SimplifiedCrosses.code()
            ));
        }
        notes
    }

    /// Whether no faces of the result go through each other.
    pub fn is_clean(&self) -> bool {
        self.pairs.is_empty()
    }
}

/// Makes a mesh of fewer triangles.
///
/// # Errors
/// [`OpError::TooFewFaces`] for fewer than 4 faces, [`OpError::ToleranceOutOfRange`] for a
/// deviation of 0 or less, [`OpError::Requires`] without either, [`OpError::NotSimplified`] when no
/// smaller surface keeps them, [`OpError::Cancelled`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// let ball = kerfold::shape::geodesic(10, 50.0);
/// let params = SimplifyParams { faces: Some(200), ..SimplifyParams::default() };
/// let (simple, report) = simplify(&ball, &params, &OpContext::default())?;
/// assert!(simple.is_closed() && simple.face_count() <= 240);
/// assert!(report.deviation_mm < 5.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn simplify(
    mesh: &Mesh,
    params: &SimplifyParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, SimplifyReport), OpError> {
    check_numbers(params)?;
    let advice = "simplify the mesh as it is in a file: write it, then `kerfold simplify FILE`";
    if let Some(&fault) = mesh.file_faults().first() {
        return Err(OpError::NotSimple { fault, advice });
    }
    let triangles = Triangles::of(mesh);
    let mut report = SimplifyReport {
        before: triangles.corners.len() / 3,
        lost_seams: mesh.edges().filter(|&e| mesh.is_seam(e)).count(),
        ..SimplifyReport::default()
    };
    let faces = params.faces.unwrap_or(4);
    let result = match params.deviation {
        None => to_number(mesh, &triangles, faces, context)?,
        Some(deviation) => within(mesh, &triangles, (faces, deviation.mm()), context)?,
    };
    let Some(result) = result else {
        return Err(OpError::NotSimplified { tries: MOST_TRIES });
    };
    report.deviation_mm = deviation(mesh, &result);
    Ok(finish(mesh, result, params, report))
}

/// The mesh of about so many faces, or of more where it would be no surface.
fn to_number(
    mesh: &Mesh,
    triangles: &Triangles,
    mut faces: usize,
    context: &OpContext<'_>,
) -> Result<Option<Mesh>, OpError> {
    for round in 0..MOST_TRIES {
        go_on(round, context)?;
        let built = triangles.build(mesh, &triangles.fewer(faces, NO_LIMIT));
        if built.is_some() {
            return Ok(built);
        }
        faces = (faces as f64 * MORE).ceil() as usize + 2;
    }
    Ok(None)
}

/// The mesh of the fewest faces found, not fewer than asked for, that keeps the deviation as it is
/// measured. The library's own error is only about as large, so the one that leads to it is searched
/// for by halving.
fn within(
    mesh: &Mesh,
    triangles: &Triangles,
    (faces, allowed): (usize, f64),
    context: &OpContext<'_>,
) -> Result<Option<Mesh>, OpError> {
    let mut best: Option<Mesh> = None;
    let (mut low, mut high) = (0.0, 2.0 * allowed);
    for round in 0..MOST_TRIES {
        go_on(round, context)?;
        let middle = low + (high - low) / 2.0;
        let built = triangles.build(mesh, &triangles.fewer(faces, middle));
        match built.filter(|built| deviation(mesh, built) <= allowed) {
            Some(built) => {
                low = middle;
                if best.as_ref().is_none_or(|best| built.face_count() < best.face_count()) {
                    best = Some(built);
                }
            }
            None => high = middle,
        }
    }
    Ok(best)
}

fn go_on(round: usize, context: &OpContext<'_>) -> Result<(), OpError> {
    if context.progress.is_cancelled() {
        return Err(OpError::Cancelled);
    }
    context.progress.report("simplifying", round, MOST_TRIES);
    Ok(())
}

fn finish(
    mesh: &Mesh,
    mut result: Mesh,
    params: &SimplifyParams,
    mut report: SimplifyReport,
) -> (Mesh, SimplifyReport) {
    carry_groups(mesh, &mut result);
    report.after = result.face_count();
    // A tenth more is what the library takes for as many.
    let many = |faces: usize| report.after > faces + faces / 10;
    report.kept_more = params.deviation.is_none() && params.faces.is_some_and(many);
    report.genus = [genus(mesh), genus(&result)];
    report.pairs = crossings(&result, MOST_PAIRS);
    (result, report)
}

fn check_numbers(params: &SimplifyParams) -> Result<(), OpError> {
    match (params.faces, params.deviation.map(Length::mm)) {
        (None, None) => Err(OpError::Requires { what: "simplify", needed: "faces or deviation" }),
        (Some(faces), _) if faces < 4 => Err(OpError::TooFewFaces { faces }),
        (_, Some(tolerance)) if !(tolerance > 0.0 && tolerance.is_finite()) => {
            Err(OpError::ToleranceOutOfRange { tolerance })
        }
        _ => Ok(()),
    }
}

/// The faces of a mesh as triangles, for the library: in single precision about the middle.
struct Triangles {
    /// The vertices of the mesh, in its order.
    vertices: Vec<VertexId>,
    places: Vec<[f32; 3]>,
    /// Three numbers for each triangle.
    corners: Vec<u32>,
}

impl Triangles {
    fn of(mesh: &Mesh) -> Self {
        let (low, high) = mesh.bounds().unwrap_or_default();
        let centre = low.midpoint(high);
        let vertices: Vec<VertexId> = mesh.vertices().collect();
        let mut number = vec![0_u32; mesh.vertex_slots()];
        vertices.iter().enumerate().for_each(|(i, v)| number[v.index()] = i as u32);
        let place = |v: &VertexId| (mesh.position(*v) - centre).as_vec3().to_array();
        let mut corners = Vec::with_capacity(3 * mesh.face_count());
        for f in mesh.faces() {
            let own: Vec<u32> = mesh.face_vertices(f).map(|v| number[v.index()]).collect();
            for t in face_triangles(mesh, f) {
                corners.extend(t.map(|i| own[i]));
            }
        }
        Self { places: vertices.iter().map(place).collect(), vertices, corners }
    }

    /// The corners of fewer triangles.
    fn fewer(&self, faces: usize, error: f64) -> Vec<u32> {
        let target = (3 * faces).min(self.corners.len());
        let error = error.min(f64::from(f32::MAX)) as f32;
        meshopt::simplify_decoder(
            &self.corners,
            &self.places,
            target,
            error,
            SimplifyOptions::ErrorAbsolute | SimplifyOptions::RegularizeLight,
            None,
        )
    }

    /// `None` when the triangles are no surface.
    fn build(&self, mesh: &Mesh, corners: &[u32]) -> Option<Mesh> {
        let mut builder = MeshBuilder::new();
        self.vertices.iter().for_each(|&v| {
            builder.vertex(mesh.position(v));
        });
        for t in corners.chunks_exact(3) {
            builder.face(t.iter().map(|&v| v as usize));
        }
        let (mut result, splits) = builder.build().ok()?;
        // A vertex that had to be doubled is one where the surface was pinched to a point.
        if !splits.is_empty() || result.is_closed() != mesh.is_closed() {
            return None;
        }
        for v in result.vertices().collect::<Vec<_>>() {
            let old = self.vertices[v.index()];
            result.set_position(v, mesh.position(old), mesh.is_given(old));
        }
        result.compact();
        result.file_faults().is_empty().then_some(result)
    }
}

/// Triangles between the corners of a face, by their places in it.
fn face_triangles(mesh: &Mesh, f: FaceId) -> Vec<[usize; 3]> {
    let places: Vec<DVec3> = mesh.face_positions(f);
    match mesh.plane(f).filter(|_| places.len() > 3) {
        Some(plane) => {
            let frame = Frame::on_plane(&plane);
            triangulate(&places.iter().map(|&p| frame.flatten(p)).collect::<Vec<_>>())
        }
        None => (2..places.len()).map(|i| [0, i - 1, i]).collect(),
    }
}

/// Every new face is of the group of the old face nearest to its middle.
fn carry_groups(mesh: &Mesh, result: &mut Mesh) {
    if mesh.faces().all(|f| mesh.group(f).is_none()) {
        return;
    }
    let faces: Vec<FaceId> = result.faces().collect();
    let middles: Vec<DVec3> = faces
        .iter()
        .map(|&f| {
            let places = result.face_positions(f);
            places.iter().sum::<DVec3>() / places.len() as f64
        })
        .collect();
    for (f, near) in faces.into_iter().zip(nearest_faces(mesh, &middles)) {
        if let Some(name) = near.and_then(|near| mesh.group(near)) {
            result.set_group(f, name);
        }
    }
}
