//! Actions, conditions and effects without parameters.

use super::domain::{Action, Task, Typed, typed};
use super::lists::{Kind, Node};
use crate::build::wrong;
use crate::parser::Parse;
use hyperplan_syntax::Span;
use indexmap::{IndexMap, IndexSet};
use std::collections::BTreeSet;

/// More choices of objects for parameters and quantified variables than this are refused.
const MAX_CHOICES: usize = 1_000_000;

/// More outcomes of one action than this are refused.
const MAX_OUTCOMES: usize = 1_000;

/// A condition over facts.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Cond {
    Const(bool),
    Fact(usize),
    Not(Box<Cond>),
    And(Vec<Cond>),
    Or(Vec<Cond>),
}

impl Cond {
    pub(super) fn not(self) -> Cond {
        match self {
            Cond::Const(value) => Cond::Const(!value),
            Cond::Not(inner) => *inner,
            other => Cond::Not(Box::new(other)),
        }
    }

    /// The conjunction, or the disjunction, of some; what does not matter is left out.
    pub(super) fn all(parts: Vec<Cond>, and: bool) -> Cond {
        if parts.contains(&Cond::Const(!and)) {
            return Cond::Const(!and);
        }
        let mut rest: Vec<Cond> = parts.into_iter().filter(|part| *part != Cond::Const(and)).collect();
        match rest.pop() {
            None => Cond::Const(and),
            Some(only) if rest.is_empty() => only,
            Some(last) => {
                rest.push(last);
                if and { Cond::And(rest) } else { Cond::Or(rest) }
            }
        }
    }

    pub(super) fn facts(&self, found: &mut BTreeSet<usize>) {
        match self {
            Cond::Const(_) => {}
            Cond::Fact(fact) => {
                found.insert(*fact);
            }
            Cond::Not(inner) => inner.facts(found),
            Cond::And(parts) | Cond::Or(parts) => parts.iter().for_each(|part| part.facts(found)),
        }
    }
}

/// A fact that becomes true or false where a condition holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Change {
    pub(super) when: Cond,
    pub(super) fact: usize,
    pub(super) to: bool,
}

/// What an action may do, one of which happens.
type Outcomes = Vec<Vec<Change>>;

/// An action with objects for its parameters.
pub(super) struct Ground {
    pub(super) name: String,
    pub(super) condition: Cond,
    pub(super) outcomes: Outcomes,
}

/// Objects for parameters and quantified variables.
type Bound<'t> = IndexMap<String, &'t str>;

pub(super) struct Grounder<'t> {
    pub(super) task: &'t Task,
    /// Facts that may change, or are not known at first: predicate and objects.
    pub(super) facts: IndexSet<Vec<String>>,
    /// Predicates whose facts never change and are known.
    fixed: BTreeSet<String>,
    /// What is known to be true at first.
    initial: BTreeSet<Vec<String>>,
    choices: usize,
}

impl<'t> Grounder<'t> {
    pub(super) fn new(task: &'t Task) -> Parse<Self> {
        let mut changed = BTreeSet::new();
        for action in &task.actions {
            if let Some(effect) = &action.effect {
                heads(effect, &mut changed)?;
            }
        }
        let mut initial = BTreeSet::new();
        for item in &task.init {
            let (word, _) = item.headed()?;
            match word {
                "oneof" | "or" | "unknown" => heads(item, &mut changed)?,
                "not" | "and" => {}
                "=" => return wrong("unsupported", item.span, "numbers are not supported"),
                _ => {}
            }
        }
        let fixed = task.predicates.keys().filter(|name| !changed.contains(*name)).cloned().collect();
        let mut grounder =
            Grounder { task, facts: IndexSet::new(), fixed, initial: BTreeSet::new(), choices: 0 };
        let mut open: Vec<&Node> = task.init.iter().rev().collect();
        while let Some(item) = open.pop() {
            match item.headed()? {
                ("oneof" | "or" | "unknown", _) => {}
                ("and", parts) => open.extend(parts.iter().rev()),
                // What is not said is false.
                ("not", [part]) => drop(grounder.atom(part, &Bound::new())?),
                _ => {
                    initial.insert(grounder.atom(item, &Bound::new())?);
                }
            }
        }
        grounder.initial = initial;
        Ok(grounder)
    }

    /// Whether a fact is true at first, for all that is said.
    pub(super) fn is_initial(&self, fact: usize) -> bool {
        self.facts.get_index(fact).is_some_and(|atom| self.initial.contains(atom))
    }

    /// A predicate with its objects.
    fn atom(&self, node: &Node, bound: &Bound<'t>) -> Parse<Vec<String>> {
        let (name, arguments) = node.headed()?;
        let Some(types) = self.task.predicates.get(name) else {
            let error = hyperplan_syntax::Diagnostic::error(
                "unknown-name",
                node.span,
                format!("no predicate `{name}`"),
            );
            let known = self.task.predicates.keys().map(String::as_str);
            return Err(Box::new(crate::smv::model::suggest(error, name, known)));
        };
        if types.len() != arguments.len() {
            let message = format!("`{name}` has {} arguments, not {}", types.len(), arguments.len());
            return wrong("argument-count", node.span, message);
        }
        let mut atom = vec![name.to_owned()];
        for argument in arguments {
            atom.push(self.object(argument, bound)?.to_owned());
        }
        Ok(atom)
    }

    fn object(&self, node: &Node, bound: &Bound<'t>) -> Parse<&'t str> {
        let word = node.word()?;
        if let Some(object) = bound.get(word) {
            return Ok(object);
        }
        match self.task.objects.get_key_value(word) {
            Some((name, _)) => Ok(name),
            None if word.starts_with('?') => {
                wrong("unknown-name", node.span, format!("no parameter `{word}`"))
            }
            None => wrong("unknown-name", node.span, format!("no object `{word}`")),
        }
    }

    pub(super) fn condition(&mut self, node: &Node, bound: &Bound<'t>) -> Parse<Cond> {
        if matches!(&node.kind, Kind::List(items) if items.is_empty()) {
            return Ok(Cond::Const(true));
        }
        let (word, parts) = node.headed()?;
        Ok(match (word, parts) {
            ("and" | "or", parts) => {
                let parts = parts.iter().map(|part| self.condition(part, bound)).collect::<Parse<_>>()?;
                Cond::all(parts, word == "and")
            }
            ("not", [part]) => self.condition(part, bound)?.not(),
            ("imply", [a, b]) => {
                let parts = vec![self.condition(a, bound)?.not(), self.condition(b, bound)?];
                Cond::all(parts, false)
            }
            ("=", [a, b]) => Cond::Const(self.object(a, bound)? == self.object(b, bound)?),
            ("forall" | "exists", [variables, body]) => {
                let mut parts = Vec::new();
                for bound in self.choices(&typed(variables.list()?)?, bound, node.span)? {
                    parts.push(self.condition(body, &bound)?);
                }
                Cond::all(parts, word == "forall")
            }
            ("not" | "imply" | "=" | "forall" | "exists", _) => {
                return wrong("syntax", node.span, format!("`{word}` has other parts"));
            }
            _ => {
                let atom = self.atom(node, bound)?;
                if self.fixed.contains(word) {
                    Cond::Const(self.initial.contains(&atom))
                } else {
                    Cond::Fact(self.facts.insert_full(atom).0)
                }
            }
        })
    }

    /// Objects for some variables, in all ways.
    fn choices(&mut self, variables: &[Typed], bound: &Bound<'t>, span: Span) -> Parse<Vec<Bound<'t>>> {
        let mut all = vec![bound.clone()];
        for (name, types, _) in variables {
            let objects = self.task.of_types(types);
            self.choices = self.choices.saturating_add(all.len().saturating_mul(objects.len()));
            if self.choices > MAX_CHOICES {
                let message = format!("more than {MAX_CHOICES} choices of objects");
                return wrong("too-large", span, message);
            }
            let with = |bound: &Bound<'t>| {
                let one = |object: &&'t str| {
                    let mut bound = bound.clone();
                    bound.insert(name.clone(), *object);
                    bound
                };
                objects.iter().map(one).collect::<Vec<_>>()
            };
            all = all.iter().flat_map(with).collect();
        }
        Ok(all)
    }

    fn effect(&mut self, node: &Node, bound: &Bound<'t>, when: &Cond) -> Parse<Outcomes> {
        if matches!(&node.kind, Kind::List(items) if items.is_empty()) {
            return Ok(vec![Vec::new()]);
        }
        let (word, parts) = node.headed()?;
        match (word, parts) {
            ("and", parts) => {
                let all =
                    parts.iter().map(|part| self.effect(part, bound, when)).collect::<Parse<Vec<_>>>()?;
                together(all, node.span)
            }
            ("forall", [variables, body]) => {
                let mut all = Vec::new();
                for bound in self.choices(&typed(variables.list()?)?, bound, node.span)? {
                    all.push(self.effect(body, &bound, when)?);
                }
                together(all, node.span)
            }
            ("oneof", parts) if !parts.is_empty() => {
                let mut all = Vec::new();
                for part in parts {
                    all.extend(self.effect(part, bound, when)?);
                }
                few(all, node.span)
            }
            ("when", [condition, body]) => {
                let condition = self.condition(condition, bound)?;
                let both = Cond::all(vec![when.clone(), condition], true);
                if both == Cond::Const(false) {
                    Ok(vec![Vec::new()])
                } else {
                    self.effect(body, bound, &both)
                }
            }
            ("not", [atom]) => self.change(atom, bound, when, false),
            ("forall" | "oneof" | "when" | "not", _) => {
                wrong("syntax", node.span, format!("`{word}` has other parts"))
            }
            ("increase" | "decrease" | "assign" | "scale-up" | "scale-down", _) => {
                wrong("unsupported", node.span, "numbers are not supported")
            }
            _ => self.change(node, bound, when, true),
        }
    }

    fn change(&mut self, atom: &Node, bound: &Bound<'t>, when: &Cond, to: bool) -> Parse<Outcomes> {
        let atom = self.atom(atom, bound)?;
        let fact = self.facts.insert_full(atom).0;
        Ok(vec![vec![Change { when: when.clone(), fact, to }]])
    }

    /// An action with objects for its parameters, in all ways in which what is fixed allows it.
    pub(super) fn action(&mut self, action: &Action) -> Parse<Vec<Ground>> {
        let mut found = Vec::new();
        for bound in self.choices(&action.parameters, &Bound::new(), action.span)? {
            let condition = match &action.condition {
                Some(condition) => self.condition(condition, &bound)?,
                None => Cond::Const(true),
            };
            if condition == Cond::Const(false) {
                continue;
            }
            let outcomes = match &action.effect {
                Some(effect) => self.effect(effect, &bound, &Cond::Const(true))?,
                None => vec![Vec::new()],
            };
            let words: Vec<&str> =
                std::iter::once(action.name.as_str()).chain(bound.values().copied()).collect();
            found.push(Ground { name: words.join("_"), condition, outcomes });
        }
        Ok(found)
    }
}

/// Each way of one effect with each way of the others.
fn together(all: Vec<Outcomes>, span: Span) -> Parse<Outcomes> {
    let mut found: Outcomes = vec![Vec::new()];
    for outcomes in all {
        if let [only] = outcomes.as_slice() {
            found.iter_mut().for_each(|one| one.extend_from_slice(only));
            continue;
        }
        if found.len().saturating_mul(outcomes.len()) > MAX_OUTCOMES {
            return too_many(span);
        }
        let with = |one: &Vec<Change>| {
            outcomes.iter().map(|more| [one.as_slice(), more].concat()).collect::<Vec<_>>()
        };
        found = found.iter().flat_map(with).collect();
    }
    Ok(found)
}

fn few(all: Outcomes, span: Span) -> Parse<Outcomes> {
    if all.len() > MAX_OUTCOMES { too_many(span) } else { Ok(all) }
}

fn too_many<T>(span: Span) -> Parse<T> {
    wrong("too-large", span, format!("more than {MAX_OUTCOMES} outcomes"))
}

/// The predicates of an effect, or of what is not known at first.
fn heads(node: &Node, found: &mut BTreeSet<String>) -> Parse<()> {
    if matches!(&node.kind, Kind::List(items) if items.is_empty()) {
        return Ok(());
    }
    let (word, parts) = node.headed()?;
    match (word, parts) {
        ("and" | "oneof" | "or" | "not" | "unknown", parts) => {
            parts.iter().try_for_each(|part| heads(part, found))
        }
        ("when" | "forall", [_, body]) => heads(body, found),
        _ => {
            found.insert(word.to_owned());
            Ok(())
        }
    }
}
