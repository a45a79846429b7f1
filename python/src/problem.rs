//! Problems and outcomes.

use crate::error::{loads, raised};
use crate::options::{Search, Wanted};
use hyperplan::answer::WitnessPath;
use hyperplan::draw::{Kind, Subject};
use hyperplan::{EmitConfig, Error, Objective, Reading, Status, Track, Verification};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::{Value, json};
use std::path::PathBuf;

/// A problem without errors.
#[pyclass(frozen, module = "hyperplan._native")]
pub(crate) struct Problem(hyperplan::Problem);

impl Problem {
    pub(crate) fn new(problem: hyperplan::Problem) -> Problem {
        Problem(problem)
    }
}

/// The objective of that name, or the only one.
fn objective<'p>(problem: &'p hyperplan::Problem, name: Option<&str>) -> Result<Objective<'p>, Error> {
    name.map_or_else(|| problem.only_objective(), |name| problem.objective(name))
}

fn text(value: &Value) -> String {
    value.to_string()
}

#[pymethods]
impl Problem {
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Problem> {
        let loaded = py.detach(|| hyperplan::Problem::load(path));
        loaded.map(Problem).map_err(|error| raised(py, &error))
    }

    #[staticmethod]
    #[pyo3(signature = (paths, bound, semantics, dialect))]
    fn load_foreign(
        py: Python<'_>,
        paths: Vec<PathBuf>,
        bound: Option<u32>,
        semantics: Option<String>,
        dialect: Option<&str>,
    ) -> PyResult<Problem> {
        let named = |name: &str| hyperplan::Dialect::ALL.into_iter().find(|dialect| dialect.name() == name);
        let none = || PyValueError::new_err("there is no such dialect");
        let dialect = dialect.map(|name| named(name).ok_or_else(none)).transpose()?;
        let reading = Reading { bound, semantics, dialect, status: None };
        let loaded = py.detach(|| hyperplan::Problem::load_foreign(&paths, reading));
        loaded.map(Problem).map_err(|error| raised(py, &error))
    }

    fn with_constant(&self, py: Python<'_>, name: &str, value: &str) -> PyResult<Problem> {
        let with = py.detach(|| self.0.with(name, value));
        with.map(Problem).map_err(|error| raised(py, &error))
    }

    fn objectives(&self) -> Vec<&str> {
        self.0.objectives()
    }

    fn constants(&self) -> Vec<(String, String)> {
        let shown = |value: &hyperplan::typed::Value| match value {
            hyperplan::typed::Value::Int(n) => n.to_string(),
            hyperplan::typed::Value::Real(fraction) => fraction.to_string(),
            other => format!("{other:?}"),
        };
        self.0.constants().iter().map(|(name, value)| (name.clone(), shown(value))).collect()
    }

    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loads(py, &text(&json!(self.0.warnings())))
    }

    fn text(&self) -> Option<&str> {
        self.0.text()
    }

    fn save(&self, py: Python<'_>, folder: PathBuf, name: &str) -> PyResult<PathBuf> {
        self.0.save(folder, name).map_err(|error| match error {
            Error::Write { .. } => PyOSError::new_err(error.to_string()),
            error => raised(py, &error),
        })
    }

    fn solve(&self, py: Python<'_>, name: Option<String>, options: Wanted) -> PyResult<Outcome> {
        let problem = self.0.clone();
        Search::new(py, options)?.run(py, move |options| {
            let objective = objective(&problem, name.as_deref())?;
            let (name, outcome) = (objective.name().to_owned(), objective.solve(options)?);
            Ok(Outcome { problem, name, outcome })
        })
    }

    /// The least value, if one was found, whether it is proved to be that, the problem with it and the outcome.
    fn minimize(
        &self,
        py: Python<'_>,
        name: Option<String>,
        constant: String,
        range: Option<(i64, i64)>,
        options: Wanted,
    ) -> PyResult<(Option<i64>, bool, Problem, Outcome)> {
        let problem = self.0.clone();
        Search::new(py, options)?.run(py, move |options| {
            let objective = objective(&problem, name.as_deref())?;
            let found = objective.minimize(&constant, range.map(|(low, high)| low..=high), options)?;
            let (problem, outcome) = (found.problem, found.outcome);
            let own = Outcome { problem: problem.clone(), name: objective.name().to_owned(), outcome };
            Ok((found.value, found.proved, Problem(problem), own))
        })
    }

    fn verify<'py>(
        &self,
        py: Python<'py>,
        name: Option<String>,
        witness: &str,
        options: Wanted,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (problem, witness) = (self.0.clone(), witness.to_owned());
        let found = Search::new(py, options)?.run(py, move |_| {
            let objective = objective(&problem, name.as_deref())?;
            objective.verify(&objective.read_strategy(&witness)?)
        })?;
        let told = match found {
            Verification::Holds => json!({"verdict": "holds", "reason": null, "paths": []}),
            Verification::Fails { reason, paths } => {
                json!({"verdict": "fails", "reason": reason, "paths": paths})
            }
            _ => json!({"verdict": "unknown", "reason": "it is too large to enumerate", "paths": []}),
        };
        loads(py, &text(&told))
    }

    fn horizon<'py>(&self, py: Python<'py>, name: Option<&str>) -> PyResult<Bound<'py, PyAny>> {
        let objective = objective(&self.0, name).map_err(|error| raised(py, &error))?;
        let each: serde_json::Map<String, Value> =
            objective.horizon_in_words().into_iter().map(|(path, horizon)| (path, json!(horizon))).collect();
        loads(py, &text(&Value::Object(each)))
    }

    #[allow(clippy::too_many_arguments, reason = "they are keywords in Python")]
    fn emit(
        &self,
        py: Python<'_>,
        name: Option<String>,
        date: String,
        quantifiers: Option<&str>,
        states: Option<&str>,
        track: &str,
        status: Option<&str>,
        options: Wanted,
    ) -> PyResult<String> {
        let mut config = EmitConfig::new(date);
        if let Some(text) = quantifiers {
            config.quantifiers = text.parse().map_err(PyValueError::new_err)?;
        }
        config.states = states.map(str::parse).transpose().map_err(PyValueError::new_err)?;
        config.track = match track {
            "single" => Track::Single,
            "incremental" => Track::Incremental,
            "model" => Track::Model,
            "unsat-core" => Track::UnsatCore,
            _ => return Err(PyValueError::new_err("a track is single, incremental, model or unsat-core")),
        };
        config.status = match status {
            None => None,
            Some("sat") => Some(Status::Sat),
            Some("unsat") => Some(Status::Unsat),
            Some("unknown") => Some(Status::Unknown),
            Some(_) => return Err(PyValueError::new_err("a status is sat, unsat or unknown")),
        };
        let problem = self.0.clone();
        Search::new(py, options)?.run(py, move |options| {
            let objective = objective(&problem, name.as_deref())?;
            objective.emit_text(config, options)
        })
    }

    /// A picture of the first system alone.
    fn draw<'py>(&self, py: Python<'py>, kind: &str) -> PyResult<Bound<'py, PyBytes>> {
        let subject = Subject { problem: self.0.typed(), objective: None, strategy: None, named: &[] };
        let drawn = subject.draw(self::kind(kind)?).map_err(|error| raised(py, &Error::Drawing(error)))?;
        Ok(PyBytes::new(py, &drawn))
    }
}

/// An answer for an objective.
#[pyclass(frozen, module = "hyperplan._native")]
pub(crate) struct Outcome {
    problem: hyperplan::Problem,
    name: String,
    outcome: hyperplan::Outcome,
}

#[pymethods]
impl Outcome {
    /// As `solve --format json` prints it.
    fn answer<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        loads(py, &text(&json!(self.outcome.answer)))
    }

    fn paths(&self) -> String {
        let paths: &[WitnessPath] = self.outcome.paths();
        text(&json!({"objective": self.name, "witness": paths}))
    }

    /// A picture of the paths, with the worst of all that they have to cope with; none where there are none.
    fn draw<'py>(&self, py: Python<'py>, kind: &str) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let kind = self::kind(kind)?;
        let Some(strategy) = self.outcome.strategy() else { return Ok(None) };
        let drawn = py.detach(|| self.problem.objective(&self.name)?.draw(strategy, kind));
        Ok(Some(PyBytes::new(py, &drawn.map_err(|error| raised(py, &error))?)))
    }
}

fn kind(name: &str) -> PyResult<Kind> {
    Ok(match name {
        "animated" => Kind::Animated,
        "gif" => Kind::Gif,
        "html" => Kind::Html,
        "pdf" => Kind::Pdf,
        "png" => Kind::Png,
        "svg" => Kind::Svg,
        "txt" => Kind::Text,
        _ => return Err(PyValueError::new_err("pictures are animated, gif, html, pdf, png, svg or txt")),
    })
}
