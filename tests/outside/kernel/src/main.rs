//! The solid half-way between a cube and an octahedron: the hull of the means of their corners.

use kerfold_kernel::geom::hull::{Numbers, convex_hull};
use kerfold_kernel::measure::{convexity, volume};
use kerfold_kernel::mesh::MeshBuilder;
use kerfold_kernel::shape::{cube, octahedron};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (a, b) = (cube(2.0), octahedron(2.0));
    let mut points = Vec::new();
    for p in a.vertices().map(|v| a.position(v)) {
        points.extend(b.vertices().map(|v| (p + b.position(v)) / 2.0));
    }
    let hull = convex_hull(&points, Numbers::Constructed)?;
    let mut builder = MeshBuilder::new();
    for &point in &points {
        builder.vertex(point);
    }
    for face in hull.iter() {
        builder.face(face.iter().map(|&v| v as usize));
    }
    let (mesh, _) = builder.build()?;
    println!("{} faces, volume {:.6}, {:?}", mesh.face_count(), volume(&mesh), convexity(&mesh));
    assert!(mesh.is_closed() && mesh.face_count() == 26);
    Ok(())
}
