//! Functions that are not interpreted.

use super::Terms;
use crate::term::{Function, Op, Sort, Stem, Term};

/// What a function is called, what it takes, and what it gives.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(super) struct Signature {
    stem: Stem,
    domain: Box<[Sort]>,
    range: Sort,
}

impl Terms {
    /// The declared function of that stem, which takes at least one argument and is printed as a symbol without a time
    /// is. A stem should be used for one thing only: SMT-LIB knows no overloading.
    pub fn function(&mut self, stem: Stem, domain: &[Sort], range: Sort) -> Function {
        assert!(!domain.is_empty(), "a function without arguments is a symbol");
        domain.iter().chain([&range]).for_each(|&sort| super::check_sort(sort));
        let signature = Signature { stem, domain: domain.into(), range };
        if let Some(&function) = self.function_ids.get(&signature) {
            return function;
        }
        let function = Function(u32::try_from(self.functions.len()).expect("fewer than 2^32 functions"));
        self.functions.push(signature.clone());
        self.function_ids.insert(signature, function);
        function
    }

    /// A function, applied to arguments of its sorts.
    pub fn apply(&mut self, function: Function, args: &[Term]) -> Term {
        let Signature { domain, range, .. } = &self.functions[function.0 as usize];
        let (needed, range) = (domain.len(), *range);
        assert!(args.len() == needed, "a function of {needed} arguments is applied to {}", args.len());
        for (&sort, &t) in domain.iter().zip(args) {
            let found = self.sort(t);
            assert!(found == sort, "argument of a function: {sort} is needed, not {found}");
        }
        let words = [args, &[Term(function.0)]].concat();
        self.intern(Op::Apply, range, &words)
    }

    /// The sorts of a function's arguments.
    #[must_use]
    pub fn domain(&self, function: Function) -> &[Sort] {
        &self.functions[function.0 as usize].domain
    }

    /// The sort of what a function gives.
    #[must_use]
    pub fn range(&self, function: Function) -> Sort {
        self.functions[function.0 as usize].range
    }

    /// What a function is called.
    pub(crate) fn function_stem(&self, function: Function) -> Stem {
        self.functions[function.0 as usize].stem
    }
}
