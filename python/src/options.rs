//! How to search, from Python; and waiting for a search, so that signals of Python are heard.

use crate::error::{HyperplanError, raised};
use hyperplan::{Cancel, Error, Options, Solvers, Standing};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// How often it is looked whether the user has pressed Ctrl-C.
const TICK: Duration = Duration::from_millis(20);

/// How long a search may take to end after its time is up, or after Ctrl-C; then it is left alone.
const GRACE: Duration = Duration::from_millis(1500);

/// What `solve` and its like are told, as keywords.
#[derive(FromPyObject)]
pub(crate) struct Wanted {
    #[pyo3(item)]
    solver: String,
    #[pyo3(item)]
    profiles: Option<String>,
    #[pyo3(item)]
    quantifiers: Option<String>,
    #[pyo3(item)]
    states: Option<String>,
    #[pyo3(item)]
    timeout: Option<f64>,
    #[pyo3(item)]
    seed: u64,
    #[pyo3(item)]
    memory_mib: Option<u64>,
    #[pyo3(item)]
    first: bool,
    #[pyo3(item)]
    progress: Option<Py<PyAny>>,
    #[pyo3(item)]
    every: f64,
}

/// The options, with what cancels and when the time is up.
pub(crate) struct Search {
    pub(crate) options: Options,
    cancel: Cancel,
    end: Option<Instant>,
}

impl Search {
    pub(crate) fn new(py: Python<'_>, wanted: Wanted) -> PyResult<Search> {
        let mut solvers = Solvers::new();
        if let Some(profiles) = &wanted.profiles {
            solvers.add(profiles).map_err(|error| raised(py, &error))?;
        }
        let cancel = Cancel::new();
        let mut options = Options::new().cancel(&cancel).seed(wanted.seed);
        let mut names = wanted.solver.split(',');
        let find = |name: &str| solvers.find(name).map_err(|error| raised(py, &error));
        options = options.solver(find(names.next().unwrap_or_default())?);
        for name in names {
            options = options.rival(find(name)?);
        }
        if let Some(text) = &wanted.quantifiers {
            options = options.quantifiers(text.parse().map_err(PyValueError::new_err)?);
        }
        if let Some(text) = &wanted.states {
            options = options.states(text.parse().map_err(PyValueError::new_err)?);
        }
        let timeout = wanted.timeout.map(|time| seconds(time, "timeout")).transpose()?;
        if let Some(timeout) = timeout {
            options = options.timeout(timeout);
        }
        if let Some(mib) = wanted.memory_mib {
            options = options.memory_mib(mib);
        }
        if wanted.first {
            options = options.first();
        }
        if let Some(tell) = wanted.progress {
            options =
                options.progress(seconds(wanted.every, "every")?, move |standing| told(&tell, standing));
        }
        Ok(Search { options, cancel, end: timeout.and_then(|time| Instant::now().checked_add(time)) })
    }

    /// Does something in a thread of its own, without the interpreter's lock, until it is done or the user has enough.
    pub(crate) fn run<T: Send + 'static>(
        self,
        py: Python<'_>,
        work: impl FnOnce(&Options) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let (done, mut ended) = channel();
        let options = self.options;
        thread::Builder::new().name("hyperplan".to_owned()).spawn(move || {
            // Who waits no longer is told nothing.
            let _ = done.send(work(&options));
        })?;
        let latest = self.end.and_then(|end| end.checked_add(GRACE));
        loop {
            let found;
            (ended, found) = py.detach(move || {
                let found = ended.recv_timeout(TICK);
                (ended, found)
            });
            match found {
                Ok(found) => return found.map_err(|error| raised(py, &error)),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err("this is a bug in hyperplan; please report it"));
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
            if let Err(signal) = py.check_signals() {
                self.cancel.cancel();
                py.detach(move || ended.recv_timeout(GRACE).map(|_| ())).ok();
                return Err(signal);
            }
            if latest.is_some_and(|latest| Instant::now() > latest) {
                self.cancel.cancel();
                let error = HyperplanError::new_err("the time is up, and the search did not end by itself");
                error.value(py).setattr("code", "timeout")?;
                return Err(error);
            }
        }
    }
}

/// A positive time; too long to count is as good as no end.
fn seconds(time: f64, name: &str) -> PyResult<Duration> {
    if time > 0.0 {
        return Ok(Duration::try_from_secs_f64(time).unwrap_or(Duration::MAX));
    }
    Err(PyValueError::new_err(format!("{name} must be a positive number of seconds, not {time}")))
}

/// Tells Python how far it is. What goes wrong there does not end the search.
fn told(tell: &Py<PyAny>, standing: &Standing) {
    Python::attach(|py| {
        let told = || {
            let facts = PyDict::new(py);
            facts.set_item("words", standing.to_string())?;
            facts.set_item("checks", standing.checks)?;
            facts.set_item("variables", standing.variables)?;
            facts.set_item("best", standing.best)?;
            tell.call1(py, (facts,))
        };
        if let Err(error) = told() {
            error.write_unraisable(py, None);
        }
    });
}
