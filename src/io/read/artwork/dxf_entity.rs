//! The outlines of DXF entities.

use std::f64::consts::TAU;

use glam::{DAffine2, DVec2};

use super::budget::{Budget, Cost};
use super::curve::{Flattener, sweep_between};
use super::dxf_value::Entity;
use super::{ArtError, FLATNESS};

/// The line of an entity in its own coordinates.
pub(super) struct Outline {
    pub points: Vec<DVec2>,
    pub closed: bool,
    /// Whether all of it is at one height, so that its lengths are true from above.
    pub is_flat: bool,
    /// Whether its points are on the curve that the file means, and near it in between.
    pub is_exact: bool,
}

/// Nothing for what is no line.
pub(super) fn outline(
    entity: &Entity<'_>,
    transform: &DAffine2,
    budget: &Budget,
) -> Result<Option<Outline>, ArtError> {
    let flattener = Flattener::of(transform, budget);
    let line = match entity.kind {
        "LINE" => entity.point(10).zip(entity.point(11)).map(|(a, b)| (vec![a, b], false)),
        "POINT" => entity.point(10).map(|p| (vec![p], false)),
        "LWPOLYLINE" => Some(light_polyline(entity, &flattener)?),
        "POLYLINE" => polyline(entity, &flattener, budget)?,
        "CIRCLE" | "ARC" => circle(entity, &flattener)?,
        "ELLIPSE" => ellipse(entity, &flattener)?,
        "SPLINE" => return spline(entity, &flattener),
        _ => None,
    };
    let is_flat = is_flat(entity);
    Ok(line.map(|(points, closed)| Outline { points, closed, is_flat, is_exact: true }))
}

/// Whether a line is at one height. Those in a plane of their own are where it looks up or down.
fn is_flat(entity: &Entity<'_>) -> bool {
    let is_level = |codes: &[i32], entity: &Entity<'_>| {
        let heights = codes.iter().flat_map(|&code| entity.numbers(code));
        let (low, high) =
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
        low > high || high - low <= FLATNESS
    };
    let is_upright = entity.normal().truncate().abs().max_element() < 1e-6;
    match entity.kind {
        "LINE" => is_level(&[30, 31], entity),
        "SPLINE" => is_level(&[30], entity) && is_level(&[31], entity),
        "ELLIPSE" => entity.number(31).unwrap_or(0.0).abs() <= FLATNESS && is_upright,
        "POINT" => true,
        "POLYLINE" => {
            let heights = entity.vertices.iter().filter_map(|v| v.number(30));
            let (low, high) =
                heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), z| (l.min(z), h.max(z)));
            is_upright && (low > high || high - low <= FLATNESS)
        }
        _ => is_upright,
    }
}

type Line = (Vec<DVec2>, bool);

fn circle(entity: &Entity<'_>, flattener: &Flattener<'_>) -> Result<Option<Line>, ArtError> {
    let Some((centre, r)) = entity.point(10).zip(entity.number(40)) else { return Ok(None) };
    let axes = [DVec2::X * r, DVec2::Y * r];
    if entity.kind == "CIRCLE" {
        return Ok(Some((flattener.ellipse(centre, axes)?, true)));
    }
    let Some((from, to)) = entity.number(50).zip(entity.number(51)) else { return Ok(None) };
    let (from, to) = (from.to_radians(), to.to_radians());
    part_of_ellipse(centre, axes, (from, to), flattener).map(Some)
}

/// An elliptic arc; closed where it runs all around.
fn part_of_ellipse(
    centre: DVec2,
    axes: [DVec2; 2],
    (from, to): (f64, f64),
    flattener: &Flattener<'_>,
) -> Result<Line, ArtError> {
    let sweep = sweep_between(from, to);
    if sweep == TAU {
        return Ok((flattener.ellipse(centre, axes)?, true));
    }
    let mut points = vec![centre + axes[0] * from.cos() + axes[1] * from.sin()];
    flattener.arc(centre, axes, (from, sweep), &mut points)?;
    Ok((points, false))
}

/// Codes 10, 20 and 42 belong to the vertex that the 10 before them began.
fn light_polyline(entity: &Entity<'_>, flattener: &Flattener<'_>) -> Result<Line, ArtError> {
    let mut vertices: Vec<(DVec2, f64)> = Vec::new();
    for (code, value) in entity.pairs {
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

fn polyline(
    entity: &Entity<'_>,
    flattener: &Flattener<'_>,
    budget: &Budget,
) -> Result<Option<Line>, ArtError> {
    // Meshes are no lines.
    if entity.flags(70) & (16 | 64) != 0 {
        return Ok(None);
    }
    budget.spend(Cost::Steps, entity.vertices.iter().map(|v| v.pairs.len()).sum())?;
    // Of splines the points of the frame are left out.
    let is_frame = |v: &&Entity<'_>| v.flags(70) & 16 != 0;
    let of = |v: &Entity<'_>| Some((v.point(10)?, v.number(42).unwrap_or(0.0)));
    let vertices: Vec<(DVec2, f64)> =
        entity.vertices.iter().filter(|v| !is_frame(v)).filter_map(of).collect();
    bulged(&vertices, entity.flags(70) & 1 != 0, flattener).map(Some)
}

fn bulged(
    vertices: &[(DVec2, f64)],
    closed: bool,
    flattener: &Flattener<'_>,
) -> Result<Line, ArtError> {
    let mut points: Vec<DVec2> = vertices.first().map(|v| v.0).into_iter().collect();
    for pair in vertices.windows(2) {
        flattener.bulge(pair[0].0, pair[1].0, pair[0].1, &mut points)?;
    }
    if let (true, Some(first), Some(last)) = (closed, vertices.first(), vertices.last())
        && last.1 != 0.0
    {
        flattener.bulge(last.0, first.0, last.1, &mut points)?;
        points.pop();
    }
    Ok((points, closed))
}

fn ellipse(entity: &Entity<'_>, flattener: &Flattener<'_>) -> Result<Option<Line>, ArtError> {
    let (Some(centre), Some(major), Some(ratio)) =
        (entity.point(10), entity.point(11), entity.number(40))
    else {
        return Ok(None);
    };
    // Seen from below it runs the other way round; centre and axis are the world's all the same.
    let side = if entity.normal().z < 0.0 { -1.0 } else { 1.0 };
    let minor = major.perp() * ratio * side;
    let of = |code, default| entity.number(code).unwrap_or(default);
    let range = (of(41, 0.0), of(42, TAU));
    part_of_ellipse(centre, [major, minor], range, flattener).map(Some)
}

fn spline(entity: &Entity<'_>, flattener: &Flattener<'_>) -> Result<Option<Outline>, ArtError> {
    let zip = |x: i32| -> Vec<DVec2> {
        let (xs, ys) = (entity.numbers(x), entity.numbers(x + 10));
        xs.into_iter().zip(ys).map(|(x, y)| DVec2::new(x, y)).collect()
    };
    let closed = entity.flags(70) & 1 != 0;
    let is_flat = is_flat(entity);
    let control = zip(10);
    if control.is_empty() {
        // Only fit points: they are on the curve.
        let points = zip(11);
        let is_any = !points.is_empty();
        return Ok(is_any.then_some(Outline { points, closed, is_flat, is_exact: false }));
    }
    let weights = entity.numbers(41);
    let weight = |i: usize| if weights.len() == control.len() { weights[i] } else { 1.0 };
    let weighted: Vec<(DVec2, f64)> =
        control.iter().enumerate().map(|(i, &p)| (p, weight(i))).collect();
    let degree = entity.number(71).unwrap_or(3.0).max(0.0) as usize;
    let points = flattener.spline(degree, &entity.numbers(40), &weighted)?;
    Ok(points.map(|points| Outline { points, closed, is_flat, is_exact: true }))
}
