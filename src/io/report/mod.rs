//! The report of a check in every form: text, JSON, CSV, and the page with pictures as HTML and
//! PDF.

pub mod csv;
pub mod html;
pub mod json;
pub mod page;
pub mod pdf;
pub mod text;
