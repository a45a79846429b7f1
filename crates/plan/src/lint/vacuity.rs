//! Parts of an objective that make no difference.
//!
//! The notion is the usual one of vacuity (Beer, Ben-David, Eisner and Rodeh; Kupferman and Vardi): an occurrence of
//! a subformula does not matter if a truth value can stand in its place. They ask this of a formula that holds in a
//! system; here it is asked of every choice of paths, so that the answer does not depend on the quantifiers: the
//! formula before and after must agree on all of them. Then no quantifier prefix tells the two apart. Where the
//! formula holds of all paths, as a property with only `forall` should, this is their notion.
//!
//! A subformula that occurs with one polarity only makes the formula weaker or stronger when it is replaced, so one
//! question decides: whether the weaker can hold and the stronger fail. What is found stays replaced in the
//! questions that follow: of two parts that imply each other only one is superfluous.
//!
//! Not every replacement is worth a question. That an assumption is not needed (a conjunct of an antecedent) says
//! that the objective asks for more than it seems, which does no harm. The left side of an until often follows from
//! how the system moves, such as `!crash` on the way to a goal that a crash rules out. And of a conjunct under a
//! temporal operator it is asked only whether its own neighbors imply it, whatever else the objective says.

use super::question::Asker;
use super::rewrite::{Builder, Replaced, above, conjuncts};
use hyperplan_problem::{Formula, FormulaId, Node, Quantifier};
use hyperplan_syntax::ast::BinaryOp;
use hyperplan_syntax::operator::Operator;
use hyperplan_syntax::{Diagnostic, Span};
use rustc_hash::FxHashMap;
use typed_index_collections::TiVec;

/// Adds what is vacuous; whether the formula as a whole holds always, or never.
pub(super) fn lint(asker: &mut Asker<'_>, found: &mut Vec<Diagnostic>) -> bool {
    let formula = &asker.objective.formula;
    let root = formula.root();
    let mut search = Vacuity {
        formula,
        replaced: Replaced::new(),
        polarity: polarities(formula),
        nested: nested(formula),
        places: places(formula),
        visited: formula.nodes.iter().map(|_| false).collect(),
        valid: false,
    };
    if search.part_possible(asker, root, true) == Some(false) {
        found.push(search.impossible(asker));
        return true;
    }
    search.valid = conjuncts(formula, root, &Replaced::new())
        .into_iter()
        .all(|part| search.part_possible(asker, part, false) == Some(false));
    let exists = asker.objective.paths.iter().any(|p| p.quantifier == Quantifier::Exists);
    if search.valid && exists {
        let message = "every choice of paths satisfies this, so it asks for nothing";
        found.push(Diagnostic::warning("trivially-true", formula.spans[root], message));
    }
    search.walk(asker, found);
    search.valid
}

/// Which way a subformula's truth pushes that of the whole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Polarity {
    positive: bool,
    negative: bool,
}

fn polarities(formula: &Formula) -> TiVec<FormulaId, Polarity> {
    let mut all: TiVec<FormulaId, Polarity> = formula.nodes.iter().map(|_| Polarity::default()).collect();
    all[formula.root()].positive = true;
    for (id, node) in formula.nodes.iter_enumerated().rev() {
        let own = all[id];
        let opposite = Polarity { positive: own.negative, negative: own.positive };
        let both =
            Polarity { positive: own.positive || own.negative, negative: own.positive || own.negative };
        let passed = match node {
            Node::Not(_) => opposite,
            Node::Iff(..) => both,
            Node::Atom(_)
            | Node::And(_)
            | Node::Or(_)
            | Node::Next(_)
            | Node::WeakNext(_)
            | Node::Until(..)
            | Node::Release(..) => own,
        };
        for child in node.children() {
            all[child].positive |= passed.positive;
            all[child].negative |= passed.negative;
        }
    }
    all
}

fn nested(formula: &Formula) -> TiVec<FormulaId, bool> {
    let mut all: TiVec<FormulaId, bool> = formula.nodes.iter().map(|_| false).collect();
    for (id, node) in formula.nodes.iter_enumerated().rev() {
        let temporal = match node {
            Node::Next(_) | Node::WeakNext(_) | Node::Until(..) | Node::Release(..) => true,
            Node::Atom(_) | Node::Not(_) | Node::And(_) | Node::Or(_) | Node::Iff(..) => false,
        };
        for child in node.children() {
            all[child] |= temporal || all[id];
        }
    }
    all
}

/// How many subformulas a place in the text stands for; those inside one of the same place do not count.
fn places(formula: &Formula) -> FxHashMap<Span, u32> {
    let mut outer: TiVec<FormulaId, bool> = formula.nodes.iter().map(|_| false).collect();
    outer[formula.root()] = true;
    for (id, node) in formula.nodes.iter_enumerated() {
        for child in node.children() {
            outer[child] |= formula.spans[child] != formula.spans[id];
        }
    }
    let mut places = FxHashMap::default();
    for id in outer.iter_enumerated().filter(|(_, outer)| **outer).map(|(id, _)| id) {
        *places.entry(formula.spans[id]).or_default() += 1;
    }
    places
}

/// Why a replacement is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Role {
    /// A conjunct: `true` in its place.
    Demand,
    /// A disjunct, or what may release or end: `false` in its place.
    Alternative,
    /// What an implication implies: `false` in its place.
    Consequent,
}

impl Role {
    fn value(self) -> bool {
        self == Role::Demand
    }
}

#[derive(Clone, Copy, Debug)]
enum Task {
    Visit(FormulaId),
    Try(FormulaId, Role),
}

struct Vacuity<'f> {
    formula: &'f Formula,
    /// What was found not to matter.
    replaced: Replaced,
    polarity: TiVec<FormulaId, Polarity>,
    /// Whether a subformula is under a temporal operator.
    nested: TiVec<FormulaId, bool>,
    /// How many subformulas each place in the text stands for.
    places: FxHashMap<Span, u32>,
    visited: TiVec<FormulaId, bool>,
    /// Whether the formula holds of all paths.
    valid: bool,
}

impl Vacuity<'_> {
    /// Whether some paths give a part this truth value.
    fn part_possible(&self, asker: &mut Asker<'_>, part: FormulaId, value: bool) -> Option<bool> {
        let mut builder = Builder::new(self.formula);
        let built = builder.part(part, value);
        let what = if value { "any paths satisfy this" } else { "all paths satisfy this" };
        match builder.finish(built) {
            Ok(question) => asker.possible(question, self.formula.spans[part], what),
            Err(constant) => Some(constant),
        }
    }

    /// The formula is unsatisfiable: the first part that is so alone, or all of it.
    fn impossible(&self, asker: &mut Asker<'_>) -> Diagnostic {
        let root = self.formula.root();
        let parts = conjuncts(self.formula, root, &Replaced::new());
        let alone = parts.iter().find(|&&part| self.part_possible(asker, part, true) == Some(false));
        let (part, message) = match alone {
            Some(part) if *part != root => (*part, "no choice of paths satisfies this part of the objective"),
            _ => (root, "no choice of paths satisfies this"),
        };
        Diagnostic::warning("trivially-false", self.formula.spans[part], message)
    }

    fn walk(&mut self, asker: &mut Asker<'_>, found: &mut Vec<Diagnostic>) {
        let mut tasks = vec![Task::Visit(self.formula.root())];
        while let Some(task) = tasks.pop() {
            if asker.is_over(self.formula.spans[self.formula.root()]) {
                return;
            }
            match task {
                Task::Visit(id) => self.visit(id, &mut tasks),
                Task::Try(id, role) => {
                    if let Some(finding) = self.attempt(asker, id, role) {
                        found.push(finding);
                    }
                }
            }
        }
    }

    /// What to try below a node. The last task is done first, and later parts are tried first: they are the ones
    /// that repeat what was said.
    fn visit(&mut self, id: FormulaId, tasks: &mut Vec<Task>) {
        if self.visited[id] || self.replaced.contains_key(&id) {
            return;
        }
        self.visited[id] = true;
        let roles = self.roles(id);
        for (child, role) in roles {
            tasks.push(Task::Visit(child));
            // What one place in the text stands for as a whole is not taken apart: a warning that marks it is right only
            // if all of it can be replaced.
            let whole = self.formula.spans[child] != self.formula.spans[id]
                && self.places.get(&self.formula.spans[child]) == Some(&1);
            if let Some(role) = role.filter(|_| whole) {
                tasks.push(Task::Try(child, role));
            }
        }
    }

    /// The operands as written, and why a replacement of each is tried, if it is.
    fn roles(&self, id: FormulaId) -> Vec<(FormulaId, Option<Role>)> {
        let operands = self.formula.operands(id).into_iter();
        if let Some(written) = self.formula.written(id) {
            let of_second = match written.operator {
                Operator::Implies => Some(Role::Consequent),
                Operator::Binary(BinaryOp::WeakUntil) => Some(Role::Alternative),
                _ => None,
            };
            return operands.zip([None, of_second]).collect();
        }
        match &self.formula.nodes[id] {
            Node::Iff(..) | Node::Atom(_) => Vec::new(),
            Node::And(_) => {
                let demand = self.polarity[id].positive.then_some(Role::Demand);
                operands.map(|i| (i, demand)).collect()
            }
            Node::Or(_) => {
                // `!a | b` is an implication.
                let assumed = |i: FormulaId| matches!(self.formula.nodes[i], Node::Not(_));
                operands.map(|i| (i, (!assumed(i)).then_some(Role::Alternative))).collect()
            }
            Node::Release(..) => operands.zip([Some(Role::Alternative), None]).collect(),
            Node::Not(_) | Node::Next(_) | Node::WeakNext(_) | Node::Until(..) => {
                operands.map(|i| (i, None)).collect()
            }
        }
    }

    fn attempt(&mut self, asker: &mut Asker<'_>, id: FormulaId, role: Role) -> Option<Diagnostic> {
        let weakens = role.value() == self.polarity[id].positive;
        let mixed = self.polarity[id].positive == self.polarity[id].negative;
        let constant = matches!(&self.formula.nodes[id], Node::Atom(e) if e.is_true() || e.is_false());
        // A formula that always holds can only be made to fail.
        if mixed || constant || self.replaced.contains_key(&id) || (self.valid && weakens) {
            return None;
        }
        let alone = role == Role::Demand && self.nested[id];
        if self.matters(asker, id, role.value(), alone, "this part matters")? {
            return None;
        }
        let (finding, replaced, value) = self.describe(asker, id, role);
        self.replaced.insert(replaced, value);
        Some(finding)
    }

    /// Whether some paths tell the formula from the one with a truth value in the place of a subformula; or tell
    /// the conjunct in which it occurs, `alone`.
    fn matters(
        &self,
        asker: &mut Asker<'_>,
        id: FormulaId,
        value: bool,
        alone: bool,
        what: &str,
    ) -> Option<bool> {
        let mut after = self.replaced.clone();
        after.insert(id, value);
        let (weak, strong) = match value == self.polarity[id].positive {
            true => (&after, &self.replaced),
            false => (&self.replaced, &after),
        };
        let mut builder = Builder::new(self.formula);
        let root = self.formula.root();
        let parts = conjuncts(self.formula, root, &after);
        let above = above(self.formula, id);
        let concerned: Vec<FormulaId> = parts.iter().copied().filter(|&part| above[part]).collect();
        let stronger = builder.parts(&concerned, strong);
        let mut parts = builder.parts(if alone { &concerned } else { &parts }, weak);
        let stronger = builder.join(true, stronger, root);
        parts.push(builder.not(stronger, root));
        let built = builder.join(true, parts, root);
        match builder.finish(built) {
            Ok(question) => asker.possible(question, self.formula.spans[id], what),
            Err(constant) => Some(constant),
        }
    }

    /// The warning, and what may stand where if what it marks is replaced as it says: what is found afterwards has to fit.
    fn describe(&self, asker: &mut Asker<'_>, id: FormulaId, role: Role) -> (Diagnostic, FormulaId, bool) {
        let span = self.formula.spans[id];
        let finding = match role {
            Role::Demand => self.superfluous(asker, id),
            Role::Alternative => {
                let message = "this alternative makes no difference: the objective says the same without it";
                Diagnostic::warning("useless-alternative", span, message)
            }
            Role::Consequent => {
                let implication = self.implication_of(id);
                let antecedent = implication.map_or(span, |(_, antecedent)| self.formula.spans[antecedent]);
                let what = "this antecedent is ever met";
                let moot = |&(implication, _): &(FormulaId, FormulaId)| {
                    self.valid || self.matters(asker, implication, true, false, what) == Some(false)
                };
                if let Some((implication, _)) = implication.filter(moot) {
                    return (never_met(antecedent), implication, true);
                }
                let message = "this never holds where its antecedent does, so only the antecedent's failing \
                               satisfies the implication";
                Diagnostic::warning("impossible-consequent", span, message)
                    .with_related(antecedent, "the antecedent")
            }
        };
        (finding, id, role.value())
    }

    /// Of an implication that is implied it is told which side makes it so.
    fn superfluous(&self, asker: &mut Asker<'_>, id: FormulaId) -> Diagnostic {
        let mut place = self.formula.spans[id];
        if let Some((antecedent, consequent)) = self.implication(id) {
            let what = "this antecedent is ever met";
            if self.matters(asker, consequent, false, false, what) == Some(false) {
                return never_met(self.formula.spans[antecedent]);
            }
            place = self.formula.spans[consequent];
        }
        let message = "this part of the objective constrains nothing: the rest of the objective implies it";
        Diagnostic::warning("vacuous", place, message)
    }

    /// The implication that a demand is, perhaps at every step.
    fn implication(&self, id: FormulaId) -> Option<(FormulaId, FormulaId)> {
        let mut at = id;
        loop {
            if let Some(sides) = self.formula.implication(at) {
                return Some(sides);
            }
            at = match self.formula.nodes[at] {
                Node::Next(a) | Node::WeakNext(a) => a,
                _ => self.formula.globally(at)?.1,
            };
        }
    }

    /// The implication that has this consequent, and its antecedent.
    fn implication_of(&self, consequent: FormulaId) -> Option<(FormulaId, FormulaId)> {
        self.formula.nodes.keys().find_map(|id| {
            let (a, b) = self.formula.implication(id)?;
            (b == consequent).then_some((id, a))
        })
    }
}

fn never_met(span: Span) -> Diagnostic {
    let message = "this antecedent is never met, so what it implies asks for nothing";
    Diagnostic::warning("vacuous-antecedent", span, message)
}
