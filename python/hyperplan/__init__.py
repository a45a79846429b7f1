"""Plans robot motion from hyperproperties.

    >>> import hyperplan
    >>> problem = hyperplan.Problem.from_text('''
    ...   system Line {
    ...     state x: 0..3;
    ...     action left, right;
    ...     on left  { x' = x - 1; }
    ...     on right { x' = x + 1; }
    ...     init x == 0;
    ...   }
    ...   objective end { exists p. F[0,3] x[p] == 3 }
    ... ''')
    >>> result = problem.solve()
    >>> result.verdict, result["p"].actions
    ('realizable', ['right', 'right', 'right'])
"""

from ._native import VERSION as __version__
from ._native import HyperplanError, ProblemError, SolverError, StrategyError
from ._command import command
from ._problem import Minimized, Problem, load
from ._result import Explanation, Path, Result, Verification
from ._systems import System

__all__ = [
    "Explanation",
    "HyperplanError",
    "Minimized",
    "Path",
    "Problem",
    "ProblemError",
    "Result",
    "SolverError",
    "StrategyError",
    "System",
    "Verification",
    "__version__",
    "command",
    "load",
]
