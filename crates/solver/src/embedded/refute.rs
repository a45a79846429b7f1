//! Plain clauses, and why they are unsatisfiable.

use crate::deadline::Deadline;
use crate::error::{Error, Unknown};
use std::io::{self, Write};

/// A SAT solver for clauses as DIMACS has them. It takes more clauses after a model, and where there is none any more, it gives a
/// refutation of all of them.
pub struct Refuter {
    #[cfg(feature = "cadical")]
    solver: super::traced::Traced,
}

impl Refuter {
    /// A solver without clauses, which works until the deadline.
    ///
    /// # Errors
    /// If this build has none.
    #[cfg(feature = "cadical")]
    pub fn new(deadline: &Deadline) -> Result<Refuter, Error> {
        Ok(Refuter { solver: super::traced::Traced::new(deadline)? })
    }

    /// A solver without clauses, which works until the deadline.
    ///
    /// # Errors
    /// If this build has none.
    #[cfg(not(feature = "cadical"))]
    pub fn new(_: &Deadline) -> Result<Refuter, Error> {
        Err(Error::Unsupported {
            what: "certificates take a build with the cargo feature cadical".to_owned(),
        })
    }

    /// Adds clauses, a 0 behind each.
    pub fn add(&mut self, clauses: &[i32]) {
        #[cfg(feature = "cadical")]
        self.solver.add(clauses);
        #[cfg(not(feature = "cadical"))]
        let _ = clauses;
    }

    /// The values of the variables from 1 on in a model, if there is one.
    ///
    /// # Errors
    /// Where the deadline, or the end of the memory that a refutation may take, came first.
    pub fn solve(&mut self) -> Result<Option<Vec<bool>>, Unknown> {
        #[cfg(feature = "cadical")]
        return self.solver.solve();
        #[cfg(not(feature = "cadical"))]
        Ok(None)
    }

    /// Writes the refutation in LRAT form, as text: clauses count from 1 on, in the order in which they were added. Only steps that
    /// are needed are written.
    ///
    /// # Errors
    /// If it cannot be written; if there is none.
    pub fn refutation(&self, to: &mut dyn Write) -> io::Result<()> {
        #[cfg(feature = "cadical")]
        return self.solver.refutation(to);
        #[cfg(not(feature = "cadical"))]
        to.flush()
    }
}
