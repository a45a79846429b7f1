//! Small problems by hand: systems as edge lists over one variable `s`, formulas as trees.

use hyperplan_problem::{
    ActionId, Clause, Comparison, Expr, Formula, FormulaId, Interval, Label, Leaf, Mode, Node, Objective,
    PathId, PathLeaf, PathVar, Problem, Quantifier, Strategy, System, SystemId, Trace, Type, Update, Value,
    Var, VarId,
};
use hyperplan_syntax::ast::{BinaryOp, UnaryOp};
use hyperplan_syntax::{SourceId, Span};

pub(crate) const S: VarId = VarId(0);

pub(crate) fn span() -> Span {
    Span::new(SourceId(0), 0..0)
}

pub(crate) fn is<L>(leaf: L, n: i64) -> Expr<L> {
    Expr::Compare(Comparison::Eq, Box::new(Expr::Leaf(leaf)), Box::new(Expr::Const(Value::Int(n))))
}

/// States `0..n`, actions `0..actions`, edges `(from, action, to)`.
pub(crate) fn system(n: i64, actions: u32, edges: &[(i64, u32, i64)], init: &[i64]) -> System {
    let clauses = edges.iter().map(|&(from, action, to)| Clause {
        actions: vec![ActionId(action)],
        guard: is(Leaf::Var(S), from),
        updates: vec![(S, Update::OneOf(vec![Expr::Const(Value::Int(to))]))],
        span: span(),
        generated: false,
    });
    System {
        name: "M".into(),
        vars: vec![Var { name: "s".into(), ty: Type::Range { lo: 0, hi: n - 1 }, sums: None, span: span() }]
            .into(),
        actions: (0..actions).map(ActionId).collect(),
        clauses: clauses.collect(),
        also: Vec::new(),
        costs: Vec::new().into(),
        base: None,
        edges: None,
        trans: Expr::TRUE,
        init: Expr::Or(init.iter().map(|&i| is(Leaf::Var(S), i)).collect()),
        labels: vec![Label {
            name: "zero".into(),
            expr: is(Leaf::Var(S), 0),
            ty: Type::Bool,
            nested: false,
            span: span(),
        }]
        .into(),
        absorb: Expr::FALSE,
        observe: Vec::new(),
        map: None,
        coordinates: None,
        span: span(),
    }
}

/// A formula as a tree; paths by number.
#[derive(Clone, Debug)]
pub(crate) enum F {
    At(u32, i64),
    Took(u32, u32),
    SameAction(u32, u32),
    SameState(u32, u32),
    Enabled(u32, u32),
    Not(Box<F>),
    And(Vec<F>),
    Or(Vec<F>),
    Implies(Box<F>, Box<F>),
    Iff(Box<F>, Box<F>),
    X(Box<F>),
    N(Box<F>),
    Fin(u32, Option<u32>, Box<F>),
    Glob(u32, Option<u32>, Box<F>),
    Bin(BinaryOp, u32, Option<u32>, Box<F>, Box<F>),
}

pub(crate) fn b(f: F) -> Box<F> {
    Box::new(f)
}

fn push(f: &F, formula: &mut Formula) -> FormulaId {
    let p = |n: u32| PathId(n);
    let interval = |lo: &u32, hi: &Option<u32>| Interval { lo: *lo, hi: *hi };
    let node = match f {
        F::At(q, n) => Node::Atom(is(PathLeaf::State(p(*q), Leaf::Var(S)), *n)),
        F::Took(q, a) => Node::Atom(Expr::Leaf(PathLeaf::Took(p(*q), ActionId(*a)))),
        F::SameAction(q, r) => Node::Atom(Expr::Leaf(PathLeaf::SameAction(p(*q), p(*r)))),
        F::SameState(q, r) => Node::Atom(Expr::Leaf(PathLeaf::SameState(p(*q), p(*r)))),
        F::Enabled(q, a) => Node::Atom(Expr::Leaf(PathLeaf::Enabled(p(*q), ActionId(*a)))),
        F::Not(a) => Node::Not(push(a, formula)),
        F::And(fs) => Node::And(fs.iter().map(|f| push(f, formula)).collect()),
        F::Or(fs) => Node::Or(fs.iter().map(|f| push(f, formula)).collect()),
        F::Iff(a, b) => Node::Iff(push(a, formula), push(b, formula)),
        F::X(a) => Node::Next(push(a, formula)),
        F::N(a) => Node::WeakNext(push(a, formula)),
        F::Implies(a, b) => {
            let (a, b) = (push(a, formula), push(b, formula));
            return formula.implies(a, b, span());
        }
        F::Fin(lo, hi, a) => {
            let a = push(a, formula);
            return formula.unary(UnaryOp::Finally, interval(lo, hi), a, span());
        }
        F::Glob(lo, hi, a) => {
            let a = push(a, formula);
            return formula.unary(UnaryOp::Globally, interval(lo, hi), a, span());
        }
        F::Bin(op, lo, hi, a, b) => {
            let (a, b) = (push(a, formula), push(b, formula));
            return formula.binary(*op, interval(lo, hi), a, b, span());
        }
    };
    formula.push(node, span())
}

/// `prefix` has one letter a path: `e` or `a`.
pub(crate) fn problem(system: System, prefix: &str, mode: Mode, f: &F) -> Problem {
    let paths = prefix.chars().enumerate().map(|(i, c)| PathVar {
        name: format!("p{i}"),
        quantifier: if c == 'e' { Quantifier::Exists } else { Quantifier::Forall },
        system: SystemId(0),
        span: span(),
    });
    let mut formula = Formula::default();
    push(f, &mut formula);
    let (name, paths) = ("o".into(), paths.collect());
    let objective =
        Objective { name, paths, mode, semantics: None, formula, minimize: Vec::new(), span: span() };
    Problem {
        actions: system.actions.iter().map(|a| format!("a{}", a.0)).collect(),
        systems: vec![system].into(),
        objectives: vec![objective],
    }
}

/// One trace for path `i`: states, and actions between them.
pub(crate) fn trace(i: u32, states: &[i64], actions: &[u32]) -> Trace {
    Trace {
        path: PathId(i),
        states: states.iter().map(|&n| vec![Value::Int(n)].into()).collect(),
        actions: actions.iter().map(|&a| ActionId(a)).collect(),
    }
}

pub(crate) fn strategy(traces: &[Trace]) -> Strategy {
    Strategy { traces: traces.to_vec() }
}

/// A trace as state numbers and action numbers.
pub(crate) fn numbers(trace: &Trace) -> (Vec<i64>, Vec<u32>) {
    let number = |v: &Value| if let Value::Int(n) = v { *n } else { -1 };
    (trace.states.iter().map(|s| number(&s[0])).collect(), trace.actions.iter().map(|a| a.0).collect())
}
