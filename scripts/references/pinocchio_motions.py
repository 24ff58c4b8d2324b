"""Exponential, logarithm and tangents of rigid motions, and poses of a free flyer: Pinocchio and mpmath.

Conventions, accuracy and what is left out as in pinocchio_kinematics.py; tangents by their upper half (J | J'). The
free flyer's difference, interpolation, integration and derivative of the difference are Pinocchio's of
JointModelFreeFlyer; weak_ranges.csv holds how many digits Pinocchio's maps lose where.
"""

import numpy as np
import pinocchio as pin
from datapackage import Field, Table, fields, root
from mpmath import mpf
from pinocchio_kinematics import (
    METHOD,
    MOVES,
    ROTATION,
    SEED,
    TOOLS,
    Samples,
    angles,
    double,
    exact,
    exp3,
    exp6,
    jexp6,
    jlog6,
    keys,
    log3,
    log6,
    norm,
    pair,
    product,
    rotation,
    rotation_quaternion,
    store,
    weak,
)

TANGENT = " ".join(f"{block}{i}{j}" for block in "jk" for i in "123" for j in "123")

MODEL = pin.Model()
MODEL.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "free")


def sample_twist(samples, angle):
    return np.concatenate([samples.vector(2.0), samples.rotation_vector(angle(samples))])


def motion_exponential(samples):
    rows = []
    for group, angle in angles("beyond"):
        for _ in range(40):
            twist = sample_twist(samples, angle)
            theirs = pin.exp6(twist)
            rows += pair([group], [twist], exp6(exact(twist)), (theirs.translation, theirs.rotation))
    return rows


def motion_logarithm(samples):
    rows = []
    for group, angle in angles("pi", nearest=-5):
        for _ in range(40):
            r, psi = samples.vector(2.0), samples.rotation_vector(angle(samples))
            a = double(exp3(exact(psi)))
            theirs = None if weak("log6", np.linalg.norm(psi)) else [pin.log6(pin.SE3(a, r)).vector]
            rows += pair([group], [r, a], [log6(exact(r), exact(a))], theirs)
    return rows


def top(matrix):
    """Upper half of [[J, J'], [0, J]], which must be what it looks like."""
    if np.abs(matrix[3:, :3]).max() > 1e-15 or np.abs(matrix[3:, 3:] - matrix[:3, :3]).max() > 1e-15:
        raise ArithmeticError("a tangent of another form")
    return matrix[:3, :3], matrix[:3, 3:]


def motion_tangents(samples):
    rows = []
    for group, angle in angles("2 pi"):
        for _ in range(25):
            twist = sample_twist(samples, angle)
            x, size = exact(twist), np.linalg.norm(twist[3:])
            theirs = None if weak("Jexp6", size) else top(pin.Jexp6(twist))
            rows += pair(["Jexp6", group], [twist], jexp6(x), theirs)
            known = size < np.pi and not weak("Jlog6", size)
            theirs = top(pin.Jlog6(pin.exp6(twist))) if known else None
            rows += pair(["Jlog6", group], [twist], jlog6(x), theirs)
    return rows


def configuration(position, q):
    """Of a free flyer."""
    return np.concatenate([position, q[1:], q[:1]])


def pose(q):
    return q[:3], pin.Quaternion(np.asarray(q[3:])).matrix()


def after(position, matrix, twist):
    """The pose that a twist in the body basis leads to."""
    r, a = exp6(twist)
    return position + matrix.dot(r), matrix.dot(a)


def flyer(samples, angle):
    """Two poses that a twist leads from and to, with the second rounded to doubles, and the twist."""
    position, q, twist = samples.vector(3.0), samples.quaternion(), sample_twist(samples, angle)
    x = exact(q)
    r, _ = exp6(exact(twist))
    end = exact(position) + rotation(x).dot(r)
    turned = product(x, rotation_quaternion(exact(twist[3:])))
    return position, q, double(end), double(turned / norm(turned)), twist


def free_flyer(samples):
    """Poses (r0, q0), (r1, q1): the twist between them, the pose at a part u of the way, the end of a given twist."""
    rows = []
    for group, angle in angles("pi", nearest=-5):
        for _ in range(25):
            r0, q0, r1, q1, twist = flyer(samples, angle)
            part = samples.number(0.0, 1.0)
            x0, a0 = exact(r0), rotation(exact(q0))
            between = log6(a0.T.dot(exact(r1) - x0), a0.T.dot(rotation(exact(q1))))
            ours = (between, *after(x0, a0, between * mpf(part)), *after(x0, a0, exact(twist)))
            start, end = configuration(r0, q0), configuration(r1, q1)
            theirs = (
                pin.difference(MODEL, start, end),
                *pose(pin.interpolate(MODEL, start, end, part)),
                *pose(pin.integrate(MODEL, start, twist)),
            )
            known = not weak("log6", np.linalg.norm(twist[3:]))
            rows += pair([group], [r0, q0, r1, q1, [part], twist], ours, theirs if known else None)
    return rows


def free_flyer_tangents(samples):
    """Derivatives of that twist with respect to body increments of the first and of the second pose."""
    rows = []
    for group, angle in angles("pi", nearest=-5):
        for _ in range(15):
            r0, q0, r1, q1, _ = flyer(samples, angle)
            a0 = rotation(exact(q0))
            between = log6(a0.T.dot(exact(r1) - exact(r0)), a0.T.dot(rotation(exact(q1))))
            ours = [tuple(-part for part in jlog6(-between)), jlog6(between)]
            known = not weak("Jlog6", np.linalg.norm(double(between[3:])))
            start, end = configuration(r0, q0), configuration(r1, q1)
            for which, argument in enumerate([pin.ARG0, pin.ARG1]):
                theirs = top(pin.dDifference(MODEL, start, end, argument)) if known else None
                rows += pair([str(which), group], [r0, q0, r1, q1], ours[which], theirs)
    return rows


def results(twist):
    """Pinocchio's maps by name, each beside the right values; no logarithms beyond half a turn."""
    psi, x = twist[3:], exact(twist)
    motion = pin.exp6(twist)
    both = jexp6(x)
    yield "Jexp3", [pin.Jexp3(psi)], both[:1]
    yield "Jexp6", top(pin.Jexp6(twist)), both
    if np.linalg.norm(psi) < np.pi:
        back = jlog6(x)
        yield "Jlog3", [pin.Jlog3(motion.rotation)], back[:1]
        yield "Jlog6", top(pin.Jlog6(motion)), back
        r, a = exact(motion.translation), exact(motion.rotation)
        yield "log3", [pin.log3(motion.rotation)], [log3(a)]
        yield "log6", [pin.log6(motion).vector], [log6(r, a)]


def weak_ranges(samples):
    """Largest error of an entry of Pinocchio's logarithms and tangents by ranges of the angle, to one digit."""
    rows = []
    for group, angle in angles("2 pi", nearest=-5):
        worst = {}
        for _ in range(40):
            for name, theirs, right in results(sample_twist(samples, angle)):
                # Jexp6 returns no numbers within 1e-8 of a full turn.
                if all(np.isfinite(part).all() for part in theirs):
                    error = max(abs(exact(a) - b).max() for a, b in zip(theirs, right))
                    worst[name] = max(worst.get(name, 0.0), float(error))
        rows += [[name, group, float(f"{error:.0e}")] for name, error in sorted(worst.items())]
    return rows


def main():
    samples = Samples(SEED + 1)
    twist = fields("v_x v_y v_z", "m", "twist, translation, {}") + fields("x y z", "rad", "twist, rotation, {}")
    position = fields("r_x r_y r_z", "m", "position, {}", **MOVES)
    matrix = fields(ROTATION, "1", "rotation matrix, entry {}", **MOVES)
    out = fields("v_x v_y v_z", "m", "twist, translation, {}", **MOVES)
    out += fields("x y z", "rad", "twist, rotation, {}", **MOVES)
    tangent = fields(TANGENT, "1 or m", "entry {} of the tangent's upper half (J | J')", **MOVES)
    poses = [
        column
        for k in "01"
        for column in fields(f"r{k}_x r{k}_y r{k}_z", "m", "pose {}, position")
        + fields(f"q{k}_w q{k}_x q{k}_y q{k}_z", "1", "pose {}, unit quaternion to within rounding")
    ]
    store(
        "motion_exponential",
        "Exponential of SE(3)",
        keys("range", "by") + twist + position + matrix,
        motion_exponential(samples),
    )
    store(
        "motion_logarithm",
        "Logarithm of the motion nearest to a position and a matrix",
        keys("range", "by") + position + matrix + out,
        motion_logarithm(samples),
    )
    store(
        "motion_tangents",
        "Right tangent of the exponential of SE(3) (Jexp6) and its inverse (Jlog6)",
        keys("map", "range", "by") + twist + tangent,
        motion_tangents(samples),
    )
    ends = [
        column
        for name, what in [("u", "at the part u of the way"), ("e", "after the given twist")]
        for column in fields(f"{name}_x {name}_y {name}_z", "m", f"pose {what}, {{}}", **MOVES)
        + fields(ROTATION.replace("a", name), "1", f"pose {what}, matrix entry {{}}", **MOVES)
    ]
    store(
        "free_flyer",
        "Two poses of a free flyer: the twist between them, a pose between them; and the pose after a twist",
        keys("range", "by") + poses + [Field("u", "1", "part of the way")]
        + fields("g_x g_y g_z", "m", "given twist, translation, {}")
        + fields("h_x h_y h_z", "rad", "given twist, rotation, {}") + out + ends,
        free_flyer(samples),
    )
    store(
        "free_flyer_tangents",
        "Derivative of the twist between two poses with respect to body increments of either",
        keys("argument", "range", "by") + poses + tangent,
        free_flyer_tangents(samples),
    )
    Table(
        source="pinocchio",
        name="weak_ranges",
        title="Largest error of an entry of Pinocchio's logarithms and tangents by ranges of the angle",
        fields=keys("map", "range")
        + [Field("error", "1, rad or m", "largest error", tolerance=1e-14, relative_tolerance=4.0)],
        rows=weak_ranges(samples),
        accuracy="one digit of the largest error of 40 samples; another machine may find another by its rounding",
        accuracy_method=METHOD,
        parameters={"seed": SEED + 1, "samples": 40},
        tools=TOOLS,
    ).write(root())


if __name__ == "__main__":
    main()
