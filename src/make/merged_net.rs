//! A net as it is drawn when a piece bends smoothly: faces that no scored line parts are one.

use std::collections::HashMap;

use glam::DVec2;

use crate::net::{FlatFace, Net};
use crate::units::Angle;

/// The net without the folds that bend by less than a limit, and how many these are. Numbers of
/// faces are those of one face of each part. What is left of a net whose parts are no discs is the
/// net itself.
pub(super) fn without_blank_folds(net: &Net, limit: Angle) -> (Net, usize) {
    let is_blank = |angle: f64| angle.abs() < limit.degrees();
    let mut part: HashMap<usize, usize> =
        net.pieces.iter().flat_map(|p| &p.faces).map(|f| (f.face, f.face)).collect();
    for fold in net.folds.iter().filter(|f| is_blank(f.fold_angle)) {
        let [a, b] = fold.faces.map(|f| root(&part, f));
        part.insert(a.max(b), a.min(b));
    }
    let sides = Sides::new(net, is_blank);
    let mut merged = net.clone();
    for piece in &mut merged.pieces {
        let whole = std::mem::take(&mut piece.faces);
        let mut order: Vec<usize> = whole.iter().map(|f| root(&part, f.face)).collect();
        order.sort_unstable();
        order.dedup();
        for of in order {
            let faces: Vec<&FlatFace> =
                whole.iter().filter(|f| root(&part, f.face) == of).collect();
            match sides.boundary(&faces) {
                Some((vertices, polygon)) => {
                    piece.faces.push(FlatFace { face: of, vertices, polygon });
                }
                None => return (net.clone(), 0),
            }
        }
    }
    let before = merged.folds.len();
    merged.folds.retain(|f| !is_blank(f.fold_angle));
    merged.folds.iter_mut().for_each(|f| f.faces = f.faces.map(|f| root(&part, f)));
    for side in merged.seams.iter_mut().flat_map(|s| &mut s.sides) {
        side.face = root(&part, side.face);
    }
    let blank = before - merged.folds.len();
    (merged, blank)
}

fn root(part: &HashMap<usize, usize>, mut face: usize) -> usize {
    while let Some(&next) = part.get(&face).filter(|&&next| next != face) {
        face = next;
    }
    face
}

/// Sides of faces, and what lies across those that are blank.
struct Sides<'a> {
    faces: HashMap<usize, &'a FlatFace>,
    across: HashMap<(usize, usize), (usize, usize)>,
}

impl<'a> Sides<'a> {
    fn new(net: &'a Net, is_blank: impl Fn(f64) -> bool) -> Self {
        let faces: HashMap<usize, &FlatFace> =
            net.pieces.iter().flat_map(|p| &p.faces).map(|f| (f.face, f)).collect();
        let side = |face: usize, edge: [usize; 2]| {
            let vertices = &faces[&face].vertices;
            let n = vertices.len();
            (0..n).find(|&i| {
                let ends = [vertices[i], vertices[(i + 1) % n]];
                ends == edge || ends == [edge[1], edge[0]]
            })
        };
        let mut across = HashMap::new();
        for fold in net.folds.iter().filter(|f| is_blank(f.fold_angle)) {
            let [f, g] = fold.faces;
            if let (Some(i), Some(j)) = (side(f, fold.edge), side(g, fold.edge)) {
                across.insert((f, i), (g, j));
                across.insert((g, j), (f, i));
            }
        }
        Self { faces, across }
    }

    /// The one boundary of faces that hang together; nothing when there are several.
    fn boundary(&self, faces: &[&FlatFace]) -> Option<(Vec<usize>, Vec<DVec2>)> {
        let open: Vec<(usize, usize)> = faces
            .iter()
            .flat_map(|f| (0..f.vertices.len()).map(|i| (f.face, i)))
            .filter(|side| !self.across.contains_key(side))
            .collect();
        let &start = open.first()?;
        let (mut vertices, mut polygon) = (Vec::new(), Vec::new());
        let mut at = start;
        loop {
            let face = self.faces[&at.0];
            vertices.push(face.vertices[at.1]);
            polygon.push(face.polygon[at.1]);
            at = self.next(at);
            while let Some(&beyond) = self.across.get(&at) {
                at = self.next(beyond);
            }
            if at == start {
                break;
            }
            if vertices.len() > open.len() {
                return None;
            }
        }
        (vertices.len() == open.len()).then_some((vertices, polygon))
    }

    fn next(&self, (face, side): (usize, usize)) -> (usize, usize) {
        (face, (side + 1) % self.faces[&face].vertices.len())
    }
}
