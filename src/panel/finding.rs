//! Which nodes break what the user requires.

use super::params::{PanelParams, PanelRequirement};
use super::plate::Plates;
use crate::mesh::VertexId;

/// Plates of a node whose residual is larger than this do not meet, in mm per mm: a millionth of
/// the offset.
pub const CONICAL: f64 = 1e-6;

/// A node that breaks a requirement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PanelFinding {
    /// The requirement.
    pub requirement: PanelRequirement,
    /// The vertex.
    pub vertex: VertexId,
    /// Its valence, or its residual in mm per mm.
    pub measured: f64,
    /// What it may be at most.
    pub limit: f64,
}

/// All nodes that break a requirement, in the order of the requirements and nodes.
pub fn panel_findings(plates: &Plates, params: &PanelParams) -> Vec<PanelFinding> {
    let mut findings = Vec::new();
    if params.requires(PanelRequirement::Valence3) {
        let is_other = |valence: usize, is_rim: bool| valence != 3 && !(is_rim && valence == 2);
        let other = plates.nodes.iter().filter(|n| is_other(n.valence, n.is_rim));
        findings.extend(other.map(|n| PanelFinding {
            requirement: PanelRequirement::Valence3,
            vertex: n.vertex,
            measured: n.valence as f64,
            limit: 3.0,
        }));
    }
    if params.requires(PanelRequirement::Conical) {
        let apart = plates.nodes.iter().filter(|n| n.residual > CONICAL);
        findings.extend(apart.map(|n| PanelFinding {
            requirement: PanelRequirement::Conical,
            vertex: n.vertex,
            measured: n.residual,
            limit: CONICAL,
        }));
    }
    findings
}
