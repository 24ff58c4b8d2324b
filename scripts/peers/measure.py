"""What all measured programs share: the exact answers, the clock, and how a run is told."""

import csv
import gc
import json
import math
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
REFERENCES = ROOT / "references"

# A run is repeated until it has taken so long, at least once and at most so often; the fastest counts.
ENOUGH, MOST = 2.0, 20


def rows(name, **wanted):
    """Rows of a table under references/ with these entries."""
    with (REFERENCES / name).open(newline="", encoding="utf-8") as file:
        return [row for row in csv.DictReader(file) if all(row[key] == value for key, value in wanted.items())]


def place(row, names="xyz"):
    return [float(row[name]) for name in names]


def spring_tip():
    """Displacement of the loaded end under 100 N [m]: the continuous equations."""
    return place(rows("continuous/static_spring_wire_end.csv", force="100.0")[0])


def bend_tip():
    """Place of the tip under 600: the continuous equations."""
    return place(rows("continuous/static_bend_45.csv", case="1/6", force="600.0")[0])


def pendulum_motion():
    """Time and place of the bob [s, m]: Exudyn, extrapolated."""
    return [(float(row["time"]), place(row)) for row in rows("exudyn/wilberforce.csv", run="limit")]


def cantilever_motion():
    """Time and place of the tip [s, m]: PyElastica, extrapolated."""
    return [(float(row["time"]), place(row)) for row in rows("pyelastica/soft_cantilever.csv")]


def largest_distance(places, reference):
    """Of places at the times of a reference."""
    assert len(places) == len(reference), "samples are missing"
    return max(math.dist(place, exact) for place, (_, exact) in zip(places, reference))


def fastest(once, quick):
    """`once` returns the seconds of its solve and its error; the least seconds of some runs, and the error."""
    best, error, spent, number = math.inf, None, 0.0, 0
    while number < (1 if quick else MOST) and (number == 0 or spent < ENOUGH):
        gc.collect()
        seconds, error = once()
        best, spent, number = min(best, seconds), spent + seconds, number + 1
    return best, error


def timed(action):
    """Processor time of this process, and what the action returned."""
    start = time.process_time()
    result = action()
    return time.process_time() - start, result


def tell(problem, series, setting, seconds, error):
    """One line on stdout for `scripts/bench_peers`; a program that failed to solve tells no seconds."""
    print(json.dumps({"problem": problem, "series": series, "setting": setting, "seconds": seconds, "error": error}), flush=True)


def quick():
    return "--quick" in sys.argv[1:]
