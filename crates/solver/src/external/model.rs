//! Models as solvers print them: by `(get-model)` in any of its notations, or by `(get-value (...))`.

use hyperplan_smt::{Term, Terms, Value, parts, read_value, symbol_text};
use rustc_hash::FxHashMap;

use super::reply::{Meaning, Reply, Splitter, meaning};

/// A model that was printed: what each symbol is, as written.
#[derive(Clone, Debug, Default)]
pub struct PrintedModel {
    values: FxHashMap<String, String>,
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
        self.values.is_empty()
    }

    /// An entry, or a list of entries, at most one within the other; whether there is one.
    fn entry(&mut self, text: &str) -> bool {
        let each = parts(text).unwrap_or_default();
        // Each of them is kept.
        self.single(text) || each.into_iter().filter(|part| self.single(part)).count() > 0
    }

    /// `(define-fun x () S v)`, `(= x v)` or `(x v)`. Functions are not kept.
    fn single(&mut self, text: &str) -> bool {
        let (name, value) = match parts(text).as_deref() {
            Some(["define-fun", name, arguments, _, value])
                if parts(arguments).is_some_and(|a| a.is_empty()) =>
            {
                (*name, *value)
            }
            Some(["define-fun" | "define-fun-rec" | "function", _, _, ..]) => return true,
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
