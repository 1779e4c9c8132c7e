//! Ready-made starting meshes.
