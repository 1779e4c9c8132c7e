//! The command line: arguments, calls, exit codes; one verb, one file.
