//! Sierpinski polyhedra (Srinivasan & Akleman 2004; Srinivasan 2004, VI): each vertex keeps a
//! pyramid half as high, what lies between is gone.
//!
//! Every edge is halved, every corner of every face cut off, and what remains in the middle of the
//! faces is removed: at the middle of each edge a self-loop joins the two neighbouring openings, so
//! that the surface stays one, closed and orientable, although its pyramids seem to touch in points
//! only. Self-loops that are there already stay as they are, in the corner where they lie.
//!
//! One round on a closed mesh with V vertices, E straight edges, L loops and F faces:
//!
//! ```text
//!   vertices  V+E    straight edges  4E    loops  L+E    faces  2E + pyramids
//! ```
//!
//! with a pyramid for each vertex, and for each further part into which loops divide a vertex. From
//! genus 0, n rounds make V + E(4ⁿ−1)/3 vertices, E·4ⁿ straight edges and E(4ⁿ−1)/3 loops, V +
//! 2E(4ⁿ−1)/3 faces, genus 1 − V + E(4ⁿ+2)/6.
//!
//! Needs: nothing. Keeps: components, positions of old vertices, groups (the triangles at the
//! corners of a face inherit its group). Planarity: corner triangles are planar, bases of pyramids
//! are for valence 3, others by luck. Degenerate cases: at the rim of an open mesh no loop is made,
//! and the pyramids of rim vertices have no base, so that the rim runs through their openings;
//! faces of loops only stay.

mod vertex_kind;

#[cfg(test)]
mod tests;

use serde::Deserialize;

use super::simple::{dissolve_lines, part_rims};
use super::size::{ask, check_size};
use super::{OpContext, OpError};
use crate::mesh::{EdgeId, FaceId, HalfEdgeId, HalfEdgeMap, Mesh, VertexId, WalkBuilder};
use crate::progress::Progress;
use crate::select::NewElements;

pub use vertex_kind::{VertexKind, vertex_kind};

/// The most rounds that may be asked for; the size of the result ends it much sooner.
const MOST_ROUNDS: u32 = 32;

/// How to make a Sierpinski polyhedron. One definition for the library, the command line and the
/// recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct SierpinskiParams {
    /// How many rounds, 1 to 32; each makes four times as many faces.
    #[arg(long, default_value_t = default_rounds())]
    #[serde(default = "default_rounds")]
    pub rounds: u32,
}

fn default_rounds() -> u32 {
    1
}

/// What was found before the first round.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SierpinskiReport {
    /// How many vertices there are of each kind, in the order of [`VertexKind::ALL`].
    pub kinds: [usize; 6],
    /// The self-loops of the result.
    pub loops: usize,
    /// How many faces were left out because their corners lie on one line.
    pub flat_faces: usize,
}

impl SierpinskiReport {
    /// The report in words: what there is, and what to expect of it.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = kinds_in_words(self.kinds);
        notes.push(format!(
            "{} self-loops of length zero hold the pyramids together; files leave them out",
            self.loops
        ));
        if self.flat_faces > 0 {
            notes.push(format!(
                "{} corners of straight angles made faces without area, which were left out",
                self.flat_faces
            ));
        }
        notes
    }
}

/// Makes a Sierpinski polyhedron. Positions count as constructed; planes are not carried along.
///
/// # Errors
/// [`OpError::RepeatOutOfRange`]; [`OpError::DoesNotFit`] before the first round;
/// [`OpError::Cancelled`].
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// let solid = kerfold::shape::tetrahedron(10.0);
/// let params = SierpinskiParams { rounds: 1 };
/// let (next, _) = sierpinski(&solid, &params, &OpContext::default())?;
/// assert!(next.is_closed() && next.face_count() > solid.face_count());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sierpinski(
    mesh: &Mesh,
    params: &SierpinskiParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, SierpinskiReport), OpError> {
    if !(1..=MOST_ROUNDS).contains(&params.rounds) {
        return Err(OpError::RepeatOutOfRange { repeat: params.rounds, limit: MOST_ROUNDS });
    }
    let kinds = count_kinds(mesh);
    // Four halves of each edge's sides and a loop, and a loop stays one.
    let edges = |rounds: u32| 5.0 / 3.0 * mesh.edge_count() as f64 * 4.0_f64.powi(rounds as i32);
    check_size("rounds", params.rounds, edges)?;
    let mut fine: Option<Mesh> = None;
    for round in 0..params.rounds {
        if context.progress.is_cancelled() {
            return Err(OpError::Cancelled);
        }
        context.progress.report("removing middles", round as usize, params.rounds as usize);
        let coarse = fine.as_ref().unwrap_or(mesh);
        fine = Some(once(coarse, context.progress)?);
    }
    let mut fine = fine.expect("there is at least one round");
    let flat_faces = dissolve_flat_faces(mesh, &mut fine);
    part_rims(&mut fine, &mut NewElements::default());
    let loops = fine.edges().filter(|e| is_loop(&fine, e.half_edge())).count();
    Ok((fine, SierpinskiReport { kinds, loops, flat_faces }))
}

/// Takes out the faces whose corners lie on one line, where the mesh before had none: corners of
/// straight angles leave them. Returns how many.
fn dissolve_flat_faces(mesh: &Mesh, fine: &mut Mesh) -> usize {
    if !mesh.file_faults().is_empty() {
        return 0;
    }
    let faults = fine.file_faults();
    let count = dissolve_lines(fine, &faults);
    if count > 0 {
        fine.compact();
    }
    count
}

/// The kinds of the vertices of a mesh in words, and what to expect of each; known before the first
/// round.
pub fn sierpinski_preview(mesh: &Mesh) -> Vec<String> {
    kinds_in_words(count_kinds(mesh))
}

fn kinds_in_words(kinds: [usize; 6]) -> Vec<String> {
    let counted = || VertexKind::ALL.iter().zip(kinds).filter(|&(_, count)| count > 0);
    let list: Vec<String> =
        counted().map(|(kind, count)| format!("{count} {}", kind.name())).collect();
    let mut notes = vec![format!("vertices before the first round: {}", list.join(", "))];
    notes.extend(
        counted().filter_map(|(kind, _)| {
            kind.expectation().map(|text| format!("{}: {text}", kind.name()))
        }),
    );
    notes
}

fn count_kinds(mesh: &Mesh) -> [usize; 6] {
    let mut kinds = [0; 6];
    for v in mesh.vertices() {
        kinds[vertex_kind(mesh, v) as usize] += 1;
    }
    kinds
}

fn is_loop(mesh: &Mesh, h: HalfEdgeId) -> bool {
    mesh.origin(h) == mesh.target(h)
}

/// The next half-edge around the face that is no loop.
fn next_straight(mesh: &Mesh, h: HalfEdgeId) -> HalfEdgeId {
    let mut next = mesh.next(h);
    while is_loop(mesh, next) {
        next = mesh.next(next);
    }
    next
}

/// Stands for a half-edge that is not made.
const NOT_MADE: HalfEdgeId = HalfEdgeId(u32::MAX);

/// Half-edges of the fine mesh that stand for half-edges of the coarse one.
struct Links<'a> {
    coarse: &'a Mesh,
    /// From the middle of a straight half-edge to its end; a loop for a loop.
    second: HalfEdgeMap<HalfEdgeId>,
    /// From the middle of a straight half-edge of a face to the middle of the next: it cuts off the
    /// corner at its end.
    cut: HalfEdgeMap<HalfEdgeId>,
    /// The new loop at the middle of a half-edge, entered from its face.
    ring: HalfEdgeMap<HalfEdgeId>,
    /// Whether the base that would reach the middle of a half-edge from its face is left out.
    is_open: HalfEdgeMap<bool>,
}

/// The half-edges that bases reach which run into the rim. None has a loop at its middle, where no
/// base would use one of its sides.
fn open_bases(coarse: &Mesh) -> HalfEdgeMap<bool> {
    let mut is_open = HalfEdgeMap::filled(coarse.half_edge_slots(), false);
    if coarse.is_closed() {
        return is_open;
    }
    let mut is_done = HalfEdgeMap::filled(coarse.half_edge_slots(), false);
    let mut reached = Vec::new();
    let sides = coarse.faces().flat_map(|f| coarse.face_half_edges(f));
    for start in sides.filter(|&h| !is_loop(coarse, h)) {
        reached.clear();
        let (mut h, mut meets_rim) = (start, false);
        while !std::mem::replace(&mut is_done[h], true) {
            let next = next_straight(coarse, h);
            if coarse.is_rim(next.edge()) {
                meets_rim = true;
                h = next;
            } else {
                reached.push(next);
                h = next.twin();
            }
        }
        if meets_rim {
            reached.iter().for_each(|&next| is_open[next] = true);
        }
    }
    is_open
}

fn once(coarse: &Mesh, progress: &dyn Progress) -> Result<Mesh, OpError> {
    let (v, e) = (coarse.vertex_count(), coarse.edge_count());
    let mut fine = WalkBuilder::with_capacity(v + e, 5 * e, 3 * e);
    let links = Links::make(coarse, &mut fine, progress)?;
    let mut inherited = Vec::new();
    let mut bases = Bases::new(&links);
    for (turn, f) in coarse.faces().enumerate() {
        ask(progress, turn)?;
        let faces = links.corners(f, &mut fine);
        if let Some(name) = coarse.group(f) {
            inherited.push((faces, name));
        }
        bases.make_at(f, &mut fine);
    }
    // Building takes the most memory, and needs none of these.
    drop((bases.is_done, links));
    let mut fine = fine.build();
    for (faces, name) in inherited {
        faces.for_each(|f| fine.set_group(FaceId::new(f), name));
    }
    Ok(fine)
}

impl<'a> Links<'a> {
    fn make(
        coarse: &'a Mesh,
        fine: &mut WalkBuilder,
        progress: &dyn Progress,
    ) -> Result<Self, OpError> {
        let none = || HalfEdgeMap::filled(coarse.half_edge_slots(), NOT_MADE);
        let is_open = open_bases(coarse);
        let mut links = Self { coarse, second: none(), cut: none(), ring: none(), is_open };
        let mut kept = vec![VertexId::new(0); coarse.vertex_slots()];
        coarse.vertices().for_each(|v| kept[v.index()] = fine.vertex(coarse.position(v)));
        let mut middles = vec![None; coarse.edge_slots()];
        // Face by face, so that what lies near each other has numbers near each other, and the next
        // round finds it in the cache.
        for (turn, f) in coarse.faces().enumerate() {
            ask(progress, turn)?;
            for h in coarse.face_half_edges(f) {
                if middles[h.edge().index()].is_none() {
                    middles[h.edge().index()] = Some(links.halve(h.edge(), &kept, fine));
                }
            }
            for h in coarse.face_half_edges(f).filter(|&h| !is_loop(coarse, h)) {
                let ends = [h, next_straight(coarse, h)]
                    .map(|h| middles[h.edge().index()].expect("it was halved"));
                links.cut[h] = fine.edge(ends[0], ends[1]);
            }
        }
        for e in coarse.edges().filter(|e| middles[e.index()].is_none()) {
            links.halve(e, &kept, fine);
        }
        Ok(links)
    }

    /// Divides an edge in the middle, with a loop there; a loop stays as it is. Returns the middle,
    /// or where the loop is.
    fn halve(&mut self, edge: EdgeId, kept: &[VertexId], fine: &mut WalkBuilder) -> VertexId {
        let coarse = self.coarse;
        let [h, t] = edge.half_edges();
        let [a, b] = [h, t].map(|h| kept[coarse.origin(h).index()]);
        if a == b {
            self.second[h] = fine.edge(a, a);
            self.second[t] = self.second[h].twin();
            return a;
        }
        let [p, q] = coarse.edge_positions(edge);
        let middle = fine.vertex(p.midpoint(q));
        self.second[h] = fine.edge(middle, b);
        self.second[t] = fine.edge(middle, a);
        if !coarse.is_rim(edge) && !self.is_open[h] && !self.is_open[t] {
            self.ring[h] = fine.edge(middle, middle);
            self.ring[t] = self.ring[h].twin();
        }
        middle
    }

    /// The faces at the corners of an old face, each with the loops that lie in its corner. Returns
    /// their numbers.
    fn corners(&self, f: FaceId, fine: &mut WalkBuilder) -> std::ops::Range<usize> {
        let coarse = self.coarse;
        let mut made: Option<std::ops::Range<usize>> = None;
        for h in coarse.face_half_edges(f).filter(|&h| !is_loop(coarse, h)) {
            let next = next_straight(coarse, h);
            let loops = std::iter::successors(Some(coarse.next(h)), |&l| Some(coarse.next(l)));
            let loops = loops.take_while(|&l| l != next).map(|l| self.second[l]);
            let back = self.second[next.twin()].twin();
            let walk =
                std::iter::once(self.second[h]).chain(loops).chain([back, self.cut[h].twin()]);
            let face = fine.face(walk).index();
            made = Some(made.map_or(face, |range| range.start)..face + 1);
        }
        made.unwrap_or_else(|| {
            let face = fine.face(coarse.face_half_edges(f).map(|l| self.second[l])).index();
            face..face + 1
        })
    }
}

/// The bases of the pyramids, seen from outside through the openings: cuts around a vertex, joined
/// by the new loops.
struct Bases<'a> {
    links: &'a Links<'a>,
    is_done: HalfEdgeMap<bool>,
    walk: Vec<HalfEdgeId>,
}

impl<'a> Bases<'a> {
    fn new(links: &'a Links<'a>) -> Self {
        Self {
            links,
            is_done: HalfEdgeMap::filled(links.coarse.half_edge_slots(), false),
            walk: Vec::new(),
        }
    }

    /// Makes the bases that begin in a face.
    fn make_at(&mut self, f: FaceId, fine: &mut WalkBuilder) {
        let coarse = self.links.coarse;
        for start in coarse.face_half_edges(f).filter(|&h| !is_loop(coarse, h)) {
            self.walk.clear();
            let mut h = start;
            let mut is_open = false;
            while !std::mem::replace(&mut self.is_done[h], true) {
                let next = next_straight(coarse, h);
                self.walk.push(self.links.cut[h]);
                h = if coarse.is_rim(next.edge()) {
                    is_open = true;
                    next
                } else {
                    let ring = self.links.ring[next];
                    self.walk.extend(Some(ring).filter(|&ring| ring != NOT_MADE));
                    next.twin()
                };
            }
            if !self.walk.is_empty() && !is_open {
                fine.face(self.walk.iter().copied());
            }
        }
    }
}
