//! Strategies as traces of NuSMV: a state each, of which those variables are told that have changed.

use hyperplan::foreign::Foreign;
use hyperplan_import::{Original, Originals};
use hyperplan_problem::Overrides;
use hyperplan_problem::answer::{Scalar, WitnessPath};
use std::fmt::Write as _;

/// What variables are in the files of another tool.
pub(crate) fn originals(foreign: Option<&Foreign>) -> Originals {
    foreign.map(|foreign| foreign.read(&Overrides::default()).2.originals).unwrap_or_default()
}

/// The traces of some paths, which refute the objective or fulfil it.
pub(crate) fn traces(objective: &str, refutes: bool, paths: &[WitnessPath], originals: &Originals) -> String {
    let mut text = String::new();
    for (number, path) in (1..).zip(paths) {
        let kind = if refutes { "Counterexample" } else { "Witness" };
        let _ = writeln!(text, "Trace Description: {objective}, path {}", path.path);
        let _ = writeln!(text, "Trace Type: {kind}");
        trace(&mut text, number, path, originals);
    }
    text
}

fn trace(text: &mut String, number: usize, path: &WitnessPath, originals: &Originals) {
    let own = originals.get(&path.system);
    let original = |name: &str| own.and_then(|names| names.get(name));
    let is_input = |name: &str| original(name).is_some_and(|original| original.input);
    let line = |text: &mut String, name: &str, value: &Scalar| {
        let written = written(value, original(name));
        let _ = writeln!(text, "    {} = {written}", original(name).map_or(name, |original| &original.name));
    };
    for (at, state) in path.states.iter().enumerate() {
        let before = at.checked_sub(1).map(|before| &path.states[before]);
        if let Some(before) = before {
            let mut inputs = String::new();
            // A model of another tool has one action, which says nothing.
            if let (None, Some(action)) = (own, path.actions.get(at - 1)) {
                let _ = writeln!(inputs, "    action = {action}");
            }
            before.0.iter().filter(|(name, _)| is_input(name)).for_each(|(n, v)| line(&mut inputs, n, v));
            if !inputs.is_empty() {
                let _ = write!(text, "  -> Input: {number}.{} <-\n{inputs}", at + 1);
            }
        }
        let _ = writeln!(text, "  -> State: {number}.{} <-", at + 1);
        for (name, value) in state.0.iter().filter(|(name, _)| !is_input(name)) {
            if before.is_none_or(|before| before.get(name) != Some(value)) {
                line(text, name, value);
            }
        }
    }
}

/// A value as NuSMV writes it.
fn written(value: &Scalar, original: Option<&Original>) -> String {
    match (value, original.and_then(|original| original.word)) {
        (Scalar::Int(n), Some((signed, width))) => {
            let (minus, sign) = (if *n < 0 { "-" } else { "" }, if signed { 's' } else { 'u' });
            format!("{minus}0{sign}d{width}_{}", n.unsigned_abs())
        }
        (Scalar::Bool(b), _) => if *b { "TRUE" } else { "FALSE" }.to_owned(),
        (value, _) => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyperplan_problem::answer::Ordered;
    use std::collections::BTreeMap;

    #[test]
    fn words_inputs_and_names_are_those_of_the_model() {
        let state = |x: i64, go: bool, on: bool| {
            let scalars = [("x_", Scalar::Int(x)), ("go", Scalar::Bool(go)), ("on", Scalar::Bool(on))];
            Ordered(scalars.map(|(name, value)| (name.to_owned(), value)).to_vec())
        };
        let path = WitnessPath {
            path: "A".to_owned(),
            system: "m".to_owned(),
            actions: vec!["step".to_owned(); 2],
            states: vec![state(0, true, false), state(-3, false, false), state(-3, true, true)],
            positions: None,
        };
        let original = |name: &str, word, input| Original { name: name.to_owned(), word, input };
        let names = BTreeMap::from([
            ("x_".to_owned(), original("p-x", Some((true, 4)), false)),
            ("go".to_owned(), original("go", None, true)),
        ]);
        let told = traces("f", true, std::slice::from_ref(&path), &BTreeMap::from([("m".to_owned(), names)]));
        let expected = "Trace Description: f, path A\nTrace Type: Counterexample\n  -> State: 1.1 <-\n    p-x = 0sd4_0\n    \
                        on = FALSE\n  -> Input: 1.2 <-\n    go = TRUE\n  -> State: 1.2 <-\n    p-x = -0sd4_3\n  -> Input: 1.3 <-\n    \
                        go = FALSE\n  -> State: 1.3 <-\n    on = TRUE\n";
        assert_eq!(told, expected);
        let own = traces("f", false, &[path], &BTreeMap::new());
        assert!(own.contains("Witness\n") && own.contains("Input: 1.2 <-\n    action = step\n"), "{own}");
    }
}
