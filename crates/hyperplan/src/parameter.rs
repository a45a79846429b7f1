//! The problems that a file describes for the values of one constant.

use crate::args::{self, Minimize};
use crate::explain::{Explain, Why};
use crate::failure::{Failure, Result};
use crate::load::{self, Consts, Loaded};
use crate::output::Output;
use hyperplan_plan::{self as plan, Config, Least, MinimizeError, Verdict, minimize};
use hyperplan_problem::answer::{Below, Minimized};
use hyperplan_problem::lower::uses;
use hyperplan_problem::{Lowered, Objective, Problem, Value};
use hyperplan_syntax::{SourceMap, ast, parse, render};
use std::ops::RangeInclusive;
use std::time::{Duration, Instant};

/// A file without errors in its syntax, and the values that its constant may take.
pub(crate) struct Parameter<'a> {
    args: &'a args::Problem,
    pub(crate) constant: &'a str,
    pub(crate) range: RangeInclusive<i64>,
    file: ast::File,
    /// With the file's own text only.
    sources: SourceMap,
}

impl<'a> Parameter<'a> {
    /// Reads a problem file. Its errors and warnings are those of the file as it is, or, if the range was given, for
    /// the first value.
    pub(crate) fn read(
        args: &'a args::Problem,
        wanted: &'a Minimize,
        out: &Output,
    ) -> Result<(Self, Loaded, Consts)> {
        let constant = wanted.constant.as_str();
        let start = Instant::now();
        let text = load::text(args)?;
        let mut sources = SourceMap::new();
        let source = sources.add(args.file.display().to_string(), text.as_str());
        let (file, _) = parse(source, &text);
        let own = declared(&file);
        if !own.contains(&constant) && !own.is_empty() {
            let names = own.join(", ");
            return Err(failure(
                args,
                format_args!("has no constant `{constant}` to minimize; it has {names}"),
            ));
        }
        let with = |value: Option<i64>| {
            let mut base = args.clone();
            base.set.extend(value.map(|value| (constant.to_owned(), value.to_string())));
            base
        };
        let mut range = wanted.range;
        let mut read = Loaded::lower(&with(range.map(|(lo, _)| lo)), &text);
        if let Some((lo, hi)) = range.filter(|_| read.0.has_errors()) {
            // Such as 0 in `[1,T]`.
            let fits = |value: &i64| !Loaded::lower(&with(Some(*value)), &text).0.has_errors();
            match (lo..=hi).skip(1).take(LEFT_OUT).find(fits) {
                Some(first) => {
                    let values = said_range(lo, first - 1);
                    out.remark(format_args!(
                        "note: {constant} = {values} is left out: the file has errors with it"
                    ));
                    range = Some((first, hi));
                    read = Loaded::lower(&with(Some(first)), &text);
                }
                None => out.remark(format_args!("note: with {constant} = {lo}:")),
            }
        }
        let (loaded, consts) = Loaded::of(&with(range.map(|(lo, _)| lo)), read, start, out)?;
        let value = consts.iter().find(|(name, _)| name == constant).map(|(_, value)| *value);
        let value = match value {
            Some(Value::Int(value)) => value,
            Some(_) => {
                let reason = format_args!("gives `{constant}` a fraction; only integers can be minimized");
                return Err(failure(args, reason));
            }
            None => return Err(failure(args, format_args!("has no constant `{constant}` to minimize"))),
        };
        if !uses(&file, constant) {
            return Err(failure(args, format_args!("never uses the constant `{constant}`")));
        }
        let range = match range {
            Some((lo, hi)) => lo..=hi,
            None if value < 0 => {
                let message = format_args!(
                    "has {constant} = {value}, so the range must be said: --minimize {constant}=LO..HI"
                );
                return Err(failure(args, message));
            }
            None => 0..=value,
        };
        let mut parameter = Parameter { args, constant, range, file, sources };
        if wanted.range.is_none() {
            // Such as 0 in `[1,T]`. The file's own value has no errors, so there is such a value.
            let lo = (0..value).find(|&value| !parameter.lower(value).0.has_errors()).unwrap_or(value);
            parameter.range = lo..=value;
        }
        Ok((parameter, loaded, consts))
    }

    /// The least value for which an objective is realizable. `base` is the file for another value.
    pub(crate) fn least(
        &self,
        base: &Loaded,
        objective: &Objective,
        config: &Config,
        explain: Explain<'_>,
    ) -> Result<(plan::Outcome, Searched), MinimizeError<Failure>> {
        let mut time = base.time;
        let mut problem = |value: i64| {
            let start = Instant::now();
            let problem = self.problem(value);
            time += start.elapsed();
            problem
        };
        let least = minimize(&objective.name, self.range.clone(), &mut problem, config)?;
        Ok(self.told(base, least, time, explain))
    }

    /// What was found out of the least value, in so much time for reading the file.
    pub(crate) fn told(
        &self,
        base: &Loaded,
        least: Least,
        time: Duration,
        explain: Explain<'_>,
    ) -> (plan::Outcome, Searched) {
        let undecided = least.undecided.as_ref().map(|reason| Why::new(reason, explain));
        let (below, words) = self.said(&least, undecided.as_ref());
        let minimized = Minimized {
            constant: self.constant.to_owned(),
            range: (*self.range.start(), *self.range.end()),
            value: (least.outcome.verdict == Verdict::Realizable).then_some(least.value),
            below,
        };
        let loaded =
            Loaded { file: base.file.clone(), problem: least.problem, sources: base.sources.clone(), time };
        (least.outcome, Searched { loaded, minimized, undecided, words })
    }

    /// What is known of smaller values, and the whole result in words.
    fn said(&self, least: &Least, undecided: Option<&Why>) -> (Below, String) {
        let Least { value, proved, .. } = *least;
        let (name, first) = (self.constant, *self.range.start());
        let values = said_range;
        let below = if proved == first { Below::OutOfRange } else { Below::Unrealizable };
        let refuted = match proved > first {
            true => format!("; unrealizable with {}", values(first, proved - 1)),
            false => String::new(),
        };
        match (least.outcome.verdict, undecided.map(|why| &why.words)) {
            (Verdict::Realizable, Some(reason)) => {
                let open = values(proved, value - 1);
                let words =
                    format!("realizable with {name} = {value}, unknown with {open}: {reason}{refuted}");
                (Below::Unknown, words)
            }
            (Verdict::Realizable, None) if proved == first => {
                (below, format!("realizable with {name} = {value}, the first of the range"))
            }
            (Verdict::Realizable, None) => {
                let refuted = values(first, value - 1);
                (below, format!("realizable with {name} = {value}, unrealizable with {refuted}"))
            }
            (Verdict::Unrealizable, _) => {
                (below, format!("unrealizable with {name} = {}", values(first, value)))
            }
            (Verdict::Unknown, reason) => {
                let reason = reason.map_or("undecided", String::as_str);
                let below = if value == proved { below } else { Below::Unknown };
                (below, format!("unknown with {name} = {value}: {reason}{refuted}"))
            }
        }
    }

    /// The problem for a value.
    pub(crate) fn problem(&self, value: i64) -> Result<Problem> {
        let (lowered, sources) = self.lower(value);
        if lowered.has_errors() {
            let errors: Vec<_> = lowered.diagnostics.into_iter().filter(|d| d.is_error()).collect();
            let errors = render(&sources, &errors, false, crate::report::WIDTH);
            let failed = failure(self.args, format_args!("has errors for {} = {value}", self.constant));
            return Err(Failure { details: errors.trim_end().to_owned(), ..failed });
        }
        Ok(lowered.problem)
    }

    fn lower(&self, value: i64) -> (Lowered, SourceMap) {
        let mut sources = self.sources.clone();
        let lowered = load::lower_file(self.args, &self.file, &mut sources, (self.constant, value));
        (lowered, sources)
    }
}

/// So many values at the lower end of a range may be left out.
const LEFT_OUT: usize = 100;

fn said_range(lo: i64, hi: i64) -> String {
    if lo == hi { lo.to_string() } else { format!("{lo}..{hi}") }
}

/// What came of a search for the least value.
pub(crate) struct Searched {
    /// The file with the value that the outcome is about.
    pub(crate) loaded: Loaded,
    pub(crate) minimized: Minimized,
    /// Why the value found may not be the least.
    pub(crate) undecided: Option<Why>,
    /// The result, on one line.
    pub(crate) words: String,
}

fn failure(args: &args::Problem, what: std::fmt::Arguments<'_>) -> Failure {
    Failure::input(format_args!("{} {what}", args.file.display()))
}

fn declared(file: &ast::File) -> Vec<&str> {
    let constants = file.items.iter().filter_map(|item| match item {
        ast::Item::Const(constant) => Some(constant.name.name.as_str()),
        _ => None,
    });
    constants.collect()
}
