"""Every fault can be planted: in one place, whatever has moved."""

import pathlib
import subprocess
import sys
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parents[1] / "planted-faults.py"


class Faults(unittest.TestCase):
    def test_each_applies_once(self):
        listed = subprocess.run([sys.executable, SCRIPT, "--list"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.assertEqual(listed.returncode, 0, listed.stderr)
        self.assertGreater(len(listed.stdout.splitlines()), 20)


if __name__ == "__main__":
    unittest.main()
