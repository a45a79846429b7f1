//! From the name of a solver to a session.

use std::str::FromStr;

use crate::embedded::{BUILTIN, Engine, backend, for_dialogue, names};
use crate::error::Error;
use crate::external::{self, Spec};
use crate::session::{Options, Quantifiers, Session};

impl Spec {
    /// A solver for integers and reals that is found on this machine, the first that hyperplan knows.
    #[must_use]
    pub fn for_arithmetic() -> Option<Spec> {
        external::for_arithmetic().map(|name| Spec::Profile(name.to_owned()))
    }

    /// The embedded engine with each SAT solver of this build.
    #[must_use]
    pub fn backends() -> Vec<Spec> {
        let specs = names().filter_map(|name| Spec::embedded(name)?.ok());
        specs.filter(|spec| *spec != Spec::Builtin).collect()
    }

    /// The embedded engine as it is called, if the name is one of its names.
    ///
    /// # Errors
    /// Where this build has not got it.
    pub fn embedded(name: &str) -> Option<Result<Spec, Error>> {
        let known = names().find(|known| *known == name)?;
        let spec = if known == BUILTIN { Spec::Builtin } else { Spec::Backend(known) };
        Some(backend(known)?.map(|_| spec))
    }
}

impl FromStr for Spec {
    type Err = Error;

    fn from_str(text: &str) -> Result<Spec, Error> {
        let text = text.trim();
        if text.is_empty() {
            return Err(Error::Unsupported { what: "the solver's name is empty".to_owned() });
        }
        if let Some(embedded) = Spec::embedded(text) {
            return embedded;
        }
        if let Some(profile) = external::profile(text) {
            return Ok(Spec::Profile(profile.name.clone()));
        }
        if external::split_list(text).len() > 1 {
            let what = format!("one solver is wanted here, not a list ({text})");
            return Err(Error::Unsupported { what });
        }
        Ok(external::of_kind(text).unwrap_or_else(|| Spec::Command(text.to_owned())))
    }
}

/// Starts a session. The solver must be installed.
///
/// # Errors
/// When the solver is missing, or cannot do what the options say.
pub fn open(spec: &Spec, options: &Options) -> Result<Box<dyn Session>, Error> {
    match spec {
        Spec::Builtin | Spec::Backend(_) => {
            let name = spec.name();
            external::demand_at_most(options, Quantifiers::None, name)?;
            let best = backend(name).ok_or_else(|| unknown(name))??;
            let ours = *spec == Spec::Builtin && options.incremental;
            let backend = ours.then(for_dialogue).flatten().unwrap_or(best);
            Ok(Box::new(Engine::new(name, backend, options)?))
        }
        Spec::Profile(name) => match external::profile(name) {
            Some(profile) => external::open_profile(profile, options),
            None => Err(unknown(name)),
        },
        Spec::Configured(profile) => external::open_profile(profile, options),
        Spec::Program(line, profile) => external::open_program(line, profile, options),
        Spec::Command(line) => external::open_command(line, options),
    }
}

fn unknown(name: &str) -> Error {
    Error::Unsupported { what: format!("no solver {name} is known") }
}
