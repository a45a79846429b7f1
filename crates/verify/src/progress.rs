//! Reading one position: a residual and a valuation of the atoms give the next residual.

use crate::report::Stop;
use crate::residual::{Connective, Residual, ResidualId, Residuals};
use crate::valuation::{Valuation, ValuationId, Valuations};
use rustc_hash::FxHashMap;

/// Memoized progression.
#[derive(Debug)]
pub(crate) struct Progress {
    memo: FxHashMap<(ResidualId, ValuationId), ResidualId>,
    /// Whether the position read is the last one of every path.
    last: bool,
    limit: usize,
}

impl Progress {
    /// At most `limit` residuals are remembered.
    pub(crate) fn new(limit: usize) -> Self {
        Progress { memo: FxHashMap::default(), last: false, limit }
    }

    /// Says whether the position to be read is the last one, where every residual becomes a constant. Returns whether
    /// this is news, so that nothing remembered holds any more.
    pub(crate) fn at_last_position(&mut self, last: bool) -> bool {
        let news = self.last != last;
        if news {
            self.memo.clear();
            self.last = last;
        }
        news
    }

    /// The residual after a position where the atoms have these values. Iterative: residuals can be as deep as the
    /// horizon is long.
    pub(crate) fn read(
        &mut self,
        residuals: &mut Residuals,
        valuations: &Valuations,
        residual: ResidualId,
        valuation: ValuationId,
    ) -> Result<ResidualId, Stop> {
        if let Some(&known) = self.memo.get(&(residual, valuation)) {
            return Ok(known);
        }
        if self.memo.len() > self.limit || residuals.len() > self.limit {
            return Err(Stop::Budget);
        }
        let values = valuations.get(valuation);
        let mut stack = vec![residual];
        while let Some(&top) = stack.last() {
            let before = stack.len();
            self.operands(residuals.get(top), |id| {
                if !self.memo.contains_key(&(id, valuation)) {
                    stack.push(id);
                }
            });
            if stack.len() == before {
                let next = self.step(residuals, top, &values, |memo, id| {
                    memo.get(&(id, valuation)).copied().unwrap_or(ResidualId::MISSING)
                });
                self.memo.insert((top, valuation), next);
                stack.pop();
            }
        }
        Ok(self.memo.get(&(residual, valuation)).copied().unwrap_or(ResidualId::MISSING))
    }

    /// The operands that are read at this position.
    fn operands(&self, node: &Residual, mut visit: impl FnMut(ResidualId)) {
        match node {
            Residual::Constant(_) | Residual::Literal { .. } | Residual::Next(..) => {}
            Residual::Connected(_, operands) => operands.iter().for_each(|&id| visit(id)),
            Residual::Temporal(_, bounds, lhs, rhs) => {
                if bounds.lo == 0 {
                    visit(*rhs);
                }
                if bounds.hi != Some(0) && !self.last {
                    visit(*lhs);
                }
            }
        }
    }

    fn step(
        &self,
        residuals: &mut Residuals,
        id: ResidualId,
        values: &Valuation,
        done: impl Fn(&FxHashMap<(ResidualId, ValuationId), ResidualId>, ResidualId) -> ResidualId,
    ) -> ResidualId {
        let done = |id| done(&self.memo, id);
        match residuals.get(id).clone() {
            Residual::Constant(_) => id,
            Residual::Literal { atom, positive } => match values.get(atom) {
                Some(holds) if holds == positive => ResidualId::TRUE,
                Some(_) => ResidualId::FALSE,
                None => ResidualId::MISSING,
            },
            Residual::Connected(kind, operands) => residuals.connect(kind, operands.iter().map(|&o| done(o))),
            Residual::Next(kind, operand) => {
                if self.last {
                    beyond(kind)
                } else {
                    operand
                }
            }
            Residual::Temporal(kind, bounds, lhs, rhs) => {
                let rest = if self.last || bounds.hi == Some(0) {
                    beyond(kind)
                } else {
                    let rest = residuals.temporal(kind, bounds.later(), lhs, rhs);
                    residuals.connect(kind.dual(), [done(lhs), rest])
                };
                if bounds.lo > 0 { rest } else { residuals.connect(kind, [done(rhs), rest]) }
            }
        }
    }
}

/// What an operator says of a position that does not exist, or lies behind its interval: nothing is found there by
/// the strong ones, nothing violated by the weak ones.
fn beyond(kind: Connective) -> ResidualId {
    match kind {
        Connective::Or => ResidualId::FALSE,
        Connective::And => ResidualId::TRUE,
    }
}
