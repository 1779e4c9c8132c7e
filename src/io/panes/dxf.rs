//! A pane as a DXF at true size: one unit is a millimetre of the pane.

use super::shape::{Pen, Shape};
use super::{PAGE, Pane};
use crate::io::number::decimal;
use crate::io::sheet::dxf::{DxfLayer, Entities, dxf_file};

/// The text of the file; `command` is the command line that made it. Letters and dimension lines are
/// as large as the scale of the drawing makes them; the layers are `FRONT`, `BACK` (dashed), `HOLES`
/// (circles), `DIMENSIONS` and `TEXT`. Dimensions are lines and letters, no DIMENSION entities: those
/// are drawn anew by every program in a style of its own.
pub fn pane_dxf(pane: &Pane, command: &str) -> String {
    let mut entities = Entities::default();
    for shape in &pane.shapes {
        let layer = shape.pen().layer();
        let shown = |mm: f64| decimal(mm * pane.scale);
        match shape {
            Shape::Line { points, is_closed, .. } => {
                let points: Vec<[String; 2]> =
                    points.iter().map(|p| [shown(p.x), shown(p.y)]).collect();
                entities.polyline(layer, &points, *is_closed);
            }
            Shape::Circle { centre, radius, .. } => {
                entities.circle(layer, [shown(centre.x), shown(centre.y)], &shown(*radius));
            }
        }
    }
    let layers = Pen::ALL.map(|pen| DxfLayer {
        name: pen.layer(),
        colour: match pen {
            Pen::Front | Pen::Text => 7,
            Pen::Back => 5,
            Pen::Hole => 1,
            Pen::Dimension => 8,
        },
        weight: 25,
        is_dashed: pen == Pen::Back,
        is_plotted: true,
    });
    let size = [PAGE.x * pane.scale, PAGE.y * pane.scale];
    dxf_file(size, &layers, command, &entities)
}
