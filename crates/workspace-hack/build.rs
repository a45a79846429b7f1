//! Does nothing: without it, build-dependencies would be ignored.

fn main() {}
