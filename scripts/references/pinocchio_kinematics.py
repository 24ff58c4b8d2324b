"""Maps of rotations and quaternions: Pinocchio, and beside it mpmath with 110 digits, of which at least 50 are right.

Rows in pairs, `by` = "pinocchio" and "mpmath", both for the numbers of the row as they stand, digit by digit.
Conventions: quaternions (w, x, y, z); twists (v, psi) and motions (A, r), translation first; tangents are right ones,
exp(x + d) = exp(x) exp(J d), and J^-1 that of the logarithm; matrices by rows. Pinocchio's Jexp3, Jlog3, Jexp6, Jlog6,
dDifference and free-flyer joint follow the same, its quaternions are (x, y, z, w) in configurations.

mpmath: with hat the cross product matrix, t = |psi|,

    exp psi = 1 + sin t/t hat + b hat^2          b = (1 - cos t)/t^2
    J(psi)  = 1 - b hat + c hat^2                c = (t - sin t)/t^3

and in SE(3) the same with dual numbers, psi + e v for psi (principle of transference), so that the tangent is
[[J, J'], [0, J]], J' the derivative of J along v; inverses by cofactors, logarithms by atan2 of the nearest rotation.
At 1e-12 the cancellations in the derivatives of b and c cost 48 digits. The closed forms are held against the power
series of the 4x4 and 6x6 matrices, to 50 digits.

Pinocchio gets unit quaternions only: it takes others without a word and returns matrices that are no rotations. Where
its logarithms and tangents lose digits (WEAK) its rows are left out; weak_ranges.csv holds how many they lose. Its Jexp6
returns no numbers at all within 1e-8 of a full turn.
"""

import random

import mpmath
import numpy as np
import pinocchio as pin
from datapackage import Field, Table, fields, root
from mpmath import mp, mpf

mp.dps = 110
SEED = 20240611

ROTATION = "a11 a12 a13 a21 a22 a23 a31 a32 a33"

NEAR_PI = (np.pi - 1e-2, np.pi)
NEAR_2_PI = (2 * np.pi - 1e-2, 2 * np.pi)
"""Angles [rad] at which Pinocchio's map loses digits; measured, see weak_ranges.csv."""
WEAK = {
    "log3": [NEAR_PI],
    "log6": [(1e-3, 1e-2), NEAR_PI],
    "Jlog3": [(1e-4, 1e-2), NEAR_PI],
    "Jexp6": [(1e-4, 1e-1), NEAR_2_PI],
    "Jlog6": [(1e-4, 1e-1), NEAR_PI],
}


def exact(values):
    """Doubles as 110-digit numbers in an array of the same shape."""
    return np.vectorize(mpf, otypes=[object])(np.asarray(values, dtype=object))


def double(values):
    return np.asarray(values, dtype=object).astype(float)


def hat(v):
    x, y, z = v
    return np.array([[mpf(0), -z, y], [z, mpf(0), -x], [-y, x, mpf(0)]])


ONE = exact(np.eye(3))


def norm(v):
    return mp.sqrt(v.dot(v))


def coefficients(t):
    """sin t/t, b, c, b'/t, c'/t."""
    s, b, c = mp.sin(t) / t, (1 - mp.cos(t)) / t**2, (t - mp.sin(t)) / t**3
    return s, b, c, (s - 2 * b) / t**2, (b - 3 * c) / t**2


def exp3(psi):
    s, b, *_ = coefficients(norm(psi))
    h = hat(psi)
    return ONE + s * h + b * h.dot(h)


def jexp6(twist):
    """(J, J') of a twist."""
    v, psi = twist[:3], twist[3:]
    _, b, c, b1, c1 = coefficients(norm(psi))
    h, k, along = hat(psi), hat(v), psi.dot(v)
    squared, mixed = h.dot(h), h.dot(k) + k.dot(h)
    return ONE - b * h + c * squared, -b * k + c * mixed + along * (c1 * squared - b1 * h)


def jexp3(psi):
    return jexp6(np.concatenate([psi, psi]))[0]


def inverse(m):
    a, b, c = m.T
    cofactors = np.array([np.cross(b, c), np.cross(c, a), np.cross(a, b)])
    return cofactors / a.dot(cofactors[0])


def jlog6(twist):
    j, k = jexp6(twist)
    back = inverse(j)
    return back, -back.dot(k).dot(back)


def exp6(twist):
    """(r, A)."""
    return jexp3(-twist[3:]).dot(twist[:3]), exp3(twist[3:])


def log3(matrix):
    """Of the rotation nearest to the matrix, by Newton's iteration; the angle is below pi."""
    r = matrix
    for _ in range(3):
        r = (r + inverse(r).T) / 2
    axis = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / 2
    return axis * (mp.atan2(norm(axis), (r[0, 0] + r[1, 1] + r[2, 2] - 1) / 2) / norm(axis))


def log6(r, matrix):
    psi = log3(matrix)
    return np.concatenate([inverse(jexp3(-psi)).dot(r), psi])


def rotation(p):
    """A(P) for any norm."""
    h = hat(p[1:])
    return ONE + (h.dot(h) + p[0] * h) * (2 / p.dot(p))


def product(a, b):
    scalar = a[0] * b[0] - a[1:].dot(b[1:])
    return np.concatenate([[scalar], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])])


def check_closed_forms(twist):
    """Against the power series of exp [[hat, v], [0, 0]] and sum (-ad)^k/(k + 1)!."""
    v, h = twist[:3], hat(twist[3:])
    zero = 0 * h
    generator = np.vstack([np.column_stack([h, v]), exact(np.zeros((1, 4)))])
    adjoint = np.block([[h, hat(v)], [zero, h]])
    r, a = exp6(twist)
    j, k = jexp6(twist)
    motion = np.vstack([np.column_stack([a, r]), exact([[0, 0, 0, 1]])])
    for matrix, first, closed in [(generator, 0, motion), (-adjoint, 1, np.block([[j, k], [zero, j]]))]:
        total = term = exact(np.eye(len(matrix)))
        for n in range(1, 200):
            term = term.dot(matrix) / (n + first)
            total = total + term
        if max(abs(total - closed).ravel()) > mpf(10) ** -50:
            raise ArithmeticError(f"closed forms and power series differ for {double(twist)}")


class Samples:
    """Random numbers that are the same on every machine: no rounding but that of mpmath to doubles."""

    def __init__(self, seed):
        self.source = random.Random(seed)

    def number(self, low=-1.0, high=1.0):
        return low + (high - low) * self.source.random()

    def vector(self, size=1.0, count=3):
        return np.array([size * self.number() for _ in range(count)])

    def axis(self):
        while True:
            v = exact(self.vector())
            if mpf("0.1") < norm(v) < 1:
                return v / norm(v)

    def rotation_vector(self, angle):
        return double(self.axis() * angle)

    def power(self, low, high):
        return mpf(10) ** mpf(self.number(low, high))

    def quaternion(self):
        """Of norm 1 as far as doubles go."""
        return double(rotation_quaternion(exact(self.rotation_vector(self.number(0.0, 3.1)))))


def rotation_quaternion(psi):
    half = norm(psi) / 2
    return np.concatenate([[mp.cos(half)], psi * (mp.sin(half) / (2 * half))])


def angles(largest, nearest=-12):
    """(name of the range, sample of an angle in it), up to pi, 2 pi or beyond; `nearest` is how near pi [exponent]."""
    for k in range(-12, 0):
        yield f"1e{k}..1e{k + 1}", lambda s, k=k: s.power(k, k + 1)
    yield "1..3", lambda s: s.number(1.0, 3.0)
    yield "below pi", lambda s: mp.pi - s.power(nearest, -2)
    if largest == "pi":
        return
    yield "above pi", lambda s: mp.pi + s.power(nearest, -2)
    yield "3.2..6.2", lambda s: s.number(3.2, 6.2)
    yield "below 2 pi", lambda s: 2 * mp.pi - s.power(-9, -2)
    if largest == "2 pi":
        return
    yield "above 2 pi", lambda s: 2 * mp.pi + s.power(-9, -2)
    yield "6.4..20", lambda s: s.number(6.4, 20.0)


def row(key, by, inputs, outputs):
    """Doubles with the digits that read back exactly, mpmath's numbers with 20 digits."""
    numbers = np.concatenate([np.ravel(part) for part in outputs])
    if by == "mpmath":
        numbers = [mpmath.nstr(mpf(x), 20, strip_zeros=True) for x in numbers]
    return [*key, by, *np.concatenate([np.ravel(part) for part in inputs]), *numbers]


def pair(key, inputs, ours, theirs):
    """Both rows, or mpmath's alone."""
    rows = [row(key, "mpmath", inputs, ours)]
    return rows if theirs is None else [*rows, row(key, "pinocchio", inputs, theirs)]


def weak(name, angle):
    return any(low <= angle < high for low, high in WEAK.get(name, []))


def rotation_exponential(samples):
    rows = []
    for group, angle in angles("beyond"):
        for _ in range(60):
            psi = samples.rotation_vector(angle(samples))
            q = pin.Quaternion(pin.exp3_quat(psi))
            x = exact(psi)
            theirs = (pin.exp3(psi), [q.w, q.x, q.y, q.z])
            rows += pair([group], [psi], (exp3(x), rotation_quaternion(x)), theirs)
    return rows


def rotation_logarithm(samples):
    rows = []
    for group, angle in angles("pi"):
        for _ in range(60):
            psi = samples.rotation_vector(angle(samples))
            a = double(exp3(exact(psi)))
            theirs = None if weak("log3", np.linalg.norm(psi)) else [pin.log3(a)]
            rows += pair([group], [a], [log3(exact(a))], theirs)
    return rows


def rotation_tangents(samples):
    rows = []
    for group, angle in angles("2 pi"):
        for _ in range(40):
            psi = samples.rotation_vector(angle(samples))
            j, size = jexp3(exact(psi)), np.linalg.norm(psi)
            rows += pair(["Jexp3", group], [psi], [j], [pin.Jexp3(psi)])
            known = size < np.pi and not weak("Jlog3", size)
            rows += pair(["Jlog3", group], [psi], [inverse(j)], [pin.Jlog3(pin.exp3(psi))] if known else None)
    return rows


def quaternions(samples):
    """A(P), P o Q, the rate of P for a body rate, and the body increment of a change of P."""
    rows = []
    for exponent in [-150, -100, -50, -10, -3, 0, 3, 10, 50, 100, 150]:
        for _ in range(60):
            size = double(samples.power(exponent, exponent + 1)).item()
            p, change = samples.vector(size, 4), samples.vector(size, 4)
            q, omega = samples.vector(1.0, 4), samples.vector(5.0)
            x, y = exact(p), exact(q)
            spin = np.concatenate([[mpf(0)], exact(omega)])
            conjugate = np.concatenate([x[:1], -x[1:]])
            turn = 2 * product(conjugate, exact(change))[1:] / x.dot(x)
            ours = (rotation(x), product(x, y), product(x, spin) / 2, turn)
            rows += pair([f"1e{exponent}"], [p, q, omega, change], ours, theirs_quaternion(p, q, omega, change))
    return rows


def theirs_quaternion(p, q, omega, change):
    """Pinocchio's quaternion algebra; the matrix of the normalised quaternion."""

    def of(numbers):
        return pin.Quaternion(*(float(x) for x in numbers))

    def parts(q):
        return np.array([q.w, q.x, q.y, q.z])

    a = of(p / np.linalg.norm(p)).matrix()
    turn = parts(of(p).inverse() * of(change))[1:] * 2
    return a, parts(of(p) * of(q)), parts(of(p) * of([0.0, *omega])) / 2, turn


TOOLS = ["pin", "mpmath", "numpy"]
"""How far a result of Pinocchio may move on another machine; the digits of mpmath do not."""
MOVES = {"tolerance": 1e-13, "relative_tolerance": 1e-13}
ACCURACY = "mpmath: all 20 digits; pinocchio: 1e-12 of numbers of size one, of the result's norm where it is larger"
METHOD = (
    "mpmath with 110 digits, closed forms held against power series to 50 digits; pinocchio differs from mpmath by no "
    "more where rows are given, and its ranges of lost digits are left out, see weak_ranges.csv"
)


def keys(*names):
    descriptions = {
        "map": "which map",
        "range": "range of the angle [rad]",
        "size": "size of the quaternion's components, a power of ten",
        "argument": "the pose that is varied, 0 or 1",
        "by": "program of the results",
    }
    return [Field(name, "", descriptions[name], type="string") for name in names]


def store(name, title, columns, rows, **parameters):
    Table(
        source="pinocchio",
        name=name,
        title=title,
        fields=columns,
        rows=rows,
        accuracy=ACCURACY,
        accuracy_method=METHOD,
        parameters={"seed": SEED, "digits": mp.dps} | parameters,
        tools=TOOLS,
    ).write(root())


def main():
    samples = Samples(SEED)
    for group, angle in angles("beyond"):
        check_closed_forms(exact(np.concatenate([samples.vector(2.0), samples.rotation_vector(angle(samples))])))
    psi = fields("x y z", "rad", "rotation vector, component {}")
    given = fields(ROTATION, "1", "rotation matrix to within rounding, entry {}")
    store(
        "rotation_exponential",
        "Exponential of SO(3), as a matrix and as a unit quaternion",
        keys("range", "by") + psi + fields(ROTATION, "1", "exp, entry {}", **MOVES)
        + fields("w i j k", "1", "unit quaternion of exp, component {}", **MOVES),
        rotation_exponential(samples),
    )
    store(
        "rotation_logarithm",
        "Logarithm of the rotation nearest to a matrix",
        keys("range", "by") + given + fields("x y z", "rad", "rotation vector, component {}", **MOVES),
        rotation_logarithm(samples),
        weak=WEAK["log3"],
    )
    store(
        "rotation_tangents",
        "Right tangent of the exponential of SO(3) (Jexp3) and its inverse (Jlog3)",
        keys("map", "range", "by") + psi + fields(ROTATION, "1", "tangent, entry {}", **MOVES),
        rotation_tangents(samples),
        weak=WEAK["Jlog3"],
    )
    store(
        "quaternions",
        "Quaternions of any norm: rotation, product, rate, and the rotation that a change makes",
        keys("size", "by")
        + fields("p0 p1 p2 p3", "1", "quaternion P, {}")
        + fields("q0 q1 q2 q3", "1", "quaternion Q, {}")
        + fields("omega_x omega_y omega_z", "rad/s", "{}, body basis")
        + fields("dp0 dp1 dp2 dp3", "1", "change of P, {}")
        + fields(ROTATION, "1", "rotation of P, entry {}; Pinocchio: of P/|P|", **MOVES)
        + fields("pq0 pq1 pq2 pq3", "1", "product P o Q, {}", **MOVES)
        + fields("rate0 rate1 rate2 rate3", "1/s", "rate of P with that omega, {}", **MOVES)
        + fields("turn_x turn_y turn_z", "rad", "{}, body basis, of that change of P", **MOVES),
        quaternions(samples),
    )


if __name__ == "__main__":
    main()
