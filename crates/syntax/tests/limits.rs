//! Deep, long and random input. Tests run on threads with stacks of 2 MB.

mod common;

use common::{SOURCE, faults};
use hyperplan_random::property;
use hyperplan_syntax::ast::{ExprKind, Item};
use hyperplan_syntax::{MAX_NESTING, SourceMap, parse, print, render};

const MANY: usize = 100_000;

fn only_too_deep(text: &str) {
    let (_, errors) = parse(SOURCE, text);
    let codes: Vec<&str> = errors.iter().map(|error| error.code).collect();
    assert_eq!(codes, ["too-deep"], "{}", &text[..60]);
}

#[test]
fn deep_nesting_is_refused() {
    let repeat = |part: &str| part.repeat(MANY);
    only_too_deep(&format!("const A = {}1{};", repeat("("), repeat(")")));
    only_too_deep(&format!("const A = {}1;", repeat("(")));
    only_too_deep(&format!("const A = {}a;", repeat("!")));
    only_too_deep(&format!("const A = {}a;", repeat("- ")));
    only_too_deep(&format!("const A = {}a;", repeat("G X ")));
    only_too_deep(&format!("const A = {}a;", repeat("F[0,")));
    only_too_deep(&format!("const A = {}a;", repeat("a in {")));
    only_too_deep(&format!("const A = {}a;", repeat("a -> ")));
    only_too_deep(&format!("const A = {}a;", repeat("a U ")));
    only_too_deep(&format!("const A = {}a;", repeat("a <-> ")));
    only_too_deep(&format!("const A = {}a;", repeat("a * ")));
    only_too_deep(&format!("const A = {}a;", repeat("if a then ")));
    only_too_deep(&format!("const A = {}a;", repeat("if a then b else 1 + ")));
    only_too_deep(&format!("system S {{ on a {{ x' in {}{{1}}; }} }}", repeat("if a then ")));
    only_too_deep(&format!("const A = {}a;", repeat("(a, ")));
    only_too_deep(&format!("const A = {}a;", repeat("a & (b | (")));
    only_too_deep(&format!("objective o {{ {}a }}", repeat("!(")));
}

/// Chains within brackets within chains: no part is too deep, the whole is.
#[test]
fn heights_add_up() {
    let chain = " * a".repeat(300);
    let text = format!("const A = {}a{};", "(".repeat(300), format!("{chain})").repeat(300));
    let codes: Vec<&str> = parse(SOURCE, &text).1.iter().map(|error| error.code).collect();
    assert_eq!(codes, ["too-deep"]);
}

#[test]
fn nesting_up_to_the_limit_is_fine() {
    let levels = MAX_NESTING as usize - 1;
    let nested =
        |open: &str, close: &str| format!("const A = {}a{};", open.repeat(levels), close.repeat(levels));
    for text in [
        nested("(", ")"),
        nested("!(", ")"),
        nested("!", ""),
        nested("a -> ", ""),
        nested("a <-> ", ""),
        nested("a & (", ")"),
        nested("a U[0,1] (", ")"),
        nested("if a then ", " else b"),
        nested("1 in {", "}"),
        nested("(a, ", ")"),
    ] {
        let (file, errors) = parse(SOURCE, &text);
        assert!(errors.is_empty(), "{}: {errors:?}", &text[..40]);
        // What walks the tree may recurse.
        assert!(file.clone() == file);
        drop(file);
    }
}

#[test]
fn long_chains_are_fine() {
    for (op, expected) in [("&", MANY + 1), ("|", MANY + 1), ("+", MANY + 1), ("-", MANY + 1)] {
        let text = format!("const A = a{};", format!(" {op} a").repeat(MANY));
        let (file, errors) = parse(SOURCE, &text);
        assert!(errors.is_empty());
        let Item::Const(constant) = &file.items[0] else { panic!("no constant") };
        let length = match &constant.value.kind {
            ExprKind::And(items) | ExprKind::Or(items) => items.len(),
            ExprKind::Sum(items) => items.len(),
            other => panic!("{other:?}"),
        };
        assert_eq!(length, expected);
        drop(file);
    }
}

/// Whoever translates a `case` of another language writes chains like this.
#[test]
fn long_chains_of_conditions_are_flat() {
    let text = format!("const A = {}a;", "if a then b else ".repeat(MANY));
    let (file, errors) = parse(SOURCE, &text);
    assert!(errors.is_empty());
    let Item::Const(constant) = &file.items[0] else { panic!("no constant") };
    let ExprKind::If(branches, _) = &constant.value.kind else { panic!("no condition") };
    assert_eq!(branches.len(), MANY);
    assert_eq!(parse(SOURCE, &print(&file, "")).0.items.len(), 1);
    let text = format!("system S {{ on a {{ x' in {}0..9; }} }}", "if a then {1, 2} else ".repeat(MANY));
    assert!(parse(SOURCE, &text).1.is_empty());
}

#[test]
fn long_files_are_fine() {
    let text = "system S { state x: 0..1; on a { x' = 1; } }\n".repeat(10_000);
    assert_eq!(common::good(&text).items.len(), 10_000);
    let text = "const A = ;\n".repeat(10_000);
    assert_eq!(faults(&text).len(), 51);
    let row = format!("system S = grid {{ {} }}", "\"....\"\n".repeat(10_000));
    common::good(&row);
}

const PIECES: &[&str] = &[
    "const",
    "system",
    "template",
    "define",
    "objective",
    "state",
    "action",
    "on",
    "when",
    "init",
    "label",
    "observe",
    "absorb",
    "moves",
    "legend",
    "grid",
    "graph",
    "within",
    "semantics",
    "exists",
    "forall",
    "true",
    "if",
    "then",
    "else",
    "in",
    "div",
    "X",
    "N",
    "F",
    "G",
    "U",
    "R",
    "W",
    "a",
    "p",
    "x",
    "enabled",
    "not",
    "and",
    "0",
    "12",
    "0.5",
    "2x",
    "\"..G\"",
    "\"",
    "'W'",
    "'",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ";",
    ";",
    ":",
    ".",
    "..",
    "#",
    "=",
    "==",
    "!=",
    "<",
    "<=",
    ">",
    ">=",
    "+",
    "-",
    "*",
    "/",
    "%",
    "!",
    "&",
    "|",
    "->",
    "<->",
    "∃",
    "∀",
    "◇",
    "𝒰",
    "&&",
    "||",
    "=>",
    "<=>",
    "<>",
    "/\\",
    "~",
    ":=",
    "//",
    "/*",
    "*/",
    "\n",
    "\n",
    "\r\n",
    "\t",
    "é",
    "§",
    "\u{202e}",
    "\\",
    "\"a\\",
];

/// Parses and renders; what matters is that it ends without a panic, and spans lie in the text.
fn survives(text: &str) {
    let parsed = std::panic::catch_unwind(|| parse(SOURCE, text));
    let Ok((_, errors)) = parsed else { panic!("{text:?}") };
    for span in errors
        .iter()
        .flat_map(|error| error.span.into_iter().chain(error.related.iter().map(|place| place.0)))
    {
        assert!(text.get(span.range()).is_some(), "{span:?} in {text:?}");
    }
    assert!(errors.len() <= 51, "{text:?}");
    let mut sources = SourceMap::new();
    sources.add("random.hp", text);
    let shown = render(&sources, &errors, false, 80);
    assert!(shown.matches("random.hp").count() >= errors.len().min(50), "{text:?}\n{shown}");
    assert_eq!(render(&sources, &errors, false, 80), shown);
}

#[test]
fn random_tokens_never_panic() {
    property(3000, 200, |random| {
        let length = random.below(80);
        let mut text = String::new();
        for _ in 0..length {
            text.push_str(PIECES[random.below(PIECES.len())]);
            text.push_str(["", " ", " ", " "][random.below(4)]);
        }
        survives(&text);
    });
}

#[test]
fn damaged_files_never_panic() {
    const SOUND: &str = "// c\nconst T = 6;\nsystem Rooms {\n  state x: 0..2, y: {a, b};\n  action left, up;\n  on left | up when y == a { x' = x - 1; y' in {a, b}; }\n  label goal = x in 0..1 & (x, y) in {(0, a)};\n}\nsystem W = grid { \"..G\" \"S..\" } { legend 'W' = #; }\nobjective o within 2*T semantics pes {\n  define r(p) = goal[p];\n  exists p. forall q: Rooms. G[0,T] (r(p) -> if r(q) then x[q] == 1 else F goal[q] U[2] goal[p])\n}\nobjective s = t(goal, T);\n";
    common::good(SOUND);
    property(3000, 20, |random| {
        let mut text: Vec<char> = SOUND.chars().collect();
        for _ in 0..=random.below(4) {
            let at = random.below(text.len());
            match random.below(3) {
                0 => {
                    text.remove(at);
                }
                1 => text.insert(at, PIECES[random.below(PIECES.len())].chars().next().unwrap_or(' ')),
                _ => {
                    let end = (at + random.below(30)).min(text.len());
                    text.drain(at..end);
                }
            }
        }
        survives(&text.into_iter().collect::<String>());
    });
}
