//! A façade of planar hexagons with three edges at every inner vertex, for tests and benchmarks.
//!
//! Each panel lies in the plane that touches the surface z = −(x²/a + y²/b)/2 at a point of a
//! triangular lattice. Where the planes of three neighbouring points meet is a vertex; for such a
//! surface that is a linear problem, the same up to a shift for all triangles of one kind, so
//! panels are planar up to rounding (the dual of a lattice on a paraboloid: Wang, Liu, Yan, Chan,
//! Ling and Sun 2008, "Hexagonal meshes with planar faces"). Radii of opposite signs make a saddle,
//! whose hexagons are concave.

use glam::{DMat2, DVec2, DVec3};

use crate::mesh::Mesh;

/// A façade of `columns` × `rows` hexagons whose lattice points are `pitch` mm apart; `radii` are
/// those of the surface at its top along x and y, in mm, not zero. Looks up (+z); panels are
/// numbered row by row.
///
/// # Panics
/// When there is no panel, or a radius is so short that planes do not meet.
pub fn hexagonal_facade(columns: usize, rows: usize, pitch: f64, radii: [f64; 2]) -> Mesh {
    assert!(columns > 0 && rows > 0, "a façade has at least one panel");
    let bend = DVec2::new(1.0 / radii[0], 1.0 / radii[1]);
    let middle = DVec2::new(columns as f64 + 1.5, (rows as f64 + 1.0) * ROW) / 2.0;
    // One lattice point more on all sides; odd rows are shifted by half a pitch.
    let site = |i: usize, j: usize| {
        let shift = if j.is_multiple_of(2) { 0.0 } else { 0.5 };
        (DVec2::new(i as f64 + shift, j as f64 * ROW) - middle) * pitch
    };
    let (width, height) = (columns + 2, rows + 2);
    let mut points = Vec::with_capacity(2 * width * height);
    let mut number = vec![usize::MAX; 2 * width * height];
    let mut corner = |triangle: usize, sites: [(usize, usize); 3]| {
        if number[triangle] == usize::MAX {
            number[triangle] = points.len();
            points.push(meet(sites.map(|(i, j)| site(i, j)), bend));
        }
        number[triangle]
    };
    let mut faces = Vec::with_capacity(columns * rows);
    for j in 1..=rows {
        for i in 1..=columns {
            // Neighbours counter-clockwise from the right.
            let s = usize::from(!j.is_multiple_of(2));
            let around = [
                (i + 1, j),
                (i + s, j + 1),
                (i + s - 1, j + 1),
                (i - 1, j),
                (i + s - 1, j - 1),
                (i + s, j - 1),
            ];
            let face: Vec<usize> = (0..6)
                .map(|k| {
                    let mut sites = [(i, j), around[k], around[(k + 1) % 6]];
                    sites.sort_by_key(|&(i, j)| (j, i));
                    // Two triangles belong to every lattice point: those of which it is the first
                    // in this order.
                    let (first, is_upright) = (sites[0], sites[0].1 != sites[1].1);
                    corner(2 * (first.1 * width + first.0) + usize::from(is_upright), sites)
                })
                .collect();
            faces.push(face);
        }
    }
    Mesh::from_faces(points, faces).expect("the dual of a lattice is a surface")
}

/// Distance of two rows of a triangular lattice, in pitches.
const ROW: f64 = 0.866_025_403_784_438_6;

/// Where the planes that touch the surface above three points meet. Above s the plane is z =
/// (s·Bs)/2 − s·Bx with B = diag(bend).
fn meet([r, s, t]: [DVec2; 3], bend: DVec2) -> DVec3 {
    let (u, v) = ((s - r) * bend, (t - r) * bend);
    let rows = DMat2::from_cols(u, v).transpose();
    let square = |p: DVec2| p.dot(p * bend) / 2.0;
    let x = rows.inverse() * DVec2::new(square(s) - square(r), square(t) - square(r));
    assert!(x.is_finite(), "the planes of three neighbours do not meet");
    x.extend(square(r) - r.dot(x * bend))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{planarity, size};
    use crate::mesh::assert_sound;

    #[test]
    fn panels_are_planar_hexagons_with_three_edges_at_inner_vertices() {
        for radii in [[30_000.0, 20_000.0], [20_000.0, -15_000.0]] {
            let mesh = hexagonal_facade(12, 9, 1000.0, radii);
            assert_sound(&mesh);
            assert_eq!((mesh.face_count(), mesh.hole_count()), (108, 1));
            assert!(
                mesh.faces().all(|f| mesh.sides(f) == 6 && planarity(&mesh, f).permille < 1e-9)
            );
            assert!(
                mesh.vertices().all(
                    |v| mesh.valence(v) == 3 || (mesh.is_rim_vertex(v) && mesh.valence(v) == 2)
                )
            );
            let looks_up = |f| mesh.plane(f).expect("an area").normal().z > 0.5;
            assert!(mesh.faces().all(looks_up), "{radii:?}");
            assert!(size(&mesh).x > 11_000.0);
        }
    }
}
