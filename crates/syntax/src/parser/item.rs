//! Top-level declarations, quantifiers and the bodies of objectives.

use super::recover::{Block, ITEMS, TOP};
use super::{Abort, Parse, Parser, habit};
use crate::ast::{
    Const, Define, Expr, File, Formula, Ident, Item, Objective, ObjectiveBody, Quantifier, Template,
};
use crate::diagnostic::Diagnostic;
use crate::operator::Operator;
use crate::similar::similar;
use crate::span::Span;
use crate::token::{EQUALS, Tok, Token};

/// The word before what is to be as small as possible.
pub(super) const MINIMIZE: &str = "minimize";

impl Parser<'_> {
    pub(super) fn file(&mut self) -> File {
        let mut items = Vec::new();
        while self.peek() != Tok::Eof {
            if let Some(Some(item)) = self.member(Block::File, Self::item) {
                items.push(item);
            }
        }
        File { items, ..File::default() }
    }

    /// A declaration; `None` where its braces are sound but what is inside is not.
    fn item(&mut self) -> Parse<Option<Item>> {
        let expected = "`const`, `system`, `template`, `define` or `objective`";
        let Some(word) = self.keyword(TOP) else {
            let token = self.token();
            let help = match token.tok {
                Tok::Semi if self.at > 0 => Some("no `;` follows a `}`".to_owned()),
                Tok::Ident if ITEMS.contains(&token.text) => {
                    Some(format!("`{}` stands inside a system", token.text))
                }
                Tok::Ident if self.peek_at(1) == Tok::Assign => {
                    Some(format!("a constant is declared as `const {} = ...;`", token.text))
                }
                _ => None,
            };
            if let Some((advice, foreign)) = habit::instead_of_declaration(token.tok, token.text) {
                let failed = self.fail_with(expected, Some(advice.to_owned()));
                // The whole text is of another language: one message is enough.
                while foreign && self.peek() != Tok::Eof && !self.at_member(Block::File) {
                    self.bump();
                }
                if foreign {
                    self.skipped_from(token.span);
                    return Ok(None);
                }
                return failed;
            }
            return self.fail_with(expected, help);
        };
        match word {
            "const" => self.constant().map(|item| Some(Item::Const(item))),
            "system" => self.system().map(|item| Some(Item::System(item))),
            "template" => Ok(self.template()?.map(Item::Template)),
            "define" => self.define(Block::File).map(|item| Some(Item::Define(item))),
            _ => Ok(self.objective()?.map(Item::Objective)),
        }
    }

    /// Which of `words` the present token is, or is meant to be: a name after an unknown word shows
    /// that it is a misspelt keyword. The token is not consumed.
    pub(super) fn keyword<'w>(&mut self, words: &[&'w str]) -> Option<&'w str> {
        let token = self.token();
        if token.tok != Tok::Ident {
            return None;
        }
        if let Some(word) = words.iter().find(|word| **word == token.text) {
            return Some(word);
        }
        if !matches!(self.peek_at(1), Tok::Ident | Tok::Char) {
            return None;
        }
        let word = similar(token.text, words.iter().copied())?;
        self.misspelt(token, word);
        Some(word)
    }

    /// Reports a misspelt keyword.
    pub(super) fn misspelt(&mut self, token: Token<'_>, word: &str) {
        let error =
            Diagnostic::error("misspelt-keyword", token.span, format!("unknown keyword `{}`", token.text));
        self.report(error.with_help(format!("did you mean `{word}`?")));
    }

    /// The sign `=` of a declaration.
    pub(super) fn equals(&mut self) -> Parse<()> {
        let token = self.token();
        if matches!(token.tok, EQUALS | Tok::ColonEq | Tok::Colon) {
            self.bump();
            self.wrong(token.span, format!("`{}` does not define a name", token.text), "write `=`");
            return Ok(());
        }
        self.expect(Tok::Assign, "`=`").map(|_| ())
    }

    fn constant(&mut self) -> Parse<Const> {
        self.bump();
        let name = self.name("the name of a constant")?;
        self.equals()?;
        let value = self.expr()?;
        self.semicolon(Block::File, "the constant", "an operator or `;`")?;
        Ok(Const { name, value })
    }

    fn define(&mut self, block: Block) -> Parse<Define> {
        self.bump();
        let name = self.name("the name of the definition")?;
        let params = self.parenthesized_names("a path variable")?;
        self.equals()?;
        let body = self.expr()?;
        self.semicolon(block, "the definition", "an operator or `;`")?;
        Ok(Define { name, params, body })
    }

    fn template(&mut self) -> Parse<Option<Template>> {
        let doc = comment_above(self.text, self.bump().span);
        let name = self.any_word("the name of the template")?;
        let params = self.parenthesized_names("a parameter")?;
        let formula = self.formula()?;
        Ok(formula.map(|formula| Template { name, params, formula, doc }))
    }

    fn objective(&mut self) -> Parse<Option<Objective>> {
        self.bump();
        let name = self.any_word("the name of the objective")?;
        let mut within = None;
        let mut semantics = None;
        if self.eat_word("within").is_some() {
            within = Some(self.arithmetic()?);
        }
        if let Some(word) = self.eat_word("semantics") {
            semantics = Some(self.name("`pes`, `opt`, `hpes` or `hopt`")?);
            if within.is_none() {
                let error = Diagnostic::error("syntax", word.span, "`semantics` needs a bound before it");
                self.report(error.with_help("write `within K semantics S`"));
            }
        }
        let body = if self.peek() == Tok::LBrace {
            self.formula()?.map(ObjectiveBody::Formula)
        } else {
            Some(self.instance(within.is_some())?)
        };
        Ok(body.map(|body| Objective { name, within, semantics, body }))
    }

    /// `= TEMPLATE(args);`
    fn instance(&mut self, bounded: bool) -> Parse<ObjectiveBody> {
        if self.peek() != Tok::Assign {
            let expected = if bounded { "`semantics`, `{` or `=`" } else { "`within`, `{` or `=`" };
            let help = "a formula stands in braces: `objective NAME { exists p. ... }`";
            return self.fail_with(expected, Some(help.to_owned()));
        }
        self.bump();
        let template = self.any_word("the name of a template")?;
        self.expect(Tok::LParen, "`(`")?;
        let mut args = Vec::new();
        if self.eat(Tok::RParen).is_none() {
            args = self.separated(Self::expr)?;
            self.expect(Tok::RParen, "`,` or `)`")?;
        }
        self.semicolon(Block::File, "the objective", "`;`")?;
        Ok(ObjectiveBody::Instance { template, args })
    }

    /// `{ DEFINES QUANTIFIERS BODY }`; `None` if the inside is at fault.
    fn formula(&mut self) -> Parse<Option<Formula>> {
        let open = self.expect(Tok::LBrace, "`{`")?;
        let mut defines = Vec::new();
        while self.at_member(Block::Defines) {
            defines.extend(self.member(Block::Defines, |parser| parser.define(Block::Defines)));
        }
        let inside = self.member(Block::Formula, |parser| {
            let quantifiers = parser.quantifiers()?;
            let body = parser.expr()?;
            let minimize = parser.minimize()?;
            parser.end_of_formula()?;
            Ok((quantifiers, body, minimize))
        });
        if inside.is_some() {
            self.close_block(open, "an operator or `}`");
        } else {
            let _ = self.eat(Tok::RBrace);
        }
        Ok(inside.map(|(quantifiers, body, minimize)| Formula { defines, quantifiers, body, minimize }))
    }

    /// `minimize EXPR, ...;` behind a formula, if it is there.
    fn minimize(&mut self) -> Parse<Vec<Expr>> {
        if self.eat_word(MINIMIZE).is_none() {
            return Ok(Vec::new());
        }
        let all = self.separated(Self::expr)?;
        if self.eat(Tok::Semi).is_none() {
            return self.fail("an operator, `,` or `;`");
        }
        Ok(all)
    }

    fn end_of_formula(&mut self) -> Parse<()> {
        if let Some(semi) = self.eat(Tok::Semi) {
            let error = Diagnostic::error("syntax", semi.span, "a formula does not end with `;`");
            self.report(error.with_help("remove the `;`"));
        }
        if self.at_word("define") {
            let help = "definitions stand before the quantifiers";
            return self.fail_with("an operator or `}`", Some(help.to_owned()));
        }
        if self.block_ends(Block::Formula) {
            return Ok(());
        }
        match self.peek() {
            Tok::Exists | Tok::Forall => self.fail_with(
                "an operator or `}`",
                Some("quantifiers stand in front of the whole formula: `exists p. forall q. ...`".to_owned()),
            ),
            _ => {
                let help = self.instead_of_operator().map(str::to_owned);
                self.fail_with("an operator or `}`", help)
            }
        }
    }

    fn quantifiers(&mut self) -> Parse<Vec<Quantifier>> {
        let mut quantifiers = Vec::new();
        while let Some(forall) = self.quantifier_word() {
            let mut unsorted: Vec<Ident> = Vec::new();
            let mut add = |paths: &mut Vec<Ident>, system: Option<&Ident>| {
                quantifiers.extend(paths.drain(..).map(|path| Quantifier {
                    forall,
                    path,
                    system: system.cloned(),
                }));
            };
            loop {
                unsorted.push(self.name("a path variable")?);
                if self.eat(Tok::Colon).is_some() {
                    let system = self.any_word("the name of a system")?;
                    add(&mut unsorted, Some(&system));
                }
                if self.peek() == Tok::Ident && matches!(self.peek_at(1), Tok::Dot | Tok::Comma | Tok::Colon)
                {
                    let message = "expected `,` between path variables";
                    let error = Diagnostic::error("missing-comma", self.behind(), message);
                    self.report(error.with_label("`,` missing here"));
                    continue;
                }
                if self.peek() != Tok::Comma || matches!(self.peek_at(1), Tok::Exists | Tok::Forall) {
                    break;
                }
                self.bump();
            }
            add(&mut unsorted, None);
            self.quantifier_dot()?;
        }
        Ok(quantifiers)
    }

    /// `exists` or `forall`, or what is meant to be; whether it is `forall`.
    fn quantifier_word(&mut self) -> Option<bool> {
        let token = self.token();
        let forall = match token.tok {
            Tok::Exists => false,
            Tok::Forall => true,
            Tok::Ident => {
                let path = self.peek_at(1) == Tok::Ident;
                if !path || !matches!(self.peek_at(2), Tok::Dot | Tok::Comma | Tok::Colon) {
                    return None;
                }
                let word = match token.text {
                    "E" => "exists",
                    "A" => "forall",
                    text => similar(text, ["exists", "forall"].into_iter())?,
                };
                self.misspelt(token, word);
                word == "forall"
            }
            _ => return None,
        };
        self.bump();
        Some(forall)
    }

    /// The `.` after quantified paths. Where it is missing but the formula goes on, it is only reported.
    fn quantifier_dot(&mut self) -> Parse<()> {
        if self.eat(Tok::Dot).is_some() {
            return Ok(());
        }
        let token = self.token();
        let help = "write `exists p.`, `forall q, r.` or `forall q: System.`";
        if matches!(token.tok, Tok::Comma | Tok::Colon | Tok::Semi) {
            self.bump();
            let message = format!("expected `.`, found `{}`", token.text);
            self.report(Diagnostic::error("missing-dot", token.span, message).with_help(help));
            return Ok(());
        }
        let goes_on = token.is_word()
            || matches!(token.tok, Tok::LParen | Tok::Exists | Tok::Forall)
            || matches!(token.tok, Tok::Op(Operator::Not | Operator::Unary(_)));
        if !goes_on {
            return self.fail_with("`.` after the path variables", Some(help.to_owned()));
        }
        let error = Diagnostic::error("missing-dot", self.behind(), "expected `.` after the path variables");
        self.report(error.with_label("`.` missing here").with_help(help));
        Ok(())
    }

    /// A declaration inside a system where it does not belong.
    pub(super) fn misplaced(&mut self) -> Parse<()> {
        let token = self.token();
        let message = format!("`{}` cannot stand inside a system", token.text);
        self.report(
            Diagnostic::error("syntax", token.span, message).with_help("move it in front of the system"),
        );
        Err(Abort)
    }
}

/// The comment lines directly above `place`, without their slashes.
fn comment_above(text: &str, place: Span) -> String {
    let above = text.get(..place.start as usize).unwrap_or("");
    let Some(line_start) = above.rfind('\n') else { return String::new() };
    if !above[line_start..].trim().is_empty() {
        return String::new();
    }
    let mut lines: Vec<&str> = above[..line_start]
        .rsplit('\n')
        .map_while(|line| line.trim_start().strip_prefix("//"))
        .map(|line| line.strip_prefix(' ').unwrap_or(line).trim_end())
        .collect();
    lines.reverse();
    lines.join("\n")
}
