//! One objective on several cores: several ways to search at once (a portfolio), or cases of it (cubes); of a constant, also several
//! of its values.
//!
//! Each is a process of its own, `hyperplan solve` on the same file, with the limits of this command. [`Board`] says what they do. What decides
//! ends the others, with all that they have started.

mod answers;
mod board;
mod ways;

use super::{Costs, Solved};
use crate::args;
use crate::explain::Explain;
use crate::failure::{Exit, Failure, Result};
use crate::load::Loaded;
use crate::output::Output;
use crate::parameter::Parameter;
use crate::wish::{Smallest, Wish};
use answers::{cheapest, ended, is_whole, outcome};
use board::{Board, Kind, Lane, Range};
use hyperplan_compare::{Finish, Foreman, Lanes};
use hyperplan_plan::{self as plan, Fallen, Least, Narrowed, Outcome, Reason, narrowed};
use hyperplan_problem::answer::{Answer, CostValue, ReasonCode, Verdict};
use hyperplan_problem::{Objective, Problem, Quantifier};
use hyperplan_solver::Unknown;
use std::collections::BTreeSet;
use std::io;
use std::ops::ControlFlow;
use std::thread::available_parallelism;
use std::time::{Duration, Instant};
use ways::Way;

/// How long lanes may take to say that their time is over; this process has a little longer.
const GRACE: Duration = Duration::from_millis(400);

/// Why there is no outcome.
type Stop = (Failure, ReasonCode);

/// What the command does besides its lanes.
pub(super) struct Team<'a> {
    pub(super) args: &'a args::Solve,
    pub(super) config: &'a plan::Config,
    pub(super) out: &'a Output,
}

/// The verdict of one case that is that of the objective.
pub(super) fn decides(objective: &Objective) -> Verdict {
    match objective.paths.first().map(|path| path.quantifier) {
        Some(Quantifier::Forall) => Verdict::Unrealizable,
        _ => Verdict::Realizable,
    }
}

impl Team<'_> {
    /// Refuses what lanes do not do.
    pub(super) fn check(args: &args::Solve) -> Result<()> {
        if args.cube.is_some() && matches!(args.minimize, Some(args::Wish::Constant(_))) {
            return Err(Failure::input(
                "--cube cannot be used with --minimize of a constant: each of its values has other cases; --cubes can",
            ));
        }
        if args.portfolio.is_none() && args.cubes.is_none() {
            return Ok(());
        }
        let option = if args.cubes.is_some() { "--cubes" } else { "--portfolio" };
        let refused = |what: &str| Err(Failure::input(format_args!("{option} {what}")));
        if crate::files::is_stdin(&args.problem.file) {
            return refused("takes a file, which several processes read, not standard input");
        }
        if args.queries.is_some() {
            return refused("cannot be used with --queries: many processes would write there");
        }
        if args.solver.contains(',') {
            return refused("takes one solver, not a race of several");
        }
        Ok(())
    }

    /// Whether the search is one of several processes, not of this one.
    pub(super) fn is_wanted(&self) -> bool {
        self.args.portfolio.is_some() || self.args.cubes.is_some()
    }

    /// The outcome of what decides, or what all together come to.
    pub(super) fn solve(
        &self,
        loaded: &Loaded,
        objective: &Objective,
        wish: &Wish<'_>,
        explain: Explain<'_>,
    ) -> Result<Solved, Stop> {
        let unsupported = |failure| (failure, ReasonCode::Unsupported);
        let targets = wish.targets(loaded, objective).map_err(unsupported)?;
        let floor: Vec<i64> = targets.iter().map(|target| target.constant).collect();
        let range = self.range(objective, wish, explain)?;
        let (kind, ways, at_a_time) = match (self.args.cubes, self.args.portfolio) {
            (Some(number), _) => {
                let cores = available_parallelism().map_or(1, usize::from);
                let decides = Some(decides(objective)).filter(|_| floor.is_empty());
                (Kind::Cases(decides), Team::cases(number), cores.min(number.into()))
            }
            (None, number) => {
                let number = usize::from(number.unwrap_or(1));
                (Kind::Ways, self.ways(number).map_err(unsupported)?, number)
            }
        };
        let constant = match &wish.smallest {
            Smallest::Constant(parameter) => Some(&**parameter),
            _ => None,
        };
        let board = Board::new(kind, ways.len(), range);
        let mut crew = Crew {
            team: self,
            objective,
            kind,
            at_a_time,
            ways,
            constant,
            board,
            ended: Vec::new(),
            over: None,
        };
        let failed = |error: io::Error| (Failure::input(error), ReasonCode::Io);
        let runner = Lanes {
            hyperplan: std::env::current_exe().map_err(failed)?,
            supervisor: vec!["supervise".to_owned()],
            temporary: std::env::temp_dir(),
            at_a_time,
        };
        runner.run(&mut crew).map_err(failed)?;
        match constant {
            Some(parameter) => crew.least(loaded, parameter, explain),
            None => crew.one(loaded, &floor),
        }
    }

    /// The values that are to be asked.
    fn range(&self, objective: &Objective, wish: &Wish<'_>, explain: Explain<'_>) -> Result<Range, Stop> {
        let Smallest::Constant(parameter) = &wish.smallest else {
            return Ok(Range { low: 0, high: 0, lasts: false });
        };
        let mut problem = |value| parameter.problem(value);
        let name = &objective.name;
        match narrowed(name, parameter.range.clone(), &mut problem, self.config) {
            Ok(Narrowed { low, lasts }) => Ok(Range { low, high: (*parameter.range.end()).max(low), lasts }),
            Err(error) => Err(super::unsolved(name, parameter, error, explain)),
        }
    }
}

/// The lanes of an objective, and what has become of them.
struct Crew<'a> {
    team: &'a Team<'a>,
    objective: &'a Objective,
    kind: Kind,
    at_a_time: usize,
    ways: Vec<Way>,
    /// Whose values are asked.
    constant: Option<&'a Parameter<'a>>,
    board: Board,
    ended: Vec<Ended>,
    /// Since when the time is over.
    over: Option<Instant>,
}

/// What became of a lane.
struct Ended {
    lane: Lane,
    end: Result<Answer, Stop>,
    /// What it said besides.
    said: String,
}

impl Foreman for Crew<'_> {
    type End = ();

    fn next(&mut self) -> Option<Vec<String>> {
        let (value, way) = self.board.next()?;
        let mut own = self.ways[way].options.clone();
        own.extend(self.constant.map(|parameter| format!("--set={}={value}", parameter.constant)));
        let share = if self.board.leaves_time(value) { plan::SHARE } else { 1 };
        Some(self.team.arguments(self.objective, &own, share))
    }

    fn ended(&mut self, finish: Finish) -> ControlFlow<()> {
        let end = ended(&finish);
        let found = end.as_ref().ok().filter(|answer| is_whole(answer)).map(|answer| answer.verdict);
        self.board.told(finish.lane, found.unwrap_or(Verdict::Unknown));
        self.ended.push(Ended { lane: self.board.lane(finish.lane), end, said: finish.stderr });
        // What cannot be had for any value is not to be tried for all.
        let hopeless =
            self.ended.len() >= self.ways.len() && self.ended.iter().all(|ended| ended.end.is_err());
        if hopeless || self.board.is_settled() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }

    fn moot(&mut self) -> Vec<usize> {
        self.board.moot()
    }

    fn over(&mut self) -> bool {
        let deadline = &self.team.config.deadline;
        if deadline.passed() && self.over.is_none() {
            self.over = Some(Instant::now());
        }
        self.over.is_some_and(|since| deadline.cancelled() || since.elapsed() > GRACE)
    }
}

impl Crew<'_> {
    /// The outcome of an objective without a constant, of which costs are not below these.
    fn one(self, loaded: &Loaded, floor: &[i64]) -> Result<Solved, Stop> {
        let (problem, objective) = (&loaded.problem, self.objective);
        let settled = self.board.is_settled();
        let answers = self.answers(0);
        if !floor.is_empty()
            && let Some((best, costs)) = self.cheapest(&answers, floor)
        {
            let outcome = outcome(problem, objective, best)?;
            let undecided = (!settled).then(|| self.reasons(0));
            return Ok(Solved { open: Costs { costs, undecided }, ..Solved::new(outcome) });
        }
        let outcome = if settled { self.winner(problem, objective, 0)? } else { self.undecided(problem, 0)? };
        Ok(Solved::new(outcome))
    }

    /// The outcome of the least value of a constant.
    fn least(self, loaded: &Loaded, parameter: &Parameter<'_>, explain: Explain<'_>) -> Result<Solved, Stop> {
        let (low, best, high) = (self.board.low(), self.board.best(), *parameter.range.end());
        if best.is_some_and(|best| best < low) {
            let message = format!(
                "{} is unrealizable with {} = {}, and realizable with less",
                self.objective.name,
                parameter.constant,
                low - 1
            );
            return Err((Failure::new(Exit::Bug, message), ReasonCode::Bug));
        }
        let settled = self.board.is_settled();
        let open = self.ended.iter().map(|ended| ended.lane.0).filter(|value| *value >= low).min();
        let value = best.unwrap_or(if settled { high } else { open.unwrap_or(low) });
        let problem = parameter.problem(value).map_err(|failure| (failure, ReasonCode::Unsupported))?;
        let objective = problem.objective(&self.objective.name).unwrap_or(self.objective);
        let undecided = (!settled).then(|| self.reasons(open.unwrap_or(low)));
        let outcome = match settled || best.is_some() {
            true => self.winner(&problem, objective, value)?,
            false => self.undecided(&problem, value)?,
        };
        let least = Least { value, problem, outcome, proved: low.min(value), undecided };
        let (outcome, searched) = parameter.told(loaded, least, loaded.time, explain);
        Ok(Solved { searched: Some(searched), ..Solved::new(outcome) })
    }

    /// The answers of the lanes of a value.
    fn answers(&self, value: i64) -> Vec<&Answer> {
        let ended = self.of(value);
        ended.into_iter().filter_map(|ended| ended.end.as_ref().ok()).collect()
    }

    /// What became of the lanes of a value, in the order of ways and cases.
    fn of(&self, value: i64) -> Vec<&Ended> {
        let mut all: Vec<&Ended> = self.ended.iter().filter(|ended| ended.lane.0 == value).collect();
        all.sort_by_key(|ended| ended.lane.1);
        all
    }

    /// The cheapest of some answers; in a portfolio that of which most is known.
    fn cheapest<'a>(&self, answers: &[&'a Answer], floor: &[i64]) -> Option<(&'a Answer, Vec<CostValue>)> {
        if self.kind != Kind::Ways {
            let all = answers.len() == self.ways.len()
                && answers.iter().all(|answer| answer.verdict != Verdict::Unknown);
            return cheapest(answers, (!all).then_some(floor));
        }
        let each = answers.iter().filter(|answer| answer.verdict == Verdict::Realizable);
        let key = |answer: &&&Answer| {
            answer.costs.iter().map(|cost| (cost.value, std::cmp::Reverse(cost.least))).collect::<Vec<_>>()
        };
        each.min_by_key(key).map(|best| (*best, best.costs.clone()))
    }

    /// The answer for a value that is settled, and what is to be said of it.
    fn winner(&self, problem: &Problem, objective: &Objective, value: i64) -> Result<Outcome, Stop> {
        let ended = self.of(value);
        let good = |ended: &&&Ended| {
            let answer = ended.end.as_ref().ok().filter(|answer| is_whole(answer));
            answer.is_some_and(|answer| match self.kind {
                Kind::Cases(Some(decides)) => answer.verdict == decides,
                Kind::Cases(None) => answer.verdict == Verdict::Realizable,
                Kind::Ways => true,
            })
        };
        let with = self
            .constant
            .map_or_else(String::new, |constant| format!("with {} = {value} ", constant.constant));
        self.tell_lost();
        let told = |words: String| self.team.out.remark(format_args!("note: {with}{words}"));
        let winner = ended.iter().find(good);
        let name = winner.map_or("", |ended| &self.ways[ended.lane.1].name);
        match (winner, self.kind) {
            (Some(_), Kind::Ways) => told(format!("the first of {} was: {name}", self.at_a_time)),
            (Some(_), Kind::Cases(_)) => told(format!("it was found in {name}")),
            (None, _) => told(format!("it is so in all of {} cases", self.ways.len())),
        }
        if let Some(winner) = winner {
            self.hand_on(&winner.said);
        }
        let answers = self.answers(value);
        let first = winner.and_then(|ended| ended.end.as_ref().ok()).or(answers.first().copied());
        let missing = || (Failure::new(Exit::Bug, "an answer was lost"), ReasonCode::Bug);
        let found = outcome(problem, objective, first.ok_or_else(missing)?)?;
        let all = self.ended.iter().filter_map(|ended| ended.end.as_ref().ok());
        let iterations = if winner.is_some() && self.constant.is_none() {
            found.iterations
        } else {
            all.map(|answer| answer.iterations).sum()
        };
        Ok(Outcome { iterations, ..found })
    }

    /// Says what the winner said besides; not how far it had been.
    fn hand_on(&self, stderr: &str) {
        let said = stderr.lines().filter(|line| line.starts_with("note: ") || line.starts_with("warning"));
        said.for_each(|line| self.team.out.remark(line));
    }

    /// What is left where no lane of a value decided.
    fn undecided(mut self, problem: &Problem, value: i64) -> Result<Outcome, Stop> {
        let objective = problem.objective(&self.objective.name).unwrap_or(self.objective);
        let answers = self.answers(value);
        let unknown = answers.iter().find(|answer| answer.verdict == Verdict::Unknown);
        // A bug of ours is not to be lost among what was undecided.
        let is_bug =
            |ended: &Ended| ended.end.as_ref().is_err_and(|(failure, _)| failure.status >= Exit::Bug);
        let bug = self.ended.iter().position(is_bug);
        if let (Some(answer), None) = (unknown.or(answers.first()), bug) {
            let outcome = outcome(problem, objective, answer)?;
            let reason = Some(self.reasons(value));
            let verdict = Verdict::Unknown;
            return Ok(Outcome { verdict, witness: None, verified: None, reason, ..outcome });
        }
        if let Some(place) = bug
            && let Err(stop) = self.ended.swap_remove(place).end
        {
            return Err(stop);
        }
        let deadline = &self.team.config.deadline;
        self.ended.sort_by_key(|ended| ended.lane);
        // What was asked for says most: the others may be ways that cannot be had.
        let first = self.ended.into_iter().filter(|_| !deadline.passed()).find_map(|ended| ended.end.err());
        Err(first.unwrap_or_else(|| {
            let reason = deadline.reason();
            let failure = Failure::new(Exit::Undecided, format_args!("{}: {reason}", objective.name));
            (failure, ReasonCode::Timeout)
        }))
    }

    /// Tells of lanes that failed before another one decided.
    fn tell_lost(&self) {
        for Ended { lane, end, .. } in &self.ended {
            if let Err((failure, _)) = end
                && failure.status >= Exit::Solver
            {
                let name = &self.ways[lane.1].name;
                self.team.out.remark(format_args!("warning: {name} failed: {}", failure.message));
            }
        }
    }

    /// Why nobody decided a value.
    fn reasons(&self, value: i64) -> Reason {
        let deadline = &self.team.config.deadline;
        if deadline.passed() {
            return deadline.reason().into();
        }
        let ended = self.of(value);
        let late = |ended: &&Ended| {
            ended.end.as_ref().is_ok_and(|answer| answer.reason_code == Some(ReasonCode::Timeout))
        };
        if ended.iter().any(late) {
            return Unknown::Timeout.into();
        }
        let mut told = BTreeSet::new();
        let mut reasons = Vec::new();
        for Ended { lane, end, .. } in ended {
            let words = match end {
                Ok(answer) => answer.reason.clone().filter(|_| !is_whole(answer)),
                Err((failure, _)) => Some(failure.message.clone()),
            };
            // Of many that say the same one is enough.
            if let Some(words) = words.filter(|words| told.insert(words.clone())) {
                let name = self.ways[lane.1].name.clone();
                reasons.push((name, Fallen::Undecided(Unknown::Said(words).into())));
            }
        }
        Reason::Several(reasons)
    }
}
