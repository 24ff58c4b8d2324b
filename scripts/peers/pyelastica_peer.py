"""PyElastica on the swinging cantilever: position Verlet, the time step proportional to the elements' length, as in
scripts/references/pyelastica_rods.py. It has no solver of statics, and no bodies on rods that a step of its size could
follow. The time holds the building of the rod, a few milliseconds; what is compiled when first used is compiled before.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "references"))

import pyelastica_rods

import measure


def main():
    quick = measure.quick()
    reference = measure.cantilever_motion()
    pyelastica_rods.simulate(4)

    def once(elements):
        seconds, (rows, _) = measure.timed(lambda: pyelastica_rods.simulate(elements))
        return seconds, measure.largest_distance(rows[:, :3], reference)

    for elements in (10,) if quick else (10, 20, 40, 80):
        seconds, error = measure.fastest(lambda: once(elements), quick)
        step = 1e6 * pyelastica_rods.PACE / elements
        measure.tell("cantilever", "PyElastica", f"{elements} elements, {step:g} µs", seconds, error)


if __name__ == "__main__":
    main()
