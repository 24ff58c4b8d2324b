"""Statics of strongly bent rods by Exudyn's geometrically exact beam elements.

`ObjectBeamGeometricallyExact`: two nodes, poses interpolated on SE(3), so strains are constant in an element: they are
1/h log(H₀⁻¹ H₁), divided by the arc length h given as `length`. Its reference strains are those of the reference
coordinates of its nodes, taken by the same logarithm; nodes with the exact frames of the curve are therefore free of
stress whatever their curvature (the script checks that), and a reference of constant curvature (line, arc, helix) is
represented exactly. Stiffnesses diag(EA, GA, GA, GJ, EI, EI) in the frame with e_x along the rod; nothing is corrected for
shear. The first node is held by a rigid joint, the last one is loaded.

Problems: a shear-soft cantilever, a 45 degree bend out of its plane, a straight rod under a moment that turns with
its end and a dead force, a helical spring pulled at the end of its wire.

Newton's method starts from the extrapolation of the solutions at smaller loads: Exudyn's own load steps, which start from
the last solution, need five times as many iterations for the spring. How a solution was found does not matter to it.

Three meshes n, 2n, 4n. The error of the elements is even in their length: the limit is extrapolated by h² and h⁴, and its
error estimated by what the last extrapolation, h⁴, changed.
"""

import sys
from dataclasses import dataclass
from math import cos, hypot, pi, sin

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (
    Force, GenericJoint, MarkerBodyRigid, MarkerNodeRigid, NodeRigidBodyEP, ObjectBeamGeometricallyExact, Torque,
)
from scipy.spatial.transform import Rotation

from datapackage import Field, Table, fields, root

INITIAL = exu.ConfigurationType.Initial


@dataclass
class Problem:
    """A rod held at its start and loaded at its end."""

    name: str
    title: str
    length: float
    """Position and rotation matrix at s/L."""
    frame: object
    """EA, GA_y, GA_z, GJ, EI_y, EI_z."""
    stiffness: list
    """Dead force at the end, and moment in the basis of the end's section."""
    force: list
    moment: list
    """Load factors that are stored."""
    stops: list
    """First increment of the load factor, and what the norm of all nodes' residuals may be [N, N m]."""
    first: float
    tolerance: float
    elements: int


def line(length):
    return lambda x: (np.array([length * x, 0, 0]), np.eye(3))


def arc(radius, angle):
    """Starts along e_x and bends towards e_y."""
    def frame(x):
        a = angle * x
        return radius * np.array([sin(a), 1 - cos(a), 0]), Rotation.from_rotvec([0, 0, a]).as_matrix()
    return frame


def helix(radius, coils, slope):
    """r = (R sin a, -R cos a, R slope a), frame of tangent, normal, binormal."""
    def frame(x):
        a = 2 * pi * coils * x
        tangent = np.array([cos(a), sin(a), slope]) / hypot(1, slope)
        normal = np.array([-sin(a), cos(a), 0])
        position = radius * np.array([sin(a), -cos(a), slope * a])
        return position, np.column_stack([tangent, normal, np.cross(tangent, normal)])
    return frame


def solid(young, shear, area, bending, torsion):
    return [young * area, shear * area, shear * area, shear * torsion, young * bending, young * bending]


def problems():
    bent = 1000.0  # slenderness 100, a square section of width w
    w = bent / 100
    moment = w**4 / 12 * 2 * pi / bent / 4
    d, radius, coils = 1e-3, 10e-3, 10
    slope = 5e-3 / (2 * pi * radius)
    second = pi * d**4 / 64
    spring = solid(1e11, 1e11 / 2.4, pi * d * d / 4, second, 2 * second)
    tenths = [k / 10 for k in range(1, 11)]
    return [
        Problem("cantilever", "Shear-soft cantilever, dead force across its end (alpha^2 = 10)", 2 * pi, line(2 * pi),
                [5, 1, 1, 1, 2, 2], [0, 10 * 2 / (2 * pi) ** 2, 0], [0, 0, 0], tenths, 0.05, 1e-12, 32),
        Problem("bend_45", "45 degree bend, dead force out of its plane", 25 * pi, arc(100, pi / 4),
                solid(1e7, 5e6, 1, 1 / 12, 1 / 6), [0, 0, 600], [0, 0, 0], [k / 20 for k in range(1, 21)], 0.02, 2e-6, 32),
        Problem("twisted", "Straight rod, moment that turns with its end and dead force along e_z", bent, line(bent),
                solid(1, 0.5, w * w, w**4 / 12, w**4 / 6), [0, 0, moment / bent], [0, 0, moment], tenths, 0.05, 1e-9, 32),
        Problem("spring", "Helical spring pulled at the end of its wire", 2 * pi * coils * radius * hypot(1, slope),
                helix(radius, coils, slope), spring, [0, 0, 10], [0, 0, 0], [k / 20 for k in range(1, 21)], 1e-3, 1e-8, 75),
    ]


class Rod:
    """One mesh."""

    def __init__(self, problem, elements):
        self.problem = problem
        self.mbs = mbs = exu.SystemContainer().AddSystem()
        section = exu.BeamSection()
        section.stiffnessMatrix = np.diag(problem.stiffness).astype(float)
        section.massPerLength, section.inertia = 1.0, np.eye(3)  # unused
        self.reference = poses([problem.frame(k / elements) for k in range(elements + 1)])
        nodes = [mbs.AddNode(NodeRigidBodyEP(referenceCoordinates=pose)) for pose in self.reference]
        beams = [
            mbs.AddObject(ObjectBeamGeometricallyExact(
                nodeNumbers=[i, j], length=problem.length / elements, sectionData=section))
            for i, j in zip(nodes[:-1], nodes[1:])
        ]
        position, rotation = problem.frame(0)
        place = exu.HT(rotation=rotation, translation=position)
        ground = mbs.AddMarker(MarkerBodyRigid(bodyNumber=mbs.CreateGround(), localHT=place))
        start = mbs.AddMarker(MarkerNodeRigid(nodeNumber=nodes[0]))
        mbs.AddObject(GenericJoint(markerNumbers=[ground, start]))
        end = mbs.AddMarker(MarkerNodeRigid(nodeNumber=nodes[-1]))
        self.force = mbs.AddLoad(Force(markerNumber=end, loadVector=[0, 0, 0]))
        self.moment = mbs.AddLoad(Torque(markerNumber=end, loadVector=[0, 0, 0], bodyFixed=True))
        mbs.Assemble()
        for beam in beams:
            for output in exu.OutputVariableType.ForceLocal, exu.OutputVariableType.TorqueLocal:
                stress = mbs.GetObjectOutputBody(beam, output, localPosition=[0, 0, 0])
                assert np.abs(stress).max() == 0, "the reference is not free of stress"
        # Rounding of EA times a strain that is a difference of positions over an element's length.
        self.settings = settings(problem.tolerance * elements / problem.elements)
        self.iterations = 0

    def solve(self, factor, guess):
        """Poses (nodes, 7) in equilibrium; None if Newton's method fails."""
        mbs = self.mbs
        mbs.SetLoadParameter(self.force, "loadVector", [factor * f for f in self.problem.force])
        mbs.SetLoadParameter(self.moment, "loadVector", [factor * m for m in self.problem.moment])
        mbs.systemData.SetODE2Coordinates((normalised(guess) - self.reference).ravel(), INITIAL)
        try:
            mbs.SolveStatic(self.settings)
        except exu.SolverError:
            return None
        self.iterations = mbs.sys["staticSolver"].it.newtonStepsCount
        return mbs.systemData.GetODE2Coordinates().reshape(-1, 7) + self.reference


def settings(tolerance):
    s = exu.SimulationSettings()
    s.solution.file.write = False
    s.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    static = s.staticSolver
    static.verboseMode = 0
    static.numberOfLoadSteps, static.adaptiveStep, static.useLoadFactor = 1, False, False
    static.newton.relativeTolerance, static.newton.absoluteTolerance = 1e-14, tolerance
    return s


def poses(frames):
    """Rows (r, q), quaternions scalar first with continuous signs."""
    rows = []
    for position, rotation in frames:
        q = np.roll(Rotation.from_matrix(rotation).as_quat(), 1)
        rows.append(np.concatenate([position, q if not rows or q @ rows[-1][3:] > 0 else -q]))
    return np.array(rows)


def normalised(rows):
    rows = rows.copy()
    rows[:, 3:] /= np.linalg.norm(rows[:, 3:], axis=1)[:, None]
    return rows


def extrapolated(history, factor):
    """The polynomial through the last four solutions."""
    known = history[-4:]
    weights = [np.prod([(factor - b) / (a - b) for b, _ in known if b != a]) for a, _ in known]
    return sum(weight * rows for weight, (_, rows) in zip(weights, known))


def follow(rod, problem):
    """Solutions at the stops, with increments as long as Newton's method allows."""
    history, factor, step, found = [(0.0, rod.reference)], 0.0, problem.first, []
    for stop in problem.stops:
        while factor < stop:
            following = stop if stop - factor < 1.2 * step else factor + step
            rows = rod.solve(following, extrapolated(history, following))
            if rows is None:
                step = (following - factor) / 3
                assert step > 1e-9, "no solution"
                continue
            step *= 1.5 if rod.iterations <= 6 else 0.8 if rod.iterations > 9 else 1.0
            factor = following
            history.append((factor, rows))
        found.append(polished(rod, stop, rows))
    return found


def polished(rod, factor, rows):
    """One Newton step more: what the tolerance left is then as small as rounding."""
    return rod.solve(factor, rows)


def distance(a, b):
    """Of two rows (r, q): in space, and the angle between the rotations."""
    return np.linalg.norm(a[:3] - b[:3]), 2 * np.linalg.norm(a[3:] - b[3:])


def table(problem):
    meshes = [follow(Rod(problem, problem.elements << level), problem) for level in range(3)]
    rows, worst = [], np.zeros(2)
    for k, stop in enumerate(problem.stops):
        a, b, c = (solutions[k][-1] for solutions in meshes)
        first, second = (4 * b - a) / 3, (4 * c - b) / 3
        limit = (16 * second - first) / 15
        limit[3:] /= np.linalg.norm(limit[3:])
        error = distance(limit, second)
        worst = np.maximum(worst, error)
        rows.append([stop, "limit", *limit, *error])
        for level, end in enumerate((a, b, c)):
            rows.append([stop, str(problem.elements << level), *end, *distance(end, limit)])
    # What a rerun may change: a fifth of the accuracy, but no less than what the solver leaves open.
    position, angle = 0.2 * worst
    Table(
        "exudyn", problem.name, f"{problem.title}: pose of the end over the load factor, Exudyn's beam elements",
        [
            Field("factor", "1", "part of the load"),
            Field("elements", "1", "two-node elements, or `limit`: extrapolated", type="string"),
            *fields("x y z", "m", "position of the end, {}", position),
            *fields("qw qx qy qz", "1", "quaternion of the end's section, scalar first, {}", angle),
            Field("position_error", "m", "estimated distance from the exact position", 2 * position),
            Field("rotation_error", "rad", "estimated angle from the exact rotation", 2 * angle),
        ],
        rows,
        f"the limit: position {worst[0]:.1e} m, rotation {worst[1]:.1e} rad or better",
        "three meshes, each twice as fine as the one before, extrapolated by h^2 and then by h^4; the error is what the "
        "extrapolation by h^4 changed, which is the error of the limit before it and more than that after it",
        {
            "length": problem.length, "stiffness": problem.stiffness, "force": problem.force,
            "bodyFixedMoment": problem.moment, "newtonToleranceOfCoarsestMesh": problem.tolerance,
            "elements": [problem.elements << level for level in range(3)],
        },
        ["exudyn", "numpy", "scipy"],
    ).write(root())


def main():
    for problem in problems():
        table(problem)


if __name__ == "__main__":
    sys.exit(main())
