//! Evaluation of terms under a model: a loop over the arena.

use crate::apply::apply;
use crate::script::Script;
use crate::term::{Op, Sort, Term};
use crate::terms::{Terms, View};
use crate::value::{Model, Value};

/// What a term or assertion is under a model.
#[derive(Copy, Clone, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// True.
    True,
    /// False.
    False,
    /// Quantified, or a number in it does not fit into 128 bits, or a symbol has no value where that matters.
    Unknown,
}

impl From<Option<bool>> for Verdict {
    fn from(value: Option<bool>) -> Self {
        match value {
            Some(true) => Verdict::True,
            Some(false) => Verdict::False,
            None => Verdict::Unknown,
        }
    }
}

/// The values of all terms of an arena under a model.
pub struct Evaluation {
    /// Per node: for Booleans 0, 1 or `UNKNOWN`; for the rest an index into `values`.
    cells: Vec<u32>,
    values: Vec<Value>,
}

const UNKNOWN: u32 = u32::MAX;

impl Evaluation {
    /// Evaluates every term. Symbols and functions without a value are false or zero. Quantified terms are
    /// unknown, and so is what depends on them.
    #[must_use]
    pub fn new(terms: &Terms, model: &Model) -> Self {
        Evaluation::with(terms, model, |sort| Some(Value::default_of(sort)))
    }

    /// Evaluates every term. Symbols and functions without a value are unknown, and so is what depends on them.
    #[must_use]
    pub fn partial(terms: &Terms, model: &Model) -> Self {
        Evaluation::with(terms, model, |_| None)
    }

    fn with(terms: &Terms, model: &Model, absent: fn(Sort) -> Option<Value>) -> Self {
        let mut evaluation = Evaluation { cells: Vec::with_capacity(terms.len()), values: Vec::new() };
        for t in terms.iter() {
            let value = node(terms, model, absent, t, |t| evaluation.value(terms, t));
            let cell = match value {
                None => UNKNOWN,
                Some(Value::Bool(b)) => u32::from(b),
                Some(value) => {
                    evaluation.values.push(value);
                    (evaluation.values.len() - 1) as u32
                }
            };
            evaluation.cells.push(cell);
        }
        evaluation
    }

    /// The value of a Boolean term.
    #[must_use]
    pub fn truth(&self, t: Term) -> Option<bool> {
        match self.cells[t.index()] {
            UNKNOWN => None,
            bit => Some((bit == 1) ^ t.is_negated()),
        }
    }

    /// The value of a term of any sort.
    #[must_use]
    pub fn value(&self, terms: &Terms, t: Term) -> Option<Value> {
        if terms.sort(t) == Sort::Bool {
            return self.truth(t).map(Value::Bool);
        }
        match self.cells[t.index()] {
            UNKNOWN => None,
            index => Some(self.values[index as usize]),
        }
    }

    /// What an assertion, a disjunction, is.
    #[must_use]
    pub fn clause(&self, literals: &[Term]) -> Verdict {
        let mut result = Some(false);
        for &t in literals {
            match self.truth(t) {
                Some(true) => return Verdict::True,
                Some(false) => {}
                None => result = None,
            }
        }
        result.into()
    }
}

/// What a node is, by what its children are. What is declared and has no value in the model is what `absent` says.
pub(crate) fn node(
    terms: &Terms,
    model: &Model,
    absent: fn(Sort) -> Option<Value>,
    t: Term,
    value: impl Fn(Term) -> Option<Value>,
) -> Option<Value> {
    let sort = terms.sort(t);
    let all = |args: &[Term]| args.iter().map(|&t| value(t)).collect::<Option<Vec<Value>>>();
    match terms.view(t) {
        View::Const(value) => Some(value),
        View::Symbol(..) => model.get(t).filter(|v| v.sort() == sort).or_else(|| absent(sort)),
        View::Apply(function, args) => match (model.get(t), model.function(function)) {
            (Some(known), _) => Some(known),
            (None, Some(definition)) => definition.value(&all(args)?).filter(|v| v.sort() == sort),
            (None, None) => absent(sort),
        },
        View::Bound(..) | View::Forall(..) => None,
        View::App(Op::And, conjuncts) => and(conjuncts, value).map(Value::Bool),
        View::App(Op::Ite, args) => value(if value(args[0])?.as_bool()? { args[1] } else { args[2] }),
        View::App(op, &[a, b]) => apply(op, sort, &[value(a)?, value(b)?], &[]),
        View::App(op, args) => apply(op, sort, &all(args)?, &[]),
        View::Extend(op, a, by) => apply(op, sort, &[value(a)?], &[by]),
        View::Extract(a, hi, lo) => apply(Op::Extract, sort, &[value(a)?], &[hi, lo]),
    }
}

/// Three-valued conjunction: one false conjunct decides.
fn and(conjuncts: &[Term], value: impl Fn(Term) -> Option<Value>) -> Option<bool> {
    let mut result = Some(true);
    for &t in conjuncts {
        match value(t).and_then(Value::as_bool) {
            Some(false) => return Some(false),
            Some(true) => {}
            None => result = None,
        }
    }
    result
}

/// What became of the assertions of a script under a model.
#[derive(Copy, Clone, PartialEq, Eq, Debug, Default)]
pub struct ModelCheck {
    /// The first assertion that is false.
    pub violated: Option<usize>,
    /// How many assertions could not be evaluated, quantified ones (up to the violated one, if any).
    pub unknown: usize,
}

/// Evaluates every assertion of the script up to the first that is false.
#[must_use]
pub fn check_model(script: &Script, model: &Model) -> ModelCheck {
    check(script, &Evaluation::new(&script.terms, model))
}

/// As [`check_model`], but a symbol without a value may be anything: what depends on it is unknown.
#[must_use]
pub fn check_partial_model(script: &Script, model: &Model) -> ModelCheck {
    check(script, &Evaluation::partial(&script.terms, model))
}

fn check(script: &Script, evaluation: &Evaluation) -> ModelCheck {
    let mut check = ModelCheck::default();
    for (index, literals) in script.assertions(0).enumerate() {
        match evaluation.clause(literals) {
            Verdict::True => {}
            Verdict::Unknown => check.unknown += 1,
            Verdict::False => {
                check.violated = Some(index);
                break;
            }
        }
    }
    check
}
