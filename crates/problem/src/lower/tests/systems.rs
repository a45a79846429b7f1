use super::interpreter::{eval, holds, labelled, states, successors};
use super::{codes, lowered_with, ok};
use crate::{Expr, Overrides, System, Type, Value};

fn system(text: &str) -> System {
    ok(text).problem.systems.first().expect("a system").clone()
}

#[test]
fn rooms() {
    let text = "system Rooms {
        state x: 0..2, y: 0..1;
        action left, right, up, down;
        on left { x' = x - 1; }
        on right { x' = x + 1; }
        on up when y == 0 { y' = 1; }
        on down when y == 1 { y' = 0; }
        label goal = y == 1 & x >= 1;
    }";
    let system = system(text);
    let at = |x, y| vec![Value::Int(x), Value::Int(y)];
    let go = |state: Vec<Value>, action: usize| {
        successors(&system, &state, system.actions[action]).into_iter().collect::<Vec<_>>()
    };
    assert_eq!(go(at(0, 0), 0), Vec::<Vec<Value>>::new());
    assert_eq!(go(at(0, 0), 1), [at(1, 0)]);
    assert_eq!(go(at(0, 0), 2), [at(0, 1)]);
    assert_eq!(go(at(0, 1), 2), Vec::<Vec<Value>>::new());
    assert_eq!(labelled(&system, "goal"), [at(1, 1), at(2, 1)]);
}

#[test]
fn choices_and_defaults() {
    let system = system(
        "system S { state x: 0..9, b: bool; on * { x' in {x, x + 1}; b' in {true, false}; } on step { x' in 0..2; } }",
    );
    let next = successors(&system, &[Value::Int(9), Value::Bool(false)], system.actions[0]);
    // 9 with either b (10 is out of range), and 0..2 with b unchanged.
    assert_eq!(next.len(), 5);
    assert_eq!(system.actions.len(), 1);
    assert!(system.init.is_true() && system.absorb.is_false());
}

#[test]
fn enumerations() {
    let text = "system S {
        state mode: {idle, busy, done};
        label idle = mode == idle; label not_done = done != mode; label some = mode in {idle, busy};
        label odd = (if idle then busy else mode) == busy;
        on step when !(busy == mode) { mode' = if idle then busy else done; }
        on step when busy == mode { mode' in {idle, done}; }
        observe mode;
    }";
    let system = system(text);
    assert_eq!(labelled(&system, "idle"), [vec![Value::Enum(0)]]);
    assert_eq!(labelled(&system, "not_done").len(), 2);
    assert_eq!(labelled(&system, "some").len(), 2);
    assert_eq!(labelled(&system, "odd").len(), 2);
    let next = |n| {
        successors(&system, &[Value::Enum(n)], system.actions[0]).into_iter().flatten().collect::<Vec<_>>()
    };
    assert_eq!(next(0), [Value::Enum(1)]);
    assert_eq!(next(1), [Value::Enum(0), Value::Enum(2)]);
    assert_eq!(next(2), [Value::Enum(2)]);
    assert!(matches!(&system.vars.first().expect("a variable").ty, Type::Enum(values) if values.len() == 3));
}

#[test]
fn arithmetic() {
    let text = "const K = 3; system S { state x: -4..4;
        label a = x * K - 2 * -x + 1 == 6; label b = x div 2 == -2; label c = x % 3 == 2;
        label d = (if x > 0 then x else 0 - x) in {1, 4}; label e = 1 < x & x <= K; label f = x in {-4, 0, 1, 2, 3, 4, 5, 6, 7, 8}; }";
    let system = system(text);
    let all = states(&system);
    assert_eq!(all.len(), 9);
    let values = |label| {
        let values = labelled(&system, label).into_iter().flatten();
        values.map(|v| if let Value::Int(n) = v { n } else { panic!() }).collect::<Vec<_>>()
    };
    assert_eq!(values("a"), [1]);
    assert_eq!(values("b"), [-4, -3]);
    assert_eq!(values("c"), [-4, -1, 2]);
    assert_eq!(values("d"), [-4, -1, 1, 4]);
    assert_eq!(values("e"), [2, 3]);
    assert_eq!(values("f"), [-4, 0, 1, 2, 3, 4]);
}

#[test]
fn labels_are_sorted() {
    let system = system(
        "system S { state x: 0..5; label c = a | b; label b = !a & x == 3; label a = x == 1; on step when c {} }",
    );
    for (id, label) in system.labels.iter_enumerated() {
        label.expr.for_each_leaf(&mut |leaf| {
            if let crate::Leaf::Label(read) = leaf {
                assert!(*read < id, "{}", label.name);
            }
        });
    }
    assert_eq!(labelled(&system, "c").len(), 2);
    let guard = &system.clauses[0].guard;
    assert_eq!(eval(&system, guard, &[Value::Int(3)]), Value::Bool(true));
    assert_eq!(eval(&system, guard, &[Value::Int(2)]), Value::Bool(false));
}

#[test]
fn a_long_chain_of_labels() {
    let mut text = "system S { state x: 0..5; ".to_owned();
    for i in 0..20_000 {
        text += &format!("label l{i} = l{} & x > 0; ", i + 1);
    }
    text += "label l20000 = x > 1; }";
    assert_eq!(system(&text).labels.len(), 20_001);
}

#[test]
fn constants_and_overrides() {
    let text = "const T = 6; const V = 2 * T + 1; system S { state x: 0..V; }";
    let (lowered, _) = lowered_with(text, &[], &Overrides::none().with("T", 4));
    let int = |name: &str, n| (name.to_owned(), Value::Int(n));
    assert_eq!(lowered.consts, [int("T", 4), int("V", 9)]);
    assert!(lowered.diagnostics.is_empty());
    let bad = Overrides::none().with("TT", 4).with("T", "four");
    let (lowered, _) = lowered_with(text, &[], &bad);
    let found: Vec<_> = lowered.diagnostics.iter().map(|d| (d.code, d.help.clone())).collect();
    assert_eq!(found, [("unknown-constant", Some("did you mean `T`?".to_owned())), ("not-a-number", None)]);
    assert_eq!(ok("const A = B + 1; const B = 2;").consts, [int("A", 3), int("B", 2)]);
    assert_eq!(codes("const A = B; const B = C; const C = B;"), [("cyclic-constant", "B".to_owned())]);
    assert_eq!(codes("const A = A;"), [("cyclic-constant", "A".to_owned())]);
    assert_eq!(codes("// nothing\n")[0].0, "empty-file");
    assert_eq!(ok("const A = if 2 > 1 & 5 in 0..9 then 7 % 4 else 0;").consts, [int("A", 3)]);
}

#[test]
fn fractions_are_exact() {
    let (lowered, _) = lowered_with("const V = 0.1; const H = 3 * V / 2;", &[], &Overrides::none());
    let real = |name: &str, n, d| (name.to_owned(), Value::Real(crate::Rational::new(n, d)));
    assert_eq!(lowered.consts, [real("V", 1, 10), real("H", 3, 20)]);
    let halved = Overrides::none().with("V", "-1/2");
    let (lowered, _) = lowered_with("const V = 0.1; const H = V + 1;", &[], &halved);
    assert_eq!(lowered.consts, [real("V", -1, 2), real("H", 1, 2)]);
    // Without real variables, comparisons of fractions become comparisons of integers.
    let text =
        "system S { state x: 0..9, y: 0..9; label l = (x + 1/2) / 3 <= 2 - 0.5 * y; label m = x < 7/2; }";
    let system = system(text);
    for state in states(&system) {
        let (Value::Int(x), Value::Int(y)) = (state[0], state[1]) else { panic!("{state:?}") };
        let holds_in =
            |label: usize| holds(&system, &system.labels[crate::LabelId::from(label)].expr, &state);
        assert_eq!(holds_in(0), 2 * x < 12 - 3 * y, "{state:?}");
        assert_eq!(holds_in(1), 2 * x < 7, "{state:?}");
    }
    let mut reals = 0;
    for label in &system.labels {
        let mut stack = vec![&label.expr];
        while let Some(e) = stack.pop() {
            reals +=
                usize::from(matches!(e, Expr::Scale(..) | Expr::ToReal(_) | Expr::Const(Value::Real(_))));
            stack.extend(e.children());
        }
    }
    assert_eq!(reals, 0);
}

#[test]
fn several_systems_share_actions() {
    let problem =
        ok("system A { action go, halt; } system B { action halt, run; } system C { state b: bool; }")
            .problem;
    assert_eq!(problem.actions.len(), 4);
    let a = problem.systems.first().expect("A");
    let b = problem.systems.iter().nth(1).expect("B");
    assert_eq!(a.actions[1], b.actions[0]);
}

#[test]
fn repeated_items_combine() {
    let s = system(
        "system S { state x: 0..5; init x > 0; init x < 2; absorb x == 1; absorb x == 2; observe x; observe x > 1, x; }",
    );
    assert!(matches!(&s.init, Expr::And(es) if es.len() == 2));
    assert!(matches!(&s.absorb, Expr::Or(es) if es.len() == 2));
    assert_eq!(s.observe.len(), 3);
}

#[test]
fn labels_of_any_type() {
    let system = system(
        "system S { state x: 0..3, m: {a, b}; label twice = 2 * half + x; label half = x div 2; \
         label other = if m == a then b else a; label more = twice > 3 & other == a; \
         trans twice' >= half; on step { x' in 0..3; m' in {a, b}; } } \
         objective o { exists p. twice[p] == 5 & F[0,1] (other[p] == m[p] | half[p] + 1 == x[p]) }",
    );
    let system = &system;
    let ty = |name: &str| system.labels[system.label(name).expect("it is declared")].ty.clone();
    assert_eq!(ty("half"), Type::Range { lo: 0, hi: 1 });
    assert_eq!(ty("twice"), Type::Range { lo: 0, hi: 5 });
    assert_eq!(ty("more"), Type::Bool);
    assert_eq!(labelled(system, "more").len(), 2);
    // From x = 2, where half is 1, no step leads to where twice is 0.
    let from = [Value::Int(2), Value::Enum(0)];
    assert_eq!(successors(system, &from, system.actions[0]).len(), 6);
}

#[test]
fn mistakes_in_systems() {
    let cases = [
        ("state x: 3..1;", "empty-range", "3..1"),
        ("state x: 0..M;", "unknown-name", "M"),
        ("state x: 0..2000000000000;", "number-too-large", "0..2000000000000"),
        ("state x: real; label a = x % 2 == 0;", "type-mismatch", "x"),
        ("state x: int, y: int; label a = x * y == 0;", "nonlinear", "x * y"),
        ("state x: real, y: real; label a = x / y == 0;", "bad-divisor", "y"),
        ("state x: real; label a = x / 0 == 0;", "bad-divisor", "0"),
        // -2^63 has no negative.
        (
            "state x: real; label a = 1 / (-2147483648.0 * 4294967296) == x;",
            "number-too-large",
            "-2147483648.0 * 4294967296",
        ),
        ("state x: int; on step { x' = x + 0.5; }", "type-mismatch", "x + 0.5"),
        ("state x: bool; on step { x' in 0..1; }", "type-mismatch", "0..1"),
        ("state x: real; on step { x' in 1..0.5; }", "empty-range", "1..0.5"),
        ("state x: bool, x: bool;", "duplicate-name", "x"),
        ("state m: {a, b, a};", "duplicate-name", "a"),
        ("action a, a;", "duplicate-name", "a"),
        ("action none;", "reserved-name", "none"),
        ("state obs: bool;", "reserved-name", "obs"),
        ("state x: 0..1; label x = true;", "duplicate-name", "x"),
        ("label a = a;", "cyclic-label", "a"),
        ("label a = b; label b = c; label c = b;", "cyclic-label", "b"),
        ("state x: 0..1; label a = xx == 1;", "unknown-name", "xx"),
        ("state x: 0..1; label a = x; init a;", "type-mismatch", "a"),
        ("state x: 0..1; label a = b & x == 0; label b = x;", "type-mismatch", "b"),
        ("state x: 0..1; trans y' == 0;", "unknown-name", "y'"),
        ("state x: 0..1; trans x';", "type-mismatch", "x'"),
        ("state x: 0..1; on step { x' in if x == 0 then {1} else {true}; }", "type-mismatch", "true"),
        ("state x: 0..1; on step { x' in if x then {1} else {0}; }", "type-mismatch", "x"),
        ("state x: 0..1, b: bool; label a = x == b;", "type-mismatch", "x == b"),
        ("state b: bool; label a = b < true;", "type-mismatch", "b < true"),
        ("state x: 0..1, y: 0..1; label a = x * y == 1;", "nonlinear", "x * y"),
        ("state x: 0..1; label a = x div 0 == 1;", "bad-divisor", "0"),
        ("state x: 0..1; label a = 4 % x == 1;", "bad-divisor", "x"),
        ("state x: 0..1; label a = x / 2;", "type-mismatch", "x / 2"),
        ("state x: 0..1; label a = x == 0.1234567890123456789;", "number-too-large", "0.1234567890123456789"),
        ("label a = 99999999999999999999 == 1;", "number-too-large", "99999999999999999999"),
        ("state x: 0..1000000000000; label a = x * 100000000 == 1;", "number-too-large", "x * 100000000"),
        ("state x: 0..1; on step { x' = true; }", "type-mismatch", "true"),
        ("state x: 0..1; on step { x' = 1; x' = 0; }", "repeated-update", "x'"),
        ("state x: 0..1; on step { z' = 1; }", "unknown-name", "z'"),
        ("state x: 0..1; label a = x == 1; on step { a' = true; }", "not-a-variable", "a'"),
        ("state x: 0..1; on step { x' in 2..1; }", "empty-range", "2..1"),
        ("state b: bool; on step { b' in 0..1; }", "type-mismatch", "0..1"),
        ("action go; on goo {}", "unknown-action", "goo"),
        ("on go {}", "unknown-action", "go"),
        ("state m: {a, b}; label l = m == c;", "unknown-name", "c"),
        ("state m: {a, b}; label l = a == b;", "ambiguous-name", "a"),
        ("state m: {a, b}, a: {a, b}; label l = m == a;", "ambiguous-name", "a"),
        ("state m: {a, b}, n: {c}; label l = m == n;", "type-mismatch", "m == n"),
        ("state m: {a, b}; on step { m' = 1; }", "type-mismatch", "1"),
        ("state x: 0..1; label l = (x, x) == 1;", "misplaced-tuple", "(x, x)"),
        ("state x: 0..1; label l = (x, x) in {(1, x)};", "not-constant", "x"),
        ("state x: 0..1; label l = (x, x) in {(1, 1, 1)};", "type-mismatch", "(1, 1, 1)"),
        ("state x: 0..1; label l = x in {true};", "type-mismatch", "true"),
        ("state x: 0..1; label l = x in 2..1;", "empty-range", "2..1"),
        ("state x: 0..1; label l = x[p] == 1;", "misplaced-path", "x[p]"),
    ];
    for (items, code, marked) in cases {
        let found = codes(&format!("system S {{ {items} }}"));
        assert_eq!(found, [(code, marked.to_owned())], "{items}");
    }
}

#[test]
fn several_mistakes_in_one_run() {
    let text = "const A = B; system S { state x: 0..A, y: 0..3; label l = x == 1 & yy == 2 | z; on step { y' = q; } label m = y == true; }";
    let found: Vec<_> = codes(text).into_iter().map(|(code, marked)| format!("{code} {marked}")).collect();
    // After x failed, unknown names in the system are not judged; the type of what is known still is.
    assert_eq!(found, ["unknown-name B", "type-mismatch y == true"]);
    let text = "system S { state y: 0..3; label l = yy == 2 | z; on step { y' = q; } }";
    let found: Vec<_> = codes(text).into_iter().map(|(_, marked)| marked).collect();
    assert_eq!(found, ["yy", "z", "q"]);
    assert_eq!(codes("system S {} system S {}")[0].0, "duplicate-name");
    assert_eq!(codes("const A = 1; const A = 2;")[0].0, "duplicate-name");
    assert_eq!(codes("system S = graph(\"g.json\") { }")[0].0, "cannot-read");
}

#[test]
fn what_transitions_do_besides() {
    let system = system(
        "system M = grid { \"S.\" \".#\" } {
            obstacle stay; edge crash;
            state batt: 0..2;
            also on right | up when batt > 0 { batt' = if action == up then batt - 1 else 0; }
            also on right when batt == 0 { batt' in {0, 2}; }
        }",
    );
    let at = |x, y, crash, batt| vec![Value::Int(x), Value::Int(y), Value::Bool(crash), Value::Int(batt)];
    let go = |state: Vec<Value>, action: &str| {
        let names = ["up", "down", "left", "right"];
        let position = names.iter().position(|name| *name == action).expect("a move");
        successors(&system, &state, system.actions[position]).into_iter().collect::<Vec<_>>()
    };
    // A move, a bump, a crash and a choice; and where it crashed nothing more.
    assert_eq!(go(at(0, 0, false, 2), "up"), [at(0, 1, false, 1)]);
    assert_eq!(go(at(0, 0, false, 2), "right"), [at(0, 0, false, 0)]);
    assert_eq!(go(at(0, 1, false, 1), "up"), [at(0, 1, true, 0)]);
    assert_eq!(go(at(0, 1, false, 0), "right"), [at(1, 1, false, 0), at(1, 1, false, 2)]);
    assert_eq!(go(at(0, 1, true, 1), "up"), [at(0, 1, true, 1)]);
    assert_eq!(go(at(0, 1, false, 2), "down"), [at(0, 0, false, 2)]);
}

#[test]
fn letters_of_a_large_map_are_told_apart() {
    let rows: Vec<String> =
        (0..600).map(|y| (0..700).map(|x| ["a", "b", "c"][(x * 7 + y * y) % 3]).collect()).collect();
    let text = "system M = grid(\"m.txt\") {
        legend 'a' = sand; legend 'b' = road; legend 'c' = mud;
        state fuel: 0..9;
        also on * when road { fuel' = fuel - 1; }
        also on up | down when sand { fuel' = fuel - 2; }
        also on * when mud { fuel' = fuel - 3; }
        also on left | right when sand & fuel > 1 { fuel' = fuel - 2; }
    }";
    let problem = super::ok_with(text, &[("m.txt", &rows.join("\n"))]).problem;
    assert_eq!(problem.systems.first().expect("a system").also.len(), 4);
}
