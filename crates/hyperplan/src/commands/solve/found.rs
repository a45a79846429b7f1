//! How an answer is printed, drawn and saved.

use super::plan_format;
use crate::args::SolveFormat;
use crate::commands::explain::closest;
use crate::failure::Result;
use crate::files::write_bytes;
use crate::load::Loaded;
use crate::nusmv;
use crate::output::Output;
use crate::parameter::Searched;
use crate::pictures::{self, Picture};
use crate::plans;
use crate::report::{json, paths_text, role};
use hyperplan::draw::Subject;
use hyperplan::foreign::Foreign;
use hyperplan_outlet::one_line;
use hyperplan_plan as plan;
use hyperplan_problem::answer::plans::PlanFormat;
use hyperplan_problem::answer::{
    Answer, Below, Case, CostValue, More, Other, Seconds, Several, Size, Verdict, Verified, WitnessPath,
    to_witness,
};
use hyperplan_problem::{Objective, Quantifier, Strategy};
use hyperplan_render::Scene;
use std::borrow::Cow;
use std::collections::BTreeSet;
use std::path::Path;

/// An outcome and all it takes to print it.
pub(super) struct Found<'a> {
    pub(super) loaded: &'a Loaded,
    pub(super) objective: &'a Objective,
    pub(super) outcome: &'a plan::Outcome,
    /// Strategies besides that of the outcome.
    pub(super) others: &'a [Strategy],
    pub(super) answer: &'a Answer,
    pub(super) searched: Option<&'a Searched>,
    /// Why there is no strategy, or how the counterexample makes the objective fail, on one line.
    pub(super) reason: Option<String>,
    /// The files of another tool, if it was these.
    pub(super) foreign: Option<&'a Foreign>,
}

impl<'a> Found<'a> {
    fn scene<'s>(&self, strategy: &'s Strategy) -> Scene<'s>
    where
        'a: 's,
    {
        let problem = &self.loaded.problem;
        Scene { problem, objective: Some(self.objective), traces: &strategy.traces, note: "" }
    }

    /// The strategies, or counterexamples.
    fn strategies(&self) -> impl Iterator<Item = &'a Strategy> {
        self.outcome.witness.iter().chain(self.others)
    }

    /// Draws each strategy; where several were asked for, into files of their own.
    pub(super) fn draw(&self, picture: &Picture) -> Result<()> {
        let draw = |(number, strategy): (usize, &Strategy)| {
            let subject = Subject {
                problem: &self.loaded.problem,
                objective: Some(self.objective),
                strategy: Some(strategy),
                named: &[],
            };
            match self.answer.several {
                Some(_) => pictures::draw(&subject, &picture.with_name(&number.to_string())),
                None => pictures::draw(&subject, picture),
            }
        };
        (1..).zip(self.strategies()).map(draw).fold(Ok(()), Result::and)
    }

    /// The paths as others want them: nothing of what comes after they were absorbed.
    fn plan(&self, strategy: &Strategy) -> Vec<WitnessPath> {
        let cut = plans::without_rest(&self.loaded.problem, self.objective, strategy);
        to_witness(&self.loaded.problem, self.objective, &cut)
    }

    /// Prints the answer, or the strategy alone; what became of the objective is a remark then.
    pub(super) fn print(
        &self,
        format: SolveFormat,
        (verbose, quiet): (bool, bool),
        out: &mut Output,
    ) -> Result<()> {
        match (plan_format(format), format) {
            (Some(format), _) => {
                out.remark(self.verdict_line());
                let Some(strategy) = &self.outcome.witness else { return Ok(()) };
                out.verbatim(&self.written(format, &self.plan(strategy))?)
            }
            (None, SolveFormat::Nusmv) => {
                out.remark(self.verdict_line());
                let Some(paths) = &self.answer.witness else { return Ok(()) };
                let refutes = self.answer.verdict == Verdict::Unrealizable;
                let name = &self.objective.name;
                out.verbatim(&nusmv::traces(name, refutes, paths, &nusmv::originals(self.foreign)))
            }
            (None, SolveFormat::Json) => out.line(json(self.answer)?),
            (None, _) if quiet => out.line(self.verdict_line()),
            (None, _) => {
                let text = self.text(verbose, out.color);
                out.line(text.trim_end())
            }
        }
    }

    fn written(&self, format: PlanFormat, paths: &[WitnessPath]) -> Result<String> {
        format.write(&self.objective.name, paths).map_err(|error| plans::cannot(&error))
    }

    /// Saves the strategies alone, a file for each path.
    pub(super) fn save(&self, format: PlanFormat, path: &Path, several: bool) -> Result<()> {
        let named = if several { plans::with_name(path, &self.objective.name) } else { path.to_owned() };
        for (number, strategy) in (1..).zip(self.strategies()) {
            let numbered =
                self.answer.several.as_ref().map(|_| plans::with_name(&named, &number.to_string()));
            let paths = self.plan(strategy);
            for (file, own) in plans::files(numbered.as_ref().unwrap_or(&named), &paths).iter().zip(&paths) {
                let text = self.written(format, std::slice::from_ref(own))?;
                write_bytes(file, text.as_bytes())?;
            }
        }
        Ok(())
    }

    fn verdict_line(&self) -> String {
        let more = self.answer.several.as_ref().map(|several| format!("; {}", self.number(several)));
        self.verdict() + &more.unwrap_or_default()
    }

    /// How many strategies there are.
    fn number(&self, several: &Several) -> String {
        let role = role(self.objective);
        let found = match (several.others.len() + 1, role) {
            (1, _) => format!("1 {role}"),
            (number, "strategy") => format!("{number} strategies that differ in {}", several.differ),
            (number, _) => format!("{number} {role}s that differ in {}", several.differ),
        };
        match several.more {
            More::None => format!("{found}, and there are no others"),
            More::Unasked => found,
            More::Unknown => {
                let why = self.answer.reason.iter().map(|reason| format!(": {}", one_line(reason)));
                format!("{found}; whether there are others is unknown{}", why.collect::<String>())
            }
        }
    }

    fn verdict(&self) -> String {
        if let Some(searched) = self.searched {
            let words = format!("{}: {}", self.objective.name, one_line(&searched.words));
            let known = searched.minimized.below != Below::Unknown && self.answer.verdict != Verdict::Unknown;
            return match (self.answer.costs.is_empty(), self.reason().filter(|_| known)) {
                (true, None) => words,
                (true, Some(why)) => format!("{words}; what is preferred is unknown: {why}"),
                (false, _) => format!("{words}; with {}", self.costs()),
            };
        }
        // Users of verifiers have words of their own.
        let verdict = match (self.answer.verdict, self.foreign) {
            (Verdict::Realizable, None) => "realizable",
            (Verdict::Realizable, Some(_)) => "realizable (holds)",
            (Verdict::Unrealizable, None) => "unrealizable",
            (Verdict::Unrealizable, Some(_)) => "unrealizable (violated)",
            (Verdict::Unknown, _) => "unknown",
        };
        let case =
            self.answer.case.map(|Case { index, of, .. }| format!("{verdict} in case {index} of {of}"));
        let verdict = case.as_deref().unwrap_or(verdict);
        if !self.answer.costs.is_empty() {
            return format!("{}: {verdict} with {}", self.objective.name, self.costs());
        }
        match self.reason() {
            Some(why) => format!("{}: {verdict}: {why}", self.objective.name),
            None => format!("{}: {verdict}", self.objective.name),
        }
    }

    /// Why the answer is not all that was asked for, but for what is told of others.
    fn reason(&self) -> Option<Cow<'_, str>> {
        let others = self.answer.several.as_ref().is_some_and(|several| several.more == More::Unknown);
        self.answer.reason.as_ref().filter(|_| !others).map(|reason| one_line(reason))
    }

    /// What the strategy costs, and whether that is the least.
    fn costs(&self) -> String {
        let all: Vec<String> = self.answer.costs.iter().map(cost_text).collect();
        all.join("; ") + &self.reason().map(|why| format!(": {why}")).unwrap_or_default()
    }

    fn text(&self, verbose: bool, color: bool) -> String {
        let mut text = self.verdict_line();
        text.push_str(&format!("\nhorizon: {}\n", self.horizons()));
        text.push_str(&self.witnesses(color));
        text.push_str(&self.closest(color));
        text.extend(self.reason.iter().map(|why| format!("{}\n", one_line(why))));
        text.push_str(&self.checked());
        match self.answer.certificates.as_slice() {
            [] => {}
            [one] => text.push_str(&format!("certificate: {}\n", one_line(one))),
            [first, .., last] => {
                text.push_str(&format!("certificates: {} to {}\n", one_line(first), one_line(last)))
            }
        }
        text.push_str(&self.effort(verbose));
        text
    }

    fn horizons(&self) -> String {
        let each = self.answer.horizon.0.iter().map(|(name, steps)| match steps {
            Some(steps) => format!("{name} {steps}"),
            None => format!("{name} not read"),
        });
        each.collect::<Vec<_>>().join(", ")
    }

    fn witnesses(&self, color: bool) -> String {
        let Some(first) = &self.outcome.witness else { return String::new() };
        let mut text = String::new();
        let others = self.answer.several.as_ref().map_or(&[][..], |several| &several.others);
        if !others.is_empty() {
            text += &format!("{} 1:\n", role(self.objective));
        } else if self.objective.paths.first().map(|p| p.quantifier) == Some(Quantifier::Forall) {
            text.push_str("counterexample:\n");
        }
        text += &format!("{}\n", paths_text(self.scene(first), color));
        for (number, (strategy, Other { costs, .. })) in (2..).zip(self.others.iter().zip(others)) {
            let costs: Vec<String> = costs.iter().map(cost_text).collect();
            let with = if costs.is_empty() { String::new() } else { format!(" with {}", costs.join("; ")) };
            text += &format!("{} {number}{with}:\n", role(self.objective));
            text += &format!("{}\n", paths_text(self.scene(strategy), color));
        }
        text
    }

    /// A candidate that comes close, where nothing was decided.
    fn closest(&self, color: bool) -> String {
        let Some(found) = &self.outcome.closest else { return String::new() };
        let line = closest(&self.loaded.problem, self.objective, found);
        format!("{line}\n{}\n", paths_text(self.scene(&found.strategy), color))
    }

    fn checked(&self) -> String {
        if self.answer.witness.is_none() {
            return String::new();
        }
        let Some(several) = &self.answer.several else { return checked(self.answer.verified).to_owned() };
        let all = [self.answer.verified].into_iter().chain(several.others.iter().map(|other| other.verified));
        let all: BTreeSet<&str> = all.map(checked).collect();
        all.into_iter().collect()
    }

    fn effort(&self, verbose: bool) -> String {
        let Answer { solver, quantifiers, states, iterations, size, seconds, .. } = self.answer;
        let rounds = if *iterations == 1 { "round" } else { "rounds" };
        let name = one_line(&format!("{} {}", solver.name, solver.version)).into_owned();
        let mut text = format!(
            "{}, quantifiers {quantifiers}, states {states}, {iterations} {rounds}, {:.3} s\n",
            name.trim_end(),
            seconds.total
        );
        if verbose {
            if let Some(because) = self.outcome.because {
                text.push_str(&format!("quantifiers {quantifiers}: {because}\n"));
            }
            let Seconds { read, encode, solve, verify, .. } = seconds;
            let Size { variables, clauses, bytes } = size;
            let text_size = bytes.map_or_else(String::new, |bytes| format!(", {bytes} bytes"));
            let logic = self.answer.logic.as_ref().map_or_else(String::new, |logic| format!(", {logic}"));
            text.push_str(&format!(
                "read {read:.3} s, encode {encode:.3} s, solve {solve:.3} s, verify {verify:.3} s\n\
                 largest query: {variables} variables, {clauses} clauses{text_size}{logic}\n"
            ));
        }
        text
    }
}

/// What a strategy costs, and whether that is the least.
fn cost_text(cost: &CostValue) -> String {
    let CostValue { expression, value, least } = cost;
    let least = match least < value {
        true => format!("; whether less is possible, down to {least}, is unknown"),
        false => ", the least".to_owned(),
    };
    format!("{expression} = {value}{least}")
}

/// How a witness was checked.
fn checked(verified: Option<Verified>) -> &'static str {
    match verified {
        Some(Verified::BySearch) => "verified by search\n",
        Some(Verified::BySolver) => "verified by a solver (too large to search)\n",
        None => "not verified\n",
    }
}
