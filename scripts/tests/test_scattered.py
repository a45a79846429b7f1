"""Random maps are the same in every run, and quantiles are what they say."""

import unittest

from bench import maps, scattered


class Scattered(unittest.TestCase):
    def test_maps_keep_starts_and_goals(self) -> None:
        for objective in maps.OBJECTIVES:
            drawn = scattered.random_map(objective, 30, 1)
            self.assertEqual(drawn, scattered.random_map(objective, 30, 1))
            self.assertNotEqual(drawn, scattered.random_map(objective, 30, 2))
            starts, goals = maps.ends(objective, scattered.SIZE)
            self.assertEqual((drawn.count("S"), drawn.count("G")), (len(starts), len(goals - starts)))
            self.assertTrue(200 < drawn.count("#") < 800)

    def test_quantiles(self) -> None:
        values = [float(n) for n in range(10, 0, -1)]
        self.assertEqual([scattered.quantile(values, part) for part in (0.5, 0.9, 1.0)], [5.0, 9.0, 10.0])


if __name__ == "__main__":
    unittest.main()
