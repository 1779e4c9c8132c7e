//! The selection language: which vertices, edges, faces.
