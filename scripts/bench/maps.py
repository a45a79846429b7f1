"""The paper's case studies at any size, and large maps of rooms.

Everything but the shortest-path maps follows the rules by which the committed maps grow from 10 x 10 to 60 x 60, and
comes out the same there. The obstacles of the shortest-path maps are scattered: about as many as 40 throws of a cell
hit, at every size from 20 on. For the committed sizes those files are taken as they are; others are thrown
here, the same at every run.
"""

import collections
import pathlib
import random

SPECS = pathlib.Path(__file__).resolve().parents[2] / "specs" / "case-studies"
OBJECTIVES = ("sp", "isr", "ar", "iso", "cso")
COMMITTED = (10, 20, 40, 60)
THROWS = 40

Cell = tuple[int, int]  # column, row; row 0 is at the bottom


def scattered(size: int) -> set[Cell]:
    """The obstacles of a shortest-path map of a size that is not committed."""
    draw = random.Random(size)
    cells = {(draw.randrange(size), draw.randrange(size)) for _ in range(THROWS)}
    return cells - {(0, 0), (size - 3, size - 5)}


def ends(objective: str, size: int) -> tuple[set[Cell], set[Cell]]:
    """The start and the goal cells."""
    top, half = size - 1, size // 2
    if objective == "isr":
        return {(x, 0) for x in range(3)}, {(x, top) for x in range(size - 4, size - 1)}
    if objective == "ar":
        left = -(-2 * size // 3)
        return {(2, 0)}, {(x, y) for x in range(left, size) for y in range(size - 3, size)}
    if objective == "iso":
        return {(x, 0) for x in range(half)}, {(size - 2, top), (size - 1, top)}
    if objective == "cso":
        return {(x, 0) for x in range(half - 2, half + 2)}, {(x, top) for x in range(half - 3, half + 3)}
    return {(0, 0)}, {(size - 3, size - 5)}


def case_map(objective: str, size: int) -> str:
    """The map of a case study: by its rule, whatever is committed."""
    thrown = scattered(size) if objective == "sp" else set()
    starts, goals = ends(objective, size)

    def blocked(x: int, y: int) -> bool:
        if objective == "sp":
            return (x, y) in thrown
        if objective in ("isr", "ar"):
            return abs(x - y) >= 5  # beside a diagonal corridor
        return x % 4 < 2 and 2 <= y < size - 2  # in a column

    def letter(x: int, y: int) -> str:
        # An obstacle among the goals is drawn as an obstacle.
        if blocked(x, y):
            return "#"
        return "S" if (x, y) in starts else "G" if (x, y) in goals else "."

    rows = ("".join(letter(x, y) for x in range(size)) for y in reversed(range(size)))
    return "".join(row + "\n" for row in rows)


def case_study(objective: str, size: int, folder: pathlib.Path) -> pathlib.Path:
    """The problem file of a case study: the committed one, or one made in the folder."""
    if size in COMMITTED:
        return SPECS / f"{objective}-{size}.hp"
    text = (SPECS / f"{objective}-10.hp").read_text(encoding="utf-8")
    for old, new in (
        ("10 x 10: the map", f"{size} x {size}: the map, scaled,"),
        ("const T = 20;", f"const T = {2 * size};"),
        (f"maps/{objective}-10.map.txt", f"{objective}-{size}.map.txt"),
    ):
        if old not in text:
            raise ValueError(f"{objective}-10.hp no longer contains: {old}")
        text = text.replace(old, new)
    (folder / f"{objective}-{size}.map.txt").write_text(case_map(objective, size), encoding="utf-8")
    file = folder / f"{objective}-{size}.hp"
    file.write_text(text, encoding="utf-8")
    return file


def map_file(objective: str, size: int, folder: pathlib.Path) -> pathlib.Path:
    """The map of a case study, whose problem file was made in the folder if it is not committed."""
    return (SPECS / "maps" if size in COMMITTED else folder) / f"{objective}-{size}.map.txt"


def differences() -> list[str]:
    """Committed maps that their rule does not give."""
    wrong = []
    for objective in OBJECTIVES[1:]:
        for size in COMMITTED:
            committed = (SPECS / "maps" / f"{objective}-{size}.map.txt").read_text(encoding="utf-8")
            if committed != case_map(objective, size):
                wrong.append(f"{objective}-{size}")
    return wrong


def rooms(size: int, seed: int = 0, room: int = 7) -> list[str]:
    """A map of rooms, in rows from the top: walls of one cell, and a door in most of them, so that every room
    can be reached."""
    draw = random.Random(seed)
    pitch = room + 1
    count = size // pitch
    grid = [["@" if x % pitch == 0 or y % pitch == 0 else "." for x in range(size)] for y in range(size)]
    for i in range(size):
        grid[i][size - 1] = grid[size - 1][i] = "@"
    parent = list(range(count * count))

    def find(a: int) -> int:
        while parent[a] != a:
            parent[a] = parent[parent[a]]
            a = parent[a]
        return a

    walls = [(i, j, 1, 0) for i in range(count - 1) for j in range(count)]
    walls += [(i, j, 0, 1) for i in range(count) for j in range(count - 1)]
    draw.shuffle(walls)
    for i, j, right, down in walls:
        a, b = find(i + j * count), find(i + right + (j + down) * count)
        at = draw.randrange(1, room)
        if a == b and draw.random() < 0.5:
            continue
        parent[a] = b
        x = (i + 1) * pitch if right else i * pitch + at
        y = (j + 1) * pitch if down else j * pitch + at
        grid[y][x] = "."
    return ["".join(row) for row in grid]


def read_map(file: pathlib.Path) -> list[str]:
    """The rows of a map in the format of the Moving AI Lab, from the top."""
    lines = file.read_text(encoding="ascii").splitlines()
    if "map" not in lines[:8]:
        raise ValueError("it is no .map file, having no line `map`")
    return lines[lines.index("map") + 1 :]


def steps(rows: list[str], start: Cell) -> dict[Cell, int]:
    """How many moves to the four neighbours each cell takes from the start; cells here count from the top."""
    height, width = len(rows), len(rows[0])
    distance = {start: 0}
    queue = collections.deque([start])
    while queue:
        x, y = queue.popleft()
        for cell in ((x + 1, y), (x - 1, y), (x, y + 1), (x, y - 1)):
            inside = 0 <= cell[0] < width and 0 <= cell[1] < height
            if inside and rows[cell[1]][cell[0]] in ".GS" and cell not in distance:
                distance[cell] = distance[x, y] + 1
                queue.append(cell)
    return distance


def large(rows: list[str], folder: pathlib.Path) -> tuple[pathlib.Path, int, int]:
    """A shortest-path problem from the first free cell of a map to the last that can be reached from there: its file,
    the least number of steps, and the horizon, a tenth more."""
    height = len(rows)
    y, row = next((y, row) for y, row in enumerate(rows) if "." in row)
    start = (row.index("."), y)
    distance = steps(rows, start)
    goal = max(distance, key=lambda cell: (cell[1], cell[0]))
    least = distance[goal]
    horizon = least + -(-least // 10)
    header = f"type octile\nheight {height}\nwidth {len(rows[0])}\nmap\n"
    (folder / "large.map").write_text(header + "\n".join(rows) + "\n", encoding="ascii")
    at = [f"x == {cell[0]} & y == {height - 1 - cell[1]}" for cell in (start, goal)]
    file = folder / "large.hp"
    file.write_text(LARGE.format(horizon=horizon, start=at[0], goal=at[1]), encoding="utf-8")
    return file, least, horizon


LARGE = """const T = {horizon};

system World = grid("large.map") {{
  obstacle undefined;
  edge undefined;
  label start = {start};
  label goal = {goal};
  absorb goal;
}}

objective sp {{
  exists p. forall q.
    start[p] & F[0,T] goal[p] &
    (start[q] -> (!goal[q] U[0,T] goal[p]))
}}
"""
