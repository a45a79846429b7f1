//! Plans in PDDL, as VAL reads them: an action a line; with several paths each action has its time, and its path as object.

use super::PlanError;
use crate::answer::WitnessPath;
use crate::objective::Objective;
use crate::problem::Problem;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A comment before the actions of a path says which it is.
const PATH: &str = "; path ";

/// A name as PDDL has them: a small letter, then letters, digits, `-` and `_`.
fn name(text: &str) -> String {
    let plain = |c: char| match c {
        'a'..='z' | '0'..='9' | '-' | '_' => c,
        'A'..='Z' => c.to_ascii_lowercase(),
        _ => '-',
    };
    let name: String = text.chars().map(plain).collect();
    if name.starts_with(|c: char| c.is_ascii_lowercase()) { name } else { format!("a-{name}") }
}

pub(super) fn write(paths: &[WitnessPath]) -> Result<String, PlanError> {
    let mut names: BTreeMap<String, &str> = BTreeMap::new();
    for action in paths.iter().flat_map(|path| &path.actions) {
        let short = name(action);
        let first = names.entry(short.clone()).or_insert(action);
        if *first != action.as_str() {
            return Err(PlanError::OneName((*first).to_owned(), action.clone(), short));
        }
    }
    // A path without actions is one too.
    let mut text: String = paths.iter().map(|path| format!("{PATH}{}\n", path.path)).collect();
    if let [path] = paths {
        path.actions.iter().for_each(|action| text += &format!("({})\n", name(action)));
        return Ok(text);
    }
    let steps = paths.iter().map(|path| path.actions.len()).max().unwrap_or(0);
    for time in 0..steps {
        for path in paths {
            if let Some(action) = path.actions.get(time) {
                let _ = writeln!(text, "{time}: ({} {})", name(action), name(&path.path));
            }
        }
    }
    Ok(text)
}

/// Whether a plan begins so.
pub(super) fn is_line(line: &str) -> bool {
    line.starts_with(['(', ';'])
        || line.split_once(':').is_some_and(|(time, _)| time.trim().parse::<f64>().is_ok())
}

/// The paths of a plan by their actions, as they are called here; the only one may have no name.
pub(super) fn read(text: &str) -> Result<Vec<WitnessPath>, String> {
    let mut paths: Vec<WitnessPath> = Vec::new();
    let mut named = "";
    for (number, line) in (1..).zip(text.lines()) {
        let line = line.trim();
        if let Some(path) = line.strip_prefix(PATH) {
            named = path.trim();
            of(&mut paths, named);
        }
        let step = line.split(';').next().unwrap_or_default().trim();
        if step.is_empty() {
            continue;
        }
        // A time before an action, and a duration behind it, say nothing that its place does not.
        let action = step.split_once(':').map_or(step, |(_, action)| action.trim());
        let action = action.split('[').next().unwrap_or_default().trim();
        let words = action.strip_prefix('(').and_then(|action| action.strip_suffix(')'));
        let words: Vec<&str> = words.unwrap_or_default().split_whitespace().collect();
        match words.as_slice() {
            [action] => of(&mut paths, named).actions.push((*action).to_owned()),
            [action, path] => of(&mut paths, path).actions.push((*action).to_owned()),
            _ => return Err(format!("line {number}: expected an action, such as `(up)` or `3: (up p)`")),
        }
    }
    if paths.is_empty() {
        return Err("the plan has no actions".to_owned());
    }
    Ok(paths)
}

/// The path of that name, new or known.
fn of<'a>(paths: &'a mut Vec<WitnessPath>, name: &str) -> &'a mut WitnessPath {
    let at = paths.iter().position(|path| path.path == name).unwrap_or_else(|| {
        let path = name.to_owned();
        paths.push(WitnessPath {
            path,
            system: String::new(),
            actions: Vec::new(),
            states: Vec::new(),
            positions: None,
        });
        paths.len() - 1
    });
    &mut paths[at]
}

/// The witness in the names of the problem: a path without a name is the only one, and names that PDDL has are those that
/// become them, where they are of no path or action themselves.
#[must_use]
pub fn meant(problem: &Problem, objective: &Objective, witness: &[WitnessPath]) -> Vec<WitnessPath> {
    let leading = objective.leading_block();
    let known = |path: &WitnessPath| {
        let by = |is: &dyn Fn(&str) -> bool| leading.iter().copied().find(|p| is(&objective.paths[*p].name));
        let own = by(&|own| own == path.path).or_else(|| by(&|own| name(own) == path.path));
        own.or_else(|| leading.first().copied().filter(|_| path.path.is_empty() && leading.len() == 1))
    };
    let one = |path: &WitnessPath| {
        let mut meant = path.clone();
        let Some(own) = known(path) else { return meant };
        meant.path.clone_from(&objective.paths[own].name);
        let actions = &problem.systems[objective.paths[own].system].actions;
        let names: Vec<&str> = actions.iter().map(|action| problem.actions[*action].as_str()).collect();
        for action in meant.actions.iter_mut().filter(|action| !names.contains(&action.as_str())) {
            if let Some(own) = names.iter().find(|own| name(own) == *action) {
                *action = (*own).to_owned();
            }
        }
        meant
    };
    witness.iter().map(one).collect()
}
