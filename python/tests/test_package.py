"""The package as it is installed: what is asked in Python is answered as the command answers it."""

import functools
import itertools
import json
import os
import random
import signal
import subprocess
import sys
import threading
import time
from fractions import Fraction

import pytest

import hyperplan
from hyperplan import Problem, System

LINE = """
const T = 3;
system Line {
  state x: 0..3;
  action left, right;
  on left  { x' = x - 1; }
  on right { x' = x + 1; }
  init x == 0;
}
objective end { exists p. F[0,T] x[p] == 3 }
"""

# Two players and many states: this takes long.
HARD = """
system Big {
  state a: 0..60, b: 0..60, c: 0..60, d: bool;
  action u, v, w, z;
  on u { a' in {a + 1, a}; }
  on v { b' in {b + 1, b}; c' = if c == 60 then 0 else c + 1; }
  on w when a == b { c' in 0..60; }
  on z { d' = !d; a' = if a == 60 then 0 else a + 1; }
  init a == 0 & b == 0;
}
objective hard {
  exists p, s. forall q. exists r.
    F[0,24] (a[p] == 9 & b[q] != c[r] & a[s] != a[p]) & (G[0,24] action[q] == action[p] -> G[0,20] (c[r] != c[q] | d[p]))
}
"""


def test_a_plan_from_text():
    result = Problem.from_text(LINE).solve()
    assert result and result.verdict == "realizable"
    path = result["p"]
    assert path.actions == ["right"] * 3
    assert path.states == [{"x": x} for x in range(4)]
    assert path.name == "p" and path.system == "Line" and len(path) == 3
    assert result.to_dict()["verified"] == "by-search"
    assert [p.name for p in result] == ["p"]


def test_paths_are_arrays():
    numpy = pytest.importorskip("numpy")
    path = Problem.from_text(LINE).solve()["p"]
    assert numpy.array_equal(path.array("x"), [[0], [1], [2], [3]])
    assert path.positions is None


def test_constants():
    problem = Problem.from_text(LINE)
    assert problem.constants == {"T": 3}
    assert problem.with_constants(T=2).solve().verdict == "unrealizable"
    least = problem.with_constants(T=9).minimize("T")
    assert (least.value, least.proved) == (3, True)
    assert least.problem.constants == {"T": 3} and least.result["p"].actions == ["right"] * 3
    half = Problem.from_text(LINE.replace("const T = 3;", "const T = 3; const H = 1/2;"))
    assert half.with_constants(H=0.25).constants["H"] == Fraction(1, 4)


def test_errors_have_places_and_hints():
    with pytest.raises(hyperplan.ProblemError) as raised:
        Problem.from_text(LINE.replace("x[p] == 3", "y[p] == 3"))
    error = raised.value
    assert (error.line, error.code) == (10, error.faults[0]["code"])
    assert error.column == 34 and "y" in str(error) and error.faults[0]["span"]["line"] == 10
    with pytest.raises(hyperplan.ProblemError) as raised:
        Problem.from_text(LINE).solve("none")
    assert raised.value.code == "no-objective"
    with pytest.raises(FileNotFoundError):
        hyperplan.load("there/is/none.hp")
    with pytest.raises(hyperplan.SolverError) as raised:
        Problem.from_text(LINE).solve(solver="no-such-solver-anywhere")
    assert raised.value.code == "solver-failed"
    with pytest.raises(ValueError):
        Problem.from_text(LINE).solve(timeout=-1)


def test_verification():
    problem = Problem.from_text(LINE)
    result = problem.solve()
    assert problem.verify(result)
    assert problem.verify(result.paths, "end")
    assert problem.verify({"p": ["right", "right", "right"]})
    fails = problem.verify({"p": ["right", "right", "left"]})
    assert not fails and fails.verdict == "fails" and fails.reason
    assert problem.verify(json.dumps(result.to_dict()))
    with pytest.raises(hyperplan.StrategyError):
        problem.verify({"p": ["left"]})
    with pytest.raises(hyperplan.StrategyError):
        problem.verify({"p": ["no-such-action"]})


def test_horizon_and_benchmark():
    problem = Problem.from_text(LINE)
    assert problem.horizon()["p"]["steps"] == 3
    text = problem.emit(date="2026-01-31", status="sat")
    assert "(check-sat)" in text and "(set-info :status sat)" in text
    assert problem.emit(date="2026-01-31", status="sat") == text


def test_systems_of_variables_and_functions_agree():
    chance = random.Random(7)
    for _ in range(12):
        width, height = chance.randint(2, 5), chance.randint(2, 5)
        walls = {(x, y) for x, y in itertools.product(range(width), range(height)) if chance.random() < 0.3}
        walls -= {(0, 0), (width - 1, height - 1)}
        goal = (width - 1, height - 1)

        def steps(cell):
            for action, (dx, dy) in {"up": (0, 1), "down": (0, -1), "left": (-1, 0), "right": (1, 0)}.items():
                to = (cell[0] + dx, cell[1] + dy)
                if 0 <= to[0] < width and 0 <= to[1] < height and to not in walls:
                    yield action, to
            yield "stay", cell

        function = System.from_function([(0, 0)], steps, {"goal": lambda cell: cell == goal})
        numpy = pytest.importorskip("numpy")
        grid = numpy.zeros((height, width), dtype=bool)
        for x, y in walls:
            grid[y, x] = True
        cells = System.from_grid(grid, {"goal": [goal], "start": [(0, 0)]}, row0="bottom")
        cells = cells.item("moves up, down, left, right, stay;").init("start")
        answers = []
        for system in (function, cells):
            problem = Problem.build({"World": system}, {"o": "exists p. F[0,T] goal[p]"}, {"T": width * height})
            least = problem.minimize("T")
            answers.append((least.value, least.result.verdict))
        # The shortest way, found by a search of our own.
        reached, front, steps_taken = {(0, 0)}, [(0, 0)], 0
        while front and goal not in reached:
            front = [to for cell in front for _, to in steps(cell) if to not in reached]
            front = list(dict.fromkeys(front))
            reached.update(front)
            steps_taken += 1
        expected = (steps_taken, "realizable") if goal in reached else (None, "unrealizable")
        assert answers == [expected, expected], (width, height, walls)


def test_a_function_gives_its_states_back():
    system = System.from_function([("a", 0)], lambda s: [("go", ("b", s[1] + 1))] if s[1] < 3 else [("go", s)])
    problem = Problem.build({"S": system}, {"o": "exists p. F[3,3] node[p] == \"b,3\""})
    assert problem.solve()["p"].nodes == [("a", 0), ("b", 1), ("b", 2), ("b", 3)]
    with pytest.raises(ValueError, match="limit"):
        System.from_function([0], lambda n: [("go", n + 1)], limit=10)
    with pytest.raises(ZeroDivisionError):
        System.from_function([0], lambda n: [("go", n / 0)])


def test_networkx():
    networkx = pytest.importorskip("networkx")
    roads = networkx.Graph()
    roads.add_node("gate", pos=(0.0, 0.0), start=True)
    roads.add_node("ramp", pos=(4.0, 0.0))
    roads.add_node(("hall", 2), pos=(4.0, 3.0), labels=["goal"])
    roads.add_edge("gate", "ramp", metres=4)
    roads.add_edge("ramp", ("hall", 2), metres=3, id="lift")
    roads.add_edge("gate", ("hall", 2), metres=9)
    system = System.from_networkx(roads).actions("wait").on("wait").init("start").cost("way", "metres")
    problem = Problem.build({"Yard": system}, {"o": "exists p. F[0,3] goal[p] minimize cost way[p];"})
    result = problem.solve()
    assert result.costs[0]["value"] == result.costs[0]["least"] == 7
    assert result["p"].nodes[:3] == ["gate", "ramp", ("hall", 2)]
    assert result["p"].positions[2].tolist() == [4.0, 3.0]


@pytest.mark.parametrize("kind", ["bool", "int8", "float"])
def test_occupancy_grids_of_any_kind(kind):
    numpy = pytest.importorskip("numpy")
    walls = numpy.array([[0, 0, 0], [1, 1, 0], [0, 0, 0]], dtype=bool)
    grid = {"bool": walls, "int8": (walls * 100).astype("int8"), "float": walls * 0.9}[kind]
    goal = numpy.array([[1, 0, 0], [0, 0, 0], [0, 0, 0]], dtype=bool)
    system = System.from_grid(grid, {"goal": goal, "start": [(0, 0)]}, resolution=0.5).absorb("goal")
    problem = Problem.build({"M": system}, {"o": "exists p. start[p] & F[0,T] goal[p]"}, {"T": 9})
    least = problem.minimize("T")
    assert least.value == 6
    assert least.result["p"].positions[0].tolist() == [0.25, 0.25]
    if kind == "int8":
        unknown = grid.copy()
        unknown[1, 2] = -1
        assert System.from_grid(unknown)
        with pytest.raises(ValueError, match="-1"):
            System.from_grid(grid.astype(int) * 2)


def test_a_large_grid_passes_at_once():
    numpy = pytest.importorskip("numpy")
    grid = numpy.random.default_rng(1).random((512, 512)) < 0.2
    times = []
    for _ in range(3):
        start = time.perf_counter()
        system = System.from_grid(grid, {"goal": [(500, 500)]})
        times.append(time.perf_counter() - start)
        assert system is not None
    # The package of the tests is not optimised.
    assert min(times) < 0.5, times


def test_deadlines_hold():
    start = time.perf_counter()
    try:
        result = Problem.from_text(HARD).solve(timeout=0.5)
        assert result.verdict == "unknown" and result.reason_code == "timeout"
    except hyperplan.HyperplanError as error:
        assert error.code in ("timeout", "interrupted")
    assert time.perf_counter() - start < 5


def test_other_threads_go_on():
    ticks, done = [0], threading.Event()

    def count():
        while not done.is_set():
            ticks[0] += 1
            time.sleep(0.005)

    thread = threading.Thread(target=count)
    thread.start()
    try:
        Problem.from_text(HARD).solve(timeout=0.5)
    except hyperplan.HyperplanError:
        pass
    finally:
        done.set()
        thread.join()
    assert ticks[0] > 20


def test_progress_is_told():
    told = []
    try:
        Problem.from_text(HARD).solve(timeout=0.6, progress=told.append, every=0.05)
    except hyperplan.HyperplanError:
        pass
    assert told and all(set(facts) == {"words", "checks", "variables", "best"} for facts in told)


@pytest.mark.skipif(os.name != "posix", reason="signals are those of POSIX")
def test_ctrl_c_ends_a_search():
    code = f"import hyperplan\nprint('begun', flush=True)\nhyperplan.Problem.from_text({HARD!r}).solve()"
    # What a shell begins in the background ignores the signal, and so do its children, if they are not told otherwise.
    heed = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    running = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=heed
    )
    assert running.stdout.readline().strip() == b"begun"
    time.sleep(0.7)
    assert running.poll() is None, "the search was to take longer"
    start = time.perf_counter()
    running.send_signal(signal.SIGINT)
    _, words = running.communicate(timeout=20)
    assert time.perf_counter() - start < 5
    assert b"KeyboardInterrupt" in words


def test_notebooks_show_pictures_and_tables():
    problem = Problem.from_text(LINE)
    result = problem.solve()
    shown = result._repr_html_()
    assert "<table>" in shown and "realizable" in shown and "<script" not in shown
    assert result._repr_svg_().startswith("<svg")
    assert result["p"]._repr_html_().count("<tr>") == 5
    numpy = pytest.importorskip("numpy")
    grid = System.from_grid(numpy.zeros((2, 2), dtype=bool))
    assert Problem.build({"G": grid}, {"o": "exists p. F[0,1] x[p] == 1"})._repr_svg_().startswith("<svg")
    assert result.picture("png").startswith(b"\x89PNG")
    with pytest.raises(ValueError):
        result.picture("bmp")


def test_matplotlib(tmp_path):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    numpy = pytest.importorskip("numpy")
    grid = System.from_grid(numpy.zeros((3, 3), dtype=bool), {"goal": [(2, 2)]}).absorb("goal")
    result = Problem.build({"G": grid}, {"o": "exists p. F[0,4] goal[p]"}).solve()
    axes = result.plot()
    axes.figure.savefig(tmp_path / "plan.png")
    assert (tmp_path / "plan.png").stat().st_size > 1000
    with pytest.raises(ValueError):
        Problem.from_text(LINE.replace(" x", " z")).solve().plot()


def test_the_command_is_there(tmp_path):
    program = hyperplan.command()
    done = subprocess.run([str(program), "--version"], capture_output=True, text=True, check=True)
    assert done.stdout.split()[1] == hyperplan.__version__
    done = subprocess.run([sys.executable, "-m", "hyperplan", "--version"], capture_output=True, text=True)
    assert done.returncode == 0 and hyperplan.__version__ in done.stdout
    file = tmp_path / "line.hp"
    file.write_text(LINE)
    loaded = hyperplan.load(file)
    own = loaded.solve().to_dict()
    # Several processes of the command, which starts itself.
    done = subprocess.run(
        [str(program), "solve", str(file), "--format", "json", "--portfolio", "2"], capture_output=True, text=True
    )
    other = json.loads(done.stdout)
    assert done.returncode == 0
    assert [other[key] for key in ("verdict", "horizon")] == [own[key] for key in ("verdict", "horizon")]


def test_explanations():
    short = Problem.from_text(LINE).with_constants(T=2)
    explained = short.explain()
    assert explained.facts["verdict"] == "unrealizable" and "T" in explained.text
    assert explained._repr_html_().startswith("<pre>")
    problem = Problem.from_text(LINE)
    assert problem.explain(strategy=problem.solve()).facts["verdict"] == "holds"


def test_comparisons(tmp_path):
    runs = Problem.from_text(LINE).compare(["builtin", "batsat"], out=tmp_path / "runs")
    assert [(run["solver"], run["status"]) for run in runs] == [("builtin", "sat"), ("batsat", "sat")]


def chain(folder):
    """A model and a formula of another tool."""
    model = folder / "model.smv"
    model.write_text("MODULE main\nVAR b : boolean;\nASSIGN init(b) := FALSE; next(b) := !b;\n")
    formula = folder / "formula.hq"
    formula.write_text("exists A. G(b[A])\n")
    return model, formula


def test_files_of_other_tools(tmp_path):
    model, formula = chain(tmp_path)
    assert hyperplan.load(model, formula, bound=3).solve().verdict == "unrealizable"
    with pytest.raises(hyperplan.ProblemError) as raised:
        hyperplan.load(model, formula, semantics="pes")
    assert raised.value.code == "semantics-without-bound"
    formula.write_text("exists A. F(b[A])\n")
    assert hyperplan.load(model, formula, bound=3).solve().verdict == "realizable"


def test_what_was_not_built_in_python_is_explained_and_compared(tmp_path):
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "room.txt").write_text("..G\n.#.\nS..\n")
    text = """const T = 3;
    system Room = grid("maps/room.txt") {}
    objective o { exists p. start[p] & F[0,T] goal[p] }"""
    # The folder is given with the text, and is not where the problem is saved.
    for problem in (Problem.from_text(text, folder=tmp_path), hyperplan.load(*chain(tmp_path), bound=3)):
        assert problem.explain().facts["verdict"] == "unrealizable"
        assert [(run["status"], run["solver"]) for run in problem.compare()] == [("unsat", "builtin")]
    outside = tmp_path / "maps" / "room.txt"
    problem = Problem.from_text(text.replace("maps/room.txt", str(outside)), folder=tmp_path)
    with pytest.raises(OSError, match="not within its folder"):
        problem.explain()
