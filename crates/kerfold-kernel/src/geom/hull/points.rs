//! The convex hull of points.

use glam::DVec3;

use super::cloud::{Cloud, PointSigns};
use super::grow::grow;
use super::merge::{Faces, fan_starts};
use super::order::{MOST_POINTS, insertion_order};
use super::polytope::Polygons;
use super::start::{Flat, far_apart};
use super::surface::{NONE, Room, Surface};
use super::{GoesOn, Numbers};
use crate::code::codes;
use crate::geom::RoundingBound;
use crate::geom::predicate::orient3d;

/// Why points have no hull with a volume. Points are numbered from 0 in the order of the input.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HullError {
    /// Too few for a volume.
    #[error("{count} points have no hull with a volume; at least 4 are needed")]
    TooFew {
        /// How many there are.
        count: usize,
    },
    /// More than can be numbered.
    #[error("{count} points are more than a hull can take ({MOST_POINTS})")]
    TooMany {
        /// How many there are.
        count: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("point {point} has a coordinate that is not a finite number: {position}")]
    NotFinite {
        /// Which point.
        point: usize,
        /// What was given.
        position: DVec3,
    },
    /// All points are the same.
    #[error("all {count} points lie at {position}; a hull needs points that span a volume")]
    Coincident {
        /// How many there are.
        count: usize,
        /// Where they lie.
        position: DVec3,
    },
    /// All points lie on a line.
    #[error(
        "all {count} points lie on one line along ({:.4}, {:.4}, {:.4}); a hull needs points that \
        span a volume",
        direction.x, direction.y, direction.z
    )]
    Collinear {
        /// How many there are.
        count: usize,
        /// The direction of the line, unit length.
        direction: DVec3,
    },
    /// All points lie in a plane.
    #[error(
        "all {count} points lie in one plane with the normal ({:.4}, {:.4}, {:.4}); a hull needs \
        points that span a volume",
        normal.x, normal.y, normal.z
    )]
    Coplanar {
        /// How many there are.
        count: usize,
        /// The normal of the plane, unit length.
        normal: DVec3,
    },
    /// The caller said so.
    #[error("stopped before the hull was finished")]
    Stopped,
}

codes!(error HullError {
    TooFew = 211,
    TooMany = 212,
    NotFinite = 213,
    Coincident = 214,
    Collinear = 215,
    Coplanar = 216,
    Stopped = 217,
});

/// The faces of the convex hull of `points`, as runs of point numbers, counter-clockwise seen from
/// outside.
///
/// Exact on the given numbers: coplanar neighbours are one face, and points inside a face or an
/// edge are no corners. With [`Numbers::Constructed`] neighbours within [`RoundingBound`] of one
/// plane are one face too, as long as a solid remains. Of equal points one stands for all. Each
/// face begins at its lowest corner; the faces are in lexicographic order, whatever the order of
/// the input's insertion.
///
/// # Errors
/// [`HullError`] when a coordinate is not finite or the points span no volume.
///
/// # Example
/// ```
/// use glam::DVec3;
/// use kerfold_kernel::geom::hull::{Numbers, convex_hull};
///
/// let corners = (0..8_u8).map(|i| DVec3::from_array([0, 1, 2].map(|k| f64::from(i >> k & 1))));
/// let points: Vec<DVec3> = corners.chain([DVec3::splat(0.5)]).collect();
/// let faces = convex_hull(&points, Numbers::Given)?;
/// assert!(faces.len() == 6 && faces.iter().all(|face| face.len() == 4));
/// # Ok::<(), kerfold_kernel::geom::hull::HullError>(())
/// ```
pub fn convex_hull(points: &[DVec3], numbers: Numbers) -> Result<Polygons, HullError> {
    convex_hull_while(points, numbers, &|| true)
}

/// [`convex_hull`] as long as `goes_on`, which is asked now and then, says yes.
///
/// # Errors
/// [`HullError`] as [`convex_hull`], and [`HullError::Stopped`].
pub fn convex_hull_while(
    points: &[DVec3],
    numbers: Numbers,
    goes_on: GoesOn<'_>,
) -> Result<Polygons, HullError> {
    let count = points.len();
    if count < 4 {
        return Err(HullError::TooFew { count });
    }
    if count >= MOST_POINTS {
        return Err(HullError::TooMany { count });
    }
    if let Some(point) = points.iter().position(|p| !p.is_finite()) {
        return Err(HullError::NotFinite { point, position: points[point] });
    }
    let (corners, centre) = start(points).map_err(|flat| refusal(flat, points))?;
    let order = insertion_order(count, |i| points[i] - centre.point);
    let signs = PointSigns { points, order: &order.points, centre: centre.point };
    let (cloud, scale) = Cloud::new(
        order.points.iter().map(|&i| points[i as usize] - centre.point).collect(),
        2.0,
        signs,
    );
    let places = corners.map(|c| {
        order.points.iter().position(|&i| i == c).expect("every point has a place") as u32
    });
    let mut room = Room::new(count);
    let mut surface =
        Surface::tetrahedron(&cloud, places, centre.is_corner.then_some(places[0]), &mut room);
    let mut inserted = places;
    inserted.sort_unstable();
    grow(&cloud, &mut surface, &order, &inserted, goes_on).ok_or(HullError::Stopped)?;
    if numbers == Numbers::Constructed {
        let (low, high) =
            points.iter().fold((points[0], points[0]), |(l, h), &p| (l.min(p), h.max(p)));
        let faces =
            Faces::within(&surface, &cloud, RoundingBound::of_box(low, high).length() * scale);
        let merged = polygons(&surface, &faces, &order.points);
        if is_closed(&merged) {
            return Ok(merged);
        }
    }
    Ok(polygons(&surface, &Faces::of(&surface, &cloud), &order.points))
}

/// Whether every face has an area and every side of it a partner.
fn is_closed(faces: &Polygons) -> bool {
    let runs = || faces.iter().flat_map(|run| run.iter().zip(run.iter().cycle().skip(1)));
    let mut sides: Vec<(u32, u32)> = runs().map(|(&a, &b)| (a, b)).collect();
    sides.sort_unstable();
    let is_paired = |w: &(u32, u32)| sides.binary_search(&(w.1, w.0)).is_ok();
    faces.len() > 3
        && faces.iter().all(|run| run.len() > 2)
        && sides.windows(2).all(|w| w[0] != w[1])
        && sides.iter().all(is_paired)
}

/// From where the hull is seen.
struct Centre {
    point: DVec3,
    /// No double lies strictly inside the first four points, so the first of them stands for the
    /// centre.
    is_corner: bool,
}

/// Four points that span a volume, and a centre inside them. The first is a corner of the hull.
fn start(points: &[DVec3]) -> Result<([u32; 4], Centre), Flat> {
    let order: Vec<u32> = (0..points.len() as u32).collect();
    let lexicographic = |&i: &u32, &j: &u32| {
        let (p, q) = (points[i as usize].to_array(), points[j as usize].to_array());
        p.partial_cmp(&q).expect("all coordinates are finite")
    };
    let lowest = order.iter().copied().min_by(lexicographic).ok_or(Flat::Point)?;
    let origin = points[lowest as usize];
    let signs = PointSigns { points, order: &order, centre: origin };
    let (cloud, _) = Cloud::new(points.iter().map(|&p| p - origin).collect(), 2.0, signs);
    let corners = far_apart(&cloud, lowest)?;
    let [a, b, c, d] = corners.map(|i| points[i as usize]);
    let middle = a + ((b - a) + (c - a) + (d - a)) / 4.0;
    let is_below = |[p, q, r]: [DVec3; 3]| orient3d(p, q, r, middle) > 0.0;
    let is_inside = [[a, b, c], [b, a, d], [c, b, d], [a, c, d]].into_iter().all(is_below);
    Ok((corners, Centre { point: if is_inside { middle } else { a }, is_corner: !is_inside }))
}

fn refusal(flat: Flat, points: &[DVec3]) -> HullError {
    let count = points.len();
    match flat {
        Flat::Point => HullError::Coincident { count, position: points[0] },
        Flat::Line(direction) => {
            HullError::Collinear { count, direction: direction.normalize_or_zero() }
        }
        Flat::Plane(normal) | Flat::OneSided(normal) => {
            HullError::Coplanar { count, normal: normal.normalize_or_zero() }
        }
    }
}

fn polygons(surface: &Surface<'_>, faces: &Faces, order: &[u32]) -> Polygons {
    let starts = fan_starts(surface, order.len());
    let mut around = Vec::new();
    let is_corner: Vec<bool> = starts
        .iter()
        .enumerate()
        .map(|(v, &f)| {
            if f == NONE || !faces.has_merged() {
                return f != NONE;
            }
            faces.around(surface, v as u32, f, &mut around);
            around.len() > 2
        })
        .collect();
    let mut rims: Vec<Vec<u32>> = Vec::with_capacity(faces.len());
    for face in 0..faces.len() as u32 {
        faces.rim(surface, face, &mut around);
        let mut rim: Vec<u32> =
            around.iter().filter(|&&v| is_corner[v as usize]).map(|&v| order[v as usize]).collect();
        let lowest = (0..rim.len()).min_by_key(|&i| rim[i]).unwrap_or(0);
        rim.rotate_left(lowest);
        rims.push(rim);
    }
    rims.sort_unstable();
    let mut polygons = Polygons::with_capacity(rims.len(), rims.iter().map(Vec::len).sum());
    rims.into_iter().for_each(|rim| polygons.push(rim));
    polygons
}
