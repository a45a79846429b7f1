"""Runs a command and says what it took."""

import contextlib
import dataclasses
import json
import os
import pathlib
import signal
import statistics
import subprocess
import tempfile
import threading
import time
from typing import Any


@dataclasses.dataclass(frozen=True)
class Run:
    """What became of a command."""

    wall: float
    memory: int  # peak, in bytes
    status: int | None  # the exit status; None if time ran out
    output: str
    errors: str

    @property
    def answer(self) -> dict[str, Any]:
        """The JSON object that was printed; empty if there is none."""
        try:
            value = json.loads(self.output)
        except ValueError:
            return {}
        return value if isinstance(value, dict) else {}

    @property
    def problem(self) -> str | None:
        """Why there is no answer, in a few words; None if there is one, whatever it says."""
        if self.status is None:
            return "timeout"
        if self.status in (0, 1):
            return None
        if self.status == 3:
            return str(self.answer.get("reason") or "undecided")
        lines = self.errors.strip().splitlines()
        # What was tried, and where, is nobody else's business.
        said = lines[-1].removeprefix("error: ").partition(" (")[0] if lines else ""
        return said[:120] or f"exit status {self.status}"


def once(command: list[str], timeout: float) -> Run:
    """Runs a command in a process group of its own, which ends with it or when time runs out."""
    with tempfile.TemporaryFile() as output, tempfile.TemporaryFile() as errors:
        start = time.perf_counter()
        try:
            child = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=output, stderr=errors, start_new_session=True
            )
        except OSError as error:
            return Run(0.0, 0, 127, "", f"cannot start {command[0]}: {error.strerror}")
        late = threading.Event()

        def end() -> None:
            late.set()
            os.killpg(child.pid, signal.SIGKILL)

        timer = threading.Timer(timeout, end)
        timer.start()
        try:
            # Not reaped yet, so that the group cannot have been taken by others when the timer fires.
            os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT)
        finally:
            wall = time.perf_counter() - start
            timer.cancel()
            timer.join()
            kill_rest(child.pid)
            _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        texts = []
        for file in (output, errors):
            file.seek(0)
            texts.append(file.read().decode("utf-8", "replace"))
        code = None if late.is_set() else child.returncode
        return Run(wall, usage.ru_maxrss * 1024, code, texts[0], texts[1])


def kill_rest(group: int) -> None:
    """Ends what a command may have left behind."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(group, signal.SIGKILL)


def median(command: list[str], runs: int, timeout: float) -> Run:
    """The run with the median time, and the largest memory of all; the first without an answer, if there is one."""
    done: list[Run] = []
    for _ in range(runs):
        run = once(command, timeout)
        if run.problem is not None:
            return run
        done.append(run)
    done.sort(key=lambda run: run.wall)
    return dataclasses.replace(done[(runs - 1) // 2], memory=max(run.memory for run in done))


def floor() -> int:
    """The least memory that can be seen: a child begins as a copy of this process, which the kernel counts."""
    return max(once(["true"], 10.0).memory for _ in range(3))


def wall(command: list[str], runs: int, timeout: float) -> float | None:
    """The median wall time; None if a run failed."""
    done = [once(command, timeout) for _ in range(runs)]
    if any(run.problem for run in done):
        return None
    return statistics.median(run.wall for run in done)


def size(folder: pathlib.Path) -> int:
    """The bytes of all files of a folder."""
    return sum(file.stat().st_size for file in folder.iterdir())
