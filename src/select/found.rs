//! What there is instead, for the message of a selection that selects nothing.

use std::collections::BTreeMap;

use super::expr::{Atom, Expr};
use crate::measure::fold_angle;
use crate::mesh::Mesh;

/// How many different values a message lists at most.
const MOST_VALUES: usize = 8;

/// The values that the mesh has for the first measured condition of the expression.
pub(super) fn found(expr: &Expr, mesh: &Mesh) -> Option<String> {
    match expr {
        Expr::Atom(atom) => of_atom(atom, mesh),
        Expr::Not(inner) => found(inner, mesh),
        Expr::And(parts) | Expr::Or(parts) => parts.iter().find_map(|part| found(part, mesh)),
    }
}

fn of_atom(atom: &Atom, mesh: &Mesh) -> Option<String> {
    match atom {
        Atom::Valence(..) => {
            histogram("the valences are", mesh.vertices().map(|v| mesh.valence(v)))
        }
        Atom::Sides(..) => histogram("the faces have sides", mesh.faces().map(|f| mesh.sides(f))),
        Atom::Fold(..) => {
            let folds = mesh
                .edges()
                .filter_map(|e| fold_angle(mesh, e))
                .map(|fold| fold.abs().to_degrees());
            range(folds).map(|(low, high)| format!("the folds go from {low:.4}° to {high:.4}°"))
        }
        Atom::Above(direction, _) | Atom::Below(direction, _) => {
            let unit = direction.unit();
            let heights = mesh.vertices().map(|v| mesh.position(v).dot(unit));
            range(heights).map(|(low, high)| {
                format!("the model goes from {low:.4} to {high:.4} mm along {direction}")
            })
        }
        Atom::Made | Atom::Strip => Some("the last step made none".to_owned()),
        _ => None,
    }
}

fn histogram(what: &str, values: impl Iterator<Item = usize>) -> Option<String> {
    let mut counts = BTreeMap::new();
    values.for_each(|value| *counts.entry(value).or_insert(0_usize) += 1);
    let listed: Vec<String> = counts
        .iter()
        .take(MOST_VALUES)
        .map(|(value, count)| format!("{value} (×{count})"))
        .collect();
    let more = if counts.len() > MOST_VALUES { ", …" } else { "" };
    (!listed.is_empty()).then(|| format!("{what} {}{more}", listed.join(", ")))
}

fn range(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, x| {
        Some(range.map_or((x, x), |(low, high): (f64, f64)| (low.min(x), high.max(x))))
    })
}
