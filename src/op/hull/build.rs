//! From hulls to a mesh: one component each, faces with their planes and groups.

use glam::DVec3;

use super::HullPart;
use super::parts::Cluster;
use crate::geom::Plane;
use crate::geom::hull::{HalfSpace, Polygons, Polytope};
use crate::mesh::{BuildError, FaceId, Mesh, MeshBuilder, VertexId};

/// The parts of a mesh in the making.
#[derive(Default)]
pub(super) struct Assembly {
    builder: MeshBuilder,
    /// For each vertex whether it lies as given.
    is_given: Vec<bool>,
    /// For each face its plane, where it carries one.
    planes: Vec<Option<Plane>>,
    /// Names of the parts, with the number of faces up to their ends.
    groups: Vec<(String, usize)>,
}

impl Assembly {
    /// Adds the convex hull of a cluster: its corners in the order of the points, at their given
    /// positions.
    pub(super) fn add_hull(&mut self, cluster: &Cluster, faces: &Polygons) -> HullPart {
        let mut number = vec![usize::MAX; cluster.points.len()];
        let mut corners = faces.corners().to_vec();
        corners.sort_unstable();
        corners.dedup();
        for i in corners {
            number[i as usize] =
                self.vertex(cluster.points[i as usize], cluster.is_given[i as usize]);
        }
        for run in faces.iter() {
            self.builder.face(run.iter().map(|&i| number[i as usize]));
            self.planes.push(None);
        }
        self.end_part(HullPart {
            name: cluster.name.clone(),
            points: cluster.points.len(),
            ..HullPart::default()
        })
    }

    /// Adds a polytope whose coordinates count from `origin`. `part` says all but faces and what
    /// has none.
    pub(super) fn add_polytope(
        &mut self,
        polytope: Polytope,
        half_spaces: &[HalfSpace],
        origin: DVec3,
        mut part: HullPart,
    ) -> HullPart {
        let first = self.is_given.len();
        for &position in &polytope.vertices {
            self.vertex(origin + position, false);
        }
        for (run, &i) in polytope.faces.iter().zip(&polytope.half_spaces) {
            self.builder.face(run.iter().map(|&v| first + v as usize));
            self.planes.push(carried(&half_spaces[i as usize], polytope.interior, origin));
        }
        let mut contributing = polytope.half_spaces.iter().copied().peekable();
        let is_without = |i: &usize| contributing.next_if(|&c| c as usize == *i).is_none();
        part.without_face = (0..half_spaces.len()).filter(is_without).collect();
        self.end_part(part)
    }

    fn vertex(&mut self, position: DVec3, is_given: bool) -> usize {
        self.is_given.push(is_given);
        self.builder.vertex(position)
    }

    fn end_part(&mut self, mut part: HullPart) -> HullPart {
        let before = self.groups.last().map_or(0, |group| group.1);
        part.faces = self.planes.len() - before;
        self.groups.push((part.name.clone(), self.planes.len()));
        part
    }

    /// The mesh of all parts.
    ///
    /// # Errors
    /// What a reader would refuse in a file of this mesh.
    pub(super) fn mesh(self) -> Result<Mesh, BuildError> {
        let (mut mesh, _) = self.builder.build()?;
        for (i, is_given) in self.is_given.into_iter().enumerate() {
            let v = VertexId::new(i);
            mesh.set_position(v, mesh.position(v), is_given);
        }
        for (i, plane) in self.planes.into_iter().enumerate() {
            if let Some(plane) = plane {
                mesh.set_plane(FaceId::new(i), plane);
            }
        }
        // A single hull needs no group to tell it from others.
        if self.groups.len() > 1 {
            let mut first = 0;
            for (name, end) in self.groups {
                (first..end).for_each(|i| mesh.set_group(FaceId::new(i), &name));
                first = end;
            }
        }
        Ok(mesh)
    }
}

/// The plane of a half-space, anchored at the foot of the point inside.
fn carried(half_space: &HalfSpace, interior: DVec3, origin: DVec3) -> Option<Plane> {
    let n = half_space.normal;
    let foot = interior + n * (half_space.slack(interior) / n.length_squared());
    Plane::new(n, origin + foot)
}
