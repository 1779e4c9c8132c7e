//! Whether the edges of one plate run inside another one.

use glam::{DVec2, DVec3};
use kerfold::panel::Plate;

/// How deep inside is inside, as a part of the thickness.
const DEEP: f64 = 1e-7;

/// All pairs of plates that overlap, with a point that lies inside of both.
pub fn overlapping(plates: &[Plate]) -> Vec<(usize, usize, DVec3)> {
    let boxes: Vec<(DVec3, DVec3)> = plates.iter().map(bounds).collect();
    let mut found = Vec::new();
    for i in 0..plates.len() {
        for j in (0..plates.len()).filter(|&j| j != i) {
            let apart = boxes[i].0.cmpgt(boxes[j].1).any() || boxes[j].0.cmpgt(boxes[i].1).any();
            if !apart {
                let edges = edges(&plates[i]);
                let inside = edges.into_iter().find_map(|e| runs_inside(&plates[j], e));
                found.extend(inside.map(|at| (i, j, at)));
            }
        }
    }
    found
}

fn rings(plate: &Plate) -> [Vec<DVec3>; 2] {
    [
        plate.front.iter().map(|&p| plate.on_front(p)).collect(),
        plate.back.iter().map(|&p| plate.on_back(p)).collect(),
    ]
}

fn bounds(plate: &Plate) -> (DVec3, DVec3) {
    let points = rings(plate).concat();
    points.iter().fold((points[0], points[0]), |(l, h), &p| (l.min(p), h.max(p)))
}

fn edges(plate: &Plate) -> Vec<[DVec3; 2]> {
    let [front, back] = rings(plate);
    let n = front.len();
    let around = [&front, &back].into_iter().flat_map(|r| (0..n).map(|i| [r[i], r[(i + 1) % n]]));
    around.chain((0..n).map(|i| [front[i], back[i]])).collect()
}

/// A point of a segment that lies inside of a plate: the segment is divided where it crosses the
/// planes of the plate's faces, and the middles of the parts are located.
fn runs_inside(plate: &Plate, [a, b]: [DVec3; 2]) -> Option<DVec3> {
    let [front, back] = rings(plate);
    let n = front.len();
    let normal = plate.frame.normal;
    let walls = (0..n).filter_map(|i| {
        let j = (i + 1) % n;
        Some(((front[j] - back[i]).cross(front[i] - back[j]).try_normalize()?, front[i]))
    });
    let planes = walls.chain([(normal, front[0]), (normal, back[0])]);
    let crossing = planes.filter_map(|(normal, point)| {
        let (d, e) = (normal.dot(a - point), normal.dot(b - point));
        let t = d / (d - e);
        (t > 0.0 && t < 1.0).then_some(t)
    });
    let mut at: Vec<f64> = crossing.chain([0.0, 1.0]).collect();
    at.sort_by(f64::total_cmp);
    at.windows(2).map(|w| a.lerp(b, w[0].midpoint(w[1]))).find(|&p| is_inside(plate, p))
}

fn is_inside(plate: &Plate, p: DVec3) -> bool {
    let frame = &plate.frame;
    let from = p - frame.origin;
    let depth = -from.dot(frame.normal) / plate.thickness;
    if !(DEEP..=1.0 - DEEP).contains(&depth) {
        return false;
    }
    let flat = DVec2::new(from.dot(frame.x), from.dot(frame.y));
    let outline: Vec<DVec2> =
        plate.front.iter().zip(&plate.back).map(|(&f, &b)| f.lerp(b, depth)).collect();
    let n = outline.len();
    let sides = || (0..n).map(|i| (outline[i], outline[(i + 1) % n]));
    let is_clear = sides().all(|(a, b)| {
        let along = b - a;
        let t = ((flat - a).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        flat.distance(a + along * t) > DEEP * plate.thickness
    });
    let crossed = sides().filter(|(a, b)| {
        (a.y > flat.y) != (b.y > flat.y)
            && flat.x < a.x + (flat.y - a.y) / (b.y - a.y) * (b.x - a.x)
    });
    is_clear && crossed.count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use kerfold::geom::Frame;
    use kerfold::mesh::FaceId;

    fn slab(at: DVec3) -> Plate {
        let square: Vec<DVec2> =
            [(0., 0.), (9., 0.), (9., 9.), (0., 9.)].into_iter().map(DVec2::from).collect();
        Plate {
            face: FaceId::new(0),
            thickness: 2.0,
            frame: Frame { origin: at, x: DVec3::X, y: DVec3::Y, normal: DVec3::Z },
            half_edges: vec![],
            reference: vec![],
            front: square.clone(),
            back: square.clone(),
            blank: square.clone(),
            inner: square,
            begins: vec![],
            ends: vec![],
            holes: vec![],
        }
    }

    #[test]
    fn plates_that_overlap_are_found_and_those_that_touch_are_not() {
        for (at, is_found) in [
            (DVec3::new(8.99, 3.0, 1.0), true),
            (DVec3::new(9.0, 3.0, 1.0), false),
            (DVec3::new(0.0, 0.0, 2.0), false),
            (DVec3::new(1.0, 1.0, 1.999), true),
        ] {
            assert_eq!(!overlapping(&[slab(DVec3::ZERO), slab(at)]).is_empty(), is_found, "{at}");
        }
    }
}
