//! What happens at the edges: how far the sides of a plate move in from the edge, at its front and
//! at its back.
//!
//! Looked at along the edge, a plate is a strip between its back and front offsets, and its
//! neighbour the same strip turned by the fold angle φ. With n its normal and u the direction out
//! of it, square to the edge, a point is o·n + s·u; the neighbour's normal is n·cos φ + u·sin φ.
//! All joints are lines s(o) in that picture; the *inset* is −s.

use glam::DVec3;

use super::error::PanelError;
use super::params::{CutStyle, PanelParams, RimCut, Shallow};
use super::rule::EdgeKind;
use crate::geom::Plane;
use crate::measure::fold_angle;
use crate::mesh::{EdgeId, EdgeMap, FaceId, FaceMap, HalfEdgeId, Mesh};

/// Mitres steeper than this are knife edges: the dihedral angle is below 1°.
const KNIFE: f64 = 89.5;

/// Cuts of rims are no steeper than this, in degrees off square; the rim is cut square instead.
const STEEPEST_RIM: f64 = 60.0;

/// Mitres between plates of different thickness are no steeper than this, in degrees off square;
/// where the edge is so flat that they would be, the mitre bisects the angle and the surfaces step.
const STEEPEST: f64 = 80.0;

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
}

impl EdgeFallback {
    /// The word in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shallow => "shallow",
            Self::Sharp => "sharp",
            Self::Short => "short",
            Self::Narrow => "narrow",
        }
    }
}

/// How far a side of a plate lies inside of the edge, in mm; negative outside.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Inset {
    /// In the front plane.
    pub front: f64,
    /// In the back plane.
    pub back: f64,
    /// Of the ends of fingers, where there are any; front and back are then their roots.
    pub tip: Option<f64>,
}

impl Inset {
    /// How far inside the side is at the innermost of front and back.
    pub fn inner(&self) -> f64 {
        self.front.max(self.back)
    }

    /// The same at the outermost: the long point, where glass is measured.
    pub fn outer(&self) -> f64 {
        self.front.min(self.back)
    }

    /// The angle of the cut off square in radians: positive where the front is longer, negative
    /// where the back is.
    pub fn bevel(&self, thickness: f64) -> f64 {
        ((self.back - self.front) / thickness).atan()
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
}

/// The picture across an edge, seen from one of its plates.
struct Across {
    fold: f64,
    own: [f64; 2],
    other: [f64; 2],
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
        Ok(Self { mesh, params, thickness, folds, kinds, rims })
    }

    /// Takes fingers away.
    pub fn fall_back(&mut self, e: EdgeId, why: EdgeFallback) {
        self.kinds[e] = (fallen(self.params.shallow), Some((self.kinds[e].0, why)));
    }

    pub fn kind(&self, e: EdgeId) -> EdgeKind {
        self.kinds[e].0
    }

    /// The offsets of front and back of a face's plate, all thicknesses taken `scale` times.
    pub fn offsets(&self, f: FaceId, scale: f64) -> [f64; 2] {
        self.params.side.offsets().map(|o| o * self.thickness[f] * scale)
    }

    /// The inset of the plate on the left of `h`, all thicknesses taken `scale` times.
    pub fn inset(&self, h: HalfEdgeId, scale: f64) -> Inset {
        self.inset_with_gap(h, scale, self.params.gap.mm())
    }

    pub fn inset_with_gap(&self, h: HalfEdgeId, scale: f64, gap: f64) -> Inset {
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

/// Cut square where it is innermost.
fn squared(inset: Inset) -> Inset {
    let inner = inset.inner();
    Inset { front: inner, back: inner, tip: inset.tip }
}

impl Across {
    /// The slope ds/do of the plane in which the plates meet: through the lines where their fronts
    /// and their backs meet.
    fn slope(&self) -> f64 {
        let [t, u] = [self.own, self.other].map(|[front, back]| front - back);
        // Equal plates bisect the angle, whatever it is; so they do while all thicknesses shrink to
        // nothing.
        let exact = if t == u {
            (self.fold / 2.0).tan()
        } else {
            (u - t * self.fold.cos()) / (t * self.fold.sin())
        };
        if t != u && exact.abs() > STEEPEST.to_radians().tan() || !exact.is_finite() {
            (self.fold / 2.0).tan()
        } else {
            exact
        }
    }

    fn is_stepped(&self) -> bool {
        let [t, u] = [self.own, self.other].map(|[front, back]| front - back);
        let exact = (u - t * self.fold.cos()) / (t * self.fold.sin());
        // At a flat edge this is 0/0, or a number over 0.
        t != u && (exact.is_nan() || exact.abs() > STEEPEST.to_radians().tan())
    }

    fn mitre(&self, gap: f64) -> Inset {
        let slope = self.slope();
        let back_off = gap / 2.0 * slope.hypot(1.0);
        let [front, back] = self.own.map(|o| back_off - o * slope);
        Inset { front, back, tip: None }
    }

    /// The same edge with concave turned into convex: seen from behind.
    fn convex_view(&self) -> Across {
        if self.fold >= 0.0 {
            return Across { fold: self.fold, own: self.own, other: self.other };
        }
        let mirrored = |[front, back]: [f64; 2]| [-back, -front];
        Across { fold: -self.fold, own: mirrored(self.own), other: mirrored(self.other) }
    }

    /// The inset at an offset of its own, of the neighbour's plane at its offset `p`.
    fn at_plane(&self, own: f64, p: f64) -> f64 {
        (own * self.fold.cos() - p) / self.fold.sin()
    }

    /// Puts values for the outer and inner offset of the convex view back to front and back.
    fn seen(&self, outer: f64, inner: f64) -> Inset {
        let (front, back) = if self.fold >= 0.0 { (outer, inner) } else { (inner, outer) };
        Inset { front, back, tip: None }
    }

    /// Of a butt joint, the plate that runs through to the outer side of the other.
    fn through(&self) -> Inset {
        let view = self.convex_view();
        let [outer, inner] = view.own.map(|o| view.at_plane(o, view.other[0]));
        self.seen(outer, inner)
    }

    /// Of a butt joint, the plate that stops at the inner side of the other.
    fn stopped(&self, gap: f64) -> Inset {
        let view = self.convex_view();
        let [outer, inner] = view.own.map(|o| view.at_plane(o, view.other[1] - gap));
        self.seen(outer, inner)
    }

    /// Fingers: the roots leave room for the slab of the neighbour, the tips are flush with its
    /// outer side.
    fn finger(&self) -> Inset {
        let view = self.convex_view();
        let inmost = |p: f64| {
            view.own.map(|o| view.at_plane(o, p)).into_iter().fold(f64::NEG_INFINITY, f64::max)
        };
        let [tip, root] = view.other.map(inmost);
        Inset { front: root, back: root, tip: Some(tip) }
    }

    /// The distances between the two plates at front and back.
    fn opening(&self, own: Inset, other: Inset) -> [f64; 2] {
        let (sin, cos) = self.fold.sin_cos();
        let distance = |(o, inset): (f64, f64), (p, across): (f64, f64)| {
            // The neighbour's point p·n' − inset'·u', with u' = −u·cos φ + n·sin φ.
            let (up, out) = (p * cos - across * sin - o, p * sin + across * cos + inset);
            up.hypot(out)
        };
        [
            distance((self.own[0], own.front), (self.other[0], other.front)),
            distance((self.own[1], own.back), (self.other[1], other.back)),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn across(fold: f64, own: [f64; 2], other: [f64; 2]) -> Across {
        Across { fold: fold.to_radians(), own, other }
    }

    #[test]
    fn equal_plates_bisect_and_open_square_cuts_by_twice_the_sine() {
        for fold in [-120.0_f64, -30.0, 0.0, 10.0, 90.0, 150.0] {
            let plates = across(fold, [0.0, -4.0], [0.0, -4.0]);
            let mitre = plates.mitre(0.0);
            assert!((mitre.bevel(4.0).to_degrees() - fold / 2.0).abs() < 1e-12, "{fold}");
            assert!(plates.opening(mitre, mitre).iter().all(|&d| d < 1e-12), "{fold}");
            let square = squared(mitre);
            let opening = plates.opening(square, square);
            let widest = opening[0].max(opening[1]);
            assert!(
                (widest - 8.0 * (fold.abs().to_radians() / 2.0).sin()).abs() < 1e-12,
                "{fold}: {opening:?}"
            );
            assert!(opening[0].min(opening[1]) < 1e-12);
        }
    }

    #[test]
    fn the_gap_is_measured_square_to_the_cut() {
        let plates = across(60.0, [3.0, 0.0], [3.0, 0.0]);
        let opening = plates.opening(plates.mitre(8.0), plates.mitre(8.0));
        assert!(opening.iter().all(|d| (d - 8.0).abs() < 1e-12), "{opening:?}");
    }

    #[test]
    fn unequal_plates_meet_on_the_lines_of_their_fronts_and_backs() {
        let (own, other) = ([2.0, -2.0], [5.0, -5.0]);
        let (here, there) = (across(100.0, own, other), across(100.0, other, own));
        let opening = here.opening(here.mitre(0.0), there.mitre(0.0));
        assert!(opening.iter().all(|&d| d < 1e-12), "{opening:?}");
        assert!(
            !here.is_stepped()
                && across(2.0, own, other).is_stepped()
                && across(0.0, own, other).is_stepped()
        );
    }

    #[test]
    fn a_right_angled_butt_and_finger_joint_take_the_thickness() {
        let (thick, thin) = ([0.0, -6.0], [0.0, -4.0]);
        let through = across(90.0, thick, thin).through();
        assert!(through.front.abs() < 1e-12 && through.back.abs() < 1e-12);
        let stopped = across(90.0, thin, thick).stopped(1.0);
        assert!((stopped.front - 7.0).abs() < 1e-12 && (stopped.back - 7.0).abs() < 1e-12);
        let finger = across(90.0, thin, thick).finger();
        assert!((finger.front - 6.0).abs() < 1e-12 && finger.tip.is_some_and(|t| t.abs() < 1e-12));
        // Seen from behind a concave edge is the same joint.
        let concave = across(-90.0, [4.0, 0.0], [6.0, 0.0]).finger();
        assert!(
            (concave.front - 6.0).abs() < 1e-12 && concave.tip.is_some_and(|t| t.abs() < 1e-12)
        );
    }

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
