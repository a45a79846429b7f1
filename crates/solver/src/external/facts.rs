//! What is known of a solver before it is run: for files that are written for it.

use std::sync::Arc;

use hyperplan_smt::{Features, logic};

use super::catalog::{demand_at_most, names, profile};
use super::profile::{Profile, Theory};
use super::spec::Spec;
use crate::error::Error;
use crate::session::{Options, Quantifiers};

impl Spec {
    /// What is known of the solver: of a command, nothing.
    #[must_use]
    pub fn profile(&self) -> Option<Arc<Profile>> {
        match self {
            Spec::Builtin | Spec::Backend(_) => {
                let theories = Some(vec![Theory::BitVectors, Theory::Datatypes]);
                let plain = Profile::plain(self.name());
                Some(Arc::new(Profile { quantifiers: Quantifiers::None, theories, ..plain }))
            }
            Spec::Profile(name) => profile(name).cloned(),
            Spec::Configured(profile) | Spec::Program(_, profile) => Some(Arc::clone(profile)),
            Spec::Command(_) => None,
        }
    }
}

/// What a solver takes, as far as it is known; what is not known, it takes.
impl Profile {
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
    /// [`Error::Unsupported`] where it has no theory for them; names solvers that have.
    pub fn logic(&self, features: &Features) -> Result<String, Error> {
        let needed = [
            (features.bitvec, Theory::BitVectors),
            (features.int, Theory::Integers),
            (features.real, Theory::Reals),
            (features.datatypes, Theory::Datatypes),
            (features.functions, Theory::Functions),
        ];
        if let Some((_, lacks)) = needed.into_iter().find(|(needed, theory)| *needed && !self.takes(*theory))
        {
            let others = names(|profile| profile.takes(lacks)).join(", ");
            let what = format!("the {} solver has no {lacks}: use one of {others}", self.name);
            return Err(Error::Unsupported { what });
        }
        // Booleans alone would be QF_UF, for which solvers are slower than for bit-vectors.
        let booleans = !(features.int || features.real || features.datatypes);
        let bitvec = features.bitvec || booleans && self.takes(Theory::BitVectors);
        let smallest = logic(&Features { bitvec, ..*features });
        Ok(self.logic.clone().unwrap_or_else(|| smallest.to_owned()))
    }
}
