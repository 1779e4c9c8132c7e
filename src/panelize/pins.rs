//! Panels whose planes are given: where they are, and that their planes can meet.
//!
//! A given plane is that of one panel, where the surface fits it best; a flat group of faces is one
//! panel as large as it is. Their places are pinned before panels are laid out around them, and
//! their planes are no unknowns.

use glam::DVec3;

use super::curvature::Quadric;
use super::refine::{Triangles, edge};
use super::regions::Panels;
use super::solve::FacePlane;
use super::surface::{NONE, PANEL_AREA, Pins, Surface};
use super::{FixChoice, FixedPlane, PanelizeError};
use crate::geom::{AxisBox, BoxTree, Grid, Plane, meet_planes_near, nearest_on_triangle};
use crate::mesh::Mesh;

/// A panel on a plane leaves the surface by at most this where it fits best, in panel sizes: its
/// distance, and half a panel's way along its tilt.
const MOST_OFF: f64 = 0.2;
/// Places that fit hardly worse than the best count as it: the panel is laid in their middle.
const ALIKE: f64 = 0.01;
/// Panels with given planes are at least so far apart.
const LEAST_APART: f64 = 0.62;
/// A group is flat when its corners are within this of its plane.
const FLAT: f64 = 1e-3;
/// Triangles of the fine surface this near to a group belong to it.
const NEAR_GROUP: f64 = 0.01;
/// Smaller groups are no panels, over the area of one.
const LEAST_GROUP: f64 = 0.2;
/// No other panel has its middle nearer to a group.
const SHADOW: f64 = 0.4;
/// Given planes meet at most so far from where their panels do.
const MEET: f64 = 0.6;

/// What asked for a plane.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Asked {
    Line(usize),
    Group(String),
}

impl std::fmt::Display for Asked {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Line(line) => write!(f, "line {line}"),
            Self::Group(name) => write!(f, "group `{name}`"),
        }
    }
}

/// A panel whose plane is given.
#[derive(Debug, Clone)]
pub(super) struct Pin {
    pub asked: Asked,
    /// In mm.
    pub given: Plane,
    /// In panel sizes, seen from the origin.
    pub plane: Plane,
    site: usize,
    /// Of a group: its vertices, and its area over that of a panel.
    members: Vec<usize>,
    pub area: Option<f64>,
}

impl Pin {
    /// Its plane for the solver.
    pub(super) fn face_plane(&self) -> FacePlane {
        FacePlane { normal: self.plane.normal(), point: self.plane.point() }
    }

    /// Whether it is a group of faces whose middle is at a vertex of the surface.
    pub(super) fn is_group_at(&self, v: usize) -> bool {
        self.area.is_some() && self.site == v
    }
}

/// The flat groups of faces of the input, by its triangles.
pub(super) struct Groups<'a> {
    mesh: &'a Mesh,
    /// The triangles of faces in groups that are asked for: their corners in mm, and the face.
    triangles: Vec<([DVec3; 3], crate::mesh::FaceId)>,
}

impl<'a> Groups<'a> {
    /// The groups that are asked for.
    ///
    /// # Errors
    /// A group that there is not.
    pub(super) fn new(
        mesh: &'a Mesh,
        given: &Triangles,
        fix: &FixChoice,
    ) -> Result<Self, PanelizeError> {
        let is_asked = |name: &str| match fix {
            FixChoice::Groups => true,
            FixChoice::Group(asked) => asked == name,
            _ => false,
        };
        let mut corners = given.corners.iter();
        let mut triangles = Vec::new();
        for f in mesh.faces() {
            // A polygon has two triangles fewer than corners.
            let own = corners.by_ref().take(mesh.face_vertices(f).count() - 2);
            let own: Vec<_> = own.map(|t| (t.map(|v| given.points[v]), f)).collect();
            if mesh.group(f).is_some_and(is_asked) {
                triangles.extend(own);
            }
        }
        if let (FixChoice::Group(name), true) = (fix, triangles.is_empty()) {
            let names: Vec<String> = mesh.groups().iter().map(|g| format!("`{g}`")).collect();
            let what = match names.is_empty() {
                true => "the surface has no groups of faces".to_owned(),
                false => format!("there is none of that name, but {}", names.join(", ")),
            };
            return Err(PanelizeError::BadGroup { name: name.clone(), what });
        }
        if *fix == FixChoice::Groups && triangles.is_empty() {
            let what = "the surface has no groups of faces".to_owned();
            return Err(PanelizeError::BadGroup { name: "*".to_owned(), what });
        }
        Ok(Self { mesh, triangles })
    }

    /// The panels that the flat parts of groups are; and in words which are not.
    ///
    /// # Errors
    /// Of a group that is asked for by name, what is in the way.
    pub(super) fn pins(
        &self,
        surface: &Surface,
        (size, origin): (f64, DVec3),
        fix: &FixChoice,
    ) -> Result<(Vec<Pin>, Vec<String>), PanelizeError> {
        let (mut pins, mut notes) = (Vec::new(), Vec::new());
        for part in self.parts(surface, (size, origin)) {
            let name = self.mesh.group(part.face).unwrap_or_default().to_owned();
            match part.pin(surface, &name, self.mesh, (size, origin)) {
                Ok(pin) => pins.push(pin),
                Err(what) if matches!(fix, FixChoice::Group(_)) => {
                    return Err(PanelizeError::BadGroup { name, what });
                }
                Err(what) => notes.push(format!("group `{name}` does not stay one panel: {what}")),
            }
        }
        notes.dedup();
        Ok((pins, notes))
    }

    /// The connected parts of groups on the fine surface.
    fn parts(&self, surface: &Surface, (size, origin): (f64, DVec3)) -> Vec<Part> {
        let scaled = |t: &[DVec3; 3]| t.map(|p| (p - origin) / size);
        let scaled: Vec<[DVec3; 3]> = self.triangles.iter().map(|(t, _)| scaled(t)).collect();
        let boxes: Vec<AxisBox> = scaled.iter().filter_map(|t| AxisBox::of(*t)).collect();
        let tree = BoxTree::new(&boxes);
        let place = |t: &[usize; 3]| t.iter().map(|&v| surface.points[v]).sum::<DVec3>() / 3.0;
        let face_of = |t: &[usize; 3]| {
            let p = place(t);
            let found = tree.nearest(p, |i| nearest_on_triangle(p, scaled[i]).distance(p));
            found.filter(|(_, off)| *off < NEAR_GROUP).map(|(i, _)| self.triangles[i].1)
        };
        let faces: Vec<_> = surface.triangles.iter().map(face_of).collect();
        let group = |t: usize| faces[t].and_then(|f| self.mesh.group(f));
        let mut across = std::collections::BTreeMap::new();
        for (t, &[a, b, c]) in surface.triangles.iter().enumerate() {
            for [u, v] in [[a, b], [b, c], [c, a]] {
                across.entry(edge(u, v)).or_insert_with(Vec::new).push(t);
            }
        }
        let mut seen = vec![false; faces.len()];
        let mut parts = Vec::new();
        for start in 0..faces.len() {
            let Some(face) = faces[start].filter(|_| !seen[start]) else { continue };
            let mut triangles = Vec::new();
            let mut open = vec![start];
            seen[start] = true;
            while let Some(t) = open.pop() {
                triangles.push(t);
                let [a, b, c] = surface.triangles[t];
                for side in [edge(a, b), edge(b, c), edge(c, a)] {
                    for &u in across.get(&side).into_iter().flatten() {
                        if !seen[u] && group(u) == group(start) {
                            seen[u] = true;
                            open.push(u);
                        }
                    }
                }
            }
            let all = triangles.iter().filter_map(|&t| faces[t]);
            let area = |f| crate::measure::face_area(self.mesh, f);
            let largest = all.max_by(|&f, &g| area(f).total_cmp(&area(g)).then(g.cmp(&f)));
            parts.push(Part { triangles, face: largest.unwrap_or(face) });
        }
        parts
    }
}

/// A connected part of a group: its triangles, and its largest face.
struct Part {
    triangles: Vec<usize>,
    face: crate::mesh::FaceId,
}

impl Part {
    /// The panel that it is; or what is in the way, in words.
    fn pin(
        &self,
        surface: &Surface,
        name: &str,
        mesh: &Mesh,
        (size, origin): (f64, DVec3),
    ) -> Result<Pin, String> {
        let corners = mesh.face_positions(self.face);
        let given = mesh.carried_plane(self.face).or_else(|| Plane::newell(&corners));
        let given = given.ok_or_else(|| "its largest face has no area".to_owned())?;
        let plane = scaled(&given, size, origin);
        let mut members: Vec<usize> =
            self.triangles.iter().flat_map(|&t| surface.triangles[t]).collect();
        members.sort_unstable();
        members.dedup();
        let off = |&v: &usize| plane.signed_distance(surface.points[v]).abs();
        let off = members.iter().map(off).fold(0.0, f64::max);
        if off > FLAT {
            return Err(format!(
                "it is not flat, a corner is {:.3} mm off its largest face ({:.3} mm are allowed)",
                off * size,
                FLAT * size
            ));
        }
        let area = |&t: &usize| {
            let [a, b, c] = surface.triangles[t].map(|v| surface.points[v]);
            (b - a).cross(c - a).length() / 2.0
        };
        let area = self.triangles.iter().map(area).sum::<f64>() / PANEL_AREA;
        if area < LEAST_GROUP {
            return Err(format!(
                "it is {area:.2} times as large as a panel, and less than {LEAST_GROUP} is none"
            ));
        }
        let middle = members.iter().map(|&v| surface.points[v]).sum::<DVec3>();
        let site = nearest_of(surface, &members, middle / members.len() as f64);
        let asked = Asked::Group(name.to_owned());
        Ok(Pin { asked, given, plane, site, members, area: Some(area) })
    }
}

/// The panels of given planes, each where the surface fits it best.
///
/// # Errors
/// A plane that fits nowhere; two that ask for one panel.
pub(super) fn pins_of_planes(
    surface: &Surface,
    quadrics: &[Quadric],
    planes: &[FixedPlane],
    (size, origin): (f64, DVec3),
) -> Result<Vec<Pin>, PanelizeError> {
    let mut pins: Vec<Pin> = Vec::new();
    for fixed in planes {
        let length = fixed.normal.length();
        let point = fixed.normal * (fixed.offset / length / length);
        let Some(given) = Plane::new(fixed.normal, point) else { continue };
        let plane = scaled(&given, size, origin);
        let apart = |v: usize| plane.signed_distance(surface.points[v]).abs();
        let tilt = |v: usize| plane.normal().cross(quadrics[v].normal).length();
        let off: Vec<f64> = (0..quadrics.len()).map(|v| apart(v) + 0.5 * tilt(v)).collect();
        let least = off.iter().copied().fold(f64::INFINITY, f64::min);
        let best: Vec<usize> = (0..off.len()).filter(|&v| off[v] <= least + ALIKE).collect();
        // Of several places that fit alike the one around the best.
        let first = best.iter().copied().min_by(|&a, &b| off[a].total_cmp(&off[b]));
        let around = first.map_or(DVec3::ZERO, |v| surface.points[v]);
        let near: Vec<usize> =
            best.into_iter().filter(|&v| surface.points[v].distance(around) < 1.0).collect();
        let middle = near.iter().map(|&v| surface.points[v]).sum::<DVec3>() / near.len() as f64;
        let site = nearest_of(surface, &near, middle);
        let place = surface.points[site];
        if least > MOST_OFF {
            return Err(PanelizeError::NoPlaneThere {
                line: fixed.line,
                distance_mm: apart(site) * size,
                degrees: tilt(site).min(1.0).asin().to_degrees(),
                place: place * size + origin,
                allowed_mm: MOST_OFF * size,
            });
        }
        for pin in &pins {
            let distance = surface.points[pin.site].distance(place);
            let Asked::Line(other) = pin.asked else { continue };
            if distance < LEAST_APART {
                return Err(PanelizeError::PlanesTooNear {
                    lines: [other, fixed.line],
                    distance_mm: distance * size,
                    place: place * size + origin,
                });
            }
        }
        let asked = Asked::Line(fixed.line);
        pins.push(Pin { asked, given, plane, site, members: Vec::new(), area: None });
    }
    Ok(pins)
}

/// A plane in panel sizes, seen from the origin.
fn scaled(given: &Plane, size: f64, origin: DVec3) -> Plane {
    let off = given.signed_distance(origin);
    Plane::new(given.normal(), given.normal() * (-off / size)).unwrap_or(*given)
}

fn nearest_of(surface: &Surface, some: &[usize], place: DVec3) -> usize {
    let off = |v: usize| surface.points[v].distance_squared(place);
    let nearest = some.iter().copied().min_by(|&a, &b| off(a).total_cmp(&off(b)).then(a.cmp(&b)));
    nearest.unwrap_or(0)
}

/// The places of pins for the layout.
pub(super) fn pinned(surface: &Surface, pins: &[Pin]) -> Pins {
    if pins.is_empty() {
        return Pins::default();
    }
    let count = surface.points.len();
    let (mut owners, mut is_shadow) = (vec![NONE; count], vec![false; count]);
    let mut grid = Grid::new([0.0; 3], SHADOW);
    let mut members = Vec::new();
    for (k, pin) in pins.iter().enumerate() {
        for &v in &pin.members {
            owners[v] = k;
            grid.insert(surface.points[v].to_array());
            members.push(v);
        }
    }
    for (v, shadow) in is_shadow.iter_mut().enumerate() {
        let place = surface.points[v];
        *shadow = grid.around(place.to_array()).any(|k| {
            let u = members[k as usize];
            surface.points[u].distance(place) < SHADOW && !surface.creases.are_apart(u, v)
        });
    }
    let areas = pins.iter().map(|pin| pin.area).collect();
    Pins { sites: pins.iter().map(|pin| pin.site).collect(), owners, is_shadow, areas }
}

/// That given planes meet near where their panels do.
///
/// # Errors
/// The first corner, in mm, near which they do not.
pub(super) fn check_meetings(
    panels: &Panels,
    pins: &[Pin],
    (size, origin): (f64, DVec3),
) -> Result<(), PanelizeError> {
    for (v, fan) in panels.fans().into_iter().enumerate() {
        let fixed: Vec<&Pin> = fan.iter().filter_map(|&f| pins.get(f)).collect();
        if fixed.len() < 2 {
            continue;
        }
        let near = panels.points[v];
        let planes: Vec<Plane> = fixed.iter().map(|pin| pin.plane).collect();
        let (met, lack) = meet_planes_near(&planes, near);
        let off = met.distance(near);
        if lack > 1e-9 || off > MEET {
            return Err(PanelizeError::PlanesDoNotMeet {
                asked: fixed.iter().map(|pin| pin.asked.to_string()).collect(),
                place: near * size + origin,
                distance_mm: (lack <= 1e-9).then_some(off * size),
                allowed_mm: MEET * size,
            });
        }
    }
    Ok(())
}
