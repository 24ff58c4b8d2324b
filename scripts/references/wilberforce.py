"""Wilberforce pendulum (Harsch & Eugster, section 4.2) from the continuous rod equations, without finite elements.

The wire is a Cosserat rod with EA, GA, G(I_y+I_z), EI (shear factor 1), reference arc length s, unstressed as an exact
helix, clamped at the top (xi = 1). The bob is rigidly connected to the wire's lower end (xi = 0); K is the 6x6 tangent
stiffness at the bob's centre of mass S, inertial basis: (force, moment about S) = K (displacement of S, rotation).

  a. unloaded shape: K = F^-1 with the flexibility  F = int H^T C^-1 H ds  along the helix.
  b. shape stretched by the bob's weight: static boundary-value problem by shooting, then K from the equations linearised
     about it (dead weight, wire end at a lever: all of it is in the linearised equations).
  c. with the wire's inertia (rho A, rho I): eigenvalues of the continuous problem about both shapes.

Statics:  r' = A (G0 + C_g^-1 A^T n),  A' = A [k0 + C_k^-1 A^T m]x,  n = m_b g e_z,  m = (x_S - r) x n  (weight of the bob only).
Linearised, spatial rotation phi, (dr, phi, dn, dm)' :
    phi' = A C_k^-1 A^T (dm - phi x m),             dr' = phi x r' + A C_g^-1 A^T (dn - phi x n),
    dn'  = -w^2 rho A dr,                            dm' = -w^2 A rho I A^T phi - dr' x n - r' x dn.
At the bob dn = -w^2 m_b u,  dm = -w^2 A Theta A^T theta - (dr - u) x n - (r - x_S) x dn;  at the clamp dr = phi = 0.

Accuracy: shape 1e-12 m (angles 1e-11), stiffness 1e-11 of the largest entries, frequencies 1e-11, relative; everything is
done twice. Integration by Gauss collocation of order 12 with two step lengths; K of the unloaded shape in closed form
and from the linearised equations, K of the stretched one also by differences of nonlinear solutions (to 1e-8), its shape
by DOP853; frequencies with the wire's inertia by shooting (bisection on the determinant) and by a dense Chebyshev
collocation of the whole eigenproblem at two sizes. The script fails if any two differ by more.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq

from datapackage import Field, Table, fields, root

RHO, SHEAR, NU, R, D, COILS, PITCH = 7850.0, 81e9, 0.23, 16e-3, 1e-3, 3, 1e-3
YOUNG = 2 * SHEAR * (1 + NU)
AREA, I2 = np.pi * D ** 2 / 4, np.pi * D ** 4 / 64
CG = np.array([YOUNG, SHEAR, SHEAR]) * AREA
CK = np.array([2 * SHEAR, YOUNG, YOUNG]) * I2
RHO_A, RHO_I = RHO * AREA, RHO * I2 * np.array([2.0, 1, 1])
BOB_R, BOB_H = 23e-3, 36e-3
MASS = RHO * np.pi * BOB_R ** 2 * BOB_H
THETA = MASS * np.array([(3 * BOB_R ** 2 + BOB_H ** 2) / 12] * 2 + [BOB_R ** 2 / 2])
S0 = np.array([0, 0, -BOB_H / 2 - D / 2])
WEIGHT = MASS * 9.81
EZ = np.array([0.0, 0, 1])

SLOPE = PITCH / (2 * np.pi * R)
STRETCH = np.hypot(1, SLOPE)
LENGTH = 2 * np.pi * COILS * R * STRETCH
K0 = np.array([SLOPE, 0, 1]) / (R * STRETCH ** 2)  # torsion, 0, curvature
G0 = np.array([1.0, 0, 0])


def skew(a):
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def cross(a, b):
    return skew(a) @ b


def helix(s):
    """Exact unstressed shape, phase pi."""
    phi = np.pi + s / (R * STRETCH)
    c, k, h = np.cos(phi), np.sin(phi), SLOPE
    r = R * np.array([k, -c, h * (phi - np.pi)])
    return r, np.array([[c / STRETCH, -k, -h * c / STRETCH], [k / STRETCH, c, -h * k / STRETCH], [h / STRETCH, 0, 1 / STRETCH]])


def gauss_rule(stages):
    x, b = np.polynomial.legendre.leggauss(stages)
    c = (x + 1) / 2
    powers = np.vander(c, stages, increasing=True)
    a = (powers * c[:, None] / np.arange(1, stages + 1)) @ np.linalg.inv(powers)
    return a, b / 2, c


A6, B6, C6 = gauss_rule(6)


# ---------------------------------------------------------------- the static shape under f times the bob's weight

def integrate_shape(start, target, force, moment, steps):
    """Gauss collocation from the clamp down; `target` = x_S assumed in the moment. Dead force and moment of the rest of the
    wire on the bob's side are n = force, m = moment + (x_S - r) x force. Returns stage and end values of r and A."""
    h = -LENGTH / steps
    r, frame = start
    stages = []

    def rates(r, frame):
        n, m = force, moment + cross(target - r, force)
        return frame @ (G0 + frame.T @ n / CG), frame @ skew(K0 + frame.T @ m / CK)

    for _ in range(steps):
        kr, kf = np.tile(rates(r, frame)[0], (6, 1)), np.tile(rates(r, frame)[1], (6, 1, 1))
        for _ in range(60):
            rs, fs = r + h * A6 @ kr, frame + h * np.einsum("ij,jkl->ikl", A6, kf)
            new = [rates(a, b) for a, b in zip(rs, fs)]
            change = max(np.abs(np.array([v[0] for v in new]) - kr).max(), R * np.abs(np.array([v[1] for v in new]) - kf).max())
            kr, kf = np.array([v[0] for v in new]), np.array([v[1] for v in new])
            if change < 4e-16:
                break
        rs, fs = r + h * A6 @ kr, frame + h * np.einsum("ij,jkl->ikl", A6, kf)
        stages.append((rs, fs))
        r, frame = r + h * B6 @ kr, frame + h * np.einsum("i,ikl->kl", B6, kf)
    return r, frame, stages


def solve_shape(force, moment, guess, steps):
    """Pose of the bob (x_S, rotation) when the wire carries `force` and `moment` about S there: shooting on x_S."""
    r0, a0 = helix(0.0)
    lever = a0.T @ (S0 - r0)
    x = guess.copy()

    def residual(x):
        r, frame, stages = integrate_shape(helix(LENGTH), x, force, moment, steps)
        return r + frame @ lever - x, frame, stages

    value = residual(x)
    for _ in range(30):
        jac = np.column_stack([(residual(x + 1e-7 * e)[0] - value[0]) / 1e-7 for e in np.eye(3)])
        step = -np.linalg.solve(jac, value[0])
        x = x + step
        value = residual(x)
        if np.abs(step).max() < 1e-15 or np.abs(value[0]).max() < 2e-16:
            break
    return x, value[1] @ a0.T, value[2], np.abs(value[0]).max()


def shape(load, steps):
    """Under `load` times the weight: (x_S, rotation of the bob, stages from the top down, residual)."""
    x = S0.copy()
    for factor in (np.linspace(0, 1, 6)[1:] * load if load else [0.0]):
        x, turn, stages, error = solve_shape(factor * WEIGHT * EZ, np.zeros(3), x, steps)
    return x, turn, stages, error


# ---------------------------------------------------------------- linearised equations

def matrices(r, frame, x_s, n):
    """State (dr, phi, dn, dm): y' = (B0 + w^2 B1) y."""
    m = cross(x_s - r, n)
    fk, fg = frame @ np.diag(1 / CK) @ frame.T, frame @ np.diag(1 / CG) @ frame.T
    rp = frame @ (G0 + frame.T @ n / CG)
    b0, b1 = np.zeros((12, 12)), np.zeros((12, 12))
    b0[3:6, 9:], b0[3:6, 3:6] = fk, fk @ skew(m)
    dr = np.zeros((3, 12))
    dr[:, 3:6], dr[:, 6:9] = -skew(rp) + fg @ skew(n), fg
    b0[:3] = dr
    b0[9:] = skew(n) @ dr
    b0[9:, 6:9] -= skew(rp)
    b1[6:9, :3] = -RHO_A * np.eye(3)
    b1[9:, 3:6] = -frame @ np.diag(RHO_I) @ frame.T
    return b0, b1


def transfer(stages, x_s, n, w2):
    """Transfer matrix from xi = 0 to xi = 1, from the stages of the shape (stored from the top down)."""
    h = LENGTH / len(stages)
    total = np.eye(12)
    scale = np.array([R] * 3 + [1] * 3 + [CK[0] / R ** 2] * 3 + [CK[0] / R] * 3)
    for rs, fs in reversed(stages):
        big = np.eye(72)
        right = np.zeros((72, 12))
        for i in range(6):  # stages top down are reversed: c -> 1 - c, Gauss points are symmetric
            b0, b1 = matrices(rs[5 - i], fs[5 - i], x_s, n)
            b = (b0 + w2 * b1) * scale[None] / scale[:, None]
            right[12 * i:12 * i + 12] = b
            for j in range(6):
                big[12 * i:12 * i + 12, 12 * j:12 * j + 12] -= h * A6[i, j] * b
        k = np.linalg.solve(big, right)
        total = (np.eye(12) + h * sum(B6[i] * k[12 * i:12 * i + 12] for i in range(6))) @ total
    return total * scale[:, None] / scale[None]


def bob_columns(r0, x_s, n):
    """State at xi = 0 from the bob's (u, theta) and the forces (dn, dM) of the wire on the bob, M about S."""
    lever = r0 - x_s
    pose = np.zeros((12, 6))
    pose[:3, :3], pose[:3, 3:], pose[3:6, 3:] = np.eye(3), -skew(lever), np.eye(3)
    pose[9:, 3:] = -skew(n) @ skew(lever)  # dm = dM - (theta x lever) x n - lever x dn;  -(t x l) x n = n x (t x l)
    force = np.zeros((12, 6))
    force[6:9, :3], force[9:, 3:], force[9:, :3] = np.eye(3), np.eye(3), -skew(lever)
    return pose, force


def tangent(x_s, r0, stages, n):
    """K: with zero dr, phi at the clamp,  T_u (pose q + force f) = 0,  f = wire on the bob = -K q."""
    pose, force = bob_columns(r0, x_s, n)
    t = transfer(stages, x_s, n, 0.0)[:6]
    return np.linalg.solve(t @ force, t @ pose)


def mass_matrix(turn):
    """Of the bob for (u, theta), both inertial: its inertia turns with it."""
    m = np.diag([MASS] * 3 + [0.0] * 3)
    m[3:, 3:] = turn @ np.diag(THETA) @ turn.T
    return m


def frequencies(k, turn):
    return np.sqrt(eigh((k + k.T) / 2, mass_matrix(turn), eigvals_only=True))


# ---------------------------------------------------------------- a: flexibility of the helix in closed form

def flexibility(steps):
    h, f = LENGTH / steps, np.zeros((6, 6))
    for e in range(steps):
        for c, b in zip(C6, B6):
            r, frame = helix(h * (e + c))
            to = np.zeros((6, 6))  # (force, moment about S) -> (n, m at r) in the section's basis
            to[:3, :3], to[3:, :3], to[3:, 3:] = frame.T, frame.T @ skew(S0 - r), frame.T
            f += h * b * to.T @ np.diag(1 / np.concatenate([CG, CK])) @ to
    return f


# ---------------------------------------------------------------- c: eigenvalues with the wire's inertia

def determinant(w, stages, x_s, r0, n, turn):
    pose, force = bob_columns(r0, x_s, n)
    m = mass_matrix(turn)
    t = transfer(stages, x_s, n, w * w)[:6] @ (pose - w * w * force @ m)
    return np.linalg.det(t / np.array([R] * 3 + [1] * 3)[:, None] * np.array([R] * 3 + [1] * 3))


def shooting(estimates, *problem):
    """Roots of the determinant near the estimates."""
    out = []
    for w in estimates:
        width = 2e-5 * w
        a, b = w - width, w + width
        fa, fb = determinant(a, *problem), determinant(b, *problem)
        out.append(brentq(determinant, a, b, args=problem, xtol=1e-12, rtol=1e-14) if fa * fb < 0 else np.nan)
    return np.array(out)


def chebyshev(n_points):
    """Points on [0, 1] from 0 to 1 and the differentiation matrix."""
    k = np.arange(n_points)
    x = -np.cos(np.pi * k / (n_points - 1))
    c = np.where((k == 0) | (k == n_points - 1), 2.0, 1.0) * (-1.0) ** k
    dx = x[:, None] - x[None]
    d = np.outer(c, 1 / c) / (dx + np.eye(n_points))
    d -= np.diag(d.sum(1))
    return (x + 1) / 2, 2 * d


def dense(shape_at, x_s, r0, n, turn, points, count):
    """All equations at Chebyshev points, the bob's and the clamp's conditions in place of the ends: L y = w^2 M y."""
    xi, d = chebyshev(points)
    scale = np.array([R] * 3 + [1] * 3 + [CK[0] / R ** 2] * 3 + [CK[0] / R] * 3)
    size = 12 * points
    left, right = np.kron(d / LENGTH, np.eye(12)), np.zeros((size, size))
    for p, x in enumerate(xi):
        b0, b1 = matrices(*shape_at(x), x_s, n)
        s = slice(12 * p, 12 * p + 12)
        left[s, s] -= b0 * scale[None] / scale[:, None]
        right[s, s] = b1 * scale[None] / scale[:, None]
    # unknowns at the bob: (u, theta) of the bob and y0; at xi = 0 replace the 12 rows by y0 = pose q - w^2 force M q with q from y0
    pose, force = bob_columns(r0, x_s, n)
    q = np.linalg.inv(pose[:6])  # q = q @ (dr, phi)
    m = mass_matrix(turn)
    # (dn, dm) = pose[6:] q + f-part;  f-part = -w^2 force[6:] m q
    rows_l, rows_r = np.zeros((6, size)), np.zeros((6, size))
    rows_l[:, 6:12], rows_l[:, :6] = np.eye(6), -pose[6:] @ q
    rows_r[:, :6] = -force[6:] @ m @ q
    rows_l[:, :12] *= scale[None] / scale[6:, None]
    rows_r[:, :12] *= scale[None] / scale[6:, None]
    # 12 differential equations of first order on `points` points: drop the equations of (dn, dm) at the bob, of (dr, phi) at the clamp
    left[6:12], right[6:12] = rows_l, rows_r
    end = size - 12
    left[end:end + 6], right[end:end + 6] = 0, 0
    left[end:end + 6, end:end + 6] = np.eye(6)
    mu = np.linalg.eigvals(np.linalg.solve(left, right))
    mu = mu[np.argsort(-np.abs(mu))][:count]
    return np.sqrt(1 / mu)


def rotation_vector(turn):
    rotation = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]) / 2
    size = np.linalg.norm(rotation)
    return rotation / size * np.arctan2(size, (np.trace(turn) - 1) / 2) if size else rotation


def by_differences(x_s, turn):
    """K of the stretched shape: the columns of its inverse by small loads on the bob and nonlinear solutions."""
    columns = []
    for i in range(6):
        size = 1e-4 * (WEIGHT if i < 3 else WEIGHT * R)
        ends = []
        for sign in (1, -1):
            e = sign * size * np.eye(6)[i]
            x, a, _, _ = solve_shape(WEIGHT * EZ - e[:3], -e[3:], x_s, 60)  # the wire carries minus the load on the bob
            ends.append(np.concatenate([x, rotation_vector(a @ turn.T)]))
        columns.append((ends[0] - ends[1]) / (2 * size))
    return np.linalg.inv(np.column_stack(columns))


def by_dop853(x_s, at):
    """The stretched shape from the clamp down, at arc lengths that fall."""
    def rates(s, y):
        frame, r, n = y[3:].reshape(3, 3), y[:3], WEIGHT * EZ
        bend = skew(K0 + frame.T @ cross(x_s - r, n) / CK)
        return np.concatenate([frame @ (G0 + frame.T @ n / CG), (frame @ bend).ravel()])
    top, frame = helix(LENGTH)
    start = np.concatenate([top, frame.ravel()])
    return solve_ivp(rates, (LENGTH, 0), start, "DOP853", at, rtol=1e-13, atol=1e-16).y.T


def apart(a, b):
    return np.abs(a - b).max() / np.abs(b).max()


def unloaded():
    """Shape and tangent stiffness, twice; K in closed form."""
    closed = np.linalg.inv(flexibility(47))
    found = []
    for steps in (60, 90):
        x_s, turn, stages, _ = shape(0.0, steps)
        found.append((x_s, turn, stages, helix(0)[0], closed))
    linear = tangent(found[1][0], helix(0)[0], found[1][2], np.zeros(3))
    errors = apart(np.linalg.inv(flexibility(30)), closed), apart(linear, closed)
    same = np.abs(frequencies(linear, np.eye(3)) / frequencies(closed, np.eye(3)) - 1).max()
    print("unloaded: K by two quadratures and by the linearised equations", errors, "frequencies", same)
    assert max(errors) < 1e-11 and same < 1e-11
    return found


def stretched():
    found = []
    for steps in (60, 90):
        x_s, turn, stages, error = shape(1.0, steps)
        r0 = x_s - turn @ (S0 - helix(0)[0])
        found.append((x_s, turn, stages, r0, tangent(x_s, r0, stages, WEIGHT * EZ)))
    (x_c, turn_c, _, _, k_c), (x_s, turn, _, r0, k) = found
    end = by_dop853(x_s, [0.0])[0]
    shapes = np.abs(x_c - x_s).max(), np.abs(end[:3] - r0).max()
    turns = np.abs(turn_c - turn).max(), np.abs(end[3:].reshape(3, 3) @ helix(0)[1].T - turn).max()
    nonlinear = apart(by_differences(x_s, turn), k)
    same = np.abs(frequencies(k_c, turn_c) / frequencies(k, turn) - 1).max()
    print("stretched: shapes", shapes, "turns", turns, "frequencies", same)
    print("stretched: K", apart(k_c, k), "its asymmetry", apart(k.T, k), "by differences", nonlinear)
    assert max(shapes) < 1e-12 and max(turns) < 1e-11 and apart(k_c, k) < 1e-11 and nonlinear < 1e-8 and same < 1e-11
    return found


def with_inertia(found, load):
    """Twelve frequencies by shooting, judged by another step and by Chebyshev collocation of two sizes."""
    n = load * WEIGHT * EZ
    problems = [(stages, x_s, r0, n, turn) for x_s, turn, stages, r0, _ in found]

    def at_points(points):
        if not load:
            return lambda x: helix(x * LENGTH)
        xi = chebyshev(points)[0]
        y = by_dop853(found[0][0], xi[::-1] * LENGTH)
        table = {round(x, 14): row for x, row in zip(xi[::-1], y)}
        return lambda x: (table[round(x, 14)][:3], table[round(x, 14)][3:].reshape(3, 3))

    d1, d2 = (dense(at_points(p), *problems[0][1:], p, 12) for p in (56, 72))
    imaginary = max(np.abs(d1.imag).max(), np.abs(d2.imag).max())
    d1, d2 = np.sort(d1.real), np.sort(d2.real)
    a, b = (shooting(d2, *problem) for problem in problems)
    errors = [np.abs(x / y - 1).max() for x, y in ((a, b), (d1, d2), (b, d2))]
    print("with inertia: shooting, Chebyshev, shooting from Chebyshev", errors, "imaginary", imaginary)
    assert max(errors) < 1e-11 and not np.isnan(b).any()
    return b


def store(name, title, columns, rows, accuracy, method):
    Table(
        source="continuous", name=name, title="Wilberforce pendulum: " + title, fields=columns, rows=rows, accuracy=accuracy,
        accuracy_method=method, parameters={"steps": 90, "judgedBySteps": 60, "chebyshevPoints": [56, 72]},
        tools=["numpy", "scipy"],
    ).write(root())


def main():
    found = {"unloaded": unloaded(), "stretched": stretched()}
    key = Field("shape", "", "unloaded, or stretched by the bob's weight", type="string")
    stiffness, omega = [], []
    for name, load in (("unloaded", 0.0), ("stretched", 1.0)):
        _, turn, _, _, k = found[name][1]
        stiffness += [[name, i, j, float(k[i, j])] for i in range(6) for j in range(6)]
        for wire, values in (("massless", frequencies(k, turn)), ("inertia", with_inertia(found[name], load))):
            omega += [[name, wire, mode + 1, value] for mode, value in enumerate(values.tolist())]
    store("wilberforce_stiffness",
          "6x6 stiffness at the bob's centre of mass, (force, moment) = K (displacement, rotation), inertial",
          [key, Field("row", "1", "0 to 5: force along x, y, z, moment about x, y, z"),
           Field("column", "1", "likewise: displacement, rotation"),
           Field("k", "N/m, N, N m", "entry", tolerance=1e-10, relative_tolerance=1e-12)],
          stiffness, "1e-11 of the largest entries",
          "closed form, linearised equations with two steps, differences of nonlinear solutions")
    store("wilberforce_frequencies", "angular frequencies about both shapes",
          [key, Field("wire", "", "massless, or with its inertia", type="string"),
           Field("mode", "1", "number from the lowest on"),
           Field("omega", "rad/s", "angular frequency", relative_tolerance=3e-12)],
          omega, "1e-11, relative",
          "two steps; shooting against a dense collocation of the whole eigenproblem with two numbers of points")
    x_s, turn, _, r0, _ = found["stretched"][1]
    store("wilberforce_hanging", "the bob at rest under its weight",
          [*fields("x y z", "m", "centre of mass of the bob, {}", tolerance=1e-12),
           *fields("rx ry rz", "rad", "rotation vector of the bob, {}", tolerance=1e-11),
           Field("alpha", "rad", "angle of A = R_x(gamma) R_y(beta) R_z(alpha): atan2(-A12, A11)", tolerance=1e-11),
           *fields("ex ey ez", "m", "end of the wire at the bob, {}", tolerance=1e-12)],
          [[*x_s.tolist(), *rotation_vector(turn).tolist(), float(np.arctan2(-turn[0, 1], turn[0, 0])), *r0.tolist()]],
          "1e-12 m, 1e-11 rad", "Gauss collocation with two steps; DOP853 from the clamp")


if __name__ == "__main__":
    main()
