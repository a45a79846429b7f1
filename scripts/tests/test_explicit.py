"""The reference searches say what the case studies say of themselves."""

import pathlib
import re
import subprocess
import tempfile
import unittest

from bench import explicit, maps


class Explicit(unittest.TestCase):
    def test_least_horizons(self) -> None:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            program = folder / "reference"
            subprocess.run(["rustc", "--edition", "2024", "-O", str(explicit.SOURCE), "-o", str(program)], check=True)
            for objective in maps.OBJECTIVES:
                for size in (10, 20):
                    text = maps.case_study(objective, size, folder).read_text(encoding="utf-8")
                    known = re.findall(rf"// {objective} T=(\d+): (\w+)", text)
                    self.assertEqual(len(known), 2, (objective, size))
                    for horizon, verdict in known:
                        command = [program, objective, maps.map_file(objective, size, folder), horizon]
                        said = subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
                        found = "unrealizable" if said == "unrealizable" else "realizable"
                        self.assertEqual(found, verdict, (objective, size, horizon))


if __name__ == "__main__":
    unittest.main()
