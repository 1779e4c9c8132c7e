//! The kerfold command; everything happens in the library's `cli` module.

use std::process::ExitCode;

fn main() -> ExitCode {
    kerfold::cli::run()
}
