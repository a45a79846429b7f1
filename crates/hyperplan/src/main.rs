//! The `hyperplan` command: flags, files and exit statuses around the libraries.

mod args;
mod commands;
mod config;
mod configuration;
mod explain;
mod failure;
mod files;
mod gather;
mod guard;
mod instances;
mod load;
mod nusmv;
mod output;
mod parameter;
mod pictures;
mod plans;
mod progress;
mod proof;
mod reading;
mod report;
mod signals;
mod store;
mod tables;
mod trusted;
mod waiting;
mod wish;

use clap::Parser as _;
use failure::{Exit, Result};
use hyperplan_outlet::one_line;
use output::Output;
use std::process::ExitCode;

fn main() -> ExitCode {
    let mut cli = match args::Cli::try_parse() {
        Ok(cli) => cli,
        Err(e) => return usage(e),
    };
    if let Err(failure) = gather::gather(&mut cli) {
        Output::new(cli.global.quiet, config::color(cli.global.color)).failure(&failure);
        return failure.status.into();
    }
    let run = || run(&cli);
    std::thread::scope(|scope| {
        // Its stack is the same on all systems.
        let worker = std::thread::Builder::new().spawn_scoped(scope, run);
        // A thread that panicked has said so; that is our bug.
        worker.map_or_else(|_| run(), |w| w.join().unwrap_or(ExitCode::from(Exit::Bug)))
    })
}

/// Help and version go to standard output and are no failure; everything else is bad usage. What was typed is told
/// without what could do harm, such as the name of a file that a pattern stands for.
fn usage(error: clap::Error) -> ExitCode {
    let typed = std::env::args_os().map(|word| one_line(&word.to_string_lossy()).into_owned());
    let error = args::Cli::try_parse_from(typed).err().unwrap_or(error);
    let status = if error.use_stderr() { Exit::Input } else { Exit::Good };
    // Nothing is left to do if it cannot be printed.
    let _ = error.print();
    status.into()
}

fn run(cli: &args::Cli) -> ExitCode {
    let mut out = Output::new(cli.global.quiet, config::color(cli.global.color));
    let result = commands::run(cli, &mut out);
    let status = finish(&mut out, result);
    signals::status().unwrap_or_else(|| status.into())
}

fn finish(out: &mut Output, result: Result) -> Exit {
    let result = result.and_then(|status| out.flush().map(|()| status));
    result.unwrap_or_else(|failure| {
        out.failure(&failure);
        failure.status
    })
}
