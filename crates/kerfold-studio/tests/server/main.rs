//! The server as other programs meet it: by HTTP, from outside.

mod harness;
mod hostile;
mod recipes;
