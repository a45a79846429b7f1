//! What SMV models and formulas of other tools consist of, as written.

use hyperplan_syntax::Span;
use hyperplan_syntax::ast::{BinaryOp, Ident, UnaryOp};

/// An expression or formula with its place.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Expr {
    pub(crate) kind: Kind,
    pub(crate) span: Span,
    /// Of the tree.
    pub(crate) height: u32,
    /// Whether it speaks of the state after a step.
    pub(crate) reads_next: bool,
}

impl Expr {
    pub(crate) fn new(kind: Kind, span: Span) -> Expr {
        let (mut height, mut reads_next) = (0, matches!(kind, Kind::Next(_)));
        kind.for_each_child(&mut |child| {
            height = height.max(child.height);
            reads_next |= child.reads_next;
        });
        Expr { kind, span, height: height + 1, reads_next }
    }
}

impl Kind {
    /// Calls a function with each direct part, those in names too.
    pub(crate) fn for_each_child<'e>(&'e self, each: &mut dyn FnMut(&'e Expr)) {
        match self {
            Kind::Bool(_) | Kind::Int(_) | Kind::Word(..) => {}
            Kind::Name(name) => name.access.iter().for_each(|access| access.for_each_part(each)),
            Kind::Next(a) | Kind::At(a, _) | Kind::Not(a) | Kind::Neg(a) | Kind::Unary(_, _, a) => each(a),
            Kind::And(es) | Kind::Or(es) | Kind::Union(es) | Kind::Set(es) | Kind::Call(_, es) => {
                es.iter().for_each(each);
            }
            Kind::Sum(es) => es.iter().for_each(|(_, e)| each(e)),
            Kind::Infix(_, a, b) | Kind::Range(a, b) | Kind::Binary(_, _, a, b) => {
                each(a);
                each(b);
            }
            Kind::Case(branches, last) => {
                for (condition, value) in branches {
                    each(condition);
                    each(value);
                }
                last.iter().for_each(|last| each(last));
            }
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Kind {
    Bool(bool),
    Int(i64),
    /// `0ud8_255`
    Word(Word, i64),
    Name(Name),
    /// `next(E)`
    Next(Box<Expr>),
    /// `E[A]`, `{E}_A`: what E reads is read of that path.
    At(Box<Expr>, Ident),
    Not(Box<Expr>),
    Neg(Box<Expr>),
    /// At least two.
    And(Vec<Expr>),
    /// At least two.
    Or(Vec<Expr>),
    /// `E union E`, at least two.
    Union(Vec<Expr>),
    /// Each operand with whether it is subtracted; at least two.
    Sum(Vec<(bool, Expr)>),
    Infix(Infix, Box<Expr>, Box<Expr>),
    /// Conditions with their values, at least one, and the value where none holds; without, it is that of the last condition.
    Case(Vec<(Expr, Expr)>, Option<Box<Expr>>),
    Set(Vec<Expr>),
    Range(Box<Expr>, Box<Expr>),
    Call(Ident, Vec<Expr>),
    Unary(UnaryOp, Bounds, Box<Expr>),
    Binary(BinaryOp, Bounds, Box<Expr>, Box<Expr>),
}

/// The interval of a temporal operator, where it has one.
pub(crate) type Bounds = Option<(u32, u32)>;

/// A word type: whether it has a sign, and its width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Word {
    pub(crate) signed: bool,
    pub(crate) width: u32,
}

impl Word {
    /// Least and greatest number that it stands for.
    pub(crate) fn bounds(self) -> (i64, i64) {
        if self.signed {
            (-(1 << (self.width - 1)), (1 << (self.width - 1)) - 1)
        } else {
            (0, (1 << self.width) - 1)
        }
    }
}

/// `a.b[1].c[7:0]`
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Name {
    pub(crate) base: String,
    pub(crate) access: Vec<Access>,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Access {
    Dot(String),
    Index(Expr),
    Bits(Expr, Expr),
}

impl Access {
    fn for_each_part<'e>(&'e self, each: &mut dyn FnMut(&'e Expr)) {
        match self {
            Access::Dot(_) => {}
            Access::Index(at) => each(at),
            Access::Bits(high, low) => {
                each(high);
                each(low);
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Infix {
    Implies,
    Iff,
    Xor,
    Eq,
    Ne,
    Lt,
    Le,
    Gt,
    Ge,
    In,
    Mul,
    Div,
    Mod,
    ShiftLeft,
    ShiftRight,
    Concat,
}

/// The parts of a `MODULE`.
#[derive(Clone, Debug)]
pub(crate) struct Module {
    pub(crate) name: Ident,
    pub(crate) params: Vec<Ident>,
    pub(crate) items: Vec<Item>,
}

#[derive(Clone, Debug)]
pub(crate) enum Item {
    Var(Role, Ident, Type),
    Define(Ident, Expr),
    Constants(Vec<Ident>),
    /// `init(x) := E`, `next(x) := E` or `x := E`.
    Assign(Moment, Expr, Expr),
    Init(Expr),
    Trans(Expr),
    Invar(Expr),
}

/// What kind of variable it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    State,
    Input,
    Frozen,
}

/// Of which state an assignment speaks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Moment {
    First,
    Next,
    Every,
}

#[derive(Clone, Debug)]
pub(crate) struct Type {
    pub(crate) kind: TypeKind,
    pub(crate) span: Span,
}

#[derive(Clone, Debug)]
pub(crate) enum TypeKind {
    Bool,
    Range(Expr, Expr),
    Values(Vec<Expr>),
    Word(bool, Expr),
    Array(Expr, Expr, Box<Type>),
    Instance(Ident, Vec<Expr>),
}

/// A formula of another tool: its quantifiers and what they say.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Formula {
    /// Whether universal, and the path.
    pub(crate) quantifiers: Vec<(bool, Ident)>,
    pub(crate) body: Expr,
}
