//! Turning edges: where an edge is too short, or a panel does not become star-shaped, two panels
//! part and two others meet (the T1 move of foams; Weaire, Hutzler 1999).

use glam::{DMat3, DVec3};

use super::regions::Kind;
use super::solve::{Run, Scene, State, Weights};
use super::start::{TURNED, meeting_point};
use super::surface::NONE;

/// Edges shorter than this may be turned, in panel sizes.
const SHORT: f64 = 0.14;
/// Faces with less of a star are broken.
const LEAST_STAR: f64 = 0.02;
/// Rounds of solving after turns.
const ROUNDS: usize = 14;
/// So many rings of panels around a turned edge are solved for.
const RINGS: usize = 4;
/// The most passes.
const PASSES: usize = 4;
/// Faces keep at least and at most so many sides.
const SIDES: std::ops::RangeInclusive<usize> = 4..=9;

/// An edge that was turned, the faces around it, and their score before.
struct Turn {
    edge: [usize; 2],
    ring: Vec<usize>,
    score: f64,
    /// Where its ends were.
    places: [DVec3; 2],
}

/// Turns edges where that makes the panels around better, and solves for the panels near them.
pub(super) fn turn_edges(
    state: &mut State,
    scene: Scene<'_>,
    weights: Weights,
    mut is_cancelled: impl FnMut() -> bool,
) {
    let mut tried: Vec<[usize; 2]> = Vec::new();
    for _ in 0..PASSES {
        if is_cancelled() {
            break;
        }
        let turns = turn_some(state, scene, &mut tried);
        if turns.is_empty() {
            break;
        }
        solve_near(state, scene, weights, &turns);
        let worse: Vec<Turn> = turns
            .into_iter()
            .filter(|turn| score(state, &turn.ring) >= turn.score - 0.02)
            .collect();
        if worse.is_empty() {
            continue;
        }
        for turn in &worse {
            let [u, v] = turn.edge;
            // Turned twice, the ends of an edge have changed places.
            if turn_images(state, u, v) {
                let [at_u, at_v] = turn.places;
                (state.panels.points[u], state.panels.points[v]) = (at_v, at_u);
            }
        }
        state.link();
        state.spread();
        solve_near(state, scene, weights, &worse);
    }
}

/// Turns the worst edges that do not share panels.
fn turn_some(state: &mut State, scene: Scene<'_>, tried: &mut Vec<[usize; 2]>) -> Vec<Turn> {
    let mut used = vec![false; state.panels.faces.len()];
    let mut turns = Vec::new();
    for (_, [u, v]) in candidates(state) {
        let Some(sides) = sides_of(state, u, v) else { continue };
        let pair = [sides[0].min(sides[1]), sides[0].max(sides[1])];
        let ring = ring_of(state, &sides);
        if tried.contains(&pair) || ring.iter().any(|&f| used[f]) {
            continue;
        }
        tried.push(pair);
        let places = [u, v].map(|c| state.panels.points[c]);
        let turn = Turn { edge: [u, v], score: score(state, &ring), ring, places };
        if turn_images(state, u, v) {
            turn.ring.iter().for_each(|&f| used[f] = true);
            place_ends(state, scene, [u, v], sides);
            turns.push(turn);
        }
    }
    state.link();
    state.spread();
    turns
}

/// Edges that may be turned, the shortest first.
fn candidates(state: &State) -> Vec<(f64, [usize; 2])> {
    let mut found = Vec::new();
    for (f, face) in state.panels.faces.iter().enumerate() {
        let length = |i: usize| {
            let [u, v] = [face[i], face[(i + 1) % face.len()]];
            state.panels.points[u].distance(state.panels.points[v])
        };
        let shortest = (0..face.len()).map(length).fold(f64::INFINITY, f64::min);
        let is_broken = state.least_star(f) < 0.5 * LEAST_STAR;
        for i in 0..face.len() {
            let [u, v] = [face[i], face[(i + 1) % face.len()]];
            let may = state.is_inner_corner(u) && state.is_inner_corner(v)
                || is_on_crease(state, f, [u, v]);
            let may = may && ![u, v].iter().any(|v| state.panels.held.contains_key(v));
            if may && (length(i) < SHORT || is_broken && length(i) <= shortest) {
                found.push((length(i), [u.min(v), u.max(v)]));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    found.dedup();
    found
}

/// Whether an edge runs along a crease from a corner at which one side changes to one at which the
/// other does. Such corners may change places.
fn is_on_crease(state: &State, f: usize, [u, v]: [usize; 2]) -> bool {
    let kinds = &state.panels.kinds;
    if kinds[u] != Kind::Crease || kinds[v] != Kind::Crease {
        return false;
    }
    // Whether the edge of f that goes on from `corner` leaves the crease.
    let leaves = |f: usize, corner: usize, other: usize| {
        let face = &state.panels.faces[f];
        let i = face.iter().position(|&c| c == corner)?;
        let sides = [face[(i + 1) % face.len()], face[(i + face.len() - 1) % face.len()]];
        let next = sides.into_iter().find(|&c| c != other)?;
        Some(!kinds[next].is_on_crease())
    };
    let both = state.fans[u].iter().copied().filter(|g| state.fans[v].contains(g));
    let both: Vec<usize> = both.collect();
    let &[g, h] = &both[..] else { return false };
    let ways = |g: usize| [leaves(g, u, v), leaves(g, v, u)];
    both.contains(&f)
        && matches!(
            (ways(g), ways(h)),
            ([Some(true), Some(false)], [Some(false), Some(true)])
                | ([Some(false), Some(true)], [Some(true), Some(false)])
        )
}

/// The four faces at an edge between two inner corners: the ones that run along it from u to v and
/// from v to u, then those that only have u and only have v.
fn sides_of(state: &State, u: usize, v: usize) -> Option<[usize; 4]> {
    let runs = |f: usize, a: usize, b: usize| {
        let face = &state.panels.faces[f];
        (0..face.len()).any(|i| face[i] == a && face[(i + 1) % face.len()] == b)
    };
    let has = |f: usize, c: usize| state.panels.faces[f].contains(&c);
    let (at_u, at_v) = (&state.fans[u], &state.fans[v]);
    let left = at_u.iter().copied().find(|&f| runs(f, u, v))?;
    let right = at_u.iter().copied().find(|&f| runs(f, v, u))?;
    let only_u = at_u.iter().copied().find(|&f| !has(f, v))?;
    let only_v = at_v.iter().copied().find(|&f| !has(f, u))?;
    (only_u != only_v).then_some([left, right, only_u, only_v])
}

/// The faces of an edge and their neighbours, ascending.
fn ring_of(state: &State, sides: &[usize; 4]) -> Vec<usize> {
    let around = sides.iter().flat_map(|&f| &state.across[f]).copied().filter(|&f| f != NONE);
    let mut ring: Vec<usize> = sides.iter().copied().chain(around).collect();
    ring.sort_unstable();
    ring.dedup();
    ring
}

/// Turns an edge and all its images across mirror planes, if it has any and they are far enough from
/// each other. Whether they were turned.
fn turn_images(state: &mut State, u: usize, v: usize) -> bool {
    let Some(symmetry) = &state.symmetry else { return turn_edge(state, u, v) };
    let is_first = |c: usize| symmetry.first[c] == c && symmetry.image[c] == DMat3::IDENTITY;
    if !is_first(u) || !is_first(v) {
        return false;
    }
    let images = |c: usize| {
        let all = 0..symmetry.first.len();
        all.filter(move |&d| symmetry.first[d] == c).map(|d| (d, symmetry.image[d]))
    };
    let of_v: Vec<(usize, DMat3)> = images(v).collect();
    let pair = |(a, way): (usize, DMat3)| {
        of_v.iter().find(|(_, other)| *other == way).map(|&(b, _)| ([a, b], way))
    };
    let pairs: Vec<([usize; 2], DMat3)> = images(u).filter_map(pair).collect();
    let mut around: Vec<usize> = Vec::new();
    for &([a, b], _) in &pairs {
        let Some(sides) = sides_of(state, a, b) else { return false };
        if sides.iter().any(|f| around.contains(f)) {
            return false;
        }
        around.extend(sides);
    }
    if !turn_edge(state, u, v) {
        return false;
    }
    for ([a, b], way) in pairs.into_iter().filter(|&([a, _], _)| a != u) {
        turn_edge(state, a, b);
        // A mirror image turns the other way, so its ends change places.
        if let (Some(symmetry), true) = (&mut state.symmetry, way.determinant() < 0.0) {
            symmetry.first.swap(a, b);
            symmetry.image.swap(a, b);
        }
    }
    true
}

/// Turns an edge: the faces along it lose a corner each, the others gain one. Whether it could be
/// turned; the links of the state are not brought up to date.
fn turn_edge(state: &mut State, u: usize, v: usize) -> bool {
    let Some([left, right, only_u, only_v]) = sides_of(state, u, v) else { return false };
    let count = |f: usize| state.panels.faces[f].len();
    let loses = [left, right].iter().all(|&f| count(f) > *SIDES.start());
    let gains = [only_u, only_v].iter().all(|&f| count(f) < *SIDES.end());
    if !loses || !gains || state.across[only_u].contains(&only_v) {
        return false;
    }
    let faces = &mut state.panels.faces;
    faces[left].retain(|&c| c != v);
    faces[right].retain(|&c| c != u);
    let insert = |face: &mut Vec<usize>, new: usize, before: usize| {
        let at = face.iter().position(|&c| c == before);
        face.insert(at.unwrap_or(0), new);
    };
    insert(&mut faces[only_u], v, u);
    insert(&mut faces[only_v], u, v);
    state.fans[u] = vec![left, only_u, only_v];
    state.fans[v] = vec![right, only_u, only_v];
    state.fans[u].sort_unstable();
    state.fans[v].sort_unstable();
    true
}

/// Puts the ends of a turned edge where the tangent planes of their faces meet.
fn place_ends(
    state: &mut State,
    scene: Scene<'_>,
    [u, v]: [usize; 2],
    [left, right, only_u, only_v]: [usize; 4],
) {
    if state.panels.kinds[u] == Kind::Crease {
        state.panels.points.swap(u, v);
        return;
    }
    let middle = state.panels.points[u].midpoint(state.panels.points[v]);
    for (corner, side) in [(u, left), (v, right)] {
        let sites = [side, only_u, only_v].map(|f| state.panels.centre(f));
        let near = middle + (sites[0] - middle) * 0.12;
        let hint = scene.surface.nearest(near, state.panels.hints[corner]);
        state.panels.hints[corner] = hint;
        state.panels.points[corner] = meeting_point(&scene.quadrics[hint], near, sites, TURNED);
    }
}

/// Solves for the panels within some rings of turned edges.
fn solve_near(state: &mut State, scene: Scene<'_>, weights: Weights, turns: &[Turn]) {
    let mut active = vec![false; state.panels.faces.len()];
    let mut front: Vec<usize> = turns.iter().flat_map(|turn| turn.ring.clone()).collect();
    front.iter().for_each(|&f| active[f] = true);
    for _ in 1..RINGS {
        let mut next = Vec::new();
        for &f in &front {
            for &g in state.across[f].iter().filter(|&&g| g != NONE) {
                if !std::mem::replace(&mut active[g], true) {
                    next.push(g);
                }
            }
        }
        front = next;
    }
    let active = Some(&active[..]);
    let run = Run { rounds: ROUNDS, from: 10.0, to: 300.0, weights, active, families: None };
    state.run(scene, run, |_| false);
}

/// How bad some faces are: the star shape and the length of edges that they lack, and sides other
/// than five to seven.
fn score(state: &State, faces: &[usize]) -> f64 {
    let mut total = 0.0;
    for &f in faces {
        let face = &state.panels.faces[f];
        total += ((LEAST_STAR - state.least_star(f)) / LEAST_STAR).clamp(0.0, 3.0);
        total += 0.05 * (face.len().abs_diff(6) as f64 - 1.0).max(0.0);
        for i in 0..face.len() {
            let [u, v] = [face[i], face[(i + 1) % face.len()]].map(|c| state.panels.points[c]);
            // Edges inside are seen twice.
            total += 0.5 * (1.0 - u.distance(v) / SHORT).max(0.0);
        }
    }
    total
}
