//! Makes Menger's sponge and tells what it is, round by round: `cargo run --example sponge`.

#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;

use kerfold::measure::{genus, volume};
use kerfold::op::{MengerParams, OpContext, menger};
use kerfold::shape::{SolidParams, solid};
use kerfold::units::Length;

fn main() -> Result<(), Box<dyn Error>> {
    let cube = solid(&SolidParams {
        name: "cube".parse()?,
        edge: Some(Length::from_mm(90.0)),
        size: None,
    })?;
    for rounds in 1..=2 {
        let params = MengerParams { rounds, exact: true, ..MengerParams::default() };
        let (sponge, _) = menger(&cube, &params, &OpContext::default())?;
        let share = volume(&sponge) / volume(&cube);
        println!(
            "round {rounds}: {} faces, genus {}, {share:.6} of the cube",
            sponge.face_count(),
            genus(&sponge)
        );
    }
    Ok(())
}
