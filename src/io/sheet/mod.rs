//! Sheets in every format that shops take, all made from the same drawing, and where each piece
//! lies.

pub mod dxf;
pub mod files;
pub mod layout;
pub mod lbrn2;
pub mod page;
pub mod pdf;
pub mod svg;
