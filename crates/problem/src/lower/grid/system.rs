//! A map's moves and rules as ordinary variables, clauses and labels.

use super::{Cell, Clearance, GridMap, Lettered, Move, Rule};
use crate::expr::{Comparison, Expr, Leaf, TupleSet, Type, Value};
use crate::ids::VarId;
use crate::lower::{Actions, Base};
use crate::system::{Clause, Label, Map, Update, Var};
use hyperplan_syntax::Span;
use rustc_hash::FxHashSet;
use std::sync::Arc;
use typed_index_collections::TiVec;

const X: VarId = VarId(0);
const Y: VarId = VarId(1);
const CRASH: VarId = VarId(2);

/// How the robot moves on a map.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    /// Without repetition.
    pub(crate) moves: Vec<Move>,
    /// What becomes of a move onto an obstacle.
    pub(crate) obstacle: Rule,
    /// What becomes of a move over the edge.
    pub(crate) edge: Rule,
    /// What becomes of a diagonal move between two obstacles, onto a free cell; `None`: nothing special.
    pub(crate) corner: Option<Rule>,
    /// Whether clauses of the file move the robot too, perhaps onto an obstacle.
    pub(crate) clauses_move: bool,
}

impl Rules {
    fn can_crash(&self) -> bool {
        [Some(self.obstacle), Some(self.edge), self.corner].contains(&Some(Rule::Crash))
    }
}

/// Which cells are free, as the smaller of two sets.
enum Ground {
    /// No obstacle at all.
    Open,
    /// Free unless in this set (meant for cells inside the map).
    Obstacles(Arc<TupleSet>),
    /// Free if in this set, which has no cells outside the map.
    Free(Arc<TupleSet>),
}

impl Ground {
    fn of(map: &GridMap) -> Self {
        let cells = map.width as usize * map.height as usize;
        if map.obstacles.is_empty() {
            return Ground::Open;
        }
        if map.obstacles.len() * 2 <= cells {
            return Ground::Obstacles(set(&map.obstacles));
        }
        let blocked: FxHashSet<Cell> = map.obstacles.iter().copied().collect();
        let all = (0..map.width).flat_map(|x| (0..map.height).map(move |y| (x, y)));
        Ground::Free(set(&all.filter(|cell| !blocked.contains(cell)).collect::<Vec<_>>()))
    }
}

fn set(cells: &[Cell]) -> Arc<TupleSet> {
    let tuples = cells.iter().map(|(x, y)| Box::from([i64::from(*x), i64::from(*y)]));
    Arc::new(TupleSet::new(tuples.collect()))
}

fn var(id: VarId) -> Expr<Leaf> {
    Expr::Leaf(Leaf::Var(id))
}

fn not(e: Expr<Leaf>) -> Expr<Leaf> {
    Expr::Not(Box::new(e))
}

/// A variable moved by a constant.
fn moved(id: VarId, by: i64) -> Expr<Leaf> {
    if by == 0 { var(id) } else { Expr::Add(vec![var(id), Expr::Const(Value::Int(by))]) }
}

fn compare(op: Comparison, a: Expr<Leaf>, b: Expr<Leaf>) -> Expr<Leaf> {
    Expr::Compare(op, Box::new(a), Box::new(b))
}

/// Whether the move leaves the map; `None` for a move that never does.
fn leaves(map: &GridMap, step: Move) -> Option<Expr<Leaf>> {
    let side = |id, by: i64, size: u32| match by {
        0 => None,
        1.. => Some(compare(Comparison::Eq, var(id), Expr::Const(Value::Int(i64::from(size) - 1)))),
        _ => Some(compare(Comparison::Eq, var(id), Expr::Const(Value::Int(0)))),
    };
    match (side(X, step.dx, map.width), side(Y, step.dy, map.height)) {
        (Some(x), Some(y)) => Some(Expr::Or(vec![x, y])),
        (x, y) => x.or(y),
    }
}

/// The label that says how far the nearest obstacle is.
fn distance(clearance: &Clearance) -> Label {
    let Clearance { name, cells } = clearance;
    let number = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
    let there = cells.iter().enumerate().filter(|(_, cells)| !cells.is_empty());
    let near = there.map(|(distance, cells)| {
        let there = Expr::Member(vec![var(X), var(Y)], set(cells));
        (there, Expr::Const(Value::Int(number(distance))))
    });
    let hi = number(cells.len());
    let expr = Expr::choice(near, Expr::Const(Value::Int(hi)));
    Label { name: name.name.clone(), expr, ty: Type::Range { lo: 0, hi }, nested: false, span: name.span }
}

/// A system's parts from a map. The action names are interned; everything lies at `span`.
pub(crate) fn base(map: &GridMap, rules: &Rules, actions: &mut Actions, span: Span) -> Base {
    let ground = Ground::of(map);
    let can_crash = rules.can_crash();
    let mut clauses = Vec::new();
    let mut ids = Vec::new();
    for step in &rules.moves {
        let id = actions.intern(step.name);
        ids.push(id);
        for (guard, updates) in cases(map, rules, &ground, *step) {
            clauses.push(Clause { actions: vec![id], guard, updates, span, generated: true });
        }
    }
    let uncrashed = |e| if can_crash { Expr::And(vec![e, not(var(CRASH))]) } else { e };
    let init = match (free(&ground, Move { name: "", dx: 0, dy: 0 }), can_crash) {
        (Some(free), _) => uncrashed(free),
        (None, true) => not(var(CRASH)),
        (None, false) => Expr::TRUE,
    };
    let labels = map.labels.iter().map(|Lettered { name, cells, .. }| {
        let expr = if cells.is_empty() {
            Expr::FALSE
        } else {
            uncrashed(Expr::Member(vec![var(X), var(Y)], set(cells)))
        };
        Label { name: name.clone(), expr, ty: Type::Bool, nested: false, span }
    });
    let labels = labels.chain(map.clearance.iter().map(distance));
    Base {
        vars: variables(map, can_crash, span),
        actions: ids,
        clauses,
        edges: None,
        labels: labels.collect(),
        init,
        absorb: if can_crash { var(CRASH) } else { Expr::FALSE },
        map: Some(Map {
            width: map.width,
            height: map.height,
            obstacles: map.obstacles.clone(),
            unknown: map.unknown.clone(),
            letters: map
                .labels
                .iter()
                .filter_map(|label| Some((label.name.clone(), label.letter?)))
                .collect(),
            x: X,
            y: Y,
            crash: can_crash.then_some(CRASH),
            place: map.place,
        }),
        coordinates: None,
        poisoned: false,
    }
}

fn variables(map: &GridMap, can_crash: bool, span: Span) -> TiVec<VarId, Var> {
    let range = |size: u32| Type::Range { lo: 0, hi: i64::from(size) - 1 };
    let var = |name: &str, ty| Var { name: name.to_owned(), ty, sums: None, span };
    let mut vars: TiVec<VarId, Var> = TiVec::new();
    vars.push(var("x", range(map.width)));
    vars.push(var("y", range(map.height)));
    if can_crash {
        vars.push(var("crash", Type::Bool));
    }
    vars
}

/// Whether the cell that the move leads to is free, given that it is inside; `None` where it always is.
fn free(ground: &Ground, step: Move) -> Option<Expr<Leaf>> {
    let target = vec![moved(X, step.dx), moved(Y, step.dy)];
    match ground {
        Ground::Open => None,
        Ground::Obstacles(obstacles) => Some(not(Expr::Member(target, obstacles.clone()))),
        Ground::Free(free) => Some(Expr::Member(target, free.clone())),
    }
}

/// The cell that the move leads to is an obstacle; `None` where it never is.
fn blocked(map: &GridMap, ground: &Ground, step: Move) -> Option<Expr<Leaf>> {
    let target = || vec![moved(X, step.dx), moved(Y, step.dy)];
    match ground {
        Ground::Open => None,
        Ground::Obstacles(obstacles) => Some(Expr::Member(target(), obstacles.clone())),
        Ground::Free(free) => {
            let blocked = not(Expr::Member(target(), free.clone()));
            Some(match leaves(map, step) {
                None => blocked,
                Some(outside) => Expr::And(vec![not(outside), blocked]),
            })
        }
    }
}

type Case = (Expr<Leaf>, Vec<(VarId, Update)>);

/// The guarded outcomes of one move: a free cell, an obstacle, the edge. The move to a free cell needs no guard
/// against the edge: an update that leaves a range is no transition.
fn cases(map: &GridMap, rules: &Rules, ground: &Ground, step: Move) -> Vec<Case> {
    let change = |id, by| (by != 0).then(|| (id, Update::Assign(moved(id, by))));
    let updates = change(X, step.dx).into_iter().chain(change(Y, step.dy)).collect();
    let free = free(ground, step).unwrap_or(Expr::TRUE);
    let corner = rules.corner.and_then(|rule| Some((rule, between(map, ground, step)?)));
    let mut cases = match &corner {
        None => vec![(free.clone(), updates)],
        Some((_, between)) => vec![(Expr::And(vec![free.clone(), not(between.clone())]), updates)],
    };
    // Only a clause of the file leads onto an obstacle, where `stay` is a move onto one like others.
    let onto = (step.dx, step.dy) != (0, 0) || rules.clauses_move;
    let onto = if onto { blocked(map, ground, step) } else { None };
    let mut bumps = vec![(rules.obstacle, onto), (rules.edge, leaves(map, step))];
    bumps.extend(corner.map(|(rule, between)| (rule, Some(Expr::And(vec![between, free])))));
    for (rule, guard) in bumps {
        let updates = match rule {
            Rule::Undefined => continue,
            Rule::Stay => Vec::new(),
            Rule::Crash => vec![(CRASH, Update::Assign(Expr::TRUE))],
        };
        cases.extend(guard.map(|guard| (guard, updates)));
    }
    cases
}

/// The move is diagonal and passes between two obstacles; `None` where it never does. Both are inside the map, and so is
/// the cell that it leads to.
fn between(map: &GridMap, ground: &Ground, step: Move) -> Option<Expr<Leaf>> {
    let beside = |dx, dy| blocked(map, ground, Move { dx, dy, ..step });
    match (step.dx, step.dy) {
        (0, _) | (_, 0) => None,
        (dx, dy) => Some(Expr::And(vec![beside(dx, 0)?, beside(0, dy)?])),
    }
}
