"""What the documentation shows: the blocks stand here as they stand there."""

import numpy, hyperplan
from hyperplan import Problem, System

room = System.from_grid(numpy.zeros((64, 64), dtype=bool), {"start": [(0, 0)], "goal": [(63, 63)]})
room = room.item("edge stay;").absorb("goal")
problem = Problem.build({"Room": room}, {"go": "exists p. start[p] & F[0,T] goal[p]"}, {"T": 130})
result = problem.solve(timeout=60)
print(result["p"].actions)

grid = numpy.zeros((64, 64), dtype=bool)
grid[20, 5:60] = True
room = System.from_grid(grid, {"start": [(0, 0)], "goal": [(63, 63)]}, resolution=0.05)
problem = Problem.build(
    {"Room": room.item("edge stay;").absorb("goal")},
    {"there": "exists p. start[p] & F[0,T] goal[p]"},
    {"T": 130},
)
least = problem.minimize("T")
print(least.value, least.result["p"].positions)


def test_what_was_found():
    assert result.verdict == "realizable"
    assert least.value == 126 and least.proved
    assert least.problem.verify(least.result)
    assert hyperplan.__version__
