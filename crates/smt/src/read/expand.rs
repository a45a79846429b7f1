//! Macros: definitions with arguments, put in place of their applications. What a body shares stays shared.

use rustc_hash::FxHashMap;

use super::Reader;
use super::Trouble;
use crate::term::{Op, Term};
use crate::terms::{Terms, View};
use crate::value::Value;

/// A definition with arguments.
pub(super) struct Macro {
    pub(super) parameters: Vec<Term>,
    pub(super) body: Term,
    /// What of the body can depend on the parameters, children before parents.
    pub(super) nodes: Vec<Term>,
}

impl Macro {
    pub(super) fn new(terms: &Terms, parameters: Vec<Term>, body: Term) -> Macro {
        // Not `reach`, which marks every term there is.
        let mut seen = FxHashMap::default();
        let mut nodes = vec![body.positive()];
        let mut next = 0;
        while let Some(&t) = nodes.get(next) {
            next += 1;
            for child in terms.children(t).iter().map(|child| child.positive()) {
                if terms.is_quantified(child) && seen.insert(child, ()).is_none() {
                    nodes.push(child);
                }
            }
        }
        // What is a variable stays what it is, unless it is a parameter.
        nodes.retain(|t| terms.is_quantified(*t) && terms.op(*t) != Op::Bound);
        nodes.sort_unstable();
        Macro { parameters, body, nodes }
    }

    /// How much of the body can depend on the parameters.
    pub(super) fn size(&self) -> usize {
        self.nodes.len()
    }
}

impl Reader<'_> {
    /// A macro, applied.
    pub(super) fn expand(&mut self, at: usize, number: usize, args: &[Term]) -> Result<Term, Trouble> {
        // Taken out, so that terms can be made meanwhile; nothing refers to macros in that.
        let definition = std::mem::replace(
            &mut self.macros[number],
            Macro { parameters: Vec::new(), body: Term::TRUE, nodes: Vec::new() },
        );
        let expanded = self.expanded(at, &definition, args);
        self.macros[number] = definition;
        expanded
    }

    fn expanded(&mut self, at: usize, definition: &Macro, args: &[Term]) -> Result<Term, Trouble> {
        let Macro { parameters, body, nodes } = definition;
        if args.len() != parameters.len() {
            let (needed, found) = (parameters.len(), args.len());
            return Err(Trouble::syntax(at, format!("{needed} arguments are needed here, not {found}")));
        }
        let mut meant: FxHashMap<Term, Term> = FxHashMap::default();
        for (&parameter, &argument) in parameters.iter().zip(args) {
            let argument = self.of_sort(at, argument, self.sort_of(parameter))?;
            meant.insert(parameter, argument);
        }
        for &t in nodes {
            let children = self.terms().children(t).to_vec();
            self.expanded += 1 + children.len();
            self.check_room(at, 0)?;
            let children: Vec<Term> = children.iter().map(|child| in_place(&meant, *child)).collect();
            let built = self.rebuilt(at, t, &children)?;
            meant.insert(t, built);
        }
        Ok(in_place(&meant, *body))
    }

    /// The node with other children.
    fn rebuilt(&mut self, at: usize, t: Term, children: &[Term]) -> Result<Term, Trouble> {
        let terms = self.terms();
        let op = match terms.view(t) {
            View::Const(_) | View::Symbol(..) | View::Bound(..) => return Ok(t),
            View::Extract(_, hi, lo) => return Ok(terms.extract(children[0], hi, lo)),
            View::Extend(Op::SignExtend, _, by) => return Ok(terms.sign_extend(children[0], by)),
            View::Extend(_, _, by) => return Ok(terms.zero_extend(children[0], by)),
            View::Forall(bound, _) => {
                let bound = bound.to_vec();
                return Ok(terms.forall(&bound, children[children.len() - 1]));
            }
            View::Apply(function, _) => return Ok(terms.apply(function, children)),
            View::App(op, _) => op,
        };
        let built = match (op, children) {
            (Op::And, _) => Some(terms.and(children)),
            (Op::Eq, &[a, b]) => Some(terms.eq(a, b)),
            (Op::Ite, &[c, a, b]) => Some(terms.ite(c, a, b)),
            (Op::BvAdd, &[a, b]) => Some(terms.bv_add(a, b)),
            (Op::BvMul, &[a, b]) => Some(terms.bv_mul(a, b)),
            (Op::BvNeg, &[a]) => Some(terms.bv_neg(a)),
            (Op::BvUlt, &[a, b]) => Some(terms.bv_ult(a, b)),
            (Op::BvSlt, &[a, b]) => Some(terms.bv_slt(a, b)),
            (Op::Add, _) => Some(terms.add(children)),
            (Op::Le, &[a, b]) => Some(terms.le(a, b)),
            (Op::ToReal, &[a]) => Some(terms.to_real(a)),
            (Op::Mul | Op::IntDiv | Op::IntMod, &[a, b]) => scaled(terms, op, a, b),
            _ => None,
        };
        built.ok_or_else(|| Trouble::unsupported(at, format!("{} in a definition", op.name())))
    }
}

/// A product with a constant, or a division by one: the constant has stayed what it was.
fn scaled(terms: &mut Terms, op: Op, a: Term, b: Term) -> Option<Term> {
    let constant = if op == Op::Mul { a } else { b };
    match (op, terms.value(constant)?) {
        (Op::Mul, Value::Real(factor)) => Some(terms.real_mul(factor, b)),
        (_, Value::Int(number)) => {
            let number = i64::try_from(number).ok()?;
            Some(match op {
                Op::Mul => terms.int_mul(number, b),
                Op::IntDiv => terms.int_div(a, number),
                _ => terms.int_mod(a, number),
            })
        }
        _ => None,
    }
}

fn in_place(meant: &FxHashMap<Term, Term>, t: Term) -> Term {
    meant.get(&t.positive()).map_or(t, |meant| meant.negate_if(t.is_negated()))
}
