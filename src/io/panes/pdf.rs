//! Panes as one PDF, a page for each.

use std::fmt::Write as _;

use glam::DVec2;

use super::shape::{Pen, Shape};
use super::{PAGE, Pane};
use crate::io::map_files::pdf_pages;
use crate::io::number::{decimal, push_point};

/// Control points of a quarter circle by a cubic curve, in radii: (4/3)·(√2 − 1).
const QUARTER: f64 = 0.552_284_749_830_793_6;

/// The bytes of the PDF; `command` is the command line that made it.
pub fn panes_pdf(panes: &[Pane], command: &str) -> Vec<u8> {
    pdf_pages([PAGE.x, PAGE.y], panes.iter().map(content), "panes", command)
}

fn content(pane: &Pane) -> String {
    let mut text = format!("{0} 0 0 {0} 0 0 cm 1 J 1 j 0 G\n", 72.0 / 25.4);
    for pen in Pen::ALL {
        let dash = if pen == Pen::Back { "[2 1.5] 0 d" } else { "[] 0 d" };
        let _ = writeln!(text, "{} w {dash}", decimal(pen.width()));
        pane.shapes.iter().filter(|s| s.pen() == pen).for_each(|s| path(&mut text, s));
    }
    text
}

fn path(text: &mut String, shape: &Shape) {
    match shape {
        Shape::Line { points, is_closed, .. } => {
            for (i, &p) in points.iter().enumerate() {
                push_point(text, p);
                *text += if i == 0 { " m " } else { " l " };
            }
            *text += if *is_closed { "s\n" } else { "S\n" };
        }
        Shape::Circle { centre, radius, .. } => {
            push_point(text, *centre + DVec2::X * *radius);
            *text += " m ";
            let mut from = DVec2::X;
            for _ in 0..4 {
                let to = from.perp();
                for d in [from + to * QUARTER, to + from * QUARTER, to] {
                    push_point(text, *centre + d * *radius);
                    text.push(' ');
                }
                *text += "c ";
                from = to;
            }
            *text += "s\n";
        }
    }
}
