"""Chains of two and three bodies in space under gravity, in Exudyn: ball joints, oblique hinges, a rigid joint.

Modelled: rigid bodies by mass and principal inertia about the centre of mass, Euler-parameter nodes in absolute
coordinates; every joint an ObjectJointGeneric between two rigid markers whose frames agree at the start (all axes of
the inertial frame; of a hinge, z along its axis), with three, five or six locked axes. The implicit trapezoidal rule
with the constraints at velocity level (TrapezoidalIndex2), full Newton, tolerances 1e-10 relative and 1e-12 absolute.
  spherical   ground - ball - body 1 - ball - body 2
  revolute    ground - hinge - body 1 - hinge - body 2, axes oblique to each other and to everything else
  rigid       ground - ball - body 1 - rigid - body 2 - hinge - body 3
each from rest and moving. Quaternions (w, x, y, z) from the body to the inertial basis. A joint's force and moment act
on the second of its pair, at the joint's point, in inertial components.

How the accuracy is judged: steps h, h/2, h/4 and two Richardson extrapolations of order 2, of positions, quaternions,
velocities and joint forces alike; the second is what is stored. The errors stored beside it are the sum of two things,
each the largest up to that time and over all bodies (joints) of the chain: the distance of the two extrapolations, and
the distance to an integration that has nothing to do with Exudyn (accelerations and multipliers from
[[M, G^T], [G, 0]], in time by scipy's DOP853). The second must not exceed the first more than threefold.
"""

import exudyn
import numpy as np
from datapackage import Field, Table, fields, root
from exudyn.utilities import GenericJoint, MarkerBodyRigid, ObjectGround, RigidBodyInertia, SensorObject
from exudyn_rigid_bodies import cross, quaternions, sensor, solve, stored
from scipy.integrate import solve_ivp

GRAVITY = np.array([0.0, 0.0, -9.81])
STEP, END, EVERY = 1e-3, 1.5, 0.05
REFINEMENTS = (1, 2, 4)
TOLERANCES = (1e-10, 1e-12)
BODIES = [
    dict(mass=1.2, inertia=[0.02, 0.03, 0.04], x=[0.25, 0.1, -0.15], q=[0.8, 0.0, 0.6, 0.0]),
    dict(mass=0.8, inertia=[0.03, 0.012, 0.02], x=[0.6, 0.35, -0.45], q=[0.6, 0.0, 0.64, 0.48]),
    dict(mass=0.5, inertia=[0.008, 0.006, 0.004], x=[1.0, 0.4, -0.7], q=[0.5, 0.5, -0.5, 0.5]),
]
"""Kind, the pair (None: ground), point, axis (the z axis of the joint)."""
JOINTS = {
    "spherical": [
        ("spherical", None, 0, [0.0, 0.0, 0.0], None),
        ("spherical", 0, 1, [0.45, 0.2, -0.25], None),
    ],
    "revolute": [
        ("revolute", None, 0, [0.0, 0.0, 0.0], [2.0, 1.0, 2.0]),
        ("revolute", 0, 1, [0.45, 0.2, -0.25], [-1.0, 2.0, 2.0]),
    ],
    "rigid": [
        ("spherical", None, 0, [0.0, 0.0, 0.0], None),
        ("rigid", 0, 1, [0.45, 0.2, -0.25], None),
        ("revolute", 1, 2, [0.8, 0.5, -0.6], [2.0, -2.0, 1.0]),
    ],
}
"""Angular velocity of each joint's second body relative to its first at the start of `moving`, inertial."""
SPEEDS = {
    "spherical": [[0.5, -1.0, 2.0], [-2.0, 1.8, -3.0]],
    "revolute": [[2.0, 1.0, 2.0], [0.5, -1.0, -1.0]],
    "rigid": [[1.0, -0.5, 1.5], [0.0, 0.0, 0.0], [2.0, -2.0, 1.0]],
}
"""Locked directions of rotation: z of a hinge is free."""
LOCKED = {"spherical": 0, "revolute": 2, "rigid": 3}

"""ForceLocal acts on the first of the pair, in the first marker's basis. TorqueLocal holds the multipliers of z0 x1 and
z0 y1 (hinge) or of z0 y1, z0 x1 and x0 y1 (rigid; unit vectors of the two markers); their moments on the second body,
in the second marker's basis."""
MOMENT = {
    "spherical": np.zeros((3, 3)),
    "revolute": np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 0]]),
    "rigid": np.diag([-1.0, 1, 1]),
}


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def matrix(q):
    """Rotation matrix of a quaternion of any norm."""
    q = np.asarray(q) / np.linalg.norm(q)
    v = skew(q[1:])
    return np.eye(3) + 2 * (q[0] * v + v @ v)


def frame(axis):
    """A right-handed basis with z along the axis; the inertial one without."""
    if axis is None:
        return np.eye(3)
    z = np.array(axis) / np.linalg.norm(axis)
    x = cross(z, np.eye(3)[np.argmin(np.abs(z))])
    x /= np.linalg.norm(x)
    return np.column_stack([x, cross(z, x), z])


def start(chain, moving):
    """Velocity and angular velocity of every body, both inertial."""
    found = []
    for (_, i, j, point, _), speed in zip(JOINTS[chain], SPEEDS[chain]):
        v, w = (np.zeros(3), np.zeros(3)) if i is None else found[i]
        before = point if i is None else BODIES[i]["x"]
        turn = w + np.array(speed) * moving
        v = v + cross(w, np.subtract(point, before)) + cross(turn, np.subtract(BODIES[j]["x"], point))
        found.append((v, turn))
    return found


# ---------------------------------------------------------------- Exudyn


def run(chain, moving, refinement):
    """Bodies [time, body, (x q v omega)] and joints [time, joint, (f m)]; omega in the body basis, f and m inertial."""
    mbs = exudyn.SystemContainer().AddSystem()
    ground, bodies = mbs.AddObject(ObjectGround()), []
    for body, (v, w) in zip(BODIES, start(chain, moving)):
        bodies.append(mbs.CreateRigidBody(
            inertia=RigidBodyInertia(mass=body["mass"], inertiaTensor=np.diag(body["inertia"])),
            nodeType=exudyn.NodeType.RotationEulerParameters,
            referencePosition=body["x"],
            referenceRotationMatrix=matrix(body["q"]),
            initialVelocity=list(v),
            initialAngularVelocity=list(w),
            gravity=list(GRAVITY),
        ))
    outputs = ("Position", "RotationMatrix", "Velocity", "AngularVelocityLocal")
    seen = [[sensor(mbs, body, output) for output in outputs] for body in bodies]
    felt = [joint(mbs, ground, bodies, *each) for each in JOINTS[chain]]

    def implicit(options):
        options.newton.relativeTolerance, options.newton.absoluteTolerance = TOLERANCES
        options.newton.useModifiedNewton = False

    solve(mbs, END, round(END / STEP) * refinement, EVERY, "TrapezoidalIndex2", implicit)
    motion, turns = [], []
    for sensors in seen:
        x, a, v, w = (stored(mbs, each, END, EVERY) for each in sensors)
        motion.append(np.hstack([x, quaternions(a), v, w]))
        turns.append(a.reshape(-1, 3, 3))
    forces = []
    for (kind, i, j, _, axis), sensors in zip(JOINTS[chain], felt):
        first, second = (
            frame(axis) if k is None else turns[k] @ matrix(BODIES[k]["q"]).T @ frame(axis) for k in (i, j)
        )
        force, moment = (stored(mbs, each, END, EVERY)[:, :, None] for each in sensors)
        forces.append(np.hstack([(first @ -force)[:, :, 0], (second @ MOMENT[kind] @ moment)[:, :, 0]]))
    return np.stack(motion, axis=1), np.stack(forces, axis=1)


def joint(mbs, ground, bodies, kind, i, j, point, axis):
    """Adds a joint; its sensors of force and moment."""
    markers = []
    for k in (i, j):
        a, x = (np.eye(3), np.zeros(3)) if k is None else (matrix(BODIES[k]["q"]), BODIES[k]["x"])
        place = exudyn.HT(a.T @ frame(axis), a.T @ np.subtract(point, x))
        markers.append(mbs.AddMarker(MarkerBodyRigid(bodyNumber=ground if k is None else bodies[k], localHT=place)))
    axes = [1, 1, 1] + [int(k < LOCKED[kind]) for k in range(3)]
    number = mbs.AddObject(GenericJoint(markerNumbers=markers, constrainedAxes=axes))
    kinds = exudyn.OutputVariableType.ForceLocal, exudyn.OutputVariableType.TorqueLocal
    return [
        mbs.AddSensor(SensorObject(objectNumber=number, storeInternal=True, outputVariableType=each)) for each in kinds
    ]


def unit(motion):
    """With unit quaternions."""
    motion = motion.copy()
    motion[..., 3:7] /= np.linalg.norm(motion[..., 3:7], axis=-1)[..., None]
    return motion


def extrapolated(coarse, fine):
    """Two runs without their errors c h^2."""
    return unit(fine[0] + (fine[0] - coarse[0]) / 3), fine[1] + (fine[1] - coarse[1]) / 3


# ---------------------------------------------------------------- without Exudyn


def independent(chain, moving):
    """The same from  M a + G^T lambda = f, G a = gamma  by DOP853."""
    joints, n = JOINTS[chain], len(start(chain, moving))
    arms = [[arm(k, point, axis) for k in (i, j)] for _, i, j, point, axis in joints]

    def solved(y):
        y = y.reshape(n, 13)
        a = [matrix(b[3:7]) for b in y]
        w = [a[k] @ y[k, 10:] for k in range(n)]
        inverse, force, rows, right, levers = np.zeros((6 * n, 6 * n)), np.zeros(6 * n), [], [], []
        for k, body in enumerate(BODIES[:n]):
            at = slice(6 * k + 3, 6 * k + 6)
            inverse[6 * k:6 * k + 3, 6 * k:6 * k + 3] = np.eye(3) / body["mass"]
            inverse[at, at] = a[k] @ np.diag(1 / np.array(body["inertia"])) @ a[k].T
            momentum = a[k] @ (body["inertia"] * y[k, 10:])
            force[6 * k:6 * k + 6] = [*(body["mass"] * GRAVITY), *-cross(w[k], momentum)]
        for (kind, i, j, _, _), sides in zip(joints, arms):
            rigid = [(np.eye(3), np.zeros(3)) if k is None else (a[k], w[k]) for k in (i, j)]
            # r_j - r_i = 0, and e (omega_j - omega_i) = 0 for the locked directions e, which turn with the first.
            locked = (rigid[0][0] @ sides[0][1])[:, :LOCKED[kind]].T
            block, bias = np.zeros((3 + len(locked), 6 * n)), np.zeros(3 + len(locked))
            for k, (turn, spin), (r, _), sign in zip((i, j), rigid, sides, (-1, 1)):
                r = turn @ r
                bias[:3] -= sign * cross(spin, cross(spin, r))
                if k is not None:
                    block[:3, 6 * k:6 * k + 6] = sign * np.hstack([np.eye(3), -skew(r)])
                    block[3:, 6 * k + 3:6 * k + 6] = sign * locked
            for row, e in enumerate(locked):
                bias[3 + row] = -cross(rigid[0][1], e) @ (rigid[1][1] - rigid[0][1])
            rows.append(block)
            right.append(bias)
            levers.append(locked)
        g, gamma = np.vstack(rows), np.concatenate(right)
        multipliers = np.linalg.solve(g @ inverse @ g.T, gamma - g @ inverse @ force)
        return a, inverse @ (force + g.T @ multipliers), multipliers, levers

    def rate(_, y):
        a, acceleration, _, _ = solved(y)
        out = np.zeros((n, 13))
        for k, body in enumerate(y.reshape(n, 13)):
            q, w, turning = body[3:7], body[10:], acceleration[6 * k:6 * k + 6]
            out[k, :3], out[k, 7:10] = body[7:10], turning[:3]
            out[k, 3], out[k, 4:7] = -0.5 * q[1:] @ w, 0.5 * (q[0] * w + cross(q[1:], w))
            out[k, 10:] = a[k].T @ turning[3:]
        return out.ravel()

    y0 = [np.concatenate([b["x"], b["q"], v, matrix(b["q"]).T @ w]) for b, (v, w) in zip(BODIES, start(chain, moving))]
    times = np.arange(round(END / EVERY) + 1) * EVERY
    path = solve_ivp(rate, (0, END), np.concatenate(y0), "DOP853", times, rtol=3e-14, atol=1e-14).y.T
    forces = np.zeros((len(times), len(joints), 6))
    for row, y in enumerate(path):
        _, _, multipliers, levers = solved(y)
        for k, locked in enumerate(levers):
            forces[row, k, :3], multipliers = multipliers[:3], multipliers[3:]
            forces[row, k, 3:], multipliers = locked.T @ multipliers[:len(locked)], multipliers[len(locked):]
    return unit(path.reshape(len(times), n, 13)), forces


def arm(k, point, axis):
    """From a body's centre to a joint, and the joint's basis, in the body's basis."""
    a, x = (np.eye(3), np.zeros(3)) if k is None else (matrix(BODIES[k]["q"]), BODIES[k]["x"])
    return a.T @ np.subtract(point, x), a.T @ frame(axis)


# ---------------------------------------------------------------- tables


def distances(a, b):
    """Largest distances over bodies and joints, row by row: position, rotation, velocity, omega, force, moment."""
    columns = []
    for part, k in ((0, slice(0, 3)), (0, slice(3, 7)), (0, slice(7, 10)), (0, slice(10, 13)), (1, slice(0, 3)),
                    (1, slice(3, 6))):
        p, q = a[part][..., k], b[part][..., k]
        apart = np.linalg.norm(p - q, axis=-1)
        if k == slice(3, 7):
            apart = 4 * np.arcsin(np.minimum(apart, np.linalg.norm(p + q, axis=-1)) / 2)
        columns.append(apart.max(axis=-1))
    return np.column_stack(columns)


def energy_drift(chain, motion):
    """Largest change of the energy, relative to the largest kinetic energy."""
    kinetic, total = 0.0, 0.0
    for k in range(motion.shape[1]):
        m, inertia = BODIES[k]["mass"], BODIES[k]["inertia"]
        x, v, w = motion[:, k, :3], motion[:, k, 7:10], motion[:, k, 10:]
        kinetic = kinetic + 0.5 * m * (v * v).sum(axis=1) + 0.5 * (w * w) @ inertia
        total = total - m * x @ GRAVITY
    total = total + kinetic
    return np.abs(total - total[0]).max() / kinetic.max()


def solved(chain, moving):
    """The second extrapolation, its errors up to each time, and the worst figures for the descriptor."""
    runs = [run(chain, moving, refinement) for refinement in REFINEMENTS]
    first, second = extrapolated(*runs[:2]), extrapolated(*runs[1:])
    other = independent(chain, moving)
    # At the start there are no forces yet, and the rest is given.
    sequence, outside = distances(first, second)[1:], distances(second, other)[1:]
    if (outside.max(axis=0) > 3 * sequence.max(axis=0)).any():
        raise RuntimeError(f"{chain}: {outside.max(axis=0)} off, estimated {sequence.max(axis=0)}")
    errors = np.maximum.accumulate(sequence + outside)
    orders = np.log2(distances(*runs[:2])[1:, :5].max(axis=0) / distances(*runs[1:])[1:, :5].max(axis=0))
    return second, errors, (sequence.max(axis=0), outside.max(axis=0), energy_drift(chain, second[0]), orders)


def said(errors):
    """The six errors in words."""
    units = ("m", "rad", "m/s", "rad/s", "N", "N m")
    return ", ".join(f"{error:.0e} {unit}" for error, unit in zip(errors, units))


def main():
    exudyn.config.printToConsole = False
    motion, reactions, worst = [], [], []
    for chain in JOINTS:
        for name in ("rest", "moving"):
            (bodies, forces), errors, figures = solved(chain, name == "moving")
            worst.append(figures)
            for k, error in enumerate(errors, start=1):
                time = round(k * EVERY, 9)
                for body, values in enumerate(bodies[k], start=1):
                    motion.append([chain, name, str(body), time, *values, *error[:4]])
                for joint, values in enumerate(forces[k], start=1):
                    reactions.append([chain, name, str(joint), time, *values, *error[4:]])
    sequence, outside, drift, orders = (np.array(each) for each in zip(*worst))
    accuracy = said((sequence + outside).max(axis=0)) + " in the worst chain; the columns say it for each"
    method = (
        "positions, rotations, velocities, angular velocities, forces, moments of two Richardson extrapolations from "
        f"h, h/2 and h/4 differ by at most {said(sequence.max(axis=0))}; those of an integration with multipliers by "
        f"DOP853, without Exudyn, by {said(outside.max(axis=0))}; the errors are the sums. Orders before the "
        f"extrapolation: {orders.min():.2f} to {orders.max():.2f}; the energy changes by {drift.max():.0e} of the "
        "largest kinetic one"
    )
    parameters = {
        "solver": "TrapezoidalIndex2",
        "node": "RotationEulerParameters",
        "relative and absolute tolerance": list(TOLERANCES),
        "step": STEP,
        "refinements": list(REFINEMENTS),
        "gravity": list(GRAVITY),
        "bodies": BODIES,
        "joints (kind, pair, point, axis)": JOINTS,
        "angular velocities of the joints when moving": SPEEDS,
    }
    keys = [
        Field("chain", "1", "spherical, revolute or rigid", type="string"),
        Field("start", "1", "rest or moving", type="string"),
    ]
    time = Field("time", "s", "time from the start")
    common = dict(source="exudyn", accuracy=accuracy, accuracy_method=method, parameters=parameters)
    upto = "error of the {}, no larger up to this time in this chain"
    Table(
        name="chain_motion",
        title="Chains of bodies on ball joints, oblique hinges and a rigid joint: motion in space under gravity",
        fields=[
            *keys,
            Field("body", "1", "1, 2 or 3", type="string"),
            time,
            *fields("x y z", "m", "centre of mass, inertial, {}", tolerance=2e-9),
            *fields("qw qx qy qz", "1", "unit quaternion, body to inertial basis, {}", tolerance=1e-8),
            *fields("vx vy vz", "m/s", "velocity of the centre of mass, inertial, {}", tolerance=3e-8),
            *fields("wx wy wz", "rad/s", "angular velocity, body basis, {}", tolerance=1e-7),
            Field("position_error", "m", upto.format("positions"), tolerance=2e-9),
            Field("rotation_error", "rad", upto.format("rotations"), tolerance=1e-8),
            Field("velocity_error", "m/s", upto.format("velocities"), tolerance=3e-8),
            Field("angular_velocity_error", "rad/s", upto.format("angular velocities"), tolerance=1e-7),
        ],
        rows=motion,
        tools=["exudyn", "numpy", "scipy"],
        **common,
    ).write(root())
    Table(
        name="chain_reactions",
        title="Chains of bodies on ball joints, oblique hinges and a rigid joint: what the joints transmit",
        fields=[
            *keys,
            Field("joint", "1", "1, 2 or 3", type="string"),
            time,
            *fields("fx fy fz", "N", "force on the second of the pair, inertial, {}", tolerance=1e-5),
            *fields("mx my mz", "N m", "moment on the second at the joint, inertial, {}", tolerance=1e-5),
            Field("force_error", "N", upto.format("forces"), tolerance=1e-5),
            Field("moment_error", "N m", upto.format("moments"), tolerance=1e-5),
        ],
        rows=reactions,
        tools=["exudyn", "numpy", "scipy"],
        **common,
    ).write(root())


if __name__ == "__main__":
    main()
