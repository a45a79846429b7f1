//! What is read, and what is refused.

use super::*;
use crate::eval::{Evaluation, Verdict};
use crate::term::Sort;
use crate::value::{Model, Value};
use crate::write::{WriteOptions, write_script};

fn refused(text: &str) -> String {
    match read_script(text) {
        Ok(_) => format!("{text} was read"),
        Err(error) => error.to_string(),
    }
}

/// Whether the assertions hold, one by one, with these values of the declared symbols.
fn truths(benchmark: &Benchmark, values: &[Value]) -> Vec<Option<bool>> {
    assert_eq!(benchmark.symbols.len(), values.len());
    let model: Model = benchmark.symbols.iter().copied().zip(values.iter().copied()).collect();
    let evaluation = Evaluation::new(&benchmark.script.terms, &model);
    let mut truths = vec![Some(true); benchmark.assertions];
    for (origin, literals) in benchmark.origins.iter().zip(benchmark.script.assertions(0)) {
        truths[origin.number - 1] = match evaluation.clause(literals) {
            crate::Verdict::True => Some(true),
            crate::Verdict::False => Some(false),
            crate::Verdict::Unknown => None,
        };
    }
    truths
}

fn read(text: &str) -> Benchmark {
    read_script(text).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_file_of_somebody_else() {
    let text = "(set-info :status |sat)|)(set-option :produce-models true) ; (assert false)\n(set-logic ALL)\n\
                (declare-const |x y| Int)(declare-fun r () Real)(define-sort Byte () (_ BitVec 8))\n\
                (declare-const b Byte)\n(declare-datatype Color ((red) (green)))(declare-const c Color)\n\
                (define-fun twice ((n Int) (p Bool)) Int (let ((m (+ n n))) (ite p m (- m))))\n\
                (define-const big Real 2)\n\
                (assert (! (< (twice (twice |x y| true) false) 0 4) :named first :weight 3 :pattern ((f x))))\n\
                (assert (and first (= r (/ 1 3) (/ |x y| 3.0)) (=> false first true)))\n\
                (assert (= (bvand b #x0F) (_ bv5 8)))\n(assert ((_ is green) c))\n\
                (assert (exists ((q Int)) (= q |x y|)))\n(assert (distinct c red (as red Color)))\n\
                (assert (> big (* r 5) 1.5))\n\
                (check-sat)(get-value (|x y| b))(get-info :reason-unknown)(exit)(nothing";
    let benchmark = read(text);
    let lines: Vec<usize> = benchmark.origins.iter().map(|origin| origin.line).collect();
    // The one that is false whatever the model is stays.
    assert_eq!(lines, [8, 9, 10, 11, 12, 13, 14]);
    let Sort::Enum(color) = benchmark.script.terms.sort(benchmark.symbols[3]) else { panic!("a datatype") };
    let third = Value::Real(crate::Rational::new(1, 3).expect("not zero"));
    let values = [Value::Int(1), third, Value::bv(0x35, 8), Value::Enum(color, 1)];
    let holds = truths(&benchmark, &values);
    assert_eq!(
        holds,
        [true, true, true, true]
            .map(Some)
            .into_iter()
            .chain([None, Some(false), Some(true)])
            .collect::<Vec<_>>()
    );
}

#[test]
fn bindings_end_where_they_should() {
    let text = "(declare-const a Bool)(declare-const b Bool)\n\
                (assert (let ((a b) (b a)) (and a (not b) (let ((a a)) a))))(assert (not a))\
                (assert (let ((x a)) (let ((x (not x)) (y x)) (and x (not y)))))\
                (define-fun f ((a Bool)) Bool (not a))(assert (f a))(assert (not (f b)))\
                (assert (let () b))";
    assert_eq!(truths(&read(text), &[Value::Bool(false), Value::Bool(true)]), [Some(true); 6]);
}

type Unary = (&'static str, fn(u32) -> u32);
type Binary = (&'static str, fn(u32, u32) -> u32);

/// Functions of bit-vectors against what they are by definition, on all values of three bits.
#[test]
fn bit_vectors_bit_by_bit() {
    let unary: [Unary; 14] = [
        ("(bvnot x)", |x| !x),
        ("(bvneg x)", |x| x.wrapping_neg()),
        ("((_ rotate_left 1) x)", |x| x << 1 | x >> 2),
        ("((_ rotate_left 4) x)", |x| x << 1 | x >> 2),
        ("((_ rotate_right 1) x)", |x| x >> 1 | x << 2),
        ("((_ rotate_right 3) x)", |x| x),
        ("(bvshl x #b010)", |x| x << 2),
        ("(bvshl x #b011)", |_| 0),
        ("(bvlshr x #b001)", |x| x >> 1),
        ("(bvlshr x #b111)", |_| 0),
        ("(bvashr x #b001)", |x| x >> 1 | x & 4),
        ("(bvashr x #b110)", |x| if x & 4 == 0 { 0 } else { 7 }),
        ("((_ extract 2 0) ((_ sign_extend 2) x))", |x| x),
        ("((_ extract 4 2) ((_ repeat 2) x))", |x| x << 1 | x >> 2),
    ];
    let binary: [Binary; 11] = [
        ("(bvand x y)", |x, y| x & y),
        ("(bvor x y)", |x, y| x | y),
        ("(bvxor x y x)", |_, y| y),
        ("(bvnand x y)", |x, y| !(x & y)),
        ("(bvnor x y)", |x, y| !(x | y)),
        ("(bvxnor x y)", |x, y| !(x ^ y)),
        ("(bvadd x y y)", |x, y| x + y + y),
        ("(bvsub x y)", |x, y| x.wrapping_sub(y)),
        ("(bvmul x y)", |x, y| x * y),
        ("((_ zero_extend 2) (bvcomp x y))", |x, y| u32::from(x == y)),
        ("((_ extract 3 1) (concat x y))", |x, y| (x << 3 | y) >> 1),
    ];
    let signed = |x: u32| if x > 3 { x as i32 - 8 } else { x as i32 };
    for x in 0..8_u32 {
        for y in 0..8_u32 {
            let holds = |assertion: &str| {
                let text = format!(
                    "(declare-const x (_ BitVec 3))(declare-const y (_ BitVec 3))(declare-const z (_ BitVec 3))(assert {assertion})"
                );
                move |z: u32| truths(&read(&text), &[x, y, z].map(|v| Value::bv(i128::from(v), 3)))[0]
            };
            let unary = unary.iter().map(|(term, f)| (*term, f(x)));
            for (term, expected) in unary.chain(binary.iter().map(|(term, f)| (*term, f(x, y)))) {
                assert_eq!(holds(&format!("(= z {term})"))(expected & 7), Some(true), "{term} {x} {y}");
            }
            let orders = [
                ("bvule", x <= y),
                ("bvult", x < y),
                ("bvuge", x >= y),
                ("bvugt", x > y),
                ("bvsle", signed(x) <= signed(y)),
                ("bvslt", signed(x) < signed(y)),
                ("bvsge", signed(x) >= signed(y)),
                ("bvsgt", signed(x) > signed(y)),
            ];
            for (order, expected) in orders {
                assert_eq!(holds(&format!("({order} x y)"))(0), Some(expected), "{order} {x} {y}");
            }
        }
    }
}

#[test]
fn numbers() {
    for x in -7..8_i128 {
        let text = format!(
            "(declare-const x Int)(declare-const r Real)(assert (= (div x 3) {}))(assert (= (mod x 3) {}))\
             (assert (= (div x (- 3)) {}))(assert (= (mod x (- 3)) {}))(assert (= (abs x) {}))\
             (assert (= ((_ divisible 2) x) {}))(assert (= (- x 1 x) (- 1)))(assert (= (/ x 2) (* r 3.5) (abs r)))",
            number(x.div_euclid(3)),
            x.rem_euclid(3),
            number(-(x.div_euclid(3))),
            x.rem_euclid(-3),
            x.abs(),
            x % 2 == 0,
        );
        let r = crate::Rational::new(x, 7).expect("not zero");
        let holds = truths(&read(&text), &[Value::Int(x), Value::Real(r)]);
        assert_eq!(holds[..7], [Some(true); 7], "{x}");
        assert_eq!(holds[7], Some(x == 0), "{x}");
    }
}

fn number(i: i128) -> String {
    if i < 0 { format!("(- {})", -i) } else { i.to_string() }
}

#[test]
fn what_is_not_supported_is_said() {
    let declared = "(declare-const i Int)(declare-const b (_ BitVec 4))\n(assert ";
    for (term, what) in [
        ("(bvudiv b b)", "2:10: bvudiv"),
        ("(= 0 (* i i))", "2:15: a product of variables"),
        ("(= 0 (div i i))", "2:15: division by a variable, by 0, or by a large number"),
        ("(= b (bvshl b b))", "2:15: a shift by a variable"),
        ("((_ to_bv 3) i)", "2:10: to_bv"),
        ("(f i)", "2:10: f"),
        ("x", "2:9: x, which is not declared,"),
        ("(match b ((x x)))", "2:10: match"),
        (
            "(= i 999999999999999999999999999999999999999)",
            "2:14: the constant 999999999999999999999999999999999999999",
        ),
        ("(= \"a\" \"b\")", "2:12: a string"),
        ("(= (concat b #x00000000000000000000000000000000) b)", "2:13: a bit-vector of more than 128 bits"),
    ] {
        assert_eq!(refused(&format!("{declared}{term})")), format!("{what} is not supported"), "{term}");
    }
    for (text, what) in [
        ("(push 1)", "1:1: push"),
        ("(check-sat)\n (assert true)", "2:2: assert after check-sat"),
        ("(check-sat)(get-assertions)", "1:12: get-assertions"),
        ("(declare-const a (Array Int Int))", "1:18: sort Array"),
        ("(declare-const a (_ BitVec 129))", "1:18: a bit-vector of 129 bits"),
        (
            "(declare-datatypes ((L 0)) (((nil) (cons (head Int) (tail L)))))",
            "1:22: a datatype with selectors",
        ),
        ("(declare-datatypes ((P 1)) ((par (X) ((p (v X))))))", "1:22: a datatype with parameters"),
        ("(check-sat-assuming (p))", "1:1: check-sat-assuming"),
        ("(define-fun-rec f () Int 1)", "1:1: define-fun-rec"),
    ] {
        assert_eq!(refused(text), format!("{what} is not supported"), "{text}");
    }
}

#[test]
fn what_makes_no_sense_is_an_error() {
    for (text, what) in [
        ("x", "1:1: a command begins with ("),
        ("(assert", "1:8: the text ends inside of a command"),
        ("(assert)", "1:8: a term is missing"),
        ("(assert true true)", "1:14: ) is missing"),
        ("(assert (and))", "1:10: arguments are missing"),
        ("(assert (not true\n false))", "1:10: 1 arguments are needed here, not 2"),
        ("(assert 1)", "1:1: Bool is needed here, not Int"),
        ("(declare-const é Int)(declare-const é Int)", "1:37: é is declared twice"),
        ("(assert (= 1 true))", "1:10: Int is needed here, not Bool"),
        ("(assert (let ((x 1) true) x))", "1:21: no term may come here"),
        ("(assert (let ((x)) x))", "1:17: a term is missing"),
        ("(assert (let ((x 1 2)) x))", "1:20: no term may come here"),
        ("(assert (let ((x 1)) true true))", "1:27: no term may come here"),
        ("(assert (let ((x 1))))", "1:21: a term is missing"),
        ("(assert (forall ((x Int)) 1))", "1:10: Bool is needed here, not Int"),
        ("(assert (! :named a))", "1:12: a term is missing"),
        ("(assert (= #b (bv)))", "1:12: #b is no symbol and no constant"),
        ("(assert (= ((_ extract 4 0) #b1010) #b1))", "1:13: there are no such bits in 4"),
        ("(assert (= (_ bv9 3) #b101))", "1:12: 9 has more than 3 bits"),
        ("(define-fun f ((x Int)) Int x)(assert (= f 1))", "1:42: f takes arguments"),
        ("(define-fun f ((x Int)) Int x)(assert (= (f) 1))", "1:43: 1 arguments are needed here, not 0"),
        ("(declare-const p Bool)(assert (p true))", "1:32: p takes no arguments"),
        ("(declare-fun f (Int Real) Int)(assert (= (f 1) 1))", "1:43: 2 arguments are needed here, not 1"),
        ("(declare-fun f (Int) Int)(assert (= (f true) 1))", "1:38: Int is needed here, not Bool"),
        ("(declare-fun f (Int) Int)(assert (= f 1))", "1:37: f takes arguments"),
        ("(declare-fun f (Int", "1:20: the text ends inside of a command"),
    ] {
        assert_eq!(refused(text), what, "{text}");
    }
}

#[test]
fn no_depth_is_too_deep() {
    const DEEP: usize = 200_000;
    let header = "(declare-const a Bool)(declare-const b Bool)(assert ";
    let lets: String = (0..DEEP)
        .map(|i| {
            format!("(let ((x{i} (= a {}))) ", if i == 0 { "b".to_owned() } else { format!("x{}", i - 1) })
        })
        .collect();
    let ends = ")".repeat(DEEP);
    let mut texts = vec![format!("{header}{lets}x{}{ends})", DEEP - 1)];
    for begin in ["(not ", "(= a ", "(let ((a ", "(! (let ((b "] {
        let end = match begin.matches('(').count() {
            1 => ")",
            3 => ")) a)",
            _ => ")) a))",
        };
        texts.push(format!("{header}{}b{})", begin.repeat(DEEP), end.repeat(DEEP)));
    }
    for text in &texts {
        assert_eq!(read(text).assertions, 1);
        // Torn anywhere, it is an error.
        assert!(read_script(&text[..text.len() / 2]).is_err());
    }
}

#[test]
fn macros_share_and_do_not_explode() {
    let mut text =
        "(declare-const a Bool)(declare-const b Bool)(define-fun f0 ((x Bool)) Bool (= x a))".to_owned();
    for i in 1..60 {
        text += &format!("(define-fun f{i} ((x Bool)) Bool (and (f{} x) (or b (f{} x))))", i - 1, i - 1);
    }
    assert!(read(&format!("{text}(assert (f59 b))")).script.terms.len() < 10_000);
    // What is not shared any more.
    let mut text = "(declare-const a Int)(define-fun f0 ((x Int)) Int (ite (< a x) (+ x 1) a))".to_owned();
    for i in 1..60 {
        text += &format!("(define-fun f{i} ((x Int)) Int (f{} (f{} x)))", i - 1, i - 1);
    }
    let error = refused(&format!("{text}(assert (= a (f59 a)))"));
    assert!(error.contains("what expands to more than"), "{error}");
}

#[test]
fn functions_are_read_written_and_evaluated() {
    let text = "(declare-fun f ((_ BitVec 2) Bool) (_ BitVec 3))(declare-fun |g h| (Int) Bool)(declare-fun i () Int)\n\
                (assert (= (f #b01 (|g h| i)) #b101))\n(assert (forall ((j Int)) (or (|g h| j) (< i j))))";
    let read = read(text);
    let script = &read.script;
    let [f, g] = read.functions[..] else { panic!("two functions") };
    let mut written = Vec::new();
    write_script(&mut written, script, &WriteOptions::default()).expect("memory");
    let written = String::from_utf8(written).expect("it is ASCII");
    for part in [
        "(set-logic ALL)\n(declare-fun f ((_ BitVec 2) Bool) (_ BitVec 3))\n(declare-fun |g h| (Int) Bool)\n(declare-fun i () Int)\n",
        "(assert (= (f #b01 (|g h| i)) #b101))\n",
        "(|g h| ",
    ] {
        assert!(written.contains(part), "{written}");
    }
    // z3, cvc5 and yices; one function by another that comes later.
    let texts = [
        "(define-fun f ((x!0 (_ BitVec 2)) (x!1 Bool)) (_ BitVec 3) (ite (and (= x!0 #b01) (k x!1)) #b101 #b000))",
        "(define-fun |g h| ((_arg_1 Int)) Bool (or (= 7 _arg_1) (not (< 0 (- 3 _arg_1)))))",
        "(define-fun k ((x Bool)) Bool (not x))",
        "(define-fun broken ((x Int)) Int (+ x nowhere))",
        "(define-fun constant () Int 3)",
    ];
    let definitions = read_definitions(&texts);
    let names: Vec<&str> = definitions.iter().map(|(name, _)| *name).collect();
    assert_eq!(names, ["g h", "k", "f"]);
    let mut model = Model::new();
    for (name, definition) in definitions {
        match name {
            "f" => model.define(f, definition),
            "g h" => model.define(g, definition),
            _ => assert_eq!(definition.value(&[Value::Int(1)]), None, "its argument is a Bool"),
        }
    }
    for (i, decided) in [(2, Verdict::True), (3, Verdict::False), (7, Verdict::False)] {
        model.insert(read.symbols[0], Value::Int(i));
        let evaluation = Evaluation::new(&script.terms, &model);
        assert_eq!(evaluation.clause(script.assertion(0)), decided, "i = {i}");
        assert_eq!(evaluation.clause(script.assertion(1)), Verdict::Unknown);
    }
    // Of a function of which nothing is said, nothing is known, or that it gives the same for all.
    let nothing = Model::new();
    assert_eq!(Evaluation::partial(&script.terms, &nothing).clause(script.assertion(0)), Verdict::Unknown);
    assert_eq!(Evaluation::new(&script.terms, &nothing).clause(script.assertion(0)), Verdict::False);
}

#[test]
fn functions_join_the_logic() {
    for (sorts, plain, quantified) in [
        ("Bool Bool", "QF_UF", "UF"),
        ("(_ BitVec 3) Bool", "QF_UFBV", "UFBV"),
        ("Int Int", "QF_UFLIA", "UFLIA"),
        ("Real Real", "QF_UFLRA", "UFLRA"),
        ("Int Real", "QF_UFLIRA", "UFLIRA"),
        ("D Bool", "QF_UFDT", "UFDT"),
    ] {
        let (domain, range) = match sorts.strip_prefix("(_ BitVec 3)") {
            Some(range) => ("(_ BitVec 3)", range),
            None => sorts.split_once(' ').expect("two sorts"),
        };
        let declared = format!(
            "(declare-datatypes ((D 0)) (((a) (b))))(declare-fun x () {domain})(declare-fun f ({domain}) {range})"
        );
        for (assertion, logic) in [
            ("(= (f x) (f x))", "QF_UF"),
            ("(not (= (f x) (f (ite (= (f x) (f x)) x x))))", "QF_UF"),
            ("(let ((y (f x))) (! (= y y) :named n))", "QF_UF"),
        ] {
            // What is true whatever the function is needs nothing.
            let script = read(&format!("{declared}(assert {assertion})")).script;
            assert_eq!(crate::logic(&crate::Features::of(&script)), logic, "{assertion}");
        }
        let script = read(&format!("{declared}(declare-fun y () {domain})(assert (= (f x) (f y)))")).script;
        assert_eq!(crate::logic(&crate::Features::of(&script)), plain, "{sorts}");
        let script = read(&format!("{declared}(assert (forall ((y {domain})) (= (f x) (f y))))")).script;
        assert_eq!(crate::logic(&crate::Features::of(&script)), quantified, "{sorts}");
    }
}
