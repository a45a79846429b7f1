//! `hyperplan plot`: the map with the paths of a strategy, and of all that it has to cope with the worst.

use crate::args;
use crate::config;
use crate::failure::{Exit, Failure, Result};
use crate::files::check_writable;
use crate::guard;
use crate::load::{Given, Loaded};
use crate::output::Output;
use crate::pictures::{Picture, draw, frames};
use hyperplan::draw::Subject;
use hyperplan_problem::{Objective, Strategy};
use hyperplan_render::TextStyle;

pub(crate) fn run(args: &args::Plot, out: &mut Output) -> Result {
    let picture = args.output.as_deref().map(Picture::new).transpose()?;
    let picture = if args.animate { picture.map(Picture::animated).transpose()? } else { picture };
    if let Some(path) = &args.output {
        check_writable(path)?;
    }
    config::deadline(args.limit.timeout, None)?;
    let loaded = Loaded::read(&args.problem, out)?;
    let wanted = args.selection.objective.as_deref();
    let given = Given::of(&args.plan)?;
    let strategies = match &given {
        Some(given) => given.strategies(&loaded, wanted)?,
        None => Vec::new(),
    };
    let strategies = chosen(strategies, args.number)?;
    let objective = match (strategies.first(), wanted) {
        (Some((objective, _)), _) => Some(*objective),
        (None, Some(name)) => loaded.selected(Some(name), false)?.first().copied(),
        (None, None) => None,
    };
    if !args.path.is_empty() && strategies.is_empty() {
        return Err(Failure::input("--path chooses paths of a strategy; give one"));
    }
    guard::doing("drawing");
    let strategy = strategies.first().map(|(_, strategy)| strategy);
    let subject = Subject { problem: &loaded.problem, objective, strategy, named: &args.path };
    if let Some(picture) = &picture {
        draw(&subject, picture)?;
    }
    if let Some(folder) = &args.frames {
        frames(&subject, folder, picture.as_ref().is_some_and(Picture::is_svg))?;
    }
    if picture.is_none() && args.frames.is_none() {
        let text = subject.text(TextStyle { color: out.color }).map_err(Failure::input)?;
        out.write(|w| w.write_all(text.as_bytes()))?;
    }
    Ok(Exit::Good)
}

/// The strategy that is meant, if there are some.
fn chosen(
    mut strategies: Vec<(&Objective, Strategy)>,
    number: Option<u16>,
) -> Result<Vec<(&Objective, Strategy)>> {
    let mut names: Vec<&str> = strategies.iter().map(|(objective, _)| objective.name.as_str()).collect();
    names.dedup();
    if names.len() > 1 {
        return Err(Failure::input(
            "the strategy file answers several objectives; choose one with --objective NAME",
        ));
    }
    match (number.map(usize::from), strategies.len()) {
        (Some(number), several) if number > several => {
            Err(Failure::input(format_args!("there is no strategy {number}: the file has {several}")))
        }
        (Some(number), _) => Ok(vec![strategies.swap_remove(number - 1)]),
        (None, 0 | 1) => Ok(strategies),
        (None, several) => Err(Failure::input(format_args!(
            "the file has {several} strategies; choose one with --number N, from 1"
        ))),
    }
}
