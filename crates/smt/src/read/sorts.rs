//! Sorts, and small pieces of syntax.

use super::Reader;
use super::{Trouble, shown};
use crate::lexer::{Context, Token};
use crate::name::is_reserved;
use crate::term::Sort;

impl<'t> Reader<'t> {
    /// The next token, which there has to be.
    pub(super) fn token(&mut self) -> Result<(usize, Token<'t>), Trouble> {
        let end = self.tokens.text().len();
        self.next()?.ok_or_else(|| Trouble::syntax(end, "the text ends inside of a command"))
    }

    /// The next token, with the place where it begins; `None` at the end.
    pub(super) fn next(&mut self) -> Result<Option<(usize, Token<'t>)>, Trouble> {
        let Some((place, token)) = self.tokens.next() else { return Ok(None) };
        let what = match token {
            Token::Strange(text) => format!("{} is no symbol and no constant", shown(text)),
            Token::Endless(Context::Text) => "a string has no end".to_owned(),
            Token::Endless(_) => "a quoted symbol has no end".to_owned(),
            token => return Ok(Some((place.start, token))),
        };
        Err(Trouble::syntax(place.start, what))
    }

    pub(super) fn open(&mut self) -> Result<usize, Trouble> {
        match self.token()? {
            (at, Token::Open) => Ok(at),
            (at, _) => Err(Trouble::syntax(at, "( is missing")),
        }
    }

    pub(super) fn close(&mut self) -> Result<(), Trouble> {
        match self.token()? {
            (_, Token::Close) => Ok(()),
            (at, _) => Err(Trouble::syntax(at, ") is missing")),
        }
    }

    /// Whether another element of a list begins, in parentheses of its own; the list ends otherwise.
    pub(super) fn another(&mut self) -> Result<bool, Trouble> {
        match self.token()? {
            (_, Token::Open) => Ok(true),
            (_, Token::Close) => Ok(false),
            (at, _) => Err(Trouble::syntax(at, "( or ) is missing")),
        }
    }

    /// A symbol that is no reserved word.
    pub(super) fn name(&mut self) -> Result<(usize, &'t str), Trouble> {
        let (at, token) = self.token()?;
        match token {
            Token::Quoted(name) => Ok((at, name)),
            Token::Word(name) if !is_reserved(name) => Ok((at, name)),
            _ => Err(Trouble::syntax(at, "a symbol is missing")),
        }
    }

    /// An index of an indexed identifier, or the width of a sort.
    pub(super) fn index(&mut self) -> Result<u32, Trouble> {
        match self.token()? {
            (at, Token::Number(digits)) => {
                digits.parse().map_err(|_| Trouble::unsupported(at, shown(digits)))
            }
            (at, _) => Err(Trouble::syntax(at, "a number is missing")),
        }
    }

    /// A sort.
    pub(super) fn sort(&mut self) -> Result<Sort, Trouble> {
        let (at, token) = self.token()?;
        self.sort_from(at, token)
    }

    /// Sorts in parentheses.
    pub(super) fn domain(&mut self) -> Result<Vec<Sort>, Trouble> {
        self.open()?;
        let mut sorts = Vec::new();
        loop {
            match self.token()? {
                (_, Token::Close) => return Ok(sorts),
                (at, token) => sorts.push(self.sort_from(at, token)?),
            }
        }
    }

    /// A sort, by its first token.
    fn sort_from(&mut self, at: usize, token: Token<'t>) -> Result<Sort, Trouble> {
        match token {
            Token::Open => self.sort_of_width(at),
            Token::Word(name) | Token::Quoted(name) => match self.sorts.get(name) {
                Some(&sort) => Ok(sort),
                None => Err(Trouble::unsupported(at, format!("sort {}", shown(name)))),
            },
            _ => Err(Trouble::syntax(at, "a sort is missing")),
        }
    }

    /// `(_ BitVec n)`, once it is begun.
    fn sort_of_width(&mut self, at: usize) -> Result<Sort, Trouble> {
        let name = match self.token()? {
            (_, Token::Word("_")) => self.name()?.1,
            (_, Token::Word(name) | Token::Quoted(name)) => {
                return Err(Trouble::unsupported(at, format!("sort {}", shown(name))));
            }
            (at, _) => return Err(Trouble::syntax(at, "a sort is missing")),
        };
        if name != "BitVec" {
            return Err(Trouble::unsupported(at, format!("sort {}", shown(name))));
        }
        let width = self.index()?;
        self.close()?;
        if !(1..=128).contains(&width) {
            return Err(Trouble::unsupported(at, format!("a bit-vector of {width} bits")));
        }
        Ok(Sort::BitVec(width))
    }

    /// Passes over everything up to the parenthesis that closes what is open.
    pub(super) fn skip(&mut self) -> Result<(), Trouble> {
        let mut depth = 1_usize;
        while depth > 0 {
            match self.token()?.1 {
                Token::Open => depth += 1,
                Token::Close => depth -= 1,
                _ => {}
            }
        }
        Ok(())
    }
}
