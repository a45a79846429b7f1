//! Texts that are nearly problem files: cut off, spliced, with pieces lost, repeated or put in.

use hyperplan_random::Random;

/// Pieces to put in: what the grammar turns on, and what it does not know.
pub const PIECES: &[&str] = &[
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ";",
    ",",
    ".",
    "..",
    ":",
    "=",
    "==",
    "'",
    "\"",
    "!",
    "&",
    "|",
    "->",
    "<->",
    "-",
    "+",
    "*",
    "<",
    "//",
    "/*",
    "\n",
    "\r\n",
    "\r",
    "\t",
    "\0",
    "\u{feff}",
    "\u{2028}",
    "é",
    "−",
    "∧",
    "𝒰",
    "exists p.",
    "forall q: S.",
    "G",
    "F[0,T]",
    "U",
    "X",
    "if ",
    " then ",
    " else ",
    " in ",
    "define ",
    "const ",
    "system S {",
    "objective o {",
    "state ",
    "label ",
    "on ",
    " when ",
    "bool",
    "enabled[p]",
    "semantics ",
    "within ",
    "not ",
    "and ",
    "legend 'W' = #;",
    "legend '#0000ff' = a;",
    "scenario \"a.scen\" 1;",
    "unknown free;",
    "inflate 0.3 m;",
    "scale 2;",
    "crop 0..1, 0..2;",
    "// c\n",
    "next(",
    "MODULE ",
    "TRUE",
    "system S = grid { \"S.G\" } {",
    "system S = graph(\"g.json\");",
    "template t(a, T) {",
    "x: 0..3",
    "{a, b}",
    "int",
    "real",
    " semantics hopt",
    "action[p] == action[q]",
    "state[p] == state[q]",
    "obs[p] == obs[q]",
    "a in enabled[p]",
    "undefined",
    "stay",
    "crash",
    "x' in {0, 1};",
];

/// `text`, damaged a few times, with parts of `other` and `pieces`.
pub fn damaged(random: &mut Random, text: &str, other: &str, pieces: &[&str]) -> String {
    let mut text = text.to_owned();
    for _ in 0..=random.below(3) {
        let (start, end) = range(random, &text);
        match random.below(6) {
            0 => text.replace_range(start..end, ""),
            1 => {
                let piece = random.one(pieces);
                text.insert_str(start, piece);
            }
            2 => {
                let (from, to) = range(random, other);
                text.insert_str(start, &other[from..to]);
            }
            3 => text.replace_range(start..end, random.one(pieces)),
            4 => {
                let again = text[start..end].to_owned();
                text.insert_str(end, &again);
            }
            _ if random.below(4) == 0 => text.truncate(start),
            _ => text = swapped(random, &text),
        }
    }
    text
}

/// A short piece of a text.
fn range(random: &mut Random, text: &str) -> (usize, usize) {
    let start = boundary(text, random.below(text.len() + 1));
    let end = boundary(text, (start + random.below(25)).min(text.len()));
    (start, end.max(start))
}

/// Two lines change places.
fn swapped(random: &mut Random, text: &str) -> String {
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    if lines.is_empty() {
        return String::new();
    }
    let (first, second) = (random.below(lines.len()), random.below(lines.len()));
    lines.swap(first, second);
    lines.concat()
}

fn boundary(text: &str, mut at: usize) -> usize {
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}
