//! Diagnostics as text and as data.

use hyperplan_syntax::{Diagnostic, SourceMap, Span, parse, render, to_json};

fn sources(text: &str) -> SourceMap {
    let mut sources = SourceMap::new();
    sources.add("rooms.hp", text);
    sources
}

fn rendered(text: &str) -> String {
    let sources = sources(text);
    let id = hyperplan_syntax::SourceId(0);
    render(&sources, &parse(id, text).1, false, 80)
}

#[test]
fn plain_text() {
    let text = "const T = 6;\n\tconst S = T && (1;\nconst U1 = 2;\n";
    let expected = "\
error[wrong-operator]

  x `&&` is not an operator here
   ,-[rooms.hp:2:14]
 1 | const T = 6;
 2 |     const S = T && (1;
   :                 ^^
 3 | const U1 = 2;
   `----
  help: write `&`

error[syntax]

  x expected an operator or `)`, found `;`
   ,-[rooms.hp:2:19]
 1 | const T = 6;
 2 |     const S = T && (1;
   :                    | |
   :                    | `-- not expected here
   :                    `-- opened here
 3 | const U1 = 2;
   `----
";
    assert_eq!(rendered(text), expected);
}

#[test]
fn color_only_on_request() {
    let text = "const T = ;";
    assert!(!rendered(text).contains('\u{1b}'));
    let sources = sources(text);
    let (_, errors) = parse(hyperplan_syntax::SourceId(0), text);
    assert!(render(&sources, &errors, true, 80).contains('\u{1b}'));
}

#[test]
fn columns_count_characters() {
    let shown = rendered("const T = (∃∃ §);\r\nconst S = 1;\r\n");
    assert!(shown.contains("rooms.hp:1:12]"), "{shown}");
}

#[test]
fn nothing_disturbs_the_terminal() {
    let shown = rendered("const T = \u{1b}[31m \u{202e} 1;");
    assert!(!shown.contains('\u{1b}') && !shown.contains('\u{202e}'), "{shown}");
    let shown = rendered("const T = \u{202e} 1;");
    assert!(!shown.contains('\u{202e}'), "{shown}");
}

#[test]
fn long_lines_are_cut() {
    let text = format!("const T = {}? {};", "a + ".repeat(10_000), "1".repeat(10_000));
    let shown = rendered(&text);
    assert!(shown.len() < 1000, "{shown}");
    assert!(shown.contains("rooms.hp:1:40011]") && shown.contains("a + ? 111"), "{shown}");
}

#[test]
fn places_far_apart_and_in_other_sources() {
    let text = format!("first\n{}last\n", "line\n".repeat(50));
    let mut sources = sources(&text);
    let prelude = sources.add("<prelude>", "template t() { true }\n");
    let id = hyperplan_syntax::SourceId(0);
    let error = Diagnostic::warning("twice", Span::new(id, 256..260), "said twice")
        .with_related(Span::new(id, 0..5), "first here")
        .with_related(Span::new(prelude, 9..10), "in this template")
        .with_help("say it once");
    let shown = render(&sources, &[error], false, 80);
    for part in [
        "warning[twice]",
        "said twice",
        "52 | last",
        "1 | first",
        "first here",
        "<prelude>:1:10]",
        "in this template",
    ] {
        assert!(shown.contains(part), "{part}\n{shown}");
    }
    assert!(shown.lines().count() < 40, "{shown}");
}

#[test]
fn strange_spans() {
    let sources = sources("ab\ncé");
    let id = hyperplan_syntax::SourceId(0);
    for (start, end) in [(0, 0), (6, 6), (100, 200), (5, 6), (4, 2), (2, 3), (2, 2), (0, 6)] {
        let span = Span { source: id, start, end };
        let error = Diagnostic::error("x", span, "message").with_label("here").with_related(span, "there");
        assert!(render(&sources, std::slice::from_ref(&error), false, 80).contains("message"));
        assert_eq!(to_json(&sources, "rooms.hp", &error).message, "message");
    }
    let shown = render(&sources, &[Diagnostic::error_nowhere("x", "nothing to mark")], false, 80);
    assert_eq!(shown, "error[x]\n\n  x nothing to mark\n");
    assert_eq!(render(&sources, &[], false, 80), "");
}

#[test]
fn json() {
    let text = "const T = 6;\nconst S = é;\n";
    let sources = sources(text);
    let (_, errors) = parse(hyperplan_syntax::SourceId(0), text);
    let value = serde_json::to_value(to_json(&sources, "rooms.hp", &errors[0])).expect("plain data");
    let expected = serde_json::json!({
        "severity": "error", "code": "bad-character", "message": "unexpected character `é`",
        "file": "rooms.hp",
        "span": {"line": 2, "column": 11, "endLine": 2, "endColumn": 12, "start": 23, "end": 25},
        "label": null, "help": "names consist of the letters a-z and A-Z, digits, and `_`", "related": [],
    });
    assert_eq!(value, expected);
    let nowhere = to_json(&sources, "rooms.hp", &Diagnostic::error_nowhere("x", "m"));
    let value = serde_json::to_value(nowhere).expect("plain data");
    assert_eq!((&value["file"], &value["span"]), (&"rooms.hp".into(), &serde_json::Value::Null));
}
