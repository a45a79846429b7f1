//! A witness is checked independently, or, where that is too much to enumerate, by a second query.

use crate::cegis::{Assignment, Cegis};
use crate::config::{Config, Quantifiers, Verified};
use crate::fact::{Error, Reason};
use crate::oracle::{Account, Oracle, Stop};
use crate::prepare::is_existential;
use hyperplan_encode::{Encoder, Goal};
use hyperplan_problem::Strategy;
use hyperplan_solver::Spec;
use hyperplan_verify as verify;

/// How a witness was checked that came of what was asked; `by` says how quantifiers were decided. It is undecided where
/// nobody could check it.
pub(crate) fn confirm(
    encoder: &Encoder<'_>,
    config: &Config,
    strategy: &Strategy,
    (account, by): (&Account, Quantifiers),
) -> Result<Verified, Stop> {
    let (problem, objective) = (encoder.problem, encoder.objective);
    let verdict = match verify::check(problem, objective, strategy, &verify::Budget::default()) {
        Err(error @ verify::Error::Overflow { .. }) => return Err(Stop::Unknown(Reason::Checker(error))),
        verdict => verdict.map_err(|error| Error::Bug(error.to_string()))?,
    };
    match verdict {
        verify::Check::Holds => Ok(Verified::BySearch),
        verify::Check::Fails(defeat) => {
            let what = defeat.describe(objective);
            // If our own encoding agrees with the checker, the solver said something wrong.
            Err(match defeated(encoder, config, strategy) {
                Ok(true) if !config.solver.is_embedded() => account.wrong_model(what),
                _ => Error::Bug(what),
            }
            .into())
        }
        // There is nothing that a second query could ask.
        verify::Check::TooLarge { .. } if objective.blocks().len() < 2 => {
            Err(Stop::Unknown(Reason::TooManySteps))
        }
        // A search by counterexamples ends with the second query, of these very paths.
        verify::Check::TooLarge { .. } if by == Quantifiers::Cegis && config.solver.is_embedded() => {
            Ok(Verified::BySolver)
        }
        verify::Check::TooLarge { .. } => match defeated(encoder, config, strategy)? {
            false => Ok(Verified::BySolver),
            true => Err(Error::Bug("a second query defeats it".into()).into()),
        },
    }
}

/// Whether the paths after the leading block can defeat the strategy, asked of the embedded solver where it can tell.
fn defeated(encoder: &Encoder<'_>, config: &Config, strategy: &Strategy) -> Result<bool, Stop> {
    let objective = encoder.objective;
    let blocks = objective.blocks();
    let mut known: Assignment = vec![None; objective.paths.len()];
    for trace in &strategy.traces {
        known[usize::from(trace.path)] = encoder.writer.known(trace);
    }
    if blocks.len() < 2 || strategy.traces.iter().any(|t| known[usize::from(t.path)].is_none()) {
        // No path at all, or nothing left to choose: the checker's word stands.
        return Ok(true);
    }
    let solver = if encoder.states.is_arithmetic() { config.solver.clone() } else { Spec::Builtin };
    let own = Config { solver, queries: None, ..config.clone() };
    let formula = &objective.formula;
    let against = Goal::new(formula, is_existential(objective)).opposed(formula);
    let mut oracle = Oracle::new(&own);
    let mut cegis = Cegis::new(encoder, &mut oracle, &blocks);
    Ok(!cegis.find(1, &known, &against, 1)?.is_empty())
}
