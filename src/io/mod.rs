//! Files in and out, one direction of one format per file.
//!
//! [`read_mesh`] reads OBJ, PLY, STL, OFF, GLB and 3MF, [`write_mesh`] writes all but GLB, and DXF;
//! `-` is standard output and means OBJ. Everything that kerfold writes goes through [`output`], so
//! that a file is whole or not there.

mod base64;
pub mod bloom_fold;
pub mod bloom_glb;
mod csv_cell;
mod error;
mod fault;
mod format;
pub mod map_files;
mod number;
pub mod order_artwork;
pub mod order_json;
pub mod output;
pub mod panels_csv;
pub mod panels_json;
pub mod panels_xlsx;
pub mod panes;
pub mod pieces_json;
pub mod planes_csv;
mod read;
pub mod report;
pub mod sheet;
mod write;

pub use error::{ContentFault, IoError, Place};
pub use format::MeshFormat;
pub(crate) use number::xml as escaped;
pub use read::artwork;
pub use read::{
    MeshUnit, ReadMesh, ReadNote, ReadOptions, decode_text, read_curves, read_curves_bytes,
    read_mesh, read_mesh_bytes, read_points, read_points_bytes, read_seams, read_seams_bytes,
    read_text, repair_mesh_bytes, size_note,
};
pub use write::glb;
pub use write::plates;
pub use write::step;
pub use write::{PlyEncoding, WriteOptions, file_note, mesh_bytes, write_mesh};
