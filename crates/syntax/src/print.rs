//! From the syntax tree back to text: the formatter.
//!
//! Lines are broken where they would be too long, and where the author broke them between a formula's quantifiers and
//! its body or behind an opening brace. Comments stay in front of what they stood in front of, or beside what they
//! stood beside.
//!
//! Formatting what is formatted changes nothing. So between two tokens that are always printed there is one place for
//! comments, and how they are printed there depends only on what is printed in front of them.

mod expr;
mod item;
mod layout;
mod map_item;
mod source;
mod system;

use crate::ast::{Expr, ExprKind, File, Ident, Item, ObjectiveBody};
use crate::is_name;
use layout::{Indent, Layout};
use source::Source;
use system::quoted;

/// The file as text, formatted. Parsing gives the same tree again, apart from places.
///
/// `text` is what the tree was parsed from: comments and empty lines are taken from there. For a tree that was made
/// otherwise it is empty.
#[must_use]
pub fn print(file: &File, text: &str) -> String {
    let mut printer = Printer { layout: Layout::default(), source: Source::new(text), fresh: true };
    printer.file(file);
    printer.layout.finish()
}

struct Printer<'a> {
    layout: Layout,
    source: Source<'a>,
    /// Nothing stands yet in the file or block: no empty line comes first.
    fresh: bool,
}

impl Printer<'_> {
    fn file(&mut self, file: &File) {
        let mut last: Option<&Item> = None;
        for item in &file.items {
            if !self.source.is_known() && last.is_some_and(|last| !belong_together(last, item)) {
                self.layout.line(true);
            }
            last = Some(item);
            self.item(item);
        }
        self.comments(usize::MAX);
    }

    /// The comments that begin before `at`.
    fn comments(&mut self, at: usize) {
        while let Some(comment) = self.source.next_comment(at) {
            let beside = !self.source.begins_line(comment.start) && comment.start > 0;
            if !beside {
                let apart = self.source.is_apart(comment.start) && !self.fresh;
                self.layout.line(apart);
            }
            self.fresh &= beside;
            self.layout.comment(comment.text.to_owned(), beside);
        }
    }

    /// Begins a line with what stood at `at`.
    fn begin(&mut self, at: usize) {
        self.begin_up_to(at, at);
    }

    /// The same; comments up to `first` stand above the line too.
    fn begin_up_to(&mut self, at: usize, first: usize) {
        self.comments(at);
        let apart = self.source.is_apart(at) && !self.fresh;
        self.layout.line(apart);
        self.comments(first);
        self.layout.line(false);
        self.fresh = false;
    }

    /// Begins a line with a declaration: the word in front of what stands at `at`.
    fn begin_word(&mut self, at: usize) {
        self.begin(self.source.word_before(at));
    }

    /// `{` and the start of lines further in.
    fn open_block(&mut self) {
        self.layout.text(" {");
        self.layout.open(Indent::By(2));
        self.fresh = true;
    }

    /// The `}` that stood at `at`.
    fn close_block(&mut self, at: usize) {
        self.comments(at);
        self.layout.close();
        self.layout.line(false);
        self.layout.text("}");
        self.fresh = false;
    }

    /// The `;` that stood at `from` or behind it.
    fn semicolon(&mut self, from: usize) {
        let at = self.source.semicolon(from);
        // A single comment in front of the `;` may as well stand behind it.
        if self.source.comments_before(at) > 1 {
            self.comments(at);
            self.layout.line(false);
        }
        self.layout.text(";");
        if let Some(comment) = self.source.next_comment(at) {
            self.layout.comment(comment.text.to_owned(), true);
        }
    }

    /// `HEAD = EXPR`, the expression on a line of its own if it is long.
    fn assignment(&mut self, head: String, value: &Expr) {
        self.layout.text(head + " =");
        self.layout.open(Indent::By(2));
        self.comments(start(value));
        self.layout.soft();
        self.expr(value);
        self.layout.close();
    }

    /// Names with `between` between them, in lines that begin at the same place.
    fn names(&mut self, names: &[Ident], between: &'static str) {
        self.separated(names, between, |printer, name| {
            printer.comments(name.span.start as usize);
            let written = if is_name(&name.name) { name.name.clone() } else { quoted(&name.name) };
            printer.layout.text(written);
        });
    }

    /// Expressions with commas between them.
    fn exprs(&mut self, exprs: &[Expr]) {
        self.separated(exprs, ",", Self::expr);
    }

    /// Anything with `between` between, in lines that begin at the same place.
    fn separated<T>(&mut self, items: &[T], between: &'static str, one: impl Fn(&mut Self, &T)) {
        self.layout.open(Indent::Here);
        for (nth, item) in items.iter().enumerate() {
            if nth > 0 {
                self.layout.text(between);
                self.layout.fill();
            }
            one(self, item);
        }
        self.layout.close();
    }
}

/// Where the first token of an expression stands that is printed whatever happens to parentheses: comments in front of
/// it are printed in front of all of the expression, wherever among the parentheses they stood.
fn start(mut e: &Expr) -> usize {
    loop {
        e = match &e.kind {
            ExprKind::And(items) | ExprKind::Or(items) if !items.is_empty() => &items[0],
            ExprKind::Sum(items) if !items.is_empty() => &items[0].1,
            ExprKind::Implies(first, _)
            | ExprKind::Iff(first, _)
            | ExprKind::Compare(_, first, _)
            | ExprKind::Arith(_, first, _)
            | ExprKind::In(first, _)
            | ExprKind::Binary(_, _, first, _) => first,
            _ => return e.span.start as usize,
        };
    }
}

fn end(e: &Expr) -> usize {
    e.span.end as usize
}

/// Whether no empty line comes between two declarations.
fn belong_together(first: &Item, second: &Item) -> bool {
    let line = |item: &Item| match item {
        Item::Objective(objective) => matches!(objective.body, ObjectiveBody::Instance { .. }),
        Item::Const(_) | Item::Define(_) => true,
        Item::System(_) | Item::Template(_) => false,
    };
    line(first) && line(second) && std::mem::discriminant(first) == std::mem::discriminant(second)
}
