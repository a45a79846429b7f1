//! `hyperplan solve`: from a problem file to a verified strategy.

mod lanes;

use crate::args::{self, Part, SolveFormat};
use crate::commands::explain;
use crate::config;
use crate::explain::{Explain, Why};
use crate::failure::{Exit, Failure, Result};
use crate::files::write_bytes;
use crate::guard;
use crate::load::Loaded;
use crate::nusmv;
use crate::output::Output;
use crate::parameter::{Parameter, Searched};
use crate::pictures::{self, Picture};
use crate::plans;
use crate::proof::{Prover, Said};
use crate::report::{json, paths_text};
use crate::waiting::Waiting;
use crate::wish::Wish;
use hyperplan::draw::Subject;
use hyperplan::foreign::Foreign;
use hyperplan::search::{self, Decided};
use hyperplan_outlet::one_line;
use hyperplan_plan::{self as plan, MinimizeError, Watch};
use hyperplan_problem::answer::plans::PlanFormat;
use hyperplan_problem::answer::{
    Answer, Below, Case, CostValue, Failed, ReasonCode, Seconds, Size, Verdict, Verified, WitnessPath,
    to_witness,
};
use hyperplan_problem::{Objective, Quantifier, Strategy};
use hyperplan_render::{Scene, can_draw};
use lanes::Team;
use std::path::Path;
use std::time::{Duration, Instant};

pub(crate) fn run(args: &args::Solve, verbose: bool, quiet: bool, out: &mut Output) -> Result {
    Team::check(args)?;
    let config = config::Solve::new(args, out)?;
    let (wish, loaded) = Wish::read(args, out)?;
    let explain = Explain { queries: config.plan.queries.as_deref() };
    let objectives = loaded.selected(args.selection.objective.as_deref(), false)?;
    let pictures = pictures(&config, &loaded, &objectives, out)?;
    let several = objectives.len() > 1;
    check_formats(args, &config, &loaded, &objectives)?;
    let mut worst = Exit::Good;
    let mut found_so_far = String::new();
    let (mut saved, mut drawn) = (Ok(()), Ok(()));
    for (index, objective) in objectives.into_iter().enumerate() {
        if out.is_closed() {
            break;
        }
        let start = Instant::now();
        let solved = watched(&loaded, objective, &wish, args, (&config.plan, explain, verbose), out);
        let (outcome, searched, open) = match solved {
            Ok(found) => found,
            Err((failure, reason_code)) => {
                // The other objectives may do better.
                out.failure(&failure);
                worst = worst.max(failure.status);
                if args.failures {
                    let objective = objective.name.clone();
                    out.line(json(&Failed { objective, reason: failure.to_string(), reason_code })?)?;
                }
                continue;
            }
        };
        guard::doing("telling what was found");
        let total = loaded.time + start.elapsed();
        let loaded = searched.as_ref().map_or(&loaded, |searched| &searched.loaded);
        let objective = loaded.problem.objective(&objective.name).unwrap_or(objective);
        let searched = searched.as_ref();
        let own = outcome.reason.as_ref().filter(|_| searched.is_none());
        let own = own.or(open.undecided.as_ref()).map(|reason| Why::new(reason, explain));
        let why = own.as_ref().or_else(|| searched?.undecided.as_ref());
        let mut answer = answer(loaded, objective, &outcome, (searched, open.costs), why, total);
        answer.case = args.cube.map(|part| case(part, objective));
        let about = (loaded, objective);
        let certified = certify(args, &config, (&mut answer, &outcome), &wish, about, out);
        worst = worst.max(certified);
        if certified >= Exit::Solver {
            // What is wrong is not told as an answer.
            continue;
        }
        let foreign = args.problem.foreign.as_ref();
        let short = args.format == SolveFormat::Text && !quiet;
        let reason = if short { in_short(about, &outcome, &config.plan) } else { None };
        let found =
            Found { loaded, objective, outcome: &outcome, answer: &answer, searched, reason, foreign };
        if let Some(path) = &config.save {
            // Before anything else that may fail.
            saved = match PlanFormat::of_file(path) {
                None => {
                    found_so_far += &(json(&answer)? + "\n");
                    write_bytes(path, found_so_far.as_bytes())
                }
                Some(format) => saved.and(found.save(format, path, several)),
            };
        }
        if index > 0 && args.format == SolveFormat::Text && !quiet {
            out.line("")?;
        }
        found.print(args.format, (verbose, quiet), out)?;
        outcome.notes.iter().for_each(|note| out.remark(format_args!("note: {}", explain.note(note))));
        if let (Some(picture), Some(strategy)) = (&pictures[index], &outcome.witness) {
            drawn = drawn.and(found.draw(strategy, picture));
        }
        worst = worst.max(status(&answer));
    }
    for failure in [saved, drawn].into_iter().filter_map(Result::err) {
        out.failure(&failure);
        worst = worst.max(failure.status);
    }
    Ok(worst)
}

/// What an answer says of the case that it is about.
fn case(part: Part, objective: &Objective) -> Case {
    let number = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    Case { index: number(part.index + 1), of: number(part.of), decides: lanes::decides(objective) }
}

/// As [`solve`], saying how far it is where that takes long.
fn watched(
    loaded: &Loaded,
    objective: &Objective,
    wish: &Wish<'_>,
    args: &args::Solve,
    (config, explain, verbose): (&plan::Config, Explain<'_>, bool),
    out: &Output,
) -> Result<Solved, (Failure, ReasonCode)> {
    if matches!(wish, Wish::Constant(_)) && !objective.minimize.is_empty() {
        let name = &objective.name;
        out.remark(format_args!("note: {name}: its own `minimize` is left aside for `--minimize`"));
    }
    guard::doing("searching for a strategy");
    let own = plan::Config { watch: Watch::default(), ..config.clone() };
    guard::watching(&own.watch);
    let _waiting = Waiting::begin(&own.watch, verbose, out);
    solve(loaded, objective, wish, &Team { args, config: &own, out }, explain)
}

/// Certifies what is said to be impossible, if that is wanted. An answer without a certificate is an answer all the same,
/// unless it is wrong.
fn certify(
    args: &args::Solve,
    config: &config::Solve,
    (answer, outcome): (&mut Answer, &plan::Outcome),
    wish: &Wish<'_>,
    about: (&Loaded, &Objective),
    out: &mut Output,
) -> Exit {
    let Some(folder) = &args.proof else { return Exit::Good };
    guard::doing("making certificates");
    let prover = Prover { folder, set: &args.problem.set, deadline: &config.plan.deadline };
    let Answer { minimized, costs, .. } = &*answer;
    let said = Said { verdict: outcome.verdict, minimized: minimized.as_ref(), costs };
    match prover.prove(about, &said, wish, out) {
        Ok((made, status)) => {
            answer.certificates = made;
            status
        }
        Err(failure) => {
            out.failure(&failure);
            failure.status
        }
    }
}

/// Refuses formats in which what is asked for cannot be told.
fn check_formats(
    args: &args::Solve,
    config: &config::Solve,
    loaded: &Loaded,
    objectives: &[&Objective],
) -> Result<()> {
    let printed = plan_format(args.format);
    if objectives.len() > 1 && (printed.is_some() || args.format == SolveFormat::Nusmv) {
        let message = "--format csv, ros, geojson, pddl and nusmv print the strategy of one objective; choose it by --objective NAME, or \
                       --save FILE with such an ending for a file each";
        return Err(Failure::input(message));
    }
    let saved = config.save.as_deref().and_then(PlanFormat::of_file);
    for format in printed.into_iter().chain(saved) {
        objectives
            .iter()
            .try_for_each(|objective| plans::check_format(format, &loaded.problem, objective))?;
    }
    Ok(())
}

/// The format of strategies for other programs, if it is one.
fn plan_format(format: SolveFormat) -> Option<PlanFormat> {
    match format {
        SolveFormat::Text | SolveFormat::Json | SolveFormat::Nusmv => None,
        SolveFormat::Csv => Some(PlanFormat::Csv),
        SolveFormat::Ros => Some(PlanFormat::Ros),
        SolveFormat::Geojson => Some(PlanFormat::Geojson),
        SolveFormat::Pddl => Some(PlanFormat::Pddl),
    }
}

/// The files to draw into, one for each objective. One that cannot be drawn has none; where all are such, there is no need
/// to search first.
fn pictures(
    config: &config::Solve,
    loaded: &Loaded,
    objectives: &[&Objective],
    out: &Output,
) -> Result<Vec<Option<Picture>>> {
    let Some(picture) = &config.plot else { return Ok(objectives.iter().map(|_| None).collect()) };
    let mut pictures = Vec::new();
    for objective in objectives {
        pictures.push(match can_draw(&loaded.problem, objective) {
            Ok(()) if objectives.len() == 1 => Some(picture.clone()),
            Ok(()) => Some(picture.for_objective(&objective.name)),
            Err(error) if objectives.len() == 1 => return Err(Failure::input(error)),
            Err(error) => {
                out.remark(format_args!("note: {} will have no picture: {error}", objective.name));
                None
            }
        });
    }
    if pictures.iter().all(Option::is_none) {
        return Err(Failure::input("none of the objectives can be drawn"));
    }
    Ok(pictures)
}

/// What is known of the costs of a strategy.
#[derive(Default)]
struct Costs {
    costs: Vec<CostValue>,
    /// Why they are perhaps not the least.
    undecided: Option<plan::Reason>,
}

type Solved = (plan::Outcome, Option<Searched>, Costs);

/// The outcome for an objective, or for the least value of a constant, or of the cheapest strategy.
fn solve(
    loaded: &Loaded,
    objective: &Objective,
    wish: &Wish<'_>,
    team: &Team<'_>,
    explain: Explain<'_>,
) -> Result<Solved, (Failure, ReasonCode)> {
    if team.is_wanted() {
        return team.solve(loaded, objective, wish, explain);
    }
    let name = &objective.name;
    let case = team.args.cube.map(|Part { index, of }| {
        plan::case(&loaded.problem, objective, (index, of), team.config)
            .map_err(|error| (explain.failure(name, &error), error.code()))
    });
    let own = case.transpose()?;
    let (objective, config) = own.as_ref().map_or((objective, team.config), |(own, config)| (own, config));
    let failed = |error: &plan::Error, value: String| {
        (explain.failure(format_args!("{name}{value}"), error), error.code())
    };
    if let Wish::Constant(parameter) = wish {
        return match parameter.least(loaded, objective, config, explain) {
            Ok((outcome, searched)) => {
                let problem = &searched.loaded.problem;
                let objective = problem.objective(name).unwrap_or(objective);
                let first = team.args.first;
                let straight = |outcome| search::straight(problem, objective, outcome, team.config);
                let outcome = if first { outcome } else { straight(outcome) };
                Ok((outcome, Some(searched), Costs::default()))
            }
            Err(error) => Err(unsolved(name, parameter, error, explain)),
        };
    }
    let targets = wish.targets(loaded, objective).map_err(|failure| (failure, ReasonCode::Unsupported))?;
    let Decided { outcome, costs, undecided } =
        search::decide(&loaded.problem, objective, &targets, config, team.args.first)
            .map_err(|error| failed(&error, String::new()))?;
    Ok((outcome, None, Costs { costs, undecided }))
}

/// Why the least value of a constant is not known.
fn unsolved(
    name: &str,
    parameter: &Parameter<'_>,
    error: MinimizeError<Failure>,
    explain: Explain<'_>,
) -> (Failure, ReasonCode) {
    match error {
        MinimizeError::Problem(failure) => (failure, ReasonCode::Unsupported),
        MinimizeError::Solve { value, error } => {
            let about = format_args!("{name} with {} = {value}", parameter.constant);
            (explain.failure(about, &error), error.code())
        }
    }
}

/// How long may be thought about why there is no strategy, if no longer than it took to find that out, and how long in any case.
const REASONS: Duration = Duration::from_millis(500);
const REASONS_ANYWAY: Duration = Duration::from_millis(100);

/// Why an objective is unrealizable, on one line, if that is soon found.
fn in_short(
    (loaded, objective): (&Loaded, &Objective),
    outcome: &plan::Outcome,
    config: &plan::Config,
) -> Option<String> {
    if outcome.verdict != Verdict::Unrealizable {
        return None;
    }
    guard::doing("looking for reasons");
    let plan::Seconds { encode, solve, .. } = outcome.seconds;
    let time = Duration::try_from_secs_f64(encode + solve).unwrap_or(REASONS).clamp(REASONS_ANYWAY, REASONS);
    let config = plan::Config { deadline: config.deadline.within(time), queries: None, ..config.clone() };
    // What fails here took nothing from the answer.
    let found = plan::explain::in_short(&loaded.problem, objective, outcome, &config).ok()?;
    explain::in_short(loaded, objective, &found)
}

fn status(answer: &Answer) -> Exit {
    match answer.verdict {
        // A value that need not be the least is not what was asked for.
        _ if answer.minimized.as_ref().is_some_and(|m| m.below == Below::Unknown) => Exit::Undecided,
        _ if answer.costs.iter().any(|cost| cost.least < cost.value) => Exit::Undecided,
        Verdict::Realizable => Exit::Good,
        Verdict::Unrealizable => Exit::Unrealizable,
        Verdict::Unknown => Exit::Undecided,
    }
}

fn answer(
    loaded: &Loaded,
    objective: &Objective,
    outcome: &plan::Outcome,
    (searched, costs): (Option<&Searched>, Vec<CostValue>),
    why: Option<&Why>,
    total: Duration,
) -> Answer {
    let about = (&loaded.problem, objective);
    Answer {
        reason: why.map(|why| why.words.clone()),
        reason_code: why.map(|why| why.code),
        minimized: searched.map(|searched| searched.minimized.clone()),
        costs,
        ..search::answer(&loaded.file, about, outcome, (loaded.time, total))
    }
}

/// An outcome and all it takes to print it.
struct Found<'a> {
    loaded: &'a Loaded,
    objective: &'a Objective,
    outcome: &'a plan::Outcome,
    answer: &'a Answer,
    searched: Option<&'a Searched>,
    /// Why there is no strategy, or how the counterexample makes the objective fail, on one line.
    reason: Option<String>,
    /// The files of another tool, if it was these.
    foreign: Option<&'a Foreign>,
}

impl<'a> Found<'a> {
    fn scene(&self) -> Scene<'a> {
        let traces = self.outcome.witness.as_ref().map_or(&[][..], |s| &s.traces);
        Scene { problem: &self.loaded.problem, objective: Some(self.objective), traces, note: "" }
    }

    fn draw(&self, strategy: &Strategy, picture: &Picture) -> Result<()> {
        let subject = Subject {
            problem: &self.loaded.problem,
            objective: Some(self.objective),
            strategy: Some(strategy),
            named: &[],
        };
        pictures::draw(&subject, picture)
    }

    /// The paths as others want them: nothing of what comes after they were absorbed.
    fn plan(&self) -> Option<Vec<WitnessPath>> {
        let strategy = self.outcome.witness.as_ref()?;
        let cut = plans::without_rest(&self.loaded.problem, self.objective, strategy);
        Some(to_witness(&self.loaded.problem, self.objective, &cut))
    }

    /// Prints the answer, or the strategy alone; what became of the objective is a remark then.
    fn print(&self, format: SolveFormat, (verbose, quiet): (bool, bool), out: &mut Output) -> Result<()> {
        match (plan_format(format), format) {
            (Some(format), _) => {
                out.remark(self.verdict_line());
                let Some(paths) = self.plan() else { return Ok(()) };
                out.verbatim(&self.written(format, &paths)?)
            }
            (None, SolveFormat::Nusmv) => {
                out.remark(self.verdict_line());
                let Some(paths) = &self.answer.witness else { return Ok(()) };
                let refutes = self.answer.verdict == Verdict::Unrealizable;
                let name = &self.objective.name;
                out.verbatim(&nusmv::traces(name, refutes, paths, &nusmv::originals(self.foreign)))
            }
            (None, SolveFormat::Json) => out.line(json(self.answer)?),
            (None, _) if quiet => out.line(self.verdict_line()),
            (None, _) => {
                let text = self.text(verbose, out.color);
                out.line(text.trim_end())
            }
        }
    }

    fn written(&self, format: PlanFormat, paths: &[WitnessPath]) -> Result<String> {
        format.write(&self.objective.name, paths).map_err(|error| plans::cannot(&error))
    }

    /// Saves the strategy alone, a file for each path.
    fn save(&self, format: PlanFormat, path: &Path, several: bool) -> Result<()> {
        let Some(paths) = self.plan() else { return Ok(()) };
        let named = if several { plans::with_name(path, &self.objective.name) } else { path.to_owned() };
        for (file, own) in plans::files(&named, &paths).into_iter().zip(&paths) {
            let text = self.written(format, std::slice::from_ref(own))?;
            write_bytes(&file, text.as_bytes())?;
        }
        Ok(())
    }

    fn verdict_line(&self) -> String {
        if let Some(searched) = self.searched {
            return format!("{}: {}", self.objective.name, one_line(&searched.words));
        }
        // Users of verifiers have words of their own.
        let verdict = match (self.answer.verdict, self.foreign) {
            (Verdict::Realizable, None) => "realizable",
            (Verdict::Realizable, Some(_)) => "realizable (holds)",
            (Verdict::Unrealizable, None) => "unrealizable",
            (Verdict::Unrealizable, Some(_)) => "unrealizable (violated)",
            (Verdict::Unknown, _) => "unknown",
        };
        let case =
            self.answer.case.map(|Case { index, of, .. }| format!("{verdict} in case {index} of {of}"));
        let verdict = case.as_deref().unwrap_or(verdict);
        if !self.answer.costs.is_empty() {
            return format!("{}: {verdict} with {}", self.objective.name, self.costs());
        }
        match &self.answer.reason {
            Some(reason) => format!("{}: {verdict}: {}", self.objective.name, one_line(reason)),
            None => format!("{}: {verdict}", self.objective.name),
        }
    }

    /// What the strategy costs, and whether that is the least.
    fn costs(&self) -> String {
        let value = |cost: &CostValue| {
            let CostValue { expression, value, least } = cost;
            let least = match least < value {
                true => format!("; whether less is possible, down to {least}, is unknown"),
                false => ", the least".to_owned(),
            };
            format!("{expression} = {value}{least}")
        };
        let all: Vec<String> = self.answer.costs.iter().map(value).collect();
        let why = self.answer.reason.iter().map(|reason| format!(": {}", one_line(reason)));
        all.join("; ") + &why.collect::<String>()
    }

    fn text(&self, verbose: bool, color: bool) -> String {
        let mut text = self.verdict_line();
        text.push_str(&format!("\nhorizon: {}\n", self.horizons()));
        if self.outcome.witness.is_some() {
            text.push_str(&self.strategy(color));
        }
        text.extend(self.reason.iter().map(|why| format!("{}\n", one_line(why))));
        text.push_str(&self.checked());
        match self.answer.certificates.as_slice() {
            [] => {}
            [one] => text.push_str(&format!("certificate: {}\n", one_line(one))),
            [first, .., last] => {
                text.push_str(&format!("certificates: {} to {}\n", one_line(first), one_line(last)))
            }
        }
        text.push_str(&self.effort(verbose));
        text
    }

    fn horizons(&self) -> String {
        let each = self.answer.horizon.0.iter().map(|(name, steps)| match steps {
            Some(steps) => format!("{name} {steps}"),
            None => format!("{name} not read"),
        });
        each.collect::<Vec<_>>().join(", ")
    }

    fn strategy(&self, color: bool) -> String {
        let mut text = String::new();
        if self.objective.paths.first().map(|p| p.quantifier) == Some(Quantifier::Forall) {
            text.push_str("counterexample:\n");
        }
        text += &paths_text(self.scene(), color);
        text + "\n"
    }

    fn checked(&self) -> String {
        let words = match (self.answer.verified, &self.answer.witness) {
            (Some(Verified::BySearch), _) => "verified by search\n",
            (Some(Verified::BySolver), _) => "verified by a solver (too large to search)\n",
            (None, Some(_)) => "not verified\n",
            (None, None) => "",
        };
        words.to_owned()
    }

    fn effort(&self, verbose: bool) -> String {
        let Answer { solver, quantifiers, states, iterations, size, seconds, .. } = self.answer;
        let rounds = if *iterations == 1 { "round" } else { "rounds" };
        let name = one_line(&format!("{} {}", solver.name, solver.version)).into_owned();
        let mut text = format!(
            "{}, quantifiers {quantifiers}, states {states}, {iterations} {rounds}, {:.3} s\n",
            name.trim_end(),
            seconds.total
        );
        if verbose {
            if let Some(because) = self.outcome.because {
                text.push_str(&format!("quantifiers {quantifiers}: {because}\n"));
            }
            let Seconds { read, encode, solve, verify, .. } = seconds;
            let Size { variables, clauses, bytes } = size;
            let text_size = bytes.map_or_else(String::new, |bytes| format!(", {bytes} bytes"));
            let logic = self.answer.logic.as_ref().map_or_else(String::new, |logic| format!(", {logic}"));
            text.push_str(&format!(
                "read {read:.3} s, encode {encode:.3} s, solve {solve:.3} s, verify {verify:.3} s\n\
                 largest query: {variables} variables, {clauses} clauses{text_size}{logic}\n"
            ));
        }
        text
    }
}
