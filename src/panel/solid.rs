//! A plate as a body of flat faces, for 3D files.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::error::PanelError;
use super::plate::{Hole, Plate};
use crate::geom::{Frame, Plane, triangulate_contours};

/// Sides of the polygon that stands for a round hole; its corners lie on the circle.
const ROUND: usize = 24;

/// A closed body.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Solid {
    /// Its corners.
    pub points: Vec<DVec3>,
    /// Its faces: front, back, sides, then the walls of holes.
    pub faces: Vec<SolidFace>,
}

/// A flat face of a body: seen from outside the outline runs counter-clockwise, holes run
/// clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidFace {
    /// Which one it is.
    pub side: SolidSide,
    /// Its corners.
    pub outline: Vec<u32>,
    /// The corners of its holes.
    pub holes: Vec<Vec<u32>>,
    /// Its outward unit normal.
    pub normal: DVec3,
    /// The face in triangles, counter-clockwise from outside.
    pub triangles: Vec<[u32; 3]>,
    /// Whether the outline is convex and without holes.
    pub is_convex: bool,
}

/// The place of a face on a plate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum SolidSide {
    /// The outer face.
    Front,
    /// The inner face.
    Back,
    /// Along an edge, a relieved corner or a finger.
    Cut,
    /// Inside a hole.
    Bore,
}

/// The body of a plate. Round holes become polygons of 24 sides.
///
/// # Errors
/// [`PanelError::OpenBody`] when the triangles of its faces do not close: every edge must be met
/// exactly once in each direction.
pub fn solid(plate: &Plate) -> Result<Solid, PanelError> {
    let mut solid = Solid::default();
    let n = plate.front.len();
    let mut front: Loops = vec![solid.add(plate, &plate.front, Plate::on_front)];
    let mut back: Loops = vec![solid.add(plate, &plate.back, Plate::on_back)];
    let mut walls: Vec<[u32; 4]> = (0..n).map(|i| wall([&front[0], &back[0]], i)).collect();
    for hole in &plate.holes {
        let circle = circle(hole);
        let rings =
            [solid.add(plate, &circle, Plate::on_front), solid.add(plate, &circle, Plate::on_back)];
        // Seen from inside the hole.
        walls.extend((0..ROUND).map(|i| wall([&rings[1], &rings[0]], i)));
        let [on_front, on_back] = rings;
        front.push(on_front.into_iter().rev().collect());
        back.push(on_back);
    }
    back[0].reverse();
    let normal = plate.frame.normal;
    let caps =
        [solid.face(SolidSide::Front, front, normal), solid.face(SolidSide::Back, back, -normal)];
    solid.faces.extend(caps);
    for (i, corners) in walls.into_iter().enumerate() {
        let side = if i < n { SolidSide::Cut } else { SolidSide::Bore };
        let [a, b, c, d] = corners.map(|k| solid.points[k as usize]);
        let Some(normal) = (c - a).cross(d - b).try_normalize() else { continue };
        let face = solid.face(side, vec![corners.to_vec()], normal);
        solid.faces.push(face);
    }
    match solid.open_edges() {
        0 => Ok(solid),
        edges => Err(PanelError::OpenBody { face: plate.face, edges }),
    }
}

/// The outline of a face, then its holes, as corners of a body.
type Loops = Vec<Vec<u32>>;

/// The four corners of the wall along side `i` of a ring and of its image on the other side of the
/// plate.
fn wall([upper, lower]: [&Vec<u32>; 2], i: usize) -> [u32; 4] {
    let j = (i + 1) % upper.len();
    [lower[i], lower[j], upper[j], upper[i]]
}

/// The corners of a hole, counter-clockwise from outside.
fn circle(hole: &Hole) -> Vec<DVec2> {
    let angle = |i: usize| i as f64 * std::f64::consts::TAU / ROUND as f64;
    (0..ROUND).map(|i| hole.centre + hole.radius * DVec2::from_angle(angle(i))).collect()
}

impl Solid {
    /// Adds a ring of corners; gives their numbers.
    fn add(&mut self, plate: &Plate, ring: &[DVec2], lift: fn(&Plate, DVec2) -> DVec3) -> Vec<u32> {
        let first = self.points.len() as u32;
        self.points.extend(ring.iter().map(|&p| lift(plate, p)));
        (first..self.points.len() as u32).collect()
    }

    /// A face in triangles; without any where it cannot be cut into triangles between its corners,
    /// so that the body does not close.
    fn face(&self, side: SolidSide, mut loops: Loops, normal: DVec3) -> SolidFace {
        let contours = self.flat(&loops, normal);
        let is_convex = matches!(contours.as_slice(), [outline] if is_convex(outline));
        let corners = loops.concat();
        let triangles = match corners[..] {
            [a, b, c, d] if is_convex => vec![[a, b, c], [a, c, d]],
            _ => {
                let found = triangulate_contours(&contours).unwrap_or_default();
                found.into_iter().map(|t| t.map(|i| corners[i])).collect()
            }
        };
        let holes = loops.split_off(1);
        SolidFace { side, outline: loops.concat(), holes, normal, triangles, is_convex }
    }

    /// Loops in the frame of their plane.
    fn flat(&self, loops: &Loops, normal: DVec3) -> Vec<Vec<DVec2>> {
        let first = self.points[loops[0][0] as usize];
        let Some(plane) = Plane::new(normal, first) else { return Vec::new() };
        let frame = Frame::on_plane(&plane);
        let flatten =
            |l: &Vec<u32>| l.iter().map(|&i| frame.flatten(self.points[i as usize])).collect();
        loops.iter().map(flatten).collect()
    }

    /// How many directed edges of the triangles are not met exactly once, or not exactly once the
    /// other way.
    fn open_edges(&self) -> usize {
        let mut count: BTreeMap<(u32, u32), usize> = BTreeMap::new();
        for [a, b, c] in self.faces.iter().flat_map(|face| &face.triangles).copied() {
            for edge in [(a, b), (b, c), (c, a)] {
                *count.entry(edge).or_default() += 1;
            }
        }
        let is_once = |edge: (u32, u32)| count.get(&edge) == Some(&1);
        let is_open = |&&(a, b): &&(u32, u32)| !is_once((a, b)) || !is_once((b, a));
        let empty = self.faces.iter().filter(|face| face.triangles.is_empty()).count();
        count.keys().filter(is_open).count() + empty
    }

    /// The volume that its faces enclose, in mm³.
    pub fn volume(&self) -> f64 {
        let Some(&centre) = self.points.first() else { return 0.0 };
        let loops = self.faces.iter().flat_map(|f| std::iter::once(&f.outline).chain(&f.holes));
        let cone = |corners: &Vec<u32>| {
            let p = |i: usize| self.points[corners[i] as usize] - centre;
            (2..corners.len()).map(|i| p(0).dot(p(i - 1).cross(p(i)))).sum::<f64>()
        };
        loops.map(cone).sum::<f64>() / 6.0
    }
}

/// Whether a polygon turns left at all corners, or not at all.
fn is_convex(outline: &[DVec2]) -> bool {
    let n = outline.len();
    (0..n).all(|i| {
        let [a, b, c] = [i, i + 1, i + 2].map(|k| outline[k % n]);
        (b - a).perp_dot(c - b) >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geom::Frame;
    use crate::mesh::{EdgeId, FaceId};

    /// A plate with teeth whose roots stand in a line up to rounding, and two holes.
    fn toothed() -> Plate {
        let turn = DVec2::from_angle(0.3);
        let mut outline = vec![(0.0, 0.0), (90.0, 0.0), (90.0, 40.0)];
        for k in (0..8).rev() {
            let x = f64::from(k) * 10.0;
            outline.extend([(x + 10.0, 50.0), (x + 10.0, 55.0), (x + 5.0, 55.0), (x + 5.0, 50.0)]);
        }
        let outline: Vec<DVec2> = outline.iter().map(|&p| turn.rotate(DVec2::from(p))).collect();
        let hole = |x: f64| Hole {
            centre: turn.rotate(DVec2::new(x, 20.0)),
            radius: 4.0,
            edge: EdgeId::new(0),
        };
        Plate {
            face: FaceId::new(3),
            thickness: 2.0,
            frame: Frame { origin: DVec3::ZERO, x: DVec3::X, y: DVec3::Y, normal: DVec3::Z },
            half_edges: vec![],
            reference: vec![],
            front: outline.clone(),
            back: outline.clone(),
            blank: outline.clone(),
            inner: outline,
            begins: vec![],
            ends: vec![],
            holes: vec![hole(20.0), hole(70.0)],
        }
    }

    #[test]
    fn holes_stay_beside_roots_that_stand_in_a_line_up_to_rounding() {
        let plate = toothed();
        let solid = solid(&plate).expect("closed");
        let of_triangles: f64 = solid.faces[0]
            .triangles
            .iter()
            .map(|t| t.map(|i| solid.points[i as usize]))
            .map(|[a, b, c]| (b - a).cross(c - a).dot(plate.frame.normal) / 2.0)
            .sum();
        let circle = 24.0 / 2.0 * (std::f64::consts::TAU / 24.0).sin() * 16.0;
        let expected = crate::geom::polygon::signed_area(&plate.front) - 2.0 * circle;
        assert!((of_triangles - expected).abs() < 1e-9, "{of_triangles} instead of {expected}");
        assert!((solid.volume() - 2.0 * expected).abs() < 1e-9);
    }

    #[test]
    fn a_body_that_does_not_close_is_an_error_and_no_file() {
        let mut bow_tie = toothed();
        bow_tie.holes.clear();
        bow_tie.front.swap(0, 1);
        let error = solid(&bow_tie).expect_err("the front crosses itself");
        assert!(matches!(error, PanelError::OpenBody { face, .. } if face == FaceId::new(3)));
        let mut pinched = toothed();
        let first = pinched.front[0];
        (pinched.front[1], pinched.back[1]) = (first, pinched.back[0]);
        assert!(solid(&pinched).is_err(), "a wall without area");
        let mut touching = toothed();
        touching.holes[1].centre = touching.holes[0].centre;
        assert!(solid(&touching).is_err(), "two holes in one place");
    }
}
