//! The intersection of half-spaces, by the hull of their dual points.

use std::collections::BTreeSet;

use glam::DVec3;

use super::GoesOn;
use super::cloud::{Cloud, PlaneSigns};
use super::contract::contract;
use super::fans::Runs;
use super::grow::grow;
use super::half_space::HalfSpace;
use super::interior::{Centre, deepest_point};
use super::merge::Faces;
use super::order::{MOST_POINTS, Order, insertion_order};
use super::parallel::fill;
use super::placing::Placing;
use super::polytope::Polytope;
use super::split::split;
use super::start::{Flat, enclose_centre, far_apart};
use super::surface::{Room, Surface};
use super::verify::Misplaced;
use crate::code::codes;

/// What becomes of points where more than three planes meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Form {
    /// One vertex, with as many edges as faces meet there.
    #[default]
    Merged,
    /// Vertices of valence 3 only, as if the planes had been moved by infinitely little: n faces,
    /// 3n − 6 edges and 2n − 4 vertices, some of them at one point.
    Simple,
}

/// Whether the numbers of the planes are meant to the last digit.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash)]
pub enum Numbers {
    /// As given: exact signs alone decide where planes meet.
    #[default]
    Given,
    /// Computed, with rounding: vertices nearer to each other than [`crate::geom::RoundingBound`]
    /// are one, and planes that cut off less than that only touch.
    Constructed,
}

/// How to intersect half-spaces.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Intersect {
    /// Form of the result.
    pub form: Form,
    /// What the numbers stand for.
    pub numbers: Numbers,
    /// A point inside, where one is known; else one is found.
    pub interior: Option<DVec3>,
    /// How near computed vertices may be before they are one, where that is more than the
    /// [`crate::geom::RoundingBound`] of the solid, in its unit: when it will be moved to where
    /// coordinates are coarser.
    pub resolution: f64,
}

/// Why half-spaces do not bound a solid. Half-spaces are numbered from 0 in the order of the input.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HalfSpaceError {
    /// More than can be numbered.
    #[error("{count} half-spaces are more than can be intersected ({MOST_POINTS})")]
    TooMany {
        /// How many there are.
        count: usize,
    },
    /// A number is NaN or infinite.
    #[error("half-space {half_space} has a number that is not finite")]
    NotFinite {
        /// Which one.
        half_space: usize,
    },
    /// A normal without direction.
    #[error("half-space {half_space} has the normal (0, 0, 0); give it a direction")]
    NoDirection {
        /// Which one.
        half_space: usize,
    },
    /// Nothing lies in all half-spaces.
    #[error(
        "the half-spaces have no point in common: {} exclude each other, by {gap:.6e}; move one of \
        them outwards",
        list(half_spaces)
    )]
    Infeasible {
        /// A few half-spaces that exclude each other, ascending.
        half_spaces: Vec<usize>,
        /// How far each of them must move at least before they meet.
        gap: f64,
    },
    /// The common part has no thickness, or one below the rounding of its coordinates.
    #[error(
        "the half-spaces leave nothing with a volume: between {} there is no room; move one of \
        them outwards",
        list(half_spaces)
    )]
    NoVolume {
        /// The half-spaces that leave no room between them, ascending.
        half_spaces: Vec<usize>,
    },
    /// The common part reaches to infinity.
    #[error(
        "the half-spaces leave the direction ({:.4}, {:.4}, {:.4}) open; add a half-space that \
        closes it, or a box",
        direction.x, direction.y, direction.z
    )]
    Unbounded {
        /// A unit vector along which one can go for ever.
        direction: DVec3,
    },
    /// A vertex did not come out where its planes meet.
    #[error(
        "vertex {} of the solid came out at {}, {:.3e} outside half-space {}: this is a fault of \
        kerfold and not of the half-spaces; please report it with them",
        fault.vertex, fault.position, fault.distance, fault.half_space
    )]
    Misplaced {
        /// What is wrong.
        fault: Misplaced,
    },
    /// Vertices of more than three edges that cannot be divided.
    #[error(
        "the points where more than three planes meet cannot be divided into vertices of three \
        edges: the solid is too thin there for edges of {least:.3e}; leave out the simple form"
    )]
    NotSimple {
        /// How long each new edge should be at least, in the unit of the coordinates.
        least: f64,
    },
    /// The caller said so.
    #[error("stopped before the solid was finished")]
    Stopped,
}

codes!(error HalfSpaceError {
    TooMany = 221,
    NotFinite = 222,
    NoDirection = 223,
    Infeasible = 224,
    NoVolume = 225,
    Unbounded = 226,
    Misplaced = 227,
    NotSimple = 228,
    Stopped = 229,
});

impl HalfSpaceError {
    /// The half-spaces concerned, where there are some to name.
    pub fn half_spaces(&self) -> &[usize] {
        match self {
            Self::NotFinite { half_space } | Self::NoDirection { half_space } => {
                std::slice::from_ref(half_space)
            }
            Self::Infeasible { half_spaces, .. } | Self::NoVolume { half_spaces } => half_spaces,
            Self::Misplaced { fault } => std::slice::from_ref(&fault.half_space),
            Self::TooMany { .. }
            | Self::Unbounded { .. }
            | Self::NotSimple { .. }
            | Self::Stopped => &[],
        }
    }
}

fn list(half_spaces: &[usize]) -> String {
    let numbers: Vec<String> = half_spaces.iter().map(usize::to_string).collect();
    match numbers.split_last() {
        Some((last, rest)) if !rest.is_empty() => {
            format!("half-spaces {} and {last}", rest.join(", "))
        }
        _ => format!("half-space {}", numbers.join("")),
    }
}

/// Intersects half-spaces to a solid.
///
/// Planes that contribute no face (redundant ones, those that touch at a vertex or along an edge,
/// repeated ones but for the first inserted) are left out. Which planes meet is settled by exact
/// signs; a vertex lies within [`crate::geom::RoundingBound`] of where they do, at any scale and
/// anywhere, also where planes are the same but for the last digits. With
/// [`Numbers::Constructed`], where vertices are joined, within four times that. Of 8192 half-spaces
/// or more in the simple form a vertex may lie outside a plane by 2⁻²⁸ of the distance from the
/// interior to it, where four planes nearly meet; [`intersect_verified`] finds and mends that.
///
/// # Errors
/// [`HalfSpaceError`]: nothing in common, no volume, an open direction, or numbers that are none.
pub fn intersect(
    half_spaces: &[HalfSpace],
    options: &Intersect,
) -> Result<Polytope, HalfSpaceError> {
    let is_thorough = half_spaces.len() < THOROUGH_BELOW;
    intersect_while(half_spaces, options, is_thorough, &|| true)
}

/// [`intersect`] as long as `goes_on`, which is asked now and then, says yes, and with the result
/// compared with all half-spaces ([`Polytope::verify`]).
///
/// # Errors
/// [`HalfSpaceError`] as [`intersect`], [`HalfSpaceError::Stopped`], and
/// [`HalfSpaceError::Misplaced`] when the result is wrong, which is a fault of this library.
pub fn intersect_verified(
    half_spaces: &[HalfSpace],
    options: &Intersect,
    goes_on: GoesOn<'_>,
) -> Result<Polytope, HalfSpaceError> {
    let mut is_thorough = half_spaces.len() < THOROUGH_BELOW;
    loop {
        let polytope = intersect_while(half_spaces, options, is_thorough, goes_on)?;
        match polytope.verify(half_spaces, options.resolution) {
            Ok(()) => return Ok(polytope),
            Err(fault) if is_thorough => return Err(HalfSpaceError::Misplaced { fault }),
            Err(_) => is_thorough = true,
        }
    }
}

fn intersect_while(
    half_spaces: &[HalfSpace],
    options: &Intersect,
    is_thorough: bool,
    goes_on: GoesOn<'_>,
) -> Result<Polytope, HalfSpaceError> {
    check(half_spaces)?;
    let centre = inside(half_spaces, options.interior)?;
    let set = Set { half_spaces, centre, is_thorough, goes_on };
    let polytope = set.exact_intersection(options.form == Form::Simple)?;
    match (options.numbers, options.form) {
        (Numbers::Given, Form::Merged) => Ok(polytope),
        (Numbers::Given, Form::Simple) => Ok(split(polytope)),
        (Numbers::Constructed, form) => {
            let merged = set.contract_all(polytope, options.resolution)?;
            Ok(if form == Form::Simple { split(merged) } else { merged })
        }
    }
}

fn check(half_spaces: &[HalfSpace]) -> Result<(), HalfSpaceError> {
    let count = half_spaces.len();
    if count >= MOST_POINTS {
        return Err(HalfSpaceError::TooMany { count });
    }
    if let Some(half_space) =
        half_spaces.iter().position(|h| !(h.normal.is_finite() && h.offset.is_finite()))
    {
        return Err(HalfSpaceError::NotFinite { half_space });
    }
    match half_spaces.iter().position(|h| h.normal == DVec3::ZERO) {
        Some(half_space) => Err(HalfSpaceError::NoDirection { half_space }),
        None => Ok(()),
    }
}

/// Whether x lies inside by more than the rounding of the terms.
fn is_well_inside(h: &HalfSpace, x: DVec3) -> bool {
    if x == DVec3::ZERO {
        return h.offset > 0.0;
    }
    let terms = (h.normal * x).abs();
    h.slack(x) > 1e-14 * (terms.x + terms.y + terms.z + h.offset.abs())
}

/// A point strictly inside: the one that was named, the origin where that is well inside, else the
/// centre of a largest ball.
fn inside(half_spaces: &[HalfSpace], named: Option<DVec3>) -> Result<DVec3, HalfSpaceError> {
    let is_inside = |x: DVec3| half_spaces.iter().all(|h| is_well_inside(h, x));
    if let Some(x) = named.filter(|&x| x.is_finite() && is_inside(x)) {
        return Ok(x);
    }
    let distances = half_spaces.iter().map(|h| h.offset / h.normal.length());
    let (least, most) =
        distances.fold((f64::INFINITY, 0.0), |(l, m): (f64, f64), d| (l.min(d), m.max(d)));
    // Dual points of very different size would leave much to exact arithmetic.
    if least > most / 64.0 && is_inside(DVec3::ZERO) {
        return Ok(DVec3::ZERO);
    }
    let Centre { point, radius, touching } = deepest_point(half_spaces);
    if is_inside(point) {
        Ok(point)
    } else if radius < -1e-12 * most.max(-least) {
        Err(HalfSpaceError::Infeasible { half_spaces: touching, gap: -radius })
    } else {
        Err(HalfSpaceError::NoVolume { half_spaces: touching })
    }
}

/// Fewer half-spaces than this are intersected thoroughly at once.
const THOROUGH_BELOW: usize = 1 << 13;
/// Rounds after which slivers stay as they are.
const MOST_ROUNDS: usize = 32;

/// Half-spaces with a point inside all of them.
#[derive(Clone, Copy)]
struct Set<'a> {
    half_spaces: &'a [HalfSpace],
    centre: DVec3,
    is_thorough: bool,
    goes_on: GoesOn<'a>,
}

impl Set<'_> {
    /// The intersection by exact signs alone, vertices where more than three planes meet merged.
    /// When only the simple form is wanted, nothing needs to be merged unless exact zeros came up
    /// on the way.
    fn exact_intersection(&self, simple: bool) -> Result<Polytope, HalfSpaceError> {
        let Self { half_spaces, centre, is_thorough, goes_on } = *self;
        let count = half_spaces.len();
        let order = insertion_order(count, |i| half_spaces[i].normal);
        let mut near = vec![DVec3::ZERO; count];
        fill(&mut near, |place| {
            let h = &half_spaces[order.points[place] as usize];
            h.normal * (1.0 / h.slack(centre))
        });
        // A dual point carries the rounding of the slack, one ulp, and of the division and the
        // product, half an ulp each.
        let (cloud, scale) =
            Cloud::stretched(near, 4.0, PlaneSigns::new(half_spaces, &order.points));
        let mut room = Room::new(count);
        let mut surface = dual_hull(&cloud, scale, &order, &mut room, goes_on)?;
        let faces = if simple && !surface.has_zeros() {
            surface.compact();
            Faces::unmerged(&surface)
        } else {
            Faces::of(&surface, &cloud)
        };
        let placing = Placing {
            half_spaces,
            order: &order.points,
            cloud: &cloud,
            centre,
            scale,
            is_thorough,
        };
        let merged = if faces.has_merged() || surface.slots() > surface.len() {
            Some(placing.vertices(&surface, &faces))
        } else {
            placing.place_poles(&mut surface);
            None
        };
        drop(cloud);
        let count = surface.len();
        let runs = Runs::of(&surface, &faces, &order.points);
        drop((faces, order));
        let poles = room.into_poles(count);
        let vertices = merged.unwrap_or_else(|| poles.into_iter().map(DVec3::from_array).collect());
        let (half_spaces, faces) = runs.into_polygons();
        Ok(Polytope { vertices, half_spaces, faces, interior: centre })
    }

    /// Contracts what is shorter than rounding. Planes that then span no face any more are left out
    /// and the rest is intersected anew, so that a sliver never stays, unless without its plane the
    /// solid would reach beyond that by more than rounding.
    fn contract_all(&self, first: Polytope, resolution: f64) -> Result<Polytope, HalfSpaceError> {
        let mut polytope = first;
        let mut needed: BTreeSet<u32> = BTreeSet::new();
        for _ in 0..MOST_ROUNDS {
            let (merged, mut slivers) = contract(&polytope, self.half_spaces, resolution);
            slivers.retain(|i| !needed.contains(i));
            if slivers.is_empty() || polytope.half_spaces.len() < slivers.len() + 4 {
                return Ok(merged);
            }
            // What is open or flat without the slivers needs them.
            let wider = match self.without(&polytope.half_spaces, &slivers) {
                Ok(wider) => wider,
                Err(HalfSpaceError::Stopped) => return Err(HalfSpaceError::Stopped),
                Err(_) => {
                    needed.extend(slivers);
                    continue;
                }
            };
            let cut_off = wider.beyond(self.half_spaces, &slivers, resolution);
            if cut_off.is_empty() {
                polytope = wider;
            } else {
                needed.extend(cut_off);
            }
        }
        Ok(contract(&polytope, self.half_spaces, resolution).0)
    }

    /// The intersection of some half-spaces without others; both by number, ascending.
    fn without(&self, all: &[u32], others: &[u32]) -> Result<Polytope, HalfSpaceError> {
        let kept: Vec<u32> =
            all.iter().copied().filter(|i| others.binary_search(i).is_err()).collect();
        let fewer: Vec<HalfSpace> = kept.iter().map(|&i| self.half_spaces[i as usize]).collect();
        let mut polytope = Set { half_spaces: &fewer, ..*self }.exact_intersection(false)?;
        polytope.half_spaces.iter_mut().for_each(|i| *i = kept[*i as usize]);
        Ok(polytope)
    }
}

/// The hull of the dual points, with the centre inside.
fn dual_hull<'a>(
    cloud: &Cloud<PlaneSigns<'_>>,
    scale: DVec3,
    order: &Order,
    room: &'a mut Room,
    goes_on: GoesOn<'_>,
) -> Result<Surface<'a>, HalfSpaceError> {
    let open =
        |flat| HalfSpaceError::Unbounded { direction: open_direction(flat, cloud.points(), scale) };
    if cloud.len() < 4 {
        return Err(open(few(cloud.points())));
    }
    let start = far_apart(cloud, 0).map_err(open)?;
    let mut surface = Surface::tetrahedron(cloud, start, None, room);
    let mut inserted = enclose_centre(cloud, &mut surface).map_err(open)?;
    inserted.extend(start);
    inserted.sort_unstable();
    grow(cloud, &mut surface, order, &inserted, goes_on).ok_or(HalfSpaceError::Stopped)?;
    Ok(surface)
}

fn few(points: &[DVec3]) -> Flat {
    match *points {
        [a, b, c] => Flat::Plane((b - a).cross(c - a)),
        [a, b] => Flat::Line(b - a),
        _ => Flat::Point,
    }
}

/// A unit vector u with n·u ≤ 0 for all normals n: along it no plane is ever met. The dual points q
/// were stretched by `scale`; for a direction u that is right for them u ∘ scale is right for the
/// normals.
fn open_direction(flat: Flat, dual_points: &[DVec3], scale: DVec3) -> DVec3 {
    let Some(&q) = dual_points.first() else { return DVec3::X };
    let direction = match flat {
        Flat::OneSided(normal) => normal,
        Flat::Plane(normal) if normal.dot(q) > 0.0 => -normal,
        Flat::Plane(normal) => normal,
        Flat::Line(along) => match along.try_normalize() {
            Some(along) => along * along.dot(q) - q,
            None => -q,
        },
        Flat::Point => -q,
    };
    // Where the line of dual points passes through the centre any direction across it is open.
    let fallback = || q.try_normalize().map_or(DVec3::X, |q| q.any_orthonormal_vector());
    let unstretched =
        direction.try_normalize().unwrap_or_else(fallback) * (scale / scale.max_element());
    unstretched.normalize_or(DVec3::X) + DVec3::ZERO
}
