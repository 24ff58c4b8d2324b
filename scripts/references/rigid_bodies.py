"""Reference motions of one rigid body, independent of any solver: no multipliers, no generalized-alpha.

  heavy_top             Geradin & Cardona; Bruels & Arnold: Euler's equations about the fixed point, unit quaternion.
  free_asymmetric_body  torque-free body that tumbles (Dzhanibekov): omega in Jacobi elliptic functions, quaternion by
                        Taylor series; free_asymmetric_body_flips: the instants at which omega_2 vanishes.
  free_symmetric_body   torque-free symmetric body: closed form.

SI units; quaternions (w, x, y, z) from the body to the inertial basis; omega in the body basis.

Accuracy: all digits of double precision. The Taylor series of order 40 have 42 digits; they are repeated with another
order and step, compared with the closed forms where there are some, with DOP853 in double precision, and, for the top,
with printed figures: those at 1 s agree within 4e-12; those at 2 s are a time integrator's, and agree within 1.2e-6.
"""

import decimal
from decimal import Decimal

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

from datapackage import Field, Table, fields, root

mp.mp.dps = 40
decimal.getcontext().prec = 42

ROUNDING = 1e-14
# What DOP853 in double precision may differ by.
DOUBLE = 1e-9


# ---------------------------------------------------------------- tools

def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def matrix(q):
    """Rotation matrix of a quaternion of any norm."""
    q = q / np.sqrt(q @ q)
    w, v = q[0], skew(q[1:])
    return np.eye(3) + 2 * (w * v + v @ v)


def product(p, q):
    return np.concatenate([[p[0] * q[0] - p[1:] @ q[1:]], p[0] * q[1:] + q[0] * p[1:] + cross(p[1:], q[1:])])


def rate(q, omega):
    """Time derivative of q for the body-basis angular velocity."""
    return 0.5 * product(q, np.concatenate([[0], omega]))


def about(axis, angle):
    return np.concatenate([[np.cos(angle / 2)], np.sin(angle / 2) * axis])


def dop853(f, y, times):
    s = solve_ivp(lambda t, y: f(y), (0, times[-1]), y, "DOP853", times, rtol=3e-14, atol=1e-15)
    assert s.success
    return s.y.T


def gap(a, b):
    """Largest difference of two lists of lists."""
    return float(max(abs(x - y) for x, y in zip(np.ravel(np.array(a, object)), np.ravel(np.array(b, object)))))


def instants(end, count):
    """Equal steps from 0, as text."""
    return [str(Decimal(end) * k / count) for k in range(count + 1)]


# ---------------------------------------------------------------- Taylor series with many digits

def taylor(y, bilinear, times, step, order):
    """y' = bilinear(y, y) by power series in decimals; bilinear takes lists and is linear in each. Returns mpmath numbers."""
    out, t, y, step = [], Decimal(0), [Decimal(str(v)) for v in y], Decimal(1) / step
    for end in times:
        n = int((Decimal(end) - t) / step + 1)
        h = (Decimal(end) - t) / n
        for _ in range(n if h else 0):
            series = [y]
            for k in range(order):
                terms = [bilinear(series[j], series[k - j]) for j in range(k + 1)]
                series.append([sum(v) / (k + 1) for v in zip(*terms)])
            y = series[-1]
            for term in reversed(series[:-1]):
                y = [a * h + b for a, b in zip(y, term)]
        t = Decimal(end)
        out.append([mp.mpf(str(v)) for v in y])
    return out


def half_product(q, w):
    a, b, c, d = q
    x, y, z = (v / 2 for v in w)
    return [-b * x - c * y - d * z, a * x + c * z - d * y, a * y + d * x - b * z, a * z + b * y - c * x]


def body_equations(inertia, weight_moment=0, k=None):
    """State (omega, e_z in the body basis, q, 1); inertia about the fixed point, lever of the weight along body axis k."""
    i1, i2, i3 = inertia

    def f(a, b):
        w, e, v = a[:3], b[3:6], b[:3]
        t = [0, 0, 0]
        if k is not None:  # moment s x (-m g e), s along axis k
            t[(k + 1) % 3] = weight_moment * e[(k + 2) % 3]
            t[(k + 2) % 3] = -weight_moment * e[(k + 1) % 3]
        # the moment is linear: the constant eleventh unknown makes it bilinear
        return [(i2 - i3) / i1 * w[1] * v[2] + a[10] * t[0] / i1,
                (i3 - i1) / i2 * w[2] * v[0] + a[10] * t[1] / i2,
                (i1 - i2) / i3 * w[0] * v[1] + a[10] * t[2] / i3,
                e[1] * w[2] - e[2] * w[1], e[2] * w[0] - e[0] * w[2], e[0] * w[1] - e[1] * w[0],
                *half_product(b[6:10], w), 0 * a[10]]
    return f


def start(omega):
    """State at the identity; omega as text."""
    return [*omega, 0, 0, 1, 1, 0, 0, 0, 1]


def rotate(q, v):
    a, x = q[0], q[1:]
    t = [2 * (x[1] * v[2] - x[2] * v[1]), 2 * (x[2] * v[0] - x[0] * v[2]), 2 * (x[0] * v[1] - x[1] * v[0])]
    u = [x[1] * t[2] - x[2] * t[1], x[2] * t[0] - x[0] * t[2], x[0] * t[1] - x[1] * t[0]]
    return [v[i] + a * t[i] + u[i] for i in range(3)]


# ---------------------------------------------------------------- the tables

def columns(*names):
    every = {
        "t": [Field("t", "s", "time")],
        "x": fields("x y z", "m", "centre of mass, inertial, {}", ROUNDING),
        "q": fields("qw qx qy qz", "1", "quaternion from the body to the inertial basis, {}", ROUNDING),
        "w": fields("wx wy wz", "rad/s", "angular velocity, body basis, {}", relative_tolerance=ROUNDING, tolerance=ROUNDING),
        "f": fields("fx fy fz", "N", "force of the joint on the body, inertial, {}", relative_tolerance=ROUNDING, tolerance=1e-11),
    }
    return [field for name in names for field in every[name]]


def store(name, title, columns, rows, method, parameters):
    Table(
        source="rigid", name=name, title=title, fields=columns,
        rows=[[float(value) for value in row] for row in rows],
        accuracy="all digits of double precision", accuracy_method=method,
        parameters=parameters, tools=["mpmath", "numpy", "scipy"],
    ).write(root())


TOP = "mass 15 kg; inertia about the centre of mass diag(0.234375, 0.46875, 0.234375) kg m2; ball joint at the origin, " \
      "centre of mass at (0, 1, 0) m; gravity 9.81 m/s2 along -e_z; starts at the identity with omega (0, 150, -4.61538) rad/s"


def heavy_top():
    times = instants("2", 100)
    mass, gravity, lever = mp.mpf(15), mp.mpf("9.81"), [0, 1, 0]
    inertia = [Decimal(v) for v in ("15.234375", "0.46875", "15.234375")]
    weight = Decimal("147.15")
    solution = taylor(start((0, 150, "-4.61538")), body_equations(inertia, weight, 1), times, 80, 40)
    again = taylor(start((0, 150, "-4.61538")), body_equations(inertia, weight, 1), times, 125, 36)
    j = np.array([float(v) for v in inertia])

    def f(y):
        moment = cross([0, 1, 0], -147.15 * (matrix(y[3:]).T @ [0, 0, 1]))
        return np.concatenate([(moment - cross(y[:3], j * y[:3])) / j, rate(y[3:], y[:3])])
    double = dop853(f, np.array([0, 150, -4.61538, 1, 0, 0, 0]), [float(t) for t in times])
    apart = gap(solution, again), gap([s[:3] + s[6:10] for s in solution], double)
    print("heavy top: Taylor against Taylor, against DOP853", apart, "published", published_top(solution, times))
    assert apart[0] < 1e-20 and apart[1] < DOUBLE

    exact = [mp.mpf(str(v)) for v in inertia]
    equations = body_equations(exact, mass * gravity, 1)
    rows = []
    for t, y in zip(times, solution):
        w, q, a = y[:3], y[6:10], equations(y, y)[:3]  # a: angular acceleration; the lever is (0, 1, 0)
        body = [w[0] * w[1] - a[2], -w[0] ** 2 - w[2] ** 2, w[1] * w[2] + a[0]]
        force = [mass * v for v in rotate(q, body)]
        force[2] += mass * gravity
        rows.append([t, *rotate(q, lever), *q, *w, *force])
    store("heavy_top", "Heavy top: centre of mass, rotation, force of the ball joint", columns(*"txqwf"), rows,
          "Taylor series of order 40 (step 1/80 s) and 36 (1/125 s) with 42 digits; DOP853; printed figures (4e-12 at 1 s)",
          {"scene": TOP, "order": 40, "step": "1/80", "digits": 42})


def published_top(solution, times):
    """Largest differences from what is printed, at 1 s and at 2 s."""
    printed = {
        "1": ("0.173343964098", "0.640088592070", "-0.748490791134", "-0.822078101686", "150", "-5.923291348117"),
        "2": ("-0.150416985652933", "-0.724164450779749", "-0.673023460701136",
              "0.122947275600560", "-0.491079359219981", "0.350430794926147", "-0.787986857972906"),
    }
    one, two = (solution[times.index(t)] for t in printed)
    found = rotate(one[6:10], [0, 1, 0]) + one[:3], rotate(two[6:10], [0, 1, 0]) + two[6:10]
    apart = [gap(f, [mp.mpf(v) for v in p]) for f, p in zip(found, printed.values())]
    assert apart[0] < 4e-12 and apart[1] < 1.2e-6
    return apart


TUMBLING = "mass 1 kg, inertia diag(1, 2, 3) kg m2, omega (0.01, 5, 0.02) rad/s and the identity at the start, no gravity"


def free_asymmetric_body():
    """omega = (a1 cn u, a2 sn u, a3 dn u), u = u0 + speed t."""
    i1, i2, i3 = inertia = [mp.mpf(v) for v in (1, 2, 3)]
    w0 = [mp.mpf("0.01"), mp.mpf(5), mp.mpf("0.02")]
    twice_t = sum(i * w ** 2 for i, w in zip(inertia, w0))
    l2 = sum((i * w) ** 2 for i, w in zip(inertia, w0))
    assert l2 > twice_t * i2
    a1 = mp.sqrt((twice_t * i3 - l2) / (i1 * (i3 - i1)))
    a2 = mp.sqrt((twice_t * i3 - l2) / (i2 * (i3 - i2)))
    a3 = mp.sqrt((l2 - twice_t * i1) / (i3 * (i3 - i1)))
    speed = mp.sqrt((i3 - i2) * (l2 - twice_t * i1) / (i1 * i2 * i3))
    modulus = (i2 - i1) * (twice_t * i3 - l2) / ((i3 - i2) * (l2 - twice_t * i1))  # k^2
    u0 = mp.ellipf(mp.atan2(w0[1] / a2, w0[0] / a1), modulus)

    def closed(t):
        u = u0 + speed * mp.mpf(t)
        return [a * mp.ellipfun(n, u, m=modulus) for a, n in ((a1, "cn"), (a2, "sn"), (a3, "dn"))]
    half = 2 * mp.ellipk(modulus) / speed  # omega_2 vanishes at u = 2K, 4K, ...
    flips = [half - u0 / speed + k * half for k in range(5)]
    assert max(abs(closed(t)[1]) for t in flips) < mp.mpf("1e-30")

    times = instants("20", 200)
    equations = body_equations([Decimal(1), Decimal(2), Decimal(3)])
    solution = taylor(start(("0.01", 5, "0.02")), equations, times, 20, 40)
    again = taylor(start(("0.01", 5, "0.02")), equations, times, 30, 36)
    j = np.array([1.0, 2, 3])
    double = dop853(lambda y: np.concatenate([-cross(y[:3], j * y[:3]) / j, rate(y[3:], y[:3])]),
                    np.array([0.01, 5, 0.02, 1, 0, 0, 0]), [float(t) for t in times])
    omega = [closed(t) for t in times]
    momentum = [i * w for i, w in zip(inertia, w0)]
    drift = gap([rotate(y[6:10], [i * w for i, w in zip(inertia, y)]) for y in solution], [momentum] * len(times))
    apart = gap(omega, [y[:3] for y in solution]), gap(solution, again), drift
    double_apart = gap([s[:3] + s[6:10] for s in solution], double)
    print("asymmetric body: closed form, Taylor against Taylor, drift of the momentum", apart, "DOP853", double_apart)
    assert max(apart) < 1e-20 and double_apart < DOUBLE
    method = "Jacobi's closed form for omega against Taylor series of order 40 (step 1/20 s) and 36 (1/30 s) with 42 digits; " \
             "angular momentum in space; DOP853"
    store("free_asymmetric_body", "Torque-free asymmetric body (Dzhanibekov): rotation and angular velocity", columns(*"tqw"),
          [[t, *y[6:10], *w] for t, y, w in zip(times, solution, omega)], method, {"scene": TUMBLING, "digits": 42})
    store("free_asymmetric_body_flips", "Torque-free asymmetric body: instants at which omega_2 changes its sign, up to 22 s",
          [Field("t", "s", "instant", ROUNDING)], [[t] for t in flips if t < 22],
          "zeros of sn, put back into sn", {"scene": TUMBLING})


SYMMETRIC = "inertia diag(2, 2, 3) kg m2, omega (1, 0, 10) rad/s and the identity at the start, no gravity"


def free_symmetric_body():
    """omega turns about e_3 at (I3 - I1) w3 / I1; q = exp(L t / I1) exp(e_3 (1 - I3/I1) w3 t), identity at t = 0."""
    i1, i3 = mp.mpf(2), mp.mpf(3)
    w0 = [mp.mpf(1), mp.mpf(0), mp.mpf(10)]
    momentum = [i1 * w0[0], i1 * w0[1], i3 * w0[2]]
    size = mp.sqrt(sum(v * v for v in momentum))
    rate3 = (i3 - i1) / i1 * w0[2]

    def closed(t):
        t = mp.mpf(t)
        c, s = mp.cos(rate3 * t), mp.sin(rate3 * t)
        w = [w0[0] * c - w0[1] * s, w0[0] * s + w0[1] * c, w0[2]]
        half = size * t / i1 / 2
        p = [mp.cos(half), *(mp.sin(half) * v / size for v in momentum)]
        back = -rate3 * t / 2
        # half_product is p * w / 2; the factor 2 restores the product with the pure part
        q = [mp.cos(back) * a + b for a, b in zip(p, half_product(p, [0, 0, 2 * mp.sin(back)]))]
        return [*q, *w]
    times = instants("5", 100)
    solution = taylor(start((1, 0, 10)), body_equations([Decimal(2), Decimal(2), Decimal(3)]), times, 20, 40)
    rows = [closed(t) for t in times]
    apart = gap(rows, [y[6:10] + y[:3] for y in solution])
    print("symmetric body: closed form against Taylor", apart)
    assert apart < 1e-20
    store("free_symmetric_body", "Torque-free symmetric body: rotation and angular velocity", columns(*"tqw"),
          [[t, *row] for t, row in zip(times, rows)], "closed form against a Taylor series of order 40 with 42 digits",
          {"scene": SYMMETRIC, "digits": 42})


if __name__ == "__main__":
    heavy_top()
    free_asymmetric_body()
    free_symmetric_body()
