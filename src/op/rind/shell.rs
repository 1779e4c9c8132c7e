//! The links of a shell: two skins, and walls around what is open.

use glam::DVec3;

use super::offset::Skin;
use super::{Opening, RindReport, bound};
use crate::mesh::{
    EdgeId, EdgeMap, FaceId, FaceMap, HalfEdgeId, HalfEdgeMap, Mesh, VertexId, VertexMap,
    WalkBuilder,
};
use crate::select::NewElements;

/// What stays of a mesh when it becomes a shell.
pub(super) struct Shell<'a> {
    mesh: &'a Mesh,
    openings: &'a FaceMap<Opening>,
    /// Edges between openings that go with their wall.
    removed: EdgeMap<bool>,
}

/// The two skins under construction.
struct Skins {
    /// The vertices that stay, with their two copies.
    vertices: Vec<(VertexId, [VertexId; 2])>,
    /// Half-edges in the direction of the mesh, on the first and on the second skin.
    sides: [HalfEdgeMap<HalfEdgeId>; 2],
    /// For each corner of an opening the edge from the first skin to the second; corners without a
    /// wall between them share one.
    rungs: HalfEdgeMap<HalfEdgeId>,
}

impl<'a> Shell<'a> {
    pub fn plan(mesh: &'a Mesh, openings: &'a FaceMap<Opening>) -> Self {
        let mut removed = EdgeMap::filled(mesh.edge_slots(), false);
        for e in mesh.edges() {
            let around = mesh.edge_faces(e).map(|f| openings[f]);
            removed[e] = !around.contains(&Opening::None) && around.contains(&Opening::Peeled);
        }
        Self { mesh, openings, removed }
    }

    fn is_open(&self, f: FaceId) -> bool {
        self.openings[f] != Opening::None
    }

    fn stays(&self, v: VertexId) -> bool {
        self.mesh.outgoing(v).any(|h| !self.removed[h.edge()])
    }

    /// Builds the mesh; with `grows_outwards` the second skin is the outer one.
    pub fn build(&self, skin: &Skin, grows_outwards: bool) -> (Mesh, NewElements) {
        let mesh = self.mesh;
        let mut walks = WalkBuilder::with_capacity(
            2 * mesh.vertex_count(),
            2 * mesh.edge_count() + mesh.edge_count() / 2,
            2 * mesh.face_count() + mesh.edge_count() / 2,
        );
        let skins = self.skins(skin, &mut walks);
        let copies = self.skin_faces(&skins, grows_outwards, &mut walks);
        let walls = self.walls(&skins, grows_outwards, &mut walks);
        let made = NewElements {
            vertices: skins.vertices.iter().map(|v| v.1[1]).collect(),
            faces: copies.iter().map(|c| c.1[1]).chain(walls).collect(),
            ..NewElements::default()
        };
        let mut made_mesh = walks.build();
        self.dress(&mut made_mesh, skin, &skins, &copies, grows_outwards);
        (made_mesh, made)
    }

    /// The faces that stay, each with its copies on the first and on the second skin.
    fn skin_faces(
        &self,
        skins: &Skins,
        grows_outwards: bool,
        walks: &mut WalkBuilder,
    ) -> Vec<(FaceId, [FaceId; 2])> {
        let [first, second] = if grows_outwards { [1, 0] } else { [0, 1] };
        let mut copies = Vec::new();
        for f in self.mesh.faces().filter(|&f| !self.is_open(f)) {
            let around: Vec<HalfEdgeId> = self.mesh.face_half_edges(f).collect();
            let out = walks.face(around.iter().map(|&h| skins.sides[first][h]));
            let back = walks.face(around.iter().rev().map(|&h| skins.sides[second][h].twin()));
            copies.push((f, if grows_outwards { [back, out] } else { [out, back] }));
        }
        copies
    }

    /// The walls of the openings.
    fn walls(&self, skins: &Skins, grows_outwards: bool, walks: &mut WalkBuilder) -> Vec<FaceId> {
        let mesh = self.mesh;
        let mut walls = Vec::new();
        for f in mesh.faces_and_holes().filter(|&f| self.is_open(f)) {
            for h in mesh.face_half_edges(f).filter(|h| !self.removed[h.edge()]) {
                // From the first skin to the second at the end of the side, and back at its start.
                let (down, up) = (skins.rungs[mesh.next(h)], skins.rungs[h].twin());
                let wall = [skins.sides[0][h], down, skins.sides[1][h].twin(), up];
                let turned = [up.twin(), skins.sides[1][h], down.twin(), skins.sides[0][h].twin()];
                walls.push(walks.face(if grows_outwards { turned } else { wall }));
            }
        }
        walls
    }

    fn skins(&self, skin: &Skin, walks: &mut WalkBuilder) -> Skins {
        let mesh = self.mesh;
        let none = || HalfEdgeMap::filled(mesh.half_edge_slots(), HalfEdgeId(u32::MAX));
        let mut skins = Skins { vertices: Vec::new(), sides: [none(), none()], rungs: none() };
        let mut copies = VertexMap::filled(mesh.vertex_slots(), [VertexId::new(0); 2]);
        for layer in 0..2 {
            let place = |v: VertexId| -> DVec3 { [mesh.position(v), skin.positions[v]][layer] };
            for v in mesh.vertices().filter(|&v| self.stays(v)) {
                copies[v][layer] = walks.vertex(place(v));
            }
            for e in mesh.edges().filter(|&e| !self.removed[e]) {
                let [h, t] = e.half_edges();
                let side = walks.edge(copies[mesh.origin(h)][layer], copies[mesh.origin(t)][layer]);
                skins.sides[layer][h] = side;
                skins.sides[layer][t] = side.twin();
            }
        }
        skins.vertices =
            mesh.vertices().filter(|&v| self.stays(v)).map(|v| (v, copies[v])).collect();
        for start in mesh.half_edges().filter(|&h| self.is_open(mesh.face(h))) {
            if self.removed[mesh.prev(start).edge()] {
                continue;
            }
            let [from, to] = copies[mesh.origin(start)];
            let rung = walks.edge(from, to);
            let mut h = start;
            skins.rungs[h] = rung;
            while self.removed[h.edge()] {
                h = mesh.next(h.twin());
                skins.rungs[h] = rung;
            }
        }
        skins
    }

    /// Gives the new mesh what the old one knew: which positions are given, groups, planes.
    fn dress(
        &self,
        made: &mut Mesh,
        skin: &Skin,
        skins: &Skins,
        copies: &[(FaceId, [FaceId; 2])],
        is_turned: bool,
    ) {
        let mesh = self.mesh;
        for &(v, [first, _]) in &skins.vertices {
            made.set_position(first, mesh.position(v), mesh.is_given(v));
        }
        let bound = bound(mesh);
        for &(f, [first, second]) in copies {
            if let Some(name) = mesh.group(f) {
                made.set_group(first, name);
                made.set_group(second, name);
            }
            let Some(plane) = mesh.carried_plane(f) else { continue };
            made.set_plane(first, if is_turned { plane.flipped() } else { plane });
            if mesh.face_vertices(f).all(|v| skin.residuals[v] <= bound) {
                let moved = skin.planes[f].expect("faces have planes");
                made.set_plane(second, if is_turned { moved } else { moved.flipped() });
            }
        }
    }

    /// Counts, and the genus that they demand.
    pub fn report(&self, made: &Mesh) -> RindReport {
        let mesh = self.mesh;
        let openings = mesh.faces_and_holes().filter(|&f| self.is_open(f)).count();
        let walls_removed = mesh.edges().filter(|&e: &EdgeId| self.removed[e]).count();
        let corners = mesh.vertices().filter(|&v| mesh.vertex_start(v).is_some());
        let (mut all, mut gone) = (0, 0);
        for v in corners {
            all += 1;
            gone += usize::from(!self.stays(v));
        }
        let faces = mesh.face_count() + mesh.hole_count();
        let euler =
            |vertices: usize, edges: usize, faces: usize| (vertices + faces) as i64 - edges as i64;
        let before = euler(all, mesh.edge_count(), faces);
        let opened = euler(gone, walls_removed, openings);
        let components = made.component_count();
        let genus = components as i64 - (before - opened);
        RindReport {
            openings,
            walls_removed,
            components,
            genus: usize::try_from(genus).unwrap_or_default(),
            ..RindReport::default()
        }
    }
}
