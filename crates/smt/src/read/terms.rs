//! Terms, on a stack of what has begun.

use super::Reader;
use super::names::Meaning;
use super::operators::Operator;
use super::value::{decimal, vector};
use super::{Trouble, shown};
use crate::lexer::Token;
use crate::name::is_reserved;
use crate::term::{Function, Sort, Term};
use crate::value::Value;

/// What has begun and not ended. Its parts are on the stack of terms, from `start` on.
struct Frame<'t> {
    at: usize,
    start: usize,
    kind: Kind<'t>,
}

enum Kind<'t> {
    Application(Head),
    /// The bindings of a `let`: their names, and whether the last has not ended.
    Bindings {
        names: Vec<&'t str>,
        inside: bool,
    },
    /// The body of a `let`, with its scope.
    Body(usize),
    /// The body of a quantifier, with its scope and variables.
    Quantified {
        scope: usize,
        exists: bool,
        variables: Vec<Term>,
    },
    /// `(! t ...)`.
    Annotated,
}

#[derive(Clone, Copy)]
enum Head {
    Operator(Operator),
    Function(Function),
    Macro(usize),
}

#[derive(Default)]
struct Stack<'t> {
    frames: Vec<Frame<'t>>,
    terms: Vec<Term>,
}

impl Stack<'_> {
    /// That a term may come here.
    fn check_place(&self, at: usize) -> Result<(), Trouble> {
        let Some(frame) = self.frames.last() else { return Ok(()) };
        let parts = self.terms.len() - frame.start;
        let fits = match &frame.kind {
            Kind::Application(_) => true,
            Kind::Bindings { names, inside } => *inside && names.len() == parts + 1,
            Kind::Body(_) | Kind::Quantified { .. } | Kind::Annotated => parts == 0,
        };
        fits.then_some(()).ok_or_else(|| Trouble::syntax(at, "no term may come here"))
    }

    /// The term whose attributes come now.
    fn annotated(&self) -> Option<Term> {
        let frame = self.frames.last().filter(|frame| matches!(frame.kind, Kind::Annotated))?;
        self.terms.get(frame.start).copied()
    }
}

impl<'t> Reader<'t> {
    /// A term.
    pub(super) fn term(&mut self) -> Result<Term, Trouble> {
        let mut stack = Stack::default();
        loop {
            let (at, token) = self.token()?;
            match (token, stack.annotated()) {
                (Token::Close, _) => self.end(&mut stack, at)?,
                (_, Some(t)) => self.attribute(t, token)?,
                (Token::Open, None) => self.begin(&mut stack, at)?,
                _ => {
                    stack.check_place(at)?;
                    let t = self.atom(at, token)?;
                    stack.terms.push(t);
                }
            }
            if stack.frames.is_empty()
                && let Some(t) = stack.terms.pop()
            {
                return Ok(t);
            }
        }
    }

    /// What comes after an opening parenthesis.
    fn begin(&mut self, stack: &mut Stack<'t>, at: usize) -> Result<(), Trouble> {
        if let Some(Frame { kind: Kind::Bindings { names, inside }, .. }) = stack.frames.last_mut()
            && !std::mem::replace(inside, true)
        {
            names.push(self.name()?.1);
            return Ok(());
        }
        stack.check_place(at)?;
        let (head_at, token) = self.token()?;
        let kind = match token {
            Token::Word("let") => {
                self.open()?;
                Kind::Bindings { names: Vec::new(), inside: false }
            }
            Token::Word(word @ ("forall" | "exists")) => {
                let scope = self.names.enter();
                let variables = self.parameters()?;
                Kind::Quantified { scope, exists: word == "exists", variables }
            }
            Token::Word("!") => Kind::Annotated,
            Token::Word("_") => {
                let t = self.indexed_constant(at)?;
                stack.terms.push(t);
                return Ok(());
            }
            Token::Word("as") => {
                let t = self.qualified()?;
                stack.terms.push(t);
                return Ok(());
            }
            Token::Open => Kind::Application(Head::Operator(self.indexed_operator(head_at)?)),
            Token::Word(name) if is_reserved(name) => return Err(Trouble::unsupported(head_at, name)),
            Token::Word(name) | Token::Quoted(name) => Kind::Application(self.head(head_at, name)?),
            _ => return Err(Trouble::syntax(head_at, "a function is missing")),
        };
        stack.frames.push(Frame { at: head_at, start: stack.terms.len(), kind });
        Ok(())
    }

    /// A function, by its name.
    fn head(&self, at: usize, name: &str) -> Result<Head, Trouble> {
        match self.names.get(name) {
            Some(Meaning::Macro(number)) => Ok(Head::Macro(number)),
            Some(Meaning::Function(function)) => Ok(Head::Function(function)),
            Some(Meaning::Term(_)) => Err(Trouble::syntax(at, format!("{} takes no arguments", shown(name)))),
            None => match Operator::named(name) {
                Some(operator) => Ok(Head::Operator(operator)),
                None => Err(Trouble::unsupported(at, shown(name))),
            },
        }
    }

    /// `(_ name index...)` as a function, once its parenthesis is open.
    fn indexed_operator(&mut self, at: usize) -> Result<Operator, Trouble> {
        match self.token()? {
            (_, Token::Word("_")) => {}
            (at, Token::Word(word)) => return Err(Trouble::unsupported(at, shown(word))),
            (at, _) => return Err(Trouble::syntax(at, "a function is missing")),
        }
        let (_, name) = self.name()?;
        let operator = match name {
            "is" => {
                let (at, constructor) = self.name()?;
                match self.names.get(constructor) {
                    Some(Meaning::Term(t)) if self.is_constructor(t) => Operator::Is(t),
                    _ => {
                        return Err(Trouble::syntax(at, format!("{} is no constructor", shown(constructor))));
                    }
                }
            }
            "extract" => Operator::Extract(self.index()?, self.index()?),
            "zero_extend" => Operator::ZeroExtend(self.index()?),
            "sign_extend" => Operator::SignExtend(self.index()?),
            "rotate_left" => Operator::RotateLeft(self.index()?),
            "rotate_right" => Operator::RotateRight(self.index()?),
            "repeat" => Operator::Repeat(self.index()?),
            "divisible" => Operator::Divisible(self.index()?),
            _ => return Err(Trouble::unsupported(at, shown(name))),
        };
        self.close()?;
        Ok(operator)
    }

    fn is_constructor(&mut self, t: Term) -> bool {
        matches!(self.terms().value(t), Some(Value::Enum(..)))
    }

    /// `(_ bv5 8)`, once `_` was read.
    fn indexed_constant(&mut self, at: usize) -> Result<Term, Trouble> {
        let (_, name) = self.name()?;
        let digits = name.strip_prefix("bv").filter(|digits| is_number(digits));
        let Some(digits) = digits else { return Err(Trouble::unsupported(at, shown(name))) };
        let width = self.index()?;
        self.close()?;
        let bits: u128 = digits.parse().map_err(|_| Trouble::unsupported(at, shown(name)))?;
        self.vector(at, bits, width as usize)
    }

    /// `(as constructor Sort)`, once `as` was read.
    fn qualified(&mut self) -> Result<Term, Trouble> {
        let (at, name) = self.name()?;
        let sort = self.sort()?;
        self.close()?;
        match self.names.get(name) {
            Some(Meaning::Term(t)) if self.sort_of(t) == sort => Ok(t),
            Some(_) => Err(Trouble::syntax(at, format!("{} is not of that sort", shown(name)))),
            None => Err(Trouble::unsupported(at, shown(name))),
        }
    }

    /// Ends what has begun last.
    fn end(&mut self, stack: &mut Stack<'t>, at: usize) -> Result<(), Trouble> {
        let Some(Frame { at: began, start, kind }) = stack.frames.pop() else {
            return Err(Trouble::syntax(at, "a term is missing"));
        };
        let parts = stack.terms.len() - start;
        let missing = || Trouble::syntax(at, "a term is missing");
        match kind {
            Kind::Application(head) => {
                let t = match head {
                    Head::Operator(operator) => self.apply(began, operator, &stack.terms[start..])?,
                    Head::Function(function) => self.applied(began, function, &stack.terms[start..])?,
                    Head::Macro(number) => self.expand(began, number, &stack.terms[start..])?,
                };
                self.check_room(began, 0)?;
                stack.terms.truncate(start);
                stack.terms.push(t);
            }
            Kind::Bindings { names, .. } if names.len() != parts => return Err(missing()),
            Kind::Bindings { names, inside: true } => {
                stack.frames.push(Frame { at: began, start, kind: Kind::Bindings { names, inside: false } });
            }
            // All at once: none is in the scope of another.
            Kind::Bindings { names, inside: false } => {
                let scope = self.names.enter();
                names
                    .into_iter()
                    .zip(stack.terms.drain(start..))
                    .for_each(|(name, t)| self.names.bind(name, t));
                stack.frames.push(Frame { at: began, start, kind: Kind::Body(scope) });
            }
            _ if parts != 1 => return Err(missing()),
            Kind::Body(scope) => self.names.leave(scope),
            Kind::Quantified { scope, exists, variables } => {
                self.names.leave(scope);
                let body = self.of_sort(began, stack.terms[start], Sort::Bool)?;
                let terms = self.terms();
                stack.terms[start] =
                    if exists { terms.exists(&variables, body) } else { terms.forall(&variables, body) };
            }
            Kind::Annotated => {}
        }
        Ok(())
    }

    /// A declared function, applied.
    fn applied(&mut self, at: usize, function: Function, args: &[Term]) -> Result<Term, Trouble> {
        let domain = self.terms().domain(function).to_vec();
        if args.len() != domain.len() {
            let (needed, found) = (domain.len(), args.len());
            return Err(Trouble::syntax(at, format!("{needed} arguments are needed here, not {found}")));
        }
        let mut fitting = Vec::with_capacity(args.len());
        for (&sort, &t) in domain.iter().zip(args) {
            fitting.push(self.of_sort(at, t, sort)?);
        }
        Ok(self.terms().apply(function, &fitting))
    }

    /// A piece of what is said of a term. Only names matter.
    fn attribute(&mut self, t: Term, token: Token<'t>) -> Result<(), Trouble> {
        match token {
            Token::Keyword(":named") => {
                let (at, name) = self.name()?;
                self.known(at, name, Meaning::Term(t))
            }
            Token::Open => self.skip(),
            _ => Ok(()),
        }
    }

    /// A symbol or a constant.
    fn atom(&mut self, at: usize, token: Token<'t>) -> Result<Term, Trouble> {
        let large = |text| Trouble::unsupported(at, format!("the constant {}", shown(text)));
        match token {
            Token::Quoted(name) => self.symbol(at, name),
            Token::Word(name) => match self.names.get(name) {
                None if name == "true" => Ok(Term::TRUE),
                None if name == "false" => Ok(Term::FALSE),
                _ => self.symbol(at, name),
            },
            Token::Number(digits) => {
                let value = decimal(digits).ok_or_else(|| large(digits))?;
                Ok(self.terms().constant(value))
            }
            Token::Hex(digits) => {
                let bits = u128::from_str_radix(digits, 16).map_err(|_| large(digits))?;
                self.vector(at, bits, digits.len() * 4)
            }
            Token::Binary(digits) => {
                let bits = u128::from_str_radix(digits, 2).map_err(|_| large(digits))?;
                self.vector(at, bits, digits.len())
            }
            Token::Text => Err(Trouble::unsupported(at, "a string")),
            _ => Err(Trouble::syntax(at, "a term is missing")),
        }
    }

    fn symbol(&self, at: usize, name: &str) -> Result<Term, Trouble> {
        match self.names.get(name) {
            Some(Meaning::Term(t)) => Ok(t),
            Some(Meaning::Macro(_) | Meaning::Function(_)) => {
                Err(Trouble::syntax(at, format!("{} takes arguments", shown(name))))
            }
            None => Err(Trouble::unsupported(at, format!("{}, which is not declared,", shown(name)))),
        }
    }

    fn vector(&mut self, at: usize, bits: u128, width: usize) -> Result<Term, Trouble> {
        if !(1..=128).contains(&width) {
            return Err(Trouble::unsupported(at, "a bit-vector without bits, or with more than 128"));
        }
        let value = vector(width, bits);
        let value = value.ok_or_else(|| Trouble::syntax(at, format!("{bits} has more than {width} bits")))?;
        Ok(self.terms().constant(value))
    }
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}
