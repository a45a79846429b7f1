//! Random problems over several systems whose variables are of different types. Each can be written in two ways: with
//! ranges, or with `int` and `real` for the same few values.

use crate::random::Random;
use std::fmt::Write as _;

/// A problem: its systems with the paths that range over them, and a formula.
#[derive(Clone, Debug)]
pub struct Mixed {
    systems: Vec<System>,
    /// Whether each path exists, and its system.
    paths: Vec<(bool, usize)>,
    formula: String,
}

#[derive(Clone, Debug)]
struct System {
    /// The largest value of its number `x`, if it has one, and the type without bounds.
    number: Option<(usize, &'static str)>,
    /// Whether it has a truth value `b`.
    truth: bool,
    /// For each action what becomes of the variables.
    actions: Vec<String>,
    init: String,
}

/// How far formulas look.
const HORIZON: u32 = 2;
const PATHS: [&str; 3] = ["p", "q", "r"];

impl Mixed {
    /// A problem whose quantifiers alternate, often of this shape: the leading path has truth values only, and what it has
    /// to do depends on the numbers of others.
    #[must_use]
    pub fn alternating(random: &mut Random) -> Mixed {
        let (count, first) = (2 + random.below(2), random.flip());
        let alternating = |count| (0..count).map(|path| first == (path % 2 == 0));
        if random.flip() {
            return Mixed::with(random, alternating(count).collect(), HORIZON);
        }
        let systems = vec![system(random, false), system(random, true), system(random, true)];
        let paths = alternating(3).zip([0, 1, 1 + random.below(2)]).collect();
        let (operator, connective) = (random.one(&["F", "G"]), random.one(&["&", "|", "<->"]));
        let (lo, relation) = (random.bound(HORIZON + 1), random.one(&["==", "<", ">=", "!="]));
        let formula = format!("{operator}[{lo},{HORIZON}] (b[p] {connective} x[q] {relation} x[r])");
        Mixed { systems, paths, formula }
    }

    /// A problem that asks for one or two paths, perhaps at time 0 only.
    #[must_use]
    pub fn existential(random: &mut Random) -> Mixed {
        let (count, look) = (1 + random.below(2), random.bound(HORIZON + 1));
        Mixed::with(random, vec![true; count], look)
    }

    fn with(random: &mut Random, exists: Vec<bool>, look: u32) -> Mixed {
        let numbers: Vec<bool> = (0..1 + random.below(3)).map(|_| random.flip()).collect();
        let systems: Vec<System> = numbers.into_iter().map(|number| system(random, number)).collect();
        let paths = exists.into_iter().map(|exists| (exists, random.below(systems.len()))).collect();
        let mut mixed = Mixed { systems, paths, formula: String::new() };
        mixed.formula = mixed.formula(random, 3, look);
        mixed
    }

    /// The problem with `int` and `real` for its numbers, or with ranges.
    #[must_use]
    pub fn text(&self, bounded: bool) -> String {
        let mut text = String::new();
        for (at, System { number, truth, actions, init }) in self.systems.iter().enumerate() {
            let number = number.map(|(most, unbounded)| match bounded {
                true => format!("x: 0..{most}"),
                false => format!("x: {unbounded}"),
            });
            let state: Vec<String> = number.into_iter().chain(truth.then(|| "b: bool".to_owned())).collect();
            let names: Vec<String> = (0..actions.len()).map(|action| format!("a{action}")).collect();
            // Writing to a string cannot fail.
            let _ = write!(text, "system S{at} {{ state {}; action {};", state.join(", "), names.join(", "));
            for (name, updates) in names.iter().zip(actions) {
                let _ = write!(text, " on {name} {{ {updates} }}");
            }
            let _ = writeln!(text, " init {init}; }}");
        }
        text += "objective o { ";
        for (name, (exists, system)) in PATHS.iter().zip(&self.paths) {
            let quantifier = if *exists { "exists" } else { "forall" };
            let _ = write!(text, "{quantifier} {name}: S{system}. ");
        }
        text + &self.formula + " }\n"
    }

    /// Whether some number is an `int`.
    #[must_use]
    pub fn has_int(&self) -> bool {
        self.systems.iter().any(|system| system.number.is_some_and(|(_, unbounded)| unbounded == "int"))
    }

    fn formula(&self, random: &mut Random, depth: u32, look: u32) -> String {
        if depth == 0 {
            return self.atom(random);
        }
        let sub = |random: &mut Random, look| self.formula(random, depth - 1, look);
        let lo = random.bound(look + 1);
        match random.below(if look > 0 { 7 } else { 4 }) {
            0 => format!("!({})", sub(random, look)),
            1 | 2 => format!("({} & {})", sub(random, look), sub(random, look)),
            3 => format!("({} | {})", sub(random, look), sub(random, look)),
            4 => format!("X ({})", sub(random, look - 1)),
            5 => format!("F[{lo},{look}] ({})", sub(random, 0)),
            _ => format!("G[{lo},{look}] ({})", sub(random, 0)),
        }
    }

    fn atom(&self, random: &mut Random) -> String {
        let (p, count) = (random.below(self.paths.len()), self.paths.len());
        let q = (p + 1 + random.below(count.max(2) - 1)) % count;
        let [first, second] = [p, q].map(|path| &self.systems[self.paths[path].1]);
        let (p, q) = (PATHS[p], PATHS[q]);
        let both = first.number.is_some() && second.number.is_some() && p != q;
        match random.below(6) {
            0 | 1 if both => {
                let relation = random.one(&["==", "<", ">=", "!="]);
                format!("x[{p}] {relation} x[{q}] + {}", random.below(2))
            }
            2 if first.truth && second.truth && p != q => format!("(b[{p}] <-> b[{q}])"),
            0..=3 if let Some((most, _)) = first.number => {
                let relation = random.one(&["==", "<", ">="]);
                format!("x[{p}] {relation} {}", random.below(most + 1))
            }
            4 if first.actions.len() > 1 => format!("action[{p}] == a{}", random.below(first.actions.len())),
            _ if first.truth => format!("b[{p}]"),
            _ => format!("x[{p}] == 0"),
        }
    }
}

/// A system in which every action is possible in every state, and leads to one.
fn system(random: &mut Random, number: bool) -> System {
    let number = number.then(|| (1 + random.below(2), random.one(&["int", "real"])));
    let truth = number.is_none() || random.once_in(3);
    let actions = (0..1 + random.below(2)).map(|_| updates(random, number.map(|n| n.0), truth)).collect();
    let mut init = Vec::new();
    if let Some((most, _)) = number {
        let some = if random.flip() { vec![random.below(most + 1)] } else { (0..=most).collect() };
        let some: Vec<String> = some.into_iter().map(|value| format!("x == {value}")).collect();
        init.push(format!("({})", some.join(" | ")));
    }
    if truth && random.flip() {
        init.push("!b".to_owned());
    }
    let init = if init.is_empty() { "true".to_owned() } else { init.join(" & ") };
    System { number, truth, actions, init }
}

fn updates(random: &mut Random, most: Option<usize>, truth: bool) -> String {
    let mut updates = String::new();
    if let Some(most) = most {
        let (one, other) = (random.below(most + 1), random.below(most + 1));
        updates += &match random.below(6) {
            0 => String::new(),
            1 => format!("x' = {one}; "),
            2 => format!("x' = {most} - x; "),
            3 => format!("x' in {{{one}, {other}}}; "),
            4 if truth => format!("x' = if b then {one} else x; "),
            _ => format!("x' = if x < {most} then x + 1 else {one}; "),
        };
    }
    if truth {
        updates += match random.below(if most.is_some() { 5 } else { 4 }) {
            0 => "",
            1 => "b' = true;",
            2 => "b' = !b;",
            3 => "b' in {true, b};",
            _ => "b' = x == 0;",
        };
    }
    updates
}
