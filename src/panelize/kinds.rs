//! How many different panels and edges there are, by lengths alone: nothing that laid them out or
//! solved for them has a say.

use glam::DVec3;

use super::regions::Panels;

/// Panels and edges are alike when their lengths differ by at most this, in panel sizes.
pub(super) const ALIKE: f64 = 1e-3;

/// Which panels are alike.
#[derive(Debug, Clone)]
pub(super) struct Kinds {
    /// For each panel the number of its kind.
    pub of_panel: Vec<usize>,
    pub panels: usize,
    pub edges: usize,
    /// How many edges there are in all.
    pub all_edges: usize,
}

/// The outline of a panel as lengths: of the side that begins at each corner, and of the diagonal
/// that skips the next corner. They settle a planar polygon up to motions and mirror images, but
/// for which side of a diagonal a corner lies on: the area tells that.
struct Outline {
    lengths: Vec<[f64; 2]>,
    perimeter: f64,
    area: f64,
}

impl Outline {
    fn new(corners: &[DVec3]) -> Self {
        let count = corners.len();
        let to = |i: usize, k: usize| corners[i].distance(corners[(i + k) % count]);
        let lengths: Vec<[f64; 2]> = (0..count).map(|i| [to(i, 1), to(i, 2)]).collect();
        let cross =
            |i: usize| (corners[i] - corners[0]).cross(corners[(i + 1) % count] - corners[0]);
        let area = (0..count).map(cross).sum::<DVec3>().length() / 2.0;
        Self { perimeter: lengths.iter().map(|l| l[0]).sum(), lengths, area }
    }

    /// Whether two outlines are the same, from some corner on, either way around.
    fn is_like(&self, other: &Self, tolerance: f64) -> bool {
        let count = self.lengths.len();
        let near = |a: f64, b: f64| (a - b).abs() <= tolerance;
        if other.lengths.len() != count
            || !near(self.perimeter / count as f64, other.perimeter / count as f64)
            || (self.area - other.area).abs() > tolerance * self.perimeter
        {
            return false;
        }
        let alike = |from: usize, backwards: bool| {
            (0..count).all(|i| {
                let [side, diagonal] = self.lengths[i];
                let (j, k) = if backwards {
                    // The side before a corner, and the diagonal that ends there.
                    let corner = (from + 2 * count - i) % count;
                    ((corner + count - 1) % count, (corner + count - 2) % count)
                } else {
                    ((from + i) % count, (from + i) % count)
                };
                near(side, other.lengths[j][0]) && near(diagonal, other.lengths[k][1])
            })
        };
        (0..count).any(|from| alike(from, false) || alike(from, true))
    }
}

/// Sorts panels and edges by kind. Each panel is compared with the first of every kind.
pub(super) fn kinds(panels: &Panels, tolerance: f64) -> Kinds {
    let mut firsts: Vec<Outline> = Vec::new();
    let mut of_panel = Vec::with_capacity(panels.faces.len());
    let mut edges = Vec::new();
    for face in &panels.faces {
        let corners: Vec<DVec3> = face.iter().map(|&v| panels.points[v]).collect();
        let outline = Outline::new(&corners);
        for i in 0..face.len() {
            let (u, v) = (face[i], face[(i + 1) % face.len()]);
            edges.push(([u.min(v), u.max(v)], corners[i].distance(corners[(i + 1) % face.len()])));
        }
        let kind = firsts.iter().position(|first| outline.is_like(first, tolerance));
        of_panel.push(kind.unwrap_or(firsts.len()));
        if kind.is_none() {
            firsts.push(outline);
        }
    }
    edges.sort_by_key(|&(ends, _)| ends);
    edges.dedup_by_key(|&mut (ends, _)| ends);
    let all_edges = edges.len();
    let mut lengths: Vec<f64> = edges.into_iter().map(|(_, length)| length).collect();
    lengths.sort_by(f64::total_cmp);
    let (mut count, mut from) = (0, f64::NEG_INFINITY);
    for length in lengths {
        if length > from + tolerance {
            (count, from) = (count + 1, length);
        }
    }
    Kinds { of_panel, panels: firsts.len(), edges: count, all_edges }
}

#[cfg(test)]
mod tests {
    use super::super::regions::Kind;
    use super::*;

    #[test]
    fn turned_and_mirrored_panels_are_alike_and_others_are_not() {
        let outline = [(0.0, 0.0), (1.0, 0.0), (1.3, 0.7), (0.4, 1.1), (-0.2, 0.6)];
        let turned =
            |(x, y): (f64, f64)| DVec3::new(3.0 + 0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, 2.0);
        let mirrored = |(x, y): (f64, f64)| DVec3::new(-x, 5.0, y);
        let plain = |(x, y): (f64, f64)| DVec3::new(x, y, 0.0);
        let mut points: Vec<DVec3> = outline.iter().map(|&p| plain(p)).collect();
        points.extend(outline.iter().map(|&p| turned(p)));
        points.extend(outline.iter().rev().map(|&p| mirrored(p)));
        points.extend(outline.iter().map(|&p| plain(p) * 1.01));
        let faces: Vec<Vec<usize>> =
            [[0, 1, 2, 3, 4], [7, 8, 9, 5, 6], [10, 11, 12, 13, 14], [15, 16, 17, 18, 19]]
                .map(|face| face.to_vec())
                .to_vec();
        let kinds_of = vec![Kind::Inner; points.len()];
        let panels = Panels { points, faces, kinds: kinds_of, ..Panels::default() };
        let found = kinds(&panels, 1e-9);
        assert_eq!((found.of_panel, found.edges, found.all_edges), (vec![0, 0, 0, 1], 10, 20));
        assert_eq!(kinds(&panels, 0.1).panels, 1);
    }
}
