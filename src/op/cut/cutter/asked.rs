//! What a cut is asked: the plane, how far it reaches, and what is closed.

use glam::DVec3;
use serde::Deserialize;

use crate::geom::Plane;
use crate::mesh::VertexId;
use crate::op::OpError;

/// A slicing plane with what is known about its numbers.
#[derive(Debug, Clone, Copy)]
pub(in crate::op) struct SlicingPlane {
    /// The plane; its normal side is removed.
    pub plane: Plane,
    /// Normal and point as the user gave them, when they were given and not constructed: then signs
    /// are exact.
    pub given: Option<(DVec3, DVec3)>,
}

impl SlicingPlane {
    /// The plane of given numbers; `normal` may have any length.
    pub(in crate::op) fn given(normal: DVec3, point: DVec3) -> Result<Self, OpError> {
        if !point.is_finite() {
            return Err(OpError::BadPoint(point.x, point.y, point.z));
        }
        let plane =
            Plane::new(normal, point).ok_or(OpError::NoDirection(normal.x, normal.y, normal.z))?;
        Ok(Self { plane, given: Some((normal, point)) })
    }
}

/// How far a cut reaches.
#[derive(Debug, Clone, Copy)]
pub enum Reach<'a> {
    /// The whole mesh.
    Global,
    /// Only the part of the normal side connected with these vertices.
    Local(&'a [VertexId]),
}

/// Which walks of a section are closed by caps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Hash, clap::ValueEnum, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Capping {
    /// Parts that were closed get caps, parts that were open stay open along the cut.
    #[default]
    Auto,
    /// Every loop of the section gets a cap, but for those that run into an old rim.
    Always,
    /// No caps: the cut leaves rims.
    Never,
}
