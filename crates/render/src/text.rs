//! Maps for terminals.

use crate::board::{Board, Mark};
use crate::{Error, Scene};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Up to this many columns each cell has room for a letter and an arrow.
const WIDE_COLUMNS: u32 = 24;

/// How terminal text looks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextStyle {
    /// Whether to use ANSI colors.
    pub color: bool,
}

const RESET: &str = "\u{1b}[0m";
const PATH: &str = "\u{1b}[1;36m";
const OBSTACLE: &str = "\u{1b}[2m";
const UNKNOWN: char = '░';
const MARKED: &str = "\u{1b}[1;33m";
/// Where a cell has no room for more, what stands in those that a path comes to more than once.
const AGAIN: char = '╬';

/// One map for each path, the bottom row last, with the axes' values; where there are no traces, the bare map. Paths of
/// systems that have no map are tables below.
///
/// An arrow shows how the path leaves the cell for the last time, so the arrows lead from its start to its end even
/// where it passes a cell twice, which a small number says, or `╬` where there is no room for one; `*` is the end of the
/// path, `X` a crash. Where cells are narrow, the letters of those where the path starts and ends stay.
///
/// # Errors
/// If no system has a place in the plane, and there is no path that could be a table.
pub fn text_map(scene: Scene<'_>, style: TextStyle) -> Result<String, Error> {
    let mut out = String::new();
    let boards = scene.boards();
    // What is no map is a table here.
    let boards = match boards {
        Err(Error::Unsupported { .. }) if !scene.traces.is_empty() => Vec::new(),
        boards => boards?,
    };
    for (system, board) in &boards {
        let traces = scene.traces_of(*system);
        if traces.is_empty() {
            draw(&mut out, board, &Vec::new(), style);
        }
        for (_, name, trace) in traces {
            if !out.is_empty() {
                out.push('\n');
            }
            let _ = writeln!(out, "{}", scene.heading(name, trace));
            let drawn = passed(board, &board.cells_of(trace), board.crash_time(trace).is_some());
            draw(&mut out, board, &drawn, style);
            if board.width > WIDE_COLUMNS && drawn.iter().any(|(_, sign)| sign.visits > 1 && !sign.end) {
                let _ = writeln!(out, "{AGAIN} more than once");
            }
        }
        legend(&mut out, board);
    }
    let drawn: Vec<_> = boards.iter().map(|(system, _)| *system).collect();
    for (heading, table) in scene.tables(&drawn) {
        let _ = write!(out, "{}{heading}\n{table}", if out.is_empty() { "" } else { "\n" });
    }
    Ok(out)
}

/// What is drawn in a cell that a path passes.
struct Sign {
    arrow: char,
    /// How often it comes there.
    visits: usize,
    /// Whether it starts or ends there.
    end: bool,
}

/// For each cell that the path passes, what to draw there.
fn passed(board: &Board, cells: &[(u32, u32)], crashed: bool) -> Vec<((u32, u32), Sign)> {
    let mut signs: BTreeMap<(u32, u32), Sign> = BTreeMap::new();
    for (time, cell) in cells.iter().enumerate() {
        let comes = time == 0 || cells[time - 1] != *cell;
        let sign = signs.entry(*cell).or_insert(Sign { arrow: '*', visits: 0, end: time == 0 });
        sign.visits += usize::from(comes);
        if let Some(next) = cells.get(time + 1).filter(|next| *next != cell) {
            sign.arrow = arrow(*cell, *next);
        }
    }
    if let Some(last) = cells.last().and_then(|last| signs.get_mut(last)) {
        last.arrow = if crashed { 'X' } else { '*' };
        last.end = true;
    }
    debug_assert!(signs.keys().all(|(x, y)| *x < board.width && *y < board.height));
    signs.into_iter().collect()
}

fn arrow(from: (u32, u32), to: (u32, u32)) -> char {
    use std::cmp::Ordering::{Equal, Greater, Less};
    match (to.0.cmp(&from.0), to.1.cmp(&from.1)) {
        (Greater, Equal) => '→',
        (Less, Equal) => '←',
        (Equal, Greater) => '↑',
        (Equal, Less) => '↓',
        (Greater, Greater) => '↗',
        (Greater, Less) => '↘',
        (Less, Greater) => '↖',
        (Less, Less) => '↙',
        (Equal, Equal) => '•',
    }
}

fn draw(out: &mut String, board: &Board, signs: &[((u32, u32), Sign)], style: TextStyle) {
    let wide = board.width <= WIDE_COLUMNS;
    let (low, high) = (board.origin.1, board.origin.1 + i64::from(board.height) - 1);
    let margin = low.to_string().len().max(high.to_string().len());
    let mut letters = vec!['.'; board.width as usize * board.height as usize];
    let index = |x: u32, y: u32| y as usize * board.width as usize + x as usize;
    // Marks of more weight come first, and so are written last.
    for mark in board.marks.iter().rev() {
        mark.cells.iter().for_each(|&(x, y)| letters[index(x, y)] = mark.letter);
    }
    board.obstacles.iter().for_each(|&(x, y)| letters[index(x, y)] = '#');
    let is_obstacle = |&(x, y): &(u32, u32)| letters[index(x, y)] == '#';
    let unseen: Vec<(u32, u32)> = board.unknown.iter().copied().filter(is_obstacle).collect();
    unseen.iter().for_each(|&(x, y)| letters[index(x, y)] = UNKNOWN);
    for y in (0..board.height).rev() {
        let mut line = format!("{:>margin$}  ", board.origin.1 + i64::from(y));
        for x in 0..board.width {
            let found = signs.binary_search_by_key(&(x, y), |(c, _)| *c).ok().map(|i| &signs[i].1);
            cell(&mut line, letters[index(x, y)], found, wide, style);
        }
        let _ = writeln!(out, "{}", line.trim_end());
    }
    axis(out, board, margin + 2, wide);
    if !unseen.is_empty() {
        let _ = writeln!(out, "{UNKNOWN} unknown");
    }
}

fn cell(line: &mut String, letter: char, sign: Option<&Sign>, wide: bool, style: TextStyle) {
    let (text, color) = match sign {
        // Room for all: the letter only where it says more than that the cell is free.
        Some(sign) if wide => {
            let letter = Some(letter).filter(|letter| *letter != '.');
            let visits = (sign.visits > 1).then(|| count(sign.visits));
            (letter.into_iter().chain([sign.arrow]).chain(visits).collect(), PATH)
        }
        Some(sign) if sign.end && letter != '.' && sign.arrow != 'X' => (letter.to_string(), PATH),
        Some(sign) if sign.visits > 1 && !sign.end => (AGAIN.to_string(), PATH),
        Some(sign) => (sign.arrow.to_string(), PATH),
        None if letter == '#' || letter == UNKNOWN => (letter.to_string(), OBSTACLE),
        None if letter != '.' => (letter.to_string(), MARKED),
        None => (letter.to_string(), ""),
    };
    let shown = text.chars().count();
    if style.color && !color.is_empty() {
        let _ = write!(line, "{color}{text}{RESET}");
    } else {
        line.push_str(&text);
    }
    line.push_str(if wide { "   ".get(shown..).unwrap_or("") } else { "" });
}

/// How often, as a small digit.
fn count(visits: usize) -> char {
    ['²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'].get(visits - 2).copied().unwrap_or('⁺')
}

/// The values of `x`: under each cell, or where cells are narrow under every tenth; left out where there is no room.
fn axis(out: &mut String, board: &Board, margin: usize, wide: bool) {
    let (every, pitch) = if wide { (1, 3) } else { (10, 1) };
    let mut line = String::new();
    for x in (0..board.width).step_by(every) {
        let column = margin + x as usize * pitch;
        if line.len() < column {
            let value = board.origin.0 + i64::from(x);
            line.extend(std::iter::repeat_n(' ', column - line.len()));
            let _ = write!(line, "{value}");
        }
    }
    let _ = writeln!(out, "{line}");
}

/// What the letters say; `S` and `G` for start and goal need no words.
fn legend(out: &mut String, board: &Board) {
    let known = |mark: &Mark| matches!((mark.label.as_str(), mark.letter), ("start", 'S') | ("goal", 'G'));
    let unknown = board.marks.iter().filter(|mark| !known(mark));
    let words: Vec<String> = unknown.map(|m| format!("{} {}", m.letter, m.label)).collect();
    if !words.is_empty() {
        let _ = writeln!(out, "{}", words.join(", "));
    }
    if let Some(scale) = board.scale() {
        let _ = writeln!(out, "{scale}");
    }
}
