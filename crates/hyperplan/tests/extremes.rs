//! Deep, long and strange files: refused with a message or read, always without a crash.

mod common;

use common::{Run, hyperplan, text};

const MANY: usize = 100_000;

/// Runs `check` on a file with these bytes, and `check --print` too, which must agree.
fn check(bytes: impl AsRef<[u8]>) -> Run {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("f.hp");
    std::fs::write(&file, bytes).expect("written");
    let run = hyperplan(&["check", "--timeout", "1", text(&file)]);
    let printed = hyperplan(&["check", "--print", text(&file)]);
    assert_eq!(printed.status, run.status, "{}", printed.stderr);
    assert_eq!(printed.stdout.is_empty(), run.status != 0);
    run
}

/// Refused, with so many messages and this one among them.
fn refused(bytes: impl AsRef<[u8]>, messages: usize, words: &str) {
    let run = check(bytes);
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert_eq!(run.stderr.matches("\n  x ").count(), messages, "{}", run.stderr);
    assert!(run.stderr.contains(words), "{}", run.stderr);
}

#[test]
fn deep_nesting_is_refused() {
    let repeat = |part: &str| part.repeat(MANY);
    let deep = "nested more than 500 levels deep";
    refused(format!("const A = {}1{};", repeat("("), repeat(")")), 1, deep);
    for part in ["!", "X ", "if a then ", "if a then b else 1 + ", "a -> ", "a U ", "- ", "F[0,", "(a, "] {
        refused(format!("const A = {}a;", repeat(part)), 1, deep);
    }
}

#[test]
fn long_chains_are_read() {
    let start = "system S {\n  state x: 0..1;\n  on step { x' = x; }\n  label a = x == 0";
    let chain = " & x == 0".repeat(MANY);
    let run = check(format!("{start}{chain};\n}}\nobjective o {{ exists p. a[p] }}\n"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    // Conditions that follow one another nest nothing.
    let chain = "if 0 == 1 then 2 else ".repeat(MANY);
    let run = check(format!("const A = {chain}3;\n{start};\n}}\nobjective o {{ exists p. a[p] }}\n"));
    assert_eq!(run.status, 0, "{}", run.stderr);
    // Nor do statements that come again.
    let many = ["init x == 0;", "absorb x == 1;", "trans x' == x | x == 0;"].map(|part| part.repeat(MANY));
    let run = check(format!("{start};\n{}\n}}\nobjective o {{ exists p. a[p] }}\n", many.concat()));
    assert_eq!(run.status, 0, "{}", run.stderr);
    // What is doubtful of so long a formula is another question.
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("f.hp");
    let chain = " & a[p]".repeat(MANY);
    std::fs::write(&file, format!("{start};\n}}\nobjective o {{ exists p. a[p]{chain} }}\n"))
        .expect("written");
    let printed = hyperplan(&["check", "--print", text(&file)]);
    assert_eq!((printed.status, printed.stdout.matches("a[p]").count()), (0, MANY + 1), "{}", printed.stderr);
}

#[test]
fn many_quantifiers_are_read() {
    let quantifiers: String = (0..5_000).map(|n| format!("exists p{n}. ")).collect();
    let text = format!("system S {{ state x: 0..1; }}\nobjective o {{ {quantifiers} x[q] == 1 }}\n");
    let run = check(text);
    assert_eq!(run.status, 2, "{}", run.stderr);
    assert!(run.stderr.contains("the path `q` is not quantified"), "{}", run.stderr);
}

#[test]
fn strange_bytes() {
    let empty = check("");
    assert_eq!(empty.status, 2);
    assert!(empty.stderr.contains("the file declares nothing"), "{}", empty.stderr);
    let latin = check(b"const T = 1;\n// gr\xf6\xdfe\n");
    assert_eq!(latin.status, 2);
    assert!(latin.stderr.contains("not in UTF-8") && latin.stderr.contains("on line 2"), "{}", latin.stderr);
    let zero = check("const T = 1;\0\n");
    assert_eq!(zero.status, 2);
    assert!(zero.stderr.contains("U+0000") && zero.stderr.contains("f.hp:1:13"), "{}", zero.stderr);
    let utf16: Vec<u8> = "const T = 1;\n".encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert_eq!(check(utf16).status, 2);
    let sound = "system S { state x: 0..1; on step { x' = x; } }\nobjective o { exists p. x[p] == 1 }\n";
    for text in
        [sound.to_owned(), sound.replace('\n', "\r\n"), sound.replace(' ', "\t"), format!("\u{feff}{sound}")]
    {
        let run = check(&text);
        assert_eq!(run.status, 0, "{}", run.stderr);
    }
}
