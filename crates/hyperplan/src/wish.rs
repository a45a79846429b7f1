//! What is to be as small as possible: a constant, costs that the command line says, or those that objectives do; and what is
//! preferred among strategies that are equal in that.

use crate::args;
use crate::failure::{Failure, Result};
use crate::load::{self, Consts, Loaded};
use crate::output::Output;
use crate::parameter::Parameter;
use crate::report::WIDTH;
use hyperplan_problem::lower::targets;
use hyperplan_problem::{Objective, Target, Value};
use hyperplan_syntax::{Diagnostic, SourceMap, ast, parse_exprs, render};
use std::time::Instant;

/// What is wanted of strategies besides the objective.
pub(crate) struct Wish<'a> {
    pub(crate) smallest: Smallest<'a>,
    preferred: Option<Sums>,
}

/// What is to be as small as possible.
pub(crate) enum Smallest<'a> {
    /// What the objective says.
    OfObjective,
    /// Nothing.
    Nothing,
    /// A constant.
    Constant(Box<Parameter<'a>>),
    /// Costs.
    Costs(Sums),
}

/// Sums of costs as an option writes them, with the constants of the file.
pub(crate) struct Sums {
    option: &'static str,
    exprs: Vec<ast::Expr>,
    consts: Consts,
    /// With the option's text only.
    sources: SourceMap,
}

impl Sums {
    /// Costs as they are written.
    pub(crate) fn read(option: &'static str, text: &str, consts: Consts) -> Result<Sums> {
        let mut sources = SourceMap::new();
        let source = sources.add(option, text);
        let (exprs, errors) = parse_exprs(source, text);
        let sums = Sums { option, exprs, consts, sources };
        if errors.is_empty() { Ok(sums) } else { Err(sums.failure(&errors)) }
    }

    /// What they are of an objective.
    pub(crate) fn of(&self, loaded: &Loaded, objective: &Objective) -> Result<Vec<Target>> {
        let found = targets(&loaded.problem, objective, &self.consts, &self.exprs);
        found.map_err(|errors| self.failure(&errors))
    }

    fn failure(&self, errors: &[Diagnostic]) -> Failure {
        let details = render(&self.sources, errors, false, WIDTH);
        let failed = Failure::input(format_args!("what `{}` says cannot be understood", self.option));
        Failure { details: details.trim_end().to_owned(), ..failed }
    }
}

impl<'a> Wish<'a> {
    /// What the arguments ask for, and the problem.
    pub(crate) fn read(args: &'a args::Solve, out: &Output) -> Result<(Wish<'a>, Loaded)> {
        if let Some(args::Wish::Constant(wanted)) = &args.minimize {
            let (parameter, loaded, consts) = Parameter::read(&args.problem, wanted, out)?;
            let smallest = Smallest::Constant(Box::new(parameter));
            return Ok((Wish { smallest, preferred: preferred(args, consts)? }, loaded));
        }
        let start = Instant::now();
        let file = load::text(&args.problem)?;
        let (loaded, consts) = Loaded::with_consts(&args.problem, &file, start, out)?;
        let smallest = match &args.minimize {
            Some(args::Wish::Costs(text)) => Smallest::Costs(Sums::read("--minimize", text, consts.clone())?),
            _ if args.own_minimize_aside => Smallest::Nothing,
            _ => Smallest::OfObjective,
        };
        Ok((Wish { smallest, preferred: preferred(args, consts)? }, loaded))
    }

    /// What has to be as small as possible of an objective; nothing where a constant has.
    pub(crate) fn kept(&self, loaded: &Loaded, objective: &Objective) -> Result<Vec<Target>> {
        match &self.smallest {
            Smallest::OfObjective => Ok(objective.minimize.clone()),
            Smallest::Nothing | Smallest::Constant(_) => Ok(Vec::new()),
            Smallest::Costs(sums) => sums.of(loaded, objective),
        }
    }

    /// What is preferred of an objective's strategies, for a value of the constant that is to be as small as possible, if one is.
    pub(crate) fn preferred(
        &self,
        loaded: &Loaded,
        objective: &Objective,
        value: Option<i64>,
    ) -> Result<Vec<Target>> {
        let Some(sums) = &self.preferred else { return Ok(Vec::new()) };
        let (Smallest::Constant(parameter), Some(value)) = (&self.smallest, value) else {
            return sums.of(loaded, objective);
        };
        let mut consts = sums.consts.clone();
        for (name, known) in &mut consts {
            if name == parameter.constant {
                *known = Value::Int(value);
            }
        }
        let found = targets(&loaded.problem, objective, &consts, &sums.exprs);
        found.map_err(|errors| sums.failure(&errors))
    }

    /// All that one search makes small, what counts most first: where a constant is to be small, nothing.
    pub(crate) fn targets(&self, loaded: &Loaded, objective: &Objective) -> Result<Vec<Target>> {
        if let Smallest::Constant(_) = self.smallest {
            return Ok(Vec::new());
        }
        let mut targets = self.kept(loaded, objective)?;
        targets.extend(self.preferred(loaded, objective, None)?);
        Ok(targets)
    }
}

/// What is preferred, if that is said.
fn preferred(args: &args::Solve, consts: Consts) -> Result<Option<Sums>> {
    args.prefer.as_ref().map(|text| Sums::read("--prefer", text, consts)).transpose()
}
