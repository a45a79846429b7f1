//! Plans that hide and plans that survive counted faults, on random maps: objectives of two players in which much depends on
//! little, for which there is an explicit search. All ways to decide them agree, and the checker decides them too.

use super::seeds;
use hyperplan_plan::{Quantifiers, Verdict};
use hyperplan_tests::judge::{lowered, verdict};
use hyperplan_tests::random::Random;
use hyperplan_tests::say;
use hyperplan_verify::{Budget, decide};

/// Rows of a map with a start and a goal, and obstacles in about a quarter of the other cells.
fn map(random: &mut Random) -> String {
    let (width, height) = (2 + random.below(3), 2 + random.below(2));
    let mut cells: Vec<char> =
        (0..width * height).map(|_| if random.once_in(4) { '#' } else { '.' }).collect();
    let start = random.below(cells.len());
    let goal = (start + 1 + random.below(cells.len() - 1)) % cells.len();
    (cells[start], cells[goal]) = ('S', 'G');
    let rows = cells.chunks(width).map(|row| format!("\"{}\"", row.iter().collect::<String>()));
    rows.collect::<Vec<_>>().join(" ")
}

fn problem(random: &mut Random) -> String {
    let rule = |random: &mut Random| random.one(&["undefined", "stay", "crash"]).to_owned();
    let (obstacle, edge) = (rule(random), rule(random));
    let observe = random.one(&["x", "y", "x + y"]).to_owned();
    let absorb = random.one(&["absorb goal;", ""]).to_owned();
    let (steps, most) = (2 + random.below(5), random.below(3));
    let world = format!(
        "system World = grid {{ {} }} {{ obstacle {obstacle}; edge {edge}; observe {observe}; {absorb} }}",
        map(random)
    );
    let faults = format!(
        "system Faults {{ state remain: 0..{most}; action fault, fine; on fault {{ remain' = remain - 1; }} on fine {{}} \
         init remain == {most}; }}"
    );
    let paths = "exists p: World. forall q: World";
    let reach = |p: &str| format!("F[0,{steps}] goal[{p}]");
    let tied = match random.below(3) {
        0 => format!("start[q] & G[0,{steps}] obs[p] == obs[q]"),
        1 => format!(
            "start[q] & F[0,{steps}] (action[p] != action[q] & X G[0,{steps}] action[p] == action[q])"
        ),
        _ => format!("G[0,{steps}] x[p] <= x[q]"),
    };
    let objective = match random.below(5) {
        0 => format!("{paths}. start[p] & {} & ({tied} -> {})", reach("p"), reach("q")),
        1 => format!("{paths}. start[p] & {} & ({tied} -> !({}))", reach("p"), reach("q")),
        2 => format!(
            "forall p: World. exists q: World. start[p] -> start[q] & F[0,{steps}] state[p] == state[q] & {}",
            reach("q")
        ),
        3 => format!(
            "exists p, r: World. forall q: World. start[p] & {} & ({tied} -> {} | F[0,{steps}] state[r] == state[q])",
            reach("r"),
            reach("q")
        ),
        _ => format!(
            "{paths}, f: Faults. start[p] & {} & (start[q] & G[1,{steps}] (action[f] == fine <-> action[p] == action[q]) -> {})",
            reach("p"),
            reach("q")
        ),
    };
    format!("{world}\n{faults}\nobjective o {{ {objective} }}\n")
}

#[test]
fn beliefs_are_decided_alike() {
    let mut tally = [0_u32; 2];
    for seed in seeds(1200) {
        let text = problem(&mut Random::new(seed));
        let typed = lowered(&text);
        let objective = &typed.objectives[0];
        let ways = [Quantifiers::Explicit, Quantifiers::Auto, Quantifiers::Cegis];
        let verdicts: Vec<Verdict> = ways.map(|quantifiers| verdict(&typed, objective, quantifiers)).to_vec();
        let checked = decide(&typed, objective, &Budget::default()).expect("it is well-formed");
        let holds = if verdicts[0] == Verdict::Realizable { Some(true) } else { Some(false) };
        assert!(verdicts.iter().all(|v| *v == verdicts[0]), "seed {seed}: {verdicts:?} by {ways:?}\n{text}");
        assert!(
            checked.is_none() || checked == holds,
            "seed {seed}: {verdicts:?}, the checker {checked:?}\n{text}"
        );
        tally[usize::from(holds == Some(true))] += 1;
    }
    say(&format!("{} realizable, {} unrealizable", tally[1], tally[0]));
    assert!(tally.iter().all(|count| *count * 10 > tally[0] + tally[1]), "one verdict is rare: {tally:?}");
}
