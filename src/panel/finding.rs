//! What breaks what the user requires, and faces that are not planar.

use super::params::{PanelParams, PanelRequirement};
use super::planar::bent_faces;
use super::plate::Plates;
use crate::code::codes;
use crate::mesh::{FaceId, Mesh, VertexId};

/// Plates of a node whose residual is larger than this do not meet, in mm per mm: a millionth of
/// the offset.
pub const CONICAL: f64 = 1e-6;

/// What is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PanelCheck {
    /// A node with other than three edges, where three are required.
    Valence3,
    /// A node whose plates do not meet, where that is required.
    Conical,
    /// A face that is not planar.
    Planar,
}

codes!(finding PanelCheck {
    Valence3 = 301,
    Conical = 302,
    Planar = 303,
});

/// Where something is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum PanelElement {
    /// At a vertex.
    Node(VertexId),
    /// At a face.
    Face(FaceId),
}

/// Something that is not as it should be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PanelFinding {
    /// What.
    pub check: PanelCheck,
    /// Where.
    pub element: PanelElement,
    /// A valence, a residual in mm per mm, or a distance in mm.
    pub measured: f64,
    /// What it may be at most.
    pub limit: f64,
}

/// All faces that are not planar, and all nodes that break a requirement, in the order of the
/// requirements and nodes.
pub fn panel_findings(mesh: &Mesh, plates: &Plates, params: &PanelParams) -> Vec<PanelFinding> {
    let bent = bent_faces(mesh).into_iter().map(|bent| PanelFinding {
        check: PanelCheck::Planar,
        element: PanelElement::Face(bent.face),
        measured: bent.mm,
        limit: bent.limit,
    });
    let mut findings: Vec<PanelFinding> = bent.collect();
    if params.requires(PanelRequirement::Valence3) {
        let is_other = |valence: usize, is_rim: bool| valence != 3 && !(is_rim && valence == 2);
        let other = plates.nodes.iter().filter(|n| is_other(n.valence, n.is_rim));
        findings.extend(other.map(|n| PanelFinding {
            check: PanelCheck::Valence3,
            element: PanelElement::Node(n.vertex),
            measured: n.valence as f64,
            limit: 3.0,
        }));
    }
    if params.requires(PanelRequirement::Conical) {
        let apart = plates.nodes.iter().filter(|n| n.residual > CONICAL);
        findings.extend(apart.map(|n| PanelFinding {
            check: PanelCheck::Conical,
            element: PanelElement::Node(n.vertex),
            measured: n.residual,
            limit: CONICAL,
        }));
    }
    findings
}
