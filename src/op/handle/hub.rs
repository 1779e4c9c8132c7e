//! A handle among three or more faces: a tube from each of them to one hub.
//!
//! The hub is a convex solid of its own: around one point lie as many regular polygons as there are
//! faces, each turned towards its face, with as many sides, and small enough to be apart from the
//! others; the hub is their convex hull, so each of them is one of its faces. Tubes join the faces
//! to them. A hub and the first tube leave the genus as it is, and each further tube adds one: k
//! faces of one component add k − 1, and faces of different components become one component.
//!
//! Faces that look to one side get a hub outside, as far above all of them as they are wide (or as
//! the first weight says). Faces that look all ways, or negative weights, get a hollow hub in their
//! midst, turned inside out, and tunnels to it. No source: Srinivasan 2004 leaves it as future work
//! (VIII.4).
//!
//! Element ids are those of the mesh without gaps, since the hub is built in; the hub takes numbers
//! behind them.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::{Course, FaceCorner, HandleParams, HandleReport, Join, OpContext, OpError, find, join};
use crate::geom::hull::{Numbers, convex_hull};
use crate::measure::face_centroid;
use crate::mesh::{
    FaceId, FaceMap, HalfEdgeId, HalfEdgeMap, Mesh, VertexId, VertexMap, WalkBuilder,
};
use crate::select::NewElements;

/// The mean of the normals is shorter than this where faces look all ways.
const ALL_WAYS: f64 = 0.25;
/// A face looks to the hub's side when its normal has this share of the way.
const LOOKS_THERE: f64 = 0.05;
/// The hub's polygons take this share of the room between two directions, and at most so much
/// (radians).
const ROOM: f64 = 0.45;
const WIDEST: f64 = 0.6;
/// Directions nearer to each other than this leave no room (radians).
const NARROWEST: f64 = 0.2;
/// The hub takes this share of the way to the nearest face at most, and its polygons are so large
/// compared with the smallest face.
const LARGEST: f64 = 0.5;
const PORT: f64 = 0.9;

/// A face that is to be joined.
struct End {
    corner: FaceCorner,
    centroid: DVec3,
    normal: DVec3,
    /// From the centroid to the first corner.
    first: DVec3,
    sides: usize,
    radius: f64,
}

/// The regular polygons around a hub, one for each face.
struct Ports {
    points: Vec<DVec3>,
    /// For each face which of the points are the corners of its polygon.
    corners: Vec<std::ops::Range<usize>>,
}

impl Ports {
    /// For each port its face of the hub; `None` when one of them is no face of it.
    fn faces(&self, polygons: &[Vec<u32>], hub_faces: &[FaceId]) -> Option<Vec<FaceId>> {
        let face = |port: &std::ops::Range<usize>| {
            let is_port = |polygon: &Vec<u32>| {
                polygon.len() == port.len() && polygon.iter().all(|&i| port.contains(&(i as usize)))
            };
            polygons.iter().position(is_port).map(|i| hub_faces[i])
        };
        self.corners.iter().map(face).collect()
    }
}

/// Where the hub lies.
struct Hub {
    centre: DVec3,
    /// Hollow, with tunnels that lead to it.
    is_inside: bool,
}

pub(super) fn hub(
    mesh: &Mesh,
    params: &HandleParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, HandleReport), OpError> {
    let refuse = |reason| OpError::NoHandle { from: params.from.face, to: params.to.face, reason };
    let ends = ends(mesh, params)?;
    let weights = params.weights.map(|w| w.0.map(crate::units::Length::mm));
    let hub = Hub::among(&ends, weights).map_err(refuse)?;
    let ports = hub.ports(&ends).map_err(refuse)?;
    let no_room = "there is no room for a hub between them; choose other faces";
    let hull = convex_hull(&ports.points, Numbers::Constructed).map_err(|_| refuse(no_room))?;
    let polygons: Vec<Vec<u32>> = hull.iter().map(<[u32]>::to_vec).collect();
    let with_hub = WithHub::build(mesh, &ports.points, &polygons, hub.is_inside);
    let port_faces = ports.faces(&polygons, &with_hub.hub_faces).ok_or_else(|| refuse(no_room))?;
    let mut report = HandleReport { made: with_hub.made(&port_faces), ..HandleReport::default() };
    let course = weights
        .map_or(Course::Free { sign: if hub.is_inside { -1.0 } else { 1.0 } }, Course::Weighed);
    let WithHub { mesh: mut made_mesh, moved, .. } = with_hub;
    for (i, (end, &port)) in ends.iter().zip(&port_faces).enumerate() {
        context.progress.report("joining faces", i, ends.len());
        let from = moved.corner(end.corner);
        let to = FaceCorner { face: port.index() as u32, vertex: None };
        let joined_by =
            Join { from, to, segments: params.segments, twist: params.twist.radians(), course };
        let (next, tube) = join(&made_mesh, &joined_by, context)?;
        made_mesh = next;
        report.made.faces.extend(tube.made.faces);
        report.made.vertices.extend(tube.made.vertices);
        report.crossing.extend(tube.crossing);
        report.halved += tube.halved;
    }
    report.crossing.sort_unstable();
    report.crossing.dedup();
    report.made.faces.sort_unstable();
    report.made.vertices.sort_unstable();
    Ok((made_mesh, report))
}

/// The faces that are to be joined, each once.
fn ends(mesh: &Mesh, params: &HandleParams) -> Result<Vec<End>, OpError> {
    let corners = [params.from, params.to].into_iter().chain(params.also.iter().copied());
    let ends: Vec<End> = corners.map(|corner| End::of(mesh, corner)).collect::<Result<_, _>>()?;
    let is_twin = |i: usize| ends[..i].iter().any(|other| other.corner.face == ends[i].corner.face);
    if (1..ends.len()).any(is_twin) {
        let reason = "one face is named twice among those to be joined; name each once";
        return Err(OpError::NoHandle { from: params.from.face, to: params.to.face, reason });
    }
    Ok(ends)
}

impl End {
    fn of(mesh: &Mesh, corner: FaceCorner) -> Result<Self, OpError> {
        let start = find(mesh, corner)?;
        let f = mesh.face(start);
        let centroid = face_centroid(mesh, f);
        let normal = mesh.plane(f).ok_or(OpError::NoArea(f))?.normal();
        let ways: Vec<f64> = mesh.face_positions(f).iter().map(|p| p.distance(centroid)).collect();
        let first = mesh.position(mesh.origin(start)) - centroid;
        let radius = ways.iter().sum::<f64>() / ways.len() as f64;
        Ok(Self { corner, centroid, normal, first, sides: ways.len(), radius })
    }
}

impl Hub {
    fn among(ends: &[End], weights: Option<[f64; 2]>) -> Result<Self, &'static str> {
        let count = ends.len() as f64;
        let middle = ends[0].centroid
            + ends.iter().map(|e| e.centroid - ends[0].centroid).sum::<DVec3>() / count;
        let mean = ends.iter().map(|e| e.normal).sum::<DVec3>() / count;
        let is_inside = weights.map_or(mean.length() < ALL_WAYS, |w| w[0] < 0.0);
        if is_inside {
            let faces_it = |e: &End| (e.centroid - middle).dot(e.normal) > LOOKS_THERE * e.radius;
            let hub = Self { centre: middle, is_inside };
            return if ends.iter().all(faces_it) {
                Ok(hub)
            } else {
                Err("the middle of the faces does not lie behind all of them, so that no tunnels \
                    can meet there; choose other faces")
            };
        }
        let up = mean.normalize_or_zero();
        let mut lift: f64 = 0.0;
        for e in ends {
            let share = up.dot(e.normal);
            if share <= LOOKS_THERE {
                return Err(
                    "the faces look to different sides, so that no hub outside can be seen from \
                    all; negative weights lead tunnels inside",
                );
            }
            let height = weights.map_or(2.0 * e.radius, |w| w[0]);
            lift = lift.max((height - (middle - e.centroid).dot(e.normal)) / share);
        }
        Ok(Self { centre: middle + up * lift, is_inside })
    }

    /// The polygons around the hub.
    fn ports(&self, ends: &[End]) -> Result<Ports, &'static str> {
        let aims: Vec<DVec3> = ends.iter().map(|end| self.aim(end)).collect();
        let nearest = nearest_directions(&aims);
        // NaN, for an aim without length, is refused, too.
        if nearest.is_nan() || nearest < NARROWEST {
            return Err(
                "two of the faces lead to the hub from the same side and leave no room between \
                their tubes; leave one out",
            );
        }
        let width = (ROOM * nearest).min(WIDEST);
        let smallest = ends.iter().map(|e| e.radius).fold(f64::INFINITY, f64::min);
        let reach = aims.iter().map(|a| a.length()).fold(f64::INFINITY, f64::min);
        let radius = (PORT * smallest / width.sin()).min(LARGEST * reach);
        let mut ports = Ports { points: Vec::new(), corners: Vec::new() };
        for (end, aim) in ends.iter().zip(&aims) {
            let towards = aim.normalize();
            let leaves = if self.is_inside { end.normal } else { -end.normal };
            let across = DQuat::from_rotation_arc(leaves, towards) * end.first;
            let x = (across - towards * across.dot(towards))
                .normalize_or(towards.any_orthonormal_vector());
            let y = towards.cross(x);
            let start = ports.points.len();
            for k in 0..end.sides {
                let (sin, cos) = (TAU * k as f64 / end.sides as f64).sin_cos();
                let out = towards * width.cos() + (x * cos + y * sin) * width.sin();
                ports.points.push(self.centre + out * radius);
            }
            ports.corners.push(start..ports.points.len());
        }
        Ok(ports)
    }

    /// From the hub towards a face, or towards a point half-way above it.
    fn aim(&self, end: &End) -> DVec3 {
        let above = (self.centre - end.centroid).dot(end.normal);
        let from =
            if self.is_inside { end.centroid } else { end.centroid + end.normal * (0.5 * above) };
        from - self.centre
    }
}

/// The least angle between two directions, in radians.
fn nearest_directions(aims: &[DVec3]) -> f64 {
    let mut nearest = std::f64::consts::PI;
    for i in 1..aims.len() {
        for j in 0..i {
            nearest = nearest.min(aims[i].angle_between(aims[j]));
        }
    }
    nearest
}

/// Where the elements of a mesh went.
struct Moved {
    vertices: VertexMap<VertexId>,
    faces: FaceMap<FaceId>,
    sides: HalfEdgeMap<HalfEdgeId>,
}

impl Moved {
    /// Copies a mesh without its gaps.
    fn copy(mesh: &Mesh, walks: &mut WalkBuilder) -> Self {
        let mut vertices = VertexMap::filled(mesh.vertex_slots(), VertexId::new(0));
        let mut faces = FaceMap::filled(mesh.face_slots(), FaceId::new(0));
        let mut sides = HalfEdgeMap::filled(mesh.half_edge_slots(), HalfEdgeId(u32::MAX));
        mesh.vertices().for_each(|v| vertices[v] = walks.vertex(mesh.position(v)));
        for e in mesh.edges() {
            let [h, t] = e.half_edges();
            sides[h] = walks.edge(vertices[mesh.origin(h)], vertices[mesh.origin(t)]);
            sides[t] = sides[h].twin();
        }
        for f in mesh.faces() {
            faces[f] = walks.face(mesh.face_half_edges(f).map(|h| sides[h]));
        }
        Self { vertices, faces, sides }
    }

    fn corner(&self, old: FaceCorner) -> FaceCorner {
        let face = self.faces[FaceId::new(old.face as usize)].index() as u32;
        let vertex = old.vertex.map(|v| self.vertices[VertexId::new(v as usize)].index() as u32);
        FaceCorner { face, vertex }
    }

    /// Gives the copy what the mesh knew: which positions are given, groups, planes, seams.
    fn dress(&self, mesh: &Mesh, copy: &mut Mesh) {
        for v in mesh.vertices() {
            copy.set_position(self.vertices[v], mesh.position(v), mesh.is_given(v));
        }
        for f in mesh.faces() {
            if let Some(name) = mesh.group(f) {
                copy.set_group(self.faces[f], name);
            }
            if let Some(plane) = mesh.carried_plane(f) {
                copy.set_plane(self.faces[f], plane);
            }
        }
        for e in mesh.edges().filter(|&e| mesh.is_seam(e)) {
            copy.set_seam(self.sides[e.half_edge()].edge(), true);
        }
    }
}

/// The mesh, without gaps, and the hub as a component more.
struct WithHub {
    mesh: Mesh,
    /// Where the elements of the mesh went.
    moved: Moved,
    /// In the order of the polygons.
    hub_faces: Vec<FaceId>,
    hub_vertices: usize,
}

impl WithHub {
    fn build(mesh: &Mesh, points: &[DVec3], polygons: &[Vec<u32>], is_turned: bool) -> Self {
        let mut walks = WalkBuilder::with_capacity(
            mesh.vertex_count() + points.len(),
            mesh.edge_count() + 3 * points.len(),
            mesh.face_count() + polygons.len(),
        );
        let moved = Moved::copy(mesh, &mut walks);
        let hub_faces = add_polygons(&mut walks, points, polygons, is_turned);
        let mut joined = walks.build();
        moved.dress(mesh, &mut joined);
        Self { mesh: joined, moved, hub_faces, hub_vertices: points.len() }
    }

    /// What is new: the hub, without the faces that tubes will take.
    fn made(&self, port_faces: &[FaceId]) -> NewElements {
        let faces = self.hub_faces.iter().copied().filter(|f| !port_faces.contains(f)).collect();
        let first = self.mesh.vertex_slots() - self.hub_vertices;
        let vertices = (first..self.mesh.vertex_slots()).map(VertexId::new).collect();
        NewElements { faces, vertices, ..NewElements::default() }
    }
}

/// Adds a closed component by its polygons; returns the faces in their order.
fn add_polygons(
    walks: &mut WalkBuilder,
    points: &[DVec3],
    polygons: &[Vec<u32>],
    is_turned: bool,
) -> Vec<FaceId> {
    let corners: Vec<VertexId> = points.iter().map(|&p| walks.vertex(p)).collect();
    let mut edges: Vec<([u32; 2], HalfEdgeId)> = Vec::new();
    let mut made = Vec::with_capacity(polygons.len());
    for polygon in polygons {
        let mut around = polygon.clone();
        if is_turned {
            around.reverse();
        }
        let mut walk = Vec::with_capacity(around.len());
        for i in 0..around.len() {
            let [a, b] = [around[i], around[(i + 1) % around.len()]];
            let known = edges.iter().find(|(ends, _)| *ends == [b, a]).map(|(_, h)| h.twin());
            walk.push(known.unwrap_or_else(|| {
                let h = walks.edge(corners[a as usize], corners[b as usize]);
                edges.push(([a, b], h));
                h
            }));
        }
        made.push(walks.face(walk));
    }
    made
}
