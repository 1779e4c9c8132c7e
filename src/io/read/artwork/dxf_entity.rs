//! The outlines of DXF entities.

use glam::{DAffine2, DVec2};

use super::curve::{Flattener, sweep_between};
use super::dxf::Entity;

/// The line of an entity in its own coordinates and whether it is closed; nothing for what is no
/// line.
pub(super) fn outline(entity: &Entity, transform: &DAffine2) -> Option<(Vec<DVec2>, bool)> {
    let flattener = Flattener::of(transform);
    match entity.kind.as_str() {
        "LINE" => Some((vec![entity.point(10)?, entity.point(11)?], false)),
        "POINT" => Some((vec![entity.point(10)?], false)),
        "LWPOLYLINE" => Some(light_polyline(entity, &flattener)),
        "POLYLINE" => polyline(entity, &flattener),
        "CIRCLE" => {
            let r = entity.number(40)?;
            Some((flattener.ellipse(entity.point(10)?, [DVec2::X * r, DVec2::Y * r]), true))
        }
        "ARC" => {
            let (centre, r) = (entity.point(10)?, entity.number(40)?);
            let (from, to) = (entity.number(50)?, entity.number(51)?);
            let axes = [DVec2::X * r, DVec2::Y * r];
            let mut points = vec![centre + r * DVec2::from_angle(from.to_radians())];
            flattener.arc(centre, axes, (from.to_radians(), sweep_between(from, to)), &mut points);
            Some((points, false))
        }
        "ELLIPSE" => ellipse(entity, &flattener),
        "SPLINE" => spline(entity, &flattener),
        _ => None,
    }
}

/// Codes 10, 20 and 42 belong to the vertex that the 10 before them began.
fn light_polyline(entity: &Entity, flattener: &Flattener) -> (Vec<DVec2>, bool) {
    let mut vertices: Vec<(DVec2, f64)> = Vec::new();
    for (code, value) in &entity.pairs {
        let number = value.trim().parse().unwrap_or(0.0);
        match (*code, vertices.last_mut()) {
            (10, _) => vertices.push((DVec2::new(number, 0.0), 0.0)),
            (20, Some(last)) => last.0.y = number,
            (42, Some(last)) => last.1 = number,
            _ => {}
        }
    }
    bulged(&vertices, entity.flags(70) & 1 != 0, flattener)
}

fn polyline(entity: &Entity, flattener: &Flattener) -> Option<(Vec<DVec2>, bool)> {
    // Meshes are no lines.
    if entity.flags(70) & (16 | 64) != 0 {
        return None;
    }
    // Of splines the points of the frame are left out.
    let is_frame = |v: &&Entity| v.flags(70) & 16 != 0;
    let of = |v: &Entity| Some((v.point(10)?, v.number(42).unwrap_or(0.0)));
    let vertices: Vec<(DVec2, f64)> =
        entity.vertices.iter().filter(|v| !is_frame(v)).filter_map(of).collect();
    Some(bulged(&vertices, entity.flags(70) & 1 != 0, flattener))
}

fn bulged(vertices: &[(DVec2, f64)], closed: bool, flattener: &Flattener) -> (Vec<DVec2>, bool) {
    let mut points: Vec<DVec2> = vertices.first().map(|v| v.0).into_iter().collect();
    for pair in vertices.windows(2) {
        flattener.bulge(pair[0].0, pair[1].0, pair[0].1, &mut points);
    }
    if let (true, Some(first), Some(last)) = (closed, vertices.first(), vertices.last())
        && last.1 != 0.0
    {
        flattener.bulge(last.0, first.0, last.1, &mut points);
        points.pop();
    }
    (points, closed)
}

fn ellipse(entity: &Entity, flattener: &Flattener) -> Option<(Vec<DVec2>, bool)> {
    let (centre, major) = (entity.point(10)?, entity.point(11)?);
    let minor = major.perp() * entity.number(40)?;
    let (from, to) =
        (entity.number(41).unwrap_or(0.0), entity.number(42).unwrap_or(std::f64::consts::TAU));
    let sweep = sweep_between(from.to_degrees(), to.to_degrees());
    if sweep >= std::f64::consts::TAU - 1e-9 {
        return Some((flattener.ellipse(centre, [major, minor]), true));
    }
    let mut points = vec![centre + major * from.cos() + minor * from.sin()];
    flattener.arc(centre, [major, minor], (from, sweep), &mut points);
    Some((points, false))
}

fn spline(entity: &Entity, flattener: &Flattener) -> Option<(Vec<DVec2>, bool)> {
    let zip = |x: i32| -> Vec<DVec2> {
        entity
            .numbers(x)
            .into_iter()
            .zip(entity.numbers(x + 10))
            .map(|(x, y)| DVec2::new(x, y))
            .collect()
    };
    let control = zip(10);
    if control.is_empty() {
        // Only fit points: they are on the curve.
        let fit = zip(11);
        return (!fit.is_empty()).then_some((fit, false));
    }
    let weights = entity.numbers(41);
    let weight = |i: usize| if weights.len() == control.len() { weights[i] } else { 1.0 };
    let weighted: Vec<(DVec2, f64)> =
        control.iter().enumerate().map(|(i, &p)| (p, weight(i))).collect();
    let degree = entity.number(71).unwrap_or(3.0).clamp(1.0, 25.0) as usize;
    Some((flattener.spline(degree, &entity.numbers(40), &weighted), entity.flags(70) & 1 != 0))
}
