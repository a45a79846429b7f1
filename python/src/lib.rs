//! The library for Python: thin wrappers, to which `hyperplan/*.py` gives its shape. Paths and answers come as JSON.

mod error;
mod options;
mod problem;
mod system;

use pyo3::pymodule;

#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::error::{HyperplanError, ProblemError, SolverError, StrategyError};
    #[pymodule_export]
    use crate::problem::{Outcome, Problem};
    #[pymodule_export]
    use crate::system::{Graph, System, build};

    #[pymodule_export]
    const VERSION: &str = env!("CARGO_PKG_VERSION");
}
