//! Menger sponges (Srinivasan 2004, VII): a tunnel from each face of a solid to a chamber in its
//! middle.
//!
//! Each edge is divided in three, each face becomes a frame around a smaller face, from there a
//! tunnel leads inwards to a copy of the smaller face at the depth of the thickness, and the copies
//! are joined along their sides and around the old vertices into an inner skin. Where faces meet at
//! an angle of 90° or less the copies meet, too: the strip between them is left out and its ends
//! become one vertex, as do those up to the angle asked for. At concave edges (over 180°) the strip
//! is bent around the edge at the distance of the thickness (figure 61).
//!
//! One round on a closed mesh with V, E, F of which no strip is left out:
//!
//! ```text
//!   vertices  V+6E    edges  15E    faces  7E+V    genus  2g+F−1    concave edge: +2, +3, +1
//! ```
//!
//! A strip left out takes a face and an edge with it; nothing of it stays as a 2-gon. Needs: a
//! closed mesh. Keeps: groups, for the frames; components. Planarity: of quads on a planar face,
//! yes; corners of the inner skin by luck. Degenerate cases: corners of 180° (winged) move at right
//! angles to their sides, reflex ones backwards. When the thickness is too large for a face, it is
//! named and the result is marked as not clean. `exact` is another thing: the solid that Menger
//! defined, of a cube or parallelepiped, with square faces of one size.

mod exact;
mod round;

#[cfg(test)]
mod tests;

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Deserializer, de};

use super::report::{crossing_note, crossing_pairs, first_few};
use super::simple::{Mended, keep_simple};
use super::size::check_size;
use super::{OpContext, OpError, OpFinding};
use crate::code::Coded;
use crate::measure::CrossingPair;
use crate::mesh::Mesh;
use crate::select::NewElements;
use crate::units::{Angle, Length, UnitError, parse_number};

/// The most rounds that may be asked for; the size of the result ends it much sooner.
const MOST_ROUNDS: u32 = 16;

/// How to make a Menger sponge. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct MengerParams {
    /// How many rounds, 1 to 16; each makes some 14 times as many faces.
    #[arg(long, default_value_t = default_rounds())]
    #[serde(default = "default_rounds")]
    pub rounds: u32,
    /// Thickness of the frames and depth of the tunnels: a share of the sides below 1/2, or with a
    /// unit a length.
    #[arg(long, default_value_t = Thickness::default())]
    #[serde(default)]
    pub thickness: Thickness,
    /// Faces that meet at this angle or a smaller one have their tunnels' ends joined, 90deg or
    /// more and below 180deg.
    #[arg(long, default_value = "90deg")]
    #[serde(default = "default_collapse")]
    pub collapse: Angle,
    /// The sponge that Menger defined, for a cube or another parallelepiped: 20 smaller copies in
    /// each round, in one surface.
    #[arg(long)]
    #[serde(default)]
    pub exact: bool,
}

fn default_rounds() -> u32 {
    1
}

fn default_collapse() -> Angle {
    Angle::from_degrees(90.0)
}

/// How thick the frames are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Thickness {
    /// A share of the sides.
    Share(f64),
    /// The same everywhere.
    Length(Length),
}

impl Default for Thickness {
    fn default() -> Self {
        Self::Share(1.0 / 3.0)
    }
}

impl FromStr for Thickness {
    type Err = UnitError;

    fn from_str(text: &str) -> Result<Self, UnitError> {
        let error = |_| UnitError {
            text: text.to_owned(),
            wanted: "a thickness",
            example: "1/3 (of the sides) or 5mm",
        };
        parse_number(text)
            .map(Self::Share)
            .or_else(|_| text.parse().map(Self::Length).map_err(error))
    }
}

impl fmt::Display for Thickness {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Share(share) if *share == 1.0 / 3.0 => f.write_str("1/3"),
            Self::Share(share) => share.fmt(f),
            Self::Length(length) => length.fmt(f),
        }
    }
}

impl<'de> Deserialize<'de> for Thickness {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Typed {
            Number(f64),
            Text(String),
        }
        match Typed::deserialize(deserializer)? {
            Typed::Number(share) => Ok(Self::Share(share)),
            Typed::Text(text) => text.parse().map_err(de::Error::custom),
        }
    }
}

impl Default for MengerParams {
    fn default() -> Self {
        Self {
            rounds: 1,
            thickness: Thickness::default(),
            collapse: default_collapse(),
            exact: false,
        }
    }
}

/// A round in which frames or tunnels do not fit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RoundCrossing {
    /// The round, counted from 1.
    pub round: u32,
    /// The faces whose frame or tunnel does not fit, in ids of the mesh before the round.
    pub faces: Vec<usize>,
}

/// What the rounds met with.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct MengerReport {
    /// The rounds in which frames or tunnels do not fit.
    pub crossing: Vec<RoundCrossing>,
    /// Faces of the result that go through each other, as tunnels do that meet in a thin wall; a
    /// thousand pairs at most.
    pub pairs: Vec<CrossingPair>,
    /// What had to be mended so that files can hold the result.
    pub mended: Mended,
}

impl MengerReport {
    /// The report in words.
    pub fn notes(&self) -> Vec<String> {
        let note = |RoundCrossing { round, faces }: &RoundCrossing| {
            format!(
                "round {round}: the thickness is too large at {} faces ({}), so the sponge crosses \
                itself there; take less ({})",
                faces.len(),
                first_few(faces, 8),
                OpFinding::SpongeCrosses.code()
            )
        };
        let mut notes = self.mended.notes();
        notes.extend(self.crossing.iter().map(note));
        notes.extend(crossing_note(&self.pairs, OpFinding::SpongeCrosses.code()));
        notes
    }
}

/// Makes a Menger sponge. Positions count as constructed; planes are not carried along.
///
/// # Errors
/// [`OpError::RepeatOutOfRange`]; [`OpError::ShareOutOfRange`]; [`OpError::DepthTooSmall`];
/// [`OpError::AngleOutOfRange`]; [`OpError::NotClosed`]; [`OpError::NoArea`];
/// [`OpError::DoesNotFit`] before the first round; [`OpError::Cancelled`]; with
/// `exact` [`OpError::NotABox`], and [`OpError::Exclude`] for another thickness than 1/3.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(90.0);
/// let params = MengerParams { rounds: 1, exact: true, ..MengerParams::default() };
/// let (sponge, _) = menger(&cube, &params, &OpContext::default())?;
/// assert_eq!(kerfold::measure::genus(&sponge), 5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn menger(
    mesh: &Mesh,
    params: &MengerParams,
    context: &OpContext<'_>,
) -> Result<(Mesh, MengerReport), OpError> {
    check(mesh, params)?;
    let edges = mesh.edge_count() as f64;
    check_size("rounds", params.rounds, |rounds| growth(params.exact, edges, rounds))?;
    if params.exact {
        return Ok((exact::exact(mesh, params.rounds, context)?, MengerReport::default()));
    }
    let mut report = MengerReport::default();
    let mut fine: Option<Mesh> = None;
    for round in 1..=params.rounds {
        if context.progress.is_cancelled() {
            return Err(OpError::Cancelled);
        }
        context.progress.report("digging tunnels", round as usize - 1, params.rounds as usize);
        let coarse = fine.as_ref().unwrap_or(mesh);
        let (next, crossing) = round::round(coarse, params, context.progress)?;
        if !crossing.is_empty() {
            report.crossing.push(RoundCrossing { round, faces: crossing });
        }
        fine = Some(next);
    }
    let mut sponge = fine.expect("there is at least one round");
    let advice = "take another thickness, or other faces that meet at a right angle";
    report.mended = keep_simple(mesh, &mut sponge, &mut NewElements::default(), advice)?;
    report.pairs = crossing_pairs(&sponge, context.progress)?;
    Ok((sponge, report))
}

/// The edges after so many rounds: 15 for each one and 3 more where it is concave, or those of the
/// smaller copies.
fn growth(is_exact: bool, edges: f64, rounds: u32) -> f64 {
    let factor: f64 = if is_exact { 20.0 } else { 15.0 };
    edges * factor.powi(rounds as i32)
}

fn check(mesh: &Mesh, params: &MengerParams) -> Result<(), OpError> {
    if !(1..=MOST_ROUNDS).contains(&params.rounds) {
        return Err(OpError::RepeatOutOfRange { repeat: params.rounds, limit: MOST_ROUNDS });
    }
    match params.thickness {
        Thickness::Share(share) if !(share > 0.0 && share < 0.5) => {
            return Err(OpError::ShareOutOfRange { what: "thickness", share, limit: 0.5 });
        }
        Thickness::Length(length) => {
            let bound = mesh
                .bounds()
                .map_or(0.0, |(low, high)| crate::geom::RoundingBound::of_box(low, high).length());
            if !(length.mm() > 8.0 * bound && length.mm().is_finite()) {
                return Err(OpError::DepthTooSmall { depth: length.mm(), least: 8.0 * bound });
            }
        }
        Thickness::Share(_) => {}
    }
    if params.exact && params.thickness != Thickness::default() {
        return Err(OpError::Exclude { first: "exact", second: "a thickness other than 1/3" });
    }
    let degrees = params.collapse.degrees();
    if !(90.0..180.0).contains(&degrees) {
        return Err(OpError::AngleOutOfRange {
            what: "collapse",
            degrees,
            least: 90.0,
            limit: 180.0,
        });
    }
    if !mesh.is_closed() {
        return Err(OpError::NotClosed { what: "a Menger sponge", holes: mesh.hole_count() });
    }
    Ok(())
}
