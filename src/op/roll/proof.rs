//! Looks at what was cut, by code that did not cut: counts, valences, widths and angles, measured
//! on the result alone.

use super::ridge::Ridge;
use crate::measure::{crossings, edge_length, fold_angle};
use crate::mesh::{EdgeId, FaceId, FaceMap, Mesh};
use crate::op::roll_error::RollError;
use crate::select::NewElements;

/// By how much widths and angles of one roll may differ, as a share.
const EQUAL: f64 = 1e-9;

/// What is compared.
pub(super) struct Planned<'a> {
    pub before: &'a Mesh,
    pub ridges: &'a [Ridge],
    pub strips: &'a [u32],
    /// Whether every roll is a cylinder, whose strips have one width.
    pub is_cylinders: bool,
    /// Whether all edges and faces are convex: then what stands apart on the surface stands apart
    /// inside, too.
    pub is_convex: bool,
}

impl Planned<'_> {
    /// Compares the mesh that came out with what was to come out.
    pub fn compare(&self, after: &Mesh, made: &NewElements) -> Result<(), RollError> {
        self.counts(after)?;
        let mut groups = Groups::of(after, made);
        let total: usize = self.strips.iter().map(|&k| k as usize).sum();
        if made.faces.len() != total {
            return differs(format!("{} strips instead of {total}", made.faces.len()));
        }
        let rolls = groups.rolls(after, made);
        let mut sizes: Vec<usize> = rolls.iter().map(|roll| roll.faces.len()).collect();
        let mut planned: Vec<usize> = self.strips.iter().map(|&k| k as usize).collect();
        sizes.sort_unstable();
        planned.sort_unstable();
        if sizes != planned {
            return differs(format!(
                "{} rolls of connected strips instead of {}, or of other sizes",
                sizes.len(),
                planned.len()
            ));
        }
        rolls.iter().try_for_each(|roll| roll.is_even(after, self.is_cylinders))?;
        if !self.is_convex
            && let Some(pair) = crossings(after, 1).first()
            && crossings(self.before, 1).is_empty()
        {
            return differs(format!(
                "faces {} and {} go through each other",
                pair.first, pair.second
            ));
        }
        Ok(())
    }

    /// A fold of k strips between ends with three edges adds 2k vertices, 3k edges and k faces.
    fn counts(&self, after: &Mesh) -> Result<(), RollError> {
        let added: usize = self.strips.iter().map(|&k| k as usize).sum();
        let before = self.before;
        let is_simple = |ridge: &Ridge| ridge.ends.iter().all(|&v| before.valence(v) == 3);
        let faces = before.face_count() + added;
        if after.face_count() != faces {
            return differs(format!("{} faces instead of {faces}", after.face_count()));
        }
        if self.ridges.iter().all(is_simple) {
            let counts = [after.vertex_count(), after.edge_count()];
            let expected = [before.vertex_count() + 2 * added, before.edge_count() + 3 * added];
            if counts != expected {
                return differs(format!(
                    "{} vertices and {} edges instead of {} and {}",
                    counts[0], counts[1], expected[0], expected[1]
                ));
            }
        }
        Ok(())
    }
}

fn differs<T>(what: String) -> Result<T, RollError> {
    Err(RollError::NotAsPlanned { what })
}

/// The strips that are joined with one another by the folds that were made.
struct Groups {
    is_strip: FaceMap<bool>,
    of: FaceMap<usize>,
}

/// The strips of one edge.
struct Rolled {
    faces: Vec<FaceId>,
    folds: Vec<EdgeId>,
}

impl Groups {
    fn of(mesh: &Mesh, made: &NewElements) -> Self {
        let mut is_strip = FaceMap::filled(mesh.face_slots(), false);
        made.faces.iter().for_each(|&f| is_strip[f] = true);
        let mut of = FaceMap::filled(mesh.face_slots(), 0);
        made.faces.iter().enumerate().for_each(|(i, &f)| of[f] = i);
        Self { is_strip, of }
    }

    fn rolls(&mut self, mesh: &Mesh, made: &NewElements) -> Vec<Rolled> {
        let mut is_fold = crate::mesh::EdgeMap::filled(mesh.edge_slots(), false);
        made.strip.iter().for_each(|&e| is_fold[e] = true);
        let mut is_seen = vec![false; made.faces.len()];
        let mut rolls = Vec::new();
        for &start in &made.faces {
            if std::mem::replace(&mut is_seen[self.of[start]], true) {
                continue;
            }
            let (mut faces, mut folds, mut next) = (Vec::new(), Vec::new(), vec![start]);
            while let Some(f) = next.pop() {
                faces.push(f);
                for h in mesh.face_half_edges(f).filter(|h| is_fold[h.edge()]) {
                    folds.push(h.edge());
                    let g = mesh.face(h.twin());
                    if self.is_strip[g] && !std::mem::replace(&mut is_seen[self.of[g]], true) {
                        next.push(g);
                    }
                }
            }
            folds.sort_unstable();
            folds.dedup();
            rolls.push(Rolled { faces, folds });
        }
        rolls
    }
}

impl Rolled {
    /// k strips have k + 1 folds of one angle, and each lies between two of them at one width.
    fn is_even(&self, mesh: &Mesh, is_cylinder: bool) -> Result<(), RollError> {
        if self.folds.len() != self.faces.len() + 1 {
            return differs(format!("{} strips with {} folds", self.faces.len(), self.folds.len()));
        }
        let angles = self.folds.iter().map(|&e| fold_angle(mesh, e).unwrap_or(f64::NAN));
        equal("fold angles", angles.map(f64::to_degrees), "degrees")?;
        if is_cylinder {
            let widths = self.faces.iter().map(|&f| self.width(mesh, f));
            equal("widths", widths, "mm")?;
        }
        Ok(())
    }

    /// The distance of the middle of one fold of a strip from the line of the other.
    fn width(&self, mesh: &Mesh, f: FaceId) -> f64 {
        let is_own = |e: &EdgeId| self.folds.binary_search(e).is_ok();
        let mut own: Vec<EdgeId> =
            mesh.face_half_edges(f).map(|h| h.edge()).filter(is_own).collect();
        own.sort_by(|&a, &b| edge_length(mesh, a).total_cmp(&edge_length(mesh, b)));
        let [short, long] = own[..] else { return f64::NAN };
        let [a, b] = mesh.edge_positions(long);
        let [p, q] = mesh.edge_positions(short);
        let along = (b - a).normalize_or_zero();
        let off = p.midpoint(q) - a;
        (off - along * off.dot(along)).length()
    }
}

fn equal(what: &str, values: impl Iterator<Item = f64>, unit: &str) -> Result<(), RollError> {
    let (mut least, mut most, mut is_number) = (f64::INFINITY, 0.0_f64, true);
    for value in values {
        (least, most) = (least.min(value), most.max(value));
        is_number &= value.is_finite();
    }
    if is_number && most - least <= EQUAL * most {
        return Ok(());
    }
    differs(format!("{what} of one roll between {least} and {most} {unit}"))
}
