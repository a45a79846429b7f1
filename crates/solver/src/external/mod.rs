//! Solvers as processes, spoken to in SMT-LIB 2 over pipes.

mod assignment;
mod bits;
mod catalog;
mod dialogue;
mod discover;
mod exchange;
mod facts;
mod line;
mod model;
mod one_shot;
mod probe;
mod process;
mod profile;
mod program;
mod reply;
mod response;
mod spec;
mod standalone;
mod version;
mod watchdog;

use std::sync::Arc;

use bits::Bits;
use dialogue::Dialogue;
use one_shot::OneShot;
use program::Program;

use crate::error::Error;
use crate::session::{Options, Session};

pub use catalog::{Catalog, ConfigError, says_what_to_run};
pub(crate) use catalog::{demand_at_most, of_kind, profile};
pub(crate) use discover::for_arithmetic;
pub use discover::{Found, discover};
pub(crate) use line::split_list;
pub use model::{PrintedModel, PrintedModelError};
pub use process::end_with_parent;
pub use profile::{Install, Profile};
#[doc(hidden)]
pub use reply::understand_output;
pub use response::{Response, Said, responses};
pub use spec::Spec;
pub use standalone::Standalone;

/// A session with a solver that is known by name.
pub(crate) fn open_profile(profile: &Arc<Profile>, options: &Options) -> Result<Box<dyn Session>, Error> {
    Ok(session(Program::of_profile(profile, options)?, options))
}

/// A session with a program of a kind that is known.
pub(crate) fn open_program(
    line: &str,
    profile: &Arc<Profile>,
    options: &Options,
) -> Result<Box<dyn Session>, Error> {
    Ok(session(Program::of_kind(line, profile, options)?, options))
}

/// A session with any command that reads SMT-LIB from its standard input or a file.
pub(crate) fn open_command(line: &str, options: &Options) -> Result<Box<dyn Session>, Error> {
    Ok(session(Program::of_command(line)?, options))
}

fn session(program: Program, options: &Options) -> Box<dyn Session> {
    if let Some(format) = program.profile.format {
        return Box::new(Bits::new(program, format, options));
    }
    // One that answers a single check may wait for the end of its input.
    if program.takes_file() || !program.profile.incremental {
        return Box::new(OneShot::new(program, options));
    }
    Box::new(Dialogue::new(program, options))
}
