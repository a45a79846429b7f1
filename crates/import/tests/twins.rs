//! Random models: what they mean by an evaluator that knows nothing of the problem language, and what their import
//! means, itself and printed as a problem file.

use hyperplan_import::{Input, Options, import};
use hyperplan_problem::{NoFiles, Overrides, System, SystemId, lower, read};
use hyperplan_random::{Random, property};
use hyperplan_space::Graph;
use hyperplan_syntax::{SourceMap, print};
use std::cell::Cell;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// The variables: how they are declared, and their values as numbers.
const VARS: [(&str, &str, i64, i64); 5] = [
    ("b", "boolean", 0, 1),
    ("x", "0..2", 0, 2),
    ("y", "-1..2", -1, 2),
    ("w", "unsigned word[2]", 0, 3),
    ("e", "{red, green, 7}", 0, 2),
];
const SYMBOLS: [&str; 3] = ["red", "green", "7"];

type State = Vec<i64>;

enum Truth {
    Constant(bool),
    B(bool),
    Less(Number, Number),
    Equal(Number, Number),
    Symbol(usize, bool),
    Word(i64, bool),
    Among(Number, Vec<i64>),
    Not(Box<Truth>),
    Many(&'static str, Vec<Truth>),
    Two(&'static str, Box<Truth>, Box<Truth>),
    Defined,
}

enum Number {
    Constant(i64),
    Read(usize, bool),
    Sum(Box<Number>, bool, Box<Number>),
    Times(Box<Number>, Box<Number>),
    Divided(Box<Number>, bool, i64),
    Case(Vec<(Truth, Number)>, Box<Number>),
    Defined,
}

/// What definitions stand for.
struct Defines {
    truth: Truth,
    number: Number,
}

/// Conditions with the values that they allow.
type Branches = Vec<(Truth, Vec<Value>)>;

struct Model {
    defines: Defines,
    /// For each variable: conditions with the values that they allow; none: any value.
    next: Vec<Option<Branches>>,
    init: Vec<Truth>,
    invar: Vec<Truth>,
    trans: Vec<Truth>,
}

enum Value {
    Number(Number),
    Truth(Truth),
    Symbol(usize),
    /// `w + n`, in two bits.
    Word(i64),
}

/// Both ends of a step; before it, of a state alone.
struct At<'a>(&'a State, &'a State, &'a Defines);

impl Truth {
    fn holds(&self, at: &At<'_>) -> bool {
        match self {
            Truth::Constant(b) => *b,
            Truth::B(next) => at.read(0, *next) == 1,
            Truth::Less(a, b) => a.value(at) < b.value(at),
            Truth::Equal(a, b) => a.value(at) == b.value(at),
            Truth::Symbol(symbol, next) => at.read(4, *next) == *symbol as i64,
            Truth::Word(n, next) => at.read(3, *next) >= *n,
            Truth::Among(a, set) => set.contains(&a.value(at)),
            Truth::Not(a) => !a.holds(at),
            Truth::Many("&", all) => all.iter().all(|a| a.holds(at)),
            Truth::Many(_, all) => all.iter().any(|a| a.holds(at)),
            Truth::Two("->", a, b) => !a.holds(at) || b.holds(at),
            Truth::Two("<->", a, b) => a.holds(at) == b.holds(at),
            Truth::Two(_, a, b) => a.holds(at) != b.holds(at),
            Truth::Defined => at.2.truth.holds(at),
        }
    }

    fn show(&self) -> String {
        let mark = |name: &str, next: &bool| if *next { format!("next({name})") } else { name.to_owned() };
        match self {
            Truth::Constant(b) => if *b { "TRUE" } else { "FALSE" }.to_owned(),
            Truth::B(next) => mark("b", next),
            Truth::Less(a, b) => format!("({} < {})", a.show(), b.show()),
            Truth::Equal(a, b) => format!("({} = {})", a.show(), b.show()),
            Truth::Symbol(symbol, next) => format!("({} = {})", mark("e", next), SYMBOLS[*symbol]),
            Truth::Word(n, next) => format!("({} >= 0ud2_{n})", mark("w", next)),
            Truth::Among(a, set) => {
                let set: Vec<String> = set.iter().map(i64::to_string).collect();
                format!("({} in {{{}}})", a.show(), set.join(", "))
            }
            Truth::Not(a) => format!("!{}", a.show()),
            Truth::Many(sign, all) => {
                let all: Vec<String> = all.iter().map(Truth::show).collect();
                format!("({})", all.join(&format!(" {sign} ")))
            }
            Truth::Two(sign, a, b) => format!("({} {sign} {})", a.show(), b.show()),
            Truth::Defined => "d".to_owned(),
        }
    }

    fn random(random: &mut Random, depth: usize, scope: Scope) -> Truth {
        let next = scope.next && random.flip();
        if depth == 0 {
            return match random.below(7) {
                0 => Truth::Constant(random.flip()),
                1 | 2 => Truth::B(next),
                3 => Truth::Symbol(random.below(3), next),
                4 => Truth::Word(1 + random.below(3) as i64, next),
                5 if scope.defined => Truth::Defined,
                _ => Truth::Less(Number::random(random, 0, scope), Number::random(random, 0, scope)),
            };
        }
        let sub = |random: &mut Random| Truth::random(random, depth - 1, scope);
        match random.below(8) {
            0 => Truth::Not(Box::new(sub(random))),
            1 => Truth::Many("&", (0..2 + random.below(2)).map(|_| sub(random)).collect()),
            2 => Truth::Many("|", (0..2 + random.below(2)).map(|_| sub(random)).collect()),
            3 => {
                let sign = random.one(&["->", "<->", "xor"]);
                let sign = ["->", "<->", "xor"].into_iter().find(|s| *s == sign).unwrap_or("->");
                Truth::Two(sign, Box::new(sub(random)), Box::new(sub(random)))
            }
            4 => Truth::Among(Number::random(random, depth - 1, scope), vec![0, random.below(3) as i64 + 1]),
            5 => Truth::Equal(Number::random(random, depth, scope), Number::random(random, depth - 1, scope)),
            6 => Truth::Less(Number::random(random, depth, scope), Number::random(random, depth - 1, scope)),
            _ => sub(random),
        }
    }
}

/// What may be read.
#[derive(Clone, Copy)]
struct Scope {
    next: bool,
    defined: bool,
}

impl At<'_> {
    fn read(&self, var: usize, next: bool) -> i64 {
        if next { self.1[var] } else { self.0[var] }
    }
}

impl Number {
    fn value(&self, at: &At<'_>) -> i64 {
        match self {
            Number::Constant(n) => *n,
            Number::Read(var, next) => at.read(*var, *next),
            Number::Sum(a, minus, b) => a.value(at) + if *minus { -b.value(at) } else { b.value(at) },
            Number::Times(a, b) => a.value(at) * b.value(at),
            // NuSMV rounds as C does.
            Number::Divided(a, false, by) => a.value(at) / by,
            Number::Divided(a, true, by) => a.value(at) % by,
            Number::Case(branches, last) => {
                branches.iter().find(|(c, _)| c.holds(at)).map_or(&**last, |(_, n)| n).value(at)
            }
            Number::Defined => at.2.number.value(at),
        }
    }

    fn show(&self) -> String {
        match self {
            Number::Constant(n) => n.to_string(),
            Number::Read(var, true) => format!("next({})", VARS[*var].0),
            Number::Read(var, false) => VARS[*var].0.to_owned(),
            Number::Sum(a, minus, b) => {
                format!("({} {} {})", a.show(), if *minus { "-" } else { "+" }, b.show())
            }
            Number::Times(a, b) => format!("({} * {})", a.show(), b.show()),
            Number::Divided(a, remainder, by) => {
                format!("({} {} {by})", a.show(), if *remainder { "mod" } else { "/" })
            }
            Number::Case(branches, last) => {
                let branches: Vec<String> =
                    branches.iter().map(|(c, n)| format!("{} : {};", c.show(), n.show())).collect();
                format!("case {} TRUE : {}; esac", branches.join(" "), last.show())
            }
            Number::Defined => "n".to_owned(),
        }
    }

    fn random(random: &mut Random, depth: usize, scope: Scope) -> Number {
        let next = scope.next && random.flip();
        if depth == 0 {
            return match random.below(5) {
                0 => Number::Constant(random.below(4) as i64),
                1 if scope.defined => Number::Defined,
                1 | 2 => Number::Read(1, next),
                _ => Number::Read(2, next),
            };
        }
        let sub = |random: &mut Random| Box::new(Number::random(random, depth - 1, scope));
        match random.below(6) {
            0 | 1 => Number::Sum(sub(random), random.flip(), sub(random)),
            2 => Number::Times(sub(random), sub(random)),
            3 => {
                let by = [2, 3, -2][random.below(3)];
                Number::Divided(sub(random), random.flip(), by)
            }
            4 => {
                let branches = (0..1 + random.below(2))
                    .map(|_| (Truth::random(random, depth - 1, scope), *sub(random)))
                    .collect();
                Number::Case(branches, sub(random))
            }
            _ => *sub(random),
        }
    }
}

impl Value {
    /// The value, or none where it is none of the variable's.
    fn of(&self, at: &At<'_>) -> i64 {
        match self {
            Value::Number(n) => n.value(at),
            Value::Truth(t) => i64::from(t.holds(at)),
            Value::Symbol(symbol) => *symbol as i64,
            Value::Word(n) => (at.read(3, false) + n).rem_euclid(4),
        }
    }

    fn show(&self) -> String {
        match self {
            Value::Number(n) => n.show(),
            Value::Truth(t) => t.show(),
            Value::Symbol(symbol) => SYMBOLS[*symbol].to_owned(),
            Value::Word(n) => format!("w + 0ud2_{n}"),
        }
    }

    fn random(random: &mut Random, var: usize) -> Value {
        let scope = Scope { next: false, defined: true };
        match var {
            0 => Value::Truth(Truth::random(random, 1, scope)),
            1 | 2 => Value::Number(Number::random(random, 1, scope)),
            3 => Value::Word(random.below(4) as i64),
            _ => Value::Symbol(random.below(3)),
        }
    }
}

impl Model {
    fn random(random: &mut Random) -> Model {
        let plain = Scope { next: false, defined: false };
        let defined = Scope { next: false, defined: true };
        let step = Scope { next: true, defined: true };
        let next = (0..VARS.len())
            .map(|var| {
                (!random.once_in(5)).then(|| {
                    let values = |random: &mut Random| {
                        (0..1 + random.below(2)).map(|_| Value::random(random, var)).collect::<Vec<_>>()
                    };
                    let mut all: Vec<_> = (0..random.below(3))
                        .map(|_| (Truth::random(random, 1, defined), values(random)))
                        .collect();
                    all.push((Truth::Constant(true), values(random)));
                    all
                })
            })
            .collect();
        let some = |random: &mut Random, scope, once_in| {
            let count = usize::from(random.once_in(once_in));
            (0..count).map(|_| Truth::random(random, 1, scope)).collect::<Vec<_>>()
        };
        Model {
            defines: Defines {
                truth: Truth::random(random, 1, plain),
                number: Number::random(random, 1, plain),
            },
            next,
            init: some(random, defined, 2),
            invar: some(random, defined, 4),
            trans: some(random, step, 3),
        }
    }

    fn show(&self) -> String {
        let mut text = "MODULE main -- a random one\nVAR\n".to_owned();
        for (name, ty, ..) in VARS {
            let _ = writeln!(text, "  {name} : {ty};");
        }
        let Defines { truth, number } = &self.defines;
        let _ = writeln!(text, "DEFINE\n  d := {};\n  n := {};\nASSIGN", truth.show(), number.show());
        for (next, (name, ..)) in self.next.iter().zip(VARS) {
            let Some(branches) = next else { continue };
            let shown: Vec<String> = branches
                .iter()
                .map(|(condition, values)| {
                    let values: Vec<String> = values.iter().map(Value::show).collect();
                    format!("{} : {{{}}};", condition.show(), values.join(", "))
                })
                .collect();
            let _ = writeln!(text, "  next({name}) := case {} esac;", shown.join(" "));
        }
        for (section, all) in [("INIT", &self.init), ("INVAR", &self.invar), ("TRANS", &self.trans)] {
            for said in all {
                let _ = writeln!(text, "{section} {}", said.show());
            }
        }
        text
    }

    fn is_state(&self, state: &State) -> bool {
        self.invar.iter().all(|said| said.holds(&At(state, state, &self.defines)))
    }

    fn starts(&self) -> BTreeSet<State> {
        let all = all_states().into_iter().filter(|state| {
            self.is_state(state) && self.init.iter().all(|said| said.holds(&At(state, state, &self.defines)))
        });
        all.collect()
    }

    fn is_step(&self, from: &State, to: &State) -> bool {
        let at = At(from, to, &self.defines);
        let allowed = |(var, next): (usize, &Option<Branches>)| {
            next.as_ref().is_none_or(|branches| {
                let branch = branches.iter().find(|(condition, _)| condition.holds(&at));
                branch.is_some_and(|(_, values)| values.iter().any(|value| value.of(&at) == to[var]))
            })
        };
        self.is_state(to)
            && self.next.iter().enumerate().all(allowed)
            && self.trans.iter().all(|said| said.holds(&at))
    }
}

fn all_states() -> Vec<State> {
    VARS.iter().fold(vec![Vec::new()], |states, (_, _, lo, hi)| {
        states
            .iter()
            .flat_map(|state: &State| (*lo..=*hi).map(move |n| [state.as_slice(), &[n]].concat()))
            .collect()
    })
}

/// Starts, and steps from all that can be reached, as the graph of a system has them.
type Meaning = (BTreeSet<State>, BTreeSet<(State, State)>);

fn meaning(system: &System) -> Meaning {
    let graph = Graph::explore(system, 10_000).expect("it is small");
    let state = |at: u32| graph.codes(at).to_vec();
    let starts = graph.initial.iter().map(|&at| state(at)).collect();
    let steps = (0..graph.len() as u32)
        .flat_map(|from| graph.successors(from).iter().map(move |&(_, to)| (from, to)))
        .map(|(from, to)| (state(from), state(to)));
    (starts, steps.collect())
}

#[test]
fn random_models_mean_what_they_say() {
    let all = all_states();
    let long = Cell::new(0);
    property(1500, 400, |random| {
        let model = Model::random(random);
        let text = model.show();
        let mut sources = SourceMap::new();
        let input = Input { name: "m.smv".to_owned(), text: text.clone() };
        let imported = import(&[input], &Options::default(), &mut sources);
        assert!(imported.diagnostics.is_empty(), "{text}\n{:#?}", imported.diagnostics);
        let lowered = lower(&imported.file, &mut sources, &NoFiles, &Overrides::default());
        assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
        let found = meaning(&lowered.problem.systems[SystemId(0)]);

        let starts = model.starts();
        let mut steps = BTreeSet::new();
        let mut open: Vec<State> = starts.iter().cloned().collect();
        let mut seen = starts.clone();
        while let Some(from) = open.pop() {
            for to in all.iter().filter(|to| model.is_step(&from, to)) {
                steps.insert((from.clone(), to.clone()));
                if seen.insert(to.clone()) {
                    open.push(to.clone());
                }
            }
        }
        long.set(long.get() + usize::from(steps.len() > 20));
        assert_eq!(found, (starts, steps), "{text}");

        let printed = print(&imported.file, "");
        let again = read(&mut SourceMap::new(), "m.hp", &printed, &NoFiles, &Overrides::default());
        assert!(!again.has_errors(), "{printed}\n{:#?}", again.diagnostics);
        assert_eq!(meaning(&again.problem.systems[SystemId(0)]), found, "{printed}");
    });
    assert!(long.get() > 300, "{} models have more than a few steps", long.get());
}
