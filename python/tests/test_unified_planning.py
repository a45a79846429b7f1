"""The engine for unified-planning, against a search of our own that takes every step with unified-planning's simulator."""

import collections
import io
import itertools
import random

import pytest

up = pytest.importorskip("unified_planning")

import hyperplan.unified_planning
from unified_planning.model import ContingentProblem
from unified_planning.shortcuts import *

hyperplan.unified_planning.register()
lit, outside = Fluent("lit"), Fluent("outside")
switch, leave = InstantaneousAction("switch_off"), InstantaneousAction("leave")
switch.add_effect(lit, False)
leave.add_precondition(Not(lit))
leave.add_effect(outside, True)
problem = ContingentProblem("home")
problem.add_fluent(lit, default_initial_value=False)
problem.add_fluent(outside, default_initial_value=False)
problem.add_unknown_initial_constraint(lit)
problem.add_actions([switch, leave])
problem.add_goal(outside)
with OneshotPlanner(name="hyperplan", params={"steps": 10}) as planner:
    print(planner.solve(problem).plan)

from unified_planning.engines import PlanGenerationResultStatus as Status
from unified_planning.exceptions import UPConflictingEffectsException, UPInvalidActionError
from unified_planning.exceptions import UPProblemDefinitionError, UPUnsupportedProblemTypeError
from unified_planning.model import SensingAction

get_environment().credits_stream = None
# Once more does no harm.
hyperplan.unified_planning.register()


def solved(problem, **params):
    with OneshotPlanner(name="hyperplan", params=params) as planner:
        return planner.solve(problem)


def bomb(packages):
    """One of the packages has the bomb; dunking disarms it and clogs the toilet."""
    package = UserType("package")
    armed, clogged = Fluent("armed", BoolType(), p=package), Fluent("clogged")
    dunk = InstantaneousAction("dunk", p=package)
    dunk.add_precondition(Not(clogged))
    dunk.add_effect(armed(dunk.p), False)
    dunk.add_effect(clogged, True)
    flush = InstantaneousAction("flush")
    flush.add_effect(clogged, False)
    problem = ContingentProblem("bomb")
    problem.add_fluent(armed, default_initial_value=False)
    problem.add_fluent(clogged, default_initial_value=False)
    problem.add_actions([dunk, flush])
    objects = [Object(f"package {number}", package) for number in range(packages)]
    problem.add_objects(objects)
    problem.add_oneof_initial_constraint([armed(one) for one in objects])
    some = Variable("some", package)
    problem.add_goal(Forall(Not(armed(some)), some))
    return problem


def starts(problem):
    """The task with each state that may be the first."""
    hidden = sorted({f for literal in problem.hidden_fluents for f in literal.environment.free_vars_extractor.get(literal)}, key=str)
    for values in itertools.product([False, True], repeat=len(hidden)):
        known = dict(zip(hidden, values))

        def true(literal):
            return not known[literal.arg(0)] if literal.is_not() else known[literal]

        if not all(any(map(true, one)) for one in problem.or_constraints):
            continue
        if not all(sum(map(true, one)) == 1 for one in problem.oneof_constraints):
            continue
        task = Problem(problem.name)
        task.add_fluents(problem.fluents)
        task.add_actions(problem.actions)
        task.add_objects(problem.all_objects)
        for fluent, value in problem.initial_values.items():
            task.set_initial_value(fluent, known.get(fluent, value))
        for goal in problem.goals:
            task.add_goal(goal)
        yield task


def instances(problem):
    for action in problem.actions:
        yield from ((action, given) for given in itertools.product(*(problem.objects(p.type) for p in action.parameters)))


class Steps:
    """Tasks that differ in their first state, side by side."""

    def __init__(self, tasks):
        self.simulators = [SequentialSimulator(task) for task in tasks]
        self.fluents = list(tasks[0].initial_values)
        self.first = [simulator.get_initial_state() for simulator in self.simulators]

    def next(self, states, action, given):
        """The next states; None where the action is not possible in one."""
        reached = []
        for simulator, state in zip(self.simulators, states):
            try:
                if simulator.get_unsatisfied_conditions(state, action, given)[0]:
                    return None
                reached.append(simulator.apply_unsafe(state, action, given))
            except (UPConflictingEffectsException, UPInvalidActionError):
                return None
        return reached

    def key(self, states):
        return tuple(str(state.get_value(fluent)) for state in states for fluent in self.fluents)

    def goal(self, states):
        return all(simulator.is_goal(state) for simulator, state in zip(self.simulators, states))


def shortest(tasks, bound):
    """How many actions a shortest plan has, and whether nothing new is reached any more within the bound."""
    steps = Steps(tasks)
    reached, layer = {steps.key(steps.first)}, [steps.first]
    for length in range(bound + 1):
        if any(map(steps.goal, layer)):
            return length, False
        following = []
        for states, (action, given) in itertools.product(layer, list(instances(tasks[0]))):
            then = steps.next(states, action, given)
            if then is not None and steps.key(then) not in reached:
                reached.add(steps.key(then))
                following.append(then)
        layer = following
    return None, not layer


def random_problem(chance, number):
    thing = UserType("thing")
    problem = ContingentProblem(f"random {number}")
    objects = [Object(f"thing {n}", thing) for n in range(2)]
    problem.add_objects(objects)
    flag, door = Fluent("flag", BoolType(), of=thing), Fluent("door")
    count, where, weight = Fluent("count", IntType(0, 3)), Fluent("where", thing), Fluent("weight", IntType(), of=thing)
    problem.add_fluent(flag, default_initial_value=False)
    problem.add_fluent(door, default_initial_value=chance.random() < 0.5)
    problem.add_fluent(count, default_initial_value=chance.randint(0, 3))
    problem.add_fluent(where, default_initial_value=chance.choice(objects))
    problem.add_fluent(weight, default_initial_value=chance.randint(1, 2))
    problem.set_initial_value(weight(objects[0]), chance.randint(-1, 2))
    facts = [flag(objects[0]), flag(objects[1]), FluentExp(door)]
    hidden = chance.choice([0, 1, 1, 2, 2, 3])
    if hidden == 1:
        problem.add_unknown_initial_constraint(chance.choice(facts))
    elif hidden == 2:
        problem.add_oneof_initial_constraint(chance.sample(facts, 2))
    elif hidden == 3:
        problem.add_or_initial_constraint([one if chance.random() < 0.6 else Not(one) for one in facts])

    def condition(of):
        some = Variable("some", thing)
        kinds = [
            lambda: flag(of), lambda: Not(flag(of)), lambda: FluentExp(door), lambda: Not(door), lambda: Equals(where, of),
            lambda: LE(count, chance.randint(0, 2)), lambda: Or(flag(of), door), lambda: Iff(flag(of), door),
            lambda: Forall(flag(some), some), lambda: Exists(Not(flag(some)), some), lambda: Implies(door, flag(of)),
            lambda: LT(weight(of), Plus(count, 1)), lambda: Equals(Times(2, count), weight(of)), lambda: Equals(Div(count, 2), 1),
        ]  # fmt: skip
        return chance.choice(kinds)()

    for name in range(chance.randint(2, 3)):
        action = InstantaneousAction(f"action {name}", of=thing)
        if chance.random() < 0.6:
            action.add_precondition(condition(action.of))
        for _ in range(chance.randint(1, 3)):
            when = condition(action.of) if chance.random() < 0.5 else True
            effect = chance.randint(0, 6)
            try:
                if effect < 2:
                    action.add_effect(flag(action.of), chance.random() < 0.7, when)
                elif effect == 2:
                    action.add_effect(door, chance.choice([True, False, condition(action.of)]), when)
                elif effect == 3:
                    action.add_effect(where, action.of, when)
                elif effect == 4:
                    action.add_effect(count, chance.choice([0, 2, Minus(3, count)]), when)
                elif effect == 5:
                    action.add_increase_effect(count, chance.choice([1, weight(action.of)]), when)
                else:
                    action.add_decrease_effect(count, 1, when)
            except UPConflictingEffectsException:
                pass
        problem.add_action(action)
    for _ in range(chance.choice([1, 1, 2])):
        problem.add_goal(condition(chance.choice(objects)))
    return problem


def accepted(tasks, plan):
    with PlanValidator(name="sequential_plan_validator") as validator:
        return all(validator.validate(task, plan) for task in tasks)


def test_random_problems():
    chance, bound, seen = random.Random(7), 3, collections.Counter()
    for number in range(50):
        problem = random_problem(chance, number)
        tasks = list(starts(problem))
        best, closed = shortest(tasks, bound)
        found = solved(problem, steps=bound)
        assert (best is not None) == (found.status == Status.SOLVED_SATISFICING), (problem, best, found)
        assert found.plan is None or len(found.plan.actions) <= bound and accepted(tasks, found.plan)
        if found.status == Status.UNSOLVABLE_PROVEN:
            assert closed or shortest(tasks, 1000) == (None, True)
        problem.add_quality_metric(MinimizeSequentialPlanLength())
        least = solved(problem, steps=bound)
        if best is not None:
            assert least.status == Status.SOLVED_OPTIMALLY, (problem, least)
            assert len(least.plan.actions) == best and accepted(tasks, least.plan), (problem, least)
        seen[len(tasks) > 1, best] += 1
    # Plans of several lengths and none.
    assert all(seen[True, best] for best in (None, 0, 1, 2)) and seen[False, None] and seen[False, 0], seen


def test_the_example():
    assert [str(action) for action in solved(problem, steps=10).plan.actions] == ["switch_off", "leave"]


def test_one_plan_for_all_that_may_be_the_case():
    problem = bomb(3)
    with OneshotPlanner(problem_kind=problem.kind) as planner:
        assert planner.name == "hyperplan"
    found = solved(problem)
    assert found.status == Status.SOLVED_SATISFICING and accepted(list(starts(problem)), found.plan)
    problem.add_quality_metric(MinimizeSequentialPlanLength())
    best = solved(problem, steps=9)
    assert best.status == Status.SOLVED_OPTIMALLY and len(best.plan.actions) == 5
    short = solved(problem, steps=4)
    assert short.status == Status.UNSOLVABLE_INCOMPLETELY and "at most 4" in short.log_messages[0].message


@pytest.mark.parametrize("goal, best", [(0, None), (2, 2), (3, 2)])
def test_an_action_that_contradicts_itself_is_not_possible(goal, best):
    count, left, right = Fluent("count", IntType(0, 3)), Fluent("left"), Fluent("right")
    problem = ContingentProblem("both")
    problem.add_fluent(count, default_initial_value=1)
    problem.add_fluent(left, default_initial_value=True)
    problem.add_fluent(right, default_initial_value=True)
    for other in (0, 2):
        act = InstantaneousAction(f"to {other} or more")
        act.add_effect(count, other, left)
        act.add_increase_effect(count, 1, right) if other else act.add_effect(count, 3, right)
        problem.add_action(act)
    drop = InstantaneousAction("drop")
    drop.add_effect(left, False)
    problem.add_action(drop)
    problem.add_goal(And(Equals(count, goal), right))
    problem.add_quality_metric(MinimizeSequentialPlanLength())
    found, tasks = solved(problem, steps=4), list(starts(problem))
    assert shortest(tasks, 4)[0] == best
    assert found.plan is None if best is None else len(found.plan.actions) == best and accepted(tasks, found.plan)


def test_a_task_with_one_start_is_an_ordinary_one():
    x, y = Fluent("x", IntType(0, 3)), Fluent("y")
    problem = Problem("line")
    problem.add_fluent(x, default_initial_value=0)
    problem.add_fluent(y, default_initial_value=False)
    go = InstantaneousAction("go")
    go.add_increase_effect(x, 1)
    problem.add_action(go)
    problem.add_goal(Equals(x, 3))
    found = solved(problem)
    assert [str(action) for action in found.plan.actions] == ["go"] * 3
    # All states are passed within 3 steps, so there is no plan of any length.
    problem.add_goal(y)
    assert solved(problem).status == Status.UNSOLVABLE_PROVEN
    nothing = Problem("nothing")
    assert solved(nothing).plan.actions == []


def test_what_is_not_supported_is_said():
    problem = bomb(2)
    look = SensingAction("look")
    look.add_observed_fluent(problem.fluent("clogged")())
    problem.add_action(look)
    with pytest.raises(UPUnsupportedProblemTypeError, match="look"):
        solved(problem)

    def task(of, goal):
        value = Fluent("value", of)
        task = Problem("task")
        task.add_fluent(value, default_initial_value=0)
        rise = InstantaneousAction("rise")
        rise.add_increase_effect(value, 1)
        task.add_action(rise)
        task.add_goal(goal(value))
        return task

    for of in (IntType(), IntType(0), RealType(0, 3)):
        with pytest.raises(UPUnsupportedProblemTypeError, match="value"):
            solved(task(of, lambda value: Equals(value, 2)))
    with pytest.raises(UPUnsupportedProblemTypeError, match="product"):
        solved(task(IntType(0, 9), lambda value: Equals(Times(value, value), 4)))
    always = task(IntType(0, 3), lambda value: Equals(value, 2))
    always.add_trajectory_constraint(Always(LE(always.fluent("value"), 2)))
    with pytest.warns(UserWarning), pytest.raises(UPUnsupportedProblemTypeError, match="STATE_INVARIANTS"):
        solved(always)
    nowhere = bomb(2)
    nowhere.add_or_initial_constraint([Not(nowhere.fluent("armed")(one)) for one in nowhere.all_objects[:1]])
    nowhere.add_or_initial_constraint([Not(nowhere.fluent("armed")(one)) for one in nowhere.all_objects[1:]])
    with pytest.raises(UPProblemDefinitionError):
        solved(nowhere)
    with pytest.raises(ValueError):
        solved(bomb(2), steps=-1)


def test_time_and_progress():
    problem, told = bomb(9), io.StringIO()
    problem.add_quality_metric(MinimizeSequentialPlanLength())
    with OneshotPlanner(name="hyperplan") as planner:
        result = planner.solve(problem, timeout=0.5, output_stream=told)
        assert result.status in (Status.TIMEOUT, Status.SOLVED_SATISFICING, Status.SOLVED_OPTIMALLY)
        assert result.plan is not None or result.status == Status.TIMEOUT
        with pytest.warns(UserWarning, match="heuristic"):
            planner.solve(bomb(2), heuristic=lambda state: 0.0)
