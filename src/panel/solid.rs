//! A plate as a body of flat faces, for 3D files.

use glam::{DVec2, DVec3};

use super::plate::{Hole, Plate};

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
pub fn solid(plate: &Plate) -> Solid {
    let n = plate.front.len();
    let mut solid = Solid::default();
    let lifted = |points: &[DVec2]| points.iter().map(|&p| plate.on_front(p)).collect::<Vec<_>>();
    solid.points.extend(lifted(&plate.front));
    solid.points.extend(plate.back.iter().map(|&p| plate.on_back(p)));
    let ring = |start: usize, len: usize| (start..start + len).map(|i| i as u32);
    let normal = plate.frame.normal;
    let mut front = SolidFace {
        side: SolidSide::Front,
        outline: ring(0, n).collect(),
        holes: Vec::new(),
        normal,
    };
    let mut back = SolidFace {
        side: SolidSide::Back,
        outline: ring(n, n).rev().collect(),
        holes: Vec::new(),
        normal: -normal,
    };
    let mut walls = Vec::new();
    for i in 0..n {
        let j = (i + 1) % n;
        walls.extend(wall(&solid, [n + i, n + j, j, i], SolidSide::Cut));
    }
    for hole in &plate.holes {
        let circle = circle(hole);
        let start = solid.points.len();
        solid.points.extend(lifted(&circle));
        solid.points.extend(circle.iter().map(|&p| plate.on_back(p)));
        front.holes.push(ring(start, ROUND).rev().collect());
        back.holes.push(ring(start + ROUND, ROUND).collect());
        for i in 0..ROUND {
            let j = (i + 1) % ROUND;
            walls.extend(wall(
                &solid,
                [start + i, start + j, start + ROUND + j, start + ROUND + i],
                SolidSide::Bore,
            ));
        }
    }
    solid.faces.extend([front, back]);
    solid.faces.extend(walls);
    solid
}

/// The four corners of a wall as a face; `None` when they enclose no area.
fn wall(solid: &Solid, corners: [usize; 4], side: SolidSide) -> Option<SolidFace> {
    let [a, b, c, d] = corners.map(|i| solid.points[i]);
    let normal = (c - a).cross(d - b).try_normalize()?;
    Some(SolidFace { side, outline: corners.map(|i| i as u32).to_vec(), holes: Vec::new(), normal })
}

/// The corners of a hole, counter-clockwise from outside.
fn circle(hole: &Hole) -> Vec<DVec2> {
    let angle = |i: usize| i as f64 * std::f64::consts::TAU / ROUND as f64;
    (0..ROUND).map(|i| hole.centre + hole.radius * DVec2::from_angle(angle(i))).collect()
}

impl Solid {
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
