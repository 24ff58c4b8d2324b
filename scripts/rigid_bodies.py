"""Reference motions of rigid bodies, independent of the solver: no multipliers, no generalized-alpha.

  top     heavy top (Geradin & Cardona; Bruels & Arnold): Euler's equations about the fixed point, unit quaternion.
  free    torque-free asymmetric body (Dzhanibekov): omega in Jacobi elliptic functions, quaternion by Taylor series.
  sym     torque-free symmetric body: closed form, also after 10000 revolutions.
  chain   ground - spherical - body 1 - oblique revolute - body 2 - spherical - body 3, in 3D: seven generalized speeds.
  loop    planar four-bar linkage in an oblique plane, four revolute joints (three constraints redundant): crank angle.

Usage: rigid_bodies.py [top free sym chain loop]; without arguments all of it, half a minute.
Needs numpy, scipy, mpmath. SI units; quaternions (w, x, y, z) from the body to the inertial basis; omega in the body basis.

How the accuracy is judged: `top` and `free` are Taylor series of order 40 with 40 digits, repeated with another order
and step, and once more by DOP853 in double precision. `chain` and `loop` are integrated twice in minimal coordinates (DOP853 and 12th-order
Gauss collocation), and a third time in absolute coordinates of all bodies with multipliers (accelerations from the
index-1 system; least squares where constraints are redundant). The differences are printed beside the tables.
"""

import decimal
import sys
from decimal import Decimal

import mpmath as mp
import numpy as np
from scipy.integrate import solve_ivp

G = np.array([0.0, 0.0, -9.81])


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


def gauss(f, y, times, h, stages=6):
    """Gauss collocation of order 2*stages, fixed-point iteration to round-off, h divides all differences of times."""
    x, w = np.polynomial.legendre.leggauss(stages)
    c = (x + 1) / 2
    powers = np.vander(c, stages, increasing=True)
    integral = powers * c[:, None] / np.arange(1, stages + 1)
    a, b = integral @ np.linalg.inv(powers), w / 2
    out, t = [], 0.0
    k = np.tile(f(y), (stages, 1))
    compensation = np.zeros_like(y)
    for end in times:
        for _ in range(round((end - t) / h)):
            last = np.inf
            while True:
                new = np.array([f(y + h * d) for d in a @ k])
                change = np.abs(new - k).max()
                k = new
                if change == 0 or (change >= last and change < 1e-9):
                    break
                last = change
            step = h * (b @ k) + compensation
            new = y + step
            compensation, y = step - (new - y), new
        t = end
        out.append(y.copy())
    return np.array(out)


def row(values, digits=15):
    return "[" + ", ".join(mp.nstr(mp.mpf(v), digits, min_fixed=-9, max_fixed=9) for v in values) + "]"


def gap(a, b):
    return f"{float(max(abs(x - y) for x, y in zip(np.ravel(np.array(a, object)), np.ravel(np.array(b, object))))):.1e}"


# ---------------------------------------------------------------- one body: Taylor series with many digits

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
    """State (omega, e_z in the body basis, q); inertia about the fixed point, lever of the weight along body axis k."""
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


def top():
    print("\n== heavy top: m 15, inertia about S (0.234375, 0.46875, 0.234375), S at (0, 1, 0), omega0 (0, 150, -4.61538)")
    m, g = Decimal(15), Decimal("9.81")
    about_s = [Decimal(v) for v in ("0.234375", "0.46875", "0.234375")]
    inertia = [about_s[0] + m, about_s[1], about_s[2] + m]
    equations = body_equations(inertia, m * g, 1)
    times = ["0", "0.5", "1", "1.5", "2"]
    y0 = start((0, 150, "-4.61538"))
    solution = taylor(y0, equations, times, 80, 40)
    again = taylor(y0, equations, times, 125, 36)
    inertia, m, g = [mp.mpf(str(v)) for v in inertia], mp.mpf(15), mp.mpf("9.81")
    equations = body_equations(inertia, m * g, 1)

    def f(y):
        e = matrix(y[3:]).T @ [0, 0, 1]
        j = np.array([15.234375, 0.46875, 15.234375])
        return np.concatenate([(cross([0, 1, 0], -15 * 9.81 * e) - cross(y[:3], j * y[:3])) / j, rate(y[3:], y[:3])])
    double = dop853(f, np.array([0, 150, -4.61538, 1, 0, 0, 0]), [float(t) for t in times])

    print("t, x_S, omega, quaternion, joint force on the top (inertial)")
    for t, y, d in zip(times, solution, double):
        w, q = y[:3], y[6:10]
        x = rotate(q, [0, 1, 0])
        a = equations(y, y)[:3]  # angular acceleration; s = (0, 1, 0)
        body = [w[0] * w[1] - a[2], -w[0] ** 2 - w[2] ** 2, w[1] * w[2] + a[0]]
        force = [m * v for v in rotate(q, body)]
        force[2] += m * g
        print(t, row(x), row(w, 17), row(q), row(force, 17), sep="\n    ")
    print("Taylor 40 (h = 1/80) against 36 (1/125):", gap(solution, again),
          " against DOP853 in double precision:", gap([s[:3] + s[6:10] for s in solution], double))
    energy = [sum(i * w * w for i, w in zip(inertia, y)) / 2 + m * g * rotate(y[6:10], [0, 1, 0])[2] for y in solution]
    print("energy", mp.nstr(energy[0], 17), "drift", mp.nstr(max(abs(e - energy[0]) for e in energy), 2))
    x1 = rotate(solution[2][6:10], [0, 1, 0])
    print("published, 1 s, x_S:", gap(x1, [mp.mpf(v) for v in ("0.173343964098", "0.640088592070", "-0.748490791134")]),
          " omega:", gap(solution[2][:3], [mp.mpf(v) for v in ("-0.822078101686", "150", "-5.923291348117")]))
    x, q = ("-0.150416985652933", "-1.724164450779749", "-0.673023460701136"), (
        "0.122947275600560", "-0.491079359219981", "0.350430794926147", "-0.787986857972906")
    other = taylor(start((0, 150, Decimal(-60) / 13)), body_equations([Decimal(v) for v in ("15.234375", "0.46875", "15.234375")],
                   Decimal("147.15"), 1), ["2"], 80, 40)[0]
    for name, y in (("-4.61538", solution[4]), ("-60/13", other)):
        x2 = rotate(y[6:10], [0, 1, 0])
        print(f"published, 2 s, against omega_3 = {name}: x_S - (0, 1, 0)", gap([x2[0], x2[1] - 1, x2[2]], [mp.mpf(v) for v in x]),
              " quaternion", gap(y[6:10], [mp.mpf(v) for v in q]))


def free():
    print("\n== Dzhanibekov: mass 1, inertia (1, 2, 3), omega0 (0.01, 5, 0.02), orientation identity, no gravity")
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
        u = u0 + speed * t
        return [a * mp.ellipfun(n, u, m=modulus) for a, n in ((a1, "cn"), (a2, "sn"), (a3, "dn"))]
    quarter = mp.ellipk(modulus) / speed
    print("k^2", mp.nstr(modulus, 17), " period 4K/speed", mp.nstr(4 * quarter, 17), " first flip (omega_2 = 0) at",
          mp.nstr(2 * quarter - u0 / speed, 17), " then every", mp.nstr(2 * quarter, 17))
    print("omega = (a1 cn u, a2 sn u, a3 dn u), u = u0 + speed t; a =", row([a1, a2, a3], 20), "speed, u0, k^2 =",
          row([speed, u0, modulus], 20))
    times = [1, 2, 3, 5, 8, 10, 15, 20]
    equations = body_equations([Decimal(1), Decimal(2), Decimal(3)])
    solution = taylor(start(("0.01", 5, "0.02")), equations, times, 20, 40)
    again = taylor(start(("0.01", 5, "0.02")), equations, times, 30, 36)
    j = np.array([1.0, 2, 3])
    double = dop853(lambda y: np.concatenate([-cross(y[:3], j * y[:3]) / j, rate(y[3:], y[:3])]),
                    np.array([0.01, 5, 0.02, 1, 0, 0, 0]), [float(t) for t in times])
    print("t, omega, quaternion")
    for t, y in zip(times, solution):
        print(t, row(closed(t)), row(y[6:10]), sep="\n    ")
    print("closed form against Taylor:", gap([closed(t) for t in times], [y[:3] for y in solution]),
          " Taylor against Taylor:", gap(solution, again), " against DOP853:",
          gap([s[:3] + s[6:10] for s in solution], double))
    start_l = [i * w for i, w in zip(inertia, w0)]
    print("inertial angular momentum", row(start_l), "drift", gap(
        [rotate(y[6:10], [i * w for i, w in zip(inertia, y)]) for y in solution], [start_l] * len(times)),
        " kinetic energy", mp.nstr(twice_t / 2, 17))
    revolutions = 2 * mp.pi * 10000 / 5
    last = closed(revolutions)
    with mp.workdps(70):  # once more with the phase reduced by whole periods
        again = closed(revolutions - mp.floor(revolutions / (4 * quarter)) * 4 * quarter)
    print("after 10000 turns at 5 rad/s, t =", mp.nstr(revolutions, 17), "omega", row(last), "reduced phase:", gap(last, again),
          " a phase error of 1e-6 s changes it by", gap(last, closed(revolutions + mp.mpf("1e-6"))))


def sym():
    print("\n== symmetric body: inertia (2, 2, 3), omega0 (1, 0, 10), identity, no gravity")
    i1, i3 = mp.mpf(2), mp.mpf(3)
    w0 = [mp.mpf(1), mp.mpf(0), mp.mpf(10)]
    momentum = [i1 * w0[0], i1 * w0[1], i3 * w0[2]]
    size = mp.sqrt(sum(v * v for v in momentum))
    rate3 = (i3 - i1) / i1 * w0[2]

    def closed(t):
        """omega turns about e_3 at (I3 - I1) w3 / I1; q = exp(L t / I1) exp(e_3 (1 - I3/I1) w3 t), identity at t = 0."""
        w = [w0[0] * mp.cos(rate3 * t) - w0[1] * mp.sin(rate3 * t), w0[0] * mp.sin(rate3 * t) + w0[1] * mp.cos(rate3 * t), w0[2]]
        half = size * t / i1 / 2
        p = [mp.cos(half), *(mp.sin(half) * v / size for v in momentum)]
        back = -rate3 * t / 2
        # half_product is p * w / 2; the factor 2 restores the product with the pure part
        q = [mp.cos(back) * a + b for a, b in zip(p, half_product(p, [0, 0, 2 * mp.sin(back)]))]
        return w, q
    times = [1, 2, 5]
    solution = taylor(start((1, 0, 10)), body_equations([Decimal(2), Decimal(2), Decimal(3)]), times, 20, 40)
    long = 2 * mp.pi * 10000 / 10
    print("t, omega, quaternion (the last: 10000 turns at 10 rad/s)")
    for t in (*times, long):
        print(mp.nstr(mp.mpf(t), 17), *map(row, closed(t)), sep="\n    ")
    print("closed form against Taylor:", gap([sum(closed(t), []) for t in times], [y[:3] + y[6:10] for y in solution]))
    print("precession of omega in the body", mp.nstr(rate3, 17), "rad/s, of the axis in space |L|/I1 =", mp.nstr(size / i1, 17))


# ---------------------------------------------------------------- absolute coordinates with multipliers (second formulation)

def absolute(bodies, joints):
    """y = all (x, q, v, omega), omega in the body basis. Acceleration from  M a + G^T lambda = f,  G a = gamma;
    least squares, so redundant constraints do no harm. Returns f(y) and the multipliers' forces on the first body.
    joints: (i, j, point, axis or None); i may be None for ground; point and axis inertial at the start."""
    n = len(bodies)
    frames = [matrix(np.array(b["q"])) for b in bodies]
    data = []
    for i, j, point, axis in joints:
        ai, xi = (frames[i], bodies[i]["x"]) if i is not None else (np.eye(3), np.zeros(3))
        arms = ai.T @ (np.array(point) - xi), frames[j].T @ (np.array(point) - bodies[j]["x"])
        pins = None
        if axis is not None:
            axis = np.array(axis) / np.linalg.norm(axis)
            first = np.linalg.svd(axis[None])[2][1:]
            pins = [ai.T @ v for v in first], frames[j].T @ axis
        data.append((i, j, arms, pins))

    def solve(y):
        y = y.reshape(n, 13)
        a = [matrix(b[3:7]) for b in y]
        w = [a[k] @ y[k, 10:] for k in range(n)]
        mass, force = np.zeros((6 * n, 6 * n)), np.zeros(6 * n)
        for k, b in enumerate(bodies):
            theta = a[k] @ np.diag(b["inertia"]) @ a[k].T
            mass[6 * k:6 * k + 3, 6 * k:6 * k + 3] = b["mass"] * np.eye(3)
            mass[6 * k + 3:6 * k + 6, 6 * k + 3:6 * k + 6] = theta
            force[6 * k:6 * k + 6] = [*(b["mass"] * G), *(-cross(w[k], theta @ w[k]))]
        g, gamma = [], []
        for i, j, arms, pins in data:
            rows, right = np.zeros((3, 6 * n)), np.zeros(3)
            for k, arm, sign in ((i, arms[0], -1), (j, arms[1], 1)):
                if k is not None:
                    r = a[k] @ arm
                    rows[:, 6 * k:6 * k + 6] += sign * np.hstack([np.eye(3), -skew(r)])
                    right -= sign * cross(w[k], cross(w[k], r))
            g.append(rows)
            gamma.append(right)
            if pins is not None:
                ai, wi = (a[i], w[i]) if i is not None else (np.eye(3), np.zeros(3))
                e = a[j] @ pins[1]
                for p in pins[0]:  # d/dt of p.e = (w_i - w_j).(p x e)
                    d, line = ai @ p, np.zeros((1, 6 * n))
                    c = cross(d, e)
                    if i is not None:
                        line[0, 6 * i + 3:6 * i + 6] = c
                    line[0, 6 * j + 3:6 * j + 6] = -c
                    c_rate = cross(cross(wi, d), e) + cross(d, cross(w[j], e))
                    g.append(line)
                    gamma.append(np.array([-(wi - w[j]) @ c_rate]))
        g, gamma = np.vstack(g), np.concatenate(gamma)
        inverse = np.linalg.inv(mass)
        lam = np.linalg.lstsq(g @ inverse @ g.T, gamma - g @ inverse @ force, rcond=1e-11)[0]
        return y, a, w, inverse @ (force + g.T @ lam), lam

    def f(y):
        y, a, w, acceleration, _ = solve(y)
        out = np.zeros_like(y)
        for k in range(n):
            out[k, :3], out[k, 3:7], out[k, 7:10] = y[k, 7:10], rate(y[k, 3:7], y[k, 10:]), acceleration[6 * k:6 * k + 3]
            out[k, 10:] = a[k].T @ acceleration[6 * k + 3:6 * k + 6]
        return out.ravel()

    y0 = np.concatenate([np.concatenate([b["x"], b["q"], b["v"], b["w"]]).astype(float) for b in bodies])
    return f, y0, lambda y: solve(y)[4]


def energy(bodies, y):
    return sum(0.5 * b["mass"] * s[7:10] @ s[7:10] + 0.5 * s[10:] @ (b["inertia"] * s[10:]) - b["mass"] * G @ s[:3]
               for b, s in zip(bodies, y.reshape(-1, 13)))


# ---------------------------------------------------------------- chain of three bodies

CHAIN = [dict(mass=1.2, inertia=np.array([0.02, 0.03, 0.04]), x=np.array([0.3, 0.1, -0.2]), q=np.array([1.0, 0, 0, 0])),
         dict(mass=0.8, inertia=np.array([0.015, 0.01, 0.02]), x=np.array([0.7, 0.2, -0.6]), q=np.array([0.6, 0, 0, 0.8])),
         dict(mass=0.5, inertia=np.array([0.006, 0.008, 0.004]), x=np.array([1.0, 0.6, -0.8]), q=np.array([0.8, 0, 0.6, 0]))]
P01, P12, P23, AXIS = np.zeros(3), np.array([0.5, 0.3, -0.4]), np.array([0.9, 0.4, -0.7]), np.array([1.0, 2, 2]) / 3


def chain_equations():
    """State (q1, angle, q3, omega1, angle rate, omega3): Kane's equations; also full states and the force at the ground."""
    a10, a20, a30 = (matrix(b["q"]) for b in CHAIN)
    x1, x2, x3 = (b["x"] for b in CHAIN)
    r1, s1, r2, s2, r3 = (a10.T @ (x1 - P01), a10.T @ (P12 - P01), a20.T @ (x2 - P12), a20.T @ (P23 - P12), a30.T @ (x3 - P23))

    def kinematics(y):
        q1, angle, q3, w1, spin, w3 = y[:4], y[4], y[5:9], y[9:12], y[12], y[13:16]
        q1, q3 = q1 / np.sqrt(q1 @ q1), q3 / np.sqrt(q3 @ q3)
        q2 = product(product(q1, about(AXIS, angle)), CHAIN[1]["q"])  # body 1 starts at the identity
        a1, a2, a3 = matrix(q1), matrix(q2), matrix(q3)
        axis = a1 @ AXIS
        w = [a1 @ w1, a1 @ w1 + spin * axis, a3 @ w3]
        jw = [np.zeros((3, 7)) for _ in range(3)]
        jw[0][:, :3], jw[1][:, :3], jw[1][:, 3], jw[2][:, 4:] = a1, a1, axis, a3
        bias = [np.zeros(3), spin * cross(w[0], axis), np.zeros(3)]  # angular accelerations without the unknown rates
        # arms from joint to joint, then to the centre of mass
        paths = [[(0, a1 @ r1)], [(0, a1 @ s1), (1, a2 @ r2)], [(0, a1 @ s1), (1, a2 @ s2), (2, a3 @ r3)]]
        x = [P01 + sum(r for _, r in path) for path in paths]
        jv = [sum(-skew(r) @ jw[k] for k, r in path) for path in paths]
        b = [sum(cross(w[k], cross(w[k], r)) + cross(bias[k], r) for k, r in path) for path in paths]
        return (q1, q2, q3), (a1, a2, a3), w, jw, bias, x, jv, b

    def accelerations(y):
        k = kinematics(y)
        _, a, w, jw, bias, _, jv, b = k
        mass, right = np.zeros((7, 7)), np.zeros(7)
        for i, body in enumerate(CHAIN):
            theta = a[i] @ np.diag(body["inertia"]) @ a[i].T
            mass += body["mass"] * jv[i].T @ jv[i] + jw[i].T @ theta @ jw[i]
            right += body["mass"] * jv[i].T @ (G - b[i]) - jw[i].T @ (theta @ bias[i] + cross(w[i], theta @ w[i]))
        return k, np.linalg.solve(mass, right)

    def f(y):
        _, u = accelerations(y)
        return np.concatenate([rate(y[:4], y[9:12]), [y[12]], rate(y[5:9], y[13:16]), u])

    def full(y):
        (q, a, w, _, _, x, jv, b), u = accelerations(y)
        v = [j @ y[9:] for j in jv]
        force = sum(body["mass"] * (jv[i] @ u + b[i] - G) for i, body in enumerate(CHAIN))
        return np.concatenate([np.concatenate([x[i], q[i], v[i], a[i].T @ w[i]]) for i in range(3)]), force
    return f, full


def chain():
    times = [0.25, 0.5, 1.0]
    for name, speeds in (("moving", [0.5, -1, 2, 1.5, -1.24, 2, -0.68]), ("at rest", [0] * 7)):
        print(f"\n== chain of three bodies, {name}")
        f, full = chain_equations()
        y0 = np.concatenate([CHAIN[0]["q"], [0], CHAIN[2]["q"], np.array(speeds, float)])
        initial = full(y0)[0].reshape(3, 13)
        bodies = [dict(b, v=s[7:10], w=s[10:]) for b, s in zip(CHAIN, initial)]
        for k, b in enumerate(bodies):
            print(f"body {k + 1}: mass {b['mass']} inertia {row(b['inertia'], 6)} position {row(b['x'], 6)} orientation",
                  f"{row(b['q'], 6)} velocity {row(b['v'], 12)} angular_velocity {row(b['w'], 12)}")
        a, b = dop853(f, y0, times), gauss(f, y0, times, 1 / 200)
        c = gauss(f, y0, times, 1 / 160)
        g, z0, multipliers = absolute(bodies, [(None, 0, P01, None), (0, 1, P12, AXIS), (1, 2, P23, None)])
        d = dop853(g, z0, times)
        for t, y, z in zip(times, b, d):
            state, force = full(y)
            print(f"t = {t}: x and q of the bodies 1, 2, 3; force on body 1 at the ground")
            for s in state.reshape(3, 13):
                print("   ", row(s[:3]), row(s[3:7]))
            print("   ", row(force), " differs from the multipliers' by", gap(force, multipliers(z)[:3]))
        states = np.array([full(y)[0] for y in b])
        print("Gauss h = 1/200 against 1/160:", gap(b, c), " against DOP853:", gap(b, a),
              " against absolute coordinates with multipliers:", gap(states, d))
        e = [energy(bodies, s) for s in (z0, *states)]
        print("energy", repr(float(e[0])), "drift", gap(e, e[0] * np.ones(len(e))))


# ---------------------------------------------------------------- four-bar loop

NORMAL, E1, E2 = np.array([1, 2, 2]) / 3, np.array([2, 1, -2]) / 3, np.array([-2, 2, -1]) / 3
PLANE = dict(A=(0.0, 0.0), B=(0.0, 0.6), C=(1.2, 0.9), D=(1.5, 0.0))  # coordinates along E1, E2
BARS = [dict(mass=1.0, inertia=np.array([0.03, 0.04, 0.05])), dict(mass=2.0, inertia=np.array([0.2, 0.3, 0.25])),
        dict(mass=1.5, inertia=np.array([0.12, 0.1, 0.09]))]


def loop():
    print("\n== four-bar loop in the plane with normal (1, 2, 2)/3, released at rest; bodies start at the identity")
    a, b, c, d = (np.array(PLANE[k]) for k in "ABCD")
    lengths = [np.linalg.norm(v) for v in (b - a, c - b, c - d)]
    polar = [mass["inertia"] @ NORMAL ** 2 for mass in BARS]  # about the normal; the bodies turn about it only
    m = [mass["mass"] for mass in BARS]
    g = np.array([G @ E1, G @ E2])
    angles0 = [np.arctan2(v[1], v[0]) for v in (b - a, c - b, c - d)]

    def unit(p):
        return np.array([np.cos(p), np.sin(p)])

    def normal(p):
        return np.array([-np.sin(p), np.cos(p)])

    def assemble(crank):
        """Angles of coupler and rocker from the circle intersection on the starting side."""
        b = a + lengths[0] * unit(crank)
        line = d - b
        size = np.hypot(*line)
        along = (lengths[1] ** 2 - lengths[2] ** 2 + size ** 2) / (2 * size)
        across = np.sqrt(lengths[1] ** 2 - along ** 2)
        c = b + (along * line + across * np.array([-line[1], line[0]])) / size
        return np.arctan2(*(c - b)[::-1]), np.arctan2(*(c - d)[::-1])

    def rates(y):
        """Angles, their rates, their accelerations for crank acceleration 0, and derivatives with respect to the crank."""
        p = y[0], *assemble(y[0])
        j = np.column_stack([lengths[1] * normal(p[1]), -lengths[2] * normal(p[2])])
        d1 = np.linalg.solve(j, -lengths[0] * normal(p[0]))
        ratio = np.array([1, *d1])
        w = ratio * y[1]
        right = lengths[0] * unit(p[0]) * w[0] ** 2 + lengths[1] * unit(p[1]) * w[1] ** 2 - lengths[2] * unit(p[2]) * w[2] ** 2
        return p, ratio, w, np.array([0, *np.linalg.solve(j, right)])

    def centres(p, ratio, w, bias):
        """Centre positions, their derivative to the crank, acceleration bias."""
        l = lengths
        x = [a + l[0] / 2 * unit(p[0]), a + l[0] * unit(p[0]) + l[1] / 2 * unit(p[1]), d + l[2] / 2 * unit(p[2])]
        jac = [l[0] / 2 * normal(p[0]), l[0] * normal(p[0]) + l[1] / 2 * normal(p[1]) * ratio[1], l[2] / 2 * normal(p[2]) * ratio[2]]

        def curve(k, r):
            return r * (normal(p[k]) * bias[k] - unit(p[k]) * w[k] ** 2)
        return x, jac, [curve(0, l[0] / 2), curve(0, l[0]) + curve(1, l[1] / 2), curve(2, l[2] / 2)]

    def acceleration(y):
        p, ratio, w, bias = rates(y)
        x, jac, curve = centres(p, ratio, w, bias)
        inertia = sum(m[k] * jac[k] @ jac[k] + polar[k] * ratio[k] ** 2 for k in range(3))
        force = sum(m[k] * jac[k] @ (g - curve[k]) - polar[k] * ratio[k] * bias[k] for k in range(3))
        return force / inertia

    def f(y):
        return np.array([y[1], acceleration(y)])

    def full(y):
        p, ratio, w, bias = rates(y)
        x, jac, _ = centres(p, ratio, w, bias)
        out = []
        for k in range(3):
            q, v = about(NORMAL, p[k] - angles0[k]), jac[k] * y[1]
            out.append(np.concatenate([x[k][0] * E1 + x[k][1] * E2, q, v[0] * E1 + v[1] * E2, w[k] * NORMAL]))
        return np.concatenate(out)

    def total(y):
        """Sum of the two ground joints' forces (determinate), inertial."""
        p, ratio, w, bias = rates(y)
        _, jac, curve = centres(p, ratio, w, bias)
        u = acceleration(y)
        s = sum(m[k] * (jac[k] * u + curve[k]) for k in range(3))
        return s[0] * E1 + s[1] * E2 - sum(m) * G

    def reactions(y):
        """In-plane forces at A on the crank and at D on the rocker: Newton and Euler for each bar, 9 equations for 8 forces."""
        p, ratio, w, bias = rates(y)
        x, jac, curve = centres(p, ratio, w, bias)
        u = acceleration(y)
        b = a + lengths[0] * unit(p[0])
        points = [a, b, b + lengths[1] * unit(p[1]), d]
        matrix, right = np.zeros((9, 8)), np.zeros(9)
        # forces A, B on the crank, -B, C on the coupler, -C, D on the rocker
        for k, pair in enumerate((((0, 1), (1, 1)), ((1, -1), (2, 1)), ((2, -1), (3, 1)))):
            for joint, sign in pair:
                r = points[joint] - x[k]
                matrix[3 * k:3 * k + 2, 2 * joint:2 * joint + 2] = sign * np.eye(2)
                matrix[3 * k + 2, 2 * joint:2 * joint + 2] = sign * np.array([-r[1], r[0]])
            right[3 * k:3 * k + 2] = m[k] * (jac[k] * u + curve[k] - g)
            right[3 * k + 2] = polar[k] * (ratio[k] * u + bias[k])
        forces, _, _, _ = np.linalg.lstsq(matrix, right, rcond=None)
        assert np.abs(matrix @ forces - right).max() < 1e-10
        return forces[[0, 1, 6, 7]]

    y0 = np.array([angles0[0], 0.0])
    start = full(y0).reshape(3, 13)
    bodies = [dict(BARS[k], x=start[k, :3], q=np.array([1.0, 0, 0, 0]), v=np.zeros(3), w=np.zeros(3)) for k in range(3)]
    space = {k: v[0] * E1 + v[1] * E2 for k, v in PLANE.items()}
    for k, v in space.items():
        print("joint", k, row(v, 15), end="  ")
    print()
    for k, body in enumerate(bodies):
        print(f"bar {k + 1}: mass {body['mass']} inertia {row(body['inertia'], 6)} position {row(body['x'])}")
    times = [0.25, 0.5, 1.0, 2.0, 3.0]
    one, two = dop853(f, y0, times), gauss(f, y0, times, 1 / 200)
    three = gauss(f, y0, times, 1 / 160)
    h, z0, multipliers = absolute(bodies, [(None, 0, space["A"], NORMAL), (0, 1, space["B"], NORMAL), (1, 2, space["C"], NORMAL),
                                           (None, 2, space["D"], NORMAL)])
    four = dop853(h, z0, times)
    for t, y, z in zip(times, two, four):
        s = full(y).reshape(3, 13)
        lam = multipliers(z)  # 5 rows a joint, the force first
        sides = [lam[:3], lam[15:18]]
        print(f"t = {t}: turn of the crank {row([y[0] - angles0[0]])} rad, rate {row([y[1]])}")
        print("    centre, quaternion of the coupler", row(s[1, :3]), row(s[1, 3:7]))
        print("    sum of the ground's forces on crank and rocker", row(total(y)), "multipliers differ by", gap(total(y), sides[0] + sides[1]))
        r = reactions(y)
        print("    in-plane part (along E1, E2) at A", row(r[:2]), "at D", row(r[2:]), "multipliers differ by",
              gap(r, [v @ e for v in sides for e in (E1, E2)]))
    states = np.array([full(y) for y in two])
    print("Gauss h = 1/200 against 1/160:", gap(two, three), " against DOP853:", gap(one, two),
          " against absolute coordinates with multipliers:", gap(states, four))
    e = [energy(bodies, s) for s in (z0, *states)]
    print("energy", repr(float(e[0])), "drift", gap(e, e[0] * np.ones(len(e))))
    path = dop853(f, y0, np.linspace(0.001, 3, 3000))[:, 0] - angles0[0]
    print("turn of the crank between", path.min(), "and", path.max(), "rad in 3 s")


if __name__ == "__main__":
    mp.mp.dps = 40
    decimal.getcontext().prec = 42
    for case in sys.argv[1:] or ("top", "free", "sym", "chain", "loop"):
        {"top": top, "free": free, "sym": sym, "chain": chain, "loop": loop}[case]()
