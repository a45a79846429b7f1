//! The type of an expression that was typed before.

use super::typed::{EnumType, Typed};
use crate::expr::{Expr, Leaf, Type, Value};
use crate::system::System;

/// `read` with the type of `e`, an expression over the state of `system`. It is only compared for equality from here on:
/// its bounds do not matter.
pub(super) fn retyped<L>(system: &System, e: &Expr<Leaf>, read: Expr<L>) -> Typed<L> {
    Typed::of_type(read, &type_of(system, e))
}

/// The type, as far as it matters; an enumeration without values where only a constant is left.
fn type_of(system: &System, e: &Expr<Leaf>) -> Type {
    match e {
        Expr::Leaf(Leaf::Var(id)) => match &system.vars[*id].ty {
            Type::Range { .. } => Type::Int,
            ty => ty.clone(),
        },
        Expr::Const(Value::Int(_)) | Expr::Mul(..) | Expr::Div(..) | Expr::Mod(..) => Type::Int,
        Expr::Const(Value::Real(_)) | Expr::Scale(..) | Expr::ToReal(_) => Type::Real,
        // All summands are of one type.
        Expr::Add(es) => es.first().map_or(Type::Int, |e| type_of(system, e)),
        Expr::Const(Value::Enum(_)) => Type::Enum(EnumType::default()),
        Expr::If(_, a, b) => match type_of(system, a) {
            Type::Enum(values) if values.is_empty() => type_of(system, b),
            known => known,
        },
        Expr::Const(Value::Bool(_))
        | Expr::Leaf(Leaf::Label(_))
        | Expr::Not(_)
        | Expr::And(_)
        | Expr::Or(_)
        | Expr::Iff(..)
        | Expr::Compare(..)
        | Expr::Member(..) => Type::Bool,
    }
}
