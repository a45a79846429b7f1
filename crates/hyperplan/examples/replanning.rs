//! A robot that finds obstacles on its way: the map changes, and the problem is solved again from where it is, in the time
//! that is left. A plan that is still good is kept: the checker says so, without any solver.
#![allow(clippy::print_stdout, reason = "an example shows what it found")]

use hyperplan::answer::{Scalar, WitnessPath};
use hyperplan::{Cell, Error, Grid, Options, Problem, System, Verdict, Verification};
use std::collections::BTreeSet;

type Position = (u32, u32);

const SIZE: u32 = 8;
const GOAL: Position = (7, 7);

/// What is known: where the robot is, what it has seen, and how many steps are left.
fn problem(at: Position, seen: &BTreeSet<Position>, left: usize) -> Result<Problem, Error> {
    let cell = |x: usize, y: usize| {
        let is_seen = seen.iter().any(|&(a, b)| (a as usize, b as usize) == (x, y));
        if is_seen { Cell::Obstacle } else { Cell::Free }
    };
    let side = SIZE as usize;
    let map = Grid::new(side, side, cell).label("start", [at]).label("goal", [GOAL]);
    Problem::builder()
        .constant("T", left)
        .system("World", System::grid(map).item("edge stay;").absorb("goal"))
        .objective("arrive", "exists p. start[p] & F[0,T] goal[p]")
        .build()
}

fn cell(path: &WitnessPath, time: usize) -> Option<Position> {
    let number = |name: &str| match path.states.get(time)?.get(name)? {
        Scalar::Int(n) => u32::try_from(*n).ok(),
        _ => None,
    };
    Some((number("x")?, number("y")?))
}

/// What is left of a plan.
fn rest(path: &WitnessPath, time: usize) -> WitnessPath {
    let (actions, states) = (path.actions[time..].to_vec(), path.states[time..].to_vec());
    WitnessPath { actions, states, positions: None, ..path.clone() }
}

fn main() -> Result<(), Error> {
    // A wall with one gap at its end, of which nothing is known at first.
    let wall: BTreeSet<Position> = (0..SIZE - 1).map(|x| (x, 4)).collect();
    let (mut seen, mut at, mut left) = (BTreeSet::new(), (0, 0), 40_usize);
    let (mut searches, mut kept) = (0, 0);
    let mut plan: Option<WitnessPath> = None;
    while at != GOAL {
        let now = problem(at, &seen, left)?;
        let objective = now.only_objective()?;
        // The old plan may be as good with the new map.
        let old = plan.take().filter(|old| {
            objective.strategy(std::slice::from_ref(old)).and_then(|s| objective.verify(&s)).ok()
                == Some(Verification::Holds)
        });
        let path = match old {
            Some(old) => {
                kept += 1;
                old
            }
            None => {
                searches += 1;
                let outcome = objective.solve(&Options::new())?;
                assert_eq!(outcome.verdict(), Verdict::Realizable, "from {at:?} with {left} steps left");
                outcome.path("p").cloned().expect("a plan has its path")
            }
        };
        let next = cell(&path, 1).expect("a plan has a next state");
        if wall.contains(&next) {
            println!("at {at:?}: {next:?} is an obstacle");
            seen.insert(next);
            plan = Some(path);
            continue;
        }
        let mut rest = rest(&path, 1);
        // A plan is as long as its horizon, which is one step shorter now.
        rest.actions.truncate(left - 1);
        rest.states.truncate(left);
        (at, left, plan) = (next, left - 1, Some(rest));
    }
    println!("arrived with {left} steps left after {searches} searches; {kept} times the plan was kept");
    assert!(searches >= 2 && kept >= 8);
    Ok(())
}

#[test]
fn it_runs() -> Result<(), Error> {
    main()
}
