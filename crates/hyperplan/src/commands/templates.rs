//! `hyperplan templates`: the prelude.

use crate::args;
use crate::failure::{Exit, Failure, Result};
use crate::output::Output;
use hyperplan_problem::prelude::TEXT as PRELUDE;
use hyperplan_syntax::ast::{Item, Template};
use hyperplan_syntax::{SourceId, parse};

pub(crate) fn run(args: &args::Templates, out: &mut Output) -> Result {
    let text = match &args.name {
        None => PRELUDE.to_owned(),
        Some(name) => one(name)?,
    };
    out.line(text.trim_end())?;
    Ok(Exit::Good)
}

/// A template with the comment above it, as written.
fn one(name: &str) -> Result<String> {
    let (file, _) = parse(SourceId(0), PRELUDE);
    let templates = file.items.iter().filter_map(|item| match item {
        Item::Template(template) => Some(template),
        _ => None,
    });
    let templates: Vec<&Template> = templates.collect();
    let Some(found) = templates.iter().find(|t| t.name.name == name) else {
        let names: Vec<&str> = templates.iter().map(|t| t.name.name.as_str()).collect();
        return Err(Failure::input(format_args!(
            "there is no template `{name}`; there are {}",
            names.join(", ")
        )));
    };
    let starts = templates.iter().map(|t| start_of(t));
    let start = start_of(found);
    let end = starts.filter(|s| *s > start).min().unwrap_or(PRELUDE.len());
    Ok(PRELUDE[start..end].to_owned())
}

/// Where a template begins, with the comment lines directly above it.
fn start_of(template: &Template) -> usize {
    let name = template.name.span.range().start.min(PRELUDE.len());
    let mut start = PRELUDE[..name].rfind('\n').map_or(0, |i| i + 1);
    while let Some(before) = PRELUDE[..start].strip_suffix('\n') {
        let line = before.rfind('\n').map_or(0, |i| i + 1);
        if !before[line..].trim_start().starts_with("//") {
            break;
        }
        start = line;
    }
    start
}
