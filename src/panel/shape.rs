//! One plate of one face: sides moved in, corners cut off, fingers put on.

use glam::DVec2;

use super::across::Inset;
use super::cut::Cutter;
use super::finger::{Comb, zone_points};
use super::outline::FlatFace;
use super::plate::Plate;
use crate::geom::Frame;
use crate::mesh::EdgeMap;

/// The share of a side that cutting off one of its corners may take.
const CORNER_SHARE: f64 = 0.45;

/// A plate without holes, and how many of its corners could not be relieved.
pub(super) struct Shaped {
    pub plate: Plate,
    pub unrelieved: usize,
}

/// Makes the plate of a face.
pub(super) fn shape(face: &FlatFace, cutter: &Cutter<'_>, combs: &EdgeMap<Option<Comb>>) -> Shaped {
    let moved = MovedSides::new(face, cutter);
    let levels: Vec<Option<f64>> = (0..face.len()).map(|i| moved.cut_level(cutter, i)).collect();
    let finish = |corners: &[DVec2]| moved.finished(corners, &levels, combs);
    let (front, back, blank) = (finish(&moved.front), finish(&moved.back), finish(&moved.blank));
    let convex = (0..face.len()).filter(|&i| face.is_convex(i)).count();
    let is_relieved = cutter.params.corner_relief.mm() > 0.0;
    let offset = cutter.offsets(face.face, 1.0)[0];
    let plate = Plate {
        face: face.face,
        thickness: cutter.thickness[face.face],
        frame: Frame { origin: face.frame.origin + face.frame.normal * offset, ..face.frame },
        half_edges: face.half_edges.clone(),
        reference: face.corners.clone(),
        front: front.points,
        back: back.points,
        blank: blank.points,
        begins: front.begins,
        ends: front.ends,
        inner: moved.inner,
        holes: Vec::new(),
    };
    let cut = levels.iter().flatten().count();
    Shaped { plate, unrelieved: if is_relieved { convex - cut } else { 0 } }
}

/// A face with its sides moved in: one corner for each vertex.
pub(super) struct MovedSides<'a> {
    face: &'a FlatFace,
    insets: Vec<Inset>,
    front: Vec<DVec2>,
    back: Vec<DVec2>,
    /// Every side where it is outermost.
    blank: Vec<DVec2>,
    /// Every side where it is innermost.
    inner: Vec<DVec2>,
}

/// An outline with the places where the sides of its face begin and end.
struct Outline {
    points: Vec<DVec2>,
    begins: Vec<usize>,
    ends: Vec<usize>,
}

impl<'a> MovedSides<'a> {
    pub fn new(face: &'a FlatFace, cutter: &Cutter<'_>) -> Self {
        let insets: Vec<Inset> = face.half_edges.iter().map(|&h| cutter.inset(h, 1.0)).collect();
        let moved = |of: fn(&Inset) -> f64| face.moved(&insets.iter().map(of).collect::<Vec<_>>());
        let [front, back] = [moved(|inset| inset.front), moved(|inset| inset.back)];
        let [blank, inner] = [moved(Inset::outer), moved(Inset::inner)];
        Self { face, insets, front, back, blank, inner }
    }

    /// The two levels between which a corner stands along its bisector: its outermost point and
    /// that of front and back which lies farther in.
    pub fn corner_levels(&self, i: usize) -> [f64; 2] {
        let inwards = self.face.bisector(i);
        let inner = self.front[i].dot(inwards).max(self.back[i].dot(inwards));
        [self.blank[i].dot(inwards), inner]
    }

    /// Whether a corner can be cut off at a level along its bisector: it is convex, and not too
    /// much is taken of a side.
    pub fn can_be_cut(&self, i: usize, level: f64) -> bool {
        let (face, n) = (self.face, self.face.len());
        let keeps_sides = |outline: &Vec<DVec2>| {
            let [p, q] = self.cut_corner(i, outline[i], level);
            let (before, after) = (outline[face.before(i)], outline[(i + 1) % n]);
            p.distance(outline[i]) < CORNER_SHARE * outline[i].distance(before)
                && q.distance(outline[i]) < CORNER_SHARE * outline[i].distance(after)
        };
        face.is_convex(i) && [&self.front, &self.back, &self.blank].into_iter().all(keeps_sides)
    }

    /// Where a corner is cut off, if it is: for the relief that was asked for, or where other
    /// plates need the place.
    fn cut_level(&self, cutter: &Cutter<'_>, i: usize) -> Option<f64> {
        let relief = cutter.params.corner_relief.mm();
        let needed = cutter.level(self.face.half_edges[i]);
        let wanted = (relief > 0.0).then(|| self.corner_levels(i)[1] + relief);
        let deeper = wanted.map(|level| needed.map_or(level, |needed| level.max(needed)));
        [deeper, needed].into_iter().flatten().find(|&level| self.can_be_cut(i, level))
    }

    /// The two corners that take the place of one.
    fn cut_corner(&self, i: usize, corner: DVec2, level: f64) -> [DVec2; 2] {
        let inwards = self.face.bisector(i);
        let rest = level - corner.dot(inwards);
        let (u, v) = (self.face.along[self.face.before(i)], self.face.along[i]);
        [corner + u * (rest / u.dot(inwards)), corner + v * (rest / v.dot(inwards))]
    }

    /// An outline with its corners cut off and its fingers.
    fn finished(
        &self,
        corners: &[DVec2],
        levels: &[Option<f64>],
        combs: &EdgeMap<Option<Comb>>,
    ) -> Outline {
        let mut outline = Outline { points: Vec::new(), begins: Vec::new(), ends: Vec::new() };
        for (i, &corner) in corners.iter().enumerate() {
            // So far the end of the side before each corner.
            outline.ends.push(outline.points.len());
            match levels[i] {
                Some(level) => outline.points.extend(self.cut_corner(i, corner, level)),
                None => outline.points.push(corner),
            }
            outline.begins.push(outline.points.len() - 1);
            if let Some(comb) = &combs[self.face.half_edges[i].edge()] {
                outline.points.extend(zone_points(self.face, i, &self.insets[i], comb));
            }
        }
        outline.ends.rotate_left(1);
        outline
    }
}
