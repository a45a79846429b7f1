//! Random trees and damaged texts, and what has to hold of them. Nothing here
//! knows the test harness: the crate with the bodies of the fuzzers includes the folder as it is.
#![allow(unreachable_pub, reason = "included by several tests")]

pub mod damage;
pub mod roundtrip;
pub mod tree;
