//! Operators with intervals, nested and far into a trace, where windows of the unrolling meet: whether the solver finds the
//! one trace that is described exactly must be what the operators' definitions say of it.

use hyperplan_plan::{Config, States, Verdict, solve};
use hyperplan_problem::{NoFiles, Overrides, read};
use hyperplan_random::Random;
use hyperplan_solver::Spec;
use hyperplan_syntax::SourceMap;
use hyperplan_tests::{number, say};
use hyperplan_verify::{Budget, decide};

const SYSTEM: &str =
    "system S { state l: bool, r: bool; action step; on step { l' in {true, false}; r' in {true, false}; } }";

/// A formula of one path, with its value by definition.
enum Formula {
    Left,
    Right,
    Not(Box<Formula>),
    /// `U`, `R`, `W` or `M` with an interval.
    Binary(char, u32, u32, Box<Formula>, Box<Formula>),
}

/// The values of `l` and `r`, and whether the trace ends there.
struct Trace {
    at: Vec<(bool, bool)>,
    ends: bool,
}

impl Formula {
    fn random(random: &mut Random, depth: u32) -> Formula {
        if depth == 0 {
            return if random.once_in(2) { Formula::Left } else { Formula::Right };
        }
        let mut part = || Box::new(Formula::random(random, depth - 1));
        let (left, right) = (part(), part());
        let lo = random.bound(4);
        let hi = lo + random.bound(5);
        match random.below(5) {
            0 => Formula::Not(left),
            kind => Formula::Binary(['U', 'R', 'W', 'M'][kind - 1], lo, hi, left, right),
        }
    }

    fn look(&self) -> u32 {
        match self {
            Formula::Left | Formula::Right => 0,
            Formula::Not(f) => f.look(),
            Formula::Binary(_, _, hi, f, g) => hi + f.look().max(g.look()),
        }
    }

    fn text(&self) -> String {
        match self {
            Formula::Left => "l[p]".to_owned(),
            Formula::Right => "r[p]".to_owned(),
            Formula::Not(f) => format!("!({})", f.text()),
            Formula::Binary(kind, lo, hi, f, g) => {
                format!("(({}) {kind}[{lo},{hi}] ({}))", f.text(), g.text())
            }
        }
    }

    fn holds(&self, trace: &Trace, time: u32) -> bool {
        let until = |lo: u32, hi: u32, wait: &dyn Fn(u32) -> bool, end: &dyn Fn(u32) -> bool| {
            (lo..=hi).any(|steps| {
                let there = !trace.ends || ((time + steps) as usize) < trace.at.len();
                there && end(time + steps) && (0..steps).all(|before| wait(time + before))
            })
        };
        match self {
            Formula::Left => trace.at[time as usize].0,
            Formula::Right => trace.at[time as usize].1,
            Formula::Not(f) => !f.holds(trace, time),
            Formula::Binary(kind, lo, hi, f, g) => {
                let (f, g) = (|t| f.holds(trace, t), |t| g.holds(trace, t));
                match kind {
                    'U' => until(*lo, *hi, &f, &g),
                    'R' => !until(*lo, *hi, &|t| !f(t), &|t| !g(t)),
                    'W' => until(*lo, *hi, &f, &g) || !until(0, *hi, &|_| true, &|t| !f(t)),
                    _ => until(*lo, *hi, &g, &|t| f(t) && g(t)),
                }
            }
        }
    }
}

#[test]
fn windows_meet() {
    let first = number("HYPERPLAN_SEED", 20_261_127);
    let cases = number("HYPERPLAN_CASES", 300);
    let mut held = 0;
    for seed in first..first + cases {
        let mut random = Random::new(seed);
        let formula = Formula::random(&mut random, 2);
        let time = random.bound(8);
        let ends = random.once_in(3);
        let last = if ends { time + random.bound(6) } else { time + formula.look() };
        let at = (0..=last).map(|_| (random.flip(), random.flip())).collect();
        let trace = Trace { at, ends };
        let sign = |holds: bool| if holds { "" } else { "!" };
        let pins = (0..)
            .zip(&trace.at)
            .map(|(t, (l, r))| format!("{}({}l[p] & {}r[p])", "X ".repeat(t), sign(*l), sign(*r)));
        let pins: Vec<String> = pins.collect();
        let within = if ends { format!(" within {last}") } else { String::new() };
        let asked = format!("{}{}", "X ".repeat(time as usize), formula.text());
        let text = format!("{SYSTEM}\nobjective o{within} {{ exists p. {} & {asked} }}\n", pins.join(" & "));
        let lowered = read(&mut SourceMap::new(), "random.hp", &text, &NoFiles, &Overrides::default());
        assert!(!lowered.has_errors(), "{text}\n{:#?}", lowered.diagnostics);
        // With variables, nothing is left out beforehand: the terms decide.
        let config = Config { states: Some(States::Bitvec), ..Config::new(Spec::Builtin) };
        let outcome =
            solve(&lowered.problem, &lowered.problem.objectives[0], &config).expect("it is supported");
        let expected = formula.holds(&trace, time);
        let checked = decide(&lowered.problem, &lowered.problem.objectives[0], &Budget::default());
        assert_eq!(checked, Ok(Some(expected)), "seed {seed}, the checker\n{text}");
        held += u64::from(expected);
        assert_eq!(outcome.verdict == Verdict::Realizable, expected, "seed {seed}\n{text}");
    }
    say(&format!("seeds {first}..{}: {held} hold", first + cases));
    assert!(held * 5 > cases && held * 5 < cases * 4, "one value is rare");
}
