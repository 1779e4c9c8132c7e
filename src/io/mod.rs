//! Files in and out, one direction of one format per file.

mod layout_json;
mod svg;

pub use layout_json::write_layout_json;
pub use svg::write_svg;
