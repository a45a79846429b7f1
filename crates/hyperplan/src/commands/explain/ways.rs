//! Ways to give an objective more time: constants of its file, or what stands in it.

use crate::args;
use crate::load::{self, Consts};
use hyperplan_plan::explain::{Longer, Time, longer};
use hyperplan_problem::lower::uses;
use hyperplan_problem::{Mode, Objective, Overrides, Problem, Value};
use hyperplan_syntax::{SourceMap, ast, parse};

/// So many constants are tried.
const CONSTANTS: usize = 3;

/// A file, and what its constants are.
pub(super) struct Ways<'a> {
    pub(super) args: &'a args::Problem,
    pub(super) text: &'a str,
    pub(super) consts: &'a Consts,
}

impl<'a> Ways<'a> {
    /// The ways of an objective of the file.
    pub(super) fn of(&'a self, problem: &'a Problem, objective: &'a Objective) -> Vec<Longer<'a>> {
        let mut ways = match &self.args.foreign {
            Some(_) => self.bound().into_iter().collect(),
            None => self.constants(objective),
        };
        if ways.is_empty() {
            ways.extend(longer(problem, objective));
        }
        ways
    }

    /// The bound with which a formula of another tool is read.
    fn bound(&self) -> Option<Longer<'a>> {
        let foreign = self.args.foreign.as_ref()?;
        let value = i64::from(foreign.options.bound?);
        let overrides = Overrides { values: self.args.set.clone() };
        let problem_of = move |value: i64| {
            let mut longer = foreign.clone();
            longer.options.bound = Some(u32::try_from(value).ok()?);
            let (lowered, _) = longer.lower(&overrides);
            (!lowered.has_errors()).then_some(lowered.problem)
        };
        Some(Longer { time: Time::Bound, value, problem_of: Box::new(problem_of) })
    }

    /// Constants with which paths get longer.
    fn constants(&self, objective: &Objective) -> Vec<Longer<'a>> {
        let mut sources = SourceMap::new();
        let source = sources.add(self.args.file.display().to_string(), self.text);
        let (file, _) = parse(source, self.text);
        let now = length(objective);
        let mut ways = Vec::new();
        for (name, value) in self.consts.iter() {
            let Value::Int(value) = *value else { continue };
            if ways.len() == CONSTANTS || value < 0 || !uses(&file, name) {
                continue;
            }
            let mut problem_of = self.with(name, file.clone(), sources.clone());
            let more = value.checked_add(1).and_then(&mut problem_of);
            let longer = more.and_then(|more| Some(length(more.objective(&objective.name)?) > now));
            if longer == Some(true) {
                ways.push(Longer { time: Time::Constant(name.clone()), value, problem_of });
            }
        }
        ways
    }

    /// The problem with other values of a constant.
    fn with(
        &self,
        name: &str,
        file: ast::File,
        sources: SourceMap,
    ) -> Box<dyn FnMut(i64) -> Option<Problem> + 'a> {
        let (args, name) = (self.args, name.to_owned());
        Box::new(move |value| {
            let lowered = load::lower_file(args, &file, &mut sources.clone(), (&name, value));
            (!lowered.has_errors()).then_some(lowered.problem)
        })
    }
}

/// The steps of the longest of the leading paths.
fn length(objective: &Objective) -> u64 {
    if let Mode::Within(steps) = objective.mode {
        return u64::from(steps);
    }
    let horizons = hyperplan_horizon::horizons(objective);
    objective.leading_block().into_iter().filter_map(|path| horizons[path].steps).max().unwrap_or(0)
}
