//! Random scripts are written, read back, and mean the same.

mod pool;

use std::collections::BTreeMap;

use hyperplan_random::{Random, property};
use hyperplan_smt::{
    Ask, Evaluation, Model, Rational, Script, Sort, Term, Value, Verdict, WriteOptions, read_script,
    symbol_text, write_script,
};
use pool::Pool;

/// A script of random assertions over random terms of all sorts, some of them quantified.
fn script(random: &mut Random) -> Script {
    let steps = 40 + random.below(80);
    let pool = Pool::grown(random, steps);
    let mut script = Script::new();
    script.terms = pool.terms;
    let mut booleans: Vec<Term> = pool
        .samples
        .iter()
        .map(|sample| sample.open)
        .filter(|&t| script.terms.sort(t) == Sort::Bool)
        .collect();
    let terms = &mut script.terms;
    let color = terms.enumeration("a color", ["red", "or", "x@y", "1"]);
    // Names that have to be quoted or changed.
    for (i, name) in ["p.x", "$3", "?y", "and", "a b", "let", "|\\"].into_iter().enumerate() {
        let stem = terms.stem(name);
        let time = (i % 3 > 0).then_some(i as u32);
        booleans.push(terms.symbol(stem, time, Sort::Bool));
        let [r, s] = ["r", "s"].map(|suffix| {
            let stem = terms.stem(&format!("{name}{suffix}"));
            terms.symbol(stem, time, Sort::Real)
        });
        let factor = Rational::new(random.below(9) as i128 - 4, 1 + random.below(4) as i128);
        let product = terms.real_mul(factor.expect("not zero"), r);
        let sum = terms.add(&[product, s]);
        booleans.push(terms.lt(sum, r));
        let stem = terms.stem(&format!("{name}c"));
        let c = terms.symbol(stem, time, Sort::Enum(color));
        let constant = terms.constructor(color, random.below(4) as u32);
        booleans.push(terms.eq(c, constant));
    }
    let stem = terms.stem("v");
    let v = terms.bound_symbol(stem, None, Sort::Bool);
    let body = terms.iff(v, booleans[random.below(booleans.len())]);
    let body = terms.and2(body, booleans[random.below(booleans.len())]);
    booleans.push(terms.exists(&[v], body));
    for _ in 0..20 {
        let literal =
            |random: &mut Random| booleans[random.below(booleans.len())].negate_if(random.below(2) == 1);
        let literals: Vec<Term> = (0..1 + random.below(3)).map(|_| literal(random)).collect();
        script.clause(&literals);
    }
    script
}

fn value(random: &mut Random, sort: Sort) -> Value {
    match sort {
        Sort::Bool => Value::Bool(random.below(2) == 1),
        Sort::BitVec(width) => Value::bv(i128::from(random.number()), width),
        Sort::Int => Value::Int(random.below(21) as i128 - 10),
        Sort::Real => {
            let r = Rational::new(random.below(21) as i128 - 10, 1 + random.below(3) as i128);
            Value::Real(r.expect("not zero"))
        }
        Sort::Enum(enumeration) => Value::Enum(enumeration, random.below(4) as u32),
    }
}

#[test]
fn what_is_written_is_read() {
    property(400, 3000, |random| {
        let script = script(random);
        let ask = [Ask::Answer, Ask::Model, Ask::Core][random.below(3)];
        let mut text = Vec::new();
        write_script(&mut text, &script, &WriteOptions { ask, ..WriteOptions::default() })
            .expect("vectors can be written to");
        let text = String::from_utf8(text).expect("all names are text");
        let read = read_script(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        assert_eq!(read.assertions, script.len());
        assert_eq!(read.origins.len(), read.script.len());
        let lines: Vec<&str> = text.lines().collect();
        assert!(read.origins.iter().all(|origin| lines[origin.line - 1].starts_with("(assert ")), "{text}");
        let names: BTreeMap<String, Term> =
            script.symbols().into_iter().map(|symbol| (symbol_text(&script.terms, symbol), symbol)).collect();
        assert_eq!(read.symbols.len(), names.len());
        let mut decided = 0;
        for _ in 0..10 {
            let (mut model, mut same) = (Model::new(), Model::new());
            for &symbol in &read.symbols {
                let written = names[&symbol_text(&read.script.terms, symbol)];
                let value = value(random, script.terms.sort(written));
                model.insert(written, value);
                // The only enumeration is the first of either.
                same.insert(symbol, value);
            }
            let evaluation = Evaluation::new(&script.terms, &model);
            let again = Evaluation::new(&read.script.terms, &same);
            let mut kept = read.origins.iter().enumerate().peekable();
            for (index, literals) in script.assertions(0).enumerate() {
                let expected = evaluation.clause(literals);
                let found = match kept.next_if(|(_, origin)| origin.number == index + 1) {
                    Some((at, _)) => again.clause(read.script.assertion(at)),
                    None => Verdict::True,
                };
                // What was seen to be true or false when it was read may have been unknown before.
                if expected != Verdict::Unknown {
                    decided += 1;
                    assert_eq!(found, expected, "assertion {index}\n{text}");
                }
            }
        }
        assert!(decided > 0, "{text}");
    });
}

const PIECES: &[&str] = &[
    "(",
    ")",
    "(",
    ")",
    "(let ((x ",
    "(assert ",
    "(_ ",
    "((_ extract 4 0) ",
    "((_ repeat 9) ",
    "(_ bv7 3)",
    "#b101",
    "#x0",
    "7",
    "2.50",
    "x",
    "and",
    "=",
    "(= ",
    "(- ",
    "(* ",
    "(div ",
    "(/ ",
    "0",
    "true",
    "(forall ((x Int)) ",
    "(! ",
    ":named y",
    "(define-fun f ((x Int) (p Bool)) Int ",
    "(f ",
    "Bool",
    "Int",
    "(declare-const z ",
    "(bvshl ",
    "(concat ",
    "(distinct ",
    "(ite ",
    "(declare-datatypes ((E 0)) (((a) (b))))",
    "((_ is a) ",
    "(as a E)",
    "|",
    "\"",
    ";",
    "\n",
    "\u{e9}",
    "-1",
    "170141183460469231731687303715884105727",
    "((_ sign_extend 4294967295) ",
    "((_ rotate_left 7) ",
    "(abs ",
];

/// Pieces of texts put together at random: whatever comes of it, it is no panic.
#[test]
fn nothing_makes_the_reader_panic() {
    property(3000, 3000, |random| {
        let mut text = if random.below(2) == 0 {
            "(declare-const x Int)(declare-const p Bool)(declare-const v (_ BitVec 3))(assert ".to_owned()
        } else {
            let script = script(random);
            let mut text = Vec::new();
            write_script(&mut text, &script, &WriteOptions::default()).expect("vectors can be written to");
            String::from_utf8(text).expect("all names are text")
        };
        for _ in 0..1 + random.below(6) {
            let mut at = random.below(text.len() + 1);
            while !text.is_char_boundary(at) {
                at -= 1;
            }
            let mut end = (at + random.below(4)).min(text.len());
            while !text.is_char_boundary(end) {
                end += 1;
            }
            let pieces: Vec<&str> =
                (0..random.below(12)).map(|_| PIECES[random.below(PIECES.len())]).collect();
            if random.below(2) == 0 {
                text.push_str(&pieces.join(" "));
            } else {
                text.replace_range(at..end, &pieces.concat());
            }
        }
        let read = std::panic::catch_unwind(|| read_script(&text).map(|read| read.assertions));
        assert!(read.is_ok(), "{text}");
    });
}
