//! Traces as tables and lines of text.

use crate::eval::truth;
use hyperplan_outlet::{blanks, one_line};
use hyperplan_problem::{Objective, Problem, State, System, Trace, Type, Value};

/// A table of a trace: time, the action taken there (`-` at the end), and the value of each variable.
#[must_use]
pub fn table(problem: &Problem, objective: &Objective, trace: &Trace) -> String {
    let Some(path) = objective.paths.get(trace.path) else { return String::new() };
    let system = &problem.systems[path.system];
    let head = std::iter::once("time".to_owned()).chain(columns(system)).collect();
    let mut rows: Vec<Vec<String>> = vec![head];
    for time in 0..trace.states.len() {
        rows.push(std::iter::once(time.to_string()).chain(row(problem, system, trace, time)).collect());
    }
    let columns = rows[0].len();
    let width = |i: usize| rows.iter().filter_map(|r| r.get(i)).map(|c| c.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut out = String::new();
    for row in &rows {
        let mut line = String::new();
        for (i, (text, &width)) in row.iter().zip(&widths).enumerate() {
            // Numbers are read from the right, names from the left.
            let blanks = blanks(text, width);
            line += &if i == 1 { [text, blanks.as_str()] } else { [blanks.as_str(), text] }.concat();
            line += "  ";
        }
        out += line.trim_end();
        out.push('\n');
    }
    out
}

/// What is told of a path at each time: the action taken there, the variables, and where it is, if that is known in metres.
pub(crate) fn columns(system: &System) -> Vec<String> {
    // Sums of costs stop where more of them makes no difference.
    let declared = system.vars.iter().filter(|var| var.sums.is_none()).map(|var| var.name.clone());
    let metres = in_metres(system).then_some(["x in m", "y in m"].map(str::to_owned));
    std::iter::once("action".to_owned()).chain(declared).chain(metres.into_iter().flatten()).collect()
}

/// The same at a time; `-` for the action at the end.
pub(crate) fn row(problem: &Problem, system: &System, trace: &Trace, time: usize) -> Vec<String> {
    let state = &trace.states[time];
    let action = trace.actions.get(time).map_or("-", |a| problem.actions[*a].as_str());
    let mut row = vec![one_line(action).into_owned()];
    let declared = system.vars.iter().filter(|var| var.sums.is_none());
    row.extend(declared.zip(state.iter()).map(|(var, value)| in_words(&var.ty, *value)));
    if let Some((x, y)) = system.position(state).filter(|_| in_metres(system)) {
        row.extend([x.to_string(), y.to_string()]);
    }
    row
}

fn in_metres(system: &System) -> bool {
    system.map.as_ref().is_some_and(|map| map.place.is_some())
}

/// A value as tables and timelines have it.
pub(crate) fn in_words(ty: &Type, value: Value) -> String {
    match (value, ty) {
        (Value::Bool(b), _) => b.to_string(),
        (Value::Int(n), _) => n.to_string(),
        (Value::Enum(i), Type::Enum(names)) => {
            names.get(i as usize).map(|name| one_line(name).into_owned()).unwrap_or_default()
        }
        (Value::Enum(i), _) => i.to_string(),
        (Value::Real(r), _) => r.to_string(),
    }
}

/// How many steps a trace takes until it is in a state that absorbs, if it ever is.
#[must_use]
pub fn steps_to_rest(problem: &Problem, objective: &Objective, trace: &Trace) -> usize {
    let Some(path) = objective.paths.get(trace.path) else { return trace.actions.len() };
    let system = &problem.systems[path.system];
    let rest = trace.states.iter().position(|state| is_absorbing(system, state));
    rest.unwrap_or(trace.actions.len()).min(trace.actions.len())
}

/// The actions of a trace on one line, repetitions counted: `right, up x3, stay`. Actions that an absorbing state
/// makes idle are only counted.
#[must_use]
pub fn actions_line(problem: &Problem, objective: &Objective, trace: &Trace) -> String {
    if objective.paths.get(trace.path).is_none() {
        return String::new();
    }
    let moved = steps_to_rest(problem, objective, trace);
    let mut runs: Vec<(usize, &str)> = Vec::new();
    for action in &trace.actions[..moved] {
        let name = problem.actions[*action].as_str();
        match runs.last_mut() {
            Some((count, last)) if *last == name => *count += 1,
            _ => runs.push((1, name)),
        }
    }
    let run = |(count, name): &(usize, &str)| {
        let name = one_line(name);
        if *count == 1 { name.into_owned() } else { format!("{name} x{count}") }
    };
    let mut parts: Vec<String> = runs.iter().map(run).collect();
    let idle = trace.actions.len() - moved;
    if idle > 0 {
        parts.push(format!("absorbed after {moved} step{}", if moved == 1 { "" } else { "s" }));
    } else if parts.is_empty() {
        parts.push("no action".to_owned());
    }
    parts.join(", ")
}

fn is_absorbing(system: &System, state: &State) -> bool {
    let known: Vec<Option<Value>> = state.iter().copied().map(Some).collect();
    truth(system, &system.absorb, &known) == Some(true)
}
