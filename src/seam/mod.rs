//! Seam sets of a mesh as graphs: matchings, 2-factors, Hamiltonian cycles.
