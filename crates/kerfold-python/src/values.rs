//! Values of Python as values of keys.

use kerfold::recipe::Value;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyList, PyString, PyTuple};

/// Keys with their values, in their order.
pub(crate) type Fields<'py> = Vec<(String, Bound<'py, PyAny>)>;

/// What was given, as a recipe would have it.
pub(crate) fn fields(given: &Fields<'_>) -> PyResult<Vec<(String, Value)>> {
    given.iter().map(|(key, value)| Ok((key.clone(), of(key, value)?))).collect()
}

fn of(key: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    // A truth value is a number in Python, so it is asked for first.
    if let Ok(is_on) = value.cast::<PyBool>() {
        return Ok(Value::from(is_on.is_true()));
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(Value::from(value.extract::<i64>()?));
    }
    if value.is_instance_of::<PyFloat>() {
        return Ok(Value::from(value.extract::<f64>()?));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(Value::from(value.extract::<String>()?));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let items = value.try_iter()?;
        let items = items.map(|item| of(key, &item?)).collect::<PyResult<Vec<_>>>()?;
        return Ok(Value::Array(items));
    }
    let kind = value.get_type().name()?;
    Err(PyTypeError::new_err(format!(
        "`{key}` is a {kind}; it takes a text, a number, True or False, or a list of these"
    )))
}
