//! Systems as items of the problem language.

use super::{Graph, Grid};

/// A system that is built in code: of variables, or of a graph or a grid with more items. Expressions are those of the
/// problem language.
#[derive(Clone, Debug, Default)]
pub struct System {
    base: Base,
    items: Vec<String>,
}

#[derive(Clone, Debug, Default)]
enum Base {
    #[default]
    Variables,
    Graph(Graph),
    GraphFile(Vec<u8>),
    Grid(Grid),
}

/// A file that the text names.
pub(super) type File = (String, Vec<u8>);

impl System {
    /// One without variables and actions yet.
    #[must_use]
    pub fn new() -> System {
        System::default()
    }

    /// The states and transitions of a graph; its variable is `node`.
    #[must_use]
    pub fn graph(graph: Graph) -> System {
        System { base: Base::Graph(graph), items: Vec::new() }
    }

    /// A graph as a file has it, in one of the formats that the language reads: node-link JSON of networkx, GraphML, a route
    /// graph of Nav2, or its own.
    #[must_use]
    pub fn graph_file(contents: impl Into<Vec<u8>>) -> System {
        System { base: Base::GraphFile(contents.into()), items: Vec::new() }
    }

    /// The cells of a grid and moves between them; its variables are `x` and `y`.
    #[must_use]
    pub fn grid(grid: Grid) -> System {
        System { base: Base::Grid(grid), items: Vec::new() }
    }

    /// Any item as it is written, such as `edge stay;`.
    #[must_use]
    pub fn item(mut self, item: impl Into<String>) -> System {
        self.items.push(item.into());
        self
    }

    /// `state NAME: TYPE;`, where the type is `bool`, `LO..HI`, `{a, b}`, `int` or `real`.
    #[must_use]
    pub fn state(self, name: &str, ty: &str) -> System {
        self.item(format!("state {name}: {ty};"))
    }

    /// `action NAME, ...;`
    #[must_use]
    pub fn actions<'a>(self, names: impl IntoIterator<Item = &'a str>) -> System {
        self.item(format!("action {};", names.into_iter().collect::<Vec<_>>().join(", ")))
    }

    /// `on ACTIONS when GUARD { UPDATES }`: the actions are one, several with `|`, or `*`; an update is `x' = x + 1;`.
    #[must_use]
    pub fn on(self, actions: &str, guard: &str, updates: &str) -> System {
        self.item(format!("on {actions} when {guard} {{ {updates} }}"))
    }

    /// `init EXPR;`
    #[must_use]
    pub fn init(self, expr: &str) -> System {
        self.item(format!("init {expr};"))
    }

    /// `label NAME = EXPR;`
    #[must_use]
    pub fn label(self, name: &str, expr: &str) -> System {
        self.item(format!("label {name} = {expr};"))
    }

    /// `cost NAME = EXPR;`
    #[must_use]
    pub fn cost(self, name: &str, expr: &str) -> System {
        self.item(format!("cost {name} = {expr};"))
    }

    /// `observe EXPR;`
    #[must_use]
    pub fn observe(self, expr: &str) -> System {
        self.item(format!("observe {expr};"))
    }

    /// `absorb EXPR;`
    #[must_use]
    pub fn absorb(self, expr: &str) -> System {
        self.item(format!("absorb {expr};"))
    }

    /// The declaration, and the files that it names; or why there is none.
    pub(super) fn written(self, name: &str) -> Result<(String, Vec<File>), String> {
        let System { base, mut items } = self;
        let (head, files) = match base {
            Base::Variables => (format!("system {name}"), Vec::new()),
            Base::Graph(graph) => {
                let file = format!("{name}.json");
                (format!("system {name} = graph(\"{file}\")"), vec![(file, graph.json()?)])
            }
            Base::GraphFile(contents) => {
                let file = format!("{name}.graph");
                (format!("system {name} = graph(\"{file}\")"), vec![(file, contents)])
            }
            Base::Grid(grid) => {
                let (file, picture) = (format!("{name}.yaml"), format!("{name}.pgm"));
                let head = format!("system {name} = grid(\"{file}\")");
                items.extend(grid.labels());
                (head, vec![(file, grid.yaml(&picture)), (picture, grid.pgm())])
            }
        };
        let items: String = items.iter().map(|item| format!("  {item}\n")).collect();
        Ok((format!("{head} {{\n{items}}}"), files))
    }
}
