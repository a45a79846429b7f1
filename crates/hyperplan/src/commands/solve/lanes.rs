//! One objective on several cores: several ways to search at once (a portfolio), or cases of it (cubes).
//!
//! Each way or case is a process of its own, `hyperplan solve` on the same file, with the limits of this command. The first
//! verified answer that decides ends the others, with all that they have started.

use crate::args;
use crate::configuration::Configured;
use crate::failure::{Exit, Failure, Result};
use crate::load::Loaded;
use crate::output::Output;
use hyperplan_compare::{Finish, Lanes};
use hyperplan_outlet::one_line;
use hyperplan_plan::{self as plan, Cube, Fallen, Outcome, Reason, cubes};
use hyperplan_problem::answer::{Answer, Failed, Quantifiers, ReasonCode, Verdict, to_strategy};
use hyperplan_problem::{Objective, Quantifier};
use hyperplan_solver::{Identity, QuerySize, Spec, Unknown};
use std::cell::Cell;
use std::collections::BTreeSet;
use std::io;
use std::ops::ControlFlow;
use std::thread::available_parallelism;
use std::time::{Duration, Instant};

/// More cases are hardly meant: each is a process.
const MOST_CUBES: usize = 10_000;

/// How long lanes may take to say that their time is over; this process has a little longer.
const GRACE: Duration = Duration::from_millis(400);

/// A lane and its answer.
type Won = (usize, Answer);

/// Why there is no outcome.
type Stop = (Failure, ReasonCode);

/// What the command does besides its lanes.
pub(super) struct Team<'a> {
    pub(super) args: &'a args::Solve,
    pub(super) config: &'a plan::Config,
    pub(super) out: &'a Output,
}

/// A process: what it is called, and what it is told besides the rest.
struct Lane {
    name: String,
    options: Vec<String>,
}

impl Team<'_> {
    /// Refuses what lanes do not do.
    pub(super) fn check(args: &args::Solve) -> Result<()> {
        if args.portfolio.is_none() && args.cubes.is_none() {
            return Ok(());
        }
        let option = if args.cubes.is_some() { "--cubes" } else { "--portfolio" };
        let refused = |what: &str| Err(Failure::input(format_args!("{option} {what}")));
        if crate::files::is_stdin(&args.problem.file) {
            return refused("takes a file, which several processes read, not standard input");
        }
        if args.minimize.is_some() {
            return refused("cannot be used with --minimize");
        }
        if args.queries.is_some() {
            return refused("cannot be used with --queries: many processes would write there");
        }
        if args.solver.contains(',') {
            return refused("takes one solver, not a race of several");
        }
        Ok(())
    }

    /// The case that this process is one of, if it is.
    pub(super) fn cube(&self, loaded: &Loaded, objective: &Objective) -> Result<Cube> {
        let mut cube = Cube::new();
        for given in &self.args.cube {
            let unknown = |what: &str| Failure::input(format_args!("--cube: there is no {}", one_line(what)));
            let leading = objective.leading_block();
            let path = leading.into_iter().find(|&path| objective.paths[path].name == given.path);
            let path = path.ok_or_else(|| unknown(&given.path))?;
            let known = &loaded.problem.systems[objective.paths[path].system].actions;
            let find = |place: &str| place.parse().ok().and_then(|place: usize| known.get(place).copied());
            let actions = given.actions.iter().map(|place| find(place).ok_or_else(|| unknown(place)));
            cube.push((path, actions.collect::<Result<_>>()?));
        }
        Ok(cube)
    }

    /// The outcome of the first lane that decides, or what all of them together come to.
    pub(super) fn solve(&self, loaded: &Loaded, objective: &Objective) -> Result<Outcome, Stop> {
        if !objective.minimize.is_empty() {
            let message = "what costs least is not searched for by --portfolio or --cubes";
            return Err((Failure::input(message), ReasonCode::Unsupported));
        }
        match self.args.cubes {
            Some(number) => self.by_cases(loaded, objective, number.into()),
            None => self.by_portfolio(loaded, objective),
        }
    }

    fn by_portfolio(&self, loaded: &Loaded, objective: &Objective) -> Result<Outcome, Stop> {
        let number = usize::from(self.args.portfolio.unwrap_or(1));
        let lanes = self.ways(number).map_err(|failure| (failure, ReasonCode::Unsupported))?;
        let (found, rest) =
            self.run(objective, &lanes, number, |answer| answer.verdict != Verdict::Unknown)?;
        match found {
            Some((lane, answer)) => {
                self.tell_lost(&lanes, &rest);
                self.out.remark(format_args!("note: the first of {number} was: {}", lanes[lane].name));
                outcome(loaded, objective, &answer)
            }
            None => self.undecided(loaded, objective, &lanes, rest),
        }
    }

    fn by_cases(&self, loaded: &Loaded, objective: &Objective, number: usize) -> Result<Outcome, Stop> {
        let cases = cubes(&loaded.problem, objective, number);
        if cases.len() > MOST_CUBES {
            let message = format!("these would be {} cases, of at most {MOST_CUBES}", cases.len());
            return Err((Failure::input(message), ReasonCode::Unsupported));
        }
        let lanes: Vec<Lane> = cases.iter().map(|cube| lane(loaded, objective, cube)).collect();
        let leads = objective.paths.first().map(|path| path.quantifier);
        // One case decides where it has a strategy, or a counterexample.
        let decides =
            if leads == Some(Quantifier::Forall) { Verdict::Unrealizable } else { Verdict::Realizable };
        let at_a_time = available_parallelism().map_or(1, usize::from).min(number);
        let (found, rest) = self.run(objective, &lanes, at_a_time, |answer| answer.verdict == decides)?;
        if let Some((lane, answer)) = found {
            self.tell_lost(&lanes, &rest);
            self.out.remark(format_args!("note: found in a case of {}: {}", lanes.len(), lanes[lane].name));
            return outcome(loaded, objective, &answer);
        }
        let answers: Vec<&Answer> = rest.iter().filter_map(|(_, end)| end.as_ref().ok()).collect();
        let all = answers.iter().all(|answer| answer.verdict != Verdict::Unknown);
        match answers.first() {
            Some(first) if all && answers.len() == lanes.len() => {
                self.out.remark(format_args!("note: so it is in all of {} cases", lanes.len()));
                let iterations = answers.iter().map(|answer| answer.iterations).sum();
                outcome(loaded, objective, &Answer { iterations, ..Answer::clone(first) })
            }
            _ => self.undecided(loaded, objective, &lanes, rest),
        }
    }

    /// Runs lanes, so many at a time, until the answer of one is good; also what became of the others.
    fn run(
        &self,
        objective: &Objective,
        lanes: &[Lane],
        at_a_time: usize,
        good: impl Fn(&Answer) -> bool,
    ) -> Result<(Option<Won>, Vec<Ended>), Stop> {
        let failed = |error: io::Error| (Failure::input(error), ReasonCode::Io);
        let runner = Lanes {
            hyperplan: std::env::current_exe().map_err(failed)?,
            supervisor: vec!["supervise".to_owned()],
            temporary: std::env::temp_dir(),
            at_a_time,
        };
        let arguments: Vec<Vec<String>> =
            lanes.iter().map(|lane| self.arguments(objective, &lane.options)).collect();
        let mut rest = Vec::new();
        let since = Cell::new(None);
        let over = || {
            let deadline = &self.config.deadline;
            let late = |since: Instant| deadline.cancelled() || since.elapsed() > GRACE;
            if deadline.passed() && since.get().is_none() {
                since.set(Some(Instant::now()));
            }
            since.get().is_some_and(late)
        };
        let found = runner.run(&arguments, over, |finish| match ended(&finish) {
            Ok(answer) if good(&answer) => {
                self.hand_on(&finish.stderr);
                ControlFlow::Break((finish.lane, answer))
            }
            end => {
                rest.push((finish.lane, end));
                ControlFlow::Continue(())
            }
        });
        found.map(|found| (found, rest)).map_err(failed)
    }

    /// The command line of a lane. What it is told last wins, so its own options come last.
    fn arguments(&self, objective: &Objective, own: &[String]) -> Vec<String> {
        let args = self.args;
        let mut words: Vec<String> = vec!["solve".to_owned(), "--format=json".into(), "--failures".into()];
        let mut files = vec![args.problem.file.display().to_string()];
        if let Some(foreign) = &args.problem.foreign {
            files = foreign.inputs.iter().map(|input| input.name.clone()).collect();
        }
        let mut option = |name: &str, value: String| words.push(format!("--{name}={value}"));
        option("objective", objective.name.clone());
        args.problem.set.iter().for_each(|(name, value)| option("set", format!("{name}={value}")));
        args.others.reading.bound.iter().for_each(|bound| option("bound", bound.to_string()));
        args.others.reading.semantics.iter().for_each(|semantics| option("semantics", semantics.clone()));
        args.cross_check.iter().for_each(|solver| option("cross-check", solver.clone()));
        args.memory.iter().for_each(|mib| option("memory", mib.to_string()));
        if let Some(left) = self.config.deadline.remaining() {
            // So that there is time to hear that it is over.
            let seconds = left.as_secs_f64();
            option("timeout", (seconds - (seconds / 10.0).min(0.5)).max(0.01).to_string());
        }
        let given = |name: &str| own.iter().any(|word| word.starts_with(&format!("--{name}=")));
        for (name, value) in [
            ("solver", args.solver.clone()),
            ("quantifiers", args.encoding.quantifiers.to_string()),
            ("states", crate::config::states_name(args.encoding.states)),
            ("seed", args.seed.to_string()),
        ] {
            if !given(name) {
                option(name, value);
            }
        }
        words.extend(args.no_verify.then(|| "--no-verify".to_owned()));
        words.extend(own.iter().cloned());
        // So that no name is taken for an option.
        words.push("--".to_owned());
        words.extend(files);
        words
    }

    /// The ways of a portfolio, what was asked for first, and some more, for those that cannot be had. Only what was left
    /// to hyperplan varies.
    fn ways(&self, number: usize) -> Result<Vec<Lane>> {
        let args = self.args;
        let mut ways: Vec<Vec<String>> = vec![Vec::new()];
        let mut add = |free: bool, option: &str, value: &str| {
            if free {
                ways.push(vec![format!("--{option}={value}")]);
            }
        };
        let quantifiers = args.encoding.quantifiers == Quantifiers::Auto;
        let builtin = args.solver == "builtin";
        add(builtin && !matches!(Spec::embedded("cadical"), Some(Err(_)) | None), "solver", "batsat");
        add(quantifiers, "quantifiers", "explicit");
        add(quantifiers, "quantifiers", "cegis");
        add(args.encoding.states.is_none(), "states", "bitvec");
        if builtin && number > 3 {
            for spec in Configured::new(self.out).catalog()?.installed() {
                add(!spec.is_embedded(), "solver", spec.name());
            }
        }
        add(quantifiers, "quantifiers", "expand");
        // As many again, with other seeds.
        let kinds = ways.len();
        for index in kinds..2 * number.max(kinds) {
            let mut way = ways[index % kinds].clone();
            way.push(format!("--seed={}", args.seed.wrapping_add((index / kinds) as u64)));
            ways.push(way);
        }
        let name = |way: &[String]| match way {
            [] => "as asked".to_owned(),
            words => words.join(" "),
        };
        Ok(ways.into_iter().map(|options| Lane { name: name(&options), options }).collect())
    }

    /// Says what the winner said besides; not how far it had been.
    fn hand_on(&self, stderr: &str) {
        let said = stderr.lines().filter(|line| line.starts_with("note: ") || line.starts_with("warning"));
        said.for_each(|line| self.out.remark(line));
    }

    /// What is left where no lane decided.
    fn undecided(
        &self,
        loaded: &Loaded,
        objective: &Objective,
        lanes: &[Lane],
        mut rest: Vec<Ended>,
    ) -> Result<Outcome, Stop> {
        rest.sort_by_key(|(lane, _)| *lane);
        let answers: Vec<&Answer> = rest.iter().filter_map(|(_, end)| end.as_ref().ok()).collect();
        let unknown = answers.iter().find(|answer| answer.verdict == Verdict::Unknown);
        // A bug of ours is not to be lost among what was undecided.
        let is_bug = |(_, end): &Ended| end.as_ref().is_err_and(|(failure, _)| failure.status >= Exit::Bug);
        if let (Some(answer), false) = (unknown.or(answers.first()), rest.iter().any(is_bug)) {
            let outcome = outcome(loaded, objective, answer)?;
            let reason = Some(self.reasons(lanes, &rest));
            return Ok(Outcome {
                verdict: Verdict::Unknown,
                witness: None,
                verified: None,
                reason,
                ..outcome
            });
        }
        if let Some(place) = rest.iter().position(is_bug)
            && let (_, Err(stop)) = rest.swap_remove(place)
        {
            return Err(stop);
        }
        // What was asked for says most: the others may be ways that cannot be had.
        let first =
            rest.into_iter().filter(|_| !self.config.deadline.passed()).find_map(|(_, end)| end.err());
        Err(first.unwrap_or_else(|| {
            let reason = self.config.deadline.reason();
            let failure = Failure::new(Exit::Undecided, format_args!("{}: {reason}", objective.name));
            (failure, ReasonCode::Timeout)
        }))
    }

    /// Tells of lanes that failed before another one decided.
    fn tell_lost(&self, lanes: &[Lane], rest: &[Ended]) {
        for (lane, end) in rest {
            if let Err((failure, _)) = end
                && failure.status >= Exit::Solver
            {
                self.out.remark(format_args!("warning: {} failed: {}", lanes[*lane].name, failure.message));
            }
        }
    }

    /// Why nobody decided.
    fn reasons(&self, lanes: &[Lane], rest: &[Ended]) -> Reason {
        if self.config.deadline.passed() {
            return self.config.deadline.reason().into();
        }
        let late = |(_, end): &Ended| {
            end.as_ref().is_ok_and(|answer| answer.reason_code == Some(ReasonCode::Timeout))
        };
        if rest.iter().any(late) {
            return Unknown::Timeout.into();
        }
        let mut told = BTreeSet::new();
        let mut reasons = Vec::new();
        for (lane, end) in rest {
            let words = match end {
                Ok(answer) => answer.reason.clone().filter(|_| answer.verdict == Verdict::Unknown),
                Err((failure, _)) => Some(failure.message.clone()),
            };
            // Of many that say the same one is enough.
            if let Some(words) = words.filter(|words| told.insert(words.clone())) {
                reasons.push((lanes[*lane].name.clone(), Fallen::Undecided(Unknown::Said(words).into())));
            }
        }
        Reason::Several(reasons)
    }
}

/// A case as a lane. Actions are told by their places among those of the system: a name may have commas.
fn lane(loaded: &Loaded, objective: &Objective, cube: &Cube) -> Lane {
    let (mut names, mut options) = (Vec::new(), Vec::new());
    for (path, actions) in cube {
        let path = &objective.paths[*path];
        let known = &loaded.problem.systems[path.system].actions;
        let words: Vec<&str> =
            actions.iter().map(|&action| loaded.problem.actions[action].as_str()).collect();
        let places = actions.iter().filter_map(|action| known.iter().position(|known| known == action));
        let places: Vec<String> = places.map(|place| place.to_string()).collect();
        names.push(format!("{}={}", path.name, words.join(",")));
        options.push(format!("--cube={}={}", path.name, places.join(",")));
    }
    Lane { name: names.join(" "), options }
}

/// What became of a lane.
type Ended = (usize, Result<Answer, Stop>);

/// The answer that a lane printed, or why it printed none.
fn ended(finish: &Finish) -> Result<Answer, Stop> {
    let line = finish.stdout.lines().rfind(|line| !line.trim().is_empty()).unwrap_or_default();
    if let Ok(answer) = serde_json::from_str(line) {
        return Ok(answer);
    }
    let status = match finish.exit_code {
        Some(2) => Exit::Input,
        Some(3) => Exit::Undecided,
        Some(5) => Exit::Bug,
        _ => Exit::Solver,
    };
    if let Ok(Failed { reason, reason_code, .. }) = serde_json::from_str(line) {
        return Err((Failure::new(status, reason), reason_code));
    }
    let said = finish
        .stderr
        .lines()
        .rfind(|line| !line.trim().is_empty())
        .unwrap_or("a process ended without an answer");
    let said = one_line(said.trim_start_matches("error: ")).into_owned();
    Err((Failure::new(status, said), ReasonCode::SolverFailed))
}

/// An answer of another process as an outcome of this one.
fn outcome(loaded: &Loaded, objective: &Objective, answer: &Answer) -> Result<Outcome, Stop> {
    let strategy = answer.witness.as_ref().map(|paths| to_strategy(&loaded.problem, objective, paths));
    let strategy = strategy.transpose().map_err(|error| {
        let message = format!("a process of ours printed what is no strategy: {error}");
        (Failure::new(Exit::Bug, message), ReasonCode::Bug)
    })?;
    Ok(Outcome {
        verdict: answer.verdict,
        reason: None,
        horizons: objective
            .paths
            .iter()
            .map(|path| answer.horizon.get(&path.name).copied().flatten())
            .collect(),
        witness: strategy,
        verified: answer.verified,
        solver: Identity { name: answer.solver.name.clone(), version: answer.solver.version.clone() },
        quantifiers: answer.quantifiers,
        because: None,
        states: answer.states,
        iterations: answer.iterations,
        size: QuerySize {
            clauses: answer.size.clauses,
            variables: answer.size.variables,
            bytes: answer.size.bytes.unwrap_or(0),
            logic: answer.logic.clone(),
        },
        seconds: plan::Seconds {
            encode: answer.seconds.encode,
            solve: answer.seconds.solve,
            verify: answer.seconds.verify,
        },
        notes: Vec::new(),
    })
}
