//! Random circuits, systems and programs: what they mean by an interpreter of their own, and what their import means.

use hyperplan_import::{Input, Options, ascii, import};
use hyperplan_problem::{NoFiles, Overrides, System, SystemId, lower};
use hyperplan_random::{Random, property};
use hyperplan_space::{Graph, holds_in};
use hyperplan_syntax::SourceMap;
use std::cell::Cell;
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// A sequence of what can be seen of each state.
type Seen = Vec<Vec<i64>>;

fn system(name: &str, text: &str) -> System {
    let mut sources = SourceMap::new();
    let input = Input { name: name.to_owned(), text: text.to_owned() };
    let imported = import(&[input], &Options::default(), &mut sources);
    assert!(imported.diagnostics.is_empty(), "{text}\n{:#?}", imported.diagnostics);
    let lowered = lower(&imported.file, &mut sources, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
    lowered.problem.systems[SystemId(0)].clone()
}

/// What paths of some steps look like, of the first so many variables.
fn seen(system: &System, visible: usize, steps: usize) -> BTreeSet<Seen> {
    let graph = Graph::explore(system, 100_000).expect("it is small");
    let look = |at: u32| graph.codes(at)[..visible].to_vec();
    let first = graph.initial.iter().map(|&at| (vec![look(at)], at));
    let mut all: BTreeSet<(Seen, u32)> = first.collect();
    for _ in 0..steps {
        let longer = all.iter().flat_map(|(seen, at)| {
            graph.successors(*at).iter().map(|&(_, to)| ([seen.as_slice(), &[look(to)]].concat(), to))
        });
        all = longer.collect();
    }
    all.into_iter().map(|(seen, _)| seen).collect()
}

/// Paths of an interpreter, by its first states and its steps.
fn interpreted<S: Clone + Ord>(
    first: Vec<S>,
    next: impl Fn(&S) -> Vec<S>,
    look: impl Fn(&S) -> Vec<i64>,
    steps: usize,
) -> BTreeSet<Seen> {
    let mut all: BTreeSet<(Seen, S)> = first.into_iter().map(|s| (vec![look(&s)], s)).collect();
    for _ in 0..steps {
        let longer = all.iter().flat_map(|(seen, state)| {
            next(state).into_iter().map(|to| ([seen.as_slice(), &[look(&to)]].concat(), to))
        });
        all = longer.collect();
    }
    all.into_iter().map(|(seen, _)| seen).collect()
}

/// A circuit with two inputs and three latches.
struct Circuit {
    gates: Vec<[u64; 2]>,
    /// The next value, and the first one; the literal itself for any.
    latches: [(u64, u64); 3],
}

const LEAVES: u64 = 5;

impl Circuit {
    fn random(random: &mut Random) -> Self {
        let mut gates: Vec<[u64; 2]> = Vec::new();
        for own in 0..2 + random.below(5) as u64 {
            let most = 2 * (LEAVES + own) + 2;
            let mut pair = [random.below(most as usize) as u64, random.below(most as usize) as u64];
            pair.sort_unstable_by(|a, b| b.cmp(a));
            gates.push(pair);
        }
        let most = 2 * (LEAVES as usize + gates.len()) + 2;
        let latches = [3, 4, 5].map(|variable| {
            let first = [0, 1, 2 * variable][random.below(3)];
            (random.below(most) as u64, first)
        });
        Circuit { gates, latches }
    }

    fn text(&self, binary: bool) -> Vec<u8> {
        let most = LEAVES as usize + self.gates.len();
        let kind = if binary { "aig" } else { "aag" };
        let mut text = format!("{kind} {most} 2 3 1 {}\n", self.gates.len()).into_bytes();
        let mut line = |words: String| text.extend((words + "\n").into_bytes());
        if !binary {
            line("2".to_owned());
            line("4".to_owned());
        }
        for (at, (next, first)) in self.latches.iter().enumerate() {
            let own = if binary { String::new() } else { format!("{} ", 2 * (at + 3)) };
            line(format!("{own}{next} {first}"));
        }
        line(format!("{}", 2 * most));
        for (at, [left, right]) in self.gates.iter().enumerate() {
            let own = 2 * (LEAVES + at as u64 + 1);
            if !binary {
                line(format!("{own} {left} {right}"));
            }
        }
        for (at, [left, right]) in self.gates.iter().enumerate().filter(|_| binary) {
            for mut less in [2 * (LEAVES + at as u64 + 1) - left, left - right] {
                while less >= 0x80 {
                    text.push((less & 0x7f) as u8 | 0x80);
                    less >>= 7;
                }
                text.push(less as u8);
            }
        }
        text.extend(b"i0 go\nc\nno more\n");
        text
    }

    /// The value of a literal where inputs and latches have these.
    fn value(&self, literal: u64, state: &[i64]) -> bool {
        let variable = (literal / 2) as usize;
        let value = match variable {
            0 => false,
            1..=5 => state[variable - 1] == 1,
            _ => self.gates[variable - 6].iter().all(|operand| self.value(*operand, state)),
        };
        value != (literal % 2 == 1)
    }

    fn with_inputs(latches: &[i64]) -> Vec<Vec<i64>> {
        (0..4).map(|bits| [&[bits & 1, bits >> 1], latches].concat()).collect()
    }
}

#[test]
fn circuits_of_both_forms_mean_what_they_say() {
    let many = Cell::new(0);
    property(400, 60, |random| {
        let circuit = Circuit::random(random);
        let text = String::from_utf8(circuit.text(false)).expect("it is text");
        let from_binary = ascii(&circuit.text(true)).expect("it is a circuit");
        assert_eq!(from_binary, text);
        let mut first = vec![Vec::new()];
        for (at, (_, begins)) in circuit.latches.iter().enumerate() {
            let free = *begins == 2 * (at as u64 + 3);
            let values = if free { vec![0, 1] } else { vec![*begins as i64] };
            first = first
                .iter()
                .flat_map(|f: &Vec<i64>| values.iter().map(move |v| [f.as_slice(), &[*v]].concat()))
                .collect();
        }
        let first = first.iter().flat_map(|latches| Circuit::with_inputs(latches)).collect();
        let next = |state: &Vec<i64>| {
            let latches: Vec<i64> =
                circuit.latches.iter().map(|(next, _)| i64::from(circuit.value(*next, state))).collect();
            Circuit::with_inputs(&latches)
        };
        let expected = interpreted(first, next, Clone::clone, 2);
        assert_eq!(seen(&system("c.aag", &text), 5, 2), expected, "{text}");
        many.set(many.get() + usize::from(expected.iter().any(|s| s[1][2..] != s[2][2..])));
    });
    assert!(many.get() > 100, "{} circuits move", many.get());
}

#[test]
fn explicit_systems_mean_what_they_say() {
    property(200, 60, |random| {
        let count = 1 + random.below(5);
        let numbers: Vec<usize> = (0..count).map(|at| 3 * at + random.below(3)).collect();
        let next: Vec<Vec<usize>> = (0..count).map(|_| subset(random, count)).collect();
        let holds: Vec<Vec<usize>> = (0..count).map(|_| random.subset(2, 2)).collect();
        let first = subset(random, count);
        let list =
            |all: &[usize]| all.iter().map(|at| numbers[*at].to_string()).collect::<Vec<_>>().join(" ");
        let mut text = format!("AP: \"a\" \"b\"\nInit: {}\n--BODY--\n", list(&first));
        for at in 0..count {
            let own: Vec<String> = holds[at].iter().map(ToString::to_string).collect();
            let _ = writeln!(text, "State: {} {{{}}}\n{}", numbers[at], own.join(" "), list(&next[at]));
        }
        text += "--END--\n";
        let expected = interpreted(first, |at| next[*at].clone(), |at| vec![numbers[*at] as i64], 4);
        let system = system("e.txt", &text);
        assert_eq!(seen(&system, 1, 4), expected, "{text}");
        let graph = Graph::explore(&system, 100).expect("it is small");
        for state in 0..graph.len() as u32 {
            let at = numbers.iter().position(|n| *n as i64 == graph.codes(state)[0]).expect("it is one");
            for (label, name) in ["a", "b"].iter().enumerate() {
                let own = system.labels.iter().find(|l| l.name == *name).expect("it is there");
                let value = holds_in(&system, &own.expr, &graph.state(&system, state));
                assert_eq!(value, Some(holds[at].contains(&label)), "{text}");
            }
        }
    });
}

/// Some of the first numbers, at least one.
fn subset(random: &mut Random, count: usize) -> Vec<usize> {
    let some = random.subset(count, 2);
    if some.is_empty() { vec![random.below(count)] } else { some }
}

/// A statement, as AutoHyper has them.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Statement {
    Ended,
    Skip,
    Assign(usize, Option<Bits>),
    If(Option<Bits>, Box<Statement>, Box<Statement>),
    While(Bits, Box<Statement>),
    Many(Vec<Statement>),
}

#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Bits {
    Read(usize),
    Bit(Box<Bits>, usize),
    Not(Box<Bits>),
    Two(bool, Box<Bits>, Box<Bits>),
    Joined(Box<Bits>, Box<Bits>),
    Twice(Box<Bits>),
}

/// The variables `a`, of one bit, and `b`, of two.
const WIDTHS: [usize; 2] = [1, 2];

impl Bits {
    fn random(random: &mut Random, width: usize, depth: u32) -> Bits {
        let sub = |random: &mut Random, width| Box::new(Bits::random(random, width, depth - 1));
        match random.below(if depth == 0 { 1 } else { 5 }) {
            1 => Bits::Not(sub(random, width)),
            2 => Bits::Two(random.flip(), sub(random, width), sub(random, width)),
            3 if width == 1 => Bits::Bit(sub(random, 2), random.below(2)),
            3 => Bits::Joined(sub(random, 1), sub(random, 1)),
            4 if width == 2 => Bits::Twice(sub(random, 1)),
            _ => Bits::Read(width - 1),
        }
    }

    fn show(&self) -> String {
        match self {
            Bits::Read(variable) => ["a", "b"][*variable].to_owned(),
            Bits::Bit(e, at) => format!("({}[{at}])", e.show()),
            Bits::Not(e) => format!("!{}", e.show()),
            Bits::Two(or, a, b) => format!("({} {} {})", a.show(), if *or { "|" } else { "&" }, b.show()),
            Bits::Joined(a, b) => format!("({} @ {})", a.show(), b.show()),
            Bits::Twice(e) => format!("(2 * {})", e.show()),
        }
    }

    fn value(&self, state: &[Vec<bool>; 2]) -> Vec<bool> {
        match self {
            Bits::Read(variable) => state[*variable].clone(),
            Bits::Bit(e, at) => vec![e.value(state)[*at]],
            Bits::Not(e) => e.value(state).iter().map(|bit| !bit).collect(),
            Bits::Two(or, a, b) => {
                let both = |(a, b): (bool, bool)| if *or { a || b } else { a && b };
                a.value(state).into_iter().zip(b.value(state)).map(both).collect()
            }
            Bits::Joined(a, b) => [a.value(state), b.value(state)].concat(),
            Bits::Twice(e) => [e.value(state), e.value(state)].concat(),
        }
    }
}

impl Statement {
    fn random(random: &mut Random, depth: u32) -> Statement {
        let sub = |random: &mut Random| {
            let many = 1 + random.below(3);
            let mut all: Vec<Statement> = (0..many).map(|_| Statement::random(random, depth - 1)).collect();
            Box::new(if many == 1 { all.remove(0) } else { Statement::Many(all) })
        };
        match random.below(if depth == 0 { 4 } else { 7 }) {
            0 => Statement::Skip,
            1 => Statement::Assign(random.below(2), None),
            4 => Statement::If(Some(Bits::random(random, 1, 2)), sub(random), sub(random)),
            5 => Statement::If(None, sub(random), sub(random)),
            6 => Statement::While(Bits::random(random, 1, 2), sub(random)),
            _ => {
                let variable = random.below(2);
                Statement::Assign(variable, Some(Bits::random(random, WIDTHS[variable], 2)))
            }
        }
    }

    fn show(&self) -> String {
        match self {
            Statement::Ended => String::new(),
            Statement::Skip => "SKIP; ".to_owned(),
            Statement::Assign(variable, value) => {
                let value = value.as_ref().map_or("*".to_owned(), Bits::show);
                format!("{} = {value}; ", ["a", "b"][*variable])
            }
            Statement::If(condition, yes, no) => {
                let condition = condition.as_ref().map_or("*".to_owned(), Bits::show);
                let no = match **no {
                    // Left out, it is the same.
                    Statement::Skip if condition != "*" => String::new(),
                    ref no => format!("else {{ {} }}", no.show()),
                };
                format!("if {condition} {{ {} }} {no} ", yes.show())
            }
            Statement::While(condition, body) => {
                format!("while ({}) {{ {} }} ", condition.show(), body.show())
            }
            Statement::Many(all) => all.iter().map(Statement::show).collect(),
        }
    }

    /// What is left behind each possible step, with the bits then.
    fn step(&self, state: &[Vec<bool>; 2]) -> Vec<(Statement, [Vec<bool>; 2])> {
        let stay = || state.clone();
        match self {
            Statement::Ended | Statement::Skip => vec![(Statement::Ended, stay())],
            Statement::Assign(variable, value) => {
                let any = || {
                    (0..1 << WIDTHS[*variable])
                        .map(|n| (0..WIDTHS[*variable]).map(|b| n >> b & 1 == 1).collect())
                };
                let values: Vec<Vec<bool>> =
                    value.as_ref().map_or_else(|| any().collect(), |e| vec![e.value(state)]);
                let with = |value| {
                    let mut next = stay();
                    next[*variable] = value;
                    (Statement::Ended, next)
                };
                values.into_iter().map(with).collect()
            }
            Statement::If(None, yes, no) => vec![((**yes).clone(), stay()), ((**no).clone(), stay())],
            Statement::If(Some(condition), yes, no) => {
                let taken = if condition.value(state)[0] { yes } else { no };
                vec![((**taken).clone(), stay())]
            }
            Statement::While(condition, body) => {
                let again = Statement::Many(vec![(**body).clone(), self.clone()]);
                vec![(if condition.value(state)[0] { again } else { Statement::Ended }, stay())]
            }
            Statement::Many(all) => {
                let (first, rest) = all.split_first().expect("there is one");
                let left = |(left, state): (Statement, _)| match (left, rest) {
                    (left, []) => (left, state),
                    (Statement::Ended, rest) => (Statement::Many(rest.to_vec()), state),
                    (left, rest) => (Statement::Many([&[left], rest].concat()), state),
                };
                first.step(state).into_iter().map(left).collect()
            }
        }
    }
}

#[test]
fn programs_mean_what_they_say() {
    let moving = Cell::new(0);
    property(400, 120, |random| {
        let statement =
            Statement::Many((0..2 + random.below(2)).map(|_| Statement::random(random, 2)).collect());
        let text = format!("a : 1;\nb : 2;\n{}\n", statement.show());
        let first = vec![(statement, WIDTHS.map(|width| vec![false; width]))];
        let next = |(statement, state): &(Statement, [Vec<bool>; 2])| statement.step(state);
        let look = |(_, state): &(Statement, [Vec<bool>; 2])| {
            state.iter().flatten().map(|bit| i64::from(*bit)).collect()
        };
        let expected = interpreted(first, next, look, 6);
        assert_eq!(seen(&system("p.txt", &text), 3, 6), expected, "{text}");
        moving.set(moving.get() + usize::from(expected.len() > 4));
    });
    assert!(moving.get() > 50, "{} programs do something", moving.get());
}
