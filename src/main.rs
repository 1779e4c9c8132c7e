//! The kerfold command.
fn main() {}
