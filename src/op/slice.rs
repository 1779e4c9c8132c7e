//! Slicing: cut a mesh by one plane and close it.
//!
//! Source: Gonen 2007, III.A. The part on the normal side is removed, what is left is closed by
//! caps. A mesh that was open stays open along the cut. Changes: every crossed edge gets a vertex
//! on the plane, every region of the section a cap. Volume kept + volume removed = volume before.
//! Degenerate: a plane that misses changes nothing; faces in the plane stay when the material lies
//! behind them; a plane that would remove everything is an error.

use glam::DVec3;
use serde::Deserialize;

use super::cut::{Cutter, Reach, SlicingPlane};
use super::report::{CutReport, RoundMarks, finish};
use super::{Capping, OpContext, OpError};
use crate::mesh::Mesh;
use crate::units::{Direction, Point};

/// Which part of the mesh a slice keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Keep {
    /// The part against the normal.
    #[default]
    Reverse,
    /// The part on the side to which the normal points.
    Normal,
    /// Both parts, each as a mesh of its own
    Both,
}

/// How to slice a mesh. One definition for the library, the command line and the recipe.
#[derive(Debug, Clone, clap::Args, Deserialize)]
pub struct SliceParams {
    /// The direction of the plane's normal, which points to the side that is removed: `x`, `-z` or
    /// `1,0,1`.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub normal: Direction,
    /// A point on the plane, in mm unless units are given: `0,0,10`.
    #[arg(long, value_name = "X,Y,Z", allow_hyphen_values = true)]
    pub point: Point,
    /// Which part to keep.
    #[arg(long, value_enum, default_value_t = Keep::Reverse)]
    #[serde(default)]
    pub keep: Keep,
    /// Which loops of the section are closed.
    #[arg(long, value_enum, default_value_t = Capping::Auto)]
    #[serde(default)]
    pub cap: Capping,
}

impl SliceParams {
    /// Cuts through `point` across `normal`, everything else by default.
    pub fn new(normal: DVec3, point: DVec3) -> Self {
        Self {
            normal: Direction(normal),
            point: Point(point),
            keep: Keep::default(),
            cap: Capping::default(),
        }
    }
}

/// Cuts a mesh by a plane.
///
/// Signs of given numbers (positions from a file, and the plane) are exact; constructed positions
/// within the rounding bound count as on the plane.
///
/// # Errors
/// [`OpError::NoDirection`], [`OpError::BadPoint`], [`OpError::NothingLeft`] when the plane leaves
/// no mesh, [`OpError::NotSimple`] when a face comes twice to a vertex and cannot be divided,
/// [`OpError::TwoParts`] for [`Keep::Both`], which [`slice_both`] is for.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use glam::DVec3;
///
/// let cube = kerfold::shape::cube(10.0);
/// let params = SliceParams::new(DVec3::Z, DVec3::new(0.0, 0.0, 2.0));
/// let (lower, report) = slice(&cube, &params, &OpContext::default())?;
/// assert_eq!((report.cuts, lower.face_count()), (1, 6));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn slice(
    mesh: &Mesh,
    params: &SliceParams,
    _context: &OpContext<'_>,
) -> Result<(Mesh, CutReport), OpError> {
    let (Direction(normal), Point(point)) = (params.normal, params.point);
    let normal = match params.keep {
        Keep::Reverse => normal,
        Keep::Normal => -normal,
        Keep::Both => return Err(OpError::TwoParts),
    };
    let plane = SlicingPlane::given(normal, point)?;
    let mut cutter = Cutter::new(mesh.clone());
    cutter.set_capping(params.cap);
    cutter.cut(&plane, Reach::Global);
    if cutter.mesh().face_count() == 0 {
        return Err(OpError::NothingLeft { cut: 1, cuts: 1 });
    }
    let marks = RoundMarks { caps: vec![cutter.cap_lineage(0)], strips: Vec::new() };
    let made = marks.collect(&cutter);
    let report = CutReport {
        cuts: 1,
        missed: usize::from(cutter.last_cut().is_miss),
        lids: cutter.last_cut().lids,
        made,
        ..CutReport::default()
    };
    finish(cutter.into_mesh(), report)
}

/// Cuts a mesh by a plane and keeps both parts: first the one on the reverse side, then the one on
/// the normal side. `None` stands for a part that is empty. [`SliceParams::keep`] is not asked.
///
/// # Errors
/// As [`slice()`], but an empty part is none.
///
/// # Example
/// ```
/// use kerfold::prelude::*;
/// use glam::DVec3;
/// use kerfold::measure::volume;
///
/// let cube = kerfold::shape::cube(10.0);
/// let params = SliceParams::new(DVec3::ONE, DVec3::ZERO);
/// let parts = kerfold::op::slice_both(&cube, &params, &OpContext::default())?;
/// let sum: f64 = parts.iter().flatten().map(|(part, _)| volume(part)).sum();
/// assert!((sum - 1000.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn slice_both(
    mesh: &Mesh,
    params: &SliceParams,
    context: &OpContext<'_>,
) -> Result<[Option<(Mesh, CutReport)>; 2], OpError> {
    let part = |keep| match slice(mesh, &SliceParams { keep, ..params.clone() }, context) {
        Ok(part) => Ok(Some(part)),
        Err(OpError::NothingLeft { .. }) => Ok(None),
        Err(error) => Err(error),
    };
    Ok([part(Keep::Reverse)?, part(Keep::Normal)?])
}
