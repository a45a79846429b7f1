//! Planning tasks in PDDL with `oneof`: conformant planning as an objective.
//!
//! Facts become Boolean variables, actions lose their parameters. A plan has to work whatever is the case at first and
//! whatever its actions lead to, and each of its actions has to be possible then: one that is not makes the task
//! `failed`. So every action can be taken everywhere, and every path with the plan's actions is one that counts. The
//! plan itself is a path of a system without states.

mod domain;
mod ground;
mod lists;

use crate::build::wrong;
use crate::names::Names;
use crate::parser::Parse;
use domain::Task;
use ground::{Change, Cond, Ground, Grounder};
use hyperplan_syntax::{SourceId, Span};
use lists::Node;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// More alternatives of what is the case at first than this are refused: no two of them may be.
const MAX_ALTERNATIVES: usize = 300;

/// The problem file, as text, that some files mean within so many steps.
pub(crate) fn problem(files: &[(SourceId, &str)], bound: Option<u32>) -> Parse<String> {
    let mut task = Task::default();
    for (source, text) in files {
        task.add(*source, text)?;
    }
    let end = files.first().map_or(Span::new(SourceId(0), 0..0), |(source, _)| Span::new(*source, 0..0));
    let goal = task.complete(end)?.clone();
    let Some(bound) = bound else {
        return wrong("unbounded-operator", goal.span, "how many steps a plan may have is not said");
    };
    let mut grounder = Grounder::new(&task)?;
    let goal = grounder.condition(&goal, &indexmap::IndexMap::new())?;
    let mut actions: Vec<Ground> = Vec::new();
    for action in &task.actions {
        actions.extend(grounder.action(action)?);
    }
    let mut init = Vec::new();
    let mut open = BTreeSet::new();
    for item in &task.init {
        init.extend(uncertain(&mut grounder, item, &mut open)?);
    }
    let writer = Writer::new(&grounder, &goal, &actions, &init, open);
    Ok(writer.write(&task, &goal, &actions, &init, bound))
}

/// What an item of `:init` says of facts that are not known at first.
fn uncertain(grounder: &mut Grounder<'_>, item: &Node, open: &mut BTreeSet<usize>) -> Parse<Vec<Cond>> {
    let (word, parts) = item.headed()?;
    if !matches!(word, "oneof" | "or" | "unknown") {
        return Ok(Vec::new());
    }
    let none = indexmap::IndexMap::new();
    let parts = parts.iter().map(|part| grounder.condition(part, &none)).collect::<Parse<Vec<Cond>>>()?;
    parts.iter().for_each(|part| part.facts(open));
    if word == "unknown" {
        return Ok(Vec::new());
    }
    let mut said = vec![Cond::all(parts.clone(), false)];
    if word == "oneof" {
        if parts.len() > MAX_ALTERNATIVES {
            return wrong("too-large", item.span, format!("more than {MAX_ALTERNATIVES} alternatives"));
        }
        for (at, one) in parts.iter().enumerate() {
            said.extend(
                parts[..at].iter().map(|other| Cond::all(vec![one.clone(), other.clone()], true).not()),
            );
        }
    }
    Ok(said)
}

struct Writer<'g, 't> {
    grounder: &'g Grounder<'t>,
    /// The facts that something reads.
    read: BTreeSet<usize>,
    /// Facts that are not known at first.
    open: BTreeSet<usize>,
    /// Of facts.
    variables: Vec<String>,
}

impl<'g, 't> Writer<'g, 't> {
    fn new(
        grounder: &'g Grounder<'t>,
        goal: &Cond,
        actions: &[Ground],
        init: &[Cond],
        open: BTreeSet<usize>,
    ) -> Self {
        let mut read = BTreeSet::new();
        goal.facts(&mut read);
        init.iter().for_each(|said| said.facts(&mut read));
        for action in actions {
            action.condition.facts(&mut read);
            action.outcomes.iter().flatten().for_each(|change| change.when.facts(&mut read));
        }
        let mut names = Names::default();
        // What is called so is ours.
        let own = ["failed", "goal"].map(|name| names.name(name));
        debug_assert_eq!(own, ["failed", "goal"]);
        let variables = grounder.facts.iter().map(|atom| names.name(&atom.join("_"))).collect();
        Writer { grounder, read, open, variables }
    }

    fn write(&self, task: &Task, goal: &Cond, actions: &[Ground], init: &[Cond], bound: u32) -> String {
        let name = task.name.as_ref().map_or("task", |(name, _)| name.as_str());
        let mut systems = Names::default();
        let [plan, system] = ["plan", name].map(|name| systems.name(name));
        let mut text = format!("system {system} {{\n");
        for fact in &self.read {
            let _ = writeln!(text, "state {}: bool;", self.variables[*fact]);
        }
        text += "state failed: bool;\n";
        let mut given = Names::default();
        let called: Vec<String> = actions.iter().map(|action| given.name(&action.name)).collect();
        let wait = given.name("wait");
        let mut list = called.clone();
        list.push(wait.clone());
        let _ = writeln!(text, "action {};", list.join(", "));
        let _ = writeln!(text, "label goal = {} & !failed;", self.shown(goal));
        text += "init !failed;\n";
        for fact in self.read.difference(&self.open) {
            let sign = if self.grounder.is_initial(*fact) { "" } else { "!" };
            let _ = writeln!(text, "init {sign}{};", self.variables[*fact]);
        }
        for said in init {
            let _ = writeln!(text, "init {};", self.shown(said));
        }
        for (action, called) in actions.iter().zip(&called) {
            self.action(&mut text, action, called);
        }
        let _ = writeln!(text, "on {wait} {{ }}\n}}");
        let (declared, taken) = (list.join(", "), list.join(" | "));
        let _ = writeln!(
            text,
            "system {plan} {{ action {declared}; on {taken} {{ }} }}
             objective conformant within {bound} {{
               exists p: {plan}. forall q: {system}. (G action[q] == action[p]) -> F[{bound},{bound}] goal[q]
             }}"
        );
        text
    }

    fn action(&self, text: &mut String, action: &Ground, called: &str) {
        let possible = match &action.condition {
            Cond::Const(true) => String::new(),
            condition => format!(" & {}", self.shown(condition)),
        };
        let mut written: Vec<String> = Vec::new();
        for outcome in &action.outcomes {
            let updates = self.updates(outcome);
            if !written.contains(&updates) {
                let _ = writeln!(text, "on {called} when !failed{possible} {{ {updates}}}");
                written.push(updates);
            }
        }
        let impossible = match action.condition.clone().not() {
            Cond::Const(false) => String::new(),
            condition => format!(" | {}", self.shown(&condition)),
        };
        let _ = writeln!(text, "on {called} when failed{impossible} {{ failed' = true; }}");
    }

    /// What is added is true, even if it is deleted too.
    fn updates(&self, outcome: &[Change]) -> String {
        let mut text = String::new();
        let facts: BTreeSet<usize> = outcome.iter().map(|change| change.fact).collect();
        for fact in facts.intersection(&self.read) {
            let of = |to: bool| {
                let own = outcome.iter().filter(|change| change.fact == *fact && change.to == to);
                Cond::all(own.map(|change| change.when.clone()).collect(), false)
            };
            let keeps = Cond::all(vec![Cond::Fact(*fact), of(false).not()], true);
            let value = Cond::all(vec![of(true), keeps], false);
            let _ = write!(text, "{}' = {}; ", self.variables[*fact], self.shown(&value));
        }
        text
    }

    /// A condition, in parentheses where it has parts. Recursion is bounded by the nesting of lists.
    fn shown(&self, condition: &Cond) -> String {
        let joined = |parts: &[Cond], sign: &str| {
            format!("({})", parts.iter().map(|part| self.shown(part)).collect::<Vec<_>>().join(sign))
        };
        match condition {
            Cond::Const(value) => value.to_string(),
            Cond::Fact(fact) => self.variables[*fact].clone(),
            Cond::Not(inner) => format!("!{}", self.shown(inner)),
            Cond::And(parts) => joined(parts, " & "),
            Cond::Or(parts) => joined(parts, " | "),
        }
    }
}
