//! Errors as exceptions that carry code, place and hint.

use hyperplan::Error;
use pyo3::exceptions::{PyException, PyFileNotFoundError};
use pyo3::prelude::*;
use pyo3::{PyErr, create_exception};

create_exception!(
    hyperplan,
    HyperplanError,
    PyException,
    "Why something cannot be done, with a `code` that stays what it is."
);
create_exception!(
    hyperplan,
    ProblemError,
    HyperplanError,
    "A problem has errors: `line`, `column`, `hint` of the first, all in `faults`."
);
create_exception!(
    hyperplan,
    SolverError,
    HyperplanError,
    "A solver is missing, failed, or does not support what was asked."
);
create_exception!(hyperplan, StrategyError, HyperplanError, "Paths are no strategy for the objective.");

/// The exception that an error is.
pub(crate) fn raised(py: Python<'_>, error: &Error) -> PyErr {
    let words = error.to_string();
    let raised = match error {
        Error::Read { path, .. } if !path.exists() => PyFileNotFoundError::new_err(words),
        Error::Faulty(_) | Error::NoObjective { .. } | Error::Constant { .. } | Error::Built { .. } => {
            ProblemError::new_err(words)
        }
        Error::Solver(_) | Error::Profile(_) | Error::Search(_) | Error::SearchWith { .. } => {
            SolverError::new_err(words)
        }
        Error::NoStrategy(_) | Error::Incomplete(_) | Error::NotRead(_) => StrategyError::new_err(words),
        _ => HyperplanError::new_err(words),
    };
    // An exception without its attributes is one all the same.
    let _ = attributes(py, &raised, error);
    raised
}

fn attributes(py: Python<'_>, raised: &PyErr, error: &Error) -> PyResult<()> {
    let value = raised.value(py);
    value.setattr("code", error.code())?;
    let first = error.faults().first();
    let span = first.and_then(|fault| fault.span.as_ref());
    value.setattr("file", first.map(|fault| fault.file.as_str()))?;
    value.setattr("line", span.map(|span| span.line))?;
    value.setattr("column", span.map(|span| span.column))?;
    value.setattr("hint", first.and_then(|fault| fault.help.as_deref()))?;
    let json = serde_json::to_string(error.faults()).unwrap_or_else(|_| "[]".to_owned());
    value.setattr("faults", loads(py, &json)?)
}

/// A JSON text as Python has it.
pub(crate) fn loads<'py>(py: Python<'py>, json: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.call_method1("loads", (json,))
}
