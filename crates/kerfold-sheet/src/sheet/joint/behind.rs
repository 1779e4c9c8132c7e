//! Where flaps come to lie: behind the face on the other side of their seam, and behind the faces
//! that continue it in its plane.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::geom::polygon::{Location, locate, segments_cross};
use crate::net::{FlatFace, FoldKind, Net, Segment};

/// How much smaller a flap is measured, relative to its size: its ends begin on corners of the face
/// behind which it lies, and may run along the sides of that.
const SLACK: f64 = 1e-6;

/// The faces of a net by their numbers, and which of them continue one another.
pub(super) struct Behind<'a> {
    net: &'a Net,
    faces: BTreeMap<usize, &'a FlatFace>,
    /// Face → faces of its piece across flat folds.
    flat: BTreeMap<usize, Vec<usize>>,
}

/// The partner of a flap.
pub(super) struct Partner<'a> {
    /// The side of the partner's face at the seam, in its sense.
    side: Segment,
    /// The face and those that continue it.
    faces: Vec<&'a FlatFace>,
    /// Their sides that belong to one of them only.
    border: Vec<Segment>,
}

impl<'a> Behind<'a> {
    pub fn new(net: &'a Net) -> Self {
        let faces = net.pieces.iter().flat_map(|p| &p.faces).map(|f| (f.face, f)).collect();
        let mut flat: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for fold in net.folds.iter().filter(|f| f.kind == FoldKind::Flat) {
            let [f, g] = fold.faces;
            flat.entry(f).or_default().push(g);
            flat.entry(g).or_default().push(f);
        }
        Self { net, faces, flat }
    }

    /// What a flap on one side of a seam lies behind; nothing when the net has no such face.
    pub fn partner(&self, seam: usize, side: usize) -> Option<Partner<'a>> {
        let seam = &self.net.seams[seam];
        let own = &seam.sides[1 - side];
        let first = *self.faces.get(&own.face)?;
        let side = first.side(seam.edge, own.segment)?;
        let faces = self.continued(first);
        let sides = || faces.iter().flat_map(|face| numbered_sides(face));
        let is_inner = |[u, v]: [usize; 2]| sides().any(|(other, _)| other == [v, u]);
        let border = sides().filter(|(ends, _)| !is_inner(*ends)).map(|(_, s)| s).collect();
        Some(Partner { side, faces, border })
    }

    /// A face with all that continue it across flat folds.
    fn continued(&self, first: &'a FlatFace) -> Vec<&'a FlatFace> {
        let mut faces = vec![first];
        let mut next = 0;
        while next < faces.len() {
            for other in self.flat.get(&faces[next].face).into_iter().flatten() {
                if let Some(&face) = self.faces.get(other)
                    && faces.iter().all(|f| f.face != face.face)
                {
                    faces.push(face);
                }
            }
            next += 1;
        }
        faces
    }
}

/// The sides of a face with the numbers of the vertices at their ends.
fn numbered_sides(face: &FlatFace) -> impl Iterator<Item = ([usize; 2], Segment)> + '_ {
    let n = face.polygon.len().min(face.vertices.len());
    (0..n).map(move |i| {
        let j = (i + 1) % n;
        ([face.vertices[i], face.vertices[j]], [face.polygon[i], face.polygon[j]])
    })
}

impl Partner<'_> {
    /// The angles that the partner leaves at the two ends of a flap's base, in radians; more than
    /// half a turn where a face goes on in its plane.
    pub fn angles(&self) -> [f64; 2] {
        let [c, d] = self.side;
        let length = c.distance(d);
        let near = |p: DVec2, q: DVec2| p.distance(q) <= SLACK * length;
        // The sides of the border that leave `d` and arrive at `c`: the base of the flap runs from
        // `d` to `c`.
        let after = self.border.iter().find(|s| near(s[0], d) && !near(s[1], c));
        let before = self.border.iter().find(|s| near(s[1], c) && !near(s[0], d));
        let turn = |from: DVec2, to: DVec2| from.angle_to(to).rem_euclid(std::f64::consts::TAU);
        [
            after.map_or(f64::INFINITY, |s| turn(s[1] - s[0], c - d)),
            before.map_or(f64::INFINITY, |s| turn(d - c, s[0] - s[1])),
        ]
    }

    /// Whether a flap, folded over its base, lies behind the partner with all its area.
    pub fn hides(&self, base: Segment, top: Segment) -> bool {
        let flap = [base[0], base[1], top[1], top[0]].map(|p| self.folded(base, p));
        let middle = flap.iter().sum::<DVec2>() / 4.0;
        let flap = flap.map(|p| p + (middle - p) * SLACK);
        let is_behind =
            |p: DVec2| self.faces.iter().any(|face| locate(&face.polygon, p) != Location::Outside);
        let crosses =
            |[a, b]: Segment| self.border.iter().any(|&[p, q]| segments_cross(a, b, p, q));
        flap.iter().all(|&p| is_behind(p)) && !(0..4).any(|i| crosses([flap[i], flap[(i + 1) % 4]]))
    }

    /// Where a point of a flap lies in the partner's frame once the flap is folded over its base.
    fn folded(&self, [a, b]: Segment, p: DVec2) -> DVec2 {
        let along = (b - a).normalize_or_zero();
        let [c, d] = self.side;
        let back = (c - d).normalize_or_zero();
        d + back * (p - a).dot(along) + back.perp() * (p - a).dot(along.perp())
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::testing::{points, twins};
    use super::*;

    /// Two equal triangles with sides of 10, 26 and 24 mm.
    fn triangles() -> Net {
        twins(points([(0.0, 0.0), (24.0, 0.0), (0.0, 10.0)]), 60.0)
    }

    #[test]
    fn a_flap_lies_behind_its_partner_or_sticks_out() {
        let net = triangles();
        let behind = Behind::new(&net);
        for (s, seam) in net.seams.iter().enumerate() {
            let partner = behind.partner(s, 0).expect("the other triangle");
            let face = &net.pieces[0].faces[0];
            let [a, b] = face.side(seam.edge, seam.sides[0].segment).expect("a side");
            let (along, out) = ((b - a).normalize(), -(b - a).normalize().perp());
            let length = a.distance(b);
            let flap = |share: f64, width: f64| {
                let [l, r] = [0.5 - share / 2.0, 0.5 + share / 2.0].map(|t| along * (length * t));
                partner.hides([a, b], [a + l + out * width, a + r + out * width])
            };
            assert!(flap(0.02, 1.0), "seam {s}");
            assert!(!flap(0.9, 0.5 * length), "seam {s}");
            // Just as high as the triangle over this side, and a little higher.
            let angles = partner.angles();
            let height = length / angles.iter().map(|a| 1.0 / a.tan()).sum::<f64>();
            let tip = a + along * (height / angles[0].tan());
            let top = |by: f64| [tip + out * (height * by); 2];
            assert!(partner.hides([a, b], top(0.999)) && !partner.hides([a, b], top(1.001)));
        }
    }
}
