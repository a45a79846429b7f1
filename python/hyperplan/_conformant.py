"""Tasks of unified-planning in the problem language, for `hyperplan.unified_planning`."""

from __future__ import annotations

from itertools import combinations
from typing import Any, Iterator, Optional

from unified_planning.engines.compilers import GrounderHelper
from unified_planning.exceptions import UPUnsupportedProblemTypeError
from unified_planning.model import Effect, FNode, InstantaneousAction, OperatorKind, SensingAction
from unified_planning.model import Problem as Task
from unified_planning.model.fluent import get_all_fluent_exp
from unified_planning.model.walkers import DagWalker, ExpressionQuantifiersRemover
from unified_planning.plans import ActionInstance, SequentialPlan

#: More variables or actions without parameters than this are refused, and longer plans are not counted on.
_MOST = 20_000

#: Up to so many facts that are not known it is counted how long a shortest plan may be.
_COUNTED = 6


def unsupported(why: str) -> UPUnsupportedProblemTypeError:
    """What is not expressed."""
    return UPUnsupportedProblemTypeError(why)


class _Words(DagWalker):  # type: ignore[misc]
    """Expressions without parameters and quantifiers, in the problem language. Objects are numbers."""

    _BETWEEN = {
        OperatorKind.AND: " & ", OperatorKind.OR: " | ", OperatorKind.IMPLIES: " -> ", OperatorKind.IFF: " <-> ",
        OperatorKind.PLUS: " + ", OperatorKind.MINUS: " - ", OperatorKind.LE: " <= ", OperatorKind.LT: " < ",
    }  # fmt: skip

    def __init__(self, fluents: dict[FNode, str], objects: dict[Any, int]) -> None:
        DagWalker.__init__(self)
        self._fluents = fluents
        self._objects = objects

    def walk_operator(self, expression: FNode, args: list[str], **_: object) -> str:
        return f"({self._BETWEEN[expression.node_type].join(args)})"

    walk_and = walk_or = walk_implies = walk_iff = walk_operator
    walk_plus = walk_minus = walk_le = walk_lt = walk_operator

    def walk_equals(self, expression: FNode, args: list[str], **_: object) -> str:
        sign = "<->" if expression.arg(0).type.is_bool_type() else "=="
        return f"({args[0]} {sign} {args[1]})"

    def walk_not(self, _expression: FNode, args: list[str], **_: object) -> str:
        return f"!{args[0]}"

    def walk_times(self, expression: FNode, args: list[str], **_: object) -> str:
        # Names of variables begin so, and nothing else in numbers has that letter.
        if sum("f" in arg for arg in args) > 1:
            raise unsupported(f"a product of two fluents, {expression}")
        return f"({' * '.join(args)})"

    def walk_div(self, expression: FNode, args: list[str], **_: object) -> str:
        if "f" in args[1]:
            raise unsupported(f"a division by a fluent, {expression}")
        return f"({args[0]} / {args[1]})"

    def walk_bool_constant(self, expression: FNode, args: list[str], **_: object) -> str:
        return "true" if expression.bool_constant_value() else "false"

    def walk_int_constant(self, expression: FNode, args: list[str], **_: object) -> str:
        return f"({expression.constant_value()})"

    walk_real_constant = walk_int_constant

    def walk_object_exp(self, expression: FNode, args: list[str], **_: object) -> str:
        return str(self._objects[expression.object()])

    def walk_fluent_exp(self, expression: FNode, args: list[str], **_: object) -> str:
        if expression not in self._fluents:
            raise unsupported(f"{expression} has no value, or arguments that are not constants")
        return self._fluents[expression]

    def walk_error(self, expression: FNode, **_: object) -> str:
        raise unsupported(f"the expression {expression}")


class Reading:
    """What a task says in the problem language.

    Fluents with their arguments are variables, or constants where nothing changes them; actions lose their parameters. As
    in `docs/importing.md`, an action that is not possible makes the task `failed`, so every action can be taken everywhere,
    and the plan is a path of a system without states. With `wait` plans may be shorter than T.
    """

    def __init__(self, task: Task) -> None:
        self._task = task
        self._remover = ExpressionQuantifiersRemover(task.environment)
        self._objects = {thing: number for number, thing in enumerate(task.all_objects)}
        self._actions = list(self._grounded())
        self.hidden = list(dict.fromkeys(
            fluent
            for literal in sorted(getattr(task, "hidden_fluents", ()), key=str)
            for fluent in task.environment.free_vars_extractor.get(literal)
        ))  # fmt: skip
        changed = {effect.fluent.fluent() for action in task.actions for effect in action.effects}
        self._varies = changed | {fluent.fluent() for fluent in self.hidden}
        self._variables: dict[FNode, str] = {}
        self._constants: dict[FNode, str] = {}
        self._words = _Words({}, self._objects)
        for fluent in (one for each in task.fluents for one in get_all_fluent_exp(task, each)):
            if fluent.fluent() in self._varies:
                self._variables[fluent] = f"f{len(self._variables)}"
            elif (value := task.initial_value(fluent)) is not None:
                self._constants[fluent] = self._words.walk(value)
            if len(self._variables) > _MOST:
                raise unsupported(f"more than {_MOST} fluents that change")
        self._words = _Words({**self._constants, **self._variables}, self._objects)

    def _grounded(self) -> Iterator[tuple[ActionInstance, InstantaneousAction]]:
        """Actions without parameters. What is hidden is not known to be constant, so nothing is left out for that."""
        for action in self._task.actions:
            if isinstance(action, SensingAction):
                raise unsupported(f"the action {action.name} senses: only plans that observe nothing are found")
            if not isinstance(action, InstantaneousAction) or action.simulated_effect is not None:
                raise unsupported(f"the action {action.name} is not instantaneous, or its effects are simulated")
        helper = GrounderHelper(self._task, prune_actions=False)
        for number, (action, parameters, grounded) in enumerate(helper.get_grounded_actions()):
            if number >= _MOST:
                raise unsupported(f"more than {_MOST} actions without parameters")
            # None where it is never possible, or changes nothing.
            if grounded is not None:
                yield ActionInstance(action, parameters), grounded

    def _said(self, expression: FNode) -> str:
        return str(self._words.walk(self._remover.remove_quantifiers(expression, self._task).simplify()))

    def plan(self, actions: list[str]) -> SequentialPlan:
        """The plan of these actions."""
        taken = [self._actions[int(name[1:])][0] for name in actions if name != "wait"]
        return SequentialPlan([ActionInstance(one.action, one.actual_parameters) for one in taken], self._task.environment)

    def _range(self, fluent: FNode) -> Optional[tuple[int, int]]:
        """The least and the greatest value, if it is no truth value."""
        kind = fluent.type
        if kind.is_bool_type():
            return None
        if kind.is_user_type():
            numbers = [self._objects[thing] for thing in self._task.objects(kind)]
            if not numbers:
                raise unsupported(f"there is no value for {fluent}")
            return min(numbers), max(numbers)
        if not kind.is_int_type() or kind.lower_bound is None or kind.upper_bound is None:
            raise unsupported(f"{fluent} changes, and is no integer between two bounds")
        return kind.lower_bound, kind.upper_bound

    @property
    def enough(self) -> Optional[int]:
        """A shortest plan has at most so many steps, if that is not too many to count: it never is in the same situation
        twice, which is a state for each that may be the first."""
        size = 1
        for fluent in self._variables:
            low, high = self._range(fluent) or (0, 1)
            size *= high - low + 1
            if size > _MOST:
                return None
        enough = size ** min(2 ** len(self.hidden), size) - 1 if len(self.hidden) <= _COUNTED else _MOST
        return None if enough >= _MOST else enough

    def text(self, steps: int) -> str:
        """The task with its objectives."""
        variables = "".join(
            f"  state {name}: {'bool' if bounds is None else f'{bounds[0]}..{bounds[1]}'};\n"
            for name, bounds in ((name, self._range(fluent)) for fluent, name in self._variables.items())
        )
        names = [*(f"a{number}" for number in range(len(self._actions))), "wait"]
        clauses = "".join(self._clauses(name, action) for name, (_, action) in zip(names, self._actions))
        goal = " & ".join(["!failed", *map(self._said, self._task.goals)])
        one_start = "exists p: Task. F[T,T] goal[p]"
        whatever = "exists p: Plan. forall q: Task. (G action[q] == action[p]) -> F[T,T] goal[q]"
        return (
            f"const T = {steps};\nsystem Task {{\n{variables}  state failed: bool;\n  action {', '.join(names)};\n"
            f"{self._starts()}{clauses}  on wait {{}}\n  label goal = {goal};\n}}\n"
            f"system Plan {{ action {', '.join(names)}; on {' | '.join(names)} {{}} }}\n"
            f"objective plan within T {{ {whatever if self.hidden else one_start} }}\n"
            "objective possible { exists p: Task. F[0,0] true }\n"
        )

    def _starts(self) -> str:
        """What is the case at first."""
        said = ["!failed"]
        hidden = set(self.hidden)
        for fluent, name in self._variables.items():
            if fluent in hidden:
                if not fluent.type.is_bool_type():
                    raise unsupported(f"{fluent} is hidden, and no truth value")
                continue
            value = self._task.initial_value(fluent)
            if value is None:
                raise unsupported(f"{fluent} has no initial value, and is not said to be hidden")
            sign = "<->" if fluent.type.is_bool_type() else "=="
            said.append(f"{name} {sign} {self._said(value)}")
        if hidden:
            for alternatives in self._task.or_constraints:
                said.append(" | ".join(map(self._said, alternatives)))
            for alternatives in self._task.oneof_constraints:
                each = [self._said(one) for one in alternatives]
                said.append(" + ".join(f"(if {one} then 1 else 0)" for one in each) + " == 1")
        return "".join(f"  init {one};\n" for one in said)

    def _clauses(self, name: str, action: InstantaneousAction) -> str:
        """What an action does where it is possible, and that elsewhere the task fails."""
        possible = ["!failed", *map(self._said, action.preconditions)]
        effects: dict[FNode, list[Effect]] = {}
        for effect in (one for each in action.effects for one in each.expand_effect(self._task)):
            effects.setdefault(effect.fluent, []).append(effect)
        updates = ""
        for fluent, each in effects.items():
            said = [(effect, self._said(effect.condition), self._said(effect.value)) for effect in each]
            if fluent not in self._variables:
                raise unsupported(f"the arguments of {fluent} are not constants")
            own = self._variables[fluent]
            if fluent.type.is_bool_type():
                # What is made both true and false is true.
                true = " | ".join(f"{condition} & {value}" for _, condition, value in said)
                touched = " | ".join(condition for _, condition, _ in said)
                updates += f" {own}' = {true} | {own} & !({touched});"
                continue
            possible += _without_conflicts(said)
            new = _changed(own, said)
            if not fluent.type.is_user_type():
                low, high = self._range(fluent) or (0, 0)
                possible.append(f"({new}) in {low}..{high}")
            updates += f" {own}' = {new};"
        guard = " & ".join(possible)
        return f"  on {name} when {guard} {{{updates} }}\n  on {name} when !({guard}) {{ failed' = true; }}\n"


def _changed(own: str, said: list[tuple[Effect, str, str]]) -> str:
    """The new value of what is no truth value, where effects do not contradict each other."""
    otherwise = own
    for effect, condition, value in said:
        if not effect.is_assignment():
            sign = "+" if effect.is_increase() else "-"
            otherwise += f" {sign} (if {condition} then {value} else 0)"
    new = otherwise
    for effect, condition, value in reversed(said):
        if effect.is_assignment():
            new = f"if {condition} then {value} else {new}"
    return new


def _without_conflicts(said: list[tuple[Effect, str, str]]) -> Iterator[str]:
    """An action is not possible where it assigns two values, or assigns one and changes it besides."""
    for (one, condition, value), (other, second, another) in combinations(said, 2):
        if one.is_assignment() and other.is_assignment():
            yield f"!({condition} & {second} & {value} != {another})"
        elif one.is_assignment() or other.is_assignment():
            yield f"!({condition} & {second})"
