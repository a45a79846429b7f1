//! Every construct of the language.

mod common;

use common::{good, names, show, show_set};
use hyperplan_syntax::ast::{
    Clause, File, Formula, Item, MapItem, Objective, ObjectiveBody, Quantifier, System, SystemItem,
    SystemKind, Type, UpdateValue,
};

const ROOMS: &str = "
// The rooms.
const T = 6; // of Figure 5

system Rooms {
  state  x: 0..2, y: 0 .. N1 - 1;
  state  b: bool, mode: {idle, busy}, n: int, r: real;
  action left, right, up;
  on left  { x' = x - 1; }
  on right | up when y == 0 & x in {0, 1} { x' in {0, x + 1}; y' in 0..1; }
  on * { }
  init x == 0;
  label start = x == 0 & y == 0;
  observe x, y + 1;
  absorb (b);
}
";

fn system(file: &File, nth: usize) -> &System {
    match &file.items[nth] {
        Item::System(system) => system,
        other => panic!("{other:?}"),
    }
}

fn objective(file: &File, nth: usize) -> &Objective {
    match &file.items[nth] {
        Item::Objective(objective) => objective,
        other => panic!("{other:?}"),
    }
}

fn describe(item: &SystemItem) -> String {
    match item {
        SystemItem::State(decls) => {
            let ty = |ty: &Type| match ty {
                Type::Bool => "bool".to_owned(),
                Type::Int => "int".to_owned(),
                Type::Real => "real".to_owned(),
                Type::Action => "action".to_owned(),
                Type::Range(lo, hi) => format!("{}..{}", show(lo), show(hi)),
                Type::Enum(values) => format!("{{{}}}", names(values)),
            };
            let decls: Vec<String> =
                decls.iter().map(|decl| format!("{}:{}", decl.name.name, ty(&decl.ty))).collect();
            format!("state {}", decls.join(" "))
        }
        SystemItem::Action(actions) => format!("action {}", names(actions)),
        SystemItem::On(clause) => describe_clause(clause),
        SystemItem::Also(clause) => format!("also {}", describe_clause(clause)),
        SystemItem::Init(expr) => format!("init {}", show(expr)),
        SystemItem::Label(name, expr) => format!("label {} {}", name.name, show(expr)),
        SystemItem::Cost(name, expr) => format!("cost {} {}", name.name, show(expr)),
        SystemItem::Observe(exprs) => {
            format!("observe {}", exprs.iter().map(show).collect::<Vec<_>>().join(","))
        }
        SystemItem::Absorb(expr) => format!("absorb {}", show(expr)),
        SystemItem::Trans(expr) => format!("trans {}", show(expr)),
        SystemItem::Moves(moves) => format!("moves {}", names(moves)),
        SystemItem::Obstacle(rule) => format!("obstacle {}", rule.name),
        SystemItem::Edge(rule) => format!("edge {}", rule.name),
        SystemItem::Corner(rule) => format!("corner {}", rule.name),
        SystemItem::Map { item, .. } => format!("{} {}", item.word(), describe_map_item(item)),
        SystemItem::Legend { letter, label, .. } => {
            format!("legend {} {}", letter.text, label.as_ref().map_or("#", |label| &label.name))
        }
    }
}

fn describe_map_item(item: &MapItem) -> String {
    match item {
        MapItem::Scenario { file, row } => format!("{} {}", file.text, show(row)),
        MapItem::Unknown(rule) => rule.name.clone(),
        MapItem::Clearance { name, most } => format!("{} {}", name.name, show(most)),
        MapItem::Inflate { by, metres } => format!("{}{}", show(by), metres.map_or("", |_| " metres")),
        MapItem::Scale(by) => show(by),
        MapItem::Crop(part) => {
            let (x, y) = (&part.x, &part.y);
            format!("{} {} {} {}", show(&x.0), show(&x.1), show(&y.0), show(&y.1))
        }
    }
}

fn describe_clause(clause: &Clause) -> String {
    let actions = clause.actions.as_ref().map_or("*".to_owned(), |actions| names(actions));
    let guard = clause.guard.as_ref().map_or(String::new(), |guard| format!(" when {}", show(guard)));
    let updates = clause.updates.iter().map(|update| match &update.value {
        UpdateValue::Assign(value) => format!(" {}={}", update.var.name, show(value)),
        UpdateValue::Choose(set) => format!(" {} in {}", update.var.name, show_set(set)),
    });
    format!("on {actions}{guard}:{}", updates.collect::<String>())
}

fn items(system: &System) -> Vec<String> {
    system.items.iter().map(describe).collect()
}

#[test]
fn system_items() {
    let file = good(ROOMS);
    let rooms = system(&file, 1);
    assert_eq!(
        items(rooms),
        [
            "state x:0..2 y:0..(+N1 -1)",
            "state b:bool mode:{idle,busy} n:int r:real",
            "action left,right,up",
            "on left: x=(+x -1)",
            "on right,up when ((y == 0) & (x in {0,1})): x in {0,(+x +1)} y in 0..1",
            "on *:",
            "init (x == 0)",
            "label start ((x == 0) & (y == 0))",
            "observe x,(+y +1)",
            "absorb b",
        ]
    );
    assert_eq!(&ROOMS[rooms.span.range()], "system Rooms");
    let SystemItem::On(clause) = &rooms.items[4] else { panic!("no clause") };
    assert_eq!(&ROOMS[clause.span.range()], "on right | up when y == 0 & x in {0, 1}");
    assert_eq!(&ROOMS[clause.updates[0].var.span.range()], "x'");
    let SystemItem::State(decls) = &rooms.items[0] else { panic!("no variables") };
    assert_eq!(&ROOMS[decls[1].ty_span.range()], "0 .. N1 - 1");
}

#[test]
fn grids() {
    let rows = |system: &System| match &system.kind {
        SystemKind::GridRows(rows) => rows.iter().map(|row| row.text.clone()).collect::<Vec<_>>().join("/"),
        SystemKind::GridFile(file) => format!("file {}", file.text),
        SystemKind::Graph(file) => format!("graph {}", file.text),
        SystemKind::Plain => "plain".to_owned(),
    };
    let file = good(
        r#"
        system W = grid { "..G" ".#." "S.." }
        system A = grid { "..G"
                          "S\"\\" moves up, down; edge stay; }
        system B = grid { "G" } { obstacle crash; label at = (x, y) in {(0, 0), (3, 4)}; }
        system C = grid { "G" moves up; } { legend 'W' = water; legend 'é' = #; }
        system D = grid { "G" };
        system E = grid("maps/a.map");
        system F1 = grid("a.map") { edge crash; }
        system G1 = graph("a.json") { label a = node == 1; }
        system H = graph("a.json");
        system I = grid("a.png") {
          legend '#0000ff' = water; scenario "a.scen" ROW; unknown free; inflate (D + 1) / 2 m;
          inflate 2; scale (4); crop 0..C - 1, (1)..9;
        }
        "#,
    );
    let kinds: Vec<String> = (0..9).map(|nth| rows(system(&file, nth))).collect();
    let expected = [
        "..G/.#./S..",
        "..G/S\"\\",
        "G",
        "G",
        "G",
        "file maps/a.map",
        "file a.map",
        "graph a.json",
        "graph a.json",
    ];
    assert_eq!(kinds, expected);
    assert_eq!(items(system(&file, 1)), ["moves up,down", "edge stay"]);
    assert_eq!(items(system(&file, 2)), ["obstacle crash", "label at (<x,y> in {<0,0>,<3,4>})"]);
    assert_eq!(items(system(&file, 3)), ["moves up", "legend W water", "legend é #"]);
    let changes = [
        "legend #0000ff water",
        "scenario a.scen ROW",
        "unknown free",
        "inflate ((+D +1) / 2) metres",
        "inflate 2",
        "scale 4",
        "crop 0 (+C -1) 1 9",
    ];
    assert_eq!(items(system(&file, 9)), changes);
}

fn quantifiers(list: &[Quantifier]) -> String {
    let one = |quantifier: &Quantifier| {
        let sign = if quantifier.forall { 'A' } else { 'E' };
        let system = quantifier.system.as_ref().map_or(String::new(), |system| format!(":{}", system.name));
        format!("{sign}{}{system}", quantifier.path.name)
    };
    list.iter().map(one).collect::<Vec<_>>().join(" ")
}

#[test]
fn objectives() {
    let file = good(
        "objective a { exists p, q: Robot. forall r: W, s, t. exists u. true }
         objective b within 2 * T semantics hpes { forall p. G a[p] }
         objective c within K = t(start, T + 1, 0.5);
         objective d = u();
         objective e { define f(p) = a[p]; define g(p, q) = f(p) & f(q); exists p. f(p) }",
    );
    let ObjectiveBody::Formula(Formula { quantifiers: list, .. }) = &objective(&file, 0).body else {
        panic!("no formula")
    };
    assert_eq!(quantifiers(list), "Ep:Robot Eq:Robot Ar:W As At Eu");
    let bounded = objective(&file, 1);
    assert_eq!(bounded.within.as_ref().map(show).as_deref(), Some("(2 * T)"));
    assert_eq!(bounded.semantics.as_ref().map(|name| name.name.as_str()), Some("hpes"));
    let ObjectiveBody::Instance { template, args } = &objective(&file, 2).body else { panic!("no instance") };
    assert_eq!(template.name, "t");
    assert_eq!(args.iter().map(show).collect::<Vec<_>>(), ["start", "(+T +1)", "0.5"]);
    assert_eq!(objective(&file, 2).within.as_ref().map(show).as_deref(), Some("K"));
    let ObjectiveBody::Formula(Formula { defines, .. }) = &objective(&file, 4).body else {
        panic!("no formula")
    };
    assert_eq!(defines.len(), 2);
    assert_eq!(
        (names(&defines[1].params), show(&defines[1].body)),
        ("p,q".to_owned(), "(f(p) & f(q))".to_owned())
    );
}

#[test]
fn templates_have_their_comments() {
    let file = good(
        "// Not this.

// The shortest path:
//   equation (6).
template shortest(start, goal, T) { // nor this
  define at(p) = goal[p];
  exists p. forall q. F[0,T] at(p)
}
define reach(r) = goal[r];
  // Indented.\r
template t() { true }
template u() { true }",
    );
    let Item::Template(first) = &file.items[0] else { panic!("no template") };
    assert_eq!(first.doc, "The shortest path:\n  equation (6).");
    assert_eq!(names(&first.params), "start,goal,T");
    assert_eq!(quantifiers(&first.formula.quantifiers), "Ep Aq");
    assert_eq!((first.formula.defines.len(), show(&first.formula.body)), (1, "(F[0,T] at(p))".to_owned()));
    assert!(matches!(&file.items[1], Item::Define(define) if define.name.name == "reach"));
    assert!(matches!(&file.items[2], Item::Template(template) if template.doc == "Indented."));
    assert!(matches!(&file.items[3], Item::Template(template) if template.doc.is_empty()));
}

#[test]
fn item_words_may_be_names() {
    good(
        "system S { state init: bool, label: 0..1; on a { init' = true; label' = 0; } label state = init; }",
    );
    good("objective o { exists p.\n init[p] &\n label[p] == 1 &\n state[p] == state[p] }");
}

#[test]
fn empty_files() {
    assert!(good("").items.is_empty());
    assert!(good(" \r\n// nothing").items.is_empty());
    assert!(good("\u{feff}").items.is_empty());
}
