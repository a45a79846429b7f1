//! What names stand for: variables, definitions, parameters of modules, parts of instances, elements of arrays.

use super::model::{Model, ScopeId, Symbol};
use crate::tree::{Access, Expr, Kind, Name};

/// Parameters that stand for parameters, one after the other.
const MAX_PARAMS: u32 = 100;

/// What a name stands for.
#[derive(Debug)]
pub(crate) enum Meaning<'m, 't> {
    /// A declaration, by its full name.
    Symbol(&'m str, &'m Symbol<'t>),
    /// What was given for a parameter, read where it was given.
    Argument(ScopeId, &'t Expr),
    /// An element of an array whose number is no constant: the array's full name, the scope of the index, and the rest of
    /// what is read.
    Element(String, usize),
    /// The bits of a word.
    Bits(&'m str, &'m Symbol<'t>),
    /// A symbolic constant.
    Constant,
}

impl<'t> Model<'t> {
    /// The declaration that a plain name stands for.
    pub(crate) fn symbol(&self, scope: ScopeId, e: &Expr) -> Option<(&str, &Symbol<'t>)> {
        let Kind::Name(name) = &e.kind else { return None };
        match self.meaning(scope, name)? {
            Meaning::Symbol(name, symbol) => Some((name, symbol)),
            Meaning::Argument(scope, e) => self.symbol(scope, e),
            _ => None,
        }
    }

    /// What a name stands for in an instance; `None` if nothing.
    pub(crate) fn meaning<'m>(&'m self, scope: ScopeId, name: &Name) -> Option<Meaning<'m, 't>> {
        self.meaning_from(scope, &name.base, &name.access, 0)
    }

    fn meaning_from<'m>(
        &'m self,
        scope: ScopeId,
        base: &str,
        access: &[Access],
        depth: u32,
    ) -> Option<Meaning<'m, 't>> {
        let inside = &self.scopes[scope.0];
        if base == "self" {
            return match access.split_first() {
                Some((Access::Dot(next), rest)) => self.meaning_from(scope, next, rest, depth + 1),
                _ => None,
            };
        }
        if let Some(&(outer, argument)) = inside.params.get(base) {
            let Kind::Name(given) = &argument.kind else {
                return access.is_empty().then_some(Meaning::Argument(outer, argument));
            };
            if access.is_empty() {
                return Some(Meaning::Argument(outer, argument));
            }
            if depth >= MAX_PARAMS {
                return None;
            }
            let all: Vec<Access> = given.access.iter().chain(access).cloned().collect();
            return self.meaning_from(outer, &given.base, &all, depth + 1);
        }
        let mut full = format!("{}{base}", inside.prefix);
        for (at, next) in access.iter().enumerate() {
            // In an instance its parameters can be read as well.
            if let (Some(Symbol::Instance(scope, _)), Access::Dot(part)) = (self.symbols.get(&full), next) {
                return self.meaning_from(*scope, part, &access[at + 1..], depth + 1);
            }
            match next {
                Access::Dot(part) => {
                    full.push('.');
                    full += part;
                }
                Access::Index(index) => match self.number(scope, index) {
                    Ok(number) => full += &format!("[{number}]"),
                    Err(_) => {
                        let array = matches!(self.symbols.get(&full), Some(Symbol::Array(..)));
                        return array.then_some(Meaning::Element(full, at));
                    }
                },
                Access::Bits(..) => {
                    let (name, symbol) = self.symbols.get_key_value(&full)?;
                    return (at + 1 == access.len()).then_some(Meaning::Bits(name, symbol));
                }
            }
        }
        if let Some((name, symbol)) = self.symbols.get_key_value(&full) {
            return Some(Meaning::Symbol(name, symbol));
        }
        (access.is_empty() && self.constants.contains_key(base)).then_some(Meaning::Constant)
    }
}
