//! What the other player answers: paths that follow from those chosen before, and their form in files.

use crate::error::Error;
use crate::system::Graph;
use hyperplan_problem::answer::{Ordered, Scalar};
use hyperplan_problem::{ActionId, Objective, PathId, Problem, System, Trace, Type, Value};
use serde::{Deserialize, Serialize};

/// No path has more steps, by the limits of the language.
const STEPS: u64 = 1 << 20;

/// A path of the other player as a function of paths that were quantified before it. Where it cannot go on it is no
/// path, and says nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Instance {
    /// The path variable that it stands for.
    pub path: PathId,
    /// How it begins.
    pub start: Start,
    /// Its steps from there on.
    pub steps: Vec<Step>,
}

/// The beginning of an instance.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Start {
    /// In this state.
    State(Box<[Value]>),
    /// Together with another path for so many steps: with its states, actions and outcomes.
    Along(PathId, u32),
}

/// A step of an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Step {
    /// The action.
    pub action: Action,
    /// Which of the states to which the action leads, in the order in which they are explored.
    pub outcome: u32,
}

/// What an instance does in a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// This.
    Is(ActionId),
    /// What another path does in that step.
    Like(PathId),
}

/// Instances of the paths of one block of the other player.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Branch {
    /// To what they are an answer: to what the player chooses after an earlier branch, given by its position from 1 on, or, for 0, in
    /// the leading block.
    pub after: usize,
    /// An instance for each path of the block, in order.
    pub instances: Vec<Instance>,
}

/// What a system's paths must be able to do after each step to be paths: in bounded mode, to go on for ever.
pub(crate) fn targets<'g>(
    graph: &'g Graph<'_>,
    state: u32,
    action: ActionId,
    lasting: bool,
) -> impl Iterator<Item = u32> + 'g {
    let moves = graph.moves(state).iter();
    moves.filter(move |m| m.0 == action && (!lasting || graph.is_live(m.1))).map(|m| m.1)
}

impl Instance {
    /// The instance that does what a trace does: with the same actions as paths before it, wherever the objective compares
    /// them and they are the same.
    pub(crate) fn of(
        objective: &Objective,
        graph: &Graph<'_>,
        (known, trace): (&[Trace], &Trace),
        lasting: bool,
    ) -> Result<Instance, Error> {
        let steps = trace.actions.len();
        let tied = |other: &&Trace| objective.ties(other.path, trace.path);
        let system = |path: PathId| objective.paths[path].system;
        let together = |other: &Trace| {
            if system(other.path) != system(trace.path) || other.states.first() != trace.states.first() {
                return None;
            }
            let same = |t: &usize| {
                let (t, next) = (*t, *t + 1);
                trace.actions.get(t) == other.actions.get(t)
                    && trace.states.get(next) == other.states.get(next)
            };
            let most = trace.actions.len().min(other.actions.len()).min(steps);
            Some(((0..most).take_while(same).count(), other.path))
        };
        // The longest common beginning; of equal ones the first.
        let along = known.iter().filter(tied).filter_map(together).rev().max_by_key(|(steps, _)| *steps);
        let start = match along {
            Some((common, path)) => Start::Along(path, u32::try_from(common).map_err(|_| SHORT)?),
            None => Start::State(trace.states.first().ok_or(SHORT)?.clone()),
        };
        let mut own = Vec::new();
        for t in along.map_or(0, |(common, _)| common)..steps {
            let (Some(&action), Some(here), Some(there)) =
                (trace.actions.get(t), trace.states.get(t), trace.states.get(t + 1))
            else {
                return Err(SHORT);
            };
            let (here, there) = (graph.find(here).ok_or(SHORT)?, graph.find(there).ok_or(SHORT)?);
            let outcome = targets(graph, here, action, lasting).position(|to| to == there).ok_or(SHORT)?;
            let same = |other: &&Trace| other.actions.get(t) == Some(&action);
            let like = known.iter().filter(|other| objective.tied_before(trace.path).contains(&other.path));
            let like =
                like.filter(same).max_by_key(|other| along.is_some_and(|(_, path)| path == other.path));
            let action = like.map_or(Action::Is(action), |other| Action::Like(other.path));
            own.push(Step { action, outcome: u32::try_from(outcome).map_err(|_| SHORT)? });
        }
        Ok(Instance { path: trace.path, start, steps: own })
    }

    /// The path that it is, given those before it; `None` where it is none.
    pub(crate) fn trace(&self, graph: &Graph<'_>, known: &[Trace], lasting: bool) -> Option<Trace> {
        let of = |path: PathId| known.iter().find(|trace| trace.path == path);
        let (mut states, mut actions) = match &self.start {
            Start::State(values) => (vec![values.clone()], Vec::new()),
            Start::Along(path, steps) => {
                let (other, steps) = (of(*path)?, *steps as usize);
                (other.states.get(..=steps)?.to_vec(), other.actions.get(..steps)?.to_vec())
            }
        };
        for step in &self.steps {
            let action = match step.action {
                Action::Is(action) => action,
                Action::Like(path) => *of(path)?.actions.get(actions.len())?,
            };
            let here = graph.find(states.last()?)?;
            let to = targets(graph, here, action, lasting).nth(step.outcome as usize)?;
            actions.push(action);
            states.push(graph.values(to).into());
        }
        Some(Trace { path: self.path, states, actions })
    }
}

/// A counterexample comes from a checker that gives whole paths.
const SHORT: Error = Error::Malformed { what: "a counterexample is no path of its system" };

/// A branch as it is written.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct BranchFile {
    #[serde(default, skip_serializing_if = "is_zero")]
    after: usize,
    instances: Vec<InstanceFile>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct InstanceFile {
    path: String,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    start: Option<Ordered<Scalar>>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    along: Option<AlongFile>,
    steps: Vec<StepFile>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct AlongFile {
    path: String,
    steps: u32,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StepFile {
    #[serde(default, skip_serializing_if = "Option::is_none")]
    action: Option<String>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    like: Option<String>,
    #[serde(default, skip_serializing_if = "is_zero")]
    outcome: u32,
    #[serde(default = "one", skip_serializing_if = "is_one")]
    times: u64,
}

fn is_zero<N: Default + PartialEq>(n: &N) -> bool {
    *n == N::default()
}

// Serde asks by reference.
#[allow(clippy::trivially_copy_pass_by_ref)]
fn is_one(n: &u64) -> bool {
    *n == 1
}

fn one() -> u64 {
    1
}

/// Branches in the names of the problem.
pub(crate) fn write(problem: &Problem, objective: &Objective, branches: &[Branch]) -> Vec<BranchFile> {
    let name = |path: PathId| objective.paths[path].name.clone();
    let instance = |own: &Instance| {
        let system = &problem.systems[objective.paths[own.path].system];
        let (start, along) = match &own.start {
            Start::State(values) => (Some(write_state(system, values)), None),
            Start::Along(path, steps) => (None, Some(AlongFile { path: name(*path), steps: *steps })),
        };
        let mut steps: Vec<StepFile> = Vec::new();
        for step in &own.steps {
            let (action, like) = match step.action {
                Action::Is(action) => (Some(problem.actions[action].clone()), None),
                Action::Like(path) => (None, Some(name(path))),
            };
            let step = StepFile { action, like, outcome: step.outcome, times: 1 };
            match steps.last_mut() {
                Some(last) if (StepFile { times: 1, ..last.clone() }) == step => last.times += 1,
                _ => steps.push(step),
            }
        }
        InstanceFile { path: name(own.path), start, along, steps }
    };
    let branch = |own: &Branch| BranchFile {
        after: own.after,
        instances: own.instances.iter().map(instance).collect(),
    };
    branches.iter().map(branch).collect()
}

fn write_state(system: &System, values: &[Value]) -> Ordered<Scalar> {
    let value = |(var, value): (&hyperplan_problem::Var, &Value)| {
        let scalar = match (value, &var.ty) {
            (Value::Bool(b), _) => Scalar::Bool(*b),
            (Value::Int(n), _) => Scalar::Int(*n),
            (Value::Enum(i), Type::Enum(names)) => {
                Scalar::Name(names.get(*i as usize).cloned().unwrap_or_default())
            }
            (Value::Enum(i), _) => Scalar::Int(i64::from(*i)),
            (Value::Real(r), _) => Scalar::Name(r.to_string()),
        };
        (var.name.clone(), scalar)
    };
    Ordered(system.vars.iter().zip(values).map(value).collect())
}

/// Branches of a file.
pub(crate) fn read(
    problem: &Problem,
    objective: &Objective,
    branches: Vec<BranchFile>,
) -> Result<Vec<Branch>, Error> {
    let branch = |BranchFile { after, instances }: BranchFile| {
        let instances = instances.into_iter().map(|own| read_instance(problem, objective, own));
        Ok(Branch { after, instances: instances.collect::<Result<_, Error>>()? })
    };
    branches.into_iter().map(branch).collect()
}

fn read_instance(problem: &Problem, objective: &Objective, own: InstanceFile) -> Result<Instance, Error> {
    let InstanceFile { path: name, start, along, steps } = own;
    let wrong = |what: String| Error::Instance { path: name.clone(), what };
    let find = |name: &str| objective.path(name).ok_or_else(|| wrong(format!("there is no path {name}")));
    let path = find(&name)?;
    let system = &problem.systems[objective.paths[path].system];
    let start = match (start, along) {
        (Some(values), None) => Start::State(read_state(system, &values).map_err(wrong)?),
        (None, Some(along)) => Start::Along(find(&along.path)?, along.steps),
        _ => return Err(wrong("it has either a start or a path along which it goes".to_owned())),
    };
    let mut all = Vec::new();
    for StepFile { action, like, outcome, times } in steps {
        let action = match (action, like) {
            (Some(action), None) => {
                let found = problem.action(&action).filter(|action| system.actions.contains(action));
                Action::Is(
                    found.ok_or_else(|| wrong(format!("system {} has no action {action}", system.name)))?,
                )
            }
            (None, Some(path)) => Action::Like(find(&path)?),
            _ => return Err(wrong("a step has either an action or a path whose action it takes".to_owned())),
        };
        if all.len() as u64 + times.min(STEPS) > STEPS {
            return Err(wrong("it has too many steps".to_owned()));
        }
        all.extend((0..times).map(|_| Step { action, outcome }));
    }
    Ok(Instance { path, start, steps: all })
}

fn read_state(system: &System, values: &Ordered<Scalar>) -> Result<Box<[Value]>, String> {
    if values.0.len() != system.vars.len() {
        return Err(format!("a state of system {} has {} variables", system.name, system.vars.len()));
    }
    let value = |var: &hyperplan_problem::Var| {
        let scalar = values.get(&var.name).ok_or_else(|| format!("its start lacks variable {}", var.name))?;
        let value = match (scalar, &var.ty) {
            (Scalar::Bool(b), _) => Some(Value::Bool(*b)),
            (Scalar::Int(n), _) => Some(Value::Int(*n)),
            (Scalar::Name(name), Type::Enum(names)) => {
                names.iter().position(|n| n == name).and_then(|at| u32::try_from(at).ok()).map(Value::Enum)
            }
            _ => None,
        };
        value
            .filter(|value| var.ty.contains(*value))
            .ok_or_else(|| format!("variable {} has no value {scalar}", var.name))
    };
    system.vars.iter().map(value).collect()
}
