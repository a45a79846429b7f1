//! Files of other tools, in place of a problem file: which were given, and what they mean.

use crate::args::{Cli, Command, Others, Plan};
use crate::failure::{Failure, Result};
use crate::files::{self, read_source};
use hyperplan_import::{Imported, Input, Kind, Options, import};
use hyperplan_problem::{Lowered, NoFiles, Overrides, lower};
use hyperplan_syntax::{Diagnostic, SourceMap, print};
use std::path::{Path, PathBuf};

/// Models and formulas, with their texts.
#[derive(Clone, Debug)]
pub(crate) struct Foreign {
    inputs: Vec<Input>,
    options: Options,
}

/// Sorts what was typed behind the file: models and formulas belong to it, a strategy is one. Texts are read.
pub(crate) fn gather(cli: &mut Cli) -> Result<()> {
    match &mut cli.command {
        Command::Solve(args) => args.problem.foreign = found(&args.problem.file, &mut args.others, None)?,
        Command::Horizon(args) => args.problem.foreign = found(&args.problem.file, &mut args.others, None)?,
        Command::Check(args) => args.problem.foreign = found(&args.problem.file, &mut args.others, None)?,
        Command::Import(args) => args.problem.foreign = found(&args.problem.file, &mut args.others, None)?,
        Command::Verify(args) => {
            let plan = Some(&mut args.plan);
            args.problem.foreign = found(&args.problem.file, &mut args.others, plan)?;
            one_strategy(&args.plan, args.model.is_some())?;
            if args.model.is_none() && args.plan.strategy.is_none() && args.plan.actions.is_empty() {
                return Err(Failure::input("a strategy is needed: STRATEGY.json, --actions or --model"));
            }
        }
        Command::Plot(args) => {
            let plan = Some(&mut args.plan);
            args.problem.foreign = found(&args.problem.file, &mut args.others, plan)?;
            one_strategy(&args.plan, false)?;
        }
        Command::Emit(args) => {
            if let Some(file) = &args.file {
                args.foreign = found(file, &mut args.others, None)?;
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
    if plan.strategy.is_some() && (model || !plan.actions.is_empty()) {
        let other = if model { "--model" } else { "--actions" };
        return Err(Failure::input(format_args!("a strategy file and {other} cannot be used together")));
    }
    Ok(())
}

fn kind(path: &Path) -> Option<Kind> {
    Kind::of(path.to_str()?)
}

fn found(file: &Path, others: &mut Others, plan: Option<&mut Plan>) -> Result<Option<Foreign>> {
    let mut all: Vec<PathBuf> = std::mem::take(&mut others.more);
    if let Some(plan) = plan {
        // What stands second is a strategy, unless it is a model or a formula; then one may stand last.
        if plan.strategy.as_deref().is_some_and(|second| kind(second).is_some()) {
            all.splice(0..0, plan.strategy.take());
            if all.last().is_some_and(|last| kind(last).is_none()) {
                plan.strategy = all.pop();
            }
        }
    }
    let own = kind(file);
    if own.is_none() {
        return match (all.first(), others.bound) {
            (Some(other), _) => {
                let (file, other) = (files::name(file), files::name(other));
                Err(Failure::input(format_args!(
                    "{other} cannot be read together with {file}: only models (.smv) and formulas (.hq) of other tools \
                     are several files"
                )))
            }
            (None, Some(_)) => Err(Failure::input(
                "--bound is for formulas of other tools (.hq); in a problem file write `within K`",
            )),
            (None, None) => Ok(None),
        };
    }
    if let Some(semantics) = others.semantics.as_deref()
        && !["pes", "opt", "hpes", "hopt"].contains(&semantics)
    {
        return Err(Failure::input(format_args!(
            "--semantics {semantics} is none of pes, opt, hpes and hopt"
        )));
    }
    let mut inputs = Vec::new();
    for path in std::iter::once(file).chain(all.iter().map(PathBuf::as_path)) {
        if kind(path).is_none() {
            let name = files::name(path);
            return Err(Failure::input(format_args!(
                "{name} is neither a model (.smv) nor a formula (.hq) of another tool"
            )));
        }
        inputs.push(Input { name: path.display().to_string(), text: read_source(path)? });
    }
    let options = Options { bound: others.bound, semantics: others.semantics.clone() };
    Ok(Some(Foreign { inputs, options }))
}

impl Foreign {
    /// What the files mean, and what is wrong with them.
    pub(crate) fn lower(&self, overrides: &Overrides) -> (Lowered, SourceMap) {
        let (lowered, sources, _) = self.read(overrides);
        (lowered, sources)
    }

    /// The same, with what the files became.
    pub(crate) fn read(&self, overrides: &Overrides) -> (Lowered, SourceMap, Imported) {
        let mut sources = SourceMap::new();
        let mut imported = import(&self.inputs, &self.options, &mut sources);
        for diagnostic in &mut imported.diagnostics {
            if diagnostic.code == "unbounded-operator" {
                diagnostic.help = Some("say it with `--bound K`".to_owned());
            }
        }
        let mut diagnostics = std::mem::take(&mut imported.diagnostics);
        if diagnostics.iter().any(Diagnostic::is_error) {
            return (Lowered { diagnostics, ..Lowered::default() }, sources, imported);
        }
        let mut lowered = lower(&imported.file, &mut sources, &NoFiles, overrides);
        diagnostics.append(&mut lowered.diagnostics);
        // What stands in a model is not there for one formula alone: nothing of it is called unused.
        let unused = std::mem::take(&mut imported.doubts);
        (Lowered { diagnostics, unused, ..lowered }, sources, imported)
    }
}

/// What files became, as a problem file that says where things come from.
pub(crate) fn text(imported: &Imported) -> String {
    format!("{}\n{}", imported.about, print(&imported.file, ""))
}
