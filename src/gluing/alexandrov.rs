//! Distances from an apex at which the pyramids over all triangles close around it: the
//! continuation of Bobenko and Izmestiev (2008, sections 3 and 5).
//!
//! The squared distance to the apex, less the squared length in the plane, is linear on each
//! triangle; an edge is convex as seen from the apex when it bends the right way there, so which
//! edge to flip is a test of polynomials, as for weighted Delaunay triangulations.

use std::collections::VecDeque;
use std::f64::consts::TAU;

use glam::DVec3;

use super::GluingError;
use super::place::flat_of_apex;
use super::pyramid::apex;
use super::surface::Surface;
use crate::geom::ldl::solve_symmetric;
use crate::progress::Progress;

/// An edge is flipped when it is hollow by more than that, in radians as seen from the apex: four
/// points on a circle would flip to and fro.
const HOLLOW: f64 = 1e-10;
/// What is hollow by no more and cannot be flipped is left as it is.
const STUCK: f64 = 1e-6;
/// Curvatures are not known better, in radians.
const ROUNDING: f64 = 3e-14;
/// From there on a failure may mean that the shape folds flat.
const NEARLY_CLOSED: f64 = 0.05;
/// The most steps of the continuation.
const STEPS: usize = 400;
/// Newton steps for each.
const NEWTON: usize = 12;
/// How near the curvatures must come, in parts of themselves.
const NEAR: f64 = 0.02;
/// And in parts of what the step is to change.
const SHORT: f64 = 0.1;

/// What the search took.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Effort {
    pub steps: usize,
    pub newton: usize,
    pub flips: usize,
}

/// A surface with the distances that were found so far.
#[derive(Debug, Clone)]
pub(super) struct Continuation {
    pub surface: Surface,
    /// Distance of each vertex from the apex.
    pub r: Vec<f64>,
    pub effort: Effort,
    /// Curvatures at the beginning, and the part of them that is left.
    first: Vec<f64>,
    left: f64,
    step: f64,
}

impl Continuation {
    /// Begins with the apex so many times the extent of the surface away.
    pub fn new(mut surface: Surface, far: f64) -> Result<Self, GluingError> {
        let extent = surface.edges().map(|h| surface.length[h]).fold(0.0, f64::max);
        let r = vec![far * extent; surface.material.len()];
        let flips = convexify(&mut surface, &r).map_err(|why| lost(1.0, why))?;
        let first = curvatures(&surface, &r).ok_or_else(|| lost(1.0, "a pyramid has no height"))?;
        let effort = Effort { flips, ..Effort::default() };
        Ok(Self { surface, r, effort, first, left: 1.0, step: 0.3 })
    }

    /// Leads the distances to where only so much of the curvatures is left. The triangulation
    /// changes on the way.
    ///
    /// # Errors
    /// That it folds flat, that it was stopped, or that no step led on.
    pub fn lead_to(&mut self, end: f64, progress: &dyn Progress) -> Result<(), GluingError> {
        while self.left > end {
            self.effort.steps += 1;
            progress.report("closing the body", self.effort.steps, 0);
            if progress.is_cancelled() {
                return Err(GluingError::Cancelled);
            }
            let goal = f64::max(self.left * (1.0 - self.step), 0.9 * end);
            let (surface, r) = (self.surface.clone(), self.r.clone());
            match newton(self, goal) {
                Ok(()) => {
                    self.left = goal;
                    self.step = f64::min(0.95, 1.6 * self.step);
                }
                Err(why) => {
                    self.surface = surface;
                    self.r = r;
                    self.step *= 0.5;
                    // A shape that folds flat leaves the pyramids no height in the end.
                    if self.left < NEARLY_CLOSED
                        && let Some(flat) = flat_of_apex(&self.surface, &self.r)
                    {
                        return Err(flat);
                    }
                    if self.step < 1e-9 || self.effort.steps > STEPS {
                        return Err(lost(self.left, why));
                    }
                }
            }
        }
        Ok(())
    }
}

fn lost(left: f64, why: &str) -> GluingError {
    GluingError::NotFound {
        fault: format!("the curvature was led to {left:.1e} of its first value, then {why}"),
    }
}

fn newton(at: &mut Continuation, goal: f64) -> Result<(), &'static str> {
    for _ in 0..NEWTON {
        at.effort.newton += 1;
        let kappa = curvatures(&at.surface, &at.r).ok_or("a pyramid has no height")?;
        let miss: Vec<f64> = kappa.iter().zip(&at.first).map(|(k, f)| goal * f - k).collect();
        // A short step must not come near without moving.
        let near = f64::min(NEAR * goal, SHORT * (at.left - goal));
        let is_near = |(m, f): (&f64, &f64)| m.abs() <= near * f.abs() + ROUNDING;
        if miss.iter().zip(&at.first).all(is_near) {
            return Ok(());
        }
        let rows = derivative(&at.surface, &at.r);
        let d = solve_symmetric(&rows, &miss).ok_or("its matrix was singular")?;
        let mut part = 1.0;
        at.r = loop {
            let moved: Vec<f64> = at.r.iter().zip(&d).map(|(r, d)| r + part * d).collect();
            if moved.iter().all(|&r| r > 0.0) && has_heights(&at.surface, &moved) {
                break moved;
            }
            part /= 2.0;
            if part < 1e-4 {
                return Err("no part of a step kept the pyramids upright");
            }
        };
        at.effort.flips += convexify(&mut at.surface, &at.r)?;
    }
    Err("Newton's method did not come near")
}

fn has_heights(surface: &Surface, r: &[f64]) -> bool {
    surface.triangles().all(|h| apex(surface, r, h).1 > 0.0)
}

/// How far each vertex lacks a full turn of pyramids around its distance. `None` when a pyramid has
/// no height.
fn curvatures(surface: &Surface, r: &[f64]) -> Option<Vec<f64>> {
    let mut sum = vec![0.0; r.len()];
    for h in surface.triangles() {
        let (foot, squared) = apex(surface, r, h);
        if squared <= 0.0 || !squared.is_finite() {
            return None;
        }
        let top = foot.extend(squared.sqrt());
        let third = surface.third(h);
        let corners = [DVec3::ZERO, DVec3::new(surface.length[h], 0.0, 0.0), third.extend(0.0)];
        let mut side = h;
        for k in 0..3 {
            let [axis, a, b] =
                [top, corners[(k + 1) % 3], corners[(k + 2) % 3]].map(|p| p - corners[k]);
            let (m, n) = (axis.cross(a), axis.cross(b));
            sum[surface.origin[side]] += m.cross(n).length().atan2(m.dot(n));
            side = surface.next[side];
        }
    }
    let is_vertex = |v: usize| !surface.is_flat[v];
    Some(sum.iter().enumerate().map(|(v, s)| if is_vertex(v) { TAU - s } else { 0.0 }).collect())
}

/// Derivatives of the curvatures by the distances (Bobenko, Izmestiev 2008, section 4.1).
fn derivative(surface: &Surface, r: &[f64]) -> Vec<Vec<(usize, f64)>> {
    let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); r.len()];
    for h in surface.edges() {
        let t = surface.twin[h];
        let (i, j, base) = (surface.origin[h], surface.origin[t], surface.length[h]);
        let [a, b] = [h, t].map(|side| {
            let (foot, squared) = apex(surface, r, side);
            (foot.y / squared.sqrt(), foot.y * foot.y + squared)
        });
        let distance = (a.1 + b.1) / 2.0;
        let g = (a.0 + b.0) * r[i] * r[j] / (base * distance);
        let cosine = (r[i] * r[i] + r[j] * r[j] - base * base) / (2.0 * r[i] * r[j]);
        rows[i].push((j, g));
        rows[j].push((i, g));
        rows[i].push((i, -g * cosine));
        rows[j].push((j, -g * cosine));
    }
    for (v, row) in rows.iter_mut().enumerate() {
        if row.is_empty() {
            row.push((v, 1.0));
        }
    }
    rows
}

/// Flips edges until all are convex as seen from the apex; how many.
fn convexify(surface: &mut Surface, r: &[f64]) -> Result<usize, &'static str> {
    let mut queue: VecDeque<usize> = surface.edges().collect();
    let mut is_queued = vec![false; surface.len()];
    queue.iter().for_each(|&h| is_queued[h] = true);
    let limit = 200 * queue.len() + 10_000;
    let mut flips = 0;
    // Edges that are hollow but cannot be flipped yet.
    let mut waiting: Vec<usize> = Vec::new();
    while let Some(h) = queue.pop_front() {
        is_queued[h] = false;
        if !is_hollow(surface, r, h) {
            continue;
        }
        if !surface.flip(h) {
            waiting.push(h);
            continue;
        }
        flips += 1;
        if flips > limit {
            return Err("edges flipped without end");
        }
        let t = surface.twin[h];
        let around = [h, t].map(|s| [surface.next[s], surface.previous(s)]).concat();
        for side in around.into_iter().chain(waiting.drain(..)) {
            let e = side.min(surface.twin[side]);
            if !std::mem::replace(&mut is_queued[e], true) {
                queue.push_back(e);
            }
        }
    }
    if waiting.iter().any(|&h| hollow(surface, r, h) > STUCK) {
        return Err("a hollow edge could not be flipped");
    }
    Ok(flips)
}

fn is_hollow(surface: &Surface, r: &[f64], h: usize) -> bool {
    hollow(surface, r, h) > HOLLOW
}

/// How hollow an edge is as seen from the apex.
fn hollow(surface: &Surface, r: &[f64], h: usize) -> f64 {
    let ((a, height), (b, _)) = (apex(surface, r, h), apex(surface, r, surface.twin[h]));
    let distance = (a.y * a.y + height.max(0.0)).sqrt();
    -(a.y + b.y) / distance
}
