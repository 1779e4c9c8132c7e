//! The native half of the Python package: steps are listed and carried out, meshes, nets and plates
//! go in and out as arrays. It knows no operator by name; `python/kerfold` makes methods of the
//! steps and classes of the rest.

mod arrays;
mod files;
mod job;
mod net;
mod plates;
mod steps;
mod trouble;
mod values;
mod work;

use pyo3::prelude::*;

/// kerfold without its classes; the package `kerfold` has these.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::files::{write_file, write_folder};
    #[pymodule_export]
    use super::job::Job;
    #[pymodule_export]
    use super::job::run_recipe;
    #[pymodule_export]
    use super::steps::{explain, nearest, shell_line, shell_text, solid_names, steps};
    #[pymodule_export]
    use super::work::on_progress;

    use super::{Bound, PyModule, PyModuleMethods, PyResult};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
