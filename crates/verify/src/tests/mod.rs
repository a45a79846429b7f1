//! Tests of the checker on problems built by hand.

mod alternation;
mod build;
mod lasting;
mod naive;
mod operators;
mod parts;
mod paths;
mod scale;
mod strategies;
mod worst;
