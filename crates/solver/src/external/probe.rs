//! What a solver can do, found out by asking it small questions.

use std::path::Path;
use std::time::Duration;

use hyperplan_smt::{Terms, Value, read_value};

use super::process::{Next, Process};
use super::profile::{FILE, Profile};
use super::reply::{self, Meaning, Reply};
use crate::deadline::Deadline;

/// How long a solver may take for one small question.
const PATIENCE: Duration = Duration::from_secs(2);

/// What came of asking.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Ability {
    /// It answered right.
    Able,
    /// It did not answer.
    Unable,
    /// It answered wrong.
    Wrong(String),
}

/// What a solver is expected to say.
#[derive(Copy, Clone, Debug)]
enum Expected {
    Sat,
    Unsat,
    /// A value of the symbol asked for.
    Value(Value),
    /// Names of assertions, these among them.
    Core(&'static [&'static str]),
}

struct Question {
    ability: &'static str,
    logic: &'static str,
    /// Quantified questions go to a process for quantifiers.
    quantified: bool,
    /// Commands, after the solver's own setup.
    text: &'static str,
    expected: &'static [Expected],
}

const QUESTIONS: &[Question] = &[
    Question {
        ability: "bit-vectors",
        logic: "QF_BV",
        quantified: false,
        text: "(declare-fun v () (_ BitVec 4))(assert (= (bvadd v #b0011) #b0001))(check-sat)(get-value (v))",
        expected: &[Expected::Sat, Expected::Value(Value::Bv { width: 4, bits: 14 })],
    },
    Question {
        ability: "integers",
        logic: "QF_LIA",
        quantified: false,
        text: "(declare-fun n () Int)(assert (= (+ n 3) 1))(check-sat)(get-value (n))",
        expected: &[Expected::Sat, Expected::Value(Value::Int(-2))],
    },
    Question {
        ability: "reals",
        logic: "QF_LRA",
        quantified: false,
        text: "(declare-fun r () Real)(assert (and (< r 0.5) (> (* 2.0 r) 1.0)))(check-sat)",
        expected: &[Expected::Unsat],
    },
    Question {
        ability: "datatypes",
        logic: "QF_DT",
        quantified: false,
        text: "(declare-datatypes ((D 0)) (((a) (b))))(declare-fun d () D)\
               (assert (not (= d a)))(assert (not (= d b)))(check-sat)",
        expected: &[Expected::Unsat],
    },
    Question {
        ability: "quantified bit-vectors",
        logic: "BV",
        quantified: true,
        text: "(declare-fun v () (_ BitVec 3))(assert (forall ((w (_ BitVec 3))) (bvule w v)))(check-sat)",
        expected: &[Expected::Sat],
    },
    Question {
        ability: "quantified integers",
        logic: "LIA",
        quantified: true,
        text: "(declare-fun n () Int)(assert (and (> n 5) (forall ((m Int)) (=> (> m 3) (>= m n)))))(check-sat)",
        expected: &[Expected::Unsat],
    },
    Question {
        ability: "quantified reals",
        logic: "LRA",
        quantified: true,
        text: "(declare-fun r () Real)(assert (and (> r 5.0) (forall ((s Real)) (=> (> s 3.0) (>= s r)))))(check-sat)",
        expected: &[Expected::Unsat],
    },
    Question {
        ability: "nested quantifiers",
        logic: "BV",
        quantified: true,
        text: "(assert (forall ((v (_ BitVec 2))) (exists ((w (_ BitVec 2))) (= (bvadd v w) #b00))))(check-sat)",
        expected: &[Expected::Sat],
    },
    Question {
        ability: "incremental",
        logic: "QF_BV",
        quantified: false,
        text: "(declare-fun p () Bool)(assert p)(check-sat)(assert (not p))(check-sat)",
        expected: &[Expected::Sat, Expected::Unsat],
    },
    Question {
        ability: "push and pop",
        logic: "QF_BV",
        quantified: false,
        text: "(declare-fun p () Bool)(assert p)(push 1)(assert (not p))(check-sat)(pop 1)(check-sat)",
        expected: &[Expected::Unsat, Expected::Sat],
    },
    Question {
        ability: "assumptions",
        logic: "QF_BV",
        quantified: false,
        text: "(declare-fun p () Bool)(assert p)(check-sat-assuming ((not p)))(check-sat)",
        expected: &[Expected::Unsat, Expected::Sat],
    },
    Question {
        ability: "cores",
        logic: "QF_UF",
        quantified: false,
        text: "(declare-fun p () Bool)(declare-fun q () Bool)(assert (! p :named yes))(assert (! q :named other))\
               (assert (! (not p) :named no))(check-sat)(get-unsat-core)",
        expected: &[Expected::Unsat, Expected::Core(&["yes", "no"])],
    },
];

/// What the solver can do, in a fixed order.
pub(super) fn abilities(profile: &Profile, program: &Path) -> Vec<(&'static str, Ability)> {
    let mut silent = 0;
    let ask = |question: &Question| {
        // One that says nothing at all is not asked a dozen times.
        if silent >= 2 {
            return (question.ability, Ability::Unable);
        }
        let (ability, in_time) = ask(profile, program, question);
        silent += usize::from(!in_time);
        (question.ability, ability)
    };
    QUESTIONS.iter().map(ask).collect()
}

/// Asks one question; whether there was an answer in time.
fn ask(profile: &Profile, program: &Path, question: &Question) -> (Ability, bool) {
    let one_shot = profile.one_shot.as_ref().filter(|_| question.quantified || !profile.incremental);
    let arguments = one_shot.unwrap_or(&profile.arguments);
    let mut text: String = profile.setup.iter().flat_map(|command| [command.as_str(), "\n"]).collect();
    if question.ability == "cores" {
        text += "(set-option :produce-unsat-cores true)\n";
    }
    let logic = profile.logic.as_deref().unwrap_or(question.logic);
    text += &format!("(set-logic {logic})\n{}\n(exit)\n", question.text.replace(")(", ")\n("));
    let file = match arguments.iter().any(|word| word.contains(FILE)) {
        true => super::one_shot::temporary(text.as_bytes()).ok(),
        false => None,
    };
    let path = file.as_ref().map(|file| file.path().display().to_string());
    let fill = |word: &String| path.as_ref().map_or_else(|| word.clone(), |path| word.replace(FILE, path));
    let arguments: Vec<String> = arguments.iter().map(fill).collect();
    let Ok(mut process) = Process::spawn(program, &arguments, None) else { return (Ability::Unable, true) };
    let deadline = Deadline::after(PATIENCE);
    if file.is_none() {
        process.send(text.into_bytes(), &deadline);
    }
    process.close_input();
    for expected in question.expected {
        match heard(&mut process, &deadline) {
            Ok(reply) => match judge(&reply, *expected) {
                Ability::Able => {}
                other => return (other, true),
            },
            Err(in_time) => return (Ability::Unable, in_time),
        }
    }
    (Ability::Able, true)
}

/// The next reply that counts; else whether it ended rather than said nothing.
fn heard(process: &mut Process, deadline: &Deadline) -> Result<Reply, bool> {
    loop {
        match process.next(deadline) {
            Next::Reply(reply) if reply::meaning(&reply) == Meaning::Noise => {}
            Next::Reply(reply) => return Ok(reply),
            Next::Ended => return Err(true),
            Next::Deadline => return Err(false),
        }
    }
}

fn judge(reply: &Reply, expected: Expected) -> Ability {
    let wrong = || Ability::Wrong(format!("it said {}", reply.text().chars().take(100).collect::<String>()));
    match (expected, reply::meaning(reply)) {
        (_, Meaning::Error(_)) => Ability::Unable,
        (Expected::Sat, Meaning::Answer(Some(true))) | (Expected::Unsat, Meaning::Answer(Some(false))) => {
            Ability::Able
        }
        (Expected::Sat | Expected::Unsat, Meaning::Answer(Some(_))) => wrong(),
        (Expected::Value(value), Meaning::Other) => match reply::values(reply).as_deref() {
            Some([said]) if read_value(&Terms::new(), value.sort(), said) == Some(value) => Ability::Able,
            Some(_) => wrong(),
            None => Ability::Unable,
        },
        (Expected::Core(names), Meaning::Other) => {
            let words = reply.text().split(|c: char| "()".contains(c) || c.is_whitespace());
            let said: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
            if names.iter().all(|name| said.contains(name)) { Ability::Able } else { Ability::Unable }
        }
        _ => Ability::Unable,
    }
}
