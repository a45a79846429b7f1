//! The files of `specs/import`: what they become, and what is said of bad ones. `UPDATE=1` writes it anew.

use hyperplan_import::{Dialect, Imported, Input, Known, Options, import};
use hyperplan_problem::{NoFiles, Overrides, lower, read};
use hyperplan_syntax::{Diagnostic, SourceMap, print, render};
use std::fs;
use std::path::{Path, PathBuf};

fn models(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../specs/import").join(folder);
    let mut found: Vec<PathBuf> =
        fs::read_dir(folder).expect("it is there").map(|e| e.expect("a file").path()).collect();
    found.retain(|path| {
        path.extension().is_some_and(|ending| ["smv", "aag", "txt", "pddl"].iter().any(|e| ending == *e))
    });
    found.sort();
    assert!(!found.is_empty());
    found
}

/// A model, with the formula of the same name, if there is one.
fn imported(model: &Path, sources: &mut SourceMap) -> Imported {
    let mut inputs = Vec::new();
    for path in [model.to_owned(), model.with_extension("hq")] {
        let Ok(text) = fs::read_to_string(&path) else { continue };
        let name = path.file_name().expect("it has a name").to_string_lossy().into_owned();
        inputs.push(Input { name, text });
    }
    import(&inputs, &Options { bound: Some(6), ..Options::default() }, sources)
}

fn same(expected: &Path, found: &str) {
    if std::env::var_os("UPDATE").is_some() {
        fs::write(expected, found).expect("it can be written");
    }
    let known = fs::read_to_string(expected).unwrap_or_default().replace("\r\n", "\n");
    assert_eq!(known, found, "{}: UPDATE=1 writes it anew", expected.display());
}

#[test]
fn good_files_become_readable_problems() {
    for model in models("pass") {
        let mut sources = SourceMap::new();
        let imported = imported(&model, &mut sources);
        let errors: Vec<&Diagnostic> = imported.diagnostics.iter().filter(|d| d.is_error()).collect();
        assert!(errors.is_empty(), "{}: {errors:#?}", model.display());
        let lowered = lower(&imported.file, &mut sources, &NoFiles, &Overrides::default());
        assert!(!lowered.has_errors(), "{}: {:#?}", model.display(), lowered.diagnostics);
        let text = format!("{}\n{}", imported.about, print(&imported.file, ""));
        same(&model.with_extension("hp"), &text);
        let again = read(&mut SourceMap::new(), "again.hp", &text, &NoFiles, &Overrides::default());
        assert!(!again.has_errors(), "{}: {:#?}", model.display(), again.diagnostics);
    }
}

#[test]
fn bad_files_are_told_of_where_they_are_bad() {
    for model in models("fail") {
        let mut sources = SourceMap::new();
        let imported = imported(&model, &mut sources);
        assert!(imported.diagnostics.iter().any(Diagnostic::is_error), "{}", model.display());
        let told = render(&sources, &imported.diagnostics, false, 100);
        same(&model.with_extension("stderr"), &told);
    }
}

/// One diagnostic, as code and marked text.
fn only_error(model: &str, formula: &str, options: &Options) -> (&'static str, String) {
    let mut sources = SourceMap::new();
    let input = |name: &str, text: &str| Input { name: name.to_owned(), text: text.to_owned() };
    let imported = import(&[input("m.smv", model), input("f.hq", formula)], options, &mut sources);
    let [error] = &imported.diagnostics[..] else { panic!("{:#?}", imported.diagnostics) };
    (error.code, error.span.map_or(String::new(), |span| sources.snippet(span).to_owned()))
}

#[test]
fn what_has_no_end_needs_a_bound() {
    let model = "MODULE main VAR x : boolean;";
    let without = Options::default();
    let said = only_error(model, "exists A. X F x[A]", &without);
    assert_eq!(said, ("unbounded-operator", "F x[A]".to_owned()));
    let mut sources = SourceMap::new();
    let input = |name: &str, text: &str| Input { name: name.to_owned(), text: text.to_owned() };
    let files = [input("m.smv", model), input("f.hq", "exists A. X F[0,3] x[A]")];
    assert!(import(&files, &without, &mut sources).diagnostics.is_empty());
}

/// Where the last condition of a `case` makes no difference, it is read all the same: its names are there, its types fit.
#[test]
fn conditions_without_effect_are_checked() {
    let model = |body: &str| format!("MODULE main VAR x : 0..3; y : boolean; ASSIGN next(x) := {body};");
    for (condition, code) in [("z", "unknown-name"), ("x", "type-mismatch"), ("z = 1", "unknown-name")] {
        for values in [["x", "0"], ["{0, 1}", "x"], ["{0, 1}", "{2, 3}"]] {
            let [first, last] = values;
            for text in [
                format!("case y : {first}; {condition} : {last}; esac"),
                format!("case {condition} : {last}; esac"),
                format!("case y : {first}; TRUE : case !y : 0; {condition} : {last}; esac; esac"),
            ] {
                let (said, place) = only_error(&model(&text), "exists A. x[A] = 0", &Options::default());
                assert_eq!((said, &place[..1]), (code, &condition[..1]), "{text}");
            }
        }
    }
}

#[test]
fn deep_and_long_input_is_refused_or_read() {
    let model = |body: &str| format!("MODULE main VAR x : 0..9; y : boolean; DEFINE d := {body};");
    let formula = "exists A. x[A] = 0";
    let nested = |open: &str, close: &str, inside: &str| {
        model(&format!("{}{inside}{}", open.repeat(100_000), close.repeat(100_000)))
    };
    for text in [
        nested("(", ")", "y"),
        nested("!", "", "y"),
        nested("- ", "", "x"),
        nested("case y : ", "; TRUE : 0; esac", "0"),
        nested("next(", ")", "y"),
        model(&format!("x{}", " * x".repeat(100_000))),
        model(&format!("y{}", " -> y".repeat(100_000))),
        model(&"(y & ".repeat(100_000)),
    ] {
        assert_eq!(only_error(&text, formula, &Options::default()).0, "too-deep", "{}", &text[..60]);
    }
    // Chains are flat, be they lists of one `case`, or each in the last case of the one before.
    for text in [
        model(&format!("y{}", " & y".repeat(100_000))),
        model(&format!("x{}", " + 1 - x + x".repeat(10_000))),
        model(&format!("case {}TRUE : 0; esac", "x = 1 & y : 1; ".repeat(20_000))),
        model(
            &format!("{}0;{}", "case x = 1 : 1; TRUE : ".repeat(5_000), " esac;".repeat(5_000))
                .replace("; esac;;", "; esac;"),
        ),
        model(&format!("{}0", "y ? 1 : ".repeat(20_000))),
    ] {
        let text = text.replace("esac;;", "esac;");
        let mut sources = SourceMap::new();
        let imported = import(
            &[Input { name: "m.smv".to_owned(), text: text.clone() }],
            &Options::default(),
            &mut sources,
        );
        assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
        let lowered = lower(&imported.file, &mut sources, &NoFiles, &Overrides::default());
        assert!(!lowered.has_errors(), "{:#?}", lowered.diagnostics);
    }
}

/// Definitions that read others twice are labels, and parameters are read where they were given: nothing doubles.
#[test]
fn definitions_are_shared() {
    let mut text = "MODULE main VAR x : 0..1; DEFINE d0 := x;".to_owned();
    for n in 1..5_000 {
        text += &format!(" d{n} := case d{0} = 0 : d{0}; TRUE : 1; esac;", n - 1);
    }
    let mut sources = SourceMap::new();
    let imported = import(&[Input { name: "m.smv".to_owned(), text }], &Options::default(), &mut sources);
    assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
    let lowered = lower(&imported.file, &mut sources, &NoFiles, &Overrides::default());
    assert!(!lowered.has_errors(), "{:#?}", lowered.diagnostics);
    // The same where each instance gives the next one its parameter twice.
    let mut text = String::new();
    for n in 0..60 {
        text += &format!("MODULE m{n}(p) VAR i : m{}(p & p);\n", n + 1);
    }
    text += "MODULE m60(p) DEFINE all := p; MODULE main VAR y : boolean; i : m0(y);";
    let mut sources = SourceMap::new();
    let imported = import(&[Input { name: "m.smv".to_owned(), text }], &Options::default(), &mut sources);
    assert!(imported.diagnostics.is_empty(), "{:#?}", imported.diagnostics);
    // Sets have no labels: where they would double too often, they are refused.
    let mut text = "MODULE main VAR x : 0..9; DEFINE s0 := {0, 1};".to_owned();
    for n in 1..60 {
        text += &format!(" s{n} := s{0} union s{0};", n - 1);
    }
    text += " ASSIGN next(x) := s59;";
    assert_eq!(only_error(&text, "exists A. x[A] = 0", &Options::default()).0, "too-large");
}

/// A formula as it is read, and the codes of what is said of it.
fn read_formula(formula: &str, options: Options) -> (String, Vec<&'static str>) {
    let model = "MODULE main VAR a : boolean; b : boolean; c : boolean; DEFINE d := TRUE;";
    let input = |name: &str, text: &str| Input { name: name.to_owned(), text: text.to_owned() };
    let inputs = [input("m.smv", model), input("f.hq", formula)];
    let imported = import(&inputs, &Options { bound: Some(6), ..options }, &mut SourceMap::new());
    let text = format!("{}{}", imported.about, print(&imported.file, ""));
    let start = text.find("objective").unwrap_or(text.len());
    let last = text[start..].lines().rfind(|line| !line.trim().is_empty() && line.trim() != "}");
    let codes = imported.diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
    (last.unwrap_or_default().trim().trim_end_matches(';').to_owned(), codes)
}

#[test]
fn languages_bind_operators_in_their_own_way() {
    use Dialect::{AutoHyper, HyperLasso, HyperQb1, HyperQb2};
    for (text, dialect, same_as, told) in [
        // As NuSMV, where nothing tells the languages apart.
        ("exists A. a[A] -> b[A] <-> c[A]", None, "a[A] -> (b[A] <-> c[A])", false),
        ("exists A. a[A] -> b[A] <-> c[A]", Some(HyperLasso), "a[A] -> (b[A] <-> c[A])", false),
        ("exists A. a[A] -> b[A] <-> c[A]", Some(AutoHyper), "(a[A] -> b[A]) <-> c[A]", true),
        ("exists A. {a}_A -> {b}_A <-> {c}_A", None, "(a[A] -> b[A]) <-> c[A]", true),
        ("exists A. {a}_A -> {b}_A -> {c}_A", None, "(a[A] -> b[A]) -> c[A]", true),
        ("exists A. {a}_A U {b}_A U {c}_A", None, "(a[A] U b[A]) U c[A]", true),
        ("exists A. ({a}_A -> {b}_A) & !{c}_A | {a}_A", None, "((a[A] -> b[A]) & !c[A]) | a[A]", false),
        ("exists A. a[A] /\\ b[A] \\/ c[A]", None, "a[A] & (b[A] | c[A])", true),
        ("exists A. a[A] \\/ b[A] -> c[A]", None, "a[A] | (b[A] -> c[A])", true),
        ("exists A. a[A] /\\ b[A] \\/ c[A]", Some(HyperLasso), "(a[A] & b[A]) | c[A]", false),
        ("exists A. G(*a[A]=1* <-> *b[A]=1*) /\\ F(c[A])", None, "G(a[A] <-> b[A]) & F(c[A])", false),
        ("exists A. c[A] & a[A] | toint(a[A]) * 2 > 1", None, "(c[A] & a[A]) | (toint(a[A]) * 2 > 1)", false),
        ("Exists A . a[A] = b[A] & c[A]", None, "a[A] <-> (b[A] & c[A])", true),
        ("exists A . a[A] = b[A] & c[A]", None, "(a[A] <-> b[A]) & c[A]", false),
        ("exists A . a[A] = b[A] & c[A]", Some(HyperQb2), "a[A] <-> (b[A] & c[A])", true),
        ("Exists A . ~a[A] = b[A]", None, "(!a[A]) <-> b[A]", true),
        ("Exists A . a[A] U b[A] R c[A]", None, "a[A] U (b[A] R c[A])", false),
        ("Exists A . a[A] R b[A] U c[A]", None, "(a[A] R b[A]) U c[A]", true),
        ("Exists A . (a[A] = b[A]) & ~(c[A])", None, "(a[A] <-> b[A]) & !c[A]", false),
        ("exists A. a[A] /\\ (b[A] \\/ c[A])", Some(HyperQb1), "a[A] & (b[A] | c[A])", false),
    ] {
        let (read, codes) = read_formula(text, Options { dialect, ..Options::default() });
        let (expected, _) = read_formula(&format!("exists A. {same_as}"), Options::default());
        assert_eq!(read, expected, "{text}");
        assert_eq!(codes == ["other-precedence"], told, "{text}: {codes:?}");
    }
    assert_eq!(read_formula("Exists A . a[A] = b[A] |", Options::default()).1, ["syntax"]);
}

#[test]
fn comments_of_formulas_say_what_is_known() {
    let about = |formula: &str, status, semantics: Option<&str>| {
        let options =
            Options { bound: Some(6), status, semantics: semantics.map(str::to_owned), ..Options::default() };
        let model = "MODULE main VAR a : boolean;";
        let input = |name: &str, text: &str| Input { name: name.to_owned(), text: text.to_owned() };
        let inputs = [input("m.smv", model), input("f.hq", formula)];
        let imported = import(&inputs, &options, &mut SourceMap::new());
        let codes: Vec<&str> = imported.diagnostics.iter().map(|diagnostic| diagnostic.code).collect();
        let known =
            imported.about.lines().find_map(|line| line.strip_prefix("// f: ").filter(|w| *w != "f.hq"));
        (known.map(str::to_owned), codes)
    };
    let formula = "-- within 6: holds\n// within 9: violated\n-- within 6 semantics pes: unrealizable\nexists A. F a[A]";
    assert_eq!(about(formula, None, None), (Some("realizable".to_owned()), vec![]));
    assert_eq!(about(formula, None, Some("pes")), (Some("unrealizable".to_owned()), vec![]));
    assert_eq!(about(formula, None, Some("opt")), (None, vec![]));
    assert_eq!(about(formula, Some(Known::Realizable), None), (Some("realizable".to_owned()), vec![]));
    assert_eq!(about(formula, Some(Known::Unrealizable), None).1, ["contradictory-status"]);
    assert_eq!(about("exists A. F a[A]", Some(Known::Unrealizable), None).0, Some("unrealizable".to_owned()));
}

/// They say what holds beyond the bound, so without one they are refused, whatever the model and the formula.
#[test]
fn semantics_are_for_a_bound() {
    let models = [("m.smv", "MODULE main VAR a : boolean;"), ("m.aag", "aag 1 1 0 1 0\n2\n2\ni0 a\n")];
    let formulas = [
        "exists A. a[A]",
        "exists A. F[0,3] a[A]",
        "forall A. exists B. X (a[A] <-> a[B])",
        "exists A. F a[A]",
    ];
    for ((model, text), formula) in
        models.into_iter().flat_map(|model| formulas.map(|formula| (model, formula)))
    {
        for (semantics, bound) in
            ["pes", "opt", "hpes", "hopt"].into_iter().flat_map(|s| [(s, None), (s, Some(4))])
        {
            let input = |name: &str, text: &str| Input { name: name.to_owned(), text: text.to_owned() };
            let inputs = [input(model, text), input("f.hq", formula)];
            let options = Options { bound, semantics: Some(semantics.to_owned()), ..Options::default() };
            let mut sources = SourceMap::new();
            let imported = import(&inputs, &options, &mut sources);
            let codes: Vec<&str> =
                imported.diagnostics.iter().filter(|d| d.is_error()).map(|d| d.code).collect();
            let expected = if bound.is_none() { vec!["semantics-without-bound"] } else { Vec::new() };
            assert_eq!(codes, expected, "{model} {formula} {semantics} {bound:?}");
            let said = print(&imported.file, "").contains(&format!("within 4 semantics {semantics}"));
            assert_eq!(said, bound.is_some(), "{model} {formula}");
        }
    }
}

/// Whatever is done to a good file, it is read or refused.
#[test]
fn damaged_files_do_no_harm() {
    let files: Vec<(String, String)> = models("pass")
        .into_iter()
        .chain(models("fail"))
        .flat_map(|model| [model.clone(), model.with_extension("hq")])
        .filter_map(|path| {
            let name = path.file_name()?.to_string_lossy().into_owned();
            Some((name, fs::read_to_string(path).ok()?))
        })
        .collect();
    hyperplan_random::property(1500, 60, |random| {
        let inputs: Vec<Input> = (0..1 + random.below(3))
            .map(|_| {
                let (name, text) = &files[random.below(files.len())];
                Input { name: name.clone(), text: damaged(text, random) }
            })
            .collect();
        let options = Options { bound: (!random.once_in(4)).then_some(3), ..Options::default() };
        let mut sources = SourceMap::new();
        let imported = import(&inputs, &options, &mut sources);
        let told = render(&sources, &imported.diagnostics, false, 100);
        let refused = imported.diagnostics.iter().any(Diagnostic::is_error);
        assert!(!refused || told.contains("error"), "{told}");
        if !refused {
            let _ = lower(&imported.file, &mut sources, &NoFiles, &Overrides::default());
        }
        let circuit =
            files.iter().find(|(name, _)| name == "circuit.aag").map(|(_, text)| damaged(text, random));
        let _ = hyperplan_import::ascii(circuit.unwrap_or_default().replacen("aag", "aig", 1).as_bytes());
    });
}

/// A text in which some words are gone, doubled, or others.
fn damaged(text: &str, random: &mut hyperplan_random::Random) -> String {
    let mut words: Vec<&str> = text.split_inclusive(|c: char| !c.is_alphanumeric()).collect();
    for _ in 0..random.below(4) {
        let at = random.below(words.len());
        match random.below(4) {
            0 => drop(words.remove(at)),
            1 => words.insert(at, words[random.below(words.len())]),
            2 => {
                words[at] =
                    ["(", ")", "99999999999", "-1", "é", "_", "\"", "{", "esac", "["][random.below(10)]
            }
            _ => words.truncate(at + 1),
        }
        if words.is_empty() {
            break;
        }
    }
    words.concat()
}
