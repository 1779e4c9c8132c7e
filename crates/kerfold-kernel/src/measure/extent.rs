//! How large things are: faces, surfaces, volumes, models.

use glam::DVec3;

use crate::geom::{Double, Frame, Plane, triangulate, triple_product};
use crate::mesh::{FaceId, Mesh};

/// The area of a face by its Newell vector; for a face that is not planar, of its projection along
/// the Newell normal.
pub fn face_area(mesh: &Mesh, f: FaceId) -> f64 {
    area_vector(&mesh.face_positions(f)).length()
}

/// The centroid of a face's area; the mean of the corners when it has no area.
pub fn face_centroid(mesh: &Mesh, f: FaceId) -> DVec3 {
    let corners = mesh.face_positions(f);
    let Some(plane) = Plane::newell(&corners) else {
        return corners.iter().sum::<DVec3>() / corners.len() as f64;
    };
    let frame = Frame::on_plane(&plane);
    let flat: Vec<_> = corners.iter().map(|&p| frame.flatten(p)).collect();
    frame.lift(crate::geom::polygon::centroid(&flat))
}

/// The largest distance between two corners of a face.
pub fn face_diameter(mesh: &Mesh, f: FaceId) -> f64 {
    let corners = mesh.face_positions(f);
    let pairs = corners
        .iter()
        .enumerate()
        .flat_map(|(i, &a)| corners[..i].iter().map(move |&b| a.distance_squared(b)));
    pairs.fold(0.0, f64::max).sqrt()
}

/// The width of a face over its longest diagonal or side, twice its area over that: the height of
/// a triangle. 0 for a face without area.
pub fn face_width(mesh: &Mesh, f: FaceId) -> f64 {
    let diameter = face_diameter(mesh, f);
    if diameter > 0.0 { 2.0 * face_area(mesh, f) / diameter } else { 0.0 }
}

/// The area of all faces, holes not counted.
pub fn surface_area(mesh: &Mesh) -> f64 {
    mesh.faces().map(|f| face_area(mesh, f)).sum()
}

/// The signed volume enclosed by the faces; holes are closed as if by a fan. Positive when the
/// faces look outwards. Right to the last digits of the given positions, for needles and far from
/// the origin, too.
///
/// # Example
/// ```
/// let cube = kerfold_kernel::shape::cube(10.0);
/// assert!((kerfold_kernel::measure::volume(&cube) - 1000.0).abs() < 1e-9);
/// ```
pub fn volume(mesh: &Mesh) -> f64 {
    let Some((low, high)) = mesh.bounds() else { return 0.0 };
    let centre = low.midpoint(high);
    let mut sum = Double::default();
    let mut corners: Vec<DVec3> = Vec::new();
    for f in mesh.faces_and_holes() {
        corners.clear();
        corners.extend(mesh.face_vertices(f).map(|v| mesh.position(v)));
        match mesh.carried_plane(f).filter(|_| folds_over(&corners)) {
            Some(plane) => {
                let frame = Frame::on_plane(&plane);
                let flat: Vec<_> = corners.iter().map(|&p| frame.flatten(p)).collect();
                let triangles = triangulate(&flat).into_iter().map(|t| t.map(|i| corners[i]));
                triangles.for_each(|t| sum = sum.plus(triple_product(centre, t)));
            }
            None => {
                let fan = corners.windows(2).skip(1).map(|w| [corners[0], w[0], w[1]]);
                fan.for_each(|t| sum = sum.plus(triple_product(centre, t)));
            }
        }
    }
    sum.value() / 6.0
}

/// Whether the fan from the first corner covers much more than the polygon, so that what its
/// corners are off their plane by would count many times. Only faces that carry a plane are cut
/// another way: for others the volume would depend on how.
fn folds_over(corners: &[DVec3]) -> bool {
    let Some((&first, rest)) = corners.split_first().filter(|_| corners.len() > 4) else {
        return false;
    };
    let fan = || rest.windows(2).map(|w| doubled_area([first, w[0], w[1]]));
    fan().map(DVec3::length).sum::<f64>() > 4.0 * fan().sum::<DVec3>().length()
}

/// The model's extent along the three axes; zero without vertices.
pub fn size(mesh: &Mesh) -> DVec3 {
    mesh.bounds().map_or(DVec3::ZERO, |(low, high)| high - low)
}

fn area_vector(corners: &[DVec3]) -> DVec3 {
    let Some(&first) = corners.first() else { return DVec3::ZERO };
    corners.windows(2).map(|w| doubled_area([first, w[0], w[1]])).sum::<DVec3>() / 2.0
}

/// Twice the area vector of a triangle, from its two shortest sides: rounding is relative to their
/// product, so that a needle keeps its digits however far it reaches.
fn doubled_area([a, b, c]: [DVec3; 3]) -> DVec3 {
    let sides = [b - a, c - b, a - c];
    let lengths = sides.map(DVec3::length_squared);
    if lengths[0] >= lengths[1].max(lengths[2]) {
        sides[1].cross(sides[2])
    } else if lengths[1] >= lengths[2] {
        sides[2].cross(sides[0])
    } else {
        sides[0].cross(sides[1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_box_far_away_keeps_its_volume() {
        let far = DVec3::new(1e6, -2e6, 3e6);
        let corner = |i: usize| {
            far + DVec3::new((i & 1) as f64 * 2.0, (i >> 1 & 1) as f64 * 3.0, (i >> 2) as f64 * 5.0)
        };
        let faces =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let mesh = Mesh::from_faces((0..8).map(corner), faces).expect("a box");
        assert!((volume(&mesh) - 30.0).abs() < 1e-8);
        assert!((surface_area(&mesh) - 62.0).abs() < 1e-8);
        assert_eq!(size(&mesh), DVec3::new(2.0, 3.0, 5.0));
        let bottom = FaceId::new(0);
        assert!((face_diameter(&mesh, bottom) - 13f64.sqrt()).abs() < 1e-12);
        assert!((face_centroid(&mesh, bottom) - far - DVec3::new(1.0, 1.5, 0.0)).length() < 1e-9);
    }

    #[test]
    fn a_needle_keeps_the_digits_of_its_volume() {
        // A prism over a right triangle with legs of 2^-24, 18 long and askew; its corners are
        // exact.
        let (along, width) = (DVec3::new(16.0, 14.0, -3.0), 2.0_f64.powi(-24));
        let base = [DVec3::ZERO, DVec3::X * width, DVec3::Y * width];
        let points: Vec<DVec3> = base.iter().copied().chain(base.map(|p| p + along)).collect();
        let faces: [&[usize]; 5] =
            [&[0, 1, 2], &[5, 4, 3], &[1, 0, 3, 4], &[2, 1, 4, 5], &[0, 2, 5, 3]];
        let mesh = Mesh::from_faces(points, faces.map(<[usize]>::to_vec)).expect("a prism");
        let exact = 3.0 * width * width / 2.0;
        assert!((volume(&mesh) - exact).abs() < 1e-8 * exact, "{} for {exact}", volume(&mesh));
    }
}
