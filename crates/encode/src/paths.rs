//! What stands for what a path does: symbols, or functions.
//!
//! With [`Paths::Symbols`] there is a symbol for each variable and time, and a path after the leading block is bound by a
//! quantifier. With functions there is one for each variable, from times to values, and one for the moves. That is the
//! same question. Of a path that the solver chooses, only finitely many times are read, each a constant of its own: the
//! values of a function at these are as free as so many symbols, and give a path where these do.
//!
//! A path that is bound existentially after universal ones becomes Skolem functions: of time, and of all that was bound
//! universally before it (where these paths start, their moves, and what their updates leave open). `forall q. exists r. F` holds
//! if and only if there are functions that give for every `q` an `r` with which `F` holds; the functions stand free, beside
//! the leading block, since nothing that comes after depends on more. Paths that are bound universally stay as they are:
//! to quantify over functions would not be of first order.
//!
//! With [`Paths::Policies`] the moves are functions of time and of what is observed of the path at that time (what the
//! system observes; where it says nothing, its variables). As time is among the arguments, there is such a function
//! for every sequence of moves, the one that does not look, and each such function gives one sequence of moves from each start: again
//! the same question. What differs is what a solver has to do: moves that are alike for equal observations come by congruence, and
//! the argument of a function depends on what it gave before.

use std::fmt;

/// What stands for what a path does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Paths {
    /// A symbol for each time.
    #[default]
    Symbols,
    /// Functions of time.
    Functions,
    /// Functions of time; moves are functions of time and what is observed.
    Policies,
}

impl Paths {
    /// All of them.
    pub const ALL: [Paths; 3] = [Paths::Symbols, Paths::Functions, Paths::Policies];
}

impl fmt::Display for Paths {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Paths::Symbols => "symbols",
            Paths::Functions => "functions",
            Paths::Policies => "policies",
        })
    }
}
