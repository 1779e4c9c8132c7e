//! One dimensioned drawing for each pane, as glass and stone shops ask for: sides, diagonals, angles,
//! mitres and holes, with a title block. As one PDF with a page for each pane, and as a DXF for each
//! at true size.
//!
//! A pane is seen from its front, its longest side at the bottom. The shapes of a page are worked out
//! once, in millimetres of paper, and written in both formats.

mod block;
mod dimension;
mod dxf;
mod pdf;
mod shape;

use glam::DVec2;

pub use dxf::pane_dxf;
pub use pdf::panes_pdf;

use self::block::title_block;
use self::dimension::dimensions;
use self::shape::{Pen, Shape};
use crate::geom::polygon::bounds;
use crate::panel::{PanelRow, Plate, Plates, Schedule};

/// A4, lying.
const PAGE: DVec2 = DVec2::new(297.0, 210.0);

/// Free border, and height of the title block, in mm.
const BORDER: f64 = 10.0;
const BLOCK: f64 = 26.0;

/// Room for dimensions around the pane, in mm.
const AROUND: f64 = 24.0;

/// Scales that drawings have: 1 to one of these.
const SCALES: [f64; 12] =
    [1.0, 2.0, 5.0, 10.0, 20.0, 25.0, 50.0, 100.0, 200.0, 250.0, 500.0, 1000.0];

/// The drawing of a pane.
#[derive(Debug, Clone, PartialEq)]
pub struct Pane {
    /// Its name, as on the sheets.
    pub name: String,
    /// Millimetres of the pane to one of paper.
    pub scale: f64,
    /// What is drawn, in millimetres of paper, origin at the lower left, y up.
    shapes: Vec<Shape>,
}

/// Where a pane lies on its page.
struct Place {
    turn: DVec2,
    /// The left end of the bottom side, in mm of the plate: holes are measured from it.
    origin: DVec2,
    middle: DVec2,
    scale: f64,
}

impl Place {
    /// With the longest side of the front at the bottom, as large as a usual scale allows.
    fn of(plate: &Plate) -> Self {
        let sides = (0..plate.begins.len()).map(|i| plate.front_side(i));
        let longest = sides.fold([DVec2::ZERO; 2], |best, [a, b]| {
            // The first of sides that are equally long but for rounding.
            let is_longer = a.distance(b) > best[0].distance(best[1]) * (1.0 + 1e-9);
            if is_longer { [a, b] } else { best }
        });
        let along = (longest[1] - longest[0]).normalize_or(DVec2::X);
        let turn = DVec2::new(along.x, -along.y);
        let all = plate.front.iter().chain(&plate.back).chain(&plate.blank);
        let turned: Vec<DVec2> = all.map(|&p| turn.rotate(p)).collect();
        let (low, high) = bounds(&turned).unwrap_or_default();
        let room =
            PAGE - DVec2::new(2.0 * BORDER, 2.0 * BORDER + BLOCK) - DVec2::splat(2.0 * AROUND);
        let least = ((high - low) / room).max_element();
        let scale = SCALES.into_iter().find(|&s| s >= least).unwrap_or_else(|| least.ceil());
        Self { turn, origin: longest[0], middle: low.midpoint(high), scale }
    }

    /// A flat point of the pane on the page.
    fn at(&self, p: DVec2) -> DVec2 {
        let centre = DVec2::new(PAGE.x / 2.0, (PAGE.y + BLOCK) / 2.0);
        centre + (self.turn.rotate(p) - self.middle) / self.scale
    }

    fn all(&self, points: &[DVec2]) -> Vec<DVec2> {
        points.iter().map(|&p| self.at(p)).collect()
    }
}

/// The drawings of all panes, in their order; `title` is the name of the project.
///
/// # Example
/// ```
/// use kerfold::io::panes::{pane_drawings, panes_pdf};
/// use kerfold::panel::{PanelParams, plates, schedule};
/// use kerfold::prelude::*;
///
/// let cube = kerfold::shape::cube(200.0);
/// let params = PanelParams::default();
/// let made = plates(&cube, Length::from_mm(5.0), &params, &Silent)?;
/// let list = schedule(&cube, &made, &params, &Silent)?;
/// let panes = pane_drawings(&list, &made, "cube");
/// assert_eq!(panes.len(), 6);
/// assert!(panes_pdf(&panes, "my program").starts_with(b"%PDF"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn pane_drawings(schedule: &Schedule, plates: &Plates, title: &str) -> Vec<Pane> {
    let rows = schedule.panels.iter().zip(&plates.plates);
    rows.map(|(row, plate)| pane(row, plate, title)).collect()
}

fn pane(row: &PanelRow, plate: &Plate, title: &str) -> Pane {
    let place = Place::of(plate);
    let mut shapes = Vec::new();
    if is_bevelled(plate) {
        shapes.push(Shape::outline(Pen::Back, place.all(&plate.back)));
    }
    shapes.push(Shape::outline(Pen::Front, place.all(&plate.front)));
    for hole in &plate.holes {
        let (centre, radius) = (place.at(hole.centre), hole.radius / place.scale);
        shapes.push(Shape::Circle { pen: Pen::Hole, centre, radius });
    }
    shapes.extend(dimensions(row, plate, &place));
    shapes.extend(title_block(row, plate, (title, place.scale)));
    Pane { name: row.id.to_string(), scale: place.scale, shapes }
}

/// Whether the back of a plate is another outline than its front.
pub fn is_bevelled(plate: &Plate) -> bool {
    let size = plate.front.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
    let differs = |(a, b): (&DVec2, &DVec2)| a.distance(*b) > 1e-9 * size;
    plate.front.len() != plate.back.len() || plate.front.iter().zip(&plate.back).any(differs)
}

#[cfg(test)]
mod tests;
