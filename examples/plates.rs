//! Turns a truncated icosahedron into glass plates and prints its cutting list: `cargo run
//! --example plates`.

#![allow(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;

use kerfold::panel::{PanelParams, plates, schedule};
use kerfold::progress::Silent;
use kerfold::shape::{SolidParams, solid};
use kerfold::units::Length;

fn main() -> Result<(), Box<dyn Error>> {
    let model = solid(&SolidParams {
        name: "soccer-ball".parse()?,
        edge: None,
        size: Some(Length::from_mm(4000.0)),
    })?;
    let params = PanelParams { gap: Length::from_mm(8.0), ..PanelParams::default() };
    let made = plates(&model, Length::from_mm(10.0), &params, &Silent)?;
    let list = schedule(&model, &made, &params, &Silent)?;
    for group in &list.groups {
        println!("{} plates like {}", group.panels.len(), group.first);
    }
    println!("{:.0} kg, nodes off by {:.1e} mm at most", list.totals.mass, list.totals.miss_mm);
    Ok(())
}
