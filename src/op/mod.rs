//! Modelling operators, mesh in, mesh out; one operator, one file.
