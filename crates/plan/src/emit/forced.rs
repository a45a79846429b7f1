//! Which steps of a strategy are forced, as an incremental benchmark that keeps its quantifiers.
//!
//! At the bottom of the assertion stack stands the whole query, which is checked first. Then, step by step, it is asked
//! between `push` and `pop` whether the leading paths can do something else in that step than one strategy does, once
//! all steps before it are those of the strategy; below, the step becomes that of the strategy. The first check is
//! satisfiable, since there is a strategy, and so is what lies at the bottom at any time: that strategy is a model.
//! The others are either.
//!
//! The answers are those of a solver without quantifiers, asked the same of the expanded query. Both queries have the
//! winning choices of the leading block for models, whatever they are written in, and the steps are told apart by
//! actions, which both know.

use super::EmitConfig;
use super::tape::Tape;
use crate::direct::{self, Direct};
use crate::fact::{Error, Note, Unsupported};
use crate::oracle::solver_for;
use hyperplan_encode::{Encoder, Known, Narrowing};
use hyperplan_problem::PathId;
use hyperplan_smt::{Model, Status, Term};
use hyperplan_solver::{Answer, Options, Session, open};

/// Asks, and keeps what is asked with its answers.
pub(super) fn dialogue(
    encoder: &Encoder<'_>,
    config: &EmitConfig,
    blocks: &[Vec<PathId>],
    exists: bool,
    notes: &mut Vec<Note>,
) -> Result<(Tape, Option<Status>), Error> {
    let solver = solver_for(!encoder.is_finite()).ok_or(Unsupported::NoArithmeticSolver)?;
    let Encoder { problem, objective, task, .. } = encoder;
    let teller = Encoder::new(problem, objective, None, task.limits, task.stop)?;
    let mut told = direct::expand(&teller, blocks, exists, Narrowing::default())?;
    let options = Options { incremental: true, ..Options::default() };
    let mut session = open(&solver, &options)?;
    match session.check(&told.query.script, &[], &config.deadline)? {
        Answer::Sat => {}
        Answer::Unsat => return Err(Unsupported::NoSteps.into()),
        Answer::Unknown(_) => return Err(Unsupported::ShortDialogue.into()),
    }
    let plan = plan(&told, &mut *session, &blocks[0])?;
    let mut asked = direct::keep(encoder, blocks, exists)?;
    let mut tape = Tape::new(config.comments);
    tape.begin(&asked.query.script, true);
    let steps = plan.iter().flatten().map(|known| known.actions.len()).max().unwrap_or(0);
    let mut cut = false;
    for step in 0..steps {
        let [other, there] = [&asked, &told].map(|direct| otherwise(direct, &plan, step));
        let other = asked.query.script.terms.or(&other);
        let there = told.query.script.terms.or(&there);
        if other == Term::FALSE {
            continue;
        }
        let answer = match there {
            Term::FALSE => Answer::Unsat,
            _ => session.check(&told.query.script, &[there], &config.deadline)?,
        };
        let satisfiable = match answer {
            Answer::Unknown(reason) => {
                notes.push(Note::DialogueCut(reason.into()));
                cut = true;
                break;
            }
            answer => answer == Answer::Sat,
        };
        tape.aside(&asked.query.script, other, satisfiable, &format!("another step {}", step + 1));
        asked.query.script.section(format!("step.{}", step + 1), format!("step {} is made", step + 1));
        asked.query.script.assert(!other);
        told.query.script.assert(!there);
    }
    if tape.checks < 2 {
        return Err(if cut { Unsupported::ShortDialogue } else { Unsupported::OneCheck }.into());
    }
    // There is a strategy, whatever may be asked of it.
    Ok((tape.finished()?, Some(Status::Sat)))
}

/// The strategy that a solver has found, by path.
fn plan(
    told: &Direct<'_, '_>,
    session: &mut dyn Session,
    block: &[PathId],
) -> Result<Vec<Option<Known>>, Error> {
    let query = &told.query;
    let mut plan = vec![None; query.encoder.objective.paths.len()];
    for &path in block {
        let Some(declared) = told.path(path) else { continue };
        let symbols = query.paths.symbols(declared);
        let values = session.values(&query.script, &symbols)?;
        let model: Model = symbols.into_iter().zip(values).collect();
        // A solver may choose numbers that are too large for ours.
        let known = query.paths.decode(declared, &model).ok_or(Unsupported::LargeModel)?;
        plan[usize::from(path)] = Some(known);
    }
    Ok(plan)
}

/// That some leading path does something else in a step than the plan: one of these.
fn otherwise(direct: &Direct<'_, '_>, plan: &[Option<Known>], step: usize) -> Vec<Term> {
    let each = direct.query.encoder.objective.paths.keys().zip(plan);
    let differs = each.filter_map(|(path, known)| {
        let action = *known.as_ref()?.actions.get(step)?;
        Some(!direct.query.paths.took(direct.path(path)?, step, action))
    });
    differs.collect()
}
