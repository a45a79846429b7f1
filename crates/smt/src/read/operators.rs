//! Functions of the theories, applied.

use super::Reader;
use super::Trouble;
use crate::term::{Sort, Term};
use crate::terms::Terms;

/// The most arguments of `distinct`, which compares each two.
const DISTINCT: usize = 2000;

/// A function of a theory.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Operator {
    Not,
    And,
    Or,
    Xor,
    Implies,
    Equal,
    Distinct,
    Ite,
    /// Whether a value of a datatype is that constructor.
    Is(Term),
    Arith(Arith),
    Compare(Compare),
    Divisible(u32),
    Bits(Bits),
    BvCompare {
        signed: bool,
        compare: Compare,
    },
    BvComp,
    Concat,
    Extract(u32, u32),
    ZeroExtend(u32),
    SignExtend(u32),
    RotateLeft(u32),
    RotateRight(u32),
    Repeat(u32),
}

/// A function from numbers to a number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Arith {
    Add,
    Sub,
    Mul,
    Div,
    IntDiv,
    Mod,
    Abs,
    ToReal,
}

/// An order.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Compare {
    Le,
    Lt,
    Ge,
    Gt,
}

/// A function from bit-vectors of one width to one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Bits {
    Not,
    Neg,
    And,
    Or,
    Xor,
    Nand,
    Nor,
    Xnor,
    Add,
    Sub,
    Mul,
    Shl,
    Lshr,
    Ashr,
}

impl Operator {
    /// The function that SMT-LIB calls so.
    pub(super) fn named(name: &str) -> Option<Operator> {
        use {Arith as A, Bits as B, Compare as C, Operator as O};
        let order = |signed, compare| O::BvCompare { signed, compare };
        Some(match name {
            "not" => O::Not,
            "and" => O::And,
            "or" => O::Or,
            "=" => O::Equal,
            "=>" => O::Implies,
            "xor" => O::Xor,
            "ite" => O::Ite,
            "distinct" => O::Distinct,
            "+" => O::Arith(A::Add),
            "-" => O::Arith(A::Sub),
            "*" => O::Arith(A::Mul),
            "/" => O::Arith(A::Div),
            "div" => O::Arith(A::IntDiv),
            "mod" => O::Arith(A::Mod),
            "abs" => O::Arith(A::Abs),
            "to_real" => O::Arith(A::ToReal),
            "<=" => O::Compare(C::Le),
            "<" => O::Compare(C::Lt),
            ">=" => O::Compare(C::Ge),
            ">" => O::Compare(C::Gt),
            "bvnot" => O::Bits(B::Not),
            "bvneg" => O::Bits(B::Neg),
            "bvand" => O::Bits(B::And),
            "bvor" => O::Bits(B::Or),
            "bvxor" => O::Bits(B::Xor),
            "bvnand" => O::Bits(B::Nand),
            "bvnor" => O::Bits(B::Nor),
            "bvxnor" => O::Bits(B::Xnor),
            "bvadd" => O::Bits(B::Add),
            "bvsub" => O::Bits(B::Sub),
            "bvmul" => O::Bits(B::Mul),
            "bvshl" => O::Bits(B::Shl),
            "bvlshr" => O::Bits(B::Lshr),
            "bvashr" => O::Bits(B::Ashr),
            "bvule" => order(false, C::Le),
            "bvult" => order(false, C::Lt),
            "bvuge" => order(false, C::Ge),
            "bvugt" => order(false, C::Gt),
            "bvsle" => order(true, C::Le),
            "bvslt" => order(true, C::Lt),
            "bvsge" => order(true, C::Ge),
            "bvsgt" => order(true, C::Gt),
            "bvcomp" => O::BvComp,
            "concat" => O::Concat,
            _ => return None,
        })
    }
}

impl Reader<'_> {
    /// A function of a theory, applied.
    pub(super) fn apply(&mut self, at: usize, operator: Operator, args: &[Term]) -> Result<Term, Trouble> {
        use Operator as O;
        if args.is_empty() {
            return Err(Trouble::syntax(at, "arguments are missing"));
        }
        match operator {
            O::Not | O::And | O::Or | O::Xor | O::Implies => self.boolean(at, operator, args),
            O::Equal | O::Distinct => self.equal(at, operator == O::Distinct, args),
            O::Ite => self.if_then_else(at, args),
            O::Is(constructor) => {
                let [t] = arity(at, args)?;
                let t = self.of_sort(at, t, self.sort_of(constructor))?;
                Ok(self.terms().eq(t, constructor))
            }
            O::Arith(arith) => self.arith(at, arith, args),
            O::Compare(compare) => self.compare(at, compare, args),
            O::Divisible(by) => self.divisible(at, by, args),
            O::Bits(bits) => self.bits(at, bits, args),
            O::BvCompare { signed, compare } => self.bv_compare(at, signed, compare, args),
            O::BvComp => {
                let [a, b] = arity(at, args)?;
                self.same_width(at, &[a, b])?;
                let terms = self.terms();
                let (equal, one, zero) = (terms.eq(a, b), terms.bv(1, 1), terms.bv(0, 1));
                Ok(terms.ite(equal, one, zero))
            }
            O::Concat | O::Repeat(_) => self.joined(at, operator, args),
            O::Extract(..) | O::ZeroExtend(_) | O::SignExtend(_) | O::RotateLeft(_) | O::RotateRight(_) => {
                let [t] = arity(at, args)?;
                self.rewired(at, operator, t)
            }
        }
    }

    fn boolean(&mut self, at: usize, operator: Operator, args: &[Term]) -> Result<Term, Trouble> {
        for &t in args {
            self.of_sort(at, t, Sort::Bool)?;
        }
        let (last, rest) = args.split_last().ok_or_else(|| Trouble::syntax(at, "arguments are missing"))?;
        let terms = self.terms();
        Ok(match operator {
            Operator::Not => {
                let [t] = arity(at, args)?;
                !t
            }
            Operator::And => terms.and(args),
            Operator::Or => terms.or(args),
            Operator::Xor => args[1..].iter().fold(args[0], |sum, &t| terms.xor(sum, t)),
            // Right-associative: all of the rest imply the last.
            _ => {
                let all: Vec<Term> = rest.iter().map(|t| !*t).chain([*last]).collect();
                terms.or(&all)
            }
        })
    }

    fn equal(&mut self, at: usize, distinct: bool, args: &[Term]) -> Result<Term, Trouble> {
        let args = self.alike(at, args)?;
        if !distinct {
            let terms = self.terms();
            let pairs: Vec<Term> = args.windows(2).map(|pair| terms.eq(pair[0], pair[1])).collect();
            return Ok(terms.and(&pairs));
        }
        if args.len() > DISTINCT {
            return Err(Trouble::unsupported(at, format!("distinct of more than {DISTINCT}")));
        }
        self.check_room(at, args.len() * args.len() / 2)?;
        let terms = self.terms();
        let mut pairs = Vec::new();
        for (i, &a) in args.iter().enumerate() {
            pairs.extend(args[..i].iter().map(|&b| !terms.eq(b, a)));
        }
        Ok(terms.and(&pairs))
    }

    fn if_then_else(&mut self, at: usize, args: &[Term]) -> Result<Term, Trouble> {
        let [c, a, b] = arity(at, args)?;
        let c = self.of_sort(at, c, Sort::Bool)?;
        let alike = self.alike(at, &[a, b])?;
        Ok(self.terms().ite(c, alike[0], alike[1]))
    }

    /// The term as one of that sort: an integer is a real too.
    pub(super) fn of_sort(&mut self, at: usize, t: Term, sort: Sort) -> Result<Term, Trouble> {
        match (self.sort_of(t), sort) {
            (Sort::Int, Sort::Real) => Ok(self.terms().to_real(t)),
            (found, _) if found == sort => Ok(t),
            (found, _) => Err(Trouble::syntax(at, format!("{sort} is needed here, not {found}"))),
        }
    }

    /// The terms, all of one sort.
    pub(super) fn alike(&mut self, at: usize, args: &[Term]) -> Result<Vec<Term>, Trouble> {
        let real = args.iter().any(|&t| self.sort_of(t) == Sort::Real);
        let sort = if real { Sort::Real } else { self.sort_of(args[0]) };
        args.iter().map(|&t| self.of_sort(at, t, sort)).collect()
    }
}

/// As many arguments as there have to be.
pub(super) fn arity<const N: usize>(at: usize, args: &[Term]) -> Result<[Term; N], Trouble> {
    let wrong = || Trouble::syntax(at, format!("{N} arguments are needed here, not {}", args.len()));
    args.try_into().map_err(|_| wrong())
}

/// That each two neighbors are in order.
pub(super) fn chain(
    terms: &mut Terms,
    compare: Compare,
    args: &[Term],
    le: impl Fn(&mut Terms, Term, Term) -> Term,
) -> Term {
    let pairs = args.windows(2).map(|pair| match compare {
        Compare::Le => le(terms, pair[0], pair[1]),
        Compare::Ge => le(terms, pair[1], pair[0]),
        Compare::Lt => !le(terms, pair[1], pair[0]),
        Compare::Gt => !le(terms, pair[0], pair[1]),
    });
    let pairs: Vec<Term> = pairs.collect();
    terms.and(&pairs)
}
