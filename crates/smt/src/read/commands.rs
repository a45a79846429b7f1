//! Commands.

use super::expand::Macro;
use super::names::Meaning;
use super::{Benchmark, Origin, Reader, Trouble, newlines, shown};
use crate::lexer::Token;
use crate::term::{Sort, Term};

impl<'t> Reader<'t> {
    /// Reads all of it.
    pub(super) fn read(mut self) -> Result<Benchmark, Trouble> {
        while let Some((at, token)) = self.next()? {
            if token != Token::Open {
                return Err(Trouble::syntax(at, "a command begins with ("));
            }
            let (_, command) = self.name()?;
            if command == "exit" {
                self.skip()?;
                break;
            }
            self.command(at, command)?;
        }
        let Reader { script, symbols, functions, origins, assertions, .. } = self;
        Ok(Benchmark { script, symbols, functions, origins, assertions })
    }

    /// A command, once its name was read.
    fn command(&mut self, at: usize, command: &'t str) -> Result<(), Trouble> {
        match command {
            // What these print may look like a model: whoever reads the output has to know of them.
            "get-assertions" | "get-proof" => return Err(Trouble::unsupported(at, command)),
            "set-logic" | "set-option" | "set-info" | "echo" => return self.skip(),
            _ if command.starts_with("get-") => return self.skip(),
            _ if self.checked => return Err(Trouble::unsupported(at, format!("{command} after check-sat"))),
            "check-sat" => self.checked = true,
            "declare-fun" => {
                let (at, name) = self.name()?;
                let domain = self.domain()?;
                match domain.as_slice() {
                    [] => self.declare(at, name)?,
                    domain => self.declare_function(at, name, domain)?,
                }
            }
            "declare-const" => {
                let (at, name) = self.name()?;
                self.declare(at, name)?;
            }
            "declare-datatypes" => self.datatypes()?,
            "declare-datatype" => {
                let (at, name) = self.name()?;
                self.datatype(at, name)?;
            }
            "define-sort" => self.define_sort()?,
            "define-fun" => self.define(true)?,
            "define-const" => self.define(false)?,
            "assert" => self.assert(at)?,
            _ => return Err(Trouble::unsupported(at, shown(command))),
        }
        self.close()
    }

    fn declare(&mut self, at: usize, name: &'t str) -> Result<(), Trouble> {
        let sort = self.sort()?;
        let stem = self.terms().verbatim_stem(name);
        let symbol = self.terms().symbol(stem, None, sort);
        self.symbols.push(symbol);
        self.known(at, name, Meaning::Term(symbol))
    }

    fn declare_function(&mut self, at: usize, name: &'t str, domain: &[Sort]) -> Result<(), Trouble> {
        let range = self.sort()?;
        let stem = self.terms().verbatim_stem(name);
        let function = self.terms().function(stem, domain, range);
        self.functions.push(function);
        self.known(at, name, Meaning::Function(function))
    }

    /// Adds a symbol, which has to be new.
    pub(super) fn known(&mut self, at: usize, name: &'t str, meaning: Meaning) -> Result<(), Trouble> {
        let new = self.names.declare(name, meaning);
        new.then_some(()).ok_or_else(|| Trouble::syntax(at, format!("{} is declared twice", shown(name))))
    }

    /// A variable like no other.
    pub(super) fn fresh(&mut self, name: &str, sort: Sort) -> Term {
        let number = self.variables;
        self.variables += 1;
        let stem = self.terms().stem(name);
        self.terms().bound_symbol(stem, Some(number), sort)
    }

    /// Names and sorts in parentheses, bound from here on.
    pub(super) fn parameters(&mut self) -> Result<Vec<Term>, Trouble> {
        self.open()?;
        let mut found = Vec::new();
        let mut bound = Vec::new();
        while self.another()? {
            let (_, name) = self.name()?;
            let sort = self.sort()?;
            self.close()?;
            let variable = self.fresh(name, sort);
            found.push(variable);
            bound.push((name, variable));
        }
        bound.into_iter().for_each(|(name, variable)| self.names.bind(name, variable));
        Ok(found)
    }

    /// A definition, with arguments or without.
    pub(super) fn define(&mut self, arguments: bool) -> Result<(), Trouble> {
        let (at, name) = self.name()?;
        let scope = self.names.enter();
        let parameters = if arguments { self.parameters()? } else { Vec::new() };
        let sort = self.sort()?;
        let body = self.term()?;
        let body = self.of_sort(at, body, sort)?;
        self.names.leave(scope);
        if parameters.is_empty() {
            return self.known(at, name, Meaning::Term(body));
        }
        let definition = Macro::new(&self.script.terms, parameters, body);
        self.expanded += definition.size();
        self.check_room(at, 0)?;
        self.macros.push(definition);
        self.known(at, name, Meaning::Macro(self.macros.len() - 1))
    }

    fn define_sort(&mut self) -> Result<(), Trouble> {
        let (at, name) = self.name()?;
        self.open()?;
        if self.token()?.1 != Token::Close {
            return Err(Trouble::unsupported(at, "define-sort with parameters"));
        }
        let sort = self.sort()?;
        self.known_sort(at, name, sort)
    }

    fn known_sort(&mut self, at: usize, name: &'t str, sort: Sort) -> Result<(), Trouble> {
        let hidden = self.sorts.insert(name, sort);
        let twice = || Trouble::syntax(at, format!("sort {} is declared twice", shown(name)));
        hidden.is_none().then_some(()).ok_or_else(twice)
    }

    /// Datatypes: their names with their numbers of parameters, then their constructors.
    fn datatypes(&mut self) -> Result<(), Trouble> {
        self.open()?;
        let mut names = Vec::new();
        while self.another()? {
            let (at, name) = self.name()?;
            if self.index()? != 0 {
                return Err(Trouble::unsupported(at, "a datatype with parameters"));
            }
            self.close()?;
            names.push((at, name));
        }
        self.open()?;
        for (at, name) in names {
            self.datatype(at, name)?;
        }
        self.close()
    }

    /// The constructors of a datatype.
    fn datatype(&mut self, at: usize, name: &'t str) -> Result<(), Trouble> {
        self.open()?;
        let mut constructors = Vec::new();
        loop {
            match self.token()? {
                (_, Token::Close) => break,
                (_, Token::Open) => {
                    constructors.push(self.name()?);
                    if self.token()?.1 != Token::Close {
                        return Err(Trouble::unsupported(at, "a datatype with selectors"));
                    }
                }
                (at, Token::Word("par")) => return Err(Trouble::unsupported(at, "par")),
                // Not SMT-LIB, but often written.
                (at, Token::Word(name) | Token::Quoted(name)) => constructors.push((at, name)),
                (at, _) => return Err(Trouble::syntax(at, "a constructor is missing")),
            }
        }
        if constructors.is_empty() {
            return Err(Trouble::syntax(at, "a datatype has no constructors"));
        }
        let texts: Vec<&str> = constructors.iter().map(|(_, constructor)| *constructor).collect();
        let enumeration = self.terms().verbatim_enumeration(name, &texts);
        self.known_sort(at, name, Sort::Enum(enumeration))?;
        for (position, (at, constructor)) in (0..).zip(constructors) {
            let constant = self.terms().constructor(enumeration, position);
            self.known(at, constructor, Meaning::Term(constant))?;
        }
        Ok(())
    }

    fn assert(&mut self, at: usize) -> Result<(), Trouble> {
        let t = self.term()?;
        let t = self.of_sort(at, t, Sort::Bool)?;
        self.assertions += 1;
        let before = self.script.len();
        self.script.assert(t);
        if self.script.len() > before {
            self.line = (at, self.line.1 + newlines(&self.tokens.text()[self.line.0..at]));
            self.origins.push(Origin { number: self.assertions, line: self.line.1 });
        }
        Ok(())
    }
}
