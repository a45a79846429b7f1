//! `hyperplan plot`: the map with the paths of a strategy.

use crate::args;
use crate::config;
use crate::failure::{Exit, Failure, Result};
use crate::files::check_writable;
use crate::guard;
use crate::load::{Given, Loaded};
use crate::output::Output;
use crate::report::{Picture, write_picture};
use hyperplan_render::{Scene, TextStyle, text_map};

pub(crate) fn run(args: &args::Plot, out: &mut Output) -> Result {
    let picture = args.output.as_deref().map(Picture::new).transpose()?;
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
    if strategies.len() > 1 {
        return Err(Failure::input(
            "the strategy file answers several objectives; choose one with --objective NAME",
        ));
    }
    let objective = match (strategies.first(), wanted) {
        (Some((objective, _)), _) => Some(*objective),
        (None, Some(name)) => loaded.selected(Some(name), false)?.first().copied(),
        (None, None) => None,
    };
    let traces = strategies.first().map_or(&[][..], |(_, strategy)| &strategy.traces);
    guard::doing("drawing");
    let scene = Scene { problem: &loaded.problem, objective, traces };
    match picture {
        Some(picture) => write_picture(scene, &picture)?,
        None => {
            let text = text_map(scene, TextStyle { color: out.color }).map_err(Failure::input)?;
            out.write(|w| w.write_all(text.as_bytes()))?;
        }
    }
    Ok(Exit::Good)
}
