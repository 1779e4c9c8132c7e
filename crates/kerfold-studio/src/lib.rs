//! The studio of kerfold: a server on this machine alone and the page that it serves, on which a
//! model is marked, cut and seen beside its sheets.
//!
//! What it can do stands in `openapi.json`, which it serves as a page at `/api.html`. Every list of
//! steps is a [`kerfold::recipe::Session`]; nothing of the geometry is done here.

mod api;
mod args;
mod encode;
mod error;
mod guard;
mod page;
mod paths;
mod schema;
mod server;
mod studio;
mod tab;
mod zip;

pub use args::Args;
pub use encode::{MAGIC, mesh_bytes};
pub use error::StudioError;
pub use schema::json_schema;
pub use server::{Serving, serve};
pub use studio::{Studio, StudioOptions};
