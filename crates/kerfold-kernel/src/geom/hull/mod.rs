//! Convex hulls and intersections of half-spaces, exact in every sign; knows no mesh.
//!
//! One kernel serves both: a hull of points ([`convex_hull`]), and a set of planes as the hull of
//! its dual points ([`intersect`]). Points are inserted in random rounds along a Hilbert curve
//! (`order`) and fanned in (`surface`), of large sets in parts of the surface side by side
//! (`grow`). Facets know the poles of their planes, so that three products tell whether one sees a
//! point. Where that is too near to call, the sign is tried on the corners with an error bound and,
//! where that cannot tell either, settled on the given numbers (`cloud`, `determinant`). The poles
//! of a dual hull are the vertices of the solid. Coplanar facets are joined afterwards (`merge`),
//! so that degenerate input (cubes, grids, repeated points, planes that only touch) gives what it
//! should.
//!
//! Sources: Clarkson and Shor 1989; Amenta, Choi and Rote 2003; Devillers, Pion and Teillaud 2002;
//! Shewchuk 1997.

mod apart;
mod cloud;
mod contract;
mod determinant;
mod fans;
mod grow;
mod half_space;
mod halfspaces;
mod interior;
mod meeting;
mod merge;
mod order;
mod parallel;
mod placing;
mod points;
mod polytope;
mod scale;
mod split;
mod start;
mod surface;
mod verify;

/// Asked now and then by long work, from any thread: whether to go on.
pub type GoesOn<'a> = &'a (dyn Fn() -> bool + Sync);

#[cfg(test)]
mod large_tests;
#[cfg(test)]
mod tests;

pub use apart::{Apart, intersect_apart};
pub use half_space::HalfSpace;
pub use halfspaces::{Form, HalfSpaceError, Intersect, Numbers, intersect, intersect_verified};
pub use points::{HullError, convex_hull, convex_hull_while};
pub use polytope::{Polygons, Polytope};
pub use verify::Misplaced;
