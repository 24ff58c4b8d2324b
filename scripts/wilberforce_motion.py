"""Motion of the Wilberforce pendulum with a *massless* wire (`inertia = false`), from the continuous rod equations.

The bob is a rigid body (position, unit quaternion, velocity, body angular velocity); at every instant the wire is in static
equilibrium, so its force and moment on the bob follow from a boundary-value problem: integrate
    r' = A (G0 + C_g^-1 A^T n),  A' = A [k0 + C_k^-1 A^T m]x,  n constant,  m = M + (x_S - r) x n
from the bob's end to the clamp and find (n, M) that meet the clamp (multiple shooting, Newton). Released at rest from the unstressed helix; weight of the
bob only; no damping. Data as in wilberforce.py.

Accuracy: the wire with two step lengths (DOP853's eighth-order formula), the motion with two tolerances; total energy
(kinetic, strain of the wire, weight) printed.
Usage: wilberforce_motion.py END_TIME WIRE_STEPS TOLERANCE      (8 s with 40 steps and 1e-9: a few minutes)
"""

import sys
from math import sqrt

import numpy as np
from scipy.integrate import solve_ivp
from scipy.integrate._ivp import dop853_coefficients as formula

from wilberforce import CG, CK, K0, LENGTH, MASS, R, S0, SLOPE, STRETCH, THETA, helix

GRAVITY = 9.81
STAGES = 12
A, B = formula.A[:STAGES, :STAGES], formula.B
ROWS = [A[i, :i].copy() for i in range(STAGES)]


def quaternion(frame):
    """Of a rotation matrix with a positive trace or not."""
    from scipy.spatial.transform import Rotation
    x, y, z, w = Rotation.from_matrix(frame).as_quat()
    return np.array([w, x, y, z])


def product(p, q):
    a, b, c, d = p
    e, f, g, h = q
    return np.array([a * e - b * f - c * g - d * h, a * f + b * e + c * h - d * g, a * g - b * h + c * e + d * f, a * h + b * g - c * f + d * e])


def rotate(q, v):
    w, x, y, z = q
    a, b, c = v
    t, u, s = 2 * (y * c - z * b), 2 * (z * a - x * c), 2 * (x * b - y * a)
    return np.array([a + w * t + y * s - z * u, b + w * u + z * t - x * s, c + w * s + x * u - y * t])


BOTTOM, TOP = helix(0.0), helix(LENGTH)
Q_BOTTOM, Q_TOP = quaternion(BOTTOM[1]), quaternion(TOP[1])
LEVER = BOTTOM[0] - S0
CG0, CG1, CG2, CK0, CK1, CK2 = *map(float, CG), *map(float, CK)
TORSION, CURVATURE = float(K0[0]), float(K0[2])


class Wire:
    """Multiple shooting: one Runge-Kutta step a piece, all pieces and all differences at once; Newton from the last solution."""

    def __init__(self, steps):
        self.steps, self.h = steps, LENGTH / steps
        self.wrench, self.count, self.energy = np.zeros(6), 0, 0.0
        nodes = [helix(self.h * i) for i in range(steps + 1)]
        q = [quaternion(a) for _, a in nodes]
        for i in range(1, steps + 1):
            q[i] = q[i] * np.sign(q[i] @ q[i - 1])
        self.y = np.column_stack([np.array([r for r, _ in nodes]), q])  # (steps + 1, 7)
        self.end_sign = np.sign(Q_TOP @ self.y[-1, 3:])
        # differences: base, 7 of the state, 6 of the wrench
        self.size = np.array([1e-8] * 3 + [1e-7] * 4 + [1e-6] * 3 + [1e-8] * 3)
        self.dy, self.dw = np.zeros((14, 7)), np.zeros((14, 6))
        self.dy[1:8], self.dw[8:] = np.diag(self.size[:7]), np.diag(self.size[7:])

    def rates(self, y, w, x):
        """y (8, columns), w (6, columns)."""
        a, b, c, d = y[3:7]
        n, m = w[:3], w[3:]
        f = 2 / (a * a + b * b + c * c + d * d)
        fb, fc, fd = f * b, f * c, f * d
        ab, ac, ad, bb, bc, bd, cc, cd, dd = a * fb, a * fc, a * fd, b * fb, b * fc, b * fd, c * fc, c * fd, d * fd
        ax, ay, az = 1 - cc - dd, bc + ad, bd - ac
        bx, by, bz = bc - ad, 1 - bb - dd, cd + ab
        cx, cy, cz = bd + ac, cd - ab, 1 - bb - cc
        ux, uy, uz = x[0] - y[0], x[1] - y[1], x[2] - y[2]
        nx, ny, nz = n
        tx, ty, tz = m[0] + uy * nz - uz * ny, m[1] + uz * nx - ux * nz, m[2] + ux * ny - uy * nx
        n1, n2, n3 = ax * nx + ay * ny + az * nz, bx * nx + by * ny + bz * nz, cx * nx + cy * ny + cz * nz
        m1, m2, m3 = ax * tx + ay * ty + az * tz, bx * tx + by * ty + bz * tz, cx * tx + cy * ty + cz * tz
        e1, e2, e3, k1, k2, k3 = n1 / CG0, n2 / CG1, n3 / CG2, m1 / CK0, m2 / CK1, m3 / CK2
        energy = 0.5 * (n1 * e1 + n2 * e2 + n3 * e3 + m1 * k1 + m2 * k2 + m3 * k3)
        e1, k1, k3 = e1 + 1, 0.5 * (k1 + TORSION), 0.5 * (k3 + CURVATURE)
        k2 = 0.5 * k2
        return np.array([ax * e1 + bx * e2 + cx * e3, ay * e1 + by * e2 + cy * e3, az * e1 + bz * e2 + cz * e3,
                         -(b * k1 + c * k2 + d * k3), a * k1 + c * k3 - d * k2, a * k2 + d * k1 - b * k3, a * k3 + b * k2 - c * k1, energy])

    def solve(self, x, q):
        """Force and moment about S of the wire on the bob, and the strain energy."""
        n = self.steps
        start = np.concatenate([x + rotate(q, LEVER), product(q, Q_BOTTOM)])
        start[3:] *= np.sign(start[3:] @ self.y[0, 3:])
        self.y[0] = start
        last = np.inf
        for _ in range(30):
            y = np.zeros((8, 14, n))
            y[:7] = self.y[:-1].T[:, None] + self.dy.T[:, :, None]
            y = y.reshape(8, -1)
            w = np.repeat((self.wrench + self.dw).T[:, :, None], n, axis=2).reshape(6, -1)
            k = np.empty((STAGES, 8, y.shape[1]))
            flat = k.reshape(STAGES, -1)
            for i in range(STAGES):
                k[i] = self.rates(y + self.h * (ROWS[i] @ flat[:i]).reshape(y.shape) if i else y, w, x)
            y = (y + self.h * (B @ flat).reshape(y.shape)).reshape(8, 14, n)
            self.count += 1
            gap = y[:7, 0].T - self.y[1:]
            slopes = ((y[:7, 1:] - y[:7, :1]) / self.size[:, None]).transpose(2, 0, 1)  # (n, 7, 13)
            chain = np.zeros((n + 1, 7, 7))  # change of the nodes: by the wrench, and the constant part
            for i in range(n):
                nxt = slopes[i, :, :7] @ chain[i]
                nxt[:, :6] += slopes[i, :, 7:]
                nxt[:, 6] += gap[i]
                chain[i + 1] = nxt
            end = self.y[-1]
            turn = np.array([product(Q_TOP * [1, -1, -1, -1], e)[1:] for e in np.eye(4)]).T * self.end_sign / sqrt(end[3:] @ end[3:])
            to = np.zeros((6, 7))
            to[:3, :3], to[3:, 3:] = np.eye(3), 2 * R * turn
            value = np.concatenate([end[:3] - TOP[0], 2 * R * turn @ end[3:]])
            step = -np.linalg.solve(to @ chain[n][:, :6], value + to @ chain[n][:, 6])
            change = chain @ np.append(step, 1)
            self.y += change
            self.wrench = self.wrench + step
            self.energy = y[7, 0].sum()
            size = np.abs(change).max()
            if size < 1e-13 or (size < 1e-10 and size > 0.3 * last):
                return self.wrench, self.energy
            last = size
        raise RuntimeError(f"wire: change {size}")


def main():
    end, steps, tolerance = float(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    wire = Wire(steps)

    def f(t, y):
        x, q, v, w = y[:3], y[3:7], y[7:10], y[10:]
        unit = q / sqrt(q @ q)
        wrench, _ = wire.solve(x, unit)
        moment = rotate(unit * [1, -1, -1, -1], wrench[3:])
        a = wrench[:3] / MASS - [0, 0, GRAVITY]
        return np.concatenate([v, 0.5 * product(q, np.concatenate([[0], w])), a, (moment - np.cross(w, THETA * w)) / THETA])

    y0 = np.concatenate([S0, [1, 0, 0, 0], np.zeros(6)])
    scale = np.array([1e-1] * 3 + [1] * 4 + [1] * 3 + [10] * 3)
    y, energies, evaluations, fine = y0, [], 0, []
    print("time x y z qw qx qy qz alpha  energy")
    for t in np.arange(0, end + 1e-9, 0.25):
        if t > 0:  # segment by segment, so that the wire's last solution starts the next
            s = solve_ivp(f, (t - 0.25, t), y, "DOP853", rtol=tolerance, atol=tolerance * scale, first_step=0.01, dense_output=True)
            fine.append(s.sol(np.arange(t - 0.25, t - 1e-9, 0.0025)))
            y, evaluations = s.y[:, -1], evaluations + s.nfev
        q = y[3:7] / sqrt(y[3:7] @ y[3:7])
        _, strain = wire.solve(y[:3], q)
        e = 0.5 * MASS * y[7:10] @ y[7:10] + 0.5 * y[10:] @ (THETA * y[10:]) + MASS * GRAVITY * (y[2] - S0[2]) + strain
        energies.append(e)
        print(f"{t:.2f}", *(f"{v:.13f}" for v in (*y[:3], *q, alpha_of(q[:, None])[0])), f"{e:.3e}", flush=True)
    fine = np.hstack(fine)
    envelope("z", fine[2], 0.0025)
    envelope("alpha", alpha_of(fine[3:7]), 0.0025)
    print("largest energy error", max(map(abs, energies)), "; wire solved", wire.count, "times; evaluations", evaluations)


def alpha_of(q):
    """Of quaternions of any norm, columns; alpha of A = R_x(gamma) R_y(beta) R_z(alpha): atan2(-A12, A11), unwrapped."""
    q = q / np.sqrt((q * q).sum(0))
    return np.unwrap(np.arctan2(2 * (q[0] * q[3] - q[1] * q[2]), 1 - 2 * (q[2] ** 2 + q[3] ** 2)))


def envelope(name, values, step):
    """Extrema by a parabola through three samples; half the difference of consecutive ones at their mid-time."""
    d = np.diff(values)
    at = np.where(d[:-1] * d[1:] < 0)[0] + 1
    b, c = (values[at + 1] - values[at - 1]) / 2, (values[at + 1] - 2 * values[at] + values[at - 1]) / 2
    time, peak = step * (at - b / (2 * c)), values[at] - b * b / (4 * c)
    print(name, "extrema (t, value):", " ".join(f"({t:.4f}, {p:.7f})" for t, p in zip(time, peak)))
    half, middle = np.abs(np.diff(peak)) / 2, (time[1:] + time[:-1]) / 2
    print(name, "envelope (t, half difference):", " ".join(f"({t:.3f}, {h:.5f})" for t, h in zip(middle, half)))


if __name__ == "__main__":
    main()
