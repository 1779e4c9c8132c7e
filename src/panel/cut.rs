//! What happens at the edges: which joint they have, and how far the sides of every plate move in
//! for it ([`super::across`]), behind their cuts where faces are not planar.

use glam::DVec3;

use super::across::{Across, Inset, squared};
use super::error::PanelError;
use super::outline::FlatFace;
use super::params::{CutStyle, PanelParams, RimCut, Shallow};
use super::rule::EdgeKind;
use crate::geom::{Plane, RoundingBound};
use crate::measure::fold_angle;
use crate::mesh::{EdgeId, EdgeMap, FaceId, FaceMap, HalfEdgeId, HalfEdgeMap, Mesh};

/// Mitres steeper than this are knife edges: the dihedral angle is below 1°.
const KNIFE: f64 = 89.5;

/// Cuts of rims are no steeper than this, in degrees off square; the rim is cut square instead.
const STEEPEST_RIM: f64 = 60.0;

/// Of an edge whose ends lie off a plane by one length on different sides, how far it and what lies
/// one length beside it is turned at most, in these lengths; with a half as margin.
const TURNED: f64 = 3.0;

/// Dihedral angles of convex edges that fingers and butt joints can have, in degrees; concave ones
/// mirrored.
const FINGER_ANGLES: [f64; 2] = [30.0, 140.0];
const BUTT_ANGLES: [f64; 2] = [30.0, 150.0];

/// Why an edge is not what its rule says.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum EdgeFallback {
    /// The plates lie too flat against each other.
    Shallow,
    /// They meet at too sharp an angle.
    Sharp,
    /// The edge is too short for two fingers.
    Short,
    /// The fingers would run into another side of a plate.
    Narrow,
    /// The plates of a node would run into each other there.
    Overlap,
}

impl EdgeFallback {
    /// The word in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shallow => "shallow",
            Self::Sharp => "sharp",
            Self::Short => "short",
            Self::Narrow => "narrow",
            Self::Overlap => "overlap",
        }
    }
}

/// What happens at one edge.
#[derive(Debug, Clone, PartialEq)]
pub struct EdgeCut {
    /// The edge.
    pub edge: EdgeId,
    /// Its fold angle in radians, positive when convex; `None` at a rim.
    pub fold: Option<f64>,
    /// What it is.
    pub kind: EdgeKind,
    /// What it should have been, and why it is not.
    pub fallback: Option<(EdgeKind, EdgeFallback)>,
    /// The insets of the plates on the left of its two half-edges; `None` for a hole.
    pub insets: [Option<Inset>; 2],
    /// Distance between the two plates at front and back, in mm: the V of square-cut plates. `None`
    /// at rims, and where plates overlap by their joint.
    pub opening: Option<[f64; 2]>,
    /// Whether the plates are so different in thickness, and the edge so flat, that their surfaces
    /// step.
    pub is_stepped: bool,
}

/// Decides the cuts of all edges; knows the thickness of every plate.
pub(super) struct Cutter<'a> {
    pub mesh: &'a Mesh,
    pub params: &'a PanelParams,
    pub thickness: FaceMap<f64>,
    folds: EdgeMap<Option<f64>>,
    kinds: EdgeMap<(EdgeKind, Option<(EdgeKind, EdgeFallback)>)>,
    rims: FaceMap<Option<DVec3>>,
    /// Whether the corner of a plate at the origin of a half-edge is straight.
    straight: HalfEdgeMap<bool>,
    /// How far each side of a plate stays behind its cut, since its face is not planar, in mm.
    slack: HalfEdgeMap<f64>,
    /// How deep the corner at the origin of a half-edge is cut off: along its bisector in the frame
    /// of its face.
    levels: HalfEdgeMap<Option<f64>>,
    /// The half-edges that have a level.
    levelled: Vec<HalfEdgeId>,
}

impl<'a> Cutter<'a> {
    pub fn new(
        mesh: &'a Mesh,
        params: &'a PanelParams,
        thickness: FaceMap<f64>,
    ) -> Result<Self, PanelError> {
        let mut folds = EdgeMap::filled(mesh.edge_slots(), None);
        let mut kinds = EdgeMap::filled(mesh.edge_slots(), (EdgeKind::Mitre, None));
        for e in mesh.edges().filter(|&e| !mesh.is_rim(e)) {
            let fold = fold_angle(mesh, e).unwrap_or(0.0);
            folds[e] = Some(fold);
            kinds[e] = kind_of(180.0 - fold.to_degrees(), params);
            let is_mitre = !matches!(kinds[e].0, EdgeKind::Butt | EdgeKind::Finger);
            if is_mitre && fold.abs().to_degrees() > 2.0 * KNIFE {
                return Err(PanelError::KnifeEdge { edge: e, degrees: 180.0 - fold.to_degrees() });
            }
        }
        let mut rims = FaceMap::filled(mesh.face_slots(), None);
        for hole in mesh.holes() {
            rims[hole] = Plane::newell(&mesh.face_positions(hole)).map(|p| p.normal());
        }
        let straight = HalfEdgeMap::filled(mesh.half_edge_slots(), false);
        let levels = HalfEdgeMap::filled(mesh.half_edge_slots(), None);
        let slack = HalfEdgeMap::filled(mesh.half_edge_slots(), 0.0);
        let levelled = Vec::new();
        Ok(Self { mesh, params, thickness, folds, kinds, rims, straight, slack, levels, levelled })
    }

    /// Says that two sides of a plate run on in a line: its corner at the origin of `h` is
    /// straight.
    pub fn set_straight(&mut self, h: HalfEdgeId) {
        self.straight[h] = true;
    }

    /// Keeps the sides of a plate back where corners of its face lie off its plane, by more than
    /// rounding: the plates of an edge then see it in different places, as far apart as it lies off
    /// their planes, and turned a little.
    pub fn set_slack(&mut self, face: &FlatFace) {
        let corners = self.mesh.face_positions(face.face);
        let least = rounding(&corners);
        let off = |i: usize| {
            let corner = corners[i % corners.len()] - face.frame.origin;
            corner.dot(face.frame.normal).abs()
        };
        for (i, &h) in face.half_edges.iter().enumerate() {
            let off = off(i).max(off(i + 1));
            if off > least {
                let turned = self.thickness[face.face] * TURNED / face.length(i);
                self.slack[h] = off * (1.0 + turned);
            }
        }
    }

    /// Whether the face of a half-edge is not planar there.
    pub fn is_bent(&self, h: HalfEdgeId) -> bool {
        self.slack[h] > 0.0 || self.slack[self.mesh.prev(h)] > 0.0
    }

    /// Takes fingers or a butt joint away. Corners are whole again, since they were cut off for the
    /// plates as they were.
    pub fn fall_back(&mut self, e: EdgeId, why: EdgeFallback) {
        self.kinds[e] = (fallen(self.params.shallow), Some((self.kinds[e].0, why)));
        for h in self.levelled.drain(..) {
            self.levels[h] = None;
        }
    }

    /// Cuts the corner at the origin of `h` off, if it is not cut deeper already.
    pub fn cut_corner(&mut self, h: HalfEdgeId, level: f64) {
        let deepest = self.levels[h].map_or(level, |known| known.max(level));
        self.levels[h] = Some(deepest);
        self.levelled.push(h);
    }

    /// How deep the corner at the origin of `h` is cut off, if it is.
    pub fn level(&self, h: HalfEdgeId) -> Option<f64> {
        self.levels[h]
    }

    pub fn kind(&self, e: EdgeId) -> EdgeKind {
        self.kinds[e].0
    }

    /// Whether an edge could be mitred instead: it has fingers or a butt joint.
    pub fn is_special(&self, e: EdgeId) -> bool {
        matches!(self.kind(e), EdgeKind::Butt | EdgeKind::Finger)
    }

    /// The offsets of front and back of a face's plate, all thicknesses taken `scale` times.
    pub fn offsets(&self, f: FaceId, scale: f64) -> [f64; 2] {
        self.params.side.offsets().map(|o| o * self.thickness[f] * scale)
    }

    /// The inset of the plate on the left of `h`, all thicknesses taken `scale` times.
    pub fn inset(&self, h: HalfEdgeId, scale: f64) -> Inset {
        self.inset_with_gap(h, scale, self.params.gap.mm())
    }

    /// Sides in a line are moved alike, as far as the innermost of them: else one of them would
    /// have to run slanted, into its neighbour.
    pub fn inset_with_gap(&self, h: HalfEdgeId, scale: f64, gap: f64) -> Inset {
        let mut inset = self.own_inset(h, scale, gap);
        let mut deepen = |other: Inset| {
            inset.front = inset.front.max(other.front);
            inset.back = inset.back.max(other.back);
        };
        let mut at = h;
        while self.straight[at] && self.mesh.prev(at) != h {
            at = self.mesh.prev(at);
            deepen(self.own_inset(at, scale, gap));
        }
        at = self.mesh.next(h);
        while self.straight[at] && at != h {
            deepen(self.own_inset(at, scale, gap));
            at = self.mesh.next(at);
        }
        inset
    }

    /// The inset that the edge of a side asks for.
    pub fn own_inset(&self, h: HalfEdgeId, scale: f64, gap: f64) -> Inset {
        let inset = self.joint_inset(h, scale, gap);
        let slack = self.slack[h];
        if slack == 0.0 {
            return inset;
        }
        // Square to the cut, in a plane that is slanted as the cut is.
        let slope = (inset.back - inset.front) / (self.thickness[self.mesh.face(h)] * scale);
        let back_off = slack * if slope.is_finite() { slope.hypot(1.0) } else { 1.0 };
        Inset {
            front: inset.front + back_off,
            back: inset.back + back_off,
            tip: inset.tip.map(|tip| tip + back_off),
        }
    }

    fn joint_inset(&self, h: HalfEdgeId, scale: f64, gap: f64) -> Inset {
        let own = self.offsets(self.mesh.face(h), scale);
        let Some(fold) = self.folds[h.edge()] else {
            return self.styled(self.rim(h, own));
        };
        let across = Across { fold, own, other: self.offsets(self.mesh.face(h.twin()), scale) };
        match self.kinds[h.edge()].0 {
            EdgeKind::Mitre | EdgeKind::Stitch => self.styled(across.mitre(gap)),
            EdgeKind::Hinge => squared(across.mitre(gap)),
            EdgeKind::Butt if self.mesh.face(h) < self.mesh.face(h.twin()) => {
                self.styled(across.through())
            }
            EdgeKind::Butt => self.styled(across.stopped(gap)),
            EdgeKind::Finger => across.finger(),
        }
    }

    fn styled(&self, inset: Inset) -> Inset {
        match self.params.cutting {
            CutStyle::Bevel => inset,
            CutStyle::Square => squared(inset),
        }
    }

    fn rim(&self, h: HalfEdgeId, own: [f64; 2]) -> Inset {
        let mesh = self.mesh;
        let square = Inset::default();
        let along = mesh.position(mesh.target(h)) - mesh.position(mesh.origin(h));
        let direction = match self.params.rim {
            RimCut::Square => return square,
            RimCut::Plumb => DVec3::Z,
            RimCut::Bisected => match self.rims[mesh.face(h.twin())] {
                Some(normal) => normal.cross(along),
                None => return square,
            },
        };
        let Some((normal, along)) =
            mesh.plane(mesh.face(h)).map(|p| p.normal()).zip(along.try_normalize())
        else {
            return square;
        };
        let (up, out) = (direction.dot(normal), direction.dot(along.cross(normal)));
        if out.abs() > up.abs() * STEEPEST_RIM.to_radians().tan() {
            return square;
        }
        let slope = out / up;
        let [front, back] = own.map(|o| -o * slope);
        if slope.is_finite() { Inset { front, back, tip: None } } else { square }
    }

    /// Everything about an edge.
    pub fn edge_cut(&self, e: EdgeId) -> EdgeCut {
        let sides = e.half_edges();
        let insets =
            sides.map(|h| (!self.mesh.is_hole(self.mesh.face(h))).then(|| self.inset(h, 1.0)));
        let (kind, fallback) = self.kinds[e];
        let across = self.folds[e].map(|fold| {
            let [own, other] = sides.map(|h| self.offsets(self.mesh.face(h), 1.0));
            Across { fold, own, other }
        });
        let is_open = !matches!(kind, EdgeKind::Butt | EdgeKind::Finger);
        let opening = across.as_ref().zip(insets[0].zip(insets[1])).filter(|_| is_open);
        EdgeCut {
            edge: e,
            fold: self.folds[e],
            kind,
            fallback,
            insets,
            opening: opening.map(|(across, (a, b))| across.opening(a, b)),
            is_stepped: across.is_some_and(|a| a.is_stepped()) && is_open,
        }
    }
}

/// The rounding that points may carry, in mm.
pub(super) fn rounding(points: &[DVec3]) -> f64 {
    let (low, high) = points
        .iter()
        .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
    RoundingBound::of_box(low, high).length()
}

fn fallen(shallow: Shallow) -> EdgeKind {
    match shallow {
        Shallow::Mitre => EdgeKind::Mitre,
        Shallow::Stitch => EdgeKind::Stitch,
    }
}

/// The kind of an edge as of the rules, or what it falls back to.
fn kind_of(dihedral: f64, params: &PanelParams) -> (EdgeKind, Option<(EdgeKind, EdgeFallback)>) {
    let kind = params.edges.kind(dihedral);
    let [sharpest, flattest] = match kind {
        EdgeKind::Finger => FINGER_ANGLES,
        EdgeKind::Butt => BUTT_ANGLES,
        _ => return (kind, None),
    };
    // A concave edge is a convex one seen from behind.
    let seen = if dihedral > 180.0 { 360.0 - dihedral } else { dihedral };
    match seen {
        s if s > flattest => (fallen(params.shallow), Some((kind, EdgeFallback::Shallow))),
        s if s < sharpest => (fallen(params.shallow), Some((kind, EdgeFallback::Sharp))),
        _ => (kind, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shallow_and_sharp_edges_fall_back() {
        let params = PanelParams {
            edges: EdgeKind::Finger.into(),
            shallow: Shallow::Stitch,
            ..PanelParams::default()
        };
        assert_eq!(kind_of(90.0, &params), (EdgeKind::Finger, None));
        assert_eq!(kind_of(270.0, &params), (EdgeKind::Finger, None));
        assert_eq!(
            kind_of(150.0, &params),
            (EdgeKind::Stitch, Some((EdgeKind::Finger, EdgeFallback::Shallow)))
        );
        assert_eq!(
            kind_of(20.0, &params),
            (EdgeKind::Stitch, Some((EdgeKind::Finger, EdgeFallback::Sharp)))
        );
        assert_eq!(
            kind_of(200.0, &params),
            (EdgeKind::Stitch, Some((EdgeKind::Finger, EdgeFallback::Shallow)))
        );
    }
}
