//! Random syntax trees, with every form that the parser can give; places are all zero.

use hyperplan_random::Random;
use hyperplan_syntax::ast::{
    Area, ArithOp, BinaryOp, Clause, CompareOp, Const, Define, Expr, ExprKind, File, Formula, Ident,
    Interval, Item, MapItem, Objective, ObjectiveBody, Quantifier, Set, StateDecl, System, SystemItem,
    SystemKind, Template, Text, Type, UnaryOp, Update, UpdateValue,
};
use hyperplan_syntax::{SourceId, Span};

const NOWHERE: Span = Span { source: SourceId(0), start: 0, end: 0 };

/// Names, some of which mean something elsewhere in the language, or in others.
const NAMES: &[&str] = &[
    "a",
    "b",
    "goal",
    "x",
    "y",
    "start",
    "a_rather_long_name_of_a_label",
    "state",
    "label",
    "on",
    "init",
    "define",
    "const",
    "system",
    "bool",
    "int",
    "enabled",
    "action",
    "not",
    "and",
    "mod",
    "until",
    "always",
    "semantics",
    "within",
    "when",
    "GF",
    "F_T",
    "E",
    "M",
    "step",
];

fn ident(random: &mut Random) -> Ident {
    Ident { name: random.one(NAMES).to_owned(), span: NOWHERE }
}

fn idents(random: &mut Random, least: usize) -> Vec<Ident> {
    (0..least + random.below(4)).map(|_| ident(random)).collect()
}

/// A file of a few declarations.
pub fn file(random: &mut Random) -> File {
    let items = (0..1 + random.below(4)).map(|_| item(random)).collect();
    File { items, ..File::default() }
}

fn item(random: &mut Random) -> Item {
    match random.below(5) {
        0 => Item::Const(Const { name: ident(random), value: expr(random, 4) }),
        1 => Item::System(system(random)),
        2 => Item::Template(Template {
            name: ident(random),
            params: idents(random, 0),
            formula: formula(random, 5),
            doc: random.one(&["", "One line.", "Several\n\n  lines."]).to_owned(),
        }),
        3 => Item::Define(define(random)),
        _ => Item::Objective(objective(random)),
    }
}

fn define(random: &mut Random) -> Define {
    Define { name: ident(random), params: idents(random, 0), body: expr(random, 4) }
}

fn defines(random: &mut Random) -> Vec<Define> {
    (0..random.below(5).saturating_sub(2)).map(|_| define(random)).collect()
}

fn quantifiers(random: &mut Random) -> Vec<Quantifier> {
    let one = |random: &mut Random| Quantifier {
        forall: random.flip(),
        path: ident(random),
        system: random.flip().then(|| ident(random)),
    };
    (0..random.below(5)).map(|_| one(random)).collect()
}

fn formula(random: &mut Random, depth: u32) -> Formula {
    let (defines, quantifiers, body) = (defines(random), quantifiers(random), expr(random, depth));
    let wishes = if random.below(4) == 0 { 1 + random.below(2) } else { 0 };
    let minimize = (0..wishes).map(|_| expr(random, 2)).collect();
    Formula { defines, quantifiers, body, minimize }
}

fn objective(random: &mut Random) -> Objective {
    let within = random.flip().then(|| expr(random, 3));
    let semantics = if within.is_some() && random.flip() { Some(ident(random)) } else { None };
    let body = if random.below(4) == 0 {
        let args = (0..random.below(4)).map(|_| expr(random, 2)).collect();
        ObjectiveBody::Instance { template: ident(random), args }
    } else {
        ObjectiveBody::Formula(formula(random, 6))
    };
    Objective { name: ident(random), within, semantics, body }
}

fn text(random: &mut Random) -> Text {
    Text { text: random.one(&["..G", "S#.", "a \"b\" \\ c", "", "// no comment"]).to_owned(), span: NOWHERE }
}

fn system(random: &mut Random) -> System {
    let kind = match random.below(5) {
        0 => SystemKind::GridRows((0..1 + random.below(3)).map(|_| text(random)).collect()),
        1 => SystemKind::GridFile(text(random)),
        2 => SystemKind::Graph(text(random)),
        _ => SystemKind::Plain,
    };
    let items = (0..random.below(6)).map(|_| system_item(random)).collect();
    System { name: ident(random), kind, items, span: NOWHERE }
}

fn system_item(random: &mut Random) -> SystemItem {
    match random.below(19) {
        0 => SystemItem::State((0..1 + random.below(3)).map(|_| state(random)).collect()),
        1 => SystemItem::Action(idents(random, 1)),
        2 => SystemItem::On(clause(random)),
        3 => SystemItem::Init(expr(random, 4)),
        4 => SystemItem::Label(ident(random), expr(random, 4)),
        5 => SystemItem::Observe((0..1 + random.below(3)).map(|_| expr(random, 2)).collect()),
        6 => SystemItem::Absorb(expr(random, 3)),
        7 => SystemItem::Moves(idents(random, 1)),
        8 => SystemItem::Obstacle(ident(random)),
        9 => SystemItem::Edge(ident(random)),
        10..=14 => SystemItem::Map { item: Box::new(map_item(random)), span: NOWHERE },
        15 => SystemItem::Also(clause(random)),
        16 => SystemItem::Cost(ident(random), expr(random, 3)),
        17 => SystemItem::Trans(constraint(random)),
        _ => SystemItem::Legend {
            letter: Text {
                text: random.one(&["W", "é", " ", "\"", "#", "#0000ff", "#00Ff0080"]).to_owned(),
                span: NOWHERE,
            },
            label: random.flip().then(|| ident(random)),
            span: NOWHERE,
        },
    }
}

fn map_item(random: &mut Random) -> MapItem {
    match random.below(6) {
        5 => MapItem::Clearance { name: ident(random), most: expr(random, 2) },
        0 => MapItem::Scenario { file: text(random), row: expr(random, 2) },
        1 => MapItem::Unknown(ident(random)),
        // Before a word, some names are read as operators.
        2 if random.flip() => {
            let by = Expr { kind: ExprKind::Number("0.5".to_owned()), span: NOWHERE };
            MapItem::Inflate { by, metres: Some(NOWHERE) }
        }
        2 => MapItem::Inflate { by: expr(random, 2), metres: None },
        3 => MapItem::Scale(expr(random, 2)),
        _ => MapItem::Crop(Box::new(Area {
            x: (expr(random, 2), expr(random, 2)),
            y: (expr(random, 2), expr(random, 2)),
        })),
    }
}

fn state(random: &mut Random) -> StateDecl {
    let ty = match random.below(7) {
        6 => Type::Action,
        0 => Type::Bool,
        1 => Type::Int,
        2 => Type::Real,
        3 => Type::Enum(idents(random, 1)),
        _ => Type::Range(expr(random, 2), expr(random, 2)),
    };
    StateDecl { name: ident(random), ty, ty_span: NOWHERE }
}

fn clause(random: &mut Random) -> Clause {
    let update = |random: &mut Random| Update {
        var: ident(random),
        value: if random.flip() {
            UpdateValue::Assign(expr(random, 3))
        } else {
            UpdateValue::Choose(choice(random, 3))
        },
    };
    Clause {
        actions: random.flip().then(|| idents(random, 1)),
        guard: random.flip().then(|| expr(random, 4)),
        updates: (0..random.below(4)).map(|_| update(random)).collect(),
        span: NOWHERE,
    }
}

/// What `trans` says: with primes.
fn constraint(random: &mut Random) -> Expr {
    let primed = Box::new(Expr { kind: ExprKind::Primed(ident(random).name), span: NOWHERE });
    let kind = ExprKind::Compare(compare(random), Box::new(expr(random, 2)), primed);
    Expr { kind, span: NOWHERE }
}

/// An expression of at most so many levels.
fn expr(random: &mut Random, depth: u32) -> Expr {
    Expr { kind: if depth == 0 { leaf(random) } else { kind(random, depth - 1) }, span: NOWHERE }
}

fn leaf(random: &mut Random) -> ExprKind {
    match random.below(8) {
        0 => ExprKind::Bool(random.flip()),
        1 => ExprKind::Number(random.one(&["0", "12", "0.5"]).to_owned()),
        2 => ExprKind::At(ident(random), idents(random, 1)),
        3 => ExprKind::Call(ident(random), idents(random, 0)),
        6 => ExprKind::Cost(ident(random), idents(random, 1)),
        4 => ExprKind::Text(random.one(&["room A", "17", "say \"hi\"", "back\\slash"]).to_owned()),
        5 => ExprKind::Name(random.one(&["proc.line", "queue[0][12]", "a.b[1].c"]).to_owned()),
        _ => ExprKind::Name(ident(random).name),
    }
}

fn kind(random: &mut Random, depth: u32) -> ExprKind {
    let mut sub = || Box::new(expr(random, depth));
    let (a, b) = (sub(), sub());
    match random.below(16) {
        0 | 1 => leaf(random),
        2 => ExprKind::Not(a),
        3 => ExprKind::Neg(a),
        4 => ExprKind::And(several(random, depth)),
        5 => ExprKind::Or(several(random, depth)),
        6 => ExprKind::Implies(a, b),
        7 => ExprKind::Iff(a, b),
        8 => ExprKind::Compare(compare(random), a, b),
        9 => {
            let mut operands = several(random, depth).into_iter();
            let first = operands.next().map(|first| (false, first));
            ExprKind::Sum(first.into_iter().chain(operands.map(|e| (random.flip(), e))).collect())
        }
        10 => ExprKind::Arith(arith(random), a, b),
        11 => ExprKind::In(a, set(random, depth)),
        12 => ExprKind::Tuple(several(random, depth)),
        13 => conditional(random, depth),
        14 => temporal(random, depth, a),
        _ => ExprKind::Binary(binary(random), interval(random, depth), a, b),
    }
}

/// A chain whose last value is none itself.
fn conditional(random: &mut Random, depth: u32) -> ExprKind {
    let branches = (0..1 + random.below(3)).map(|_| (expr(random, depth), expr(random, depth))).collect();
    let mut last = expr(random, depth);
    while let ExprKind::If(_, end) = last.kind {
        last = *end;
    }
    ExprKind::If(branches, Box::new(last))
}

fn binary(random: &mut Random) -> BinaryOp {
    use BinaryOp::{Release, StrongRelease, Until, WeakUntil};
    [Until, Release, WeakUntil, StrongRelease][random.below(4)]
}

fn temporal(random: &mut Random, depth: u32, a: Box<Expr>) -> ExprKind {
    match random.below(4) {
        0 => ExprKind::Unary(UnaryOp::Next, None, a),
        1 => ExprKind::Unary(UnaryOp::WeakNext, None, a),
        2 => ExprKind::Unary(UnaryOp::Finally, interval(random, depth), a),
        _ => ExprKind::Unary(UnaryOp::Globally, interval(random, depth), a),
    }
}

fn several(random: &mut Random, depth: u32) -> Vec<Expr> {
    (0..2 + random.below(3)).map(|_| expr(random, depth)).collect()
}

/// What an update chooses from.
fn choice(random: &mut Random, depth: u32) -> Set {
    if depth == 0 || random.flip() {
        return match set(random, depth) {
            // It is parsed as a set, and is none that an update can have.
            Set::Enabled(..) => Set::List(vec![expr(random, depth)], NOWHERE),
            set => set,
        };
    }
    let branches = (0..1 + random.below(3)).map(|_| (expr(random, depth), choice(random, depth - 1)));
    let branches = branches.collect();
    let mut last = choice(random, depth - 1);
    while let Set::If(_, end, _) = last {
        last = *end;
    }
    Set::If(branches, Box::new(last), NOWHERE)
}

fn set(random: &mut Random, depth: u32) -> Set {
    match random.below(4) {
        0 => Set::Enabled(ident(random), NOWHERE),
        1 => Set::Range(Box::new(expr(random, depth.min(2))), Box::new(expr(random, depth.min(2)))),
        _ => Set::List((0..1 + random.below(4)).map(|_| expr(random, depth.min(2))).collect(), NOWHERE),
    }
}

fn interval(random: &mut Random, depth: u32) -> Option<Interval> {
    let depth = depth.min(2);
    random.flip().then(|| Interval {
        lo: random.flip().then(|| Box::new(expr(random, depth))),
        hi: Box::new(expr(random, depth)),
        span: NOWHERE,
    })
}

fn compare(random: &mut Random) -> CompareOp {
    use CompareOp::{Eq, Ge, Gt, Le, Lt, Ne};
    [Eq, Ne, Lt, Le, Gt, Ge][random.below(6)]
}

fn arith(random: &mut Random) -> ArithOp {
    [ArithOp::Mul, ArithOp::Divide, ArithOp::Div, ArithOp::Mod][random.below(4)]
}
