"""Exudyn on the problems: its geometrically exact beam elements, two nodes, SE(3), as in scripts/references.

Statics: equilibria of Exudyn at load factors one after the other, Newton's method started from the extrapolation of the ones
before (scripts/references/exudyn_beams.py), which for the spring takes an eighth of the time of Exudyn's own load steps;
for the bend whichever of the two is faster. Motion: generalized-alpha, spectral radius 0.8, constant steps, full Newton
iterations: the kept tangent, Exudyn's default, takes twice the time here. The tolerance on the cantilever, whose axial
stiffness is that of PyElastica's sixteen-fold one, is 1e-4 of the residual a step begins with: below some 1e-5 the
iteration stalls, and the error of the motion is the same as with 1e-5 where that converges, to four digits. One thread;
the time is that of Exudyn's solver alone. Meshes and steps are paired so that neither is wasted on the other.
"""

import math
import sys
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "references"))

import exudyn as exu
import exudyn_beams as beams
import exudyn_wilberforce as wilberforce
import numpy as np
from exudyn.itemInterface import (
    Force, GenericJoint, MarkerBodyRigid, MarkerNodeRigid, NodeRigidBodyRotVecLG, ObjectBeamGeometricallyExact, SensorNode,
)

import measure
import soft_cantilever

SERIES = "Exudyn"


def followed(problem, elements, exact):
    """All increments, and the distance of the end's displacement or place from the exact one; infinite where no increment
    is short enough."""
    rod = beams.Rod(problem, elements)
    try:
        seconds, found = measure.timed(lambda: beams.follow(rod, problem))
    except AssertionError:
        return math.inf, math.inf
    return seconds, math.dist(found[-1][-1][:3] - exact[0], exact[1])


def stepped(problem, elements, exact, steps):
    """Exudyn's own load steps."""
    rod = beams.Rod(problem, elements)
    static = rod.settings.staticSolver
    static.numberOfLoadSteps, static.adaptiveStep, static.useLoadFactor = steps, True, True
    rod.mbs.SetLoadParameter(rod.force, "loadVector", [float(f) for f in problem.force])
    try:
        seconds, _ = measure.timed(lambda: rod.mbs.SolveStatic(rod.settings))
    except exu.SolverError:
        return math.inf, math.inf
    end = (rod.mbs.systemData.GetODE2Coordinates().reshape(-1, 7) + rod.reference)[-1][:3]
    return seconds, math.dist(end - exact[0], exact[1])


def statics(quick):
    problems = {problem.name: problem for problem in beams.problems()}
    bend = replace(problems["bend_45"], stops=[1.0])
    exact = np.zeros(3), measure.bend_tip()
    for n in (8, 16) if quick else (8, 16, 32, 64, 128):
        ways = [lambda: followed(bend, n, exact)] + [
            lambda steps=steps: stepped(bend, n, exact, steps) for steps in (1, 3, 5, 10)]
        seconds, error = min(measure.fastest(way, quick) for way in ways)
        measure.tell("bend", SERIES, f"{n} elements", seconds, error)
    spring = replace(problems["spring"], force=[0, 0, 100], stops=[1.0], first=1e-4)
    exact = spring.frame(1)[0], measure.spring_tip()
    for n in (38,) if quick else (75, 150, 300):
        seconds, error = measure.fastest(lambda: followed(spring, n, exact), quick)
        if seconds < math.inf:
            measure.tell("spring", SERIES, f"{n} elements", seconds, error)
        else:
            print(f"spring: Exudyn, {n} elements: no solution", file=sys.stderr)


def settings(end, step, tolerance):
    s = exu.SimulationSettings()
    s.solution.file.write = False
    # Of every step; a period of the samples is missed by rounding.
    s.solution.sensors.writePeriod = step / 2
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    time = s.timeIntegration
    time.verboseMode, time.endTime, time.numberOfSteps, time.adaptiveStep = 0, end, round(end / step), False
    time.generalizedAlpha.spectralRadius = 0.8
    newton = time.newton
    newton.relativeTolerance, newton.absoluteTolerance, newton.useModifiedNewton = tolerance, 1e-6, False
    return s


def moved(build, end, step, reference, tolerance):
    """Seconds of a motion, infinite if it fails, and the largest distance from the reference; `build` gives the system and
    a sensor of places."""
    mbs, sensor = build()
    s = settings(end, step, tolerance)
    try:
        seconds, _ = measure.timed(lambda: mbs.SolveDynamic(s, solverType=exu.DynamicSolverType.GeneralizedAlpha))
    except exu.SolverError:
        return math.inf, math.inf
    by_time = {round(row[0], 6): row[1:4] for row in mbs.GetSensorStoredData(sensor)}
    return seconds, measure.largest_distance([by_time[round(time, 6)] for time, _ in reference], reference)


def motions(quick, problem, build, end, reference, tolerance, runs):
    for elements, milliseconds in runs[:2] if quick else runs:
        once = lambda: moved(lambda: build(elements), end, 1e-3 * milliseconds, reference, tolerance)
        seconds, error = measure.fastest(once, quick)
        if seconds < math.inf:
            measure.tell(problem, SERIES, f"{elements} elements, {milliseconds:g} ms", seconds, error)


def pendulum(elements):
    mbs, sensors = wilberforce.pendulum(elements)
    return mbs, sensors[0]


def cantilever(elements):
    """The rod of scripts/references/pyelastica_rods.py; weight and tip force on the nodes."""
    mbs = exu.SystemContainer().AddSystem()
    given = soft_cantilever.parameters()
    section = exu.BeamSection()
    section.stiffnessMatrix = np.diag(given["stiffness"])
    section.massPerLength, section.inertia = given["mass_per_length"], np.diag(given["rotary_inertia"])
    size = given["length"] / elements
    nodes = [mbs.AddNode(NodeRigidBodyRotVecLG(referenceCoordinates=[size * k, 0, 0, 0, 0, 0])) for k in range(elements + 1)]
    for pair in zip(nodes[:-1], nodes[1:]):
        mbs.AddObject(ObjectBeamGeometricallyExact(nodeNumbers=list(pair), length=size, sectionData=section))
    markers = [mbs.AddMarker(MarkerNodeRigid(nodeNumber=node)) for node in nodes]
    ground = mbs.AddMarker(MarkerBodyRigid(bodyNumber=mbs.CreateGround()))
    mbs.AddObject(GenericJoint(markerNumbers=[ground, markers[0]]))
    for k, marker in enumerate(markers):
        part = size if 0 < k < elements else size / 2
        mbs.AddLoad(Force(markerNumber=marker, loadVector=[0, 0, -given["gravity"] * given["mass_per_length"] * part]))

    def push(mbs, time, load):
        return [0, given["force"] * min(1.0, time / given["ramp"]), 0]

    mbs.AddLoad(Force(markerNumber=markers[-1], loadVector=[0, given["force"], 0], loadVectorUserFunction=push))
    sensor = mbs.AddSensor(SensorNode(
        nodeNumber=nodes[-1], storeInternal=True, outputVariableType=exu.OutputVariableType.Position))
    mbs.Assemble()
    return mbs, sensor


def main():
    quick = measure.quick()
    # What is loaded when it is first used is in no measurement.
    stepped(replace(beams.problems()[1], stops=[1.0]), 4, (np.zeros(3), measure.bend_tip()), 10)
    statics(quick)
    reference = measure.pendulum_motion()
    motions(quick, "pendulum", pendulum, 2.0, reference, 1e-8, [(24, 5), (48, 5), (72, 2.5), (96, 2.5)])
    if not quick:
        motions(quick, "paper", pendulum, 8.0, reference, 1e-8, [(36, 5)])
    reference = measure.cantilever_motion()
    motions(quick, "cantilever", cantilever, 1.0, reference, 1e-4, [(8, 10), (16, 10), (32, 5), (48, 2.5), (64, 1.25)])


if __name__ == "__main__":
    main()
