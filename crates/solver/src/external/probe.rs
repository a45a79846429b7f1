//! What a solver can do, found out by asking it small questions.

use std::path::Path;
use std::sync::{Arc, LazyLock};
use std::time::Duration;

use hyperplan_smt::{Terms, Value, read_script, read_value};
use serde::Deserialize;

use super::bits::Bits;
use super::process::{Next, Process};
use super::profile::{FILE, Profile};
use super::program::Program;
use super::reply::{self, Meaning, Reply};
use crate::deadline::Deadline;
use crate::error::Unknown;
use crate::propositional::Format;
use crate::session::{Answer, Options, Quantifiers, Session as _};

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
#[derive(Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Expected {
    Sat,
    Unsat,
    /// A value of the symbol asked for: a bit-vector of four bits.
    Vector(i128),
    /// A value of the symbol asked for: an integer.
    Integer(i128),
    /// Names of assertions, these among them.
    Core(Vec<String>),
}

#[derive(Deserialize)]
struct Question {
    ability: String,
    logic: String,
    /// Commands, after the solver's own setup.
    text: String,
    expected: Vec<Expected>,
}

/// The table of questions.
#[derive(Deserialize)]
struct Table {
    question: Vec<Question>,
}

/// The questions, in a fixed order.
static QUESTIONS: LazyLock<Vec<Question>> = LazyLock::new(|| {
    let table: Table = toml::from_str(include_str!("questions.toml")).expect("the table is tested");
    table.question
});

/// What the solver can do, in a fixed order.
pub(super) fn abilities(profile: &Arc<Profile>, program: &Path) -> Vec<(&'static str, Ability)> {
    let mut silent = 0;
    let ask = |question: &'static Question| {
        // One that says nothing at all is not asked a dozen times.
        if silent >= 2 {
            return (question.ability.as_str(), Ability::Unable);
        }
        let (ability, in_time) = match profile.format {
            Some(format) => ask_in_bits(profile, program, format, question),
            None => ask(profile, program, question),
        };
        silent += usize::from(!in_time);
        (question.ability.as_str(), ability)
    };
    QUESTIONS.iter().map(ask).collect()
}

/// Asks one question of a program that gets files of bits: about one answer, and values; whether there was an answer in time.
fn ask_in_bits(
    profile: &Arc<Profile>,
    program: &Path,
    format: Format,
    question: &Question,
) -> (Ability, bool) {
    let quantified = !question.logic.starts_with("QF_");
    let text = format!("(set-logic {})\n{}", question.logic, question.text);
    let Ok(benchmark) = read_script(&text) else { return (Ability::Unable, true) };
    let answers = question.expected.iter().filter(|said| matches!(said, Expected::Sat | Expected::Unsat));
    if quantified && profile.quantifiers == Quantifiers::None || answers.count() > 1 {
        return (Ability::Unable, true);
    }
    let program = Program::at(program.to_owned(), profile, &Options::default());
    let mut session = Bits::new(program, format, &Options::default());
    let Ok(answer) = session.check(&benchmark.script, &[], &Deadline::after(PATIENCE)) else {
        return (Ability::Unable, true);
    };
    for expected in &question.expected {
        let right = match expected {
            Expected::Sat => answer == Answer::Sat,
            Expected::Unsat => answer == Answer::Unsat,
            Expected::Vector(number) => {
                let values = session.values(&benchmark.script, &benchmark.symbols);
                values.is_ok_and(|values| values == [Value::bv(*number, 4)])
            }
            Expected::Integer(_) | Expected::Core(_) => return (Ability::Unable, true),
        };
        match answer {
            Answer::Unknown(why) => return (Ability::Unable, why != Unknown::Timeout),
            _ if !right => return (Ability::Wrong(format!("it said {answer:?}")), true),
            _ => {}
        }
    }
    (Ability::Able, true)
}

/// Asks one question; whether there was an answer in time.
fn ask(profile: &Profile, program: &Path, question: &Question) -> (Ability, bool) {
    let quantified = !question.logic.starts_with("QF_");
    let one_shot = profile.one_shot.as_ref().filter(|_| quantified || !profile.incremental);
    let arguments = one_shot.unwrap_or(&profile.arguments);
    let mut text: String = profile.setup.iter().flat_map(|command| [command.as_str(), "\n"]).collect();
    if question.ability == "cores" {
        text += "(set-option :produce-unsat-cores true)\n";
    }
    let logic = profile.logic.as_ref().unwrap_or(&question.logic);
    text += &format!("(set-logic {logic})\n{}", question.text);
    let file = match arguments.iter().any(|word| word.contains(FILE)) {
        true => super::one_shot::temporary(&[text.as_bytes(), b"(exit)\n"], "smt2").ok(),
        false => None,
    };
    let path = file.as_ref().map(|file| file.path().display().to_string());
    let fill = |word: &String| path.as_ref().map_or_else(|| word.clone(), |path| word.replace(FILE, path));
    let arguments: Vec<String> = arguments.iter().map(fill).collect();
    let Ok(mut process) = Process::spawn(program, &arguments, None) else { return (Ability::Unable, true) };
    let deadline = Deadline::after(PATIENCE);
    if file.is_none() {
        process.send((text + "(exit)\n").into_bytes(), &deadline);
    }
    process.close_input();
    for expected in &question.expected {
        match heard(&mut process, &deadline) {
            Ok(reply) => match judge(&reply, expected) {
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

fn judge(reply: &Reply, expected: &Expected) -> Ability {
    let wrong = || Ability::Wrong(format!("it said {}", reply.text().chars().take(100).collect::<String>()));
    let value = |value: Value| match reply::values(reply).as_deref() {
        Some([said]) if read_value(&Terms::new(), value.sort(), said) == Some(value) => Ability::Able,
        Some(_) => wrong(),
        None => Ability::Unable,
    };
    match (expected, reply::meaning(reply)) {
        (_, Meaning::Error(_)) => Ability::Unable,
        (Expected::Sat, Meaning::Answer(Some(true))) | (Expected::Unsat, Meaning::Answer(Some(false))) => {
            Ability::Able
        }
        (Expected::Sat | Expected::Unsat, Meaning::Answer(Some(_))) => wrong(),
        (Expected::Vector(number), Meaning::Other) => value(Value::bv(*number, 4)),
        (Expected::Integer(number), Meaning::Other) => value(Value::Int(*number)),
        (Expected::Core(names), Meaning::Other) => {
            let words = reply.text().split(|c: char| "()".contains(c) || c.is_whitespace());
            let said: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
            if names.iter().all(|name| said.contains(&name.as_str())) {
                Ability::Able
            } else {
                Ability::Unable
            }
        }
        _ => Ability::Unable,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_can_be_read() {
        assert!(QUESTIONS.iter().all(|question| !question.expected.is_empty()));
    }
}
