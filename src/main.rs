//! The kerfold command; everything happens in the library's `cli` module.

use std::process::ExitCode;

/// Large tables come and go in this program; this allocator hands their memory on instead of asking
/// the system for it each time.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    kerfold::cli::run()
}
