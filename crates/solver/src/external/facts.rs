//! What is known of a solver before it is run: for files that are written for it.

use hyperplan_smt::{Features, logic};

use super::catalog::{demand_at_most, names, profile};
use super::profile::{Profile, Theory};
use super::spec::Spec;
use crate::error::Error;
use crate::session::{Options, Quantifiers};

/// What a solver takes, as far as it is known; what is not known, it takes.
#[derive(Clone, Debug)]
pub struct Facts {
    name: String,
    quantifiers: Quantifiers,
    theories: Option<Vec<Theory>>,
    logic: Option<String>,
}

impl Facts {
    /// The facts of a solver.
    #[must_use]
    pub fn of(spec: &Spec) -> Facts {
        let name = spec.name().to_owned();
        match spec {
            Spec::Builtin | Spec::Backend(_) => {
                let theories = Some(vec![Theory::BitVectors, Theory::Datatypes]);
                Facts { name, quantifiers: Quantifiers::None, theories, logic: None }
            }
            Spec::Profile(called) => match profile(called) {
                Some(profile) => Facts::of_profile(profile),
                None => Facts::unknown(name),
            },
            Spec::Configured(profile) => Facts::of_profile(profile),
            Spec::Command(_) => Facts::unknown(name),
        }
    }

    pub(super) fn of_profile(profile: &Profile) -> Facts {
        Facts {
            name: profile.name.clone(),
            quantifiers: profile.quantifiers,
            theories: profile.theories.clone(),
            logic: profile.logic.clone(),
        }
    }

    pub(super) fn unknown(name: String) -> Facts {
        Facts { name, quantifiers: Quantifiers::Any, theories: None, logic: None }
    }

    /// What the solver is called.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Refuses quantifiers, perhaps inside others, where the solver takes none such, and names solvers that do.
    ///
    /// # Errors
    /// [`Error::Unsupported`].
    pub fn demand_quantifiers(&self, nested: bool) -> Result<(), Error> {
        let options = Options { quantified: true, nested, ..Options::default() };
        demand_at_most(&options, self.quantifiers, &self.name)
    }

    /// The logic that serves it best for terms with those features.
    ///
    /// # Errors
    /// [`Error::Unsupported`] where it has no theory for them.
    pub fn logic(&self, features: &Features) -> Result<String, Error> {
        demand_theories(&self.name, self.theories.as_deref(), features)?;
        // Booleans alone would be QF_UF, for which solvers are slower than for bit-vectors.
        let booleans = !(features.int || features.real || features.datatypes);
        let vectors = self.theories.as_ref().is_none_or(|theories| theories.contains(&Theory::BitVectors));
        let smallest = logic(&Features { bitvec: features.bitvec || booleans && vectors, ..*features });
        Ok(self.logic.clone().unwrap_or_else(|| smallest.to_owned()))
    }
}

/// Refuses what a solver that has those theories cannot take, and names solvers that can.
fn demand_theories(solver: &str, theories: Option<&[Theory]>, features: &Features) -> Result<(), Error> {
    let Some(theories) = theories else { return Ok(()) };
    let needed = [
        (features.bitvec, Theory::BitVectors),
        (features.int, Theory::Integers),
        (features.real, Theory::Reals),
        (features.datatypes, Theory::Datatypes),
    ];
    for (_, theory) in needed.into_iter().filter(|(needed, _)| *needed) {
        if !theories.contains(&theory) {
            let others = names(|profile| profile.takes(theory)).join(", ");
            let what = format!("the {solver} solver has no {theory}: use one of {others}");
            return Err(Error::Unsupported { what });
        }
    }
    Ok(())
}
