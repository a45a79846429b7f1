//! A problem: from a file, a text, files of other tools, or built in code.

mod objective;

pub use objective::{Minimized, Objective};

use crate::build::Builder;
use crate::disk::{self, read_bytes, reason};
use crate::error::{Error, Faults};
use crate::foreign::{Foreign, is_foreign, text_of};
use crate::source::{Files, Source, of_kind};
use hyperplan_import::{Input, Options as Reading};
use hyperplan_outlet::one_line;
use hyperplan_problem::{self as typed, Lowered, Overrides, Value};
use hyperplan_syntax::{JsonDiagnostic, SourceMap};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Systems and objectives without errors. Clones share what was read.
#[derive(Clone, Debug)]
pub struct Problem {
    pub(crate) source: Arc<Source>,
    pub(crate) overrides: Overrides,
    pub(crate) typed: Arc<typed::Problem>,
    pub(crate) sources: Arc<SourceMap>,
    constants: Vec<(String, Value)>,
    warnings: Arc<Faults>,
    /// How long reading took.
    pub(crate) time: Duration,
}

impl Problem {
    /// Reads a problem file, or a model of another tool that has its properties in it.
    ///
    /// # Errors
    /// When it cannot be read, or has errors.
    pub fn load(path: impl AsRef<Path>) -> Result<Problem, Error> {
        let path = path.as_ref();
        if is_foreign(path) {
            return Problem::load_foreign(&[path], Reading::default());
        }
        let cannot = |why| Error::Read { path: path.to_owned(), why };
        let bytes = read_bytes(path).map_err(|error| cannot(reason(&error)))?;
        let text = disk::text(bytes).map_err(cannot)?;
        let files = Files { folder: Some(Source::folder_of(path)), ..Files::default() };
        Problem::of(Source::Text { name: path.display().to_string(), text, files }, Overrides::none())
    }

    /// Reads models and formulas of other tools, as `docs/importing.md` says.
    ///
    /// # Errors
    /// Those of [`Problem::load`].
    pub fn load_foreign(paths: &[impl AsRef<Path>], options: Reading) -> Result<Problem, Error> {
        let input = |path: &Path| {
            let text = text_of(path).map_err(|why| Error::Read { path: path.to_owned(), why })?;
            Ok(Input { name: one_line(&path.display().to_string()).into_owned(), text })
        };
        let inputs: Result<_, Error> = paths.iter().map(|path| input(path.as_ref())).collect();
        Problem::of(Source::Foreign(Foreign { inputs: inputs?, options }), Overrides::none())
    }

    /// A problem from its text, as `docs/language.md` has it; it names no files.
    ///
    /// # Errors
    /// When it has errors: [`Error::Faulty`], with their places and what helps.
    pub fn from_text(text: impl Into<String>) -> Result<Problem, Error> {
        Problem::builder().text(text).build()
    }

    /// A problem that is built in code.
    #[must_use]
    pub fn builder() -> Builder {
        Builder::default()
    }

    pub(crate) fn of(source: Source, overrides: Overrides) -> Result<Problem, Error> {
        let start = Instant::now();
        let (lowered, sources) = source.lower(&overrides);
        Problem::lowered(Arc::new(source), overrides, (lowered, sources), start)
    }

    fn lowered(
        source: Arc<Source>,
        overrides: Overrides,
        (lowered, sources): (Lowered, SourceMap),
        start: Instant,
    ) -> Result<Problem, Error> {
        let faults = |errors| Faults::new(&sources, source.name(), &of_kind(&lowered.diagnostics, errors));
        if lowered.has_errors() {
            return Err(Error::Faulty(faults(true)));
        }
        let warnings = Arc::new(faults(false));
        let (typed, sources) = (Arc::new(lowered.problem), Arc::new(sources));
        let constants = lowered.consts;
        Ok(Problem { source, overrides, typed, sources, constants, warnings, time: start.elapsed() })
    }

    /// The same problem with another value of a constant: an integer, or a fraction such as `1/4`.
    ///
    /// # Errors
    /// When there is no such constant, or the problem has errors with that value.
    pub fn with(&self, constant: &str, value: impl ToString) -> Result<Problem, Error> {
        let (start, overrides) = (Instant::now(), self.overrides.clone().with(constant, value));
        let lowered = self.source.lower(&overrides);
        Problem::lowered(Arc::clone(&self.source), overrides, lowered, start)
    }

    /// Its constants in the order of the text, with their values.
    #[must_use]
    pub fn constants(&self) -> &[(String, Value)] {
        &self.constants
    }

    /// What is doubtful in it.
    #[must_use]
    pub fn warnings(&self) -> &[JsonDiagnostic] {
        self.warnings.list()
    }

    /// Its text; `None` where it was read from files of other tools.
    #[must_use]
    pub fn text(&self) -> Option<&str> {
        match &*self.source {
            Source::Text { text, .. } => Some(text),
            Source::Foreign(_) => None,
        }
    }

    /// Systems, actions and objectives, typed.
    #[must_use]
    pub fn typed(&self) -> &typed::Problem {
        &self.typed
    }

    /// The names of its objectives, in order.
    #[must_use]
    pub fn objectives(&self) -> Vec<&str> {
        self.typed.objectives.iter().map(|objective| objective.name.as_str()).collect()
    }

    /// The objective of that name.
    ///
    /// # Errors
    /// When there is none.
    pub fn objective(&self, name: &str) -> Result<Objective<'_>, Error> {
        let found = self.typed.objective(name);
        found.map(|typed| Objective { problem: self, typed }).ok_or_else(|| self.no_objective(Some(name)))
    }

    /// The only objective.
    ///
    /// # Errors
    /// When there is none, or more than one.
    pub fn only_objective(&self) -> Result<Objective<'_>, Error> {
        match self.typed.objectives.as_slice() {
            [typed] => Ok(Objective { problem: self, typed }),
            _ => Err(self.no_objective(None)),
        }
    }

    fn no_objective(&self, name: Option<&str>) -> Error {
        let known = self.objectives().into_iter().map(str::to_owned).collect();
        Error::NoObjective { name: name.map(str::to_owned), known }
    }

    /// Writes the problem into a folder as `NAME.hp`, with the files that it names beside it, so that the command can be run
    /// on it. Constants are as they were read. Files of other tools are written as what they mean. Where it is.
    ///
    /// # Errors
    /// When something cannot be written, or a file is not within the folder that it is named in.
    pub fn save(&self, folder: impl AsRef<Path>, name: &str) -> Result<PathBuf, Error> {
        let folder = folder.as_ref();
        let path = folder.join(format!("{name}.hp"));
        let (text, files) = self.source.whole();
        let outside = |name: &String| {
            Path::new(name).components().any(|part| !matches!(part, Component::Normal(_) | Component::CurDir))
        };
        if let Some(name) = files.keys().find(|name| outside(name)) {
            let why = format!("the problem names `{}`, which is not within its folder", one_line(name));
            return Err(Error::Write { path, why });
        }
        let beside = files.iter().map(|(name, bytes)| (folder.join(name), bytes.as_slice()));
        for (path, bytes) in beside.chain([(path.clone(), text.as_bytes())]) {
            path.parent()
                .map_or(Ok(()), std::fs::create_dir_all)
                .and_then(|()| hyperplan_outlet::write(&path, |to| to.write_all(bytes)))
                .map_err(|error| Error::Write { path: path.clone(), why: reason(&error) })?;
        }
        Ok(path)
    }
}

impl Builder {
    /// The problem.
    ///
    /// # Errors
    /// When it has errors, with their places in the text that was built.
    pub fn build(self) -> Result<Problem, Error> {
        Problem::of(self.source()?, Overrides::none())
    }
}
