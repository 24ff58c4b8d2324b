"""This project's program on the problems, by its command line.

The program has one thread. The processor time of its solve is no more than what it reports as `seconds.solve`, by the wall
clock and without reading the scene, building the model and writing files; and no more than the processor time of the whole
process, files and all. The lesser of these two is taken, on a quiet machine the first. Every run is a process of its
own, so that nothing is warm but the files.
"""

import csv
import json
import os
import subprocess
import tempfile
from pathlib import Path

import measure
import soft_cantilever
from measure import ROOT

PROGRAM = ROOT / "target" / "release" / "cosserat"


def run(scene, overrides):
    """Seconds of the solve, and the probes of every row; None if it stopped early."""
    with tempfile.TemporaryDirectory() as folder:
        command = [PROGRAM, "run", scene, "--out", folder, "--quiet"]
        command += [part for entry in overrides for part in ("--set", entry)]
        with (Path(folder) / "said").open("w+") as said:
            started = subprocess.Popen(command, stdout=said, stderr=said)
            _, status, usage = os.wait4(started.pid, 0)
            started.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            if started.returncode not in (0, 3):
                raise SystemExit(f"{' '.join(map(str, command))}\n{said.read()}")
        if started.returncode == 3:
            return None
        seconds = json.loads((Path(folder) / "summary.json").read_text(encoding="utf-8"))["seconds"]["solve"]
        with (Path(folder) / "probes.csv").open(newline="", encoding="utf-8") as file:
            return min(seconds, usage.ru_utime + usage.ru_stime), list(csv.DictReader(file))


def probe(row, name):
    return [float(row[f"{name}.{axis}"]) for axis in "xyz"]


def at_times(rows, name, reference):
    """Places of a probe at the reference's times, which must be among the rows."""
    by_time = {round(float(row["time"]), 9): probe(row, name) for row in rows}
    return [by_time[round(time, 9)] for time, _ in reference]


def rod(degree, elements, interpolation="r12"):
    return [f"rod.0.degree={degree}", f"rod.0.elements={elements}", f'rod.0.interpolation="{interpolation}"']


def ladder(quick, problem, scene, series, settings, error):
    """Tells every run of a series: `settings` are (label, overrides), `error` takes the rows."""
    for label, overrides in settings[:2] if quick else settings:
        def once():
            found = run(scene, overrides)
            return (found[0], error(found[1])) if found else (float("nan"), None)
        seconds, off = measure.fastest(once, quick)
        if off is not None:
            measure.tell(problem, series, label, seconds, off)


def spring(quick):
    exact = measure.spring_tip()

    def error(rows):
        first, last = probe(rows[0], "tip"), probe(rows[-1], "tip")
        return measure.math.dist([b - a for a, b in zip(first, last)], exact)

    fixed = ['rod.0.reference={kind="nodes"}', "statics={}"]
    for degree, meshes in (2, (75, 104, 150, 300, 600)), (4, (21, 30, 45, 75)), (6, (15, 24, 40, 62)):
        settings = [(f"{n} elements", rod(degree, n) + fixed) for n in meshes]
        ladder(quick, "spring", ROOT / "scenes" / "helical_spring.toml", f"cosserat, degree {degree}", settings, error)
    settings = [(f"{n} elements", rod(1, n, "se3") + fixed) for n in (75, 150, 300, 600)]
    ladder(quick, "spring", ROOT / "scenes" / "helical_spring.toml", "cosserat, SE(3)", settings, error)


def bend(quick):
    exact = measure.bend_tip()
    # The exact tip has the axes of the scene: x along the tangent at the clamp, y towards the centre.
    error = lambda rows: measure.math.dist(probe(rows[-1], "tip"), exact)
    fixed = ["statics={increments=1}"]
    for degree, meshes in (2, (4, 8, 16, 32, 64)), (4, (2, 4, 8)):
        settings = [(f"{n} elements", rod(degree, n) + fixed) for n in meshes]
        ladder(quick, "bend", ROOT / "scenes" / "bend_45.toml", f"cosserat, degree {degree}", settings, error)
    settings = [(f"{n} elements", rod(1, n, "se3") + fixed) for n in (8, 16, 32, 64, 128)]
    ladder(quick, "bend", ROOT / "scenes" / "bend_45.toml", "cosserat, SE(3)", settings, error)


def pendulum(quick):
    reference = measure.pendulum_motion()
    error = lambda rows: measure.largest_distance(at_times(rows, "bob", reference), reference)
    fixed = ['rod.0.reference={kind="nodes"}']
    for degree, steps in (2, ((18, 5), (24, 5), (36, 5), (48, 2.5))), (4, ((6, 5), (8, 5), (8, 2.5), (9, 1.25))):
        settings = [
            (f"{n} elements, {ms:g} ms",
             rod(degree, n) + fixed + ["dynamics.end_time=2.0", f"dynamics.time_step={ms * 1e-3}"])
            for n, ms in steps
        ]
        ladder(quick, "pendulum", ROOT / "scenes" / "wilberforce.toml", f"cosserat, degree {degree}", settings, error)
    # Two-node elements, as the peers have them, with the meshes and steps of Exudyn.
    settings = [
        (f"{n} elements, {ms:g} ms",
         rod(1, n, "se3") + fixed + ["dynamics.end_time=2.0", f"dynamics.time_step={ms * 1e-3}"])
        for n, ms in ((24, 5), (48, 5), (72, 2.5), (96, 2.5))
    ]
    ladder(quick, "pendulum", ROOT / "scenes" / "wilberforce.toml", "cosserat, SE(3)", settings, error)
    # The paper's 8 s; the reference ends after 2 s, and so does the error.
    settings = [("37 nodes, 5 ms", rod(2, 18) + fixed)]
    ladder(quick, "paper", ROOT / "scenes" / "wilberforce.toml", "cosserat, degree 2", settings, error)


def cantilever(quick):
    """The rod of scripts/references/pyelastica_rods.py."""
    given = soft_cantilever.parameters()
    names = "axial shear_y shear_z torsion bending_y bending_z".split()
    section = ", ".join(f"{name} = {value}" for name, value in zip(names, given["stiffness"]))
    text = f"""
gravity = [0.0, 0.0, {-given["gravity"]}]

[[rod]]
name = "rod"
curve = {{ kind = "line", length = {given["length"]} }}
section = {{ kind = "custom", {section}, mass_per_length = {given["mass_per_length"]}, \
rotary_inertia = {given["rotary_inertia"]} }}
elements = 8

[[joint]]
kind = "rigid"
between = ["ground", "rod@0"]

[[load]]
kind = "force"
on = "rod@1"
value = [0.0, {given["force"]}, 0.0]
time = [[0.0, 0.0], [{given["ramp"]}, 1.0]]

[[probe]]
name = "tip"
on = "rod@1"

[dynamics]
end_time = 1.0
time_step = 1e-3
"""
    reference = measure.cantilever_motion()
    error = lambda rows: measure.largest_distance(at_times(rows, "tip", reference), reference)
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "cantilever.toml"
        scene.write_text(text, encoding="utf-8")
        for degree, steps in (
            (2, ((4, 10), (4, 5), (6, 2.5), (8, 1.25), (16, 0.625))), (4, ((2, 10), (2, 5), (3, 2.5), (4, 1.25), (6, 0.625)))
        ):
            settings = [
                (f"{n} elements, {ms:g} ms", rod(degree, n) + [f"dynamics.time_step={ms * 1e-3}"]) for n, ms in steps
            ]
            ladder(quick, "cantilever", scene, f"cosserat, degree {degree}", settings, error)


def main():
    quick = measure.quick()
    for problem in spring, bend, pendulum, cantilever:
        problem(quick)


if __name__ == "__main__":
    main()
