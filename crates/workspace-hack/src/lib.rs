//! Nothing: its dependencies matter, as `Cargo.toml` explains.
