//! Systems and their items.

use super::layout::Indent;
use super::{Printer, end};
use crate::ast::{
    Clause, Expr, Ident, Set, StateDecl, System, SystemItem, SystemKind, Text, Type, Update, UpdateValue,
};

impl Printer<'_> {
    pub(super) fn system(&mut self, system: &System) {
        self.begin_word(system.name.span.start as usize);
        self.layout.text(format!("system {}", system.name.name));
        let head = system.span.end as usize;
        let braces = self.source.opens(head);
        let close = if braces { self.source.braces(head).1 } else { head.saturating_sub(1) };
        match &system.kind {
            SystemKind::Plain => return self.items(system, close),
            SystemKind::GridRows(rows) => {
                self.rows(system, rows);
                if system.items.is_empty() {
                    return;
                }
            }
            SystemKind::GridFile(file) => self.layout.text(format!(" = grid({})", quoted(&file.text))),
            SystemKind::Graph(file) => self.layout.text(format!(" = graph({})", quoted(&file.text))),
        }
        if !system.items.is_empty() || braces && self.source.comments_before(close) > 0 {
            self.items(system, close);
        } else {
            self.semicolon(close);
        }
    }

    /// ` = grid { "..." }`. Items inside the braces of the rows are printed inside a second pair.
    fn rows(&mut self, system: &System, rows: &[Text]) {
        self.layout.text(" = grid");
        self.open_block();
        for row in rows {
            self.begin(row.span.start as usize);
            self.layout.text(quoted(&row.text));
        }
        let close = (system.span.end as usize).saturating_sub(1);
        let items_inside = system.items.first().is_some_and(|item| self.item_start(item) < close);
        let last = rows.last().map_or(0, |row| row.span.end as usize);
        self.close_block(if items_inside { last } else { close });
    }

    /// `{ ITEMS }`, closed at `close`.
    fn items(&mut self, system: &System, close: usize) {
        if system.items.is_empty() && self.source.comments_before(close) == 0 {
            self.layout.text(" { }");
            return;
        }
        self.open_block();
        for item in &system.items {
            self.begin(self.item_start(item));
            self.system_item(item);
        }
        self.close_block(close);
    }

    /// Where the item's word stands.
    fn item_start(&self, item: &SystemItem) -> usize {
        let behind = match item {
            SystemItem::On(Clause { span, .. })
            | SystemItem::Also(Clause { span, .. })
            | SystemItem::Legend { span, .. }
            | SystemItem::Map { span, .. } => return span.start as usize,
            SystemItem::State(decls) => decls.first().map(|decl| decl.name.span),
            SystemItem::Action(names) | SystemItem::Moves(names) => names.first().map(|name| name.span),
            SystemItem::Init(e) | SystemItem::Absorb(e) | SystemItem::Trans(e) => Some(e.span),
            SystemItem::Label(name, _)
            | SystemItem::Cost(name, _)
            | SystemItem::Obstacle(name)
            | SystemItem::Edge(name)
            | SystemItem::Corner(name) => Some(name.span),
            SystemItem::Observe(es) => es.first().map(|e| e.span),
        };
        behind.map_or(0, |span| self.source.word_before(span.start as usize))
    }

    fn system_item(&mut self, item: &SystemItem) {
        let end = match item {
            SystemItem::On(clause) => return self.clause("on ", clause),
            SystemItem::Also(clause) => return self.clause("also on ", clause),
            SystemItem::State(decls) => self.state(decls),
            SystemItem::Action(names) => self.named("action ", names),
            SystemItem::Moves(names) => self.named("moves ", names),
            SystemItem::Init(e) => self.constraint("init ", e),
            SystemItem::Absorb(e) => self.constraint("absorb ", e),
            SystemItem::Trans(e) => self.constraint("trans ", e),
            SystemItem::Observe(es) => {
                self.layout.text("observe ");
                self.exprs(es);
                es.last().map_or(0, end)
            }
            SystemItem::Label(name, e) => {
                self.assignment(format!("label {}", name.name), e);
                end(e)
            }
            SystemItem::Cost(name, e) => {
                self.assignment(format!("cost {}", name.name), e);
                end(e)
            }
            SystemItem::Obstacle(rule) => self.named("obstacle ", std::slice::from_ref(rule)),
            SystemItem::Edge(rule) => self.named("edge ", std::slice::from_ref(rule)),
            SystemItem::Corner(rule) => self.named("corner ", std::slice::from_ref(rule)),
            SystemItem::Map { item, .. } => self.map_item(item),
            SystemItem::Legend { letter, label, span } => {
                let label = label.as_ref().map_or("#", |label| &label.name);
                self.layout.text(format!("legend '{}' = {label}", letter.text));
                span.end as usize
            }
        };
        self.semicolon(end);
    }

    fn named(&mut self, word: &'static str, names: &[Ident]) -> usize {
        self.layout.text(word);
        self.names(names, ",");
        names.last().map_or(0, |name| name.span.end as usize)
    }

    fn constraint(&mut self, word: &'static str, e: &Expr) -> usize {
        self.layout.text(word);
        self.expr(e);
        end(e)
    }

    fn state(&mut self, decls: &[StateDecl]) -> usize {
        self.layout.text("state ");
        self.separated(decls, ",", |printer, decl| {
            printer.comments(decl.name.span.start as usize);
            printer.layout.text(format!("{}: ", decl.name.name));
            match &decl.ty {
                Type::Bool => printer.layout.text("bool"),
                Type::Int => printer.layout.text("int"),
                Type::Real => printer.layout.text("real"),
                Type::Action => printer.layout.text("action"),
                Type::Range(lo, hi) => printer.range(lo, hi),
                Type::Enum(values) => {
                    printer.layout.text("{");
                    printer.names(values, ",");
                    printer.layout.text("}");
                }
            }
        });
        decls.last().map_or(0, |decl| decl.ty_span.end as usize)
    }

    /// `on A | B when GUARD { UPDATES }`; on one line if it was and fits.
    fn clause(&mut self, word: &'static str, clause: &Clause) {
        self.layout.text(word);
        match &clause.actions {
            None => self.layout.text("*"),
            Some(actions) => self.names(actions, " |"),
        }
        if let Some(guard) = &clause.guard {
            self.layout.text(" when ");
            self.expr(guard);
        }
        let (open, close) = self.source.braces(clause.span.end as usize);
        let comments = self.source.comments_before(close) > 0;
        let Some(first) = clause.updates.first().filter(|_| !comments) else {
            if comments {
                return self.updates(&clause.updates, close);
            }
            return self.layout.text(" { }");
        };
        if self.source.breaks_between(open + 1, first.var.span.start as usize) {
            return self.updates(&clause.updates, close);
        }
        self.layout.open(Indent::By(0));
        self.layout.text(" {");
        for update in &clause.updates {
            self.layout.soft_indented(2);
            // Where an update takes several lines, they are indented by more than its first one.
            self.layout.open(Indent::By(2));
            self.update(update);
            self.layout.close();
        }
        self.layout.soft();
        self.layout.text("}");
        self.layout.close();
    }

    fn updates(&mut self, updates: &[Update], close: usize) {
        self.open_block();
        for update in updates {
            self.begin(update.var.span.start as usize);
            self.update(update);
        }
        self.close_block(close);
    }

    fn update(&mut self, update: &Update) {
        let end = match &update.value {
            UpdateValue::Assign(value) => {
                self.assignment(format!("{}'", update.var.name), value);
                end(value)
            }
            UpdateValue::Choose(set) => {
                self.layout.text(format!("{}' in ", update.var.name));
                self.set(set);
                match set {
                    Set::List(_, span) | Set::Enabled(_, span) | Set::If(_, _, span) => span.end as usize,
                    Set::Range(_, hi) => end(hi),
                }
            }
        };
        self.semicolon(end);
    }
}

/// In quotes, with escapes.
pub(super) fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}
