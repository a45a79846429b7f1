# A tool-info module for hyperplan. BenchExec takes it from here if this folder's parent is on PYTHONPATH:
# it is named hyperplan_tool.hyperplan there.

import json

import benchexec.result as result
from benchexec.tools.template import BaseTool2, UnsupportedFeatureException


class Tool(BaseTool2):
    """
    Tool info for hyperplan, which plans robot motion from hyperproperties.

    A task is a problem file. Its options, in the task-definition file, are "objective", a name that is needed if the
    problem has several objectives, and "set", a list of constants such as "T=12". The result is "true" for what is
    realizable and "false" for what is not.
    """

    def name(self):
        return "hyperplan"

    def executable(self, tool_locator):
        return tool_locator.find_executable("hyperplan")

    def version(self, executable):
        return self._version_from_tool(executable, line_prefix="hyperplan")

    def cmdline(self, executable, options, task, rlimits):
        wanted = task.options or {}
        unknown = set(wanted) - {"objective", "set"}
        if unknown:
            raise UnsupportedFeatureException(f"unknown task options: {', '.join(sorted(unknown))}")
        cmdline = [executable, "solve", "--format", "json", *options]
        if "objective" in wanted:
            cmdline += ["--objective", wanted["objective"]]
        for value in wanted.get("set", []):
            cmdline += ["--set", value]
        if rlimits.walltime:
            cmdline += ["--timeout", str(rlimits.walltime)]
        return [*cmdline, "--", task.single_input_file]

    def determine_result(self, run):
        if run.was_timeout:
            return result.RESULT_TIMEOUT
        return {
            0: result.RESULT_TRUE_PROP,
            1: result.RESULT_FALSE_PROP,
            2: "ERROR (refused or not supported)",
            3: result.RESULT_UNKNOWN,
            4: "ERROR (a solver failed)",
            5: "ERROR (a bug in hyperplan)",
        }.get(run.exit_code.value, result.RESULT_ERROR)

    def get_value_from_output(self, output, identifier):
        """Columns are paths into the answer: "verified", "seconds.solve", "solver.version"."""
        for line in output:
            if not line.startswith("{"):
                continue
            try:
                value = json.loads(line)
                for part in identifier.split("."):
                    value = value[part]
            except (ValueError, KeyError, TypeError):
                return None
            return None if value is None else str(value)
        return None
