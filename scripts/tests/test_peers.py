"""Tables are read, commands made and answers judged as they are meant; the tools themselves are little programs here."""

import pathlib
import stat
import subprocess
import sys
import tempfile
import types
import unittest
from unittest import mock

import peers

PEER = {"title": "P", "programs": ["p"], "holds": "^result: *sat", "violated": "^result: *unsat"}


def ended(**changes: object) -> dict:
    return {"late": False, "status": 0, "out": "", "err": "", "seconds": 1.0} | changes


def instance(**changes: object) -> peers.Instance:
    values = {"models": ("a.smv", "b.smv"), "formula": "f.hq", "bound": "5", "semantics": "", "known": None, "elsewhere": ""}
    return peers.Instance(**values | changes)


class Peers(unittest.TestCase):
    def setUp(self) -> None:
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def table(self, text: str) -> pathlib.Path:
        path = self.folder / "t.tsv"
        path.write_text(text)
        return path

    def test_tables(self) -> None:
        path = self.table("# family\tm\tf\tK\tknown\tby\tpeer s\nx\ta.smv b.smv\tf.hq\t20 hpes\tunrealizable\thand\t3.5\n\nx\ta.smv\tf.hq\t4\t-\n")
        first, second = peers.instances(path)
        self.assertEqual(first.models, (str(self.folder / "a.smv"), str(self.folder / "b.smv")))
        self.assertEqual((first.bound, first.semantics, first.known, first.elsewhere), ("20", "hpes", "violated", "3.5"))
        self.assertEqual((second.known, second.semantics, second.elsewhere), (None, "", ""))
        self.assertEqual(first.label(), "a, b: f, K = 20")
        self.assertEqual(peers.elsewhere(path), "peer s")
        for bad in ("x\ta.smv\tf.hq\tten\t-", "x\ta.smv\tf.hq\t4\tmaybe", "x\ta.smv"):
            with self.assertRaisesRegex(ValueError, "t.tsv:1"):
                peers.instances(self.table(bad))

    def test_commands(self) -> None:
        peer = {"command": ["{program}", "-n", "{models}", "{formula}", ["-s", "{semantics}"], "-t", "{timeout}"]}
        self.assertEqual(peers.command(peer, "p", instance(), 2.5), ["p", "-n", "a.smv", "b.smv", "f.hq", "-t", "2.5"])
        self.assertIn("hpes", peers.command(peer, "p", instance(semantics="hpes"), 2))
        formula = self.folder / "f.hq"
        formula.write_text("Forall (AP \"x\" 0)\n")
        words = peers.command({"command": ["{program}", "{text}", "{model}"]}, "p", instance(formula=str(formula)), 2)
        self.assertEqual(words, ["p", "Forall (AP \"x\" 0)", "a.smv"])
        for name, known in peers.tomllib.loads((peers.HERE / "peers.toml").read_text()).items():
            words = peers.command(known, "p", instance(formula=str(formula), semantics="pes"), 2)
            self.assertTrue(words[0] == "p" and all("{" not in word for word in words), name)
        peer = {"command": ["{program}", ["-i", "{models}"], "-F", "{formula}"]}
        self.assertEqual(
            peers.command(peer, "p", instance(), 9.0), ["p", "-i", "a.smv", "-i", "b.smv", "-F", "f.hq"]
        )

    def test_verdicts(self) -> None:
        self.assertEqual(peers.verdict(PEER, ended(out="x\nresult: unsat.\n"))[0], "violated")
        self.assertEqual(peers.verdict(PEER, ended(out="result: sat.\n"))[0], "holds")
        self.assertEqual(peers.verdict(PEER, ended(out="panicked"))[0], "unknown")
        self.assertEqual(peers.verdict(PEER, ended(out="result: sat.", late=True))[0], "timeout")
        own = {"statuses": {"1": "violated"}, "json": "verified"}
        self.assertEqual(peers.verdict(own, ended(status=1, out='{"verified":"by-search"}\n')), ("violated", "by-search"))
        self.assertEqual(peers.verdict(own, ended(status=3, out="{broken")), ("unknown", ""))

    def test_judgement(self) -> None:
        known = {"hyperplan": {"title": "hyperplan"}, "p": PEER, "i": {"title": "I", "infinite": True}}
        said = {"hyperplan": ("holds", "by-search"), "p": ("violated", ""), "i": ("violated", "")}
        wrong = peers.judge(instance(), said, known)
        self.assertEqual(wrong, ["a, b: f, K = 5: P says violated, not holds"])
        both = peers.judge(instance(known="violated"), said, known)
        self.assertIn("a checked witness says holds", both[0])
        self.assertEqual(peers.judge(instance(), {"p": ("violated", "")}, known), [])
        self.assertEqual(peers.judge(instance(known="holds"), {"p": ("timeout", "")}, known), [])

    def test_runs_end_in_time_and_are_kept(self) -> None:
        program = self.folder / "slow"
        program.write_text("#!/bin/sh\nsleep 60 &\necho result: sat\necho again >> \"$1\"\ntest -z \"$2\" || wait\n")
        program.chmod(program.stat().st_mode | stat.S_IXUSR)
        count = self.folder / "count"
        log = peers.Log(self.folder / "log" / "peers.jsonl")
        words = [str(program), str(count), "wait"]
        late = log.run(words, 0.5)
        self.assertTrue(late["late"] and late["seconds"] < 10)
        self.assertEqual(log.run(words, 0.5), late)
        self.assertEqual(peers.Log(log.path).run(words, 0.5)["key"], late["key"])
        self.assertEqual(count.read_text().count("again"), 1)

    def test_pages(self) -> None:
        rows = [{
            "instance": instance(known="holds", elsewhere="9"), "said": {"hyperplan": ("holds", "by-search"), "p": ("violated", "")},
            "seconds": {"hyperplan": 0.123, "p": 4.0}, "doubts": ["vacuous"],
        }]
        text = peers.table(rows, {"hyperplan": {"title": "hyperplan"}, "p": PEER}, ["hyperplan", "p"], "there s")
        self.assertIn("| a, b: f, K = 5 | holds | by-search | 0.12 | violated (4.00) | 9 | `vacuous` |", text)
        page = f"before\n{peers.BEGIN}\nold\n{peers.END}\nafter\n"
        self.assertEqual(peers.written(page, text), f"before\n{peers.BEGIN}\n{text}\n{peers.END}\nafter\n")
        with self.assertRaises(ValueError):
            peers.written("nothing", text)

    def test_whole(self) -> None:
        tool = self.folder / "tool"
        tool.write_text("#!/bin/sh\necho result: unsat\n")
        tool.chmod(tool.stat().st_mode | stat.S_IXUSR)
        config = self.folder / "peers.toml"
        config.write_text(
            f'[t]\ntitle = "T"\nprograms = ["{tool}"]\ncommand = ["{{program}}", "{{models}}"]\n'
            'holds = "result: sat"\nviolated = "result: unsat"\nfor = [".smv"]\n'
            '[none]\ntitle = "None"\nprograms = ["there-is-none"]\ncommand = []\nfor = []\n'
        )
        table = self.table("x\ta.smv\tf.hq\t4\tholds\n")
        words = [sys.executable, str(peers.HERE / "peers.py"), str(table), "--config", str(config), "--out", str(self.folder / "o")]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("None is not installed", done.stderr)
        self.assertIn("wrong: a: f, K = 4: T says violated, not holds", done.stderr)
        self.assertIn("| a: f, K = 4 | holds | - | violated (", done.stdout)


class Modules(unittest.TestCase):
    """The modules for BenchExec, of which as much as they use is here."""

    def test_modules(self) -> None:
        template = types.ModuleType("benchexec.tools.template")
        template.BaseTool2 = object
        template.UnsupportedFeatureException = type("UnsupportedFeatureException", (Exception,), {})
        result = types.ModuleType("benchexec.result")
        result.RESULT_TRUE_PROP, result.RESULT_FALSE_PROP = "true", "false"
        result.RESULT_UNKNOWN, result.RESULT_TIMEOUT = "unknown", "timeout"
        package = types.ModuleType("benchexec")
        package.result = result
        fakes = {"benchexec": package, "benchexec.result": result, "benchexec.tools": types.ModuleType("t"), "benchexec.tools.template": template}
        with mock.patch.dict(sys.modules, fakes):
            # Whoever looked for tests may have loaded them with the real one.
            for name in [name for name in sys.modules if name.split(".")[0] == "peers_tool"]:
                del sys.modules[name]
            from peers_tool import hyperqb2

            tool = hyperqb2.Tool()
            task = types.SimpleNamespace(options={"bound": 7}, input_files=["a.smv", "b.smv", "f.hq"])
            limits = types.SimpleNamespace(walltime=10, cputime=None)
            words = tool.cmdline("/bin/p", ["-c"], task, limits)
            self.assertEqual(words, ["/bin/p", "-n", "a.smv", "b.smv", "-f", "f.hq", "-k", "7", "-s", "hpes", "-c"])
            run = types.SimpleNamespace(was_timeout=False, exit_code=types.SimpleNamespace(value=0), output=["result: unsat."])
            self.assertEqual((tool.name(), tool.determine_result(run)), ("HyperQB 2.0", "false"))
            with self.assertRaises(template.UnsupportedFeatureException):
                tool.cmdline("p", [], types.SimpleNamespace(options={}, input_files=["a.smv", "f.hq"]), limits)


if __name__ == "__main__":
    unittest.main()
