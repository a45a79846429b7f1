//! Typed things back in the language's syntax, for messages.

use crate::expr::{Comparison, Expr, Leaf, PathLeaf, Rational, State, Type, Value};
use crate::formula::{Formula, Interval, Node};
use crate::ids::{CostId, FormulaId, PathId};
use crate::objective::{Objective, Quantifier};
use crate::problem::Problem;
use crate::system::System;
use crate::target::Target;
use hyperplan_syntax::ast::{BinaryOp, UnaryOp};
use hyperplan_syntax::is_name;
use hyperplan_syntax::operator::{Fixity, Operator, level};
use std::borrow::Cow;

/// Longer texts are cut, with `...` at the end: shared parts could make them exponential.
const MAX_LENGTH: usize = 4_000;

/// Sets with more members are shortened.
const MAX_MEMBERS: usize = 12;

/// A part of an objective's formula.
#[must_use]
pub fn formula(problem: &Problem, objective: &Objective, id: FormulaId) -> String {
    let names = PathNames { problem, objective };
    let mut printer = Printer { out: String::new(), names: &names };
    printer.formula(&objective.formula, id, level::LOWEST);
    printer.finish()
}

/// A whole objective: quantifiers and formula.
#[must_use]
pub fn objective(problem: &Problem, objective: &Objective) -> String {
    let mut out = String::new();
    for path in &objective.paths {
        let quantifier = match path.quantifier {
            Quantifier::Exists => "exists",
            Quantifier::Forall => "forall",
        };
        out += &format!("{quantifier} {}", path.name);
        if problem.systems.len() > 1 {
            out += &format!(": {}", problem.systems[path.system].name);
        }
        out += ". ";
    }
    out + &formula(problem, objective, objective.formula.root())
}

/// An atom of an objective.
#[must_use]
pub fn atom(problem: &Problem, objective: &Objective, e: &Expr<PathLeaf>) -> String {
    let names = PathNames { problem, objective };
    let mut printer = Printer { out: String::new(), names: &names };
    printer.expr(e, 0, None);
    printer.finish()
}

/// An expression over the state of a system.
#[must_use]
pub fn state_expr(system: &System, e: &Expr<Leaf>) -> String {
    let mut printer = Printer { out: String::new(), names: system };
    printer.expr(e, 0, None);
    printer.finish()
}

/// A value of a type.
#[must_use]
pub fn value(ty: &Type, value: Value) -> String {
    match (value, ty) {
        (Value::Bool(b), _) => b.to_string(),
        (Value::Int(n), _) => n.to_string(),
        (Value::Enum(index), Type::Enum(values)) => {
            values.get(index as usize).map_or_else(|| format!("#{index}"), |v| name(v).into_owned())
        }
        (Value::Enum(index), _) => format!("#{index}"),
        (Value::Real(r), _) => r.to_string(),
    }
}

/// The name of an enumeration value or action as the language writes it: in quotes where it could be no name else.
#[must_use]
pub fn name(name: &str) -> Cow<'_, str> {
    if is_name(name) {
        return Cow::Borrowed(name);
    }
    Cow::Owned(format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\"")))
}

/// A sum of costs: `2 * cost fuel[p] + cost time[q]`.
#[must_use]
pub fn target(problem: &Problem, objective: &Objective, target: &Target) -> String {
    let term = |&(factor, path, cost): &(i64, PathId, CostId)| {
        let var = &objective.paths[path];
        let own = format!("cost {}[{}]", problem.systems[var.system].costs[cost].name, var.name);
        if factor == 1 { own } else { format!("{factor} * {own}") }
    };
    let mut text = target.terms.iter().map(term).collect::<Vec<_>>().join(" + ");
    match target.constant {
        0 => {}
        constant => text += &format!(" {} {}", if constant < 0 { "-" } else { "+" }, constant.unsigned_abs()),
    }
    text
}

/// A state: `(x = 1, y = 2)`; a crash is shown only where it happened.
#[must_use]
pub fn state(system: &System, state: &State) -> String {
    let crash = system.map.as_ref().and_then(|map| map.crash);
    let shown = system.vars.iter_enumerated().zip(state.iter());
    let shown =
        shown.filter(|((id, var), v)| var.sums.is_none() && (Some(*id) != crash || **v == Value::Bool(true)));
    let parts: Vec<String> =
        shown.map(|((_, var), v)| format!("{} = {}", var.name, value(&var.ty, *v))).collect();
    format!("({})", parts.join(", "))
}

/// How leaves are written, and of which type they are.
trait Names<L> {
    fn leaf(&self, leaf: &L) -> String;
    /// `!leaf`, where that has a form of its own.
    fn negated(&self, leaf: &L) -> Option<String>;
    fn ty(&self, leaf: &L) -> Option<&Type>;
}

impl Names<Leaf> for System {
    fn leaf(&self, leaf: &Leaf) -> String {
        match leaf {
            Leaf::Var(id) => self.vars[*id].name.clone(),
            Leaf::Label(id) => self.labels[*id].name.clone(),
        }
    }

    fn negated(&self, _leaf: &Leaf) -> Option<String> {
        None
    }

    fn ty(&self, leaf: &Leaf) -> Option<&Type> {
        Some(self.leaf_type(*leaf))
    }
}

struct PathNames<'a> {
    problem: &'a Problem,
    objective: &'a Objective,
}

impl PathNames<'_> {
    fn path(&self, path: PathId) -> &str {
        &self.objective.paths[path].name
    }

    fn system(&self, path: PathId) -> &System {
        &self.problem.systems[self.objective.paths[path].system]
    }
}

impl Names<PathLeaf> for PathNames<'_> {
    fn leaf(&self, leaf: &PathLeaf) -> String {
        match leaf {
            PathLeaf::State(p, leaf) => format!("{}[{}]", self.system(*p).leaf(leaf), self.path(*p)),
            PathLeaf::Took(p, a) => {
                format!("action[{}] == {}", self.path(*p), name(&self.problem.actions[*a]))
            }
            PathLeaf::SameAction(p, q) => format!("action[{}] == action[{}]", self.path(*p), self.path(*q)),
            PathLeaf::SameState(p, q) => format!("state[{}] == state[{}]", self.path(*p), self.path(*q)),
            PathLeaf::Enabled(p, a) => {
                format!("{} in enabled[{}]", name(&self.problem.actions[*a]), self.path(*p))
            }
            PathLeaf::Halted(p) => format!("halted[{}]", self.path(*p)),
        }
    }

    fn negated(&self, leaf: &PathLeaf) -> Option<String> {
        match leaf {
            PathLeaf::Took(..) | PathLeaf::SameAction(..) | PathLeaf::SameState(..) => {
                Some(self.leaf(leaf).replacen("==", "!=", 1))
            }
            PathLeaf::State(..) | PathLeaf::Enabled(..) | PathLeaf::Halted(_) => None,
        }
    }

    fn ty(&self, leaf: &PathLeaf) -> Option<&Type> {
        match leaf {
            PathLeaf::State(p, leaf) => self.system(*p).ty(leaf),
            _ => None,
        }
    }
}

struct Printer<'a, N> {
    out: String,
    names: &'a N,
}

impl<N> Printer<'_, N> {
    fn full(&self) -> bool {
        self.out.len() >= MAX_LENGTH
    }

    fn finish(mut self) -> String {
        if self.full() {
            self.out.truncate(self.out.floor_char_boundary(MAX_LENGTH));
            self.out += "...";
        }
        self.out
    }

    /// Runs `f`, in parentheses where what it prints binds more weakly than its place asks.
    fn at_level(&mut self, own: u8, place: u8, f: impl FnOnce(&mut Self)) {
        if self.full() {
            return;
        }
        if own < place {
            self.out.push('(');
        }
        f(self);
        if own < place {
            self.out.push(')');
        }
    }

    /// Operands with a sign between them; `empty` where there is none.
    fn list<T>(&mut self, items: &[T], sign: &str, empty: &str, mut f: impl FnMut(&mut Self, &T)) {
        if items.is_empty() {
            self.out += empty;
        }
        for (index, item) in items.iter().enumerate() {
            if self.full() {
                return;
            }
            if index > 0 {
                self.out += sign;
            }
            f(self, item);
        }
    }
}

impl<N> Printer<'_, N> {
    fn expr<L>(&mut self, e: &Expr<L>, place: u8, ty: Option<&Type>)
    where
        N: Names<L>,
    {
        let names = self.names;
        let own = expr_level(e);
        self.at_level(own, place, |p| match e {
            Expr::Const(v) => p.out += &value(ty.unwrap_or(&Type::Bool), *v),
            Expr::Leaf(leaf) => p.out += &names.leaf(leaf),
            Expr::Not(a) => p.negation(a),
            Expr::And(es) => p.list(es, " & ", "true", |p, e| p.expr(e, level::AND + 1, None)),
            Expr::Or(es) => p.list(es, " | ", "false", |p, e| p.expr(e, level::OR + 1, None)),
            Expr::Iff(a, b) => p.infix(a, " <-> ", b, level::IFF + 1, None),
            Expr::Compare(op, a, b) => {
                let ty = enumeration(names, a).or_else(|| enumeration(names, b));
                p.infix(a, comparison(*op), b, level::SUM, ty);
            }
            Expr::Add(es) => p.sum(es),
            Expr::Mul(-1, a) => p.operand("-", a, ""),
            Expr::Mul(c, a) => p.operand(&format!("{c} * "), a, ""),
            Expr::Scale(c, a) if *c == -Rational::ONE => p.operand("-", a, ""),
            Expr::Scale(c, a) if c.is_integer() || *c.numer() != 1 => p.operand(&format!("{c} * "), a, ""),
            Expr::Scale(c, a) => p.operand("", a, &format!(" / {}", c.denom())),
            Expr::ToReal(a) => p.expr(a, place, ty),
            Expr::Div(a, c) => p.operand("", a, &format!(" div {c}")),
            Expr::Mod(a, c) => p.operand("", a, &format!(" % {c}")),
            Expr::If(branches, last) => {
                for (c, a) in branches {
                    p.out += "if ";
                    p.expr(c, 0, None);
                    p.out += " then ";
                    p.expr(a, 0, ty);
                    p.out += " else ";
                }
                p.expr(last, 0, ty);
            }
            Expr::Member(es, set) => {
                let types: Vec<Option<&Type>> = es.iter().map(|e| enumeration(names, e)).collect();
                p.member(es, &types, &set.tuples);
            }
        });
    }

    /// An operand that binds most tightly, with what stands before and behind it.
    fn operand<L>(&mut self, before: &str, a: &Expr<L>, behind: &str)
    where
        N: Names<L>,
    {
        self.out += before;
        self.expr(a, level::OPERAND, None);
        self.out += behind;
    }

    fn infix<L>(&mut self, a: &Expr<L>, sign: &str, b: &Expr<L>, place: u8, ty: Option<&Type>)
    where
        N: Names<L>,
    {
        self.expr(a, place, ty);
        self.out += sign;
        self.expr(b, place, ty);
    }

    fn negation<L>(&mut self, a: &Expr<L>)
    where
        N: Names<L>,
    {
        if let Expr::Compare(Comparison::Eq, a, b) = a {
            let ty = enumeration(self.names, a).or_else(|| enumeration(self.names, b));
            self.infix(a, " != ", b, level::SUM, ty);
            return;
        }
        if let Expr::Leaf(leaf) = a
            && let Some(negated) = self.names.negated(leaf)
        {
            self.out += &negated;
            return;
        }
        self.out.push('!');
        // `!` takes a comparison whole; parentheses say so to those who do not know.
        self.expr(a, level::OPERAND, None);
    }

    fn sum<L>(&mut self, es: &[Expr<L>])
    where
        N: Names<L>,
    {
        if es.is_empty() {
            self.out.push('0');
        }
        for (index, e) in es.iter().enumerate() {
            let (minus, e) = match e {
                Expr::Const(Value::Int(n)) if *n < 0 && index > 0 => {
                    self.out += &format!(" - {}", n.unsigned_abs());
                    continue;
                }
                Expr::Const(Value::Real(r)) if *r < Rational::ZERO && index > 0 => {
                    self.out += &format!(" - {}", -*r);
                    continue;
                }
                Expr::Mul(-1, e) if index > 0 => (true, &**e),
                Expr::Scale(c, e) if *c == -Rational::ONE && index > 0 => (true, &**e),
                e => (false, e),
            };
            if index > 0 {
                self.out += if minus { " - " } else { " + " };
            }
            self.expr(e, level::PRODUCT, None);
        }
    }

    fn member<L>(&mut self, es: &[Expr<L>], types: &[Option<&Type>], tuples: &[Box<[i64]>])
    where
        N: Names<L>,
    {
        if let [only] = es {
            self.expr(only, level::SUM, None);
        } else {
            self.out.push('(');
            self.list(es, ", ", "", |p, e| p.expr(e, 0, None));
            self.out.push(')');
        }
        self.out += " in {";
        let shown = &tuples[..tuples.len().min(MAX_MEMBERS)];
        self.list(shown, ", ", "", |p, tuple| {
            let member = |(n, ty): (&i64, &Option<&Type>)| match ty {
                Some(ty) => value(ty, Value::Enum(u32::try_from(*n).unwrap_or(u32::MAX))),
                None => n.to_string(),
            };
            let members: Vec<String> = tuple.iter().zip(types).map(member).collect();
            p.out += &match members.as_slice() {
                [only] => only.clone(),
                members => format!("({})", members.join(", ")),
            };
        });
        self.out += if shown.len() < tuples.len() { ", ...}" } else { "}" };
    }
}

impl Printer<'_, PathNames<'_>> {
    fn formula(&mut self, formula: &Formula, id: FormulaId, place: u8) {
        let none = Interval::ALWAYS;
        let (operator, interval) = match (formula.written(id), &formula.nodes[id]) {
            (Some(written), _) => (written.operator, written.interval),
            (None, Node::Atom(e)) => {
                if !self.full() {
                    self.expr(e, place, None);
                }
                return;
            }
            (None, Node::Not(_)) => (Operator::Not, none),
            (None, Node::And(_)) => (Operator::And, none),
            (None, Node::Or(_)) => (Operator::Or, none),
            (None, Node::Iff(..)) => (Operator::Iff, none),
            (None, Node::Next(_)) => (Operator::Unary(UnaryOp::Next), none),
            (None, Node::WeakNext(_)) => (Operator::Unary(UnaryOp::WeakNext), none),
            (None, Node::Until(i, ..)) if formula.finally(id).is_some() => {
                (Operator::Unary(UnaryOp::Finally), *i)
            }
            (None, Node::Release(i, ..)) if formula.globally(id).is_some() => {
                (Operator::Unary(UnaryOp::Globally), *i)
            }
            (None, Node::Until(i, ..)) => (Operator::Binary(BinaryOp::Until), *i),
            (None, Node::Release(i, ..)) => (Operator::Binary(BinaryOp::Release), *i),
        };
        let (row, operands) = (operator.row(), formula.operands(id));
        let sign = row.name.to_owned() + &shown(interval);
        match (row.fixity, operands.as_slice()) {
            (Fixity::Prefix, _) => self.at_level(row.level, place, |p| match operands.last() {
                Some(&a) if operator == Operator::Not => p.not(formula, a),
                Some(&a) => {
                    p.out += &format!("{sign} ");
                    p.formula(formula, a, row.level);
                }
                None => {}
            }),
            // With one operand it is that operand, which may need parentheses.
            (_, [only]) => self.formula(formula, *only, row.level + 1),
            _ => self.at_level(row.level, place, |p| {
                let empty = if operator == Operator::And { "true" } else { "false" };
                p.list(&operands, &format!(" {sign} "), empty, |p, x| p.formula(formula, *x, row.level + 1));
            }),
        }
    }

    fn not(&mut self, formula: &Formula, a: FormulaId) {
        if let Node::Atom(e) = &formula.nodes[a] {
            return self.negation(e);
        }
        self.out += Operator::Not.name();
        self.formula(formula, a, level::LOGIC_PREFIX);
    }
}
fn expr_level<L>(e: &Expr<L>) -> u8 {
    match e {
        Expr::Const(Value::Int(n)) if *n < 0 => level::SUM,
        Expr::Const(Value::Real(r)) if *r < Rational::ZERO => level::SUM,
        Expr::Const(Value::Real(r)) if !r.is_integer() => level::PRODUCT,
        Expr::ToReal(a) => expr_level(a),
        Expr::Const(_) | Expr::Leaf(_) => level::OPERAND,
        Expr::Not(_) => level::LOGIC_PREFIX,
        Expr::And(_) => level::AND,
        Expr::Or(_) => level::OR,
        Expr::Iff(..) => level::IFF,
        Expr::Compare(..) | Expr::Member(..) => level::COMPARE,
        Expr::Add(_) => level::SUM,
        Expr::Mul(..) | Expr::Scale(..) | Expr::Div(..) | Expr::Mod(..) => level::PRODUCT,
        Expr::If(..) => 0,
    }
}

fn comparison(op: Comparison) -> &'static str {
    match op {
        Comparison::Eq => " == ",
        Comparison::Lt => " < ",
        Comparison::Le => " <= ",
    }
}

/// The enumeration that an operand belongs to, if it says so.
fn enumeration<'a, L>(names: &'a impl Names<L>, e: &Expr<L>) -> Option<&'a Type> {
    let mut at = e;
    loop {
        match at {
            Expr::Leaf(leaf) => return names.ty(leaf).filter(|ty| matches!(ty, Type::Enum(_))),
            // Values may be constants; the first that is none says it.
            Expr::If(branches, last) => {
                let values = branches.iter().map(|(_, a)| a);
                at = values.into_iter().find(|a| !matches!(a, Expr::Const(_))).unwrap_or(last);
            }
            _ => return None,
        }
    }
}

fn shown(interval: Interval) -> String {
    match interval.hi {
        Some(hi) => format!("[{},{hi}]", interval.lo),
        None => String::new(),
    }
}
