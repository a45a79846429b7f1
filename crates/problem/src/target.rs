//! What is to be as small as possible: sums of the costs of paths.

use crate::ids::{CostId, PathId};
use hyperplan_syntax::Span;

/// `minimize EXPR`: a sum of costs of paths of the leading block, which are those of all steps that the objective reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Target {
    /// How often each cost of a path counts, at least once; each stands in it once.
    pub terms: Vec<(i64, PathId, CostId)>,
    /// What is added to their sum.
    pub constant: i64,
    /// Its place.
    pub span: Span,
}

impl Target {
    /// The value, given those of the costs; `None` where it does not fit into 64 bits.
    pub fn value(&self, mut cost: impl FnMut(PathId, CostId) -> Option<i64>) -> Option<i64> {
        self.terms.iter().try_fold(self.constant, |sum, &(factor, path, id)| {
            sum.checked_add(factor.checked_mul(cost(path, id)?)?)
        })
    }
}
