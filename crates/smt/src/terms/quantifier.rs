//! Quantifiers.

use super::Terms;
use crate::term::{Op, Sort, Term};

impl Terms {
    /// Universal quantification over variables made by [`Terms::bound_symbol`].
    pub fn forall(&mut self, bound: &[Term], body: Term) -> Term {
        self.check_bool("forall", body);
        // A body without any bound variable or quantifier does not depend on these.
        if bound.is_empty() || !self.is_quantified(body) {
            return body;
        }
        let mut args = bound.to_vec();
        for &variable in bound {
            let fit = self.op(variable) == Op::Bound && !variable.is_negated();
            assert!(fit, "quantifiers bind variables made by bound_symbol");
        }
        args.sort_unstable();
        args.dedup();
        args.push(body);
        self.intern(Op::Forall, Sort::Bool, &args)
    }

    /// Existential quantification over variables made by [`Terms::bound_symbol`].
    pub fn exists(&mut self, bound: &[Term], body: Term) -> Term {
        !self.forall(bound, !body)
    }
}
