//! From an expression to the elements that fit: one table of marks per condition, so the work grows
//! with the mesh alone.

use std::cmp::Ordering;

use glam::DVec3;

use super::error::ElementKind::{self, Edge, Face, Vertex};
use super::error::SelectError;
use super::expr::{Atom, Compare, Expr};
use super::found::found;
use super::{Context, NewElements, seams};
use crate::geom::predicate::side_of_plane;
use crate::geom::{RoundingBound, Side};
use crate::measure::fold_angle;
use crate::mesh::{EdgeId, FaceId, Mesh, VertexId};
use crate::progress::Progress;
use crate::units::{Direction, nearest_word};

/// Measured angles carry rounding: two that differ by less, in degrees, count as equal. A hundred
/// times what a model a thousand sizes away from the origin shows.
const ANGLE_ROUNDING: f64 = 1e-6;

/// One mark per slot of the element's table; free slots and holes are never marked.
type Marks = Vec<bool>;

/// The numbers of the elements that fit, ascending; never empty.
pub(super) fn evaluate(
    expr: &Expr,
    context: &Context<'_>,
    kind: ElementKind,
) -> Result<Vec<usize>, SelectError> {
    let evaluation =
        Evaluation { mesh: context.mesh, made: context.made, progress: context.progress, kind };
    let marks = evaluation.expr(expr)?;
    let chosen: Vec<usize> = (0..marks.len()).filter(|&i| marks[i]).collect();
    if chosen.is_empty() {
        let found = found(expr, context.mesh);
        return Err(SelectError::Empty { selection: expr.to_string(), kind, found });
    }
    Ok(chosen)
}

/// The kinds of element that a condition can tell apart.
fn serves(atom: &Atom) -> &'static [ElementKind] {
    match atom {
        Atom::Sides(..) => &[Face],
        Atom::Fold(..) | Atom::Along(..) | Atom::Strip | Atom::Folds(_) => &[Edge],
        Atom::Normal(..) => &[Face, Vertex],
        _ => &[Vertex, Edge, Face],
    }
}

struct Evaluation<'a> {
    mesh: &'a Mesh,
    made: Option<&'a NewElements>,
    progress: &'a dyn Progress,
    kind: ElementKind,
}

impl Evaluation<'_> {
    fn expr(&self, expr: &Expr) -> Result<Marks, SelectError> {
        match expr {
            Expr::Atom(atom) => self.atom(atom),
            Expr::Not(inner) => {
                let marks = self.expr(inner)?;
                Ok(self.all().iter().zip(marks).map(|(&exists, mark)| exists && !mark).collect())
            }
            Expr::And(parts) => self.joined(parts, |a, b| a && b),
            Expr::Or(parts) => self.joined(parts, |a, b| a || b),
        }
    }

    fn joined(&self, parts: &[Expr], join: fn(bool, bool) -> bool) -> Result<Marks, SelectError> {
        let mut marks: Option<Marks> = None;
        for part in parts {
            let more = self.expr(part)?;
            marks = Some(match marks {
                Some(marks) => marks.iter().zip(more).map(|(&a, b)| join(a, b)).collect(),
                None => more,
            });
        }
        Ok(marks.expect("a chain has parts"))
    }

    fn atom(&self, atom: &Atom) -> Result<Marks, SelectError> {
        let mesh = self.mesh;
        let serves = serves(atom);
        if !serves.contains(&self.kind) {
            return Err(SelectError::WrongKind {
                atom: atom.to_string(),
                wanted: self.kind,
                serves,
            });
        }
        Ok(match *atom {
            Atom::All => self.all(),
            Atom::Ids(ref runs) => self.ids(runs)?,
            Atom::Valence(compare, n) => self.by_vertices(&vertices(mesh, |v| {
                compare.holds(mesh.valence(v).cmp(&(n as usize)))
            })),
            Atom::Sides(compare, n) => {
                faces(mesh, |f| compare.holds(mesh.sides(f).cmp(&(n as usize))))
            }
            Atom::Fold(compare, angle) => edges(mesh, |e| {
                let fold = fold_angle(mesh, e).map(|fold| fold.abs().to_degrees());
                fold.is_some_and(|fold| compare_angles(compare, fold, angle.degrees()))
            }),
            Atom::Along(direction, tolerance) => edges(mesh, |e| {
                let [a, b] = mesh.edge_positions(e);
                let angle = angle_between(b - a, direction.unit());
                is_within(angle.map(|angle| angle.min(180.0 - angle)), tolerance.degrees())
            }),
            Atom::Above(direction, height) => {
                self.by_vertices(&self.beyond(direction, height.mm()))
            }
            Atom::Below(direction, height) => {
                self.by_vertices(&self.beyond(direction.reversed(), -height.mm()))
            }
            Atom::Normal(direction, tolerance) => self.by_normals(|normal| {
                is_within(angle_between(normal, direction.unit()), tolerance.degrees())
            }),
            Atom::Group(ref name) => self.group(name)?,
            Atom::Made => {
                let made = self.made(atom)?;
                match self.kind {
                    Vertex => self.listed(made.vertices.iter().map(|v| v.index())),
                    Edge => self.listed(made.edges.iter().map(|e| e.index())),
                    Face => self.listed(made.faces.iter().map(|f| f.index())),
                }
            }
            Atom::Strip => self.listed(self.made(atom)?.strip.iter().map(|e| e.index())),
            Atom::Folds(which) => {
                let folds = seams::folds(mesh, which, self.progress);
                let folds = folds
                    .map_err(|source| SelectError::Seams { atom: atom.to_string(), source })?;
                self.listed(folds.iter().map(|e| e.index()))
            }
        })
    }

    /// What the last step made.
    fn made(&self, atom: &Atom) -> Result<&NewElements, SelectError> {
        self.made.ok_or_else(|| SelectError::NothingMade { atom: atom.to_string() })
    }

    fn all(&self) -> Marks {
        match self.kind {
            Vertex => vertices(self.mesh, |_| true),
            Edge => edges(self.mesh, |_| true),
            Face => faces(self.mesh, |_| true),
        }
    }

    /// Every id of every run must exist.
    fn ids(&self, runs: &[(u32, u32)]) -> Result<Marks, SelectError> {
        let all = self.all();
        let mut marks = vec![false; all.len()];
        for id in runs.iter().flat_map(|&(first, last)| first..=last) {
            if all.get(id as usize) != Some(&true) {
                let count = all.iter().filter(|&&exists| exists).count();
                let last = all.iter().rposition(|&exists| exists);
                return Err(SelectError::NoSuchId { kind: self.kind, id, count, last });
            }
            marks[id as usize] = true;
        }
        Ok(marks)
    }

    /// The elements with these numbers, as far as they still exist.
    fn listed(&self, numbers: impl Iterator<Item = usize>) -> Marks {
        let all = self.all();
        let mut marks = vec![false; all.len()];
        for i in numbers.filter(|&i| all.get(i) == Some(&true)) {
            marks[i] = true;
        }
        marks
    }

    /// The elements all of whose vertices are marked.
    fn by_vertices(&self, marks: &Marks) -> Marks {
        let mesh = self.mesh;
        match self.kind {
            Vertex => marks.clone(),
            Edge => edges(mesh, |e| mesh.edge_vertices(e).iter().all(|v| marks[v.index()])),
            Face => faces(mesh, |f| mesh.face_vertices(f).all(|v| marks[v.index()])),
        }
    }

    /// The vertices that lie farther along a direction than `height`. Signs of given positions are
    /// exact; a computed one must exceed its rounding, so that a face that should lie at the height
    /// does not count as above it.
    fn beyond(&self, direction: Direction, height: f64) -> Marks {
        let unit = direction.unit();
        let rounding =
            self.mesh.bounds().map_or(0.0, |(low, high)| RoundingBound::of_box(low, high).length());
        vertices(self.mesh, |v| {
            let position = self.mesh.position(v);
            if self.mesh.is_given(v) {
                side_of_plane(direction.0, unit * height, position) == Side::Normal
            } else {
                position.dot(unit) - height > rounding
            }
        })
    }

    fn by_normals(&self, fits: impl Fn(DVec3) -> bool) -> Marks {
        let mesh = self.mesh;
        if self.kind == Face {
            return faces(mesh, |f| mesh.plane(f).is_some_and(|plane| fits(plane.normal())));
        }
        // Of a vertex: the mean of the unit normals around it.
        let mut normals = vec![DVec3::ZERO; mesh.vertex_slots()];
        for f in mesh.faces() {
            let normal = mesh.plane(f).map_or(DVec3::ZERO, |plane| plane.normal());
            mesh.face_vertices(f).for_each(|v| normals[v.index()] += normal);
        }
        vertices(mesh, |v| fits(normals[v.index()]))
    }

    /// The faces of a group, or the edges and vertices of these faces.
    fn group(&self, name: &str) -> Result<Marks, SelectError> {
        let mesh = self.mesh;
        let of_group = faces(mesh, |f| mesh.group(f) == Some(name));
        if !of_group.contains(&true) {
            let nearest = nearest_word(name, mesh.groups().iter().map(String::as_str))
                .filter(|near| *near != name);
            let (nearest, known) = (nearest.map(str::to_owned), mesh.groups().to_vec());
            return Err(SelectError::NoSuchGroup { name: name.to_owned(), nearest, known });
        }
        Ok(match self.kind {
            Vertex => vertices(mesh, |v| mesh.vertex_faces(v).any(|f| of_group[f.index()])),
            Edge => edges(mesh, |e| mesh.edge_faces(e).iter().any(|f| of_group[f.index()])),
            Face => of_group,
        })
    }
}

/// Whether there is an angle, and it is at most the other; both in degrees.
fn is_within(angle: Option<f64>, most: f64) -> bool {
    angle.is_some_and(|angle| compare_angles(Compare::LessOrEqual, angle, most))
}

fn vertices(mesh: &Mesh, fits: impl Fn(VertexId) -> bool) -> Marks {
    let mut marks = vec![false; mesh.vertex_slots()];
    mesh.vertices().for_each(|v| marks[v.index()] = fits(v));
    marks
}

fn edges(mesh: &Mesh, fits: impl Fn(EdgeId) -> bool) -> Marks {
    let mut marks = vec![false; mesh.edge_slots()];
    mesh.edges().for_each(|e| marks[e.index()] = fits(e));
    marks
}

fn faces(mesh: &Mesh, fits: impl Fn(FaceId) -> bool) -> Marks {
    let mut marks = vec![false; mesh.face_slots()];
    mesh.faces().for_each(|f| marks[f.index()] = fits(f));
    marks
}

fn compare_angles(compare: Compare, measured: f64, given: f64) -> bool {
    let is_equal = (measured - given).abs() <= ANGLE_ROUNDING;
    compare.holds(if is_equal { Ordering::Equal } else { measured.total_cmp(&given) })
}

/// The angle between two directions in degrees, from 0 to 180; `None` when one of them is zero.
fn angle_between(a: DVec3, b: DVec3) -> Option<f64> {
    let a = a.try_normalize()?;
    Some(a.cross(b).length().atan2(a.dot(b)).to_degrees())
}
