//! What is to be drawn, projected and coloured: facets, lines and dots.

use glam::{DVec2, DVec3};

use super::camera::Camera;
use super::marks::{Marks, Owner, Rank, Tag};
use super::paint::{self, Light, Modelling};
use super::params::{EdgeLines, Ids, Shadow, Surface};
use super::smooth::{Normals, Slope};
use super::{Colour, RenderParams};
use crate::geom::{Frame, Plane, triangulate};
use crate::mesh::{EdgeId, FaceId, FaceMap, HalfEdgeId, HalfEdgeMap, Mesh, VertexId, VertexMap};

/// Faces that are bent by more than this part of their size are cut into triangles; flatter ones
/// are drawn whole.
const BENT: f64 = 1e-3;
/// Faces with more corners are always drawn whole: where one crosses itself, cutting takes the
/// square of their number.
const MAX_CUT_CORNERS: usize = 256;

/// How far soft shadows reach, relative to the longer side of the picture.
const SHADOW: f64 = 0.03;

/// A polygon in the picture with the plane of its depth.
pub(super) struct Facet {
    /// The face that it is (a part of).
    pub face: FaceId,
    /// Its corners in [`Scene::corners`].
    pub corners: std::ops::Range<usize>,
    /// How much it is pointed out.
    pub rank: Rank,
    /// Its colour.
    pub light: Light,
    /// How its normal runs where it is shaded smoothly, with the colour of the material.
    pub smooth: Option<(Slope, [u8; 3], Modelling)>,
    /// Highest and lowest corner, in pixels.
    pub top: f64,
    pub bottom: f64,
    anchor: DVec3,
    slope: DVec2,
    depths: (f64, f64),
}

impl Facet {
    /// The depth at a point of the picture. Kept between the depths of the corners, because
    /// rounding tilts facets that are seen from the edge.
    pub fn depth(&self, x: f64, y: f64) -> f64 {
        let depth =
            self.anchor.z + self.slope.x * (x - self.anchor.x) + self.slope.y * (y - self.anchor.y);
        depth.clamp(self.depths.0, self.depths.1)
    }
}

/// An edge in the picture.
#[derive(Clone)]
pub(super) struct Line {
    pub ends: [DVec3; 2],
    /// The faces whose sight makes the edge seen.
    pub faces: [FaceId; 2],
    /// Full width in pixels.
    pub width: f64,
    /// Opacity in 0..=1.
    pub strength: f32,
    /// Whether one of its faces is seen from the front and the other from the back, or is missing.
    pub is_outline: bool,
    pub ink: Ink,
}

/// The colour of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Ink {
    Edge,
    Rim,
    /// Pointed out.
    Mark,
    /// Around a slicing plane.
    Plane,
}

impl Ink {
    pub fn colour(self) -> [u8; 3] {
        match self {
            Self::Edge => paint::LINE,
            Self::Rim => paint::RIM,
            Self::Mark => paint::MARK,
            Self::Plane => paint::PLANE_LINE,
        }
    }
}

/// A vertex in the picture.
pub(super) struct Dot {
    pub place: DVec3,
    pub vertex: VertexId,
    pub colour: [u8; 3],
}

/// All that is to be drawn, in pixels.
pub(super) struct Scene {
    pub corners: Vec<DVec3>,
    pub facets: Vec<Facet>,
    pub lines: Vec<Line>,
    pub dots: Vec<Dot>,
    /// Radius of the dots in pixels.
    pub dot_radius: f64,
    /// Numbers.
    pub tags: Vec<Tag>,
    /// Whether what is behind shows through.
    pub is_x_ray: bool,
    /// How far shadows reach, in pixels; 0 for none.
    pub shadow: f64,
}

impl Scene {
    /// The light of a facet at a point of the picture.
    pub fn light(&self, facet: usize, x: f64, y: f64) -> Light {
        let facet = &self.facets[facet];
        match &facet.smooth {
            None => facet.light,
            Some((slope, colour, modelling)) => paint::lit(*colour, slope.at(x, y), *modelling),
        }
    }
}

/// The thickness of a normal line in pixels: grows with the picture.
pub(super) fn line_width(width: u32, height: u32) -> f64 {
    (1.25 * f64::from(width.max(height)) / 1200.0).max(0.6)
}

impl Scene {
    /// Projects and colours the faces, edges and vertices. `colours` are those of the faces seen
    /// from the front.
    pub fn new(
        mesh: &Mesh,
        params: &RenderParams,
        camera: &Camera,
        (colours, marks): (&FaceMap<[u8; 3]>, &Marks),
    ) -> Self {
        let mut stage = Stage::new(mesh, params, camera);
        let corners = mesh.faces().map(|f| mesh.sides(f)).sum();
        stage.scene.corners.reserve(corners);
        stage.scene.facets.reserve(mesh.face_count());
        stage.ranks = marks.ranks(mesh);
        for f in mesh.faces() {
            stage.add_face(f, colours[f]);
        }
        if params.edges == EdgeLines::On {
            stage.scene.lines = mesh.edges().filter_map(|e| stage.line(e)).collect();
        }
        if params.colour == Colour::Valence {
            stage.add_dots();
        }
        stage.add_marks(marks);
        stage.add_tags(params.ids, marks);
        stage.scene
    }
}

/// A scene in the making.
struct Stage<'a> {
    mesh: &'a Mesh,
    plain: bool,
    /// Pixels per half diagonal.
    scale: f64,
    line_width: f64,
    /// Positions in half diagonals, turned as the camera.
    turned: VertexMap<DVec3>,
    /// Positions in the picture.
    places: VertexMap<DVec3>,
    /// Unit normals, turned as the camera; zero for faces without area.
    normals: FaceMap<DVec3>,
    /// Areas in square pixels as if seen from straight ahead.
    areas: FaceMap<f64>,
    /// How much each face is pointed out.
    ranks: FaceMap<Rank>,
    /// Whether the part of the face at the half-edge is seen from the front.
    fronts: HalfEdgeMap<bool>,
    /// Normals of smooth shading, where it is asked for.
    smooth: Option<Normals>,
    scene: Scene,
}

impl<'a> Stage<'a> {
    fn new(mesh: &'a Mesh, params: &RenderParams, camera: &Camera) -> Self {
        let mut turned = VertexMap::filled(mesh.vertex_slots(), DVec3::ZERO);
        let mut places = VertexMap::filled(mesh.vertex_slots(), DVec3::ZERO);
        for v in mesh.vertices() {
            turned[v] = camera.turned(mesh.position(v));
            places[v] = camera.project(mesh.position(v));
        }
        let (width, height) = params.pixels();
        let scene = Scene {
            corners: Vec::new(),
            facets: Vec::new(),
            lines: Vec::new(),
            dots: Vec::new(),
            dot_radius: 0.0,
            tags: Vec::new(),
            is_x_ray: params.surface == Surface::XRay,
            shadow: match params.shadow {
                Shadow::Off => 0.0,
                Shadow::Soft => SHADOW * f64::from(width.max(height)),
            },
        };
        let is_smooth = params.surface == Surface::Smooth;
        Self {
            mesh,
            plain: params.colour == Colour::Faces,
            scale: camera.scale(),
            line_width: line_width(width, height),
            turned,
            places,
            normals: FaceMap::filled(mesh.face_slots(), DVec3::ZERO),
            areas: FaceMap::filled(mesh.face_slots(), 0.0),
            ranks: FaceMap::filled(mesh.face_slots(), Rank::Plain),
            fronts: HalfEdgeMap::filled(mesh.half_edge_slots(), true),
            smooth: is_smooth.then(|| Normals::new(mesh, |v| camera.turned(mesh.position(v)))),
            scene,
        }
    }

    fn add_face(&mut self, f: FaceId, colour: [u8; 3]) {
        let half_edges: Vec<HalfEdgeId> = self.mesh.face_half_edges(f).collect();
        let vertices = half_edges.iter().map(|&h| self.mesh.origin(h));
        let turned: Vec<DVec3> = vertices.map(|v| self.turned[v]).collect();
        let Some(plane) = Plane::newell(&turned) else { return };
        self.normals[f] = plane.normal();
        self.areas[f] = newell(&turned).length() / 2.0 * self.scale * self.scale;
        if is_bent(&turned, &plane) || (self.smooth.is_some() && turned.len() > 3) {
            let frame = Frame::on_plane(&plane);
            let flat: Vec<DVec2> = turned.iter().map(|&p| frame.flatten(p)).collect();
            for triangle in triangulate(&flat) {
                let normal = Plane::newell(&triangle.map(|i| turned[i]))
                    .map_or(plane.normal(), |p| p.normal());
                let is_front = self.add_facet(f, &triangle.map(|i| half_edges[i]), normal, colour);
                // The sides of the triangle that are edges of the face, not cuts.
                for (i, j) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (triangle[i], triangle[j])) {
                    if (i + 1) % half_edges.len() == j {
                        self.fronts[half_edges[i]] = is_front;
                    }
                }
            }
        } else {
            let is_front = self.add_facet(f, &half_edges, plane.normal(), colour);
            for h in half_edges {
                self.fronts[h] = is_front;
            }
        }
    }

    /// Adds the polygon of the origins of `half_edges`; says whether its front is seen.
    fn add_facet(
        &mut self,
        face: FaceId,
        half_edges: &[HalfEdgeId],
        normal: DVec3,
        colour: [u8; 3],
    ) -> bool {
        let start = self.scene.corners.len();
        self.scene.corners.extend(half_edges.iter().map(|&h| self.places[self.mesh.origin(h)]));
        let places = &self.scene.corners[start..];
        let tilt = newell(places);
        // y runs down in the picture, so the front runs clockwise.
        let is_front = tilt.z < 0.0;
        if tilt.z == 0.0 {
            // Seen exactly from the edge: covers nothing.
            self.scene.corners.truncate(start);
            return is_front;
        }
        let (low, high) =
            places.iter().fold((places[0], places[0]), |(low, high), &p| (low.min(p), high.max(p)));
        let sign = if is_front { 1.0 } else { -1.0 };
        let (colour, modelling) = match (self.plain, is_front) {
            (true, true) => (colour, Modelling::Full),
            (true, false) if colour == paint::FRONT => (paint::BACK, Modelling::Full),
            (true, false) => (colour, Modelling::Full),
            (false, _) => (colour, Modelling::Soft),
        };
        let smooth = self.smooth.as_ref().filter(|_| half_edges.len() == 3).map(|normals| {
            let corners = [0, 1, 2].map(|i| (places[i], sign * normals.at(half_edges[i])));
            (Slope::new(corners), colour, modelling)
        });
        self.scene.facets.push(Facet {
            face,
            rank: self.ranks[face],
            light: match self.ranks[face] {
                // Planes are no material.
                Rank::Plane | Rank::Section => paint::ink(colour),
                _ => paint::lit(colour, sign * normal, modelling),
            },
            smooth,
            top: low.y,
            bottom: high.y,
            anchor: places.iter().sum::<DVec3>() / places.len() as f64,
            slope: DVec2::new(-tilt.x / tilt.z, -tilt.y / tilt.z),
            depths: (low.z, high.z),
            corners: start..self.scene.corners.len(),
        });
        is_front
    }

    /// How an edge is drawn; `None` when it would hardly be seen.
    fn line(&self, e: EdgeId) -> Option<Line> {
        let faces = self.mesh.edge_faces(e);
        let is_rim = self.mesh.is_rim(e);
        let [is_front, is_other_front] = e.half_edges().map(|h| self.fronts[h]);
        let is_outline = is_rim || is_front != is_other_front;
        let [n, m] = faces.map(|f| self.normals[f]);
        let fold = n.cross(m).length().atan2(n.dot(m)).to_degrees();
        // How many line widths there are between this edge and the next ones: where few, lines
        // would blacken the faces.
        let [area, other_area] = faces.map(|f| self.areas[f]);
        let spacing = area.max(other_area).sqrt() / self.line_width;
        let is_smoothed = self.smooth.is_some() && fold < super::smooth::CREASE;
        let strength = if is_outline {
            ramp(spacing, 0.1, 0.5)
        } else if is_smoothed {
            0.0
        } else {
            // Edges in a smooth or flat part are light, real folds dark; sharp folds stay longer
            // where it gets dense.
            let sharp = ramp(fold, 20.0, 40.0);
            let by_fold = 0.13 + 0.45 * ramp(fold, 0.5, 8.0) + 0.32 * ramp(fold, 8.0, 30.0);
            by_fold * ramp(spacing, 2.5 - 1.5 * sharp, 16.0 - 10.0 * sharp)
        };
        let width =
            self.line_width * if is_outline { 1.9 } else { 0.75 + 0.45 * ramp(fold, 0.5, 8.0) };
        let ends = self.mesh.edge_vertices(e).map(|v| self.places[v]);
        (strength > 0.02).then_some(Line {
            ends,
            faces,
            width,
            strength: strength as f32,
            is_outline,
            ink: match faces.map(|f| self.ranks[f]).into_iter().max() {
                Some(Rank::Plane | Rank::Section) => Ink::Plane,
                _ if is_rim => Ink::Rim,
                _ => Ink::Edge,
            },
        })
    }

    /// Draws marked edges thick, and dots on marked vertices.
    fn add_marks(&mut self, marks: &Marks) {
        let thick = |&e: &EdgeId| Line {
            ends: self.mesh.edge_vertices(e).map(|v| self.places[v]),
            faces: self.mesh.edge_faces(e),
            width: 3.2 * self.line_width,
            strength: 1.0,
            is_outline: self.mesh.is_rim(e),
            ink: Ink::Mark,
        };
        let lines: Vec<Line> = marks.edges.iter().map(thick).collect();
        self.scene.lines.extend(lines);
        if !marks.vertices.is_empty() {
            self.scene.dot_radius = self.scene.dot_radius.max(5.5 * self.line_width);
        }
        let dot = |&v: &VertexId| Dot { place: self.places[v], vertex: v, colour: paint::MARK };
        let dots: Vec<Dot> = marks.vertices.iter().map(dot).collect();
        self.scene.dots.retain(|d| !marks.vertices.contains(&d.vertex));
        self.scene.dots.extend(dots);
    }

    /// The numbers of the elements of a kind, or of those that are marked.
    fn add_tags(&mut self, ids: Ids, marks: &Marks) {
        let mesh = self.mesh;
        self.scene.tags = match ids {
            Ids::None => Vec::new(),
            Ids::Vertices => {
                let used = mesh.vertices().filter(|&v| mesh.vertex_start(v).is_some());
                used.map(|v| self.vertex_tag(v)).collect()
            }
            Ids::Edges => mesh.edges().map(|e| self.edge_tag(e)).collect(),
            Ids::Faces => mesh.faces().filter_map(|f| self.face_tag(f)).collect(),
            Ids::Marked => {
                let vertices = marks.vertices.iter().map(|&v| self.vertex_tag(v));
                let edges = marks.edges.iter().map(|&e| self.edge_tag(e));
                let faces = marks.faces.iter().filter_map(|&f| self.face_tag(f));
                vertices.chain(edges).chain(faces).collect()
            }
        };
    }

    fn vertex_tag(&self, v: VertexId) -> Tag {
        Tag { place: self.places[v], owner: Owner::Vertex(v), text: v.index().to_string() }
    }

    fn edge_tag(&self, e: EdgeId) -> Tag {
        let [a, b] = self.mesh.edge_vertices(e).map(|v| self.places[v]);
        let owner = Owner::Edge(self.mesh.edge_faces(e));
        Tag { place: a.midpoint(b), owner, text: e.index().to_string() }
    }

    /// The number of a face in the middle of its largest triangle, which lies inside of it.
    fn face_tag(&self, f: FaceId) -> Option<Tag> {
        let corners: Vec<VertexId> = self.mesh.face_vertices(f).collect();
        let turned: Vec<DVec3> = corners.iter().map(|&v| self.turned[v]).collect();
        let frame = Frame::on_plane(&Plane::newell(&turned)?);
        let flat: Vec<DVec2> = turned.iter().map(|&p| frame.flatten(p)).collect();
        let centre = crate::geom::polygon::centroid(&flat);
        let is_inside =
            crate::geom::polygon::locate(&flat, centre) == crate::geom::polygon::Location::Inside;
        let places = corners.iter().map(|&v| self.places[v]);
        let n = corners.len() as f64;
        let place = if is_inside && corners.len() <= 8 {
            places.sum::<DVec3>() / n
        } else {
            let area = |t: &[usize; 3]| {
                let [a, b, c] = t.map(|i| flat[i]);
                (b - a).perp_dot(c - a)
            };
            let largest =
                triangulate(&flat).into_iter().max_by(|a, b| area(a).total_cmp(&area(b)))?;
            largest.iter().map(|&i| self.places[corners[i]]).sum::<DVec3>() / 3.0
        };
        Some(Tag { place, owner: Owner::Face(f), text: f.index().to_string() })
    }

    fn add_dots(&mut self) {
        let mesh = self.mesh;
        let lengths = mesh.edges().map(|e| {
            let [a, b] = mesh.edge_vertices(e).map(|v| self.places[v]);
            a.distance(b)
        });
        let mean = lengths.sum::<f64>() / mesh.edge_count().max(1) as f64;
        self.scene.dot_radius = (5.5 * self.line_width).min(mean / 5.0).max(0.75);
        let dots = mesh.vertices().filter(|&v| mesh.vertex_start(v).is_some());
        let dot = |v| Dot {
            place: self.places[v],
            vertex: v,
            colour: paint::valence_colour(mesh.valence(v)),
        };
        self.scene.dots = dots.map(dot).collect();
    }
}

/// Twice the vector area of a polygon.
fn newell(corners: &[DVec3]) -> DVec3 {
    let first = corners.first().copied().unwrap_or_default();
    corners.windows(2).map(|w| (w[0] - first).cross(w[1] - first)).sum()
}

fn is_bent(corners: &[DVec3], plane: &Plane) -> bool {
    if !(4..=MAX_CUT_CORNERS).contains(&corners.len()) {
        return false;
    }
    let size = corners.iter().map(|p| p.distance(corners[0])).fold(0.0, f64::max);
    corners.iter().any(|&p| plane.signed_distance(p).abs() > BENT * size)
}

/// 0 below `low`, 1 above `high`, straight between.
fn ramp(x: f64, low: f64, high: f64) -> f64 {
    ((x - low) / (high - low)).clamp(0.0, 1.0)
}

/// Whether a face touches a vertex.
pub(super) fn touches(mesh: &Mesh, v: VertexId, f: FaceId) -> bool {
    mesh.outgoing(v).any(|h| mesh.face(h) == f)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_are_clamped() {
        assert_eq!(
            [ramp(-1.0, 0.0, 2.0), ramp(1.0, 0.0, 2.0), ramp(9.0, 0.0, 2.0)],
            [0.0, 0.5, 1.0]
        );
    }
}
