//! Where a shell crosses itself: the second skin turns round or comes too near to the first.

use glam::{DVec3, IVec3};

use super::super::OpError;
use super::super::size::ask;
use super::Opening;
use super::offset::Skin;
use crate::geom::{Frame, nearest_on_triangle, triangulate};
use crate::mesh::{FaceId, FaceMap, Mesh};
use crate::progress::Progress;

/// By how much less than the thickness a distance may be: the rounding of the construction, with
/// room for flat corners.
const SLACK: f64 = 1e-6;

/// The first skin, and how thick the shell is to be.
pub(super) struct Outer<'a> {
    pub mesh: &'a Mesh,
    pub openings: &'a FaceMap<Opening>,
    pub thickness: &'a FaceMap<f64>,
}

impl Outer<'_> {
    /// The faces that stay and that the second skin comes nearer to than their thickness, or whose
    /// sides turn round; ascending.
    pub fn crossing_faces(
        &self,
        skin: &Skin,
        progress: &dyn Progress,
    ) -> Result<Vec<usize>, OpError> {
        let mesh = self.mesh;
        let is_solid = |&f: &FaceId| self.openings[f] == Opening::None;
        let solid: Vec<FaceId> = mesh.faces().filter(is_solid).collect();
        let turns_round = |f: FaceId| {
            mesh.face_half_edges(f).any(|h| {
                let (a, b) = (mesh.origin(h), mesh.target(h));
                let before = mesh.position(b) - mesh.position(a);
                a != b
                    && before.dot(skin.positions[b] - skin.positions[a])
                        < -SLACK * before.length_squared()
            })
        };
        let mut found: Vec<usize> =
            solid.iter().filter(|&&f| turns_round(f)).map(|f| f.index()).collect();
        let near = too_near(mesh, &solid, self.thickness, (skin, progress))?;
        found.extend(near.iter().map(|f| f.index()));
        found.sort_unstable();
        found.dedup();
        Ok(found)
    }
}

/// Faces with a vertex of the second skin nearer than their thickness.
fn too_near(
    mesh: &Mesh,
    solid: &[FaceId],
    thickness: &FaceMap<f64>,
    (skin, progress): (&Skin, &dyn Progress),
) -> Result<Vec<FaceId>, OpError> {
    let Some((low, high)) = mesh.bounds() else { return Ok(Vec::new()) };
    let reach = solid.iter().map(|&f| thickness[f].abs()).fold(0.0, f64::max);
    let fineness = (solid.len() as f64).sqrt().clamp(4.0, 128.0);
    let size = reach.max((high - low).max_element() / fineness);
    let triangles = Triangles::new(triangles_of(mesh, solid), Cells { low, size });
    let unevenness = unevenness(mesh, solid);
    let mut is_near = FaceMap::filled(mesh.face_slots(), false);
    for (turn, v) in mesh.vertices().enumerate() {
        ask(progress, turn)?;
        let p = skin.positions[v];
        if p.cmplt(low - reach).any() || p.cmpgt(high + reach).any() {
            continue;
        }
        triangles.around(p, reach, |f, corners| {
            let wanted = thickness[f].abs() * (1.0 - SLACK) - skin.residuals[v] - unevenness[f];
            is_near[f] |= nearest_on_triangle(p, *corners).distance(p) < wanted;
        });
    }
    Ok(solid.iter().copied().filter(|&f| is_near[f]).collect())
}

/// How far the corners of a face lie beside its plane. The skin keeps its distance from planes, so
/// a face that is not planar may be nearer by so much.
fn unevenness(mesh: &Mesh, solid: &[FaceId]) -> FaceMap<f64> {
    let mut unevenness = FaceMap::filled(mesh.face_slots(), 0.0);
    for &f in solid {
        let plane = mesh.plane(f).expect("the skin was made of planes");
        let beside = mesh.face_vertices(f).map(|v| plane.signed_distance(mesh.position(v)).abs());
        unevenness[f] = beside.fold(0.0, f64::max);
    }
    unevenness
}

/// Triangles by the cells that their boxes touch.
struct Triangles {
    all: Vec<(FaceId, [DVec3; 3])>,
    cells: Cells,
    /// Cells with the triangles in them, ascending.
    entries: Vec<([i32; 3], u32)>,
}

impl Triangles {
    fn new(all: Vec<(FaceId, [DVec3; 3])>, cells: Cells) -> Self {
        let mut entries = Vec::new();
        for (i, (_, [a, b, c])) in all.iter().enumerate() {
            let (low, high) = (a.min(*b).min(*c), a.max(*b).max(*c));
            cells.between(low, high).for_each(|cell| entries.push((cell, i as u32)));
        }
        entries.sort_unstable();
        Self { all, cells, entries }
    }

    /// Visits the triangles, some more than once, that may come as near to a point as `reach`.
    fn around(&self, p: DVec3, reach: f64, mut visit: impl FnMut(FaceId, &[DVec3; 3])) {
        for cell in self.cells.between(p - reach, p + reach) {
            let start = self.entries.partition_point(|entry| entry.0 < cell);
            for &(_, i) in self.entries[start..].iter().take_while(|entry| entry.0 == cell) {
                let (f, corners) = &self.all[i as usize];
                visit(*f, corners);
            }
        }
    }
}

fn triangles_of(mesh: &Mesh, faces: &[FaceId]) -> Vec<(FaceId, [DVec3; 3])> {
    let of_face = |&f: &FaceId| {
        let corners = mesh.face_positions(f);
        let plane = mesh.plane(f).expect("the skin was made of planes");
        let frame = Frame::on_plane(&plane);
        let flat: Vec<_> = corners.iter().map(|&p| frame.flatten(p)).collect();
        let triangles = if corners.len() == 3 { vec![[0, 1, 2]] } else { triangulate(&flat) };
        triangles.into_iter().map(move |t| (f, t.map(|i| corners[i])))
    };
    faces.iter().flat_map(of_face).collect()
}

/// Cubes that divide space.
struct Cells {
    low: DVec3,
    size: f64,
}

impl Cells {
    fn of(&self, p: DVec3) -> IVec3 {
        ((p - self.low) / self.size).floor().as_ivec3()
    }

    fn between(&self, low: DVec3, high: DVec3) -> impl Iterator<Item = [i32; 3]> + use<> {
        let (a, b) = (self.of(low), self.of(high));
        (a.x..=b.x)
            .flat_map(move |x| (a.y..=b.y).flat_map(move |y| (a.z..=b.z).map(move |z| [x, y, z])))
    }
}
