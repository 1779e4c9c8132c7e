//! What needs no neighbours to be judged: vertices at one place, empty and doubled faces; and
//! vertices that lie on the sides of other faces.

use std::collections::{BTreeMap, HashSet};

use glam::DVec3;

use super::super::soup::{Soup, SoupFace, by_edge};
use super::super::weld::{remove_spikes, weld_targets};
use super::{Repair, Repairs};
use crate::geom::{AxisBox, BoxTree};

pub(super) fn weld(soup: &mut Soup, near: f64, repairs: &mut Repairs) {
    // Vertices of no face are nobody's place.
    let mut used: Vec<u32> = soup.faces.iter().flat_map(|f| f.corners.iter().copied()).collect();
    used.sort_unstable();
    used.dedup();
    let places: Vec<DVec3> = used.iter().map(|&v| soup.positions[v as usize]).collect();
    let mut target: Vec<u32> = (0..soup.positions.len() as u32).collect();
    for (&v, other) in used.iter().zip(weld_targets(&places, near)) {
        target[v as usize] = used[other as usize];
    }
    let welded = (0..target.len()).filter(|&v| target[v] as usize != v).count();
    let faces = std::mem::take(&mut soup.faces);
    for mut face in faces {
        face.corners.iter_mut().for_each(|v| *v = target[*v as usize]);
        remove_spikes(&mut face.corners);
        let rings = simple_rings(&face.corners).into_iter();
        soup.faces.extend(rings.map(|corners| SoupFace { corners, source: face.source }));
    }
    repairs.add(Repair::Welded, welded);
}

/// A ring that visits vertices more than once as rings that do not: what lies between two visits is
/// a ring of its own.
fn simple_rings(ring: &[u32]) -> Vec<Vec<u32>> {
    let (mut rings, mut open) = (Vec::new(), Vec::new());
    for &v in ring {
        if let Some(at) = open.iter().position(|&w| w == v) {
            rings.push(open.split_off(at));
        }
        open.push(v);
    }
    rings.push(open);
    // Of several rings those without area are nothing new; where all are, one stands for the face.
    if rings.iter().any(|ring| ring.len() > 2) {
        rings.retain(|ring| ring.len() > 2);
    }
    rings.truncate(rings.iter().filter(|ring| ring.len() > 2).count().max(1));
    rings
}

/// Drops faces that are narrower than `near`.
pub(super) fn drop_empty(soup: &mut Soup, near: f64, repairs: &mut Repairs) {
    let before = soup.faces.len();
    let is_empty = |corners: &[u32]| {
        let place = |v: u32| soup.positions[v as usize];
        let Some(&first) = corners.first() else { return true };
        let way = |v: &u32| place(*v).distance_squared(place(first));
        let Some(&far) = corners.iter().max_by(|a, b| way(a).total_cmp(&way(b))) else {
            return true;
        };
        // The line through two corners that are far apart; a corner off it gives the face area.
        let along = place(far) - place(first);
        let off = |v: &u32| (place(*v) - place(first)).cross(along).length();
        corners.len() < 3 || corners.iter().all(|v| off(v) <= near * along.length())
    };
    let kept: Vec<bool> = soup.faces.iter().map(|f| !is_empty(&f.corners)).collect();
    let mut kept = kept.into_iter();
    soup.faces.retain(|_| kept.next().unwrap_or(true));
    repairs.add(Repair::Empty, before - soup.faces.len());
}

/// Drops faces with the same corners as an earlier one. One that looks the other way goes only where
/// it is one too many: two solids that touch along a face both have it.
pub(super) fn drop_doubled(soup: &mut Soup, repairs: &mut Repairs) {
    let before = soup.faces.len();
    let mut met: HashSet<Vec<u32>> = HashSet::new();
    soup.faces.retain(|face| met.insert(from_lowest(&face.corners)));
    let sides = soup.sides();
    let mut uses = vec![0_usize; sides.len()];
    for edge in by_edge(&sides) {
        edge.iter().for_each(|&s| uses[s as usize] = edge.len());
    }
    let mut first_side = 0;
    let mut seen: HashSet<Vec<u32>> = HashSet::new();
    soup.faces.retain(|face| {
        let own = &uses[first_side..first_side + face.corners.len()];
        first_side += face.corners.len();
        let back: Vec<u32> = face.corners.iter().rev().copied().collect();
        let is_surplus = seen.contains(&from_lowest(&back)) && own.iter().all(|uses| uses % 2 == 1);
        seen.insert(from_lowest(&face.corners));
        !is_surplus
    });
    repairs.add(Repair::Doubled, before - soup.faces.len());
}

/// The same ring, from its lowest corner on.
fn from_lowest(ring: &[u32]) -> Vec<u32> {
    let start = (0..ring.len()).min_by_key(|&i| ring[i]).unwrap_or(0);
    ring[start..].iter().chain(&ring[..start]).copied().collect()
}

/// Makes corners of vertices that lie on a side that has no neighbour, and belong to such a side
/// themselves.
pub(super) fn take_in_junctions(soup: &mut Soup, near: f64, repairs: &mut Repairs) {
    let sides = soup.sides();
    let rims: Vec<u32> =
        by_edge(&sides).into_iter().filter(|e| e.len() == 1).map(|e| e[0]).collect();
    let mut ends: Vec<u32> =
        rims.iter().flat_map(|&s| [sides[s as usize].from, sides[s as usize].to]).collect();
    ends.sort_unstable();
    ends.dedup();
    let place = |v: u32| soup.positions[v as usize];
    let segments =
        rims.iter().map(|&s| [place(sides[s as usize].from), place(sides[s as usize].to)]);
    let found = on_segments(
        &segments.collect::<Vec<_>>(),
        &ends.iter().map(|&v| place(v)).collect::<Vec<_>>(),
        near,
    );
    // For each face and corner, what comes behind it, by how far along the side.
    let mut taken: BTreeMap<(u32, u32), Vec<(f64, u32)>> = BTreeMap::new();
    for (segment, point, along) in found {
        let side = sides[rims[segment] as usize];
        if !soup.faces[side.face as usize].corners.contains(&ends[point]) {
            taken.entry((side.face, side.corner)).or_default().push((along, ends[point]));
        }
    }
    let mut count = 0;
    // From the last corner on, so that the places of earlier ones stay.
    for ((face, corner), mut more) in taken.into_iter().rev() {
        more.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        more.dedup_by_key(|m| m.1);
        let corners = &mut soup.faces[face as usize].corners;
        more.retain(|m| !corners.contains(&m.1));
        count += more.len();
        let at = corner as usize + 1;
        corners.splice(at..at, more.into_iter().map(|m| m.1));
    }
    repairs.add(Repair::Junctions, count);
}

/// The points that lie within `near` of the inside of segments, each with the segment and its share
/// of the way.
pub(in crate::mend) fn on_segments(
    segments: &[[DVec3; 2]],
    points: &[DVec3],
    near: f64,
) -> Vec<(usize, usize, f64)> {
    let wide = DVec3::splat(near);
    let of_segment =
        |[a, b]: &[DVec3; 2]| AxisBox { low: a.min(*b) - wide, high: a.max(*b) + wide };
    let of_point = |p: &DVec3| AxisBox { low: *p, high: *p };
    let boxes: Vec<AxisBox> =
        segments.iter().map(of_segment).chain(points.iter().map(of_point)).collect();
    let mut found = Vec::new();
    BoxTree::new(&boxes).pairs(|i, j| {
        if i < segments.len() && j >= segments.len() {
            let ([a, b], p) = (segments[i], points[j - segments.len()]);
            let along = (p - a).dot(b - a) / (b - a).length_squared();
            let is_inside = p.distance(a) > near && p.distance(b) > near;
            if is_inside && (0.0..=1.0).contains(&along) && p.distance(a.lerp(b, along)) <= near {
                found.push((i, j - segments.len(), along));
            }
        }
        true
    });
    found.sort_by_key(|&(segment, point, _)| (segment, point));
    found
}
