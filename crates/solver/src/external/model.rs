//! Models as solvers print them: by `(get-model)` in any of its notations, or by `(get-value (...))`.

use hyperplan_smt::{
    Definition, Function, Term, Terms, Value, function_text, parts, read_definitions, read_value, symbol_text,
};
use rustc_hash::FxHashMap;

use super::reply::{Meaning, Reply, Splitter, meaning};

/// A model that was printed: what each symbol is, as written.
#[derive(Clone, Debug, Default)]
pub struct PrintedModel {
    values: FxHashMap<String, String>,
    /// Functions as yices writes them: `(function NAME (type ...) (= (NAME v ...) w) ... (default w))`.
    tables: FxHashMap<String, String>,
    /// The definitions of functions with arguments, as written, or made of tables.
    definitions: FxHashMap<String, String>,
    /// What these are, where that could be read.
    functions: FxHashMap<String, Definition>,
    /// A symbol of which two things are said, in different notations perhaps.
    ambiguous: Option<String>,
}

/// Why a text is no model.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PrintedModelError {
    /// The solver said so.
    #[error("the solver said {0}: there is no model")]
    NoModel(&'static str),
    /// The solver reported an error, and nothing else.
    #[error("the solver reported an error: {0}")]
    Failed(String),
    /// There are no values in it.
    #[error("there are no values in it: expected what a solver prints for (get-model) or (get-value (...))")]
    Empty,
    /// A value cannot be read.
    #[error("the value of {symbol} cannot be read: {value}")]
    Value {
        /// The symbol.
        symbol: String,
        /// What is written.
        value: String,
    },
}

impl PrintedModel {
    /// Reads what a solver printed, an answer before the model included.
    ///
    /// # Errors
    /// [`PrintedModelError`], where there is no model in it.
    pub fn read(output: &str) -> Result<PrintedModel, PrintedModelError> {
        let mut splitter = Splitter::default();
        splitter.feed(output.as_bytes());
        splitter.finish();
        let (mut model, mut trouble, mut empty) = (PrintedModel::default(), None, false);
        while let Some(reply) = splitter.next() {
            match meaning(&reply) {
                Meaning::Noise => {}
                // Some print nothing for a model without symbols.
                Meaning::Answer(Some(true)) => empty = true,
                Meaning::Answer(Some(false)) => trouble = Some(PrintedModelError::NoModel("unsat")),
                Meaning::Answer(None) | Meaning::Timeout => {
                    trouble = trouble.or(Some(PrintedModelError::NoModel("unknown")));
                }
                Meaning::Error(message) => trouble = trouble.or(Some(PrintedModelError::Failed(message))),
                Meaning::Other => {
                    if let Reply::Expression(text) = &reply {
                        empty |= matches!(parts(text).as_deref(), Some([] | ["model"]));
                        empty |= model.entry(text);
                    }
                }
            }
        }
        model.understand();
        match trouble {
            // What comes with such an answer is a guess.
            Some(PrintedModelError::NoModel(answer)) => Err(PrintedModelError::NoModel(answer)),
            trouble if model.is_empty() && !(empty && trouble.is_none()) => {
                Err(trouble.unwrap_or(PrintedModelError::Empty))
            }
            _ => Ok(model),
        }
    }

    /// Whether it gives no value.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.values.is_empty() && self.definitions.is_empty()
    }

    /// Reads the definitions of functions, which may need each other.
    fn understand(&mut self) {
        let made = self.values.iter().filter_map(|(symbol, value)| {
            let table = self.tables.get(bare(value))?;
            Some((symbol.clone(), definition_of(symbol, table)?))
        });
        self.definitions.extend(made);
        self.values.retain(|symbol, _| !self.definitions.contains_key(symbol));
        let mut texts: Vec<&str> = self.definitions.values().map(String::as_str).collect();
        texts.sort_unstable();
        let read = read_definitions(&texts).into_iter();
        self.functions = read.map(|(name, definition)| (name.to_owned(), definition)).collect();
    }

    /// An entry, or a list of entries, at most one within the other; whether there is one.
    fn entry(&mut self, text: &str) -> bool {
        let each = parts(text).unwrap_or_default();
        // Each of them is kept.
        self.single(text) || each.into_iter().filter(|part| self.single(part)).count() > 0
    }

    /// `(define-fun x () S v)`, `(= x v)` or `(x v)`; of a function, `(define-fun f ((x S) ...) S v)`.
    fn single(&mut self, text: &str) -> bool {
        let (name, value) = match parts(text).as_deref() {
            Some(["define-fun", name, arguments, _, value])
                if parts(arguments).is_some_and(|a| a.is_empty()) =>
            {
                (*name, *value)
            }
            Some(["define-fun", name, _, _, _]) => {
                let former = self.definitions.insert(bare(name).to_owned(), text.to_owned());
                if former.is_some_and(|former| former != *text) {
                    self.ambiguous.get_or_insert_with(|| bare(name).to_owned());
                }
                return true;
            }
            Some(["function", name, _, ..]) => {
                self.tables.insert(bare(name).to_owned(), text.to_owned());
                return true;
            }
            Some(["define-fun-rec", _, _, ..]) => return true,
            Some(["=", name, value]) => (*name, *value),
            Some([name, value]) if !name.starts_with('(') && !value.starts_with("(define-fun") => {
                (*name, *value)
            }
            _ => return false,
        };
        let former = self.values.insert(bare(name).to_owned(), value.to_owned());
        if former.is_some_and(|former| former != *value) {
            self.ambiguous.get_or_insert_with(|| bare(name).to_owned());
        }
        true
    }

    /// A symbol of which it says two things: the last holds, but they may contradict each other.
    #[must_use]
    pub fn ambiguous(&self) -> Option<&str> {
        self.ambiguous.as_deref()
    }

    /// Whether it says what the symbol is.
    #[must_use]
    pub fn has(&self, terms: &Terms, symbol: Term) -> bool {
        self.values.contains_key(bare(&symbol_text(terms, symbol)))
    }

    /// Whether it says what the function is.
    #[must_use]
    pub fn has_function(&self, terms: &Terms, function: Function) -> bool {
        self.definitions.contains_key(bare(&function_text(terms, function)))
    }

    /// What a declared function is; `None` where nothing is said of it.
    ///
    /// # Errors
    /// [`PrintedModelError::Value`], where what is said cannot be read, or is a function of other sorts.
    pub fn function(
        &self,
        terms: &Terms,
        function: Function,
    ) -> Result<Option<&Definition>, PrintedModelError> {
        let name = function_text(terms, function);
        let Some(text) = self.definitions.get(bare(&name)) else { return Ok(None) };
        let fits = |definition: &&Definition| {
            definition.domain().eq(terms.domain(function).iter().copied())
                && definition.range() == terms.range(function)
        };
        let definition = self.functions.get(bare(&name)).filter(fits);
        let cannot = || PrintedModelError::Value { symbol: name, value: text.chars().take(100).collect() };
        definition.map(Some).ok_or_else(cannot)
    }

    /// What a declared symbol is; `None` where nothing is said of it.
    ///
    /// # Errors
    /// [`PrintedModelError::Value`], where what is said is no value of its sort.
    pub fn value(&self, terms: &Terms, symbol: Term) -> Result<Option<Value>, PrintedModelError> {
        let name = symbol_text(terms, symbol);
        let Some(text) = self.values.get(bare(&name)) else { return Ok(None) };
        let value = read_value(terms, terms.sort(symbol), text);
        let cannot = || PrintedModelError::Value { symbol: name, value: text.chars().take(100).collect() };
        value.map(Some).ok_or_else(cannot)
    }
}

/// A function as a definition: the first entry whose arguments fit, or the default.
fn definition_of(symbol: &str, table: &str) -> Option<String> {
    let table = parts(table)?;
    let ["function", _, kind, entries @ .., default] = table.as_slice() else { return None };
    let ["default", default] = parts(default)?[..] else { return None };
    let ["type", kind] = parts(kind)?[..] else { return None };
    let kind = parts(kind)?;
    let [_, domain @ .., range] = kind.as_slice() else { return None };
    let mut text = format!("(define-fun |{symbol}| (");
    for (at, sort) in domain.iter().enumerate() {
        text += &format!("(x{at} {sort})");
    }
    text += &format!(") {range} ");
    for entry in entries {
        let ["=", applied, value] = parts(entry)?[..] else { return None };
        let applied = parts(applied)?;
        let equal = applied.iter().skip(1).enumerate().map(|(at, value)| format!(" (= x{at} {value})"));
        text += &format!("(ite (and true{}) {value} ", equal.collect::<String>());
    }
    text += default;
    text += &")".repeat(entries.len() + 1);
    Some(text)
}

/// A symbol without its quotes.
fn bare(symbol: &str) -> &str {
    symbol.strip_prefix('|').and_then(|symbol| symbol.strip_suffix('|')).unwrap_or(symbol)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyperplan_smt::Sort;

    fn values(output: &str) -> Result<Vec<Option<Value>>, PrintedModelError> {
        let mut terms = Terms::new();
        let names = [("p.x", Sort::BitVec(3)), ("p.ok", Sort::Bool), ("a b", Sort::Int)];
        let symbols = names.map(|(name, sort)| {
            let stem = terms.stem(name);
            terms.symbol(stem, Some(7), sort)
        });
        let model = PrintedModel::read(output)?;
        symbols.into_iter().map(|symbol| model.value(&terms, symbol)).collect()
    }

    #[test]
    fn models_in_all_notations() {
        let expected = Ok(vec![Some(Value::bv(5, 3)), Some(Value::Bool(true)), Some(Value::Int(-2))]);
        for output in [
            "sat\n(\n  (define-fun p.x@7 () (_ BitVec 3)\n    #b101)\n  (define-fun p.ok@7 () Bool true)\n\
             (define-fun |a b@7| () Int (- 2)))",
            "sat\n(model\n(define-fun |p.x@7| () (_ BitVec 3) (_ bv5 3)) (define-fun p.ok@7 () Bool true)\n\
             (define-fun f ((x Int)) Int x) (define-fun |a b@7| () Int (- 2)))",
            "sat\n(= p.x@7 #b101)\n(= p.ok@7 true)\n(= |a b@7| (- 2))\n",
            "((p.x@7 #b101)\n (p.ok@7 true))((|a b@7| (- 2)))",
        ] {
            assert_eq!(values(output), expected, "{output}");
        }
    }

    #[test]
    fn functions_in_all_notations() {
        let mut terms = Terms::new();
        let stem = terms.stem("p.x");
        let f = terms.function(stem, &[Sort::BitVec(2), Sort::Bool], Sort::Int);
        for output in [
            "sat\n(\n(define-fun p.x ((x!0 (_ BitVec 2)) (x!1 Bool)) Int (ite (and (= x!0 #b01) x!1) (- 2) (k x!1)))\n\
             (define-fun k ((x!0 Bool)) Int 7))",
            "sat\n(= p.x @fun_2)\n(function @fun_2\n (type (-> (_ BitVec 2) Bool Int))\n (= (@fun_2 #b01 true) (- 2))\n (default 7))",
        ] {
            let model = PrintedModel::read(output).expect("a model");
            assert!(model.has_function(&terms, f) && !model.is_empty());
            let definition = model.function(&terms, f).expect("it can be read").expect("it is there");
            let value = |bits, b| definition.value(&[Value::bv(bits, 2), Value::Bool(b)]);
            assert_eq!(value(1, true), Some(Value::Int(-2)), "{output}");
            assert_eq!(
                (value(1, false), value(2, true)),
                (Some(Value::Int(7)), Some(Value::Int(7))),
                "{output}"
            );
        }
        for output in [
            "((define-fun p.x ((x (_ BitVec 3)) (y Bool)) Int 7))",
            "((define-fun p.x ((x (_ BitVec 2)) (y Bool)) Int (nowhere x)))",
        ] {
            let model = PrintedModel::read(output).expect("a model");
            assert!(matches!(model.function(&terms, f), Err(PrintedModelError::Value { .. })), "{output}");
        }
        let other = PrintedModel::read("((define-fun q.x ((x Int)) Int 7))").expect("a model");
        assert!(matches!(other.function(&terms, f), Ok(None)));
    }

    #[test]
    fn what_is_said_twice() {
        let ambiguous = |output: &str| {
            let model = PrintedModel::read(output).expect("a model");
            model.ambiguous().map(str::to_owned)
        };
        assert_eq!(
            ambiguous("sat\n((x 1) (|y| 2))\n((define-fun y () Int 2) (define-fun x () Int 1))"),
            None
        );
        assert_eq!(ambiguous("sat\n((x 1) (y 2))\n((define-fun |y| () Int 3))").as_deref(), Some("y"));
    }

    #[test]
    fn what_is_no_model() {
        assert_eq!(values("unsat\n(error \"no model\")"), Err(PrintedModelError::NoModel("unsat")));
        assert_eq!(values("unknown\n((p.ok@7 true))"), Err(PrintedModelError::NoModel("unknown")));
        assert_eq!(values("(error \"broken\")"), Err(PrintedModelError::Failed("broken".to_owned())));
        assert_eq!(values("hello"), Err(PrintedModelError::Empty));
        let wrong = values("((p.x@7 #b1011))");
        assert!(matches!(wrong, Err(PrintedModelError::Value { .. })), "{wrong:?}");
    }
}
