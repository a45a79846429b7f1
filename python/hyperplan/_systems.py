"""Systems from graphs, grids, functions, and expressions of the problem language."""

from __future__ import annotations

import json
import warnings
from typing import TYPE_CHECKING, Any, Callable, Hashable, Iterable, Mapping

from . import _native

if TYPE_CHECKING:
    import networkx as nx
    import numpy.typing as npt

#: States that a transition function may have, unless more are allowed.
_STATES = 1_000_000

#: What `GetMap` of ROS takes to be occupied, in percent, and from where on cells are free.
_OCCUPIED = 65
_FREE = 19.6


class System:
    """A system. Items of the problem language are added by methods, each of which gives another system."""

    def __init__(
        self, native: _native.System | None = None, states: Mapping[str, Hashable] | None = None
    ) -> None:
        self._native = _native.System.variables() if native is None else native
        #: What the names of a graph's nodes stand for, where they were made of other things.
        self.states: Mapping[str, Hashable] = {} if states is None else states

    @classmethod
    def from_networkx(cls, graph: "nx.Graph[Any]") -> System:
        """The nodes and edges of a graph. What is `True` of a node is a label, and so is each word of its `labels`; `pos`, or
        `x` and `y`, say where it lies. The integers of edges are attributes, for `cost` and `also`; an edge's `id` is the name
        of its action, which is otherwise `go_TARGET`. Edges of undirected graphs lead both ways. Paths may begin at every
        node, unless `init` says where."""
        import networkx

        with warnings.catch_warnings():
            # Its versions differ in what they call edges, and some say so; the language knows both.
            warnings.simplefilter("ignore", FutureWarning)
            data = networkx.node_link_data(graph)
        names = {_node_name(node): node for node in graph.nodes}
        if len(names) < len(graph.nodes):
            raise ValueError("several nodes of the graph have the same name")
        return cls(_native.System.graph_file(json.dumps(data, default=_plain).encode()), names)

    @classmethod
    def from_grid(
        cls,
        grid: "npt.ArrayLike",
        labels: Mapping[str, Any] | None = None,
        *,
        resolution: float | None = None,
        origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
        row0: str = "top",
    ) -> System:
        """An occupancy grid, whose moves are `up`, `down`, `left` and `right`: its variables `x` and `y` count from the left
        and from the bottom. Booleans say where obstacles are; integers are those of ROS (0 free to 100 occupied, -1
        unknown), fractions are probabilities, of which NaN is unknown. `row0` says where the first row of the array is: at
        the "top", as pictures have it, or at the "bottom", as ROS does. A label is a list of cells `(x, y)`, or an array of
        Booleans like the grid. `resolution` is the side of a cell in metres, `origin` the lower left corner."""
        import numpy as np

        if row0 not in ("top", "bottom"):
            raise ValueError('row0 is "top" or "bottom"')
        cells = _occupancy(np.asarray(grid))
        height, width = cells.shape
        upward = cells if row0 == "bottom" else cells[::-1]
        place = None if resolution is None else (float(resolution), tuple(map(float, origin)))
        pairs = [(name, _pairs(where, cells.shape, row0)) for name, where in (labels or {}).items()]
        native = _native.System.grid(width, upward.tobytes(), place, pairs)
        return cls(native)

    @classmethod
    def from_function(
        cls,
        initial: Iterable[Hashable],
        steps: Callable[[Any], Iterable[tuple[str, Hashable]]],
        labels: Mapping[str, Callable[[Any], bool]] | None = None,
        *,
        limit: int = _STATES,
    ) -> System:
        """The states that are reached from the initial ones: `steps(state)` gives pairs of an action and the next state,
        several with one action where that is not deterministic, and is asked once for each state. A label is a
        function too, which says of a state whether it holds there."""
        graph = _native.Graph()
        names: dict[str, Hashable] = {}
        numbers: dict[Hashable, int] = {}
        work: list[Hashable] = []

        def number(state: Hashable) -> int:
            known = numbers.get(state)
            if known is not None:
                return known
            if len(numbers) >= limit:
                raise ValueError(f"more than {limit} states are reached; `limit` allows more")
            name = _node_name(state)
            if name in names:
                raise ValueError(f"two states are called {name!r}: give them different `str`")
            names[name] = state
            numbers[state] = graph.state(name)
            work.append(state)
            return numbers[state]

        for state in initial:
            graph.initial(number(state))
        if not numbers:
            raise ValueError("there is no initial state")
        while work:
            state = work.pop()
            for action, to in steps(state):
                graph.edge(numbers[state], action, number(to), [])
        for name, holds in (labels or {}).items():
            graph.label(name, [own for state, own in numbers.items() if holds(state)])
        return cls(_native.System.graph(graph), names)

    def item(self, text: str) -> System:
        """One more item, as the problem language has it: `edge stay;`."""
        return System(self._native.item(text), self.states)

    def state(self, name: str, type: str) -> System:
        """A variable: its type is `bool`, `0..9`, `{a, b}`, `int` or `real`."""
        return self.item(f"state {name}: {type};")

    def actions(self, *names: str) -> System:
        """Actions."""
        return self.item(f"action {', '.join(names)};")

    def on(self, actions: str, updates: str = "", when: str = "true") -> System:
        """What actions do, and when: `on("left", "x' = x - 1;", when="x > 0")`."""
        return self.item(f"on {actions} when {when} {{ {updates} }}")

    def init(self, expr: str) -> System:
        """Where paths begin."""
        return self.item(f"init {expr};")

    def label(self, name: str, expr: str) -> System:
        """A name for the states where an expression holds."""
        return self.item(f"label {name} = {expr};")

    def cost(self, name: str, expr: str) -> System:
        """What a step costs."""
        return self.item(f"cost {name} = {expr};")

    def observe(self, expr: str) -> System:
        """What others see of a state."""
        return self.item(f"observe {expr};")

    def absorb(self, expr: str) -> System:
        """Where nothing changes any more."""
        return self.item(f"absorb {expr};")


def _node_name(node: Hashable) -> str:
    """As the problem language names a node: parts of tuples are joined by commas."""
    if isinstance(node, tuple):
        return ",".join(_node_name(part) for part in node)
    return str(node)


def _plain(value: Any) -> Any:
    """Numbers and arrays of NumPy as JSON has them; sets as lists."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, (set, frozenset)):
        return sorted(value)
    return str(value)


def _occupancy(grid: Any) -> Any:
    """A byte for each cell: 0 free, 1 an obstacle, 2 unknown."""
    import numpy as np

    if grid.ndim != 2 or grid.size == 0:
        raise ValueError(f"an occupancy grid has two dimensions and a cell at least, not the shape {grid.shape}")
    if grid.dtype == np.bool_:
        return grid.astype(np.uint8)
    if np.issubdtype(grid.dtype, np.integer):
        if grid.size and (grid.min() < -1 or grid.max() > 100):
            raise ValueError("integers in an occupancy grid are -1 (unknown) to 100 (occupied)")
        cells = np.full(grid.shape, 2, dtype=np.uint8)
        cells[(grid >= 0) & (grid < _FREE)] = 0
        cells[grid > _OCCUPIED] = 1
        return cells
    if np.issubdtype(grid.dtype, np.floating):
        cells = np.full(grid.shape, 2, dtype=np.uint8)
        cells[grid < _FREE / 100] = 0
        cells[grid > _OCCUPIED / 100] = 1
        return cells
    raise ValueError(f"an occupancy grid has Booleans, integers or probabilities, not {grid.dtype}")


def _pairs(where: Any, shape: tuple[int, int], row0: str) -> bytes:
    """The cells of a label as pairs of 32-bit numbers."""
    import numpy as np

    array = np.asarray(where if hasattr(where, "dtype") else list(where))
    if array.dtype == np.bool_:
        if array.shape != shape:
            raise ValueError(f"a label's array has the shape {array.shape}, not the grid's {shape}")
        rows, columns = np.nonzero(array)
        rows = rows if row0 == "bottom" else shape[0] - 1 - rows
        array = np.stack([columns, rows], axis=1)
    if array.size == 0:
        return b""
    if array.ndim != 2 or array.shape[1] != 2 or not np.issubdtype(array.dtype, np.integer):
        raise ValueError("a label is a list of cells (x, y), or an array of Booleans")
    height, width = shape
    if array.min() < 0 or array[:, 0].max() >= width or array[:, 1].max() >= height:
        raise ValueError(f"a label has a cell that is not in the grid of {width} x {height}")
    return bytes(np.ascontiguousarray(array, dtype=np.uint32).tobytes())
