//! Where in a picture the model stands.

use glam::DVec2;

use super::camera::Window;
use super::legend::Legend;

/// The margin around the model, as a part of the smaller side of the picture.
const MARGIN: f64 = 0.06;

/// The part of the picture for the model, beside the legend.
pub(super) fn window(width: u32, height: u32, has_legend: bool) -> Window {
    let size = DVec2::new(f64::from(width), f64::from(height));
    let margin = DVec2::splat(size.min_element() * MARGIN);
    let beside = DVec2::new(if has_legend { Legend::width(width, height) } else { 0.0 }, 0.0);
    Window { low: margin, high: size - margin - beside }
}
