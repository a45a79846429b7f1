//! One module for each command.

mod certify;
mod check;
mod compare;
mod emit;
mod emit_family;
mod explain;
mod horizon;
mod import;
mod manual;
mod new;
mod plot;
mod solve;
mod solvers;
mod templates;
mod verify;

use crate::args::{Cli, Command};
use crate::failure::Result;
use crate::output::Output;

/// Runs the command that was asked for.
pub(crate) fn run(cli: &Cli, out: &mut Output) -> Result {
    let verbose = cli.global.verbose;
    match &cli.command {
        Command::Solve(args) => solve::run(args, verbose, cli.global.quiet, out),
        Command::Emit(args) => match &args.file {
            Some(file) => emit::run(args, file, out),
            None => emit_family::run(args, verbose, out),
        },
        Command::Horizon(args) => horizon::run(args, out),
        Command::Check(args) => check::run(args, verbose, out),
        Command::Verify(args) => verify::run(args, out),
        Command::Explain(args) => explain::run(args, out),
        Command::Certify(args) => certify::run(args, out),
        Command::Import(args) => import::run(args, out),
        Command::Plot(args) => plot::run(args, out),
        Command::Compare(args) => compare::run(args, verbose, out),
        Command::Solvers(args) => solvers::run(args, out),
        Command::Templates(args) => templates::run(args, out),
        Command::New(args) => new::run(args, out),
        Command::Completions(args) => manual::completions(args, out),
        Command::Man(args) => manual::man(args, out),
        Command::Supervise => compare::supervise(),
    }
}
