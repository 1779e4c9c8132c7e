//! Errors as exceptions with their codes.

use std::fmt::Display;

use kerfold::code::Coded;
use kerfold::recipe::{RecipeError, StepError};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyType;

/// `kerfold.KerfoldError` of a message and a code. The class stands in the Python half, so that type
/// checkers see it.
pub(crate) fn exception(message: &str, code: Option<String>) -> PyErr {
    static CLASS: PyOnceLock<Py<PyType>> = PyOnceLock::new();
    Python::attach(|py| {
        let class = CLASS.import(py, "kerfold._errors", "KerfoldError");
        match class.and_then(|class| class.call1((message, code))) {
            Ok(error) => PyErr::from_value(error),
            Err(error) => error,
        }
    })
}

/// An error of kerfold.
pub(crate) fn coded<E: Display + Coded>(error: &E) -> PyErr {
    exception(&error.to_string(), Some(error.code().to_string()))
}

/// A step that could not be read: there is no text of which line and column would tell a place.
pub(crate) fn unread(error: &RecipeError) -> PyErr {
    exception(&error.without_place(), Some(error.code().to_string()))
}

/// A step that failed; it is the only one, so its number says nothing.
pub(crate) fn failed(error: &StepError) -> PyErr {
    exception(&error.cause.to_string(), Some(error.code().to_string()))
}

/// What only a fault of ours can bring about.
pub(crate) fn fault(message: &str) -> PyErr {
    PyRuntimeError::new_err(message.to_owned())
}
