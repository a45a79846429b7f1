//! Explanations in words.

use super::{Subject, Told};
use crate::load::Loaded;
use crate::report::{WIDTH, is_drawable, paths_text};
use hyperplan_outlet::one_line;
use hyperplan_plan::Verdict;
use hyperplan_plan::explain::{
    Candidate, Choice, Closest, Core, Difference, Explanation, Failing, Failure, Judged, Later, Opponents,
    Scope, Time, Wall,
};
use hyperplan_problem::{ActionId, FormulaId, Objective, PathId, Problem, State, Trace, display};
use hyperplan_render::{Board, Scene};
use hyperplan_syntax::{Diagnostic, render};
use hyperplan_verify::Defeat;

/// Longer parts are cut.
const PART: usize = 60;
/// So many states, differences and starts are listed.
const LISTED: usize = 20;
const FEW: usize = 5;

/// A part as it reads with its paths, on one line.
pub(super) fn part_text(loaded: &Loaded, objective: &Objective, part: FormulaId) -> String {
    one_line(&display::formula(&loaded.problem, objective, part)).into_owned()
}

/// The line of it that `solve` prints.
pub(crate) fn in_short(loaded: &Loaded, objective: &Objective, found: &Explanation) -> Option<String> {
    let text = |part: &FormulaId| format!("`{}`", cut(&part_text(loaded, objective, *part)));
    let all = |parts: &[FormulaId]| {
        let first: Vec<String> = parts.iter().take(FEW).map(text).collect();
        match parts.len() {
            0..=FEW => first.join(", "),
            more => format!("{}, and {} more", first.join(", "), more - FEW),
        }
    };
    if let Some(core) = &found.core {
        let parts = all(&core.parts);
        let more = "`hyperplan explain` says more";
        return Some(match core.parts.len() {
            1 if core.scope == Scope::Game => {
                format!("why: against the other paths nothing makes sure of {parts}; {more}")
            }
            1 => format!("why: {parts} cannot be met; {more}"),
            _ if core.minimal => format!("why: {parts} exclude each other; {more}"),
            // Which of them do was not found out so soon, and that all do is no news.
            _ => "why: `hyperplan explain` says, given time".to_owned(),
        });
    }
    let failure = found.counterexample.as_ref()?;
    let first = failure.parts.first()?;
    Some(match first.time {
        Some(time) => format!("why: {} fails at time {time}", text(&first.part)),
        None => {
            let parts: Vec<FormulaId> = failure.parts.iter().map(|failing| failing.part).collect();
            let parts = all(&parts);
            format!("why: whatever the other paths are, they do not meet {parts}")
        }
    })
}

fn cut(text: &str) -> String {
    match text.char_indices().nth(PART) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text.to_owned(),
    }
}

pub(super) struct Words<'a> {
    pub(super) told: &'a Told<'a>,
    pub(super) color: bool,
}

impl Words<'_> {
    pub(super) fn text(&self) -> String {
        let Told { objective, subject, .. } = self.told;
        let name = &objective.name;
        match subject {
            Subject::Answer { verdict, reason, notes, found } => {
                let said = match verdict {
                    Verdict::Realizable => "realizable",
                    Verdict::Unrealizable => "unrealizable",
                    Verdict::Unknown => "unknown",
                };
                let mut text = format!("{name}: {said}");
                text +=
                    &reason.as_ref().map_or_else(String::new, |why| format!(": {}", one_line(&why.words)));
                text.push('\n');
                if *verdict == Verdict::Realizable {
                    text += "there is nothing to explain; `hyperplan solve` shows how\n";
                }
                notes.iter().for_each(|note| text += &format!("note: {}\n", one_line(note)));
                text += &self.explanation(found);
                let certificates = &self.told.certificates;
                let named: Vec<String> =
                    certificates.iter().map(|file| format!("certificate: {}\n", one_line(file))).collect();
                if named.is_empty() { text } else { format!("{text}\n{}", named.concat()) }
            }
            Subject::Given { judged: Judged::Holds, role } => format!("{name}: the {role} holds\n"),
            Subject::Given { judged: Judged::TooLarge, role } => {
                format!("{name}: undecided: the {role} takes more than the checker's budget\n")
            }
            Subject::Given { judged: Judged::Fails(failure), role } => {
                let reason = failure.defeat.as_ref().map(|defeat| defeat.describe(objective));
                let reason = reason.unwrap_or_default();
                format!("{name}: the {role} fails: {}\n{}", one_line(&reason), self.failure(failure))
            }
        }
    }

    fn explanation(&self, found: &Explanation) -> String {
        let mut text = String::new();
        let mut add = |more: String| {
            if !more.is_empty() {
                text.push('\n');
                text += &more;
            }
        };
        add(found.core.as_ref().map_or_else(String::new, |core| self.core(core)));
        add(found.wall.as_ref().map_or_else(String::new, |wall| self.wall(wall)));
        add(render(&self.told.loaded.sources, &found.demanded, self.color, WIDTH));
        add(found.opponents.as_ref().map_or_else(String::new, |opponents| self.opponents(opponents)));
        add(found.candidate.as_ref().map_or_else(String::new, |candidate| self.candidate(candidate)));
        add(found.counterexample.as_ref().map_or_else(String::new, |failure| self.failure(failure)));
        add(found.later.iter().map(later).collect());
        add(found.open.iter().map(|open| format!("not found out: {open}\n")).collect());
        text
    }

    fn part(&self, part: FormulaId) -> String {
        part_text(self.told.loaded, self.told.objective, part)
    }

    fn name(&self, path: PathId) -> String {
        one_line(&self.told.objective.paths[path].name).into_owned()
    }

    fn state(&self, path: PathId, state: &State) -> String {
        let system = &self.told.loaded.problem.systems[self.told.objective.paths[path].system];
        one_line(&display::state(system, state)).into_owned()
    }

    /// A message with parts marked where they are written. What stands there in other words, as where a definition is used, is
    /// said beside it.
    fn marked(&self, code: &'static str, message: String, parts: &[FormulaId]) -> String {
        let Told { loaded, objective, .. } = self.told;
        let mut places: Vec<(hyperplan_syntax::Span, Vec<String>)> = Vec::new();
        let message = match parts.len().checked_sub(LISTED) {
            Some(more) if more > 0 => format!("{message} ({more} more are not marked)"),
            _ => message,
        };
        for &part in parts.iter().take(LISTED) {
            let (span, text) = (objective.formula.spans[part], self.part(part));
            let words: Vec<&str> = loaded.sources.snippet(span).split_whitespace().collect();
            let said = if words.join(" ") == text { Vec::new() } else { vec![cut(&text)] };
            match places.iter_mut().find(|(other, _)| *other == span) {
                Some((_, texts)) => texts.extend(said),
                None => places.push((span, said)),
            }
        }
        let mut places = places.into_iter();
        let Some((span, said)) = places.next() else { return message + "\n" };
        let mut note = Diagnostic::note(code, span, message).with_label(said.join("; "));
        note.related = places.map(|(span, said)| (span, said.join("; "))).collect();
        render(&loaded.sources, &[note], self.color, WIDTH)
    }

    fn core(&self, core: &Core) -> String {
        let several = self.told.objective.blocks().len() > 1;
        let mut message = match (core.parts.len(), core.scope) {
            (1, Scope::Leading) => "this part cannot be met".to_owned(),
            (_, Scope::Leading) => "these parts exclude each other".to_owned(),
            (1, Scope::All) => "no choice of paths meets this part".to_owned(),
            (_, Scope::All) => "no choice of paths meets these parts together".to_owned(),
            (1, Scope::Game) => "this part cannot be met against the other player".to_owned(),
            (_, Scope::Game) => "these parts cannot be met together against the other player".to_owned(),
        };
        match (core.minimal, core.parts.len()) {
            (true, 1) => {}
            (true, _) => message += ", and none of them can be left out for that",
            (false, _) => message += "; perhaps not all of them are needed for that",
        }
        if several && core.scope == Scope::Leading {
            message += "; no other player is needed, the leading paths fail alone";
        }
        self.marked("conflict", message, &core.parts)
    }

    fn wall(&self, wall: &Wall) -> String {
        let path = self.name(wall.path);
        let system = &self.told.loaded.problem.systems[self.told.objective.paths[wall.path].system];
        let part = cut(&self.part(wall.part));
        let board = Board::of(system).ok();
        let reached = wall.reached.len();
        let (count, what) = match &board {
            Some(board) => {
                let mut cells: Vec<_> = wall.reached.iter().filter_map(|state| board.cell(state)).collect();
                cells.sort_unstable();
                cells.dedup();
                let free = u64::from(board.width) * u64::from(board.height) - board.obstacles.len() as u64;
                (cells.len(), format!("of the {free} cells that are free"))
            }
            None => (reached, format!("of the {} states that there are", wall.states)),
        };
        let mut text = format!(
            "`{part}` is never met, however much time there is: {path} reaches {count} {what}, and none is enough\n"
        );
        match board.filter(|_| is_drawable(system)) {
            Some(board) => text += &picture(&board, &wall.reached),
            None => {
                for state in wall.reached.iter().take(LISTED) {
                    text += &format!("  {}\n", self.state(wall.path, state));
                }
                if reached > LISTED {
                    text += &format!("  and {} more\n", reached - LISTED);
                }
            }
        }
        text
    }

    fn choice(&self, choice: &Choice) -> String {
        choice_text(&self.told.loaded.problem, self.told.objective, choice)
    }

    fn opponents(&self, found: &Opponents) -> String {
        let (mut starts, mut steps) = (Vec::new(), Vec::new());
        for choice in &found.choices {
            match choice {
                Choice::Start(path, _) if !found.starts.contains(path) => {}
                Choice::Start(..) => starts.push(self.choice(choice)),
                Choice::Replaced(..) => steps.push(self.choice(choice)),
            }
        }
        let mut kinds = Vec::new();
        if !found.steps.is_empty() && steps.is_empty() {
            let names: Vec<String> = found.steps.iter().map(|&path| self.name(path)).collect();
            kinds.push(format!("no action of {} need be another", names.join(" and ")));
        }
        let one = starts.len() + steps.len() == 1;
        for list in [steps, starts] {
            match list.len() {
                0 => {}
                1..=FEW => kinds.extend(list),
                more => {
                    kinds.extend(list.into_iter().take(FEW));
                    kinds.push(format!("{} more of this kind", more - FEW));
                }
            }
        }
        let all = match (one, found.minimal) {
            (true, _) => "every candidate is defeated by one kind of opponent alone",
            (false, true) => {
                "every candidate is defeated even if the other player chooses nothing but these, and needs all of them"
            }
            (false, false) => {
                "every candidate is defeated even if the other player chooses nothing but these"
            }
        };
        format!("{all}:\n  {}\n", kinds.join("\n  "))
    }

    fn candidate(&self, candidate: &Candidate) -> String {
        let how = match candidate.spared.as_deref() {
            Some(choices) if choices.len() <= FEW => {
                let choices: Vec<String> = choices.iter().map(|choice| self.choice(choice)).collect();
                format!("it wins against any but {}", choices.join(", and "))
            }
            Some(choices) => {
                format!("it wins unless the other player makes one of {} choices", choices.len())
            }
            None => "it does what the objective asks of it alone".to_owned(),
        };
        let names = candidate.strategy.traces.iter().map(|trace| self.name(trace.path));
        let names = names.collect::<Vec<_>>().join(", ");
        format!("a candidate for {names}: {how}, and is defeated so:\n{}", self.failure(&candidate.failure))
    }

    fn failure(&self, failure: &Failure) -> String {
        let mut text = String::new();
        for failing in failure.parts.iter().take(FEW) {
            if let Failing { part, time: Some(time) } = failing {
                text += &self.marked("fails", format!("this part fails at time {time}"), &[*part]);
            }
        }
        let open: Vec<FormulaId> = failure
            .parts
            .iter()
            .filter(|failing| failing.time.is_none())
            .map(|failing| failing.part)
            .collect();
        if !open.is_empty() {
            let rest = self.told.objective.paths.iter_enumerated().skip(failure.paths.len());
            let rest = rest.map(|(path, _)| self.name(path)).collect::<Vec<_>>().join(", ");
            let message = match open.len() {
                1 => format!("this part fails whatever {rest} is"),
                _ => format!("these parts exclude each other whatever {rest} is"),
            };
            text += &self.marked("fails", message, &open);
        }
        failure.differences.iter().for_each(|difference| text += &self.difference(difference));
        if matches!(
            failure.defeat,
            Some(Defeat::NotInitial { .. } | Defeat::NoTransition { .. } | Defeat::DeadEnd { .. })
        ) {
            return text;
        }
        let scene = |traces: &'_ [Trace]| {
            let (problem, objective) = (&self.told.loaded.problem, Some(self.told.objective));
            paths_text(Scene { problem, objective, traces, note: "" }, self.color)
        };
        text + &scene(&failure.paths)
    }

    fn difference(&self, difference: &Difference) -> String {
        let Difference { path, from, starts, actions } = difference;
        let (own, other) = (self.name(*path), self.name(*from));
        let mut text = String::new();
        if let Some((start, others)) = starts {
            let (start, others) = (self.state(*path, start), self.state(*from, others));
            text += &format!("{own} begins in {start}, {other} in {others}\n");
        }
        let action = |action: ActionId| one_line(&self.told.loaded.problem.actions[action]).into_owned();
        for &(time, did, instead) in actions.iter().take(FEW) {
            text += &format!("{own} does {} instead of {} at time {time}\n", action(did), action(instead));
        }
        if actions.len() > FEW {
            text += &format!("{own} does otherwise {} times more\n", actions.len() - FEW);
        }
        text
    }
}

/// Paths of the other player that make a choice.
fn choice_text(problem: &Problem, objective: &Objective, choice: &Choice) -> String {
    let name = |path: PathId| one_line(&objective.paths[path].name);
    match choice {
        Choice::Start(path, state) => {
            let system = &problem.systems[objective.paths[*path].system];
            format!("{} that begins in {}", name(*path), one_line(&display::state(system, state)))
        }
        Choice::Replaced(path, from, time) => {
            format!("{} that does something else than {} at time {time}", name(*path), name(*from))
        }
    }
}

/// The line above a candidate that `solve` prints where nothing was decided.
pub(crate) fn closest(problem: &Problem, objective: &Objective, closest: &Closest) -> String {
    let names = closest.strategy.traces.iter().map(|trace| one_line(&objective.paths[trace.path].name));
    let choices = closest.spared.iter().map(|choice| choice_text(problem, objective, choice));
    let (names, choices) = (names.collect::<Vec<_>>().join(", "), choices.collect::<Vec<_>>().join(", "));
    format!("a candidate for {names}: it wins against any but {choices}")
}

/// What more time would do.
fn later(later: &Later) -> String {
    let Later { time, now, least, refuted } = later;
    let with = |value: String| match time {
        Time::Constant(name) => format!("{} = {value} instead of {now}", one_line(name)),
        Time::Within => format!("`within {value}` instead of {now}"),
        Time::Interval => format!("{value} instead of {now} as the end of intervals"),
        Time::Bound => format!("--bound {value} instead of {now}"),
    };
    match least {
        Some(least) if later.is_proved() => {
            format!("more time helps: realizable with {}, the least\n", with(least.to_string()))
        }
        Some(least) => format!(
            "more time helps: realizable with {}; whether less than that would do is not known\n",
            with(least.to_string())
        ),
        None if refuted > now => {
            let values = with(format!("{}..{refuted}", now + 1));
            format!("more time does not help so far: unrealizable with {values}, too\n")
        }
        None => {
            format!("not found out: whether more time would help, such as {}\n", with((now + 1).to_string()))
        }
    }
}

/// A map of the cells that are reached: `+`, but for those with a letter of their own. The bottom row is the last.
fn picture(board: &Board, reached: &[State]) -> String {
    let (width, height) = (board.width as usize, board.height as usize);
    let mut cells = vec!['.'; width * height];
    let at = |(x, y): (u32, u32)| y as usize * width + x as usize;
    let on = reached.iter().filter_map(|state| board.cell(state));
    on.for_each(|cell| cells[at(cell)] = '+');
    for mark in board.marks.iter().rev() {
        mark.cells.iter().for_each(|&cell| cells[at(cell)] = mark.letter);
    }
    board.obstacles.iter().for_each(|&cell| cells[at(cell)] = '#');
    let rows = (0..height).rev().map(|y| cells[y * width..(y + 1) * width].iter().collect::<String>());
    rows.map(|row| format!("  {row}\n")).collect()
}
