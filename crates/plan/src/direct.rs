//! One query for the whole objective: with its quantifiers, or expanded.

use crate::oracle::{Dialogue, Oracle, Stop};
use hyperplan_encode::{Bound, Encoder, Env, Error, Goal, Known, Narrowing, PathIx, Query};
use hyperplan_problem::{PathId, display};
use hyperplan_smt::{Script, Term};

/// A query whose models are the winning choices of the leading block.
pub(crate) struct Direct<'e, 'a> {
    pub(crate) query: Query<'e, 'a>,
    env: Env,
    /// Whether all runs of the leading block are in it, so that nothing found means that there is nothing.
    pub(crate) exact: bool,
}

/// Builds the query with the quantifiers of later blocks inside, the paper's formula (16): a path constraint is a
/// conjunct under `exists` and an antecedent under `forall`, and only what determines a path is quantified. A path under
/// `exists` that is written as functions of what is bound before it needs no quantifier.
pub(crate) fn keep<'e, 'a>(
    encoder: &'e Encoder<'a>,
    blocks: &[Vec<PathId>],
    want: bool,
) -> Result<Direct<'e, 'a>, Error> {
    let goal = Goal::new(&encoder.objective.formula, want);
    let against = goal.opposed(&encoder.objective.formula);
    let mut direct = leading(encoder, blocks, &goal, Narrowing::default())?;
    let mut env = direct.env.clone();
    // From the outside in the paths are bound, from the inside out the formula is closed.
    let (mut open, mut universal) = (Vec::new(), Vec::new());
    for (depth, block) in blocks.iter().enumerate().skip(1) {
        let own = depth % 2 == 0;
        for &path in block {
            if own
                && let Some((chosen, guard)) =
                    direct.query.paths.depend(&mut direct.query.script.terms, path, &universal)
            {
                env[usize::from(path)] = Some(chosen);
                open.push((own, Bound { path: chosen, variables: Vec::new(), guard }));
                continue;
            }
            let bound = direct.query.paths.bind(
                &mut direct.query.script.terms,
                path,
                if own { &goal } else { &against },
            )?;
            env[usize::from(path)] = Some(bound.path);
            if !own {
                universal.extend(&bound.variables);
            }
            open.push((own, bound));
        }
    }
    let mut formula = direct.query.goal(&env, &goal);
    let terms = &mut direct.query.script.terms;
    for (own, Bound { variables, guard, .. }) in open.into_iter().rev() {
        formula = if own {
            let body = terms.and2(guard, formula);
            terms.exists(&variables, body)
        } else {
            let body = terms.implies(guard, formula);
            terms.forall(&variables, body)
        };
    }
    let text = display::objective(encoder.problem, encoder.objective);
    direct.query.script.section("formula", format!("the formula, with its quantifiers: {text}"));
    direct.query.script.assert(formula);
    Ok(direct)
}

/// Builds the quantifier-free query that follows all runs of the other player's path at once. `None` where the other
/// player has more than one path, or not the last word, or where there is too much to follow.
pub(crate) fn sweep<'e, 'a>(
    encoder: &'e Encoder<'a>,
    blocks: &[Vec<PathId>],
    want: bool,
    narrowing: Narrowing,
) -> Result<Option<Direct<'e, 'a>>, Error> {
    let [_, last] = blocks else { return Ok(None) };
    let [path] = last.as_slice() else { return Ok(None) };
    let (mut direct, rest) = demanding(encoder, blocks, want, narrowing)?;
    let against = rest.opposed(&encoder.objective.formula);
    let swept = direct.query.paths.sweep(&mut direct.query.script, *path, &direct.env, &against)?;
    Ok(swept.then_some(direct))
}

/// Builds a quantifier-free query: by [`sweep`] if possible; else each block of the other player becomes one copy for
/// each of its cases, and each copy has its own choice of the blocks that follow.
pub(crate) fn expand<'e, 'a>(
    encoder: &'e Encoder<'a>,
    blocks: &[Vec<PathId>],
    want: bool,
    narrowing: Narrowing,
) -> Result<Direct<'e, 'a>, Error> {
    if let Some(direct) = sweep(encoder, blocks, want, narrowing)? {
        return Ok(direct);
    }
    let (mut direct, rest) = demanding(encoder, blocks, want, narrowing)?;
    let against = rest.opposed(&encoder.objective.formula);
    let mut copies = vec![(direct.env.clone(), Term::TRUE)];
    for (depth, block) in blocks.iter().enumerate().skip(1) {
        for &path in block {
            let mut next = Vec::new();
            if depth % 2 == 0 {
                for (mut env, guard) in copies {
                    env[usize::from(path)] =
                        Some(direct.query.paths.declare(&mut direct.query.script, path, &rest)?);
                    next.push((env, guard));
                }
            } else {
                let cases = encoder.writer.cases(path, &against)?;
                for (env, guard) in copies {
                    for case in &cases {
                        let (terms, is_path) = direct.query.paths.instantiate(
                            &mut direct.query.script,
                            path,
                            case,
                            &env,
                            &against,
                        )?;
                        let mut env = env.clone();
                        env[usize::from(path)] = Some(terms);
                        next.push((env, direct.query.script.terms.and2(guard, is_path)));
                    }
                    encoder.task.allow_cases(path, next.len())?;
                }
            }
            copies = next;
        }
    }
    for (number, (env, guard)) in copies.into_iter().enumerate() {
        // A case that is impossible asks for nothing.
        if guard != Term::FALSE {
            let number = number + 1;
            direct
                .query
                .script
                .section(format!("case.{number}"), format!("the rest of the formula, case {number}"));
            let formula = direct.query.goal(&env, &rest);
            direct.query.script.clause(&[!guard, formula]);
        }
    }
    Ok(direct)
}

/// The leading block with what the formula asks of it alone, and the rest of what its player wants.
fn demanding<'e, 'a>(
    encoder: &'e Encoder<'a>,
    blocks: &[Vec<PathId>],
    want: bool,
    narrowing: Narrowing,
) -> Result<(Direct<'e, 'a>, Goal), Error> {
    let formula = &encoder.objective.formula;
    let goal = Goal::new(formula, want);
    let (own, rest) = goal.split(formula, &|path| blocks[0].contains(&path));
    let mut direct = leading(encoder, blocks, &goal, narrowing)?;
    direct.query.demand(&direct.env, &own);
    Ok((direct, rest))
}

pub(crate) fn leading<'e, 'a>(
    encoder: &'e Encoder<'a>,
    blocks: &[Vec<PathId>],
    goal: &Goal,
    narrowing: Narrowing,
) -> Result<Direct<'e, 'a>, Error> {
    let relevant = encoder.writer.relevant(&blocks[0], goal, narrowing)?;
    let exact = relevant.is_exact();
    let mut query = Query::new(encoder, &[], relevant);
    let mut env = query.known();
    for &path in &blocks[0] {
        env[usize::from(path)] = Some(query.paths.declare(&mut query.script, path, goal)?);
    }
    query.paths.afford(&mut query.script, &env)?;
    Ok(Direct { query, env, exact })
}

impl Direct<'_, '_> {
    /// The query alone.
    pub(crate) fn into_script(self) -> Script {
        self.query.script
    }

    /// A path of the leading block.
    pub(crate) fn path(&self, path: PathId) -> Option<PathIx> {
        self.env[usize::from(path)]
    }

    /// Asks a solver; `blocks` of quantifiers are in the query, the leading one as free symbols.
    pub(crate) fn solve(
        &self,
        oracle: &mut Oracle<'_>,
        blocks: usize,
    ) -> Result<Option<Vec<Option<Known>>>, Stop> {
        let mut dialogue = oracle.open(blocks)?;
        if !oracle.check(&mut dialogue, &self.query.script)? {
            return Ok(None);
        }
        self.paths(oracle, &mut dialogue).map(Some)
    }

    /// The paths of the leading block in the solver's model.
    pub(crate) fn paths(
        &self,
        oracle: &mut Oracle<'_>,
        dialogue: &mut Dialogue,
    ) -> Result<Vec<Option<Known>>, Stop> {
        let wanted: Vec<Term> =
            self.env.iter().flatten().flat_map(|&path| self.query.paths.symbols(path)).collect();
        let model = oracle.model(dialogue, &self.query.script, wanted)?;
        let mut known = vec![None; self.env.len()];
        for (at, path) in self.env.iter().enumerate() {
            if let Some(path) = *path {
                let decoded = self.query.paths.decode(path, &model);
                known[at] = Some(decoded.ok_or_else(|| oracle.no_path(dialogue, self.query.encoder))?);
            }
        }
        Ok(known)
    }
}
