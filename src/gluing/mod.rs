//! Flat outlines joined along their rims: the one convex body that they close to, computed.
//!
//! Joined along their rims, flat pieces are a closed surface with a metric that is flat but for
//! the seams. If it is a sphere and no point has more than 360° of material, it is the surface of
//! exactly one convex body (Alexandrov 1941). The body is found as Bobenko and Izmestiev do (2008,
//! "Alexandrov's theorem, weighted Delaunay triangulations, and mixed volumes"): from an apex far
//! away, distances to the points of the seam are led until the pyramids over all triangles close
//! around it. The D-form is the convex hull of its seam (Demaine, Price 2010), so the pieces bend
//! only along straight lines between points of the seam.
//!
//! The way: [`Outline`]s and [`Seam`]s → rims cut into chords that are equal on both sides
//! (`rims`) → a triangulated surface that knows lengths and no positions (`surface`) → the
//! distances from the apex (`alexandrov`) → positions, mended until every edge has its length
//! (`place`) → where the seams run on the body (`trace`) → mesh and net (`body`).

mod alexandrov;
mod body;
mod closing;
mod error;
mod named;
mod outline;
mod overlay;
mod place;
mod planar;
mod pyramid;
mod rims;
mod seams;
mod start;
mod surface;
mod trace;
mod triangle;

pub use body::{Glued, GluedFacts, glue};
pub use error::GluingError;
pub use named::named_outline;
pub use outline::Outline;
pub use planar::{PlanarBody, planar_body};
pub use rims::POINTS_LIMIT;
pub use seams::{Gluing, Seam, Span};

#[cfg(test)]
mod random_points;
#[cfg(test)]
mod tests;
