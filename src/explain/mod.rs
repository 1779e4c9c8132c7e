//! What every code of an error or a finding means and what to do about it.
//!
//! The pages stand in `docs/errors.md`, two sentences each; they are part of the program, so that
//! `kerfold explain` needs no file.

mod page;

pub use page::{Page, pages};
