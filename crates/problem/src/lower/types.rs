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
        Expr::Leaf(leaf) => match system.leaf_type(*leaf) {
            Type::Range { .. } => Type::Int,
            ty => ty.clone(),
        },
        Expr::Const(Value::Int(_)) | Expr::Mul(..) | Expr::Div(..) | Expr::Mod(..) => Type::Int,
        Expr::Const(Value::Real(_)) | Expr::Scale(..) | Expr::ToReal(_) => Type::Real,
        // All summands are of one type.
        Expr::Add(es) => es.first().map_or(Type::Int, |e| type_of(system, e)),
        Expr::Const(Value::Enum(_)) => Type::Enum(EnumType::default()),
        Expr::If(branches, last) => {
            let mut types = branches.iter().map(|(_, value)| type_of(system, value));
            let open = |ty: &Type| matches!(ty, Type::Enum(values) if values.is_empty());
            types.find(|ty| !open(ty)).unwrap_or_else(|| type_of(system, last))
        }
        Expr::Const(Value::Bool(_))
        | Expr::Not(_)
        | Expr::And(_)
        | Expr::Or(_)
        | Expr::Iff(..)
        | Expr::Compare(..)
        | Expr::Member(..) => Type::Bool,
    }
}
