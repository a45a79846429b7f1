//! Why there is no certificate, or one does not count.

use std::io;

/// Why a claim cannot be certified, or a certificate is none.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// Certificates are for finite systems.
    #[error("system {system} has variables without bounds: such answers are not certified")]
    Infinite {
        /// The system.
        system: String,
    },
    /// It would be too much to write down.
    #[error("too large to certify: {what}")]
    TooLarge {
        /// What is.
        what: String,
    },
    /// The time is up.
    #[error("stopped before the end")]
    Stopped,
    /// Lowering makes no such thing.
    #[error("the problem is malformed: {what}")]
    Malformed {
        /// What is wrong.
        what: &'static str,
    },
    /// An instance is none of its path.
    #[error("instance of path {path}: {what}")]
    Instance {
        /// The path.
        path: String,
        /// What is wrong with it.
        what: String,
    },
    /// A certificate is for something else.
    #[error("the certificate is for {0}")]
    Foreign(String),
    /// A file of a certificate is damaged.
    #[error("the certificate cannot be read: {0}")]
    Unreadable(String),
    /// A step of the refutation does not follow.
    #[error("the refutation is wrong in step {step}: {what}")]
    Step {
        /// Which step, from 1 on.
        step: u64,
        /// What is wrong with it.
        what: &'static str,
    },
    /// It ends without a contradiction.
    #[error("the refutation ends before a contradiction is reached")]
    Incomplete,
    /// A file cannot be read or written.
    #[error(transparent)]
    Io(#[from] io::Error),
}
