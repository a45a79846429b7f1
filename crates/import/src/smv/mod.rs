//! SMV as NuSMV and its relatives write it.

pub(crate) mod model;
pub(crate) mod parser;
pub(crate) mod resolve;
