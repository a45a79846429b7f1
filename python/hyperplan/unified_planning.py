"""An engine for unified-planning: plans without sensing, which have to work whatever is the case at first.

    >>> import hyperplan.unified_planning
    >>> hyperplan.unified_planning.register()
    >>> with OneshotPlanner(name="hyperplan", params={"steps": 20}) as planner:
    ...     result = planner.solve(problem)

A `ContingentProblem` without sensing actions is a conformant one: some facts are hidden, and one sequence of actions has to be
possible, and to lead to the goal, in every state that may be the first. A `Problem` has one such state.
"""

from __future__ import annotations

import time
import warnings
from typing import IO, Any, Callable, Iterator, Optional

import unified_planning.engines as engines
from unified_planning.engines.mixins import OneshotPlannerMixin
from unified_planning.engines.mixins.oneshot_planner import OptimalityGuarantee
from unified_planning.engines.results import LogLevel, LogMessage, PlanGenerationResult
from unified_planning.engines.results import PlanGenerationResultStatus as Status
from unified_planning.environment import Environment, get_environment
from unified_planning.exceptions import UPProblemDefinitionError
from unified_planning.model import Problem as Task
from unified_planning.model import ProblemKind
from unified_planning.plans import SequentialPlan

from ._conformant import Reading, unsupported
from ._native import HyperplanError, ProblemError
from ._problem import Problem

#: How long plans may be, if it is not said.
_STEPS = 64

#: What is left when the time is up, in seconds: the search says so then.
_LEAST = 0.001

_FEATURES = """
    ACTION_BASED CONTINGENT SIMPLE_NUMERIC_PLANNING GENERAL_NUMERIC_PLANNING FLAT_TYPING HIERARCHICAL_TYPING
    BOOL_FLUENT_PARAMETERS BOUNDED_INT_FLUENT_PARAMETERS BOOL_ACTION_PARAMETERS BOUNDED_INT_ACTION_PARAMETERS BOUNDED_TYPES
    INT_FLUENTS REAL_FLUENTS OBJECT_FLUENTS NEGATIVE_CONDITIONS DISJUNCTIVE_CONDITIONS EQUALITIES EXISTENTIAL_CONDITIONS
    UNIVERSAL_CONDITIONS CONDITIONAL_EFFECTS INCREASE_EFFECTS DECREASE_EFFECTS STATIC_FLUENTS_IN_BOOLEAN_ASSIGNMENTS
    STATIC_FLUENTS_IN_NUMERIC_ASSIGNMENTS STATIC_FLUENTS_IN_OBJECT_ASSIGNMENTS FLUENTS_IN_BOOLEAN_ASSIGNMENTS
    FLUENTS_IN_NUMERIC_ASSIGNMENTS FLUENTS_IN_OBJECT_ASSIGNMENTS FORALL_EFFECTS PLAN_LENGTH UNDEFINED_INITIAL_SYMBOLIC
"""


def register(environment: Optional[Environment] = None) -> None:
    """Makes the engine `hyperplan` known to an environment of unified-planning: the global one, if none is given."""
    factory = get_environment(environment).factory
    if "hyperplan" not in factory.engines:
        factory.add_engine("hyperplan", __name__, "Engine")


class Engine(engines.Engine, OneshotPlannerMixin):  # type: ignore[misc]
    """Finds sequential plans of at most `steps` actions, with any solver of hyperplan."""

    def __init__(self, *, steps: int = _STEPS, solver: str = "builtin") -> None:
        engines.Engine.__init__(self)
        OneshotPlannerMixin.__init__(self)
        if steps < 0:
            raise ValueError(f"a plan cannot have {steps} actions")
        self._steps = steps
        self._solver = solver

    @property
    def name(self) -> str:
        return "hyperplan"

    @staticmethod
    def supported_kind() -> ProblemKind:
        return ProblemKind(_FEATURES.split())

    @staticmethod
    def supports(problem_kind: ProblemKind) -> bool:
        return bool(problem_kind <= Engine.supported_kind())

    @staticmethod
    def satisfies(optimality_guarantee: OptimalityGuarantee) -> bool:
        # The only metric that is read is the length of plans.
        return True

    def _solve(
        self,
        problem: Task,
        heuristic: Optional[Callable[[Any], Optional[float]]] = None,
        timeout: Optional[float] = None,
        output_stream: Optional[IO[str]] = None,
    ) -> PlanGenerationResult:
        # Reading and grounding count, too.
        end = None if timeout is None else time.monotonic() + timeout
        if heuristic is not None:
            warnings.warn("hyperplan uses no heuristic of others")
        other = problem.kind.features - self.supported_kind().features
        if other:
            raise unsupported(", ".join(sorted(other)))
        reading = Reading(problem)
        try:
            task = Problem.from_text(reading.text(self._steps))
        except ProblemError as error:
            raise unsupported(f"hyperplan cannot take it: {error}") from error
        try:
            return self._search(task, reading, bool(problem.quality_metrics), end, output_stream)
        except HyperplanError as error:
            status = Status.TIMEOUT if error.code == "timeout" else Status.INTERNAL_ERROR
            return self._answer(status, why=str(error))

    def _search(
        self, task: Problem, reading: Reading, shortest: bool, end: Optional[float], stream: Optional[IO[str]]
    ) -> PlanGenerationResult:
        def options() -> dict[str, Any]:
            tell = stream and (lambda facts: stream.write(f"{facts['words']}\n"))
            left = None if end is None else max(end - time.monotonic(), _LEAST)
            return {"solver": self._solver, "timeout": left, "progress": tell}

        if reading.hidden and task.solve("possible", **options()).verdict == "unrealizable":
            raise UPProblemDefinitionError("no initial state meets all that is said of what is hidden")
        # A plan that is in the same situation twice can be shortened.
        most = self._steps if reading.enough is None else min(self._steps, reading.enough)
        proved = False
        if shortest:
            found = task.minimize("T", "plan", range=(0, most), **options())
            result, proved = found.result, found.proved
        else:
            for steps in _doubled(most):
                result = task.with_constants(T=steps).solve("plan", **options())
                if result.verdict != "unrealizable":
                    break
        if result:
            status = Status.SOLVED_OPTIMALLY if proved else Status.SOLVED_SATISFICING
            return self._answer(status, plan=reading.plan(result["p"].actions))
        if result.verdict == "unknown":
            timed = result.reason_code == "timeout"
            return self._answer(Status.TIMEOUT if timed else Status.INTERNAL_ERROR, why=str(result.reason))
        if most == reading.enough:
            return self._answer(Status.UNSOLVABLE_PROVEN, why="there is no plan")
        return self._answer(Status.UNSOLVABLE_INCOMPLETELY, why=f"there is no plan of at most {most} actions")

    def _answer(
        self, status: Status, *, plan: Optional[SequentialPlan] = None, why: Optional[str] = None
    ) -> PlanGenerationResult:
        log = None if why is None else [LogMessage(LogLevel.INFO, why)]
        return PlanGenerationResult(status, plan, self.name, log_messages=log)


def _doubled(most: int) -> Iterator[int]:
    """Numbers of steps to try: short plans are found fast."""
    steps = 1
    while steps < most:
        yield steps
        steps *= 2
    yield most
