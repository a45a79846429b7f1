//! Expressions whose types fit, over the states of a system or over paths.

use super::system::{Kind, System};
use hyperplan_random::Random;

/// A system's state, or a path, of which an expression may speak.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scope<'a> {
    system: &'a System,
    /// The path variable; empty where a state is meant.
    pub(super) path: &'a str,
}

impl<'a> Scope<'a> {
    pub(super) fn of_state(system: &'a System) -> Self {
        Scope { system, path: "" }
    }

    pub(super) fn of_path(system: &'a System, path: &'a str) -> Self {
        Scope { system, path }
    }

    /// Whether steps cost something.
    pub(super) fn costs(&self) -> bool {
        self.system.costs
    }

    /// A label or a variable.
    fn at(&self, name: &str) -> String {
        if self.path.is_empty() { name.to_owned() } else { format!("{name}[{}]", self.path) }
    }

    /// The variables of a kind.
    fn vars(&self, is: fn(&Kind) -> bool) -> Vec<&'a (String, Kind)> {
        self.system.vars.iter().filter(|(_, kind)| is(kind)).collect()
    }

    fn action(&self, random: &mut Random) -> &'a str {
        &self.system.actions[random.below(self.system.actions.len())]
    }
}

fn some<'s, 'a>(random: &mut Random, scopes: &'s [Scope<'a>]) -> &'s Scope<'a> {
    &scopes[random.below(scopes.len())]
}

/// A formula that looks at most so many steps ahead at each operator; without a number, bounds may be left out.
pub(super) fn formula(
    random: &mut Random,
    scopes: &[Scope<'_>],
    depth: usize,
    look: Option<usize>,
) -> String {
    if depth == 0 || random.once_in(6) {
        return atom(random, scopes);
    }
    let part = |random: &mut Random| formula(random, scopes, depth - 1, look);
    match random.below(12) {
        0 => format!("!{}", part(random)),
        1 | 2 => connected(random, part),
        3 => format!("(if {} then {} else {})", atom(random, scopes), part(random), part(random)),
        4 => format!("({} {})", random.one(&["X", "N"]), part(random)),
        5..=8 => format!("({}{} {})", random.one(&["F", "G"]), interval(random, look), part(random)),
        _ => {
            let (f, g) = (part(random), part(random));
            format!("({f} {}{} {g})", random.one(&["U", "R", "W", "M"]), interval(random, look))
        }
    }
}

/// Several parts, joined.
fn connected(random: &mut Random, mut part: impl FnMut(&mut Random) -> String) -> String {
    let sign = random.one(&["&", "|", "->", "<->"]);
    let parts: Vec<String> = (0..2 + random.below(2)).map(|_| part(random)).collect();
    format!("({})", parts.join(&format!(" {sign} ")))
}

fn interval(random: &mut Random, look: Option<usize>) -> String {
    let last = look.unwrap_or(3);
    match random.below(if look.is_none() { 5 } else { 4 }) {
        0 => format!("[{last}]"),
        1 if last > 1 => "[1,T]".to_owned(),
        2 => format!("[{},{last}]", random.below(last + 1)),
        4 => String::new(),
        _ => format!("[0,{last}]"),
    }
}

/// What paths do, or something of their states.
fn atom(random: &mut Random, scopes: &[Scope<'_>]) -> String {
    let (p, q) = (*some(random, scopes), *some(random, scopes));
    let (a, b) = (p.path, q.path);
    let alike = p.system.number == q.system.number;
    match random.below(12) {
        0 => format!("action[{a}] == {}", p.action(random)),
        1 => format!("action[{a}] {} action[{b}]", random.one(&["==", "!="])),
        2 => format!("action[{a}] in {{none, {}}}", p.action(random)),
        3 if alike => format!("state[{a}] == state[{b}]"),
        4 if alike && p.system.observes => format!("obs[{a}] == obs[{b}]"),
        5 => format!("{} in enabled[{a}]", p.action(random)),
        6 if alike && p.system.defined => format!("d{}({a}, {b})", p.system.number),
        7 if !p.vars(Kind::is_number).is_empty() => {
            let taken = format!("(if action[{a}] == {} then 1 else 0)", p.action(random));
            format!("{} == {taken}", quantity(random, &[p], 0))
        }
        _ => proposition(random, scopes, 1),
    }
}

/// A condition on states.
pub(super) fn proposition(random: &mut Random, scopes: &[Scope<'_>], depth: usize) -> String {
    if depth > 0 && !random.once_in(3) {
        let part = |random: &mut Random| proposition(random, scopes, depth - 1);
        return match random.below(4) {
            0 => format!("!({})", part(random)),
            1 => format!("(if {} then {} else {})", part(random), part(random), part(random)),
            _ => connected(random, part),
        };
    }
    let scope = *some(random, scopes);
    let (bools, numbers) = (scope.vars(|kind| *kind == Kind::Bool), scope.vars(Kind::is_number));
    let enums = scope.vars(|kind| matches!(kind, Kind::Enum(_)));
    match random.below(8) {
        0 | 1 if !scope.system.labels.is_empty() => {
            scope.at(&scope.system.labels[random.below(scope.system.labels.len())])
        }
        2 if !bools.is_empty() => scope.at(&bools[random.below(bools.len())].0),
        3 if !enums.is_empty() => {
            let (name, kind) = enums[random.below(enums.len())];
            let Kind::Enum(values) = kind else { unreachable!("only those were chosen") };
            let value = &values[random.below(values.len())];
            match random.below(3) {
                0 => format!("{} in {{{value}, {}}}", scope.at(name), values[0]),
                1 => format!("{} != {value}", scope.at(name)),
                _ => format!("{} == {value}", scope.at(name)),
            }
        }
        4 if !numbers.is_empty() && !numbers.iter().any(|(_, kind)| *kind == Kind::Real) => {
            let name = scope.at(&numbers[random.below(numbers.len())].0);
            format!("{name} in {}", range(random, scopes))
        }
        5 => random.one(&["true", "false"]).to_owned(),
        _ => {
            let (left, right) = (quantity(random, scopes, 1), quantity(random, scopes, 1));
            format!("{left} {} {right}", random.one(&["==", "!=", "<", "<=", ">", ">="]))
        }
    }
}

/// A number.
pub(super) fn quantity(random: &mut Random, scopes: &[Scope<'_>], depth: usize) -> String {
    if depth == 0 || random.once_in(3) {
        let scope = *some(random, scopes);
        let numbers = scope.vars(Kind::is_number);
        return if numbers.is_empty() || random.once_in(4) {
            random.one(&["0", "1", "2", "T", "D"]).to_owned()
        } else {
            scope.at(&numbers[random.below(numbers.len())].0)
        };
    }
    let (a, b) = (quantity(random, scopes, depth - 1), quantity(random, scopes, depth - 1));
    let is_real = scopes.iter().any(|scope| !scope.vars(|kind| *kind == Kind::Real).is_empty());
    match random.below(8) {
        0 | 1 => format!("({a} + 1)"),
        2 => format!("({a} - {b})"),
        3 => format!("({a} + {b})"),
        4 => format!("({a} * 2)"),
        5 if is_real => format!("({a} / 2)"),
        5 => format!("({a} {} 2)", random.one(&["div", "%"])),
        6 => format!("(if {} then {a} else {b})", proposition(random, scopes, 0)),
        _ => format!("(-{a})"),
    }
}

/// A set of integers.
pub(super) fn range(random: &mut Random, scopes: &[Scope<'_>]) -> String {
    match random.below(3) {
        0 => "0..1".to_owned(),
        1 => format!("{{{}, 1}}", quantity(random, scopes, 0)),
        _ => "{0, T}".to_owned(),
    }
}
