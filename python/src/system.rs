//! Systems from Python: graphs, grids, and what is written.

use crate::error::raised;
use crate::problem::Problem;
use hyperplan::{Cell, Grid};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// States and transitions that are listed one by one.
#[pyclass(module = "hyperplan._native")]
#[derive(Default)]
pub(crate) struct Graph(hyperplan::Graph);

#[pymethods]
impl Graph {
    #[new]
    fn new() -> Graph {
        Graph::default()
    }

    fn state(&mut self, name: String) -> usize {
        self.0.state(name)
    }

    fn edge(&mut self, start: usize, action: String, end: usize, attributes: Vec<(String, i64)>) {
        let attributes: Vec<(&str, i64)> = attributes.iter().map(|(name, n)| (name.as_str(), *n)).collect();
        self.0.edge(start, action, end, &attributes);
    }

    fn initial(&mut self, state: usize) {
        self.0.initial(state);
    }

    fn label(&mut self, name: &str, states: Vec<usize>) {
        self.0.label(name, states);
    }

    fn place(&mut self, state: usize, x: f64, y: f64) {
        self.0.place(state, x, y);
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }
}

/// A system, to which items of the problem language are added.
#[pyclass(from_py_object, module = "hyperplan._native")]
#[derive(Clone)]
pub(crate) struct System(hyperplan::System);

/// A resolution, and `x`, `y` and the angle of the origin.
type Place = (f64, (f64, f64, f64));

/// Bytes of a coordinate.
const WORD: usize = size_of::<u32>();

#[pymethods]
impl System {
    #[staticmethod]
    fn variables() -> System {
        System(hyperplan::System::new())
    }

    #[staticmethod]
    fn graph(graph: &Graph) -> System {
        System(hyperplan::System::graph(graph.0.clone()))
    }

    #[staticmethod]
    fn graph_file(contents: &[u8]) -> System {
        System(hyperplan::System::graph_file(contents))
    }

    /// Cells are a byte each, 0 free, 1 an obstacle, 2 unknown, row 0 at the bottom; labels have pairs of 32-bit numbers.
    #[staticmethod]
    fn grid(
        width: usize,
        cells: &Bound<'_, PyBytes>,
        place: Option<Place>,
        labels: Vec<(String, Bound<'_, PyBytes>)>,
    ) -> PyResult<System> {
        let cells = cells.as_bytes();
        if width == 0 || cells.is_empty() || cells.len() % width != 0 {
            return Err(PyValueError::new_err("a grid has rows of the same length, and one cell at least"));
        }
        let cell = |x: usize, y: usize| match cells[y * width + x] {
            0 => Cell::Free,
            1 => Cell::Obstacle,
            _ => Cell::Unknown,
        };
        let mut grid = Grid::new(width, cells.len() / width, cell);
        if let Some((resolution, (x, y, angle))) = place {
            grid = grid.place(resolution, [x, y, angle]);
        }
        for (name, pairs) in labels {
            let number = |bytes: &[u8]| bytes.try_into().map(u32::from_ne_bytes).unwrap_or_default();
            let pairs = pairs.as_bytes().chunks_exact(2 * WORD);
            grid = grid.label(&name, pairs.map(|pair| (number(&pair[..WORD]), number(&pair[WORD..]))));
        }
        Ok(System(hyperplan::System::grid(grid)))
    }

    /// One with one more item.
    fn item(&self, text: &str) -> System {
        System(self.0.clone().item(text))
    }
}

/// A problem of a text, constants, systems and objectives.
#[pyfunction]
#[pyo3(signature = (name, text, folder, files, constants, systems, objectives))]
#[allow(clippy::too_many_arguments, reason = "they are put together in Python")]
pub(crate) fn build(
    py: Python<'_>,
    name: Option<String>,
    text: String,
    folder: Option<String>,
    files: Vec<(String, Vec<u8>)>,
    constants: Vec<(String, String)>,
    systems: Vec<(String, System)>,
    objectives: Vec<(String, String)>,
) -> PyResult<Problem> {
    let built = py.detach(move || {
        let mut builder = hyperplan::Problem::builder().text(text);
        if let Some(name) = name {
            builder = builder.name(name);
        }
        if let Some(folder) = folder {
            builder = builder.folder(folder);
        }
        builder = files.into_iter().fold(builder, |builder, (name, bytes)| builder.file(name, bytes));
        builder = constants.iter().fold(builder, |builder, (name, value)| builder.constant(name, value));
        builder =
            systems.into_iter().fold(builder, |builder, (name, system)| builder.system(&name, system.0));
        builder = objectives.iter().fold(builder, |builder, (name, text)| builder.objective(name, text));
        builder.build()
    });
    built.map(Problem::new).map_err(|error| raised(py, &error))
}
