//! Scenarios of the Moving AI Lab: start and goal on a map, one scenario a line.

use super::env::Env;
use super::files::load_text;
use super::grid::Cell;
use hyperplan_syntax::ast::Text;
use hyperplan_syntax::{Diagnostic, Span};

/// One scenario. Its columns count from the left and its rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Scenario {
    /// The map that it is for, as it names it.
    pub(super) map: String,
    /// Columns and rows of that map.
    pub(super) size: (u32, u32),
    pub(super) start: Cell,
    pub(super) goal: Cell,
    /// Its line.
    pub(super) span: Span,
}

/// What stands in a line, in this order.
const FIELDS: [&str; 9] = [
    "bucket",
    "map",
    "map's width",
    "map's height",
    "start's x",
    "start's y",
    "goal's x",
    "goal's y",
    "optimal length",
];

/// A scenario of a file, by its number from 1; `None` after a message.
pub(super) fn read(file: &Text, number: i64, at: Span, env: &mut Env) -> Option<Scenario> {
    let text = load_text(file, "a list of scenarios", env)?;
    let source = env.sources.add(file.text.clone(), text.as_str());
    let mut start = 0;
    let mut count = 0;
    for (index, line) in text.split_inclusive('\n').enumerate() {
        let span = Span::new(source, start..start + line.trim_end().len());
        start += line.len();
        let is_head = index == 0 && line.trim_start().to_lowercase().starts_with("version");
        if is_head || line.trim().is_empty() {
            continue;
        }
        count += 1;
        if count == number {
            return one(line.trim_end(), span).map_err(|wrong| env.diagnostics.push(*wrong)).ok();
        }
    }
    let message = match count {
        0 => format!("`{}` has no scenario", file.text),
        _ => format!("`{}` has the scenarios 1 to {count}, not {number}", file.text),
    };
    env.diagnostics.refuse(Diagnostic::error("unknown-scenario", at, message))
}

/// The scenario that a line gives. Names of maps may have blanks where tabs stand between the fields.
fn one(line: &str, span: Span) -> Result<Scenario, Box<Diagnostic>> {
    let bad = |message: String| Box::new(Diagnostic::error("bad-scenario", span, message));
    let fields: Vec<&str> = match line.contains('\t') {
        true => line.split('\t').map(str::trim).collect(),
        false => line.split_whitespace().collect(),
    };
    if fields.len() != FIELDS.len() {
        let message = format!("a scenario has {} fields, this line {}", FIELDS.len(), fields.len());
        let help = format!("they are, with tabs between them: {}", FIELDS.join(", "));
        return Err(Box::new(Diagnostic::error("bad-scenario", span, message).with_help(help)));
    }
    let number = |at: usize| {
        let (name, text) = (FIELDS[at], fields[at]);
        text.parse::<u32>().map_err(|_| bad(format!("the {name} is a number from 0 up, not `{text}`")))
    };
    Ok(Scenario {
        map: fields[1].to_owned(),
        size: (number(2)?, number(3)?),
        start: (number(4)?, number(5)?),
        goal: (number(6)?, number(7)?),
        span,
    })
}
