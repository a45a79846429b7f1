//! When two strategies are different ones, and the demand that one differs from others.
//!
//! A path counts until it is *at rest*: where it is absorbed, or, where one block of quantifiers asks single paths for what they
//! have to reach, when all that it has to reach was reached. What comes after makes no difference. Up to there it is a word: the
//! cells that it is in, or the actions that it takes. Two strategies are the same if all their paths have the same words, of the
//! same lengths; so this is an equivalence, and it does not matter in what order strategies are found.

use crate::expr::{Comparison, Expr, Leaf, PathLeaf, State, Type, Value};
use crate::formula::{Formula, Interval, Node};
use crate::ids::{ActionId, FormulaId, PathId, VarId};
use crate::names::names;
use crate::objective::{Objective, Quantifier};
use crate::problem::Problem;
use crate::strategy::{Strategy, Trace};
use crate::system::System;
use hyperplan_syntax::Span;
use hyperplan_syntax::ast::UnaryOp;
#[cfg(test)]
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What of paths is compared.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Difference {
    /// Where they are: the cell of a map, the node of a graph, of other systems all variables.
    #[default]
    Cells,
    /// What they do.
    Actions,
}

names!(pub Difference: Cells "cells", Actions "actions");

/// What tells strategies of an objective apart.
#[derive(Clone, Debug)]
pub struct Distinction<'a> {
    problem: &'a Problem,
    objective: &'a Objective,
    difference: Difference,
    /// What has to be reached, by one path each; `None` where nobody knows when a path is at rest but by its being absorbed.
    errands: Option<Vec<(PathId, FormulaId)>>,
}

/// A path until it is at rest.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Word {
    Cells(Vec<Vec<Value>>),
    Actions(Vec<ActionId>),
}

impl<'a> Distinction<'a> {
    /// Of strategies for an objective; for some `forall` at its beginning, of counterexamples.
    #[must_use]
    pub fn new(problem: &'a Problem, objective: &'a Objective, difference: Difference) -> Self {
        Distinction { problem, objective, difference, errands: errands(objective) }
    }

    /// Whether two strategies are the same.
    #[must_use]
    pub fn is_same(&self, a: &Strategy, b: &Strategy) -> bool {
        let words = |strategy: &Strategy| -> Vec<Word> {
            strategy.traces.iter().map(|trace| self.word(strategy, trace)).collect()
        };
        words(a) == words(b)
    }

    /// The objective with the demand that a strategy differs from each of these. It is to be one that asks no less of paths than
    /// that of the distinction, and begins with its formula: with paths read for longer, perhaps.
    #[must_use]
    pub fn apart(&self, objective: &Objective, strategies: &[Strategy]) -> Objective {
        let mut apart = objective.clone();
        let root = apart.formula.root();
        let others: Vec<FormulaId> =
            strategies.iter().map(|other| self.differs(&mut apart.formula, other)).collect();
        if others.is_empty() {
            return apart;
        }
        let span = apart.span;
        let parts = |first, others: Vec<FormulaId>| [vec![first], others].concat();
        let exists = apart.paths.first().is_none_or(|path| path.quantifier == Quantifier::Exists);
        let whole = match exists {
            true => Node::And(parts(root, others)),
            // A counterexample makes the formula false.
            false => {
                let same = others.iter().map(|&other| apart.formula.push(Node::Not(other), span)).collect();
                Node::Or(parts(root, same))
            }
        };
        apart.formula.push(whole, span);
        apart
    }

    /// That some leading path is not what it is in a strategy.
    fn differs(&self, formula: &mut Formula, other: &Strategy) -> FormulaId {
        let mut ways = Vec::new();
        for trace in &other.traces {
            let rest = self.rest(other, trace);
            let mut writer = Writer { formula, path: trace.path, span: self.objective.span };
            match self.difference {
                Difference::Cells => {
                    for (time, state) in trace.states[..=rest].iter().enumerate() {
                        let elsewhere = Expr::Not(Box::new(self.is_at(trace.path, state)));
                        ways.push(writer.at(time, elsewhere));
                    }
                }
                Difference::Actions => {
                    for (step, &action) in trace.actions[..rest].iter().enumerate() {
                        let took = Expr::Leaf(PathLeaf::Took(trace.path, action));
                        ways.push(writer.at(step + 1, Expr::Not(Box::new(took))));
                    }
                }
            }
            // The same so far, and at rest earlier or later.
            if let Some(before) = rest.checked_sub(1) {
                ways.push(self.rests(&mut writer, before));
            }
            if rest < trace.actions.len() {
                let rests = self.rests(&mut writer, rest);
                ways.push(writer.formula.push(Node::Not(rests), writer.span));
            }
        }
        formula.push(Node::Or(ways), self.objective.span)
    }

    /// That a path is at rest by a time which is before its end.
    fn rests(&self, writer: &mut Writer<'_>, time: usize) -> FormulaId {
        let path = writer.path;
        let mut ways = Vec::new();
        let absorb = &self.system(path).absorb;
        if !absorb.is_false() {
            ways.push(writer.at(time, absorb.map(&mut |leaf| PathLeaf::State(path, *leaf))));
        }
        if let Some(errands) = self.errands_of(path) {
            let met = errands.iter().map(|&errand| writer.met_by(errand, time)).collect();
            ways.push(writer.formula.push(Node::And(met), writer.span));
        }
        writer.formula.push(Node::Or(ways), writer.span)
    }

    /// When a path of a strategy is at rest, at the latest at its end.
    fn rest(&self, strategy: &Strategy, trace: &Trace) -> usize {
        let system = self.system(trace.path);
        let absorbs = |state: &State| truth(system, &system.absorb, state);
        let absorbed = trace.states.iter().position(absorbs);
        let met = self.errands_of(trace.path).map(|errands| {
            let times = errands.iter().map(|&errand| self.met(strategy, errand));
            times.max().unwrap_or(0)
        });
        absorbed.into_iter().chain(met).fold(trace.actions.len(), usize::min)
    }

    /// What a path has to reach; of one that need not reach anything itself, what all have to.
    fn errands_of(&self, path: PathId) -> Option<Vec<FormulaId>> {
        let all = self.errands.as_ref()?;
        let own: Vec<FormulaId> = all.iter().filter(|(own, _)| *own == path).map(|(_, id)| *id).collect();
        Some(if own.is_empty() { all.iter().map(|(_, id)| *id).collect() } else { own })
    }

    /// When something that has to be reached is; never is later than any time.
    fn met(&self, strategy: &Strategy, errand: FormulaId) -> usize {
        let formula = &self.objective.formula;
        let Node::Until(interval, before, reached) = formula.nodes[errand] else { return usize::MAX };
        let of = self.errands.iter().flatten().find(|(_, id)| *id == errand).map(|(path, _)| *path);
        let trace = strategy.traces.iter().find(|trace| Some(trace.path) == of);
        let length = trace.map_or(0, |trace| trace.states.len());
        let last = interval.hi.map_or(usize::MAX, |hi| hi as usize);
        for time in 0..length.min(last.saturating_add(1)) {
            if time >= interval.lo as usize && self.holds(strategy, reached, time) {
                return time;
            }
            if !self.holds(strategy, before, time) {
                break;
            }
        }
        usize::MAX
    }

    /// Whether a formula without operators over time holds.
    fn holds(&self, strategy: &Strategy, id: FormulaId, time: usize) -> bool {
        let holds = |id: FormulaId| self.holds(strategy, id, time);
        match &self.objective.formula.nodes[id] {
            Node::Atom(atom) => {
                let mut read = |leaf: &PathLeaf| {
                    let trace = |path: PathId| strategy.traces.iter().find(move |trace| trace.path == path);
                    match *leaf {
                        PathLeaf::State(path, leaf) => {
                            value(self.system(path), &Expr::Leaf(leaf), trace(path)?.states.get(time)?)
                        }
                        PathLeaf::Took(path, action) => {
                            let taken = time.checked_sub(1).map(|step| trace(path)?.actions.get(step));
                            Some(Value::Bool(taken.flatten() == Some(&action)))
                        }
                        _ => None,
                    }
                };
                atom.truth(&mut read) == Some(true)
            }
            Node::Not(a) => !holds(*a),
            Node::And(all) => all.iter().all(|&id| holds(id)),
            Node::Or(all) => all.iter().any(|&id| holds(id)),
            Node::Iff(a, b) => holds(*a) == holds(*b),
            Node::Next(_) | Node::WeakNext(_) | Node::Until(..) | Node::Release(..) => false,
        }
    }

    fn word(&self, strategy: &Strategy, trace: &Trace) -> Word {
        let rest = self.rest(strategy, trace);
        match self.difference {
            Difference::Actions => Word::Actions(trace.actions[..rest].to_vec()),
            Difference::Cells => {
                let vars = place(self.system(trace.path));
                let cell = |state: &State| vars.iter().map(|var| state[usize::from(*var)]).collect();
                Word::Cells(trace.states[..=rest].iter().map(cell).collect())
            }
        }
    }

    fn system(&self, path: PathId) -> &'a System {
        &self.problem.systems[self.objective.paths[path].system]
    }

    /// That a path is in the cell of a state.
    fn is_at(&self, path: PathId, state: &State) -> Expr<PathLeaf> {
        let system = self.system(path);
        let is = |var: &VarId| {
            let leaf = Expr::Leaf(PathLeaf::State(path, Leaf::Var(*var)));
            match (&system.vars[*var].ty, state[usize::from(*var)]) {
                (Type::Bool, Value::Bool(true)) => leaf,
                (Type::Bool, _) => Expr::Not(Box::new(leaf)),
                (_, value) => Expr::Compare(Comparison::Eq, Box::new(leaf), Box::new(Expr::Const(value))),
            }
        };
        Expr::And(place(system).iter().map(is).collect())
    }
}

/// Writes what is said of a path.
struct Writer<'f> {
    formula: &'f mut Formula,
    path: PathId,
    span: Span,
}

impl Writer<'_> {
    /// That something holds at a time.
    fn at(&mut self, time: usize, what: Expr<PathLeaf>) -> FormulaId {
        // Horizons are far less.
        let time = u32::try_from(time).unwrap_or(u32::MAX);
        let atom = self.formula.push(Node::Atom(what), self.span);
        let then = Interval { lo: time, hi: Some(time) };
        self.formula.unary(UnaryOp::Finally, then, atom, self.span)
    }

    /// That something that has to be reached is by a time.
    fn met_by(&mut self, errand: FormulaId, time: usize) -> FormulaId {
        let time = u32::try_from(time).unwrap_or(u32::MAX);
        let node = match self.formula.nodes[errand] {
            Node::Until(interval, before, reached) if interval.lo <= time => {
                let hi = interval.hi.map_or(time, |hi| hi.min(time));
                Node::Until(Interval { lo: interval.lo, hi: Some(hi) }, before, reached)
            }
            _ => Node::Or(Vec::new()),
        };
        self.formula.push(node, self.span)
    }
}

/// What has to be reached, if that is all that is owed over time but for what always has to hold.
fn errands(objective: &Objective) -> Option<Vec<(PathId, FormulaId)>> {
    let exists = objective.paths.iter().all(|path| path.quantifier == Quantifier::Exists);
    if !exists || objective.semantics.is_some() {
        return None;
    }
    let formula = &objective.formula;
    let timeless = timeless(formula);
    let mut errands = Vec::new();
    for part in formula.parts() {
        match formula.nodes[part] {
            _ if timeless[usize::from(part)] => {}
            Node::Until(_, before, reached)
                if timeless[usize::from(before)] && timeless[usize::from(reached)] =>
            {
                let [path] = readers(formula, &[before, reached])?[..] else { return None };
                errands.push((path, part));
            }
            _ => {
                let (_, always) = formula.globally(part)?;
                timeless[usize::from(always)].then_some(())?;
            }
        }
    }
    (!errands.is_empty()).then_some(errands)
}

/// Which subformulas have no operators over time.
fn timeless(formula: &Formula) -> Vec<bool> {
    let mut timeless: Vec<bool> = Vec::with_capacity(formula.nodes.len());
    for node in &formula.nodes {
        timeless.push(match node {
            Node::Next(_) | Node::WeakNext(_) | Node::Until(..) | Node::Release(..) => false,
            other => other.children().iter().all(|child| timeless[usize::from(*child)]),
        });
    }
    timeless
}

/// The paths that subformulas read; `None` where they read more than states and actions of single paths.
fn readers(formula: &Formula, roots: &[FormulaId]) -> Option<Vec<PathId>> {
    let mut open = roots.to_vec();
    let mut paths = Vec::new();
    let mut simple = true;
    while let Some(id) = open.pop() {
        if let Node::Atom(atom) = &formula.nodes[id] {
            atom.for_each_leaf(&mut |leaf| match *leaf {
                PathLeaf::State(path, _) | PathLeaf::Took(path, _) => paths.push(path),
                _ => simple = false,
            });
        }
        open.extend(formula.nodes[id].children());
    }
    paths.sort_unstable();
    paths.dedup();
    simple.then_some(paths)
}

/// The variables that say where a path is.
fn place(system: &System) -> Vec<VarId> {
    match (&system.map, &system.edges) {
        (Some(map), _) => vec![map.x, map.y],
        (None, Some(edges)) => vec![edges.var],
        (None, None) => {
            let own = system.vars.iter_enumerated().filter(|(_, var)| var.sums.is_none());
            own.map(|(var, _)| var).collect()
        }
    }
}

fn value(system: &System, expr: &Expr<Leaf>, state: &State) -> Option<Value> {
    system.evaluate(expr, &|var| state.get(usize::from(var)).copied())
}

fn truth(system: &System, expr: &Expr<Leaf>, state: &State) -> bool {
    value(system, expr, state) == Some(Value::Bool(true))
}
