//! The radii of rolls: the largest that the limits leave, or those that were asked for.

use super::limit::{Limit, limits, tightest};
use super::params::Roll;
use super::ridge::Ridge;
use super::{first_edges, named};
use crate::mesh::Mesh;
use crate::op::OpError;
use crate::op::roll_error::RollError;
use crate::op::rolled::{Place, RollLimit};
use crate::units::Length;

/// How much of an edge or of the way to a corner the largest rolls take; the rest keeps strips and
/// faces apart.
const SHARE: f64 = 0.875;
/// By how much more than all a given radius may take of a place: the rounding of its digits.
const ROUNDING: f64 = 1e-9;

/// The radii at both ends of every ridge, in mm.
pub(super) struct Radii {
    pub of: Vec<[f64; 2]>,
    /// What limits them, where the largest were asked for.
    pub limit: Option<RollLimit>,
}

impl Radii {
    /// Solved from the limits, or compared with them.
    pub fn solve(mesh: &Mesh, ridges: &[Ridge], roll: Roll) -> Result<Self, OpError> {
        let both = |radius: f64| vec![[radius; 2]; ridges.len()];
        match roll {
            Roll::Max => largest_common(&limits(mesh, ridges, &both(1.0)), ridges),
            Roll::Each => largest_for_each(&limits(mesh, ridges, &both(1.0)), ridges),
            Roll::Radius(radius) => given(mesh, ridges, roll, [radius; 2]),
            Roll::Cone(radii) => given(mesh, ridges, roll, radii),
        }
    }
}

/// Limits are linear in a common radius, so one division solves it.
fn largest_common(limits: &[Limit], ridges: &[Ridge]) -> Result<Radii, OpError> {
    let tight = tightest(limits).ok_or_else(|| no_room(limits, ridges))?;
    let radius = SHARE / tight.filled();
    if !(radius.is_finite() && radius > 0.0) {
        return Err(no_room(limits, ridges));
    }
    let limit = named(tight, ridges, radius, SHARE);
    Ok(Radii { of: vec![[radius; 2]; ridges.len()], limit: Some(limit) })
}

/// All radii grow together; those that a limit holds stop, and the others go on.
fn largest_for_each(limits: &[Limit], ridges: &[Ridge]) -> Result<Radii, OpError> {
    let mut radii: Vec<Option<f64>> = vec![None; ridges.len()];
    let mut first = None;
    while radii.contains(&None) {
        let reached = |limit: &Limit| {
            let (mut fixed, mut growing) = (0.0, 0.0);
            for &(i, taken) in &limit.taken {
                match radii[i] {
                    Some(radius) => fixed += radius * taken,
                    None => growing += taken,
                }
            }
            (growing > 0.0).then(|| ((SHARE - fixed) / growing).max(0.0))
        };
        let open = limits.iter().filter_map(|limit| Some((reached(limit)?, limit)));
        let Some((radius, limit)) = open.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
        if !(radius.is_finite() && radius > 0.0) {
            return Err(no_room(limits, ridges));
        }
        first = first.or_else(|| Some(named(limit, ridges, radius, SHARE)));
        for &(i, _) in &limit.taken {
            radii[i] = radii[i].or(Some(radius));
        }
    }
    let of: Option<Vec<[f64; 2]>> = radii.into_iter().map(|r| r.map(|r| [r; 2])).collect();
    let of = of.ok_or_else(|| no_room(limits, ridges))?;
    Ok(Radii { of, limit: first })
}

fn given(
    mesh: &Mesh,
    ridges: &[Ridge],
    roll: Roll,
    lengths: [Length; 2],
) -> Result<Radii, OpError> {
    let asked = lengths.map(Length::mm);
    if let Some(&radius) = asked.iter().find(|r| !(r.is_finite() && **r > 0.0)) {
        return Err(RollError::BadRadius { radius }.into());
    }
    let of = vec![asked; ridges.len()];
    let scaled = |share: f64| limits(mesh, ridges, &vec![asked.map(|r| r * share); ridges.len()]);
    let found = scaled(1.0);
    match tightest(&found) {
        Some(tight) if tight.filled() > 1.0 + ROUNDING => {
            let wider = asked[0].max(asked[1]);
            let fits = if asked[0] == asked[1] {
                tight.filled().recip()
            } else {
                largest_share(|share| tightest(&scaled(share)).map_or(0.0, Limit::filled))
            };
            Err(RollError::TooLarge {
                asked: format!("the roll {roll}"),
                place: tight.place,
                edges: first_edges(tight, ridges),
                largest: rounded_down(wider * fits),
            }
            .into())
        }
        _ => Ok(Radii { of, limit: None }),
    }
}

/// The largest share of a cone at which nothing is filled; by halving, since the stretches of cones
/// are not linear in their radii.
fn largest_share(filled: impl Fn(f64) -> f64) -> f64 {
    let (mut fits, mut too_large) = (0.0, 1.0);
    for _ in 0..64 {
        let middle = 0.5 * (fits + too_large);
        if filled(middle) > 1.0 { too_large = middle } else { fits = middle }
    }
    fits
}

/// Down to four digits, so that the number can be typed.
fn rounded_down(x: f64) -> f64 {
    if !(x.is_finite() && x > 0.0) {
        return 0.0;
    }
    let digits = 3 - x.log10().floor() as i32;
    let down = (x * 10.0_f64.powi(digits) * (1.0 + 1e-12)).floor();
    // Divided by a whole power where there is one, so that no digits of rounding are shown.
    if digits >= 0 { down / 10.0_f64.powi(digits) } else { down * 10.0_f64.powi(-digits) }
}

/// Where not even the smallest radius has room.
fn no_room(limits: &[Limit], ridges: &[Ridge]) -> OpError {
    let tight = tightest(limits);
    let place = tight.map_or(Place::Edge(ridges[0].edge), |limit| limit.place);
    let edges = tight.map_or_else(Vec::new, |limit| first_edges(limit, ridges));
    RollError::TooLarge { asked: "any radius".to_owned(), place, edges, largest: 0.0 }.into()
}
