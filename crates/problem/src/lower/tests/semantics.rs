use super::ok;
use crate::{Node, Objective, Semantics, display};

const SYSTEM: &str = "system S {
  state x: 0..3, b: bool;
  action left, right;
  on * { x' = x; }
}
";

/// The translation of a formula within 3 steps.
fn translated(semantics: &str, body: &str) -> String {
    let text = format!("{SYSTEM}objective o within 3 semantics {semantics} {{ exists p. {body} }}");
    let problem = ok(&text).problem;
    let shown = display::objective(&problem, &problem.objectives[0]);
    shown.strip_prefix("exists p. ").expect("the quantifier").to_owned()
}

fn objective(body: &str) -> Objective {
    let problem = ok(&format!("{SYSTEM}objective o within 3 {body}")).problem;
    problem.objectives.into_iter().next().expect("an objective")
}

#[test]
fn what_fits_in_the_trace_is_left_alone() {
    for semantics in ["pes", "opt", "hpes", "hopt"] {
        for body in [
            "b[p]",
            "X X X b[p]",
            "F[0,3] b[p]",
            "G[1,2] b[p]",
            "b[p] U[0,3] x[p] == 1",
            "x[p] == 1 R[2,3] b[p]",
        ] {
            assert_eq!(translated(semantics, body), body, "{semantics}");
        }
    }
}

#[test]
fn negations_reach_the_literals() {
    assert_eq!(translated("pes", "!(b[p] -> X b[p])"), "b[p] & X !b[p]");
    assert_eq!(translated("pes", "!(b[p] U[0,2] x[p] == 1)"), "!b[p] R[0,2] x[p] != 1");
    assert_eq!(translated("opt", "!(b[p] W[1,2] x[p] == 1)"), "!b[p] R[1,2] x[p] != 1 & F[0,2] !b[p]");
    assert_eq!(translated("pes", "b[p] <-> X b[p]"), "b[p] & X b[p] | !b[p] & X !b[p]");
}

#[test]
fn constants_hold_beyond_the_trace_or_nothing_does() {
    let cases = [
        ("pes", "G b[p]", "false"),
        ("opt", "G b[p]", "G b[p]"),
        ("pes", "F b[p]", "F b[p]"),
        ("opt", "F b[p]", "true"),
        ("pes", "G (b[p] | true)", "false"),
        ("opt", "X X X X (b[p] & false)", "true"),
        ("pes", "X X X X (b[p] | true)", "false"),
        ("pes", "X X X N b[p]", "false"),
        ("opt", "X X X X b[p]", "true"),
        ("pes", "G[0,4] b[p]", "false"),
        ("opt", "b[p] U[1,5] x[p] == 1", "b[p] U[1,5] x[p] == 1 | G b[p]"),
        ("pes", "b[p] R x[p] == 1", "(b[p] R x[p] == 1) & F b[p]"),
        ("pes", "F G[0,2] b[p]", "F (G[0,2] b[p] & F[2,2] true)"),
        ("opt", "G X b[p]", "G (X b[p] | N false)"),
    ];
    for (semantics, body, expected) in cases {
        let plain = |text: &str| text.replace(['(', ')'], "");
        assert_eq!(plain(&translated(semantics, body)), plain(expected), "{semantics} {body}");
    }
}

#[test]
fn halted_paths_stay_where_they_are() {
    let cases = [
        ("hpes", "G b[p]", "F[3,3] halted[p] & G b[p] & F N false & b[p]"),
        ("hopt", "F b[p]", "!F[3,3] halted[p] | F b[p] | F N false & b[p]"),
        ("hpes", "X X X X b[p]", "F[3,3] halted[p] & X X X b[p]"),
        // The least offset beyond the trace is 4: where more is asked, the left operand has to hold there as well.
        ("hpes", "b[p] U[4,5] x[p] == 1", "F[3,3] halted[p] & G b[p] & F N false & x[p] == 1"),
        (
            "hpes",
            "b[p] U[5,5] x[p] == 1",
            "F[3,3] halted[p] & G b[p] & F N false & x[p] == 1 & F N false & b[p]",
        ),
        ("hpes", "X X X X action[p] == left", "false"),
        ("hopt", "X X X X action[p] == left", "true"),
        ("hpes", "X X X X action[p] != left", "false"),
        ("hpes", "X X X X (action[p] == left | b[p])", "F[3,3] halted[p] & X X X b[p]"),
        ("hpes", "X X X X if action[p] == left then b[p] else true", "false"),
        ("hpes", "X X X X x[p] == (if action[p] == left then 1 else 2)", "false"),
        ("hopt", "X X X X x[p] == (if action[p] == left then 1 else 2)", "true"),
    ];
    for (semantics, body, expected) in cases {
        // The printer puts the parentheses where they belong; the rest matters here.
        let plain = |text: &str| text.replace(['(', ')'], "");
        assert_eq!(plain(&translated(semantics, body)), expected, "{semantics} {body}");
    }
}

#[test]
fn the_size_is_linear() {
    let nodes = |semantics: &str, depth: usize| {
        let open = "(b[p] <-> x[p] == 1 U[1,2] (x[p] == 2 R X ".repeat(depth);
        let text = format!("{semantics} {{ exists p. {open}b[p]{} }}", "))".repeat(depth));
        objective(&text).formula.nodes.len()
    };
    for semantics in Semantics::ALL.map(|s| format!("semantics {}", s.name())) {
        let (one, two) = (nodes(&semantics, 40), nodes(&semantics, 80));
        assert!(two <= 2 * one + 40, "{semantics}: {one} and {two} nodes");
        assert!(two <= 30 * nodes("", 80), "{semantics}: {two} nodes");
    }
}

#[test]
fn children_stand_before_parents_and_nothing_is_left_over() {
    for semantics in Semantics::ALL {
        let text = format!(
            "semantics {} {{ exists p. G (b[p] -> !(X b[p] U[1,2] F x[p] == 1)) }}",
            semantics.name()
        );
        let formula = objective(&text).formula;
        let mut read = vec![false; formula.nodes.len()];
        for (id, node) in formula.nodes.iter_enumerated() {
            assert!(node.children().into_iter().all(|child| child < id), "{semantics:?}");
            node.children().into_iter().for_each(|child| read[usize::from(child)] = true);
        }
        read[usize::from(formula.root())] = true;
        assert!(read.iter().all(|&read| read), "{semantics:?}");
        let halting = matches!(semantics, Semantics::HaltingPessimistic | Semantics::HaltingOptimistic);
        let atoms = formula.nodes.iter().filter(|n| matches!(n, Node::Atom(_))).count();
        assert!(atoms <= 3 + usize::from(halting), "{semantics:?}: {atoms} atoms");
    }
}
