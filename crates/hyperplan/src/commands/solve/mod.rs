//! `hyperplan solve`: from a problem file to a verified strategy.

mod found;
mod further;
mod lanes;

use crate::args::{self, Part, SolveFormat};
use crate::commands::explain;
use crate::config;
use crate::explain::{Explain, Why};
use crate::failure::{Exit, Failure, Result};
use crate::files::write_bytes;
use crate::guard;
use crate::load::Loaded;
use crate::output::Output;
use crate::parameter::{Parameter, Searched};
use crate::pictures::Picture;
use crate::plans;
use crate::proof::{Prover, Said};
use crate::report::json;
use crate::waiting::Waiting;
use crate::wish::{Smallest, Wish};
use found::Found;
use hyperplan::search::{self, Decided};
use hyperplan_certify::Apart;
use hyperplan_plan::{self as plan, MinimizeError, Watch};
use hyperplan_problem::Objective;
use hyperplan_problem::answer::plans::PlanFormat;
use hyperplan_problem::answer::{Answer, Below, Case, CostValue, Failed, More, ReasonCode, Verdict};
use hyperplan_render::can_draw;
use lanes::Team;
use std::time::{Duration, Instant};

pub(crate) fn run(args: &args::Solve, verbose: bool, quiet: bool, out: &mut Output) -> Result {
    Team::check(args)?;
    let config = config::Solve::new(args, out)?;
    let (wish, loaded) = Wish::read(args, out)?;
    let explain = Explain { queries: config.plan.queries.as_deref() };
    let objectives = loaded.selected(args.selection.objective.as_deref(), false)?;
    let pictures = pictures(&config, &loaded, &objectives, out)?;
    check_formats(args, &config, &loaded, &objectives)?;
    let several = objectives.len() > 1;
    let asked = Asked { args, config: &config, wish: &wish, explain, several, verbose, quiet };
    let mut told = Told { worst: Exit::Good, lines: String::new(), saved: Ok(()), drawn: Ok(()) };
    for (index, (objective, picture)) in objectives.into_iter().zip(&pictures).enumerate() {
        if out.is_closed() {
            break;
        }
        let start = Instant::now();
        match watched(&loaded, objective, &wish, args, (&config.plan, explain, verbose), out) {
            Ok((solved, failure)) => {
                guard::doing("telling what was found");
                let total = loaded.time + start.elapsed();
                asked.tell((&loaded, objective, index), (solved, total), picture.as_ref(), &mut told, out)?;
                if let Some(failure) = failure {
                    out.failure(&failure);
                    told.worst = told.worst.max(failure.status);
                }
            }
            Err((failure, reason_code)) => {
                // The other objectives may do better.
                out.failure(&failure);
                told.worst = told.worst.max(failure.status);
                if args.failures {
                    let objective = objective.name.clone();
                    out.line(json(&Failed { objective, reason: failure.to_string(), reason_code })?)?;
                }
            }
        }
    }
    let Told { mut worst, saved, drawn, .. } = told;
    for failure in [saved, drawn].into_iter().filter_map(Result::err) {
        out.failure(&failure);
        worst = worst.max(failure.status);
    }
    Ok(worst)
}

/// What was asked for.
struct Asked<'a> {
    args: &'a args::Solve,
    config: &'a config::Solve,
    wish: &'a Wish<'a>,
    explain: Explain<'a>,
    /// Whether there are several objectives.
    several: bool,
    verbose: bool,
    quiet: bool,
}

/// What was told so far.
struct Told {
    worst: Exit,
    /// The answers, for a file.
    lines: String,
    saved: Result<()>,
    drawn: Result<()>,
}

impl Asked<'_> {
    /// Certifies, saves, prints and draws what was found of an objective, and tells its status.
    fn tell(
        &self,
        (loaded, objective, index): (&Loaded, &Objective, usize),
        (solved, total): (Solved, Duration),
        picture: Option<&Picture>,
        told: &mut Told,
        out: &mut Output,
    ) -> Result<()> {
        let Asked { args, config, explain, .. } = *self;
        let Solved { outcome, searched, open, several } = solved;
        let loaded = searched.as_ref().map_or(loaded, |searched| &searched.loaded);
        let objective = loaded.problem.objective(&objective.name).unwrap_or(objective);
        let searched = searched.as_ref();
        let own = outcome.reason.as_ref().filter(|_| searched.is_none());
        let own = own.or(open.undecided.as_ref()).map(|reason| Why::new(reason, explain));
        let why = own.as_ref().or_else(|| searched?.undecided.as_ref());
        let mut answer = answer(loaded, objective, &outcome, (searched, open.costs), why, total);
        answer.case = args.cube.map(|part| case(part, objective));
        let (several, others, open) = further::told((loaded, objective), args, &answer, several);
        answer.several = several;
        if let Some(why) = open.map(|reason| Why::new(&reason, explain)).filter(|_| answer.reason.is_none()) {
            (answer.reason, answer.reason_code) = (Some(why.words), Some(why.code));
        }
        let about = (loaded, objective);
        let certified = certify(args, config, (&mut answer, &outcome), self.wish, about, out);
        told.worst = told.worst.max(certified);
        if certified >= Exit::Solver {
            // What is wrong is not told as an answer.
            return Ok(());
        }
        let foreign = args.problem.foreign.as_ref();
        let short = args.format == SolveFormat::Text && !self.quiet;
        let reason = if short { in_short(about, &outcome, &config.plan) } else { None };
        let (outcome, answer, others) = (&outcome, &answer, others.as_slice());
        let found = Found { loaded, objective, outcome, others, answer, searched, reason, foreign };
        if let Some(path) = &config.save {
            // Before anything else that may fail.
            let saved = std::mem::replace(&mut told.saved, Ok(()));
            told.saved = match PlanFormat::of_file(path) {
                None => {
                    told.lines += &(json(answer)? + "\n");
                    write_bytes(path, told.lines.as_bytes())
                }
                Some(format) => saved.and(found.save(format, path, self.several)),
            };
        }
        if index > 0 && short {
            out.line("")?;
        }
        found.print(args.format, (self.verbose, self.quiet), out)?;
        outcome.notes.iter().for_each(|note| out.remark(format_args!("note: {}", explain.note(note))));
        if let Some(picture) = picture {
            let drawn = found.draw(picture);
            told.drawn = std::mem::replace(&mut told.drawn, Ok(())).and(drawn);
        }
        told.worst = told.worst.max(status(answer));
        Ok(())
    }
}

/// What an answer says of the case that it is about.
fn case(part: Part, objective: &Objective) -> Case {
    let number = |number: usize| u32::try_from(number).unwrap_or(u32::MAX);
    Case { index: number(part.index + 1), of: number(part.of), decides: lanes::decides(objective) }
}

/// As [`solve`], with what is preferred and others that differ, saying how far it is where that takes long; also what failed after
/// something was found.
fn watched(
    loaded: &Loaded,
    objective: &Objective,
    wish: &Wish<'_>,
    args: &args::Solve,
    (config, explain, verbose): (&plan::Config, Explain<'_>, bool),
    out: &Output,
) -> Result<(Solved, Option<Failure>), (Failure, ReasonCode)> {
    if matches!(wish.smallest, Smallest::Constant(_)) && !objective.minimize.is_empty() {
        let name = &objective.name;
        out.remark(format_args!("note: {name}: its own `minimize` is left aside for `--minimize`"));
    }
    guard::doing("searching for a strategy");
    let own = plan::Config { watch: Watch::default(), ..config.clone() };
    guard::watching(&own.watch);
    let _waiting = Waiting::begin(&own.watch, verbose, out);
    let team = Team { args, config: &own, out };
    let mut solved = solve(loaded, objective, wish, &team, explain)?;
    // What fails from now on takes nothing from what was found.
    let further = further::prefer((loaded, objective), wish, &team, explain, &mut solved);
    let further =
        further.and_then(|()| further::others((loaded, objective), wish, &team, explain, &mut solved));
    Ok((solved, further.err().map(|(failure, _)| failure)))
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
    let Answer { minimized, costs, witness, several, .. } = &*answer;
    let all = several.as_ref().filter(|several| several.more == More::None).map(|several| Apart {
        differ: several.differ,
        from: witness.iter().chain(several.others.iter().map(|other| &other.witness)).cloned().collect(),
    });
    let said = Said { verdict: outcome.verdict, minimized: minimized.as_ref(), costs, all };
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
    if args.all.is_some() && (printed.is_some() || args.format == SolveFormat::Nusmv) {
        let message = "--format csv, ros, geojson, pddl and nusmv print one strategy, and --all finds several; --save FILE with such \
                       an ending makes a file of each, and --format json prints all";
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
            Ok(()) => Some(picture.with_name(&objective.name)),
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

/// What was found of an objective.
struct Solved {
    outcome: plan::Outcome,
    searched: Option<Searched>,
    open: Costs,
    /// What was found besides, where several answers are wanted.
    several: Option<plan::Several>,
}

impl Solved {
    fn new(outcome: plan::Outcome) -> Self {
        Solved { outcome, searched: None, open: Costs::default(), several: None }
    }
}

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
    if let Smallest::Constant(parameter) = &wish.smallest {
        return match parameter.least(loaded, objective, config, explain) {
            Ok((outcome, searched)) => {
                let problem = &searched.loaded.problem;
                let objective = problem.objective(name).unwrap_or(objective);
                let first = team.args.first;
                let straight = |outcome| search::straight(problem, objective, outcome, team.config);
                let outcome = if first { outcome } else { straight(outcome) };
                Ok(Solved { searched: Some(searched), ..Solved::new(outcome) })
            }
            Err(error) => Err(unsolved(name, parameter, error, explain)),
        };
    }
    let targets = wish.targets(loaded, objective).map_err(|failure| (failure, ReasonCode::Unsupported))?;
    let Decided { outcome, costs, undecided } =
        search::decide(&loaded.problem, objective, &targets, config, team.args.first)
            .map_err(|error| failed(&error, String::new()))?;
    Ok(Solved { open: Costs { costs, undecided }, ..Solved::new(outcome) })
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
        // Nor is one of which it is not known whether it is preferred.
        _ if answer.minimized.is_some() && answer.reason.is_some() => Exit::Undecided,
        // Neither are fewer strategies than there may be.
        _ if answer.several.as_ref().is_some_and(|several| several.more == More::Unknown) => Exit::Undecided,
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
