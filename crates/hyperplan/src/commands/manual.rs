//! `hyperplan completions` and `hyperplan man`: what shells and manual readers want to know of the command line.

use crate::args::{self, Cli};
use crate::failure::{Exit, Failure, Result};
use crate::files::{cannot_write, write};
use crate::output::Output;
use clap::CommandFactory as _;
use std::path::Path;

pub(crate) fn completions(args: &args::Completions, out: &mut Output) -> Result {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut visible(), "hyperplan", &mut script);
    out.write(|w| w.write_all(&script))?;
    Ok(Exit::Good)
}

/// All pages into a folder, or one page.
pub(crate) fn man(args: &args::Man, out: &mut Output) -> Result {
    if let Some(folder) = &args.output {
        std::fs::create_dir_all(folder).map_err(|error| cannot_write(folder, &error))?;
        let mut command = visible().disable_help_subcommand(true);
        command.build();
        return write_pages(&command, folder).map(|()| Exit::Good);
    }
    let mut command = visible();
    command.build();
    let command = match &args.command {
        None => command,
        Some(name) => {
            let missing = || Failure::input(format_args!("there is no command `{name}`"));
            command.find_subcommand(name).cloned().ok_or_else(missing)?
        }
    };
    let mut page = Vec::new();
    let source = concat!("hyperplan ", env!("CARGO_PKG_VERSION"));
    clap_mangen::Man::new(command).source(source).render(&mut page).map_err(Failure::input)?;
    out.write(|w| w.write_all(&page))?;
    Ok(Exit::Good)
}

/// Writes the pages of a command and of those below it.
fn write_pages(command: &clap::Command, folder: &Path) -> Result<()> {
    let below = command.get_subcommands().filter(|command| !command.is_hide_set());
    below.into_iter().try_for_each(|command| write_pages(command, folder))?;
    let page = clap_mangen::Man::new(command.clone());
    write(&folder.join(page.get_filename()), |to| page.render(to)).map(|_| ())
}

/// The command line without what is only for hyperplan itself.
fn visible() -> clap::Command {
    let all = Cli::command();
    let shown: Vec<clap::Command> = all.get_subcommands().filter(|c| !c.is_hide_set()).cloned().collect();
    clap::Command::new("hyperplan")
        .version(env!("CARGO_PKG_VERSION"))
        .about(all.get_about().cloned().unwrap_or_default())
        .after_help(all.get_after_help().cloned().unwrap_or_default())
        .args(all.get_arguments().cloned())
        .subcommands(shown)
}
