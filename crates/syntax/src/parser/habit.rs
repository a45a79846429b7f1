//! What users of other tools and languages write out of habit, and how it is written here.

use super::{Parse, Parser};
use crate::ast::{ArithOp, CompareOp};
use crate::operator::Operator;
use crate::token::Tok;

const SYSTEM: &str = "a system is written `system S { state x: 0..3; action a; on a { x' = x + 1; } }`";
const STATE: &str = "state variables are declared as `state x: 0..3, b: bool;`";
const STEP: &str = "transitions are written `on ACTION when GUARD { x' = x + 1; }`";
const COMMENT: &str = "a comment begins with `//`";

/// Advice for what stands where a declaration should, and whether what follows is of the same kind and best skipped.
pub(super) fn instead_of_declaration(tok: Tok, text: &str) -> Option<(&'static str, bool)> {
    Some(match (tok, text) {
        (Tok::Hash | Tok::Op(Operator::Minus | Operator::Arith(ArithOp::Mod)), _) => (COMMENT, false),
        (Tok::Exists | Tok::Forall, _) => {
            ("a formula stands in an objective: `objective NAME { exists p. ... }`", true)
        }
        (_, "Forall" | "Exists" | "LTLSPEC" | "CTLSPEC" | "INVARSPEC" | "SPEC") => {
            ("a formula stands in an objective: `objective NAME { exists p. ... }`", true)
        }
        (_, "MODULE" | "VAR" | "IVAR" | "FROZENVAR" | "ASSIGN" | "INIT" | "TRANS" | "INVAR" | "DEFINE") => {
            (SYSTEM, true)
        }
        (_, "let" | "int" | "real" | "param" | "constant") => ("write `const NAME = VALUE;`", false),
        (_, "var") => (STATE, false),
        _ => return None,
    })
}

/// Advice for what stands where an item of a system should.
pub(super) fn instead_of_item(tok: Tok, text: &str) -> Option<&'static str> {
    Some(match (tok, text) {
        (Tok::Hash | Tok::Op(Operator::Minus | Operator::Arith(ArithOp::Mod)), _) => COMMENT,
        (_, "VAR" | "var" | "bool" | "boolean" | "int" | "real" | "variable" | "let") => STATE,
        (_, "ASSIGN" | "TRANS" | "next" | "transition" | "when") => STEP,
        (_, "INIT" | "initial") => "initial states are written `init x == 0;`",
        (_, "DEFINE") => "labels are written `label NAME = x == 0;`",
        _ => return None,
    })
}

impl Parser<'_> {
    /// Advice for the token behind a complete expression.
    pub(super) fn instead_of_operator(&self) -> Option<&'static str> {
        let before = self.tokens[self.at.saturating_sub(1)];
        Some(match self.peek() {
            Tok::Prime => {
                "only `trans` and the left side of an update have primes; in a formula `X` reads the next step"
            }
            Tok::Dot if self.token_at(1).is_word() => "what is read of a path is written `goal[p]`",
            Tok::ColonEq => "conditions compare by `==`: `init x == 0;`",
            Tok::Colon if before.text == "case" => "write `if C then A else B`",
            _ if before.text == "case" && !self.token().first_on_line => "write `if C then A else B`",
            _ => return None,
        })
    }

    /// Explains `F{0,T} a`, `F<=T a` and the like, where the operator was just read.
    pub(super) fn check_interval_brackets(&mut self) -> Parse<()> {
        let op = self.tokens[self.at - 1].text;
        let help = format!("an interval is written `{op}[0,T]`");
        match self.peek() {
            Tok::LBrace | Tok::Op(Operator::Compare(CompareOp::Le | CompareOp::Lt)) => {
                self.fail_with("`[` or a formula", Some(help))
            }
            _ => Ok(()),
        }
    }
}
