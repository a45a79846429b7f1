//! Files into problems and strategies.

use crate::args;
use crate::explain::advise;
use crate::failure::{Failure, Result};
use crate::files::{self, read_source};
use crate::output::Output;
use crate::report;
use hyperplan::disk::Beside;
use hyperplan_problem::answer::{StrategyFile, plans, to_strategy};
use hyperplan_problem::{Lowered, Objective, Overrides, Problem, Strategy, Value, lower, read};
use hyperplan_syntax::{SourceMap, ast};
use hyperplan_verify::{Budget, complete};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// A problem without errors.
pub(crate) struct Loaded {
    /// The file as it was named.
    pub(crate) file: String,
    pub(crate) problem: Problem,
    pub(crate) sources: SourceMap,
    /// How long reading took.
    pub(crate) time: Duration,
}

impl Loaded {
    /// Reads a problem file; its errors and warnings are printed.
    pub(crate) fn read(args: &args::Problem, out: &Output) -> Result<Loaded> {
        let start = Instant::now();
        let text = text(args)?;
        Self::with_consts(args, &text, start, out).map(|(loaded, _)| loaded)
    }

    /// As [`Loaded::read`], of a text that was read, which began at `start`; with its constants.
    pub(crate) fn with_consts(
        args: &args::Problem,
        text: &str,
        start: Instant,
        out: &Output,
    ) -> Result<(Loaded, Consts)> {
        Self::of(args, Self::lower(args, text), start, out)
    }

    /// As [`Loaded::with_consts`], of what a text was found to mean.
    pub(crate) fn of(
        args: &args::Problem,
        (lowered, sources): (Lowered, SourceMap),
        start: Instant,
        out: &Output,
    ) -> Result<(Loaded, Consts)> {
        report::diagnostics(&sources, &lowered.diagnostics, out);
        if lowered.has_errors() {
            return Err(Failure::said());
        }
        let (file, problem) = (args.file.display().to_string(), lowered.problem);
        Ok((Loaded { file, problem, sources, time: start.elapsed() }, lowered.consts))
    }

    /// What a text means, and what is wrong with it.
    pub(crate) fn lower(args: &args::Problem, text: &str) -> (Lowered, SourceMap) {
        let folder = Beside(args.file.parent().unwrap_or(Path::new("")).to_owned());
        let overrides = Overrides { values: args.set.clone() };
        if let Some(foreign) = &args.foreign {
            let (mut lowered, sources) = foreign.lower(&overrides);
            advise(&mut lowered.diagnostics);
            return (lowered, sources);
        }
        let mut sources = SourceMap::new();
        let lowered = read(&mut sources, &args.file.display().to_string(), text, &folder, &overrides);
        (lowered, sources)
    }

    /// The objectives that are meant: the one of that name, all for `all`, and without a name the only one.
    pub(crate) fn selected(&self, name: Option<&str>, all_by_default: bool) -> Result<Vec<&Objective>> {
        let objectives: Vec<&Objective> = self.problem.objectives.iter().collect();
        let names: Vec<&str> = objectives.iter().map(|o| o.name.as_str()).collect();
        match name {
            _ if objectives.is_empty() => Err(Failure::input(format_args!("{} has no objective", self.file))),
            // Where one is called so, it is meant.
            Some("all") if self.problem.objective("all").is_none() => Ok(objectives),
            Some(name) => match self.problem.objective(name) {
                Some(objective) => Ok(vec![objective]),
                None => {
                    let names = names.join(", ");
                    Err(Failure::input(format_args!(
                        "{} has no objective `{name}`; it has {names}",
                        self.file
                    )))
                }
            },
            None if objectives.len() == 1 || all_by_default => Ok(objectives),
            None => Err(Failure::input(format_args!(
                "{} has several objectives; choose one of {} with --objective NAME, or --objective all",
                self.file,
                names.join(", ")
            ))),
        }
    }
}

/// The text of a problem file; those of other tools were read before.
pub(crate) fn text(args: &args::Problem) -> Result<String> {
    if args.foreign.is_some() { Ok(String::new()) } else { read_source(&args.file) }
}

/// Constants with their values.
pub(crate) type Consts = Vec<(String, Value)>;

/// What a parsed file means with a constant replaced.
pub(crate) fn lower_file(
    args: &args::Problem,
    file: &ast::File,
    sources: &mut SourceMap,
    (constant, value): (&str, i64),
) -> Lowered {
    let folder = Beside(args.file.parent().unwrap_or(Path::new("")).to_owned());
    let overrides = Overrides { values: args.set.clone() }.with(constant, value);
    lower(file, sources, &folder, &overrides)
}

/// Where strategy files are described.
const DESCRIBED: &str = "docs/strategies.md says what strategies look like";

/// A strategy file.
pub(crate) struct Given {
    /// The file as it was named.
    pub(crate) name: String,
    answers: Vec<StrategyFile>,
}

impl Given {
    /// What the user gave, if anything.
    pub(crate) fn of(plan: &args::Plan) -> Result<Option<Given>> {
        match plan.strategy.as_slice() {
            [] => {}
            [file] => return Given::read(file).map(Some),
            files => return Given::together(files).map(Some),
        }
        let answer = StrategyFile { objective: None, verdict: None, witness: Some(plan.actions.clone()) };
        let given = Given { name: "--actions".to_owned(), answers: vec![answer] };
        Ok((!plan.actions.is_empty()).then_some(given))
    }

    /// Reads a strategy file.
    fn read(path: &Path) -> Result<Given> {
        let name = files::name(path);
        let answers = plans::read(&read_source(path)?)
            .map_err(|e| Failure::input(format_args!("{name} is no strategy: {e}; {DESCRIBED}")))?;
        if answers.is_empty() {
            return Err(Failure::input(format_args!("{name} is no strategy: it is empty; {DESCRIBED}")));
        }
        Ok(Given { name, answers })
    }

    /// Reads the files with the paths of one strategy.
    fn together(paths: &[PathBuf]) -> Result<Given> {
        let mut all = Given { name: String::new(), answers: Vec::new() };
        let mut whole = StrategyFile { objective: None, verdict: None, witness: None };
        for path in paths {
            let Given { name, answers } = Given::read(path)?;
            let [one] = answers.as_slice() else {
                let message =
                    format!("{name} has several strategies: of several files each gives paths of one");
                return Err(Failure::input(message));
            };
            if all.name.is_empty() {
                all.name = name;
            } else {
                all.name = format!("{}, {name}", all.name);
            }
            if whole.objective.is_some() && one.objective.is_some() && whole.objective != one.objective {
                return Err(Failure::input(format_args!("{} are for different objectives", all.name)));
            }
            whole.objective = whole.objective.or_else(|| one.objective.clone());
            whole.witness.get_or_insert_default().extend(one.witness.clone().unwrap_or_default());
        }
        all.answers.push(whole);
        Ok(all)
    }

    /// The strategies of the file that are meant, each with its objective.
    pub(crate) fn strategies<'a>(
        &self,
        loaded: &'a Loaded,
        name: Option<&str>,
    ) -> Result<Vec<(&'a Objective, Strategy)>> {
        let failure = |message: String| Failure::input(format_args!("{}: {message}; {DESCRIBED}", self.name));
        let wanted = name.filter(|n| *n != "all" || loaded.problem.objective(n).is_some());
        let fits = |answer: &&StrategyFile| match (wanted, &answer.objective) {
            (Some(wanted), Some(own)) => wanted == own,
            _ => true,
        };
        let mut found = Vec::new();
        for answer in self.answers.iter().filter(fits) {
            let objective = match wanted.or(answer.objective.as_deref()) {
                Some(name) => loaded.selected(Some(name), false)?,
                None => loaded.selected(None, false)?,
            };
            let Some(objective) = objective.first().copied() else { continue };
            let Some(witness) = &answer.witness else {
                return Err(failure(format!("there is no witness for objective {}", objective.name)));
            };
            let problem = &loaded.problem;
            let witness = plans::meant(problem, objective, witness);
            let mut strategy =
                to_strategy(problem, objective, &witness).map_err(|e| failure(e.to_string()))?;
            complete(problem, objective, &mut strategy, &Budget::default())
                .map_err(|open| failure(open.describe(problem, objective)))?;
            found.push((objective, strategy));
        }
        match (found.is_empty(), wanted) {
            (true, Some(wanted)) => Err(failure(format!("there is no strategy for objective {wanted}"))),
            _ => Ok(found),
        }
    }
}
