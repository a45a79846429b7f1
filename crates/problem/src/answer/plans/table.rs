//! Plans as tables: `time,path,action`, the variables, and places. A row is a state and the action that is taken there; the
//! last of a path has none.

use super::PlanError;
use crate::answer::{Ordered, Scalar, WitnessPath};

/// The columns that every table begins with.
const HEAD: [&str; 3] = ["time", "path", "action"];
/// Those of places; variables of these names come before them.
const PLACE: [&str; 2] = ["x_m", "y_m"];

/// Whether a table begins so.
pub(super) fn is_head(line: &str) -> bool {
    let mut cells = line.split(',').map(|cell| cell.trim().trim_matches('"'));
    HEAD.iter().all(|name| cells.next() == Some(name))
}

pub(super) fn write(paths: &[WitnessPath]) -> Result<String, PlanError> {
    let mut variables: Vec<&str> = Vec::new();
    for (name, _) in paths.iter().flat_map(|path| &path.states).flat_map(|state| &state.0) {
        if !variables.contains(&name.as_str()) {
            variables.push(name);
        }
    }
    let in_place = paths.iter().any(|path| path.positions.is_some());
    let mut writer = csv::Writer::from_writer(Vec::new());
    let head = HEAD.iter().chain(&variables).chain(if in_place { &PLACE[..] } else { &[] });
    let mut failed = writer.write_record(head).is_err();
    for path in paths {
        for (time, state) in path.states.iter().enumerate() {
            let mut row = vec![time.to_string(), path.path.clone()];
            row.push(path.actions.get(time).cloned().unwrap_or_default());
            row.extend(variables.iter().map(|name| state.get(name).map_or_else(String::new, cell)));
            if in_place {
                let place = path.positions.as_ref().and_then(|positions| positions.get(time));
                let (x, y) = place.map_or_else(Default::default, |(x, y)| (x.to_string(), y.to_string()));
                row.extend([x, y]);
            }
            failed |= writer.write_record(&row).is_err();
        }
    }
    let bytes = writer.into_inner().ok().filter(|_| !failed);
    bytes
        .and_then(|bytes| String::from_utf8(bytes).ok())
        .ok_or_else(|| PlanError::Failed("it is no table".to_owned()))
}

fn cell(scalar: &Scalar) -> String {
    match scalar {
        Scalar::Name(name) => name.clone(),
        other => other.to_string(),
    }
}

/// What stands in a cell; what it means its variable's type decides.
fn scalar(text: &str) -> Scalar {
    match text {
        "true" => Scalar::Bool(true),
        "false" => Scalar::Bool(false),
        _ => text.parse().map_or_else(|_| Scalar::Name(text.to_owned()), Scalar::Int),
    }
}

/// The paths of a table; rows of several may stand in any order, but those of each by time.
pub(super) fn read(text: &str) -> Result<Vec<WitnessPath>, String> {
    let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let wrong = |error: &csv::Error| {
        let words = error.to_string();
        words.strip_prefix("CSV error: ").unwrap_or(&words).to_owned()
    };
    let head = reader.headers().map_err(|error| wrong(&error))?.clone();
    let mut paths: Vec<(WitnessPath, bool)> = Vec::new();
    for record in reader.records() {
        let record = record.map_err(|error| wrong(&error))?;
        let line = record.position().map_or(0, csv::Position::line);
        let (time, name, action) = (&record[0], &record[1], &record[2]);
        let found = paths.iter_mut().find(|(path, _)| path.path == name);
        let (path, ended) = match found {
            Some(path) => path,
            None => {
                let path = WitnessPath {
                    path: name.to_owned(),
                    system: String::new(),
                    actions: Vec::new(),
                    states: Vec::new(),
                    positions: None,
                };
                paths.push((path, false));
                paths.last_mut().ok_or("there is no row")?
            }
        };
        if time.parse() != Ok(path.states.len()) {
            let due = path.states.len();
            return Err(format!("line {line}: time {due} of path {name} is due, not `{time}`"));
        }
        if *ended {
            return Err(format!("line {line}: path {name} ended before, where no action was taken"));
        }
        match action {
            "" => *ended = true,
            action => path.actions.push(action.to_owned()),
        }
        let cells = head.iter().zip(&record).skip(HEAD.len());
        let cells = cells.filter(|(variable, cell)| !cell.is_empty() && !PLACE.contains(variable));
        path.states.push(Ordered(cells.map(|(name, cell)| (name.to_owned(), scalar(cell))).collect()));
    }
    if paths.is_empty() {
        return Err("the table has no rows".to_owned());
    }
    Ok(paths.into_iter().map(|(path, _)| path).collect())
}
