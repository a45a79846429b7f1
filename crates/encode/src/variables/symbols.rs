//! What the terms of a path that is not known are made from: numbers of some sort, as symbols, bound variables, or functions.

use crate::value::width;
use hyperplan_problem::Type;
use hyperplan_smt::{Features, Rational, Sort, Stem, Term, Terms, Value};
use hyperplan_space::{Commands, bounds};

/// What numbers are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Numbers {
    /// Bit-vectors (`--states bitvec`).
    Bits,
    /// Integers, and reals where a variable is one (`--states int`).
    Integers,
    /// Reals (`--states real`).
    Reals,
}

impl Numbers {
    /// The sort of a variable.
    pub(super) fn sort(self, ty: &Type) -> Sort {
        match (self, ty, bounds(ty)) {
            (_, Type::Bool, _) => Sort::Bool,
            (Numbers::Bits, _, Some((lo, hi))) => Sort::BitVec(width(lo, hi)),
            (Numbers::Reals, ..) | (_, Type::Real, _) => Sort::Real,
            _ => Sort::Int,
        }
    }

    /// The sort of the symbols that say which command is taken, where there is a choice.
    pub(super) fn sort_of_choice(self, commands: &Commands) -> Option<Sort> {
        let count = commands.all.len();
        let sort = match self {
            Numbers::Bits => Sort::BitVec(width(0, count as i64 - 1)),
            Numbers::Integers | Numbers::Reals => Sort::Bool,
        };
        (count > 1).then_some(sort)
    }

    /// Whether an update may leave a value of that type between two ends open, for the solver to find it.
    pub(super) fn leaves_open(self, ty: &Type) -> bool {
        match self {
            Numbers::Bits | Numbers::Integers => true,
            Numbers::Reals => *ty == Type::Real,
        }
    }

    /// The sort of times, which makes no further theory necessary: features are those of the paths' variables.
    pub(super) fn sort_of_time(self, features: &Features, horizon: u32) -> Sort {
        match self {
            // Times are not negative, and need no sign.
            Numbers::Bits => Sort::BitVec((width(0, horizon.into()) - 1).max(1)),
            Numbers::Reals => Sort::Real,
            Numbers::Integers if features.real && !features.int => Sort::Real,
            Numbers::Integers => Sort::Int,
        }
    }

    /// The sort of a number that is not a variable.
    pub(super) fn plain(self) -> Sort {
        match self {
            Numbers::Bits => Sort::BitVec(1),
            Numbers::Integers => Sort::Int,
            Numbers::Reals => Sort::Real,
        }
    }
}

/// What stands for the values of a path.
#[derive(Clone, Debug)]
pub(super) enum Symbols {
    /// Declared symbols, one for each time.
    Declared,
    /// Bound variables, one for each time.
    Bound,
    /// Declared functions, applied to a time, and to what else there is to depend on.
    Functions {
        /// The sort of times.
        time: Sort,
        /// The other arguments.
        of: Vec<Term>,
        /// The sorts of what moves also depend on, if they do.
        observed: Option<Vec<Sort>>,
    },
}

impl Symbols {
    /// What one of the path's variables, or of its choices, is at a time.
    pub(super) fn at(&self, terms: &mut Terms, stem: Stem, at: u32, sort: Sort) -> Term {
        match self {
            Symbols::Declared => terms.symbol(stem, Some(at), sort),
            Symbols::Bound => terms.bound_symbol(stem, Some(at), sort),
            Symbols::Functions { time, of, .. } => {
                let mut args = vec![moment(terms, *time, at)];
                args.extend(of);
                let domain: Vec<Sort> = args.iter().map(|&t| terms.sort(t)).collect();
                let function = terms.function(stem, &domain, sort);
                terms.apply(function, &args)
            }
        }
    }

    /// What the choices of a path are called: moves, or what a policy does.
    pub(super) fn word(&self) -> &'static str {
        match self {
            Symbols::Functions { observed: Some(_), .. } => "act",
            Symbols::Declared | Symbols::Bound | Symbols::Functions { .. } => "move",
        }
    }
}

/// A time as a term.
fn moment(terms: &mut Terms, sort: Sort, at: u32) -> Term {
    terms.constant(match sort {
        Sort::BitVec(width) => Value::Bv { width, bits: at.into() },
        Sort::Real => Value::Real(Rational::from(i64::from(at))),
        _ => Value::Int(at.into()),
    })
}
