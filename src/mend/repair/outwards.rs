//! Closed parts made to look outwards, and cavities inwards.

use super::super::soup::{Soup, by_edge};
use super::{Repair, Repairs};
use crate::geom::AxisBox;
use glam::DVec3;

/// Turns the closed parts that look the wrong way: outwards is right for a part inside no other, or
/// inside two of them; inwards for the wall of a cavity.
pub(super) fn turn(soup: &mut Soup, repairs: &mut Repairs) {
    let parts = closed_parts(soup);
    let boxes: Vec<AxisBox> = parts
        .iter()
        .map(|part| {
            let places = part.iter().flat_map(|&f| soup.places(f));
            AxisBox::of(places).unwrap_or(AxisBox { low: DVec3::ZERO, high: DVec3::ZERO })
        })
        .collect();
    let mut wrong = Vec::new();
    for (i, part) in parts.iter().enumerate() {
        let inside_of = (0..parts.len()).filter(|&j| {
            j != i && contains(&boxes[j], &boxes[i]) && goes_around(soup, &parts[j], part)
        });
        let is_cavity = inside_of.count() % 2 == 1;
        if (volume(soup, part) < 0.0) != is_cavity {
            wrong.push(i);
        }
    }
    for &i in &wrong {
        parts[i].iter().for_each(|&f| soup.faces[f].corners.reverse());
    }
    repairs.add(Repair::TurnedParts, wrong.len());
}

/// The parts without rim, each with its faces ascending, where neighbours look the same way.
fn closed_parts(soup: &Soup) -> Vec<Vec<usize>> {
    let sides = soup.sides();
    let mut part: Vec<usize> = (0..soup.faces.len()).collect();
    fn root(part: &mut [usize], mut at: usize) -> usize {
        while part[at] != at {
            part[at] = part[part[at]];
            at = part[at];
        }
        at
    }
    let edges = by_edge(&sides);
    let mut is_open = vec![false; soup.faces.len()];
    for edge in &edges {
        let faces: Vec<usize> = edge.iter().map(|&s| sides[s as usize].face as usize).collect();
        for &f in &faces[1..] {
            let (a, b) = (root(&mut part, faces[0]), root(&mut part, f));
            part[a.max(b)] = a.min(b);
        }
        let runs_against =
            edge.len() == 2 && sides[edge[0] as usize].from == sides[edge[1] as usize].to;
        is_open[faces[0]] |= !runs_against;
    }
    let mut open_roots = vec![false; soup.faces.len()];
    for (f, is_open) in is_open.iter().enumerate() {
        let r = root(&mut part, f);
        open_roots[r] |= is_open;
    }
    let mut found: std::collections::BTreeMap<usize, Vec<usize>> = Default::default();
    for f in 0..soup.faces.len() {
        let r = root(&mut part, f);
        if !open_roots[r] {
            found.entry(r).or_default().push(f);
        }
    }
    found.into_values().collect()
}

fn contains(outer: &AxisBox, inner: &AxisBox) -> bool {
    outer.low.cmple(inner.low).all() && outer.high.cmpge(inner.high).all()
}

/// The signed volume of a closed part, from its first corner.
fn volume(soup: &Soup, part: &[usize]) -> f64 {
    let from = part.first().map_or(DVec3::ZERO, |&f| soup.places(f)[0]);
    let of_face = |&f: &usize| -> f64 {
        let places = soup.places(f);
        places[1..].windows(2).map(|w| triple(places[0] - from, w[0] - from, w[1] - from)).sum()
    };
    part.iter().map(of_face).sum::<f64>() / 6.0
}

fn triple(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    a.dot(b.cross(c))
}

/// Whether a closed part goes around another one: a corner of this one that is as deep in it as any
/// decides, by the solid angle under which the part is seen (Van Oosterom and Strackee 1983).
fn goes_around(soup: &Soup, part: &[usize], other: &[usize]) -> bool {
    let Some(&first) = other.first() else { return false };
    let places = soup.places(first);
    let p = places.iter().sum::<DVec3>() / places.len() as f64;
    let angle: f64 = part
        .iter()
        .map(|&f| {
            let corners: Vec<DVec3> = soup.places(f).into_iter().map(|q| q - p).collect();
            let fan = corners[1..].windows(2).map(|w| {
                let (a, b, c) = (corners[0], w[0], w[1]);
                let [x, y, z] = [a, b, c].map(DVec3::length);
                let below = x * y * z + a.dot(b) * z + b.dot(c) * x + c.dot(a) * y;
                2.0 * triple(a, b, c).atan2(below)
            });
            fan.sum::<f64>()
        })
        .sum();
    angle.abs() > 2.0 * std::f64::consts::PI
}
