//! The body of few planes per piece: for sheets that do not bend.
//!
//! Every piece touches the body's tangent planes along its rulings. Planes at equal turns of the
//! normal, taken along the rulings from one end of the piece to the other, bound a solid of planar
//! faces around the body, with three at every corner unless the planes are special.

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};

use super::{Glued, GluingError};
use crate::geom::hull::{HalfSpace, Intersect, Numbers, intersect};
use crate::geom::nearest_on_segment;
use crate::geom::polygon::{Location, locate};
use crate::measure::size;
use crate::mesh::{EdgeId, FaceId, Mesh};

/// The most planes for a piece.
const MOST_PLANES: usize = 500;

/// A solid of planes around a body.
#[derive(Debug, Clone)]
pub struct PlanarBody {
    /// The solid; faces carry their planes.
    pub mesh: Mesh,
    /// Edges between planes that follow one another on a piece.
    pub folds: Vec<EdgeId>,
    /// How far its corners lie outside the body at most, in mm.
    pub distance: f64,
    /// Planes that bound no face.
    pub without_face: usize,
    /// Corners at which other than three faces meet.
    pub not_three: usize,
}

/// A plane that touches the body along a ruling.
struct Tangent {
    normal: DVec3,
    offset: f64,
    piece: usize,
}

/// Takes `planes` tangent planes for each piece, at equal turns of the normal.
///
/// # Errors
/// [`GluingError::Planes`] when they do not bound a solid or are too many.
pub fn planar_body(glued: &Glued, planes: usize) -> Result<PlanarBody, GluingError> {
    let fault = |fault: String| GluingError::Planes { planes, fault };
    if !(2..=MOST_PLANES).contains(&planes) {
        return Err(fault(format!("2 to {MOST_PLANES} can be taken")));
    }
    let (mut tangents, mut beside) = (Vec::new(), BTreeSet::new());
    for piece in 0..glued.net.pieces.len() {
        Sampler::new(glued, piece).run(planes, &mut tangents, &mut beside);
    }
    let half_spaces: Vec<HalfSpace> =
        tangents.iter().map(|t| HalfSpace { normal: t.normal, offset: t.offset }).collect();
    let options = Intersect { numbers: Numbers::Constructed, ..Intersect::default() };
    let solid = intersect(&half_spaces, &options).map_err(|e| fault(e.to_string()))?;
    let faces = solid.faces.iter().map(|run| run.iter().map(|&v| v as usize));
    let mesh = Mesh::from_faces(solid.vertices.iter().copied(), faces)
        .map_err(|e| fault(e.to_string()))?;
    let plane_of = |f: FaceId| solid.half_spaces[f.index()] as usize;
    let folds = mesh
        .edges()
        .filter(|&e| {
            let [a, b] = mesh.edge_faces(e).map(plane_of);
            tangents[a].piece == tangents[b].piece && beside.contains(&(a.min(b), a.max(b)))
        })
        .collect();
    let distance = mesh
        .vertices()
        .map(|v| distance_to_body(&glued.mesh, mesh.position(v)))
        .fold(0.0, f64::max);
    Ok(PlanarBody {
        without_face: tangents.len() - mesh.face_count(),
        not_three: mesh.vertices().filter(|&v| mesh.valence(v) != 3).count(),
        folds,
        distance,
        mesh,
    })
}

/// A face on a walk, with the face before and the ruling between, and how far it is from the start,
/// in radians.
type Walked = (usize, Option<(usize, usize)>, f64);

/// The faces of a piece as a tree whose edges are rulings with the angles by which they bend.
struct Sampler<'a> {
    glued: &'a Glued,
    piece: usize,
    /// Face of the mesh → rulings to other faces of the piece.
    near: std::collections::BTreeMap<usize, Vec<(usize, usize)>>,
}

impl<'a> Sampler<'a> {
    fn new(glued: &'a Glued, piece: usize) -> Self {
        let mut near: std::collections::BTreeMap<usize, Vec<(usize, usize)>> =
            glued.net.pieces[piece].faces.iter().map(|f| (f.face, Vec::new())).collect();
        for (i, fold) in glued.net.folds.iter().enumerate().filter(|(_, f)| f.piece.0 == piece) {
            let [a, b] = fold.faces;
            near.entry(a).or_default().push((b, i));
            near.entry(b).or_default().push((a, i));
        }
        Self { glued, piece, near }
    }

    fn turn(&self, fold: usize) -> f64 {
        self.glued.net.folds[fold].fold_angle.to_radians().max(0.0)
    }

    /// Faces from a start in the order of the walk.
    fn walk(&self, start: usize) -> Vec<Walked> {
        let mut order = Vec::new();
        let mut stack = vec![(start, None, 0.0)];
        while let Some((face, before, far)) = stack.pop() {
            order.push((face, before, far));
            let came_from = before.map(|(f, _)| f);
            for &(next, fold) in &self.near[&face] {
                if Some(next) != came_from {
                    stack.push((next, Some((face, fold)), far + self.turn(fold)));
                }
            }
        }
        order
    }

    fn run(
        &self,
        planes: usize,
        tangents: &mut Vec<Tangent>,
        beside: &mut BTreeSet<(usize, usize)>,
    ) {
        let Some(&any) = self.near.keys().next() else { return };
        let farthest =
            |order: &[Walked]| order.iter().max_by(|a, b| a.2.total_cmp(&b.2)).map_or(any, |f| f.0);
        // One end of the piece: the face farthest from any.
        let order = self.walk(farthest(&self.walk(any)));
        let total: f64 = order.iter().filter_map(|o| o.1).map(|(_, fold)| self.turn(fold)).sum();
        let step = total / planes as f64;
        let (mut passed, mut taken) = (0.0, 0);
        // Face → planes that no other plane separates from it.
        let mut region: std::collections::BTreeMap<usize, usize> =
            std::collections::BTreeMap::new();
        let mut touching: Vec<Vec<usize>> = vec![Vec::new()];
        for &(face, before, _) in &order {
            let Some((from, fold)) = before else {
                region.insert(face, 0);
                continue;
            };
            let turn = self.turn(fold);
            let mut here = region[&from];
            while taken < planes && (taken as f64 + 0.5) * step <= passed + turn {
                let part = (((taken as f64 + 0.5) * step - passed) / turn).clamp(0.0, 1.0);
                touching[here].push(tangents.len());
                tangents.push(self.tangent((from, face), fold, part));
                here = touching.len();
                touching.push(vec![tangents.len() - 1]);
                taken += 1;
            }
            region.insert(face, here);
            passed += turn;
        }
        for all in touching {
            for (i, &a) in all.iter().enumerate() {
                beside.extend(all[i + 1..].iter().map(|&b| (a.min(b), a.max(b))));
            }
        }
    }

    /// The plane through a ruling, turned by a part of its angle from one face to the other.
    fn tangent(&self, (from, to): (usize, usize), fold: usize, part: f64) -> Tangent {
        let mesh = &self.glued.mesh;
        let normal = |f: usize| mesh.plane(FaceId::new(f)).map_or(DVec3::Z, |plane| plane.normal());
        let (n, m) = (normal(from), normal(to));
        let across = (m - n * n.dot(m)).normalize_or_zero();
        let angle = self.turn(fold) * part;
        let normal = (n * angle.cos() + across * angle.sin()).normalize_or_zero();
        let ends = self.glued.net.folds[fold].edge.map(crate::mesh::VertexId::new);
        let offset = ends.map(|v| normal.dot(mesh.position(v))).into_iter().fold(0.0_f64, f64::max);
        let offset = mesh.vertices().map(|v| normal.dot(mesh.position(v))).fold(offset, f64::max);
        Tangent { normal, offset, piece: self.piece }
    }
}

/// How far a point outside lies from a convex body.
fn distance_to_body(mesh: &Mesh, p: DVec3) -> f64 {
    let mut nearest = size(mesh).length();
    let mut is_outside = false;
    for f in mesh.faces() {
        let Some(plane) = mesh.plane(f) else { continue };
        let height = (p - plane.point()).dot(plane.normal());
        if height <= 0.0 {
            continue;
        }
        is_outside = true;
        let corners = mesh.face_positions(f);
        let (x, y) = plane.normal().any_orthonormal_pair();
        let flat = |q: DVec3| DVec2::new(q.dot(x), q.dot(y));
        let outline: Vec<DVec2> = corners.iter().map(|&q| flat(q)).collect();
        let beside = if locate(&outline, flat(p)) == Location::Outside {
            let n = corners.len();
            (0..n)
                .map(|i| nearest_on_segment(p, [corners[i], corners[(i + 1) % n]]).distance(p))
                .fold(f64::MAX, f64::min)
        } else {
            height
        };
        nearest = nearest.min(beside);
    }
    if is_outside { nearest } else { 0.0 }
}
