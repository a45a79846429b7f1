//! Which states can matter for an objective, and when: what is left of exploring the paths of a [`Task`] with what their
//! players want.
//!
//! A [`Goal`] is what one player wants of the formula. Its [`Residuals`] are what is left of it after some steps, by
//! progression (Bacchus and Kabanza). [`Layers`] are the states of a path that can matter at each time; [`leading`] finds
//! those of the leading block, which may lose runs on purpose ([`Narrowing`]) and says so, and [`Relevance`] those of
//! the paths after it. A [`Game`] is played where two paths of different players are tied. [`cases`] are finitely many
//! [`Instance`]s that stand for all choices of a path. [`believe`] decides small two-player objectives by itself. [`case`] cuts
//! the runs of the leading block into cases for searches side by side.
//!
//! Invariants: what is excluded can take part in no choice of all paths that its player would accept (the argument
//! stands at the head of `reach`), unless [`Relevant::is_exact`] says otherwise. No term, no solver and no way of writing
//! states is known here; nothing is printed; what is found does not depend on the order of a hash table.
//!
//! `task` < `goal` < `residual` < `reach` < `game` < `relevant`; `layers` and `instance` are data, and `cases` reads
//! `residual` and `instance`, `split` and `relevant`.

mod belief;
mod cases;
mod ceiling;
mod cube;
mod game;
mod goal;
mod instance;
mod layers;
mod reach;
mod reads;
mod relevant;
mod residual;
mod split;
mod task;
#[cfg(test)]
mod tests;

pub use belief::{Belief, believe};
pub use cases::{Numbering, cases};
pub use ceiling::{Ceiling, NO_WAY, rests, transitions};
pub use cube::{Case, Cube};
pub use game::{Game, LosingMove, MAX_RESIDUALS, Pair, Turn};
pub use goal::Goal;
pub use instance::{Instance, Known, Move, Start, generalize};
pub use layers::Layers;
pub use reads::{in_state, only_path};
pub use relevant::{Narrowing, Relevance, Relevant, leading, least};
pub use residual::{FALSE, MAX_ATOMS, Now, Residual, Residuals, TRUE};
pub use split::case;
pub use task::{Arena, Error, Limits, Pruning, Stop, Task};
