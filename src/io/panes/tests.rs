use super::*;
use crate::panel::{PanelParams, plates, schedule};
use crate::progress::Silent;
use crate::shape::cube;
use crate::sheet::plain_lettering;
use crate::units::Length;

fn drawn(params: &PanelParams) -> (Vec<Pane>, Plates) {
    let mesh = cube(200.0);
    let made = plates(&mesh, Length::from_mm(5.0), params, &Silent).expect("plates");
    let list = schedule(&mesh, &made, params, &Silent).expect("a schedule");
    (pane_drawings(&list, &made, "my cube"), made)
}

/// Whether a text stands somewhere on the page, by the shape of its strokes.
fn has(pane: &Pane, text: &str) -> bool {
    let heights = [2.5, 2.0, 2.8, 3.0, 7.0];
    let texts: Vec<&Vec<DVec2>> = pane
        .shapes
        .iter()
        .filter_map(|s| match s {
            Shape::Line { pen: Pen::Text, points, .. } => Some(points),
            _ => None,
        })
        .collect();
    heights.iter().any(|&height| {
        let letters = plain_lettering(text, height).expect("letters").strokes;
        texts.windows(letters.len()).any(|window| {
            // Lengths and distances from the first point are kept by every turn.
            window.iter().zip(&letters).all(|(found, wanted)| {
                found.len() == wanted.len()
                    && found.iter().zip(wanted).all(|(p, q)| {
                        let (from, to) = (window[0][0], letters[0][0]);
                        (p.distance(from) - q.distance(to)).abs() < 1e-6
                    })
            })
        })
    })
}

#[test]
fn a_pane_tells_sides_diagonals_angles_and_mitres() {
    let (panes, made) = drawn(&PanelParams::default());
    let plate = &made.plates[0];
    let [a, b] = plate.front_side(0);
    let side = dimension::tenths(a.distance(b));
    let diagonal = dimension::tenths(plate.front[0].distance(plate.front[plate.begins[2]]));
    for text in [side.as_str(), diagonal.as_str(), "90.0°", "P01", "MY CUBE"] {
        assert!(has(&panes[0], text), "{text}");
    }
    assert!(has(&panes[0], "E000  45.0° OFF SQUARE") || has(&panes[0], "E001  45.0° OFF SQUARE"));
    assert!(!has(&panes[0], "91.0°"));
    assert!(panes[0].shapes.iter().any(|s| s.pen() == Pen::Back), "the back of a bevelled plate");
}

#[test]
fn everything_stays_on_the_page_and_no_pane_on_the_block() {
    let (panes, _) = drawn(&PanelParams::default());
    for pane in &panes {
        for shape in &pane.shapes {
            let points = match shape {
                Shape::Line { points, .. } => points.clone(),
                Shape::Circle { centre, .. } => vec![*centre],
            };
            let is_on = |p: &DVec2| p.min_element() >= 0.0 && p.cmple(PAGE).all();
            assert!(points.iter().all(is_on), "{shape:?}");
            let is_pane = matches!(shape.pen(), Pen::Front | Pen::Back);
            assert!(!is_pane || points.iter().all(|p| p.y > BORDER + BLOCK), "{shape:?}");
        }
    }
}

#[test]
fn the_dxf_is_at_true_size() {
    let (panes, made) = drawn(&PanelParams::default());
    let text = pane_dxf(&panes[0], "kerfold");
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let at = lines.windows(2).position(|w| w == ["8", "FRONT"]).expect("the front");
    let xs: Vec<f64> = lines[at..]
        .windows(2)
        .filter(|w| w[0] == "10")
        .take(4)
        .map(|w| w[1].parse().expect("a number"))
        .collect();
    let [a, b] = made.plates[0].front_side(0);
    let width =
        xs.iter().fold(f64::MIN, |a, &b| a.max(b)) - xs.iter().fold(f64::MAX, |a, &b| a.min(b));
    assert!((width - a.distance(b)).abs() < 1e-3, "{width}");
}
