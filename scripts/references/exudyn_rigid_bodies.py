"""One rigid body in Exudyn: the flips of a torque-free nut and the heavy top.

Modelled: a body with principal inertia about its reference point, the rotation-vector Lie-group node (no singularity,
no multipliers), the explicit Runge-Kutta method RK67 of order 6 with constant steps and Lie-group updates.
  nut   mass 1, inertia (1, 2, 3), omega0 (0.01, 5, 0.02), no forces: Dzhanibekov's flips.
  top   Geradin & Cardona: the reference point is the fixed point, where the inertia is (15.234375, 0.46875, 15.234375)
        and where the centre of mass is put as well; the weight 15 * 9.81 acts at (0, 1, 0) of the body and its opposite
        at the reference point, which therefore stays where it is without a joint. omega0 (0, 150, -4.61538).

How the accuracy is judged: steps h, h/2, h/4; the stored values are those of h/4. The errors stored beside them are the
sum of the largest distances, up to that time, to those of h/2 (order 6 would leave 1/63 of it; rounding takes the rest)
and to Euler's equations by scipy's DOP853.
"""

import exudyn
import numpy as np
from datapackage import Field, Table, fields, root
from exudyn.utilities import LoadForceVector, MarkerBodyPosition, RigidBodyInertia, SensorBody
from scipy.integrate import solve_ivp

BODIES = {
    "nut": dict(mass=1.0, inertia=[1.0, 2.0, 3.0], omega=[0.01, 5.0, 0.02], weight=0.0, step=2e-2, end=10.0, every=0.1),
    "top": dict(mass=15.0, inertia=[15.234375, 0.46875, 15.234375], omega=[0.0, 150.0, -4.61538], weight=15 * 9.81,
                step=5e-4, end=2.0, every=0.02),
}
"""Where the weight acts [m]; the nut has none."""
LEVER = [0.0, 1.0, 0.0]
REFINEMENTS = (1, 2, 4)
"""What DOP853 itself may be off by, relative to the start."""
DOUBLE = 1e-10


def cross(a, b):
    """np.cross, without its overhead."""
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def quaternions(matrices):
    """Unit quaternions (w, x, y, z) of rotation matrices along a path; w >= 0 in the first, continuous."""
    out = []
    for a in np.reshape(matrices, (-1, 3, 3)):
        # 4 q q^T; its largest column is q, up to the norm.
        square = np.array([
            [1 + a[0, 0] + a[1, 1] + a[2, 2], a[2, 1] - a[1, 2], a[0, 2] - a[2, 0], a[1, 0] - a[0, 1]],
            [0, 1 + a[0, 0] - a[1, 1] - a[2, 2], a[0, 1] + a[1, 0], a[0, 2] + a[2, 0]],
            [0, 0, 1 - a[0, 0] + a[1, 1] - a[2, 2], a[1, 2] + a[2, 1]],
            [0, 0, 0, 1 - a[0, 0] - a[1, 1] + a[2, 2]],
        ])
        square += np.triu(square, 1).T
        q = square[np.argmax(np.diag(square))]
        q = q / np.linalg.norm(q)
        like = out[-1] if out else np.array([1.0, 0, 0, 0])
        out.append(q if q @ like >= 0 else -q)
    return np.array(out)


def sensor(mbs, body, output):
    """A sensor of a body that keeps what it sees."""
    kind = getattr(exudyn.OutputVariableType, output)
    return mbs.AddSensor(SensorBody(bodyNumber=body, storeInternal=True, outputVariableType=kind))


def solve(mbs, end, steps, every, solver, change=lambda options: None):
    """Runs a model with constant steps; what its sensors saw is stored at multiples of `every`, the start included."""
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = every
    options = settings.timeIntegration
    options.verboseMode = 0
    options.numberOfSteps, options.endTime = steps, end
    change(options)
    mbs.SolveDynamic(settings, solverType=getattr(exudyn.DynamicSolverType, solver))


def stored(mbs, sensor, end, every):
    """Rows of a sensor, without the time, which is checked."""
    data = mbs.GetSensorStoredData(sensor)
    times = np.arange(round(end / every) + 1) * every
    if data.shape[0] != len(times) or np.abs(data[:, 0] - times).max() > 1e-9 * end:
        raise RuntimeError(f"times {data[:, 0]} instead of {times}")
    return data[:, 1:]


def run(body, refinement):
    """Quaternions and angular velocities (body basis) at the times that are stored."""
    mbs = exudyn.SystemContainer().AddSystem()
    number = mbs.CreateRigidBody(
        inertia=RigidBodyInertia(mass=body["mass"], inertiaTensor=np.diag(body["inertia"])),
        nodeType=exudyn.NodeType.RotationRotationVector,
        initialAngularVelocity=body["omega"],
    )
    if body["weight"]:
        for place, force in ((LEVER, -body["weight"]), ([0.0, 0.0, 0.0], body["weight"])):
            marker = mbs.AddMarker(MarkerBodyPosition(bodyNumber=number, localPosition=place))
            mbs.AddLoad(LoadForceVector(markerNumber=marker, loadVector=[0.0, 0.0, force]))
    sensors = [sensor(mbs, number, output) for output in ("RotationMatrix", "AngularVelocityLocal")]
    end, every = body["end"], body["every"]

    def explicit(options):
        options.explicit.useLieGroupIntegration = True

    solve(mbs, end, round(end / body["step"]) * refinement, every, "RK67", explicit)
    matrices, omega = (stored(mbs, number, end, every) for number in sensors)
    return np.hstack([quaternions(matrices), omega])


def euler(body):
    """The same by Euler's equations and q' = q omega / 2, DOP853."""
    inertia, times = np.array(body["inertia"]), np.arange(round(body["end"] / body["every"]) + 1) * body["every"]

    def rate(_, y):
        w, (a, b, c, d) = y[4:], y[:4]
        down = -body["weight"] * np.array([2 * (b * d - a * c), 2 * (c * d + a * b), a * a - b * b - c * c + d * d])
        turn = [-b * w[0] - c * w[1] - d * w[2], a * w[0] + c * w[2] - d * w[1], a * w[1] + d * w[0] - b * w[2],
                a * w[2] + b * w[1] - c * w[0]]
        moment = cross(LEVER, down) / (y[:4] @ y[:4])
        return np.concatenate([0.5 * np.array(turn), (moment - cross(w, inertia * w)) / inertia])

    start = np.concatenate([[1.0, 0, 0, 0], body["omega"]])
    path = solve_ivp(rate, (0, times[-1]), start, "DOP853", times, rtol=3e-14, atol=1e-15).y.T
    path[:, :4] /= np.linalg.norm(path[:, :4], axis=1)[:, None]
    return path


def distances(a, b):
    """Angle between the rotations, and distance of the angular velocities, row by row."""
    same = np.minimum(*(np.linalg.norm(a[:, :4] - sign * b[:, :4], axis=1) for sign in (1, -1)))
    return np.column_stack([4 * np.arcsin(same / 2), np.linalg.norm(a[:, 4:] - b[:, 4:], axis=1)])


def motion(name, body):
    """Rows of the table, and the largest distances to the steps h/2 and to Euler's equations."""
    runs = [run(body, refinement) for refinement in REFINEMENTS]
    halved, outside = distances(runs[1], runs[2]), distances(runs[2], euler(body))
    size = np.array([1.0, np.linalg.norm(body["omega"])])
    if (outside.max(axis=0) > halved.max(axis=0) + DOUBLE * size).any():
        raise RuntimeError(f"{name}: off Euler's equations by {outside.max(axis=0)}, estimated {halved.max(axis=0)}")
    errors = np.maximum.accumulate(halved + outside)
    times = [round(k * body["every"], 9) for k in range(len(errors))]
    rows = [[name, time, *values, *error] for time, values, error in zip(times, runs[2], errors)]
    return rows[1:], halved.max(axis=0), outside.max(axis=0)


def said(errors):
    """Largest errors in words."""
    return "; ".join(f"{name}: {angle:.0e} rad, {rate:.0e} rad/s" for name, (angle, rate) in errors.items())


def main():
    exudyn.config.printToConsole = False
    results = {name: motion(name, body) for name, body in BODIES.items()}
    rows = [row for found, _, _ in results.values() for row in found]
    Table(
        source="exudyn",
        name="rigid_body_motion",
        title="Torque-free nut and heavy top: rotation-vector Lie-group node, explicit RK67",
        fields=[
            Field("body", "1", "nut or top", type="string"),
            Field("time", "s", "time from the start"),
            *fields("qw qx qy qz", "1", "unit quaternion, body to inertial basis, {}", tolerance=1e-9),
            *fields("wx wy wz", "rad/s", "angular velocity, body basis, {}", tolerance=1e-8),
            Field("rotation_error", "rad", "error of the rotation up to this time", tolerance=1e-9),
            Field("angular_velocity_error", "rad/s", "error of the angular velocity up to this time", tolerance=1e-8),
        ],
        rows=rows,
        accuracy="rotation and angular velocity at the end (earlier as the columns say): "
        + said({name: found[-1][-2:] for name, (found, _, _) in results.items()}),
        accuracy_method="largest distance between the steps h/2 and h/4 up to the time, order 6: "
        + said({name: halved for name, (_, halved, _) in results.items()})
        + ", and to Euler's equations by DOP853: "
        + said({name: outside for name, (_, _, outside) in results.items()}),
        parameters={
            "solver": "RK67, useLieGroupIntegration",
            "node": "RotationRotationVector",
            "refinements": list(REFINEMENTS),
            "weight acts at": LEVER,
            **BODIES,
        },
        tools=["exudyn", "numpy", "scipy"],
    ).write(root())


if __name__ == "__main__":
    main()
