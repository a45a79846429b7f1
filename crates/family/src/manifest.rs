//! The list of a family's benchmarks.

use crate::record::{Dropped, Entry, Head, Record};
use serde::Serialize;
use serde_json::Value;
use std::collections::BTreeMap;

/// What a family consists of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Manifest {
    /// The family.
    #[serde(flatten)]
    pub head: Head,
    /// The benchmarks.
    pub benchmarks: Vec<Entry>,
    /// The instances without one.
    pub dropped: Vec<Dropped>,
}

/// The columns of the table: the names of an entry's fields, and the track.
const COLUMNS: &str = "\
    file,sha256,bytes,logic,status,certified,track,objective,map,size,density,seed,horizon,steps,\
    states,quantifiers,pruning,problem";

impl Manifest {
    /// The manifest of a log: of several records of one instance the last counts. The order is that of the names, so
    /// that it does not depend on when an instance was done. Of benchmarks that ask the same the first by name stays;
    /// the others are dropped, and their files, which come with the manifest, are to be removed.
    #[must_use]
    pub fn new(head: Head, records: &[Record]) -> (Manifest, Vec<String>) {
        let mut last: BTreeMap<&str, &Record> = BTreeMap::new();
        for record in records {
            match record {
                Record::Written(entry) => last.insert(&entry.about.instance, record),
                Record::Dropped(dropped) => last.insert(&dropped.instance, record),
                // What was dropped as it was undecided is not any more.
                Record::Least { case, .. } => last.remove(case.as_str()),
                Record::Head(_) => None,
            };
        }
        let mut manifest = Manifest { head, benchmarks: Vec::new(), dropped: Vec::new() };
        let mut bodies: BTreeMap<&str, &str> = BTreeMap::new();
        let mut alike = Vec::new();
        for record in last.into_values() {
            match record {
                Record::Written(entry) => match bodies.get(entry.body.as_str()) {
                    Some(first) => {
                        let instance = entry.about.instance.clone();
                        manifest
                            .dropped
                            .push(Dropped { instance, reason: format!("asks the same as {first}") });
                        alike.push(entry.file.clone());
                    }
                    None => {
                        bodies.insert(&entry.body, &entry.about.instance);
                        manifest.benchmarks.push((**entry).clone());
                    }
                },
                Record::Dropped(dropped) => manifest.dropped.push(dropped.clone()),
                Record::Head(_) | Record::Least { .. } => {}
            }
        }
        (manifest, alike)
    }

    /// As JSON.
    ///
    /// # Errors
    /// None: it is plain data.
    pub fn json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(self).map(|text| text + "\n")
    }

    /// The benchmarks as a table, comma-separated.
    ///
    /// # Errors
    /// None: it is written to memory.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut table = csv::Writer::from_writer(Vec::new());
        if !self.benchmarks.is_empty() {
            table.write_record(COLUMNS.split(','))?;
        }
        for entry in &self.benchmarks {
            let mut fields = serde_json::to_value(entry).map_err(std::io::Error::from)?;
            fields["track"] = self.head.track.clone().into();
            fields["map"] = entry.about.case.map.kind.to_string().into();
            table.write_record(COLUMNS.split(',').map(|column| match &fields[column] {
                Value::String(text) => text.clone(),
                number => number.to_string(),
            }))?;
        }
        table.into_inner().map_err(|e| e.into_error().into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{About, Case, Horizon, Kind, Objective, Parameters};

    fn written(instance: &str, body: &str) -> Record {
        let text = |text: &str| text.to_owned();
        let map = Parameters { kind: Kind::Random, size: 8, density: 10, seed: 3 };
        let about = About {
            instance: text(instance),
            case: Case { objective: Objective::Sp, map },
            horizon: Horizon::Least,
            steps: 7,
            states: text("onehot"),
            quantifiers: text("keep"),
            paths: text("symbols"),
            pruning: text("light"),
        };
        Record::Written(Box::new(Entry {
            file: format!("{instance}.smt2"),
            sha256: text("0"),
            body: text(body),
            bytes: 5,
            logic: text("UF"),
            status: text("sat"),
            certified: false,
            problem: text("problems/a.hp"),
            about,
        }))
    }

    fn head() -> Head {
        Head {
            generator: "g".into(),
            date: "d".into(),
            family: "f".into(),
            submitter: "s".into(),
            track: "single".into(),
        }
    }

    fn dropped(instance: &str) -> Record {
        Record::Dropped(Dropped { instance: instance.into(), reason: "too large".into() })
    }

    #[test]
    fn the_order_of_work_does_not_matter() {
        let records = [written("b", "2"), written("a", "1"), dropped("c"), written("d", "1")];
        let (manifest, alike) = Manifest::new(head(), &records);
        let mut backwards = records.clone();
        backwards.reverse();
        assert_eq!(Manifest::new(head(), &backwards), (manifest.clone(), alike.clone()));
        assert_eq!(alike, ["d.smt2"]);
        let names: Vec<&str> = manifest.benchmarks.iter().map(|entry| &*entry.about.instance).collect();
        assert_eq!(names, ["a", "b"]);
        let dropped: Vec<(&str, &str)> =
            manifest.dropped.iter().map(|dropped| (&*dropped.instance, &*dropped.reason)).collect();
        assert_eq!(dropped, [("c", "too large"), ("d", "asks the same as a")]);
    }

    #[test]
    fn the_last_record_of_an_instance_counts() {
        let least = Record::Least { case: "b".into(), least: Some(1) };
        let (manifest, _) = Manifest::new(head(), &[dropped("a"), written("a", "1"), dropped("b"), least]);
        assert_eq!((manifest.benchmarks.len(), manifest.dropped.len()), (1, 0));
    }

    #[test]
    fn the_table_has_a_line_for_each_benchmark() {
        let (manifest, _) = Manifest::new(head(), &[written("a", "1")]);
        let table = String::from_utf8(manifest.csv().expect("plain data")).expect("text");
        assert_eq!(
            table,
            "file,sha256,bytes,logic,status,certified,track,objective,map,size,density,seed,horizon,steps,states,quantifiers,pruning,problem\n\
             a.smt2,0,5,UF,sat,false,single,sp,random,8,10,3,least,7,onehot,keep,light,problems/a.hp\n"
        );
        let json: serde_json::Value =
            serde_json::from_str(&manifest.json().expect("plain data")).expect("JSON");
        assert_eq!(json["benchmarks"][0]["size"], 8);
        assert_eq!(json["benchmarks"][0]["horizon"], "least");
    }
}
