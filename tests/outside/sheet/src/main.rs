//! Nests ten triangles and a ring, and prints where they lie.

use glam::DVec2;
use kerfold_sheet::net::{MeshCounts, Net, Piece, PieceId, Proof};
use kerfold_sheet::sheet::{SheetParams, lay_out};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let ring = |radius: f64, n: u32| -> Vec<DVec2> {
        (0..n).map(|i| DVec2::from_angle(f64::from(i) * 6.2 / f64::from(n)) * radius).collect()
    };
    let piece = |id, outline, holes| Piece { id: PieceId(id), outline, holes, faces: vec![] };
    let mut pieces: Vec<Piece> = (0..10).map(|i| piece(i, ring(30.0, 3), vec![])).collect();
    let hole = ring(60.0, 40).into_iter().rev().collect();
    pieces.push(piece(10, ring(90.0, 60), vec![hole]));
    let counts = MeshCounts { vertices: 0, edges: 0, faces: 0 };
    let proof = Proof { congruence_mm: 0.0, refold_mm: 0.0, overlaps: 0 };
    let (folds, seams, rims) = (vec![], vec![], vec![]);
    let net = Net { scale: 1.0, counts, pieces, folds, seams, rims, proof };
    let sheets = lay_out(&net, &SheetParams::default())?;
    let placed = sheets.layout.sheets.iter().flat_map(|sheet| &sheet.placed);
    placed.clone().for_each(|p| println!("{} at {:.1}, {:.1} mm", p.piece, p.x, p.y));
    assert_eq!((placed.count(), sheets.drawings.len()), (11, 1));
    Ok(())
}
