//! Bar charts as SVG inside a page.

use std::fmt::Write as _;

use crate::io::report::page::Chart;

/// Width and height of a chart, and of the room below the bars, in user units.
const SIZE: [f64; 2] = [720.0, 236.0];
const FOOT: f64 = 46.0;
/// The words of a limit stand above the counts.
const HEAD: f64 = 38.0;

/// A chart with a count above every bar that is not empty. Its name is read out by screen readers.
pub(super) fn bars(chart: &Chart) -> String {
    let Chart { name, axis, bars, limit } = chart;
    let [width, height] = SIZE;
    let (base, room) = (height - FOOT, height - FOOT - HEAD);
    let most = bars.iter().map(|b| b.count).max().unwrap_or(0).max(1) as f64;
    let step = width / bars.len().max(1) as f64;
    let thick = (step * 0.84).min(64.0);
    let mut svg = format!(
        "<svg class=\"chart\" viewBox=\"0 0 {width} {height}\" role=\"img\" aria-label=\"{name}\" \
         xmlns=\"http://www.w3.org/2000/svg\">\n"
    );
    for (i, bar) in bars.iter().enumerate() {
        let middle = (i as f64 + 0.5) * step;
        // What is there is seen, be it one of a million.
        let tall = if bar.count == 0 { 0.0 } else { (bar.count as f64 / most * room).max(1.5) };
        let [r, g, b] = bar.colour();
        let _ = write!(
            svg,
            "<rect x=\"{:.2}\" y=\"{:.2}\" width=\"{:.2}\" height=\"{tall:.2}\" \
            fill=\"#{r:02x}{g:02x}{b:02x}\"/>",
            middle - thick / 2.0,
            base - tall,
            thick
        );
        let count = if bar.count == 0 { String::new() } else { bar.count.to_string() };
        if !count.is_empty() {
            let _ = write!(
                svg,
                "<text x=\"{middle:.2}\" y=\"{:.2}\">{count}</text>",
                base - tall - 5.0
            );
        }
        let _ = writeln!(
            svg,
            "<text class=\"tick\" x=\"{middle:.2}\" y=\"{:.2}\">{}</text>",
            base + 15.0,
            bar.label
        );
    }
    let _ = writeln!(svg, "<line x1=\"0\" y1=\"{base}\" x2=\"{width}\" y2=\"{base}\"/>");
    if let Some((at, words)) = *limit {
        let x = at * step;
        let (anchor, shift) = if x > width / 2.0 { ("end", -6.0) } else { ("start", 6.0) };
        let _ = writeln!(
            svg,
            "<line class=\"limit\" x1=\"{x:.2}\" y1=\"2\" x2=\"{x:.2}\" y2=\"{base}\"/>\
             <text class=\"limit\" x=\"{:.2}\" y=\"11\" style=\"text-anchor: \
             {anchor}\">{words}</text>",
            x + shift
        );
    }
    let _ =
        writeln!(svg, "<text x=\"{}\" y=\"{}\">{axis}</text>\n</svg>", width / 2.0, height - 6.0);
    svg
}
