//! Files in and out, one direction of one format per file.
//!
//! [`read_mesh`] reads OBJ, PLY, STL and OFF, [`write_mesh`] writes them; `-` is standard input or
//! output and means OBJ. Everything that kerfold writes goes through [`output`], so that a file is
//! whole or not there.

mod base64;
pub mod bloom_glb;
pub mod dxf;
mod error;
mod format;
pub mod layout_json;
pub mod lbrn2;
pub mod map_files;
mod number;
pub mod order_json;
pub mod output;
pub mod panels_csv;
pub mod panels_json;
pub mod pdf;
pub mod pieces_json;
pub mod planes_csv;
mod read;
pub mod report_csv;
pub mod report_html;
pub mod report_json;
pub mod report_page;
pub mod report_pdf;
pub mod report_text;
pub mod sheet_files;
pub mod svg;
mod write;

pub use error::{ContentFault, IoError, Place};
pub use format::MeshFormat;
pub(crate) use number::xml as escaped;
pub use read::artwork;
pub use read::{
    MeshUnit, ReadMesh, ReadNote, ReadOptions, read_mesh, read_mesh_bytes, read_points, read_seams,
};
pub use write::glb;
pub use write::plates;
pub use write::step;
pub use write::{PlyEncoding, WriteOptions, mesh_bytes, write_mesh};
