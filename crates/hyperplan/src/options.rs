//! How to search: solvers, time, a token that cancels, and who is told how far it is.

use crate::error::Error;
use hyperplan_plan::{Config, Quantifiers, Standing, States, Watch};
use hyperplan_solver::{Catalog, Deadline, Spec};
use std::fmt;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// Cancels whatever was begun with it. Clones share what was cancelled.
#[derive(Clone, Debug)]
pub struct Cancel(Deadline);

impl Default for Cancel {
    fn default() -> Self {
        Cancel(Deadline::never())
    }
}

impl Cancel {
    /// One that was not cancelled yet.
    #[must_use]
    pub fn new() -> Cancel {
        Cancel::default()
    }

    /// Cancels, for good: searches end soon, and say that they were interrupted.
    pub fn cancel(&self) {
        self.0.cancel();
    }

    /// Whether it was cancelled.
    #[must_use]
    pub fn is_cancelled(&self) -> bool {
        self.0.cancelled()
    }
}

/// The solvers that can be named: those that hyperplan knows, and profiles of one's own.
#[derive(Clone, Debug, Default)]
pub struct Solvers(Catalog);

impl Solvers {
    /// Those that hyperplan knows. Configuration files are not read.
    #[must_use]
    pub fn new() -> Solvers {
        Solvers::default()
    }

    /// Adds profiles, in TOML as `docs/solvers.md` has it.
    ///
    /// # Errors
    /// When it is none, with the line.
    pub fn add(&mut self, toml: &str) -> Result<(), Error> {
        Ok(self.0.add(Path::new("<profile>"), toml)?)
    }

    /// The solver that a name or a command line means: `builtin`, `z3`, that of a profile, or `my-solver --quiet`.
    ///
    /// # Errors
    /// When it means none. Whether it is installed is found out when it is asked.
    pub fn find(&self, name: &str) -> Result<Spec, Error> {
        match Spec::embedded(name.trim()) {
            Some(embedded) => Ok(embedded?),
            None => Ok(self.0.spec(name)?),
        }
    }
}

/// Who is told how far a search is.
pub type Progress = Arc<dyn Fn(&Standing) + Send + Sync>;

/// How to search. What is not said is left to hyperplan.
#[derive(Clone)]
pub struct Options {
    solver: Spec,
    rivals: Vec<Spec>,
    quantifiers: Quantifiers,
    states: Option<States>,
    timeout: Option<Duration>,
    cancel: Cancel,
    seed: u64,
    memory_mib: Option<u64>,
    first: bool,
    progress: Option<(Duration, Progress)>,
}

impl Default for Options {
    fn default() -> Self {
        Options {
            solver: Spec::Builtin,
            rivals: Vec::new(),
            quantifiers: Quantifiers::Auto,
            states: None,
            timeout: None,
            cancel: Cancel::default(),
            seed: 0,
            memory_mib: None,
            first: false,
            progress: None,
        }
    }
}

impl fmt::Debug for Options {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut all = f.debug_struct("Options");
        all.field("solver", &self.solver).field("rivals", &self.rivals).field("timeout", &self.timeout);
        all.finish_non_exhaustive()
    }
}

impl Options {
    /// The embedded solver, no limit of time.
    #[must_use]
    pub fn new() -> Options {
        Options::default()
    }

    /// Another solver, see [`Solvers::find`].
    #[must_use]
    pub fn solver(self, solver: Spec) -> Options {
        Options { solver, ..self }
    }

    /// One more solver that searches at the same time: the first verified answer counts.
    #[must_use]
    pub fn rival(mut self, solver: Spec) -> Options {
        self.rivals.push(solver);
        self
    }

    /// How quantifiers are decided.
    #[must_use]
    pub fn quantifiers(self, quantifiers: Quantifiers) -> Options {
        Options { quantifiers, ..self }
    }

    /// How states are written.
    #[must_use]
    pub fn states(self, states: States) -> Options {
        Options { states: Some(states), ..self }
    }

    /// When to give up: each call has that long.
    #[must_use]
    pub fn timeout(self, timeout: Duration) -> Options {
        Options { timeout: Some(timeout), ..self }
    }

    /// What cancels.
    #[must_use]
    pub fn cancel(self, cancel: &Cancel) -> Options {
        Options { cancel: cancel.clone(), ..self }
    }

    /// The seed of solvers.
    #[must_use]
    pub fn seed(self, seed: u64) -> Options {
        Options { seed, ..self }
    }

    /// The memory of each solver process, in MiB.
    #[must_use]
    pub fn memory_mib(self, mib: u64) -> Options {
        Options { memory_mib: Some(mib), ..self }
    }

    /// The first strategy found, with its detours.
    #[must_use]
    pub fn first(self) -> Options {
        Options { first: true, ..self }
    }

    /// Who is told how far it is, that often, from a thread of its own. It should return soon.
    #[must_use]
    pub fn progress(self, every: Duration, tell: impl Fn(&Standing) + Send + Sync + 'static) -> Options {
        Options { progress: Some((every, Arc::new(tell))), ..self }
    }

    pub(crate) fn wants_first(&self) -> bool {
        self.first
    }

    pub(crate) fn config(&self) -> Config {
        let deadline = self.timeout.map_or_else(|| self.cancel.0.clone(), |time| self.cancel.0.within(time));
        Config {
            rivals: self.rivals.clone(),
            quantifiers: self.quantifiers,
            states: self.states,
            // What is cancelled in here is no more than this call.
            deadline: deadline.part(),
            seed: self.seed,
            memory_mib: self.memory_mib,
            ..Config::new(self.solver.clone())
        }
    }

    /// Does something, and tells on the way how far it is.
    pub(crate) fn watched<T>(&self, watch: &Watch, work: impl FnOnce() -> T) -> T {
        let Some((every, tell)) = &self.progress else { return work() };
        // No system has clocks as fine, and a thread that never sleeps is none that watches.
        let every = (*every).max(Duration::from_millis(1));
        thread::scope(|scope| {
            let (done, ended) = channel::<()>();
            scope.spawn(move || {
                while ended.recv_timeout(every) == Err(RecvTimeoutError::Timeout) {
                    tell(&watch.standing());
                }
            });
            let found = work();
            drop(done);
            found
        })
    }
}
