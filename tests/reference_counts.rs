//! Counts and volumes of the truncations on all solids, against an independent intersection of half-spaces.
