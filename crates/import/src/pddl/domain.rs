//! What a domain and a problem declare.

use super::lists::{Kind, Node, read};
use crate::build::wrong;
use crate::parser::Parse;
use hyperplan_syntax::{SourceId, Span};
use indexmap::IndexMap;

/// What is known of `:requirements`; others are refused.
const REQUIREMENTS: &[&str] = &[
    ":strips",
    ":typing",
    ":equality",
    ":conditional-effects",
    ":negative-preconditions",
    ":disjunctive-preconditions",
    ":existential-preconditions",
    ":universal-preconditions",
    ":quantified-preconditions",
    ":adl",
    ":non-deterministic",
    ":nondeterministic",
    ":oneof",
];

/// A name with the types that it may have; none for any.
pub(super) type Typed = (String, Vec<String>, Span);

pub(super) struct Action {
    pub(super) name: String,
    pub(super) span: Span,
    pub(super) parameters: Vec<Typed>,
    pub(super) condition: Option<Node>,
    pub(super) effect: Option<Node>,
}

/// A domain with a problem.
#[derive(Default)]
pub(super) struct Task {
    /// Each type with its parents.
    types: IndexMap<String, Vec<String>>,
    /// With their types.
    pub(super) objects: IndexMap<String, Vec<String>>,
    /// The types of the arguments.
    pub(super) predicates: IndexMap<String, Vec<Vec<String>>>,
    pub(super) actions: Vec<Action>,
    pub(super) init: Vec<Node>,
    pub(super) goal: Option<Node>,
    /// The problem's name, and where it stands.
    pub(super) name: Option<(String, Span)>,
    has_domain: bool,
}

impl Task {
    /// Adds what a file defines.
    pub(super) fn add(&mut self, source: SourceId, text: &str) -> Parse<()> {
        let start = Span::new(source, 0..0);
        let definitions = read(source, text)?;
        if definitions.is_empty() {
            return wrong("syntax", start, "expected `(define ...)`");
        }
        for definition in &definitions {
            let (word, parts) = definition.headed()?;
            let Some((head, sections)) = parts.split_first().filter(|_| word == "define") else {
                return wrong("syntax", definition.span, "expected `(define (domain NAME) ...)`");
            };
            let (what, name) = head.headed()?;
            let Some(name) = name.first() else { return wrong("syntax", head.span, "a name is missing") };
            match what {
                "domain" if self.has_domain => return wrong("duplicate-name", head.span, "a second domain"),
                "domain" => self.has_domain = true,
                "problem" if self.name.is_some() => {
                    return wrong("duplicate-name", head.span, "a second problem");
                }
                "problem" => self.name = Some((name.word()?.to_owned(), head.span)),
                _ => return wrong("syntax", head.span, "expected `(domain NAME)` or `(problem NAME)`"),
            }
            for section in sections {
                self.section(section)?;
            }
        }
        Ok(())
    }

    /// Refuses what lacks a domain or a problem.
    pub(super) fn complete(&self, end: Span) -> Parse<&Node> {
        if !self.has_domain {
            return wrong("syntax", end, "there is no domain: `(define (domain NAME) ...)`");
        }
        match (&self.goal, &self.name) {
            (Some(goal), _) => Ok(goal),
            (None, Some((_, span))) => wrong("syntax", *span, "this problem has no `(:goal ...)`"),
            (None, None) => wrong("syntax", end, "there is no problem: `(define (problem NAME) ...)`"),
        }
    }

    fn section(&mut self, section: &Node) -> Parse<()> {
        let (word, parts) = section.headed()?;
        match word {
            ":requirements" => {
                for part in parts {
                    if !REQUIREMENTS.contains(&part.word()?) {
                        let message = format!("the requirement `{}` is not supported", part.word()?);
                        return wrong("unsupported", part.span, message);
                    }
                }
            }
            ":domain" => {}
            ":types" => {
                for (name, parents, _) in typed(parts)? {
                    for parent in &parents {
                        self.types.entry(parent.clone()).or_default();
                    }
                    self.types.entry(name).or_default().extend(parents);
                }
            }
            ":constants" | ":objects" => {
                for (name, types, span) in typed(parts)? {
                    self.known_types(&types, span)?;
                    if self.objects.insert(name.clone(), types).is_some() {
                        return wrong("duplicate-name", span, format!("a second object `{name}`"));
                    }
                }
            }
            ":predicates" => {
                for part in parts {
                    let (name, arguments) = part.headed()?;
                    let arguments = typed(arguments)?;
                    for (_, types, span) in &arguments {
                        self.known_types(types, *span)?;
                    }
                    let types = arguments.into_iter().map(|(_, types, _)| types).collect();
                    if self.predicates.insert(name.to_owned(), types).is_some() {
                        return wrong("duplicate-name", part.span, format!("a second predicate `{name}`"));
                    }
                }
            }
            ":action" => self.action(section.span, parts)?,
            ":init" => self.init.extend_from_slice(parts),
            ":goal" => match parts {
                [goal] => self.goal = Some(goal.clone()),
                _ => return wrong("syntax", section.span, "expected one condition behind `:goal`"),
            },
            other => return wrong("unsupported", section.span, format!("`{other}` is not supported")),
        }
        Ok(())
    }

    fn action(&mut self, span: Span, parts: &[Node]) -> Parse<()> {
        let Some((name, fields)) = parts.split_first() else {
            return wrong("syntax", span, "expected the name of the action");
        };
        let mut action = Action {
            name: name.word()?.to_owned(),
            span: name.span,
            parameters: Vec::new(),
            condition: None,
            effect: None,
        };
        for field in fields.chunks(2) {
            let [key, value] = field else { return wrong("syntax", span, "a field without what it says") };
            match key.word()? {
                ":parameters" => {
                    action.parameters = typed(value.list()?)?;
                    for (_, types, span) in &action.parameters {
                        self.known_types(types, *span)?;
                    }
                }
                ":precondition" => action.condition = Some(value.clone()),
                ":effect" => action.effect = Some(value.clone()),
                other => return wrong("unsupported", key.span, format!("`{other}` is not supported")),
            }
        }
        if self.actions.iter().any(|known| known.name == action.name) {
            return wrong("duplicate-name", action.span, format!("a second action `{}`", action.name));
        }
        self.actions.push(action);
        Ok(())
    }

    fn known_types(&self, types: &[String], span: Span) -> Parse<()> {
        match types.iter().find(|name| *name != "object" && !self.types.contains_key(*name)) {
            Some(name) => wrong("unknown-name", span, format!("no type `{name}`")),
            None => Ok(()),
        }
    }

    /// The objects of one of some types.
    pub(super) fn of_types(&self, types: &[String]) -> Vec<&str> {
        let fits = |own: &Vec<String>| types.is_empty() || types.iter().any(|ty| self.is_one(own, ty));
        self.objects.iter().filter(|(_, own)| fits(own)).map(|(name, _)| name.as_str()).collect()
    }

    /// Whether what has one of these types is of that type. Types that are their own parents are looked at once.
    fn is_one(&self, own: &[String], ty: &str) -> bool {
        let mut open: Vec<&str> = own.iter().map(String::as_str).collect();
        let mut seen: Vec<&str> = Vec::new();
        while let Some(next) = open.pop() {
            if next == ty {
                return true;
            }
            if !seen.contains(&next) {
                seen.push(next);
                open.extend(self.types.get(next).into_iter().flatten().map(String::as_str));
            }
        }
        ty == "object"
    }
}

/// `a b - t c - (either t u) d`
pub(super) fn typed(nodes: &[Node]) -> Parse<Vec<Typed>> {
    let mut found: Vec<Typed> = Vec::new();
    let mut untyped = 0;
    let mut at = 0;
    while let Some(node) = nodes.get(at) {
        let word = node.word()?;
        if word != "-" {
            found.push((word.to_owned(), Vec::new(), node.span));
            at += 1;
            continue;
        }
        let Some(ty) = nodes.get(at + 1) else { return wrong("syntax", node.span, "a type is missing") };
        let types: Vec<String> = match &ty.kind {
            Kind::Word(word) => vec![word.clone()],
            Kind::List(_) => match ty.headed()? {
                ("either", types) => {
                    types.iter().map(|t| t.word().map(str::to_owned)).collect::<Parse<_>>()?
                }
                _ => return wrong("syntax", ty.span, "expected a type, or `(either ...)`"),
            },
        };
        found[untyped..].iter_mut().for_each(|item| item.1.clone_from(&types));
        untyped = found.len();
        at += 2;
    }
    Ok(found)
}
