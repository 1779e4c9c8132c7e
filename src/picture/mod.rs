//! Pictures of models and sheets as pixels.
