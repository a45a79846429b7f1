"""Tool-info modules of BenchExec for hyperplan and its peers on models and formulas: `peers_tool.hyperqb2` and so on.

A task has the models and, last, the formula as its input files, and in its options `bound` and, where wanted, `semantics`. How a
tool is run and what it says stands in peers.toml beside this folder. With the folder of the scripts on PYTHONPATH:
`<benchmark tool="peers_tool.hyperqb2">`.
"""

import pathlib
import tomllib

import benchexec.result as result
from benchexec.tools.template import BaseTool2, UnsupportedFeatureException

import peers

PEERS = tomllib.loads((pathlib.Path(__file__).resolve().parent.parent / "peers.toml").read_text())


class Peer(BaseTool2):
    """One of the tools of peers.toml; each module here names one."""

    peer = ""

    def name(self):
        return PEERS[self.peer]["title"]

    def executable(self, tool_locator):
        return tool_locator.find_executable(PEERS[self.peer]["programs"][0])

    def cmdline(self, executable, options, task, rlimits):
        wanted = task.options or {}
        *models, formula = list(task.input_files)
        if "bound" not in wanted or not models or set(wanted) - {"bound", "semantics"}:
            raise UnsupportedFeatureException("a task needs models, a formula and the option bound")
        instance = peers.Instance(
            tuple(models), formula, str(wanted["bound"]), wanted.get("semantics", ""), None, ""
        )
        timeout = rlimits.walltime or rlimits.cputime or 3600
        return [*peers.command(PEERS[self.peer], executable, instance, timeout), *options]

    def determine_result(self, run):
        if run.was_timeout:
            return result.RESULT_TIMEOUT
        ended = {"late": False, "status": run.exit_code.value, "out": "\n".join(run.output), "err": ""}
        said, _ = peers.verdict(PEERS[self.peer], ended)
        return {"holds": result.RESULT_TRUE_PROP, "violated": result.RESULT_FALSE_PROP}.get(said, result.RESULT_UNKNOWN)
