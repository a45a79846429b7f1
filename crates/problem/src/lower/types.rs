//! The type of an expression that was typed before.

use super::typed::{EnumType, Typed};
use crate::expr::{Expr, Leaf, Type, Value};
use crate::system::System;

/// `read` with the type of `e`, an expression over the state of `system`.
pub(super) fn retyped<L>(system: &System, e: &Expr<Leaf>, read: Expr<L>) -> Typed<L> {
    match kind(system, e) {
        Kind::Bool => Typed::Bool(read),
        // Only compared for equality from here on: its bounds do not matter.
        Kind::Int => Typed::Int(read, None),
        Kind::Real => Typed::Real(read),
        Kind::Enum(values) => Typed::Enum(read, values.unwrap_or_default()),
    }
}

enum Kind {
    Bool,
    Int,
    Real,
    /// `None` where only a constant is left.
    Enum(Option<EnumType>),
}

fn kind(system: &System, e: &Expr<Leaf>) -> Kind {
    match e {
        Expr::Leaf(Leaf::Var(id)) => match &system.vars[*id].ty {
            Type::Bool => Kind::Bool,
            Type::Range { .. } | Type::Int => Kind::Int,
            Type::Enum(values) => Kind::Enum(Some(values.clone())),
            Type::Real => Kind::Real,
        },
        Expr::Const(Value::Int(_)) | Expr::Mul(..) | Expr::Div(..) | Expr::Mod(..) => Kind::Int,
        Expr::Const(Value::Real(_)) | Expr::Scale(..) | Expr::ToReal(_) => Kind::Real,
        // All summands are of one type.
        Expr::Add(es) => es.first().map_or(Kind::Int, |e| kind(system, e)),
        Expr::Const(Value::Enum(_)) => Kind::Enum(None),
        Expr::If(_, a, b) => match kind(system, a) {
            Kind::Enum(None) => kind(system, b),
            known => known,
        },
        Expr::Const(Value::Bool(_))
        | Expr::Leaf(Leaf::Label(_))
        | Expr::Not(_)
        | Expr::And(_)
        | Expr::Or(_)
        | Expr::Iff(..)
        | Expr::Compare(..)
        | Expr::Member(..) => Kind::Bool,
    }
}
