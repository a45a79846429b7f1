//! Witnesses in the names of their problem, and back.

use super::{Ordered, Scalar, WitnessPath};
use crate::expr::{Rational, State, Type, Value};
use crate::ids::{ActionId, PathId, VarId};
use crate::lower::number;
use crate::objective::Objective;
use crate::problem::Problem;
use crate::strategy::{Strategy, Trace};
use crate::system::System;
use hyperplan_syntax::similar;
use thiserror::Error;

/// Why a witness is none for an objective of a problem. Positions of actions and states count from 0.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum WitnessError {
    /// A path stands in it twice.
    #[error("path {0} is given twice")]
    Twice(String),
    /// A path of the leading block is missing.
    #[error("path {0} is missing")]
    Missing(String),
    /// The objective has no such path.
    #[error("objective {objective} has no path `{path}`; a strategy for it gives {expected}")]
    NoPath {
        /// The objective.
        objective: String,
        /// What was given.
        path: String,
        /// The paths of its leading block.
        expected: String,
    },
    /// A path that is no part of a strategy.
    #[error("path {path} is quantified after a change of quantifier; a strategy gives {expected} only")]
    NotLeading {
        /// What was given.
        path: String,
        /// The paths of the leading block.
        expected: String,
    },
    /// The path is said to be one of another system.
    #[error("path {path} is one of system {system}, not of `{given}`")]
    System {
        /// The path.
        path: String,
        /// Its system.
        system: String,
        /// What was given.
        given: String,
    },
    /// Neither a state before and after each action, nor the first alone, nor none.
    #[error(
        "path {path} has {actions} actions and {states} states; there must be one more state than actions"
    )]
    Lengths {
        /// The path.
        path: String,
        /// How many actions.
        actions: usize,
        /// How many states.
        states: usize,
    },
    /// The system has no such action.
    #[error("path {path}, action {step}: system {system} has no action `{action}`{hint}")]
    Action {
        /// The path.
        path: String,
        /// The action's position.
        step: usize,
        /// The system.
        system: String,
        /// What was given.
        action: String,
        /// Empty, or what was probably meant.
        hint: String,
    },
    /// No state of the system.
    #[error("path {path}, state {step}: {fault}")]
    State {
        /// The path.
        path: String,
        /// The state's position.
        step: usize,
        /// What is wrong with it.
        fault: StateFault,
    },
}

/// Why something is no state of a system.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum StateFault {
    /// The system has no such variable.
    #[error("system {system} has no variable `{variable}`{hint}")]
    Unknown {
        /// The system.
        system: String,
        /// What was given.
        variable: String,
        /// Empty, or what was probably meant.
        hint: String,
    },
    /// A variable has no value.
    #[error("variable {0} is missing")]
    Missing(String),
    /// A value is not one of the variable's type.
    #[error("{variable} is {expected}, not {value}")]
    Value {
        /// The variable.
        variable: String,
        /// Its type, in words.
        expected: String,
        /// What was given.
        value: String,
    },
}

/// A strategy in the names of the problem.
#[must_use]
pub fn to_witness(problem: &Problem, objective: &Objective, strategy: &Strategy) -> Vec<WitnessPath> {
    let one = |trace: &Trace| {
        let var = &objective.paths[trace.path];
        let system = &problem.systems[var.system];
        WitnessPath {
            path: var.name.clone(),
            system: system.name.clone(),
            actions: trace.actions.iter().map(|&a| problem.actions[a].clone()).collect(),
            states: trace.states.iter().map(|s| write_state(system, s)).collect(),
            positions: positions(system, trace),
        }
    };
    strategy.traces.iter().map(one).collect()
}

/// Where each state is in the plane, where the system says so.
fn positions(system: &System, trace: &Trace) -> Option<Vec<(f64, f64)>> {
    let positions: Option<Vec<_>> = trace.states.iter().map(|state| system.position(state)).collect();
    positions.filter(|positions| !positions.is_empty())
}

/// A state in the names of its system. `crash` appears only where a map's robot has crashed.
#[must_use]
pub fn write_state(system: &System, state: &State) -> Ordered<Scalar> {
    let crash = system.map.as_ref().and_then(|m| m.crash);
    let entries = system.vars.iter_enumerated().zip(state.iter());
    // What costs add up to follows from the steps.
    let declared = entries.filter(|((_, var), _)| var.sums.is_none());
    let shown = declared.filter(|((id, _), v)| crash != Some(*id) || **v == Value::Bool(true));
    Ordered(shown.map(|((_, var), v)| (var.name.clone(), write_value(&var.ty, *v))).collect())
}

fn write_value(ty: &Type, value: Value) -> Scalar {
    match (value, ty) {
        (Value::Bool(b), _) => Scalar::Bool(b),
        (Value::Int(n), _) => Scalar::Int(n),
        (Value::Enum(i), Type::Enum(names)) => {
            Scalar::Name(names.get(i as usize).cloned().unwrap_or_else(|| i.to_string()))
        }
        (Value::Enum(i), _) => Scalar::Int(i64::from(i)),
        (Value::Real(r), _) if r.is_integer() => Scalar::Int(r.to_integer()),
        (Value::Real(r), _) => Scalar::Name(r.to_string()),
    }
}

/// The strategy that a witness describes, its traces in the order of the leading block. Whether they are paths of
/// their systems is for the checker to say. A path may be given by its actions, with its first state or with none: then
/// its trace has no others, for the checker to find.
///
/// # Errors
/// If names, counts or types do not fit the objective.
pub fn to_strategy(
    problem: &Problem,
    objective: &Objective,
    witness: &[WitnessPath],
) -> Result<Strategy, WitnessError> {
    let leading = objective.leading_block();
    let mut traces: Vec<Trace> = Vec::new();
    for given in witness {
        let path = find_path(objective, &leading, &given.path)?;
        if traces.iter().any(|t| t.path == path) {
            return Err(WitnessError::Twice(given.path.clone()));
        }
        traces.push(read_trace(problem, &problem.systems[objective.paths[path].system], path, given)?);
    }
    if let Some(missing) = leading.iter().find(|p| traces.iter().all(|t| t.path != **p)) {
        return Err(WitnessError::Missing(objective.paths[*missing].name.clone()));
    }
    traces.sort_by_key(|t| t.path);
    Ok(Strategy { traces })
}

fn find_path(objective: &Objective, leading: &[PathId], name: &str) -> Result<PathId, WitnessError> {
    let expected = || {
        let names: Vec<&str> = leading.iter().map(|&p| objective.paths[p].name.as_str()).collect();
        names.join(", ")
    };
    match objective.path(name) {
        None => Err(WitnessError::NoPath {
            objective: objective.name.clone(),
            path: name.to_owned(),
            expected: expected(),
        }),
        Some(path) if !leading.contains(&path) => {
            Err(WitnessError::NotLeading { path: name.to_owned(), expected: expected() })
        }
        Some(path) => Ok(path),
    }
}

fn read_trace(
    problem: &Problem,
    system: &System,
    path: PathId,
    given: &WitnessPath,
) -> Result<Trace, WitnessError> {
    let name = || given.path.clone();
    if !given.system.is_empty() && given.system != system.name {
        let (system, given) = (system.name.clone(), given.system.clone());
        return Err(WitnessError::System { path: name(), system, given });
    }
    let (actions, states) = (given.actions.len(), given.states.len());
    if states > 1 && states != actions + 1 {
        return Err(WitnessError::Lengths { path: name(), actions, states });
    }
    let actions = given.actions.iter().enumerate();
    let actions = actions.map(|(step, action)| {
        read_action(problem, system, action).ok_or_else(|| WitnessError::Action {
            path: name(),
            step,
            system: system.name.clone(),
            action: action.clone(),
            hint: hint(action, system.actions.iter().map(|&a| problem.actions[a].as_str())),
        })
    });
    let states = given.states.iter().enumerate();
    let states = states.map(|(step, state)| {
        read_state(system, state).map_err(|fault| WitnessError::State { path: name(), step, fault })
    });
    let mut trace = Trace {
        path,
        actions: actions.collect::<Result<_, _>>()?,
        states: states.collect::<Result<_, _>>()?,
    };
    system.add_up(&mut trace);
    Ok(trace)
}

/// The action of that name.
fn read_action(problem: &Problem, system: &System, name: &str) -> Option<ActionId> {
    system.actions.iter().copied().find(|&a| problem.actions[a] == name)
}

fn read_state(system: &System, given: &Ordered<Scalar>) -> Result<State, StateFault> {
    let declared = || system.vars.iter().filter(|var| var.sums.is_none()).map(|var| var.name.as_str());
    if let Some((name, _)) = given.0.iter().find(|(name, _)| !declared().any(|known| known == name)) {
        let hint = hint(name, declared());
        return Err(StateFault::Unknown { system: system.name.clone(), variable: name.clone(), hint });
    }
    let crash: Option<VarId> = system.map.as_ref().and_then(|m| m.crash);
    let read = |(id, var): (VarId, &crate::system::Var)| match given.get(&var.name) {
        None if crash == Some(id) => Ok(Value::Bool(false)),
        None if var.sums.is_some() => Ok(Value::Int(0)),
        None => Err(StateFault::Missing(var.name.clone())),
        Some(value) => read_value(&var.ty, value).ok_or_else(|| StateFault::Value {
            variable: var.name.clone(),
            expected: type_in_words(&var.ty),
            value: value.to_string(),
        }),
    };
    system.vars.iter_enumerated().map(read).collect()
}

fn read_value(ty: &Type, value: &Scalar) -> Option<Value> {
    match (ty, value) {
        (Type::Bool, Scalar::Bool(b)) => Some(Value::Bool(*b)),
        (Type::Range { lo, hi }, Scalar::Int(n)) if (lo..=hi).contains(&n) => Some(Value::Int(*n)),
        (Type::Int, Scalar::Int(n)) => Some(Value::Int(*n)),
        (Type::Real, Scalar::Int(n)) => Value::real(Rational::from(*n)),
        (Type::Real, Scalar::Decimal(x)) => real(&x.to_string()),
        (Type::Real, Scalar::Name(text)) => real(text),
        (Type::Enum(names), Scalar::Name(name)) => {
            let index = names.iter().position(|n| n == name)?;
            u32::try_from(index).ok().map(Value::Enum)
        }
        // Graph files may call a state by an integer.
        (Type::Enum(_), Scalar::Int(n)) => read_value(ty, &Scalar::Name(n.to_string())),
        _ => None,
    }
}

fn real(text: &str) -> Option<Value> {
    match number(text)? {
        Value::Int(n) => Some(Value::Real(Rational::from(n))),
        real => Some(real),
    }
}

fn type_in_words(ty: &Type) -> String {
    match ty {
        Type::Bool => "true or false".to_owned(),
        Type::Range { lo, hi } => format!("an integer in {lo}..{hi}"),
        // The states of a graph may be many.
        Type::Enum(names) if names.len() > 12 => format!("one of {}, ...", names[..12].join(", ")),
        Type::Enum(names) => format!("one of {}", names.join(", ")),
        Type::Int => "an integer".to_owned(),
        Type::Real => "a number or a fraction in quotes, such as \"1/4\"".to_owned(),
    }
}

fn hint<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> String {
    similar(name, known).map_or_else(String::new, |meant| format!("; did you mean `{meant}`?"))
}

#[cfg(test)]
mod tests {
    use super::super::StrategyFile;
    use super::*;
    use crate::expr::Expr;
    use crate::formula::{Formula, Node};
    use crate::objective::{Mode, PathVar, Quantifier};
    use crate::system::{Map, Var};
    use hyperplan_syntax::{SourceId, Span};
    use typed_index_collections::ti_vec;

    fn example() -> Problem {
        let span = Span::new(SourceId(0), 0..0);
        let var = |name: &str, ty| Var { name: name.to_owned(), ty, sums: None, span };
        let lights: std::sync::Arc<[String]> = ["red".to_owned(), "green".to_owned()].into();
        let system = System {
            name: "Rooms".to_owned(),
            vars: ti_vec![
                var("x", Type::Range { lo: 0, hi: 2 }),
                var("light", Type::Enum(lights)),
                var("crash", Type::Bool)
            ],
            actions: vec![ActionId(0), ActionId(1)],
            clauses: Vec::new(),
            also: Vec::new(),
            costs: ti_vec![],
            base: None,
            edges: None,
            trans: Expr::TRUE,
            init: Expr::TRUE,
            labels: ti_vec![],
            absorb: Expr::FALSE,
            observe: Vec::new(),
            map: Some(Map {
                width: 3,
                height: 1,
                obstacles: Vec::new(),
                unknown: Vec::new(),
                letters: Vec::new(),
                x: VarId(0),
                y: VarId(0),
                crash: Some(VarId(2)),
                place: None,
            }),
            coordinates: None,
            span,
        };
        let path = |name: &str, quantifier| PathVar {
            name: name.to_owned(),
            quantifier,
            system: crate::ids::SystemId(0),
            span,
        };
        let mut formula = Formula::default();
        formula.push(Node::Atom(Expr::TRUE), span);
        let objective = Objective {
            name: "o".to_owned(),
            paths: ti_vec![path("p", Quantifier::Exists), path("q", Quantifier::Forall)],
            mode: Mode::Bounded,
            semantics: None,
            formula,
            minimize: Vec::new(),
            span,
        };
        Problem {
            actions: ti_vec!["left".to_owned(), "right".to_owned()],
            systems: ti_vec![system],
            objectives: vec![objective],
        }
    }

    fn read(problem: &Problem, text: &str) -> Result<Strategy, String> {
        let files = StrategyFile::read_all(text).map_err(|e| e.to_string())?;
        let witness = files[0].witness.clone().expect("the test has one");
        to_strategy(problem, &problem.objectives[0], &witness).map_err(|e| e.to_string())
    }

    const GOOD: &str = r#"{"witness": [{"path": "p", "actions": ["right"],
        "states": [{"x": 0, "light": "red"}, {"light": "green", "x": 1, "crash": true}]}]}"#;

    #[test]
    fn round_trip() {
        let problem = example();
        let strategy = read(&problem, GOOD).expect("it fits");
        let witness = to_witness(&problem, &problem.objectives[0], &strategy);
        let json = serde_json::to_string(&witness).expect("serializable");
        assert_eq!(
            json,
            r#"[{"path":"p","system":"Rooms","actions":["right"],"states":[{"x":0,"light":"red"},{"x":1,"light":"green","crash":true}]}]"#
        );
        assert_eq!(to_strategy(&problem, &problem.objectives[0], &witness), Ok(strategy));
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let problem = example();
        let with =
            |from: &str, to: &str| read(&problem, &GOOD.replace(from, to)).expect_err("it does not fit");
        assert_eq!(with("\"p\"", "\"r\""), "objective o has no path `r`; a strategy for it gives p");
        assert_eq!(
            with("\"p\"", "\"q\""),
            "path q is quantified after a change of quantifier; a strategy gives p only"
        );
        assert_eq!(
            with("[\"right\"]", "[\"rigth\"]"),
            "path p, action 0: system Rooms has no action `rigth`; did you mean `right`?"
        );
        assert_eq!(with("\"x\": 1", "\"x\": 3"), "path p, state 1: x is an integer in 0..2, not 3");
        assert_eq!(with("\"x\": 1, ", ""), "path p, state 1: variable x is missing");
        assert_eq!(
            with("\"green\"", "\"blue\""),
            "path p, state 1: light is one of red, green, not \"blue\""
        );
        assert_eq!(
            with("[\"right\"]", "[]"),
            "path p has 0 actions and 2 states; there must be one more state than actions"
        );
        assert_eq!(
            with("\"path\": \"p\"", "\"path\": \"p\", \"system\": \"W\""),
            "path p is one of system Rooms, not of `W`"
        );
        assert!(with("\"x\": 0", "\"x\": 0, \"x\": 1").starts_with("`x` is given twice at line 2"));
        let (from, to) = (
            "\"witness\": [",
            "\"witness\": [{\"path\": \"p\", \"actions\": [], \"states\": [{\"x\": 0, \"light\": \"red\"}]},",
        );
        assert_eq!(with(from, to), "path p is given twice");
        assert_eq!(read(&problem, r#"{"witness": []}"#), Err("path p is missing".to_owned()));
    }
}
