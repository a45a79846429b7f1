//! What the tests share: random scripts, brute force, and which solvers there are.
#![allow(dead_code)]

use hyperplan_random::Random;
use hyperplan_smt::{Evaluation, Model, Script, Sort, Term, Value, Verdict};
use hyperplan_solver::{Session, discover};

/// The names of the external solvers that are installed, out of those; the rest is said to be
/// skipped, or is a failure where all are required.
pub(crate) fn installed(names: &[&str]) -> Vec<String> {
    let required = std::env::var_os("HYPERPLAN_REQUIRE_SOLVERS").is_some_and(|value| value == "1");
    let found = discover();
    let mut present = Vec::new();
    for &name in names {
        if found.iter().any(|solver| solver.name == name && solver.path.is_some()) {
            present.push(name.to_owned());
        } else {
            assert!(!required, "solver {name} is missing");
            say_skipped(name);
        }
    }
    present
}

/// A growing random script over Booleans and two bit-vectors of three bits.
pub(crate) struct Growing {
    pub(crate) script: Script,
    pub(crate) symbols: Vec<Term>,
    bools: Vec<Term>,
    vectors: Vec<Term>,
}

impl Growing {
    pub(crate) fn new() -> Growing {
        let mut script = Script::new();
        let (b, v) = (script.terms.stem("b"), script.terms.stem("v w"));
        let bools: Vec<Term> = (0..4).map(|i| script.terms.symbol(b, Some(i), Sort::Bool)).collect();
        let mut vectors: Vec<Term> =
            (0..2).map(|i| script.terms.symbol(v, Some(i), Sort::BitVec(3))).collect();
        let symbols = bools.iter().chain(&vectors).copied().collect();
        vectors.extend([0, 1, 5].map(|k| script.terms.bv(k, 3)));
        Growing { script, symbols, bools, vectors }
    }

    pub(crate) fn pick(&self, random: &mut Random) -> Term {
        // Later terms are deeper.
        let count = self.bools.len();
        let index = random.below(count).max(random.below(count));
        self.bools[index].negate_if(random.below(2) == 1)
    }

    fn vector(&self, random: &mut Random) -> Term {
        self.vectors[random.below(self.vectors.len())]
    }

    pub(crate) fn step(&mut self, random: &mut Random) {
        let (a, b, c) = (self.pick(random), self.pick(random), self.pick(random));
        let (v, w) = (self.vector(random), self.vector(random));
        let t = &mut self.script.terms;
        let boolean = match random.below(13) {
            0 => t.and(&[a, b, c]),
            1 => t.or(&[a, b, c]),
            2 => t.iff(a, b),
            3 => t.ite(a, b, c),
            4 => t.bv_ult(v, w),
            5 => t.bv_slt(v, w),
            6 | 7 => t.eq(v, w),
            choice => {
                let vector = match choice {
                    8 => t.bv_add(v, w),
                    9 => t.bv_mul(v, w),
                    10 => t.bv_neg(v),
                    11 => t.ite(a, v, w),
                    _ => {
                        let wide = if a.is_negated() { t.sign_extend(v, 2) } else { t.zero_extend(v, 2) };
                        t.extract(wide, 3, 1)
                    }
                };
                self.vectors.push(vector);
                return;
            }
        };
        self.bools.push(boolean);
    }

    pub(crate) fn assert_some(&mut self, random: &mut Random) {
        let picked: Vec<Term> = (0..1 + random.below(3)).map(|_| self.pick(random)).collect();
        self.script.clause(&picked);
    }

    /// Whether some assignment satisfies all assertions and assumptions.
    pub(crate) fn brute_force(&self, assumptions: &[Term]) -> bool {
        (0..1 << 10_u32).any(|bits: u32| {
            let mut model = Model::new();
            for (i, &symbol) in self.symbols[..4].iter().enumerate() {
                model.insert(symbol, Value::Bool(bits >> i & 1 == 1));
            }
            model.insert(self.symbols[4], Value::bv(i128::from(bits >> 4 & 7), 3));
            model.insert(self.symbols[5], Value::bv(i128::from(bits >> 7 & 7), 3));
            satisfies(&self.script, assumptions, &model)
        })
    }

    /// The session's model, which must satisfy everything.
    pub(crate) fn check_model(&self, session: &mut dyn Session, assumptions: &[Term], context: &str) {
        let values = session.values(&self.script, &self.symbols).expect(context);
        let model: Model = self.symbols.iter().copied().zip(values).collect();
        assert!(satisfies(&self.script, assumptions, &model), "wrong model: {context}");
    }
}

pub(crate) fn satisfies(script: &Script, assumptions: &[Term], model: &Model) -> bool {
    let evaluation = Evaluation::new(&script.terms, model);
    let holds = |literals: &[Term]| evaluation.clause(literals) == Verdict::True;
    assumptions.iter().all(|&t| holds(&[t])) && script.assertions(0).all(holds)
}

#[allow(clippy::print_stderr)]
fn say_skipped(name: &str) {
    eprintln!("solver {name} missing: skipped");
}
