//! Unfolds a dodecahedron into two pieces, proves them, and prints the sheet as SVG: `cargo run
//! --example two_pieces > sheet.svg`.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example prints")]

use std::error::Error;

use kerfold::io::sheet::svg::write_svg;
use kerfold::progress::Silent;
use kerfold::shape::{SolidParams, solid};
use kerfold::sheet::{Joint, JointParams, SheetParams, StockParams, lay_out};
use kerfold::unfold::{MeshSource, Seams, UnfoldParams, prove, unfold};
use kerfold::units::Length;

fn main() -> Result<(), Box<dyn Error>> {
    let model = solid(&SolidParams {
        name: "dodecahedron".parse()?,
        edge: Some(Length::from_mm(60.0)),
        size: None,
    })?;
    let params = UnfoldParams { pieces: "2".parse()?, ..UnfoldParams::default() };
    let net = unfold(
        &model,
        &Seams::Free,
        &params,
        &MeshSource { scale: 1.0, split_vertices: &[] },
        &Silent,
    )?;
    let proof = prove(&model, &net)?;
    eprintln!(
        "{} pieces, {} overlaps, folds up to {:.0e} mm",
        net.pieces.len(),
        proof.overlaps,
        proof.refold_mm
    );
    let sheet = SheetParams {
        joint: JointParams { kind: Joint::Flaps, ..JointParams::default() },
        stock: StockParams { kerf: Length::from_mm(0.15), ..StockParams::default() },
        ..SheetParams::default()
    };
    let set = lay_out(&net, &sheet)?;
    print!("{}", write_svg(&set.drawings[0], sheet.files.preset, "two_pieces"));
    Ok(())
}
