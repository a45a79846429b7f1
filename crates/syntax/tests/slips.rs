//! What is said about likely slips: the exact place, and nothing that follows from them.

mod common;

use common::{SOURCE, advice, faults};
use hyperplan_syntax::parse;

/// The only fault of `objective o { TEXT }`, and its help.
fn slip(text: &str) -> (String, String) {
    let text = format!("objective o {{ {text} }}\nconst T = 1;");
    let found = faults(&text);
    assert_eq!(found.len(), 1, "{text}\n{found:#?}");
    let (file, _) = parse(SOURCE, &text);
    assert!(matches!(file.items.last(), Some(hyperplan_syntax::ast::Item::Const(_))));
    (found[0].clone(), advice(&text))
}

#[test]
fn operators_of_other_languages() {
    let cases = [
        ("a = b", "=", "=="),
        ("a && b", "&&", "&"),
        ("a || b", "||", "|"),
        (r"a /\ b", r"/\", "&"),
        (r"a \/ b", r"\/", "|"),
        ("a and b", "and", "&"),
        ("a OR b", "OR", "|"),
        ("a <=> b", "<=>", "<->"),
        ("a <> b", "<>", "!="),
        ("a =< b", "=<", "<="),
        ("a mod 2 == 1", "mod", "%"),
        ("a until b", "until", "U"),
        ("not a[p]", "not", "!"),
        ("not (a == b)", "not", "!"),
        ("~a[p]", "~", "!"),
        ("<> a[p]", "<>", "F"),
        ("[] a[p]", "[]", "G"),
        ("always a[p]", "always", "G"),
        ("eventually !a[p]", "eventually", "F"),
    ];
    for (text, marked, instead) in cases {
        let (fault, help) = slip(text);
        assert_eq!(fault, format!("wrong-operator: `{marked}` is not an operator here @ {marked}"));
        assert_eq!(help, format!("write `{instead}`"));
    }
    assert_eq!(slip("a => b").1, "write `->` for implication, `>=` for \"at least\"");
    assert_eq!(slip("F[0..T] a").1, "write `[a,b]`");
}

#[test]
fn slips_are_read_as_meant() {
    let (file, errors) = parse(SOURCE, "objective o { exists p a && b }");
    assert_eq!(errors.len(), 2);
    assert_eq!(file.items.len(), 1);
}

#[test]
fn formulas() {
    assert_eq!(slip("a < b < c").0, "chained-comparison: comparisons cannot be chained @ <");
    assert_eq!(slip("a == !b").0, "needs-parentheses: `!` needs parentheses here @ !");
    assert_eq!(slip("X[0,1] a").0, "interval-not-allowed: `X` takes no interval @ [0,1]");
    assert_eq!(slip("F_T goal[p]").1, "an operator and its bound are written `F[0,T]`");
    assert_eq!(slip("GF goal[p]").1, "put blanks between operators: `G F`");
    assert_eq!(slip("a;").0, "syntax: a formula does not end with `;` @ ;");
    assert_eq!(slip("a & (exists q. b)").0, "syntax: expected an expression, found `exists` @ exists");
    assert_eq!(slip("a b").0, "syntax: expected an operator or `}`, found `b` @ b");
    assert_eq!(slip("a & U b").1, "this operator stands between two formulas: `a U b`");
    assert_eq!(slip("x' == 1").0, "syntax: expected an operator or `}`, found `'` @ '");
    assert_eq!(slip("x in y").1, "a set is written `{a, b}`, `0..2` or `enabled[p]`");
    assert_eq!(slip("x[0 + 1] == 1").0, "syntax: expected a path variable, found `0` @ 0");
    assert_eq!(slip("if a then b").1, "an `if` always has an `else`");
    assert_eq!(slip("F[0 T] a").0, "syntax: expected `,` or `]`, found `T` @ T");
    assert_eq!(slip("").0, "syntax: expected an expression, found `}` @ }");
    assert_eq!(slip("x in {1, = 3} & y").0, "syntax: expected an expression, found `=` @ =");
}

#[test]
fn quantifiers() {
    assert_eq!(slip("exists p forall q. a").0, "missing-dot: expected `.` after the path variables @ ");
    assert_eq!(slip("exists p, forall q. a").0, "missing-dot: expected `.`, found `,` @ ,");
    assert_eq!(slip("exists p F goal[p]").0, "missing-dot: expected `.` after the path variables @ ");
    assert_eq!(slip("Exists p. a").1, "did you mean `exists`?");
    assert_eq!(slip("A p. a").1, "did you mean `forall`?");
    assert_eq!(slip("exist p, q. a").1, "did you mean `exists`?");
    assert_eq!(slip("exists G. a").0, "reserved-name: `G` cannot be a name @ G");
    assert_eq!(slip("exists p. a & b define f(p) = a;").1, "definitions stand before the quantifiers");
}

#[test]
fn parentheses_point_at_their_partner() {
    let text = "objective o { exists p. (a & b }";
    let (_, errors) = parse(SOURCE, text);
    assert_eq!(errors.len(), 1);
    assert_eq!(errors[0].related.len(), 1);
    assert_eq!(&text[errors[0].related[0].0.range()], "(");
}

#[test]
fn names() {
    assert_eq!(faults("const G = 1;"), ["reserved-name: `G` cannot be a name @ G"]);
    assert_eq!(faults("const true = 1;"), ["reserved-name: `true` cannot be a name @ true"]);
    assert_eq!(faults("system S { label F = x == 1; action X, N; }").len(), 3);
    assert!(faults("system W { } objective U { forall p: W. true }").is_empty());
}

/// `M` is an operator between two operands only, and a name elsewhere.
#[test]
fn names_that_an_operator_shares() {
    let text = "const M = 1;
system M { state M: 0..M; action a; on a { M' = M; } label b = M == M; }
define c(M) = b[M] M b[M];
objective M { exists M: M. M[M] == M M M[M] == 2 & !M[M] == M M[M] b[M] & c(M) }";
    assert_eq!(faults(text), [""; 0]);
    let next_update = "system S { on a { x' = 1\n M' = 2; } }";
    assert_eq!(faults(next_update), ["missing-semicolon: expected `;` after the update @ "]);
}

#[test]
fn keywords() {
    assert_eq!(faults("systm S { }"), ["misspelt-keyword: unknown keyword `systm` @ systm"]);
    assert_eq!(advice("systm S { }"), "did you mean `system`?");
    assert_eq!(advice("system S { lable a = true; }"), "did you mean `label`?");
    assert_eq!(advice("system S { on a wen x == 1 { } }"), "did you mean `when`?");
    assert_eq!(advice("system S { on a if x == 1 { } }"), "did you mean `when`?");
    assert_eq!(advice("system S = gird(\"f\");"), "did you mean `grid`?");
    assert_eq!(advice("label a = x == 1;"), "`label` stands inside a system");
    assert_eq!(
        advice("system S {\n  define f(p) = x == 1;\n  init true;\n}"),
        "move it in front of the system"
    );
    assert_eq!(
        faults("hello"),
        ["syntax: expected `const`, `system`, `template`, `define` or `objective`, found `hello` @ hello"]
    );
}

#[test]
fn semicolons() {
    let text = "const A = 1\nconst B = 2\nsystem S {\n action a\n on a { x' = 1 }\n label l = true\n}";
    let found = faults(text);
    assert_eq!(
        found,
        [
            "missing-semicolon: expected `;` after the constant @ ",
            "missing-semicolon: expected `;` after the constant @ ",
            "missing-semicolon: expected `;` after `action` @ ",
            "missing-semicolon: expected `;` after the update @ ",
            "missing-semicolon: expected `;` after `label` @ ",
        ]
    );
    let (file, errors) = parse(SOURCE, text);
    assert_eq!(file.items.len(), 3);
    assert_eq!(errors[0].span.map(|span| span.start), Some(11));
    assert_eq!(advice("system S { };"), "no `;` follows a `}`");
    assert_eq!(faults("objective o { define f(p) = a[p]\n exists p. f(p) }").len(), 1);
}

#[test]
fn actions_of_a_clause() {
    for separator in ["||", ","] {
        let text = format!("system S {{ on a{separator} b | c {{ }} }}");
        let found = faults(&text);
        assert_eq!(
            found,
            [format!("wrong-operator: actions of a clause are separated by `|` @ {separator}")]
        );
        assert_eq!(advice(&text), "write `on a | b { ... }`");
    }
}

#[test]
fn updates() {
    let update = |text: &str| advice(&format!("system S {{ on a {{ {text} y' = 2; }} init true; }}"));
    assert_eq!(update("x = x + 1;"), "the next value of `x` is written `x'`");
    assert_eq!(update("x' == 1;"), "write `=`");
    assert_eq!(update("x' := 1;"), "write `=`");
    assert_eq!(update("x' = {1, 2};"), "write `in` to choose from a set");
    assert_eq!(update("x' = 0..2;"), "write `in` to choose from a range: `x' in 0..2;`");
    assert_eq!(update("x' = x' + 1;"), "only the left side of an update has a prime: `x' = x + 1;`");
    assert_eq!(update("x' = 1, y' = 2;"), "an update ends with `;`");
}

#[test]
fn types_and_maps() {
    assert_eq!(advice("system S { state b: boolean; }"), "did you mean `bool`?");
    assert_eq!(advice("system S { state b: Bool, c: bool; }"), "did you mean `bool`?");
    assert_eq!(advice("system S { state b: [0,2]; }"), "a range of integers is written `0..2`");
    assert_eq!(advice("system S = grid { \"..\", \"..\" }"), "remove the `,`");
    assert_eq!(
        advice("system S = grid { \"..\" legend W = a; }"),
        "write `legend 'W' = water;`, or `legend 'W' = #;` for an obstacle"
    );
    assert_eq!(faults("system S = grid { }"), ["syntax: expected a row of the map in quotes, found `}` @ }"]);
    assert_eq!(faults("system S { label a == true; }"), ["wrong-operator: `==` does not define a name @ =="]);
}

#[test]
fn braces() {
    let text = "system S {\n  state x: 0..1;\nobjective o { true }\nconst T = 1;";
    let (file, errors) = parse(SOURCE, text);
    assert_eq!(faults(text), ["unclosed-brace: expected an item or `}`, found `objective` @ objective"]);
    assert_eq!(&text[errors[0].related[0].0.range()], "{");
    assert_eq!(file.items.len(), 3);
    assert_eq!(faults("system S {\n on a { x' = 1;\n on b { }\n}").len(), 1);
    assert_eq!(faults("objective o { true\nconst T = 1;").len(), 1);
    assert_eq!(faults("system S { state x: 0..1;").len(), 1);
    assert_eq!(faults("}\nconst T = 1;").len(), 1);
}

#[test]
fn characters() {
    assert_eq!(faults("const T = 1 § 2;"), ["bad-character: unexpected character `§` @ §"]);
    assert_eq!(faults("const größe = 2;"), ["bad-character: unexpected characters `öß` @ öß"]);
    assert_eq!(faults("const T = 2x;"), ["bad-number: `2x` is neither a number nor a name @ 2x"]);
    assert_eq!(faults("const T = 1e5;"), ["bad-number: `1e5` is neither a number nor a name @ 1e5"]);
    assert_eq!(
        faults("/* a\n b */ const T = 1;")[0],
        "bad-comment: block comments are not part of the language @ /* a\n b */"
    );
    assert_eq!(
        faults("system S = grid(\"a);\nconst T = 1;"),
        ["unclosed-string: this string has no closing `\"` @ \"a);"]
    );
    assert_eq!(faults(r#"system S = grid("maps\foo");"#), [r"bad-escape: unknown escape `\f` @ \f"]);
}

#[test]
fn binary_data() {
    let text = "const T = 1;\0\u{1}\u{2}const {{{";
    let (file, errors) = parse(SOURCE, text);
    assert!(file.items.is_empty());
    assert_eq!(errors.len(), 1);
    assert_eq!(errors[0].message, "this is not a text file: it has the control character U+0000");
    let noise: String = (0..5000).map(|n| char::from_u32(0x2500 + n % 500).expect("a character")).collect();
    assert!(parse(SOURCE, &noise).1.len() <= 51);
}

/// Each mistake is told once, and what is sound around it is kept.
#[test]
fn several_errors_in_one_run() {
    let text = "
const A = ;
const B = 1 + 2;
system S {
  state x 0..2;
  action a, b
  on a { x' = ; x' = 1; }
  on b when x = { x' = 1; }
  label l = x ==;
  label m = x == 1;
}
objective o { exists p. m[p] & }
objective q { exists p. m[p] }
";
    let found = faults(text);
    assert_eq!(
        found,
        [
            "syntax: expected an expression, found `;` @ ;",
            "syntax: expected `:` and a type, found `0` @ 0",
            "missing-semicolon: expected `;` after `action` @ ",
            "syntax: expected an expression, found `;` @ ;",
            "wrong-operator: `=` is not an operator here @ =",
            "syntax: expected an expression, found `{` @ {",
            "syntax: expected an expression, found `;` @ ;",
            "syntax: expected an expression, found `}` @ }",
        ]
    );
    let (file, _) = parse(SOURCE, text);
    assert_eq!(file.items.len(), 3);
}
