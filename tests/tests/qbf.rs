//! Files for QBF and SAT solvers: that they follow their standards, and are true if and only if what they were made from is.
//!
//! `HYPERPLAN_SEED` and `HYPERPLAN_CASES` replace the seed and the number of cases.

use hyperplan_plan::{EmitConfig, Quantifiers, States, Status, emit};
use hyperplan_random::Random;
use hyperplan_smt::{Evaluation, Model, Script, Sort, Term, Terms, Value};
use hyperplan_solver::{Deadline, Error, Format, Propositional};
use hyperplan_tests::brute::Brute;
use hyperplan_tests::judge::{fixture, lowered};
use hyperplan_tests::qbf::Formula;
use hyperplan_tests::random::problem;
use hyperplan_tests::{number, say};

const FORMATS: [Format; 3] = [Format::Dimacs, Format::Qdimacs, Format::Qcir];

fn seeds(cases: u64) -> impl Iterator<Item = u64> {
    let first = number("HYPERPLAN_SEED", 20_261_128);
    let cases = number("HYPERPLAN_CASES", cases);
    say(&format!("seed {first}, {cases} cases"));
    (0..cases).map(move |i| first.wrapping_add(i))
}

fn read(text: &str, format: Format) -> Formula {
    match format {
        Format::Qcir => Formula::of_gates(text),
        _ => Formula::of_clauses(text, format == Format::Qdimacs),
    }
}

/// The variables of each block: a Boolean, a vector of two bits, and a value of three.
#[derive(Clone, Copy)]
struct Block {
    universal: bool,
    variables: [Term; 3],
}

/// Blocks of variables with a random condition for each, and what is asked of all.
struct Quantified {
    script: Script,
    blocks: Vec<Block>,
    /// Of each block what its variables have to fulfil, and at last what is asked.
    conditions: Vec<Term>,
}

impl Quantified {
    /// The same for the same seed, with variables that quantifiers bind, or with symbols in their place.
    fn new(seed: u64, bound: bool) -> Quantified {
        let mut random = Random::new(seed);
        let mut script = Script::new();
        let terms = &mut script.terms;
        let three = terms.enumeration("three", ["one", "two", "three"]);
        let (mut blocks, mut conditions) = (Vec::new(), Vec::new());
        let (mut bools, mut vectors, mut values) = (Vec::new(), Vec::new(), Vec::new());
        let mut universal = false;
        for number in 0..1 + random.bound(3) {
            let mut variable = |name: &str, sort: Sort| {
                let stem = terms.stem(name);
                let binds = bound && number > 0;
                if binds {
                    terms.bound_symbol(stem, Some(number), sort)
                } else {
                    terms.symbol(stem, Some(number), sort)
                }
            };
            let variables =
                [variable("b", Sort::Bool), variable("v", Sort::BitVec(2)), variable("e", Sort::Enum(three))];
            bools.push(variables[0]);
            vectors.push(variables[1]);
            values.push(variables[2]);
            for _ in 0..5 {
                grow(terms, &mut random, &mut bools, &mut vectors, &values);
            }
            blocks.push(Block { universal, variables });
            conditions.push(pick(&mut random, &bools));
            universal = !universal || random.once_in(4);
        }
        for _ in 0..12 {
            grow(terms, &mut random, &mut bools, &mut vectors, &values);
        }
        conditions.push(pick(&mut random, &bools));
        Quantified { script, blocks, conditions }
    }

    /// Asserts it, with its quantifiers.
    fn assert(mut self) -> Script {
        let terms = &mut self.script.terms;
        let mut formula = self.conditions.pop().expect("what is asked");
        for (block, condition) in self.blocks.iter().zip(&self.conditions).skip(1).rev() {
            formula = if block.universal {
                let body = terms.implies(*condition, formula);
                terms.forall(&block.variables, body)
            } else {
                let body = terms.and2(*condition, formula);
                terms.exists(&block.variables, body)
            };
        }
        let first = self.conditions[0];
        // As a clause with a literal more now and then, which the reader of clauses has to see.
        self.script.assert(first);
        self.script.clause(&[formula, Term::FALSE]);
        self.script
    }

    /// Whether it is true, block by block; of the first the values are given.
    fn holds(&self, at: usize, model: &mut Model) -> bool {
        let Some(block) = self.blocks.get(at) else {
            return Evaluation::new(&self.script.terms, model).truth(self.conditions[at]) == Some(true);
        };
        let sort = self.script.terms.sort(block.variables[2]);
        let Sort::Enum(three) = sort else { panic!("{sort:?}") };
        let mut cases = (0..2 * 4 * 3).map(|case: u32| {
            let mut model = model.clone();
            model.insert(block.variables[0], Value::Bool(case & 1 == 1));
            model.insert(block.variables[1], Value::bv(i128::from(case >> 1 & 3), 2));
            model.insert(block.variables[2], Value::Enum(three, case >> 3));
            let fits = Evaluation::new(&self.script.terms, &model).truth(self.conditions[at]) == Some(true);
            (fits, model)
        });
        if block.universal {
            cases.all(|(fits, mut model)| !fits || self.holds(at + 1, &mut model))
        } else {
            cases.any(|(fits, mut model)| fits && self.holds(at + 1, &mut model))
        }
    }
}

fn pick(random: &mut Random, bools: &[Term]) -> Term {
    let index = random.below(bools.len()).max(random.below(bools.len()));
    bools[index].negate_if(random.flip())
}

/// One more Boolean, or vector.
fn grow(
    terms: &mut Terms,
    random: &mut Random,
    bools: &mut Vec<Term>,
    vectors: &mut Vec<Term>,
    values: &[Term],
) {
    let (a, b, c) = (pick(random, bools), pick(random, bools), pick(random, bools));
    let (v, w) = (vectors[random.below(vectors.len())], vectors[random.below(vectors.len())]);
    let (x, y) = (values[random.below(values.len())], values[random.below(values.len())]);
    let boolean = match random.below(11) {
        0 => terms.and(&[a, b, c]),
        1 => terms.or(&[a, b, c]),
        2 => terms.iff(a, b),
        3 => terms.ite(a, b, c),
        4 => terms.bv_ult(v, w),
        5 => terms.bv_slt(v, w),
        6 => terms.eq(v, w),
        7 => {
            let chosen = terms.ite(a, x, y);
            terms.eq(chosen, values[0])
        }
        8 => return vectors.push(terms.bv_add(v, w)),
        9 => return vectors.push(terms.bv_mul(v, w)),
        _ => return vectors.push(terms.ite(a, v, w)),
    };
    bools.push(boolean);
}

#[test]
fn scripts_mean_the_same_as_bits() {
    let mut answers = [0_u32; 2];
    for seed in seeds(400) {
        let plain = Quantified::new(seed, false);
        let expected = plain.holds(0, &mut Model::new());
        let is_quantified = plain.blocks.len() > 1;
        let script = Quantified::new(seed, true).assert();
        for format in FORMATS {
            let bits = Propositional::new(&script, &[], format, &Deadline::never());
            let bits = match bits {
                Err(Error::Unsupported { .. }) if format == Format::Dimacs && is_quantified => continue,
                bits => bits.expect("bits for all"),
            };
            let mut text = Vec::new();
            bits.write(&mut text, &["about".to_owned()], false).expect("to a vector");
            let text = String::from_utf8(text).expect("plain text");
            let formula = read(&text, format);
            assert_eq!(formula.comments[0], "about");
            let names = formula.comments.len() - 1;
            assert!(script.symbols().len() <= names, "seed {seed}: a symbol has no name\n{text}");
            assert_eq!(formula.is_true(), expected, "seed {seed}, {format}\n{text}");
        }
        answers[usize::from(expected)] += 1;
    }
    say(&format!("{answers:?}"));
    assert!(answers.iter().all(|&count| 10 * count > answers[0] + answers[1]), "{answers:?} is one-sided");
}

/// The most variables of states and actions of a formula that is decided by brute force here.
const MOST: usize = 24;

#[test]
fn objectives_mean_the_same_as_bits() {
    let (mut decided, mut quantified) = (0_u32, 0_u32);
    for seed in seeds(150) {
        let random = problem(&mut Random::new(seed));
        let brute = Brute::new(&random, usize::MAX / 8).expect("no limit");
        let realizable = brute.verdict();
        let text = fixture(&random.to_string(), realizable);
        let typed = lowered(&text);
        let expected = realizable == random.exists[0];
        for format in FORMATS {
            for quantifiers in [Quantifiers::Keep, Quantifiers::Expand] {
                let states = if seed % 2 == 0 { States::Bitvec } else { States::Enum };
                let config = EmitConfig {
                    format: Some(format),
                    quantifiers,
                    states: Some(states),
                    status: Some(Status::Unknown),
                    ..EmitConfig::new("2026-11-28")
                };
                // What cannot be expanded, or has quantifiers left in DIMACS, is refused elsewhere too.
                let Ok(mut emitted) = emit(&typed, &typed.objectives[0], &config) else { continue };
                let mut file = Vec::new();
                emitted.write(&mut file).expect("to a vector");
                let file = String::from_utf8(file).expect("plain text");
                let formula = read(&file, format);
                let named = formula.comments.iter().position(|line| line == "What variables stand for:");
                let named = formula.comments.len() - named.expect("names") - 1;
                if named > MOST {
                    continue;
                }
                assert_eq!(
                    formula.is_true(),
                    expected,
                    "seed {seed}, {format}, {quantifiers}, {states:?}\n{text}\n{file}"
                );
                decided += 1;
                quantified += u32::from(formula.prefix.iter().any(|(universal, _)| *universal));
            }
        }
    }
    say(&format!("{decided} files decided, {quantified} with quantifiers"));
    assert!(decided > 100 && quantified > 20, "{decided} files are few, {quantified} with quantifiers");
}
