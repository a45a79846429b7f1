//! Systems: their maps, variables, actions and clauses.

use super::recover::{Block, ITEMS};
use super::{Abort, Parse, Parser, did_you_mean, habit};
use crate::ast::{
    ArithOp, Clause, Expr, Ident, StateDecl, System, SystemItem, SystemKind, Text, Type, Update, UpdateValue,
};
use crate::diagnostic::Diagnostic;
use crate::operator::Operator;
use crate::span::Span;
use crate::token::{EQUALS, Tok};

impl Parser<'_> {
    pub(super) fn system(&mut self) -> Parse<System> {
        let start = self.bump().span;
        let name = self.any_word("the name of the system")?;
        let mut items = Vec::new();
        if self.peek() == Tok::LBrace {
            let span = self.since(start);
            self.items(&mut items)?;
            return Ok(System { name, kind: SystemKind::Plain, items, span });
        }
        if self.eat(Tok::Assign).is_none() {
            return self.fail("`{` or `=`");
        }
        let kind = self.system_kind(&mut items)?;
        let span = self.since(start);
        if self.peek() == Tok::LBrace {
            self.items(&mut items)?;
        } else if matches!(kind, SystemKind::GridRows(_)) {
            // After a `}`, the `;` is a matter of taste.
            let _ = self.eat(Tok::Semi);
        } else {
            self.semicolon(Block::File, "the file name", "`{` or `;`")?;
        }
        Ok(System { name, kind, items, span })
    }

    /// `grid("file")`, `grid { rows items }` or `graph("file")`.
    fn system_kind(&mut self, items: &mut Vec<SystemItem>) -> Parse<SystemKind> {
        let token = self.token();
        let word = match token.text {
            "grid" | "graph" => token.text,
            text if token.tok == Tok::Ident => {
                let help = did_you_mean(text, &["grid", "graph"]);
                return self.fail_with("`grid` or `graph`", help);
            }
            _ => return self.fail("`grid` or `graph`"),
        };
        self.bump();
        if word == "grid" && self.peek() == Tok::LBrace {
            return Ok(SystemKind::GridRows(self.rows(items)?));
        }
        self.expect(Tok::LParen, if word == "grid" { "`(` or `{`" } else { "`(`" })?;
        let file = self.string("a file name in quotes")?;
        self.expect(Tok::RParen, "`)`")?;
        Ok(if word == "grid" { SystemKind::GridFile(file) } else { SystemKind::Graph(file) })
    }

    /// `{ "..." "..." items }`, the rows from the top.
    fn rows(&mut self, items: &mut Vec<SystemItem>) -> Parse<Vec<Text>> {
        let open = self.bump();
        let mut rows = Vec::new();
        while self.peek() == Tok::Str {
            rows.push(self.string("a row of the map")?);
            if let Some(comma) = self.eat(Tok::Comma) {
                let error =
                    Diagnostic::error("syntax", comma.span, "no comma stands between the rows of a map");
                self.report(error.with_help("remove the `,`"));
            }
        }
        if rows.is_empty() {
            return self.fail("a row of the map in quotes");
        }
        self.item_list(items);
        self.close_block(open, "another row, an item or `}`");
        Ok(rows)
    }

    fn items(&mut self, items: &mut Vec<SystemItem>) -> Parse<()> {
        let open = self.expect(Tok::LBrace, "`{`")?;
        self.item_list(items);
        self.close_block(open, "an item or `}`");
        Ok(())
    }

    fn item_list(&mut self, items: &mut Vec<SystemItem>) {
        while !self.block_ends(Block::System) {
            items.extend(self.member(Block::System, Self::system_item).flatten());
        }
    }

    fn system_item(&mut self) -> Parse<Option<SystemItem>> {
        let start = self.token();
        if matches!(start.text, "define" | "const" | "objective" | "template") && self.at_member(Block::File)
        {
            self.misplaced()?;
        }
        let foreign = habit::instead_of_item(start.tok, start.text).is_some();
        let Some(word) = Some(()).filter(|()| !foreign).and_then(|()| self.keyword(ITEMS)) else {
            let help = match start.tok {
                Tok::Semi if self.at > 0 => Some("no `;` follows a `}`".to_owned()),
                Tok::Str => Some("the rows of a map stand before its items".to_owned()),
                tok => habit::instead_of_item(tok, start.text)
                    .map(str::to_owned)
                    .or_else(|| did_you_mean(start.text, ITEMS).filter(|_| tok == Tok::Ident)),
            };
            let expected = "an item of the system (`state`, `action`, `on`, `init`, `label`, ...)";
            return self.fail_with(expected, help);
        };
        self.bump();
        let item = match word {
            "on" => return self.clause(start.span).map(|clause| Some(SystemItem::On(clause))),
            "also" => {
                if self.eat_word("on").is_none() {
                    let help = "what moves do besides is written `also on a | b { x' = x + 1; }`";
                    return self.fail_with("`on`", Some(help.to_owned()));
                }
                return self.clause(start.span).map(|clause| Some(SystemItem::Also(clause)));
            }
            "state" => SystemItem::State(self.separated(Self::state_decl)?),
            "action" => SystemItem::Action(self.names("the name of an action")?),
            "moves" => SystemItem::Moves(self.names("a move")?),
            "obstacle" => SystemItem::Obstacle(self.name("`undefined`, `stay` or `crash`")?),
            "edge" => SystemItem::Edge(self.name("`undefined`, `stay` or `crash`")?),
            "corner" => SystemItem::Corner(self.name("`free`, `undefined`, `stay` or `crash`")?),
            "init" => SystemItem::Init(self.expr()?),
            "absorb" => SystemItem::Absorb(self.expr()?),
            "trans" => {
                self.primes = true;
                let constraint = self.expr();
                self.primes = false;
                SystemItem::Trans(constraint?)
            }
            "observe" => SystemItem::Observe(self.separated(Self::expr)?),
            "label" => {
                let name = self.name("the name of a label")?;
                self.equals()?;
                SystemItem::Label(name, self.expr()?)
            }
            "cost" => {
                let name = self.name("the name of a cost")?;
                self.equals()?;
                SystemItem::Cost(name, self.expr()?)
            }
            "scenario" | "unknown" | "inflate" | "scale" | "crop" | "clearance" => {
                let (item, expected) = self.map_item(word)?;
                let span = self.since(start.span);
                self.semicolon(Block::System, &format!("`{word}`"), expected)?;
                return Ok(Some(SystemItem::Map { item: Box::new(item), span }));
            }
            _ => {
                let (letter, label) = self.legend()?;
                SystemItem::Legend { letter, label, span: self.since(start.span) }
            }
        };
        let expected = match item {
            SystemItem::Obstacle(_)
            | SystemItem::Edge(_)
            | SystemItem::Corner(_)
            | SystemItem::Legend { .. } => "`;`",
            SystemItem::Action(_) | SystemItem::Moves(_) | SystemItem::State(_) => "`,` or `;`",
            _ => "an operator or `;`",
        };
        self.semicolon(Block::System, &format!("`{word}`"), expected)?;
        Ok(Some(item))
    }

    fn legend(&mut self) -> Parse<(Text, Option<Ident>)> {
        let token = self.token();
        if token.tok != Tok::Char {
            let help = match token.text.starts_with('"') {
                true => "write `legend 'W' = water;`, and of a picture `legend '#0000ff' = water;`",
                false => "write `legend 'W' = water;`, or `legend 'W' = #;` for an obstacle",
            };
            return self.fail_with("a letter in quotes", Some(help.to_owned()));
        }
        self.bump();
        let letter = Text { text: token.text.trim_matches('\'').to_owned(), span: token.span };
        self.equals()?;
        if self.eat(Tok::Hash).is_some() {
            return Ok((letter, None));
        }
        Ok((letter, Some(self.name("a label or `#`")?)))
    }

    fn state_decl(&mut self) -> Parse<StateDecl> {
        let name = self.name("the name of a state variable")?;
        self.expect(Tok::Colon, "`:` and a type")?;
        let start = self.token().span;
        let ty = self.state_type()?;
        Ok(StateDecl { name, ty, ty_span: self.since(start) })
    }

    fn state_type(&mut self) -> Parse<Type> {
        let token = self.token();
        let alone = matches!(self.peek_at(1), Tok::Comma | Tok::Semi | Tok::RBrace | Tok::Eof);
        let known = match token.text {
            "bool" => Some(Type::Bool),
            "int" => Some(Type::Int),
            "real" => Some(Type::Real),
            "action" => Some(Type::Action),
            _ => None,
        };
        let begins_range = matches!(self.peek_at(1), Tok::DotDot | Tok::LBracket | Tok::LParen)
            || self.token_at(1).infix().is_some();
        if matches!(token.text, "int" | "integer") && self.peek_at(1) == Tok::Number {
            self.wrong(token.span, "a range has no word before it", "write `LO..HI` alone: `x: 0..2`");
            self.bump();
        } else if let Some(known) = known.filter(|_| !begins_range) {
            self.bump();
            return Ok(known);
        }
        if token.tok == Tok::Ident && alone {
            let meant = match token.text.to_ascii_lowercase().as_str() {
                "boolean" => Some("did you mean `bool`?".to_owned()),
                "integer" | "nat" => Some("did you mean `int`?".to_owned()),
                "float" | "double" => Some("did you mean `real`?".to_owned()),
                _ => did_you_mean(token.text, &["bool", "int", "real", "action"]),
            };
            let help = meant.unwrap_or_else(|| {
                "types are `bool`, `LO..HI`, `{a, b}`, `int`, `real` and `action`".to_owned()
            });
            let error =
                Diagnostic::error("unknown-type", token.span, format!("unknown type `{}`", token.text));
            self.report(error.with_help(help));
            return Err(Abort);
        }
        if self.eat(Tok::LBrace).is_some() {
            if self.peek() == Tok::Number {
                let help = "a range of integers is written `0..2`, without braces";
                return self.fail_with("the name of a value", Some(help.to_owned()));
            }
            let values = self.separated(|parser| parser.action("the name of a value"))?;
            self.expect(Tok::RBrace, "`,` or `}`")?;
            return Ok(Type::Enum(values));
        }
        if token.tok == Tok::LBracket {
            return self.fail_with("a type", Some("a range of integers is written `0..2`".to_owned()));
        }
        let lo = self.arithmetic()?;
        self.expect(Tok::DotDot, "`..` and the upper end of the range")?;
        if self.peek() == Tok::Dot {
            return self.fail_with("the upper end of the range", Some("write `0..2`".to_owned()));
        }
        Ok(Type::Range(lo, self.arithmetic()?))
    }

    /// `on A | B when GUARD { UPDATES }`, behind the `on`.
    fn clause(&mut self, start: Span) -> Parse<Clause> {
        let actions = if self.eat(Tok::Op(Operator::Arith(ArithOp::Mul))).is_some() {
            None
        } else {
            Some(self.clause_actions()?)
        };
        let guard = self.guard()?;
        let span = self.since(start);
        let expected = if guard.is_some() { "an operator or `{`" } else { "`|`, `when` or `{`" };
        let open = self.expect(Tok::LBrace, expected)?;
        let mut updates = Vec::new();
        while !self.block_ends(Block::Updates) {
            updates.extend(self.member(Block::Updates, Self::update));
        }
        self.close_block(open, "an update or `}`");
        Ok(Clause { actions, guard, updates, span })
    }

    fn clause_actions(&mut self) -> Parse<Vec<Ident>> {
        let mut actions = vec![self.action("the name of an action or `*`")?];
        loop {
            let token = self.token();
            match token.tok {
                Tok::Op(Operator::Or) => {
                    self.bump();
                }
                Tok::Foreign | Tok::Comma if matches!(token.text, "||" | ",") => {
                    self.bump();
                    self.wrong(
                        token.span,
                        "actions of a clause are separated by `|`",
                        "write `on a | b { ... }`",
                    );
                }
                _ => return Ok(actions),
            }
            actions.push(self.action("the name of an action")?);
        }
    }

    /// The name of an action, in quotes where a graph's action is no word.
    fn action(&mut self, what: &str) -> Parse<Ident> {
        if self.peek() != Tok::Str {
            return self.name(what);
        }
        let quoted = self.string(what)?;
        Ok(Ident { name: quoted.text, span: quoted.span })
    }

    fn guard(&mut self) -> Parse<Option<Expr>> {
        let token = self.token();
        let meant =
            token.tok == Tok::If || token.tok == Tok::Ident && did_you_mean(token.text, &["when"]).is_some();
        if meant {
            self.misspelt(token, "when");
            self.bump();
        } else if self.eat_word("when").is_none() {
            return Ok(None);
        }
        self.expr().map(Some)
    }

    /// `v' = E;`, `v' in {E, ...};` or `v' in LO..HI;`
    fn update(&mut self) -> Parse<Update> {
        if self.peek() == Tok::If {
            let help =
                "a condition stands in front, `on a when C { ... }`, or inside: `x' = if C then A else B;`";
            return self.fail_with("an update such as `x' = x + 1;`", Some(help.to_owned()));
        }
        let mut var = self.name("an update such as `x' = x + 1;`")?;
        if let Some(prime) = self.eat(Tok::Prime) {
            var.span = var.span.to(prime.span);
        } else if matches!(self.peek(), Tok::Assign | Tok::ColonEq | Tok::Op(Operator::In)) {
            let message = format!("expected `'` after `{}`", var.name);
            let help = format!("the next value of `{0}` is written `{0}'`", var.name);
            self.report(Diagnostic::error("missing-prime", var.span, message).with_help(help));
        } else {
            let help = match (self.peek(), self.peek_at(1)) {
                (Tok::LParen, Tok::Ident) if var.name == "next" => {
                    Some(format!("the next value of `{0}` is written `{0}'`", self.token_at(1).text))
                }
                (
                    Tok::Op(Operator::Plus | Operator::Minus),
                    Tok::Assign | Tok::Op(Operator::Plus | Operator::Minus),
                ) => {
                    let sign = self.token().text;
                    Some(format!("write `{0}' = {0} {sign} 1;`", var.name))
                }
                _ => None,
            };
            return self.fail_with("`'` after the variable", help);
        }
        let value = self.update_value()?;
        self.semicolon(Block::Updates, "the update", "an operator or `;`")?;
        Ok(Update { var, value })
    }

    fn update_value(&mut self) -> Parse<UpdateValue> {
        if self.eat(Tok::Op(Operator::In)).is_some() {
            return Ok(UpdateValue::Choose(self.set()?));
        }
        let token = self.token();
        if !matches!(token.tok, Tok::Assign | EQUALS | Tok::ColonEq) {
            return self.fail("`=` or `in`");
        }
        self.bump();
        if token.tok != Tok::Assign {
            self.wrong(token.span, format!("`{}` is not an update", token.text), "write `=`");
        }
        if self.peek() == Tok::LBrace {
            self.wrong(token.span, "a variable is given one value by `=`", "write `in` to choose from a set");
            return Ok(UpdateValue::Choose(self.set()?));
        }
        let value = self.expr()?;
        if self.peek() == Tok::DotDot {
            let help = "write `in` to choose from a range: `x' in 0..2;`";
            return self.fail_with("an operator or `;`", Some(help.to_owned()));
        }
        Ok(UpdateValue::Assign(value))
    }
}
