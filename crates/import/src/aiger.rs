//! Circuits in AIGER: latches and inputs are Boolean variables, outputs and gates definitions.
//!
//! Source: Biere, Heljanko, Wieringa, "AIGER 1.9 And Beyond", 2011. The binary form is turned into the other one first, as
//! `aigtoaig` does, so that places can be shown.

use crate::build::{Lines, MAX_PARTS, Unique, assign, boolean, main, name, not, truth, wrong};
use crate::parser::Parse;
use crate::tree::{Expr, Item, Kind, Module, Moment, Role};
use hyperplan_syntax::ast::Ident;
use hyperplan_syntax::{SourceId, Span};
use rustc_hash::FxHashMap;
use std::fmt::Write as _;

/// The numbers of the first line: variables, inputs, latches, outputs, gates, bad states, constraints.
struct Header {
    most: u64,
    inputs: usize,
    latches: usize,
    outputs: usize,
    gates: usize,
    bad: usize,
    constraints: usize,
}

impl Header {
    fn read(line: &str, format: &str) -> Result<Header, String> {
        let mut words = line.split(' ');
        if words.next() != Some(format) {
            return Err(format!("expected `{format} M I L O A`, which circuits begin with"));
        }
        let mut numbers = [0u64; 9];
        let mut count = 0;
        for word in words {
            let (Some(place), Ok(number)) = (numbers.get_mut(count), word.parse()) else {
                return Err(format!("`{word}` is no number of things that circuits have"));
            };
            *place = number;
            count += 1;
        }
        let [most, inputs, latches, outputs, gates, bad, constraints, justice, fairness] = numbers;
        if count < 5 {
            return Err(format!("expected at least five numbers behind `{format}`: M I L O A"));
        }
        if justice > 0 || fairness > 0 {
            return Err("justice and fairness speak of infinite paths, and these are finite".to_owned());
        }
        let total = numbers[1..].iter().try_fold(0u64, |sum, n| sum.checked_add(*n));
        if total.is_none_or(|total| total > MAX_PARTS as u64) || most > MAX_PARTS as u64 {
            return Err(format!("a circuit of more than {MAX_PARTS} parts"));
        }
        let small = |n: u64| usize::try_from(n).unwrap_or(MAX_PARTS);
        Ok(Header {
            most,
            inputs: small(inputs),
            latches: small(latches),
            outputs: small(outputs),
            gates: small(gates),
            bad: small(bad),
            constraints: small(constraints),
        })
    }
}

/// A circuit as a module.
pub(crate) fn parse(source: SourceId, text: &str) -> Parse<Vec<Module>> {
    let mut lines = Lines::new(source, text);
    let end = lines.end();
    let (first, head) = lines.next().unwrap_or(("", end));
    let header = match Header::read(first, "aag") {
        Ok(header) => header,
        Err(message) => return wrong("syntax", head, message),
    };
    let most = 2 * header.most + 1;
    let mut rows = |count: usize, least: usize, greatest: usize| -> Parse<Vec<(Vec<u64>, Span)>> {
        let row = |_| {
            let (line, span) = lines.next().unwrap_or(("", end));
            let numbers: Option<Vec<u64>> = line.split(' ').map(|word| word.parse().ok()).collect();
            match numbers {
                Some(row) if (least..=greatest).contains(&row.len()) && row.iter().all(|n| *n <= most) => {
                    Ok((row, span))
                }
                _ => wrong("syntax", span, format!("expected {least} literals of at most {most}")),
            }
        };
        (0..count).map(row).collect()
    };
    let inputs = rows(header.inputs, 1, 1)?;
    let latches = rows(header.latches, 2, 3)?;
    let outputs = rows(header.outputs, 1, 1)?;
    let bad = rows(header.bad, 1, 1)?;
    let constraints = rows(header.constraints, 1, 1)?;
    let gates = rows(header.gates, 3, 3)?;
    let symbols = symbols(&mut lines)?;
    let mut circuit = Circuit { names: FxHashMap::default(), unique: Unique::default(), items: Vec::new() };
    for (letter, role, all) in [('i', Role::Input, &inputs), ('l', Role::State, &latches)] {
        for (at, (row, span)) in all.iter().enumerate() {
            let ident = circuit.define(row[0], symbols.get(&(letter, at)), format!("{letter}{at}"), *span)?;
            circuit.items.push(boolean(role, ident));
        }
    }
    for (row, span) in &gates {
        circuit.define(row[0], None, format!("n{}", row[0] / 2), *span)?;
    }
    for (row, span) in &gates {
        let (left, right) = (circuit.literal(row[1], *span)?, circuit.literal(row[2], *span)?);
        let both = Expr::new(Kind::And(vec![left, right]), *span);
        let own = circuit.names[&row[0]].clone();
        circuit.items.push(Item::Define(Ident { name: own, span: *span }, both));
    }
    for (row, span) in &latches {
        let own = || name(&circuit.names[&row[0]], *span);
        let first = match row.get(2) {
            None | Some(0) => Some(false),
            Some(1) => Some(true),
            Some(reset) if *reset == row[0] => None,
            Some(_) => return wrong("syntax", *span, "a latch begins with 0, 1 or, as itself, anything"),
        };
        let begins = first.map(|value| assign(Moment::First, own(), truth(value, *span)));
        let goes_on = assign(Moment::Next, own(), circuit.literal(row[1], *span)?);
        circuit.items.extend(begins);
        circuit.items.push(goes_on);
    }
    for (letter, all) in [('o', &outputs), ('b', &bad)] {
        for (at, (row, span)) in all.iter().enumerate() {
            let symbol = symbols.get(&(letter, at)).cloned();
            let own = circuit.literal(row[0], *span)?;
            // An output often has the name of the latch that it shows.
            if symbol.is_some() && symbol.as_ref() == circuit.names.get(&row[0]) {
                continue;
            }
            let ident = circuit.unique.name(&symbol.unwrap_or_else(|| format!("{letter}{at}")));
            circuit.items.push(Item::Define(Ident { name: ident, span: *span }, own));
        }
    }
    for (row, span) in &constraints {
        let holds = circuit.literal(row[0], *span)?;
        circuit.items.push(Item::Invar(holds));
    }
    Ok(main(circuit.items, head))
}

struct Circuit {
    /// Of positive literals.
    names: FxHashMap<u64, String>,
    unique: Unique,
    items: Vec<Item>,
}

impl Circuit {
    /// Gives a variable its name.
    fn define(
        &mut self,
        literal: u64,
        symbol: Option<&String>,
        otherwise: String,
        span: Span,
    ) -> Parse<Ident> {
        if literal < 2 || literal % 2 == 1 {
            return wrong("syntax", span, format!("{literal} is no variable: variables are even, from 2"));
        }
        let name = self.unique.name(symbol.unwrap_or(&otherwise));
        if self.names.insert(literal, name.clone()).is_some() {
            return wrong("duplicate-name", span, format!("{literal} is defined twice"));
        }
        Ok(Ident { name, span })
    }

    fn literal(&self, literal: u64, span: Span) -> Parse<Expr> {
        if literal < 2 {
            return Ok(truth(literal == 1, span));
        }
        let Some(own) = self.names.get(&(literal & !1)) else {
            return wrong(
                "unknown-name",
                span,
                format!("{} is neither input nor latch nor gate", literal & !1),
            );
        };
        let positive = name(own, span);
        Ok(if literal % 2 == 1 { not(positive, span) } else { positive })
    }
}

/// The names behind the gates, `i0 NAME`; comments begin with a line `c`.
fn symbols(lines: &mut Lines<'_>) -> Parse<FxHashMap<(char, usize), String>> {
    let mut found = FxHashMap::default();
    while let Some((line, span)) = lines.next() {
        if line == "c" || line.is_empty() {
            break;
        }
        let symbol = line.split_once(' ').and_then(|(place, name)| {
            let letter = place.chars().next().filter(|letter| "ilobcjf".contains(*letter))?;
            Some(((letter, place[1..].parse::<usize>().ok()?), name))
        });
        match symbol {
            Some((place, name)) if !name.is_empty() => found.insert(place, name.to_owned()),
            _ => return wrong("syntax", span, "expected a name, such as `i0 request`, or the comment, `c`"),
        };
    }
    Ok(found)
}

/// A circuit in the binary form, in the other one.
///
/// # Errors
/// If it is none; where, in bytes, is part of the message.
pub fn ascii(bytes: &[u8]) -> Result<String, String> {
    let line_end = |from: usize| bytes[from..].iter().position(|b| *b == b'\n').map(|length| from + length);
    let mut at = line_end(0).ok_or("it has no first line")?;
    let first = String::from_utf8_lossy(&bytes[..at]).into_owned();
    let header = Header::read(first.trim_end(), "aig")?;
    at += 1;
    let known = (header.inputs + header.latches + header.gates) as u64;
    if known != header.most {
        return Err(format!("{} variables are announced, and {known} are there", header.most));
    }
    let mut text = first.trim_end().replacen("aig", "aag", 1) + "\n";
    for input in 1..=header.inputs {
        let _ = writeln!(text, "{}", 2 * input);
    }
    for line in 0..header.latches + header.outputs + header.bad + header.constraints {
        let end = line_end(at).ok_or_else(|| format!("it ends in line {}", line + 2))?;
        if line < header.latches {
            let _ = write!(text, "{} ", 2 * (header.inputs + line + 1));
        }
        text += String::from_utf8_lossy(&bytes[at..end]).trim_end();
        text.push('\n');
        at = end + 1;
    }
    for gate in 0..header.gates {
        let own = 2 * (header.inputs + header.latches + gate + 1) as u64;
        let mut operand = |from: u64| {
            let less = number(bytes, &mut at).filter(|less| *less <= from);
            less.map(|less| from - less).ok_or_else(|| format!("byte {at} is no difference of two literals"))
        };
        let left = operand(own)?;
        let right = operand(left)?;
        let _ = writeln!(text, "{own} {left} {right}");
    }
    Ok(text + &String::from_utf8_lossy(&bytes[at..]))
}

/// Seven bits a byte, the least first; all but the last have the eighth.
fn number(bytes: &[u8], at: &mut usize) -> Option<u64> {
    let mut number = 0;
    for shift in (0..35).step_by(7) {
        let byte = *bytes.get(*at)?;
        *at += 1;
        number |= u64::from(byte & 0x7f) << shift;
        if byte & 0x80 == 0 {
            return Some(number);
        }
    }
    None
}
