use super::{codes, lowered, lowered_with, messages, ok};
use crate::{
    Expr, Interval, Leaf, Mode, Node, Objective, Overrides, PathId, PathLeaf, Problem, Quantifier, display,
};

const ROOMS: &str = "const T = 6;
system Rooms {
  state x: 0..2, y: 0..1, b: bool;
  action left, right;
  on * { x' = x; }
  label start = x == 0; label goal = x == 2; label avoid = false;
  observe y, b;
}
";

fn objective(text: &str) -> (Problem, Objective) {
    let problem = ok(&format!("{ROOMS}{text}")).problem;
    let objective = problem.objectives.first().expect("an objective").clone();
    (problem, objective)
}

/// The objective as printed again.
fn shown(text: &str) -> String {
    let (problem, objective) = objective(text);
    display::objective(&problem, &objective)
}

#[test]
fn nodes_and_atoms() {
    let (_, o) = objective(
        "objective o { exists p. forall q. start[p] & F[0,T] goal[p] & (start[q] -> (!goal[q] U[1,T] goal[p])) }",
    );
    assert_eq!(o.mode, Mode::Bounded);
    let quantifiers: Vec<_> = o.paths.iter().map(|p| (p.name.as_str(), p.quantifier)).collect();
    assert_eq!(quantifiers, [("p", Quantifier::Exists), ("q", Quantifier::Forall)]);
    let Node::And(parts) = &o.formula.nodes[o.formula.root()] else { panic!("{:?}", o.formula) };
    assert_eq!(parts.len(), 3);
    assert!(matches!(
        &o.formula.nodes[parts[0]],
        Node::Atom(Expr::Leaf(PathLeaf::State(PathId(0), Leaf::Label(_))))
    ));
    assert!(matches!(o.formula.finally(parts[1]), Some((Interval { lo: 0, hi: Some(6) }, _))));
    let Some((_, until)) = o.formula.implication(parts[2]) else { panic!() };
    let Node::Until(i, not, _) = &o.formula.nodes[until] else { panic!() };
    assert_eq!(*i, Interval { lo: 1, hi: Some(6) });
    assert!(matches!(&o.formula.nodes[*not], Node::Not(_)));
    for (id, node) in o.formula.nodes.iter_enumerated() {
        assert!(node.children().iter().all(|child| *child < id));
    }
}

#[test]
fn every_form_lowers_to_what_it_prints() {
    let cases = [
        ("G[2] x[p] + 1 < x[q]", "G[0,2] x[p] + 1 < x[q]"),
        ("action[p] == left & action[q] != right", "action[p] == left & action[q] != right"),
        ("G[0,T] action[p] == action[q]", "G[0,6] action[p] == action[q]"),
        ("action[p] != action[q]", "action[p] != action[q]"),
        ("action[p] == none | b[q]", "action[p] != left & action[p] != right | b[q]"),
        ("action[p] in {left, right} & b[q]", "(action[p] == left | action[p] == right) & b[q]"),
        ("left in enabled[p] & !(right in enabled[q])", "left in enabled[p] & !right in enabled[q]"),
        ("state[p] != state[q]", "state[p] != state[q]"),
        ("obs[p] == obs[q]", "y[p] == y[q] & (b[p] <-> b[q])"),
        ("obs[p] != obs[q]", "!(y[p] == y[q] & (b[p] <-> b[q]))"),
        ("b[p] == goal[q]", "b[p] <-> goal[q]"),
        ("b[p] != (F[0,1] goal[q])", "!(b[p] <-> F[0,1] goal[q])"),
        ("x[p] != 1 & x[q] in 0..1", "x[p] != 1 & 0 <= x[q] & x[q] <= 1"),
        ("(x[p], y[q]) in {(0, 0), (1, 1)}", "(x[p], y[q]) in {(0, 0), (1, 1)}"),
        ("if b[p] then F[0,1] b[q] else b[q]", "b[p] & F[0,1] b[q] | !b[p] & b[q]"),
        ("(if b[p] then x[p] else 2 * x[q]) == 1", "(if b[p] then x[p] else 2 * x[q]) == 1"),
        ("X N b[p] <-> b[q]", "X N b[p] <-> b[q]"),
        ("b[p] R[0,2] b[q] W[1,2] b[q]", "b[p] R[0,2] (b[q] W[1,2] b[q])"),
        ("near(q, p)", "x[q] == x[p]"),
        ("F[0,2] !both(p, q) & gap(p, q) < 1", "F[0,2] !(x[p] == x[q] & goal[p]) & x[p] - x[q] < 1"),
    ];
    let defines = "define near(a, b) = x[a] == x[b]; define both(a, b) = near(a, b) & goal[a]; define gap(a, b) = x[a] - x[b];";
    for (body, printed) in cases {
        let text = format!("{defines} objective o {{ exists p. forall q. {body} }}");
        let shown = shown(&text);
        let expected = format!("exists p. forall q. {printed}");
        // `And` inside `And` keeps its parentheses: compare without.
        let plain = |s: &str| s.replace("(0 <= x[q] & x[q] <= 1)", "0 <= x[q] & x[q] <= 1");
        assert_eq!(plain(&shown), expected, "{body}");
    }
}

#[test]
fn within_a_length() {
    let (_, o) = objective("objective o within T + 1 { exists p. F goal[p] & G[1,2] b[p] }");
    assert_eq!(o.mode, Mode::Within(7));
    let unbounded =
        o.formula.nodes.keys().any(|id| matches!(o.formula.finally(id), Some((Interval::ALWAYS, _))));
    assert!(unbounded);
    let (_, o) = objective("objective o within T = action_robust(start, goal, b, T);");
    assert_eq!(o.mode, Mode::Within(6));
}

#[test]
fn the_prelude_is_free_of_mistakes() {
    let mut sources = hyperplan_syntax::SourceMap::new();
    let source = sources.add("prelude.hp", crate::prelude::TEXT);
    let (file, diagnostics) = hyperplan_syntax::parse(source, crate::prelude::TEXT);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    assert_eq!(file.items.len(), 7);
    assert!(crate::prelude::templates().iter().all(|t| t.doc.contains("The paper's (")), "documented");
}

#[test]
fn instances_of_the_prelude() {
    let cases = [
        (
            "shortest_path(start, goal, T)",
            "exists p. forall q. start[p] & F[0,6] goal[p] & (start[q] -> !goal[q] U[0,6] goal[p])",
        ),
        (
            "longest_path(start, goal, T)",
            "exists p. forall q. start[p] & F[0,6] goal[p] & (start[q] & F[0,6] goal[q] -> !goal[p] U[0,6] goal[q])",
        ),
        (
            "initial_state_robust(start, avoid, goal, b, 2)",
            "exists p. forall q. start[p] & !b[p] U[0,2] goal[p] \
             & (avoid[q] & G[0,2] action[p] == action[q] -> !b[q] U[0,2] goal[q])",
        ),
        (
            "action_robust(start, goal, avoid, T - 1)",
            "exists p. forall q. start[p] & !avoid[p] U[0,5] goal[p] \
             & (start[q] & G[0,5] (action[p] != action[q] -> N G[0,5] action[p] == action[q]) -> !avoid[q] U[0,5] goal[q])",
        ),
        (
            "action_robust_successive(start, goal, avoid, 2, T)",
            "exists p. forall q. start[p] & !avoid[p] U[0,6] goal[p] \
             & (start[q] & G[1,5] F[0,1] action[p] == action[q] -> !avoid[q] U[0,6] goal[q])",
        ),
        (
            "initial_state_opaque(start, goal, T)",
            "exists p. exists q. start[p] & state[p] != state[q] \
             & G[0,6] (action[p] == action[q] & (y[p] == y[q] & (b[p] <-> b[q]))) & F[0,6] goal[p] & F[0,6] goal[q]",
        ),
        (
            "current_state_opaque(start, goal, 0)",
            "exists p. exists q. start[p] & state[p] == state[q] & G[0,0] (y[p] == y[q] & (b[p] <-> b[q])) \
             & F[0,0] goal[p] & F[0,0] goal[q] & F[0,0] state[p] != state[q]",
        ),
    ];
    for (instance, printed) in cases {
        assert_eq!(shown(&format!("objective o = {instance};")), printed);
    }
}

#[test]
fn own_templates() {
    let text =
        "template twice(l, n) { define d(a) = l[a] & x[a] < n; exists p. F[0,n] d(p) & F[n, 2 * n] l[p] }
        objective o = twice(goal, 2); objective s = shortest_path(start, goal, T);";
    assert_eq!(shown(text), "exists p. F[0,2] (goal[p] & x[p] < 2) & F[2,4] goal[p]");
    // An own template hides the one of the prelude.
    let text = "template shortest_path(g) { exists p. g[p] } objective o = shortest_path(goal);";
    assert_eq!(shown(text), "exists p. goal[p]");
}

#[test]
fn several_systems() {
    let text = "system A { state x: 0..1; label start = x == 0; label goal = x == 1; observe x; }
        system B { state z: 0..1, y: bool; action go; label home = z == 0; observe z; }
        objective o { exists p: A. forall q: B. x[p] == z[q] & y[q] & obs[p] == obs[q] & action[p] == action[q] }
        objective s = shortest_path(start, goal, 3);";
    let problem = ok(text).problem;
    let systems = |o: &Objective| o.paths.iter().map(|p| p.system.0).collect::<Vec<_>>();
    assert_eq!(systems(&problem.objectives[0]), [0, 1]);
    assert_eq!(systems(&problem.objectives[1]), [0, 0]);
    let header = "system A { state x: 0..1; label l = x == 0; } system B { state z: 0..1, m: {a}; }\n";
    let found = |text: &str| codes(&format!("{header}{text}"));
    assert_eq!(found("objective o { exists p. x[p] == 0 }"), [("which-system", "p".to_owned())]);
    assert_eq!(found("objective o { exists p: C. x[p] == 0 }"), [("unknown-system", "C".to_owned())]);
    let states = found("objective o { exists p: A. exists q: B. state[p] == state[q] }");
    assert_eq!(states, [("type-mismatch", "state[p] == state[q]".to_owned())]);
    assert_eq!(found("objective o { exists p: B. x[p] == 0 }"), [("unknown-name", "x".to_owned())]);
    let instance = found("objective o = shortest_path(l, gaol, 3);");
    assert_eq!(instance, [("unknown-name", "gaol".to_owned()); 1]);
    assert_eq!(found("objective o = shortest_path(l, z, 3);")[0].0, "which-system");
}

#[test]
fn unused_paths_are_warned_of() {
    let (lowered, _) = lowered(&format!("{ROOMS}objective o {{ exists p. forall q. goal[p] }}"));
    assert!(!lowered.has_errors());
    let warnings: Vec<_> = lowered.diagnostics.iter().map(|d| d.code).collect();
    assert_eq!(warnings, ["unused-path"]);
}

#[test]
fn mistakes_in_objectives() {
    let cases = [
        ("goal", "missing-path", "goal"),
        ("goal[0]", "unknown-name", "goal[0]"),
        ("goal.p", "unknown-name", "goal.p"),
        ("gaol[p]", "unknown-name", "gaol"),
        ("goal[q]", "unquantified-path", "q"),
        ("goal[p, p]", "argument-count", "goal[p, p]"),
        ("F goal[p]", "unbounded-operator", "F goal[p]"),
        ("goal[p] U goal[p]", "unbounded-operator", "goal[p] U goal[p]"),
        ("F[0,-1] goal[p]", "negative-bound", "-1"),
        ("F[0,1000000] goal[p]", "bound-too-large", "1000000"),
        ("F[3,2] goal[p]", "empty-interval", "[3,2]"),
        ("F[0,x] goal[p]", "unknown-name", "x"),
        ("F[0,x[p]] goal[p]", "not-constant", "x[p]"),
        ("x[p]", "type-mismatch", "x[p]"),
        ("x[p] == goal[p]", "type-mismatch", "x[p] == goal[p]"),
        ("action[p]", "misplaced-special", "action[p]"),
        ("action[p] == lift", "unknown-action", "lift"),
        ("action[p] == 1", "type-mismatch", "1"),
        ("action[p] == state[p]", "type-mismatch", "action[p] == state[p]"),
        ("action[p] < left", "type-mismatch", "action[p] < left"),
        ("state[p] == left", "type-mismatch", "left"),
        ("up in enabled[p]", "unknown-action", "up"),
        ("left == 1", "misplaced-action", "left"),
        ("nope(p)", "unknown-name", "nope"),
        ("x[p] + (F[0,1] goal[p]) == 1", "misplaced-temporal", "F[0,1] goal[p]"),
        ("x[p] == true + 0.5", "type-mismatch", "true"),
    ];
    for (body, code, marked) in cases {
        let found = codes(&format!("{ROOMS}objective o {{ exists p. {body} }}"));
        assert_eq!(found, [(code, marked.to_owned())], "{body}");
    }
}

#[test]
fn mistakes_in_headers_and_templates() {
    let cases = [
        ("objective o { exists p, p. goal[p] }", "duplicate-name", "p"),
        ("objective o within 0 - 1 { exists p. F goal[p] }", "negative-bound", "0 - 1"),
        ("objective o within 3000000 { exists p. F goal[p] }", "bound-too-large", "3000000"),
        ("objective o within T semantics pess { exists p. F goal[p] }", "unknown-name", "pess"),
        ("objective o = shortest_pat(start, goal, T);", "unknown-template", "shortest_pat"),
        ("objective o = shortest_path(start, T);", "argument-count", "shortest_path"),
        ("objective o = shortest_path(start, 3, T);", "parameter-kind", "3"),
        ("objective o = shortest_path(start, gaol, T);", "unknown-name", "gaol"),
        ("objective o = shortest_path(start, goal, goal);", "unknown-name", "goal"),
        ("objective o = shortest_path(start, goal, 0 - 2);", "negative-bound", "0 - 2"),
        ("objective o = shortest_path(start, goal, 5000000);", "bound-too-large", "5000000"),
        ("objective o = shortest_path(start, x, T);", "parameter-kind", "x"),
        ("template t(a) { exists p. a[p] & F[0,a] a[p] }", "parameter-kind", "a"),
        ("template t(a, a) { exists p. a[p] }", "duplicate-name", "a"),
        ("template t(a) { exists p. a[q] }", "unquantified-path", "q"),
        ("define d(a) = e(a); define e(a) = d(a); objective o { exists p. d(p) }", "cyclic-define", "d"),
        ("define d(a) = goal[a]; objective o { exists p. d(p, p) }", "argument-count", "d(p, p)"),
        ("define d(a) = goal[b]; objective o { exists p. d(p) & d(p) }", "unquantified-path", "b"),
        ("objective o { exists p. goal[p] } objective o { exists p. goal[p] }", "duplicate-name", "o"),
    ];
    for (text, code, marked) in cases {
        let found = codes(&format!("{ROOMS}{text}"));
        assert_eq!(found.first(), Some(&(code, marked.to_owned())), "{text}: {found:?}");
        assert!(found.len() <= 2, "{text}: {found:?}");
    }
    assert_eq!(codes("objective o { exists p. a[p] }"), [("no-system", "p".to_owned())]);
    let text = "system S { state x: 0..1; } objective o { exists p, q. obs[p] == obs[q] }";
    assert_eq!(codes(text), [("nothing-observed", "obs[p] == obs[q]".to_owned())]);
}

#[test]
fn expanding_definitions_has_limits() {
    let mut text = format!("{ROOMS}define d0(p) = goal[p];");
    for i in 1..40 {
        text += &format!("define d{i}(p) = d{}(p) & d{}(p);", i - 1, i - 1);
    }
    assert_eq!(codes(&format!("{text} objective o {{ exists p. d39(p) }}"))[0].0, "too-large");
    let mut text = format!("{ROOMS}define d0(p) = goal[p];");
    for i in 1..3000 {
        text += &format!("define d{i}(p) = !d{}(p);", i - 1);
    }
    assert_eq!(codes(&format!("{text} objective o {{ exists p. d2999(p) }}"))[0].0, "too-large");
    assert_eq!(codes(&format!("{text} objective o {{ exists p. d400(p) }}")), []);
    let mut set = "x[p]".to_owned();
    for _ in 0..200 {
        set = format!("(if {set} in 0..1 then 1 else 0)");
    }
    assert_eq!(codes(&format!("{ROOMS} objective o {{ exists p. {set} == 1 }}"))[0].0, "too-large");
}

#[test]
fn deep_and_long_expressions() {
    let deep = format!("{}goal[p]{}", "(!".repeat(490), ")".repeat(490));
    assert_eq!(codes(&format!("{ROOMS} objective o {{ exists p. {deep} }}")), []);
    let deep = format!("{}x[p]{}", "(1 + ".repeat(490), ")".repeat(490));
    assert_eq!(codes(&format!("{ROOMS} objective o {{ exists p. {deep} > 1 }}")), []);
    let long = vec!["goal[p]"; 100_000].join(" & ");
    let (problem, o) = objective(&format!("objective o {{ exists p. {long} }}"));
    assert!(matches!(&o.formula.nodes[o.formula.root()], Node::And(parts) if parts.len() == 100_000));
    assert!(display::objective(&problem, &o).ends_with("..."));
}

#[test]
fn mistakes_in_a_template_name_the_instance() {
    let text = format!("{ROOMS}template t(n) {{ exists p. F goal[p] & F[0,n] goal[p] }} objective o = t(2);");
    let (lowered, sources) = lowered_with(&text, &[], &Overrides::none());
    assert_eq!(messages(&lowered, &sources), ["test.hp:9:27 unbounded-operator: `F` has no bound"]);
    assert_eq!(sources.snippet(lowered.diagnostics[0].related[0].0), "t");
}
