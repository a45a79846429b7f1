//! The plane that a system lives in: cells, obstacles, marks.

use crate::Error;
use crate::eval::truth;
use hyperplan_outlet::is_harmless;
use hyperplan_problem::{Place, State, System, Trace, Type, Value, VarId};

/// The most cells that are drawn.
const CELL_LIMIT: u64 = 4_000_000;

/// A label that is drawn, and where it holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mark {
    /// The label.
    pub label: String,
    /// The letter that stands for it: the map's own, `S` for start, `G` for goal, else one of the label's name where free.
    pub letter: char,
    /// The cells, row by row from the bottom.
    pub cells: Vec<(u32, u32)>,
}

/// What of a system does not depend on a strategy, in cells counted from the lower left corner.
#[derive(Clone, Debug)]
pub struct Board {
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// The values of `x` and `y` in the lower left cell.
    pub origin: (i64, i64),
    /// Cells that are obstacles, sorted.
    pub obstacles: Vec<(u32, u32)>,
    /// Cells that nobody has seen, as maps of ROS have; whether they are obstacles, the others say.
    pub unknown: Vec<(u32, u32)>,
    /// Labels that hold in some cells but not in all.
    pub marks: Vec<Mark>,
    /// Where a map lies, if it says so.
    pub place: Option<Place>,
    x: VarId,
    y: VarId,
    crash: Option<VarId>,
}

impl Board {
    /// The board of a map, or of any system with integer range variables `x` and `y`.
    ///
    /// # Errors
    /// If the system has no such place, or too large a one.
    pub fn of(system: &System) -> Result<Board, Error> {
        let mut board = Self::without_marks(system)?;
        board.marks = board.marks_of(system);
        Ok(board)
    }

    /// The same, but for what stands in the cells, which takes time.
    pub(crate) fn without_marks(system: &System) -> Result<Board, Error> {
        let mut board = match &system.map {
            Some(map) => Board {
                width: map.width,
                height: map.height,
                origin: (0, 0),
                obstacles: map.obstacles.clone(),
                unknown: map.unknown.clone(),
                marks: Vec::new(),
                place: map.place,
                x: map.x,
                y: map.y,
                crash: map.crash,
            },
            None => Self::of_variables(system)?,
        };
        board.obstacles.sort_unstable();
        let (width, height) = (u64::from(board.width), u64::from(board.height));
        if width.saturating_mul(height) > CELL_LIMIT {
            return Err(Error::TooLarge { system: system.name.clone(), width, height, limit: CELL_LIMIT });
        }
        Ok(board)
    }

    fn of_variables(system: &System) -> Result<Board, Error> {
        let unsupported = || Error::Unsupported { system: system.name.clone() };
        let range = |name: &str| {
            let var = system.var(name)?;
            match system.vars[var].ty {
                Type::Range { lo, hi } => Some((var, lo, hi)),
                _ => None,
            }
        };
        let (x, x_lo, x_hi) = range("x").ok_or_else(unsupported)?;
        let (y, y_lo, y_hi) = range("y").ok_or_else(unsupported)?;
        let (width, height) = (x_hi.abs_diff(x_lo).saturating_add(1), y_hi.abs_diff(y_lo).saturating_add(1));
        let (Ok(columns), Ok(rows)) = (u32::try_from(width), u32::try_from(height)) else {
            return Err(Error::TooLarge { system: system.name.clone(), width, height, limit: CELL_LIMIT });
        };
        Ok(Board {
            width: columns,
            height: rows,
            origin: (x_lo, y_lo),
            obstacles: Vec::new(),
            unknown: Vec::new(),
            marks: Vec::new(),
            place: None,
            x,
            y,
            crash: None,
        })
    }

    /// All cells, row by row from the bottom.
    fn cells(&self) -> impl Iterator<Item = (u32, u32)> {
        let width = self.width;
        (0..self.height).flat_map(move |y| (0..width).map(move |x| (x, y)))
    }

    fn marks_of(&self, system: &System) -> Vec<Mark> {
        let free: Vec<(u32, u32)> = self.cells().filter(|c| !self.is_obstacle(*c)).collect();
        let mut marks: Vec<Mark> = Vec::new();
        let mut known: Vec<Option<Value>> = vec![None; system.vars.len()];
        if let Some(crash) = self.crash {
            known[usize::from(crash)] = Some(Value::Bool(false));
        }
        let letters = system.map.as_ref().map_or(&[][..], |map| &map.letters);
        let own = |label: &str| letters.iter().find(|(name, _)| name == label).map(|(_, letter)| *letter);
        // The two that every map has take their letters first, then those with letters of the map.
        let mut labels: Vec<_> = system.labels.iter().collect();
        labels.sort_by_key(|l| match l.name.as_str() {
            "start" => 0,
            "goal" => 1,
            name if own(name).is_some() => 2,
            _ => 3,
        });
        for label in labels {
            let mut holds = |&(x, y): &(u32, u32)| {
                known[usize::from(self.x)] = Some(Value::Int(self.origin.0 + i64::from(x)));
                known[usize::from(self.y)] = Some(Value::Int(self.origin.1 + i64::from(y)));
                truth(system, &label.expr, &known) == Some(true)
            };
            let cells: Vec<_> = free.iter().filter(|c| holds(c)).copied().collect();
            if !cells.is_empty() && cells.len() < free.len() {
                marks.push(Mark {
                    letter: letter(&label.name, own(&label.name), &marks),
                    label: label.name.clone(),
                    cells,
                });
            }
        }
        marks
    }

    /// What a cell is in metres, where that is known.
    pub(crate) fn scale(&self) -> Option<String> {
        let place = self.place?;
        let (x, y) = place.centre((0, 0));
        let turned = if place.yaw == 0.0 { String::new() } else { format!(", turned by {}", place.yaw) };
        Some(format!("cells of {} m, the centre of (0, 0) at ({x}, {y}) m{turned}", place.cell()))
    }

    /// Whether the cell is an obstacle.
    #[must_use]
    pub fn is_obstacle(&self, cell: (u32, u32)) -> bool {
        self.obstacles.binary_search(&cell).is_ok()
    }

    /// The cell of a state; `None` if it is not on the board.
    #[must_use]
    pub fn cell(&self, state: &State) -> Option<(u32, u32)> {
        let coordinate = |var: VarId, origin: i64, size: u32| match state.get(usize::from(var)) {
            Some(Value::Int(n)) => {
                n.checked_sub(origin).and_then(|d| u32::try_from(d).ok()).filter(|d| *d < size)
            }
            _ => None,
        };
        Some((
            coordinate(self.x, self.origin.0, self.width)?,
            coordinate(self.y, self.origin.1, self.height)?,
        ))
    }

    /// The cells of a trace, one a state; states off the board are left out.
    #[must_use]
    pub fn cells_of(&self, trace: &Trace) -> Vec<(u32, u32)> {
        trace.states.iter().filter_map(|s| self.cell(s)).collect()
    }

    /// The first time at which the robot has crashed.
    #[must_use]
    pub fn crash_time(&self, trace: &Trace) -> Option<usize> {
        let crash = usize::from(self.crash?);
        trace.states.iter().position(|s| s.get(crash) == Some(&Value::Bool(true)))
    }
}

/// A letter for a label that no label before it has: its own on the map, or one of its name.
fn letter(label: &str, on_map: Option<char>, taken: &[Mark]) -> char {
    let free = |c: &char| taken.iter().all(|m| m.letter != *c);
    let own = label.chars().filter(|c| c.is_ascii_alphabetic());
    let candidates = own.flat_map(|c| [c.to_ascii_uppercase(), c.to_ascii_lowercase()]);
    let on_map = on_map.filter(|letter| is_harmless(*letter));
    on_map.into_iter().chain(candidates).chain('1'..='9').find(free).unwrap_or('+')
}
