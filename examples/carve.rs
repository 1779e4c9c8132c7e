//! Carves a soccer ball, checks the result, and prints it as OBJ: `cargo run --example carve >
//! carved.obj`.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "an example prints")]

use std::error::Error;

use kerfold::check::{CheckParams, check};
use kerfold::io::{MeshFormat, WriteOptions, mesh_bytes};
use kerfold::op::{OpContext, TruncateVertexParams, truncate_vertices};
use kerfold::shape::{SolidParams, solid};
use kerfold::units::Length;

fn main() -> Result<(), Box<dyn Error>> {
    let ball = SolidParams {
        name: "soccer-ball".parse()?,
        edge: None,
        size: Some(Length::from_mm(300.0)),
    };
    let ball = solid(&ball)?;
    let (carved, report) = truncate_vertices(
        &ball,
        &TruncateVertexParams::new("all".parse()?, 0.3),
        &OpContext::default(),
    )?;
    for note in report.notes("vertex") {
        eprintln!("note: {note}");
    }
    let report = check(&carved, &CheckParams::default())?;
    eprintln!("{} faces, off plane by {:.1e} mm at most", report.model.faces, report.worst.mm);
    let text = mesh_bytes(MeshFormat::Obj, &carved, &WriteOptions::default())?;
    print!("{}", String::from_utf8(text)?);
    Ok(())
}
