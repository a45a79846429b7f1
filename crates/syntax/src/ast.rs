//! The syntax tree of a problem file, as written: no name is resolved here.
//!
//! State expressions and formulas share one expression type; which of its forms make sense
//! where is decided when names are resolved (`hyperplan-problem`). Chains of `&`, `|` and `+`/`-`
//! are flat lists, so that long ones cost no stack.

mod map_item;

pub use map_item::{Area, MapItem};

use crate::span::Span;

/// A name and its place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ident {
    /// The name.
    pub name: String,
    /// Its place.
    pub span: Span,
}

/// A quoted string and its place (quotes included); the text has its escapes resolved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Text {
    /// The contents.
    pub text: String,
    /// The place, with the quotes.
    pub span: Span,
}

/// A whole problem file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct File {
    /// Declarations in the order of the file.
    pub items: Vec<Item>,
    /// Declarations that could not be parsed, and so are missing above; empty for a file without errors.
    pub skipped: Vec<Span>,
}

/// A top-level declaration.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// `const NAME = EXPR;`
    Const(Const),
    /// `system NAME { ... }` and its map and graph forms.
    System(System),
    /// `template NAME(params) { QUANTIFIERS BODY }`
    Template(Template),
    /// `define NAME(p, ...) = BODY;` outside an objective.
    Define(Define),
    /// `objective NAME ... { ... }` or `objective NAME = template(...);`
    Objective(Objective),
}

/// `const NAME = EXPR;`
#[derive(Clone, Debug, PartialEq)]
pub struct Const {
    /// The constant.
    pub name: Ident,
    /// Its value.
    pub value: Expr,
}

/// `system NAME ...`
#[derive(Clone, Debug, PartialEq)]
pub struct System {
    /// The system.
    pub name: Ident,
    /// Where its state space comes from.
    pub kind: SystemKind,
    /// What stands between the braces.
    pub items: Vec<SystemItem>,
    /// `system NAME ...` up to the opening brace.
    pub span: Span,
}

/// Where a system's state space comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum SystemKind {
    /// `system NAME { ... }`
    Plain,
    /// `system NAME = grid { "..." "..." items }`: the rows, top row first.
    GridRows(Vec<Text>),
    /// `system NAME = grid("file") { ... }`
    GridFile(Text),
    /// `system NAME = graph("file.json") { ... }`
    Graph(Text),
}

/// An item of a system.
#[derive(Clone, Debug, PartialEq)]
pub enum SystemItem {
    /// `state x: 0..2, y: bool;`
    State(Vec<StateDecl>),
    /// `action left, right;`
    Action(Vec<Ident>),
    /// `on A || B when GUARD { UPDATES }`
    On(Clause),
    /// `also on A || B when GUARD { UPDATES }`
    Also(Clause),
    /// `init EXPR;`
    Init(Expr),
    /// `label NAME = EXPR;`
    Label(Ident, Expr),
    /// `cost NAME = EXPR;`
    Cost(Ident, Expr),
    /// `observe EXPR, ...;`
    Observe(Vec<Expr>),
    /// `absorb EXPR;`
    Absorb(Expr),
    /// `trans EXPR;`, over the states before and after a step
    Trans(Expr),
    /// `moves up, down, ...;` (maps only)
    Moves(Vec<Ident>),
    /// `obstacle undefined|stay|crash;` (maps only)
    Obstacle(Ident),
    /// `edge undefined|stay|crash;` (maps only)
    Edge(Ident),
    /// `corner free|undefined|stay|crash;` (maps only)
    Corner(Ident),
    /// `legend 'W' = water;` or `legend 'W' = #;` (maps only)
    Legend {
        /// The letter, or of a picture the colour as `#rrggbb`; its span has the quotes.
        letter: Text,
        /// The label that it carries, or `None` for an obstacle (`#`).
        label: Option<Ident>,
        /// The whole item.
        span: Span,
    },
    /// How the cells come about (maps only)
    Map {
        /// What is said.
        item: Box<MapItem>,
        /// The whole item.
        span: Span,
    },
}

/// `x: TYPE`
#[derive(Clone, Debug, PartialEq)]
pub struct StateDecl {
    /// The variable.
    pub name: Ident,
    /// Its type.
    pub ty: Type,
    /// The place of the type.
    pub ty_span: Span,
}

/// The type of a state variable.
#[derive(Clone, Debug, PartialEq)]
pub enum Type {
    /// `bool`
    Bool,
    /// `LO..HI`, both ends included
    Range(Expr, Expr),
    /// `{a, b, c}`
    Enum(Vec<Ident>),
    /// `int`
    Int,
    /// `real`
    Real,
    /// `action`: one of the system's actions
    Action,
}

/// `on ACTIONS when GUARD { UPDATES }`, perhaps behind `also`
#[derive(Clone, Debug, PartialEq)]
pub struct Clause {
    /// The actions, or `None` for `*`.
    pub actions: Option<Vec<Ident>>,
    /// The guard, if any.
    pub guard: Option<Expr>,
    /// The updates.
    pub updates: Vec<Update>,
    /// `on ACTIONS when GUARD`, with the `also`.
    pub span: Span,
}

/// `v' = E;`, `v' in {E, ...};` or `v' in LO..HI;`
#[derive(Clone, Debug, PartialEq)]
pub struct Update {
    /// The variable (its span covers the prime too).
    pub var: Ident,
    /// What becomes of it.
    pub value: UpdateValue,
}

/// The right-hand side of an update.
#[derive(Clone, Debug, PartialEq)]
pub enum UpdateValue {
    /// `v' = E;`
    Assign(Expr),
    /// `v' in SET;`
    Choose(Set),
}

/// `template NAME(params) { QUANTIFIERS BODY }`
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    /// The template.
    pub name: Ident,
    /// Its parameters: labels or numbers, told apart by use.
    pub params: Vec<Ident>,
    /// What stands between the braces.
    pub formula: Formula,
    /// Comment lines (`//`) that stand directly above the template, without the slashes.
    pub doc: String,
}

/// `define NAME(p, ...) = BODY;`
#[derive(Clone, Debug, PartialEq)]
pub struct Define {
    /// The definition.
    pub name: Ident,
    /// Its path parameters.
    pub params: Vec<Ident>,
    /// What it stands for.
    pub body: Expr,
}

/// `objective NAME [within K [semantics S]] ...`
#[derive(Clone, Debug, PartialEq)]
pub struct Objective {
    /// The objective.
    pub name: Ident,
    /// `within K`.
    pub within: Option<Expr>,
    /// `semantics S`.
    pub semantics: Option<Ident>,
    /// The formula, or the template that gives it.
    pub body: ObjectiveBody,
}

/// What an objective says.
#[derive(Clone, Debug, PartialEq)]
pub enum ObjectiveBody {
    /// `{ QUANTIFIERS BODY }`
    Formula(Formula),
    /// `= TEMPLATE(args);`
    Instance {
        /// The template.
        template: Ident,
        /// Its arguments.
        args: Vec<Expr>,
    },
}

/// `DEFINES QUANTIFIERS BODY [minimize EXPR, ...;]`
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    /// Definitions.
    pub defines: Vec<Define>,
    /// Quantifiers, outermost first, one entry a path variable.
    pub quantifiers: Vec<Quantifier>,
    /// The quantifier-free rest.
    pub body: Expr,
    /// What is to be as small as possible, what counts most first.
    pub minimize: Vec<Expr>,
}

/// One quantified path variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantifier {
    /// `forall` rather than `exists`.
    pub forall: bool,
    /// The path variable.
    pub path: Ident,
    /// `: SYSTEM`.
    pub system: Option<Ident>,
}

/// An expression or formula with its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Expr {
    /// What it is.
    pub kind: ExprKind,
    /// Where it stands (without surrounding parentheses).
    pub span: Span,
}

/// The forms of an expression.
#[derive(Clone, Debug, PartialEq)]
pub enum ExprKind {
    /// `true`, `false`
    Bool(bool),
    /// A number as written: digits, with a fraction part for reals (`0.5`).
    Number(String),
    /// A constant, variable, label, enumeration value, action, or parameter.
    Name(String),
    /// `"NAME"`: an enumeration value or action, whatever its name
    Text(String),
    /// `NAME'`: a variable or label after the step, in `trans`.
    Primed(String),
    /// `NAME[PATH]`: a label or variable of a path, `action[p]`, `state[p]`, `obs[p]`, `enabled[p]`.
    /// More than one path is kept for the message that refuses it.
    At(Ident, Vec<Ident>),
    /// `cost NAME[PATH]`: what the steps of a path have cost.
    Cost(Ident, Vec<Ident>),
    /// `NAME(ARGS)`: a use of a `define`.
    Call(Ident, Vec<Ident>),
    /// `!E`
    Not(Box<Expr>),
    /// `-E`
    Neg(Box<Expr>),
    /// `E & E & ...`, at least two
    And(Vec<Expr>),
    /// `E | E | ...`, at least two
    Or(Vec<Expr>),
    /// `E -> E`
    Implies(Box<Expr>, Box<Expr>),
    /// `E <-> E`
    Iff(Box<Expr>, Box<Expr>),
    /// `== != < <= > >=`
    Compare(CompareOp, Box<Expr>, Box<Expr>),
    /// `E + E - E ...`: each operand but the first with its sign (`true` for minus); at least two
    Sum(Vec<(bool, Expr)>),
    /// `* / div %`
    Arith(ArithOp, Box<Expr>, Box<Expr>),
    /// `E in SET`
    In(Box<Expr>, Set),
    /// `(E, E, ...)`, at least two
    Tuple(Vec<Expr>),
    /// `if C then A else if D then B else E`: each condition with its value, at least one, and the value where none
    /// holds. A chain is flat, however long it is: the last value is never an `if` itself.
    If(Vec<(Expr, Expr)>, Box<Expr>),
    /// `X N F G`
    Unary(UnaryOp, Option<Interval>, Box<Expr>),
    /// `U R W M`
    Binary(BinaryOp, Option<Interval>, Box<Expr>, Box<Expr>),
}

/// What stands to the right of `in`.
#[derive(Clone, Debug, PartialEq)]
pub enum Set {
    /// `{E, ...}`
    List(Vec<Expr>, Span),
    /// `LO..HI`
    Range(Box<Expr>, Box<Expr>),
    /// `enabled[p]`
    Enabled(Ident, Span),
    /// `if C then SET else if D then SET else SET`, flat as [`ExprKind::If`] is; to the right of an update's `in` only.
    If(Vec<(Expr, Set)>, Box<Set>, Span),
}

/// Comparison operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CompareOp {
    /// `==`
    Eq,
    /// `!=`
    Ne,
    /// `<`
    Lt,
    /// `<=`
    Le,
    /// `>`
    Gt,
    /// `>=`
    Ge,
}

/// Multiplicative operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ArithOp {
    /// `*`
    Mul,
    /// `/`
    Divide,
    /// `div`
    Div,
    /// `%`
    Mod,
}

/// Unary temporal operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum UnaryOp {
    /// `X`, strong next
    Next,
    /// `N`, weak next
    WeakNext,
    /// `F`
    Finally,
    /// `G`
    Globally,
}

/// Binary temporal operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum BinaryOp {
    /// `U`
    Until,
    /// `R`
    Release,
    /// `W`
    WeakUntil,
    /// `M`
    StrongRelease,
}

/// `[a,b]`, or `[b]` for `[0,b]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Interval {
    /// First step; `None` where only the upper bound is written.
    pub lo: Option<Box<Expr>>,
    /// Last step.
    pub hi: Box<Expr>,
    /// With the brackets.
    pub span: Span,
}
