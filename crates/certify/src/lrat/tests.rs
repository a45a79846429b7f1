use super::Checker;
use crate::error::Error;
use std::io::Cursor;

/// The four clauses of two variables.
const ALL: [&[i32]; 4] = [&[1, 2], &[1, -2], &[-1, 2], &[-1, -2]];

fn check(clauses: &[&[i32]], proof: &str) -> Result<u64, Error> {
    let mut checker = Checker::default();
    for clause in clauses {
        checker.clause(clause)?;
    }
    checker.check(&mut Cursor::new(proof), &|| false)?;
    Ok(checker.steps())
}

#[test]
fn a_refutation_is_followed_step_by_step() {
    assert_eq!(check(&ALL, "5 1 0 1 2 0\n5 d 1 2 0\n6 0 5 3 4 0\n").ok(), Some(3));
    // What was refuted needs no more.
    assert_eq!(check(&ALL, "5 1 0 1 2 0\n6 0 5 3 4 0\nnonsense").ok(), Some(2));
    assert_eq!(check(&[&[]], "").ok(), Some(0));
}

#[test]
fn wrong_steps_are_refused() {
    for (proof, what) in [
        ("5 1 0 1 0\n", "no contradiction"),
        ("5 0 1 2 0\n", "more than one literal"),
        ("5 1 0 1 9 0\n", "no clause"),
        ("5 1 0 1 -2 0\n", "no clause"),
        ("4 1 0 1 2 0\n", "that of another clause"),
        ("5 3 0 1 2 0\n", "no clause has"),
        ("5 1 0 1 2\n", "end with 0"),
        ("5 1 2 0\n", "no hints"),
        ("5 d 9 0\n", "no clause"),
        ("x 1 0 1 2 0\n", "no number"),
        ("5 1 0 1 y 0\n", "no number"),
        ("5 1 0 1 2 0\n5 d 1 0\n6 0 5 1 0\n", "no clause"),
    ] {
        let said = check(&ALL, proof).map_err(|error| error.to_string());
        assert!(said.as_ref().is_err_and(|said| said.contains(what)), "{proof}: {said:?}");
    }
    assert!(matches!(check(&ALL, "5 1 0 1 2 0\n"), Err(Error::Incomplete)));
    assert!(check(&ALL[..3], "5 1 0 1 2 0\n6 0 5 3 4 0\n").is_err());
}

/// Deletions make room, after which everything is found where it is then.
#[test]
fn clauses_are_found_after_others_were_deleted() {
    let mut proof = String::new();
    for number in 5..50_000 {
        proof += &format!("{number} 1 0 1 2 0\n");
        if number > 5 {
            proof += &format!("{number} d {} 0\n", number - 1);
        }
    }
    proof += "50000 0 49999 3 4 0\n";
    assert!(check(&ALL, &proof).is_ok());
}
