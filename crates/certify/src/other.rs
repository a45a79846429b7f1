//! Refutations as other checkers read them.

use crate::error::Error;
use rustc_hash::FxHashMap;
use std::io::{BufRead, BufWriter, Write};

/// Writes a refutation of so many clauses, in LRAT form and checked before, as VeriPB reads it. There constraints are numbered one
/// after the other. `empty` is the number of the first of the clauses that is empty, if one is.
///
/// # Errors
/// If it cannot be read or written.
pub fn pseudo_boolean(
    refutation: &mut dyn BufRead,
    (clauses, empty): (u64, Option<u64>),
    to: &mut dyn Write,
) -> Result<(), Error> {
    let mut to = BufWriter::new(to);
    let broken = || Error::Unreadable("a step of the refutation is broken".to_owned());
    let mut numbers: FxHashMap<u64, u64> = FxHashMap::default();
    let (mut last, mut end) = (clauses, empty);
    write!(to, "pseudo-Boolean proof version 3.0\nf {clauses} ;\n")?;
    let mut line = String::new();
    while end.is_none() {
        line.clear();
        if refutation.read_line(&mut line)? == 0 {
            return Err(Error::Incomplete);
        }
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        let number = |word: &&str| word.parse::<u64>().map_err(|_| broken());
        let (own, rest) = words.split_first().ok_or_else(broken)?;
        // Deletions only save time; the first clauses stay.
        if rest.first() == Some(&"d") {
            for word in rest.get(1..rest.len() - 1).ok_or_else(broken)? {
                if let Some(known) = numbers.remove(&number(word)?) {
                    writeln!(to, "del id {known} ;")?;
                }
            }
            continue;
        }
        let middle = rest.iter().position(|word| *word == "0").ok_or_else(broken)?;
        write!(to, "rup")?;
        for literal in &rest[..middle] {
            match literal.strip_prefix('-') {
                Some(variable) => write!(to, " 1 ~x{variable}")?,
                None => write!(to, " 1 x{literal}")?,
            }
        }
        write!(to, " >= 1 :")?;
        for hint in rest.get(middle + 1..rest.len() - 1).ok_or_else(broken)? {
            let hint = number(hint)?;
            write!(to, " {}", numbers.get(&hint).copied().unwrap_or(hint))?;
        }
        writeln!(to, " ;")?;
        last += 1;
        numbers.insert(number(own)?, last);
        end = (middle == 0).then_some(last);
    }
    let end = end.unwrap_or(last);
    write!(to, "output NONE ;\nconclusion UNSAT : {end} ;\nend pseudo-Boolean proof ;\n")?;
    Ok(to.flush()?)
}
