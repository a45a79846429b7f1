//! Random terms with their values.

use hyperplan_random::Random;
use hyperplan_smt::{Model, Term, Terms, Value};

#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Plain {
    Bool(bool),
    Bits(u32, u64),
    Int(i64),
}

pub(crate) fn to_value(value: Plain) -> Value {
    match value {
        Plain::Bool(b) => Value::Bool(b),
        Plain::Bits(width, bits) => Value::bv(i128::from(bits), width),
        Plain::Int(i) => Value::Int(i128::from(i)),
    }
}

/// A term over symbols, the same with constants in the symbols' place, and what it should be.
#[derive(Clone, Copy)]
pub(crate) struct Sample {
    pub(crate) open: Term,
    pub(crate) folded: Term,
    pub(crate) value: Plain,
}

pub(crate) struct Pool {
    pub(crate) terms: Terms,
    pub(crate) model: Model,
    pub(crate) samples: Vec<Sample>,
}

impl Pool {
    fn new(random: &mut Random) -> Pool {
        let mut pool = Pool { terms: Terms::new(), model: Model::new(), samples: Vec::new() };
        for i in 0..14 {
            let value = match i % 4 {
                0 => Plain::Bool(random.below(2) == 1),
                1 => Plain::Bits(3, random.number() & 7),
                2 => Plain::Bits(5, random.number() & 31),
                _ => Plain::Int(random.below(21) as i64 - 10),
            };
            let stem = pool.terms.stem(&format!("s{i}"));
            let symbol = pool.terms.symbol(stem, Some(i), to_value(value).sort());
            let folded = pool.terms.constant(to_value(value));
            pool.model.insert(symbol, to_value(value));
            pool.samples.push(Sample { open: symbol, folded, value });
            if random.below(3) == 0 {
                pool.samples.push(Sample { open: folded, folded, value });
            }
        }
        pool
    }

    /// A pool after so many steps.
    pub(crate) fn grown(random: &mut Random, steps: usize) -> Pool {
        let mut pool = Pool::new(random);
        for _ in 0..steps {
            match random.below(3) {
                0 => pool.step_bool(random),
                1 => pool.step_bits(random),
                _ => pool.step_int(random),
            }
        }
        pool
    }

    fn pick(&self, random: &mut Random, fits: impl Fn(Plain) -> bool) -> Sample {
        let fitting: Vec<&Sample> = self.samples.iter().filter(|sample| fits(sample.value)).collect();
        *fitting[random.below(fitting.len())]
    }

    fn pick_bool(&self, random: &mut Random) -> (Sample, bool) {
        let sample = self.pick(random, |v| matches!(v, Plain::Bool(_)));
        let Plain::Bool(b) = sample.value else { unreachable!() };
        if random.below(3) == 0 {
            return (Sample { open: !sample.open, folded: !sample.folded, value: Plain::Bool(!b) }, !b);
        }
        (sample, b)
    }

    /// Builds the same operation on both sides.
    fn push(&mut self, args: &[Sample], value: Plain, build: impl Fn(&mut Terms, &[Term]) -> Term) {
        let open: Vec<Term> = args.iter().map(|s| s.open).collect();
        let folded: Vec<Term> = args.iter().map(|s| s.folded).collect();
        let (open, folded) = (build(&mut self.terms, &open), build(&mut self.terms, &folded));
        self.samples.push(Sample { open, folded, value });
    }

    fn step_bool(&mut self, random: &mut Random) {
        let ((a, x), (b, y), (c, z)) =
            (self.pick_bool(random), self.pick_bool(random), self.pick_bool(random));
        match random.below(7) {
            0 => self.push(&[a, b, c], Plain::Bool(x & y & z), |t, s| t.and(s)),
            1 => self.push(&[a, b, c], Plain::Bool(x | y | z), |t, s| t.or(s)),
            2 => self.push(&[a, b], Plain::Bool(!x | y), |t, s| t.implies(s[0], s[1])),
            3 => self.push(&[a, b], Plain::Bool(x == y), |t, s| t.iff(s[0], s[1])),
            4 => self.push(&[a, b], Plain::Bool(x != y), |t, s| t.xor(s[0], s[1])),
            5 => self.push(&[a, b], Plain::Bool(x == y), |t, s| t.eq(s[0], s[1])),
            _ => self.push(&[a, b, c], Plain::Bool(if x { y } else { z }), |t, s| t.ite(s[0], s[1], s[2])),
        }
    }

    fn step_bits(&mut self, random: &mut Random) {
        let a = self.pick(random, |v| matches!(v, Plain::Bits(..)));
        let Plain::Bits(w, x) = a.value else { unreachable!() };
        let b = self.pick(random, |v| matches!(v, Plain::Bits(width, _) if width == w));
        let Plain::Bits(_, y) = b.value else { unreachable!() };
        let (c, z) = self.pick_bool(random);
        let mask = |bits: u64| bits & ((1 << w) - 1);
        let signed = |bits: u64| if bits >> (w - 1) == 1 { bits as i64 - (1 << w) } else { bits as i64 };
        let bits = |bits: u64| Plain::Bits(w, mask(bits));
        match random.below(12) {
            0 => self.push(&[a, b], bits(x.wrapping_add(y)), |t, s| t.bv_add(s[0], s[1])),
            1 => self.push(&[a, b], bits(x.wrapping_mul(y)), |t, s| t.bv_mul(s[0], s[1])),
            2 => self.push(&[a], bits(x.wrapping_neg()), |t, s| t.bv_neg(s[0])),
            3 => self.push(&[a, b], Plain::Bool(x < y), |t, s| t.bv_ult(s[0], s[1])),
            4 => self.push(&[a, b], Plain::Bool(x <= y), |t, s| t.bv_ule(s[0], s[1])),
            5 => self.push(&[a, b], Plain::Bool(signed(x) < signed(y)), |t, s| t.bv_slt(s[0], s[1])),
            6 => self.push(&[a, b], Plain::Bool(signed(x) <= signed(y)), |t, s| t.bv_sle(s[0], s[1])),
            7 => self.push(&[a, b], Plain::Bool(x == y), |t, s| t.eq(s[0], s[1])),
            8 => self.push(&[c, a, b], bits(if z { x } else { y }), |t, s| t.ite(s[0], s[1], s[2])),
            9 if w == 3 => {
                self.push(&[a], Plain::Bits(5, signed(x) as u64 & 31), |t, s| t.sign_extend(s[0], 2));
            }
            9 | 10 if w == 5 => {
                self.push(&[a], Plain::Bits(3, x >> 1 & 7), |t, s| t.extract(s[0], 3, 1));
            }
            _ if w == 3 => self.push(&[a], Plain::Bits(5, x), |t, s| t.zero_extend(s[0], 2)),
            _ => {}
        }
    }

    fn step_int(&mut self, random: &mut Random) {
        let small = |v: Plain| matches!(v, Plain::Int(i) if i.abs() < 1 << 40);
        let (a, b) = (self.pick(random, small), self.pick(random, small));
        let (Plain::Int(x), Plain::Int(y)) = (a.value, b.value) else { unreachable!() };
        let k = random.below(7) as i64 - 3;
        let d = random.below(5) as i64 + 1;
        match random.below(6) {
            0 => self.push(&[a, b, a], Plain::Int(x + y + x), |t, s| t.add(s)),
            1 => self.push(&[a], Plain::Int(k * x), |t, s| t.int_mul(k, s[0])),
            2 => self.push(&[a, b], Plain::Bool(x <= y), |t, s| t.le(s[0], s[1])),
            3 => self.push(&[a, b], Plain::Bool(x < y), |t, s| t.lt(s[0], s[1])),
            4 => self.push(&[a], Plain::Int(x.div_euclid(d)), |t, s| t.int_div(s[0], d)),
            _ => self.push(&[a], Plain::Int(x.rem_euclid(d)), |t, s| t.int_mod(s[0], d)),
        }
    }
}
