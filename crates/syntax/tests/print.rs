//! The formatter: what it does to particular texts, and that it changes none of the problem files.

mod common;
mod random;

use common::{SOURCE, good};
use hyperplan_random::{Random, property};
use hyperplan_syntax::{parse, print};
use random::roundtrip::{self, without_places};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The text, formatted, with all that the formatter owes to it.
fn formatted(text: &str) -> String {
    roundtrip::formatted(&good(text), text)
}

/// The formula, formatted on lines of its own.
fn formula(text: &str) -> String {
    let printed = formatted(&format!("objective o {{\n{text} }}"));
    let inside = printed.strip_prefix("objective o {\n").and_then(|rest| rest.strip_suffix("\n}\n"));
    let lines = inside.expect("the formula stands in braces").lines();
    lines.map(|line| line.strip_prefix("  ").unwrap_or(line)).collect::<Vec<_>>().join("\n")
}

/// The texts of all problem files without errors, and the prelude.
fn problem_files() -> Vec<String> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut folders = vec![crates.join("../specs"), crates.join("problem/src")];
    let mut texts = Vec::new();
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).expect("the specs are part of the repository");
        let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("readable").path()).collect();
        paths.sort();
        for path in paths {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "hp") {
                texts.extend(std::fs::read_to_string(&path).ok());
            }
        }
    }
    texts.retain(|text| parse(SOURCE, text).1.is_empty() && text.len() < 20_000);
    assert!(texts.len() > 60, "{}", texts.len());
    texts
}

#[test]
fn all_problem_files() {
    for text in problem_files() {
        formatted(&text);
    }
}

/// Trees are the same after printing and parsing.
#[test]
fn random_trees() {
    property(150, 5000, |random| {
        let file = random::tree::file(random);
        let printed = print(&file, "");
        let (again, errors) = parse(SOURCE, &printed);
        assert!(errors.is_empty(), "{:?}\n{printed}", errors[0]);
        assert!(without_places(&again) == without_places(&file), "another tree\n{printed}");
        assert!(print(&again, &printed) == formatted(&printed), "another text\n{printed}");
    });
}

/// Texts that were damaged are parsed without a panic, every place of a message lies in the text, and what is still a
/// problem file can be formatted.
#[test]
fn damaged_texts() {
    let texts = problem_files();
    let start = Instant::now();
    let mut sound = 0;
    let mut seed = 0;
    while seed < 100 || start.elapsed() < Duration::from_secs(1) {
        let mut random = Random::new(seed);
        let (text, other) = (&texts[random.below(texts.len())], &texts[random.below(texts.len())]);
        let text = random::damage::damaged(&mut random, text, other, random::damage::PIECES);
        let survived = std::panic::catch_unwind(|| survives(&text));
        match survived {
            Ok(clean) => sound += u32::from(clean),
            Err(_) => panic!("seed {seed}:\n{text}"),
        }
        seed += 1;
    }
    assert!(sound > 5, "of {seed} texts {sound} are sound");
}

/// Whether there is nothing wrong with the text.
fn survives(text: &str) -> bool {
    let (_, errors) = parse(SOURCE, text);
    for error in &errors {
        for span in error.span.iter().chain(error.related.iter().map(|(span, _)| span)) {
            assert!(text.get(span.range()).is_some(), "{error:?}");
        }
    }
    if errors.is_empty() {
        formatted(text);
    }
    errors.is_empty()
}

#[test]
fn parentheses() {
    for text in [
        "(a | b) & c -> d",
        "a & b | c & (d -> e) <-> f",
        "(a -> b) -> c -> d",
        "(a <-> b) <-> c",
        "(a U[0,1] b) U c U d",
        "!(x == 1) & !a & !F a",
        "G x[p] == x[q] + 1",
        "(G x[p]) == y",
        "1 - (2 - 3) - -4 * (5 + 6) * (7 % 8)",
        "(if a then b else c) & d",
        "if a then b & c else if d then e else f & g",
        "(a & b) & c",
        "((a, b)) in {(1, 2)}",
        "X X N a",
        "F[2] a & F[1,T + 1] b & x in 0 .. T - 1 & x in 0..3 & up in enabled[p]",
    ] {
        let expected = text.replace("(a <-> b) <-> c", "a <-> b <-> c").replace("((a, b))", "(a, b)");
        assert_eq!(formula(text), expected);
    }
    assert_eq!(formula("((a) & ((b[p])) | (c & d)) -> (e -> (F (g)))"), "a & b[p] | c & d -> e -> F g");
    assert_eq!(formula("∃p.∀q. ¬a[p] ∧ ◇[0,1] b[q]"), "exists p. forall q. !a[p] & F[0,1] b[q]");
}

/// All constructs, most in parentheses that are not needed.
const ODD: &str = "\
const A = (if ((a) & b) then (c -> (d -> e)) else (if (x) then y else ((on W[false] not) % (1)))) - ((2)) * (-(3));

system S {
  state x : (0) .. (T - 1), y : { red , blue }, z : bool, r : real;
  action left, right;
  on left | right when (x == (0)) { x' = ((x) + 1); y' in { (red), (blue) }; x' in (0) .. (2); }
  on * { }
  on left {
    x' = 1;
  }
  init ((x) == 0) & y in { red }; label goal = (x, (y)) in { (0, red) };
  observe (x), y;
  absorb ((goal));
}

system M = grid { \"..G\" \"S..\" edge stay; }
system E = grid { \"SG\" }
system N = grid(\"f.txt\") { moves up, down; legend 'W' = water; }
system G = graph(\"g.json\");
system H = graph(\"g.json\") { }
template u(a) { G a }
define near(p, q) = (x[p] - x[q]) <= 1;

template t(a, k) {
  exists p. (F[(1), k] (a[p]) U[k] (X (!(a[p]))))
}

objective o within (T) semantics stutter { define d(p) = (a[p]); exists p : S . exists q : S , r : M . forall d .
  ((((a[p]) & b[q]) | (near(p, q))) <-> (state[p] in enabled[q])) }
objective i { exists p. exists q : S. (((a[p] == 1) & b[q])) }
objective u { ((a) -> b) }
objective s within (2) * T = t(goal, (1) + 2);
";

/// Wherever comments stand, formatting twice is the same as formatting once.
#[test]
fn comments_anywhere() {
    let mut sound = 0;
    for part in ODD.split("\n\n") {
        let tree = without_places(&good(part));
        for at in (0..=part.len()).filter(|at| part.is_char_boundary(*at)) {
            let (before, after) = part.split_at(at);
            let inside = |c: char| c.is_alphanumeric() || c == '_';
            if before.ends_with(inside) && after.starts_with(inside) {
                continue;
            }
            let (next, rest) = after.split_at(after.chars().next().map_or(0, char::len_utf8));
            for text in [
                format!("{before} // c\n{after}"),
                format!("{before}\n// c\n{after}"),
                format!("{before}\n\n  // c\n  // d\n\n{after}"),
                format!("{before}// c\n{next}// d\n{rest}"),
            ] {
                let (commented, errors) = parse(SOURCE, &text);
                // In a string or in the middle of `..` it is no comment.
                if errors.is_empty() && without_places(&commented) == tree {
                    roundtrip::formatted(&commented, &text);
                    sound += 1;
                }
            }
        }
    }
    assert!(sound > 2000, "{sound}");
}

#[test]
fn quantifiers_share_their_words() {
    assert_eq!(formula("exists p. exists q. a"), "exists p, q. a");
    assert_eq!(formula("exists p: S. exists q: S, r: T. a"), "exists p, q: S, r: T. a");
    assert_eq!(formula("exists p. exists q: S. a"), "exists p. exists q: S. a");
    assert_eq!(formula("exists p: S. exists q. forall r. a"), "exists p: S, q. forall r. a");
    assert_eq!(formula("exists p. forall q.\n a"), "exists p. forall q.\n  a");
}

#[test]
fn layout() {
    let text = "
// The rooms.


const T=6; // six
const U1 = 1+2   // why
  ;
system Rooms { // rooms

  // first
  state  x: 0..2, // the column
         y: 0 .. T - 1;
  on left  { x' = x - 1; }
  on right|up {
    x' = x + 1; // go
    // nothing more
  }
  on * {}
  label goal = (x,y) in {(0,0),(1,1),(2,2),(3,3),(4,4),(5,5),(6,6),(7,7),(8,8),(9,9),(10,10),(11,11)};

  // the end
}
system W = grid { \"..G\" // top
 \"S.\\\"\" // bottom
 edge stay; }
objective o { exists p: Rooms. forall r: W. (goal[p] & (F[0,T] goal[r])) // done
  | G[0,2*T] !(x[p] == 1) }
objective s within 2*T = shortest(start,
  T);
// over";
    let expected = "\
// The rooms.

const T = 6;  // six
const U1 = 1 + 2;  // why
system Rooms {  // rooms
  // first
  state x: 0..2,  // the column
        y: 0 .. T - 1;
  on left { x' = x - 1; }
  on right | up {
    x' = x + 1;  // go
    // nothing more
  }
  on * { }
  label goal =
    (x, y) in {(0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (5, 5), (6, 6), (7, 7), (8, 8), (9, 9),
               (10, 10), (11, 11)};

  // the end
}
system W = grid {
  \"..G\"  // top
  \"S.\\\"\"
} {  // bottom
  edge stay;
}
objective o {
  exists p: Rooms. forall r: W.
    goal[p] & F[0,T] goal[r]  // done
    | G[0,2 * T] !(x[p] == 1)
}
objective s within 2 * T = shortest(start, T);
// over
";
    assert_eq!(formatted(text), expected);
    assert_eq!(formatted(&text.replace('\n', "\r\n")), expected);
    assert_eq!(formatted("objective o { exists p. a[p] }"), "objective o { exists p. a[p] }\n");
    assert_eq!(print(&good(""), ""), "");
    assert_eq!(formatted("\u{feff}// a\n"), "// a\n");
}

/// Neither depth nor length troubles the stack.
#[test]
fn deep_and_long() {
    let levels = hyperplan_syntax::MAX_NESTING as usize - 2;
    for (open, close) in
        [("!(", ")"), ("!", ""), ("a -> ", ""), ("a U[0,1] (", ")"), ("if a then ", " else b")]
    {
        formatted(&format!("const A = {}a{};", open.repeat(levels), close.repeat(levels)));
    }
    let chain = format!("const A = a{};", " & a".repeat(100_000));
    assert_eq!(print(&good(&chain), &chain).lines().count(), 100_002);
}
