//! A page: the paths of a plan with a slider for the time, what the objective's parts come to, and a menu of what it copes
//! with. One file that needs no network; the template escapes all text.

use crate::drawing::Drawing;
use crate::mover::Mover;
use crate::panel::Purpose;
use crate::table::{columns, in_words, row};
use crate::{Error, Scene};
use askama::Template;
use hyperplan_outlet::one_line;
use hyperplan_problem::{Expr, Leaf, Objective, Problem, State, System, Trace, Type, display};
use serde::Serialize;

/// The most steps on a page.
const MOST_STEPS: usize = 5_000;
/// The most bytes of pictures besides the first; more variants are left out.
const MOST_BYTES: usize = 6_000_000;

/// What a page shows.
#[derive(Clone, Debug)]
pub struct Page<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// The objective.
    pub objective: &'a Objective,
    /// What is said above, such as horizons.
    pub facts: Vec<String>,
    /// The paths, and other paths that may be there instead; the first is shown at first.
    pub variants: Vec<Variant>,
}

/// Paths that are shown together.
#[derive(Clone, Debug)]
pub struct Variant {
    /// What the menu calls them.
    pub name: String,
    /// The paths.
    pub traces: Vec<Trace>,
    /// What legends say of those that are not the strategy's.
    pub note: &'static str,
    /// What the objective's parts come to on them.
    pub parts: Vec<Part>,
}

/// A part of the objective on some paths.
#[derive(Clone, Debug, Serialize)]
pub struct Part {
    /// The part, as the language has it.
    pub words: String,
    /// In how many others it stands.
    pub depth: usize,
    /// Whether it speaks of one time, and the values are of that time. Else they are what is known of it so far.
    pub present: bool,
    /// Its truth at each time.
    pub values: Vec<Option<bool>>,
}

#[derive(Template)]
#[template(path = "plan.html")]
struct Filled<'a> {
    style: &'static str,
    script: &'static str,
    title: String,
    formula: String,
    facts: &'a [String],
    last: usize,
    paths: usize,
    menu: String,
    variants: Vec<&'a str>,
    svg: String,
    data: String,
}

/// What the page's script needs.
#[derive(Serialize)]
struct Data<'a> {
    variants: Vec<Shown<'a>>,
}

#[derive(Serialize)]
struct Shown<'a> {
    svg: String,
    last: usize,
    movers: Vec<Moving>,
    paths: Vec<Path>,
    parts: &'a [Part],
    /// Whether an observer sees the same of all paths, at each time.
    #[serde(skip_serializing_if = "Option::is_none")]
    same: Option<Vec<bool>>,
}

#[derive(Serialize)]
struct Moving {
    svg: String,
    path: Option<String>,
    at: Vec<(f64, f64)>,
}

#[derive(Serialize)]
struct Path {
    name: String,
    columns: Vec<String>,
    rows: Vec<Vec<String>>,
}

/// The page.
///
/// # Errors
/// If there is nothing to draw, or too much.
pub fn page(page: &Page<'_>) -> Result<String, Error> {
    let mut shown: Vec<Shown<'_>> = Vec::new();
    let mut bytes = 0;
    for variant in &page.variants {
        let one = page.shown(variant, shown.is_empty())?;
        bytes += if shown.is_empty() { 0 } else { one.svg.len() };
        if bytes > MOST_BYTES {
            break;
        }
        shown.push(one);
    }
    let Some(first) = shown.first() else { return Err(Error::NothingMoves) };
    let failed = |reason: String| Error::Format { format: "HTML", reason };
    let (svg, last, paths) = (first.svg.clone(), first.last, first.paths.len());
    let names: Vec<&str> =
        page.variants.iter().take(shown.len()).map(|variant| variant.name.as_str()).collect();
    let data = serde_json::to_string(&Data { variants: shown }).map_err(|error| failed(error.to_string()))?;
    let others = page.objective.paths.iter_enumerated();
    let others = others.filter(|(id, _)| !page.objective.leading_block().contains(id));
    let others: Vec<&str> = others.map(|(_, path)| path.name.as_str()).collect();
    let filled = Filled {
        style: include_str!("../templates/plan.css"),
        script: include_str!("../templates/plan.js"),
        title: one_line(&page.objective.name).into_owned(),
        formula: display::objective(page.problem, page.objective),
        facts: &page.facts,
        last,
        paths,
        menu: others.join(", "),
        variants: names,
        svg,
        // Nothing in it may end the element in which it stands.
        data: data.replace('<', "\\u003c"),
    };
    filled.render().map_err(|error| failed(error.to_string()))
}

impl Page<'_> {
    fn shown<'v>(&self, variant: &'v Variant, areas: bool) -> Result<Shown<'v>, Error> {
        let (problem, objective) = (self.problem, self.objective);
        let scene =
            Scene { problem, objective: Some(objective), traces: &variant.traces, note: variant.note };
        let longest = variant.traces.iter().max_by_key(|trace| trace.states.len());
        if let Some(longest) = longest.filter(|trace| trace.actions.len() > MOST_STEPS) {
            let path = objective.paths[longest.path].name.clone();
            return Err(Error::TooLong { path, steps: longest.actions.len(), limit: MOST_STEPS });
        }
        let drawing = Drawing::of(scene)?;
        let (document, movers) = drawing.document(Purpose { bitmaps: true, film: false, bare: !areas });
        let moving = |mover: &Mover| Moving {
            svg: mover.drawn().to_string(),
            path: match mover {
                Mover::Robot { name, .. } => Some(name.clone()),
                Mover::Cursor { .. } => None,
            },
            at: mover.at().to_vec(),
        };
        Ok(Shown {
            svg: document.to_string(),
            last: longest.map_or(0, |trace| trace.actions.len()),
            movers: movers.iter().map(moving).collect(),
            paths: variant.traces.iter().map(|trace| self.path(trace)).collect(),
            parts: &variant.parts,
            same: self.same(&variant.traces),
        })
    }

    fn path(&self, trace: &Trace) -> Path {
        let path = &self.objective.paths[trace.path];
        let system = &self.problem.systems[path.system];
        let mut columns = columns(system);
        let mut rows: Vec<Vec<String>> =
            (0..trace.states.len()).map(|time| row(self.problem, system, trace, time)).collect();
        if !system.observe.is_empty() {
            columns.push("observer sees".to_owned());
            for (row, state) in rows.iter_mut().zip(&trace.states) {
                row.push(observed(system, state).join(", "));
            }
        }
        Path { name: one_line(&path.name).into_owned(), columns, rows }
    }

    /// Where all paths are of one system that is observed: whether they look the same.
    fn same(&self, traces: &[Trace]) -> Option<Vec<bool>> {
        let system = self.objective.paths.get(traces.first()?.path)?.system;
        let all = traces.iter().all(|trace| self.objective.paths[trace.path].system == system);
        let system = Some(&self.problem.systems[system])
            .filter(|s| all && traces.len() > 1 && !s.observe.is_empty())?;
        let end = traces.iter().map(|trace| trace.states.len()).min()?;
        let looks = |trace: &Trace, time: usize| observed(system, &trace.states[time]);
        Some(
            (0..end)
                .map(|time| traces.windows(2).all(|two| looks(&two[0], time) == looks(&two[1], time)))
                .collect(),
        )
    }
}

/// What an observer sees of a state, in words.
fn observed(system: &System, state: &State) -> Vec<String> {
    let words = |expr: &Expr<Leaf>| {
        let value = system.evaluate(expr, &|var| state.get(usize::from(var)).copied());
        // Only what is a variable's value has a name.
        let named = match expr {
            Expr::Leaf(leaf) => system.leaf_type(*leaf),
            _ => &Type::Int,
        };
        value.map_or_else(|| "?".to_owned(), |value| in_words(named, value))
    };
    system.observe.iter().map(words).collect()
}
