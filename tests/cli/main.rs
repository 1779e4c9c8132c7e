//! The program as users meet it: exit codes, messages, pipes, and files that are whole or not
//! there. What holds for every verb stands in `every_verb`, the rest by verb.

mod check;
mod dform;
mod every_verb;
mod explain;
mod gallery;
mod harness;
mod help;
mod hull;
mod lint;
mod nest;
mod notices;
mod panelize;
mod recipe;
mod rows;
mod seams;
mod streams;
#[cfg(unix)]
mod studio;
mod threads;
mod unfold;
mod verify;
mod words;
