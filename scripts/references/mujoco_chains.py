"""Chains and trees of rigid bodies with MuJoCo: joint-space dynamics without any multipliers.

Three mechanisms fall freely under gravity from a moving start: a long chain of seven bodies whose ball joints and oblique
hinges alternate, a tree on a ball joint whose first body carries two branches, and a free body that carries two others.
Geometry and inertias are drawn once from a seeded generator and rounded to 1e-3; every body has three different moments of
inertia about turned axes.

In MuJoCo all body frames are parallel to the inertial one at the start, with their origins in the joints; armature,
damping, contacts, limits and constraints are off, and so are its lower bounds of mass and inertia. A ball joint's
velocity is the relative angular velocity in the child's frame, a free joint's is (inertial velocity, angular velocity in
the body's frame).

The trajectories are MuJoCo's accelerations q̈(q, q̇), integrated by the Dormand-Prince method of order 8 (SciPy) with
q̇ = ½ q ∘ ω for quaternions, and again with a hundred times the tolerance. MuJoCo's own RK4, with exponentials for
quaternions, is run beside them with three steps: it shows order 4 and ends in the same places.
"""

from dataclasses import dataclass

import mujoco
import numpy as np
from scipy.integrate import solve_ivp

from datapackage import Field, Table, fields, root

GRAVITY = [0.0, 0.0, -9.81]
TIMES = [round(0.1 * k, 1) for k in range(11)]
TOLERANCE = 1e-13
RK4_STEPS = [4e-3, 2e-3, 1e-3]

# Body, the one it hangs on, and the joint between them.
MECHANISMS = {
    "chain": [(f"b{k}", f"b{k - 1}" if k > 1 else "ground", ["hinge", "ball"][k % 2]) for k in range(1, 8)],
    "tree": [
        ("trunk", "ground", "ball"),
        ("left", "trunk", "hinge"),
        ("right", "trunk", "ball"),
        ("leaf", "right", "hinge"),
    ],
    "free": [("base", "", "free"), ("arm", "base", "hinge"), ("tail", "base", "ball")],
}
SEEDS = {"chain": 1, "tree": 2, "free": 3}
# Largest joint velocity at the start [m/s, rad/s].
RATES = {"chain": 4.0, "tree": 6.0, "free": 12.0}
JOINT_KINDS = {"hinge": "revolute", "ball": "spherical"}


@dataclass
class Part:
    """A body at the start, in inertial components but for the inertia about its principal axes."""

    name: str
    parent: str
    joint: str
    anchor: np.ndarray
    axis: np.ndarray
    centre: np.ndarray
    orientation: np.ndarray
    mass: float
    inertia: np.ndarray
    """The joint's velocity."""
    rate: np.ndarray


def unit(vector):
    return vector / np.linalg.norm(vector)


def draw(scene):
    """The parts of a mechanism."""
    random = np.random.default_rng(SEEDS[scene])
    around = lambda middle, width, size: np.round(middle + width * random.uniform(-1, 1, size), 3)
    parts, tips = [], {"ground": [np.zeros(3)], "": [np.zeros(3)]}
    for name, parent, joint in MECHANISMS[scene]:
        anchor = tips[parent].pop() if len(tips[parent]) > 1 else tips[parent][0]
        along = around(np.array([0.12, 0.08, -0.12]), 0.15, 3)
        centre = anchor if joint == "free" else np.round(anchor + 0.5 * along + around(0.0, 0.03, 3), 4)
        mass = float(around(1.0, 0.5, 1)[0])
        # Second moments of a lump of mass: no inertia then exceeds the sum of the other two.
        second = mass * around(0.005, 0.004, 3)
        rate = around(0.0, RATES[scene], {"free": 6, "ball": 3, "hinge": 1}[joint])
        parts.append(
            Part(name, parent, joint, anchor, unit(around(0.0, 1.0, 3)), centre, unit(around(0.0, 1.0, 4)), mass,
                 np.round(second.sum() - second, 6), rate)
        )
        tips[name] = [anchor + np.array([-0.15, 0.2, 0.1]), anchor + along] if name in ("trunk", "base") else [anchor + along]
    return parts


def xml(parts):
    """The mechanism in MuJoCo's language."""
    words = lambda values: " ".join(repr(float(x)) for x in np.atleast_1d(values))

    def body(part):
        start = next((other.anchor for other in parts if other.name == part.parent), np.zeros(3))
        axis = f' axis="{words(part.axis)}"' if part.joint == "hinge" else ""
        return (
            f'<body name="{part.name}" pos="{words(part.anchor - start)}"><joint type="{part.joint}"{axis}/>'
            f'<inertial pos="{words(part.centre - part.anchor)}" quat="{words(part.orientation)}" '
            f'mass="{part.mass!r}" diaginertia="{words(part.inertia)}"/>'
            + "".join(body(child) for child in parts if child.parent == part.name)
            + "</body>"
        )

    roots = "".join(body(part) for part in parts if part.parent in ("", "ground"))
    return (
        '<mujoco><compiler boundmass="0" boundinertia="0" balanceinertia="false" angle="radian"/>'
        f'<option integrator="RK4" gravity="{words(GRAVITY)}">'
        '<flag contact="disable" constraint="disable" energy="enable"/></option>'
        f"<worldbody>{roots}</worldbody></mujoco>"
    )


def quaternion_rate(quaternion, turn):
    """½ q ∘ ω with ω in the turning frame."""
    scalar, vector = quaternion[0], quaternion[1:]
    return 0.5 * np.concatenate([[-vector @ turn], scalar * turn + np.cross(vector, turn)])


class Mechanism:
    """MuJoCo's model with the start."""

    def __init__(self, scene):
        self.parts = draw(scene)
        self.model = mujoco.MjModel.from_xml_string(xml(self.parts))
        self.data = mujoco.MjData(self.model)
        model = self.model
        assert not model.dof_armature.any() and not model.dof_damping.any() and not model.jnt_stiffness.any()
        ids = [model.body(part.name).id for part in self.parts]
        assert np.array_equal(model.body_inertia[ids], [part.inertia for part in self.parts])
        self.ids = dict(zip([part.name for part in self.parts], ids))
        self.start_position = model.qpos0.copy()
        self.start_velocity = np.zeros(model.nv)
        for part in self.parts:
            first = model.jnt_dofadr[model.body_jntadr[self.ids[part.name]]]
            self.start_velocity[first : first + len(part.rate)] = part.rate

    def set(self, position, velocity):
        """Evaluates everything in a state."""
        self.data.qpos[:], self.data.qvel[:] = position, velocity
        mujoco.mj_forward(self.model, self.data)

    def right_hand_side(self, _, state):
        """(q̇, q̈)."""
        model, data = self.model, self.data
        position, velocity = np.split(state, [model.nq])
        self.set(position, velocity)
        rate = np.zeros(model.nq)
        for kind, q, v in zip(model.jnt_type, model.jnt_qposadr, model.jnt_dofadr):
            if kind == mujoco.mjtJoint.mjJNT_FREE:
                rate[q : q + 3] = velocity[v : v + 3]
                q, v = q + 3, v + 3
            if kind == mujoco.mjtJoint.mjJNT_HINGE:
                rate[q] = velocity[v]
            else:
                rate[q : q + 4] = quaternion_rate(position[q : q + 4], velocity[v : v + 3])
        return np.concatenate([rate, data.qacc])

    def integrate(self, tolerance):
        """(q, q̇) at the times of the tables."""
        start = np.concatenate([self.start_position, self.start_velocity])
        found = solve_ivp(self.right_hand_side, (0, TIMES[-1]), start, "DOP853", TIMES, rtol=tolerance, atol=tolerance)
        assert found.success
        return [np.split(state, [self.model.nq]) for state in found.y.T]

    def rk4(self, step):
        """Centres of mass at the end by MuJoCo's own method."""
        self.model.opt.timestep = step
        mujoco.mj_resetData(self.model, self.data)
        self.set(self.start_position, self.start_velocity)
        for _ in range(round(TIMES[-1] / step)):
            mujoco.mj_step(self.model, self.data)
        mujoco.mj_forward(self.model, self.data)
        return self.data.xipos[1:].copy()

    def poses(self):
        """(x y z, quaternion) of the bodies' principal axes."""
        for name, index in self.ids.items():
            quaternion = np.zeros(4)
            mujoco.mju_mat2Quat(quaternion, self.data.ximat[index])
            yield name, self.data.xipos[index].tolist(), quaternion.tolist()

    def velocities(self):
        """Of the centre of mass, inertial, and angular in the body's principal axes."""
        for name, index in self.ids.items():
            both = np.zeros(6)
            mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_BODY, index, both, 0)
            yield name, both[3:].tolist(), (self.data.ximat[index].reshape(3, 3).T @ both[:3]).tolist()

    def reactions(self):
        """(f, m) of the joints on their second bodies, inertial, about the joint's point.

        MuJoCo's cfrc_int is (moment, force) of the parent on the body about the centre of mass of the whole tree.
        """
        mujoco.mj_rnePostConstraint(self.model, self.data)
        for part in self.parts:
            if part.joint == "free":
                continue
            index = self.ids[part.name]
            moment, force = np.split(self.data.cfrc_int[index], 2)
            centre = self.data.subtree_com[self.model.body_rootid[index]]
            moment = moment + np.cross(centre - self.data.xpos[index], force)
            free = moment if part.joint == "ball" else self.data.xmat[index].reshape(3, 3) @ part.axis @ moment
            assert np.abs(free).max() < 1e-11, "a ball has no moment, a hinge none about its axis"
            yield part.name, force.tolist(), moment.tolist()


def observe(mechanism, scene, states):
    """Rows of the tables that change in time, and the places of all bodies at the end."""
    tables = {"motion": [], "reactions": [], "energies": []}
    for time, state in zip(TIMES, states, strict=True):
        mechanism.set(*state)
        potential, kinetic = mechanism.data.energy
        tables["energies"].append([scene, time, kinetic, potential])
        tables["motion"] += [[scene, time, name, *place, *q] for name, place, q in mechanism.poses()]
        tables["reactions"] += [[scene, time, name, *f, *m] for name, f, m in mechanism.reactions()]
    return tables, mechanism.data.xipos[1:].copy()


def describe(mechanism, scene):
    """Rows of the tables that say what the mechanism is."""
    mechanism.set(mechanism.start_position, mechanism.start_velocity)
    bodies, joints = [], []
    for part, (_, place, quaternion), (_, velocity, turn) in zip(
        mechanism.parts, mechanism.poses(), mechanism.velocities(), strict=True
    ):
        bodies.append([scene, part.name, part.mass, *part.inertia, *place, *quaternion, *velocity, *turn])
        if part.joint != "free":
            joints.append([scene, part.name, JOINT_KINDS[part.joint], part.parent, *part.anchor, *part.axis])
    return {"bodies": bodies, "joints": joints}


def difference(first, second):
    """Largest difference of two tables' numbers; quaternions with their signs as they are."""
    numbers = lambda rows: np.array([[x for x in row if not isinstance(x, str)] for row in rows], dtype=float)
    return np.abs(numbers(first) - numbers(second)).max()


def follow(scene):
    """Rows of all tables of one mechanism; how far they are known."""
    mechanism = Mechanism(scene)
    described = describe(mechanism, scene)
    exact, ends = observe(mechanism, scene, mechanism.integrate(TOLERANCE))
    rough, _ = observe(mechanism, scene, mechanism.integrate(100 * TOLERANCE))
    errors = {name: difference(exact[name], rough[name]) for name in exact}
    total = [kinetic + potential for _, _, kinetic, potential in exact["energies"]]
    errors["conserved"] = np.ptp(total)
    distances = [np.abs(mechanism.rk4(step) - ends).max() for step in RK4_STEPS]
    errors["rk4"], errors["order"] = distances[-1], np.log2(distances[-2] / distances[-1])
    assert 3.8 < errors["order"] < 4.2, errors
    return described | exact, errors


VECTOR = "x y z"
QUATERNION = "qw qx qy qz"
SCENE = Field("scene", "", "chain, tree or free", type="string")
TIME = Field("time", "s", "time")

INPUT = {
    "bodies": [
        SCENE,
        Field("body", "", "name; in the order in which they hang on each other", type="string"),
        Field("mass", "kg", "mass"),
        *fields("ixx iyy izz", "kg m²", "moment of inertia {} about the centre of mass and principal axes"),
        *fields(VECTOR, "m", "centre of mass at the start, {}"),
        *fields(QUATERNION, "1", "from the principal axes to the inertial basis at the start, {}", 1e-15),
        *fields("vx vy vz", "m/s", "velocity of the centre of mass at the start, {}", 1e-13),
        *fields("wx wy wz", "rad/s", "angular velocity at the start, principal axes, {}", 1e-13),
    ],
    "joints": [
        SCENE,
        Field("joint", "", "name, that of its second body", type="string"),
        Field("kind", "", "spherical or revolute", type="string"),
        Field("first", "", "ground, or the first body", type="string"),
        *fields(VECTOR, "m", "its point at the start, {}"),
        *fields("ax ay az", "1", "axis of a revolute joint at the start, {}"),
    ],
}
OUTPUT = {
    "motion": [
        SCENE,
        TIME,
        Field("body", "", "name", type="string"),
        *fields(VECTOR, "m", "centre of mass, {}", 3e-12),
        *fields(QUATERNION, "1", "from the principal axes to the inertial basis, either sign, {}", 3e-12),
    ],
    "reactions": [
        SCENE,
        TIME,
        Field("joint", "", "name", type="string"),
        *fields("fx fy fz", "N", "force on the second body, inertial, {}", 3e-10),
        *fields("mx my mz", "N m", "moment about the joint's point on the second body, inertial, {}", 3e-10),
    ],
    "energies": [
        SCENE,
        TIME,
        Field("kinetic", "J", "kinetic energy", 1e-10),
        Field("gravity", "J", "potential energy, zero at the origin", 1e-10),
    ],
}
TITLES = {
    "bodies": "Three mechanisms of rigid bodies: the bodies at the start",
    "joints": "Three mechanisms of rigid bodies: the joints at the start",
    "motion": "Three mechanisms of rigid bodies: poses of the bodies",
    "reactions": "Three mechanisms of rigid bodies: forces and moments of the joints",
    "energies": "Three mechanisms of rigid bodies: energies",
}
BOUNDS = {"motion": 1e-11, "reactions": 1e-9, "energies": 1e-10}


def main():
    tables, errors = {}, {}
    for scene in MECHANISMS:
        rows, errors[scene] = follow(scene)
        for name, part in rows.items():
            tables.setdefault(name, []).extend(part)
    worst = lambda what: max(found[what] for found in errors.values())
    for name, columns in (INPUT | OUTPUT).items():
        if name in INPUT:
            accuracy, method = "given; velocities to rounding", "velocities follow from those of the joints by MuJoCo's kinematics"
        else:
            # The errors go with the tolerance: the finer run's are a hundredth of the difference.
            assert worst(name) < 10 * BOUNDS[name], errors
            accuracy = f"{BOUNDS[name]:.0e} in the units of the columns"
            method = (
                f"two tolerances of the integration, {TOLERANCE:.0e} and a hundred times that, differ by {worst(name):.0e}, "
                f"which is the error of the second; "
                f"the total energy stays within {worst('conserved'):.0e} J; MuJoCo's own RK4 with h = {RK4_STEPS[-1]} s "
                f"shows order 4 and ends within {worst('rk4'):.0e} m"
            )
        Table(
            source="mujoco",
            name="chains_" + name,
            title=TITLES[name],
            fields=columns,
            rows=tables[name],
            accuracy=accuracy,
            accuracy_method=method,
            parameters={"gravity": GRAVITY, "tolerance": TOLERANCE, "rk4_steps": RK4_STEPS, "seeds": SEEDS},
            tools=["mujoco", "numpy", "scipy"],
        ).write(root())


if __name__ == "__main__":
    main()
