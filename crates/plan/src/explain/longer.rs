//! Whether more time would help, and how much.

use crate::config::{Config, Verdict};
use crate::fact::{Error, Fault};
use crate::minimize::{MinimizeError, minimize};
use hyperplan_problem::{Interval, Mode, Node, Objective, Problem};
use hyperplan_solver::Deadline;

/// What gives an objective its time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Time {
    /// A constant of the file.
    Constant(String),
    /// The K of `within K`.
    Within,
    /// The last step that an interval of the formula names.
    Interval,
    /// The bound with which formulas of other tools are read.
    Bound,
}

/// A way to give an objective more time.
pub struct Longer<'a> {
    /// What is made larger.
    pub time: Time,
    /// What it is now.
    pub value: i64,
    /// The problem with another value; `None` where there is none.
    pub problem_of: Box<dyn FnMut(i64) -> Option<Problem> + 'a>,
}

/// What is known of more time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Later {
    /// What was made larger.
    pub time: Time,
    /// What it is now.
    pub now: i64,
    /// The least value found with which there is a strategy.
    pub least: Option<i64>,
    /// With all values from the present one up to this there is none: where nothing was found, or some value between was not
    /// decided, there may be one beyond.
    pub refuted: i64,
}

/// Values far beyond the present one are not tried: so many times it, and so many more.
const TIMES: i64 = 4;
const MORE: i64 = 16;

/// Ways to give an objective more time that need no file: `within K`, or the last step that intervals name.
#[must_use]
pub fn longer<'a>(problem: &'a Problem, objective: &'a Objective) -> Option<Longer<'a>> {
    let at = problem.objectives.iter().position(|other| other.name == objective.name)?;
    let with = move |change: &dyn Fn(&mut Objective)| {
        let mut problem = problem.clone();
        problem.objectives.truncate(at + 1);
        problem.objectives.get_mut(at).map(change)?;
        Some(problem)
    };
    match objective.mode {
        // Other semantics were translated for this K.
        Mode::Within(_) if objective.semantics.is_some() => None,
        Mode::Within(steps) => Some(Longer {
            time: Time::Within,
            value: i64::from(steps),
            problem_of: Box::new(move |value| {
                let steps = u32::try_from(value).ok()?;
                with(&|objective| objective.mode = Mode::Within(steps))
            }),
        }),
        Mode::Bounded => {
            let last = objective.formula.nodes.iter().filter_map(|node| interval(node)?.hi).max()?;
            Some(Longer {
                time: Time::Interval,
                value: i64::from(last),
                problem_of: Box::new(move |value| {
                    let end = u32::try_from(value).ok()?;
                    with(&|objective| {
                        for node in &mut objective.formula.nodes {
                            lengthen(node, last, end);
                        }
                    })
                }),
            })
        }
    }
}

fn interval(node: &Node) -> Option<Interval> {
    match node {
        Node::Until(interval, ..) | Node::Release(interval, ..) => Some(*interval),
        _ => None,
    }
}

/// Intervals that end at the last step end at another.
fn lengthen(node: &mut Node, last: u32, end: u32) {
    if let Node::Until(interval, ..) | Node::Release(interval, ..) = node
        && interval.hi == Some(last)
        && interval.lo <= end
    {
        interval.hi = Some(end);
    }
}

/// The least larger value with which the objective has a strategy, as far as that is found in time.
pub(super) fn later(
    objective: &str,
    longer: &mut Longer<'_>,
    config: &Config,
    deadline: &Deadline,
) -> Result<Later, Error> {
    let mut later =
        Later { time: longer.time.clone(), now: longer.value, least: None, refuted: longer.value };
    let most = longer.value.saturating_mul(TIMES).saturating_add(MORE);
    let config = Config { deadline: deadline.clone(), ..config.clone() };
    while later.refuted < most && !deadline.passed() {
        let low = later.refuted + 1;
        let high = low.saturating_add(later.refuted.max(MORE / 2)).min(most);
        let mut problem_of = |value| (longer.problem_of)(value).ok_or(());
        let least = match minimize(objective, low..=high, &mut problem_of, &config) {
            Ok(least) => least,
            Err(MinimizeError::Problem(())) => break,
            Err(MinimizeError::Solve { error, .. }) if error.fault() <= Fault::Time => break,
            Err(MinimizeError::Solve { error, .. }) => return Err(error),
        };
        later.refuted = later.refuted.max(least.proved - 1);
        match least.outcome.verdict {
            Verdict::Realizable => {
                later.least = Some(least.value);
                break;
            }
            Verdict::Unrealizable => later.refuted = high,
            Verdict::Unknown => break,
        }
    }
    Ok(later)
}

impl Later {
    /// Whether the value found is the least.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.least.is_some_and(|least| self.refuted + 1 >= least)
    }
}
