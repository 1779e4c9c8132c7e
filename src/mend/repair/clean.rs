//! What needs no neighbours to be judged: vertices at one place, empty and doubled faces; and
//! vertices that lie on the sides of other faces.

use std::collections::{BTreeMap, HashMap};

use glam::DVec3;

use super::super::soup::{Soup, by_edge};
use super::super::weld::{remove_spikes, weld_targets};
use super::{Repair, Repairs};
use crate::geom::{AxisBox, BoxTree};

pub(super) fn weld(soup: &mut Soup, near: f64, repairs: &mut Repairs) {
    let mut is_used = vec![false; soup.positions.len()];
    soup.faces.iter().flat_map(|f| &f.corners).for_each(|&v| is_used[v as usize] = true);
    let target = weld_targets(&soup.positions, near);
    let welded = (0..target.len()).filter(|&v| is_used[v] && target[v] as usize != v).count();
    for face in &mut soup.faces {
        face.corners.iter_mut().for_each(|v| *v = target[*v as usize]);
        remove_spikes(&mut face.corners);
    }
    repairs.add(Repair::Welded, welded);
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
    let sides = soup.sides();
    let mut uses = vec![0_usize; sides.len()];
    for edge in by_edge(&sides) {
        edge.iter().for_each(|&s| uses[s as usize] = edge.len());
    }
    let mut first_side = 0;
    let mut met: HashMap<Vec<u32>, Vec<Vec<u32>>> = HashMap::new();
    let mut is_kept = Vec::with_capacity(before);
    for face in &soup.faces {
        let own = &uses[first_side..first_side + face.corners.len()];
        first_side += face.corners.len();
        let mut key = face.corners.clone();
        key.sort_unstable();
        let ring = from_lowest(&face.corners);
        let others = met.entry(key).or_default();
        let is_same = others.contains(&ring);
        let back: Vec<u32> = from_lowest(&face.corners.iter().rev().copied().collect::<Vec<_>>());
        let is_surplus = others.contains(&back) && own.iter().all(|uses| uses % 2 == 1);
        is_kept.push(!(is_same || is_surplus));
        if !(is_same || is_surplus) {
            others.push(ring);
        }
    }
    let mut kept = is_kept.into_iter();
    soup.faces.retain(|_| kept.next().unwrap_or(true));
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
    found.sort_by(|a, b| (a.0, a.1).cmp(&(b.0, b.1)));
    found
}
