"""What was found, for Python, notebooks and pictures."""

from __future__ import annotations

import html
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Hashable, Iterator, Mapping, Optional, Sequence

from . import _native

if TYPE_CHECKING:
    import numpy.typing as npt

#: Longer tables are cut in notebooks.
_ROWS = 60


class Path:
    """A path: its states, and the actions between them."""

    def __init__(self, facts: dict[str, Any], states: Mapping[str, Mapping[str, Hashable]] | None = None) -> None:
        self._facts = facts
        self._originals = (states or {}).get(facts.get("system", ""), {})

    @property
    def name(self) -> str:
        """The path variable."""
        return str(self._facts["path"])

    @property
    def system(self) -> str:
        """Its system."""
        return str(self._facts.get("system", ""))

    @property
    def actions(self) -> list[str]:
        """The actions; there is one more state."""
        return list(self._facts["actions"])

    @property
    def states(self) -> list[dict[str, Any]]:
        """The states: the value of each variable."""
        return [dict(state) for state in self._facts["states"]]

    @property
    def nodes(self) -> list[Hashable]:
        """Of a graph or a function: the nodes or states as they were given."""
        return [self._originals.get(state["node"], state["node"]) for state in self._facts["states"]]

    @property
    def positions(self) -> Optional["npt.NDArray[Any]"]:
        """Where the states are in the plane, if that is known: an array of two columns."""
        import numpy as np

        positions = self._facts.get("positions")
        return None if positions is None else np.asarray(positions, dtype=float)

    def array(self, *variables: str) -> "npt.NDArray[Any]":
        """The values of variables, of all or of some: a row a state, a column a variable."""
        import numpy as np

        states = self._facts["states"]
        names = variables or tuple(states[0]) if states else variables
        return np.array([[state[name] for name in names] for state in states])

    def _json(self) -> dict[str, Any]:
        return {key: self._facts[key] for key in ("path", "system", "actions", "states") if key in self._facts}

    def __len__(self) -> int:
        return len(self._facts["actions"])

    def __repr__(self) -> str:
        return f"<hyperplan.Path {self.name}: {' '.join(self.actions)}>"

    def _rows(self) -> str:
        states, actions = self._facts["states"][:_ROWS], self._facts["actions"]
        names = list(states[0]) if states else []
        head = "".join(f"<th>{html.escape(name)}</th>" for name in ("step", *names, "action"))
        rows = []
        for time, state in enumerate(states):
            action = actions[time] if time < len(actions) else ""
            cells = (time, *(state[name] for name in names), action)
            rows.append("<tr>" + "".join(f"<td>{html.escape(str(cell))}</td>" for cell in cells) + "</tr>")
        more = len(self._facts["states"]) - len(states)
        rest = f"<tr><td colspan='{len(names) + 2}'>and {more} more</td></tr>" if more > 0 else ""
        return f"<table><caption>{html.escape(self.name)}</caption><tr>{head}</tr>{''.join(rows)}{rest}</table>"

    def _repr_html_(self) -> str:
        return self._rows()


class Result:
    """An answer for an objective. It is true where the objective is realizable."""

    def __init__(self, native: _native.Outcome, states: Mapping[str, Mapping[str, Hashable]]) -> None:
        self._native = native
        self._answer = native.answer()
        self._paths = [Path(path, states) for path in self._answer["witness"] or []]

    @property
    def objective(self) -> str:
        """The objective."""
        return str(self._answer["objective"])

    @property
    def verdict(self) -> str:
        """`realizable`, `unrealizable` or `unknown`."""
        return str(self._answer["verdict"])

    @property
    def reason(self) -> Optional[str]:
        """Why it is unknown, or what is remarkable about it."""
        return self._answer["reason"]  # type: ignore[no-any-return]

    @property
    def reason_code(self) -> Optional[str]:
        """The same in a word that stays what it is: `timeout`."""
        return self._answer["reason_code"]  # type: ignore[no-any-return]

    @property
    def paths(self) -> list[Path]:
        """The plan, or the counterexample."""
        return list(self._paths)

    @property
    def costs(self) -> list[dict[str, Any]]:
        """What was to be as small as possible: `expression`, `value`, and the `least` that there can be."""
        return list(self._answer.get("costs", []))

    def __getitem__(self, name: str) -> Path:
        for path in self._paths:
            if path.name == name:
                return path
        raise KeyError(name)

    def __iter__(self) -> Iterator[Path]:
        return iter(self._paths)

    def __bool__(self) -> bool:
        return self.verdict == "realizable"

    def to_dict(self) -> dict[str, Any]:
        """All of it, as `hyperplan solve --format json` prints it (`docs/answer.schema.json`)."""
        return dict(self._answer)

    def picture(self, kind: str = "svg") -> Optional[bytes]:
        """A picture of the paths, with the worst of all that they have to cope with: `svg`, `animated` (an SVG that moves),
        `png`, `pdf`, `gif`, `html` (a page with a slider) or `txt`. `None` where there are no paths."""
        return self._native.draw(kind)

    def plot(self, ax: Any = None) -> Any:
        """Draws the paths with matplotlib, where each state has a place or variables `x` and `y`. The axes."""
        import matplotlib.pyplot as plt

        axes = ax if ax is not None else plt.subplots()[1]
        for path in self._paths:
            points = path.positions
            if points is None and path.states and {"x", "y"} <= path.states[0].keys():
                points = path.array("x", "y")
            if points is None:
                raise ValueError(f"path {path.name} lies nowhere: its system has neither places nor x and y")
            axes.plot(points[:, 0], points[:, 1], marker="o", label=path.name)
        axes.set_aspect("equal")
        axes.legend()
        return axes

    def _repr_svg_(self) -> Optional[str]:
        try:
            drawn = self._native.draw("svg")
        except _native.HyperplanError:
            return None
        return None if drawn is None else drawn.decode()

    def _repr_html_(self) -> str:
        reason = "" if self.reason is None else f": {html.escape(self.reason)}"
        head = f"<p>{html.escape(self.objective)}: <b>{self.verdict}</b>{reason}</p>"
        picture = self._repr_svg_()
        return head + (picture or "") + "".join(path._rows() for path in self._paths)

    def __repr__(self) -> str:
        reason = "" if self.reason is None else f": {self.reason}"
        return f"<hyperplan.Result {self.objective}: {self.verdict}{reason}>"


@dataclass(frozen=True)
class Verification:
    """What the checker says of a strategy. It is true where the strategy holds."""

    #: `holds`, `fails` or `unknown`.
    verdict: str
    #: Why it fails, or is undecided.
    reason: Optional[str] = None
    #: Paths that defeat it, if that is why.
    paths: Sequence[Path] = field(default_factory=list)

    def __bool__(self) -> bool:
        return self.verdict == "holds"


@dataclass(frozen=True)
class Explanation:
    """Why an objective is unrealizable, or a strategy fails."""

    #: For people.
    text: str
    #: For programs, as `hyperplan explain --format json` has it.
    facts: dict[str, Any]

    def __str__(self) -> str:
        return self.text

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(self.text)}</pre>"
