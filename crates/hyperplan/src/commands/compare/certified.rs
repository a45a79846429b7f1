//! Known answers that are certified, for those who believe no others.

use crate::commands::certify::{Checking, check};
use crate::failure::Result;
use crate::output::Output;
use crate::proof::DESCRIPTION;
use hyperplan_certify::{Certificate, Error};
use hyperplan_compare::{Answer, Record};
use hyperplan_solver::Deadline;
use std::collections::BTreeMap;
use std::path::Path;

/// The records, with known answers only where a certificate beside the benchmark proves them; says how many these are. So no
/// answer counts as known of a problem file, and none is `sat`: models are checked as they come.
pub(super) fn certified(records: &[Record], out: &Output) -> Vec<Record> {
    let mut known: BTreeMap<&str, bool> = BTreeMap::new();
    for record in records.iter().filter(|record| record.expected.is_some()) {
        known.entry(&record.instance).or_insert_with(|| {
            let is_proved = record.expected == Some(Answer::Unsat) && record.states.is_none();
            let description = Path::new(&record.instance).with_extension(DESCRIPTION);
            if !is_proved || !description.is_file() {
                return false;
            }
            let refused = match prove(record, &description, out) {
                Ok(Ok(())) => return true,
                Ok(Err(error)) => error.to_string(),
                Err(failure) => failure.to_string(),
            };
            out.remark(format_args!("warning: {}: not certified: {refused}", record.instance));
            false
        });
    }
    let (all, proved) = (known.len(), known.values().filter(|proved| **proved).count());
    out.remark(format_args!(
        "note: {proved} of {all} known answers are certified; the others are not believed"
    ));
    let believed = |record: &Record| {
        let is_known = known.get(record.instance.as_str()).copied().unwrap_or(false);
        Record { expected: record.expected.filter(|_| is_known), ..record.clone() }
    };
    records.iter().map(believed).collect()
}

/// Checks the certificate of the benchmark that was run.
fn prove(record: &Record, description: &Path, out: &Output) -> Result<Result<(), Error>> {
    let certificate = match Certificate::read(description) {
        Ok(certificate) => certificate,
        Err(error) => return Ok(Err(error)),
    };
    let benchmark = certificate.benchmark.as_ref().filter(|own| own.sha256 == record.sha256);
    let Some(benchmark) = benchmark.filter(|_| certificate.costs.is_empty()) else {
        return Ok(Err(Error::Foreign("another benchmark".to_owned())));
    };
    let file = description.parent().unwrap_or(Path::new("")).join(&benchmark.file);
    let deadline = Deadline::never();
    let checking = Checking { file: &file, foreign: None, export: None, deadline: &deadline };
    Ok(check(&checking, &certificate, description, out)?.map(|_| ()))
}
