//! Files in and out, one direction of one format per file.

pub mod planes_csv;
