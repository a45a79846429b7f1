//! Quantified Boolean formulas by brute force, from files in DIMACS, QDIMACS and QCIR, which have to follow their standards in
//! every respect.

use std::collections::BTreeSet;

/// A formula: its quantifiers, then gates or clauses.
#[derive(Debug)]
pub struct Formula {
    /// From the outside in: whether universal, and the variable.
    pub prefix: Vec<(bool, usize)>,
    /// The lines of comment before it.
    pub comments: Vec<String>,
    variables: usize,
    matrix: Matrix,
}

#[derive(Debug)]
enum Matrix {
    Clauses(Vec<Vec<i32>>),
    /// Each with its variable, whether it is a conjunction, and its inputs; the last is the output.
    Gates(Vec<(usize, bool, Vec<i32>)>),
}

impl Formula {
    /// Reads a file in DIMACS or QDIMACS.
    ///
    /// # Panics
    /// Where it does not follow the standard.
    #[must_use]
    pub fn of_clauses(text: &str, quantified: bool) -> Formula {
        let mut lines = text.lines().peekable();
        let mut comments = Vec::new();
        while let Some(line) = lines.next_if(|line| line.starts_with('c')) {
            comments.push(line[1..].trim_start().to_owned());
        }
        let problem: Vec<&str> = lines.next().expect("a problem line").split(' ').collect();
        let ["p", "cnf", variables, count] = problem[..] else { panic!("{problem:?} is no problem line") };
        let variables: usize = variables.parse().expect("a number of variables");
        let mut prefix = Vec::new();
        let mut blocks = Vec::new();
        while let Some(line) = lines.next_if(|line| line.starts_with(['a', 'e'])) {
            assert!(quantified, "DIMACS has no quantifiers: {line}");
            let universal = line.starts_with('a');
            let block = numbers(&line[1..]);
            assert!(!block.is_empty(), "an empty block");
            assert!(blocks.last() != Some(&universal), "two blocks of one quantifier: {line}");
            blocks.push(universal);
            prefix.extend(block.into_iter().map(|v| (universal, usize::try_from(v).expect("a variable"))));
        }
        if !quantified {
            prefix = (1..=variables).map(|variable| (false, variable)).collect();
        }
        assert!(blocks.last() != Some(&true), "the innermost block is universal");
        let clauses: Vec<Vec<i32>> = lines.map(numbers).collect();
        assert_eq!(clauses.len().to_string(), count, "the number of clauses");
        assert!(clauses.iter().all(|clause| !clause.is_empty()), "an empty clause");
        let formula = Formula { prefix, comments, variables, matrix: Matrix::Clauses(clauses) };
        formula.is_closed();
        formula
    }

    /// Reads a file in QCIR-14, which has to be prenex and cleansed.
    ///
    /// # Panics
    /// Where it is not.
    #[must_use]
    pub fn of_gates(text: &str) -> Formula {
        let mut lines = text.lines().peekable();
        let head = lines.next().and_then(|line| line.strip_prefix("#QCIR-G14 ")).expect("a head");
        let variables: usize = head.parse().expect("the last variable");
        let mut comments = Vec::new();
        while let Some(line) = lines.next_if(|line| line.starts_with('#')) {
            comments.push(line[1..].trim_start().to_owned());
        }
        let list = |text: &str| -> Vec<i32> {
            let inner = text.split_once('(').and_then(|(_, rest)| rest.strip_suffix(')')).expect("a list");
            let parts = inner.split(", ").filter(|part| !part.is_empty());
            parts.map(|part| part.parse().expect("a literal")).collect()
        };
        let (mut prefix, mut last) = (Vec::new(), None);
        while let Some(line) =
            lines.next_if(|line| line.starts_with("exists(") || line.starts_with("forall("))
        {
            let universal = line.starts_with("forall");
            assert!(last != Some(universal), "two blocks of one quantifier: {line}");
            last = Some(universal);
            let block = list(line);
            assert!(!block.is_empty(), "an empty block");
            prefix.extend(block.into_iter().map(|v| (universal, usize::try_from(v).expect("a variable"))));
        }
        let output = list(lines.next().filter(|line| line.starts_with("output(")).expect("an output"));
        let mut gates = Vec::new();
        for line in lines {
            let (variable, gate) = line.split_once(" = ").expect("a gate");
            assert!(gate.starts_with("and(") || gate.starts_with("or("), "{line}");
            let variable: usize = variable.parse().expect("a variable");
            gates.push((variable, gate.starts_with("and("), list(gate)));
        }
        assert_eq!(gates.last().map(|gate| vec![gate.0 as i32]), Some(output), "the last gate is the output");
        let formula = Formula { prefix, comments, variables, matrix: Matrix::Gates(gates) };
        formula.is_closed();
        formula
    }

    /// What occurs is quantified or defined before, once, and counted.
    fn is_closed(&self) {
        let mut known = BTreeSet::new();
        for &(_, variable) in &self.prefix {
            assert!(known.insert(variable), "{variable} has two quantifiers");
        }
        let check = |literal: &i32, known: &BTreeSet<usize>| {
            assert!(known.contains(&(literal.unsigned_abs() as usize)), "{literal} is free");
        };
        match &self.matrix {
            Matrix::Clauses(clauses) => clauses.iter().flatten().for_each(|literal| check(literal, &known)),
            Matrix::Gates(gates) => {
                for (variable, _, inputs) in gates {
                    inputs.iter().for_each(|literal| check(literal, &known));
                    assert!(known.insert(*variable), "{variable} is defined twice");
                }
            }
        }
        assert!(known.iter().all(|variable| (1..=self.variables).contains(variable)), "beyond the count");
    }

    /// Whether it is true.
    #[must_use]
    pub fn is_true(&self) -> bool {
        self.holds(0, &mut vec![None; self.variables + 1])
    }

    fn holds(&self, at: usize, values: &mut Vec<Option<bool>>) -> bool {
        let before = values.clone();
        let known = match &self.matrix {
            Matrix::Clauses(clauses) => propagated(clauses, &self.prefix, values),
            Matrix::Gates(gates) => evaluated(gates, values),
        };
        let result = known.unwrap_or_else(|| {
            let next = (at..self.prefix.len()).find(|&i| values[self.prefix[i].1].is_none());
            let Some(at) = next else { return true };
            let (universal, variable) = self.prefix[at];
            let mut with = |value| {
                values[variable] = Some(value);
                let holds = self.holds(at + 1, values);
                values[variable] = None;
                holds
            };
            if universal { with(false) && with(true) } else { with(false) || with(true) }
        });
        *values = before;
        result
    }
}

/// The numbers of a line before its 0.
fn numbers(line: &str) -> Vec<i32> {
    let mut numbers: Vec<i32> =
        line.split_ascii_whitespace().map(|word| word.parse().expect("a number")).collect();
    assert_eq!(numbers.pop(), Some(0), "{line}");
    assert!(!numbers.contains(&0), "{line}");
    numbers
}

/// What a literal is.
fn truth(values: &[Option<bool>], literal: i32) -> Option<bool> {
    values[literal.unsigned_abs() as usize].map(|value| value == (literal > 0))
}

/// Assigns what clauses force; what all of them together are, if that is known.
fn propagated(clauses: &[Vec<i32>], prefix: &[(bool, usize)], values: &mut [Option<bool>]) -> Option<bool> {
    let universal: BTreeSet<usize> =
        prefix.iter().filter(|(universal, _)| *universal).map(|(_, v)| *v).collect();
    loop {
        let (mut forced, mut all) = (false, true);
        for clause in clauses {
            if clause.iter().any(|&literal| truth(values, literal) == Some(true)) {
                continue;
            }
            all = false;
            let mut open = clause.iter().filter(|&&literal| truth(values, literal).is_none());
            match (open.next(), open.next()) {
                (None, _) => return Some(false),
                (Some(&literal), None) => {
                    // Whoever is against the formula has the choice.
                    if universal.contains(&(literal.unsigned_abs() as usize)) {
                        return Some(false);
                    }
                    values[literal.unsigned_abs() as usize] = Some(literal > 0);
                    forced = true;
                }
                _ => {}
            }
        }
        if all {
            return Some(true);
        }
        if !forced {
            return None;
        }
    }
}

/// The values of gates as far as they are known, and that of the last.
fn evaluated(gates: &[(usize, bool, Vec<i32>)], values: &mut [Option<bool>]) -> Option<bool> {
    let mut last = None;
    for (variable, is_and, inputs) in gates {
        let decides = inputs.iter().any(|&input| truth(values, input) == Some(!is_and));
        let open = inputs.iter().any(|&input| truth(values, input).is_none());
        last = if decides {
            Some(!is_and)
        } else if open {
            None
        } else {
            Some(*is_and)
        };
        values[*variable] = last;
    }
    last
}
