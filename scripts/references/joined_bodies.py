"""Reference motions of joined rigid bodies in minimal coordinates: no multipliers, no generalized-alpha.

  chain     ground - spherical - body 1 - oblique revolute - body 2 - spherical - body 3, in 3D: seven generalized
            speeds, Kane's equations; moving at the start, and released at rest; chain_force: force of the ground.
  four_bar  planar four-bar linkage in an oblique plane, four revolute joints (three constraints redundant), released at
            rest: crank angle. How normal forces and moments in the plane are shared is indeterminate and not stored.

SI units; quaternions (w, x, y, z) from the body to the inertial basis; omega in the body basis.

Accuracy: each is integrated by 12th-order Gauss collocation with two steps, by DOP853, and a third time in absolute
coordinates of all bodies with multipliers (accelerations from the index-1 system; least squares where constraints are
redundant). The script fails if any two differ by more than it states.
"""

import numpy as np

from datapackage import Field, Table, fields, root
from rigid_bodies import about, cross, dop853, matrix, product, rate, skew

G = np.array([0.0, 0.0, -9.81])

# Accuracy of poses [m, 1, rad] and forces [N].
CHAIN_STATED, LOOP_STATED = (1e-12, 5e-12), (4e-12, 2e-10)


def gap(a, b):
    return float(np.abs(np.asarray(a) - np.asarray(b)).max())


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


def pose_fields(what, stated):
    return [
        *fields("x y z", "m", "centre of mass" + what + ", inertial, {}", 0.5 * stated),
        *fields("qw qx qy qz", "1", "quaternion" + what + " to the inertial basis, {}", 0.5 * stated),
    ]


def store(name, title, columns, rows, stated, scene):
    Table(
        source="rigid", name=name, title=title, fields=columns,
        rows=[[v if isinstance(v, (str, int)) else float(v) for v in row] for row in rows],
        accuracy=f"poses {stated[0]:.0e} m and 1, forces {stated[1]:.0e} N",
        accuracy_method="Gauss collocation of order 12 with steps of 1/200 s and 1/160 s, DOP853, and absolute coordinates with "
                        "multipliers; energy constant",
        parameters={"scene": scene, "step": "1/200"}, tools=["numpy", "scipy"],
    ).write(root())


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


CHAIN_SPEEDS = {"moving": [0.5, -1, 2, 1.5, -1.24, 2, -0.68], "at rest": [0] * 7}
CHAIN_SCENE = "three bodies (mass 1.2, 0.8, 0.5 kg), joints at (0, 0, 0), (0.5, 0.3, -0.4), (0.9, 0.4, -0.7) m, revolute " \
              "axis (1, 2, 2)/3, gravity 9.81 m/s2 along -e_z; inertias, poses and speeds at the start in the script"


def chain():
    times = np.arange(41) / 40
    poses, forces = [], []
    for name, speeds in CHAIN_SPEEDS.items():
        f, full = chain_equations()
        y0 = np.concatenate([CHAIN[0]["q"], [0], CHAIN[2]["q"], np.array(speeds, float)])
        bodies = [dict(b, v=s[7:10], w=s[10:]) for b, s in zip(CHAIN, full(y0)[0].reshape(3, 13))]
        best = gauss(f, y0, times, 1 / 200)
        g, z0, multipliers = absolute(bodies, [(None, 0, P01, None), (0, 1, P12, AXIS), (1, 2, P23, None)])
        other = dop853(g, z0, times)
        states, force = (np.array(part) for part in zip(*(full(y) for y in best)))
        pose = [s.reshape(-1, 3, 13)[:, :, :7] for s in (states, other)]
        apart = max(gap(best[:, :9], y[:, :9]) for y in (gauss(f, y0, times, 1 / 160), dop853(f, y0, times))), gap(*pose)
        force_apart = gap(force, [multipliers(z)[:3] for z in other])
        energies = [energy(bodies, s) for s in states]
        print(f"chain, {name}: poses apart {apart}, forces {force_apart:.1e}, energy {np.ptp(energies):.1e}")
        assert max(apart) < CHAIN_STATED[0] and force_apart < CHAIN_STATED[1] and np.ptp(energies) < 1e-11
        for t, state, pull in zip(times, states, force):
            poses += [[name, t, k + 1, *s[:7]] for k, s in enumerate(state.reshape(3, 13))]
            forces.append([name, t, *pull])
    keys = [Field("start", "", "moving or at rest", type="string"), Field("t", "s", "time")]
    pose_columns = [*keys, Field("body", "1", "number from the ground on"), *pose_fields(" of the body", CHAIN_STATED[0])]
    store("chain", "Chain of three bodies: poses", pose_columns, poses, CHAIN_STATED, CHAIN_SCENE)
    force_columns = [*keys, *fields("fx fy fz", "N", "force of the ground on body 1, inertial, {}", 0.5 * CHAIN_STATED[1])]
    store("chain_force", "Chain of three bodies: force of the ground on the first", force_columns, forces, CHAIN_STATED, CHAIN_SCENE)


# ---------------------------------------------------------------- four-bar loop

NORMAL, E1, E2 = np.array([1, 2, 2]) / 3, np.array([2, 1, -2]) / 3, np.array([-2, 2, -1]) / 3
PLANE = dict(A=(0.0, 0.0), B=(0.0, 0.6), C=(1.2, 0.9), D=(1.5, 0.0))  # coordinates along E1, E2
BARS = [dict(mass=1.0, inertia=np.array([0.03, 0.04, 0.05])), dict(mass=2.0, inertia=np.array([0.2, 0.3, 0.25])),
        dict(mass=1.5, inertia=np.array([0.12, 0.1, 0.09]))]


def loop_equations():
    """State (crank angle, its rate); f, full states of the bars, forces of the ground, angles at the start."""
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

    return f, full, total, reactions, angles0


LOOP_SCENE = "bars of 1, 2, 1.5 kg; joints A (0, 0, 0), B (0, 0.6), C (1.2, 0.9), D (1.5, 0) m along e_1 = (2, 1, -2)/3 and " \
             "e_2 = (-2, 2, -1)/3; axes (1, 2, 2)/3; gravity 9.81 m/s2 along -e_z; at rest and at the identity at the start"


def four_bar():
    f, full, total, reactions, angles = loop_equations()
    y0, times = np.array([angles[0], 0.0]), np.arange(61) / 20
    begin = full(y0).reshape(3, 13)
    bodies = [dict(BARS[k], x=begin[k, :3], q=np.array([1.0, 0, 0, 0]), v=np.zeros(3), w=np.zeros(3)) for k in range(3)]
    space = {k: v[0] * E1 + v[1] * E2 for k, v in PLANE.items()}
    best = gauss(f, y0, times, 1 / 200)
    h, z0, multipliers = absolute(bodies, [(None, 0, space["A"], NORMAL), (0, 1, space["B"], NORMAL), (1, 2, space["C"], NORMAL),
                                           (None, 2, space["D"], NORMAL)])
    other = dop853(h, z0, times)
    states = np.array([full(y) for y in best])
    pose = [s.reshape(-1, 3, 13)[:, :, :7] for s in (states, other)]
    apart = max(gap(best[:, 0], y[:, 0]) for y in (gauss(f, y0, times, 1 / 160), dop853(f, y0, times))), gap(*pose)
    sums, shares = np.array([total(y) for y in best]), np.array([reactions(y) for y in best])
    # 5 rows a joint, the force first
    sides = np.array([multipliers(z) for z in other])[:, [0, 1, 2, 15, 16, 17]].reshape(-1, 2, 3)
    in_plane = np.array([[v @ e for v in pair for e in (E1, E2)] for pair in sides])
    force_apart = max(gap(sums, sides.sum(1)), gap(shares, in_plane))
    energies = [energy(bodies, s) for s in states]
    print(f"four-bar: poses apart {apart}, forces {force_apart:.1e}, energy {np.ptp(energies):.1e}")
    assert max(apart) < LOOP_STATED[0] and force_apart < LOOP_STATED[1] and np.ptp(energies) < 1e-11
    columns = [
        Field("t", "s", "time"),
        Field("crank", "rad", "turn of the crank from the start, about the normal", 0.5 * LOOP_STATED[0]),
        *pose_fields(" of the coupler", LOOP_STATED[0]),
        *fields("fx fy fz", "N", "sum of the forces of the ground on crank and rocker, inertial, {}", 0.5 * LOOP_STATED[1]),
        *fields("a1 a2 d1 d2", "N", "in-plane force of the ground at joint A or D along e_1 or e_2, {}", 0.5 * LOOP_STATED[1]),
    ]
    rows = [[t, y[0] - angles[0], *s.reshape(3, 13)[1, :7], *force, *share]
            for t, y, s, force, share in zip(times, best, states, sums, shares)]
    store("four_bar", "Four-bar loop: crank, coupler, forces of the ground", columns, rows, LOOP_STATED, LOOP_SCENE)


if __name__ == "__main__":
    chain()
    four_bar()
