//! Atoms of an objective as terms over the paths.

use crate::Encoder;
use crate::eval::{eval, eval_in};
use crate::explicit::ExplicitPath;
use crate::graph::{Graph, StateIx};
use crate::moves::InState;
use crate::path::{Path, Shape};
use crate::symbolic::SymbolicPath;
use crate::unroll::AtomTerms;
use crate::value::{Leaves, Val, constant, merge, same, translate};
use hyperplan_problem::{
    ActionId, Expr, FormulaId, Leaf, Node, Objective, PathId, PathLeaf, Problem, System, Value,
};
use hyperplan_smt::{Term, Terms};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// The paths of one instance of the formula, by path variable.
pub(crate) type Env = Vec<Option<Rc<Path>>>;

/// Atoms over one choice of paths.
pub(crate) struct PathAtoms<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) objective: &'a Objective,
    pub(crate) env: &'a Env,
    /// Whether each enumerated state satisfies an atom that reads one such path's state, by atom.
    truth: FxHashMap<FormulaId, Vec<Option<bool>>>,
    /// The symbolic enabledness of moves, by path and time.
    enabled: FxHashMap<(PathId, u32), Rc<Vec<Term>>>,
}

impl<'a> PathAtoms<'a> {
    pub(crate) fn new(problem: &'a Problem, objective: &'a Objective, env: &'a Env) -> Self {
        PathAtoms { problem, objective, env, truth: FxHashMap::default(), enabled: FxHashMap::default() }
    }

    fn path(&self, path: PathId) -> &'a Path {
        self.env[usize::from(path)].as_deref().expect("every path of the formula is quantified")
    }

    fn system(&self, path: PathId) -> &'a System {
        &self.problem.systems[self.objective.paths[path].system]
    }
}

impl AtomTerms for PathAtoms<'_> {
    fn atom(&mut self, terms: &mut Terms, atom: FormulaId, time: u32) -> Term {
        let objective = self.objective;
        let Node::Atom(expr) = &objective.formula.nodes[atom] else {
            unreachable!("only atoms are asked for");
        };
        // The common case, with its truth per state computed once: an atom over the state of one enumerated path.
        if let Some(path) = only_path(expr)
            && let Shape::Explicit(explicit) = &self.path(path).shape
        {
            let system = self.system(path);
            let states = explicit.graph.len();
            let truth = self.truth.entry(atom).or_insert_with(|| vec![None; states]);
            return explicit.layers[time as usize].any(terms, |state| {
                *truth[state as usize].get_or_insert_with(|| eval_on(system, explicit, expr, state) != 0)
            });
        }
        translate(terms, expr, &mut AtTime { atoms: self, time }).truth()
    }
}

/// The path whose state alone an expression reads, if there is one.
fn only_path(expr: &Expr<PathLeaf>) -> Option<PathId> {
    let mut path = None;
    let mut only = true;
    expr.for_each_leaf(&mut |leaf| match *leaf {
        PathLeaf::State(p, _) | PathLeaf::Enabled(p, _) | PathLeaf::Halted(p) => {
            only &= path.is_none_or(|known| known == p);
            path = Some(p);
        }
        PathLeaf::Took(..) | PathLeaf::SameAction(..) | PathLeaf::SameState(..) => only = false,
    });
    path.filter(|_| only)
}

/// The value of an expression over one enumerated path in a state.
fn eval_on(system: &System, path: &ExplicitPath, expr: &Expr<PathLeaf>, state: u32) -> i64 {
    eval(expr, &mut |leaf| match *leaf {
        PathLeaf::State(_, leaf) => eval_in(system, &Expr::Leaf(leaf), path.graph.row(state)),
        PathLeaf::Enabled(_, action) => i64::from(path.graph.enables(state, action)),
        PathLeaf::Halted(_) => i64::from(path.graph.halts(state)),
        // `only_path` lets nothing else through.
        PathLeaf::Took(..) | PathLeaf::SameAction(..) | PathLeaf::SameState(..) => 0,
    })
}

/// Whether an expression is a truth value rather than a number.
fn is_truth(system_of: &dyn Fn(PathId, Leaf) -> bool, expr: &Expr<PathLeaf>) -> bool {
    match expr {
        Expr::Const(Value::Bool(_))
        | Expr::Not(_)
        | Expr::And(_)
        | Expr::Or(_)
        | Expr::Iff(..)
        | Expr::Compare(..)
        | Expr::Member(..) => true,
        Expr::Const(_)
        | Expr::Add(_)
        | Expr::Mul(..)
        | Expr::Scale(..)
        | Expr::ToReal(_)
        | Expr::Div(..)
        | Expr::Mod(..) => false,
        Expr::If(_, a, _) => is_truth(system_of, a),
        Expr::Leaf(PathLeaf::State(p, leaf)) => system_of(*p, *leaf),
        Expr::Leaf(_) => true,
    }
}

struct AtTime<'b, 'a> {
    atoms: &'b mut PathAtoms<'a>,
    time: u32,
}

impl AtTime<'_, '_> {
    /// The action just taken; at time 0 none was.
    fn took(&self, path: PathId, action: ActionId) -> Term {
        let Some(step) = (self.time as usize).checked_sub(1) else { return Term::FALSE };
        match &self.atoms.path(path).shape {
            Shape::Explicit(p) => p.steps[step].took(action),
            Shape::Symbolic(p) => p.steps[step].took(action),
        }
    }

    fn same_action(&self, terms: &mut Terms, p: PathId, q: PathId) -> Term {
        if self.time == 0 || p == q {
            return Term::TRUE;
        }
        let parts: Vec<Term> = self
            .atoms
            .system(p)
            .actions
            .iter()
            .map(|&action| {
                let (a, b) = (self.took(p, action), self.took(q, action));
                terms.implies(a, b)
            })
            .collect();
        terms.and(&parts)
    }

    fn same_state(&self, terms: &mut Terms, p: PathId, q: PathId) -> Term {
        let time = self.time as usize;
        match (&self.atoms.path(p).shape, &self.atoms.path(q).shape) {
            (Shape::Explicit(p), Shape::Explicit(q)) => {
                let (p, q) = (&p.layers[time], &q.layers[time]);
                if let ([state], [Term::TRUE]) = (&p.states[..], &p.terms[..]) {
                    return q.is(*state);
                }
                let parts: Vec<Term> =
                    p.states.iter().zip(&p.terms).map(|(&s, &here)| terms.implies(here, q.is(s))).collect();
                terms.and(&parts)
            }
            (Shape::Symbolic(p), Shape::Symbolic(q)) => {
                let pairs = p.states[time].iter().zip(q.states[time].iter());
                let parts: Vec<Term> = pairs.map(|(a, b)| same(terms, a, b)).collect();
                terms.and(&parts)
            }
            _ => unreachable!("all paths of a query are written alike"),
        }
    }

    fn enabled(&mut self, terms: &mut Terms, path: PathId, action: ActionId) -> Term {
        let time = self.time;
        match &self.atoms.path(path).shape {
            Shape::Explicit(p) => p.layers[time as usize].any(terms, |s| p.graph.enables(s, action)),
            Shape::Symbolic(p) => {
                let enabled = self.enabled_moves(terms, path, p);
                let moves = self.atoms.path(path).moves();
                let own: Vec<Term> = moves.of_action(action).map(|at| enabled[at]).collect();
                terms.or(&own)
            }
        }
    }

    fn halted(&mut self, terms: &mut Terms, path: PathId) -> Term {
        let time = self.time as usize;
        match &self.atoms.path(path).shape {
            Shape::Explicit(p) => p.layers[time].any(terms, |s| p.graph.halts(s)),
            Shape::Symbolic(p) => {
                let enabled = self.enabled_moves(terms, path, p);
                let moves = self.atoms.path(path).moves();
                moves.halted(terms, self.atoms.system(path), &p.states[time], &enabled)
            }
        }
    }

    /// For each move of the path's system, whether it can be made now.
    fn enabled_moves(&mut self, terms: &mut Terms, path: PathId, symbolic: &SymbolicPath) -> Rc<Vec<Term>> {
        let system = self.atoms.system(path);
        let moves = self.atoms.path(path).moves();
        let state = &symbolic.states[self.time as usize];
        let known = self.atoms.enabled.entry((path, self.time));
        known.or_insert_with(|| Rc::new(moves.enabled(terms, system, state))).clone()
    }

    /// An expression over one enumerated path, by the value that it has in each state.
    fn by_state(&self, terms: &mut Terms, path: &ExplicitPath, of: PathId, expr: &Expr<PathLeaf>) -> Val {
        let system = self.atoms.system(of);
        let layer = &path.layers[self.time as usize];
        let truth = is_truth(&|_, leaf| is_truth_leaf(system, leaf), expr);
        if truth {
            return Val::Bool(layer.any(terms, |s| eval_on(system, path, expr, s) != 0));
        }
        let cases: Vec<(i64, Term)> = layer
            .states
            .iter()
            .zip(&layer.terms)
            .map(|(&s, &here)| (eval_on(system, path, expr, s), here))
            .collect();
        merge(terms, cases.into_iter())
    }
}

impl Leaves<PathLeaf> for AtTime<'_, '_> {
    fn leaf(&mut self, terms: &mut Terms, leaf: &PathLeaf) -> Val {
        match *leaf {
            PathLeaf::Took(p, action) => Val::Bool(self.took(p, action)),
            PathLeaf::SameAction(p, q) => Val::Bool(self.same_action(terms, p, q)),
            PathLeaf::SameState(p, q) => Val::Bool(self.same_state(terms, p, q)),
            PathLeaf::Enabled(p, action) => Val::Bool(self.enabled(terms, p, action)),
            PathLeaf::Halted(p) => Val::Bool(self.halted(terms, p)),
            PathLeaf::State(p, leaf) => match &self.atoms.path(p).shape {
                Shape::Explicit(path) => self.by_state(terms, path, p, &Expr::Leaf(PathLeaf::State(p, leaf))),
                Shape::Symbolic(path) => in_state(terms, self.atoms.system(p), path, self.time, leaf),
            },
        }
    }

    fn whole(&mut self, terms: &mut Terms, expr: &Expr<PathLeaf>) -> Option<Val> {
        let path = only_path(expr)?;
        match &self.atoms.path(path).shape {
            Shape::Explicit(explicit) => Some(self.by_state(terms, explicit, path, expr)),
            Shape::Symbolic(_) => None,
        }
    }
}

fn in_state(terms: &mut Terms, system: &System, path: &SymbolicPath, time: u32, leaf: Leaf) -> Val {
    InState { system, state: &path.states[time as usize] }.leaf(terms, &leaf)
}

/// The leaves of atoms where one path is on a given step of a run, the others as terms.
pub(crate) struct OnRun<'b, 'a> {
    pub(crate) atoms: &'b mut PathAtoms<'a>,
    pub(crate) encoder: &'b Encoder<'b>,
    /// The path on the run.
    pub(crate) path: PathId,
    pub(crate) graph: &'b Graph,
    pub(crate) state: StateIx,
    /// The action just taken; none at time 0.
    pub(crate) action: Option<ActionId>,
    pub(crate) time: u32,
}

impl OnRun<'_, '_> {
    /// The other of two paths, where one is on the run.
    fn other(&self, p: PathId, q: PathId) -> Option<PathId> {
        match (p == self.path, q == self.path) {
            (true, _) => Some(q),
            (_, true) => Some(p),
            _ => None,
        }
    }

    /// Whether a path is read at this time at all; beyond its horizon no value matters.
    fn is_read(&self, path: PathId) -> bool {
        path == self.path || self.time <= self.encoder.horizon(path)
    }

    fn is_at(&self, path: PathId) -> Term {
        match &self.atoms.path(path).shape {
            Shape::Explicit(p) => p.layers[self.time as usize].is(self.state),
            Shape::Symbolic(_) => unreachable!("all paths of a query are written alike"),
        }
    }
}

impl Leaves<PathLeaf> for OnRun<'_, '_> {
    fn leaf(&mut self, terms: &mut Terms, leaf: &PathLeaf) -> Val {
        let truth = |holds: bool| Val::Bool(if holds { Term::TRUE } else { Term::FALSE });
        let unread = leaf.paths().into_iter().flatten().any(|p| !self.is_read(p));
        match *leaf {
            PathLeaf::State(p, state_leaf) if p == self.path || unread => {
                let system = self.encoder.system(p);
                let value = if unread {
                    0
                } else {
                    eval_in(system, &Expr::Leaf(state_leaf), self.graph.row(self.state))
                };
                if is_truth_leaf(system, state_leaf) { truth(value != 0) } else { constant(value) }
            }
            _ if unread => truth(false),
            PathLeaf::Took(p, action) if p == self.path => truth(self.action == Some(action)),
            PathLeaf::Enabled(p, action) if p == self.path => truth(self.graph.enables(self.state, action)),
            PathLeaf::Halted(p) if p == self.path => truth(self.graph.halts(self.state)),
            PathLeaf::SameAction(p, q) if self.other(p, q).is_some() => match (self.other(p, q), self.action)
            {
                (Some(other), Some(action)) if other != self.path => {
                    Val::Bool(AtTime { atoms: self.atoms, time: self.time }.took(other, action))
                }
                _ => truth(true),
            },
            PathLeaf::SameState(p, q) if self.other(p, q).is_some() => match self.other(p, q) {
                Some(other) if other != self.path => Val::Bool(self.is_at(other)),
                _ => truth(true),
            },
            _ => AtTime { atoms: self.atoms, time: self.time }.leaf(terms, leaf),
        }
    }

    fn whole(&mut self, terms: &mut Terms, expr: &Expr<PathLeaf>) -> Option<Val> {
        let path = only_path(expr).filter(|&p| p != self.path && self.is_read(p))?;
        match &self.atoms.path(path).shape {
            Shape::Explicit(_) => AtTime { atoms: self.atoms, time: self.time }.whole(terms, expr),
            Shape::Symbolic(_) => None,
        }
    }
}

fn is_truth_leaf(system: &System, leaf: Leaf) -> bool {
    match leaf {
        Leaf::Var(v) => system.vars[v].ty == hyperplan_problem::Type::Bool,
        Leaf::Label(_) => true,
    }
}
