//! The cheapest way on weighted maps and graphs, against an explicit search that knows nothing of formulas.

use hyperplan_plan::{Cheapest, Config, Limits, Pruning, Quantifiers, States, Verdict, cheapest};
use hyperplan_problem::{Overrides, Problem, read};
use hyperplan_solver::{Deadline, Spec};
use hyperplan_syntax::SourceMap;
use hyperplan_tests::random::Random;
use std::time::Duration;

/// How many maps, and as many graphs.
const CASES: u64 = 500;

/// Places with weighted ways between them.
struct Ways {
    places: usize,
    /// From, to, and what that costs.
    steps: Vec<(usize, usize, i64)>,
    goals: Vec<usize>,
    /// How many steps there may be.
    most: usize,
}

impl Ways {
    /// The least that a way costs from the first place to a goal, in no more steps than there may be.
    fn least(&self) -> Option<i64> {
        let mut paid = vec![None; self.places];
        paid[0] = Some(0);
        let mut best = None;
        for _ in 0..=self.most {
            let there = self.goals.iter().filter_map(|&goal| paid[goal]).min();
            best = [best, there].into_iter().flatten().min();
            let mut next: Vec<Option<i64>> = vec![None; self.places];
            for &(from, to, cost) in &self.steps {
                // What comes to a goal stays there, and is counted above.
                if let Some(paid) = paid[from].filter(|_| !self.goals.contains(&from)) {
                    next[to] = Some(next[to].map_or(paid + cost, |known: i64| known.min(paid + cost)));
                }
            }
            paid = next;
        }
        best
    }
}

/// A map of cells with weights, written with a letter for each; a move costs what the cell does that it leaves.
fn map(random: &mut Random) -> (String, Ways) {
    let (width, height) = (2 + random.below(5), 1 + random.below(4));
    let weights: Vec<usize> = (0..width * height).map(|_| random.below(10)).collect();
    let blocked = |cell: usize| weights[cell] == 9 && cell > 0;
    let goal = random.below(width * height);
    let letter = |cell: usize| match weights[cell] {
        // The first cell is where it starts, and that is no obstacle.
        9 if cell > 0 => '#',
        weight => char::from(b'a' + u8::try_from(weight).expect("a digit")),
    };
    let rows: Vec<String> = (0..height)
        .map(|row| {
            let y = height - 1 - row;
            format!("\"{}\"", (0..width).map(|x| letter(y * width + x)).collect::<String>())
        })
        .collect();
    let used: Vec<usize> = {
        let mut used: Vec<usize> =
            (0..width * height).filter(|&cell| !blocked(cell)).map(|cell| weights[cell]).collect();
        used.sort_unstable();
        used.dedup();
        used
    };
    let most = random.below(width * height + 3);
    let letters = used.iter().map(|w| format!("legend '{}' = w{w};", char::from(b'a' + *w as u8)));
    let cost = used.iter().fold("0".to_owned(), |rest, w| format!("if w{w} then {w} else {rest}"));
    let text = format!(
        "system M = grid {{ {} }} {{ {} moves up, down, left, right, stay; init x == 0 & y == 0;",
        rows.join(" "),
        letters.collect::<Vec<_>>().join(" "),
    );
    let text = text
        + &format!(
            "label there = x == {} & y == {}; absorb there; cost c = {cost}; }}\n\
             objective o {{ exists p. F[0,{most}] there[p] minimize cost c[p]; }}",
            goal % width,
            goal / width
        );
    let mut steps = Vec::new();
    for cell in (0..width * height).filter(|&cell| !blocked(cell)) {
        let (x, y) = (cell % width, cell / width);
        let mut to = vec![cell];
        to.extend((x > 0).then(|| cell - 1));
        to.extend((x + 1 < width).then(|| cell + 1));
        to.extend((y > 0).then(|| cell - width));
        to.extend((y + 1 < height).then(|| cell + width));
        let cost = i64::try_from(weights[cell]).expect("a digit");
        steps.extend(to.into_iter().filter(|&to| !blocked(to)).map(|to| (cell, to, cost)));
    }
    let goals = if blocked(goal) { Vec::new() } else { vec![goal] };
    (text, Ways { places: width * height, steps, goals, most })
}

/// A graph whose transitions carry lengths, some none; the text, and the file.
fn graph(random: &mut Random) -> (String, String, Ways) {
    let places = 2 + random.below(8);
    let mut steps: Vec<(usize, usize, i64)> = Vec::new();
    let mut described = Vec::new();
    for (number, from) in
        (0..1 + random.below(3 * places)).map(|n| (n, random.below(places))).collect::<Vec<_>>()
    {
        let (to, length) = (random.below(places), i64::try_from(random.below(10)).expect("a digit"));
        steps.push((from, to, length));
        let length = if length == 0 { String::new() } else { format!(", \"length\": {length}") };
        described.push(format!("{{\"from\": {from}, \"action\": \"go{number}\", \"to\": {to}{length}}}"));
    }
    // Whoever is anywhere may wait, at a price.
    for place in 0..places {
        steps.push((place, place, 1));
        described
            .push(format!("{{\"from\": {place}, \"action\": \"wait\", \"to\": {place}, \"length\": 1}}"));
    }
    let actions: Vec<String> = (0..steps.len() - places).map(|n| format!("\"go{n}\"")).collect();
    let goals: Vec<usize> = random.subset(places, 4);
    let states: Vec<String> = (0..places).map(|place| place.to_string()).collect();
    let file = format!(
        "{{\"states\": [{}], \"actions\": [{}, \"wait\"], \"initial\": [0], \"transitions\": [{}], \"labels\": {{\"goal\": {goals:?}}}}}",
        states.join(", "),
        actions.join(", "),
        described.join(", "),
    );
    let most = random.below(places + 3);
    let text = format!(
        "system M = graph(\"g.json\") {{ absorb goal; cost c = length; }}\n\
         objective o {{ exists p. F[0,{most}] goal[p] minimize 2 * cost c[p] + 1; }}"
    );
    (text, file, Ways { places, steps, goals, most })
}

fn lowered(text: &str, file: &str) -> Problem {
    let loader = |_: &str| Ok(file.to_owned().into_bytes());
    let lowered = read(&mut SourceMap::new(), "weighted.hp", text, &loader, &Overrides::default());
    assert!(!lowered.has_errors(), "{text}\n{file}\n{:#?}", lowered.diagnostics);
    lowered.problem
}

/// Compares what is found, one way or another, with the least of a search; whether there is a way at all.
fn compare(seed: u64, (text, file): (&str, &str), ways: &Ways, value: impl Fn(i64) -> i64) -> bool {
    let problem = lowered(text, file);
    let objective = &problem.objectives[0];
    let expected = ways.least().map(value);
    let unpruned = Limits { pruning: Pruning::Light, ..Limits::default() };
    let all = [
        (Quantifiers::Auto, None, Limits::default()),
        (Quantifiers::Cegis, Some(States::Onehot), unpruned),
        (Quantifiers::Auto, Some(States::Bitvec), Limits::default()),
    ];
    // By variable it takes longer, and every fifth time is enough.
    for (quantifiers, states, limits) in all.into_iter().take(if seed.is_multiple_of(5) { 3 } else { 2 }) {
        let deadline = Deadline::after(Duration::from_secs(60));
        let config = Config { quantifiers, states, limits, deadline, ..Config::new(Spec::Builtin) };
        let answer = cheapest(&problem, objective, &objective.minimize, &config).expect("it is supported");
        let Cheapest { outcome, values, undecided } = answer;
        let context = || format!("seed {seed}, {quantifiers} {states:?}\n{text}\n{file}");
        assert!(undecided.is_none() && outcome.verdict != Verdict::Unknown, "{}", context());
        assert_eq!(values.first().map(|value| value.found), expected, "{}", context());
        assert!(values.iter().all(|value| value.found == value.least), "{}", context());
        assert_eq!(outcome.verdict == Verdict::Realizable, expected.is_some(), "{}", context());
    }
    expected.is_some()
}

#[test]
fn the_cheapest_way_on_a_map() {
    let mut found = 0;
    for seed in 0..CASES {
        let (text, ways) = map(&mut Random::new(seed));
        found += u64::from(compare(seed, (&text, ""), &ways, |least| least));
    }
    assert!((CASES / 5..CASES).contains(&found), "{found}");
}

#[test]
fn the_cheapest_way_in_a_graph() {
    let mut found = 0;
    for seed in 0..CASES {
        let (text, file, ways) = graph(&mut Random::new(seed));
        found += u64::from(compare(seed, (&text, &file), &ways, |least| 2 * least + 1));
    }
    assert!((CASES / 5..CASES).contains(&found), "{found}");
}
