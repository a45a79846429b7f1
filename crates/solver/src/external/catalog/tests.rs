use super::*;

fn error(text: &str) -> String {
    let mut catalog = Catalog::default();
    let before = catalog.profiles.clone();
    let error = catalog.add(Path::new("etc/hyperplan.toml"), text).expect_err(text);
    assert_eq!(catalog.profiles, before, "what is refused changes nothing");
    error.to_string()
}

fn with(text: &str) -> Catalog {
    let mut catalog = Catalog::default();
    catalog.add(Path::new("/etc/hyperplan.toml"), text).expect("it is good");
    catalog
}

fn configured(catalog: &Catalog, name: &str) -> Profile {
    match catalog.spec(name) {
        Ok(Spec::Configured(profile)) => Profile::clone(&profile),
        other => panic!("{name} is not configured: {other:?}"),
    }
}

#[test]
fn the_table_is_good() {
    let catalog = Catalog::known();
    let names: Vec<&str> = catalog.profiles().iter().map(|profile| profile.name()).collect();
    let smt = ["z3", "cvc5", "yices", "bitwuzla"];
    let qbf = ["depqbf", "caqe", "qute", "rareqs"];
    let sat = ["kissat", "cryptominisat", "minisat", "picosat", "clasp", "glucose"];
    assert_eq!(names, [&smt[..], &qbf, &sat].concat());
    // Those that get files of bits answer once, and are told which file.
    for profile in catalog.profiles().iter().filter(|profile| profile.format.is_some()) {
        let file = |arguments: &Vec<String>| arguments.iter().any(|argument| argument == FILE);
        assert!(!profile.incremental && profile.one_shot.as_ref().is_some_and(file), "{}", profile.name);
    }
    let z3 = catalog.profile("z3").expect("it is there");
    assert_eq!((z3.variable().as_str(), z3.origin.as_ref()), ("HYPERPLAN_Z3", None));
    assert_eq!(
        z3.install.to_string(),
        "install it with `apt-get install z3` (Debian), `brew install z3` (macOS) or `pip install z3-solver` (PyPI)"
    );
    let bitwuzla = catalog.profile("bitwuzla").expect("it is there");
    assert_eq!(bitwuzla.install.to_string(), "see https://bitwuzla.github.io");
}

#[test]
fn a_solver_takes_a_few_lines() {
    let catalog = with(
        "[[solver]]\nname = \"mathsat\"\nprogram = \"mathsat\"\ntheories = [\"bit-vectors\", \"integers\"]\n\
         quantifiers = \"none\"\n",
    );
    let profile = configured(&catalog, "mathsat");
    assert_eq!(profile.arguments, Vec::<String>::new());
    assert_eq!(profile.setup[1], "(set-option :produce-models true)");
    assert!(profile.incremental && profile.takes(Theory::Integers) && !profile.takes(Theory::Reals));
    assert_eq!(profile.quantifiers, Quantifiers::None);
    assert_eq!(catalog.files(), [PathBuf::from("/etc/hyperplan.toml")]);
    // The others are as they were.
    assert_eq!(catalog.spec("z3").expect("known"), Spec::Profile("z3".to_owned()));
}

#[test]
fn old_and_new_versions_side_by_side() {
    let catalog = with(
        "[[solver]]\nname = \"z3-old\"\nlike = \"z3\"\nprogram = \"bin/z3\"\n\
         [[solver]]\nname = \"z3\"\narguments = [\"-in\", \"-v:0\"]\n\
         [[solver]]\nname = \"z3-older\"\nlike = \"z3-old\"\naliases = [\"ancient\"]\nprogram = \"/opt/z3\"\n",
    );
    let old = configured(&catalog, "z3-old");
    assert_eq!((old.program.as_str(), old.arguments.as_slice()), ("/etc/bin/z3", &["-in".to_owned()][..]));
    assert_eq!(old.variable(), "HYPERPLAN_Z3_OLD");
    let new = configured(&catalog, "z3");
    assert_eq!((new.program.as_str(), new.arguments.len()), ("z3", 2));
    assert_eq!(configured(&catalog, "ancient").name, "z3-older");
}

#[test]
fn what_a_program_reads() {
    let catalog = with(
        "[[solver]]\nname = \"q\"\nprogram = \"q\"\nformat = \"qcir\"\none-shot = [\"{file}\"]\n\
         [[solver]]\nname = \"depqbf-6\"\nlike = \"depqbf\"\none-shot = [\"{file}\"]\n\
         [[solver]]\nname = \"smt\"\nlike = \"q\"\nformat = \"smt2\"\n",
    );
    let of = |name| (configured(&catalog, name).format(), configured(&catalog, name).incremental);
    assert_eq!(of("q"), (Some(Format::Qcir), false));
    assert_eq!(of("depqbf-6"), (Some(Format::Qdimacs), false));
    assert_eq!(of("smt"), (None, false));
    let wrong = error("[[solver]]\nname = \"x\"\nprogram = \"x\"\nformat = \"tptp\"\n");
    assert!(wrong.starts_with("etc/hyperplan.toml:4: ") && wrong.contains("qdimacs"), "{wrong}");
}

#[test]
fn later_files_come_first() {
    let mut catalog = with("[[solver]]\nname = \"mine\"\nprogram = \"a\"\nseed = \":seed\"\n");
    catalog
        .add(Path::new("/home/hyperplan.toml"), "[[solver]]\nname = \"mine\"\nprogram = \"b\"\n")
        .expect("good");
    let mine = configured(&catalog, "mine");
    assert_eq!((mine.program.as_str(), mine.seed.as_deref()), ("b", Some(":seed")));
}

#[test]
fn errors_have_a_place_and_advice() {
    assert_eq!(
        error("[[solver]]\nname = \"x\"\nprogramm = \"x\"\n").split(", expected").next(),
        Some("etc/hyperplan.toml:3: unknown field `programm`")
    );
    assert_eq!(
        error("\n\n[[solver]]\nname = \"x\"\n"),
        "etc/hyperplan.toml:4: solver x needs a `program`, or a `like` with the name of another solver"
    );
    assert_eq!(
        error("[[solver]]\nname = \"x\"\nlike = \"z4\"\n"),
        "etc/hyperplan.toml:3: there is no solver z4 to be like; there are z3, cvc5, yices, bitwuzla, depqbf, \
         caqe, qute, rareqs, kissat, cryptominisat, minisat, picosat, clasp, glucose"
    );
    assert_eq!(
        error("[[solver]]\nname = \"x\"\nprogram = \"x\"\n[[solver]]\nname = \"x\"\nprogram = \"y\"\n"),
        "etc/hyperplan.toml:5: solver x is described twice in this file; rename one"
    );
    assert_eq!(
        error("[[solver]]\nname = \"a b\"\nprogram = \"x\"\n"),
        "etc/hyperplan.toml:2: \"a b\" is no name for a solver: use letters, digits, `-`, `_` and `.`"
    );
    for name in ["builtin", "cadical", "batsat"] {
        let taken = error(&format!("[[solver]]\nname = \"{name}\"\nprogram = \"x\"\n"));
        assert!(taken.ends_with(&format!("{name} is an embedded solver; choose another name")), "{taken}");
    }
    assert!(error("[[solver]]\nname = \"x\"\nprogram = \" \"\n").starts_with("etc/hyperplan.toml:3: "));
    assert!(
        error("[[solver]]\nname = \"x\"\nprogram = \"x\"\narguments = [\"{file}\"]\n").contains("one-shot")
    );
    for command in ["(echo \\\"sat\\\")", "(get-info :name)", "(check-sat)"] {
        let answered = error(&format!(
            "[[solver]]\nname = \"x\"\nprogram = \"x\"\nsetup = [\"(set-logic ALL)\", \"{command}\"]\n"
        ));
        assert!(
            answered.starts_with("etc/hyperplan.toml:2: ") && answered.contains("has an answer"),
            "{answered}"
        );
    }
    let kinds = error("[[solver]]\nname = \"x\"\nprogram = \"x\"\nquantifiers = \"some\"\n");
    assert!(kinds.starts_with("etc/hyperplan.toml:4: ") && kinds.contains("exists-forall"), "{kinds}");
    assert!(error("[[solver]\n").starts_with("etc/hyperplan.toml:1: "));
    assert!(error("[solvers]\n").contains("unknown field `solvers`"));
    assert!(error("solver = 3\n").starts_with("etc/hyperplan.toml:1: "));
}

#[test]
fn lists_are_split_at_commas_outside_of_quotes() {
    assert_eq!(split_list("z3"), ["z3"]);
    assert_eq!(split_list("z3,cvc5 --x"), ["z3", "cvc5 --x"]);
    assert_eq!(split_list("a '-x=1,2',b \"c,'d\""), ["a '-x=1,2'", "b \"c,'d\""]);
    let specs = Catalog::default().specs("z3, builtin,x -i").expect("good");
    let command = Spec::Command("x -i".to_owned());
    assert_eq!(specs, [Spec::Profile("z3".to_owned()), Spec::Builtin, command]);
    assert!(Catalog::default().specs("z3,,cvc5").is_err());
}

/// The examples of the page about solvers are good, and all in one file.
#[test]
fn the_examples_are_good() {
    let page = include_str!("../../../../../docs/solvers.md");
    let blocks = page.split("```toml").skip(1).filter_map(|rest| rest.split("```").next());
    let blocks = blocks.filter_map(|block| Some(block.split_once('\n')?.1));
    let catalog = with(&blocks.collect::<String>());
    for name in ["cvc4", "z3-old", "mathsat", "opensmt", "smtinterpol", "batch"] {
        assert_eq!(configured(&catalog, name).name, name);
    }
}

#[test]
fn damaged_files_are_refused_with_a_place_inside() {
    let text = include_str!("../solvers.toml");
    let lines = text.lines().count() + 1;
    let mut refused = 0;
    for at in 0..text.len() {
        for by in [&b"\""[..], b"[", b"\n", b"=", b"\xc3\xa4"] {
            let damaged = [&text.as_bytes()[..at], by, &text.as_bytes()[at + 1..]].concat();
            let Ok(damaged) = String::from_utf8(damaged) else { continue };
            if let Err(error) = Catalog::default().add(Path::new("x"), &damaged) {
                assert!(
                    (1..=lines + 1).contains(&error.line) && !error.what.is_empty(),
                    "{error}: {damaged}"
                );
                refused += 1;
            }
        }
    }
    assert!(refused > 1000, "{refused}");
}
