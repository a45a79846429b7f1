//! What is to be as small as possible: a constant, costs that the command line says, or those that objectives do.

use crate::args;
use crate::failure::{Failure, Result};
use crate::load::{self, Consts, Loaded};
use crate::output::Output;
use crate::parameter::Parameter;
use crate::report::WIDTH;
use hyperplan_problem::lower::targets;
use hyperplan_problem::{Objective, Target};
use hyperplan_syntax::{Diagnostic, SourceMap, ast, parse_exprs, render};
use std::time::Instant;

pub(crate) enum Wish<'a> {
    /// What the objective says.
    OfObjective,
    /// Nothing.
    Nothing,
    /// A constant.
    Constant(Box<Parameter<'a>>),
    /// Costs, with the constants of the file.
    Costs {
        exprs: Vec<ast::Expr>,
        consts: Consts,
        /// With the option's text only.
        sources: SourceMap,
    },
}

impl<'a> Wish<'a> {
    /// What the arguments ask for, and the problem.
    pub(crate) fn read(args: &'a args::Solve, out: &Output) -> Result<(Wish<'a>, Loaded)> {
        let text = match &args.minimize {
            None if args.own_minimize_aside => {
                return Ok((Wish::Nothing, Loaded::read(&args.problem, out)?));
            }
            None => return Ok((Wish::OfObjective, Loaded::read(&args.problem, out)?)),
            Some(args::Wish::Constant(wanted)) => {
                let (parameter, loaded) = Parameter::read(&args.problem, wanted, out)?;
                return Ok((Wish::Constant(Box::new(parameter)), loaded));
            }
            Some(args::Wish::Costs(text)) => text,
        };
        let start = Instant::now();
        let file = load::text(&args.problem)?;
        let (loaded, consts) = Loaded::with_consts(&args.problem, &file, start, out)?;
        Ok((Wish::of_costs(text, consts)?, loaded))
    }

    /// Costs as they are written.
    pub(crate) fn of_costs(text: &str, consts: Consts) -> Result<Wish<'static>> {
        let mut sources = SourceMap::new();
        let source = sources.add("--minimize", text);
        let (exprs, errors) = parse_exprs(source, text);
        match errors.as_slice() {
            [] => Ok(Wish::Costs { exprs, consts, sources }),
            errors => Err(failure(&sources, errors)),
        }
    }

    /// What is to be as small as possible of an objective; nothing where a constant is.
    pub(crate) fn targets(&self, loaded: &Loaded, objective: &Objective) -> Result<Vec<Target>> {
        match self {
            Wish::OfObjective => Ok(objective.minimize.clone()),
            Wish::Nothing | Wish::Constant(_) => Ok(Vec::new()),
            Wish::Costs { exprs, consts, sources } => {
                targets(&loaded.problem, objective, consts, exprs).map_err(|errors| failure(sources, &errors))
            }
        }
    }
}

fn failure(sources: &SourceMap, errors: &[Diagnostic]) -> Failure {
    let details = render(sources, errors, false, WIDTH);
    let failed = Failure::input("what `--minimize` says cannot be understood");
    Failure { details: details.trim_end().to_owned(), ..failed }
}
