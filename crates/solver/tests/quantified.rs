//! Quantified random formulas: what z3 and cvc5 say to the written quantifiers is what they say to
//! the expansion. Binders nest, shadow each other and share terms.

mod common;

use common::installed;
use hyperplan_random::Random;
use hyperplan_smt::{Script, Sort, Stem, Term, Terms};
use hyperplan_solver::{Answer, Deadline, Options, Spec, open};

/// A formula as a DAG: operands are indices of earlier nodes.
#[derive(Clone, Copy)]
enum Node {
    Free(u32),
    Variable(u32),
    And(usize, usize),
    Xor(usize, usize),
    Not(usize),
    Ite(usize, usize, usize),
    /// Binds one or two variables.
    Forall(u32, Option<u32>, usize),
}

const VARIABLES: usize = 3;

fn random_formula(random: &mut Random) -> Vec<Node> {
    let mut nodes: Vec<Node> = (0..2).map(Node::Free).collect();
    nodes.extend((0..VARIABLES as u32).map(Node::Variable));
    for _ in 0..22 {
        let mut pick = || nodes.len() - 1 - random.below(nodes.len()).min(random.below(nodes.len()));
        let (a, b, c) = (pick(), pick(), pick());
        let node = match random.below(8) {
            0 | 1 => Node::And(a, b),
            2 => Node::Xor(a, b),
            3 | 4 => Node::Not(a),
            5 => Node::Ite(a, b, c),
            _ => {
                let (x, y) = (random.below(VARIABLES) as u32, random.below(VARIABLES) as u32);
                Node::Forall(x, (x != y).then_some(y), a)
            }
        };
        nodes.push(node);
    }
    // Close it.
    for variable in 0..VARIABLES as u32 {
        nodes.push(Node::Forall(variable, None, nodes.len() - 1));
        nodes.push(Node::Not(nodes.len() - 1));
    }
    nodes
}

struct Stems {
    free: Stem,
    bound: Stem,
}

/// The formula with quantifiers.
fn quantified(terms: &mut Terms, stems: &Stems, nodes: &[Node]) -> Term {
    let mut built: Vec<Term> = Vec::new();
    for &node in nodes {
        let mut variable = |v| terms.bound_symbol(stems.bound, Some(v), Sort::Bool);
        let t = match node {
            Node::Variable(v) => variable(v),
            Node::Forall(x, y, body) => {
                let bound: Vec<Term> = std::iter::once(x).chain(y).map(variable).collect();
                terms.forall(&bound, built[body])
            }
            _ => plain(terms, stems, node, |i| built[i]),
        };
        built.push(t);
    }
    built[nodes.len() - 1]
}

/// The formula with each quantifier expanded, under values of the variables.
fn expanded(terms: &mut Terms, stems: &Stems, nodes: &[Node], root: usize, env: [bool; VARIABLES]) -> Term {
    match nodes[root] {
        Node::Variable(v) => Term::from(env[v as usize]),
        Node::Forall(x, y, body) => {
            let mut cases = Vec::new();
            for bits in 0..4 {
                let mut env = env;
                env[x as usize] = bits & 1 == 1;
                if let Some(y) = y {
                    env[y as usize] = bits & 2 == 2;
                }
                cases.push(expanded(terms, stems, nodes, body, env));
            }
            terms.and(&cases)
        }
        node => {
            let operands = match node {
                Node::And(a, b) | Node::Xor(a, b) => vec![a, b],
                Node::Not(a) => vec![a],
                Node::Ite(a, b, c) => vec![a, b, c],
                Node::Free(_) | Node::Variable(_) | Node::Forall(..) => vec![],
            };
            let built: Vec<(usize, Term)> =
                operands.into_iter().map(|i| (i, expanded(terms, stems, nodes, i, env))).collect();
            plain(terms, stems, node, |i| built.iter().find(|(j, _)| *j == i).expect("an operand").1)
        }
    }
}

fn plain(terms: &mut Terms, stems: &Stems, node: Node, of: impl Fn(usize) -> Term) -> Term {
    match node {
        Node::Free(i) => terms.symbol(stems.free, Some(i), Sort::Bool),
        Node::And(a, b) => terms.and2(of(a), of(b)),
        Node::Xor(a, b) => terms.xor(of(a), of(b)),
        Node::Not(a) => !of(a),
        Node::Ite(a, b, c) => terms.ite(of(a), of(b), of(c)),
        Node::Variable(_) | Node::Forall(..) => unreachable!("handled by the callers"),
    }
}

#[test]
fn quantifiers_mean_their_expansion() {
    for name in installed(&["z3", "cvc5"]) {
        let options = Options { quantified: true, nested: true, incremental: true, ..Options::default() };
        let mut session = open(&Spec::Profile(name.clone()), &options).expect("it is installed");
        let mut script = Script::new();
        let mut contingent = 0;
        for seed in 0..300 {
            let mut random = Random::new(seed);
            // The same names for free and bound variables: they must not capture each other.
            let stem = script.terms.stem("x");
            let stems = Stems { free: stem, bound: stem };
            let nodes = random_formula(&mut random);
            let q = quantified(&mut script.terms, &stems, &nodes);
            let e = expanded(&mut script.terms, &stems, &nodes, nodes.len() - 1, [false; VARIABLES]);
            contingent += usize::from(!e.is_const());
            let differ = script.terms.xor(q, e);
            let answer = session.check(&script, &[differ], &Deadline::never()).expect("an answer");
            assert_eq!(answer, Answer::Unsat, "{name}, seed {seed}");
        }
        assert!(contingent > 20, "only {contingent} formulas depend on anything");
    }
}
