//! Pieces to sheets: kerf, joints, labels, placing, cutting order; knows pieces, never meshes.
