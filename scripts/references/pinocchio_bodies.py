"""One free rigid body of unequal moments of inertia: Pinocchio's free flyer, and mpmath.

Newton's and Euler's equations about the centre of mass, principal axes, body basis where it says so:

    a = g + (f + A h)/m      Theta omega' = n + d x A^T f - omega x Theta omega
    T = (m v.v + omega.Theta omega)/2, p = m v, L = A Theta omega (inertial, about the centre of mass)

for an inertial force f at the lever d (body basis), a force h of the body basis at the centre of mass and a moment n of
the body basis. mpmath: those, with 110 digits, for the doubles of the row, quaternions of any norm. Pinocchio:
`computeKineticEnergy`, `ccrba`, `aba` with `fext`, `centerOfMass`. It describes the body in its own frame ("centred"),
or in one that is shifted from the centre of mass and turned against the principal axes ("offset"), where every formula
has other terms.
"""

import numpy as np
import pinocchio as pin
from datapackage import Field, Table, fields, root
from mpmath import mpf
from pinocchio_kinematics import MOVES, SEED, TOOLS, Samples, double, exact, keys, pair, rotation


def sample(samples):
    """Mass, inertia, position, quaternion, velocity, omega, gravity, force, lever, body force, moment."""
    mass = double(samples.power(-1, 2)).item()
    x, y, z = (samples.number(0.02, 1.0) for _ in range(3))
    inertia = mass * np.array([y + z, z + x, x + y]) * samples.number(0.1, 1.0)
    quaternion = samples.vector(1.0, 4) * double(samples.power(-3, 3)).item()
    return (
        mass,
        inertia,
        samples.vector(5.0),
        quaternion,
        samples.vector(10.0),
        samples.vector(double(samples.power(-2, 2)).item()),
        samples.vector(10.0),
        samples.vector(50.0),
        samples.vector(1.0),
        samples.vector(50.0),
        samples.vector(20.0),
    )


def ours(mass, inertia, position, quaternion, velocity, omega, gravity, force, lever, push, moment):
    m, theta, v, w, f = mpf(mass), exact(inertia), exact(velocity), exact(omega), exact(force)
    a = rotation(exact(quaternion))
    spin = theta * w
    energy = (m * v.dot(v) + w.dot(spin)) / 2
    acceleration = exact(gravity) + (f + a.dot(exact(push))) / m
    torque = exact(moment) + np.cross(exact(lever), a.T.dot(f)) - np.cross(w, spin)
    return [energy], m * v, a.dot(spin), acceleration, torque / theta


def theirs(shift, turn, mass, inertia, position, quaternion, velocity, omega, gravity, force, lever, push, moment):
    """The frame's origin is at -`shift` from the centre of mass in its basis, which `turn` leads to from the body's."""
    w, x, y, z = quaternion / np.linalg.norm(quaternion)
    principal = pin.Quaternion(w, x, y, z).matrix()
    frame = principal @ turn.T
    model = pin.Model()
    joint = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "free")
    tensor = turn @ np.diag(inertia) @ turn.T
    model.appendBodyToJoint(joint, pin.Inertia(mass, shift, (tensor + tensor.T) / 2), pin.SE3.Identity())
    model.gravity.linear = gravity
    data = model.createData()
    q = pin.SE3ToXYZQUAT(pin.SE3(frame, position - frame @ shift))
    spin = turn @ omega
    u = np.concatenate([frame.T @ velocity - np.cross(spin, shift), spin])
    at_centre = [(frame.T @ force, turn @ lever), (turn @ push, np.zeros(3))]
    wrench = pin.Force(sum(f for f, _ in at_centre), turn @ moment + sum(np.cross(shift + d, f) for f, d in at_centre))
    wrenches = pin.StdVec_Force()
    wrenches.append(pin.Force.Zero())
    wrenches.append(wrench)
    rate = pin.aba(model, data, q, u, np.zeros(6), wrenches).copy()
    pin.centerOfMass(model, data, q, u, rate)
    acceleration = data.acom[0].copy()
    pin.ccrba(model, data, q, u)
    energy = pin.computeKineticEnergy(model, data, q, u)
    return [energy], data.hg.linear.copy(), data.hg.angular.copy(), acceleration, turn.T @ rate[3:]


def main():
    samples = Samples(SEED + 2)
    rows = []
    for group in ["centred", "offset"]:
        for _ in range(150):
            body = sample(samples)
            shift, turn = samples.vector(1.0), pin.exp3(samples.rotation_vector(samples.number(0.1, 3.0)))
            if group == "centred":
                shift, turn = np.zeros(3), np.eye(3)
            rows += pair([group], body, ours(*body), theirs(shift, turn, *body))
    columns = [Field("frame", "", "Pinocchio's frame: centred or offset", type="string"), *keys("by")]
    columns += [Field("mass", "kg", "mass")]
    for name, unit, what in [
        ("inertia", "kg m2", "principal moment of inertia"),
        ("r", "m", "centre of mass"),
    ]:
        columns += fields(f"{name}_x {name}_y {name}_z", unit, what + ", {}")
    columns += fields("q_w q_x q_y q_z", "1", "quaternion of any norm, body to inertial, {}")
    for name, unit, what in [
        ("v", "m/s", "velocity of the centre of mass, inertial"),
        ("omega", "rad/s", "angular velocity, body basis"),
        ("g", "m/s2", "gravity"),
        ("force", "N", "force, inertial"),
        ("lever", "m", "lever of that force, body basis"),
        ("push", "N", "force at the centre of mass, body basis"),
        ("moment", "N m", "moment, body basis"),
    ]:
        columns += fields(f"{name}_x {name}_y {name}_z", unit, what + ", {}")
    columns += [Field("energy", "J", "kinetic energy", **MOVES)]
    for name, unit, what in [
        ("p", "kg m/s", "linear momentum, inertial"),
        ("l", "kg m2/s", "angular momentum about the centre of mass, inertial"),
        ("a", "m/s2", "acceleration of the centre of mass, inertial"),
        ("alpha", "rad/s2", "rate of the angular velocity, body basis"),
    ]:
        columns += fields(f"{name}_x {name}_y {name}_z", unit, what + ", {}", 1e-9, 1e-12)
    Table(
        source="pinocchio",
        name="free_body",
        title="A free rigid body: energy, momenta, accelerations",
        fields=columns,
        rows=rows,
        accuracy="mpmath: all 20 digits; pinocchio: 1e-12 of the sum of the sizes of the terms",
        accuracy_method="110 digits; pinocchio differs from mpmath by no more",
        parameters={"seed": SEED + 2, "bodies": 300},
        tools=TOOLS,
    ).write(root())


if __name__ == "__main__":
    main()
