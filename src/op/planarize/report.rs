//! What planarizing did, and what it cost, in numbers and words.

use crate::check::short;
use crate::code::Coded;
use crate::mesh::{FaceId, VertexId};
use crate::op::OpFinding;
use crate::op::report::first_few;
use crate::units::counted;

/// What planarizing did. Ids are those of the mesh, which keeps them.
#[derive(Debug, Clone, PartialEq)]
pub struct PlanarizeReport {
    /// How many rounds it took.
    pub rounds: u32,
    /// Whether all faces keep the limits of the profile.
    pub is_planar: bool,
    /// The face farthest from its limit, and the largest distance of a corner from a face's plane
    /// before and after, in mm.
    pub worst: Option<FaceId>,
    /// Before.
    pub before_mm: f64,
    /// After.
    pub after_mm: f64,
    /// The longest way of a vertex, in mm.
    pub largest_movement_mm: f64,
    /// The mean way of all vertices, in mm.
    pub mean_movement_mm: f64,
    /// The vertex with the longest way.
    pub farthest: Option<VertexId>,
    /// Faces whose sides cross or touch each other now and did not before.
    pub crossing: Vec<FaceId>,
    /// Corners that were no needles before and are now.
    pub needles: Vec<Needle>,
    /// Corners that were not sharp before and are now, needles not among them.
    pub sharp: Vec<Needle>,
    /// Faces that were convex before and are concave now.
    pub concave: Vec<FaceId>,
    /// Vertices that moved by more than a tenth of their mean edge, farthest first.
    pub far: Vec<FarMove>,
    /// Whether most faces have four sides.
    pub is_quads: bool,
    /// How many faces the model has.
    pub faces: usize,
    /// Whether it is closed: only then can planes cut it face by face.
    pub is_closed: bool,
}

/// A vertex that moved so far that the model is another one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FarMove {
    /// The vertex.
    pub vertex: VertexId,
    /// How far, in mm.
    pub mm: f64,
    /// The same as a share of the mean length of its edges before.
    pub share: f64,
}

/// A corner of a face so sharp that no plate can be made of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Needle {
    /// The face.
    pub face: FaceId,
    /// The vertex at the corner.
    pub vertex: VertexId,
    /// Its angle, in degrees.
    pub degrees: f64,
}

/// A corner with a smaller angle is a needle, in degrees; one as near to a full turn is a slit.
pub(super) const SHARPEST: f64 = 0.1;
/// A corner with a smaller angle breaks off or cannot be ground, in degrees.
pub(super) const SHARP: f64 = 5.0;
/// A vertex that moves by more than this share of its mean edge makes another model.
pub(super) const TENTH: f64 = 0.1;

impl PlanarizeReport {
    /// What the user should know, in words.
    pub fn notes(&self) -> Vec<String> {
        let mut notes = vec![format!(
            "planarized in {} rounds: corners off their face's plane by {} mm at most before, {} \
            mm after; vertices moved by {} mm at most{}, {} mm on average",
            self.rounds,
            short(self.before_mm),
            short(self.after_mm),
            short(self.largest_movement_mm),
            self.farthest.map_or(String::new(), |v| format!(" (vertex {v})")),
            short(self.mean_movement_mm)
        )];
        if let Some(worst) = self.worst.filter(|_| !self.is_planar) {
            notes.push(format!(
                "the profile is not reached: face {worst} is the worst; allow more rounds, free \
                its fixed corners, or divide it ({})",
                OpFinding::NotPlanar.code()
            ));
        }
        if !self.crossing.is_empty() {
            notes.push(format!(
                "sides cross now at {} faces that were simple before ({}): take a looser profile \
                or more fairness, or make them planar by `cut face` instead ({})",
                self.crossing.len(),
                first_few(&self.crossing, 8),
                OpFinding::FacesCross.code()
            ));
        }
        if let Some(worst) = self.needles.first() {
            notes.push(format!(
                "{} corners became sharper than {SHARPEST}°, the first in face {} at vertex {} \
                ({:.2e}°): no plate can be made of them; take a looser profile or more fairness, or \
                merge the two ends of the short side there ({})",
                self.needles.len(),
                worst.face,
                worst.vertex,
                worst.degrees,
                OpFinding::NeedleCorners.code()
            ));
        }
        notes.extend(self.damage_in_words());
        notes
    }

    /// What the movement cost, each with its numbers, and other ways at the end.
    fn damage_in_words(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(worst) = self.far.first() {
            notes.push(format!(
                "{} moved by more than a tenth of the edges there, the farthest, vertex {}, by {} \
                mm, {:.0} % of its edges: the model is not what was drawn ({})",
                counted(self.far.len(), "vertex", "vertices"),
                worst.vertex,
                short(worst.mm),
                100.0 * worst.share,
                OpFinding::MovedFar.code()
            ));
        }
        if !self.concave.is_empty() {
            notes.push(format!(
                "{} concave and {} convex before ({}) ({})",
                counted(self.concave.len(), "panel is", "panels are"),
                if self.concave.len() == 1 { "was" } else { "were" },
                first_few(&self.concave, 8),
                OpFinding::MadeConcave.code()
            ));
        }
        if let Some(worst) = self.sharp.iter().min_by(|a, b| a.degrees.total_cmp(&b.degrees)) {
            notes.push(format!(
                "{} sharper than {SHARP}° and {} not before, the sharpest {}° in face {} at \
                vertex {} ({})",
                counted(self.sharp.len(), "corner is", "corners are"),
                if self.sharp.len() == 1 { "was" } else { "were" },
                short(worst.degrees),
                worst.face,
                worst.vertex,
                OpFinding::MadeSharp.code()
            ));
        }
        if self.is_damaged() {
            let planes = if self.is_closed {
                ", `kerfold cut face IN --select all -o OUT` moves planes instead of points"
            } else {
                ""
            };
            notes.push(format!(
                "other ways to planar panels: `kerfold panelize IN --count {} -o OUT` lays panels on \
                the form anew, `kerfold subdivide triangulate IN -o OUT` makes triangles, which are \
                always planar{planes}",
                self.faces
            ));
        }
        if self.is_quads && (self.is_damaged() || !self.is_planar) {
            notes.push(
                "why: on a doubly curved surface quads are planar only where their edges follow \
                conjugate directions, such as lines of curvature, so any other mesh of quads has \
                to move far"
                    .to_owned(),
            );
        }
        notes
    }

    fn is_damaged(&self) -> bool {
        !(self.far.is_empty() && self.concave.is_empty() && self.sharp.is_empty())
    }

    /// Whether the profile is reached, no vertex moved far, and no face crosses itself, is concave
    /// or has a sharp corner that did not before.
    pub fn is_clean(&self) -> bool {
        let is_simple = self.crossing.is_empty() && self.needles.is_empty();
        self.is_planar && is_simple && !self.is_damaged()
    }
}
