//! Mesh to pieces: seams, flattening, overlap, proof by refolding.
