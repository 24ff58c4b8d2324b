"""Motion of the Wilberforce pendulum by Exudyn's geometrically exact beam elements.

A steel wire, three coils of radius 16 mm and pitch 1 mm, clamped at its upper end (z = 3 mm); a steel cylinder hangs at
its lower end (z = 0), its centre of mass on the axis of the helix at z = -18.5 mm. Gravity acts on the bob only, from
t = 0; no damping; released at rest from the stress-free helix.

Elements: `ObjectBeamGeometricallyExact`, interpolated on SE(3), with its consistent mass (mass and rotary inertia of the
wire, rho diag(2I, I, I)), reference strains from nodes with the exact frames of the helix (see exudyn_beams.py). Bob:
`RigidBody`; bob and clamp are held by rigid joints (index 3). All nodes are of the rotation-vector Lie-group type.
Integrator: generalized-alpha with spectral radius 0.8; full Newton iterations to 1e-9 (Exudyn's default, a tangent that is
kept and 1e-8 of the step's first residual, moves alpha by 1e-3 rad within a second).

Order 2 in time and in the length of the elements. The limit is taken from a ladder of steps on the coarsest mesh and a
ladder of meshes with the longest step, and the change of the first difference in space with the step. Its error is
estimated by what the last extrapolations changed.
"""

import sys
from math import cos, hypot, pi, sin

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    GenericJoint, Gravity, MarkerBodyMass, MarkerBodyRigid, MarkerNodeRigid, NodeRigidBodyRotVecLG,
    ObjectBeamGeometricallyExact, ObjectRigidBody, SensorNode,
)
from scipy.spatial.transform import Rotation

from datapackage import Field, Table, fields, root

SHEAR, POISSON, DENSITY = 81e9, 0.23, 7850.0
DIAMETER, RADIUS, COILS, PITCH = 1e-3, 16e-3, 3, 1e-3
BOB_RADIUS, BOB_HEIGHT, GRAVITY = 23e-3, 36e-3, 9.81
CENTRE = np.array([0, 0, -(BOB_HEIGHT + DIAMETER) / 2])
SLOPE = PITCH / (2 * pi * RADIUS)
LENGTH = 2 * pi * COILS * RADIUS * hypot(1, SLOPE)
END, SAMPLE, SPECTRAL_RADIUS, TOLERANCE = 2.0, 0.05, 0.8, 1e-9
"""Elements and steps [ms] of the runs."""
STEPS = [(24, 2.5), (24, 1.25), (24, 0.625)]
MESHES = [(24, 2.5), (48, 2.5), (96, 2.5)]
BOTH = (48, 1.25)
QUANTITIES = "x y z alpha yaw".split()


def helix(x):
    """Position and frame of tangent, normal, binormal at s/L."""
    a = pi + 2 * pi * COILS * x
    tangent = np.array([cos(a), sin(a), SLOPE]) / hypot(1, SLOPE)
    normal = np.array([-sin(a), cos(a), 0])
    position = RADIUS * np.array([sin(a), -cos(a), SLOPE * (a - pi)])
    return position, np.column_stack([tangent, normal, np.cross(tangent, normal)])


def wire_section():
    young = 2 * SHEAR * (1 + POISSON)
    area, second = pi * DIAMETER**2 / 4, pi * DIAMETER**4 / 64
    section = exu.BeamSection()
    section.stiffnessMatrix = np.diag(
        [young * area, SHEAR * area, SHEAR * area, 2 * SHEAR * second, young * second, young * second])
    section.massPerLength = DENSITY * area
    section.inertia = DENSITY * second * np.diag([2, 1, 1])
    return section


def pendulum(elements):
    """The system and the sensors of the bob's position and rotation matrix."""
    mbs = exu.SystemContainer().AddSystem()
    section, nodes = wire_section(), []
    for k in range(elements + 1):
        position, frame = helix(k / elements)
        coordinates = [*position, *Rotation.from_matrix(frame).as_rotvec()]
        nodes.append(mbs.AddNode(NodeRigidBodyRotVecLG(referenceCoordinates=coordinates)))
    for pair in zip(nodes[:-1], nodes[1:]):
        mbs.AddObject(ObjectBeamGeometricallyExact(
            nodeNumbers=list(pair), length=LENGTH / elements, sectionData=section))
    mass = DENSITY * pi * BOB_RADIUS**2 * BOB_HEIGHT
    across, along = mass * (BOB_RADIUS**2 / 4 + BOB_HEIGHT**2 / 12), mass * BOB_RADIUS**2 / 2
    centre = mbs.AddNode(NodeRigidBodyRotVecLG(referenceCoordinates=[*CENTRE, 0, 0, 0]))
    bob = mbs.AddObject(ObjectRigidBody(
        nodeNumber=centre, mass=mass, inertia=[across, across, along, 0, 0, 0]))
    weight = mbs.AddMarker(MarkerBodyMass(bodyNumber=bob))
    mbs.AddLoad(Gravity(markerNumber=weight, loadVector=[0, 0, -GRAVITY]))
    for body, origin, node, x in (bob, CENTRE, nodes[0], 0), (mbs.CreateGround(), 0 * CENTRE, nodes[-1], 1):
        position, frame = helix(x)
        place = exu.HT(rotation=frame, translation=position - origin)
        held = mbs.AddMarker(MarkerBodyRigid(bodyNumber=body, localHT=place))
        end = mbs.AddMarker(MarkerNodeRigid(nodeNumber=node))
        mbs.AddObject(GenericJoint(markerNumbers=[held, end]))
    sensors = [
        mbs.AddSensor(SensorNode(nodeNumber=centre, storeInternal=True, outputVariableType=output))
        for output in (exu.OutputVariableType.Position, exu.OutputVariableType.RotationMatrix)
    ]
    mbs.Assemble()
    return mbs, sensors


def run(elements, milliseconds):
    """The quantities at multiples of the sample time, a row each."""
    mbs, sensors = pendulum(elements)
    s = exu.SimulationSettings()
    s.solution.file.write = False
    s.solution.sensors.writePeriod = SAMPLE
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    time = s.timeIntegration
    time.verboseMode, time.endTime, time.numberOfSteps = 0, END, round(END / (1e-3 * milliseconds))
    time.generalizedAlpha.spectralRadius = SPECTRAL_RADIUS
    newton = time.newton
    newton.relativeTolerance, newton.absoluteTolerance, newton.useModifiedNewton = TOLERANCE, TOLERANCE, False
    mbs.SolveDynamic(s, solverType=exu.DynamicSolverType.GeneralizedAlpha)
    position, rotation = (mbs.GetSensorStoredData(sensor) for sensor in sensors)
    assert np.allclose(position[:, 0], SAMPLE * np.arange(len(position)), atol=1e-9), "samples are off the grid"
    a = rotation[:, 1:].reshape(-1, 3, 3)
    alpha = np.unwrap(np.arctan2(-a[:, 0, 1], a[:, 0, 0]))
    yaw = np.unwrap(np.arctan2(a[:, 1, 0], a[:, 0, 0]))
    return np.column_stack([position[:, 1:], alpha, yaw])


def extrapolated(coarse, fine):
    return (4 * fine - coarse) / 3


def limit(found):
    """The limit, and its estimated error in x, y, z together and in the larger of both angles."""
    times = [extrapolated(found[a], found[b]) for a, b in zip(STEPS[:-1], STEPS[1:])]
    spaces = [extrapolated(found[a], found[b]) for a, b in zip(MESHES[:-1], MESHES[1:])]
    # After h^2 come h^3 in time and h^4 in space.
    in_time, in_space = (times[1] - times[0]) / 7, (spaces[1] - spaces[0]) / 15
    mixed = 16 / 9 * (found[BOTH] - found[STEPS[1]] - found[MESHES[1]] + found[MESHES[0]])
    best = times[1] + in_time + spaces[1] + in_space - found[MESHES[0]] + mixed
    spread = np.abs(in_time) + np.abs(in_space) + np.abs(mixed) / 4
    return best, np.linalg.norm(spread[:, :3], axis=1), spread[:, 3:].max(axis=1)


def main():
    runs = list(dict.fromkeys([*STEPS, *MESHES, BOTH]))
    found = {parameters: run(*parameters) for parameters in runs}
    best, position_error, angle_error = limit(found)
    rows = []
    for k, time in enumerate(SAMPLE * np.arange(len(best))):
        rows.append([round(time, 6), "limit", *best[k], position_error[k], angle_error[k]])
        for elements, milliseconds in runs:
            values = found[elements, milliseconds][k]
            off = values - best[k]
            name = f"{elements} elements, {milliseconds} ms"
            rows.append([round(time, 6), name, *values, np.linalg.norm(off[:3]), np.abs(off[3:]).max()])
    position, angle = position_error.max(), angle_error.max()
    Table(
        "exudyn", "wilberforce", "Motion of the Wilberforce pendulum: Exudyn's beam elements, a rigid bob",
        [
            Field("time", "s", "time"),
            Field("run", "1", "elements and step, or `limit`: extrapolated", type="string"),
            *fields("x y z", "m", "centre of mass of the bob, {}", 0.2 * position),
            Field("alpha", "rad", "of A = R_x(gamma) R_y(beta) R_z(alpha), unwrapped", 0.2 * angle),
            Field("yaw", "rad", "of A = R_z(yaw) R_y R_x, unwrapped", 0.2 * angle),
            Field("position_error", "m", "estimated distance from the exact position", 0.4 * position),
            Field("angle_error", "rad", "estimated error of the worse angle", 0.4 * angle),
        ],
        rows,
        f"the limit: position {position:.1e} m, angles {angle:.1e} rad or better",
        "three steps on 24 elements and three meshes with 2.5 ms, extrapolated by h^2 and by the term after it (h^3 in time, "
        "h^4 in space), which is the error given; and a quarter of what space and time change together",
        {
            "runs": [list(parameters) for parameters in runs], "endTime": END, "spectralRadius": SPECTRAL_RADIUS,
            "newtonTolerance": TOLERANCE,
            "method": "generalized-alpha, index 3, rotation-vector Lie-group nodes",
        },
        ["exudyn", "numpy", "scipy"],
    ).write(root())


if __name__ == "__main__":
    sys.exit(main())
