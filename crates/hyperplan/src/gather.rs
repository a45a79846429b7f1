//! Which files were given: a problem file, or those of other tools, and a strategy.

use crate::args::{Cli, Command, Plan, Reading};
use crate::failure::{Failure, Result};
use crate::files;
use hyperplan::foreign::{Foreign, is_foreign, text_of};
use hyperplan_import::{Input, Options};
use hyperplan_outlet::one_line;
use std::path::{Path, PathBuf};

/// Sorts what was typed behind the file: models and formulas belong to it, a strategy is one. Texts are read.
pub(crate) fn gather(cli: &mut Cli) -> Result<()> {
    match &mut cli.command {
        Command::Solve(args) => {
            args.problem.foreign = found(&args.problem.file, &mut args.others.more, &args.others.reading)?
        }
        Command::Horizon(args) => {
            args.problem.foreign = found(&args.problem.file, &mut args.others.more, &args.others.reading)?
        }
        Command::Check(args) => {
            args.problem.foreign = found(&args.problem.file, &mut args.others.more, &args.others.reading)?
        }
        Command::Import(args) => {
            args.problem.foreign = found(&args.problem.file, &mut args.others.more, &args.others.reading)?;
            if let Some(foreign) = &mut args.problem.foreign {
                foreign.options.status = args.status;
            }
        }
        Command::Verify(args) => {
            let mut more = behind(&mut args.plan);
            args.problem.foreign = found(&args.problem.file, &mut more, &args.reading)?;
            one_strategy(&args.plan, args.model.is_some())?;
            if args.model.is_none() && args.plan.strategy.is_empty() && args.plan.actions.is_empty() {
                return Err(Failure::input("a strategy is needed: STRATEGY.json, --actions or --model"));
            }
        }
        Command::Explain(args) => {
            let mut more = behind(&mut args.plan);
            args.problem.foreign = found(&args.problem.file, &mut more, &args.reading)?;
            one_strategy(&args.plan, false)?;
        }
        Command::Certify(args) => {
            let all = std::mem::take(&mut args.folder).into_iter();
            let (mut more, folders) = all.partition(|path| is_foreign(path));
            args.folder = folders;
            args.foreign = found(&args.file, &mut more, &args.reading)?;
        }
        Command::Plot(args) => {
            let mut more = behind(&mut args.plan);
            args.problem.foreign = found(&args.problem.file, &mut more, &args.reading)?;
            one_strategy(&args.plan, false)?;
        }
        Command::Emit(args) => {
            if let Some(file) = &args.file {
                args.foreign = found(file, &mut args.others.more, &args.others.reading)?;
            }
        }
        Command::Compare(_)
        | Command::Solvers(_)
        | Command::Templates(_)
        | Command::New(_)
        | Command::Completions(_)
        | Command::Man(_)
        | Command::Supervise => {}
    }
    Ok(())
}

fn one_strategy(plan: &Plan, model: bool) -> Result<()> {
    if !plan.strategy.is_empty() && (model || !plan.actions.is_empty()) {
        let other = if model { "--model" } else { "--actions" };
        return Err(Failure::input(format_args!("a strategy file and {other} cannot be used together")));
    }
    Ok(())
}

/// The text of a file of another tool.
fn text(path: &Path) -> Result<String> {
    // Standard input is nothing that ends in a known way.
    text_of(path).map_err(|why| Failure::input(format_args!("cannot read {}: {why}", files::name(path))))
}

/// The models and formulas among what was given as strategies.
fn behind(plan: &mut Plan) -> Vec<PathBuf> {
    let (more, strategies) =
        std::mem::take(&mut plan.strategy).into_iter().partition(|path| is_foreign(path));
    plan.strategy = strategies;
    more
}

fn found(file: &Path, more: &mut Vec<PathBuf>, reading: &Reading) -> Result<Option<Foreign>> {
    let all: Vec<PathBuf> = std::mem::take(more);
    if !is_foreign(file) {
        return match (all.first(), reading.bound) {
            (Some(other), _) => {
                let (file, other) = (files::name(file), files::name(other));
                Err(Failure::input(format_args!(
                    "{other} cannot be read together with {file}: only models (.smv, .aag, .aig, .txt, .pddl) and formulas (.hq) of other tools \
                     are several files"
                )))
            }
            (None, Some(_)) => Err(Failure::input(
                "--bound is for formulas of other tools (.hq); in a problem file write `within K`",
            )),
            (None, None) => Ok(None),
        };
    }
    let files = std::iter::once(file).chain(all.iter().map(PathBuf::as_path));
    together(files, options(reading)?).map(Some)
}

/// How formulas are to be read.
pub(crate) fn options(reading: &Reading) -> Result<Options> {
    if let Some(semantics) = reading.semantics.as_deref() {
        known_semantics("--semantics", semantics)?;
    }
    let Reading { bound, semantics, dialect } = reading.clone();
    Ok(Options { bound, semantics, dialect, status: None })
}

/// Refuses semantics that there are not.
pub(crate) fn known_semantics(what: &str, semantics: &str) -> Result<()> {
    if ["pes", "opt", "hpes", "hopt"].contains(&semantics) {
        return Ok(());
    }
    Err(Failure::input(format_args!("{what} {semantics} is none of pes, opt, hpes and hopt")))
}

/// Models and formulas, read.
pub(crate) fn together<'p>(files: impl Iterator<Item = &'p Path>, options: Options) -> Result<Foreign> {
    let mut inputs = Vec::new();
    for path in files {
        if !is_foreign(path) {
            let name = files::name(path);
            return Err(Failure::input(format_args!(
                "{name} is neither a model (.smv, .aag, .aig, .txt, .pddl) nor a formula (.hq) of another tool"
            )));
        }
        let name = one_line(&path.display().to_string()).into_owned();
        inputs.push(Input { name, text: text(path)? });
    }
    Ok(Foreign { inputs, options })
}
