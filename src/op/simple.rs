//! Makes a result one that files can hold: what lies at one point becomes one vertex, faces
//! without area go into their neighbours, and of several edges between two vertices all but one get
//! a vertex in between.

use super::OpError;
use super::divide::divide_repeated;
use crate::mesh::{
    BuildError, Corner, EdgeId, FaceId, FileFault, HalfEdgeId, Mesh, MeshBuilder, VertexId,
    VertexMap,
};
use crate::select::NewElements;

/// Mending one fault may bring another to light: a split edge beside a 2-gon makes a face without
/// area. More passes than this no chain of them has needed.
const MOST_PASSES: usize = 8;

/// What was done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Mended {
    /// Edges without length of which both ends became one vertex.
    pub collapsed: usize,
    /// Faces without area, or with two sides, that went into a neighbour.
    pub dissolved: usize,
    /// Edges that divide faces that came twice to a vertex.
    pub divided: usize,
    /// Edges that got a vertex in between, since another one joins the same two vertices.
    pub split: usize,
}

impl Mended {
    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        let mut note = |count: usize, one: &str, many: &str| {
            if count > 0 {
                notes.push(format!("{count} {}", if count == 1 { one } else { many }));
            }
        };
        note(
            self.collapsed,
            "edge had no length: its ends became one vertex",
            "edges had no length: their ends became one vertex each",
        );
        note(
            self.dissolved,
            "face without area went into its neighbour",
            "faces without area went into their neighbours",
        );
        note(
            self.divided,
            "edge divides a face that came twice to a vertex",
            "edges divide faces that came twice to a vertex",
        );
        note(
            self.split,
            "edge got a vertex in between, since another one joins the same two vertices",
            "edges got a vertex in between, since others join the same two vertices",
        );
        notes
    }

    fn add(&mut self, other: Self) {
        self.collapsed += other.collapsed;
        self.dissolved += other.dissolved;
        self.divided += other.divided;
        self.split += other.split;
    }

    fn is_nothing(self) -> bool {
        self == Self::default()
    }
}

/// Makes a result one that files can hold. Where the mesh that it was made of had self-loops, 2-gons
/// and their like, and the result has some, it is on the way to something else, and may stay so.
///
/// # Errors
/// [`OpError::NotSimple`] with the first fault that could not be mended.
pub(super) fn keep_simple(
    before: &Mesh,
    result: &mut Mesh,
    made: &mut NewElements,
    advice: &'static str,
) -> Result<Mended, OpError> {
    if is_unfinished(before) && is_unfinished(result) {
        return Ok(Mended::default());
    }
    let mended = make_simple(result, made);
    if let Some(&fault) = result.file_faults().first() {
        return Err(OpError::NotSimple { fault, advice });
    }
    if is_unfinished(result) || has_pinches(result) {
        *result = as_polygons(result, made)
            .map_err(|_| OpError::NotSimple { fault: FileFault::NoFaces, advice })?;
    }
    Ok(mended)
}

/// Whether a mesh has self-loops, or faces with fewer than three different corners: no part of
/// files, and good for the next operator only.
fn is_unfinished(mesh: &Mesh) -> bool {
    mesh.edges().any(|e| is_loop(mesh, e)) || mesh.faces().any(|f| !has_three_corners(mesh, f))
}

/// Whether several rims run through one vertex: a file holds a vertex for each of them.
fn has_pinches(mesh: &Mesh) -> bool {
    let mut is_met = VertexMap::filled(mesh.vertex_slots(), false);
    let mut corners = mesh.holes().flat_map(|f| mesh.face_vertices(f));
    corners.any(|v| std::mem::replace(&mut is_met[v], true))
}

/// Makes a result of cuts one that files can hold: faces that come twice to a vertex are divided, and
/// rims parted. Ids of faces stay, parts of faces get new ones.
///
/// # Errors
/// [`OpError::NotSimple`] for a face at a made vertex that still comes twice to a vertex or has no
/// area, where no self-loops and 2-gons say that the mesh is on the way to something else.
pub(super) fn keep_cut_simple(mesh: &mut Mesh, made: &mut NewElements) -> Result<(), OpError> {
    if !is_unfinished(mesh)
        && divide_repeated(mesh, made) > 0
        && is_unfinished(mesh)
        && mesh.file_faults().is_empty()
        && let Ok(parted) = as_polygons(mesh, made)
    {
        *mesh = parted;
    }
    part_rims(mesh, made);
    match mesh.file_faults_at(&made.vertices).into_iter().next() {
        Some(fault) if !is_unfinished(mesh) => {
            let advice = "take a smaller offset, or fewer elements at once";
            Err(OpError::NotSimple { fault, advice })
        }
        _ => Ok(()),
    }
}

/// Takes out what has no extent at made vertices, as it comes where planes meet nearly at one point
/// or one line: of two vertices at the same numbers at both ends of an edge one stays, and faces of
/// which two sides are left, or whose corners lie on one line, go. Ids stay, with gaps.
pub(super) fn drop_flat(mesh: &mut Mesh, made: &[VertexId]) {
    let mut near = made.to_vec();
    for _ in 0..MOST_PASSES {
        near.retain(|&v| mesh.has_vertex(v));
        let faults = mesh.file_faults_at(&near);
        let mut dropped = collapse_points(mesh, &faults);
        if dropped == 0 {
            // What such a face hid between given vertices is found in the next pass.
            near.extend(flat_faces(&faults).flat_map(|f| mesh.face_vertices(f)));
            dropped = dissolve_lines(mesh, &faults);
        }
        if dropped == 0 {
            return;
        }
        dissolve_two_gons(mesh);
    }
}

/// The faces without area among faults.
fn flat_faces(faults: &[FileFault]) -> impl Iterator<Item = FaceId> + '_ {
    faults.iter().filter_map(|fault| match *fault {
        FileFault::NoArea(f) => Some(f),
        _ => None,
    })
}

/// Pulls vertices apart through which several rims run, where nothing else keeps the mesh from
/// being a file.
pub(super) fn part_rims(mesh: &mut Mesh, made: &mut NewElements) {
    if has_pinches(mesh)
        && !is_unfinished(mesh)
        && mesh.file_faults().is_empty()
        && let Ok(parted) = as_polygons(mesh, made)
    {
        *mesh = parted;
    }
}

fn is_loop(mesh: &Mesh, e: EdgeId) -> bool {
    let [a, b] = mesh.edge_vertices(e);
    a == b
}

/// The corners of a face that no self-loop brings.
fn corners(mesh: &Mesh, f: FaceId) -> impl Iterator<Item = VertexId> + '_ {
    let straight = mesh.face_half_edges(f).filter(|h| !is_loop(mesh, h.edge()));
    straight.map(|h| mesh.origin(h))
}

/// Whether a face has three different corners.
fn has_three_corners(mesh: &Mesh, f: FaceId) -> bool {
    let mut corners = corners(mesh, f);
    let (first, second) = (corners.next(), corners.next());
    corners.any(|v| Some(v) != first && Some(v) != second)
}

/// The corners of a face without self-loops; none when fewer than three of them differ.
fn straight_corners(mesh: &Mesh, f: FaceId) -> Vec<VertexId> {
    if has_three_corners(mesh, f) { corners(mesh, f).collect() } else { Vec::new() }
}

/// The mesh that a file would hold: without self-loops and small faces, vertices that these held
/// together pulled apart. Groups, seams and planes stay.
fn as_polygons(mesh: &Mesh, made: &mut NewElements) -> Result<Mesh, BuildError> {
    let mut builder = MeshBuilder::new();
    let mut numbers = VertexMap::filled(mesh.vertex_slots(), VertexId::new(0));
    for v in mesh.vertices() {
        numbers[v] = VertexId::new(builder.vertex(mesh.position(v)));
    }
    let mut faces: Vec<FaceId> = Vec::with_capacity(mesh.face_count());
    for f in mesh.faces() {
        let corners = straight_corners(mesh, f);
        if !corners.is_empty() {
            builder.face(corners.into_iter().map(|v| numbers[v].index()));
            faces.push(f);
        }
    }
    let (mut polygons, splits) = builder.build()?;
    dress_faces(mesh, &faces, &mut polygons);
    let old: Vec<VertexId> = mesh.vertices().collect();
    let parted = splits.iter().map(|split| (split.added, old[split.given.index()]));
    for (new, v) in old.iter().map(|&v| (numbers[v], v)).chain(parted) {
        if polygons.has_vertex(new) {
            polygons.set_position(new, mesh.position(v), mesh.is_given(v));
        }
    }
    let edge = |e: EdgeId| {
        let [a, b] = mesh.edge_vertices(e).map(|v| numbers[v]);
        let is_there = polygons.has_vertex(a) && polygons.has_vertex(b);
        is_there.then(|| polygons.edge_between(a, b)).flatten()
    };
    let seams: Vec<EdgeId> = mesh.edges().filter(|&e| mesh.is_seam(e)).filter_map(edge).collect();
    made.edges = made.edges.iter().copied().filter_map(edge).collect();
    made.strip = made.strip.iter().copied().filter_map(edge).collect();
    made.vertices = made.vertices.iter().map(|&v| numbers[v]).collect();
    let number = |f: &FaceId| faces.binary_search(f).ok().map(FaceId::new);
    made.faces = made.faces.iter().filter_map(number).collect();
    seams.into_iter().for_each(|e| polygons.set_seam(e, true));
    made.compact(&mut polygons);
    Ok(polygons)
}

/// Gives faces, in their order, the groups and planes of those that they were.
fn dress_faces(mesh: &Mesh, faces: &[FaceId], polygons: &mut Mesh) {
    for (number, &f) in faces.iter().enumerate() {
        if let Some(name) = mesh.group(f) {
            polygons.set_group(FaceId::new(number), name);
        }
        if let Some(plane) = mesh.carried_plane(f) {
            polygons.set_plane(FaceId::new(number), plane);
        }
    }
}

/// Mends what can be mended. Ids stay without gaps, and `made`
/// follows them.
fn make_simple(mesh: &mut Mesh, made: &mut NewElements) -> Mended {
    let mut mended = Mended::default();
    for _ in 0..MOST_PASSES {
        let mut pass = Mended { dissolved: dissolve_two_gons(mesh), ..Mended::default() };
        let faults = mesh.file_faults();
        pass.collapsed = collapse_points(mesh, &faults);
        if pass.collapsed == 0 {
            pass.dissolved += dissolve_lines(mesh, &faults);
        }
        if pass.collapsed == 0 && pass.dissolved == 0 {
            pass.divided = divide_repeated(mesh, made);
        }
        if pass.collapsed == 0 && pass.dissolved == 0 && pass.divided == 0 {
            pass.split = split_parallels(mesh, &faults);
        }
        mended.add(pass);
        if pass.is_nothing() {
            break;
        }
    }
    if !mended.is_nothing() {
        made.compact(mesh);
    }
    mended
}

/// Takes 2-gons out: the two edges become one.
fn dissolve_two_gons(mesh: &mut Mesh) -> usize {
    let gons: Vec<FaceId> = mesh.faces().filter(|&f| is_two_gon(mesh, f)).collect();
    gons.into_iter().filter(|&f| dissolve_two_gon(mesh, f)).count()
}

fn dissolve_two_gon(mesh: &mut Mesh, f: FaceId) -> bool {
    // Another one beside it may have taken it along.
    if !mesh.has_face(f) || !is_two_gon(mesh, f) {
        return false;
    }
    let sides: Vec<HalfEdgeId> = mesh.face_half_edges(f).collect();
    let [a, b] = sides[..] else { return false };
    // Two faces of two sides are all that there is of their component.
    let beside = mesh.face(a.twin());
    if beside == f || beside == mesh.face(b.twin()) {
        return false;
    }
    let is_seam = mesh.is_seam(a.edge()) || mesh.is_seam(b.edge());
    mesh.delete_edge_of(a);
    mesh.set_seam(b.edge(), is_seam);
    true
}

fn is_two_gon(mesh: &Mesh, f: FaceId) -> bool {
    let mut sides = mesh.face_half_edges(f);
    let (Some(a), Some(b), None) = (sides.next(), sides.next(), sides.next()) else { return false };
    a.edge() != b.edge() && mesh.origin(a) != mesh.origin(b)
}

/// Makes both ends of each edge without length one vertex.
fn collapse_points(mesh: &mut Mesh, faults: &[FileFault]) -> usize {
    let mut count = 0;
    for fault in faults {
        let &FileFault::ZeroLengthEdge(e) = fault else { continue };
        // A loop that an earlier collapse has made holds the surface together.
        if mesh.has_edge(e) && mesh.contract_edge(e).is_ok() {
            count += 1;
        }
    }
    count
}

/// Deletes the longest side of each face whose corners lie on a line: the others become sides of
/// the neighbour, or of the hole, and lie where that side lay. A face whose other sides run to and
/// fro on the line loses ears first, until they do not.
pub(super) fn dissolve_lines(mesh: &mut Mesh, faults: &[FileFault]) -> usize {
    let mut open: Vec<FaceId> = flat_faces(faults).collect();
    open.reverse();
    // Faces that hand ears to each other would never end: there are as many ears as corners.
    let mut ears: usize = open.iter().map(|&f| mesh.sides(f)).sum();
    let mut count = 0;
    while let Some(f) = open.pop() {
        if !mesh.has_face(f) {
            continue;
        }
        let sides: Vec<HalfEdgeId> = mesh.face_half_edges(f).collect();
        match spanning_side(mesh, &sides) {
            Some(h) if mesh.face(h.twin()) != f => {
                mesh.delete_edge_of(h);
                let edges: Vec<EdgeId> = sides.into_iter().map(HalfEdgeId::edge).collect();
                delete_between_holes(mesh, &edges);
                count += 1;
            }
            None if ears > 0 => {
                ears -= 1;
                open.extend(cut_ear(mesh, f, &sides));
            }
            _ => {}
        }
    }
    count
}

/// The longest side of a face whose corners lie on a line, where the others run the way back without
/// turning.
fn spanning_side(mesh: &Mesh, sides: &[HalfEdgeId]) -> Option<HalfEdgeId> {
    let along = |h: HalfEdgeId| mesh.position(mesh.target(h)) - mesh.position(mesh.origin(h));
    let length = |h: &HalfEdgeId| along(*h).length_squared();
    let longest = sides.iter().copied().max_by(|a, b| length(a).total_cmp(&length(b)))?;
    // Sides of a few of the smallest numbers have a product of zero.
    let back = -along(longest);
    let mut others = sides.iter().filter(|&&h| h != longest);
    others.all(|&h| along(h).dot(back) >= 0.0).then_some(longest)
}

/// Cuts the corner at an end of the line off a face whose corners lie on it. Where the corners beside
/// it lie at one place they become one vertex. Returns the parts that are left to be looked at.
fn cut_ear(mesh: &mut Mesh, f: FaceId, sides: &[HalfEdgeId]) -> Vec<FaceId> {
    let (n, from) = (sides.len(), mesh.position(mesh.origin(sides[0])));
    let distance = |i: &usize| mesh.position(mesh.origin(sides[*i])).distance_squared(from);
    let end = (0..n).max_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(0);
    let [before, after] = [sides[(end + n - 1) % n], sides[(end + 1) % n]];
    let [a, b] = [before, after].map(|h| mesh.origin(h));
    // A triangle has no ear, and a loop would be one more thing that files cannot hold.
    if n == 3 || a == b {
        return Vec::new();
    }
    let is_one_place = mesh.position(a) == mesh.position(b);
    let Ok(e) = mesh.insert_edge(Corner::At(before), Corner::At(after)) else { return Vec::new() };
    let parts = mesh.edge_faces(e);
    debug_assert!(parts.contains(&f), "the face stays, a part of it is new");
    if is_one_place && mesh.contract_edge(e).is_ok() {
        return parts.into_iter().filter(|&part| !dissolve_two_gon(mesh, part)).collect();
    }
    parts.into()
}

/// Deletes those of the edges that have a hole on either side, which hold nothing any more.
fn delete_between_holes(mesh: &mut Mesh, edges: &[EdgeId]) {
    for &e in edges {
        if mesh.has_edge(e) && mesh.edge_faces(e).iter().all(|&f| mesh.is_hole(f)) {
            mesh.delete_edge_with_cleanup(e);
        }
    }
}

/// Splits all but the first of the edges between two vertices, each at a place of its own.
fn split_parallels(mesh: &mut Mesh, faults: &[FileFault]) -> usize {
    let pairs: Vec<(EdgeId, EdgeId)> = faults
        .iter()
        .filter_map(|fault| match *fault {
            FileFault::ParallelEdges(first, other) => Some((first, other)),
            _ => None,
        })
        .collect();
    for group in pairs.chunk_by(|a, b| a.0 == b.0) {
        for (i, &(_, e)) in group.iter().enumerate() {
            let share = (i + 1) as f64 / (group.len() + 1) as f64;
            let [a, b] = mesh.edge_positions(e);
            mesh.split_edge(e, a.lerp(b, share));
        }
    }
    pairs.len()
}
