//! Maps for terminals.

use crate::board::{Board, Mark};
use crate::{Error, Scene, heading};
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

/// One map for each path, the bottom row last, with the axes' values; where there are no traces, the bare map. Paths of
/// systems that have no map are tables below.
///
/// An arrow shows how the path leaves the cell for the last time, so the arrows lead from its start to its end even
/// where it passes a cell twice; `*` is the end of the path, `X` a crash.
///
/// # Errors
/// If no system has a place in the plane.
pub fn text_map(scene: Scene<'_>, style: TextStyle) -> Result<String, Error> {
    let mut out = String::new();
    let boards = scene.boards();
    // Roadmaps are tables here.
    let boards = if scene.roadmaps()?.is_empty() { boards? } else { boards.unwrap_or_default() };
    for (system, board) in &boards {
        let traces = scene.traces_of(*system);
        if traces.is_empty() {
            draw(&mut out, board, &Vec::new(), style);
        }
        for (_, name, trace) in traces {
            if !out.is_empty() {
                out.push('\n');
            }
            let _ = writeln!(out, "{}", heading(name, trace));
            let arrows = arrows(board, &board.cells_of(trace), board.crash_time(trace).is_some());
            draw(&mut out, board, &arrows, style);
        }
        legend(&mut out, board);
    }
    let drawn: Vec<_> = boards.iter().map(|(system, _)| *system).collect();
    for (heading, table) in scene.tables(&drawn) {
        let _ = write!(out, "\n{heading}\n{table}");
    }
    Ok(out)
}

/// For each cell that the path passes, what to draw there.
fn arrows(board: &Board, cells: &[(u32, u32)], crashed: bool) -> Vec<((u32, u32), char)> {
    let mut drawn: Vec<Option<char>> = vec![None; board.width as usize * board.height as usize];
    let index = |(x, y): (u32, u32)| y as usize * board.width as usize + x as usize;
    for pair in cells.windows(2) {
        if pair[0] != pair[1] {
            drawn[index(pair[0])] = Some(arrow(pair[0], pair[1]));
        }
    }
    if let Some(last) = cells.last() {
        drawn[index(*last)] = Some(if crashed { 'X' } else { '*' });
    }
    let mut passed: Vec<(u32, u32)> = cells.to_vec();
    passed.sort_unstable();
    passed.dedup();
    passed.into_iter().filter_map(|c| drawn[index(c)].map(|a| (c, a))).collect()
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

fn draw(out: &mut String, board: &Board, arrows: &[((u32, u32), char)], style: TextStyle) {
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
    for y in (0..board.height).rev() {
        let mut line = format!("{:>margin$}  ", board.origin.1 + i64::from(y));
        for x in 0..board.width {
            let found = arrows.binary_search_by_key(&(x, y), |(c, _)| *c).ok().map(|i| arrows[i].1);
            cell(&mut line, letters[index(x, y)], found, wide, style);
        }
        let _ = writeln!(out, "{}", line.trim_end());
    }
    axis(out, board, margin + 2, wide);
}

fn cell(line: &mut String, letter: char, arrow: Option<char>, wide: bool, style: TextStyle) {
    let mut paint = |text: String, color: &str| {
        if style.color {
            let _ = write!(line, "{color}{text}{RESET}");
        } else {
            line.push_str(&text);
        }
    };
    match arrow {
        // Room for both: the letter only where it says more than that the cell is free.
        Some(arrow) if wide && letter != '.' => paint(format!("{letter}{arrow}"), PATH),
        Some(arrow) => paint(arrow.to_string(), PATH),
        None if letter == '#' => paint("#".to_owned(), OBSTACLE),
        None => line.push(letter),
    }
    let shown = if wide && arrow.is_some() && letter != '.' { 2 } else { 1 };
    line.push_str(if wide { &"   "[shown..] } else { "" });
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
