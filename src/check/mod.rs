//! Findings against limits, as data.
