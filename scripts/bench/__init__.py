"""The parts of scripts/performance.py: problems to measure, runs, what they say, and how it is shown."""
