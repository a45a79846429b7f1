//! Random problem files with all that the language has: constants, systems of every kind and the files that they name,
//! definitions, templates, objectives over several systems, lengths and semantics.
//!
//! What is made has a meaning, nearly always: names are declared and types fit. Whether it is worth asking for is left
//! to chance. [`model`](crate::model) makes less, but knows the answers.

mod expression;
mod system;

use expression::Scope;
use hyperplan_random::Random;
use std::collections::BTreeMap;
use system::System;

/// A problem file.
#[derive(Clone, Debug)]
pub struct Whole {
    /// Its text.
    pub text: String,
    /// The files that it names.
    pub files: BTreeMap<String, String>,
}

impl Whole {
    /// A random one.
    #[must_use]
    pub fn random(random: &mut Random) -> Whole {
        let mut whole = Whole { text: "const T = 2;\nconst D = T + 1;\n".to_owned(), files: BTreeMap::new() };
        let count = [1, 1, 1, 2, 2, 3][random.below(6)];
        let mut systems: Vec<System> =
            (0..count).map(|number| System::random(random, number, &mut whole)).collect();
        whole.shared(random, &mut systems);
        for number in 0..1 + random.below(2) {
            whole.objective(random, &systems, number);
        }
        whole
    }

    /// The text of a file that the problem names.
    ///
    /// # Errors
    /// If it names none such.
    pub fn file(&self, path: &str) -> Result<Vec<u8>, String> {
        let text = self.files.get(path).ok_or("there is no such file")?;
        Ok(text.clone().into_bytes())
    }

    /// A template, and for each system a definition of two of its paths.
    fn shared(&mut self, random: &mut Random, systems: &mut [System]) {
        for system in systems {
            let scopes = [Scope::of_path(system, "a"), Scope::of_path(system, "b")];
            let depth = random.below(3);
            let body = expression::formula(random, &scopes, depth, Some(1));
            self.text += &format!("define d{}(a, b) = {body};\n", system.number);
            system.defined = true;
        }
        let block = random.one(&[
            "exists p. forall q.",
            "exists p, q.",
            "forall p. exists q.",
            "forall q. exists p.",
        ]);
        let body = random.one(&[
            "here[p] & F[0,K] there[p] & (here[q] -> !there[q] U[0,K] there[p])",
            "F[K] there[p] | G[0,K] (here[q] <-> state[p] == state[q])",
            "(G[0,K] action[p] == action[q]) -> (here[p] W[0,K] there[q])",
        ]);
        self.text += &format!("template t(here, there, K) {{ {block} {body} }}\n");
    }

    fn objective(&mut self, random: &mut Random, systems: &[System], number: usize) {
        let within = random.once_in(3);
        let mut semantics = "";
        self.text += &format!("objective o{number}");
        if within {
            self.text += random.one(&[" within 0", " within T", " within D", " within 4"]);
            semantics = random.one(&[
                "",
                "",
                " semantics pes",
                " semantics opt",
                " semantics hpes",
                " semantics hopt",
            ]);
            self.text += semantics;
        }
        if systems.len() == 1 && random.once_in(4) {
            self.text += &format!(" = {};\n", instance(random, &systems[0]));
            return;
        }
        let mut quantifiers = String::new();
        let mut scopes: Vec<Scope<'_>> = Vec::new();
        for path in &["p", "q", "r"][..1 + random.below(3)] {
            let system = &systems[random.below(systems.len())];
            let of = if systems.len() > 1 { format!(": {}", system.name) } else { String::new() };
            quantifiers += &format!("{} {path}{of}. ", random.one(&["exists", "forall"]));
            scopes.push(Scope::of_path(system, path));
        }
        let depth = 1 + random.below(4);
        let body = expression::formula(random, &scopes, depth, (!within).then_some(3));
        let mut inner = String::new();
        let mut body = body;
        let priced: Vec<&str> = scopes.iter().filter(|scope| scope.costs()).map(|scope| scope.path).collect();
        if let (Some(first), Some(last), "") = (priced.first(), priced.last(), semantics) {
            body = match random.below(4) {
                0 => format!("({body}) & F[0,2] cost c[{first}] <= 3"),
                1 => format!("({body}) | !cost c[{first}] + 1 < 2 * cost c[{last}]"),
                _ => body,
            };
        }
        let leads = quantifiers.starts_with("exists p") && scopes[0].costs();
        let wish = if leads && random.flip() { " minimize 2 * cost c[p] + T;" } else { "" };
        if random.once_in(3) {
            let own = expression::formula(random, &scopes[..1], 1, Some(1));
            inner = format!("define own({}) = {own};\n  ", scopes[0].path);
            body = format!("own({}) {} {body}", scopes[0].path, random.one(&["&", "|", "->"]));
        }
        self.text += &format!(" {{\n  {inner}{quantifiers}\n  {body}{wish}\n}}\n");
    }
}

/// A use of a template: the one of the file, or one that is built in.
fn instance(random: &mut Random, system: &System) -> String {
    let label = |random: &mut Random| system.labels[random.below(system.labels.len())].clone();
    let (a, b, c) = (label(random), label(random), label(random));
    let steps = random.one(&["1", "T", "D"]);
    match random.below(7) {
        0 => format!("shortest_path({a}, {b}, {steps})"),
        1 => format!("longest_path({a}, {b}, {steps})"),
        2 => format!("initial_state_robust({a}, {b}, {c}, {b}, {steps})"),
        3 => format!("action_robust({a}, {b}, {c}, {steps})"),
        4 if system.observes => format!("initial_state_opaque({a}, {b}, {steps})"),
        5 if system.observes => format!("current_state_opaque({a}, {b}, {steps})"),
        _ => format!("t({a}, {b}, {steps})"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyperplan_problem::{Overrides, read};
    use hyperplan_syntax::SourceMap;

    #[test]
    fn most_have_a_meaning() {
        let (mut good, mut seen) = (0, String::new());
        let mut codes = BTreeMap::<&str, u32>::new();
        for seed in 0..400 {
            let whole = Whole::random(&mut Random::new(seed));
            let file = |path: &str| whole.file(path);
            let lowered = read(&mut SourceMap::new(), "whole.hp", &whole.text, &file, &Overrides::default());
            good += u32::from(!lowered.has_errors());
            for error in lowered.diagnostics.iter().filter(|d| d.is_error()) {
                *codes.entry(error.code).or_default() += 1;
            }
            seen += &whole.text;
            whole.files.values().for_each(|file| seen += file);
        }
        assert!(good > 380, "only {good} of 400 have a meaning; {codes:?}");
        let words = [
            "= grid {",
            "= grid(",
            "= graph(",
            "legend",
            "corner",
            "inflate",
            "clearance",
            ": action",
            "scale T",
            "crop 0..",
            "crash",
            "template t",
            " = t(",
            "action_robust",
            "semantics hopt",
            "define own",
            "d0(",
            ": S1.",
            "absorb",
            "observe",
            "obs[",
            "enabled[",
            "room A",
            "FeatureCollection",
            "\"links\"",
            ": int",
            ": real",
            " M[",
            "on *",
            "also on *",
            "length div",
            "cost c =",
            "cost c[",
            "minimize",
            "init",
            "div",
        ];
        for word in words {
            assert!(seen.contains(word), "{word} is never made");
        }
        // Without choices all are the first.
        assert!(!Whole::random(&mut Random::of(Vec::new())).text.is_empty());
    }
}
