//! Flat regions made one face each, and vertices on straight runs taken out.

use std::collections::HashMap;

use glam::DVec3;

use super::flat::{Discs, flat_patches};
use crate::geom::{RoundingBound, nearest_on_segment};
use crate::measure::self_contact;
use crate::mesh::{
    BuildError, EdgeId, FaceId, FaceMap, HalfEdgeId, Mesh, MeshBuilder, VertexId, VertexMap,
};

/// What merging did. Ids are those of the result.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Merged {
    /// How many faces there were.
    pub faces_before: usize,
    /// The faces that were made of several.
    pub made: Vec<FaceId>,
    /// Regions around a hole: a face is one ring, so each of them is two faces or more.
    pub divided_regions: usize,
    /// Regions left as they were, since their ring would have met itself.
    pub left_regions: usize,
    /// How many vertices on straight runs were taken out.
    pub straight_vertices: usize,
}

/// Makes every flat region one face, as far as a face can be: it is one ring of different corners,
/// so a region around a hole becomes two or more. `tolerance` is how far a corner may lie from the
/// plane of its region, and a vertex with two edges from the straight line that takes its place, in
/// mm. Groups and seams stay: nothing is merged across them.
///
/// # Errors
/// [`BuildError`] when the mesh has what no file of polygons can hold: faces with two sides,
/// self-loops.
pub fn merge_flat(mesh: &Mesh, tolerance: f64) -> Result<(Mesh, Merged), BuildError> {
    let mut patches = flat_patches(mesh, tolerance).patches;
    let (low, high) = mesh.bounds().unwrap_or_default();
    let near = tolerance.max(RoundingBound::of_box(low, high).length());
    let mut left_regions = 0;
    loop {
        let (result, mut report, sources) = merge_patches(mesh, &patches, near)?;
        let is_bad = |f: &FaceId| self_contact(&result, *f).is_some();
        let bad: Vec<FaceId> =
            report.made.iter().filter(|f| is_bad(f)).map(|f| sources[f.index()]).collect();
        if bad.is_empty() {
            report.left_regions = left_regions;
            return Ok((result, report));
        }
        // Those regions stay as they were; each round takes out one at least.
        let is_left = |patch: &[FaceId]| bad.iter().any(|f| patch.binary_search(f).is_ok());
        let (whole, kept): (Vec<_>, Vec<_>) = patches.into_iter().partition(|p| is_left(p));
        left_regions += whole.len();
        patches = kept;
        patches.extend(whole.into_iter().flatten().map(|f| vec![f]));
        patches.sort_unstable_by_key(|patch| patch[0]);
    }
}

/// Also returns the lowest face that each face of the result was made of.
fn merge_patches(
    mesh: &Mesh,
    patches: &[Vec<FaceId>],
    near: f64,
) -> Result<(Mesh, Merged, Vec<FaceId>), BuildError> {
    let mut discs = Discs::new(mesh);
    let mut report = Merged { faces_before: mesh.face_count(), ..Merged::default() };
    for patch in patches {
        report.divided_regions += usize::from(discs.divide(mesh, patch) > 1);
    }
    let runs = StraightRuns::of(mesh, &discs.of, near);
    report.straight_vertices = runs.removed;
    let mut sizes = vec![0_u32; discs.count as usize + 1];
    mesh.faces().for_each(|f| sizes[discs.of[f] as usize] += 1);
    let mut sources = Vec::with_capacity(discs.count as usize);
    let mut rings = Vec::with_capacity(discs.count as usize);
    let mut is_done = vec![false; discs.count as usize + 1];
    for f in mesh.faces() {
        if std::mem::replace(&mut is_done[discs.of[f] as usize], true) {
            continue;
        }
        let ring = ring(mesh, &discs.of, f);
        rings.push(ring.into_iter().filter(|&v| !runs.is_removed[v]).collect::<Vec<_>>());
        if sizes[discs.of[f] as usize] > 1 {
            report.made.push(FaceId::new(sources.len()));
        }
        sources.push(f);
    }
    let result = build(mesh, &discs.of, &rings, &sources, &runs)?;
    Ok((result, report, sources))
}

/// The corners around the disc of a face.
fn ring(mesh: &Mesh, disc: &FaceMap<u32>, f: FaceId) -> Vec<VertexId> {
    // The first face of a disc may lie inside it; then one at its border is looked for.
    let is_border = |h: HalfEdgeId| disc[mesh.face(h)] != disc[mesh.face(h.twin())];
    let mut open = vec![f];
    let mut seen = std::collections::HashSet::from([f]);
    let mut start = None;
    while let (None, Some(g)) = (start, open.pop()) {
        start = mesh.face_half_edges(g).find(|&h| is_border(h));
        for h in mesh.face_half_edges(g) {
            let other = mesh.face(h.twin());
            if disc[other] == disc[f] && seen.insert(other) {
                open.push(other);
            }
        }
    }
    let Some(start) = start else { return mesh.face_vertices(f).collect() };
    let mut ring = Vec::new();
    let mut h = start;
    loop {
        ring.push(mesh.origin(h));
        h = mesh.next(h);
        while !is_border(h) {
            h = mesh.next(h.twin());
        }
        if h == start {
            return ring;
        }
    }
}

/// The vertices with two edges left that lie on the straight line between those that stay.
struct StraightRuns {
    is_removed: VertexMap<bool>,
    removed: usize,
    /// The seams that are left, by their ends.
    seams: Vec<[VertexId; 2]>,
}

impl StraightRuns {
    fn of(mesh: &Mesh, disc: &FaceMap<u32>, near: f64) -> Self {
        let stays = |e: EdgeId| {
            let [f, g] = mesh.edge_faces(e);
            f != g && disc[f] != disc[g]
        };
        let mut runs = Self {
            is_removed: VertexMap::filled(mesh.vertex_slots(), false),
            removed: 0,
            seams: Vec::new(),
        };
        let chains = chains(mesh, &stays);
        let kept: Vec<Vec<VertexId>> =
            chains.iter().map(|(chain, _)| straightened(mesh, chain, near)).collect();
        let mut singles: HashMap<[VertexId; 2], usize> = HashMap::new();
        let key = |chain: &[VertexId]| {
            let (a, b) = (chain[0], chain[chain.len() - 1]);
            [a.min(b), a.max(b)]
        };
        for chain in kept.iter().filter(|chain| chain.len() == 2) {
            *singles.entry(key(chain)).or_default() += 1;
        }
        for ((chain, is_seam), mut kept) in chains.iter().zip(kept) {
            // Two edges between the same vertices would be one edge in a file.
            if kept.len() == 2 && chain.len() > 2 && singles[&key(&kept)] > 1 {
                kept.insert(1, farthest(mesh, chain).0);
            }
            let mut next_kept = kept.iter().peekable();
            for v in chain {
                // What is kept comes in the order of the chain.
                if next_kept.next_if_eq(&v).is_none() {
                    runs.is_removed[*v] = true;
                    runs.removed += 1;
                }
            }
            if *is_seam {
                runs.seams.extend(kept.windows(2).map(|w| [w[0], w[1]]));
            }
        }
        runs
    }
}

/// The edges that stay in chains between vertices where other than two of them meet, or where a
/// seam begins; a chain without such a vertex begins and ends at its lowest one.
fn chains(mesh: &Mesh, stays: &dyn Fn(EdgeId) -> bool) -> Vec<(Vec<VertexId>, bool)> {
    let is_inner = |v: VertexId| {
        let mut edges = mesh.outgoing(v).map(HalfEdgeId::edge).filter(|&e| stays(e));
        match (edges.next(), edges.next(), edges.next()) {
            (Some(a), Some(b), None) => mesh.is_seam(a) == mesh.is_seam(b),
            _ => false,
        }
    };
    let mut is_done = vec![false; mesh.edge_slots()];
    let mut chains = Vec::new();
    let mut walk = |start: HalfEdgeId, chains: &mut Vec<_>| {
        let first = mesh.origin(start);
        let mut chain = vec![first];
        let mut h = start;
        while !std::mem::replace(&mut is_done[h.edge().index()], true) {
            let v = mesh.target(h);
            chain.push(v);
            if v == first || !is_inner(v) {
                break;
            }
            let onwards = mesh.outgoing(v).find(|out| stays(out.edge()) && *out != h.twin());
            match onwards {
                Some(out) => h = out,
                None => break,
            }
        }
        if chain.len() > 1 {
            chains.push((chain, mesh.is_seam(start.edge())));
        }
    };
    // First from the ends, then what has none.
    for from_ends in [true, false] {
        for v in mesh.vertices().filter(|&v| is_inner(v) != from_ends) {
            let leaving: Vec<HalfEdgeId> = mesh.outgoing(v).filter(|h| stays(h.edge())).collect();
            leaving.into_iter().for_each(|h| walk(h, &mut chains));
        }
    }
    chains
}

/// The vertices of a chain that stay, so that none that goes lies farther from the line that takes
/// its place than `near` (Ramer 1972; Douglas, Peucker 1973). A closed chain keeps three.
fn straightened(mesh: &Mesh, chain: &[VertexId], near: f64) -> Vec<VertexId> {
    let last = chain.len() - 1;
    let mut stays = vec![false; chain.len()];
    (stays[0], stays[last]) = (true, true);
    let mut open = vec![(0, last)];
    if chain[0] == chain[last] {
        let first = mesh.position(chain[0]);
        let way = |&i: &usize| mesh.position(chain[i]).distance_squared(first);
        let far = (1..last).max_by(|a, b| way(a).total_cmp(&way(b))).unwrap_or(0);
        stays[far] = true;
        open = vec![(0, far), (far, last)];
        let line = [first, mesh.position(chain[far])];
        let off = |&i: &usize| distance_to(mesh.position(chain[i]), line);
        let third = (1..last).filter(|&i| i != far).max_by(|a, b| off(a).total_cmp(&off(b)));
        if let Some(third) = third {
            stays[third] = true;
            open.retain(|&(a, b)| !(a < third && third < b));
            let (a, b) = if third < far { (0, far) } else { (far, last) };
            open.extend([(a, third), (third, b)]);
        }
    }
    while let Some((a, b)) = open.pop() {
        if b < a + 2 {
            continue;
        }
        let line = [mesh.position(chain[a]), mesh.position(chain[b])];
        let off = |i: usize| distance_to(mesh.position(chain[i]), line);
        let worst = (a + 1..b).max_by(|&i, &j| off(i).total_cmp(&off(j))).unwrap_or(a);
        if off(worst) > near {
            stays[worst] = true;
            open.extend([(a, worst), (worst, b)]);
        }
    }
    (0..chain.len()).filter(|&i| stays[i]).map(|i| chain[i]).collect()
}

/// The inner vertex of a chain that lies farthest from the line between its ends, and how far.
fn farthest(mesh: &Mesh, chain: &[VertexId]) -> (VertexId, f64) {
    let line = [chain[0], chain[chain.len() - 1]].map(|v| mesh.position(v));
    let inner = chain[1..chain.len() - 1].iter();
    inner
        .map(|&v| (v, distance_to(mesh.position(v), line)))
        .max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))
        .unwrap_or((chain[0], 0.0))
}

fn distance_to(p: DVec3, line: [DVec3; 2]) -> f64 {
    nearest_on_segment(p, line).distance(p)
}

fn build(
    mesh: &Mesh,
    disc: &FaceMap<u32>,
    rings: &[Vec<VertexId>],
    sources: &[FaceId],
    runs: &StraightRuns,
) -> Result<Mesh, BuildError> {
    let mut builder = MeshBuilder::new();
    let mut number = VertexMap::filled(mesh.vertex_slots(), u32::MAX);
    let mut used: Vec<VertexId> = rings.iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    for &v in &used {
        number[v] = builder.vertex(mesh.position(v)) as u32;
    }
    for ring in rings {
        builder.face(ring.iter().map(|&v| number[v] as usize));
    }
    let (mut result, splits) = builder.build()?;
    let mut of = used.clone();
    of.extend(splits.iter().map(|split| used[split.given.index()]));
    for (i, &v) in of.iter().enumerate() {
        result.set_position(VertexId::new(i), mesh.position(v), mesh.is_given(v));
    }
    let mut sizes = vec![0_u32; sources.len() + 1];
    mesh.faces().for_each(|f| sizes[disc[f] as usize] += 1);
    for (i, &source) in sources.iter().enumerate() {
        let f = FaceId::new(i);
        if let Some(name) = mesh.group(source) {
            result.set_group(f, name);
        }
        if let Some(plane) =
            mesh.carried_plane(source).filter(|_| sizes[disc[source] as usize] == 1)
        {
            result.set_plane(f, plane);
        }
    }
    for [a, b] in &runs.seams {
        let ends = [a, b].map(|v| VertexId::new(number[*v] as usize));
        if let Some(e) = result.edge_between(ends[0], ends[1]) {
            result.set_seam(e, true);
        }
    }
    Ok(result)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::cube;
    use crate::measure::{surface_area, volume};
    use crate::mesh::assert_sound;

    /// A cube of 2 with every face divided into n × n squares of two triangles.
    fn fine_cube(n: usize) -> Mesh {
        let mut places: HashMap<[i64; 3], usize> = HashMap::new();
        let mut points = Vec::new();
        let mut faces = Vec::new();
        for axis in 0..3 {
            for side in [0_i64, n as i64] {
                let mut at = |i: usize, j: usize| {
                    let mut key = [0_i64; 3];
                    key[axis] = side;
                    key[(axis + 1) % 3] = i as i64;
                    key[(axis + 2) % 3] = j as i64;
                    *places.entry(key).or_insert_with(|| {
                        let p = key.map(|k| 2.0 * k as f64 / n as f64);
                        points.push(DVec3::from_array(p));
                        points.len() - 1
                    })
                };
                for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
                    let quad = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                    let turn = |t: [usize; 3]| if side == 0 { [t[0], t[2], t[1]] } else { t };
                    faces.push(turn([quad[0], quad[1], quad[2]]));
                    faces.push(turn([quad[0], quad[2], quad[3]]));
                }
            }
        }
        Mesh::from_faces(points, faces).expect("a cube")
    }

    #[test]
    fn a_finely_divided_cube_is_a_cube_again() {
        let fine = fine_cube(5);
        assert_eq!(fine.face_count(), 300);
        let (result, report) = merge_flat(&fine, 1e-6).expect("merged");
        assert_sound(&result);
        assert_eq!((result.vertex_count(), result.edge_count(), result.face_count()), (8, 12, 6));
        assert_eq!((report.faces_before, report.made.len(), report.divided_regions), (300, 6, 0));
        assert_eq!(report.straight_vertices, 12 * 4);
        assert!((volume(&result) - 8.0).abs() < 1e-12);
        let (again, nothing) = merge_flat(&result, 1e-6).expect("merged");
        assert_eq!(again.face_count(), 6);
        assert!(nothing.made.is_empty() && nothing.straight_vertices == 0);
    }

    #[test]
    fn groups_and_seams_keep_faces_apart() {
        let mut fine = fine_cube(2);
        // Half of the faces of the first side belong to a group.
        let first: Vec<FaceId> = fine.faces().take(4).collect();
        first.iter().for_each(|&f| fine.set_group(f, "half"));
        let (result, _) = merge_flat(&fine, 1e-6).expect("merged");
        assert_eq!(result.face_count(), 7);
        assert_eq!(result.faces().filter(|&f| result.group(f) == Some("half")).count(), 1);
        let mut fine = fine_cube(2);
        let seam = fine.edges().find(|&e| {
            let [f, g] = fine.edge_faces(e).map(FaceId::index);
            f / 2 == g / 2
        });
        fine.set_seam(seam.expect("a diagonal"), true);
        let (result, _) = merge_flat(&fine, 1e-6).expect("merged");
        assert_sound(&result);
        assert_eq!(result.edges().filter(|&e| result.is_seam(e)).count(), 1);
        assert!((7..10).contains(&result.face_count()), "{}", result.face_count());
    }

    #[test]
    fn a_plate_with_a_window_is_left_in_two_simple_faces() {
        // A flat frame: four squares around a hole at each side, and corners.
        let mut points = Vec::new();
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
            points.push(DVec3::new(i as f64, j as f64, 0.0));
        }
        let mut faces = Vec::new();
        for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
            if (i, j) != (1, 1) {
                let at = |i: usize, j: usize| 4 * i + j;
                faces.push([at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
        let mesh = Mesh::from_faces(points, faces).expect("a frame");
        let (result, report) = merge_flat(&mesh, 1e-9).expect("merged");
        assert_sound(&result);
        assert_eq!((result.face_count(), report.divided_regions, result.hole_count()), (2, 1, 2));
        assert!(result.file_faults().is_empty());
        assert!((surface_area(&result) - 8.0).abs() < 1e-12);
        assert!(result.faces().all(|f| self_contact(&result, f).is_none()));
    }

    #[test]
    fn what_is_no_flat_region_stays_byte_for_byte() {
        let mesh = cube();
        let (result, report) = merge_flat(&mesh, 1e-9).expect("merged");
        let places = |mesh: &Mesh| mesh.vertices().map(|v| mesh.position(v)).collect::<Vec<_>>();
        assert_eq!(places(&result), places(&mesh));
        assert!(report.made.is_empty());
    }
}
