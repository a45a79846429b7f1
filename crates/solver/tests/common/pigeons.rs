//! Formulas that are hard for their size.

use hyperplan_smt::{Script, Sort, Term};

/// More pigeons than holes.
pub(crate) fn pigeons(holes: usize) -> Script {
    let mut script = Script::new();
    let stem = script.terms.stem("in");
    let places = 0..((holes + 1) * holes) as u32;
    let at: Vec<Term> = places.map(|i| script.terms.symbol(stem, Some(i), Sort::Bool)).collect();
    for pigeon in at.chunks(holes) {
        script.clause(pigeon);
    }
    for hole in 0..holes {
        for a in 0..=holes {
            for b in 0..a {
                script.clause(&[!at[a * holes + hole], !at[b * holes + hole]]);
            }
        }
    }
    script
}
