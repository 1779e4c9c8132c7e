//! Files in and out, one direction of one format per file.

pub mod report_csv;
pub mod report_json;
pub mod report_text;
