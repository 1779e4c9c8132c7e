//! The boundaries of all pieces, edge by edge, with the seam that every edge belongs to, and what
//! joints add to them.

use std::collections::BTreeMap;

use glam::DVec2;

use super::distance::distance_to_segment;
use crate::geom::polygon::segments_meet;
use crate::net::{FlatFace, Net, Segment};

/// One closed boundary with the material on its left.
pub(crate) struct Contour {
    /// Index of the piece in the net.
    pub piece: usize,
    pub corners: Vec<DVec2>,
    /// Corner → what is cut there instead.
    pub cut_corners: Vec<Vec<DVec2>>,
    /// Edge → what is cut between its two corners.
    pub profiles: Vec<Vec<DVec2>>,
    /// Edge → the seam, by its index in the net, and which of its sides it is.
    pub sides: Vec<Option<(usize, usize)>>,
}

/// Where a side of a seam lies: the contour and the edge, from its corner of the same number to the
/// next.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Place {
    pub contour: usize,
    pub edge: usize,
}

/// All boundaries of a net.
pub(crate) struct Boundaries {
    pub contours: Vec<Contour>,
    /// Seam → where its two sides lie.
    pub places: Vec<[Option<Place>; 2]>,
}

impl Contour {
    pub fn len(&self) -> usize {
        self.corners.len()
    }

    pub fn edge(&self, i: usize) -> Segment {
        [self.corners[i], self.corners[(i + 1) % self.len()]]
    }

    /// What is cut, all around.
    pub fn path(&self) -> Vec<DVec2> {
        (0..self.len())
            .flat_map(|i| self.cut_corners[i].iter().chain(&self.profiles[i]).copied())
            .collect()
    }

    /// All that is cut around it, with the edges that it belongs to: the corner before an edge,
    /// then the edge.
    pub fn cuts(&self) -> impl Iterator<Item = (usize, Segment)> + '_ {
        (0..self.len()).flat_map(|i| {
            let corner = segments(&self.cut_corners[i]);
            let along = segments(&self.cut_edge(i));
            corner.into_iter().chain(along).map(move |s| (i, s))
        })
    }

    /// The cut along one edge, from the end of its first corner to the beginning of its second.
    pub fn cut_edge(&self, i: usize) -> Vec<DVec2> {
        let first = self.cut_corners[i].last().copied();
        let last = self.cut_corners[(i + 1) % self.len()].first().copied();
        first.into_iter().chain(self.profiles[i].iter().copied()).chain(last).collect()
    }
}

impl Boundaries {
    pub fn new(net: &Net) -> Self {
        let mut sides: BTreeMap<_, Vec<(Segment, (usize, usize))>> = BTreeMap::new();
        let faces: BTreeMap<usize, &FlatFace> =
            net.pieces.iter().flat_map(|p| &p.faces).map(|f| (f.face, f)).collect();
        for (s, seam) in net.seams.iter().enumerate() {
            for (k, side) in seam.sides.iter().enumerate() {
                let found =
                    faces.get(&side.face).and_then(|face| face.side(seam.edge, side.segment));
                sides.entry(side.piece).or_default().extend(found.map(|segment| (segment, (s, k))));
            }
        }
        for here in sides.values_mut() {
            here.sort_by(|(x, _), (y, _)| x[0].x.total_cmp(&y[0].x));
        }
        let mut all = Self { contours: Vec::new(), places: vec![[None; 2]; net.seams.len()] };
        for (i, piece) in net.pieces.iter().enumerate() {
            let here = sides.get(&piece.id).map_or(&[][..], Vec::as_slice);
            for corners in std::iter::once(&piece.outline).chain(&piece.holes) {
                all.add(i, corners, here);
            }
        }
        all
    }

    /// Adds a contour. The sides of seams are in the order of the x of their first ends, so that only
    /// those that begin near an edge are compared with it.
    fn add(&mut self, piece: usize, corners: &[DVec2], sides: &[(Segment, (usize, usize))]) {
        let n = corners.len();
        let mut contour = Contour {
            piece,
            corners: corners.to_vec(),
            cut_corners: corners.iter().map(|&p| vec![p]).collect(),
            profiles: vec![Vec::new(); n],
            sides: vec![None; n],
        };
        for i in 0..n {
            let [a, b] = contour.edge(i);
            // Corners of neighbouring faces differ by rounding, so that the nearest side is meant.
            let near = 1e-6 * a.distance(b);
            let off = |s: &Segment| s[0].distance(a) + s[1].distance(b);
            let first = sides.partition_point(|(s, _)| s[0].x < a.x - near);
            let here = sides[first..].iter().take_while(|(s, _)| s[0].x <= a.x + near);
            // Of equal ones the first in the net.
            let nearest = here.min_by(|x, y| off(&x.0).total_cmp(&off(&y.0)).then(x.1.cmp(&y.1)));
            if let Some((_, (s, k))) = nearest.filter(|(s, _)| off(s) <= near) {
                contour.sides[i] = Some((*s, *k));
                self.places[*s][*k] = Some(Place { contour: self.contours.len(), edge: i });
            }
        }
        self.contours.push(contour);
    }

    /// The contours of a piece: the outline, then its holes.
    pub fn of_piece(&self, piece: usize) -> impl Iterator<Item = &Contour> {
        self.contours.iter().filter(move |c| c.piece == piece)
    }

    /// All that is cut around a piece, edge by edge.
    pub fn cuts(&self, piece: usize) -> impl Iterator<Item = (&Contour, usize, Segment)> {
        self.of_piece(piece).flat_map(|c| c.cuts().map(move |(i, s)| (c, i, s)))
    }
}

fn segments(points: &[DVec2]) -> Vec<Segment> {
    points.windows(2).map(|w| [w[0], w[1]]).collect()
}

/// The distance of two closed segments; 0 when they meet.
pub(super) fn segment_distance([a, b]: Segment, [c, d]: Segment) -> f64 {
    if segments_meet(a, b, c, d) {
        return 0.0;
    }
    let from = |p, q, r| distance_to_segment(p, q, r);
    from(a, c, d).min(from(b, c, d)).min(from(c, a, b)).min(from(d, a, b))
}
