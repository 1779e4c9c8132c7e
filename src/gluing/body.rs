//! The whole way from outlines to the body's mesh and its pieces.

use glam::{DVec2, DVec3};

use super::alexandrov::{Continuation, Effort};
use super::overlay::{Overlay, SeamPart, overlay};
use super::place::place;
use super::rims::Rims;
use super::surface::Surface;
use super::trace::trace;
use super::{Gluing, GluingError};
use crate::geom::polygon::{bounds, smallest_rectangle};
use crate::measure::{convexity, edge_length, fold_angle, size};
use crate::mesh::{HalfEdgeId, HalfEdgeMap, Mesh};
use crate::net::{
    EdgeLabel, FlatFace, Fold, FoldKind, MeshCounts, Net, Piece, PieceId, Proof, Seam, SeamSide,
};
use crate::progress::Progress;

/// First distances of the apex, in times the extent of the surface: a further one where a nearer
/// one leads nowhere.
const FAR: [f64; 3] = [30.0, 300.0, 3000.0];
/// How little of the curvatures is left when corners are placed; less where that does not do.
const LEFT: [f64; 3] = [1e-6, 1e-8, 1e-10];
/// Edges of the body are those of the pieces within that part of its size.
const TRUE_EDGES: f64 = 1e-12;
/// Material at a corner of the body is that of the pieces within so many radians.
const TRUE_ANGLES: f64 = 1e-9;

/// A body that outlines close to.
#[derive(Debug, Clone)]
pub struct Glued {
    /// The convex body. Its edges are seams, and rulings along which the pieces bend.
    pub mesh: Mesh,
    /// The pieces, one for each outline in its own shape; proof still to come.
    pub net: Net,
    /// What was measured.
    pub facts: GluedFacts,
}

/// What was measured on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct GluedFacts {
    /// Points of the surface where material is missing.
    pub corners: usize,
    /// Newton steps and flips that the search took.
    pub newton: usize,
    /// See above.
    pub flips: usize,
    /// How far edges of the body differ from those of the pieces at most, in parts of its size.
    pub edge_error: f64,
    /// How far the material at a corner differs, in radians.
    pub angle_error: f64,
    /// For each piece how far its chords leave the outline, in mm.
    pub off_outline: Vec<f64>,
}

/// Joins outlines and solves for the body.
///
/// # Errors
/// See [`GluingError`]. A body that is not convex, or whose edges or angles are not those of the
/// pieces, is never returned.
pub fn glue(gluing: &Gluing, progress: &dyn Progress) -> Result<Glued, GluingError> {
    let rims = gluing.rims()?;
    if let Some(shape) = rims.mirrored() {
        return Err(GluingError::FoldsFlat { size: smallest_rectangle(&shape) });
    }
    let (surface, directions) = Surface::new(&rims)?;
    let mut tried = Err(GluingError::Cancelled);
    for far in FAR {
        tried = Continuation::new(surface.clone(), far).and_then(|start| placed(start, progress));
        if !matches!(tried, Err(GluingError::NotFound { .. })) {
            break;
        }
    }
    let (surface, places, effort) = tried?;
    let places = upright(&places, &rims);
    let traced = trace(&surface, &rims, &directions)?;
    let overlay = overlay(&surface, &rims, &traced, places)?;
    let mesh = mesh(&overlay)?;
    let net = Pieces::new(&mesh, &rims, &overlay)?.net();
    let (edge_error, angle_error) = measured(&mesh, &net, &rims);
    let facts = GluedFacts {
        corners: rims.vertices,
        newton: effort.newton,
        flips: effort.flips,
        edge_error,
        angle_error,
        off_outline: rims.pieces.iter().map(|p| p.off).collect(),
    };
    check(&mesh, &facts)?;
    Ok(Glued { mesh, net, facts })
}

fn placed(
    mut continuation: Continuation,
    progress: &dyn Progress,
) -> Result<(Surface, Vec<DVec3>, Effort), GluingError> {
    let mut last = None;
    for left in LEFT {
        match continuation.lead_to(left, progress) {
            Ok(()) => {}
            Err(error) => return Err(last.unwrap_or(error)),
        }
        let mut surface = continuation.surface.clone();
        match place(&mut surface, &continuation.r, progress) {
            Ok((mut places, _)) => {
                let middle = places.iter().sum::<DVec3>() / places.len() as f64;
                places.iter_mut().for_each(|p| *p -= middle);
                return Ok((surface, places, continuation.effort));
            }
            Err(error @ GluingError::NotFound { .. }) => last = Some(error),
            Err(error) => return Err(error),
        }
    }
    Err(last.unwrap_or(GluingError::Cancelled))
}

/// Turned so that the first piece lies on top, as nearly as can be as it was drawn.
fn upright(places: &[DVec3], rims: &Rims) -> Vec<DVec3> {
    let (mut x, mut y) = (DVec3::ZERO, DVec3::ZERO);
    for (p, &v) in rims.pieces[0].points.iter().zip(&rims.pieces[0].vertex) {
        x += p.x * places[v];
        y += p.y * places[v];
    }
    let x = x.normalize_or_zero();
    let y = (y - y.dot(x) * x).normalize_or_zero();
    if x == DVec3::ZERO || y == DVec3::ZERO {
        return places.to_vec();
    }
    let z = x.cross(y);
    places.iter().map(|p| DVec3::new(p.dot(x), p.dot(y), p.dot(z))).collect()
}

fn mesh(overlay: &Overlay) -> Result<Mesh, GluingError> {
    let faces = overlay.faces.iter().map(|f| f.iter().copied());
    let mut mesh = Mesh::from_faces(overlay.places.iter().copied(), faces)
        .map_err(|error| GluingError::NotTrue { fault: error.to_string() })?;
    let seams: Vec<_> = mesh
        .edges()
        .filter(|&e| {
            let [a, b] = mesh.edge_vertices(e).map(|v| v.index());
            overlay.seams.contains_key(&(a, b))
        })
        .collect();
    seams.into_iter().for_each(|e| mesh.set_seam(e, true));
    Ok(mesh)
}

fn check(mesh: &Mesh, facts: &GluedFacts) -> Result<(), GluingError> {
    let not_true = |fault: String| Err(GluingError::NotTrue { fault });
    let convex = convexity(mesh);
    if !convex.is_convex() {
        return not_true(format!(
            "{} edges and {} faces bend inwards, by {:.1e} mm at most{}",
            convex.concave_edges.len(),
            convex.concave_faces.len(),
            convex.deepest_mm,
            if convex.is_ball { "" } else { "; it is no closed ball" },
        ));
    }
    if facts.edge_error > TRUE_EDGES || facts.edge_error.is_nan() {
        return not_true(format!("an edge is off by {:.1e} of the size", facts.edge_error));
    }
    if facts.angle_error > TRUE_ANGLES || facts.angle_error.is_nan() {
        return not_true(format!(
            "the material at a corner is off by {:.1e} rad",
            facts.angle_error
        ));
    }
    Ok(())
}

/// Lengths and angles of the mesh against those of the pieces, by the positions alone.
fn measured(mesh: &Mesh, net: &Net, rims: &Rims) -> (f64, f64) {
    let (mut edge, mut material) = (0.0_f64, vec![0.0; mesh.vertex_count()]);
    for face in net.pieces.iter().flat_map(|p| &p.faces) {
        let n = face.vertices.len();
        let at = |i: usize| mesh.position(crate::mesh::VertexId::new(face.vertices[i % n]));
        for i in 0..n {
            let flat = face.polygon[i].distance(face.polygon[(i + 1) % n]);
            edge = edge.max((flat - at(i).distance(at(i + 1))).abs());
            let (a, b) = (at(i + 1) - at(i), at(i + n - 1) - at(i));
            material[face.vertices[i]] += a.cross(b).length().atan2(a.dot(b));
        }
    }
    let angles = rims.cone_angles();
    let angle = angles.iter().zip(&material).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    (edge / size(mesh).length(), angle)
}

/// The pieces of a mesh whose seams are known.
struct Pieces<'a> {
    mesh: &'a Mesh,
    rims: &'a Rims,
    seams: &'a std::collections::BTreeMap<(usize, usize), SeamPart>,
    /// Half-edge → where its origin lies in the piece of its face.
    flat: HalfEdgeMap<DVec2>,
    /// Half-edge → the piece of its face.
    piece: HalfEdgeMap<usize>,
}

impl<'a> Pieces<'a> {
    fn new(mesh: &'a Mesh, rims: &'a Rims, overlay: &'a Overlay) -> Result<Self, GluingError> {
        let mut pieces = Self {
            mesh,
            rims,
            seams: &overlay.seams,
            flat: HalfEdgeMap::filled(mesh.half_edge_slots(), DVec2::ZERO),
            piece: HalfEdgeMap::filled(mesh.half_edge_slots(), 0),
        };
        for f in mesh.faces() {
            for h in mesh.face_half_edges(f) {
                let part = pieces.seam_beside(h).ok_or_else(|| GluingError::NotTrue {
                    fault: format!("a corner of face {} lies on no seam", f.index()),
                })?;
                pieces.piece[h] = part.piece;
                pieces.flat[h] = pieces.point(part.piece, part.side, part.from);
            }
            let mut of = mesh.face_half_edges(f).map(|h| pieces.piece[h]);
            let first = of.next();
            if of.any(|p| Some(p) != first) {
                let fault = format!("face {} lies on two pieces", f.index());
                return Err(GluingError::NotTrue { fault });
            }
        }
        Ok(pieces)
    }

    fn ends(&self, h: HalfEdgeId) -> (usize, usize) {
        (self.mesh.origin(h).index(), self.mesh.target(h).index())
    }

    /// The seam that bounds the piece of a corner clockwise of it.
    fn seam_beside(&self, h: HalfEdgeId) -> Option<SeamPart> {
        let mut at = h;
        for _ in 0..self.mesh.half_edge_slots() {
            if let Some(&part) = self.seams.get(&self.ends(at)) {
                return Some(part);
            }
            at = self.mesh.next(at.twin());
        }
        None
    }

    /// A point of a side, the piece's box beginning at the origin.
    fn point(&self, piece: usize, side: usize, along: f64) -> DVec2 {
        let rim = &self.rims.pieces[piece];
        let low = bounds(&rim.points).map_or(DVec2::ZERO, |b| b.0);
        let d = rim.side(side);
        rim.points[side] - low + if along == 0.0 { DVec2::ZERO } else { d * (along / d.length()) }
    }

    fn net(&self) -> Net {
        let mesh = self.mesh;
        let mut pieces: Vec<Piece> = (0..self.rims.pieces.len())
            .map(|p| Piece {
                id: PieceId(p),
                outline: self.outline(p),
                holes: Vec::new(),
                faces: Vec::new(),
            })
            .collect();
        for f in mesh.faces() {
            let sides: Vec<HalfEdgeId> = mesh.face_half_edges(f).collect();
            pieces[self.piece[sides[0]]].faces.push(FlatFace {
                face: f.index(),
                vertices: sides.iter().map(|&h| mesh.origin(h).index()).collect(),
                polygon: sides.iter().map(|&h| self.flat[h]).collect(),
            });
        }
        let (mut folds, mut seams) = (Vec::new(), Vec::new());
        for e in mesh.edges() {
            let [h, t] = e.half_edges();
            let edge = mesh.edge_vertices(e).map(|v| v.index());
            let faces = [h, t].map(|h| mesh.face(h).index());
            let angle = fold_angle(mesh, e).unwrap_or(0.0);
            let forward = |h: HalfEdgeId| [self.flat[h], self.flat[mesh.next(h)]];
            let segment = |h: HalfEdgeId| {
                let [a, b] = forward(h);
                if self.ends(h).0 == edge[0] { [a, b] } else { [b, a] }
            };
            let fold_angle = angle.to_degrees();
            let id = EdgeLabel(e.index());
            if mesh.is_seam(e) {
                let side = |h: HalfEdgeId| SeamSide {
                    piece: PieceId(self.piece[h]),
                    face: mesh.face(h).index(),
                    segment: segment(h),
                };
                let length = edge_length(mesh, e);
                seams.push(Seam { id, edge, length, fold_angle, sides: [side(h), side(t)] });
            } else {
                let piece = PieceId(self.piece[h]);
                let kind = match angle {
                    a if a.abs() <= FLAT_FOLD => FoldKind::Flat,
                    a if a > 0.0 => FoldKind::Mountain,
                    _ => FoldKind::Valley,
                };
                let segment = segment(h);
                folds.push(Fold { id, edge, piece, faces, segment, fold_angle, kind });
            }
        }
        let counts = MeshCounts {
            vertices: mesh.vertex_count(),
            edges: mesh.edge_count(),
            faces: mesh.face_count(),
        };
        Net { scale: 1.0, counts, pieces, folds, seams, rims: Vec::new(), proof: Proof::default() }
    }

    /// The rim of a piece with all points of the mesh on it.
    fn outline(&self, piece: usize) -> Vec<DVec2> {
        let mut parts: Vec<&SeamPart> = self.seams.values().filter(|s| s.piece == piece).collect();
        parts.sort_by(|a, b| a.side.cmp(&b.side).then(a.from.total_cmp(&b.from)));
        parts.into_iter().map(|s| self.point(s.piece, s.side, s.from)).collect()
    }
}

/// As unfolding has it: less is flat, in radians.
const FLAT_FOLD: f64 = 1e-6;
