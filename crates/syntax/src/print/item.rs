//! Declarations other than systems.

use super::layout::Indent;
use super::{Printer, end, start};
use crate::ast::{Define, Formula, Ident, Item, Objective, ObjectiveBody, Quantifier, Template};

impl Printer<'_> {
    pub(super) fn item(&mut self, item: &Item) {
        match item {
            Item::Const(constant) => {
                self.begin_word(constant.name.span.start as usize);
                self.assignment(format!("const {}", constant.name.name), &constant.value);
                self.semicolon(end(&constant.value));
            }
            Item::System(system) => self.system(system),
            Item::Template(template) => self.template(template),
            Item::Define(define) => self.define(define),
            Item::Objective(objective) => self.objective(objective),
        }
    }

    fn define(&mut self, define: &Define) {
        self.begin_word(define.name.span.start as usize);
        self.assignment(format!("define {}({})", define.name.name, listed(&define.params)), &define.body);
        self.semicolon(end(&define.body));
    }

    fn template(&mut self, template: &Template) {
        if !self.source.is_known() {
            for line in template.doc.lines() {
                self.layout.line(false);
                self.layout.comment(format!("// {line}").trim_end().to_owned(), false);
            }
        }
        self.begin_word(template.name.span.start as usize);
        self.layout.text(format!("template {}(", template.name.name));
        self.names(&template.params, ",");
        self.layout.text(")");
        let head = template.params.last().unwrap_or(&template.name);
        self.formula(&template.formula, head.span.end as usize);
    }

    fn objective(&mut self, objective: &Objective) {
        self.begin_word(objective.name.span.start as usize);
        self.layout.text(format!("objective {}", objective.name.name));
        let mut head = objective.name.span.end as usize;
        if let Some(within) = &objective.within {
            self.layout.text(" within ");
            self.arithmetic(within);
            head = end(within);
        }
        if let Some(semantics) = &objective.semantics {
            self.layout.text(format!(" semantics {}", semantics.name));
            head = semantics.span.end as usize;
        }
        match &objective.body {
            ObjectiveBody::Formula(formula) => self.formula(formula, head),
            ObjectiveBody::Instance { template, args } => {
                self.layout.text(format!(" = {}(", template.name));
                self.exprs(args);
                self.layout.text(")");
                self.semicolon(args.last().map_or(template.span.end as usize, end));
            }
        }
    }

    /// `{ DEFINES QUANTIFIERS BODY }`; the braces open behind `head`.
    fn formula(&mut self, formula: &Formula, head: usize) {
        let (open, close) = self.source.braces(head);
        let (first, inner) = match formula.quantifiers.first() {
            Some(Quantifier { path, .. }) => {
                let inner = path.span.start as usize;
                (self.source.word_before(inner), inner)
            }
            None => {
                let inner = start(&formula.body);
                (self.source.opening(inner), inner)
            }
        };
        let on_one_line = formula.defines.is_empty()
            && self.source.is_known()
            && !self.source.breaks_between(open + 1, first)
            && self.source.comments_before(close) == 0;
        if on_one_line {
            self.layout.open(Indent::By(0));
            self.layout.text(" {");
            self.layout.soft_indented(2);
            self.quantifiers(&formula.quantifiers);
            self.body(formula, 4);
            self.minimize(formula, 2);
            self.layout.soft();
            self.layout.text("}");
            self.layout.close();
            return;
        }
        self.open_block();
        for define in &formula.defines {
            self.define(define);
        }
        self.begin_up_to(first, inner);
        self.layout.open(Indent::By(0));
        self.quantifiers(&formula.quantifiers);
        self.body(formula, 2);
        self.minimize(formula, 0);
        self.layout.close();
        self.close_block(close);
    }

    /// ` minimize EXPR, ...;`, on a line of its own where it has one, or needs one.
    fn minimize(&mut self, formula: &Formula, indent: usize) {
        let (Some(first), Some(last)) = (formula.minimize.first(), formula.minimize.last()) else { return };
        let word = self.source.word_before(self.source.opening(start(first)));
        if self.source.breaks_between(end(&formula.body), word) || self.source.comments_before(word) > 0 {
            self.comments(word);
            self.layout.line(false);
        } else {
            self.layout.soft_indented(indent);
        }
        self.layout.text("minimize ");
        self.exprs(&formula.minimize);
        self.semicolon(end(last));
    }

    /// The body behind the quantifiers; on a line of its own where it has one, or needs one.
    fn body(&mut self, formula: &Formula, indent: usize) {
        let body = &formula.body;
        if let Some(last) = formula.quantifiers.last() {
            let last = last.system.as_ref().unwrap_or(&last.path).span.end as usize;
            let first = start(body);
            if self.source.breaks_between(last, first) || self.source.comments_before(first) > 0 {
                self.layout.open(Indent::By(indent));
                self.comments(first);
                self.layout.line(false);
                self.expr(body);
                self.layout.close();
                return;
            }
            self.layout.soft_indented(indent);
        }
        self.expr(body);
    }

    /// `exists p, q: S. forall r.`: neighbors of one kind share a word.
    fn quantifiers(&mut self, quantifiers: &[Quantifier]) {
        let mut rest = quantifiers;
        while let Some(first) = rest.first() {
            let together = rest.windows(2).take_while(|pair| may_share(&pair[0], &pair[1])).count() + 1;
            let (group, behind) = rest.split_at(together);
            if rest.len() < quantifiers.len() {
                self.layout.text(" ");
            }
            self.comments(first.path.span.start as usize);
            self.layout.text(if first.forall { "forall " } else { "exists " });
            self.paths(group);
            self.layout.text(".");
            rest = behind;
        }
    }

    fn paths(&mut self, group: &[Quantifier]) {
        for (nth, quantifier) in group.iter().enumerate() {
            if nth > 0 {
                self.layout.text(", ");
            }
            self.comments(quantifier.path.span.start as usize);
            self.layout.text(quantifier.path.name.clone());
            let next = group.get(nth + 1).and_then(|next| next.system.as_ref());
            match &quantifier.system {
                // `p, q: S` says of both that they are of S.
                Some(system) if next.is_none_or(|next| next.name != system.name) => {
                    self.layout.text(format!(": {}", system.name));
                }
                _ => {}
            }
        }
    }
}

/// Whether two quantifiers can be written with one word. A path without a system cannot stand in front of one with:
/// `p, q: S` gives S to both.
fn may_share(first: &Quantifier, second: &Quantifier) -> bool {
    first.forall == second.forall && (first.system.is_some() || second.system.is_none())
}

fn listed(names: &[Ident]) -> String {
    let names: Vec<&str> = names.iter().map(|name| name.name.as_str()).collect();
    names.join(", ")
}
