//! A chain of steps read from TOML, run in order.
