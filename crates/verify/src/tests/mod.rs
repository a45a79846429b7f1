//! Tests of the checker on problems built by hand.

mod alternation;
mod build;
mod naive;
mod operators;
mod paths;
mod scale;
mod strategies;
