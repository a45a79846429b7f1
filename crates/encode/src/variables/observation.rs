//! What is observed of a path's states, on which its moves depend where they are a policy.

use super::path::Builder;
use super::step::InState;
use super::symbols::Symbols;
use crate::value::{Val, translate};
use hyperplan_smt::{Sort, Term, Terms};

impl Builder<'_> {
    /// The sorts of what is observed of a state: those of what the system observes, else of its variables. They come
    /// from the variables' types, and so are the same at all times, whatever is known of a state then.
    pub(super) fn observed_sorts(&self, terms: &mut Terms) -> Vec<Sort> {
        let plain = self.numbers.plain();
        let any = self.variables(terms, 0, &Symbols::Bound);
        self.seen(terms, &any).iter().map(|value| value.sort(terms, plain)).collect()
    }

    /// What is observed of a state, in these sorts. Each holds the values of any state.
    pub(super) fn observation(&self, terms: &mut Terms, state: &[Val], sorts: &[Sort]) -> Vec<Term> {
        let seen = self.seen(terms, state);
        seen.iter().zip(sorts).map(|(value, &sort)| value.of_sort(terms, sort)).collect()
    }

    fn seen(&self, terms: &mut Terms, state: &[Val]) -> Vec<Val> {
        let system = self.names.system;
        if system.observe.is_empty() {
            return state.to_vec();
        }
        let mut leaves = InState::new(system, state);
        system.observe.iter().map(|expr| translate(terms, expr, &mut leaves)).collect()
    }

    /// What a step's choice is made from.
    pub(super) fn of_step(&self, terms: &mut Terms, symbols: &Symbols, here: &[Val]) -> Symbols {
        match symbols {
            Symbols::Functions { time, of, observed: Some(sorts) } => {
                let mut args = self.observation(terms, here, sorts);
                args.extend(of);
                Symbols::Functions { time: *time, of: args, observed: Some(sorts.clone()) }
            }
            other => other.clone(),
        }
    }
}
