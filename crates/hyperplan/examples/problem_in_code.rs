//! Problems built in code: of variables, a roadmap, and an occupancy grid.
#![allow(clippy::print_stdout, reason = "an example shows what it found")]

use hyperplan::draw::Kind;
use hyperplan::{Cell, Error, Graph, Grid, Options, Problem, System, Verdict, Verification};

/// A battery that a robot charges at one end of a corridor.
fn of_variables() -> Result<Problem, Error> {
    let robot = System::new()
        .state("x", "0..9")
        .state("charge", "0..12")
        .actions(["left", "right", "charging"])
        .on("left", "charge > 0", "x' = x - 1; charge' = charge - 1;")
        .on("right", "charge > 0", "x' = x + 1; charge' = charge - 1;")
        .on("charging", "x == 0", "charge' = 12;")
        .init("x == 3 & charge == 5")
        .label("end", "x == 9")
        .absorb("end");
    Problem::builder()
        .constant("T", 16)
        .system("Robot", robot)
        .objective("there", "exists p. F[0,T] end[p]")
        .build()
}

/// A roadmap whose edges have lengths.
fn of_a_graph() -> Result<Problem, Error> {
    let mut roads = Graph::new();
    let [gate, ramp, hall] = ["gate", "ramp", "hall 2"].map(|name| roads.state(name));
    for (from, to, metres) in [(gate, ramp, 4), (ramp, hall, 3), (gate, hall, 9), (hall, hall, 0)] {
        roads.edge(from, if from == to { "wait" } else { "go" }, to, &[("metres", metres)]);
    }
    roads.initial(gate);
    roads.label("goal", [hall]);
    Problem::builder()
        .system("Yard", System::graph(roads).cost("way", "metres"))
        .objective("cheap", "exists p. F[0,3] goal[p] minimize cost way[p];")
        .build()
}

/// A room with a wall that has a door.
fn of_a_grid() -> Result<Problem, Error> {
    let wall = |x: usize, y: usize| if x == 5 && y != 2 { Cell::Obstacle } else { Cell::Free };
    let room = Grid::new(10, 6, wall).place(0.5, [0.0, 0.0, 0.0]);
    let room = room.label("start", [(0, 0)]).label("goal", [(9, 5)]);
    Problem::builder()
        .constant("T", 20)
        .system("Room", System::grid(room).item("edge stay;").absorb("goal"))
        .objective("through", "exists p. start[p] & F[0,T] goal[p]")
        .build()
}

fn main() -> Result<(), Error> {
    for problem in [of_variables()?, of_a_graph()?, of_a_grid()?] {
        let objective = problem.only_objective()?;
        let outcome = objective.solve(&Options::new())?;
        assert_eq!(outcome.verdict(), Verdict::Realizable);
        for path in outcome.paths() {
            println!("{}: {}: {}", objective.name(), path.path, path.actions.join(" "));
        }
        for cost in outcome.costs() {
            println!("{} = {}", cost.expression, cost.value);
            assert_eq!((cost.value, cost.least), (7, 7));
        }
        let Some(strategy) = outcome.strategy() else { continue };
        assert_eq!(objective.verify(strategy)?, Verification::Holds);
        println!("{}", String::from_utf8_lossy(&objective.draw(strategy, Kind::Svg)?).len());
    }
    let least = of_a_grid()?.only_objective()?.minimize("T", None, &Options::new())?;
    println!("the shortest way through the door has {:?} steps", least.value);
    assert_eq!((least.value, least.proved), (Some(14), true));
    Ok(())
}

#[test]
fn it_runs() -> Result<(), Error> {
    main()
}
